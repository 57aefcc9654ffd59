/* SPDX-License-Identifier: MIT
 *
 * Whether two scenes are in the same state, bit for bit.
 */
#ifndef SAME_BITS_H
#define SAME_BITS_H

#include <string.h>
#include <impact/scene.h>
#include "kit/near.h"

/* Body i of a and body j of b. */
static inline bool same_body(const impact_scene *a, int i, const impact_scene *b, int j)
{
    impact_sample x, y;
    if (impact_scene_body(a, i, &x) != IMPACT_OK || impact_scene_body(b, j, &y) != IMPACT_OK) return false;
    return memcmp(&x.position, &y.position, sizeof x.position) == 0 &&
           memcmp(&x.orientation, &y.orientation, sizeof x.orientation) == 0 &&
           memcmp(&x.velocity, &y.velocity, sizeof x.velocity) == 0 && memcmp(&x.omega, &y.omega, sizeof x.omega) == 0;
}

/* All bodies, the time and the books. */
static inline bool same_scene(const impact_scene *a, const impact_scene *b)
{
    bool same = impact_scene_time(a) == impact_scene_time(b);
    for (int i = 0; i < impact_scene_body_count(a); i++) same = same && same_body(a, i, b, i);
    const impact_energy x = impact_scene_energy(a), y = impact_scene_energy(b);
    return same && memcmp(&x, &y, sizeof x) == 0;
}

#endif
