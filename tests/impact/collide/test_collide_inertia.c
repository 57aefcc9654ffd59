/* SPDX-License-Identifier: MIT
 *
 * Principal moments and axes of an inertia tensor.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <impact/collide.h>
#include <quat/rotation.h>
#include "generators/collide_cases.h"

static qmat3 tensor_of(qvec3 j, quat q)
{
    const qmat3 r = quat_to_matrix(q);
    const double moments[3] = {j.x, j.y, j.z};
    qmat3 t = {0};
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            for (int k = 0; k < 3; k++) t.m[a][b] += r.m[a][k] * moments[k] * r.m[b][k];
    return t;
}

static void and_back(void **state)
{
    (void)state;
    for (uint64_t i = 0; i < 2000; i++) {
        const impact_collider body = case_make(CASE_WILD, 89, i).body[0];
        if (isinf(body.mass)) continue;
        const qmat3 t = tensor_of(body.moments, body.orientation);
        qvec3 j;
        quat q;
        assert_int_equal(impact_principal_axes(&t, &j, &q), IMPACT_OK);
        const qmat3 again = tensor_of(j, q);
        const double size = body.moments.x + body.moments.y + body.moments.z;
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++) assert_true(fabs(again.m[a][b] - t.m[a][b]) < 4e-15 * size);
        assert_true(fabs(quat_dot(q, q) - 1) < 1e-14);
        assert_true(fabs(j.x + j.y + j.z - size) < 4e-15 * size);
    }
}

static void refusals(void **state)
{
    (void)state;
    qvec3 j;
    quat q;
    qmat3 t = {{{1, 0.5, 0}, {0, 1, 0}, {0, 0, 1}}};
    assert_int_equal(impact_principal_axes(&t, &j, &q), IMPACT_EARGUMENT);
    t.m[1][0] = 0.5;
    assert_int_equal(impact_principal_axes(&t, &j, &q), IMPACT_OK);
    t.m[0][1] = t.m[1][0] = 2; /* not positive definite */
    assert_int_equal(impact_principal_axes(&t, &j, &q), IMPACT_EARGUMENT);
    t.m[2][2] = NAN;
    assert_int_equal(impact_principal_axes(&t, &j, &q), IMPACT_EDOMAIN);
    assert_true(q.w == 1 && isnan(j.x));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(and_back), cmocka_unit_test(refusals)};
    return cmocka_run_group_tests_name("impact collide_inertia", tests, NULL, NULL);
}
