/* SPDX-License-Identifier: MIT
 *
 * gap_solver (internal): the gap of two bodies with forms, in scaled units, and the ways to it.
 *
 * Body A is the public body 2 and body B the public body 1, so that the normal from A to B is the public one.
 * For every unit n, g(n) = n.c - h_A(n) - h_B(-n) is a lower bound of the gap, and the gap is its maximum.
 */
#ifndef IMP_GAP_SOLVER_H
#define IMP_GAP_SOLVER_H

#include <impact/toi.h>
#include "shape/support.h"

typedef struct imp_gap_solids {
    imp_form form[2];
    double c[3];  /* centre of B minus centre of A, world axes */
    double size;  /* largest semi-axis of both */
    double reach; /* size + |c| */
} imp_gap_solids;

typedef struct imp_gap_bracket {
    double gap;
    double n[3];         /* unit, A to B */
    double x[2][3];      /* witness points relative to the centres, world axes */
    double stiffness;    /* smallest eigenvalue of H_A + H_B + gap I across n */
    double lower, upper; /* bracket of the gap; upper is certain for separated bodies only */
    bool shares;         /* the bodies are seen to have a point in common, or gap >= 0 */
} imp_gap_bracket;

/* Whether impact_gap takes the bodies; their orientations, normalised. */
impact_status imp_gap_check(const impact_solid *body1, quat *q1, const impact_solid *body2, quat *q2);

/* What lengths are multiplied by for the largest semi-axis to lie in [1, 2); the pair so scaled of two bodies with unit
 * orientations; and a meeting of it as a contact of theirs. */
double imp_gap_scale(const impact_solid *body1, const impact_solid *body2);
void imp_gap_pair(const impact_solid *body1, quat q1, const impact_solid *body2, quat q2, double scale,
                  imp_gap_solids *pair);
void imp_gap_apart(qvec3 c, double scale, imp_gap_solids *pair); /* moves its bodies c apart */
void imp_gap_contact(const impact_solid *body1, const impact_solid *body2, double scale, const imp_gap_bracket *meeting,
                     impact_gap_path path, impact_contact *contact);

/* A normal to begin with: that of ellipsoids in the bodies' stead; of two bodies, no planes, with unit orientations. */
void imp_gap_seed(const imp_gap_solids *pair, double n[3]);
qvec3 imp_gap_guess(const impact_solid *body1, const impact_solid *body2);

/* g(n), n unit; x (NULL: not wanted) are the support points. */
double imp_pair_gap(const imp_gap_solids *pair, const double n[3], double x[2][3]);

/* Mixed primal/dual Newton from the unit seed n, and from points near the witness points (x; NULL: the support points):
 * true when it settled on the global maximum of g (gap >= 0) or on a local one; *meeting is then the answer. A negative
 * local maximum may be of bodies that are apart, unless it shares, or is proved the highest. */
bool imp_gap_newton(const imp_gap_solids *pair, const double n[3], const double (*x)[3], imp_gap_bracket *meeting);

/* The same from surface points that face each other, as they are. */
bool imp_gap_newton_at(const imp_gap_solids *pair, const imp_surface at[2], imp_gap_bracket *meeting);

/* Two moving bodies at one time. */
typedef struct imp_gap_moved {
    impact_solid body[2]; /* orientations unit */
    qvec3 v, omega[2];    /* of body 1's centre less that of body 2's; of both */
} imp_gap_moved;

/* Two bodies that move, as Newton for their contact in time sees them. */
typedef struct imp_gap_course {
    void (*at)(const void *of, double t, imp_gap_moved *moved);
    const void *of;
    double longest; /* no step in time is longer, s */
} imp_gap_course;

/* Newton for a time in [low, high] at which two bodies, no plane among them, come into contact, from *t in there and
 * the normal n: true when it settled on one to rounding, but not always the first; *t, and the contact then. */
bool imp_gap_strike(const imp_gap_course *course, double low, double high, qvec3 n, double *t, impact_contact *contact);

/* The same with the other body first. */
impact_contact imp_contact_swapped(impact_contact c);

typedef enum imp_simplex_end { IMP_SIMPLEX_APART, IMP_SIMPLEX_OVERLAP } imp_simplex_end;

/* Distance of the bodies shrunk by the factor shrink, from the unit seed n, until the bracket is within tolerance of
 * size + distance, or for so many steps. n: the best normal met; x: the nearest points, on the bodies' own scale and
 * relative to their centres; *lower, *upper: the bracket of the shrunk bodies' distance. */
imp_simplex_end imp_gap_simplex(const imp_gap_solids *pair, double shrink, double tolerance, int steps, double n[3],
                                double x[2][3], double *lower, double *upper);

/* What gjk.c gives: the two functions below where there is libccd. */
typedef struct imp_gap_ccd {
    bool (*harvest)(const imp_gap_solids *pair, double n[3]);
    bool (*epa)(const imp_gap_solids *pair, double rho, const double first[3], double tolerance, double *depth,
                double n[3]);
} imp_gap_ccd;

/* libccd's way: the normal with the largest g among all the directions that its intersection test asks for.
 * False when there is no libccd (base/parts.h) or nothing was met. */
bool imp_gap_harvest(const imp_gap_solids *pair, double n[3]);

/* libccd's own answer: the depth of the origin in the difference c + B - A, inflated by a ball of radius rho, and the
 * normal n from A to B that leads out. first: the direction to begin with; tolerance: of a length. False: it has none,
 * or was at its end of support calls.
 */
bool imp_gap_epa(const imp_gap_solids *pair, double rho, const double first[3], double tolerance, double *depth,
                 double n[3]);

/* impact_gap_ccd of two bodies without a closed form, with unit orientations. */
impact_status imp_gap_by_ccd(const impact_solid *body1, quat q1, const impact_solid *body2, quat q2, double tolerance,
                             impact_contact *contact);

/* Points of the bodies' difference c + B - A, at peaks n of g: there g(n) n is one, but for rounding. asked: for how
 * many Newton was. */
enum { IMP_MOST_PEAKS = 32 };
typedef struct imp_gap_peaks {
    int count, asked;
    double v[IMP_MOST_PEAKS][3];
} imp_gap_peaks;

void imp_gap_peak_add(const double v[3], imp_gap_peaks *peaks);

/* Whether g is nowhere more than *gap + slack, *gap <= 0 being g(n); peaks: one at least, more may be found. Against:
 * it is, and *gap and n tell where; climb: they are followed to the highest instead. Open: neither was found in a
 * bounded number of steps. */
typedef enum imp_proof { IMP_PROOF_NEAREST, IMP_PROOF_AGAINST, IMP_PROOF_OPEN } imp_proof;

imp_proof imp_gap_prove(const imp_gap_solids *pair, imp_gap_peaks *peaks, double slack, bool climb, double *gap,
                        double n[3]);

/* Whether one body is a polytope with edges and the other a cylinder or cone; and then, of two that share a point, the
 * highest g but for the slack, by their features, where it is more than *gap by that. */
typedef struct imp_way_out {
    double gap, n[3];
    bool all;          /* no g is higher but for the slack: the work allowed was enough */
    bool placed;       /* at: points of both on the features that face each other */
    imp_surface at[2]; /* as the pair's bodies are */
} imp_way_out;

bool imp_gap_has_arcs(const imp_gap_solids *pair);
/* Whether one was found; all is told anyway. */
bool imp_gap_highest_by_arcs(const imp_gap_solids *pair, double slack, double gap, imp_way_out *way_out);

/* How far x (world, relative to the centre) is outside the body, to first order; negative inside. */
double imp_gap_outside(const imp_form *form, const double x[3]);
/* Whether it is so by no more than slack > 0; a NaN is not. */
bool imp_gap_holds(const imp_form *form, const double x[3], double slack);

/* All the ways in order, from a cached normal (NULL: none). */
impact_status imp_gap_settle(const imp_gap_solids *pair, const double *cached, imp_gap_bracket *meeting,
                             impact_gap_path *path);

/* Only the cheap ways: false when they do not settle. An overlap's answer is then any local one. */
bool imp_gap_first(const imp_gap_solids *pair, const double *cached, imp_gap_bracket *meeting, impact_gap_path *path);

/* impact_gap for callers that want but the sign of an overlap: its answer is any local one (IMPACT_OK), and what the
 * cheap ways do not settle is IMPACT_BRACKET with no contact filled. */
impact_status imp_gap_glance(const impact_solid *body1, const impact_solid *body2, impact_gap_cache *cache,
                             impact_contact *contact);

#endif
