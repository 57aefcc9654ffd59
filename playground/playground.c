/* SPDX-License-Identifier: MIT
 *
 * The library, its modules and Lua as one program for WebAssembly, or as any other that a page calls: a script's text
 * in, what it printed, drew and recorded out. No files: what scripts write is kept in the answer.
 */
#include "playground.h"

#include <lauxlib.h>
#include <lualib.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "impact_core.h"
#include "quat_core.h"
#include "runner_layers.h"

typedef struct kept {
    char *bytes;
    unsigned long size;
} kept;

static kept answer, files[PLAYGROUND_KINDS];

static bool keep(kept *to, const char *bytes, size_t size)
{
    free(to->bytes);
    *to = (kept){malloc(size + 1), (unsigned long)size};
    if (!to->bytes) return to->size = 0, false;
    memcpy(to->bytes, bytes, size);
    to->bytes[size] = 0;
    return true;
}

static void forget(kept *what)
{
    free(what->bytes);
    *what = (kept){NULL, 0};
}

/* (kind, bytes): for the page. */
static int keep_bytes(lua_State *L)
{
    size_t size;
    const lua_Integer kind = luaL_checkinteger(L, 1);
    const char *bytes = luaL_checklstring(L, 2, &size);
    luaL_argcheck(L, kind >= 0 && kind < PLAYGROUND_KINDS, 1, "no such kind");
    return keep(&files[kind], bytes, size) ? 0 : luaL_error(L, "not enough memory");
}

static int load_embedded(lua_State *L)
{
    const char *module = luaL_checkstring(L, 1);
    for (const impact_runner_layer *layer = impact_runner_layers; layer->module; layer++) {
        if (strcmp(layer->module, module) != 0) continue;
        lua_pushfstring(L, "=%s", module);
        quat_lua_mark_layer(L, lua_tostring(L, -1));
        if (luaL_loadbufferx(L, (const char *)layer->source, layer->size, lua_tostring(L, -1), "t") != LUA_OK)
            return lua_error(L);
        lua_pushvalue(L, 1);
        lua_call(L, 1, 1);
        return 1;
    }
    return luaL_error(L, "no layer '%s'", module);
}

static void open_modules(lua_State *L)
{
    luaL_openlibs(L);
    luaL_getsubtable(L, LUA_REGISTRYINDEX, LUA_PRELOAD_TABLE);
    for (const impact_runner_layer *layer = impact_runner_layers; layer->module; layer++) {
        lua_pushcfunction(L, load_embedded);
        lua_setfield(L, -2, layer->module);
    }
    lua_pushcfunction(L, luaopen_quat_core);
    lua_setfield(L, -2, "quat.core");
    lua_pushcfunction(L, luaopen_impact_core);
    lua_setfield(L, -2, "impact.core");
    lua_pop(L, 1);
    lua_pushcfunction(L, keep_bytes);
    lua_setglobal(L, "keep");
}

/* Protected: (name, source, values) -> the answer, JSON. */
static int work(lua_State *L)
{
    open_modules(L);
    lua_getglobal(L, "require");
    lua_pushliteral(L, "playground");
    lua_call(L, 1, 1);
    lua_insert(L, 1);
    lua_call(L, 3, 1);
    return 1;
}

int playground_run(const char *name, const char *source, const char *values)
{
    forget(&answer);
    for (int kind = 0; kind < PLAYGROUND_KINDS; kind++) forget(&files[kind]);
    lua_State *L = luaL_newstate();
    if (!L) return 1;
    lua_pushcfunction(L, work);
    lua_pushstring(L, name);
    lua_pushstring(L, source);
    lua_pushstring(L, values);
    const int code = lua_pcall(L, 3, 1, 0);
    const char *text = lua_tostring(L, -1);
    if (!text) text = "the script raised an error that is not a text";
    keep(&answer, text, strlen(text));
    lua_close(L);
    return code != LUA_OK;
}

const char *playground_answer(void) { return answer.bytes ? answer.bytes : "not enough memory"; }
const char *playground_bytes(int kind) { return files[kind].bytes; }
unsigned long playground_size(int kind) { return files[kind].size; }
