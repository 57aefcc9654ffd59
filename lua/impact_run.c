/* SPDX-License-Identifier: MIT
 *
 * Running a scene from a script. The script's functions are called from inside libimpact and CVODE, so each call is protected:
 * an error is kept, the run stops in order, and the error goes on from where scene:run was called.
 */
#include "impact_scene.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

/* ---- calling the script ---- */

typedef struct law_call {
    double t;
    const char *body;
    double mass;
    const qvec3 *position, *velocity, *omega;
    const quat *orientation;
    qvec3 *force, *torque;
} law_call;

/* state[key] = the entry's own vector at place, with the components of v. */
static void set_vec3(lua_State *L, int entry, int state, int place, const char *key, const qvec3 *v)
{
    const double component[3] = {v->x, v->y, v->z};
    lua_rawgeti(L, entry, place);
    for (int i = 0; i < 3; i++) {
        lua_pushnumber(L, component[i]);
        lua_rawseti(L, -2, i + 1);
    }
    lua_setfield(L, state, key);
}

/* The sign of a NaN means nothing, and is not shown. */
static double positive_nan(double x) { return isnan(x) ? (double)NAN : x; }

/* A vector that a law returned; nil is zero. The law's entry is at index 2. */
static qvec3 returned_vec3(lua_State *L, int index, const char *what)
{
    double v[3] = {0, 0, 0};
    if (lua_isnil(L, index)) return (qvec3){0, 0, 0};
    bool good = lua_istable(L, index);
    for (int i = 0; good && i < 3; i++) {
        lua_rawgeti(L, index, i + 1);
        v[i] = lua_tonumber(L, -1);
        good = lua_type(L, -1) == LUA_TNUMBER && isfinite(v[i]);
        lua_pop(L, 1);
    }
    if (good) return (qvec3){v[0], v[1], v[2]};
    lua_rawgeti(L, 2, IMPACT_LUA_LAW_WHERE);
    lua_rawgeti(L, 2, IMPACT_LUA_LAW_NAME);
    char got[100];
    if (lua_istable(L, index))
        snprintf(got, sizeof got, "{%.6g, %.6g, %.6g}", positive_nan(v[0]), positive_nan(v[1]), positive_nan(v[2]));
    else
        snprintf(got, sizeof got, "a %s", luaL_typename(L, index));
    lua_pushfstring(L, "%sforce '%s': the %s must be a vector {x, y, z} of finite numbers, got %s", lua_tostring(L, -2),
                    lua_tostring(L, -1), what, got);
    lua_error(L);
    return (qvec3){0, 0, 0};
}

/* Protected: (law_call *, the law's entry) */
static int call_law(lua_State *L)
{
    const law_call *call = lua_touserdata(L, 1);
    luaL_checkstack(L, 12, NULL);
    lua_rawgeti(L, 2, IMPACT_LUA_LAW_STATE);
    const int state = lua_gettop(L);
    lua_rawgeti(L, 2, IMPACT_LUA_LAW_ORIENTATION);
    *(quat *)lua_touserdata(L, -1) = *call->orientation;
    lua_setfield(L, state, "orientation");
    lua_pushstring(L, call->body);
    lua_setfield(L, state, "name");
    lua_pushnumber(L, call->mass);
    lua_setfield(L, state, "mass");
    set_vec3(L, 2, state, IMPACT_LUA_LAW_POSITION, "position", call->position);
    set_vec3(L, 2, state, IMPACT_LUA_LAW_VELOCITY, "velocity", call->velocity);
    set_vec3(L, 2, state, IMPACT_LUA_LAW_OMEGA, "omega", call->omega);
    lua_rawgeti(L, 2, IMPACT_LUA_LAW_FUNCTION);
    lua_pushnumber(L, call->t);
    lua_pushvalue(L, state);
    lua_call(L, 2, 2);
    const int result = lua_gettop(L) - 1;
    *call->force = returned_vec3(L, result, "force");
    *call->torque = returned_vec3(L, result + 1, "torque");
    return 0;
}

static bool fail(impact_lua_scene *self) /* the error is on top */
{
    lua_replace(self->L, self->error_slot);
    self->failed = true;
    return false;
}

bool impact_lua_call_law(double t, int body, double mass, qvec3 position, quat orientation, qvec3 velocity, qvec3 omega,
                         qvec3 *force, qvec3 *torque, void *context)
{
    const impact_lua_law *law = context;
    impact_lua_scene *self = law->owner;
    lua_State *L = self->L;
    impact_sample sample;
    if (!L || self->failed || !lua_checkstack(L, 8) || impact_scene_body(self->scene, body, &sample) < 0) return false;
    law_call call = {t, sample.name, mass, &position, &velocity, &omega, &orientation, force, torque};
    lua_pushcfunction(L, call_law);
    lua_pushlightuserdata(L, &call);
    lua_rawgeti(L, self->laws_slot, law->index);
    if (lua_pcall(L, 2, 0, 0) == LUA_OK) return true;
    return fail(self);
}

void impact_lua_push_sample(lua_State *L, const impact_sample *sample)
{
    luaL_checkstack(L, 6, NULL);
    lua_createtable(L, 0, 6);
    quat_lua_set_number(L, "t", sample->t);
    quat_lua_set_string(L, "body", sample->name);
    quat_lua_set_vec3(L, "position", sample->position);
    quat_lua_set_quat(L, "orientation", sample->orientation);
    quat_lua_set_vec3(L, "velocity", sample->velocity);
    quat_lua_set_vec3(L, "omega", sample->omega);
}

static void push_event(lua_State *L, const impact_event *event, const char *phases)
{
    luaL_checkstack(L, 6, NULL);
    lua_createtable(L, 0, 13);
    quat_lua_set_number(L, "t", event->t);
    quat_lua_set_number(L, "impulse_n", event->impulse_normal);
    quat_lua_set_number(L, "impulse_t", event->impulse_tangential);
    quat_lua_set_number(L, "un_before", event->normal_before);
    quat_lua_set_number(L, "un_after", event->normal_after);
    quat_lua_set_number(L, "energy_before", event->energy_before);
    quat_lua_set_number(L, "energy_after", event->energy_after);
    quat_lua_set_string(L, "event", impact_event_name(event->kind));
    quat_lua_set_string(L, "body1", event->name1);
    quat_lua_set_string(L, "body2", event->name2);
    quat_lua_set_string(L, "phases", phases);
    quat_lua_set_vec3(L, "point", event->point);
    quat_lua_set_vec3(L, "normal", event->normal);
}

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
    push_event(L, event, event->phases ? event->phases : "");
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
    if (lua_pcall(L, 2, 1, 0) != LUA_OK) return fail(self);
    self->stopped |= lua_isboolean(L, -1) && !lua_toboolean(L, -1);
    lua_pop(L, 1);
    return !self->stopped;
}

/* ---- keeping rows; the memory is the Lua state's, so that its limit holds ---- */

/* Room for one more of size bytes; false when the memory is out. */
static bool grow(lua_State *L, void **array, size_t count, size_t *capacity, size_t size)
{
    void *context;
    lua_Alloc allocate = lua_getallocf(L, &context);
    if (count < *capacity) return true;
    const size_t wanted = *capacity ? 2 * *capacity : 256;
    void *more = wanted < (size_t)-1 / 2 / size ? allocate(context, *array, *capacity * size, wanted * size) : NULL;
    if (!more) return false;
    *array = more;
    *capacity = wanted;
    return true;
}

void impact_lua_free_rows(lua_State *L, impact_lua_rows *rows)
{
    void *context;
    lua_Alloc allocate = lua_getallocf(L, &context);
    if (rows->samples) allocate(context, rows->samples, rows->sample_capacity * sizeof *rows->samples, 0);
    if (rows->events) allocate(context, rows->events, rows->event_capacity * sizeof *rows->events, 0);
    *rows = (impact_lua_rows){0};
}

static bool keep_sample(impact_lua_scene *self, const impact_sample *sample)
{
    impact_lua_rows *rows = &self->rows;
    void *array = rows->samples;
    if (!grow(self->L, &array, rows->sample_count, &rows->sample_capacity, sizeof *sample)) return false;
    rows->samples = array;
    rows->samples[rows->sample_count++] = *sample;
    return true;
}

static bool keep_event(impact_lua_scene *self, const impact_event *event)
{
    impact_lua_rows *rows = &self->rows;
    void *array = rows->events;
    if (!grow(self->L, &array, rows->event_count, &rows->event_capacity, sizeof *rows->events)) return false;
    rows->events = array;
    impact_lua_event *place = &rows->events[rows->event_count++];
    place->event = *event;
    snprintf(place->phases, sizeof place->phases, "%s", event->phases ? event->phases : "");
    return true;
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
    /* Long flights in closed form are all samples and no progress. */
    if (++self->samples_told % 1024 == 0 && !tell_host(self, sample->t, self->t_end)) return false;
    if (self->has_csv && !self->csv.sample(self->csv.context, sample)) return csv_fails(self);
    if (self->record && !keep_sample(self, sample)) return self->record_failed = true, false;
    return !self->sample_slot || call_script(self, call_with_sample, self->sample_slot, sample);
}

static bool on_event(void *context, const impact_event *event)
{
    impact_lua_scene *self = context;
    if (self->failed || self->stopped) return false;
    if (self->has_csv && !self->csv.event(self->csv.context, event)) return csv_fails(self);
    if (self->record && !keep_event(self, event)) return self->record_failed = true, false;
    return !self->event_slot || call_script(self, call_with_event, self->event_slot, event);
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

/* A name for files that stays in its folder. */
static bool is_plain(const char *name) { return name[0] && name[0] != '.' && !strchr(name, '/') && strlen(name) < 200; }

/* Opens NAME.csv and NAME_events.csv; NULL with a message when it cannot. */
static impact_csv *open_csv(const quat_lua_reader *options, const impact_lua_host *host, char *message, size_t size)
{
    lua_State *L = options->L;
    impact_csv *csv = NULL;
    quat_lua_push(options, "csv"); /* stays on the stack, and so the name stays */
    const char *name = quat_lua_get_string(options, "csv", "");
    const bool plain = is_plain(name);
    if (host && host->confined && !plain)
        quat_lua_reader_error(options, "csv must be a plain name without '/', got the string '%s'", name);
    const bool inside = host && plain;
    if (inside && !host->prepare(host->context, message, size)) return NULL;
    const char *directory = inside ? host->directory : "", *slash = inside ? "/" : "";
    const char *samples = lua_pushfstring(L, "%s%s%s.csv", directory, slash, name);
    const char *events = lua_pushfstring(L, "%s%s%s_events.csv", directory, slash, name);
    remove(lua_pushfstring(L, "%s.part", samples)); /* never through a link that lies there */
    remove(lua_pushfstring(L, "%s.part", events));
    if (impact_csv_open(samples, events, &csv, message, size) < 0) csv = NULL;
    return csv;
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

/* Returns the reason it ended, with a message when that is "inaccurate"; or nil, message, "run" or "output". */
static int finish(lua_State *L, impact_lua_scene *self, impact_csv *csv, impact_status status)
{
    char message[400] = "";
    const bool good = !self->failed && !self->record_failed && !self->csv_failed && !self->ended_by_host &&
                      (status >= 0 || self->stopped);
    self->L = NULL;
    const impact_status closed = csv ? impact_csv_close(csv, good, message, sizeof message) : IMPACT_OK;
    if (self->failed) {
        lua_settop(L, self->error_slot);
        return lua_error(L);
    }
    if (self->record_failed) return quat_lua_error(L, "not enough memory to record the run");
    if (good && closed >= 0) {
        lua_pushstring(L, outcome(self, status));
        if (status != IMPACT_SOFT) return 1;
        lua_pushstring(L, impact_scene_message(self->scene));
        return 2;
    }
    lua_pushnil(L);
    if (good || self->csv_failed) {
        if (self->csv_failed) snprintf(message, sizeof message, "cannot write the rows: %s", strerror(self->csv_errno));
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

static int run(lua_State *L, double t_end, int options_index)
{
    static const char *const keys[] = {"csv", "record", "on_sample", "on_event", "on_progress", NULL};
    impact_lua_scene *self = impact_lua_check_scene(L);
    impact_csv *csv = NULL;
    if (lua_isnoneornil(L, options_index)) {
        lua_settop(L, options_index - 1);
        lua_newtable(L);
    }
    lua_settop(L, options_index);
    luaL_checkstack(L, 24, NULL);
    const quat_lua_reader options = quat_lua_read(L, options_index, "run", NULL, keys);
    self->host = impact_lua_get_host(L);
    self->t_end = t_end;
    self->samples_told = 0;
    self->record = quat_lua_get_boolean(&options, "record", false);
    self->sample_slot = function_slot(&options, "on_sample");
    self->event_slot = function_slot(&options, "on_event");
    self->progress_slot = function_slot(&options, "on_progress");
    lua_getiuservalue(L, 1, IMPACT_LUA_LAWS);
    self->laws_slot = lua_gettop(L);
    self->failed = self->stopped = self->csv_failed = self->record_failed = self->ended_by_host = self->has_csv = false;
    if (quat_lua_has(&options, "csv")) {
        char message[400] = "";
        csv = open_csv(&options, self->host, message, sizeof message);
        if (!csv) {
            quat_lua_failure(L, message[0] ? message : "cannot open the CSV files");
            lua_pushliteral(L, "output");
            return 3;
        }
        self->csv = impact_csv_recorder(csv);
        self->has_csv = true;
    }
    lua_pushnil(L);
    self->error_slot = lua_gettop(L);
    self->L = L; /* from here on nothing raises until finish has closed the files */
    const impact_recorder recorder = {self, on_sample, on_event, on_progress};
    return finish(L, self, csv, impact_scene_run_to(self->scene, t_end, &recorder));
}

int impact_lua_scene_run(lua_State *L) { return run(L, impact_lua_check_scene(L)->duration, 2); }

int impact_lua_scene_run_to(lua_State *L)
{
    impact_lua_check_scene(L);
    return run(L, quat_lua_arg_number(L, 2, "t", QUAT_LUA_NOT_NEGATIVE), 3);
}

/* ---- what was recorded ---- */

/* track(body): {t=, x=, ... wz=}, columns of the recorded rows of one body. */
int impact_lua_scene_track(lua_State *L)
{
    static const char *const columns[] = {"t",  "x",  "y",  "z",  "qw", "qx", "qy",
                                          "qz", "vx", "vy", "vz", "wx", "wy", "wz"};
    enum { COLUMNS = sizeof columns / sizeof *columns };
    const impact_lua_scene *self = impact_lua_check_scene(L);
    const char *name = luaL_checkstring(L, 2);
    const int body = impact_scene_find(self->scene, name);
    if (body < 0) return quat_lua_error(L, "scene '%s' has no body '%s'", self->name, name);
    lua_settop(L, 2);
    luaL_checkstack(L, COLUMNS + 4, NULL);
    for (int c = 0; c < COLUMNS; c++) lua_newtable(L);
    lua_Integer row = 0;
    for (size_t i = 0; i < self->rows.sample_count; i++) {
        const impact_sample *s = &self->rows.samples[i];
        if (s->body != body) continue;
        const double values[COLUMNS] = {s->t,
                                        s->position.x,
                                        s->position.y,
                                        s->position.z,
                                        s->orientation.w,
                                        s->orientation.x,
                                        s->orientation.y,
                                        s->orientation.z,
                                        s->velocity.x,
                                        s->velocity.y,
                                        s->velocity.z,
                                        s->omega.x,
                                        s->omega.y,
                                        s->omega.z};
        row++;
        for (int c = 0; c < COLUMNS; c++) {
            lua_pushnumber(L, values[c]);
            lua_rawseti(L, 3 + c, row);
        }
    }
    lua_createtable(L, 0, COLUMNS);
    for (int c = 0; c < COLUMNS; c++) {
        lua_pushvalue(L, 3 + c);
        lua_setfield(L, -2, columns[c]);
    }
    return 1;
}

/* events(): the recorded events, in order. */
int impact_lua_scene_events(lua_State *L)
{
    const impact_lua_scene *self = impact_lua_check_scene(L);
    lua_createtable(L, (int)self->rows.event_count, 0);
    for (size_t i = 0; i < self->rows.event_count; i++) {
        push_event(L, &self->rows.events[i].event, self->rows.events[i].phases);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    return 1;
}
