/* SPDX-License-Identifier: MIT
 *
 * Bounces that never end. Forces, friction and restitution are homogeneous: velocities c times as large make all else
 * happen alike. What bounces from contact to contact, ever less, through all but a wedge thus comes to multiples of
 * itself, and its impulses p and works E to geometric series. Of three moments in equal numbers of rounds
 *
 *     p'' - p' = R (p' - p)      p_end = p'' + (p'' - p') R/(1 - R)      E_end = E'' + (E'' - E') R^2/(1 - R^2)
 *
 * But friction's works: slip that does not come to nothing has part of them fall by R, the rest by R^2,
 *
 *     E_end = E'' + (E'' - E') R/(1 - R) + (E'' - E' - R (E' - E)) R^2/((1 - R) (1 - R^2))
 *
 * R is that of as many rounds as leave it under IMP_BOUNCES_RATIO: 1/(1 - R)^2 is by what p_end has the rounding of p.
 * Where that would take too long, or nothing is in one ratio, the end is found by its own equations (springs_rest.c).
 * Moments are closings of one contact, whatever presses then: of two that bounce in turn one may always do. What
 * presses without bouncing is in no ratio. Where nothing does in between, rounds take ever longer, and what else
 * approaches ends them: then there is no such end.
 */
#include "contact/springs.h"

#include <math.h>
#include <string.h>
#include "base/tolerances.h"

/* Impulses and works of three moments. */
size_t imp_springs_bounces_size(size_t n) { return 18 * n; }

static void note_moment(const imp_springs *s, int moment)
{
    double *p = imp_springs_impulses_at(s, moment), *work = imp_springs_works_at(s, moment);
    for (int i = 0; i < s->count; i++)
        for (int j = 0; j < 3; j++) {
            p[3 * i + j] = s->springs[i].p[j];
            work[3 * i + j] = s->springs[i].finding->work[j];
        }
}

/* The ratio of the last two differences of impulses, least squares; *off: the most that is not in it; *pushed: the
 * most of the last one. */
static double find_ratio(const imp_springs *s, double *off, double *pushed)
{
    const double *first = imp_springs_impulses_at(s, 0), *second = imp_springs_impulses_at(s, 1),
                 *third = imp_springs_impulses_at(s, 2);
    double both = 0, square = 0;
    *off = *pushed = 0;
    for (int i = 0; i < 3 * s->count; i++) {
        const double before = second[i] - first[i], after = third[i] - second[i];
        both += before * after, square += before * before;
        *pushed = fmax(*pushed, fabs(after));
    }
    for (int i = 0; i < 3 * s->count; i++)
        *off = fmax(*off, fabs(third[i] - second[i] - both / square * (second[i] - first[i])));
    return both / square;
}

/* To the end, where that ratio leads; works too. */
static void go_to_end(imp_springs *s, double ratio)
{
    const double *p = imp_springs_impulses_at(s, 1), *work = imp_springs_works_at(s, 1),
                 *first = imp_springs_works_at(s, 0), more = ratio / (1 - ratio),
                 square = ratio * ratio / (1 - ratio * ratio);
    for (int i = 0; i < s->count; i++) {
        imp_spring *c = &s->springs[i];
        for (int j = 0; j < 3; j++) c->p[j] += more * (c->p[j] - p[3 * i + j]);
        for (int j = 0; j < 2; j++) c->finding->work[j] += square * (c->finding->work[j] - work[3 * i + j]);
        const int k = 3 * i + 2;
        const double last = c->finding->work[2] - work[k], slower = last - ratio * (work[k] - first[k]);
        c->finding->work[2] += more * last + square / (1 - ratio) * slower;
    }
    imp_springs_find_velocities(s);
}

static bool none_approaches(const imp_springs *s, double error)
{
    for (int i = 0; i < s->count; i++)
        if (s->springs[i].u[0] < -fmax(error, s->springs[i].none)) return false;
    return true;
}

/* What has not been pushed since the moment before does not approach. */
static bool only_they_approach(const imp_springs *s)
{
    const double *p = imp_springs_impulses_at(s, 1);
    for (int i = 0; i < s->count; i++)
        if (s->springs[i].p[0] == p[3 * i] && s->springs[i].u[0] < -s->springs[i].none) return false;
    return true;
}

/* Whether it is the end, where nothing approaches; the state becomes what it was at the third moment where it is not.
 */
static bool stays(imp_springs *s)
{
    const double *work = imp_springs_works_at(s, 2);
    if (none_approaches(s, IMP_BOUNCES_ERROR)) return true;
    memcpy(s->springs, s->kept, (size_t)s->count * sizeof *s->kept);
    for (int i = 0; i < s->count; i++)
        for (int j = 0; j < 3; j++) s->springs[i].finding->work[j] = work[3 * i + j];
    return false;
}

static bool is_late(const imp_springs *s) { return s->events + s->steps >= IMP_BOUNCES_LATE; }

/* To the end, by the ratio, or, late, by what it is. */
static bool ends(imp_springs *s, double ratio, double off, double pushed)
{
    const double left = 1 - ratio;
    const bool falls = ratio > 0 && ratio < 1;
    if (!falls || s->springs[s->bounces.contact].u[0] > -IMP_BOUNCES_SLOWEST || !only_they_approach(s)) return false;
    memcpy(s->kept, s->springs, (size_t)s->count * sizeof *s->kept);
    if (ratio <= IMP_BOUNCES_RATIO && off <= IMP_BOUNCES_ERROR * left * left) {
        go_to_end(s, ratio);
        if (stays(s)) return true;
    }
    /* they have fallen by enough, or so alike that the ratio tells impulses to come, pushed R/(1 - R), as well as they
     * are compared: what is not in it is off R/(1 - R)^2 of them */
    const bool goes_on = ratio * ratio <= IMP_BOUNCES_RATIO || off <= IMP_BOUNCES_APART * left * pushed;
    return is_late(s) && goes_on && imp_springs_come_to_rest(s, ratio) && stays(s);
}

/* Rounds between the next three moments: as many as the ratio asks, or twice as many; late, where they have fallen by
 * enough, as many: what is waited for then comes to nothing while they fall. */
static long next_span(const imp_springs *s, double ratio)
{
    const long span = s->bounces.span;
    const bool falls = ratio > 0 && ratio < 1;
    if (falls && ratio <= IMP_BOUNCES_FALLEN && is_late(s)) return span;
    const double asked = falls ? fmin(log(IMP_BOUNCES_RATIO) / log(ratio), 4) * (double)span + 1 : 0;
    return (long)fmax(2 * (double)span, asked);
}

/* At the third moment; if it is not the end, three others follow. */
static bool look_for_end(imp_springs *s)
{
    imp_springs_bounces *b = &s->bounces;
    double off, pushed;
    note_moment(s, 2);
    const double ratio = find_ratio(s, &off, &pushed);
    if (ends(s, ratio, off, pushed)) return true;
    note_moment(s, 0);
    b->rounds = 0;
    b->span = next_span(s, ratio);
    return false;
}

bool imp_springs_end_bounces(imp_springs *s)
{
    imp_springs_bounces *b = &s->bounces;
    if (s->closing < 0) return false;
    if (b->span == 0 || s->events > b->expected) { /* the contact no longer takes part */
        *b = (imp_springs_bounces){.room = b->room, .contact = s->closing, .span = IMP_BOUNCES_ROUNDS};
        note_moment(s, 0);
    }
    if (s->closing != b->contact) return false;
    b->expected = s->events + IMP_BOUNCES_LONGEST;
    b->rounds++;
    if (b->rounds == b->span) note_moment(s, 1);
    return b->rounds == 2 * b->span && look_for_end(s);
}
