/* SPDX-License-Identifier: MIT
 *
 * How far the answer follows its data: cases on paper; every class against differences of the answers, and against
 * differences of the 128-bit oracle's; events that nearly and just happen.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <float.h>
#include <string.h>

#include <impact/collide.h>
#include "collide/collide_variation.h"
#include "generators/collide_cases.h"
#include "kit/near.h"
#ifdef HAVE_QUADMATH
#include "generators/collide_oracle.h"
#endif

static const impact_collider floor_body = {.mass = INFINITY, .orientation = {1, 0, 0, 0}};

/* ---- on paper ---- */

/* A ball of unit mass falls straight down: V = eps v, so that the changes of eps and of v each move it by their own
 * size, and nothing else does: n at unit length does not follow a change along itself. */
static void a_ball_on_paper(void **state)
{
    (void)state;
    const impact_collision c = {.body = {{1, {1, 1, 1}, {1, 0, 0, 0}, {0, 0, -1}, {0, 0, -1}, {0, 0, 0}}, floor_body},
                                .normal = {0, 0, 1},
                                .restitution = 0.5};
    assert_near(impact_collide_sensitivity(&c), sqrt(2), 1e-15);
    impact_collision stops = c;
    stops.body[0].velocity.z = 0;
    assert_true(impact_collide_sensitivity(&stops) == 0);
    stops.body[0].velocity.z = 1;
    assert_true(impact_collide_sensitivity(&stops) == 1);
    /* The floor comes up at 1 m/s: V = w + eps (w - v) = 2, and w is no answer. */
    impact_collision lifted = c;
    lifted.body[1].velocity.z = 1;
    assert_near(impact_collide_sensitivity(&lifted), sqrt(0.25 + 2.25 + 1) / 2, 1e-15);
    impact_collision sticky = c;
    sticky.friction = 0.3;
    assert_near(impact_collide_sensitivity(&sticky), sqrt(2), 1e-15);
}

/* It slides too: V_x = v_x - mu (1 + eps) |v_z|, W_y = -mu (1 + eps) |v_z| r m/J, V_z = eps |v_z|, rho^2 = J/m. Of the
 * data v_x, v_z, mu, eps, m and J count as written; r_z as the arm of W_y and, by omega = 0, of nothing else; r's z
 * component alone leaves it along n. */
static void a_ball_that_slides(void **state)
{
    (void)state;
    const double J = 0.4, m = 1, mu = 0.1, eps = 0.5, vx = 3, vz = 1, p = m * (1 + eps) * vz;
    const impact_collision c = {.body = {{m, {J, J, J}, {1, 0, 0, 0}, {0, 0, -1}, {vx, 0, -vz}, {0, 0, 0}}, floor_body},
                                .normal = {0, 0, 1},
                                .friction = mu,
                                .restitution = eps};
    const double x = vx - mu * p, y = mu * p / J, z = eps * vz, rho2 = J;
    /* rows: of v_x, v_z, mu, eps, m (V per p/m stays, W goes with m), the three moments (J_y alone), r_z */
    const double d[][3] = {{vx, 0, 0}, {-mu * p, y, z}, {-mu * p, y, 0}, {-mu * eps * vz, mu * eps * vz / J, z},
                           {0, y, 0},  {0, -y, 0},      {0, y, 0}};
    double sum = 0;
    for (size_t i = 0; i < sizeof d / sizeof *d; i++)
        sum += d[i][0] * d[i][0] + rho2 * d[i][1] * d[i][1] + d[i][2] * d[i][2];
    assert_near(impact_collide_sensitivity(&c), sqrt(sum / (x * x + rho2 * y * y + z * z)), 1e-14);
}

/* Thrown down so that it comes nearly to rest, it follows its data by what is left of the velocity. */
static void what_nearly_stops(void **state)
{
    (void)state;
    const impact_collision c = {
        .body = {{1, {1, 1, 1}, {1, 0, 0, 0}, {0, -0.6, -0.8}, {1e-6, -0.75, -1}, {0, 0, 0}}, floor_body},
        .normal = {0, 0.6, 0.8},
        .restitution = 0};
    const double s = impact_collide_sensitivity(&c);
    assert_true(s > 1e5 && s < 1e7);
}

static void refused(void **state)
{
    (void)state;
    const impact_collision c = {.body = {{-1, {1, 1, 1}, {1, 0, 0, 0}, {0}, {0}, {0}}, floor_body},
                                .normal = {0, 0, 1}};
    assert_true(isnan(impact_collide_sensitivity(&c)));
}

/* ---- by differences ---- */

enum { OF_BODY = 17, DATA = 2 * OF_BODY + 5 };

static double *number_of(impact_collision *c, int k)
{
    impact_collider *b = &c->body[k / OF_BODY % 2];
    double *const body[OF_BODY] = {
        &b->mass,     &b->moments.x,     &b->moments.y,     &b->moments.z,     &b->offset.x,     &b->offset.y,
        &b->offset.z, &b->velocity.x,    &b->velocity.y,    &b->velocity.z,    &b->omega.x,      &b->omega.y,
        &b->omega.z,  &b->orientation.w, &b->orientation.x, &b->orientation.y, &b->orientation.z};
    double *const contact[] = {&c->normal.x, &c->normal.y, &c->normal.z, &c->friction, &c->restitution};
    return k < 2 * OF_BODY ? body[k % OF_BODY] : contact[k - 2 * OF_BODY];
}

typedef struct velocities {
    qvec3 v[2], w[2];
} velocities;

/* False: no answer, or by other phases than `like`. */
typedef bool answerer(const impact_collision *c, const impact_outcome *like, velocities *out);

static bool same_phases(const impact_outcome *a, const impact_outcome *b)
{
    return a->phase_count == b->phase_count && memcmp(a->phases, b->phases, (size_t)a->phase_count) == 0;
}

static bool by_library(const impact_collision *c, const impact_outcome *like, velocities *out)
{
    impact_outcome o;
    if (impact_collide(c, &o) != IMPACT_OK || !same_phases(&o, like)) return false;
    memcpy(out->v, o.velocity, sizeof out->v);
    memcpy(out->w, o.omega, sizeof out->w);
    return true;
}

/* Every number up and down by `by` of itself; NaN where an answer is missing. */
static double by_differences(impact_collision c, const impact_outcome *o, answerer *answer, double by)
{
    double sum = 0;
    c.any_restitution = true;
    for (int k = 0; k < DATA; k++) {
        impact_collision up = c, down = c;
        velocities above, below;
        const double x = *number_of(&c, k);
        if (x == 0 || isinf(x)) continue;
        *number_of(&up, k) = x + by * x;
        *number_of(&down, k) = x - by * x;
        if (!answer(&up, o, &above) || !answer(&down, o, &below)) return NAN;
        const double moved = case_error(&c, above.v, above.w, below.v, below.w) / (2 * by);
        sum += moved * moved;
    }
    return sqrt(sum);
}

/* A change by 2^-28 is small beside slips of 1e-6, and rounding of the answers, 30 eps s, is 2e-6 s of it. Where a
 * velocity is left of 1e-5 of what it was, it bends by 1e5 2^-28 of itself. */
static void every_class(void **state)
{
    (void)state;
    for (int class_ = 0; class_ < CASE_RANGE; class_++) {
        if (class_ == CASE_REST) continue;
        int compared = 0;
        for (uint64_t i = 0; i < 200; i++) {
            const impact_collision c = case_make((case_class)class_, 71, i);
            impact_outcome o;
            assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
            const double wanted = by_differences(c, &o, by_library, 0x1p-28), s = impact_collide_sensitivity(&c);
            assert_true(s > 0);
            if (isnan(wanted)) continue; /* a change that takes it to other phases */
            if (!(fabs(s - wanted) <= (1e-5 + 0x1p-28 * s) * wanted))
                fail_msg("%s %d: %.9g, not %.9g", case_name((case_class)class_), (int)i, s, wanted);
            compared++;
        }
        assert_true(compared >= 190);
    }
}

#ifdef HAVE_QUADMATH
static bool by_oracle(const impact_collision *c, const impact_outcome *like, velocities *out)
{
    oracle_outcome o;
    (void)like;
    if (!oracle_collide(c, &o)) return false;
    memcpy(out->v, o.velocity, sizeof out->v);
    memcpy(out->w, o.omega, sizeof out->w);
    return true;
}

/* What is left of a velocity, of 1e-5 of what it was, bends by (1e5 2^-30)^2 of itself. */
static void every_class_in_128_bits(void **state)
{
    (void)state;
    int compared = 0;
    for (int class_ = 0; class_ < CASE_RANGE; class_++)
        for (uint64_t i = 0; i < 1; i++) {
            if (class_ == CASE_REST) continue;
            const impact_collision c = case_make((case_class)class_, 73, i);
            impact_outcome o;
            assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
            const double wanted = by_differences(c, &o, by_oracle, 0x1p-30), s = impact_collide_sensitivity(&c);
            if (isnan(wanted)) continue;
            if (!(fabs(s - wanted) <= 1e-6 * wanted))
                fail_msg("%s %d: %.9g, not %.9g", case_name((case_class)class_), (int)i, s, wanted);
            compared++;
        }
    assert_true(compared >= 9);
}
#endif

/* From u_t = 0: what sticks follows as any other; where it slides on there is a derivative on one side only, and what
 * is said is that along the slip, near the mean of both. */
static void from_rest(void **state)
{
    (void)state;
    int sliding = 0, sticking = 0;
    for (uint64_t i = 0; i < 1000; i++) {
        const impact_collision c = case_make(CASE_REST, 77, i);
        impact_outcome o;
        assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
        impact_collision free = c;
        free.any_restitution = true;
        double sum = 0;
        for (int k = 0; k < DATA; k++) {
            impact_outcome above, below;
            impact_collision up = free, down = free;
            const double x = *number_of(&free, k), by = 0x1p-24;
            if (x == 0 || isinf(x)) continue;
            *number_of(&up, k) = x + by * x;
            *number_of(&down, k) = x - by * x;
            assert_int_equal(impact_collide(&up, &above), IMPACT_OK);
            assert_int_equal(impact_collide(&down, &below), IMPACT_OK);
            const double moved = case_error(&c, above.velocity, above.omega, below.velocity, below.omega) / (2 * by);
            sum += moved * moved;
        }
        const double said = impact_collide_sensitivity(&c) / sqrt(sum);
        const bool sticks = o.phases[0] == IMPACT_STICK_C;
        if (!(fabs(said - 1) <= (sticks ? 1e-5 : 0.25))) fail_msg("%d: %.9g of the difference", (int)i, said);
        sliding += !sticks;
        sticking += sticks;
    }
    assert_true(sliding > 200 && sticking > 200);
}

/* ---- what CVODE alone answers ---- */

static double constant(double speed, void *context)
{
    (void)speed;
    return *(const double *)context;
}

/* A friction law that is constant: as its constant, but for the column of friction itself. */
static void a_friction_law(void **state)
{
    (void)state;
    if (!impact_has(IMPACT_PART_CVODE)) skip();
    for (uint64_t i = 0; i < 8; i++) {
        impact_collision c = case_make(CASE_PLAIN, 79, i);
        double mu = c.friction;
        impact_outcome o;
        c.friction_law = constant;
        c.friction_context = &mu;
        assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
        const double s = impact_collide_sensitivity(&c);
        impact_collision plain = c, more = c;
        plain.friction_law = NULL;
        more.friction_law = NULL;
        more.friction *= 1 + 0x1p-24;
        impact_outcome other;
        assert_int_equal(impact_collide(&plain, &o), IMPACT_OK);
        assert_int_equal(impact_collide(&more, &other), IMPACT_OK);
        const double of_mu = case_error(&c, other.velocity, other.omega, o.velocity, o.omega) * 0x1p24;
        const double all = impact_collide_sensitivity(&plain);
        assert_near(s, sqrt(all * all - of_mu * of_mu), 1e-4 * all);
    }
}

/* Straight down on a compliant contact nothing happens across it. */
static void a_compliant_contact(void **state)
{
    (void)state;
    if (!impact_has(IMPACT_PART_CVODE)) skip();
    const impact_collision c = {.body = {{1, {1, 1, 1}, {1, 0, 0, 0}, {0, 0, -1}, {0, 0, -1}, {0, 0, 0}}, floor_body},
                                .normal = {0, 0, 1},
                                .friction = 0.3,
                                .restitution = 0.5,
                                .law = IMPACT_STRONGE,
                                .tangential_compliance = 1.2};
    assert_near(impact_collide_sensitivity(&c), sqrt(2), 1e-5);
}

/* ---- events that just happen ---- */

/* Between friction with which a contact is compressed once and with which it is twice the answer jumps, where it ends
 * just before it is compressed again: infinite on both sides, to the last bit of friction. Where it does not jump (the
 * second compression begins with a stop) both sides have a derivative. */
static void jumps(void **state)
{
    (void)state;
    int found = 0, infinite = 0, steady = 0;
    for (uint64_t i = 0; i < 200000 && found < 30; i++) {
        const impact_collision c = case_make(CASE_WILD, 83, i);
        impact_collision below = c, above = c;
        impact_outcome o, p;
        below.law = above.law = IMPACT_POISSON;
        if (impact_collide(&above, &o) != IMPACT_OK || o.compressions != 2 || o.conditioning > 1e3) continue;
        for (int k = 0; k < 60; k++) {
            impact_collision mid = above;
            mid.friction = (k == 0 ? 0 : below.friction + above.friction) / 2;
            assert_int_equal(impact_collide(&mid, &o), IMPACT_OK);
            *(o.compressions == 2 ? &above : &below) = mid;
        }
        assert_int_equal(impact_collide(&above, &o), IMPACT_OK);
        assert_int_equal(impact_collide(&below, &p), IMPACT_OK);
        const double of_above = impact_collide_sensitivity(&above), of_below = impact_collide_sensitivity(&below);
        if (case_error(&c, o.velocity, o.omega, p.velocity, p.omega) < 1e-12) {
            assert_true(isfinite(of_above) && isfinite(of_below));
            steady++;
            continue;
        }
        found++;
        infinite += of_above == INFINITY && of_below == INFINITY;
    }
    /* without 113 bits it is by differences, which are finite */
    assert_true(found == 30 && infinite >= (IMP_HAS_SECOND ? 27 : 0) && steady > 0);
}

/* Where u_z stands still as it comes to 0 there is no derivative: M = [[1, 0, .5], [0, 1, 0], [.5, 0, 1]], mu = 2, and
 * a slip along t1, in which Z = 1 - mu/2. */
static void a_tie(void **state)
{
    (void)state;
    const imp_frame frame = {.a = 1, .b = 1, .c = 0.5, .schur = 1, .k = 0.75, .alpha = -0.5, .scale = 1};
    const unsigned char phases[] = {IMPACT_SLIP_C, IMPACT_SLIP_R};
    const double reached[] = {0.1, 0.2};
    for (int half = 0; half < 2; half++) {
        const impact_collision c = {.friction = half ? 1 : 2, .restitution = 1};
        imp_course start;
        imp_variation v;
        imp_course_start(&start, &frame, &c, 1, 0);
        assert_true(imp_variation_make(&start, phases, reached, 2, &v));
        assert_int_equal(v.tied, !half);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_on_paper),
        cmocka_unit_test(a_ball_that_slides),
        cmocka_unit_test(what_nearly_stops),
        cmocka_unit_test(refused),
        cmocka_unit_test(every_class),
#ifdef HAVE_QUADMATH
        cmocka_unit_test(every_class_in_128_bits),
#endif
        cmocka_unit_test(from_rest),
        cmocka_unit_test(a_friction_law),
        cmocka_unit_test(a_compliant_contact),
        cmocka_unit_test(jumps),
        cmocka_unit_test(a_tie),
    };
    return cmocka_run_group_tests_name("impact collide_sensitivity", tests, NULL, NULL);
}
