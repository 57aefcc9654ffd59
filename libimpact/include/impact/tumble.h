/* SPDX-License-Identifier: MIT
 *
 * tumble: torque-free rotation of a rigid body with any principal moments, in closed form: Jacobi's elliptic functions
 * for the angular velocity, a theta series for the angle about the angular momentum. Method, sources and accuracy:
 * docs/flight.md.
 */
#ifndef IMPACT_TUMBLE_H
#define IMPACT_TUMBLE_H

#include <quat/quat.h>
#include "status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One modulus of elliptic functions, and one elliptic integral of the third kind: the numbers of their series. */
enum { IMPACT_THETA_TERMS = 5 };

typedef struct impact_elliptic {
    double K;        /* quarter period; infinite at m = 1 */
    bool hyperbolic; /* the series are in powers of exp(-pi K/K'), not of exp(-pi K'/K) */
    double scale, sn, cn, dn, even[IMPACT_THETA_TERMS], odd[IMPACT_THETA_TERMS];
} impact_elliptic;

typedef struct impact_elliptic_phase {
    double slope; /* at 0 */
    double linear, sine[IMPACT_THETA_TERMS], cosine[IMPACT_THETA_TERMS];
} impact_elliptic_phase;

/* A torque-free rotation, ready to be asked for any time. A plain value; its first four numbers may be read, the
 * others are the room's own. */
typedef struct impact_tumble {
    quat orientation; /* at t = 0, body to world, unit */
    qvec3 momentum;   /* angular, about the centre, world, kg m^2/s: kept for ever */
    qvec3 moments;    /* principal, along the body axes, kg m^2 */
    qvec3 omega;      /* angular velocity at t = 0, body axes, rad/s */

    bool steady;  /* omega is constant */
    double size;  /* of the momentum */
    qvec3 turn;   /* steady: omega, world */
    double rate;  /* of the elliptic functions' argument, 1/s */
    double start; /* their argument at t = 0 */
    double mean;  /* mean rate of the angle about the momentum, rad/s */
    double sense, start_phase;
    double amplitude[3]; /* of the momentum's direction in the body, along the axes below */
    int axis[3];         /* the body's axes: far, middle, and the one that the momentum circles */
    double sign[3];
    quat first; /* minimal rotation of the momentum's direction onto the third axis, at t = 0 */
    impact_elliptic elliptic;
    impact_elliptic_phase phase;
} impact_tumble;

/* moments: each finite and > 0, in any ratio (no triangle inequality is asked for); equal ones and nearly equal ones
 * are fine. orientation: normalised on use. momentum: finite, world; zero stays where it is. IMPACT_EDOMAIN: a NaN or
 * infinity, given or in momentum/moments, or a zero orientation; IMPACT_EARGUMENT: a moment <= 0. *tumble is then
 * unchanged. A momentum exactly on the separatrix or on an axis of spin is followed there: it is for rounding to decide
 * whether a body spun about its middle axis ever turns over. */
IMPACT_API impact_status impact_tumble_make(qvec3 moments, quat orientation, qvec3 momentum, impact_tumble *tumble);

/* The same from the angular velocity in the body's axes, rad/s: what slender bodies are to be kept by, since the
 * momentum in world axes has lost eps J_max/J_min of the spin about their axis. Statuses as above, moments times omega
 * in place of the momentum. */
IMPACT_API impact_status impact_tumble_make_omega(qvec3 moments, quat orientation, qvec3 omega, impact_tumble *tumble);

/* The orientation after t seconds, of any sign and size: unit, its sign continuous in t. The error is a few
 * roundings, and a few of the angle turned through: 1e-16 |omega t|. NaN only for a t that is not finite. */
IMPACT_API quat impact_tumble_at(const impact_tumble *tumble, double t);

/* The angular velocity then, rad/s, in the body's axes, each component to the rounding of its own amplitude; at t = 0
 * the bits that impact_tumble_make_omega was given. */
IMPACT_API qvec3 impact_tumble_omega_body(const impact_tumble *tumble, double t);

/* The same in world axes. */
IMPACT_API qvec3 impact_tumble_omega(const impact_tumble *tumble, double t);

/* The period of the angular velocity in the body's axes, s: infinite where it is constant, and on the separatrix. A
 * body that turns over (Dzhanibekov, Poinsot) does so twice in it. */
IMPACT_API double impact_tumble_period(const impact_tumble *tumble);

#ifdef __cplusplus
}
#endif

#endif
