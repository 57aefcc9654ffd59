/* SPDX-License-Identifier: MIT
 *
 * Results and lists, for every room of quat.core and quat.gsl.
 */
#include "quat_core.h"

#include <stdio.h>
#include <quat/batch.h>

/* ---- results ---- */

int quat_lua_results(lua_State *L, quat_status status, int count)
{
    if (status < 0) return quat_lua_failure(L, quat_status_string(status));
    if (status == QUAT_OK) return count;
    lua_pushstring(L, quat_status_string(status));
    return count + 1;
}

int quat_lua_result(lua_State *L, quat_status status, quat q)
{
    quat_lua_push_quat(L, q);
    return quat_lua_results(L, status, 1);
}

int quat_lua_element_failure(lua_State *L, const char *name, size_t i, quat_status status)
{
    lua_pushnil(L);
    lua_pushfstring(L, "%s[%d]: %s", name, (int)i + 1, quat_status_string(status));
    return 2;
}

int quat_lua_give_vec3(lua_State *L, qvec3 v)
{
    quat_lua_push_vec3(L, v);
    return 1;
}

void quat_lua_push_vec2(lua_State *L, qvec2 v)
{
    const double x[2] = {v.x, v.y};
    quat_lua_push_numbers(L, 2, x);
}

void quat_lua_push_matrix(lua_State *L, int rows, int columns, const double m[])
{
    lua_createtable(L, rows, 0);
    for (int i = 0; i < rows; i++) {
        quat_lua_push_numbers(L, (size_t)columns, m + (ptrdiff_t)i * columns);
        lua_rawseti(L, -2, i + 1);
    }
}

void quat_lua_push_numbers(lua_State *L, size_t n, const double x[])
{
    lua_createtable(L, (int)n, 0);
    for (size_t i = 0; i < n; i++) {
        lua_pushnumber(L, x[i]);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
}

void quat_lua_push_vec3s(lua_State *L, size_t n, const qvec3 v[])
{
    lua_createtable(L, (int)n, 0);
    for (size_t i = 0; i < n; i++) {
        quat_lua_push_vec3(L, v[i]);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
}

void quat_lua_push_quats(lua_State *L, size_t n, const quat q[])
{
    lua_createtable(L, (int)n, 0);
    for (size_t i = 0; i < n; i++) {
        quat_lua_push_quat(L, q[i]);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
}

/* ---- arguments ---- */

quat quat_lua_arg_unit(lua_State *L, int arg, const char *name)
{
    quat unit;
    if (quat_normalize(quat_lua_arg_quat(L, arg, name), &unit) != QUAT_OK)
        quat_lua_error(L, "argument '%s' must not be zero", name);
    return unit;
}

void quat_lua_arg_image(lua_State *L, int arg, const char *name, int n, double x[])
{
    static const char *const letters[] = {"x", "y", "z"};
    bool good = lua_type(L, arg) == LUA_TTABLE;
    for (int i = 0; i < n && good; i++) {
        if (lua_rawgeti(L, arg, i + 1) == LUA_TNIL) {
            lua_pop(L, 1);
            lua_pushstring(L, letters[i]);
            lua_rawget(L, arg);
        }
        x[i] = lua_tonumber(L, -1);
        good = lua_type(L, -1) == LUA_TNUMBER && !isnan(x[i]);
        lua_pop(L, 1);
    }
    if (!good) quat_lua_error(L, "argument '%s' must be a point {%s} of numbers", name, n == 2 ? "x, y" : "x, y, z");
}

qvec2 quat_lua_arg_vec2(lua_State *L, int arg, const char *name)
{
    double x[2] = {0, 0};
    quat_lua_arg_image(L, arg, name, 2, x);
    if (!isfinite(x[0]) || !isfinite(x[1])) quat_lua_error(L, "argument '%s' must be finite", name);
    return qvec2_make(x[0], x[1]);
}

qmat3 quat_lua_arg_matrix(lua_State *L, int arg, const char *name)
{
    size_t n;
    const qvec3 *const rows = quat_lua_arg_vec3s(L, arg, name, 3, &n);
    if (n != 3) quat_lua_error(L, "argument '%s' must have 3 rows, got %d", name, (int)n);
    const qmat3 m = {
        {{rows[0].x, rows[0].y, rows[0].z}, {rows[1].x, rows[1].y, rows[1].z}, {rows[2].x, rows[2].y, rows[2].z}}};
    lua_pop(L, 1); /* the buffer */
    return m;
}

/* ---- lists ---- */

/* The length of the list at arg. */
static size_t list_length(lua_State *L, int arg, const char *name, size_t least)
{
    if (lua_type(L, arg) != LUA_TTABLE)
        quat_lua_error(L, "argument '%s' must be a list, got a %s", name, luaL_typename(L, arg));
    const size_t n = lua_rawlen(L, arg);
    if (n < least)
        quat_lua_error(L, "argument '%s' must be a list of at least %d elements, got %d", name, (int)least, (int)n);
    return n;
}

static void *buffer(lua_State *L, size_t n, size_t size) { return lua_newuserdatauv(L, (n ? n : 1) * size, 0); }

/* Pushes element i and gives it a name for errors. */
static int push_element(lua_State *L, int arg, const char *name, size_t i, char *text, size_t size)
{
    lua_rawgeti(L, arg, (lua_Integer)i + 1);
    snprintf(text, size, "%s[%zu]", name, i + 1);
    return lua_gettop(L);
}

quat *quat_lua_arg_quats(lua_State *L, int arg, const char *name, size_t least, size_t *n)
{
    char text[64];
    *n = list_length(L, arg, name, least);
    quat *const q = buffer(L, *n, sizeof *q);
    for (size_t i = 0; i < *n; i++) {
        q[i] = quat_lua_arg_quat(L, push_element(L, arg, name, i, text, sizeof text), text);
        lua_pop(L, 1);
    }
    return q;
}

qvec2 *quat_lua_arg_vec2s(lua_State *L, int arg, const char *name, size_t least, size_t *n)
{
    char text[64];
    *n = list_length(L, arg, name, least);
    qvec2 *const v = buffer(L, *n, sizeof *v);
    for (size_t i = 0; i < *n; i++) {
        v[i] = quat_lua_arg_vec2(L, push_element(L, arg, name, i, text, sizeof text), text);
        lua_pop(L, 1);
    }
    return v;
}

qvec3 *quat_lua_arg_vec3s(lua_State *L, int arg, const char *name, size_t least, size_t *n)
{
    char text[64];
    *n = list_length(L, arg, name, least);
    qvec3 *const v = buffer(L, *n, sizeof *v);
    for (size_t i = 0; i < *n; i++) {
        v[i] = quat_lua_arg_vec3(L, push_element(L, arg, name, i, text, sizeof text), text);
        lua_pop(L, 1);
    }
    return v;
}

quat *quat_lua_arg_units(lua_State *L, int arg, const char *name, size_t least, size_t *n)
{
    size_t bad;
    quat *const q = quat_lua_arg_quats(L, arg, name, least, n);
    if (quat_normalize_array(*n, q, q, &bad) != QUAT_OK)
        quat_lua_error(L, "argument '%s[%d]' must not be zero", name, (int)bad + 1);
    return q;
}

double *quat_lua_arg_numbers(lua_State *L, int arg, const char *name, size_t least, size_t *n)
{
    *n = list_length(L, arg, name, least);
    double *const x = buffer(L, *n, sizeof *x);
    for (size_t i = 0; i < *n; i++) {
        int is_number;
        lua_rawgeti(L, arg, (lua_Integer)i + 1);
        x[i] = lua_tonumberx(L, -1, &is_number);
        if (!is_number || !isfinite(x[i]))
            quat_lua_error(L, "argument '%s[%d]' must be a finite number", name, (int)i + 1);
        lua_pop(L, 1);
    }
    return x;
}

double *quat_lua_arg_weights(lua_State *L, int arg, size_t n)
{
    if (lua_isnoneornil(L, arg)) return NULL;
    size_t count;
    double *const w = quat_lua_arg_numbers(L, arg, "weights", 0, &count);
    if (count != n)
        quat_lua_error(L, "argument 'weights' must have %d elements, one for each, got %d", (int)n, (int)count);
    for (size_t i = 0; i < n; i++)
        if (w[i] < 0) quat_lua_error(L, "argument 'weights[%d]' must not be negative, got %g", (int)i + 1, w[i]);
    return w;
}

void quat_lua_same_length(lua_State *L, size_t n, size_t other, const char *name)
{
    if (n != other)
        quat_lua_error(L, "argument '%s' must have %d elements like the first, got %d", name, (int)n, (int)other);
}
