/* SPDX-License-Identifier: MIT */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>
#include "gap/gap_solver.h"
#include "kit/contact_random.h"

static imp_gap_solids random_pair(random_stream *random, int family, double distance)
{
    imp_gap_solids pair = {.size = 0};
    for (int k = 0; k < 2; k++) {
        const impact_shape shape = random_shape(random, family);
        imp_form_make(&shape, 1, random_rotation(random), &pair.form[k]);
        for (int i = 0; i < 3; i++) pair.size = fmax(pair.size, pair.form[k].axis[i]);
    }
    const qvec3 d = random_direction(random);
    pair.c[0] = distance * d.x, pair.c[1] = distance * d.y, pair.c[2] = distance * d.z;
    pair.reach = pair.size + distance;
    return pair;
}

static double length(const double v[3]) { return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

/* The harvest is a unit direction with a larger g than the seed's; without libccd it says that it has none. */
static void harvest_improves_the_seed(void **state)
{
    (void)state;
    random_stream random = {1};
    for (int k = 0; k < 4000; k++) {
        const imp_gap_solids pair = random_pair(&random, k % RANDOM_FAMILIES, 1.5 + random_unit(&random));
        const qvec3 d = random_direction(&random);
        double n[3] = {d.x, d.y, d.z};
        const double before = imp_pair_gap(&pair, n, NULL);
        const bool met = imp_gap_harvest(&pair, n);
        assert_true(met == impact_has(IMPACT_PART_CCD));
        assert_true(fabs(length(n) - 1) < 1e-14);
        assert_true(imp_pair_gap(&pair, n, NULL) >= before - 1e-14);
    }
}

/* libccd's loops end on the bodies that make its own penetration search run away. */
static void harvest_ends(void **state)
{
    (void)state;
    random_stream random = {2};
    for (int k = 0; k < 400; k++) {
        imp_gap_solids pair = random_pair(&random, RANDOM_BOXY, k % 4 == 0 ? 0 : 0.3);
        double n[3] = {0, 0, 1};
        imp_gap_harvest(&pair, n);
        assert_true(isfinite(n[0] + n[1] + n[2]));
    }
}

/* The simplex search brackets the distance that Newton finds, of the bodies and of shrunk ones. */
static void simplex_brackets(void **state)
{
    (void)state;
    random_stream random = {3};
    for (int k = 0; k < 4000; k++) {
        const int family = k % RANDOM_FAMILIES;
        const imp_gap_solids pair = random_pair(&random, family, 2.2 + random_unit(&random));
        double n[3] = {pair.c[0], pair.c[1], pair.c[2]}, x[2][3], lower, upper;
        for (int i = 0; i < 3; i++) n[i] /= pair.reach - pair.size;
        imp_gap_bracket meeting;
        impact_gap_path path;
        assert_int_equal(imp_gap_settle(&pair, NULL, &meeting, &path), IMPACT_OK);
        assert_true(meeting.gap > 0);
        assert_int_equal(imp_gap_simplex(&pair, 1, 1e-6, 300, n, x, &lower, &upper), IMP_SIMPLEX_APART);
        const double room = 1e-13 * pair.reach;
        assert_true(lower <= meeting.gap + room && meeting.gap <= upper + room);
        assert_true(upper - lower <= 1e-5 * pair.reach);
        assert_int_equal(imp_gap_simplex(&pair, 0.5, 1e-6, 300, n, x, &lower, &upper), IMP_SIMPLEX_APART);
        assert_true(lower > meeting.gap - room);
    }
}

static void simplex_sees_overlap(void **state)
{
    (void)state;
    random_stream random = {4};
    for (int k = 0; k < 500; k++) {
        imp_gap_solids pair = random_pair(&random, RANDOM_MIXED, 0.05);
        double n[3] = {0, 0, 1}, x[2][3], lower, upper;
        assert_int_equal(imp_gap_simplex(&pair, 1, 1e-6, 300, n, x, &lower, &upper), IMP_SIMPLEX_OVERLAP);
        assert_int_equal(imp_gap_simplex(&pair, 0.01, 1e-6, 300, n, x, &lower, &upper), IMP_SIMPLEX_APART);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(harvest_improves_the_seed),
        cmocka_unit_test(harvest_ends),
        cmocka_unit_test(simplex_brackets),
        cmocka_unit_test(simplex_sees_overlap),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
