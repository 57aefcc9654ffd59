/* SPDX-License-Identifier: MIT
 *
 * Cone problems from files, (W + W^T)/2 for W; per contact a normal, then two tangents:
 *
 * - as numbers apart by white space, commas or semicolons, # to the end of a line left out:
 *   n; mu_1 ... mu_n; W by rows, 3n x 3n; q;
 * - as Siconos writes them (Acary & al.): dimension; n; W, dense by columns of rows or in blocks; q; mu;
 * - as the library of frictional contact problems has them (FCLIB; Acary, Bremond, Koziara & Perignon 2014), HDF5: W
 * and q; or M, H, f and w of M v = H r + f, u = H^T v + w, which are W = H^T M^-1 H and q = H^T M^-1 f + w.
 *
 * Those in the plane get a second tangent along which nothing happens.
 */
#ifndef REPORT_CONES_FILES_H
#define REPORT_CONES_FILES_H

#include "kit/cone_cases.h"

/* The file's problem; siconos: its text is of the second kind. NULL, or what is wrong with it. c is to be freed. */
const char *report_cones_read(const char *path, bool siconos, cone_case *c);

/* Room for so many contacts, three numbers each; NULL, or what is wrong. */
const char *report_cones_room(double contacts, cone_case *c);

/* The spatial problem from W (n^2 by rows) and q of so many numbers a contact, 2 or 3, whose room there is. */
void report_cones_take(const double *w, const double *q, int dimension, cone_case *c);

/* HDF5 (report_cones_fclib.c). */
const char *report_cones_read_fclib(const char *path, cone_case *c);

#endif
