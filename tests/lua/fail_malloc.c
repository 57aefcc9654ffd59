/* SPDX-License-Identifier: MIT
 *
 * For LD_PRELOAD: of the process's allocations number FAIL_AT fails, and all after it unless FAIL_ONCE is set;
 * FAIL_COUNT puts their number on stderr at the end. For this process alone, not for those that it starts.
 *
 * FAIL_EACH=N: at each Nth allocation the process is doubled. In the double it fails, and all after it (each hundredth
 * alone); the process waits for how the double ends, and goes on. At the end a line on stderr: "each N refused R
 * signals S", N doubles, of them R that ended with an exit code other than 0, and S by a signal. Told at once are
 * doubles that hang, exit codes but 0, 1, 4 and 5, and such as end so without one line on stderr.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *block, size_t size);
int __libc_start_main(int (*main)(int, char **, char **), int count_of_words, char **words, void (*init)(void),
                      void (*fini)(void), void (*loader_fini)(void), void *stack_end);
void fail_malloc_end(void); /* kit/exit_measured.c asks for it */

enum { LONGEST = 20 }; /* s */

static long count, fail_at, refused, signals;
static long doubling; /* N */
static int once, ready, busy, done;
static pid_t first;

/* How a double ended; its words are in the file. */
static void judge(int status, int words)
{
    char text[400];
    const ssize_t length = pread(words, text, sizeof text - 1, 0);
    text[length > 0 ? length : 0] = 0;
    const char *end = strchr(text, '\n');
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1, one_line = end && !end[1];
    refused += code > 0;
    signals += code < 0;
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM) dprintf(STDERR_FILENO, "allocation %ld: hangs\n", count);
    if (code > 0 && (!one_line || !strchr("\1\4\5", code)))
        dprintf(STDERR_FILENO, "allocation %ld: exit code %d: %s\n", count, code, text);
}

/* Files that are open get twins, with what is in them and the same place: what the double reads and writes is its own.
 */
static void part_files(void)
{
    static char text[65536];
    struct stat status;
    for (int file = 3; file < 32; file++) {
        if (fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) continue;
        const int twin = memfd_create("twin", 0);
        off_t at = 0;
        for (ssize_t n; (n = pread(file, text, sizeof text, at)) > 0; at += n)
            if (write(twin, text, (size_t)n) != n) _exit(99);
        lseek(twin, lseek(file, 0, SEEK_CUR), SEEK_SET);
        dup2(twin, file);
        close(twin);
    }
}

/* Whether this is the double. */
static int is_double(void)
{
    const int words = memfd_create("words", 0);
    const pid_t child = words < 0 ? -1 : fork();
    if (child == 0) {
        doubling = 0;
        once = count % 100 == 0;
        fail_at = count;
        dup2(words, STDERR_FILENO);
        part_files();
        alarm(LONGEST);
        return 1;
    }
    int status;
    if (child < 0 || waitpid(child, &status, 0) != child)
        dprintf(STDERR_FILENO, "allocation %ld: no double\n", count);
    else
        judge(status, words);
    close(words);
    return 0;
}

static int fails(void)
{
    if (!ready) {
        const char *at = getenv("FAIL_AT");
        ready = 1;
        first = getpid();
        fail_at = at ? atol(at) : 0;
        once = getenv("FAIL_ONCE") != NULL;
        const char *each = getenv("FAIL_EACH");
        doubling = each ? atol(each) : 0;
    }
    if (busy || done) return 0;
    count++;
    if (doubling && count % doubling == 0 && getpid() == first) {
        busy = 1;
        const int here = is_double();
        busy = 0;
        return here;
    }
    const int refused_now = fail_at > 0 && (once ? count == fail_at : count >= fail_at);
    if (refused_now) errno = ENOMEM; /* pthread_create asserts it */
    return refused_now;
}

void *malloc(size_t size) { return fails() ? NULL : __libc_malloc(size); }
void *calloc(size_t number, size_t size) { return fails() ? NULL : __libc_calloc(number, size); }
void *realloc(void *block, size_t size) { return fails() ? NULL : __libc_realloc(block, size); }

/* What writes down which branches were taken (gcov), after all that the program does, is not the program's, and has no
 * answer to a refusal. */
void fail_malloc_end(void) { done = 1; }

static int (*program)(int, char **, char **);

static int begin(int count_of_words, char **words, char **environment)
{
    busy = 1; /* atexit may allocate */
    atexit(fail_malloc_end);
    busy = 0;
    return program(count_of_words, words, environment);
}

/* Before the program's main, behind all that its libraries left to be done at its end. */
int __libc_start_main(int (*main)(int, char **, char **), int count_of_words, char **words, void (*init)(void),
                      void (*fini)(void), void (*loader_fini)(void), void *stack_end)
{
    program = main;
    return ((__typeof__(&__libc_start_main))dlsym(RTLD_NEXT, "__libc_start_main"))(begin, count_of_words, words, init,
                                                                                   fini, loader_fini, stack_end);
}

__attribute__((constructor)) static void keep_to_myself(void) { unsetenv("LD_PRELOAD"); }

__attribute__((destructor)) static void tell(void)
{
    const long total = count;
    if (getenv("FAIL_COUNT")) fprintf(stderr, "%ld\n", total);
    if (doubling && getpid() == first)
        dprintf(STDERR_FILENO, "each %ld refused %ld signals %ld\n", total / doubling, refused, signals);
}
