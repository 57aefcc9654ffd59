/* SPDX-License-Identifier: MIT */
#include "motion/face_motion.h"
#include "base/bracket.h"
#include "base/tolerances.h"
#include "motion/face_begin.h"

#include <math.h>
#include <quat/quat.h>
#include <string.h>

/* ---- collocation ---- */

/* Gauss's nine places and weights in [0, 1]. */
static const double node[IMP_FACE_NODES] =
    {0.015919880246186957, 0.081984446336682115, 0.19331428364970482, 0.33787328829809554, 0.5,
     0.66212671170190451,  0.80668571635029518,  0.91801555366331788, 0.98408011975381304},
                    weight[IMP_FACE_NODES] = {0.040637194180787081, 0.090324080347428684, 0.1303053482014678,
                                              0.15617353852000146,  0.16511967750062992,  0.15617353852000146,
                                              0.1303053482014678,   0.090324080347428684, 0.040637194180787081};

const double imp_face_last_node = 0.98408011975381304;

/* Legendre's polynomials P_0 ... P_9 over [0, 1] at x. */
static void legendre(double x, double p[IMP_FACE_NODES + 1])
{
    const double z = 2 * x - 1;
    p[0] = 1, p[1] = z;
    for (int k = 1; k < IMP_FACE_NODES; k++) p[k + 1] = ((2 * k + 1) * z * p[k] - k * p[k - 1]) / (k + 1);
}

typedef struct collocation {
    double term[IMP_FACE_NODES][IMP_FACE_NODES];     /* P_k at the nodes */
    double integral[IMP_FACE_NODES][IMP_FACE_NODES]; /* of P_k from 0 to them */
    double way[IMP_FACE_NODES][IMP_FACE_NODES];      /* A: of what has 1 at a node and 0 at the others */
} collocation;

static void lay_out(collocation *c)
{
    for (int i = 0; i < IMP_FACE_NODES; i++) {
        double p[IMP_FACE_NODES + 1];
        legendre(node[i], p);
        c->integral[i][0] = node[i];
        for (int k = 0; k < IMP_FACE_NODES; k++) {
            c->term[i][k] = p[k];
            if (k > 0) c->integral[i][k] = (p[k + 1] - p[k - 1]) / (2 * (2 * k + 1));
        }
    }
    for (int i = 0; i < IMP_FACE_NODES; i++)
        for (int j = 0; j < IMP_FACE_NODES; j++) {
            c->way[i][j] = 0;
            for (int k = 0; k < IMP_FACE_NODES; k++)
                c->way[i][j] += c->integral[i][k] * (2 * k + 1) * weight[j] * c->term[j][k];
        }
}

/* The rates' coefficients in Legendre's polynomials from their values at the nodes. */
static void expand(const collocation *c, double rate[][IMP_FACE_STATE], double k[][IMP_FACE_STATE])
{
    for (int j = 0; j < IMP_FACE_NODES; j++)
        for (int n = 0; n < IMP_FACE_STATE; n++) {
            k[j][n] = 0;
            for (int i = 0; i < IMP_FACE_NODES; i++) k[j][n] += (2 * j + 1) * weight[i] * c->term[i][j] * rate[i][n];
        }
}

/* A */
static double greatest_rate(const imp_face_motion *motion)
{
    return motion->friction * motion->load.press + hypot(motion->load.pull[0], motion->load.pull[1]);
}

/* What each number is measured by: what it still changes by where the motion fades, as far as that counts. */
static void measure(const imp_face_motion *motion, const double *y, double unit[IMP_FACE_STATE])
{
    const double least = IMP_FACE_STILL / IMP_FACE_TOLERANCE * motion->still;
    const double speed = fmax(imp_face_speed(motion, y), least), time = speed / greatest_rate(motion);
    const double c = motion->rolling > 0 ? motion->height : 1, goes = speed + c * fabs(y[IMP_FACE_ROLL]);
    for (int n = 0; n < IMP_FACE_V; n++) unit[n] = n < IMP_FACE_ANGLE ? goes * time : speed * time;
    for (int n = IMP_FACE_V; n < IMP_FACE_TIME; n++) unit[n] = speed;
    unit[IMP_FACE_ROLL] = goes / c, unit[IMP_FACE_ROLLED] = goes / c * time;
    unit[IMP_FACE_TIME] = time;
    unit[IMP_FACE_WORK] = unit[IMP_FACE_PUSHED] = unit[IMP_FACE_DAMPED] = speed * speed;
}

/* dt/dtau: under loads that change no longer than the time in which the body falls its reach. */
static double clock_of(const imp_face_motion *motion, const double *y)
{
    if (motion->clock > 0) return motion->clock;
    const double speed = imp_face_speed(motion, y), least = motion->loads ? speed * sqrt(motion->load.press) : 0;
    return speed / (greatest_rate(motion) + least);
}

static bool rates_in_tau(const imp_face_motion *motion, const double *y, double *rate, imp_face_balance *balance)
{
    const double clock = clock_of(motion, y);
    if (!imp_face_rates(motion, y, rate, balance)) return false;
    for (int n = 0; n < IMP_FACE_STATE; n++) rate[n] *= clock;
    return imp_face_margin(motion, y, balance) > IMP_FACE_MARGIN;
}

enum { MOVING = 4, SYSTEM = MOVING * IMP_FACE_NODES };

/* The velocities, and the places that go with them; the last of a line alone. */
static const int face_velocity[MOVING] = {IMP_FACE_V, IMP_FACE_V + 1, IMP_FACE_W, IMP_FACE_ROLL},
                 face_place[MOVING] = {IMP_FACE_X, IMP_FACE_X + 1, IMP_FACE_ANGLE, IMP_FACE_ROLLED};

static int moving_of(const imp_face_motion *motion) { return motion->rolling > 0 ? MOVING : MOVING - 1; }

/* The places' rates. */
static void going_at(const imp_face_motion *motion, const double *y, double out[MOVING])
{
    imp_face_center_velocity(motion, y, out);
    out[2] = y[IMP_FACE_W], out[3] = y[IMP_FACE_ROLL];
}

/* LU with rows exchanged, in place, of so many; and its solution in place of b. */
static bool factor(double a[SYSTEM][SYSTEM], int size, int *row)
{
    for (int k = 0; k < size; k++) {
        int best = k;
        for (int i = k + 1; i < size; i++)
            if (fabs(a[i][k]) > fabs(a[best][k])) best = i;
        row[k] = best;
        if (!(fabs(a[best][k]) > 0)) return false;
        for (int j = k; j < size && best != k; j++) {
            const double swap = a[k][j];
            a[k][j] = a[best][j], a[best][j] = swap;
        }
        for (int i = k + 1; i < size; i++) {
            const double part = a[i][k] /= a[k][k];
            if (part == 0) continue;
            for (int j = k + 1; j < size; j++) a[i][j] -= part * a[k][j];
        }
    }
    return true;
}

static void back_solve(double a[SYSTEM][SYSTEM], int size, const int *row, double *b)
{
    for (int k = 0; k < size; k++) {
        const double swap = b[k];
        b[k] = b[row[k]], b[row[k]] = swap;
        for (int i = k + 1; i < size; i++) b[i] -= a[i][k] * b[k];
    }
    for (int k = size - 1; k >= 0; k--) {
        for (int j = k + 1; j < size; j++) b[k] -= a[k][j] * b[j];
        b[k] /= a[k][k];
    }
}

/* The slopes of the velocities' rates at y, by differences. */
static bool face_slopes(const imp_face_motion *motion, const double *y, const double *rate, imp_face_balance *last,
                        double slope[MOVING][MOVING])
{
    const int moving = moving_of(motion);
    for (int j = 0; j < moving; j++) {
        double there[IMP_FACE_STATE], found[IMP_FACE_STATE];
        memcpy(there, y, sizeof there);
        const double step = imp_face_difference(motion) * imp_face_speed(motion, y);
        there[face_velocity[j]] += step;
        if (!rates_in_tau(motion, there, found, last)) return false;
        for (int i = 0; i < moving; i++) slope[i][j] = (found[face_velocity[i]] - rate[face_velocity[i]]) / step;
    }
    return true;
}

/* 1 - h A J of the velocities, with the slopes J at each node. */
static bool linearize(const collocation *c, int moving, double h, double slope[][MOVING][MOVING],
                      double a[SYSTEM][SYSTEM], int *row)
{
    const int size = moving * IMP_FACE_NODES;
    for (int n = 0; n < size; n++)
        for (int m = 0; m < size; m++) {
            const double part = h * c->way[n / moving][m / moving];
            a[n][m] = (n == m) - part * slope[m / moving][n % moving][m % moving];
        }
    return factor(a, size, row);
}

static void states_at_nodes(const collocation *c, const double *y, double h, double rate[][IMP_FACE_STATE],
                            double there[][IMP_FACE_STATE])
{
    for (int i = 0; i < IMP_FACE_NODES; i++)
        for (int n = 0; n < IMP_FACE_STATE; n++) {
            double way = 0;
            for (int j = 0; j < IMP_FACE_NODES; j++) way += c->way[i][j] * rate[j][n];
            there[i][n] = y[n] + h * way;
        }
}

/* The places at the nodes, as the velocities there lead to them; returns by how much they change, in units. */
static double follow_velocities(const imp_face_motion *motion, const collocation *c, const double *y, double h,
                                const double *unit, double there[][IMP_FACE_STATE])
{
    const int moving = moving_of(motion);
    double going[IMP_FACE_NODES][MOVING], moved = 0;
    for (int i = 0; i < IMP_FACE_NODES; i++) {
        const double clock = clock_of(motion, there[i]);
        going_at(motion, there[i], going[i]);
        for (int n = 0; n < moving; n++) going[i][n] *= clock;
    }
    for (int i = 0; i < IMP_FACE_NODES; i++)
        for (int n = 0; n < moving; n++) {
            const int to = face_place[n];
            double way = 0;
            for (int j = 0; j < IMP_FACE_NODES; j++) way += c->way[i][j] * going[j][n];
            moved = fmax(moved, fabs(y[to] + h * way - there[i][to]) / unit[to]);
            there[i][to] = y[to] + h * way;
        }
    return moved;
}

/* The velocities at the nodes by one step of Newton's, from those that their rates lead to, and the places that go with
 * them; returns by how much they change, in units. */
static double follow_rates(double a[SYSTEM][SYSTEM], int moving, const int *row, const double *unit,
                           double made[][IMP_FACE_STATE], double there[][IMP_FACE_STATE])
{
    const int size = moving * IMP_FACE_NODES;
    double off[SYSTEM], moved = 0;
    for (int n = 0; n < size; n++)
        off[n] = made[n / moving][face_velocity[n % moving]] - there[n / moving][face_velocity[n % moving]];
    back_solve(a, size, row, off);
    for (int n = 0; n < size; n++) {
        there[n / moving][face_velocity[n % moving]] += off[n];
        moved = fmax(moved, fabs(off[n]) / unit[face_velocity[n % moving]]);
    }
    return moved;
}

/* A step on its way. */
typedef struct course {
    double first[IMP_FACE_STATE]; /* rates where it begins; */
    double rate[IMP_FACE_NODES][IMP_FACE_STATE],
        there[IMP_FACE_NODES][IMP_FACE_STATE]; /* rates and states at its nodes */
    double slope[IMP_FACE_NODES][MOVING][MOVING];
    imp_face_balance last[IMP_FACE_NODES]; /* from one round to the next they hardly change */
} course;

/* With the rates and slopes of y all along. */
static bool set_forth(const imp_face_motion *motion, const double *y, course *on)
{
    imp_face_balance begun = {.p = {0}};
    if (!rates_in_tau(motion, y, on->first, &begun) || !face_slopes(motion, y, on->first, &begun, on->slope[0]))
        return false;
    for (int i = 0; i < IMP_FACE_NODES; i++) {
        memcpy(on->rate[i], on->first, sizeof on->rate[i]);
        memcpy(on->there[i], y, sizeof on->there[i]);
        memcpy(on->slope[i], on->slope[0], sizeof on->slope[i]);
        on->last[i] = begun;
    }
    return true;
}

/* The accelerations with which it begins to move. */
static bool goes_from_rest(const imp_face_motion *motion, const double *y, double a[MOVING], imp_face_balance *balance)
{
    imp_face_load load = {.press = 0};
    if (imp_face_begins(motion, y, a, balance) != IMP_FACE_GOES) return false;
    if (motion->rolling > 0 && !imp_face_load_at(motion, y, &load)) return false;
    a[MOVING - 1] = imp_face_roll_rate(motion, &load, balance->force);
    return true;
}

/* From rest: with the velocities that it would have if it began to move with half a node's time gone, and the slopes
 * there. */
static bool leave_rest(const imp_face_motion *motion, const double *y, double h, course *on)
{
    double a[MOVING], going[MOVING];
    memset(on->first, 0, sizeof on->first);
    if (!goes_from_rest(motion, y, a, &on->last[0])) return false;
    going_at(motion, y, going);
    for (int n = 0; n < MOVING; n++)
        on->first[face_place[n]] = motion->clock * going[n], on->first[face_velocity[n]] = motion->clock * a[n];
    on->first[IMP_FACE_TIME] = motion->clock;
    for (int i = 0; i < IMP_FACE_NODES; i++) {
        double *there = on->there[i], time = h * motion->clock * node[i];
        memcpy(there, y, sizeof on->there[i]);
        there[IMP_FACE_TIME] += 0.5 * time;
        if (motion->loads && !goes_from_rest(motion, there, a, &on->last[i])) return false;
        there[IMP_FACE_TIME] += 0.5 * time;
        for (int n = 0; n < MOVING; n++) there[face_velocity[n]] += time * a[n];
        on->last[i] = on->last[0];
        if (!rates_in_tau(motion, there, on->rate[i], &on->last[i]) ||
            !face_slopes(motion, there, on->rate[i], &on->last[i], on->slope[i]))
            return false;
    }
    return true;
}

/* The rates at the nodes, by Newton's iteration for the velocities; all else only follows them. It begins with what
 * rates would lead to that go from those as their slopes. */
static bool collocate(const imp_face_motion *motion, const collocation *c, const double *y, double h,
                      const double *unit, course *on, double k[][IMP_FACE_STATE])
{
    double made[IMP_FACE_NODES][IMP_FACE_STATE], a[SYSTEM][SYSTEM], change = INFINITY;
    int row[SYSTEM];
    const int moving = moving_of(motion);
    if (!linearize(c, moving, h, on->slope, a, row)) return false;
    for (int round = -1; round < IMP_FACE_ROUNDS; round++) {
        for (int i = 0; round >= 0 && i < IMP_FACE_NODES; i++)
            if (!rates_in_tau(motion, on->there[i], on->rate[i], &on->last[i])) return false;
        states_at_nodes(c, y, h, on->rate, made);
        const double turned = follow_rates(a, moving, row, unit, made, on->there);
        const double moved = fmax(turned, follow_velocities(motion, c, y, h, unit, on->there));
        for (int i = 0; i < IMP_FACE_NODES; i++)
            for (int n = IMP_FACE_TIME; n <= IMP_FACE_DAMPED; n++) on->there[i][n] = made[i][n];
        if (round >= 0 && (moved <= IMP_FACE_SETTLED || (moved >= change && moved <= IMP_FACE_TOLERANCE))) {
            expand(c, on->rate, k);
            return true;
        }
        if (moved >= change && round > 2) return false;
        change = moved;
    }
    return false;
}

/* y0 + h sum k_j of the integrals of P_j(1 + 2 s) = sum over i of binomial(j, i) binomial(j + i, i) s^i, about the end.
 */
static void keep_path(const double *y, double h, double clock, double k[][IMP_FACE_STATE], imp_face_path *path)
{
    memset(path, 0, sizeof *path);
    path->length = h, path->clock = clock;
    for (int n = 0; n < IMP_FACE_STATE; n++) path->c[0][n] = y[n] + h * k[0][n];
    for (int j = 0; j < IMP_FACE_NODES; j++) {
        double binomials = 1;
        for (int i = 0; i <= j; i++) {
            for (int n = 0; n < IMP_FACE_STATE; n++) path->c[i + 1][n] += h * k[j][n] * binomials / (i + 1);
            binomials *= (double)((j - i) * (j + i + 1)) / ((i + 1) * (i + 1));
        }
    }
}

void imp_face_at(const imp_face_path *path, double s, double *y)
{
    for (int n = 0; n < IMP_FACE_STATE; n++) {
        y[n] = 0;
        for (int k = IMP_FACE_TERMS - 1; k >= 0; k--) y[n] = y[n] * s + path->c[k][n];
    }
}

/* In tolerances: the last term; and by how much the rates miss those of the begin, where no node stands. */
static double error_of(double k[][IMP_FACE_STATE], const double *first, double h, const double *unit)
{
    double error = 0;
    for (int n = 0; n < IMP_FACE_STATE; n++) {
        double miss = first[n];
        for (int j = 0; j < IMP_FACE_NODES; j++) miss += j % 2 ? k[j][n] : -k[j][n];
        error = fmax(error, h * fmax(fabs(k[IMP_FACE_NODES - 1][n]), fabs(miss)) / (unit[n] * IMP_FACE_TOLERANCE));
    }
    return error;
}

/* A step of h, its error in tolerances; false: none so long. */
static bool attempt(const imp_face_motion *motion, const collocation *c, const double *y, double h, course *on,
                    double k[][IMP_FACE_STATE], double *error)
{
    double unit[IMP_FACE_STATE];
    if (!(motion->clock > 0 ? leave_rest(motion, y, h, on) : set_forth(motion, y, on))) return false;
    measure(motion, motion->clock > 0 ? on->there[IMP_FACE_NODES - 1] : y, unit);
    if (!collocate(motion, c, y, h, unit, on, k)) return false;
    *error = error_of(k, on->first, h, unit);
    return true;
}

/* ---- where the pressed part comes to have other sides ---- */

static int corners_of(const imp_flat_face *face) { return face->count > 0 ? face->count : 1; }

/* The pressure at a corner; of a disc the least. */
static double pressure_of(const imp_flat_face *face, int i, const double p[3])
{
    if (face->count == 0) return imp_least_pressure(face, p);
    return p[0] + p[1] * face->corner[i][0] + p[2] * face->corner[i][1];
}

/* Above zero until one of the corners has another sign than there. */
static double same_side(const imp_flat_face *face, const double there[3], const double p[3])
{
    double least = INFINITY;
    for (int i = 0; i < corners_of(face); i++)
        least = fmin(least, copysign(1, pressure_of(face, i, there)) * pressure_of(face, i, p));
    return least;
}

/* Where, of the step, the line of no pressure first comes to a corner, between two of its nodes; 0: nowhere. There the
 * pressed part has one side more or less, and of the rates, which change as the cube of what is beyond, no polynomial
 * tells. The path is one whose step is no good: near enough for that. */
static double first_bend(const imp_face_motion *motion, const course *on, const imp_face_path *path)
{
    const imp_flat_face *face = &motion->face;
    int i = 1;
    while (i < IMP_FACE_NODES && same_side(face, on->last[0].p, on->last[i].p) >= 0) i++;
    if (i == IMP_FACE_NODES) return 0;
    imp_face_balance balance = on->last[i];
    imp_bracket b = {.low = node[i - 1],
                     .high = node[i],
                     .at_low = same_side(face, on->last[0].p, on->last[i - 1].p),
                     .at_high = same_side(face, on->last[0].p, on->last[i].p)};
    for (int k = 0; k < IMP_BRACKET_MOST && b.high - b.low > IMP_FACE_BEND; k++) {
        double y[IMP_FACE_STATE], rate[IMP_FACE_STATE];
        const double guess = imp_bracket_guess(&b);
        imp_face_at(path, guess - 1, y);
        if (!rates_in_tau(motion, y, rate, &balance)) return 0;
        const double value = same_side(face, on->last[0].p, balance.p);
        if (fabs(value) <= IMP_FACE_BEND) return guess;
        imp_bracket_take(&b, guess, value, value < 0);
    }
    return b.high;
}

/* How fast it turns, about whatever. */
static double turning_rate(const double *y) { return hypot(y[IMP_FACE_W], y[IMP_FACE_ROLL]); }

static bool step_within(const imp_face_motion *motion, const double *y, double longest, double shortest, double *length,
                        imp_face_path *path)
{
    collocation c;
    course on;
    double k[IMP_FACE_NODES][IMP_FACE_STATE], error, bent = 0;
    bool cut = false;
    lay_out(&c);
    for (double h = fmin(*length, longest); h > 0;) {
        if (!attempt(motion, &c, y, h, &on, k, &error) || h * fabs(k[0][IMP_FACE_ROLLED]) > 2 * IMP_FACE_TURN) {
            cut = true;
            h *= 0.5;
            if (h <= shortest) return false;
            continue;
        }
        const double next = h * fmin(fmax(0.9 * pow(error, -1.0 / IMP_FACE_NODES), 0.2), 2);
        keep_path(y, h, motion->clock, k, path);
        if (error <= 1 || (h <= IMP_FACE_JUMP && isfinite(error))) {
            *length = !(error <= 1) ? IMP_FACE_LONGEST : fmax(bent, cut ? h : next);
            return true;
        }
        if (h <= IMP_FACE_JUMP) return false;
        const double bend = h * first_bend(motion, &on, path);
        bent = bend > 0 ? h : 0;
        h = fmax(bend > 0 ? bend : next, IMP_FACE_JUMP);
    }
    return false;
}

/* tau of a step under loads that change, if |(v, k w)| goes on as e^(g tau) as it does now, g <= 1: in which it changes
 * by a factor of e at most, no more time passes than a step may last, and it turns no farther than in a step. */
static double longest_in_tau(const imp_face_motion *motion, const double *y)
{
    const double clock = clock_of(motion, y), k = motion->gyration * motion->gyration, *v = &y[IMP_FACE_V],
                 w = y[IMP_FACE_W], speed = imp_face_speed(motion, y);
    const double part = fmin(motion->longest, IMP_FACE_TURN / turning_rate(y)) / clock;
    double rate[IMP_FACE_STATE];
    imp_face_balance balance = {.p = {0}};
    if (!imp_face_rates(motion, y, rate, &balance)) return fmin(log1p(part), 1);
    const double grows = v[0] * rate[IMP_FACE_V] + v[1] * rate[IMP_FACE_V + 1] + k * w * rate[IMP_FACE_W];
    const double g = clock * grows / (speed * speed), once = 1 / fabs(g);
    return g * part > -1 && fabs(g) > IMP_LEVEL ? fmin(log1p(g * part) / g, once) : fmin(part, once);
}

/* The path of constant accelerations from y on, so long. */
static void set_off(const imp_face_motion *motion, const double *y, const double a[MOVING], double h,
                    imp_face_path *path)
{
    double going[MOVING], over[2] = {0, 0};
    if (motion->rolling > 0) imp_face_over_center(motion, y, a[MOVING - 1], over);
    going_at(motion, y, going);
    *path = (imp_face_path){.clock = 1};
    memcpy(path->c[0], y, sizeof path->c[0]);
    path->c[0][IMP_FACE_TIME] += h, path->c[1][IMP_FACE_TIME] = h;
    for (int n = 0; n < MOVING; n++) {
        const double own = n < 2 ? a[n] - over[n] : a[n], bend = 0.5 * h * h * own;
        double(*c)[IMP_FACE_STATE] = path->c;
        const int to = face_place[n];
        c[0][to] += h * going[n] + bend, c[1][to] = h * going[n] + 2 * bend, c[2][to] = bend;
        c[0][face_velocity[n]] += h * a[n], c[1][face_velocity[n]] = h * a[n];
    }
}

/* Where friction turns faster than the body gets on, for a load that grows from what the face holds moves it as the
 * square of time, no polynomial follows: with the acceleration of the middle of a time so short that it does not count
 * as motion yet. */
static bool creep(const imp_face_motion *motion, const double *y, double longest, imp_face_path *path)
{
    const double aim = IMP_FACE_SET_OUT * motion->still;
    double a[MOVING], then[IMP_FACE_STATE], speed = INFINITY, h = longest;
    imp_face_load load;
    for (int round = 0; round < IMP_FACE_BEGINS && speed > 2 * aim; round++) {
        imp_face_balance balance;
        memcpy(then, y, sizeof then);
        then[IMP_FACE_TIME] += 0.5 * h;
        const bool goes = goes_from_rest(motion, then, a, &balance);
        speed = goes ? h * qvec3_norm((qvec3){a[0], a[1], motion->gyration * a[2]}) : INFINITY;
        if (speed > 2 * aim) h *= goes ? sqrt(aim / speed) : 0.5;
    }
    if (!(speed <= 2 * aim) || !imp_face_load_at(motion, then, &load)) return false;
    set_off(motion, y, a, h, path);
    path->c[0][IMP_FACE_PUSHED] += h * load.power, path->c[1][IMP_FACE_PUSHED] = h * load.power;
    path->c[0][IMP_FACE_DAMPED] += h * load.damping, path->c[1][IMP_FACE_DAMPED] = h * load.damping;
    return true;
}

/* In which it turns no farther than a step may. */
static bool step_from_rest(const imp_face_motion *motion, const double *y, double *length, imp_face_path *path)
{
    imp_face_motion begun = *motion;
    imp_face_balance balance;
    double a[MOVING];
    if (!goes_from_rest(motion, y, a, &balance)) return false;
    begun.clock = 1 / sqrt(motion->load.press);
    const double turns = fmax(sqrt(0.5 * hypot(a[2], a[3]) / IMP_FACE_TURN), turning_rate(y) / IMP_FACE_TURN),
                 longest = fmin(motion->loads ? motion->longest : INFINITY, fmin(1 / turns, *length * begun.clock));
    *length = longest / begun.clock;
    const bool found = step_within(&begun, y, *length, IMP_FACE_FIRST * *length, length, path);
    *length = IMP_FACE_LONGEST;
    /* what it has gained by then is to count as motion, or it would be begun anew */
    const bool counts = found && !(imp_face_speed(motion, path->c[0]) <= motion->still);
    return counts || creep(motion, y, longest, path) || found;
}

/* How far the centre of turning is within the face's border; INFINITY: there is none, or it is a line's. */
static double center_spare(const imp_face_motion *motion, const double *y)
{
    double v[2];
    imp_face_turn(&y[IMP_FACE_V], -y[IMP_FACE_ANGLE], v);
    const double center[2] = {-v[1] / y[IMP_FACE_W], v[0] / y[IMP_FACE_W]};
    return motion->rolling > 0 || y[IMP_FACE_W] == 0 ? INFINITY : imp_face_spare(&motion->face, center);
}

/* tau of a step towards where the centre of turning crosses the border, d away: there friction has d^2 log d, which a
 * polynomial follows no farther than to a part of the way; what is next to it goes there. */
static double longest_to_border(const imp_face_motion *motion, const double *y)
{
    double rate[IMP_FACE_STATE], then[IMP_FACE_STATE];
    imp_face_balance balance = {.p = {0}};
    if (motion->rolling > 0 || !rates_in_tau(motion, y, rate, &balance)) return INFINITY;
    for (int n = 0; n < IMP_FACE_STATE; n++) then[n] = y[n] + IMP_FACE_DIFFERENCE * rate[n];
    const double spare = center_spare(motion, y), closes = (spare - center_spare(motion, then)) / IMP_FACE_DIFFERENCE,
                 way = spare / closes;
    if (!(way > 0)) return INFINITY;
    return way < IMP_FACE_NEARS ? fmax(way, 0.1 * IMP_FACE_NEARS) : fmax(IMP_FACE_TOWARDS * way, IMP_FACE_NEARS);
}

bool imp_face_motion_step(const imp_face_motion *motion, const double *y, double *length, imp_face_path *path)
{
    if (!(imp_face_speed(motion, y) > 0)) return step_from_rest(motion, y, length, path);
    const double turns = turning_rate(y) * clock_of(motion, y);
    const bool own = motion->loads || motion->rolling > 0; /* a line may turn slower, or faster, than it slides */
    const double longest = own ? longest_in_tau(motion, y) : IMP_FACE_TURN / fmax(turns, IMP_FACE_TURN);
    return step_within(motion, y, fmin(longest, longest_to_border(motion, y)), IMP_FACE_SHORTEST, length, path);
}

double imp_face_end_miss(const imp_face_motion *motion, const imp_face_path *path)
{
    double begin[IMP_FACE_STATE], unit[IMP_FACE_STATE], rate[IMP_FACE_STATE], most = 0;
    imp_face_balance balance = {.p = {0}};
    if (path->length <= IMP_FACE_JUMP || (motion->rolling > 0 && !motion->loads)) return 0;
    imp_face_motion own = *motion;
    own.clock = path->clock;
    imp_face_at(path, -1, begin);
    measure(motion, path->clock > 0 ? path->c[0] : begin, unit);
    if (!rates_in_tau(&own, path->c[0], rate, &balance)) return 0;
    for (int n = 0; n < IMP_FACE_STATE; n++)
        most = fmax(most, fabs(path->length * rate[n] - path->c[1][n]) / (unit[n] * IMP_FACE_TOLERANCE));
    return most;
}
