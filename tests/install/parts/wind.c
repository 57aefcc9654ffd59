/* SPDX-License-Identifier: MIT
 *
 * A ball in a wind that takes it along at a rate of 1e6/s, which is stiff: nothing but CVODE's BDF follows it. It is
 * where it should be, or the run says what is absent. x'' = k (1 - x'): x = t - (1 - e^(-k t))/k.
 */
#include <impact/impact.h>

#include <math.h>
#include <stdio.h>

static const double rate = 1e6;

static bool wind(double t, int body, double mass, qvec3 position, quat orientation, qvec3 velocity, qvec3 omega,
                 qvec3 *force, qvec3 *torque, void *context)
{
    (void)t, (void)body, (void)orientation, (void)position, (void)omega, (void)torque, (void)context;
    *force = qvec3_scale(qvec3_sub(qvec3_make(1, 0, 0), velocity), rate * mass);
    return true;
}

int main(void)
{
    impact_body_def ball = impact_default_body_def();
    impact_force_def force = impact_default_force_def(IMPACT_FORCE_CUSTOM);
    force.name = "wind";
    force.function = wind;
    ball.name = "ball";
    ball.mass = 1;
    if (impact_shape_sphere(0.1, &ball.shape) != IMPACT_OK) return 1;
    impact_scene_def def = impact_default_scene_def();
    def.gravity = qvec3_make(0, 0, 0);
    def.bodies = &ball;
    def.body_count = 1;
    def.forces = &force;
    def.force_count = 1;
    def.duration = 1;
    char message[256] = "";
    impact_scene *scene;
    impact_status status = impact_scene_create(&def, &scene, message, sizeof message);
    if (status == IMPACT_OK) {
        status = impact_scene_run(scene, NULL);
        snprintf(message, sizeof message, "%s", impact_scene_message(scene));
    }
    if (status == IMPACT_EABSENT) return printf("absent: %s\n", message) < 0;
    impact_sample at;
    if (status < 0 || impact_scene_body(scene, 0, &at) != IMPACT_OK || !(fabs(at.position.x - (1 - 1 / rate)) < 1e-8))
        return puts("not where it should be"), 1;
    impact_scene_destroy(scene);
    return puts("flew") < 0;
}
