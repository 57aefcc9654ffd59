/* SPDX-License-Identifier: MIT
 *
 * Projections of S^3, S^2 and S^1, and Hopf's map, in Lua.
 */
#include "quat_core.h"

#include <stdio.h>
#include <quat/project.h>

/* "south" or "north"; nil gives the thesis' own choice. */
static quat_pole pole_at(lua_State *L, int index, quat_pole usual)
{
    static const char *const poles[] = {"south", "north", NULL};
    if (lua_isnoneornil(L, index)) return usual;
    return quat_lua_arg_choice(L, index, "pole", poles) == 0 ? QUAT_SOUTH_POLE : QUAT_NORTH_POLE;
}

static int half_at(lua_State *L, int index) { return (int)quat_lua_arg_integer(L, index, "half", -1, 1); }

/* ---- stereographic ---- */

static int l_stereographic(lua_State *L)
{
    qvec3 image;
    const quat q = quat_lua_arg_quat(L, 1, "q");
    const quat_status status = quat_stereographic(q, pole_at(L, 2, QUAT_SOUTH_POLE), &image);
    quat_lua_push_vec3(L, image);
    return quat_lua_results(L, status, 1);
}

static int l_from_stereographic(lua_State *L)
{
    double x[3] = {0, 0, 0};
    quat_lua_arg_image(L, 1, "image", 3, x);
    const quat_pole pole = pole_at(L, 2, QUAT_SOUTH_POLE);
    quat_lua_push_quat(L, quat_from_stereographic(qvec3_make(x[0], x[1], x[2]), pole));
    return 1;
}

static int l_stereographic_sphere(lua_State *L)
{
    qvec2 image;
    const qvec3 p = quat_lua_arg_vec3(L, 1, "p");
    const quat_status status = quat_stereographic_sphere(p, pole_at(L, 2, QUAT_NORTH_POLE), &image);
    quat_lua_push_vec2(L, image);
    return quat_lua_results(L, status, 1);
}

static int l_from_stereographic_sphere(lua_State *L)
{
    double x[2] = {0, 0};
    quat_lua_arg_image(L, 1, "image", 2, x);
    const quat_pole pole = pole_at(L, 2, QUAT_NORTH_POLE);
    return quat_lua_give_vec3(L, quat_from_stereographic_sphere(qvec2_make(x[0], x[1]), pole));
}

static int l_stereographic_circle(lua_State *L)
{
    double image;
    const qvec2 p = quat_lua_arg_vec2(L, 1, "p");
    const quat_status status = quat_stereographic_circle(p, pole_at(L, 2, QUAT_NORTH_POLE), &image);
    lua_pushnumber(L, image);
    return quat_lua_results(L, status, 1);
}

static int l_from_stereographic_circle(lua_State *L)
{
    const double image = lua_tonumber(L, 1);
    if (lua_type(L, 1) != LUA_TNUMBER || isnan(image)) return quat_lua_error(L, "argument 'image' must be a number");
    quat_lua_push_vec2(L, quat_from_stereographic_circle(image, pole_at(L, 2, QUAT_NORTH_POLE)));
    return 1;
}

/* ---- orthographic: image, half ---- */

static int l_orthographic(lua_State *L)
{
    qvec3 image;
    int half;
    const quat_status status = quat_orthographic(quat_lua_arg_quat(L, 1, "q"), &image, &half);
    quat_lua_push_vec3(L, image);
    lua_pushinteger(L, half);
    return quat_lua_results(L, status, 2);
}

static int l_from_orthographic(lua_State *L)
{
    quat q;
    const qvec3 image = quat_lua_arg_vec3(L, 1, "image");
    const quat_status status = quat_from_orthographic(image, half_at(L, 2), &q);
    return quat_lua_result(L, status, q);
}

static int l_orthographic_sphere(lua_State *L)
{
    qvec2 image;
    int half;
    const quat_status status = quat_orthographic_sphere(quat_lua_arg_vec3(L, 1, "p"), &image, &half);
    quat_lua_push_vec2(L, image);
    lua_pushinteger(L, half);
    return quat_lua_results(L, status, 2);
}

static int l_from_orthographic_sphere(lua_State *L)
{
    qvec3 p;
    const qvec2 image = quat_lua_arg_vec2(L, 1, "image");
    const quat_status status = quat_from_orthographic_sphere(image, half_at(L, 2), &p);
    quat_lua_push_vec3(L, p);
    return quat_lua_results(L, status, 1);
}

static int l_orthographic_circle(lua_State *L)
{
    double image;
    int half;
    const quat_status status = quat_orthographic_circle(quat_lua_arg_vec2(L, 1, "p"), &image, &half);
    lua_pushnumber(L, image);
    lua_pushinteger(L, half);
    return quat_lua_results(L, status, 2);
}

static int l_from_orthographic_circle(lua_State *L)
{
    qvec2 p;
    const double image = quat_lua_arg_number(L, 1, "image", QUAT_LUA_FINITE);
    const quat_status status = quat_from_orthographic_circle(image, half_at(L, 2), &p);
    quat_lua_push_vec2(L, p);
    return quat_lua_results(L, status, 1);
}

/* ---- lists ---- */

static int l_stereographic_list(lua_State *L)
{
    size_t n, first;
    lua_settop(L, 2); /* before buffers take the places of absent arguments */
    const quat_pole pole = pole_at(L, 2, QUAT_SOUTH_POLE);
    const quat *const q = quat_lua_arg_quats(L, 1, "q", 0, &n);
    qvec3 *const image = lua_newuserdatauv(L, (n + 1) * sizeof *image, 0);
    const quat_status status = quat_stereographic_array(n, q, pole, image, &first);
    if (status < 0) return quat_lua_element_failure(L, "q", first, status);
    quat_lua_push_vec3s(L, n, image);
    return quat_lua_results(L, status, 1);
}

static int l_from_stereographic_list(lua_State *L)
{
    char name[64];
    if (lua_type(L, 1) != LUA_TTABLE)
        return quat_lua_error(L, "argument 'images' must be a list, got a %s", luaL_typename(L, 1));
    const quat_pole pole = pole_at(L, 2, QUAT_SOUTH_POLE);
    const size_t n = lua_rawlen(L, 1);
    lua_createtable(L, (int)n, 0);
    for (size_t i = 0; i < n; i++) {
        double x[3] = {0, 0, 0};
        snprintf(name, sizeof name, "images[%zu]", i + 1);
        lua_rawgeti(L, 1, (lua_Integer)i + 1);
        quat_lua_arg_image(L, lua_gettop(L), name, 3, x);
        lua_pop(L, 1);
        quat_lua_push_quat(L, quat_from_stereographic(qvec3_make(x[0], x[1], x[2]), pole));
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    return 1;
}

/* images, halves */
static int l_orthographic_list(lua_State *L)
{
    size_t n, first;
    lua_settop(L, 1);
    const quat *const q = quat_lua_arg_quats(L, 1, "q", 0, &n);
    qvec3 *const image = lua_newuserdatauv(L, (n + 1) * sizeof *image, 0);
    int *const half = lua_newuserdatauv(L, (n + 1) * sizeof *half, 0);
    const quat_status status = quat_orthographic_array(n, q, image, half, &first);
    if (status < 0) return quat_lua_element_failure(L, "q", first, status);
    quat_lua_push_vec3s(L, n, image);
    lua_createtable(L, (int)n, 0);
    for (size_t i = 0; i < n; i++) {
        lua_pushinteger(L, half[i]);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    return 2;
}

static int l_from_orthographic_list(lua_State *L)
{
    size_t n, halves, first;
    lua_settop(L, 2);
    const qvec3 *const image = quat_lua_arg_vec3s(L, 1, "images", 0, &n);
    const double *const given = quat_lua_arg_numbers(L, 2, "halves", 0, &halves);
    quat_lua_same_length(L, n, halves, "halves");
    int *const half = lua_newuserdatauv(L, (n + 1) * sizeof *half, 0);
    quat *const q = lua_newuserdatauv(L, (n + 1) * sizeof *q, 0);
    for (size_t i = 0; i < n; i++) {
        if (given[i] != -1 && given[i] != 0 && given[i] != 1)
            return quat_lua_error(L, "argument 'halves[%d]' must be -1, 0 or 1, got %g", (int)i + 1, given[i]);
        half[i] = (int)given[i];
    }
    const quat_status status = quat_from_orthographic_array(n, image, half, q, &first);
    if (status < 0) return quat_lua_element_failure(L, "images", first, status);
    quat_lua_push_quats(L, n, q);
    return 1;
}

/* ---- Hopf ---- */

static int l_hopf(lua_State *L) { return quat_lua_give_vec3(L, quat_hopf(quat_lua_arg_unit(L, 1, "q"))); }

static int l_hopf_angle(lua_State *L)
{
    lua_pushnumber(L, quat_hopf_angle(quat_lua_arg_unit(L, 1, "q")));
    return 1;
}

static int l_hopf_fibre(lua_State *L)
{
    quat q;
    const qvec3 p = quat_lua_arg_vec3(L, 1, "p");
    const quat_status status = quat_hopf_fibre(p, quat_lua_arg_number(L, 2, "t", QUAT_LUA_FINITE), &q);
    return quat_lua_result(L, status, q);
}

void quat_lua_open_project(lua_State *L)
{
    static const luaL_Reg methods[] = {{"stereographic", l_stereographic},
                                       {"orthographic", l_orthographic},
                                       {"hopf", l_hopf},
                                       {"hopf_angle", l_hopf_angle},
                                       {NULL, NULL}};
    static const luaL_Reg functions[] = {{"from_stereographic", l_from_stereographic},
                                         {"stereographic_sphere", l_stereographic_sphere},
                                         {"from_stereographic_sphere", l_from_stereographic_sphere},
                                         {"stereographic_circle", l_stereographic_circle},
                                         {"from_stereographic_circle", l_from_stereographic_circle},
                                         {"from_orthographic", l_from_orthographic},
                                         {"orthographic_sphere", l_orthographic_sphere},
                                         {"from_orthographic_sphere", l_from_orthographic_sphere},
                                         {"orthographic_circle", l_orthographic_circle},
                                         {"from_orthographic_circle", l_from_orthographic_circle},
                                         {"stereographic_list", l_stereographic_list},
                                         {"from_stereographic_list", l_from_stereographic_list},
                                         {"orthographic_list", l_orthographic_list},
                                         {"from_orthographic_list", l_from_orthographic_list},
                                         {"hopf_fibre", l_hopf_fibre},
                                         {NULL, NULL}};
    luaL_setfuncs(L, functions, 0);
    quat_lua_add_methods(L, methods);
}
