/* SPDX-License-Identifier: MIT
 *
 * With d tau = dp / s, s = |u_t|, sliding is  du_t/dtau = s M_tz - mu M_tt u_t,  dp/dtau = s: Lipschitz, free of
 * angles, and regular where sliding stops. One Taylor step holds u_t, s (from s^2 = u_t . u_t), uz, p and the works as
 * polynomials; the step length follows from the last coefficients (Jorba & Zou 2005).
 *
 * The variable is sigma = Lambda tau, Lambda = |c| + |d| + mu max(a, b): |du_t/dsigma| <= imp_sqrt(2) s, so that all
 * coefficients are of the size of s however small mu and M_tz are (in tau they carry Lambda^k, and underflow). While
 * u_t changes by less than (imp_sqrt(2) - 1) s, u_t . u_t does not vanish: the radius of convergence is .29 at least.
 *
 * Events: theta turns monotonically within a slip, by far less than pi/2 in a step, so Z = d uz / dp is monotone
 * between the zeros of M_tz x u_t. Splitting a step there and at the zeros of Z leaves pieces on which uz is monotone:
 * no event can be missed.
 */
#include "collide/collide_series.h"

#include "base/tolerances.h"

#define I(k) ((imp_real)1 / (k))
static const imp_real inverse[] = {0,     I(1),  I(2),  I(3),  I(4),  I(5),  I(6),  I(7),  I(8),  I(9),  I(10),
                                   I(11), I(12), I(13), I(14), I(15), I(16), I(17), I(18), I(19), I(20), I(21),
                                   I(22), I(23), I(24), I(25), I(26), I(27), I(28), I(29), I(30), I(31), I(32),
                                   I(33), I(34), I(35), I(36), I(37), I(38), I(39), I(40), I(41), I(42), I(43)};
#undef I

/* The largest h for which the last two terms stay below eps/256 of s. */
static imp_real step_length(const imp_taylor *taylor)
{
    const int n = taylor->order;
    imp_real h = IMP_COLLIDE_FARTHEST;
    for (int k = n - 1; k <= n; k++) {
        const imp_real size =
            imp_larger(imp_larger(imp_abs(taylor->x[k]), imp_abs(taylor->y[k])), imp_abs(taylor->s[k]));
        const double least = (double)(IMP_EPSILON / 256 * (taylor->s[0] / size));
        if (size > 0 && least < DBL_MAX) h = imp_smaller(h, exp(log(least) / k));
    }
    return h;
}

void imp_taylor_make(imp_taylor *taylor, const imp_frame *frame, imp_real mu, imp_real ux, imp_real uy, imp_real s,
                     int order)
{
    imp_real *x = taylor->x, *y = taylor->y, *v = taylor->s;
    const imp_real lambda = imp_abs(frame->c) + imp_abs(frame->d) + mu * imp_larger(frame->a, frame->b),
                   rate = 1 / lambda;
    const imp_real ma = mu * frame->a * rate, mb = mu * frame->b * rate, c = frame->c * rate, d = frame->d * rate;
    const imp_real half = 0.5 / s;
    imp_lanes u[IMP_SERIES_ROOM]; /* x and y */
    const imp_lanes pull = {c, d}, drag = {ma, mb};
    taylor->order = order;
    taylor->rate = rate;
    u[0] = (imp_lanes){ux, uy};
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
        imp_lanes q = {0, 0};
        imp_real r = 0;
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
    for (int k = 0; k <= order; k++) taylor->climb[k] = rate * v[k] - mu * (c * x[k] + d * y[k]);
    taylor->h = step_length(taylor);
}

/* Even and odd terms side by side. */
imp_real imp_taylor_value(const imp_real *coefficient, int order, imp_real t)
{
    const imp_real t2 = t * t;
    int k = order - order % 2;
    imp_lanes sum = IMP_LANES(coefficient + k);
    for (k -= 2; k >= 0; k -= 2) sum = sum * t2 + IMP_LANES(coefficient + k);
    return sum[0] + t * sum[1];
}

imp_real imp_taylor_integral(const imp_real *coefficient, int order, imp_real t)
{
    const imp_real t2 = t * t;
    int k = order - order % 2;
    imp_lanes sum = IMP_LANES(coefficient + k) * IMP_LANES(inverse + k + 1);
    for (k -= 2; k >= 0; k -= 2) sum = sum * t2 + IMP_LANES(coefficient + k) * IMP_LANES(inverse + k + 1);
    return (sum[0] + t * sum[1]) * t;
}

/* ---- one step and the events in it ---- */

/* The integrals from 0 to t that the course is kept by: side by side, since each alone is a chain of dependent
 * operations. */
typedef struct totals {
    imp_real p, work, friction, px, py;
} totals;

typedef struct step {
    imp_course *course;
    imp_taylor taylor;
    imp_real uz0;                    /* uz at sigma = 0 */
    imp_real power[IMP_SERIES_ROOM]; /* uz s / Lambda, the rate of the normal work */
    bool has_power;
    imp_real at; /* where the course stands in this step */
    totals done; /* from 0 to `at` */
} step;

static imp_real uz_at(const step *st, imp_real t)
{
    return st->uz0 + imp_taylor_integral(st->taylor.climb, st->taylor.order, t);
}

static void make_power(step *st)
{
    const int order = st->taylor.order;
    const imp_real *s = st->taylor.s, rate = st->taylor.rate;
    imp_real *power = st->power, uz[IMP_SERIES_ROOM];
    uz[0] = st->uz0 * rate;
    for (int k = 0; k <= order; k++) uz[k + 1] = st->taylor.climb[k] * inverse[k + 1] * rate;
    for (int k = 0; k <= order; k += 2) {
        imp_lanes sum = {0, uz[k + 1] * s[0]};
        for (int i = 0; i <= k; i++) sum += uz[i] * IMP_LANES(s + k - i);
        power[k] = sum[0];
        power[k + 1] = sum[1];
    }
    power[order + 1] = 0;
    st->has_power = true;
}

static imp_real work_until(step *st, imp_real t)
{
    if (!st->has_power) make_power(st);
    return imp_taylor_integral(st->power, st->taylor.order, t);
}

/* What a root is looked for of. */
typedef enum target { TARGET_UZ, TARGET_CLIMB, TARGET_CROSS, TARGET_P, TARGET_WORK } target;

static imp_real target_value(step *st, target what, imp_real t, imp_real wanted, imp_real *slope)
{
    const imp_taylor *ty = &st->taylor;
    const int n = ty->order;
    switch (what) {
    case TARGET_UZ: *slope = imp_taylor_value(ty->climb, n, t); return uz_at(st, t) - wanted;
    case TARGET_P:
        *slope = ty->rate * imp_taylor_value(ty->s, n, t);
        return ty->rate * imp_taylor_integral(ty->s, n, t) - wanted;
    case TARGET_WORK: *slope = imp_taylor_value(st->power, n, t); return work_until(st, t) - wanted;
    case TARGET_CLIMB:
        *slope = 0;
        for (int k = n; k >= 1; k--) *slope = *slope * t + k * ty->climb[k];
        return imp_taylor_value(ty->climb, n, t) - wanted;
    case TARGET_CROSS: {
        const imp_real c = st->course->frame->c, d = st->course->frame->d;
        imp_real sum = 0, rate = 0;
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
static imp_real find_sigma(step *st, target what, imp_real wanted, imp_real low, imp_real high)
{
    imp_real slope, f_low = target_value(st, what, low, wanted, &slope);
    const imp_real f_high = target_value(st, what, high, wanted, &slope);
    if (f_low == 0) return low;
    if (f_high == 0 || (f_low > 0) == (f_high > 0)) return high;
    imp_real t = low + (high - low) * (f_low / (f_low - f_high));
    for (int i = 0; i < 80; i++) {
        const imp_real f = target_value(st, what, t, wanted, &slope);
        if (f == 0) return t;
        if ((f > 0) == (f_low > 0))
            low = t;
        else
            high = t;
        imp_real new_t = t - f / slope;
        if (!(new_t >= low && new_t <= high)) new_t = 0.5 * (low + high);
        const imp_real move = imp_abs(new_t - t);
        t = new_t;
        if (move <= 2 * IMP_EPSILON * t) break;
    }
    return t;
}

static totals totals_at(step *st, imp_real t)
{
    if (!st->has_power) make_power(st);
    const imp_taylor *ty = &st->taylor;
    imp_real work = 0;
    imp_lanes slide = {0, 0}, speed = {0, 0};
    for (int k = ty->order; k >= 0; k--) {
        const imp_real f = inverse[k + 1];
        slide = slide * t + (imp_lanes){ty->x[k], ty->y[k]} * f;
        speed = speed * t + (imp_lanes){ty->s[k], ty->squared[k]} * f;
        work = work * t + st->power[k] * f;
    }
    const imp_real tau = ty->rate * t, rub = -st->course->mu * tau;
    return (totals){speed[0] * tau, work * t, speed[1] * rub, slide[0] * rub, slide[1] * rub};
}

/* Moves the course on to sigma = t within one phase. */
static void move_to_sigma(step *st, imp_real t)
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
static bool end_by(step *st, imp_real to, imp_real *where)
{
    const imp_course *course = st->course;
    switch (course->law) {
    case IMPACT_POISSON: {
        const imp_real wanted = st->done.p + imp_course_left_poisson(course);
        if (wanted <= st->done.p) {
            *where = st->at;
            return true;
        }
        if (st->taylor.rate * imp_taylor_integral(st->taylor.s, st->taylor.order, to) < wanted) return false;
        *where = find_sigma(st, TARGET_P, wanted, st->at, to);
        return true;
    }
    case IMPACT_NEWTON: {
        const imp_real wanted = imp_course_target_newton(course);
        if (course->uz >= wanted) {
            *where = st->at;
            return true;
        }
        if (uz_at(st, to) < wanted) return false;
        *where = find_sigma(st, TARGET_UZ, wanted, st->at, to);
        return true;
    }
    case IMPACT_STRONGE: {
        const imp_real more = imp_course_left_stronge(course);
        if (more <= 0) {
            *where = st->at;
            return true;
        }
        if (work_until(st, to) < st->done.work + more) return false;
        *where = find_sigma(st, TARGET_WORK, st->done.work + more, st->at, to);
        return true;
    }
    }
    return false;
}

/* The sense of uz on a piece where it is monotone; at a turn, uz itself is rounding. */
static bool climbs(const step *st, imp_real to)
{
    return imp_taylor_value(st->taylor.climb, st->taylor.order, 0.5 * (st->at + to)) > 0;
}

/* Follows the course to sigma = to through its events; uz is monotone on the way. */
static void monotone_piece(step *st, imp_real to)
{
    imp_course *course = st->course;
    for (int i = 0; i < 4 && !course->ended; i++) {
        const imp_real uz_to = uz_at(st, to);
        if (course->compressing) {
            if (uz_to < 0 || !climbs(st, to)) break;
            move_to_sigma(st, find_sigma(st, TARGET_UZ, 0, st->at, to));
            imp_course_turn(course);
            if (course->law == IMPACT_STRONGE) return;
            continue;
        }
        const bool turns = uz_to < 0 && !climbs(st, to);
        const imp_real turn = turns ? find_sigma(st, TARGET_UZ, 0, st->at, to) : to;
        imp_real end;
        if (end_by(st, turn, &end)) {
            move_to_sigma(st, end);
            if (course->law == IMPACT_NEWTON) course->uz = imp_course_target_newton(course);
            course->ended = true;
            return;
        }
        if (!turns) break;
        move_to_sigma(st, turn);
        imp_course_turn(course);
    }
    if (!course->ended) move_to_sigma(st, to);
}

/* A step that stops short of its end at a turn (Stronge's law) goes on as a new one: the work given back is then an
 * integral from there, and not a small difference. */
static bool stopped(const step *st, imp_real at) { return st->course->ended || st->at < at; }

static void split_at_climb(step *st, imp_real to)
{
    const int n = st->taylor.order;
    const imp_real low = imp_taylor_value(st->taylor.climb, n, st->at),
                   high = imp_taylor_value(st->taylor.climb, n, to);
    if ((low > 0 && high < 0) || (low < 0 && high > 0)) {
        const imp_real split = find_sigma(st, TARGET_CLIMB, 0, st->at, to);
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
    const imp_real h = st->taylor.h, x = imp_taylor_value(st->taylor.x, n, h), y = imp_taylor_value(st->taylor.y, n, h);
    const imp_real before = frame->c * course->uy - frame->d * course->ux, after = frame->c * y - frame->d * x;
    if ((before > 0 && after < 0) || (before < 0 && after > 0)) {
        const imp_real split = find_sigma(st, TARGET_CROSS, 0, 0, h);
        split_at_climb(st, split);
        if (!stopped(st, split)) split_at_climb(st, h);
    } else {
        split_at_climb(st, h);
    }
    course->ux = st->at == h ? x : imp_taylor_value(st->taylor.x, n, st->at);
    course->uy = st->at == h ? y : imp_taylor_value(st->taylor.y, n, st->at);
    course->s = imp_sqrt(course->ux * course->ux + course->uy * course->uy);
}

/* ---- the end of a slip ---- */

typedef enum stride { STRIDE_TAKEN, STRIDE_NOT_YET, STRIDE_EVENT } stride;

/* Takes the rest of the slip in one stride, if the series reaches so far and no event lies on the way. */
static stride take_tail(imp_course *course)
{
    const imp_frame *frame = course->frame;
    const imp_real mu = course->mu;
    imp_tail tail;
    if (!imp_tail_make(&tail, frame, mu, course->ux, course->uy, course->s, course->uz)) return STRIDE_NOT_YET;
    const imp_real uz = course->uz + tail.rise;
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
    course->s = course->ux = course->uy = 0;
    return STRIDE_TAKEN;
}

/* Whether Z keeps its sign and uz its sense on the way to the end of the slip: then what holds at its end holds
 * on it. */
static bool tail_is_near(const imp_course *course, imp_real x, imp_real y)
{
    const imp_frame *frame = course->frame;
    const imp_real mu = course->mu, along = frame->c * x + frame->d * y;
    const imp_real R = along - mu * (frame->a * x * x + frame->b * y * y);
    const imp_real T = imp_course_turning(frame, mu, x, y),
                   slope = -along + mu * (frame->a - frame->b) * (x * x - y * y);
    if (!(R < 0 && slope < 0 && imp_abs(T) < 0.5 * -slope)) return false;
    /* Z and its slope in theta bound its change over twice the angle that Newton sees. */
    const imp_real Z = 1 - mu * along, swing = mu * imp_hypot(frame->c, frame->d) * 2 * imp_abs(T / slope);
    return imp_abs(Z) > swing;
}

bool imp_series_solve(imp_course *course, int order)
{
    const imp_frame *frame = course->frame;
    if (course->mu == 0) return imp_course_straight(course);
    const imp_real mu = course->mu, small = IMP_EPSILON / 16 * imp_smaller(course->s, 1);
    int events = -1;
    for (int steps = 0; steps < IMP_SERIES_STEPS && course->s > 0 && !course->ended; steps++) {
        const imp_real x = course->ux / course->s, y = course->uy / course->s;
        if (course->s <= small || imp_course_is_straight(frame, mu, x, y)) {
            imp_course_slide(course, x, y);
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
