/* SPDX-License-Identifier: MIT */
#include "run/rows.h"

#include <string.h>

enum { FIRST_ROOM = 16, MOST_ROOM = 16384 }; /* rows of a piece; each has twice the room of the last */

static bool add_piece(imp_rows *rows, imp_arena *arena)
{
    const long before = rows->last ? rows->last->room : FIRST_ROOM / 2;
    const long room = before < MOST_ROOM ? 2 * before : MOST_ROOM;
    const size_t size = sizeof(double) * (size_t)(room * rows->width);
    imp_rows_piece *piece = imp_arena_take_unset(arena, 1, sizeof *piece + size);
    if (!piece) return false;
    *piece = (imp_rows_piece){.room = room};
    *(rows->last ? &rows->last->next : &rows->first) = piece;
    rows->last = piece;
    return true;
}

bool imp_rows_add(imp_rows *rows, imp_arena *arena, const double *values)
{
    if ((!rows->last || rows->last->used == rows->last->room) && !add_piece(rows, arena)) return false;
    memcpy(rows->last->values + rows->last->used * rows->width, values, sizeof *values * (size_t)rows->width);
    rows->last->used++;
    rows->count++;
    return true;
}

void imp_rows_free(imp_rows *rows, imp_arena *arena)
{
    for (imp_rows_piece *piece = rows->first, *next; piece; piece = next) {
        next = piece->next;
        imp_arena_give(arena, piece);
    }
    *rows = (imp_rows){.width = rows->width};
}

const double *imp_rows_next(const imp_rows *rows, imp_rows_cursor *at)
{
    if (at->piece && at->row == at->piece->used) *at = (imp_rows_cursor){at->piece->next, 0};
    return at->piece ? at->piece->values + at->row++ * rows->width : NULL;
}
