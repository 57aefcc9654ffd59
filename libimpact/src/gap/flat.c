/* SPDX-License-Identifier: MIT */
#include "gap/flat.h"
#include <math.h>
#include <string.h>
#include "base/tolerances.h"

/* > 0 where p is left of the line from a to b: twice the area. */
static double turn_at(const double a[2], const double b[2], const double p[2])
{
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
}

static double beside(const double a[2], const double b[2], const double p[2])
{
    return turn_at(a, b, p) / hypot(b[0] - a[0], b[1] - a[1]);
}

void imp_flat_copy(imp_flat *to, const imp_flat *from)
{
    to->count = from->count;
    memcpy(to->p, from->p, (size_t)from->count * sizeof from->p[0]);
    memcpy(to->from, from->from, (size_t)from->count * sizeof from->from[0]);
}

static void put_corner(imp_flat *flat, double x, double y, short from)
{
    if (flat->count == IMP_FLAT_CORNERS) return;
    flat->p[flat->count][0] = x, flat->p[flat->count][1] = y;
    flat->from[flat->count++] = from;
}

typedef struct numbered {
    double p[2];
    short from;
} numbered;

static bool before(const numbered *a, const numbered *b)
{
    return a->p[0] < b->p[0] || (a->p[0] == b->p[0] && a->p[1] < b->p[1]);
}

/* By x, then y: few, and mostly in order. */
static void sort(numbered *at, int count)
{
    for (int i = 1; i < count; i++) {
        const numbered moving = at[i];
        int j = i;
        for (; j > 0 && before(&moving, &at[j - 1]); j--) at[j] = at[j - 1];
        at[j] = moving;
    }
}

/* Without those within slack of one before. */
static int distinct(numbered *at, int count, double slack)
{
    int kept = 0;
    for (int i = 0; i < count; i++) {
        bool known = false;
        for (int j = kept - 1; j >= 0 && at[i].p[0] - at[j].p[0] <= slack; j--)
            known = known || hypot(at[i].p[0] - at[j].p[0], at[i].p[1] - at[j].p[1]) <= slack;
        if (!known) at[kept++] = at[i];
    }
    return kept;
}

/* One chain of Andrew's algorithm onto the corners from `first` on. */
static int chain(const numbered *at, int count, bool back, int first, imp_flat *flat)
{
    int size = first;
    for (int i = 0; i < count; i++) {
        const numbered *next = &at[back ? count - 1 - i : i];
        while (size >= first + 2 && !(turn_at(flat->p[size - 2], flat->p[size - 1], next->p) > 0)) size--;
        memcpy(flat->p[size], next->p, sizeof next->p);
        flat->from[size++] = next->from;
    }
    return size;
}

static void leave_out(imp_flat *flat, int corner)
{
    flat->count--;
    for (int i = corner; i < flat->count; i++) {
        memcpy(flat->p[i], flat->p[i + 1], sizeof flat->p[i]);
        flat->from[i] = flat->from[i + 1];
    }
}

/* Corners within slack of the line through both beside them. */
static void straighten(imp_flat *flat, double slack)
{
    for (int i = 0; i < flat->count && flat->count > 2;) {
        const double *p = flat->p[(i + flat->count - 1) % flat->count], *q = flat->p[(i + 1) % flat->count];
        if (fabs(beside(p, q, flat->p[i])) <= slack)
            leave_out(flat, i), i = 0;
        else
            i++;
    }
}

void imp_flat_hull(imp_flat *flat, double slack)
{
    numbered at[IMP_FLAT_CORNERS];
    imp_flat made;
    for (int i = 0; i < flat->count; i++) {
        memcpy(at[i].p, flat->p[i], sizeof at[i].p);
        at[i].from = flat->from[i];
    }
    sort(at, flat->count);
    const int count = distinct(at, flat->count, slack);
    made.count = chain(at, count, false, 0, &made);
    if (made.count > 1) made.count = chain(at, count, true, made.count - 1, &made) - 1; /* the ends of both are one */
    straighten(&made, slack);
    imp_flat_copy(flat, &made);
}

/* What is left of the line, or by no more than slack right of it (Sutherland & Hodgman 1974); a corner that comes about
 * lies on the line, its `from` is -1. */
static void cut(imp_flat *flat, const double a[2], const double b[2], double slack)
{
    imp_flat part;
    part.count = 0;
    for (int i = 0; i < flat->count; i++) {
        const int next = (i + 1) % flat->count;
        const double *p = flat->p[i], *q = flat->p[next], at_p = beside(a, b, p), at_q = beside(a, b, q);
        if (at_p >= -slack) put_corner(&part, p[0], p[1], flat->from[i]);
        if ((at_p < -slack) == (at_q < -slack) || (flat->count == 2 && i == 1)) continue;
        const double share = fmax(0, fmin(1, at_p / (at_p - at_q)));
        put_corner(&part, p[0] + (q[0] - p[0]) * share, p[1] + (q[1] - p[1]) * share, -1);
    }
    imp_flat_copy(flat, &part);
}

/* Between both sides of a segment's line, and its ends. */
static void cut_to_segment(imp_flat *one, const double a[2], const double b[2], double slack)
{
    const double across[2] = {a[1] - b[1], b[0] - a[0]};
    const double a_up[2] = {a[0] + across[0], a[1] + across[1]}, b_up[2] = {b[0] + across[0], b[1] + across[1]};
    cut(one, a, b, slack);
    cut(one, b, a, slack);
    cut(one, a_up, a, slack);
    cut(one, b, b_up, slack);
}

static bool holds(const imp_flat *flat, const double p[2], double slack)
{
    if (flat->count == 1) return hypot(p[0] - flat->p[0][0], p[1] - flat->p[0][1]) <= slack;
    imp_flat point;
    point.count = 0;
    put_corner(&point, p[0], p[1], 0);
    if (flat->count == 2)
        cut_to_segment(&point, flat->p[0], flat->p[1], slack);
    else
        for (int i = 0; i < flat->count; i++) cut(&point, flat->p[i], flat->p[(i + 1) % flat->count], slack);
    return point.count > 0;
}

/* New corners that are the other's own get its number. */
static void name_corners(imp_flat *one, const imp_flat *other, double slack, int offset)
{
    for (int i = 0; i < one->count; i++)
        for (int j = 0; one->from[i] < 0 && j < other->count; j++)
            if (hypot(one->p[i][0] - other->p[j][0], one->p[i][1] - other->p[j][1]) <= slack)
                one->from[i] = (short)(other->from[j] + offset);
}

void imp_flat_clip(imp_flat *one, const imp_flat *other, double slack, int offset)
{
    if (other->count == 1 || (other->count == 2 && one->count > 2)) { /* what is smaller is clipped */
        imp_flat part;
        imp_flat_copy(&part, other);
        if (other->count == 1 && !holds(one, other->p[0], slack)) part.count = 0;
        if (other->count == 2)
            for (int i = 0; i < one->count; i++) cut(&part, one->p[i], one->p[(i + 1) % one->count], slack);
        for (int i = 0; i < part.count; i++)
            if (part.from[i] >= 0) part.from[i] = (short)(part.from[i] + offset);
        imp_flat_copy(one, &part);
        return;
    }
    if (other->count == 2)
        cut_to_segment(one, other->p[0], other->p[1], slack);
    else
        for (int i = 0; i < other->count && one->count > 0; i++)
            cut(one, other->p[i], other->p[(i + 1) % other->count], slack);
    name_corners(one, other, 2 * slack, offset);
}

/* Twice the area that goes with the corner. */
static double area_at(const imp_flat *flat, int corner)
{
    const int last = flat->count - 1;
    return turn_at(flat->p[corner > 0 ? corner - 1 : last], flat->p[corner], flat->p[corner < last ? corner + 1 : 0]);
}

/* Which goes of two corners whose areas are one but for rounding: that of the lower number, which is of its body; where
 * borders cross there is none, and what is there stays. */
static bool goes_first(const imp_flat *flat, int corner, double area, int other, double least)
{
    if (!(fabs(area - least) <= IMP_FLAT_ALIKE * least)) return area < least;
    return (unsigned short)flat->from[corner] < (unsigned short)flat->from[other];
}

void imp_flat_thin(imp_flat *flat, int most)
{
    while (flat->count > most) {
        int least = 0;
        double cost = area_at(flat, 0);
        for (int i = 1; i < flat->count; i++) {
            const double area = area_at(flat, i);
            if (goes_first(flat, i, area, least, cost)) cost = area, least = i;
        }
        leave_out(flat, least);
    }
}
