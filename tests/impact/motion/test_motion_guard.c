/* SPDX-License-Identifier: MIT
 *
 * What a motion says of its own work, step by step, on numbers made up for it: losses that fall, once and again, within
 * their error and beyond it; states that are no numbers; and time that all but stands.
 */
#include "motion/motion_equations.h"
#include "motion/motion_guard.h"
#include "kit/near.h"

#include <string.h>

enum { SIZE = Y_BODIES + Y_PER_BODY };

/* The state before the last step is the last quarter of the probe. */
typedef struct desk {
    double probe[4 * SIZE], y[SIZE], absolute[SIZE];
    imp_motion motion;
} desk;

static double *before(desk *d) { return d->probe + 3 * SIZE; }

static void set_up(desk *d)
{
    memset(d, 0, sizeof *d);
    for (int i = 0; i < SIZE; i++) d->absolute[i] = 1e-15;
    d->motion = (imp_motion){.size = SIZE, .relative = 1e-13, .probe = d->probe, .absolute = d->absolute};
}

/* From the losses `from` to `to` by time t. */
static bool step(desk *d, double t, double from, double to)
{
    before(d)[Y_TIME] = t;
    before(d)[Y_SLIDING] = from;
    d->y[Y_SLIDING] = to;
    return imp_motion_loss_falls(&d->motion, d->y);
}

static void a_loss_that_falls_is_booked(void **state)
{
    (void)state;
    desk d;
    set_up(&d);
    assert_false(step(&d, 0, 1, 1 + 1e-9));
    assert_false(step(&d, 0.5, 1, 1 - 5e-11)); /* within a thousand errors of 1e-13 */
    assert_true(d.motion.fallen == 0);
    assert_true(step(&d, 1, 1, 0.75));
    assert_true(step(&d, 2, 0.75, 0.625));
    assert_near(d.motion.fallen, 0.375, 1e-15);
    assert_true(d.motion.fell_at == 1);  /* the first */
    d.motion.method = IMPACT_MOTION_RK4; /* with whose steps there is none to go on by */
    assert_false(step(&d, 3, 1, 0));
}

/* Once: what falls again soon is kept, and the other method is asked; a hundred steps later it is trusted again. */
static void a_step_is_taken_back_once(void **state)
{
    (void)state;
    desk d;
    set_up(&d);
    assert_true(step(&d, 1, 1, 0.5));
    assert_true(imp_motion_take_back(&d.motion, d.y));
    assert_true(d.y[Y_SLIDING] == 1 && d.motion.fallen == 0 && d.motion.distrusted);
    assert_true(step(&d, 1, 1, 0.5));
    assert_false(imp_motion_take_back(&d.motion, d.y));
    assert_true(d.y[Y_SLIDING] == 0.5 && d.motion.fallen == 0.5 && !d.motion.distrusted);
    for (int k = 0; k < 99; k++) assert_false(step(&d, 2, 1, 1));
    assert_true(d.motion.retried);
    assert_false(step(&d, 2, 1, 1));
    assert_false(d.motion.retried);
    assert_true(step(&d, 3, 1, 0.5));
    assert_true(imp_motion_take_back(&d.motion, d.y));
}

static void what_is_no_number_goes_back(void **state)
{
    (void)state;
    const double bad[] = {NAN, INFINITY, -INFINITY};
    for (int k = 0; k < 3 * SIZE; k++) {
        desk d;
        set_up(&d);
        for (int i = 0; i < SIZE; i++) before(&d)[i] = i;
        d.y[k / 3] = 7;
        assert_true(imp_motion_finite_or_back(&d.motion, d.y));
        assert_true(d.y[k / 3] == 7);
        d.y[k / 3] = bad[k % 3];
        assert_false(imp_motion_finite_or_back(&d.motion, d.y));
        assert_memory_equal(d.y, before(&d), sizeof d.y);
    }
}

/* A hundred thousand steps have to gain a hundred thousand times 8192 roundings of t. */
static void time_that_stands_is_told(void **state)
{
    (void)state;
    const double t = 1024, gain = 1e5 * 8192 * 0x1p-53 * t;
    for (int k = 0; k < 2; k++) {
        desk d;
        set_up(&d);
        d.motion.pace_began = t;
        for (int i = 1; i < 100000; i++) assert_true(imp_motion_gains(&d.motion, t));
        assert_int_equal(imp_motion_gains(&d.motion, t + (k ? 1.01 : 0.99) * gain), k);
        assert_true(imp_motion_gains(&d.motion, t)); /* counted anew */
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_loss_that_falls_is_booked),
        cmocka_unit_test(a_step_is_taken_back_once),
        cmocka_unit_test(what_is_no_number_goes_back),
        cmocka_unit_test(time_that_stands_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
