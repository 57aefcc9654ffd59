/* SPDX-License-Identifier: MIT
 *
 * report_held: the energy account of contacts that are held. Superquadrics and superellipsoids of random axes,
 * orientation and spin, set down on a plane so that they roll, or slide without friction, for three seconds.
 *
 * report_held [--runs N] [--seed S] [--exponent P]
 * CSV: one row per exponent and mode. error: what the account is off by, over the largest energy in it, of the runs
 * that ended well: median and worst. soft: runs that said themselves that their account is off (IMPACT_SOFT); refused:
 * runs that ended with an error, with a word; long: stopped after a million steps. held: the part of the time in
 * contact. drift: of the runs without friction, the change of the angular momentum about the vertical, over the
 * largest. steps, starts: the integrator's, per run. message: the last refusal.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <impact/scene.h>
#include "../tests/kit/contact_random.h"
#include "options.h"

enum { MOST_STEPS = 1000000, MIXED = 0, BARR = -1, MOST_RUNS = 10000 };

static const double duration = 3;
static const double exponents[] = {1.2, 1.5, 1.8, 2,  2.05, 2.2, 2.5, 3,   3.5,   4,
                                   5,   6,   8,   12, 16,   20,  50,  100, MIXED, BARR};

typedef struct watch {
    long steps;
    double since, held;
    bool touching;
} watch;

typedef struct row {
    int ended, soft, refused, too_long;
    double errors[MOST_RUNS], drift, held, steps, starts;
    char message[256];
} tally;

static bool count_step(void *context, double t, double end)
{
    (void)t, (void)end;
    watch *w = context;
    return ++w->steps < MOST_STEPS;
}

static void touch(watch *w, double t, bool touching)
{
    if (w->touching) w->held += t - w->since;
    w->since = t;
    w->touching = touching;
}

static bool note_event(void *context, const impact_event *event)
{
    watch *w = context;
    if (event->kind == IMPACT_EVENT_CONTACT) touch(w, event->t, true);
    if (event->kind == IMPACT_EVENT_LIFTOFF) touch(w, event->t, false);
    return true;
}

static double pick(random_stream *random, double exponent)
{
    return exponent == MIXED || exponent == BARR ? random_log(random, 1.2, 20) : exponent;
}

/* Its lowest point touches the floor, and rests there, or glides at the velocity slide. */
static impact_body_def set_down(random_stream *random, double exponent, bool rolls)
{
    impact_body_def body = impact_default_body_def();
    qvec3 lowest;
    body.name = "body";
    body.mass = 1;
    double x[6]; /* exponents, then semi-axes */
    for (int i = 0; i < 6; i++) x[i] = i < 3 ? pick(random, exponent) : 0.2 + 0.2 * random_unit(random);
    if (exponent == BARR)
        impact_shape_superellipsoid(x[5], x[4], x[3], 2 / x[2], 2 / x[1], &body.shape);
    else
        impact_shape_superquadric(x[5], x[4], x[3], x[2], x[1], x[0], &body.shape);
    body.orientation = random_rotation(random);
    body.position.z =
        impact_shape_support(&body.shape, quat_rotate_inverse(body.orientation, (qvec3){0, 0, -1}), &lowest);
    body.omega = random_vector(random, 0.1, 3);
    body.velocity = qvec3_neg(qvec3_cross(body.omega, quat_rotate(body.orientation, lowest)));
    if (!rolls) body.velocity.x += 0.3;
    body.friction = rolls ? 1000 : 0;
    body.restitution = 0;
    return body;
}

/* About the vertical; without friction it stays. */
static double vertical_momentum(const impact_scene *scene, const impact_body_def *def)
{
    impact_sample s;
    impact_scene_body(scene, 1, &s);
    const qvec3 moments = qvec3_scale(impact_shape_inertia(&def->shape), def->mass);
    const qvec3 w = quat_rotate_inverse(s.orientation, s.omega);
    return quat_rotate(s.orientation, (qvec3){moments.x * w.x, moments.y * w.y, moments.z * w.z}).z;
}

static double account_error(const impact_scene *scene)
{
    const impact_energy e = impact_scene_energy(scene);
    const double losses = e.damping_loss + e.sliding_loss + e.impact_loss, now = e.kinetic + e.potential;
    return fabs(now - (e.start + e.force_work - losses)) / fmax(fabs(e.start), fmax(e.kinetic, fabs(e.potential)));
}

static void run(random_stream *random, double exponent, bool rolls, tally *row)
{
    impact_body_def bodies[2] = {impact_default_body_def(), set_down(random, exponent, rolls)};
    bodies[0].name = "floor";
    bodies[0].is_static = true;
    bodies[0].friction = 1;
    impact_shape_plane(INFINITY, INFINITY, &bodies[0].shape);
    impact_scene_def def = impact_default_scene_def();
    def.bodies = bodies;
    def.body_count = 2;
    def.duration = duration;
    impact_scene *scene;
    if (impact_scene_create(&def, &scene, row->message, sizeof row->message) != IMPACT_OK) {
        row->refused++;
        return;
    }
    watch w = {0};
    const impact_recorder recorder = {
        .struct_size = sizeof recorder, .context = &w, .event = note_event, .progress = count_step};
    const double before = vertical_momentum(scene, &bodies[1]);
    const impact_status status = impact_scene_run(scene, &recorder);
    touch(&w, impact_scene_time(scene), false);
    if (status == IMPACT_SOFT) row->soft++;
    if (status == IMPACT_STOPPED) row->too_long++;
    if (status < 0) {
        row->refused++;
        snprintf(row->message, sizeof row->message, "%s", impact_scene_message(scene));
    }
    if (status == IMPACT_OK || status == IMPACT_SOFT || status == IMPACT_AT_REST) {
        row->errors[row->ended++] = account_error(scene);
        row->held += w.held / duration;
        row->drift = fmax(row->drift, fabs(vertical_momentum(scene, &bodies[1]) - before) / fmax(fabs(before), 1e-3));
        row->steps += (double)impact_scene_usage(scene).integrator_steps;
        row->starts += (double)impact_scene_usage(scene).integrator_starts;
    }
    impact_scene_destroy(scene);
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void print(const char *name, bool rolls, tally *r)
{
    qsort(r->errors, (size_t)r->ended, sizeof *r->errors, by_size);
    const double n = r->ended;
    printf("%s,%s,%d,%.2g,%.2g,%d,%d,%d,%.2f,", name, rolls ? "rolling" : "frictionless", r->ended,
           r->ended ? r->errors[r->ended / 2] : NAN, r->ended ? r->errors[r->ended - 1] : NAN, r->soft, r->refused,
           r->too_long, r->held / n);
    if (rolls)
        printf(",");
    else
        printf("%.2g,", r->drift);
    printf("%.0f,%.0f,%s\n", r->steps / n, r->starts / n, r->message);
    fflush(stdout);
}

int main(int argc, char **argv)
{
    static const char *const names[] = {"--exponent", "--runs", "--seed", NULL};
    if (!options_known(argc, argv, names)) {
        fprintf(stderr, "report_held [--exponent P] [--runs N] [--seed S]\n");
        return 2;
    }
    const double only = options_number(argc, argv, "--exponent", NAN);
    const int runs = (int)fmin(fmax(options_number(argc, argv, "--runs", 20), 1), MOST_RUNS);
    const uint64_t seed = (uint64_t)options_number(argc, argv, "--seed", 1);
    static tally row;
    printf("exponent,mode,ended,error_median,error_worst,soft,refused,long,held,drift,steps,starts,message\n");
    for (size_t k = 0; k < sizeof exponents / sizeof *exponents; k++)
        for (int rolls = 1; rolls >= 0; rolls--) {
            if (!isnan(only) && exponents[k] != only) continue;
            char name[32];
            if (exponents[k] == MIXED || exponents[k] == BARR)
                snprintf(name, sizeof name, "%s", exponents[k] == MIXED ? "mixed" : "superellipsoid");
            else
                snprintf(name, sizeof name, "%g", exponents[k]);
            memset(&row, 0, sizeof row);
            random_stream random = {seed};
            for (int i = 0; i < runs; i++) run(&random, exponents[k], rolls, &row);
            print(name, rolls, &row);
        }
    return 0;
}
