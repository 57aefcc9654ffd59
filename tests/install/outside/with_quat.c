/* SPDX-License-Identifier: MIT */
#include <quat/rotation.h>

#include <stdio.h>

/* A quarter turn about z takes x to y. */
int main(void)
{
    quat q;
    if (quat_from_axis_angle(qvec3_make(0, 0, 2), acos(0.0), &q) != QUAT_OK) return 1;
    const qvec3 v = quat_rotate(q, qvec3_make(1, 0, 0));
    printf("quat: (1, 0, 0) -> (%g, %g, %g)\n", v.x, v.y, v.z);
    return qvec3_norm(qvec3_sub(v, qvec3_make(0, 1, 0))) < 1e-15 ? 0 : 1;
}
