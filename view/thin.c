/* SPDX-License-Identifier: MIT
 *
 * Keys of closed forms stay. Of others the furthest is kept that the quintic from the last kept one reaches: there it
 * meets the record at every key between and in the middle of every interval, to three quarters of the tolerance. What
 * jumps stays two keys of one time. What is left of a number is what the last quarter needs: of a place so many metres
 * u, of a velocity u/h, of an acceleration u/h^2, h the longer of the intervals beside the key; the zeros behind it
 * leave with the deflation.
 */
#include "thin.h"
#include "base/tolerances.h"
#include "motion/key.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Parts of the tolerance: for what a polynomial is off by, and for the unit of a number, which five of them share. */
static const double part_of_way = 0.75, part_of_unit = 0.02;

/* What is left of a velocity, and of an acceleration, whatever its unit. */
static const double least_part = 0x1p-24;

typedef struct thinner {
    const impact_run *run;
    double place, angle; /* what the body's keys may be off by: m, rad */
    long *rows;          /* kept, of all bodies one after another, by their numbers in the table */
    long *first;         /* of each body in rows; one more */
} thinner;

/* ---- which keys ---- */

static bool meets_at(const thinner *t, const impact_key ends[2], const impact_key *wanted)
{
    const impact_key key = imp_key_between(ends, wanted->t);
    return qvec3_norm(qvec3_sub(key.position, wanted->position)) <= part_of_way * t->place &&
           2 * quat_norm(quat_sub(key.orientation, wanted->orientation)) <= part_of_way * t->angle;
}

static bool reaches(const thinner *t, int body, long from, long to)
{
    const impact_key ends[2] = {imp_run_key(t->run, body, from), imp_run_key(t->run, body, to)};
    impact_key pair[2] = {ends[0]};
    for (long k = from + 1; k <= to; k++) {
        if (pair[0].form != IMPACT_KEY_QUINTIC) return false;
        pair[1] = imp_run_key(t->run, body, k);
        const impact_key middle = imp_key_between(pair, 0.5 * (pair[0].t + pair[1].t));
        if (!meets_at(t, ends, &middle) || !meets_at(t, ends, &pair[1])) return false;
        pair[0] = pair[1];
    }
    return true;
}

static bool is_quintic(const thinner *t, int body, long key)
{
    return imp_run_key(t->run, body, key).form == IMPACT_KEY_QUINTIC;
}

/* By doubling, then by halving. */
static long furthest(const thinner *t, int body, long from)
{
    const long last = t->run->bodies[body].count - 1;
    if (t->angle == 0 || !is_quintic(t, body, from)) return from + 1;
    long good = from + 1, bad = last + 1;
    for (long step = 2; from + step <= last && bad > last; step *= 2)
        *(reaches(t, body, from, from + step) ? &good : &bad) = from + step;
    while (bad - good > 1) {
        const long middle = good + (bad - good) / 2;
        *(reaches(t, body, from, middle) ? &good : &bad) = middle;
    }
    return good;
}

static void set_body(thinner *t, int body, double tolerance)
{
    const impact_body_def *def = &t->run->bodies[body].def;
    const double size = impact_shape_bounding_radius(&def->shape) + qvec3_norm(def->shape_position);
    t->place = tolerance * size;
    t->angle = tolerance;
}

static void choose(thinner *t, double tolerance)
{
    long count = 0;
    for (int b = 0; b < t->run->body_count; b++) {
        const imp_run_body *body = &t->run->bodies[b];
        set_body(t, b, tolerance);
        t->first[b] = count;
        t->rows[count++] = body->first;
        for (long k = 0; k < body->count - 1;) t->rows[count++] = body->first + (k = furthest(t, b, k));
    }
    t->first[t->run->body_count] = count;
}

/* ---- shorter numbers ---- */

/* The nearest multiple of the greatest power of two up to unit. */
static double shorten(double value, double unit)
{
    int exponent;
    frexp(unit, &exponent);
    const double step = ldexp(1, exponent - 1);
    return unit > 0 && step > 0 && fabs(value) < step / DBL_EPSILON ? round(value / step) * step : value;
}

static void shorten_rates(double *v, double unit)
{
    for (int c = 0; c < 3; c++) v[c] = shorten(v[c], fmin(unit, least_part * fabs(v[c])));
}

static void shorten_key(double *v, double place, double angle, double h)
{
    for (int c = 1; c < 4; c++) v[c] = shorten(v[c], place);
    for (int c = 4; c < 8; c++) v[c] = shorten(v[c], angle);
    shorten_rates(v + 8, place / h);
    shorten_rates(v + 11, angle / h);
    shorten_rates(v + 14, place / (h * h));
    shorten_rates(v + 17, angle / (h * h));
}

static double time_of(const impact_run *run, long row)
{
    double v[IMP_KEY_COLUMNS];
    imp_run_row(run, IMP_RUN_KEYS, row, v);
    return v[0];
}

static void put_keys(imp_text *out, const thinner *t, int body)
{
    /* an orientation that is off by more than that is taken for none */
    const double place = part_of_unit * t->place, angle = fmin(part_of_unit * t->angle, part_of_unit * IMP_RUN_UNIT);
    for (long k = t->first[body]; k < t->first[body + 1]; k++) {
        double v[IMP_KEY_COLUMNS], h = 0;
        imp_run_row(t->run, IMP_RUN_KEYS, t->rows[k], v);
        if (k > t->first[body]) h = v[0] - time_of(t->run, t->rows[k - 1]);
        if (k + 1 < t->first[body + 1]) h = fmax(h, time_of(t->run, t->rows[k + 1]) - v[0]);
        if (h > 0 && angle > 0) shorten_key(v, place, angle, h);
        imp_text_put(out, v, sizeof v);
    }
}

/* ---- the head ---- */

static void say_key(imp_text *out, const char *key, bool first)
{
    if (!first) imp_text_say(out, ",");
    if (!key) return;
    imp_text_string(out, key);
    imp_text_say(out, ":");
}

static void say_value(imp_text *out, const imp_json *value)
{
    static const char *const words[] = {[IMP_JSON_NULL] = "null", [IMP_JSON_FALSE] = "false", [IMP_JSON_TRUE] = "true"};
    const bool object = value->kind == IMP_JSON_OBJECT;
    if (value->kind == IMP_JSON_NUMBER) {
        imp_text_number(out, value->number);
    } else if (value->kind == IMP_JSON_STRING) {
        imp_text_string(out, value->string);
    } else if (value->kind < IMP_JSON_NUMBER) {
        imp_text_say(out, words[value->kind]);
    } else {
        imp_text_say(out, object ? "{" : "[");
        for (const imp_json *member = value->first; member; member = member->next) {
            say_key(out, member->key, member == value->first);
            say_value(out, member);
        }
        imp_text_say(out, object ? "}" : "]");
    }
}

static void say_body(imp_text *out, const thinner *t, const imp_json *body, int number)
{
    imp_text_say(out, "{");
    for (const imp_json *member = body->first; member; member = member->next) {
        if (strcmp(member->key, "keys") == 0) continue;
        say_key(out, member->key, member == body->first);
        say_value(out, member);
    }
    say_key(out, "keys", false);
    imp_text_say(out, "[");
    imp_text_number(out, (double)t->first[number]);
    imp_text_say(out, ",");
    imp_text_number(out, (double)(t->first[number + 1] - t->first[number]));
    imp_text_say(out, "]}");
}

static long rows_of(const thinner *t, int table)
{
    return table == IMP_RUN_KEYS ? t->first[t->run->body_count] : t->run->tables[table].rows;
}

static void say_tables(imp_text *out, const thinner *t)
{
    size_t at = 0;
    for (int i = 0; i < IMP_RUN_TABLES; i++) {
        const imp_run_table *table = &imp_run_tables[i];
        imp_text_say(out, i ? "," : "{");
        imp_text_string(out, table->name);
        imp_text_say(out, ":{\"at\":");
        imp_text_number(out, (double)at);
        say_key(out, "rows", false);
        imp_text_number(out, (double)rows_of(t, i));
        say_key(out, "columns", false);
        for (int c = 0; c < table->columns; c++) {
            imp_text_say(out, c ? "," : "[");
            imp_text_string(out, table->column[c]);
        }
        imp_text_say(out, "]}");
        at += sizeof(double) * (size_t)rows_of(t, i) * (size_t)table->columns;
    }
    imp_text_say(out, "}");
}

static void say_head(imp_text *out, const thinner *t, double tolerance)
{
    const size_t from = out->size;
    imp_text_say(out, "{");
    for (const imp_json *member = t->run->head->first; member; member = member->next) {
        say_key(out, member->key, member == t->run->head->first);
        if (strcmp(member->key, "tables") == 0) {
            say_tables(out, t);
        } else if (strcmp(member->key, "bodies") == 0) {
            int number = 0;
            for (const imp_json *body = member->first; body; body = body->next) {
                imp_text_say(out, number ? "," : "[");
                say_body(out, t, body, number++);
            }
            imp_text_say(out, "]");
        } else {
            say_value(out, member);
        }
    }
    if (tolerance > 0) say_key(out, "thinned", false);
    if (tolerance > 0) imp_text_number(out, tolerance);
    imp_text_say(out, "}");
    while (!out->failed && (out->size - from) % IMP_RUN_ALIGNMENT != IMP_RUN_ALIGNMENT - 1) imp_text_say(out, " ");
    imp_text_say(out, "\n");
}

impact_status imp_thin(imp_text *out, const impact_run *run, double tolerance)
{
    imp_arena *arena = out->arena;
    const size_t keys = (size_t)run->tables[IMP_RUN_KEYS].rows, bodies = (size_t)run->body_count;
    thinner t = {.run = run,
                 .rows = imp_arena_take(arena, keys + 1, sizeof *t.rows),
                 .first = imp_arena_take(arena, bodies + 1, sizeof *t.first)};
    if (!t.rows || !t.first) return IMPACT_ENOMEM;
    choose(&t, tolerance);
    say_head(out, &t, tolerance);
    for (int b = 0; b < run->body_count; b++) {
        set_body(&t, b, tolerance);
        put_keys(out, &t, b);
    }
    for (int i = IMP_RUN_KEYS + 1; i < IMP_RUN_TABLES; i++)
        for (long row = 0; row < run->tables[i].rows; row++) {
            double v[IMP_RUN_MOST_COLUMNS];
            imp_run_row(run, i, row, v);
            imp_text_put(out, v, sizeof *v * (size_t)imp_run_tables[i].columns);
        }
    imp_run_seal(out);
    imp_arena_give(arena, t.rows);
    imp_arena_give(arena, t.first);
    return out->failed ? IMPACT_ENOMEM : IMPACT_OK;
}
