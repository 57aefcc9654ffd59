/* SPDX-License-Identifier: MIT
 *
 * Contacts that other forces press together, sliding at u_n = 0, in a group: does some contact's own friction draw it
 * on faster than the group can answer,
 *
 *     d(u_n)/dp < 0,   what touches beside it giving way as bodies and their contacts do,
 *
 * no pressure holds it (Painleve 1895), and the limit of stiff springs is the encounter begun at u_n = -0. Each law
 * follows a seed of its own; where nothing draws, it comes to impulses of its size, which are none.
 * collide_tangential.c has the same of one contact.
 */
#include <quat/rotation.h>
#include "base/tolerances.h"
#include "contact/encounter.h"

/* Of the terms that the contact's u is a sum of. */
static double speeds_at(const imp_contact *c, const qvec3 *velocity, const qvec3 *omega)
{
    double sum = 0;
    for (int s = 0; s < 2; s++)
        sum += qvec3_norm(velocity[c->body[s]]) + qvec3_norm(omega[c->body[s]]) * qvec3_norm(c->arm[s]);
    return sum;
}

void imp_encounter_press(const imp_group *group, imp_contact *contact, const double *u)
{
    const double still = IMP_COLLIDE_SEED * speeds_at(contact, group->velocity, group->omega);
    if (contact->friction > 0 && fabs(u[0]) <= still) contact->slip = hypot(u[1], u[2]);
}

bool imp_encounter_is_drawn(const imp_group *group, int contact)
{
    const double slip = group->contacts[contact].slip;
    if (slip == 0) return false;
    const double own = group->w[(size_t)(3 * contact) * (3 * (size_t)group->count + 1)];
    return own * group->p[3 * contact] * fmax(1, group->contacts[contact].friction) > IMP_ENCOUNTER_DRAWN * slip;
}

bool imp_encounter_draws(const imp_group *group)
{
    for (int i = 0; i < group->count; i++)
        if (imp_encounter_is_drawn(group, i)) return true;
    return false;
}

bool imp_encounter_strikes(const imp_group *group)
{
    for (int i = 0; i < group->count; i++)
        if (group->contacts[i].slip == 0 && group->u0[3 * i] < 0) return true;
    return imp_encounter_draws(group);
}
