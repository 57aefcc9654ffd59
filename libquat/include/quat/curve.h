/* SPDX-License-Identifier: MIT
 *
 * curve: space curves: arc length, curvature and torsion, and their moving frames as curves of quaternions.
 * Conventions in quat.h; lengths in
 * the caller's unit. Ready-made curves are in family.h.
 *
 * A frame's body x axis is the unit tangent T, in the direction of growing t; for a Frenet frame y is the principal
 * normal N and z the binormal B = T x N. Frames come out continuous on S^3: neighbours are on the same side.
 */
#ifndef QUAT_CURVE_H
#define QUAT_CURVE_H

#include "quat.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Sets d[0] = x(t) and d[k] = its k-th derivative for k up to the curve's `known`; leaves the others alone. False where
 * the curve has no value; the functions below then return QUAT_EDOMAIN, as for an infinite or NaN value. */
typedef bool (*quat_curve_function)(double t, qvec3 d[4], void *context);

/* A curve x(t), start <= t <= end. `closed`: x is periodic with period end - start, and t is taken into start ... end
 * before `at` is called. Derivatives that are not known are taken by differences of the highest known one, inside
 * start ... end. */
typedef struct quat_curve {
    quat_curve_function at;
    void *context;
    double start, end;
    bool closed;
    int known; /* 0 ... 3 */
} quat_curve;

/* Points x[i] at increasing t[i]; a closed curve's last point is its first again. Both arrays stay the caller's. */
typedef struct quat_samples {
    size_t n;
    const double *t;
    const qvec3 *x;
    bool closed;
} quat_samples;

/* The curve through the samples: between t[i] and t[i+1] the polynomial through the eight nearest points (four or more,
 * when there are no eight). Continuous, with derivatives that jump at the samples by what the interpolation errs:
 * O(h^8) in position, O(h^(8-k)) in derivative k. *samples must outlive the curve. QUAT_EARGUMENT for fewer than 4
 * samples and for t that do not increase; QUAT_EDOMAIN for infinite or NaN values, and for a closed curve that does not
 * end where it starts, to 1e-9 of its size. */
QUAT_API quat_status quat_curve_from_samples(const quat_samples *samples, quat_curve *curve);

/* ---- at a point ---- */

/* d[0] = x(t) and its derivatives up to `order` (0 ... 3). error[k] (error may be NULL) estimates the error of d[k]:
 * rounding, and for differences what the best step leaves; about 1e-13, 1e-11, 1e-9 of the curve's size for k = 1, 2, 3
 * when only x is known. QUAT_EARGUMENT: a curve without a function, bad ends or `known`, bad order. QUAT_EDOMAIN: t
 * outside an open curve, infinite or NaN; no value. *d is zero then. */
QUAT_API quat_status quat_curve_derivatives(const quat_curve *curve, double t, int order, qvec3 d[4], double error[4]);

typedef struct quat_curve_point {
    qvec3 position;
    double speed;                          /* |dx/dt| */
    double curvature;                      /* |x' x x''|/|x'|^3, not negative */
    double torsion;                        /* (x' x x'').x'''/|x' x x''|^2: positive for a right-handed helix */
    double curvature_error, torsion_error; /* estimates */
    quat frame;                            /* Frenet's, w >= 0: x tangent, y normal, z binormal */
} quat_curve_point;

/* The Frenet apparatus at t. QUAT_NOT_UNIQUE at an inflection, where the curvature vanishes within four times its
 * error: curvature and torsion are 0 then, and the frame is the shortest rotation that carries x to the tangent.
 * QUAT_EDOMAIN besides where the speed is 0 within its error; all zero then, frame = 1, but for the position if there
 * is one. QUAT_ERANGE: a derivative above 1e100 or a speed below 1e-100, where products overflow or vanish. Other
 * errors as above. */
QUAT_API quat_status quat_curve_at(const quat_curve *curve, double t, quat_curve_point *point);

/* ---- arc length ---- */

/* The length from t = a to t = b, negative for b < a: adaptive Gauss-Kronrod over the speed, to about 1e-13 of it.
 * QUAT_NOT_CONVERGED with the best value when that is not reached (a speed with poles, noise, differences that err by
 * 1e-8 of the curve's size). QUAT_ERANGE when it overflows; other statuses as quat_curve_derivatives'; *length = 0
 * then. */
QUAT_API quat_status quat_curve_length(const quat_curve *curve, double a, double b, double *length);
/* The t at `length` along the curve from its start: Newton's method, kept in a bracket. QUAT_EDOMAIN for a length
 * outside 0 ... the whole (by more than 1e-9 of it), QUAT_NOT_CONVERGED as for lengths. */
QUAT_API quat_status quat_curve_at_length(const quat_curve *curve, double length, double *t);
/* n >= 2 values of t at equal distances along the curve, increasing, from start to end. QUAT_NOT_CONVERGED where a
 * length is that, or nothing but noise: the rest are then at equal steps of t. Other statuses as quat_curve_length's,
 * and QUAT_EARGUMENT for n < 2. */
QUAT_API quat_status quat_curve_even(const quat_curve *curve, size_t n, double t[]);

/* Integrals along the curve: length, of the curvature (2 pi or more for a closed curve, more than 4 pi for a knot;
 * Fenchel, Fary, Milnor) and of the torsion. QUAT_NOT_UNIQUE when an inflection was met: the torsion counts as 0
 * there. */
typedef struct quat_curve_totals {
    double length, curvature, torsion;
} quat_curve_totals;
QUAT_API quat_status quat_curve_total(const quat_curve *curve, quat_curve_totals *totals);

/* ---- frames along the curve ---- */

typedef enum quat_framing {
    QUAT_FRENET,  /* from the derivatives; turns over where the curve has an inflection */
    QUAT_MINIMAL, /* rotation-minimising: does not turn about its tangent; need not close with a closed curve */
    QUAT_CLOSED   /* minimal, with the holonomy taken back in proportion to arc length; closed curves only */
} quat_framing;

typedef struct quat_framing_report {
    double holonomy; /* closed curves: the angle about the tangent by which the minimal frame comes back turned,
                      * -pi ... pi; minus the total torsion, up to full turns. 0 for open ones */
    int monodromy;   /* closed curves: +1 when q[n-1] comes back on q[0]'s side of S^3, -1 opposite; 0 for open ones */
    size_t inflections; /* QUAT_FRENET: where there is no normal or it turned over; 0 otherwise */
} quat_framing_report;

/* Frames at n >= 2 increasing t[i], or at equal steps from start to end when t is NULL. Minimal frames start from the
 * Frenet frame, or from *first (may be NULL), swung so that its x axis is the tangent, and go by the double reflection
 * of Wang, Juettler, Zheng and Liu (2008): error O(h^4) over the curve. Holonomy and monodromy need t from start to
 * end. Frenet frames at an inflection are carried on from the sample before. QUAT_NOT_UNIQUE when inflections were met.
 * QUAT_EARGUMENT: n, t, `framing`, or QUAT_CLOSED for an open curve or t that do not go from start to end.
 * QUAT_EDOMAIN: no tangent somewhere, two samples at one place. */
QUAT_API quat_status quat_curve_frames(const quat_curve *curve, quat_framing framing, const quat *first, size_t n,
                                       const double t[], quat q[], quat_framing_report *report);

/* One step of the double reflection: the frame at (x1, unit tangent1) of the frame q at x0, whose tangent is its x
 * axis. QUAT_EDOMAIN and *next = q when x0 = x1, when the tangent is zero, infinite or NaN, and when it is the mirror
 * image of the other in the chord's plane to rounding (2e-15 rad: a cusp between the two). */
QUAT_API quat_status quat_frame_step(quat q, qvec3 x0, qvec3 x1, qvec3 tangent1, quat *next);

#ifdef __cplusplus
}
#endif

#endif
