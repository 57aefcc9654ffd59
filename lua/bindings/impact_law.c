/* SPDX-License-Identifier: MIT
 *
 * The laws of custom forces: functions of the script, called from inside CVODE. Each call is protected: an error is
 * kept, and the run stops in order.
 */
#include "impact_scene.h"

#include <stdio.h>

void impact_lua_push_law(lua_State *L, const impact_force_def *force)
{
    const int table = lua_gettop(L);
    lua_createtable(L, IMPACT_LUA_LAW_SIZE, 0);
    lua_pushliteral(L, "law");
    lua_rawget(L, table);
    lua_rawseti(L, -2, IMPACT_LUA_LAW_FUNCTION);
    lua_newtable(L);
    quat_lua_seal(L, "the body of a law");
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
    lua_pushliteral(L, "edge");
    lua_rawget(L, table);
    lua_rawseti(L, -2, IMPACT_LUA_LAW_EDGE);
}

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
    qvec3 v = {0, 0, 0};
    char got[120];
    if (lua_isnil(L, index) || quat_lua_is_vec3(L, index, &v)) return v;
    lua_rawgeti(L, 2, IMPACT_LUA_LAW_WHERE);
    lua_rawgeti(L, 2, IMPACT_LUA_LAW_NAME);
    lua_pushfstring(L, "%sforce '%s': the %s must be a vector {x, y, z} of finite numbers, got %s", lua_tostring(L, -2),
                    lua_tostring(L, -1), what, quat_lua_describe(L, index, got, sizeof got));
    lua_error(L);
    return v;
}

/* Pushes the body as the script sees it. The law's entry is at index 2. */
static int push_state(lua_State *L, const law_call *call)
{
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
    return state;
}

/* Protected: (law_call *, the law's entry) */
static int call_law(lua_State *L)
{
    const law_call *call = lua_touserdata(L, 1);
    const int state = push_state(L, call);
    lua_rawgeti(L, 2, IMPACT_LUA_LAW_FUNCTION);
    lua_pushnumber(L, call->t);
    lua_pushvalue(L, state);
    lua_call(L, 2, 2);
    const int result = lua_gettop(L) - 1;
    *call->force = returned_vec3(L, result, "force");
    *call->torque = returned_vec3(L, result + 1, "torque");
    return 0;
}

/* Protected: (law_call *, the law's entry, double *) */
static int call_edge(lua_State *L)
{
    const law_call *call = lua_touserdata(L, 1);
    double *value = lua_touserdata(L, 3);
    const int state = push_state(L, call);
    lua_rawgeti(L, 2, IMPACT_LUA_LAW_EDGE);
    lua_pushnumber(L, call->t);
    lua_pushvalue(L, state);
    lua_call(L, 2, 1);
    *value = lua_type(L, -1) == LUA_TNUMBER ? lua_tonumber(L, -1) : NAN;
    if (isfinite(*value)) return 0;
    char got[40];
    if (lua_type(L, -1) == LUA_TNUMBER)
        snprintf(got, sizeof got, "%g", positive_nan(*value));
    else
        snprintf(got, sizeof got, "a %s", luaL_typename(L, -1));
    lua_rawgeti(L, 2, IMPACT_LUA_LAW_WHERE);
    lua_rawgeti(L, 2, IMPACT_LUA_LAW_NAME);
    lua_pushfstring(L, "%sforce '%s': the edge must be a finite number, got %s", lua_tostring(L, -2),
                    lua_tostring(L, -1), got);
    return lua_error(L);
}

bool impact_lua_script_fails(impact_lua_scene *self)
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
    return impact_lua_script_fails(self);
}

double impact_lua_call_edge(double t, const impact_sample *body, void *context)
{
    const impact_lua_law *law = context;
    impact_lua_scene *self = law->owner;
    lua_State *L = self->L;
    double value = NAN;
    impact_body_def def = impact_default_body_def();
    if (!L || self->failed || !lua_checkstack(L, 8) || impact_scene_body_def(self->scene, body->body, &def) < 0)
        return NAN;
    law_call call = {t,    body->name, def.mass, &body->position, &body->velocity, &body->omega, &body->orientation,
                     NULL, NULL};
    lua_pushcfunction(L, call_edge);
    lua_pushlightuserdata(L, &call);
    lua_rawgeti(L, self->laws_slot, law->index);
    lua_pushlightuserdata(L, &value);
    if (lua_pcall(L, 3, 0, 0) != LUA_OK) impact_lua_script_fails(self);
    return value;
}
