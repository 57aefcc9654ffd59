/* SPDX-License-Identifier: MIT
 *
 * quat.core: the C side of `require "quat"`. Needs libquat and libm only.
 */
#include "quat_core.h"

int luaopen_quat_core(lua_State *L)
{
    static void (*const rooms[])(lua_State *) = {quat_lua_open_quat};
    luaL_checkversion(L); /* header against library */
    lua_newtable(L);
    lua_pushcfunction(L, quat_lua_layer);
    lua_setfield(L, -2, "layer");
    for (size_t i = 0; i < sizeof rooms / sizeof *rooms; i++) rooms[i](L);
    return 1;
}
