/* SPDX-License-Identifier: MIT
 *
 * The second fence, by the kernel: whatever a script or a library makes of this process, it reads what the system holds
 * for everybody to run (no home, no scene), writes to the output folder, and reaches no network and no other program.
 * Landlock (Linux 5.13) for files, a seccomp filter for calls; by syscall and prctl, without a library. Both are asked
 * for at run time: a kernel may lack them, or have them switched off.
 */
#define _GNU_SOURCE
#include "runner.h"

#if defined(__linux__) && defined(__has_include) && !defined(__SANITIZE_ADDRESS__) && !defined(IMPACT_RUNNER_MEASURED)
#if __has_include(<linux/landlock.h>) && __has_include(<linux/seccomp.h>)
#define FENCE
#endif
#endif

#if !defined(FENCE)

const char *impact_runner_fence(impact_runner *runner)
{
    (void)runner;
    return "this build has no fence (it is Linux' own, and neither sanitizers nor coverage live within it)";
}

#else

#include <errno.h>
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

/* ---- files ---- */

enum {
    READ_FILE = LANDLOCK_ACCESS_FS_READ_FILE,
    READ_ALL = READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR,
    REFER = 1 << 13,    /* from the second version on */
    TRUNCATE = 1 << 14, /* from the third on */
    WRITE_ALL = READ_ALL | LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_REMOVE_FILE |
                LANDLOCK_ACCESS_FS_MAKE_REG | REFER | TRUNCATE
};

/* All rights that this version of landlock can take away from everything that is not named. */
static uint64_t rights_of(long version)
{
    const int count = version >= 5 ? 16 : version >= 3 ? 15 : version >= 2 ? 14 : 13;
    return ((uint64_t)1 << count) - 1;
}

/* What is not there needs no rule. */
static bool allow(int rules, int place, uint64_t rights)
{
    const struct landlock_path_beneath_attr rule = {.allowed_access = rights, .parent_fd = place};
    return place < 0 || syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &rule, 0) == 0;
}

static bool allow_path(int rules, const char *path, uint64_t rights)
{
    const int place = open(path, O_PATH | O_CLOEXEC);
    const bool good = allow(rules, place, rights);
    if (place >= 0) close(place);
    return good;
}

static bool allow_paths(int rules, const impact_runner *runner, uint64_t all)
{
    /* Libraries that a module needs, their loader's list, and the time zone of os.date. */
    static const char *const folders[] = {"/usr", "/lib", "/lib32", "/lib64", "/opt", "/nix/store", "/gnu/store"};
    static const char *const files[] = {"/etc/ld.so.cache", "/etc/localtime"};
    char program[4096 + 1024];
    const ssize_t length = readlink("/proc/self/exe", program, 4095);
    bool good = allow(rules, runner->folder, WRITE_ALL & all);
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++)
        good = good && allow_path(rules, folders[i], READ_ALL);
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) good = good && allow_path(rules, files[i], READ_FILE);
    static const char *const modules[] = {"modules", IMPACT_RUNNER_MODULES}; /* quat.gsl: see runner_sandbox.c */
    program[length > 0 ? length : 0] = 0;
    for (size_t i = 0; strrchr(program, '/') && i < sizeof modules / sizeof *modules; i++) {
        snprintf(strrchr(program, '/') + 1, 1024, "%s", modules[i]);
        good = good && allow_path(rules, program, READ_ALL);
        program[strlen(program) - strlen(modules[i])] = 0;
    }
    return good;
}

static const char *close_files(const impact_runner *runner)
{
    const long version = syscall(SYS_landlock_create_ruleset, NULL, (size_t)0, LANDLOCK_CREATE_RULESET_VERSION);
    if (version < 1) return "the kernel has no landlock";
    const uint64_t all = rights_of(version);
    const struct {
        uint64_t files;
    } handled = {all};
    const int rules = (int)syscall(SYS_landlock_create_ruleset, &handled, sizeof handled, 0);
    const bool closed =
        rules >= 0 && allow_paths(rules, runner, all) && syscall(SYS_landlock_restrict_self, rules, 0) == 0;
    if (rules >= 0) close(rules);
    return closed ? NULL : "landlock refused";
}

/* ---- calls ---- */

#if defined(__x86_64__)
#define OWN_ARCHITECTURE AUDIT_ARCH_X86_64
#elif defined(__aarch64__)
#define OWN_ARCHITECTURE AUDIT_ARCH_AARCH64
#endif

#define LOAD(field) BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, field))
#define ANSWER(error) BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | (error))
#define ALLOW BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW)
#define REFUSE(call) BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (call), 0, 1), ANSWER(EPERM)

static const char *close_calls(void)
{
#if defined(OWN_ARCHITECTURE)
    struct sock_filter filter[] = {
        LOAD(arch),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, OWN_ARCHITECTURE, 1, 0),
        ANSWER(EPERM),
        LOAD(nr),
#if defined(__x86_64__) /* the x32 calls */
        BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, 0x40000000, 0, 1),
        ANSWER(EPERM),
#endif
        REFUSE(SYS_socket),
        REFUSE(SYS_socketpair),
        REFUSE(SYS_connect),
        REFUSE(SYS_bind),
        REFUSE(SYS_execve),
        REFUSE(SYS_execveat),
        REFUSE(SYS_ptrace),
        REFUSE(SYS_process_vm_readv),
        REFUSE(SYS_process_vm_writev),
        REFUSE(SYS_bpf),
        REFUSE(SYS_perf_event_open),
        REFUSE(SYS_mount),
        REFUSE(SYS_unshare),
        REFUSE(SYS_setns),
        REFUSE(SYS_keyctl),
        REFUSE(SYS_add_key),
        REFUSE(SYS_userfaultfd),
#if defined(SYS_io_uring_setup) /* it makes calls that no filter sees */
        REFUSE(SYS_io_uring_setup),
#endif
#if defined(SYS_fork)
        REFUSE(SYS_fork),
        REFUSE(SYS_vfork),
#endif
#if defined(SYS_clone3) /* its flags are out of a filter's sight; the C library then takes clone */
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_clone3, 0, 1),
        ANSWER(ENOSYS),
#endif
        /* Threads may be, processes not. */
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_clone, 0, 3),
        LOAD(args[0]),
        BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, CLONE_THREAD, 1, 0),
        ANSWER(EPERM),
        ALLOW,
    };
    const struct sock_fprog program = {sizeof filter / sizeof *filter, filter};
    return prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0 ? NULL : "the kernel has no seccomp filters";
#else
    return "no filter is written for this processor";
#endif
}

const char *impact_runner_fence(impact_runner *runner)
{
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return "the kernel keeps programs' privileges";
    const char *why = close_files(runner);
    return why ? why : close_calls();
}

#endif
