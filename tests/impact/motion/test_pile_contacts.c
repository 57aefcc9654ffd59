/* SPDX-License-Identifier: MIT
 *
 * What steps remember of each point: of a rim's points, which are all of the same features, its own, whatever opens or
 * closes beside it; and where the friction of a face's points acts.
 */
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>
#include "kit/contact_random.h"
#include "motion/pile_contacts.h"

enum { RIM = 16 };

static const double turn = 6.283185307179586 / RIM;

static qvec3 place_of(int k, double ahead) { return (qvec3){cos(k * turn + ahead), sin(k * turn + ahead), 0}; }

/* Some places of a rim were held and some touch now, the rim turned on by less than half of what parts them. */
static void rims_remember_their_own(void **state)
{
    (void)state;
    random_stream random = {11};
    imp_body bodies[2] = {{.radius = 1}, {.is_static = true}};
    imp_pair pair = {.body1 = 0, .body2 = 1};
    const imp_world world = {.bodies = bodies, .body_count = 2, .pairs = &pair, .pair_count = 1};
    const imp_state states[2] = {{.q = quat_identity()}, {.q = quat_identity()}};
    for (int run = 0; run < 2000; run++) {
        imp_pile_point points[RIM];
        imp_pile_memory list[RIM];
        imp_pile_memories memories = {.list = list, .room = RIM};
        imp_pile_contacts contacts = {.points = points, .room = RIM};
        int held[RIM], touches[RIM];
        const double ahead = 0.45 * turn * (2 * random_unit(&random) - 1);
        const impact_feature rim = {IMPACT_RIM, 1}, face = {IMPACT_FACE, 4};
        for (int k = 0; k < RIM; k++) {
            if (random_unit(&random) < 0.5) {
                held[memories.count] = k;
                list[memories.count++] = (imp_pile_memory){.feature = {rim, face}, .arm1 = place_of(k, 0)};
            }
            if (random_unit(&random) < 0.5) {
                touches[contacts.count] = k;
                points[contacts.count++] =
                    (imp_pile_point){.feature = {rim, face}, .contact.arm1 = place_of(k, ahead), .memory = -1};
            }
        }
        imp_pile_recall(&contacts, &world, states, 0, &memories);
        for (int i = 0; i < contacts.count; i++) {
            const int found = points[i].memory;
            bool there = false;
            for (int m = 0; m < memories.count; m++) there = there || held[m] == touches[i];
            if (there) assert_true(found >= 0 && held[found] == touches[i]);
        }
    }
}

/* Where friction acts of so many places in a plane, that press evenly. */
static void place(const double (*at)[2], int count, imp_pile_point *points)
{
    imp_body bodies[2] = {{.radius = 1}, {.is_static = true}};
    imp_pair pair = {.body1 = 0, .body2 = 1, .law = {.friction = 0.5}};
    const imp_world world = {.bodies = bodies, .body_count = 2, .pairs = &pair, .pair_count = 1};
    const imp_pile_memories none = {.count = 0};
    imp_pile_contacts contacts = {.points = points, .count = count, .room = count};
    for (int k = 0; k < count; k++) {
        points[k] =
            (imp_pile_point){.contact = {.body1 = 0, .body2 = 1, .arm1 = {at[k][0], at[k][1], -1}}, .memory = -1};
        imp_cone_find_axes((qvec3){0, 0, 1}, points[k].contact.axes);
    }
    imp_pile_place_friction(&contacts, &world, &none, NULL, 0);
}

/* Squares turned, triangles and lines against their mean distances; and whatever else a patch may be, places that
 * coincide or lie in a line but for roundings among it, is told a part of the way. */
static void friction_acts_nearer_to_the_centre(void **state)
{
    (void)state;
    imp_pile_point points[16];
    random_stream random = {23};
    const double square = 1 - (sqrt(2) + asinh(1)) / (3 * sqrt(2));
    for (int run = 0; run < 100; run++) {
        const double c = cos(run), s = sin(run), at[4][2] = {{c, s}, {-c, -s}, {-s, c}, {s, -c}};
        place(at, 4, points);
        for (int k = 0; k < 4; k++) assert_true(fabs(points[k].nearer - square) <= 1e-14);
        assert_true(qvec3_norm(qvec3_axpy(square, (qvec3){c, s, 0}, points[0].contact.rub)) <= 1e-14);
        place(at, 2, points);
        assert_true(points[0].nearer == 0.5 && qvec3_norm(points[0].contact.rub) <= 0.5 + 1e-15);
    }
    for (int run = 0; run < 200000; run++) {
        const int count = 2 + (int)(random_bits(&random) % 15);
        const double thin = random_bits(&random) % 3 == 0 ? 0 : exp(-40 * random_unit(&random));
        double at[16][2], reach = 0;
        for (int k = 0; k < count; k++) {
            const bool again = k > 0 && random_bits(&random) % 8 == 0;
            at[k][0] = again ? at[k - 1][0] : 2 * random_unit(&random) - 1;
            at[k][1] = again ? at[k - 1][1] : thin * (2 * random_unit(&random) - 1);
            reach = fmax(reach, hypot(at[k][0], at[k][1]));
        }
        place((const double(*)[2])at, count, points);
        for (int k = 0; k < count; k++) {
            assert_true(points[k].nearer >= 0 && points[k].nearer <= 1);
            assert_true(qvec3_norm(points[k].contact.rub) <= 2 * reach);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rims_remember_their_own),
        cmocka_unit_test(friction_acts_nearer_to_the_centre),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
