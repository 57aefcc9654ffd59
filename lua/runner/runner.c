/* SPDX-License-Identifier: MIT
 *
 * impact SCRIPT.lua: runs a scene script, writes its CSV files and its picture, and tells what happened.
 */
#define _XOPEN_SOURCE 700
#include "sweep.h"

#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- while it runs ---- */

static void clear_progress(impact_runner *runner)
{
    if (runner->progress_shown) fputs("\r\033[K", stderr);
    runner->progress_shown = false;
}

/* The host's progress function. */
static bool on_progress(void *context, double t, double t_end)
{
    impact_runner *runner = context;
    if (impact_runner_time_is_over() || impact_runner_signal()) return false;
    if (runner->quiet || !isatty(STDERR_FILENO)) return true;
    const double now = impact_runner_now();
    if (now - runner->started < 0.5 || now - runner->progress_at < 0.1) return true;
    runner->progress_at = now;
    runner->progress_shown = true;
    fprintf(stderr, "\r\033[Kt = %.4g of %.4g s, %.0f %%", t, t_end, 100 * t / t_end);
    fflush(stderr);
    return true;
}

static bool prepare(void *context, const char *name, char *message, size_t size)
{
    impact_runner *runner = context;
    runner->early[0] = 0;
    if (!impact_runner_open_folder(runner, message, size)) return false;
    impact_runner_guard(runner, name);
    return true;
}

static void on_early_end(void *context, double t, double t_end, const char *files)
{
    impact_runner *runner = context;
    snprintf(runner->early, sizeof runner->early, "; the run came to t = %.6g of %.6g s%s%s", t, t_end,
             files[0] ? ", its rows are in " : "", files);
}

/* The one line of an end that is not as it should be. */
int impact_runner_complain(impact_runner *runner, int code, const char *message)
{
    clear_progress(runner);
    fprintf(stderr, "impact: %s%s\n", message ? message : "unknown error", runner->early);
    return code;
}

/* What went wrong, in words: a limit that was reached, or else the code given. */
int impact_runner_complain_limits(impact_runner *runner, int code, const char *text)
{
    char message[120];
    const int end = impact_runner_signal();
    if (end) {
        snprintf(message, sizeof message, end == SIGINT ? "interrupted" : "ended by signal %d, %s", end,
                 strsignal(end));
        return impact_runner_complain(runner, IMPACT_EXIT_SIGNAL + end, message);
    }
    if (runner->quota.spent) {
        snprintf(message, sizeof message, "disk limit of %g MB reached", runner->max_disk_megabytes);
        return impact_runner_complain(runner, IMPACT_EXIT_LIMIT, message);
    }
    if (impact_runner_time_is_over()) {
        snprintf(message, sizeof message, "time limit of %g s reached", runner->max_time);
        return impact_runner_complain(runner, IMPACT_EXIT_LIMIT, message);
    }
    if (text && (strstr(text, "not enough memory") || strstr(text, "out of memory"))) {
        snprintf(message, sizeof message, "memory limit of %g MB reached", runner->max_megabytes);
        return impact_runner_complain(runner, IMPACT_EXIT_LIMIT,
                                      runner->memory_refused ? message : "not enough memory");
    }
    return impact_runner_complain(runner, code, text);
}

/* ---- a scene ---- */

void impact_runner_base_name(const impact_runner *runner, char *name, size_t size)
{
    const char *slash = strrchr(runner->script, '/');
    snprintf(name, size, "%s", slash ? slash + 1 : runner->script);
    char *dot = strrchr(name, '.');
    if (dot && dot != name) *dot = 0;
}

/* The name of the files: the definition's, else the script's own. */
static void choose_name(lua_State *L, int scene, const impact_runner *runner, char *name, size_t size)
{
    lua_getfield(L, scene, "definition");
    lua_pushvalue(L, scene);
    lua_call(L, 1, 1);
    lua_getfield(L, -1, "name");
    if (lua_type(L, -1) == LUA_TSTRING) {
        snprintf(name, size, "%s", lua_tostring(L, -1));
    } else {
        impact_runner_base_name(runner, name, size);
    }
    lua_pop(L, 2);
    if (!impact_runner_is_plain(name))
        luaL_error(L, "%s: the scene's name '%s' names the files: it must be plain, without '/'", runner->script, name);
}

/* scene:run{csv = name, record = NAME.run, or whether it has a plot, rows = whether it has}; an exit code. Pushes the
 * reason it ended. */
static int run_scene(lua_State *L, int scene, impact_runner *runner, const char *name, bool plot)
{
    lua_getfield(L, scene, "run");
    lua_pushvalue(L, scene);
    lua_createtable(L, 0, 3);
    lua_pushstring(L, name);
    lua_setfield(L, -2, "csv");
    if (runner->record)
        lua_pushfstring(L, "%s.run", name);
    else
        lua_pushboolean(L, plot || runner->verify);
    lua_setfield(L, -2, "record");
    lua_pushboolean(L, plot || runner->verify);
    lua_setfield(L, -2, "rows");
    lua_call(L, 2, 3);
    clear_progress(runner);
    if (!lua_isnil(L, -3) && strcmp(lua_tostring(L, -3), "event limit") == 0)
        return impact_runner_complain(runner, IMPACT_EXIT_LIMIT, lua_tostring(L, -2));
    if (!lua_isnil(L, -3)) {
        const char *doubt = lua_tostring(L, -2);
        if (doubt) fprintf(stderr, "impact: %s\n", doubt);
        lua_pop(L, 2);
        return doubt ? IMPACT_EXIT_INACCURATE : IMPACT_EXIT_OK;
    }
    const char *kind = lua_tostring(L, -1), *message = lua_tostring(L, -2);
    return impact_runner_complain_limits(
        runner, kind && strcmp(kind, "output") == 0 ? IMPACT_EXIT_OUTPUT : IMPACT_EXIT_RUN, message);
}

/* The picture of a scene with a plot; an exit code. *drawn tells whether there is one. */
static int draw_scene(lua_State *L, int scene, impact_runner *runner, const char *name, bool *drawn)
{
    char message[400] = "", text[600];
    lua_getfield(L, scene, "figure");
    lua_pushvalue(L, scene);
    lua_call(L, 1, 1);
    switch (impact_runner_draw(L, lua_gettop(L), runner, name, message, sizeof message)) {
    case IMPACT_DRAWN: *drawn = true; return IMPACT_EXIT_OK;
    case IMPACT_DRAW_NO_GNUPLOT:
        fprintf(stderr, "impact: gnuplot is not installed: no picture is drawn; the CSV files are complete\n");
        return IMPACT_EXIT_OK;
    case IMPACT_DRAW_REFUSED:
        snprintf(text, sizeof text, "%s: the plot of scene '%s': %s", runner->script, name, message);
        return impact_runner_complain_limits(runner, IMPACT_EXIT_SCRIPT, text);
    default:
        snprintf(text, sizeof text, "no picture: %s", message);
        return impact_runner_complain_limits(runner, IMPACT_EXIT_OUTPUT, text);
    }
}

static void summarise(lua_State *L, int scene, const impact_runner *runner, const char *name, bool drawn, bool viewed)
{
    lua_getfield(L, scene, "summary");
    lua_pushvalue(L, scene);
    lua_pushvalue(L, -3); /* the reason */
    lua_call(L, 2, 1);
    const char *directory = runner->directory, *text = lua_tostring(L, -1);
    printf("%s  wrote      ", text ? text : "");
    if (viewed) printf("%s/%s.%s, ", directory, name, runner->ending);
    printf("%s/%s.csv, %s/%s_events.csv", directory, name, directory, name);
    if (runner->record) printf(", %s/%s.run", directory, name);
    if (drawn) printf(", %s/%s.png", directory, name);
    putchar('\n');
    if (runner->unfenced) printf("  not fenced %s\n", runner->unfenced);
    lua_pop(L, 1);
}

/* The figure on top of the stack as NAME.png; an exit code. */
static int draw_report(lua_State *L, impact_runner *runner, const char *name, bool *drawn)
{
    char message[400] = "", text[600];
    switch (impact_runner_draw(L, lua_gettop(L), runner, name, message, sizeof message)) {
    case IMPACT_DRAWN: *drawn = true; return IMPACT_EXIT_OK;
    case IMPACT_DRAW_NO_GNUPLOT:
        fprintf(stderr, "impact: gnuplot is not installed: no picture is drawn; the CSV file is complete\n");
        return IMPACT_EXIT_OK;
    default:
        snprintf(text, sizeof text, "no picture: %s", message);
        return impact_runner_complain(runner, IMPACT_EXIT_OUTPUT, text);
    }
}

/* Pushes what the method of the report at the index answers to it. */
static void ask_report(lua_State *L, int report, const char *method, const char *argument)
{
    lua_getfield(L, report, method);
    lua_pushvalue(L, report);
    lua_pushstring(L, argument);
    lua_call(L, 2, 2);
}

/* The report in the runner's stead: NAME_report.csv, NAME_report.png, and the table. */
static int report_scene(lua_State *L, int scene, impact_runner *runner, const char *name)
{
    char file[280];
    bool drawn = false;
    snprintf(file, sizeof file, "%s_report", name);
    lua_getfield(L, scene, "report");
    lua_pushvalue(L, scene);
    lua_createtable(L, 0, 1);
    if (runner->report_seconds > 0) lua_pushnumber(L, runner->report_seconds), lua_setfield(L, -2, "seconds");
    lua_call(L, 2, 2);
    clear_progress(runner);
    if (lua_isnil(L, -2)) return impact_runner_complain_limits(runner, IMPACT_EXIT_RUN, lua_tostring(L, -1));
    lua_pop(L, 1);
    const int report = lua_gettop(L);
    ask_report(L, report, "csv", file);
    if (lua_isnil(L, -2)) return impact_runner_complain_limits(runner, IMPACT_EXIT_OUTPUT, lua_tostring(L, -1));
    ask_report(L, report, "figure", NULL);
    lua_pop(L, 1);
    const int code = draw_report(L, runner, file, &drawn);
    ask_report(L, report, "text", NULL);
    if (!runner->quiet)
        printf("%s  wrote       %s/%s.csv%s%s%s%s%s\n", lua_tostring(L, -2), runner->directory, file, drawn ? ", " : "",
               drawn ? runner->directory : "", drawn ? "/" : "", drawn ? file : "", drawn ? ".png" : "");
    return code;
}

/* The run done again by another method: what that found; an exit code. */
static int verify_scene(lua_State *L, int scene, impact_runner *runner)
{
    lua_getfield(L, scene, "verify");
    lua_pushvalue(L, scene);
    lua_call(L, 1, 2);
    clear_progress(runner);
    if (lua_isnil(L, -2)) return impact_runner_complain_limits(runner, IMPACT_EXIT_INACCURATE, lua_tostring(L, -1));
    lua_pop(L, 1);
    lua_getfield(L, -1, "good");
    lua_getfield(L, -2, "text");
    lua_pushvalue(L, -3);
    lua_call(L, 1, 1);
    if (!lua_toboolean(L, -2)) return impact_runner_complain(runner, IMPACT_EXIT_INACCURATE, lua_tostring(L, -1));
    if (!runner->quiet) printf("verified: %s\n", lua_tostring(L, -1));
    return IMPACT_EXIT_OK;
}

static int view_scene(lua_State *L, int scene, impact_runner *runner, const char *name)
{
    lua_getfield(L, scene, "record");
    lua_pushvalue(L, scene);
    lua_call(L, 1, 1);
    return impact_runner_view(L, lua_gettop(L), runner, name);
}

static int drive_scene(lua_State *L, int scene, impact_runner *runner)
{
    char name[256];
    bool drawn = false;
    choose_name(L, scene, runner, name, sizeof name);
    if (runner->report) return report_scene(L, scene, runner, name);
    snprintf(runner->run_name, sizeof runner->run_name, "%s", name);
    impact_runner_resume(L, scene, runner);
    runner->saved = impact_runner_now();
    lua_getfield(L, scene, "has_plot");
    lua_pushvalue(L, scene);
    lua_call(L, 1, 1);
    const bool plot = lua_toboolean(L, -1);
    lua_pop(L, 1);
    const int ran = run_scene(L, scene, runner, name, plot);
    if (ran != IMPACT_EXIT_OK && ran != IMPACT_EXIT_INACCURATE) return ran;
    impact_runner_drop_checkpoint(runner);
    const int unsaved = impact_runner_tell_unsaved(runner);
    const int reason = lua_gettop(L);
    int drew = plot ? draw_scene(L, scene, runner, name, &drawn) : IMPACT_EXIT_OK;
    const bool views = drew == IMPACT_EXIT_OK && runner->shown;
    if (views) drew = view_scene(L, scene, runner, name);
    lua_settop(L, reason);
    const int verified = runner->verify ? verify_scene(L, scene, runner) : IMPACT_EXIT_OK;
    lua_settop(L, reason);
    if (!runner->quiet) summarise(L, scene, runner, name, drawn, views && drew == IMPACT_EXIT_OK);
    return drew != IMPACT_EXIT_OK ? drew : ran != IMPACT_EXIT_OK ? ran : unsaved != IMPACT_EXIT_OK ? unsaved : verified;
}

/* The table arg, as lua has it. */
void impact_runner_set_arguments(lua_State *L, const impact_runner *runner)
{
    lua_newtable(L);
    lua_pushstring(L, runner->script);
    lua_rawseti(L, -2, 0);
    for (int i = 0; runner->arguments && runner->arguments[i]; i++) {
        lua_pushstring(L, runner->arguments[i]);
        lua_rawseti(L, -2, i + 1);
    }
    lua_setglobal(L, "arg");
}

/* Protected: (runner) -> exit code */
static int work(lua_State *L)
{
    impact_runner *runner = lua_touserdata(L, 1);
    impact_runner_open_libraries(L, runner);
    impact_runner_start_clock(runner);
    impact_runner_watch(L);
    impact_runner_set_arguments(L, runner);
    const bool record = impact_runner_is_record(runner);
    const int loaded = record ? LUA_OK : luaL_loadfilex(L, runner->script, runner->trust ? NULL : "t");
    if (loaded == LUA_ERRSYNTAX) return impact_runner_refuse_script(L, runner);
    if (loaded != LUA_OK) return lua_error(L);
    if (record) impact_runner_push_record(L, runner);
    if (!runner->trust) {
        impact_runner_open_folder_early(runner);
        runner->unfenced = impact_runner_fence(runner);
        if (runner->unfenced && runner->fence) {
            lua_pushinteger(L, impact_runner_complain(runner, IMPACT_EXIT_RUN,
                                                      lua_pushfstring(L, "not fenced: %s", runner->unfenced)));
            return 1;
        }
    }
    if (record) {
        lua_pushinteger(L, impact_runner_view_record(L, runner));
        return 1;
    }
    lua_call(L, 0, 1);
    int code = IMPACT_EXIT_OK;
    if (luaL_testudata(L, -1, "impact.scene"))
        code = drive_scene(L, lua_gettop(L), runner);
    else if (runner->shown)
        return luaL_error(L, "%s: %s needs a script that returns a scene, impact.scene{...}", runner->script,
                          runner->shown);
    else if (!lua_isnil(L, -1))
        return luaL_error(L, "%s: a script returns a scene, impact.scene{...}, or nothing; this one returned a %s",
                          runner->script, luaL_typename(L, -1));
    else if (!runner->used)
        return luaL_error(L,
                          "%s: the script returned nothing, ran nothing and wrote nothing: is `return` missing before "
                          "impact.scene{...}?",
                          runner->script);
    lua_pushinteger(L, code);
    return 1;
}

static int run_script(impact_runner *runner)
{
    int code;
    lua_State *L = lua_newstate(impact_runner_allocate, runner);
    if (!L)
        return impact_runner_complain(runner, IMPACT_EXIT_LIMIT,
                                      runner->memory_refused ? "the memory limit is too small to start"
                                                             : "not enough memory");
    lua_pushcfunction(L, work);
    lua_pushlightuserdata(L, runner);
    if (lua_pcall(L, 1, 1, 0) == LUA_OK) {
        code = (int)lua_tointeger(L, -1);
    } else {
        const char *text = lua_tostring(L, -1);
        code = impact_runner_complain_limits(runner, IMPACT_EXIT_SCRIPT,
                                             text ? text : "the script raised an error that is not a text");
    }
    lua_close(L);
    return code;
}

int main(int count, char **words)
{
    impact_runner runner = {.directory = "out",
                            .folder = -1,
                            .drawer_link = -1,
                            .save_at = NAN,
                            .threads = 1,
                            .shards = 1,
                            .started = impact_runner_now(),
                            .max_disk_megabytes = 1024};
    int code = impact_runner_read_command(count, words, &runner);
    if (code < 0) {
        runner.quota.left = (unsigned long long)(runner.max_disk_megabytes * 1048576.0);
        runner.folder_made = runner.command != IMPACT_COMMAND_GATHER && access(runner.directory, F_OK) != 0;
        impact_runner_start_drawer(&runner);
        impact_runner_limit_memory(&runner);
        runner.host = (impact_lua_host){.directory = runner.directory,
                                        .confined = !runner.trust,
                                        .prepare = prepare,
                                        .progress = on_progress,
                                        .ended_early = on_early_end,
                                        .ran = &runner.used,
                                        .save = impact_runner_save,
                                        .save_at = runner.save_at,
                                        .checkpoints = runner.checkpoint > 0,
                                        .quota = &runner.quota,
                                        .allocator = &runner.allocator,
                                        .context = &runner};
        code = impact_runner_read_resumed(&runner);
        if (code != IMPACT_EXIT_OK)
            ;
        else if (runner.command == IMPACT_COMMAND_SWEEP)
            code = impact_runner_sweep(&runner);
        else if (runner.command == IMPACT_COMMAND_GATHER)
            code = impact_runner_gather(&runner);
        else
            code = run_script(&runner);
        impact_runner_end_drawer(&runner);
        free(runner.resumed);
    }
    if (fflush(stdout) != 0 && code == IMPACT_EXIT_OK) {
        fprintf(stderr, "impact: cannot write to the standard output: %s\n", strerror(errno));
        code = IMPACT_EXIT_OUTPUT;
    }
    return code;
}
