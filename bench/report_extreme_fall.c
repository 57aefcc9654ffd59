/* SPDX-License-Identifier: MIT
 *
 * Bodies that fall tilted or spinning, beside truth_fall.
 */
#include "report_extreme.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <quat/rotation.h>

#if defined(HAVE_QUADMATH)
#include "truth_fall.h"

/* What the trial's body, the second, is to truth_fall. */
static truth_fall fall_of(const extreme_trial *t, double exponent)
{
    impact_body_def body = impact_default_body_def();
    impact_scene_body_def(t->scene, 1, &body);
    const impact_shape *shape = &t->bodies[1].shape;
    truth_fall f = {.mass = body.mass,
                    .axis = {shape->a, shape->b, shape->c},
                    .exponent = exponent,
                    .moments = body.moments,
                    .gravity = extreme_gravity,
                    .restitution = body.restitution,
                    .friction = body.friction,
                    .law = t->def.law};
    f.from = (truth_state){0, body.position, body.velocity, quat_unit(body.orientation), {0, 0, 0}};
    f.from.omega = quat_rotate_inverse(f.from.orientation, body.omega);
    return f;
}

/* The flights up to the third impact and half the way to the next, each followed for a thousand radians at most
 * after an impact; until when they tell. */
enum { FLIGHTS = 4 };
/* With BENCH_QUICK to the first impact, and for thirty radians. */
static bool is_quick(void) { return getenv("BENCH_QUICK") != NULL; }
static int flights_of(truth_fall f, double duration, truth_fall flights[FLIGHTS], double *until)
{
    int count = 0;
    double begin = 0, most = duration;
    bool struck = true;
    while (struck && count < (is_quick() ? 2 : FLIGHTS)) {
        flights[count++] = f;
        begin = f.from.t;
        if (count > 1) most = fmin(duration, begin + (is_quick() ? 30 : 1e3) / qvec3_norm(f.from.omega));
        struck = truth_fall_next(&f, most);
    }
    *until = struck ? (begin + f.from.t) / 2 : most;
    return count;
}

/* Of places over the height of the fall, of velocities over the greatest (points of the body's own), and rad. */
static double apart(const truth_state *a, const truth_state *b, double way, double size)
{
    const qvec3 turning = qvec3_sub(quat_rotate(a->orientation, a->omega), quat_rotate(b->orientation, b->omega));
    const double speed = sqrt(2 * extreme_gravity * way) + size * qvec3_norm(a->omega),
                 v = qvec3_norm(qvec3_sub(a->velocity, b->velocity)) + size * qvec3_norm(turning);
    return fmax(fmax(qvec3_norm(qvec3_sub(a->position, b->position)) / way, v / speed),
                quat_rotation_distance(a->orientation, b->orientation));
}

static truth_state found(const extreme_trial *t, double at)
{
    const impact_sample s = extreme_end_of(t, 1);
    return (truth_state){at, s.position, s.velocity, s.orientation, quat_rotate_inverse(s.orientation, s.omega)};
}

/* The greatest difference at 12 times, of the scene or, where it is NULL, of flights that begin a little aside; what
 * is nearer to an impact than a thousandth is not asked. */
static double greatest(extreme_trial *t, const truth_fall one[], int count, const truth_fall aside[], double until)
{
    enum { TIMES = 12 };
    double worst = 0;
    const double way = one[0].from.position.z, size = one[0].axis[0];
    for (int k = 1; k <= TIMES; k++) {
        const double at = until * k / TIMES;
        int flight = 0;
        bool near = false;
        for (int i = 1; i < count; i++) {
            near = near || fabs(at - one[i].from.t) < until / 1000;
            if (one[i].from.t <= at) flight = i;
        }
        if (near) continue;
        if (t) extreme_go_on(t, at);
        const truth_state wanted = truth_fall_at(&one[flight], at),
                          got = t ? found(t, at) : truth_fall_at(&aside[flight], at);
        worst = fmax(worst, apart(&wanted, &got, way, size));
    }
    return worst;
}

/* The condition: of a start that is higher by 1e-12, or of the flights. Not asked for with BENCH_QUICK. */
static double condition_of(const truth_fall flights[], int count, double until, double duration)
{
    const double nudge = 1e-12;
    double worst = 0, other;
    truth_fall aside[FLIGHTS], f = flights[0];
    if (is_quick()) return NAN;
    for (int i = 0; i < count; i++)
        worst = fmax(worst, truth_fall_condition(&flights[i], i + 1 < count ? flights[i + 1].from.t : until));
    f.from.position.z *= 1 + nudge;
    if (flights_of(f, duration, aside, &other) != count) return NAN;
    return fmax(worst, greatest(NULL, flights, count, aside, until) / nudge);
}

void extreme_falling(const char *name, double parameter, extreme_trial *t, double exponent)
{
    truth_fall flights[FLIGHTS];
    double until;
    const int count = flights_of(fall_of(t, exponent), t->def.duration, flights, &until);
    const double error = greatest(t, flights, count, NULL, until);
    if (!is_quick()) extreme_go_on(t, t->def.duration);
    extreme_row(name, parameter, t,
                (extreme_source){error, "oracle", until, condition_of(flights, count, until, t->def.duration)});
}
#else
void extreme_falling(const char *name, double parameter, extreme_trial *t, double exponent)
{
    (void)exponent;
    fprintf(stderr, "report_extreme: %s %g is left out: the compiler has no 128 bits\n", name, parameter);
    impact_scene_destroy(t->scene);
}
#endif
