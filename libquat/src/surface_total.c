/* SPDX-License-Identifier: MIT */
#include "surface.h"

#include <stdlib.h>
#include <gsl/gsl_integration.h>

enum { most = 64, points = 10 };

/* Nodes and weights of n <= most points across 0 ... 1. */
typedef struct rule {
    size_t n;
    double node[most], weight[most];
} rule;

static void even_rule(size_t n, rule *r)
{
    r->n = n;
    for (size_t i = 0; i < n; i++) {
        r->node[i] = ((double)i + 0.5) / (double)n;
        r->weight[i] = 1 / (double)n;
    }
}

static quat_status gauss_rule(size_t n, rule *r)
{
    void *const probe = malloc(4096); /* GSL's own memory, which it must not lack: its handler would end the program */
    if (!probe) return QUAT_ENOMEM;
    free(probe);
    gsl_integration_glfixed_table *const table = gsl_integration_glfixed_table_alloc(n); /* n is one it holds */
    if (!table) return QUAT_ENOMEM;
    r->n = n;
    for (size_t i = 0; i < n; i++) gsl_integration_glfixed_point(0, 1, i, &r->node[i], &r->weight[i], table);
    gsl_integration_glfixed_table_free(table);
    return QUAT_OK;
}

static void add(quat_surface_totals *to, const quat_surface_totals *t)
{
    to->area += t->area;
    to->gauss += t->gauss;
    to->mean += t->mean;
    to->bending += t->bending;
}

/* What a point's curvatures may err by, times its piece of area: of those from differences of x alone all of their
 * estimate, which is wide; of others, when they cannot be relied on at all, themselves. The area can. */
static void doubt(const quat_surface *s, quat_status status, const quat_surface_point *p, double piece,
                  quat_surface_totals *to)
{
    const quat_curvature *const c = &p->curvature;
    const double size = fabs(c->principal[0]) + fabs(c->principal[1]), error = status == QUAT_NOT_CONVERGED
                                                                                   ? fmax(p->error, size)
                                                                               : s->known == 0 ? p->error
                                                                                               : 0;
    to->gauss += piece * error * size;
    to->mean += piece * error;
    to->bending += piece * error * size;
}

typedef struct rectangle {
    double u0, u1, v0, v1;
    quat_surface_totals totals, noise; /* noise: what points may err by */
} rectangle;

static quat_status sum(const quat_surface *s, const rule *in_u, const rule *in_v, rectangle *r)
{
    const quat_surface_totals none = {0, 0, 0, 0};
    const double width = r->u1 - r->u0, height = r->v1 - r->v0;
    r->totals = r->noise = none;
    for (size_t i = 0; i < in_u->n; i++)
        for (size_t j = 0; j < in_v->n; j++) {
            quat_surface_point p;
            const quat_status status =
                quat_surface_at(s, r->u0 + in_u->node[i] * width, r->v0 + in_v->node[j] * height, &p);
            if (status < 0) {
                r->totals = none;
                return status;
            }
            const double piece = in_u->weight[i] * width * in_v->weight[j] * height * p.area, H = p.curvature.mean;
            const quat_surface_totals here = {piece, piece * p.curvature.gauss, piece * H, piece * H * H};
            add(&r->totals, &here);
            doubt(s, status, &p, piece, &r->noise);
        }
    return QUAT_OK;
}

/* The integrals of K and H^2 go without a unit; of H's, a length, zero is the sum of parts. */
static quat_surface_totals allowance(const quat_surface_totals *t, double tolerance)
{
    const quat_surface_totals allowed = {tolerance * t->area, tolerance * (fabs(t->gauss) + 12),
                                         tolerance * (fabs(t->mean) + sqrt(t->area * (t->bending + 12))),
                                         tolerance * (t->bending + 12)};
    return allowed;
}

static quat_surface_totals difference(const quat_surface_totals *a, const quat_surface_totals *b)
{
    const quat_surface_totals d = {fabs(a->area - b->area), fabs(a->gauss - b->gauss), fabs(a->mean - b->mean),
                                   fabs(a->bending - b->bending)};
    return d;
}

/* The largest of four errors, in parts of what is allowed. */
static double worst_of(const quat_surface_totals *off, const quat_surface_totals *allowed)
{
    return fmax(fmax(off->area / allowed->area, off->gauss / allowed->gauss),
                fmax(off->mean / allowed->mean, off->bending / allowed->bending));
}

/* ---- the whole at once ---- */

static quat_status by_products(const quat_surface *s, double tolerance, rectangle *whole)
{
    rule in_u, in_v;
    for (size_t n = 16; n <= most; n *= 2) {
        const quat_surface_totals before = whole->totals;
        quat_status status = QUAT_OK;
        even_rule(n, &in_u);
        even_rule(n, &in_v);
        if (!s->closed_u) status = gauss_rule(n, &in_u);
        if (!s->closed_v && status == QUAT_OK) status = gauss_rule(n, &in_v);
        if (status == QUAT_OK) status = sum(s, &in_u, &in_v, whole);
        if (status != QUAT_OK) return status;
        const quat_surface_totals allowed = allowance(&whole->totals, tolerance),
                                  off = difference(&before, &whole->totals);
        if (n > 16 && worst_of(&off, &allowed) <= 1 && worst_of(&whole->noise, &allowed) <= 1) return QUAT_OK;
    }
    return QUAT_NOT_CONVERGED;
}

/* ---- in parts, smaller where it bends sharply ---- */

typedef struct part {
    rectangle whole, half[2]; /* cut the way that changes more */
    quat_surface_totals off;  /* by how much that is */
} part;

typedef struct search {
    const quat_surface *surface;
    const rule *rule;
    double tolerance;
    quat_surface_totals found, allowed; /* so far */
    bool short_of;
} search;

/* False where a half has no value, as beside a pole. */
static bool cut(const search *s, const rectangle *r, bool across_v, part *p)
{
    rectangle *const half = p->half;
    p->whole = half[0] = half[1] = *r;
    if (across_v)
        half[0].v1 = half[1].v0 = r->v0 + (r->v1 - r->v0) / 2;
    else
        half[0].u1 = half[1].u0 = r->u0 + (r->u1 - r->u0) / 2;
    for (int i = 0; i < 2; i++)
        if (sum(s->surface, s->rule, s->rule, &half[i]) != QUAT_OK) return false;
    quat_surface_totals both = half[0].totals;
    add(&both, &half[1].totals);
    p->off = difference(&both, &r->totals);
    return true;
}

/* Both ways to cut it in two should give what the whole gave. */
static part judge(search *s, const rectangle *r)
{
    static const quat_surface_totals none = {0, 0, 0, 0};
    part across_u, across_v;
    if (cut(s, r, false, &across_u) && cut(s, r, true, &across_v))
        return worst_of(&across_v.off, &s->allowed) > worst_of(&across_u.off, &s->allowed) ? across_v : across_u;
    s->short_of = true;
    across_u.half[0] = *r;
    across_u.half[1].totals = across_u.half[1].noise = across_u.off = none;
    return across_u;
}

/* Adds the parts up, and their errors; the one that is worst. */
static size_t add_up(search *s, size_t n, const part parts[], quat_surface_totals *off, quat_surface_totals *noise)
{
    static const quat_surface_totals none = {0, 0, 0, 0};
    size_t worst = 0;
    s->found = *off = *noise = none;
    for (size_t i = 0; i < n; i++) {
        for (int k = 0; k < 2; k++) add(&s->found, &parts[i].half[k].totals), add(noise, &parts[i].half[k].noise);
        add(off, &parts[i].off);
    }
    s->allowed = allowance(&s->found, s->tolerance);
    for (size_t i = 1; i < n; i++)
        if (worst_of(&parts[i].off, &s->allowed) > worst_of(&parts[worst].off, &s->allowed)) worst = i;
    return worst;
}

/* The worst part gives way to its halves, until all errors together are allowed. */
static void divide(search *s, size_t most_parts, part parts[])
{
    for (size_t n = 1;; n++) {
        quat_surface_totals off, noise;
        const size_t worst = add_up(s, n, parts, &off, &noise);
        const bool good = worst_of(&off, &s->allowed) <= 1;
        if (good && worst_of(&noise, &s->allowed) <= 1) return;
        if (good || n == most_parts) break;
        const part given = parts[worst];
        parts[worst] = judge(s, &given.half[0]);
        parts[n] = judge(s, &given.half[1]);
    }
    s->short_of = true;
}

static quat_status by_parts(const quat_surface *surface, double tolerance, rectangle *whole)
{
    rule in_both;
    search s = {.surface = surface, .rule = &in_both, .tolerance = tolerance};
    const size_t most_parts = surface->known > 0 ? 500 : 50; /* differences of x alone ask it 200 times a point */
    quat_status status = gauss_rule(points, &in_both);
    if (status == QUAT_OK) status = sum(surface, &in_both, &in_both, whole);
    if (status != QUAT_OK) return status;
    part *const parts = malloc(most_parts * sizeof *parts);
    if (!parts) return QUAT_ENOMEM;
    s.allowed = allowance(&whole->totals, tolerance);
    parts[0] = judge(&s, whole);
    divide(&s, most_parts, parts);
    whole->totals = s.found;
    free(parts);
    return s.short_of ? QUAT_NOT_CONVERGED : QUAT_OK;
}

quat_status quat_surface_total(const quat_surface *surface, double tolerance, quat_surface_totals *totals)
{
    const quat_surface_totals none = {0, 0, 0, 0};
    *totals = none;
    if (!quat_surface_is_good(surface) || !(tolerance >= 1e-14)) return QUAT_EARGUMENT;
    rectangle whole = {surface->u0, surface->u1, surface->v0, surface->v1, none, none};
    quat_status status = by_products(surface, tolerance, &whole);
    if (status == QUAT_NOT_CONVERGED) status = by_parts(surface, tolerance, &whole);
    if (status < 0) return status;
    *totals = whole.totals;
    if (isfinite(totals->area + totals->gauss + totals->mean + totals->bending)) return status;
    *totals = none;
    return QUAT_ERANGE;
}
