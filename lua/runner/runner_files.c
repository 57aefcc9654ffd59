/* SPDX-License-Identifier: MIT
 *
 * The output folder. Every file is reached from the folder's descriptor, component by component, without following
 * links.
 */
#define _XOPEN_SOURCE 700
#include "runner.h"

#include <errno.h>
#include <fcntl.h>
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
    if (make_folder(runner->directory)) runner->folder = open(runner->directory, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (runner->folder >= 0 && faccessat(runner->folder, ".", W_OK | X_OK, 0) == 0) return true;
    snprintf(message, size, "cannot write to the folder '%s': %s", runner->directory, strerror(errno));
    if (runner->folder >= 0) close(runner->folder);
    runner->folder = -1;
    return false;
}

bool impact_runner_is_plain(const char *name)
{
    const size_t length = strlen(name);
    if (length == 0 || length > 200 || name[0] == '.') return false;
    for (size_t i = 0; i < length; i++)
        if (name[i] == '/' || (unsigned char)name[i] < 32 || name[i] == 127) return false;
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

bool impact_runner_finish_file(impact_runner *runner, const char *name, bool keep)
{
    char part[256];
    snprintf(part, sizeof part, "%s.part", name);
    if (keep && renameat(runner->folder, part, runner->folder, name) == 0) return true;
    const int error = errno;
    unlinkat(runner->folder, part, 0);
    errno = error;
    return false;
}

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
        stream->f = fresh ? fdopen(file, mode) : NULL;
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
