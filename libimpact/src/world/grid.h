/* SPDX-License-Identifier: MIT
 *
 * grid: which boxes overlap. A hierarchical hash grid: a box lies on the level whose cells are as long as its longest
 * side or up to twice that, in the one cell of its low corner; so that it reaches into the next cell at most, and a
 * query looks at the cells from one before its own low corner to its high one, on every level that is occupied. Where
 * those are more cells than the level has boxes, its boxes are looked through one by one. Internal.
 */
#ifndef IMP_GRID_H
#define IMP_GRID_H

#include "base/arena.h"

#include <stdint.h>

typedef struct imp_box {
    double low[3], high[3];
} imp_box;

/* All six at once, without a branch: a gas tells one box in ten. The sign of a difference is exact. */
static inline bool imp_boxes_overlap(const imp_box *a, const imp_box *b)
{
    double apart = a->low[0] - b->high[0];
    for (int k = 0; k < 3; k++) {
        const double above = a->low[k] - b->high[k], below = b->low[k] - a->high[k];
        apart = apart > above ? apart : above;
        apart = apart > below ? apart : below;
    }
    return apart <= 0;
}

/* One line of a processor's cache: a query looks at dozens of them. */
typedef struct imp_grid_entry {
    _Alignas(64) imp_box box;
    int level;          /* in the grid's list; -1: not in the grid */
    int next, previous; /* in its bucket */
    uint32_t cell;      /* the last ten bits of each of its three numbers */
} imp_grid_entry;

typedef struct imp_grid_place {
    int next, previous; /* on its level */
} imp_grid_place;

typedef struct imp_grid_level {
    int exponent; /* cells of 2^exponent m */
    double scale; /* 2^-exponent */
    int count, first;
} imp_grid_level;

typedef struct imp_grid {
    imp_arena *arena;
    imp_grid_entry *entries;
    imp_grid_place *places; /* of the entries */
    int count;
    int *buckets;
    unsigned bucket_mask;
    imp_grid_level *levels;
    int level_count, level_room;
    int *found; /* of the last query */
    int found_count, found_room;
} imp_grid;

impact_status imp_grid_open(imp_grid *grid, imp_arena *arena, int entries);

/* No entry is in it any more. */
void imp_grid_clear(imp_grid *grid);

/* Puts the entry where the box is, which is finite; takes it away from where it was. IMPACT_ENOMEM: it is then away. */
impact_status imp_grid_put(imp_grid *grid, int entry, const imp_box *box);

/* Lists in grid->found the entries whose boxes overlap this one, itself if it is in the grid too, in no order. */
impact_status imp_grid_query(imp_grid *grid, const imp_box *box);

#endif
