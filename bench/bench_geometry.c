/* SPDX-License-Identifier: MIT
 *
 * bench_geometry: what the rooms project, sequence, curve, surface and their Gauss maps cost. CSV: case, n (points,
 * nodes or repeats that one time is divided by), time in ns for each (median of repeats), error against a closed form
 * (nan where there is none), and a checksum.
 */
#include <stdio.h>
#include <string.h>
#include <quat/family.h>
#include <quat/project.h>
#include <quat/sequence.h>
#include "measure.h"

enum { POINTS = 4096, REPEATS = 15, SIDE = 33 };

static const double pi = 3.14159265358979323846;

static quat frames[POINTS], work[POINTS], nodes[SIDE * SIDE], chosen[SIDE * SIDE];
static qvec3 images[POINTS], places[SIDE * SIDE];
static size_t triangles[2 * (SIDE - 1) * (SIDE - 1)][3];

/* One run of a case: how far off it was, and a number that depends on all of it. */
typedef struct outcome {
    double error, checksum;
} outcome;

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
    return (outcome){fabs(l / 9.68844822054767619842 - 1), l}; /* 8 E(sqrt(3)/2) */
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
    return (outcome){fabs(l * 256 / 9.68844822054767619842 - 1), t[100]};
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

static void measure(const char *name, int n, outcome (*run)(void))
{
    double times[REPEATS];
    outcome o = run();
    for (int i = 0; i < measure_count(REPEATS); i++) {
        const double start = measure_clock();
        o = run();
        times[i] = measure_since(start) / n * 1e9;
    }
    printf("%s,%d,%.4g,%.2g,%.12g\n", name, n, measure_quantile(times, measure_count(REPEATS), 0.5), o.error,
           o.checksum);
}

int main(void)
{
    quat_family family;
    quat_surface surface;
    for (int i = 0; i < POINTS; i++) frames[i] = quat_belt_untwist(0.2, (i + 0.5) / POINTS);
    puts("case,n,ns,error,checksum");
    measure("stereographic there and back", POINTS, stereographic);
    measure("belt frames", POINTS, belt);
    measure("rolling strokes", POINTS, ball);
    measure("curve points: derivatives known", POINTS, points_known);
    measure("curve points: x alone", POINTS, points_guessed);
    measure("minimal frames", POINTS, minimal);
    measure("length of an ellipse", 1, length);
    measure("even points", 257, even);
    measure("surface points: derivatives known", SIDE * SIDE, curvatures_known);
    measure("surface points: x alone", SIDE * SIDE, curvatures_guessed);
    measure("totals of an ellipsoid", 1, ellipsoid);
    measure("totals of a disc of 1 : 1e4", 1, disc);
    quat_saddle(1, 2, &family, &surface);
    quat_surface_patch(&surface, -2, 2, -2, 2, SIDE, SIDE, places, nodes, triangles[0]);
    measure("saddle: least length", SIDE * SIDE, least_length);
    measure("saddle: least area", SIDE * SIDE, least_area);
    quat_torus(2, 0.8, &family, &surface);
    quat_surface_patch(&surface, 0, 2 * pi, 0, 2 * pi, SIDE, SIDE, places, nodes, triangles[0]);
    measure("whole torus: least area", SIDE * SIDE, least_area);
    return 0;
}
