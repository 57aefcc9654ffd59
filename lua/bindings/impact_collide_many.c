/* SPDX-License-Identifier: MIT
 *
 * impact.collide_many{count=, ...}: the keys of impact.collide, each one value for all or a list with one for each.
 */
#include "impact_collide.h"

static const char *const keys[] = {"count", "threads", "m1", "J1", "r1",  "v1",  "w1",     "m2",    "J2",      "r2",
                                   "v2",    "w2",      "n",  "mu", "eps", "law", "solver", "order", "checked", NULL};

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

/* All keys, opened; `law` ... are the same for all. */
typedef struct batch {
    column mass[2], offset[2], velocity[2], omega[2], normal, mu, eps;
    inertia j[2];
    impact_law law;
    impact_solver solver;
    int order, threads;
    bool checked; /* by receipts */
} batch;

static const char *const body_keys[2][5] = {{"m1", "J1", "r1", "v1", "w1"}, {"m2", "J2", "r2", "v2", "w2"}};

static void open_all(const quat_lua_reader *reader, batch *b, lua_Integer count)
{
    for (int i = 0; i < 2; i++) {
        b->mass[i] = open_numbers(reader, body_keys[i][0], INFINITY, count);
        b->j[i] = open_inertia(reader, body_keys[i][1]);
        b->offset[i] = open_vectors(reader, body_keys[i][2], count);
        b->velocity[i] = open_vectors(reader, body_keys[i][3], count);
        b->omega[i] = open_vectors(reader, body_keys[i][4], count);
    }
    b->normal = open_vectors(reader, "n", count);
    b->mu = open_numbers(reader, "mu", 0, count);
    b->eps = open_numbers(reader, "eps", 0, count);
    b->law = (impact_law)quat_lua_get_choice(reader, "law", impact_lua_laws, IMPACT_POISSON);
    b->solver = (impact_solver)quat_lua_get_choice(reader, "solver", impact_lua_solvers, IMPACT_SOLVER_AUTO);
    b->order = (int)quat_lua_get_integer(reader, "order", 8, 32, 0);
    b->threads = (int)quat_lua_get_integer(reader, "threads", 0, 256, 1);
    b->checked = quat_lua_get_boolean(reader, "checked", false);
}

static void read_one(const quat_lua_reader *reader, const batch *b, lua_Integer row, impact_collision *c)
{
    *c = (impact_collision){.law = b->law, .solver = b->solver, .series_order = b->order};
    c->checking = b->checked ? IMPACT_CHECK_ALWAYS : IMPACT_CHECK_NEVER;
    for (int i = 0; i < 2; i++) {
        impact_collider *body = &c->body[i];
        body->mass = number_of(reader, &b->mass[i], row);
        inertia_of(reader, body_keys[i][1], &b->j[i], row, body);
        body->offset = vector_of(reader, &b->offset[i], row);
        body->velocity = vector_of(reader, &b->velocity[i], row);
        body->omega = vector_of(reader, &b->omega[i], row);
    }
    c->normal = vector_of(reader, &b->normal, row);
    c->friction = number_of(reader, &b->mu, row);
    c->restitution = number_of(reader, &b->eps, row);
    char message[200];
    if (impact_collide_check(c, message, sizeof message) != IMPACT_OK)
        quat_lua_reader_error(reader, "impact %lld: %s", (long long)row + 1, message);
}

/* ---- results: columns, filled block by block ---- */

enum { VECTORS = 5, NUMBERS = 4, COLUMNS = VECTORS + NUMBERS + 1 };

static const char *const column_keys[COLUMNS] = {
    "v1", "w1", "v2", "w2", "impulse", "energy_before", "energy_after", "normal_after", "error", "status"};

static void fill(lua_State *L, int first_column, const impact_outcome *o, impact_status status, lua_Integer row)
{
    const qvec3 vectors[VECTORS] = {o->velocity[0], o->omega[0], o->velocity[1], o->omega[1], o->impulse};
    const double numbers[NUMBERS] = {o->energy_before, o->energy_after, o->normal_after, o->error};
    for (int k = 0; k < VECTORS; k++) {
        const double x[3] = {vectors[k].x, vectors[k].y, vectors[k].z};
        for (int i = 0; i < 3; i++) {
            lua_pushnumber(L, x[i]);
            lua_rawseti(L, first_column + k, 3 * row + i + 1);
        }
    }
    for (int k = 0; k < NUMBERS; k++) {
        lua_pushnumber(L, numbers[k]);
        lua_rawseti(L, first_column + VECTORS + k, row + 1);
    }
    lua_pushstring(L, status == IMPACT_OK           ? "ok"
                      : status == IMPACT_SEPARATING ? "separating"
                      : status == IMPACT_SOFT       ? "soft"
                                                    : impact_lua_why_no_outcome(status));
    lua_rawseti(L, first_column + COLUMNS - 1, row + 1);
}

int impact_lua_collide_many(lua_State *L)
{
    enum { BLOCK = 16384 };
    const quat_lua_reader reader = quat_lua_read(L, 1, "collisions", NULL, keys);
    quat_lua_need(&reader, "count");
    quat_lua_need(&reader, "m1");
    quat_lua_need(&reader, "n");
    const lua_Integer count = quat_lua_get_integer(&reader, "count", 1, 100000000, 0);
    luaL_checkstack(L, 60, "collide_many");
    batch b;
    open_all(&reader, &b, count);
    /* Blocks of Lua's own: nothing leaks when reading raises. */
    impact_collision *c = lua_newuserdatauv(L, sizeof *c * BLOCK, 0);
    impact_outcome *o = lua_newuserdatauv(L, sizeof *o * BLOCK, 0);
    impact_status *statuses = lua_newuserdatauv(L, sizeof *statuses * BLOCK, 0);
    const int first_column = lua_gettop(L) + 1;
    for (int k = 0; k < COLUMNS; k++) lua_createtable(L, (int)(k < VECTORS ? 3 * count : count), 0);
    for (lua_Integer from = 0; from < count; from += BLOCK) {
        const lua_Integer n = count - from < BLOCK ? count - from : BLOCK;
        for (lua_Integer i = 0; i < n; i++) read_one(&reader, &b, from + i, &c[i]);
        impact_collide_many(c, (size_t)n, b.threads, o, statuses);
        for (lua_Integer i = 0; i < n; i++) fill(L, first_column, &o[i], statuses[i], from + i);
    }
    lua_createtable(L, 0, COLUMNS);
    for (int k = 0; k < COLUMNS; k++) {
        lua_pushvalue(L, first_column + k);
        lua_setfield(L, -2, column_keys[k]);
    }
    return 1;
}
