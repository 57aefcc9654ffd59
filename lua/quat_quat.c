/* SPDX-License-Identifier: MIT */
#include "quat_core.h"

#include <stdio.h>
#include <string.h>

static quat *check_self(lua_State *L) { return luaL_checkudata(L, 1, QUAT_LUA_QUAT); }

static int quat_new(lua_State *L)
{
    if (lua_gettop(L) == 1) {
        quat_lua_push_quat(L, quat_lua_arg_quat(L, 1, "q"));
        return 1;
    }
    const double w = quat_lua_arg_number(L, 1, "w", QUAT_LUA_FINITE),
                 x = quat_lua_arg_number(L, 2, "x", QUAT_LUA_FINITE);
    const double y = quat_lua_arg_number(L, 3, "y", QUAT_LUA_FINITE),
                 z = quat_lua_arg_number(L, 4, "z", QUAT_LUA_FINITE);
    quat_lua_push_quat(L, quat_make(w, x, y, z));
    return 1;
}

static int quat_component(lua_State *L)
{
    const quat *q = check_self(L);
    const char *key = lua_type(L, 2) == LUA_TSTRING ? lua_tostring(L, 2) : "";
    if (strcmp(key, "w") == 0)
        lua_pushnumber(L, q->w);
    else if (strcmp(key, "x") == 0)
        lua_pushnumber(L, q->x);
    else if (strcmp(key, "y") == 0)
        lua_pushnumber(L, q->y);
    else if (strcmp(key, "z") == 0)
        lua_pushnumber(L, q->z);
    else
        lua_pushnil(L);
    return 1;
}

static int quat_tostring(lua_State *L)
{
    const quat *q = check_self(L);
    char text[120];
    snprintf(text, sizeof text, "(%.14g, %.14g, %.14g, %.14g)", q->w, q->x, q->y, q->z);
    lua_pushstring(L, text);
    return 1;
}

void quat_lua_open_quat(lua_State *L)
{
    static const luaL_Reg methods[] = {{"__index", quat_component}, {"__tostring", quat_tostring}, {NULL, NULL}};
    static const luaL_Reg functions[] = {{"new", quat_new}, {NULL, NULL}};
    luaL_newmetatable(L, QUAT_LUA_QUAT);
    luaL_setfuncs(L, methods, 0);
    lua_pop(L, 1);
    luaL_setfuncs(L, functions, 0);
}
