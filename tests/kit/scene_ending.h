/* SPDX-License-Identifier: MIT
 *
 * Small scenes, run to their end, and all that the public interface tells of it.
 */
#ifndef SCENE_ENDING_H
#define SCENE_ENDING_H

#include <stdio.h>
#include "kit/scene_log.h"

static inline impact_body_def ball(const char *name, double radius, qvec3 position, qvec3 velocity)
{
    impact_body_def body = impact_default_body_def();
    body.name = name;
    body.mass = 1;
    body.position = position;
    body.velocity = velocity;
    impact_shape_sphere(radius, &body.shape);
    return body;
}

static inline impact_body_def box(const char *name, qvec3 half, double exponent, qvec3 position, double friction)
{
    impact_body_def body = impact_default_body_def();
    body.name = name;
    body.position = position;
    body.friction = friction;
    body.restitution = 0;
    impact_shape_superquadric(half.x, half.y, half.z, exponent, exponent, exponent, &body.shape);
    return body;
}

static inline impact_body_def floor_body(double friction, double restitution)
{
    return plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), friction, restitution);
}

static inline impact_scene_def scene_of(const impact_body_def *bodies, int count, double duration)
{
    impact_scene_def def = impact_default_scene_def();
    def.bodies = bodies;
    def.body_count = count;
    def.duration = duration;
    def.output_rate = 0;
    return def;
}

typedef struct ending {
    impact_status status;
    char message[512];
    impact_sample body; /* the last of the definition */
    double t;
    impact_energy energy;
    impact_usage usage;
    impact_scene_residuals residuals;
} ending;

static inline ending run_logged(const impact_scene_def *def, scene_log *log)
{
    impact_scene *scene = make_scene(def);
    const impact_recorder recorder =
        log ? log_recorder(log) : (impact_recorder){.struct_size = sizeof(impact_recorder)};
    ending e = {.status = impact_scene_run(scene, log ? &recorder : NULL)};
    snprintf(e.message, sizeof e.message, "%s", impact_scene_message(scene));
    impact_scene_body(scene, def->body_count - 1, &e.body);
    e.body.name = NULL; /* gone with the scene */
    e.t = impact_scene_time(scene);
    e.energy = impact_scene_energy(scene);
    e.usage = impact_scene_usage(scene);
    impact_scene_receipt(scene, &e.residuals);
    impact_scene_destroy(scene);
    return e;
}

static inline ending run(const impact_scene_def *def) { return run_logged(def, NULL); }

static inline void assert_good(const ending *e)
{
    if (e->status != IMPACT_OK && e->status != IMPACT_AT_REST) fail_msg("status %d: %s", e->status, e->message);
    if (e->residuals.failed) fail_msg("the receipt fails: %s", e->residuals.failed);
}

/* Not good, and it says so. */
static inline bool refused(const ending *e)
{
    if (e->status == IMPACT_OK || e->status == IMPACT_AT_REST) return false;
    assert_true(e->message[0] != '\0');
    return true;
}

#endif
