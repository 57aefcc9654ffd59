/* SPDX-License-Identifier: MIT
 *
 * The Lua face: FUZZ_SCRIPT, a Lua file beside this one, makes calls (lua_face.lua) or whole scripts (lua_script.lua)
 * out of the bytes. Whatever they answer, the process lives, and what is raised is a message. Each step is told before
 * it is done, so that it can be printed as Lua that reproduces it.
 */
#include "fuzz.h"

#include <lauxlib.h>
#include <lualib.h>

enum { ROOM = 1 << 16, STEPS = 20000000 };
static const size_t most_memory = (size_t)1 << 28;

static char told[ROOM];
static size_t told_size, memory;
static lua_State *L;

void fuzz_show(FILE *out) { fprintf(out, "%s\n", told); }

/* tell(text): the next lines of the script at hand. */
static int tell(lua_State *state)
{
    size_t size;
    const char *text = luaL_checklstring(state, 1, &size);
    if (told_size + size + 2 > ROOM) return 0;
    memcpy(told + told_size, text, size);
    told_size += size;
    told[told_size++] = '\n';
    told[told_size] = 0;
    return 0;
}

static void *allocate(void *context, void *block, size_t old, size_t wanted)
{
    (void)context;
    if (!block) old = 0;
    if (wanted == 0) {
        free(block);
        memory -= old;
        return NULL;
    }
    if (wanted > old && memory + (wanted - old) > most_memory) return NULL;
    void *const got = realloc(block, wanted);
    if (got) memory += wanted - old;
    return got;
}

static void too_many_steps(lua_State *state, lua_Debug *at)
{
    (void)at;
    luaL_error(state, "too many steps");
}

static void fail(const char *what)
{
    fprintf(stderr, "%s: %s\n", what, lua_tostring(L, -1));
    exit(2);
}

static void set_path(const char *field, const char *path)
{
    lua_getglobal(L, "package");
    lua_pushstring(L, path);
    lua_setfield(L, -2, field);
    lua_pop(L, 1);
}

static void make_state(void)
{
    L = lua_newstate(allocate, NULL);
    if (!L) abort();
    luaL_openlibs(L);
    set_path("path", FUZZ_MODULES "/?.lua;" FUZZ_FOLDER "/?.lua");
    set_path("cpath", FUZZ_MODULES "/?.so");
    lua_pushcfunction(L, tell);
    lua_setglobal(L, "tell");
    if (luaL_dofile(L, FUZZ_FOLDER "/" FUZZ_SCRIPT) != LUA_OK) fail(FUZZ_SCRIPT);
    lua_setfield(L, LUA_REGISTRYINDEX, "fuzz");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static unsigned long inputs;
    if (!L) make_state();
    told_size = 0, told[0] = 0;
    lua_sethook(L, too_many_steps, LUA_MASKCOUNT, STEPS);
    lua_getfield(L, LUA_REGISTRYINDEX, "fuzz");
    lua_pushlstring(L, (const char *)data, size);
    const bool good = lua_pcall(L, 1, 0, 0) == LUA_OK;
    if (!good) fprintf(stderr, "%s\n", luaL_tolstring(L, -1, NULL));
    HOLD(good || strstr(lua_tostring(L, -1), "not enough memory") || strstr(lua_tostring(L, -1), "too many steps"), 0,
         0);
    lua_settop(L, 0);
    if (++inputs % 64 == 0) lua_gc(L, LUA_GCCOLLECT);
    return 0;
}
