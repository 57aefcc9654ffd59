/* SPDX-License-Identifier: MIT
 *
 * Bodies as a script writes them: impact.body{name=, shape=, ...}.
 */
#include "impact_core.h"

#include <quat/rotation.h>

#define BODY "impact.body"

static const char positions_key[] = "impact.positions"; /* registry: definition table -> "file:line: ", weak keys */

static void push_positions(lua_State *L)
{
    if (lua_getfield(L, LUA_REGISTRYINDEX, positions_key) == LUA_TTABLE) return;
    lua_pop(L, 1);
    lua_newtable(L);
    lua_createtable(L, 0, 1);
    lua_pushliteral(L, "k");
    lua_setfield(L, -2, "__mode");
    lua_setmetatable(L, -2);
    lua_pushvalue(L, -1);
    lua_setfield(L, LUA_REGISTRYINDEX, positions_key);
}

void impact_lua_mark(lua_State *L, int arg, const char *metatable)
{
    arg = lua_absindex(L, arg);
    luaL_newmetatable(L, metatable);
    lua_setmetatable(L, arg);
    push_positions(L);
    lua_pushvalue(L, arg);
    quat_lua_where(L);
    lua_rawset(L, -3);
    lua_pop(L, 1);
}

bool impact_lua_is_marked(lua_State *L, int index, const char *metatable)
{
    if (!lua_istable(L, index) || !lua_getmetatable(L, index)) return false;
    luaL_getmetatable(L, metatable);
    const bool same = lua_istable(L, -1) && lua_rawequal(L, -1, -2);
    lua_pop(L, 2);
    return same;
}

const char *impact_lua_push_position(lua_State *L, int index)
{
    index = lua_absindex(L, index);
    push_positions(L);
    lua_pushvalue(L, index);
    lua_rawget(L, -2);
    lua_remove(L, -2);
    return lua_tostring(L, -1);
}

/* The shortest turn that takes +z to the normal; half a turn about x when they are opposite. */
static quat turn_to_normal(qvec3 normal)
{
    const double length = qvec3_norm(normal);
    const qvec3 n = {normal.x / length, normal.y / length, normal.z / length};
    const double w = n.z > 0 ? 1 + n.z : (n.x * n.x + n.y * n.y) / (1 - n.z);
    quat q;
    if (quat_normalize(quat_make(w, -n.y, n.x, 0), &q) < 0) q = quat_make(0, 1, 0, 0);
    return q;
}

static void read_shape(const quat_lua_reader *reader, impact_body_def *def)
{
    lua_State *L = reader->L;
    quat_lua_need(reader, "shape");
    quat_lua_push(reader, "shape");
    const impact_shape *shape = luaL_testudata(L, -1, IMPACT_LUA_SHAPE);
    if (!shape)
        quat_lua_reader_error(reader, "shape must be a shape such as impact.sphere(0.3), got a %s",
                              luaL_typename(L, -1));
    def->shape = *shape;
    lua_pop(L, 1);
}

static void read_orientation(const quat_lua_reader *reader, impact_body_def *def)
{
    if (quat_lua_has(reader, "normal")) {
        const qvec3 normal = quat_lua_get_vec3(reader, "normal", (qvec3){0, 0, 1});
        if (quat_lua_has(reader, "orientation")) quat_lua_reader_error(reader, "give normal or orientation, not both");
        if (def->shape.kind != IMPACT_PLANE) quat_lua_reader_error(reader, "normal is for planes; give orientation");
        if (!(qvec3_norm(normal) > 0)) quat_lua_reader_error(reader, "normal must not be zero");
        def->orientation = turn_to_normal(normal);
        return;
    }
    def->orientation = quat_lua_get_quat(reader, "orientation", def->orientation);
    if (quat_normalize(def->orientation, &def->orientation) < 0)
        quat_lua_reader_error(reader, "orientation must not be zero");
}

/* What a static body does not follow is a mistake of the script's: a mass that does nothing. */
static void refuse_of_static(const quat_lua_reader *reader)
{
    static const char *const idle[] = {"mass", "density", "moments", "linear_damping", "angular_damping", NULL};
    for (int i = 0; idle[i]; i++)
        if (quat_lua_has(reader, idle[i])) quat_lua_reader_error(reader, "is static: it has no use for %s", idle[i]);
}

void impact_lua_read_body(lua_State *L, int index, const char *where, impact_body_def *def)
{
    static const char *const keys[] = {"name",
                                       "shape",
                                       "static",
                                       "mass",
                                       "density",
                                       "moments",
                                       "position",
                                       "orientation",
                                       "normal",
                                       "velocity",
                                       "omega",
                                       "friction",
                                       "restitution",
                                       "torsional_friction",
                                       "rolling_friction",
                                       "linear_damping",
                                       "angular_damping",
                                       "shape_position",
                                       "shape_orientation",
                                       "trail",
                                       NULL};
    const quat_lua_reader reader = quat_lua_read(L, index, "body", where, keys);
    *def = impact_default_body_def();
    quat_lua_need(&reader, "name");
    def->name = quat_lua_get_string(&reader, "name", "");
    if (!def->name[0]) quat_lua_reader_error(&reader, "name must not be empty");
    read_shape(&reader, def);
    def->is_static = quat_lua_get_boolean(&reader, "static", def->shape.kind == IMPACT_PLANE);
    if (def->is_static) refuse_of_static(&reader);
    if (quat_lua_has(&reader, "mass") && quat_lua_has(&reader, "density"))
        quat_lua_reader_error(&reader, "give mass or density, not both");
    def->mass =
        quat_lua_get_number(&reader, "mass", QUAT_LUA_POSITIVE, quat_lua_has(&reader, "density") ? NAN : def->mass);
    def->density = quat_lua_get_number(&reader, "density", QUAT_LUA_POSITIVE, def->density);
    def->moments = quat_lua_get_vec3(&reader, "moments", def->moments);
    def->position = quat_lua_get_vec3(&reader, "position", def->position);
    read_orientation(&reader, def);
    def->shape_position = quat_lua_get_vec3(&reader, "shape_position", def->shape_position);
    def->shape_orientation = quat_lua_get_quat(&reader, "shape_orientation", def->shape_orientation);
    def->trail = quat_lua_get_vec3(&reader, "trail", def->trail);
    def->velocity = quat_lua_get_vec3(&reader, "velocity", def->velocity);
    def->omega = quat_lua_get_vec3(&reader, "omega", def->omega);
    def->friction = quat_lua_get_number(&reader, "friction", QUAT_LUA_NOT_NEGATIVE, def->friction);
    def->restitution = quat_lua_get_number(&reader, "restitution", QUAT_LUA_FRACTION, def->restitution);
    def->torsional_friction =
        quat_lua_get_number(&reader, "torsional_friction", QUAT_LUA_NOT_NEGATIVE, def->torsional_friction);
    def->rolling_friction =
        quat_lua_get_number(&reader, "rolling_friction", QUAT_LUA_NOT_NEGATIVE, def->rolling_friction);
    def->linear_damping = quat_lua_get_number(&reader, "linear_damping", QUAT_LUA_BELOW_ONE, def->linear_damping);
    def->angular_damping = quat_lua_get_number(&reader, "angular_damping", QUAT_LUA_BELOW_ONE, def->angular_damping);
}

/* What is read is a copy that no finaliser of the script's can reach: the collector need not rest, which would make it
 * begin anew with each of many bodies. */
static void push_copy(lua_State *L, int table)
{
    lua_newtable(L);
    for (lua_pushnil(L); lua_next(L, table); lua_pop(L, 1)) {
        lua_pushvalue(L, -2);
        lua_pushvalue(L, -2);
        lua_rawset(L, -5);
    }
}

/* body{name=, shape=, ...}: the same table, checked. */
static int body_new(lua_State *L)
{
    impact_body_def def;
    lua_settop(L, 1);
    if (lua_istable(L, 1))
        push_copy(L, 1);
    else
        lua_pushvalue(L, 1);
    impact_lua_read_body(L, 2, NULL, &def);
    impact_lua_mark(L, 1, BODY);
    lua_settop(L, 1);
    return 1;
}

void impact_lua_open_body(lua_State *L)
{
    lua_pushcfunction(L, body_new);
    lua_setfield(L, -2, "body");
}
