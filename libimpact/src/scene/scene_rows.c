/* SPDX-License-Identifier: MIT */
#include "scene/scene_rows.h"

#include <stdlib.h>

imp_row *imp_rows_add(imp_rows *rows)
{
    imp_row *more = imp_arena_grow(rows->arena, rows->rows, &rows->room, rows->count + 1, sizeof *more);
    rows->failed = rows->failed || !more;
    if (!more) return NULL;
    rows->rows = more;
    imp_row *row = &rows->rows[rows->count++];
    *row = (imp_row){0};
    return row;
}

void imp_rows_free(imp_rows *rows)
{
    imp_arena_give(rows->arena, rows->rows);
    *rows = (imp_rows){.arena = rows->arena};
}

static int in_order(const void *a, const void *b)
{
    const imp_row *x = a, *y = b;
    if (x->t != y->t) return x->t > y->t ? 1 : -1;
    if (x->beside != y->beside) return x->beside ? 1 : -1;
    if (x->beside && x->group != y->group) return (x->group > y->group) - (x->group < y->group);
    return (x->rank > y->rank) - (x->rank < y->rank);
}

static double between(const imp_knot *a, const imp_knot *b, double t)
{
    if (!(b->t > a->t)) return a->after;
    return a->after + (b->before - a->after) * ((t - a->t) / (b->t - a->t));
}

/* Where each group stands on the way through the rows: the event behind it and the one ahead. */
typedef struct place {
    imp_knot last, next;
} place;

/* The group's next event from row `from` on, or its end. */
static imp_knot next_knot(const imp_rows *rows, int group, int from, double end, double energy_end)
{
    for (int k = from; k < rows->count; k++) {
        const imp_row *row = &rows->rows[k];
        if (row->is_event && row->group == group)
            return (imp_knot){row->t, row->event.energy_before, row->event.energy_after};
    }
    return (imp_knot){end, energy_end, energy_end};
}

impact_status imp_rows_arrange(imp_rows *rows, int groups, double start, double end, const double *energy,
                               const double *energy_end)
{
    if (rows->failed) return IMPACT_ENOMEM;
    place *places = imp_arena_take(rows->arena, (size_t)groups, sizeof *places);
    if (!places) return IMPACT_ENOMEM;
    if (rows->count > 0) qsort(rows->rows, (size_t)rows->count, sizeof *rows->rows, in_order);
    for (int g = 0; g < groups; g++)
        places[g] = (place){{start, energy[g], energy[g]}, next_knot(rows, g, 0, end, energy_end[g])};
    for (int k = 0; k < rows->count; k++) {
        imp_row *row = &rows->rows[k];
        if (!row->is_event) continue;
        place *own = &places[row->group];
        own->last = own->next;
        own->next = next_knot(rows, row->group, k + 1, end, energy_end[row->group]);
        double others = 0;
        for (int g = 0; g < groups; g++)
            if (g != row->group) others += between(&places[g].last, &places[g].next, row->t);
        row->event.energy_before += others;
        row->event.energy_after += others;
    }
    imp_arena_give(rows->arena, places);
    return IMPACT_OK;
}

impact_status imp_rows_deliver(imp_rows *rows, const impact_recorder *recorder)
{
    for (; recorder && rows->next < rows->count; rows->next++) {
        imp_row *row = &rows->rows[rows->next];
        row->event.phases = row->phases;
        const bool taken = row->is_event ? !recorder->event || recorder->event(recorder->context, &row->event)
                                         : !recorder->sample || recorder->sample(recorder->context, &row->sample);
        if (taken) continue;
        rows->next++;
        return IMPACT_ESINK;
    }
    rows->count = rows->next = 0;
    return IMPACT_OK;
}
