/* SPDX-License-Identifier: MIT
 *
 * A spinning ball falls from rest and bounces: the first impact of a scene, from C. The same scene in Lua:
 * docs/scene.md.
 *
 *   fall    z = z0 - g t^2/2 until z = r:  t = sqrt(2 (z0 - r)/g) = 0.428426 s
 *   bounce  the contact point slips at v - r w = -2 m/s; friction ends that during the impact: v+ = r w+ = 1 + 4/7 m/s
 *
 *   cc hello.c $(pkg-config --cflags --libs impact) -o hello
 */
#include <impact/impact.h>

#include <stdio.h>

static bool print_impact(void *context, const impact_event *event)
{
    (void)context;
    printf("t = %.12f s: %s meets %s at %.12f m/s (%s)\n", event->t, event->name1, event->name2, -event->normal_before,
           event->phases);
    return true;
}

int main(void)
{
    impact_body_def bodies[2] = {impact_default_body_def(), impact_default_body_def()};
    bodies[0].name = "floor";
    bodies[0].is_static = true;
    bodies[0].friction = bodies[0].restitution = 1;
    bodies[1].name = "ball";
    bodies[1].mass = 0.5;
    bodies[1].position = qvec3_make(0, 0, 1);
    bodies[1].velocity = qvec3_make(1, 0, 0);
    bodies[1].omega = qvec3_make(0, 30, 0);
    bodies[1].friction = 0.3;
    bodies[1].restitution = 0.8;
    if (impact_shape_plane(INFINITY, INFINITY, &bodies[0].shape) != IMPACT_OK) return 1;
    if (impact_shape_sphere(0.1, &bodies[1].shape) != IMPACT_OK) return 1;

    impact_scene_def def = impact_default_scene_def();
    def.bodies = bodies;
    def.body_count = 2;
    def.duration = 2;
    def.max_events = 1;

    char message[256];
    impact_scene *scene;
    if (impact_scene_create(&def, &scene, message, sizeof message) != IMPACT_OK) return puts(message), 1;
    const impact_recorder recorder = {.struct_size = sizeof recorder, .event = print_impact};
    const impact_status status = impact_scene_run(scene, &recorder);
    impact_sample ball;
    if (impact_scene_body(scene, 1, &ball) != IMPACT_OK) return 1;
    printf("v = (%.12f, %g, %.12f) m/s, r w = %.12f m/s\n", ball.velocity.x, ball.velocity.y, ball.velocity.z,
           0.1 * ball.omega.y);
    printf("%s\n", impact_status_string(status));
    impact_scene_destroy(scene);
    return 0;
}
