/* SPDX-License-Identifier: MIT
 *
 * Random encounters of the campaign (./run report together) that once found no end, or another in another frame.
 */
#include "kit/near.h"

#include <string.h>
#include <impact/together.h>
#include "kit/encounter_kept.h"

/* Encounters of the campaign (./run report together), answered in eight frames and units: by springs where slip comes
 * all but straight to its stop, so that series of |u_t| went on through it, or begins and stops again in one stride; by
 * Moreau's law where more than one answer is right, and units chose among them; where compression's impulses are not
 * unique, of them one that all come to rest by, with bodies that nothing pushes; where what restitution's parts leave
 * open was told by rounding; and where they are so great that their rounding is all of the residual; by springs where a
 * contact closes beyond a dent that was hardly one; and where slip of 1e-14 leads time, in a measure in which series
 * underflow. */
static void no_frame_or_unit_chooses_the_answer(void **state)
{
    (void)state;
    static const struct {
        uint64_t seed, number;
        impact_together_law law;
        double exponent;
        int least, most;
    } cases[] = {
        {101, 262, IMPACT_TOGETHER_SPRINGS, 1.5, 2, 3},         {102, 1174, IMPACT_TOGETHER_SPRINGS, 1.5, 7, 12},
        {102, 1870, IMPACT_TOGETHER_SPRINGS, 1, 2, 3},          {101, 2848, IMPACT_TOGETHER_SPRINGS, 1, 7, 12},
        {101, 3352, IMPACT_TOGETHER_MOREAU, 0, 2, 3},           {101, 3627, IMPACT_TOGETHER_MOREAU, 0, 4, 6},
        {102, 3651, IMPACT_TOGETHER_MOREAU, 0, 4, 6},           {102, 3430, IMPACT_TOGETHER_MOREAU, 0, 2, 3},
        {102, 3627, IMPACT_TOGETHER_MOREAU, 0, 4, 6},           {101, 4282, IMPACT_TOGETHER_MOREAU, 0, 7, 12},
        {404, 1956, IMPACT_TOGETHER_MOREAU, 0, 4, 6},           {21100000, 11907, IMPACT_TOGETHER_SPRINGS, 1.5, 7, 12},
        {20100000, 11998, IMPACT_TOGETHER_SPRINGS, 1.5, 7, 12}, {21000000, 10721, IMPACT_TOGETHER_SPRINGS, 1.5, 7, 12},
        {20000000, 34969, IMPACT_TOGETHER_MOREAU, 0, 7, 12},    {20000000, 34583, IMPACT_TOGETHER_MOREAU, 0, 7, 12},
        {20000000, 37256, IMPACT_TOGETHER_MOREAU, 0, 7, 12},    {20000000, 37305, IMPACT_TOGETHER_MOREAU, 0, 7, 12}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const encounter_ranges ranges = {cases[k].least, cases[k].most, 10, 0.05, 1e4, 1e4};
        random_stream random = {cases[k].seed + 0x9e3779b97f4a7c15u * cases[k].number};
        const random_encounter e = encounter_draw(&random, &ranges);
        const answer a = solve(&e, cases[k].law, cases[k].exponent, NULL);
        assert_int_equal(a.status, IMPACT_OK);
        /* the last one's impulses are known to 1e-10 of themselves */
        (void)assert_alike_in_frames(&random, 8, &e, cases[k].law, cases[k].exponent, &a,
                                     cases[k].seed == 404 ? 1e-10 : 1e-12);
    }
}

/* Encounters of the campaign (./run report together) that once found no end: slip that begins by and by where the
 * contact is about to open; slip as slow as the rounding of impulses a hundred times the largest momentum; slip that
 * creeps among impulses as great, each step of which began with their rounding; slip that creeps until its contact
 * opens; one that came to an end, but for a contact of no more than rounding, whose friction drove by that; bounces
 * that die out in 106723 steps and events; a pressed few of nine contacts, whose work was counted as that of all; and
 * bounces whose gaps grow from one to the next, beyond 1e308 of their dents, where they were taken to have ended; and
 * slip that creeps beside what swings for ten thousand times as long, off its balance by the rounding of W p, whose
 * terms are four hundred times the velocities: no step was taken to be good enough; bounces of which four thousand
 * leave three parts in four, with rounding that no smaller ratio outweighs; and bounces of two contacts that fall by
 * 3e-4 from round to round, until a third joins after 386046 steps and events. */
static void what_found_no_end_is_answered(void **state)
{
    (void)state;
    static const kept_encounter cases[] = {
        {1, 1192, 1.5, 2, 3},        {1, 433, 1, 4, 6},       {1, 555, 1, 7, 12},      {1, 4055, 1.5, 4, 6},
        {102, 1111, 1.5, 7, 12},     {101, 2857, 1, 7, 12},   {102, 2166, 1, 4, 6},    {905, 341, 1.5, 2, 3},
        {907, 1184, 1.5, 4, 6},      {901, 2839, 1.5, 7, 12}, {904, 2771, 1.5, 7, 12}, {36, 5065, 1, 7, 12},
        {31, 5405, 1, 7, 12},        {603, 5863, 1, 7, 12},   {777, 1829, 1, 7, 12},   {20050000, 3257, 1.5, 2, 3},
        {43400000, 2751, 1.5, 7, 12}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const random_encounter e = draw_kept(cases[k].seed, cases[k].number, cases[k].least, cases[k].most);
        const answer a = solve(&e, IMPACT_TOGETHER_SPRINGS, cases[k].exponent, NULL);
        assert_int_equal(a.status, IMPACT_OK);
        assert_true(a.outcome.residual < 1e-12);
    }
}

/* Groups whose contacts only a motion of a thousandth of their own mobility takes apart: they were told as wedged. */
static void what_comes_loose_is_no_wedge(void **state)
{
    (void)state;
    const encounter_ranges ranges = {7, 12, 10, 0.05, 1e4, 1e4};
    random_stream random = {777 + 0x9e3779b97f4a7c15u * 1829}, other = {1 + 0x9e3779b97f4a7c15u * 720u};
    const random_encounter e = encounter_draw(&random, &ranges), loose = encounter_draw(&other, &ranges);
    const encounter_frame frame = random_frame(&random);
    const random_encounter turned = change_frame(&e, &frame);
    const answer a = solve(&turned, IMPACT_TOGETHER_SPRINGS, 1, NULL),
                 b = solve(&loose, IMPACT_TOGETHER_SPRINGS, 1.5, NULL);
    assert_int_equal(a.status, IMPACT_OK);
    assert_int_equal(b.status, IMPACT_OK);
    assert_at_most(fmax(a.outcome.residual, b.outcome.residual), 1e-12);
}

/* Moreau's problems to whose answers neither the central path leads nor long sweeps: the path on which friction sets in
 * does, of some round folds for hundreds of linear systems; of the last three, of contacts that no motion takes apart,
 * too. */
static void what_no_path_leads_to_is_found(void **state)
{
    (void)state;
    static const struct {
        uint64_t seed, number;
        int least, most;
        impact_law restitution;
    } cases[] = {{902, 17518, 7, 12, IMPACT_POISSON}, {902, 17220, 7, 12, IMPACT_POISSON},
                 {901, 20012, 4, 6, IMPACT_NEWTON},   {1001, 10714, 4, 6, IMPACT_NEWTON},
                 {1001, 11119, 7, 12, IMPACT_NEWTON}, {1002, 11060, 7, 12, IMPACT_NEWTON},
                 {7001, 45554, 2, 3, IMPACT_NEWTON},  {7001, 41001, 7, 12, IMPACT_POISSON},
                 {424242, 16340, 4, 6, IMPACT_NEWTON}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        random_encounter e = draw_kept(cases[k].seed, cases[k].number, cases[k].least, cases[k].most);
        e.restitution = cases[k].restitution;
        const answer a = solve(&e, IMPACT_TOGETHER_MOREAU, 0, NULL);
        assert_int_equal(a.status, IMPACT_OK);
        assert_at_most(a.outcome.residual, 1e-13);
    }
}

static void assert_answered_by_newton(const kept_encounter *cases, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        random_encounter e = draw_kept(cases[k].seed, cases[k].number, cases[k].least, cases[k].most);
        e.restitution = IMPACT_NEWTON;
        const answer a = solve(&e, IMPACT_TOGETHER_MOREAU, 0, NULL);
        assert_int_equal(a.status, IMPACT_OK);
        assert_at_most(a.outcome.residual, 1e-12);
    }
}

/* Newton's problems of the campaign that no other way solves: the path on which friction sets in does where it is
 * followed itself. In steps that went by it at a tenth of e it was lost, or crept. */
static void the_path_on_which_friction_sets_in_is_followed_to_its_end(void **state)
{
    (void)state;
    static const kept_encounter cases[] = {{20000000, 47331, 0, 7, 12}, {20050000, 44223, 0, 4, 6},
                                           {20050000, 48374, 0, 7, 12}, {20050000, 48847, 0, 7, 12},
                                           {21100000, 44734, 0, 4, 6},  {21100000, 46943, 0, 7, 12},
                                           {21100000, 49961, 0, 7, 12}, {21100000, 49978, 0, 7, 12}};
    assert_answered_by_newton(cases, sizeof cases / sizeof *cases);
}

/* Twelve contacts by Moreau's law whose impulses are not unique, twice: the path to those of restitution turns round
 * folds, and its arc length leads no further than to e = 6e-7. In no frame was the first answered, and the second,
 * whose velocities changes of 1e-11 move three times as far, was told as wedged. */
static void a_path_with_folds_is_followed_where_impulses_are_not_unique(void **state)
{
    (void)state;
    static const kept_encounter cases[] = {{42300000, 8892, 0, 7, 12}, {31000000, 4306, 0, 7, 12}};
    static const double off[] = {1e-12, 3e-11};
    random_stream random = {5};
    for (int k = 0; k < 2; k++) {
        const random_encounter e = draw_kept(cases[k].seed, cases[k].number, cases[k].least, cases[k].most);
        const answer a = solve(&e, IMPACT_TOGETHER_MOREAU, 0, NULL);
        assert_int_equal(a.status, IMPACT_OK);
        assert_at_most(assert_alike_in_frames(&random, 4, &e, IMPACT_TOGETHER_MOREAU, 0, &a, off[k]), 1e-14);
    }
}

/* An encounter by Moreau's law with impulses so great, and among themselves so nearly balanced, that what takes their
 * rounding away (encounter_mend.c) changes them by a billionth: friction of what slides has to follow. */
static void friction_follows_what_mends_its_pressure(void **state)
{
    (void)state;
    random_stream random = {5};
    const random_encounter e = draw_kept(20000000, 37034, 7, 12);
    for (int run = 0; run < 8; run++) {
        const encounter_frame frame = random_frame(&random);
        const random_encounter other = change_frame(&e, &frame);
        const answer a = solve(&other, IMPACT_TOGETHER_MOREAU, 0, NULL);
        assert_int_equal(a.status, IMPACT_OK);
        assert_at_most(a.outcome.residual, 1e-14);
    }
}

/* Encounters by Moreau's law whose impulses are 67 times what is exchanged, beside a body that nothing pushes, and ten
 * million times, in a wedge that comes to rest: what a velocity misses is rounding of the greatest impulses, wherever
 * they are, and great impulses tell the ray that they slide on better than the slip they leave. */
static void rounding_of_great_impulses_is_mended_everywhere(void **state)
{
    (void)state;
    random_encounter beside = draw_kept(20530000, 7691, 7, 12);
    beside.restitution = IMPACT_NEWTON;
    const random_encounter cases[] = {draw_kept(40000000, 8746, 7, 12), beside};
    random_stream random = {5};
    for (int k = 0; k < 2; k++) {
        const answer a = solve(&cases[k], IMPACT_TOGETHER_MOREAU, 0, NULL);
        assert_int_equal(a.status, IMPACT_OK);
        assert_at_most(assert_alike_in_frames(&random, 6, &cases[k], IMPACT_TOGETHER_MOREAU, 0, &a, 1e-11), 1e-14);
    }
}

/* Encounters by Moreau's law whose impulses are not unique. Ten contacts that all come to rest: the solver's are up to
 * a million times what is exchanged, in each frame others, and leave it to their rounding; where that was to be
 * balanced too, those of least norm were not found, and velocities were off by up to 3e-11. Nine of three bodies that
 * go on as one: in one frame of four no forces balanced what the solver's left but for rounding; what came back was the
 * rounding of impulses 1e10 times what is exchanged, and velocities were off by up to 3e-8. */
static void impulses_of_least_norm_are_found_among_great_ones(void **state)
{
    (void)state;
    const random_encounter cases[] = {draw_kept(41800000, 8708, 7, 12), draw_kept(43800000, 8370, 7, 12)};
    const double off[] = {3e-13, 1e-14};
    const int frames[] = {60, 40};
    for (int k = 0; k < 2; k++) {
        random_stream random = {5 + (uint64_t)k};
        const answer a = solve(&cases[k], IMPACT_TOGETHER_MOREAU, 0, NULL);
        assert_int_equal(a.status, IMPACT_OK);
        (void)assert_alike_in_frames(&random, frames[k], &cases[k], IMPACT_TOGETHER_MOREAU, 0, &a, off[k]);
    }
}

/* Newton's problems of the campaign with impulses a thousand times what is exchanged, answered to 3e-13 of these: that
 * left velocities of 2e-11 and more in one frame of three. */
static void what_the_solver_leaves_of_great_impulses_is_mended(void **state)
{
    (void)state;
    static const kept_encounter cases[] = {{42000000, 11336, 0, 7, 12}, {42400000, 11783, 0, 7, 12}};
    random_stream random = {5};
    for (int k = 0; k < 2; k++) {
        random_encounter e = draw_kept(cases[k].seed, cases[k].number, cases[k].least, cases[k].most);
        e.restitution = IMPACT_NEWTON;
        const answer a = solve(&e, IMPACT_TOGETHER_MOREAU, 0, NULL);
        assert_int_equal(a.status, IMPACT_OK);
        (void)assert_alike_in_frames(&random, 12, &e, IMPACT_TOGETHER_MOREAU, 0, &a, 1e-11);
    }
}

/* Five contacts by Moreau's law that come to rest, with impulses three hundred times what is exchanged: solved to a
 * part of those, restitution's problem left velocities of 6e-10 in one frame of four. */
static void restitution_is_solved_to_velocities(void **state)
{
    (void)state;
    random_stream random = {5};
    const random_encounter e = draw_kept(41000000, 7770, 4, 6);
    const answer a = solve(&e, IMPACT_TOGETHER_MOREAU, 0, NULL);
    assert_int_equal(a.status, IMPACT_OK);
    assert_at_most(assert_alike_in_frames(&random, 12, &e, IMPACT_TOGETHER_MOREAU, 0, &a, 1e-12), 1e-14);
}

/* An encounter by Moreau's law of nine contacts, five of which press: with parts of nothing in restitution's problem
 * for the others no path led to its answer. Impulses are hundreds of times what is exchanged. */
static void what_did_not_press_has_no_part_in_restitution(void **state)
{
    (void)state;
    random_stream random = {5};
    const random_encounter e = draw_kept(20410000, 5826, 7, 12);
    const answer a = solve(&e, IMPACT_TOGETHER_MOREAU, 0, NULL);
    assert_int_equal(a.status, IMPACT_OK);
    assert_at_most(a.outcome.residual, 1e-12);
    (void)assert_alike_in_frames(&random, 3, &e, IMPACT_TOGETHER_MOREAU, 0, &a, 1e-10);
}

/* Encounters of the campaign to whose answers by Moreau's law no path leads, one with reactions 1e4 times what is
 * exchanged: they are swept to. */
static void what_no_path_leads_to_is_answered(void **state)
{
    (void)state;
    static const struct {
        uint64_t number;
        int least, most;
    } cases[] = {{720, 4, 6}, {2543, 7, 12}, {2686, 7, 12}};
    for (int k = 0; k < 3; k++) {
        const encounter_ranges ranges = {cases[k].least, cases[k].most, 10, 0.05, 1e4, 1e4};
        random_stream random = {1 + 0x9e3779b97f4a7c15u * cases[k].number};
        const random_encounter e = encounter_draw(&random, &ranges);
        const answer a = solve(&e, IMPACT_TOGETHER_MOREAU, 0, NULL);
        assert_int_equal(a.status, IMPACT_OK);
        assert_at_most(a.outcome.residual, 1e-13);
    }
}

/* The same by Newton's law, by sweeps that for a while go by the same each time, as those do that go on for ever. */
static void what_seems_to_go_on_for_ever_is_answered(void **state)
{
    (void)state;
    static const kept_encounter cases[] = {
        {7001, 50498, 0, 4, 6}, {7001, 55019, 0, 7, 12}, {7001, 57857, 0, 7, 12}, {424242, 15105, 0, 4, 6}};
    assert_answered_by_newton(cases, sizeof cases / sizeof *cases);
}

/* By Newton's law speeds are asked for that no bodies have: impulses grew to 1e11 and 1e14, whose rounding hid that
 * contacts which they do not press approach, and an answer was given with them, in each frame another. */
static void impulses_without_end_are_no_answer(void **state)
{
    (void)state;
    static const kept_encounter cases[] = {
        {909, 10337, 0, 4, 6}, {20000000, 40306, 0, 4, 6}, {20000000, 40478, 0, 4, 6}, {20000000, 40546, 0, 4, 6}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        random_encounter e = draw_kept(cases[k].seed, cases[k].number, cases[k].least, cases[k].most);
        e.restitution = IMPACT_NEWTON;
        const answer a = solve(&e, IMPACT_TOGETHER_MOREAU, 0, NULL);
        assert_int_equal(a.status, IMPACT_EUNSETTLED);
        assert_true(a.outcome.wedged >= 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_frame_or_unit_chooses_the_answer),
        cmocka_unit_test(what_found_no_end_is_answered),
        cmocka_unit_test(what_comes_loose_is_no_wedge),
        cmocka_unit_test(what_no_path_leads_to_is_found),
        cmocka_unit_test(friction_follows_what_mends_its_pressure),
        cmocka_unit_test(the_path_on_which_friction_sets_in_is_followed_to_its_end),
        cmocka_unit_test(a_path_with_folds_is_followed_where_impulses_are_not_unique),
        cmocka_unit_test(rounding_of_great_impulses_is_mended_everywhere),
        cmocka_unit_test(impulses_of_least_norm_are_found_among_great_ones),
        cmocka_unit_test(what_the_solver_leaves_of_great_impulses_is_mended),
        cmocka_unit_test(restitution_is_solved_to_velocities),
        cmocka_unit_test(what_did_not_press_has_no_part_in_restitution),
        cmocka_unit_test(what_no_path_leads_to_is_answered),
        cmocka_unit_test(what_seems_to_go_on_for_ever_is_answered),
        cmocka_unit_test(impulses_without_end_are_no_answer),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
