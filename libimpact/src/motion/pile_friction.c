/* SPDX-License-Identifier: MIT
 *
 * Where the friction of a face acts, and how strong it is. Its points bear the pressure of all of it, N in all. What
 * slides is rubbed at other places, and more or less strongly, so that all of them are to it what the face is, evenly
 * pressed (face_points.h): force and torque, however many points there are and whatever part of the pressure each
 * bears. That part is not unique of more than three, and friction with it: each step's answer stays near the last one's
 * parts (pile_solve.c).
 *
 * At rest a point's friction acts on its way to the centre of pressure, at
 *
 *     mean distance / mean distance of the points:   a square (sqrt 2 + asinh 1)/(3 sqrt 2), a disc 2/3, a line 1/2
 *
 * of it: corners hold more torque than a face, mu N times their mean distance from the centre, of a square 1.85 times
 * as much. So are lines where they slide too (docs/faces.md). The centre of pressure is that of the reactions
 * themselves, which are looked for anew with it.
 */
#include "base/tolerances.h"
#include "motion/face_points.h"
#include "motion/pile_contacts.h"

#include <string.h>

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

/* At what part of the way friction acts at rest: of a polygon, sorted round, as above, else of a line. */
static double part_at_rest(const flat_points *flat)
{
    double center[2], points = 0, reach = 0;
    if (flat->count == 2) return 0.5;
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

static void lay_in_plane(const qvec3 axes[3], qvec3 way, double out[2])
{
    for (int k = 0; k < 2; k++) out[k] = qvec3_dot(axes[k + 1], way);
}

/* From where the point bears, along the surface; the centre of pressure on body 1. */
static qvec3 rub_of(const imp_pile_point *point, qvec3 center)
{
    const qvec3 n = point->contact.axes[0], way = qvec3_sub(point->contact.arm1, center);
    return qvec3_axpy(-point->nearer, qvec3_axpy(-qvec3_dot(n, way), n, way), point->aside);
}

/* A whole disc's points, a sixteenth of its rim apart. */
static bool is_disc(const imp_pile_point *points, int count)
{
    for (int i = 0; i < count; i++)
        if (points[i].feature[0].kind != IMPACT_RIM && points[i].feature[1].kind != IMPACT_RIM) return false;
    return count == IMP_POINTS;
}

/* A pair's points, what they bear of the pressure, and its centre, on body 1. */
typedef struct face_pressure {
    int count;
    double part[IMP_POINTS];
    qvec3 center; /* on body 1 */
} face_pressure;

static face_pressure face_pressure_of(const imp_pile_point *points, int count, const imp_pile_memories *memories)
{
    face_pressure p = {.count = count, .center = {0, 0, 0}};
    double sum = 0;
    for (int i = 0; i < count; i++) sum += p.part[i] = remembered_pressure(&points[i], memories);
    for (int i = 0; i < count; i++) {
        const qvec3 arm = points[i].contact.arm1;
        p.part[i] = sum > 0 ? p.part[i] / sum : 1.0 / count;
        p.center = qvec3_axpy(p.part[i], arm, p.center);
    }
    return p;
}

/* How body 1 goes on body 2 at the centre of pressure: along the plane's axes and about its normal. */
static void twist_of(const imp_world *world, const imp_state *states, const imp_cone_contact *contact, qvec3 center,
                     double twist[3])
{
    double u[6];
    imp_cone_contact there = *contact;
    there.rub = qvec3_sub(center, contact->arm1);
    imp_cone_contact_turning(world, states, &there, 1, u);
    memcpy(twist, &u[1], 3 * sizeof *twist);
}

/* The face of the points, sorted round, about its centre and over its reach; false: they are in a line. */
static bool face_of(const flat_points *flat, bool disc, double *reach, imp_flat_face *face)
{
    double center[2];
    *face = (imp_flat_face){.count = disc ? 0 : flat->count, .radius = disc};
    mean_of(flat, center);
    *reach = 0;
    for (int i = 0; i < flat->count; i++) *reach = fmax(*reach, distance(center, flat->x[i]));
    if (disc) return true;
    if (flat->count == 2 || !(area_of(flat, center) > IMP_PILE_LINE * *reach * *reach)) return false;
    for (int i = 0; i < flat->count; i++)
        for (int k = 0; k < 2; k++) face->corner[i][k] = (flat->x[i][k] - center[k]) / *reach;
    return true;
}

/* How a pair's face slides: over its reach, about the centre of pressure. */
typedef struct face_slide {
    imp_flat_face face;
    double twist[3], reach;
} face_slide;

/* Whether it is a face, and slides faster than the least. */
static bool face_slides(const imp_world *world, const imp_pile_point *points, const face_pressure *pressure,
                        const flat_points *sorted, const imp_state *states, double least, face_slide *slide)
{
    if (!states || !face_of(sorted, is_disc(points, sorted->count), &slide->reach, &slide->face)) return false;
    twist_of(world, states, &points[0].contact, pressure->center, slide->twist);
    slide->twist[2] *= slide->reach;
    return hypot(slide->twist[0], slide->twist[1]) + fabs(slide->twist[2]) > least;
}

/* Where it rubs; false: there are no such places. */
static bool place_sliding(imp_pile_point *points, const face_pressure *pressure, const face_slide *slide)
{
    const imp_cone_contact *first = &points[0].contact;
    imp_face_points own = {.count = pressure->count};
    for (int i = 0; i < own.count; i++) {
        const qvec3 arm = qvec3_sub(points[i].contact.arm1, pressure->center);
        lay_in_plane(first->axes, qvec3_scale(arm, 1 / slide->reach), own.bear[i]);
        own.part[i] = pressure->part[i];
    }
    if (!imp_points_as_face(&slide->face, slide->twist, &own)) return false;
    for (int i = 0; i < own.count; i++) {
        points[i].slides = true;
        points[i].nearer = 1 - own.k;
        points[i].strength = own.strength;
        points[i].aside = (qvec3){0, 0, 0};
        for (int k = 0; k < 2; k++) {
            const double aside = slide->reach * (own.rub[i][k] - own.k * own.bear[i][k]);
            points[i].aside = qvec3_axpy(aside, first->axes[k + 1], points[i].aside);
        }
    }
    return true;
}

static void place_pair(const imp_world *world, imp_pile_point *points, int count, const imp_pile_memories *memories,
                       const imp_state *states, double least)
{
    const face_pressure pressure = face_pressure_of(points, count, memories);
    flat_points flat = {.count = count};
    face_slide slide;
    for (int i = 0; i < count; i++)
        lay_in_plane(points[0].contact.axes, qvec3_sub(points[i].contact.arm1, points[0].contact.arm1), flat.x[i]);
    sort_round(&flat);
    const bool slides =
        face_slides(world, points, &pressure, &flat, states, least, &slide) && place_sliding(points, &pressure, &slide);
    const double part = is_disc(points, count) ? 2.0 / 3 : part_at_rest(&flat);
    for (int i = 0; i < count && !slides; i++) points[i].nearer = 1 - part;
    for (int i = 0; i < count; i++) points[i].contact.rub = rub_of(&points[i], pressure.center);
}

/* How many points from this one on are of its pair. */
static int points_of_pair(const imp_pile_contacts *contacts, int first)
{
    int count = 1;
    while (first + count < contacts->count && contacts->points[first + count].pair == contacts->points[first].pair)
        count++;
    return count;
}

void imp_pile_place_friction(imp_pile_contacts *contacts, const imp_world *world, const imp_pile_memories *memories,
                             const imp_state *states, double least)
{
    for (int i = 0, count; i < contacts->count; i += count) {
        imp_pile_point *first = &contacts->points[i];
        count = points_of_pair(contacts, i);
        if (count > 1 && world->pairs[first->pair].law.friction > 0)
            place_pair(world, first, count, memories, states, least);
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
        if (first->nearer != 0)
            shifted = shift_pair(contacts, &members[c], same, &r[width * c], width, &own[c]) || shifted;
    }
    return shifted;
}
