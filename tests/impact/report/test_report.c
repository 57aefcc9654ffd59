/* SPDX-License-Identifier: MIT
 *
 * The report of a scene: what it says is held to scenes whose motion has a formula, and what it cannot say it does not.
 */
#include <stdio.h>
#include <impact/report.h>
#include "kit/scene_log.h"

enum { MOST_ROWS = 100, TIMES = 24 };

typedef struct table {
    impact_report_row rows[MOST_ROWS];
    int count;
    impact_report_summary summary;
    char message[300];
} table;

static bool take(const impact_report_row *row, void *context)
{
    table *t = context;
    assert_true(t->count < MOST_ROWS);
    t->rows[t->count++] = *row;
    return true;
}

static impact_status ask(const impact_scene_def *def, const impact_report_def *how, table *t)
{
    *t = (table){0};
    return impact_report(def, how, take, t, &t->summary, t->message, sizeof t->message);
}

static void get(const impact_scene_def *def, const impact_report_def *how, table *t)
{
    if (ask(def, how, t) != IMPACT_OK) fail_msg("%s", t->message);
}

static const impact_report_row *best_of(const table *t, impact_report_method method)
{
    const impact_report_row *best = NULL;
    for (int k = 0; k < t->count; k++) {
        const impact_report_row *row = &t->rows[k];
        if (row->method != method || row->rounds == 0) continue;
        if (!best || impact_report_worst(row->error) < impact_report_worst(best->error)) best = row;
    }
    assert_non_null(best);
    return best;
}

/* ---- a ball that bounces in a constant force ---- */

/* x'' = f/m, z'' = -g; restitution e at z = r, without friction: piecewise parabolas. */
typedef struct bounce_scene {
    impact_body_def bodies[2];
    impact_force_def force;
    impact_scene_def def;
    long runs; /* or calls at t = 0: what the force remembers */
} bounce_scene;

static const double height = 1, bounciness = 0.7, push = 2, radius = 0.3, weight = 4, g = 9.81;

static bool constant_push(double t, int body, double mass, qvec3 position, quat orientation, qvec3 velocity,
                          qvec3 omega, qvec3 *force, qvec3 *torque, void *context)
{
    (void)t, (void)body, (void)mass, (void)position, (void)orientation, (void)velocity, (void)omega, (void)context;
    *force = (qvec3){push, 0, 0}, *torque = (qvec3){0, 0, 0};
    return true;
}

static bool counting_push(double t, int body, double mass, qvec3 position, quat orientation, qvec3 velocity,
                          qvec3 omega, qvec3 *force, qvec3 *torque, void *context)
{
    bounce_scene *s = context;
    s->runs += t == 0;
    (void)body, (void)mass, (void)position, (void)orientation, (void)velocity, (void)omega;
    *force = (qvec3){push + 1e-6 * (double)s->runs, 0, 0}, *torque = (qvec3){0, 0, 0};
    return true;
}

static void make_bounce(bounce_scene *s)
{
    *s = (bounce_scene){0};
    s->bodies[0] = plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 0, 1);
    s->bodies[1] = ball_body("ball", (qvec3){0, 0, radius + height}, 0, bounciness);
    s->force = impact_default_force_def(IMPACT_FORCE_CUSTOM);
    s->force.name = "push";
    s->force.function = constant_push;
    s->force.context = s;
    s->def = impact_default_scene_def();
    s->def.gravity = (qvec3){0, 0, -g};
    s->def.bodies = s->bodies, s->def.body_count = 2;
    s->def.forces = &s->force, s->def.force_count = 1;
    s->def.duration = 1.5;
}

static impact_sample bounce_at(double t)
{
    double z = height, w = 0, left = t;
    for (;;) {
        const double fall = (w + sqrt(w * w + 2 * g * z)) / g; /* until z = 0 */
        if (left <= fall) break;
        left -= fall;
        w = bounciness * (g * fall - w), z = 0;
    }
    const double a = push / weight;
    return (impact_sample){.t = t,
                           .body = 1,
                           .position = {0.5 * a * t * t, 0, radius + z + left * (w - 0.5 * g * left)},
                           .orientation = {1, 0, 0, 0},
                           .velocity = {a * t, 0, w - g * left}};
}

static void fill_truth(impact_sample *rows)
{
    for (int k = 0; k < TIMES; k++) rows[k] = bounce_at(1.5 * (k + 1) / TIMES - 0.003);
}

/* ---- what it says ---- */

/* Against the truth the default's error is a few roundings, the fixed step's falls; and the certainty that is stated
 * without the truth is no less than a third of the error that the truth shows. */
static void its_certainty_is_no_flattery(void **state)
{
    (void)state;
    bounce_scene s;
    table blind, seen;
    impact_sample truth[TIMES];
    make_bounce(&s);
    fill_truth(truth);
    const impact_report_def alone = {.struct_size = sizeof alone, .times = TIMES, .rounds = 1};
    const impact_report_def oracle = {.struct_size = sizeof oracle,
                                      .times = TIMES,
                                      .rounds = 1,
                                      .oracle = truth,
                                      .oracle_count = TIMES,
                                      .oracle_error = 1e-15};
    get(&s.def, &alone, &blind);
    get(&s.def, &oracle, &seen);
    assert_true(isnan(seen.summary.reference) && seen.summary.sure);
    const double true_error = impact_report_worst(best_of(&seen, IMPACT_REPORT_DEFAULT)->error);
    const double stated = impact_report_worst(blind.summary.certainty);
    assert_at_most(true_error, 1e-12);
    assert_at_most(true_error, 3 * stated);
    assert_at_most(stated, 1e-11);
    assert_true(blind.summary.sure && blind.summary.motion_witness.method == IMPACT_REPORT_RK4);
    assert_near(blind.summary.condition, 1, 5);
    assert_true(blind.summary.horizon == s.def.duration);
    assert_int_equal(blind.summary.times, TIMES);
}

/* Every row: tolerances and steps in their order, errors that fall with them, all events, counters of its own method.
 */
static void its_rows_are_what_they_say(void **state)
{
    (void)state;
    bounce_scene s;
    table t;
    make_bounce(&s);
    get(&s.def, &(impact_report_def){.struct_size = sizeof(impact_report_def), .times = TIMES, .rounds = 3}, &t);
    assert_true(t.summary.useless[IMPACT_REPORT_GAPS] && !t.summary.useless[IMPACT_REPORT_MOTION]);
    assert_false(t.summary.useless[IMPACT_REPORT_RK4] || t.summary.useless[IMPACT_REPORT_IMPACTS]);
    int steps = 0;
    for (int k = 0; k < t.count; k++) {
        const impact_report_row *row = &t.rows[k];
        const bool first = k == 0 || t.rows[k - 1].method != row->method;
        assert_true(first || row->setting < t.rows[k - 1].setting);
        assert_true(row->status >= 0 && row->cpu > 0 && row->spread >= 1 && row->rounds == 3);
        assert_int_equal(row->other_events, 0);
        assert_true(row->usage.integrator_steps > 0);
        assert_int_equal(row->usage.impacts_cvode > 0,
                         row->method == IMPACT_REPORT_IMPACTS || row->method == IMPACT_REPORT_TEXTBOOK);
        assert_at_most(row->error.t, 10 * impact_report_worst(row->error) + 1e-11);
        steps += row->method == IMPACT_REPORT_RK4;
    }
    assert_int_equal(steps, 6);
    assert_at_most(impact_report_worst(best_of(&t, IMPACT_REPORT_RK4)->error), 1e-10);
    assert_at_most(impact_report_worst(t.summary.certainty), 1e-11);
    assert_true(t.summary.events >= 2 && t.summary.X > 1 && t.summary.V > 3);
}

/* Where the default needs no integrator it has one row, and CVODE and the fixed step stand beside it. */
static void a_flight_in_closed_form_has_one_row(void **state)
{
    (void)state;
    bounce_scene s;
    table t;
    make_bounce(&s);
    s.def.force_count = 0;
    s.bodies[1].omega = (qvec3){1, 2, 3};
    get(&s.def, &(impact_report_def){.struct_size = sizeof(impact_report_def), .times = TIMES, .rounds = 1}, &t);
    int count[IMPACT_REPORT_METHODS] = {0};
    for (int k = 0; k < t.count; k++) count[t.rows[k].method]++;
    assert_int_equal(count[IMPACT_REPORT_DEFAULT], 1);
    assert_int_equal(count[IMPACT_REPORT_MOTION], 11);
    assert_int_equal(count[IMPACT_REPORT_TEXTBOOK], 11);
    assert_true(t.rows[0].below && t.summary.reference == 0);
    assert_int_equal(t.rows[0].usage.integrators, 0);
    for (int k = 0; k < t.count; k++)
        if (t.rows[k].method == IMPACT_REPORT_MOTION || t.rows[k].method == IMPACT_REPORT_TEXTBOOK)
            assert_int_equal(t.rows[k].usage.ballistic_flights, 0);
}

/* A run that did not come to the end knows nothing: its error is infinite, and it vouches for nobody. */
static void a_run_that_failed_has_no_error_to_show(void **state)
{
    (void)state;
    bounce_scene s;
    table t;
    make_bounce(&s);
    s.def.max_steps = 5000;
    const double steps[] = {1e-2, 1e-4}; /* 15000 of these */
    const impact_report_def how = {
        .struct_size = sizeof how, .times = TIMES, .rounds = 1, .steps = steps, .step_count = 2};
    get(&s.def, &how, &t);
    const impact_report_row *coarse = NULL, *failed = NULL;
    for (int k = 0; k < t.count; k++) {
        if (t.rows[k].method != IMPACT_REPORT_RK4) continue;
        if (t.rows[k].setting == 1e-2) coarse = &t.rows[k];
        if (t.rows[k].setting == 1e-4) failed = &t.rows[k];
    }
    assert_true(coarse && isfinite(impact_report_worst(coarse->error)));
    assert_true(failed && isinf(failed->error.x) && isinf(failed->error.t) && failed->status == IMPACT_EUNSETTLED);
    assert_true(failed->reached > 0 && failed->reached < s.def.duration);
    assert_non_null(strstr(failed->message, "max_steps"));
    assert_false(failed->below);
    assert_true(t.summary.motion_witness.setting == 1e-2);
}

/* An ellipsoid that bounces without loss, and parts from itself: nothing is compared behind that. */
static void behind_the_horizon_nothing_is_said(void **state)
{
    (void)state;
    bounce_scene s;
    table t;
    make_bounce(&s);
    s.def.force_count = 0;
    impact_shape_ellipsoid(0.1, 0.2, 0.3, &s.bodies[1].shape);
    s.bodies[1].restitution = 1, s.bodies[1].friction = 0.3, s.bodies[0].friction = 1;
    s.bodies[1].omega = (qvec3){1, 2, 3};
    s.def.duration = 25;
    const double tolerances[] = {1e-6, 1e-10}, step = 1e-3;
    const impact_report_def how = {
        sizeof how,           .times = 100,   .rounds = 1,    .seconds = 1e4, .tolerances = tolerances,
        .tolerance_count = 2, .steps = &step, .step_count = 1};
    get(&s.def, &how, &t);
    assert_true(t.summary.horizon > 1 && t.summary.horizon < 25);
    assert_true(t.summary.condition > 1e3);
    assert_at_most(impact_report_worst(t.summary.certainty), 1e-3);
    const impact_report_row *loose = NULL;
    for (int k = 0; k < t.count; k++)
        if (t.rows[k].method == IMPACT_REPORT_MOTION && t.rows[k].setting == 1e-6) loose = &t.rows[k];
    assert_true(loose && impact_report_worst(loose->error) > 1e-3); /* it parted before */
}

/* Bodies in another order: the same methods, errors alike. */
static void swapped_bodies_make_the_same_table(void **state)
{
    (void)state;
    bounce_scene s;
    table one, other;
    make_bounce(&s);
    const impact_report_def how = {.struct_size = sizeof how, .times = TIMES, .rounds = 1};
    get(&s.def, &how, &one);
    const impact_body_def first = s.bodies[0];
    s.bodies[0] = s.bodies[1], s.bodies[1] = first;
    get(&s.def, &how, &other);
    assert_int_equal(one.count, other.count);
    for (int k = 0; k < one.count; k++) {
        const double a = impact_report_worst(one.rows[k].error), b = impact_report_worst(other.rows[k].error);
        assert_true(one.rows[k].method == other.rows[k].method && one.rows[k].setting == other.rows[k].setting);
        assert_true(fabs(a - b) <= 1e-12 + 0.1 * a);
    }
}

/* ---- what it refuses ---- */

static void refuse(const impact_scene_def *def, impact_report_def how, impact_status status, const char *words)
{
    table t;
    const impact_status got = ask(def, &how, &t);
    if (got != status || !strstr(t.message, words)) fail_msg("wanted '%s', got %d '%s'", words, (int)got, t.message);
    assert_int_equal(t.count, 0);
}

static void what_cannot_be_compared_is_said(void **state)
{
    (void)state;
    bounce_scene s;
    make_bounce(&s);
    s.force.function = counting_push;
    refuse(&s.def, (impact_report_def){.struct_size = sizeof(impact_report_def)}, IMPACT_EARGUMENT,
           "force 'push' is not the same in two runs: a report needs laws without memory");
    make_bounce(&s);
    s.def.body_count = 1;
    s.def.force_count = 0;
    refuse(&s.def, (impact_report_def){.struct_size = sizeof(impact_report_def)}, IMPACT_EARGUMENT, "nothing moves");
    s.def.body_count = 2;
    s.bodies[1].position.z = radius;
    refuse(&s.def, (impact_report_def){.struct_size = sizeof(impact_report_def)}, IMPACT_EARGUMENT,
           "nothing moves"); /* it rests from the start */
    s.bodies[1].position.z = 0;
    refuse(&s.def, (impact_report_def){.struct_size = sizeof(impact_report_def)}, IMPACT_EARGUMENT,
           "overlaps"); /* what making the scene says */
}

/* Without a name, behind a force that is not custom; with no laws at all; and with nobody to tell. */
static void what_is_refused_without_a_place_for_words(void **state)
{
    (void)state;
    bounce_scene s;
    impact_force_def forces[2] = {impact_default_force_def(IMPACT_FORCE_WIND)};
    const impact_report_def how = {.struct_size = sizeof how};
    make_bounce(&s);
    s.force.function = counting_push, s.force.name = NULL;
    forces[1] = s.force;
    s.def.forces = forces, s.def.force_count = 2;
    refuse(&s.def, how, IMPACT_EARGUMENT, "force '' is not the same in two runs");
    assert_int_equal(impact_report(&s.def, &how, NULL, NULL, NULL, NULL, 0), IMPACT_EARGUMENT);
    char none[1] = {'x'};
    assert_int_equal(impact_report(&s.def, &how, NULL, NULL, NULL, none, 0), IMPACT_EARGUMENT);
    assert_int_equal(none[0], 'x');
    assert_int_equal(impact_report(&s.def, &(impact_report_def){.struct_size = 7}, NULL, NULL, NULL, NULL, 0),
                     IMPACT_EARGUMENT);
}

/* Without a definition all is as by default, a sink is not asked for; and the last time is the duration itself, also
 * where duration times/times is not. */
static void without_a_definition_it_is_the_default(void **state)
{
    (void)state;
    bounce_scene s;
    impact_report_summary summary;
    make_bounce(&s);
    s.def.force_count = 0, s.def.duration = 0.2;
    char message[300];
    if (impact_report(&s.def, NULL, NULL, NULL, &summary, message, sizeof message) != IMPACT_OK)
        fail_msg("%s", message);
    assert_int_equal(summary.times, 48);
    assert_true(summary.sure && summary.horizon == s.def.duration);
}

/* Nothing vouches for what steps move, and no solver beside them is of use where impacts are compliant. */
static void what_has_no_witness_is_not_sure(void **state)
{
    (void)state;
    bounce_scene s;
    table t;
    const double tolerance = 1e-6;
    const impact_report_def how = {
        .struct_size = sizeof how, .times = 6, .rounds = 1, .tolerances = &tolerance, .tolerance_count = 1};
    make_bounce(&s);
    s.def.force_count = 0, s.def.duration = 0.3;
    s.bodies[1].position.z = radius, s.bodies[1].velocity = (qvec3){1, 0, 0}, s.bodies[1].friction = 0.3;
    s.bodies[1].rolling_friction = 0.01, s.bodies[1].restitution = 0;
    impact_shape_ellipsoid(radius, radius, radius, &s.bodies[1].shape);
    s.def.piles = IMPACT_PILES_STEPS;
    get(&s.def, &how, &t);
    assert_false(t.summary.sure);
    assert_true(isinf(impact_report_worst(t.summary.certainty)));
    make_bounce(&s);
    s.def.law = IMPACT_STRONGE, s.def.compliance = 1.2;
    s.def.duration = 0.6;
    get(&s.def, &how, &t);
    assert_true(t.summary.useless[IMPACT_REPORT_IMPACTS]);
}

static void numbers_out_of_range_are_refused(void **state)
{
    (void)state;
    bounce_scene s;
    make_bounce(&s);
    const double rising[] = {1e-6, 1e-3}, bad[] = {1e-3, 0};
    impact_sample truth[TIMES];
    fill_truth(truth);
    refuse(&s.def, (impact_report_def){.struct_size = sizeof(impact_report_def), .seconds = -1}, IMPACT_EARGUMENT,
           "seconds");
    refuse(&s.def, (impact_report_def){.struct_size = sizeof(impact_report_def), .seconds = NAN}, IMPACT_EARGUMENT,
           "seconds");
    refuse(&s.def, (impact_report_def){.struct_size = sizeof(impact_report_def), .seconds = INFINITY}, IMPACT_EARGUMENT,
           "seconds");
    refuse(&s.def, (impact_report_def){.struct_size = 7}, IMPACT_EARGUMENT, "report: struct_size = 7: ");
    refuse(&s.def, (impact_report_def){.struct_size = sizeof(impact_report_def), .times = -1}, IMPACT_EARGUMENT,
           "times");
    refuse(&s.def, (impact_report_def){.struct_size = sizeof(impact_report_def), .times = 10001}, IMPACT_EARGUMENT,
           "times");
    refuse(&s.def, (impact_report_def){.struct_size = sizeof(impact_report_def), .rounds = 16}, IMPACT_EARGUMENT,
           "rounds");
    refuse(&s.def,
           (impact_report_def){.struct_size = sizeof(impact_report_def), .tolerances = rising, .tolerance_count = 2},
           IMPACT_EARGUMENT, "tolerances");
    refuse(&s.def, (impact_report_def){.struct_size = sizeof(impact_report_def), .steps = bad, .step_count = 2},
           IMPACT_EARGUMENT, "steps");
    refuse(&s.def,
           (impact_report_def){.struct_size = sizeof(impact_report_def), .oracle = truth, .oracle_count = TIMES},
           IMPACT_EARGUMENT, "error");
    const int counts[] = {-1, 1000};
    const double endless[] = {INFINITY, 1};
    for (int k = 0; k < 2; k++) {
        refuse(&s.def, (impact_report_def){.struct_size = sizeof(impact_report_def), .tolerance_count = counts[k]},
               IMPACT_EARGUMENT, "tolerances");
        refuse(&s.def, (impact_report_def){.struct_size = sizeof(impact_report_def), .step_count = counts[k]},
               IMPACT_EARGUMENT, "tolerances");
    }
    refuse(&s.def, (impact_report_def){.struct_size = sizeof(impact_report_def), .steps = endless, .step_count = 2},
           IMPACT_EARGUMENT, "steps");
    refuse(&s.def,
           (impact_report_def){
               .struct_size = sizeof(impact_report_def), .oracle = truth, .oracle_count = 0, .oracle_error = 1e-15},
           IMPACT_EARGUMENT, "every body that moves at each of its times");
    const double kept = truth[3].t;
    truth[3].t = truth[2].t;
    refuse(&s.def,
           (impact_report_def){
               .struct_size = sizeof(impact_report_def), .oracle = truth, .oracle_count = TIMES, .oracle_error = 1e-15},
           IMPACT_EARGUMENT, "order of time and bodies");
    truth[3].t = kept;
    truth[3].body = 0;
    refuse(&s.def,
           (impact_report_def){
               .struct_size = sizeof(impact_report_def), .oracle = truth, .oracle_count = TIMES, .oracle_error = 1e-15},
           IMPACT_EARGUMENT, "order of time and bodies");
    assert_null(impact_report_method_name((impact_report_method)-1));
    assert_null(impact_report_method_name(IMPACT_REPORT_METHODS));
}

static bool refuse_row(const impact_report_row *row, void *context)
{
    (void)row, (void)context;
    return false;
}

static bool not_now(void *context)
{
    (void)context;
    return false;
}

static void it_ends_when_it_is_told_to(void **state)
{
    (void)state;
    bounce_scene s;
    table t;
    make_bounce(&s);
    const impact_report_def quick = {.struct_size = sizeof quick, .times = TIMES, .rounds = 1};
    assert_int_equal(impact_report(&s.def, &quick, refuse_row, NULL, NULL, NULL, 0), IMPACT_ESINK);
    assert_int_equal(ask(&s.def, &(impact_report_def){.struct_size = sizeof(impact_report_def), .go_on = not_now}, &t),
                     IMPACT_STOPPED);
    const impact_status status =
        ask(&s.def, &(impact_report_def){.struct_size = sizeof(impact_report_def), .seconds = 0.02}, &t);
    assert_true(status == IMPACT_STOPPED || (status == IMPACT_OK && t.summary.dropped > 0));
    /* rounds of timing give way to the budget: all, those before it ended, one, or none of a setting */
    assert_int_equal(
        ask(&s.def, &(impact_report_def){.struct_size = sizeof(impact_report_def), .seconds = 0.5, .rounds = 15}, &t),
        IMPACT_OK);
    for (int k = 0; k < t.count; k++) {
        const impact_report_row *row = &t.rows[k];
        assert_true(row->rounds >= 0 && row->rounds <= 15);
        assert_true(row->rounds == 0 || (row->cpu > 0 && row->spread >= 1));
    }
}

int main(void)
{
    const struct CMUnitTest always[] = {cmocka_unit_test(numbers_out_of_range_are_refused)};
    const struct CMUnitTest with_cvode[] = {
        cmocka_unit_test(its_certainty_is_no_flattery),
        cmocka_unit_test(its_rows_are_what_they_say),
        cmocka_unit_test(a_flight_in_closed_form_has_one_row),
        cmocka_unit_test(a_run_that_failed_has_no_error_to_show),
        cmocka_unit_test(behind_the_horizon_nothing_is_said),
        cmocka_unit_test(swapped_bodies_make_the_same_table),
        cmocka_unit_test(what_is_refused_without_a_place_for_words),
        cmocka_unit_test(without_a_definition_it_is_the_default),
        cmocka_unit_test(what_has_no_witness_is_not_sure),
        cmocka_unit_test(what_cannot_be_compared_is_said),
        cmocka_unit_test(it_ends_when_it_is_told_to),
    };
    const int failed = impact_has(IMPACT_PART_CVODE) ? cmocka_run_group_tests(with_cvode, NULL, NULL) : 0;
    return failed + (impact_has(IMPACT_PART_CVODE) ? cmocka_run_group_tests(always, NULL, NULL) : 0);
}
