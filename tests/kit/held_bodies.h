/* SPDX-License-Identifier: MIT
 *
 * What the tests of held contacts share.
 */
#ifndef HELD_BODIES_H
#define HELD_BODIES_H

#include "kit/contact_random.h"
#include "kit/scene_log.h"

static const double mass = 4, radius = 0.3, gravity = 9.81;

static inline impact_body_def ellipsoid_body(const char *name, double a, double b, double c, quat orientation)
{
    impact_body_def body = impact_default_body_def();
    body.name = name;
    body.mass = mass;
    body.orientation = orientation;
    impact_shape_ellipsoid(a, b, c, &body.shape);
    return body;
}

static inline impact_scene_def scene_of(const impact_body_def *bodies, int count, double duration)
{
    impact_scene_def def = impact_default_scene_def();
    def.gravity = (qvec3){0, 0, -gravity};
    def.bodies = bodies;
    def.body_count = count;
    def.duration = duration;
    return def;
}

/* Upwards of z = 0. */
static inline impact_body_def floor_body(void) { return plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 1, 0); }

#endif
