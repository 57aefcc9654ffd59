/* SPDX-License-Identifier: MIT
 *
 * IMP_OUT_NAMED leaves O_TMPFILE aside, for the test of what serves where there is none.
 */
#if defined(__linux__)
#define _GNU_SOURCE
#endif
#include "base/out_file.h"

#include <errno.h>
#include <string.h>

#if defined(__unix__) || defined(__APPLE__)
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

#if !defined(EDQUOT) /* Windows has no quotas */
#define EDQUOT ENOSPC
#endif

enum { BUFFER = 65536 }; /* bytes */

#if defined(__unix__) || defined(__APPLE__)

/* A file without a name in the folder of the path; -1 where the system or the folder's file system has none. */
static int open_nameless(const char *path, char *folder)
{
#if defined(O_TMPFILE) && !defined(IMP_OUT_NAMED)
    const char *slash = strrchr(path, '/');
    const size_t length = slash ? (size_t)(slash - path) : 0;
    memcpy(folder, path, length);
    strcpy(folder + length, length ? "" : slash ? "/" : ".");
    /* What gives it its name: see imp_out_give_name. */
    return access("/proc/self/fd", X_OK) == 0 ? open(folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0666) : -1;
#else
    (void)path, (void)folder;
    return -1;
#endif
}

/* Never through a link that lies there. */
static int open_part(const char *part)
{
    unlink(part);
    return open(part, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
}

static FILE *open_stream(imp_out_file *f)
{
    int stream = open_nameless(f->path, f->part);
    f->nameless = stream >= 0;
    strcpy(f->part, f->path);
    strcat(f->part, ".part");
    if (stream < 0) stream = open_part(f->part);
    if (stream < 0) return NULL;
    f->descriptor = fcntl(stream, F_DUPFD_CLOEXEC, 0);
    FILE *file = f->descriptor >= 0 ? fdopen(stream, "wb") : NULL;
    if (file) return file;
    const int error = errno;
    if (f->descriptor >= 0) close(f->descriptor);
    f->descriptor = -1;
    close(stream);
    if (!f->nameless) unlink(f->part);
    return errno = error, NULL;
}

/* To the end of the last whole line. */
static bool trim_lines(int descriptor)
{
    char text[4096];
    off_t end = lseek(descriptor, 0, SEEK_END);
    while (end > 0) {
        const off_t from = end > (off_t)sizeof text ? end - (off_t)sizeof text : 0;
        ssize_t i = pread(descriptor, text, (size_t)(end - from), from);
        if (i < end - from) return false;
        while (i > 0 && text[i - 1] != '\n') i--;
        if (i > 0) return ftruncate(descriptor, from + i) == 0;
        end = from;
    }
    return false;
}

static bool link_name(const imp_out_file *f, const char *path)
{
#if defined(O_TMPFILE)
    char own[40];
    snprintf(own, sizeof own, "/proc/self/fd/%d", f->descriptor);
    return linkat(AT_FDCWD, own, AT_FDCWD, path, AT_SYMLINK_FOLLOW) == 0;
#else
    (void)f, (void)path;
    return false;
#endif
}

static void close_descriptor(int descriptor) { close(descriptor); }

#else /* C alone */

static FILE *open_stream(imp_out_file *f)
{
    strcpy(f->part, f->path);
    strcat(f->part, ".part");
    return fopen(f->part, "wb");
}
static bool trim_lines(int descriptor) { return (void)descriptor, false; }
static bool link_name(const imp_out_file *f, const char *path) { return (void)f, (void)path, false; }
static void close_descriptor(int descriptor) { (void)descriptor; }

#endif

bool imp_out_open(imp_out_file *f, imp_arena *arena, const char *path, impact_quota *quota)
{
    *f = (imp_out_file){.descriptor = -1, .quota = quota};
    f->path = imp_arena_copy(arena, path);
    f->part = imp_arena_take(arena, strlen(path) + sizeof ".part", 1);
    char *buffer = imp_arena_take(arena, BUFFER, 1);
    if (!f->path || !f->part || !buffer) return errno = ENOMEM, false;
    f->file = open_stream(f);
    if (!f->file) return false;
    setvbuf(f->file, buffer, _IOFBF, BUFFER);
    return true;
}

bool imp_out_put(imp_out_file *f, const char *text, size_t size)
{
    if (f->quota && size > f->quota->left) return f->quota->spent = true, errno = EDQUOT, false;
    if (f->quota) f->quota->left -= size;
    return fwrite(text, 1, size, f->file) == size;
}

bool imp_out_finish(imp_out_file *f, bool trim)
{
    if (!f->file) return true;
    const bool good = fflush(f->file) == 0 && !ferror(f->file);
    const int error = errno;
    const bool closed = fclose(f->file) == 0;
    f->file = NULL;
    if (!good) errno = error;
    const bool whole = good && closed, broken_off = f->quota && f->quota->spent;
    return trim && (!whole || broken_off) ? trim_lines(f->descriptor) : whole;
}

bool imp_out_give_name(imp_out_file *f, const char *path)
{
    if (!f->path) return true;
    if (f->nameless && !link_name(f, path)) {
        if (errno != EEXIST) return false;
        remove(f->part);
        if (!link_name(f, f->part)) return false;
        f->nameless = false;
    } else if (f->nameless) {
        return true;
    }
    return rename(f->part, path) == 0;
}

void imp_out_close(imp_out_file *f)
{
    if (f->file) fclose(f->file);
    if (f->descriptor >= 0) close_descriptor(f->descriptor);
    if (f->part && !f->nameless && f->part[0]) remove(f->part);
    *f = (imp_out_file){.descriptor = -1};
}
