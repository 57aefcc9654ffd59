/* SPDX-License-Identifier: MIT
 *
 * quat.gsl's rooms: each adds its functions to the table on top of the stack.
 */
#ifndef QUAT_LUA_GSL_H
#define QUAT_LUA_GSL_H

#include "quat_core.h"

QUAT_API int luaopen_quat_gsl(lua_State *L);

void quat_lua_open_curve(lua_State *L);
void quat_lua_open_surface(lua_State *L);

#endif
