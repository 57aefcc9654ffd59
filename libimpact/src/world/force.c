/* SPDX-License-Identifier: MIT */
#include <impact/force.h>

#include <math.h>

impact_force_def impact_default_force_def(impact_force_kind kind)
{
    return (impact_force_def){
        .kind = kind,
        .name = kind == IMPACT_FORCE_WIND         ? "wind"
                : kind == IMPACT_FORCE_ATTRACTION ? "attraction"
                                                  : "force",
        .direction = {1, 0, 0},
        .reach = INFINITY,
        .radius = INFINITY,
        .falloff_length = 1,
        .constant = 6.67430e-11,
        .power = 2,
        .max_step = NAN,
    };
}
