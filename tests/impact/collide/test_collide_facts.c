/* SPDX-License-Identifier: MIT
 *
 * The facts that docs/collide.md lists, as properties of what the library answers for random bodies; references in long
 * double. M = [[a, 0, c], [0, b, d], [c, d, m]] in the principal tangential frame. At a sliding direction theta, |u_t|
 * changes by R, theta by T / |u_t| and u_z by Z per unit of p.
 */
#include <complex.h>
#include <float.h>
#include <string.h>

#include <impact/collide.h>
#include <quat/rotation.h>
#include "generators/collide_cases.h"
#include "kit/near.h"

typedef long double wide;
static const wide pi = 3.14159265358979323846264338327950288L;
static const double eps = DBL_EPSILON;

/* ---- the equation ---- */

static wide R_at(const impact_flow *f, wide t)
{
    return f->c * cosl(t) + f->d * sinl(t) - f->friction * (f->a * cosl(t) * cosl(t) + f->b * sinl(t) * sinl(t));
}

static wide T_at(const impact_flow *f, wide t)
{
    return -f->c * sinl(t) + f->d * cosl(t) + (wide)f->friction * ((wide)f->a - f->b) * cosl(t) * sinl(t);
}

static wide Z_at(const impact_flow *f, wide t) { return f->m - f->friction * (f->c * cosl(t) + f->d * sinl(t)); }

/* Of all of the above, and so of their rounding. */
static double size_of(const impact_flow *f)
{
    return fabs(f->c) + fabs(f->d) + f->m + f->friction * (f->a + f->b + fabs(f->c) + fabs(f->d));
}

/* M_tt^-1 M_tz: what friction has to give to hold. */
static wide need_of(const impact_flow *f) { return hypotl((wide)f->c / f->a, (wide)f->d / f->b); }

/* An angle into [0, 2 pi). */
static wide wrapped(wide angle)
{
    const wide t = fmodl(angle, 2 * pi);
    return t < 0 ? t + 2 * pi : t;
}

/* Random bodies, every other one a rod, and how their contact slides. */
static impact_collision bodies(uint64_t i, impact_flow *flow, double u[3])
{
    const impact_collision c = case_make(i % 2 ? CASE_ROD : CASE_PLAIN, 11, i);
    assert_int_equal(impact_flow_make(&c, flow, u), IMPACT_OK);
    return c;
}

/* Enough of p for most slips to come to their end. */
static double long_enough(const impact_flow *f, const double u[3])
{
    return 3 * fabs(u[2]) / f->m + 2 * hypot(u[0], u[1]) / ((0.1 + f->friction) * fmin(f->a, f->b));
}

static bool has_phase(const impact_outcome *o, impact_phase phase)
{
    return memchr(o->phases, (int)phase, (size_t)o->phase_count) != NULL;
}

/* ---- the facts ---- */

static double apart(const impact_flow *f, const double *u, const double *v)
{
    return hypot((u[0] - v[0]) / sqrt(f->a), (u[1] - v[1]) / sqrt(f->b));
}

/* du_t/dp = -M_tt grad(mu |u_t| - u_t . M_tt^-1 M_tz): the potential falls; two slips never part in the norm of
 * M_tt^-1; and who starts on the way of another goes on as that one. */
static void fact_1_the_flow_is_unique_and_non_expansive(void **state)
{
    (void)state;
    enum { HALF = 60, POINTS = 2 * HALF + 1 };
    int stopped = 0;
    for (uint64_t i = 0; i < 3000; i++) {
        impact_flow f;
        double u[3];
        bodies(i, &f, u);
        const double v[3] = {-0.3 * u[0] + 0.1 * u[1], u[1] - 0.8 * u[0], u[2]}, p_end = long_enough(&f, u);
        impact_flow_point one[POINTS], two[POINTS], late[HALF + 1];
        assert_int_equal(impact_flow_sample(&f, u, p_end, POINTS, one), IMPACT_OK);
        assert_int_equal(impact_flow_sample(&f, v, p_end, POINTS, two), IMPACT_OK);
        assert_int_equal(impact_flow_sample(&f, one[HALF].velocity, p_end / 2, HALF + 1, late), IMPACT_OK);
        const double w[2] = {f.c / f.a, f.d / f.b}, none[2] = {0, 0};
        for (int k = 1; k < POINTS; k++) {
            const double *a = one[k - 1].velocity, *b = one[k].velocity;
            const double most = fmax(apart(&f, a, none), apart(&f, b, none)) + apart(&f, u, none);
            assert_at_most(apart(&f, b, two[k].velocity) - apart(&f, a, two[k - 1].velocity), 20 * eps * most);
            const double down =
                f.friction * (one[k].speed - one[k - 1].speed) - w[0] * (b[0] - a[0]) - w[1] * (b[1] - a[1]);
            assert_at_most(down, 20 * eps * (f.friction + hypot(w[0], w[1])) * (one[k].speed + one[0].speed));
            if (k >= HALF) assert_at_most(apart(&f, b, late[k - HALF].velocity), 50 * eps * most);
        }
        stopped += one[POINTS - 1].stick;
    }
    assert_true(stopped > 500);
}

/* On both sides of |M_tt^-1 M_tz| = mu, near and far; and in impacts that come to rest, or start there. */
static void fact_1_stick_persists_iff_friction_suffices(void **state)
{
    (void)state;
    int held = 0;
    for (uint64_t i = 0; i < 6000; i++) {
        impact_flow f;
        double u[3];
        impact_collision c = bodies(i, &f, u);
        const double rest[3] = {0, 0, -1}, off[4] = {1e-12, 1e-3, 0.3, 0.9};
        const wide need = need_of(&f);
        f.friction = (double)(need * (1 + (i / 4 % 2 ? 1 : -1) * off[i % 4]));
        impact_flow_point points[5];
        assert_int_equal(impact_flow_sample(&f, rest, 2 / f.m, 5, points), IMPACT_OK);
        for (int k = 0; k < 5; k++) {
            assert_int_equal(points[k].stick, need <= f.friction);
            if (!points[k].stick) continue;
            assert_true(points[k].velocity[0] == 0 && points[k].velocity[1] == 0);
            assert_near(points[k].impulse[0], -f.c / f.a * points[k].p, 4 * eps * f.friction * points[k].p);
            assert_near(points[k].impulse[1], -f.d / f.b * points[k].p, 4 * eps * f.friction * points[k].p);
        }
        /* As an impact: what does not slide at first, and what has stopped. */
        if (i % 3 == 0) c = case_make(CASE_REST, 11, i);
        impact_outcome o;
        assert_int_equal(impact_flow_make(&c, &f, u), IMPACT_OK);
        assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
        const bool holds = need_of(&f) <= c.friction;
        if (i % 3 == 0) assert_int_equal(o.phases[0], holds ? IMPACT_STICK_C : IMPACT_SLIP_C);
        const bool sticks = has_phase(&o, IMPACT_STICK_C) || has_phase(&o, IMPACT_STICK_R);
        assert_false(holds ? has_phase(&o, IMPACT_REVERSAL) : sticks);
        held += sticks;
    }
    assert_true(held > 1000);
}

/* The lambda > 0 of |(mu M_tt + lambda)^-1 M_tz| = 1, which falls with lambda; e: that vector. */
static wide restart(const impact_flow *f, wide e[2])
{
    wide low = 0, high = hypotl(f->c, f->d);
    for (int i = 0; i < 90; i++) {
        const wide mid = (low + high) / 2;
        e[0] = f->c / ((wide)f->friction * f->a + mid);
        e[1] = f->d / ((wide)f->friction * f->b + mid);
        *(hypotl(e[0], e[1]) > 1 ? &low : &high) = mid;
    }
    return high;
}

/* From rest; and no other direction leads away from u_t = 0. */
static void fact_2_the_one_direction_of_a_restart(void **state)
{
    (void)state;
    for (uint64_t i = 0; i < 5000; i++) {
        impact_flow f;
        double u[3];
        wide e[2];
        bodies(i, &f, u);
        f.friction = (double)(need_of(&f) * (0.01 + 0.98 * (double)(i % 50) / 50));
        const wide lambda = restart(&f, e);
        const double rounding = 8 * eps * size_of(&f), rest[3] = {0, 0, -1};
        impact_flow_direction directions[4];
        const int n = impact_flow_directions(&f, directions);
        int leaving = 0;
        for (int k = 0; k < n; k++) {
            if (directions[k].rate <= 0) continue;
            leaving++;
            assert_near(directions[k].rate, (double)lambda, rounding);
            assert_near(cos(directions[k].theta), (double)e[0], 100 * eps);
            assert_near(sin(directions[k].theta), (double)e[1], 100 * eps);
        }
        assert_int_equal(leaving, 1);
        impact_flow_point points[2];
        assert_int_equal(impact_flow_sample(&f, rest, 1, 2, points), IMPACT_OK);
        assert_false(points[1].stick);
        assert_near(points[1].velocity[0], (double)(lambda * e[0]), rounding);
        assert_near(points[1].velocity[1], (double)(lambda * e[1]), rounding);
    }
}

/* The same direction after sliding has stopped in the midst of an impact. */
static void fact_2_a_reversal_takes_that_direction(void **state)
{
    (void)state;
    int reversals = 0;
    for (uint64_t i = 0; i < 40000; i++) {
        impact_collision c = case_make(CASE_ROD, 17, i);
        impact_outcome o;
        assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
        if (!has_phase(&o, IMPACT_REVERSAL)) continue;
        reversals++;
        double size = 0, u[3];
        for (int b = 0; b < 2; b++) {
            c.body[b].velocity = o.velocity[b];
            c.body[b].omega = o.omega[b];
            size += qvec3_norm(o.velocity[b]) + qvec3_norm(o.omega[b]) * qvec3_norm(c.body[b].offset);
        }
        impact_flow f;
        wide e[2];
        assert_int_equal(impact_flow_make(&c, &f, u), IMPACT_OK);
        assert_true(need_of(&f) > f.friction);
        restart(&f, e);
        assert_near((double)(e[0] * u[1] - e[1] * u[0]), 0, 10 * eps * size);
        assert_true(e[0] * u[0] + e[1] * u[1] > 0);
    }
    assert_true(reversals > 50);
}

/* xi' M xi for a force along xi, from the bodies themselves: a sum of squares. */
static wide form_of(const impact_collision *c, const wide xi[3])
{
    wide sum = 0;
    for (int i = 0; i < 2; i++) {
        const impact_collider *b = &c->body[i];
        if (isinf(b->mass)) continue;
        const wide r[3] = {b->offset.x, b->offset.y, b->offset.z},
                   q[4] = {b->orientation.w, b->orientation.x, b->orientation.y, b->orientation.z};
        const wide moment[3] = {b->moments.x, b->moments.y, b->moments.z};
        const wide n = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
        wide torque[3], along[3] = {0};
        for (int k = 0; k < 3; k++) torque[k] = r[(k + 1) % 3] * xi[(k + 2) % 3] - r[(k + 2) % 3] * xi[(k + 1) % 3];
        /* Column k of the rotation: the k-th principal axis. */
        for (int k = 0; k < 3; k++) {
            const int x = k, y = (k + 1) % 3, z = (k + 2) % 3;
            const wide axis_x = n - 2 * (q[1 + y] * q[1 + y] + q[1 + z] * q[1 + z]);
            const wide axis_y = 2 * (q[1 + x] * q[1 + y] + q[0] * q[1 + z]);
            const wide axis_z = 2 * (q[1 + x] * q[1 + z] - q[0] * q[1 + y]);
            along[k] = (axis_x * torque[x] + axis_y * torque[y] + axis_z * torque[z]) / n;
            sum += along[k] * along[k] / moment[k];
        }
        sum += (xi[0] * xi[0] + xi[1] * xi[1] + xi[2] * xi[2]) / b->mass;
    }
    return sum;
}

/* With xi = (-mu e, 1) for sliding along e, Z - mu R = xi' M xi > 0: in no slip does u_z - mu |u_t| fall. So a jam
 * brakes, and u_z > 0 by p = (|u_z| + mu |u_t|) / k at the latest, k the least of xi' M xi; in a plane, where nothing
 * can turn aside, it runs into u_t = 0. */
static void fact_3_a_jam_runs_into_stick_and_compression_ends(void **state)
{
    (void)state;
    enum { POINTS = 60 };
    const case_class classes[3] = {CASE_WILD, CASE_ROD, CASE_PLANAR};
    int jams = 0, planar_jams = 0;
    for (uint64_t i = 0; i < 9000; i++) {
        const case_class class_ = classes[i % 3];
        const impact_collision c = case_make(class_, 13, i);
        impact_flow f;
        double u[3];
        assert_int_equal(impact_flow_make(&c, &f, u), IMPACT_OK);
        const double mu = f.friction;
        const qvec3 axes[3] = {f.t1, f.t2, f.n};
        for (int k = 0; k < 12; k++) {
            const wide t = 2 * pi * k / 12, e[3] = {-mu * cosl(t), -mu * sinl(t), 1};
            wide xi[3] = {0};
            for (int j = 0; j < 3; j++) xi[0] += e[j] * axes[j].x, xi[1] += e[j] * axes[j].y, xi[2] += e[j] * axes[j].z;
            const wide form = form_of(&c, xi);
            assert_true(form > 0);
            assert_near((double)(Z_at(&f, t) - mu * R_at(&f, t)), (double)form, 20 * eps * (1 + mu) * size_of(&f));
        }
        impact_outcome o;
        assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
        assert_true(o.normal_after >= 0);
        const double k = (double)(f.m - (wide)f.c * f.c / f.a - (wide)f.d * f.d / f.b), s = hypot(u[0], u[1]);
        assert_at_most(o.compression_impulse * k, (fabs(u[2]) + mu * s) * (1 + 10 * eps * o.conditioning));
        if (!o.jammed) continue;
        jams++;
        if (class_ == CASE_PLANAR) {
            planar_jams++;
            assert_int_equal(o.phases[0], IMPACT_SLIP_C);
            assert_true(o.phases[1] == IMPACT_STICK_C || o.phases[1] == IMPACT_REVERSAL);
        }
        if (o.conditioning > 1e4) continue;
        impact_flow_point points[POINTS];
        assert_int_equal(impact_flow_sample(&f, u, o.compression_impulse, POINTS, points), IMPACT_OK);
        for (int j = 1; j < POINTS; j++) {
            const double rise = points[j].velocity[2] - points[j - 1].velocity[2];
            const double gain = points[j].speed - points[j - 1].speed;
            assert_at_most(mu * gain, rise + 100 * eps * (fabs(u[2]) + mu * s));
        }
    }
    assert_true(jams > 300 && planar_jams > 50);
}

/* Theta turns in the sense of T to at most the next root of T; and u_z rises and falls as Z has it, so that it turns at
 * the two angles of Z = 0 alone. What goes beyond the root has stopped, and slides on along the one direction of a
 * restart. */
static void fact_4_theta_is_monotone_and_u_z_turns_at_most_twice(void **state)
{
    (void)state;
    enum { POINTS = 100 };
    int slips = 0, turning[3] = {0};
    for (uint64_t i = 0; i < 9000; i++) {
        impact_flow f;
        double u[3];
        bodies(i, &f, u);
        f.friction *= (double)(1 + i % 3 * 3);
        const wide start = atan2l(u[1], u[0]), T = T_at(&f, start), pull = f.friction * hypotl(f.c, f.d);
        if (fabsl(T) < 1e-6 * size_of(&f)) continue;
        const int sense = T > 0 ? 1 : -1;
        impact_flow_direction directions[4];
        wide root = 2 * pi, stops[2] = {INFINITY, INFINITY};
        double rate = 0;
        const int n = impact_flow_directions(&f, directions);
        for (int k = 0; k < n; k++) {
            const wide way = wrapped(sense * (directions[k].theta - start));
            if (way < root) root = way, rate = directions[k].rate;
        }
        for (int k = 0; k < 2 && pull > f.m; k++)
            stops[k] = wrapped(sense * (atan2l(f.d, f.c) + (k ? 1 : -1) * acosl(f.m / pull) - start));
        impact_flow_point points[POINTS];
        assert_int_equal(impact_flow_sample(&f, u, long_enough(&f, u), POINTS, points), IMPACT_OK);
        wide before = 0;
        int turns = 0;
        for (int k = 1; k < POINTS && points[k].speed > 1e-9 * points[0].speed; k++) {
            const wide way = wrapped(sense * (points[k].theta - start));
            if (rate < 0 && R_at(&f, points[k].theta) > 0 && fabsl(T_at(&f, points[k].theta)) < 1e-12 * size_of(&f))
                break;
            assert_true(way > before - 4 * eps && way < root + 4 * eps);
            int inside = 0;
            for (int j = 0; j < 2; j++) inside += stops[j] > before - 1e-9 && stops[j] < way + 1e-9;
            turns += inside;
            const double rise = points[k].velocity[2] - points[k - 1].velocity[2];
            const wide Z = Z_at(&f, start + sense * (before + way) / 2);
            if (!inside && fabsl(Z) > 1e-9 * size_of(&f)) assert_true((rise > 0) == (Z > 0));
            before = way;
        }
        assert_true(turns <= 2);
        turning[turns]++;
        slips++;
    }
    assert_true(slips > 3000 && turning[1] > 300 && turning[2] > 5);
}

/* Four iff |c|^2/3 + |d|^2/3 < (mu |a - b|)^2/3, else two: of random bodies, and a hair inside and outside of the
 * astroid, near its cusps too, where three directions are close. Half of them attract. */
static void fact_5_four_invariant_directions_or_two(void **state)
{
    (void)state;
    int four = 0, two = 0;
    for (uint64_t i = 0; i < 4000; i++) {
        impact_flow f;
        double u[3];
        bodies(i, &f, u);
        const double h = f.friction * fabs(f.a - f.b), share = i % 4 == 2 ? 1 - 1e-7 : 1 + 1e-7;
        if (i % 4 >= 2) {
            const double t = (double)i;
            f.c = share * h * pow(cos(t), 3);
            f.d = share * h * pow(sin(t), 3);
            f.m = 2 * (f.c * f.c / f.a + f.d * f.d / f.b);
        }
        const wide room = cbrtl((wide)h * h) - cbrtl((wide)f.c * f.c) - cbrtl((wide)f.d * f.d);
        if (f.friction == 0 || fabsl(room) < 1e-9 * cbrt(h * h)) continue;
        impact_flow_direction found[4];
        const int n = impact_flow_directions(&f, found);
        assert_int_equal(n, room > 0 ? 4 : 2);
        int attract = 0;
        for (int k = 0; k < n; k++) {
            const double t = found[k].theta;
            assert_near((double)T_at(&f, t), 0, 4 * eps * size_of(&f));
            assert_near(found[k].rate, (double)R_at(&f, t), 4 * eps * size_of(&f));
            assert_near(found[k].climb, (double)Z_at(&f, t), 4 * eps * size_of(&f));
            attract += found[k].pull < 0;
            assert_true(k == 0 || t > found[k - 1].theta);
        }
        assert_int_equal(attract, n / 2);
        four += n == 4;
        two += n == 2;
    }
    assert_true(four > 1000 && two > 1000);
}

typedef long double complex complex_wide;

/* The roots z = e^(i theta) of T: h z^4 + (i d - c) z^3 + (c + i d) z - h, h = mu (a - b) / 2, all at once (Durand &
 * Kerner). */
static complex_wide quartic(const impact_flow *f, complex_wide z)
{
    const wide h = (wide)f->friction * ((wide)f->a - f->b) / 2;
    return ((h * z + (I * (wide)f->d - f->c)) * z * z + (f->c + I * (wide)f->d)) * z - h;
}

static void roots_of(const impact_flow *f, complex_wide z[4])
{
    const wide h = (wide)f->friction * ((wide)f->a - f->b) / 2;
    for (int i = 0; i < 4; i++) z[i] = cpowl(0.4L + 0.9L * I, i);
    for (int round = 0; round < 200; round++) {
        wide moved = 0;
        for (int i = 0; i < 4; i++) {
            complex_wide others = h;
            for (int k = 0; k < 4; k++)
                if (k != i) others *= z[i] - z[k];
            const complex_wide step = quartic(f, z[i]) / others;
            z[i] -= step;
            moved += cabsl(step / z[i]);
        }
        if (moved < 16 * LDBL_EPSILON) return;
    }
}

/* gamma = R / T' at each root, real or complex. False where two of them nearly meet. */
static bool exponents(const impact_flow *f, complex_wide theta[4], complex_wide gamma[4])
{
    complex_wide z[4];
    roots_of(f, z);
    for (int i = 0; i < 4; i++) {
        theta[i] = -I * clogl(z[i]);
        const complex_wide x = ccosl(theta[i]), y = csinl(theta[i]), along = f->c * x + f->d * y;
        const complex_wide slope = -along + f->friction * ((wide)f->a - f->b) * (x * x - y * y);
        if (!(cabsl(slope) > 0.02 * (hypot(f->c, f->d) + f->friction * fabs(f->a - f->b)))) return false;
        gamma[i] = (along - f->friction * (f->a * x * x + f->b * y * y)) / slope;
    }
    return true;
}

static wide hodograph(const complex_wide theta[4], const complex_wide gamma[4], wide from, wide to)
{
    complex_wide log_s = 0;
    for (int i = 0; i < 4; i++) log_s += gamma[i] * clogl(csinl((to - theta[i]) / 2) / csinl((from - theta[i]) / 2));
    return expl(creall(log_s));
}

/* Gauss & Legendre, five points on each of ten parts. */
static wide impulse_between(const impact_flow *f, const complex_wide theta[4], const complex_wide gamma[4], wide from,
                            wide to)
{
    static const wide node[3] = {0, 0.538469310105683091036314420700208805L, 0.906179845938663992797626878299392965L};
    static const wide weight[3] = {0.568888888888888888888888888888888889L, 0.478628670499366468041291514835638193L,
                                   0.236926885056189087514264040719917363L};
    wide sum = 0;
    for (int part = 0; part < 10; part++)
        for (int k = -2; k <= 2; k++) {
            const wide t = from + (to - from) * (part + 0.5L + (k < 0 ? -node[-k] : node[k]) / 2) / 10;
            sum += weight[k < 0 ? -k : k] / 20 * hodograph(theta, gamma, from, t) / T_at(f, t);
        }
    return (to - from) * sum;
}

/* s = s0 prod |sin((theta - theta_i) / 2) / sin((theta0 - theta_i) / 2)|^gamma_i, sum gamma_i = -2, p = int s / T;
 * against the library's own points of a slip. Its theta is a double, by which s may be off by R / T and p by s / T. */
static void fact_6_the_closed_hodograph(void **state)
{
    (void)state;
    enum { POINTS = 12 };
    int slips = 0, complex_pairs = 0;
    for (uint64_t i = 0; i < 1000; i++) {
        impact_flow f;
        double u[3];
        bodies(i, &f, u);
        if (f.friction * fabs(f.a - f.b) < 0.01 * hypot(f.c, f.d)) continue;
        complex_wide theta[4], gamma[4];
        impact_flow_direction found[4];
        if (!exponents(&f, theta, gamma)) continue;
        assert_near((double)cabsl(gamma[0] + gamma[1] + gamma[2] + gamma[3] + 2), 0, 1e-13);
        const int n = impact_flow_directions(&f, found);
        complex_pairs += n == 2;
        for (int k = 0; k < n; k++)
            assert_near((double)cabsl(quartic(&f, cexpl(I * (wide)found[k].theta))), 0, 8 * eps * size_of(&f));
        impact_flow_point points[POINTS];
        const double most = f.friction * (f.a + f.b) + hypot(f.c, f.d);
        assert_int_equal(impact_flow_sample(&f, u, hypot(u[0], u[1]) / most, POINTS, points), IMPACT_OK);
        for (int k = 1; k < POINTS; k++) {
            const wide from = points[k - 1].theta, to = from + remainderl(points[k].theta - from, 2 * pi);
            const double s0 = points[k - 1].speed, s = points[k].speed, p = points[k].p - points[k - 1].p;
            if (fminl(fabsl(T_at(&f, from)), fabsl(T_at(&f, to))) < 1e-3 * most) break;
            const double slack = (double)(fabsl(R_at(&f, from) / T_at(&f, from)) + fabsl(R_at(&f, to) / T_at(&f, to)));
            assert_near(s / s0, (double)hodograph(theta, gamma, from, to), (10 + 8 * slack) * eps);
            const double short_of = (double)(s0 / fabsl(T_at(&f, from)) + s / fabsl(T_at(&f, to)));
            assert_near(p, (double)(s0 * impulse_between(&f, theta, gamma, from, to)),
                        eps * (10 * points[POINTS - 1].p + 8 * short_of));
        }
        slips++;
    }
    assert_true(slips > 400 && complex_pairs > 100);
}

/* Kinetic, of what moves. */
static wide energy(const impact_collision *c, const qvec3 v[2], const qvec3 w[2])
{
    wide sum = 0;
    for (int i = 0; i < 2; i++) {
        const impact_collider *b = &c->body[i];
        if (isinf(b->mass)) continue;
        const qvec3 l = quat_rotate_inverse(b->orientation, w[i]), j = b->moments;
        sum += (wide)b->mass * ((wide)v[i].x * v[i].x + (wide)v[i].y * v[i].y + (wide)v[i].z * v[i].z);
        sum += (wide)j.x * l.x * l.x + (wide)j.y * l.y * l.y + (wide)j.z * l.z * l.z;
    }
    return sum / 2;
}

static double gain(const impact_collision *c, impact_outcome *o)
{
    assert_int_equal(impact_collide(c, o), IMPACT_OK);
    const qvec3 v[2] = {c->body[0].velocity, c->body[1].velocity}, w[2] = {c->body[0].omega, c->body[1].omega};
    return (double)(energy(c, o->velocity, o->omega) / energy(c, v, w) - 1);
}

static void fact_7_poisson_and_stronge_never_gain(void **state)
{
    (void)state;
    int newton = 0;
    for (int class_ = 0; class_ < CASE_CLASSES; class_++)
        for (uint64_t i = 0; i < 9000; i++) {
            const impact_collision c = case_make((case_class)class_, 31, i);
            impact_outcome o;
            const double more = gain(&c, &o);
            if (c.law != IMPACT_NEWTON) {
                assert_at_most(more, 1e-14);
                assert_false(o.energy_rose);
            } else {
                newton += more > 1e-12;
                if (fabs(more) > 1e-12) assert_int_equal(o.energy_rose, more > 0);
            }
        }
    assert_true(newton > 100);
}

/* Kane's: thin, at 55 degrees, eps = 1, mu = 0.5, v = (-1, 0, -1); its end slides, stops and slides back. M_xx = 1 + 3
 * sin^2, M_zz = 1 + 3 cos^2, M_xz = 3 sin cos per unit of mass, and each piece is straight. */
static void fact_7_the_thin_rod_gains_by_newton(void **state)
{
    (void)state;
    const wide angle = 55 * pi / 180, sn = sinl(angle), cs = cosl(angle), mu = 0.5L;
    impact_collision c = {.body = {{.mass = 1,
                                    .moments = {1.0 / 3, 1.0 / 3, 1e-9},
                                    .orientation = {1, 0, 0, 0},
                                    .offset = {(double)cs, 0, -(double)sn},
                                    .velocity = {-1, 0, -1}},
                                   {.mass = INFINITY, .orientation = {1, 0, 0, 0}}},
                          .normal = {0, 0, 1},
                          .friction = 0.5,
                          .restitution = 1,
                          .law = IMPACT_NEWTON};
    const wide xx = 1 + 3 * sn * sn, zz = 1 + 3 * cs * cs, xz = 3 * sn * cs;
    /* u = (-1, -1): to u_x = 0, and from there on with friction the other way, if it does not hold; u_z = 1 ends it. */
    const wide first = 1 / (mu * xx + xz), uz = -1 + (zz + mu * xz) * first, hold = -xz / xx;
    const wide g = fabsl(hold) <= mu ? hold : -mu, p = first + (1 - uz) / (zz + g * xz);
    const wide px = mu * first + g * (p - first), vx = px - 1, vz = p - 1, w = 3 * (-sn * px - cs * p);
    const double wanted = (double)((vx * vx + vz * vz + w * w / 3) / 2 - 1);
    impact_outcome o;
    assert_near(wanted, 0.104, 5e-4);
    assert_near(gain(&c, &o), wanted, 4 * eps);
    assert_true(o.energy_rose);
    for (int law = IMPACT_POISSON; law <= IMPACT_STRONGE; law += IMPACT_STRONGE) {
        c.law = (impact_law)law;
        assert_at_most(gain(&c, &o), 2 * eps);
        assert_false(o.energy_rose);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fact_1_the_flow_is_unique_and_non_expansive),
        cmocka_unit_test(fact_1_stick_persists_iff_friction_suffices),
        cmocka_unit_test(fact_2_the_one_direction_of_a_restart),
        cmocka_unit_test(fact_2_a_reversal_takes_that_direction),
        cmocka_unit_test(fact_3_a_jam_runs_into_stick_and_compression_ends),
        cmocka_unit_test(fact_4_theta_is_monotone_and_u_z_turns_at_most_twice),
        cmocka_unit_test(fact_5_four_invariant_directions_or_two),
        cmocka_unit_test(fact_6_the_closed_hodograph),
        cmocka_unit_test(fact_7_poisson_and_stronge_never_gain),
        cmocka_unit_test(fact_7_the_thin_rod_gains_by_newton),
    };
    return cmocka_run_group_tests_name("impact collide_facts", tests, NULL, NULL);
}
