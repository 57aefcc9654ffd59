/* SPDX-License-Identifier: MIT
 *
 * Derivatives in Lua: matrices as lists of rows, column order w, x, y, z for quaternions. Those of products and of the
 * operator are taken at q as it is given, of any length.
 */
#include "quat_core.h"

#include <quat/jacobian.h>

/* Returns the matrix to the script; nil and a message when it does not exist there (elements infinite or NaN). */
static int give(lua_State *L, int rows, int columns, const double m[])
{
    for (int i = 0; i < rows * columns; i++)
        if (!isfinite(m[i])) return quat_lua_failure(L, "the derivative does not exist here");
    quat_lua_push_matrix(L, rows, columns, m);
    return 1;
}

static int l_left_matrix(lua_State *L)
{
    const qmat4 m = quat_left_matrix(quat_lua_arg_quat(L, 1, "p"));
    return give(L, 4, 4, m.m[0]);
}

static int l_right_matrix(lua_State *L)
{
    const qmat4 m = quat_right_matrix(quat_lua_arg_quat(L, 1, "q"));
    return give(L, 4, 4, m.m[0]);
}

static int l_rotate_jacobian(lua_State *L)
{
    const quat q = quat_lua_arg_quat(L, 1, "q");
    const qmat34 m = quat_rotate_jacobian(q, quat_lua_arg_vec3(L, 2, "v"));
    return give(L, 3, 4, m.m[0]);
}

static int l_exp_jacobian(lua_State *L)
{
    const qmat43 m = quat_exp_jacobian(quat_lua_arg_vec3(L, 1, "v"));
    return give(L, 4, 3, m.m[0]);
}

static int l_log_jacobian(lua_State *L)
{
    const qmat34 m = quat_log_jacobian(quat_lua_arg_unit(L, 1, "q"));
    return give(L, 3, 4, m.m[0]);
}

/* One of the two forms of f(r [, "left" | "right"]). */
static int rotation_vector(lua_State *L, qmat3 (*left)(qvec3), qmat3 (*right)(qvec3))
{
    static const char *const sides[] = {"left", "right", NULL};
    const qvec3 r = quat_lua_arg_vec3(L, 1, "r");
    const bool is_right = !lua_isnoneornil(L, 2) && quat_lua_arg_choice(L, 2, "side", sides) == 1;
    const qmat3 m = is_right ? right(r) : left(r);
    return give(L, 3, 3, m.m[0]);
}

static int l_rotation_vector_jacobian(lua_State *L)
{
    return rotation_vector(L, quat_rotation_vector_jacobian_left, quat_rotation_vector_jacobian_right);
}

static int l_rotation_vector_jacobian_inverse(lua_State *L)
{
    return rotation_vector(L, quat_rotation_vector_jacobian_left_inverse, quat_rotation_vector_jacobian_right_inverse);
}

void quat_lua_open_jacobian(lua_State *L)
{
    static const luaL_Reg methods[] = {{"left_matrix", l_left_matrix},
                                       {"right_matrix", l_right_matrix},
                                       {"rotate_jacobian", l_rotate_jacobian},
                                       {"log_jacobian", l_log_jacobian},
                                       {NULL, NULL}};
    static const luaL_Reg functions[] = {{"exp_jacobian", l_exp_jacobian},
                                         {"rotation_vector_jacobian", l_rotation_vector_jacobian},
                                         {"rotation_vector_jacobian_inverse", l_rotation_vector_jacobian_inverse},
                                         {NULL, NULL}};
    luaL_setfuncs(L, functions, 0);
    quat_lua_add_methods(L, methods);
}
