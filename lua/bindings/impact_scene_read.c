/* SPDX-License-Identifier: MIT
 *
 * From a script's tables to an impact_scene_def.
 */
#include "impact_scene.h"

#include <limits.h>
#include <stdio.h>

static const char *const rule_words[] = {"product", "geometric_mean", "minimum", "maximum", NULL};
static const char *const law_words[] = {"poisson", "newton", "stronge", NULL};
static const char *const solver_words[] = {"auto", "closed_form", "series", "cvode", NULL};

/* A list at key: pushes it and returns its length; 0 (and nil pushed) when it is absent. Holes and names
 * are refused. */
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
    if (count != length || length > INT_MAX) quat_lua_reader_error(reader, "%s must be a list without holes", key);
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

static bool has_edge(lua_State *L, int index)
{
    index = lua_absindex(L, index);
    lua_pushliteral(L, "edge");
    const bool has = lua_rawget(L, index) != LUA_TNIL;
    lua_pop(L, 1);
    return has;
}

/* laws: the stack place of the table of laws. */
static const impact_force_def *read_forces(const quat_lua_reader *reader, impact_scene_def *def, impact_lua_scene *self,
                                           int laws)
{
    lua_State *L = reader->L;
    def->force_count = push_list(reader, "forces");
    const int list = lua_gettop(L);
    if (impact_lua_is_force(L, list)) quat_lua_reader_error(reader, "forces must be a list of forces, got one force");
    impact_force_def *forces = hold(L, def->force_count, sizeof *forces);
    impact_lua_law *contexts = hold(L, def->force_count, sizeof *contexts);
    lua_pushvalue(L, -1);
    lua_setfield(L, laws, "contexts"); /* keeps them alive with the scene */
    lua_newtable(L);                   /* the switches, until the scene has copied them */
    const int kept = lua_gettop(L);
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
            if (has_edge(L, -1)) forces[i].edge = impact_lua_call_edge;
            forces[i].switches = impact_lua_push_switches(L, -1, NULL, &forces[i]);
            lua_rawseti(L, kept, i + 1);
            impact_lua_push_law(L, &forces[i]);
            lua_rawseti(L, laws, i + 1);
        }
        lua_pop(L, 1);
    }
    return forces;
}

static const impact_pair_def *read_pairs(const quat_lua_reader *reader, impact_scene_def *def)
{
    static const char *const keys[] = {"bodies",           "friction",  "restitution", "torsional_friction",
                                       "rolling_friction", "stiffness", NULL};
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
        pairs[i] = impact_default_pair_def(lua_tostring(L, -2), lua_tostring(L, -1));
        pairs[i].friction = quat_lua_get_number(&pair, "friction", QUAT_LUA_NOT_NEGATIVE, NAN);
        pairs[i].restitution = quat_lua_get_number(&pair, "restitution", QUAT_LUA_FRACTION, NAN);
        pairs[i].torsional_friction = quat_lua_get_number(&pair, "torsional_friction", QUAT_LUA_NOT_NEGATIVE, NAN);
        pairs[i].rolling_friction = quat_lua_get_number(&pair, "rolling_friction", QUAT_LUA_NOT_NEGATIVE, NAN);
        pairs[i].stiffness = quat_lua_get_number(&pair, "stiffness", QUAT_LUA_POSITIVE, NAN);
        lua_pop(L, 4);
    }
    return pairs;
}

static const char *const samples_words[] = {"all", "moving", NULL};
static const char *const piles_words[] = {"auto", "exact", "steps", NULL};
static const char *const together_words[] = {"auto", "springs", "moreau", "sequence", NULL};

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
    def->piles = (impact_piles)quat_lua_get_choice(reader, "piles", piles_words, (int)def->piles);
    def->together = (impact_scene_together)quat_lua_get_choice(reader, "together", together_words, (int)def->together);
    def->samples = (impact_samples)quat_lua_get_choice(reader, "samples", samples_words, (int)def->samples);
    def->compliance = quat_lua_get_number(reader, "compliance", QUAT_LUA_NOT_NEGATIVE, def->compliance);
}

/* Whether both are given, and differ: two names of one key. */
static void refuse_two_names(const quat_lua_reader *scene, const char *own, const quat_lua_reader *methods,
                             const char *key, bool differ)
{
    if (quat_lua_has(scene, own) && quat_lua_has(methods, key) && differ)
        quat_lua_reader_error(scene, "%s, and %s in methods, are two names of one key, and differ", own, key);
}

static void read_methods(const quat_lua_reader *reader, impact_scene_def *def)
{
    static const char *const keys[] = {"motion",           "impacts",       "gaps", "tolerance",
                                       "impact_tolerance", "gap_tolerance", "step", NULL};
    static const char *const motion_words[] = {"auto", "cvode", "rk4", "steps", "other", NULL};
    static const char *const gap_words[] = {"newton", "ccd", NULL};
    if (quat_lua_push(reader, "methods") != LUA_TNIL) {
        const quat_lua_reader methods = quat_lua_read(reader->L, -1, "methods", reader->where, keys);
        impact_methods *m = &def->methods;
        m->motion = (impact_motion_method)quat_lua_get_choice(&methods, "motion", motion_words, (int)m->motion);
        m->impacts = (impact_solver)quat_lua_get_choice(&methods, "impacts", solver_words, (int)m->impacts);
        m->gaps = (impact_gap_method)quat_lua_get_choice(&methods, "gaps", gap_words, (int)m->gaps);
        m->tolerance = quat_lua_get_number(&methods, "tolerance", QUAT_LUA_POSITIVE, m->tolerance);
        m->impact_tolerance = quat_lua_get_number(&methods, "impact_tolerance", QUAT_LUA_POSITIVE, m->impact_tolerance);
        m->gap_tolerance = quat_lua_get_number(&methods, "gap_tolerance", QUAT_LUA_POSITIVE, m->gap_tolerance);
        m->step = quat_lua_get_number(&methods, "step", QUAT_LUA_POSITIVE, m->step);
        refuse_two_names(reader, "solver", &methods, "impacts", def->solver != m->impacts);
        refuse_two_names(reader, "tolerance", &methods, "tolerance", def->tolerance != m->tolerance);
    }
    lua_pop(reader->L, 1);
}

static void read_plot(const quat_lua_reader *reader)
{
    const int type = quat_lua_push(reader, "plot");
    if (type != LUA_TNIL && type != LUA_TFUNCTION)
        quat_lua_reader_error(reader, "plot must be a function(scene) that returns a figure, got a %s",
                              lua_typename(reader->L, type));
    lua_pop(reader->L, 1);
}

impact_scene_def impact_lua_read_scene(lua_State *L, int index, impact_lua_scene *self, int laws)
{
    static const char *const keys[] = {"name",       "gravity",       "duration",       "output_rate", "bodies",
                                       "forces",     "pairs",         "rules",          "law",         "solver",
                                       "tolerance",  "rest_height",   "rest_speed",     "max_events",  "plot",
                                       "compliance", "key_tolerance", "piles",          "max_steps",   "together",
                                       "samples",    "methods",       "pile_tolerance", NULL};
    const quat_lua_reader reader = quat_lua_read(L, index, "scene", NULL, keys);
    impact_scene_def def = impact_default_scene_def();
    const impact_lua_host *host = impact_lua_get_host(L);
    def.allocator = host ? host->allocator : NULL;
    def.name = quat_lua_get_string(&reader, "name", def.name ? def.name : "scene");
    def.gravity = quat_lua_get_vec3(&reader, "gravity", def.gravity);
    quat_lua_need(&reader, "duration");
    def.duration = quat_lua_get_number(&reader, "duration", QUAT_LUA_POSITIVE, def.duration);
    def.output_rate = quat_lua_get_number(&reader, "output_rate", QUAT_LUA_NOT_NEGATIVE, def.output_rate);
    read_rules(&reader, &def);
    def.tolerance = quat_lua_get_number(&reader, "tolerance", QUAT_LUA_POSITIVE, def.tolerance);
    read_methods(&reader, &def);
    def.rest_height = quat_lua_get_number(&reader, "rest_height", QUAT_LUA_NOT_NEGATIVE, def.rest_height);
    def.rest_speed = quat_lua_get_number(&reader, "rest_speed", QUAT_LUA_NOT_NEGATIVE, def.rest_speed);
    def.max_events = (long)quat_lua_get_integer(&reader, "max_events", 1, 1000000000, def.max_events);
    def.key_tolerance = quat_lua_get_number(&reader, "key_tolerance", QUAT_LUA_POSITIVE, def.key_tolerance);
    def.pile_tolerance = quat_lua_get_number(&reader, "pile_tolerance", QUAT_LUA_POSITIVE, def.pile_tolerance);
    def.max_steps = (long)quat_lua_get_integer(&reader, "max_steps", 1, 1000000000000, def.max_steps);
    read_plot(&reader);
    def.bodies = read_bodies(&reader, &def);
    def.forces = read_forces(&reader, &def, self, laws);
    def.pairs = read_pairs(&reader, &def);
    return def;
}
