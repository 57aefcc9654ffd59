/* SPDX-License-Identifier: MIT
 *
 * report_flat: what drops on a face. Box-like superquadrics of one exponent, and cylinders of (2, 2, p), are let fall
 * .01 m onto their largest face, tilted, or thrown in any orientation (tilt "any"), and watched for five seconds.
 *
 * report_flat [--steps N] [--seed S] [--exponent P]
 * CSV: one row per shape, tilt, and friction, over the restitutions 0, .3 and .8: rest: runs that came to rest; ended:
 * that still moved after five seconds; long: stopped after N steps of the integrator (a million); refused: with an
 * error, or the word that the account is off. account: the worst error of the energy account, over the energy at the
 * start; sunk: the deepest that the body ended in the plane, over its bounding radius; steps: the most.
 */
#include <stdio.h>
#include <stdlib.h>
#include <impact/scene.h>
#include "../tests/kit/contact_random.h"
#include "options.h"

typedef struct tally {
    int rest, ended, too_long, refused;
    double account, sunk;
    long steps;
} tally;

typedef struct watch {
    long steps, most;
} watch;

static bool count_step(void *context, double t, double end)
{
    (void)t, (void)end;
    watch *w = context;
    return ++w->steps < w->most;
}

static impact_body_def drop(const impact_shape *shape, quat orientation, double friction, double restitution)
{
    impact_body_def body = impact_default_body_def();
    body.name = "body";
    body.mass = 1;
    body.shape = *shape;
    body.orientation = orientation;
    body.friction = friction;
    body.restitution = restitution;
    body.position.z = 0.01 + impact_shape_support(shape, quat_rotate_inverse(orientation, (qvec3){0, 0, -1}), NULL);
    return body;
}

static void run(const impact_body_def *body, long most, tally *row)
{
    impact_body_def bodies[2] = {impact_default_body_def(), *body};
    bodies[0].name = "floor";
    bodies[0].is_static = true;
    bodies[0].friction = bodies[0].restitution = 1;
    impact_shape_plane(INFINITY, INFINITY, &bodies[0].shape);
    impact_scene_def def = impact_default_scene_def();
    def.bodies = bodies;
    def.body_count = 2;
    def.duration = 5;
    def.output_rate = 0;
    impact_scene *scene;
    if (impact_scene_create(&def, &scene, NULL, 0) != IMPACT_OK) {
        row->refused++;
        return;
    }
    watch w = {.most = most};
    const impact_recorder recorder = {.struct_size = sizeof recorder, .context = &w, .progress = count_step};
    const impact_status status = impact_scene_run(scene, &recorder);
    row->rest += status == IMPACT_AT_REST;
    row->ended += status == IMPACT_OK;
    row->too_long += status == IMPACT_STOPPED;
    row->refused += status < 0 || status == IMPACT_SOFT;
    const impact_energy e = impact_scene_energy(scene);
    impact_sample s;
    impact_scene_body(scene, 1, &s);
    const double lowest =
        s.position.z - impact_shape_support(&body->shape, quat_rotate_inverse(s.orientation, (qvec3){0, 0, -1}), NULL);
    row->account =
        fmax(row->account, fabs(e.kinetic + e.potential - e.start + e.sliding_loss + e.impact_loss) / fabs(e.start));
    row->sunk = fmax(row->sunk, -lowest / impact_shape_bounding_radius(&body->shape));
    row->steps = (long)fmax((double)row->steps, (double)impact_scene_usage(scene).integrator_steps);
    impact_scene_destroy(scene);
}

static void report(const char *name, double exponent, const impact_shape *shape, double tilt, double friction,
                   long most, random_stream *random)
{
    static const double restitutions[] = {0, 0.3, 0.8};
    tally row = {0};
    for (int i = 0; i < 3; i++) {
        const quat q =
            isnan(tilt) ? random_rotation(random) : quat_from_rotation_vector((qvec3){0.8 * tilt, 0.6 * tilt, 0});
        const impact_body_def body = drop(shape, q, friction, restitutions[i]);
        run(&body, most, &row);
    }
    char angle[32] = "any";
    if (!isnan(tilt)) snprintf(angle, sizeof angle, "%g", tilt);
    printf("%s,%g,%s,%g,%d,%d,%d,%d,%.1g,%.1g,%ld\n", name, exponent, angle, friction, row.rest, row.ended,
           row.too_long, row.refused, row.account, row.sunk, row.steps);
    fflush(stdout);
}

int main(int argc, char **argv)
{
    static const char *const names[] = {"--steps", "--exponent", "--seed", NULL};
    if (!options_known(argc, argv, names)) {
        fprintf(stderr, "report_flat [--steps N] [--exponent P] [--seed S]\n");
        return 2;
    }
    static const double exponents[] = {4, 10, 20, 50, 100}, tilts[] = {0, 1e-6, 1e-3, 0.1, NAN};
    const long most = (long)fmax(options_number(argc, argv, "--steps", 1e6), 1);
    const double only = options_number(argc, argv, "--exponent", NAN);
    random_stream random = {(uint64_t)options_number(argc, argv, "--seed", 1)};
    printf("shape,exponent,tilt,friction,rest,ended,long,refused,account,sunk,steps\n");
    for (int cylinder = 0; cylinder < 2; cylinder++)
        for (int k = cylinder ? 4 : 0; k < 5; k++)
            for (int i = 0; i < 5; i++)
                for (int rough = 1; rough >= 0; rough--) {
                    const double p = exponents[k];
                    if (!isnan(only) && p != only) continue;
                    impact_shape shape;
                    if (cylinder)
                        impact_shape_superquadric(0.2, 0.2, 0.15, 2, 2, p, &shape);
                    else
                        impact_shape_superquadric(0.2, 0.25, 0.15, p, p, p, &shape);
                    report(cylinder ? "cylinder" : "box", p, &shape, tilts[i], rough ? 0.3 : 0, most, &random);
                }
    return 0;
}
