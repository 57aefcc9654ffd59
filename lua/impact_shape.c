/* SPDX-License-Identifier: MIT */
#include "impact_core.h"

#include <stdio.h>
#include <string.h>

void impact_lua_push_shape(lua_State *L, const impact_shape *shape)
{
    impact_shape *place = lua_newuserdatauv(L, sizeof *shape, 0);
    *place = *shape;
    luaL_setmetatable(L, IMPACT_LUA_SHAPE);
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

static const char *const kind_words[] = {
    [IMPACT_SPHERE] = "sphere",
    [IMPACT_PLANE] = "plane",
    [IMPACT_SUPERQUADRIC] = "superquadric",
    [IMPACT_SUPERELLIPSOID] = "superellipsoid",
};

/* shape.kind, .a .b .c .r .s .t, .volume, .inertia (per unit mass), .bounding_radius */
static int shape_index(lua_State *L)
{
    const impact_shape *shape = luaL_checkudata(L, 1, IMPACT_LUA_SHAPE);
    const char *key = lua_type(L, 2) == LUA_TSTRING ? lua_tostring(L, 2) : "";
    const struct {
        const char *key;
        double value;
    } numbers[] = {{"a", shape->a}, {"b", shape->b}, {"c", shape->c},
                   {"r", shape->r}, {"s", shape->s}, {"t", shape->t}};
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
    else
        lua_pushnil(L);
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
    static const luaL_Reg methods[] = {{"__index", shape_index}, {"__tostring", shape_tostring}, {NULL, NULL}};
    static const luaL_Reg functions[] = {{"sphere", shape_sphere}, {"plane", shape_plane}, {NULL, NULL}};
    luaL_newmetatable(L, IMPACT_LUA_SHAPE);
    luaL_setfuncs(L, methods, 0);
    lua_pop(L, 1);
    luaL_setfuncs(L, functions, 0);
}
