/* SPDX-License-Identifier: MIT
 *
 * run: a recorded run, in one file or in memory. What a viewer, an exporter or a figure needs of a run stands in it:
 * bodies, keys from which every state follows (at any t, between any events), events, held contacts, the energy
 * account. The format: docs/run.md.
 */
#ifndef IMPACT_RUN_H
#define IMPACT_RUN_H

#include <stddef.h>
#include "record.h"
#include "scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- writing ---- */

typedef struct impact_run_writer impact_run_writer;

/* A writer for the next run of the scene, whose memory it takes and which must outlive it. message (may be NULL) says
 * what is wrong. IMPACT_ENOMEM. */
IMPACT_API impact_status impact_run_create(const impact_scene *scene, impact_run_writer **writer, char *message,
                                           unsigned long message_size);
/* A recorder over it (no progress function); valid until the writer is destroyed. A sink refuses when the memory is
 * out. */
IMPACT_API void impact_run_fill_recorder(impact_run_writer *writer, impact_recorder *recorder, size_t struct_size);
IMPACT_INLINE impact_recorder impact_run_recorder(impact_run_writer *writer)
{
    impact_recorder recorder;
    impact_run_fill_recorder(writer, &recorder, sizeof recorder);
    return recorder;
}
/* The record so far, as a file has it; valid until the next such call or the writer's end. reason: why the run ended,
 * in a word or two. IMPACT_ENOMEM. */
IMPACT_API impact_status impact_run_bytes(impact_run_writer *writer, const char *reason, const void **bytes,
                                          size_t *size);
/* The same into a file, which is whole or not there. quota: what may be written still; NULL: no limit. IMPACT_ESINK,
 * with a message. */
IMPACT_API impact_status impact_run_save(impact_run_writer *writer, const char *reason, const char *path,
                                         impact_quota *quota, char *message, unsigned long message_size);
IMPACT_API void impact_run_discard(impact_run_writer *writer); /* NULL is fine */

/* ---- reading ---- */

typedef struct impact_run impact_run;

/* Opens a record; nothing in it is trusted: IMPACT_EARGUMENT, with a message, when it is no record, is newer than this
 * program or is damaged (any bit: it ends with a sum; and offsets, counts, order of time, numbers that are not finite,
 * orientations that are not unit).
 * IMPACT_ESINK: the file cannot be read. allocator: of all its memory (copied; NULL: malloc); IMPACT_ENOMEM. *run is
 * NULL on failure. */
IMPACT_API impact_status impact_run_open(const char *path, const impact_allocator *allocator, impact_run **run,
                                         char *message, unsigned long message_size);
/* The same of bytes, which are copied. name stands for the path in messages. */
IMPACT_API impact_status impact_run_read(const void *bytes, size_t size, const char *name,
                                         const impact_allocator *allocator, impact_run **run, char *message,
                                         unsigned long message_size);
IMPACT_API void impact_run_close(impact_run *run); /* NULL is fine */

/* What it was read from, byte for byte; valid until it is closed, as all strings below are. */
IMPACT_API const void *impact_run_contents(const impact_run *run, size_t *size);

IMPACT_API const char *impact_run_name(const impact_run *run);   /* the scene's */
IMPACT_API const char *impact_run_reason(const impact_run *run); /* why it ended */
IMPACT_API double impact_run_begin(const impact_run *run);       /* s: the first time there is a state of, and */
IMPACT_API double impact_run_end(const impact_run *run);         /* the last */
IMPACT_API qvec3 impact_run_gravity(const impact_run *run);
IMPACT_API double impact_run_tolerance(const impact_run *run); /* of its keys: see impact_scene_def */

IMPACT_API int impact_run_body_count(const impact_run *run);
IMPACT_API int impact_run_find(const impact_run *run, const char *body); /* index, or -1 */
/* The body as it was defined; position, orientation and velocities are those of its first key, or its surface's where
 * it is static. def->struct_size is to be set: begin with impact_default_body_def(). IMPACT_EARGUMENT when it is not,
 * or when there is no such body. */
IMPACT_API impact_status impact_run_body(const impact_run *run, int body, impact_body_def *def);

/* The state at t, exact to the record's tolerance: of two states at the time of an event the one after it, or before
 * it. Of a static body: where it stands, and no velocity. IMPACT_EARGUMENT: t outside of the run (or NaN), or no such
 * body. */
IMPACT_API impact_status impact_run_state(const impact_run *run, int body, double t, impact_sample *state);
IMPACT_API impact_status impact_run_state_before(const impact_run *run, int body, double t, impact_sample *state);

/* Keys of one body, rows of the whole run; by number, from 0, in order of time. IMPACT_EARGUMENT when there is none. */
IMPACT_API long impact_run_key_count(const impact_run *run, int body);
IMPACT_API impact_status impact_run_key(const impact_run *run, int body, long number, impact_key *key);
IMPACT_API long impact_run_event_count(const impact_run *run);
IMPACT_API impact_status impact_run_event(const impact_run *run, long number, impact_event *event);
IMPACT_API long impact_run_held_count(const impact_run *run);
IMPACT_API impact_status impact_run_held(const impact_run *run, long number, impact_held *held);
IMPACT_API long impact_run_account_count(const impact_run *run);
/* start: of the first row. */
IMPACT_API impact_status impact_run_account(const impact_run *run, long number, double *t, impact_energy *energy);

#ifdef __cplusplus
}
#endif

#endif
