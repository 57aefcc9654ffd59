/* SPDX-License-Identifier: MIT
 *
 * scene_rows: the rows of the groups of a crowd, gathered apart and handed on in order of time. Internal.
 */
#ifndef IMPACT_SCENE_ROWS_H
#define IMPACT_SCENE_ROWS_H

#include <impact/record.h>

typedef struct impact_row {
    double t;
    bool beside; /* an event, or a row beside one */
    bool is_event;
    int group, rank; /* rank: of a sample on the grid its body, else its place in its group */
    impact_sample sample;
    impact_event event; /* energies: of the group */
    char phases[96];
} impact_row;

/* The energy of a group at times of its own; between them it changes evenly. */
typedef struct impact_knot {
    double t, before, after;
} impact_knot;

typedef struct impact_rows {
    impact_row *rows;
    int count, room, next; /* next: the first that is not handed on yet */
    bool failed;           /* out of memory */
} impact_rows;

/* The new last row, zeroed; NULL when there is no memory. */
impact_row *impact_rows_add(impact_rows *rows);
void impact_rows_free(impact_rows *rows);

/* Puts them in order of time: samples of the grid by body before events, events of one instant by group. energy[g],
 * energy_end[g]: of each of the groups at start and end; fills the events' energies with those of all groups together.
 */
impact_status impact_rows_arrange(impact_rows *rows, int groups, double start, double end, const double *energy,
                                  const double *energy_end);

/* Hands them on; IMPACT_ESINK where the recorder refuses: the rest is kept for later. */
impact_status impact_rows_deliver(impact_rows *rows, const impact_recorder *recorder);

#endif
