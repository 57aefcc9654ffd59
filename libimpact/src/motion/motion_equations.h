/* SPDX-License-Identifier: MIT
 *
 * motion_equations: what the integrator integrates, and the roots it looks for. Internal.
 */
#ifndef IMP_MOTION_EQUATIONS_H
#define IMP_MOTION_EQUATIONS_H

#include "motion/motion.h"

enum {
    Y_TIME,
    Y_FORCE_WORK,
    Y_DAMPING,
    Y_SLIDING,
    Y_BODIES,
    Y_PER_BODY = 13,
    Y_VELOCITY = 7,
    Y_PER_SPOT = 3,
    ROOTS_PER_PAIR = 3,
    ROOTS_PER_EDGE = 2
};

/* Where a driven world's y ends: the drives' work. */
static inline int imp_motion_drive(const imp_motion *motion) { return motion->size - 1; }

/* Between the bodies' states and the integrated state y; static bodies' states are left as they are. */
void imp_motion_pack(const imp_motion *motion, double t, const imp_state *states, double *y);
void imp_motion_unpack(const imp_motion *motion, const double *y, imp_state *states);
/* What each component of y is measured by where it passes zero: 1, or of a large body its size, speed and angular
 * momentum; works by the energy that is there, as closely as that itself. */
void imp_motion_measures(const imp_motion *motion, const imp_state *states, double *measure);

/* Whether the variable of integration is not time. */
static inline bool imp_motion_clocked(const imp_motion *motion) { return motion->sliding || motion->following; }

/* dt/dtau, for the contacts as they stand. */
double imp_motion_clock(const imp_motion *motion);

/* How fast any point of the body moves at most, m/s. */
double imp_motion_speed(const imp_body *body, const imp_state *state);

/* Contacts and pairs as they are, and back: to look must leave no traces. False: there is no room. */
bool imp_motion_keep_contacts(imp_motion *motion);
void imp_motion_restore_contacts(imp_motion *motion);

/* For impact_ode: the rates of y, and the root functions: ROOTS_PER_PAIR for each pair that is held (its pressure, what
 * is left of its mode, its distance from the plane's bounds), ROOTS_PER_EDGE for each edge of a field (its value, minus
 * the value's rate), one for each body (its speed over the rest speed). Every one falls through zero when its event
 * comes; a rate's root is where a value that fell and rose within one step is lowest. */
int imp_motion_rates(double tau, const double *y, double *rate, void *motion);
int imp_motion_root_values(double tau, const double *y, double *value, void *motion);

#endif
