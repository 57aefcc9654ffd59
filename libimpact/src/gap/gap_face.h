/* SPDX-License-Identifier: MIT
 *
 * gap_face (internal): two surface points that face each other, the equations that they be witness points, and Newton's
 * step on them. The normals oppose (2 equations, in gnomonic coordinates about their bisector) and the points'
 * difference is along them (2 equations); for bodies in motion, and one unknown more, the time, the points also meet.
 */
#ifndef IMP_GAP_FACE_H
#define IMP_GAP_FACE_H

#include "base/tolerances.h"
#include "gap/gap_chart.h"
#include "gap/gap_solver.h"

typedef struct imp_face {
    imp_chart chart[2];
    double m[3], t[2][3];     /* bisector of the normals, and across it */
    double y[2][2], along[2]; /* gnomonic coordinates of both normals; their length along m */
    double v[3], vm, vt[2];   /* x_B + c - x_A and its parts */
} imp_face;

/* How points and normals move in time where the surface points stay. */
typedef struct imp_drift {
    double x[2][3], N[2][3]; /* x[1] with c's rate */
} imp_drift;

/* The points that the bodies reach along the unit n from A to B, or such near x (NULL: any). */
void imp_face_start(const imp_gap_solids *pair, const double n[3], const double (*x)[3], imp_surface s[2]);

/* False when the normals do not face each other. */
bool imp_face_look(const imp_gap_solids *pair, const imp_surface s[2], imp_face *face);

/* One Newton step for the four free halves: step[body][pair]. */
void imp_face_step(const imp_gap_solids *pair, const imp_face *face, double step[2][2]);

/* The same for the points to meet, and the time *dt to it; beyond the limits *dt is the limit, and the step is for the
 * gap's witness points at that time. */
void imp_face_strike(const imp_gap_solids *pair, const imp_face *face, const imp_drift *drift, double least,
                     double most, double step[2][2], double *dt);

/* Moves both points, halving the step until it stays on the surfaces; *taken is the largest part of the step. */
bool imp_face_advance(const imp_gap_solids *pair, const imp_face *face, double step[2][2], imp_surface s[2],
                      double *taken);

/* Two flats whose normals differ have their nearest points at a border: both points go there, down the slope of the
 * height between them. False: they cannot, with their normals as they are. */
bool imp_face_slide(const imp_gap_solids *pair, const imp_face *face, imp_surface s[2]);

/* Closes the bracket at the points reached and says whether it is an answer. */
bool imp_face_judge(const imp_gap_solids *pair, const imp_face *face, imp_gap_bracket *meeting);

#endif
