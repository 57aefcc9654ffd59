/* SPDX-License-Identifier: MIT
 *
 * playground: scripts in a page. One at a time.
 */
#ifndef PLAYGROUND_H
#define PLAYGROUND_H

enum { PLAYGROUND_KINDS = 2 };

/* Runs a script; values: lines NAME=NUMBER for what it may have as its arguments. 0, or 1: it failed, and the answer
 * says why. */
int playground_run(const char *name, const char *source, const char *values);
/* Of the last run, until the next: JSON (playground.lua), or the error's words. */
const char *playground_answer(void);
/* Of the last run, until the next: 0 the record, 1 its page, as files have them; NULL, 0: none. */
const char *playground_bytes(int kind);
unsigned long playground_size(int kind);

#endif
