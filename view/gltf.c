/* SPDX-License-Identifier: MIT
 *
 * glTF 2.0 (Khronos 2021) in one binary file: a line of JSON that names pieces of one buffer. A node for each body
 * under a root that turns z up into glTF's y up; a mesh for each shape, its octants of either sign as two primitives
 * with two materials, so that turning is seen; one animation.
 */
#include "gltf_keys.h"
#include "mesh.h"

#include <impact/view.h>
#include <quat/rotation.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "run/run_open.h"
#include "run/text.h"

enum { FLOAT = 5126, WORD = 5125, SHORT = 5123, VERTICES = 34962, INDICES = 34963 };

/* What a plane without edges shows of itself, m from the middle of the motion, in sizes of that. */
static const double plane_room = 1.5;

/* Of materials: of what moves and what is static, in one octant and the next. */
enum { KINDS = 4 };

/* 1/s: Blender's own, and multiples of it, of which every tenth, hundredth, thousandth frame is one of its own; up to
 * what Blender admits. */
static const double frame_rates[] = {24, 240, 2400, 24000};

typedef struct gltf {
    imp_arena *arena;
    const impact_run *run;
    imp_text buffer, views, accessors, meshes, nodes, channels, samplers, materials;
    int view_count, accessor_count, mesh_count, sampler_count, material_count;
    int material[KINDS]; /* their numbers, from 1; 0: not used so far */
    qvec3 middle;        /* of the motion, and its half size */
    double half;
    imp_gltf_way way;
    double off; /* what keys are off by where Blender would take closer ones as one */
} gltf;

static void say_list(imp_text *text, const double *values, int count)
{
    for (int i = 0; i < count; i++) {
        imp_text_say(text, i ? "," : "[");
        imp_text_number(text, values[i]);
    }
    imp_text_say(text, "]");
}

static void say(imp_text *text, const char *before, double value)
{
    imp_text_say(text, before);
    imp_text_number(text, value);
}

/* ---- accessors ---- */

/* Puts bytes into the buffer; the accessor's number. low and high: of each of the width components, or NULL. */
static int put_accessor(gltf *g, const void *bytes, size_t size, int target, int type, long count, int width,
                        const double *low, const double *high)
{
    static const char *const types[] = {"", "SCALAR", "", "VEC3", "VEC4"};
    static const char padding[4] = {0};
    say(&g->views,
        g->view_count ? ",{\"buffer\":0,\"byteOffset\":" : "{\"buffer\":0,\"byteOffset\":", (double)g->buffer.size);
    say(&g->views, ",\"byteLength\":", (double)size);
    if (target) say(&g->views, ",\"target\":", target);
    imp_text_say(&g->views, "}");
    say(&g->accessors, g->accessor_count ? ",{\"bufferView\":" : "{\"bufferView\":", g->view_count++);
    say(&g->accessors, ",\"componentType\":", type);
    say(&g->accessors, ",\"count\":", (double)count);
    imp_text_say(&g->accessors, ",\"type\":");
    imp_text_string(&g->accessors, types[width]);
    if (low) {
        imp_text_say(&g->accessors, ",\"min\":");
        say_list(&g->accessors, low, width);
        imp_text_say(&g->accessors, ",\"max\":");
        say_list(&g->accessors, high, width);
    }
    imp_text_say(&g->accessors, "}");
    imp_text_put(&g->buffer, bytes, size);
    imp_text_put(&g->buffer, padding, (4 - size % 4) % 4);
    return g->accessor_count++;
}

static int put_floats(gltf *g, const float *values, long count, int width, int target, bool bounded)
{
    double low[4] = {INFINITY, INFINITY, INFINITY, INFINITY}, high[4] = {-INFINITY, -INFINITY, -INFINITY, -INFINITY};
    for (long i = 0; i < count * width; i++) {
        low[i % width] = fmin(low[i % width], values[i]);
        high[i % width] = fmax(high[i % width], values[i]);
    }
    const size_t size = sizeof *values * (size_t)count * (size_t)width;
    return put_accessor(g, values, size, target, FLOAT, count, width, bounded ? low : NULL, high);
}

/* ---- meshes ---- */

static void put_vector(float *place, qvec3 v) { place[0] = (float)v.x, place[1] = (float)v.y, place[2] = (float)v.z; }

/* Vermillion and its light partner, of bodies that move; greys. Linear, as glTF has colours. */
static void say_material(gltf *g, int kind)
{
    static const double colors[KINDS][4] = {
        {0.665, 0.112, 0, 1}, {0.93, 0.83, 0.76, 1}, {0.5, 0.5, 0.48, 1}, {0.7, 0.7, 0.7, 1}};
    static const char *const names[KINDS] = {"moving", "moving, light", "static", "static, light"};
    imp_text_say(&g->materials, g->material_count ? ",{\"name\":" : "{\"name\":");
    imp_text_string(&g->materials, names[kind]);
    imp_text_say(&g->materials,
                 ",\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0.5,\"baseColorFactor\":");
    say_list(&g->materials, colors[kind], 4);
    imp_text_say(&g->materials, "}}");
}

/* Its number, made when first asked for. */
static int material_of(gltf *g, int kind)
{
    if (g->material[kind] == 0) {
        say_material(g, kind);
        g->material[kind] = ++g->material_count;
    }
    return g->material[kind] - 1;
}

static void say_primitive(gltf *g, int points, int normals, int index, int material)
{
    say(&g->meshes, "{\"attributes\":{\"POSITION\":", points);
    say(&g->meshes, ",\"NORMAL\":", normals);
    say(&g->meshes, "},\"indices\":", index);
    say(&g->meshes, ",\"material\":", material_of(g, material));
    imp_text_say(&g->meshes, "}");
}

static bool solid_mesh(gltf *g, const impact_body_def *def, int material)
{
    imp_mesh mesh;
    const bool whole = imp_mesh_of(g->arena, def, &mesh);
    if (whole) {
        const long count = (long)(mesh.points.size / (3 * sizeof(float)));
        const int at = put_floats(g, (const float *)(const void *)mesh.points.bytes, count, 3, VERTICES, true);
        const int up = put_floats(g, (const float *)(const void *)mesh.normals.bytes, count, 3, VERTICES, false);
        for (int kind = 0; kind < 2; kind++) {
            const imp_text *index = &mesh.index[kind];
            const long corners = (long)(index->size / sizeof(uint32_t));
            const int list = put_accessor(g, index->bytes, index->size, INDICES, WORD, corners, 1, NULL, NULL);
            if (kind) imp_text_say(&g->meshes, ",");
            say_primitive(g, at, up, list, material + kind);
        }
    }
    imp_mesh_free(&mesh);
    return whole;
}

static bool plane_mesh(gltf *g, const impact_body_def *def, int material)
{
    static const uint16_t index[6] = {0, 1, 2, 0, 2, 3};
    const qvec3 off = quat_rotate_inverse(def->orientation, qvec3_sub(g->middle, def->position));
    const double x = isfinite(def->shape.a) ? def->shape.a : plane_room * g->half + fabs(off.x);
    const double y = isfinite(def->shape.b) ? def->shape.b : plane_room * g->half + fabs(off.y);
    const float w = (float)x, d = (float)y;
    const float points[12] = {-w, -d, 0, w, -d, 0, w, d, 0, -w, d, 0},
                normals[12] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    const int at = put_floats(g, points, 4, 3, VERTICES, true), up = put_floats(g, normals, 4, 3, VERTICES, false);
    const int list = put_accessor(g, index, sizeof index, INDICES, SHORT, 6, 1, NULL, NULL);
    say_primitive(g, at, up, list, material);
    return true;
}

static bool same_look(const impact_body_def *a, const impact_body_def *b)
{
    const impact_shape *s = &a->shape, *t = &b->shape;
    return a->is_static == b->is_static && s->kind == t->kind && s->a == t->a && s->b == t->b && s->c == t->c &&
           s->r == t->r && s->s == t->s && s->t == t->t && s->rounding == t->rounding && s->hull == t->hull &&
           qvec3_norm(qvec3_sub(a->shape_position, b->shape_position)) == 0 &&
           quat_norm(quat_sub(a->shape_orientation, b->shape_orientation)) == 0;
}

/* The mesh of an earlier body of the same shape and colour, or a new one; -1: out of memory. */
static int mesh_of(gltf *g, int body, const int *meshes, int material)
{
    impact_body_def def = impact_default_body_def(), other = def;
    impact_run_body(g->run, body, &def);
    for (int i = 0; i < body && def.shape.kind != IMPACT_PLANE; i++) {
        impact_run_body(g->run, i, &other);
        if (same_look(&other, &def)) return meshes[i];
    }
    imp_text_say(&g->meshes, g->mesh_count ? ",{\"primitives\":[" : "{\"primitives\":[");
    if (!(def.shape.kind == IMPACT_PLANE ? plane_mesh : solid_mesh)(g, &def, material)) return -1;
    imp_text_say(&g->meshes, "]}");
    return g->mesh_count++;
}

/* ---- motion ---- */

static void say_channel(gltf *g, int body, int times, int values, const char *path)
{
    say(&g->samplers, g->sampler_count ? ",{\"input\":" : "{\"input\":", times);
    say(&g->samplers, ",\"interpolation\":\"LINEAR\",\"output\":", values);
    imp_text_say(&g->samplers, "}");
    say(&g->channels, g->sampler_count ? ",{\"sampler\":" : "{\"sampler\":", g->sampler_count);
    say(&g->channels, ",\"target\":{\"node\":", body + 1);
    imp_text_say(&g->channels, ",\"path\":");
    imp_text_string(&g->channels, path);
    imp_text_say(&g->channels, "}}");
    g->sampler_count++;
}

/* glTF has the scalar part last. */
static void put_quat(float *place, quat q)
{
    const double values[4] = {q.x, q.y, q.z, q.w};
    for (int c = 0; c < 4; c++) place[c] = (float)values[c];
}

static bool animate(gltf *g, int body)
{
    int count;
    imp_gltf_key *keys = imp_gltf_keys(g->arena, g->run, body, &g->way, &count, &g->off);
    float *times = imp_arena_take(g->arena, (size_t)count, sizeof *times);
    float *places = imp_arena_take(g->arena, (size_t)count, 3 * sizeof *places);
    float *turns = imp_arena_take(g->arena, (size_t)count, 4 * sizeof *turns);
    const bool whole = keys && times && places && turns;
    long kept = 0;
    for (int i = 0; whole && i < count; i++) {
        const float t = (float)(keys[i].t - impact_run_begin(g->run));
        if (kept > 0 && !(t > times[kept - 1])) continue; /* times increase as floats too */
        times[kept] = t;
        put_vector(places + 3 * kept, keys[i].x);
        put_quat(turns + 4 * kept++, keys[i].q);
    }
    if (whole) {
        const int input = put_floats(g, times, kept, 1, 0, true);
        say_channel(g, body, input, put_floats(g, places, kept, 3, 0, false), "translation");
        say_channel(g, body, input, put_floats(g, turns, kept, 4, 0, false), "rotation");
    }
    imp_arena_give(g->arena, keys);
    imp_arena_give(g->arena, times);
    imp_arena_give(g->arena, places);
    imp_arena_give(g->arena, turns);
    return whole;
}

static void say_node(gltf *g, int body, int mesh)
{
    impact_body_def def = impact_default_body_def();
    impact_run_body(g->run, body, &def);
    const quat q = def.orientation;
    imp_text_say(&g->nodes, ",{\"name\":");
    imp_text_string(&g->nodes, def.name);
    say(&g->nodes, ",\"mesh\":", mesh);
    imp_text_say(&g->nodes, ",\"translation\":");
    say_list(&g->nodes, (const double[]){def.position.x, def.position.y, def.position.z}, 3);
    imp_text_say(&g->nodes, ",\"rotation\":");
    say_list(&g->nodes, (const double[]){q.x, q.y, q.z, q.w}, 4);
    imp_text_say(&g->nodes, ",\"extras\":{\"shape\":");
    imp_text_string(&g->nodes, imp_run_shapes[def.shape.kind]);
    imp_text_say(&g->nodes, ",\"exponents\":");
    say_list(&g->nodes, (const double[]){def.shape.r, def.shape.s, def.shape.t}, 3);
    say(&g->nodes, ",\"friction\":", def.friction);
    say(&g->nodes, ",\"restitution\":", def.restitution);
    if (!def.is_static) say(&g->nodes, ",\"mass\":", def.mass);
    if (!def.is_static) imp_text_say(&g->nodes, ",\"moments\":");
    if (!def.is_static) say_list(&g->nodes, (const double[]){def.moments.x, def.moments.y, def.moments.z}, 3);
    imp_text_say(&g->nodes, "}}");
}

/* ---- the file ---- */

static void measure(gltf *g)
{
    qvec3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    for (int i = 0; i < impact_run_body_count(g->run); i++) {
        impact_body_def def = impact_default_body_def();
        impact_run_body(g->run, i, &def);
        const double r = def.shape.kind == IMPACT_PLANE ? 0 : impact_shape_bounding_radius(&def.shape);
        for (long k = 0; k < impact_run_key_count(g->run, i) && (r > 0 || impact_run_body_count(g->run) == 1); k++) {
            impact_key key;
            impact_run_key(g->run, i, k, &key);
            const qvec3 x = key.position;
            low = (qvec3){fmin(low.x, x.x - r), fmin(low.y, x.y - r), fmin(low.z, x.z - r)};
            high = (qvec3){fmax(high.x, x.x + r), fmax(high.y, x.y + r), fmax(high.z, x.z + r)};
        }
    }
    const bool any = low.x <= high.x;
    g->middle = any ? qvec3_scale(qvec3_add(low, high), 0.5) : (qvec3){0, 0, 0};
    g->half = any ? fmax(0.5 * qvec3_norm(qvec3_sub(high, low)), 1e-30) : 1;
}

static bool fill(gltf *g)
{
    const int count = impact_run_body_count(g->run);
    int *meshes = imp_arena_take(g->arena, (size_t)count, sizeof *meshes);
    bool whole = meshes != NULL;
    measure(g);
    for (int i = 0; whole && i < count; i++) {
        impact_body_def def = impact_default_body_def();
        impact_run_body(g->run, i, &def);
        meshes[i] = mesh_of(g, i, meshes, def.is_static ? 2 : 0);
        whole = meshes[i] >= 0;
        say_node(g, i, meshes[i]);
        if (whole && !def.is_static && impact_run_end(g->run) > impact_run_begin(g->run)) whole = animate(g, i);
    }
    return whole;
}

static void say_events(imp_text *json, const impact_run *run)
{
    for (long k = 0; k < impact_run_event_count(run); k++) {
        impact_event e;
        impact_run_event(run, k, &e);
        say(json, k ? ",{\"t\":" : "{\"t\":", e.t);
        imp_text_say(json, ",\"event\":");
        imp_text_string(json, impact_event_name(e.kind));
        imp_text_say(json, ",\"bodies\":[");
        imp_text_string(json, e.name1);
        imp_text_say(json, ",");
        imp_text_string(json, e.name2);
        imp_text_say(json, "],\"point\":");
        say_list(json, (const double[]){e.point.x, e.point.y, e.point.z}, 3);
        imp_text_say(json, ",\"impulse\":");
        say_list(json, (const double[]){e.impulse.x, e.impulse.y, e.impulse.z}, 3);
        imp_text_say(json, "}");
    }
}

static void join(imp_text *json, const char *before, const imp_text *part)
{
    imp_text_say(json, before);
    imp_text_put(json, part->bytes, part->size);
}

static void say_json(imp_text *json, const gltf *g)
{
    imp_text_say(json, "{\"asset\":{\"version\":\"2.0\",\"generator\":\"impact\"},\"scene\":0,\"scenes\":[{\"nodes\":["
                       "0],\"extras\":{\"frame_rate\":");
    imp_text_number(json, g->way.frame_rate);
    say(json, ",\"tolerance\":", g->way.tolerance);
    say(json, ",\"off\":", g->off);
    imp_text_say(json, ",\"events\":[");
    say_events(json, g->run);
    imp_text_say(json, "]}}],\"nodes\":[{\"name\":\"scene, z "
                       "up\",\"rotation\":[-0.7071067811865476,0,0,0.7071067811865476],\"children\":[");
    for (int i = 0; i < impact_run_body_count(g->run); i++) say(json, i ? "," : "", i + 1);
    join(json, "]}", &g->nodes);
    join(json, "],\"meshes\":[", &g->meshes);
    join(json, "],\"materials\":[", &g->materials);
    if (g->sampler_count > 0) {
        join(json, "],\"animations\":[{\"name\":\"run\",\"channels\":[", &g->channels);
        join(json, "],\"samplers\":[", &g->samplers);
        imp_text_say(json, "]}");
    }
    join(json, "],\"accessors\":[", &g->accessors);
    join(json, "],\"bufferViews\":[", &g->views);
    say(json, "],\"buffers\":[{\"byteLength\":", (double)g->buffer.size);
    imp_text_say(json, "}]}");
    while (!json->failed && json->size % 4 != 0) imp_text_say(json, " ");
}

static void put_word(imp_text *file, size_t value)
{
    const unsigned char bytes[4] = {value & 255, value >> 8 & 255, value >> 16 & 255, value >> 24 & 255};
    imp_text_put(file, bytes, 4);
}

static void put_file(imp_text *file, const imp_text *json, const imp_text *buffer)
{
    imp_text_say(file, "glTF");
    put_word(file, 2);
    put_word(file, 12 + 8 + json->size + 8 + buffer->size);
    put_word(file, json->size);
    imp_text_say(file, "JSON");
    imp_text_put(file, json->bytes, json->size);
    put_word(file, buffer->size);
    imp_text_put(file, "BIN", 4);
    imp_text_put(file, buffer->bytes, buffer->size);
}

/* Of what the file could not hold. */
static void say_what_is_off(const gltf *g, char *message, unsigned long message_size)
{
    if (!(g->off > g->way.tolerance)) return;
    snprintf(
        message, message_size,
        "at %g frames a second Blender, to which keys within a hundredth of a frame are one, shows bodies up to %.2g "
        "of their size or rad off; more frames bring it closer",
        g->way.frame_rate, g->off);
}

static void say_rate(double rate, char *message, unsigned long message_size)
{
    snprintf(message, message_size,
             "for a scene of %g frames a second in Blender, to be set before importing; events follow too fast for %g",
             rate, frame_rates[0]);
}

/* The pieces of the file at the rate of g->way. */
static bool make(gltf *g)
{
    imp_text *const parts[] = {&g->buffer, &g->views,    &g->accessors, &g->meshes,
                               &g->nodes,  &g->channels, &g->samplers,  &g->materials};
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) parts[i]->arena = g->arena;
    bool whole = fill(g);
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) whole = whole && !parts[i]->failed;
    return whole;
}

static impact_status write_file(gltf *g, const char *path, impact_quota *quota, char *message,
                                unsigned long message_size)
{
    imp_text json = {.arena = g->arena}, file = {.arena = g->arena};
    say_json(&json, g);
    put_file(&file, &json, &g->buffer);
    if (message) say_what_is_off(g, message, message_size);
    if (!json.failed && !file.failed)
        return imp_file_save(g->arena, path, file.bytes, file.size, quota, message, message_size);
    if (message) imp_arena_explain(g->run->arena, message, message_size);
    return IMPACT_ENOMEM;
}

/* *good: whether the file holds the run to its tolerance, and is written; or is written in any case, as the last. */
static impact_status try_rate(const impact_run *run, imp_gltf_way way, bool last, bool *good, const char *path,
                              impact_quota *quota, char *message, unsigned long message_size)
{
    gltf g = {.run = run, .way = way};
    const impact_allocator within = imp_arena_allocator(run->arena);
    impact_status status = imp_arena_create(&within, &g.arena);
    if (status == IMPACT_OK && !make(&g)) status = IMPACT_ENOMEM;
    if (status != IMPACT_OK && message) imp_arena_explain(run->arena, message, message_size);
    *good = status != IMPACT_OK || last || g.off <= way.tolerance;
    if (status == IMPACT_OK && *good) status = write_file(&g, path, quota, message, message_size);
    imp_arena_destroy(g.arena);
    return status;
}

static impact_status refuse(const char *words, double value, char *message, unsigned long message_size)
{
    if (message) snprintf(message, message_size, words, value);
    return IMPACT_EARGUMENT;
}

impact_status impact_gltf_write(const impact_run *run, double tolerance, double frame_rate, const char *path,
                                impact_quota *quota, char *message, unsigned long message_size)
{
    const int rates = (int)(sizeof frame_rates / sizeof *frame_rates);
    impact_status status = IMPACT_OK;
    bool good = false;
    if (message && message_size > 0) message[0] = '\0';
    if (!(tolerance >= 1e-7 && tolerance <= 0.1))
        return refuse("tolerance = %g must lie in [1e-7, 0.1]: glTF has floats", tolerance, message, message_size);
    if (frame_rate != 0 && !(frame_rate >= 1 && frame_rate <= 32767))
        return refuse("frame_rate = %g must lie in [1, 32767], as Blender's does, or be 0", frame_rate, message,
                      message_size);
    for (int k = frame_rate == 0 ? 0 : rates - 1; k < rates && !good; k++) {
        const imp_gltf_way way = {tolerance, frame_rate == 0 ? frame_rates[k] : frame_rate};
        status = try_rate(run, way, k == rates - 1, &good, path, quota, message, message_size);
        const bool silent = status == IMPACT_OK && good && message && !message[0];
        if (silent && way.frame_rate != frame_rates[0] && frame_rate == 0)
            say_rate(way.frame_rate, message, message_size);
    }
    return status;
}
