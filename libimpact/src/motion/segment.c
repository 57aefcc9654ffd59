/* SPDX-License-Identifier: MIT */
#include "motion/segment.h"
#include "motion/motion_equations.h"

#include <float.h>

/* ---- the functions of damping ---- */

double imp_phi1(double k, double T) { return k > 0 ? -expm1(-k * T) / k : T; }

/* For small k T the difference cancels: the series T^2 (1/2 - kT/6 + (kT)^2/24 - ...), to under a rounding at kT = 1.
 */
double imp_phi2(double k, double T)
{
    enum { TERMS = 18 };
    const double z = k * T;
    if (z > 1) return (T - imp_phi1(k, T)) / k;
    double sum = 0;
    for (int n = TERMS; n >= 0; n--) sum = (1 - z * sum) / (n + 2);
    return T * T * sum;
}

/* ---- making ---- */

/* No less than the components of a tumble's omega ever are, body axes: those of its ends, or where omega is steady, its
 * own. */
static qvec3 fastest_of(const imp_body *body, const imp_state *start, const impact_tumble *tumble)
{
    const double L = qvec3_norm(start->momentum);
    double w[3];
    if (!tumble || tumble->steady) {
        const qvec3 omega = quat_rotate_inverse(start->q, imp_omega(body, start));
        return (qvec3){fabs(omega.x), fabs(omega.y), fabs(omega.z)};
    }
    for (int k = 0; k < 3; k++) w[tumble->axis[k]] = fabs(tumble->amplitude[k]) * L;
    return (qvec3){w[0] * body->inverse_moments.x, w[1] * body->inverse_moments.y, w[2] * body->inverse_moments.z};
}

static bool is_zero(qvec3 v) { return v.x == 0 && v.y == 0 && v.z == 0; }

imp_segment imp_segment_rest(double t0, const imp_state *start)
{
    return (imp_segment){.kind = IMP_SEGMENT_REST, .t0 = t0, .t1 = INFINITY, .start = *start};
}

imp_segment imp_segment_fly(const imp_body *body, double t0, const imp_state *start, qvec3 acceleration,
                            impact_tumble *tumble)
{
    imp_segment s = imp_segment_rest(t0, start);
    if (body->is_static) return s;
    s.kind = body->linear_rate != 0 || body->angular_rate != 0 ? IMP_SEGMENT_DAMPED : IMP_SEGMENT_FREE;
    s.acceleration = acceleration;
    if (is_zero(start->momentum)) return s;
    if (!body->spherical) {
        impact_tumble_make(body->moments, start->q, start->momentum, tumble);
        s.tumble = tumble;
    } else {
        const qvec3 omega = imp_omega(body, start);
        const double spin = qvec3_norm(omega);
        s.half_spin = 0.5 * spin;
        s.axis = spin > 0 ? qvec3_scale(omega, 1 / spin) : omega;
    }
    s.fastest = fastest_of(body, start, s.tumble);
    return s;
}

imp_segment imp_segment_roll(double t0, double t1, const imp_state *start, qvec3 acceleration, qvec3 spin_up)
{
    imp_segment s = imp_segment_rest(t0, start);
    s.kind = IMP_SEGMENT_ROLL;
    s.t1 = t1;
    s.acceleration = acceleration;
    s.spin_up = spin_up;
    return s;
}

imp_segment imp_segment_dense(const imp_dense *dense, int place, const imp_state *start)
{
    return (imp_segment){
        .kind = IMP_SEGMENT_DENSE, .t0 = dense->t0, .t1 = dense->t1, .start = *start, .dense = dense, .place = place};
}

/* ---- a state ---- */

static int first_of(const imp_segment *s) { return Y_BODIES + Y_PER_BODY * s->place; }

static imp_state dense_state(const imp_segment *s, double t)
{
    double b[Y_PER_BODY];
    imp_dense_at(s->dense, t, first_of(s), Y_PER_BODY, b);
    imp_state state = {.x = {b[0], b[1], b[2]},
                       .v = {b[7], b[8], b[9]},
                       .q = {b[3], b[4], b[5], b[6]},
                       .momentum = {b[10], b[11], b[12]}};
    quat_normalize(state.q, &state.q);
    return state;
}

/* The rotation that omega0 and omega0 + alpha tau make up in the time T, where they are parallel. */
static quat straight_turn(quat q, qvec3 omega, qvec3 alpha, double T)
{
    return quat_mul(quat_from_rotation_vector(qvec3_scale(qvec3_axpy(0.5 * T, alpha, omega), T)), q);
}

/* And where they are not: by Magnus' series to the fourth order, the commutator |omega x alpha| h^3/12 a step, in steps
 * of IMP_ROLL_STEP: 1e-11 of the angle turned through, which moves nothing of a ball. */
static quat roll_turn(quat q, qvec3 omega, qvec3 alpha, double T)
{
    const qvec3 cross = qvec3_cross(omega, alpha);
    if (is_zero(cross)) return straight_turn(q, omega, alpha, T);
    const double fastest = qvec3_norm(omega) + T * qvec3_norm(alpha), longest = IMP_ROLL_STEP / fastest;
    const long steps = (long)fmin(ceil(T / longest), IMP_ROLL_STEPS);
    const double h = T / (double)steps;
    for (long i = 0; i < steps; i++) {
        const qvec3 middle = qvec3_axpy(((double)i + 0.5) * h, alpha, omega);
        const qvec3 turn = qvec3_axpy(-h * h * h / 12, cross, qvec3_scale(middle, h));
        q = quat_mul(quat_from_rotation_vector(turn), q);
    }
    return q;
}

static quat turned(const imp_segment *s, double clock)
{
    if (s->tumble) return impact_tumble_at(s->tumble, clock);
    if (s->half_spin == 0) return s->start.q;
    const double half = s->half_spin * clock, sine = sin(half);
    quat q = quat_mul((quat){cos(half), sine * s->axis.x, sine * s->axis.y, sine * s->axis.z}, s->start.q);
    (void)quat_normalize(q, &q); /* to the last digit: a gap takes no other */
    return q;
}

qvec3 imp_segment_place_of(const imp_segment *s, const imp_body *body, double t, qvec3 *velocity)
{
    const double T = t - s->t0;
    switch (T == 0 ? IMP_SEGMENT_REST : s->kind) {
    case IMP_SEGMENT_REST: break;
    case IMP_SEGMENT_FREE:
    case IMP_SEGMENT_ROLL:
        *velocity = qvec3_axpy(T, s->acceleration, s->start.v);
        return qvec3_axpy(T, qvec3_axpy(0.5 * T, s->acceleration, s->start.v), s->start.x);
    case IMP_SEGMENT_DAMPED: {
        const double k = body->linear_rate, one = imp_phi1(k, T);
        *velocity = qvec3_axpy(one, s->acceleration, qvec3_scale(s->start.v, exp(-k * T)));
        return qvec3_axpy(one, s->start.v, qvec3_axpy(imp_phi2(k, T), s->acceleration, s->start.x));
    }
    case IMP_SEGMENT_DENSE: {
        double x[Y_PER_BODY];
        imp_dense_at(s->dense, t, first_of(s), Y_VELOCITY + 3, x);
        *velocity = (qvec3){x[Y_VELOCITY], x[Y_VELOCITY + 1], x[Y_VELOCITY + 2]};
        return (qvec3){x[0], x[1], x[2]};
    }
    }
    *velocity = s->start.v;
    return s->start.x;
}

/* Of what rolls, or turns about an axis that stays, T on; it stands as q says. */
static qvec3 rolled_momentum(const imp_segment *s, const imp_body *body, quat q, double T)
{
    return body->spherical ? qvec3_axpy(T * body->moments.x, s->spin_up, s->start.momentum)
                           : imp_inertia(body, q, qvec3_axpy(T, s->spin_up, imp_omega(body, &s->start)));
}

imp_state imp_segment_at(const imp_segment *s, const imp_body *body, double t)
{
    imp_state state = s->start;
    const double T = t - s->t0;
    if (s->kind == IMP_SEGMENT_REST || T == 0) return state;
    if (s->kind == IMP_SEGMENT_DENSE) return dense_state(s, t);
    state.x = imp_segment_place(s, body, t, &state.v);
    if (s->kind == IMP_SEGMENT_ROLL) {
        const qvec3 omega = imp_omega(body, &s->start);
        state.q = quat_unit((body->spherical ? roll_turn : straight_turn)(s->start.q, omega, s->spin_up, T));
        state.momentum = rolled_momentum(s, body, state.q, T);
        return state;
    }
    const double kappa = s->kind == IMP_SEGMENT_DAMPED ? body->angular_rate : 0;
    state.q = turned(s, imp_phi1(kappa, T));
    if (kappa > 0) state.momentum = qvec3_scale(state.momentum, exp(-kappa * T));
    return state;
}

imp_state imp_segment_unturned(const imp_segment *s, const imp_body *body, double t)
{
    const double T = t - s->t0;
    imp_state state = s->start;
    if (s->kind == IMP_SEGMENT_REST) return state;
    if (s->kind == IMP_SEGMENT_DENSE) return dense_state(s, t);
    state.x = imp_segment_place(s, body, t, &state.v);
    if (s->kind == IMP_SEGMENT_ROLL)
        state.momentum = rolled_momentum(s, body, state.q, T);
    else if (s->kind == IMP_SEGMENT_DAMPED && body->angular_rate > 0)
        state.momentum = qvec3_scale(state.momentum, exp(-body->angular_rate * T));
    return state;
}

double imp_segment_time(const imp_segment *s, double own)
{
    double t = own;
    if (s->kind == IMP_SEGMENT_DENSE) imp_dense_there(s->dense, own, Y_TIME, 1, &t);
    return t;
}

/* Most pieces begin or end with their step: of those nothing is to be searched for, but where time's own rounding (of
 * 13 terms) is all that is off. */
double imp_segment_own(const imp_segment *s, double t)
{
    if (s->kind != IMP_SEGMENT_DENSE) return t;
    if (t == imp_segment_time(s, 0)) return 0;
    const bool begins = fabs(imp_segment_time(s, -1) - t) <= IMP_DENSE_TERMS * DBL_EPSILON * fabs(t);
    return begins ? -1 : imp_dense_place(s->dense, t);
}

qvec3 imp_segment_pose(const imp_segment *s, const imp_body *body, double own, double *t, quat *q)
{
    double b[Y_VELOCITY];
    *t = imp_segment_time(s, own);
    if (s->kind != IMP_SEGMENT_DENSE) {
        const imp_state state = imp_segment_at(s, body, own);
        *q = state.q;
        return state.x;
    }
    imp_dense_there(s->dense, own, first_of(s), Y_VELOCITY, b);
    *q = quat_unit((quat){b[3], b[4], b[5], b[6]});
    return (qvec3){b[0], b[1], b[2]};
}

bool imp_segment_is_parabola(const imp_segment *s)
{
    return s->kind != IMP_SEGMENT_DAMPED && s->kind != IMP_SEGMENT_DENSE;
}

bool imp_segment_turns(const imp_segment *s, const imp_body *body)
{
    if (imp_is_ball(body) || s->kind == IMP_SEGMENT_REST) return false;
    return s->kind == IMP_SEGMENT_DENSE || !is_zero(s->start.momentum) || !is_zero(s->spin_up);
}

/* ---- bounds ---- */

static imp_bounds find_dense_bounds(const imp_segment *s, double t, double window)
{
    const imp_dense_window at = imp_dense_window_of(s->dense, t, window);
    imp_dense_rate time = {.rate = 1, .most_rate = 1}, r[IMP_DENSE_AT_ONCE];
    if (s->dense->clocked) imp_dense_rates(s->dense, at, Y_TIME, 1, &time);
    imp_dense_rates(s->dense, at, first_of(s) + Y_VELOCITY, 6, r);
    /* the clock is slowest where it may have come from here at its fastest change, and no slower than a tenth: within a
     * step of the integrator it changes by less */
    const double slowest = fmax(0.1 * time.rate, time.rate - at.w * s->dense->h * time.most_second);
    double speed = 0, rate = 0, second = 0, momentum = 0, torque = 0, twist = 0;
    for (int k = 0; k < 3; k++) {
        speed += r[k].most * r[k].most;
        rate += r[k].most_rate * r[k].most_rate;
        second += r[k].most_second * r[k].most_second;
        momentum += r[3 + k].most * r[3 + k].most;
        torque += r[3 + k].most_rate * r[3 + k].most_rate;
        twist += r[3 + k].most_second * r[3 + k].most_second;
    }
    imp_bounds b = {.acceleration = qvec3_scale((qvec3){r[0].rate, r[1].rate, r[2].rate}, 1 / time.rate),
                    .torque = qvec3_scale((qvec3){r[3].rate, r[4].rate, r[5].rate}, 1 / time.rate),
                    .speed = sqrt(speed)};
    b.jerk = (sqrt(second) + sqrt(rate) * time.most_second / slowest) / (slowest * slowest);
    b.momentum = sqrt(momentum);
    b.most_torque = sqrt(torque) / slowest;
    b.torque_rate = (sqrt(twist) + sqrt(torque) * time.most_second / slowest) / (slowest * slowest);
    return b;
}

static imp_bounds dense_bounds(const imp_segment *s, double t, double window)
{
    imp_dense_seen *seen = s->dense->seen ? &s->dense->seen[s->place] : NULL;
    if (seen && seen->t == t && seen->window == window) return seen->bounds;
    const imp_bounds bounds = find_dense_bounds(s, t, window);
    if (seen) *seen = (imp_dense_seen){t, window, bounds};
    return bounds;
}

/* Of the centre on a parabola, or damped: it goes towards g/k on a line. */
static double bound_speed(const imp_segment *s, const imp_body *body, double t, double window)
{
    const double pull = qvec3_norm(s->acceleration);
    qvec3 v;
    imp_segment_place(s, body, t, &v);
    if (s->kind == IMP_SEGMENT_DAMPED && body->linear_rate > 0) return fmax(qvec3_norm(v), pull / body->linear_rate);
    return qvec3_norm(v) + (pull > 0 ? pull * window : 0);
}

imp_bounds imp_segment_bounds(const imp_segment *s, const imp_body *body, double t, double window)
{
    imp_bounds b = {.acceleration = s->acceleration};
    const double L = qvec3_norm(s->start.momentum), T = t - s->t0;
    switch (s->kind) {
    case IMP_SEGMENT_REST: return (imp_bounds){.jerk = 0};
    case IMP_SEGMENT_DENSE: return dense_bounds(s, t, window);
    case IMP_SEGMENT_FREE: b.momentum = L; break;
    case IMP_SEGMENT_DAMPED: {
        const double k = body->linear_rate, left = L * exp(-body->angular_rate * T);
        qvec3 v;
        imp_segment_place(s, body, t, &v);
        b.acceleration = qvec3_axpy(-k, v, s->acceleration);
        b.torque = qvec3_scale(s->start.momentum, -body->angular_rate * exp(-body->angular_rate * T));
        b.jerk = k * qvec3_norm(b.acceleration); /* both only fall */
        b.momentum = left;                       /* it and its rates only fall, too */
        b.most_torque = body->angular_rate * left;
        b.torque_rate = body->angular_rate * b.most_torque;
        break;
    }
    case IMP_SEGMENT_ROLL: {
        const double alpha = qvec3_norm(s->spin_up), I = fmax(body->moments.x, fmax(body->moments.y, body->moments.z)),
                     gained = alpha > 0 ? I * alpha * (T + window) : 0; /* the window may have no end */
        b.torque = imp_inertia(body, s->start.q, s->spin_up);
        b.momentum = L + gained;
        b.most_torque = I * alpha;
        break;
    }
    }
    b.speed = bound_speed(s, body, t, window);
    return b;
}

imp_spin imp_segment_spin(const imp_segment *s, const imp_body *body, const imp_state *now, const imp_bounds *b,
                          double window)
{
    const bool flies = s->kind == IMP_SEGMENT_FREE || s->kind == IMP_SEGMENT_DAMPED;
    return imp_spin_of(body, now, flies ? &s->fastest : NULL, b->momentum,
                       (imp_torques){b->torque, b->most_torque, b->torque_rate}, window);
}

void imp_segment_rates(const imp_segment *s, const imp_body *body, double own, qvec3 *acceleration, qvec3 *torque)
{
    if (s->kind == IMP_SEGMENT_DENSE) {
        double r[6]; /* of v and the momentum, which stand side by side */
        imp_dense_slopes(s->dense, own, first_of(s) + Y_VELOCITY, 6, r);
        *acceleration = (qvec3){r[0], r[1], r[2]};
        *torque = (qvec3){r[3], r[4], r[5]};
        return;
    }
    *acceleration = s->acceleration;
    *torque = (qvec3){0, 0, 0};
    if (s->kind == IMP_SEGMENT_FREE || s->kind == IMP_SEGMENT_REST) return; /* a rest's acceleration is zero */
    const imp_bounds b = imp_segment_bounds(s, body, own, 0);
    *acceleration = b.acceleration;
    *torque = b.torque;
}

bool imp_segment_is_within_step(const imp_segment *s, double t)
{
    return s->kind == IMP_SEGMENT_DENSE && s->dense->stepped && t > s->dense->t0 && t < s->dense->t1;
}

static qvec3 twice_vector(quat a, quat b, double divisor)
{
    const quat product = quat_mul(a, quat_conj(b));
    return qvec3_scale((qvec3){product.x, product.y, product.z}, 2 / divisor);
}

void imp_segment_turning(const imp_segment *s, double own, qvec3 *omega, qvec3 *alpha)
{
    double jet[4][3];
    for (int k = 0; k < 4; k++) imp_dense_jet(s->dense, own, first_of(s) + 3 + k, jet[k]);
    quat p[3];
    for (int k = 0; k < 3; k++) p[k] = (quat){jet[0][k], jet[1][k], jet[2][k], jet[3][k]};
    const double square = quat_dot(p[0], p[0]);
    *omega = twice_vector(p[1], p[0], square);
    *alpha = qvec3_axpy(-2 * quat_dot(p[0], p[1]) / square, *omega, twice_vector(p[2], p[0], square));
}
