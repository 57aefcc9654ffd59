/* SPDX-License-Identifier: MIT */
#include <impact/scene.h>
#include "base/definition.h"
#include "base/tolerances.h"

#include <math.h>

void impact_fill_scene_def(impact_scene_def *def, size_t struct_size)
{
    const impact_scene_def own = {
        .name = "scene",
        .gravity = {0, 0, -9.80665}, /* standard gravity, CGPM 1901 */
        .duration = 1,
        .output_rate = 24,
        .friction_rule = IMPACT_PRODUCT,
        .restitution_rule = IMPACT_PRODUCT,
        .law = IMPACT_POISSON,
        .solver = IMPACT_SOLVER_AUTO,
        .tolerance = IMP_DEFAULT_TOLERANCE,
        .rest_height = IMP_DEFAULT_REST_HEIGHT,
        .rest_speed = IMP_DEFAULT_REST_SPEED,
        .max_events = 1000000,
        .max_steps = 100000000,
        .key_tolerance = IMP_DEFAULT_KEY_TOLERANCE,
        .piles = IMPACT_PILES_AUTO,
        .together = IMPACT_SCENE_TOGETHER_AUTO,
        .samples = IMPACT_SAMPLES_ALL,
        .pile_tolerance = IMP_DEFAULT_PILE_TOLERANCE,
    };
    imp_definition_give(&own, sizeof own, def, struct_size);
}

void impact_fill_body_def(impact_body_def *def, size_t struct_size)
{
    const impact_body_def own = {
        .mass = NAN,
        .density = 1000,
        .moments = {NAN, NAN, NAN},
        .orientation = {1, 0, 0, 0},
        .shape_orientation = {1, 0, 0, 0},
        .friction = 0.5,
        .restitution = 0.5,
    };
    imp_definition_give(&own, sizeof own, def, struct_size);
}

void impact_fill_pair_def(impact_pair_def *def, size_t struct_size)
{
    const impact_pair_def own = {
        .friction = NAN, .restitution = NAN, .stiffness = NAN, .torsional_friction = NAN, .rolling_friction = NAN};
    imp_definition_give(&own, sizeof own, def, struct_size);
}
