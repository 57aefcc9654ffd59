/* SPDX-License-Identifier: MIT
 *
 * A ball between two walls, which open by twice an angle: it is wedged where friction holds against that angle, and
 * where the walls are parallel but for rounding.
 */
#include "contact/encounter.h"
#include "kit/contact_random.h"
#include "kit/near.h"

enum { WALLS = 2, WIDTH = 3 * WALLS, ROOM = 100 };

/* Walls whose normals lean by the angle out of opposite directions; W of a ball of that mass, through its centre. */
static bool wedged(double angle, double friction, double mass, const bool *taken)
{
    const double s = sin(angle), c = cos(angle);
    /* normal and two tangents of each */
    const double frame[WALLS][3][3] = {{{c, s, 0}, {-s, c, 0}, {0, 0, 1}}, {{-c, s, 0}, {s, c, 0}, {0, 0, 1}}};
    double w[WIDTH * WIDTH], room[ROOM];
    for (int i = 0; i < WIDTH; i++)
        for (int j = 0; j < WIDTH; j++) {
            const double *a = frame[i / 3][i % 3], *b = frame[j / 3][j % 3];
            w[i * WIDTH + j] = (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) / mass;
        }
    const double frictions[WALLS] = {friction, friction};
    assert_true(imp_encounter_wedge_size(WALLS) <= ROOM);
    const imp_wedge_question question = {WALLS, w, frictions, taken};
    return imp_encounter_wedged(&question, room);
}

/* What opens by more than rounding is proved to, whatever the mass; what opens by less balances. */
static void walls_that_open_are_told_from_parallel_ones(void **state)
{
    (void)state;
    for (int k = -3; k <= 3; k++) {
        const double mass = pow(10, k);
        assert_true(wedged(0, 0, mass, NULL));
        for (int j = 1; j <= 21; j++) assert_false(wedged(ldexp(1, -j), 0, mass, NULL));
        for (int j = 23; j <= 60; j++) assert_true(wedged(ldexp(1, -j), 0, mass, NULL));
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
        if (fabs(angle - hold) < 1e-5) continue;
        assert_int_equal(wedged(angle, friction, random_log(&random, 1e-3, 1e3), NULL), angle < hold);
        assert_false(wedged(angle, friction, 1, first));
        assert_false(wedged(angle, friction, 1, none));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(walls_that_open_are_told_from_parallel_ones),
                                       cmocka_unit_test(friction_holds_within_its_angle)};
    return cmocka_run_group_tests_name("impact.encounter_wedge", tests, NULL, NULL);
}
