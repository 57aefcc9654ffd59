/* SPDX-License-Identifier: MIT
 *
 * key: the quintic Hermite polynomial between two keys of a body, and where keys stand on its trajectory. Internal.
 */
#ifndef IMP_KEY_H
#define IMP_KEY_H

#include <impact/record.h>
#include "motion/segment.h"

/* The state at t, keys[0].t <= t <= keys[1].t, of the polynomial that has the place, its rate and second rate of both
 * keys; the orientation's is normalised, and omega is the rate of what is normalised. acceleration and alpha: zero. */
impact_key imp_key_between(const impact_key keys[2], double t);

/* The state at t >= key->t by the key's own form, which is not the quintic; of a free flight acceleration and alpha as
 * well. */
impact_key imp_key_alone(const imp_body *body, const impact_key *key, double t);

/* The form of a body's segment: not the quintic where one key says all. */
impact_key_form imp_key_form(const imp_body *body, const imp_segment *segment);

/* The key of a body in such a state: momentum' is the torque on it; the rates of both, world. */
impact_key imp_key_of(const imp_body *body, int index, double t, const imp_state *state, qvec3 acceleration,
                      qvec3 torque);

typedef struct imp_pose {
    double t;
    qvec3 x;
    quat q;
} imp_pose;

/* A piece of motion that is done, between two events: at tells where one of its bodies was at part s, 0 to 1, of the
 * way through it; pose is the same without the rates, and begin the key at s = 0 without the
 * accelerations. Time rises with s, not always evenly. At s = 0 and 1 the state is
 * the one that the neighbouring pieces and events have, to the bit. */
typedef struct imp_piece {
    double from, to; /* s */
    void *context;
    impact_key (*at)(void *context, int body, double s);
    imp_pose (*pose)(void *context, int body, double s);
    impact_key (*begin)(void *context, int body);
} imp_piece;

/* A part of a piece on which the polynomial of its ends meets the trajectory, and where the trajectory was inside it.
 */
typedef struct imp_span {
    impact_key from, to;
    imp_pose way[3];
} imp_span;

/* What a polynomial may be off by: m, rad. */
typedef struct imp_key_tolerance {
    double place, angle;
} imp_key_tolerance;

typedef bool imp_span_sink(void *context, const imp_span *span);

/* Halves one body's piece until the polynomial of each part meets it at a quarter, half and three quarters, and hands
 * the parts on in order. *unmet counts parts too short to be halved further. False: the sink refused. */
bool imp_key_halve(const imp_piece *piece, int body, imp_key_tolerance tolerance, imp_span_sink *sink, void *context,
                   long *unmet);

/* One body's keys so far: spans join as long as one polynomial meets all of them. */
enum { IMP_KEY_WAY = 8 };

typedef struct imp_key_line {
    bool begun, open, lonely; /* lonely: what came last did not join */
    impact_key last, next;    /* handed on; open: the end of the span that may still grow */
    int count;
    imp_pose way[IMP_KEY_WAY]; /* on the way from last to next */
} imp_key_line;

typedef bool imp_key_sink(void *context, const impact_key *key);

/* Takes the body's next span, and hands on the keys that this settles. False: the sink refused. */
bool imp_key_line_add(imp_key_line *line, const imp_span *span, imp_key_tolerance tolerance, imp_key_sink *sink,
                      void *context);
/* The same of a body's next piece, halved where it must be. */
bool imp_key_line_add_piece(imp_key_line *line, const imp_piece *piece, int body, imp_key_tolerance tolerance,
                            imp_key_sink *sink, void *context, long *unmet);
/* A motion in closed form, from this key on. */
bool imp_key_line_add_form(imp_key_line *line, const impact_key *key, imp_key_sink *sink, void *context);
/* Hands on the key that is still open. */
bool imp_key_line_end(imp_key_line *line, imp_key_sink *sink, void *context);

#endif
