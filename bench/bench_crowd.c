/* SPDX-License-Identifier: MIT
 *
 * What a simulated second of balls that fall into a box costs, and one event, against the number of balls: CSV, with
 * ratios to the smallest case. The box grows with the balls, so that each has as many neighbours.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <impact/scene.h>
#include "measure.h"

enum { WALLS = 5, MOST = 400, REPEATS = 3 };

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* In [0, 1); Park and Miller's. */
static double draw(unsigned long *seed)
{
    *seed = (*seed * 16807) % 2147483647;
    return (double)*seed / 2147483647;
}

static impact_body_def wall(const char *name, qvec3 position, quat orientation)
{
    impact_body_def body = impact_default_body_def();
    body.name = name;
    body.is_static = true;
    body.position = position;
    body.orientation = orientation;
    body.friction = body.restitution = 1;
    impact_shape_plane(INFINITY, INFINITY, &body.shape);
    return body;
}

typedef struct outcome {
    double cpu;
    long events, starts;
    impact_status status;
} outcome;

/* ---- piles ---- */

typedef struct watch {
    double start, most; /* s of the processor */
} watch;

static bool within_time(void *context, double t, double duration)
{
    const watch *w = context;
    (void)t, (void)duration;
    return now() - w->start < w->most;
}

/* Five balls in a shaft as wide as two and a bit, each dropped on the one below: clamped between walls and each other
 * as they settle. */
static void shaft(double friction, double restitution)
{
    static const char *const names[] = {"1", "2", "3", "4", "5"};
    const double h = sqrt(0.5), most = 20;
    const qvec3 at[5] = {
        {-0.14, 0, 0.15}, {0.13, 0, 0.2}, {0.01, 0.003, 0.5}, {-0.02, -0.005, 0.8}, {0.02, -0.005, 1.1}};
    impact_body_def bodies[WALLS + 5] = {wall("floor", (qvec3){0, 0, 0}, (quat){1, 0, 0, 0}),
                                         wall("west", (qvec3){-0.25, 0, 0}, (quat){h, 0, h, 0}),
                                         wall("east", (qvec3){0.25, 0, 0}, (quat){h, 0, -h, 0}),
                                         wall("south", (qvec3){0, -0.11, 0}, (quat){h, -h, 0, 0}),
                                         wall("north", (qvec3){0, 0.11, 0}, (quat){h, h, 0, 0})};
    for (int i = 0; i < 5; i++) {
        impact_body_def *body = &bodies[WALLS + i];
        *body = impact_default_body_def();
        body->name = names[i];
        impact_shape_sphere(0.1, &body->shape);
        body->position = at[i];
        body->friction = friction;
        body->restitution = restitution;
    }
    impact_scene_def def = impact_default_scene_def();
    def.bodies = bodies;
    def.body_count = WALLS + 5;
    def.friction_rule = def.restitution_rule = IMPACT_MINIMUM;
    def.duration = 4;
    impact_scene *scene;
    if (impact_scene_create(&def, &scene, NULL, 0) != IMPACT_OK) return;
    watch w = {.start = now(), .most = most};
    const impact_recorder recorder = {.context = &w, .progress = within_time};
    const impact_status status = impact_scene_run(scene, &recorder);
    const double cpu = now() - w.start, reached = impact_scene_time(scene);
    const impact_usage usage = impact_scene_usage(scene);
    printf("%g,%g,%.3f,%.3g,%ld,%ld,%s\n", friction, restitution, reached, cpu / reached, usage.integrator_starts,
           usage.integrator_steps, impact_status_string(status));
    fflush(stdout);
    impact_scene_destroy(scene);
}

/* ---- balls in a box ---- */

static outcome fall(int balls, double friction, double restitution, double duration)
{
    static char names[MOST][16];
    static impact_body_def bodies[WALLS + MOST];
    const int side = (int)ceil(sqrt(balls / 2.0));
    const double h = sqrt(0.5), half = 0.11 * side + 0.05;
    bodies[0] = wall("floor", (qvec3){0, 0, 0}, (quat){1, 0, 0, 0});
    bodies[1] = wall("west", (qvec3){-half, 0, 0}, (quat){h, 0, h, 0});
    bodies[2] = wall("east", (qvec3){half, 0, 0}, (quat){h, 0, -h, 0});
    bodies[3] = wall("south", (qvec3){0, -half, 0}, (quat){h, -h, 0, 0});
    bodies[4] = wall("north", (qvec3){0, half, 0}, (quat){h, h, 0, 0});
    unsigned long seed = 1;
    for (int i = 0; i < balls; i++) {
        const int cell = i % (side * side), layer = i / (side * side);
        impact_body_def *body = &bodies[WALLS + i];
        snprintf(names[i], sizeof names[i], "ball %d", i);
        *body = impact_default_body_def();
        body->name = names[i];
        impact_shape_sphere(0.08, &body->shape);
        body->position = (qvec3){0.22 * (cell % side - 0.5 * (side - 1)) + 0.02 * (draw(&seed) - 0.5),
                                 0.22 * (cell / side - 0.5 * (side - 1)) + 0.02 * (draw(&seed) - 0.5),
                                 0.3 + 0.25 * layer + 0.02 * draw(&seed)};
        body->velocity = (qvec3){draw(&seed) - 0.5, draw(&seed) - 0.5, 0};
        body->friction = friction;
        body->restitution = restitution;
    }
    impact_scene_def def = impact_default_scene_def();
    def.bodies = bodies;
    def.body_count = WALLS + balls;
    def.friction_rule = def.restitution_rule = IMPACT_MINIMUM;
    def.duration = duration;
    impact_scene *scene;
    outcome result = {.status = impact_scene_create(&def, &scene, NULL, 0)};
    if (result.status != IMPACT_OK) return result;
    const double start = now();
    result.status = impact_scene_run(scene, NULL);
    result.cpu = now() - start;
    const impact_usage usage = impact_scene_usage(scene);
    for (int k = 0; k <= IMPACT_EVENT_REST; k++) result.events += usage.events[k];
    result.starts = usage.integrator_starts;
    impact_scene_destroy(scene);
    return result;
}

int main(void)
{
    static const int sizes[] = {10, 20, 50, 100, 200, 400};
    static const struct {
        const char *name;
        double friction, restitution;
    } kinds[] = {{"elastic", 0, 1}, {"rough", 0.3, 0.8}};
    const double duration = 0.6;
    printf("kind,balls,events,integrator_starts,cpu_per_second,per_event_us,cpu_ratio,per_event_ratio,status\n");
    for (int k = 0; k < 2; k++) {
        double first_cpu = 0, first_event = 0;
        for (int s = 0; s < 6; s++) {
            double times[REPEATS];
            outcome result = {0};
            for (int r = 0; r < REPEATS; r++) {
                result = fall(sizes[s], kinds[k].friction, kinds[k].restitution, duration);
                times[r] = result.cpu;
            }
            const double time = measure_quantile(times, REPEATS, 0.5), cpu = time / duration,
                         event = time / (double)(result.events ? result.events : 1);
            if (s == 0) first_cpu = cpu, first_event = event;
            printf("%s,%d,%ld,%ld,%.3g,%.3g,%.3g,%.3g,%s\n", kinds[k].name, sizes[s], result.events, result.starts, cpu,
                   1e6 * event, cpu / first_cpu, event / first_event, impact_status_string(result.status));
            fflush(stdout);
        }
    }
    printf("\npile_friction,pile_restitution,reached_s,cpu_per_second,integrator_starts,integrator_steps,status\n");
    for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++) shaft(0.3 * k, 0.25 * l);
    return 0;
}
