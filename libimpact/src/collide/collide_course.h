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
    double mu, eps;
    impact_law law;
    /* Relative velocity at the contact; s = |(ux, uy)|. */
    double ux, uy, s, uz;
    /* Impulse on body 1; p along the normal. */
    double px, py, p;
    /* The least the normal work has been (Stronge's work of loading, <= 0), and how far it is above that now. */
    double work_low, above;
    /* Normal work summed over compressions (<= 0) and over restitutions (>= 0); work of friction, <= 0. */
    double work_c, work_r, work_f;
    /* Normal impulse spent in compressions and in restitutions. */
    double p_c, p_r;
    bool compressing, ended, jammed;
    int compressions, phase_count;
    unsigned char phases[IMPACT_MAX_PHASES];
} imp_course;

/* A straight piece: u and the impulse change in proportion to p. Per unit of p: s by R, uz by Z, (px, py) by
 * (gx, gy). */
typedef struct imp_line {
    double R, Z, gx, gy;
    bool stick;
} imp_line;

void imp_course_start(imp_course *course, const imp_frame *frame, const impact_collision *collision, double ux,
                      double uy);

/* Follows a line for at most `room` of p (INFINITY: to the end of the impact) through as many events as there are. */
void imp_course_line(imp_course *course, const imp_line *line, double room);

/* Where friction goes on from u_t = 0: sticking, or sliding along the one possible direction. */
imp_line imp_course_from_rest(const imp_frame *frame, double mu);

/* The line of sliding in the direction (x, y), a unit vector, if it were not to turn. */
imp_line imp_course_sliding(const imp_frame *frame, double mu, double x, double y);

/* How fast the sliding direction turns, per unit of tau: T = (-y, x) . (M_tz - mu M_tt (x, y)). */
double imp_course_turning(const imp_frame *frame, double mu, double x, double y);

/* Whether T there is nothing but rounding: the slip is then taken as a straight one, which puts u_t off by at most
 * 2e-15 of its change. */
bool imp_course_is_straight(const imp_frame *frame, double mu, double x, double y);

/* The restitution impulse still due, the velocity at which the impact ends, the work still to be given back. */
double imp_course_left_poisson(const imp_course *course);
double imp_course_target_newton(const imp_course *course);
double imp_course_left_stronge(const imp_course *course);

/* uz at the end of a piece within one phase; a fall in compression is a jam. */
void imp_course_reach(imp_course *course, double uz);

void imp_course_phase(imp_course *course, impact_phase phase);
/* uz has come up to 0: compression turns to restitution; uz has come down to 0: compressed again. */
void imp_course_turn(imp_course *course);
/* Adds a piece that stays within one phase: impulse dp, works of normal impulse and friction. */
void imp_course_book(imp_course *course, double dp, double work, double friction);

/* Everything from u_t = 0 on. */
void imp_course_finish(imp_course *course);

/* Solves the whole impact when the sliding direction does not turn; false otherwise. */
bool imp_course_straight(imp_course *course);

#endif
