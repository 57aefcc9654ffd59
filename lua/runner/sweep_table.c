/* SPDX-License-Identifier: MIT
 *
 * All parts as one table, in the order of the runs. A run that stands in several (a process was thought dead) has the
 * same row in each, but for its CPU time.
 */
#include "sweep.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* A part's line: CPU time, run, status, message, parameters, name=value. */
enum { CPU, RUN, STATUS, MESSAGE, PARAMETERS };

/* The cell from text to the next tab; *text goes on behind it, NULL at the end. */
static impact_sweep_cell next_cell(const char **text, const char *end)
{
    const char *begin = *text, *tab = memchr(begin, '\t', (size_t)(end - begin));
    *text = tab ? tab + 1 : NULL;
    return (impact_sweep_cell){begin, (size_t)((tab ? tab : end) - begin)};
}

/* ---- columns ---- */

static impact_sweep_column *find_column(impact_sweep_table *table, const char *name, size_t size)
{
    for (int i = 0; i < table->column_count; i++) {
        impact_sweep_column *column = &table->columns[i];
        if (strncmp(column->name, name, size) == 0 && column->name[size] == 0) return column;
    }
    return NULL;
}

static bool add_column(impact_sweep_table *table, const char *name, size_t size, impact_sweep_kind kind)
{
    impact_sweep_column *more = realloc(table->columns, (size_t)(table->column_count + 1) * sizeof *more);
    if (more) table->columns = more;
    if (!more || size >= sizeof more->name) return false;
    impact_sweep_column *column = &more[table->column_count++];
    *column = (impact_sweep_column){.kind = kind};
    memcpy(column->name, name, size);
    return true;
}

static impact_sweep_kind kind_of(impact_sweep_cell cell)
{
    if (cell.size == 0 || cell.text[0] == '"') return IMPACT_SWEEP_STRING;
    if (cell.text[0] == 't' || cell.text[0] == 'f') return IMPACT_SWEEP_BOOLEAN;
    const size_t from = cell.text[0] == '-';
    for (size_t i = from; i < cell.size; i++)
        if (cell.text[i] < '0' || cell.text[i] > '9') return IMPACT_SWEEP_NUMBER;
    return IMPACT_SWEEP_INTEGER;
}

static bool is_numeric(impact_sweep_kind kind) { return kind == IMPACT_SWEEP_INTEGER || kind == IMPACT_SWEEP_NUMBER; }

static void widen(impact_sweep_column *column, impact_sweep_cell cell)
{
    const impact_sweep_kind kind = kind_of(cell);
    if (column->count++ == 0)
        column->kind = kind;
    else if (column->kind != kind)
        column->kind = is_numeric(kind) && is_numeric(column->kind) ? IMPACT_SWEEP_NUMBER : IMPACT_SWEEP_STRING;
    if (cell.size > column->longest) column->longest = cell.size;
}

/* Results that some run has not: whole numbers have no word for absent, NaN has. */
static void note_absent(impact_sweep_table *table)
{
    for (int i = 1 + table->parameter_count; i < table->column_count; i++) {
        impact_sweep_column *column = &table->columns[i];
        if (column->count < table->rows && column->kind == IMPACT_SWEEP_INTEGER) column->kind = IMPACT_SWEEP_NUMBER;
    }
}

/* Takes note of a line's cells: new results, kinds. */
static bool note_line(impact_sweep_table *table, const char *line, size_t size)
{
    const char *text = line;
    for (int place = 0; text; place++) {
        impact_sweep_cell cell = next_cell(&text, line + size);
        impact_sweep_column *column = NULL;
        if (place >= PARAMETERS && place < PARAMETERS + table->parameter_count) {
            column = &table->columns[1 + place - PARAMETERS];
        } else if (place >= PARAMETERS) {
            const char *sign = memchr(cell.text, '=', cell.size);
            if (!sign) return false;
            const size_t name = (size_t)(sign - cell.text);
            column = find_column(table, cell.text, name);
            if (!column && !add_column(table, cell.text, name, IMPACT_SWEEP_NUMBER)) return false;
            if (!column) column = &table->columns[table->column_count - 1];
            cell.text += name + 1, cell.size -= name + 1;
        }
        if (column) widen(column, cell);
        if ((place == STATUS || place == MESSAGE) && cell.size > table->longest_words[place - STATUS])
            table->longest_words[place - STATUS] = cell.size;
    }
    return true;
}

static int by_column_name(const void *a, const void *b)
{
    return strcmp(((const impact_sweep_column *)a)->name, ((const impact_sweep_column *)b)->name);
}

/* ---- the table ---- */

static long run_of(const char *line, size_t size)
{
    const char *text = line;
    next_cell(&text, line + size);
    return text ? strtol(text, NULL, 10) : -1;
}

static bool same_sweep(const impact_sweep_id *a, const impact_sweep_id *b)
{
    return a->hash == b->hash && a->runs == b->runs && strcmp(a->parameters, b->parameters) == 0;
}

static bool add_parameters(impact_sweep_table *table, const char *names)
{
    while (*names) {
        const size_t size = strcspn(names, ",");
        if (!add_column(table, names, size, IMPACT_SWEEP_NUMBER)) return false;
        table->parameter_count++;
        names += size + (names[size] == ',');
    }
    return true;
}

static bool take_lines(impact_sweep_table *table, const impact_sweep_part *part)
{
    size_t at = 0, size;
    for (const char *line; (line = impact_sweep_next_line(part, &at, &size));) {
        const long run = run_of(line, size);
        if (run < 0 || run >= table->runs) return false;
        if (table->lines[run]) continue;
        table->lines[run] = line, table->sizes[run] = size;
        if (!note_line(table, line, size)) return false;
    }
    return true;
}

/* Rows that are there move up. */
static void close_ranks(impact_sweep_table *table)
{
    for (long run = 0; run < table->runs; run++) {
        if (!table->lines[run]) continue;
        table->lines[table->rows] = table->lines[run];
        table->sizes[table->rows++] = table->sizes[run];
    }
}

bool impact_sweep_gather(const impact_sweep_part *parts, int count, const impact_sweep_id *id,
                         impact_sweep_table *table, char *message, size_t size)
{
    *table = (impact_sweep_table){.runs = id->runs};
    table->lines = calloc((size_t)id->runs, sizeof *table->lines);
    table->sizes = calloc((size_t)id->runs, sizeof *table->sizes);
    bool good = table->lines && table->sizes && add_column(table, "run", 3, IMPACT_SWEEP_INTEGER) &&
                add_parameters(table, id->parameters);
    snprintf(message, size, good ? "a row of '%s' is damaged" : "not enough memory for '%s'", id->name);
    for (int i = 0; good && i < count; i++) {
        if (strcmp(parts[i].id.name, id->name) != 0) continue;
        good = same_sweep(&parts[i].id, id);
        if (!good)
            snprintf(message, size,
                     "the folder holds rows of another sweep '%s': script, arguments or version differ; take another "
                     "folder, or remove its %s.*.rows",
                     id->name, id->name);
        good = good && take_lines(table, &parts[i]);
    }
    if (!good) return impact_sweep_free_table(table), false;
    const int before = 1 + table->parameter_count;
    if (table->column_count > before)
        qsort(table->columns + before, (size_t)(table->column_count - before), sizeof *table->columns, by_column_name);
    close_ranks(table);
    note_absent(table);
    good = add_column(table, "status", 6, IMPACT_SWEEP_STRING) &&
           add_column(table, "message", 7, IMPACT_SWEEP_STRING) && add_column(table, "cpu", 3, IMPACT_SWEEP_NUMBER);
    for (int i = 0; good && i < 2; i++) table->columns[table->column_count - 3 + i].longest = table->longest_words[i];
    if (!good) snprintf(message, size, "not enough memory for '%s'", id->name), impact_sweep_free_table(table);
    return good;
}

void impact_sweep_free_table(impact_sweep_table *table)
{
    free(table->columns);
    free(table->lines);
    free(table->sizes);
    *table = (impact_sweep_table){0};
}
