/* SPDX-License-Identifier: MIT
 *
 * Scenes of many bodies: moved each for itself as moved together; momentum, energy, no overlap, the order of the rows.
 */
#include <math.h>
#include <stdio.h>
#include <impact/gap.h>
#include "kit/scene_log.h"

enum { BALLS = 24, WALLS = 5, MOST_BODIES = 80 };

static const double radius = 0.08;

typedef struct box_scene {
    char names[MOST_BODIES][16];
    impact_body_def bodies[MOST_BODIES];
    impact_force_def nothing;
    impact_scene_def def;
} box_scene;

/* In [0, 1); Park and Miller's. */
static double draw(unsigned long *seed)
{
    *seed = (*seed * 16807) % 2147483647;
    return (double)*seed / 2147483647;
}

static impact_body_def small_ball(box_scene *s, int i, qvec3 position, double friction, double restitution)
{
    snprintf(s->names[i], sizeof s->names[i], "ball %d", i);
    impact_body_def body = ball_body(s->names[i], position, friction, restitution);
    impact_shape_sphere(radius, &body.shape);
    body.mass = NAN;
    return body;
}

/* A floor and four walls, 1 m apart, and balls above the floor. */
static box_scene *make_box(int balls, double friction, double restitution)
{
    box_scene *s = calloc(1, sizeof *s);
    const double h = sqrt(0.5);
    const qvec3 at[WALLS] = {{0, 0, 0}, {-0.5, 0, 0}, {0.5, 0, 0}, {0, -0.5, 0}, {0, 0.5, 0}};
    const quat turned[WALLS] = {{1, 0, 0, 0}, {h, 0, h, 0}, {h, 0, -h, 0}, {h, -h, 0, 0}, {h, h, 0, 0}};
    const char *const names[WALLS] = {"floor", "west", "east", "south", "north"};
    for (int i = 0; i < WALLS; i++) s->bodies[i] = plane_body(names[i], at[i], turned[i], 1, 1);
    unsigned long seed = 1;
    for (int i = 0; i < balls; i++) {
        const int cell = i % 16;
        const qvec3 x = {(cell % 4 - 1.5) * 0.22 + 0.02 * (draw(&seed) - 0.5),
                         ((cell >> 2) - 1.5) * 0.22 + 0.02 * (draw(&seed) - 0.5),
                         0.3 + (i >> 4) * 0.22 + 0.02 * draw(&seed)};
        s->bodies[WALLS + i] = small_ball(s, WALLS + i, x, friction, restitution);
        s->bodies[WALLS + i].velocity = (qvec3){draw(&seed) - 0.5, draw(&seed) - 0.5, 0};
    }
    s->def = impact_default_scene_def();
    s->def.bodies = s->bodies;
    s->def.body_count = WALLS + balls;
    s->def.friction_rule = s->def.restitution_rule = IMPACT_MINIMUM;
    s->def.duration = 0.7;
    return s;
}

/* Balls without weight that fly at one another. */
static box_scene *make_swarm(double friction, double restitution)
{
    box_scene *s = make_box(0, 0, 0);
    unsigned long seed = 7;
    for (int i = 0; i < BALLS; i++) {
        const qvec3 x = {0.4 * (i % 3) - 0.4 + 0.1 * draw(&seed), 0.4 * (i / 3 % 3) - 0.4 + 0.1 * draw(&seed),
                         0.4 * (i / 9) - 0.4 + 0.1 * draw(&seed)};
        s->bodies[i] = small_ball(s, i, x, friction, restitution);
        s->bodies[i].velocity = qvec3_axpy(0.3, (qvec3){draw(&seed), draw(&seed), draw(&seed)}, qvec3_scale(x, -2));
        s->bodies[i].omega = (qvec3){10 * draw(&seed), 10 * draw(&seed), 10 * draw(&seed)};
    }
    s->def.body_count = BALLS;
    s->def.gravity = (qvec3){0, 0, 0};
    s->def.duration = 1;
    return s;
}

static scene_log run_box(box_scene *s, impact_status expected, impact_energy *energy)
{
    impact_scene *scene = make_scene(&s->def);
    scene_log log = {0};
    const impact_recorder recorder = log_recorder(&log);
    assert_int_equal(impact_scene_run(scene, &recorder), expected);
    if (energy) *energy = impact_scene_energy(scene);
    for (int i = 0; i < log.sample_count; i++) log.samples[i].name = NULL; /* the scene's own */
    for (int i = 0; i < log.event_count; i++) log.events[i].name1 = log.events[i].name2 = NULL;
    impact_scene_destroy(scene);
    return log;
}

/* ---- each for itself as together ---- */

/* A wind that is nowhere keeps the bodies together. */
static void keep_together(box_scene *s)
{
    s->nothing = impact_default_force_def(IMPACT_FORCE_WIND);
    s->nothing.strength = 0;
    s->def.forces = &s->nothing;
    s->def.force_count = 1;
}

static void in_groups_as_together(void **state)
{
    (void)state;
    box_scene *s = make_box(12, 0.3, 0.6);
    s->def.duration = 0.4;
    const scene_log groups = run_box(s, IMPACT_OK, NULL);
    keep_together(s);
    const scene_log together = run_box(s, IMPACT_OK, NULL);
    assert_true(groups.event_count > 20);
    assert_int_equal(groups.event_count, together.event_count);
    for (int i = 0; i < groups.event_count; i++) {
        const impact_event *a = &groups.events[i], *b = &together.events[i];
        assert_int_equal(a->kind, b->kind);
        assert_int_equal(a->body1, b->body1);
        assert_int_equal(a->body2, b->body2);
        assert_near(a->t, b->t, 1e-10);
        assert_near3(a->point, b->point, 1e-9);
        assert_near(a->impulse_normal, b->impulse_normal, 1e-8);
        assert_near(a->energy_before, b->energy_before, 1e-9);
        assert_near(a->energy_after, b->energy_after, 1e-9);
    }
    assert_int_equal(groups.sample_count, together.sample_count);
    for (int i = 0; i < groups.sample_count; i++) {
        assert_int_equal(groups.samples[i].body, together.samples[i].body);
        assert_near(groups.samples[i].t, together.samples[i].t, 1e-10);
        assert_near3(groups.samples[i].position, together.samples[i].position, 1e-9);
        assert_near3(groups.samples[i].velocity, together.samples[i].velocity, 1e-8);
    }
    free_log((scene_log *)&groups);
    free_log((scene_log *)&together);
    free(s);
}

/* ---- what is kept ---- */

static void momentum_and_energy_are_kept(void **state)
{
    (void)state;
    for (int rough = 0; rough < 2; rough++) {
        box_scene *s = make_swarm(rough ? 0.4 : 0, 1);
        impact_scene *scene = make_scene(&s->def);
        qvec3 p[2] = {{0, 0, 0}, {0, 0, 0}}, l[2] = {{0, 0, 0}, {0, 0, 0}};
        const double density = 1000, mass = density * 4 / 3 * 3.14159265358979323846 * pow(radius, 3);
        for (int end = 0; end < 2; end++) {
            for (int i = 0; i < BALLS; i++) {
                impact_sample at;
                assert_int_equal(impact_scene_body(scene, i, &at), IMPACT_OK);
                p[end] = qvec3_axpy(mass, at.velocity, p[end]);
                l[end] = qvec3_axpy(mass, qvec3_cross(at.position, at.velocity), l[end]);
                l[end] = qvec3_axpy(0.4 * mass * radius * radius, at.omega, l[end]);
            }
            if (end == 0) assert_int_equal(impact_scene_run(scene, NULL), IMPACT_OK);
        }
        const impact_usage usage = impact_scene_usage(scene);
        const impact_energy energy = impact_scene_energy(scene);
        assert_true(usage.events[IMPACT_EVENT_IMPACT] > 30);
        assert_int_equal(usage.integrators, 0);
        assert_near3(p[1], p[0], 1e-12);
        assert_near3(l[1], l[0], 1e-12);
        assert_near(energy.kinetic + energy.impact_loss, energy.start, 1e-11);
        if (rough)
            assert_true(energy.impact_loss > 1);
        else
            assert_near(energy.impact_loss, 0, 1e-11);
        impact_scene_destroy(scene);
        free(s);
    }
}

static void the_rows_are_in_order_and_account_for_the_energy(void **state)
{
    (void)state;
    box_scene *s = make_box(BALLS, 0, 0.8); /* without friction, so that energy changes at impacts alone */
    s->def.output_rate = 100;
    impact_energy energy;
    scene_log log = run_box(s, IMPACT_OK, &energy);
    assert_true(log.event_count > 100);
    for (int i = 1; i < log.sample_count; i++) assert_true(log.samples[i].t >= log.samples[i - 1].t);
    double now = energy.start;
    for (int i = 0; i < log.event_count; i++) {
        if (i > 0) assert_true(log.events[i].t >= log.events[i - 1].t);
        assert_near(log.events[i].energy_before, now, 1e-8);
        now = log.events[i].energy_after;
    }
    assert_near(now, energy.kinetic + energy.potential, 1e-8);
    assert_near(energy.start - energy.impact_loss - energy.sliding_loss, now, 1e-8);
    free_log(&log);
    free(s);
}

/* At every time of the grid all bodies have a row; then no two overlap. */
static void nothing_overlaps(void **state)
{
    (void)state;
    box_scene *s = make_box(BALLS, 0.3, 0.6);
    s->def.output_rate = 256;
    scene_log log = run_box(s, IMPACT_OK, NULL);
    qvec3 x[MOST_BODIES];
    int times = 0;
    for (int i = 0, row = 0; i < log.sample_count; i++) {
        const impact_sample *at = &log.samples[i];
        if (at->body != WALLS + row || at->t != log.samples[i - row].t || at->t * 256 != round(at->t * 256)) {
            row = at->body == WALLS;
            x[at->body] = at->position;
            continue;
        }
        x[at->body] = at->position;
        if (++row < BALLS) continue;
        row = 0;
        times++;
        for (int a = WALLS; a < WALLS + BALLS; a++) {
            const double room = 0.5 - fmax(fabs(x[a].x), fabs(x[a].y)) - radius;
            assert_true(fmin(room, x[a].z - radius) > -1e-12);
            for (int b = WALLS; b < a; b++) assert_true(qvec3_norm(qvec3_sub(x[a], x[b])) - 2 * radius > -1e-12);
        }
    }
    assert_true(times == 180);
    free_log(&log);
    free(s);
}

static void the_same_bits_on_every_run(void **state)
{
    (void)state;
    box_scene *s = make_box(BALLS, 0.3, 0.6);
    scene_log a = run_box(s, IMPACT_OK, NULL), b = run_box(s, IMPACT_OK, NULL);
    assert_int_equal(a.sample_count, b.sample_count);
    assert_int_equal(a.event_count, b.event_count);
    for (int i = 0; i < a.sample_count; i++) {
        assert_true(a.samples[i].t == b.samples[i].t);
        assert_memory_equal(&a.samples[i].position, &b.samples[i].position, sizeof(qvec3));
        assert_memory_equal(&a.samples[i].velocity, &b.samples[i].velocity, sizeof(qvec3));
        assert_memory_equal(&a.samples[i].orientation, &b.samples[i].orientation, sizeof(quat));
    }
    for (int i = 0; i < a.event_count; i++) {
        assert_true(a.events[i].t == b.events[i].t && a.events[i].energy_after == b.events[i].energy_after);
        assert_string_equal(a.phases[i], b.phases[i]);
    }
    free_log(&a);
    free_log(&b);
    free(s);
}

/* ---- chains and clamps ---- */

/* Balls that touch, on a line, their impacts answered one after another in the order of the pairs: the last alone flies
 * off. */
static void a_cradle_of_touching_balls(void **state)
{
    (void)state;
    for (int apart = 0; apart < 2; apart++) {
        box_scene *s = make_box(0, 0, 0);
        for (int i = 0; i < 6; i++) {
            const qvec3 x = {2 * radius * i * (apart ? 1.001 : 1) - (i == 0 ? 0.5 : 0), 0, 0};
            s->bodies[i] = small_ball(s, i, x, 0.3, 1);
        }
        s->bodies[0].velocity = (qvec3){2, 0, 0};
        s->def.together = IMPACT_SCENE_SEQUENCE;
        s->def.body_count = 6;
        s->def.gravity = (qvec3){0, 0, 0};
        s->def.duration = 1;
        scene_log log = run_box(s, IMPACT_OK, NULL);
        int impacts = 0;
        for (int i = 0; i < log.event_count; i++) {
            if (log.events[i].kind != IMPACT_EVENT_IMPACT) continue;
            assert_int_equal(log.events[i].body1, impacts);
            assert_int_equal(log.events[i].body2, impacts + 1);
            impacts++;
        }
        assert_int_equal(impacts, 5);
        for (int i = 0; i < log.sample_count; i++)
            if (log.samples[i].t > 0.9)
                assert_near3(log.samples[i].velocity, (qvec3){log.samples[i].body == 5 ? 2 : 0, 0, 0}, 1e-15);
        free_log(&log);
        free(s);
    }
}

/* Balls in a shaft as wide as two and a bit, dropped on each other. */
static box_scene *make_shaft(int balls, double friction, double restitution)
{
    const double half = 0.25, r = 0.1;
    const qvec3 at[5] = {
        {-0.14, 0, 0.15}, {0.13, 0, 0.2}, {0.01, 0.003, 0.5}, {-0.02, -0.005, 0.8}, {0.02, -0.005, 1.1}};
    box_scene *s = make_box(balls, friction, restitution);
    s->bodies[1].position.x = -half, s->bodies[2].position.x = half;
    s->bodies[3].position.y = -0.11, s->bodies[4].position.y = 0.11;
    for (int i = 0; i < balls; i++) {
        s->bodies[WALLS + i] = small_ball(s, WALLS + i, at[i], friction, restitution);
        impact_shape_sphere(r, &s->bodies[WALLS + i].shape);
    }
    s->def.duration = 4;
    return s;
}

/* Five balls in the shaft: the lower ones are clamped between floor, walls and those above. Impacts one after another
 * go round among them and end together; by Moreau's law they are together from the first. All come to rest; no row of
 * one contact gains energy beyond rounding. */
static void clamped_balls_come_to_rest(void **state)
{
    (void)state;
    const double restitutions[3] = {0, 0.3, 0.5};
    for (int run = 0; run < 6; run++) {
        box_scene *s = make_shaft(5, 0, restitutions[run / 2]);
        const char *law = run % 2 ? "together" : "moreau";
        if (run % 2) s->def.together = IMPACT_SCENE_SEQUENCE;
        impact_energy energy;
        scene_log log = run_box(s, IMPACT_AT_REST, &energy);
        int together = 0;
        for (int i = 0; i < log.event_count; i++) {
            together += strcmp(log.phases[i], law) == 0;
            if (i > 0 && log.events[i].encounter == 0)
                assert_at_most(log.events[i].energy_after, log.events[i].energy_before + 1e-11);
            assert_true(log.events[i].impulse_normal >= 0);
        }
        assert_true(together > 0);
        assert_near(energy.kinetic + energy.potential + energy.impact_loss + energy.sliding_loss, energy.start, 1e-8);
        assert_near(energy.kinetic, 0, 1e-15);
        free_log(&log);
        free(s);
    }
}

/* With friction they slide and stick on each other until they jam: slip begins and dies out on many contacts at once.
 */
static void rough_clamped_balls_come_to_rest(void **state)
{
    (void)state;
    box_scene *s = make_shaft(3, 0.3, 0);
    impact_energy energy;
    scene_log log = run_box(s, IMPACT_AT_REST, &energy);
    assert_true(find_event(&log, IMPACT_EVENT_SLIP, NULL, 0) >= 0);
    for (int i = 0; i < log.event_count; i++) assert_true(log.events[i].impulse_normal >= 0);
    assert_near(energy.kinetic + energy.potential + energy.impact_loss + energy.sliding_loss, energy.start, 1e-8);
    assert_near(energy.kinetic, 0, 1e-15);
    assert_true(energy.sliding_loss > 0);
    free_log(&log);
    free(s);
}

/* ---- stopping ---- */

typedef struct stopper {
    scene_log log;
    int left;
} stopper;

static bool stop_after(void *context, const impact_event *event)
{
    stopper *s = context;
    log_event(&s->log, event);
    return --s->left != 0;
}

/* A run that its recorder stopped goes on with the very next row. */
static void stopped_and_run_on(void **state)
{
    (void)state;
    box_scene *s = make_box(BALLS, 0, 1);
    s->def.duration = 0.5;
    const scene_log whole = run_box(s, IMPACT_OK, NULL);
    impact_scene *scene = make_scene(&s->def);
    stopper half = {.left = whole.event_count / 2};
    const impact_recorder recorder = {.struct_size = sizeof recorder, .context = &half, .event = stop_after};
    assert_int_equal(impact_scene_run(scene, &recorder), IMPACT_ESINK);
    assert_int_equal(half.log.event_count, whole.event_count / 2);
    assert_int_equal(impact_scene_run(scene, &recorder), IMPACT_OK);
    assert_int_equal(half.log.event_count, whole.event_count);
    for (int i = 0; i < whole.event_count; i++) {
        assert_int_equal(half.log.events[i].body1, whole.events[i].body1);
        assert_near(half.log.events[i].t, whole.events[i].t, 1e-10);
    }
    impact_scene_destroy(scene);
    free_log(&half.log);
    free_log((scene_log *)&whole);
    free(s);
}

static void the_event_limit_holds(void **state)
{
    (void)state;
    box_scene *s = make_box(BALLS, 0, 1);
    s->def.max_events = 10;
    impact_scene *scene = make_scene(&s->def);
    assert_int_equal(impact_scene_run(scene, NULL), IMPACT_EVENT_LIMIT);
    assert_true(impact_scene_time(scene) < 0.7);
    assert_non_null(strstr(impact_scene_message(scene), "the limit"));
    impact_scene_destroy(scene);
    free(s);
}

/* Eight ellipsoids fall on each other. Two that stand on the floor come to where one slips while they are apart, and
 * draws near, and sticks while they touch, and goes off: a thousand impacts in a millionth of a second, again and
 * again, and never more than two contacts held, so that it was taken for no pile. */
static void what_chatters_goes_by_steps(void **state)
{
    (void)state;
    enum { COUNT = 8 };
    static char names[COUNT][8];
    impact_body_def bodies[1 + COUNT];
    for (int i = 0; i <= COUNT; i++) bodies[i] = impact_default_body_def();
    bodies[0].name = "floor";
    bodies[0].is_static = true;
    bodies[0].friction = 0.5;
    impact_shape_plane(INFINITY, INFINITY, &bodies[0].shape);
    for (int i = 1; i <= COUNT; i++) {
        const double length = sqrt(5 + i * i);
        impact_body_def *body = &bodies[i];
        snprintf(names[i - 1], sizeof names[0], "%d", i);
        body->name = names[i - 1];
        body->friction = 0.8;
        impact_shape_ellipsoid(0.05, 0.06, 0.08, &body->shape);
        body->position = (qvec3){0.03 * sin(i) + 9e-3 * (i % 3 - 1), 0.03 * cos(i), 0.2 * i};
        body->orientation =
            (quat){cos(0.5 * i), sin(0.5 * i) / length, sin(0.5 * i) * i / length, sin(0.5 * i) * 2 / length};
    }
    impact_scene_def def = impact_default_scene_def();
    def.gravity = (qvec3){0, 0, -9.81};
    def.bodies = bodies;
    def.body_count = 1 + COUNT;
    def.duration = 0.6;
    def.max_events = 20000;
    impact_scene *scene = make_scene(&def);
    assert_int_equal(impact_scene_run(scene, NULL), IMPACT_OK);
    const impact_usage usage = impact_scene_usage(scene);
    assert_true(usage.pile_steps > 0 && usage.events[IMPACT_EVENT_IMPACT] < 3000);
    impact_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest closed_forms[] = {
        cmocka_unit_test(momentum_and_energy_are_kept),
        cmocka_unit_test(stopped_and_run_on),
        cmocka_unit_test(the_event_limit_holds),
    };
    const struct CMUnitTest integrated[] = {
        cmocka_unit_test(in_groups_as_together),
        cmocka_unit_test(the_rows_are_in_order_and_account_for_the_energy),
        cmocka_unit_test(nothing_overlaps),
        cmocka_unit_test(what_chatters_goes_by_steps),
        cmocka_unit_test(a_cradle_of_touching_balls),
        cmocka_unit_test(clamped_balls_come_to_rest),
        cmocka_unit_test(rough_clamped_balls_come_to_rest),
        cmocka_unit_test(the_same_bits_on_every_run),
    };
    const int failed = cmocka_run_group_tests(closed_forms, NULL, NULL);
    if (!impact_has(IMPACT_PART_CVODE)) return failed;
    return failed + cmocka_run_group_tests(integrated, NULL, NULL);
}
