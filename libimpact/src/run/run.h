/* SPDX-License-Identifier: MIT
 *
 * run: the tables of a recorded run, as its writer and its reader agree on them. Internal.
 */
#ifndef IMP_RUN_H
#define IMP_RUN_H

#include <impact/run.h>
#include "base/arena.h"
#include "run/text.h"

#define IMP_RUN_FORMAT "impact-run"

enum { IMP_RUN_VERSION = 1, IMP_RUN_ALIGNMENT = 8, IMP_RUN_SEAL = 8 };

enum { IMP_RUN_KEYS, IMP_RUN_EVENTS, IMP_RUN_CONTACTS, IMP_RUN_ACCOUNT, IMP_RUN_TABLES };

enum {
    IMP_KEY_COLUMNS = 21,
    IMP_EVENT_COLUMNS = 19,
    IMP_CONTACT_COLUMNS = 13,
    IMP_ACCOUNT_COLUMNS = 8,
    IMP_RUN_MOST_COLUMNS = IMP_KEY_COLUMNS
};

typedef struct imp_run_table {
    const char *name;
    int columns;
    const char *column[IMP_RUN_MOST_COLUMNS];
} imp_run_table;

extern const imp_run_table imp_run_tables[IMP_RUN_TABLES];

extern const char *const imp_run_shapes[IMPACT_SHAPE_KINDS]; /* their names, by kind */

/* The key as a row of its table. */
void imp_run_key_row(const impact_key *key, double row[IMP_KEY_COLUMNS]);

/* The last IMP_RUN_SEAL bytes of a record, the low one first: CRC-32 (ISO 3309, zlib's crc32) of all before them, which
 * any one bit, byte or run of 32 bits that changed gives away, and all else but one time in 2^32. */
void imp_run_seal(imp_text *record);
bool imp_run_is_sealed(const char *bytes, size_t size);

/* Writes a file that is whole or not there: IMPACT_ESINK or IMPACT_ENOMEM, with a message. What an
 * open file takes comes from the arena, and goes back. */
impact_status imp_file_save(imp_arena *arena, const char *path, const void *bytes, size_t size, impact_quota *quota,
                            char *message, unsigned long message_size);

#endif
