/* SPDX-License-Identifier: MIT
 *
 * Random encounters: bodies of any inertia, tied by contacts anywhere on them; some at rest, some static, some planar.
 */
#ifndef ENCOUNTER_RANDOM_H
#define ENCOUNTER_RANDOM_H

#include <impact/together.h>
#include "kit/contact_random.h"

enum { ENCOUNTER_BODIES = 101, ENCOUNTER_CONTACTS = 100 };

/* What is drawn: the ranges of the campaign. */
typedef struct encounter_ranges {
    int least, most;    /* contacts */
    double friction;    /* 0 with one in five, else up to this, evenly in the logarithm over three decades */
    double restitution; /* from this to 1; 1 with one in five */
    double mass_ratio, stiffness_ratio;
} encounter_ranges;

typedef struct random_encounter {
    impact_collider bodies[ENCOUNTER_BODIES];
    impact_meeting meetings[ENCOUNTER_CONTACTS];
    int body_count, meeting_count;
    impact_law restitution; /* of the laws that have several; drawn: Poisson's */
} random_encounter;

static inline double encounter_spread(random_stream *random, double ratio)
{
    return random_log(random, 1 / sqrt(ratio), sqrt(ratio));
}

static inline impact_collider encounter_body(random_stream *random, const encounter_ranges *ranges, bool rests)
{
    impact_collider body = {.mass = encounter_spread(random, ranges->mass_ratio),
                            .orientation = random_rotation(random)};
    const double a = random_log(random, 0.05, 0.6), b = random_log(random, 0.05, 0.6);
    body.moments = (qvec3){body.mass * (a + b), body.mass * a, body.mass * b};
    if (rests) return body;
    body.velocity = random_vector(random, 0.1, 1);
    body.omega = random_vector(random, 0.1, 1);
    return body;
}

/* Flattened into the plane z = 0: all stays in it, but for rounding. */
static inline void encounter_flatten(random_encounter *e)
{
    for (int b = 0; b < e->body_count; b++) {
        impact_collider *body = &e->bodies[b];
        body->orientation = quat_identity();
        body->velocity.z = body->omega.x = body->omega.y = 0;
    }
    for (int i = 0; i < e->meeting_count; i++) {
        impact_meeting *m = &e->meetings[i];
        m->normal.z = m->offset1.z = m->offset2.z = 0;
    }
}

static inline qvec3 encounter_slip(const random_encounter *e, const impact_meeting *m)
{
    const impact_collider *a = &e->bodies[m->body1], *b = &e->bodies[m->body2];
    return qvec3_sub(qvec3_add(a->velocity, qvec3_cross(a->omega, m->offset1)),
                     qvec3_add(b->velocity, qvec3_cross(b->omega, m->offset2)));
}

/* Contact i ties body i % (bodies - 1) + 1 to an earlier one, so that all hang together; body 0 may be static. */
static inline random_encounter encounter_draw(random_stream *random, const encounter_ranges *ranges)
{
    random_encounter e = {.meeting_count = ranges->least};
    e.meeting_count += (int)(random_unit(random) * (ranges->most - ranges->least + 1));
    e.body_count = 2 + (int)(random_unit(random) * e.meeting_count);
    const bool rests = random_unit(random) < 0.3, flat = random_unit(random) < 0.2, walled = random_unit(random) < 0.4;
    for (int b = 0; b < e.body_count; b++) e.bodies[b] = encounter_body(random, ranges, rests && b != 1);
    if (walled) e.bodies[0] = (impact_collider){.mass = INFINITY, .orientation = {1, 0, 0, 0}};
    for (int i = 0; i < e.meeting_count; i++) {
        const int own = i % (e.body_count - 1) + 1;
        impact_meeting *m = &e.meetings[i];
        *m = (impact_meeting){.body1 = own, .body2 = (int)(random_unit(random) * own)};
        m->normal = random_direction(random);
        m->offset1 = random_vector(random, 0.2, 1);
        m->offset2 = random_vector(random, 0.2, 1);
        m->friction = random_unit(random) < 0.2 || ranges->friction == 0
                          ? 0
                          : random_log(random, 1e-3 * ranges->friction, ranges->friction);
        m->restitution = random_unit(random) < 0.2 ? 1 : random_log(random, ranges->restitution, 1);
        m->stiffness = encounter_spread(random, ranges->stiffness_ratio);
    }
    if (flat) encounter_flatten(&e);
    for (int i = 0; i < e.meeting_count; i++) /* most approach */
        if (qvec3_dot(e.meetings[i].normal, encounter_slip(&e, &e.meetings[i])) > 0 && random_unit(random) < 0.8)
            e.meetings[i].normal = qvec3_neg(e.meetings[i].normal);
    return e;
}

static inline impact_encounter encounter_of(const random_encounter *e, impact_together_law law)
{
    return (impact_encounter){.bodies = e->bodies,
                              .body_count = e->body_count,
                              .meetings = e->meetings,
                              .meeting_count = e->meeting_count,
                              .law = law,
                              .restitution = e->restitution};
}

#endif
