/* SPDX-License-Identifier: MIT
 *
 * The proof that nothing touches between two times. From a state with gap g >= 0 and normal n,
 * follow time (either way) along the direction n(t) = (1 + alpha t^2/2) n + t nu. With d = n or -n outward, w the spin,
 * c, v, a the centres' offset and its rates, the direction in a body's axes is, to third order, R^T of
 *
 *     d + t (nu - w x d) + t^2/2 q + t^3/6 s + rest,   q = w x (w x d) - 2 w x nu + alpha d,
 *     s = -w x (w x (w x d)) + 3 w x (w x nu) - 3 alpha w x d,   |rest| <= M t^4/24.
 *
 * The support function h is convex and subadditive, r the body's radius, so that n(t).c(t) less both h is at least
 *
 *     psi(t) = g + (n.v + nu.c) t + min(0, B) t^2/2 + min(0, C) t^3/6 - r M t^4/24 - sum [h(d + t (nu - w x d)) - h(d)]
 *
 * B = n.a + 2 nu.v + alpha n.c - sum h(q), C = 3 nu.a + 3 alpha n.v - sum r |s|. psi is concave: psi(T) >= 0 proves that
 * there is no contact from 0 to T. nu is chosen to lead to the normal found at T, where the true gap is known to be
 * positive, so that psi(T) falls short of it by terms of second order in T only, however steep or flat the surfaces.
 */
#include "toi_proof.h"

static double support(const impact_form *form, qvec3 d)
{
    const double body[3] = {form->rotation[0][0] * d.x + form->rotation[1][0] * d.y + form->rotation[2][0] * d.z,
                            form->rotation[0][1] * d.x + form->rotation[1][1] * d.y + form->rotation[2][1] * d.z,
                            form->rotation[0][2] * d.x + form->rotation[1][2] * d.y + form->rotation[2][2] * d.z};
    impact_surface s;
    return body[0] == 0 && body[1] == 0 && body[2] == 0 ? 0 : impact_form_support(form, body, &s);
}

void impact_instant_centres(const impact_chase *q, double t, impact_instant *at)
{
    const impact_course *course = &q->course;
    const qvec3 start = qvec3_sub(course->body[0]->position, course->body[1]->position),
                v = qvec3_sub(course->motion[0]->velocity, course->motion[1]->velocity);
    at->t = t;
    at->c = qvec3_axpy(t, qvec3_axpy(0.5 * t, q->acceleration, v), start);
    at->v = qvec3_axpy(t, q->acceleration, v);
}

void impact_instant_place(const impact_chase *q, double t, impact_instant *at)
{
    impact_instant_centres(q, t, at);
    at->sketched = false;
    for (int k = 0; k < 2; k++) {
        at->body[k] = impact_motion_at(q->course.body[k], q->course.motion[k], t);
        if (!q->plane[k]) impact_form_make(&at->body[k].shape, 1, at->body[k].orientation, &at->form[k]);
    }
    at->c = qvec3_sub(at->body[0].position, at->body[1].position);
    at->tolerance = 2.5e-16 * (q->length + qvec3_norm(at->c));
}

bool impact_instant_sketch(const impact_chase *q, qvec3 n, impact_instant *at)
{
    qvec3 offset[2];
    double gap = qvec3_dot(n, at->c);
    for (int k = 0; k < 2; k++) {
        const qvec3 outward = k ? n : qvec3_neg(n);
        const double d[3] = {outward.x, outward.y, outward.z};
        double x[3];
        impact_surface s;
        gap -= impact_form_support_world(&at->form[k], d, x, &s);
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

/* psi(T) with n(t) as the head of this file has it. */
static double psi(const impact_chase *q, const impact_instant *at, double sense, qvec3 nu, double T)
{
    const qvec3 n = at->contact.normal, v = qvec3_scale(at->v, sense);
    qvec3 outward[2], lead[2], w[2];
    double alpha = 0;
    for (int k = 0; k < 2; k++) {
        outward[k] = k ? n : qvec3_neg(n), lead[k] = k ? nu : qvec3_neg(nu);
        w[k] = qvec3_scale(q->omega[k], sense);
        const qvec3 slip = qvec3_sub(lead[k], qvec3_cross(w[k], outward[k]));
        if (!q->plane[k]) alpha = fmax(alpha, qvec3_dot(slip, slip) - qvec3_dot(nu, nu));
    }
    double first = qvec3_dot(n, v) + qvec3_dot(nu, at->c),
           second = qvec3_dot(n, q->acceleration) + 2 * qvec3_dot(nu, v) + alpha * qvec3_dot(n, at->c),
           third = 3 * qvec3_dot(nu, q->acceleration) + 3 * alpha * qvec3_dot(n, v),
           fourth = fmin(0, 6 * alpha * qvec3_dot(n, q->acceleration)), value = fmax(0, at->gap);
    for (int k = 0; k < 2; k++) {
        if (q->plane[k]) continue;
        const qvec3 wd = qvec3_cross(w[k], outward[k]), wnu = qvec3_cross(w[k], lead[k]);
        const qvec3 bend = qvec3_axpy(alpha, outward[k], qvec3_axpy(-2, wnu, qvec3_cross(w[k], wd)));
        const qvec3 twist =
            qvec3_axpy(-3 * alpha, wd,
                       qvec3_sub(qvec3_scale(qvec3_cross(w[k], wnu), 3), qvec3_cross(w[k], qvec3_cross(w[k], wd))));
        const double W = qvec3_norm(w[k]), N = qvec3_norm(nu);
        second -= support(&at->form[k], bend);
        third -= q->radius[k] * qvec3_norm(twist);
        fourth -=
            q->radius[k] * W * W * (W * W * (1 + T * N + 0.5 * alpha * T * T) + 4 * W * (N + alpha * T) + 6 * alpha);
        const qvec3 offset = k ? at->contact.offset2 : at->contact.offset1;
        value -=
            support(&at->form[k], qvec3_axpy(T, qvec3_sub(lead[k], wd), outward[k])) - qvec3_dot(outward[k], offset);
    }
    return value + T * (first + T * (fmin(0, second) / 2 + T * (fmin(0, third) / 6 + T * fourth / 24)));
}

bool impact_toi_link(const impact_chase *q, const impact_instant *from, const impact_instant *to)
{
    const bool forward = from->gap < to->gap;
    const impact_instant *base = forward ? from : to, *end = forward ? to : from;
    const double T = to->t - from->t, along = qvec3_dot(base->contact.normal, end->contact.normal);
    if (!(along > 0.2)) return false;
    const qvec3 nu = qvec3_scale(qvec3_axpy(-along, base->contact.normal, end->contact.normal), 1 / (along * T));
    return psi(q, base, forward ? 1 : -1, nu, T) >= -base->tolerance;
}

/* First T > 0 at which gap + slope T - bend T^2/2 is zero; infinite when there is none. gap > 0, bend >= 0. */
static double first_zero(double gap, double slope, double bend)
{
    const double root = sqrt(slope * slope + 2 * bend * gap);
    if (slope < 0) return 2 * gap / (root - slope);
    return bend > 0 ? (slope + root) / bend : INFINITY;
}

double impact_toi_safe_step(const impact_chase *q, const impact_instant *at, double limit)
{
    const double value = psi(q, at, 1, (qvec3){0, 0, 0}, limit);
    return value >= 0 ? limit : limit * (at->gap / (at->gap - value)); /* psi is above its chord */
}

double impact_toi_ball_step(const impact_chase *q, const impact_instant *at, qvec3 n)
{
    if (q->plane[0] || q->plane[1]) return 0;
    const double apart = qvec3_dot(n, at->c) - q->radius[0] - q->radius[1];
    return apart > 0 ? first_zero(apart, qvec3_dot(n, at->v), -fmin(0, qvec3_dot(n, q->acceleration))) : 0;
}
