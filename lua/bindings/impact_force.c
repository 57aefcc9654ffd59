/* SPDX-License-Identifier: MIT
 *
 * Forces as a script writes them: impact.wind{...}, impact.attraction{...}, impact.force{law=function(t, body) ...
 * end}.
 */
#include "impact_core.h"

static const char *const metatables[] = {
    [IMPACT_FORCE_WIND] = "impact.wind",
    [IMPACT_FORCE_ATTRACTION] = "impact.attraction",
    [IMPACT_FORCE_CUSTOM] = "impact.force",
};

static const char *const words[] = {
    [IMPACT_FORCE_WIND] = "wind",
    [IMPACT_FORCE_ATTRACTION] = "attraction",
    [IMPACT_FORCE_CUSTOM] = "force",
};

static const char *const custom_keys[] = {"name",   "body",   "law",  "max_step", "switches",
                                          "period", "steady", "edge", NULL};

static void read_wind(const quat_lua_reader *reader, impact_force_def *def)
{
    def->origin = quat_lua_get_vec3(reader, "origin", def->origin);
    def->direction = quat_lua_get_vec3(reader, "direction", def->direction);
    if (!(qvec3_norm(def->direction) > 0)) quat_lua_reader_error(reader, "direction must not be zero");
    quat_lua_need(reader, "strength");
    def->strength = quat_lua_get_number(reader, "strength", QUAT_LUA_FINITE, def->strength);
    def->reach = quat_lua_get_number(reader, "reach", QUAT_LUA_POSITIVE_OR_INF, def->reach);
    def->radius = quat_lua_get_number(reader, "radius", QUAT_LUA_POSITIVE_OR_INF, def->radius);
    def->falloff_power = quat_lua_get_number(reader, "falloff_power", QUAT_LUA_NOT_NEGATIVE, def->falloff_power);
    def->falloff_length = quat_lua_get_number(reader, "falloff_length", QUAT_LUA_POSITIVE, def->falloff_length);
    def->drag = quat_lua_get_number(reader, "drag", QUAT_LUA_NOT_NEGATIVE, def->drag);
}

static void read_attraction(const quat_lua_reader *reader, impact_force_def *def)
{
    def->constant = quat_lua_get_number(reader, "constant", QUAT_LUA_FINITE, def->constant);
    def->power = quat_lua_get_number(reader, "power", QUAT_LUA_FINITE, def->power);
    def->reach = quat_lua_get_number(reader, "reach", QUAT_LUA_POSITIVE_OR_INF, def->reach);
}

/* The switches' list into times[count]; NULL: checks and counts it only. */
static int read_switches(const quat_lua_reader *reader, double *times)
{
    lua_State *L = reader->L;
    const int type = quat_lua_push(reader, "switches");
    if (type != LUA_TNIL && type != LUA_TTABLE)
        quat_lua_reader_error(reader, "switches must be a list of times, got a %s", luaL_typename(L, -1));
    const lua_Unsigned count = type == LUA_TTABLE ? lua_rawlen(L, -1) : 0;
    if (count > 1000000) quat_lua_reader_error(reader, "switches must be at most a million times");
    for (lua_Unsigned i = 1; i <= count; i++) {
        lua_rawgeti(L, -1, (lua_Integer)i);
        if (lua_type(L, -1) != LUA_TNUMBER)
            quat_lua_reader_error(reader, "switches[%d] must be a number, got a %s", (int)i, luaL_typename(L, -1));
        if (times) times[i - 1] = lua_tonumber(L, -1);
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    return (int)count;
}

static void read_custom(const quat_lua_reader *reader, impact_force_def *def)
{
    lua_State *L = reader->L;
    quat_lua_need(reader, "law");
    if (quat_lua_push(reader, "law") != LUA_TFUNCTION)
        quat_lua_reader_error(reader, "law must be a function(t, body), got a %s", luaL_typename(L, -1));
    const int edge = quat_lua_push(reader, "edge");
    if (edge != LUA_TNIL && edge != LUA_TFUNCTION)
        quat_lua_reader_error(reader, "edge must be a function(t, body), got a %s", luaL_typename(L, -1));
    lua_pop(L, 2);
    def->max_step = quat_lua_get_number(reader, "max_step", QUAT_LUA_POSITIVE_OR_INF, def->max_step);
    def->switch_period = quat_lua_get_number(reader, "period", QUAT_LUA_POSITIVE, def->switch_period);
    def->steady = quat_lua_get_boolean(reader, "steady", def->steady);
    def->switch_count = read_switches(reader, NULL);
}

static void read_kind(lua_State *L, int index, const char *where, impact_force_kind kind, impact_force_def *def)
{
    static const char *const wind_keys[] = {"name",           "body",  "origin", "direction",
                                            "strength",       "reach", "radius", "falloff_power",
                                            "falloff_length", "drag",  NULL};
    static const char *const attraction_keys[] = {"name", "body", "constant", "power", "reach", NULL};
    static const char *const *const keys[] = {wind_keys, attraction_keys, custom_keys};
    const quat_lua_reader reader = quat_lua_read(L, index, words[kind], where, keys[kind]);
    *def = impact_default_force_def(kind);
    def->name = quat_lua_get_string(&reader, "name", words[kind]);
    def->body = quat_lua_get_string(&reader, "body", NULL);
    switch (kind) {
    case IMPACT_FORCE_WIND: read_wind(&reader, def); break;
    case IMPACT_FORCE_ATTRACTION: read_attraction(&reader, def); break;
    case IMPACT_FORCE_CUSTOM: read_custom(&reader, def); break;
    }
}

const double *impact_lua_push_switches(lua_State *L, int index, const char *where, const impact_force_def *def)
{
    const quat_lua_reader reader = quat_lua_read(L, index, words[IMPACT_FORCE_CUSTOM], where, custom_keys);
    double *times = lua_newuserdatauv(L, ((size_t)def->switch_count + 1) * sizeof *times, 0);
    read_switches(&reader, times);
    return times;
}

bool impact_lua_is_force(lua_State *L, int index)
{
    for (int kind = IMPACT_FORCE_WIND; kind <= IMPACT_FORCE_CUSTOM; kind++)
        if (impact_lua_is_marked(L, index, metatables[kind])) return true;
    return false;
}

void impact_lua_read_force(lua_State *L, int index, const char *where, const char *item, impact_force_def *def)
{
    for (int kind = IMPACT_FORCE_WIND; kind <= IMPACT_FORCE_CUSTOM; kind++) {
        if (impact_lua_is_marked(L, index, metatables[kind])) {
            read_kind(L, index, where, (impact_force_kind)kind, def);
            return;
        }
    }
    quat_lua_error(L, "%s must be made with impact.wind, impact.attraction or impact.force", item);
}

static int make(lua_State *L, impact_force_kind kind)
{
    impact_force_def def;
    lua_settop(L, 1);
    read_kind(L, 1, NULL, kind, &def);
    impact_lua_mark(L, 1, metatables[kind]);
    return 1;
}

static int new_wind(lua_State *L) { return make(L, IMPACT_FORCE_WIND); }
static int new_attraction(lua_State *L) { return make(L, IMPACT_FORCE_ATTRACTION); }
static int new_custom(lua_State *L) { return make(L, IMPACT_FORCE_CUSTOM); }

static int force_wind(lua_State *L) { return quat_lua_quietly(L, new_wind); }
static int force_attraction(lua_State *L) { return quat_lua_quietly(L, new_attraction); }
static int force_custom(lua_State *L) { return quat_lua_quietly(L, new_custom); }

void impact_lua_open_force(lua_State *L)
{
    static const luaL_Reg functions[] = {
        {"wind", force_wind}, {"attraction", force_attraction}, {"force", force_custom}, {NULL, NULL}};
    luaL_setfuncs(L, functions, 0);
}
