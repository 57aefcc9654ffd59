/* SPDX-License-Identifier: MIT
 *
 * Space curves in Lua: from a function, from points, or ready-made.
 */
#include "quat_call.h"
#include "quat_core.h"

#include <quat/family.h>

#define CURVE "quat.curve"

/* User value 1: the script's function; 2 and 3: the buffers of samples. */
typedef struct lua_curve {
    quat_curve curve;
    quat_family family;
    quat_samples samples;
    bool scripted;
} lua_curve;

static bool ask(double t, qvec3 d[4], void *context) { return quat_lua_call_vectors(context, 1, &t, d); }

/* The curve of argument 1, ready to be asked; its function's place in *call. */
static quat_curve begin(lua_State *L, quat_lua_call *call)
{
    lua_curve *const c = luaL_checkudata(L, 1, CURVE);
    quat_curve curve = c->curve;
    *call = quat_lua_call_begin(L, 1, curve.known + 1);
    if (c->scripted) curve.context = call;
    return curve;
}

static lua_curve *new_curve(lua_State *L)
{
    lua_curve *const c = lua_newuserdatauv(L, sizeof *c, 3);
    const lua_curve none = {0};
    *c = none;
    luaL_setmetatable(L, CURVE);
    return c;
}

/* ---- making ---- */

/* curve.new{at = f, start = , finish = [, closed = , derivatives = ]} */
static int l_new(lua_State *L)
{
    static const char *const keys[] = {"at", "start", "finish", "closed", "derivatives", NULL};
    const quat_lua_reader reader = quat_lua_read(L, 1, "curve", NULL, keys);
    quat_lua_need(&reader, "at");
    quat_lua_need(&reader, "start");
    quat_lua_need(&reader, "finish");
    const double start = quat_lua_get_number(&reader, "start", QUAT_LUA_FINITE, 0),
                 end = quat_lua_get_number(&reader, "finish", QUAT_LUA_FINITE, 0);
    if (!(start < end))
        return quat_lua_reader_error(&reader, "finish must be greater than start, got %g and %g", end, start);
    lua_curve *const c = new_curve(L);
    c->curve.at = ask;
    c->curve.start = start;
    c->curve.end = end;
    c->curve.closed = quat_lua_get_boolean(&reader, "closed", false);
    c->curve.known = (int)quat_lua_get_integer(&reader, "derivatives", 0, 3, 0);
    c->scripted = true;
    if (quat_lua_push(&reader, "at") != LUA_TFUNCTION)
        return quat_lua_reader_error(&reader, "at must be a function, got a %s", luaL_typename(L, -1));
    lua_setiuservalue(L, -2, 1);
    return 1;
}

/* curve.samples{times = , points = [, closed = ]} */
static int l_samples(lua_State *L)
{
    static const char *const keys[] = {"times", "points", "closed", NULL};
    const quat_lua_reader reader = quat_lua_read(L, 1, "samples", NULL, keys);
    size_t n, count;
    quat_lua_need(&reader, "times");
    quat_lua_need(&reader, "points");
    lua_curve *const c = new_curve(L);
    const int place = lua_gettop(L);
    c->samples.closed = quat_lua_get_boolean(&reader, "closed", false);
    lua_getfield(L, 1, "times");
    c->samples.t = quat_lua_arg_numbers(L, lua_gettop(L), "times", 4, &n);
    lua_setiuservalue(L, place, 2);
    lua_getfield(L, 1, "points");
    c->samples.x = quat_lua_arg_vec3s(L, lua_gettop(L), "points", 4, &count);
    lua_setiuservalue(L, place, 3);
    if (count != n) return quat_lua_reader_error(&reader, "%d times but %d points", (int)n, (int)count);
    c->samples.n = n;
    const quat_status status = quat_curve_from_samples(&c->samples, &c->curve);
    if (status == QUAT_EARGUMENT) return quat_lua_reader_error(&reader, "times must increase");
    if (status != QUAT_OK)
        return quat_lua_reader_error(&reader, "the last point of a closed curve must be the first again");
    lua_pushvalue(L, place);
    return 1;
}

static double size(lua_State *L, int index, const char *name)
{
    return quat_lua_arg_number(L, index, name, QUAT_LUA_POSITIVE);
}

static int ellipse(lua_State *L, double a, double b)
{
    lua_curve *const c = new_curve(L);
    quat_ellipse(a, b, &c->family, &c->curve);
    return 1;
}

static int l_circle(lua_State *L)
{
    const double r = size(L, 1, "r");
    return ellipse(L, r, r);
}

static int l_ellipse(lua_State *L)
{
    const double a = size(L, 1, "a"), b = size(L, 2, "b");
    return ellipse(L, a, b);
}

static int l_helix(lua_State *L)
{
    const double r = size(L, 1, "r"), h = quat_lua_arg_number(L, 2, "h", QUAT_LUA_FINITE), turns = size(L, 3, "turns");
    lua_curve *const c = new_curve(L);
    quat_helix(r, h, turns, &c->family, &c->curve);
    return 1;
}

static int l_torus_knot(lua_State *L)
{
    const double R = size(L, 1, "R"), r = size(L, 2, "r");
    const int p = (int)quat_lua_arg_integer(L, 3, "p", 1, 1000), q = (int)quat_lua_arg_integer(L, 4, "q", 1, 1000);
    if (r >= R) return quat_lua_error(L, "argument 'r' must be less than R, got %g", r);
    lua_curve *const c = new_curve(L);
    if (quat_torus_knot(R, r, p, q, &c->family, &c->curve) != QUAT_OK)
        return quat_lua_error(L, "arguments 'p' and 'q' must have no common factor, got %d and %d", p, q);
    return 1;
}

static int l_trefoil(lua_State *L)
{
    const double a = size(L, 1, "a");
    lua_curve *const c = new_curve(L);
    quat_trefoil(a, &c->family, &c->curve);
    return 1;
}

static int l_viviani(lua_State *L)
{
    const double a = size(L, 1, "a");
    lua_curve *const c = new_curve(L);
    quat_viviani(a, &c->family, &c->curve);
    return 1;
}

static int l_cubic(lua_State *L)
{
    const double a = size(L, 1, "a");
    lua_curve *const c = new_curve(L);
    quat_cubic(a, lua_toboolean(L, 2), &c->family, &c->curve);
    return 1;
}

/* ---- asking ---- */

/* curve:range() -> start, end, closed */
static int l_range(lua_State *L)
{
    const lua_curve *const c = luaL_checkudata(L, 1, CURVE);
    lua_pushnumber(L, c->curve.start);
    lua_pushnumber(L, c->curve.end);
    lua_pushboolean(L, c->curve.closed);
    return 3;
}

/* curve:derivatives(t, order) -> {x, x', ...} */
static int l_derivatives(lua_State *L)
{
    quat_lua_call call;
    qvec3 d[4];
    const double t = quat_lua_arg_number(L, 2, "t", QUAT_LUA_FINITE);
    const int order = (int)quat_lua_arg_integer(L, 3, "order", 0, 3);
    const quat_curve curve = begin(L, &call);
    const quat_status status = quat_curve_derivatives(&curve, t, order, d, NULL);
    quat_lua_call_end(&call);
    quat_lua_push_vec3s(L, (size_t)order + 1, d);
    return quat_lua_results(L, status, 1);
}

static int l_at(lua_State *L)
{
    quat_lua_call call;
    quat_curve_point p;
    const double t = quat_lua_arg_number(L, 2, "t", QUAT_LUA_FINITE);
    const quat_curve curve = begin(L, &call);
    const quat_status status = quat_curve_at(&curve, t, &p);
    quat_lua_call_end(&call);
    lua_createtable(L, 0, 7);
    quat_lua_set_vec3(L, "position", p.position);
    quat_lua_set_number(L, "speed", p.speed);
    quat_lua_set_number(L, "curvature", p.curvature);
    quat_lua_set_number(L, "torsion", p.torsion);
    quat_lua_set_number(L, "curvature_error", p.curvature_error);
    quat_lua_set_number(L, "torsion_error", p.torsion_error);
    quat_lua_set_quat(L, "frame", p.frame);
    return quat_lua_results(L, status, 1);
}

/* curve:length([a [, b]]) */
static int l_length(lua_State *L)
{
    quat_lua_call call;
    const lua_curve *const c = luaL_checkudata(L, 1, CURVE);
    const double a = quat_lua_arg_number_or(L, 2, "a", QUAT_LUA_FINITE, c->curve.start),
                 b = quat_lua_arg_number_or(L, 3, "b", QUAT_LUA_FINITE, c->curve.end);
    double length;
    const quat_curve curve = begin(L, &call);
    const quat_status status = quat_curve_length(&curve, a, b, &length);
    quat_lua_call_end(&call);
    lua_pushnumber(L, length);
    return quat_lua_results(L, status, 1);
}

static int l_at_length(lua_State *L)
{
    quat_lua_call call;
    double t;
    const double length = quat_lua_arg_number(L, 2, "length", QUAT_LUA_FINITE);
    const quat_curve curve = begin(L, &call);
    const quat_status status = quat_curve_at_length(&curve, length, &t);
    quat_lua_call_end(&call);
    lua_pushnumber(L, t);
    return quat_lua_results(L, status, 1);
}

static int l_even(lua_State *L)
{
    quat_lua_call call;
    const size_t n = (size_t)quat_lua_arg_integer(L, 2, "n", 2, 1000000);
    double *const t = lua_newuserdatauv(L, n * sizeof *t, 0);
    const quat_curve curve = begin(L, &call);
    const quat_status status = quat_curve_even(&curve, n, t);
    quat_lua_call_end(&call);
    if (status >= 0) quat_lua_push_numbers(L, n, t);
    return quat_lua_results(L, status, 1);
}

static int l_total(lua_State *L)
{
    quat_lua_call call;
    quat_curve_totals totals;
    const quat_curve curve = begin(L, &call);
    const quat_status status = quat_curve_total(&curve, &totals);
    quat_lua_call_end(&call);
    lua_createtable(L, 0, 3);
    quat_lua_set_number(L, "length", totals.length);
    quat_lua_set_number(L, "curvature", totals.curvature);
    quat_lua_set_number(L, "torsion", totals.torsion);
    return quat_lua_results(L, status, 1);
}

/* curve:frames{n = | times = [, framing = , first = ]} -> quaternions, report */
static int l_frames(lua_State *L)
{
    static const char *const keys[] = {"n", "times", "framing", "first", NULL};
    static const char *const framings[] = {"frenet", "minimal", "closed", NULL};
    quat_lua_call call;
    quat_framing_report report;
    const quat_lua_reader reader = quat_lua_read(L, 2, "frames", NULL, keys);
    const int framing = quat_lua_get_choice(&reader, "framing", framings, QUAT_MINIMAL);
    const bool has_first = quat_lua_has(&reader, "first");
    const quat first = quat_lua_get_quat(&reader, "first", quat_identity());
    size_t n = (size_t)quat_lua_get_integer(&reader, "n", 2, 1000000, 101);
    const double *t = NULL;
    if (quat_lua_has(&reader, "times")) {
        lua_getfield(L, 2, "times");
        t = quat_lua_arg_numbers(L, lua_gettop(L), "times", 2, &n);
    }
    quat *const q = lua_newuserdatauv(L, n * sizeof *q, 0);
    const quat_curve curve = begin(L, &call);
    const quat_status status =
        quat_curve_frames(&curve, (quat_framing)framing, has_first ? &first : NULL, n, t, q, &report);
    quat_lua_call_end(&call);
    if (status == QUAT_EARGUMENT)
        return quat_lua_reader_error(
            &reader, framing == QUAT_CLOSED ? "closed frames need a closed curve, and times from its start to its end"
                                            : "times must increase, from start to finish");
    if (status < 0) return quat_lua_results(L, status, 0);
    quat_lua_push_quats(L, n, q);
    lua_createtable(L, 0, 3);
    quat_lua_set_number(L, "holonomy", report.holonomy);
    quat_lua_set_integer(L, "monodromy", report.monodromy);
    quat_lua_set_integer(L, "inflections", (lua_Integer)report.inflections);
    return quat_lua_results(L, status, 2);
}

void quat_lua_open_curve(lua_State *L)
{
    static const luaL_Reg methods[] = {{"range", l_range},   {"at", l_at},         {"derivatives", l_derivatives},
                                       {"length", l_length}, {"even", l_even},     {"at_length", l_at_length},
                                       {"total", l_total},   {"frames", l_frames}, {NULL, NULL}};
    static const luaL_Reg makers[] = {{"new", l_new},         {"samples", l_samples},
                                      {"ellipse", l_ellipse}, {"circle", l_circle},
                                      {"helix", l_helix},     {"torus_knot", l_torus_knot},
                                      {"trefoil", l_trefoil}, {"viviani", l_viviani},
                                      {"cubic", l_cubic},     {NULL, NULL}};
    luaL_newmetatable(L, CURVE);
    luaL_newlib(L, methods);
    lua_setfield(L, -2, "__index");
    lua_pop(L, 1);
    luaL_newlib(L, makers);
    lua_setfield(L, -2, "curve");
}
