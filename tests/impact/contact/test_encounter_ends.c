/* SPDX-License-Identifier: MIT
 *
 * Random encounters of the campaign (./run report together) by springs whose bounces never end, or all but, and wedges:
 * where they end is told, or that they do not.
 */
#include "kit/near.h"

#include <string.h>
#include <impact/together.h>
#include "kit/encounter_kept.h"

/* Encounters of the campaign whose bodies bounce from contact to contact, ever less, each round like the one before:
 * two that once spent the work allowed, and one that came to where its springs count as open, after 45000 steps, with
 * 2e-9 of its speed left; and two of whose two contacts one always presses, which come to rest. */
static void bounces_that_never_end_are_followed_to_their_end(void **state)
{
    (void)state;
    static const kept_encounter cases[] = {{905, 3316, 1, 2, 3},
                                           {906, 1717, 1.5, 4, 6},
                                           {903, 4606, 1, 4, 6},
                                           {35, 5506, 1, 7, 12},
                                           {406, 485, 1.5, 4, 6}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const random_encounter e = draw_kept(cases[k].seed, cases[k].number, cases[k].least, cases[k].most);
        const answer a = solve(&e, IMPACT_TOGETHER_SPRINGS, cases[k].exponent, NULL);
        assert_int_equal(a.status, IMPACT_OK);
        assert_at_most(a.outcome.residual, 1e-12);
        assert_true(a.outcome.steps < 40000);
        int closed = 0; /* what bounced stays together */
        for (int i = 0; i < e.meeting_count; i++) closed += fabs(a.meetings[i].normal_after) < 1e-11;
        assert_int_equal(closed, 2);
    }
}

/* The same in no rhythm of their own, or so slowly that no ratio outweighs rounding: of two contacts while a third
 * joins in ever anew, of three that come loose in no direction, of four, two of which slide on, of two that fall by
 * 6e-6 from round to round, and of three and four of which one slides on, turning until the end; the third of those
 * would spend all steps that are allowed before its turn does nothing. Their end's own equations tell it; energies are
 * those that they come to where they are followed until nothing is left, for up to forty-six million steps and events.
 * The last one's slip drives its bounces, which fall no more than it does: all comes apart in the end. */
static void what_bounces_in_no_rhythm_comes_to_rest(void **state)
{
    (void)state;
    static const struct {
        kept_encounter of;
        int closed;
        double energy, off;
    } cases[] = {{{20200000, 5163, 1.5, 4, 6}, 3, 1.7057600824714116, 1e-12},
                 {{21200000, 13845, 1, 2, 3}, 3, 0.75277245328024633, 1e-12},
                 {{20050000, 18316, 1, 4, 6}, 4, 0.80132998504625452, 1e-11},
                 {{21100000, 19464, 1, 4, 6}, 2, 3.4647183320134767, 1e-12},
                 {{20410000, 3759, 1, 7, 12}, 3, 2.2543250815782, 1e-12},
                 {{40000000, 5532, 1, 7, 12}, 3, 2.0108178274829518, 1e-12},
                 {{40900000, 2906, 1.5, 7, 12}, 4, 1.4822896569402304, 1e-12},
                 {{41000000, 5940, 1, 7, 12}, 3, 4.3830740791218, 1e-12},
                 {{7001, 835, 1.5, 2, 6}, 0, 0.010838975502575935, 1e-7}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const kept_encounter *own = &cases[k].of;
        const random_encounter e = draw_kept(own->seed, own->number, own->least, own->most);
        const answer a = solve(&e, IMPACT_TOGETHER_SPRINGS, own->exponent, NULL);
        assert_int_equal(a.status, IMPACT_OK);
        assert_at_most(a.outcome.residual, 1e-12);
        assert_near(a.outcome.energy_after, cases[k].energy, cases[k].off);
        int closed = 0;
        for (int i = 0; i < e.meeting_count; i++) closed += fabs(a.meetings[i].normal_after) < 1e-11;
        assert_int_equal(closed, cases[k].closed);
    }
}

/* Bounces of three contacts that fall by a twentieth in 556 rounds, one of which has just ceased to slide: their ratio
 * tells impulses to come to a part of 2e-4, and where they end. Waited for until they had fallen by more, they were not
 * looked at again before 453749 steps and events, where their end is the same. */
static void bounces_end_once_their_ratio_tells_where(void **state)
{
    (void)state;
    const random_encounter e = draw_kept(44100000, 1974, 4, 6);
    const answer a = solve(&e, IMPACT_TOGETHER_SPRINGS, 1.5, NULL);
    assert_int_equal(a.status, IMPACT_OK);
    assert_at_most(a.outcome.residual, 1e-12);
    assert_near(a.outcome.energy_after, 0.66873336897256, 1e-13);
    assert_true(a.outcome.steps < 200000);
}

/* Two contacts of two bodies that stick and slip by turns, hundreds of times, while a spring that loses nothing lets
 * go: each was taken to have stopped where it was no faster than twice what the other had drifted to, which doubled
 * until velocities were off by 1e-7; without that it was told as a wedge, as no energy was lost. */
static void what_stops_by_turns_does_not_drift(void **state)
{
    (void)state;
    random_stream random = {5};
    const random_encounter e = draw_kept(40100000, 4301, 4, 6);
    const answer a = solve(&e, IMPACT_TOGETHER_SPRINGS, 1, NULL);
    assert_int_equal(a.status, IMPACT_OK);
    assert_at_most(a.outcome.residual, 1e-12);
    (void)assert_alike_in_frames(&random, 3, &e, IMPACT_TOGETHER_SPRINGS, 1, &a, 1e-11);
}

/* The second of these in other frames: its slips go straight, in a plane, though its impulses grow to 2e4 times what is
 * exchanged, and rounding turns velocities by as much as they do; and slip that comes to nothing leaves friction, all
 * of it, a direction that is rounding's. */
static void what_bounces_comes_to_rest_in_any_frame(void **state)
{
    (void)state;
    random_stream random = {5};
    const random_encounter e = draw_kept(21200000, 13845, 2, 3);
    const answer a = solve(&e, IMPACT_TOGETHER_SPRINGS, 1, NULL);
    for (int run = 0; run < 4; run++) {
        const encounter_frame frame = random_frame(&random);
        const random_encounter other = change_frame(&e, &frame);
        answer b = solve(&other, IMPACT_TOGETHER_SPRINGS, 1, NULL);
        assert_int_equal(b.status, IMPACT_OK);
        assert_in_range(b.outcome.steps, a.outcome.steps - 1000, a.outcome.steps + 1000);
        change_back(&b, e.body_count, &frame);
        assert_at_most(distance(&e, &a, &b), 1e-9);
    }
}

/* The same, where what bounces goes on to slide, or slides elsewhere meanwhile: friction's works fall by R, and not by
 * R^2 as those of dents do. Receipts missed by 5e-9 to 8e-5. */
static void works_of_bounces_go_to_their_own_end(void **state)
{
    (void)state;
    static const kept_encounter cases[] = {{20000000, 11408, 1.5, 7, 12},
                                           {21000000, 20995, 1, 7, 12},
                                           {21100000, 1370, 1.5, 2, 3},
                                           {20150000, 4937, 1.5, 4, 6}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const random_encounter e = draw_kept(cases[k].seed, cases[k].number, cases[k].least, cases[k].most);
        const answer a = solve(&e, IMPACT_TOGETHER_SPRINGS, cases[k].exponent, NULL);
        assert_int_equal(a.status, IMPACT_OK);
        assert_at_most(a.outcome.residual, 1e-13);
    }
}

/* Two bodies of the campaign that come to rest in a wedge, twice: what was rounding bounced on and was told as wedged,
 * the first in five frames of eight, the second, each of whose steps costs much, as drawn. And two that come loose
 * late, whose springs were counted twice where dents were loaded on, so that they seemed to lose no energy: in two of
 * eight. */
static void what_comes_to_rest_in_a_wedge_is_answered_in_any_frame(void **state)
{
    (void)state;
    static const struct {
        kept_encounter of;
        bool stops;
    } cases[] = {
        {{30000000, 1072, 1, 7, 12}, true}, {{2001, 682, 1.5, 7, 12}, true}, {{20550000, 824, 1.5, 4, 6}, false}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const kept_encounter *own = &cases[k].of;
        random_stream random = {1};
        const random_encounter e = draw_kept(own->seed, own->number, own->least, own->most);
        const answer a = solve(&e, IMPACT_TOGETHER_SPRINGS, own->exponent, NULL);
        assert_int_equal(a.status, IMPACT_OK);
        assert_int_equal(a.outcome.energy_after < 1e-24 * a.outcome.energy_before, cases[k].stops);
        (void)assert_alike_in_frames(&random, 4, &e, IMPACT_TOGETHER_SPRINGS, own->exponent, &a, 1e-10);
    }
}

/* Encounters of the campaign that no motion takes apart. Of two no series went on, as what pressures left of one
 * another was their rounding; four came apart by that, with velocities known to 1e-4 to 1e-8; and two, in a plane,
 * after thousands of bounces, otherwise in each frame, or not at all. */
static void a_wedge_is_told_whatever_rounding_makes_of_it(void **state)
{
    (void)state;
    static const kept_encounter cases[] = {{21000000, 10791, 1.5, 7, 12}, {21000000, 24972, 1, 7, 12},
                                           {21000000, 7155, 1.5, 4, 6},   {20050000, 5676, 1.5, 4, 6},
                                           {21200000, 10511, 1.5, 7, 12}, {21000000, 24035, 1, 7, 12},
                                           {21100000, 8982, 1.5, 7, 12},  {21100000, 17358, 1, 4, 6}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const random_encounter e = draw_kept(cases[k].seed, cases[k].number, cases[k].least, cases[k].most);
        const answer a = solve(&e, IMPACT_TOGETHER_SPRINGS, cases[k].exponent, NULL);
        assert_int_equal(a.status, IMPACT_EUNSETTLED);
        assert_true(a.outcome.wedged >= 0);
    }
}

/* Of the campaign (./run report together, N = 2250): wedges by friction, which pressures of their own hold but for
 * rounding, and which once spent the work allowed; where trying in vain to follow what creeps did; and what takes long,
 * stiffnesses and restitutions being far apart; and where what sticks had drifted, three times as far at each stop; and
 * what no motion takes apart, whose springs keep their energy for a while, and lose it then. */
static void what_never_ends_is_told_and_what_takes_long_is_answered(void **state)
{
    (void)state;
    static const struct {
        uint64_t seed, number;
        double exponent;
        int least, most;
        bool wedged;
    } cases[] = {{403, 775, 1, 2, 3, true},        {404, 308, 1.5, 4, 6, true},     {406, 1241, 1, 4, 6, true},
                 {402, 651, 1.5, 7, 12, true},     {407, 569, 1.5, 7, 12, false},   {404, 1469, 1, 7, 12, false},
                 {406, 1269, 1, 7, 12, false},     {402, 1305, 1, 7, 12, false},    {404, 1159, 1, 4, 6, false},
                 {406, 1425, 1, 7, 12, false},     {7001, 22203, 1, 4, 6, false},   {7001, 12264, 1.5, 7, 12, false},
                 {424242, 1786, 1.5, 4, 6, false}, {42400000, 4946, 1, 4, 6, false}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const random_encounter e = draw_kept(cases[k].seed, cases[k].number, cases[k].least, cases[k].most);
        const answer a = solve(&e, IMPACT_TOGETHER_SPRINGS, cases[k].exponent, NULL);
        assert_int_equal(a.status, cases[k].wedged ? IMPACT_EUNSETTLED : IMPACT_OK);
        assert_int_equal(a.outcome.wedged >= 0, cases[k].wedged);
    }
}

/* Two contacts of three bounce for 2.1 million steps, falling by a tenth in a thousand rounds: ended after less than a
 * quarter of them, and told, with velocities that are nearer to those at that end than what is told. */
static void what_is_ended_early_is_told(void **state)
{
    (void)state;
    static const double end[6] = {0.0674856304814, 0.0233191663887, -0.0306063242163,
                                  -0.134707319101, 0.028145272966,  -0.0678364079075};
    const random_encounter e = draw_kept(42500000, 3053, 2, 3);
    const answer a = solve(&e, IMPACT_TOGETHER_SPRINGS, 1, NULL);
    assert_int_equal(a.status, IMPACT_SOFT);
    assert_true(a.outcome.ended_early);
    assert_at_most(a.outcome.residual, 1e-13);
    const double found[6] = {a.velocity[0].x, a.velocity[0].y, a.velocity[0].z,
                             a.omega[0].x,    a.omega[0].y,    a.omega[0].z};
    double off = 0;
    for (int k = 0; k < 6; k++) off = fmax(off, fabs(found[k] - end[k]));
    assert_at_most(off, 1e-5);
    assert_true(a.outcome.error > off && a.outcome.error < 0.01);
}

/* Masses and stiffnesses up to 1e8 apart: what is left when the work allowed is spent could do as much as has been
 * done, and is no answer; nor is it a wedge. */
static void what_is_known_to_nothing_is_no_answer(void **state)
{
    (void)state;
    const encounter_ranges ranges = {4, 6, 10, 0.05, 1e8, 1e8};
    random_stream random = {777 + 0x9e3779b97f4a7c15u * 1477};
    const random_encounter e = encounter_draw(&random, &ranges);
    const answer a = solve(&e, IMPACT_TOGETHER_SPRINGS, 1.5, NULL);
    assert_int_equal(a.status, IMPACT_EUNSETTLED);
    assert_int_equal(a.outcome.wedged, -1);
    for (int b = 0; b < e.body_count; b++) assert_near3(a.velocity[b], e.bodies[b].velocity, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(bounces_that_never_end_are_followed_to_their_end),
                                       cmocka_unit_test(what_bounces_in_no_rhythm_comes_to_rest),
                                       cmocka_unit_test(bounces_end_once_their_ratio_tells_where),
                                       cmocka_unit_test(what_stops_by_turns_does_not_drift),
                                       cmocka_unit_test(what_bounces_comes_to_rest_in_any_frame),
                                       cmocka_unit_test(works_of_bounces_go_to_their_own_end),
                                       cmocka_unit_test(what_comes_to_rest_in_a_wedge_is_answered_in_any_frame),
                                       cmocka_unit_test(a_wedge_is_told_whatever_rounding_makes_of_it),
                                       cmocka_unit_test(what_never_ends_is_told_and_what_takes_long_is_answered),
                                       cmocka_unit_test(what_is_ended_early_is_told),
                                       cmocka_unit_test(what_is_known_to_nothing_is_no_answer)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
