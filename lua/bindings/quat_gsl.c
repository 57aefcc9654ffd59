/* SPDX-License-Identifier: MIT
 *
 * quat.gsl: curves and surfaces. A module of its own, so that `require "quat"` loads no GSL.
 */
#include "quat_gsl.h"

int luaopen_quat_gsl(lua_State *L)
{
    luaL_checkversion(L); /* header against library */
    lua_newtable(L);
    quat_lua_open_curve(L);
    quat_lua_open_surface(L);
    return 1;
}
