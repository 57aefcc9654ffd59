/* SPDX-License-Identifier: MIT
 *
 * Recorded runs against closed forms, against the scene itself, and against bytes that are no record.
 */
#include "kit/scene_log.h"
#include "kit/seal.h"
#include <impact/impact.h>

#include <float.h>
#include <stdio.h>
#include <unistd.h>

static double uniform(unsigned long long *seed)
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(*seed >> 11) / 9007199254740992.0;
}

/* Runs the scene to its end and opens what it wrote. */
static impact_run *record(impact_scene *scene)
{
    char message[200];
    impact_run_writer *writer;
    impact_run *run;
    const void *bytes;
    size_t size;
    assert_int_equal(impact_run_create(scene, &writer, message, sizeof message), IMPACT_OK);
    const impact_recorder recorder = impact_run_recorder(writer);
    if (impact_scene_run(scene, &recorder) < 0) fail_msg("%s", impact_scene_message(scene));
    assert_int_equal(impact_run_bytes(writer, "end of time", &bytes, &size), IMPACT_OK);
    if (impact_run_read(bytes, size, "test", NULL, &run, message, sizeof message) < 0) fail_msg("%s", message);
    size_t kept;
    assert_memory_equal(impact_run_contents(run, &kept), bytes, size);
    assert_int_equal(kept, size);
    impact_run_discard(writer);
    return run;
}

static impact_body_def brick(void)
{
    impact_body_def body = impact_default_body_def();
    body.name = "brick";
    impact_shape_superquadric(0.3, 0.2, 0.1, 8, 8, 8, &body.shape);
    body.mass = 2;
    body.moments = (qvec3){0.02, 0.05, 0.06};
    body.position = (qvec3){1, 2, 30};
    body.orientation = (quat){0.9, 0.3, -0.2, 0.1};
    return body;
}

static impact_scene_def one_body(const impact_body_def *body, double duration)
{
    impact_scene_def def = impact_default_scene_def();
    def.bodies = body;
    def.body_count = 1;
    def.duration = duration;
    return def;
}

/* ---- closed forms ---- */

static void test_a_parabola_has_two_keys(void **state)
{
    (void)state;
    impact_body_def body = brick();
    body.velocity = (qvec3){3, -2, 7};
    const impact_scene_def def = one_body(&body, 2.5);
    impact_scene *scene = make_scene(&def);
    impact_run *run = record(scene);
    unsigned long long seed = 1;
    assert_int_equal(impact_run_key_count(run, 0), 2);
    for (int i = 0; i < 1000; i++) {
        const double t = 2.5 * uniform(&seed);
        impact_sample s;
        assert_int_equal(impact_run_state(run, 0, t, &s), IMPACT_OK);
        assert_near(s.position.x, 1 + 3 * t, 8 * 9 * DBL_EPSILON);
        assert_near(s.position.z, 30 + 7 * t + 0.5 * def.gravity.z * t * t, 8 * 30 * DBL_EPSILON);
        assert_near(s.velocity.z, 7 + def.gravity.z * t, 1e-13);
        assert_near(qvec3_norm(s.omega), 0, 1e-15);
    }
    impact_run_close(run);
    impact_scene_destroy(scene);
}

/* To the roundings of the angle turned through. */
static void test_a_steady_spin_is_one_key(void **state)
{
    (void)state;
    const double turns = 10, rate = 2 * acos(-1) * turns;
    impact_body_def body = brick();
    body.moments = (qvec3){0.05, 0.05, 0.05};
    body.omega = (qvec3){0, 0.6 * rate, 0.8 * rate};
    const impact_scene_def def = one_body(&body, 1);
    impact_scene *scene = make_scene(&def);
    impact_run *run = record(scene);
    impact_key key;
    assert_int_equal(impact_run_key_count(run, 0), 2); /* and the end */
    assert_int_equal(impact_run_key(run, 0, 0, &key), IMPACT_OK);
    assert_int_equal(key.form, IMPACT_KEY_STEADY);
    unsigned long long seed = 2;
    quat start;
    quat_normalize(body.orientation, &start);
    for (int i = 0; i < 10000; i++) {
        const double t = uniform(&seed), half = 0.5 * rate * t;
        impact_sample s;
        assert_int_equal(impact_run_state(run, 0, t, &s), IMPACT_OK);
        const quat turned = quat_mul((quat){cos(half), 0, 0.6 * sin(half), 0.8 * sin(half)}, start);
        assert_true(2 * quat_norm(quat_sub(s.orientation, turned)) <= 4 * rate * DBL_EPSILON);
        assert_near(s.omega.y, 0.6 * rate, 2 * rate * DBL_EPSILON);
    }
    impact_run_close(run);
    impact_scene_destroy(scene);
}

/* Against the tumble's own formula, and where it is damped against v' = g - k v and the same tumble by a slower clock.
 */
static void test_a_free_flight_is_one_key(void **state)
{
    (void)state;
    const double dampings[] = {0, 0.3};
    impact_body_def body = brick();
    body.omega = (qvec3){0.2, 9, -0.3};
    body.velocity = (qvec3){3, -2, 7};
    for (size_t k = 0; k < sizeof dampings / sizeof *dampings; k++) {
        body.linear_damping = body.angular_damping = dampings[k];
        const impact_scene_def def = one_body(&body, 4);
        const double rate = -log1p(-dampings[k]), g = def.gravity.z;
        impact_scene *scene = make_scene(&def);
        impact_run *run = record(scene);
        impact_tumble tumble;
        impact_sample s;
        unsigned long long seed = 3;
        quat q;
        assert_int_equal(impact_run_key_count(run, 0), 2);
        quat_normalize(body.orientation, &q);
        const qvec3 w = quat_rotate_inverse(q, body.omega), J = body.moments;
        const qvec3 momentum = quat_rotate(q, (qvec3){w.x * J.x, w.y * J.y, w.z * J.z});
        assert_int_equal(impact_tumble_make(J, q, momentum, &tumble), IMPACT_OK);
        for (int i = 0; i < 10000; i++) {
            const double t = 4 * uniform(&seed), clock = rate > 0 ? -expm1(-rate * t) / rate : t;
            const double fall = rate > 0 ? g * (t - clock) / rate : 0.5 * g * t * t;
            assert_int_equal(impact_run_state(run, 0, t, &s), IMPACT_OK);
            const double off = 2 * quat_norm(quat_sub(s.orientation, impact_tumble_at(&tumble, clock)));
            assert_true(off <= 40 * 9 * 4 * DBL_EPSILON);
            assert_near(s.position.x, 1 + 3 * clock, 1e-14);
            assert_near(s.position.z, 30 + 7 * clock + fall, 1e-12);
        }
        impact_run_close(run);
        impact_scene_destroy(scene);
    }
}

/* A ball that slides from rest of its spin, in a line, and rolls: v = v0 - mu g t until 5/7 v0, omega = 5/2 mu g t/r.
 */
static void test_a_roll_is_a_few_keys(void **state)
{
    (void)state;
    impact_body_def bodies[2] = {plane_body("floor", (qvec3){0, 0, 0}, (quat){1, 0, 0, 0}, 0.2, 0),
                                 ball_body("ball", (qvec3){0, 0, 0.3}, 1, 0)};
    bodies[1].velocity = (qvec3){7, 0, 0};
    impact_scene_def def = impact_default_scene_def();
    def.bodies = bodies;
    def.body_count = 2;
    def.duration = 3;
    impact_scene *scene = make_scene(&def);
    impact_run *run = record(scene);
    const double a = -0.2 * def.gravity.z, end = 2 * 7 / (7 * a);
    assert_true(impact_run_key_count(run, 1) <= 5);
    for (int i = 0; i <= 300; i++) {
        impact_sample s;
        const double t = 0.01 * i, slid = fmin(t, end);
        assert_int_equal(impact_run_state(run, 1, t, &s), IMPACT_OK);
        assert_near(s.position.x, 7 * slid - 0.5 * a * slid * slid + 5 * (t - slid), 1e-11);
        assert_near(s.omega.y, 2.5 * a * slid / 0.3, 1e-11);
    }
    impact_run_close(run);
    impact_scene_destroy(scene);
}

/* ---- a scene with everything ---- */

static impact_scene_def ball_on_floor(impact_body_def *bodies, impact_force_def *wind)
{
    bodies[0] = plane_body("floor", (qvec3){0, 0, 0}, (quat){1, 0, 0, 0}, 0.5, 0.8);
    bodies[1] = ball_body("ball", (qvec3){-1, 0, 0.6}, 0.3, 0.6);
    bodies[1].omega = (qvec3){3, 20, 5};
    bodies[1].linear_damping = 0.05;
    *wind = impact_default_force_def(IMPACT_FORCE_WIND);
    wind->name = "wind";
    wind->origin = (qvec3){-1, 0, 0};
    wind->strength = 4;
    wind->reach = 1.5;
    impact_scene_def def = impact_default_scene_def();
    def.name = "ball";
    def.bodies = bodies;
    def.body_count = 2;
    def.forces = wind;
    def.force_count = 1;
    def.duration = 3;
    return def;
}

static void test_states_are_the_scenes_own(void **state)
{
    (void)state;
    if (!impact_has(IMPACT_PART_CVODE)) skip();
    impact_body_def bodies[2];
    impact_force_def wind;
    impact_scene_def def = ball_on_floor(bodies, &wind);
    impact_scene *scene = make_scene(&def), *other;
    impact_run *run = record(scene);
    def.tolerance = 1e-14;
    other = make_scene(&def);
    unsigned long long seed = 4;
    double t = 0;
    for (int i = 0; i < 400; i++) {
        impact_sample wanted, got;
        t += 3.0 / 400 * uniform(&seed);
        assert_true(impact_scene_run_to(other, t, NULL) >= 0);
        assert_int_equal(impact_scene_body(other, 1, &wanted), IMPACT_OK);
        assert_int_equal(impact_run_state(run, 1, t, &got), IMPACT_OK);
        assert_true(qvec3_norm(qvec3_sub(got.position, wanted.position)) <= 1e-9);
        assert_true(2 * quat_norm(quat_sub(got.orientation, wanted.orientation)) <= 1e-9);
        assert_true(qvec3_norm(qvec3_sub(got.velocity, wanted.velocity)) <= 1e-6);
    }
    impact_run_close(run);
    impact_scene_destroy(scene);
    impact_scene_destroy(other);
}

static void test_recording_changes_no_bit(void **state)
{
    (void)state;
    if (!impact_has(IMPACT_PART_CVODE)) skip();
    impact_body_def bodies[2];
    impact_force_def wind;
    const impact_scene_def def = ball_on_floor(bodies, &wind);
    impact_scene *scene = make_scene(&def), *other = make_scene(&def);
    impact_run *run = record(scene);
    assert_true(impact_scene_run(other, NULL) >= 0);
    impact_sample a, b;
    assert_int_equal(impact_scene_body(scene, 1, &a), IMPACT_OK);
    assert_int_equal(impact_scene_body(other, 1, &b), IMPACT_OK);
    assert_memory_equal(&a.position, &b.position, sizeof a.position);
    assert_memory_equal(&a.orientation, &b.orientation, sizeof a.orientation);
    assert_memory_equal(&a.omega, &b.omega, sizeof a.omega);
    assert_int_equal(impact_scene_usage(other).keys, 0);
    impact_run_close(run);
    impact_scene_destroy(scene);
    impact_scene_destroy(other);
}

static void test_events_stand_between_two_keys(void **state)
{
    (void)state;
    if (!impact_has(IMPACT_PART_CVODE)) skip();
    impact_body_def bodies[2];
    impact_force_def wind;
    const impact_scene_def def = ball_on_floor(bodies, &wind);
    impact_scene *scene = make_scene(&def);
    impact_run *run = record(scene);
    int impacts = 0, forces = 0;
    for (long k = 0; k < impact_run_event_count(run); k++) {
        impact_event e;
        impact_sample before, after;
        assert_int_equal(impact_run_event(run, k, &e), IMPACT_OK);
        forces += e.kind == IMPACT_EVENT_FORCE && strcmp(e.name2, "wind") == 0;
        if (e.kind != IMPACT_EVENT_IMPACT) continue;
        impacts++;
        assert_int_equal(impact_run_state_before(run, 1, e.t, &before), IMPACT_OK);
        assert_int_equal(impact_run_state(run, 1, e.t, &after), IMPACT_OK);
        const qvec3 change = qvec3_scale(qvec3_sub(after.velocity, before.velocity), 4);
        assert_true(qvec3_norm(qvec3_sub(change, e.impulse)) <= 8 * 15 * DBL_EPSILON); /* roundings of the momentum */
        assert_true(qvec3_norm(qvec3_sub(after.position, before.position)) <= 1e-13);
        assert_near(before.velocity.z, e.normal_before, 1e-12);
        assert_string_equal(e.name1, "ball");
        assert_string_equal(e.name2, "floor");
    }
    assert_true(impacts > 10);
    assert_int_equal(forces, 1);
    impact_run_close(run);
    impact_scene_destroy(scene);
}

static void test_held_contacts_carry_the_weight(void **state)
{
    (void)state;
    if (!impact_has(IMPACT_PART_CVODE)) skip();
    impact_body_def bodies[2];
    impact_force_def wind;
    const impact_scene_def def = ball_on_floor(bodies, &wind);
    impact_scene *scene = make_scene(&def);
    impact_run *run = record(scene);
    int slips = 0, sticks = 0;
    for (long k = 0; k < impact_run_held_count(run); k++) {
        impact_held c;
        assert_int_equal(impact_run_held(run, k, &c), IMPACT_OK);
        slips += c.mode == IMPACT_HOLD_SLIP;
        sticks += c.mode == IMPACT_HOLD_STICK;
        assert_near(c.force.z, -4 * def.gravity.z, 1e-9);
        assert_near(c.point.z, 0, 1e-9);
        assert_near(c.normal.z, 1, 1e-15);
    }
    assert_true(slips > 0 && sticks > 0);
    impact_energy e = {0};
    double t = 0;
    for (long k = 0; k < impact_run_account_count(run); k++) {
        assert_int_equal(impact_run_account(run, k, &t, &e), IMPACT_OK);
        const double losses = e.damping_loss + e.sliding_loss + e.impact_loss;
        assert_near(e.kinetic + e.potential + losses, e.start + e.force_work + e.drive_work, 1e-9);
    }
    assert_near(t, 3, 0);
    assert_true(e.force_work > 0);
    impact_run_close(run);
    impact_scene_destroy(scene);
}

/* Two boxes that rest on each other: each patch has its four corners once, and they carry what is above. */
static void test_what_rests_has_its_patches(void **state)
{
    (void)state;
    impact_body_def bodies[3] = {plane_body("floor", (qvec3){0, 0, 0}, (quat){1, 0, 0, 0}, 0.5, 0),
                                 ball_body("low", (qvec3){0, 0, 0.1}, 0.5, 0),
                                 ball_body("high", (qvec3){0, 0, 0.3}, 0.5, 0)};
    for (int i = 1; i < 3; i++) impact_shape_box(0.3, 0.2, 0.1, 0, &bodies[i].shape);
    impact_scene_def def = impact_default_scene_def();
    def.bodies = bodies;
    def.body_count = 3;
    def.duration = 2;
    impact_scene *scene = make_scene(&def);
    impact_run *run = record(scene);
    double floor = 0, between = 0;
    assert_int_equal(impact_run_held_count(run), 8);
    for (long k = 0; k < 8; k++) {
        impact_held c;
        assert_int_equal(impact_run_held(run, k, &c), IMPACT_OK);
        assert_int_equal(c.mode, IMPACT_HOLD_STICK);
        const double up = c.body1 == 0 || (c.body1 == 1 && c.body2 == 2) ? -c.force.z : c.force.z;
        *(c.body1 == 0 || c.body2 == 0 ? &floor : &between) += up;
        assert_near(fabs(c.point.x), 0.3, 1e-9);
        assert_near(fabs(c.point.y), 0.2, 1e-9);
    }
    assert_near(floor, -8 * def.gravity.z, 1e-9);
    assert_near(between, -4 * def.gravity.z, 1e-9);
    impact_run_close(run);
    impact_scene_destroy(scene);
}

/* ---- many bodies ---- */

static void test_a_crowd_is_recorded(void **state)
{
    (void)state;
    enum { BALLS = 6 };
    static const char *const names[BALLS] = {"a", "b", "c", "d", "e", "f"};
    impact_body_def bodies[BALLS + 1];
    bodies[0] = plane_body("floor", (qvec3){0, 0, 0}, (quat){1, 0, 0, 0}, 0.5, 1);
    unsigned long long seed = 5;
    for (int i = 0; i < BALLS; i++) {
        bodies[i + 1] = ball_body(names[i], (qvec3){0.7 * i, 0, 0.5 + 0.3 * i}, 0.5, 1);
        bodies[i + 1].velocity = (qvec3){uniform(&seed) - 0.5, 0, 0};
    }
    impact_scene_def def = impact_default_scene_def();
    def.bodies = bodies;
    def.body_count = BALLS + 1;
    def.duration = 3;
    impact_scene *scene = make_scene(&def);
    impact_run *run = record(scene);
    assert_true(impact_scene_usage(scene).events[IMPACT_EVENT_IMPACT] > 10);
    for (int i = 0; i <= BALLS; i++) {
        impact_sample wanted, got;
        assert_int_equal(impact_scene_body(scene, i, &wanted), IMPACT_OK);
        assert_int_equal(impact_run_state(run, i, 3, &got), IMPACT_OK);
        assert_memory_equal(&got.position, &wanted.position, sizeof got.position);
    }
    impact_run_close(run);
    impact_scene_destroy(scene);
}

/* ---- what is no record ---- */

static void refused(const char *bytes, size_t size, const char *wanted)
{
    char message[300] = "";
    impact_run *run;
    assert_int_equal(impact_run_read(bytes, size, "x.run", NULL, &run, message, sizeof message), IMPACT_EARGUMENT);
    assert_null(run);
    assert_string_equal(message, wanted);
}

static void test_damage_is_named(void **state)
{
    (void)state;
    impact_body_def body = brick();
    const impact_scene_def def = one_body(&body, 1);
    impact_scene *scene = make_scene(&def);
    impact_run *run = record(scene);
    size_t size;
    const char *bytes = impact_run_contents(run, &size);
    char *copy = malloc(size);
    static const char sum[] = "'x.run': damaged: its bytes do not give the sum that it ends with";
    static const char cut[] = "'x.run': cut short: 447 of 448 bytes of table 'account'";
    refused("", 0, "'x.run': not a recorded run");
    refused("t,body,x\n", 9, "'x.run': not a recorded run");
    memcpy(copy, bytes, size);
    *strstr(copy, "\"version\":1") = ' ';
    refused(copy, size, "'x.run': its first line is not JSON");
    memcpy(copy, bytes, size);
    strstr(copy, "\"version\":1")[10] = '2';
    refused(copy, size, "'x.run': version 2 is newer than this program (1)");
    const size_t data = (size_t)((char *)memchr(bytes, '\n', size) - bytes) + 1;
    refused(bytes, data + 160, "'x.run': cut short: 160 of 336 bytes of table 'keys'");
    refused(bytes, size - 1, sum), refused(bytes, size - SEAL, sum), refused(bytes, size - SEAL - 1, cut);
    memcpy(copy, bytes, size);
    const double nan = NAN, late = 2;
    memcpy(copy + data + 8, &nan, sizeof nan);
    seal(copy, size);
    refused(copy, size, "'x.run': table 'keys', row 0: x is not a number that a run can have");
    memcpy(copy, bytes, size);
    memcpy(copy + data, &late, sizeof late);
    seal(copy, size);
    refused(copy, size, "'x.run': table 'keys', row 1: t = 1 comes after 2");
    memcpy(copy, bytes, size);
    memcpy(copy + data + 32, &late, sizeof late);
    seal(copy, size);
    refused(copy, size, "'x.run': body 'brick', t = 0: its orientation is not a unit");
    const double form = 3, free_flight = IMPACT_KEY_FREE, fast = 1e149;
    memcpy(copy, bytes, size);
    memcpy(copy + data + 160, &form, sizeof form);
    seal(copy, size);
    refused(copy, size, "'x.run': table 'keys', row 0: its form is damaged");
    memcpy(copy, bytes, size);
    memcpy(copy + data + 160, &free_flight, sizeof free_flight);
    for (int c = 11; c < 14; c++) memcpy(copy + data + 8 * c, &fast, sizeof fast);
    memcpy(strstr(copy, "[0.02,0.05,0.06]"), "[1e300,1e300,9 ]", 16);
    seal(copy, size);
    refused(copy, size, "'x.run': table 'keys', row 0: its form is damaged");
    free(copy);
    impact_sample s;
    assert_int_equal(impact_run_state(run, 0, -1e-9, &s), IMPACT_EARGUMENT);
    assert_int_equal(impact_run_state(run, 0, 1.1, &s), IMPACT_EARGUMENT);
    assert_int_equal(impact_run_state(run, 0, NAN, &s), IMPACT_EARGUMENT);
    assert_int_equal(impact_run_state(run, 1, 0.5, &s), IMPACT_EARGUMENT);
    impact_run_close(run);
    impact_scene_destroy(scene);
}

/* Whichever bit is changed, the sum tells it where nothing else does. */
static void test_no_bit_is_changed_unseen(void **state)
{
    (void)state;
    impact_body_def body = brick();
    const impact_scene_def def = one_body(&body, 1);
    impact_scene *scene = make_scene(&def);
    impact_run *run = record(scene), *other;
    size_t size, by_sum = 0;
    const char *bytes = impact_run_contents(run, &size);
    char *copy = malloc(size), message[300];
    memcpy(copy, bytes, size);
    seal(copy, size);
    assert_memory_equal(copy, bytes, size);
    for (size_t bit = 0; bit < 8 * size; bit++) {
        copy[bit / 8] ^= (char)(1 << bit % 8);
        assert_int_equal(impact_run_read(copy, size, "x.run", NULL, &other, message, sizeof message), IMPACT_EARGUMENT);
        by_sum += strstr(message, "do not give the sum") != NULL;
        copy[bit / 8] ^= (char)(1 << bit % 8);
    }
    assert_true(by_sum > 4 * size);
    free(copy);
    impact_run_close(run);
    impact_scene_destroy(scene);
}

/* An open record answers with finite numbers whatever became of its bytes. */
static void try_bytes(const char *bytes, size_t size)
{
    char message[300] = "";
    impact_run *run;
    const impact_status status = impact_run_read(bytes, size, "x.run", NULL, &run, message, sizeof message);
    assert_true(status == IMPACT_OK || (status == IMPACT_EARGUMENT && message[0]));
    for (int i = 0; run && i < impact_run_body_count(run); i++) {
        const double begin = impact_run_begin(run), end = impact_run_end(run);
        for (int k = 0; k <= 8; k++) {
            impact_sample s;
            const double t = fmin(begin + (end - begin) * k / 8, end);
            assert_int_equal(impact_run_state(run, i, t, &s), IMPACT_OK);
            assert_true(isfinite(s.position.x + s.position.y + s.position.z));
        }
    }
    for (long k = 0; run && k < impact_run_event_count(run); k++) {
        impact_event event;
        assert_int_equal(impact_run_event(run, k, &event), IMPACT_OK);
    }
    impact_run_close(run);
}

static void test_damaged_bytes_are_survived(void **state)
{
    (void)state;
    impact_body_def bodies[2] = {plane_body("floor", (qvec3){0, 0, 0}, (quat){1, 0, 0, 0}, 0.5, 1),
                                 ball_body("ball", (qvec3){0, 0, 1}, 0.5, 0.9)};
    impact_scene_def def = impact_default_scene_def();
    def.bodies = bodies;
    def.body_count = 2;
    def.duration = 1;
    impact_scene *scene = make_scene(&def);
    impact_run *run = record(scene);
    size_t size;
    const char *bytes = impact_run_contents(run, &size);
    char *copy = malloc(size);
    unsigned long long seed = 6;
    for (int i = 0; i < 20000; i++) {
        memcpy(copy, bytes, size);
        const int flips = 1 + (int)(3 * uniform(&seed));
        for (int k = 0; k < flips; k++)
            copy[(size_t)((double)size * uniform(&seed))] ^= (char)(1 << (int)(8 * uniform(&seed)));
        seal(copy, size);
        try_bytes(copy, i % 10 ? size : (size_t)((double)size * uniform(&seed)));
    }
    free(copy);
    impact_run_close(run);
    impact_scene_destroy(scene);
}

static void test_files(void **state)
{
    (void)state;
    impact_body_def body = brick();
    body.trail = (qvec3){0.3, -0.2, 0.1};
    body.torsional_friction = 0.004, body.rolling_friction = 0.002;
    const impact_scene_def def = one_body(&body, 1);
    impact_scene *scene = make_scene(&def);
    impact_run_writer *writer;
    impact_run *run;
    char message[300], path[] = "test_run_XXXXXX";
    assert_int_equal(close(mkstemp(path)), 0);
    assert_int_equal(impact_run_create(scene, &writer, message, sizeof message), IMPACT_OK);
    const impact_recorder recorder = impact_run_recorder(writer);
    assert_int_equal(impact_scene_run(scene, &recorder), IMPACT_OK);
    assert_int_equal(impact_run_save(writer, "end of time", path, NULL, message, sizeof message), IMPACT_OK);
    assert_int_equal(impact_run_open(path, NULL, &run, message, sizeof message), IMPACT_OK);
    assert_string_equal(impact_run_reason(run), "end of time");
    assert_string_equal(impact_run_name(run), "scene");
    assert_int_equal(impact_run_find(run, "brick"), 0);
    impact_body_def back = impact_default_body_def();
    assert_int_equal(impact_run_body(run, 0, &back), IMPACT_OK);
    assert_int_equal(back.shape.kind, body.shape.kind);
    assert_near3((qvec3){back.shape.a, back.shape.b, back.shape.c}, (qvec3){0.3, 0.2, 0.1}, 0);
    assert_near3((qvec3){back.shape.r, back.shape.s, back.shape.t}, (qvec3){8, 8, 8}, 0);
    assert_near3(back.trail, body.trail, 0);
    assert_near(back.torsional_friction, 0.004, 0);
    assert_near(back.rolling_friction, 0.002, 0);
    assert_memory_equal(&back.moments, &body.moments, sizeof back.moments);
    impact_run_close(run);
    remove(path);
    assert_int_equal(impact_run_open(path, NULL, &run, message, sizeof message), IMPACT_ESINK);
    assert_non_null(strstr(message, path));
    assert_int_equal(impact_run_save(writer, "", "no/such/folder.run", NULL, message, sizeof message), IMPACT_ESINK);
    impact_quota quota = {.left = 100};
    assert_int_equal(impact_run_save(writer, "", path, &quota, message, sizeof message), IMPACT_ESINK);
    assert_true(quota.spent && access(path, F_OK) != 0);
    impact_run_discard(writer);
    impact_scene_destroy(scene);
}

/* ---- shapes with faces ---- */

static void test_shapes_with_faces_come_back(void **state)
{
    (void)state;
    const qvec3 corner[5] = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}, {0.1, 0, 0}};
    impact_hull *hull;
    assert_int_equal(impact_hull_create(corner, 5, 0.1, NULL, &hull, NULL, 0), IMPACT_OK);
    for (int kind = 0; kind < 5; kind++) {
        impact_body_def body = brick();
        body.omega = (qvec3){1, 2, 3};
        if (kind == 0) impact_shape_box(0.3, 0.2, 0.1, 0.01, &body.shape);
        if (kind == 1) impact_shape_cylinder(0.3, 0.2, 0.01, &body.shape);
        if (kind == 2) impact_shape_cone(0.3, 0.4, 0.01, &body.shape);
        if (kind == 3) impact_shape_capsule(0.1, 0.2, &body.shape);
        if (kind == 4) assert_int_equal(impact_shape_polyhedron(hull, &body.shape), IMPACT_OK);
        const impact_scene_def def = one_body(&body, 0.5);
        impact_scene *scene = make_scene(&def);
        impact_run *run = record(scene);
        impact_body_def back = impact_default_body_def();
        impact_run_body(run, 0, &back);
        assert_int_equal(back.shape.kind, body.shape.kind);
        assert_true(back.shape.a == body.shape.a && back.shape.c == body.shape.c && back.shape.t == body.shape.t);
        assert_true(back.shape.rounding == body.shape.rounding && back.shape.base == body.shape.base);
        assert_near(impact_shape_volume(&back.shape), impact_shape_volume(&body.shape), 1e-15);
        for (int i = 0; kind == 4 && i < 4; i++)
            assert_true(qvec3_norm(qvec3_sub(impact_hull_vertex(back.shape.hull, i), impact_hull_vertex(hull, i))) ==
                        0);
        impact_run_close(run);
        impact_scene_destroy(scene);
    }
    impact_hull_destroy(hull);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_parabola_has_two_keys),
        cmocka_unit_test(test_shapes_with_faces_come_back),
        cmocka_unit_test(test_a_steady_spin_is_one_key),
        cmocka_unit_test(test_a_free_flight_is_one_key),
        cmocka_unit_test(test_a_roll_is_a_few_keys),
        cmocka_unit_test(test_states_are_the_scenes_own),
        cmocka_unit_test(test_recording_changes_no_bit),
        cmocka_unit_test(test_events_stand_between_two_keys),
        cmocka_unit_test(test_held_contacts_carry_the_weight),
        cmocka_unit_test(test_what_rests_has_its_patches),
        cmocka_unit_test(test_a_crowd_is_recorded),
        cmocka_unit_test(test_damage_is_named),
        cmocka_unit_test(test_no_bit_is_changed_unseen),
        cmocka_unit_test(test_damaged_bytes_are_survived),
        cmocka_unit_test(test_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
