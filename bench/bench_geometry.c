/* SPDX-License-Identifier: MIT
 *
 * bench_geometry: what the rooms project, sequence, curve, surface and their Gauss maps cost. CSV: case, n (points,
 * nodes or repeats that one time is divided by), time in ns for each (median over rounds in which all of a part take
 * turns), error against a closed form (nan where there is none), a checksum, median over least; then the part, who does
 * it (libquat, or a textbook's way: peers_geometry.h) and with which step, number or tolerance.
 */
#include <stdio.h>
#include <string.h>
#include <quat/family.h>
#include <quat/project.h>
#include <quat/sequence.h>
#include "measure.h"
#include "peers_geometry.h"

enum { POINTS = 4096, REPEATS = 15, SIDE = 33, MOST = 16 };

static const double pi = 3.14159265358979323846;

static quat frames[POINTS], work[POINTS], nodes[SIDE * SIDE], chosen[SIDE * SIDE];
static qvec3 images[POINTS], places[SIDE * SIDE];
static size_t triangles[2 * (SIDE - 1) * (SIDE - 1)][3];

static double sum_of(size_t n, const quat q[])
{
    double sum = 0;
    for (size_t i = 0; i < n; i++) sum += q[i].w + 2 * q[i].x + 3 * q[i].y + 4 * q[i].z;
    return sum;
}

static outcome stereographic(void)
{
    quat_stereographic_array(POINTS, frames, QUAT_SOUTH_POLE, images, NULL);
    quat_from_stereographic_array(POINTS, images, QUAT_SOUTH_POLE, work);
    double worst = 0;
    for (int i = 0; i < POINTS; i++) worst = fmax(worst, quat_norm(quat_sub(work[i], frames[i])));
    return (outcome){worst, sum_of(POINTS, work)};
}

static outcome belt(void)
{
    quat_belt_frames(0.3, POINTS, work, images);
    return (outcome){quat_norm(quat_sub(work[POINTS - 1], quat_identity())), sum_of(POINTS, work)};
}

static outcome ball(void)
{
    quat q = quat_identity();
    for (int i = 1; i <= POINTS; i++) {
        const double from = 2 * pi * (i - 1) / POINTS, to = 2 * pi * i / POINTS;
        q = quat_roll(q, 0.5 * (cos(to) - cos(from)), 0.5 * (sin(to) - sin(from)));
    }
    return (outcome){quat_rotation_distance(q, quat_roll_circle(0.5, 2 * pi)), sum_of(1, &q)};
}

/* Curvature of a helix whose derivatives are known, or not. */
static outcome points(int known)
{
    quat_family family;
    quat_curve curve;
    double worst = 0, sum = 0;
    quat_helix(1, 2 * pi, 2, &family, &curve);
    curve.known = known;
    for (int i = 0; i < POINTS; i++) {
        quat_curve_point p;
        quat_curve_at(&curve, curve.end * i / POINTS, &p);
        worst = fmax(worst, fabs(p.curvature - 0.5));
        sum += p.torsion;
    }
    return (outcome){worst, sum};
}
static outcome points_known(void) { return points(3); }
static outcome points_guessed(void) { return points(0); }

static outcome minimal(void)
{
    quat_family family;
    quat_curve curve;
    quat_framing_report report;
    quat_curve_totals total;
    quat_trefoil(1, &family, &curve);
    quat_curve_frames(&curve, QUAT_MINIMAL, NULL, POINTS, NULL, work, &report);
    quat_curve_total(&curve, &total);
    return (outcome){fabs(remainder(report.holonomy + total.torsion, 2 * pi)), sum_of(POINTS, work)};
}

static outcome length(void)
{
    quat_family family;
    quat_curve curve;
    double l = 0;
    quat_ellipse(2, 1, &family, &curve);
    quat_curve_length(&curve, 0, 2 * pi, &l);
    return (outcome){fabs(l / ellipse_length - 1), l};
}

static outcome even(void)
{
    static double t[257];
    quat_family family;
    quat_curve curve;
    double l = 0;
    quat_ellipse(2, 1, &family, &curve);
    quat_curve_even(&curve, 257, t);
    quat_curve_length(&curve, t[100], t[101], &l);
    return (outcome){fabs(l * 256 / ellipse_length - 1), t[100]};
}

static outcome curvatures(int known)
{
    quat_family family;
    quat_surface surface;
    double worst = 0, sum = 0;
    quat_torus(2, 1, &family, &surface);
    surface.known = known;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double v = 2 * pi * (i % SIDE) / SIDE;
        quat_surface_point p;
        quat_surface_at(&surface, 2 * pi * i / (SIDE * SIDE), v, &p);
        worst = fmax(worst, fabs(p.curvature.gauss - cos(v) / (2 + cos(v))));
        sum += p.curvature.mean;
    }
    return (outcome){worst, sum};
}
static outcome curvatures_known(void) { return curvatures(2); }
static outcome curvatures_guessed(void) { return curvatures(0); }

static outcome total_of(double a, double c)
{
    quat_family family;
    quat_surface surface;
    quat_surface_totals t;
    quat_ellipsoid(a, a, c, &family, &surface);
    quat_surface_total(&surface, 1e-10, &t);
    return (outcome){fabs(t.gauss - 4 * pi), t.area};
}
static outcome ellipsoid(void) { return total_of(1, 1.5); }
static outcome disc(void) { return total_of(1, 1e-4); }

static outcome choose(quat_gauge gauge)
{
    quat_gauge_report report;
    memcpy(chosen, nodes, sizeof chosen);
    const quat_status status =
        quat_choose_frames(SIDE * SIDE, places, 2 * (SIDE - 1) * (SIDE - 1), triangles[0], gauge, chosen, &report);
    return (outcome){status == QUAT_OK ? NAN : INFINITY, gauge == QUAT_MINIMAL_AREA ? report.area : report.energy};
}
static outcome least_length(void) { return choose(QUAT_MINIMAL_LENGTH); }
static outcome least_area(void) { return choose(QUAT_MINIMAL_AREA); }

/* ---- the textbooks' ways ---- */

static outcome plain(double setting)
{
    (void)setting;
    return plain_stereographic(POINTS, frames);
}
static outcome helix_steps(double step) { return helix_differences(POINTS, step); }
static outcome torus_steps(double step) { return torus_differences(SIDE * SIDE, step); }

/* ---- the table ---- */

typedef struct row {
    const char *part, *name, *who;
    double setting;
    int n;
    outcome (*run)(void);
    outcome (*with)(double setting);
} row;

static outcome run_row(const row *r) { return r->run ? r->run() : r->with(r->setting); }

/* All of a part take turns, round after round; the saddle's and the torus' nodes are made before. */
static void compete(const row *rows, int count)
{
    static double times[MOST][REPEATS];
    outcome last[MOST];
    double spent[MOST] = {0};
    int rounds[MOST] = {0};
    for (int i = 0; i < measure_count(REPEATS); i++)
        for (int k = 0; k < count; k++) {
            if (spent[k] > 2) continue;
            const double start = measure_clock();
            last[k] = run_row(&rows[k]);
            const double seconds = measure_since(start);
            times[k][rounds[k]++] = seconds / rows[k].n * 1e9;
            spent[k] += seconds;
        }
    for (int k = 0; k < count; k++) {
        const row *r = &rows[k];
        const measure_time time = measure_of_rounds(times[k], rounds[k]);
        printf("%s,%d,%.4g,%.2g,%.12g,%.2f,%s,%s,%g\n", r->name, r->n, time.median, last[k].error, last[k].checksum,
               time.spread, r->part, r->who, r->setting);
    }
    fflush(stdout);
}

#define COUNT(rows) ((int)(sizeof(rows) / sizeof *(rows)))
static const char *const us = "libquat", *const differences = "differences", *const gsl = "GSL QAGS";

static void projections_and_curves(void)
{
    const row projections[] = {
        {"projections", "stereographic there and back", us, 0, POINTS, stereographic, NULL},
        {"projections", "stereographic by plain formulas", "plain formulas", 0, POINTS, NULL, plain},
        {"projections", "belt frames", us, 0, POINTS, belt, NULL},
        {"projections", "rolling strokes", us, 0, POINTS, ball, NULL},
    };
    const row curves[] = {
        {"curvature", "curve points: derivatives known", us, 0, POINTS, points_known, NULL},
        {"curvature", "curve points: x alone", us, 0, POINTS, points_guessed, NULL},
        {"curvature", "curve points by differences 1e-2", differences, 1e-2, POINTS, NULL, helix_steps},
        {"curvature", "curve points by differences 1e-3", differences, 1e-3, POINTS, NULL, helix_steps},
        {"curvature", "curve points by differences 1e-4", differences, 1e-4, POINTS, NULL, helix_steps},
        {"curvature", "curve points by differences 1e-5", differences, 1e-5, POINTS, NULL, helix_steps},
        {"frames", "minimal frames", us, 0, POINTS, minimal, NULL},
        {"length", "length of an ellipse", us, 0, 1, length, NULL},
        {"length", "length by a polygon of 100", "polygon", 100, 1, NULL, ellipse_polygon},
        {"length", "length by a polygon of 1000", "polygon", 1000, 1, NULL, ellipse_polygon},
        {"length", "length by a polygon of 10000", "polygon", 10000, 1, NULL, ellipse_polygon},
        {"even points", "even points", us, 0, 257, even, NULL},
        {"length", "length by GSL 1e-6", gsl, 1e-6, 1, NULL, ellipse_gsl},
        {"length", "length by GSL 1e-13", gsl, 1e-13, 1, NULL, ellipse_gsl},
    };
    compete(projections, COUNT(projections));
    compete(curves, COUNT(curves) - (HAS_GSL ? 0 : 2));
}

static void surfaces_and_totals(void)
{
    const row surfaces[] = {
        {"gauss curvature", "surface points: derivatives known", us, 0, SIDE * SIDE, curvatures_known, NULL},
        {"gauss curvature", "surface points: x alone", us, 0, SIDE * SIDE, curvatures_guessed, NULL},
        {"gauss curvature", "surface points by differences 1e-2", differences, 1e-2, SIDE * SIDE, NULL, torus_steps},
        {"gauss curvature", "surface points by differences 1e-3", differences, 1e-3, SIDE * SIDE, NULL, torus_steps},
        {"gauss curvature", "surface points by differences 1e-4", differences, 1e-4, SIDE * SIDE, NULL, torus_steps},
        {"gauss curvature", "surface points by differences 1e-5", differences, 1e-5, SIDE * SIDE, NULL, torus_steps},
    };
    const row totals[] = {
        {"gauss-bonnet", "totals of an ellipsoid", us, 0, 1, ellipsoid, NULL},
        {"gauss-bonnet", "midpoints 16", "midpoint rule", 16, 1, NULL, ellipsoid_midpoints},
        {"gauss-bonnet", "midpoints 128", "midpoint rule", 128, 1, NULL, ellipsoid_midpoints},
        {"gauss-bonnet", "midpoints 1024", "midpoint rule", 1024, 1, NULL, ellipsoid_midpoints},
        {"gauss-bonnet of a disc", "totals of a disc of 1 : 1e4", us, 0, 1, disc, NULL},
        {"gauss-bonnet", "totals by GSL along v 1e-6", gsl, 1e-6, 1, NULL, ellipsoid_gsl},
        {"gauss-bonnet", "totals by GSL along v 1e-12", gsl, 1e-12, 1, NULL, ellipsoid_gsl},
    };
    compete(surfaces, COUNT(surfaces));
    compete(totals, COUNT(totals) - (HAS_GSL ? 0 : 2));
}

static void gauss_maps(void)
{
    const row saddle[] = {{"gauss map", "saddle: least length", us, 0, SIDE * SIDE, least_length, NULL},
                          {"gauss map", "saddle: least area", us, 0, SIDE * SIDE, least_area, NULL}};
    const row torus[] = {{"gauss map", "whole torus: least area", us, 0, SIDE * SIDE, least_area, NULL}};
    quat_family family;
    quat_surface surface;
    quat_saddle(1, 2, &family, &surface);
    quat_surface_patch(&surface, -2, 2, -2, 2, SIDE, SIDE, places, nodes, triangles[0]);
    compete(saddle, COUNT(saddle));
    quat_torus(2, 0.8, &family, &surface);
    quat_surface_patch(&surface, 0, 2 * pi, 0, 2 * pi, SIDE, SIDE, places, nodes, triangles[0]);
    compete(torus, COUNT(torus));
}

int main(void)
{
    for (int i = 0; i < POINTS; i++) frames[i] = quat_belt_untwist(0.2, (i + 0.5) / POINTS);
    if (!HAS_GSL) puts("# GSL is not installed: its rows are skipped");
    puts("case,n,ns,error,checksum,spread,part,who,setting");
    projections_and_curves();
    surfaces_and_totals();
    gauss_maps();
    return 0;
}
