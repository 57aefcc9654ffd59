/* SPDX-License-Identifier: MIT
 *
 * impact sweep SCRIPT: does what is to do, then puts the rows together when all are there. impact gather DIR: puts
 * together what is there.
 */
#define _GNU_SOURCE
#include "sweep.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- the script ---- */

static bool read_script(const char *path, char **text, size_t *size, char *message, size_t message_size)
{
    FILE *file = fopen(path, "rb");
    impact_sweep_block read = {0};
    char piece[4096];
    size_t got = 0;
    bool good = file != NULL;
    while (good && (got = fread(piece, 1, sizeof piece, file)) > 0) good = impact_sweep_add(&read, piece, got);
    good = good && !ferror(file) && impact_sweep_add(&read, "", 1);
    if (!good) snprintf(message, message_size, "cannot open %s: %s", path, strerror(errno));
    if (file) fclose(file);
    *text = read.text, *size = good ? read.size - 1 : 0;
    return good;
}

/* As luaL_loadfile: a first line that begins with # is the shell's. */
static const char *without_shebang(const char *script, size_t *size)
{
    if (*size == 0 || script[0] != '#') return script;
    const char *end = memchr(script, '\n', *size);
    *size = end ? *size - (size_t)(end - script) : 0;
    return end ? end : "";
}

void impact_sweep_load(lua_State *L, impact_runner *runner, const char *script, size_t size, bool first)
{
    impact_runner_open_libraries(L, runner);
    if (first)
        impact_runner_watch(L);
    else
        impact_runner_watch_thread(L);
    impact_runner_set_arguments(L, runner);
    script = without_shebang(script, &size);
    lua_pushfstring(L, "@%s", runner->script);
    if (luaL_loadbufferx(L, script, size, lua_tostring(L, -1), runner->trust ? NULL : "t") != LUA_OK) lua_error(L);
    if (first && !runner->trust && !runner->mpi) runner->unfenced = impact_runner_fence(runner);
    if (runner->unfenced && runner->fence) luaL_error(L, "not fenced: %s", runner->unfenced);
    lua_call(L, 0, 1);
    const bool named = luaL_getmetafield(L, -1, "__name") == LUA_TSTRING;
    const bool good = named && strcmp(lua_tostring(L, -1), "impact.sweep") == 0;
    if (named) lua_pop(L, 1);
    if (!good)
        luaL_error(L, "%s: a sweep needs a script that returns impact.sweep{...}; this one returned a %s",
                   runner->script, luaL_typename(L, -1));
    char name[200];
    impact_runner_base_name(runner, name, sizeof name);
    lua_getfield(L, -1, "definition");
    if (lua_getfield(L, -1, "name") == LUA_TSTRING) snprintf(name, sizeof name, "%s", lua_tostring(L, -1));
    lua_pop(L, 2);
    if (!impact_runner_is_plain(name))
        luaL_error(L, "%s: the sweep's name '%s' names the files: it must be plain, without '/'", runner->script, name);
    lua_pushstring(L, name);
    lua_setfield(L, -2, "name");
}

/* The sweep at index says which it is. */
static void read_id(lua_State *L, int index, impact_sweep *sweep)
{
    impact_sweep_id *id = &sweep->id;
    const impact_runner *runner = sweep->runner;
    const char *version = impact_version();
    uint64_t hash = impact_sweep_hash(0, version, strlen(version));
    hash = impact_sweep_hash(hash, sweep->script, sweep->script_size);
    for (int i = 0; runner->arguments && runner->arguments[i]; i++)
        hash = impact_sweep_hash(hash, runner->arguments[i], strlen(runner->arguments[i]) + 1);
    id->hash = hash;
    lua_getfield(L, index, "name");
    snprintf(id->name, sizeof id->name, "%s", lua_tostring(L, -1));
    lua_getfield(L, index, "runs");
    id->runs = (long)luaL_checkinteger(L, -1);
    lua_getfield(L, index, "names");
    lua_pushvalue(L, index);
    lua_call(L, 1, 1);
    size_t size = 0;
    id->parameters[0] = 0;
    for (lua_Integer i = 1; lua_rawgeti(L, -1, i) == LUA_TSTRING; i++, lua_pop(L, 1)) {
        size += (size_t)snprintf(id->parameters + size, sizeof id->parameters - size, "%s%s", i > 1 ? "," : "",
                                 lua_tostring(L, -1));
        if (size >= sizeof id->parameters) luaL_error(L, "sweep: the parameters' names are too long");
    }
    lua_settop(L, index);
}

/* ---- what is to do ---- */

/* The runs of this shard that no part has; false with the sweep's message. */
static bool list_todo(impact_sweep *sweep)
{
    const impact_runner *runner = sweep->runner;
    impact_sweep_part *parts;
    impact_sweep_table table;
    const int count =
        impact_sweep_read_parts(sweep->runner, sweep->id.name, &parts, sweep->message, sizeof sweep->message);
    if (count < 0) return false;
    bool good = impact_sweep_gather(parts, count, &sweep->id, &table, sweep->message, sizeof sweep->message);
    if (good) sweep->todo = malloc((size_t)sweep->id.runs * sizeof *sweep->todo);
    long row = 0;
    for (long run = 0; good && sweep->todo && run < sweep->id.runs; run++) {
        const char *tab = row < table.rows ? strchr(table.lines[row], '\t') : NULL;
        if (tab && strtol(tab + 1, NULL, 10) == run)
            row++;
        else if (run % runner->shards == runner->shard)
            sweep->todo[sweep->todo_count++] = (int32_t)run;
    }
    if (good) impact_sweep_free_table(&table);
    impact_sweep_free_parts(parts, count);
    return good && sweep->todo;
}

/* ---- the rows, together ---- */

typedef struct tally {
    long failed, first;
    char message[200];
} tally;

/* Failed runs: their status is the third cell of a part's line, their message the fourth. */
static tally count_failed(const impact_sweep_table *table)
{
    tally result = {.first = -1};
    for (long row = 0; row < table->rows; row++) {
        const char *run = strchr(table->lines[row], '\t') + 1, *status = strchr(run, '\t') + 1;
        if (strncmp(status, "error\t", 6) != 0 && strncmp(status, "failed\t", 7) != 0) continue;
        if (result.failed++ > 0) continue;
        const char *message = strchr(status, '\t') + 1;
        result.first = strtol(run, NULL, 10);
        snprintf(result.message, sizeof result.message, "%.*s", (int)strcspn(message, "\t\n"), message);
    }
    return result;
}

static void tell_table(const impact_runner *runner, const impact_sweep_table *table, const char *name,
                       const tally *failed, bool drawn)
{
    const char *part = table->rows < table->runs ? ".partial" : "", *folder = runner->directory;
    printf("%s: %ld of %ld runs, %ld failed", name, table->rows, table->runs, failed->failed);
    if (failed->failed > 0) printf("; the first is run %ld: %s", failed->first, failed->message);
    printf("\n  wrote      %s/%s%s.csv, %s/%s_times%s.csv", folder, name, part, folder, name, part);
    if (runner->hdf5) printf(", %s/%s%s.h5", folder, name, part);
    if (drawn) printf(", %s/%s.png", folder, name);
    putchar('\n');
    if (runner->unfenced) printf("  not fenced %s\n", runner->unfenced);
}

/* Draws what the definition's plot makes of the table; the sweep is at index. An exit code. */
static int draw_table(lua_State *L, int index, impact_runner *runner, const impact_sweep_table *table, const char *name,
                      bool *drawn)
{
    char message[400] = "";
    lua_getfield(L, index, "figure");
    lua_pushvalue(L, index);
    impact_sweep_push_table(L, table);
    lua_call(L, 2, 1);
    if (lua_isnil(L, -1)) return IMPACT_EXIT_OK;
    const impact_draw_result result = impact_runner_draw(L, lua_gettop(L), runner, name, message, sizeof message);
    *drawn = result == IMPACT_DRAWN;
    if (*drawn) return IMPACT_EXIT_OK;
    fprintf(stderr, "impact: no picture of '%s': %s\n", name, message);
    return result == IMPACT_DRAW_NO_GNUPLOT ? IMPACT_EXIT_OK
                                            : (result == IMPACT_DRAW_REFUSED ? IMPACT_EXIT_SCRIPT : IMPACT_EXIT_OUTPUT);
}

/* Writes the table of an id's parts; with a state also its picture, when all rows are there. An exit code. */
static int put_together(impact_runner *runner, const impact_sweep_part *parts, int count, const impact_sweep_id *id,
                        const impact_sweep_hdf5 *hdf5, lua_State *L, int index)
{
    impact_sweep_table table;
    char message[400] = "";
    bool drawn = false;
    if (!impact_sweep_gather(parts, count, id, &table, message, sizeof message))
        return impact_runner_complain(runner, IMPACT_EXIT_OUTPUT, message);
    int code = IMPACT_EXIT_OK;
    const bool whole = table.rows == table.runs;
    const tally failed = count_failed(&table);
    if (!impact_sweep_write(runner, &table, id->name, hdf5, message, sizeof message))
        code = impact_runner_complain_limits(runner, IMPACT_EXIT_OUTPUT, message);
    if (code == IMPACT_EXIT_OK && L && whole) code = draw_table(L, index, runner, &table, id->name, &drawn);
    if (code == IMPACT_EXIT_OK && !runner->quiet) tell_table(runner, &table, id->name, &failed, drawn);
    if (code == IMPACT_EXIT_OK && failed.failed == table.rows && whole)
        code = impact_runner_complain(runner, IMPACT_EXIT_RUN, "every run of the sweep failed");
    if (code == IMPACT_EXIT_OK && !whole && !L) {
        snprintf(message, sizeof message, "'%s' has %ld of %ld runs; the rest is to do", id->name, table.rows,
                 table.runs);
        code = impact_runner_complain(runner, IMPACT_EXIT_RUN, message);
    }
    impact_sweep_free_table(&table);
    return code;
}

static const impact_sweep_hdf5 *load_hdf5(impact_runner *runner, int *code)
{
    char message[400];
    if (!runner->hdf5) return NULL;
    const impact_sweep_hdf5 *hdf5 =
        impact_runner_extra("sweep_hdf5", "impact_sweep_hdf5_writer", message, sizeof message);
    if (!hdf5) *code = impact_runner_complain(runner, IMPACT_EXIT_USAGE, message);
    return hdf5;
}

int impact_runner_gather(impact_runner *runner)
{
    impact_sweep_part *parts = NULL;
    char message[400];
    int code = IMPACT_EXIT_OK;
    const impact_sweep_hdf5 *hdf5 = load_hdf5(runner, &code);
    if (code != IMPACT_EXIT_OK) return code;
    runner->directory = runner->script;
    if (access(runner->directory, F_OK) != 0) {
        snprintf(message, sizeof message, "no folder '%s'", runner->directory);
        return impact_runner_complain(runner, IMPACT_EXIT_USAGE, message);
    }
    const int count = impact_runner_open_folder(runner, message, sizeof message)
                          ? impact_sweep_read_parts(runner, NULL, &parts, message, sizeof message)
                          : -1;
    if (count == 0) snprintf(message, sizeof message, "no rows of a sweep in '%s'", runner->directory);
    if (count <= 0) return impact_runner_complain(runner, IMPACT_EXIT_OUTPUT, message);
    for (int i = 0; i < count; i++) {
        if (i > 0 && strcmp(parts[i].id.name, parts[i - 1].id.name) == 0) continue;
        const int one = put_together(runner, parts, count, &parts[i].id, hdf5, NULL, 0);
        if (code == IMPACT_EXIT_OK) code = one;
    }
    impact_sweep_free_parts(parts, count);
    return code;
}

/* ---- the sweep ---- */

/* Says why it did not come to its end, and how far it came. */
static int complain_early(impact_sweep *sweep, int code)
{
    impact_runner *runner = sweep->runner;
    snprintf(runner->early, sizeof runner->early, "; %ld of %ld runs done here, the same command goes on",
             atomic_load(&sweep->done), sweep->todo_count);
    return impact_runner_complain_limits(runner, code, sweep->message);
}

/* When every run is there, whoever did it: the table, by rank 0. */
static int finish(lua_State *L, int index, impact_sweep *sweep, const impact_sweep_hdf5 *hdf5)
{
    impact_runner *runner = sweep->runner;
    impact_sweep_part *parts;
    impact_sweep_table table;
    char message[400];
    const int count = impact_sweep_read_parts(runner, sweep->id.name, &parts, message, sizeof message);
    if (count < 0) return impact_runner_complain(runner, IMPACT_EXIT_OUTPUT, message);
    int code = IMPACT_EXIT_OK;
    if (!impact_sweep_gather(parts, count, &sweep->id, &table, message, sizeof message)) {
        code = impact_runner_complain(runner, IMPACT_EXIT_OUTPUT, message);
    } else {
        const bool whole = table.rows == table.runs;
        if (!whole && !runner->quiet)
            printf("%s: %ld runs done here; %ld of %ld are in %s: impact gather %s\n", sweep->id.name,
                   atomic_load(&sweep->done), table.rows, table.runs, runner->directory, runner->directory);
        impact_sweep_free_table(&table);
        if (whole) code = put_together(runner, parts, count, &sweep->id, hdf5, L, index);
    }
    impact_sweep_free_parts(parts, count);
    return code;
}

/* About 64 takes a thread: few enough to cost nothing, small enough that all end together. */
static long grain_of(long todo, long workers)
{
    const long grain = todo / (64 * workers);
    return grain < 1 ? 1 : grain > 64 ? 64 : grain;
}

static int do_runs(impact_sweep *sweep)
{
    impact_runner *runner = sweep->runner;
    sweep->grain = grain_of(sweep->todo_count, (long)runner->threads * sweep->rank_count);
    if (sweep->ranks) sweep->ranks->open_counter(); /* all have read the parts before any writes */
    if (sweep->todo_count == 0) return IMPACT_EXIT_OK;
    sweep->part = impact_sweep_new_part(runner, &sweep->id, sweep->message, sizeof sweep->message);
    if (sweep->part < 0) return IMPACT_EXIT_OUTPUT;
    const long threads = runner->threads < sweep->todo_count ? runner->threads : sweep->todo_count;
    int code = impact_sweep_work(sweep, (int)threads);
    if (close(sweep->part) != 0 && code == IMPACT_EXIT_OK) code = IMPACT_EXIT_OUTPUT;
    return code;
}

/* Protected: (sweep) -> exit code */
static int run_sweep(lua_State *L)
{
    impact_sweep *sweep = lua_touserdata(L, 1);
    impact_runner *runner = sweep->runner;
    int code = IMPACT_EXIT_OK;
    const impact_sweep_hdf5 *hdf5 = load_hdf5(runner, &code);
    if (code == IMPACT_EXIT_OK && !impact_runner_open_folder(runner, sweep->message, sizeof sweep->message))
        code = impact_runner_complain(runner, IMPACT_EXIT_OUTPUT, sweep->message);
    if (code != IMPACT_EXIT_OK) return lua_pushinteger(L, code), 1;
    impact_runner_start_clock(runner);
    impact_sweep_load(L, runner, sweep->script, sweep->script_size, true);
    const int index = lua_gettop(L);
    read_id(L, index, sweep);
    if (!list_todo(sweep)) {
        code = impact_runner_complain(runner, IMPACT_EXIT_OUTPUT, sweep->message);
        return lua_pushinteger(L, code), 1;
    }
    code = do_runs(sweep);
    if (sweep->ranks) sweep->ranks->meet();
    if (code != IMPACT_EXIT_OK || impact_runner_signal() || impact_runner_time_is_over())
        code = complain_early(sweep, code != IMPACT_EXIT_OK ? code : IMPACT_EXIT_RUN);
    else if (sweep->rank == 0)
        code = finish(L, index, sweep, hdf5);
    return lua_pushinteger(L, code), 1;
}

/* Ranks begin before the fence and the threads. An exit code. */
static int begin_ranks(impact_sweep *sweep)
{
    impact_runner *runner = sweep->runner;
    char message[400];
    sweep->rank_count = 1;
    if (!runner->mpi) return IMPACT_EXIT_OK;
    const impact_sweep_ranks *ranks = impact_runner_extra("sweep_mpi", "impact_sweep_mpi", message, sizeof message);
    const char *wrong = ranks ? ranks->begin(&sweep->rank, &sweep->rank_count) : message;
    if (wrong) return impact_runner_complain(runner, IMPACT_EXIT_USAGE, wrong);
    sweep->ranks = ranks;
    runner->unfenced = "MPI reaches other processes";
    return IMPACT_EXIT_OK;
}

int impact_runner_sweep(impact_runner *runner)
{
    impact_sweep sweep = {.runner = runner, .part = -1};
    char *script = NULL;
    int code = begin_ranks(&sweep);
    if (code != IMPACT_EXIT_OK) return code;
    pthread_mutex_init(&sweep.gate, NULL);
    pthread_cond_init(&sweep.end, NULL);
    const bool read = read_script(runner->script, &script, &sweep.script_size, sweep.message, sizeof sweep.message);
    sweep.script = script;
    lua_State *L = read ? lua_newstate(impact_runner_allocate, runner) : NULL;
    if (!L) {
        code = impact_runner_complain(runner, IMPACT_EXIT_SCRIPT, read ? "not enough memory" : sweep.message);
    } else {
        lua_pushcfunction(L, run_sweep);
        lua_pushlightuserdata(L, &sweep);
        if (lua_pcall(L, 1, 1, 0) == LUA_OK)
            code = (int)lua_tointeger(L, -1);
        else
            code = impact_runner_complain_limits(runner, IMPACT_EXIT_SCRIPT, lua_tostring(L, -1));
        lua_close(L);
    }
    free(sweep.todo);
    free(script);
    pthread_cond_destroy(&sweep.end);
    pthread_mutex_destroy(&sweep.gate);
    if (sweep.ranks) sweep.ranks->end(code);
    return code;
}
