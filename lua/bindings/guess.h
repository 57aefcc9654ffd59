/* SPDX-License-Identifier: MIT
 *
 * arguments, inside: what a script's author probably meant by a key that is not known.
 */
#ifndef QUAT_LUA_GUESS_H
#define QUAT_LUA_GUESS_H

/* The one of the keys (NULL-terminated) that was probably meant: at most a third of its letters wrong, of a single
 * letter its repeats; NULL when none is near. */
const char *quat_lua_guess(const char *given, const char *const keys[]);

#endif
