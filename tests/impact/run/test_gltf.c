/* SPDX-License-Identifier: MIT
 *
 * A strict reader of our own for what impact_gltf_write writes: lengths, bounds, units, order of times, and straight
 * lines and slerp against the record. (Khronos' validator: ./run test browser.)
 */
#include "kit/scene_log.h"
#include <impact/impact.h>
#include "run/json.h"

#include <quat/interpolate.h>
#include <quat/rotation.h>
#include <stdint.h>
#include <stdio.h>

typedef struct glb {
    unsigned char *bytes, *buffer;
    size_t size, buffer_size;
    imp_arena *arena; /* of the JSON */
    const imp_json *json;
} glb;

static uint32_t word_at(const unsigned char *at) { return at[0] | at[1] << 8 | at[2] << 16 | (uint32_t)at[3] << 24; }

static const imp_json *item(const imp_json *list, int number)
{
    assert_non_null(list);
    const imp_json *member = list->first;
    while (number-- > 0) member = member->next;
    assert_non_null(member);
    return member;
}

static const imp_json *list_of(const imp_json *object, const char *key)
{
    const imp_json *list = imp_json_get(object, key, IMP_JSON_ARRAY);
    assert_non_null(list);
    return list;
}

static double number_of(const imp_json *object, const char *key)
{
    const imp_json *number = imp_json_get(object, key, IMP_JSON_NUMBER);
    assert_non_null(number);
    return number->number;
}

static glb read_glb(const char *path)
{
    glb g = {0};
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    g.size = (size_t)ftell(file);
    rewind(file);
    g.bytes = malloc(g.size);
    assert_int_equal(fread(g.bytes, 1, g.size, file), g.size);
    fclose(file);
    assert_memory_equal(g.bytes, "glTF", 4);
    assert_int_equal(word_at(g.bytes + 4), 2);
    assert_int_equal(word_at(g.bytes + 8), g.size);
    const uint32_t text = word_at(g.bytes + 12);
    assert_memory_equal(g.bytes + 16, "JSON", 4);
    assert_int_equal(text % 4, 0);
    assert_memory_equal(g.bytes + 20 + text + 4, "BIN\0", 4);
    g.buffer_size = word_at(g.bytes + 20 + text);
    g.buffer = g.bytes + 28 + text;
    assert_int_equal(28 + text + g.buffer_size, g.size);
    assert_int_equal(imp_arena_create(NULL, &g.arena), IMPACT_OK);
    assert_int_equal(imp_json_read(g.arena, (const char *)g.bytes + 20, text, &g.json), IMPACT_OK);
    assert_int_equal(number_of(item(list_of(g.json, "buffers"), 0), "byteLength"), g.buffer_size);
    return g;
}

static void free_glb(glb *g)
{
    imp_arena_destroy(g->arena);
    free(g->bytes);
}

/* The accessor's numbers, which lie in the buffer and between its min and max. */
static const float *floats_of(const glb *g, int accessor, int width, int *count)
{
    const imp_json *a = item(list_of(g->json, "accessors"), accessor);
    const imp_json *view = item(list_of(g->json, "bufferViews"), (int)number_of(a, "bufferView"));
    const double at = number_of(view, "byteOffset"), size = number_of(view, "byteLength");
    *count = (int)number_of(a, "count");
    assert_int_equal(number_of(a, "componentType"), 5126);
    assert_true(at + size <= (double)g->buffer_size && fmod(at, 4) == 0 && size == 4.0 * width * *count);
    const float *values = (const float *)(const void *)(g->buffer + (size_t)at);
    const imp_json *low = imp_json_get(a, "min", IMP_JSON_ARRAY), *high = imp_json_get(a, "max", IMP_JSON_ARRAY);
    for (int c = 0; low && c < width; c++) {
        double least = INFINITY, most = -INFINITY;
        for (int i = 0; i < *count; i++) {
            least = fmin(least, values[i * width + c]);
            most = fmax(most, values[i * width + c]);
        }
        assert_near(item(low, c)->number, least, 0);
        assert_near(item(high, c)->number, most, 0);
    }
    return values;
}

static int accessor_of(const glb *g, int sampler, const char *key)
{
    const imp_json *animation = item(list_of(g->json, "animations"), 0);
    const imp_json *s = item(list_of(animation, "samplers"), sampler);
    assert_string_equal(imp_json_get(s, "interpolation", IMP_JSON_STRING)->string, "LINEAR");
    return (int)number_of(s, key);
}

/* The pose of the body that samplers 2k and 2k + 1 move, at part s of its times. */
static void pose_at(const glb *g, int k, double t, qvec3 *x, quat *q)
{
    int count, places, turns;
    const float *times = floats_of(g, accessor_of(g, 2 * k, "input"), 1, &count);
    const float *p = floats_of(g, accessor_of(g, 2 * k, "output"), 3, &places);
    const float *r = floats_of(g, accessor_of(g, 2 * k + 1, "output"), 4, &turns);
    assert_true(places == count && turns == count);
    int i = 0;
    while (i + 2 < count && times[i + 1] <= t) i++;
    const double s = fmin(1, (t - times[i]) / (times[i + 1] - times[i]));
    const qvec3 a = {p[3 * i], p[3 * i + 1], p[3 * i + 2]}, b = {p[3 * i + 3], p[3 * i + 4], p[3 * i + 5]};
    *x = qvec3_axpy(s, qvec3_sub(b, a), a);
    const float *u = r + 4 * i, *v = u + 4;
    *q = quat_slerp((quat){u[3], u[0], u[1], u[2]}, (quat){v[3], v[0], v[1], v[2]}, s);
}

static impact_run *record(const impact_scene_def *def)
{
    char message[200];
    impact_scene *scene = make_scene(def);
    impact_run_writer *writer;
    impact_run *run;
    const void *bytes;
    size_t size;
    assert_int_equal(impact_run_create(scene, &writer, message, sizeof message), IMPACT_OK);
    const impact_recorder recorder = impact_run_recorder(writer);
    assert_true(impact_scene_run(scene, &recorder) >= 0);
    assert_int_equal(impact_run_bytes(writer, "end", &bytes, &size), IMPACT_OK);
    assert_int_equal(impact_run_read(bytes, size, "test", NULL, &run, message, sizeof message), IMPACT_OK);
    impact_run_discard(writer);
    impact_scene_destroy(scene);
    return run;
}

static void test_lines_meet_the_record(void **state)
{
    (void)state;
    if (!impact_has(IMPACT_PART_VIEW)) skip();
    impact_body_def bodies[3] = {plane_body("floor", (qvec3){0, 0, 0}, (quat){1, 0, 0, 0}, 0.5, 1),
                                 ball_body("ball", (qvec3){0, 0, 2}, 0.5, 0.9),
                                 ball_body("egg", (qvec3){3, 0, 2}, 0.5, 0.8)};
    bodies[1].velocity = (qvec3){1, 2, 0};
    bodies[1].omega = (qvec3){4, 3, 9};
    assert_int_equal(impact_shape_ellipsoid(0.2, 0.3, 0.4, &bodies[2].shape), IMPACT_OK);
    bodies[2].omega = (qvec3){2, 7, -1};
    impact_scene_def def = impact_default_scene_def();
    def.bodies = bodies;
    def.body_count = 3;
    def.duration = 1.5;
    impact_run *run = record(&def);
    char message[200], path[] = "test_gltf.glb";
    assert_int_equal(impact_gltf_write(run, 3e-4, 24, path, NULL, message, sizeof message), IMPACT_OK);
    glb g = read_glb(path);
    assert_int_equal(list_of(g.json, "nodes")->count, 4);
    assert_int_equal(list_of(g.json, "meshes")->count, 3);
    assert_int_equal(
        list_of(imp_json_get(item(list_of(g.json, "scenes"), 0), "extras", IMP_JSON_OBJECT), "events")->count,
        impact_run_event_count(run));
    const double size[2] = {0.3, 0.4};
    for (int k = 0; k < 2; k++) {
        int count;
        const float *times = floats_of(&g, accessor_of(&g, 2 * k, "input"), 1, &count);
        for (int i = 1; i < count; i++) assert_true(times[i] > times[i - 1]);
        const float *turns = floats_of(&g, accessor_of(&g, 2 * k + 1, "output"), 4, &count);
        for (int i = 0; i < 4 * count; i += 4) {
            const float *u = turns + i;
            assert_near(quat_norm((quat){u[3], u[0], u[1], u[2]}), 1, 1e-6);
        }
        for (int i = 0; i <= 1000; i++) {
            const double t = 1.5 * i / 1000;
            impact_sample s;
            qvec3 x;
            quat q;
            assert_int_equal(impact_run_state(run, k + 1, t, &s), IMPACT_OK);
            pose_at(&g, k, t, &x, &q);
            assert_true(qvec3_norm(qvec3_sub(x, s.position)) <= 3.1e-4 * size[k] + 4e-7); /* floats of 4 m */
            assert_true(quat_distance(q, s.orientation) <= 5e-4);
        }
    }
    free_glb(&g);
    remove(path);
    assert_int_equal(impact_gltf_write(run, 0, 24, path, NULL, message, sizeof message), IMPACT_EARGUMENT);
    assert_int_equal(impact_gltf_write(run, 3e-4, 24, "no/such/x.glb", NULL, message, sizeof message), IMPACT_ESINK);
    impact_run_close(run);
}

/* Between keys a hundredth of a frame apart at least, in frames that are floats, as Blender has them, the ball is
 * within what the file says of the run; its worst, in bodies. */
static double held_apart(const impact_run *run, double rate, double *off)
{
    char message[300], path[] = "test_gltf_rate.glb";
    assert_int_equal(impact_gltf_write(run, 3e-4, rate, path, NULL, message, sizeof message), IMPACT_OK);
    glb g = read_glb(path);
    const imp_json *extras = imp_json_get(item(list_of(g.json, "scenes"), 0), "extras", IMP_JSON_OBJECT);
    *off = number_of(extras, "off");
    assert_near(number_of(extras, "frame_rate"), rate, 0);
    assert_int_equal(message[0] != 0, *off > 3e-4);
    int count;
    const float *times = floats_of(&g, accessor_of(&g, 0, "input"), 1, &count);
    for (int i = 1; i < count; i++) assert_true((float)(times[i] * rate) - (float)(times[i - 1] * rate) > 0.01F);
    double worst = 0;
    for (int i = 0; i <= 5000; i++) {
        const double t = impact_run_end(run) * i / 5000;
        impact_sample s;
        qvec3 x;
        quat q;
        assert_int_equal(impact_run_state(run, 2, t, &s), IMPACT_OK);
        pose_at(&g, 0, t, &x, &q);
        worst = fmax(worst, qvec3_norm(qvec3_sub(x, s.position)) / 0.1);
    }
    free_glb(&g);
    remove(path);
    assert_true(worst <= fmax(*off, 3e-4));
    return worst;
}

/* A ball between two planes .5 mm wider than it meets one every .1 ms. */
static void test_what_frames_cannot_hold_is_said(void **state)
{
    (void)state;
    if (!impact_has(IMPACT_PART_VIEW)) skip();
    impact_body_def bodies[3] = {plane_body("floor", (qvec3){0, 0, 0}, (quat){1, 0, 0, 0}, 0, 1),
                                 plane_body("ceiling", (qvec3){0, 0, 0.2005}, (quat){0, 1, 0, 0}, 0, 1),
                                 ball_body("ball", (qvec3){0, 0, 0.1002}, 0, 1)};
    assert_int_equal(impact_shape_sphere(0.1, &bodies[2].shape), IMPACT_OK);
    bodies[2].velocity = (qvec3){1, 0, 5};
    impact_scene_def def = impact_default_scene_def();
    def.bodies = bodies;
    def.body_count = 3;
    def.duration = 0.05;
    impact_run *run = record(&def);
    assert_true(impact_run_event_count(run) > 400);
    double few, many;
    const double worst = held_apart(run, 24, &few);
    assert_true(worst > 2e-3 && few < 2 * worst);
    held_apart(run, 2400, &many);
    assert_true(many <= 3e-4);
    char message[300], path[] = "test_gltf_chosen.glb";
    assert_int_equal(impact_gltf_write(run, 3e-4, 0.5, path, NULL, message, sizeof message), IMPACT_EARGUMENT);
    assert_string_equal(message, "frame_rate = 0.5 must lie in [1, 32767], as Blender's does, or be 0");
    assert_int_equal(impact_gltf_write(run, 3e-4, 0, path, NULL, message, sizeof message), IMPACT_OK);
    assert_non_null(strstr(message, "for a scene of 2400 frames a second in Blender"));
    glb g = read_glb(path);
    const imp_json *extras = imp_json_get(item(list_of(g.json, "scenes"), 0), "extras", IMP_JSON_OBJECT);
    assert_near(number_of(extras, "frame_rate"), 2400, 0);
    assert_near(number_of(extras, "off"), many, 0);
    free_glb(&g);
    remove(path);
    impact_run_close(run);
}

static void test_equal_shapes_share_a_mesh(void **state)
{
    (void)state;
    if (!impact_has(IMPACT_PART_VIEW)) skip();
    impact_body_def bodies[2] = {ball_body("a", (qvec3){0, 0, 2}, 0.5, 1), ball_body("b", (qvec3){3, 0, 2}, 0.5, 1)};
    impact_scene_def def = impact_default_scene_def();
    def.bodies = bodies;
    def.body_count = 2;
    impact_run *run = record(&def);
    char message[200], path[] = "test_gltf_two.glb";
    assert_int_equal(impact_gltf_write(run, 3e-4, 24, path, NULL, message, sizeof message), IMPACT_OK);
    glb g = read_glb(path);
    assert_int_equal(list_of(g.json, "meshes")->count, 1);
    free_glb(&g);
    remove(path);
    impact_run_close(run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lines_meet_the_record),
        cmocka_unit_test(test_what_frames_cannot_hold_is_said),
        cmocka_unit_test(test_equal_shapes_share_a_mesh),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
