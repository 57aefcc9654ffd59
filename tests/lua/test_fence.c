/* SPDX-License-Identifier: MIT
 *
 * What the kernel still allows a process within the runner's fence: its own folder, what the system holds, memory and
 * threads; no other file, no network, no other program. Each question is asked in a process of its own.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>
#include "kit/near.h"
#include "runner.h"

static char folder[] = "fence_XXXXXX";
static char outside[64], inside[64];

enum { NO_FENCE = 250 }; /* exit code */

static int opens(const char *path, int flags)
{
    const int file = open(path, flags | O_CLOEXEC, 0600);
    if (file >= 0) close(file);
    return file >= 0 ? 0 : errno;
}

/* ---- what is asked, within: 0, or errno ---- */

static int read_outside(void) { return opens(outside, O_RDONLY); }
static int write_outside(void) { return opens(outside, O_WRONLY); }
static int make_outside(void) { return opens("fence_made", O_WRONLY | O_CREAT); }
static int read_passwords(void) { return opens("/etc/passwd", O_RDONLY); }
static int remove_outside(void) { return unlink(outside) == 0 ? 0 : errno; }
static int rename_outside(void) { return rename(inside, "fence_made") == 0 ? 0 : errno; }
static int write_system(void) { return opens("/usr/fence_made", O_WRONLY | O_CREAT); }
static int reach_network(void) { return socket(AF_INET, SOCK_STREAM, 0) >= 0 ? 0 : errno; }
static int reach_neighbour(void) { return socket(AF_UNIX, SOCK_STREAM, 0) >= 0 ? 0 : errno; }
static int run_program(void) { return execl("/bin/true", "true", (char *)NULL), errno; }
static int make_process(void) { return syscall(SYS_clone, SIGCHLD, NULL, NULL, NULL, NULL) >= 0 ? 0 : errno; }
static int look_into_parent(void) { return ptrace(PTRACE_ATTACH, getppid(), NULL, NULL) == 0 ? 0 : errno; }

static int write_inside(void)
{
    char name[80];
    snprintf(name, sizeof name, "%s/new", folder);
    return opens(name, O_WRONLY | O_CREAT | O_TRUNC);
}

/* As the CSV files do: without a name, then with one, then with one that was taken. */
static int name_inside(void)
{
    char own[40], name[80], taken[80];
    snprintf(name, sizeof name, "%s/named", folder);
    snprintf(taken, sizeof taken, "%s/named2", folder);
    const int file = open(folder, O_TMPFILE | O_RDWR, 0600);
    if (file < 0) return errno == EOPNOTSUPP ? 0 : errno; /* not on every file system */
    snprintf(own, sizeof own, "/proc/self/fd/%d", file);
    if (linkat(AT_FDCWD, own, AT_FDCWD, name, AT_SYMLINK_FOLLOW) != 0) return errno;
    return rename(name, taken) == 0 ? 0 : errno;
}

static int read_system(void) { return opens("/usr", O_RDONLY | O_DIRECTORY); }
static void *nothing(void *context) { return context; }

static int make_thread(void)
{
    pthread_t thread;
    const int error = pthread_create(&thread, NULL, nothing, NULL);
    return error ? error : pthread_join(thread, NULL);
}

static int take_memory(void)
{
    void *block = malloc((size_t)64 << 20);
    free(block);
    return block ? 0 : ENOMEM;
}

/* ---- the asking ---- */

static int answer_within(int (*ask)(void))
{
    const pid_t child = fork();
    if (child == 0) {
        impact_runner runner = {.folder = open(folder, O_RDONLY | O_DIRECTORY)};
        const char *why = impact_runner_fence(&runner);
        if (why) fprintf(stderr, "no fence: %s\n", why);
        _exit(why ? NO_FENCE : ask());
    }
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

static void the_fence_holds(void **state)
{
    static int (*const refused[])(void) = {read_outside,    write_outside,  make_outside, read_passwords,
                                           remove_outside,  rename_outside, write_system, reach_network,
                                           reach_neighbour, run_program,    make_process, look_into_parent};
    static int (*const allowed[])(void) = {write_inside, name_inside, read_system, make_thread, take_memory};
    (void)state;
    if (answer_within(take_memory) == NO_FENCE) skip();
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        const int error = answer_within(refused[i]);
        if (error != EACCES && error != EPERM && error != EXDEV)
            fail_msg("question %zu: %s", i, error ? strerror(error) : "allowed");
    }
    for (size_t i = 0; i < sizeof allowed / sizeof *allowed; i++) {
        const int error = answer_within(allowed[i]);
        if (error) fail_msg("question %zu: %s", i, strerror(error));
    }
    assert_int_equal(access(outside, F_OK), 0);
    assert_int_equal(access(inside, F_OK), 0);
}

static int make(void **state)
{
    (void)state;
    if (!mkdtemp(folder)) return -1;
    snprintf(outside, sizeof outside, "%s_outside", folder);
    snprintf(inside, sizeof inside, "%s/inside", folder);
    return opens(outside, O_WRONLY | O_CREAT) || opens(inside, O_WRONLY | O_CREAT);
}

static int take_away(void **state)
{
    (void)state;
    static const char *const names[] = {"inside", "new", "named", "named2"};
    char path[80];
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        remove(path);
    }
    remove(outside);
    return rmdir(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test_setup_teardown(the_fence_holds, make, take_away)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
