/* SPDX-License-Identifier: MIT
 *
 * The nearest way out of a polytope for a cylinder or cone that shares a point with it. The ball about 0 that touches
 * the boundary of their difference D from inside does so where D has one normal, which is where the cones of normals of
 * the polytope's feature and of the other's, N_P(p) and N_T(x), have but a ray in common (of a sum of convex bodies
 * they intersect: Schneider 2014, theorem 2.2.1). So the highest g is at
 *
 *     a face's normal; the axis (a cap's);
 *     a vertex on the side: the highest of a sinusoid over the circle of the side's normals;
 *     an edge on the side or a rim: on the arc between the normals of the edge's faces;
 *
 * and never at a vertex on a rim or the apex, or at an edge on the apex. On the arc, with m the polytope's outward
 * normal, v a vertex of the edge, e its direction, a the axis, C the way from centre to centre, and the rims of radii
 * r_k at heights h_k (a cone's apex is one of radius 0),
 *
 *     g(m) = m.(C - v) + min_k f_k,    f_k = h_k z - r_k rho,    z = m.a,    rho = sqrt(1 - z^2).
 *
 * It is halved until each piece is known not to be above the bound B < 0, by one of two ways:
 *
 *   - a point w of D, the support point of its middle, has g(m) <= m.w, and w.m <= B at both ends: then it is so
 *     between them, as w.d - B |d| is convex in d;
 *   - with s = m.(C - v), s + f_k has s'' + f_k'' + s + f_k = -K, K = r_k (e.a)^2 / rho^3, along the arc: with K <= K1
 *     on the piece s + f_k + K1 is below the sinusoid through its values at the ends (Sturm), which is below B + K1.
 *
 * The second is what ends an edge along the axis, or the like, where g is the same all along.
 */
#include "base/tolerances.h"
#include "gap/gap_chart.h"
#include "gap/gap_solver.h"
#include "gap/gap_walk.h"
#include <string.h>

/* A piece is halved 2 log2(1e7) times before the first way clears it at any curvature. */
enum { MOST_PIECES = 2000, MOST_WAITING = 64 };

typedef struct way {
    const imp_core *core; /* the polytope's; all is in its axes */
    double a[3], C[3];    /* unit axis; centre of the other less the polytope's */
    double h[2], r[2];    /* its rims */
    double best, n[3];    /* the highest g met, and its m; or what was asked for */
    imp_walk_kind kind;   /* the polytope's feature there; a cap: of its normal, at the vertex of that index */
    int index;
    double bound, slack; /* what pieces are cleared by: the best and the slack */
    int pieces;
} way;

/* m on an arc, and what g is made of there. */
typedef struct spot {
    double m[3], across[3], s, z, rho; /* across: m's part across the axis, of length rho */
} spot;

typedef struct edge_arc {
    int index;
    double d[3], e[3]; /* from its first vertex to the other's centre, and to its second */
} edge_arc;

typedef struct piece {
    spot end[2];
    double w[3]; /* the point of D that all but cleared what it was cut from */
} piece;

static bool has_edges(const imp_form *form)
{
    return (form->kind == IMP_FORM_BOX || form->kind == IMP_FORM_POLYTOPE) && form->core.hull->edge_count > 0;
}

static int polytope_of(const imp_gap_solids *pair)
{
    for (int k = 0; k < 2; k++)
        if (has_edges(&pair->form[k]) && imp_of_revolution(&pair->form[1 - k])) return k;
    return -1;
}

bool imp_gap_has_arcs(const imp_gap_solids *pair) { return polytope_of(pair) >= 0; }

static way way_of(const imp_gap_solids *pair, int polytope)
{
    const imp_form *own = &pair->form[polytope], *turned = &pair->form[1 - polytope];
    const double axis[3] = {turned->rotation[0][2], turned->rotation[1][2], turned->rotation[2][2]};
    const bool cone = turned->kind == IMP_FORM_CONE;
    way w = {.core = &own->core,
             .h = {cone ? turned->base : -turned->axis[2], cone ? turned->base + turned->axis[2] : turned->axis[2]},
             .r = {turned->axis[0], cone ? 0 : turned->axis[0]}};
    imp_to_body(own->rotation, axis, w.a);
    imp_to_body(own->rotation, pair->c, w.C);
    for (int i = 0; polytope == 1 && i < 3; i++) w.C[i] = -w.C[i];
    return w;
}

static void raise_to(way *w, double g, const double m[3], imp_walk_kind kind, int index)
{
    if (!(g > w->best)) return;
    w->best = g, w->kind = kind, w->index = index;
    memcpy(w->n, m, sizeof w->n);
    w->bound = g + w->slack;
}

/* v's part across the axis, taken twice: of what is all but along it the first leaves rounding. Returns that along it.
 */
static double take_across(const way *w, const double v[3], double across[3])
{
    const double along = imp_dot(v, w->a);
    for (int i = 0; i < 3; i++) across[i] = v[i] - along * w->a[i];
    const double left = imp_dot(across, w->a);
    for (int i = 0; i < 3; i++) across[i] -= left * w->a[i];
    return along;
}

/* Of the unit m. */
static void lean(const way *w, spot *p)
{
    p->z = take_across(w, p->m, p->across);
    p->rho = imp_norm(p->across);
}

static double rim_height(const way *w, const spot *p, int k) { return w->h[k] * p->z - w->r[k] * p->rho; }

/* Of the rim that reaches farther against m. */
static int rim_at(const way *w, const spot *p) { return rim_height(w, p, 1) < rim_height(w, p, 0); }

/* g(m) where the polytope reaches as far as h along the unit m. */
static void look_along(way *w, const double m[3], double h, imp_walk_kind kind, int index)
{
    spot p = {.m = {m[0], m[1], m[2]}};
    lean(w, &p);
    raise_to(w, imp_dot(m, w->C) - h + rim_height(w, &p, rim_at(w, &p)), m, kind, index);
}

static void look_anywhere(way *w, const double m[3], imp_walk_kind kind)
{
    int vertex;
    const double h = imp_core_support(w->core, m, &vertex);
    look_along(w, m, h, kind, vertex);
}

/* The vertex on the side: z and rho are those of the side's normals. */
static void look_at_vertex(way *w, const double v[3], double z, double rho)
{
    const double from[3] = {w->C[0] - v[0], w->C[1] - v[1], w->C[2] - v[2]};
    double d[3], across[2][3], m[3];
    const double along = take_across(w, from, d);
    const double aside = imp_norm(d);
    if (!(z * (along + w->h[0]) + rho * (aside - w->r[0]) > w->best)) return;
    imp_across(w->a, across);
    for (int i = 0; i < 3; i++) m[i] = z * w->a[i] + rho * (aside > 0 ? d[i] / aside : across[0][i]);
    look_anywhere(w, m, IMP_ON_VERTEX);
}

static void look_at_vertices(way *w)
{
    const double rise = w->h[0] - w->h[1], fall = w->r[0] - w->r[1], length = hypot(rise, fall);
    for (int i = 0; i < w->core->hull->vertex_count; i++) {
        double v[3];
        imp_core_vertex(w->core, i, v);
        look_at_vertex(w, v, fall / (rise < 0 ? -length : length), fabs(rise) / length);
    }
}

static bool clears_piece(const piece *p, const double w[3], double bound)
{
    return imp_dot(w, p->end[0].m) <= bound && imp_dot(w, p->end[1].m) <= bound;
}

/* The highest of the sinusoid with values p and q a chord apart, between them. */
static double sinusoid_peak(double p, double q, double chord)
{
    const double square = chord * chord, less = 0.5 * square, most = fmax(p, q); /* less: 1 - cos */
    if (q - p + p * less <= 0 || p - q + q * less <= 0) return most;             /* it falls from one end on */
    return sqrt(((p - q) * (p - q) + 2 * p * q * less) / (square * (1 - 0.25 * square)));
}

/* No rho on the piece is less. On less than a quarter rho has no least one inside where from one end on it rises; else
 * m's part across is no less than that of the chord's point below it. */
static double least_rho(const piece *p)
{
    const spot *a = &p->end[0], *b = &p->end[1];
    const double cosine = imp_dot(a->m, b->m), both = imp_dot(a->across, b->across), least = fmin(a->rho, b->rho);
    if (cosine > 0 && both >= (1 - 2 * IMP_ROUNDOFF) * cosine * least * least) return least;
    double chord[3], nearest[3];
    for (int i = 0; i < 3; i++) chord[i] = b->across[i] - a->across[i];
    const double square = imp_dot(chord, chord), at = square > 0 ? -imp_dot(a->across, chord) / square : 0;
    for (int i = 0; i < 3; i++) nearest[i] = a->across[i] + fmin(fmax(at, 0), 1) * chord[i];
    return imp_norm(nearest);
}

/* The second way, by rim k, on the arc across e, where K is not far above the depth: above that g bends more than the
 * ball about 0 does, and the first way soon clears it. */
static bool bends_little(const way *w, const piece *p, const double e[3], int k)
{
    const double rho = least_rho(p), along = imp_dot(e, w->a);
    const double most = w->r[k] * along * along / (imp_dot(e, e) * rho * rho * rho);
    double chord[3];
    if (!(most <= -IMP_GAP_BENDS * w->bound)) return false;
    for (int i = 0; i < 3; i++) chord[i] = p->end[0].m[i] - p->end[1].m[i];
    return sinusoid_peak(p->end[0].s + rim_height(w, &p->end[0], k) + most,
                         p->end[1].s + rim_height(w, &p->end[1], k) + most, imp_norm(chord)) <= w->bound + most;
}

/* The piece's middle, the point of D it has, and its rim. */
static int halfway(const way *w, const double d[3], const piece *p, spot *mid, double point[3])
{
    for (int i = 0; i < 3; i++) mid->m[i] = p->end[0].m[i] + p->end[1].m[i];
    const double length = imp_norm(mid->m);
    for (int i = 0; i < 3; i++) mid->m[i] /= length;
    mid->s = imp_dot(mid->m, d);
    lean(w, mid);
    const int rim = rim_at(w, mid);
    const double out = mid->rho > 0 ? w->r[rim] / mid->rho : 0;
    for (int i = 0; i < 3; i++) point[i] = d[i] + w->h[rim] * w->a[i] - out * mid->across[i];
    return rim;
}

/* All normals between the two on the edge's arc: false when there were too many pieces. */
static bool look_along_arc(way *w, const edge_arc *edge, const double from[3], const double to[3])
{
    piece waiting[MOST_WAITING] = {{.end = {{.m = {from[0], from[1], from[2]}}, {.m = {to[0], to[1], to[2]}}}}};
    for (int k = 0; k < 2; k++) {
        waiting[0].end[k].s = imp_dot(waiting[0].end[k].m, edge->d);
        lean(w, &waiting[0].end[k]);
    }
    for (int count = 1; count > 0;) {
        piece *top = &waiting[count - 1];
        if (++w->pieces > MOST_PIECES || count == MOST_WAITING) return false;
        if (clears_piece(top, top->w, w->bound)) {
            count--;
            continue;
        }
        spot mid;
        const int rim = halfway(w, edge->d, top, &mid, top->w);
        raise_to(w, mid.s + rim_height(w, &mid, rim), mid.m, IMP_ON_EDGE, edge->index);
        if (clears_piece(top, top->w, w->bound) || bends_little(w, top, edge->e, rim)) {
            count--;
            continue;
        }
        waiting[count] = *top;
        top->end[1] = mid, waiting[count++].end[0] = mid;
    }
    return true;
}

/* Of a segment's edge, which has no faces beside it, all that is across it: four quarters. */
static bool look_around(way *w, const edge_arc *edge)
{
    double t[2][3], unit[3];
    const double length = imp_norm(edge->e);
    for (int i = 0; i < 3; i++) unit[i] = edge->e[i] / length;
    imp_across(unit, t);
    for (int quarter = 0; quarter < 4; quarter++) {
        double end[2][3];
        for (int k = 0; k < 2; k++) {
            const int turn = (quarter + k) % 4;
            for (int i = 0; i < 3; i++) end[k][i] = turn < 2 ? t[turn][i] : -t[turn - 2][i];
        }
        if (!look_along_arc(w, edge, end[0], end[1])) return false;
    }
    return true;
}

static edge_arc edge_of(const way *w, int index)
{
    const short *v = w->core->hull->edge[index].v;
    edge_arc edge = {.index = index};
    double from[3], to[3];
    imp_core_vertex(w->core, v[0], from);
    imp_core_vertex(w->core, v[1], to);
    for (int i = 0; i < 3; i++) edge.d[i] = w->C[i] - from[i], edge.e[i] = to[i] - from[i];
    return edge;
}

static bool look_at_edges(way *w, const double (*normal)[3])
{
    const impact_hull *hull = w->core->hull;
    for (int i = 0; i < hull->edge_count; i++) {
        const short *f = hull->edge[i].f;
        const edge_arc edge = edge_of(w, i);
        if (f[0] < 0 ? !look_around(w, &edge) : !look_along_arc(w, &edge, normal[f[0]], normal[f[1]])) return false;
    }
    return true;
}

/* Normals of faces, and of the other's caps. */
static void look_along_normals(way *w, double (*normal)[3])
{
    const double back[3] = {-w->a[0], -w->a[1], -w->a[2]};
    for (int f = 0; f < w->core->hull->face_count; f++) {
        imp_core_normal(w->core, f, normal[f]);
        look_along(w, normal[f], imp_core_height(w->core, f, normal[f]), IMP_ON_FACE, f);
    }
    look_anywhere(w, w->a, IMP_ON_CAP);
    look_anywhere(w, back, IMP_ON_CAP);
}

/* The other body's rims (a cone's apex) along the best normal, from the polytope's centre; of the two the part of the
 * way from the first to the second that reaches farther; whether both do. */
static bool reach_rims(const way *w, double rim[2][3], double *part)
{
    spot p = {.m = {w->n[0], w->n[1], w->n[2]}};
    lean(w, &p);
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < 3; i++)
            rim[k][i] = w->C[i] + w->h[k] * w->a[i] - (p.rho > 0 ? w->r[k] / p.rho : 0) * p.across[i];
    *part = rim_at(w, &p);
    return fabs(rim_height(w, &p, 1) - rim_height(w, &p, 0)) <= IMP_WALK_START * fabs(w->h[1] - w->h[0]);
}

/* The part of the way from rim to rim at which, seen along the normal, it crosses the edge. */
static double cross_edge(const edge_arc *edge, const double from[3], const double line[3], double part)
{
    const double cross = imp_dot(line, edge->e), square = imp_dot(edge->e, edge->e),
                 det = imp_dot(line, line) * square - cross * cross;
    return det > 0 ? (cross * imp_dot(from, edge->e) - square * imp_dot(from, line)) / det : part;
}

/* What of the polytope's and of the other's meet along the best normal, and where, both from the polytope's centre. */
typedef struct meeting_place {
    imp_walk_kind kind[2];
    int index[2];
    double x[2][3];
} meeting_place;

/* The polytope's vertex is on the other's side, or on its cap, which it may miss where an edge or face lies along it.
 */
static bool meet_vertex(const way *w, meeting_place *p)
{
    double from[3], across[3];
    imp_core_vertex(w->core, w->index, p->x[0]);
    for (int i = 0; i < 3; i++) p->x[1][i] = p->x[0][i] + w->best * w->n[i], from[i] = p->x[1][i] - w->C[i];
    p->kind[0] = IMP_ON_VERTEX, p->index[0] = w->index;
    p->kind[1] = w->kind == IMP_ON_CAP ? IMP_ON_CAP : IMP_ON_SIDE;
    p->index[1] = w->kind == IMP_ON_CAP && imp_dot(w->n, w->a) < 0;
    take_across(w, from, across);
    return w->kind == IMP_ON_VERTEX || imp_norm(across) <= w->r[p->index[1]];
}

static void meet_edge(const way *w, const double rim[2][3], bool side, double part, meeting_place *p)
{
    const edge_arc edge = edge_of(w, w->index);
    double vertex[3], from[3], line[3];
    for (int i = 0; i < 3; i++)
        vertex[i] = w->C[i] - edge.d[i], from[i] = rim[0][i] - vertex[i], line[i] = rim[1][i] - rim[0][i];
    if (side) part = cross_edge(&edge, from, line, part);
    for (int i = 0; i < 3; i++) from[i] += fmin(fmax(part, 0), 1) * line[i];
    const double at = imp_dot(from, edge.e) / imp_dot(edge.e, edge.e);
    for (int i = 0; i < 3; i++) p->x[1][i] = vertex[i] + from[i], p->x[0][i] = vertex[i] + at * edge.e[i];
    p->index[1] = part > 0;
    if (part > 0 && part < 1) p->kind[1] = IMP_ON_SIDE, p->index[1] = 0;
}

/* False: it is not known, as where a side or cap lies on a face. */
static bool meet(const way *w, meeting_place *p)
{
    double rim[2][3], part;
    if (w->kind == IMP_ON_VERTEX || w->kind == IMP_ON_CAP) return meet_vertex(w, p);
    const bool side = reach_rims(w, rim, &part);
    *p = (meeting_place){.kind = {w->kind, IMP_ON_RIM}, .index = {w->index, part > 0}};
    if (w->kind == IMP_ON_EDGE) meet_edge(w, (const double(*)[3])rim, side, part, p);
    for (int i = 0; i < 3 && w->kind == IMP_ON_FACE; i++)
        p->x[1][i] = rim[p->index[1]][i], p->x[0][i] = p->x[1][i] - w->best * w->n[i];
    if (p->kind[1] == IMP_ON_RIM && w->r[p->index[1]] == 0) p->kind[1] = IMP_ON_VERTEX, p->index[1] = 0;
    return w->kind == IMP_ON_EDGE || !side;
}

static bool put_on_features(const way *w, const imp_gap_solids *pair, int polytope, imp_surface at[2])
{
    const imp_form *own = &pair->form[polytope], *turned = &pair->form[1 - polytope];
    meeting_place p;
    double y[3], m[3], world[3], back[3];
    if (!meet(w, &p)) return false;
    imp_walk_put(own, p.kind[0], p.index[0], p.x[0], w->n, &at[polytope]);
    for (int i = 0; i < 3; i++) back[i] = -w->n[i], p.x[1][i] -= w->C[i];
    imp_to_world(own->rotation, back, world);
    imp_to_body(turned->rotation, world, m);
    imp_to_world(own->rotation, p.x[1], world);
    imp_to_body(turned->rotation, world, y);
    imp_walk_put(turned, p.kind[1], p.index[1], y, m, &at[1 - polytope]);
    return true;
}

bool imp_gap_highest_by_arcs(const imp_gap_solids *pair, double slack, double gap, imp_way_out *way_out)
{
    const int polytope = polytope_of(pair);
    way w = way_of(pair, polytope);
    double normal[2 * IMPACT_HULL_POINTS][3];
    w.slack = slack, w.best = w.bound = gap + slack;
    look_along_normals(&w, normal);
    look_at_vertices(&w);
    way_out->all = w.bound < 0 && look_at_edges(&w, (const double(*)[3])normal) && w.bound < 0;
    if (!(w.best > gap + slack)) return false;
    way_out->gap = w.best;
    way_out->placed = put_on_features(&w, pair, polytope, way_out->at);
    imp_to_world(pair->form[polytope].rotation, w.n, way_out->n);
    for (int i = 0; polytope == 1 && i < 3; i++) way_out->n[i] = -way_out->n[i];
    return true;
}
