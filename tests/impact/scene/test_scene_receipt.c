/* SPDX-License-Identifier: MIT
 *
 * A scene's receipt is told what is wrong: a ball that the wind drives over a rough floor is right, and then spoilt in
 * one place at a time, by an amount that the receipt has to name.
 */
#include "scene/scene_receipt.h"
#include "world/world_gap.h"
#include "kit/scene_ending.h"

#include <string.h>

typedef struct stage {
    impact_body_def bodies[2];
    impact_force_def wind;
    impact_scene_def def;
    impact_scene *scene;
    imp_island *island;
} stage;

/* At t = .25 the ball slides, the wind and friction have done work, and the island has been looked at before. */
static void raise_with(stage *s, double tolerance)
{
    memset(s, 0, sizeof *s);
    s->bodies[0] = floor_body(0.5, 0.5);
    s->bodies[1] = ball_body("ball", (qvec3){0, 0, 0.3}, 0.5, 0.5);
    s->bodies[1].velocity = (qvec3){3, 0, 0};
    s->wind = impact_default_force_def(IMPACT_FORCE_WIND);
    s->wind.name = "wind", s->wind.strength = 2, s->wind.direction = (qvec3){0, 1, 0};
    s->def = scene_of(s->bodies, 2, 1);
    s->def.forces = &s->wind, s->def.force_count = 1;
    s->def.tolerance = tolerance;
    s->scene = make_scene(&s->def);
    assert_true(impact_scene_run_to(s->scene, 0.25, NULL) >= 0);
    for (int k = 0; k < s->scene->island_count && !s->island; k++) s->island = s->scene->islands[k];
    assert_non_null(s->island);
    imp_island_go_to(s->island, 0.25);
    s->island->looked_at = 0.125;
}

static void raise(stage *s) { raise_with(s, 1e-13); }

static imp_state *ball_of(stage *s) { return &s->island->states[imp_island_find(s->island, 1)]; }

static void what_is_right_passes(void **state)
{
    (void)state;
    stage s;
    raise(&s);
    impact_scene_residuals *r = &s.scene->receipt;
    const long stretches = r->stretches;
    imp_scene_receipt_look(s.island);
    assert_null(r->failed);
    assert_true(r->stretches == stretches + 1 && r->begin == 0.125 && r->end == 0.25);
    assert_true(s.island->motion.works.force > 1e-3 && s.island->motion.works.sliding > 1e-1);
    assert_at_most(r->unit, 1e-15);
    assert_at_most(r->gap, 1e-12);
    assert_at_most(r->contact, 1e-12);
    assert_at_most(r->energy, 1e-11);
    assert_true(r->momentum == 0 && r->loss_fallen == 0);
    impact_scene_destroy(s.scene);
}

static void check_told(stage *s, const char *field, double value, double wanted, const char *words)
{
    const impact_scene_residuals *r = &s->scene->receipt;
    assert_non_null(r->failed);
    assert_string_equal(r->failed, field);
    assert_near(value, wanted, 1e-6 * wanted);
    assert_true(r->failed_begin == 0.125 && r->failed_end == 0.25);
    assert_int_equal(impact_scene_run_to(s->scene, 0.26, NULL), IMPACT_SOFT);
    const char *message = impact_scene_message(s->scene);
    if (!strstr(message, words)) fail_msg("'%s' does not say '%s'", message, words);
    assert_non_null(strstr(message, "first between t = 0.125 and 0.25: do not trust the digits"));
    impact_scene_destroy(s->scene);
}

static void what_is_wrong_is_told(void **state)
{
    (void)state;
    stage s;
    impact_scene_residuals *r;
    raise(&s), r = &s.scene->receipt;
    ball_of(&s)->q = quat_scale(ball_of(&s)->q, 1 + 1e-9);
    imp_scene_receipt_look(s.island);
    check_told(&s, "unit", r->unit, 1e-9, "orientations are off unit by 1e-09");

    raise(&s), r = &s.scene->receipt;
    ball_of(&s)->x.z += 1e-4;
    const imp_pair pair = s.island->world.pairs[0];
    const double size = imp_world_place_scale(&s.island->world, &pair, s.island->states);
    imp_scene_receipt_look(s.island);
    check_told(&s, "gap", r->gap, 1e-4 / size, "held contacts are apart or overlap by ");

    raise(&s), r = &s.scene->receipt;
    s.island->balance += 1e-3;
    imp_scene_receipt_look(s.island);
    check_told(&s, "energy", r->energy, 1e-3 / s.scene->greatest_energy, "the energy account is off by ");

    raise(&s), r = &s.scene->receipt;
    s.island->pushed.off = 1e-3;
    imp_scene_receipt_look(s.island);
    assert_true(s.island->pushed.off == 0);
    check_told(&s, "momentum", r->momentum, 1e-3,
               "impacts changed the momentum by 0.001 of it more than static bodies");

    raise(&s), r = &s.scene->receipt;
    s.island->loss_before = s.island->impact_loss + 0.5;
    imp_scene_receipt_look(s.island);
    check_told(&s, "loss_fallen", r->loss_fallen, 0.5, "losses of energy fell by 0.5 J of ");
}

/* Spoil one residual by so much. */
static void spoil_unit(stage *s, double by) { ball_of(s)->q = quat_scale(ball_of(s)->q, 1 + by); }

static void spoil_gap(stage *s, double by)
{
    const imp_pair pair = s->island->world.pairs[0];
    ball_of(s)->x.z += by * imp_world_place_scale(&s->island->world, &pair, s->island->states);
}

static void spoil_energy(stage *s, double by) { s->island->balance += by * s->scene->greatest_energy; }

static void spoil_momentum(stage *s, double by) { s->island->pushed.off = by; }

static void spoil_loss(stage *s, double by)
{
    s->island->loss_before = s->island->impact_loss + by * s->scene->greatest_energy;
}

/* The limits that docs/scene.md names, of a tolerance of 1e-12: less passes, more is told. */
static void limits_are_those_that_are_named(void **state)
{
    (void)state;
    static const struct {
        const char *field;
        void (*spoil)(stage *, double);
        double limit;
    } all[] = {{"unit", spoil_unit, 0x1p-49},
               {"gap", spoil_gap, 1e-9 + 1e-9},
               {"energy", spoil_energy, 1e-8 + 1e-9},
               {"momentum", spoil_momentum, 1e-12},
               {"loss_fallen", spoil_loss, 1e-8 + 1e-9}};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++)
        for (int more = 0; more < 2; more++) {
            stage s;
            raise_with(&s, 1e-12);
            impact_scene_residuals *r = &s.scene->receipt;
            assert_near(r->limit_contact, 1e-8, 0);
            all[k].spoil(&s, (more ? 1.5 : 0.7) * all[k].limit);
            imp_scene_receipt_look(s.island);
            if (more ? !r->failed || strcmp(r->failed, all[k].field) != 0 : r->failed != NULL)
                fail_msg("%s: %s", all[k].field, r->failed ? r->failed : "passes");
            impact_scene_destroy(s.scene);
        }
}

/* A NaN passes no comparison: it is wrong wherever it comes. */
static void no_number_is_wrong(void **state)
{
    (void)state;
    stage s;
    raise(&s);
    s.island->balance = NAN;
    imp_scene_receipt_look(s.island);
    assert_string_equal(s.scene->receipt.failed, "energy");
    assert_true(isnan(s.scene->receipt.energy));
    impact_scene_destroy(s.scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_right_passes),
        cmocka_unit_test(what_is_wrong_is_told),
        cmocka_unit_test(limits_are_those_that_are_named),
        cmocka_unit_test(no_number_is_wrong),
    };
    if (!impact_has(IMPACT_PART_CVODE)) return 0; /* what slides is its */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
