/* SPDX-License-Identifier: MIT */
#include "scene/rules.h"

#include <stdlib.h>

static int by_rule_bodies(const void *a, const void *b)
{
    const imp_own_rule *x = a, *y = b;
    if (x->low != y->low) return (x->low > y->low) - (x->low < y->low);
    return (x->high > y->high) - (x->high < y->high);
}

impact_status imp_rules_open(imp_rules *rules, imp_arena *arena, const impact_scene_def *def, const imp_names *names)
{
    *rules = (imp_rules){.friction = def->friction_rule,
                         .restitution = def->restitution_rule,
                         .own = imp_arena_take(arena, (size_t)def->pair_count, sizeof *rules->own)};
    if (!rules->own) return IMPACT_ENOMEM;
    for (int k = 0; k < def->pair_count; k++) {
        const int i = imp_names_find(names, def->pairs[k].body1), j = imp_names_find(names, def->pairs[k].body2);
        rules->own[rules->own_count++] = (imp_own_rule){.low = i < j ? i : j,
                                                        .high = i < j ? j : i,
                                                        .friction = def->pairs[k].friction,
                                                        .restitution = def->pairs[k].restitution,
                                                        .torsional = def->pairs[k].torsional_friction,
                                                        .rolling = def->pairs[k].rolling_friction,
                                                        .stiffness = def->pairs[k].stiffness};
    }
    qsort(rules->own, (size_t)rules->own_count, sizeof *rules->own, by_rule_bodies);
    return IMPACT_OK;
}

const imp_own_rule *imp_rules_second(const imp_rules *rules)
{
    for (int k = 1; k < rules->own_count; k++)
        if (by_rule_bodies(&rules->own[k - 1], &rules->own[k]) == 0) return &rules->own[k];
    return NULL;
}

static double joined(impact_pair_rule rule, double a, double b)
{
    switch (rule) {
    case IMPACT_PRODUCT: return a * b;
    case IMPACT_GEOMETRIC_MEAN: return sqrt(a * b);
    case IMPACT_MINIMUM: return fmin(a, b);
    case IMPACT_MAXIMUM: return fmax(a, b);
    }
    return 0;
}

static const imp_own_rule *own_of(const imp_rules *rules, int low, int high)
{
    int first = 0, end = rules->own_count;
    const imp_own_rule sought = {.low = low, .high = high};
    while (first < end) {
        const int middle = (first + end) / 2;
        if (by_rule_bodies(&rules->own[middle], &sought) < 0)
            first = middle + 1;
        else
            end = middle;
    }
    const imp_own_rule *own = &rules->own[first];
    return first < rules->own_count && own->low == low && own->high == high ? own : NULL;
}

imp_pair imp_rules_pair(const imp_rules *rules, const imp_world *world, int i, int j)
{
    const int low = i < j ? i : j, high = i < j ? j : i;
    const imp_body *a = &world->bodies[low], *b = &world->bodies[high];
    imp_pair pair = {.body1 = a->is_static ? high : low,
                     .body2 = a->is_static ? low : high,
                     .law.friction = joined(rules->friction, a->friction, b->friction),
                     .law.restitution = joined(rules->restitution, a->restitution, b->restitution),
                     .law.torsional = a->torsional + b->torsional,
                     .law.rolling = a->rolling + b->rolling};
    const imp_own_rule *own = rules->own_count > 0 ? own_of(rules, low, high) : NULL;
    if (own && !isnan(own->friction)) pair.law.friction = own->friction;
    if (own && !isnan(own->restitution)) pair.law.restitution = own->restitution;
    if (own && !isnan(own->torsional)) pair.law.torsional = own->torsional;
    if (own && !isnan(own->rolling)) pair.law.rolling = own->rolling;
    if (own && own->stiffness > 0) pair.law.stiffness = own->stiffness;
    return pair;
}
