/* SPDX-License-Identifier: MIT
 *
 * impact.open(path), scene:record(): a recorded run as a script sees it.
 */
#include "impact_record.h"

#include <stdlib.h>

void impact_lua_push_run(lua_State *L, impact_run *run)
{
    impact_run **self = lua_newuserdatauv(L, sizeof *self, 0);
    *self = run;
    luaL_setmetatable(L, IMPACT_LUA_RUN);
}

typedef impact_status impact_exporter(const impact_run *run, double tolerance, double frame_rate, const char *path,
                                      impact_quota *quota, char *message, unsigned long size);

static impact_run *check_run(lua_State *L)
{
    impact_run **self = luaL_checkudata(L, 1, IMPACT_LUA_RUN);
    if (!*self) quat_lua_error(L, "the recorded run is closed");
    return *self;
}

static int run_open(lua_State *L)
{
    char message[400] = "";
    const impact_lua_host *host = impact_lua_get_host(L);
    const char *path = luaL_checkstring(L, 1);
    if (host && host->confined && !impact_lua_is_plain(path))
        return quat_lua_error(L, "open: the path must be a plain name without '/', got the string '%s'", path);
    if (host && impact_lua_is_plain(path)) path = lua_pushfstring(L, "%s/%s", host->directory, path);
    impact_lua_push_run(L, NULL);
    if (impact_run_open(path, host ? host->allocator : NULL, lua_touserdata(L, -1), message, sizeof message) < 0)
        return quat_lua_failure(L, message);
    return 1;
}

static int run_name(lua_State *L)
{
    lua_pushstring(L, impact_run_name(check_run(L)));
    return 1;
}

static int run_reason(lua_State *L)
{
    lua_pushstring(L, impact_run_reason(check_run(L)));
    return 1;
}

static int run_times(lua_State *L)
{
    const impact_run *run = check_run(L);
    lua_pushnumber(L, impact_run_begin(run));
    lua_pushnumber(L, impact_run_end(run));
    return 2;
}

static int find_body(lua_State *L, const impact_run *run, int arg)
{
    const char *name = luaL_checkstring(L, arg);
    const int body = impact_run_find(run, name);
    if (body < 0) quat_lua_error(L, "run '%s' has no body '%s'", impact_run_name(run), name);
    return body;
}

static impact_sample state_of(lua_State *L, const impact_run *run, int body, double t, bool before)
{
    impact_sample state;
    if ((before ? impact_run_state_before : impact_run_state)(run, body, t, &state) < 0)
        quat_lua_error(L, "run '%s' has no state at t = %g s: it goes from %g to %g s", impact_run_name(run), t,
                       impact_run_begin(run), impact_run_end(run));
    return state;
}

static int push_state(lua_State *L, bool before)
{
    const impact_run *run = check_run(L);
    const int body = find_body(L, run, 2);
    const impact_sample state = state_of(L, run, body, quat_lua_arg_number(L, 3, "t", QUAT_LUA_FINITE), before);
    impact_lua_push_sample(L, &state);
    return 1;
}

static int run_state(lua_State *L) { return push_state(L, false); }
static int run_state_before(lua_State *L) { return push_state(L, true); }

/* columns(body, times): {t=, x=, ... wz=} at those times. */
static int run_columns(lua_State *L)
{
    const impact_run *run = check_run(L);
    const int body = find_body(L, run, 2);
    luaL_checktype(L, 3, LUA_TTABLE);
    const lua_Integer count = (lua_Integer)lua_rawlen(L, 3);
    impact_lua_begin_columns(L);
    for (lua_Integer i = 1; i <= count; i++) {
        lua_rawgeti(L, 3, i);
        const double t = lua_tonumber(L, -1);
        lua_pop(L, 1);
        const impact_sample state = state_of(L, run, body, t, false);
        impact_lua_add_columns(L, &state, i);
    }
    impact_lua_end_columns(L);
    return 1;
}

/* keys(body): the times of its keys. */
static int run_keys(lua_State *L)
{
    const impact_run *run = check_run(L);
    const int body = find_body(L, run, 2);
    lua_newtable(L);
    for (long k = 0; k < impact_run_key_count(run, body); k++) {
        impact_key key;
        impact_run_key(run, body, k, &key);
        lua_pushnumber(L, key.t);
        lua_rawseti(L, -2, (lua_Integer)k + 1);
    }
    return 1;
}

static int run_bodies(lua_State *L)
{
    const impact_run *run = check_run(L);
    lua_newtable(L);
    for (int i = 0; i < impact_run_body_count(run); i++) {
        impact_body_def def = impact_default_body_def();
        impact_run_body(run, i, &def);
        lua_createtable(L, 0, 8);
        quat_lua_set_string(L, "name", def.name);
        quat_lua_set_boolean(L, "static", def.is_static);
        quat_lua_set_number(L, "mass", def.mass);
        quat_lua_set_vec3(L, "moments", def.moments);
        quat_lua_set_vec3(L, "shape_position", def.shape_position);
        quat_lua_set_quat(L, "shape_orientation", def.shape_orientation);
        quat_lua_set_vec3(L, "trail", def.trail);
        quat_lua_set_number(L, "friction", def.friction);
        quat_lua_set_number(L, "restitution", def.restitution);
        quat_lua_set_number(L, "torsional_friction", def.torsional_friction);
        quat_lua_set_number(L, "rolling_friction", def.rolling_friction);
        impact_lua_push_shape(L, &def.shape);
        lua_setfield(L, -2, "shape");
        lua_rawseti(L, -2, i + 1);
    }
    return 1;
}

static int run_events(lua_State *L)
{
    const impact_run *run = check_run(L);
    lua_newtable(L);
    for (long k = 0; k < impact_run_event_count(run); k++) {
        impact_event event;
        impact_run_event(run, k, &event);
        impact_lua_push_event(L, &event, event.phases);
        lua_rawseti(L, -2, (lua_Integer)k + 1);
    }
    return 1;
}

static int run_contacts(lua_State *L)
{
    const impact_run *run = check_run(L);
    lua_newtable(L);
    for (long k = 0; k < impact_run_held_count(run); k++) {
        impact_held held;
        impact_body_def body1 = impact_default_body_def(), body2 = body1;
        impact_run_held(run, k, &held);
        impact_run_body(run, held.body1, &body1);
        impact_run_body(run, held.body2, &body2);
        lua_createtable(L, 0, 7);
        quat_lua_set_number(L, "t", held.t);
        quat_lua_set_string(L, "body1", body1.name);
        quat_lua_set_string(L, "body2", body2.name);
        quat_lua_set_string(L, "mode", impact_hold_name(held.mode));
        quat_lua_set_vec3(L, "point", held.point);
        quat_lua_set_vec3(L, "normal", held.normal);
        quat_lua_set_vec3(L, "force", held.force);
        lua_rawseti(L, -2, (lua_Integer)k + 1);
    }
    return 1;
}

static int run_account(lua_State *L)
{
    const impact_run *run = check_run(L);
    lua_newtable(L);
    for (long k = 0; k < impact_run_account_count(run); k++) {
        impact_energy energy;
        double t;
        impact_run_account(run, k, &t, &energy);
        impact_lua_push_energy(L, &energy);
        quat_lua_set_number(L, "t", t);
        lua_rawseti(L, -2, (lua_Integer)k + 1);
    }
    return 1;
}

/* view(path, tolerance), gltf(path, tolerance, frame_rate): writes the file; true, and what is to be said of it; or nil
 * and a message. */
static int export_run(lua_State *L, const char *what, impact_exporter *write, double usual)
{
    char message[400] = "";
    const double tolerance = luaL_optnumber(L, 3, usual), frame_rate = luaL_optnumber(L, 4, 0);
    const impact_run *run = check_run(L);
    const impact_lua_host *host = impact_lua_get_host(L);
    const char *path = luaL_checkstring(L, 2);
    const bool plain = impact_lua_is_plain(path);
    if (host && host->confined && !plain)
        return quat_lua_error(L, "%s: the path must be a plain name without '/', got the string '%s'", what, path);
    if (host && plain) {
        if (!host->prepare(host->context, path, message, sizeof message)) return quat_lua_failure(L, message);
        path = lua_pushfstring(L, "%s/%s", host->directory, path);
    }
    if (write(run, tolerance, frame_rate, path, host ? host->quota : NULL, message, sizeof message) < 0)
        return quat_lua_failure(L, message);
    lua_pushboolean(L, true);
    if (message[0]) lua_pushstring(L, message);
    return message[0] ? 2 : 1;
}

static impact_status write_page(const impact_run *run, double tolerance, double frame_rate, const char *path,
                                impact_quota *quota, char *message, unsigned long size)
{
    (void)frame_rate;
    return impact_view_write(run, tolerance, path, quota, message, size);
}

static int run_gltf(lua_State *L) { return export_run(L, "gltf", impact_gltf_write, 3e-4); }
static int run_view(lua_State *L) { return export_run(L, "view", write_page, 1e-5); }

static int run_close(lua_State *L)
{
    impact_run **self = luaL_checkudata(L, 1, IMPACT_LUA_RUN);
    impact_run_close(*self);
    *self = NULL;
    return 0;
}

static int run_tostring(lua_State *L)
{
    impact_run *const *self = luaL_checkudata(L, 1, IMPACT_LUA_RUN);
    if (*self)
        lua_pushfstring(L, "run '%s' (%d bodies, %f s)", impact_run_name(*self), impact_run_body_count(*self),
                        impact_run_end(*self));
    else
        lua_pushliteral(L, "run (closed)");
    return 1;
}

void impact_lua_open_record(lua_State *L)
{
    static const luaL_Reg meta[] = {
        {"__gc", run_close}, {"__close", run_close}, {"__tostring", run_tostring}, {NULL, NULL}};
    static const luaL_Reg methods[] = {
        {"name", run_name},
        {"reason", run_reason},
        {"times", run_times},
        {"state", run_state},
        {"state_before", run_state_before},
        {"columns", run_columns},
        {"keys", run_keys},
        {"bodies", run_bodies},
        {"events", run_events},
        {"contacts", run_contacts},
        {"account", run_account},
        {"view", run_view},
        {"gltf", run_gltf},
        {"close", run_close},
        {NULL, NULL},
    };
    luaL_newmetatable(L, IMPACT_LUA_RUN);
    luaL_setfuncs(L, meta, 0);
    luaL_newlib(L, methods);
    lua_setfield(L, -2, "__index");
    lua_pop(L, 1);
    lua_pushcfunction(L, run_open);
    lua_setfield(L, -2, "open");
}
