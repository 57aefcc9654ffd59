/* SPDX-License-Identifier: MIT
 *
 * Every threshold of the library, with its unit, its reason and what it is derived from. eps is the unit in the last
 * place of 1 (2^-52; of the second precision, 2^-112). A scene's `tolerance` is not among them: it sets how closely the
 * integrator goes, and decides nothing.
 */
#ifndef IMP_TOLERANCES_H
#define IMP_TOLERANCES_H

/* Unit roundoff of double: what one operation errs by, relative. */
#define IMP_ROUNDOFF 0x1p-53
/* Added to what divides and may be 0: no number that is not below 1e-284 is changed by it. */
#define IMP_NOT_ZERO 1e-300
/* Of what its slope promises: a step along which a function falls by less is halved (Armijo 1966; Dennis, Schnabel
 * 1983). */
#define IMP_ARMIJO 1e-4

/* Bytes of a definition at most: ten times the largest there is. A size beyond it was never set, and is not read. */
#define IMP_MOST_DEFINITION 4096

/* ---- what a definition may give, and gives by itself ---- */

/* tolerance and key_tolerance: what doubles hold, and two digits. Without one the integrator errs by less than what
 * tells slip from none (IMP_SLIDING_TOLERANCE). */
#define IMP_LEAST_TOLERANCE 1e-15
#define IMP_MOST_TOLERANCE 1e-2
#define IMP_DEFAULT_TOLERANCE 1e-13
/* Of a key's place, without one: of a body of 1 m an atom's diameter. A finer one than the least is its rounding. */
#define IMP_LEAST_KEY_TOLERANCE 1e-14
#define IMP_DEFAULT_KEY_TOLERANCE 1e-10
/* Of the smallest radius, what a step of a pile may err: a tenth of what a picture shows. A tenth of it asks for two
 * and a half times the work of twenty falling dominoes, whose end is told as half as uncertain: motions part (bench
 * piles). And the least: where the shortest step falls its radius's 1e-18, two roundings of a millimetre in a metre. */
#define IMP_DEFAULT_PILE_TOLERANCE 1e-3
#define IMP_LEAST_PILE_TOLERANCE 1e-9
/* m, of a bounce, and m/s: what no eye and no instrument sees of bodies of centimetres to metres, and doubles hold to
 * three digits in gaps of 1 m. */
#define IMP_DEFAULT_REST_HEIGHT 1e-12
#define IMP_DEFAULT_REST_SPEED 1e-9
/* Samples of a run: each then has its own number in a double. */
#define IMP_MOST_SAMPLES 1e15
/* Of the other two moments' sum: a flat body's largest is that sum, to some roundings of the formula it is from. */
#define IMP_MOMENTS_TOGETHER 1e-12
/* Of the first moment: three that differ by less are a sphere's, but for the rounding of what they were computed by. */
#define IMP_ALIKE_MOMENTS 1e-14
/* J: sums of 1e8 such energies are finite. */
#define IMP_MOST_ENERGY 1e300
/* m^3/(kg s^2), the constant of gravitation (CODATA 2018). */
#define IMP_NEWTONIAN_CONSTANT 6.67430e-11

/* ---- places ---- */

/* A gap along the normal n of bodies at x1, x2 with bounding radii r1, r2 is made of numbers as large as
 * sum_k |n_k| (|x1_k| + |x2_k|) + r1 + r2, m (imp_world_place_scale), and rounds by about 4 units of it. Two contacts
 * that come in one instant are found in places that differ by a thousand times that: their bodies got there by
 * a thousand steps, each rounded. Gaps below this part of the scale touch. */
#define IMP_TOUCHING (4096 * IMP_ROUNDOFF)
/* Gaps below this part of the scale cannot be told from 0: what comes nearer has come. */
#define IMP_GAP_ROUNDING (2 * IMP_ROUNDOFF)
/* Bodies may overlap by this part of the scale at the start: places are given by hand, to nine digits. */
#define IMP_OVERLAP_AT_START 1e-9

/* ---- shapes with faces, docs/faces.md ---- */

/* Of the products' sum: what a sign of an orientation's determinant may be off by, (7 + 56 eps) eps/2 (Shewchuk 1997).
 */
#define IMP_ORIENTATION_BOUND ((7 + 112 * IMP_ROUNDOFF) * IMP_ROUNDOFF)
/* Of the distance of a hull's farthest corner: corners given in doubles lie in their plane to some roundings of their
 * coordinates, three each, and those of a pattern that was turned or divided to a dozen. */
#define IMP_HULL_FLAT (64 * IMP_ROUNDOFF)
/* Of a hull's size, and of its second moments: a centroid and axes off by less are sums' rounding. */
#define IMP_HULL_FRAME (64 * IMP_ROUNDOFF)
/* Of a core's size: vertices whose heights differ by less are reached together: three products and two sums each. */
#define IMP_CORE_TIE (8 * IMP_ROUNDOFF)
/* Jacobi's sweeps of a 3 by 3 matrix: it converges quadratically, in four or five. */
#define IMP_HULL_SWEEPS 12

/* ---- supports ---- */

/* An exponent that is over 1 by less than this has an edge there: u = exp(x/(p - 1)), and x, which rounds by 2e-16,
 * leaves u no digit. */
#define IMP_SHARP_EXPONENT 1e-14
/* The last step in the logarithm of a support's multiplier, relative: Halley's leaves its cube. */
#define IMP_MULTIPLIER_STEP 1e-10

/* ---- gap of polytopes, docs/faces.md ---- */

/* Of the reach: what distance and dual bound may differ by, 18 u; the first answers of nearly parallel pairs that miss
 * it (1.4 %) are found again by all features. */
#define IMP_CORE_ACCEPTED 4e-15
/* The squared sine of edges' angle down to which their nearest points are found in one go, off by eps over it. */
#define IMP_CORE_CROSSING 0.1
/* Of the reach: a distance under this may be an overlap's rounding: then the facets are asked as well. */
#define IMP_CORE_TOUCHING 1e-13
/* Of the reach and the distance: the next tip is no nearer than this: rounding of its products. */
#define IMP_CORE_CLOSED (4 * IMP_ROUNDOFF)
/* Sine: ends of an arc on another's circle to this, rounding of unit normals and edges; a crossing that is then missed
 * costs as much of the size. */
#define IMP_CORE_ARC (64 * IMP_ROUNDOFF)
/* Simplices on the way to the nearest point; each is of new vertices and nearer, of a box met after 5 in the mean. */
#define IMP_CORE_STEPS 100
/* Of the reach: heights of a face's corners along its own normal, and the widest that a normal of nearly parallel edges
 * leaves. */
#define IMP_CORE_LEVEL (4 * IMP_ROUNDOFF)
#define IMP_CORE_LEVEL_MOST 1e-12

/* Of a body's size: a point so near a face is taken to be on it where a walk begins: what simplices leave. */
#define IMP_WALK_START 1e-6

/* Of the reach: a point in a core, but for rounding. */
#define IMP_WALK_INSIDE (32 * IMP_ROUNDOFF)

/* ---- gap of superquadrics, docs/gap.md ---- */

/* |q|^2 - 1 of a quaternion that is taken as it comes: two eps, what a product of two unit ones leaves. */
#define IMP_UNIT_AS_IT_COMES 4.5e-16
/* Of sum u e = 1 on a surface: what the others must leave the coordinate that is solved for, which is the heaviest and
 * has a third where they are alike; and what it is given where a walk begins outside. */
#define IMP_CHART_PIVOT 1e-3
#define IMP_CHART_START 0.01
/* Of a semi-axis, exponent 1: a point nearer to the plane across it is on the edge there, u = 0: the root of eps. */
#define IMP_CHART_FACE 1e-7
/* Pivots of Newton's matrix, of the largest: rounding (50 eps) is none; and without pivoting in columns, in units of
 * the largest step: six digits may be lost, and the next step mends them. */
#define IMP_GAP_RANK 1e-14
#define IMP_GAP_PIVOT 1e-6
/* |n_A - n_B| of the outward normals, 2 where they are opposite: with less no face lies between the bodies. */
#define IMP_GAP_FACING 0.2
/* A step of u and e at most, of 1: charts change there. */
#define IMP_GAP_STEP 0.5
/* Over the pair's size: curvature that is lent to a flat place, so that a step stays within a thousand sizes; and of
 * the terms of det Q: what is one. */
#define IMP_GAP_LEAST_CURVATURE 1e-3
#define IMP_GAP_FLAT 1e-6
/* Newton's steps, of the halves u and e that move, converge quadratically: after one smaller than this the next, about
 * its square, is below rounding. */
#define IMP_GAP_LAST_STEP 1e-10
/* A last step under this converges: a few more are worth it. */
#define IMP_GAP_CONVERGING 1e-2
/* Of the reach: a bracket that cannot be narrower, 4 eps; and the one that is promised, 100 eps. */
#define IMP_GAP_TIGHT 1e-15
#define IMP_GAP_CLOSED 2e-14
/* Of the level function f, whose terms are powers: 18 eps times the exponent, of a size. */
#define IMP_GAP_INSIDE 4e-15
/* Of the reach: how far witness points may lie outside their bodies: 20 eps; right answers of all families stay below
 * 4. */
#define IMP_GAP_OUTSIDE 4.4e-15
/* Of the size: curvatures' sum that is 0 but for rounding at an overlap's maximum. */
#define IMP_GAP_STIFFNESS 1e-12
/* Deeper than this part of the smallest semi-axis, or of the smallest radius of both surfaces together at the contact,
 * an overlap may have several local answers. */
#define IMP_GAP_DEEP 0.05
/* Of the reach: an overlap that is rounding, and needs no proof. */
#define IMP_GAP_SHALLOW 1e-13
/* Of the reach: how far apart bodies are drawn for their normal, which is then off by this part of what it was. */
#define IMP_GAP_PARTED 1e-8
/* Of the size, how far apart bodies with faces are drawn for the points that Newton starts from, and how closely these
 * are found: to rounding, as faces in touch may lean by no more. */
#define IMP_GAP_APART 0.3
#define IMP_GAP_APART_CLOSED 1e-15
/* Below this exponent a body has edges; two such bodies may overlap shallowly in more than one way. */
#define IMP_GAP_SHARP 1.3
/* Of the reach, what a proof that there is no nearer way out leaves: half of the bracket that is promised. Of the depth
 * and of the size, what it leaves where that cannot be had (a ring of ways out, alike but for rounding). */
#define IMP_GAP_SLACK 1e-14
#define IMP_GAP_COARSE_DEPTH 5e-3
#define IMP_GAP_COARSE_SIZE 1e-3
/* How many times the depth a rim may bend g by where its sinusoids are asked (gap_arcs.c): with much more, what g is
 * made of is lost in their rounding. */
#define IMP_GAP_BENDS 2
/* Of the reach, and of the depth at most: a middle so near the bound is within 1e-3 rad of a peak, where Newton
 * converges; and of the cosine: as near to a known peak it is not asked again. */
#define IMP_GAP_NEAR_PEAK 1e-6
#define IMP_GAP_PEAK_OF_DEPTH 0.01
#define IMP_GAP_SAME_PEAK 1e-4
/* Of the largest semi-axis: the least of the ellipsoid that a body is taken for to begin with. */
#define IMP_GAP_SEED_AXIS 1e-3
/* Of the distance: how closely simplices find it before Newton is tried from there, each time; and of the sizes: bodies
 * that overlap are made smaller until they are apart. */
#define IMP_GAP_SIMPLEX_STAGES 1e-2, 1e-4, 1e-7, 1e-11
#define IMP_GAP_SHRINKING 1, 0.99, 0.9, 0.7, 0.45, 0.2, 0.05
/* Of the size: a simplex so near the origin holds it. */
#define IMP_SIMPLEX_OVERLAPS 1e-12
/* rad: the shortest step up a slope of g that is flat but for rounding; the directions about a normal that show the
 * midst of what it touches. */
#define IMP_GAP_SLOPE_STEP 1e-7
#define IMP_GAP_LEAST_LEAN 1e-10
#define IMP_GAP_MOST_LEAN 0.1
/* Of the size: bodies on their way whose surfaces are so near are near contact. */
#define IMP_STRIKE_NEAR 1e-2
/* The largest exponent of a superquadric: its edges are then 1e-6 of its size wide, and u^(p - 1) spans double's range.
 */
#define IMP_MOST_EXPONENT 1e6
/* How far over 1 a body's exponent lies at least, but where it is 1: its dual is then at most 1e6 too. Nearer to 1 what
 * rolls on its nearly flat sides rocks at 1/sqrt(p - 1) times its own rate, and rounding leaves eps/(p - 1) of where it
 * touches: below 1e-7 a scene's steps were of 1e-10 s. */
#define IMP_LEAST_OVER_ONE 1e-6
/* Of 1: a component of a direction at which the surface's flat place gives way to its neighbourhood, where radii of
 * curvature are finite. */
#define IMP_OFF_FLAT 1e-9
/* A flat point's slope, which is 0: a contact passes it before any time goes by; a last Newton's step, relative; and a
 * bend whose inverse is no part of a sum any more. */
#define IMP_SPOT_LEAST_SLOPE 1e-200
#define IMP_SPOT_STEP 1e-16
#define IMP_SPOT_MOST_BENT 1e100

/* ---- patches, docs/faces.md ---- */

/* |d| - 1 of a direction that is taken for unit: a normal of a gap, turned twice. */
#define IMP_FACE_UNIT 1e-9
/* The least exponent along a superquadric's face for its flat place to be one: within 1e-12 of a side it is 1e-4 of it
 * wide for 3, and 1e-6, as on a ball, for 2. */
#define IMP_FLAT_EXPONENT 3
/* Of the bodies' distance and size: places of corners in the plane of a patch, three products and sums each. */
#define IMP_PATCH_BORDER (16 * IMP_ROUNDOFF)
/* Of the area that a corner of a patch costs: what is less apart is so by rounding. A disc's 64 places cost
 * (2 pi/64)^3/2 of its radius squared each, which places are rounded to 1e-12 of. */
#define IMP_FLAT_ALIKE 1e-9

/* A plane whose slope is less than this is level, and directions that differ by less are one line: of a ball that has
 * slid through hundreds of turns, each put back on its plane with a few roundings; and as closely as slip is integrated
 * (IMP_SLIDING_TOLERANCE). */
#define IMP_LEVEL (1024 * IMP_ROUNDOFF)

/* ---- speeds ---- */

/* Slip slower than this part of the rest speed, m/s, is none: what ends as rest has stuck before, by a margin that the
 * last changes of mode on the way there do not fill. */
#define IMP_SLIP_OF_REST_SPEED 1e-2
/* Slip faster than this part of the slip scale turns no faster than the motion goes. */
#define IMP_SLIP_SLOW_OF_SCALE 1e-2
/* Of mu h omega, h the height that turning's friction has: a face's slip so near to a pivot's, where the friction just
 * suffices and goes on doing so, is the pivot's: sqrt(w^2 - (mu h omega)^2) of roundings of both is 1e-8 of them, and
 * integration adds two digits to that. */
#define IMP_FLAT_PIVOT 1e-6
/* A line's tipping: of the body's radius, the arm that is none; and of its speed, what slips across the line. */
#define IMP_LINE_TIGHT 1e-9
#define IMP_LINE_NOISE 1e-12
/* Slip that begins from rest is led by its acceleration up to so many times the slip speed. There the direction of slip
 * has come to within 1e-5 of that of its acceleration, and the stiffness of the direction, (friction
 * acceleration)/slip, is one that BDF follows. */
#define IMP_INCIPIENT_OF_SLIP_SPEED 1e5
/* A distance that opens no faster than this part of the motion's speed stays as it is: rates are differences of
 * velocities with the errors of a thousand steps. */
#define IMP_STILL_OF_SPEED 1e-9

/* ---- times ---- */

/* A force is asked so far inside its piece, of the switch's time: four operations of its own, each rounded, may tell on
 * which side it stands. */
#define IMP_SWITCH_ROUNDING (16 * IMP_ROUNDOFF)
/* max_step of a custom force that gives none, of the duration. */
#define IMP_MAX_STEP_OF_DURATION 1e-3
/* A body's radius over its speed bounds a step no more than this part of max_step does: a million steps in a run are
 * the most that is spent on looking. */
#define IMP_LEAST_OF_MAX_STEP 1e-3
/* Events of one body at one instant, for itself and for each pair that it may meet: the pair is met, held, slides and
 * is let go, each for the sake of two others and once more as those answer. No scene of the tests has more than three.
 */
#define IMP_EVENTS_AT_ONCE 12
/* Of the time left, what two million steps (motion_stretch.c) must gain: with less a run takes 2e12 of them. */
#define IMP_LEAST_GAIN 1e-6

/* ---- heights ---- */

/* Rocking on a face or along a line that lifts the body by fewer rest heights than this is lying: the rest height is
 * that of a bounce about a point, and of rocking the lift of the centre is the smaller part. */
#define IMP_LYING_OF_REST_HEIGHT 100

/* ---- the integrator ---- */

/* Sliding contacts are integrated at least this closely, whatever the scene's tolerance: slip is the difference of two
 * velocities of order 1 m/s and must be told from nothing at IMP_SLIP_OF_REST_SPEED of the default rest speed, 1e-11
 * m/s. A tolerance looser than this would decide between slip and stick. */
#define IMP_SLIDING_TOLERANCE 1e-13
/* Of a body's speed: slip slower than this, what steps of that tolerance come to, is none, whatever the rest speed: a
 * box of 500 m slid on where one of .5 m sticks. */
#define IMP_SLIP_TOLD (10 * IMP_SLIDING_TOLERANCE)
/* And so is a stretch that begins with a bounce: a flight of rest height, 1e-12 m, of a body of 1 m must come down
 * where it falls, or bounces die out never or too soon. */
#define IMP_BOUNCE_TOLERANCE 3e-12
/* Accelerations by forces under this, m/s^2, are none: over 1e10 s they do less than 1e-60 of the least absolute
 * tolerance, and their squares over it underflow. */
#define IMP_LEAST_ACCELERATION 1e-100
/* Of what an integrator's component passes zero by, over the relative tolerance. */
#define IMP_ABSOLUTE_OF_RELATIVE 1e-2
/* From one to this many of SI's units a body's size, speed and angular momentum are measured in those; smaller ones by
 * themselves, or the tolerance would be as great as they are; larger ones too, or where they pass through 0 rounding
 * counts as error: that of 1e3 is the default tolerance of 1. */
#define IMP_ORDINARY_SIZE 1e3
/* Steps in flight are many and their errors add up, over a thousand seconds to ten thousand times one's: what nothing
 * holds is integrated closer than asked by IMP_FLIGHT_OF_TOLERANCE, and down to what doubles hold. */
#define IMP_FLIGHT_OF_TOLERANCE 0.03
/* And what is held: of a ball that rolls for 6 s at 30 rad/s (examples/scenes/turntable.lua) the turn is 2.5e-8 off at
 * 1e-13 in 20 900 steps, 9e-10 at 3e-14 in 22 600. */
#define IMP_HELD_OF_TOLERANCE 0.3
#define IMP_FLIGHT_TOLERANCE 1e-15
/* A step's defect between its ends, over the error allowed in it, beyond which a custom force did there what the step
 * did not see. Of smooth forces Adams' polynomials of order 12 show up to a few hundred; a pulse that the step missed
 * shows its whole impulse, 1e10 and more. */
#define IMP_DEFECT 1e4
/* Contact forces pull, or leave their cone, where they do so by more than this part of the greatest of them: they are
 * the solutions of linear systems with conditions up to 1e4. */
#define IMP_MODE_ROUNDING 1e-12
/* Of the largest acceleration: what Coulomb's law in accelerations has along the slip of what slides on. Its direction
 * is then off by 1e-4, of which each of two rounds of correction leaves 1e-4; accelerations round by 1e4 eps. */
#define IMP_MODES_FAR 1e4
/* Slip that was to begin goes on where the friction needed over what there is passes 1 by more than this: it is the
 * outcome of Newton's iteration in the direction, which is left at this. */
#define IMP_HOLD_ROUNDING 1e-9
/* Of what is asked of held contacts: what reactions may leave. Modes that nothing can hold left 2e-2 to all of it where
 * they were met; regular systems, as they come near to such a one, up to 4.5e-7 (random scene 20422). */
#define IMP_UNMET 1e-6
/* What contacts yield by where pressures balance that no load makes, of what their own forces move: over what the
 * modes' residuals leave (1e-12 of IMP_MODES_FAR), and under what would tell in them. */
#define IMP_YIELDS 1e-6
/* A pair that is open is pressed where the loads' part of its acceleration towards the body is more than this: what the
 * reactions of others balance leaves less. */
#define IMP_PRESSED_OF_LOADS 1e-9
/* Of the greatest element: a pivot of the contacts' linear system that is none: 4000 eps, of conditions up to 1e4. */
#define IMP_LINEAR_VANISHING 1e-12
/* The same of pivots taken by columns, beyond which the next ones, whose rounding is eps over this, tell of no rank. */
#define IMP_LINEAR_DOUBTFUL 1e-7
/* Newton's step of a secular equation's multiplier, relative: half an eps. */
#define IMP_SECULAR_STEP 1e-16
/* rad: directions of slip that begins have come to rest where none turns by 4 eps; what Newton's linear step leaves of
 * them, its square; and what it leaves where it leads nowhere. */
#define IMP_ONSET_TURNED 1e-15
#define IMP_ONSET_LEFT 1e-16
#define IMP_ONSET_FAR 1e3
/* What bodies at rest have, of the island's loads: acceleration that is none; and what is none by the law, whose
 * reactions of 1e10 times the loads and more leave as many roundings. And of a reaction that is remembered, what leaves
 * its cone by rounding, 450 eps. */
#define IMP_STILL_BALANCED 1e-10
#define IMP_STILL_HELD 1e-4
#define IMP_STILL_SETTLED 1e-13
/* No surface that presses is rounder than this part of its body's size: about edges the normal turns faster, but not
 * for long. */
#define IMP_ROUNDEST_PRESS 1e-3
/* Of its spare, as the root that told of it leaves it: a body on a face whose centre of pressure has come to the
 * border. */
#define IMP_SPARE_SPENT 1e-6
/* A loss that falls in a step by more than so many of the errors allowed in it falls in earnest. */
#define IMP_LOSS_ERRORS 1e3
/* So many steps without a fall later what fell is over, and the next fall is looked at anew: about a restart's. */
#define IMP_TRUSTED_STEPS 100
/* Steps that are shorter than this in the mean over 1e5, in parts of t, are stuck. Near a pole of a force, where t is
 * subtracted from a constant, the error test then sees t's rounding over the step: 1e-4. (Slip that dies out takes a
 * hundred such steps, and all contacts of a heap may stick and slip at almost one instant.) */
#define IMP_SHORTEST_STEP (8192 * IMP_ROUNDOFF)

/* Of the velocities that the integrator left at held contacts: what puts them back turns a body by more, its radius
 * long, only where contacts that hold one place but for 1e-3 of that radius are taken for two: a rim in the crease of
 * two planes lost its spin as it came by, by 4e-10 m/s of slip. */
#define IMP_PUT_BACK_BY 1e3

/* ---- a scene's receipt ---- */

/* Orientations are normalised where they are used, to two roundings; a flight's are products of two. */
#define IMP_RECEIPT_UNIT (16 * IMP_ROUNDOFF)
/* Held contacts are put back exactly at every event, to the gap's own error on bodies with edges. */
#define IMP_RECEIPT_GAP 1e-9
/* Reactions are asked for their cones to 1e-12 of the greatest where modes are chosen, and incipient slip to 1e-9. */
#define IMP_RECEIPT_CONTACT 1e-8
/* The account is a sum of as many terms as there are steps; 1e8 of them, each off by a rounding. */
#define IMP_RECEIPT_ENERGY 1e-8
/* Of an event's impulses and momenta: they are sums, some hundred roundings long in a pile; 1.4e-16 is the most that
 * random scenes show. */
#define IMP_RECEIPT_MOMENTUM 1e-12
/* And each off by the integrator's tolerance: a run has about as many steps in one direction of error. */
#define IMP_RECEIPT_ERRORS 1e3

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

/* Of the velocities' terms: slip that is their rounding, two eps, stands. */
#define IMP_COLLIDE_STANDS 0x1p-51
/* Of 113 bits, double's 53 are what remains of a conditioning of 2^60. */
#define IMP_COLLIDE_SECOND_SPREAD 0x1p-60
/* Of the first term: the last that a divided difference needs. */
#define IMP_COLLIDE_LAST_TERM 0x1p-56
/* Exponents beyond this are halved to nothing in double: NaN. */
#define IMP_COLLIDE_MOST_EXPONENT 0x1p1000
/* Of the impulse: the turning that is left of a slip taken as straight to its stop: in double, a hundredth of what is
 * asked of a sensitivity (1e-6); in 113 bits, with 18 digits of conditioning to lose, the same. */
#define IMP_COLLIDE_TAIL 0x1p-27
#define IMP_COLLIDE_TAIL_SECOND 0x1p-90
/* rad: and it is to turn by less than this on the way. */
#define IMP_COLLIDE_TAIL_TURN 0x1p-8

/* Relative tolerances of a workspace: Adams' method reaches the first; the second leaves two digits. */
#define IMP_COLLIDE_CVODE_LEAST 1e-14
#define IMP_COLLIDE_CVODE_MOST 1e-2
/* tau over the rate's inverse: a slip that has not ended by then ends nowhere. */
#define IMP_COLLIDE_CVODE_LONGEST 1e30
/* Of the speed at which slip has stopped: where slip from rest under a law of friction begins. */
#define IMP_COLLIDE_CVODE_ONSET 1e3

/* Relative, of the integrator that is made where none is given: about what Adams' method reaches. */
#define IMP_COLLIDE_CVODE_FINEST 1e-12

/* Steps of the integrator in one impact: ten times what the longest of the benchmark takes at 1e-14. */
#define IMP_COLLIDE_CVODE_STEPS 20000
/* And on a compliant contact, some 1.5 s: what a compliance of 1e-2 takes at most at 1e-14 in 360 random impacts. */
#define IMP_COLLIDE_COMPLIANT_STEPS 300000

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

/* ---- collide: impacts without approach ---- */

/* Of the speeds that u is a sum of: an approach that is none, 16 roundings, and that from which an impact without
 * approach is followed. What comes of it is off by that much. */
#define IMP_COLLIDE_SEED 0x1p-48

/* ---- collide: sensitivity ---- */

/* eps, of the terms of du_n/dp: below it is rounding of the data (a product of three and a sum, of two bodies), and
 * u_n only touches 0. */
#define IMP_COLLIDE_TIE 16
/* |M| |M^-1| / 3 from which derivatives are taken in 128 bits: in double eps times its square, 2e-4, is the most that
 * cancellation between the entries of M leaves (1e-6 was seen). */
#define IMP_COLLIDE_VARIED_IN_DOUBLE 1e6
/* Relative, where answers come to CVODE's tolerance, 1e-12: differences over this are derivatives to 1e-5, and a
 * quaternion changed by it is still taken for one of unit length (1e-6). */
#define IMP_COLLIDE_NUDGE 0x1p-22

/* ---- contact: stiff springs, docs/together.md; in units in which velocities and W are of order 1 ---- */

/* Of u, the last terms of a step's series: 1/64 eps, so that hundreds of steps err by a few eps together. */
#define IMP_SPRINGS_TRUNCATION 0x1p-58
/* The energy under which a spring counts as open. Met at a speed u it changes that by 2^-90/u, by less than eps down to
 * u = 1e-11; what grazes slower is off by 2^-45 at most. */
#define IMP_SPRINGS_ENERGY 0x1p-90
/* The same of a linear spring without friction, which is analytic: only told from 0. */
#define IMP_SPRINGS_ENERGY_LINEAR 0x1p-200
/* Of tiny: contacts that close or open within this part of it do so together, as they would but for rounding. */
#define IMP_SPRINGS_TOGETHER 1e-12
/* Of tiny: how far a contact is from it just as it closes or opens, so that only its return counts. */
#define IMP_SPRINGS_JUST 1e-3
/* Velocities that are none: 4 eps of the terms of u = u0 + W p, at least 1, which that leaves of a stop. */
#define IMP_SPRINGS_STILL 0x1p-50
/* Of that: slip that began together with others slides without them; and slip that could go on beside what sticks stops
 * under it, whatever that has drifted to. Stopped at rounding itself one of forty struck cubes creeps at 3e-15 for ever
 * (draw_struck_cube of test_encounter_random.c); at twice the drift, two that stop by turns were 1e-7 off. */
#define IMP_SPRINGS_TOLD 64
/* Of the depth of its turn: a spring is loaded on once it is deeper by more than rounding. */
#define IMP_SPRINGS_PAST (1 + 0x1p-50)
/* Slip slower than this is summed from its own steps, and may go straight to its stop where what it still turns by is
 * rounding. From u0 + W p it would have the rounding of W p anew at each step, and friction, which turns slip in the
 * time |u_t|/(mu lambda W), would answer each time: what creeps would never be seen to be slow. Of four random
 * encounters that spent all their work with 2^-26 three end with 2^-18 and all with 2^-12; 2^-7 leaves ten times the
 * residual. */
#define IMP_SPRINGS_SLOW 0x1p-12
/* Of its speed: slip that has slowed down to this has its turn as what leads time. The series of |u_t| has its branch
 * points where u_t . u_t vanishes; of slip that is all but straight they lie beside its stop, too weak to be felt by
 * its terms, and it would be taken through 0. */
#define IMP_SPRINGS_SLOWED 0.125
/* Of W: a response across a slip under this turns it by rounding only. W of a planar encounter that is turned in space
 * has a few eps, times the condition of what sticks. */
#define IMP_SPRINGS_STRAIGHT 0x1p-46
/* Velocity that a contact's friction could still make before it opens: a sixteenth of eps does nothing. */
#define IMP_SPRINGS_SPENT 0x1p-56
/* Rank of what sticks: of the largest pivot. W is rounded to eps, and pivots are its differences. */
#define IMP_SPRINGS_RANK 1e-11
/* Accelerations of slip that begins, of the largest: under it friction gives way by and by. The cone solver is good to
 * 1e-13 of that. */
#define IMP_SPRINGS_WEAK 1e-11
/* Of (mu lambda)^2: the margin that rounding leaves where slip is just held. */
#define IMP_SPRINGS_MARGIN 0x1p-48
/* Of mu lambda: friction that is smaller by this part of it holds, whatever a root of its margin says. A root that is
 * real is right to 1e-8, the square root of rounding, at the worst. */
#define IMP_SPRINGS_HELD 1e-6
/* Of mu lambda, where reactions are not unique: friction may be over its bound by so much before slip begins. It is so
 * for this part of the time that forces take to change, and the slip lags by the square of it, 1e-14; accelerations of
 * that size are told from the cone solver's 1e-13 to five digits. */
#define IMP_SPRINGS_OVER 1e-7
/* Slip that creeps: a step by powers covers less than this part of the time in which forces change, its own speed
 * changing by less than that part: a hundred such steps cost more than one of springs_creep.c. */
#define IMP_CREEP_STIFF 0.01
#define IMP_CREEP_CHANGE 0.1
/* Of the time in which forces change: a step. Their rounds then converge by a tenth each. */
#define IMP_CREEP_STEP 0.25
/* Steps by powers that it has to replace. */
#define IMP_CREEP_WORTH 16
/* Of accelerations: what Newton leaves; of forces: what the last round may have changed. */
#define IMP_CREEP_BALANCED 0x1p-49
#define IMP_CREEP_ROUNDING 0x1p-48
/* Of velocities: what a step's polynomials miss, by their last term, or the one before times what terms fall by. */
#define IMP_CREEP_ERROR 0x1p-48
#define IMP_CREEP_RATIO 0.1
/* Factor of T, and Newton's steps for each, of which a handful are taken. */
#define IMP_SPRINGS_TIGHTER 10
#define IMP_SPRINGS_CENTRE_STEPS 40
/* tau: further than this no step goes; where the last terms vanish they bound nothing. */
#define IMP_SPRINGS_FARTHEST 4.0
/* Of the time at which three terms have the next event: what later terms shift it by, mostly. */
#define IMP_LINEAR_AHEAD 1.0625
/* tau: 2^-58 over its power 22 is the least normal double; further on terms that matter are not held. */
#define IMP_SPRINGS_HELD_BY_DOUBLES 0x1p43
/* Gaps between bounces, in units of dents: from the first on they are taken so much smaller, which leaves dents nothing
 * beside them, as before. */
#define IMP_SPRINGS_FAR 0x1p600
#define IMP_SPRINGS_NEARER 0x1p-400
/* Radii of a power's series that a step goes: 5^22 eps is .5, of a force that is small where the radius is. */
#define IMP_SPRINGS_REACH 5
/* The least restitution of springs: what unloads is 1/eps times as stiff in time as what loads, and a pressed contact
 * then swings that much faster. Less counts as the first of these where steps and events do not take longer than
 * IMP_SPRINGS_TRIED, as where what turns opens at once, else as the second; what comes back is off by as much of the
 * approach, and told. The energy that comes back of the hardest is 2^-60, a hundred roundings of the spring's own under
 * which it counts as open. Of random encounters with restitutions under 1e-3 99 in a hundred of those that end do so
 * within 845; of what does not end by 2000 with the hardest two in a hundred do with 2^-20. */
#define IMP_SPRINGS_HARDEST 0x1p-30
#define IMP_SPRINGS_LEAST 1e-3
#define IMP_SPRINGS_TRIED 1000
/* Steps and events, or multiplications, by which what is spent is counted: more than all but a few take in all. After
 * the first part of that a group is asked whether it is wedged, and whenever it has spent twice as much: each question
 * costs a hundredth. From the last on what is not proved to be loose is taken for wedged. */
#define IMP_SPRINGS_LONG 4000
#define IMP_SPRINGS_MUCH 8e7
#define IMP_SPRINGS_ASKED 0.125
#define IMP_SPRINGS_ASKED_LAST 10
/* Extreme pressures that are tried, ten times as many as any random group needs. */
#define IMP_WEDGE_STEPS 1000
/* Of the largest |G^T r|^2, and of its rates: sums' rounding over as many steps, 2^-52 each, that goes and comes. */
#define IMP_WEDGE_BALANCED 0x1p-44
/* Of the same: the pivot under which extreme pressures are not told apart. */
#define IMP_WEDGE_ROUNDING 0x1p-50
/* Of what springs hold: what they may lose, at the pace of the last half, in all that is spent before a group is given
 * up. Of 30000 random encounters 99 come to as little once, of which 7 then end, and 77 twice, of which none does. */
#define IMP_WEDGE_KEPT 0.5
/* Of velocities: their rounding from which what comes out of a wedge is none of its doing. Receipts miss by a seventh
 * to a hundredth of it, of what is loose too: .03 of the 2e-11 of seed 777, number 1829. */
#define IMP_SPRINGS_KNOWN 1e-10
/* What comes out of a wedge after so much is solved once more in a unit of velocities so many times as great, which
 * rounds otherwise, and where the answer moves by more than the third, of velocities, with normals turned by 1e-11. Of
 * 100 random encounters that come out after half as much rounding moves nine in ten by 1e-9 and less. */
#define IMP_SPRINGS_CHANCY 2
#define IMP_SPRINGS_OTHER_UNIT 1.3
#define IMP_SPRINGS_CHANCE 1e-8
#define IMP_SPRINGS_NEARBY 0x1p-37
/* Steps and events of one group: a quarter more than the longest random encounter with ratios of 1e4 that is known to
 * end takes, 386046 (N = 12000, seed 43400000, number 2751 of ./run report together): two of its nine contacts bounce,
 * falling by 3e-4 from round to round, until a third joins. */
#define IMP_SPRINGS_STEPS 480000
/* Multiplications of one group, some two seconds: a hundred contacts with friction take a thirtieth; the longest random
 * encounter that is known to end takes 3.1e9 (N = 12000, seed 42400000, number 4946), of ratios of 1e6 1.1e9. */
#define IMP_SPRINGS_WORK 3.5e9
/* Bounces that never end: rounds between the first three moments; events in which a contact that takes part closes
 * again. */
#define IMP_BOUNCES_ROUNDS 8
#define IMP_BOUNCES_LONGEST 100
/* The ratio over so many rounds: at the end impulses have 1/(1 - R)^2 = 16 times the rounding of those before. */
#define IMP_BOUNCES_RATIO 0.75
/* Of velocities: what is left at the end of what no ratio explains: a tenth of what the receipt takes. */
#define IMP_BOUNCES_ERROR 0x1p-40
/* Of impulses to come: how well the ratio of the last ones has to tell them, and how far they may be from those by the
 * equations of rest. Of 22000 random encounters of up to 6 contacts, looked at from 1000 and 2000 steps on, 18 are
 * ended so within a tenth, and all where following them ends; of 10 that are a tenth to a half apart 4 are not. */
#define IMP_BOUNCES_APART 0.1
/* Steps and events from which bounces are ended by the equations of rest: what takes fewer is done by then, but for a
 * few in a thousand. */
#define IMP_BOUNCES_LATE 40000
/* From then on: the ratio that leaves moments as far apart as they are. Twice as far each time, impulses fell by ten
 * and a hundred thousand from look to look, past where they may be ended: slower than the last of these. */
#define IMP_BOUNCES_FALLEN 0.5
/* Of velocities: bounces slower than a thousand times that are not ended: what of them is left would not be told from
 * it, as where the seed of a contact that is pressed (IMP_SPRINGS_SEED) bounces before it grows. */
#define IMP_BOUNCES_SLOWEST 0x1p-30

/* ---- contact: encounters, docs/together.md ---- */

/* The receipt of what is answered as OK: a hundred times what rounding leaves of a thousand steps. */
#define IMP_ENCOUNTER_RECEIPT 1e-11
/* Of the lighter body's mass times the fastest speed: what an impulse may be off by without telling: the roundings of
 * a solve for dozens of contacts, whose velocities, slip among them, are as large as that. */
#define IMP_ENCOUNTER_GRAIN (512 * IMP_ROUNDOFF)
/* eps, of the greatest terms of a velocity u0 + W p in a group: their sums' rounding, and that of the bodies'
 * velocities. Of its own terms one missed up to 2.7 times as much in a wedge of 12 contacts (./run report together,
 * N = 12000, seed 40000000, number 8746). */
#define IMP_ENCOUNTER_ROUNDINGS 32
/* Contacts of an encounter from which Moreau's problems begin in the space of the bodies: a brick wall's 77 take 4 s
 * along the central path. */
#define IMP_ENCOUNTER_MANY 16
/* Multiplications of taking their systems apart after which what the start leaves stays: of three corners of a brick
 * that slide at 1e-8 of the ball's speed, among 94 contacts, it left 2e-10, and all paths, 600 systems and 1.2 s, found
 * none better. Of 20 contacts it is ten thousand systems. */
#define IMP_ENCOUNTER_WORK 2e9
/* Of the greatest element: a pivot of a column under it may be a rounding of what has none; complete pivoting tells,
 * and takes those over the rounding of W, IMP_ENCOUNTER_ROUNDINGS eps. Four points of one body that slide on the floor
 * had 5e-16 of a velocity taken away by a thousandth of their impulses. */
#define IMP_ENCOUNTER_DOUBTFUL 1e-8
/* Rounds in which that is taken away, each of what the last one left: the condition of W times eps of it. */
#define IMP_ENCOUNTER_MENDINGS 3
/* Seeds of contacts that are pressed and may be drawn on: of the group's fastest speed, under which velocities are none
 * (IMP_SPRINGS_STILL) and whose energy that of an open spring; and of the slip, far over what the cone problem takes
 * for none (its answer's modes are then solved for without). */
#define IMP_SPRINGS_SEED 0x1p-46
#define IMP_MOREAU_SEED 0x1p-20
/* Of the slip: what the normal's own answer to an impulse is, over 1 or mu, where friction draws: stopping it takes
 * slip/(mu W_tt). What seeds come to is of their size. */
#define IMP_ENCOUNTER_DRAWN 0x1p-12
/* One after another: of the fastest approach, what is none. */
#define IMP_SEQUENCE_STILL 0x1p-48
/* Sweeps down the list: bodies of masses 1e4 apart take some thousands. */
#define IMP_SEQUENCE_SWEEPS 100000

/* ---- the search for the next contact (motion/search.c) ---- */

/* Bounding balls are larger by this part, so that the time at which they meet is never late. */
#define IMP_SEARCH_BALLS 1e-6
/* Bodies in company of an integrator's polynomials: their gap is all but closed below this part of the size of their
 * places: at 10 m/s^2 a step from there is 1e-5 s for a body of 1 m; */
#define IMP_ALL_BUT_CLOSED 1e-9
/* and a step is then no shorter than the polynomial's by this factor. */
#define IMP_CRAWL_PARTS 64
/* rad: the faster of two bodies turns by no more in one look ahead, as a normal's guess is good for as much; and as
 * many looks make a window, a turn and more: what struck once is cleared at once. Neither changes what is found. */
#define IMP_WINDOW_TURN 0.5
#define IMP_WINDOW_LOOKS 16
/* Of gaps at both ends: what a time between must have to be of use; of the gap, what one ahead must; of a look ahead,
 * where sketched normals are too rough for links. */
#define IMP_WINDOW_GLIMPSE 0.1
#define IMP_WINDOW_SCOUT 0.2
#define IMP_WINDOW_NEAR 0.02
/* Queries of one search; it goes on from there when the queue comes back to it, and with 20 finds the same bits. */
#define IMP_SEARCH_QUERIES 2000
/* Of the time: bisection of a bound of fall ends; it is a bound from below. */
#define IMP_SEARCH_BISECTED 1e-9
/* rad, steps by Magnus' series of a ball that rolls: the next term, h^5 omega^4/720, is 1e-11 of a step; and as many
 * steps as that takes, at most. */
#define IMP_ROLL_STEP 0.01
#define IMP_ROLL_STEPS 1e7
/* Of a body's radius, how far it goes in its box: at first; the least, under which boxes would be made anew more often
 * than anything else happens; the most, at which there is one box; between them it is for the number of pairs to say.
 * And of that, the margin around the path. None of them changes a row: they set how many pairs are looked at. */
#define IMP_BOX_FIRST 1
#define IMP_BOX_LEAST 0.5
#define IMP_BOX_FATTEST 0x1p60
#define IMP_BOX_MARGIN 0.1
/* Of t: the shortest time in a box, a thousand eps: the next one begins later. */
#define IMP_BOX_SHORTEST (2000 * IMP_ROUNDOFF)
/* Cells on either side of the grid's middle: what a 64-bit number counts; and m, the least side of a box, whose cells'
 * scale is finite. */
#define IMP_GRID_CELLS 0x1p62
#define IMP_GRID_LEAST 0x1p-1000

/* ---- normals that go with edges and corners ---- */

/* rad: a little earlier and later, for the rate of a normal: errors are its square over that of the turning, and eps
 * over it. The search's need not be right, only near. */
#define IMP_VEERING 1e-4
/* Steps of the search: a bound is made for steps that reach so many times as far as the last: at the last one's end
 * its 1 - k T^2/2 is 1 to 1/512, as good as for none longer. */
#define IMP_PSI_REACH 16
/* A step of the search that is less than this part of gap over rate creeps: quadratic convergence takes nearly all of
 * it. With 0 and with 1e300 in its place a die's four thousand queries are a hundredth fewer, and eight other
 * scenes' rows the same bits: it sets how many queries a search takes, and not what it finds. */
#define IMP_CREEPING 0.25

/* ---- contact: the cone problem, docs/cone.md ---- */

/* The residual of what is solved: some 450 eps of the largest reaction and velocity. W itself is rounded, in sums of as
 * many terms as bodies' coordinates; the worst of 70 000 made problems is 2e-14. */
#define IMP_CONE_ACCEPTED 1e-13
/* The residual up to which an answer is told as inexact: above it modes, not digits, are wrong. */
#define IMP_CONE_USABLE 1e-6
/* eps, of the terms of W r: what of the residual may be the rounding of r, half of one a term. */
#define IMP_CONE_ROUNDINGS 2
/* |F| without units at which Newton's steps end: 4 eps, x and y being of order 1. */
#define IMP_CONE_FINEST 1e-15
/* e where the path ends: x and y that differ by less than its square, 1e-20, are modes that no rounding tells apart. */
#define IMP_CONE_PATH_END 1e-10
/* The same where matrices are taken apart by rank: stacks whose q differ by 1e-9 of the largest have such modes. */
#define IMP_CONE_RANK_END 1e-14
/* |F| up to this part of e is the path: x and y are of order e where modes are not told apart yet. */
#define IMP_CONE_NEAR 0.1
/* The same where the path is followed round its folds, and all along where friction sets in on it. Near a fold |F| of a
 * tenth of e is no nearness: steps went off the path and, where it turned, had none to come back to, so that they
 * crept. Of 26776 of Newton's problems of 7 to 12 contacts, none wedged, that path alone, from nothing, leaves 90
 * unsolved with .1, 5 with .01, 1 with this, 2 with 1e-4. */
#define IMP_CONE_ON_PATH 1e-3
/* e below which a step that fails shows rounding, not a fold: the matrix' condition is 1/e^2, 1e12. */
#define IMP_CONE_ARC_LEAST 1e-6
/* Ratio of e's steps from which the path is said to turn: 44 steps for two decades. */
#define IMP_CONE_SLOW 0.9
/* Ratio of the longest steps of e, where Newton needs but two: three of the path's ten decades. */
#define IMP_CONE_STRIDE 1e-3
/* Where the eased path ends, e, tried one after another: by how many of the hard ones they solve. */
#define IMP_CONE_EASINGS 0.1, 1e-2, 1e-3, 1
/* The least step by arc length, of a contact's size: a path that creeps more is left. */
#define IMP_CONE_CREEP 1e-6
/* Alpha of A + alpha 1, A's diagonal being 1 in the mean: contacts hardly feel each other. */
#define IMP_CONE_EASING 20
/* Multiplications of taking matrices apart for one problem, half a minute: the longest of Siconos' problems that is
 * solved, 570 contacts, takes .7e11. A path that creeps would go on for minutes. */
#define IMP_CONE_WORK 1e11
/* Multiplications of the longest run of sweeps, some .05 s: of 15000 random encounters by Newton's law a third of it
 * loses three that are found, and three times as much finds none more. */
#define IMP_CONE_SWEEPING 1e8
/* Of what r goes by at a sweep: what of it may change where it goes on for ever. Of those 15000 four that come to an
 * answer change as little once, none twice. */
#define IMP_CONE_DRIFT 0.1
/* The same of the problem that shows a direction of no solution: its answer grows to 1/shift along it, and is off it by
 * as little. */
#define IMP_CONE_SHIFT 1e-10
/* Q/d: where a solution's reactions would have to exceed this there is none: W d is then rounding. */
#define IMP_CONE_EXCLUDING 1e8

/* ---- contact: the cone problem in the space of bodies, docs/cone.md ---- */

/* A contact's stiffness against the mass it sees, at first, at least then, and how many times as much where Newton
 * takes but a step or two: stiffer ones leave less to the next iteration, and take Newton more steps from afar. Of the
 * 4638 problems of twenty falling dominoes and 1403 of thirty bricks that are struck, as far as they ask, 5, 30 and 4
 * take .83 and .81 of the time that 30, 100 and 10 take; begun at 3 or 10, from 10 or 100 on, by 3 or 6 times: as much
 * or more. Where 1e-8 is wanted a sixth more of them keep more. */
#define IMP_BODIES_SOFT 5
#define IMP_BODIES_STIFF 30
#define IMP_BODIES_STIFFENS 4
#define IMP_BODIES_STIFFEST 1e6
/* The residual of the start beyond which contacts are swept before Newton: twenty dominoes take him 13 steps a problem
 * then for 19, at the price of one. */
#define IMP_BODIES_FAR 1e-3
/* Sweeps, there and back, at most; and what five of them leave of the residual where five more are made. A step of
 * Newton's costs as much as some four: half a second of thirty bricks that are struck takes 3.9 s for 5.9 with ten
 * sweeps whatever they do. Where he leaves much even so, ten and a hundred times as many change nothing: a hundred
 * problems of a fallen wall, of 168 contacts. */
#define IMP_BODIES_SWEEPS 40
#define IMP_BODIES_SWEPT 0.7
/* A sweep's stiffness against the mass that the contact sees, the mean along its axes: the greatest is up to three
 * times that. The same dominoes and bricks take Newton 10600 and 2900 steps with 1, 7000 and 2300 with .5 to .8, 24600
 * and 4600 with 1.2. */
#define IMP_BODIES_SWEEP 0.65
/* Newton's steps after which contacts are let give, and after which the contacts' own space is asked, where that is at
 * hand: seven stacks that lean on thin bodies take 21 s with 15, 20 with 30, 21 with 50. */
#define IMP_BODIES_BRIEF 30
/* How stiff contacts that give are, ten times as much from one to the next, and what Newton may leave of the gradient:
 * of sixty problems that some ninety of his steps had left at residuals of .01 and more 54 are then solved, in some 35.
 * Begun at 100 every fourth one is lost, and at 1e-4 of the gradient the stacks take twice the time. */
#define IMP_BODIES_EASIEST 10
#define IMP_BODIES_HARDEST 1e7
#define IMP_BODIES_EASED 1e-6
/* Of what an iteration began with: where Newton may end. */
#define IMP_BODIES_INNER 0.1
/* The proof's residual up to which an answer is taken: a thousandth of what a step of a pile may be off, of its speeds;
 * with ten times as much five boxes that settle do not come to rest. */
#define IMP_BODIES_ACCEPTED 1e-8
/* Of the gradient's terms: what Newton's steps may leave of it; and up to what the function that they lessen may be
 * rounding, the root of eps. */
#define IMP_BODIES_FINEST 1e-12
#define IMP_BODIES_ROUNDING 1e-8

/* ---- contact: the proof of rest, docs/cone.md ---- */

/* What may be left of a body's load and reactions, of the sum of their sizes: some 450 eps of sums of as many terms. */
#define IMP_REST_BALANCED 1e-13
/* The residual from which the forces themselves are corrected: Newton's next step squares it. */
#define IMP_REST_NEAR 1e-8
/* eps, of forces far greater than their loads: what the rounding of G leaves of those that nothing balances. Of 200
 * frames of nine contacts (./run report together, N = 12000, seed 43800000, number 8370) 45 leave 5 to 82. */
#define IMP_REST_ROUNDINGS 256
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

/* Looks at one body that rows of the account take for each step or event of the run at most: one takes some 150
 * instructions, the cheapest step or event (of balls in flight) some 10000, so that rows are 2 % of a run at most. */
#define IMP_ACCOUNT_LOOKS 1.0

/* ---- an opened run (run/run_read.c) ---- */

/* No number in it is larger, so that a quintic's products h^2 f'' stay finite for h up to 1e4 s. */
#define IMP_RUN_LARGEST 1e150

/* Orientations are written as the motion normalised them, to a few roundings; what is off by more is damage. */
#define IMP_RUN_UNIT 1e-9
/* A whole number below this is written as one: 15 digits. */
#define IMP_MOST_WHOLE 1e15

/* ---- report ---- */

/* The start's displacement, in X: large against its rounding (1e-16), small enough for its effect to be linear. */
#define IMP_REPORT_NUDGE 1e-11
/* Two samples of rounding, x + e1 and x + e2, tell of the third by (e1 + e2)/2 - e0, which is small by chance too: in
 * one of twenty-five cases a twelfth of e0. A certainty of four times it is then a third of the error, at least. */
#define IMP_REPORT_SPREAD 4.0
/* Reference and witness have parted: what is left of agreement is no digit worth a comparison. */
#define IMP_REPORT_PARTING 1e-3
/* Of a report's budget: the rest is for a step that is under way as its time is up, and for the picture, which took 1.2
 * s over 20 (a wall of bricks). */
#define IMP_REPORT_WORK 0.9

/* ---- gap: libccd's own answer (gap/gap_ccd.c) ---- */

/* Of the larger body, libccd's tolerance: asked for less EPA runs away (1e-8: 1 of 214 pairs of ellipsoids wrong by a
 * twelfth of their size, after 34 ms). Asked for more than a hundredth it tells nothing. Not given: libccd's own. */
#define IMP_LEAST_CCD 1e-7
#define IMP_MOST_CCD 1e-2
#define IMP_DEFAULT_CCD 1e-4
/* In tolerances: how far its gap may be off that of its normal, which it misses by the root of the tolerance: the gap
 * then by that squared over the curvature, a few tolerances. Without the check 2 of 214 pairs were off by a third. */
#define IMP_CCD_CHECK 30.0

/* ---- motion: faces that slide and turn, docs/faces.md ---- */

/* Of the face's reach: a centre of turning farther off than this has its friction by Gauss's eight places each way over
 * the area, which are then right to rounding: the integrand's nearest singularity has the ellipse of sum of axes 4 +
 * sqrt 15 = 7.9, and 7.9^-16 is 5e-15. The sums over the border cancel as the cube of the distance. */
#define IMP_FACE_DISTANT 4.0
/* rad: panels along an arc grow by their distance from what is singular, so that sixteen places leave 1e-15 of each;
 * the narrowest, over which what is singular is the square of this; and the widest. */
#define IMP_FACE_PANEL 1e-7
#define IMP_FACE_WIDEST 0.8

/* Newton's iterations for the pressed part: three to six; and the last change, of the pressure, that rounding may leave
 * near a border, where the part is small. */
#define IMP_FACE_PRESSINGS 60
#define IMP_FACE_PRESSED 1e-12
/* Of the pressure: a change after which the next, as its square, is rounding; a twelfth of what a cube that comes to
 * rest takes. */
#define IMP_FACE_NEXT 1e-8
/* A step's last Legendre term, of what its numbers change by: the next is as much smaller, and its end closer still;
 * and by how much its rates miss those of its begin, before the first node, where a force may end or friction bend. */
#define IMP_FACE_TOLERANCE 1e-11
/* Of the rest speed, in which it is said what counts as motion: errors of velocities that do not count. A cube that
 * falls takes 113 steps to rest without, half of them at less than a thousandth of the speed that it glides with; and
 * 65 with it. */
#define IMP_FACE_STILL 1e-5
/* Newton's iteration for a step: it has settled, a tenth of the tolerance, of which the rates are off by a part; how
 * many rounds it may take, each of which brings a digit or more; and, of the speed, by how much its slopes are
 * differences. */
#define IMP_FACE_SETTLED 1e-12
#define IMP_FACE_ROUNDS 20
#define IMP_FACE_DIFFERENCE 1e-6
/* The same of a line, along which friction is v/w log(v/w) of slow slip v: the log is then right to a fifth from the
 * tolerance of a step on, and slopes to what rounding leaves of a difference, 1e-7. */
#define IMP_LINE_DIFFERENCE 1e-9
/* rad: the most that a body turns in a step: its quaternion is a polynomial of degree 12. */
#define IMP_FACE_TURN 1.0
/* tau: the longest step, in which the speed falls to a half; and the shortest: what does not go on so far tips. */
#define IMP_FACE_LONGEST 0.7
#define IMP_FACE_SHORTEST 1e-10
/* tau: a step so short is taken whatever its error: over it a force jumps, and may be off so far of what it does in the
 * time in which the speed falls to a part. */
#define IMP_FACE_JUMP 1e-12
/* Of a step, and of the mean pressure: how near to where the line of no pressure comes to a corner of the face a step
 * ends. What is missed there is the cube of it, a billionth of what made the step no good. */
#define IMP_FACE_BEND 1e-3
/* Of the time until the centre of turning comes to the border, a step towards it: from there the border is three half
 * lengths off the step's middle, and Legendre's terms fall as 5.8^-k. And in tau, what goes all the way: d^2 log d is
 * then some tolerances. */
#define IMP_FACE_TOWARDS 0.5
#define IMP_FACE_NEARS 1e-2
/* How a face begins to move: Newton's iterations, three to eight; the part of what a step is to gain at the least
 * (Armijo, 1966); and, of the acceleration, the last step, whose square is rounding. */
#define IMP_FACE_BEGINS 60
#define IMP_FACE_FALLS 1e-4
#define IMP_FACE_BEGUN 1e-9
/* Of Newton's step: what gains nothing by so little of it is a rounding away. */
#define IMP_FACE_HALVED 0x1p-30
/* Of the longest first step from rest: the shortest; what does not go so creeps, */
#define IMP_FACE_FIRST 0.05
/* up to so many rest speeds. */
#define IMP_FACE_SET_OUT 4.0
/* Looks at what stands under forces that change, in the time in which it falls its reach, no farther apart than the
 * longest step that they allow: what they do between two is not seen, as between the places of a step. */
#define IMP_FACE_LOOKS 64
/* Of the face's reach: a centre of pressure nearer to a border stands on it. */
#define IMP_FACE_MARGIN 1e-9
/* Of the line's reach: the same of its ends. Three times as much is pressed, of which moments about the middle tell
 * pressures by its square: to 1e-11. */
#define IMP_LINE_MARGIN 1e-3
/* Of the face's reach: points so near to the side over which a body tips are on it: rounding of places found on another
 * way; corners stand farther apart. */
#define IMP_TIP_SIDE 1e-6
/* Of the lying body's size: a plane without end has its border there. */
#define IMP_WITHOUT_END 1e9

/* ---- motion: piles that are stepped, docs/cone.md ---- */

/* Of a step's error: gaps up to this are closed. Where contacts are more than motions overlaps that are put back leave
 * gaps elsewhere: taken as open those bodies would fall and be caught for ever. Static faces that lie no farther apart,
 * of what a step may err at the default tolerance, are one to what is stepped. */
#define IMP_PILE_SLACK 1e-1
/* Of the deepest overlap: what parting it makes overlap by more than this is parted with it, so that half is left to
 * the next step. With a tenth it opens so many contacts, which fall and are caught, that three bodies took 2300 steps
 * in two seconds for 460 (impact.piles, 268). */
#define IMP_PILE_JOINS 0.5
/* Of a step's error: how far bodies may be off, in the time in which the smallest falls its radius, where friction acts
 * along the slip of the step's end instead of its middle's. With none such the answers are as good: it saves a second
 * solution where slip hardly turns. */
#define IMP_PILE_LEAD 1e-1
/* The residual of impulses up to which a step is taken: as a part of the speeds, over the step, it counts as its error;
 * and of works that impulses do, what is none. */
#define IMP_PILE_USABLE 1e-3
/* Of a step's error: what the residual of its impulses may make of it; and of the fastest body's speed, so that what
 * settles comes to rest. */
#define IMP_PILE_RESIDUAL 1e-1
#define IMP_PILE_STILL 1e-2
/* Contacts of an island up to which its impulses are looked for in their own space: at once, as with so few it costs no
 * more than that of the bodies; and where that of the bodies does not settle: some 3e7 multiplications then for each of
 * 20 to 60 systems. */
#define IMP_PILE_FEW 4
#define IMP_PILE_DENSE 100
/* Multiplications of taking their systems apart, where a shorter step is to be had: 80 of 27 contacts, 4 of 70. Seven
 * questions for 72 contacts, which took more than a hundred each, were a fourth of the time of twenty dominoes. */
#define IMP_PILE_WORK 3e7
/* How much more the steps of the coarser scene may err, that tells what all of them make of the motion; how often it is
 * looked at, of the duration; and what is told of a body, of its radius, where that is no small difference any more:
 * what it meets then, and with which side, is another. */
#define IMP_COARSER_STEPS 10
/* Where errors are as the cube root of what a step may err, D = (10^(1/3) - 1) e; but motions that are about to part do
 * so by chance: of seventy scenes done again with finer steps one was off by 5.1 times what is seen, two by more
 * than 4, the others by less than 3. */
#define IMP_COARSER_SAFETY 5
/* Of the duration, from one comparison of both runs to the next: what has parted seldom comes together again. */
#define IMP_COARSER_LOOKS (1 / 64.)
#define IMP_COARSER_PARTED 1e-1
/* Of what a step may err, the height to which a rim's rocking would lift its far side: more, and whether it lands is no
 * small difference. A disc that wobbles ever lower, which steps bring to rest as well, has four times its far side's.
 */
#define IMP_RIM_ROCKS 10
/* Of a step that leads over the edge of a force: how far beyond it ends that is shortened to end there. */
#define IMP_PILE_EDGE 1e-11
/* Of the energy at hand: what a step may give bodies beyond what loads do. Errors of 1e-5 of the radius give 1e-5 of
 * it; points taken for others once gave a thousand times it. */
#define IMP_PILE_GAIN 1e-2
/* Of the least step, whose places may be off by anything: what gives bodies energy is tried again in shorter ones, to
 * this part. Their places may be right all the same, and in both scenes met one or two halvings were enough. */
#define IMP_PILE_LEAST_GIVING 0x1p-10
/* Of the speed at which the smallest falls its radius, 1.6e-8: slower than this is no motion, whatever the rest speed,
 * for the residual that is accepted leaves so much: of what gravity brings in the longest step that part of contacts'
 * speeds, and of bodies' some times as much. Two boxes of 100 m crept at 1e-9 m/s for ever, of 1 m for 32 steps. */
#define IMP_PILE_RESTS (8 * IMP_BODIES_ACCEPTED * IMP_PILE_LONGEST)
/* The longest step at the default tolerance, in which contacts turn by less than .2, in units of the time in which the
 * smallest body falls its radius; as the cube root of the tolerance at others, as errors are; and of how many parts of
 * it the first is one. */
#define IMP_PILE_FIRST 5
/* How many times as far as what is held may be apart, and its gaps together, bodies may be moved to close these: in 300
 * random piles the farthest was 33 times. Where once as far was too much five of a thousand fell and were caught for
 * ever; corners microns apart threw two plates a thousand times as far. */
#define IMP_PILE_ASTRAY 1e2
/* Of the error that a step may have: at so much of it the next aims, .5 to .9 being alike: five rows of twenty dominoes
 * try 16 to 17 thousand steps with each. And as how much of one that failed the next is tried at least. */
#define IMP_PILE_AIM 0.7
#define IMP_PILE_SHORTENS 0.1
/* Of a step: what strikes later is left to the next. Struck early, as within a pair that is held, it is off by what is
 * left of its way, and the same strike is met again at the end of ever shorter steps: twenty dominoes take 1125 steps
 * then for 996. */
#define IMP_PILE_AT_END 0.95
#define IMP_PILE_LONGEST 2e-1
/* rad that what is no ball turns by in a step. A log that rolls by 2 a step turns aside by twice as much at each, from
 * roundings on; by 1 it does not. */
#define IMP_PILE_TURN 1
/* Friction acts by the pressures that it is found with, but for this part of its distance from their centre: with half
 * of it twenty dominoes take a fifteenth more time, and with none of it looked at errors do not fall with the
 * tolerance.
 */
#define IMP_PILE_SHIFTED 1e-1
/* Of the speed at which the smallest falls its radius: a face that slides no faster rubs as at rest, for its slip is
 * over within a millionth of the radius, and what steps leave of what stands is no slip. */
#define IMP_PILE_GLIDES 1e-3
/* Of sliding: turning, at a face's reach, that is less is as so much, but for its square. And how well it is known
 * where the friction of a face's points acts, and how well enough, of the reach. */
#define IMP_GLIDE_LEAST 1e-3
#define IMP_GLIDE_KNOWN 1e-6
#define IMP_GLIDE_USABLE 1e-2
/* Of a pair's points that lie in a line: their area over the square of their reach, which is roundings'. */
#define IMP_PILE_LINE 1e-9
/* In that unit, too: what has not touched the rest of a pile for so long goes on exactly. A time, not a number of
 * steps: what strikes then is answered by another law (docs/scene.md), and which it is must not hang on the tolerance.
 */
#define IMP_PILE_APART 1
/* Rates of the motion asked for, an event and a stretch in closed form for 16 of them, as for a step of the explicit
 * method: with bodies held on each other, for the time in which the smallest falls its radius, more is a pile that does
 * not get on. They are some twenty slips that begin and die out. With a quarter of them two ellipsoids that settle on
 * each other, and balls that roll about in a box, are stepped too, which the exact motion brings to their end. */
#define IMP_PILE_PATIENCE 8000
#define IMP_EVENT_RATES 16
/* Steps and events of an encounter that count as an event more: they take that long together. One that takes all the
 * work allowed is more than patience with faces; in a second of CPU a cylinder between an ellipsoid and a ball went on
 * by ten microseconds, for ever, by Stronge's law with friction 1. */
#define IMP_EVENT_STRIDES 100
/* Of two bodies held on each other otherwise: the most that was met is 8500, of a superquadric of exponents 3 and 4
 * that wobbles; where curvatures are infinite or none, as of exponents under 2, the integrator may ask for a million in
 * a microsecond. */
#define IMP_HELD_PATIENCE 400000
/* Stretches and events of what has faces, or stands on a flat place, in the same time: the motion between them is
 * smooth for longer (a superquadric of exponents 3 and 4 that wobbles asks for 8500 rates), and bounces on corners die
 * out. */
#define IMP_FACES_PATIENCE 4000
/* A step of the integrator shorter than t's rounding counts as so many: what lies face on face while the point that
 * holds it runs from end to end takes no end of them, and asks for the gap by its longest way. (By the variable that is
 * integrated: while slip dies out t stands, and that gets on.) */
#define IMP_STOOD_STRIDES 10

/* ---- one impact: what is given, and rare places ---- */

/* |n|^2 - 1 of a normal and an orientation that are taken for unit: they are then made so. */
#define IMP_COLLIDE_UNIT 1e-6
/* Of an inertia tensor's largest entry: a_ij - a_ji of one that was turned in single precision, or printed. */
#define IMP_COLLIDE_SYMMETRIC 1e-9
/* Of the work of compression: energy that rose by less is rounding's, and not told (energy_rose). */
#define IMP_COLLIDE_ROSE 1e-12
/* The turning of a slip, 1/(kg m/s), below which its line is straight whatever the rates: under its square all
 * underflows. */
#define IMP_COLLIDE_LEAST_TURNING 1e-290
/* Squared lengths in [1/this, this] have a root without loss; others go by hypot. */
#define IMP_COLLIDE_SQUARES 1e200
/* A step in tau over the rate's inverse below which powers go on by expm1, whose terms then lose nothing. */
#define IMP_COLLIDE_SHORT_STEP 1e-3
/* CVODE: slip under this part of the tolerance has stopped; and what one root in theta is passed by, of the jump that
 * it found, so that the next is another. */
#define IMP_COLLIDE_CVODE_STOP 1e-3
#define IMP_COLLIDE_CLIMB 1e-6
/* Of the speed at the start: a sampled slip that is slower stands (impact_flow_sample). */
#define IMP_FLOW_STOPPED 1e-17
/* Of a turn: a zero between two angles is met. */
#define IMP_FLOW_BISECTED 2e-16

/* ---- tangential compliance ---- */

/* The direction of a sliding spring's force follows the slip at a rate of 1/this at most, in units of the impact's: it
 * then lags by this in a slip that turns in the time of the impact, and velocities by up to 1e-7 where eta^2 is under
 * this (measured); at 1e-8 the integrator finds one impact of forty too stiff. And the least force at all. */
#define IMP_COMPLIANT_FOLLOWS 1e-6
#define IMP_COMPLIANT_LEAST 1e-12
/* Of the greatest force: an unloading spring under this has let go: F falls as (t - t_end)^(3/2). */
#define IMP_COMPLIANT_OFF 1e-8
/* Of the time of compression: to here the first instant goes in closed form; what its next term leaves is the square.
 */
#define IMP_COMPLIANT_BEGIN 1e-7

/* In periods of the normal spring: springs that have not parted by then do not. */
#define IMP_COMPLIANT_LONGEST 1e7

/* ---- the hodograph's receipt ---- */

/* Roots z of the turning's polynomial nearer than this to each other, of |z|, are not told apart: there each is known
 * to eps over the distance; and a turn less than this may go either way round. */
#define IMP_HODOGRAPH_APART 1e-3
/* | |z| - 1 | of a root that is on the circle: eps/IMP_HODOGRAPH_APART by the distance, squared for a third root. */
#define IMP_HODOGRAPH_CIRCLE 1e-5
/* |q|/|p| of a turning without its second harmonic: two of its roots are at infinity. */
#define IMP_HODOGRAPH_LEAST 1e-200
/* eps, of the turning's terms: what turns by less is not told from what does not turn. */
#define IMP_HODOGRAPH_TURNS 1e4
/* |z| - 1 of a root that stands for two. */
#define IMP_HODOGRAPH_OUTER 1e-6
/* A residual that rounding makes larger than this tells nothing, and is not taken. */
#define IMP_HODOGRAPH_OPEN 1e-3

/* ---- times of impact ---- */

/* Of all lengths: what a gap may be and its bodies touch, an eps. */
#define IMP_TOI_ROUNDING 2.5e-16
/* Of the time, times the gap's rate: what a gap is off by its time's rounding, half an eps; and by an answer's, two. */
#define IMP_TOI_TIME_ROUNDING 1.2e-16
#define IMP_TOI_TIME_NEAR 4.5e-16
/* Roundings of the gap that an answer may be early by: an advancement's last step leaves a few, its proof's gap others;
 * and that a normal must part bodies by for them to be apart. */
#define IMP_TOI_NEAR 40
/* Of the bodies' length: so far back along the way an answer's bodies must have been apart: rounding of places is 1e-10
 * of it. */
#define IMP_TOI_GLANCE_BACK 1e-6
/* Newton's steps on a bound psi: of the gap, where a chord finishes; of the time, where they stand. */
#define IMP_PSI_NEAR 1e-3
#define IMP_PSI_STEP 1e-12

/* ---- series and means ---- */

/* |a - b|/a of an arithmetic-geometric mean that has met: it squares, so that the next would be 1e-17. */
#define IMP_AGM_MET 1e-8
/* Carlson's: the arguments are within this of their mean: the series' first term left out is its sixth power, 6e-17. */
#define IMP_RF_NEAR 2e-3
/* Of a cosine or sine: a quarter turn given in doubles. */
#define IMP_QUARTER_TURN 2.5e-16
/* Of the time that slip which fades has left: a step of the explicit method. Its direction turns at a rate that goes as
 * 1/slip; with .3 or .9 a slip that dies out takes a fifth more rates. */
#define IMP_FADING_PART 0.6
/* Of a unit direction: more than what a script's arithmetic leaves of zero. */
#define IMP_SURFACE_CRUMB 1e-12
/* Of a body's speed: how far a force's brake is asked beside it: the difference keeps 32 digits of 52. */
#define IMP_BRAKE_NUDGE 0x1p-20
/* Of a fixed step: a last one may be longer by this, so that no sliver is left over. */
#define IMP_RK4_SLIVER 1e-9
/* Steps of a length of their own: an error allowed of a component is no less than this part of its size and of its way
 * in the step, what eight rates make of their rounding; and of what is and stays 0. */
#define IMP_ONE_STEP_ROUNDING (8 * IMP_ROUNDOFF)
#define IMP_ONE_STEP_LEAST 1e-300
/* The least error that the next step's length is taken from, for a step ten times as long. */
#define IMP_ONE_STEP_GROWTH 4e-10
/* In tolerances: a state or a rate that tells no first step; and the step, s, that is then tried (Hairer, Norsett,
 * Wanner 1993, II.4). */
#define IMP_ONE_STEP_NOTHING 1e-5
#define IMP_ONE_STEP_FIRST 1e-6
/* What the polynomial of an explicit step is off by, of its defect in the middle: it is the integral of that, which
 * changes its sign some seven times in the step. */
#define IMP_DOP853_DEFECT 0.1
/* Collocation holds no body with an exponent under this: about its edges the normal turns by a right angle while the
 * contact goes a few hundredths of the size, which seven nodes of a long step do not see. A body of exponents 1.12,
 * 1.05 and 1 rolled on over its edge that flies off there, .02 of its size away within .03 s, with all receipts right;
 * CVODE's steps tell it at every tolerance (impact.random_scenes). */
#define IMP_COLLOCATED_EXPONENT 1.3
/* Collocation, of the error allowed: what the sweeps may leave, */
#define IMP_LOBATTO_LEFT 0.1
/* the ratio of one sweep's change to that before from which they are taken to go nowhere, */
#define IMP_LOBATTO_SLOW 0.7
/* and the ratio r that steps are chosen for, 1/e: r is as the step, and sweeps are as 1/-log r, so that a sweep goes
 * farthest where -r log r is largest. */
#define IMP_LOBATTO_RATIO 0.37

#endif
