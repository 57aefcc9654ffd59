/* SPDX-License-Identifier: MIT
 *
 * bench_scene: error against run time of whole scenes, by method of motion, over its tolerance or its step.
 *
 * CSV rows (drawn by draw_scene.lua): scene; motion (default, cvode: all by CVODE, rk4: the classical method at fixed
 * steps); setting, the relative tolerance or the step, s; worst error of position and of velocity over the times of the
 * truth, relative to the largest of the run, and the larger of both; median time of making and running the scene in
 * microseconds, that over the time at the default's tolerance, median over least of the rounds, in which all settings
 * take turns; steps; checksum, of the last places. The truths are tests/data/scenes, in 40 digits by
 * tests/generators/scene_truths.py, which shares no code with the library. Scenes: `sphere_wall` and `two_spheres` as
 * in examples/scenes; `ellipsoid_in_wind`, three bounces; `orbit`, an ellipse of Kepler's, eccentricity 0.3.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <impact/scene.h>
#include "measure.h"

enum { MOST_TIMES = 64, MOST_BODIES = 4, ROUNDS = 7, MOST_SETTINGS = 32 };

/* Places and velocities at the truth's times; of bodies that stand nothing. */
typedef struct states {
    int times;
    double t[MOST_TIMES];
    qvec3 position[MOST_TIMES][MOST_BODIES], velocity[MOST_TIMES][MOST_BODIES];
} states;

/* A scene with all that its definition points to. */
typedef struct setting {
    const char *name;
    impact_body_def bodies[MOST_BODIES];
    impact_force_def forces[2];
    impact_pair_def pair;
    impact_scene_def def;
} setting;

/* ---- the scenes ---- */

static void start(setting *s, const char *name, int bodies, int forces, double duration)
{
    *s = (setting){.name = name, .def = impact_default_scene_def()};
    s->def.gravity = (qvec3){0, 0, -9.81};
    s->def.duration = duration;
    s->def.output_rate = 0;
    s->def.bodies = s->bodies;
    s->def.body_count = bodies;
    s->def.forces = s->forces;
    s->def.force_count = forces;
    for (int i = 0; i < MOST_BODIES; i++) {
        s->bodies[i] = impact_default_body_def();
        s->bodies[i].friction = 0.25;
        s->bodies[i].restitution = 0.3;
    }
}

static void floor_of(impact_body_def *body, double width)
{
    body->name = "floor";
    body->is_static = true;
    body->restitution = 1;
    if (width > 0)
        impact_shape_plane(width / 2, width / 2, &body->shape);
    else
        impact_shape_plane(INFINITY, INFINITY, &body->shape);
}

static void ball_of(impact_body_def *body, const char *name, double mass, double radius, qvec3 position)
{
    body->name = name;
    body->mass = mass;
    body->position = position;
    impact_shape_sphere(radius, &body->shape);
}

static impact_force_def wind_of(const char *body, qvec3 origin, qvec3 direction, double strength, double reach)
{
    impact_force_def wind = impact_default_force_def(IMPACT_FORCE_WIND);
    wind.body = body;
    wind.origin = origin;
    wind.direction = direction;
    wind.strength = strength;
    wind.reach = reach;
    return wind;
}

static void make_sphere_wall(setting *s)
{
    start(s, "sphere_wall", 3, 1, 3.75);
    floor_of(&s->bodies[0], 8);
    s->bodies[1].name = "wall";
    s->bodies[1].is_static = true;
    s->bodies[1].orientation = (quat){1, 0, -1, 0};
    impact_shape_plane(1.5, 1.5, &s->bodies[1].shape);
    ball_of(&s->bodies[2], "sphere", 4, 0.3, (qvec3){-3, 0, 1});
    s->bodies[2].linear_damping = 0.04;
    s->bodies[2].angular_damping = 0.848;
    s->forces[0] = wind_of(NULL, (qvec3){-3, 0, 1}, (qvec3){1, 0, 0}, 25, 2);
}

static void make_two_spheres(setting *s)
{
    start(s, "two_spheres", 3, 2, 3.75);
    floor_of(&s->bodies[0], 20);
    ball_of(&s->bodies[1], "left", 4, 0.3, (qvec3){-5, 0, 5});
    ball_of(&s->bodies[2], "right", 4, 0.3, (qvec3){5, 0.2, 5});
    s->forces[0] = wind_of("left", (qvec3){-5, 0, 5}, (qvec3){1, 0, 0}, 25, 5);
    s->forces[1] = wind_of("right", (qvec3){5, 0.2, 5}, (qvec3){-1, 0, 0}, 25, 5);
    s->pair = (impact_pair_def){sizeof(impact_pair_def), "left", "right", 0.25, 0.3, NAN, NAN, NAN};
    s->def.pairs = &s->pair;
    s->def.pair_count = 1;
}

static void make_ellipsoid(setting *s)
{
    start(s, "ellipsoid_in_wind", 2, 1, 1.2);
    floor_of(&s->bodies[0], 0);
    s->bodies[0].friction = 0.5;
    impact_body_def *body = &s->bodies[1];
    body->name = "ellipsoid";
    body->mass = 4;
    body->position = (qvec3){0, 0, 1};
    body->orientation = (quat){0.9, 0.3, 0.2, 0.1};
    body->omega = (qvec3){1, 2, -1};
    body->velocity = (qvec3){1, 0, 0};
    body->friction = 0.1;
    body->restitution = 0.6;
    body->linear_damping = 0.04;
    impact_shape_ellipsoid(0.1, 0.2, 0.3, &body->shape);
    s->forces[0] = wind_of(NULL, (qvec3){0, 0, 1}, (qvec3){1, 0, 0}, 5, INFINITY);
}

/* G (m1 + m2) = 1, semi-axis 1, from the nearest point; the first body with the origin at their centre. */
static void make_orbit(setting *s)
{
    const double e = 0.3, speed = sqrt((1 + e) / (1 - e));
    start(s, "orbit", 2, 1, 6.283185307179586);
    s->def.gravity = (qvec3){0, 0, 0};
    ball_of(&s->bodies[0], "sun", 0.5, 0.01, (qvec3){0, 0, 0});
    ball_of(&s->bodies[1], "planet", 0.5, 0.01, (qvec3){1 - e, 0, 0});
    s->bodies[0].velocity = (qvec3){0, -speed / 2, 0};
    s->bodies[1].velocity = (qvec3){0, speed / 2, 0};
    s->forces[0] = impact_default_force_def(IMPACT_FORCE_ATTRACTION);
    s->forces[0].constant = 1;
}

/* ---- the truth ---- */

static int body_of(const setting *s, const char *name)
{
    for (int i = 0; i < s->def.body_count; i++)
        if (strcmp(s->bodies[i].name, name) == 0) return i;
    fprintf(stderr, "bench_scene: the truth of %s has a body '%s'\n", s->name, name);
    exit(1);
}

/* Lines t, body, x y z, qw qx qy qz, vx vy vz and more; remarks and the header are no such lines. */
static void read_truth(const setting *s, states *truth)
{
    char path[400], line[600], name[40];
    snprintf(path, sizeof path, "%s/%s.csv", SCENE_TRUTHS, s->name);
    FILE *file = fopen(path, "r");
    if (!file) perror(path), exit(1);
    *truth = (states){.times = 0};
    while (fgets(line, sizeof line, file)) {
        double t, q[4];
        qvec3 x, v;
        if (sscanf(line, "%lf,%39[^,],%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf", &t, name, &x.x, &x.y, &x.z, &q[0],
                   &q[1], &q[2], &q[3], &v.x, &v.y, &v.z) != 12)
            continue;
        if ((truth->times == 0 || truth->t[truth->times - 1] != t) && truth->times < MOST_TIMES)
            truth->t[truth->times++] = t;
        const int k = truth->times - 1, i = body_of(s, name);
        truth->position[k][i] = x, truth->velocity[k][i] = v;
    }
    fclose(file);
}

static impact_scene *make(const setting *s)
{
    impact_scene *scene;
    char message[200];
    if (impact_scene_create(&s->def, &scene, message, sizeof message) == IMPACT_OK) return scene;
    fprintf(stderr, "%s: %s\n", s->name, message);
    exit(1);
}

/* ---- a setting of the motion ---- */

typedef struct contestant {
    const char *motion;
    impact_methods methods;
    double setting, x, v, sum, times[ROUNDS];
    int rounds; /* 0: it does not come to the end */
    long steps;
} contestant;

/* The errors of one run against the truth, over the largest place and velocity there. */
static void compare(setting *s, const states *truth, contestant *c)
{
    s->def.methods = c->methods;
    impact_scene *scene = make(s);
    double x = 0, v = 0, far = 0, fast = 0;
    for (int k = 0; k < truth->times; k++) {
        if (impact_scene_run_to(scene, truth->t[k], NULL) < IMPACT_OK) x = v = NAN;
        for (int i = 0; i < s->def.body_count; i++) {
            impact_sample sample;
            if (s->bodies[i].is_static) continue;
            impact_scene_body(scene, i, &sample);
            x = isnan(x) ? x : fmax(x, qvec3_norm(qvec3_sub(sample.position, truth->position[k][i])));
            v = isnan(v) ? v : fmax(v, qvec3_norm(qvec3_sub(sample.velocity, truth->velocity[k][i])));
            far = fmax(far, qvec3_norm(truth->position[k][i]));
            fast = fmax(fast, qvec3_norm(truth->velocity[k][i]));
            c->sum += k == truth->times - 1 ? sample.position.x + sample.position.z : 0;
        }
    }
    c->x = x / far, c->v = v / fast;
    c->steps = impact_scene_usage(scene).integrator_steps;
    impact_scene_destroy(scene);
}

static void time_once(setting *s, contestant *c)
{
    s->def.methods = c->methods;
    const double from = measure_clock();
    impact_scene *scene = make(s);
    const impact_status status = impact_scene_run(scene, NULL);
    impact_scene_destroy(scene);
    if (status >= IMPACT_OK) c->times[c->rounds++] = 1e6 * measure_since(from);
}

static int line_up(contestant list[MOST_SETTINGS])
{
    static const double steps[] = {0.1, 0.03, 0.01, 0.003, 0.001, 0.0003};
    const bool cvode = impact_has(IMPACT_PART_CVODE);
    int count = 0;
    for (int method = 0; method < (cvode ? 2 : 1); method++)
        for (int digits = 4; digits <= 14; digits++)
            list[count++] = (contestant){.motion = method == 0 ? "default" : "cvode",
                                         .setting = pow(10, -digits),
                                         .methods = {.motion = method == 0 ? IMPACT_MOTION_AUTO : IMPACT_MOTION_CVODE,
                                                     .tolerance = pow(10, -digits)}};
    for (size_t k = 0; k < sizeof steps / sizeof *steps; k++)
        list[count++] = (contestant){
            .motion = "rk4", .setting = steps[k], .methods = {.motion = IMPACT_MOTION_RK4, .step = steps[k]}};
    return count;
}

static void measure(void fill(setting *s))
{
    static setting s;
    static states truth;
    contestant list[MOST_SETTINGS];
    const int count = line_up(list), rounds = measure_count(ROUNDS);
    double usual = NAN;
    fill(&s);
    read_truth(&s, &truth);
    for (int k = 0; k < count; k++) compare(&s, &truth, &list[k]);
    for (int round = 0; round < rounds; round++)
        for (int k = 0; k < count; k++) time_once(&s, &list[k]);
    for (int pass = 0; pass < 2; pass++)
        for (int k = 0; k < count; k++) {
            const contestant *c = &list[k];
            const measure_time time = measure_of_rounds(list[k].times, c->rounds);
            if (pass == 0 && strcmp(c->motion, "default") == 0 && fabs(c->setting - 1e-13) < 1e-15) usual = time.median;
            if (pass == 0) continue;
            printf("%s,%s,%g,%.2g,%.2g,%.2g,%.4g,%.3g,%.2f,%ld,%.9g\n", s.name, c->motion, c->setting, fmax(c->x, c->v),
                   c->x, c->v, time.median, time.median / usual, time.spread, c->steps, c->sum);
        }
    fflush(stdout);
}

int main(void)
{
    printf("scene,motion,setting,error,error_position,error_velocity,us,time_over_default,spread,steps,checksum\n");
    measure(make_orbit);
    measure(make_sphere_wall);
    measure(make_two_spheres);
    measure(make_ellipsoid);
    return 0;
}
