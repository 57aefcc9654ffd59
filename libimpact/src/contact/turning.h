/* SPDX-License-Identifier: MIT
 *
 * turning: one impact at one point of two bodies that resist turning on each other. Internal.
 *
 * Moreau's law with Poisson's restitution (Glocker & Pfeiffer 1995), K and û with moments as in cone.h:
 *
 *     compression    u = u0 + W p,   K* contains û,  û . p = 0,  K contains p
 *     restitution    u' = u + W p',  p' = eps p_n n + more, the friction of each in its own cone; the same of `more`
 *
 * Friction's direction is that at each phase's end. Along one continuing compression, as impact_collide has it, moments
 * and forces would turn against two slips of one bound; no measured or known answer tells more of that than this does,
 * which for a ball, whose slips keep their lines, is the same law.
 */
#ifndef IMP_TURNING_H
#define IMP_TURNING_H

#include "contact/cone_assemble.h"

typedef struct imp_turning_impact {
    double p[6]; /* N s, N m s, along and about the contact's axes */
    double before[6], after[6];
    double residual;
} imp_turning_impact;

/* The states are not changed. IMPACT_ENOMEM; IMPACT_EUNSETTLED: no answer was found. */
impact_status imp_turning_collide(const imp_world *world, const imp_state *states, const imp_cone_contact *contact,
                                  double friction, imp_cone_lengths lengths, double restitution,
                                  imp_cone_workspace *workspace, imp_turning_impact *impact);

#endif
