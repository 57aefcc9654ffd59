/* SPDX-License-Identifier: MIT
 *
 * Rotation splines in Lua: a userdata that frees its spline when it is collected.
 */
#include "quat_core.h"

#include <quat/spline.h>

#define SPLINE "quat.spline"

static const quat_spline *spline(lua_State *L)
{
    quat_spline *const *const place = luaL_checkudata(L, 1, SPLINE);
    if (!*place) quat_lua_error(L, "argument 'spline' has been closed");
    return *place;
}

/* spline{times = {...}, keys = {...} [, ends = "natural" | "clamped" | "periodic", omega_first = v, omega_last = v]} */
static int l_spline(lua_State *L)
{
    static const char *const keys[] = {"times", "keys", "ends", "omega_first", "omega_last", NULL};
    static const char *const ends[] = {"natural", "clamped", "periodic", NULL};
    const quat_lua_reader reader = quat_lua_read(L, 1, "spline", NULL, keys);
    const qvec3 zero = {0, 0, 0};
    quat_lua_need(&reader, "times");
    quat_lua_need(&reader, "keys");
    const int end = quat_lua_get_choice(&reader, "ends", ends, QUAT_SPLINE_NATURAL);
    if (end == QUAT_SPLINE_CLAMPED) {
        quat_lua_need(&reader, "omega_first");
        quat_lua_need(&reader, "omega_last");
    }
    const qvec3 first = quat_lua_get_vec3(&reader, "omega_first", zero),
                last = quat_lua_get_vec3(&reader, "omega_last", zero);
    size_t n, count;
    lua_getfield(L, 1, "times");
    const double *const t = quat_lua_arg_numbers(L, lua_gettop(L), "times", 2, &n);
    lua_getfield(L, 1, "keys");
    const quat *const q = quat_lua_arg_quats(L, lua_gettop(L), "keys", 2, &count);
    if (count != n) return quat_lua_reader_error(&reader, "%d times but %d keys", (int)n, (int)count);

    quat_spline **const place = lua_newuserdatauv(L, sizeof *place, 0);
    *place = NULL;
    luaL_setmetatable(L, SPLINE);
    const quat_status status = quat_spline_new(n, t, q, (quat_spline_end)end, first, last, place);
    if (status == QUAT_NOT_CONVERGED || status == QUAT_ENOMEM || status == QUAT_ERANGE)
        return quat_lua_failure(L, quat_status_string(status));
    if (status == QUAT_EARGUMENT)
        return quat_lua_reader_error(
            &reader, end == QUAT_SPLINE_PERIODIC
                         ? "times must increase, and the last of at least 3 keys must be the first again"
                         : "times must increase");
    if (status != QUAT_OK) return quat_lua_reader_error(&reader, "keys must not be zero");
    return 1;
}

static int l_at(lua_State *L)
{
    quat_lua_push_quat(L, quat_spline_at(spline(L), quat_lua_arg_number(L, 2, "t", QUAT_LUA_FINITE)));
    return 1;
}

static int l_state(lua_State *L)
{
    qvec3 omega, acceleration;
    quat_lua_push_quat(
        L, quat_spline_state(spline(L), quat_lua_arg_number(L, 2, "t", QUAT_LUA_FINITE), &omega, &acceleration));
    quat_lua_push_vec3(L, omega);
    quat_lua_push_vec3(L, acceleration);
    return 3;
}

static int l_length(lua_State *L)
{
    const double t = lua_isnoneornil(L, 2) ? INFINITY : quat_lua_arg_number(L, 2, "t", QUAT_LUA_FINITE);
    lua_pushnumber(L, quat_spline_length(spline(L), t));
    return 1;
}

static int l_time_at(lua_State *L)
{
    lua_pushnumber(L, quat_spline_time_at(spline(L), quat_lua_arg_number(L, 2, "length", QUAT_LUA_FINITE)));
    return 1;
}

static int l_close(lua_State *L)
{
    quat_spline **const place = luaL_checkudata(L, 1, SPLINE);
    quat_spline_free(*place);
    *place = NULL;
    return 0;
}

void quat_lua_open_spline(lua_State *L)
{
    static const luaL_Reg methods[] = {{"at", l_at},           {"state", l_state}, {"length", l_length},
                                       {"time_at", l_time_at}, {"close", l_close}, {NULL, NULL}};
    static const luaL_Reg functions[] = {{"spline", l_spline}, {NULL, NULL}};
    luaL_newmetatable(L, SPLINE);
    lua_newtable(L);
    luaL_setfuncs(L, methods, 0);
    lua_setfield(L, -2, "__index");
    lua_pushcfunction(L, l_close);
    lua_setfield(L, -2, "__gc");
    lua_pushcfunction(L, l_close);
    lua_setfield(L, -2, "__close");
    lua_pop(L, 1);
    luaL_setfuncs(L, functions, 0);
}
