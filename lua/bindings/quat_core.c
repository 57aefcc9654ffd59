/* SPDX-License-Identifier: MIT
 *
 * quat.core: the C side of `require "quat"`. Needs libquat and libm only.
 */
#include "quat_core.h"

int luaopen_quat_core(lua_State *L)
{
    static void (*const rooms[])(lua_State *) = {
        quat_lua_open_quat,    quat_lua_open_rotation, quat_lua_open_interpolate, quat_lua_open_spline,
        quat_lua_open_array,   quat_lua_open_average,  quat_lua_open_dual,        quat_lua_open_jacobian,
        quat_lua_open_project, quat_lua_open_sequence, quat_lua_open_vector,      quat_lua_open_curve,
        quat_lua_open_surface};
    luaL_checkversion(L); /* header against library */
    lua_newtable(L);
    lua_pushcfunction(L, quat_lua_layer);
    lua_setfield(L, -2, "layer");
    lua_pushcfunction(L, quat_lua_no_function);
    lua_setfield(L, -2, "no_function");
    for (size_t i = 0; i < sizeof rooms / sizeof *rooms; i++) rooms[i](L);
    return 1;
}

void quat_lua_add_methods(lua_State *L, const luaL_Reg functions[])
{
    luaL_setfuncs(L, functions, 0);
    luaL_newmetatable(L, QUAT_LUA_QUAT);
    luaL_getsubtable(L, -1, "methods");
    luaL_setfuncs(L, functions, 0);
    lua_pop(L, 2);
}
