/* SPDX-License-Identifier: MIT
 *
 * A scene between runs: event by event, what is held, pushes and states that a script sets, saves.
 */
#include "impact_scene.h"

#include <math.h>

/* ---- the script's laws, asked outside of a run ---- */

static void begin_calls(lua_State *L, impact_lua_scene *self)
{
    luaL_checkstack(L, 24, NULL);
    self->sample_slot = self->event_slot = self->progress_slot = 0;
    self->failed = self->stopped = false;
    lua_getiuservalue(L, 1, IMPACT_LUA_LAWS);
    self->laws_slot = lua_gettop(L);
    lua_pushnil(L);
    self->error_slot = lua_gettop(L);
    self->L = L;
}

/* An error of a law goes on from here; else any that the status tells. */
static void end_calls(lua_State *L, impact_lua_scene *self, impact_status status)
{
    self->L = NULL;
    if (self->failed) {
        lua_settop(L, self->error_slot);
        lua_error(L);
    }
    if (status >= 0) return;
    const char *why = impact_scene_message(self->scene);
    quat_lua_error(L, "%s", why[0] ? why : impact_status_string(status));
}

/* ---- event by event ---- */

/* step(t_max, options): the next event, or nil where none comes by t_max (the duration), and what run returns. */
static int scene_step(lua_State *L)
{
    impact_lua_scene *self = impact_lua_check_scene(L);
    impact_event event;
    const double t_max = lua_isnoneornil(L, 2) ? fmax(self->duration, impact_scene_time(self->scene))
                                               : quat_lua_arg_number(L, 2, "t_max", QUAT_LUA_NOT_NEGATIVE);
    lua_settop(L, 3);
    const int results = impact_lua_run(L, self, t_max, 3, &event);
    if (event.body1 < 0)
        lua_pushnil(L);
    else
        impact_lua_push_event(L, &event, event.phases);
    lua_insert(L, -results - 1);
    return results + 1;
}

static void push_held(lua_State *L, const impact_scene *scene, const impact_held *held)
{
    impact_body_def body1 = impact_default_body_def(), body2 = impact_default_body_def();
    impact_scene_body_def(scene, held->body1, &body1);
    impact_scene_body_def(scene, held->body2, &body2);
    lua_createtable(L, 0, 8);
    quat_lua_set_number(L, "t", held->t);
    quat_lua_set_string(L, "body1", body1.name);
    quat_lua_set_string(L, "body2", body2.name);
    quat_lua_set_string(L, "mode", impact_hold_name(held->mode));
    quat_lua_set_vec3(L, "point", held->point);
    quat_lua_set_vec3(L, "normal", held->normal);
    quat_lua_set_vec3(L, "force", held->force);
    quat_lua_set_vec3(L, "moment", held->moment);
}

/* held(): the contacts that are held now. */
static int scene_held(lua_State *L)
{
    impact_lua_scene *self = impact_lua_check_scene(L);
    begin_calls(L, self);
    const int count = impact_scene_held(self->scene, NULL, 0);
    end_calls(L, self, count < 0 ? (impact_status)count : IMPACT_OK);
    impact_held *held = lua_newuserdatauv(L, (size_t)(count + 1) * sizeof *held, 0);
    begin_calls(L, self);
    impact_scene_held(self->scene, held, count);
    end_calls(L, self, IMPACT_OK);
    lua_createtable(L, count, 0);
    for (int k = 0; k < count; k++) {
        push_held(L, self->scene, &held[k]);
        lua_rawseti(L, -2, k + 1);
    }
    return 1;
}

/* ---- changes ---- */

/* The state of the body that argument 2 names. */
static impact_sample named_state(lua_State *L, const impact_lua_scene *self)
{
    const char *name = luaL_checkstring(L, 2);
    impact_sample sample;
    if (impact_scene_body(self->scene, impact_scene_find(self->scene, name), &sample) < 0)
        quat_lua_error(L, "scene '%s' has no body '%s'", self->name, name);
    return sample;
}

/* set(body, {position=, orientation=, velocity=, omega=}): what is absent stays. */
static int scene_set(lua_State *L)
{
    static const char *const keys[] = {"position", "orientation", "velocity", "omega", NULL};
    impact_lua_scene *self = impact_lua_check_scene(L);
    impact_sample sample = named_state(L, self);
    const quat_lua_reader reader = quat_lua_read(L, 3, "state", NULL, keys);
    sample.position = quat_lua_get_vec3(&reader, "position", sample.position);
    sample.orientation = quat_lua_get_quat(&reader, "orientation", sample.orientation);
    sample.velocity = quat_lua_get_vec3(&reader, "velocity", sample.velocity);
    sample.omega = quat_lua_get_vec3(&reader, "omega", sample.omega);
    begin_calls(L, self);
    end_calls(L, self, impact_scene_set_state(self->scene, sample.body, &sample));
    return 0;
}

/* push(body, impulse, point): at the centre, unless a point is given. */
static int scene_push(lua_State *L)
{
    impact_lua_scene *self = impact_lua_check_scene(L);
    const impact_sample sample = named_state(L, self);
    const qvec3 impulse = quat_lua_arg_vec3(L, 3, "impulse");
    const qvec3 point = lua_isnoneornil(L, 4) ? sample.position : quat_lua_arg_vec3(L, 4, "point");
    begin_calls(L, self);
    end_calls(L, self, impact_scene_push(self->scene, sample.body, impulse, point));
    return 0;
}

/* ---- saving ---- */

/* save(): a string of bytes. */
static int scene_save(lua_State *L)
{
    impact_lua_scene *self = impact_lua_check_scene(L);
    size_t size = 0;
    begin_calls(L, self);
    end_calls(L, self, impact_scene_save(self->scene, NULL, &size));
    void *bytes = lua_newuserdatauv(L, size, 0);
    begin_calls(L, self);
    end_calls(L, self, impact_scene_save(self->scene, bytes, &size));
    lua_pushlstring(L, bytes, size);
    return 1;
}

/* load(bytes): goes on from there. */
static int scene_load(lua_State *L)
{
    impact_lua_scene *self = impact_lua_check_scene(L);
    size_t size;
    const char *bytes = luaL_checklstring(L, 2, &size);
    begin_calls(L, self);
    end_calls(L, self, impact_scene_load(self->scene, bytes, size));
    return 0;
}

void impact_lua_add_interaction(lua_State *L)
{
    static const luaL_Reg methods[] = {{"step", scene_step}, {"held", scene_held}, {"set", scene_set},
                                       {"push", scene_push}, {"save", scene_save}, {"load", scene_load},
                                       {NULL, NULL}};
    luaL_setfuncs(L, methods, 0);
}
