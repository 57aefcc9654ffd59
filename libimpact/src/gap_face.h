/* SPDX-License-Identifier: MIT
 *
 * gap_face (internal): two surface points that face each other, the equations that they be witness points, and Newton's
 * step on them. The normals oppose (2 equations, in gnomonic coordinates about their bisector) and the points'
 * difference is along them (2 equations); for bodies in motion, and one unknown more, the time, the points also meet.
 */
#ifndef IMPACT_GAP_FACE_H
#define IMPACT_GAP_FACE_H

#include "gap_chart.h"
#include "gap_solver.h"

typedef struct impact_face {
    impact_chart chart[2];
    double m[3], t[2][3];     /* bisector of the normals, and across it */
    double y[2][2], along[2]; /* gnomonic coordinates of both normals; their length along m */
    double v[3], vm, vt[2];   /* x_B + c - x_A and its parts */
} impact_face;

/* How points and normals move in time where the surface points stay. */
typedef struct impact_drift {
    double x[2][3], N[2][3]; /* x[1] with c's rate */
} impact_drift;

/* The points that the bodies reach along the unit n from A to B, or such near x (NULL: any). */
void impact_face_start(const impact_pair *pair, const double n[3], const double (*x)[3], impact_surface s[2]);

/* False when the normals do not face each other. */
bool impact_face_look(const impact_pair *pair, const impact_surface s[2], impact_face *face);

/* One Newton step for the four free halves: step[body][pair]. */
void impact_face_step(const impact_pair *pair, const impact_face *face, double step[2][2]);

/* The same for the points to meet, and the time *dt to it; beyond the limits *dt is the limit, and the step is for the
 * gap's witness points at that time. */
void impact_face_strike(const impact_pair *pair, const impact_face *face, const impact_drift *drift, double least,
                        double most, double step[2][2], double *dt);

/* Moves both points, halving the step until it stays on the surfaces; *taken is the largest part of the step. */
bool impact_face_advance(const impact_pair *pair, const impact_face *face, double step[2][2], impact_surface s[2],
                         double *taken);

/* Closes the bracket at the points reached and says whether it is an answer. */
bool impact_face_judge(const impact_pair *pair, const impact_face *face, impact_meeting *meeting);

#endif
