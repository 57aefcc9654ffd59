/* SPDX-License-Identifier: MIT */
#include "quadrature.h"

#include <math.h>

enum { points = 21, half = 10 };

/* Kronrod's rule of 21 points on -1 ... 1, from the ends inward: the 1st, 3rd, ... pair from without were added to the
 * pairs of Gauss' rule of 10. Exact for polynomials up to degree 31. Kronrod, "Nodes and weights of quadrature
 * formulas", 1965; Piessens et al., QUADPACK, 1983. */
static const double node[half] = {0.9956571630258080807355, 0.9739065285171717200780, 0.9301574913557082260012,
                                  0.8650633666889845107321, 0.7808177265864168970637, 0.6794095682990244062343,
                                  0.5627571346686046833390, 0.4333953941292471907993, 0.2943928627014601981311,
                                  0.1488743389816312108848};
static const double node_weight[half + 1] = {
    0.0116946388673718742781, 0.0325581623079647274788, 0.0547558965743519960314, 0.0750396748109199527670,
    0.0931254545836976055351, 0.1093871588022976418992, 0.1234919762620658510780, 0.1347092173114733259281,
    0.1427759385770600807971, 0.1477391049013384913748, 0.1494455540029169056649};

typedef struct search {
    quat_integrand f;
    void *context;
    double allowed;
    double noise; /* of all parts that were taken */
    size_t left;  /* intervals that may still be asked */
    bool short_of;
    /* the values that the rule has just asked for */
    size_t count;
    double t[points], value[points], doubt; /* doubt: the sum of f's own errors */
    double weight[points];                  /* barycentric, of the rule's nodes in its own order */
} search;

typedef struct part {
    double a, b, integral;
    double size;  /* of |f| */
    double noise; /* what f's own errors may make of the integral */
    double ends;  /* what may hide between the ends and the nodes next to them */
} part;

static double doubted(search *s, double t)
{
    double error = 0;
    const double value = s->f(t, s->context, &error);
    s->t[s->count] = t, s->value[s->count] = value, s->count++;
    s->doubt += error;
    return value;
}

static void weigh(search *s, double a, double b)
{
    for (int i = 0; i < points; i++) {
        s->weight[i] = 1;
        for (int k = 0; k < points; k++)
            if (k != i) s->weight[i] *= (b - a) / 2 / (s->t[i] - s->t[k]);
    }
}

/* By how much f(t) is off the polynomial through the nodes. */
static double surprise(const search *s, double t)
{
    double above = 0, below = 0, error;
    for (int i = 0; i < points; i++) {
        const double share = s->weight[i] / (t - s->t[i]);
        above += share * s->value[i];
        below += share;
    }
    return fabs(s->f(t, s->context, &error) - above / below);
}

/* The rule's sum over a ... b, and that of |f|. */
static double rule(search *s, double a, double b, double *size)
{
    const double middle = 0.5 * (a + b), reach = 0.5 * (b - a), centre = doubted(s, middle);
    double sum = node_weight[half] * centre;
    *size = node_weight[half] * fabs(centre);
    for (int i = 0; i < half; i++) {
        const int k = i < half / 2 ? 2 * i + 1 : 2 * i - half; /* Gauss' pairs first */
        const double below = doubted(s, middle - reach * node[k]), above = doubted(s, middle + reach * node[k]);
        sum += node_weight[k] * (below + above);
        *size += node_weight[k] * (fabs(below) + fabs(above));
    }
    *size *= fabs(reach);
    return sum * reach;
}

/* A kink between an end and the node next to it, .0022 of the interval away, is seen by no rule on it and by none on
 * its halves: f is asked close to the ends, and not at them, where it may be infinite. */
static part ask(search *s, double a, double b)
{
    static const double blind = 0.0022, inward = 1e-8, shortest = 1e-5;
    part p = {.a = a, .b = b};
    s->doubt = 0;
    s->count = 0;
    p.integral = rule(s, a, b, &p.size);
    p.noise = s->doubt / points * fabs(b - a);
    if (fabs(b - a) < shortest * fmax(fabs(a), fabs(b))) return p; /* the nodes themselves are rounded */
    if (s->weight[0] == 0) weigh(s, a, b);
    const double step = inward * (b - a);
    p.ends = blind * fabs(b - a) * (surprise(s, a + step) + surprise(s, b - step));
    return p;
}

/* The rule's own estimate takes a small difference for a far smaller error. Two halves that give what the whole gave
 * are better witnesses. */
static double refine(search *s, part whole, int depth)
{
    const double middle = whole.a + (whole.b - whole.a) / 2;
    const part low = ask(s, whole.a, middle), high = ask(s, middle, whole.b);
    const double sum = low.integral + high.integral, off = fabs(sum - whole.integral) + low.ends + high.ends;
    const bool good = off <= s->allowed + low.noise + high.noise, last = depth == 0 || s->left < 2;
    if (!good && !last) {
        s->left -= 2;
        return refine(s, low, depth - 1) + refine(s, high, depth - 1);
    }
    s->short_of = s->short_of || !good;
    s->noise += low.noise + high.noise;
    return sum;
}

quat_status quat_quadrature(quat_integrand f, void *context, double a, double b, double tolerance, double *integral,
                            double *noise)
{
    search s = {.f = f, .context = context, .left = 1600};
    *integral = *noise = 0;
    if (a == b) return QUAT_OK;
    const part whole = ask(&s, a, b);
    s.allowed = tolerance * whole.size;
    *integral = refine(&s, whole, 40);
    *noise = s.noise;
    return s.short_of ? QUAT_NOT_CONVERGED : QUAT_OK;
}
