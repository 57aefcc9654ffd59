/* SPDX-License-Identifier: MIT
 *
 * impact.scene{...}: making a scene, and what a script can ask of it.
 */
#include "impact_record.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- making ---- */

/* Raises with the place of the body that the message speaks of, when it speaks of one; else with the scene's. */
static int refuse_scene(lua_State *L, const impact_scene_def *def, const char *message)
{
    lua_pushliteral(L, "bodies");
    lua_rawget(L, 1);
    for (int i = 0; i < def->body_count; i++) {
        char start[96];
        snprintf(start, sizeof start, "body '%s'", def->bodies[i].name);
        if (strncmp(message, start, strlen(start)) != 0) continue;
        lua_rawgeti(L, -1, i + 1);
        const char *where = impact_lua_push_position(L, -1);
        if (!where) break;
        lua_pushfstring(L, "%s%s", where, message);
        return lua_error(L);
    }
    return quat_lua_error(L, "%s", message);
}

/* A table that holds the polyhedra's hulls, whatever the script does with its shapes. */
static void push_hulls(lua_State *L, const impact_scene_def *def)
{
    lua_newtable(L);
    for (int i = 0; i < def->body_count; i++) {
        if (!def->bodies[i].shape.hull) continue;
        impact_lua_push_hull(L, def->bodies[i].shape.hull);
        lua_rawseti(L, -2, i + 1);
    }
}

static int make_scene(lua_State *L)
{
    char message[400] = "";
    lua_settop(L, 1);
    luaL_checkstack(L, 24, NULL);
    impact_lua_scene *self = lua_newuserdatauv(L, sizeof *self, 3);
    memset(self, 0, sizeof *self);
    luaL_setmetatable(L, IMPACT_LUA_SCENE);
    lua_newtable(L);
    const impact_scene_def def = impact_lua_read_scene(L, 1, self, 3);
    const impact_status status = impact_scene_create(&def, &self->scene, message, sizeof message);
    if (status < 0) return refuse_scene(L, &def, message[0] ? message : impact_status_string(status));
    snprintf(self->name, sizeof self->name, "%s", def.name);
    self->duration = def.duration;
    self->body_count = def.body_count;
    lua_pushvalue(L, 1);
    lua_setiuservalue(L, 2, IMPACT_LUA_DEFINITION);
    lua_pushvalue(L, 3);
    lua_setiuservalue(L, 2, IMPACT_LUA_LAWS);
    push_hulls(L, &def);
    lua_setiuservalue(L, 2, IMPACT_LUA_HULLS);
    lua_settop(L, 2);
    return 1;
}

static int scene_new(lua_State *L) { return quat_lua_quietly(L, make_scene); }

/* ---- asking ---- */

impact_lua_scene *impact_lua_check_scene(lua_State *L)
{
    impact_lua_scene *self = luaL_checkudata(L, 1, IMPACT_LUA_SCENE);
    if (!self->scene) quat_lua_error(L, "the scene is closed");
    if (self->L)
        quat_lua_error(L,
                       "scene '%s' is running; ask when the run has ended, or go on by scene:step() or scene:run_to(t) "
                       "and ask between",
                       self->name);
    return self;
}

static int scene_time(lua_State *L)
{
    lua_pushnumber(L, impact_scene_time(impact_lua_check_scene(L)->scene));
    return 1;
}

static int scene_duration(lua_State *L)
{
    lua_pushnumber(L, impact_lua_check_scene(L)->duration);
    return 1;
}

static int scene_name(lua_State *L)
{
    lua_pushstring(L, impact_lua_check_scene(L)->name);
    return 1;
}

static int scene_definition(lua_State *L)
{
    impact_lua_check_scene(L);
    lua_getiuservalue(L, 1, IMPACT_LUA_DEFINITION);
    return 1;
}

static int scene_state(lua_State *L)
{
    const impact_lua_scene *self = impact_lua_check_scene(L);
    const char *name = luaL_checkstring(L, 2);
    impact_sample sample;
    if (impact_scene_body(self->scene, impact_scene_find(self->scene, name), &sample) < 0)
        return quat_lua_error(L, "scene '%s' has no body '%s'", self->name, name);
    impact_lua_push_sample(L, &sample);
    return 1;
}

void impact_lua_push_energy(lua_State *L, const impact_energy *energy)
{
    lua_createtable(L, 0, 9);
    quat_lua_set_number(L, "start", energy->start);
    quat_lua_set_number(L, "kinetic", energy->kinetic);
    quat_lua_set_number(L, "potential", energy->potential);
    quat_lua_set_number(L, "force_work", energy->force_work);
    quat_lua_set_number(L, "drive_work", energy->drive_work);
    quat_lua_set_number(L, "damping_loss", energy->damping_loss);
    quat_lua_set_number(L, "sliding_loss", energy->sliding_loss);
    quat_lua_set_number(L, "impact_loss", energy->impact_loss);
}

static int scene_energy(lua_State *L)
{
    const impact_energy energy = impact_scene_energy(impact_lua_check_scene(L)->scene);
    impact_lua_push_energy(L, &energy);
    return 1;
}

/* Returns "ok" or "inaccurate", and the table of residuals. */
static int scene_receipt(lua_State *L)
{
    impact_scene_residuals r;
    const bool good = impact_scene_receipt(impact_lua_check_scene(L)->scene, &r) == IMPACT_OK;
    const struct {
        const char *key;
        double value, limit;
    } numbers[] = {
        {"unit", r.unit, r.limit_unit},
        {"gap", r.gap, r.limit_gap},
        {"contact", r.contact, r.limit_contact},
        {"energy", r.energy, r.limit_energy},
        {"momentum", r.momentum, r.limit_momentum},
        {"loss_fallen", r.loss_fallen, NAN},
        {"begin", r.begin, NAN},
        {"end", r.end, NAN},
        {"stretches", (double)r.stretches, NAN},
    };
    lua_pushstring(L, good ? "ok" : "inaccurate");
    lua_newtable(L);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        lua_pushnumber(L, numbers[i].value);
        lua_setfield(L, -2, numbers[i].key);
        if (isnan(numbers[i].limit)) continue;
        lua_pushfstring(L, "limit_%s", numbers[i].key);
        lua_pushnumber(L, numbers[i].limit);
        lua_settable(L, -3);
    }
    if (good) return 2;
    lua_pushstring(L, r.failed);
    lua_setfield(L, -2, "failed");
    lua_pushnumber(L, r.failed_begin);
    lua_setfield(L, -2, "failed_begin");
    lua_pushnumber(L, r.failed_end);
    lua_setfield(L, -2, "failed_end");
    return 2;
}

static int scene_usage(lua_State *L)
{
    const impact_usage usage = impact_scene_usage(impact_lua_check_scene(L)->scene);
    const char *name;
    long value;
    lua_newtable(L);
    for (int i = 0; impact_usage_entry(&usage, i, &name, &value); i++) {
        lua_pushinteger(L, value);
        lua_setfield(L, -2, name);
    }
    lua_pushnumber(L, impact_scene_pile_error(impact_lua_check_scene(L)->scene));
    lua_setfield(L, -2, "pile_error");
    const double parted = impact_scene_pile_parted(impact_lua_check_scene(L)->scene);
    if (isfinite(parted)) {
        lua_pushnumber(L, parted);
        lua_setfield(L, -2, "pile_parted");
    }
    lua_createtable(L, 0, IMPACT_EVENT_REST + 1);
    for (int kind = 0; kind <= IMPACT_EVENT_REST; kind++) {
        lua_pushinteger(L, usage.events[kind]);
        lua_setfield(L, -2, impact_event_name((impact_event_kind)kind));
    }
    lua_setfield(L, -2, "events");
    return 1;
}

static int scene_memory(lua_State *L)
{
    const impact_memory memory = impact_scene_memory(impact_lua_check_scene(L)->scene);
    const struct {
        const char *key;
        size_t value;
    } counts[] = {
        {"held", memory.held}, {"used", memory.used}, {"most", memory.most}, {"pieces", (size_t)memory.pieces}};
    lua_createtable(L, 0, 4);
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        lua_pushinteger(L, (lua_Integer)counts[i].value);
        lua_setfield(L, -2, counts[i].key);
    }
    return 1;
}

/* ---- running ---- */

static int scene_run(lua_State *L)
{
    impact_lua_scene *self = impact_lua_check_scene(L);
    return impact_lua_run(L, self, NAN, 2, NULL);
}

static int scene_run_to(lua_State *L)
{
    impact_lua_scene *self = impact_lua_check_scene(L);
    return impact_lua_run(L, self, quat_lua_arg_number(L, 2, "t", QUAT_LUA_NOT_NEGATIVE), 3, NULL);
}

/* Raises when no run was recorded: empty rows would be taken for an answer. */
static const impact_lua_scene *recorded_scene(lua_State *L)
{
    const impact_lua_scene *self = impact_lua_check_scene(L);
    if (!self->rows.asked) quat_lua_error(L, "scene '%s' has no rows: run it with record = true", self->name);
    return self;
}

/* track(body): {t=, x=, ... wz=}, columns of the recorded rows of one body. */
static int scene_track(lua_State *L)
{
    const impact_lua_scene *self = recorded_scene(L);
    const char *name = luaL_checkstring(L, 2);
    const int body = impact_scene_find(self->scene, name);
    if (body < 0) return quat_lua_error(L, "scene '%s' has no body '%s'", self->name, name);
    impact_lua_push_track(L, &self->rows, body);
    return 1;
}

/* events(): the recorded events, in order. */
static int scene_events(lua_State *L)
{
    impact_lua_push_events(L, &recorded_scene(L)->rows);
    return 1;
}

/* record(): the recorded run, for any time. */
static int scene_record(lua_State *L)
{
    const impact_lua_scene *self = impact_lua_check_scene(L);
    if (!self->writer) quat_lua_error(L, "scene '%s' has no record: run it with record = true", self->name);
    char message[200] = "";
    const void *bytes;
    size_t size;
    impact_run **run;
    impact_lua_push_run(L, NULL);
    run = lua_touserdata(L, -1);
    impact_status status = impact_run_bytes(self->writer, self->reason ? self->reason : "so far", &bytes, &size);
    if (status < 0) return quat_lua_error(L, "%s", impact_status_string(status));
    const impact_allocator *allocator = self->host ? self->host->allocator : NULL;
    status = impact_run_read(bytes, size, self->name, allocator, run, message, sizeof message);
    if (status < 0) return quat_lua_error(L, "%s", message);
    return 1;
}

static int scene_close(lua_State *L)
{
    impact_lua_scene *self = luaL_checkudata(L, 1, IMPACT_LUA_SCENE);
    if (self->L) return quat_lua_error(L, "scene '%s' is running", self->name);
    impact_run_discard(self->writer);
    self->writer = NULL;
    impact_scene_destroy(self->scene);
    self->scene = NULL;
    impact_lua_free_rows(L, &self->rows);
    return 0;
}

static int scene_tostring(lua_State *L)
{
    const impact_lua_scene *self = luaL_checkudata(L, 1, IMPACT_LUA_SCENE);
    lua_pushfstring(L, "scene '%s' (%d %s%s)", self->name, self->body_count, self->body_count == 1 ? "body" : "bodies",
                    self->scene ? "" : ", closed");
    return 1;
}

/* defaults: what the library takes for an absent key, for scripts to read. */
static void add_defaults(lua_State *L)
{
    const impact_scene_def scene = impact_default_scene_def();
    const impact_body_def body = impact_default_body_def();
    const struct {
        const char *key;
        double value;
    } numbers[] = {
        {"output_rate", scene.output_rate},
        {"tolerance", scene.tolerance},
        {"rest_height", scene.rest_height},
        {"rest_speed", scene.rest_speed},
        {"key_tolerance", scene.key_tolerance},
        {"pile_tolerance", scene.pile_tolerance},
        {"max_events", (double)scene.max_events},
        {"density", body.density},
        {"friction", body.friction},
        {"restitution", body.restitution},
        {"torsional_friction", body.torsional_friction},
        {"rolling_friction", body.rolling_friction},
        {"linear_damping", body.linear_damping},
        {"angular_damping", body.angular_damping},
    };
    lua_newtable(L);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        lua_pushnumber(L, numbers[i].value);
        lua_setfield(L, -2, numbers[i].key);
    }
    quat_lua_push_vec3(L, scene.gravity);
    lua_setfield(L, -2, "gravity");
    lua_setfield(L, -2, "defaults");
}

void impact_lua_open_scene(lua_State *L)
{
    static const luaL_Reg meta[] = {
        {"__gc", scene_close}, {"__close", scene_close}, {"__tostring", scene_tostring}, {NULL, NULL}};
    static const luaL_Reg methods[] = {
        {"run", scene_run},         {"run_to", scene_run_to},
        {"track", scene_track},     {"events", scene_events},
        {"time", scene_time},       {"duration", scene_duration},
        {"name", scene_name},       {"definition", scene_definition},
        {"state", scene_state},     {"energy", scene_energy},
        {"usage", scene_usage},     {"memory", scene_memory},
        {"close", scene_close},     {"record", scene_record},
        {"receipt", scene_receipt}, {NULL, NULL},
    };
    luaL_newmetatable(L, IMPACT_LUA_SCENE);
    luaL_setfuncs(L, meta, 0);
    luaL_newlib(L, methods);
    impact_lua_add_interaction(L);
    impact_lua_add_report(L);
    lua_pushvalue(L, -1);
    lua_setfield(L, -3, "__index");
    lua_setfield(L, -3, "scene_methods"); /* the layer adds its own */
    lua_pop(L, 1);
    lua_pushcfunction(L, scene_new);
    lua_setfield(L, -2, "scene");
    add_defaults(L);
}
