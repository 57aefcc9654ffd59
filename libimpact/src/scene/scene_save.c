/* SPDX-License-Identifier: MIT
 *
 * Saved scenes as bytes: a head that says of which scene, by which version, how long; what is saved (saved.h); and a
 * sum of all bytes before it. Nothing of it is believed before the sum is right and all numbers can be.
 */
#include "base/floats.h"
#include "scene/saved.h"
#include "scene/scene_methods.h"

#include <stdio.h>
#include <string.h>

enum { FORMAT = 5, NAME = 64, SUM = 8 };

static const char magic[16] = "impact saved";

/* ---- the definition ---- */

static void print_text(imp_archive *a, const char *text)
{
    char end = '\0';
    for (const char *c = text ? text : ""; *c; c++) {
        char letter[1] = {*c};
        imp_archive_text(a, letter, 1);
    }
    imp_archive_text(a, &end, 1);
}

static void print_numbers(imp_archive *a, const double *numbers, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        double number = isnan(numbers[k]) ? NAN : numbers[k]; /* one of its many */
        imp_archive_double(a, &number);
    }
}

#define PRINT(a, ...)                                                                                                  \
    print_numbers(a, (const double[]){__VA_ARGS__}, sizeof((const double[]){__VA_ARGS__}) / sizeof(double))

static void print_hull(imp_archive *a, const impact_hull *hull)
{
    if (!hull) return;
    const impact_hull_info info = impact_hull_describe(hull);
    for (int i = 0; i < info.vertices; i++) {
        const qvec3 v = impact_hull_vertex(hull, i);
        PRINT(a, v.x, v.y, v.z);
    }
}

static void print_body(imp_archive *a, const impact_body_def *b)
{
    const impact_shape *s = &b->shape;
    print_text(a, b->name);
    PRINT(a, s->kind, s->a, s->b, s->c, s->r, s->s, s->t, s->rounding, s->base);
    print_hull(a, s->hull);
    PRINT(a, b->is_static, b->mass, b->density, b->moments.x, b->moments.y, b->moments.z);
    PRINT(a, b->position.x, b->position.y, b->position.z);
    PRINT(a, b->orientation.w, b->orientation.x, b->orientation.y, b->orientation.z);
    PRINT(a, b->shape_position.x, b->shape_position.y, b->shape_position.z);
    PRINT(a, b->shape_orientation.w, b->shape_orientation.x, b->shape_orientation.y, b->shape_orientation.z);
    PRINT(a, b->velocity.x, b->velocity.y, b->velocity.z, b->omega.x, b->omega.y, b->omega.z);
    PRINT(a, b->friction, b->restitution, b->torsional_friction, b->rolling_friction);
    PRINT(a, b->linear_damping, b->angular_damping);
}

/* Functions and contexts are the loading scene's own. */
static void print_force(imp_archive *a, const impact_force_def *f)
{
    print_text(a, f->name);
    print_text(a, f->body);
    PRINT(a, f->kind, f->body != NULL, f->edge != NULL, f->steady);
    PRINT(a, f->origin.x, f->origin.y, f->origin.z, f->direction.x, f->direction.y, f->direction.z);
    PRINT(a, f->strength, f->reach, f->radius, f->falloff_power, f->falloff_length, f->drag, f->constant, f->power);
    PRINT(a, f->max_step, f->switch_period, f->switch_count);
    if (f->kind == IMPACT_FORCE_CUSTOM) print_numbers(a, f->switches, (size_t)f->switch_count);
}

uint64_t imp_scene_print(const impact_scene_def *def)
{
    imp_archive a = imp_archive_write(NULL, 0);
    print_text(&a, def->name);
    PRINT(&a, def->gravity.x, def->gravity.y, def->gravity.z, def->duration, def->output_rate);
    PRINT(&a, def->body_count, def->force_count, def->pair_count);
    for (int i = 0; i < def->body_count; i++) print_body(&a, &def->bodies[i]);
    for (int k = 0; k < def->force_count; k++) print_force(&a, &def->forces[k]);
    for (int k = 0; k < def->pair_count; k++) {
        print_text(&a, def->pairs[k].body1);
        print_text(&a, def->pairs[k].body2);
        PRINT(&a, def->pairs[k].friction, def->pairs[k].restitution, def->pairs[k].stiffness);
        PRINT(&a, def->pairs[k].torsional_friction, def->pairs[k].rolling_friction);
    }
    PRINT(&a, def->friction_rule, def->restitution_rule, def->law, def->compliance);
    const impact_methods m = imp_scene_methods_of(def);
    PRINT(&a, m.motion, m.impacts, m.gaps, m.tolerance, m.impact_tolerance, m.gap_tolerance, m.step);
    PRINT(&a, def->rest_height, def->rest_speed, imp_scene_piles_of(def), def->together, def->samples,
          def->pile_tolerance);
    return a.sum;
}

/* ---- the head ---- */

typedef struct save_head {
    char magic[sizeof magic];
    uint64_t size; /* of all bytes */
    int format, version[3];
    char name[NAME];
    int bodies;
    uint64_t print;
} save_head;

static void walk_head(imp_archive *a, save_head *head)
{
    imp_archive_text(a, head->magic, sizeof head->magic);
    imp_archive_word(a, &head->size);
    imp_archive_int(a, &head->format, 0, INT32_MAX);
    for (int k = 0; k < 3; k++) imp_archive_int(a, &head->version[k], 0, INT32_MAX);
    imp_archive_text(a, head->name, sizeof head->name);
    imp_archive_int(a, &head->bodies, 0, INT32_MAX);
    imp_archive_word(a, &head->print);
}

static save_head own_head(const impact_scene *scene, size_t size)
{
    save_head head = {.size = size,
                      .format = FORMAT,
                      .version = {IMPACT_VERSION_MAJOR, IMPACT_VERSION_MINOR, IMPACT_VERSION_PATCH},
                      .bodies = scene->world.body_count,
                      .print = scene->print};
    memcpy(head.magic, magic, sizeof magic);
    snprintf(head.name, sizeof head.name, "%s", scene->name);
    return head;
}

/* ---- saving ---- */

static impact_status refuse_save(impact_scene *scene, const char *why)
{
    snprintf(scene->message, sizeof scene->message, "scene '%s' cannot be saved: %s", scene->name, why);
    return IMPACT_EARGUMENT;
}

/* Between two instants of a run that has not failed: contacts that are due are found again, ends of segments are not.
 */
static impact_status check_pause(impact_scene *scene)
{
    scene->message[0] = '\0';
    if (scene->failed) return refuse_save(scene, "its run has failed");
    for (int k = 0; k < scene->island_count; k++) {
        const imp_island *island = scene->islands[k];
        if (!island) continue;
        if (!island->moves) return refuse_save(scene, "its run has failed");
        const bool is_due = imp_queue_time_of(&scene->queue, imp_scene_island_slot(scene, k)) <= scene->t;
        if (is_due && island->end.kind != IMP_END_TIME)
            return refuse_save(scene, "it was stopped amid an instant; run it on first");
    }
    return IMPACT_OK;
}

static void write_all(imp_archive *a, const impact_scene *scene, imp_saved *saved, size_t size)
{
    save_head head = own_head(scene, size);
    walk_head(a, &head);
    imp_saved_walk(saved, a, NULL);
    uint64_t sum = a->sum;
    imp_archive_word(a, &sum);
}

static impact_status save(impact_scene *scene, void *bytes, size_t *size)
{
    imp_saved saved;
    const size_t room = bytes ? *size : 0;
    impact_status status = check_pause(scene);
    if (status != IMPACT_OK) return status;
    status = imp_saved_collect(&saved, scene);
    if (status == IMPACT_OK) {
        imp_archive count = imp_archive_write(NULL, 0);
        write_all(&count, scene, &saved, 0);
        *size = count.at;
        imp_archive archive = imp_archive_write(bytes, room);
        if (bytes && room < count.at)
            status = refuse_save(scene, "there is not so much room");
        else if (bytes)
            write_all(&archive, scene, &saved, count.at);
        if (bytes && status == IMPACT_OK) status = imp_saved_restore(&saved, scene);
        scene->failed = status < 0 && status != IMPACT_EARGUMENT;
    }
    imp_saved_release(&saved, scene->world.arena);
    return status;
}

static impact_status explained(impact_scene *scene, impact_status status)
{
    if (status == IMPACT_ENOMEM) imp_arena_explain(scene->world.arena, scene->message, sizeof scene->message);
    if (status < 0 && scene->message[0] == '\0')
        snprintf(scene->message, sizeof scene->message, "%s", impact_status_string(status));
    return status;
}

impact_status impact_scene_save(impact_scene *scene, void *bytes, size_t *size)
{
    const imp_floats floats = imp_floats_hold();
    const impact_status status = explained(scene, save(scene, bytes, size));
    imp_floats_give_back(&floats);
    return status;
}

/* ---- loading ---- */

static impact_status refuse_load(impact_scene *scene, const char *why)
{
    snprintf(scene->message, sizeof scene->message, "scene '%s' cannot go on from these bytes: %s", scene->name, why);
    return IMPACT_EARGUMENT;
}

/* The sum first: what is damaged is not asked what it is. */
static impact_status check_bytes(impact_scene *scene, const void *bytes, size_t size, save_head *head)
{
    char why[200];
    imp_archive a = imp_archive_read(bytes, size), sum = imp_archive_read(bytes, size);
    walk_head(&a, head);
    if (size < a.at + SUM || memcmp(head->magic, magic, sizeof magic) != 0)
        return refuse_load(scene, "they are no saved scene");
    if (head->size != size) {
        snprintf(why, sizeof why, "a saved scene of %llu bytes, of which there are %zu", (unsigned long long)head->size,
                 size);
        return refuse_load(scene, why);
    }
    for (size_t k = 0; k < size - SUM; k++) imp_archive_text(&sum, (char[1]){0}, 1);
    const uint64_t wanted = sum.sum;
    uint64_t found = 0;
    imp_archive_word(&sum, &found);
    return found == wanted && !a.failed ? IMPACT_OK : refuse_load(scene, "they are damaged, their sum is wrong");
}

static impact_status check_scene(impact_scene *scene, const save_head *head)
{
    char why[300];
    const save_head own = own_head(scene, 0);
    if (head->format != own.format || memcmp(head->version, own.version, sizeof own.version) != 0) {
        snprintf(why, sizeof why, "version %d.%d.%d saved them, this is %s", head->version[0], head->version[1],
                 head->version[2], impact_version());
        return refuse_load(scene, why);
    }
    if (strcmp(head->name, own.name) != 0 || head->bodies != own.bodies) {
        snprintf(why, sizeof why, "they are scene '%s' with %d bodies, this one has %d", head->name, head->bodies,
                 own.bodies);
        return refuse_load(scene, why);
    }
    return head->print == own.print ? IMPACT_OK
                                    : refuse_load(scene, "its definition was another one when it was saved");
}

static impact_status read_all(impact_scene *scene, const void *bytes, size_t size, imp_saved *saved)
{
    save_head head;
    impact_status status = check_bytes(scene, bytes, size, &head);
    if (status == IMPACT_OK) status = check_scene(scene, &head);
    if (status != IMPACT_OK) return status;
    imp_archive a = imp_archive_read(bytes, size - SUM);
    walk_head(&a, &head);
    status = imp_saved_walk(saved, &a, scene->world.arena);
    const char *fault = "numbers in their places";
    if (status == IMPACT_OK && a.at != size - SUM) status = IMPACT_EARGUMENT;
    if (status == IMPACT_OK) status = imp_saved_check(saved, scene, &fault);
    if (status != IMPACT_EARGUMENT) return status;
    char why[200];
    snprintf(why, sizeof why, "they are no state of it: wanted %s", fault);
    return refuse_load(scene, why);
}

static impact_status load(impact_scene *scene, const void *bytes, size_t size)
{
    imp_saved saved = {0};
    scene->message[0] = '\0';
    impact_status status = read_all(scene, bytes, size, &saved);
    if (status == IMPACT_OK) {
        status = imp_saved_restore(&saved, scene);
        scene->failed = status < 0;
    }
    imp_saved_release(&saved, scene->world.arena);
    return status;
}

impact_status impact_scene_load(impact_scene *scene, const void *bytes, size_t size)
{
    const imp_floats floats = imp_floats_hold();
    const impact_status status = explained(scene, load(scene, bytes, size));
    imp_floats_give_back(&floats);
    return status;
}
