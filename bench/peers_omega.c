/* SPDX-License-Identifier: MIT
 *
 * GSL's rk8pd and DOP853 on q' = q (0, w(t))/2.
 */
#include "peers_omega.h"

#include <math.h>
#include "peers_dop853.h"

static void rates(double t, const double *y, double *rate)
{
    const quat r = quat_derivative_body((quat){y[0], y[1], y[2], y[3]}, omega_at(t));
    rate[0] = r.w, rate[1] = r.x, rate[2] = r.y, rate[3] = r.z;
}

static quat unit_of(const double *y) { return quat_unit((quat){y[0], y[1], y[2], y[3]}); }

static void begin(double *y)
{
    const quat q = omega_truth(0);
    y[0] = q.w, y[1] = q.x, y[2] = q.y, y[3] = q.z;
}

#ifdef HAVE_GSL
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

static int gsl_rates(double t, const double y[], double rate[], void *context)
{
    (void)context;
    rates(t, y, rate);
    return GSL_SUCCESS;
}

static quat by_gsl(double tolerance)
{
    double t = 0, y[4];
    gsl_odeiv2_system system = {gsl_rates, NULL, 4, NULL};
    gsl_odeiv2_driver *driver =
        gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, 0.1, tolerance, tolerance);
    begin(y);
    const int status = driver ? gsl_odeiv2_driver_apply(driver, &t, omega_duration, y) : GSL_ENOMEM;
    gsl_odeiv2_driver_free(driver);
    return status == GSL_SUCCESS ? unit_of(y) : (quat){NAN, NAN, NAN, NAN};
}

const omega_peer omega_peers_gsl[] = {{"GSL rk8pd", 1e-6, by_gsl},
                                      {"GSL rk8pd", 1e-9, by_gsl},
                                      {"GSL rk8pd", 1e-12, by_gsl},
                                      {"GSL rk8pd", 1e-15, by_gsl},
                                      {NULL, 0, NULL}};
#else
const omega_peer omega_peers_gsl[] = {{NULL, 0, NULL}};
#endif

#ifdef HAVE_DOP853
static void dop853_rate(double t, double *y, double *rate, double *context)
{
    (void)context;
    rates(t, y, rate);
}

static quat by_dop853(double tolerance)
{
    double y0[4], y[8] = {NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN}, t[2] = {0, omega_duration};
    int success = 0;
    begin(y0);
    dop853_wrapper(dop853_rate, 4, y0, NULL, 2, t, y, tolerance, tolerance, 10000000, &success);
    return success == 1 ? unit_of(y + 4) : (quat){NAN, NAN, NAN, NAN};
}

const omega_peer omega_peers_dop853[] = {{"DOP853", 1e-6, by_dop853},
                                         {"DOP853", 1e-9, by_dop853},
                                         {"DOP853", 1e-12, by_dop853},
                                         {"DOP853", 1e-14, by_dop853},
                                         {NULL, 0, NULL}};
#else
const omega_peer omega_peers_dop853[] = {{NULL, 0, NULL}};
#endif
