/* SPDX-License-Identifier: MIT
 *
 * Interpolation between two and four rotations in Lua.
 */
#include "quat_core.h"

#include <quat/interpolate.h>

/* The last argument, "short" unless given. */
static bool as_given(lua_State *L, int index)
{
    static const char *const ways[] = {"short", "as_given", NULL};
    return !lua_isnoneornil(L, index) && quat_lua_arg_choice(L, index, "way", ways) == 1;
}

/* One of the two forms of f(p, q, t [, "short" | "as_given"]). */
static int between(lua_State *L, quat (*rotations)(quat, quat, double), quat (*points)(quat, quat, double))
{
    const quat p = quat_lua_arg_unit(L, 1, "p"), q = quat_lua_arg_unit(L, 2, "q");
    const double t = quat_lua_arg_number(L, 3, "t", QUAT_LUA_FINITE);
    quat_lua_push_quat(L, as_given(L, 4) ? points(p, q, t) : rotations(p, q, t));
    return 1;
}

static int l_slerp(lua_State *L) { return between(L, quat_slerp, quat_slerp_as_given); }
static int l_nlerp(lua_State *L) { return between(L, quat_nlerp, quat_nlerp_as_given); }

static int l_slerp_omega(lua_State *L)
{
    const quat p = quat_lua_arg_unit(L, 1, "p"), q = quat_lua_arg_unit(L, 2, "q");
    return quat_lua_give_vec3(L, as_given(L, 3) ? quat_slerp_as_given_omega(p, q) : quat_slerp_omega(p, q));
}

static int l_nlerp_omega(lua_State *L)
{
    const quat p = quat_lua_arg_unit(L, 1, "p"), q = quat_lua_arg_unit(L, 2, "q");
    const double t = quat_lua_arg_number(L, 3, "t", QUAT_LUA_FINITE);
    return quat_lua_give_vec3(L, as_given(L, 4) ? quat_nlerp_as_given_omega(p, q, t) : quat_nlerp_omega(p, q, t));
}

static int l_squad(lua_State *L)
{
    const quat p = quat_lua_arg_unit(L, 1, "p"), a = quat_lua_arg_unit(L, 2, "a"), b = quat_lua_arg_unit(L, 3, "b"),
               q = quat_lua_arg_unit(L, 4, "q");
    quat_lua_push_quat(L, quat_squad(p, a, b, q, quat_lua_arg_number(L, 5, "t", QUAT_LUA_FINITE)));
    return 1;
}

static int l_squad_control(lua_State *L)
{
    quat_lua_push_quat(L, quat_squad_control(quat_lua_arg_unit(L, 1, "before"), quat_lua_arg_unit(L, 2, "q"),
                                             quat_lua_arg_unit(L, 3, "after")));
    return 1;
}

static int l_squad_omega(lua_State *L)
{
    const quat p = quat_lua_arg_unit(L, 1, "p"), a = quat_lua_arg_unit(L, 2, "a"), b = quat_lua_arg_unit(L, 3, "b"),
               q = quat_lua_arg_unit(L, 4, "q");
    return quat_lua_give_vec3(L, quat_squad_omega(p, a, b, q, quat_lua_arg_number(L, 5, "t", QUAT_LUA_FINITE)));
}

void quat_lua_open_interpolate(lua_State *L)
{
    static const luaL_Reg methods[] = {{"slerp", l_slerp},
                                       {"nlerp", l_nlerp},
                                       {"slerp_omega", l_slerp_omega},
                                       {"nlerp_omega", l_nlerp_omega},
                                       {NULL, NULL}};
    static const luaL_Reg functions[] = {
        {"squad", l_squad}, {"squad_control", l_squad_control}, {"squad_omega", l_squad_omega}, {NULL, NULL}};
    luaL_setfuncs(L, functions, 0);
    quat_lua_add_methods(L, methods);
}
