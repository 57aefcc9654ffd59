/* SPDX-License-Identifier: MIT
 *
 * impact.scene{...}: from a script's tables to an impact_scene, and what a script can ask of it. Running it is in impact_run.c.
 */
#include "impact_scene.h"

#include <stdio.h>
#include <string.h>

/* ---- the host ---- */

static const char host_key[] = "impact.host"; /* registry: light userdata */

void impact_lua_set_host(lua_State *L, const impact_lua_host *host)
{
    lua_pushlightuserdata(L, (void *)host);
    lua_setfield(L, LUA_REGISTRYINDEX, host_key);
}

const impact_lua_host *impact_lua_get_host(lua_State *L)
{
    lua_getfield(L, LUA_REGISTRYINDEX, host_key);
    const impact_lua_host *host = lua_touserdata(L, -1);
    lua_pop(L, 1);
    return host;
}

/* ---- reading a definition ---- */

static const char *const rule_words[] = {"product", "geometric_mean", "minimum", "maximum", NULL};
static const char *const law_words[] = {"poisson", "newton", "stronge", NULL};
static const char *const solver_words[] = {"auto", "closed_form", "series", "cvode", NULL};

/* A list at key: pushes it and returns its length; 0 (and nil pushed) when it is absent. Holes and names are refused. */
static int push_list(const quat_lua_reader *reader, const char *key)
{
    lua_State *L = reader->L;
    if (quat_lua_push(reader, key) == LUA_TNIL) return 0;
    if (!lua_istable(L, -1)) quat_lua_reader_error(reader, "%s must be a list, got a %s", key, luaL_typename(L, -1));
    const lua_Unsigned length = lua_rawlen(L, -1);
    lua_Unsigned count = 0;
    for (lua_pushnil(L); lua_next(L, -2); lua_pop(L, 1)) {
        if (!lua_isinteger(L, -2))
            quat_lua_reader_error(reader, "%s must be a list, without names for its members", key);
        count++;
    }
    if (count != length || length > 100000) quat_lua_reader_error(reader, "%s must be a list without holes", key);
    return (int)length;
}

/* Memory that lives as long as the value left on the stack. */
static void *hold(lua_State *L, int count, size_t size)
{
    return lua_newuserdatauv(L, (size_t)(count > 0 ? count : 1) * size, 0);
}

static const impact_body_def *read_bodies(const quat_lua_reader *reader, impact_scene_def *def)
{
    lua_State *L = reader->L;
    quat_lua_need(reader, "bodies");
    def->body_count = push_list(reader, "bodies");
    const int list = lua_gettop(L);
    impact_body_def *bodies = hold(L, def->body_count, sizeof *bodies);
    for (int i = 0; i < def->body_count; i++) {
        luaL_checkstack(L, 8, NULL);
        lua_rawgeti(L, list, i + 1);
        const char *where = impact_lua_push_position(L, -1);
        impact_lua_read_body(L, -2, where, &bodies[i]);
        lua_pop(L, 2);
    }
    return bodies;
}

/* An entry of the table of laws: see impact_lua_law. The force's table is on top, its place below it. */
static void push_law(lua_State *L, const impact_force_def *force)
{
    const int table = lua_gettop(L);
    lua_createtable(L, IMPACT_LUA_LAW_SIZE, 0);
    lua_pushliteral(L, "law");
    lua_rawget(L, table);
    lua_rawseti(L, -2, IMPACT_LUA_LAW_FUNCTION);
    lua_newtable(L);
    lua_rawseti(L, -2, IMPACT_LUA_LAW_STATE);
    for (int vector = IMPACT_LUA_LAW_POSITION; vector <= IMPACT_LUA_LAW_OMEGA; vector++) {
        quat_lua_push_vec3(L, (qvec3){0, 0, 0});
        lua_rawseti(L, -2, vector);
    }
    quat_lua_push_quat(L, quat_identity());
    lua_rawseti(L, -2, IMPACT_LUA_LAW_ORIENTATION);
    if (!impact_lua_push_position(L, table)) {
        lua_pop(L, 1);
        lua_pushliteral(L, "");
    }
    lua_rawseti(L, -2, IMPACT_LUA_LAW_WHERE);
    lua_pushstring(L, force->name);
    lua_rawseti(L, -2, IMPACT_LUA_LAW_NAME);
}

/* laws: the stack place of the table of laws. */
static const impact_force_def *read_forces(const quat_lua_reader *reader, impact_scene_def *def, impact_lua_scene *self,
                                           int laws)
{
    lua_State *L = reader->L;
    def->force_count = push_list(reader, "forces");
    const int list = lua_gettop(L);
    impact_force_def *forces = hold(L, def->force_count, sizeof *forces);
    impact_lua_law *contexts = hold(L, def->force_count, sizeof *contexts);
    lua_pushvalue(L, -1);
    lua_setfield(L, laws, "contexts"); /* keeps them alive with the scene */
    for (int i = 0; i < def->force_count; i++) {
        char item[40];
        luaL_checkstack(L, 12, NULL);
        snprintf(item, sizeof item, "forces[%d]", i + 1);
        lua_rawgeti(L, list, i + 1);
        const char *where = impact_lua_push_position(L, -1);
        impact_lua_read_force(L, -2, where, item, &forces[i]);
        lua_pop(L, 1);
        if (forces[i].kind == IMPACT_FORCE_CUSTOM) {
            contexts[i] = (impact_lua_law){self, i + 1};
            forces[i].function = impact_lua_call_law;
            forces[i].context = &contexts[i];
            push_law(L, &forces[i]);
            lua_rawseti(L, laws, i + 1);
        }
        lua_pop(L, 1);
    }
    return forces;
}

static const impact_pair_def *read_pairs(const quat_lua_reader *reader, impact_scene_def *def)
{
    static const char *const keys[] = {"bodies", "friction", "restitution", NULL};
    lua_State *L = reader->L;
    def->pair_count = push_list(reader, "pairs");
    const int list = lua_gettop(L);
    impact_pair_def *pairs = hold(L, def->pair_count, sizeof *pairs);
    for (int i = 0; i < def->pair_count; i++) {
        luaL_checkstack(L, 8, NULL);
        lua_rawgeti(L, list, i + 1);
        const quat_lua_reader pair = quat_lua_read(L, -1, "pair", NULL, keys);
        quat_lua_need(&pair, "bodies");
        if (push_list(&pair, "bodies") != 2) quat_lua_reader_error(&pair, "bodies must be the names of two bodies");
        if (lua_rawgeti(L, -1, 1) != LUA_TSTRING || lua_rawgeti(L, -2, 2) != LUA_TSTRING)
            quat_lua_reader_error(&pair, "bodies must be the names of two bodies");
        pairs[i].body1 = lua_tostring(L, -2);
        pairs[i].body2 = lua_tostring(L, -1);
        pairs[i].friction = quat_lua_get_number(&pair, "friction", QUAT_LUA_NOT_NEGATIVE, NAN);
        pairs[i].restitution = quat_lua_get_number(&pair, "restitution", QUAT_LUA_FRACTION, NAN);
        lua_pop(L, 4);
    }
    return pairs;
}

static void read_rules(const quat_lua_reader *reader, impact_scene_def *def)
{
    static const char *const keys[] = {"friction", "restitution", NULL};
    lua_State *L = reader->L;
    if (quat_lua_push(reader, "rules") != LUA_TNIL) {
        const quat_lua_reader rules = quat_lua_read(L, -1, "rules", reader->where, keys);
        def->friction_rule =
            (impact_pair_rule)quat_lua_get_choice(&rules, "friction", rule_words, (int)def->friction_rule);
        def->restitution_rule =
            (impact_pair_rule)quat_lua_get_choice(&rules, "restitution", rule_words, (int)def->restitution_rule);
    }
    lua_pop(L, 1);
    def->law = (impact_law)quat_lua_get_choice(reader, "law", law_words, (int)def->law);
    def->solver = (impact_solver)quat_lua_get_choice(reader, "solver", solver_words, (int)def->solver);
    def->compliance = quat_lua_get_number(reader, "compliance", QUAT_LUA_NOT_NEGATIVE, def->compliance);
}

static void read_plot(const quat_lua_reader *reader)
{
    const int type = quat_lua_push(reader, "plot");
    if (type != LUA_TNIL && type != LUA_TFUNCTION)
        quat_lua_reader_error(reader, "plot must be a function(scene) that returns a figure, got a %s",
                              lua_typename(reader->L, type));
    lua_pop(reader->L, 1);
}

/* The lists stay on the stack so that the definition's memory lives until the scene is made. */
static impact_scene_def read_scene(lua_State *L, int index, impact_lua_scene *self, int laws)
{
    static const char *const keys[] = {
        "name",   "gravity",   "duration",    "output_rate", "bodies",     "forces", "pairs",      "rules", "law",
        "solver", "tolerance", "rest_height", "rest_speed",  "max_events", "plot",   "compliance", NULL};
    const quat_lua_reader reader = quat_lua_read(L, index, "scene", NULL, keys);
    impact_scene_def def = impact_default_scene_def();
    def.name = quat_lua_get_string(&reader, "name", def.name ? def.name : "scene");
    def.gravity = quat_lua_get_vec3(&reader, "gravity", def.gravity);
    quat_lua_need(&reader, "duration");
    def.duration = quat_lua_get_number(&reader, "duration", QUAT_LUA_POSITIVE, def.duration);
    def.output_rate = quat_lua_get_number(&reader, "output_rate", QUAT_LUA_NOT_NEGATIVE, def.output_rate);
    read_rules(&reader, &def);
    def.tolerance = quat_lua_get_number(&reader, "tolerance", QUAT_LUA_POSITIVE, def.tolerance);
    def.rest_height = quat_lua_get_number(&reader, "rest_height", QUAT_LUA_NOT_NEGATIVE, def.rest_height);
    def.rest_speed = quat_lua_get_number(&reader, "rest_speed", QUAT_LUA_NOT_NEGATIVE, def.rest_speed);
    def.max_events = (long)quat_lua_get_integer(&reader, "max_events", 1, 1000000000, def.max_events);
    read_plot(&reader);
    def.bodies = read_bodies(&reader, &def);
    def.forces = read_forces(&reader, &def, self, laws);
    def.pairs = read_pairs(&reader, &def);
    return def;
}

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

static int make_scene(lua_State *L)
{
    char message[400] = "";
    lua_settop(L, 1);
    luaL_checkstack(L, 24, NULL);
    impact_lua_scene *self = lua_newuserdatauv(L, sizeof *self, 2);
    memset(self, 0, sizeof *self);
    luaL_setmetatable(L, IMPACT_LUA_SCENE);
    lua_newtable(L);
    const impact_scene_def def = read_scene(L, 1, self, 3);
    const impact_status status = impact_scene_create(&def, &self->scene, message, sizeof message);
    if (status < 0) return refuse_scene(L, &def, message[0] ? message : impact_status_string(status));
    snprintf(self->name, sizeof self->name, "%s", def.name);
    self->duration = def.duration;
    self->body_count = def.body_count;
    lua_pushvalue(L, 1);
    lua_setiuservalue(L, 2, IMPACT_LUA_DEFINITION);
    lua_pushvalue(L, 3);
    lua_setiuservalue(L, 2, IMPACT_LUA_LAWS);
    lua_settop(L, 2);
    return 1;
}

static int scene_new(lua_State *L) { return quat_lua_quietly(L, make_scene); }

/* ---- asking ---- */

impact_lua_scene *impact_lua_check_scene(lua_State *L)
{
    impact_lua_scene *self = luaL_checkudata(L, 1, IMPACT_LUA_SCENE);
    if (!self->scene) quat_lua_error(L, "the scene is closed");
    if (self->L) quat_lua_error(L, "scene '%s' is running; ask when the run has ended", self->name);
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

static int scene_energy(lua_State *L)
{
    const impact_energy energy = impact_scene_energy(impact_lua_check_scene(L)->scene);
    const struct {
        const char *key;
        double value;
    } numbers[] = {
        {"start", energy.start},
        {"kinetic", energy.kinetic},
        {"potential", energy.potential},
        {"force_work", energy.force_work},
        {"damping_loss", energy.damping_loss},
        {"sliding_loss", energy.sliding_loss},
        {"impact_loss", energy.impact_loss},
    };
    lua_createtable(L, 0, 7);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        lua_pushnumber(L, numbers[i].value);
        lua_setfield(L, -2, numbers[i].key);
    }
    return 1;
}

static int scene_usage(lua_State *L)
{
    const impact_usage usage = impact_scene_usage(impact_lua_check_scene(L)->scene);
    const struct {
        const char *key;
        long value;
    } counts[] = {
        {"ballistic_flights", usage.ballistic_flights},
        {"integrators", usage.integrators},
        {"integrator_starts", usage.integrator_starts},
        {"integrator_steps", usage.integrator_steps},
        {"integrator_rhs_calls", usage.integrator_rhs_calls},
        {"gap_closed_form", usage.gap_closed_form},
        {"gap_newton", usage.gap_newton},
        {"gap_gjk", usage.gap_gjk},
        {"gap_fallback", usage.gap_fallback},
        {"impacts_closed_form", usage.impacts_closed_form},
        {"impacts_series", usage.impacts_series},
        {"impacts_cvode", usage.impacts_cvode},
        {"samples", usage.samples},
    };
    lua_createtable(L, 0, 14);
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        lua_pushinteger(L, counts[i].value);
        lua_setfield(L, -2, counts[i].key);
    }
    lua_createtable(L, 0, IMPACT_EVENT_REST + 1);
    for (int kind = 0; kind <= IMPACT_EVENT_REST; kind++) {
        lua_pushinteger(L, usage.events[kind]);
        lua_setfield(L, -2, impact_event_name((impact_event_kind)kind));
    }
    lua_setfield(L, -2, "events");
    return 1;
}

static int scene_close(lua_State *L)
{
    impact_lua_scene *self = luaL_checkudata(L, 1, IMPACT_LUA_SCENE);
    if (self->L) return quat_lua_error(L, "scene '%s' is running", self->name);
    impact_scene_destroy(self->scene);
    self->scene = NULL;
    impact_lua_free_rows(L, &self->rows);
    return 0;
}

static int scene_tostring(lua_State *L)
{
    const impact_lua_scene *self = luaL_checkudata(L, 1, IMPACT_LUA_SCENE);
    lua_pushfstring(L, "scene '%s' (%d bodies%s)", self->name, self->body_count, self->scene ? "" : ", closed");
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
        {"max_events", (double)scene.max_events},
        {"density", body.density},
        {"friction", body.friction},
        {"restitution", body.restitution},
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
        {"run", impact_lua_scene_run},
        {"run_to", impact_lua_scene_run_to},
        {"track", impact_lua_scene_track},
        {"events", impact_lua_scene_events},
        {"time", scene_time},
        {"duration", scene_duration},
        {"name", scene_name},
        {"definition", scene_definition},
        {"state", scene_state},
        {"energy", scene_energy},
        {"usage", scene_usage},
        {"close", scene_close},
        {NULL, NULL},
    };
    luaL_newmetatable(L, IMPACT_LUA_SCENE);
    luaL_setfuncs(L, meta, 0);
    luaL_newlib(L, methods);
    lua_pushvalue(L, -1);
    lua_setfield(L, -3, "__index");
    lua_setfield(L, -3, "scene_methods"); /* the layer adds its own */
    lua_pop(L, 1);
    lua_pushcfunction(L, scene_new);
    lua_setfield(L, -2, "scene");
    add_defaults(L);
}
