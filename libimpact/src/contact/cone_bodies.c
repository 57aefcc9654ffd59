/* SPDX-License-Identifier: MIT */
#include "contact/cone_bodies.h"
#include "base/tolerances.h"

#include <math.h>
#include <string.h>

typedef struct bodies_problem {
    int count, n; /* contacts; 6 bodies */
    const imp_cone_row *rows;
    int (*touching)[2]; /* each contact's bodies; -1: does not move */
    const double *q, *friction;
    imp_skyline *sky;
    double *x, *trial, *gradient, *step; /* 6 bodies each */
    double *r, *u, *offset, *pressed;    /* 3 contacts; offset: q + s */
    double *stiffness, *mobility;        /* contacts */
    imp_cone_outcome *outcome;
} bodies_problem;

enum { BODY_VECTORS = 4, CONTACT_VECTORS = 14 };

/* ---- room ---- */

static bool furnish_bodies(imp_cone_bodies *workspace, int contacts, int bodies)
{
    if (contacts <= workspace->contacts && bodies <= workspace->bodies) return true;
    imp_arena *arena = workspace->arena;
    workspace->sky.arena = arena;
    imp_arena_give(arena, workspace->block);
    imp_arena_give(arena, workspace->touching);
    const size_t size = BODY_VECTORS * 6 * (size_t)bodies + CONTACT_VECTORS * (size_t)contacts;
    workspace->block = imp_arena_take(arena, size, sizeof *workspace->block);
    workspace->touching = imp_arena_take(arena, (size_t)contacts, sizeof *workspace->touching);
    const bool there = workspace->block && workspace->touching;
    workspace->contacts = there ? contacts : 0;
    workspace->bodies = there ? bodies : 0;
    return there;
}

static bodies_problem lay_out_bodies(imp_cone_bodies *workspace, int count, int bodies)
{
    bodies_problem p = {.count = count, .n = 6 * bodies, .touching = workspace->touching, .sky = &workspace->sky};
    double *block = workspace->block;
    double **body[] = {&p.x, &p.trial, &p.gradient, &p.step}, **contact[] = {&p.r, &p.u, &p.offset, &p.pressed};
    for (int k = 0; k < BODY_VECTORS; k++, block += p.n) *body[k] = block;
    for (int k = 0; k < 4; k++, block += 3 * (size_t)count) *contact[k] = block;
    p.stiffness = block, p.mobility = block + count;
    return p;
}

/* ---- G ---- */

/* G x at the contact. */
static void seen_at(const bodies_problem *p, int c, const double *x, double v[3])
{
    v[0] = v[1] = v[2] = 0;
    for (int side = 0; side < 2; side++) {
        if (p->touching[c][side] < 0) continue;
        const double *own = &x[6 * p->touching[c][side]];
        for (int k = 0; k < 3; k++)
            for (int l = 0; l < 6; l++) v[k] += p->rows[c].side[side][k][l] * own[l];
    }
}

/* Adds factor G^T f of the contact. */
static void add_effect(const bodies_problem *p, int c, const double f[3], double factor, double *x)
{
    for (int side = 0; side < 2; side++) {
        if (p->touching[c][side] < 0) continue;
        double *own = &x[6 * p->touching[c][side]];
        for (int k = 0; k < 3; k++)
            for (int l = 0; l < 6; l++) own[l] += factor * f[k] * p->rows[c].side[side][k][l];
    }
}

static void add_bend(const bodies_problem *p, int c, double slope[3][3])
{
    const imp_cone_row *row = &p->rows[c];
    for (int i = 0; i < 2; i++) {
        double left[6][3] = {{0}};
        if (p->touching[c][i] < 0) continue;
        for (int k = 0; k < 6; k++)
            for (int m = 0; m < 3; m++)
                for (int o = 0; o < 3; o++) left[k][m] += p->stiffness[c] * row->side[i][o][k] * slope[o][m];
        for (int j = 0; j < 2; j++) {
            double block[6][6] = {{0}};
            if (p->touching[c][j] < 0) continue;
            for (int k = 0; k < 6; k++)
                for (int l = 0; l < 6; l++)
                    for (int m = 0; m < 3; m++) block[k][l] += left[k][m] * row->side[j][m][l];
            imp_skyline_add(p->sky, p->touching[c][i], p->touching[c][j], block);
        }
    }
}

static void set_stiffness(const bodies_problem *p, double stiffness)
{
    for (int c = 0; c < p->count; c++) {
        const int dimension = p->friction[c] > 0 ? 3 : 1;
        double trace = 0;
        for (int side = 0; side < 2; side++)
            for (int k = 0; k < dimension; k++)
                for (int l = 0; l < 6; l++) trace += p->rows[c].side[side][k][l] * p->rows[c].side[side][k][l];
        p->mobility[c] = trace / dimension;
        p->stiffness[c] = stiffness / p->mobility[c];
    }
}

/* ---- Newton ---- */

/* r - rho (q + s + G x). */
static void pressed_by(const bodies_problem *p, int c, const double *x, double y[3])
{
    double v[3];
    seen_at(p, c, x, v);
    for (int k = 0; k < 3; k++) y[k] = p->r[3 * c + k] - p->stiffness[c] * (p->offset[3 * c + k] + v[k]);
}

static double sum_of_products(const double *a, const double *b, int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

/* What x is to minimise; its reactions go to pressed, its gradient to gradient. */
static double look_at(const bodies_problem *p, const double *x, double *scale)
{
    double value = 0.5 * sum_of_products(x, x, p->n);
    memcpy(p->gradient, x, sizeof *x * (size_t)p->n);
    *scale = sum_of_products(x, x, p->n);
    for (int c = 0; c < p->count; c++) {
        double y[3], *f = &p->pressed[3 * c];
        pressed_by(p, c, x, y);
        imp_cone_project(p->friction[c], y, f, NULL);
        value += 0.5 * sum_of_products(f, f, 3) / p->stiffness[c];
        *scale = fmax(*scale, sum_of_products(f, f, 3) * p->mobility[c]);
        add_effect(p, c, f, -1, p->gradient);
    }
    *scale = sqrt(*scale);
    return value;
}

static bool newton_step(const bodies_problem *p)
{
    imp_skyline_clear(p->sky);
    for (int b = 0; b < p->n / 6; b++) {
        double one[6][6] = {{0}};
        for (int k = 0; k < 6; k++) one[k][k] = 1;
        imp_skyline_add(p->sky, b, b, one);
    }
    for (int c = 0; c < p->count; c++) {
        double y[3], f[3], slope[3][3];
        pressed_by(p, c, p->x, y);
        imp_cone_project(p->friction[c], y, f, slope);
        if (f[0] > 0) add_bend(p, c, slope);
    }
    p->outcome->factorings++;
    if (!imp_skyline_factor(p->sky)) return false;
    for (int i = 0; i < p->n; i++) p->step[i] = -p->gradient[i];
    imp_skyline_solve(p->sky, p->step);
    return true;
}

/* Along the step, halved until the function falls by a part of what its slope promises; false where it does not. */
static bool go_along(const bodies_problem *p, double *value, double *scale)
{
    enum { HALVINGS = 30 };
    const double slope = sum_of_products(p->gradient, p->step, p->n);
    double part = 1;
    for (int k = 0; k < HALVINGS; k++, part *= 0.5) {
        for (int i = 0; i < p->n; i++) p->trial[i] = p->x[i] + part * p->step[i];
        const double found = look_at(p, p->trial, scale);
        if (!(found <= *value + 1e-4 * part * slope)) continue;
        *value = found;
        memcpy(p->x, p->trial, sizeof *p->x * (size_t)p->n);
        return true;
    }
    return false;
}

/* Newton's steps for x until the gradient is `enough` of its terms, or rounding: there the function tells no more, and
 * a step counts that halves the gradient. */
static void settle_motion(const bodies_problem *p, double enough)
{
    enum { STEPS = 60 };
    double scale, value = look_at(p, p->x, &scale);
    for (int step = 0; step < STEPS; step++) {
        const double size = sqrt(sum_of_products(p->gradient, p->gradient, p->n));
        if (size <= fmax(enough, IMP_BODIES_FINEST) * scale || !newton_step(p)) return;
        p->outcome->steps++;
        if (size > IMP_BODIES_ROUNDING * scale) {
            if (go_along(p, &value, &scale)) continue;
        } else {
            for (int i = 0; i < p->n; i++) p->trial[i] = p->x[i] + p->step[i];
            const double found = look_at(p, p->trial, &scale);
            if (sum_of_products(p->gradient, p->gradient, p->n) < 0.25 * size * size) {
                value = found;
                memcpy(p->x, p->trial, sizeof *p->x * (size_t)p->n);
                continue;
            }
        }
        (void)look_at(p, p->x, &scale);
        return;
    }
}

/* ---- multipliers ---- */

/* x and u of the reactions r. */
static void effect_of(const bodies_problem *p, const double *r)
{
    memset(p->x, 0, sizeof *p->x * (size_t)p->n);
    for (int c = 0; c < p->count; c++) add_effect(p, c, &r[3 * c], 1, p->x);
    for (int c = 0; c < p->count; c++) {
        double v[3];
        seen_at(p, c, p->x, v);
        for (int k = 0; k < 3; k++) p->u[3 * c + k] = p->q[3 * c + k] + v[k];
    }
}

static double slip_part(const bodies_problem *p, int c)
{
    return p->friction[c] > 0 ? p->friction[c] * hypot(p->u[3 * c + 1], p->u[3 * c + 2]) : 0;
}

static void set_offset(const bodies_problem *p)
{
    for (int c = 0; c < p->count; c++) {
        memcpy(&p->offset[3 * c], &p->q[3 * c], 3 * sizeof *p->q);
        p->offset[3 * c] += slip_part(p, c);
    }
}

static double largest_of(const bodies_problem *p, const double *v)
{
    double most = 0;
    for (int c = 0; c < p->count; c++)
        most = fmax(most, sum_of_products(&v[3 * c], &v[3 * c], p->friction[c] > 0 ? 3 : 1));
    return sqrt(most);
}

/* As imp_cone_residual. */
static double residual_of(const bodies_problem *p, const double *r)
{
    const double most = largest_of(p, r), size = largest_of(p, p->q), s = size > 0 && most > 0 ? most / size : 1;
    double worst = 0;
    for (int c = 0; c < p->count; c++) {
        const double *own = &r[3 * c], *v = &p->u[3 * c];
        const double wanted[3] = {own[0] - s * (v[0] + slip_part(p, c)), own[1] - s * v[1], own[2] - s * v[2]};
        double on[3], off = 0;
        imp_cone_project(p->friction[c], wanted, on, NULL);
        for (int k = 0; k < (p->friction[c] > 0 ? 3 : 1); k++) off += (own[k] - on[k]) * (own[k] - on[k]);
        const double part = sqrt(off) / (most > 0 ? most : s * (size > 0 ? size : 1));
        if (!(part <= worst)) worst = part;
    }
    return worst;
}

static void iterate(const bodies_problem *p, double *r, double *u)
{
    enum { MOST = 40, PATIENCE = 10 };
    const size_t size = 3 * sizeof *r * (size_t)p->count;
    imp_cone_outcome *outcome = p->outcome;
    for (int k = 0, idle = 0; k <= MOST && idle < PATIENCE; k++) {
        effect_of(p, p->r);
        const double found = residual_of(p, p->r);
        idle = found < 0.5 * outcome->residual ? 0 : idle + 1;
        if (found < outcome->residual) {
            outcome->residual = found;
            memcpy(r, p->r, size);
            memcpy(u, p->u, size);
        }
        if (outcome->residual <= IMP_BODIES_ACCEPTED) return;
        set_offset(p);
        set_stiffness(p, k == 0 ? IMP_BODIES_SOFT : IMP_BODIES_STIFF); /* Newton finds its way from soft to stiff */
        settle_motion(p, IMP_BODIES_INNER * found);
        memcpy(p->r, p->pressed, size);
    }
}

imp_cone_outcome imp_cone_solve_bodies(imp_cone_bodies *workspace, const imp_cone_contact *contacts,
                                       const imp_cone_row *rows, int count, const int *number, int bodies,
                                       const double *q, const double *friction, const double *last_r, double *r,
                                       double *u)
{
    imp_cone_outcome outcome = {.status = IMP_CONE_BAD, .residual = INFINITY};
    if (count == 0) return (imp_cone_outcome){.status = IMP_CONE_SOLVED};
    outcome.status = IMP_CONE_NO_ROOM;
    if (!furnish_bodies(workspace, count, bodies)) return outcome;
    bodies_problem p = lay_out_bodies(workspace, count, bodies);
    p.rows = rows, p.q = q, p.friction = friction, p.outcome = &outcome;
    for (int c = 0; c < count; c++) {
        p.touching[c][0] = number[contacts[c].body1];
        p.touching[c][1] = number[contacts[c].body2];
    }
    if (!imp_skyline_shape(p.sky, bodies, (const int(*)[2])p.touching, count)) return outcome;
    outcome.status = IMP_CONE_BAD;
    memset(p.r, 0, 3 * sizeof *p.r * (size_t)count);
    if (last_r) memcpy(p.r, last_r, 3 * sizeof *p.r * (size_t)count);
    for (int c = 0; c < count; c++)
        if (!(friction[c] > 0)) p.r[3 * c + 1] = p.r[3 * c + 2] = 0;
    iterate(&p, r, u);
    if (!(outcome.residual < INFINITY)) return outcome;
    outcome.status = outcome.residual <= IMP_BODIES_ACCEPTED ? IMP_CONE_SOLVED
                     : outcome.residual <= IMP_CONE_USABLE   ? IMP_CONE_INEXACT
                                                             : IMP_CONE_UNSETTLED;
    return outcome;
}
