/* SPDX-License-Identifier: MIT
 *
 * The scene userdata, and the files that work on it: impact_scene.c (making it, asking it) stands on
 * impact_scene_read.c (its definition), impact_run.c (running it), impact_rows.c (what comes out) and impact_law.c
 * (forces of the script).
 */
#ifndef IMPACT_LUA_SCENE_H
#define IMPACT_LUA_SCENE_H

#include "impact_core.h"

#define IMPACT_LUA_SCENE "impact.scene"

/* The user values of a scene userdata. */
enum { IMPACT_LUA_DEFINITION = 1, IMPACT_LUA_LAWS = 2, IMPACT_LUA_HULLS = 3 };

/* The phases of events, each word for word once. */
typedef struct impact_lua_phases {
    char words[160];
} impact_lua_phases;

/* What scene:run{record=true} keeps. */
typedef struct impact_lua_rows {
    bool asked; /* some run was to keep rows */
    impact_sample *samples;
    size_t sample_count, sample_capacity;
    impact_event *events; /* their phases point nowhere: those of event i are phases[which[i]] */
    size_t event_count, event_capacity;
    unsigned *which;
    size_t which_capacity;
    impact_lua_phases *phases;
    size_t phases_count, phases_capacity;
} impact_lua_rows;

/* The places of an entry of the table of laws. The script sees the state; what is written into it at each call stands
 * beside it, so that the script cannot take it away. */
enum {
    IMPACT_LUA_LAW_FUNCTION = 1,
    IMPACT_LUA_LAW_STATE,
    IMPACT_LUA_LAW_POSITION,
    IMPACT_LUA_LAW_VELOCITY,
    IMPACT_LUA_LAW_OMEGA,
    IMPACT_LUA_LAW_ORIENTATION,
    IMPACT_LUA_LAW_WHERE,
    IMPACT_LUA_LAW_NAME,
    IMPACT_LUA_LAW_EDGE,
    IMPACT_LUA_LAW_SIZE = IMPACT_LUA_LAW_EDGE
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
    bool save_failed;
    char save_message[400];
    double t_end, t_told; /* of the run; of the last row */
    bool whole;           /* it is to its duration, or until all rests */
    int files_slot;       /* the names of the files of a run that ends early; nil without CSV */
    unsigned long samples_told;
    bool record, keeps_rows;
    bool has_csv;
    impact_recorder csv;
    impact_run_writer *writer; /* of all runs with record */
    impact_recorder keys;      /* over it */
    const char *reason;        /* why the last run ended, for the record; NULL: it failed, or there was none */
    const impact_lua_host *host;
} impact_lua_scene;

/* ---- impact_law.c ---- */

/* Pushes the entry of a custom force in the table of laws. The force's table is on top of the stack, its place below
 * it. */
void impact_lua_push_law(lua_State *L, const impact_force_def *force);
/* The force function that calls a script's law. */
impact_force_function impact_lua_call_law;
/* The edge function that calls a script's edge; NaN where that fails. */
impact_edge_function impact_lua_call_edge;
/* Keeps the error on top of the stack for the end of the run; false. */
bool impact_lua_script_fails(impact_lua_scene *self);

/* ---- impact_rows.c ---- */

/* Pushes {t=, body=, position=, orientation=, velocity=, omega=}. */
void impact_lua_push_sample(lua_State *L, const impact_sample *sample);
void impact_lua_push_energy(lua_State *L, const impact_energy *energy);
void impact_lua_push_event(lua_State *L, const impact_event *event, const char *phases);

/* False: out of memory. */
bool impact_lua_keep_sample(lua_State *L, impact_lua_rows *rows, const impact_sample *sample);
bool impact_lua_keep_event(lua_State *L, impact_lua_rows *rows, const impact_event *event);
void impact_lua_free_rows(lua_State *L, impact_lua_rows *rows);

/* {t=, x=, ... wz=}, columns of rows: begun, a row at a time, and put together on top of the stack; in between what is
 * on top stays there. */
void impact_lua_begin_columns(lua_State *L);
void impact_lua_add_columns(lua_State *L, const impact_sample *sample, lua_Integer row);
void impact_lua_end_columns(lua_State *L);
/* Pushes {t=, x=, ... wz=}, columns of the rows kept of one body; the list of the events kept. */
void impact_lua_push_track(lua_State *L, const impact_lua_rows *rows, int body);
void impact_lua_push_events(lua_State *L, const impact_lua_rows *rows);

/* ---- impact_scene_read.c ---- */

/* The definition in the table at index. What it points to stays on the stack, and must until the scene is made; laws:
 * the stack place of the table of laws, which is filled. */
impact_scene_def impact_lua_read_scene(lua_State *L, int index, impact_lua_scene *self, int laws);

/* ---- impact_report.c ---- */

/* Adds scene:report_rows to the methods on top of the stack; the layer makes scene:report of it. */
void impact_lua_add_report(lua_State *L);

/* ---- impact_scene.c ---- */

/* The scene at index 1; an error when it is closed or is running. */
impact_lua_scene *impact_lua_check_scene(lua_State *L);

/* ---- impact_interact.c ---- */

/* Adds step, held, set, push, save and load to the table of methods on top of the stack. */
void impact_lua_add_interaction(lua_State *L);

/* ---- impact_run.c ---- */

/* A name for files that stays in its folder. */
bool impact_lua_is_plain(const char *name);
/* Runs to t_end (NAN: to the duration, or until all rests), with the table of options at options_index: returns what
 * run returns to the script. The scene is at index 1. event, unless NULL: to the next event only, which goes there. */
int impact_lua_run(lua_State *L, impact_lua_scene *self, double t_end, int options_index, impact_event *event);

#endif
