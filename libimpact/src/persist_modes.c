/* SPDX-License-Identifier: MIT
 *
 * Where giving way one contact after another leads to no consistent modes, all there are of few contacts are tried.
 */
#include "persist_system.h"

#include <math.h>

enum { FEW = 4, CHOICES = 3 };

/* Contacts whose slip is at rest, and what each would slide against. */
typedef struct contact_set {
    int count;
    int pair[FEW];
    qvec3 direction[FEW];
} contact_set;

/* The contacts that may roll, slide or open; false when they are too many. */
static bool list_candidates(const impact_persist *persist, contact_set *set)
{
    set->count = 0;
    for (int c = 0; c < persist->count; c++) {
        const impact_touch *touch = &persist->touches[c];
        if (touch->still || touch->friction == 0 || (touch->mode == IMPACT_SLIDE && !touch->onset)) continue;
        if (set->count == FEW) return false;
        set->pair[set->count] = touch->pair;
        set->direction[set->count++] = touch->onset ? touch->direction : impact_against_friction(touch);
    }
    return true;
}

static void choose(const contact_set *set, impact_world *world, int choice)
{
    for (int k = 0; k < set->count; k++, choice /= CHOICES) {
        impact_pair *pair = &world->pairs[set->pair[k]];
        pair->mode = choice % CHOICES == 0 ? IMPACT_ROLL : choice % CHOICES == 1 ? IMPACT_SLIDE : IMPACT_OPEN;
        pair->onset = pair->mode == IMPACT_SLIDE;
        pair->direction = set->direction[k];
        pair->turned = false;
    }
}

static bool presses_and_holds(const impact_persist *persist)
{
    double scale = 0;
    for (int c = 0; c < persist->count; c++) scale = fmax(scale, qvec3_norm(persist->touches[c].force));
    for (int c = 0; c < persist->count; c++) {
        const impact_touch *touch = &persist->touches[c];
        if (touch->still) continue;
        if (touch->pressure < -1e-12 * scale || (touch->onset && touch->drive < 1 - 1e-9)) return false;
        if (touch->mode == IMPACT_ROLL && touch->margin < -1e-12 * scale) return false;
    }
    return true;
}

/* Whether what was opened parts under the loads and the reactions. */
static bool parts(const impact_persist *persist, impact_world *world, const contact_set *set,
                  const impact_state *states, const impact_load *loads)
{
    for (int k = 0; k < set->count; k++) {
        if (impact_is_held(&world->pairs[set->pair[k]])) continue;
        const impact_touch touch = impact_persist_touch(world, set->pair[k], states, loads);
        const double push = qvec3_norm(loads[touch.body1].force) * world->bodies[touch.body1].inverse_mass;
        const double acceleration =
            qvec3_dot(touch.normal, qvec3_add(touch.bias, impact_system_change(persist, &touch))) +
            qvec3_dot(touch.normal_rate, touch.slip);
        if (acceleration < -1e-12 * push) return false;
    }
    return true;
}

impact_status impact_persist_try_modes(impact_persist *persist, impact_world *world, const impact_state *states,
                                       const impact_load *loads)
{
    contact_set set;
    bool found = false;
    if (!list_candidates(persist, &set)) return IMPACT_OK;
    int choices = 1;
    for (int k = 0; k < set.count; k++) choices *= CHOICES;
    impact_pair kept[FEW];
    for (int k = 0; k < set.count; k++) kept[k] = world->pairs[set.pair[k]];
    impact_status status = IMPACT_OK;
    for (int choice = 0; status == IMPACT_OK && choice < choices && !found; choice++) {
        choose(&set, world, choice);
        status = impact_persist_reserve(persist, world, states);
        if (status != IMPACT_OK) break;
        impact_persist_solve(persist, world, states, loads);
        found = presses_and_holds(persist) && parts(persist, world, &set, states, loads);
    }
    if (found || status != IMPACT_OK) return status;
    for (int k = 0; k < set.count; k++) world->pairs[set.pair[k]] = kept[k];
    status = impact_persist_reserve(persist, world, states);
    if (status == IMPACT_OK) impact_persist_solve(persist, world, states, loads);
    return status;
}

void impact_persist_stop_onsets(impact_persist *persist, impact_world *world, const impact_state *states,
                                const impact_load *loads)
{
    impact_persist_solve(persist, world, states, loads);
    for (int c = 0; c < persist->count; c++) {
        impact_pair *pair = &world->pairs[persist->touches[c].pair];
        if (!persist->touches[c].onset || persist->touches[c].drive > 1 + 1e-9) continue;
        pair->mode = IMPACT_ROLL;
        pair->onset = false;
    }
}
