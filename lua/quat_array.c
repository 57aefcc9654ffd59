/* SPDX-License-Identifier: MIT
 *
 * Lists of rotations and vectors in Lua: the loops are in C. A list of vectors is {{x, y, z}, ...} or flat,
 * {x, y, z, x, y, z, ...}; the result has the form of the input.
 */
#include "quat_core.h"

#include <quat/average.h>
#include <quat/batch.h>
#include <quat/interpolate.h>

static quat unit(lua_State *L, int index, const char *name)
{
    quat q;
    if (quat_normalize(quat_lua_arg_quat(L, index, name), &q) != QUAT_OK)
        quat_lua_error(L, "argument '%s' must not be zero", name);
    return q;
}

/* A list of rotations, normalised. */
static quat *units(lua_State *L, int index, const char *name, size_t least, size_t *n)
{
    size_t bad;
    quat *const q = quat_lua_arg_quats(L, index, name, least, n);
    if (quat_normalize_array(*n, q, q, &bad) != QUAT_OK)
        quat_lua_error(L, "argument '%s[%d]' must not be zero", name, (int)bad + 1);
    return q;
}

static void same_length(lua_State *L, size_t n, size_t other, const char *name)
{
    if (n != other)
        quat_lua_error(L, "argument '%s' must have %d elements like the first, got %d", name, (int)n, (int)other);
}

static int rotate_list(lua_State *L, bool inverse)
{
    size_t n;
    const quat given = unit(L, 1, "q"), q = inverse ? quat_conj(given) : given;
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
        lua_createtable(L, (int)n, 0);
        for (size_t i = 0; i < n; i++) {
            lua_pushnumber(L, x[i]);
            lua_rawseti(L, -2, (lua_Integer)i + 1);
        }
        return 1;
    }
    qvec3 *const v = quat_lua_arg_vec3s(L, 2, "vectors", 0, &n);
    quat_rotate_array(q, n, v, v);
    lua_createtable(L, (int)n, 0);
    for (size_t i = 0; i < n; i++) {
        quat_lua_push_vec3(L, v[i]);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    return 1;
}

static int l_rotate_list(lua_State *L) { return rotate_list(L, false); }
static int l_rotate_inverse_list(lua_State *L) { return rotate_list(L, true); }

static int l_mul_list(lua_State *L)
{
    size_t n, other;
    lua_settop(L, 2); /* before buffers take the places of absent arguments */
    quat *const p = quat_lua_arg_quats(L, 1, "p", 0, &n);
    const quat *const q = quat_lua_arg_quats(L, 2, "q", 0, &other);
    same_length(L, n, other, "q");
    quat_mul_array(n, p, q, p);
    quat_lua_push_quats(L, n, p);
    return 1;
}

static int l_normalize_list(lua_State *L)
{
    size_t n;
    const quat *const q = units(L, 1, "q", 0, &n);
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
    const quat p = unit(L, 1, "p"), q = unit(L, 2, "q");
    const double *const t = quat_lua_arg_numbers(L, 3, "t", 0, &n);
    lua_createtable(L, (int)n, 0);
    for (size_t i = 0; i < n; i++) {
        quat_lua_push_quat(L, quat_slerp(p, q, t[i]));
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
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

static int l_mean(lua_State *L)
{
    size_t n;
    quat m;
    lua_settop(L, 2); /* before buffers take the places of absent arguments */
    const quat *const q = units(L, 1, "q", 1, &n);
    const quat_status status = quat_mean(n, q, quat_lua_arg_weights(L, 2, n), &m);
    return quat_lua_result(L, status, m);
}

/* mean, spread [, reason] */
static int l_mean_karcher(lua_State *L)
{
    size_t n;
    quat m;
    double spread;
    lua_settop(L, 2); /* before buffers take the places of absent arguments */
    const quat *const q = units(L, 1, "q", 1, &n);
    const quat_status status = quat_mean_karcher(n, q, quat_lua_arg_weights(L, 2, n), &m, &spread);
    if (status < 0) return quat_lua_failure(L, quat_status_string(status));
    quat_lua_push_quat(L, m);
    lua_pushnumber(L, spread);
    if (status == QUAT_OK) return 2;
    lua_pushstring(L, quat_status_string(status));
    return 3;
}

/* q, residual [, reason] */
static int l_align(lua_State *L)
{
    size_t n, other;
    quat q;
    double residual;
    lua_settop(L, 3); /* before buffers take the places of absent arguments */
    const qvec3 *const a = quat_lua_arg_vec3s(L, 1, "a", 1, &n), *const b = quat_lua_arg_vec3s(L, 2, "b", 1, &other);
    same_length(L, n, other, "b");
    const quat_status status = quat_align(n, a, b, quat_lua_arg_weights(L, 3, n), &q, &residual);
    if (status < 0) return quat_lua_failure(L, quat_status_string(status));
    quat_lua_push_quat(L, q);
    lua_pushnumber(L, residual);
    if (status == QUAT_OK) return 2;
    lua_pushstring(L, quat_status_string(status));
    return 3;
}

/* q, shift, residual [, reason] */
static int l_align_points(lua_State *L)
{
    size_t n, other;
    quat q;
    qvec3 shift;
    double residual;
    lua_settop(L, 3); /* before buffers take the places of absent arguments */
    const qvec3 *const a = quat_lua_arg_vec3s(L, 1, "a", 1, &n), *const b = quat_lua_arg_vec3s(L, 2, "b", 1, &other);
    same_length(L, n, other, "b");
    const quat_status status = quat_align_points(n, a, b, quat_lua_arg_weights(L, 3, n), &q, &shift, &residual);
    if (status < 0) return quat_lua_failure(L, quat_status_string(status));
    quat_lua_push_quat(L, q);
    quat_lua_push_vec3(L, shift);
    lua_pushnumber(L, residual);
    if (status == QUAT_OK) return 3;
    lua_pushstring(L, quat_status_string(status));
    return 4;
}

void quat_lua_open_array(lua_State *L)
{
    static const luaL_Reg methods[] = {{"rotate_list", l_rotate_list},
                                       {"rotate_inverse_list", l_rotate_inverse_list},
                                       {"slerp_list", l_slerp_list},
                                       {NULL, NULL}};
    static const luaL_Reg functions[] = {{"mul_list", l_mul_list},
                                         {"normalize_list", l_normalize_list},
                                         {"compose_list", l_compose_list},
                                         {"unflip", l_unflip},
                                         {"mean", l_mean},
                                         {"mean_karcher", l_mean_karcher},
                                         {"align", l_align},
                                         {"align_points", l_align_points},
                                         {NULL, NULL}};
    luaL_setfuncs(L, functions, 0);
    quat_lua_add_methods(L, methods);
}
