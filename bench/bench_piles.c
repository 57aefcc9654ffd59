/* SPDX-License-Identifier: MIT
 *
 * bench_piles: what scenes cost whose bodies pile up, moved exactly as long as that gets on ("auto") and by steps
 * ("steps"): docs/scene.md, Piles. CSV: scene; piles; s of motion, reached and asked; how it ended; s of CPU, at most
 * some 20; steps of the integrator, events, and steps of the pile; their measured error, m; what the energy account is
 * off by, of the energy lost.
 * Scenes: five balls in a shaft (friction .3, restitution .25); 27 balls on a floor in three layers (.3, .3); 32 balls
 * dropped into a box (.3, .7).
 */
#include <stdio.h>
#include <time.h>
#include <impact/scene.h>
#include "../tests/kit/contact_random.h"

enum { MOST = 40 };

static const double most_cpu = 20;

typedef struct pile_scene {
    const char *name;
    char names[MOST][16];
    impact_body_def bodies[MOST];
    int count;
    double duration;
} pile_scene;

static double cpu_clock(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static impact_body_def *add_body(pile_scene *s, qvec3 position)
{
    impact_body_def *body = &s->bodies[s->count];
    *body = impact_default_body_def();
    snprintf(s->names[s->count], sizeof s->names[0], "%d", s->count);
    body->name = s->names[s->count++];
    body->position = position;
    return body;
}

static void add_plane(pile_scene *s, qvec3 position, quat orientation)
{
    impact_body_def *body = add_body(s, position);
    impact_shape_plane(INFINITY, INFINITY, &body->shape);
    body->is_static = true;
    body->orientation = orientation;
    body->friction = body->restitution = 1;
}

/* A floor and four walls, so far from the middle. */
static void add_walls(pile_scene *s, double x, double y)
{
    const double h = sqrt(0.5);
    add_plane(s, (qvec3){0, 0, 0}, quat_identity());
    add_plane(s, (qvec3){-x, 0, 0}, (quat){h, 0, h, 0});
    add_plane(s, (qvec3){x, 0, 0}, (quat){h, 0, -h, 0});
    add_plane(s, (qvec3){0, -y, 0}, (quat){h, -h, 0, 0});
    add_plane(s, (qvec3){0, y, 0}, (quat){h, h, 0, 0});
}

static impact_body_def *add_ball(pile_scene *s, double radius, qvec3 position, double restitution)
{
    impact_body_def *body = add_body(s, position);
    impact_shape_sphere(radius, &body->shape);
    body->friction = 0.3;
    body->restitution = restitution;
    return body;
}

static pile_scene shaft(void)
{
    const qvec3 at[] = {
        {-0.14, 0, 0.15}, {0.13, 0, 0.2}, {0.01, 0.003, 0.5}, {-0.02, -0.005, 0.8}, {0.02, -0.005, 1.1}};
    pile_scene s = {.name = "5 in a shaft", .duration = 4};
    add_walls(&s, 0.25, 0.11);
    for (int i = 0; i < 5; i++) add_ball(&s, 0.1, at[i], 0.25);
    return s;
}

static pile_scene heap(void)
{
    pile_scene s = {.name = "27 in a heap", .duration = 1};
    random_stream random = {5};
    add_plane(&s, (qvec3){0, 0, 0}, quat_identity());
    for (int i = 0; i < 27; i++) {
        const double x = 0.21 * (i % 3 - 1), y = 0.21 * (i / 3 % 3 - 1);
        const double off = 0.004 * random_unit(&random), aside = 0.004 * random_unit(&random);
        add_ball(&s, 0.1, (qvec3){x + off, y + aside, 0.12 + 0.21 * (i / 9)}, 0.3);
    }
    return s;
}

static pile_scene box(void)
{
    pile_scene s = {.name = "32 in a box", .duration = 2};
    random_stream random = {3};
    add_walls(&s, 0.5, 0.5);
    for (int i = 0; i < 32; i++) {
        const int column = i % 16;
        const double x = 0.22 * (column % 4 - 1.5), y = 0.22 * (column / 4 - 1.5), z = 0.3 + 0.3 * (i / 16);
        const double off = 0.02 * (random_unit(&random) - 0.5), up = 0.05 * random_unit(&random);
        impact_body_def *body = add_ball(&s, 0.08, (qvec3){x + off, y - off, z + up}, 0.7);
        body->velocity = (qvec3){random_unit(&random) - 0.5, random_unit(&random) - 0.5, 0};
    }
    return s;
}

static bool in_time(void *context, double t, double end)
{
    (void)t, (void)end;
    return cpu_clock() < *(const double *)context + most_cpu;
}

static void measure(const pile_scene *s, impact_piles piles)
{
    impact_scene_def def = impact_default_scene_def();
    def.name = s->name;
    def.gravity = (qvec3){0, 0, -9.81};
    def.bodies = s->bodies;
    def.body_count = s->count;
    def.duration = s->duration;
    def.output_rate = 0;
    def.friction_rule = def.restitution_rule = IMPACT_MINIMUM;
    def.piles = piles;
    impact_scene *scene;
    char message[256];
    double begun = cpu_clock();
    if (impact_scene_create(&def, &scene, message, sizeof message) != IMPACT_OK) {
        fprintf(stderr, "bench_piles: %s: %s\n", s->name, message);
        return;
    }
    const impact_recorder recorder = {.context = &begun, .progress = in_time};
    const impact_status status = impact_scene_run(scene, &recorder);
    const double seconds = cpu_clock() - begun;
    const impact_usage usage = impact_scene_usage(scene);
    const impact_energy e = impact_scene_energy(scene);
    const double losses = e.impact_loss + e.sliding_loss;
    long events = 0;
    for (int kind = 0; kind <= IMPACT_EVENT_REST; kind++) events += usage.events[kind];
    printf("%s,%s,%.3f,%g,%s,%.2f,%ld,%ld,%ld,%.2g,%.1g\n", s->name, piles == IMPACT_PILES_STEPS ? "steps" : "auto",
           impact_scene_time(scene), s->duration, impact_status_string(status), seconds, usage.integrator_steps, events,
           usage.pile_steps, impact_scene_pile_error(scene), fabs(e.kinetic + e.potential + losses - e.start) / losses);
    fflush(stdout);
    impact_scene_destroy(scene);
}

int main(void)
{
    const pile_scene scenes[] = {shaft(), heap(), box()};
    printf("scene,piles,reached_s,asked_s,ended,cpu_s,integrator_steps,events,pile_steps,error_m,account\n");
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 2; k++) {
            pile_scene s = scenes[i];
            for (int b = 0; b < s.count; b++) s.bodies[b].name = s.names[b]; /* the copy's own */
            measure(&s, k ? IMPACT_PILES_STEPS : IMPACT_PILES_AUTO);
        }
    return 0;
}
