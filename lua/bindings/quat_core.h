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
void quat_lua_open_average(lua_State *L);
void quat_lua_open_jacobian(lua_State *L);
void quat_lua_open_project(lua_State *L);
void quat_lua_open_sequence(lua_State *L);
void quat_lua_open_dual(lua_State *L);
void quat_lua_open_vector(lua_State *L);
void quat_lua_open_curve(lua_State *L);
void quat_lua_open_surface(lua_State *L);

/* Adds functions (ended by {NULL, NULL}) to the module's table on top of the stack and to the methods
 * of quaternions. */
void quat_lua_add_methods(lua_State *L, const luaL_Reg functions[]);

/* ---- results ---- */

/* Returns the `count` values on top of the stack to the script; with a failure nil and a message instead; with a reason
 * for success the reason after them. */
int quat_lua_results(lua_State *L, quat_status status, int count);
/* The same for one quaternion. */
int quat_lua_result(lua_State *L, quat_status status, quat q);
/* Returns nil and "name[i + 1]: why" to the script, for the element i of a list. */
int quat_lua_element_failure(lua_State *L, const char *name, size_t i, quat_status status);
/* Returns one vector to the script. */
int quat_lua_give_vec3(lua_State *L, qvec3 v);
/* A point of the plane, {x, y}. */
void quat_lua_push_vec2(lua_State *L, qvec2 v);
/* A matrix as a list of rows, each a list of numbers; a row-major array. */
void quat_lua_push_matrix(lua_State *L, int rows, int columns, const double m[]);
void quat_lua_push_numbers(lua_State *L, size_t n, const double x[]);
void quat_lua_push_vec3s(lua_State *L, size_t n, const qvec3 v[]);
void quat_lua_push_quats(lua_State *L, size_t n, const quat q[]);

/* ---- arguments ---- */

/* A quaternion that stands for a rotation, normalised: anything but zero. */
quat quat_lua_arg_unit(lua_State *L, int arg, const char *name);
/* n <= 3 numbers, {x, y, z} or {x=, y=, z=} or the first n of them; infinite ones pass, NaN does not. */
void quat_lua_arg_image(lua_State *L, int arg, const char *name, int n, double x[]);
/* {x, y} or {x=, y=}, both finite. */
qvec2 quat_lua_arg_vec2(lua_State *L, int arg, const char *name);
/* Three rows of three finite numbers. */
qmat3 quat_lua_arg_matrix(lua_State *L, int arg, const char *name);

/* Lists, read into a buffer that Lua collects: n elements of the list at arg. The list is pinned by the buffer's place
 * on the stack; at least `least` elements are asked for. */
quat *quat_lua_arg_quats(lua_State *L, int arg, const char *name, size_t least, size_t *n);
qvec2 *quat_lua_arg_vec2s(lua_State *L, int arg, const char *name, size_t least, size_t *n);
qvec3 *quat_lua_arg_vec3s(lua_State *L, int arg, const char *name, size_t least, size_t *n);
double *quat_lua_arg_numbers(lua_State *L, int arg, const char *name, size_t least, size_t *n);
/* The same, normalised. */
quat *quat_lua_arg_units(lua_State *L, int arg, const char *name, size_t least, size_t *n);
/* NULL for nil or none, else n numbers that are not negative. */
double *quat_lua_arg_weights(lua_State *L, int arg, size_t n);
/* Raises an error unless the list called `name` is as long as the first one, n. */
void quat_lua_same_length(lua_State *L, size_t n, size_t other, const char *name);

#endif
