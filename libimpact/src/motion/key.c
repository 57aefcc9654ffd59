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

/* The polynomial of two keys, ready to be asked: where it starts, and what each weight takes, of the place (a fourth
 * beside it, so that two fill a register) and of the orientation. */
enum { PLACE = 0, TURN = 4, WIDE = 8 };

typedef struct quintic {
    double t, h;
    double start[WIDE], part[5][WIDE];
} quintic;

static void put_state(double out[WIDE], qvec3 x, quat q)
{
    const double all[WIDE] = {x.x, x.y, x.z, 0, q.w, q.x, q.y, q.z};
    memcpy(out, all, sizeof all);
}

static quintic quintic_of(const impact_key keys[2])
{
    const impact_key *a = &keys[0], *b = &keys[1];
    const double h = b->t - a->t, h2 = h * h;
    const turn from = turn_of(a), to = turn_of(b);
    quintic p;
    p.t = a->t, p.h = h;
    put_state(p.start, a->position, a->orientation);
    put_state(p.part[0], qvec3_scale(a->velocity, h), quat_scale(from.rate, h));
    put_state(p.part[1], qvec3_scale(a->acceleration, h2), quat_scale(from.second, h2));
    put_state(p.part[2], qvec3_sub(b->position, a->position), quat_sub(b->orientation, a->orientation));
    put_state(p.part[3], qvec3_scale(b->velocity, h), quat_scale(to.rate, h));
    put_state(p.part[4], qvec3_scale(b->acceleration, h2), quat_scale(to.second, h2));
    return p;
}

static void mix(const quintic *p, weights w, double out[WIDE])
{
    for (int i = 0; i < WIDE; i++) {
        double sum = w.rate0 * p->part[0][i];
        sum = w.second0 * p->part[1][i] + sum;
        sum = w.change * p->part[2][i] + sum;
        sum = w.rate1 * p->part[3][i] + sum;
        out[i] = w.second1 * p->part[4][i] + sum;
    }
}

static void value_at(const quintic *p, double s, double out[WIDE])
{
    mix(p, weights_at(s), out);
    for (int i = 0; i < WIDE; i++) out[i] = p->start[i] + out[i];
}

static qvec3 place_in(const double y[WIDE]) { return (qvec3){y[PLACE], y[PLACE + 1], y[PLACE + 2]}; }
static quat turn_in(const double y[WIDE]) { return (quat){y[TURN], y[TURN + 1], y[TURN + 2], y[TURN + 3]}; }

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
    double value[WIDE], rate[WIDE];
    value_at(&curve, s, value);
    mix(&curve, slopes_at(s), rate);
    const quat p = turn_in(value);
    const quat spin = quat_mul(quat_scale(turn_in(rate), 1 / h), quat_conj(p));
    key.position = place_in(value);
    key.velocity = qvec3_scale(place_in(rate), 1 / h);
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
    return (impact_key){t, index, state->x, state->q, state->v, omega, acceleration, alpha, IMPACT_KEY_QUINTIC};
}

static imp_pose pose_of(const impact_key *key) { return (imp_pose){key->t, key->position, key->orientation}; }

/* ---- whether the polynomial meets the trajectory ---- */

static double square(qvec3 v) { return qvec3_dot(v, v); }

/* A difference d of unit quaternions is a turn of 2 |d|, as long as that is small. */
static bool meets(const quintic *curve, const imp_pose *pose, imp_key_tolerance tolerance)
{
    double y[WIDE];
    value_at(curve, (pose->t - curve->t) / curve->h, y);
    const qvec3 off = qvec3_sub(place_in(y), pose->x);
    const double place = tolerance.place + IMP_KEY_ROUNDINGS * DBL_EPSILON * sqrt(square(pose->x));
    if (!(square(off) <= place * place)) return false;
    const double angle = tolerance.angle + IMP_KEY_ROUNDINGS * DBL_EPSILON;
    return 4 * quat_norm2(quat_sub(quat_unit(turn_in(y)), pose->q)) <= angle * angle;
}

static bool turns_little(const impact_key keys[2])
{
    const double fastest = fmax(square(keys[0].omega), square(keys[1].omega));
    return sqrt(fastest) * (keys[1].t - keys[0].t) <= IMP_KEY_TURN;
}

static double shortest(double from, double to) { return IMP_KEY_ULPS * DBL_EPSILON * fmax(fabs(from), fabs(to)); }

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
    imp_span span;
    span.from = ends[0], span.to = ends[1];
    if (span_meets(h, s, length, &span)) return h->sink(h->context, &span);
    if (depth == IMP_KEY_HALVINGS || ends[1].t - ends[0].t <= shortest(ends[0].t, ends[1].t))
        return hand_on_unmet(h, s, length, &span);
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
    if (line->count == IMP_KEY_WAY) {
        double before = line->last.t, least = INFINITY;
        int crowded = 0;
        for (int i = 0; i < IMP_KEY_WAY - 1; before = line->way[i++].t)
            if (line->way[i + 1].t - before < least) crowded = i, least = line->way[i + 1].t - before;
        line->count--;
        memmove(&line->way[crowded], &line->way[crowded + 1], sizeof pose * (size_t)(line->count - crowded));
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

/* Whether the polynomial meets what is known of the way, where halving would look: at its half, quarter and three
 * quarters, or next after them. The half first, where a quintic is off most. */
static bool quarters_meet(const quintic *curve, const imp_pose *const *way, int count, imp_key_tolerance tolerance)
{
    static const double places[3] = {0.5, 0.25, 0.75};
    for (int k = 0; k < 3; k++) {
        const double t = curve->t + places[k] * curve->h;
        int next = 0;
        while (next < count - 1 && way[next]->t < t) next++;
        if (!meets(curve, way[next], tolerance)) return false;
    }
    return true;
}

/* Whether one polynomial from the last key to `to` meets what is open, where that ends, and so many poses beyond. */
static bool joins(const imp_key_line *line, const impact_key *to, const imp_pose *beyond, int more,
                  imp_key_tolerance tolerance)
{
    const impact_key keys[2] = {line->last, *to};
    const imp_pose *way[IMP_KEY_WAY + 4], middle = pose_of(&line->next);
    int count = 0;
    if (!turns_little(keys)) return false;
    for (int i = 0; i < line->count; i++) way[count++] = &line->way[i];
    if (line->open) way[count++] = &middle;
    for (int i = 0; i < more; i++) way[count++] = &beyond[i];
    const quintic curve = quintic_of(keys);
    return quarters_meet(&curve, way, count, tolerance);
}

bool imp_key_line_add(imp_key_line *line, const imp_span *span, imp_key_tolerance tolerance, imp_key_sink *sink,
                      void *context)
{
    const bool goes_on = line->begun && same_state(line->open ? &line->next : &line->last, &span->from);
    if (goes_on && joins(line, &span->to, span->way, 3, tolerance)) {
        grow(line, span);
        line->lonely = false;
        return true;
    }
    if (line->open && !hand_on(line, &line->next, sink, context)) return false;
    line->lonely = true;
    /* The accelerations differ on either side of a kink: then both stand, before and after it. */
    if (!(goes_on && joins(line, &span->to, span->way, 3, tolerance)) && !hand_on(line, &span->from, sink, context))
        return false;
    grow(line, span);
    return true;
}

/* A piece so short on the way from the last key that no halving of it is a closer look: of a quarter of the way its end
 * is enough, of a half its middle as well. Where the last did not join, as in fixed steps with a kink at each, the
 * closer look comes first. */
static bool join_whole(imp_key_line *line, const imp_piece *piece, int body, imp_key_tolerance tolerance)
{
    const double length = piece->to - piece->from, way = piece->to - line->last.t;
    if (!line->open || 2 * length > way || (4 * length > way && line->lonely)) return false;
    const impact_key from = piece->begin(piece->context, body), to = piece->at(piece->context, body, 1);
    const int looks = 4 * length > way;
    imp_pose middle;
    if (!same_state(&line->next, &from)) return false;
    if (looks) middle = piece->pose(piece->context, body, 0.5);
    if (!joins(line, &to, &middle, looks, tolerance)) return false;
    keep_pose(line, pose_of(&line->next));
    if (looks) keep_pose(line, middle);
    line->lonely = false;
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

bool imp_key_line_add_form(imp_key_line *line, const impact_key *key, imp_key_sink *sink, void *context)
{
    if (line->open && !hand_on(line, &line->next, sink, context)) return false;
    return hand_on(line, key, sink, context);
}

bool imp_key_line_end(imp_key_line *line, imp_key_sink *sink, void *context)
{
    return !line->open || hand_on(line, &line->next, sink, context);
}
