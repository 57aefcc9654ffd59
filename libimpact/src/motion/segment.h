/* SPDX-License-Identifier: MIT
 *
 * segment: the motion of one body over [t0, t1], fixed once it is made. All that is asked of a motion (samples,
 * contacts, energies, where a box is left) is asked of its segment. With T = t - t0, g the constant acceleration, k and
 * kappa the rates of damping:
 *
 *     REST    nothing changes
 *
 *     FREE    x = x0 + v0 T + g T^2/2,  L = L0: the rotation is a tumble (impact/tumble.h)
 *
 *     DAMPED  v' = g - k v:  v = v0 e^(-kT) + g phi1(k, T),  x = x0 + v0 phi1(k, T) + g phi2(k, T)
 *             L' = -kappa L:  L = L0 e^(-kappa T),  q = the tumble of L0 at the clock phi1(kappa, T),
 *             for with L = e^(-kappa T) M, dM/dtau and dq/dtau are torque-free
 *
 *     ROLL    a ball that rolls or slides in a line on a plane, a face that slides without turning, or turns on the
 *             spot: x as FREE, omega = omega0 + alpha T
 *
 *     DENSE   the polynomial of a step, an integrator's or a pile's (motion/dense.h)
 *
 * phi1(k, T) = (1 - e^(-kT))/k, phi2(k, T) = (T - phi1)/k; T and T^2/2 at k = 0. Internal.
 */
#ifndef IMP_SEGMENT_H
#define IMP_SEGMENT_H

#include <impact/tumble.h>
#include "motion/dense.h"
#include "motion/spin.h"

typedef enum imp_segment_kind {
    IMP_SEGMENT_REST,
    IMP_SEGMENT_FREE,
    IMP_SEGMENT_DAMPED,
    IMP_SEGMENT_ROLL,
    IMP_SEGMENT_DENSE
} imp_segment_kind;

typedef struct imp_segment {
    imp_segment_kind kind;
    double t0, t1;               /* s; t1 is infinite where the form holds for ever */
    qvec3 acceleration;          /* FREE, ROLL: of the centre; DAMPED: g, m/s^2 */
    imp_state start;             /* at t0 */
    qvec3 spin_up;               /* ROLL: alpha, 1/s^2; of an unequal body along a steady omega */
    const impact_tumble *tumble; /* FREE, DAMPED of unequal moments that turn; else NULL */
    qvec3 axis;                  /* FREE, DAMPED of equal moments that turn: unit, along omega */
    double half_spin;            /* |omega|/2 of those, 1/s */
    qvec3 fastest;               /* FREE, DAMPED: no less than omega's components in body axes ever are, 1/s */
    const imp_dense *dense;      /* DENSE: its island's step, and */
    int place;                   /* the body's place in it */
} imp_segment;

/* A body that nothing touches, under a constant acceleration, from its state at t0: FREE, or DAMPED where it is damped;
 * a static body rests. tumble: room for a body that turns with unequal moments, which has to live as long as the
 * segment. */
imp_segment imp_segment_fly(const imp_body *body, double t0, const imp_state *start, qvec3 acceleration,
                            impact_tumble *tumble);
/* A body that stays where it is. */
imp_segment imp_segment_rest(double t0, const imp_state *start);
/* Constant accelerations, until t1. */
imp_segment imp_segment_roll(double t0, double t1, const imp_state *start, qvec3 acceleration, qvec3 spin_up);
/* The body at this place of an integrator's step, from its state at t0. */
imp_segment imp_segment_dense(const imp_dense *dense, int place, const imp_state *start);

/* The state at t; before t0 and after t1 the form is continued. */
imp_state imp_segment_at(const imp_segment *segment, const imp_body *body, double t);
/* The same without the search for the orientation, where the form is closed: it is that of the start. A place, and the
 * energies of motion and of spin are right: of a torque-free spin L.omega is kept, and damping falls with L alone. */
imp_state imp_segment_unturned(const imp_segment *segment, const imp_body *body, double t);
typedef imp_state imp_segment_look(const imp_segment *segment, const imp_body *body, double t);
/* The variable that a segment is given in: time, or in a step of the integrator the place in it, with which time rises;
 * and the time, place (returned) and orientation there, without the search for it that a time takes. */
double imp_segment_own(const imp_segment *s, double t);
double imp_segment_time(const imp_segment *s, double own);
qvec3 imp_segment_pose(const imp_segment *s, const imp_body *body, double own, double *t, quat *q);
/* The centre's place and velocity alone. */
qvec3 imp_segment_place_of(const imp_segment *segment, const imp_body *body, double t, qvec3 *velocity);

static inline qvec3 imp_segment_place(const imp_segment *segment, const imp_body *body, double t, qvec3 *velocity)
{
    if (segment->kind != IMP_SEGMENT_FREE) return imp_segment_place_of(segment, body, t, velocity);
    const double T = t - segment->t0;
    *velocity = qvec3_axpy(T, segment->acceleration, segment->start.v);
    return qvec3_axpy(T, qvec3_axpy(0.5 * T, segment->acceleration, segment->start.v), segment->start.x);
}

/* Whether the centre has a constant acceleration; whether the body turns in a way that moves its surface. */
bool imp_segment_is_parabola(const imp_segment *segment);
bool imp_segment_turns(const imp_segment *segment, const imp_body *body);

/* Over [t, t + window]. */
imp_bounds imp_segment_bounds(const imp_segment *segment, const imp_body *body, double t, double window);
/* The same of its turning, which is `now` at t and within those bounds. */
imp_spin imp_segment_spin(const imp_segment *segment, const imp_body *body, const imp_state *now,
                          const imp_bounds *bounds, double window);
/* Its acceleration and torque alone, where its own variable is this. */
void imp_segment_rates(const imp_segment *segment, const imp_body *body, double own, qvec3 *acceleration,
                       qvec3 *torque);
/* Whether t is within a pile's step, not at its ends. Within, the momentum is not that of the turning: one is a line,
 * the other a quintic between the ends, and what lay on each other was put back at the last. */
bool imp_segment_is_within_step(const imp_segment *segment, double t);
/* How it turns within a pile's step, as the orientation's polynomial p has it: omega = 2 vec(p' p*)/|p|^2 and alpha =
 * 2 vec(p'' p*)/|p|^2 - 2 (p.p'/|p|^2) omega. */
void imp_segment_turning(const imp_segment *segment, double own, qvec3 *omega, qvec3 *alpha);

/* (1 - e^(-kT))/k and (T - phi1)/k, to rounding, k T >= 0. */
double imp_phi1(double k, double T);
double imp_phi2(double k, double T);

#endif
