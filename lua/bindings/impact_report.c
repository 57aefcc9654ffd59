/* SPDX-License-Identifier: MIT
 *
 * scene:report_rows{...}: the scene's definition by every method, as impact_report has it.
 */
#include <impact/report.h>
#include "impact_scene.h"

#include <string.h>

enum { COMPONENTS = 15 }; /* of an oracle's row: t, body, x y z, q w x y z, v, w */

/* A list of numbers at key, on the stack as memory; NULL when it is absent. */
static const double *read_numbers(const quat_lua_reader *reader, const char *key, int *count)
{
    lua_State *L = reader->L;
    *count = 0;
    if (quat_lua_push(reader, key) == LUA_TNIL) return NULL;
    if (!lua_istable(L, -1)) quat_lua_reader_error(reader, "%s must be a list of numbers", key);
    const int list = lua_gettop(L);
    const lua_Unsigned length = lua_rawlen(L, list);
    if (length < 1 || length > 10000000) quat_lua_reader_error(reader, "%s must be a list of numbers", key);
    double *numbers = lua_newuserdatauv(L, length * sizeof *numbers, 0);
    for (lua_Unsigned i = 0; i < length; i++) {
        if (lua_rawgeti(L, list, (lua_Integer)i + 1) != LUA_TNUMBER)
            quat_lua_reader_error(reader, "%s must be a list of numbers", key);
        numbers[i] = lua_tonumber(L, -1);
        lua_pop(L, 1);
    }
    *count = (int)length;
    return numbers;
}

/* Only the methods named. */
static void read_methods(const quat_lua_reader *reader, impact_report_def *how)
{
    lua_State *L = reader->L;
    if (quat_lua_push(reader, "methods") == LUA_TNIL) return;
    if (!lua_istable(L, -1)) quat_lua_reader_error(reader, "methods must be a list of their names");
    for (int m = 0; m < IMPACT_REPORT_METHODS; m++) how->left_out[m] = true;
    const lua_Unsigned count = lua_rawlen(L, -1);
    for (lua_Unsigned i = 0; i < count; i++) {
        lua_rawgeti(L, -1, (lua_Integer)i + 1);
        const char *name = lua_type(L, -1) == LUA_TSTRING ? lua_tostring(L, -1) : "";
        int m = 0;
        while (m < IMPACT_REPORT_METHODS && strcmp(name, impact_report_method_name((impact_report_method)m)) != 0) m++;
        if (m == IMPACT_REPORT_METHODS)
            quat_lua_reader_error(reader,
                                  "unknown method '%s' in methods: 'default', 'motion = cvode', 'impacts = cvode', "
                                  "'gaps = ccd', 'textbook', 'motion = rk4'",
                                  name);
        how->left_out[m] = false;
        lua_pop(L, 1);
    }
}

static const impact_sample *read_oracle(const quat_lua_reader *reader, impact_report_def *how)
{
    int count;
    const double *n = read_numbers(reader, "reference", &count);
    if (!n) return NULL;
    if (count % COMPONENTS != 0) quat_lua_reader_error(reader, "reference has rows that are not whole");
    how->oracle_count = count / COMPONENTS;
    impact_sample *rows = lua_newuserdatauv(reader->L, (size_t)how->oracle_count * sizeof *rows, 0);
    for (int i = 0; i < how->oracle_count; i++, n += COMPONENTS)
        rows[i] = (impact_sample){.t = n[0],
                                  .body = (int)n[1],
                                  .position = {n[2], n[3], n[4]},
                                  .orientation = {n[5], n[6], n[7], n[8]},
                                  .velocity = {n[9], n[10], n[11]},
                                  .omega = {n[12], n[13], n[14]}};
    return rows;
}

static impact_report_def read_options(lua_State *L, int index)
{
    static const char *const keys[] = {"seconds", "times",     "rounds",          "tolerances", "steps",
                                       "methods", "reference", "reference_error", NULL};
    const quat_lua_reader reader = quat_lua_read(L, index, "report", NULL, keys);
    impact_report_def how = {.struct_size = sizeof how};
    how.seconds = quat_lua_get_number(&reader, "seconds", QUAT_LUA_POSITIVE, 20);
    how.times = (int)quat_lua_get_integer(&reader, "times", 1, 10000, 48);
    how.rounds = (int)quat_lua_get_integer(&reader, "rounds", 1, 15, 7);
    how.tolerances = read_numbers(&reader, "tolerances", &how.tolerance_count);
    how.steps = read_numbers(&reader, "steps", &how.step_count);
    read_methods(&reader, &how);
    how.oracle = read_oracle(&reader, &how);
    how.oracle_error = quat_lua_get_number(&reader, "reference_error", QUAT_LUA_POSITIVE, 1e-15);
    return how;
}

/* ---- results ---- */

static void set_error(lua_State *L, impact_report_error e)
{
    quat_lua_set_number(L, "e_x", e.x);
    quat_lua_set_number(L, "e_v", e.v);
    quat_lua_set_number(L, "e_q", e.q);
    quat_lua_set_number(L, "e_t", e.t);
    quat_lua_set_number(L, "e", impact_report_worst(e));
}

static void set_usage(lua_State *L, const impact_usage *usage)
{
    const char *name;
    long value;
    lua_newtable(L);
    for (int i = 0; impact_usage_entry(usage, i, &name, &value); i++) quat_lua_set_integer(L, name, value);
    lua_setfield(L, -2, "usage");
}

typedef struct row_sink {
    lua_State *L;
    int rows, count;
} row_sink;

/* Protected: (row_sink *, row *) */
static int push_row(lua_State *L)
{
    const row_sink *sink = lua_touserdata(L, 1);
    const impact_report_row *row = lua_touserdata(L, 2);
    lua_createtable(L, 0, 20);
    quat_lua_set_string(L, "method", impact_report_method_name(row->method));
    quat_lua_set_number(L, "setting", row->setting);
    set_error(L, row->error);
    quat_lua_set_boolean(L, "below", row->below);
    quat_lua_set_integer(L, "other_events", row->other_events);
    quat_lua_set_number(L, "first_other", row->first_other);
    quat_lua_set_integer(L, "dying", row->dying);
    quat_lua_set_number(L, "account", row->account);
    quat_lua_set_number(L, "cpu", row->cpu);
    quat_lua_set_number(L, "spread", row->spread);
    quat_lua_set_integer(L, "rounds", row->rounds);
    quat_lua_set_string(L, "ended", impact_status_string(row->status));
    quat_lua_set_number(L, "reached", row->reached);
    quat_lua_set_string(L, "message", row->message);
    set_usage(L, &row->usage);
    lua_rawseti(L, 3, sink->count);
    return 0;
}

static bool take_row(const impact_report_row *row, void *context)
{
    row_sink *sink = context;
    lua_State *L = sink->L;
    sink->count++;
    if (!lua_checkstack(L, 8)) return false;
    lua_pushcfunction(L, push_row);
    lua_pushlightuserdata(L, sink);
    lua_pushlightuserdata(L, (void *)row);
    lua_pushvalue(L, sink->rows);
    if (lua_pcall(L, 3, 0, 0) == LUA_OK) return true;
    lua_pop(L, 1);
    return false;
}

static void set_witness(lua_State *L, const char *key, impact_report_witness witness)
{
    if (witness.setting == 0) return;
    lua_createtable(L, 0, 2);
    quat_lua_set_string(L, "method", impact_report_method_name(witness.method));
    quat_lua_set_number(L, "setting", witness.setting);
    lua_setfield(L, -2, key);
}

static void push_summary(lua_State *L, const impact_report_summary *s)
{
    lua_createtable(L, 0, 20);
    quat_lua_set_number(L, "duration", s->duration);
    quat_lua_set_integer(L, "times", s->times);
    quat_lua_set_integer(L, "events", s->events);
    quat_lua_set_integer(L, "rounds", s->rounds);
    quat_lua_set_number(L, "X", s->X);
    quat_lua_set_number(L, "V", s->V);
    quat_lua_set_number(L, "reference", s->reference);
    quat_lua_set_boolean(L, "sure", s->sure);
    lua_newtable(L);
    set_error(L, s->certainty);
    lua_setfield(L, -2, "certainty");
    set_witness(L, "motion_witness", s->motion_witness);
    set_witness(L, "impact_witness", s->impact_witness);
    quat_lua_set_number(L, "condition", s->condition);
    quat_lua_set_number(L, "horizon", s->horizon);
    quat_lua_set_integer(L, "dropped", s->dropped);
    quat_lua_set_number(L, "cpu", s->cpu);
    lua_newtable(L);
    for (int m = 0, n = 0; m < IMPACT_REPORT_METHODS; m++) {
        if (!s->useless[m]) continue;
        lua_pushstring(L, impact_report_method_name((impact_report_method)m));
        lua_rawseti(L, -2, ++n);
    }
    lua_setfield(L, -2, "useless");
}

/* ---- the call ---- */

static bool host_goes_on(void *context)
{
    const impact_lua_scene *self = context;
    if (self->failed) return false;
    return !self->host || !self->host->progress || self->host->progress(self->host->context, 0, self->duration);
}

/* The scene as the laws see it, with the definition's own: a copy that lives as long as the call. */
static impact_lua_scene *push_double(lua_State *L, const impact_lua_scene *self, impact_scene_def *def)
{
    impact_lua_scene *own = lua_newuserdatauv(L, sizeof *own, 0);
    memset(own, 0, sizeof *own);
    own->scene = self->scene; /* its bodies have the names */
    own->duration = self->duration;
    own->host = impact_lua_get_host(L);
    lua_newtable(L);
    own->laws_slot = lua_gettop(L);
    lua_getiuservalue(L, 1, IMPACT_LUA_DEFINITION);
    *def = impact_lua_read_scene(L, lua_gettop(L), own, own->laws_slot);
    return own;
}

/* report_rows(options): {rows}, {summary}; or nil, message */
static int report_rows(lua_State *L)
{
    char message[300] = "";
    impact_lua_scene *self = impact_lua_check_scene(L);
    lua_settop(L, 2);
    luaL_checkstack(L, 60, NULL);
    impact_report_def how = read_options(L, 2);
    impact_scene_def def;
    impact_lua_scene *own = push_double(L, self, &def);
    how.go_on = host_goes_on, how.context = own;
    impact_report_summary summary;
    lua_newtable(L);
    row_sink sink = {.L = L, .rows = lua_gettop(L)};
    lua_pushnil(L);
    own->error_slot = lua_gettop(L);
    own->L = self->L = L; /* nothing raises until it is given back */
    const impact_status status = impact_report(&def, &how, take_row, &sink, &summary, message, sizeof message);
    self->L = NULL;
    if (own->failed) {
        lua_pushvalue(L, own->error_slot);
        return lua_error(L);
    }
    if (status < 0 || status == IMPACT_STOPPED)
        return quat_lua_failure(L, message[0] ? message : impact_status_string(status));
    lua_pushvalue(L, sink.rows);
    push_summary(L, &summary);
    return 2;
}

void impact_lua_add_report(lua_State *L)
{
    lua_pushcfunction(L, report_rows);
    lua_setfield(L, -2, "report_rows");
}
