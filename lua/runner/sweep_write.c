/* SPDX-License-Identifier: MIT
 *
 * A table as CSV, as HDF5 by the module that can, and as columns for Lua.
 */
#define _GNU_SOURCE
#include "sweep.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- cells ---- */

static int find_result(const impact_sweep_table *table, const char *name, size_t size)
{
    for (int i = 1 + table->parameter_count; i < table->column_count - 3; i++) {
        const char *own = table->columns[i].name;
        if (strncmp(own, name, size) == 0 && own[size] == 0) return i;
    }
    return -1;
}

/* The place in the table of the cell at that place of the line; a result's cell loses its name. */
static int place_in_table(const impact_sweep_table *table, int place, impact_sweep_cell *cell)
{
    const int count = table->column_count;
    const int first[] = {count - 1, 0, count - 3, count - 2};
    if (place < 4) return first[place];
    if (place < 4 + table->parameter_count) return place - 3;
    const char *sign = memchr(cell->text, '=', cell->size);
    const size_t name = sign ? (size_t)(sign - cell->text) : 0;
    const int column = find_result(table, cell->text, name);
    cell->text += name + 1, cell->size -= name + 1;
    return column;
}

static void split_line(const impact_sweep_table *table, long row, impact_sweep_cell *cells)
{
    const char *text = table->lines[row], *end = text + table->sizes[row];
    memset(cells, 0, (size_t)table->column_count * sizeof *cells);
    for (int place = 0; text; place++) {
        const char *tab = memchr(text, '\t', (size_t)(end - text));
        impact_sweep_cell cell = {text, (size_t)((tab ? tab : end) - text)};
        const int column = place_in_table(table, place, &cell);
        if (column >= 0) cells[column] = cell;
        text = tab ? tab + 1 : NULL;
    }
}

static size_t plain_text(impact_sweep_cell cell, char *text)
{
    size_t count = 0, at = cell.size > 0 && cell.text[0] == '"';
    for (; at < cell.size; at++) {
        char letter = cell.text[at];
        if (letter == '\\' && at + 1 < cell.size) {
            const char next = cell.text[++at];
            letter = next == 't' ? '\t' : next == 'n' ? '\n' : next == 'r' ? '\r' : next == '0' ? '\0' : next;
        }
        text[count++] = letter;
    }
    return count;
}

/* ---- CSV ---- */

/* As the rows of scenes have their words: quoted where CSV would trip, with an apostrophe before what a spreadsheet
 * would run. */
static void put_text(FILE *file, const char *text, size_t size)
{
    const bool runs = size > 0 && memchr("=+-@\t\r'", text[0], 7) != NULL;
    bool quoted = runs;
    for (size_t i = 0; i < size; i++) quoted = quoted || (text[i] && strchr(",\"\r\n", text[i]));
    if (quoted) fputs(runs ? "\"'" : "\"", file);
    for (size_t i = 0; i < size; i++) {
        if (text[i] == '"') fputc('"', file);
        if (text[i]) fputc(text[i], file);
    }
    if (quoted) fputc('"', file);
}

static void put_cell(FILE *file, const impact_sweep_table *table, int column, impact_sweep_cell cell, char *room)
{
    const bool word = column >= table->column_count - 3 && column < table->column_count - 1;
    if (cell.text && (word || (cell.size > 0 && cell.text[0] == '"')))
        put_text(file, room, plain_text(cell, room));
    else if (cell.text)
        fwrite(cell.text, 1, cell.size, file);
}

static size_t longest_line(const impact_sweep_table *table)
{
    size_t longest = 0;
    for (long i = 0; i < table->rows; i++) longest = table->sizes[i] > longest ? table->sizes[i] : longest;
    return longest + 1;
}

/* times: run and cpu alone; else all but cpu. */
static bool put_csv(FILE *file, const impact_sweep_table *table, bool times)
{
    const int count = table->column_count;
    impact_sweep_cell *cells = malloc((size_t)count * sizeof *cells);
    char *room = malloc(longest_line(table));
    const bool good = cells && room;
    for (long row = -1; good && row < table->rows; row++) {
        bool first = true;
        if (row >= 0) split_line(table, row, cells);
        for (int i = 0; i < count; i++) {
            if (times ? i > 0 && i < count - 1 : i == count - 1) continue;
            if (!first) fputc(',', file);
            if (row < 0)
                fputs(table->columns[i].name, file);
            else
                put_cell(file, table, i, cells[i], room);
            first = false;
        }
        fputc('\n', file);
    }
    free(cells);
    free(room);
    return good && fflush(file) == 0 && !ferror(file);
}

static bool write_csv(impact_runner *runner, const impact_sweep_table *table, const char *name, bool times)
{
    bool nameless;
    const int file = impact_runner_new_file(runner, name, &nameless);
    FILE *stream = file >= 0 ? impact_runner_count_writes(runner, file, "w") : NULL;
    if (file >= 0 && !stream) close(file);
    if (!stream) return false;
    const bool whole = put_csv(stream, table, times);
    const bool named = impact_runner_finish_file(runner, file, nameless, name, whole);
    return fclose(stream) == 0 && whole && named;
}

static bool write_hdf5(impact_runner *runner, const impact_sweep_table *table, const char *name,
                       const impact_sweep_hdf5 *hdf5, char *message, size_t size)
{
    char part[300], path[4400];
    struct stat status;
    snprintf(part, sizeof part, "%s.part", name);
    snprintf(path, sizeof path, "%s/%s", runner->directory, part);
    unlinkat(runner->folder, part, 0);
    const char *wrong = hdf5->write(path, table, split_line, plain_text);
    if (!wrong && fstatat(runner->folder, part, &status, AT_SYMLINK_NOFOLLOW) == 0 &&
        impact_runner_spend(runner, (unsigned long long)status.st_size) &&
        renameat(runner->folder, part, runner->folder, name) == 0)
        return true;
    snprintf(message, size, "cannot write '%s/%s': %s", runner->directory, name, wrong ? wrong : strerror(errno));
    unlinkat(runner->folder, part, 0);
    return false;
}

bool impact_sweep_write(impact_runner *runner, const impact_sweep_table *table, const char *name,
                        const impact_sweep_hdf5 *hdf5, char *message, size_t size)
{
    static const char *const endings[] = {"", "_times"};
    const char *part = table->rows < table->runs ? ".partial" : "";
    char file[300];
    for (int times = 0; times < 2; times++) {
        snprintf(file, sizeof file, "%s%s%s.csv", name, endings[times], part);
        if (!write_csv(runner, table, file, times))
            return snprintf(message, size, "cannot write '%s/%s': %s", runner->directory, file, strerror(errno)), false;
        snprintf(file, sizeof file, "%s%s.partial.csv", name, endings[times]);
        if (!part[0]) unlinkat(runner->folder, file, 0);
    }
    snprintf(file, sizeof file, "%s%s.h5", name, part);
    return !hdf5 || write_hdf5(runner, table, file, hdf5, message, size);
}

/* ---- Lua ---- */

static void push_cell(lua_State *L, const impact_sweep_column *column, impact_sweep_cell cell, char *room)
{
    if (!cell.text)
        lua_pushnumber(L, NAN);
    else if (column->kind == IMPACT_SWEEP_BOOLEAN)
        lua_pushboolean(L, cell.text[0] == 't');
    else if (column->kind == IMPACT_SWEEP_STRING)
        lua_pushlstring(L, room, plain_text(cell, room));
    else if (column->kind == IMPACT_SWEEP_INTEGER)
        lua_pushinteger(L, strtoll(cell.text, NULL, 10));
    else
        lua_pushnumber(L, strtod(cell.text, NULL));
}

void impact_sweep_push_table(lua_State *L, const impact_sweep_table *table)
{
    const int count = table->column_count;
    const int place = lua_gettop(L) + 1;
    luaL_checkstack(L, count + 10, NULL);
    impact_sweep_cell *cells = lua_newuserdatauv(L, (size_t)count * sizeof *cells, 0);
    char *room = lua_newuserdatauv(L, longest_line(table), 0);
    lua_createtable(L, 0, count);
    const int result = lua_gettop(L);
    for (int i = 0; i < count; i++) {
        lua_createtable(L, (int)table->rows, 0);
        lua_pushvalue(L, -1);
        lua_setfield(L, result, table->columns[i].name);
    }
    for (long row = 0; row < table->rows; row++) {
        split_line(table, row, cells);
        for (int i = 0; i < count; i++) {
            push_cell(L, &table->columns[i], cells[i], room);
            lua_rawseti(L, result + 1 + i, row + 1);
        }
    }
    lua_settop(L, result);
    lua_replace(L, place);
    lua_settop(L, place);
}
