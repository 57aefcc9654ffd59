/* SPDX-License-Identifier: MIT */
#ifndef QUAT_LENGTH_KERNEL_H
#define QUAT_LENGTH_KERNEL_H

#include <math.h>
#include <quat/quat.h>

/* q/|q| for |q|^2 in the range of doubles, without branches. The quotient u = q r keeps what its rounding lost, and its
 * length is put right by c = (1 - |u|^2)/2, summed in halves so small that each rounding on the way is a quarter of a
 * unit. Half a unit in all, and half for the result. */
static inline quat quat_divide_by_length(quat q)
{
    const double r = 1 / sqrt(quat_norm2(q));
    const quat u = quat_scale(q, r);
    const quat lost = quat_make(fma(q.w, r, -u.w), fma(q.x, r, -u.x), fma(q.y, r, -u.y), fma(q.z, r, -u.z));
    const double excess = fma(u.w, u.w, fma(u.x, u.x, -0.5)) + fma(u.y, u.y, fma(u.z, u.z, -0.5));
    const double c = -0.5 * excess - (fma(u.w, lost.w, u.x * lost.x) + fma(u.y, lost.y, u.z * lost.z));
    return quat_make(u.w + fma(c, u.w, lost.w), u.x + fma(c, u.x, lost.x), u.y + fma(c, u.y, lost.y),
                     u.z + fma(c, u.z, lost.z));
}

#endif
