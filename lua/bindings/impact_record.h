/* SPDX-License-Identifier: MIT
 *
 * The recorded-run userdata.
 */
#ifndef IMPACT_LUA_RECORD_H
#define IMPACT_LUA_RECORD_H

#include "impact_scene.h"

#define IMPACT_LUA_RUN "impact.run"

/* Pushes a userdata that owns the run. */
void impact_lua_push_run(lua_State *L, impact_run *run);

#endif
