/* SPDX-License-Identifier: MIT
 *
 * Opening a record: every offset, count, index and number in it is checked here, so that nothing that asks an open one
 * has to.
 */
#include "base/number.h"
#include "run/run_open.h"
#include "base/tolerances.h"
#include "run/text.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

typedef struct reader {
    impact_run *run;
    const char *name; /* of the file, for messages */
    char *message;
    unsigned long message_size;
} reader;

__attribute__((format(printf, 2, 3))) static impact_status refuse(const reader *r, const char *format, ...)
{
    char words[200];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(words, sizeof words, format, arguments);
    va_end(arguments);
    if (r->message && r->message_size > 0) snprintf(r->message, r->message_size, "'%s': %s", r->name, words);
    return IMPACT_EARGUMENT;
}

static impact_status out_of_memory(const reader *r)
{
    char words[160];
    imp_arena_explain(r->run->arena, words, sizeof words);
    refuse(r, "%s", words);
    return IMPACT_ENOMEM;
}

/* ---- the head ---- */

/* The line of JSON; *data is where the tables begin. */
static impact_status read_head(const reader *r, size_t *data)
{
    static const char start[] = "{\"format\":\"" IMP_RUN_FORMAT "\"";
    impact_run *run = r->run;
    const bool begins = run->size >= sizeof start && memcmp(run->bytes, start, sizeof start - 1) == 0;
    const char *end = begins ? memchr(run->bytes, '\n', run->size) : NULL;
    if (!end) return refuse(r, "not a recorded run");
    *data = (size_t)(end - run->bytes) + 1;
    bool good = true;
    const impact_status status = imp_json_read(run->arena, run->bytes, *data, &run->head);
    if (status == IMPACT_ENOMEM) return out_of_memory(r);
    if (status < 0) return refuse(r, "its first line is not JSON");
    const double version = imp_json_number(run->head, "version", 0, &good);
    if (!good || !(version >= 1)) return refuse(r, "not a recorded run: it has no version");
    if (version > IMP_RUN_VERSION)
        return refuse(r, "version %.0f is newer than this program (%d)", version, IMP_RUN_VERSION);
    return IMPACT_OK;
}

static const char *string_of(const imp_json *object, const char *key)
{
    const imp_json *string = imp_json_get(object, key, IMP_JSON_STRING);
    return string ? string->string : NULL;
}

/* Reads count numbers; false when the list is there and is no list of so many. An absent one leaves them as they are.
 */
static bool numbers_of(const imp_json *object, const char *key, double *values, int count, double for_null)
{
    const imp_json *list = imp_json_get(object, key, IMP_JSON_ARRAY);
    if (!list) {
        bool good = true;
        imp_json_number(object, key, 0, &good);
        return good;
    }
    if (list->count != count) return false;
    for (const imp_json *item = list->first; item; item = item->next) {
        if (item->kind != IMP_JSON_NUMBER && item->kind != IMP_JSON_NULL) return false;
        *values++ = item->kind == IMP_JSON_NUMBER ? item->number : for_null;
    }
    return true;
}

static bool vector_of(const imp_json *object, const char *key, qvec3 *v)
{
    double values[3] = {v->x, v->y, v->z};
    if (!numbers_of(object, key, values, 3, NAN)) return false;
    *v = (qvec3){values[0], values[1], values[2]};
    return isfinite(v->x + v->y + v->z);
}

static impact_status words_of(const reader *r, const char *key, imp_words *words)
{
    const imp_json *list = imp_json_get(r->run->head, key, IMP_JSON_ARRAY);
    if (!list) return refuse(r, "it has no list '%s'", key);
    words->word = imp_arena_take(r->run->arena, (size_t)list->count + 1, sizeof *words->word);
    if (!words->word) return out_of_memory(r);
    for (const imp_json *item = list->first; item; item = item->next) {
        if (item->kind != IMP_JSON_STRING) return refuse(r, "list '%s' holds what is no string", key);
        words->word[words->count++] = item->string;
    }
    return IMPACT_OK;
}

/* ---- tables ---- */

/* A whole number up to most; -1 where it is none. */
static double whole(const imp_json *object, const char *key, double most)
{
    bool good = true;
    const double value = imp_json_number(object, key, -1, &good);
    return good && value >= 0 && value <= most && value == floor(value) ? value : -1;
}

static impact_status read_table(const reader *r, int number, size_t data)
{
    const imp_run_table *table = &imp_run_tables[number];
    const impact_run *run = r->run;
    imp_run_place *place = &r->run->tables[number];
    const imp_json *tables = imp_json_get(run->head, "tables", IMP_JSON_OBJECT);
    const imp_json *entry = imp_json_get(tables, table->name, IMP_JSON_OBJECT);
    const imp_json *columns = imp_json_get(entry, "columns", IMP_JSON_ARRAY);
    const double most = 9007199254740992; /* 2^53: whole numbers end there */
    if (!columns) return refuse(r, "it has no table '%s'", table->name);
    const double at = whole(entry, "at", most), rows = whole(entry, "rows", most);
    if (at < 0 || rows < 0 || fmod(at, IMP_RUN_ALIGNMENT) != 0)
        return refuse(r, "table '%s': its place is damaged", table->name);
    const double left = (double)(run->size - data) - at, bytes = rows * columns->count * (double)sizeof(double);
    if (bytes > 0 && bytes > left)
        return refuse(r, "cut short: %.0f of %.0f bytes of table '%s'", fmax(left, 0), bytes, table->name);
    *place = (imp_run_place){.at = bytes > 0 ? run->bytes + data + (size_t)at : run->bytes,
                             .rows = columns->count > 0 ? (long)rows : 0,
                             .width = columns->count};
    for (int c = 0; c < table->columns; c++) {
        int where = 0;
        place->column[c] = -1;
        for (const imp_json *item = columns->first; item; item = item->next, where++)
            if (item->kind == IMP_JSON_STRING && strcmp(item->string, table->column[c]) == 0) place->column[c] = where;
        if (place->column[c] < 0 && place->rows > 0)
            return refuse(r, "table '%s' has no column '%s'", table->name, table->column[c]);
    }
    return IMPACT_OK;
}

/* Every number within bounds, t rising. */
static impact_status check_rows(const reader *r, int table, long first, long count)
{
    double before = -INFINITY, values[IMP_RUN_MOST_COLUMNS];
    for (long row = first; row < first + count; row++) {
        imp_run_row(r->run, table, row, values);
        for (int c = 0; c < imp_run_tables[table].columns; c++)
            if (!(fabs(values[c]) <= IMP_RUN_LARGEST))
                return refuse(r, "table '%s', row %ld: %s is not a number that a run can have",
                              imp_run_tables[table].name, row, imp_run_tables[table].column[c]);
        if (values[0] < before)
            return refuse(r, "table '%s', row %ld: t = %s comes after %s", imp_run_tables[table].name, row,
                          imp_number_of(values[0]).text, imp_number_of(before).text);
        before = values[0];
    }
    return IMPACT_OK;
}

/* ---- bodies ---- */

/* The hull of a polyhedron's corners, in whose frame they stand. */
static impact_status read_hull(const reader *r, const imp_json *body, imp_run_body *out, char *why, size_t size)
{
    const imp_json *list = imp_json_get(body, "vertices", IMP_JSON_ARRAY);
    impact_shape *shape = &out->def.shape;
    qvec3 points[IMPACT_HULL_POINTS];
    size_t count = 0;
    if (!list || list->count > IMPACT_HULL_POINTS) return IMPACT_EARGUMENT;
    for (const imp_json *item = list->first; item; item = item->next) {
        const imp_json *number = item->kind == IMP_JSON_ARRAY && item->count == 3 ? item->first : NULL;
        double x[3];
        for (int k = 0; k < 3; k++, number = number->next) {
            if (!number || number->kind != IMP_JSON_NUMBER) return IMPACT_EARGUMENT;
            x[k] = number->number;
        }
        points[count++] = (qvec3){x[0], x[1], x[2]};
    }
    const impact_status status =
        impact_hull_create(points, count, shape->rounding, &r->run->allocator, &out->hull, why, size);
    return status < 0 ? status : impact_shape_polyhedron(out->hull, shape);
}

static impact_status read_shape(const reader *r, const imp_json *body, imp_run_body *out, char *why, size_t size)
{
    impact_shape *shape = &out->def.shape;
    const char *kind = string_of(body, "kind");
    double axes[3] = {0, 0, 0}, exponents[3] = {2, 2, 2};
    int k = 0;
    snprintf(why, size, "its shape is damaged");
    while (kind && k < IMPACT_SHAPE_KINDS && strcmp(kind, imp_run_shapes[k]) != 0) k++;
    if (!kind || k == IMPACT_SHAPE_KINDS) return IMPACT_EARGUMENT;
    if (!numbers_of(body, "axes", axes, 3, INFINITY) || !numbers_of(body, "exponents", exponents, 3, INFINITY))
        return IMPACT_EARGUMENT;
    *shape = (impact_shape){.kind = (impact_shape_kind)k,
                            .a = axes[0],
                            .b = axes[1],
                            .c = axes[2],
                            .r = exponents[0],
                            .s = exponents[1],
                            .t = exponents[2]};
    bool good = true;
    shape->rounding = imp_json_number(body, "rounding", 0, &good);
    shape->base = imp_json_number(body, "base", 0, &good);
    if (!good) return IMPACT_EARGUMENT;
    return k == IMPACT_POLYHEDRON ? read_hull(r, body, out, why, size) : impact_shape_check(shape, why, size);
}

static bool read_numbers(const imp_json *body, impact_body_def *def)
{
    const imp_json *is_static = imp_json_get(body, "static", IMP_JSON_TRUE);
    double turn[4] = {1, 0, 0, 0};
    bool good = true;
    def->is_static = is_static != NULL;
    def->mass = def->is_static ? INFINITY : imp_json_number(body, "mass", NAN, &good);
    def->friction = imp_json_number(body, "friction", 0, &good);
    def->restitution = imp_json_number(body, "restitution", 0, &good);
    def->torsional_friction = imp_json_number(body, "torsional_friction", 0, &good);
    def->rolling_friction = imp_json_number(body, "rolling_friction", 0, &good);
    def->linear_damping = imp_json_number(body, "linear_damping", 0, &good);
    def->angular_damping = imp_json_number(body, "angular_damping", 0, &good);
    def->moments = def->shape_position = def->trail = def->velocity = def->omega = (qvec3){0, 0, 0};
    good = good && (def->is_static || (def->mass > 0 && vector_of(body, "moments", &def->moments)));
    good = good && vector_of(body, "shape_position", &def->shape_position) && vector_of(body, "trail", &def->trail);
    good = good && def->linear_damping >= 0 && def->linear_damping < 1;
    good = good && def->angular_damping >= 0 && def->angular_damping < 1;
    good = good && numbers_of(body, "shape_orientation", turn, 4, NAN);
    good = good && vector_of(body, "surface_velocity", &def->velocity) && vector_of(body, "surface_omega", &def->omega);
    def->shape_orientation = (quat){turn[0], turn[1], turn[2], turn[3]};
    return good && fabs(quat_norm(def->shape_orientation) - 1) <= IMP_RUN_UNIT;
}

static impact_status read_body(const reader *r, const imp_json *body, imp_run_body *out)
{
    char why[120];
    double keys[2] = {-1, -1};
    impact_body_def *def = &out->def;
    *def = impact_default_body_def();
    def->name = string_of(body, "name");
    if (!def->name) return refuse(r, "a body has no name");
    const impact_status shaped = read_shape(r, body, out, why, sizeof why);
    if (shaped == IMPACT_ENOMEM) return out_of_memory(r);
    if (shaped < 0) return refuse(r, "body '%.80s': %s", def->name, why);
    if (!read_numbers(body, def)) return refuse(r, "body '%.80s': its numbers are damaged", def->name);
    out->flight = (imp_body){.is_static = def->is_static,
                             .linear_rate = -log1p(-def->linear_damping),
                             .angular_rate = -log1p(-def->angular_damping)};
    if (!def->is_static) imp_body_give_moments(&out->flight, def->moments);
    const double rows = (double)r->run->tables[IMP_RUN_KEYS].rows;
    if (!numbers_of(body, "keys", keys, 2, NAN) || !(keys[0] >= 0) || !(keys[1] >= 1) || keys[0] + keys[1] > rows ||
        keys[0] != floor(keys[0]) || keys[1] != floor(keys[1]))
        return refuse(r, "body '%.80s': its keys are not in the table", def->name);
    out->first = (long)keys[0], out->count = (long)keys[1];
    return IMPACT_OK;
}

static impact_status check_keys(const reader *r, int body)
{
    impact_run *run = r->run;
    imp_run_body *b = &run->bodies[body];
    const impact_status status = check_rows(r, IMP_RUN_KEYS, b->first, b->count);
    if (status != IMPACT_OK) return status;
    for (long k = 0; k < b->count; k++) {
        if (!imp_run_key_is_sound(run, body, k))
            return refuse(r, "table 'keys', row %ld: its form is damaged", b->first + k);
        const impact_key key = imp_run_key(run, body, k);
        if (fabs(quat_norm(key.orientation) - 1) > IMP_RUN_UNIT)
            return refuse(r, "body '%.80s', t = %s: its orientation is not a unit", b->def.name,
                          imp_number_of(key.t).text);
    }
    const impact_key first = imp_run_key(run, body, 0), last = imp_run_key(run, body, b->count - 1);
    b->def.position = first.position;
    b->def.orientation = first.orientation;
    if (!b->def.is_static) b->def.velocity = first.velocity, b->def.omega = first.omega;
    run->begin = fmin(run->begin, first.t);
    run->end = fmax(run->end, last.t);
    return IMPACT_OK;
}

static impact_status read_bodies(const reader *r)
{
    impact_run *run = r->run;
    const imp_json *list = imp_json_get(run->head, "bodies", IMP_JSON_ARRAY);
    if (!list || list->count == 0) return refuse(r, "it has no bodies");
    run->bodies = imp_arena_take(run->arena, (size_t)list->count, sizeof *run->bodies);
    if (!run->bodies) return out_of_memory(r);
    run->begin = INFINITY, run->end = -INFINITY;
    for (const imp_json *body = list->first; body; body = body->next) {
        impact_status status = read_body(r, body, &run->bodies[run->body_count]);
        if (status == IMPACT_OK) status = check_keys(r, run->body_count);
        run->body_count++; /* one that is refused has a hull to give back */
        if (status != IMPACT_OK) return status;
    }
    return IMPACT_OK;
}

/* ---- indices in rows ---- */

static bool is_index(double value, double least, int count)
{
    return value >= least && value < count && value == floor(value);
}

static impact_status check_events(const reader *r)
{
    const impact_run *run = r->run;
    impact_status status = check_rows(r, IMP_RUN_EVENTS, 0, run->tables[IMP_RUN_EVENTS].rows);
    for (long row = 0; status == IMPACT_OK && row < run->tables[IMP_RUN_EVENTS].rows; row++) {
        double v[IMP_EVENT_COLUMNS];
        imp_run_row(run, IMP_RUN_EVENTS, row, v);
        if (!is_index(v[1], 0, run->kinds.count) || !is_index(v[2], 0, run->body_count) ||
            !is_index(v[3], -1, run->body_count) || !is_index(v[4], -1, run->forces.count) ||
            !is_index(v[16], 0, run->phases.count))
            status = refuse(r, "table 'events', row %ld: it points at what is not there", row);
    }
    return status;
}

static impact_status check_contacts(const reader *r)
{
    const impact_run *run = r->run;
    impact_status status = check_rows(r, IMP_RUN_CONTACTS, 0, run->tables[IMP_RUN_CONTACTS].rows);
    for (long row = 0; status == IMPACT_OK && row < run->tables[IMP_RUN_CONTACTS].rows; row++) {
        double v[IMP_CONTACT_COLUMNS];
        imp_run_row(run, IMP_RUN_CONTACTS, row, v);
        if (!is_index(v[1], 0, run->body_count) || !is_index(v[2], 0, run->body_count) ||
            !is_index(v[3], 0, run->modes.count))
            status = refuse(r, "table 'contacts', row %ld: it points at what is not there", row);
    }
    return status;
}

/* ---- opening ---- */

static impact_status read_run(const reader *r)
{
    impact_run *run = r->run;
    size_t data = 0;
    bool good = true;
    impact_status status = read_head(r, &data);
    for (int i = 0; status == IMPACT_OK && i < IMP_RUN_TABLES; i++) status = read_table(r, i, data);
    if (status == IMPACT_OK && !imp_run_is_sealed(run->bytes, run->size))
        status = refuse(r, "damaged: its bytes do not give the sum that it ends with");
    if (status == IMPACT_OK) status = words_of(r, "kinds", &run->kinds);
    if (status == IMPACT_OK) status = words_of(r, "modes", &run->modes);
    if (status == IMPACT_OK) status = words_of(r, "forces", &run->forces);
    if (status == IMPACT_OK) status = words_of(r, "phases", &run->phases);
    if (status == IMPACT_OK) status = read_bodies(r);
    if (status == IMPACT_OK) status = check_events(r);
    if (status == IMPACT_OK) status = check_contacts(r);
    if (status == IMPACT_OK) status = check_rows(r, IMP_RUN_ACCOUNT, 0, run->tables[IMP_RUN_ACCOUNT].rows);
    if (status != IMPACT_OK) return status;
    run->name = string_of(run->head, "name");
    run->reason = string_of(run->head, "reason");
    run->tolerance = imp_json_number(run->head, "tolerance", 0, &good);
    if (!run->name || !run->reason || !good || !vector_of(run->head, "gravity", &run->gravity))
        return refuse(r, "its name, reason, tolerance or gravity is damaged");
    return IMPACT_OK;
}

/* A run with nothing in it but its arena. */
static impact_status begin(const impact_allocator *allocator, const char *name, impact_run **run, char *message,
                           unsigned long message_size)
{
    imp_arena *arena;
    if (message && message_size > 0) message[0] = '\0';
    impact_status status = imp_arena_create(allocator, &arena);
    *run = status < 0 ? NULL : imp_arena_take(arena, 1, sizeof **run);
    if (*run) {
        (*run)->arena = arena;
        if (allocator) (*run)->allocator = *allocator;
        return IMPACT_OK;
    }
    if (status == IMPACT_OK) status = IMPACT_ENOMEM, imp_arena_destroy(arena);
    if (message && message_size > 0) snprintf(message, message_size, "'%s': %s", name, impact_status_string(status));
    return status;
}

/* A run that cannot be read is closed. */
static impact_status ended(impact_status status, impact_run **run)
{
    if (status == IMPACT_OK) return status;
    impact_run_close(*run);
    *run = NULL;
    return status;
}

impact_status impact_run_read(const void *bytes, size_t size, const char *name, const impact_allocator *allocator,
                              impact_run **run, char *message, unsigned long message_size)
{
    const impact_status begun = begin(allocator, name, run, message, message_size);
    if (begun < 0) return begun;
    const reader r = {*run, name, message, message_size};
    (*run)->bytes = imp_arena_take_unset((*run)->arena, size, 1);
    (*run)->size = size;
    if (!(*run)->bytes) return ended(out_of_memory(&r), run);
    if (size > 0) memcpy((*run)->bytes, bytes, size);
    return ended(read_run(&r), run);
}

/* All of a file, into the run. IMPACT_ESINK with errno. */
static impact_status read_file(const char *path, impact_run *run)
{
    FILE *file = fopen(path, "rb");
    imp_text text = {.arena = run->arena};
    char some[4096];
    bool good = file != NULL;
    while (good && !text.failed && !feof(file)) {
        const size_t got = fread(some, 1, sizeof some, file);
        imp_text_put(&text, some, got);
        good = !ferror(file);
    }
    if (file) fclose(file);
    run->bytes = text.bytes;
    run->size = text.size;
    return !good ? IMPACT_ESINK : text.failed ? IMPACT_ENOMEM : IMPACT_OK;
}

impact_status impact_run_open(const char *path, const impact_allocator *allocator, impact_run **run, char *message,
                              unsigned long message_size)
{
    const impact_status begun = begin(allocator, path, run, message, message_size);
    if (begun < 0) return begun;
    const reader r = {*run, path, message, message_size};
    errno = 0;
    const impact_status got = read_file(path, *run);
    if (got == IMPACT_ESINK) refuse(&r, "%s", strerror(errno));
    if (got == IMPACT_ENOMEM) out_of_memory(&r);
    return ended(got < 0 ? got : read_run(&r), run);
}

void impact_run_close(impact_run *run)
{
    if (!run) return;
    for (int i = 0; i < run->body_count; i++) impact_hull_destroy(run->bodies[i].hull);
    imp_arena_destroy(run->arena);
}
