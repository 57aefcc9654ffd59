/* SPDX-License-Identifier: MIT
 *
 * DOP853 (Hairer, Norsett and Wanner 1993) by the wrapper in numbalsoda's wheel, which brings no header: y at the given
 * times, size values each, the first of them y0; success is 1 where the end was reached.
 */
#ifndef PEERS_DOP853_H
#define PEERS_DOP853_H

typedef void dop853_rates(double t, double *y, double *rate, double *context);
void dop853_wrapper(dop853_rates *rates, int size, double *y0, void *context, int times, double *t, double *y,
                    double relative, double absolute, int most_steps, int *success);

#endif
