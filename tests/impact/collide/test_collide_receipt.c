/* SPDX-License-Identifier: MIT
 *
 * Receipts: small for every right answer, large for each kind of wrong one, NaN for NaN; and the ladder that a receipt
 * that does not pass sends an impact up.
 */
#include <float.h>

#include <impact/collide.h>
#include "collide/collide_real.h"
#include "generators/collide_cases.h"
#include "kit/near.h"

static const double limit = 1e4;

static void right_answers(void **state)
{
    (void)state;
    int count = 0, over = 0;
    for (int class_ = 0; class_ < CASE_RANGE; class_++)
        for (uint64_t i = 0; i < 4000; i++) {
            const impact_collision c = case_make((case_class)class_, 41, i);
            impact_outcome o;
            impact_receipt r;
            assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
            const double worst = impact_collide_receipt(&c, &o, &r);
            assert_true(worst == r.worst && worst <= limit && !o.second);
            assert_true(o.error > 0);
            count++;
            over += worst > 100;
        }
    assert_true(over * 2000 <= count);
}

/* Of slips that turn most are known by the hodograph, to a unit or two of what rounding leaves. */
static void hodographs(void **state)
{
    (void)state;
    static const case_class classes[] = {CASE_PLAIN, CASE_WILD, CASE_ROD, CASE_TANGENT, CASE_SLENDER};
    for (int k = 0; k < 5; k++) {
        int count = 0, known = 0;
        for (uint64_t i = 0; i < 4000; i++) {
            const impact_collision c = case_make(classes[k], 53, i);
            impact_outcome o;
            impact_receipt r;
            assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
            if (o.solver != IMPACT_SOLVER_SERIES) continue;
            impact_collide_receipt(&c, &o, &r);
            assert_at_most(r.hodograph, 10);
            count++;
            known += r.slips > 0;
        }
        assert_true(2 * known > count);
    }
}

/* Slid with a tenth less friction than there is, an impact keeps every other identity, the cone among them. */
static void only_the_hodograph_sees_a_wrong_way(void **state)
{
    (void)state;
    int seen = 0, known = 0;
    for (uint64_t i = 0; i < 2000; i++) {
        const impact_collision c = case_make(CASE_PLAIN, 59, i);
        impact_collision less = c;
        impact_outcome o;
        impact_receipt r;
        less.friction *= 0.9;
        assert_int_equal(impact_collide(&less, &o), IMPACT_OK);
        if (o.solver != IMPACT_SOLVER_SERIES || o.conditioning > 10) continue;
        impact_collide_receipt(&c, &o, &r);
        if (r.slips == 0) continue;
        known++;
        seen += r.hodograph > limit;
        const double others[] = {r.momentum, r.spin, r.cone, r.energy, r.power, r.law, r.approach, r.stick, r.path};
        for (int k = 0; k < 9; k++) assert_true(others[k] <= limit);
    }
    assert_true(known > 1000 && seen * 100 >= known * 99);
}

/* What has no closed form, sticks at the end and was compressed once, so that every identity has something to say. */
static impact_collision telling(uint64_t i, impact_outcome *o)
{
    for (uint64_t k = 1000 * i;; k++) {
        impact_collision c = case_make(CASE_PLAIN, 43, k);
        if (isinf(c.body[0].mass) || isinf(c.body[1].mass) || !(c.restitution > 0.1) || !(c.friction > 0.1)) continue;
        if (impact_collide(&c, o) != IMPACT_OK || o->solver != IMPACT_SOLVER_SERIES || o->compressions != 1) continue;
        if (o->conditioning < 10 && o->phases[o->phase_count - 1] == IMPACT_STICK_R) return c;
    }
}

static qvec3 tilted(qvec3 v, double by) { return (qvec3){v.x + by * v.y, v.y + by * v.z, v.z + by * v.x}; }

typedef enum lie {
    LIE_VELOCITY,
    LIE_SPIN,
    LIE_IMPULSE,
    LIE_PART,
    LIE_COMPRESSION,
    LIE_WORK,
    LIE_FRICTION,
    LIE_ENERGY,
    LIE_APPROACH,
    LIE_PATH,
    LIES
} lie;

/* The outcome changed by 1e-9 of something; the field that is to notice. */
static const double *tell(lie which, impact_outcome *o, const impact_receipt *r)
{
    const double by = 1e-9;
    switch (which) {
    case LIE_VELOCITY: o->velocity[0] = tilted(o->velocity[0], by); return &r->momentum;
    case LIE_SPIN: o->omega[1] = tilted(o->omega[1], by); return &r->spin;
    case LIE_IMPULSE: o->impulse = tilted(o->impulse, by); return &r->momentum;
    case LIE_PART: o->impulse_normal *= 1 + by; return &r->approach;
    case LIE_COMPRESSION: o->compression_impulse *= 1 + by; return &r->law;
    case LIE_WORK: o->work_restitution *= 1 + 10 * by; return &r->power;
    case LIE_FRICTION: o->work_friction = by * -o->work_compression; return &r->energy;
    case LIE_ENERGY: o->energy_after *= 1 + by; return &r->energy;
    case LIE_APPROACH: o->normal_after *= 1 + 10 * by; return &r->approach;
    default: o->phase_impulse[0] = tilted(o->phase_impulse[0], 100 * by); return &r->path;
    }
}

static void lies_are_noticed(void **state)
{
    (void)state;
    for (uint64_t i = 0; i < 60; i++) {
        impact_outcome right;
        impact_receipt r;
        impact_collision c = telling(i, &right);
        for (int k = 0; k < LIES; k++) {
            if (k == LIE_COMPRESSION && c.law != IMPACT_POISSON) continue;
            impact_outcome o = right;
            const double *field = tell((lie)k, &o, &r);
            const double worst = impact_collide_receipt(&c, &o, &r);
            if (!(*field > limit && worst > limit)) fail_msg("case %d, lie %d: %g, worst %g", (int)i, k, *field, worst);
        }
        /* Of what was asked: less friction than was used, another restitution, another law. */
        impact_collision other = c;
        const qvec3 n = qvec3_scale(c.normal, 1 / qvec3_norm(c.normal));
        const double along = qvec3_dot(right.impulse, n), across = qvec3_norm(qvec3_axpy(-along, n, right.impulse));
        other.friction = across / along * (1 - 1e-9);
        assert_true(impact_collide_receipt(&other, &right, &r) > limit && r.cone > limit);
        other = c;
        other.restitution *= 1 - 1e-9;
        assert_true(impact_collide_receipt(&other, &right, &r) > limit && r.law > limit);
    }
}

/* More energy than there was, by an impulse that is too large: momentum, spin and cone hold, the law does not ask. */
static void energy_that_rises(void **state)
{
    (void)state;
    impact_collision c = case_make(CASE_SMOOTH, 3, 0);
    impact_outcome o;
    impact_receipt r;
    c.law = IMPACT_POISSON;
    c.any_restitution = true;
    c.restitution = 1 + 1e-9;
    assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
    assert_true(impact_collide_receipt(&c, &o, &r) < limit);
    c.restitution = 1;
    assert_true(impact_collide_receipt(&c, &o, &r) > limit && r.energy > limit);
}

static void nan_never_passes(void **state)
{
    (void)state;
    const impact_collision c = case_make(CASE_PLAIN, 3, 1);
    impact_outcome right, o;
    impact_receipt r;
    assert_int_equal(impact_collide(&c, &right), IMPACT_OK);
    double *const fields[] = {&o.velocity[0].x, &o.velocity[1].z,     &o.omega[0].y,       &o.omega[1].x,
                              &o.impulse.z,     &o.impulse_normal,    &o.normal_before,    &o.normal_after,
                              &o.work_friction, &o.work_compression,  &o.work_restitution, &o.energy_before,
                              &o.energy_after,  &o.phase_impulse[0].x};
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++) {
        o = right;
        if (i < 4 && isinf(c.body[i % 2].mass)) continue;
        *fields[i] = NAN;
        assert_true(isnan(impact_collide_receipt(&c, &o, &r)));
    }
}

/* In wide units the receipt is the same. */
static void units(void **state)
{
    (void)state;
    for (uint64_t i = 0; i < 500; i++) {
        impact_collision c = case_make(CASE_PLAIN, 45, i);
        impact_outcome o;
        impact_receipt r;
        for (int k = 0; k < 2; k++) {
            c.body[k].mass *= 0x1p400;
            c.body[k].moments = qvec3_scale(c.body[k].moments, 0x1p400);
            c.body[k].velocity = qvec3_scale(c.body[k].velocity, 0x1p-300);
            c.body[k].omega = qvec3_scale(c.body[k].omega, 0x1p-300);
        }
        assert_int_equal(impact_collide(&c, &o), IMPACT_OK);
        assert_at_most(impact_collide_receipt(&c, &o, &r), 100);
    }
}

/* A static body that moves does work: by closed forms and by the series. */
static void moving_walls(void **state)
{
    (void)state;
    const impact_receipt none = {0};
    for (uint64_t i = 0; i < 3000; i++) {
        impact_collision c = case_make(i % 2 ? CASE_SPHERE : CASE_ROD, 51, i);
        impact_outcome o;
        impact_receipt r = none;
        if (isinf(c.body[0].mass) || isinf(c.body[1].mass)) continue;
        c.body[i % 4 / 2].mass = INFINITY;
        c.body[0].velocity = qvec3_scale(c.body[0].velocity, 3);
        c.body[1].omega = qvec3_scale(c.body[1].omega, 2);
        const impact_status status = impact_collide(&c, &o);
        if (status == IMPACT_SEPARATING) continue;
        assert_int_equal(status, IMPACT_OK);
        assert_at_most(impact_collide_receipt(&c, &o, &r), 100);
    }
}

/* Numbers that double cannot settle are settled in 128 bits, or said to be soft; never OK with a receipt that fails. */
static void the_ladder(void **state)
{
    (void)state;
    int second = 0, soft = 0;
    for (uint64_t i = 0; i < 400; i++) {
        const impact_collision c = case_make(CASE_RANGE, 47, i);
        impact_outcome o;
        impact_receipt r;
        const impact_status status = impact_collide(&c, &o);
        if (status < 0 || status == IMPACT_SEPARATING) continue;
        const double worst = impact_collide_receipt(&c, &o, &r);
        if (status == IMPACT_OK && o.solver != IMPACT_SOLVER_CVODE) assert_at_most(worst, limit);
        if (status == IMPACT_SOFT) assert_true(!(worst <= limit));
        const double works = o.work_compression + o.work_restitution + o.work_friction;
        assert_true(c.law == IMPACT_NEWTON || works <= 1e-11 * -o.work_compression);
        second += o.second;
        soft += status == IMPACT_SOFT;
    }
    assert_true(IMP_HAS_SECOND ? second > 5 && soft < 40 : second == 0 && soft > 0);
}

/* Arrays are checked when asked. */
static void arrays(void **state)
{
    (void)state;
    enum { COUNT = 400 };
    static impact_collision c[COUNT];
    static impact_outcome o[COUNT];
    for (int i = 0; i < COUNT; i++) c[i] = case_make((case_class)(i % CASE_CLASSES), 49, (uint64_t)i);
    for (int checking = IMPACT_CHECK_AUTO; checking <= IMPACT_CHECK_NEVER; checking++) {
        for (int i = 0; i < COUNT; i++) c[i].checking = (impact_checking)checking;
        assert_int_equal(impact_collide_many(c, COUNT, 2, o, NULL), IMPACT_OK);
        for (int i = 0; i < COUNT; i++) {
            impact_outcome one;
            assert_int_equal(impact_collide(&c[i], &one), IMPACT_OK);
            assert_true((o[i].error > 0) == (checking == IMPACT_CHECK_ALWAYS));
            assert_true((one.error > 0) == (checking != IMPACT_CHECK_NEVER));
            assert_memory_equal(&one.impulse, &o[i].impulse, sizeof one.impulse);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(right_answers),
        cmocka_unit_test(hodographs),
        cmocka_unit_test(only_the_hodograph_sees_a_wrong_way),
        cmocka_unit_test(lies_are_noticed),
        cmocka_unit_test(energy_that_rises),
        cmocka_unit_test(nan_never_passes),
        cmocka_unit_test(units),
        cmocka_unit_test(the_ladder),
        cmocka_unit_test(arrays),
        cmocka_unit_test(moving_walls),
    };
    return cmocka_run_group_tests_name("impact collide_receipt", tests, NULL, NULL);
}
