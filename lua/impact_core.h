/* SPDX-License-Identifier: MIT
 *
 * impact.core's rooms: each adds its functions to the table on top of the stack.
 */
#ifndef IMPACT_LUA_CORE_H
#define IMPACT_LUA_CORE_H

#include <impact/impact.h>
#include "arguments.h"

/* The metatable name of a shape userdata, which holds one `impact_shape`. */
#define IMPACT_LUA_SHAPE "impact.shape"

IMPACT_API int luaopen_impact_core(lua_State *L);

void impact_lua_open_shape(lua_State *L);

/* Pushes a shape userdata. */
void impact_lua_push_shape(lua_State *L, const impact_shape *shape);

#endif
