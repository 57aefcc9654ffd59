/* SPDX-License-Identifier: MIT
 *
 * toi: the first time at which two moving bodies touch.
 */
#ifndef IMPACT_TOI_H
#define IMPACT_TOI_H

#include "gap.h"

#ifdef __cplusplus
extern "C" {
#endif

/* position(t) = position + velocity t + acceleration t^2/2; orientation(t) = exp(omega t) orientation, omega in world
 * axes. */
typedef struct impact_motion {
    qvec3 velocity;     /* m/s, of the position */
    qvec3 acceleration; /* m/s^2, constant */
    qvec3 omega;        /* rad/s, constant */
} impact_motion;

/* The body at time t of its motion. */
IMPACT_API impact_solid impact_motion_at(const impact_solid *body, const impact_motion *motion, double t);

/* First contact in [0, t_max], t_max finite and >= 0. Planes stand still (their motion must be zero). All that is
 * passed over is proved free of contact, so that none is missed, however thin or fast the bodies. contact (NULL: not
 * wanted): the contact at *time. IMPACT_OK: *time is when the gap reaches zero, to the gap's or the time's rounding; 0
 * when the bodies touch or overlap at the start. IMPACT_NO_CONTACT: *time = t_max. IMPACT_EUNSETTLED: too many steps (a
 * long near-contact, 2000), or an answer that fails its receipt (then *time = 0): there is none before *time. Other
 * negative statuses: *time is NaN. */
IMPACT_API impact_status impact_toi(const impact_solid *body1, const impact_motion *motion1, const impact_solid *body2,
                                    const impact_motion *motion2, double t_max, double *time, impact_contact *contact);

#ifdef __cplusplus
}
#endif

#endif
