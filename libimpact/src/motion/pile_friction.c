/* SPDX-License-Identifier: MIT
 *
 * Where the friction of a face acts. Its points bear the pressure of all of it, N in all, and what they do to what
 * slides without turning is what the face does: mu N at the centre of pressure. Against turning about its centre a face
 * that is pressed evenly has mu N times the mean distance from there, where its corners have mu N times theirs, 1.85
 * times as much of a square. So friction acts not at the corners but nearer to the centre of pressure, by
 *
 *     mean distance / mean distance of the points:   a square (sqrt 2 + asinh 1)/(3 sqrt 2), a disc 2/3, a line 1/2
 *
 * of their way: sliding is as it was, turning right, and what does both off by as much as four places differ from all
 * (docs/faces.md). The centre of pressure is that of the reactions themselves, which are looked for anew with it.
 */
#include "base/tolerances.h"
#include "motion/pile_contacts.h"

/* A pair's points in the plane of the contact. */
typedef struct flat_points {
    int count;
    double x[IMP_POINTS + 1][2], angle[IMP_POINTS + 1];
} flat_points;

static void mean_of(const flat_points *flat, double mean[2])
{
    mean[0] = mean[1] = 0;
    for (int i = 0; i < flat->count; i++)
        for (int k = 0; k < 2; k++) mean[k] += flat->x[i][k] / flat->count;
}

/* Grows with the angle of (x, y), which it is not: from -2 to 2. */
static double round_angle(double x, double y)
{
    const double along = x / (fabs(x) + fabs(y) + IMP_NOT_ZERO);
    return y < 0 ? along - 1 : 1 - along;
}

/* Round their mean, counter-clockwise. */
static void sort_round(flat_points *flat)
{
    double mean[2];
    mean_of(flat, mean);
    for (int i = 0; i < flat->count; i++) {
        const double x = flat->x[i][0], y = flat->x[i][1], angle = round_angle(x - mean[0], y - mean[1]);
        int k = i;
        for (; k > 0 && flat->angle[k - 1] > angle; k--) {
            flat->angle[k] = flat->angle[k - 1];
            flat->x[k][0] = flat->x[k - 1][0], flat->x[k][1] = flat->x[k - 1][1];
        }
        flat->angle[k] = angle;
        flat->x[k][0] = x, flat->x[k][1] = y;
    }
}

/* Twice the triangle that the side from a to b has with o. */
static double twice_area(const double o[2], const double a[2], const double b[2])
{
    return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}

/* The polygon's area and its centre; of a line they are roundings'. */
static double area_of(const flat_points *flat, double center[2])
{
    double twice = 0, sum[2] = {0, 0};
    for (int i = 0; i < flat->count; i++) {
        const double *o = flat->x[0], *a = flat->x[i], *b = flat->x[(i + 1) % flat->count];
        const double own = twice_area(o, a, b);
        twice += own;
        for (int k = 0; k < 2; k++) sum[k] += own * (a[k] + b[k] + o[k]) / 3;
    }
    for (int k = 0; k < 2; k++) center[k] = sum[k] / twice;
    return 0.5 * twice;
}

static double distance(const double a[2], const double b[2])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]));
}

/* int |r| dA of the triangle of o and a side, r from o: a third of the side's distance h from o times int |r| ds along
 * it, of which the primitive is (s |r| + h^2 asinh(s/h))/2. */
static double side_reach(const double o[2], const double a[2], const double b[2])
{
    const double length = distance(a, b), from = distance(o, a), to = distance(o, b);
    if (!(length > 0)) return 0;
    const double h = twice_area(o, a, b) / length, end = (to * to - from * from + length * length) / (2 * length),
                 begin = end - length, along = end * to - begin * from;
    return h / 6 * (h != 0 ? along + h * h * (asinh(end / fabs(h)) - asinh(begin / fabs(h))) : along);
}

/* How much nearer to the centre friction acts than the points are: of a polygon as above, else of a line. */
static double nearness(flat_points *flat)
{
    double center[2], points = 0, reach = 0;
    if (flat->count == 2) return 0.5;
    sort_round(flat);
    const double area = area_of(flat, center);
    for (int i = 0; i < flat->count; i++) {
        reach += side_reach(center, flat->x[i], flat->x[(i + 1) % flat->count]);
        points += distance(center, flat->x[i]) / flat->count;
    }
    if (!(area > IMP_PILE_LINE * points * points)) return 0.5;
    return fmin(reach / area / points, 1); /* points that crowd near the centre tell of none beyond them */
}

/* The pressure that is remembered of a point, N; 0: nothing. */
static double remembered_pressure(const imp_pile_point *point, const imp_pile_memories *memories)
{
    const int own = point->memory;
    return own < 0 ? 0 : fmax(qvec3_dot(memories->list[own].reaction, point->contact.axes[0]), 0);
}

/* The part of the way from the centre of pressure, on body 1, along the surface. */
static qvec3 rub_of(const imp_pile_point *point, qvec3 center)
{
    const qvec3 n = point->contact.axes[0], way = qvec3_sub(point->contact.arm1, center);
    return qvec3_scale(qvec3_axpy(-qvec3_dot(n, way), n, way), -point->nearer);
}

/* A whole disc's points, a sixteenth of its rim apart. */
static bool is_disc(const imp_pile_point *points, int count)
{
    for (int i = 0; i < count; i++)
        if (points[i].feature[0].kind != IMPACT_RIM && points[i].feature[1].kind != IMPACT_RIM) return false;
    return count == IMP_POINTS;
}

static void place_pair(imp_pile_point *points, int count, const imp_pile_memories *memories)
{
    const imp_cone_contact *first = &points[0].contact;
    flat_points flat = {.count = count};
    qvec3 pressed = {0, 0, 0}, mean = {0, 0, 0};
    double sum = 0;
    for (int i = 0; i < count; i++) {
        const qvec3 arm = points[i].contact.arm1, place = qvec3_sub(arm, first->arm1);
        const double pressure = remembered_pressure(&points[i], memories);
        for (int k = 0; k < 2; k++) flat.x[i][k] = qvec3_dot(first->axes[k + 1], place);
        pressed = qvec3_axpy(pressure, arm, pressed);
        mean = qvec3_axpy(1.0 / count, arm, mean);
        sum += pressure;
    }
    const double nearer = 1 - (is_disc(points, count) ? 2.0 / 3 : nearness(&flat));
    const qvec3 center = sum > 0 ? qvec3_scale(pressed, 1 / sum) : mean;
    for (int i = 0; i < count; i++) {
        points[i].nearer = nearer;
        points[i].contact.rub = rub_of(&points[i], center);
    }
}

void imp_pile_place_friction(imp_pile_contacts *contacts, const imp_world *world, const imp_pile_memories *memories)
{
    for (int i = 0, count; i < contacts->count; i += count) {
        imp_pile_point *first = &contacts->points[i];
        for (count = 1; i + count < contacts->count && first[count].pair == first->pair;) count++;
        if (count > 1 && world->pairs[first->pair].law.friction > 0) place_pair(first, count, memories);
    }
}

/* Of one pair's members. */
static bool shift_pair(imp_pile_contacts *contacts, const int *members, int count, const double *r, int width,
                       imp_cone_contact *own)
{
    qvec3 pressed = {0, 0, 0};
    double sum = 0, moved = 0, reach = 0;
    for (int c = 0; c < count; c++) {
        const double pressure = fmax(r[width * c], 0);
        pressed = qvec3_axpy(pressure, contacts->points[members[c]].contact.arm1, pressed);
        sum += pressure;
    }
    if (!(sum > 0)) return false;
    const qvec3 center = qvec3_scale(pressed, 1 / sum);
    for (int c = 0; c < count; c++) {
        const imp_pile_point *point = &contacts->points[members[c]];
        const qvec3 rub = rub_of(point, center);
        moved = fmax(moved, qvec3_norm(qvec3_sub(rub, point->contact.rub)));
        reach = fmax(reach, qvec3_norm(rub));
    }
    if (!(moved > IMP_PILE_SHIFTED * reach)) return false;
    for (int c = 0; c < count; c++) {
        imp_pile_point *point = &contacts->points[members[c]];
        point->contact.rub = own[c].rub = rub_of(point, center);
    }
    return true;
}

bool imp_pile_shift_friction(imp_pile_contacts *contacts, const int *members, int count, const double *r, int width,
                             imp_cone_contact *own)
{
    bool shifted = false;
    for (int c = 0, same; c < count; c += same) {
        const imp_pile_point *first = &contacts->points[members[c]];
        for (same = 1; c + same < count && contacts->points[members[c + same]].pair == first->pair;) same++;
        if (first->nearer > 0)
            shifted = shift_pair(contacts, &members[c], same, &r[width * c], width, &own[c]) || shifted;
    }
    return shifted;
}
