/* SPDX-License-Identifier: MIT
 *
 * euler: rotations as three angles about coordinate axes, all 24 sequences. Conventions in quat.h.
 *
 * Intrinsic sequences turn about the body's own, already turned, axes: XYZ is x-y'-z'', R_x(a) R_y(b) R_z(c) (the
 * thesis' section 5.3.3). Extrinsic ones turn about the fixed world axes: R_z(c) R_y(b) R_x(a). The angles always come
 * in the order of the letters.
 */
#ifndef QUAT_EULER_H
#define QUAT_EULER_H

#include "quat.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Two bits for each axis (0 x, 1 y, 2 z), the first highest; bit 6 for extrinsic. */
typedef enum quat_euler {
    QUAT_EULER_XYZ = 0x06,
    QUAT_EULER_XZY = 0x09,
    QUAT_EULER_YZX = 0x18,
    QUAT_EULER_YXZ = 0x12,
    QUAT_EULER_ZXY = 0x21,
    QUAT_EULER_ZYX = 0x24, /* yaw, pitch, roll */
    QUAT_EULER_XYX = 0x04,
    QUAT_EULER_XZX = 0x08,
    QUAT_EULER_YXY = 0x11,
    QUAT_EULER_YZY = 0x19,
    QUAT_EULER_ZXZ = 0x22, /* Euler's own */
    QUAT_EULER_ZYZ = 0x26,
    QUAT_EULER_EXTRINSIC_XYZ = 0x46,
    QUAT_EULER_EXTRINSIC_XZY = 0x49,
    QUAT_EULER_EXTRINSIC_YZX = 0x58,
    QUAT_EULER_EXTRINSIC_YXZ = 0x52,
    QUAT_EULER_EXTRINSIC_ZXY = 0x61,
    QUAT_EULER_EXTRINSIC_ZYX = 0x64,
    QUAT_EULER_EXTRINSIC_XYX = 0x44,
    QUAT_EULER_EXTRINSIC_XZX = 0x48,
    QUAT_EULER_EXTRINSIC_YXY = 0x51,
    QUAT_EULER_EXTRINSIC_YZY = 0x59,
    QUAT_EULER_EXTRINSIC_ZXZ = 0x62,
    QUAT_EULER_EXTRINSIC_ZYZ = 0x66
} quat_euler;

/* "XYZ" gives the intrinsic, "xyz" the extrinsic sequence. QUAT_EARGUMENT and *sequence = QUAT_EULER_XYZ for a NULL,
 * mixed or unknown name. */
QUAT_API quat_status quat_euler_from_name(const char *name, quat_euler *sequence);

/* The unit quaternion of three angles (radians). QUAT_EDOMAIN (*q = 1) for infinite and NaN angles, QUAT_EARGUMENT
 * (*q = 1) for a sequence that is none of the 24. */
QUAT_API quat_status quat_from_euler(const double angles[3], quat_euler sequence, quat *q);

/* The three angles of a non-zero q, the same for q and -q: first and third in -pi ... pi, the middle one in
 * -pi/2 ... pi/2 (three different axes) or 0 ... pi (first axis = third). Bernardes and Viollet (2022), with no
 * threshold: near lock the first and third angle are simply those that the digits of q give. At exact lock only their
 * sum or difference is known: the third is then 0 and the status QUAT_NOT_UNIQUE. QUAT_EDOMAIN and zeros for zero,
 * infinite and NaN, QUAT_EARGUMENT and zeros for an unknown sequence. */
QUAT_API quat_status quat_to_euler(quat q, quat_euler sequence, double angles[3]);

#ifdef __cplusplus
}
#endif

#endif
