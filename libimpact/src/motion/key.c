/* SPDX-License-Identifier: MIT
 *
 * With h = t1 - t0, s = (t - t0)/h, a quantity f with its first and second rates at both ends is
 *
 *     f(s) = (1 - e) f0 + h s (1 - s^2 (6 - 8 s + 3 s^2)) f0' + h^2 s^2 (1 - s)^3 f0''/2
 *          +      e  f1 + h s^3 (-4 + 7 s - 3 s^2) f1' + h^2 s^3 (1 - s)^2 f1''/2,     e = s^3 (10 - 15 s + 6 s^2),
 *
 * off by no more than h^6 max|f^(6)|/46080. Of an orientation q' = (0, w) q/2 and q'' = ((0, alpha) q + (0, w) q')/2;
 * the polynomial p is normalised, and w = 2 vec(p' p*)/|p|^2: what p' has along p falls out of vec. Of a steady spin
 * the sixth rate lies along q, so that normalising takes it away.
 */
#include "motion/key.h"
#include "base/tolerances.h"

#include <float.h>
#include <string.h>

/* ---- the polynomial ---- */

/* Of f0' h, f0'' h^2, f1 - f0, f1' h, f1'' h^2. */
typedef struct weights {
    double rate0, second0, change, rate1, second1;
} weights;

static weights weights_at(double s)
{
    const double r = 1 - s, s2 = s * s, s3 = s2 * s;
    return (weights){s * (1 - s2 * (6 - s * (8 - 3 * s))), 0.5 * s2 * r * r * r, s3 * (10 - s * (15 - 6 * s)),
                     s3 * (-4 + s * (7 - 3 * s)), 0.5 * s3 * r * r};
}

/* Their rates by s. */
static weights slopes_at(double s)
{
    const double r = 1 - s, s2 = s * s;
    return (weights){1 - s2 * (18 - s * (32 - 15 * s)), 0.5 * s * r * r * (2 - 5 * s), 30 * s2 * r * r,
                     s2 * (-12 + s * (28 - 15 * s)), 0.5 * s2 * r * (3 - 5 * s)};
}

/* (0, v) q / 2 */
static quat half_product(qvec3 v, quat q) { return quat_scale(quat_mul((quat){0, v.x, v.y, v.z}, q), 0.5); }

/* The rates of an orientation at one key. */
typedef struct turn {
    quat rate, second;
} turn;

static turn turn_of(const impact_key *key)
{
    const quat rate = half_product(key->omega, key->orientation);
    return (turn){rate, quat_add(half_product(key->alpha, key->orientation), half_product(key->omega, rate))};
}

/* The polynomial of two keys, ready to be asked: what each weight takes, of the place and of the orientation. */
typedef struct quintic {
    const impact_key *a, *b;
    double h;
    qvec3 x[5];
    quat q[5];
} quintic;

static quintic quintic_of(const impact_key keys[2])
{
    const impact_key *a = &keys[0], *b = &keys[1];
    const double h = b->t - a->t, h2 = h * h;
    const turn from = turn_of(a), to = turn_of(b);
    return (quintic){a,
                     b,
                     h,
                     {qvec3_scale(a->velocity, h), qvec3_scale(a->acceleration, h2),
                      qvec3_sub(b->position, a->position), qvec3_scale(b->velocity, h),
                      qvec3_scale(b->acceleration, h2)},
                     {quat_scale(from.rate, h), quat_scale(from.second, h2), quat_sub(b->orientation, a->orientation),
                      quat_scale(to.rate, h), quat_scale(to.second, h2)}};
}

static qvec3 mix(const quintic *p, weights w)
{
    const qvec3 *x = p->x;
    qvec3 sum = qvec3_scale(x[0], w.rate0);
    sum = qvec3_axpy(w.second0, x[1], sum);
    sum = qvec3_axpy(w.change, x[2], sum);
    sum = qvec3_axpy(w.rate1, x[3], sum);
    return qvec3_axpy(w.second1, x[4], sum);
}

static quat mix_turn(const quintic *p, weights w)
{
    const quat *q = p->q;
    quat sum = quat_scale(q[0], w.rate0);
    sum = quat_add(sum, quat_scale(q[1], w.second0));
    sum = quat_add(sum, quat_scale(q[2], w.change));
    sum = quat_add(sum, quat_scale(q[3], w.rate1));
    return quat_add(sum, quat_scale(q[4], w.second1));
}

impact_key imp_key_between(const impact_key keys[2], double t)
{
    const impact_key *a = &keys[0], *b = &keys[1];
    const double h = b->t - a->t, s = h > 0 ? (t - a->t) / h : 1;
    impact_key key = {.t = t, .body = a->body};
    if (s <= 0 || s >= 1) { /* the ends themselves, not their rounding */
        const impact_key *end = s <= 0 ? a : b;
        key.position = end->position, key.orientation = end->orientation;
        key.velocity = end->velocity, key.omega = end->omega;
        return key;
    }
    const quintic curve = quintic_of(keys);
    const weights w = weights_at(s), d = slopes_at(s);
    const quat p = quat_add(a->orientation, mix_turn(&curve, w)), rate = quat_scale(mix_turn(&curve, d), 1 / h);
    const quat spin = quat_mul(rate, quat_conj(p));
    key.position = qvec3_add(a->position, mix(&curve, w));
    key.velocity = qvec3_scale(mix(&curve, d), 1 / h);
    quat_normalize(p, &key.orientation);
    key.omega = qvec3_scale((qvec3){spin.x, spin.y, spin.z}, 2 / quat_dot(p, p));
    return key;
}

/* ---- a key ---- */

/* L = J w, so L' = J w' + w x L. */
impact_key imp_key_of(const imp_body *body, int index, double t, const imp_state *state, qvec3 acceleration,
                      qvec3 torque)
{
    const qvec3 omega = imp_omega(body, state);
    const qvec3 alpha = imp_inverse_inertia(body, state->q, qvec3_sub(torque, qvec3_cross(omega, state->momentum)));
    return (impact_key){t, index, state->x, state->q, state->v, omega, acceleration, alpha};
}

static imp_pose pose_of(const impact_key *key) { return (imp_pose){key->t, key->position, key->orientation}; }

/* ---- whether the polynomial meets the trajectory ---- */

static double square(qvec3 v) { return qvec3_dot(v, v); }

/* A difference d of unit quaternions is a turn of 2 |d|, as long as that is small. */
static bool meets(const quintic *curve, const imp_pose *pose, imp_key_tolerance tolerance)
{
    const weights w = weights_at((pose->t - curve->a->t) / curve->h);
    const qvec3 off = qvec3_sub(qvec3_add(curve->a->position, mix(curve, w)), pose->x);
    const double place = tolerance.place + IMP_KEY_ROUNDINGS * DBL_EPSILON * sqrt(square(pose->x));
    if (!(square(off) <= place * place)) return false;
    const quat p = quat_unit(quat_add(curve->a->orientation, mix_turn(curve, w)));
    const double angle = tolerance.angle + IMP_KEY_ROUNDINGS * DBL_EPSILON;
    return 4 * quat_norm2(quat_sub(p, pose->q)) <= angle * angle;
}

static bool turns_little(const impact_key keys[2])
{
    const double fastest = fmax(square(keys[0].omega), square(keys[1].omega));
    return sqrt(fastest) * (keys[1].t - keys[0].t) <= IMP_KEY_TURN;
}

static bool all_meet(const quintic *curve, const imp_pose *way, int count, imp_key_tolerance tolerance)
{
    for (int i = 0; i < count; i++)
        if (!meets(curve, &way[i], tolerance)) return false;
    return true;
}

static bool too_short(const impact_key keys[2])
{
    const double t = fmax(fabs(keys[0].t), fabs(keys[1].t));
    return keys[1].t - keys[0].t <= IMP_KEY_ULPS * DBL_EPSILON * t;
}

typedef struct halving {
    const imp_piece *piece;
    int body;
    imp_key_tolerance tolerance;
    imp_span_sink *sink;
    void *context;
    long *unmet;
} halving;

static imp_pose quarter(const halving *h, double s, double length, int i)
{
    return h->piece->pose(h->piece->context, h->body, s + 0.25 * (i + 1) * length);
}

/* The middle first, where a quintic is off most: what fails there is not asked elsewhere. */
static bool span_meets(const halving *h, double s, double length, imp_span *span)
{
    static const int order[3] = {1, 0, 2};
    const impact_key ends[2] = {span->from, span->to};
    if (!turns_little(ends)) return false;
    const quintic curve = quintic_of(ends);
    for (int k = 0; k < 3; k++) {
        const int i = order[k];
        span->way[i] = quarter(h, s, length, i);
        if (!meets(&curve, &span->way[i], h->tolerance)) return false;
    }
    return true;
}

static bool hand_on_unmet(const halving *h, double s, double length, imp_span *span)
{
    for (int i = 0; i < 3; i++) span->way[i] = quarter(h, s, length, i);
    ++*h->unmet;
    return h->sink(h->context, span);
}

/* The part from s to s + length, with the keys at its ends. */
static bool halve(const halving *h, double s, double length, const impact_key ends[2], int depth)
{
    imp_span span = {.from = ends[0], .to = ends[1]};
    if (span_meets(h, s, length, &span)) return h->sink(h->context, &span);
    if (depth == IMP_KEY_HALVINGS || too_short(ends)) return hand_on_unmet(h, s, length, &span);
    const impact_key middle = h->piece->at(h->piece->context, h->body, s + 0.5 * length);
    const impact_key left[2] = {ends[0], middle}, right[2] = {middle, ends[1]};
    return halve(h, s, 0.5 * length, left, depth + 1) && halve(h, s + 0.5 * length, 0.5 * length, right, depth + 1);
}

bool imp_key_halve(const imp_piece *piece, int body, imp_key_tolerance tolerance, imp_span_sink *sink, void *context,
                   long *unmet)
{
    const halving h = {piece, body, tolerance, sink, context, unmet};
    const impact_key ends[2] = {piece->at(piece->context, body, 0), piece->at(piece->context, body, 1)};
    return !(ends[1].t > ends[0].t) || halve(&h, 0, 1, ends, 0);
}

/* ---- a body's keys ---- */

static bool same_state(const impact_key *a, const impact_key *b)
{
    return a->t == b->t && memcmp(&a->position, &b->position, sizeof a->position) == 0 &&
           memcmp(&a->orientation, &b->orientation, sizeof a->orientation) == 0 &&
           memcmp(&a->velocity, &b->velocity, sizeof a->velocity) == 0 &&
           memcmp(&a->omega, &b->omega, sizeof a->omega) == 0;
}

static bool hand_on(imp_key_line *line, const impact_key *key, imp_key_sink *sink, void *context)
{
    line->begun = true;
    line->open = false;
    line->last = *key;
    line->count = 0;
    return sink(context, key);
}

/* When there is no room, the pose goes whose neighbours stand closest: those that stay are spread over the way. */
static void keep_pose(imp_key_line *line, imp_pose pose)
{
    enum { ROOM = sizeof line->way / sizeof *line->way };
    if (line->count == ROOM) {
        int crowded = 1;
        for (int i = 2; i < ROOM - 1; i++)
            if (line->way[i + 1].t - line->way[i - 1].t < line->way[crowded + 1].t - line->way[crowded - 1].t)
                crowded = i;
        line->count--;
        memmove(&line->way[crowded], &line->way[crowded + 1], sizeof *line->way * (size_t)(ROOM - 1 - crowded));
    }
    line->way[line->count++] = pose;
}

static void grow(imp_key_line *line, const imp_span *span)
{
    if (line->open) keep_pose(line, pose_of(&line->next));
    for (int i = 0; i < 3; i++) keep_pose(line, span->way[i]);
    line->next = span->to;
    line->open = true;
}

/* Whether one polynomial from the last key meets what is open and the span: what is most likely to be off first. */
static bool joins(const imp_key_line *line, const imp_span *span, imp_key_tolerance tolerance)
{
    const impact_key keys[2] = {line->last, span->to};
    if (!turns_little(keys)) return false;
    const quintic curve = quintic_of(keys);
    const imp_pose middle = pose_of(&line->next);
    return all_meet(&curve, line->way + line->count / 2, line->count - line->count / 2, tolerance) &&
           all_meet(&curve, span->way, 3, tolerance) && all_meet(&curve, line->way, line->count / 2, tolerance) &&
           (!line->open || meets(&curve, &middle, tolerance));
}

bool imp_key_line_add(imp_key_line *line, const imp_span *span, imp_key_tolerance tolerance, imp_key_sink *sink,
                      void *context)
{
    const bool goes_on = line->begun && same_state(line->open ? &line->next : &line->last, &span->from);
    if (goes_on && joins(line, span, tolerance)) {
        grow(line, span);
        return true;
    }
    if (line->open && !hand_on(line, &line->next, sink, context)) return false;
    /* The accelerations differ on either side of a kink: then both stand, before and after it. */
    if (!(goes_on && joins(line, span, tolerance)) && !hand_on(line, &span->from, sink, context)) return false;
    grow(line, span);
    return true;
}

/* Whether the piece is so short on the way from the last key that its end alone is as close a look as quarters are. */
static bool is_quarter(const imp_key_line *line, const imp_piece *piece)
{
    return line->open && 4 * (piece->to - piece->from) <= piece->to - line->last.t;
}

/* The piece, not looked into, joined to what is open. */
static bool join_whole(imp_key_line *line, const imp_piece *piece, int body, imp_key_tolerance tolerance)
{
    if (!is_quarter(line, piece)) return false;
    const impact_key from = piece->begin(piece->context, body), to = piece->at(piece->context, body, 1);
    const impact_key keys[2] = {line->last, to};
    if (!same_state(&line->next, &from) || !turns_little(keys)) return false;
    const quintic curve = quintic_of(keys);
    const imp_pose middle = pose_of(&line->next);
    if (!meets(&curve, &middle, tolerance) || !all_meet(&curve, line->way, line->count, tolerance)) return false;
    keep_pose(line, middle);
    line->next = to;
    return true;
}

typedef struct line_sink {
    imp_key_line *line;
    imp_key_tolerance tolerance;
    imp_key_sink *sink;
    void *context;
} line_sink;

static bool add_span(void *context, const imp_span *span)
{
    const line_sink *to = context;
    return imp_key_line_add(to->line, span, to->tolerance, to->sink, to->context);
}

bool imp_key_line_add_piece(imp_key_line *line, const imp_piece *piece, int body, imp_key_tolerance tolerance,
                            imp_key_sink *sink, void *context, long *unmet)
{
    line_sink to = {line, tolerance, sink, context};
    return join_whole(line, piece, body, tolerance) || imp_key_halve(piece, body, tolerance, add_span, &to, unmet);
}

bool imp_key_line_end(imp_key_line *line, imp_key_sink *sink, void *context)
{
    return !line->open || hand_on(line, &line->next, sink, context);
}
