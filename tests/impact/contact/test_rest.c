/* SPDX-License-Identifier: MIT
 *
 * Stacks, slopes and overhangs of boxes that touch at points given by hand, against what is known of them; loads made
 * from reactions; and the proofs that are handed out, checked by what they say.
 */
#include "contact/rest.h"
#include "kit/contact_random.h"
#include "kit/near.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_BODIES = 40, MOST_CONTACTS = 160 };

static imp_rest_workspace room;

/* A scene of boxes of half side 1/2 on a ground, body 0. */
typedef struct pile {
    imp_world world;
    imp_body bodies[MOST_BODIES];
    imp_state states[MOST_BODIES];
    imp_load loads[MOST_BODIES];
    imp_cone_contact contacts[MOST_CONTACTS];
    double friction[MOST_CONTACTS], reactions[3 * MOST_CONTACTS];
    imp_rest_velocity velocities[MOST_BODIES];
    int count;
    imp_rest_outcome outcome;
} pile;

static pile *new_pile(void)
{
    pile *p = calloc(1, sizeof *p);
    p->bodies[0] = (imp_body){.is_static = true};
    p->states[0].q = (quat){1, 0, 0, 0};
    p->world = (imp_world){.body_count = 1, .bodies = p->bodies};
    return p;
}

static int add_box(pile *p, double mass, qvec3 position, qvec3 gravity)
{
    const int i = p->world.body_count++;
    const double j = mass / 6;
    p->bodies[i] = (imp_body){.mass = mass,
                              .inverse_mass = 1 / mass,
                              .moments = {j, j, j},
                              .spherical = true,
                              .inverse_moments = {1 / j, 1 / j, 1 / j}};
    p->states[i] = (imp_state){.x = position, .q = {1, 0, 0, 0}};
    p->loads[i].force = qvec3_scale(gravity, mass);
    return i;
}

static void contact(pile *p, int upper, int lower, qvec3 at, qvec3 normal, double friction)
{
    imp_cone_contact *c = &p->contacts[p->count];
    *c = (imp_cone_contact){.body1 = upper, .body2 = lower};
    imp_cone_find_axes(normal, c->axes);
    c->arm1 = qvec3_sub(at, p->states[upper].x);
    c->arm2 = qvec3_sub(at, p->states[lower].x);
    p->friction[p->count++] = friction;
}

/* The box lies on another at height z, over x from low to high. */
static void lie(pile *p, int upper, int lower, double z, double low, double high, double friction)
{
    for (int k = 0; k < 4; k++)
        contact(p, upper, lower, (qvec3){k % 2 ? high : low, k / 2 ? 0.5 : -0.5, z}, (qvec3){0, 0, 1}, friction);
}

static imp_rest_status solve(pile *p)
{
    assert_true(imp_rest_reserve(&room, p->count, p->world.body_count));
    p->outcome = imp_rest_solve(&p->world, p->states, p->contacts, p->friction, NULL, p->count, p->loads, &room,
                                p->reactions, p->velocities);
    return p->outcome.status;
}

/* By forces and torques of the world: inside the cones, and in balance with the loads. */
static void assert_balance(const pile *p)
{
    imp_load left[MOST_BODIES];
    double most = 0;
    memcpy(left, p->loads, sizeof left);
    for (int c = 0; c < p->count; c++) {
        const double *r = &p->reactions[3 * c];
        assert_at_most(hypot(r[1], r[2]) - p->friction[c] * r[0], 1e-14 * fabs(r[0]));
        qvec3 f = {0, 0, 0};
        for (int k = 0; k < 3; k++) f = qvec3_axpy(r[k], p->contacts[c].axes[k], f);
        imp_load *one = &left[p->contacts[c].body1], *two = &left[p->contacts[c].body2];
        one->force = qvec3_add(one->force, f);
        one->torque = qvec3_add(one->torque, qvec3_cross(p->contacts[c].arm1, f));
        two->force = qvec3_sub(two->force, f);
        two->torque = qvec3_sub(two->torque, qvec3_cross(p->contacts[c].arm2, f));
        most = fmax(most, qvec3_norm(f));
    }
    for (int i = 1; i < p->world.body_count; i++) {
        assert_near3(left[i].force, (qvec3){0, 0, 0}, 1e-12 * most);
        assert_near3(left[i].torque, (qvec3){0, 0, 0}, 1e-12 * most);
    }
}

/* The motion that shows it opens every contact, friction notwithstanding, and the loads drive it. */
static void assert_goes(const pile *p)
{
    double power = 0;
    for (int i = 1; i < p->world.body_count; i++)
        power += qvec3_dot(p->loads[i].force, p->velocities[i].linear) +
                 qvec3_dot(p->loads[i].torque, p->velocities[i].angular);
    assert_true(power > 0);
    for (int c = 0; c < p->count; c++) {
        const imp_cone_contact *own = &p->contacts[c];
        const imp_rest_velocity *one = &p->velocities[own->body1], *two = &p->velocities[own->body2];
        const qvec3 v = qvec3_sub(qvec3_add(one->linear, qvec3_cross(one->angular, own->arm1)),
                                  qvec3_add(two->linear, qvec3_cross(two->angular, own->arm2)));
        const double n = qvec3_dot(v, own->axes[0]);
        assert_at_most(p->friction[c] * hypot(qvec3_dot(v, own->axes[1]), qvec3_dot(v, own->axes[2])) - n,
                       1e-6 * power);
    }
}

static const qvec3 down = {0, 0, -9.81};

/* ---- stacks ---- */

static void stacks_rest(void **state)
{
    (void)state;
    const int heights[] = {1, 2, 5, 10, 30};
    for (int k = 0; k < 10; k++) {
        pile *p = new_pile();
        double x = 0;
        for (int i = 1; i <= heights[k / 2]; i++) {
            const double mass = k % 2 && i % 2 ? 1e4 : 1, before = x;
            x = 0.1 * ((i * 7) % 5 - 2) / 2;
            add_box(p, mass, (qvec3){x, 0, i - 0.5}, down);
            lie(p, i, i - 1, i - 1, i == 1 ? x - 0.5 : fmax(x, before) - 0.5, i == 1 ? x + 0.5 : fmin(x, before) + 0.5,
                0.5);
        }
        assert_int_equal(solve(p), IMP_REST_RESTS);
        assert_balance(p);
        free(p);
    }
}

/* One box on edges: the centre is inside them, or beyond by one part in a million. */
static void overhangs_fall_past_the_edge(void **state)
{
    (void)state;
    const double over[] = {-1e-3, -1e-6, -1e-9, 1e-6, 1e-3, 0.2};
    for (int k = 0; k < 6; k++) {
        pile *p = new_pile();
        add_box(p, 2, (qvec3){0.5 * (1 + over[k]), 0, 0.5}, down);
        lie(p, 1, 0, 0, 0, 0.5, 0.6);
        if (over[k] < 0) {
            assert_int_equal(solve(p), IMP_REST_RESTS);
            assert_balance(p);
        } else {
            assert_int_equal(solve(p), IMP_REST_MOVES);
            assert_goes(p);
            assert_true(p->velocities[1].angular.y > 0); /* over the far edge */
        }
        free(p);
    }
}

/* ---- slopes ---- */

static void slopes_hold_up_to_their_friction(void **state)
{
    (void)state;
    const double off[] = {-1e-1, -1e-3, -1e-6, -1e-9, 1e-6, 1e-3, 1e-1};
    for (int k = 0; k < 7; k++) {
        pile *p = new_pile();
        const double friction = 0.4, angle = atan(friction * (1 + off[k]));
        const qvec3 g = {9.81 * sin(angle), 0, -9.81 * cos(angle)};
        for (int i = 1; i <= 2; i++) {
            add_box(p, i, (qvec3){0, 0, i - 0.5}, g);
            lie(p, i, i - 1, i - 1, -0.5, 0.5, i == 1 ? friction : 1);
        }
        if (off[k] < 0) {
            assert_int_equal(solve(p), IMP_REST_RESTS);
            assert_balance(p);
        } else {
            assert_int_equal(solve(p), IMP_REST_MOVES);
            assert_goes(p);
            assert_true(p->velocities[1].linear.x > 0 && p->velocities[2].linear.x > 0);
        }
        free(p);
    }
}

/* ---- made loads ---- */

static void loads_made_from_reactions_are_balanced(void **state)
{
    (void)state;
    random_stream random = {5};
    for (int k = 0; k < 300; k++) {
        pile *p = new_pile();
        const int bodies = 1 + k % 8, contacts = 1 + (int)(random_unit(&random) * 3.99 * bodies);
        for (int i = 1; i <= bodies; i++)
            add_box(p, random_log(&random, 0.1, 10), random_vector(&random, 0.5, 2), (qvec3){0, 0, 0});
        for (int c = 0; c < contacts; c++) {
            const int one = 1 + c % bodies, two = (int)(random_unit(&random) * one);
            const double friction = c % 5 ? random_log(&random, 0.05, 2) : 0;
            contact(p, one, two, random_vector(&random, 0.5, 2), random_direction(&random), friction);
            const double push = random_unit(&random), angle = 6.28 * random_unit(&random),
                         rub = friction * push * random_unit(&random);
            const double r[3] = {push, rub * cos(angle), rub * sin(angle)};
            for (int l = 0; l < 3; l++) {
                const qvec3 f = qvec3_scale(p->contacts[c].axes[l], r[l]);
                p->loads[one].force = qvec3_sub(p->loads[one].force, f);
                p->loads[one].torque = qvec3_sub(p->loads[one].torque, qvec3_cross(p->contacts[c].arm1, f));
                p->loads[two].force = qvec3_add(p->loads[two].force, f);
                p->loads[two].torque = qvec3_add(p->loads[two].torque, qvec3_cross(p->contacts[c].arm2, f));
            }
        }
        assert_int_equal(solve(p), IMP_REST_RESTS);
        assert_balance(p);
        free(p);
    }
}

/* A ball that falls freely, and one that no contact names. */
static void what_nothing_holds_goes(void **state)
{
    (void)state;
    pile *p = new_pile();
    add_box(p, 1, (qvec3){0, 0, 0.5}, (qvec3){0, 0, 9.81});
    add_box(p, 1, (qvec3){5, 0, 0.5}, down);
    lie(p, 1, 0, 0, -0.5, 0.5, 0.5);
    assert_int_equal(solve(p), IMP_REST_MOVES);
    assert_true(p->velocities[1].linear.z > 0);
    assert_near3(p->velocities[2].linear, (qvec3){0, 0, 0}, 0);
    free(p);
}

/* A ball on two rails, whose places across are e apart: it rolls down them, by nothing that reactions could hold, and
 * by less than shows that none do. That is soon found out. */
static void what_all_but_rests_is_left_soon(void **state)
{
    (void)state;
    for (double e = 1e-8; e > 1e-11; e /= 10) {
        pile *p = new_pile();
        const double x = 0.07, z = 0.0714;
        add_box(p, 1, (qvec3){0, 0, z}, down);
        for (int side = -1; side <= 1; side += 2)
            contact(p, 1, 0, (qvec3){side * x, side < 0 ? e : 0, 0},
                    qvec3_scale((qvec3){-side * x, 0, z}, 1 / hypot(x, z)), 0.5);
        assert_int_not_equal(solve(p), IMP_REST_RESTS);
        assert_true(p->outcome.steps <= 20);
        free(p);
    }
}

static int furnish(void **state)
{
    (void)state;
    return imp_arena_create(NULL, &room.arena);
}

static int clear(void **state)
{
    (void)state;
    imp_arena_destroy(room.arena);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stacks_rest),
        cmocka_unit_test(overhangs_fall_past_the_edge),
        cmocka_unit_test(slopes_hold_up_to_their_friction),
        cmocka_unit_test(loads_made_from_reactions_are_balanced),
        cmocka_unit_test(what_nothing_holds_goes),
        cmocka_unit_test(what_all_but_rests_is_left_soon),
    };
    return cmocka_run_group_tests(tests, furnish, clear);
}
