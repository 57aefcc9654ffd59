/* SPDX-License-Identifier: MIT
 *
 * The sliding flow as data: u(p) at equal steps of p, and the directions that do not turn.
 */
#include "collide/collide_series.h"
#include "base/tolerances.h"

#include <float.h>

/* ---- invariant directions ---- */

static const double turn = 6.283185307179586;

static double turning_at(const imp_frame *frame, double mu, double theta)
{
    return imp_course_turning(frame, mu, cos(theta), sin(theta));
}

static double pull_at(const imp_frame *frame, double mu, double theta)
{
    const double x = cos(theta), y = sin(theta);
    return -(frame->c * x + frame->d * y) + mu * (frame->a - frame->b) * (x * x - y * y);
}

/* The slope of the pull. */
static double bend_at(const imp_frame *frame, double mu, double theta)
{
    const double x = cos(theta), y = sin(theta);
    return frame->c * y - frame->d * x - 4 * mu * (frame->a - frame->b) * x * y;
}

typedef double angle_function(const imp_frame *frame, double mu, double theta);

/* The zero between low and high, where the signs differ. */
static double bisect(angle_function *f, const imp_frame *frame, double mu, double low, double high)
{
    const bool rising = f(frame, mu, low) < 0;
    for (int i = 0; i < 70 && high - low > IMP_FLOW_BISECTED * turn; i++) {
        const double mid = 0.5 * (low + high);
        if ((f(frame, mu, mid) < 0) == rising)
            low = mid;
        else
            high = mid;
    }
    return 0.5 * (low + high);
}

static bool unlike(double a, double b) { return (a < 0) != (b < 0); }

/* Keeps the directions in order of theta. */
static int add_direction(const imp_frame *frame, const impact_flow *flow, double theta,
                         impact_flow_direction *directions, int n)
{
    if (n == 4) return n;
    const imp_line line = imp_course_sliding(frame, flow->friction, cos(theta), sin(theta));
    const double wrapped = theta < turn ? theta : theta - turn;
    int at = n;
    for (; at > 0 && directions[at - 1].theta > wrapped; at--) directions[at] = directions[at - 1];
    directions[at] = (impact_flow_direction){.theta = wrapped,
                                             .rate = line.R * flow->m,
                                             .climb = line.Z * flow->m,
                                             .pull = pull_at(frame, flow->friction, theta) * flow->m};
    return n + 1;
}

static bool frame_of(const impact_flow *flow, imp_frame *frame)
{
    const double m = flow->m, a = flow->a / m, b = flow->b / m, c = flow->c / m, d = flow->d / m;
    const double k = 1 - c * c / a - d * d / b;
    if (!(m > 0 && a > 0 && b > 0 && k > 0 && isfinite(a + b + k) && flow->friction >= 0 && isfinite(flow->friction)))
        return false;
    *frame = (imp_frame){.t1 = flow->t1,
                         .t2 = flow->t2,
                         .n = flow->n,
                         .a = a,
                         .b = b,
                         .c = c,
                         .d = d,
                         .schur = b,
                         .k = k,
                         .alpha = -c / a,
                         .beta = -d / b,
                         .scale = m};
    return true;
}

/* The roots of T between low and high, two or three close together among them: split where the bend is 0, so that the
 * pull is monotone, and where that is 0, so that T is. order: 2 the bend, 1 the pull, 0 T. */
static int directions_between(const imp_frame *frame, const impact_flow *flow, int order, double low, double high,
                              impact_flow_direction *directions, int n)
{
    static angle_function *const functions[3] = {turning_at, pull_at, bend_at};
    angle_function *const f = functions[order];
    const double mu = flow->friction;
    const bool zero = unlike(f(frame, mu, low), f(frame, mu, high));
    const double middle = zero ? bisect(f, frame, mu, low, high) : high;
    if (order == 0) return zero ? add_direction(frame, flow, middle, directions, n) : n;
    n = directions_between(frame, flow, order - 1, low, middle, directions, n);
    return zero ? directions_between(frame, flow, order - 1, middle, high, directions, n) : n;
}

int impact_flow_directions(const impact_flow *flow, impact_flow_direction directions[4])
{
    enum { CELLS = 360 };
    imp_frame frame;
    if (!frame_of(flow, &frame)) return 0;
    const double mu = flow->friction;
    const double size = fabs(frame.c) + fabs(frame.d) + mu * fabs(frame.a - frame.b);
    if (size <= 4 * DBL_EPSILON * (1 + mu * (frame.a + frame.b))) return 0;
    int n = 0;
    /* Cells begin off the axes, where directions like to lie. */
    for (int i = 0; i < CELLS; i++)
        n = directions_between(&frame, flow, 2, turn * (i + 0.37123) / CELLS, turn * (i + 1.37123) / CELLS, directions,
                               n);
    return n;
}

/* ---- the flow at equal steps of p ---- */

typedef struct sampler {
    const impact_flow *flow;
    const imp_frame *frame;
    const double *start;
    double unit; /* N s per scaled impulse */
    double speed;
    double p_end; /* N s */
    int count, next;
    impact_flow_point *points;
    double x, y, s, p, px, py; /* scaled, now */
} sampler;

static double wanted_p(const sampler *sm) { return sm->p_end * sm->next / (sm->count - 1) / sm->unit; }

static void put(sampler *sm, double x, double y, double p, double px, double py, bool stick)
{
    impact_flow_point *out = &sm->points[sm->next];
    const imp_frame *frame = sm->frame;
    out->p = sm->p_end * sm->next / (sm->count - 1);
    out->velocity[0] = x * sm->speed;
    out->velocity[1] = y * sm->speed;
    out->velocity[2] = sm->start[2] + (frame->c * px + frame->d * py + p) * sm->speed;
    out->impulse[0] = px * sm->unit;
    out->impulse[1] = py * sm->unit;
    out->speed = sqrt(x * x + y * y) * sm->speed;
    out->theta = out->speed > 0 ? atan2(y, x) : 0;
    out->stick = stick;
    sm->next++;
}

/* Along a line in the direction (x, y) from now on, to where it stops. */
static void along_line(sampler *sm, const imp_line *line, double x, double y)
{
    const double room = line->R < 0 ? sm->s / -line->R : INFINITY;
    while (sm->next < sm->count && wanted_p(sm) <= sm->p + room) {
        const double p = wanted_p(sm), dp = p - sm->p, s = sm->s + line->R * dp;
        put(sm, s * x, s * y, p, sm->px + line->gx * dp, sm->py + line->gy * dp, line->stick);
    }
    if (room == INFINITY) return;
    sm->p += room;
    sm->px += line->gx * room;
    sm->py += line->gy * room;
    sm->s = 0;
}

static void from_rest(sampler *sm)
{
    const imp_line line = imp_course_from_rest(sm->frame, sm->flow->friction);
    const double pull = hypot(line.gx, line.gy);
    sm->s = 0;
    if (line.stick)
        along_line(sm, &line, 0, 0);
    else if (sm->flow->friction > 0)
        along_line(sm, &line, -line.gx / pull, -line.gy / pull);
    else
        along_line(sm, &line, sm->frame->c / line.R, sm->frame->d / line.R);
}

/* Puts the points within one Taylor step, and moves to its end. */
static void through_step(sampler *sm, const imp_taylor *ty)
{
    const int n = ty->order;
    const double h = ty->h, mu = sm->flow->friction, rate = ty->rate, rub = mu * rate,
                 dp = rate * imp_taylor_integral(ty->s, n, h);
    double t = 0;
    while (sm->next < sm->count && wanted_p(sm) <= sm->p + dp) {
        const double p = wanted_p(sm);
        double low = t, high = h;
        for (int i = 0; i < 60; i++) {
            const double f = sm->p + rate * imp_taylor_integral(ty->s, n, t) - p;
            if (f > 0)
                high = t;
            else
                low = t;
            double to = t - f / (rate * imp_taylor_value(ty->s, n, t));
            if (!(to >= low && to <= high)) to = 0.5 * (low + high);
            const double move = fabs(to - t);
            t = to;
            if (move <= 2 * DBL_EPSILON * t) break;
        }
        put(sm, imp_taylor_value(ty->x, n, t), imp_taylor_value(ty->y, n, t), p,
            sm->px - rub * imp_taylor_integral(ty->x, n, t), sm->py - rub * imp_taylor_integral(ty->y, n, t), false);
    }
    sm->px -= rub * imp_taylor_integral(ty->x, n, h);
    sm->py -= rub * imp_taylor_integral(ty->y, n, h);
    sm->p += dp;
    sm->x = imp_taylor_value(ty->x, n, h);
    sm->y = imp_taylor_value(ty->y, n, h);
    sm->s = sqrt(sm->x * sm->x + sm->y * sm->y);
}

static impact_status sample(sampler *sm)
{
    const imp_frame *frame = sm->frame;
    const double mu = sm->flow->friction, small = IMP_FLOW_STOPPED * sm->s;
    for (int steps = 0; steps < 1000 && sm->next < sm->count; steps++) {
        if (sm->s <= small) {
            from_rest(sm);
            return IMPACT_OK;
        }
        const double x = sm->x / sm->s, y = sm->y / sm->s;
        const imp_line line = imp_course_straight_line(frame, mu, x, y);
        if (imp_course_is_straight(frame, mu, x, y)) {
            along_line(sm, &line, x, y);
            continue;
        }
        imp_tail tail;
        if (imp_tail_make(&tail, frame, mu, sm->x, sm->y, sm->s, 0) && sm->p + tail.p < wanted_p(sm)) {
            sm->p += tail.p;
            sm->px += tail.px;
            sm->py += tail.py;
            sm->s = 0;
            continue;
        }
        imp_taylor taylor;
        imp_taylor_make(&taylor, frame, mu, sm->x, sm->y, sm->s, IMP_SERIES_ORDER);
        through_step(sm, &taylor);
    }
    return sm->next == sm->count ? IMPACT_OK : IMPACT_EUNSETTLED;
}

impact_status impact_flow_sample(const impact_flow *flow, const double velocity[3], double p_end, int count,
                                 impact_flow_point *points)
{
    imp_frame frame;
    if (!isfinite(velocity[0] + velocity[1] + velocity[2]) || isnan(p_end)) return IMPACT_EDOMAIN;
    if (count < 2 || !(p_end > 0 && p_end < INFINITY) || !frame_of(flow, &frame)) return IMPACT_EARGUMENT;
    const double s = hypot(velocity[0], velocity[1]), speed = s > 0 ? s : 1;
    sampler sm = {.flow = flow,
                  .frame = &frame,
                  .start = velocity,
                  .unit = speed / flow->m,
                  .speed = speed,
                  .p_end = p_end,
                  .count = count,
                  .points = points,
                  .x = velocity[0] / speed,
                  .y = velocity[1] / speed,
                  .s = s / speed};
    put(&sm, sm.x, sm.y, 0, 0, 0, s == 0 && imp_course_from_rest(&frame, flow->friction).stick);
    return sample(&sm);
}

impact_status impact_flow_make(const impact_collision *collision, impact_flow *flow, double velocity[3])
{
    const impact_status status = impact_collide_check(collision, NULL, 0);
    if (status != IMPACT_OK) return status;
    imp_ready ready;
    imp_frame frame;
    imp_ready_make(collision, &ready);
    imp_frame_principal(imp_frame_normal(collision), &ready, &frame);
    const double m = frame.scale;
    *flow = (impact_flow){.t1 = frame.t1,
                          .t2 = frame.t2,
                          .n = frame.n,
                          .a = frame.a * m,
                          .b = frame.b * m,
                          .c = frame.c * m,
                          .d = frame.d * m,
                          .m = m,
                          .friction = collision->friction};
    const qvec3 u = imp_ready_velocity(&ready);
    velocity[0] = qvec3_dot(u, frame.t1);
    velocity[1] = qvec3_dot(u, frame.t2);
    velocity[2] = qvec3_dot(u, frame.n);
    return IMPACT_OK;
}
