/* SPDX-License-Identifier: MIT
 *
 * collide, inside: units of mass, length and time in which the numbers of an impact are near 1, and the range that it
 * is taken in.
 */
#ifndef IMP_COLLIDE_UNITS_H
#define IMP_COLLIDE_UNITS_H

#include <stdarg.h>
#include <impact/collide.h>

/* Powers of two: multiplying by them is exact. */
typedef struct imp_units {
    int mass, length, speed;
} imp_units;

/* Reduced mass; longest arm or radius of gyration; fastest velocity. The collision is finite, and of positive masses.
 */
imp_units imp_units_of(const impact_collision *collision);

impact_collision imp_units_scaled(const impact_collision *collision, imp_units units);

/* The other way, and an outcome into them. */
imp_units imp_units_inverse(imp_units units);

/* An outcome in those units, into the caller's. */
void imp_units_restore(impact_outcome *outcome, imp_units units);

/* DBL_MIN of the caller's, in those units. */
typedef struct imp_least {
    double velocity, omega, impulse, energy;
} imp_least;

imp_least imp_units_least(imp_units units);

/* Whether the numbers lie in the range that the kernel is right in (docs/collide.md); else what does not, in words. */
impact_status imp_units_check(const impact_collision *collision, char *message, size_t size);

/* The status, with a message cut to fit. */
impact_status imp_collide_refuse(char *message, size_t size, impact_status status, const char *format, ...);

#endif
