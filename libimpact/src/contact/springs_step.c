/* SPDX-License-Identifier: MIT
 *
 * One stretch of the springs' motion: to the first event, as a root of the series, or as far as they reach. What
 * happens at the event itself is seen from where the contacts are then (springs_changes.c), but for slip, which is told
 * here: that it stopped, or that friction no longer holds it.
 */
#include "contact/springs.h"

#include <math.h>
#include "base/tolerances.h"

typedef enum event {
    EVENT_NONE,
    EVENT_TURN,
    EVENT_OPEN,
    EVENT_CLOSE,
    EVENT_AGAIN,
    EVENT_STOP,
    EVENT_GIVE,
    EVENT_SLOW
} event;

typedef struct first_event {
    event what;
    int contact;
    double when;
} first_event;

static double poly(const double *c, int order, double t)
{
    double f = c[order];
    for (int k = order - 1; k >= 0; k--) f = f * t + c[k];
    return f;
}

/* ---- which event comes first ---- */

static void see(first_event *first, event what, int contact, const double *f)
{
    bool found;
    const double when = imp_springs_first_fall(f, IMP_SPRINGS_ORDER, first->when, &found);
    if (found && (first->what == EVENT_NONE || when < first->when)) *first = (first_event){what, contact, when};
}

/* sign * terms + shift */
static void shifted(const double *terms, double sign, double shift, double *f)
{
    for (int k = 0; k <= IMP_SPRINGS_ORDER; k++) f[k] = sign * terms[k];
    f[0] += shift;
}

/* mu^2 lambda^2 - |f_t|^2, times g^2; rounding at its beginning is none of its falling. */
static void find_margin(const imp_springs *s, const imp_spring *c, double *f)
{
    const double friction = c->friction * (s->deficient ? 1 + IMP_SPRINGS_OVER : 1), square = friction * friction;
    for (int k = 0; k <= IMP_SPRINGS_ORDER; k++) {
        f[k] = 0;
        if (k == IMP_SPRINGS_ORDER) break;
        for (int i = 0; i <= k; i++)
            f[k] += square * c->push[0][i] * c->push[0][k - i] - c->push[1][i] * c->push[1][k - i] -
                    c->push[2][i] * c->push[2][k - i];
    }
    const double rounding = IMP_SPRINGS_MARGIN * square * c->push[0][0] * c->push[0][0];
    if (f[0] < rounding) f[0] = rounding;
}

static void see_normal(const imp_springs *s, int i, first_event *first)
{
    const imp_spring *c = &s->springs[i];
    imp_terms f;
    if (c->normal == IMP_SPRING_OPEN) {
        shifted(c->depth, -1, c->tiny, f);
        if (f[0] <= 0) f[0] = IMP_SPRINGS_JUST * c->tiny; /* it has just opened, or touches */
        see(first, EVENT_CLOSE, i, f);
        return;
    }
    const bool root = s->lead == IMP_SPRING_ROOT && s->leader == i;
    shifted(root ? c->root : c->depth, 1, root ? -sqrt(c->tiny) : -c->tiny, f);
    if (f[0] <= 0) f[0] = IMP_SPRINGS_JUST * c->tiny; /* it has just closed */
    see(first, EVENT_OPEN, i, f);
    if (c->normal == IMP_SPRING_LOADS && c->restitution < 1) {
        shifted(c->velocity[0], -1, 0, f);
        see(first, EVENT_TURN, i, f);
    }
    if (c->normal == IMP_SPRING_UNLOADS) {
        shifted(c->depth, -1, imp_springs_again(c), f);
        if (f[0] > 0) see(first, EVENT_AGAIN, i, f);
    }
}

/* Slip that slows down: from its speed; where it begins, speed/t or, weakly, speed/t^2 from what that begins with. */
static void see_slowing(const imp_springs *s, int i, first_event *first)
{
    const imp_spring *c = &s->springs[i];
    const int from = c->slip != IMP_SPRING_BEGINS ? 0 : c->weak ? 2 : 1;
    imp_terms f = {0};
    for (int k = 0; k + from <= IMP_SPRINGS_ORDER; k++) f[k] = c->speed[k + from];
    f[0] *= 1 - IMP_SPRINGS_SLOWED;
    if (f[0] > 0) see(first, EVENT_SLOW, i, f);
}

/* Slip that goes straight to its stop, and comes by it: the stride ends where it is told that it does. */
static void see_turning(const imp_springs *s, int i, first_event *first)
{
    const imp_spring *c = &s->springs[i];
    const double turned = imp_springs_turned(s, i);
    imp_terms f;
    for (int side = -1; side <= 1 && isfinite(turned); side += 2) {
        for (int k = 0; k <= IMP_SPRINGS_ORDER; k++)
            f[k] = side * (c->along[0] * c->velocity[2][k] - c->along[1] * c->velocity[1][k]);
        f[0] += 2 * turned;
        if (f[0] > 0) see(first, EVENT_SLOW, i, f);
    }
}

static void see_slip(const imp_springs *s, int i, first_event *first)
{
    const imp_spring *c = &s->springs[i];
    imp_terms f;
    if (c->normal == IMP_SPRING_OPEN) return;
    if (c->slip == IMP_SPRING_STICKS) {
        find_margin(s, c, f);
        see(first, EVENT_GIVE, i, f);
    } else if (c->slip == IMP_SPRING_STRAIGHT) {
        for (int k = 0; k <= IMP_SPRINGS_ORDER; k++)
            f[k] = c->along[0] * c->velocity[1][k] + c->along[1] * c->velocity[2][k];
        if (f[0] < c->rounding) f[0] = c->rounding; /* it begins, from where it was held: that must not grow */
        see(first, EVENT_STOP, i, f);
        see_turning(s, i, first);
    } else if (s->creeping && c->slip == IMP_SPRING_SLIDES) {
        shifted(c->speed, 1, 0, f);
        if (f[0] < c->rounding) f[0] = c->rounding;
        see(first, EVENT_STOP, i, f);
    } else if (c->slip >= IMP_SPRING_SLIDES && !(s->lead == IMP_SPRING_SPEED && s->leader == i)) {
        see_slowing(s, i, first);
    }
}

/* ---- to there ---- */

static void note_phase(imp_spring *c, bool compressing)
{
    const bool sticks = c->slip == IMP_SPRING_STICKS;
    const unsigned char phase = (unsigned char)(compressing ? sticks ? IMPACT_STICK_C : IMPACT_SLIP_C
                                                : sticks    ? IMPACT_STICK_R
                                                            : IMPACT_SLIP_R);
    imp_finding *f = c->finding;
    if (f->phase_count > 0 && f->phases[f->phase_count - 1] == phase) return;
    if (f->phase_count < IMPACT_MAX_PHASES) f->phases[f->phase_count++] = phase;
}

static void book_energy(imp_spring *c, double energy)
{
    const double rise = energy - c->stored;
    c->finding->work[rise > 0 ? 0 : 1] -= rise;
    c->stored = energy;
}

/* The spring's work to t; where u_n changes its sign on the way the energy has an extreme. What loads and will turn has
 * none before that. */
static void book_spring(const imp_springs *s, imp_spring *c, double t, double after)
{
    const double before = c->velocity[0][0];
    double when[IMP_SPRINGS_EXTREMES];
    bool compressed = before < 0 || (before == 0 && after < 0);
    const bool turns = c->normal == IMP_SPRING_LOADS && c->restitution < 1;
    const int changes =
        turns ? 0 : imp_springs_sign_changes(c->velocity[0], IMP_SPRINGS_ORDER, t, when, IMP_SPRINGS_EXTREMES);
    note_phase(c, compressed);
    for (int k = 0; k < changes; k++) {
        book_energy(c, imp_springs_energy(s, c, poly(c->depth, IMP_SPRINGS_ORDER, when[k])));
        c->finding->compressions += compressed;
        compressed = !compressed;
        note_phase(c, compressed);
    }
    book_energy(c, imp_springs_energy(s, c, c->x));
}

static void book_friction(imp_spring *c, double t)
{
    if (c->slip < IMP_SPRING_SLIDES) return;
    double sum = 0;
    for (int k = IMP_SPRINGS_ORDER - 1; k >= 0; k--) {
        double power = 0;
        for (int i = 0; i <= k; i++)
            power += c->push[1][i] * c->velocity[1][k - i] + c->push[2][i] * c->velocity[2][k - i];
        sum = sum * t + power / (k + 1);
    }
    c->finding->work[2] += sum * t;
}

static void push_on(imp_spring *c, double t)
{
    for (int j = 0; j < 3; j++) {
        if (j > 0 && c->slip == IMP_SPRING_SMOOTH) continue;
        double sum = 0;
        for (int k = IMP_SPRINGS_ORDER - 1; k >= 0; k--) sum = sum * t + c->push[j][k] / (k + 1);
        c->p[j] += sum * t;
    }
}

/* Row i of W times all that has been pushed. */
static double velocity_pushed(const imp_springs *s, int i)
{
    const imp_spring_rows *r = &s->rows;
    double sum = 0;
    for (int k = r->start[i]; k < r->start[i + 1]; k++)
        sum += imp_springs_entry(s, i, r->column[k]) * s->now[r->column[k]];
    return sum;
}

/* The largest sum of terms of the contact's velocities. */
static double terms_of_velocity(const imp_springs *s, int contact)
{
    const imp_spring_rows *r = &s->rows;
    double most = 0;
    for (int i = 3 * contact; i < 3 * contact + (s->springs[contact].friction > 0 ? 3 : 1); i++) {
        double sum = 0;
        for (int k = r->start[i]; k < r->start[i + 1]; k++)
            sum += fabs(imp_springs_entry(s, i, r->column[k]) * s->now[r->column[k]]);
        most = fmax(most, sum);
    }
    return most;
}

/* What the slips that are held have drifted to, by rounding of all steps so far. */
static double drift_of_held(const imp_springs *s)
{
    double most = 0;
    for (int i = 0; i < s->stick_count; i++) most = fmax(most, fabs(s->springs[s->stick[i] / 3].u[s->stick[i] % 3]));
    return most;
}

void imp_springs_find_velocities(imp_springs *s)
{
    for (int i = 0; i < s->count; i++)
        for (int j = 0; j < 3; j++) s->now[3 * i + j] = s->springs[i].p[j];
    for (int i = 0; i < s->count; i++) {
        for (int j = 0; j < 3; j++) s->springs[i].u[j] = s->u0[3 * i + j] + velocity_pushed(s, 3 * i + j);
        s->springs[i].rounding = IMP_SPRINGS_STILL * fmax(1, terms_of_velocity(s, i));
    }
    const double drift = drift_of_held(s);
    for (int i = 0; i < s->count; i++) s->springs[i].none = fmax(s->springs[i].rounding, 2 * drift);
}

/* What has begun to slip slides once its velocity is more than rounding; where slips have begun together, as those of
 * one body do, once all are, or it is much more: beside one at rest those would go by in steps of their own speeds. */
static void go_sliding(imp_springs *s)
{
    bool all = true;
    for (int i = 0; i < s->count; i++) {
        const imp_spring *c = &s->springs[i];
        if (imp_springs_presses(c) && c->slip == IMP_SPRING_BEGINS) all = all && hypot(c->u[1], c->u[2]) > c->none;
    }
    for (int i = 0; i < s->count; i++) {
        imp_spring *c = &s->springs[i];
        const double speed = hypot(c->u[1], c->u[2]);
        if (!imp_springs_presses(c) || c->slip < IMP_SPRING_SLIDES) continue;
        if (speed <= c->none || (c->slip == IMP_SPRING_BEGINS && !all && speed <= IMP_SPRINGS_TOLD * c->none)) continue;
        c->still = false;
        if (c->slip == IMP_SPRING_BEGINS) c->slip = IMP_SPRING_SLIDES;
    }
}

/* Slip that is slow keeps its digits: once it is, or has just begun, it is summed. */
static void sum_slip(imp_spring *c, double t)
{
    double u[2];
    if (!c->summed && !(imp_springs_presses(c) && c->slip == IMP_SPRING_SLIDES &&
                        hypot(c->velocity[1][0], c->velocity[2][0]) <= IMP_SPRINGS_SLOW))
        return;
    for (int j = 0; j < 2; j++) u[j] = poly(c->velocity[1 + j], IMP_SPRINGS_ORDER, t);
    c->summed = imp_springs_presses(c) && c->slip >= IMP_SPRING_SLIDES && hypot(u[0], u[1]) <= IMP_SPRINGS_SLOW;
    for (int j = 0; j < 2 && c->summed; j++) c->u[1 + j] = u[j];
}

static void move_on(imp_springs *s, double t)
{
    for (int i = 0; i < s->count; i++) {
        imp_spring *c = &s->springs[i];
        const bool root = s->lead == IMP_SPRING_ROOT && s->leader == i && c->normal != IMP_SPRING_OPEN;
        const double w = root ? poly(c->root, IMP_SPRINGS_ORDER, t) : 0;
        c->x = root ? w * w : poly(c->depth, IMP_SPRINGS_ORDER, t);
        if (c->normal == IMP_SPRING_OPEN) continue;
        push_on(c, t);
        book_friction(c, t);
    }
    imp_springs_find_velocities(s);
    for (int i = 0; i < s->count; i++) sum_slip(&s->springs[i], t);
    for (int i = 0; i < s->count; i++)
        if (s->springs[i].normal != IMP_SPRING_OPEN) book_spring(s, &s->springs[i], t, s->springs[i].u[0]);
    go_sliding(s);
}

/* ---- what happens there ---- */

/* Friction no longer holds: it slips against what held it; where reactions are not unique, others may hold it yet.
 * Where the contact is about to open the margin vanishes with lambda^2, and its zero may be rounding. */
static bool give_way(imp_springs *s, imp_spring *c, double t)
{
    const double x = poly(c->push[1], IMP_SPRINGS_ORDER - 1, t), y = poly(c->push[2], IMP_SPRINGS_ORDER - 1, t),
                 size = hypot(x, y);
    if (size < (1 - IMP_SPRINGS_HELD) * c->friction * poly(c->push[0], IMP_SPRINGS_ORDER - 1, t)) return true;
    if (s->deficient) {
        s->stopped = true;
        return true;
    }
    c->slip = IMP_SPRING_BEGINS;
    c->weak = true;
    c->along[0] = -x / size, c->along[1] = -y / size;
    imp_springs_tie(s);
    imp_springs_straighten(s);
    return size > 0;
}

static bool take_event(imp_springs *s, const first_event *first)
{
    imp_spring *c = &s->springs[first->contact];
    s->events++;
    switch (first->what) {
    case EVENT_TURN: c->u[0] = fmax(c->u[0], 0); break;
    case EVENT_OPEN: c->x = c->tiny; break;
    case EVENT_CLOSE: c->x = c->tiny; break;
    case EVENT_AGAIN: c->x = fmax(c->x, imp_springs_again(c)); break;
    case EVENT_STOP:
        c->still = true;
        c->slip = IMP_SPRING_STICKS;
        s->stopped = true;
        break;
    case EVENT_GIVE: return give_way(s, c, first->when);
    case EVENT_SLOW:
    case EVENT_NONE: s->events--; break;
    }
    return true;
}

bool imp_springs_step(imp_springs *s)
{
    const double h = imp_springs_expand(s);
    s->steps++;
    if (isnan(h)) return false;
    first_event first = {EVENT_NONE, 0, isfinite(h) ? h : IMP_SPRINGS_FARTHEST};
    for (int i = 0; i < s->count; i++) {
        see_normal(s, i, &first);
        see_slip(s, i, &first);
    }
    move_on(s, first.when);
    return take_event(s, &first);
}

/* Flights between bounces are alike at all sizes: gaps that grow from one to the next, beside which dents are nothing,
 * are taken smaller before they are more than a double holds. */
static void take_gaps_smaller(imp_springs *s)
{
    double farthest = 0;
    for (int i = 0; i < s->count; i++) farthest = fmax(farthest, fabs(s->springs[i].x));
    for (int i = 0; i < s->count && farthest > IMP_SPRINGS_FAR; i++) s->springs[i].x *= IMP_SPRINGS_NEARER;
}

bool imp_springs_drift(imp_springs *s)
{
    take_gaps_smaller(s);
    double soonest = INFINITY;
    int next = -1;
    for (int i = 0; i < s->count; i++) {
        const imp_spring *c = &s->springs[i];
        const double time = c->u[0] < -c->none ? fmax(0, c->tiny - c->x) / -c->u[0] : INFINITY;
        if (time < soonest) soonest = time, next = i;
    }
    if (next < 0) return false;
    for (int i = 0; i < s->count; i++) s->springs[i].x -= s->springs[i].u[0] * soonest;
    s->springs[next].x = s->springs[next].tiny;
    return true;
}
