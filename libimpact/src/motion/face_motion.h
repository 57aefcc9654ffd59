/* SPDX-License-Identifier: MIT
 *
 * face_motion: a body that lies with a face on a static one, and slides and turns on it under gravity and what else
 * acts on it. Internal.
 *
 * In the plane of the face, from the foot of the centre of mass, with the velocity v of the centre over the surface and
 * w about the normal n, N = m P, the height c of the centre, J = n.J n and j = the part of J n in the face, under a
 * force m (pull - P n) and a torque T:
 *
 *     v' = F/m + pull,   w' = (M + n.T)/J
 *     int p = N,   int x p = -c F + w' n x j - w^2 j - n x T      no torque tips the body; j turns with it
 *
 * p = a + b.x >= 0 over the face, and F and M of it (face_friction.h) are linear in (a, b): three equations for three
 * numbers. Where the line of no pressure crosses the face they are solved for what it leaves, until that stays:
 * Newton's iteration. The state y = (x, angle, v, w) goes by collocation at Gauss's nine places of a step (order 18),
 * in a time of its own:
 *
 *     dt = |(v, k w)|/A dtau,   A = mu P + |pull| where the step begins,  k the face's radius of gyration
 *
 * (under loads that change + |(v, k w)| root P, which bounds dt/dtau),
 * in which what slides and turns to its end goes there as e^-tau, smoothly, at the end along one twist. What begins to
 * move has no such time: its first step is one of t/root P, in which v = a t + ... is smooth (face_begin.h): no place
 * of a step is at its begin, where friction has no direction. Lengths are in units of the face's reach.
 *
 * A line, along e, of a body that is round about it: across it no pressure is asked for, for about it the body rolls,
 * with W and the moment I. With h = n x e, v + c W h is the velocity of the line's points without w, and the v of y:
 *
 *     I W' = c F.h + T.e,   v' = F/m + pull + c (W' h - W w e),   int p s = -c F.e - h.T - I W w
 *
 * It slides and turns to one instant as a face does; what is left rolls.
 */
#ifndef IMP_FACE_MOTION_H
#define IMP_FACE_MOTION_H

#include "motion/face_friction.h"

#include <stddef.h>

enum {
    IMP_FACE_X,
    IMP_FACE_ANGLE = 2,
    IMP_FACE_V,
    IMP_FACE_W = 5,
    IMP_FACE_TIME,
    IMP_FACE_WORK,   /* that friction has taken, */
    IMP_FACE_PUSHED, /* forces but gravity have done, */
    IMP_FACE_DAMPED, /* and damping has taken */
    IMP_FACE_ROLLED, /* of a line: the angle about it, */
    IMP_FACE_ROLL,   /* and its rate W */
    IMP_FACE_STATE
};

/* What acts but friction, in axes that stay, which the face's are at the angle 0. */
typedef struct imp_face_load {
    double press;          /* P, 1/s^2 */
    double pull[2];        /* 1/s^2 */
    double tip[2];         /* n x T/(m size^2), 1/s^2 */
    double turn;           /* n.T/J, 1/s^2 */
    double power, damping; /* rates of the works, over m size^2, 1/s^3 */
} imp_face_load;

/* It at y, with the time since the step began; false: there is none. */
typedef bool imp_face_loads(const void *context, const double *y, imp_face_load *load);

/* Lengths over `size`, in axes of the face that turn with the body, from the foot of the centre of mass. */
typedef struct imp_face_motion {
    imp_flat_face face;
    double height;         /* c */
    double friction;       /* mu */
    imp_face_load load;    /* where the step begins; all along where there are no */
    imp_face_loads *loads; /* NULL: it is constant */
    const void *context;
    double longest;      /* s: of a step, under loads that change */
    double still;        /* the rest speed; 0: none */
    double turning;      /* m size^2/J */
    double aside[2];     /* j/(m size^2) */
    double rolling;      /* of a line, > 0: I/(m size^2); 0: a face */
    double gyration;     /* k */
    double clock;        /* s: dt/dtau where it is the same all along a step; 0: as above */
    imp_flat_face under; /* what it lies on, in axes that stay; of */
    bool bounded;        /* else: a plane without end */
    imp_pressed whole;   /* of the face: by imp_face_prepare */
    double moments[3][3];
} imp_face_motion;

/* What follows of the face, once it is set. */
void imp_face_prepare(imp_face_motion *motion);

/* What presses and rubs: over m P, in the face's axes. */
typedef struct imp_face_balance {
    double p[3];
    double force[2], moment; /* of friction, the moment about the foot */
    double center[2];        /* of pressure */
} imp_face_balance;

/* A direction of motion (v, w) in the face's axes, not 0, of any size; and w^2, and of a line W w, as they are: 0 of a
 * motion that begins. */
typedef struct imp_face_twist {
    double way[3], square, rolled;
} imp_face_twist;

/* Under a load in the face's axes; twist NULL: it stands, and friction is what balances the load. Else as below. */
bool imp_face_balance_under(const imp_face_motion *motion, const imp_face_load *load, const imp_face_twist *twist,
                            imp_face_balance *balance);
/* With the twist (v, w) in the face's axes, not 0; p is where to begin, 0 for the whole face pressed. False where no
 * pressure balances it: the body tips. */
bool imp_face_balance_of(const imp_face_motion *motion, const double twist[3], imp_face_balance *balance);
/* By an angle: from the face's axes to those that stay, or back. */
void imp_face_turn(const double v[2], double angle, double out[2]);
/* The load at y, its tip in the face's axes; false: there is none, or it does not press. */
bool imp_face_load_at(const imp_face_motion *motion, const double *y, imp_face_load *load);
/* W' of a line; 0 of a face: under a load in the face's axes, with such friction over m P. */
double imp_face_roll_rate(const imp_face_motion *motion, const imp_face_load *load, const double force[2]);
/* By how much more a force across a line moves its points than its centre, 1 + c^2 m/I; 1 of a face. */
double imp_face_ease(const imp_face_motion *motion);
/* Of the twist: by how much differences tell slopes of its friction. */
double imp_face_difference(const imp_face_motion *motion);
/* c W h, by which a line's points are faster than its centre, of its roll W or W': in axes that stay. */
void imp_face_over_center(const imp_face_motion *motion, const double *y, double roll, double out[2]);
/* The centre's velocity, in axes that stay. */
void imp_face_center_velocity(const imp_face_motion *motion, const double *y, double v[2]);
/* Rates of y by time, y of IMP_FACE_STATE numbers: works are over m size^2. */
bool imp_face_rates(const imp_face_motion *motion, const double *y, double *rate, imp_face_balance *balance);

/* How far within all borders the centre of pressure is, and the face within what it lies on. */
double imp_face_margin(const imp_face_motion *motion, const double *y, const imp_face_balance *balance);

/* |(v, k w)| */
double imp_face_speed(const imp_face_motion *motion, const double *y);

enum { IMP_FACE_NODES = 9, IMP_FACE_TERMS = IMP_FACE_NODES + 1 };

/* y over the step = sum of c[k] s^k, s in [-1, 0]. */
typedef struct imp_face_path {
    double c[IMP_FACE_TERMS][IMP_FACE_STATE];
    double length; /* in tau; 0 of what creeps */
    double clock;  /* the motion's; 0: as its speed says */
} imp_face_path;

/* How far along a step its last node is: rates beyond are not asked for. */
extern const double imp_face_last_node;

/* One step from y, of a length (in tau) that begins with *length and suits its error; *length for the next. Of a body
 * at rest, from that on. False: there is none, for the body stands, tips or leaves the border at once. */
bool imp_face_motion_step(const imp_face_motion *motion, const double *y, double *length, imp_face_path *path);
void imp_face_at(const imp_face_path *path, double s, double *y);
/* By how much, in tolerances of a step, the path's rates miss those of its end, where no node stands; 0 where the body
 * tips, of a step over a jump, and of a line under a load that is constant. */
double imp_face_end_miss(const imp_face_motion *motion, const imp_face_path *path);

#endif
