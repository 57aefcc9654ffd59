/* SPDX-License-Identifier: MIT
 *
 * What bench_engines and the engines it compares share: three questions, each asked with a step of the engine's
 * choosing.
 */
#ifndef PEERS_ENGINES_H
#define PEERS_ENGINES_H

#include <impact/collide.h>
#include "measure.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { BOUNCES = 10, TURNS = 100 };

/* S3: a sphere falls with its lowest point `height` up and bounces. */
typedef struct bounce_case {
    double radius, mass, height, gravity, restitution, duration;
} bounce_case;

/* S4: a body turns freely for tumble_seconds(); omega in body axes, the body axes in the world's at the start. */
typedef struct tumble_case {
    double mass;
    qvec3 moments, omega;
} tumble_case;

/* TURNS; with BENCH_QUICK a tenth. */
static inline int tumble_seconds(void) { return getenv("BENCH_QUICK") ? TURNS / 10 : TURNS; }

/* Each gives its answer and the seconds that the motion itself took, without the making of a world. False:
 * no answer. */
typedef struct engine {
    const char *name; /* NULL ends the list */
    double step;      /* s; of an integrator with error control: its accuracy */
    /* velocities after the impact, from its exact point and normal; NULL, here and below: it has none */
    bool (*impact)(const impact_collision *c, double step, qvec3 v[2], qvec3 w[2], double *seconds);
    /* greatest height after each bounce */
    bool (*bounce)(const bounce_case *c, double step, double height[BOUNCES], double *seconds);
    /* orientation at 1, 2 ... tumble_seconds() */
    bool (*tumble)(const tumble_case *c, double step, quat q[TURNS], double *seconds);
} engine;

/* Empty where the engine is not installed. */
extern const engine engines_ode[], engines_bullet[], engines_simbody[];

/* A bouncing point mass watched at each step: the height of each flight from its energy, so that the step's place on
 * the parabola does not count. */
typedef struct bounce_watch {
    double last_speed;
    int bounces;
} bounce_watch;

static inline void bounce_look(bounce_watch *w, const bounce_case *c, double z, double speed, double height[BOUNCES])
{
    if (w->last_speed < 0 && speed > 0 && w->bounces < BOUNCES)
        height[w->bounces++] = z - c->radius + speed * speed / (2 * c->gravity);
    w->last_speed = speed;
}

#ifdef __cplusplus
}
#endif

#endif
