/* SPDX-License-Identifier: MIT
 *
 * springs: the limit of stiff springs at the contacts of a group. Internal; equations in docs/together.md.
 *
 * In units in which the mean of W_nn, the greatest speed and the greatest stiffness are of order 1, K -> infinity with
 * ratios kept stretches time so that
 *
 *     delta' = -u_n,   p' = F = (lambda, f_t),   u = u0 + W p,   lambda = kappa (delta - base)^eta or 0
 *     kappa, base = k, 0 while loading;  k eps^(-2 eta), (1 - eps^2) delta_m after u_n has turned at delta_m
 *     u_t != 0:  f_t = -mu lambda u_t/|u_t|       u_t = 0:  |f_t| <= mu lambda, leaving the least u_t'
 *
 * Between events all is smooth, and p, delta are Taylor series in tau, dt = g dtau. g is 1, or what is about to vanish:
 *   w = sqrt(delta - base) of Hertz's force near opening or closing: delta^(3/2) is then w^3, w' = -u_n/2;
 *   s = |u_t| of slip about to stop:  g f_t = -mu lambda u_t.
 */
#ifndef IMP_SPRINGS_H
#define IMP_SPRINGS_H

#include "contact/encounter.h"

/* Of a step of some radians no velocity has more zeros than a handful. */
enum { IMP_SPRINGS_ORDER = 22, IMP_SPRINGS_TERMS = IMP_SPRINGS_ORDER + 2, IMP_SPRINGS_EXTREMES = 8 };
/* Of slips that creep: nodes of a step, and how many are taken together: as many as two bodies have points. */
enum { IMP_SPRINGS_NODES = 8, IMP_SPRINGS_CREEPERS = 16 };

typedef enum imp_spring_normal { IMP_SPRING_OPEN, IMP_SPRING_LOADS, IMP_SPRING_UNLOADS } imp_spring_normal;

typedef enum imp_spring_slip {
    IMP_SPRING_SMOOTH,   /* no friction, or no force */
    IMP_SPRING_STICKS,   /* u_t = 0 */
    IMP_SPRING_SLIDES,   /* u_t != 0 */
    IMP_SPRING_STRAIGHT, /* u_t along `along`, from which nothing turns it */
    IMP_SPRING_BEGINS    /* u_t = 0 here, and then along `along` */
} imp_spring_slip;

typedef double imp_terms[IMP_SPRINGS_TERMS];

/* One contact, in the solver's units. */
typedef struct imp_spring {
    double friction, restitution, stiffness;
    double tiny; /* x = delta - base up to which the force does nothing that a double would hold */
    imp_spring_normal normal;
    imp_spring_slip slip;
    double x, base, kappa, deepest; /* delta = x + base */
    double u[3], p[3];
    double rounding; /* of u, by its terms */
    double none;     /* a velocity that is none: rounding, or what held slips have drifted to */
    bool free;       /* SLIDES, and could beside what sticks */
    bool still;      /* u_t is zero: it came to a stop, or was never more than rounding */
    bool summed;     /* u_t has been summed from step to step since it was 0: free of the rounding of u0 and W p */
    bool creeps;     /* SLIDES, so slowly that its direction is `along` (springs_creep.c) */
    bool weak;       /* BEGINS: from no acceleration, u_t ~ t^2; else u_t ~ t */
    double along[2]; /* of slip; STICKS: the friction's ratio to lambda where reactions are not unique */
    double stored;   /* energy in the spring */
    double loose;    /* what was spent when it last slid or was open (springs.c) */
    imp_finding *finding;
    /* Series in tau. */
    imp_terms velocity[3]; /* u */
    imp_terms depth;       /* x */
    imp_terms root;        /* w, of the leading contact */
    imp_terms force;       /* lambda */
    imp_terms push[3];     /* g F = dp/dtau */
    imp_terms speed;       /* s */
    imp_terms ratio;       /* g lambda/s */
    imp_terms angle;       /* BEGINS: of u_t from `along`; its cosine and sine */
    imp_terms cosine, sine;
} imp_spring;

/* Of W by rows: the columns without zeros, and without those of no friction where they are tangential. */
typedef struct imp_spring_rows {
    int *start, *column;
} imp_spring_rows;

/* What leads: the factor g of time. */
typedef enum imp_spring_lead { IMP_SPRING_TIME, IMP_SPRING_ROOT, IMP_SPRING_SPEED } imp_spring_lead;

/* Moments of bounces that may never end: at the closings of one contact. */
typedef struct imp_springs_bounces {
    int contact;
    long rounds, span; /* closings since the first of three moments; between them */
    long expected;     /* events until which it closes again */
    double *room;
} imp_springs_bounces;

typedef struct imp_springs {
    int count;
    double exponent;
    imp_spring *springs;
    const double *w; /* (3 count)^2, without units */
    const double *u0;
    imp_spring_rows rows, pressed; /* all; columns of what presses alone */
    /* What sticks: its components, and the pseudo-inverse of their part of W. */
    int stick_count, *stick;
    double *inverse;
    bool deficient; /* which is none: reactions are not unique */
    double *now;    /* 3 count: the forces of one order */
    double *scratch, *factor, *wedge;
    imp_spring_lead lead;
    int leader;
    double stretch;          /* of SPEED: g = stretch |u_t| */
    int begin_count, *begin; /* contacts that begin to slip */
    double *turning;         /* their system */
    imp_cone_workspace *cone;
    imp_cone_mode *modes;
    double *creep_room, creep_step; /* of what creeps: room, and the last step */
    double creep_due;               /* work at which it is tried again: where it failed, once powers cost as much */
    imp_spring *kept;
    bool creeping; /* the series are springs_creep.c's */
    bool stopped;  /* a slip has: what sticks must be chosen anew */
    int closing;   /* what has just closed, of several the one that bounces are counted by; -1: nothing */
    imp_springs_bounces bounces;
    long events, steps;
    double work; /* multiplications so far, roughly */
    bool chosen;
} imp_springs;

static inline double imp_springs_entry(const imp_springs *s, int i, int j)
{
    return s->w[(size_t)i * 3 * (size_t)s->count + (size_t)j];
}

static inline bool imp_springs_presses(const imp_spring *c) { return c->normal != IMP_SPRING_OPEN; }

/* ---- springs_modes.c ---- */

/* The system of what sticks, anew. */
void imp_springs_tie(imp_springs *s);
/* Whether it is that of what sticks now. */
bool imp_springs_is_tied(const imp_springs *s);
/* push[..][k] of the sticking contacts from those of the others. */
void imp_springs_hold(imp_springs *s, int k);
/* The columns of what presses, anew. */
void imp_springs_pack_pressed(imp_springs *s);
/* Row i of W times the forces `now`, of what presses. */
double imp_springs_row(const imp_springs *s, int i);
/* The accelerations of now: forces into `now`; du/dt of contact c, component i by imp_springs_row. */
void imp_springs_forces(imp_springs *s);
/* Whether what sticks leaves the contact's slip two ways of its own: were it to stick too reactions would be as unique
 * as they are. */
bool imp_springs_is_free(const imp_springs *s, int contact);
/* Which slips go straight. */
void imp_springs_straighten(imp_springs *s);

/* ---- springs_choose.c ---- */

/* Whether friction of what sticks, which is not unique, is over its bound; forces as of now. */
bool imp_springs_is_over(const imp_springs *s);
/* Chooses what sticks and what slips among the still contacts that press: forces as of now. False: not settled. */
bool imp_springs_choose(imp_springs *s);

/* ---- springs_centre.c ---- */

/* Of what sticks, where reactions are not unique: ratios that take the least part of the bounds; the plain forces are
 * `now`. */
void imp_springs_centre(imp_springs *s);

/* ---- springs_series.c ---- */

/* The series from here on; their usable length in tau. */
double imp_springs_expand(imp_springs *s);

/* W across to across of what begins (begin[begin_count]), stick answering, into `turning`: column d by a unit of force
 * across at contact d. */
void imp_springs_make_turning(imp_springs *s);

/* Gauss with pivoting: a x = b of order n, row by row; a is lost, b becomes x. */
void imp_springs_gauss(double *a, double *b, int n);

/* ---- springs_creep.c ---- */

/* Doubles of room for n contacts. */
size_t imp_springs_creep_size(size_t n);
/* The series from here on by collocation, where that goes much further than `reach`: their length in time, else 0 (the
 * series are lost, and no contact is changed). */
double imp_springs_creep(imp_springs *s, double reach);

/* ---- springs_events.c ---- */

/* h^k, k < count */
void imp_springs_find_powers(double h, int count, double *power);
/* Whether sum c_k t^k, k < terms, is above zero on (0, h], by its coefficients: the first that count are by more than
 * what the others take; false where they do not tell. */
bool imp_springs_stay_above(const double *c, int terms, const double *power);
/* The first time in [0, h] at which sum c_k t^k, k <= order, falls to 0, or h where it does not: none is missed. *found
 * tells. c[0] <= 0 falls at 0. */
double imp_springs_first_fall(const double *c, int order, double h, bool *found);
/* Of t in [0, 1], as of series in units of their reach. Whether sum c_k t^k, k < 5, less what is taken is above zero on
 * (0, 1], by three terms, the first one, two or none of which are zero or give; false where they do not tell. */
bool imp_springs_begins_above(const double c[5], double takes);
/* The same of terms >= 5. */
bool imp_springs_is_clear(const double *c, int terms);
/* The time at which sum c_k t^k, k <= order, falls from c[0] > 0 to 0, where it is shown that there is no other; *found
 * false where that does not tell. about: when, or 0. */
double imp_springs_lone_fall(const double *c, int order, double about, bool *found);

/* Where sum c_k t^k changes its sign in (0, t): the times, at most so many; returns how many. */
int imp_springs_sign_changes(const double *c, int order, double t, double *when, int most);

/* ---- springs_bounces.c ---- */

/* Doubles of room for n contacts. */
size_t imp_springs_bounces_size(size_t n);
/* Whether bounces are like those before, to whose end impulses, works and velocities have gone then; s->closing closes.
 */
bool imp_springs_end_bounces(imp_springs *s);

/* Of three moments, the last one now: impulses and works, 3 count each. */
static inline double *imp_springs_impulses_at(const imp_springs *s, int moment)
{
    return s->bounces.room + 6 * s->count * moment;
}
static inline double *imp_springs_works_at(const imp_springs *s, int moment)
{
    return imp_springs_impulses_at(s, moment) + 3 * s->count;
}

/* ---- springs_rest.c ---- */

/* To where bounces end by their end's own equations, impulses, works and velocities; ratio: of the last differences of
 * impulses. False: they do not come to rest, or are not seen to, and nothing is changed. */
bool imp_springs_come_to_rest(imp_springs *s, double ratio);

/* ---- springs_changes.c ---- */

/* The force's branch; delta stays as it is. */
void imp_springs_take_branch(imp_springs *s, int contact, imp_spring_normal normal, double base, double kappa);
double imp_springs_energy(const imp_springs *s, const imp_spring *c, double x);
/* x from which an unloading spring is loaded on. */
double imp_springs_again(const imp_spring *c);
/* The velocity across slip that goes straight from which on it does no longer; INFINITY: whatever it does is nothing.
 */
double imp_springs_turned(const imp_springs *s, int contact);
/* Of its friction alone the contact's slip changes by up to so much. */
double imp_springs_mobility_along(const imp_springs *s, int contact);
/* How fast forces change: springs swing, or are let go. */
double imp_springs_pace(const imp_springs *s);
/* Whether any is closed. */
bool imp_springs_pressed(const imp_springs *s);
/* Everything that is due now: turns, closings, openings, stops, and then what sticks. False: not settled. */
bool imp_springs_settle(imp_springs *s);

/* ---- springs_step.c ---- */

/* To the next event, or as far as the series reach, and what happens there. False: not settled. */
bool imp_springs_step(imp_springs *s);
/* Nothing presses: to the next closing; false: there is none. */
bool imp_springs_drift(imp_springs *s);
/* u = u0 + W p */
void imp_springs_find_velocities(imp_springs *s);

/* ---- springs_linear.c ---- */

/* Of a group whose springs are linear, without friction at any contact; group->w is not looked at. IMPACT_OK;
 * IMPACT_EUNSETTLED: too long, imp_springs_solve will say why; IMPACT_ENOMEM. */
impact_status imp_springs_solve_linear(imp_group *group, impact_together_workspace *workspace);

/* ---- springs.c ---- */

/* IMPACT_OK, IMPACT_EUNSETTLED, IMPACT_ENOMEM. */
impact_status imp_springs_solve(imp_group *group, double exponent, impact_together_workspace *workspace);

#endif
