/* SPDX-License-Identifier: MIT
 *
 * difference: derivatives of functions that are known by their values only. Internal.
 */
#ifndef QUAT_DIFFERENCE_H
#define QUAT_DIFFERENCE_H

#include <quat/quat.h>

#define QUAT_DIFFERENCE_NODES 9
#define QUAT_DIFFERENCE_ORDERS 3

/* weights[k][i]: what value i counts in derivative k (0 ... orders) at 0 of the polynomial through n <= 9 nodes
 * (Fornberg 1988). */
void quat_difference_weights(int n, const double node[], int orders, double weights[][QUAT_DIFFERENCE_NODES]);

/* A vector along a line; false when it has none. */
typedef bool (*quat_line)(double t, qvec3 *x, void *context);

/* The derivatives 1 ... orders (at most 3) of f at t, d[0] ... d[orders - 1], from nine values within low ... high. The
 * step is halved from (high - low)/24, or span/24 when the ends are infinite, until rounding outweighs truncation; f's
 * values are taken to be known to rounding and `noise`. error[k] is what the best step of derivative k leaves; *step
 * (may be NULL) is that of the first. */
bool quat_differentiate(quat_line f, void *context, double t, double low, double high, double span, double noise,
                        int orders, qvec3 d[], double error[], double *step);

/* The first derivative at a step that is known to be good. */
bool quat_differentiate_once(quat_line f, void *context, double t, double low, double high, double step, qvec3 *d);

#endif
