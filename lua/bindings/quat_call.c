/* SPDX-License-Identifier: MIT */
#include "quat_call.h"

#include <stdio.h>

quat_lua_call quat_lua_call_begin(lua_State *L, int object, int count)
{
    luaL_checkstack(L, 16, NULL);
    lua_getiuservalue(L, object, 1);
    const quat_lua_call call = {L, lua_gettop(L), count, false};
    return call;
}

/* evaluate(function, d, count, x ...): nothing, or false when the function returns nil. */
static int evaluate(lua_State *L)
{
    qvec3 *const d = lua_touserdata(L, 2);
    const int count = (int)lua_tointeger(L, 3);
    const int arguments = lua_gettop(L) - 3;
    luaL_checkstack(L, count + 8, NULL);
    lua_pushvalue(L, 1);
    for (int i = 0; i < arguments; i++) lua_pushvalue(L, 4 + i);
    const int base = lua_gettop(L) - arguments;
    lua_call(L, arguments, count);
    if (lua_isnil(L, base)) {
        lua_pushboolean(L, 0);
        return 1;
    }
    for (int i = 0; i < count; i++) {
        char name[32];
        snprintf(name, sizeof name, "result %d of at", i + 1);
        d[i] = quat_lua_arg_vec3(L, base + i, name);
    }
    return 0;
}

bool quat_lua_call_vectors(quat_lua_call *call, int n, const double x[], qvec3 d[])
{
    lua_State *const L = call->L;
    if (call->failed) return false;
    lua_pushcfunction(L, evaluate);
    lua_pushvalue(L, call->function);
    lua_pushlightuserdata(L, d);
    lua_pushinteger(L, call->count);
    for (int i = 0; i < n; i++) lua_pushnumber(L, x[i]);
    if (lua_pcall(L, 3 + n, 1, 0) != LUA_OK) {
        call->failed = true; /* the error stays on top */
        return false;
    }
    const bool none = lua_isboolean(L, -1);
    lua_pop(L, 1);
    return !none;
}

void quat_lua_call_end(quat_lua_call *call)
{
    if (call->failed) lua_error(call->L);
}
