/* SPDX-License-Identifier: MIT
 *
 * out_file: a file that has its name only when it is whole. Where the system can, it has none before (Linux: O_TMPFILE,
 * linkat), so that nothing is left of a process that is killed; elsewhere it stands under "PATH.part". Internal.
 */
#ifndef IMP_OUT_FILE_H
#define IMP_OUT_FILE_H

#include <impact/record.h>
#include <stdio.h>
#include "base/arena.h"

typedef struct imp_out_file {
    FILE *file;          /* NULL: not open */
    int descriptor;      /* a second one, that outlives `file`; where it has no name yet */
    char *path, *part;   /* to be; before, or on the way there */
    bool nameless;       /* it does not stand under `part` */
    impact_quota *quota; /* may be NULL */
} imp_out_file;

/* False, with errno: it cannot be written. */
bool imp_out_open(imp_out_file *f, imp_arena *arena, const char *path, impact_quota *quota);
/* False, with errno: EDQUOT where the quota is at its end, and nothing of it was written then. */
bool imp_out_put(imp_out_file *f, const char *text, size_t size);
/* Writes what is buffered and ends writing. trim: what cannot be written is left out, to the end of the last line that
 * stands whole. False, with errno: not all was written. */
bool imp_out_finish(imp_out_file *f, bool trim);
/* After imp_out_finish: gives it a name, in place of what had it. False, with errno. */
bool imp_out_give_name(imp_out_file *f, const char *path);
/* Closes it; without a name it is gone. */
void imp_out_close(imp_out_file *f);

#endif
