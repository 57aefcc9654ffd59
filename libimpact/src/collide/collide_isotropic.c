/* SPDX-License-Identifier: MIT
 *
 * a = b: let x point along M_tz = (g, 0) and d tau = dp / s. Then t = tan(theta / 2) obeys dt/dtau = -g t, and with m =
 * mu a, alpha = g - m, beta = g + m,
 *
 *   s = X e^(alpha tau) + Y e^(-beta tau),   u_x = X e^(alpha tau) - Y e^(-beta tau),   u_y = u_y0 e^(-m tau),
 *   X = (s0 + u_x0) / 2,   Y = (s0 - u_x0) / 2,   4 X Y = u_y0^2:
 *
 * p, the impulse and uz are sums of I1 = int e^(alpha tau) and I2 = int e^(-beta tau), works of their products. The
 * slip ends, at tau = infinity, iff alpha < 0. uz turns once at most, where mu g > 1.
 */
#include "collide/collide_isotropic.h"
#include "base/tolerances.h"

#include <float.h>

bool imp_isotropic_is(const imp_frame *frame)
{
    return fabs(frame->a - frame->b) <= 8 * DBL_EPSILON * frame->a && fabs(frame->e) <= 4 * DBL_EPSILON * frame->a;
}

/* The slip from where the course stands. */
typedef struct whirl {
    imp_course *course;
    double ex, ey; /* x of this file, in the course's tangential frame */
    double a, g, mu, m, alpha, beta;
    double over_alpha, over_beta; /* their inverses; 0 for alpha = 0 */
    double X, Y, uy;
    double X_climb, Y_climb; /* d uz / d tau = X_climb e^(alpha tau) + Y_climb e^(-beta tau) */
} whirl;

/* At tau, INFINITY where alpha < 0: the exponentials A, B and their integrals. */
typedef struct powers {
    double A, B, I1, I2;
} powers;

static inline powers powers_at(const whirl *w, double tau)
{
    if (tau == 0) return (powers){1, 1, 0, 0};
    if (tau == INFINITY) return (powers){0, 0, -w->over_alpha, w->over_beta};
    const double B = expm1(-w->beta * tau);
    if (w->alpha == 0) return (powers){1, 1 + B, tau, -B * w->over_beta};
    const double A = expm1(w->alpha * tau);
    return (powers){1 + A, 1 + B, A * w->over_alpha, -B * w->over_beta};
}

/* int_0^d e^(k t) dt for a small k d. */
static inline double little(double k, double d)
{
    const double x = k * d;
    return d * (1 + x * (0.5 + x * ((1.0 / 6) + x * (1.0 / 24))));
}

/* From one tau to another. */
static inline powers powers_on(const whirl *w, const powers *at, double from, double to)
{
    const double d = to - from;
    if (!(fabs(d) * w->beta < IMP_COLLIDE_SHORT_STEP)) return powers_at(w, to);
    const double up = at->A * little(w->alpha, d), down = at->B * little(-w->beta, d);
    return (powers){at->A + w->alpha * up, at->B - w->beta * down, at->I1 + up, at->I2 + down};
}

/* 1 - e^(-m tau), which is 1 - sqrt(A B) where that is as good: A and B are right to rounding of 1. */
static inline double shed_by(const whirl *w, const powers *at, double tau)
{
    const double x = w->m * tau;
    return x > 0.25 && at->A > 0.25 && at->B > 0.25 ? 1 - sqrt(at->A * at->B) : -expm1(-x);
}

/* int_0^tau e^(-2 m t) dt */
static inline double integral_of_both(const whirl *w, double shed) { return shed * (2 - shed) / (2 * w->m); }

/* int I2 dI1 - int I1 dI2 = tau^3 2 g f[-beta tau, -2 m tau, alpha tau], f(x) = (e^x - 1) / x: its divided difference
 * as a series where the plain difference would cancel. */
static double swirl(const whirl *w, const powers *at, double tau, double I3)
{
    const double y = -w->beta * tau;
    if (y < -0.5) return 2 * (at->I1 - I3) * w->over_beta - at->I1 * at->I2;
    const double x = w->alpha * tau, z = x + y;
    const double e1 = x + y + z, e2 = x * y + z * z, e3 = x * y * z;
    /* h: complete homogeneous polynomials of x, y, z. */
    double h = 1, h1 = 0, h2 = 0, factor = 1.0 / 6, sum = factor;
    for (int k = 4; k < 24 && fabs(h * factor) > IMP_COLLIDE_LAST_TERM; k++) {
        const double next = e1 * h - e2 * h1 + e3 * h2;
        h2 = h1;
        h1 = h;
        h = next;
        factor /= k;
        sum += h * factor;
    }
    return tau * tau * tau * 2 * w->g * sum;
}

/* ---- what the laws look at ---- */

static double p_at(const whirl *w, const powers *at) { return w->X * at->I1 + w->Y * at->I2; }
static double rise_at(const whirl *w, const powers *at) { return w->X_climb * at->I1 + w->Y_climb * at->I2; }

static double work_at(const whirl *w, const powers *at, double tau, double I3)
{
    const double both = at->I1 * at->I2 + w->mu * w->g * swirl(w, at, tau, I3);
    return w->course->uz * p_at(w, at) + 0.5 * w->X * w->X_climb * at->I1 * at->I1 +
           0.5 * w->Y * w->Y_climb * at->I2 * at->I2 + w->X * w->Y * both;
}

typedef enum sought { SOUGHT_UZ, SOUGHT_P, SOUGHT_WORK } sought;

/* A function of tau less what is wanted, and its first two derivatives; the first by the shares of its two
 * exponentials. */
typedef struct jet {
    double value, first[2], second;
} jet;

static jet value_at(const whirl *w, sought what, double wanted, const powers *at, double tau)
{
    const double s1 = w->X * at->A, s2 = w->Y * at->B, z1 = w->X_climb * at->A, z2 = w->Y_climb * at->B;
    const double bend_s = w->alpha * s1 - w->beta * s2;
    switch (what) {
    case SOUGHT_UZ: return (jet){(w->course->uz - wanted) + rise_at(w, at), {z1, z2}, w->alpha * z1 - w->beta * z2};
    case SOUGHT_P: return (jet){p_at(w, at) - wanted, {s1, s2}, bend_s};
    case SOUGHT_WORK: break;
    }
    const double uz = w->course->uz + rise_at(w, at);
    const double I3 = integral_of_both(w, shed_by(w, at, tau));
    return (jet){work_at(w, at, tau, I3) - wanted, {uz * s1, uz * s2}, (z1 + z2) * (s1 + s2) + uz * bend_s};
}

/* tau further by so much that the integral of the larger exponential grows by `more` of its present rate: Newton's step
 * in the variable in which the function is nearly straight. NaN or infinite where that is never. */
static double step_on(const whirl *w, bool first, double tau, double more)
{
    if (first) return tau + (w->alpha == 0 ? more : log1p(w->alpha * more) * w->over_alpha);
    return tau - log1p(-w->beta * more) * w->over_beta;
}

/* Halley's step, and about how far it misses the root: (f''^2/4 f'^2 - f'''/6 f') d^3, the third derivative at most
 * beta^2 times what the exponentials' shares of the first come to. Newton's as above where that is no better, with no
 * such bound. */
static double step_from(const whirl *w, const jet *f, double tau, double *miss)
{
    const double inverse = 1 / (f->first[0] + f->first[1]), t = -f->value * inverse, bend = f->second * inverse;
    *miss = INFINITY;
    if (!(tau > 0 && fabs(t * bend) < 1)) return step_on(w, fabs(f->first[0]) >= fabs(f->first[1]), tau, t);
    const double d = t / (1 + 0.5 * t * bend), shares = (fabs(f->first[0]) + fabs(f->first[1])) * fabs(inverse);
    *miss = fabs(d * d * d) * (bend * bend + w->beta * w->beta * shares);
    return tau + d;
}

/* The root of a function that is monotone on [low, high] and has another sign at high, from `start` inside a bracket; a
 * step that misses it by no more than rounding is the last. *at: the exponentials there. */
static double find_tau(const whirl *w, sought what, double wanted, double low, double high, double start, powers *at)
{
    double tau = start, miss;
    *at = powers_at(w, low);
    jet f = value_at(w, what, wanted, at, low);
    if (f.value == 0) return low;
    const bool from_above = f.value > 0;
    for (int i = 0; i < 200; i++) {
        if (tau > low) {
            *at = powers_at(w, tau);
            f = value_at(w, what, wanted, at, tau);
            if (f.value == 0) return tau;
            *((f.value > 0) == from_above ? &low : &high) = tau;
        }
        const double last = tau;
        tau = step_from(w, &f, last, &miss);
        if (!(tau >= low && tau <= high && tau < INFINITY)) {
            tau = high < INFINITY ? 0.5 * (low + high) : 2 * low + 1 / w->beta;
            miss = INFINITY;
        }
        if (fabs(tau - last) <= 2 * DBL_EPSILON * tau || miss <= DBL_EPSILON * tau) {
            *at = powers_on(w, at, last, tau);
            break;
        }
    }
    return tau;
}

/* ---- the way from event to event ---- */

static void start(whirl *w, imp_course *course)
{
    const imp_frame *frame = course->frame;
    const double c = frame->c, d = frame->d;
    w->course = course;
    w->a = 0.5 * (frame->a + frame->b);
    w->g = sqrt(c * c + d * d);
    w->mu = course->mu;
    w->m = w->mu * w->a;
    w->alpha = w->g - w->m;
    w->beta = w->g + w->m;
    w->over_alpha = w->alpha == 0 ? 0 : 1 / w->alpha;
    w->over_beta = 1 / w->beta;
    w->ex = c / w->g;
    w->ey = d / w->g;
    const double along = w->ex * course->ux + w->ey * course->uy;
    w->uy = w->ex * course->uy - w->ey * course->ux;
    /* The small one of X and Y from their product: no cancellation. */
    const double large = 0.5 * (course->s + fabs(along)), small = 0.25 * w->uy * w->uy / large;
    w->X = along > 0 ? large : small;
    w->Y = along > 0 ? small : large;
}

/* The rates of uz; where it turns from rising to falling: INFINITY if not from here on. */
static double find_turn(whirl *w)
{
    const double pull = w->mu * w->g;
    w->X_climb = (1 - pull) * w->X;
    w->Y_climb = (1 + pull) * w->Y;
    return w->X_climb < 0 && w->X_climb + w->Y_climb > 0 ? log(w->Y_climb / -w->X_climb) / (2 * w->g) : INFINITY;
}

/* Moves on to tau within one phase; INFINITY: to the end of the slip. */
static void move_to_tau(whirl *w, double tau, const powers *at)
{
    if (!(tau > 0)) return;
    imp_course *course = w->course;
    const double shed = shed_by(w, at, tau), I3 = integral_of_both(w, shed);
    const double along = w->mu * (w->Y * at->I2 - w->X * at->I1), over = -w->uy * shed / w->a;
    const double squares = w->X * w->X * at->I1 * (1 + at->A) / 2 + w->Y * w->Y * at->I2 * (1 + at->B) / 2;
    imp_course_phase(course, course->compressing ? IMPACT_SLIP_C : IMPACT_SLIP_R);
    imp_course_book(course, p_at(w, at), work_at(w, at, tau, I3), -w->mu * (squares + 2 * w->X * w->Y * I3));
    course->px += w->ex * along - w->ey * over;
    course->py += w->ey * along + w->ex * over;
    imp_course_reach(course, course->uz + rise_at(w, at));
    w->X *= at->A;
    w->Y *= at->B;
    w->uy *= 1 - shed;
    course->ux = w->ex * (w->X - w->Y) - w->ey * w->uy;
    course->uy = w->ey * (w->X - w->Y) + w->ex * w->uy;
}

/* Where to start looking for the end by Stronge's law: uz may be 0 here, and the work then has no slope. */
static double guess_work(const whirl *w, double more)
{
    const double s = w->X + w->Y, rate = (w->X_climb + w->Y_climb) / s, uz = w->course->uz;
    const double root = uz * uz + 2 * rate * more;
    const double tau = step_on(w, w->X >= w->Y, 0, root > 0 ? 2 * more / (uz + sqrt(root)) / s : 0);
    return tau > 0 && tau < INFINITY ? tau : 0;
}

/* In restitution, uz >= 0 up to `to`: whether the impact ends by then, and where; the exponentials at both. */
static bool ends_by(const whirl *w, double to, const powers *at_to, double *where, powers *at)
{
    const imp_course *course = w->course;
    const bool poisson = course->law == IMPACT_POISSON, newton = course->law == IMPACT_NEWTON;
    const double wanted = poisson  ? imp_course_left_poisson(course)
                          : newton ? imp_course_target_newton(course)
                                   : imp_course_left_stronge(course);
    *where = 0;
    *at = (powers){1, 1, 0, 0};
    if (newton ? course->uz >= wanted : wanted <= 0) return true;
    const sought what = poisson ? SOUGHT_P : newton ? SOUGHT_UZ : SOUGHT_WORK;
    /* Without end nothing is out of reach but where sliding stops. */
    if (to < INFINITY || w->alpha < 0) {
        if (value_at(w, what, wanted, at_to, to).value < 0) return false;
    }
    *where = find_tau(w, what, wanted, 0, to, what == SOUGHT_WORK ? guess_work(w, wanted) : 0, at);
    return true;
}

void imp_isotropic_solve(imp_course *course)
{
    whirl w;
    start(&w, course);
    for (int i = 0; i < 16; i++) {
        /* To the next event. */
        double to = find_turn(&w);
        const bool without_end = to == INFINITY && w.alpha >= 0, rises = w.X_climb + w.Y_climb > 0;
        powers at = without_end ? (powers){NAN, NAN, NAN, NAN} : powers_at(&w, to);
        const double uz_to = without_end ? INFINITY : course->uz + rise_at(&w, &at);
        const bool turns = course->compressing ? rises && uz_to >= 0 : !rises && uz_to < 0;
        if (turns) to = find_tau(&w, SOUGHT_UZ, 0, 0, to, 0, &at);
        double where;
        powers at_end;
        if (!course->compressing && ends_by(&w, to, &at, &where, &at_end)) {
            move_to_tau(&w, where, &at_end);
            if (course->law == IMPACT_NEWTON) course->uz = imp_course_target_newton(course);
            course->ended = true;
            return;
        }
        move_to_tau(&w, to, &at);
        if (turns)
            imp_course_turn(course);
        else if (to == INFINITY)
            break;
    }
    imp_course_finish(course);
}
