/* SPDX-License-Identifier: MIT
 *
 * Quaternions in Lua: construction, operators, algebra, exp and log.
 */
#include "quat_core.h"

#include <stdio.h>
#include <string.h>
#include <quat/exponential.h>

static quat arg(lua_State *L, int index, const char *name) { return quat_lua_arg_quat(L, index, name); }

static int give(lua_State *L, quat q)
{
    quat_lua_push_quat(L, q);
    return 1;
}

static int number(lua_State *L, double x)
{
    lua_pushnumber(L, x);
    return 1;
}

/* ---- making and reading ---- */

static int l_new(lua_State *L)
{
    if (lua_gettop(L) == 1) return give(L, arg(L, 1, "q"));
    const double w = quat_lua_arg_number(L, 1, "w", QUAT_LUA_FINITE),
                 x = quat_lua_arg_number(L, 2, "x", QUAT_LUA_FINITE);
    const double y = quat_lua_arg_number(L, 3, "y", QUAT_LUA_FINITE),
                 z = quat_lua_arg_number(L, 4, "z", QUAT_LUA_FINITE);
    return give(L, quat_make(w, x, y, z));
}

static int l_identity(lua_State *L) { return give(L, quat_identity()); }
static int l_pure(lua_State *L) { return give(L, quat_pure(quat_lua_arg_vec3(L, 1, "v"))); }

static int l_components(lua_State *L)
{
    const quat q = arg(L, 1, "q");
    lua_pushnumber(L, q.w);
    lua_pushnumber(L, q.x);
    lua_pushnumber(L, q.y);
    lua_pushnumber(L, q.z);
    return 4;
}

static int l_vector(lua_State *L) { return quat_lua_give_vec3(L, quat_vector(arg(L, 1, "q"))); }

/* q.w, q.x, q.y, q.z, or a method. */
static int meta_index(lua_State *L)
{
    const quat *const q = luaL_checkudata(L, 1, QUAT_LUA_QUAT);
    const char *const key = lua_type(L, 2) == LUA_TSTRING ? lua_tostring(L, 2) : "";
    if (key[0] != '\0' && key[1] == '\0') {
        switch (key[0]) {
        case 'w': return number(L, q->w);
        case 'x': return number(L, q->x);
        case 'y': return number(L, q->y);
        case 'z': return number(L, q->z);
        default: break;
        }
    }
    lua_pushvalue(L, 2);
    lua_rawget(L, lua_upvalueindex(1));
    return 1;
}

static int meta_newindex(lua_State *L)
{
    return quat_lua_error(L, "'%s' cannot be set: quaternions do not change; make another with quat.new",
                          luaL_tolstring(L, 2, NULL));
}

static int meta_tostring(lua_State *L)
{
    const quat *const q = luaL_checkudata(L, 1, QUAT_LUA_QUAT);
    char text[120];
    snprintf(text, sizeof text, "(%.14g, %.14g, %.14g, %.14g)", q->w, q->x, q->y, q->z);
    lua_pushstring(L, text);
    return 1;
}

/* ---- operators; a number stands for a real quaternion ---- */

static quat operand(lua_State *L, int index)
{
    if (lua_type(L, index) == LUA_TNUMBER) {
        const double x = quat_lua_arg_number(L, index, index == 1 ? "left" : "right", QUAT_LUA_FINITE);
        return quat_make(x, 0, 0, 0);
    }
    return arg(L, index, index == 1 ? "left" : "right");
}

static int meta_add(lua_State *L) { return give(L, quat_add(operand(L, 1), operand(L, 2))); }
static int meta_sub(lua_State *L) { return give(L, quat_sub(operand(L, 1), operand(L, 2))); }
static int meta_unm(lua_State *L) { return give(L, quat_neg(operand(L, 1))); }

static int meta_mul(lua_State *L)
{
    if (lua_type(L, 2) == LUA_TNUMBER) return give(L, quat_scale(operand(L, 1), operand(L, 2).w));
    if (lua_type(L, 1) == LUA_TNUMBER) return give(L, quat_scale(operand(L, 2), operand(L, 1).w));
    return give(L, quat_mul(operand(L, 1), operand(L, 2)));
}

/* Division by zero is misuse, not an expected failure: an operator cannot return nil and a message. */
static int meta_div(lua_State *L)
{
    quat r;
    const quat_status status = quat_div(operand(L, 1), operand(L, 2), &r);
    if (status < 0) return quat_lua_error(L, "division of quaternions: %s", quat_status_string(status));
    return give(L, r);
}

static int meta_pow(lua_State *L)
{
    quat r;
    const quat_status status = lua_type(L, 2) == LUA_TNUMBER ? quat_pow(operand(L, 1), operand(L, 2).w, &r)
                                                             : quat_pow_quat(operand(L, 1), operand(L, 2), &r);
    if (status < 0) return quat_lua_error(L, "power of quaternions: %s", quat_status_string(status));
    return give(L, r);
}

static int meta_eq(lua_State *L)
{
    const quat *const p = luaL_testudata(L, 1, QUAT_LUA_QUAT), *const q = luaL_testudata(L, 2, QUAT_LUA_QUAT);
    lua_pushboolean(L, p && q && quat_equal(*p, *q));
    return 1;
}

/* ---- algebra ---- */

static int l_conj(lua_State *L) { return give(L, quat_conj(arg(L, 1, "q"))); }
static int l_norm(lua_State *L) { return number(L, quat_norm(arg(L, 1, "q"))); }
static int l_dot(lua_State *L) { return number(L, quat_dot(arg(L, 1, "p"), arg(L, 2, "q"))); }
static int l_mul_compensated(lua_State *L) { return give(L, quat_mul_compensated(arg(L, 1, "p"), arg(L, 2, "q"))); }

/* One of the functions of one quaternion that can fail. */
static int of_one(lua_State *L, quat_status (*function)(quat, quat *))
{
    quat r;
    const quat_status status = function(arg(L, 1, "q"), &r);
    return quat_lua_result(L, status, r);
}

static int l_inverse(lua_State *L) { return of_one(L, quat_inverse); }
static int l_normalize(lua_State *L) { return of_one(L, quat_normalize); }
static int l_exp(lua_State *L) { return of_one(L, quat_exp); }
static int l_log(lua_State *L) { return of_one(L, quat_log); }
static int l_sqrt(lua_State *L) { return of_one(L, quat_sqrt); }

static int l_div_left(lua_State *L)
{
    quat r;
    const quat_status status = quat_div_left(arg(L, 1, "q"), arg(L, 2, "p"), &r);
    return quat_lua_result(L, status, r);
}

/* On the unit sphere: exp_pure(v), q:log_unit(), q:pow_unit(t). */
static int l_exp_pure(lua_State *L) { return give(L, quat_exp_pure(quat_lua_arg_vec3(L, 1, "v"))); }
static int l_log_unit(lua_State *L) { return quat_lua_give_vec3(L, quat_log_unit(quat_lua_arg_unit(L, 1, "q"))); }
static int l_pow_unit(lua_State *L)
{
    const quat q = quat_lua_arg_unit(L, 1, "q");
    return give(L, quat_pow_unit(q, quat_lua_arg_number(L, 2, "exponent", QUAT_LUA_FINITE)));
}

static int l_pow(lua_State *L)
{
    quat r;
    const quat q = arg(L, 1, "q");
    const quat_status status = lua_type(L, 2) == LUA_TNUMBER
                                   ? quat_pow(q, quat_lua_arg_number(L, 2, "exponent", QUAT_LUA_FINITE), &r)
                                   : quat_pow_quat(q, arg(L, 2, "exponent"), &r);
    return quat_lua_result(L, status, r);
}

/* ---- distances ---- */

static int l_distance(lua_State *L)
{
    return number(L, quat_distance(quat_lua_arg_unit(L, 1, "p"), quat_lua_arg_unit(L, 2, "q")));
}
static int l_rotation_distance(lua_State *L)
{
    return number(L, quat_rotation_distance(quat_lua_arg_unit(L, 1, "p"), quat_lua_arg_unit(L, 2, "q")));
}
static int l_angle(lua_State *L) { return number(L, quat_angle(arg(L, 1, "q"))); }
static int l_nearest(lua_State *L) { return give(L, quat_nearest(arg(L, 1, "q"), arg(L, 2, "reference"))); }

static int l_near(lua_State *L)
{
    lua_pushboolean(
        L, quat_near(arg(L, 1, "p"), arg(L, 2, "q"), quat_lua_arg_number(L, 3, "tolerance", QUAT_LUA_NOT_NEGATIVE)));
    return 1;
}

static int l_same_rotation(lua_State *L)
{
    const quat p = quat_lua_arg_unit(L, 1, "p"), q = quat_lua_arg_unit(L, 2, "q");
    lua_pushboolean(L, quat_same_rotation(p, q, quat_lua_arg_number(L, 3, "angle", QUAT_LUA_NOT_NEGATIVE)));
    return 1;
}

/* ---- random: the caller's generator, math.random by default ---- */

static double uniform(void *state)
{
    lua_State *const L = state;
    lua_pushvalue(L, -1);
    lua_call(L, 0, 1);
    const double x = quat_lua_arg_number(L, lua_gettop(L), "generator()", QUAT_LUA_BELOW_ONE);
    lua_pop(L, 1);
    return x;
}

static int l_random(lua_State *L)
{
    if (lua_isnoneornil(L, 1)) {
        lua_getglobal(L, "math");
        lua_getfield(L, -1, "random");
    } else {
        lua_settop(L, 1);
    }
    if (!lua_isfunction(L, -1))
        return quat_lua_error(L, "argument 'generator' must be a function, got a %s", luaL_typename(L, -1));
    return give(L, quat_random(uniform, L));
}

void quat_lua_open_quat(lua_State *L)
{
    static const luaL_Reg meta[] = {
        {"__tostring", meta_tostring}, {"__add", meta_add}, {"__sub", meta_sub}, {"__mul", meta_mul},
        {"__div", meta_div},           {"__unm", meta_unm}, {"__pow", meta_pow}, {"__eq", meta_eq},
        {"__newindex", meta_newindex}, {NULL, NULL}};
    static const luaL_Reg methods[] = {{"components", l_components},
                                       {"vector", l_vector},
                                       {"conj", l_conj},
                                       {"norm", l_norm},
                                       {"dot", l_dot},
                                       {"mul_compensated", l_mul_compensated},
                                       {"inverse", l_inverse},
                                       {"normalize", l_normalize},
                                       {"div_left", l_div_left},
                                       {"exp", l_exp},
                                       {"log", l_log},
                                       {"sqrt", l_sqrt},
                                       {"pow", l_pow},
                                       {"log_unit", l_log_unit},
                                       {"pow_unit", l_pow_unit},
                                       {"distance", l_distance},
                                       {"rotation_distance", l_rotation_distance},
                                       {"angle", l_angle},
                                       {"nearest", l_nearest},
                                       {"near", l_near},
                                       {"same_rotation", l_same_rotation},
                                       {NULL, NULL}};
    static const luaL_Reg functions[] = {{"new", l_new},           {"identity", l_identity}, {"pure", l_pure},
                                         {"exp_pure", l_exp_pure}, {"random", l_random},     {NULL, NULL}};
    luaL_newmetatable(L, QUAT_LUA_QUAT);
    luaL_setfuncs(L, meta, 0);
    luaL_getsubtable(L, -1, "methods");
    lua_pushcclosure(L, meta_index, 1);
    lua_setfield(L, -2, "__index");
    lua_pop(L, 1);
    luaL_setfuncs(L, functions, 0);
    quat_lua_add_methods(L, methods);
}
