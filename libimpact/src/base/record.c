/* SPDX-License-Identifier: MIT */
#include "base/definition.h"
#include "base/digits.h"
#include "base/out_file.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

const char *impact_event_name(impact_event_kind kind)
{
    switch (kind) {
    case IMPACT_EVENT_IMPACT: return "impact";
    case IMPACT_EVENT_CONTACT: return "contact";
    case IMPACT_EVENT_SLIP: return "slip";
    case IMPACT_EVENT_STICK: return "stick";
    case IMPACT_EVENT_LIFTOFF: return "liftoff";
    case IMPACT_EVENT_FORCE: return "force";
    case IMPACT_EVENT_REST: return "rest";
    }
    return "unknown";
}

const char *impact_key_form_name(impact_key_form form)
{
    switch (form) {
    case IMPACT_KEY_QUINTIC: return "quintic";
    case IMPACT_KEY_STEADY: return "steady";
    case IMPACT_KEY_FREE: return "free";
    }
    return "unknown";
}

const char *impact_hold_name(impact_hold mode)
{
    switch (mode) {
    case IMPACT_HOLD_OPEN: return "open";
    case IMPACT_HOLD_SLIP: return "slip";
    case IMPACT_HOLD_STICK: return "stick";
    }
    return "unknown";
}

struct impact_csv {
    imp_arena *arena;
    imp_out_file samples, events;
    long rows[2];     /* of samples and events */
    char *partial[2]; /* names of what was not ended */
};

static void explain(char *message, size_t size, const char *path, const char *what)
{
    if (message && size > 0) snprintf(message, size, "%s: %s: %s", path, what, strerror(errno));
}

/* ---- rows ---- */

enum { MOST_NUMBERS = 13 }; /* beside each other in a row */

/* Numbers with the digits that give back the same bits; adding 0 turns -0 into 0. */
static bool put_numbers(imp_out_file *file, const double *values, int count, char end)
{
    char text[MOST_NUMBERS * IMP_DIGITS_ROOM], *at = text;
    for (int i = 0; i < count; i++) {
        at += imp_digits(values[i] + 0.0, at);
        *at++ = i + 1 < count ? ',' : end;
    }
    return imp_out_put(file, text, (size_t)(at - text));
}

static bool put_number(imp_out_file *file, double value, char end) { return put_numbers(file, &value, 1, end); }

/* A word, quoted when it holds what CSV would trip over (RFC 4180). What a spreadsheet would take for a formula gets an
 * apostrophe before it, and so does what begins with one: that can be undone. */
static bool put_word(imp_out_file *file, const char *word)
{
    const bool runs = word[0] && strchr("=+-@\t\r'", word[0]);
    if (!runs && !strpbrk(word, ",\"\r\n")) return imp_out_put(file, word, strlen(word)) && imp_out_put(file, ",", 1);
    bool good = imp_out_put(file, "\"'", runs ? 2 : 1);
    for (; good && *word; word++) good = imp_out_put(file, *word == '"' ? "\"\"" : word, *word == '"' ? 2 : 1);
    return good && imp_out_put(file, "\",", 2);
}

static bool put_sample(void *context, const impact_sample *s)
{
    impact_csv *csv = context;
    imp_out_file *file = &csv->samples;
    if (!file->file) return true;
    csv->rows[0]++;
    const double values[] = {s->position.x,    s->position.y,    s->position.z, s->orientation.w, s->orientation.x,
                             s->orientation.y, s->orientation.z, s->velocity.x, s->velocity.y,    s->velocity.z,
                             s->omega.x,       s->omega.y,       s->omega.z};
    return put_number(file, s->t, ',') && put_word(file, s->name) &&
           put_numbers(file, values, sizeof values / sizeof *values, '\n');
}

static bool put_event(void *context, const impact_event *e)
{
    impact_csv *csv = context;
    imp_out_file *file = &csv->events;
    if (!file->file) return true;
    csv->rows[1]++;
    const double values[] = {e->point.x,       e->point.y,     e->point.z,        e->normal.x,
                             e->normal.y,      e->normal.z,    e->impulse_normal, e->impulse_tangential,
                             e->normal_before, e->normal_after};
    return put_number(file, e->t, ',') && put_word(file, impact_event_name(e->kind)) && put_word(file, e->name1) &&
           put_word(file, e->name2) && put_numbers(file, values, sizeof values / sizeof *values, ',') &&
           put_word(file, e->phases) && put_number(file, (double)e->encounter, ',') &&
           put_number(file, e->energy_before, ',') && put_number(file, e->energy_after, '\n');
}

void impact_csv_fill_recorder(impact_csv *csv, impact_recorder *recorder, size_t struct_size)
{
    const impact_recorder own = {.struct_size = sizeof own, .context = csv, .sample = put_sample, .event = put_event};
    imp_definition_give(&own, sizeof own, recorder, struct_size);
}

/* ---- closing ---- */

static impact_status end_files(impact_csv *csv, impact_csv_fate fate, char *message, unsigned long size)
{
    imp_out_file *files[2] = {&csv->samples, &csv->events};
    const bool partial = fate == IMPACT_CSV_PARTIAL;
    for (int i = 0; i < 2; i++)
        if (!imp_out_finish(files[i], partial))
            return explain(message, size, files[i]->path, "cannot be finished"), IMPACT_ESINK;
    for (int i = 0; i < 2; i++)
        if (files[i]->path && !imp_out_give_name(files[i], partial ? csv->partial[i] : files[i]->path))
            return explain(message, size, files[i]->path, "cannot be given its name"), IMPACT_ESINK;
    for (int i = 0; !partial && i < 2; i++)
        if (csv->partial[i]) remove(csv->partial[i]); /* of a run before, that did not come so far */
    return IMPACT_OK;
}

impact_status impact_csv_close(impact_csv *csv, impact_csv_fate fate, char *message, unsigned long message_size)
{
    if (!csv) return IMPACT_OK;
    const bool keep = fate == IMPACT_CSV_KEEP || (fate == IMPACT_CSV_PARTIAL && impact_csv_rows(csv) > 0);
    const impact_status status = keep ? end_files(csv, fate, message, message_size) : IMPACT_OK;
    imp_out_close(&csv->samples);
    imp_out_close(&csv->events);
    imp_arena_destroy(csv->arena);
    return status;
}

/* ---- opening ---- */

/* "NAME.partial.csv" for "NAME.csv"; of another ending, "NAME.partial". */
static char *partial_name(imp_arena *arena, const char *path)
{
    const size_t length = strlen(path), stem = length > 4 && !strcmp(path + length - 4, ".csv") ? length - 4 : length;
    char *name = imp_arena_take(arena, length + sizeof ".partial", 1);
    if (name) sprintf(name, "%.*s.partial%s", (int)stem, path, path + stem);
    return name;
}

static bool open_one(impact_csv *csv, int which, const char *path, impact_quota *quota, const char *header)
{
    imp_out_file *f = which ? &csv->events : &csv->samples;
    if (!path) return true;
    csv->partial[which] = partial_name(csv->arena, path);
    if (!csv->partial[which]) return errno = ENOMEM, false;
    return imp_out_open(f, csv->arena, path, quota) && imp_out_put(f, header, strlen(header));
}

static impact_status open_both(impact_csv *csv, const impact_csv_def *def, char *message, unsigned long size)
{
    static const char samples[] = "t,body,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n";
    static const char events[] = "t,event,body1,body2,px,py,pz,nx,ny,nz,impulse_n,impulse_t,un_before,un_after,phases,"
                                 "encounter,energy_before,energy_after\n";
    if (!open_one(csv, 0, def->samples_path, def->quota, samples))
        return explain(message, size, def->samples_path, "cannot be written"), IMPACT_ESINK;
    if (!open_one(csv, 1, def->events_path, def->quota, events))
        return explain(message, size, def->events_path, "cannot be written"), IMPACT_ESINK;
    return IMPACT_OK;
}

static impact_status open_csv(const impact_csv_def *def, impact_csv **out, char *message, unsigned long message_size)
{
    imp_arena *arena;
    if (def->samples_path && def->events_path && strcmp(def->samples_path, def->events_path) == 0) {
        if (message) snprintf(message, message_size, "%s: samples and events need a file each", def->samples_path);
        return IMPACT_EARGUMENT;
    }
    impact_status status = imp_arena_create(def->allocator, &arena);
    if (status != IMPACT_OK) return status;
    impact_csv *csv = imp_arena_take(arena, 1, sizeof *csv);
    if (!csv) return imp_arena_destroy(arena), IMPACT_ENOMEM;
    *csv = (impact_csv){.arena = arena, .samples.descriptor = -1, .events.descriptor = -1};
    status = open_both(csv, def, message, message_size);
    if (status == IMPACT_OK)
        *out = csv;
    else
        impact_csv_close(csv, IMPACT_CSV_DROP, NULL, 0);
    return status;
}

impact_status impact_csv_open_with(const impact_csv_def *def, impact_csv **out, char *message,
                                   unsigned long message_size)
{
    impact_csv_def own = {.struct_size = sizeof own};
    const char *why = imp_definition_refusal(def, sizeof own);
    *out = NULL;
    if (why) {
        if (message) snprintf(message, message_size, "CSV: struct_size = %zu: %s", def->struct_size, why);
        return IMPACT_EARGUMENT;
    }
    imp_definition_take(def, &own, sizeof own);
    return open_csv(&own, out, message, message_size);
}

impact_status impact_csv_open(const char *samples_path, const char *events_path, impact_csv **csv, char *message,
                              unsigned long message_size)
{
    const impact_csv_def def = {.struct_size = sizeof def, .samples_path = samples_path, .events_path = events_path};
    return impact_csv_open_with(&def, csv, message, message_size);
}

long impact_csv_rows(const impact_csv *csv) { return csv->rows[0] + csv->rows[1]; }
