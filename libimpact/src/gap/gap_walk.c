/* SPDX-License-Identifier: MIT */
#include "gap/gap_walk.h"
#include "base/tolerances.h"
#include "gap/gap_chart.h"
#include <string.h>

static double size_of_form(const imp_form *form) { return fmax(form->axis[0], fmax(form->axis[1], form->axis[2])); }

static void put_on(imp_surface *s, imp_walk_kind kind, int index) { s->kind = (short)kind, s->index = (short)index; }

static void make_unit(double v[3])
{
    const double length = imp_norm(v);
    for (int k = 0; k < 3; k++) v[k] /= length;
}

/* ---- polytopes ---- */

static void edge_ends(const imp_core *core, int edge, double a[3], double b[3])
{
    imp_core_vertex(core, core->hull->edge[edge].v[0], a);
    imp_core_vertex(core, core->hull->edge[edge].v[1], b);
}

/* Its direction, unit, and across it and the normal. */
static void edge_frame(const imp_form *form, const imp_surface *s, double along[3], double across[3])
{
    double a[3], b[3];
    edge_ends(&form->core, s->index, a, b);
    for (int k = 0; k < 3; k++) along[k] = b[k] - a[k];
    make_unit(along);
    imp_cross(along, s->e, across);
}

/* The part of the step at which the point leaves the face, and through which edge; 1: it does not. */
static double leave_face(const imp_core *core, int face, const double x[3], const double d[3], int *edge)
{
    const impact_hull *hull = core->hull;
    double n[3], a[3], b[3], part = 1;
    imp_core_normal(core, face, n);
    for (int i = 0; i < hull->edge_count; i++) {
        const imp_hull_edge *e = &hull->edge[i];
        if (e->f[0] != face && e->f[1] != face) continue;
        double out[3], along[3], from[3];
        edge_ends(core, i, a, b);
        for (int k = 0; k < 3; k++) along[k] = e->f[0] == face ? b[k] - a[k] : a[k] - b[k], from[k] = x[k] - a[k];
        imp_cross(along, n, out);
        const double speed = imp_dot(out, d), room = fmax(0, -imp_dot(out, from));
        if (speed > 0 && room < part * speed) part = room / speed, *edge = i;
    }
    return part;
}

static void move_on_face(const imp_form *form, const double step[2], imp_surface *s)
{
    double t[2][3], d[3];
    int edge = -1;
    const double size = size_of_form(form);
    imp_across(s->e, t);
    for (int k = 0; k < 3; k++) d[k] = size * (step[0] * t[0][k] + step[1] * t[1][k]);
    const double part = leave_face(&form->core, s->index, s->u, d, &edge);
    for (int k = 0; k < 3; k++) s->u[k] += part * d[k];
    if (edge >= 0) put_on(s, IMP_ON_EDGE, edge);
}

/* The part of the turn from e to m at which the normal leaves the arc of the edge, and to which face. */
static double leave_arc(const imp_form *form, const imp_surface *s, const double along[3], const double m[3], int *face)
{
    const imp_hull_edge *edge = &form->core.hull->edge[s->index];
    double part = 1;
    for (int side = 0; side < 2 && edge->f[0] >= 0; side++) {
        double n[3], across[3];
        imp_core_normal(&form->core, edge->f[side], n);
        imp_cross(along, n, across); /* away from the edge, in the face; f[0] is on its left */
        const double sign = side ? 1 : -1;
        const double here = sign * imp_dot(across, s->e), there = sign * imp_dot(across, m);
        /* beyond the face's normal where it leans to the face's own side */
        if (there > 0 && there > here && -here < part * (there - here))
            part = fmax(0, -here / (there - here)), *face = edge->f[side];
    }
    return part;
}

static void move_on_edge(const imp_form *form, const double step[2], imp_surface *s)
{
    double a[3], b[3], along[3], across[3], m[3];
    const impact_hull *hull = form->core.hull;
    const imp_hull_edge edge = hull->edge[s->index];
    edge_ends(&form->core, s->index, a, b);
    edge_frame(form, s, along, across);
    double length = 0, at = 0, part = 1;
    for (int k = 0; k < 3; k++) length += along[k] * (b[k] - a[k]), at += along[k] * (s->u[k] - a[k]);
    at = fmax(0, fmin(length, at));
    const double way = size_of_form(form) * step[0];
    int face = -1, end = -1;
    if (at + way > length) part = fmax(0, (length - at) / way), end = edge.v[1];
    if (at + way < 0) part = fmax(0, -at / way), end = edge.v[0];
    for (int k = 0; k < 3; k++) m[k] = s->e[k] + step[1] * across[k];
    make_unit(m);
    const double turn = leave_arc(form, s, along, m, &face);
    if (turn < part)
        part = turn, end = -1;
    else if (end >= 0)
        face = -1;
    for (int k = 0; k < 3; k++) {
        s->u[k] = a[k] + fmax(0, fmin(length, at + part * way)) * along[k];
        s->e[k] += part * step[1] * across[k];
    }
    make_unit(s->e);
    if (face >= 0) {
        imp_core_normal(&form->core, face, s->e);
        put_on(s, IMP_ON_FACE, face);
    } else if (end >= 0) {
        imp_core_vertex(&form->core, end, s->u);
        put_on(s, IMP_ON_VERTEX, end);
    }
}

static void move_on_vertex(const imp_form *form, const double step[2], imp_surface *s)
{
    const impact_hull *hull = form->core.hull;
    double t[2][3], d[3], part = 1, leaving[3] = {0, 0, 0};
    int edge = -1;
    imp_across(s->e, t);
    for (int k = 0; k < 3; k++) d[k] = step[0] * t[0][k] + step[1] * t[1][k];
    for (int i = 0; i < hull->edge_count; i++) {
        const short *v = hull->edge[i].v;
        if (v[0] != s->index && v[1] != s->index) continue;
        double a[3], b[3], away[3];
        edge_ends(&form->core, i, a, b);
        for (int k = 0; k < 3; k++) away[k] = v[0] == s->index ? b[k] - a[k] : a[k] - b[k];
        const double speed = imp_dot(away, d), room = fmax(0, -imp_dot(away, s->e));
        if (speed > 0 && room < part * speed) part = room / speed, edge = i, memcpy(leaving, away, sizeof away);
    }
    for (int k = 0; k < 3; k++) s->e[k] += part * d[k];
    if (edge >= 0) { /* on the edge's circle */
        const double off = imp_dot(s->e, leaving) / imp_dot(leaving, leaving);
        for (int k = 0; k < 3; k++) s->e[k] -= off * leaving[k];
        put_on(s, IMP_ON_EDGE, edge);
    }
    make_unit(s->e);
}

/* Faces on which x lies but for slack: how many, the first two. */
static int faces_at(const imp_core *core, const double x[3], double slack, int found[2])
{
    int count = 0;
    for (int f = 0; f < core->hull->face_count; f++) {
        double n[3];
        imp_core_normal(core, f, n);
        if (imp_core_height(core, f, n) - imp_dot(n, x) > slack) continue;
        if (count < 2) found[count] = f;
        count++;
    }
    return count;
}

static int edge_of_faces(const impact_hull *hull, const int f[2])
{
    for (int i = 0; i < hull->edge_count; i++) {
        const short *g = hull->edge[i].f;
        if ((g[0] == f[0] && g[1] == f[1]) || (g[0] == f[1] && g[1] == f[0])) return i;
    }
    return -1;
}

/* Within a segment, which has no faces; the normal is there already. */
static void start_within_segment(const imp_form *form, const double x[3], imp_surface *s)
{
    double a[3], b[3], along[3], from[3];
    edge_ends(&form->core, 0, a, b);
    for (int k = 0; k < 3; k++) along[k] = b[k] - a[k], from[k] = x[k] - a[k];
    const double square = imp_dot(along, along), at = imp_dot(from, along) / square,
                 off = imp_dot(s->e, along) / square;
    if (!(at > IMP_WALK_START && at < 1 - IMP_WALK_START)) return;
    double across[3];
    for (int k = 0; k < 3; k++) across[k] = s->e[k] - off * along[k];
    if (!(imp_norm(across) > IMP_WALK_START)) return; /* a normal along it is an end's */
    for (int k = 0; k < 3; k++) s->u[k] = a[k] + at * along[k], s->e[k] = across[k];
    make_unit(s->e);
    put_on(s, IMP_ON_EDGE, 0);
}

static void start_at_point(const imp_form *form, const double x[3], imp_surface *s)
{
    if (form->core.hull->face_count == 0) {
        if (form->core.hull->edge_count > 0) start_within_segment(form, x, s);
        return;
    }
    int found[2] = {-1, -1};
    const int count = faces_at(&form->core, x, IMP_WALK_START * size_of_form(form), found);
    const int edge = count == 2 ? edge_of_faces(form->core.hull, found) : -1;
    if (count == 1) {
        memcpy(s->u, x, 3 * sizeof *x);
        imp_core_normal(&form->core, found[0], s->e);
        const double off = imp_core_height(&form->core, found[0], s->e) - imp_dot(s->e, x);
        for (int k = 0; k < 3; k++) s->u[k] += off * s->e[k];
        put_on(s, IMP_ON_FACE, found[0]);
    } else if (edge >= 0) {
        double n[3], m[3], along[3], across[3], a[3], b[3];
        imp_core_normal(&form->core, found[0], n);
        imp_core_normal(&form->core, found[1], m);
        for (int k = 0; k < 3; k++) s->e[k] = n[k] + m[k];
        make_unit(s->e);
        put_on(s, IMP_ON_EDGE, edge);
        edge_frame(form, s, along, across);
        edge_ends(&form->core, edge, a, b);
        double at = 0;
        for (int k = 0; k < 3; k++) at += along[k] * (x[k] - a[k]);
        for (int k = 0; k < 3; k++) s->u[k] = a[k] + at * along[k];
    }
}

/* ---- cylinders and cones ---- */

/* Cosine and sine of the slope of the side's normal, and its length. */
static void side_slope(const imp_form *form, double *cosine, double *sine, double *length)
{
    *length = form->kind == IMP_FORM_CONE ? hypot(form->axis[0], form->axis[2]) : 2 * form->axis[2];
    *cosine = form->kind == IMP_FORM_CONE ? form->axis[2] / *length : 1;
    *sine = form->kind == IMP_FORM_CONE ? form->axis[0] / *length : 0;
}

static double cap_height(const imp_form *form, int cap)
{
    return form->kind == IMP_FORM_CONE ? form->base : cap ? form->axis[2] : -form->axis[2];
}

/* Outward across the axis at the point, or where that is on the axis along the normal. */
static void outward(const imp_surface *s, double u[3])
{
    double length = hypot(s->u[0], s->u[1]);
    const double *v = length > 0 ? s->u : s->e;
    length = hypot(v[0], v[1]);
    u[0] = length > 0 ? v[0] / length : 1, u[1] = length > 0 ? v[1] / length : 0, u[2] = 0;
}

/* A point at the angle that step adds to that of u. */
static void go_around(const double u[3], double step, double v[3])
{
    const double c = cos(step), s = sin(step);
    v[0] = c * u[0] - s * u[1], v[1] = s * u[0] + c * u[1], v[2] = 0;
}

static void place_on_rim(const imp_form *form, const double u[3], double cosine, double sine, int cap, imp_surface *s)
{
    for (int k = 0; k < 2; k++) s->u[k] = form->axis[0] * u[k], s->e[k] = cosine * u[k];
    s->u[2] = cap_height(form, cap), s->e[2] = sine;
    put_on(s, IMP_ON_RIM, cap);
}

static void place_on_side(const imp_form *form, const double u[3], double z, imp_surface *s)
{
    double cosine, sine, length;
    side_slope(form, &cosine, &sine, &length);
    const double radius =
        form->kind == IMP_FORM_CONE ? form->axis[0] * (form->base + form->axis[2] - z) / form->axis[2] : form->axis[0];
    for (int k = 0; k < 2; k++) s->u[k] = radius * u[k], s->e[k] = cosine * u[k];
    s->u[2] = z, s->e[2] = sine;
    put_on(s, IMP_ON_SIDE, 0);
}

static void place_on_cap(const imp_form *form, double x, double y, int cap, imp_surface *s)
{
    s->u[0] = x, s->u[1] = y, s->u[2] = cap_height(form, cap);
    s->e[0] = s->e[1] = 0, s->e[2] = cap ? 1 : -1;
    put_on(s, IMP_ON_CAP, cap);
}

static void place_on_apex(const imp_form *form, const double n[3], imp_surface *s)
{
    s->u[0] = s->u[1] = 0, s->u[2] = form->base + form->axis[2];
    memcpy(s->e, n, 3 * sizeof *n);
    put_on(s, IMP_ON_VERTEX, 0);
}

static void move_on_cap(const imp_form *form, const double step[2], imp_surface *s)
{
    const double size = size_of_form(form), sign = s->e[2];
    const double dx = size * step[0], dy = sign * size * step[1], x = s->u[0], y = s->u[1], R = form->axis[0];
    const double dd = dx * dx + dy * dy, xd = x * dx + y * dy, room = fmax(0, R * R - x * x - y * y);
    if ((x + dx) * (x + dx) + (y + dy) * (y + dy) <= R * R) {
        s->u[0] = x + dx, s->u[1] = y + dy;
        return;
    }
    const double part = room / (xd + sqrt(xd * xd + dd * room)); /* where it meets the rim */
    const double u[3] = {(x + part * dx) / R, (y + part * dy) / R, 0};
    double unit[3] = {u[0], u[1], 0};
    make_unit(unit);
    place_on_rim(form, unit, 0, sign, s->index, s);
}

static void move_on_rim(const imp_form *form, const double step[2], imp_surface *s)
{
    double u[3], v[3], cosine, sine, length;
    const int cap = s->index;
    outward(s, u);
    side_slope(form, &cosine, &sine, &length);
    const double up = cap ? 1 : -1, phi = atan2(s->e[2], u[0] * s->e[0] + u[1] * s->e[1]) + step[1];
    const double side = up * atan2(sine, cosine), quarter = 1.5707963267948966;
    go_around(u, step[0], v);
    if (up * phi >= quarter)
        place_on_cap(form, form->axis[0] * v[0], form->axis[0] * v[1], cap, s);
    else if (up * phi <= side)
        place_on_side(form, v, cap_height(form, cap), s);
    else
        place_on_rim(form, v, cos(phi), sin(phi), cap, s);
}

static void move_on_side(const imp_form *form, const double step[2], imp_surface *s)
{
    double u[3], v[3], cosine, sine, length;
    side_slope(form, &cosine, &sine, &length);
    outward(s, u);
    go_around(u, step[1], v);
    const double low = form->kind == IMP_FORM_CONE ? form->base : -form->axis[2],
                 high = form->kind == IMP_FORM_CONE ? form->base + form->axis[2] : form->axis[2];
    const double z = s->u[2] + size_of_form(form) * cosine * step[0];
    const double n[3] = {cosine * v[0], cosine * v[1], sine};
    if (z < low)
        place_on_rim(form, v, cosine, sine, 0, s);
    else if (z > high && form->kind == IMP_FORM_CONE)
        place_on_apex(form, n, s);
    else if (z > high)
        place_on_rim(form, v, cosine, sine, 1, s);
    else
        place_on_side(form, v, z, s);
}

static void move_on_apex(const imp_form *form, const double step[2], imp_surface *s)
{
    double t[2][3], cosine, sine, length, n[3];
    side_slope(form, &cosine, &sine, &length);
    imp_across(s->e, t);
    for (int k = 0; k < 3; k++) n[k] = s->e[k] + step[0] * t[0][k] + step[1] * t[1][k];
    make_unit(n);
    if (n[2] >= sine) {
        place_on_apex(form, n, s);
        return;
    }
    const double across = hypot(n[0], n[1]), u[3] = {across > 0 ? n[0] / across : 1, across > 0 ? n[1] / across : 0, 0};
    place_on_side(form, u, form->base + form->axis[2], s);
}

/* By the normal alone: a rim or the apex, which all else borders on. */
static void start_turned(const imp_form *form, const double d[3], imp_surface *s)
{
    double cosine, sine, length, n[3] = {d[0], d[1], d[2]};
    side_slope(form, &cosine, &sine, &length);
    make_unit(n);
    const double across = hypot(n[0], n[1]), u[3] = {across > 0 ? n[0] / across : 1, across > 0 ? n[1] / across : 0, 0};
    if (form->kind == IMP_FORM_CONE && n[2] > sine)
        place_on_apex(form, n, s);
    else if (across == 0)
        place_on_cap(form, 0, 0, n[2] > 0, s);
    else
        place_on_rim(form, u, across, n[2], form->kind == IMP_FORM_CYLINDER && n[2] > 0, s);
}

static void start_turned_at(const imp_form *form, const double x[3], imp_surface *s)
{
    const double slack = IMP_WALK_START * size_of_form(form), rho = hypot(x[0], x[1]), R = form->axis[0];
    const bool cone = form->kind == IMP_FORM_CONE;
    const double high = cone ? form->base + form->axis[2] : form->axis[2], low = cap_height(form, 0);
    const double u[3] = {rho > 0 ? x[0] / rho : 1, rho > 0 ? x[1] / rho : 0, 0};
    if (rho < R - slack && x[2] - low <= slack)
        place_on_cap(form, x[0], x[1], 0, s);
    else if (rho < R - slack && !cone && high - x[2] <= slack)
        place_on_cap(form, x[0], x[1], 1, s);
    else if (x[2] > low + slack && x[2] < high - slack)
        place_on_side(form, u, x[2], s);
}

/* ---- all ---- */

void imp_walk_start(const imp_form *form, const double d[3], const double *x, imp_surface *s)
{
    if (imp_of_revolution(form)) {
        start_turned(form, d, s);
        if (x) start_turned_at(form, x, s);
        return;
    }
    int vertex;
    imp_core_support(&form->core, d, &vertex);
    imp_core_vertex(&form->core, vertex, s->u);
    memcpy(s->e, d, 3 * sizeof *d);
    make_unit(s->e);
    put_on(s, IMP_ON_VERTEX, vertex);
    if (x) start_at_point(form, x, s);
}

void imp_walk_put(const imp_form *form, imp_walk_kind kind, int index, const double x[3], const double m[3],
                  imp_surface *s)
{
    const double across = hypot(m[0], m[1]), u[3] = {across > 0 ? m[0] / across : 1, across > 0 ? m[1] / across : 0, 0};
    if (kind == IMP_ON_RIM) {
        place_on_rim(form, u, across, m[2], index, s);
    } else if (kind == IMP_ON_SIDE) {
        place_on_side(form, u, x[2], s);
    } else if (kind == IMP_ON_CAP) {
        place_on_cap(form, x[0], x[1], index, s);
    } else {
        memcpy(s->u, x, 3 * sizeof *x);
        memcpy(s->e, m, 3 * sizeof *m);
        put_on(s, kind, index);
    }
}

static void chart_of_turned(const imp_form *form, const imp_surface *s, double P[2][3], double Q[2][3])
{
    double u[3], cosine, sine, length;
    const double size = size_of_form(form);
    outward(s, u);
    side_slope(form, &cosine, &sine, &length);
    const double around[3] = {-u[1], u[0], 0}, rho = hypot(s->u[0], s->u[1]);
    if (s->kind == IMP_ON_CAP) {
        P[0][0] = size, P[1][1] = s->e[2] * size;
        return;
    }
    const double out = u[0] * s->e[0] + u[1] * s->e[1];
    for (int k = 0; k < 3; k++) {
        if (s->kind == IMP_ON_RIM) {
            P[0][k] = rho * around[k], Q[0][k] = out * around[k];
            Q[1][k] = k == 2 ? out : -s->e[2] * u[k];
        } else {
            P[0][k] = size * (k == 2 ? cosine : -sine * u[k]);
            P[1][k] = rho * around[k], Q[1][k] = cosine * around[k];
        }
    }
}

void imp_walk_chart(const imp_form *form, const imp_surface *s, double P[2][3], double Q[2][3])
{
    double t[2][3], along[3], across[3];
    const double size = size_of_form(form);
    memset(P, 0, 2 * sizeof P[0]);
    memset(Q, 0, 2 * sizeof Q[0]);
    switch ((imp_walk_kind)s->kind) {
    case IMP_ON_VERTEX: imp_across(s->e, Q); return;
    case IMP_ON_FACE:
        imp_across(s->e, t);
        for (int j = 0; j < 2; j++)
            for (int k = 0; k < 3; k++) P[j][k] = size * t[j][k];
        return;
    case IMP_ON_EDGE:
        edge_frame(form, s, along, across);
        for (int k = 0; k < 3; k++) P[0][k] = size * along[k], Q[1][k] = across[k];
        return;
    default: chart_of_turned(form, s, P, Q);
    }
}

void imp_walk_move(const imp_form *form, const double step[2], imp_surface *s)
{
    switch ((imp_walk_kind)s->kind) {
    case IMP_ON_VERTEX: (imp_of_revolution(form) ? move_on_apex : move_on_vertex)(form, step, s); break;
    case IMP_ON_EDGE: move_on_edge(form, step, s); break;
    case IMP_ON_FACE: move_on_face(form, step, s); break;
    case IMP_ON_CAP: move_on_cap(form, step, s); break;
    case IMP_ON_SIDE: move_on_side(form, step, s); break;
    case IMP_ON_RIM: move_on_rim(form, step, s); break;
    }
}

/* On a cap the ball is held by the side and the other cap, on the side by the axis and both caps. */
static double radius_in_cylinder(const imp_form *form, const double x[3])
{
    const double slack = IMP_WALK_START * size_of_form(form), in = form->axis[0] - hypot(x[0], x[1]),
                 under = form->axis[2] - fabs(x[2]);
    if (in > slack && under <= slack) return fmin(in, form->axis[2]);
    return in <= slack && under > slack ? fmin(form->axis[0], under) : 0;
}

/* On a face n the ball of radius r about x - r n is off another face m by d + r (n.m - 1), d that of x. */
double imp_walk_inner_radius(const imp_form *form, const double x[3])
{
    const imp_core *core = &form->core;
    const double slack = IMP_WALK_START * size_of_form(form);
    double radius = INFINITY, n[3], m[3];
    int found[2];
    if (form->kind == IMP_FORM_CYLINDER) return radius_in_cylinder(form, x);
    if (form->kind == IMP_FORM_CONE || faces_at(core, x, slack, found) != 1) return 0;
    imp_core_normal(core, found[0], n);
    for (int f = 0; f < core->hull->face_count; f++) {
        if (f == found[0]) continue;
        imp_core_normal(core, f, m);
        const double away = imp_core_height(core, f, m) - imp_dot(m, x);
        radius = fmin(radius, away / (1 - imp_dot(n, m)));
    }
    return radius;
}
