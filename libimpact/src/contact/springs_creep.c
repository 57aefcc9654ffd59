/* SPDX-License-Identifier: MIT
 *
 * Slip that creeps: so slow that friction turns it at once to where it balances all else, in a time |u_t|/(mu lambda W)
 * that is a small part of what forces take to change. A box on more contacts than it needs that just gives way slips
 * so, for long. Taylor series resolve that time and no more; what is slow is smooth, and is found by collocation at the
 * nodes c_j of Radau's right rule (L-stable: the fast part is damped; Hairer & Wanner 1996), with the speed s and angle
 * theta of each slip at each node as unknowns,
 *
 *     u_t = s e(theta),    s_j e(theta_j) = u_t(0) + h sum_k A_jk (b_k - W_cc mu lambda_k e(theta_k))
 *
 * A_jk the integrals of Lagrange's polynomials to c_j, W_cc with what sticks answering, b what all other forces do. It
 * is regular at s = 0. Everything else is not stiff: it follows in rounds, forces from indentations and back. The
 * polynomials through the nodes then stand in for the Taylor series.
 */
#include "contact/springs.h"

#include <math.h>
#include "base/numbers.h"
#include "base/tolerances.h"

/* Rounds settle at a tenth each, Newton's steps square: more are none that converge. */
enum { NODES = IMP_SPRINGS_NODES, ROUNDS = 40, NEWTONS = 12, LEADING_6 = 924, LEADING_7 = 3432 };
_Static_assert(NODES == 8, "LEADING_6 and LEADING_7 are of the last two terms that so many nodes give");

/* Radau's nodes on (0, 1], A, and the terms of a polynomial by its values there. */
typedef struct radau {
    double node[NODES], integral[NODES][NODES], terms[NODES][NODES];
} radau;

typedef struct creep {
    imp_springs *s;
    radau rule;
    int count, *which;               /* contacts that creep */
    double h;                        /* the step, in time */
    double *force, *rate, *velocity; /* NODES rows of 3 n: F, W F, u */
    double *depth;                   /* NODES rows of n: x */
    double *start;                   /* of each contact x and u at the beginning */
    double *response;                /* W_cc: (2 count)^2 */
    double *other;                   /* b: NODES rows of 2 count */
    double *speed, *angle;           /* NODES rows of count */
    double *first;                   /* angles to begin with */
    double *matrix, *right;          /* Newton's, 2 count NODES */
} creep;

/* ---- the rule ---- */

/* P_n - P_(n-1), Legendre's: its zeros are Radau's right nodes on (-1, 1]. */
static double radau_polynomial(double x)
{
    double before = 1, now = x;
    for (int k = 1; k < NODES; k++) {
        const double next = ((2 * k + 1) * x * now - k * before) / (k + 1);
        before = now, now = next;
    }
    return now - before;
}

/* 1, and by bisection those between neighbours of a net that is finer than any two of them. */
static void find_nodes(double node[NODES])
{
    enum { NET = 64 * NODES };
    int found = 0;
    for (int i = 0; i < NET && found < NODES - 1; i++) {
        double low = -cos(M_PI * i / NET), high = -cos(M_PI * (i + 1) / NET);
        const double sign = radau_polynomial(low);
        if ((radau_polynomial(high) > 0) == (sign > 0)) continue;
        for (int k = 0; k < 80; k++) {
            const double middle = 0.5 * (low + high);
            *((radau_polynomial(middle) > 0) == (sign > 0) ? &low : &high) = middle;
        }
        node[found++] = 0.5 * (1 + low);
    }
    node[NODES - 1] = 1;
}

static radau make_rule(void)
{
    radau r;
    find_nodes(r.node);
    for (int k = 0; k < NODES; k++) { /* Lagrange's polynomial of node k, by its factors */
        double c[NODES + 1] = {1}, size = 1;
        int order = 0;
        for (int m = 0; m < NODES; m++) {
            if (m == k) continue;
            for (int i = ++order; i >= 0; i--) c[i] = (i > 0 ? c[i - 1] : 0) - r.node[m] * (i < order ? c[i] : 0);
            size *= r.node[k] - r.node[m];
        }
        for (int i = 0; i < NODES; i++) r.terms[i][k] = c[i] / size;
        for (int j = 0; j < NODES; j++) {
            double sum = 0;
            for (int i = NODES - 1; i >= 0; i--) sum = sum * r.node[j] + r.terms[i][k] / (i + 1);
            r.integral[j][k] = sum * r.node[j];
        }
    }
    return r;
}

/* ---- forces at the nodes ---- */

/* The contact's state at node j; what creeps goes straight along its angle there. */
static void stand_at(creep *k, int j)
{
    imp_springs *s = k->s;
    const double *u = &k->velocity[(size_t)(3 * s->count) * (size_t)j];
    for (int i = 0; i < s->count; i++) {
        imp_spring *c = &s->springs[i];
        c->x = k->depth[j * s->count + i];
        for (int m = 0; m < 3; m++) c->u[m] = u[3 * i + m];
    }
    for (int a = 0; a < k->count; a++) {
        imp_spring *c = &s->springs[k->which[a]];
        c->slip = IMP_SPRING_STRAIGHT;
        c->along[0] = cos(k->angle[j * k->count + a]);
        c->along[1] = sin(k->angle[j * k->count + a]);
    }
}

/* F at node j into its row; returns the most it changed by, and *most its size. */
static double take_node_forces(creep *k, int j, double *most)
{
    imp_springs *s = k->s;
    double *force = &k->force[(size_t)(3 * s->count) * (size_t)j], changed = 0;
    stand_at(k, j);
    imp_springs_forces(s);
    for (int i = 0; i < 3 * s->count; i++) {
        const double change = fabs(s->now[i] - force[i]), size = fabs(s->now[i]);
        changed = imp_worse(changed, change);
        *most = size > *most ? size : *most;
        force[i] = s->now[i];
    }
    return changed;
}

/* Friction mu lambda e of what creeps, at node j. */
static void find_bounds(const creep *k, int j, int a, double f[2])
{
    const int i = k->which[a];
    const double bound = k->s->springs[i].friction * k->force[(3 * k->s->count) * j + 3 * i];
    f[0] = bound * cos(k->angle[j * k->count + a]);
    f[1] = bound * sin(k->angle[j * k->count + a]);
}

/* b at node j, whose forces are `now`. */
static void find_others(creep *k, int j)
{
    const int n = 2 * k->count;
    double *other = &k->other[n * j];
    for (int a = 0; a < n; a++) other[a] = imp_springs_row(k->s, 3 * k->which[a / 2] + 1 + a % 2);
    for (int b = 0; b < k->count; b++) {
        double f[2];
        find_bounds(k, j, b, f);
        for (int a = 0; a < n; a++)
            other[a] += k->response[a * n + 2 * b] * f[0] + k->response[a * n + 2 * b + 1] * f[1];
    }
}

/* W_cc, column by column. */
static void find_response(creep *k)
{
    const int n = 2 * k->count;
    for (int b = 0; b < n; b++) {
        for (int i = 0; i < 3 * k->s->count; i++) k->s->now[i] = 0;
        k->s->now[3 * k->which[b / 2] + 1 + b % 2] = 1;
        imp_springs_hold(k->s, -1);
        for (int a = 0; a < n; a++) k->response[a * n + b] = imp_springs_row(k->s, 3 * k->which[a / 2] + 1 + a % 2);
    }
}

/* u and x at the nodes from the forces there. */
static void integrate(creep *k)
{
    imp_springs *s = k->s;
    const int width = 3 * s->count;
    for (int j = 0; j < NODES; j++) { /* rates first, each at its own node */
        for (int i = 0; i < width; i++) s->now[i] = k->force[width * j + i];
        for (int i = 0; i < width; i++) k->rate[width * j + i] = imp_springs_row(s, i);
    }
    for (int j = 0; j < NODES; j++)
        for (int i = 0; i < width; i++) {
            double sum = 0;
            for (int m = 0; m < NODES; m++) sum += k->rule.integral[j][m] * k->rate[width * m + i];
            k->velocity[width * j + i] = k->start[4 * (i / 3) + 1 + i % 3] + k->h * sum;
        }
    for (int j = 0; j < NODES; j++)
        for (int i = 0; i < s->count; i++) {
            double sum = 0;
            for (int m = 0; m < NODES; m++) sum += k->rule.integral[j][m] * k->velocity[width * m + 3 * i];
            k->depth[s->count * j + i] = k->start[4 * i] - k->h * sum;
        }
}

/* ---- Newton for speeds and angles ---- */

/* The residual over h into `right`; returns its largest. */
static double find_creep_residual(creep *k)
{
    const int n = 2 * k->count;
    double worst = 0;
    for (int j = 0; j < NODES; j++) /* accelerations */
        for (int a = 0; a < n; a++) {
            double sum = k->other[n * j + a];
            for (int b = 0; b < k->count; b++) {
                double f[2];
                find_bounds(k, j, b, f);
                sum -= k->response[a * n + 2 * b] * f[0] + k->response[a * n + 2 * b + 1] * f[1];
            }
            k->matrix[n * j + a] = sum;
        }
    for (int j = 0; j < NODES; j++)
        for (int a = 0; a < n; a++) {
            const int place = j * k->count + a / 2;
            const double e = a % 2 ? sin(k->angle[place]) : cos(k->angle[place]);
            double sum = (k->start[4 * k->which[a / 2] + 2 + a % 2] - k->speed[place] * e) / k->h;
            for (int m = 0; m < NODES; m++) sum += k->rule.integral[j][m] * k->matrix[n * m + a];
            k->right[n * j + a] = sum;
            worst = imp_worse(worst, fabs(sum));
        }
    return worst;
}

/* Of the residual's negative: columns speed/h, angle. */
static void find_jacobian(creep *k)
{
    const int n = 2 * k->count, all = n * NODES;
    for (int i = 0; i < all * all; i++) k->matrix[i] = 0;
    for (int m = 0; m < NODES; m++)
        for (int b = 0; b < k->count; b++) {
            const int place = m * k->count + b, column = n * m + 2 * b;
            const double e[2] = {cos(k->angle[place]), sin(k->angle[place])}, part = k->speed[place] / k->h;
            double f[2];
            find_bounds(k, m, b, f);
            for (int i = 0; i < 2; i++) {
                k->matrix[(size_t)(n * m + 2 * b + i) * (size_t)all + (size_t)column] = e[i];
                k->matrix[(size_t)(n * m + 2 * b + i) * (size_t)all + (size_t)column + 1] =
                    part * (i == 0 ? -e[1] : e[0]);
            }
            for (int j = 0; j < NODES; j++)
                for (int a = 0; a < n; a++)
                    k->matrix[(size_t)(n * j + a) * (size_t)all + (size_t)column + 1] +=
                        k->rule.integral[j][m] *
                        (k->response[a * n + 2 * b + 1] * f[0] - k->response[a * n + 2 * b] * f[1]);
        }
}

static bool find_slips(creep *k)
{
    const int unknowns = k->count * NODES;
    double size = 0;
    for (int i = 0; i < 2 * unknowns; i++) size = fmax(size, fabs(k->other[i]));
    for (int a = 0; a < k->count; a++) size = fmax(size, k->speed[a] / k->h);
    for (int turn = 0; turn < NEWTONS; turn++) {
        if (find_creep_residual(k) <= IMP_CREEP_BALANCED * size) return true;
        find_jacobian(k);
        imp_springs_gauss(k->matrix, k->right, 2 * unknowns);
        double most = 0;
        for (int i = 0; i < unknowns; i++) most = fmax(most, fabs(k->right[2 * i + 1]));
        if (!isfinite(most)) return false;
        const double part = most > 0.5 ? 0.5 / most : 1;
        for (int i = 0; i < unknowns; i++) {
            k->speed[i] += part * k->h * k->right[2 * i];
            k->angle[i] += part * k->right[2 * i + 1];
        }
        k->s->work += pow(2 * unknowns, 3) / 3;
    }
    return false;
}

/* ---- a step ---- */

/* Rounds from forces to indentations and back, until they stay. */
static bool settle_nodes(creep *k)
{
    double before = INFINITY;
    for (int round = 0; round < ROUNDS; round++) {
        double changed = 0, most = 0;
        for (int j = 0; j < NODES; j++) {
            changed = fmax(changed, take_node_forces(k, j, &most));
            find_others(k, j);
        }
        if (round > 1 && changed <= IMP_CREEP_ROUNDING * most) return true;
        if (!isfinite(changed) || (round > 4 && changed > before)) return false;
        before = changed;
        if (!find_slips(k)) return false;
        for (int j = 0; j < NODES; j++) (void)take_node_forces(k, j, &most);
        integrate(k);
        k->s->work += 4.0 * NODES * k->s->pressed.start[3 * k->s->count];
    }
    return false;
}

/* How fast what friction balances goes out of balance, of contact i: the pace at which forces change of what friction
 * alone would do. */
static double rate_of_setting_in(const imp_springs *s, int i)
{
    const imp_spring *c = &s->springs[i];
    return imp_springs_pace(s) * c->friction * c->kappa * pow(c->x, s->exponent) *
           imp_springs_entry(s, 3 * i + 1, 3 * i + 1);
}

/* Speeds as of slip that sets in by and by, a tenth of that rate t^2: at rest angles of more contacts than two bodies
 * need are not told apart, and Newton's steps would find none. A hundredth and all of it do as well. */
static void begin_nodes(creep *k)
{
    const imp_springs *s = k->s;
    for (int j = 0; j < NODES; j++) {
        for (int i = 0; i < s->count; i++) {
            k->depth[s->count * j + i] = k->start[4 * i] - k->h * k->rule.node[j] * k->start[4 * i + 1];
            for (int m = 0; m < 3; m++) k->velocity[3 * (s->count * j + i) + m] = k->start[4 * i + 1 + m];
        }
        for (int a = 0; a < k->count; a++) {
            const double *own = &k->start[4 * k->which[a]];
            const double t = k->h * k->rule.node[j];
            k->speed[j * k->count + a] = hypot(own[2], own[3]) + 0.1 * t * t * rate_of_setting_in(s, k->which[a]);
            k->angle[j * k->count + a] = k->first[a];
        }
    }
}

/* The term of (t/h)^m of what has the values at the nodes, `stride` apart. */
static double creep_term(const creep *k, const double *values, int stride, int m)
{
    double sum = 0;
    for (int j = 0; j < NODES; j++) sum += k->rule.terms[m][j] * values[stride * j];
    return sum;
}

/* What the polynomials miss of velocities: the last two terms as Legendre's polynomials on (0, 1) have them, whose
 * leading terms are binom(2k, k). */
static double find_creep_error(const creep *k)
{
    const int width = 3 * k->s->count;
    double worst = 0;
    for (int i = 0; i < width; i++) {
        const double last = fabs(creep_term(k, &k->rate[i], width, NODES - 1)) / LEADING_7,
                     before = fabs(creep_term(k, &k->rate[i], width, NODES - 2)) / LEADING_6;
        worst = fmax(worst, fmax(last, IMP_CREEP_RATIO * before));
    }
    return k->h * worst;
}

/* The series of springs.h, in time, from the nodes. */
static void give_series(creep *k)
{
    imp_springs *s = k->s;
    const int width = 3 * s->count;
    double scale = 1;
    s->lead = IMP_SPRING_TIME;
    for (int m = 0; m < IMP_SPRINGS_TERMS - 1; m++, scale /= k->h) {
        for (int i = 0; i < width && m < IMP_SPRINGS_ORDER; i++) {
            imp_spring *c = &s->springs[i / 3];
            const bool filled = m < NODES;
            c->push[i % 3][m] = filled ? scale * creep_term(k, &k->force[i], width, m) : 0;
            c->velocity[i % 3][m + 1] = filled ? scale * creep_term(k, &k->rate[i], width, m) / (m + 1) : 0;
            if (m == 0) c->velocity[i % 3][0] = k->start[4 * (i / 3) + 1 + i % 3];
        }
        for (int i = 0; i < s->count; i++) {
            imp_spring *c = &s->springs[i];
            if (m == 0) c->depth[0] = k->start[4 * i];
            c->depth[m + 1] = -c->velocity[0][m] / (m + 1);
        }
        for (int a = 0; a < k->count; a++)
            s->springs[k->which[a]].speed[m] = m < NODES ? scale * creep_term(k, &k->speed[a], k->count, m) : 0;
    }
}

/* ---- the whole ---- */

static bool creeps(const imp_spring *c)
{
    return imp_springs_presses(c) && (c->slip == IMP_SPRING_SLIDES || c->slip == IMP_SPRING_BEGINS);
}

size_t imp_springs_creep_size(size_t n)
{
    const size_t m = 2 * (n < IMP_SPRINGS_CREEPERS ? n : IMP_SPRINGS_CREEPERS);
    return NODES * (10 * n + 3 * m) + 4 * n + m * m * (1 + NODES * NODES) + m;
}

static void lay_out_creep(creep *k, double *room)
{
    const int n = k->s->count, m = 2 * k->count;
    double **parts[] = {&k->force, &k->velocity, &k->rate,  &k->depth, &k->start, &k->response,
                        &k->other, &k->speed,    &k->angle, &k->first, &k->right, &k->matrix};
    const int sizes[] = {
        3 * n * NODES, 3 * n * NODES,    3 * n * NODES,    n * NODES, 4 * n,     m * m,
        m * NODES,     k->count * NODES, k->count * NODES, k->count,  m * NODES, m * m * NODES * NODES};
    for (int i = 0; i < 12; i++) *parts[i] = room, room += sizes[i];
}

/* The error that a step may have: u, as rounded as it is, has slip that creeps off its balance by that much, and no
 * nodes resolve how it comes back. The rule damps it. */
static double creep_error_taken(const creep *k)
{
    double taken = IMP_CREEP_ERROR;
    for (int a = 0; a < k->count; a++) taken = fmax(taken, k->s->springs[k->which[a]].rounding);
    return taken;
}

/* Nodes for the longest step up to h that settles; false: none does that is much longer than `least`. */
static bool find_creep_step(creep *k, double h, double least)
{
    const double taken = creep_error_taken(k);
    for (k->h = h; k->h > IMP_CREEP_WORTH * least; k->h *= 0.25) {
        begin_nodes(k);
        if (settle_nodes(k) && find_creep_error(k) <= taken) return true;
    }
    return false;
}

static void keep_start(const creep *k, imp_spring *kept)
{
    for (int i = 0; i < k->s->count; i++) {
        const imp_spring *c = &k->s->springs[i];
        kept[i] = *c;
        k->start[4 * i] = c->x;
        for (int m = 0; m < 3; m++) k->start[4 * i + 1 + m] = c->u[m];
    }
    for (int a = 0; a < k->count; a++) {
        const imp_spring *c = &k->s->springs[k->which[a]];
        const bool told = c->slip == IMP_SPRING_BEGINS || c->creeps;
        k->first[a] = told ? atan2(c->along[1], c->along[0]) : atan2(c->u[2], c->u[1]);
    }
}

/* As at the start, what creeps along its last direction. */
static void give_back(creep *k, const imp_spring *kept, bool found)
{
    for (int i = 0; i < k->s->count; i++) {
        imp_spring *c = &k->s->springs[i];
        c->x = kept[i].x;
        c->slip = kept[i].slip;
        for (int m = 0; m < 3; m++) c->u[m] = kept[i].u[m];
        for (int m = 0; m < 2; m++) c->along[m] = kept[i].along[m];
    }
    for (int a = 0; a < k->count && found; a++) {
        imp_spring *c = &k->s->springs[k->which[a]];
        const double angle = k->angle[(NODES - 1) * k->count + a];
        c->along[0] = cos(angle), c->along[1] = sin(angle);
        c->creeps = true;
    }
}

double imp_springs_creep(imp_springs *s, double reach)
{
    creep k = {.s = s, .which = s->begin};
    for (int i = 0; i < s->count; i++)
        if (creeps(&s->springs[i])) k.which[k.count++] = i;
    if (k.count == 0 || k.count > IMP_SPRINGS_CREEPERS) return 0;
    k.rule = make_rule();
    lay_out_creep(&k, s->creep_room);
    keep_start(&k, s->kept);
    find_response(&k);
    const double longest = IMP_CREEP_STEP / imp_springs_pace(s);
    const bool found = find_creep_step(&k, s->creep_step > 0 ? fmin(longest, 4 * s->creep_step) : longest, reach);
    if (found) {
        s->creep_step = k.h;
        give_back(&k, s->kept, true);
        give_series(&k);
        return k.h;
    }
    give_back(&k, s->kept, false);
    return 0;
}
