/* SPDX-License-Identifier: MIT
 *
 * arguments: how the Lua face reads what a script hands it. Shared by quat.core, quat.gsl and impact.core.
 *
 * To bind a room:
 *   1. quat_ROOM.c or impact_ROOM.c in lua/bindings, with one `void quat_lua_open_ROOM(lua_State *L)` (or
 * impact_lua_open_ROOM): the module's table is on top of the stack when it is called and when it returns; add your
 * functions to it with luaL_setfuncs.
 *   2. Name the file in lua/CMakeLists.txt and the opener in the list of quat_core.c or impact_core.c.
 *      A room that needs GSL goes to the module quat.gsl instead (quat_gsl.c), which quat.lua and the runner load
 * when a script first uses one of its names.
 *   3. Read with the functions below. Misuse raises an error that names the argument; an expected failure returns nil,
 * message (quat_lua_failure). Results go back with what results.h has.
 *   4. Sugar in Lua and the LuaLS annotations go to lua/layer/quat.lua or lua/layer/impact.lua.
 * Never let a Lua error pass through C code that is not ours (CVODE, GSL, libccd): call back with lua_pcall.
 */
#ifndef QUAT_LUA_ARGUMENTS_H
#define QUAT_LUA_ARGUMENTS_H

#include <stdbool.h>
#include <lauxlib.h>
#include <lua.h>
#include <quat/quat.h>
#include "results.h"

#if LUA_VERSION_NUM != 504
#error "the Lua face is written for Lua 5.4"
#endif

/* What a number must be; NaN never passes. */
typedef enum quat_lua_range {
    QUAT_LUA_FINITE,
    QUAT_LUA_POSITIVE,       /* > 0, finite */
    QUAT_LUA_NOT_NEGATIVE,   /* >= 0, finite */
    QUAT_LUA_FRACTION,       /* [0, 1] */
    QUAT_LUA_BELOW_ONE,      /* [0, 1) */
    QUAT_LUA_POSITIVE_OR_INF /* > 0, may be infinite */
} quat_lua_range;

/* ---- errors ---- */

/* Pushes "file:line: " of the innermost script code that is not one of our own Lua layers; "" when there is none. */
void quat_lua_where(lua_State *L);
/* Marks the calling Lua chunk as one of our own layers. A lua_CFunction: `core.layer()` on top of every layer. */
int quat_lua_layer(lua_State *L);
/* The same of a chunk by its name, as lua_Debug's source has it. */
void quat_lua_mark_layer(lua_State *L, const char *source);
/* no_function(name): an __index for the module of that name, which raises "no function 'boks' in impact (did you mean
 * 'box'?)". */
int quat_lua_no_function(lua_State *L);

/* Of the table on top, as a script is given it: a key that it has not is an error, "no field 'velocty' in the state of
 * a body (did you mean 'velocity'?)"; `owner` the last words. Keys that are there cost nothing. */
void quat_lua_seal(lua_State *L, const char *owner);
/* Raises "file:line: message". Never returns; `return quat_lua_error(...)`. */
int quat_lua_error(lua_State *L, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Returns nil, message to the script: `return quat_lua_failure(L, quat_status_string(status))`. */
int quat_lua_failure(lua_State *L, const char *message);

/* Runs work on the arguments on the stack with the collector at rest: no finaliser of the script's runs, and no string
 * of a table that is being read goes away. `return quat_lua_quietly(L, work)`. */
int quat_lua_quietly(lua_State *L, lua_CFunction work);

/* ---- arguments of functions, by position; name is the argument's name in the error ---- */

double quat_lua_arg_number(lua_State *L, int arg, const char *name, quat_lua_range range);
double quat_lua_arg_number_or(lua_State *L, int arg, const char *name, quat_lua_range range,
                              double fallback); /* nil or none */
lua_Integer quat_lua_arg_integer(lua_State *L, int arg, const char *name, lua_Integer least, lua_Integer most);
/* {x, y, z} or {x=, y=, z=}, all finite. */
qvec3 quat_lua_arg_vec3(lua_State *L, int arg, const char *name);
/* A quaternion userdata, {w, x, y, z} or {w=, x=, y=, z=}, all finite; not normalised. */
quat quat_lua_arg_quat(lua_State *L, int arg, const char *name);
/* Whether the value at index is such a vector, finite; and any value in words for an error, in `text`. */
bool quat_lua_is_vec3(lua_State *L, int index, qvec3 *v);
const char *quat_lua_describe(lua_State *L, int index, char *text, size_t size);
/* Raises "argument 'name' must be <wanted>, got <what it is>". */
int quat_lua_refuse(lua_State *L, int arg, const char *name, const char *wanted);
/* The index of the word in words (NULL-terminated). */
int quat_lua_arg_choice(lua_State *L, int arg, const char *name, const char *const words[]);

/* ---- tables of named values ---- */

/* A table being read. kind and name tell the script whose key is wrong: "body 'coin'". All pointers must outlive the
 * reader. */
typedef struct quat_lua_reader {
    lua_State *L;
    int index;         /* of the table, absolute */
    const char *kind;  /* "body" */
    const char *name;  /* "coin", or NULL */
    const char *where; /* "file:line: ", or NULL: where the script is now */
} quat_lua_reader;

/* Checks that the value at index is a table with no other keys than those in keys (NULL-terminated), and raises
 * "unknown key 'fricton' in body 'coin' (did you mean 'friction'?)" otherwise, with the keys it knows where no guess
 * comes to mind. The table's own `name`, when it is a string, becomes the reader's. */
quat_lua_reader quat_lua_read(lua_State *L, int index, const char *kind, const char *where, const char *const keys[]);
/* Raises "file:line: body 'coin': message". */
int quat_lua_reader_error(const quat_lua_reader *reader, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Pushes the key's value, without metamethods; its type. */
int quat_lua_push(const quat_lua_reader *reader, const char *key);
/* Each reads one key; an absent key (nil) gives the fallback. */
bool quat_lua_has(const quat_lua_reader *reader, const char *key);
double quat_lua_get_number(const quat_lua_reader *reader, const char *key, quat_lua_range range, double fallback);
lua_Integer quat_lua_get_integer(const quat_lua_reader *reader, const char *key, lua_Integer least, lua_Integer most,
                                 lua_Integer fallback);
bool quat_lua_get_boolean(const quat_lua_reader *reader, const char *key, bool fallback);
/* Without NUL bytes; lives as long as the table holds it. */
const char *quat_lua_get_string(const quat_lua_reader *reader, const char *key, const char *fallback);
int quat_lua_get_choice(const quat_lua_reader *reader, const char *key, const char *const words[], int fallback);
qvec3 quat_lua_get_vec3(const quat_lua_reader *reader, const char *key, qvec3 fallback);
quat quat_lua_get_quat(const quat_lua_reader *reader, const char *key, quat fallback);
/* Raises "body 'coin': mass is missing" when the key is absent. */
void quat_lua_need(const quat_lua_reader *reader, const char *key);

#endif
