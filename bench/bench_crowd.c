/* SPDX-License-Identifier: MIT
 *
 * bench_crowd: what many bodies cost (docs/scene.md, Many bodies). CSV, in three tables, all times of the processor.
 *
 * A gas: n equal balls without friction, restitution 1, in a box of which they fill a tenth; impacts; us for one;
 * that over the textbook program's of the same run (peers_crowd_textbook.c); kinetic energy at the end over that of the
 * start, less 1; bytes a ball; median over least. Each is the median of runs that take turns; of the engines, which
 * take steps of 1 ms, one run. They count no impacts: theirs are taken to be as many in a second of motion as
 * libimpact's. Single cases, each with its quantity. Balls that fall into a box which grows with them.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <impact/scene.h>
#include <quat/rotation.h>
#include "measure.h"
#include "peers_crowd.h"

enum { WALLS = 6, REPEATS = 5, NAME = 12 };

static const double filled = 0.1;

/* Marsaglia's xorshift; in [0, 1). */
static double draw(unsigned long long *seed)
{
    *seed ^= *seed << 13, *seed ^= *seed >> 7, *seed ^= *seed << 17;
    return (double)(*seed >> 11) * 0x1p-53;
}

static qvec3 draw_vector(unsigned long long *seed)
{
    double v[3];
    for (int k = 0; k < 3; k++) v[k] = sqrt(-2 * log(1 - draw(seed))) * cos(6.283185307179586 * draw(seed));
    return (qvec3){v[0], v[1], v[2]};
}

static void *take(size_t count, size_t size)
{
    void *block = calloc(count, size);
    if (!block) fputs("bench_crowd: no memory\n", stderr), exit(1);
    return block;
}

/* ---- gases ---- */

static gas open_gas(int count)
{
    return (gas){.count = count,
                 .radius = take((size_t)count, sizeof(double)),
                 .position = take((size_t)count, sizeof(qvec3)),
                 .velocity = take((size_t)count, sizeof(qvec3))};
}

static void close_gas(gas *g) { free(g->radius), free(g->position), free(g->velocity); }

static double side_of(const gas *g)
{
    double volume = 0;
    for (int i = 0; i < g->count; i++) volume += crowd_mass(g->radius[i]);
    return cbrt(volume / filled);
}

/* Near the places of a lattice. */
static gas equal_balls(int count)
{
    unsigned long long seed = 88172645463325252u;
    gas g = open_gas(count);
    const double r = 0.1;
    const int cells = (int)ceil(cbrt(count));
    for (int i = 0; i < count; i++) g.radius[i] = r;
    g.side = side_of(&g);
    const double cell = g.side / cells, play = 0.4 * (cell - 2 * r);
    for (int i = 0; i < count; i++) {
        const int row = i / cells, layer = row / cells;
        const qvec3 place = {i % cells + 0.5, row % cells + 0.5, layer + 0.5};
        const qvec3 off = {draw(&seed) - 0.5, draw(&seed) - 0.5, draw(&seed) - 0.5};
        g.position[i] = qvec3_axpy(play, off, qvec3_scale(place, cell));
        g.velocity[i] = draw_vector(&seed);
    }
    return g;
}

static bool is_free(const gas *g, int i)
{
    for (int j = 0; j < i; j++)
        if (qvec3_norm(qvec3_sub(g->position[i], g->position[j])) < g->radius[i] + g->radius[j]) return false;
    return true;
}

/* Radii from 0.6 m down to a thirtieth of it, as many in each octave, wherever there is room. */
static gas unequal_balls(int count)
{
    unsigned long long seed = 88172645463325252u;
    gas g = open_gas(count);
    for (int i = 0; i < count; i++) g.radius[i] = 0.6 * pow(30, -(double)i / (count - 1));
    g.side = side_of(&g);
    for (int i = 0; i < count; i++) {
        const double room = g.side - 2 * g.radius[i];
        do {
            const qvec3 u = {draw(&seed), draw(&seed), draw(&seed)}, low = {1, 1, 1};
            g.position[i] = qvec3_axpy(room, u, qvec3_scale(low, g.radius[i]));
        } while (!is_free(&g, i));
        g.velocity[i] = draw_vector(&seed);
    }
    return g;
}

/* ---- scenes ---- */

typedef struct cast {
    impact_body_def *bodies;
    char (*names)[NAME];
    int count;
} cast;

static cast open_cast(int room)
{
    return (cast){take((size_t)room, sizeof(impact_body_def)), take((size_t)room, NAME), 0};
}

static void close_cast(cast *c) { free(c->bodies), free(c->names); }

static impact_body_def *add_body(cast *c, qvec3 position)
{
    impact_body_def *body = &c->bodies[c->count];
    *body = impact_default_body_def();
    snprintf(c->names[c->count], NAME, "%d", c->count);
    body->name = c->names[c->count++];
    body->position = position;
    body->friction = 0;
    body->restitution = 1;
    return body;
}

static impact_body_def *add_ball(cast *c, double radius, qvec3 position)
{
    impact_body_def *body = add_body(c, position);
    impact_shape_sphere(radius, &body->shape);
    return body;
}

static impact_body_def *add_plane(cast *c, qvec3 position, qvec3 normal)
{
    impact_body_def *body = add_body(c, position);
    const quat turn = {1 + normal.z, -normal.y, normal.x, 0}; /* from z to the normal */
    impact_shape_plane(INFINITY, INFINITY, &body->shape);
    body->is_static = true;
    body->orientation = normal.z < 0 ? (quat){0, 1, 0, 0} : turn;
    return body;
}

/* The balls of a gas; or, in their places, ellipsoids that tumble. */
static cast cast_of(const gas *g, bool tumbling)
{
    unsigned long long seed = 1;
    cast c = open_cast(g->count + WALLS);
    for (int k = 0; k < WALLS; k++) {
        qvec3 place, normal;
        crowd_wall(g, k, &place, &normal);
        add_plane(&c, place, normal);
    }
    for (int i = 0; i < g->count; i++) {
        const double r = g->radius[i];
        impact_body_def *body = add_ball(&c, r, g->position[i]);
        body->velocity = g->velocity[i];
        if (!tumbling) continue;
        impact_shape_ellipsoid(r, 0.8 * r, 0.6 * r, &body->shape);
        body->omega = qvec3_scale(draw_vector(&seed), 3);
        body->orientation = quat_from_rotation_vector(draw_vector(&seed));
    }
    return c;
}

typedef struct outcome {
    double seconds; /* of the run alone */
    impact_usage usage;
    impact_energy energy;
    impact_memory memory;
    impact_status status;
} outcome;

static outcome run_cast(const cast *c, qvec3 gravity, double duration)
{
    impact_scene_def def = impact_default_scene_def();
    def.bodies = c->bodies;
    def.body_count = c->count;
    def.gravity = gravity;
    def.duration = duration;
    def.max_events = 100000000;
    def.friction_rule = def.restitution_rule = IMPACT_MINIMUM;
    char message[200];
    impact_scene *scene;
    outcome o = {.status = impact_scene_create(&def, &scene, message, sizeof message)};
    if (o.status != IMPACT_OK) fprintf(stderr, "bench_crowd: %s\n", message), exit(1);
    const double from = crowd_clock();
    o.status = impact_scene_run(scene, NULL);
    o.seconds = crowd_clock() - from;
    o.usage = impact_scene_usage(scene);
    o.energy = impact_scene_energy(scene);
    o.memory = impact_scene_memory(scene);
    impact_scene_destroy(scene);
    return o;
}

static const qvec3 nowhere = {0, 0, 0}, down = {0, 0, -9.81};

static long impacts_of(const outcome *o) { return o->usage.events[IMPACT_EVENT_IMPACT]; }

static bool crowd_impact(const gas *g, double duration, gas_run *run)
{
    cast c = cast_of(g, false);
    const outcome o = run_cast(&c, nowhere, duration);
    close_cast(&c);
    *run = (gas_run){o.seconds, impacts_of(&o), o.energy.kinetic / o.energy.start - 1, (double)o.memory.most};
    return o.status == IMPACT_OK;
}

/* ---- a gas against the peers ---- */

/* The engines run once, for this part of the others' time. */
static const double engines_part = 0.05;

static void compare(int balls, double duration, int repeats)
{
    static const struct {
        const char *name;
        gas_program *move;
        int most; /* balls: more would take too long */
        bool engine;
    } programs[] = {{"libimpact", crowd_impact, 100000, false},
                    {"textbook", crowd_textbook, 100000, false},
                    {"ODE", crowd_ode, 10000, true},
                    {"Bullet", crowd_bullet, 10000, true}};
    enum { PROGRAMS = sizeof programs / sizeof *programs };
    double times[PROGRAMS][REPEATS], median[PROGRAMS], spread[PROGRAMS];
    gas_run run[PROGRAMS];
    bool there[PROGRAMS];
    const bool few = getenv("BENCH_QUICK") != NULL; /* Bullet takes a minute to take 10000 in */
    gas g = equal_balls(balls);
    for (int r = 0; r < repeats; r++)
        for (int p = 0; p < PROGRAMS; p++) {
            if (programs[p].engine && r > 0) continue;
            const double part = programs[p].engine ? engines_part : 1;
            there[p] = balls <= (programs[p].engine && few ? 1000 : programs[p].most) &&
                       programs[p].move(&g, part * duration, &run[p]);
            if (!there[p]) continue;
            if (programs[p].engine) run[p].events = lround(part * (double)run[0].events);
            times[p][r] = 1e6 * run[p].seconds / (double)run[p].events;
        }
    for (int p = 0; p < PROGRAMS; p++)
        if (there[p]) {
            const measure_time time = measure_of_rounds(times[p], programs[p].engine ? 1 : repeats);
            median[p] = time.median, spread[p] = time.spread;
        }
    for (int p = 0; p < PROGRAMS; p++) {
        if (!there[p]) continue;
        printf("%d,%s,%ld,%.3g,%.3g,%.1e,%.4g,%.2f\n", balls, programs[p].name, run[p].events, median[p],
               median[p] / median[1], run[p].energy, run[p].memory / balls, spread[p]);
    }
    fflush(stdout);
    close_gas(&g);
}

static void name_absent(void)
{
    gas g = equal_balls(1);
    gas_run run;
    if (!crowd_ode(&g, crowd_step, &run)) puts("# ODE is not installed: its rows are skipped");
    if (!crowd_bullet(&g, crowd_step, &run)) puts("# Bullet is not installed: its rows are skipped");
    close_gas(&g);
}

/* ---- single cases ---- */

static void show(const char *name, const char *quantity, double value)
{
    printf("%s,%s,%.4g\n", name, quantity, value);
    fflush(stdout);
}

static void show_gas(const char *name, gas g, bool tumbling, double duration)
{
    double times[3];
    cast c = cast_of(&g, tumbling);
    const int rounds = getenv("BENCH_QUICK") ? 1 : 3;
    for (int r = 0; r < rounds; r++) {
        const outcome o = run_cast(&c, nowhere, duration);
        times[r] = 1e6 * o.seconds / (double)impacts_of(&o);
    }
    show(name, "us an event", measure_quantile(times, rounds, 0.5));
    close_cast(&c);
    close_gas(&g);
}

/* Balls that bounce for ever on a floor, each far from the others. */
static double bounce_apart(int balls)
{
    cast c = open_cast(balls + 1);
    add_plane(&c, nowhere, (qvec3){0, 0, 1});
    for (int i = 0; i < balls; i++) {
        const int row = i / 10;
        add_ball(&c, 0.1, (qvec3){i % 10, row, 0.3 + 0.01 * (i % 7)});
    }
    const outcome o = run_cast(&c, down, 400);
    close_cast(&c);
    return o.seconds;
}

static void show_apart(void)
{
    enum { BALLS = 100 };
    double one[REPEATS], many[REPEATS];
    const int rounds = measure_count(REPEATS);
    for (int r = 0; r < rounds; r++) one[r] = bounce_apart(1), many[r] = bounce_apart(BALLS);
    show("100 balls that bounce apart", "over 100 times one",
         measure_quantile(many, rounds, 0.5) / (BALLS * measure_quantile(one, rounds, 0.5)));
}

static void show_steps(const char *name, cast *c, double duration)
{
    const outcome o = run_cast(c, down, duration);
    show(name, "integrators", (double)o.usage.integrators);
    show(name, "integrator steps", (double)o.usage.integrator_steps);
    close_cast(c);
}

static void show_damped(void)
{
    cast c = open_cast(5);
    add_plane(&c, nowhere, (qvec3){0, 0, 1});
    for (int i = 0; i < 4; i++) {
        impact_body_def *ball = add_ball(&c, 0.1, (qvec3){i, 0, 1 + 0.3 * i});
        ball->linear_damping = 0.1 * (i + 1);
        ball->omega = (qvec3){1, 2, 3};
        ball->angular_damping = 0.2;
    }
    show_steps("four damped balls over a floor", &c, 2);
}

static void show_beside_rest(void)
{
    cast c = open_cast(3);
    add_plane(&c, nowhere, (qvec3){0, 0, 1});
    add_ball(&c, 0.1, (qvec3){0, 0, 0.1});
    add_ball(&c, 0.1, (qvec3){1, 0, 1})->velocity = (qvec3){1, 0, 10};
    show_steps("flight beside a ball at rest", &c, 2);
}

static void show_rolling(void)
{
    cast c = open_cast(2);
    add_plane(&c, nowhere, (qvec3){0, 0, 1})->friction = 1;
    impact_body_def *ball = add_ball(&c, 0.1, (qvec3){0, 0, 0.1});
    ball->friction = 0.5;
    ball->velocity = (qvec3){1, 0, 0};
    ball->omega = (qvec3){0, 10, 0};
    show_steps("a ball rolls for 1e4 s", &c, 1e4);
}

static void show_memory(int balls, double duration)
{
    char name[40];
    gas g = equal_balls(balls);
    gas_run run;
    crowd_impact(&g, duration, &run);
    snprintf(name, sizeof name, "memory of %d balls", balls);
    show(name, "MB", 1e-6 * run.memory);
    close_gas(&g);
}

/* A script's 1e5 bodies, made and put into a scene, by the runner. */
static void show_script(void)
{
#ifdef CROWD_RUNNER
    char line[200];
    FILE *output = popen("'" CROWD_RUNNER "' '" CROWD_SCRIPT "' --quiet", "r"); // NOLINT: both names are the build's
    while (output && fgets(line, sizeof line, output)) fputs(line, stdout);
    if (output) pclose(output);
    fflush(stdout);
#else
    fputs("bench_crowd: this build has no Lua, and no bodies of a script's\n", stderr);
#endif
}

/* ---- balls in a box ---- */

static outcome fall(int balls, double friction, double restitution, double duration)
{
    unsigned long long seed = 1;
    cast c = open_cast(balls + WALLS);
    const int side = (int)ceil(sqrt(balls / 2.0));
    const double half = 0.11 * side + 0.05;
    add_plane(&c, nowhere, (qvec3){0, 0, 1})->friction = 1;
    for (int k = 0; k < 4; k++) {
        const double out = k % 2 ? -1 : 1;
        const qvec3 normal = {k < 2 ? out : 0, k < 2 ? 0 : out, 0};
        add_plane(&c, qvec3_scale(normal, -half), normal)->friction = 1;
    }
    for (int i = 0; i < balls; i++) {
        const int cell = i % (side * side), layer = i / (side * side), row = cell / side;
        const double x = 0.22 * (cell % side - 0.5 * (side - 1)), y = 0.22 * (row - 0.5 * (side - 1));
        const qvec3 off = {draw(&seed) - 0.5, draw(&seed) - 0.5, draw(&seed)};
        impact_body_def *ball = add_ball(&c, 0.08, qvec3_axpy(0.02, off, (qvec3){x, y, 0.3 + 0.25 * layer}));
        ball->velocity = (qvec3){draw(&seed) - 0.5, draw(&seed) - 0.5, 0};
        ball->friction = friction;
        ball->restitution = restitution;
    }
    const outcome o = run_cast(&c, down, duration);
    close_cast(&c);
    return o;
}

static void show_box(const char *kind, double friction, double restitution)
{
    static const int sizes[] = {10, 100, 400};
    const double duration = 0.6;
    for (int s = 0; s < 3; s++) {
        double times[3];
        outcome o = {0};
        for (int r = 0; r < 3; r++) o = fall(sizes[s], friction, restitution, duration), times[r] = o.seconds;
        long events = 0;
        for (int k = 0; k <= IMPACT_EVENT_REST; k++) events += o.usage.events[k];
        printf("%s,%d,%ld,%.3g,%s\n", kind, sizes[s], events,
               1e6 * measure_quantile(times, 3, 0.5) / (double)(events ? events : 1), impact_status_string(o.status));
        fflush(stdout);
    }
}

int main(void)
{
    name_absent();
    puts("balls,program,events,us_per_event,over_textbook,energy_off,bytes_per_ball,spread");
    const bool quick = getenv("BENCH_QUICK") != NULL; /* a tenth of the motion, once */
    const double part = quick ? 0.1 : 1;
    compare(100, 40 * part, quick ? 1 : REPEATS);
    compare(1000, 4 * part, quick ? 1 : REPEATS);
    compare(10000, 0.8 * part, quick ? 1 : 3);
    compare(100000, 0.15 * part, quick ? 1 : 3);
    puts("\ncase,quantity,value");
    show_gas("1000 balls of sizes 1 : 30", unequal_balls(1000), false, 2 * part);
    show_gas("1000 tumbling ellipsoids", equal_balls(1000), true, 0.5 * part);
    show_apart();
    show_damped();
    show_beside_rest();
    show_rolling();
    show_memory(2000, 1);
    show_memory(100000, 0.05);
    show_script();
    puts("\nbox,balls,events,us_per_event,status");
    show_box("elastic", 0, 1);
    show_box("friction 0.3 restitution 0.8", 0.3, 0.8);
    return 0;
}
