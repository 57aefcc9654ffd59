/* SPDX-License-Identifier: MIT
 *
 * The proof that nothing touches between two times, 0 and T. Where normals n0 and n1 part the bodies by g0 and g1
 * there, follow the direction n(t) that turns from one to the other at a steady rate Omega. In the axes of a body of
 * spin w it is d(t) = R^T n (or its opposite), and with D = Omega - w
 *
 *     d'' = R^T [(D x w) x n + D x (D x n)],   |d'''| <= E (|w| + 3 |D|) + |D|^3,   E = |D x w|.
 *
 * d(t) is the chord between its ends less the integral of Green's function, which is never negative and has the
 * integral t (T - t)/2, times d''. The support function h is convex and subadditive. So with c, v, a the centres'
 * offset and its rates, lambda = t/T, the bodies are parted at t by at least
 *
 *     (1 - lambda) g0 + lambda g1 - lambda (1 - lambda) T^2/2 [M + L T (1 + lambda)/3],
 *     M = (n.c)'' + sum h(d'') at time 0,   (n.c)'' = -Omega^2 n.c + 2 (Omega x n).v + n.a,
 *     L = Omega^3 |c| + 3 Omega^2 |v| + 3 Omega |a| + sum r |d'''|, at their largest, r the body's radius.
 *
 * With K for T^2/2 times the bracket at lambda = 1 that is never negative if sqrt(g0) + sqrt(g1) >= sqrt(K), or, as the
 * bracket times (1 - lambda) falls, if g1 is at least T^2/2 times the bracket at 0 and M >= 0. The normals are those of
 * the gap or near it, so that the bound falls short of the gap by terms of second order in T only, however steep or
 * flat the surfaces.
 */
#include "motion/toi_proof.h"
#include "base/tolerances.h"

static double support(const imp_form *form, qvec3 d)
{
    const double body[3] = {form->rotation[0][0] * d.x + form->rotation[1][0] * d.y + form->rotation[2][0] * d.z,
                            form->rotation[0][1] * d.x + form->rotation[1][1] * d.y + form->rotation[2][1] * d.z,
                            form->rotation[0][2] * d.x + form->rotation[1][2] * d.y + form->rotation[2][2] * d.z};
    imp_surface s;
    return body[0] == 0 && body[1] == 0 && body[2] == 0 ? 0 : imp_form_support(form, body, &s);
}

void imp_instant_centres(const imp_chase *q, double t, imp_instant *at)
{
    const imp_gap_course *course = &q->course;
    const qvec3 start = qvec3_sub(course->body[0]->position, course->body[1]->position),
                v = qvec3_sub(course->motion[0]->velocity, course->motion[1]->velocity);
    at->t = t;
    at->c = qvec3_axpy(t, qvec3_axpy(0.5 * t, q->acceleration, v), start);
    at->v = qvec3_axpy(t, q->acceleration, v);
}

void imp_instant_place(const imp_chase *q, double t, bool exact, imp_instant *at)
{
    imp_instant_centres(q, t, at);
    at->sketched = false;
    for (int k = 0; k < 2; k++) {
        at->body[k] =
            exact ? impact_motion_at(q->course.body[k], q->course.motion[k], t) : imp_course_at(&q->course, k, t);
        if (!q->plane[k]) imp_form_make(&at->body[k].shape, 1, at->body[k].orientation, &at->form[k]);
    }
    at->c = qvec3_sub(at->body[0].position, at->body[1].position);
    at->tolerance = IMP_TOI_ROUNDING * (q->length + qvec3_norm(at->c));
}

bool imp_instant_sketch(const imp_chase *q, qvec3 n, imp_instant *at)
{
    qvec3 offset[2];
    double gap = qvec3_dot(n, at->c);
    for (int k = 0; k < 2; k++) {
        const qvec3 outward = k ? n : qvec3_neg(n);
        const double d[3] = {outward.x, outward.y, outward.z};
        double x[3];
        imp_surface s;
        gap -= imp_form_support_world(&at->form[k], d, x, &s);
        offset[k] = (qvec3){x[0], x[1], x[2]};
    }
    if (!(gap > 40 * at->tolerance)) return false;
    at->gap = gap;
    at->rate = qvec3_dot(
        n, qvec3_add(at->v, qvec3_sub(qvec3_cross(q->omega[0], offset[0]), qvec3_cross(q->omega[1], offset[1]))));
    at->contact = (impact_contact){.gap = gap, .lower = gap, .upper = INFINITY, .normal = n};
    at->contact.offset1 = offset[0], at->contact.offset2 = offset[1];
    at->sketched = true;
    return true;
}

/* How far the unit n parts the bodies, or g(n). */
static double parted(const imp_chase *q, const imp_instant *at, qvec3 n)
{
    double gap = qvec3_dot(n, at->c);
    for (int k = 0; k < 2; k++)
        if (!q->plane[k]) gap -= support(&at->form[k], k ? n : qvec3_neg(n));
    return gap;
}

/* The bound's M and L, for n to turn at the rate turn; sense: of time, 1 or -1; speed, distance: the largest on the
 * way. */
static void bends(const imp_chase *q, const imp_instant *at, double sense, qvec3 turn, double speed, double distance,
                  double *M, double *L)
{
    const qvec3 n = at->contact.normal, lead = qvec3_cross(turn, n);
    const double square = qvec3_dot(turn, turn), rate = sqrt(square);
    *M = -square * qvec3_dot(n, at->c) + 2 * sense * qvec3_dot(lead, at->v) + qvec3_dot(n, q->acceleration);
    *L = square * (rate * distance + 3 * speed) + 3 * rate * qvec3_norm(q->acceleration);
    for (int k = 0; k < 2; k++) {
        if (q->plane[k]) continue;
        const qvec3 w = qvec3_scale(q->omega[k], sense), D = qvec3_sub(turn, w), E = qvec3_cross(D, w);
        const double slip = qvec3_norm(D);
        *M += support(&at->form[k], qvec3_add(qvec3_cross(E, n), qvec3_cross(D, qvec3_cross(D, n))));
        *L += q->radius[k] * (qvec3_norm(E) * (qvec3_norm(w) + 3 * slip) + slip * slip * slip);
    }
}

qvec3 imp_toi_turn(qvec3 n0, qvec3 n1, double T)
{
    const qvec3 axis = qvec3_cross(n0, n1);
    const double sine = qvec3_norm(axis);
    return sine > 0 ? qvec3_scale(axis, atan2(sine, qvec3_dot(n0, n1)) / (sine * T)) : axis;
}

/* The largest speed of the centres, and no less than the largest distance, between two instants. */
static double greatest_speed(const imp_instant *a, const imp_instant *b)
{
    return fmax(qvec3_norm(a->v), qvec3_norm(b->v));
}

static double greatest_distance(const imp_chase *q, const imp_instant *a, const imp_instant *b)
{
    const double T = b->t - a->t;
    return fmax(qvec3_norm(a->c), qvec3_norm(b->c)) + qvec3_norm(q->acceleration) * T * T / 8;
}

bool imp_toi_link(const imp_chase *q, const imp_instant *from, const imp_instant *to)
{
    const bool forward = from->gap < to->gap;
    const imp_instant *base = forward ? from : to, *end = forward ? to : from;
    const double T = to->t - from->t, g0 = fmax(0, base->gap) + base->tolerance, g1 = end->gap + base->tolerance;
    if (!(qvec3_dot(base->contact.normal, end->contact.normal) > 0)) return false;
    const qvec3 turn = imp_toi_turn(base->contact.normal, end->contact.normal, T);
    double M, L;
    bends(q, base, forward ? 1 : -1, turn, greatest_speed(from, to), greatest_distance(q, from, to), &M, &L);
    if (M >= 0 && g1 >= 0.5 * T * T * (M + L * T / 3)) return true;
    return sqrt(g0) + sqrt(g1) >= T * sqrt(fmax(0, 0.5 * (M + 2 * L * T / 3)));
}

/* First T > 0 at which gap + slope T - bend T^2/2 is zero; infinite when there is none. gap > 0, bend >= 0. */
static double first_zero(double gap, double slope, double bend)
{
    const double root = sqrt(slope * slope + 2 * bend * gap);
    if (slope < 0) return 2 * gap / (root - slope);
    return bend > 0 ? (slope + root) / bend : INFINITY;
}

/* Of the turns the normal may make on the way to end, as it did before, with either body or none, the one along which
 * the bodies are parted most; and by how much they are. */
static double best_turn(const imp_chase *q, const imp_instant *at, const imp_instant *end, qvec3 trend, qvec3 *turn)
{
    const qvec3 n = at->contact.normal, turns[4] = {{0, 0, 0}, trend, q->omega[0], q->omega[1]};
    const double T = end->t - at->t;
    double best = -INFINITY;
    for (int i = 0; i < 4; i++) {
        const qvec3 across = qvec3_axpy(-qvec3_dot(turns[i], n), n, turns[i]);
        const double angle = T * qvec3_norm(across);
        if ((i > 0 && !(angle > 0)) || angle > 1 || (i > 0 && (q->plane[0] || q->plane[1]))) continue;
        const double sine = angle > 0 ? T * sin(angle) / angle : 0;
        const double gap = parted(q, end, qvec3_axpy(sine, qvec3_cross(across, n), qvec3_scale(n, cos(angle))));
        if (gap > best) best = gap, *turn = across;
    }
    return best;
}

double imp_toi_safe_step(const imp_chase *q, const imp_instant *at, qvec3 trend, double limit)
{
    imp_instant end;
    imp_instant_place(q, at->t + limit, false, &end);
    double M, L;
    qvec3 turn = {0, 0, 0};
    const double g0 = at->gap, g1 = best_turn(q, at, &end, trend, &turn);
    bends(q, at, 1, turn, greatest_speed(at, &end), greatest_distance(q, at, &end), &M, &L);
    const double K = fmax(0, 0.5 * limit * limit * (M + 2 * L * limit / 3)), b = g0 + K - g1,
                 square = b * b - 4 * K * g0;
    if (g1 >= 0 && (b <= 0 || square <= 0)) return limit;
    return limit * fmin(1, 2 * g0 / (b + sqrt(fmax(0, square))));
}

double imp_toi_ball_step(const imp_chase *q, const imp_instant *at, qvec3 n)
{
    if (q->plane[0] || q->plane[1]) return 0;
    const double apart = qvec3_dot(n, at->c) - q->radius[0] - q->radius[1];
    return apart > 0 ? first_zero(apart, qvec3_dot(n, at->v), -fmin(0, qvec3_dot(n, q->acceleration))) : 0;
}

/* The gap's rounding, or that of the time; an advance of the bodies that rounding of neither hides; of a length. */
static double room_of(const imp_instant *at)
{
    return fmax(IMP_TOI_NEAR * at->tolerance, IMP_TOI_TIME_NEAR * at->t * fabs(at->rate));
}

bool imp_toi_holds(const imp_chase *q, const imp_instant *at)
{
    const double room = room_of(at);
    if (!(fabs(at->gap) <= room)) return false;
    const double back = fmin(at->t, fabs(at->rate) > 0 ? IMP_TOI_GLANCE_BACK * q->length / fabs(at->rate) : 0);
    imp_instant before;
    impact_contact contact;
    imp_instant_place(q, at->t - back, true, &before);
    if (parted(q, &before, at->contact.normal) > -room) return true;
    return impact_gap(&before.body[0], &before.body[1], NULL, &contact) >= 0 && contact.upper > -room;
}
