/* SPDX-License-Identifier: MIT */
#include <quat/quat.h>

const char *quat_status_string(quat_status status)
{
    switch (status) {
    case QUAT_OK: return "ok";
    case QUAT_NOT_UNIQUE: return "the answer is not unique; one was chosen";
    case QUAT_EDOMAIN: return "zero, infinite or NaN where a finite, non-zero value is needed";
    case QUAT_EARGUMENT: return "argument out of range";
    case QUAT_ENOMEM: return "out of memory";
    case QUAT_EABSENT: return "this part was left out of the build";
    }
    return "unknown status";
}

double qvec3_norm(qvec3 a) { return hypot(hypot(a.x, a.y), a.z); }

quat_status quat_normalize(quat q, quat *unit)
{
    const double largest = fmax(fmax(fabs(q.w), fabs(q.x)), fmax(fabs(q.y), fabs(q.z)));
    if (!(isfinite(q.w) && isfinite(q.x) && isfinite(q.y) && isfinite(q.z)) || largest == 0) {
        *unit = quat_identity();
        return QUAT_EDOMAIN;
    }
    const int shift = -ilogb(largest);
    const quat s = {ldexp(q.w, shift), ldexp(q.x, shift), ldexp(q.y, shift), ldexp(q.z, shift)};
    const double norm = sqrt(quat_dot(s, s));
    *unit = (quat){s.w / norm, s.x / norm, s.y / norm, s.z / norm};
    return QUAT_OK;
}
