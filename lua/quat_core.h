/* SPDX-License-Identifier: MIT
 *
 * quat.core's rooms: each adds its functions to the table on top of the stack.
 */
#ifndef QUAT_LUA_CORE_H
#define QUAT_LUA_CORE_H

#include "arguments.h"

QUAT_API int luaopen_quat_core(lua_State *L);

void quat_lua_open_quat(lua_State *L);

#endif
