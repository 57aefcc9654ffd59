/* SPDX-License-Identifier: MIT
 *
 * Random impacts, each a function of (class, seed, index) alone, for tests, benchmarks and the campaign.
 */
#ifndef COLLIDE_CASES_H
#define COLLIDE_CASES_H

#include <stdint.h>
#include <impact/collide.h>

typedef enum case_class {
    CASE_PLAIN,   /* two bodies of like mass and size, mu 0 ... 1 */
    CASE_WILD,    /* mass ratios 1e-8 ... 1e8, mu 1e-3 ... 1e3, slim bodies */
    CASE_ROD,     /* slim bodies struck near an end: jam, reversal, second compression */
    CASE_TANGENT, /* |u_t| from 1e-6 to 1e6 of |u_z| */
    CASE_REST,    /* u_t = 0, or nothing but rounding */
    CASE_PLANAR,  /* everything in one plane */
    CASE_SPHERE,
    CASE_SMOOTH,    /* mu = 0 */
    CASE_ISOTROPIC, /* a = b, c and d not 0, exactly or to rounding; some mu as in wild, u_t as in tangent */
    CASE_TILTED,    /* planar ones turned any way: in one plane but for rounding */
    CASE_CLASSES,
    /* At the limits of what is admitted: collide_extremes.c. */
    CASE_SLENDER = CASE_CLASSES, /* moments r : 1 : 1, r = 1e-1 ... 1e-9, any way and along the axes, struck anywhere */
    CASE_SLIPPERY,               /* slender or not, mu 1e-8 ... 1e-300, all units within 1e+-8 */
    CASE_RANGE,                  /* every number within 1e+-3 ... 1e+-100; many are refused */
    CASE_ALL
} case_class;

const char *case_name(case_class class_);

/* A collision that approaches (CASE_RANGE: or touches); about one in ten at restitution 0, one in ten at 1; the laws in
 * turn. */
impact_collision case_make(case_class class_, uint64_t seed, uint64_t index);

/* A slender impact with the given r. */
impact_collision case_slender(uint64_t seed, uint64_t index, double r);

/* splitmix64 (Steele, Lea, Flood 2014): the next number, in [0, 1). */
double case_random(uint64_t *state);

/* sqrt(sum |dv|^2 + rho^2 |dw|^2) over the same of the wanted velocities; static bodies do not count. */
double case_error(const impact_collision *c, const qvec3 v[2], const qvec3 w[2], const qvec3 wanted_v[2],
                  const qvec3 wanted_w[2]);

#endif
