/* SPDX-License-Identifier: MIT
 *
 * truth_lean: a heavy ball falls on the side of a light one of the same radius that lies on the floor, without friction
 * and without restitution, in the plane of their centres:
 *   falling    the heavy one alone, until the centres are s = 2 r apart
 *   impact     along the line of centres; the floor takes the light one's vertical part
 *   pressing   the line of centres at the angle theta over the floor. Energy and momentum are kept:
 *              theta'^2 = 2 (E - m2 g s sin theta)/(s^2 (m1 m2/(m1 + m2) sin^2 theta + m2 cos^2 theta)),
 *              and t(theta) is a quadrature, until the light one is no longer pushed: its speed is at its greatest
 *   apart      one slides on, the other falls
 */
#ifndef BENCH_TRUTH_LEAN_H
#define BENCH_TRUTH_LEAN_H

typedef struct truth_lean {
    double gravity, radius, light, heavy;
    double away, above; /* of the heavy ball's centre from the light one's, at rest: horizontal, vertical, m */
} truth_lean;

/* The times of impact, of parting, and at which the heavy ball comes to the floor. */
typedef struct truth_lean_times {
    double impact, parting, floor;
} truth_lean_times;

truth_lean_times truth_lean_events(const truth_lean *lean);

/* While they press: t, and how far each is along the line from the light ball's start to the heavy one's (m), and the
 * heavy one's centre over the light one's, at the part p of the way in theta, 0 ... 1. */
void truth_lean_pressing(const truth_lean *lean, double p, double *t, double *light, double *heavy, double *above);

/* After the parting, up to the floor. */
void truth_lean_apart(const truth_lean *lean, double t, double *light, double *heavy, double *above);

#endif
