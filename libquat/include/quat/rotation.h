/* SPDX-License-Identifier: MIT
 *
 * rotation: unit quaternions as rotations of space. Conventions in quat.h.
 */
#ifndef QUAT_ROTATION_H
#define QUAT_ROTATION_H

#include "quat.h"

#ifdef __cplusplus
extern "C" {
#endif

/* v rotated by the unit quaternion q (body to world): v + 2 w (u x v) + 2 u x (u x v), u the vector part. */
static inline qvec3 quat_rotate(quat q, qvec3 v)
{
    const qvec3 u = {q.x, q.y, q.z};
    qvec3 t = qvec3_cross(u, v);
    t = (qvec3){t.x + t.x, t.y + t.y, t.z + t.z};
    return qvec3_add(qvec3_axpy(q.w, t, v), qvec3_cross(u, t));
}

/* The inverse rotation, world to body. */
static inline qvec3 quat_rotate_inverse(quat q, qvec3 v) { return quat_rotate(quat_conj(q), v); }

/* The unit quaternion of the rotation vector r (axis times angle, radians); r = 0 gives 1. */
QUAT_API quat quat_from_rotation_vector(qvec3 r);

/* Rotation by angle (radians) about axis (any finite non-zero length). QUAT_EDOMAIN and *q = 1 otherwise. */
QUAT_API quat_status quat_from_axis_angle(qvec3 axis, double angle, quat *q);

/* The rotation matrix of the unit quaternion q: its columns are the body axes in the world. */
QUAT_API qmat3 quat_to_matrix(quat q);

#ifdef __cplusplus
}
#endif

#endif
