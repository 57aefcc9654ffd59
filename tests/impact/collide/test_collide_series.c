/* SPDX-License-Identifier: MIT
 *
 * Turning slip: against the closed hodograph in 128 bits (tests/data/collide_oracle.csv), against CVODE, against other
 * orders, and cone and works over random impacts of every class.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <impact/collide.h>
#include "generators/collide_cases.h"

/* ---- the oracle ---- */

enum { INPUTS = 40, ANSWERS = 20 };

static qvec3 three(const double *x) { return (qvec3){x[0], x[1], x[2]}; }

static bool read_row(FILE *file, char *name, double *numbers)
{
    static char line[8192];
    if (!fgets(line, sizeof line, file)) return false;
    char *at = strchr(line, ',');
    if (!at) return false;
    snprintf(name, 32, "%.*s", (int)(at - line), line);
    for (int i = 0; i < INPUTS + ANSWERS; i++) {
        char *end;
        numbers[i] = strtod(at + 1, &end);
        if (end == at + 1) return false;
        at = end;
    }
    return true;
}

static impact_collider body_of(const double *x)
{
    return (impact_collider){x[0], three(x + 1), {x[4], x[5], x[6], x[7]}, three(x + 8), three(x + 11), three(x + 14)};
}

/* The approach is a difference of the velocities given: what rounding of theirs is to it. */
static double cancellation(const impact_collision *c, const impact_outcome *o)
{
    double size = 0;
    for (int i = 0; i < 2; i++)
        size += qvec3_norm(c->body[i].velocity) + qvec3_norm(c->body[i].omega) * qvec3_norm(c->body[i].offset);
    return size / -o->normal_before;
}

static void check_row(const char *name, const double *x, impact_solver solver)
{
    const impact_collision c = {.body = {body_of(x), body_of(x + 17)},
                                .normal = three(x + 34),
                                .friction = x[37],
                                .restitution = x[38],
                                .law = (impact_law)(int)x[39],
                                .solver = solver};
    const double *y = x + INPUTS;
    const qvec3 v[2] = {three(y), three(y + 6)}, w[2] = {three(y + 3), three(y + 9)};
    impact_outcome o;
    assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
    /* The bar: 1e-12, and beyond the well-conditioned 10 eps cond. */
    const double allowed = fmax(1e-12, 10 * 0x1p-52 * o.conditioning), size = qvec3_norm(o.impulse);
    const double parts = fmax(allowed, 10 * 0x1p-52 * cancellation(&c, &o));
    const double error = case_error(&c, o.velocity, o.omega, v, w);
    if (!(error <= allowed)) fail_msg("%s: velocities off by %.3g, allowed %.3g", name, error, allowed);
    const double off = qvec3_norm(qvec3_sub(o.impulse, three(y + 12))) / size;
    if (!(off <= parts)) fail_msg("%s: impulse off by %.3g, allowed %.3g", name, off, parts);
    const double wanted[4] = {y[15], y[16], y[17], y[18]};
    const double got[4] = {o.compression_impulse, o.work_compression, o.work_restitution, o.work_friction};
    const double joule = fabs(y[16]) + fabs(y[18]), unit[4] = {y[15], joule, joule, joule};
    for (int i = 0; i < 4; i++)
        if (!(fabs(got[i] - wanted[i]) <= parts * unit[i]))
            fail_msg("%s: p_c, W_c, W_r, W_f [%d]: wanted %.17g, got %.17g", name, i, wanted[i], got[i]);
    assert_int_equal(o.compressions, (int)y[19]);
}

static void closed_hodograph(void **state)
{
    (void)state;
    FILE *file = fopen(TEST_DATA "/collide_oracle.csv", "r");
    assert_non_null(file);
    static char heading[4096];
    assert_non_null(fgets(heading, sizeof heading, file));
    char name[32];
    double numbers[INPUTS + ANSWERS];
    int rows = 0, again = 0;
    for (; read_row(file, name, numbers); rows++) {
        check_row(name, numbers, IMPACT_SOLVER_AUTO);
        check_row(name, numbers, IMPACT_SOLVER_SERIES);
        again += numbers[INPUTS + ANSWERS - 1] > 1;
    }
    fclose(file);
    assert_true(rows > 400 && again >= 18);
}

/* ---- other solvers ---- */

static double distance(const impact_collision *c, const impact_outcome *a, const impact_outcome *b)
{
    return case_error(c, a->velocity, a->omega, b->velocity, b->omega);
}

static void agrees_with_cvode(void **state)
{
    (void)state;
    if (!impact_has(IMPACT_PART_CVODE)) skip();
    impact_collide_workspace *ws;
    assert_int_equal(impact_collide_workspace_create(IMPACT_ODE_ADAMS, 1e-12, &ws), IMPACT_OK);
    for (int class_ = 0; class_ < CASE_CLASSES; class_++)
        for (uint64_t i = 0; i < 100; i++) {
            impact_collision c = case_make((case_class)class_, 23, i);
            impact_outcome o, other;
            assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
            c.solver = IMPACT_SOLVER_CVODE;
            c.workspace = ws;
            assert_int_equal(impact_collide(&c, &other), IMPACT_OK);
            assert_int_equal(other.solver, IMPACT_SOLVER_CVODE);
            const double off = distance(&c, &o, &other);
            if (!(off < 1e-9)) fail_msg("%s %d: off by %.3g", case_name((case_class)class_), (int)i, off);
            assert_int_equal(o.compressions, other.compressions);
        }
    impact_collide_workspace_destroy(ws);
}

static void orders_agree(void **state)
{
    (void)state;
    for (int class_ = 0; class_ < CASE_REST; class_++)
        for (uint64_t i = 0; i < 300; i++) {
            impact_collision c = case_make((case_class)class_, 29, i);
            impact_outcome o, other;
            assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
            c.series_order = 12 + 6 * (int)(i % 4);
            assert_int_equal(impact_collide(&c, &other), IMPACT_OK);
            assert_true(distance(&c, &o, &other) < 10 * 0x1p-52 * (1 + o.conditioning));
        }
}

/* ---- what holds always ---- */

/* However slow the sliding is beside the approach: the works account for the energy. */
static void slow_sliding(void **state)
{
    (void)state;
    for (int exponent = -18; exponent < 0; exponent++)
        for (uint64_t i = 0; i < 2000; i++) {
            impact_collision c = case_make(CASE_PLAIN, 31, i);
            const qvec3 n = qvec3_scale(c.normal, 1 / qvec3_norm(c.normal)), t = qvec3_cross(n, (qvec3){0.3, 0.5, 0.8});
            for (int k = 0; k < 2; k++) c.body[k].velocity = c.body[k].omega = (qvec3){0, 0, 0};
            const int mover = isinf(c.body[0].mass) ? 1 : 0;
            const double sign = mover == 0 ? -1 : 1;
            c.body[mover].velocity = qvec3_axpy(sign, n, qvec3_scale(t, pow(10, exponent)));
            impact_outcome o;
            assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
            const double works = o.work_compression + o.work_restitution + o.work_friction;
            assert_true(fabs(o.energy_after - o.energy_before - works) <=
                        1e-13 * (1 + o.conditioning) * o.energy_before);
        }
}

static void cone_and_works(void **state)
{
    (void)state;
    int jams = 0, again = 0, reversals = 0;
    for (int class_ = 0; class_ < CASE_CLASSES; class_++)
        for (uint64_t i = 0; i < 20000; i++) {
            const impact_collision c = case_make((case_class)class_, 31, i);
            impact_outcome o;
            assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
            const double n = qvec3_norm(c.normal), p = qvec3_dot(o.impulse, c.normal) / n;
            const double t = qvec3_norm(qvec3_axpy(-p / n, c.normal, o.impulse));
            assert_true(t - c.friction * p <= 1e-15 * qvec3_norm(o.impulse) * sqrt(1 + c.friction * c.friction));
            const double works = o.work_compression + o.work_restitution + o.work_friction;
            assert_true(fabs(o.energy_after - o.energy_before - works) <=
                        1e-14 * (1 + o.conditioning) * o.energy_before);
            jams += o.jammed;
            again += o.compressions > 1;
            for (int k = 0; k < o.phase_count; k++) reversals += o.phases[k] == IMPACT_REVERSAL;
        }
    assert_true(jams > 1000 && again > 10 && reversals > 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closed_hodograph), cmocka_unit_test(agrees_with_cvode), cmocka_unit_test(orders_agree),
        cmocka_unit_test(slow_sliding),     cmocka_unit_test(cone_and_works),
    };
    return cmocka_run_group_tests_name("impact collide_series", tests, NULL, NULL);
}
