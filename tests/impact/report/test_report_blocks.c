/* SPDX-License-Identifier: MIT
 *
 * A report with one block of its memory, or of its scenes', refused, or all from one on; with too little time; told to
 * stop at any question; its rows refused. Each ends by itself, with its status and a message, and leaves nothing over.
 */
#include <stdio.h>
#include <impact/report.h>
#include "kit/blocks.h"
#include "kit/ledger.h"
#include "kit/scene_log.h"

typedef struct fixture {
    impact_body_def bodies[3];
    impact_scene_def def;
    impact_report_def how;
} fixture;

static const double tolerances[] = {1e-5, 1e-9}, steps[] = {0.01};

/* One slides and rolls, one bounces: with all methods. */
static void make(fixture *f)
{
    *f = (fixture){.def = impact_default_scene_def(), .how = {.struct_size = sizeof f->how}};
    f->bodies[0] = plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 0.5, 0.5);
    f->bodies[1] = ball_body("ball", (qvec3){0, 0, 0.3}, 0.5, 0.5);
    f->bodies[1].velocity = (qvec3){1, 0, 0};
    f->bodies[2] = ball_body("egg", (qvec3){2, 0, 0.3}, 0.5, 0.5);
    impact_shape_ellipsoid(0.2, 0.25, 0.3, &f->bodies[2].shape);
    f->bodies[2].velocity = (qvec3){0, 0, -0.5}, f->bodies[2].position.z = 0.32;
    f->def.bodies = f->bodies, f->def.body_count = 3, f->def.duration = 0.1;
    f->how.tolerances = tolerances, f->how.tolerance_count = 2;
    f->how.steps = steps, f->how.step_count = 1;
    f->how.rounds = 1, f->how.times = 8;
}

static long rows, refuse_row;

static bool take(const impact_report_row *row, void *context) { return (void)row, (void)context, ++rows != refuse_row; }

static impact_status ask(fixture *f, char message[300])
{
    impact_report_summary summary;
    ledger l = {0};
    const impact_allocator allocator = ledger_allocator(&l, 0);
    f->def.allocator = &allocator;
    rows = blocks = 0;
    message[0] = '\0';
    const impact_status status = impact_report(&f->def, &f->how, take, NULL, &summary, message, 300);
    fail_at = 0;
    assert_int_equal(l.live, 0);
    return status;
}

static void a_block_refused(void **state)
{
    (void)state;
    fixture f;
    char message[300];
    make(&f);
    assert_int_equal(ask(&f, message), IMPACT_OK);
    const long all = blocks, whole = rows;
    long told = 0;
    assert_true(all > 1000 && whole > 5);
    for (long at = 1; at <= all; at += at < 80 ? 1 : 1 + all / 120) {
        fail_at = at, all_after = at % 2;
        const impact_status status = ask(&f, message);
        if (status == IMPACT_OK) continue; /* a run that failed is a row that says so */
        assert_int_equal(status, IMPACT_ENOMEM);
        assert_true(message[0] != '\0');
        told++;
    }
    assert_true(told > 80);
}

static long questions, stop_at;

static bool go_on(void *context) { return (void)context, ++questions != stop_at; }

static void stopped_at_any_question(void **state)
{
    (void)state;
    fixture f;
    char message[300];
    make(&f);
    f.how.go_on = go_on;
    questions = stop_at = 0;
    assert_int_equal(ask(&f, message), IMPACT_OK);
    const long all = questions;
    for (stop_at = 1; stop_at <= all; stop_at += 1 + all / 30) {
        questions = 0;
        assert_int_equal(ask(&f, message), IMPACT_STOPPED);
        assert_true(message[0] != '\0' && rows == 0);
    }
}

static void rows_that_are_refused(void **state)
{
    (void)state;
    fixture f;
    char message[300];
    make(&f);
    for (refuse_row = 1; refuse_row <= 6; refuse_row++) assert_int_equal(ask(&f, message), IMPACT_ESINK);
    refuse_row = 0;
}

/* What has no time is dropped and counted, or, where it is the reference, the report says so. */
static void too_little_time(void **state)
{
    (void)state;
    const double budgets[] = {1e-6, 1e-3, 5e-3, 1e-2, 2e-2, 5e-2};
    for (size_t k = 0; k < sizeof budgets / sizeof *budgets; k++) {
        fixture f;
        impact_report_summary summary;
        char message[300];
        make(&f);
        f.how.seconds = budgets[k];
        const impact_status status = impact_report(&f.def, &f.how, take, NULL, &summary, message, sizeof message);
        assert_true(status == IMPACT_OK || (status == IMPACT_STOPPED && message[0] != '\0'));
        if (k == 0) assert_int_equal(status, IMPACT_STOPPED);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_block_refused),
        cmocka_unit_test(stopped_at_any_question),
        cmocka_unit_test(rows_that_are_refused),
        cmocka_unit_test(too_little_time),
    };
    return impact_has(IMPACT_PART_CVODE) ? cmocka_run_group_tests(tests, NULL, NULL) : 0;
}
