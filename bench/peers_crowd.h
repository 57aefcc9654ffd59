/* SPDX-License-Identifier: MIT
 *
 * What bench_crowd and the programs it compares share: a gas of balls in a box with elastic, frictionless walls.
 */
#ifndef PEERS_CROWD_H
#define PEERS_CROWD_H

#include <quat/quat.h>
#include <stdlib.h>
#include <time.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Balls in the cube from 0 to side, of density 1 kg/m^3, that neither overlap nor turn. */
typedef struct gas {
    int count;
    double side; /* m */
    double *radius;
    qvec3 *position, *velocity;
} gas;

typedef struct gas_run {
    double seconds; /* of the processor, for the motion alone */
    long events;    /* impacts; -1: the program counts none */
    double energy;  /* at the end, over that of the start, less 1 */
    double memory;  /* bytes; NaN: not known */
} gas_run;

/* Moves a gas for so long; false: it cannot. */
typedef bool gas_program(const gas *g, double duration, gas_run *run);

gas_program crowd_textbook;          /* balls of one size only */
gas_program crowd_ode, crowd_bullet; /* in steps of crowd_step; false where the engine is not installed */

static const double crowd_step = 1e-3; /* s */

/* Of the processor: the machine may have other work. */
static inline double crowd_clock(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* The wall k of six: where it stands, and the way it faces. */
static inline void crowd_wall(const gas *g, int k, qvec3 *place, qvec3 *normal)
{
    const double far = k % 2 ? g->side : 0, out = k % 2 ? -1 : 1;
    *normal = qvec3_make(k / 2 == 0 ? out : 0, k / 2 == 1 ? out : 0, k / 2 == 2 ? out : 0);
    *place = qvec3_make(k / 2 == 0 ? far : 0, k / 2 == 1 ? far : 0, k / 2 == 2 ? far : 0);
}

static inline double crowd_mass(double radius) { return 4.1887902047863905 * radius * radius * radius; }

static inline double crowd_energy(double radius, qvec3 v) { return 0.5 * crowd_mass(radius) * qvec3_dot(v, v); }

#ifdef __cplusplus
}
#endif

#endif
