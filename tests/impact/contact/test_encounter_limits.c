/* SPDX-License-Identifier: MIT
 *
 * What encounters may be: groups and duplicates, wedges that are told, memory, and bad input in words.
 */
#include "kit/near.h"

#include <stdlib.h>
#include <string.h>
#include <impact/together.h>
#include "kit/encounter_answer.h"

static impact_collider ball(double speed)
{
    return (impact_collider){
        .mass = 1, .moments = {0.4, 0.4, 0.4}, .orientation = {1, 0, 0, 0}, .velocity = {speed, 0, 0}};
}

/* ---- groups, duplicates, wedges ---- */

static void groups_are_apart_and_one_contact_is_impact_collide(void **state)
{
    (void)state;
    const impact_collider bodies[4] = {ball(1), ball(0), ball(2), ball(-1)};
    impact_meeting m[3];
    for (int i = 0; i < 3; i++)
        m[i] = (impact_meeting){.body1 = i == 2 ? 2 : 0,
                                .body2 = i == 2 ? 3 : 1,
                                .normal = {-1, 0.1, 0},
                                .offset1 = {1, 0, 0},
                                .offset2 = {-1, 0, 0},
                                .friction = 0.2,
                                .restitution = 0.7,
                                .stiffness = 1};
    qvec3 v[4], omega[4];
    impact_meeting_outcome each[3];
    impact_together_outcome o = {.velocity = v, .omega = omega, .meetings = each};
    const impact_encounter e = {.bodies = bodies, .body_count = 4, .meetings = m, .meeting_count = 3};
    assert_int_equal(impact_collide_together(&e, &o), IMPACT_OK);
    assert_int_equal(o.groups, 2);
    assert_int_equal(o.solver, IMPACT_TOGETHER_ALONE);
    assert_true(each[1].merged && !each[0].merged && !each[2].merged);
    assert_int_equal(each[0].group, each[1].group);
    impact_collision c = {.body = {bodies[2], bodies[3]},
                          .normal = m[2].normal,
                          .friction = 0.2,
                          .restitution = 0.7,
                          .law = IMPACT_STRONGE};
    c.body[0].offset = m[2].offset1, c.body[1].offset = m[2].offset2;
    impact_outcome one;
    assert_int_equal(impact_collide(&c, &one), IMPACT_OK);
    assert_memory_equal(&v[2], &one.velocity[0], sizeof v[2]);
    assert_memory_equal(&omega[3], &one.omega[1], sizeof omega[3]);
}

static void a_wedged_ball_is_told(void **state)
{
    (void)state;
    const impact_collider bodies[2] = {ball(1), {.mass = INFINITY, .orientation = {1, 0, 0, 0}}};
    impact_meeting m[2];
    for (int i = 0; i < 2; i++)
        m[i] = (impact_meeting){.body1 = 0,
                                .body2 = 1,
                                .normal = {i ? 1 : -1, 0, 0},
                                .offset1 = {i ? -1 : 1, 0, 0},
                                .restitution = 0.5,
                                .stiffness = 1};
    qvec3 v[2];
    impact_together_outcome o = {.velocity = v};
    const impact_encounter e = {.bodies = bodies, .body_count = 2, .meetings = m, .meeting_count = 2};
    assert_int_equal(impact_collide_together(&e, &o), IMPACT_EUNSETTLED);
    assert_true(o.wedged >= 0);
    assert_near3(v[0], bodies[0].velocity, 0);
}

/* A ball in a groove of 60 degrees: friction of 3 holds it by pressures of its own, of .2 does not. */
static void what_friction_locks_is_told(void **state)
{
    (void)state;
    const double c = cos(0.5236), s = sin(0.5236);
    impact_collider bodies[2] = {ball(0), {.mass = INFINITY, .orientation = {1, 0, 0, 0}}};
    bodies[0].velocity = (qvec3){0.1, 0, -1};
    impact_meeting m[2];
    for (int i = 0; i < 2; i++)
        m[i] = (impact_meeting){.body1 = 0,
                                .body2 = 1,
                                .normal = {i ? c : -c, 0, s},
                                .offset1 = {i ? -c : c, 0, -s},
                                .friction = 3,
                                .restitution = 0.5,
                                .stiffness = 1};
    impact_together_outcome o = {.velocity = NULL};
    const impact_encounter e = {.bodies = bodies, .body_count = 2, .meetings = m, .meeting_count = 2};
    assert_int_equal(impact_collide_together(&e, &o), IMPACT_EUNSETTLED);
    assert_true(o.wedged >= 0);
    for (int i = 0; i < 2; i++) m[i].friction = 0.2;
    assert_int_equal(impact_collide_together(&e, &o), IMPACT_OK);
}

/* ---- memory ---- */

static void *count_bytes(size_t size, void *context)
{
    *(size_t *)context += size;
    return malloc(size);
}

static void release(void *piece, size_t size, void *context)
{
    (void)size, (void)context;
    free(piece);
}

static void a_workspace_takes_memory_once_and_keeps_its_limit(void **state)
{
    (void)state;
    size_t taken = 0;
    const impact_allocator counting = {count_bytes, release, &taken, 0}, tight = {NULL, NULL, NULL, 4096};
    impact_together_workspace *workspace;
    random_stream random = {19};
    const random_encounter e = encounter_draw(&random, &(encounter_ranges){5, 5, 1, 0.3, 4, 4});
    assert_int_equal(impact_together_workspace_create(&counting, &workspace), IMPACT_OK);
    const answer first = solve(&e, IMPACT_TOGETHER_SPRINGS, 0, workspace);
    const size_t once = taken;
    const answer again = solve(&e, IMPACT_TOGETHER_SPRINGS, 0, workspace);
    assert_int_equal(taken, once);
    assert_int_equal(impact_together_workspace_memory(workspace).held, once);
    assert_memory_equal(first.velocity, again.velocity, (size_t)e.body_count * sizeof *first.velocity);
    impact_together_workspace_destroy(workspace);
    if (impact_together_workspace_create(&tight, &workspace) != IMPACT_OK) return;
    assert_int_equal(solve(&e, IMPACT_TOGETHER_SPRINGS, 0, workspace).status, IMPACT_ENOMEM);
    impact_together_workspace_destroy(workspace);
}

/* ---- bad input ---- */

static void expect(const random_encounter *e, double exponent, impact_status status, const char *words)
{
    char message[300];
    impact_encounter encounter = encounter_of(e, IMPACT_TOGETHER_SPRINGS);
    encounter.exponent = exponent;
    assert_int_equal(impact_collide_together_check(&encounter, message, sizeof message), status);
    if (!strstr(message, words)) fail_msg("'%s' does not say '%s'", message, words);
    assert_int_equal(solve(e, IMPACT_TOGETHER_SPRINGS, exponent, NULL).status, status);
}

static void bad_input_is_named_in_words(void **state)
{
    (void)state;
    random_stream random = {23};
    const random_encounter good = encounter_draw(&random, &(encounter_ranges){3, 3, 1, 0.3, 4, 4});
    random_encounter e = good;
    e.meetings[1].body2 = 9;
    expect(&e, 0, IMPACT_EARGUMENT, "contact 1: body2 is 9");
    e = good, e.meetings[2].body2 = e.meetings[2].body1;
    expect(&e, 0, IMPACT_EARGUMENT, "contact 2: both sides are body");
    e = good, e.meetings[0].stiffness = -1;
    expect(&e, 0, IMPACT_EARGUMENT, "contact 0: stiffness is -1, must be > 0");
    e = good, e.meetings[0].stiffness = NAN;
    expect(&e, 0, IMPACT_EDOMAIN, "contact 0: stiffness is NaN");
    e = good, e.meetings[2].friction = -0.5;
    expect(&e, 0, IMPACT_EARGUMENT, "contact 2, of body");
    e = good, e.bodies[e.meetings[0].body1].mass = NAN;
    expect(&e, 0, IMPACT_EDOMAIN, "mass is NaN");
    e = good, e.bodies[e.meetings[0].body1].mass = e.bodies[e.meetings[0].body2].mass = INFINITY;
    expect(&e, 0, IMPACT_EARGUMENT, "static");
    e = good, e.meetings[1] = e.meetings[0], e.meetings[1].friction += 1;
    expect(&e, 0, IMPACT_EARGUMENT, "contact 1 is contact 0 again");
    expect(&good, 4, IMPACT_EARGUMENT, "exponent is 4");
    e = good, e.meeting_count = 0;
    expect(&e, 0, IMPACT_EARGUMENT, "there are no contacts");
}

/* What is wrong of an encounter as a whole, by what is said of it. */
static void what_no_encounter_has_is_named(void **state)
{
    (void)state;
    random_stream random = {24};
    const random_encounter e = encounter_draw(&random, &(encounter_ranges){3, 3, 1, 0.3, 4, 4});
    const impact_encounter good = encounter_of(&e, IMPACT_TOGETHER_SPRINGS);
    impact_encounter bad[9];
    static const char *const words[9] = {
        "there are no bodies: body_count is 0",
        "there are no bodies: body_count is 4",
        "there are no contacts: meeting_count is -1",
        "there are no contacts: meeting_count is 3",
        "law is 3, must be springs, moreau or sequence",
        "law is -1, must be springs, moreau or sequence",
        "restitution is 3, must be Poisson's, Newton's or Stronge's",
        "exponent is NaN",
        "exponent is 0.5, must be in [1, 3], or 0 for 3/2",
    };
    for (int k = 0; k < 9; k++) bad[k] = good;
    bad[0].body_count = 0;
    bad[1].bodies = NULL, bad[1].body_count = 4;
    bad[2].meeting_count = -1;
    bad[3].meetings = NULL, bad[3].meeting_count = 3;
    bad[4].law = (impact_together_law)3;
    bad[5].law = (impact_together_law)-1;
    bad[6].restitution = (impact_law)3;
    bad[7].exponent = NAN;
    bad[8].exponent = 0.5;
    for (int k = 0; k < 9; k++) {
        char message[300];
        const impact_status wanted = k == 7 ? IMPACT_EDOMAIN : IMPACT_EARGUMENT;
        assert_int_equal(impact_collide_together_check(&bad[k], message, sizeof message), wanted);
        assert_string_equal(message, words[k]);
        assert_int_equal(impact_collide_together_check(&bad[k], NULL, 0), wanted);
    }
    random_encounter other = e;
    other.meetings[0].stiffness = INFINITY;
    expect(&other, 0, IMPACT_EARGUMENT, "contact 0: stiffness is inf, must be > 0 and finite");
    other = e, other.meetings[2].body1 = -1;
    expect(&other, 0, IMPACT_EARGUMENT, "contact 2: body1 is -1, and there are ");
    other = e, other.meetings[1] = other.meetings[0], other.meetings[1].restitution *= 0.5;
    expect(&other, 0, IMPACT_EARGUMENT,
           "contact 1 is contact 0 again, with another friction, restitution or stiffness");
    other = e, other.meetings[1] = other.meetings[0], other.meetings[1].stiffness *= 2;
    expect(&other, 0, IMPACT_EARGUMENT,
           "contact 1 is contact 0 again, with another friction, restitution or stiffness");
}

static void laws_and_solvers_have_names(void **state)
{
    (void)state;
    static const char *const laws[] = {"springs", "moreau", "sequence", "unknown"};
    static const char *const solvers[] = {"none", "alone", "series", "cone", "sweeps", "unknown"};
    for (int k = 0; k < 4; k++) assert_string_equal(impact_together_law_name((impact_together_law)k), laws[k]);
    for (int k = 0; k < 6; k++) assert_string_equal(impact_together_solver_name((impact_together_solver)k), solvers[k]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(groups_are_apart_and_one_contact_is_impact_collide),
        cmocka_unit_test(a_wedged_ball_is_told),
        cmocka_unit_test(what_friction_locks_is_told),
        cmocka_unit_test(a_workspace_takes_memory_once_and_keeps_its_limit),
        cmocka_unit_test(bad_input_is_named_in_words),
        cmocka_unit_test(what_no_encounter_has_is_named),
        cmocka_unit_test(laws_and_solvers_have_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
