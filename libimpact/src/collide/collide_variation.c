/* SPDX-License-Identifier: MIT
 *
 * How an impact's impulse P follows a parameter k (an entry of M, of u-, friction, restitution), to first order. Since
 * u = u- + M P, all that varies at a given normal impulse p is the tangential impulse: D = dP_t/dk at fixed p, and then
 * du/dk = du-/dk + dM/dk P + M (D, 0).
 *
 * Along a slip of direction e = u_t/s that turns, in tau (d tau = dp/s), where the equation is regular also as s -> 0,
 *
 *   delta' = ds M_tz - mu M_tt delta + s dM_tz - mu dM_tt u_t - dmu M_tt u_t,   ds = e . delta,   delta = du_t
 *
 * (Leine & Nijmeijer 2004), by the same Taylor steps as u_t; dp = int ds and dP_t = -int (dmu u_t + mu delta) then give
 * D = dP_t + mu e dp. Straight along e, with t across, S = s0 + R p, kappa = mu t.M_tt t and f = dM xi + M dxi,
 * xi = (-mu e, 1):
 *
 *   q = t . delta:  dq/dp = f_t - kappa q/S,   dD/dp = -dmu e - mu t q/S:   exponentials in tau and their integrals.
 *
 * A stop is at tau = infinity for all neighbours alike. What follows it: sticking, u_t = 0, so that D is known without
 * the past; or sliding on along one direction, begun at p_s where dp_s = -ds/R: delta = -R+ e+ dp_s there.
 * The events: dp = -du_z/Z at a turn of u_z; p_f = (1 + eps) p_c; u_z = -eps u_z-; or W = (1 - eps^2) W_low, W being
 * the normal work and W_low the least it was at a turn. Where u_z only touches 0, or the law's value (Z = 0), the
 * event's time has no derivative, and neither has the answer. Where the law is met just as the contact would be
 * compressed again (u_z = 0, Z < 0) the answer jumps.
 */
#include "collide/collide_variation.h"

#include <float.h>
#include "base/tolerances.h"
#include "collide/collide_swerve.h"
#include "collide/collide_series.h"

enum { VARIED = IMP_BY_EPS }; /* restitution takes part in the last event only */

/* Of the impulse: what is left of a slip's way to u_t = 0 is taken as straight where its turning is that much. */
#ifdef IMP_SECOND
static const imp_real tail_part = IMP_COLLIDE_TAIL_SECOND;
#else
static const imp_real tail_part = IMP_COLLIDE_TAIL;
#endif

/* The impact so far. */
typedef struct drift {
    const imp_course *start;
    const imp_frame *frame;
    imp_real mu;
    imp_real P[3], x, y, s, uz;
    imp_line line;       /* dP_t/dp and Z where it stands */
    imp_real terms;      /* of Z, where they may cancel */
    imp_real low, above; /* W_low, and W - W_low */
    imp_real p_c;        /* sum of p over turns to restitution, less the others' */
    imp_real D[VARIED][2], low_by[VARIED], above_by[VARIED], p_c_by[VARIED];
    imp_real turn_by[VARIED], turn_p; /* of the last turn */
    bool tied;
} drift;

/* ---- what a parameter is ---- */

/* dM/dk P */
static void mass_change(imp_parameter k, const imp_real P[3], imp_real out[3])
{
    static const signed char row[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
    out[0] = out[1] = out[2] = 0;
    if (k > IMP_BY_YZ) return;
    const int i = row[k][0], j = row[k][1];
    out[i] = P[j];
    out[j] = P[i];
}

/* M P */
static void mass_times(const imp_frame *m, const imp_real P[3], imp_real out[3])
{
    out[0] = m->a * P[0] + m->c * P[2];
    out[1] = m->b * P[1] + m->d * P[2];
    out[2] = m->c * P[0] + m->d * P[1] + P[2];
}

/* du/dk at fixed p. */
static void velocity_by(const drift *d, int k, imp_real out[3])
{
    imp_real moved[3];
    const imp_real D[3] = {d->D[k][0], d->D[k][1], 0};
    mass_change((imp_parameter)k, d->P, out);
    mass_times(d->frame, D, moved);
    for (int i = 0; i < 3; i++) out[i] += moved[i] + (k == IMP_BY_UX + i);
}

/* D for a wanted du_t. */
static void set_slip(drift *d, int k, imp_real x, imp_real y)
{
    imp_real out[3];
    mass_change((imp_parameter)k, d->P, out);
    d->D[k][0] = (x - out[0] - (k == IMP_BY_UX)) / d->frame->a;
    d->D[k][1] = (y - out[1] - (k == IMP_BY_UY)) / d->frame->b;
}

/* ---- straight pieces ---- */

static void follow_line(drift *d, const imp_line *line, const imp_swerve *sw, imp_real dp)
{
    const imp_real mu = d->mu, x = line->x, y = line->y, xi[3] = {-mu * x, -mu * y, 1};
    const imp_frame *m = d->frame;
    for (int k = 0; k < VARIED; k++) {
        imp_real u[3], f[3];
        velocity_by(d, k, u);
        mass_change((imp_parameter)k, xi, f);
        const imp_real rub = k == IMP_BY_MU;
        f[0] -= rub * m->a * x;
        f[1] -= rub * m->b * y;
        f[2] -= rub * (m->c * x + m->d * y);
        const imp_real q = x * u[1] - y * u[0], across = x * f[1] - y * f[0];
        const imp_real Q = mu * (q * sw->once + across * sw->again), QQ = mu * (q * sw->twice + across * sw->thrice);
        d->D[k][0] += y * Q - rub * x * dp;
        d->D[k][1] -= x * Q + rub * y * dp;
        d->above_by[k] += dp * (u[2] + f[2] * dp / 2) - (m->d * x - m->c * y) * QQ;
    }
    d->above += dp * (d->uz + line->Z * dp / 2);
    d->P[0] += line->gx * dp;
    d->P[1] += line->gy * dp;
    d->P[2] += dp;
    d->uz += line->Z * dp;
    d->s = imp_larger(d->s + line->R * dp, 0);
    d->x = d->s * x;
    d->y = d->s * y;
    d->line = *line;
    d->terms = d->frame->k + imp_abs(line->Z - d->frame->k);
}

/* How fast the direction across the slip is pulled back. */
static imp_real stiffness(const drift *d, const imp_line *line)
{
    return d->mu * (d->frame->a * line->y * line->y + d->frame->b * line->x * line->x);
}

static void slide_straight(drift *d, imp_real x, imp_real y, imp_real dp)
{
    const imp_line line = imp_course_straight_line(d->frame, d->mu, x, y);
    const imp_swerve sw = imp_swerve_over(d->s, line.R, stiffness(d, &line), dp);
    follow_line(d, &line, &sw, dp);
}

/* False: it does not stop. */
static bool slide_to_rest(drift *d, const imp_line *line)
{
    if (!(line->R < 0)) return false;
    const imp_swerve sw = imp_swerve_to_rest(d->s, line->R, stiffness(d, line));
    follow_line(d, line, &sw, -d->s / line->R);
    d->s = d->x = d->y = 0;
    return true;
}

/* ---- slip that turns ---- */

/* A parameter's series in sigma: delta, ds, and du_z, of which the constant is given. */
typedef struct varied {
    imp_real x[IMP_SERIES_ROOM], y[IMP_SERIES_ROOM], s[IMP_SERIES_ROOM], uz[IMP_SERIES_ROOM];
} varied;

/* Term n of (u_t . delta)/s. */
static imp_real speed_term(const imp_taylor *ty, const varied *v, int n)
{
    imp_real sum = ty->x[0] * v->x[n] + ty->y[0] * v->y[n];
    for (int i = 1; i <= n; i++) sum += ty->x[i] * v->x[n - i] + ty->y[i] * v->y[n - i] - ty->s[i] * v->s[n - i];
    return sum / ty->s[0];
}

static void vary_step(const drift *d, const imp_taylor *ty, int k, varied *v)
{
    const imp_frame *m = d->frame;
    const imp_real mu = d->mu, rate = ty->rate, rub = k == IMP_BY_MU;
    imp_real u[3];
    velocity_by(d, k, u);
    v->x[0] = u[0];
    v->y[0] = u[1];
    v->uz[0] = u[2];
    for (int n = 0; n <= ty->order; n++) {
        v->s[n] = speed_term(ty, v, n);
        const imp_real P[3] = {-mu * ty->x[n], -mu * ty->y[n], ty->s[n]},
                       moved[3] = {-rub * ty->x[n] - mu * v->x[n], -rub * ty->y[n] - mu * v->y[n], v->s[n]};
        imp_real f[3], g[3];
        mass_change((imp_parameter)k, P, f);
        mass_times(m, moved, g);
        const imp_real part = rate / (n + 1);
        v->x[n + 1] = part * (f[0] + g[0]);
        v->y[n + 1] = part * (f[1] + g[1]);
        v->uz[n + 1] = part * (f[2] + g[2]);
    }
}

/* int_0^h (u_z ds + s du_z) d tau, the change of the normal work. */
static imp_real work_by(const imp_taylor *ty, const varied *v, const imp_real *uz, imp_real h)
{
    imp_real product[IMP_SERIES_ROOM];
    for (int n = 0; n <= ty->order; n++) {
        product[n] = 0;
        for (int i = 0; i <= n; i++) product[n] += uz[i] * v->s[n - i] + ty->s[i] * v->uz[n - i];
    }
    product[ty->order + 1] = 0;
    return ty->rate * imp_taylor_integral(product, ty->order, h);
}

static imp_real work_of(const imp_taylor *ty, const imp_real *uz, imp_real h)
{
    imp_real product[IMP_SERIES_ROOM];
    for (int n = 0; n <= ty->order; n++) {
        product[n] = 0;
        for (int i = 0; i <= n; i++) product[n] += uz[i] * ty->s[n - i];
    }
    product[ty->order + 1] = 0;
    return ty->rate * imp_taylor_integral(product, ty->order, h);
}

/* sigma where p has grown by dp, h at most: Newton, s > 0. */
static imp_real sigma_of(const imp_taylor *ty, imp_real dp)
{
    imp_real t = ty->h;
    for (int i = 0; i < 60; i++) {
        const imp_real over = ty->rate * imp_taylor_integral(ty->s, ty->order, t) - dp;
        if (i == 0 && over <= 0) return t;
        const imp_real by = over / (ty->rate * imp_taylor_value(ty->s, ty->order, t));
        t = imp_smaller(imp_larger(t - by, 0), ty->h);
        if (imp_abs(by) <= 2 * IMP_EPSILON * ty->h) break;
    }
    return t;
}

/* One Taylor step of at most dp. */
static void slide_step(drift *d, imp_real dp)
{
    imp_taylor ty;
    varied v;
    imp_real uz[IMP_SERIES_ROOM] = {d->uz};
    const imp_frame *m = d->frame;
    const imp_real mu = d->mu;
    imp_taylor_make(&ty, m, mu, d->x, d->y, d->s, IMP_SERIES_ORDER);
    const int n = ty.order;
    for (int i = 0; i <= n; i++) uz[i + 1] = ty.climb[i] / (i + 1);
    const imp_real h = sigma_of(&ty, dp), px = ty.rate * imp_taylor_integral(ty.x, n, h),
                   py = ty.rate * imp_taylor_integral(ty.y, n, h);
    const imp_real to_x = imp_taylor_value(ty.x, n, h), to_y = imp_taylor_value(ty.y, n, h),
                   to_s = imp_sqrt(to_x * to_x + to_y * to_y), ex = to_x / to_s, ey = to_y / to_s;
    const imp_real to_uz = d->uz + imp_taylor_integral(ty.climb, n, h);
    for (int k = 0; k < VARIED; k++) {
        vary_step(d, &ty, k, &v);
        v.x[n + 1] = v.y[n + 1] = v.s[n + 1] = 0;
        const imp_real p = ty.rate * imp_taylor_integral(v.s, n, h), rub = k == IMP_BY_MU;
        d->D[k][0] += mu * (ex * p - ty.rate * imp_taylor_integral(v.x, n, h)) - rub * px;
        d->D[k][1] += mu * (ey * p - ty.rate * imp_taylor_integral(v.y, n, h)) - rub * py;
        if (d->start->law == IMPACT_STRONGE) d->above_by[k] += work_by(&ty, &v, uz, h) - to_uz * p;
    }
    d->above += work_of(&ty, uz, h);
    d->P[0] -= mu * px;
    d->P[1] -= mu * py;
    d->P[2] += ty.rate * imp_taylor_integral(ty.s, n, h);
    d->x = to_x;
    d->y = to_y;
    d->s = to_s;
    d->uz = to_uz;
    d->line = imp_course_sliding(m, mu, ex, ey);
    d->terms = 1 + imp_abs(1 - d->line.Z);
}

/* Whether what is left of the way to u_t = 0 may be taken as a straight line: it is short, or turns by little, beside
 * p. */
static bool nearly_stopped(const drift *d, imp_real x, imp_real y, imp_real p, imp_line *line)
{
    const imp_frame *m = d->frame;
    const imp_real T = imp_course_turning(m, d->mu, x, y), most = tail_part * p;
    const imp_real slope = -(m->c * x + m->d * y) + d->mu * (m->a - m->b) * (x * x - y * y);
    *line = imp_course_sliding(m, d->mu, x, y);
    line->x = x;
    line->y = y;
    if (d->s <= -line->R * most) return true;
    const imp_real turn = imp_abs(T / slope);
    if (!(line->R < 0 && slope < 0 && turn < IMP_COLLIDE_TAIL_TURN && turn * d->s <= -line->R * most)) return false;
    const imp_real to_x = x + T / slope * y, to_y = y - T / slope * x, f = 1 / imp_sqrt(to_x * to_x + to_y * to_y);
    *line = imp_course_straight_line(m, d->mu, to_x * f, to_y * f);
    return true;
}

/* Slides until p, or to u_t = 0. */
static bool vary_slip(drift *d, imp_real p, bool stops)
{
    for (int steps = 0; steps < IMP_SERIES_STEPS; steps++) {
        const imp_real left = p - d->P[2];
        if (!stops && left <= IMP_EPSILON * p) return true;
        if (d->mu == 0) {
            const imp_line line = {.Z = 1};
            const imp_swerve none = {0, 0, 0, 0};
            follow_line(d, &line, &none, left);
            return true;
        }
        const imp_real x = d->x / d->s, y = d->y / d->s;
        const bool straight = imp_course_is_straight(d->frame, d->mu, x, y);
        if (straight && !stops) {
            slide_straight(d, x, y, left);
            return true;
        }
        imp_line line;
        if (stops && straight) line = imp_course_straight_line(d->frame, d->mu, x, y);
        if (stops && (straight || nearly_stopped(d, x, y, p, &line))) return slide_to_rest(d, &line);
        slide_step(d, stops ? INFINITY : left);
        if (!imp_is_finite(d->s + d->P[2] + d->uz) || d->s == 0) return false;
    }
    return false;
}

/* ---- from u_t = 0 ---- */

/* D of what sticks: du_t = 0. */
static bool vary_stick(drift *d, imp_real p)
{
    const imp_line line = imp_course_from_rest(d->frame, d->mu);
    const imp_real dp = p - d->P[2];
    if (!line.stick) return false;
    imp_real from[VARIED], u[3];
    for (int k = 0; k < VARIED; k++) {
        set_slip(d, k, 0, 0);
        velocity_by(d, k, u);
        from[k] = u[2];
    }
    d->P[0] += line.gx * dp;
    d->P[1] += line.gy * dp;
    d->P[2] = p;
    d->above += dp * (d->uz + line.Z * dp / 2);
    d->uz += line.Z * dp;
    d->line = line;
    d->terms = 0;
    for (int k = 0; k < VARIED; k++) {
        set_slip(d, k, 0, 0);
        velocity_by(d, k, u);
        d->above_by[k] += dp * (from[k] + u[2]) / 2;
    }
    return true;
}

/* False: friction holds. Slides from u_t = 0 until p. From rest at the start du_t counts along the slip (in the norm of
 * M_tt^-1, in which neighbours never part); after a stop it is what the stop's time leaves. */
static bool vary_restart(drift *d, imp_real p)
{
    const imp_frame *m = d->frame;
    const imp_line line = imp_course_from_rest(m, d->mu);
    const imp_real x = line.x, y = line.y, dp = p - d->P[2];
    if (line.stick) return false;
    for (int k = 0; k < VARIED; k++) {
        imp_real u[3];
        velocity_by(d, k, u);
        const imp_real along = d->P[2] > 0 ? line.R * (d->line.x * u[0] + d->line.y * u[1]) / d->line.R
                                           : (x * u[0] / m->a + y * u[1] / m->b) / (x * x / m->a + y * y / m->b);
        set_slip(d, k, along * x, along * y);
    }
    const imp_swerve sw = imp_swerve_from_rest(line.R, stiffness(d, &line), dp);
    follow_line(d, &line, &sw, dp);
    d->terms = 0; /* Z > 0 is a sum of what is positive */
    return true;
}

/* ---- events ---- */

/* Ties within what rounding of the data leaves, in either precision. */
static const imp_real tie = IMP_COLLIDE_TIE * DBL_EPSILON;

static bool only_touches(const drift *d) { return imp_abs(d->line.Z) <= tie * d->terms; }

/* Whether u_z is back at 0 as the impact ends: with less friction, or more, it is compressed again. */
static bool just_ends(const drift *d)
{
    const imp_frame *m = d->frame;
    const imp_real size = 1 + d->P[2] + imp_abs(m->c * d->P[0]) + imp_abs(m->d * d->P[1]);
    return d->line.Z < 0 && d->uz <= tie * size;
}

/* Whether it had all but ended as it is compressed again. */
static bool just_goes_on(const drift *d)
{
    const imp_real eps = d->start->eps, given = d->P[2] - d->p_c;
    switch (d->start->law) {
    case IMPACT_POISSON: return eps * d->p_c - given <= tie * d->P[2];
    case IMPACT_NEWTON: return false;
    case IMPACT_STRONGE: return -eps * eps * d->low - d->above <= -tie * d->low;
    }
    return false;
}

/* u_z = 0: to restitution, or back. */
static void vary_turn(drift *d, bool to_restitution)
{
    const imp_real sign = to_restitution ? 1 : -1;
    d->tied |= only_touches(d) || (!to_restitution && just_goes_on(d));
    d->turn_p = d->P[2];
    d->p_c += sign * d->P[2];
    d->uz = 0;
    for (int k = 0; k < VARIED; k++) {
        imp_real u[3];
        velocity_by(d, k, u);
        d->turn_by[k] = -u[2] / d->line.Z;
        d->p_c_by[k] += sign * d->turn_by[k];
    }
    if (!to_restitution || d->above > 0) return;
    d->low += d->above;
    d->above = 0;
    for (int k = 0; k < VARIED; k++) {
        d->low_by[k] += d->above_by[k];
        d->above_by[k] = 0;
    }
}

/* d(p at the end)/dk. */
static imp_real end_varies(const drift *d, int k)
{
    const imp_real eps = d->start->eps, rest = k == IMP_BY_EPS;
    imp_real u[3] = {0, 0, 0};
    const bool at_turn = !(d->P[2] > d->turn_p);
    if (!rest) velocity_by(d, k, u);
    switch (d->start->law) {
    case IMPACT_POISSON: return rest ? d->p_c : (1 + eps) * d->p_c_by[k];
    case IMPACT_NEWTON: return (rest - (k == IMP_BY_UZ) * eps - u[2]) / d->line.Z;
    case IMPACT_STRONGE: break;
    }
    if (at_turn) return rest ? 0 : d->turn_by[k];
    const imp_real more = rest ? -2 * eps * d->low : -eps * eps * d->low_by[k] - d->above_by[k];
    return more / d->uz;
}

static void finish_variation(drift *d, imp_variation *v)
{
    const bool newton = d->start->law == IMPACT_NEWTON;
    v->tied = d->tied || (newton ? only_touches(d) : just_ends(d));
    for (int i = 0; i < 3; i++) v->P[i] = d->P[i];
    for (int k = 0; k < IMP_PARAMETERS; k++) {
        const imp_real dp = end_varies(d, k);
        v->by[k][0] = (k < VARIED ? d->D[k][0] : 0) + d->line.gx * dp;
        v->by[k][1] = (k < VARIED ? d->D[k][1] : 0) + d->line.gy * dp;
        v->by[k][2] = dp;
        for (int i = 0; i < 3; i++) v->tied |= !imp_is_finite(v->by[k][i]);
    }
}

static bool is_stick(unsigned char phase) { return phase == IMPACT_STICK_C || phase == IMPACT_STICK_R; }
static bool is_loading(unsigned char phase)
{
    return phase == IMPACT_SLIP_C || phase == IMPACT_STICK_C || phase == IMPACT_TANGENTIAL;
}

static bool follow_phase(drift *d, unsigned char phase, imp_real p, bool stops)
{
    if (is_stick(phase)) return vary_stick(d, p);
    return d->s == 0 && d->mu > 0 ? vary_restart(d, p) : vary_slip(d, p, stops);
}

bool imp_variation_make(const imp_course *start, const unsigned char *phases, const imp_real *reached, int count,
                        imp_variation *variation)
{
    drift d = {.start = start, .frame = start->frame, .mu = start->mu, .x = start->ux, .y = start->uy, .s = start->s};
    d.uz = start->uz;
    bool loading = true;
    for (int i = 0; i < count; i++) {
        const unsigned char phase = phases[i], next = i + 1 < count ? phases[i + 1] : phase;
        if (phase == IMPACT_REVERSAL) continue;
        if (loading != is_loading(phase)) {
            vary_turn(&d, loading);
            loading = !loading;
        }
        const bool stops = !is_stick(phase) && (is_stick(next) || next == IMPACT_REVERSAL);
        if (!follow_phase(&d, phase, reached[i], stops)) return false;
    }
    if (loading) vary_turn(&d, true);
    finish_variation(&d, variation);
    return imp_is_finite(variation->P[0] + variation->P[1] + variation->P[2]);
}
