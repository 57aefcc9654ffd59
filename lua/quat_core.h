/* SPDX-License-Identifier: MIT
 *
 * quat.core's rooms: each adds its functions to the table on top of the stack, and those whose first argument is a
 * quaternion to the methods of quaternions as well.
 */
#ifndef QUAT_LUA_CORE_H
#define QUAT_LUA_CORE_H

#include "arguments.h"

QUAT_API int luaopen_quat_core(lua_State *L);

void quat_lua_open_quat(lua_State *L);
void quat_lua_open_rotation(lua_State *L);
void quat_lua_open_interpolate(lua_State *L);
void quat_lua_open_spline(lua_State *L);
void quat_lua_open_array(lua_State *L);
void quat_lua_open_dual(lua_State *L);

/* Adds functions (ended by {NULL, NULL}) to the module's table on top of the stack and to the methods of quaternions. */
void quat_lua_add_methods(lua_State *L, const luaL_Reg functions[]);

/* Returns q to the script; with a failure nil and a message; with a reason for success q and the reason. */
int quat_lua_result(lua_State *L, quat_status status, quat q);
/* The same for a result that is already on top of the stack. */
int quat_lua_result_on_top(lua_State *L, quat_status status);

/* Lists, read into a buffer that Lua collects: n elements of the list at arg. The list is pinned by the buffer's place on
 * the stack; at least `least` elements are asked for. */
quat *quat_lua_arg_quats(lua_State *L, int arg, const char *name, size_t least, size_t *n);
qvec3 *quat_lua_arg_vec3s(lua_State *L, int arg, const char *name, size_t least, size_t *n);
double *quat_lua_arg_numbers(lua_State *L, int arg, const char *name, size_t least, size_t *n);
/* NULL for nil or none, else n numbers that are not negative. */
double *quat_lua_arg_weights(lua_State *L, int arg, size_t n);
void quat_lua_push_quats(lua_State *L, size_t n, const quat q[]);

#endif
