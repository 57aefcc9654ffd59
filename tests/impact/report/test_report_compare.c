/* SPDX-License-Identifier: MIT
 *
 * Two runs' events against each other, pair of bodies by pair: times apart, dying tails, and what one alone has.
 */
#include "report/report_run.h"
#include "kit/contact_random.h"
#include "kit/near.h"

enum { MOST = 64 };

typedef struct events {
    imp_report_event list[MOST];
    int count;
} events;

static void add(events *e, double t, int kind, int body1, int body2, unsigned force)
{
    e->list[e->count++] = (imp_report_event){t, kind, {body1, body2}, force};
}

/* As runs have them, in any order: the comparison sorts them. */
static void shuffle(events *e, random_stream *random)
{
    for (int i = e->count - 1; i > 0; i--) {
        const int k = (int)(random_unit(random) * (i + 1));
        const imp_report_event kept = e->list[i];
        e->list[i] = e->list[k];
        e->list[k] = kept;
    }
}

/* Both ways round the same, but for the sign of nothing. */
static impact_report_row match(events a, events b, double t)
{
    random_stream random = {81};
    imp_report report = {.arena = NULL};
    assert_int_equal(imp_arena_create(NULL, &report.arena), IMPACT_OK);
    shuffle(&a, &random);
    shuffle(&b, &random);
    const imp_report_track one = {.events = a.list, .event_count = a.count},
                           other = {.events = b.list, .event_count = b.count};
    impact_report_row row = {0}, back = {0};
    assert_true(imp_report_match(&report, &one, &other, t, &row));
    assert_true(imp_report_match(&report, &other, &one, t, &back));
    imp_arena_destroy(report.arena);
    assert_true(row.error.t == back.error.t && row.other_events == back.other_events && row.dying == back.dying &&
                row.first_other == back.first_other);
    return row;
}

static void assert_same(impact_report_row row, double error)
{
    assert_near(row.error.t, error, 0);
    assert_int_equal(row.other_events, 0);
    assert_true(isinf(row.first_other));
}

/* Three pairs, and an edge of a force: a body bounces until it is held, another bounces, two slide and stick. */
static events three_pairs(double late)
{
    events e = {.count = 0};
    for (int k = 0; k < 5; k++) add(&e, 1 - pow(0.5, k + 1) + late, IMPACT_EVENT_IMPACT, 1, 0, 0);
    add(&e, 1 + late, IMPACT_EVENT_CONTACT, 1, 0, 0);
    for (int k = 0; k < 4; k++) add(&e, 0.3 * k + 0.1, IMPACT_EVENT_IMPACT, 2, 0, 0);
    add(&e, 0.5, IMPACT_EVENT_CONTACT, 1, 2, 0);
    add(&e, 0.5, IMPACT_EVENT_SLIP, 1, 2, 0);
    add(&e, 0.7, IMPACT_EVENT_STICK, 1, 2, 0);
    add(&e, 0.2, IMPACT_EVENT_FORCE, 1, -1, 7);
    add(&e, 0.2, IMPACT_EVENT_FORCE, 1, -1, 9);
    return e;
}

static void the_same_events_are_matched_with_their_times(void **state)
{
    (void)state;
    const events e = three_pairs(0);
    assert_same(match(e, e, 2), 0);
    assert_same(match((events){.count = 0}, (events){.count = 0}, 2), 0);
    for (int k = -12; k <= -2; k += 5) {
        const double late = pow(2, k);
        const impact_report_row row = match(e, three_pairs(late), 2);
        assert_same(row, late);
        assert_int_equal(row.dying, 0);
    }
}

/* A tail of impacts that dies out before the contact is held: one run has more of them, or all of them alone. */
static void dying_tails_are_no_other_events(void **state)
{
    (void)state;
    for (int more = 0; more < 5; more++) {
        events e = {.count = 0}, fewer = {.count = 0};
        for (int k = 0; k < 5; k++) {
            add(&e, 0.1 * k, IMPACT_EVENT_IMPACT, 1, 0, 0);
            if (k < 5 - more) add(&fewer, 0.1 * k, IMPACT_EVENT_IMPACT, 1, 0, 0);
        }
        add(&e, 0.5, IMPACT_EVENT_CONTACT, 1, 0, 0);
        add(&fewer, 0.5 - 0.001 * more, IMPACT_EVENT_CONTACT, 1, 0, 0);
        const impact_report_row row = match(e, fewer, 2);
        assert_int_equal(row.dying, more);
        assert_int_equal(row.other_events, 0);
        assert_near(row.error.t, 0.001 * more, 1e-15);
    }
}

/* What one has and the other has not, from when on; an event of another force or kind is another event, and impacts
 * that end in no contact are no tail. */
static void others_are_counted_by_pair_and_dated(void **state)
{
    (void)state;
    events e = three_pairs(0);
    add(&e, 1.5, IMPACT_EVENT_LIFTOFF, 1, 2, 0);
    impact_report_row row = match(e, three_pairs(0), 2);
    assert_int_equal(row.other_events, 1);
    assert_near(row.first_other, 1.5, 0);
    add(&e, 1.25, IMPACT_EVENT_IMPACT, 3, 0, 0);
    row = match(e, three_pairs(0), 2);
    assert_int_equal(row.other_events, 2);
    assert_near(row.first_other, 1.25, 0);

    events one = {.count = 0}, other = {.count = 0};
    add(&one, 0.5, IMPACT_EVENT_FORCE, 1, -1, 7);
    add(&other, 0.5, IMPACT_EVENT_FORCE, 1, -1, 8);
    row = match(one, other, 2);
    assert_int_equal(row.other_events, 2);
    assert_near(row.first_other, 0.5, 0);

    one = other = (events){.count = 0};
    add(&one, 0.25, IMPACT_EVENT_IMPACT, 1, 0, 0);
    add(&one, 0.75, IMPACT_EVENT_SLIP, 1, 0, 0);
    add(&other, 0.5, IMPACT_EVENT_CONTACT, 1, 0, 0);
    row = match(one, other, 2);
    assert_int_equal(row.other_events, 1);
    assert_int_equal(row.dying, 0);
    assert_near(row.first_other, 0.25, 0);
}

/* What comes last, so near to the end that the other has it behind that, is not missed; what comes behind it is not
 * looked at. */
static void the_end_is_where_comparing_ends(void **state)
{
    (void)state;
    events one = {.count = 0}, other = {.count = 0};
    add(&one, 0.5, IMPACT_EVENT_IMPACT, 1, 0, 0);
    other = one;
    add(&one, 2 * (1 - 5e-7), IMPACT_EVENT_IMPACT, 1, 0, 0);
    add(&one, 2.5, IMPACT_EVENT_IMPACT, 1, 0, 0);
    assert_same(match(one, other, 2), 0);
    add(&one, 2 * (1 - 2e-6), IMPACT_EVENT_IMPACT, 1, 0, 0);
    assert_int_equal(match(one, other, 2).other_events, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_same_events_are_matched_with_their_times),
                                       cmocka_unit_test(dying_tails_are_no_other_events),
                                       cmocka_unit_test(others_are_counted_by_pair_and_dated),
                                       cmocka_unit_test(the_end_is_where_comparing_ends)};
    return cmocka_run_group_tests_name("impact.report_compare", tests, NULL, NULL);
}
