/* SPDX-License-Identifier: MIT
 *
 * A program of quaternions: the product of two rotations turns a vector. With ANGLES it makes them of axes and angles
 * and tells the product so, which takes sin, cos and atan2.
 */
#include <quat/rotation.h>

#include <stdio.h>

#if defined(ANGLES)
static quat_status turns(int count, quat *a, quat *b)
{
    const quat_status status = quat_from_axis_angle(qvec3_make(0, 0, 1), count, a);
    return status == QUAT_OK ? quat_from_axis_angle(qvec3_make(1, count, 0), 2, b) : status;
}
static quat_status told(quat q, double *angle)
{
    qvec3 axis;
    return quat_to_axis_angle(q, &axis, angle);
}
#else
static quat_status turns(int count, quat *a, quat *b)
{
    const quat_status status = quat_from_two_vectors(qvec3_make(0, count, 1), qvec3_make(1, 0, 0), a);
    return status == QUAT_OK ? quat_normalize(quat_make(count, 1, 0, 2), b) : status;
}
static quat_status told(quat q, double *angle)
{
    const qmat3 m = quat_to_matrix(q);
    *angle = 1 + m.m[0][0];
    return QUAT_OK;
}
#endif

int main(int count, char **arguments)
{
    quat a, b;
    double angle;
    (void)arguments;
    if (turns(count, &a, &b) != QUAT_OK) return 1;
    const quat q = quat_mul(b, a);
    const qvec3 v = quat_rotate(q, qvec3_make(1, 2, 3));
    if (told(q, &angle) != QUAT_OK) return 1;
    const char text[] = {(char)('0' + (int)angle), (char)('0' + (v.x > 0)), 0};
    return puts(text) < 0;
}
