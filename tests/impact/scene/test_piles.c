/* SPDX-License-Identifier: MIT
 *
 * Boxes, cylinders and polyhedra on each other and in boxes (tests/kit/pile_scene.h; ./run report piles: five hundred):
 * those whose steps once gave energy, by restitution at several contacts or by a normal's rate told across a jump of
 * its place; that met what they did not touch, as they glided without friction; that told of losses or reactions what
 * was not so; and a few of each kind. All come to their end, keep their account and do not reach into each other.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>
#include "kit/pile_scene.h"
#include "kit/random_scene.h"

static bool not_for_ever(void *context, double t, double end)
{
    (void)t, (void)end;
    return ++*(long *)context < 100000;
}

static impact_usage run_at(uint64_t seed, int start, double tolerance)
{
    enum { LOOKS = 40 };
    pile_scene pile;
    impact_scene *scene;
    long steps = 0;
    const impact_recorder recorder = {.struct_size = sizeof recorder, .context = &steps, .progress = not_for_ever};
    random_pile_scene(seed, start, &pile);
    pile.def.pile_tolerance = tolerance;
    assert_int_equal(impact_scene_create(&pile.def, &scene, NULL, 0), IMPACT_OK);
    impact_status status = IMPACT_OK;
    for (int k = 1; k <= LOOKS && status == IMPACT_OK; k++) {
        status = impact_scene_run_to(scene, pile.def.duration * k / LOOKS, &recorder);
        assert_true(pile_overlap(&pile, scene) <= 1e-11);
    }
    if (status != IMPACT_OK && status != IMPACT_AT_REST)
        fail_msg("seed %lu, %s: %s %s", (unsigned long)seed, pile_start_name(start), impact_status_string(status),
                 impact_scene_message(scene));
    const impact_energy e = impact_scene_energy(scene);
    const double off = e.start - e.kinetic - e.potential - e.sliding_loss - e.impact_loss;
    assert_true(fabs(off) <= 1e-9 * fabs(e.start));
    assert_true(e.impact_loss + e.sliding_loss >= -1e-4 * fabs(e.start));
    const impact_usage usage = impact_scene_usage(scene);
    impact_scene_destroy(scene);
    pile_scene_end(&pile);
    return usage;
}

/* With steps by which what these were kept for is met. */
static impact_usage run(uint64_t seed, int start) { return run_at(seed, start, 1e-4); }

static impact_usage run_coarse(uint64_t seed, int start) { return run_at(seed, start, 1e-3); }

static void test_bounces_give_no_energy(void **state)
{
    (void)state;
    run(1009, PILE_SET);
    run(3015, PILE_SET);
    run(1005, PILE_IN_BOX);
    run(1023, PILE_IN_BOX);
}

/* A disc that a border cuts, or leans, is lowest between two of its rim's points: it reached nanometres into what it
 * lies on. */
static void test_discs_are_parted_between_their_points(void **state)
{
    (void)state;
    run(34, PILE_SET);
    run(5030, PILE_SET);
    run(1087, PILE_IN_BOX); /* an edge over a rim: two normals take turns, and each parts what the other left by half */
}

/* A polyhedron stands on one corner and leans with another against a wall, which slides along it until a third reaches
 * it: that is an impact. Held as a whole the pair went on at the third corner's velocity, and lost what that takes. */
static void test_what_leans_is_held_at_its_corner(void **state)
{
    (void)state;
    run(1108, PILE_IN_BOX);
}

/* Its own friction brakes what slides on the floor, so that what flies behind it comes to press on it: a bounce lower
 * than what touches is none. Some thousand were answered, one by one. */
static void test_what_slides_is_pressed_from_behind(void **state)
{
    (void)state;
    assert_true(run(6453, PILE_SET).encounters < 100);
    assert_true(run(6272, PILE_IN_BOX).encounters < 200);
}

/* A piece strikes a wall where a step begins, and goes on towards another pile: sought from the velocity before, it was
 * found a tenth of a millimetre inside. */
static void test_what_strikes_at_the_begin_has_struck(void **state)
{
    (void)state;
    run(9014, PILE_IN_BOX);
}

static bool count_key(void *context, const impact_key *key)
{
    return isfinite(key->position.x) && ++*(long *)context > 0;
}

/* A step is a polynomial, which a key or two tell to the last digit: but for what its momentum and its turning were not
 * the same within it, and a step cut by a look took thousands. */
static void test_steps_take_few_keys(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed < 14; seed += 3) {
        pile_scene pile;
        impact_scene *scene;
        long keys = 0;
        const impact_recorder recorder = {.struct_size = sizeof recorder, .context = &keys, .key = count_key};
        random_pile_scene(seed, PILE_SET, &pile);
        pile.def.pile_tolerance = 1e-4;
        pile.def.duration = 0.2;
        assert_int_equal(impact_scene_create(&pile.def, &scene, NULL, 0), IMPACT_OK);
        const impact_status status = impact_scene_run(scene, &recorder);
        assert_true(status == IMPACT_OK || status == IMPACT_AT_REST);
        const impact_usage usage = impact_scene_usage(scene);
        assert_true(usage.pile_steps > 0 && usage.keys == keys);
        assert_true(keys <= 3 * (usage.pile_steps + 20) * pile.def.body_count);
        impact_scene_destroy(scene);
        pile_scene_end(&pile);
    }
}

/* In a bounce friction may take more than all impulses do, which is told as theirs together. */
static void test_losses_do_not_fall(void **state)
{
    (void)state;
    run(1038, PILE_IN_BOX);
}

/* A pair whose points had parted was dropped without being searched for again: bodies fell through each other, and were
 * flung apart at kilometres a second. */
static void test_what_parts_is_searched_for(void **state)
{
    (void)state;
    run(3060, PILE_SET);
}

/* What a face ends that was held on corners goes on by steps: its last reactions are no one's. */
static void test_reactions_that_are_past(void **state)
{
    (void)state;
    run(2029, PILE_IN_BOX);
}

/* Two corners come to be held at one instant, and what takes the bounce from the one gave the other, which slid as it
 * was looked at, a slip that it then stuck with: its friction gave energy all along. */
static void test_what_sticks_has_no_slip(void **state)
{
    (void)state;
    run(118, PILE_SET);
}

/* An edge and a cylinder's side cross, all but parallel: their place runs along both at kilometres a second, past their
 * ends within a step, and what its velocity changes by, told at once, gave a body what nothing did. */
static void test_places_that_run_past_their_ends(void **state)
{
    (void)state;
    run(39, PILE_IN_BOX);
}

static void test_normals_that_jump(void **state)
{
    (void)state;
    run(1057, PILE_SET);
    run(6036, PILE_SET);
    run(6004, PILE_DROPPED);
}

/* A cylinder that rolls, struck at both ends at once: slip of 1e-13 of what strikes is none, however it came out. */
static void test_lines_that_roll_are_struck(void **state)
{
    (void)state;
    run(56, PILE_DROPPED);
    run(89, PILE_DROPPED);
}

/* What leans over a wall's foot on the floor was held by the wall's hidden bottom too: no impulses answer that. */
static void test_hidden_bottoms_hold_nothing(void **state)
{
    (void)state;
    run(3008, PILE_IN_BOX);
    run(3068, PILE_IN_BOX);
}

static void test_glides_meet_what_they_touch(void **state)
{
    (void)state;
    run(1010, PILE_DROPPED);
    run(1027, PILE_IN_BOX);
}

/* A bounce on a body that glides, over in a twelfth of the step that looked for its end, was followed as a contact:
 * what met lay twenty micrometres within each other by then. */
static void test_small_bounces_on_what_glides_end(void **state)
{
    (void)state;
    run(101, PILE_DROPPED);
    run(204, PILE_IN_BOX);
}

/* A bounce that ends within a step was held open by it, fell on, and was caught by the next: for two seconds, 3600
 * steps. */
static void test_small_bounces_end_within_a_step(void **state)
{
    (void)state;
    assert_true(run(268, PILE_SET).pile_steps < 1500);
}

/* Caught between others a body cannot leave one by as much as restitution tells: no impulses do that. Without
 * restitution the last has some, a thousand times those that no friction asks for. */
static void test_jams_are_answered(void **state)
{
    (void)state;
    run(7065, PILE_IN_BOX);
    run(6035, PILE_IN_BOX);
    run(7130, PILE_DROPPED);
}

/* ---- what bounces in small ---- */

static impact_body_def box_of(const char *name, qvec3 half, qvec3 position, double restitution)
{
    impact_body_def body = impact_default_body_def();
    body.name = name;
    impact_shape_box(half.x, half.y, half.z, 0, &body.shape);
    body.mass = 1;
    body.position = position;
    body.friction = 0.5;
    body.restitution = restitution;
    return body;
}

static bool last_impact(void *context, const impact_event *event)
{
    if (event->body1 > 0 && event->body2 > 0) *(impact_event *)context = *event;
    return true;
}

/* A box comes down on its corner, as it turns, at a micrometre a second on a slab that stands: a bounce that would rise
 * less than the rest height is none. The slab was taken to fall as the box does, and the bounce to rise for ever. */
static void test_bounces_on_what_stands_die_out(void **state)
{
    (void)state;
    const double half = 0.03, corner = half * sqrt(3), turns = 4, tilt = acos(-1 / sqrt(3)), aside = sin(0.5 * tilt);
    impact_body_def bodies[3] = {impact_default_body_def(),
                                 box_of("slab", (qvec3){0.1, 0.1, 0.03}, (qvec3){0, 0, 0.03}, 0.6),
                                 box_of("box", (qvec3){half, half, half}, (qvec3){0, 0, 0.06 + corner}, 0.6)};
    bodies[0].name = "floor";
    bodies[0].is_static = true;
    bodies[0].friction = bodies[0].restitution = 1;
    impact_shape_plane(INFINITY, INFINITY, &bodies[0].shape);
    bodies[2].orientation = (quat){cos(0.5 * tilt), sqrt(0.5) * aside, -sqrt(0.5) * aside, 0};
    bodies[2].omega = (qvec3){0, turns, 0};
    bodies[2].velocity = (qvec3){turns * corner, 0, -1e-6};
    impact_scene_def def = impact_default_scene_def();
    def.gravity = (qvec3){0, 0, -9.81};
    def.bodies = bodies;
    def.body_count = 3;
    def.duration = 1e-3;
    impact_event impact = {.normal_before = 0};
    const impact_recorder recorder = {.struct_size = sizeof recorder, .context = &impact, .event = last_impact};
    impact_scene *scene;
    assert_int_equal(impact_scene_create(&def, &scene, NULL, 0), IMPACT_OK);
    assert_int_equal(impact_scene_run(scene, &recorder), IMPACT_OK);
    assert_true(fabs(impact.normal_before + 1e-6) < 1e-12);
    assert_true(fabs(impact.normal_after) < 1e-15);
    impact_scene_destroy(scene);
}

/* An elastic box in a slot with a play of two micrometres flies between half a million impacts a second: these count
 * as steps of an integrator do, and the count stays with what flies. */
static void test_time_advances(void **state)
{
    (void)state;
    const double half = 0.05, play = 1e-6;
    impact_body_def bodies[3] = {box_of("left", (qvec3){half, 1, 1}, (qvec3){-2 * half - play, 0, 0}, 1),
                                 box_of("right", (qvec3){half, 1, 1}, (qvec3){2 * half + play, 0, 0}, 1),
                                 box_of("box", (qvec3){half, half, half}, (qvec3){0, 0, 0}, 1)};
    bodies[0].is_static = bodies[1].is_static = true;
    bodies[2].velocity = (qvec3){1, 0, 0};
    impact_scene_def def = impact_default_scene_def();
    def.gravity = (qvec3){0, 0, 0};
    def.bodies = bodies;
    def.body_count = 3;
    def.duration = 0.1;
    long calls = 0;
    const impact_recorder recorder = {.struct_size = sizeof recorder, .context = &calls, .progress = not_for_ever};
    impact_scene *scene;
    impact_sample box;
    assert_int_equal(impact_scene_create(&def, &scene, NULL, 0), IMPACT_OK);
    const impact_status status = impact_scene_run(scene, &recorder);
    assert_true(status == IMPACT_OK || status == IMPACT_AT_REST); /* for a step, what is so narrow stops it */
    assert_true(status == IMPACT_OK || impact_scene_usage(scene).pile_steps > 0);
    assert_true(calls < 10000);
    impact_scene_body(scene, 2, &box);
    assert_true(fabs(box.position.x) <= play + 1e-5 * half && fabs(box.velocity.x) <= 1 + 1e-12);
    impact_scene_destroy(scene);
}

static void test_a_few(void **state)
{
    (void)state;
    for (int start = 0; start < PILE_STARTS; start++)
        for (uint64_t seed = 2; seed < 4; seed++) run(seed, start);
}

/* The greatest that any point of a body is off at t, of another scene's. */
static double apart(const pile_scene *pile, const impact_scene *one, const impact_scene *other)
{
    double most = 0;
    for (int i = 0; i < pile->def.body_count; i++) {
        impact_sample a, b;
        impact_scene_body(one, i, &a);
        impact_scene_body(other, i, &b);
        if (pile->bodies[i].is_static) continue;
        const quat turn = quat_mul(a.orientation, quat_conj(b.orientation));
        const double angle = 2 * qvec3_norm((qvec3){turn.x, turn.y, turn.z}),
                     radius = impact_shape_bounding_radius(&pile->bodies[i].shape);
        most = fmax(most, qvec3_norm(qvec3_sub(a.position, b.position)) + radius * angle);
    }
    return most;
}

static impact_scene *scene_at(pile_scene *pile, double tolerance, double t)
{
    impact_scene *scene;
    pile->def.pile_tolerance = tolerance;
    assert_int_equal(impact_scene_create(&pile->def, &scene, NULL, 0), IMPACT_OK);
    assert_int_equal(impact_scene_run_to(scene, t, NULL), IMPACT_OK);
    return scene;
}

/* A cylinder leaves what it rattled on and strikes the floor. By which law it does, that of steps or the exact one, is
 * the same for all tolerances, so that errors fall with them; and for the second run, so that what it tells does. */
static void test_errors_fall_with_the_tolerance(void **state)
{
    (void)state;
    const double t = 0.32, tolerance[] = {1e-5, 1e-6, 1e-7}, most[] = {1.5e-3, 3e-4, 6e-5};
    pile_scene pile;
    random_pile_scene(310331, PILE_DROPPED, &pile);
    impact_scene *finest = scene_at(&pile, 1e-8, t);
    for (int k = 0; k < 3; k++) {
        int small = 0;
        for (int i = -1; i < 2; i++) {
            impact_scene *scene = scene_at(&pile, tolerance[k] * (1 + 0.2 * i), t);
            const double off = apart(&pile, scene, finest), told = impact_scene_pile_error(scene);
            small += off <= most[k] && (k < 2 || told <= 1e-3);
            assert_true(off <= told);
            impact_scene_destroy(scene);
        }
        assert_true(small >= 2); /* of three: which of two corners lands first is chance */
    }
    impact_scene_destroy(finest);
    pile_scene_end(&pile);
}

/* What leaves edge on edge, by some .1 mm/s: along the normal as it was the gap would close at once, and the search
 * went on by hundredths of it. Gaps are counted: the whole scene asks for some thousands. */
static void what_leaves_edge_on_edge_is_not_crept_after(void **state)
{
    (void)state;
    const unsigned long seeds[] = {3032, 6001};
    for (size_t k = 0; k < sizeof seeds / sizeof *seeds; k++) {
        static pile_scene pile;
        random_pile_scene(seeds[k], (int)(seeds[k] % PILE_STARTS), &pile);
        pile.def.pile_tolerance = 1e-4;
        impact_scene *scene;
        assert_int_equal(impact_scene_create(&pile.def, &scene, NULL, 0), IMPACT_OK);
        assert_true(impact_scene_run(scene, NULL) >= 0);
        const impact_usage u = impact_scene_usage(scene);
        const long asked = u.gap_closed_form + u.gap_newton + u.gap_gjk + u.gap_fallback;
        if (asked > 100000) fail_msg("seed %lu: %ld gaps", seeds[k], asked);
        impact_scene_destroy(scene);
        pile_scene_end(&pile);
    }
}

/* A ball that keeps nine tenths of its speed at each bounce comes to rest by steps when they are over, sqrt(2 h/g) (1 +
 * e)/(1 - e) after it is dropped from h, but for those that are lower than a step may err. */
static void what_bounces_high_comes_to_rest(void **state)
{
    (void)state;
    const double height = 0.01, g = 9.81, e = 0.9, over = sqrt(2 * height / g) * (1 + e) / (1 - e);
    impact_body_def bodies[2] = {impact_default_body_def(), impact_default_body_def()};
    bodies[0].name = "floor";
    impact_shape_plane(INFINITY, INFINITY, &bodies[0].shape);
    bodies[1].name = "ball";
    bodies[1].mass = 1;
    impact_shape_sphere(0.1, &bodies[1].shape);
    bodies[1].position.z = 0.1 + height;
    bodies[0].is_static = true;
    bodies[0].restitution = 1;
    bodies[1].restitution = e;
    impact_scene_def def = impact_default_scene_def();
    def.gravity = (qvec3){0, 0, -g};
    def.bodies = bodies;
    def.body_count = 2;
    def.duration = 4;
    def.piles = IMPACT_PILES_STEPS;
    def.pile_tolerance = 1e-5;
    def.restitution_rule = IMPACT_MINIMUM;
    impact_scene *scene;
    assert_int_equal(impact_scene_create(&def, &scene, NULL, 0), IMPACT_OK);
    assert_int_equal(impact_scene_run(scene, NULL), IMPACT_AT_REST);
    assert_true(fabs(impact_scene_time(scene) - over) < 0.1 * over);
    impact_scene_destroy(scene);
}

/* What overlaps is parted at once with all that is near: of a body between two others, one contact after the other,
 * overlaps grew to centimetres. Two bodies overlap most where an edge stands in a face, of which no corner tells. */
static void what_overlaps_is_parted(void **state)
{
    (void)state;
    run_coarse(635, PILE_DROPPED);
    run_coarse(232, PILE_SET);
    run_coarse(537, PILE_IN_BOX); /* a plate not half as thick as a step may err */
    run_coarse(74, PILE_IN_BOX);  /* by more than eight passes, at 1.05 s */
}

/* Bounces that no impulses hold are lessened until some do. */
static void bounces_that_nothing_holds_are_lessened(void **state)
{
    (void)state;
    run_coarse(3000, PILE_IN_BOX);
}

/* What flies from a pile and lands is as near as steps err: what closing that takes is in the account. */
static void landings_after_steps_are_booked(void **state)
{
    (void)state;
    run_coarse(914, PILE_DROPPED);
    run_coarse(804, PILE_IN_BOX);
}

/* A step whose places err by less than they may, but which gives bodies energy, .17 J at .4845 s, is no step: a shorter
 * one is. */
static void steps_that_give_energy_are_shortened(void **state)
{
    (void)state;
    static random_scene s;
    random_scene_make(708324, &s);
    impact_scene *scene;
    double most = 0;
    assert_int_equal(impact_scene_create(&s.def, &scene, NULL, 0), IMPACT_OK);
    for (int k = 0; k <= 1000; k++) {
        assert_int_equal(impact_scene_run_to(scene, 0.484 + 1e-6 * k, NULL), IMPACT_OK);
        const impact_energy e = impact_scene_energy(scene);
        most = fmax(most, e.impact_loss + e.sliding_loss);
        assert_true(e.impact_loss + e.sliding_loss > most - 0.25);
    }
    assert_true(impact_scene_usage(scene).pile_steps > 0);
    assert_true(impact_scene_run(scene, NULL) >= 0);
    impact_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bounces_give_no_energy),
        cmocka_unit_test(test_discs_are_parted_between_their_points),
        cmocka_unit_test(test_steps_take_few_keys),
        cmocka_unit_test(test_what_leans_is_held_at_its_corner),
        cmocka_unit_test(test_what_slides_is_pressed_from_behind),
        cmocka_unit_test(test_what_strikes_at_the_begin_has_struck),
        cmocka_unit_test(test_losses_do_not_fall),
        cmocka_unit_test(test_reactions_that_are_past),
        cmocka_unit_test(test_what_parts_is_searched_for),
        cmocka_unit_test(test_what_sticks_has_no_slip),
        cmocka_unit_test(test_places_that_run_past_their_ends),
        cmocka_unit_test(test_normals_that_jump),
        cmocka_unit_test(test_lines_that_roll_are_struck),
        cmocka_unit_test(test_hidden_bottoms_hold_nothing),
        cmocka_unit_test(test_glides_meet_what_they_touch),
        cmocka_unit_test(test_small_bounces_on_what_glides_end),
        cmocka_unit_test(test_small_bounces_end_within_a_step),
        cmocka_unit_test(test_jams_are_answered),
        cmocka_unit_test(test_bounces_on_what_stands_die_out),
        cmocka_unit_test(what_bounces_high_comes_to_rest),
        cmocka_unit_test(what_overlaps_is_parted),
        cmocka_unit_test(bounces_that_nothing_holds_are_lessened),
        cmocka_unit_test(landings_after_steps_are_booked),
        cmocka_unit_test(steps_that_give_energy_are_shortened),
        cmocka_unit_test(test_time_advances),
        cmocka_unit_test(test_errors_fall_with_the_tolerance),
        cmocka_unit_test(what_leaves_edge_on_edge_is_not_crept_after),
        cmocka_unit_test(test_a_few),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
