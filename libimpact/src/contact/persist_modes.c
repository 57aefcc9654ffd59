/* SPDX-License-Identifier: MIT
 *
 * Where giving way one contact after another leads to no consistent modes, all there are of few contacts are tried.
 */
#include "contact/persist_system.h"

#include <math.h>

enum { FEW = 4, CHOICES = 3 };

/* Contacts whose slip is at rest, and what each would slide against. */
typedef struct contact_set {
    int count;
    int pair[FEW];
    qvec3 direction[FEW];
} contact_set;

/* The contacts that may roll, slide or open; false when they are too many. */
static bool list_candidates(const imp_persist *persist, contact_set *set)
{
    set->count = 0;
    for (int c = 0; c < persist->count; c++) {
        const imp_touch *touch = &persist->touches[c];
        if (touch->still || touch->friction == 0 || (touch->mode == IMP_SLIDE && !touch->onset)) continue;
        if (set->count == FEW) return false;
        set->pair[set->count] = touch->pair;
        set->direction[set->count++] = touch->onset ? touch->direction : imp_against_friction(touch);
    }
    return true;
}

static void choose(const contact_set *set, imp_world *world, int choice)
{
    for (int k = 0; k < set->count; k++, choice /= CHOICES) {
        imp_pair *pair = &world->pairs[set->pair[k]];
        pair->mode = choice % CHOICES == 0 ? IMP_ROLL : choice % CHOICES == 1 ? IMP_SLIDE : IMP_OPEN;
        pair->slip = (imp_sliding){.age = pair->mode == IMP_SLIDE ? IMP_SLIP_BEGUN : IMP_SLIP_OLD,
                                   .direction = set->direction[k]};
    }
}

static bool presses_and_holds(const imp_persist *persist)
{
    double scale = 0;
    for (int c = 0; c < persist->count; c++) scale = fmax(scale, qvec3_norm(persist->touches[c].force));
    for (int c = 0; c < persist->count; c++) {
        const imp_touch *touch = &persist->touches[c];
        if (touch->still) continue;
        if (touch->pressure < -IMP_MODE_ROUNDING * scale || (touch->onset && touch->drive < 1 - IMP_DRIVE_ROUNDING))
            return false;
        if (touch->mode == IMP_ROLL && touch->margin < -IMP_MODE_ROUNDING * scale) return false;
    }
    return true;
}

/* Whether what was opened parts under the loads and the reactions. */
static bool parts(const imp_persist *persist, imp_world *world, const contact_set *set, const imp_state *states,
                  const imp_load *loads)
{
    for (int k = 0; k < set->count; k++) {
        if (imp_is_held(&world->pairs[set->pair[k]])) continue;
        const imp_touch touch = imp_persist_touch(world, set->pair[k], states, loads);
        const double push = qvec3_norm(loads[touch.body1].force) * world->bodies[touch.body1].inverse_mass;
        const double acceleration = qvec3_dot(touch.normal, qvec3_add(touch.bias, imp_system_change(persist, &touch))) +
                                    qvec3_dot(touch.normal_rate, touch.slip);
        if (acceleration < -IMP_MODE_ROUNDING * push) return false;
    }
    return true;
}

impact_status imp_persist_try_modes(imp_persist *persist, imp_world *world, const imp_state *states,
                                    const imp_load *loads)
{
    contact_set set;
    bool found = false;
    if (!list_candidates(persist, &set)) return IMPACT_OK;
    int choices = 1;
    for (int k = 0; k < set.count; k++) choices *= CHOICES;
    imp_pair kept[FEW];
    for (int k = 0; k < set.count; k++) kept[k] = world->pairs[set.pair[k]];
    impact_status status = IMPACT_OK;
    for (int choice = 0; status == IMPACT_OK && choice < choices && !found; choice++) {
        choose(&set, world, choice);
        status = imp_persist_reserve(persist, world, states);
        if (status != IMPACT_OK) break;
        imp_persist_solve(persist, world, states, loads);
        found = presses_and_holds(persist) && parts(persist, world, &set, states, loads);
    }
    if (found || status != IMPACT_OK) return status;
    for (int k = 0; k < set.count; k++) world->pairs[set.pair[k]] = kept[k];
    status = imp_persist_reserve(persist, world, states);
    if (status == IMPACT_OK) imp_persist_solve(persist, world, states, loads);
    return status;
}

void imp_persist_stop_onsets(imp_persist *persist, imp_world *world, const imp_state *states, const imp_load *loads)
{
    imp_persist_solve(persist, world, states, loads);
    for (int c = 0; c < persist->count; c++) {
        imp_pair *pair = &world->pairs[persist->touches[c].pair];
        if (!persist->touches[c].onset || persist->touches[c].drive > 1 + IMP_DRIVE_ROUNDING) continue;
        pair->mode = IMP_ROLL;
        imp_end_onset(pair);
    }
}
