/* SPDX-License-Identifier: MIT
 *
 * Rotations in Lua. Quaternions that stand for a rotation are normalised as they come in.
 */
#include "quat_core.h"

#include <quat/euler.h>
#include <quat/integrate.h>
#include <quat/rotation.h>

static qvec3 direction(lua_State *L, int index, const char *name)
{
    qvec3 n;
    if (qvec3_normalize(quat_lua_arg_vec3(L, index, name), &n) != QUAT_OK)
        quat_lua_error(L, "argument '%s' must not be zero", name);
    return n;
}

static int l_rotate(lua_State *L)
{
    return quat_lua_give_vec3(L, quat_rotate(quat_lua_arg_unit(L, 1, "q"), quat_lua_arg_vec3(L, 2, "v")));
}
static int l_rotate_inverse(lua_State *L)
{
    return quat_lua_give_vec3(L, quat_rotate_inverse(quat_lua_arg_unit(L, 1, "q"), quat_lua_arg_vec3(L, 2, "v")));
}
static int l_reflect(lua_State *L)
{
    return quat_lua_give_vec3(L, quat_reflect(direction(L, 1, "normal"), quat_lua_arg_vec3(L, 2, "v")));
}
static int l_from_reflections(lua_State *L)
{
    quat_lua_push_quat(L, quat_from_reflections(direction(L, 1, "n1"), direction(L, 2, "n2")));
    return 1;
}

static int l_from_rotation_vector(lua_State *L)
{
    quat_lua_push_quat(L, quat_from_rotation_vector(quat_lua_arg_vec3(L, 1, "r")));
    return 1;
}
static int l_to_rotation_vector(lua_State *L)
{
    return quat_lua_give_vec3(L, quat_to_rotation_vector(quat_lua_arg_unit(L, 1, "q")));
}

static int l_from_axis_angle(lua_State *L)
{
    quat q;
    const qvec3 axis = quat_lua_arg_vec3(L, 1, "axis");
    const quat_status status = quat_from_axis_angle(axis, quat_lua_arg_number(L, 2, "angle", QUAT_LUA_FINITE), &q);
    return quat_lua_result(L, status, q);
}

static int l_to_axis_angle(lua_State *L)
{
    qvec3 axis;
    double angle;
    const quat_status status = quat_to_axis_angle(quat_lua_arg_quat(L, 1, "q"), &axis, &angle);
    quat_lua_push_vec3(L, axis);
    lua_pushnumber(L, angle);
    return quat_lua_results(L, status, 2);
}

/* ---- matrices: three rows of three ---- */

static int l_to_matrix(lua_State *L)
{
    const qmat3 m = quat_to_matrix(quat_lua_arg_unit(L, 1, "q"));
    quat_lua_push_matrix(L, 3, 3, m.m[0]);
    return 1;
}

static int l_from_matrix(lua_State *L)
{
    quat q;
    const qmat3 m = quat_lua_arg_matrix(L, 1, "matrix");
    const quat_status status = quat_from_matrix(&m, &q);
    return quat_lua_result(L, status, q);
}

/* q, distance [, reason] */
static int l_from_matrix_nearest(lua_State *L)
{
    quat q;
    double distance;
    const qmat3 m = quat_lua_arg_matrix(L, 1, "matrix");
    const quat_status status = quat_from_matrix_nearest(&m, &q, &distance);
    quat_lua_push_quat(L, q);
    lua_pushnumber(L, distance);
    return quat_lua_results(L, status, 2);
}

/* ---- Euler angles ---- */

static quat_euler sequence(lua_State *L, int index)
{
    quat_euler s;
    const char *const name = lua_type(L, index) == LUA_TSTRING ? lua_tostring(L, index) : NULL;
    if (quat_euler_from_name(name, &s) != QUAT_OK)
        quat_lua_refuse(L, index, "sequence",
                        "three axes such as 'ZYX' (intrinsic) or 'xyz' (extrinsic), no two neighbours alike");
    return s;
}

static int l_from_euler(lua_State *L)
{
    quat q;
    const quat_euler s = sequence(L, 1);
    const double angles[3] = {quat_lua_arg_number(L, 2, "a", QUAT_LUA_FINITE),
                              quat_lua_arg_number(L, 3, "b", QUAT_LUA_FINITE),
                              quat_lua_arg_number(L, 4, "c", QUAT_LUA_FINITE)};
    const quat_status status = quat_from_euler(angles, s, &q);
    return quat_lua_result(L, status, q);
}

static int l_to_euler(lua_State *L)
{
    double angles[3];
    const quat q = quat_lua_arg_quat(L, 1, "q");
    const quat_status status = quat_to_euler(q, sequence(L, 2), angles);
    for (int i = 0; i < 3; i++) lua_pushnumber(L, angles[i]);
    return quat_lua_results(L, status, 3);
}

/* ---- from vectors ---- */

static int l_from_two_vectors(lua_State *L)
{
    quat q;
    const qvec3 a = quat_lua_arg_vec3(L, 1, "a");
    const quat_status status = quat_from_two_vectors(a, quat_lua_arg_vec3(L, 2, "b"), &q);
    return quat_lua_result(L, status, q);
}

static int l_from_axes(lua_State *L)
{
    quat q;
    const qvec3 x = quat_lua_arg_vec3(L, 1, "x");
    const quat_status status = quat_from_axes(x, quat_lua_arg_vec3(L, 2, "y"), &q);
    return quat_lua_result(L, status, q);
}

static int l_from_frame(lua_State *L)
{
    quat q;
    const qvec3 x = quat_lua_arg_vec3(L, 1, "x"), y = quat_lua_arg_vec3(L, 2, "y");
    const quat_status status = quat_from_frame(x, y, quat_lua_arg_vec3(L, 3, "z"), &q);
    return quat_lua_result(L, status, q);
}

/* swing, twist [, reason] */
static int l_swing_twist(lua_State *L)
{
    quat swing, twist;
    const quat q = quat_lua_arg_unit(L, 1, "q");
    const quat_status status = quat_swing_twist(q, direction(L, 2, "axis"), &swing, &twist);
    quat_lua_push_quat(L, swing);
    quat_lua_push_quat(L, twist);
    return quat_lua_results(L, status, 2);
}

/* ---- angular velocity ---- */

static quat_frame frame(lua_State *L, int index)
{
    static const char *const frames[] = {"world", "body", NULL};
    if (lua_isnoneornil(L, index)) return QUAT_WORLD;
    return quat_lua_arg_choice(L, index, "frame", frames) == 1 ? QUAT_BODY : QUAT_WORLD;
}

static int l_step(lua_State *L)
{
    const quat q = quat_lua_arg_unit(L, 1, "q");
    const qvec3 omega = quat_lua_arg_vec3(L, 2, "omega");
    const double dt = quat_lua_arg_number(L, 3, "dt", QUAT_LUA_FINITE);
    quat_lua_push_quat(L, frame(L, 4) == QUAT_BODY ? quat_step_body(q, omega, dt) : quat_step_world(q, omega, dt));
    return 1;
}

static int l_derivative(lua_State *L)
{
    const quat q = quat_lua_arg_unit(L, 1, "q");
    const qvec3 omega = quat_lua_arg_vec3(L, 2, "omega");
    quat_lua_push_quat(L, frame(L, 3) == QUAT_BODY ? quat_derivative_body(q, omega) : quat_derivative_world(q, omega));
    return 1;
}

static int l_omega(lua_State *L)
{
    const quat q = quat_lua_arg_unit(L, 1, "q"), dq = quat_lua_arg_quat(L, 2, "dq");
    return quat_lua_give_vec3(L, frame(L, 3) == QUAT_BODY ? quat_omega_body(q, dq) : quat_omega_world(q, dq));
}

/* The script's function at time t. */
static qvec3 omega_at(lua_State *L, int function, double t)
{
    lua_pushvalue(L, function);
    lua_pushnumber(L, t);
    lua_call(L, 1, 1);
    const qvec3 omega = quat_lua_arg_vec3(L, lua_gettop(L), "omega(t)");
    lua_pop(L, 1);
    return omega;
}

/* integrate(q, omega, t0, t1, steps [, frame [, method]]); the loop is here, so that an error in omega passes through
 * no library. */
static int l_integrate(lua_State *L)
{
    static const char *const methods[] = {"magnus4", "cf4", "magnus8", NULL};
    static const quat_method known[] = {QUAT_MAGNUS4, QUAT_CF4, QUAT_MAGNUS8};
    quat q = quat_lua_arg_unit(L, 1, "q");
    if (!lua_isfunction(L, 2))
        return quat_lua_error(L, "argument 'omega' must be a function of time, got a %s", luaL_typename(L, 2));
    const double t0 = quat_lua_arg_number(L, 3, "t0", QUAT_LUA_FINITE),
                 t1 = quat_lua_arg_number(L, 4, "t1", QUAT_LUA_FINITE);
    const lua_Integer n = quat_lua_arg_integer(L, 5, "steps", 1, 1000000000);
    const quat_frame axes = frame(L, 6);
    const quat_method method = known[lua_isnoneornil(L, 7) ? 0 : quat_lua_arg_choice(L, 7, "method", methods)];
    const double h = (t1 - t0) / (double)n;
    double part[4];
    const int parts = quat_method_parts(method, part);
    for (lua_Integer i = 0; i < n; i++) {
        qvec3 omega[4];
        for (int k = 0; k < parts; k++) omega[k] = omega_at(L, 2, t0 + (double)i * h + part[k] * h);
        q = quat_renormalize(quat_step_by(method, q, omega, h, axes));
    }
    quat_lua_push_quat(L, q);
    return 1;
}

void quat_lua_open_rotation(lua_State *L)
{
    static const luaL_Reg methods[] = {{"rotate", l_rotate},
                                       {"rotate_inverse", l_rotate_inverse},
                                       {"to_rotation_vector", l_to_rotation_vector},
                                       {"to_axis_angle", l_to_axis_angle},
                                       {"to_matrix", l_to_matrix},
                                       {"to_euler", l_to_euler},
                                       {"swing_twist", l_swing_twist},
                                       {"step", l_step},
                                       {"derivative", l_derivative},
                                       {"omega", l_omega},
                                       {"integrate", l_integrate},
                                       {NULL, NULL}};
    static const luaL_Reg functions[] = {{"reflect", l_reflect},
                                         {"from_reflections", l_from_reflections},
                                         {"from_rotation_vector", l_from_rotation_vector},
                                         {"from_axis_angle", l_from_axis_angle},
                                         {"from_matrix", l_from_matrix},
                                         {"from_matrix_nearest", l_from_matrix_nearest},
                                         {"from_euler", l_from_euler},
                                         {"from_two_vectors", l_from_two_vectors},
                                         {"from_axes", l_from_axes},
                                         {"from_frame", l_from_frame},
                                         {NULL, NULL}};
    luaL_setfuncs(L, functions, 0);
    quat_lua_add_methods(L, methods);
}
