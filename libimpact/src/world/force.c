/* SPDX-License-Identifier: MIT */
#include <impact/force.h>
#include "base/definition.h"
#include "base/tolerances.h"

#include <math.h>

void impact_fill_force_def(impact_force_def *def, size_t struct_size, impact_force_kind kind)
{
    const impact_force_def own = {
        .kind = kind,
        .name = kind == IMPACT_FORCE_WIND         ? "wind"
                : kind == IMPACT_FORCE_ATTRACTION ? "attraction"
                                                  : "force",
        .direction = {1, 0, 0},
        .reach = INFINITY,
        .radius = INFINITY,
        .falloff_length = 1,
        .constant = IMP_NEWTONIAN_CONSTANT,
        .power = 2,
        .max_step = NAN,
    };
    imp_definition_give(&own, sizeof own, def, struct_size);
}
