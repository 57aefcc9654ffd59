/* SPDX-License-Identifier: MIT
 *
 * What steps remember of each point: of a rim's points, which are all of the same features, its own, whatever opens or
 * closes beside it.
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
                points[contacts.count++] = (imp_pile_point){
                    .feature = {rim, face}, .contact.arm1 = place_of(k, ahead), .memory = {-1, -1, -1}};
            }
        }
        imp_pile_recall(&contacts, &world, states, 0, &memories, IMP_PILE_BEFORE);
        for (int i = 0; i < contacts.count; i++) {
            const int found = points[i].memory[IMP_PILE_BEFORE];
            bool there = false;
            for (int m = 0; m < memories.count; m++) there = there || held[m] == touches[i];
            if (there) assert_true(found >= 0 && held[found] == touches[i]);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rims_remember_their_own),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
