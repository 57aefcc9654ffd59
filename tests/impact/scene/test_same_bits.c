/* SPDX-License-Identifier: MIT
 *
 * The bits of a body's motion depend on its own events alone: not on pauses, on its number, on bodies far away, nor on
 * the units, over random scenes and over every setting that a definition has. (Saves: test_save.c.)
 */
#include "kit/random_scene.h"
#include "kit/same_bits.h"
#include "kit/scene_log.h"
#include "scene/saved.h"

enum { SCENES = 40, FAR = 20, MOST_BODIES = 1 + RANDOM_SCENE_BODIES + FAR };

/* A random scene that lands soon, and is short. */
static void make_short(unsigned long seed, random_scene *s)
{
    random_scene_make(seed, s);
    s->def.duration = fmin(s->def.duration, 0.2);
    s->def.gravity.z = -40;
    s->def.max_events = 300;
    if (seed % 5 == 0) s->def.piles = IMPACT_PILES_STEPS;
}

/* All bodies attract all: then there is no far. */
static bool is_tied(const impact_scene_def *def)
{
    return def->force_count > 0 && def->forces[0].kind == IMPACT_FORCE_ATTRACTION;
}

static impact_status run(impact_scene *scene)
{
    const impact_status status = impact_scene_run(scene, NULL);
    if (status < 0) fail_msg("%s", impact_scene_message(scene));
    return status;
}

/* ---- in parts ---- */

static void in_parts_is_the_whole(void **state)
{
    (void)state;
    if (!impact_has(IMPACT_PART_CVODE)) skip();
    for (unsigned long seed = 1; seed <= SCENES; seed++) {
        random_scene s;
        make_short(seed, &s);
        random_stream random = {seed + 500};
        impact_scene *whole = make_scene(&s.def), *parts = make_scene(&s.def);
        const impact_status ended = run(whole);
        double t = 0;
        for (int k = 0; k < 30; k++) {
            t += 0.1 * random_unit(&random) * (s.def.duration - t);
            if (t > impact_scene_time(parts)) impact_scene_run_to(parts, t, NULL);
        }
        assert_int_equal(impact_scene_run(parts, NULL), ended);
        if (!same_scene(whole, parts)) fail_msg("seed %lu: the parts are not the whole", seed);
        impact_scene_destroy(whole);
        impact_scene_destroy(parts);
    }
}

/* ---- far bodies ---- */

/* The scene's bodies from place `first` on, and far ones in the other places. */
static void add_far(const impact_scene_def *def, int first, impact_body_def bodies[MOST_BODIES], char names[FAR][8])
{
    random_stream random = {17};
    for (int i = 0; i < FAR; i++) {
        impact_body_def far = impact_default_body_def();
        snprintf(names[i], sizeof names[i], "far%d", i);
        far.name = names[i];
        impact_shape_sphere(0.1 + random_unit(&random), &far.shape);
        far.position = (qvec3){1000 + 5.0 * i, 2000 + 30 * random_unit(&random), 3 + 5 * random_unit(&random)};
        far.velocity = random_vector(&random, 0.1, 10);
        far.omega = random_vector(&random, 0.1, 10);
        far.restitution = 0.9;
        far.friction = 0.2;
        bodies[i < first ? i : i + def->body_count] = far;
    }
    for (int i = 0; i < def->body_count; i++) bodies[first + i] = def->bodies[i];
}

static void far_bodies_change_nothing(const impact_scene_def *def, int first)
{
    impact_body_def bodies[MOST_BODIES];
    char names[FAR][8];
    add_far(def, first, bodies, names);
    impact_scene_def more = *def;
    more.bodies = bodies;
    more.body_count = def->body_count + FAR;
    more.max_events = 100000;
    impact_scene *alone = make_scene(def), *among = make_scene(&more);
    const impact_status ended = run(alone);
    if (ended != IMPACT_EVENT_LIMIT) {
        run(among);
        for (int i = 0; i < def->body_count; i++)
            if (!same_body(alone, i, among, first + i))
                fail_msg("'%s' is elsewhere among far ones", def->bodies[i].name);
    }
    impact_scene_destroy(alone);
    impact_scene_destroy(among);
}

static void twenty_far_bodies_change_no_bit(void **state)
{
    (void)state;
    if (!impact_has(IMPACT_PART_CVODE)) skip();
    for (unsigned long seed = 1; seed <= SCENES; seed++) {
        random_scene s;
        make_short(seed, &s);
        if (!is_tied(&s.def)) far_bodies_change_nothing(&s.def, seed % 2 ? 0 : 7);
    }
}

/* ---- numbers ---- */

/* Whether bodies that move never touch each other: within one island the order of sums is that of the numbers. */
static bool islands_are_single(const scene_log *log, const impact_scene_def *def)
{
    for (int k = 0; k < log->event_count; k++) {
        const impact_event *e = &log->events[k];
        if (e->body2 >= 0 && !def->bodies[e->body1].is_static && !def->bodies[e->body2].is_static) return false;
    }
    return true;
}

static void other_numbers_are_the_same_motion(void **state)
{
    (void)state;
    if (!impact_has(IMPACT_PART_CVODE)) skip();
    int compared = 0;
    for (unsigned long seed = 1; seed <= 2 * SCENES; seed++) {
        random_scene s;
        make_short(seed, &s);
        const int n = s.def.body_count;
        scene_log log = {0};
        const impact_recorder rows = log_recorder(&log);
        impact_scene *a = make_scene(&s.def);
        const impact_status ended = impact_scene_run(a, &rows);
        impact_body_def turned[1 + RANDOM_SCENE_BODIES];
        for (int i = 0; i < n; i++) turned[n - 1 - i] = s.bodies[i];
        if (!is_tied(&s.def) && ended != IMPACT_EVENT_LIMIT && islands_are_single(&log, &s.def)) {
            impact_scene_def def = s.def;
            def.bodies = turned;
            impact_scene *b = make_scene(&def);
            assert_int_equal(run(b), ended);
            for (int i = 0; i < n; i++)
                if (!same_body(a, i, b, n - 1 - i)) fail_msg("seed %lu: body %d differs", seed, i);
            impact_scene_destroy(b);
            compared++;
        }
        free_log(&log);
        impact_scene_destroy(a);
    }
    assert_true(compared > SCENES);
}

/* Impacts of a crowd among each other, no two at one time. */
static void a_crowd_in_any_order_is_the_same_crowd(void **state)
{
    (void)state;
    enum { BALLS = 12 };
    impact_body_def bodies[2][BALLS];
    char names[BALLS][8];
    random_stream random = {4};
    for (int i = 0; i < BALLS; i++) {
        snprintf(names[i], sizeof names[i], "b%d", i);
        bodies[0][i] = ball_body(names[i], (qvec3){i % 3, (i / 3) % 2, i / 6}, 0.3, 0.9);
        bodies[0][i].position = qvec3_add(bodies[0][i].position, random_vector(&random, 0.01, 0.1));
        bodies[0][i].velocity = qvec3_sub((qvec3){1, 0.5, 0.5}, bodies[0][i].position); /* to the middle */
        bodies[1][(5 * i + 3) % BALLS] = bodies[0][i];
    }
    impact_scene *scenes[2];
    long impacts = 0;
    for (int k = 0; k < 2; k++) {
        impact_scene_def def = impact_default_scene_def();
        def.bodies = bodies[k];
        def.body_count = BALLS;
        def.duration = 1;
        scenes[k] = make_scene(&def);
        run(scenes[k]);
        impacts = impact_scene_usage(scenes[k]).events[IMPACT_EVENT_IMPACT];
    }
    assert_true(impacts >= 10);
    for (int i = 0; i < BALLS; i++) assert_true(same_body(scenes[0], i, scenes[1], (5 * i + 3) % BALLS));
    for (int k = 0; k < 2; k++) impact_scene_destroy(scenes[k]);
}

/* ---- units ---- */

static qvec3 times(qvec3 v, double factor) { return qvec3_scale(v, factor); }

/* The definition in units of length and mass that are powers of two of the old ones. */
static void change_units(impact_scene_def *def, impact_body_def *bodies, double length, double mass)
{
    for (int i = 0; i < def->body_count; i++) {
        impact_body_def *b = &bodies[i];
        b->shape.a *= length, b->shape.b *= length, b->shape.c *= length;
        b->shape.rounding *= length, b->shape.base *= length;
        b->position = times(b->position, length);
        b->velocity = times(b->velocity, length);
        b->density *= mass / (length * length * length);
        b->mass *= mass;
    }
    def->gravity = times(def->gravity, length);
    def->rest_height *= length;
    def->rest_speed *= length;
}

/* Balls, which have closed forms: what an integrator moves has steps whose errors are weighed with numbers that are not
 * the units'. */
static void other_units_are_the_same_motion(void **state)
{
    (void)state;
    enum { BALLS = 5 };
    static const double lengths[] = {8, 0x1p-20, 0x1p30}, masses[] = {4, 0x1p40, 0x1p-30};
    for (int k = 0; k < 3; k++) {
        impact_body_def bodies[2][1 + BALLS];
        char names[BALLS][8];
        random_stream random = {3};
        bodies[0][0] = plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 0.5, 1);
        for (int i = 0; i < BALLS; i++) {
            snprintf(names[i], sizeof names[i], "b%d", i);
            bodies[0][1 + i] = ball_body(names[i], (qvec3){0.7 * i, 0, 1 + random_unit(&random)}, 0.3, 0.9);
            bodies[0][1 + i].velocity = random_vector(&random, 0.1, 2);
            bodies[0][1 + i].omega = random_vector(&random, 0.1, 20);
        }
        memcpy(bodies[1], bodies[0], sizeof bodies[0]);
        impact_scene *scenes[2];
        for (int u = 0; u < 2; u++) {
            impact_scene_def def = impact_default_scene_def();
            def.gravity = (qvec3){0, 0, -9.81};
            def.bodies = bodies[u];
            def.body_count = 1 + BALLS;
            def.duration = 2;
            if (u == 1) change_units(&def, bodies[1], lengths[k], masses[k]);
            scenes[u] = make_scene(&def);
            run(scenes[u]);
        }
        assert_true(impact_scene_usage(scenes[0]).events[IMPACT_EVENT_IMPACT] > 10);
        for (int i = 1; i <= BALLS; i++) {
            impact_sample a, b;
            impact_scene_body(scenes[0], i, &a);
            impact_scene_body(scenes[1], i, &b);
            const qvec3 x = times(a.position, lengths[k]), v = times(a.velocity, lengths[k]);
            assert_memory_equal(&x, &b.position, sizeof x);
            assert_memory_equal(&v, &b.velocity, sizeof v);
            assert_memory_equal(&a.omega, &b.omega, sizeof a.omega);
            assert_memory_equal(&a.orientation, &b.orientation, sizeof a.orientation);
        }
        for (int u = 0; u < 2; u++) impact_scene_destroy(scenes[u]);
    }
}

/* ---- every setting ---- */

typedef enum field_kind { NUMBER, VECTOR, QUATERNION, CHOICE, FLAG, COUNT, LIMIT, POINTER, SHAPE, OTHER } field_kind;

/* decides: whether it decides the motion; only what does is part of a definition's print. */
typedef struct field {
    const char *name;
    size_t offset, size;
    field_kind kind;
    bool decides;
} field;

#define FIELD(type, name, kind, decides)                                                                               \
    {                                                                                                                  \
#name, offsetof(type, name), sizeof(((type *)0)->name), kind, decides                                          \
    }

static const field scene_fields[] = {
    FIELD(impact_scene_def, struct_size, OTHER, false),      FIELD(impact_scene_def, name, POINTER, true),
    FIELD(impact_scene_def, gravity, VECTOR, true),          FIELD(impact_scene_def, duration, NUMBER, true),
    FIELD(impact_scene_def, output_rate, NUMBER, true),      FIELD(impact_scene_def, bodies, OTHER, true),
    FIELD(impact_scene_def, body_count, COUNT, true),        FIELD(impact_scene_def, forces, OTHER, true),
    FIELD(impact_scene_def, force_count, COUNT, true),       FIELD(impact_scene_def, pairs, OTHER, true),
    FIELD(impact_scene_def, pair_count, COUNT, true),        FIELD(impact_scene_def, friction_rule, CHOICE, true),
    FIELD(impact_scene_def, restitution_rule, CHOICE, true), FIELD(impact_scene_def, law, CHOICE, true),
    FIELD(impact_scene_def, solver, CHOICE, true),           FIELD(impact_scene_def, compliance, NUMBER, true),
    FIELD(impact_scene_def, tolerance, NUMBER, true),        FIELD(impact_scene_def, rest_height, NUMBER, true),
    FIELD(impact_scene_def, rest_speed, NUMBER, true),       FIELD(impact_scene_def, max_events, LIMIT, false),
    FIELD(impact_scene_def, max_steps, LIMIT, false),        FIELD(impact_scene_def, allocator, OTHER, false),
    FIELD(impact_scene_def, key_tolerance, NUMBER, false),   FIELD(impact_scene_def, piles, CHOICE, true),
    FIELD(impact_scene_def, together, CHOICE, true),         FIELD(impact_scene_def, samples, CHOICE, true),
    FIELD(impact_scene_def, methods, OTHER, true),           FIELD(impact_scene_def, pile_tolerance, NUMBER, true),
};

static const field methods_fields[] = {
    FIELD(impact_methods, motion, CHOICE, true),
    FIELD(impact_methods, impacts, CHOICE, true),
    FIELD(impact_methods, gaps, CHOICE, true),
    FIELD(impact_methods, tolerance, NUMBER, true),
    FIELD(impact_methods, impact_tolerance, NUMBER, true),
    FIELD(impact_methods, gap_tolerance, NUMBER, true),
    FIELD(impact_methods, step, NUMBER, true),
};

static const field body_fields[] = {
    FIELD(impact_body_def, struct_size, OTHER, false),
    FIELD(impact_body_def, name, POINTER, true),
    FIELD(impact_body_def, shape, SHAPE, true),
    FIELD(impact_body_def, is_static, FLAG, true),
    FIELD(impact_body_def, mass, NUMBER, true),
    FIELD(impact_body_def, density, NUMBER, true),
    FIELD(impact_body_def, moments, VECTOR, true),
    FIELD(impact_body_def, position, VECTOR, true),
    FIELD(impact_body_def, orientation, QUATERNION, true),
    FIELD(impact_body_def, shape_position, VECTOR, true),
    FIELD(impact_body_def, shape_orientation, QUATERNION, true),
    FIELD(impact_body_def, velocity, VECTOR, true),
    FIELD(impact_body_def, omega, VECTOR, true),
    FIELD(impact_body_def, friction, NUMBER, true),
    FIELD(impact_body_def, restitution, NUMBER, true),
    FIELD(impact_body_def, torsional_friction, NUMBER, true),
    FIELD(impact_body_def, rolling_friction, NUMBER, true),
    FIELD(impact_body_def, linear_damping, NUMBER, true),
    FIELD(impact_body_def, angular_damping, NUMBER, true),
    FIELD(impact_body_def, trail, VECTOR, false),
    FIELD(impact_body_def, user, OTHER, false),
};

static const field force_fields[] = {
    FIELD(impact_force_def, struct_size, OTHER, false),    FIELD(impact_force_def, kind, CHOICE, true),
    FIELD(impact_force_def, name, POINTER, true),          FIELD(impact_force_def, body, POINTER, true),
    FIELD(impact_force_def, origin, VECTOR, true),         FIELD(impact_force_def, direction, VECTOR, true),
    FIELD(impact_force_def, strength, NUMBER, true),       FIELD(impact_force_def, reach, NUMBER, true),
    FIELD(impact_force_def, radius, NUMBER, true),         FIELD(impact_force_def, falloff_power, NUMBER, true),
    FIELD(impact_force_def, falloff_length, NUMBER, true), FIELD(impact_force_def, drag, NUMBER, true),
    FIELD(impact_force_def, constant, NUMBER, true),       FIELD(impact_force_def, power, NUMBER, true),
    FIELD(impact_force_def, function, OTHER, false),       FIELD(impact_force_def, context, OTHER, false),
    FIELD(impact_force_def, max_step, NUMBER, true),       FIELD(impact_force_def, switches, OTHER, true),
    FIELD(impact_force_def, switch_count, COUNT, true),    FIELD(impact_force_def, steady, FLAG, true),
    FIELD(impact_force_def, switch_period, NUMBER, true),  FIELD(impact_force_def, edge, OTHER, true),
};

static const field pair_fields[] = {
    FIELD(impact_pair_def, struct_size, OTHER, false),
    FIELD(impact_pair_def, body1, POINTER, true),
    FIELD(impact_pair_def, body2, POINTER, true),
    FIELD(impact_pair_def, friction, NUMBER, true),
    FIELD(impact_pair_def, restitution, NUMBER, true),
    FIELD(impact_pair_def, stiffness, NUMBER, true),
    FIELD(impact_pair_def, torsional_friction, NUMBER, true),
    FIELD(impact_pair_def, rolling_friction, NUMBER, true),
};

/* Between two fields lies no more than what aligns them: a field that is not listed would stand there. */
static void assert_all_listed(const field *fields, size_t count, size_t size)
{
    size_t end = 0;
    for (size_t k = 0; k <= count; k++) {
        const size_t begin = k < count ? fields[k].offset : size;
        if (begin < end || begin - end >= 8)
            fail_msg("before '%s' a field is not listed", k < count ? fields[k].name : "the end");
        if (k < count) end = begin + fields[k].size;
    }
}

/* Another value in the field's place; false: none to be made here. */
static bool vary(void *thing, const field *f)
{
    void *place = (char *)thing + f->offset;
    double *number = place;
    static const char other[] = "another";
    const char *text = other;
    switch (f->kind) {
    case NUMBER:
    case VECTOR:
    case QUATERNION:
    case SHAPE:
        if (f->kind == SHAPE) number = &((impact_shape *)place)->a;
        *number = isfinite(*number) && *number != 0 ? 1.5 * *number : 0.25;
        return true;
    case CHOICE: *(int *)place = *(int *)place > 0 ? *(int *)place - 1 : 1; return true;
    case LIMIT: ++*(long *)place; return true;
    case FLAG: *(bool *)place = !*(bool *)place; return true;
    case POINTER: memcpy(place, &text, sizeof text); return true;
    default: return false;
    }
}

typedef struct whole_definition {
    impact_scene_def scene;
    impact_body_def bodies[2];
    impact_force_def forces[2];
    impact_pair_def pairs[1];
} whole_definition;

static void make_definition(whole_definition *d)
{
    d->scene = impact_default_scene_def();
    d->scene.name = "all";
    for (int i = 0; i < 2; i++) d->bodies[i] = ball_body(i ? "one" : "two", (qvec3){2.0 * i, 0, 1}, 0.3, 0.5);
    d->forces[0] = impact_default_force_def(IMPACT_FORCE_WIND);
    d->forces[1] = impact_default_force_def(IMPACT_FORCE_CUSTOM);
    d->pairs[0] = (impact_pair_def){sizeof(impact_pair_def), "one", "two", 0.1, 0.2, 3, 0.01, 0.02};
    d->scene.bodies = d->bodies, d->scene.body_count = 2;
    d->scene.forces = d->forces, d->scene.force_count = 2;
    d->scene.pairs = d->pairs, d->scene.pair_count = 1;
}

static int check_prints(const field *fields, size_t count, size_t offset)
{
    int varied = 0;
    for (size_t k = 0; k < count; k++) {
        whole_definition d;
        make_definition(&d);
        const uint64_t before = imp_scene_print(&d.scene);
        if (!vary((char *)&d + offset, &fields[k])) continue;
        if ((imp_scene_print(&d.scene) != before) != fields[k].decides) fail_msg("'%s' and the print", fields[k].name);
        varied++;
    }
    return varied;
}

#define ALL(list) list, sizeof list / sizeof *list

static void every_field_that_decides_is_in_the_print(void **state)
{
    (void)state;
    assert_all_listed(ALL(scene_fields), sizeof(impact_scene_def));
    assert_all_listed(ALL(methods_fields), sizeof(impact_methods));
    assert_all_listed(ALL(body_fields), sizeof(impact_body_def));
    assert_all_listed(ALL(force_fields), sizeof(impact_force_def));
    assert_all_listed(ALL(pair_fields), sizeof(impact_pair_def));
    assert_int_equal(check_prints(ALL(scene_fields), offsetof(whole_definition, scene)), 19);
    assert_int_equal(check_prints(ALL(methods_fields), offsetof(whole_definition, scene.methods)), 7);
    assert_int_equal(check_prints(ALL(body_fields), offsetof(whole_definition, bodies)), 19);
    assert_int_equal(check_prints(ALL(force_fields), offsetof(whole_definition, forces)), 16);
    assert_int_equal(check_prints(ALL(pair_fields), offsetof(whole_definition, pairs)), 7);
}

/* Each setting of the scene another one, and the same bits among far bodies, in parts and saved. */
static void the_same_bits_with_every_setting(void **state)
{
    (void)state;
    if (!impact_has(IMPACT_PART_CVODE)) skip();
    for (size_t k = 0; k < sizeof scene_fields / sizeof *scene_fields; k++) {
        random_scene s;
        make_short(7, &s);
        s.def.law = IMPACT_STRONGE;
        const int kind = (int)scene_fields[k].kind;
        if (kind == POINTER || kind == OTHER) continue;
        if (strcmp(scene_fields[k].name, "together") == 0) /* another: by Moreau */
            s.def.law = IMPACT_POISSON, s.def.together = IMPACT_SCENE_SEQUENCE;
        if (strcmp(scene_fields[k].name, "law") == 0)
            s.def.law = IMPACT_NEWTON;
        else if (strcmp(scene_fields[k].name, "duration") != 0 && !vary(&s.def, &scene_fields[k]))
            continue;
        far_bodies_change_nothing(&s.def, 3);
        impact_scene *a = make_scene(&s.def), *b = make_scene(&s.def), *whole = make_scene(&s.def);
        run(whole);
        impact_scene_run_to(b, 0.3 * s.def.duration, NULL);
        run(b);
        assert_true(same_scene(whole, b));
        impact_scene_run_to(a, 0.6 * s.def.duration, NULL);
        unsigned char bytes[20000];
        size_t size = sizeof bytes;
        assert_int_equal(impact_scene_save(a, bytes, &size), IMPACT_OK);
        assert_int_equal(impact_scene_load(b, bytes, size), IMPACT_OK);
        run(a), run(b);
        assert_true(same_scene(a, b));
        impact_scene_destroy(a);
        impact_scene_destroy(b);
        impact_scene_destroy(whole);
    }
}

static void the_user_pointer_comes_back(void **state)
{
    (void)state;
    int mine = 0;
    impact_body_def body = ball_body("ball", (qvec3){0, 0, 1}, 0, 1), back = impact_default_body_def();
    body.user = &mine;
    impact_scene_def def = impact_default_scene_def();
    def.bodies = &body;
    def.body_count = 1;
    def.duration = 1;
    impact_scene *scene = make_scene(&def);
    run(scene);
    assert_int_equal(impact_scene_body_def(scene, 0, &back), IMPACT_OK);
    assert_ptr_equal(back.user, &mine);
    impact_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(in_parts_is_the_whole),
        cmocka_unit_test(twenty_far_bodies_change_no_bit),
        cmocka_unit_test(other_numbers_are_the_same_motion),
        cmocka_unit_test(a_crowd_in_any_order_is_the_same_crowd),
        cmocka_unit_test(other_units_are_the_same_motion),
        cmocka_unit_test(every_field_that_decides_is_in_the_print),
        cmocka_unit_test(the_same_bits_with_every_setting),
        cmocka_unit_test(the_user_pointer_comes_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
