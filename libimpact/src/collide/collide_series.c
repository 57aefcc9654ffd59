/* SPDX-License-Identifier: MIT
 *
 * With d tau = dp / s, s = |u_t|, sliding is  du_t/dtau = s M_tz - mu M_tt u_t,  dp/dtau = s: Lipschitz, free of
 * angles, and regular where sliding stops. One Taylor step holds u_t, s (from s^2 = u_t . u_t), uz, p and the works as
 * polynomials of tau; the step length follows from the last coefficients (Jorba & Zou 2005).
 *
 * Events: theta turns monotonically within a slip, by far less than pi/2 in a step, so Z = d uz / dp is monotone
 * between the zeros of M_tz x u_t. Splitting a step there and at the zeros of Z leaves pieces on which uz is monotone:
 * no event can be missed.
 */
#include "collide/collide_series.h"

#include <float.h>

static const double inverse[] = {0,        1.0,      1.0 / 2,  1.0 / 3,  1.0 / 4,  1.0 / 5,  1.0 / 6,
                                 1.0 / 7,  1.0 / 8,  1.0 / 9,  1.0 / 10, 1.0 / 11, 1.0 / 12, 1.0 / 13,
                                 1.0 / 14, 1.0 / 15, 1.0 / 16, 1.0 / 17, 1.0 / 18, 1.0 / 19, 1.0 / 20,
                                 1.0 / 21, 1.0 / 22, 1.0 / 23, 1.0 / 24, 1.0 / 25, 1.0 / 26, 1.0 / 27,
                                 1.0 / 28, 1.0 / 29, 1.0 / 30, 1.0 / 31, 1.0 / 32, 1.0 / 33, 1.0 / 34};

/* The largest h for which the last two terms stay below 2^-60 of s. */
static double step_length(const imp_taylor *taylor)
{
    const int n = taylor->order;
    double h = INFINITY;
    for (int k = n - 1; k <= n; k++) {
        const double size = imp_larger(imp_larger(fabs(taylor->x[k]), fabs(taylor->y[k])), fabs(taylor->s[k]));
        if (size > 0) h = imp_smaller(h, exp(log(taylor->s[0] / size * 0x1p-60) / k));
    }
    return h;
}

void imp_taylor_make(imp_taylor *taylor, const imp_frame *frame, double mu, double ux, double uy, double s, int order)
{
    double *x = taylor->x, *y = taylor->y, *v = taylor->s;
    const double ma = mu * frame->a, mb = mu * frame->b, c = frame->c, d = frame->d, half = 0.5 / s;
    imp_pair u[IMP_SERIES_ROOM]; /* x and y */
    const imp_pair pull = {c, d}, drag = {ma, mb};
    taylor->order = order;
    u[0] = (imp_pair){ux, uy};
    x[0] = ux;
    y[0] = uy;
    v[0] = s;
    taylor->squared[0] = s * s;
    for (int k = 0; k < order; k++) {
        const int n = k + 1;
        u[n] = (pull * v[k] - drag * u[k]) * inverse[n];
        x[n] = u[n][0];
        y[n] = u[n][1];
        /* s^2 = x^2 + y^2, term n; every product but the middle one stands twice. */
        imp_pair q = {0, 0};
        double r = 0;
        for (int i = 1; 2 * i < n; i++) {
            q += u[i] * u[n - i];
            r += v[i] * v[n - i];
        }
        q = 2 * (q + u[0] * u[n]);
        r *= 2;
        if (n % 2 == 0) {
            q += u[n / 2] * u[n / 2];
            r += v[n / 2] * v[n / 2];
        }
        taylor->squared[n] = q[0] + q[1];
        v[n] = (q[0] + q[1] - r) * half;
    }
    x[order + 1] = y[order + 1] = v[order + 1] = taylor->squared[order + 1] = taylor->climb[order + 1] = 0;
    for (int k = 0; k <= order; k++) taylor->climb[k] = v[k] - mu * (c * x[k] + d * y[k]);
    /* A straight slip at constant speed would have no end. */
    taylor->h = imp_smaller(step_length(taylor), 100 / (fabs(c) + fabs(d) + imp_larger(ma, mb)));
}

/* Even and odd terms side by side. */
double imp_taylor_value(const double *coefficient, int order, double t)
{
    const double t2 = t * t;
    int k = order - order % 2;
    imp_pair sum = IMP_PAIR(coefficient + k);
    for (k -= 2; k >= 0; k -= 2) sum = sum * t2 + IMP_PAIR(coefficient + k);
    return sum[0] + t * sum[1];
}

double imp_taylor_integral(const double *coefficient, int order, double t)
{
    const double t2 = t * t;
    int k = order - order % 2;
    imp_pair sum = IMP_PAIR(coefficient + k) * IMP_PAIR(inverse + k + 1);
    for (k -= 2; k >= 0; k -= 2) sum = sum * t2 + IMP_PAIR(coefficient + k) * IMP_PAIR(inverse + k + 1);
    return (sum[0] + t * sum[1]) * t;
}

/* ---- one step and the events in it ---- */

/* The integrals from 0 to t that the course is kept by: side by side, since each alone is a chain of dependent
 * operations. */
typedef struct totals {
    double p, work, friction, px, py;
} totals;

typedef struct step {
    imp_course *course;
    imp_taylor taylor;
    double uz0;                    /* uz at tau = 0 */
    double power[IMP_SERIES_ROOM]; /* uz s, the rate of the normal work */
    bool has_power;
    double at;   /* where the course stands in this step */
    totals done; /* from 0 to `at` */
} step;

static double uz_at(const step *st, double t)
{
    return st->uz0 + imp_taylor_integral(st->taylor.climb, st->taylor.order, t);
}

static void make_power(step *st)
{
    const int order = st->taylor.order;
    const double *s = st->taylor.s;
    double *power = st->power, uz[IMP_SERIES_ROOM];
    uz[0] = st->uz0;
    for (int k = 0; k <= order; k++) uz[k + 1] = st->taylor.climb[k] * inverse[k + 1];
    for (int k = 0; k <= order; k += 2) {
        imp_pair sum = {0, uz[k + 1] * s[0]};
        for (int i = 0; i <= k; i++) sum += uz[i] * IMP_PAIR(s + k - i);
        power[k] = sum[0];
        power[k + 1] = sum[1];
    }
    power[order + 1] = 0;
    st->has_power = true;
}

static double work_at(step *st, double t)
{
    if (!st->has_power) make_power(st);
    return imp_taylor_integral(st->power, st->taylor.order, t);
}

/* What a root is looked for of. */
typedef enum target { TARGET_UZ, TARGET_CLIMB, TARGET_CROSS, TARGET_P, TARGET_WORK } target;

static double target_value(step *st, target what, double t, double wanted, double *slope)
{
    const imp_taylor *ty = &st->taylor;
    const int n = ty->order;
    switch (what) {
    case TARGET_UZ: *slope = imp_taylor_value(ty->climb, n, t); return uz_at(st, t) - wanted;
    case TARGET_P: *slope = imp_taylor_value(ty->s, n, t); return imp_taylor_integral(ty->s, n, t) - wanted;
    case TARGET_WORK: *slope = imp_taylor_value(st->power, n, t); return work_at(st, t) - wanted;
    case TARGET_CLIMB:
        *slope = 0;
        for (int k = n; k >= 1; k--) *slope = *slope * t + k * ty->climb[k];
        return imp_taylor_value(ty->climb, n, t) - wanted;
    case TARGET_CROSS: {
        const double c = st->course->frame->c, d = st->course->frame->d;
        double sum = 0, rate = 0;
        for (int k = n; k >= 0; k--) {
            rate = rate * t + sum;
            sum = sum * t + (c * ty->y[k] - d * ty->x[k]);
        }
        *slope = rate;
        return sum - wanted;
    }
    }
    *slope = 0;
    return 0;
}

/* The root of a monotone function on [low, high] whose signs differ at the ends: Newton kept inside a shrinking
 * bracket. */
static double find_root(step *st, target what, double wanted, double low, double high)
{
    double slope, f_low = target_value(st, what, low, wanted, &slope);
    const double f_high = target_value(st, what, high, wanted, &slope);
    if (f_low == 0) return low;
    if (f_high == 0 || (f_low > 0) == (f_high > 0)) return high;
    double t = low + (high - low) * (f_low / (f_low - f_high));
    for (int i = 0; i < 80; i++) {
        const double f = target_value(st, what, t, wanted, &slope);
        if (f == 0) return t;
        if ((f > 0) == (f_low > 0))
            low = t;
        else
            high = t;
        double new_t = t - f / slope;
        if (!(new_t >= low && new_t <= high)) new_t = 0.5 * (low + high);
        const double move = fabs(new_t - t);
        t = new_t;
        if (move <= 2 * DBL_EPSILON * t) break;
    }
    return t;
}

static totals totals_at(step *st, double t)
{
    if (!st->has_power) make_power(st);
    const imp_taylor *ty = &st->taylor;
    double work = 0;
    imp_pair slide = {0, 0}, speed = {0, 0};
    for (int k = ty->order; k >= 0; k--) {
        const double f = inverse[k + 1];
        slide = slide * t + (imp_pair){ty->x[k], ty->y[k]} * f;
        speed = speed * t + (imp_pair){ty->s[k], ty->squared[k]} * f;
        work = work * t + st->power[k] * f;
    }
    const double rub = -st->course->mu * t;
    return (totals){speed[0] * t, work * t, speed[1] * rub, slide[0] * rub, slide[1] * rub};
}

/* Moves the course on to tau = t within one phase. */
static void move_to(step *st, double t)
{
    imp_course *course = st->course;
    if (!(t > st->at)) return;
    imp_course_phase(course, course->compressing ? IMPACT_SLIP_C : IMPACT_SLIP_R);
    const totals to = totals_at(st, t);
    imp_course_book(course, to.p - st->done.p, to.work - st->done.work, to.friction - st->done.friction);
    course->px += to.px - st->done.px;
    course->py += to.py - st->done.py;
    imp_course_reach(course, uz_at(st, t));
    st->done = to;
    st->at = t;
}

/* In restitution, uz >= 0 up to `to`: whether the impact ends by then, and where. */
static bool end_by(step *st, double to, double *where)
{
    const imp_course *course = st->course;
    switch (course->law) {
    case IMPACT_POISSON: {
        const double wanted = st->done.p + imp_course_left_poisson(course);
        if (wanted <= st->done.p) {
            *where = st->at;
            return true;
        }
        if (imp_taylor_integral(st->taylor.s, st->taylor.order, to) < wanted) return false;
        *where = find_root(st, TARGET_P, wanted, st->at, to);
        return true;
    }
    case IMPACT_NEWTON: {
        const double wanted = imp_course_target_newton(course);
        if (course->uz >= wanted) {
            *where = st->at;
            return true;
        }
        if (uz_at(st, to) < wanted) return false;
        *where = find_root(st, TARGET_UZ, wanted, st->at, to);
        return true;
    }
    case IMPACT_STRONGE: {
        const double more = imp_course_left_stronge(course);
        if (more <= 0) {
            *where = st->at;
            return true;
        }
        if (work_at(st, to) < st->done.work + more) return false;
        *where = find_root(st, TARGET_WORK, st->done.work + more, st->at, to);
        return true;
    }
    }
    return false;
}

/* The sense of uz on a piece where it is monotone; at a turn, uz itself is rounding. */
static bool climbs(const step *st, double to)
{
    return imp_taylor_value(st->taylor.climb, st->taylor.order, 0.5 * (st->at + to)) > 0;
}

/* Follows the course to tau = to through its events; uz is monotone on the way. */
static void monotone_piece(step *st, double to)
{
    imp_course *course = st->course;
    for (int i = 0; i < 4 && !course->ended; i++) {
        const double uz_to = uz_at(st, to);
        if (course->compressing) {
            if (uz_to < 0 || !climbs(st, to)) break;
            move_to(st, find_root(st, TARGET_UZ, 0, st->at, to));
            imp_course_turn(course);
            if (course->law == IMPACT_STRONGE) return;
            continue;
        }
        const bool turns = uz_to < 0 && !climbs(st, to);
        const double turn = turns ? find_root(st, TARGET_UZ, 0, st->at, to) : to;
        double end;
        if (end_by(st, turn, &end)) {
            move_to(st, end);
            if (course->law == IMPACT_NEWTON) course->uz = imp_course_target_newton(course);
            course->ended = true;
            return;
        }
        if (!turns) break;
        move_to(st, turn);
        imp_course_turn(course);
    }
    if (!course->ended) move_to(st, to);
}

/* A step that stops short of its end at a turn (Stronge's law) goes on as a new one: the work given back is then an
 * integral from there, and not a small difference. */
static bool stopped(const step *st, double at) { return st->course->ended || st->at < at; }

static void split_at_climb(step *st, double to)
{
    const int n = st->taylor.order;
    const double low = imp_taylor_value(st->taylor.climb, n, st->at), high = imp_taylor_value(st->taylor.climb, n, to);
    if ((low > 0 && high < 0) || (low < 0 && high > 0)) {
        const double split = find_root(st, TARGET_CLIMB, 0, st->at, to);
        monotone_piece(st, split);
        if (stopped(st, split)) return;
    }
    monotone_piece(st, to);
}

static void follow_step(step *st)
{
    imp_course *course = st->course;
    const imp_frame *frame = course->frame;
    const int n = st->taylor.order;
    const double h = st->taylor.h, x = imp_taylor_value(st->taylor.x, n, h), y = imp_taylor_value(st->taylor.y, n, h);
    const double before = frame->c * course->uy - frame->d * course->ux, after = frame->c * y - frame->d * x;
    if ((before > 0 && after < 0) || (before < 0 && after > 0)) {
        const double split = find_root(st, TARGET_CROSS, 0, 0, h);
        split_at_climb(st, split);
        if (!stopped(st, split)) split_at_climb(st, h);
    } else {
        split_at_climb(st, h);
    }
    course->ux = st->at == h ? x : imp_taylor_value(st->taylor.x, n, st->at);
    course->uy = st->at == h ? y : imp_taylor_value(st->taylor.y, n, st->at);
    course->s = sqrt(course->ux * course->ux + course->uy * course->uy);
}

/* ---- the end of a slip ---- */

typedef enum stride { STRIDE_TAKEN, STRIDE_NOT_YET, STRIDE_EVENT } stride;

/* Takes the rest of the slip in one stride, if the series reaches so far and no event lies on the way. */
static stride take_tail(imp_course *course)
{
    const imp_frame *frame = course->frame;
    const double mu = course->mu;
    imp_tail tail;
    if (!imp_tail_make(&tail, frame, mu, course->ux, course->uy, course->s, course->uz)) return STRIDE_NOT_YET;
    const double uz = course->uz + tail.rise;
    if (course->compressing ? uz >= 0 : uz < 0) return STRIDE_EVENT;
    if (!course->compressing) {
        switch (course->law) {
        case IMPACT_POISSON:
            if (tail.p >= imp_course_left_poisson(course)) return STRIDE_EVENT;
            break;
        case IMPACT_NEWTON:
            if (uz >= imp_course_target_newton(course)) return STRIDE_EVENT;
            break;
        case IMPACT_STRONGE:
            if (tail.work >= imp_course_left_stronge(course)) return STRIDE_EVENT;
            break;
        }
    }
    imp_course_phase(course, course->compressing ? IMPACT_SLIP_C : IMPACT_SLIP_R);
    imp_course_book(course, tail.p, tail.work, tail.work_f);
    course->px += tail.px;
    course->py += tail.py;
    imp_course_reach(course, uz);
    course->s = 0;
    return STRIDE_TAKEN;
}

/* Whether Z keeps its sign and uz its sense on the way to the end of the slip: then what holds at its end holds
 * on it. */
static bool tail_is_near(const imp_course *course, double x, double y)
{
    const imp_frame *frame = course->frame;
    const double mu = course->mu, along = frame->c * x + frame->d * y;
    const double R = along - mu * (frame->a * x * x + frame->b * y * y);
    const double T = imp_course_turning(frame, mu, x, y), slope = -along + mu * (frame->a - frame->b) * (x * x - y * y);
    if (!(R < 0 && slope < 0 && fabs(T) < 0.5 * -slope)) return false;
    /* Z and its slope in theta bound its change over twice the angle that Newton sees. */
    const double Z = 1 - mu * along, swing = mu * hypot(frame->c, frame->d) * 2 * fabs(T / slope);
    return fabs(Z) > swing;
}

bool imp_series_solve(imp_course *course, int order)
{
    const imp_frame *frame = course->frame;
    if (course->mu == 0) return imp_course_straight(course);
    const double mu = course->mu, small = 1e-17 * imp_smaller(course->s, 1);
    int events = -1;
    for (int steps = 0; steps < 400 && course->s > 0 && !course->ended; steps++) {
        const double x = course->ux / course->s, y = course->uy / course->s;
        if (course->s <= small || imp_course_is_straight(frame, mu, x, y)) {
            const imp_line line = imp_course_sliding(frame, mu, x, y);
            imp_course_line(course, &line, line.R < 0 ? course->s / -line.R : INFINITY);
            if (!course->ended) course->s = 0;
            break;
        }
        /* A tail with an event in it is not tried again before that event is past. */
        const int event = 2 * course->compressions + course->compressing;
        if (event != events && tail_is_near(course, x, y)) {
            const stride result = take_tail(course);
            if (result == STRIDE_TAKEN) break;
            if (result == STRIDE_EVENT) events = event;
        }
        step st; /* large: only what is not computed is set */
        st.course = course;
        st.uz0 = course->uz;
        st.has_power = false;
        st.at = 0;
        st.done = (totals){0, 0, 0, 0, 0};
        imp_taylor_make(&st.taylor, frame, mu, course->ux, course->uy, course->s, order);
        follow_step(&st);
    }
    if (!course->ended && course->s == 0) imp_course_finish(course);
    return course->ended;
}
