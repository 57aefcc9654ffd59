/* SPDX-License-Identifier: MIT
 *
 * Every number of a definition, and every choice in it, replaced by numbers at and beyond the ends: the scene is made,
 * and then runs to an end that it names, or it is refused in words, and with the thing's name where it has one.
 */
#include <stdio.h>
#include <impact/impact.h>
#include "kit/scene_log.h"

typedef struct fixture {
    impact_body_def bodies[3];
    impact_force_def forces[3];
    impact_pair_def pair;
    impact_scene_def def;
    double switches[2];
} fixture;

static bool push(double t, int body, double mass, qvec3 x, quat q, qvec3 v, qvec3 omega, qvec3 *force, qvec3 *torque,
                 void *context)
{
    (void)t, (void)body, (void)x, (void)q, (void)v, (void)omega, (void)context;
    *force = (qvec3){0.1 * mass, 0, 0}, *torque = (qvec3){0, 0, 0};
    return true;
}

static void make(fixture *f)
{
    *f = (fixture){.def = impact_default_scene_def(), .pair = impact_default_pair_def("floor", "egg")};
    f->bodies[0] = plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 0.5, 0.5);
    f->bodies[1] = ball_body("ball", (qvec3){0, 0, 0.4}, 0.5, 0.5);
    f->bodies[1].mass = 2, f->bodies[1].moments = (qvec3){0.1, 0.1, 0.1};
    f->bodies[2] = ball_body("egg", (qvec3){2, 0, 0.5}, 0.5, 0.5);
    f->bodies[2].mass = NAN, f->bodies[2].moments = (qvec3){NAN, NAN, NAN};
    impact_shape_superquadric(0.2, 0.3, 0.25, 2, 3, 2.5, &f->bodies[2].shape);
    f->forces[0] = impact_default_force_def(IMPACT_FORCE_WIND);
    f->forces[1] = impact_default_force_def(IMPACT_FORCE_ATTRACTION);
    f->forces[2] = impact_default_force_def(IMPACT_FORCE_CUSTOM);
    f->forces[0].strength = 0.1, f->forces[1].constant = 1e-3, f->forces[2].function = push;
    f->forces[0].name = "breeze", f->forces[1].name = "pull", f->forces[2].name = "push";
    f->switches[0] = 0.01, f->switches[1] = 0.02;
    f->forces[2].switches = f->switches, f->forces[2].switch_count = 2, f->forces[2].switch_period = 0.05;
    f->def.bodies = f->bodies, f->def.body_count = 3;
    f->def.forces = f->forces, f->def.force_count = 3;
    f->def.pairs = &f->pair, f->def.pair_count = 1;
    f->def.duration = 0.03, f->def.max_steps = 2000, f->def.max_events = 100;
}

typedef struct tally {
    long made, refused;
} tally;

static void ask(const fixture *f, const char *what, double value, tally *t)
{
    impact_scene *scene;
    char message[300] = "untouched";
    const impact_status status = impact_scene_create(&f->def, &scene, message, sizeof message);
    if (status < 0) {
        if (scene || message[0] == '\0' || strcmp(message, "untouched") == 0)
            fail_msg("%s = %g: status %d, '%s'", what, value, status, message);
        if (impact_scene_create(&f->def, &scene, NULL, 0) != status)
            fail_msg("%s = %g: other without words", what, value);
        t->refused++;
        return;
    }
    const impact_status ran = impact_scene_run(scene, NULL);
    if (ran < 0 && impact_scene_message(scene)[0] == '\0') fail_msg("%s = %g: ends with %d", what, value, ran);
    impact_scene_destroy(scene);
    t->made++;
}

static const double values[] = {NAN, INFINITY, -INFINITY, -1, 0, 1e-300, 0.5, 1, 1.5, 1e17, 1e300};
enum { VALUES = sizeof values / sizeof *values };

/* All doubles that stand in [from, from + size) of the fixture, one after the other. */
static void every_double(size_t from, size_t size, const char *what, tally *t)
{
    for (size_t at = from; at + sizeof(double) <= from + size; at += sizeof(double))
        for (int k = 0; k < VALUES; k++) {
            fixture f;
            make(&f);
            f.def.bodies = f.bodies, f.def.forces = f.forces, f.def.pairs = &f.pair;
            f.forces[2].switches = f.switches;
            memcpy((char *)&f + at, &values[k], sizeof(double));
            ask(&f, what, values[k], t);
        }
}

static void every_int(size_t at, const char *what, tally *t)
{
    static const int numbers[] = {-2147483647, -1, 0, 1, 2, 3, 4, 5, 99};
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) {
        fixture f;
        make(&f);
        f.def.bodies = f.bodies, f.def.forces = f.forces, f.def.pairs = &f.pair;
        f.forces[2].switches = f.switches;
        memcpy((char *)&f + at, &numbers[k], sizeof(int));
        ask(&f, what, numbers[k], t);
    }
}

#define DOUBLES(field) every_double(offsetof(fixture, field), sizeof((fixture *)0)->field, #field, &t)
#define CHOICE(field) every_int(offsetof(fixture, field), #field, &t)

static void bodies(void **state)
{
    (void)state;
    tally t = {0};
    DOUBLES(bodies[0].shape.a), DOUBLES(bodies[0].shape.b), DOUBLES(bodies[0].position), DOUBLES(bodies[0].velocity);
    DOUBLES(bodies[0].omega), DOUBLES(bodies[0].orientation), DOUBLES(bodies[0].shape_position);
    for (size_t i = 1; i < 3; i++) {
        DOUBLES(bodies[i].shape.a), DOUBLES(bodies[i].shape.r), DOUBLES(bodies[i].shape.t);
        DOUBLES(bodies[i].mass), DOUBLES(bodies[i].density), DOUBLES(bodies[i].moments), DOUBLES(bodies[i].position);
        DOUBLES(bodies[i].orientation), DOUBLES(bodies[i].shape_position), DOUBLES(bodies[i].shape_orientation);
        DOUBLES(bodies[i].velocity), DOUBLES(bodies[i].omega), DOUBLES(bodies[i].friction);
        DOUBLES(bodies[i].restitution), DOUBLES(bodies[i].torsional_friction), DOUBLES(bodies[i].rolling_friction);
        DOUBLES(bodies[i].linear_damping), DOUBLES(bodies[i].angular_damping), DOUBLES(bodies[i].trail);
    }
    assert_true(t.made > 200 && t.refused > 300);
}

static void forces(void **state)
{
    (void)state;
    tally t = {0};
    for (size_t i = 0; i < 3; i++) {
        DOUBLES(forces[i].origin), DOUBLES(forces[i].direction), DOUBLES(forces[i].strength), DOUBLES(forces[i].reach);
        DOUBLES(forces[i].radius), DOUBLES(forces[i].falloff_power), DOUBLES(forces[i].falloff_length);
        DOUBLES(forces[i].drag), DOUBLES(forces[i].constant), DOUBLES(forces[i].power), DOUBLES(forces[i].max_step);
        DOUBLES(forces[i].switch_period), CHOICE(forces[i].kind);
    }
    DOUBLES(switches), CHOICE(pair.struct_size);
    DOUBLES(pair.friction), DOUBLES(pair.restitution), DOUBLES(pair.stiffness);
    DOUBLES(pair.torsional_friction), DOUBLES(pair.rolling_friction);
    assert_true(t.made > 100 && t.refused > 100);
}

static void scenes(void **state)
{
    (void)state;
    tally t = {0};
    DOUBLES(def.gravity), DOUBLES(def.output_rate), DOUBLES(def.compliance), DOUBLES(def.tolerance);
    DOUBLES(def.rest_height), DOUBLES(def.rest_speed), DOUBLES(def.key_tolerance), DOUBLES(def.pile_tolerance),
        DOUBLES(def.methods.tolerance);
    DOUBLES(def.methods.impact_tolerance), DOUBLES(def.methods.gap_tolerance), DOUBLES(def.methods.step);
    CHOICE(def.friction_rule), CHOICE(def.restitution_rule), CHOICE(def.law), CHOICE(def.solver), CHOICE(def.piles);
    CHOICE(def.together), CHOICE(def.samples), CHOICE(def.methods.motion), CHOICE(def.methods.impacts);
    CHOICE(def.methods.gaps);
    assert_true(t.made > 60 && t.refused > 60);
}

/* Names: none, empty, unknown, twice. */
static void names(void **state)
{
    (void)state;
    static const char *const wrong[] = {NULL, "", "nobody", "floor"};
    tally t = {0};
    for (int k = 0; k < 4; k++) {
        fixture f[5];
        for (int i = 0; i < 5; i++) make(&f[i]), f[i].def.bodies = f[i].bodies;
        f[0].bodies[1].name = wrong[k], f[1].pair.body1 = wrong[k], f[2].pair.body2 = wrong[k];
        f[3].forces[0].body = wrong[k], f[4].forces[0].name = wrong[k];
        for (int i = 0; i < 5; i++) {
            f[i].def.forces = f[i].forces, f[i].def.pairs = &f[i].pair, f[i].forces[2].switches = f[i].switches;
            ask(&f[i], "name", k, &t);
        }
    }
    fixture f;
    make(&f);
    f.def.bodies = NULL;
    ask(&f, "bodies", 0, &t);
    make(&f);
    f.forces[2].function = NULL;
    ask(&f, "function", 0, &t);
    make(&f);
    f.forces[2].switches = NULL;
    ask(&f, "switches", 0, &t);
    assert_true(t.made > 2 && t.refused > 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bodies),
        cmocka_unit_test(forces),
        cmocka_unit_test(scenes),
        cmocka_unit_test(names),
    };
    return impact_has(IMPACT_PART_CVODE) ? cmocka_run_group_tests(tests, NULL, NULL) : 0;
}
