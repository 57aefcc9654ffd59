/* SPDX-License-Identifier: MIT
 *
 * What the files of the curve share. Internal.
 */
#ifndef QUAT_CURVE_INTERNAL_H
#define QUAT_CURVE_INTERNAL_H

#include <quat/curve.h>

bool quat_curve_is_good(const quat_curve *curve);
/* Position and unit tangent; statuses as quat_curve_at's. */
quat_status quat_curve_tangent(const quat_curve *curve, double t, qvec3 *position, qvec3 *tangent);

#endif
