/* SPDX-License-Identifier: MIT
 *
 * bench_scene: error against run time of whole scenes over `tolerance`, the relative tolerance of the motion's
 * integration.
 *
 * CSV rows (drawn by draw_scene.lua): scene, what the error is taken against, tolerance, worst error of position and of
 * velocity over 32 times of the run, relative to the largest of the run, median time of making and running the scene in
 * microseconds, that over the time at the default tolerance, and the integrator's steps. Scenes: `orbit`, two spheres
 * about each other, eccentricity 0.6, ten turns, against Kepler's equation in long double; `sphere_wall` and
 * `two_spheres` as in examples/scenes; `ellipsoid`, dropped in a wind on the floor, three bounces. These three have no
 * closed form as a whole, and are taken against themselves at the tolerance 1e-14.
 */
#include <stdio.h>
#include <stdlib.h>
#include <impact/scene.h>
#include "measure.h"

enum { TIMES = 32, MOST_BODIES = 4, REPEATS = 7 };

typedef struct states {
    qvec3 position[TIMES][MOST_BODIES], velocity[TIMES][MOST_BODIES];
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
    impact_shape_plane(width / 2, width / 2, &body->shape);
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
    start(s, "ellipsoid", 2, 1, 1.2);
    floor_of(&s->bodies[0], 20);
    impact_body_def *body = &s->bodies[1];
    body->name = "ellipsoid";
    body->mass = 4;
    body->position = (qvec3){0, 0, 1};
    body->orientation = (quat){0.9, 0.3, 0.2, 0.1};
    body->omega = (qvec3){1, 2, -1};
    body->restitution = 0.6;
    body->linear_damping = 0.04;
    impact_shape_ellipsoid(0.1, 0.2, 0.3, &body->shape);
    s->forces[0] = wind_of(NULL, (qvec3){0, 0, 1}, (qvec3){1, 0, 0}, 5, INFINITY);
}

static const double eccentricity = 0.6;

/* G (m1 + m2) = 2, semi-axis 1, from the nearest point; both bodies half of the relative motion. */
static void make_orbit(setting *s)
{
    start(s, "orbit", 2, 1, 10 * 2 * 3.14159265358979323846 / sqrt(2));
    s->def.gravity = (qvec3){0, 0, 0};
    const double r = (1 - eccentricity) / 2, v = sqrt(2 * (1 + eccentricity) / (1 - eccentricity)) / 2;
    for (int i = 0; i < 2; i++) {
        const double sign = i == 0 ? 1 : -1;
        ball_of(&s->bodies[i], i == 0 ? "one" : "two", 1, 0.01, (qvec3){sign * r, 0, 0});
        s->bodies[i].velocity = (qvec3){0, sign * v, 0};
    }
    s->forces[0] = impact_default_force_def(IMPACT_FORCE_ATTRACTION);
    s->forces[0].constant = 1;
}

/* ---- right answers ---- */

static double time_of(const setting *s, int k) { return s->def.duration * (k + 1) / TIMES; }

static void solve_orbit(const setting *s, states *out)
{
    const long double e = eccentricity, mean = sqrtl(2), minor = sqrtl(1 - e * e);
    for (int k = 0; k < TIMES; k++) {
        const long double M = mean * time_of(s, k);
        long double E = M;
        for (int i = 0; i < 60; i++) E -= (E - e * sinl(E) - M) / (1 - e * cosl(E));
        const long double rate = mean / (1 - e * cosl(E));
        const qvec3 x = {(double)((cosl(E) - e) / 2), (double)(minor * sinl(E) / 2), 0};
        const qvec3 v = {(double)(-sinl(E) * rate / 2), (double)(minor * cosl(E) * rate / 2), 0};
        out->position[k][0] = x;
        out->velocity[k][0] = v;
        out->position[k][1] = qvec3_neg(x);
        out->velocity[k][1] = qvec3_neg(v);
    }
}

static impact_scene *make(const setting *s)
{
    impact_scene *scene;
    char message[200];
    if (impact_scene_create(&s->def, &scene, message, sizeof message) == IMPACT_OK) return scene;
    fprintf(stderr, "%s: %s\n", s->name, message);
    exit(1);
}

/* False: the run failed on its way. */
static bool run_to_times(const setting *s, states *out, long *steps)
{
    impact_scene *scene = make(s);
    bool good = true;
    for (int k = 0; k < TIMES && good; k++) {
        good = impact_scene_run_to(scene, time_of(s, k), NULL) >= IMPACT_OK;
        for (int i = 0; i < s->def.body_count; i++) {
            impact_sample sample;
            impact_scene_body(scene, i, &sample);
            out->position[k][i] = sample.position;
            out->velocity[k][i] = sample.velocity;
        }
    }
    *steps = impact_scene_usage(scene).integrator_steps;
    impact_scene_destroy(scene);
    return good;
}

static double worst_difference(qvec3 a[TIMES][MOST_BODIES], qvec3 b[TIMES][MOST_BODIES], int bodies)
{
    double off = 0, size = 0;
    for (int k = 0; k < TIMES; k++)
        for (int i = 0; i < bodies; i++) {
            off = fmax(off, qvec3_norm(qvec3_sub(a[k][i], b[k][i])));
            size = fmax(size, qvec3_norm(b[k][i]));
        }
    return off / size;
}

/* ---- measuring ---- */

/* Median time of making and running the scene; NaN when it fails. */
static double run_time(const setting *s)
{
    double times[REPEATS];
    for (int i = 0; i < REPEATS; i++) {
        const double from = measure_clock();
        impact_scene *scene = make(s);
        const impact_status status = impact_scene_run(scene, NULL);
        impact_scene_destroy(scene);
        if (status < IMPACT_OK) return NAN;
        times[i] = measure_clock() - from;
    }
    return measure_quantile(times, REPEATS, 0.5);
}

static void measure(setting *s, void solve(const setting *s, states *out))
{
    static states right, got;
    long steps;
    const double usual = run_time(s);
    if (solve) {
        solve(s, &right);
    } else {
        s->def.tolerance = 1e-14;
        if (!run_to_times(s, &right, &steps)) return;
    }
    for (int digits = 6; digits <= (solve ? 14 : 13); digits++) {
        s->def.tolerance = pow(10, -digits);
        const bool good = run_to_times(s, &got, &steps);
        const double x = good ? worst_difference(got.position, right.position, s->def.body_count) : NAN;
        const double v = good ? worst_difference(got.velocity, right.velocity, s->def.body_count) : NAN;
        const double time = run_time(s);
        printf("%s,%s,1e-%d,%.2g,%.2g,%.4g,%.3g,%ld\n", s->name, solve ? "closed form" : "tolerance 1e-14", digits, x,
               v, 1e6 * time, time / usual, steps);
        fflush(stdout);
    }
}

int main(void)
{
    static setting s;
    printf("scene,against,tolerance,error_position,error_velocity,us_median,time_over_default,steps\n");
    make_orbit(&s);
    measure(&s, solve_orbit);
    make_sphere_wall(&s);
    measure(&s, NULL);
    make_two_spheres(&s);
    measure(&s, NULL);
    make_ellipsoid(&s);
    measure(&s, NULL);
    return 0;
}
