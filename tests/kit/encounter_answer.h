/* SPDX-License-Identifier: MIT
 *
 * A random encounter solved, with all that is told of it.
 */
#ifndef ENCOUNTER_ANSWER_H
#define ENCOUNTER_ANSWER_H

#include "kit/encounter_random.h"

typedef struct answer {
    impact_status status;
    impact_together_outcome outcome;
    qvec3 velocity[ENCOUNTER_BODIES], omega[ENCOUNTER_BODIES];
    impact_meeting_outcome meetings[ENCOUNTER_CONTACTS];
} answer;

static inline answer solve(const random_encounter *e, impact_together_law law, double exponent,
                           impact_together_workspace *workspace)
{
    answer a;
    impact_encounter encounter = encounter_of(e, law);
    encounter.exponent = exponent;
    encounter.workspace = workspace;
    a.outcome = (impact_together_outcome){.velocity = a.velocity, .omega = a.omega, .meetings = a.meetings};
    a.status = impact_collide_together(&encounter, &a.outcome);
    return a;
}

/* All turned, masses, lengths and times multiplied. */
typedef struct encounter_frame {
    quat turn;
    double mass, length, time;
} encounter_frame;

static inline random_encounter change_frame(const random_encounter *e, const encounter_frame *frame)
{
    random_encounter out = *e;
    const quat q = frame->turn;
    const double m = frame->mass, l = frame->length, t = frame->time;
    for (int b = 0; b < e->body_count; b++) {
        impact_collider *body = &out.bodies[b];
        body->mass *= m;
        body->moments = qvec3_scale(body->moments, m * l * l);
        body->orientation = quat_mul(q, body->orientation);
        (void)quat_normalize(body->orientation, &body->orientation);
        body->velocity = quat_rotate(q, qvec3_scale(body->velocity, l / t));
        body->omega = quat_rotate(q, qvec3_scale(body->omega, 1 / t));
    }
    for (int i = 0; i < e->meeting_count; i++) {
        impact_meeting *own = &out.meetings[i];
        own->normal = quat_rotate(q, own->normal);
        own->offset1 = quat_rotate(q, qvec3_scale(own->offset1, l));
        own->offset2 = quat_rotate(q, qvec3_scale(own->offset2, l));
        own->stiffness *= 3.7;
    }
    return out;
}

/* The answer in such a frame as it was before. */
static inline void change_back(answer *a, int bodies, const encounter_frame *frame)
{
    for (int k = 0; k < bodies; k++) {
        a->velocity[k] = qvec3_scale(quat_rotate_inverse(frame->turn, a->velocity[k]), frame->time / frame->length);
        a->omega[k] = qvec3_scale(quat_rotate_inverse(frame->turn, a->omega[k]), frame->time);
    }
}

/* Of the fastest body, before or after: what was stopped altogether has no speed of its own to be measured by. */
static inline double distance(const random_encounter *e, const answer *a, const answer *b)
{
    double off = 0, size = 0;
    for (int k = 0; k < e->body_count; k++) {
        off = fmax(off, qvec3_norm(qvec3_sub(a->velocity[k], b->velocity[k])) +
                            qvec3_norm(qvec3_sub(a->omega[k], b->omega[k])));
        size = fmax(size, qvec3_norm(a->velocity[k]) + qvec3_norm(a->omega[k]));
        size = fmax(size, qvec3_norm(e->bodies[k].velocity) + qvec3_norm(e->bodies[k].omega));
    }
    return off / size;
}

/* What answers are asked to stand: relative changes of the data, and how far in another frame they may be off. */
#define ENCOUNTER_CHANGE 1e-11

/* The answer after relative changes of so much of some of its data: of velocities, normals, stiffnesses. All at once
 * may leave a wedge that is planar without an answer, and tell nothing of how it goes. */
static inline answer solve_nearby(random_stream *random, const random_encounter *e, impact_together_law law,
                                  double exponent, double change)
{
    random_encounter near = *e;
    const int some = 1 + (int)(7 * random_unit(random));
    for (int b = 0; b < e->body_count && (some & 1); b++)
        near.bodies[b].velocity = qvec3_axpy(change, random_direction(random), near.bodies[b].velocity);
    for (int i = 0; i < e->meeting_count && (some & 2); i++)
        near.meetings[i].normal = qvec3_axpy(change, random_direction(random), near.meetings[i].normal);
    for (int i = 0; i < e->meeting_count && (some & 4); i++)
        near.meetings[i].stiffness *= 1 + change * random_unit(random);
    return solve(&near, law, exponent, NULL);
}

/* How far the answer goes after such changes, the most of 512 tries, or until one is `enough`. */
static inline double spread(random_stream *random, const random_encounter *e, impact_together_law law, double exponent,
                            const answer *a, double change, double enough)
{
    double most = 0;
    for (int k = 0; k < 512 && most < enough; k++) {
        const answer b = solve_nearby(random, e, law, exponent, change);
        if (b.status >= 0) most = fmax(most, distance(e, a, &b));
    }
    return most;
}

/* Whether changes of the data leave it without an answer, in one of 512 tries: as where it is chance whether a wedge
 * locks. */
static inline bool is_lost_nearby(random_stream *random, const random_encounter *e, impact_together_law law,
                                  double exponent)
{
    bool lost = false;
    for (int k = 0; k < 512 && !lost; k++) lost = solve_nearby(random, e, law, exponent, ENCOUNTER_CHANGE).status < 0;
    return lost;
}

/* How far an answer may be off that is right to 1e-11 times its sensitivity: as far as it goes after such changes of
 * the data; at least 1e-11. */
static inline double allowance(random_stream *random, const random_encounter *e, impact_together_law law,
                               double exponent, const answer *a, double enough)
{
    return fmax(ENCOUNTER_CHANGE, spread(random, e, law, exponent, a, ENCOUNTER_CHANGE, enough));
}

#endif
