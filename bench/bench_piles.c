/* SPDX-License-Identifier: MIT
 *
 * bench_piles: what scenes cost whose bodies pile up, moved exactly as long as that gets on ("auto") and by steps
 * ("steps"): docs/scene.md, Piles. CSV: scene; piles; s of motion, reached and asked; how it ended; s of CPU, at most
 * some 20; steps of the integrator, events, and steps of the pile; what these leave places uncertain by, m, and from
 * when on motions part; what the energy account is off by, of the energy lost. Scenes: five balls in a shaft (friction
 * .3, restitution .25); 27 balls on a floor in three layers (.3, .3); 32 balls dropped into a box (.3, .7). Of boxes: a
 * cube that falls on a corner (.5, .3), ten set on each other with masses 1 and 1e4 in turn, five dropped with offsets,
 * two dice thrown (.4, .5), five dominoes and twenty (.3, .3), a wall of thirty bricks that a ball strikes (.6, .1);
 * median and slowest of nine such rows of twenty, pushed ever harder, of nine walls, struck ever farther aside, and of
 * sets of three bodies with faces, dropped (.2 ... .8, 0 ... .6): docs/faces.md. And error against run time, of the
 * first .2 s of five dominoes: pile_tolerance; s of CPU; steps; the error that is told, m; and by how much places of
 * bodies are off, m, from those with 1e-7.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
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
    impact_scene_together together;
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

/* ---- boxes ---- */

static impact_body_def *add_box(pile_scene *s, qvec3 half, double rounding, double mass, qvec3 position,
                                double friction, double restitution)
{
    impact_body_def *body = add_body(s, position);
    impact_shape_box(half.x, half.y, half.z, rounding, &body->shape);
    body->mass = mass;
    body->friction = friction;
    body->restitution = restitution;
    return body;
}

static quat turned(qvec3 axis, double angle)
{
    quat q = quat_identity();
    (void)quat_from_axis_angle(axis, angle, &q);
    return q;
}

static pile_scene cube(void)
{
    pile_scene s = {.name = "a cube falls", .duration = 2};
    add_plane(&s, (qvec3){0, 0, 0}, quat_identity());
    add_box(&s, (qvec3){0.1, 0.1, 0.1}, 0, 1, (qvec3){0, 0, 0.3}, 0.5, 0.3)->orientation =
        turned((qvec3){1, 0.3, 0.2}, 0.4);
    return s;
}

static pile_scene stack(int count, double apart, double heavy, const char *name)
{
    pile_scene s = {.name = name, .duration = 2};
    add_plane(&s, (qvec3){0, 0, 0}, quat_identity());
    for (int i = 1; i <= count; i++)
        add_box(&s, (qvec3){0.1, 0.1, 0.05}, 0, i % 2 ? 1 : heavy,
                (qvec3){0.03 * (i % 3), 0.02 * (i % 2), 0.05 + apart + (0.1 + apart) * (i - 1)}, 0.5, 0.3);
    return s;
}

static pile_scene dice(void)
{
    const qvec3 spins[] = {{10, 20, 5}, {-10, 15, 5}};
    pile_scene s = {.name = "two dice", .duration = 3};
    add_plane(&s, (qvec3){0, 0, 0}, quat_identity());
    for (int i = 0; i < 2; i++) {
        impact_body_def *die =
            add_box(&s, (qvec3){0.008, 0.008, 0.008}, 1e-3, 5e-3, (qvec3){0, 0.03 * i, 0.1}, 0.4, 0.5);
        die->velocity = (qvec3){0.5, -0.06 * i, 0};
        die->omega = spins[i];
        die->orientation = turned((qvec3){1, 0.3, 0.2}, 0.4 + i);
    }
    return s;
}

/* In a row, the first pushed; the more so the greater the number. */
static pile_scene dominoes(int count, const char *name, uint64_t number)
{
    pile_scene s = {.name = name, .duration = 2};
    add_plane(&s, (qvec3){0, 0, 0}, quat_identity());
    for (int i = 0; i < count; i++)
        add_box(&s, (qvec3){0.004, 0.012, 0.024}, 0, 0.008, (qvec3){0.02 * i, 0, 0.024}, 0.3, 0.3);
    s.bodies[1].velocity = (qvec3){0.1, 0, 0};
    s.bodies[1].omega = (qvec3){0, 4 + 0.05 * (double)number, 0};
    return s;
}

static pile_scene twenty_dominoes(uint64_t number) { return dominoes(20, "20 dominoes", number); }

/* A wall of five courses of six, laid dry in bond; a ball of 2 kg comes at 5 m/s, the farther aside the greater the
 * number. */
static pile_scene bricks(uint64_t number)
{
    enum { COURSES = 5, BRICKS = 6 };
    pile_scene s = {.name = "30 bricks struck", .duration = 0.5, .together = IMPACT_SCENE_MOREAU};
    add_plane(&s, (qvec3){0, 0, 0}, quat_identity());
    for (int i = 0; i < COURSES * BRICKS; i++) {
        const int course = i / BRICKS;
        const double x = 0.2 * (i % BRICKS - (BRICKS - 1) / 2.0) + (course % 2 ? 0.05 : -0.05);
        add_box(&s, (qvec3){0.1, 0.05, 0.03}, 0, 2.4, (qvec3){x, 0, 0.03 + 0.06 * course}, 0.6, 0.1);
    }
    impact_body_def *ball = add_body(&s, (qvec3){0.03 + 0.004 * (double)number, -0.4, 0.17});
    impact_shape_sphere(0.06, &ball->shape);
    ball->mass = 2;
    ball->velocity = (qvec3){0, 5, 0.3};
    ball->friction = 0.4, ball->restitution = 0.3;
    return s;
}

/* Three bodies of kinds and sizes that the seed draws, one over another. */
static pile_scene drawn(uint64_t seed)
{
    pile_scene s = {.name = "3 drawn", .duration = 2};
    random_stream random = {seed + 1};
    add_plane(&s, (qvec3){0, 0, 0}, quat_identity());
    for (int i = 0; i < 3; i++) {
        const double a = 0.03 + 0.07 * random_unit(&random), b = 0.03 + 0.07 * random_unit(&random),
                     c = 0.03 + 0.07 * random_unit(&random);
        impact_body_def *body = add_body(&s, (qvec3){0.05 * random_unit(&random), 0, 0.25 + 0.25 * i});
        switch (random_bits(&random) % 4) {
        case 0: impact_shape_box(a, b, c, 0, &body->shape); break;
        case 1: impact_shape_cylinder(a, c, 0, &body->shape); break;
        case 2: impact_shape_cone(a, 2 * c, 0, &body->shape); break;
        default: impact_shape_capsule(0.4 * a, 0.4 * a + c, &body->shape);
        }
        body->density = 1000;
        body->orientation = random_rotation(&random);
        body->velocity = (qvec3){random_unit(&random) - 0.5, random_unit(&random) - 0.5, -random_unit(&random)};
        body->omega = random_vector(&random, 0.1, 10);
        body->friction = 0.2 + 0.6 * random_unit(&random);
        body->restitution = 0.6 * random_unit(&random);
    }
    return s;
}

/* ---- one scene ---- */

static bool in_time(void *context, double t, double end)
{
    static int asked; /* the clock takes as long as a small event */
    (void)t, (void)end;
    return ++asked % 64 || cpu_clock() < *(const double *)context + most_cpu;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static impact_scene_def def_of(const pile_scene *s)
{
    impact_scene_def def = impact_default_scene_def();
    def.name = s->name;
    def.gravity = (qvec3){0, 0, -9.81};
    def.bodies = s->bodies;
    def.body_count = s->count;
    def.duration = s->duration;
    def.output_rate = 0;
    def.friction_rule = def.restitution_rule = IMPACT_MINIMUM;
    def.together = s->together;
    return def;
}

/* s of CPU; told: with its row. */
static double measure(const pile_scene *s, impact_piles piles, bool told)
{
    impact_scene_def def = def_of(s);
    impact_scene *scene;
    char message[256];
    double begun = cpu_clock();
    def.piles = piles;
    if (impact_scene_create(&def, &scene, message, sizeof message) != IMPACT_OK) {
        fprintf(stderr, "bench_piles: %s: %s\n", s->name, message);
        return NAN;
    }
    const impact_recorder recorder = {.struct_size = sizeof recorder, .context = &begun, .progress = in_time};
    const impact_status status = impact_scene_run(scene, &recorder);
    const double seconds = cpu_clock() - begun;
    const impact_usage usage = impact_scene_usage(scene);
    const impact_energy e = impact_scene_energy(scene);
    const double losses = e.impact_loss + e.sliding_loss;
    long events = 0;
    for (int kind = 0; kind <= IMPACT_EVENT_REST; kind++) events += usage.events[kind];
    if (told)
        printf("%s,%s,%.3f,%g,%s,%.3f,%ld,%ld,%ld,%.2g,%.3g,%.1g\n", s->name,
               piles == IMPACT_PILES_STEPS ? "steps" : "auto", impact_scene_time(scene), s->duration,
               impact_status_string(status), seconds, usage.integrator_steps, events, usage.pile_steps,
               impact_scene_pile_error(scene), impact_scene_pile_parted(scene),
               losses > 0 ? fabs(e.kinetic + e.potential + losses - e.start) / losses : 0);
    fflush(stdout);
    impact_scene_destroy(scene);
    return status < 0 || status == IMPACT_STOPPED ? NAN : seconds;
}

/* A copy's bodies have names of their own. */
static double measure_copy(pile_scene s, impact_piles piles, bool told)
{
    for (int b = 0; b < s.count; b++) s.bodies[b].name = s.names[b];
    return measure(&s, piles, told);
}

/* Of so many alike, which chance leads on to other times: a row would be one of them. */
static void measure_many(const char *name, pile_scene (*make)(uint64_t number), int count)
{
    enum { MANY = 60 };
    double seconds[MANY];
    int ended = 0;
    for (int k = 0; k < count; k++) {
        const double taken = measure_copy(make((uint64_t)k), IMPACT_PILES_AUTO, false);
        if (!isnan(taken))
            seconds[ended++] = taken;
        else
            printf("# %s: number %d did not end\n", name, k);
    }
    qsort(seconds, (size_t)ended, sizeof *seconds, ascending);
    printf("# of %d times %s %d ended: median %.3f s of CPU, slowest %.3f s\n", count, name, ended,
           ended > 0 ? seconds[ended / 2] : NAN, ended > 0 ? seconds[ended - 1] : NAN);
    fflush(stdout);
}

/* ---- error against run time ---- */

static double apart(const impact_sample *a, const impact_sample *b, double radius)
{
    const quat turn = quat_mul(a->orientation, quat_conj(b->orientation));
    return qvec3_norm(qvec3_sub(a->position, b->position)) + 2 * radius * qvec3_norm((qvec3){turn.x, turn.y, turn.z});
}

typedef struct dominoes_run {
    bool ended;
    double seconds, told;
    long steps;
    impact_sample at[MOST];
} dominoes_run;

static dominoes_run run_dominoes(pile_scene s, double tolerance)
{
    dominoes_run run = {0};
    impact_scene *scene;
    for (int b = 0; b < s.count; b++) s.bodies[b].name = s.names[b];
    impact_scene_def def = def_of(&s);
    def.duration = 0.2;
    def.pile_tolerance = tolerance;
    if (impact_scene_create(&def, &scene, NULL, 0) != IMPACT_OK) return run;
    const double begun = cpu_clock();
    run.ended = impact_scene_run(scene, NULL) >= 0;
    run.seconds = cpu_clock() - begun;
    run.told = impact_scene_pile_error(scene);
    run.steps = impact_scene_usage(scene).pile_steps;
    for (int b = 0; b < s.count; b++) impact_scene_body(scene, b, &run.at[b]);
    impact_scene_destroy(scene);
    return run;
}

static void compare_tolerances(void)
{
    const double tolerances[] = {1e-6, 1e-5, 1e-4, 1e-3};
    const pile_scene s = dominoes(5, "5 dominoes", 0);
    const double radius = impact_shape_bounding_radius(&s.bodies[1].shape);
    const dominoes_run finest = run_dominoes(s, 1e-7);
    puts("\npile_tolerance,cpu_s,pile_steps,told_m,off_m");
    for (int k = 0; k < 4; k++) {
        const dominoes_run run = run_dominoes(s, tolerances[k]);
        double off = finest.ended && run.ended ? 0 : NAN;
        for (int b = 1; b < s.count && !isnan(off); b++) off = fmax(off, apart(&run.at[b], &finest.at[b], radius));
        printf("%g,%.3f,%ld,%.2g,%.2g\n", tolerances[k], run.seconds, run.steps, run.told, off);
        fflush(stdout);
    }
}

int main(void)
{
    const pile_scene balls[] = {shaft(), heap(), box()},
                     boxes[] = {cube(),   stack(10, 0, 1e4, "10 boxes set"), stack(5, 0.02, 1, "5 boxes dropped"),
                                dice(),   dominoes(5, "5 dominoes", 0),      twenty_dominoes(0),
                                bricks(0)};
    printf("scene,piles,reached_s,asked_s,ended,cpu_s,integrator_steps,events,pile_steps,error_m,parted_s,account\n");
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 2; k++) measure_copy(balls[i], k ? IMPACT_PILES_STEPS : IMPACT_PILES_AUTO, true);
    for (int i = 0; i < 7; i++) measure_copy(boxes[i], IMPACT_PILES_AUTO, true);
    measure_many("20 dominoes", twenty_dominoes, 9);
    measure_many("30 bricks struck", bricks, 9);
    measure_many("3 drawn", drawn, 60);
    compare_tolerances();
    return 0;
}
