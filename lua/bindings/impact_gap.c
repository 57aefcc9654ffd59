/* SPDX-License-Identifier: MIT
 *
 * The gap of two bodies, and when they first touch.
 */
#include "impact_core.h"

static void read_solid(const quat_lua_reader *reader, impact_solid *solid)
{
    lua_State *L = reader->L;
    quat_lua_need(reader, "shape");
    lua_getfield(L, reader->index, "shape");
    const impact_shape *shape = luaL_testudata(L, -1, IMPACT_LUA_SHAPE);
    if (!shape)
        quat_lua_reader_error(reader, "shape must be a shape such as impact.sphere(0.3), got a %s",
                              luaL_typename(L, -1));
    solid->shape = *shape;
    lua_pop(L, 1);
    solid->position = quat_lua_get_vec3(reader, "position", (qvec3){0, 0, 0});
    const quat q = quat_lua_get_quat(reader, "orientation", quat_identity());
    if (quat_normalize(q, &solid->orientation) != QUAT_OK) quat_lua_reader_error(reader, "orientation is zero");
}

static const char *const path_words[] = {
    [IMPACT_PATH_NONE] = "none", [IMPACT_PATH_CLOSED_FORM] = "closed form", [IMPACT_PATH_NEWTON] = "newton",
    [IMPACT_PATH_GJK] = "gjk",   [IMPACT_PATH_FALLBACK] = "fallback",       [IMPACT_PATH_CCD] = "ccd",
};

static void push_contact(lua_State *L, const impact_contact *c, impact_status status)
{
    lua_createtable(L, 0, 12);
    quat_lua_set_number(L, "gap", c->gap);
    quat_lua_set_number(L, "lower", c->lower);
    quat_lua_set_number(L, "upper", c->upper);
    quat_lua_set_number(L, "stiffness", c->stiffness);
    quat_lua_set_vec3(L, "normal", c->normal);
    quat_lua_set_vec3(L, "point1", c->point1);
    quat_lua_set_vec3(L, "point2", c->point2);
    quat_lua_set_vec3(L, "offset1", c->offset1);
    quat_lua_set_vec3(L, "offset2", c->offset2);
    quat_lua_set_string(L, "path", path_words[c->path]);
    quat_lua_set_string(L, "status", impact_status_string(status));
}

static const char no_gap[] = "two planes have no gap: one of the bodies must have another shape";

static bool both_planes(const impact_solid body[2])
{
    return body[0].shape.kind == IMPACT_PLANE && body[1].shape.kind == IMPACT_PLANE;
}

static void read_solids(lua_State *L, impact_solid body[2])
{
    static const char *const keys[] = {"name", "shape", "position", "orientation", NULL};
    for (int i = 0; i < 2; i++) {
        const quat_lua_reader reader = quat_lua_read(L, i + 1, i == 0 ? "first body" : "second body", NULL, keys);
        read_solid(&reader, &body[i]);
    }
}

/* libccd's tolerance, where options ask for it; 0: not by libccd. */
static double read_gap_options(lua_State *L, int arg)
{
    static const char *const keys[] = {"method", "tolerance", NULL};
    static const char *const words[] = {"newton", "ccd", NULL};
    if (lua_isnoneornil(L, arg)) return 0;
    const quat_lua_reader reader = quat_lua_read(L, arg, "options", NULL, keys);
    const bool ccd = quat_lua_get_choice(&reader, "method", words, 0) == 1;
    const double tolerance = quat_lua_get_number(&reader, "tolerance", QUAT_LUA_POSITIVE, 1e-4);
    if (!ccd && quat_lua_has(&reader, "tolerance"))
        quat_lua_reader_error(&reader, "tolerance is libccd's: it needs method = \"ccd\"");
    if (ccd && !(tolerance >= 1e-7 && tolerance <= 1e-2))
        quat_lua_reader_error(&reader, "tolerance must be in [1e-7, 1e-2]: libccd cannot give another");
    return ccd ? tolerance : 0;
}

/* gap(A, B[, {method=, tolerance=}]): {gap=, normal=, point1=, point2=, ...}, or nil, message */
static int gap(lua_State *L)
{
    impact_solid body[2];
    read_solids(L, body);
    const double ccd = read_gap_options(L, 3);
    if (both_planes(body)) return quat_lua_failure(L, no_gap);
    impact_contact contact;
    const impact_status status =
        ccd > 0 ? impact_gap_ccd(&body[0], &body[1], ccd, &contact) : impact_gap(&body[0], &body[1], NULL, &contact);
    if (status < 0) return quat_lua_failure(L, impact_status_string(status));
    push_contact(L, &contact, status);
    return 1;
}

/* gap_receipt(A, B, contact): {worst=, normal=, dual=, primal=, order=, inside1=, inside2=} */
static int gap_receipt(lua_State *L)
{
    static const char *const keys[] = {"gap",    "lower",   "upper",   "stiffness", "normal", "point1",
                                       "point2", "offset1", "offset2", "path",      "status", NULL};
    impact_solid body[2];
    impact_contact contact = {0};
    impact_gap_residuals r;
    read_solids(L, body);
    const quat_lua_reader reader = quat_lua_read(L, 3, "contact", NULL, keys);
    contact.gap = quat_lua_get_number(&reader, "gap", QUAT_LUA_FINITE, NAN);
    contact.lower = quat_lua_get_number(&reader, "lower", QUAT_LUA_FINITE, NAN);
    contact.upper = quat_lua_get_number(&reader, "upper", QUAT_LUA_FINITE, NAN);
    contact.normal = quat_lua_get_vec3(&reader, "normal", (qvec3){NAN, NAN, NAN});
    contact.offset1 = quat_lua_get_vec3(&reader, "offset1", (qvec3){NAN, NAN, NAN});
    contact.offset2 = quat_lua_get_vec3(&reader, "offset2", (qvec3){NAN, NAN, NAN});
    const double worst = impact_gap_receipt(&body[0], &body[1], &contact, &r);
    lua_createtable(L, 0, 7);
    quat_lua_set_number(L, "worst", worst);
    quat_lua_set_number(L, "normal", r.normal);
    quat_lua_set_number(L, "dual", r.dual);
    quat_lua_set_number(L, "primal", r.primal);
    quat_lua_set_number(L, "order", r.order);
    quat_lua_set_number(L, "inside1", r.inside1);
    quat_lua_set_number(L, "inside2", r.inside2);
    return 1;
}

static const char *const feature_words[] = {[IMPACT_SMOOTH] = "smooth",
                                            [IMPACT_VERTEX] = "vertex",
                                            [IMPACT_EDGE] = "edge",
                                            [IMPACT_RIM] = "rim",
                                            [IMPACT_FACE] = "face"};

static void push_patch_point(lua_State *L, const impact_patch_point *p)
{
    lua_createtable(L, 0, 7);
    quat_lua_set_vec3(L, "offset1", p->offset1);
    quat_lua_set_vec3(L, "offset2", p->offset2);
    quat_lua_set_vec3(L, "normal", p->normal);
    quat_lua_set_number(L, "height", p->height);
    quat_lua_set_boolean(L, "closed", p->closed);
    quat_lua_set_string(L, "feature1", feature_words[p->feature1.kind]);
    quat_lua_set_string(L, "feature2", feature_words[p->feature2.kind]);
}

/* patch(A, B[, height]): {dimension=, normal=, gap=, disc=, points={...}}, or nil, message; height in m, 1e-12 when
 * left out */
static int patch(lua_State *L)
{
    impact_solid body[2];
    read_solids(L, body);
    const double height = quat_lua_arg_number_or(L, 3, "height", QUAT_LUA_NOT_NEGATIVE, 1e-12);
    if (both_planes(body)) return quat_lua_failure(L, no_gap);
    impact_contact contact;
    impact_patch p;
    impact_status status = impact_gap(&body[0], &body[1], NULL, &contact);
    if (status >= 0) status = impact_patch_find(&body[0], &body[1], &contact, height, &p);
    if (status < 0) return quat_lua_failure(L, impact_status_string(status));
    lua_createtable(L, 0, 5);
    quat_lua_set_integer(L, "dimension", p.dimension);
    quat_lua_set_vec3(L, "normal", p.normal);
    quat_lua_set_number(L, "gap", contact.gap);
    if (p.disc > 0) quat_lua_set_number(L, "disc", p.disc);
    lua_createtable(L, p.count, 0);
    for (int i = 0; i < p.count; i++) {
        push_patch_point(L, &p.point[i]);
        lua_rawseti(L, -2, i + 1);
    }
    lua_setfield(L, -2, "points");
    return 1;
}

/* toi(A, B, t_max): time, contact; or nil, message when they do not meet by then */
static int toi(lua_State *L)
{
    static const char *const keys[] = {"name",     "shape",        "position", "orientation",
                                       "velocity", "acceleration", "omega",    NULL};
    const qvec3 zero = {0, 0, 0};
    impact_solid body[2];
    impact_motion motion[2];
    for (int i = 0; i < 2; i++) {
        const quat_lua_reader reader = quat_lua_read(L, i + 1, i == 0 ? "first body" : "second body", NULL, keys);
        read_solid(&reader, &body[i]);
        motion[i].velocity = quat_lua_get_vec3(&reader, "velocity", zero);
        motion[i].acceleration = quat_lua_get_vec3(&reader, "acceleration", zero);
        motion[i].omega = quat_lua_get_vec3(&reader, "omega", zero);
    }
    const double t_max = quat_lua_arg_number(L, 3, "t_max", QUAT_LUA_NOT_NEGATIVE);
    if (both_planes(body)) return quat_lua_failure(L, no_gap);
    double time;
    impact_contact contact;
    const impact_status status = impact_toi(&body[0], &motion[0], &body[1], &motion[1], t_max, &time, &contact);
    if (status != IMPACT_OK) return quat_lua_failure(L, impact_status_string(status));
    lua_pushnumber(L, time);
    push_contact(L, &contact, status);
    return 2;
}

void impact_lua_open_gap(lua_State *L)
{
    static const luaL_Reg functions[] = {
        {"gap", gap}, {"gap_receipt", gap_receipt}, {"toi", toi}, {"patch", patch}, {NULL, NULL}};
    luaL_setfuncs(L, functions, 0);
}
