/* SPDX-License-Identifier: MIT
 *
 * What a script can reach. Without --trust: no programs, no files but those of the output folder, no C code but ours,
 * no bytecode, no look into other functions' insides.
 */
#define _XOPEN_SOURCE 700
#include "runner.h"

#include <lualib.h>
#include <string.h>
#include <unistd.h>
#include "quat_core.h"
#include "runner_layers.h"

/* Keeps only the named fields of a library's table, which is shared by everyone who holds it. */
static void keep_only(lua_State *L, const char *library, const char *const names[])
{
    lua_getfield(L, LUA_REGISTRYINDEX, LUA_LOADED_TABLE);
    lua_getfield(L, -1, library);
    lua_newtable(L); /* what stays */
    for (int i = 0; names[i]; i++) {
        lua_getfield(L, -2, names[i]);
        lua_setfield(L, -2, names[i]);
    }
    for (lua_pushnil(L); lua_next(L, -3);) { /* clearing fields while stepping is allowed */
        lua_pop(L, 1);
        lua_pushvalue(L, -1);
        lua_pushnil(L);
        lua_rawset(L, -5);
    }
    for (lua_pushnil(L); lua_next(L, -2); lua_pop(L, 1)) {
        lua_pushvalue(L, -2);
        lua_pushvalue(L, -2);
        lua_rawset(L, -6);
    }
    lua_pop(L, 3);
}

/* load(chunk, name, mode, environment) for source text only; upvalue 1 is the original. */
static int load_text(lua_State *L)
{
    const int count = lua_gettop(L);
    if (count < 3) lua_settop(L, 3);
    lua_pushliteral(L, "t");
    lua_replace(L, 3);
    lua_pushvalue(L, lua_upvalueindex(1));
    lua_insert(L, 1);
    lua_call(L, count < 3 ? 3 : count, LUA_MULTRET);
    return lua_gettop(L);
}

static int load_layer(lua_State *L)
{
    const char *module = luaL_checkstring(L, 1);
    if (!impact_runner_load_layer(L, module)) return luaL_error(L, "no layer '%s'", module);
    lua_pushvalue(L, 1);
    lua_call(L, 1, 1);
    return 1;
}

bool impact_runner_load_layer(lua_State *L, const char *module)
{
    for (const impact_runner_layer *layer = impact_runner_layers; layer->module; layer++) {
        if (strcmp(layer->module, module) != 0) continue;
        char name[64];
        snprintf(name, sizeof name, "=%s", module);
        quat_lua_mark_layer(L, name);
        if (luaL_loadbufferx(L, (const char *)layer->source, layer->size, name, "t") != LUA_OK) lua_error(L);
        return true;
    }
    return false;
}

/* require "quat.gsl": the module beside this program, from the build tree or as installed, so that GSL is loaded by
 * those only who use it. Upvalue 1 is package.loadlib. */
static int load_gsl(lua_State *L)
{
    static const char *const places[] = {"modules", IMPACT_RUNNER_MODULES};
    char program[4096];
    const ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    if (length <= 0) return luaL_error(L, "quat.gsl: this program does not know where it is");
    program[length] = 0;
    *strrchr(program, '/') = 0;
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        const char *path = lua_pushfstring(L, "%s/%s/quat/gsl.so", program, places[i]);
        if (access(path, R_OK) != 0) continue;
        lua_pushvalue(L, lua_upvalueindex(1));
        lua_pushstring(L, path);
        lua_pushliteral(L, "luaopen_quat_gsl");
        lua_call(L, 2, 2);
        if (lua_isnil(L, -2)) return luaL_error(L, "quat.gsl: %s", lua_tostring(L, -1));
        lua_pop(L, 1);
        lua_pushliteral(L, "quat.gsl");
        lua_call(L, 1, 1);
        return 1;
    }
    return luaL_error(L, "quat.gsl is not in this build");
}

static void preload(lua_State *L, const char *module, lua_CFunction opener)
{
    luaL_getsubtable(L, LUA_REGISTRYINDEX, LUA_PRELOAD_TABLE);
    lua_pushcfunction(L, opener);
    lua_setfield(L, -2, module);
    lua_pop(L, 1);
}

/* Upvalues: the runner, and a function that writes. */
static int note_use(lua_State *L)
{
    ((impact_runner *)lua_touserdata(L, lua_upvalueindex(1)))->used = true;
    lua_pushvalue(L, lua_upvalueindex(2));
    lua_insert(L, 1);
    lua_call(L, lua_gettop(L) - 1, LUA_MULTRET);
    return lua_gettop(L);
}

/* The function of that name, of the table on top of the stack. */
static void note_uses_of(lua_State *L, impact_runner *runner, const char *name)
{
    lua_pushlightuserdata(L, runner);
    lua_getfield(L, -2, name);
    lua_pushcclosure(L, note_use, 2);
    lua_setfield(L, -2, name);
}

static void note_writing(lua_State *L, impact_runner *runner)
{
    lua_pushglobaltable(L);
    note_uses_of(L, runner, "print");
    lua_getglobal(L, LUA_IOLIBNAME);
    note_uses_of(L, runner, "write");
    luaL_getmetatable(L, LUA_FILEHANDLE);
    lua_getfield(L, -1, "__index");
    note_uses_of(L, runner, "write");
    lua_pop(L, 4);
}

static void preload_ours(lua_State *L, impact_runner *runner)
{
    for (const impact_runner_layer *layer = impact_runner_layers; layer->module; layer++)
        preload(L, layer->module, load_layer);
    preload(L, "quat.core", luaopen_quat_core);
    preload(L, "impact.core", luaopen_impact_core);
    luaL_getsubtable(L, LUA_REGISTRYINDEX, LUA_PRELOAD_TABLE);
    lua_pushlightuserdata(L, runner);
    lua_pushcclosure(L, impact_runner_open_host, 1);
    lua_setfield(L, -2, "quat.host");
    lua_getglobal(L, LUA_LOADLIBNAME);
    lua_getfield(L, -1, "loadlib");
    lua_remove(L, -2);
    lua_pushcclosure(L, load_gsl, 1);
    lua_setfield(L, -2, "quat.gsl");
    lua_pop(L, 1);
}

static void close_in(lua_State *L, impact_runner *runner)
{
    static const char *const io_names[] = {"write", "type", "stdout", "stderr", "close", NULL};
    static const char *const os_names[] = {"clock", "date", "difftime", "time", NULL};
    static const char *const debug_names[] = {"traceback", NULL};
    static const char *const package_names[] = {"loaded", "preload", "config", NULL};
    lua_getglobal(L, "package"); /* require keeps this table; only its preload searcher stays */
    lua_getfield(L, -1, "searchers");
    lua_rawgeti(L, -1, 1);
    lua_createtable(L, 1, 0);
    lua_insert(L, -2);
    lua_rawseti(L, -2, 1);
    lua_remove(L, -2);
    keep_only(L, LUA_LOADLIBNAME, package_names);
    lua_setfield(L, -2, "searchers");
    lua_pop(L, 1);
    keep_only(L, LUA_IOLIBNAME, io_names);
    keep_only(L, LUA_OSLIBNAME, os_names);
    keep_only(L, LUA_DBLIBNAME, debug_names);

    lua_getglobal(L, "io");
    lua_pushlightuserdata(L, runner);
    lua_pushcclosure(L, impact_runner_io_open, 1);
    lua_setfield(L, -2, "open");
    lua_getglobal(L, "string");
    lua_pushnil(L);
    lua_setfield(L, -2, "dump");
    lua_pop(L, 2);

    lua_getglobal(L, "load");
    lua_pushcclosure(L, load_text, 1);
    lua_setglobal(L, "load");
    lua_pushnil(L);
    lua_setglobal(L, "dofile");
    lua_pushnil(L);
    lua_setglobal(L, "loadfile");
}

void impact_runner_open_libraries(lua_State *L, impact_runner *runner)
{
    luaL_checkversion(L);
    luaL_openlibs(L);
    preload_ours(L, runner);
    impact_lua_set_host(L, &runner->host);
    note_writing(L, runner);
    if (!runner->trust) close_in(L, runner);
}
