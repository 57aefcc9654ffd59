/* SPDX-License-Identifier: MIT
 *
 * Each word of a saved scene replaced by what is at and beyond the ends, its sum put right: the load is refused in
 * words and nothing has changed, or the scene goes on as any does, to an end that it names.
 */
#include <stdint.h>
#include <stdio.h>
#include <impact/impact.h>
#include "kit/scene_log.h"

enum { WORD = 8, MOST_BYTES = 1 << 16, EVERY = 7 };

/* Of each kind one: it rolls, lies and rocks, flies in a wind; stands on a corner and is pushed over on a static box,
 * or (planes with edges carry none such) falls beside a plane. */
static impact_scene *make(bool corners)
{
    static const char *const names[] = {"floor", "shelf", "rolls", "egg", "flies", "block", "beside"};
    enum { COUNT = sizeof names / sizeof *names };
    impact_body_def bodies[COUNT];
    bodies[0] = plane_body(names[0], (qvec3){0, 0, 0}, quat_identity(), 0.5, 0.5);
    bodies[1] = plane_body(names[1], (qvec3){20, 0, 1}, quat_identity(), 0.5, 0.5);
    if (corners)
        impact_shape_box(1, 1, 0.2, 0, &bodies[1].shape);
    else
        impact_shape_plane(1, 1, &bodies[1].shape);
    for (int i = 2; i < COUNT; i++) bodies[i] = ball_body(names[i], (qvec3){2.0 * i, 0, 0.3}, 0.4, 0.3);
    bodies[2].velocity.x = 1;
    impact_shape_ellipsoid(0.4, 0.35, 0.3, &bodies[3].shape);
    bodies[3].omega.y = 1;
    bodies[4].position.z = 2, bodies[4].linear_damping = 0.1;
    if (corners) impact_shape_superquadric(0.1, 0.1, 0.2, 1, 1, 1, &bodies[5].shape);
    bodies[5].position = corners ? (qvec3){20, 0.5, 1.45} : (qvec3){10, 0, 0.3};
    bodies[5].omega.x = 0.5;
    bodies[6].position = (qvec3){21.4, 0, 0.8};
    impact_scene_def def = impact_default_scene_def();
    impact_force_def wind = impact_default_force_def(IMPACT_FORCE_WIND);
    wind.strength = 0.1, wind.reach = 3, wind.body = "flies";
    def.bodies = bodies, def.body_count = COUNT;
    def.forces = &wind, def.force_count = 1;
    def.duration = 0.2, def.tolerance = 1e-6, def.max_steps = 3000, def.max_events = 50;
    return make_scene(&def);
}

/* FNV-1a, the bytes' own. */
static void put_sum(unsigned char *bytes, size_t size)
{
    uint64_t sum = 0xcbf29ce484222325u;
    for (size_t k = 0; k < size - WORD; k++) sum = (sum ^ bytes[k]) * 0x100000001b3u;
    for (size_t k = 0; k < WORD; k++) bytes[size - WORD + k] = (unsigned char)(sum >> (8 * k));
}

static uint64_t bits_of(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static void replace_words(bool corners)
{
    static unsigned char bytes[MOST_BYTES], changed[MOST_BYTES];
    size_t size = sizeof bytes;
    const uint64_t words[] = {0,
                              1,
                              2,
                              (uint64_t)-1,
                              1u << 31,
                              255,
                              bits_of(-1),
                              400,
                              bits_of(NAN),
                              bits_of(0.05),
                              bits_of(1e300),
                              bits_of(INFINITY)};
    long refused = 0, loaded = 0;
    impact_scene *from = make(corners), *scene = make(corners);
    assert_true(impact_scene_run_to(from, 0.1, NULL) >= 0);
    assert_int_equal(impact_scene_save(from, bytes, &size), IMPACT_OK);
    for (size_t place = 0; place + 2 * WORD <= size; place += WORD)
        for (size_t k = 0; k < sizeof words / sizeof *words; k++) {
            memcpy(changed, bytes, size);
            for (size_t i = 0; i < WORD; i++) changed[place + i] = (unsigned char)(words[k] >> (8 * i));
            put_sum(changed, size);
            const double t = impact_scene_time(scene);
            const impact_status status = impact_scene_load(scene, changed, size);
            if (status < 0) {
                if (impact_scene_message(scene)[0] == '\0') fail_msg("byte %zu, word %zu: %d", place, k, status);
                if (status == IMPACT_EARGUMENT) assert_true(impact_scene_time(scene) == t);
                refused++;
                if (status == IMPACT_EARGUMENT) continue;
            } else if (++loaded % EVERY == 0) {
                const impact_status ran = impact_scene_run(scene, NULL);
                if (ran < 0 && impact_scene_message(scene)[0] == '\0') fail_msg("byte %zu, word %zu", place, k);
            } else {
                continue;
            }
            impact_scene_destroy(scene);
            scene = make(corners);
        }
    assert_true(refused > 1000 && loaded > 1000);
    impact_scene_destroy(scene);
    impact_scene_destroy(from);
}

static void replaced_words_are_refused_or_go_on(void **state)
{
    (void)state;
    replace_words(false);
}

static void of_corners_too(void **state)
{
    (void)state;
    replace_words(true);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(replaced_words_are_refused_or_go_on),
        cmocka_unit_test(of_corners_too),
    };
    return impact_has(IMPACT_PART_CVODE) ? cmocka_run_group_tests(tests, NULL, NULL) : 0;
}
