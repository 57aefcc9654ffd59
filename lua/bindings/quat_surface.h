/* SPDX-License-Identifier: MIT
 *
 * Surfaces of Lua, for what calls GSL and what does not.
 */
#ifndef QUAT_LUA_SURFACE_H
#define QUAT_LUA_SURFACE_H

#include <quat/family.h>
#include "quat_call.h"

#define QUAT_LUA_SURFACE "quat.surface"

/* User value 1: the script's function. */
typedef struct quat_lua_surface {
    quat_surface surface;
    quat_family family;
    bool scripted;
} quat_lua_surface;

/* The surface at argument 1, its function asked through the call. */
static inline quat_surface quat_lua_begin_surface(lua_State *L, quat_lua_call *call)
{
    static const int counts[] = {1, 3, 6};
    quat_lua_surface *const s = luaL_checkudata(L, 1, QUAT_LUA_SURFACE);
    quat_surface surface = s->surface;
    *call = quat_lua_call_begin(L, 1, counts[surface.known]);
    if (s->scripted) surface.context = call;
    return surface;
}

#endif
