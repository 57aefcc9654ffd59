/* SPDX-License-Identifier: MIT
 *
 * A ball between two walls, which open by twice an angle: it is wedged where friction holds against that angle, and
 * where the walls are parallel but for rounding.
 */
#include "contact/encounter.h"
#include "base/tolerances.h"
#include "kit/contact_random.h"
#include "kit/near.h"

enum { WALLS = 2, WIDTH = 3 * WALLS };

/* Walls whose normals lean by the angle out of opposite directions; W of a ball of that mass, through its centre. */
static double wedged(double angle, double friction, double mass, const bool *taken)
{
    const double s = sin(angle), c = cos(angle);
    /* normal and two tangents of each */
    const double frame[WALLS][3][3] = {{{c, s, 0}, {-s, c, 0}, {0, 0, 1}}, {{-c, s, 0}, {s, c, 0}, {0, 0, 1}}};
    double w[WIDTH * WIDTH], room[2 * WIDTH];
    for (int i = 0; i < WIDTH; i++)
        for (int j = 0; j < WIDTH; j++) {
            const double *a = frame[i / 3][i % 3], *b = frame[j / 3][j % 3];
            w[i * WIDTH + j] = (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) / mass;
        }
    const double frictions[WALLS] = {friction, friction};
    const imp_wedge_question question = {WALLS, w, frictions, taken, 0};
    return imp_encounter_wedged(&question, room);
}

/* What opens by more than rounding is proved to, whatever the mass; what opens by less balances. */
static void walls_that_open_are_told_from_parallel_ones(void **state)
{
    (void)state;
    for (int k = -3; k <= 3; k++) {
        const double mass = pow(10, k);
        assert_at_most(wedged(0, 0, mass, NULL), IMP_WEDGE_BALANCED);
        for (int j = 1; j <= 21; j++) assert_true(isinf(wedged(ldexp(1, -j), 0, mass, NULL)));
        for (int j = 23; j <= 60; j++) assert_at_most(wedged(ldexp(1, -j), 0, mass, NULL), IMP_WEDGE_BALANCED);
    }
}

/* Friction holds what opens by less than its own angle; one wall alone holds nothing. */
static void friction_holds_within_its_angle(void **state)
{
    (void)state;
    random_stream random = {91};
    static const bool none[WALLS] = {false, false}, first[WALLS] = {true, false};
    for (int run = 0; run < 2000; run++) {
        const double friction = random_log(&random, 1e-3, 3), hold = atan(friction), angle = 1.5 * random_unit(&random);
        if (fabs(angle - hold) < 1e-2 * hold) continue;
        const double left = wedged(angle, friction, random_log(&random, 1e-3, 1e3), NULL);
        if (angle > hold)
            assert_true(isinf(left));
        else
            assert_at_most(left, IMP_WEDGE_TAKEN);
        assert_true(isinf(wedged(angle, friction, 1, first)));
        assert_true(isinf(wedged(angle, friction, 1, none)));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(walls_that_open_are_told_from_parallel_ones),
                                       cmocka_unit_test(friction_holds_within_its_angle)};
    return cmocka_run_group_tests_name("impact.encounter_wedge", tests, NULL, NULL);
}
