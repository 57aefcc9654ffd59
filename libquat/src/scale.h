/* SPDX-License-Identifier: MIT
 *
 * Scaling by powers of two, exact but where the result is subnormal; for the library's own use.
 */
#ifndef QUAT_SCALE_H
#define QUAT_SCALE_H

#include <quat/quat.h>

static inline quat quat_ldexp(quat q, int exponent)
{
    return quat_make(ldexp(q.w, exponent), ldexp(q.x, exponent), ldexp(q.y, exponent), ldexp(q.z, exponent));
}

/* q = s 2^exponent with the largest component of s in [1, 2). Zero is left alone; q must be finite. */
static inline quat quat_prescale(quat q, int *exponent)
{
    const double largest = fmax(fmax(fabs(q.w), fabs(q.x)), fmax(fabs(q.y), fabs(q.z)));
    *exponent = largest > 0 ? ilogb(largest) : 0;
    return quat_ldexp(q, -*exponent);
}

static inline qvec3 quat_ldexp_vector(qvec3 v, int exponent)
{
    return qvec3_make(ldexp(v.x, exponent), ldexp(v.y, exponent), ldexp(v.z, exponent));
}

/* The exponent of v's largest component; 0 for zero. v must be finite. */
static inline int quat_vector_exponent(qvec3 v)
{
    const double largest = fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z)));
    return largest > 0 ? ilogb(largest) : 0;
}

#endif
