/* SPDX-License-Identifier: MIT */
#include "results.h"
#include "arguments.h"

#include <stdio.h>

/* v.x, v.y, v.z of a vector table, and the methods that quat.core gives to vectors. */
static int vec3_index(lua_State *L)
{
    luaL_checktype(L, 1, LUA_TTABLE);
    const char *key = lua_type(L, 2) == LUA_TSTRING ? lua_tostring(L, 2) : "";
    if (key[0] >= 'x' && key[0] <= 'z' && key[1] == 0) {
        lua_rawgeti(L, 1, key[0] - 'x' + 1);
    } else if (luaL_getmetafield(L, 1, "methods") == LUA_TTABLE) {
        lua_pushvalue(L, 2);
        lua_rawget(L, -2);
    } else {
        lua_pushnil(L);
    }
    return 1;
}

static int vec3_tostring(lua_State *L)
{
    char text[120];
    double v[3];
    luaL_checktype(L, 1, LUA_TTABLE);
    for (int i = 0; i < 3; i++) {
        lua_rawgeti(L, 1, i + 1);
        v[i] = lua_tonumber(L, -1);
    }
    snprintf(text, sizeof text, "(%.14g, %.14g, %.14g)", v[0], v[1], v[2]);
    lua_pushstring(L, text);
    return 1;
}

void quat_lua_push_vec3(lua_State *L, qvec3 v)
{
    const double component[3] = {v.x, v.y, v.z};
    luaL_checkstack(L, 4, NULL);
    lua_createtable(L, 3, 0);
    for (int i = 0; i < 3; i++) {
        lua_pushnumber(L, component[i]);
        lua_rawseti(L, -2, i + 1);
    }
    if (luaL_newmetatable(L, QUAT_LUA_VEC3)) {
        static const luaL_Reg methods[] = {{"__index", vec3_index}, {"__tostring", vec3_tostring}, {NULL, NULL}};
        luaL_setfuncs(L, methods, 0);
    }
    lua_setmetatable(L, -2);
}

void quat_lua_push_quat(lua_State *L, quat q)
{
    luaL_checkstack(L, 3, NULL);
    if (!quat_isfinite(q)) /* of finite operands: an overflow */
        quat_lua_error(L, "the result is (%f, %f, %f, %f): %s", q.w, q.x, q.y, q.z, quat_status_string(QUAT_ERANGE));
    quat *place = lua_newuserdatauv(L, sizeof q, 0);
    *place = q;
    luaL_newmetatable(L, QUAT_LUA_QUAT); /* filled by quat.core, whichever comes first */
    lua_setmetatable(L, -2);
}

/* ---- fields ---- */

void quat_lua_set_number(lua_State *L, const char *key, double value)
{
    luaL_checkstack(L, 1, NULL);
    lua_pushnumber(L, value);
    lua_setfield(L, -2, key);
}

void quat_lua_set_integer(lua_State *L, const char *key, lua_Integer value)
{
    luaL_checkstack(L, 1, NULL);
    lua_pushinteger(L, value);
    lua_setfield(L, -2, key);
}

void quat_lua_set_boolean(lua_State *L, const char *key, bool value)
{
    luaL_checkstack(L, 1, NULL);
    lua_pushboolean(L, value);
    lua_setfield(L, -2, key);
}

void quat_lua_set_string(lua_State *L, const char *key, const char *value)
{
    luaL_checkstack(L, 1, NULL);
    lua_pushstring(L, value);
    lua_setfield(L, -2, key);
}

void quat_lua_set_vec3(lua_State *L, const char *key, qvec3 value)
{
    quat_lua_push_vec3(L, value);
    lua_setfield(L, -2, key);
}

void quat_lua_set_quat(lua_State *L, const char *key, quat value)
{
    quat_lua_push_quat(L, value);
    lua_setfield(L, -2, key);
}
