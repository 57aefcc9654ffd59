/* SPDX-License-Identifier: MIT */
#include "impact_core.h"

#include <stdio.h>
#include <string.h>

void impact_lua_push_shape(lua_State *L, const impact_shape *shape)
{
    impact_shape *place = lua_newuserdatauv(L, sizeof *shape, 1);
    *place = *shape;
    luaL_setmetatable(L, IMPACT_LUA_SHAPE);
    if (!shape->hull) return;
    impact_lua_push_hull(L, shape->hull);
    lua_setiuservalue(L, -2, 1);
}

static int push_checked(lua_State *L, impact_status status, const impact_shape *shape)
{
    if (status < 0) return quat_lua_error(L, "shape: %s", impact_status_string(status));
    impact_lua_push_shape(L, shape);
    return 1;
}

/* sphere(radius) or sphere{radius=} */
static int shape_sphere(lua_State *L)
{
    static const char *const keys[] = {"radius", NULL};
    impact_shape shape;
    double radius;
    if (lua_istable(L, 1)) {
        const quat_lua_reader reader = quat_lua_read(L, 1, "sphere", NULL, keys);
        quat_lua_need(&reader, "radius");
        radius = quat_lua_get_number(&reader, "radius", QUAT_LUA_POSITIVE, 0);
    } else {
        radius = quat_lua_arg_number(L, 1, "radius", QUAT_LUA_POSITIVE);
    }
    return push_checked(L, impact_shape_sphere(radius, &shape), &shape);
}

/* plane() without edges, or plane{width=, depth=}: the whole lengths of its edges along its own x and y */
static int shape_plane(lua_State *L)
{
    static const char *const keys[] = {"width", "depth", NULL};
    impact_shape shape;
    double width = INFINITY, depth = INFINITY;
    if (!lua_isnoneornil(L, 1)) {
        const quat_lua_reader reader = quat_lua_read(L, 1, "plane", NULL, keys);
        width = quat_lua_get_number(&reader, "width", QUAT_LUA_POSITIVE_OR_INF, width);
        depth = quat_lua_get_number(&reader, "depth", QUAT_LUA_POSITIVE_OR_INF, depth);
    }
    return push_checked(L, impact_shape_plane(width / 2, depth / 2, &shape), &shape);
}

/* The semi-axes and, by their names, what else makes the shape. */
static double semi_axis(const quat_lua_reader *reader, const char *key)
{
    quat_lua_need(reader, key);
    return quat_lua_get_number(reader, key, QUAT_LUA_POSITIVE, 0);
}

/* Pushes the shape, or raises what impact_shape_check says of it. */
static int push_good(const quat_lua_reader *reader, impact_shape shape)
{
    char message[120];
    if (impact_shape_check(&shape, message, sizeof message) < 0) return quat_lua_reader_error(reader, "%s", message);
    impact_lua_push_shape(reader->L, &shape);
    return 1;
}

/* ellipsoid{a=, b=, c=} */
static int shape_ellipsoid(lua_State *L)
{
    static const char *const keys[] = {"a", "b", "c", NULL};
    const quat_lua_reader reader = quat_lua_read(L, 1, "ellipsoid", NULL, keys);
    const double a = semi_axis(&reader, "a"), b = semi_axis(&reader, "b"), c = semi_axis(&reader, "c");
    return push_good(&reader,
                     (impact_shape){.kind = IMPACT_SUPERQUADRIC, .a = a, .b = b, .c = c, .r = 2, .s = 2, .t = 2});
}

/* superquadric{a=, b=, c=, r=, s=, t=}: exponents of 2 where they are left out */
static int shape_superquadric(lua_State *L)
{
    static const char *const keys[] = {"a", "b", "c", "r", "s", "t", NULL};
    const quat_lua_reader reader = quat_lua_read(L, 1, "superquadric", NULL, keys);
    const double a = semi_axis(&reader, "a"), b = semi_axis(&reader, "b"), c = semi_axis(&reader, "c");
    const double r = quat_lua_get_number(&reader, "r", QUAT_LUA_FINITE, 2),
                 s = quat_lua_get_number(&reader, "s", QUAT_LUA_FINITE, 2),
                 t = quat_lua_get_number(&reader, "t", QUAT_LUA_FINITE, 2);
    return push_good(&reader,
                     (impact_shape){.kind = IMPACT_SUPERQUADRIC, .a = a, .b = b, .c = c, .r = r, .s = s, .t = t});
}

/* superellipsoid{a=, b=, c=, eps1=, eps2=}: 1 where they are left out */
static int shape_superellipsoid(lua_State *L)
{
    static const char *const keys[] = {"a", "b", "c", "eps1", "eps2", NULL};
    const quat_lua_reader reader = quat_lua_read(L, 1, "superellipsoid", NULL, keys);
    const double a = semi_axis(&reader, "a"), b = semi_axis(&reader, "b"), c = semi_axis(&reader, "c");
    const double eps1 = quat_lua_get_number(&reader, "eps1", QUAT_LUA_POSITIVE, 1),
                 eps2 = quat_lua_get_number(&reader, "eps2", QUAT_LUA_POSITIVE, 1);
    if (eps1 > 2) return quat_lua_reader_error(&reader, "eps1 = %.17g > 2 is not convex", eps1);
    if (eps2 > 2) return quat_lua_reader_error(&reader, "eps2 = %.17g > 2 is not convex", eps2);
    return push_good(
        &reader,
        (impact_shape){
            .kind = IMPACT_SUPERELLIPSOID, .a = a, .b = b, .c = c, .r = 2 / eps2, .s = 2 / eps2, .t = 2 / eps1});
}

/* ---- what a shape can be asked ---- */

static const impact_shape *self(lua_State *L) { return luaL_checkudata(L, 1, IMPACT_LUA_SHAPE); }

static qvec3 arg_direction(lua_State *L)
{
    const qvec3 d = quat_lua_arg_vec3(L, 2, "direction");
    if (!(qvec3_norm(d) > 0)) quat_lua_error(L, "argument 'direction' must not be zero");
    return d;
}

/* shape:support(direction): h, point */
static int shape_support(lua_State *L)
{
    const impact_shape *shape = self(L);
    qvec3 point;
    lua_pushnumber(L, impact_shape_support(shape, arg_direction(L), &point));
    quat_lua_push_vec3(L, point);
    return 2;
}

/* shape:point(u, v), shape:normal(u, v) */
static int shape_point(lua_State *L)
{
    const double u = quat_lua_arg_number(L, 2, "u", QUAT_LUA_FINITE),
                 v = quat_lua_arg_number(L, 3, "v", QUAT_LUA_FINITE);
    quat_lua_push_vec3(L, impact_shape_point(self(L), u, v));
    return 1;
}

static int shape_normal(lua_State *L)
{
    const double u = quat_lua_arg_number(L, 2, "u", QUAT_LUA_FINITE),
                 v = quat_lua_arg_number(L, 3, "v", QUAT_LUA_FINITE);
    quat_lua_push_vec3(L, impact_shape_normal(self(L), u, v));
    return 1;
}

/* shape:inside(x): below 1 inside, 1 on the surface */
static int shape_inside(lua_State *L)
{
    lua_pushnumber(L, impact_shape_inside(self(L), quat_lua_arg_vec3(L, 2, "x")));
    return 1;
}

/* shape:hessian(direction): the support function's at the unit of direction, three rows of three */
static int shape_hessian(lua_State *L)
{
    const qvec3 d = arg_direction(L);
    const qmat3 H = impact_shape_support_hessian(self(L), qvec3_scale(d, 1 / qvec3_norm(d)));
    lua_createtable(L, 3, 0);
    for (int i = 0; i < 3; i++) {
        lua_createtable(L, 3, 0);
        for (int j = 0; j < 3; j++) {
            lua_pushnumber(L, H.m[i][j]);
            lua_rawseti(L, -2, j + 1);
        }
        lua_rawseti(L, -2, i + 1);
    }
    return 1;
}

/* shape:curvatures(direction): k1, k2 where the outward normal is along direction */
static int shape_curvatures(lua_State *L)
{
    double k1, k2;
    impact_shape_curvatures(self(L), arg_direction(L), &k1, &k2);
    lua_pushnumber(L, k1);
    lua_pushnumber(L, k2);
    return 2;
}

static void push_grid(lua_State *L, const qvec3 *v, lua_Integer count)
{
    lua_createtable(L, (int)count, 0);
    for (lua_Integer i = 0; i < count; i++) {
        quat_lua_push_vec3(L, v[i]);
        lua_rawseti(L, -2, i + 1);
    }
}

/* shape:mesh(nu, nv): points, normals; row j = 0 .. nv (v from -pi/2 to pi/2) of i = 0 .. nu - 1 (u from -pi), one
 * after the other */
static int shape_mesh(lua_State *L)
{
    const impact_shape *shape = self(L);
    const lua_Integer nu = quat_lua_arg_integer(L, 2, "nu", 3, 4096), nv = quat_lua_arg_integer(L, 3, "nv", 2, 4096);
    const lua_Integer count = nu * (nv + 1);
    qvec3 *points = lua_newuserdatauv(L, 2 * (size_t)count * sizeof *points, 0), *normals = points + count;
    impact_shape_mesh(shape, (int)nu, (int)nv, points, normals);
    push_grid(L, points, count);
    push_grid(L, normals, count);
    return 2;
}

static const char *const kind_words[] = {
    [IMPACT_SPHERE] = "sphere",
    [IMPACT_PLANE] = "plane",
    [IMPACT_SUPERQUADRIC] = "superquadric",
    [IMPACT_SUPERELLIPSOID] = "superellipsoid",
    [IMPACT_BOX] = "box",
    [IMPACT_CYLINDER] = "cylinder",
    [IMPACT_CONE] = "cone",
    [IMPACT_CAPSULE] = "capsule",
    [IMPACT_POLYHEDRON] = "polyhedron",
};

/* shape.kind, .a .b .c .r .s .t .rounding, .volume, .inertia (per unit mass), .bounding_radius, and the methods */
static int shape_index(lua_State *L)
{
    const impact_shape *shape = luaL_checkudata(L, 1, IMPACT_LUA_SHAPE);
    const char *key = lua_type(L, 2) == LUA_TSTRING ? lua_tostring(L, 2) : "";
    const struct {
        const char *key;
        double value;
    } numbers[] = {{"a", shape->a},
                   {"b", shape->b},
                   {"c", shape->c},
                   {"r", shape->r},
                   {"s", shape->s},
                   {"t", shape->t},
                   {"rounding", shape->rounding}};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        if (strcmp(key, numbers[i].key) == 0) {
            lua_pushnumber(L, numbers[i].value);
            return 1;
        }
    }
    if (strcmp(key, "kind") == 0)
        lua_pushstring(L, kind_words[shape->kind]);
    else if (strcmp(key, "volume") == 0)
        lua_pushnumber(L, impact_shape_volume(shape));
    else if (strcmp(key, "inertia") == 0)
        quat_lua_push_vec3(L, impact_shape_inertia(shape));
    else if (strcmp(key, "bounding_radius") == 0)
        lua_pushnumber(L, impact_shape_bounding_radius(shape));
    else if (!shape->hull || !impact_lua_push_hull_value(L, shape->hull, key))
        lua_getfield(L, lua_upvalueindex(1), key);
    return 1;
}

static int shape_tostring(lua_State *L)
{
    const impact_shape *shape = luaL_checkudata(L, 1, IMPACT_LUA_SHAPE);
    char text[120];
    snprintf(text, sizeof text, "%s(%g, %g, %g)", kind_words[shape->kind], shape->a, shape->b, shape->c);
    lua_pushstring(L, text);
    return 1;
}

void impact_lua_open_shape(lua_State *L)
{
    static const luaL_Reg methods[] = {
        {"support", shape_support},       {"point", shape_point}, {"normal", shape_normal},   {"inside", shape_inside},
        {"curvatures", shape_curvatures}, {"mesh", shape_mesh},   {"hessian", shape_hessian}, {NULL, NULL}};
    static const luaL_Reg functions[] = {{"sphere", shape_sphere},
                                         {"plane", shape_plane},
                                         {"ellipsoid", shape_ellipsoid},
                                         {"superquadric", shape_superquadric},
                                         {"superellipsoid", shape_superellipsoid},
                                         {NULL, NULL}};
    luaL_newmetatable(L, IMPACT_LUA_SHAPE);
    luaL_newlib(L, methods);
    lua_pushcclosure(L, shape_index, 1);
    lua_setfield(L, -2, "__index");
    lua_pushcfunction(L, shape_tostring);
    lua_setfield(L, -2, "__tostring");
    lua_pop(L, 1);
    luaL_setfuncs(L, functions, 0);
    luaL_newlib(L, functions); /* impact.shape.sphere as well as impact.sphere */
    lua_setfield(L, -2, "shape");
}
