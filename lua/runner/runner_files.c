/* SPDX-License-Identifier: MIT
 *
 * The output folder. Every file is reached from the folder's descriptor, component by component, without following
 * links.
 */
#define _GNU_SOURCE
#include "runner.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* mkdir -p; the user's own --out may lead through links. */
static bool make_folder(const char *path)
{
    char part[4096];
    struct stat status;
    if (strlen(path) >= sizeof part) return errno = ENAMETOOLONG, false;
    for (size_t i = 0; path[i]; i++) {
        part[i] = path[i], part[i + 1] = 0;
        if (i > 0 && path[i] == '/') {
            part[i] = 0;
            if (mkdir(part, 0777) != 0 && errno != EEXIST) return false;
            part[i] = '/';
        }
    }
    if (mkdir(path, 0777) != 0 && errno != EEXIST) return false;
    return stat(path, &status) == 0 && (S_ISDIR(status.st_mode) || (errno = ENOTDIR, false));
}

bool impact_runner_open_folder(impact_runner *runner, char *message, size_t size)
{
    if (runner->folder >= 0) return true;
    errno = runner->folder_error;
    if (!runner->folder_error && make_folder(runner->directory))
        runner->folder = open(runner->directory, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (runner->folder >= 0 && faccessat(runner->folder, ".", W_OK | X_OK, 0) == 0) return true;
    const int error = errno;
    snprintf(message, size, "cannot write to the folder '%.300s': %s", runner->directory, strerror(error));
    if (runner->folder >= 0) close(runner->folder);
    runner->folder = -1;
    errno = error;
    return false;
}

void impact_runner_open_folder_early(impact_runner *runner)
{
    char message[400];
    if (!impact_runner_open_folder(runner, message, sizeof message)) runner->folder_error = errno;
}

void impact_runner_leave_folder(const impact_runner *runner)
{
    if (runner->folder_made) rmdir(runner->directory); /* unless something is in it */
}

bool impact_runner_is_plain(const char *name)
{
    const size_t length = strlen(name);
    if (length == 0 || length > 200 || name[0] == '.') return false;
    for (size_t i = 0; i < length; i++)
        if (name[i] == '/' || (unsigned char)name[i] < 32 || name[i] == 127) return false;
    return true;
}

bool impact_runner_write(int file, const char *text, size_t size)
{
    while (size > 0) {
        const ssize_t written = write(file, text, size);
        if (written < 0 && errno != EINTR) return false;
        if (written > 0) text += written, size -= (size_t)written;
    }
    return true;
}

int impact_runner_open_file(impact_runner *runner, const char *path, int flags)
{
    char message[16];
    struct stat status;
    if (!impact_runner_open_folder(runner, message, sizeof message)) return -1;
    int folder = dup(runner->folder);
    while (folder >= 0) {
        char name[256];
        const size_t length = strcspn(path, "/");
        const bool last = path[length] == 0;
        int next = -1;
        if (length >= sizeof name)
            errno = ENAMETOOLONG;
        else if (length == 0 || strncmp(path, ".", length) == 0 || (length == 2 && strncmp(path, "..", 2) == 0))
            errno = EACCES;
        else {
            memcpy(name, path, length), name[length] = 0;
            next = openat(folder, name, (last ? flags | O_NONBLOCK : O_RDONLY | O_DIRECTORY) | O_NOFOLLOW | O_CLOEXEC,
                          0666);
        }
        const int error = errno;
        close(folder);
        if (next < 0) return errno = error == ELOOP ? EACCES : error, -1;
        if (last) {
            /* Devices, pipes and folders are not files of ours; more than one name may lead out of the folder. */
            if (fstat(next, &status) == 0 && S_ISREG(status.st_mode) && status.st_nlink <= 1) return next;
            close(next);
            return errno = EACCES, -1;
        }
        folder = next;
        path += length + 1;
    }
    return -1;
}

/* ---- files that have a name only when they are whole ---- */

static void part_of(const char *name, char part[256]) { snprintf(part, 256, "%s.part", name); }

int impact_runner_new_file(impact_runner *runner, const char *name, bool *nameless)
{
    char part[256];
    int file = -1;
    runner->used = true;
#if defined(O_TMPFILE)
    if (access("/proc/self/fd", X_OK) == 0) file = openat(runner->folder, ".", O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
#endif
    *nameless = file >= 0;
    if (file >= 0) return file;
    part_of(name, part);
    unlinkat(runner->folder, part, 0);
    return impact_runner_open_file(runner, part, O_RDWR | O_CREAT | O_EXCL);
}

static bool link_file(const impact_runner *runner, int file, const char *name)
{
    char own[40];
    snprintf(own, sizeof own, "/proc/self/fd/%d", file);
    return linkat(AT_FDCWD, own, runner->folder, name, AT_SYMLINK_FOLLOW) == 0;
}

bool impact_runner_finish_file(impact_runner *runner, int file, bool nameless, const char *name, bool keep)
{
    char part[256];
    part_of(name, part);
    if (keep && nameless) {
        if (link_file(runner, file, name)) return true;
        if (errno != EEXIST) return false;
        unlinkat(runner->folder, part, 0);
        if (!link_file(runner, file, part)) return false;
    }
    if (keep && renameat(runner->folder, part, runner->folder, name) == 0) return true;
    const int error = errno;
    unlinkat(runner->folder, part, 0);
    errno = error;
    return false;
}

/* ---- the quota ---- */

bool impact_runner_spend(impact_runner *runner, unsigned long long bytes)
{
    if (bytes > runner->quota.left) return runner->quota.spent = true, errno = EDQUOT, false;
    runner->quota.left -= bytes;
    return true;
}

#if defined(__linux__)

typedef struct counted {
    impact_runner *runner;
    int file;
} counted;

static ssize_t read_counted(void *cookie, char *buffer, size_t size)
{
    return read(((counted *)cookie)->file, buffer, size);
}

static ssize_t write_counted(void *cookie, const char *buffer, size_t size)
{
    const counted *c = cookie;
    if (!impact_runner_spend(c->runner, size)) return 0;
    const ssize_t written = write(c->file, buffer, size);
    return written < 0 ? 0 : written; /* as fopencookie wants it */
}

static int seek_counted(void *cookie, off64_t *offset, int whence)
{
    const off_t at = lseek(((counted *)cookie)->file, *offset, whence);
    if (at >= 0) *offset = at;
    return at >= 0 ? 0 : -1;
}

static int close_counted(void *cookie)
{
    const int closed = close(((counted *)cookie)->file);
    free(cookie);
    return closed;
}

FILE *impact_runner_count_writes(impact_runner *runner, int file, const char *mode)
{
    const cookie_io_functions_t functions = {read_counted, write_counted, seek_counted, close_counted};
    counted *c = malloc(sizeof *c);
    FILE *stream = NULL;
    if (c) *c = (counted){runner, file}, stream = fopencookie(c, mode, functions);
    if (c && !stream) free(c);
    return stream;
}

#else /* counted where a file is closed, and each bounded by RLIMIT_FSIZE */

FILE *impact_runner_count_writes(impact_runner *runner, int file, const char *mode)
{
    (void)runner;
    return fdopen(file, mode);
}

#endif

/* ---- io.open ---- */

/* The path below the folder: as given when relative, what follows "DIRECTORY/" when it starts so; NULL: outside. */
static const char *below(const impact_runner *runner, const char *path)
{
    const size_t length = strlen(runner->directory);
    if (strncmp(path, runner->directory, length) == 0 && path[length] == '/') return path + length + 1;
    return path[0] == '/' ? NULL : path;
}

static int flags_of(const char *mode)
{
    const bool update = strchr(mode, '+') != NULL;
    switch (mode[0]) {
    case 'w': return (update ? O_RDWR : O_WRONLY) | O_CREAT | O_TRUNC;
    case 'a': return (update ? O_RDWR : O_WRONLY) | O_CREAT | O_APPEND;
    default: return update ? O_RDWR : O_RDONLY;
    }
}

static int close_stream(lua_State *L)
{
    luaL_Stream *stream = luaL_checkudata(L, 1, LUA_FILEHANDLE);
    const int closed = fclose(stream->f);
    return luaL_fileresult(L, closed == 0, NULL);
}

int impact_runner_io_open(lua_State *L)
{
    impact_runner *runner = lua_touserdata(L, lua_upvalueindex(1));
    size_t length;
    const char *path = luaL_checklstring(L, 1, &length), *mode = luaL_optstring(L, 2, "r");
    const size_t letters = strspn(mode, "rwa");
    luaL_argcheck(L, letters == 1 && strspn(mode + 1, "+b") == strlen(mode + 1) && strlen(mode) <= 3, 2,
                  "invalid mode");
    const char *inside = strlen(path) == length ? below(runner, path) : NULL;
    luaL_Stream *stream = lua_newuserdatauv(L, sizeof *stream, 0);
    stream->closef = NULL;
    luaL_setmetatable(L, LUA_FILEHANDLE);
    if (inside) {
        const int file = impact_runner_open_file(runner, inside, flags_of(mode) & ~O_TRUNC);
        /* Truncated only when it is known to be a plain file of the folder. */
        const bool fresh = file >= 0 && (mode[0] != 'w' || ftruncate(file, 0) == 0);
        stream->f = fresh ? impact_runner_count_writes(runner, file, mode) : NULL;
        if (file >= 0 && !stream->f) close(file);
    } else {
        errno = EACCES;
        stream->f = NULL;
    }
    if (!stream->f) {
        lua_pushnil(L);
        lua_pushfstring(L, "%s: %s", path,
                        errno == EACCES ? "outside the output folder (see --trust)" : strerror(errno));
        lua_pushinteger(L, errno);
        return 3;
    }
    stream->closef = close_stream;
    return 1;
}
