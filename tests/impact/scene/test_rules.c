/* SPDX-License-Identifier: MIT
 *
 * What two bodies share: their materials by each rule, the sums of what resists turning, and a pair's own values over
 * both, found among many. A body's static side comes second.
 */
#include "scene/rules.h"
#include "kit/contact_random.h"
#include "kit/near.h"

enum { BODIES = 12, PAIRS = 40 };

typedef struct stock {
    imp_arena *arena;
    imp_names names;
    imp_body body[BODIES];
    imp_world world;
    impact_pair_def own[PAIRS];
    int count;
    impact_scene_def def;
    imp_rules rules;
} stock;

static const char *const name_of[BODIES] = {"a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l"};

static double perhaps(random_stream *random, double unset)
{
    return random_unit(random) < 0.3 ? unset : random_unit(random);
}

/* Every pair at most once, in any order, named either way round. */
static void take_pairs(stock *s, random_stream *random)
{
    bool taken[BODIES][BODIES] = {{false}};
    s->count = 0;
    for (int k = 0; k < PAIRS; k++) {
        const int i = (int)(BODIES * random_unit(random)), j = (int)(BODIES * random_unit(random));
        if (i == j || taken[i][j]) continue;
        taken[i][j] = taken[j][i] = true;
        s->own[s->count++] = (impact_pair_def){.body1 = name_of[i],
                                               .body2 = name_of[j],
                                               .friction = perhaps(random, NAN),
                                               .restitution = perhaps(random, NAN),
                                               .torsional_friction = perhaps(random, NAN),
                                               .rolling_friction = perhaps(random, NAN),
                                               .stiffness = perhaps(random, 0)};
    }
}

static void open_stock(stock *s, random_stream *random, impact_pair_rule friction, impact_pair_rule restitution)
{
    assert_int_equal(imp_arena_create(NULL, &s->arena), IMPACT_OK);
    assert_int_equal(imp_names_open(&s->names, s->arena, BODIES), IMPACT_OK);
    for (int i = 0; i < BODIES; i++) {
        assert_int_equal(imp_names_add(&s->names, name_of[i]), IMPACT_OK);
        s->body[i] = (imp_body){.is_static = random_unit(random) < 0.3,
                                .friction = random_unit(random),
                                .restitution = random_unit(random),
                                .torsional = random_unit(random),
                                .rolling = random_unit(random)};
    }
    s->world = (imp_world){.bodies = s->body, .body_count = BODIES};
    take_pairs(s, random);
    s->def = (impact_scene_def){
        .friction_rule = friction, .restitution_rule = restitution, .pairs = s->own, .pair_count = s->count};
    assert_int_equal(imp_rules_open(&s->rules, s->arena, &s->def, &s->names), IMPACT_OK);
}

/* As docs/scene.md has them. */
static double by_rule(impact_pair_rule rule, double a, double b)
{
    const double less = a < b ? a : b, more = a < b ? b : a;
    if (rule == IMPACT_MINIMUM) return less;
    if (rule == IMPACT_MAXIMUM) return more;
    return rule == IMPACT_PRODUCT ? a * b : pow(a * b, 0.5);
}

static const impact_pair_def *own_of(const stock *s, int i, int j)
{
    for (int k = 0; k < s->count; k++) {
        const int one = imp_names_find(&s->names, s->own[k].body1), two = imp_names_find(&s->names, s->own[k].body2);
        if ((one == i && two == j) || (one == j && two == i)) return &s->own[k];
    }
    return NULL;
}

static void check_pair(const stock *s, int i, int j)
{
    static const impact_pair_def nothing = {
        .friction = NAN, .restitution = NAN, .torsional_friction = NAN, .rolling_friction = NAN};
    const imp_body *a = &s->body[i], *b = &s->body[j];
    const impact_pair_def *found = own_of(s, i, j), *own = found ? found : &nothing;
    const imp_pair pair = imp_rules_pair(&s->rules, &s->world, i, j);
    const double friction = by_rule(s->def.friction_rule, a->friction, b->friction),
                 restitution = by_rule(s->def.restitution_rule, a->restitution, b->restitution);
    assert_near(pair.law.friction, isnan(own->friction) ? friction : own->friction, 1e-15);
    assert_near(pair.law.restitution, isnan(own->restitution) ? restitution : own->restitution, 1e-15);
    assert_near(pair.law.torsional,
                isnan(own->torsional_friction) ? a->torsional + b->torsional : own->torsional_friction, 1e-15);
    assert_near(pair.law.rolling, isnan(own->rolling_friction) ? a->rolling + b->rolling : own->rolling_friction,
                1e-15);
    assert_true(pair.law.stiffness == own->stiffness);
    const int low = i < j ? i : j, high = i < j ? j : i, first = s->body[low].is_static ? high : low;
    assert_true(pair.body1 == first && pair.body2 == low + high - first && pair.mode == IMP_OPEN);
}

static void pairs_are_what_their_rules_say(void **state)
{
    (void)state;
    random_stream random = {51};
    static const impact_pair_rule rules[] = {IMPACT_PRODUCT, IMPACT_GEOMETRIC_MEAN, IMPACT_MINIMUM, IMPACT_MAXIMUM};
    for (int k = 0; k < 16; k++) {
        static stock s;
        open_stock(&s, &random, rules[k % 4], rules[k / 4]);
        assert_true(s.count > 10);
        for (int i = 0; i < BODIES; i++)
            for (int j = 0; j < BODIES; j++)
                if (i != j) check_pair(&s, i, j);
        imp_arena_destroy(s.arena);
    }
}

/* Two rules for one pair, whichever body is named first, are refused by their names: either could be meant. */
static void two_rules_for_a_pair_are_refused(void **state)
{
    (void)state;
    const char *names[] = {"a", "b", "c"};
    impact_body_def bodies[3];
    for (int i = 0; i < 3; i++) {
        bodies[i] = impact_default_body_def();
        bodies[i].name = names[i];
        bodies[i].position.x = 3 * i;
        assert_int_equal(impact_shape_sphere(1, &bodies[i].shape), IMPACT_OK);
    }
    const char *of[3][2] = {{"c", "b"}, {"a", "b"}, {"b", "c"}};
    impact_pair_def rules[3];
    for (int k = 0; k < 3; k++) {
        rules[k] = impact_default_pair_def(of[k][0], of[k][1]);
        rules[k].friction = 0.25 * k;
    }
    impact_scene_def def = impact_default_scene_def();
    def.bodies = bodies, def.body_count = 3;
    def.pairs = rules, def.pair_count = 3;
    def.duration = 1;
    impact_scene *scene = NULL;
    char why[200];
    assert_int_equal(impact_scene_create(&def, &scene, why, sizeof why), IMPACT_EARGUMENT);
    assert_string_equal(why, "pair with 'b': its rule with 'c' is given twice");
    def.pair_count = 2;
    assert_int_equal(impact_scene_create(&def, &scene, why, sizeof why), IMPACT_OK);
    impact_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(pairs_are_what_their_rules_say),
                                       cmocka_unit_test(two_rules_for_a_pair_are_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
