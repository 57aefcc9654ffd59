/* SPDX-License-Identifier: MIT
 *
 * impact.collide_many{count=, ...}: the keys of impact.collide, each one value for all or a list with one for each.
 */
#include "impact_collide.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static const char *const keys[] = {"count", "threads", "m1", "J1", "r1",  "v1",  "w1",     "m2",    "J2", "r2",
                                   "v2",    "w2",      "n",  "mu", "eps", "law", "solver", "order", NULL};

/* A key's value as columns of `width` numbers: one row for all, or one for each. */
typedef struct column {
    const char *key;
    int index; /* stack index of the list, or 0: `one` serves all */
    bool flat; /* a list of width * count numbers, not of tables */
    double one[3];
} column;

static double number_at(const quat_lua_reader *reader, const column *col, int index, lua_Integer i, lua_Integer row)
{
    int is_number;
    lua_rawgeti(reader->L, index, i);
    const double x = lua_tonumberx(reader->L, -1, &is_number);
    if (!is_number || isnan(x))
        quat_lua_reader_error(reader, "%s: number %lld of impact %lld is missing or no number", col->key, (long long)i,
                              (long long)row + 1);
    lua_pop(reader->L, 1);
    return x;
}

/* Leaves a list on the stack. */
static column open_numbers(const quat_lua_reader *reader, const char *key, double fallback, lua_Integer count)
{
    lua_State *L = reader->L;
    column col = {.key = key, .one = {fallback}};
    if (lua_getfield(L, reader->index, key) == LUA_TTABLE) {
        col.index = lua_gettop(L);
        col.flat = true;
        if ((lua_Integer)lua_rawlen(L, col.index) != count)
            quat_lua_reader_error(reader, "%s: a list of %lld numbers is needed, got %lld", key, (long long)count,
                                  (long long)lua_rawlen(L, col.index));
    } else if (!lua_isnil(L, -1)) {
        int is_number;
        col.one[0] = lua_tonumberx(L, -1, &is_number);
        if (!is_number || isnan(col.one[0]))
            quat_lua_reader_error(reader, "%s must be a number or a list of numbers", key);
    }
    return col;
}

static column open_vectors(const quat_lua_reader *reader, const char *key, lua_Integer count)
{
    lua_State *L = reader->L;
    column col = {.key = key};
    if (lua_getfield(L, reader->index, key) == LUA_TNIL) return col;
    if (!lua_istable(L, -1)) quat_lua_reader_error(reader, "%s must be a vector or a list", key);
    const int index = lua_gettop(L);
    const bool tables = lua_rawgeti(L, index, 1) == LUA_TTABLE;
    lua_pop(L, 1);
    const lua_Integer length = (lua_Integer)lua_rawlen(L, index);
    if (!tables && (length == 3 || length == 0)) {
        const qvec3 v = quat_lua_get_vec3(reader, key, (qvec3){0, 0, 0});
        col.one[0] = v.x, col.one[1] = v.y, col.one[2] = v.z;
        return col;
    }
    if (length != (tables ? count : 3 * count))
        quat_lua_reader_error(reader, "%s: a list of %lld %s is needed, got %lld", key,
                              (long long)(tables ? count : 3 * count), tables ? "vectors" : "numbers",
                              (long long)length);
    col.index = index;
    col.flat = !tables;
    return col;
}

static double number_of(const quat_lua_reader *reader, const column *col, lua_Integer row)
{
    return col->index ? number_at(reader, col, col->index, row + 1, row) : col->one[0];
}

static qvec3 vector_of(const quat_lua_reader *reader, const column *col, lua_Integer row)
{
    if (!col->index) return (qvec3){col->one[0], col->one[1], col->one[2]};
    lua_State *L = reader->L;
    double x[3];
    if (col->flat) {
        for (int k = 0; k < 3; k++) x[k] = number_at(reader, col, col->index, 3 * row + k + 1, row);
    } else {
        if (lua_rawgeti(L, col->index, row + 1) != LUA_TTABLE)
            quat_lua_reader_error(reader, "%s: vector %lld is missing", col->key, (long long)row + 1);
        for (int k = 0; k < 3; k++) x[k] = number_at(reader, col, lua_gettop(L), k + 1, row);
        lua_pop(L, 1);
    }
    return (qvec3){x[0], x[1], x[2]};
}

/* J1, J2: one inertia for all, or a list of them ({moments=} tables or 3 x 3 tensors). */
typedef struct inertia {
    int index;
    qvec3 moments;
    quat orientation;
} inertia;

static inertia open_inertia(const quat_lua_reader *reader, const char *key)
{
    lua_State *L = reader->L;
    inertia j = {.moments = {NAN, NAN, NAN}, .orientation = {1, 0, 0, 0}};
    if (lua_getfield(L, reader->index, key) == LUA_TNIL) return j;
    if (!lua_istable(L, -1)) quat_lua_reader_error(reader, "%s must be an inertia or a list of them", key);
    const int index = lua_gettop(L);
    /* A list: its first element is itself an inertia, {moments=} or a tensor of rows. */
    bool list = false;
    if (lua_rawgeti(L, index, 1) == LUA_TTABLE) {
        list = lua_getfield(L, -1, "moments") != LUA_TNIL;
        lua_pop(L, 1);
        list = lua_rawgeti(L, -1, 1) == LUA_TTABLE || list;
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    if (list)
        j.index = index;
    else
        impact_lua_read_inertia(reader, key, &j.moments, &j.orientation);
    return j;
}

static void inertia_of(const quat_lua_reader *reader, const char *key, const inertia *j, lua_Integer row,
                       impact_collider *body)
{
    body->moments = j->moments;
    body->orientation = j->orientation;
    if (!j->index) return;
    lua_rawgeti(reader->L, j->index, row + 1);
    impact_lua_read_inertia(reader, key, &body->moments, &body->orientation);
    lua_pop(reader->L, 1);
}

static void read_all(const quat_lua_reader *reader, impact_collision *c, lua_Integer count)
{
    static const char *const names[2][5] = {{"m1", "J1", "r1", "v1", "w1"}, {"m2", "J2", "r2", "v2", "w2"}};
    column mass[2], offset[2], velocity[2], omega[2];
    inertia j[2];
    for (int b = 0; b < 2; b++) {
        mass[b] = open_numbers(reader, names[b][0], INFINITY, count);
        j[b] = open_inertia(reader, names[b][1]);
        offset[b] = open_vectors(reader, names[b][2], count);
        velocity[b] = open_vectors(reader, names[b][3], count);
        omega[b] = open_vectors(reader, names[b][4], count);
    }
    const column normal = open_vectors(reader, "n", count), mu = open_numbers(reader, "mu", 0, count),
                 eps = open_numbers(reader, "eps", 0, count);
    const impact_law law = (impact_law)quat_lua_get_choice(reader, "law", impact_lua_laws, IMPACT_POISSON);
    const impact_solver solver =
        (impact_solver)quat_lua_get_choice(reader, "solver", impact_lua_solvers, IMPACT_SOLVER_AUTO);
    const int order = (int)quat_lua_get_integer(reader, "order", 8, 32, 0);
    for (lua_Integer i = 0; i < count; i++) {
        impact_collision *k = &c[i];
        *k = (impact_collision){.law = law, .solver = solver, .series_order = order};
        for (int b = 0; b < 2; b++) {
            k->body[b].mass = number_of(reader, &mass[b], i);
            inertia_of(reader, names[b][1], &j[b], i, &k->body[b]);
            k->body[b].offset = vector_of(reader, &offset[b], i);
            k->body[b].velocity = vector_of(reader, &velocity[b], i);
            k->body[b].omega = vector_of(reader, &omega[b], i);
        }
        k->normal = vector_of(reader, &normal, i);
        k->friction = number_of(reader, &mu, i);
        k->restitution = number_of(reader, &eps, i);
    }
}

static void push_vectors(lua_State *L, const char *key, const impact_outcome *o, lua_Integer count, size_t place)
{
    lua_createtable(L, (int)(3 * count), 0);
    for (lua_Integer i = 0; i < count; i++) {
        qvec3 v;
        memcpy(&v, (const char *)&o[i] + place, sizeof v);
        const double x[3] = {v.x, v.y, v.z};
        for (int k = 0; k < 3; k++) {
            lua_pushnumber(L, x[k]);
            lua_rawseti(L, -2, 3 * i + k + 1);
        }
    }
    lua_setfield(L, -2, key);
}

static void push_numbers(lua_State *L, const char *key, const impact_outcome *o, lua_Integer count, size_t place)
{
    lua_createtable(L, (int)count, 0);
    for (lua_Integer i = 0; i < count; i++) {
        double x;
        memcpy(&x, (const char *)&o[i] + place, sizeof x);
        lua_pushnumber(L, x);
        lua_rawseti(L, -2, i + 1);
    }
    lua_setfield(L, -2, key);
}

static void push_all(lua_State *L, const impact_outcome *o, const impact_status *statuses, lua_Integer count)
{
    lua_createtable(L, 0, 12);
    push_vectors(L, "v1", o, count, offsetof(impact_outcome, velocity));
    push_vectors(L, "v2", o, count, offsetof(impact_outcome, velocity) + sizeof(qvec3));
    push_vectors(L, "w1", o, count, offsetof(impact_outcome, omega));
    push_vectors(L, "w2", o, count, offsetof(impact_outcome, omega) + sizeof(qvec3));
    push_vectors(L, "impulse", o, count, offsetof(impact_outcome, impulse));
    push_numbers(L, "energy_before", o, count, offsetof(impact_outcome, energy_before));
    push_numbers(L, "energy_after", o, count, offsetof(impact_outcome, energy_after));
    push_numbers(L, "normal_after", o, count, offsetof(impact_outcome, normal_after));
    lua_createtable(L, (int)count, 0);
    for (lua_Integer i = 0; i < count; i++) {
        lua_pushstring(L, statuses[i] == IMPACT_OK           ? "ok"
                          : statuses[i] == IMPACT_SEPARATING ? "separating"
                                                             : impact_status_string(statuses[i]));
        lua_rawseti(L, -2, i + 1);
    }
    lua_setfield(L, -2, "status");
}

int impact_lua_collide_many(lua_State *L)
{
    const quat_lua_reader reader = quat_lua_read(L, 1, "collisions", NULL, keys);
    quat_lua_need(&reader, "count");
    quat_lua_need(&reader, "m1");
    quat_lua_need(&reader, "n");
    const lua_Integer count = quat_lua_get_integer(&reader, "count", 1, 100000000, 0);
    const int threads = (int)quat_lua_get_integer(&reader, "threads", 0, 256, 1);
    luaL_checkstack(L, 40, "collide_many");
    /* Blocks of Lua's own: nothing leaks when reading raises. */
    impact_collision *c = lua_newuserdatauv(L, sizeof *c * (size_t)count, 0);
    read_all(&reader, c, count);
    char message[200];
    for (lua_Integer i = 0; i < count; i++)
        if (impact_collide_check(&c[i], message, sizeof message) != IMPACT_OK)
            return quat_lua_reader_error(&reader, "impact %lld: %s", (long long)i + 1, message);
    impact_outcome *o = lua_newuserdatauv(L, sizeof *o * (size_t)count, 0);
    impact_status *statuses = lua_newuserdatauv(L, sizeof *statuses * (size_t)count, 0);
    impact_collide_many(c, (size_t)count, threads, o, statuses);
    push_all(L, o, statuses, count);
    return 1;
}
