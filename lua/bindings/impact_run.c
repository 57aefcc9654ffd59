/* SPDX-License-Identifier: MIT
 *
 * Running a scene from a script. The script's functions are called from inside libimpact and CVODE, so each call is
 * protected: an error is kept, the run stops in order, and the error goes on from where scene:run was called.
 */
#include "impact_scene.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- calling the script ---- */

/* Protected: (function, row) -> whether to go on. */
static int call_with_sample(lua_State *L)
{
    lua_pushvalue(L, 1);
    impact_lua_push_sample(L, lua_touserdata(L, 2));
    lua_call(L, 1, 1);
    return 1;
}

static int call_with_event(lua_State *L)
{
    const impact_event *event = lua_touserdata(L, 2);
    lua_pushvalue(L, 1);
    impact_lua_push_event(L, event, event->phases ? event->phases : "");
    lua_call(L, 1, 1);
    return 1;
}

/* Calls the script's function at slot by way of caller. False: it failed or answered false. */
static bool call_script(impact_lua_scene *self, lua_CFunction caller, int slot, const void *row)
{
    lua_State *L = self->L;
    if (!lua_checkstack(L, 8)) return false;
    lua_pushcfunction(L, caller);
    lua_pushvalue(L, slot);
    lua_pushlightuserdata(L, (void *)row);
    if (lua_pcall(L, 2, 1, 0) != LUA_OK) return impact_lua_script_fails(self);
    self->stopped |= lua_isboolean(L, -1) && !lua_toboolean(L, -1);
    lua_pop(L, 1);
    return !self->stopped;
}

/* ---- the recorder: CSV, rows kept, the script's functions, the host ---- */

/* Tells the host how far the run is; false when it is to end. */
static bool tell_host(impact_lua_scene *self, double t, double t_end)
{
    if (!self->host || !self->host->progress || self->host->progress(self->host->context, t, t_end)) return true;
    self->ended_by_host = true;
    return false;
}

static bool csv_fails(impact_lua_scene *self)
{
    self->csv_failed = true;
    self->csv_errno = errno;
    return false;
}

static bool on_sample(void *context, const impact_sample *sample)
{
    impact_lua_scene *self = context;
    if (self->failed || self->stopped) return false;
    self->t_told = sample->t;
    /* Long flights in closed form are all samples and no progress. */
    if (++self->samples_told % 1024 == 0 && !tell_host(self, sample->t, self->t_end)) return false;
    if (self->has_csv && !self->csv.sample(self->csv.context, sample)) return csv_fails(self);
    if (self->keeps_rows && !impact_lua_keep_sample(self->L, &self->rows, sample))
        return self->record_failed = true, false;
    return !self->sample_slot || call_script(self, call_with_sample, self->sample_slot, sample);
}

static bool on_event(void *context, const impact_event *event)
{
    impact_lua_scene *self = context;
    if (self->failed || self->stopped) return false;
    self->t_told = event->t;
    if (self->has_csv && !self->csv.event(self->csv.context, event)) return csv_fails(self);
    if (self->keeps_rows && !impact_lua_keep_event(self->L, &self->rows, event))
        return self->record_failed = true, false;
    if (self->record && !self->keys.event(self->keys.context, event)) return self->record_failed = true, false;
    return !self->event_slot || call_script(self, call_with_event, self->event_slot, event);
}

static bool on_key(void *context, const impact_key *key)
{
    impact_lua_scene *self = context;
    self->record_failed |= !self->keys.key(self->keys.context, key);
    return !self->record_failed;
}

static bool on_held(void *context, const impact_held *contact)
{
    impact_lua_scene *self = context;
    self->record_failed |= !self->keys.held(self->keys.context, contact);
    return !self->record_failed;
}

static bool on_account(void *context, double t, const impact_energy *energy)
{
    impact_lua_scene *self = context;
    self->record_failed |= !self->keys.account(self->keys.context, t, energy);
    return !self->record_failed;
}

static int call_with_times(lua_State *L)
{
    const double *times = lua_touserdata(L, 2);
    lua_pushvalue(L, 1);
    lua_pushnumber(L, times[0]);
    lua_pushnumber(L, times[1]);
    lua_call(L, 2, 1);
    return 1;
}

static bool on_progress(void *context, double t, double t_end)
{
    impact_lua_scene *self = context;
    const double times[2] = {t, t_end};
    if (self->failed || self->stopped) return false;
    if (!tell_host(self, t, t_end)) return false;
    return !self->progress_slot || call_script(self, call_with_times, self->progress_slot, times);
}

/* ---- run ---- */

/* The slot of an option that must be a function; 0 when it is absent. */
static int function_slot(const quat_lua_reader *options, const char *key)
{
    if (quat_lua_push(options, key) == LUA_TNIL) return 0;
    if (!lua_isfunction(options->L, -1))
        quat_lua_reader_error(options, "%s must be a function, got a %s", key, luaL_typename(options->L, -1));
    return lua_gettop(options->L);
}

bool impact_lua_is_plain(const char *name)
{
    return name[0] && name[0] != '.' && !strchr(name, '/') && strlen(name) < 200;
}

/* Pushes the path of a file of this name without its ending: in the host's folder, which is then made, when the name is
 * plain. Raises when it is not, and must be; NULL with a message when the folder cannot be made. */
static const char *push_path(const quat_lua_reader *options, const char *key, const char *name,
                             const impact_lua_host *host, const char *ending, char *message, size_t size)
{
    lua_State *L = options->L;
    const bool plain = impact_lua_is_plain(name);
    if (host && host->confined && !plain)
        quat_lua_reader_error(options, "%s must be a plain name without '/', got the string '%s'", key, name);
    const size_t length = strlen(name), tail = strlen(ending);
    if (length > tail && strcmp(name + length - tail, ending) == 0) name = lua_pushlstring(L, name, length - tail);
    if (!host || !plain) return lua_pushstring(L, name);
    if (!host->prepare(host->context, name, message, size)) return NULL;
    return lua_pushfstring(L, "%s/%s", host->directory, name);
}

/* Opens NAME.csv and NAME_events.csv; NULL with a message when it cannot. The names they get when the run ends early
 * stand on top of the stack. */
static impact_csv *open_csv(const quat_lua_reader *options, const impact_lua_host *host, char *message, size_t size)
{
    lua_State *L = options->L;
    impact_csv *csv = NULL;
    quat_lua_push(options, "csv"); /* stays on the stack, and so the name stays */
    const char *path = push_path(options, "csv", quat_lua_get_string(options, "csv", ""), host, ".csv", message, size);
    if (!path) return NULL;
    const char *samples = lua_pushfstring(L, "%s.csv", path);
    const char *events = lua_pushfstring(L, "%s_events.csv", path);
    const impact_csv_def def = {.struct_size = sizeof def,
                                .samples_path = samples,
                                .events_path = events,
                                .quota = host ? host->quota : NULL,
                                .allocator = host ? host->allocator : NULL};
    if (impact_csv_open_with(&def, &csv, message, size) < 0) csv = NULL;
    lua_pushfstring(L, "%s.partial.csv and %s_events.partial.csv", path, path);
    return csv;
}

/* Reads record: true, or the path of a file; *path stays on the stack. False, with a message, when it cannot be. */
static bool open_record(const quat_lua_reader *options, impact_lua_scene *self, const char **path, char *message,
                        size_t size)
{
    lua_State *L = options->L;
    *path = NULL;
    const int type = quat_lua_push(options, "record");
    if (type != LUA_TNIL && type != LUA_TBOOLEAN && type != LUA_TSTRING)
        quat_lua_reader_error(options, "record must be true or the name of a file, got a %s", luaL_typename(L, -1));
    self->record = lua_toboolean(L, -1);
    self->keeps_rows = self->record && quat_lua_get_boolean(options, "rows", true);
    self->rows.asked = self->rows.asked || self->keeps_rows;
    if (self->record && !self->writer && impact_run_create(self->scene, &self->writer, message, size) < 0) return false;
    if (self->record) self->keys = impact_run_recorder(self->writer);
    if (type == LUA_TSTRING)
        *path = push_path(options, "record", quat_lua_get_string(options, "record", ""), self->host, "", message, size);
    return type != LUA_TSTRING || *path;
}

static const char *outcome(const impact_lua_scene *self, impact_status status)
{
    if (self->stopped) return "stopped by the script";
    switch (status) {
    case IMPACT_OK: return "end of time";
    case IMPACT_AT_REST: return "at rest";
    case IMPACT_EVENT_LIMIT: return "event limit";
    case IMPACT_SOFT: return "inaccurate";
    default: return "stopped";
    }
}

/* Closes the files: whole ones of a run that came to its end, partial ones of another, which the host is told of. */
static impact_status close_files(lua_State *L, impact_lua_scene *self, impact_csv *csv, bool early, char *message,
                                 size_t size)
{
    const bool rows = csv && impact_csv_rows(csv) > 0;
    const impact_status closed = impact_csv_close(csv, early ? IMPACT_CSV_PARTIAL : IMPACT_CSV_KEEP, message, size);
    if (early && self->host && self->host->ended_early)
        self->host->ended_early(self->host->context, fmax(impact_scene_time(self->scene), self->t_told), self->t_end,
                                rows && closed == IMPACT_OK ? lua_tostring(L, self->files_slot) : "");
    return closed;
}

/* Returns the reason it ended, with a message when that is "inaccurate" or "event limit"; or nil, message, "run" or
 * "output". */
static int finish(lua_State *L, impact_lua_scene *self, impact_csv *csv, const char *record, impact_status status)
{
    char message[400] = "";
    const bool good = !self->failed && !self->record_failed && !self->csv_failed && !self->save_failed &&
                      !self->ended_by_host && (status >= 0 || self->stopped);
    self->L = NULL;
    self->reason = good ? outcome(self, status) : NULL;
    impact_status closed = close_files(L, self, csv, !good || status == IMPACT_EVENT_LIMIT, message, sizeof message);
    if (good && closed >= 0 && record)
        closed = impact_run_save(self->writer, self->reason, record, self->host ? self->host->quota : NULL, message,
                                 sizeof message);
    if (self->failed) {
        lua_settop(L, self->error_slot);
        return lua_error(L);
    }
    if (self->record_failed) return quat_lua_error(L, "not enough memory to record the run");
    if (good && closed >= 0) {
        lua_pushstring(L, outcome(self, status));
        if (self->stopped || (status != IMPACT_SOFT && status != IMPACT_EVENT_LIMIT)) return 1;
        lua_pushstring(L, impact_scene_message(self->scene));
        return 2;
    }
    lua_pushnil(L);
    if (good || self->csv_failed || self->save_failed) {
        if (self->save_failed)
            snprintf(message, sizeof message, "%s", self->save_message);
        else if (self->csv_failed)
            snprintf(message, sizeof message, "cannot write the rows: %s",
                     self->csv_errno == EDQUOT ? "the disk limit is reached" : strerror(self->csv_errno));
        lua_pushstring(L, message);
        lua_pushliteral(L, "output");
    } else {
        const char *why =
            self->ended_by_host ? "ended by the program that runs the script" : impact_scene_message(self->scene);
        lua_pushstring(L, why[0] ? why : impact_status_string(status));
        lua_pushliteral(L, "run");
    }
    return 3;
}

static int output_failure(lua_State *L, const char *message)
{
    quat_lua_failure(L, message);
    lua_pushliteral(L, "output");
    return 3;
}

/* ---- saving on the way ---- */

static bool save(impact_lua_scene *self, bool at_time)
{
    const impact_lua_host *host = self->host;
    if (host->save(host->context, self->scene, at_time, self->save_message, sizeof self->save_message)) return true;
    return self->save_failed = true, false;
}

static impact_status go_to(impact_lua_scene *self, double t, const impact_recorder *recorder)
{
    return self->whole && t == self->t_end ? impact_scene_run(self->scene, recorder)
                                           : impact_scene_run_to(self->scene, t, recorder);
}

/* To t, event by event where checkpoints are due in between. */
static impact_status run_to(impact_lua_scene *self, double t, const impact_recorder *recorder)
{
    impact_event event;
    if (!self->host || !self->host->save || !self->host->checkpoints) return go_to(self, t, recorder);
    for (;;) {
        const impact_status status = impact_scene_step(self->scene, t, recorder, &event);
        if (status < 0 || status == IMPACT_EVENT_LIMIT || self->stopped) return status;
        if (event.body1 < 0) return go_to(self, t, recorder);
        if (!save(self, false)) return IMPACT_OK;
    }
}

static impact_status run_and_save(impact_lua_scene *self, const impact_recorder *recorder)
{
    const double at = self->host && self->host->save ? self->host->save_at : NAN;
    if (!(at >= impact_scene_time(self->scene) && at <= self->t_end)) return run_to(self, self->t_end, recorder);
    const impact_status status = run_to(self, at, recorder);
    if (status < 0 || status == IMPACT_EVENT_LIMIT || self->stopped || self->save_failed) return status;
    return save(self, true) ? run_to(self, self->t_end, recorder) : IMPACT_OK;
}

int impact_lua_run(lua_State *L, impact_lua_scene *self, double t_end, int options_index, impact_event *event)
{
    static const char *const keys[] = {"csv", "record", "rows", "on_sample", "on_event", "on_progress", NULL};
    impact_csv *csv = NULL;
    if (lua_isnoneornil(L, options_index)) {
        lua_settop(L, options_index - 1);
        lua_newtable(L);
    }
    lua_settop(L, options_index);
    luaL_checkstack(L, 24, NULL);
    const quat_lua_reader options = quat_lua_read(L, options_index, "run", NULL, keys);
    self->host = impact_lua_get_host(L);
    if (self->host && self->host->ran) *self->host->ran = true;
    self->whole = isnan(t_end);
    self->t_end = self->whole ? self->duration : t_end;
    self->t_told = 0;
    self->samples_told = 0;
    self->sample_slot = function_slot(&options, "on_sample");
    self->event_slot = function_slot(&options, "on_event");
    self->progress_slot = function_slot(&options, "on_progress");
    lua_getiuservalue(L, 1, IMPACT_LUA_LAWS);
    self->laws_slot = lua_gettop(L);
    self->failed = self->stopped = self->csv_failed = self->record_failed = self->ended_by_host = self->has_csv =
        self->save_failed = false;
    char message[400] = "";
    const char *record;
    if (!open_record(&options, self, &record, message, sizeof message)) return output_failure(L, message);
    if (quat_lua_has(&options, "csv")) {
        csv = open_csv(&options, self->host, message, sizeof message);
        if (!csv) return output_failure(L, message[0] ? message : "cannot open the CSV files");
        self->files_slot = lua_gettop(L);
        self->csv = impact_csv_recorder(csv);
        self->has_csv = true;
    }
    lua_pushnil(L);
    self->error_slot = lua_gettop(L);
    self->L = L; /* from here on nothing raises until finish has closed the files */
    const impact_recorder recorder = {.struct_size = sizeof recorder,
                                      .context = self,
                                      .sample = on_sample,
                                      .event = on_event,
                                      .progress = on_progress,
                                      .key = self->record ? on_key : NULL,
                                      .held = self->record ? on_held : NULL,
                                      .account = self->record ? on_account : NULL};
    const impact_status status =
        event ? impact_scene_step(self->scene, self->t_end, &recorder, event) : run_and_save(self, &recorder);
    return finish(L, self, csv, record, status);
}
