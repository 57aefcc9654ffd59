/* SPDX-License-Identifier: MIT
 *
 * Rotation sequences in Lua: the belt, spinor discs, bands, the rolled ball, chains.
 */
#include "quat_core.h"

#include <quat/sequence.h>

static double number(lua_State *L, int index, const char *name)
{
    return quat_lua_arg_number(L, index, name, QUAT_LUA_FINITE);
}

static int give(lua_State *L, quat q)
{
    quat_lua_push_quat(L, q);
    return 1;
}

/* ---- the belt ---- */

static int l_belt_twist(lua_State *L) { return give(L, quat_belt_twist(number(L, 1, "angle"), number(L, 2, "t"))); }
static int l_belt_untwist(lua_State *L) { return give(L, quat_belt_untwist(number(L, 1, "s"), number(L, 2, "t"))); }
static int l_belt_centre(lua_State *L)
{
    return quat_lua_give_vec3(L, quat_belt_centre(number(L, 1, "s"), number(L, 2, "t")));
}

/* belt_frames(s, n) -> rotations, places */
static int l_belt_frames(lua_State *L)
{
    const double s = number(L, 1, "s");
    const size_t n = (size_t)quat_lua_arg_integer(L, 2, "n", 1, 10000000);
    quat *const q = lua_newuserdatauv(L, n * sizeof *q, 0);
    qvec3 *const centre = lua_newuserdatauv(L, n * sizeof *centre, 0);
    quat_belt_frames(s, n, q, centre);
    quat_lua_push_quats(L, n, q);
    quat_lua_push_vec3s(L, n, centre);
    return 2;
}

/* ---- spinor discs ---- */

static int l_spinor_arrows(lua_State *L)
{
    enum { most = 1000000 };
    const double angle = number(L, 1, "angle");
    const size_t n = quat_spinor_arrows(angle, 0, NULL);
    if (n > most) return quat_lua_error(L, "argument 'angle' would give more than %d arrows, got %g", most, angle);
    double *const arrows = lua_newuserdatauv(L, (n + 1) * sizeof *arrows, 0);
    quat_spinor_arrows(angle, n, arrows);
    quat_lua_push_numbers(L, n, arrows);
    return 1;
}

static int l_spinor_place(lua_State *L)
{
    lua_pushnumber(L, quat_spinor_place(number(L, 1, "angle")));
    return 1;
}

/* ---- bands ---- */

static int l_band(lua_State *L) { return give(L, quat_band(number(L, 1, "twist"), number(L, 2, "u"))); }

static int l_loop_sign(lua_State *L)
{
    size_t n;
    const quat *const q = quat_lua_arg_quats(L, 1, "q", 0, &n);
    lua_pushinteger(L, quat_loop_sign(n, q));
    return 1;
}

/* ---- the ball ---- */

static int l_roll(lua_State *L)
{
    const quat q = quat_lua_arg_unit(L, 1, "q");
    return give(L, quat_roll(q, number(L, 2, "dx"), number(L, 3, "dy")));
}

static int l_roll_path(lua_State *L)
{
    size_t n;
    const quat start = quat_lua_arg_unit(L, 1, "start");
    const qvec2 *const hand = quat_lua_arg_vec2s(L, 2, "hand", 0, &n);
    quat *const q = lua_newuserdatauv(L, (n + 1) * sizeof *q, 0);
    quat_roll_path(start, n, hand, q);
    quat_lua_push_quats(L, n, q);
    return 1;
}

static int l_roll_circle(lua_State *L)
{
    return give(L, quat_roll_circle(number(L, 1, "radius"), number(L, 2, "angle")));
}

static int l_roll_loop(lua_State *L) { return quat_lua_give_vec3(L, quat_roll_loop(number(L, 1, "radius"))); }

/* ---- chains ---- */

/* chain(start, turns, parts [, "world" | "body"]) */
static int l_chain(lua_State *L)
{
    static const char *const frames[] = {"world", "body", NULL};
    size_t legs;
    lua_settop(L, 4); /* before buffers take the places of absent arguments */
    const quat start = quat_lua_arg_unit(L, 1, "start");
    const qvec3 *const turns = quat_lua_arg_vec3s(L, 2, "turns", 0, &legs);
    const size_t parts = (size_t)quat_lua_arg_integer(L, 3, "parts", 1, 1000000);
    const bool body = !lua_isnil(L, 4) && quat_lua_arg_choice(L, 4, "frame", frames) == 1;
    quat *const q = lua_newuserdatauv(L, (legs * parts + 1) * sizeof *q, 0);
    const quat_status status = quat_chain(start, legs, turns, body ? QUAT_BODY : QUAT_WORLD, parts, q);
    quat_lua_push_quats(L, legs * parts + 1, q);
    return quat_lua_results(L, status, 1);
}

void quat_lua_open_sequence(lua_State *L)
{
    static const luaL_Reg methods[] = {{"roll", l_roll}, {NULL, NULL}};
    static const luaL_Reg functions[] = {{"belt_twist", l_belt_twist},
                                         {"belt_untwist", l_belt_untwist},
                                         {"belt_centre", l_belt_centre},
                                         {"belt_frames", l_belt_frames},
                                         {"spinor_arrows", l_spinor_arrows},
                                         {"spinor_place", l_spinor_place},
                                         {"band", l_band},
                                         {"loop_sign", l_loop_sign},
                                         {"roll_path", l_roll_path},
                                         {"roll_circle", l_roll_circle},
                                         {"roll_loop", l_roll_loop},
                                         {"chain", l_chain},
                                         {NULL, NULL}};
    luaL_setfuncs(L, functions, 0);
    quat_lua_add_methods(L, methods);
}
