/* SPDX-License-Identifier: MIT
 *
 * Every threshold of the library, with its unit, its reason and what it is derived from. eps is the unit in the last
 * place of 1 (2^-52; of the second precision, 2^-112).
 */
#ifndef IMP_TOLERANCES_H
#define IMP_TOLERANCES_H

/* ---- collide: the range an impact is taken in, docs/collide.md ---- */

/* Numbers in units of the reduced mass, the longest arm and the fastest velocity: products of three stay within
 * 1e+-308.
 */
#define IMP_COLLIDE_RANGE 1e100
/* Largest over smallest moment of one body: J^-1/2 spreads over 1e6, and its squares still meet in one sum. */
#define IMP_COLLIDE_MOMENTS_APART 1e12
/* Larger over smaller mass: 1/eps, beyond which the larger takes no part in any sum. */
#define IMP_COLLIDE_MASSES_APART 1e16
/* Masses, moments, arms and velocities within this power, and an approach above the second (their units' cube), are in
 * range whatever the units: no need to look closer. */
#define IMP_COLLIDE_ORDINARY 1e20
#define IMP_COLLIDE_ORDINARY_APPROACH 1e-60

/* ---- collide: the solvers ---- */

/* Largest over smallest moment from which a body is slim: 3 bits of its arm are at stake in J^-1/2 r. */
#define IMP_COLLIDE_SLIM 8
/* |M| |M^-1| / 3 from which the impulse's rounding is felt in u: half of the 30 eps that an answer may be off. */
#define IMP_COLLIDE_UNEVEN 16
/* Units of eps: a sliding direction turns by no more than rounding of its rate's terms (nine of them). */
#define IMP_COLLIDE_STRAIGHT 9
/* sigma: 22 terms of e^sigma hold 2^-60 to 1.4; further than this the last coefficients, which may vanish, are not
 * believed. */
#define IMP_COLLIDE_FARTHEST 4

/* Relative, of the integrator that is made where none is given: about what Adams' method reaches. */
#define IMP_COLLIDE_CVODE_FINEST 1e-12

/* Steps of the integrator in one impact: ten times what the longest of the benchmark takes at 1e-14. */
#define IMP_COLLIDE_CVODE_STEPS 20000

/* ---- collide: receipts ---- */

/* eps: the worst that a receipt may show. Right answers leave 100 at most, but for some of stiff laws (a root of the
 * work where u_n is steep), 500; what is wrong by 2e-12 or more fails. */
#define IMP_COLLIDE_RECEIPT 1e4
/* Times a receipt's energy: that may rise by 100 eps of its terms, of which right answers of ordinary bodies show 11.
 */
#define IMP_COLLIDE_ENERGY 100
/* Conditioning up to which a closed form is looked at briefly: a tenth of the above, so that rounding cannot reach it.
 */
#define IMP_COLLIDE_BRIEF 1e3

/* ---- contact: the cone problem, docs/cone.md ---- */

/* The residual of what is solved: some 450 eps of the largest reaction and velocity. W itself is rounded, in sums of as
 * many terms as bodies' coordinates; the worst of 70 000 made problems is 2e-14. */
#define IMP_CONE_ACCEPTED 1e-13
/* The residual up to which an answer is told as inexact: above it modes, not digits, are wrong. */
#define IMP_CONE_USABLE 1e-6
/* |F| without units at which Newton's steps end: 4 eps, x and y being of order 1. */
#define IMP_CONE_FINEST 1e-15
/* e where the path ends: x and y that differ by less than its square, 1e-20, are modes that no rounding tells apart. */
#define IMP_CONE_PATH_END 1e-10
/* |F| up to this part of e is the path: x and y are of order e where modes are not told apart yet. */
#define IMP_CONE_NEAR 0.1
/* e below which a step that fails shows rounding, not a fold: the matrix' condition is 1/e^2, 1e12. */
#define IMP_CONE_ARC_LEAST 1e-6
/* Ratio of e's steps from which the path is said to turn: 44 steps for two decades. */
#define IMP_CONE_SLOW 0.9
/* The least step by arc length, of a contact's size: a path that creeps more is left. */
#define IMP_CONE_CREEP 1e-6
/* Alpha of A + alpha 1, A's diagonal being 1 in the mean: contacts hardly feel each other. */
#define IMP_CONE_EASING 20
/* The same of the problem that shows a direction of no solution: its answer grows to 1/shift along it, and is off it by
 * as little. */
#define IMP_CONE_SHIFT 1e-10
/* Q/d: where a solution's reactions would have to exceed this there is none: W d is then rounding. */
#define IMP_CONE_EXCLUDING 1e8

/* ---- contact: the proof of rest, docs/cone.md ---- */

/* What may be left of a body's load and reactions, of the sum of their sizes: some 450 eps of sums of as many terms. */
#define IMP_REST_BALANCED 1e-13
/* The residual from which the forces themselves are corrected: Newton's next step squares it. */
#define IMP_REST_NEAR 1e-8
/* Of its greatest element, added to the Hessian's diagonal: its rounding. */
#define IMP_REST_SHIFT 1e-13
/* Of the load's size: reactions larger than this are none. A slope of mu (1 + 1e-6) shows 1e9 and more. */
#define IMP_REST_EXCLUDING 1e6

/* ---- keys of a recorded run (motion/key.c) ---- */

/* rad: a body turns less than this from key to key. One turned further could meet a polynomial at the three places
 * where both are compared by chance; a quintic that keeps 1e-6 rad turns less than this anyway (h^6 (w/2)^6 / 46080 at
 * w h = 1 is 3e-7), so that no finer tolerance pays for it. */
#define IMP_KEY_TURN 1.0

/* Roundings of a coordinate that a key's place may be off by: the polynomial is a sum of six products. */
#define IMP_KEY_ROUNDINGS 8.0

/* Halvings of one piece of motion at most: its length then is below its own rounding. */
#define IMP_KEY_HALVINGS 40

/* ulp of t: keys closer than this are not halved further. The rates' parts of the polynomial are of the order of
 * s = (t - t0)/h, whose error is an ulp of t over h: 1/64 in the worst case. */
#define IMP_KEY_ULPS 64.0

/* ---- rows of a recorded run for display (scene/scene_keys.c) ---- */

/* Part of the force, of the body's radius and of a unit normal that a held contact may change by between two rows: a
 * pixel in a picture of 100 pixels. */
#define IMP_HELD_CHANGE 0.01

/* Rows of the account, and of a held contact, in a run's time at most, but for those beside events: with straight lines
 * between, a curve 300 pixels wide is off by less than one (1/(8 n^2) of its second rate). */
#define IMP_DISPLAY_ROWS 48.0

/* ---- an opened run (run/run_read.c) ---- */

/* No number in it is larger, so that a quintic's products h^2 f'' stay finite for h up to 1e4 s. */
#define IMP_RUN_LARGEST 1e150

/* Orientations are written as the motion normalised them, to a few roundings; what is off by more is damage. */
#define IMP_RUN_UNIT 1e-9
/* ---- motion: piles that are stepped, docs/cone.md ---- */

/* Of the smallest body's radius: gaps up to this are closed, a tenth of a step's error. Where contacts are more than
 * motions overlaps that are put back leave gaps elsewhere: taken as open those bodies would fall and be caught for
 * ever.
 */
#define IMP_PILE_SLACK 1e-6
/* Of the smallest body's radius: what one step and its two halves may differ by. */
#define IMP_PILE_ERROR 1e-5
/* Steps in units of the time in which the smallest body falls its radius: the first; the longest, in which contacts
 * turn by less than .05; and the shortest, in which a fall is 1e-10 of the radius. */
#define IMP_PILE_FIRST 1e-2
#define IMP_PILE_LONGEST 5e-2
#define IMP_PILE_SHORTEST 1e-5
/* Steps of the integrator, with bodies held on each other, for the time in which the smallest falls its radius: more is
 * a pile that does not get on. With 1000 two ellipsoids that settle on each other, and balls that roll about in a box,
 * are stepped too, which the exact motion brings to their end. */
#define IMP_PILE_PATIENCE 4000

#endif
