/* SPDX-License-Identifier: MIT
 *
 * The kernel in its second precision: against the 128-bit oracle, which shares no formula with it, on slender bodies
 * and on every kind of slip; both round to the same double, or to neighbours.
 */
#include <float.h>
#include <stdio.h>
#include <stdlib.h>

#include "collide/collide_second.h"
#include "generators/collide_cases.h"
#include "kit/near.h"

static qvec3 three(const double *x) { return (qvec3){x[0], x[1], x[2]}; }

static impact_collider body_of(const double *x)
{
    return (impact_collider){x[0], three(x + 1), {x[4], x[5], x[6], x[7]}, three(x + 8), three(x + 11), three(x + 14)};
}

/* The first column is a name. Returns how many rows stood. */
static int compare(const char *path)
{
    static char line[8192];
    int rows = 0;
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    assert_non_null(fgets(line, sizeof line, file));
    for (int number = 2; fgets(line, sizeof line, file); number++) {
        double x[52];
        char *at = line;
        while (*at != ',') at++;
        for (int i = 0; i < 52; i++) x[i] = strtod(at + 1, &at);
        const impact_collision c = {.body = {body_of(x), body_of(x + 17)},
                                    .normal = three(x + 34),
                                    .friction = x[37],
                                    .restitution = x[38],
                                    .law = (impact_law)(int)x[39]};
        const double *y = x + 40;
        const qvec3 v[2] = {three(y), three(y + 6)}, w[2] = {three(y + 3), three(y + 9)};
        impact_outcome o;
        const impact_status status = imp_second_collide(&c, &o);
        if (status == IMPACT_EABSENT) skip();
        if (status == IMPACT_SEPARATING) continue;
        assert_int_equal(status, IMPACT_OK);
        const double off = case_error(&c, o.velocity, o.omega, v, w) / DBL_EPSILON;
        if (!(off <= 1)) fail_msg("%s, row %d: off by %.3g eps", path, number, off);
        rows++;
    }
    fclose(file);
    return rows;
}

static void slender(void **state)
{
    (void)state;
    assert_true(compare(TEST_DATA "/collide_slender.csv") > 200);
}

static void every_slip(void **state)
{
    (void)state;
    assert_true(compare(TEST_DATA "/collide_oracle.csv") > 400);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(slender), cmocka_unit_test(every_slip)};
    return cmocka_run_group_tests_name("impact collide_second", tests, NULL, NULL);
}
