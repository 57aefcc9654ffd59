/* SPDX-License-Identifier: MIT
 *
 * The bytes of a saved scene, changed: refused in words, and the scene stays where it is. Where their sum is put right
 * they are refused too, or go on as any run does: numbers that can be no state of the scene have to be found.
 */
#include "fuzz.h"

#include <impact/impact.h>

enum { MOST_BYTES = 8192, MOST_CHANGES = 16, SUM = 8 };

static struct {
    int count;
    size_t place[MOST_CHANGES];
    unsigned value[MOST_CHANGES];
    size_t part;
    bool mended;
} change;

void fuzz_show(FILE *out)
{
    fputs("bytes of the scene in fuzz_save.c, saved at 0.1 s, with", out);
    for (int k = 0; k < change.count; k++) fprintf(out, " [%zu] = %u", change.place[k], change.value[k]);
    fprintf(out, ", the first %zu%s\n", change.part, change.mended ? ", their sum put right" : "");
}

/* One rolls, one lies on a side and rocks, one flies. */
static impact_scene *make_scene(void)
{
    static const char *const names[4] = {"floor", "rolls", "egg", "flies"};
    impact_body_def bodies[4];
    impact_scene *scene = NULL;
    for (int i = 0; i < 4; i++) {
        bodies[i] = impact_default_body_def();
        bodies[i].name = names[i];
        bodies[i].is_static = i == 0;
        bodies[i].position = (qvec3){2.0 * i, 0, 0.1 * i};
        bodies[i].friction = 0.3;
        bodies[i].restitution = 0.5;
    }
    bodies[1].velocity.x = 1;
    bodies[2].omega.y = 1;
    bodies[3].position.z = 2;
    bodies[3].linear_damping = 0.1;
    impact_shape_plane(INFINITY, INFINITY, &bodies[0].shape);
    impact_shape_sphere(0.1, &bodies[1].shape);
    impact_shape_ellipsoid(0.4, 0.3, 0.2, &bodies[2].shape);
    impact_shape_ellipsoid(0.1, 0.2, 0.3, &bodies[3].shape);
    impact_scene_def def = impact_default_scene_def();
    def.bodies = bodies;
    def.body_count = 4;
    def.duration = 0.2;
    def.tolerance = 1e-8;
    def.max_steps = 2000;
    def.max_events = 200;
    const impact_status status = impact_scene_create(&def, &scene, NULL, 0);
    HOLD(status == IMPACT_OK, status, 0);
    return scene;
}

/* FNV-1a, as the bytes' own. */
static void put_sum(unsigned char *bytes, size_t size)
{
    uint64_t sum = 0xcbf29ce484222325u;
    for (size_t k = 0; k < size - SUM; k++) sum = (sum ^ bytes[k]) * 0x100000001b3u;
    for (size_t k = 0; k < SUM; k++) bytes[size - SUM + k] = (unsigned char)(sum >> (8 * k));
}

static void change_bytes(fuzz_bytes *b, unsigned char *bytes, size_t size)
{
    change.mended = take_below(b, 4) > 0;
    change.part = take_below(b, 8) == 1 ? size * take_byte(b) / 256 : size;
    change.count = 1 + (int)take_below(b, MOST_CHANGES);
    for (int k = 0; k < change.count; k++) {
        change.place[k] = (size_t)(take_byte(b) * 256 + take_byte(b)) % size;
        change.value[k] = take_byte(b);
        bytes[change.place[k]] = (unsigned char)change.value[k];
    }
    if (change.mended) put_sum(bytes, size);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t length)
{
    unsigned char bytes[MOST_BYTES], changed[MOST_BYTES];
    size_t size = sizeof bytes;
    fuzz_bytes input = {data, length};
    impact_scene *scene = make_scene();
    impact_scene_run_to(scene, 0.1, NULL);
    const impact_status saved = impact_scene_save(scene, bytes, &size);
    HOLD(saved == IMPACT_OK, saved, 0);
    memcpy(changed, bytes, size);
    change_bytes(&input, changed, size);
    const bool whole = change.part == size && memcmp(bytes, changed, size) == 0;
    const double t = impact_scene_time(scene);
    const impact_status status = impact_scene_load(scene, changed, change.part);
    HOLD(status >= 0 || impact_scene_message(scene)[0] != '\0', status, 0);
    HOLD(status != IMPACT_EARGUMENT || impact_scene_time(scene) == t, impact_scene_time(scene), t);
    HOLD(status != IMPACT_OK || whole || change.mended, status, 0);
    HOLD(status == IMPACT_OK || !whole, status, 0);
    if (status == IMPACT_OK) {
        impact_scene_run_to(scene, impact_scene_time(scene) + 0.05, NULL);
        impact_scene_held(scene, NULL, 0);
    }
    impact_scene_destroy(scene);
    return 0;
}
