/* SPDX-License-Identifier: MIT
 *
 * results: what the Lua face hands back to a script.
 */
#ifndef QUAT_LUA_RESULTS_H
#define QUAT_LUA_RESULTS_H

#include <stdbool.h>
#include <lauxlib.h>
#include <lua.h>
#include <quat/quat.h>

/* The metatable name of a quaternion userdata, which holds one `quat`. */
#define QUAT_LUA_QUAT "quat.quat"
/* The metatable name of the vectors we hand out: tables {x, y, z} that also answer to .x .y .z. */
#define QUAT_LUA_VEC3 "quat.vec3"

void quat_lua_push_vec3(lua_State *L, qvec3 v);
/* A quat userdata; `require "quat"` gives it its methods. Raises an error for an infinite or NaN q. */
void quat_lua_push_quat(lua_State *L, quat q);

/* Each sets table[key] of the table on top of the stack. */
void quat_lua_set_number(lua_State *L, const char *key, double value);
void quat_lua_set_integer(lua_State *L, const char *key, lua_Integer value);
void quat_lua_set_boolean(lua_State *L, const char *key, bool value);
void quat_lua_set_string(lua_State *L, const char *key, const char *value); /* NULL: nil, the key stays absent */
void quat_lua_set_vec3(lua_State *L, const char *key, qvec3 value);
void quat_lua_set_quat(lua_State *L, const char *key, quat value);

#endif
