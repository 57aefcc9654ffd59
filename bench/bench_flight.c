/* SPDX-License-Identifier: MIT
 *
 * bench_flight: torque-free rotation of bodies with three different moments, in closed form and by CVODE's Adams
 * methods at several tolerances, over stretches of several angles: error against run time. CSV: method, tolerance,
 * angle (of the fastest moment's |L|/I, rad), time in us (median over the bodies of the median of repeats), error of
 * the orientation in rad (p50, worst) against Taylor series in 128-bit arithmetic (nan without libquadmath), and a
 * checksum. "closed form": made and asked once; "closed form, again": asked once more.
 */
#include <stdio.h>
#include <stdlib.h>
#include <impact/ode.h>
#include <impact/tumble.h>
#include <quat/rotation.h>
#include "../tests/kit/contact_random.h"
#include "measure.h"
#ifdef HAVE_QUADMATH
#include "tumble_oracle.h"
#endif

enum { BODIES = 24, REPEATS = 9 };

static int body_count(void) { return measure_count(BODIES); }

typedef struct body {
    qvec3 moments, momentum;
    quat orientation, truth;
    double t;
} body;

static void make_bodies(body *bodies, double angle)
{
    random_stream random = {1};
    for (int i = 0; i < body_count(); i++) {
        body *b = &bodies[i];
        b->moments = (qvec3){random_log(&random, 0.3, 3), random_log(&random, 0.3, 3), random_log(&random, 0.3, 3)};
        b->momentum = random_direction(&random);
        b->orientation = random_rotation(&random);
        b->t = angle * fmin(b->moments.x, fmin(b->moments.y, b->moments.z));
#ifdef HAVE_QUADMATH
        b->truth = oracle_tumble(b->moments, b->orientation, b->momentum, b->t);
#else
        b->truth = (quat){NAN, NAN, NAN, NAN};
#endif
    }
}

/* ---- methods: the orientation after t, and how often the clock is to be asked to see one ---- */

typedef struct method {
    const char *name;
    double tolerance;
    int batch;
    quat (*turn)(const body *b, void *context);
} method;

static quat closed_form(const body *b, void *context)
{
    impact_tumble tumble;
    (void)context;
    impact_tumble_make(b->moments, b->orientation, b->momentum, &tumble);
    return impact_tumble_at(&tumble, b->t);
}

static quat closed_form_again(const body *b, void *context) { return impact_tumble_at(context, b->t); }

static int rates(double t, const double *y, double *rate, void *context)
{
    const body *b = context;
    const quat q = {y[0], y[1], y[2], y[3]}, unit = quat_unit(q);
    (void)t;
    const qvec3 l = quat_rotate_inverse(unit, b->momentum);
    const quat turned = quat_mul(q, (quat){0, l.x / b->moments.x, l.y / b->moments.y, l.z / b->moments.z});
    rate[0] = 0.5 * turned.w;
    rate[1] = 0.5 * turned.x;
    rate[2] = 0.5 * turned.y;
    rate[3] = 0.5 * turned.z;
    return 0;
}

/* The integrator is there already, as in a scene after its first stretch. */
static quat integrated(const body *b, void *context)
{
    double t, y[4] = {b->orientation.w, b->orientation.x, b->orientation.y, b->orientation.z};
    bool found;
    impact_ode_start(context, 0, y);
    impact_ode_advance(context, b->t, &t, y, NULL, &found);
    return quat_unit((quat){y[0], y[1], y[2], y[3]});
}

static void *prepare(const method *m, const body *b, impact_tumble *tumble)
{
    if (m->turn == closed_form_again) {
        impact_tumble_make(b->moments, b->orientation, b->momentum, tumble);
        return tumble;
    }
    if (m->turn != integrated) return NULL;
    const impact_ode_def def = {.struct_size = sizeof def,
                                .size = 4,
                                .rhs = rates,
                                .context = (void *)b,
                                .method = IMPACT_ODE_ADAMS,
                                .relative_tolerance = m->tolerance,
                                .absolute_tolerance = m->tolerance};
    impact_ode *ode;
    return impact_ode_create(&def, &ode) == IMPACT_OK ? ode : NULL;
}

/* One row; ours: the closed form's time, 0 where this is it. Returns the time. */
static double measure(const method *m, const body *bodies, double angle, double ours)
{
    double times[BODIES], errors[BODIES], sum = 0;
    for (int i = 0; i < body_count(); i++) {
        impact_tumble tumble;
        void *context = prepare(m, &bodies[i], &tumble);
        double repeats[REPEATS];
        quat q = {1, 0, 0, 0};
        for (int r = 0; r < REPEATS; r++) {
            const double start = measure_clock();
            for (int k = 0; k < m->batch; k++) {
                q = m->turn(&bodies[i], context);
                sum += q.x;
            }
            repeats[r] = (measure_clock() - start) / m->batch * 1e6;
        }
        times[i] = measure_quantile(repeats, REPEATS, 0.5);
        errors[i] = quat_rotation_distance(q, bodies[i].truth);
        if (m->turn == integrated) impact_ode_destroy(context);
    }
    const double error = measure_quantile(errors, body_count(), 0.5), time = measure_quantile(times, body_count(), 0.5);
    printf("%s,%g,%g,%.4g,%.2e,%.2e,%.12g,%.3g\n", m->name, m->tolerance, angle, time, error, errors[body_count() - 1],
           sum / (m->batch * REPEATS), ours > 0 ? time / ours : 1);
    fflush(stdout);
    return time;
}

int main(void)
{
    const double angles[] = {1, 10, 100, 1000};
    printf("method,tolerance,angle,us,error_p50,error_worst,checksum,time_over_ours\n");
    for (int a = 0; a < 4; a++) {
        body bodies[BODIES];
        make_bodies(bodies, angles[a]);
        const double ours = measure(&(method){"closed form", 0, 200, closed_form}, bodies, angles[a], 0);
        measure(&(method){"closed form again", 0, 1000, closed_form_again}, bodies, angles[a], ours);
        if (!impact_has(IMPACT_PART_CVODE)) continue;
        for (double tolerance = 1e-4; tolerance > 5e-16; tolerance *= tolerance > 5e-13 ? 1e-3 : 0.03)
            measure(&(method){"CVODE", tolerance, angles[a] > 50 ? 1 : 10, integrated}, bodies, angles[a], ours);
    }
    if (!impact_has(IMPACT_PART_CVODE)) fprintf(stderr, "bench_flight: no CVODE in this build\n");
    return 0;
}
