/* SPDX-License-Identifier: MIT
 *
 * The Lua face of one impact, of many and of the sliding in one: what they share.
 */
#ifndef IMPACT_LUA_COLLIDE_H
#define IMPACT_LUA_COLLIDE_H

#include "impact_core.h"

/* Values of `law` and `solver`, in the order of the C enums; NULL-terminated. */
extern const char *const impact_lua_laws[];
extern const char *const impact_lua_solvers[];

/* Reads an inertia at the top of the stack: {{,,},{,,},{,,}}, a world tensor, or {moments=, orientation=}. Raises with
 * the key. */
void impact_lua_read_inertia(const quat_lua_reader *reader, const char *key, qvec3 *moments, quat *orientation);

/* Reads the keys that every kind of call has, mu not among them. Raises with the key. */
void impact_lua_read_collision(const quat_lua_reader *reader, impact_collision *c);

/* Words for a failure of impact_collide after impact_collide_check has found nothing. */
const char *impact_lua_why_no_outcome(impact_status status);

/* impact.flow{} */
int impact_lua_flow(lua_State *L);

/* impact.collide_together{} */
int impact_lua_collide_together(lua_State *L);

/* impact.collide_many{} */
int impact_lua_collide_many(lua_State *L);

#endif
