/* SPDX-License-Identifier: MIT
 *
 * collide, inside: one impact under way, in scaled units: velocities over U = |u_z(0)|, impulses times M_zz / U.
 * The course knows the laws of restitution; how u moves between events is told to it by the solvers.
 */
#ifndef IMP_COLLIDE_COURSE_H
#define IMP_COLLIDE_COURSE_H

#include "collide/collide_frame.h"

typedef struct imp_course {
    const imp_frame *frame;
    imp_real mu, eps;
    impact_law law;
    /* Relative velocity at the contact; s = |(ux, uy)|. */
    imp_real ux, uy, s, uz;
    imp_real from_x, from_y; /* u_t before the impact; u_z was -1 */
    /* Impulse on body 1; p along the normal. */
    imp_real px, py, p;
    /* The least the normal work has been (Stronge's work of loading, <= 0), and how far it is above that now. */
    imp_real work_low, above;
    /* Normal work summed over compressions (<= 0) and over restitutions (>= 0); work of friction, <= 0. */
    imp_real work_c, work_r, work_f;
    /* Normal impulse spent in compressions and in restitutions. */
    imp_real p_c, p_r;
    bool compressing, ended, jammed;
    int compressions, phase_count;
    unsigned char phases[IMPACT_MAX_PHASES];
    imp_real reached[IMPACT_MAX_PHASES][3]; /* px, py, p where each phase ended */
} imp_course;

/* A straight piece: u and the impulse change in proportion to p. Per unit of p: s by R, uz by Z, (px, py) by
 * (gx, gy). */
typedef struct imp_line {
    imp_real R, Z, gx, gy;
    imp_real x, y; /* the direction of u_t, a unit vector; 0 where it does not matter or sticks */
    bool stick;
} imp_line;

void imp_course_start(imp_course *course, const imp_frame *frame, const impact_collision *collision, imp_real ux,
                      imp_real uy);

/* Along the principal directions, which the series and CVODE ask for: turns `frame`, the course's own. */
void imp_course_turn_frame(imp_course *course, const imp_ready *ready, imp_frame *frame);

/* Follows a line for at most `room` of p (INFINITY: to the end of the impact) through as many events as there are. */
void imp_course_line(imp_course *course, const imp_line *line, imp_real room);

/* Where friction goes on from u_t = 0: sticking, or sliding along the one possible direction. */
imp_line imp_course_from_rest(const imp_frame *frame, imp_real mu);

/* The rates of sliding in the direction (x, y), a unit vector, as they are there. */
imp_line imp_course_sliding(const imp_frame *frame, imp_real mu, imp_real x, imp_real y);

/* The line of sliding in the direction (x, y) where that does not turn, T = 0: the same rates, without cancellation. */
imp_line imp_course_straight_line(const imp_frame *frame, imp_real mu, imp_real x, imp_real y);

/* How fast the sliding direction turns, per unit of tau: T = (-y, x) . (M_tz - mu M_tt (x, y)). */
imp_real imp_course_turning(const imp_frame *frame, imp_real mu, imp_real x, imp_real y);

/* Whether T there is nothing but rounding (or beyond the range of numbers): the slip is then taken as a straight one,
 * which puts u_t off by at most 9 eps of its change. */
bool imp_course_is_straight(const imp_frame *frame, imp_real mu, imp_real x, imp_real y);

/* The restitution impulse still due, the velocity at which the impact ends, the work still to be given back. */
imp_real imp_course_left_poisson(const imp_course *course);
imp_real imp_course_target_newton(const imp_course *course);
imp_real imp_course_left_stronge(const imp_course *course);

/* uz at the end of a piece within one phase; a fall in compression is a jam. */
void imp_course_reach(imp_course *course, imp_real uz);

/* The phase that what is booked next belongs to. */
void imp_course_phase(imp_course *course, impact_phase phase);
/* uz has come up to 0: compression turns to restitution; uz has come down to 0: compressed again. */
void imp_course_turn(imp_course *course);
/* Adds a piece that stays within one phase: impulse dp, works of normal impulse and friction. */
void imp_course_book(imp_course *course, imp_real dp, imp_real work, imp_real friction);

/* Where the course stands is where its last phase ended, so far. */
void imp_course_mark(imp_course *course);

/* The rest of a slip that goes straight along (x, y), to u_t = 0 or the end of the impact. */
void imp_course_slide(imp_course *course, imp_real x, imp_real y);

/* Everything from u_t = 0 on. */
void imp_course_finish(imp_course *course);

/* Solves the whole impact when the sliding direction does not turn; false otherwise. */
bool imp_course_straight(imp_course *course);

#endif
