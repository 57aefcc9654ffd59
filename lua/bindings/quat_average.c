/* SPDX-License-Identifier: MIT
 *
 * Means of rotations, and the rotation that aligns two sets, in Lua.
 */
#include "quat_core.h"

#include <quat/average.h>

static int l_mean(lua_State *L)
{
    size_t n;
    quat m;
    lua_settop(L, 2); /* before buffers take the places of absent arguments */
    const quat *const q = quat_lua_arg_units(L, 1, "q", 1, &n);
    const quat_status status = quat_mean(n, q, quat_lua_arg_weights(L, 2, n), &m);
    return quat_lua_result(L, status, m);
}

/* mean, spread [, reason] */
static int l_mean_karcher(lua_State *L)
{
    size_t n;
    quat m;
    double spread;
    lua_settop(L, 2); /* before buffers take the places of absent arguments */
    const quat *const q = quat_lua_arg_units(L, 1, "q", 1, &n);
    const quat_status status = quat_mean_karcher(n, q, quat_lua_arg_weights(L, 2, n), &m, &spread);
    quat_lua_push_quat(L, m);
    lua_pushnumber(L, spread);
    return quat_lua_results(L, status, 2);
}

/* q, residual [, reason] */
static int l_align(lua_State *L)
{
    size_t n, other;
    quat q;
    double residual;
    lua_settop(L, 3); /* before buffers take the places of absent arguments */
    const qvec3 *const a = quat_lua_arg_vec3s(L, 1, "a", 1, &n), *const b = quat_lua_arg_vec3s(L, 2, "b", 1, &other);
    quat_lua_same_length(L, n, other, "b");
    const quat_status status = quat_align(n, a, b, quat_lua_arg_weights(L, 3, n), &q, &residual);
    quat_lua_push_quat(L, q);
    lua_pushnumber(L, residual);
    return quat_lua_results(L, status, 2);
}

/* q, shift, residual [, reason] */
static int l_align_points(lua_State *L)
{
    size_t n, other;
    quat q;
    qvec3 shift;
    double residual;
    lua_settop(L, 3); /* before buffers take the places of absent arguments */
    const qvec3 *const a = quat_lua_arg_vec3s(L, 1, "a", 1, &n), *const b = quat_lua_arg_vec3s(L, 2, "b", 1, &other);
    quat_lua_same_length(L, n, other, "b");
    const quat_status status = quat_align_points(n, a, b, quat_lua_arg_weights(L, 3, n), &q, &shift, &residual);
    quat_lua_push_quat(L, q);
    quat_lua_push_vec3(L, shift);
    lua_pushnumber(L, residual);
    return quat_lua_results(L, status, 3);
}

typedef double error_of(size_t n, const qvec3 a[], const qvec3 b[], const double weights[], quat q);

/* (q, a, b [, weights]): rad */
static int push_error(lua_State *L, error_of *error)
{
    size_t n, other;
    lua_settop(L, 4); /* before buffers take the places of absent arguments */
    const quat q = quat_lua_arg_unit(L, 1, "q");
    const qvec3 *const a = quat_lua_arg_vec3s(L, 2, "a", 1, &n), *const b = quat_lua_arg_vec3s(L, 3, "b", 1, &other);
    quat_lua_same_length(L, n, other, "b");
    lua_pushnumber(L, error(n, a, b, quat_lua_arg_weights(L, 4, n), q));
    return 1;
}

static int l_align_error(lua_State *L) { return push_error(L, quat_align_error); }

static int l_align_points_error(lua_State *L) { return push_error(L, quat_align_points_error); }

void quat_lua_open_average(lua_State *L)
{
    static const luaL_Reg functions[] = {{"mean", l_mean},
                                         {"mean_karcher", l_mean_karcher},
                                         {"align", l_align},
                                         {"align_points", l_align_points},
                                         {"align_error", l_align_error},
                                         {"align_points_error", l_align_points_error},
                                         {NULL, NULL}};
    luaL_setfuncs(L, functions, 0);
}
