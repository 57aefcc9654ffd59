/* SPDX-License-Identifier: MIT
 *
 * One ball over a floor, from C: event by event, a push now and then, saved and tried again. What was saved
 * goes on with the same bits, in another scene of the same definition too.
 *
 *   cc saved.c $(pkg-config --cflags --libs impact) -o saved
 */
#include <impact/impact.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static impact_scene *make_scene(void)
{
    impact_body_def bodies[2] = {impact_default_body_def(), impact_default_body_def()};
    bodies[0].name = "floor";
    bodies[0].is_static = true;
    bodies[0].friction = bodies[0].restitution = 1;
    bodies[1].name = "ball";
    bodies[1].mass = 0.5;
    bodies[1].position = qvec3_make(0, 0, 1);
    bodies[1].friction = 0.3;
    bodies[1].restitution = 0.5;
    impact_scene_def def = impact_default_scene_def();
    impact_scene *scene = NULL;
    char message[256];
    if (impact_shape_plane(INFINITY, INFINITY, &bodies[0].shape) != IMPACT_OK) return NULL;
    if (impact_shape_sphere(0.1, &bodies[1].shape) != IMPACT_OK) return NULL;
    def.bodies = bodies;
    def.body_count = 2;
    def.duration = 60;
    if (impact_scene_create(&def, &scene, message, sizeof message) != IMPACT_OK) puts(message);
    return scene;
}

/* To the end of the third bounce after a push to the side. */
static impact_sample play(impact_scene *scene, double push)
{
    impact_sample ball;
    impact_event event;
    impact_scene_body(scene, 1, &ball);
    impact_scene_push(scene, 1, qvec3_make(push, 0, 0), ball.position);
    for (int k = 0; k < 3; k++) impact_scene_step(scene, 60, NULL, &event);
    printf("push %g N s: %s of %s at t = %.9f s, x = %.9f m\n", push, impact_event_name(event.kind), event.name1,
           event.t, event.point.x);
    impact_scene_body(scene, 1, &ball);
    return ball;
}

int main(void)
{
    impact_scene *scene = make_scene(), *other = make_scene();
    impact_event event;
    if (!scene || !other) return 1;
    impact_scene_step(scene, 60, NULL, &event);
    printf("t = %.9f s: %s\n", event.t, event.phases);

    size_t size;
    if (impact_scene_save(scene, NULL, &size) != IMPACT_OK) return 1;
    void *bytes = malloc(size);
    if (!bytes || impact_scene_save(scene, bytes, &size) != IMPACT_OK) return 1;
    play(scene, 1);
    if (impact_scene_load(scene, bytes, size) != IMPACT_OK) return 1;
    const impact_sample a = play(scene, 0.25);
    if (impact_scene_load(other, bytes, size) != IMPACT_OK) return 1;
    const impact_sample b = play(other, 0.25);
    puts(memcmp(&a.position, &b.position, sizeof a.position) == 0 ? "the same bits" : "other bits");

    ((char *)bytes)[size / 2] ^= 1;
    if (impact_scene_load(other, bytes, size) != IMPACT_OK) puts(impact_scene_message(other));

    impact_held held;
    const impact_status status = impact_scene_run(scene, NULL);
    const int count = impact_scene_held(scene, &held, 1);
    printf("%s; %d held, with %.9f N\n", impact_status_string(status), count, held.force.z);
    free(bytes);
    impact_scene_destroy(scene);
    impact_scene_destroy(other);
    return 0;
}
