/* SPDX-License-Identifier: MIT
 *
 * Vectors in Lua: operators and methods of the tables {x, y, z} that are handed out, and quat.vec3 to make one. The
 * other operand may be any {x, y, z} or {x = , y = , z = }.
 */
#include "quat_core.h"

static int give(lua_State *L, qvec3 v)
{
    if (!qvec3_isfinite(v)) /* of finite operands: an overflow */
        return quat_lua_error(L, "the result is (%f, %f, %f): %s", v.x, v.y, v.z, quat_status_string(QUAT_ERANGE));
    return quat_lua_give_vec3(L, v);
}

static qvec3 left(lua_State *L) { return quat_lua_arg_vec3(L, 1, "left"); }
static qvec3 right(lua_State *L) { return quat_lua_arg_vec3(L, 2, "right"); }

/* vec3(x, y, z) or vec3{x, y, z} */
static int l_vec3(lua_State *L)
{
    if (lua_gettop(L) == 1) return quat_lua_give_vec3(L, quat_lua_arg_vec3(L, 1, "v"));
    const double x = quat_lua_arg_number(L, 1, "x", QUAT_LUA_FINITE),
                 y = quat_lua_arg_number(L, 2, "y", QUAT_LUA_FINITE);
    return quat_lua_give_vec3(L, qvec3_make(x, y, quat_lua_arg_number(L, 3, "z", QUAT_LUA_FINITE)));
}

static int meta_add(lua_State *L) { return give(L, qvec3_add(left(L), right(L))); }
static int meta_sub(lua_State *L) { return give(L, qvec3_sub(left(L), right(L))); }
static int meta_unm(lua_State *L) { return give(L, qvec3_neg(left(L))); }

/* A vector and a number, in either order. */
static int meta_mul(lua_State *L)
{
    if (lua_type(L, 1) == LUA_TNUMBER)
        return give(L, qvec3_scale(right(L), quat_lua_arg_number(L, 1, "left", QUAT_LUA_FINITE)));
    if (lua_type(L, 2) != LUA_TNUMBER)
        return quat_lua_error(L, "a vector is multiplied by a number; of two vectors take v:dot(w) or v:cross(w)");
    return give(L, qvec3_scale(left(L), quat_lua_arg_number(L, 2, "right", QUAT_LUA_FINITE)));
}

static int meta_div(lua_State *L)
{
    const qvec3 v = left(L);
    const double s = quat_lua_arg_number(L, 2, "right", QUAT_LUA_FINITE);
    if (s == 0) return quat_lua_error(L, "division of a vector by zero");
    return give(L, qvec3_make(v.x / s, v.y / s, v.z / s));
}

static int l_dot(lua_State *L)
{
    const qvec3 v = quat_lua_arg_vec3(L, 1, "v");
    lua_pushnumber(L, qvec3_dot(v, quat_lua_arg_vec3(L, 2, "w")));
    return 1;
}

static int l_cross(lua_State *L)
{
    const qvec3 v = quat_lua_arg_vec3(L, 1, "v");
    return give(L, qvec3_cross(v, quat_lua_arg_vec3(L, 2, "w")));
}

static int l_norm(lua_State *L)
{
    lua_pushnumber(L, qvec3_norm(quat_lua_arg_vec3(L, 1, "v")));
    return 1;
}

static int l_normalize(lua_State *L)
{
    qvec3 unit;
    const quat_status status = qvec3_normalize(quat_lua_arg_vec3(L, 1, "v"), &unit);
    quat_lua_push_vec3(L, unit);
    return quat_lua_results(L, status, 1);
}

void quat_lua_open_vector(lua_State *L)
{
    static const luaL_Reg meta[] = {{"__add", meta_add}, {"__sub", meta_sub}, {"__unm", meta_unm},
                                    {"__mul", meta_mul}, {"__div", meta_div}, {NULL, NULL}};
    static const luaL_Reg methods[] = {
        {"dot", l_dot}, {"cross", l_cross}, {"norm", l_norm}, {"normalize", l_normalize}, {NULL, NULL}};
    quat_lua_push_vec3(L, qvec3_make(0, 0, 0)); /* its metatable is there from now on */
    lua_getmetatable(L, -1);
    luaL_setfuncs(L, meta, 0);
    luaL_getsubtable(L, -1, "methods");
    luaL_setfuncs(L, methods, 0);
    lua_pop(L, 3);
    lua_pushcfunction(L, l_vec3);
    lua_setfield(L, -2, "vec3");
}
