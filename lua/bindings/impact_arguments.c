/* SPDX-License-Identifier: MIT
 *
 * impact.arguments: what a script was given on its command line, "key=value" each, over defaults that say which keys
 * there are and of what kind.
 */
#include "impact_core.h"
#include "guess.h"

#include <string.h>

enum { MOST_KEYS = 64 };

/* The keys of the defaults at index 1, for a guess; the strings live as long as the table. */
static void list_keys(lua_State *L, const char *keys[MOST_KEYS + 1])
{
    int count = 0;
    for (lua_pushnil(L); lua_next(L, 1); lua_pop(L, 1)) {
        if (lua_type(L, -2) != LUA_TSTRING) quat_lua_error(L, "arguments: the defaults are a table by names");
        const char *key = lua_tostring(L, -2);
        const int type = lua_type(L, -1);
        if (type != LUA_TNUMBER && type != LUA_TSTRING && type != LUA_TBOOLEAN)
            quat_lua_error(L, "arguments: the default of '%s' must be a number, a string or a boolean, got a %s", key,
                           luaL_typename(L, -1));
        if (count == MOST_KEYS) quat_lua_error(L, "arguments: more than %d keys", MOST_KEYS);
        keys[count++] = key;
    }
    keys[count] = NULL;
}

/* Pushes the text as a value of the kind that the default, on top of the stack, is of. */
static void push_value(lua_State *L, const char *key, const char *text)
{
    switch (lua_type(L, -1)) {
    case LUA_TSTRING: lua_pushstring(L, text); return;
    case LUA_TBOOLEAN:
        if (strcmp(text, "true") != 0 && strcmp(text, "false") != 0)
            quat_lua_error(L, "argument '%s' must be true or false, got '%s'", key, text);
        lua_pushboolean(L, text[0] == 't');
        return;
    default:
        if (lua_stringtonumber(L, text) == 0) quat_lua_error(L, "argument '%s' must be a number, got '%s'", key, text);
        if (lua_isinteger(L, -2) && !lua_isinteger(L, -1))
            quat_lua_error(L, "argument '%s' must be a whole number, got '%s'", key, text);
        return;
    }
}

static void take_argument(lua_State *L, const char *word, const char *const keys[])
{
    const char *sign = strchr(word, '=');
    if (!sign || sign == word) quat_lua_error(L, "an argument has the form key=value, got '%s'", word);
    const char *key = lua_pushlstring(L, word, (size_t)(sign - word));
    lua_pushvalue(L, -1);
    if (lua_rawget(L, 1) == LUA_TNIL) {
        const char *near = quat_lua_guess(key, keys);
        if (near) quat_lua_error(L, "unknown argument '%s' (did you mean '%s'?)", key, near);
        quat_lua_error(L, "unknown argument '%s'", key);
    }
    push_value(L, key, sign + 1);
    lua_remove(L, -2);
    lua_rawset(L, 2);
}

/* arguments(defaults): a table of them, with what the command line says in place of theirs. */
static int core_arguments(lua_State *L)
{
    const char *keys[MOST_KEYS + 1];
    luaL_checktype(L, 1, LUA_TTABLE);
    lua_settop(L, 1);
    list_keys(L, keys);
    lua_newtable(L);
    for (lua_pushnil(L); lua_next(L, 1);) {
        lua_pushvalue(L, -2);
        lua_insert(L, -2);
        lua_rawset(L, 2);
    }
    if (lua_getglobal(L, "arg") != LUA_TTABLE) return lua_settop(L, 2), 1;
    for (lua_Integer i = 1; lua_rawgeti(L, 3, i) == LUA_TSTRING; i++) {
        take_argument(L, lua_tostring(L, 4), keys);
        lua_settop(L, 3);
    }
    lua_settop(L, 2);
    return 1;
}

void impact_lua_open_arguments(lua_State *L)
{
    lua_pushcfunction(L, core_arguments);
    lua_setfield(L, -2, "arguments");
}
