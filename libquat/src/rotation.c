/* SPDX-License-Identifier: MIT */
#include <quat/rotation.h>

quat quat_from_rotation_vector(qvec3 r)
{
    const double angle = qvec3_norm(r);
    const double half = 0.5 * angle;
    const double s = half < 1e-8 ? 0.5 : sin(half) / angle;
    return (quat){cos(half), s * r.x, s * r.y, s * r.z};
}

quat_status quat_from_axis_angle(qvec3 axis, double angle, quat *q)
{
    quat unit;
    const quat_status status = quat_normalize((quat){0, axis.x, axis.y, axis.z}, &unit);
    if (status != QUAT_OK || !isfinite(angle)) {
        *q = quat_identity();
        return QUAT_EDOMAIN;
    }
    const double s = sin(0.5 * angle);
    *q = (quat){cos(0.5 * angle), s * unit.x, s * unit.y, s * unit.z};
    return QUAT_OK;
}

qmat3 quat_to_matrix(quat q)
{
    const double xx = 2 * q.x * q.x, yy = 2 * q.y * q.y, zz = 2 * q.z * q.z;
    const double xy = 2 * q.x * q.y, xz = 2 * q.x * q.z, yz = 2 * q.y * q.z;
    const double wx = 2 * q.w * q.x, wy = 2 * q.w * q.y, wz = 2 * q.w * q.z;
    return (qmat3){{{1 - (yy + zz), xy - wz, xz + wy}, {xy + wz, 1 - (xx + zz), yz - wx}, {xz - wy, yz + wx, 1 - (xx + yy)}}};
}
