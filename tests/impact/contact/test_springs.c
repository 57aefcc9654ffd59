/* SPDX-License-Identifier: MIT
 *
 * The springs against a plain integration of their equations in 80 bits (tests/kit/springs_oracle.h), and of one
 * contact against impact_collide, whatever exponent and stiffness.
 */
#include "kit/near.h"

#include <string.h>
#include "contact/cone_assemble.h"
#include "base/tolerances.h"
#include "contact/springs.h"
#include "kit/encounter_random.h"
#include "kit/springs_oracle.h"

/* ---- the first fall ---- */

static void the_first_zero_of_a_polynomial_is_found(void **state)
{
    (void)state;
    random_stream random = {1};
    for (int run = 0; run < 2000; run++) {
        double c[6] = {1}, first = INFINITY;
        const int pairs = 1 + run % 5;
        for (int i = 0; i < pairs; i++) { /* (1 - t/a) for each root */
            const double root = random_log(&random, 1e-3, 10);
            first = fmin(first, root);
            for (int k = i + 1; k >= 1; k--) c[k] -= c[k - 1] / root;
        }
        bool found;
        const double at = imp_springs_first_fall(c, 5, 20, &found);
        assert_true(found);
        assert_near(at / first, 1, 1e-9);
        if (first > 0.5) assert_near(imp_springs_first_fall(c, 5, first / 2, &found), first / 2, 0);
    }
}

static void what_touches_zero_from_above_is_not_passed(void **state)
{
    (void)state;
    const double just_misses[] = {1.0000001, -2, 1}, just_falls[] = {0.9999999, -2, 1}; /* (t - 1)^2 +- 1e-7 */
    bool found;
    assert_near(imp_springs_first_fall(just_misses, 2, 3, &found), 3, 0);
    assert_false(found);
    assert_near(imp_springs_first_fall(just_falls, 2, 3, &found), 1 - sqrt(1e-7), 1e-9);
    assert_true(found);
    const double late[] = {1e-30, 0, 0, -1}; /* flat at its beginning */
    assert_near(imp_springs_first_fall(late, 3, 1, &found), 1e-10, 1e-20);
}

/* (1 - t/a) for each root, some of them beyond 1, some complex; how many are in [0, 1], and the first. */
static int draw_polynomial(random_stream *random, double c[8], double *first)
{
    int within = 0, order = 0;
    for (int k = 0; k < 8; k++) c[k] = k == 0;
    *first = INFINITY;
    while (order < 6) {
        if (random_unit(random) < 0.4) { /* 1 - b t + c t^2, b^2 < 4 c */
            const double root = random_log(random, 0.5, 5), b = 1.9 * (2 * random_unit(random) - 1) / root;
            for (int k = order + 2; k >= 1; k--) c[k] += (k >= 2 ? c[k - 2] / (root * root) : 0) - b * c[k - 1];
            order += 2;
        } else {
            const double root = random_log(random, 0.1, 100);
            for (int k = ++order; k >= 1; k--) c[k] -= c[k - 1] / root;
            within += root <= 1;
            *first = fmin(*first, root);
        }
    }
    return within;
}

static void a_lone_zero_is_shown_to_be_the_only_one(void **state)
{
    (void)state;
    random_stream random = {2};
    int lone = 0, one = 0, clear = 0, none = 0;
    for (int run = 0; run < 4000; run++) {
        double c[8], first;
        bool found;
        const int within = draw_polynomial(&random, c, &first);
        const double about = run % 2 ? first * (1 + 0.1 * (random_unit(&random) - 0.5)) : 0;
        const double at = imp_springs_lone_fall(c, 7, about > 1 ? 0 : about, &found);
        if (found) assert_int_equal(within, 1);
        if (found) assert_near(at / first, 1, 1e-12);
        if (imp_springs_is_clear(c, 8)) assert_int_equal(within, 0);
        lone += found, one += within == 1;
        clear += imp_springs_is_clear(c, 8), none += within == 0;
    }
    assert_true(lone > one / 2 && clear > none / 2); /* and they do tell */
}

/* ---- one contact ---- */

static impact_collider any_body(random_stream *random, bool is_static)
{
    static const encounter_ranges ranges = {.mass_ratio = 100};
    impact_collider body = encounter_body(random, &ranges, is_static);
    if (is_static) body.mass = INFINITY;
    body.offset = random_vector(random, 0.3, 1);
    return body;
}

enum { BLOCK = 1 << 18 };

/* The springs' impulse of one contact, which impact_collide_together would hand to impact_collide. */
static impact_status by_springs(const impact_collision *c, double exponent, impact_together_workspace *workspace,
                                double p[3], size_t room)
{
    static unsigned char bytes[BLOCK];
    const impact_meeting m = {.body1 = 0,
                              .body2 = 1,
                              .normal = c->normal,
                              .offset1 = c->body[0].offset,
                              .offset2 = c->body[1].offset,
                              .friction = c->friction,
                              .restitution = c->restitution,
                              .stiffness = 3};
    const impact_encounter e = {.bodies = c->body, .body_count = 2, .meetings = &m, .meeting_count = 1};
    const imp_contact contact = imp_encounter_contact(&e, 0, false);
    const qvec3 v[2] = {c->body[0].velocity, c->body[1].velocity}, omega[2] = {c->body[0].omega, c->body[1].omega};
    double w[9] = {0}, u0[3];
    imp_finding finding = {.compressions = 0};
    imp_group group = {.count = 1,
                       .contacts = &contact,
                       .w = w,
                       .u0 = u0,
                       .p = p,
                       .findings = &finding,
                       .least = IMP_SPRINGS_LEAST,
                       .patience = IMP_SPRINGS_STEPS};
    imp_encounter_velocity(&contact, v, omega, u0);
    for (int s = 0; s < 2; s++)
        for (int i = 0; i < 9; i++)
            for (int k = 0; k < 6; k++) w[i] += contact.row[s][i / 3][k] * contact.row[s][i % 3][k];
    p[0] = p[1] = p[2] = 0;
    workspace->work = (imp_block){.bytes = bytes, .size = room};
    return imp_springs_solve(&group, exponent, workspace);
}

/* Whatever of its room is missing, a group says so, and touches nothing beyond. */
static void a_block_too_small_is_told(void **state)
{
    (void)state;
    impact_together_workspace *workspace;
    random_stream random = {8};
    int refused = 0, solved = 0;
    const impact_collision c = {.body = {any_body(&random, false), any_body(&random, false)},
                                .normal = random_direction(&random),
                                .friction = 0.3,
                                .restitution = 0.5,
                                .law = IMPACT_STRONGE};
    assert_int_equal(impact_together_workspace_create(NULL, &workspace), IMPACT_OK);
    for (size_t room = 0; room < 16384; room += 256) {
        double p[3];
        const impact_status status = by_springs(&c, 1.5, workspace, p, room);
        assert_true(status == IMPACT_ENOMEM ? solved == 0 : status == IMPACT_OK);
        refused += status == IMPACT_ENOMEM, solved += status == IMPACT_OK;
    }
    assert_true(refused > 2 && solved > 2);
    workspace->work = (imp_block){0};
    impact_together_workspace_destroy(workspace);
}

static void one_contact_is_impact_collide(void **state)
{
    (void)state;
    impact_together_workspace *workspace;
    assert_int_equal(impact_together_workspace_create(NULL, &workspace), IMPACT_OK);
    random_stream random = {7};
    const double exponents[] = {1, 1.5, 2.2};
    int seen[IMPACT_REVERSAL + 1] = {0};
    for (int run = 0; run < 2000; run++) {
        impact_collision c = {.body = {any_body(&random, false), any_body(&random, run % 3 == 0)},
                              .normal = random_direction(&random),
                              .friction = run % 7 == 0 ? 0 : random_log(&random, 0.05, 3),
                              .restitution = run % 13 == 0 ? 1 : random_log(&random, 0.05, 1),
                              .law = IMPACT_STRONGE};
        impact_outcome o;
        if (impact_collide(&c, &o) != IMPACT_OK) continue;
        double p[3];
        assert_int_equal(by_springs(&c, exponents[run % 3], workspace, p, BLOCK), IMPACT_OK);
        qvec3 normal, axes[3];
        (void)qvec3_normalize(c.normal, &normal);
        imp_cone_find_axes(normal, axes);
        for (int k = 0; k < 3; k++)
            assert_near(p[k] / o.impulse_normal, qvec3_dot(axes[k], o.impulse) / o.impulse_normal, 1e-12);
        for (int k = 0; k < o.phase_count; k++) seen[o.phases[k]]++;
    }
    for (int k = IMPACT_SLIP_C; k <= IMPACT_STICK_R; k++) assert_true(seen[k] > 100);
    assert_true(seen[IMPACT_REVERSAL] > 0);
    workspace->work = (imp_block){0};
    impact_together_workspace_destroy(workspace);
}

/* ---- where bounces end ---- */

/* One contact that slides along x, W = 1, friction .3: pushed by 1 and by .5 between three moments, at `approach` now,
 * its friction so large a part of what it should have been. Whether it comes to rest, and with what. */
static bool comes_to_rest(double approach, double part, imp_spring *contact, imp_finding *finding)
{
    const double w[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, mu = 0.3, slip = 5,
                 u0[3] = {-approach - 1.5, slip + 1.5 * mu * part};
    int start[] = {0, 1, 2, 3}, column[] = {0, 1, 2}, begin[1];
    double room[18] = {0}, factor[34], now[3]; /* 12 + 22 */
    imp_cone_mode modes[1];
    impact_together_workspace *workspace;
    assert_int_equal(impact_together_workspace_create(NULL, &workspace), IMPACT_OK);
    assert_true(imp_cone_reserve(&workspace->cone, 1));
    assert_int_equal(imp_springs_bounces_size(1), 18);
    *finding = (imp_finding){.work = {-3, 2, -9}};
    *contact = (imp_spring){.friction = mu, .finding = finding, .u = {-approach, slip}, .p = {1.5, -1.5 * mu * part}};
    imp_springs s = {.count = 1,
                     .springs = contact,
                     .w = w,
                     .u0 = u0,
                     .rows = {start, column},
                     .now = now,
                     .factor = factor,
                     .begin = begin,
                     .modes = modes,
                     .cone = &workspace->cone,
                     .bounces = {.room = room}};
    const double second[] = {1, -mu * part, 0, -2, 1, -6}, third[] = {1.5, -1.5 * mu * part, 0, -3, 2, -9};
    memcpy(imp_springs_impulses_at(&s, 1), second, sizeof second);
    memcpy(imp_springs_impulses_at(&s, 2), third, sizeof third);
    const bool rests = imp_springs_come_to_rest(&s, 0.5);
    impact_together_workspace_destroy(workspace);
    return rests;
}

/* At rest after .5 more, as the ratio says; not where that takes it elsewhere, nor where friction was not what slip
 * that stays has. */
static void bounces_end_where_their_course_leads(void **state)
{
    (void)state;
    imp_spring contact;
    imp_finding finding;
    assert_true(comes_to_rest(0.5, 1, &contact, &finding));
    assert_near(contact.p[0], 2, 1e-15);
    assert_near(contact.u[0], 0, 1e-15);
    assert_near(contact.u[1], 5 - 0.3 * 0.5, 1e-15);
    assert_false(comes_to_rest(0.25, 1, &contact, &finding));
    assert_false(comes_to_rest(0.8, 1, &contact, &finding));
    assert_false(comes_to_rest(0.5, 0.9, &contact, &finding));
    assert_near(contact.p[0], 1.5, 0);
}

/* ---- many ---- */

/* The worst difference of velocities over so many random encounters; *followed: how many the oracle went through. */
static double worst_of(encounter_ranges ranges, double exponent, bool planar, uint64_t seed, int runs, int *followed)
{
    static oracle o;
    random_stream random = {seed};
    double worst = 0;
    *followed = 0;
    for (int run = 0; run < runs; run++) {
        random_encounter e = encounter_draw(&random, &ranges);
        if (planar) encounter_flatten(&e);
        impact_encounter encounter = encounter_of(&e, IMPACT_TOGETHER_SPRINGS);
        encounter.exponent = exponent;
        qvec3 v[ENCOUNTER_BODIES], omega[ENCOUNTER_BODIES];
        impact_together_outcome outcome = {.velocity = v, .omega = omega};
        const impact_status status = impact_collide_together(&encounter, &outcome);
        if (status == IMPACT_SEPARATING || outcome.wedged >= 0) continue;
        assert_int_equal(status, IMPACT_OK);
        if (!oracle_run(&o, &encounter, exponent, planar)) continue;
        ++*followed;
        for (int b = 0; b < e.body_count; b++) {
            const double got[6] = {v[b].x, v[b].y, v[b].z, omega[b].x, omega[b].y, omega[b].z};
            for (int k = 0; k < 6; k++) worst = fmax(worst, fabs(got[k] - (double)o.y[6 * b + k]));
        }
    }
    return worst;
}

static void random_encounters_are_the_oracle_s(void **state)
{
    (void)state;
    const encounter_ranges smooth = {2, 3, 0, 0.3, 4, 4}, rough = {2, 3, 1, 0.3, 4, 4};
    int followed;
    assert_at_most(worst_of(smooth, 1, false, 5, 30, &followed), 1e-14);
    assert_true(followed >= 25);
    assert_at_most(worst_of(smooth, 1.5, false, 5, 25, &followed), 1e-14);
    assert_true(followed >= 20);
    assert_at_most(worst_of(rough, 1, false, 5, 30, &followed), 1e-13);
    assert_true(followed >= 25);
    assert_at_most(worst_of(rough, 1.5, false, 5, 30, &followed), 1e-13);
    assert_true(followed >= 25);
    assert_at_most(worst_of(rough, 1, true, 5, 11, &followed), 1e-13);
    assert_true(followed >= 7);
}

/* Linear springs without friction have a solver of their own; with friction that does nothing the general one answers,
 * and both agree as far as rounding is magnified. */
static void both_solvers_of_linear_springs_agree(void **state)
{
    (void)state;
    const encounter_ranges ranges = {2, 10, 0, 0.2, 10, 10};
    random_stream random = {31};
    int answered = 0;
    for (int run = 0; run < 120; run++) {
        random_encounter e = encounter_draw(&random, &ranges);
        impact_encounter encounter = encounter_of(&e, IMPACT_TOGETHER_SPRINGS);
        encounter.exponent = 1;
        qvec3 v[2][ENCOUNTER_BODIES], omega[2][ENCOUNTER_BODIES];
        impact_meeting_outcome each[2][ENCOUNTER_CONTACTS];
        impact_status status[2];
        for (int k = 0; k < 2; k++) {
            impact_together_outcome o = {.velocity = v[k], .omega = omega[k], .meetings = each[k]};
            for (int i = 0; k == 1 && i < e.meeting_count; i++) e.meetings[i].friction = 1e-290;
            status[k] = impact_collide_together(&encounter, &o);
        }
        assert_int_equal(status[0], status[1]);
        if (status[0] != IMPACT_OK) continue;
        answered++;
        for (int b = 0; b < e.body_count; b++) {
            assert_near3(v[0][b], v[1][b], 1e-11);
            assert_near3(omega[0][b], omega[1][b], 1e-11);
        }
        for (int i = 0; i < e.meeting_count; i++) {
            assert_near(each[0][i].work_compression, each[1][i].work_compression, 1e-11);
            assert_near(each[0][i].work_restitution, each[1][i].work_restitution, 1e-11);
        }
    }
    assert_true(answered > 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_first_zero_of_a_polynomial_is_found),
        cmocka_unit_test(what_touches_zero_from_above_is_not_passed),
        cmocka_unit_test(a_lone_zero_is_shown_to_be_the_only_one),
        cmocka_unit_test(a_block_too_small_is_told),
        cmocka_unit_test(one_contact_is_impact_collide),
        cmocka_unit_test(bounces_end_where_their_course_leads),
        cmocka_unit_test(random_encounters_are_the_oracle_s),
        cmocka_unit_test(both_solvers_of_linear_springs_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
