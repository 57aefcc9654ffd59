/* SPDX-License-Identifier: MIT
 *
 * The modes of held contacts are what Coulomb's law in accelerations makes of them (cone.h):
 *
 *     K* contains û,  û . r = 0,  K contains r,   u = W r + q,   q = bias + (n' . slip) n
 *
 * for all contacts of bodies that hang together: r_n = 0 opens, friction within its cone sticks, on it slides, u_t
 * being where to. Contacts that slide at a speed s obey the same law of their velocities a time h on, which over h has
 * s/h + u for u. As h goes to 0 the direction of that is s's, whatever its size: their q has `far` of the largest
 * acceleration along s, so that it is off by 1/far of it; and what u then has across s is taken from q, which leaves
 * 1/far of that.
 *
 * A flat place shifts to where moments balance: forces on it move its body without turning it, and W is 1/m.
 *
 * The modes that a contact comes with are tried first, by one linear system, and are kept where they obey: at the ends
 * of slip and of pressure the law allows both, and who found that end knows which comes next. Where reactions are not
 * unique the law's own, amid what the cones allow, is what they stay next to from there on: friction gives way only
 * where none holds.
 */
#include "contact/held_choice.h"
#include "contact/held_law.h"
#include "contact/held_system.h"

#include <math.h>

/* ---- whether modes obey ---- */

/* The largest force of the island. */
static double greatest_force(const imp_held *held, int island)
{
    double scale = 0;
    for (int c = 0; c < held->count; c++)
        if (held->island[c] == island) scale = fmax(scale, qvec3_norm(held->contacts[c].force));
    return scale;
}

/* Whether the contact does what its mode asks of it; pulls no more than rounding; nor slides without pressure, where
 * that is no matter of choice; and its friction is in its cone, against slip that begins on it. What rolls with a slip
 * begun is asked. */
static bool obeys(const imp_held_contact *contact, const imp_pair *pair, double scale)
{
    const double rounding = IMP_MODE_ROUNDING * scale;
    const bool presses = contact->mode == IMP_SLIDE && !contact->redundant;
    if (contact->still) return true;
    if (contact->unmet || (contact->mode == IMP_STICK && imp_is_incipient(pair))) return false;
    if (contact->pressure < (presses ? rounding : -rounding)) return false;
    return contact->mode == IMP_STICK ? contact->margin >= -rounding
                                      : !contact->incipient || contact->hold >= 1 - IMP_HOLD_ROUNDING;
}

static bool island_obeys(const imp_held *held, const imp_world *world, int island)
{
    const double scale = greatest_force(held, island);
    for (int c = island; c < held->count; c++)
        if (held->island[c] == island && !obeys(&held->contacts[c], &world->pairs[held->contacts[c].pair], scale))
            return false;
    return true;
}

static bool all_obey(const imp_held *held, const imp_world *world)
{
    for (int c = 0; c < held->count; c++)
        if (held->island[c] == c && !island_obeys(held, world, c)) return false;
    return true;
}

/* ---- the law of an island ---- */

/* Whether it slides as it goes, whatever the law says of what begins. */
static bool slides_on(const imp_held_contact *contact)
{
    return contact->mode == IMP_SLIDE && !contact->incipient && contact->friction > 0;
}

/* Adds to q, of what slides on, so much along its slip. */
static void send_far(const imp_held *held, imp_held_law *law, double far)
{
    for (int i = 0; i < law->count; i++) {
        const imp_held_contact *contact = &held->contacts[law->contact[i]];
        for (int k = 1; k < 3 && slides_on(contact); k++)
            law->q[3 * i + k] += far * qvec3_dot(law->contacts[i].axes[k], contact->direction);
    }
}

/* Takes from q what u has across the slip of what slides on; whether there was such. */
static bool straighten(const imp_held *held, imp_held_law *law)
{
    bool any = false;
    for (int i = 0; i < law->count; i++) {
        const imp_held_contact *contact = &held->contacts[law->contact[i]];
        if (!slides_on(contact)) continue;
        const qvec3 across = qvec3_cross(contact->normal, contact->direction);
        const double a1 = qvec3_dot(law->contacts[i].axes[1], across), a2 = qvec3_dot(law->contacts[i].axes[2], across),
                     off = a1 * law->u[3 * i + 1] + a2 * law->u[3 * i + 2];
        law->q[3 * i + 1] -= off * a1;
        law->q[3 * i + 2] -= off * a2;
        any = true;
    }
    return any;
}

/* Modes are shown right by the linear system alone: what residual they are found with does not matter. */
static bool solve_law(const imp_held *held, imp_held_law *law)
{
    enum { ROUNDS = 3 };
    send_far(held, law, IMP_MODES_FAR * law->size);
    for (int k = 0; k < ROUNDS; k++) {
        const imp_cone_outcome o = imp_held_law_solve(law);
        if (o.status == IMP_CONE_NO_SOLUTION || o.status == IMP_CONE_BAD) return false;
        if (!straighten(held, law)) return true;
    }
    return true;
}

/* ---- its answer ---- */

static qvec3 along_axes(const qvec3 axes[3], double normal, double t1, double t2)
{
    return qvec3_axpy(normal, axes[0], qvec3_axpy(t1, axes[1], qvec3_scale(axes[2], t2)));
}

/* Slip that begins, where it goes and how hard: not known yet of acceleration that is rounding's, when it goes against
 * the friction. */
static imp_sliding begun_slip(const imp_held_contact *contact, const qvec3 axes[3], double size, const double *r,
                              const double *u)
{
    const double rate = hypot(u[1], u[2]), rubs = hypot(r[1], r[2]);
    if (!(contact->friction > 0)) return (imp_sliding){.stage = IMP_SLIP_GROSS};
    if (rate <= IMP_HOLD_ROUNDING * size)
        return (imp_sliding){.stage = IMP_SLIP_INCIPIENT, .direction = along_axes(axes, 0, -r[1] / rubs, -r[2] / rubs)};
    return (imp_sliding){
        .stage = IMP_SLIP_TURNED, .direction = along_axes(axes, 0, u[1] / rate, u[2] / rate), .mobility = rate / rubs};
}

static void take_mode(imp_pair *pair, const imp_held_contact *contact, const qvec3 axes[3], imp_cone_mode mode,
                      double size, const double *r, const double *u)
{
    pair->rest.reaction = along_axes(axes, r[0], r[1], r[2]);
    if (mode == IMP_CONE_OPEN) {
        pair->mode = IMP_OPEN;
    } else if (mode == IMP_CONE_STICKS) {
        pair->mode = IMP_STICK;
        pair->slip.stage = IMP_SLIP_INCIPIENT; /* until its reaction is chosen */
    } else if (!slides_on(contact)) {
        pair->mode = IMP_SLIDE;
        pair->slip = begun_slip(contact, axes, size, r, u);
    }
}

/* False where what slides on would be stopped at once: that is an impact. */
static bool take_modes(const imp_held *held, imp_world *world, const imp_held_law *law)
{
    double most = 0;
    for (int i = 0; i < law->count; i++) most = fmax(most, law->r[3 * i]);
    for (int i = 0; i < law->count; i++) {
        const imp_held_contact *contact = &held->contacts[law->contact[i]];
        const bool presses = law->r[3 * i] > IMP_PRESSED_OF_LOADS * most;
        if (presses && law->modes[i] == IMP_CONE_STICKS && slides_on(contact)) return false;
        take_mode(&world->pairs[contact->pair], contact, law->contacts[i].axes, presses ? law->modes[i] : IMP_CONE_OPEN,
                  law->size, &law->r[3 * i], &law->u[3 * i]);
    }
    return true;
}

/* The modes of every island that disobeys; false where the law is not solved. */
static bool find_modes(const imp_held *held, imp_world *world, const imp_state *states, const imp_load *loads,
                       imp_held_law *law)
{
    for (int c = 0; c < held->count; c++) {
        if (held->island[c] != c || island_obeys(held, world, c)) continue;
        imp_held_law_find(held, world, states, loads, c, law);
        if (!solve_law(held, law) || !take_modes(held, world, law)) return false;
    }
    return true;
}

static impact_status solve_modes(imp_held *held, imp_world *world, const imp_state *states, const imp_load *loads)
{
    imp_held_law law;
    impact_status status = imp_held_law_take(held->arena, held->count, &law) ? IMPACT_OK : IMPACT_ENOMEM;
    if (status == IMPACT_OK && !find_modes(held, world, states, loads, &law)) status = IMPACT_EUNSETTLED;
    imp_held_law_give(&law);
    if (status == IMPACT_OK) status = imp_held_reserve(held, world, states);
    if (status != IMPACT_OK) return status;
    imp_held_solve(held, world, states, loads);
    status = imp_held_choose(held, world, states, loads);
    if (status != IMPACT_OK) return status;
    return all_obey(held, world) ? IMPACT_OK : IMPACT_EUNSETTLED;
}

/* Sliding that has died out, here or because another contact's did, is rolling until its friction says otherwise. */
static void stop_slow_slides(imp_held *held, imp_world *world, const imp_state *states, const imp_load *loads)
{
    imp_held_find_contacts(held, world, states, loads);
    for (int c = 0; c < held->count; c++) {
        const imp_held_contact *contact = &held->contacts[c];
        if (slides_on(contact) && contact->speed <= world->slip_speed) world->pairs[contact->pair].mode = IMP_STICK;
    }
}

impact_status imp_held_resolve(imp_held *held, imp_world *world, const imp_state *states, const imp_load *loads)
{
    const impact_status status = imp_held_reserve(held, world, states);
    if (status != IMPACT_OK || held->count == 0) return status;
    stop_slow_slides(held, world, states, loads);
    imp_held_solve(held, world, states, loads);
    return all_obey(held, world) ? IMPACT_OK : solve_modes(held, world, states, loads);
}
