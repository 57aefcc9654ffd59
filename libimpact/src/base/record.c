/* SPDX-License-Identifier: MIT */
#include <impact/record.h>

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
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

/* A file that stands under "PATH.part" until it is whole. */
typedef struct part_file {
    FILE *file;
    char *path, *part;
} part_file;

struct impact_csv {
    part_file samples, events;
};

static void explain(char *message, size_t size, const char *path, const char *what)
{
    if (message && size > 0) snprintf(message, size, "%s: %s: %s", path, what, strerror(errno));
}

static bool open_part(part_file *f, const char *path, const char *header)
{
    if (!path) return true;
    const size_t length = strlen(path);
    f->path = malloc(length + 1);
    f->part = malloc(length + sizeof ".part");
    if (!f->path || !f->part) return false;
    memcpy(f->path, path, length + 1);
    memcpy(f->part, path, length);
    memcpy(f->part + length, ".part", sizeof ".part");
    f->file = fopen(f->part, "wb");
    return f->file && fputs(header, f->file) >= 0;
}

static void discard(part_file *f)
{
    if (f->file) {
        fclose(f->file);
        remove(f->part);
    }
    free(f->path);
    free(f->part);
    *f = (part_file){0};
}

/* Flushes and closes; the partial file is gone when that fails. */
static bool finish(part_file *f)
{
    if (!f->file) return true;
    const bool good = fflush(f->file) == 0 && !ferror(f->file);
    const bool closed = fclose(f->file) == 0;
    f->file = NULL;
    if (good && closed) return true;
    remove(f->part);
    return false;
}

static bool give_name(const part_file *f) { return !f->path || rename(f->part, f->path) == 0; }

impact_status impact_csv_open(const char *samples_path, const char *events_path, impact_csv **out, char *message,
                              unsigned long message_size)
{
    *out = NULL;
    if (samples_path && events_path && strcmp(samples_path, events_path) == 0) {
        if (message) snprintf(message, message_size, "%s: samples and events need a file each", samples_path);
        return IMPACT_EARGUMENT;
    }
    impact_csv *csv = calloc(1, sizeof *csv);
    if (!csv) return IMPACT_ENOMEM;
    const bool samples = open_part(&csv->samples, samples_path, "t,body,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n");
    if (!samples) explain(message, message_size, samples_path, "cannot be written");
    const bool events =
        samples && open_part(&csv->events, events_path,
                             "t,event,body1,body2,px,py,pz,nx,ny,nz,impulse_n,impulse_t,un_before,un_after,phases,"
                             "energy_before,energy_after\n");
    if (samples && !events) explain(message, message_size, events_path, "cannot be written");
    if (!events) {
        impact_csv_close(csv, false, NULL, 0);
        return IMPACT_ESINK;
    }
    *out = csv;
    return IMPACT_OK;
}

/* A number with the digits that give back the same bits, '.' whatever the locale; adding 0 turns -0 into 0. */
static bool put_number(FILE *file, double value, char end)
{
    char text[32];
    snprintf(text, sizeof text, "%.17g", value + 0.0);
    char *point = text + strspn(text, "+-0123456789einfa");
    const size_t size = strcspn(point, "0123456789e"); /* of the locale's decimal point, which may be several bytes */
    if (size > 0) {
        memmove(point + 1, point + size, strlen(point + size) + 1);
        *point = '.';
    }
    return fputs(text, file) >= 0 && putc(end, file) != EOF;
}

static bool put_numbers(FILE *file, const double *values, int count, char end)
{
    for (int i = 0; i < count; i++)
        if (!put_number(file, values[i], i + 1 < count ? ',' : end)) return false;
    return true;
}

/* A word, quoted when it holds what CSV would trip over (RFC 4180). */
static bool put_word(FILE *file, const char *word)
{
    if (!strpbrk(word, ",\"\r\n")) return fputs(word, file) >= 0 && putc(',', file) != EOF;
    putc('"', file);
    for (; *word; word++) {
        if (*word == '"') putc('"', file);
        putc(*word, file);
    }
    return putc('"', file) != EOF && putc(',', file) != EOF;
}

static bool put_sample(void *context, const impact_sample *s)
{
    FILE *file = ((impact_csv *)context)->samples.file;
    if (!file) return true;
    const double values[] = {s->position.x,    s->position.y,    s->position.z, s->orientation.w, s->orientation.x,
                             s->orientation.y, s->orientation.z, s->velocity.x, s->velocity.y,    s->velocity.z,
                             s->omega.x,       s->omega.y,       s->omega.z};
    return put_number(file, s->t, ',') && put_word(file, s->name) &&
           put_numbers(file, values, sizeof values / sizeof *values, '\n');
}

static bool put_event(void *context, const impact_event *e)
{
    FILE *file = ((impact_csv *)context)->events.file;
    if (!file) return true;
    const double values[] = {e->point.x,       e->point.y,     e->point.z,        e->normal.x,
                             e->normal.y,      e->normal.z,    e->impulse_normal, e->impulse_tangential,
                             e->normal_before, e->normal_after};
    return put_number(file, e->t, ',') && put_word(file, impact_event_name(e->kind)) && put_word(file, e->name1) &&
           put_word(file, e->name2) && put_numbers(file, values, sizeof values / sizeof *values, ',') &&
           put_word(file, e->phases) && put_number(file, e->energy_before, ',') &&
           put_number(file, e->energy_after, '\n');
}

impact_recorder impact_csv_recorder(impact_csv *csv)
{
    return (impact_recorder){.context = csv, .sample = put_sample, .event = put_event};
}

impact_status impact_csv_close(impact_csv *csv, bool keep, char *message, unsigned long message_size)
{
    if (!csv) return IMPACT_OK;
    impact_status status = IMPACT_OK;
    part_file *files[2] = {&csv->samples, &csv->events};
    for (int i = 0; keep && i < 2; i++)
        if (!finish(files[i])) {
            explain(message, message_size, files[i]->path, "cannot be finished");
            status = IMPACT_ESINK;
        }
    for (int i = 0; keep && status == IMPACT_OK && i < 2; i++)
        if (!give_name(files[i])) {
            explain(message, message_size, files[i]->path, "cannot be given its name");
            status = IMPACT_ESINK;
        }
    for (int i = 0; i < 2; i++) {
        if (status != IMPACT_OK && !files[i]->file && files[i]->part) remove(files[i]->part);
        discard(files[i]);
    }
    free(csv);
    return status;
}
