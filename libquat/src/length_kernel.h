/* SPDX-License-Identifier: MIT */
#ifndef QUAT_LENGTH_KERNEL_H
#define QUAT_LENGTH_KERNEL_H

#include <quat/quat.h>
#include "dd.h"

/* q/|q| for |q|^2 in the range of doubles: the plain quotient, corrected by the residual |q|^2 - n^2 of its length. */
static inline quat quat_divide_by_length(quat q)
{
    const quat_dd w = quat_two_prod(q.w, q.w), x = quat_two_prod(q.x, q.x);
    const quat_dd y = quat_two_prod(q.y, q.y), z = quat_two_prod(q.z, q.z);
    const quat_dd wx = quat_two_sum(w.hi, x.hi), yz = quat_two_sum(y.hi, z.hi), sum = quat_two_sum(wx.hi, yz.hi);
    const double n = sqrt(sum.hi);
    const double lost = ((w.lo + x.lo) + (y.lo + z.lo)) + ((wx.lo + yz.lo) + sum.lo);
    const double correction = -0.5 * (fma(-n, n, sum.hi) + lost) / sum.hi;
    const quat unit = quat_make(q.w / n, q.x / n, q.y / n, q.z / n);
    return quat_axpy(correction, unit, unit);
}

#endif
