/* SPDX-License-Identifier: MIT
 *
 * Shapes with faces: boxes, cylinders, cones, capsules, polyhedra.
 */
#include "impact_core.h"

#include <string.h>

/* A userdata that holds one impact_hull *, kept alive by the shapes that use it. */
#define HULL "impact.hull"

static double length_of(const quat_lua_reader *reader, const char *key)
{
    quat_lua_need(reader, key);
    return quat_lua_get_number(reader, key, QUAT_LUA_POSITIVE, 0);
}

/* Pushes the shape that was made, or raises what is wrong with the numbers. */
static int push_made(const quat_lua_reader *reader, impact_status status, const impact_shape *shape,
                     const impact_shape *numbers)
{
    char message[120];
    if (status < 0 && impact_shape_check(numbers, message, sizeof message) < 0)
        return quat_lua_reader_error(reader, "%s", message);
    if (status < 0) return quat_lua_reader_error(reader, "%s", impact_status_string(status));
    impact_lua_push_shape(reader->L, shape);
    return 1;
}

static double rounding_of(const quat_lua_reader *reader)
{
    return quat_lua_get_number(reader, "rounding", QUAT_LUA_FINITE, 0);
}

static impact_shape plain(impact_shape_kind kind, double a, double b, double c, double rounding)
{
    return (impact_shape){.kind = kind, .a = a, .b = b, .c = c, .r = 2, .s = 2, .t = 2, .rounding = rounding};
}

/* box{a=, b=, c=, rounding=}: half sides of the whole */
static int shape_box(lua_State *L)
{
    static const char *const keys[] = {"a", "b", "c", "rounding", NULL};
    const quat_lua_reader reader = quat_lua_read(L, 1, "box", NULL, keys);
    const double a = length_of(&reader, "a"), b = length_of(&reader, "b"), c = length_of(&reader, "c");
    const impact_shape numbers = plain(IMPACT_BOX, a, b, c, rounding_of(&reader));
    impact_shape shape;
    const impact_status status = impact_shape_box(a, b, c, numbers.rounding, &shape);
    return push_made(&reader, status, &shape, &numbers);
}

/* cylinder{radius=, half_height=, rounding=} */
static int shape_cylinder(lua_State *L)
{
    static const char *const keys[] = {"radius", "half_height", "rounding", NULL};
    const quat_lua_reader reader = quat_lua_read(L, 1, "cylinder", NULL, keys);
    const double radius = length_of(&reader, "radius"), half = length_of(&reader, "half_height");
    const impact_shape numbers = plain(IMPACT_CYLINDER, radius, radius, half, rounding_of(&reader));
    impact_shape shape;
    const impact_status status = impact_shape_cylinder(radius, half, numbers.rounding, &shape);
    return push_made(&reader, status, &shape, &numbers);
}

/* cone{radius=, height=, rounding=} */
static int shape_cone(lua_State *L)
{
    static const char *const keys[] = {"radius", "height", "rounding", NULL};
    const quat_lua_reader reader = quat_lua_read(L, 1, "cone", NULL, keys);
    const double radius = length_of(&reader, "radius"), height = length_of(&reader, "height");
    const impact_shape numbers = plain(IMPACT_CONE, radius, radius, height, rounding_of(&reader));
    impact_shape shape;
    const impact_status status = impact_shape_cone(radius, height, numbers.rounding, &shape);
    return push_made(&reader, status, &shape, &numbers);
}

/* capsule{radius=, half_height=} */
static int shape_capsule(lua_State *L)
{
    static const char *const keys[] = {"radius", "half_height", NULL};
    const quat_lua_reader reader = quat_lua_read(L, 1, "capsule", NULL, keys);
    const double radius = length_of(&reader, "radius"), half = length_of(&reader, "half_height");
    const impact_shape numbers = plain(IMPACT_CAPSULE, radius, radius, half + radius, radius);
    impact_shape shape;
    const impact_status status = impact_shape_capsule(radius, half, &shape);
    return push_made(&reader, status, &shape, &numbers);
}

/* ---- polyhedra ---- */

static size_t read_points(const quat_lua_reader *reader, qvec3 *points)
{
    lua_State *L = reader->L;
    quat_lua_need(reader, "vertices");
    if (quat_lua_push(reader, "vertices") != LUA_TTABLE)
        quat_lua_reader_error(reader, "vertices must be a list of points, got a %s", luaL_typename(L, -1));
    const size_t count = lua_rawlen(L, -1);
    if (count > IMPACT_HULL_POINTS) quat_lua_reader_error(reader, "%d points are more than 256", (int)count);
    for (size_t i = 0; i < count; i++) {
        char name[32];
        lua_pushfstring(L, "vertices[%d]", (int)i + 1);
        strncpy(name, lua_tostring(L, -1), sizeof name - 1);
        name[sizeof name - 1] = '\0';
        lua_pop(L, 1);
        lua_rawgeti(L, -1, (lua_Integer)i + 1);
        points[i] = quat_lua_arg_vec3(L, lua_gettop(L), name);
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    return count;
}

impact_hull **impact_lua_push_hull(lua_State *L, const impact_hull *hull)
{
    impact_hull **place = lua_newuserdatauv(L, sizeof *place, 0);
    *place = NULL;
    luaL_setmetatable(L, HULL);
    if (hull) *place = impact_hull_share(hull);
    return place;
}

/* polyhedron{vertices={{x, y, z}, ...}, rounding=}: their hull, about its centroid, along its principal axes */
static int shape_polyhedron(lua_State *L)
{
    static const char *const keys[] = {"name", "vertices", "rounding", NULL};
    const quat_lua_reader reader = quat_lua_read(L, 1, "polyhedron", NULL, keys);
    qvec3 points[IMPACT_HULL_POINTS];
    char message[120];
    const size_t count = read_points(&reader, points);
    const double rounding = rounding_of(&reader);
    impact_hull **place = impact_lua_push_hull(L, NULL);
    const impact_lua_host *host = impact_lua_get_host(L);
    if (impact_hull_create(points, count, rounding, host ? host->allocator : NULL, place, message, sizeof message) < 0)
        return quat_lua_reader_error(&reader, "%s", message);
    impact_shape shape;
    impact_shape_polyhedron(*place, &shape);
    impact_lua_push_shape(L, &shape);
    return 1;
}

static int hull_gc(lua_State *L)
{
    impact_hull **place = luaL_checkudata(L, 1, HULL);
    impact_hull_destroy(*place);
    *place = NULL;
    return 0;
}

static void push_vertices(lua_State *L, const impact_hull *hull, int count)
{
    lua_createtable(L, count, 0);
    for (int i = 0; i < count; i++) {
        quat_lua_push_vec3(L, impact_hull_vertex(hull, i));
        lua_rawseti(L, -2, i + 1);
    }
}

static void push_faces(lua_State *L, const impact_hull *hull, int count)
{
    int vertex[IMPACT_HULL_POINTS];
    lua_createtable(L, count, 0);
    for (int f = 0; f < count; f++) {
        const int corners = impact_hull_face(hull, f, vertex, NULL);
        lua_createtable(L, corners, 0);
        for (int i = 0; i < corners; i++) {
            lua_pushinteger(L, vertex[i] + 1);
            lua_rawseti(L, -2, i + 1);
        }
        lua_rawseti(L, -2, f + 1);
    }
}

bool impact_lua_push_hull_value(lua_State *L, const impact_hull *hull, const char *key)
{
    const impact_hull_info info = impact_hull_describe(hull);
    if (strcmp(key, "vertices") == 0)
        push_vertices(L, hull, info.vertices);
    else if (strcmp(key, "faces") == 0)
        push_faces(L, hull, info.faces);
    else if (strcmp(key, "dropped") == 0)
        lua_pushinteger(L, info.dropped);
    else if (strcmp(key, "center") == 0)
        quat_lua_push_vec3(L, info.center);
    else if (strcmp(key, "axes") == 0)
        quat_lua_push_quat(L, info.axes);
    else
        return false;
    return true;
}

void impact_lua_open_faces(lua_State *L)
{
    static const luaL_Reg functions[] = {
        {"box", shape_box},         {"cylinder", shape_cylinder},     {"cone", shape_cone},
        {"capsule", shape_capsule}, {"polyhedron", shape_polyhedron}, {NULL, NULL}};
    luaL_newmetatable(L, HULL);
    lua_pushcfunction(L, hull_gc);
    lua_setfield(L, -2, "__gc");
    lua_pop(L, 1);
    luaL_setfuncs(L, functions, 0);
    lua_getfield(L, -1, "shape"); /* impact.shape.box as well as impact.box */
    luaL_setfuncs(L, functions, 0);
    lua_pop(L, 1);
}
