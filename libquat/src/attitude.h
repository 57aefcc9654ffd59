/* SPDX-License-Identifier: MIT
 *
 * The rotation that fits a 3 x 3 profile matrix best, shared by rotation and average.
 */
#ifndef QUAT_ATTITUDE_H
#define QUAT_ATTITUDE_H

#include <quat/quat.h>

/* Eigenvalues (descending) and orthonormal eigenvectors (vectors[k] belongs to values[k]) of the symmetric a, by cyclic
 * Jacobi rotations; a is destroyed. Elements near overflow or underflow are the caller's to scale. */
void quat_eigen4(double a[4][4], double values[4], double vectors[4][4]);

/* The unit q with w >= 0 that maximises trace(R(q)^T m), Davenport's q-method. QUAT_NOT_UNIQUE when the two largest
 * eigenvalues agree to rounding; QUAT_EDOMAIN and *q = 1 for a zero, infinite or NaN m. */
quat_status quat_attitude(const qmat3 *m, quat *q);

#endif
