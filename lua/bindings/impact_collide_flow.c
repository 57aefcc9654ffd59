/* SPDX-License-Identifier: MIT
 *
 * impact.flow{}: the sliding during an impact, as data.
 */
#include "impact_collide.h"

static void push_directions(lua_State *L, const impact_flow *flow)
{
    impact_flow_direction directions[4];
    const int n = impact_flow_directions(flow, directions);
    lua_createtable(L, n, 0);
    for (int i = 0; i < n; i++) {
        lua_createtable(L, 0, 4);
        quat_lua_set_number(L, "theta", directions[i].theta);
        quat_lua_set_number(L, "rate", directions[i].rate);
        quat_lua_set_number(L, "climb", directions[i].climb);
        quat_lua_set_number(L, "pull", directions[i].pull);
        lua_rawseti(L, -2, i + 1);
    }
}

static void push_points(lua_State *L, const impact_flow_point *points, int count)
{
    static const char *const names[] = {"p", "ux", "uy", "uz", "s", "theta", "px", "py"};
    for (int k = 0; k < 8; k++) {
        lua_createtable(L, count, 0);
        for (int i = 0; i < count; i++) {
            const impact_flow_point *at = &points[i];
            const double values[] = {at->p,     at->velocity[0], at->velocity[1], at->velocity[2],
                                     at->speed, at->theta,       at->impulse[0],  at->impulse[1]};
            lua_pushnumber(L, values[k]);
            lua_rawseti(L, -2, i + 1);
        }
        lua_setfield(L, -2, names[k]);
    }
    lua_createtable(L, count, 0);
    for (int i = 0; i < count; i++) {
        lua_pushboolean(L, points[i].stick);
        lua_rawseti(L, -2, i + 1);
    }
    lua_setfield(L, -2, "stick");
}

/* flow{a=, b=, c=, d=, m=, mu=, u={ux, uy, uz}, p_end=, count=}, or the keys of collide with p_end and count. */
int impact_lua_flow(lua_State *L)
{
    static const char *const plain_keys[] = {"a", "b", "c", "d", "m", "mu", "u", "p_end", "count", NULL};
    static const char *const collision_keys[] = {"m1", "J1", "r1", "v1", "w1",    "m2",    "J2", "r2",
                                                 "v2", "w2", "n",  "mu", "p_end", "count", NULL};
    luaL_checktype(L, 1, LUA_TTABLE);
    lua_getfield(L, 1, "a");
    const bool plain = !lua_isnil(L, -1);
    lua_pop(L, 1);
    const quat_lua_reader reader = quat_lua_read(L, 1, "flow", NULL, plain ? plain_keys : collision_keys);
    impact_flow data = {.t1 = {1, 0, 0}, .t2 = {0, 1, 0}, .n = {0, 0, 1}};
    double u[3];
    if (plain) {
        data.a = quat_lua_get_number(&reader, "a", QUAT_LUA_POSITIVE, 1);
        data.b = quat_lua_get_number(&reader, "b", QUAT_LUA_POSITIVE, 1);
        data.c = quat_lua_get_number(&reader, "c", QUAT_LUA_FINITE, 0);
        data.d = quat_lua_get_number(&reader, "d", QUAT_LUA_FINITE, 0);
        data.m = quat_lua_get_number(&reader, "m", QUAT_LUA_POSITIVE, 1);
        quat_lua_need(&reader, "u");
        const qvec3 v = quat_lua_get_vec3(&reader, "u", (qvec3){0, 0, 0});
        u[0] = v.x, u[1] = v.y, u[2] = v.z;
    } else {
        impact_collision c;
        char message[200];
        impact_lua_read_collision(&reader, &c);
        if (impact_collide_check(&c, message, sizeof message) != IMPACT_OK)
            return quat_lua_reader_error(&reader, "%s", message);
        impact_flow_make(&c, &data, u);
    }
    data.friction = quat_lua_get_number(&reader, "mu", QUAT_LUA_NOT_NEGATIVE, 0);
    quat_lua_need(&reader, "p_end");
    const double p_end = quat_lua_get_number(&reader, "p_end", QUAT_LUA_POSITIVE, 1);
    const int count = (int)quat_lua_get_integer(&reader, "count", 2, 1000000, 200);
    if (data.c * data.c / data.a + data.d * data.d / data.b >= data.m)
        return quat_lua_reader_error(&reader, "M must be positive definite: c^2/a + d^2/b < m");
    impact_flow_point *points = lua_newuserdatauv(L, sizeof *points * (size_t)count, 0);
    const impact_status status = impact_flow_sample(&data, u, p_end, count, points);
    if (status != IMPACT_OK) return quat_lua_failure(L, impact_status_string(status));
    lua_createtable(L, 0, 20);
    push_points(L, points, count);
    push_directions(L, &data);
    lua_setfield(L, -2, "directions");
    quat_lua_set_vec3(L, "t1", data.t1);
    quat_lua_set_vec3(L, "t2", data.t2);
    quat_lua_set_vec3(L, "normal", data.n);
    quat_lua_set_number(L, "a", data.a);
    quat_lua_set_number(L, "b", data.b);
    quat_lua_set_number(L, "c", data.c);
    quat_lua_set_number(L, "d", data.d);
    quat_lua_set_number(L, "m", data.m);
    return 1;
}
