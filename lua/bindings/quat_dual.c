/* SPDX-License-Identifier: MIT
 *
 * Rigid motions in Lua: dual quaternions as a userdata, m1 * m2 applying m2 first.
 */
#include "quat_core.h"

#include <stdio.h>
#include <string.h>
#include <quat/dual.h>

#define DUAL "quat.dual"

static qdual motion(lua_State *L, int index, const char *name)
{
    const qdual *const p = luaL_testudata(L, index, DUAL);
    if (!p) quat_lua_error(L, "argument '%s' must be a motion, got a %s", name, luaL_typename(L, index));
    return *p;
}

static int give(lua_State *L, qdual p)
{
    if (!quat_isfinite(p.real) || !quat_isfinite(p.dual)) /* of finite operands: an overflow */
        return quat_lua_error(L, "the motion is not finite: %s", quat_status_string(QUAT_ERANGE));
    qdual *const place = lua_newuserdatauv(L, sizeof p, 0);
    *place = p;
    luaL_setmetatable(L, DUAL);
    return 1;
}

/* motion(q, shift): x -> q x q* + shift. */
static int l_motion(lua_State *L)
{
    const quat q = quat_lua_arg_unit(L, 1, "q");
    return give(L, quat_dual_from(q, quat_lua_arg_vec3(L, 2, "shift")));
}

static int l_screw(lua_State *L)
{
    qdual p;
    const qvec3 axis = quat_lua_arg_vec3(L, 1, "axis"), point = quat_lua_arg_vec3(L, 2, "point");
    const double angle = quat_lua_arg_number(L, 3, "angle", QUAT_LUA_FINITE),
                 slide = quat_lua_arg_number(L, 4, "slide", QUAT_LUA_FINITE);
    const quat_status status = quat_dual_from_screw(axis, point, angle, slide, &p);
    return status < 0 ? quat_lua_failure(L, quat_status_string(status)) : give(L, p);
}

/* motion_from_parts(real, dual): the unit dual quaternion nearest in direction. */
static int l_motion_from_parts(lua_State *L)
{
    qdual p;
    const quat real = quat_lua_arg_quat(L, 1, "real");
    const quat_status status = quat_dual_normalize(quat_dual_make(real, quat_lua_arg_quat(L, 2, "dual")), &p);
    return status < 0 ? quat_lua_failure(L, quat_status_string(status)) : give(L, p);
}

static int l_motion_exp(lua_State *L)
{
    const qtwist twist = {quat_lua_arg_vec3(L, 1, "rotation"), quat_lua_arg_vec3(L, 2, "translation")};
    return give(L, quat_dual_exp(twist));
}

static int meta_mul(lua_State *L) { return give(L, quat_dual_mul(motion(L, 1, "left"), motion(L, 2, "right"))); }

static int meta_eq(lua_State *L)
{
    const qdual *const p = luaL_testudata(L, 1, DUAL), *const q = luaL_testudata(L, 2, DUAL);
    lua_pushboolean(L, p && q && quat_equal(p->real, q->real) && quat_equal(p->dual, q->dual));
    return 1;
}

static int meta_tostring(lua_State *L)
{
    const qdual p = motion(L, 1, "motion");
    const qvec3 s = quat_dual_shift(p);
    char text[240];
    snprintf(text, sizeof text, "motion: turn (%.14g, %.14g, %.14g, %.14g), shift (%.14g, %.14g, %.14g)", p.real.w,
             p.real.x, p.real.y, p.real.z, s.x, s.y, s.z);
    lua_pushstring(L, text);
    return 1;
}

static int l_inverse(lua_State *L) { return give(L, quat_dual_conj(motion(L, 1, "motion"))); }
static int l_apply(lua_State *L)
{
    return quat_lua_give_vec3(L, quat_dual_apply(motion(L, 1, "motion"), quat_lua_arg_vec3(L, 2, "x")));
}
static int l_apply_inverse(lua_State *L)
{
    return quat_lua_give_vec3(L, quat_dual_apply_inverse(motion(L, 1, "motion"), quat_lua_arg_vec3(L, 2, "x")));
}
static int l_shift(lua_State *L) { return quat_lua_give_vec3(L, quat_dual_shift(motion(L, 1, "motion"))); }

static int l_rotation(lua_State *L)
{
    quat_lua_push_quat(L, motion(L, 1, "motion").real);
    return 1;
}

static int l_parts(lua_State *L)
{
    const qdual p = motion(L, 1, "motion");
    quat_lua_push_quat(L, p.real);
    quat_lua_push_quat(L, p.dual);
    return 2;
}

static int l_log(lua_State *L)
{
    const qtwist twist = quat_dual_log(motion(L, 1, "motion"));
    quat_lua_push_vec3(L, twist.rotation);
    quat_lua_push_vec3(L, twist.translation);
    return 2;
}

static int l_sclerp(lua_State *L)
{
    const qdual p = motion(L, 1, "p"), q = motion(L, 2, "q");
    return give(L, quat_dual_sclerp(p, q, quat_lua_arg_number(L, 3, "t", QUAT_LUA_FINITE)));
}

/* blend(motions [, weights]) */
static int l_blend(lua_State *L)
{
    qdual blend;
    lua_settop(L, 2); /* before buffers take the places of absent arguments */
    if (lua_type(L, 1) != LUA_TTABLE)
        return quat_lua_error(L, "argument 'motions' must be a list, got a %s", luaL_typename(L, 1));
    const size_t n = lua_rawlen(L, 1);
    if (n == 0) return quat_lua_error(L, "argument 'motions' must not be empty");
    qdual *const p = lua_newuserdatauv(L, n * sizeof *p, 0);
    for (size_t i = 0; i < n; i++) {
        lua_rawgeti(L, 1, (lua_Integer)i + 1);
        p[i] = motion(L, lua_gettop(L), "motions");
        lua_pop(L, 1);
    }
    const quat_status status = quat_dual_blend(n, p, quat_lua_arg_weights(L, 2, n), &blend);
    return status < 0 ? quat_lua_failure(L, quat_status_string(status)) : give(L, blend);
}

/* axis, point, angle, slide [, reason] */
static int l_to_screw(lua_State *L)
{
    qvec3 axis, point;
    double angle, slide;
    const quat_status status = quat_dual_to_screw(motion(L, 1, "motion"), &axis, &point, &angle, &slide);
    quat_lua_push_vec3(L, axis);
    quat_lua_push_vec3(L, point);
    lua_pushnumber(L, angle);
    lua_pushnumber(L, slide);
    return quat_lua_results(L, status, 4);
}

void quat_lua_open_dual(lua_State *L)
{
    static const luaL_Reg meta[] = {
        {"__mul", meta_mul}, {"__eq", meta_eq}, {"__tostring", meta_tostring}, {NULL, NULL}};
    static const luaL_Reg methods[] = {{"inverse", l_inverse},
                                       {"apply", l_apply},
                                       {"apply_inverse", l_apply_inverse},
                                       {"shift", l_shift},
                                       {"rotation", l_rotation},
                                       {"parts", l_parts},
                                       {"log", l_log},
                                       {"sclerp", l_sclerp},
                                       {"to_screw", l_to_screw},
                                       {NULL, NULL}};
    static const luaL_Reg functions[] = {{"motion", l_motion}, {"motion_from_parts", l_motion_from_parts},
                                         {"screw", l_screw},   {"motion_exp", l_motion_exp},
                                         {"blend", l_blend},   {NULL, NULL}};
    luaL_newmetatable(L, DUAL);
    luaL_setfuncs(L, meta, 0);
    lua_newtable(L);
    luaL_setfuncs(L, methods, 0);
    lua_setfield(L, -2, "__index");
    lua_pop(L, 1);
    luaL_setfuncs(L, functions, 0);
}
