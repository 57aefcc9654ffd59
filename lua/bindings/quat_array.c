/* SPDX-License-Identifier: MIT
 *
 * Lists of rotations and vectors in Lua: the loops are in C. A list of vectors is {{x, y, z}, ...} or flat,
 * {x, y, z, x, y, z, ...}; a list for each component; or numbers in any regular layout. The result has the form of the
 * input.
 */
#include "quat_core.h"

#include <stdio.h>
#include <quat/batch.h>
#include <quat/interpolate.h>
#include <quat/rotation.h>

static int rotate_list(lua_State *L, bool inverse)
{
    size_t n;
    const quat given = quat_lua_arg_unit(L, 1, "q"), q = inverse ? quat_conj(given) : given;
    bool flat = false;
    if (lua_type(L, 2) == LUA_TTABLE) {
        lua_rawgeti(L, 2, 1);
        flat = lua_type(L, -1) == LUA_TNUMBER;
        lua_pop(L, 1);
    }
    if (flat) {
        double *const x = quat_lua_arg_numbers(L, 2, "vectors", 0, &n);
        if (n % 3 != 0)
            return quat_lua_error(L, "argument 'vectors' must hold three numbers for each vector, got %d numbers",
                                  (int)n);
        quat_rotate_array(q, n / 3, (const qvec3 *)(const void *)x, (qvec3 *)(void *)x);
        quat_lua_push_numbers(L, n, x);
        return 1;
    }
    qvec3 *const v = quat_lua_arg_vec3s(L, 2, "vectors", 0, &n);
    quat_rotate_array(q, n, v, v);
    quat_lua_push_vec3s(L, n, v);
    return 1;
}

static int l_rotate_list(lua_State *L) { return rotate_list(L, false); }
static int l_rotate_inverse_list(lua_State *L) { return rotate_list(L, true); }

/* rotate_soa(q, xs, ys, zs) -> xs, ys, zs */
static int l_rotate_soa(lua_State *L)
{
    static const char *const names[] = {"x", "y", "z"};
    double *x[3];
    size_t n[3];
    lua_settop(L, 4); /* before buffers take the places of absent arguments */
    const quat q = quat_lua_arg_unit(L, 1, "q");
    for (int i = 0; i < 3; i++) {
        x[i] = quat_lua_arg_numbers(L, i + 2, names[i], 0, &n[i]);
        quat_lua_same_length(L, n[0], n[i], names[i]);
    }
    quat_rotate_soa(q, n[0], x[0], x[1], x[2], x[0], x[1], x[2]);
    for (int i = 0; i < 3; i++) quat_lua_push_numbers(L, n[0], x[i]);
    return 3;
}

/* Raises an error unless every component of every point lies within the size numbers of data. */
static void check_layout(const quat_lua_reader *layout, lua_Integer size, lua_Integer count, lua_Integer first,
                         lua_Integer point, lua_Integer component)
{
    const lua_Integer steps = count > 0 ? count - 1 : 0;
    const lua_Integer low = (point < 0 ? steps * point : 0) + (component < 0 ? 2 * component : 0),
                      high = (point > 0 ? steps * point : 0) + (component > 0 ? 2 * component : 0);
    if (count > 0 && (first + low < 1 || first + high > size))
        quat_lua_reader_error(layout, "reaches from data[%lld] to data[%lld], but data has %lld numbers",
                              (long long)(first + low), (long long)(first + high), (long long)size);
}

/* rotate_strided(q, data, {count = n [, first = 1, point = 3, component = 1]}): component c of point i is at
 * data[first + i point + c component]; all other numbers are handed back as they are. */
static int l_rotate_strided(lua_State *L)
{
    static const char *const keys[] = {"count", "first", "point", "component", NULL};
    enum { most = 1 << 30 };
    size_t n, copied;
    lua_settop(L, 3); /* before buffers take the places of absent arguments */
    const quat q = quat_lua_arg_unit(L, 1, "q");
    double *const in = quat_lua_arg_numbers(L, 2, "data", 0, &n), *const out =
                                                                      quat_lua_arg_numbers(L, 2, "data", 0, &copied);
    const quat_lua_reader layout = quat_lua_read(L, 3, "layout", NULL, keys);
    quat_lua_need(&layout, "count");
    const lua_Integer count = quat_lua_get_integer(&layout, "count", 0, most, 0),
                      first = quat_lua_get_integer(&layout, "first", 1, most, 1),
                      point = quat_lua_get_integer(&layout, "point", -most, most, 3),
                      component = quat_lua_get_integer(&layout, "component", -most, most, 1);
    check_layout(&layout, (lua_Integer)n, count, first, point, component);
    const quat_strided from = {in + (first - 1), (ptrdiff_t)point, (ptrdiff_t)component},
                       to = {out + (first - 1), from.point, from.component};
    if (count > 0) quat_rotate_strided(q, (size_t)count, from, to);
    quat_lua_push_numbers(L, n, out);
    return 1;
}

/* rotate_each(qs, vectors): the i-th vector by the i-th rotation. */
static int l_rotate_each(lua_State *L)
{
    size_t n, other;
    lua_settop(L, 2); /* before buffers take the places of absent arguments */
    const quat *const q = quat_lua_arg_units(L, 1, "q", 0, &n);
    qvec3 *const v = quat_lua_arg_vec3s(L, 2, "vectors", 0, &other);
    quat_lua_same_length(L, n, other, "vectors");
    quat_rotate_each(n, q, v, v);
    quat_lua_push_vec3s(L, n, v);
    return 1;
}

static int l_to_matrix_list(lua_State *L)
{
    size_t n;
    lua_settop(L, 1);
    const quat *const q = quat_lua_arg_units(L, 1, "q", 0, &n);
    qmat3 *const m = lua_newuserdatauv(L, (n ? n : 1) * sizeof *m, 0);
    quat_to_matrix_array(n, q, m);
    lua_createtable(L, (int)n, 0);
    for (size_t i = 0; i < n; i++) {
        quat_lua_push_matrix(L, 3, 3, m[i].m[0]);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    return 1;
}

static int l_from_matrix_list(lua_State *L)
{
    size_t bad;
    if (lua_type(L, 1) != LUA_TTABLE)
        return quat_lua_error(L, "argument 'matrices' must be a list, got a %s", luaL_typename(L, 1));
    const size_t n = lua_rawlen(L, 1);
    qmat3 *const m = lua_newuserdatauv(L, (n ? n : 1) * sizeof *m, 0);
    quat *const q = lua_newuserdatauv(L, (n ? n : 1) * sizeof *q, 0);
    for (size_t i = 0; i < n; i++) {
        char name[64];
        snprintf(name, sizeof name, "matrices[%zu]", i + 1);
        lua_rawgeti(L, 1, (lua_Integer)i + 1);
        m[i] = quat_lua_arg_matrix(L, lua_gettop(L), name);
        lua_pop(L, 1);
    }
    const quat_status status = quat_from_matrix_array(n, m, q, &bad);
    if (status < 0) return quat_lua_element_failure(L, "matrices", bad, status);
    quat_lua_push_quats(L, n, q);
    return 1;
}

static int l_mul_list(lua_State *L)
{
    size_t n, other;
    lua_settop(L, 2); /* before buffers take the places of absent arguments */
    quat *const p = quat_lua_arg_quats(L, 1, "p", 0, &n);
    const quat *const q = quat_lua_arg_quats(L, 2, "q", 0, &other);
    quat_lua_same_length(L, n, other, "q");
    quat_mul_array(n, p, q, p);
    quat_lua_push_quats(L, n, p);
    return 1;
}

static int l_normalize_list(lua_State *L)
{
    size_t n;
    const quat *const q = quat_lua_arg_units(L, 1, "q", 0, &n);
    quat_lua_push_quats(L, n, q);
    return 1;
}

static int l_compose_list(lua_State *L)
{
    size_t n;
    const quat *const q = quat_lua_arg_quats(L, 1, "q", 0, &n);
    quat_lua_push_quat(L, quat_compose_array(n, q));
    return 1;
}

/* slerp_list(p, q, ts): the points at each t between two rotations. */
static int l_slerp_list(lua_State *L)
{
    size_t n;
    const quat p = quat_lua_arg_unit(L, 1, "p"), q = quat_lua_arg_unit(L, 2, "q");
    const double *const t = quat_lua_arg_numbers(L, 3, "t", 0, &n);
    lua_createtable(L, (int)n, 0);
    for (size_t i = 0; i < n; i++) {
        quat_lua_push_quat(L, quat_slerp(p, q, t[i]));
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    return 1;
}

/* slerp_each(ps, qs, ts): between the i-th rotations at the i-th t, the short way. */
static int l_slerp_each(lua_State *L)
{
    size_t n, others, times;
    lua_settop(L, 3); /* before buffers take the places of absent arguments */
    quat *const p = quat_lua_arg_units(L, 1, "p", 0, &n);
    const quat *const q = quat_lua_arg_units(L, 2, "q", 0, &others);
    const double *const t = quat_lua_arg_numbers(L, 3, "t", 0, &times);
    quat_lua_same_length(L, n, others, "q");
    quat_lua_same_length(L, n, times, "t");
    for (size_t i = 0; i < n; i++)
        if (!(t[i] >= 0 && t[i] <= 1))
            return quat_lua_error(L, "argument 't[%d]' must be a number from 0 to 1, got %g", (int)i + 1, t[i]);
    quat_slerp_array(n, p, q, t, p);
    quat_lua_push_quats(L, n, p);
    return 1;
}

/* unflip(list) -> list, changed, monodromy */
static int l_unflip(lua_State *L)
{
    size_t n;
    int monodromy;
    quat *const q = quat_lua_arg_quats(L, 1, "q", 0, &n);
    const size_t changed = quat_unflip(n, q, &monodromy);
    quat_lua_push_quats(L, n, q);
    lua_pushinteger(L, (lua_Integer)changed);
    lua_pushinteger(L, monodromy);
    return 3;
}

void quat_lua_open_array(lua_State *L)
{
    static const luaL_Reg methods[] = {{"rotate_list", l_rotate_list}, {"rotate_inverse_list", l_rotate_inverse_list},
                                       {"rotate_soa", l_rotate_soa},   {"rotate_strided", l_rotate_strided},
                                       {"slerp_list", l_slerp_list},   {NULL, NULL}};
    static const luaL_Reg functions[] = {{"rotate_each", l_rotate_each},
                                         {"to_matrix_list", l_to_matrix_list},
                                         {"from_matrix_list", l_from_matrix_list},
                                         {"mul_list", l_mul_list},
                                         {"normalize_list", l_normalize_list},
                                         {"compose_list", l_compose_list},
                                         {"slerp_each", l_slerp_each},
                                         {"unflip", l_unflip},
                                         {NULL, NULL}};
    luaL_setfuncs(L, functions, 0);
    quat_lua_add_methods(L, methods);
}
