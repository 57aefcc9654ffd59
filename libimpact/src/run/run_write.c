/* SPDX-License-Identifier: MIT
 *
 * A line of JSON, padded with blanks to a multiple of 8 bytes, then tables of little-endian doubles, then the sum of
 * all that. Keys come as the motion makes them and are put body by body when the record is made up.
 */
#include "run/run.h"
#include "base/definition.h"
#include "run/rows.h"
#include "run/text.h"
#include "scene/scene_internal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Before a key's row stands whose it is. */
struct impact_run_writer {
    const impact_scene *scene;
    imp_rows tables[IMP_RUN_TABLES];
    imp_text phases;
    int phase_count;
    imp_text record; /* made up last */
};

static int lead_of(int table) { return table == IMP_RUN_KEYS; }

static bool add_row(impact_run_writer *w, int table, const double *values)
{
    return imp_rows_add(&w->tables[table], w->scene->world.arena, values);
}

/* ---- the recorder ---- */

static bool put_key(void *context, const impact_key *k)
{
    double values[1 + IMP_KEY_COLUMNS] = {k->body};
    imp_run_key_row(k, values + 1);
    return add_row(context, IMP_RUN_KEYS, values);
}

/* The number of these words among all phases, which stand one after another, each with its 0. */
static int phase_number(impact_run_writer *w, const char *words)
{
    int number = 0;
    for (size_t at = 0; at < w->phases.size; at += strlen(w->phases.bytes + at) + 1, number++)
        if (strcmp(w->phases.bytes + at, words) == 0) return number;
    imp_text_put(&w->phases, words, strlen(words) + 1);
    return w->phase_count++;
}

static int force_number(const impact_scene *scene, const impact_event *e)
{
    if (e->kind != IMPACT_EVENT_FORCE) return -1;
    for (int i = 0; impact_scene_force_name(scene, i); i++)
        if (strcmp(impact_scene_force_name(scene, i), e->name2) == 0) return i;
    return -1;
}

static bool put_event(void *context, const impact_event *e)
{
    impact_run_writer *w = context;
    const double values[IMP_EVENT_COLUMNS] = {e->t,
                                              e->kind,
                                              e->body1,
                                              e->body2,
                                              force_number(w->scene, e),
                                              e->point.x,
                                              e->point.y,
                                              e->point.z,
                                              e->normal.x,
                                              e->normal.y,
                                              e->normal.z,
                                              e->impulse.x,
                                              e->impulse.y,
                                              e->impulse.z,
                                              e->normal_before,
                                              e->normal_after,
                                              phase_number(w, e->phases),
                                              e->energy_before,
                                              e->energy_after};
    return add_row(w, IMP_RUN_EVENTS, values) && !w->phases.failed;
}

static bool put_held(void *context, const impact_held *c)
{
    const double values[IMP_CONTACT_COLUMNS] = {c->t,       c->body1,   c->body2,    c->mode,     c->point.x,
                                                c->point.y, c->point.z, c->normal.x, c->normal.y, c->normal.z,
                                                c->force.x, c->force.y, c->force.z};
    return add_row(context, IMP_RUN_CONTACTS, values);
}

static bool put_account(void *context, double t, const impact_energy *e)
{
    const double values[IMP_ACCOUNT_COLUMNS] = {
        t, e->kinetic, e->potential, e->force_work, e->drive_work, e->damping_loss, e->sliding_loss, e->impact_loss};
    return add_row(context, IMP_RUN_ACCOUNT, values);
}

impact_status impact_run_create(const impact_scene *scene, impact_run_writer **writer, char *message,
                                unsigned long message_size)
{
    imp_arena *arena = scene->world.arena;
    impact_run_writer *w = *writer = imp_arena_take(arena, 1, sizeof *w);
    if (!w) {
        if (message) imp_arena_explain(arena, message, message_size);
        return IMPACT_ENOMEM;
    }
    w->scene = scene;
    w->phases.arena = w->record.arena = arena;
    for (int i = 0; i < IMP_RUN_TABLES; i++) w->tables[i].width = lead_of(i) + imp_run_tables[i].columns;
    return IMPACT_OK;
}

void impact_run_fill_recorder(impact_run_writer *writer, impact_recorder *recorder, size_t struct_size)
{
    const impact_recorder own = {.struct_size = sizeof own,
                                 .context = writer,
                                 .event = put_event,
                                 .key = put_key,
                                 .held = put_held,
                                 .account = put_account};
    imp_definition_give(&own, sizeof own, recorder, struct_size);
}

void impact_run_discard(impact_run_writer *writer)
{
    if (!writer) return;
    for (int i = 0; i < IMP_RUN_TABLES; i++) imp_rows_free(&writer->tables[i], writer->scene->world.arena);
    imp_text_free(&writer->phases);
    imp_text_free(&writer->record);
    imp_arena_give(writer->scene->world.arena, writer);
}

/* ---- the head ---- */

static void say_key(imp_text *head, const char *key)
{
    imp_text_say(head, ",");
    imp_text_string(head, key);
    imp_text_say(head, ":");
}

static void say_number(imp_text *head, const char *key, double value)
{
    say_key(head, key);
    imp_text_number(head, value);
}

static void say_list(imp_text *head, const double *values, int count)
{
    for (int i = 0; i < count; i++) {
        imp_text_say(head, i ? "," : "[");
        imp_text_number(head, values[i]);
    }
    imp_text_say(head, "]");
}

static void say_numbers(imp_text *head, const char *key, const double *values, int count)
{
    say_key(head, key);
    say_list(head, values, count);
}

static void say_vector(imp_text *head, const char *key, qvec3 v)
{
    say_numbers(head, key, (const double[]){v.x, v.y, v.z}, 3);
}

/* The corners, and for whoever draws it the faces. */
static void say_hull(imp_text *head, const impact_hull *hull)
{
    const impact_hull_info info = impact_hull_describe(hull);
    int vertex[IMPACT_HULL_POINTS];
    say_key(head, "vertices");
    for (int i = 0; i < info.vertices; i++) {
        const qvec3 v = impact_hull_vertex(hull, i);
        imp_text_say(head, i ? "," : "[");
        say_list(head, (const double[]){v.x, v.y, v.z}, 3);
    }
    imp_text_say(head, "]");
    say_key(head, "faces");
    for (int f = 0; f < info.faces; f++) {
        double number[IMPACT_HULL_POINTS];
        const int count = impact_hull_face(hull, f, vertex, NULL);
        for (int i = 0; i < count; i++) number[i] = vertex[i];
        imp_text_say(head, f ? "," : "[");
        say_list(head, number, count);
    }
    imp_text_say(head, "]");
}

static void say_body(imp_text *head, const impact_body_def *def, long first_key, long key_count)
{
    const impact_shape *s = &def->shape;
    const quat o = def->shape_orientation;
    imp_text_say(head, "{\"name\":");
    imp_text_string(head, def->name);
    say_key(head, "kind");
    imp_text_string(head, imp_run_shapes[s->kind]);
    say_numbers(head, "axes", (const double[]){s->a, s->b, s->c}, 3);
    say_numbers(head, "exponents", (const double[]){s->r, s->s, s->t}, 3);
    if (s->rounding > 0) say_number(head, "rounding", s->rounding);
    if (s->kind == IMPACT_CONE) say_number(head, "base", s->base);
    if (s->hull) say_hull(head, s->hull);
    if (qvec3_norm(def->shape_position) > 0) say_vector(head, "shape_position", def->shape_position);
    if (qvec3_norm(def->trail) > 0) say_vector(head, "trail", def->trail);
    if (o.x != 0 || o.y != 0 || o.z != 0)
        say_numbers(head, "shape_orientation", (const double[]){o.w, o.x, o.y, o.z}, 4);
    say_key(head, "static");
    imp_text_say(head, def->is_static ? "true" : "false");
    if (!def->is_static) {
        say_number(head, "mass", def->mass);
        say_vector(head, "moments", def->moments);
        say_number(head, "linear_damping", def->linear_damping);
        say_number(head, "angular_damping", def->angular_damping);
    } else if (qvec3_norm(def->velocity) > 0 || qvec3_norm(def->omega) > 0) {
        say_vector(head, "surface_velocity", def->velocity);
        say_vector(head, "surface_omega", def->omega);
    }
    say_number(head, "friction", def->friction);
    say_number(head, "restitution", def->restitution);
    if (def->torsional_friction > 0) say_number(head, "torsional_friction", def->torsional_friction);
    if (def->rolling_friction > 0) say_number(head, "rolling_friction", def->rolling_friction);
    say_numbers(head, "keys", (const double[]){(double)first_key, (double)key_count}, 2);
    imp_text_say(head, "}");
}

static void say_bodies(imp_text *head, const impact_run_writer *w, const long *first)
{
    const int count = impact_scene_body_count(w->scene);
    say_key(head, "bodies");
    for (int i = 0; i < count; i++) {
        impact_body_def def = impact_default_body_def();
        impact_scene_body_def(w->scene, i, &def);
        imp_text_say(head, i ? "," : "[");
        say_body(head, &def, first[i], first[i + 1] - first[i]);
    }
    imp_text_say(head, "]");
}

/* A list of words, the number-th given by word; NULL ends it. */
static void say_words(imp_text *head, const char *key, const char *(*word)(const void *, int), const void *context)
{
    say_key(head, key);
    imp_text_say(head, "[");
    for (int i = 0; word(context, i); i++) {
        if (i) imp_text_say(head, ",");
        imp_text_string(head, word(context, i));
    }
    imp_text_say(head, "]");
}

static const char *event_word(const void *context, int i)
{
    (void)context;
    return i <= IMPACT_EVENT_REST ? impact_event_name((impact_event_kind)i) : NULL;
}

static const char *form_word(const void *context, int i)
{
    (void)context;
    return i <= IMPACT_KEY_FREE ? impact_key_form_name((impact_key_form)i) : NULL;
}

static const char *hold_word(const void *context, int i)
{
    (void)context;
    return i <= IMPACT_HOLD_STICK ? impact_hold_name((impact_hold)i) : NULL;
}

static const char *force_word(const void *context, int i) { return impact_scene_force_name(context, i); }

static const char *phase_word(const void *context, int i)
{
    const impact_run_writer *w = context;
    size_t at = 0;
    if (i >= w->phase_count) return NULL;
    while (i-- > 0) at += strlen(w->phases.bytes + at) + 1;
    return w->phases.bytes + at;
}

static void say_usage(imp_text *head, const impact_scene *scene)
{
    const impact_usage usage = impact_scene_usage(scene);
    const char *name;
    long value;
    say_key(head, "usage");
    imp_text_say(head, "{");
    for (int i = 0; impact_usage_entry(&usage, i, &name, &value); i++) {
        if (i) imp_text_say(head, ",");
        imp_text_string(head, name);
        imp_text_say(head, ":");
        imp_text_number(head, (double)value);
    }
    imp_text_say(head, "}");
}

static const char *column_word(const void *context, int i)
{
    const imp_run_table *table = context;
    return i < table->columns ? table->column[i] : NULL;
}

static size_t row_size(int table) { return sizeof(double) * (size_t)imp_run_tables[table].columns; }

static size_t table_size(const impact_run_writer *w, int table)
{
    return row_size(table) * (size_t)w->tables[table].count;
}

static void say_tables(imp_text *head, const impact_run_writer *w)
{
    size_t at = 0;
    say_key(head, "tables");
    for (int i = 0; i < IMP_RUN_TABLES; i++) {
        const imp_run_table *table = &imp_run_tables[i];
        imp_text_say(head, i ? "," : "{");
        imp_text_string(head, table->name);
        imp_text_say(head, ":{\"at\":");
        imp_text_number(head, (double)at);
        say_number(head, "rows", (double)w->tables[i].count);
        say_words(head, "columns", column_word, table);
        imp_text_say(head, "}");
        at += table_size(w, i);
    }
    imp_text_say(head, "}");
}

static void say_head(imp_text *head, const impact_run_writer *w, const char *scene_name, const char *reason,
                     const long *first)
{
    const impact_scene *scene = w->scene;
    imp_text_say(head, "{\"format\":\"" IMP_RUN_FORMAT "\"");
    say_number(head, "version", IMP_RUN_VERSION);
    say_key(head, "name");
    imp_text_string(head, scene_name);
    say_number(head, "duration", impact_scene_time(scene));
    say_vector(head, "gravity", impact_scene_gravity(scene));
    say_number(head, "tolerance", impact_scene_key_tolerance(scene));
    say_key(head, "reason");
    imp_text_string(head, reason);
    say_bodies(head, w, first);
    say_words(head, "forms", form_word, NULL);
    say_words(head, "kinds", event_word, NULL);
    say_words(head, "modes", hold_word, NULL);
    say_words(head, "forces", force_word, scene);
    say_words(head, "phases", phase_word, w);
    say_usage(head, scene);
    say_tables(head, w);
    imp_text_say(head, "}");
    while (!head->failed && head->size % IMP_RUN_ALIGNMENT != IMP_RUN_ALIGNMENT - 1) imp_text_say(head, " ");
    imp_text_say(head, "\n");
}

/* ---- the record ---- */

/* first[i]: the place of body i's first key when keys stand body by body. */
static void count_keys(const impact_run_writer *w, long *first)
{
    const imp_rows *keys = &w->tables[IMP_RUN_KEYS];
    const int count = impact_scene_body_count(w->scene);
    memset(first, 0, sizeof *first * ((size_t)count + 2));
    imp_rows_cursor at = {keys->first, 0};
    for (const double *row; (row = imp_rows_next(keys, &at));) first[(int)row[0] + 2]++;
    for (int i = 2; i < count + 2; i++) first[i] += first[i - 1];
}

/* Keys to their places; place[i] begins as first[i], and ends as first[i + 1]. */
static void put_keys(const impact_run_writer *w, long *place, char *out)
{
    const imp_rows *keys = &w->tables[IMP_RUN_KEYS];
    const size_t size = row_size(IMP_RUN_KEYS);
    imp_rows_cursor at = {keys->first, 0};
    for (const double *row; (row = imp_rows_next(keys, &at));)
        memcpy(out + (size_t)place[(int)row[0]]++ * size, row + 1, size);
}

/* A held contact's row is told when one that differs follows: rows of several contacts come out of order. */
typedef struct place {
    const double *row;
    long number;
} place;

static int in_order(const void *a, const void *b)
{
    const place *x = a, *y = b;
    if (x->row[0] != y->row[0]) return x->row[0] > y->row[0] ? 1 : -1;
    return (x->number > y->number) - (x->number < y->number);
}

static bool put_contacts(const impact_run_writer *w, char *out)
{
    imp_arena *arena = w->scene->world.arena;
    const imp_rows *contacts = &w->tables[IMP_RUN_CONTACTS];
    const size_t size = row_size(IMP_RUN_CONTACTS), count = (size_t)contacts->count;
    place *places = imp_arena_take(arena, count, sizeof *places);
    if (!places) return false;
    imp_rows_cursor at = {contacts->first, 0};
    for (size_t k = 0; k < count; k++) places[k] = (place){imp_rows_next(contacts, &at), (long)k};
    qsort(places, count, sizeof *places, in_order);
    for (size_t k = 0; k < count; k++) memcpy(out + k * size, places[k].row, size);
    imp_arena_give(arena, places);
    return true;
}

static void put_rows(const impact_run_writer *w, int table, char *out)
{
    const size_t size = row_size(table);
    for (const imp_rows_piece *p = w->tables[table].first; p; p = p->next) {
        memcpy(out, p->values, (size_t)p->used * size);
        out += (size_t)p->used * size;
    }
}

/* All tables behind the head, keys and contacts in the record's order. */
static bool put_tables(const impact_run_writer *w, imp_text *all, long *first)
{
    size_t size = 0;
    for (int i = 0; i < IMP_RUN_TABLES; i++) size += table_size(w, i);
    char *out = imp_text_room(all, size);
    bool whole = out != NULL;
    for (int i = 0; whole && i < IMP_RUN_TABLES; out += table_size(w, i++)) {
        if (i == IMP_RUN_KEYS)
            put_keys(w, first + 1, out);
        else if (i == IMP_RUN_CONTACTS)
            whole = put_contacts(w, out);
        else
            put_rows(w, i, out);
    }
    return whole;
}

impact_status impact_run_bytes(impact_run_writer *w, const char *reason, const void **bytes, size_t *size)
{
    imp_arena *arena = w->scene->world.arena;
    imp_text_free(&w->record);
    *bytes = NULL;
    long *first = imp_arena_take(arena, (size_t)impact_scene_body_count(w->scene) + 2, sizeof *first);
    if (!first) return IMPACT_ENOMEM;
    count_keys(w, first);
    say_head(&w->record, w, impact_scene_name(w->scene), reason, first + 1);
    const bool whole = put_tables(w, &w->record, first);
    imp_arena_give(arena, first);
    imp_run_seal(&w->record);
    if (!whole || w->record.failed) return imp_text_free(&w->record), IMPACT_ENOMEM;
    *bytes = w->record.bytes;
    *size = w->record.size;
    return IMPACT_OK;
}

impact_status impact_run_save(impact_run_writer *w, const char *reason, const char *path, impact_quota *quota,
                              char *message, unsigned long message_size)
{
    const void *bytes;
    size_t size;
    imp_arena *arena = w->scene->world.arena;
    const impact_status status = impact_run_bytes(w, reason, &bytes, &size);
    if (status == IMPACT_OK) return imp_file_save(arena, path, bytes, size, quota, message, message_size);
    if (message) imp_arena_explain(arena, message, message_size);
    return status;
}
