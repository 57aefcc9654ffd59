/* SPDX-License-Identifier: MIT
 *
 * impact.core's rooms: each adds its functions to the table on top of the stack.
 */
#ifndef IMPACT_LUA_CORE_H
#define IMPACT_LUA_CORE_H

#include <impact/impact.h>
#include "arguments.h"

/* The metatable name of a shape userdata, which holds one `impact_shape`. */
#define IMPACT_LUA_SHAPE "impact.shape"

IMPACT_API int luaopen_impact_core(lua_State *L);

void impact_lua_open_shape(lua_State *L);
void impact_lua_open_faces(lua_State *L); /* after impact_lua_open_shape */
void impact_lua_open_gap(lua_State *L);
void impact_lua_open_body(lua_State *L);
void impact_lua_open_force(lua_State *L);
void impact_lua_open_scene(lua_State *L);
void impact_lua_open_collide(lua_State *L);
void impact_lua_open_arguments(lua_State *L);
void impact_lua_open_record(lua_State *L);

/* Pushes what a polyhedron has beside other shapes: vertices, faces, dropped, center, axes; false for another key. */
bool impact_lua_push_hull_value(lua_State *L, const impact_hull *hull, const char *key);

/* Pushes a userdata that holds the hull (NULL: to be filled) until it is collected. */
impact_hull **impact_lua_push_hull(lua_State *L, const impact_hull *hull);

/* Pushes a shape userdata, which holds its hull. */
void impact_lua_push_shape(lua_State *L, const impact_shape *shape);

/* ---- who runs the scripts ---- */

/* Set by a program that runs scripts; absent in a stock interpreter. */
typedef struct impact_lua_host {
    const char *directory; /* scene:run{csv="name"} writes in here */
    bool confined;         /* and csv takes plain names only */
    /* Makes the folder for NAME.csv and NAME_events.csv; false with a message. */
    bool (*prepare)(void *context, const char *name, char *message, size_t size);
    bool (*progress)(void *context, double t, double t_end); /* false: the run fails */
    /* A run ended early, at t of t_end; files: where its rows are ("a.csv and b.csv"), or "". */
    void (*ended_early)(void *context, double t, double t_end, const char *files);
    /* Saves the scene: at the time save_at, and, at_time false, after an event when it is due; false with a message.
     * NULL: none is to be saved. */
    bool (*save)(void *context, impact_scene *scene, bool at_time, char *message, size_t size);
    double save_at;              /* s; NaN: at no time */
    bool checkpoints;            /* save is asked after each event */
    bool *ran;                   /* set by every run; NULL: nobody asks */
    impact_quota *quota;         /* of the CSV files; NULL: none */
    impact_allocator *allocator; /* of the scenes and CSV files; NULL: malloc */
    void *context;
} impact_lua_host;

/* host must outlive the state. */
void impact_lua_set_host(lua_State *L, const impact_lua_host *host);
/* NULL when there is none. */
const impact_lua_host *impact_lua_get_host(lua_State *L);

/* ---- definitions that a script makes before the scene ---- */

/* Makes the table at arg a checked definition of the kind: gives it the metatable and keeps its position for later
 * errors. */
void impact_lua_mark(lua_State *L, int arg, const char *metatable);
/* Whether the value at index was so marked. */
bool impact_lua_is_marked(lua_State *L, int index, const char *metatable);
/* Pushes the "file:line: " where the table at index was made, or nil; returns the string or NULL. */
const char *impact_lua_push_position(lua_State *L, int index);

/* Read a definition over the library's defaults. The strings in *def live as long as the table. */
void impact_lua_read_body(lua_State *L, int index, const char *where, impact_body_def *def);
/* The kinds' metatables decide; a custom force's function and context stay unset. Raises when it is no force; item
 * names it. */
/* Whether the value at index was made with impact.wind, impact.attraction or impact.force. */
bool impact_lua_is_force(lua_State *L, int index);
void impact_lua_read_force(lua_State *L, int index, const char *where, const char *item, impact_force_def *def);
/* The switches of a custom force at index, as many as its definition says; they live as long as the value pushed. */
const double *impact_lua_push_switches(lua_State *L, int index, const char *where, const impact_force_def *def);

#endif
