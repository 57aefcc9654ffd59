/* SPDX-License-Identifier: MIT
 *
 * Pictures: by gnuplot, and with --pictures as a page, too. A script describes a figure as plain data; the data is
 * copied into a Lua state of our own, which no script has touched, and there becomes gnuplot's commands. gnuplot starts
 * without a shell, reads the commands from a file without a name and writes the picture to a descriptor of ours.
 */
#define _GNU_SOURCE
#include "runner.h"

#include <errno.h>
#include <fcntl.h>
#include <lualib.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

/* ---- plain data from one state to another ---- */

enum { DEEPEST = 12 };

/* Protected in `to`. */
static int push_string(lua_State *to)
{
    const char *text = lua_touserdata(to, 1);
    lua_pushlstring(to, text, *(size_t *)lua_touserdata(to, 2));
    return 1;
}

static int push_table(lua_State *to) { return lua_newtable(to), 1; }
static int set_entry(lua_State *to) { return lua_rawset(to, 1), 0; }

/* Pushes a copy of the value at index of `from` onto `to`; NULL, or what is wrong. Raises in neither state: `to` is
 * worked in protected calls, and `from` is only read. */
static const char *copy(lua_State *from, int index, lua_State *to, int depth)
{
    if (depth > DEEPEST) return "a figure's tables are nested too deep";
    if (!lua_checkstack(from, 8) || !lua_checkstack(to, 8)) return "not enough memory";
    index = lua_absindex(from, index);
    switch (lua_type(from, index)) {
    case LUA_TNUMBER: lua_pushnumber(to, lua_tonumber(from, index)); return NULL;
    case LUA_TBOOLEAN: lua_pushboolean(to, lua_toboolean(from, index)); return NULL;
    case LUA_TSTRING: {
        size_t length;
        const char *text = lua_tolstring(from, index, &length);
        lua_pushcfunction(to, push_string);
        lua_pushlightuserdata(to, (void *)text);
        lua_pushlightuserdata(to, &length);
        return lua_pcall(to, 2, 1, 0) == LUA_OK ? NULL : "not enough memory";
    }
    case LUA_TTABLE: break;
    default: return "a figure holds numbers, strings and tables only";
    }
    lua_pushcfunction(to, push_table);
    if (lua_pcall(to, 0, 1, 0) != LUA_OK) return "not enough memory";
    const int table = lua_gettop(to);
    for (lua_pushnil(from); lua_next(from, index); lua_pop(from, 1)) {
        lua_pushcfunction(to, set_entry);
        lua_pushvalue(to, table);
        /* A number that is a whole one stands for a place in a list. */
        const char *wrong = NULL;
        if (lua_isinteger(from, -2))
            lua_pushinteger(to, lua_tointeger(from, -2));
        else if (lua_type(from, -2) == LUA_TSTRING)
            wrong = copy(from, -2, to, depth + 1);
        else
            wrong = "a figure's tables have names or places as keys";
        if (!wrong) wrong = copy(from, -1, to, depth + 1);
        if (!wrong && lua_pcall(to, 3, 0, 0) != LUA_OK) wrong = "not enough memory";
        if (wrong) return lua_pop(from, 2), wrong;
    }
    return NULL;
}

/* ---- gnuplot's commands ---- */

static const char page_form[] = "figure.html";

static void load_module(lua_State *to, const char *name)
{
    impact_runner_load_layer(to, name);
    lua_call(to, 0, 1);
    luaL_getsubtable(to, LUA_REGISTRYINDEX, LUA_LOADED_TABLE);
    lua_pushvalue(to, -2);
    lua_setfield(to, -2, name);
    lua_pop(to, 1);
}

/* Protected: (FILE *, figure, form); nothing is written of a figure that has not this form. */
static int write_commands(lua_State *to)
{
    FILE *file = lua_touserdata(to, 1);
    const char *form = lua_touserdata(to, 3);
    size_t length;
    luaL_openlibs(to);
    load_module(to, "quat.gnuplot");
    if (strcmp(form, page_form) == 0) {
        load_module(to, "quat.page_template");
        load_module(to, "quat.page");
    }
    lua_getfield(to, -1, "commands");
    lua_pushvalue(to, 2);
    lua_pushnil(to);
    lua_pushstring(to, form);
    lua_call(to, 3, 1);
    if (lua_isnil(to, -1)) return 0;
    const char *text = luaL_checklstring(to, -1, &length);
    if (fwrite(text, 1, length, file) != length || fflush(file) != 0)
        return luaL_error(to, "cannot write gnuplot's commands");
    rewind(file);
    return 0;
}

static bool make_commands(lua_State *L, int index, impact_runner *runner, const char *form, FILE *file, char *message,
                          size_t size)
{
    lua_State *to = lua_newstate(impact_runner_allocate, runner);
    if (!to) return snprintf(message, size, "not enough memory"), false;
    lua_pushcfunction(to, write_commands);
    lua_pushlightuserdata(to, file);
    const char *wrong = lua_istable(L, index) ? copy(L, index, to, 0) : NULL;
    char type[80];
    if (!lua_istable(L, index)) {
        snprintf(type, sizeof type, "a figure is made with plot.figure; this is a %s", luaL_typename(L, index));
        wrong = type;
    }
    if (!wrong) lua_pushlightuserdata(to, (void *)form);
    if (!wrong && lua_pcall(to, 3, 0, 0) != LUA_OK) {
        const char *text = lua_tostring(to, -1);
        const char *plain =
            text && strncmp(text, "quat.gnuplot:", 13) == 0 ? strchr(text, ' ') : NULL; /* not our line number */
        wrong = plain ? plain + 1 : text ? text : "it cannot be drawn";
    }
    if (wrong) snprintf(message, size, "%s", wrong);
    lua_close(to);
    return wrong == NULL;
}

/* ---- the picture ---- */

/* A file without a name for what is told to gnuplot, and for what it says. */
static FILE *scratch_file(void)
{
#if defined(__linux__)
    const int file = memfd_create("gnuplot", MFD_CLOEXEC); /* the fence leaves no folder but the output's */
    FILE *stream = file >= 0 ? fdopen(file, "w+") : NULL;
    if (file >= 0 && !stream) close(file);
    return stream;
#else
    return tmpfile();
#endif
}

/* The last line that gnuplot had to say, without its caret. */
static void last_complaint(FILE *complaints, char *message, size_t size)
{
    char line[300];
    snprintf(message, size, "gnuplot failed");
    rewind(complaints);
    while (fgets(line, sizeof line, complaints)) {
        line[strcspn(line, "\r\n")] = 0;
        if (strspn(line, " \t^") < strlen(line)) snprintf(message, size, "gnuplot: %s", line);
    }
}

/* 0, or IMPACT_NO_PROGRAM, or what else went wrong. */
static int copy_page(FILE *page, int picture)
{
    char bytes[4096];
    for (size_t length; (length = fread(bytes, 1, sizeof bytes, page)) > 0;)
        if (!impact_runner_write(picture, bytes, length)) return 1;
    return 0;
}

static impact_draw_result draw_commands(FILE *commands, impact_runner *runner, const char *file_name, bool page,
                                        char *message, size_t size)
{
    if (!impact_runner_open_folder(runner, message, size)) return IMPACT_DRAW_FAILED;
    bool nameless = false;
    const int picture = impact_runner_new_file(runner, file_name, &nameless);
    FILE *complaints = picture >= 0 ? scratch_file() : NULL;
    int code = -1;
    impact_draw_result result = IMPACT_DRAW_FAILED;
    if (!complaints)
        snprintf(message, size, "cannot write '%s/%s': %s", runner->directory, file_name, strerror(errno));
    else
        code = page ? copy_page(commands, picture)
                    : impact_runner_gnuplot(runner, fileno(commands), picture, fileno(complaints));
    const off_t length = code == 0 ? lseek(picture, 0, SEEK_END) : 0;
    const bool drawn = length > 0 && impact_runner_spend(runner, (unsigned long long)length);
    if (complaints && !drawn) {
        if (code == IMPACT_NO_PROGRAM)
            snprintf(message, size, "gnuplot is not installed"), result = IMPACT_DRAW_NO_GNUPLOT;
        else if (code == IMPACT_FILE_TOO_LARGE || length > 0)
            snprintf(message, size, "cannot write '%s/%s': %s", runner->directory, file_name,
                     runner->quota.spent ? "the disk limit is reached" : strerror(EFBIG));
        else
            last_complaint(complaints, message, size);
    }
    if (complaints) fclose(complaints);
    if (picture >= 0 && impact_runner_finish_file(runner, picture, nameless, file_name, drawn)) result = IMPACT_DRAWN;
    if (drawn && result != IMPACT_DRAWN)
        snprintf(message, size, "cannot write '%s/%s': %s", runner->directory, file_name, strerror(errno));
    if (picture >= 0) close(picture);
    return result;
}

static impact_draw_result draw_form(lua_State *L, int index, impact_runner *runner, const char *name, const char *form,
                                    char *message, size_t size)
{
    char file_name[240];
    impact_draw_result result = IMPACT_DRAW_REFUSED;
    snprintf(file_name, sizeof file_name, "%s.%s", name, form);
    FILE *commands = scratch_file();
    if (!commands)
        return snprintf(message, size, "cannot make a temporary file: %s", strerror(errno)), IMPACT_DRAW_FAILED;
    if (make_commands(L, index, runner, form, commands, message, size)) {
        const long length = fseek(commands, 0, SEEK_END) == 0 ? ftell(commands) : -1;
        snprintf(message, size, "cannot read gnuplot's commands: %s", strerror(errno));
        rewind(commands);
        lseek(fileno(commands), 0, SEEK_SET); /* a stream may seek in its buffer alone; gnuplot reads the descriptor */
        result = length > 0    ? draw_commands(commands, runner, file_name, strcmp(form, page_form) == 0, message, size)
                 : length == 0 ? IMPACT_DRAWN
                               : IMPACT_DRAW_FAILED;
    }
    fclose(commands);
    return result;
}

impact_draw_result impact_runner_draw(lua_State *L, int index, impact_runner *runner, const char *name, char *message,
                                      size_t size)
{
    static const char *const others[] = {"svg", "pdf", page_form};
    const impact_draw_result result = draw_form(L, index, runner, name, "png", message, size);
    impact_draw_result other = result;
    for (size_t i = 0; runner->pictures && result == IMPACT_DRAWN && other == IMPACT_DRAWN && i < 3; i++)
        other = draw_form(L, index, runner, name, others[i], message, size);
    return other;
}

/* ---- quat.host ---- */

static const char *plain_name(lua_State *L, int arg)
{
    size_t length;
    const char *name = luaL_checklstring(L, arg, &length);
    if (strlen(name) != length || !impact_runner_is_plain(name))
        quat_lua_error(L, "the name of a file must be plain, without '/', got '%s'", name);
    return name;
}

/* save(figure, name): true, or nil and why */
static int host_save(lua_State *L)
{
    char message[400] = "";
    impact_runner *runner = lua_touserdata(L, lua_upvalueindex(1));
    const char *name = plain_name(L, 2);
    switch (impact_runner_draw(L, 1, runner, name, message, sizeof message)) {
    case IMPACT_DRAWN: lua_pushboolean(L, 1); return 1;
    case IMPACT_DRAW_REFUSED: return quat_lua_error(L, "figure '%s': %s", name, message);
    default: return quat_lua_failure(L, message);
    }
}

/* write(name, text): the whole file or none; true, or nil and why */
static int host_write(lua_State *L)
{
    char message[400] = "";
    size_t length;
    impact_runner *runner = lua_touserdata(L, lua_upvalueindex(1));
    const char *name = plain_name(L, 1), *text = luaL_checklstring(L, 2, &length);
    if (!impact_runner_open_folder(runner, message, sizeof message)) return quat_lua_failure(L, message);
    bool nameless = false;
    const int file = impact_runner_new_file(runner, name, &nameless);
    const bool good = file >= 0 && impact_runner_spend(runner, length) && impact_runner_write(file, text, length);
    const int error = errno;
    const bool there = file >= 0 && impact_runner_finish_file(runner, file, nameless, name, good);
    if (good) snprintf(message, sizeof message, "cannot write '%s/%s': %s", runner->directory, name, strerror(errno));
    if (!good)
        snprintf(message, sizeof message, "cannot write '%s/%s': %s", runner->directory, name,
                 error == EDQUOT ? "the disk limit is reached" : strerror(error));
    if (file >= 0 && close(file) != 0 && there) return quat_lua_failure(L, strerror(errno));
    if (!there) return quat_lua_failure(L, message);
    lua_pushboolean(L, 1);
    return 1;
}

int impact_runner_open_host(lua_State *L)
{
    static const luaL_Reg functions[] = {{"save", host_save}, {"write", host_write}, {NULL, NULL}};
    luaL_newlibtable(L, functions);
    lua_pushvalue(L, lua_upvalueindex(1));
    luaL_setfuncs(L, functions, 1);
    return 1;
}
