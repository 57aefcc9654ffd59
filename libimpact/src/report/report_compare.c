/* SPDX-License-Identifier: MIT */
#include "report/report_run.h"
#include "base/tolerances.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- states ---- */

/* rad; of near rotations to a rounding. */
static double turn_between(quat a, quat b)
{
    const double m = quat_norm(quat_sub(a, b)), p = quat_norm(quat_add(a, b));
    return 4 * atan2(fmin(m, p), fmax(m, p));
}

static impact_report_error difference(const imp_report *report, int i, const impact_sample *a, const impact_sample *b)
{
    const double r = report->gyration[i], turn = turn_between(a->orientation, b->orientation);
    const double x = qvec3_norm(qvec3_sub(a->position, b->position)),
                 v = qvec3_norm(qvec3_sub(a->velocity, b->velocity)) + r * qvec3_norm(qvec3_sub(a->omega, b->omega));
    return (impact_report_error){.x = x / report->X, .v = v / report->V, .q = turn};
}

impact_report_error imp_report_compare(const imp_report *report, const imp_report_track *a, const imp_report_track *b,
                                       int count, double *e)
{
    impact_report_error worst = {0};
    for (int k = 0; k < count; k++) {
        impact_report_error here = {0};
        for (int i = 0; i < report->moving_count; i++) {
            const size_t place = (size_t)k * (size_t)report->moving_count + (size_t)i;
            const impact_report_error d = difference(report, i, &a->states[place], &b->states[place]);
            here = (impact_report_error){.x = fmax(here.x, d.x), .v = fmax(here.v, d.v), .q = fmax(here.q, d.q)};
        }
        if (e) e[k] = impact_report_worst(here);
        worst.x = fmax(worst.x, here.x), worst.v = fmax(worst.v, here.v), worst.q = fmax(worst.q, here.q);
    }
    return worst;
}

static qvec3 bend3(qvec3 a, qvec3 m, qvec3 b)
{
    return qvec3_add(qvec3_scale(qvec3_sub(a, m), 0.5), qvec3_scale(qvec3_sub(b, m), 0.5));
}

impact_report_error imp_report_bend(const imp_report *report, const imp_report_track *one,
                                    const imp_report_track *middle, const imp_report_track *other, int count)
{
    impact_report_error worst = {0};
    for (int n = 0; n < count * report->moving_count; n++) {
        const impact_sample *a = &one->states[n], *m = &middle->states[n], *b = &other->states[n];
        const double r = report->gyration[n % report->moving_count];
        const quat q = m->orientation, p = quat_sub(quat_nearest(a->orientation, q), q),
                   s = quat_sub(quat_nearest(b->orientation, q), q);
        const double v = qvec3_norm(bend3(a->velocity, m->velocity, b->velocity)) +
                         r * qvec3_norm(bend3(a->omega, m->omega, b->omega));
        worst.x = fmax(worst.x, qvec3_norm(bend3(a->position, m->position, b->position)) / report->X);
        worst.v = fmax(worst.v, v / report->V);
        worst.q = fmax(worst.q, quat_norm(quat_add(p, s))); /* 2 |dq|, dq half the sum */
    }
    const double f = IMP_REPORT_SPREAD;
    return (impact_report_error){.x = f * worst.x, .v = f * worst.v, .q = f * worst.q};
}

/* ---- events ---- */

static int compare_pairs(const imp_report_event *a, const imp_report_event *b)
{
    for (int k = 0; k < 2; k++)
        if (a->body[k] != b->body[k]) return a->body[k] < b->body[k] ? -1 : 1;
    return a->force < b->force ? -1 : a->force > b->force;
}

/* By pair, then by time. */
static int compare_events(const void *one, const void *other)
{
    const imp_report_event *a = one, *b = other;
    const int pairs = compare_pairs(a, b);
    if (pairs != 0) return pairs;
    if (a->t != b->t) return a->t < b->t ? -1 : 1;
    return a->kind - b->kind;
}

/* The track's events up to t, sorted. */
static imp_report_event *sorted(const imp_report *report, const imp_report_track *track, double t, int *count)
{
    imp_report_event *list = imp_arena_take(report->arena, (size_t)track->event_count + 1, sizeof *list);
    *count = 0;
    if (!list) return NULL;
    for (int k = 0; k < track->event_count; k++)
        if (track->events[k].t <= t) list[(*count)++] = track->events[k];
    qsort(list, (size_t)*count, sizeof *list, compare_events);
    return list;
}

typedef struct event_range {
    const imp_report_event *at, *end;
} event_range;

static event_range take_pair(const imp_report_event *at, const imp_report_event *end)
{
    const imp_report_event *next = at;
    while (next < end && compare_pairs(at, next) == 0) next++;
    return (event_range){at, next};
}

/* Impacts from here on up to a contact: how many, or -1 where something else comes. */
static int tail_of(event_range r)
{
    int n = 0;
    while (r.at + n < r.end && r.at[n].kind == IMPACT_EVENT_IMPACT) n++;
    return r.at + n < r.end && r.at[n].kind == IMPACT_EVENT_CONTACT ? n : -1;
}

static bool skip_tail(event_range *r, int *dying)
{
    const int n = tail_of(*r);
    if (n <= 0) return false;
    *dying += n;
    r->at += n;
    return true;
}

/* One pair's events; what comes last, so near to the end that the other may have it behind that, is not missed. */
static void match_pair(event_range a, event_range b, double last, impact_report_row *row)
{
    while (a.at < a.end && b.at < b.end) {
        if (a.at->kind == b.at->kind) {
            row->error.t = fmax(row->error.t, fabs(a.at->t - b.at->t));
            a.at++, b.at++;
            continue;
        }
        const bool held_a = a.at->kind == IMPACT_EVENT_CONTACT, held_b = b.at->kind == IMPACT_EVENT_CONTACT;
        if ((held_b && skip_tail(&a, &row->dying)) || (held_a && skip_tail(&b, &row->dying))) continue;
        break;
    }
    const double t = fmin(a.at < a.end ? a.at->t : INFINITY, b.at < b.end ? b.at->t : INFINITY);
    if (t >= last) return;
    row->other_events++;
    row->first_other = fmin(row->first_other, t);
}

bool imp_report_match(const imp_report *report, const imp_report_track *a, const imp_report_track *b, double t,
                      impact_report_row *row)
{
    int count[2];
    imp_report_event *list[2] = {sorted(report, a, t, &count[0]), sorted(report, b, t, &count[1])};
    row->error.t = 0, row->other_events = row->dying = 0, row->first_other = INFINITY;
    const bool room = list[0] && list[1];
    const imp_report_event *at[2] = {list[0], list[1]}, *end[2] = {list[0] + count[0], list[1] + count[1]};
    while (room && (at[0] < end[0] || at[1] < end[1])) {
        const int order = at[0] == end[0] ? 1 : at[1] == end[1] ? -1 : compare_pairs(at[0], at[1]);
        const event_range none = {at[0], at[0]};
        const event_range one = order <= 0 ? take_pair(at[0], end[0]) : none,
                          other = order >= 0 ? take_pair(at[1], end[1]) : none;
        match_pair(one, other, t * (1 - 1e-6), row);
        if (order <= 0) at[0] = one.end;
        if (order >= 0) at[1] = other.end;
    }
    imp_arena_give(report->arena, list[0]);
    imp_arena_give(report->arena, list[1]);
    return room;
}
