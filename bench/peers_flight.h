/* SPDX-License-Identifier: MIT
 *
 * What bench_flight and the methods it compares share: the orientation of a free body after so long.
 */
#ifndef PEERS_FLIGHT_H
#define PEERS_FLIGHT_H

#include <quat/rotation.h>

typedef struct flight_body {
    qvec3 moments, momentum; /* principal moments; angular momentum, in the world's axes */
    quat orientation, truth;
    double t; /* s */
    int number;
} flight_body;

/* The body's angular velocity in its own axes at the orientation q, of any length. */
static inline qvec3 flight_omega(const flight_body *b, quat q)
{
    const qvec3 l = quat_rotate_inverse(quat_unit(q), b->momentum);
    return (qvec3){l.x / b->moments.x, l.y / b->moments.y, l.z / b->moments.z};
}

/* q' = q (0, omega)/2. */
static inline quat flight_rate(const flight_body *b, quat q)
{
    const qvec3 w = flight_omega(b, q);
    return quat_scale(quat_mul(q, (quat){0, w.x, w.y, w.z}), 0.5);
}

/* A method with error control, or with so many steps to the rad of the fastest axis. */
typedef struct flight_peer {
    const char *name; /* NULL ends the list */
    double setting;   /* tolerance, or rad a step */
    double most;      /* rad: beyond it takes too long */
    quat (*turn)(const flight_body *b, double setting, void *context);
    void *(*open)(void); /* not timed; NULL: it has no state */
    void (*close)(void *context);
} flight_peer;

/* Empty where the peer is not installed. */
extern const flight_peer flight_peers_gsl[], flight_peers_dop853[], flight_peers_mujoco[], flight_peers_textbook[];

#endif
