/* SPDX-License-Identifier: MIT
 *
 * Integrators of torque-free rotation, each of the quaternion with the constant angular momentum: GSL's rk8pd (Prince
 * and Dormand 1981), DOP853 (Hairer, Norsett and Wanner 1993), the classical method of order 4, and the same on the
 * group (Munthe-Kaas 1999): u' = w + u x w/2 + u x (u x w)/12 of the rotation vector u of each step, q <- q exp(u).
 */
#include "peers_dop853.h"
#include "peers_flight.h"

#include <math.h>
#include <stdlib.h>

static void put(quat q, double *y) { y[0] = q.w, y[1] = q.x, y[2] = q.y, y[3] = q.z; }
static quat get(const double *y) { return (quat){y[0], y[1], y[2], y[3]}; }

/* ---- fixed steps ---- */

static long steps_of(const flight_body *b, double step)
{
    const double least = fmin(b->moments.x, fmin(b->moments.y, b->moments.z));
    return (long)ceil(b->t / least / step);
}

static quat classical(const flight_body *b, double setting, void *context)
{
    const long n = steps_of(b, setting);
    const double h = b->t / (double)n;
    quat q = b->orientation;
    (void)context;
    for (long i = 0; i < n; i++) {
        const quat k1 = flight_rate(b, q), k2 = flight_rate(b, quat_add(q, quat_scale(k1, h / 2))),
                   k3 = flight_rate(b, quat_add(q, quat_scale(k2, h / 2))),
                   k4 = flight_rate(b, quat_add(q, quat_scale(k3, h)));
        const quat sum = quat_add(quat_add(k1, k4), quat_scale(quat_add(k2, k3), 2));
        q = quat_unit(quat_add(q, quat_scale(sum, h / 6)));
    }
    return q;
}

/* u' at u, from q. */
static qvec3 group_rate(const flight_body *b, quat q, qvec3 u)
{
    const qvec3 w = flight_omega(b, quat_mul(q, quat_from_rotation_vector(u))), x = qvec3_cross(u, w);
    return qvec3_axpy(1.0 / 12, qvec3_cross(u, x), qvec3_axpy(0.5, x, w));
}

static quat group(const flight_body *b, double setting, void *context)
{
    const long n = steps_of(b, setting);
    const double h = b->t / (double)n;
    quat q = b->orientation;
    (void)context;
    for (long i = 0; i < n; i++) {
        const qvec3 k1 = flight_omega(b, q), k2 = group_rate(b, q, qvec3_scale(k1, h / 2)),
                    k3 = group_rate(b, q, qvec3_scale(k2, h / 2)), k4 = group_rate(b, q, qvec3_scale(k3, h));
        const qvec3 sum = qvec3_axpy(2, qvec3_add(k2, k3), qvec3_add(k1, k4));
        q = quat_unit(quat_mul(q, quat_from_rotation_vector(qvec3_scale(sum, h / 6))));
    }
    return q;
}

const flight_peer flight_peers_textbook[] = {{"RK4", 0.1, 1000, classical, NULL, NULL},
                                             {"RK4", 0.01, 1000, classical, NULL, NULL},
                                             {"RK4", 0.001, 100, classical, NULL, NULL},
                                             {"Lie group RK4", 0.1, 1000, group, NULL, NULL},
                                             {"Lie group RK4", 0.01, 1000, group, NULL, NULL},
                                             {"Lie group RK4", 0.001, 100, group, NULL, NULL},
                                             {NULL, 0, 0, NULL, NULL, NULL}};

/* ---- GSL ---- */

#ifdef HAVE_GSL
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

static int gsl_rates(double t, const double y[], double rate[], void *context)
{
    (void)t;
    put(flight_rate(context, get(y)), rate);
    return GSL_SUCCESS;
}

static quat by_gsl(const flight_body *b, double setting, void *context)
{
    (void)context;
    double t = 0, y[4];
    flight_body body = *b;
    gsl_odeiv2_system system = {gsl_rates, NULL, 4, &body};
    gsl_odeiv2_driver *driver =
        gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, 0.1 * b->t, setting, setting);
    put(b->orientation, y);
    const int status = driver ? gsl_odeiv2_driver_apply(driver, &t, b->t, y) : GSL_ENOMEM;
    gsl_odeiv2_driver_free(driver);
    return status == GSL_SUCCESS ? quat_unit(get(y)) : (quat){NAN, NAN, NAN, NAN};
}

static void *quiet(void)
{
    gsl_set_error_handler_off();
    return NULL;
}

const flight_peer flight_peers_gsl[] = {{"GSL rk8pd", 1e-6, 1000, by_gsl, quiet, NULL},
                                        {"GSL rk8pd", 1e-9, 1000, by_gsl, quiet, NULL},
                                        {"GSL rk8pd", 1e-12, 1000, by_gsl, quiet, NULL},
                                        {"GSL rk8pd", 1e-15, 1000, by_gsl, quiet, NULL},
                                        {NULL, 0, 0, NULL, NULL, NULL}};
#else
const flight_peer flight_peers_gsl[] = {{NULL, 0, 0, NULL, NULL, NULL}};
#endif

/* ---- DOP853 ---- */

#ifdef HAVE_DOP853
static void dop853_rate(double t, double *y, double *rate, double *context)
{
    (void)t;
    put(flight_rate((const flight_body *)(const void *)context, get(y)), rate);
}

static quat by_dop853(const flight_body *b, double setting, void *context)
{
    (void)context;
    double y0[4], y[8] = {NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN}, t[2] = {0, b->t};
    flight_body body = *b;
    int success = 0;
    put(b->orientation, y0);
    dop853_wrapper(dop853_rate, 4, y0, &body, 2, t, y, setting, setting, 10000000, &success);
    return success == 1 ? quat_unit(get(y + 4)) : (quat){NAN, NAN, NAN, NAN};
}

const flight_peer flight_peers_dop853[] = {{"DOP853", 1e-6, 1000, by_dop853, NULL, NULL},
                                           {"DOP853", 1e-9, 1000, by_dop853, NULL, NULL},
                                           {"DOP853", 1e-12, 1000, by_dop853, NULL, NULL},
                                           {"DOP853", 1e-14, 1000, by_dop853, NULL, NULL},
                                           {NULL, 0, 0, NULL, NULL, NULL}};
#else
const flight_peer flight_peers_dop853[] = {{NULL, 0, 0, NULL, NULL, NULL}};
#endif

/* ---- MuJoCo ---- */

#ifdef HAVE_MUJOCO
#include <mujoco/mujoco.h>

typedef struct world {
    mjModel *model;
    mjData *data;
} world;

static void *open_world(void)
{
    static const char *const xml = "<mujoco><option gravity='0 0 0' integrator='RK4'/><worldbody><body><freejoint/>"
                                   "<inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/></body></worldbody></mujoco>";
    world *w = calloc(1, sizeof *w);
    mjSpec *spec = mj_parseXMLString(xml, NULL, NULL, 0);
    if (w && spec) w->model = mj_compile(spec, NULL);
    if (spec) mj_deleteSpec(spec);
    if (w && w->model) w->data = mj_makeData(w->model);
    return w;
}

static void close_world(void *context)
{
    world *w = context;
    if (w && w->data) mj_deleteData(w->data);
    if (w && w->model) mj_deleteModel(w->model);
    free(w);
}

static quat by_mujoco(const flight_body *b, double setting, void *context)
{
    const world *w = context;
    if (!w || !w->data) return (quat){NAN, NAN, NAN, NAN};
    const long n = steps_of(b, setting);
    const qvec3 omega = flight_omega(b, b->orientation);
    double *inertia = w->model->body_inertia + 3;
    inertia[0] = b->moments.x, inertia[1] = b->moments.y, inertia[2] = b->moments.z;
    mj_setConst(w->model, w->data);
    mj_resetData(w->model, w->data);
    w->model->opt.timestep = b->t / (double)n;
    put(b->orientation, w->data->qpos + 3);
    w->data->qvel[3] = omega.x, w->data->qvel[4] = omega.y, w->data->qvel[5] = omega.z;
    for (long i = 0; i < n; i++) mj_step(w->model, w->data);
    return quat_unit(get(w->data->qpos + 3));
}

const flight_peer flight_peers_mujoco[] = {{"MuJoCo RK4", 0.1, 1000, by_mujoco, open_world, close_world},
                                           {"MuJoCo RK4", 0.01, 100, by_mujoco, open_world, close_world},
                                           {"MuJoCo RK4", 0.001, 10, by_mujoco, open_world, close_world},
                                           {NULL, 0, 0, NULL, NULL, NULL}};
#else
const flight_peer flight_peers_mujoco[] = {{NULL, 0, 0, NULL, NULL, NULL}};
#endif
