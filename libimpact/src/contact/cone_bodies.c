/* SPDX-License-Identifier: MIT */
#include "contact/cone_bodies.h"
#include "base/tolerances.h"

#include <math.h>
#include <string.h>

typedef struct bodies_problem {
    int count, n, width;              /* contacts; 6 bodies; numbers a contact */
    const imp_cone_row *rows, *turns; /* turns: divided by the units that make forces of moments */
    const imp_cone_lengths *lengths;
    int (*touching)[2]; /* each contact's bodies; -1: does not move */
    const double *q, *friction;
    imp_skyline *sky;
    double *x, *trial, *gradient, *step; /* 6 bodies each */
    double *r, *u, *offset, *pressed;    /* width contacts; offset: q + s */
    double *y, *lean;                    /* width contacts: r - rho û, and the slope of û_n - u_n in u, of x */
    double *own_q;                       /* with moments: q in their units */
    double *rolling;                     /* contacts, with moments: the slope of rolling's cone in them */
    double *stiffness, *mobility;        /* contacts */
    bool follows;                        /* s is that of x */
    imp_cone_outcome *outcome;
} bodies_problem;

enum { BODY_VECTORS = 4, CONTACT_VECTORS = 7, CONTACT_NUMBERS = 3 };

/* ---- room ---- */

static bool furnish_bodies(imp_cone_bodies *workspace, int contacts, int bodies, int width)
{
    if (contacts <= workspace->contacts && bodies <= workspace->bodies && width <= workspace->width) return true;
    imp_arena *arena = workspace->arena;
    workspace->sky.arena = arena;
    imp_arena_give(arena, workspace->block);
    imp_arena_give(arena, workspace->touching);
    imp_arena_give(arena, workspace->turns);
    const size_t numbers = CONTACT_VECTORS * (size_t)width + CONTACT_NUMBERS;
    const size_t size = BODY_VECTORS * 6 * (size_t)bodies + numbers * (size_t)contacts;
    workspace->block = imp_arena_take(arena, size, sizeof *workspace->block);
    workspace->touching = imp_arena_take(arena, (size_t)contacts, sizeof *workspace->touching);
    workspace->turns = width > 3 ? imp_arena_take(arena, (size_t)contacts, sizeof *workspace->turns) : NULL;
    const bool there = workspace->block && workspace->touching && (width == 3 || workspace->turns);
    workspace->width = width;
    workspace->contacts = there ? contacts : 0;
    workspace->bodies = there ? bodies : 0;
    return there;
}

static bodies_problem lay_out_bodies(imp_cone_bodies *workspace, int count, int bodies, int width)
{
    bodies_problem p = {
        .count = count, .n = 6 * bodies, .width = width, .touching = workspace->touching, .sky = &workspace->sky};
    double *block = workspace->block;
    double **body[] = {&p.x, &p.trial, &p.gradient, &p.step},
           **contact[] = {&p.r, &p.u, &p.offset, &p.pressed, &p.own_q, &p.y, &p.lean};
    for (int k = 0; k < BODY_VECTORS; k++, block += p.n) *body[k] = block;
    for (int k = 0; k < CONTACT_VECTORS; k++, block += (size_t)(width * count)) *contact[k] = block;
    p.stiffness = block, p.mobility = block + count, p.rolling = block + 2 * (size_t)count;
    return p;
}

/* ---- G ---- */

/* G x at the contact, of its three rows of forces, or of moments. */
static void seen_by(const bodies_problem *p, const imp_cone_row *row, int c, const double *x, double v[3])
{
    v[0] = v[1] = v[2] = 0;
    for (int side = 0; side < 2; side++) {
        if (p->touching[c][side] < 0) continue;
        const double *own = &x[6 * p->touching[c][side]];
        for (int k = 0; k < 3; k++) {
            const double *a = row->side[side][k];
            v[k] += (a[0] * own[0] + a[1] * own[1]) + (a[2] * own[2] + a[3] * own[3]) + (a[4] * own[4] + a[5] * own[5]);
        }
    }
}

/* G x at the contact. */
static void seen_at(const bodies_problem *p, int c, const double *x, double v[6])
{
    seen_by(p, &p->rows[c], c, x, v);
    if (p->width > 3) seen_by(p, &p->turns[c], c, x, v + 3);
}

static void add_effect_of(const bodies_problem *p, const imp_cone_row *row, int c, const double f[3], double factor,
                          double *x)
{
    for (int side = 0; side < 2; side++) {
        if (p->touching[c][side] < 0) continue;
        double *own = &x[6 * p->touching[c][side]];
        for (int k = 0; k < 3; k++)
            for (int l = 0; l < 6; l++) own[l] += factor * f[k] * row->side[side][k][l];
    }
}

/* Adds factor G^T f of the contact. */
static void add_effect(const bodies_problem *p, int c, const double *f, double factor, double *x)
{
    add_effect_of(p, &p->rows[c], c, f, factor, x);
    if (p->width > 3) add_effect_of(p, &p->turns[c], c, f + 3, factor, x);
}

/* P_K y of the contact, and its derivative, width x width. */
static void project_pressed(const bodies_problem *p, int c, const double *y, double *f, double slope[36])
{
    if (p->width == 3)
        imp_cone_project(p->friction[c], y, f, (double(*)[3])slope);
    else
        imp_cone_project_turning(p->friction[c], p->lengths[c], p->rolling[c], y, f, (double(*)[6])slope);
}

/* The part of the matrix from rows of the one kind times rows of the other: of three by three of slope. */
static void add_bend_of(const bodies_problem *p, const imp_cone_row *row, const imp_cone_row *other, int c,
                        const double *slope)
{
    for (int i = 0; i < 2; i++) {
        double left[6][3] = {{0}};
        if (p->touching[c][i] < 0) continue;
        for (int k = 0; k < 6; k++)
            for (int m = 0; m < 3; m++)
                for (int o = 0; o < 3; o++)
                    left[k][m] += p->stiffness[c] * row->side[i][o][k] * slope[p->width * o + m];
        for (int j = 0; j < 2; j++) {
            double block[6][6] = {{0}};
            if (p->touching[c][j] < 0) continue;
            for (int k = 0; k < 6; k++)
                for (int m = 0; m < 3; m++)
                    for (int l = 0; l < 6; l++) block[k][l] += left[k][m] * other->side[j][m][l];
            imp_skyline_add(p->sky, p->touching[c][i], p->touching[c][j], block);
        }
    }
}

static void add_bend(const bodies_problem *p, int c, const double slope[36])
{
    add_bend_of(p, &p->rows[c], &p->rows[c], c, slope);
    if (p->width == 3) return;
    add_bend_of(p, &p->rows[c], &p->turns[c], c, slope + 3);
    add_bend_of(p, &p->turns[c], &p->rows[c], c, slope + 18);
    add_bend_of(p, &p->turns[c], &p->turns[c], c, slope + 21);
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

/* ---- slip ---- */

/* u over its size, times the slope, at most two numbers; 0 of none. */
static double scaled_slip(double slope, double *u, int count)
{
    const double size = count == 1 ? fabs(u[0]) : sqrt(u[0] * u[0] + u[1] * u[1]);
    for (int k = 0; k < count; k++) u[k] *= size > 0 ? slope / size : 0;
    return slope * size;
}

/* s = û_n - u_n of the contact's velocities u, and its slope in them (0 where there is none). */
static double slip_part(const bodies_problem *p, int c, const double *u, double slope[6])
{
    const double friction = p->friction[c];
    memcpy(slope, u, (size_t)p->width * sizeof *u);
    slope[0] = 0;
    const double rubs = scaled_slip(friction > 0 ? friction : 0, slope + 1, 2);
    if (p->width == 3) return rubs;
    const double cone = friction > 0 ? friction : 1; /* with which spin is one slip */
    const double spins = scaled_slip(p->lengths[c].torsional > 0 ? cone : 0, slope + 3, 1),
                 one = sqrt(rubs * rubs + spins * spins);
    for (int k = 1; k < 4; k++) slope[k] *= one > 0 ? (k < 3 ? rubs : spins) / one : 0;
    return one + scaled_slip(p->lengths[c].rolling > 0 ? p->rolling[c] : 0, slope + 4, 2);
}

/* ---- Newton ---- */

/* Of x: r - rho (q + s + G x), and where s follows x its slope in what is seen of x. */
static void look_at_contact(const bodies_problem *p, int c, const double *x)
{
    const int i = p->width * c;
    double v[6], *y = &p->y[i];
    seen_at(p, c, x, v);
    if (p->follows) {
        for (int k = 0; k < p->width; k++) v[k] += p->q[i + k];
        v[0] += slip_part(p, c, v, &p->lean[i]);
    } else {
        for (int k = 0; k < p->width; k++) v[k] += p->offset[i + k];
    }
    for (int k = 0; k < p->width; k++) y[k] = p->r[i + k] - p->stiffness[c] * v[k];
}

static double sum_of_products(const double *a, const double *b, int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

/* What x is to minimise; its reactions go to pressed, its gradient to gradient. Where s follows x that is the gradient
 * of nothing, and half its square is to fall. */
static double look_at(const bodies_problem *p, const double *x, double *scale)
{
    double value = 0.5 * sum_of_products(x, x, p->n);
    memcpy(p->gradient, x, sizeof *x * (size_t)p->n);
    *scale = sum_of_products(x, x, p->n);
    for (int c = 0; c < p->count; c++) {
        double *f = &p->pressed[p->width * c];
        look_at_contact(p, c, x);
        project_pressed(p, c, &p->y[p->width * c], f, NULL);
        value += 0.5 * sum_of_products(f, f, p->width) / p->stiffness[c];
        *scale = fmax(*scale, sum_of_products(f, f, p->width) * p->mobility[c]);
        add_effect(p, c, f, -1, p->gradient);
    }
    *scale = sqrt(*scale);
    return p->follows ? 0.5 * sum_of_products(p->gradient, p->gradient, p->n) : value;
}

/* From x, which was looked at last. */
static bool newton_step(const bodies_problem *p)
{
    imp_skyline_clear(p->sky);
    for (int b = 0; b < p->n / 6; b++) {
        double one[6][6] = {{0}};
        for (int k = 0; k < 6; k++) one[k][k] = 1;
        imp_skyline_add(p->sky, b, b, one);
    }
    for (int c = 0; c < p->count; c++) {
        const int i = p->width * c;
        double f[6], slope[36];
        if (!(p->pressed[i] > 0)) continue;
        project_pressed(p, c, &p->y[i], f, slope);
        for (int k = 0; p->follows && k < p->width; k++)
            for (int l = 1; l < p->width; l++) slope[p->width * k + l] += slope[p->width * k] * p->lean[i + l];
        add_bend(p, c, slope);
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
    const double slope = p->follows ? -2 * *value : sum_of_products(p->gradient, p->step, p->n);
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
 * a step counts that halves the gradient. How many; -1: none led on. */
static int settle_motion(const bodies_problem *p, double enough)
{
    enum { STEPS = 60 };
    double scale, value = look_at(p, p->x, &scale);
    for (int step = 0; step < STEPS; step++) {
        const double size = sqrt(sum_of_products(p->gradient, p->gradient, p->n));
        if (size <= fmax(enough, IMP_BODIES_FINEST) * scale) return step;
        if (!newton_step(p)) return -1;
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
        return size <= IMP_BODIES_ROUNDING * scale ? step : -1;
    }
    return -1;
}

/* ---- multipliers ---- */

/* x and u of the reactions r. */
static void effect_of(const bodies_problem *p, const double *r)
{
    memset(p->x, 0, sizeof *p->x * (size_t)p->n);
    for (int c = 0; c < p->count; c++) add_effect(p, c, &r[p->width * c], 1, p->x);
    for (int c = 0; c < p->count; c++) {
        double v[6];
        const int i = p->width * c;
        seen_at(p, c, p->x, v);
        for (int k = 0; k < p->width; k++) p->u[i + k] = p->q[i + k] + v[k];
    }
}

static void set_offset(const bodies_problem *p)
{
    for (int c = 0; c < p->count; c++) {
        const int i = p->width * c;
        memcpy(&p->offset[i], &p->q[i], (size_t)p->width * sizeof *p->q);
        double slope[6];
        p->offset[i] += slip_part(p, c, &p->u[i], slope);
    }
}

/* The size of what turns the contact, as forces: of reactions b is rolling times as large, of velocities smaller. */
static double turning_square(const bodies_problem *p, const double *own, double rolling)
{
    if (p->width == 3) return 0;
    return own[3] * own[3] + (own[4] * own[4] + own[5] * own[5]) * rolling * rolling;
}

static double largest_of(const bodies_problem *p, const double *v, bool velocities)
{
    double most = 0;
    for (int c = 0; c < p->count; c++) {
        const double *own = &v[p->width * c];
        const double rolling = p->width == 3 ? 1 : velocities ? p->rolling[c] : 1 / p->rolling[c];
        most = fmax(most, sum_of_products(own, own, p->friction[c] > 0 ? 3 : 1) + turning_square(p, own, rolling));
    }
    return sqrt(most);
}

/* P_K in units of forces. */
static void nearest(const bodies_problem *p, int c, double *v, double *on)
{
    if (p->width == 3) {
        imp_cone_project(p->friction[c], v, on, NULL);
        return;
    }
    for (int k = 4; k < 6; k++) v[k] /= p->rolling[c];
    imp_cone_project_turning(p->friction[c], p->lengths[c], 1, v, on, NULL);
    for (int k = 4; k < 6; k++) on[k] *= p->rolling[c];
}

/* As imp_cone_residual. */
static double residual_of(const bodies_problem *p, const double *r)
{
    const double most = largest_of(p, r, false), size = largest_of(p, p->q, true),
                 s = size > 0 && most > 0 ? most / size : 1;
    double worst = 0;
    for (int c = 0; c < p->count; c++) {
        const double *own = &r[p->width * c], *v = &p->u[p->width * c];
        double wanted[6], on[6], slope[6], off = 0;
        const double slip = slip_part(p, c, v, slope);
        for (int k = 0; k < p->width; k++) {
            const double rolling = k > 3 ? p->rolling[c] : 1; /* s holds in units of forces: b is rolling times these */
            wanted[k] = own[k] - s * rolling * rolling * (v[k] + (k == 0 ? slip : 0));
        }
        nearest(p, c, wanted, on);
        for (int k = 0; k < p->width; k++) {
            const double rolling = k > 3 ? p->rolling[c] : 1;
            if (k == 0 || k > 2 || p->friction[c] > 0) off += (own[k] - on[k]) / rolling * ((own[k] - on[k]) / rolling);
        }
        const double part = sqrt(off) / (most > 0 ? most : s * (size > 0 ? size : 1));
        if (!(part <= worst)) worst = part;
    }
    return worst;
}

/* The motion for r, with s that follows it, or where that leads nowhere as r's own motion has it; how stiff the next
 * may be. */
static double settle_friction(bodies_problem *p, double rho, double enough)
{
    enum { FEW = 2 };
    set_stiffness(p, rho);
    p->follows = true;
    const int steps = settle_motion(p, enough);
    if (steps >= 0) return steps <= FEW ? fmin(10 * rho, IMP_BODIES_STIFFEST) : rho;
    p->follows = false;
    effect_of(p, p->r);
    set_offset(p);
    (void)settle_motion(p, enough);
    return fmax(0.1 * rho, IMP_BODIES_STIFF);
}

/* r of one contact, as x is while the others stay. */
static void sweep_contact(const bodies_problem *p, int c)
{
    double v[6], own[6], slope[6], *r = &p->r[p->width * c];
    seen_at(p, c, p->x, v);
    for (int k = 0; k < p->width; k++) v[k] += p->q[p->width * c + k];
    v[0] += slip_part(p, c, v, slope);
    for (int k = 0; k < p->width; k++) own[k] = r[k] - p->stiffness[c] * v[k];
    project_pressed(p, c, own, v, NULL);
    for (int k = 0; k < p->width; k++) own[k] = v[k] - r[k], r[k] = v[k];
    add_effect(p, c, own, 1, p->x);
}

/* What is struck anew is far from where the last step left it: contact by contact, there and back, it comes near. */
static void sweep_bodies(const bodies_problem *p)
{
    enum { SWEEPS = 10 };
    set_stiffness(p, 1);
    effect_of(p, p->r);
    for (int k = 0; k < SWEEPS; k++) {
        for (int c = 0; c < p->count; c++) sweep_contact(p, c);
        for (int c = p->count - 1; c >= 0; c--) sweep_contact(p, c);
    }
}

static void iterate(bodies_problem *p, double enough, double *r, double *u)
{
    enum { MOST = 40, PATIENCE = 10 };
    const size_t size = (size_t)p->width * sizeof *r * (size_t)p->count;
    imp_cone_outcome *outcome = p->outcome;
    double rho = IMP_BODIES_SOFT;
    effect_of(p, p->r);
    if (residual_of(p, p->r) > IMP_BODIES_FAR) sweep_bodies(p);
    for (int k = 0, idle = 0; k <= MOST && idle < PATIENCE; k++) {
        effect_of(p, p->r);
        const double found = residual_of(p, p->r);
        idle = found < 0.5 * outcome->residual ? 0 : idle + 1;
        if (found < outcome->residual) {
            outcome->residual = found;
            memcpy(r, p->r, size);
            memcpy(u, p->u, size);
        }
        if (outcome->residual <= fmax(enough, IMP_BODIES_ACCEPTED)) return;
        rho = fmax(settle_friction(p, rho, IMP_BODIES_INNER * fmin(found, 1)), IMP_BODIES_STIFF);
        memcpy(p->r, p->pressed, size);
    }
}

/* ---- moments as forces ---- */

/* The units of moments, with rolling's so that these move as much as forces do: one rho suits both. */
static void units_of_bodies(const bodies_problem *p, int c, double units[6])
{
    imp_cone_units(p->friction[c], p->lengths[c], units);
    for (int k = 4; k < 6; k++) units[k] *= p->rolling[c];
}

/* Reactions to the units (or, back, to the caller's), velocities the other way; what a contact has not is 0 there. */
static void change_units(const bodies_problem *p, bool velocities, bool back, const double *from, double *to)
{
    for (int i = 0; i < p->width * p->count; i++) {
        const int c = i / p->width, k = i % p->width;
        double units[6];
        units_of_bodies(p, c, units);
        to[i] = !(units[k] > 0) ? 0 : velocities == back ? from[i] * units[k] : from[i] / units[k];
    }
}

static double row_squares(const imp_cone_row *row, int first, int rows)
{
    double sum = 0;
    for (int side = 0; side < 2; side++)
        for (int k = first; k < first + rows; k++)
            for (int l = 0; l < 6; l++) sum += row->side[side][k][l] * row->side[side][k][l];
    return sum / rows;
}

static void set_turns(bodies_problem *p, const imp_cone_row *turns, imp_cone_row *own)
{
    for (int c = 0; c < p->count; c++) {
        double units[6];
        p->rolling[c] = 1;
        if (p->lengths[c].rolling > 0)
            p->rolling[c] = p->lengths[c].rolling * sqrt(row_squares(&turns[c], 1, 2) / row_squares(&p->rows[c], 0, 3));
        units_of_bodies(p, c, units);
        for (int i = 0; i < 36; i++) {
            const int side = i / 18, k = i / 6 % 3, l = i % 6;
            own[c].side[side][k][l] = units[3 + k] > 0 ? turns[c].side[side][k][l] / units[3 + k] : 0;
        }
    }
    p->turns = own;
}

/* What turning there is without reactions, of a contact that does not resist it, is told as it is. */
static void give_turning(const bodies_problem *p, const imp_cone_row *turns, const double *q, double *u)
{
    effect_of(p, p->r);
    for (int c = 0; c < p->count; c++) {
        double v[3];
        seen_by(p, &turns[c], c, p->x, v);
        for (int k = 0; k < 3; k++) u[6 * c + 3 + k] = q[6 * c + 3 + k] + v[k];
    }
}

imp_cone_outcome imp_cone_solve_bodies(imp_cone_bodies *workspace, const imp_cone_contact *contacts,
                                       const imp_cone_row *rows, const imp_cone_row *turns, const int *number,
                                       int bodies, const imp_cone_problem *problem, double *r, double *u)
{
    imp_cone_outcome outcome = {.status = IMP_CONE_BAD, .residual = INFINITY};
    const int count = problem->count, width = imp_cone_width(problem);
    const size_t size = (size_t)(width * count);
    if (count == 0) return (imp_cone_outcome){.status = IMP_CONE_SOLVED};
    outcome.status = IMP_CONE_NO_ROOM;
    if (!furnish_bodies(workspace, count, bodies, width)) return outcome;
    bodies_problem p = lay_out_bodies(workspace, count, bodies, width);
    p.rows = rows, p.q = problem->q, p.friction = problem->friction, p.lengths = problem->lengths;
    p.outcome = &outcome;
    for (int c = 0; c < count; c++) {
        p.touching[c][0] = number[contacts[c].body1];
        p.touching[c][1] = number[contacts[c].body2];
    }
    if (!imp_skyline_shape(p.sky, bodies, (const int(*)[2])p.touching, count)) return outcome;
    outcome.status = IMP_CONE_BAD;
    memset(p.r, 0, size * sizeof *p.r);
    if (problem->last_r) memcpy(p.r, problem->last_r, size * sizeof *p.r);
    for (int c = 0; c < count; c++)
        if (!(p.friction[c] > 0)) p.r[width * c + 1] = p.r[width * c + 2] = 0;
    if (width > 3) {
        set_turns(&p, turns, workspace->turns);
        change_units(&p, true, false, problem->q, p.own_q);
        change_units(&p, false, false, p.r, p.r);
        p.q = p.own_q;
    }
    iterate(&p, problem->enough, r, u);
    if (!(outcome.residual < INFINITY)) return outcome;
    if (width > 3) {
        memcpy(p.r, r, size * sizeof *r);
        give_turning(&p, turns, problem->q, u);
        change_units(&p, false, true, p.r, r);
    }
    outcome.status = outcome.residual <= IMP_BODIES_ACCEPTED ? IMP_CONE_SOLVED
                     : outcome.residual <= IMP_CONE_USABLE   ? IMP_CONE_INEXACT
                                                             : IMP_CONE_UNSETTLED;
    return outcome;
}
