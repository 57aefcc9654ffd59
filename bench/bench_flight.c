/* SPDX-License-Identifier: MIT
 *
 * bench_flight: torque-free rotation of bodies with three different moments, in closed form, by CVODE's Adams methods,
 * and by the integrators of peers_flight.c, over stretches of several angles: error against run time. CSV: method;
 * setting (tolerance, or rad of the fastest axis a step); angle (of the fastest moment's |L|/I, rad); time in us (mean
 * over the bodies, median over rounds in which all take turns); error of the orientation in rad (p50, worst) against
 * Taylor series in 128-bit arithmetic (nan without libquadmath); a checksum; that time over the closed form's; median
 * over least of the rounds. "closed form": made and asked once; "closed form, again": asked once more.
 */
#include <stdio.h>
#include <stdlib.h>
#include <impact/ode.h>
#include <impact/tumble.h>
#include "../tests/kit/contact_random.h"
#include "measure.h"
#include "peers_flight.h"
#ifdef HAVE_QUADMATH
#include "tumble_oracle.h"
#endif

enum { BODIES = 12, ROUNDS = 9, MOST = 40 };

/* What takes longer is not asked again. */
static double enough(void) { return getenv("BENCH_QUICK") ? 0.01 : 0.15; } /* s */

static int body_count(void)
{
    const int few = 2, count = measure_count(BODIES);
    return count > few ? count : few;
}

static void make_bodies(flight_body *bodies, double angle)
{
    random_stream random = {1};
    for (int i = 0; i < body_count(); i++) {
        flight_body *b = &bodies[i];
        b->moments = (qvec3){random_log(&random, 0.3, 3), random_log(&random, 0.3, 3), random_log(&random, 0.3, 3)};
        b->number = i;
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

/* ---- ours ---- */

static quat closed_form(const flight_body *b, double setting, void *context)
{
    impact_tumble tumble;
    (void)setting, (void)context;
    impact_tumble_make(b->moments, b->orientation, b->momentum, &tumble);
    return impact_tumble_at(&tumble, b->t);
}

typedef struct kept {
    impact_tumble tumble;
    bool made;
} kept;

static void *open_kept(void) { return calloc(BODIES, sizeof(kept)); }

/* Of each body the tumble is made once. */
static quat closed_form_again(const flight_body *b, double setting, void *context)
{
    kept *k = (kept *)context + b->number;
    (void)setting;
    if (!k->made) impact_tumble_make(b->moments, b->orientation, b->momentum, &k->tumble);
    k->made = true;
    return impact_tumble_at(&k->tumble, b->t);
}

/* ---- CVODE, by the library ---- */

static const flight_body *turning;

static int rates(double t, const double *y, double *rate, void *context)
{
    (void)t, (void)context;
    const quat r = flight_rate(turning, (quat){y[0], y[1], y[2], y[3]});
    rate[0] = r.w, rate[1] = r.x, rate[2] = r.y, rate[3] = r.z;
    return 0;
}

static void *open_ode(void)
{
    const impact_ode_def def = {.struct_size = sizeof def,
                                .size = 4,
                                .rhs = rates,
                                .method = IMPACT_ODE_ADAMS,
                                .relative_tolerance = 1e-12,
                                .absolute_tolerance = 1e-12};
    impact_ode *ode;
    return impact_ode_create(&def, &ode) == IMPACT_OK ? ode : NULL;
}

/* The integrator is there already, as in a scene after its first stretch. */
static quat integrated(const flight_body *b, double setting, void *context)
{
    double t, y[4] = {b->orientation.w, b->orientation.x, b->orientation.y, b->orientation.z};
    bool found;
    turning = b;
    if (impact_ode_set_tolerance(context, setting, setting) != IMPACT_OK) return (quat){NAN, NAN, NAN, NAN};
    impact_ode_start(context, 0, y);
    impact_ode_advance(context, b->t, &t, y, NULL, &found);
    return quat_unit((quat){y[0], y[1], y[2], y[3]});
}

static void close_ode(void *ode) { impact_ode_destroy(ode); }

/* ---- the table ---- */

typedef struct contestant {
    const flight_peer *how;
    void *context;
    double times[ROUNDS], spent, sum;
    int rounds, batch;
} contestant;

static double round_of(contestant *c, const flight_body *bodies)
{
    const double from = measure_clock();
    for (int i = 0; i < body_count(); i++)
        for (int k = 0; k < c->batch; k++) c->sum += c->how->turn(&bodies[i], c->how->setting, c->context).x;
    return measure_since(from);
}

static void print(const contestant *c, const flight_body *bodies, double angle, measure_time time, double ours)
{
    double errors[BODIES], sum = 0;
    for (int i = 0; i < body_count(); i++) {
        const quat q = c->how->turn(&bodies[i], c->how->setting, c->context);
        errors[i] = quat_rotation_distance(q, bodies[i].truth);
        sum += q.x;
    }
    const double error = measure_quantile(errors, body_count(), 0.5);
    printf("%s,%g,%g,%.4g,%.2e,%.2e,%.12g,%.3g,%.2f\n", c->how->name, c->how->setting, angle, time.median, error,
           errors[body_count() - 1], sum, time.median / ours, time.spread);
    fflush(stdout);
}

/* So many times that the clock sees it, by one round. */
static void choose_batch(contestant *c, const flight_body *bodies)
{
    const double wanted = 2e-4;
    c->batch = 1;
    const double once = round_of(c, bodies);
    c->batch = once > wanted ? 1 : (int)fmin(1000, ceil(wanted / fmax(once, 1e-7)));
}

static void compete(contestant *list, int count, const flight_body *bodies, double angle)
{
    for (int k = 0; k < count; k++) choose_batch(&list[k], bodies);
    for (int round = 0; round < ROUNDS; round++)
        for (int k = 0; k < count; k++) {
            contestant *c = &list[k];
            if (c->spent > enough()) continue;
            const double seconds = round_of(c, bodies);
            c->spent += seconds;
            c->times[c->rounds++] = 1e6 * seconds / (body_count() * c->batch);
        }
    double ours = 0;
    for (int k = 0; k < count; k++) {
        const measure_time time = measure_of_rounds(list[k].times, list[k].rounds);
        if (k == 0) ours = time.median;
        print(&list[k], bodies, angle, time, ours);
    }
}

static int join(contestant *list, int count, const flight_peer *peer, double angle)
{
    for (; peer->name; peer++)
        if (angle <= peer->most && count < MOST)
            list[count++] = (contestant){.how = peer, .context = peer->open ? peer->open() : NULL};
    return count;
}

int main(void)
{
    static const flight_peer own[] = {{"closed form", 0, 1e9, closed_form, NULL, NULL},
                                      {"closed form again", 0, 1e9, closed_form_again, open_kept, free},
                                      {NULL, 0, 0, NULL, NULL, NULL}},
                             cvode[] = {{"CVODE", 1e-4, 1e9, integrated, open_ode, close_ode},
                                        {"CVODE", 1e-7, 1e9, integrated, open_ode, close_ode},
                                        {"CVODE", 1e-10, 1e9, integrated, open_ode, close_ode},
                                        {"CVODE", 1e-13, 1e9, integrated, open_ode, close_ode},
                                        {"CVODE", 3e-15, 1e9, integrated, open_ode, close_ode},
                                        {NULL, 0, 0, NULL, NULL, NULL}};
    const struct {
        const char *name;
        const flight_peer *list;
    } all[] = {{"libimpact", own},
               {"CVODE", impact_has(IMPACT_PART_CVODE) ? cvode : cvode + 5},
               {"GSL", flight_peers_gsl},
               {"DOP853 (numbalsoda's)", flight_peers_dop853},
               {"RK4", flight_peers_textbook},
               {"MuJoCo", flight_peers_mujoco}};
    const double angles[] = {1, 10, 100, 1000};
    for (int p = 0; p < 6; p++)
        if (!all[p].list[0].name) printf("# %s is not installed: its rows are skipped\n", all[p].name);
    printf("method,tolerance,angle,us,error_p50,error_worst,checksum,time_over_ours,spread\n");
    for (int a = 0; a < 4; a++) {
        flight_body bodies[BODIES];
        static contestant list[MOST];
        int count = 0;
        make_bodies(bodies, angles[a]);
        for (int p = 0; p < 6; p++) count = join(list, count, all[p].list, angles[a]);
        compete(list, count, bodies, angles[a]);
        for (int k = 0; k < count; k++)
            if (list[k].how->close) list[k].how->close(list[k].context);
    }
    return 0;
}
