/* SPDX-License-Identifier: MIT
 *
 * How a function of the script's stands in for a callback of C.
 */
#ifndef QUAT_LUA_CALL_H
#define QUAT_LUA_CALL_H

#include "quat_core.h"

/* A function of the script's while C asks it for vectors. It runs under lua_pcall, so that its errors do not pass
 * through the library: the first is kept on top of the stack until quat_lua_call_end raises it. */
typedef struct quat_lua_call {
    lua_State *L;
    int function; /* its place on the stack */
    int count;    /* vectors that it returns */
    bool failed;
} quat_lua_call;

/* Puts the function in the user value of the object at `object` on the stack. */
quat_lua_call quat_lua_call_begin(lua_State *L, int object, int count);
/* Calls it with n <= 2 numbers for the vectors d[]; false when it returns nil, or has failed. */
bool quat_lua_call_vectors(quat_lua_call *call, int n, const double x[], qvec3 d[]);
/* Raises the function's error, if there was one. */
void quat_lua_call_end(quat_lua_call *call);

#endif
