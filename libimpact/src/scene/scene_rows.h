/* SPDX-License-Identifier: MIT
 *
 * scene_rows: the rows of the groups of a crowd, gathered apart and handed on in order of time. Internal.
 */
#ifndef IMP_SCENE_ROWS_H
#define IMP_SCENE_ROWS_H

#include <impact/record.h>
#include "base/arena.h"

typedef struct imp_row {
    double t;
    bool beside; /* an event, or a row beside one */
    bool is_event;
    int group, rank; /* rank: of a sample on the grid its body, else its place in its group */
    impact_sample sample;
    impact_event event; /* energies: of the group */
    char phases[96];
} imp_row;

/* The energy of a group at times of its own; between them it changes evenly. */
typedef struct imp_knot {
    double t, before, after;
} imp_knot;

typedef struct imp_rows {
    imp_arena *arena;
    imp_row *rows;
    int count, room, next; /* next: the first that is not handed on yet */
    bool failed;           /* out of memory */
} imp_rows;

/* The new last row, zeroed; NULL when there is no memory. */
imp_row *imp_rows_add(imp_rows *rows);
void imp_rows_free(imp_rows *rows);

/* Puts them in order of time: samples of the grid by body before events, events of one instant by group. energy[g],
 * energy_end[g]: of each of the groups at start and end; fills the events' energies with those of all groups together.
 */
impact_status imp_rows_arrange(imp_rows *rows, int groups, double start, double end, const double *energy,
                               const double *energy_end);

/* Hands them on; IMPACT_ESINK where the recorder refuses: the rest is kept for later. */
impact_status imp_rows_deliver(imp_rows *rows, const impact_recorder *recorder);

#endif
