/* SPDX-License-Identifier: MIT
 *
 * force: what acts on bodies besides uniform gravity and contact.
 */
#ifndef IMPACT_FORCE_H
#define IMPACT_FORCE_H

#include <quat/quat.h>
#include "record.h"
#include "status.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum impact_force_kind {
    IMPACT_FORCE_WIND,       /* a tube of constant direction; strength falls along it */
    IMPACT_FORCE_ATTRACTION, /* between every two bodies that move: G m1 m2 / r^power, along the line of centres */
    IMPACT_FORCE_CUSTOM      /* the caller's function */
} impact_force_kind;

/* Force (N, world, at the centre) and torque (N m, world) of a custom force at time t; both are zero on entry. They
 * must be smooth along the motion but at the switches and edges of the definition. They are asked at velocities nearby
 * too: forces that brake fast beside the motion are followed by BDF, not Adams. Return false to stop the run with an
 * error. */
typedef bool impact_force_function(double t, int body, double mass, qvec3 position, quat orientation, qvec3 velocity,
                                   qvec3 omega, qvec3 *force, qvec3 *torque, void *context);

/* Where a custom force has a corner or a jump along the motion of a body: zero there, of other signs on its two sides;
 * in any unit, finite (else the run ends with IMPACT_EDOMAIN). */
typedef double impact_edge_function(double t, const impact_sample *body, void *context);

typedef struct impact_force_def {
    size_t struct_size; /* see impact_body_def */
    impact_force_kind kind;
    const char *name;
    const char *body; /* acts on this body only; NULL: on every body that moves */

    /* wind: along the unit of direction, at distance d = |(x - origin) . direction| along the tube:
     * strength (1 + d/falloff_length)^(-falloff_power) while d <= reach and within radius of the axis, else 0. */
    qvec3 origin, direction;
    double strength;       /* N */
    double reach, radius;  /* m; infinite: no edge. attraction uses reach too: no force between bodies further apart */
    double falloff_power;  /* 0: none */
    double falloff_length; /* m, > 0 */
    /* wind: N s/m, >= 0. With it the wind pulls towards its own speed, strength/drag along its direction: the force is
     * (1 + d/falloff_length)^(-falloff_power) (strength direction - drag v), v the body's velocity. 0: none. */
    double drag;

    double constant; /* attraction: G in N m^power / kg^2 */
    double power;    /* attraction: 2 for Newton */

    impact_force_function *function; /* custom */
    void *context;                   /* handed to function and edge */
    /* custom: between two times at which the force is asked lie at most max_step seconds (> 0; NaN: a thousandth of the
     * scene's duration) and the time in which the body moves by its radius, if that is no less than a thousandth of
     * max_step; infinite: neither holds. What is narrower can be stepped over, unless it is declared: */
    double max_step;
    /* custom: the times at which the force jumps or has a corner, s, rising, finite, copied. Between them it is asked
     * at times inside alone, by at least eight roundings. */
    const double *switches;
    int switch_count;
    bool steady; /* custom: does not depend on t, so that what rests under it rests for ever; else it is asked on */
    double switch_period;       /* s; > 0: they come again and again, before and after, in periods; 0: once */
    impact_edge_function *edge; /* custom: NULL: none. A zero is an event of the kind IMPACT_EVENT_FORCE. */
} impact_force_def;

/* The same defaults into a struct of struct_size bytes, as impact_fill_scene_def. */
IMPACT_API void impact_fill_force_def(impact_force_def *def, size_t struct_size, impact_force_kind kind);

/* Defaults: wind along +x of strength 0 with no edge and no falloff; attraction with Newton's G = 6.67430e-11 and power
 * 2 (CODATA 2018). */
IMPACT_INLINE impact_force_def impact_default_force_def(impact_force_kind kind)
{
    impact_force_def def;
    impact_fill_force_def(&def, sizeof def, kind);
    return def;
}

#ifdef __cplusplus
}
#endif

#endif
