/* SPDX-License-Identifier: MIT
 *
 * For LD_PRELOAD: of the process's calls of the system below, or of those named FAIL_ONLY, number FAIL_AT is answered
 * with an error (FAIL_WITH, or EIO); FAIL_COUNT puts their number on stderr at the end. FAIL_CLOCK: the clock that is
 * read goes so many times as fast. FAIL_TTY: every descriptor is a terminal. A child that is
 * forked goes on counting; a program that is started is left alone.
 */
#define _GNU_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static long count, fail_at;
static int ready, ended, wanted = EIO;
static const char *only;

static int fails(const char *name)
{
    if (!ready) {
        const char *at = getenv("FAIL_AT"), *with = getenv("FAIL_WITH");
        ready = 1;
        fail_at = at ? atol(at) : 0;
        if (with) wanted = atoi(with);
        only = getenv("FAIL_ONLY");
    }
    if (ended || (only && strcmp(only, name) != 0) || ++count != fail_at) return 0;
    errno = wanted;
    return 1;
}

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

#define REFUSED(type, bad, name, parameters, arguments)                                                                \
    type name parameters { return fails(#name) ? (bad) : REAL(name) arguments; }

static mode_t mode_of(int flags, va_list rest) { return flags & (O_CREAT | O_TMPFILE) ? va_arg(rest, mode_t) : 0; }

/* The counts of coverage are written at the end: they are not the program's. */
static int is_count(const char *path)
{
    const size_t length = strlen(path);
    if (length > 5 && strcmp(path + length - 5, ".gcda") == 0) ended = 1;
    return ended;
}

int open(const char *path, int flags, ...)
{
    va_list rest;
    va_start(rest, flags);
    const mode_t mode = mode_of(flags, rest);
    va_end(rest);
    return !is_count(path) && fails(__func__) ? -1 : REAL(open)(path, flags, mode);
}

int openat(int folder, const char *path, int flags, ...)
{
    va_list rest;
    va_start(rest, flags);
    const mode_t mode = mode_of(flags, rest);
    va_end(rest);
    return fails(__func__) ? -1 : REAL(openat)(folder, path, flags, mode);
}

/* What is refused is closed all the same, as Linux does. */
int close(int file)
{
    const int refused = fails(__func__), closed = REAL(close)(file);
    return refused ? errno = wanted, -1 : closed;
}

int fflush(FILE *file)
{
    const int refused = fails(__func__), flushed = REAL(fflush)(file);
    return refused ? errno = wanted, EOF : flushed;
}

int fclose(FILE *file)
{
    const int refused = fails(__func__), closed = REAL(fclose)(file);
    return refused ? errno = wanted, EOF : closed;
}

/* The stream remembers, as ferror tells (glibc: _IO_ERR_SEEN). */
static size_t none_of(FILE *file)
{
    file->_flags |= 0x20;
    return 0;
}

size_t fwrite(const void *from, size_t size, size_t number, FILE *file)
{
    return fails(__func__) ? none_of(file) : REAL(fwrite)(from, size, number, file);
}

size_t fread(void *to, size_t size, size_t number, FILE *file)
{
    return fails(__func__) ? none_of(file) : REAL(fread)(to, size, number, file);
}

int isatty(int file) { return getenv("FAIL_TTY") != NULL || REAL(isatty)(file); }

/* Its errors are what it returns. */
int pthread_create(pthread_t *thread, const pthread_attr_t *with, void *(*run)(void *), void *of)
{
    return fails(__func__) ? wanted : REAL(pthread_create)(thread, with, run, of);
}

int clock_gettime(clockid_t clock, struct timespec *now)
{
    const int answer = REAL(clock_gettime)(clock, now);
    const char *faster = clock == CLOCK_MONOTONIC ? getenv("FAIL_CLOCK") : NULL;
    if (answer != 0 || !faster) return answer;
    static struct timespec first;
    if (first.tv_sec == 0) first = *now;
    const double passed =
        atof(faster) * ((double)(now->tv_sec - first.tv_sec) + 1e-9 * (double)(now->tv_nsec - first.tv_nsec));
    now->tv_sec = first.tv_sec + (time_t)passed;
    now->tv_nsec = (long)(1e9 * (passed - (double)(time_t)passed));
    return answer;
}

REFUSED(int, -1, memfd_create, (const char *name, unsigned flags), (name, flags))
REFUSED(ssize_t, -1, readlink, (const char *path, char *to, size_t size), (path, to, size))
REFUSED(void *, NULL, dlopen, (const char *path, int how), (path, how))
REFUSED(int, -1, fseek, (FILE * file, long offset, int whence), (file, offset, whence))
REFUSED(long, -1, ftell, (FILE * file), (file))
REFUSED(int, -1, fstatat, (int folder, const char *path, struct stat *status, int flags), (folder, path, status, flags))
REFUSED(int, -1, unlinkat, (int folder, const char *path, int flags), (folder, path, flags))
REFUSED(DIR *, NULL, fdopendir, (int file), (file))
REFUSED(int, -1, setitimer, (__itimer_which_t which, const struct itimerval *now, struct itimerval *before),
        (which, now, before))
REFUSED(int, -1, dup, (int file), (file))
REFUSED(int, -1, dup2, (int from, int to), (from, to))
REFUSED(int, -1, fstat, (int file, struct stat *status), (file, status))
REFUSED(int, -1, stat, (const char *path, struct stat *status), (path, status))
REFUSED(int, -1, access, (const char *path, int how), (path, how))
REFUSED(int, -1, faccessat, (int folder, const char *path, int how, int flags), (folder, path, how, flags))
REFUSED(int, -1, mkdir, (const char *path, mode_t mode), (path, mode))
REFUSED(int, -1, linkat, (int a, const char *from, int b, const char *to, int flags), (a, from, b, to, flags))
REFUSED(int, -1, renameat, (int a, const char *from, int b, const char *to), (a, from, b, to))
REFUSED(int, -1, ftruncate, (int file, off_t size), (file, size))
REFUSED(off_t, -1, lseek, (int file, off_t offset, int whence), (file, offset, whence))
REFUSED(ssize_t, -1, write, (int file, const void *from, size_t size), (file, from, size))
REFUSED(ssize_t, -1, read, (int file, void *to, size_t size), (file, to, size))
REFUSED(FILE *, NULL, fdopen, (int file, const char *mode), (file, mode))
REFUSED(FILE *, NULL, fopen, (const char *path, const char *mode), (path, mode))
REFUSED(FILE *, NULL, tmpfile, (void), ())
REFUSED(FILE *, NULL, fopencookie, (void *cookie, const char *mode, cookie_io_functions_t f), (cookie, mode, f))
REFUSED(int, -1, socketpair, (int domain, int type, int protocol, int ends[2]), (domain, type, protocol, ends))
REFUSED(ssize_t, -1, sendmsg, (int link, const struct msghdr *message, int flags), (link, message, flags))
REFUSED(ssize_t, -1, recvmsg, (int link, struct msghdr *message, int flags), (link, message, flags))
REFUSED(ssize_t, -1, send, (int link, const void *from, size_t size, int flags), (link, from, size, flags))
REFUSED(ssize_t, -1, recv, (int link, void *to, size_t size, int flags), (link, to, size, flags))
REFUSED(pid_t, -1, fork, (void), ())
REFUSED(pid_t, -1, waitpid, (pid_t child, int *status, int options), (child, status, options))
REFUSED(int, -1, getrlimit, (__rlimit_resource_t which, struct rlimit *limit), (which, limit))
REFUSED(int, -1, setrlimit, (__rlimit_resource_t which, const struct rlimit *limit), (which, limit))
REFUSED(int, -1, sigaction, (int number, const struct sigaction *now, struct sigaction *before), (number, now, before))

__attribute__((constructor)) static void keep_to_myself(void) { unsetenv("LD_PRELOAD"); }

__attribute__((destructor)) static void tell(void)
{
    if (getenv("FAIL_COUNT")) dprintf(STDERR_FILENO, "%ld\n", count);
}
