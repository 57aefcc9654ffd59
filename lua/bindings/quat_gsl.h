/* SPDX-License-Identifier: MIT
 *
 * quat.gsl, for the layer of `require "quat"` (docs/lua.md).
 */
#ifndef QUAT_LUA_GSL_H
#define QUAT_LUA_GSL_H

#include "quat_core.h"

QUAT_API int luaopen_quat_gsl(lua_State *L);

#endif
