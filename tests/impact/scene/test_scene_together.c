/* SPDX-License-Identifier: MIT
 *
 * Scenes whose contacts are struck at one instant, answered together: against answers known in closed form or to many
 * digits (docs/together.md), in any order of the definition.
 */
#include <math.h>
#include "kit/islands.h"
#include "kit/contact_random.h"
#include "base/tolerances.h"
#include "scene/stepped.h"

static const double radius = 0.3;

static impact_body_def smooth_ball(const char *name, qvec3 position, qvec3 velocity)
{
    impact_body_def body = ball_body(name, position, 0, 1);
    body.velocity = velocity;
    return body;
}

static impact_scene_def scene_of(const impact_body_def *bodies, int count, impact_scene_together together)
{
    impact_scene_def def = impact_default_scene_def();
    def.gravity = (qvec3){0, 0, 0};
    def.bodies = bodies;
    def.body_count = count;
    def.duration = 0.1;
    def.law = together == IMPACT_SCENE_SPRINGS ? IMPACT_STRONGE : IMPACT_POISSON;
    def.together = together;
    return def;
}

static void run_scene(const impact_scene_def *def, scene_log *log, impact_sample *ends)
{
    impact_scene *scene = make_scene(def);
    const impact_recorder recorder = log_recorder(log);
    assert_int_equal(impact_scene_run(scene, &recorder), IMPACT_OK);
    for (int i = 0; i < def->body_count; i++) assert_int_equal(impact_scene_body(scene, i, &ends[i]), IMPACT_OK);
    const impact_energy e = impact_scene_energy(scene);
    assert_near(e.kinetic + e.impact_loss, e.start, 1e-13 * e.start);
    impact_scene_destroy(scene);
}

/* Bernoulli: a ball that meets two at once, 30 degrees to either side of its way, turns back at a fifth of its speed,
 * whatever the order of the definition. */
static void a_ball_meets_two(void **state)
{
    (void)state;
    static const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    const double c = 2 * radius * cos(M_PI / 6), s = 2 * radius * sin(M_PI / 6);
    const impact_body_def all[3] = {smooth_ball("striker", (qvec3){-0.05, 0, 0}, (qvec3){1, 0, 0}),
                                    smooth_ball("left", (qvec3){c, s, 0}, (qvec3){0, 0, 0}),
                                    smooth_ball("right", (qvec3){c, -s, 0}, (qvec3){0, 0, 0})};
    for (int law = IMPACT_SCENE_SPRINGS; law <= IMPACT_SCENE_MOREAU; law++)
        for (int k = 0; k < 6; k++) {
            impact_body_def bodies[3];
            impact_sample ends[3];
            scene_log log = {0};
            for (int i = 0; i < 3; i++) bodies[i] = all[orders[k][i]];
            const impact_scene_def def = scene_of(bodies, 3, (impact_scene_together)law);
            run_scene(&def, &log, ends);
            const int first = find_event(&log, IMPACT_EVENT_IMPACT, NULL, 0),
                      second = find_event(&log, IMPACT_EVENT_IMPACT, NULL, 1);
            assert_true(first >= 0 && second >= 0 && find_event(&log, IMPACT_EVENT_IMPACT, NULL, 2) < 0);
            assert_true(log.events[first].t == log.events[second].t);
            assert_true(log.events[first].encounter == 1 && log.events[second].encounter == 1);
            for (int i = 0; i < 3; i++) {
                const qvec3 v = ends[i].velocity;
                const double side = orders[k][i] == 1 ? 1 : -1;
                if (orders[k][i] == 0)
                    assert_near3(v, (qvec3){-0.2, 0, 0}, 1e-12);
                else
                    assert_near3(v, (qvec3){0.6, side * 0.6 * tan(M_PI / 6), 0}, 1e-12);
            }
            free_log(&log);
        }
}

/* A ball into two that touch: Hertz's springs send it back (the digits: many_contacts in docs/together.md); after
 * Moreau's law the two go on together. */
static void a_cradle(void **state)
{
    (void)state;
    if (!impact_has(IMPACT_PART_CVODE)) skip();
    const impact_body_def bodies[3] = {smooth_ball("striker", (qvec3){-2 * radius - 0.05, 0, 0}, (qvec3){1, 0, 0}),
                                       smooth_ball("middle", (qvec3){0, 0, 0}, (qvec3){0, 0, 0}),
                                       smooth_ball("end", (qvec3){2 * radius, 0, 0}, (qvec3){0, 0, 0})};
    impact_sample ends[3];
    scene_log log = {0};
    impact_scene_def def = scene_of(bodies, 3, IMPACT_SCENE_SPRINGS);
    run_scene(&def, &log, ends);
    assert_near(ends[0].velocity.x, -0.0710, 5e-5);
    assert_near(ends[1].velocity.x, 0.0764, 5e-5);
    assert_near(ends[2].velocity.x, 0.9945, 1e-4);
    free_log(&log);
    def = scene_of(bodies, 3, IMPACT_SCENE_SEQUENCE);
    run_scene(&def, &log, ends);
    assert_near(ends[0].velocity.x, 0, 1e-15);
    assert_near(ends[2].velocity.x, 1, 1e-15);
    for (int k = 0; k < log.event_count; k++) assert_int_equal(log.events[k].encounter, 0);
    free_log(&log);
    def = scene_of(bodies, 3, IMPACT_SCENE_MOREAU);
    run_scene(&def, &log, ends);
    assert_near(ends[0].velocity.x + ends[1].velocity.x + ends[2].velocity.x, 1, 1e-13);
    assert_true(ends[0].velocity.x < 0 && ends[1].velocity.x <= ends[2].velocity.x + 1e-12);
    free_log(&log);
}

static void laws_that_do_not_fit_are_refused(void **state)
{
    (void)state;
    const impact_body_def body = smooth_ball("ball", (qvec3){0, 0, 0}, (qvec3){0, 0, 0});
    char message[256];
    impact_scene *scene;
    impact_scene_def def = scene_of(&body, 1, IMPACT_SCENE_SPRINGS);
    def.law = IMPACT_POISSON;
    assert_int_equal(impact_scene_create(&def, &scene, message, sizeof message), IMPACT_EARGUMENT);
    assert_non_null(strstr(message, "stronge"));
    def.law = IMPACT_STRONGE;
    def.together = IMPACT_SCENE_MOREAU;
    assert_int_equal(impact_scene_create(&def, &scene, message, sizeof message), IMPACT_EARGUMENT);
    assert_non_null(strstr(message, "\"poisson\" or \"newton\""));
    def.together = (impact_scene_together)9;
    assert_int_equal(impact_scene_create(&def, &scene, message, sizeof message), IMPACT_EARGUMENT);
}

/* A ball falls into a groove of 60 degrees whose friction, 3, locks it: springs find no end to that, and are asked once
 * in that instant, which is then answered one contact after the other. The message names a pair. */
static void what_is_locked_is_answered_one_after_another(void **state)
{
    (void)state;
    const double half = M_PI / 6; /* planes 60 degrees steep, either way */
    impact_body_def bodies[3] = {ball_body("ball", (qvec3){0, 0, 2 * radius + 0.1}, 3, 0.5),
                                 plane_body("left", (qvec3){0, 0, 0}, (quat){cos(half), 0, sin(half), 0}, 3, 0.5),
                                 plane_body("right", (qvec3){0, 0, 0}, (quat){cos(half), 0, -sin(half), 0}, 3, 0.5)};
    impact_scene_def def = scene_of(bodies, 3, IMPACT_SCENE_SPRINGS);
    bodies[0].velocity.z = -1;
    def.duration = 0.15;
    impact_scene *scene = make_scene(&def);
    const impact_status status = impact_scene_run(scene, NULL);
    const impact_usage usage = impact_scene_usage(scene);
    assert_true(status == IMPACT_OK);
    assert_int_equal(usage.encounters, 0);
    assert_true(usage.impacts_simultaneous > 0);
    assert_non_null(strstr(impact_scene_message(scene), "springs finds no answer to all together"));
    impact_scene_destroy(scene);
}

/* A light ball between a wall and a heavy one of 100^N times its mass, at one instant, one impact after another: as
 * many as pi has in its first N + 1 digits (Galperin 2003). */
static impact_scene_def wall_and_two(impact_body_def bodies[3], double ratio)
{
    bodies[0] = impact_default_body_def();
    bodies[0].name = "wall";
    bodies[0].is_static = true;
    bodies[0].restitution = 1;
    impact_shape_plane(INFINITY, INFINITY, &bodies[0].shape);
    bodies[1] = smooth_ball("light", (qvec3){0, 0, radius}, (qvec3){0, 0, 0});
    bodies[2] = smooth_ball("heavy", (qvec3){0, 0, 3 * radius}, (qvec3){0, 0, -1});
    bodies[1].mass = 1;
    bodies[2].mass = ratio;
    return scene_of(bodies, 3, IMPACT_SCENE_SEQUENCE);
}

static void impacts_of_an_instant_count_pi(void **state)
{
    (void)state;
    static const long digits[] = {3, 31, 314, 3141, 31415};
    for (int n = 0; n < 5; n++) {
        impact_body_def bodies[3];
        const impact_scene_def def = wall_and_two(bodies, pow(100, n));
        impact_scene *scene = make_scene(&def);
        assert_int_equal(impact_scene_run(scene, NULL), IMPACT_OK);
        assert_int_equal(impact_scene_usage(scene).events[IMPACT_EVENT_IMPACT], digits[n]);
        impact_scene_destroy(scene);
    }
}

static bool few(void *context, double t, double t_end)
{
    (void)t, (void)t_end;
    return ++*(int *)context < 20;
}

/* More than there may be: told with the time. The host is asked meanwhile; what it stops then goes on no more. */
static void impacts_of_an_instant_are_bounded(void **state)
{
    (void)state;
    impact_body_def bodies[3];
    const impact_scene_def def = wall_and_two(bodies, 1e10);
    impact_scene *scene = make_scene(&def);
    assert_int_equal(impact_scene_run(scene, NULL), IMPACT_EUNSETTLED);
    assert_string_equal(impact_scene_message(scene), "100000 impacts in the one instant t = 0 brought no end");
    impact_scene_destroy(scene);
    int calls = 0;
    const impact_recorder recorder = {.struct_size = sizeof recorder, .context = &calls, .progress = few};
    scene = make_scene(&def);
    assert_int_equal(impact_scene_run(scene, &recorder), IMPACT_STOPPED);
    assert_int_equal(calls, 20);
    assert_true(impact_scene_usage(scene).events[IMPACT_EVENT_IMPACT] <= 2000);
    assert_int_equal(impact_scene_run(scene, NULL), IMPACT_EUNSETTLED);
    assert_non_null(strstr(impact_scene_message(scene), "stopped amid an instant"));
    size_t size;
    assert_int_equal(impact_scene_save(scene, NULL, &size), IMPACT_EARGUMENT);
    impact_scene_destroy(scene);
}

/* A box lies along a capsule and is struck from above, without friction: of the capsule's side and the box's face, flat
 * or sharp as roundings had it, Hertz's stiffness was made, and one frame in a hundred gave another answer by .06 m/s.
 */
static void springs_are_as_stiff_in_every_frame(void **state)
{
    (void)state;
    random_stream random = {20};
    qvec3 first[3][2];
    for (int run = 0; run < 2000; run++) {
        const quat frame = run == 0 ? quat_identity() : random_rotation(&random);
        impact_body_def bodies[3];
        const qvec3 places[3] = {{0, 0, 0}, {0.0876, -0.045, 0.15}, {0.0122, -0.0319, 0.3}},
                    speeds[3] = {{0, 0, 0.69}, {0, 0, -0.04}, {0, 0, -1.04}};
        for (int i = 0; i < 3; i++) {
            bodies[i] = smooth_ball("body", quat_rotate(frame, places[i]), quat_rotate(frame, speeds[i]));
            bodies[i].orientation = frame;
            bodies[i].friction = 0, bodies[i].restitution = 0.5 + 0.1 * i;
        }
        assert_int_equal(impact_shape_capsule(0.1, 0.3, &bodies[0].shape), IMPACT_OK);
        bodies[0].orientation = quat_mul(frame, (quat){M_SQRT1_2, 0, M_SQRT1_2, 0});
        assert_int_equal(impact_shape_box(0.3, 0.2, 0.05, 0, &bodies[1].shape), IMPACT_OK);
        assert_int_equal(impact_shape_sphere(0.1, &bodies[2].shape), IMPACT_OK);
        for (int i = 0; i < 3; i++) bodies[i].name = i == 0 ? "capsule" : i == 1 ? "box" : "ball";
        impact_scene_def def = scene_of(bodies, 3, IMPACT_SCENE_SPRINGS);
        def.duration = 1e-9;
        scene_log log = {0};
        impact_sample ends[3];
        run_scene(&def, &log, ends);
        free_log(&log);
        for (int i = 0; i < 3; i++) {
            const qvec3 now[2] = {quat_rotate_inverse(frame, ends[i].velocity),
                                  quat_rotate_inverse(frame, ends[i].omega)};
            for (int k = 0; k < 2; k++) {
                if (run == 0) first[i][k] = now[k];
                assert_at_most(qvec3_norm(qvec3_sub(now[k], first[i][k])), 1e-11);
            }
        }
    }
}

/* A ball falls on a ball that rests on a plane, or did not fall for want of gravity. */
static impact_scene_def ball_on_ball(impact_body_def bodies[3], impact_scene_together together, double gravity,
                                     const double restitution[3])
{
    const double fall = gravity > 0 ? 1 / (2 * gravity) : 0; /* both come at 1 m/s */
    bodies[0] = plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 0, restitution[0]);
    bodies[1] = smooth_ball("low", (qvec3){0, 0, radius}, (qvec3){0, 0, 0});
    bodies[2] = smooth_ball("top", (qvec3){0, 0, 3 * radius + 1e-3}, (qvec3){0, 0, -1});
    if (gravity > 0.1) bodies[2].position.z = 3 * radius + fall, bodies[2].velocity.z = 0;
    for (int i = 1; i < 3; i++) bodies[i].restitution = restitution[i];
    impact_scene_def def = scene_of(bodies, 3, together);
    def.gravity.z = -gravity;
    def.duration = gravity > 0.1 ? sqrt(2 * fall / gravity) + 1e-9 : 2e-3;
    return def;
}

/* What rests on the floor comes back from the blow that it passes on by the floor's restitution, as it does
 * without gravity: of its own it has no bounce, and with the restitution 0 of what does not bounce Hertz's springs, all
 * elastic, lost half the energy, and a millionth of gravity led to another answer than none. */
static void what_rests_comes_back_from_a_blow(void **state)
{
    (void)state;
    static const double mixed[3] = {1, 0.8, 0.3}, elastic[3] = {1, 1, 1};
    for (int law = IMPACT_SCENE_SPRINGS; law <= IMPACT_SCENE_MOREAU; law++) {
        if (law == IMPACT_SCENE_SPRINGS && !impact_has(IMPACT_PART_CVODE)) continue;
        for (int kind = 0; kind < 2; kind++) {
            double free[3] = {0, 0, 0};
            for (int k = 0; k < 3; k++) {
                static const double gravities[3] = {0, 1e-6, 9.81};
                impact_body_def bodies[3];
                const impact_scene_def def =
                    ball_on_ball(bodies, (impact_scene_together)law, gravities[k], kind == 0 ? mixed : elastic);
                impact_scene *scene = make_scene(&def);
                assert_int_equal(impact_scene_run(scene, NULL), IMPACT_OK);
                for (int i = 1; i < 3; i++) {
                    impact_sample end;
                    assert_int_equal(impact_scene_body(scene, i, &end), IMPACT_OK);
                    if (k == 0) free[i] = end.velocity.z;
                    assert_near(end.velocity.z, free[i], 1e-7);
                }
                impact_scene_destroy(scene);
                assert_true(free[1] > 0.1 || free[2] > 0.1);
                if (kind == 1) assert_near(free[1] * free[1] + free[2] * free[2], 1, 1e-12);
            }
        }
    }
}

/* An island of bodies with faces goes by steps after so many events; encounters that take long count as more. */
static void long_encounters_try_patience(void **state)
{
    (void)state;
    impact_body_def bodies[2] = {plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 0.5, 0),
                                 smooth_ball("box", (qvec3){0, 0, 0.1}, (qvec3){0, 0, 0})};
    assert_int_equal(impact_shape_box(0.1, 0.1, 0.1, 0, &bodies[1].shape), IMPACT_OK);
    impact_scene_def def = scene_of(bodies, 2, IMPACT_SCENE_TOGETHER_AUTO);
    def.gravity.z = -9.81;
    impact_scene *scene = make_scene(&def);
    imp_island *island = whole_island(scene);
    long asked = 0;
    for (island->strides = 1000L * IMP_EVENT_STRIDES; !imp_island_loses_patience(island, 0, false); asked++)
        island->strides = 1000L * IMP_EVENT_STRIDES;
    assert_int_equal(asked, IMP_FACES_PATIENCE / 1001);
    impact_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(long_encounters_try_patience),
        cmocka_unit_test(impacts_of_an_instant_count_pi),
        cmocka_unit_test(impacts_of_an_instant_are_bounded),
        cmocka_unit_test(a_ball_meets_two),
        cmocka_unit_test(a_cradle),
        cmocka_unit_test(springs_are_as_stiff_in_every_frame),
        cmocka_unit_test(what_rests_comes_back_from_a_blow),
        cmocka_unit_test(laws_that_do_not_fit_are_refused),
        cmocka_unit_test(what_is_locked_is_answered_one_after_another),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
