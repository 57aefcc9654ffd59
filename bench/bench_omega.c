/* SPDX-License-Identifier: MIT
 *
 * bench_omega: a motion known in closed form, q(t) = exp(z a t) exp(x b) exp(z c t) (half angles), made from its
 * angular velocity, and from so many of its orientations: error against run time. CSV in two tables:
 *
 *   integration of w(t) over ten seconds: method; setting (steps, or tolerance); us; error, rad; us over that of
 *   Magnus' method with as many steps or, of others, with 1000; median over least; checksum. The peers integrate
 *   q' = q (0, w)/2: GSL's rk8pd, DOP853, and the classical method of order 4, normalised.
 *   interpolation: way; keys in those ten seconds; ns for an orientation (the making of the spline in it, over 4096 of
 *   them); the greatest error, rad; ns over slerp's; median over least; checksum.
 *
 * All take turns, round after round.
 */
#include <stdio.h>
#include <string.h>
#include <quat/integrate.h>
#include <quat/interpolate.h>
#include <quat/rotation.h>
#include <quat/spline.h>
#include "measure.h"
#include "peers_omega.h"

enum { ROUNDS = 15, MOST = 24, PLACES = 4096, MOST_KEYS = 1024 };

static int rounds(void)
{
    const int few = 3, count = measure_count(ROUNDS);
    return count > few ? count : few;
}

/* ---- integration ---- */

static qvec3 ask(double t, void *context)
{
    (void)context;
    return omega_at(t);
}

static quat by_library(quat_method method, double steps)
{
    quat q = {NAN, NAN, NAN, NAN};
    quat_integrate(ask, NULL, QUAT_BODY, method, 0, omega_duration, (size_t)steps, omega_truth(0), &q);
    return q;
}

static quat magnus(double steps) { return by_library(QUAT_MAGNUS4, steps); }
static quat magnus8(double steps) { return by_library(QUAT_MAGNUS8, steps); }
static quat two_exponentials(double steps) { return by_library(QUAT_CF4, steps); }

static quat classical(double steps)
{
    const double h = omega_duration / steps;
    quat q = omega_truth(0);
    for (long i = 0; i < (long)steps; i++) {
        const double t = (double)i * h;
        const quat k1 = quat_derivative_body(q, omega_at(t)),
                   k2 = quat_derivative_body(quat_add(q, quat_scale(k1, h / 2)), omega_at(t + h / 2)),
                   k3 = quat_derivative_body(quat_add(q, quat_scale(k2, h / 2)), omega_at(t + h / 2)),
                   k4 = quat_derivative_body(quat_add(q, quat_scale(k3, h)), omega_at(t + h));
        const quat sum = quat_add(quat_add(k1, k4), quat_scale(quat_add(k2, k3), 2));
        q = quat_unit(quat_add(q, quat_scale(sum, h / 6)));
    }
    return q;
}

static int join(const omega_peer *peer, const omega_peer **all, int count)
{
    for (; peer->name && count < MOST; peer++) all[count++] = peer;
    return count;
}

static void integrate(void)
{
    static const omega_peer own[] = {{"Magnus 4", 1000, magnus},
                                     {"Magnus 4", 10, magnus},
                                     {"Magnus 4", 100, magnus},
                                     {"Magnus 4", 10000, magnus},
                                     {"two exponentials", 100, two_exponentials},
                                     {"two exponentials", 1000, two_exponentials},
                                     {"two exponentials", 10000, two_exponentials},
                                     {"Magnus 8", 30, magnus8},
                                     {"Magnus 8", 50, magnus8},
                                     {"Magnus 8", 80, magnus8},
                                     {"Magnus 8", 200, magnus8},
                                     {"Magnus 8", 400, magnus8},
                                     {"RK4", 100, classical},
                                     {"RK4", 1000, classical},
                                     {"RK4", 10000, classical},
                                     {NULL, 0, NULL}};
    const omega_peer *all[MOST];
    static double times[MOST][ROUNDS];
    if (!omega_peers_gsl[0].name) printf("# GSL is not installed: its rows are skipped\n");
    if (!omega_peers_dop853[0].name) printf("# DOP853 (numbalsoda's) is not installed: its rows are skipped\n");
    const int count = join(omega_peers_dop853, all, join(omega_peers_gsl, all, join(own, all, 0)));
    for (int r = 0; r < rounds(); r++)
        for (int k = 0; k < count; k++) {
            const double from = measure_clock();
            all[k]->turn(all[k]->setting);
            times[k][r] = 1e6 * measure_since(from);
        }
    const double ours = measure_of_rounds(times[0], rounds()).median;
    const quat truth = omega_truth(omega_duration);
    printf("method,setting,us,error,time_over_ours,spread,checksum\n");
    for (int k = 0; k < count; k++) {
        const measure_time time = measure_of_rounds(times[k], rounds());
        const quat q = all[k]->turn(all[k]->setting);
        printf("%s,%g,%.4g,%.2g,%.3g,%.2f,%.12g\n", all[k]->name, all[k]->setting, time.median,
               quat_rotation_distance(q, truth), time.median / ours, time.spread, q.x);
    }
}

/* ---- interpolation ---- */

static quat all_keys[MOST_KEYS + 3], *const keys = all_keys + 1, out[PLACES]; /* one before, one behind */
static double key_times[MOST_KEYS + 1];

static void put_keys(int count)
{
    for (int i = -1; i <= count + 1; i++) keys[i] = omega_truth(omega_duration * i / count);
    for (int i = 0; i <= count; i++) key_times[i] = omega_duration * i / count;
    quat_unflip((size_t)count + 3, all_keys, NULL);
}

static double place(int k) { return omega_duration * (k + 0.5) / PLACES; }

/* The key before t, and how far it is on the way to the next. */
static int find(int count, double t, double *part)
{
    const double x = t / omega_duration * count;
    const int i = (int)x < count ? (int)x : count - 1;
    *part = x - i;
    return i;
}

static void by_nlerp(int count)
{
    for (int k = 0; k < PLACES; k++) {
        double s;
        const int i = find(count, place(k), &s);
        out[k] = quat_nlerp(keys[i], keys[i + 1], s);
    }
}

static void by_slerp(int count)
{
    for (int k = 0; k < PLACES; k++) {
        double s;
        const int i = find(count, place(k), &s);
        out[k] = quat_slerp(keys[i], keys[i + 1], s);
    }
}

static void by_squad(int count)
{
    static quat control[MOST_KEYS + 1];
    for (int i = 0; i <= count; i++) control[i] = quat_squad_control(keys[i - 1], keys[i], keys[i + 1]);
    for (int k = 0; k < PLACES; k++) {
        double s;
        const int i = find(count, place(k), &s);
        out[k] = quat_squad(keys[i], control[i], control[i + 1], keys[i + 1], s);
    }
}

/* The angular velocities at both ends are known here. */
static void by_spline(int count)
{
    quat_spline *spline;
    const qvec3 first = quat_rotate(keys[0], omega_at(0)), last = quat_rotate(keys[count], omega_at(omega_duration));
    if (quat_spline_new((size_t)count + 1, key_times, keys, QUAT_SPLINE_CLAMPED, first, last, &spline) != QUAT_OK)
        return;
    for (int k = 0; k < PLACES; k++) out[k] = quat_spline_at(spline, place(k));
    quat_spline_free(spline);
}

static void interpolate(void)
{
    static const struct {
        const char *name;
        void (*run)(int count);
    } ways[] = {{"slerp", by_slerp}, {"nlerp", by_nlerp}, {"squad", by_squad}, {"spline", by_spline}};
    static const int counts[] = {16, 64, 256, MOST_KEYS};
    printf("\nway,keys,ns,error,time_over_slerp,spread,checksum\n");
    for (int c = 0; c < 4; c++) {
        static double times[4][ROUNDS];
        put_keys(counts[c]);
        for (int r = 0; r < rounds(); r++)
            for (int w = 0; w < 4; w++) {
                const double from = measure_clock();
                ways[w].run(counts[c]);
                times[w][r] = 1e9 * measure_since(from) / PLACES;
            }
        double slerp = 0;
        for (int w = 0; w < 4; w++) {
            double worst = 0, sum = 0;
            ways[w].run(counts[c]);
            for (int k = 0; k < PLACES; k++) {
                worst = fmax(worst, quat_rotation_distance(out[k], omega_truth(place(k))));
                sum += out[k].x;
            }
            const measure_time time = measure_of_rounds(times[w], rounds());
            if (w == 0) slerp = time.median;
            printf("%s,%d,%.4g,%.2g,%.3g,%.2f,%.12g\n", ways[w].name, counts[c], time.median, worst,
                   time.median / slerp, time.spread, sum);
        }
    }
}

int main(void)
{
    integrate();
    interpolate();
    return 0;
}
