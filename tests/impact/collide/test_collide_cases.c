/* SPDX-License-Identifier: MIT
 *
 * Impacts that were once answered wrong with IMPACT_OK, or never, and their neighbours: each is right by its receipt,
 * or refused in words.
 */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>
#include <stdlib.h>
#include <string.h>
#include <impact/collide.h>
#include "generators/collide_cases.h"

static const impact_collision nan_was_answered_as_ok = {
    .body = {{.mass = 0x1.999999999999ap-3,
              .moments = {0x1.cb9de0f05549fp-3, 0x1.2b431bb0f209dp-2, 0x1.15d0ae178f203p-4},
              .orientation = {0x1.cd284cfdbf06p-2, -0x1.8aba9a0b4c3d2p-1, 0x1.cd284cfdbf06p-2, -0x1.357a41c491acap-28},
              .offset = {-0x1.999999999999ap-3, -0x1.e56fb8afcfd1cp-2, -0x1.a38347068e0d2p+0},
              .velocity = {-0x1.a1934326864d1p-1, -0x1.2d725ae4b5c97p+0, 0x1p+0},
              .omega = {0x1p+0, -0x1.999999999999ap+0, 0x1.f82e489a65913p-1}},
             {.mass = 0x1p+0,
              .moments = {0x1p+0, 0x1.cd2b297d889bcp-53, 0x1.0000000000001p+0},
              .orientation = {0x0p+0, -0x1.cca8fd58b1642p-54, -0x1.809654fd88b9ep-5, -0x1.ff6f7ac4a5e51p-1},
              .offset = {0x0p+0, -0x1.6956d2ada55b5p+0, -0x0p+0},
              .velocity = {0x1.cd2b297d889bcp-53, -0x1.eb63d6c7ad8f6p-3, 0x1.b9a37346e68ddp-2},
              .omega = {0x1.cc21a0562b4a2p-1, 0x1.12e225c44b889p-3, -0x1.5bca4fc35fa3dp-3}}},
    .normal = {0x0p+0, 0x1.3333333333333p-1, -0x1.f0ebe1d7c3af8p+0},
    .friction = 0x1.8fffffffffff2p+6,
    .restitution = 0x1.999999999999ap-4,
    .law = 0,
    .solver = 0};

static const impact_collision energy_rose_twelvefold = {
    .body = {{.mass = 0x1p+0,
              .moments = {0x1.121513fcb37fep-5, 0x1.121513fcb37fep-5, 0x1.89c82fc67b27ep-7},
              .orientation = {-0x1.67484aff57822p-1, 0x1.dc19617e7b614p-4, 0x1.7ccb16e1d5059p-53,
                              -0x1.67e2feb60aae1p-1},
              .offset = {0x1.69e9d47b46c9cp-1, -0x1.0dba1b7436e87p+0, 0x1p+0},
              .velocity = {0x0p+0, 0x1.3333333333333p-1, -0x1.35b8a69cfaad6p-1},
              .omega = {0x1.b8437086e10dcp+0, -0x1.19cd77d1d4787p-8, -0x1.fffffffffffffp+0}},
             {.mass = 0x1.ad1ac91376a78p-4,
              .moments = {0x1.5c218b8756196p-108, 0x1.45bdf8b7e4253p-114, 0x1.5849f7661a58cp-108},
              .orientation = {0x1.3059fbc24e81p-1, 0x1.177086bd5badp-23, -0x1.a6d50bf417e82p-10, 0x1.9bb85be5fec14p-1},
              .offset = {0x1.155e505cf78b9p-1, -0x1.3333333333333p-1, -0x1.027c04f809f01p+1},
              .velocity = {0x1.99999a37d51b2p-4, -0x0p+0, -0x1.d14ba297452e9p-1},
              .omega = {-0x1p+0, -0x1.a7d34fa69f4d4p-2, -0x1.29825304a6095p-2}}},
    .normal = {0x1.999999999999ap+0, 0x1p-1, 0x1p+0},
    .friction = 0x1.24a89586981f8p+5,
    .restitution = 0x1.999999999999ap-4,
    .law = 2,
    .solver = 0};

static const impact_collision speeds_of_1e149_never_came_back = {
    .body = {{.mass = 0x1.f103e207c40f9p+0,
              .moments = {0x1.f103e207c40f9p+0, 0x1.8d9cb4d3033fbp-2, 0x1.8d9cb4d3033fap+0},
              .orientation = {-0x1.360da48a2b197p-1, -0x1.e88f9042562dfp-3, -0x1.417e4847939f6p-2,
                              -0x1.61e94e45a1c51p-1},
              .offset = {0x1.f907d18b6f3acp-301, -0x0p+0, -0x1p-1},
              .velocity = {0x1.050955b32fc18p-202, 0x1.0f1a5e445b29cp+379, 0x1.810b0216042c1p+0},
              .omega = {-0x1.ae575caeb95d7p+0, 0x0p+0, 0x1.4a8729fc3ddb7p-399}},
             {.mass = 0x1.5798ee2308c3ap-26,
              .moments = {0x1.5798ee2308c3ap-128, 0x1.5798ee2308c3ap-179, 0x1.5798ee2308c39p-128},
              .orientation = {0x1.f90e4515923f4p-2, 0x1.f8a9a95a94003p-3, 0x1.926bc71b243e2p-1, 0x1.1e72e406a1c15p-2},
              .offset = {-0x1.a43f487e90fd2p+0, -0x1.2ae255c4ab895p-1, -0x1.7732ee65dccbcp-2},
              .velocity = {0x0p+0, -0x1.adf50ce012cadp+496, 0x0p+0},
              .omega = {0x1p+0, -0x1.999999999999ap+0, 0x1.58576f7889ed6p-125}}},
    .normal = {0x1.0137987dd704cp-2, 0x0p+0, -0x1.fffffe746b3d3p-1},
    .friction = 0x1p+0,
    .restitution = 0x1.433286650cca2p-2,
    .law = 2,
    .solver = 0};

static const impact_collision *const kept[] = {&nan_was_answered_as_ok, &energy_rose_twelvefold,
                                               &speeds_of_1e149_never_came_back};

enum { KEPT = sizeof kept / sizeof *kept, NEIGHBOURS = 4000 };

static uint64_t seed;
static double draw(void) /* [0, 1) */
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(seed >> 11) * 0x1p-53;
}

/* Refused in words, or finite, within its receipt unless it says otherwise, and without energy gained; 1: answered. */
static int right_or_refused(const impact_collision *hit)
{
    char why[256] = "";
    impact_outcome out;
    const impact_status checked = impact_collide_check(hit, why, sizeof why), status = impact_collide(hit, &out);
    assert_true((checked < 0) == (strlen(why) > 0));
    if (checked < 0) assert_int_equal(status, checked);
    if (status < 0 || status == IMPACT_SEPARATING) return 0;
    for (int body = 0; body < 2; body++)
        assert_true(qvec3_isfinite(out.velocity[body]) && qvec3_isfinite(out.omega[body]));
    impact_receipt receipt;
    const double worst = impact_collide_receipt(hit, &out, &receipt);
    if (status != IMPACT_SOFT) assert_true(worst <= 1e4);
    if (status != IMPACT_SOFT && hit->law != IMPACT_NEWTON)
        assert_true(out.energy_after <= out.energy_before * (1 + 0x1p-45));
    return 1;
}

static void kept_impacts_are_right_or_refused(void **state)
{
    (void)state;
    int answered = 0;
    for (int k = 0; k < KEPT; k++) answered += right_or_refused(kept[k]);
    assert_true(answered > 0 && answered < KEPT);
}

static double *numbers_of(impact_collider *body, int *count)
{
    *count = (int)((sizeof *body - offsetof(impact_collider, mass)) / sizeof(double));
    return &body->mass;
}

/* Each number of each kept impact off by rounding, by half, by a power of ten, or zero; other laws, other friction. */
static void so_are_their_neighbours(void **state)
{
    (void)state;
    int answered = 0, refused = 0;
    seed = 20261122;
    for (int k = 0; k < KEPT; k++)
        for (int i = 0; i < NEIGHBOURS; i++) {
            impact_collision hit = *kept[k];
            for (int changes = 1 + (int)(3 * draw()); changes > 0; changes--) {
                int count;
                double *numbers = numbers_of(&hit.body[draw() < 0.5], &count);
                double *x = &numbers[(int)(draw() * count)];
                const double how = draw();
                *x *= how < 0.4   ? 1 + (draw() - 0.5) * 0x1p-50
                      : how < 0.7 ? 0.5 + draw()
                      : how < 0.9 ? pow(10, 40 * (draw() - 0.5))
                                  : 0;
            }
            if (draw() < 0.3) hit.friction = pow(10, 20 * (draw() - 0.9));
            if (draw() < 0.3) hit.restitution = draw();
            if (draw() < 0.3) hit.law = (impact_law)(3 * draw());
            if (right_or_refused(&hit))
                answered++;
            else
                refused++;
        }
    assert_true(answered > NEIGHBOURS / 4 && refused > NEIGHBOURS / 4);
}

/* Units of mass, length and time that are powers of two change no more than the error that the answer tells. */
static void units_change_no_more_than_the_error_told(void **state)
{
    (void)state;
    for (int k = 0; k < KEPT; k++)
        for (int power = -30; power <= 30; power += 15) {
            impact_collision hit = *kept[k];
            const double mass = ldexp(1, power), length = ldexp(1, -power / 3), speed = ldexp(1, power / 5);
            for (int body = 0; body < 2; body++) {
                impact_collider *c = &hit.body[body];
                c->mass *= mass;
                c->moments = qvec3_scale(c->moments, mass * length * length);
                c->offset = qvec3_scale(c->offset, length);
                c->velocity = qvec3_scale(c->velocity, speed);
                c->omega = qvec3_scale(c->omega, speed / length);
            }
            impact_outcome here, there;
            const impact_status status = impact_collide(kept[k], &here);
            assert_int_equal(impact_collide(&hit, &there), status);
            if (status < 0) continue;
            for (int body = 0; body < 2; body++) {
                const qvec3 v = qvec3_scale(there.velocity[body], 1 / speed),
                            w = qvec3_scale(there.omega[body], length / speed);
                assert_true(qvec3_norm(qvec3_sub(v, here.velocity[body])) <= here.error * qvec3_norm(v));
                assert_true(qvec3_norm(qvec3_sub(w, here.omega[body])) <= here.error * qvec3_norm(w));
            }
        }
}

/* In double rounding took all of its impulse, and what that left of its receipt was NaN, which passed. */
static void an_impulse_lost_to_rounding(void **state)
{
    (void)state;
    const impact_collision hit = case_make(CASE_RANGE, 7, 90214);
    right_or_refused(&hit);
    impact_outcome out;
    assert_true(impact_collide(&hit, &out) != IMPACT_OK || qvec3_norm(out.impulse) > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_impulse_lost_to_rounding),
        cmocka_unit_test(kept_impacts_are_right_or_refused),
        cmocka_unit_test(so_are_their_neighbours),
        cmocka_unit_test(units_change_no_more_than_the_error_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
