/* SPDX-License-Identifier: MIT
 *
 * rules: frictions and restitution of any two bodies of a scene, from their materials or their own rule. Internal.
 */
#ifndef IMP_RULES_H
#define IMP_RULES_H

#include <impact/scene.h>
#include "scene/names.h"
#include "world/world.h"

typedef struct imp_own_rule {
    int low, high; /* the bodies' indices */
    double friction, restitution, torsional, rolling, stiffness;
} imp_own_rule;

typedef struct imp_rules {
    impact_pair_rule friction, restitution;
    imp_own_rule *own; /* sorted by their bodies */
    int own_count;
} imp_rules;

impact_status imp_rules_open(imp_rules *rules, imp_arena *arena, const impact_scene_def *def, const imp_names *names);

/* The second of two rules for one pair; NULL: every pair has one at most. */
const imp_own_rule *imp_rules_second(const imp_rules *rules);

/* An open pair of the world's bodies i and j: one that moves first, else as the definition has them. */
imp_pair imp_rules_pair(const imp_rules *rules, const imp_world *world, int i, int j);

#endif
