/* SPDX-License-Identifier: MIT
 *
 * The Lua face of one impact and of many: what the two share.
 */
#ifndef IMPACT_LUA_COLLIDE_H
#define IMPACT_LUA_COLLIDE_H

#include "impact_core.h"

/* Values of `law` and `solver`, in the order of the C enums; NULL-terminated. */
extern const char *const impact_lua_laws[];
extern const char *const impact_lua_solvers[];

/* Reads an inertia at the top of the stack: {{,,},{,,},{,,}}, a world tensor, or {moments=, orientation=}. Raises with the key. */
void impact_lua_read_inertia(const quat_lua_reader *reader, const char *key, qvec3 *moments, quat *orientation);

/* impact.collide_many{} */
int impact_lua_collide_many(lua_State *L);

#endif
