/* SPDX-License-Identifier: MIT
 *
 * The scene userdata, shared by impact_scene.c (making it, asking it) and impact_run.c (running it).
 */
#ifndef IMPACT_LUA_SCENE_H
#define IMPACT_LUA_SCENE_H

#include "impact_core.h"

#define IMPACT_LUA_SCENE "impact.scene"

/* The user values of a scene userdata. */
enum { IMPACT_LUA_DEFINITION = 1, IMPACT_LUA_LAWS = 2 };

/* An event with its words copied. */
typedef struct impact_lua_event {
    impact_event event; /* its phases point nowhere: see below */
    char phases[160];
} impact_lua_event;

/* What scene:run{record=true} keeps. */
typedef struct impact_lua_rows {
    impact_sample *samples;
    size_t sample_count, sample_capacity;
    impact_lua_event *events;
    size_t event_count, event_capacity;
} impact_lua_rows;

/* The places of an entry of the table of laws. The script sees the state; what is written into it at each call stands beside it, so
 * that the script cannot take it away. */
enum {
    IMPACT_LUA_LAW_FUNCTION = 1,
    IMPACT_LUA_LAW_STATE,
    IMPACT_LUA_LAW_POSITION,
    IMPACT_LUA_LAW_VELOCITY,
    IMPACT_LUA_LAW_OMEGA,
    IMPACT_LUA_LAW_ORIENTATION,
    IMPACT_LUA_LAW_WHERE,
    IMPACT_LUA_LAW_NAME,
    IMPACT_LUA_LAW_SIZE = IMPACT_LUA_LAW_NAME
};

/* The context of one custom force. */
typedef struct impact_lua_law {
    struct impact_lua_scene *owner;
    int index; /* in the table of laws */
} impact_lua_law;

typedef struct impact_lua_scene {
    impact_scene *scene;
    char name[64];
    double duration;
    int body_count;
    impact_lua_rows rows;

    /* Only while it runs; the slots are absolute places on L's stack, 0 when there is none. */
    lua_State *L;
    int laws_slot, sample_slot, event_slot, progress_slot, error_slot;
    bool failed;  /* a function of the script raised an error; it is at error_slot */
    bool stopped; /* a function of the script answered false */
    bool csv_failed, record_failed, ended_by_host;
    int csv_errno;
    double t_end;
    unsigned long samples_told;
    bool record;
    bool has_csv;
    impact_recorder csv;
    const impact_lua_host *host;
} impact_lua_scene;

/* The scene at index 1; an error when it is none or is running. */
impact_lua_scene *impact_lua_check_scene(lua_State *L);

/* The force function that calls a script's law. */
impact_force_function impact_lua_call_law;

/* run(options), run_to(t, options), track(body), events() */
int impact_lua_scene_run(lua_State *L);
int impact_lua_scene_run_to(lua_State *L);
int impact_lua_scene_track(lua_State *L);
int impact_lua_scene_events(lua_State *L);
void impact_lua_free_rows(lua_State *L, impact_lua_rows *rows);

/* Pushes {t=, body=, position=, orientation=, velocity=, omega=}. */
void impact_lua_push_sample(lua_State *L, const impact_sample *sample);

#endif
