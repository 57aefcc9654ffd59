/* SPDX-License-Identifier: MIT
 *
 * Parametric surfaces in Lua, and the choice of frames over a mesh.
 */
#include "quat_core.h"
#include "quat_surface.h"

static bool ask(double u, double v, qvec3 d[6], void *context)
{
    const double x[2] = {u, v};
    return quat_lua_call_vectors(context, 2, x, d);
}

static quat_lua_surface *new_surface(lua_State *L)
{
    quat_lua_surface *const s = lua_newuserdatauv(L, sizeof *s, 1);
    const quat_lua_surface none = {0};
    *s = none;
    luaL_setmetatable(L, QUAT_LUA_SURFACE);
    return s;
}

/* ---- making ---- */

/* surface.new{at = f, u0 = , u1 = , v0 = , v1 = [, closed_u = , closed_v = , derivatives = ]} */
static int l_new(lua_State *L)
{
    static const char *const keys[] = {"at", "u0", "u1", "v0", "v1", "closed_u", "closed_v", "derivatives", NULL};
    const quat_lua_reader reader = quat_lua_read(L, 1, "surface", NULL, keys);
    double range[4];
    for (int i = 0; i < 5; i++) quat_lua_need(&reader, keys[i]);
    for (int i = 0; i < 4; i++) range[i] = quat_lua_get_number(&reader, keys[i + 1], QUAT_LUA_FINITE, 0);
    for (int i = 0; i < 4; i += 2)
        if (!(range[i] < range[i + 1]))
            return quat_lua_reader_error(&reader, "%s must be greater than %s, got %g and %g", keys[i + 2], keys[i + 1],
                                         range[i + 1], range[i]);
    quat_lua_surface *const s = new_surface(L);
    s->surface.at = ask;
    s->surface.u0 = range[0], s->surface.u1 = range[1], s->surface.v0 = range[2], s->surface.v1 = range[3];
    s->surface.closed_u = quat_lua_get_boolean(&reader, "closed_u", false);
    s->surface.closed_v = quat_lua_get_boolean(&reader, "closed_v", false);
    s->surface.known = (int)quat_lua_get_integer(&reader, "derivatives", 0, 2, 0);
    s->scripted = true;
    if (quat_lua_push(&reader, "at") != LUA_TFUNCTION)
        return quat_lua_reader_error(&reader, "at must be a function, got a %s", luaL_typename(L, -1));
    lua_setiuservalue(L, -2, 1);
    return 1;
}

static double size(lua_State *L, int index, const char *name)
{
    return quat_lua_arg_number(L, index, name, QUAT_LUA_POSITIVE);
}

static int l_plane(lua_State *L)
{
    const double a = size(L, 1, "a"), b = size(L, 2, "b");
    quat_lua_surface *const s = new_surface(L);
    quat_plane(a, b, &s->family, &s->surface);
    return 1;
}

static int l_sphere(lua_State *L)
{
    const double r = size(L, 1, "r");
    quat_lua_surface *const s = new_surface(L);
    quat_ellipsoid(r, r, r, &s->family, &s->surface);
    return 1;
}

static int l_ellipsoid(lua_State *L)
{
    const double a = size(L, 1, "a"), b = size(L, 2, "b"), c = size(L, 3, "c");
    quat_lua_surface *const s = new_surface(L);
    quat_ellipsoid(a, b, c, &s->family, &s->surface);
    return 1;
}

static int l_torus(lua_State *L)
{
    const double R = size(L, 1, "R"), r = size(L, 2, "r");
    if (r >= R) return quat_lua_error(L, "argument 'r' must be less than R, got %g", r);
    quat_lua_surface *const s = new_surface(L);
    quat_torus(R, r, &s->family, &s->surface);
    return 1;
}

static int l_saddle(lua_State *L)
{
    const double a = size(L, 1, "a"), extent = size(L, 2, "size");
    quat_lua_surface *const s = new_surface(L);
    quat_saddle(a, extent, &s->family, &s->surface);
    return 1;
}

static int l_catenoid(lua_State *L)
{
    const double a = size(L, 1, "a"), height = size(L, 2, "height");
    quat_lua_surface *const s = new_surface(L);
    quat_catenoid(a, height, &s->family, &s->surface);
    return 1;
}

static int l_helicoid(lua_State *L)
{
    const double a = size(L, 1, "a"), turns = size(L, 2, "turns"), width = size(L, 3, "width");
    quat_lua_surface *const s = new_surface(L);
    quat_helicoid(a, turns, width, &s->family, &s->surface);
    return 1;
}

static double exponent(lua_State *L, int index, const char *name)
{
    const double e = quat_lua_arg_number(L, index, name, QUAT_LUA_POSITIVE);
    if (e < 0.05 || e > 4) quat_lua_error(L, "argument '%s' must be from 0.05 to 4, got %g", name, e);
    return e;
}

static int l_superellipsoid(lua_State *L)
{
    const double a = size(L, 1, "a"), b = size(L, 2, "b"), c = size(L, 3, "c"), e = exponent(L, 4, "e"),
                 f = exponent(L, 5, "f");
    quat_lua_surface *const s = new_surface(L);
    quat_superellipsoid(a, b, c, e, f, &s->family, &s->surface);
    return 1;
}

/* ---- asking ---- */

/* surface:range() -> u0, u1, v0, v1, closed_u, closed_v */
static int l_range(lua_State *L)
{
    const quat_surface *const s = &((const quat_lua_surface *)luaL_checkudata(L, 1, QUAT_LUA_SURFACE))->surface;
    const double range[4] = {s->u0, s->u1, s->v0, s->v1};
    for (int i = 0; i < 4; i++) lua_pushnumber(L, range[i]);
    lua_pushboolean(L, s->closed_u);
    lua_pushboolean(L, s->closed_v);
    return 6;
}

static void push_point(lua_State *L, const quat_surface_point *p)
{
    lua_createtable(L, 0, 15);
    quat_lua_set_vec3(L, "position", p->position);
    quat_lua_set_vec3(L, "xu", p->xu);
    quat_lua_set_vec3(L, "xv", p->xv);
    quat_lua_set_quat(L, "frame", p->frame);
    quat_lua_set_vec3(L, "a", p->a);
    quat_lua_set_vec3(L, "b", p->b);
    quat_lua_set_number(L, "area", p->area);
    quat_lua_set_number(L, "gauss", p->curvature.gauss);
    quat_lua_set_number(L, "mean", p->curvature.mean);
    quat_lua_set_number(L, "error", p->error);
    quat_lua_push_numbers(L, 3, p->first);
    lua_setfield(L, -2, "first");
    quat_lua_push_numbers(L, 3, p->second);
    lua_setfield(L, -2, "second");
    quat_lua_push_numbers(L, 2, p->curvature.principal);
    lua_setfield(L, -2, "principal");
    quat_lua_push_vec3s(L, 2, p->curvature.direction);
    lua_setfield(L, -2, "directions");
}

static int l_at(lua_State *L)
{
    quat_lua_call call;
    quat_surface_point p;
    const double u = quat_lua_arg_number(L, 2, "u", QUAT_LUA_FINITE),
                 v = quat_lua_arg_number(L, 3, "v", QUAT_LUA_FINITE);
    const quat_surface surface = quat_lua_begin_surface(L, &call);
    const quat_status status = quat_surface_at(&surface, u, v, &p);
    quat_lua_call_end(&call);
    push_point(L, &p);
    return quat_lua_results(L, status, 1);
}

static int l_integrability(lua_State *L)
{
    quat_lua_call call;
    double residual;
    const double u = quat_lua_arg_number(L, 2, "u", QUAT_LUA_FINITE),
                 v = quat_lua_arg_number(L, 3, "v", QUAT_LUA_FINITE);
    const quat_surface surface = quat_lua_begin_surface(L, &call);
    const quat_status status = quat_surface_integrability(&surface, u, v, &residual);
    quat_lua_call_end(&call);
    lua_pushnumber(L, residual);
    return quat_lua_results(L, status, 1);
}

/* ---- frames over a mesh ---- */

static void push_triangles(lua_State *L, size_t m, const size_t corner[])
{
    lua_createtable(L, (int)m, 0);
    for (size_t i = 0; i < m; i++) {
        lua_createtable(L, 3, 0);
        for (size_t c = 0; c < 3; c++) {
            lua_pushinteger(L, (lua_Integer)corner[3 * i + c] + 1);
            lua_rawseti(L, -2, (lua_Integer)c + 1);
        }
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
}

/* surface:patch{rows = , columns = [, u0 = , u1 = , v0 = , v1 = ]} -> {positions = , frames = , triangles = } */
static int l_patch(lua_State *L)
{
    static const char *const keys[] = {"rows", "columns", "u0", "u1", "v0", "v1", NULL};
    quat_lua_call call;
    const quat_surface *const s = &((const quat_lua_surface *)luaL_checkudata(L, 1, QUAT_LUA_SURFACE))->surface;
    const quat_lua_reader reader = quat_lua_read(L, 2, "patch", NULL, keys);
    quat_lua_need(&reader, "rows");
    quat_lua_need(&reader, "columns");
    const size_t rows = (size_t)quat_lua_get_integer(&reader, "rows", 2, 2000, 2),
                 columns = (size_t)quat_lua_get_integer(&reader, "columns", 2, 2000, 2),
                 m = 2 * (rows - 1) * (columns - 1);
    const double u0 = quat_lua_get_number(&reader, "u0", QUAT_LUA_FINITE, s->u0),
                 u1 = quat_lua_get_number(&reader, "u1", QUAT_LUA_FINITE, s->u1),
                 v0 = quat_lua_get_number(&reader, "v0", QUAT_LUA_FINITE, s->v0),
                 v1 = quat_lua_get_number(&reader, "v1", QUAT_LUA_FINITE, s->v1);
    if (!(u0 < u1)) return quat_lua_reader_error(&reader, "u1 must be greater than u0");
    if (!(v0 < v1)) return quat_lua_reader_error(&reader, "v1 must be greater than v0");
    qvec3 *const x = lua_newuserdatauv(L, rows * columns * sizeof *x, 0);
    quat *const q = lua_newuserdatauv(L, rows * columns * sizeof *q, 0);
    size_t *const corner = lua_newuserdatauv(L, 3 * m * sizeof *corner, 0);
    const quat_surface surface = quat_lua_begin_surface(L, &call);
    const quat_status status = quat_surface_patch(&surface, u0, u1, v0, v1, rows, columns, x, q, corner);
    quat_lua_call_end(&call);
    if (status < 0) return quat_lua_results(L, status, 0);
    lua_createtable(L, 0, 3);
    quat_lua_push_vec3s(L, rows * columns, x);
    lua_setfield(L, -2, "positions");
    quat_lua_push_quats(L, rows * columns, q);
    lua_setfield(L, -2, "frames");
    push_triangles(L, m, corner);
    lua_setfield(L, -2, "triangles");
    return 1;
}

static size_t *corners(lua_State *L, int list, size_t nodes, size_t *m)
{
    if (lua_type(L, list) != LUA_TTABLE || lua_rawlen(L, list) < 1)
        quat_lua_error(L, "argument 'triangles' must be a list of at least one triangle");
    *m = lua_rawlen(L, list);
    size_t *const corner = lua_newuserdatauv(L, 3 * *m * sizeof *corner, 0);
    for (size_t i = 0; i < *m; i++) {
        const bool table = lua_rawgeti(L, list, (lua_Integer)i + 1) == LUA_TTABLE;
        for (int c = 0; c < 3; c++) {
            int good = 0;
            lua_Integer node = 0;
            if (table) {
                lua_rawgeti(L, -1, c + 1);
                node = lua_tointegerx(L, -1, &good);
                lua_pop(L, 1);
            }
            if (!good || node < 1 || (size_t)node > nodes)
                quat_lua_error(L, "argument 'triangles[%d]' must be three numbers of nodes, 1 ... %d", (int)i + 1,
                               (int)nodes);
            corner[3 * i + (size_t)c] = (size_t)node - 1;
        }
        lua_pop(L, 1);
    }
    return corner;
}

/* surface.choose_frames{positions = , frames = , triangles = [, gauge = ]} -> frames, report */
static int l_choose_frames(lua_State *L)
{
    static const char *const keys[] = {"positions", "frames", "triangles", "gauge", NULL};
    static const char *const gauges[] = {"shortest", "length", "area", NULL};
    quat_gauge_report report;
    size_t n, count, m;
    const quat_lua_reader reader = quat_lua_read(L, 1, "choose_frames", NULL, keys);
    for (int i = 0; i < 3; i++) quat_lua_need(&reader, keys[i]);
    const int gauge = quat_lua_get_choice(&reader, "gauge", gauges, QUAT_MINIMAL_LENGTH);
    lua_getfield(L, 1, "positions");
    const qvec3 *const x = quat_lua_arg_vec3s(L, lua_gettop(L), "positions", 1, &n);
    lua_getfield(L, 1, "frames");
    quat *const q = quat_lua_arg_units(L, lua_gettop(L), "frames", 1, &count);
    if (count != n) return quat_lua_reader_error(&reader, "%d positions but %d frames", (int)n, (int)count);
    lua_getfield(L, 1, "triangles");
    const size_t *const corner = corners(L, lua_gettop(L), n, &m);
    const quat_status status = quat_choose_frames(n, x, m, corner, (quat_gauge)gauge, q, &report);
    if (status == QUAT_EARGUMENT) return quat_lua_reader_error(&reader, "the triangles do not join all nodes");
    quat_lua_push_quats(L, n, q);
    lua_createtable(L, 0, 4);
    quat_lua_set_number(L, "energy", report.energy);
    quat_lua_set_number(L, "area", report.area);
    quat_lua_set_integer(L, "rounds", (lua_Integer)report.rounds);
    quat_lua_set_integer(L, "torn", (lua_Integer)report.torn);
    return quat_lua_results(L, status, 2);
}

/* surface.transition(q1, q2) -> turns, angles [, reason] */
static int l_transition(lua_State *L)
{
    size_t n, count;
    double turns;
    const quat *const q1 = quat_lua_arg_units(L, 1, "q1", 1, &n), *const q2 = quat_lua_arg_units(L, 2, "q2", 1, &count);
    quat_lua_same_length(L, n, count, "q2");
    double *const angle = lua_newuserdatauv(L, n * sizeof *angle, 0);
    const quat_status status = quat_transition(n, q1, q2, angle, &turns, NULL);
    if (status < 0) return quat_lua_failure(L, "the frames do not share their normals");
    lua_pushnumber(L, turns);
    quat_lua_push_numbers(L, n, angle);
    return quat_lua_results(L, status, 2);
}

void quat_lua_open_surface(lua_State *L)
{
    static const luaL_Reg methods[] = {
        {"range", l_range}, {"at", l_at}, {"integrability", l_integrability}, {"patch", l_patch}, {NULL, NULL}};
    static const luaL_Reg functions[] = {{"new", l_new},
                                         {"plane", l_plane},
                                         {"sphere", l_sphere},
                                         {"ellipsoid", l_ellipsoid},
                                         {"torus", l_torus},
                                         {"saddle", l_saddle},
                                         {"catenoid", l_catenoid},
                                         {"helicoid", l_helicoid},
                                         {"superellipsoid", l_superellipsoid},
                                         {"choose_frames", l_choose_frames},
                                         {"transition", l_transition},
                                         {NULL, NULL}};
    luaL_newmetatable(L, QUAT_LUA_SURFACE);
    luaL_newlib(L, methods);
    lua_pushvalue(L, -1);
    lua_setfield(L, -3, "__index");
    lua_setfield(L, -3, "surface_methods"); /* the layer adds `total` */
    lua_pop(L, 1);
    luaL_newlib(L, functions);
    lua_setfield(L, -2, "surface");
}
