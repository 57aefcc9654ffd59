/* SPDX-License-Identifier: MIT
 *
 * Where bounces end, whatever their rhythm. What bounces on and on comes to rest against one another, but for slip that
 * friction cannot stop; then nothing of it approaches, and friction is against the slip that is left with all its
 * force. All impulses P from now until then are therefore known without following them, by the cone problem
 *
 *     u' = u + W P,   K* contains u' + mu |u_t'| n,   P . (u' + mu |u_t'| n) = 0,   K contains P
 *
 * of the contacts that take part: u' is a constant of the motion, and how far off the motion is from it,
 *
 *     D^2 = P . W P = P . (u' - u),
 *
 * twice the energy of one against the other, comes to nothing. Of what friction does a part is u' . P; the rest, with
 * what dents do, is of second order, -D^2/2 in sum: from one moment to the next -(D'^2 - D''^2)/2, and each contact has
 * its share of what is left as it had of that,
 *
 *     E_end = E'' + u'_t . P_t + (E'' - E' - u'_t . (p''_t - p'_t)) D''^2/(D'^2 - D''^2)
 *
 * The slip u'_t is that of the end. Until then it turns to it, by an angle phi that falls as D does, and friction turns
 * with it: of the impulses to come mu phi P_n is not against u'_t, which is of second order too. It is waited for until
 * that does nothing, with phi as it has been since the moment before.
 *
 * That they do come to it is not in these equations; the course has to tell.
 */
#include "contact/springs.h"

#include <math.h>
#include "base/tolerances.h"

/* The cone problem of the contacts that take part. */
typedef struct rest {
    int count, *which;
    double *w, *q, *impulse, *after, *last_r, *last_u, *friction;
} rest;

static rest take_part(imp_springs *s)
{
    const double *first = imp_springs_impulses_at(s, 0);
    rest r = {.which = s->begin};
    for (int i = 0; i < s->count; i++)
        if (s->springs[i].p[0] != first[3 * i]) r.which[r.count++] = i;
    const size_t width = 3 * (size_t)r.count;
    r.w = s->factor, r.q = r.w + width * width, r.impulse = r.q + width, r.after = r.impulse + width;
    r.last_r = r.after + width, r.last_u = r.last_r + width, r.friction = r.last_u + width;
    for (size_t i = 0; i < width; i++) {
        const int row = 3 * r.which[i / 3] + (int)(i % 3);
        for (size_t j = 0; j < width; j++)
            r.w[i * width + j] = imp_springs_entry(s, row, 3 * r.which[j / 3] + (int)(j % 3));
        r.q[i] = s->springs[row / 3].u[row % 3];
    }
    for (int c = 0; c < r.count; c++) r.friction[c] = s->springs[r.which[c]].friction;
    return r;
}

/* So many times the impulses of last, and the velocities after them. */
static void guess_rest(const imp_springs *s, const rest *r, double times)
{
    const double *then = imp_springs_impulses_at(s, 1), *now = imp_springs_impulses_at(s, 2);
    const int width = 3 * r->count;
    for (int i = 0; i < width; i++) {
        const int own = 3 * r->which[i / 3] + i % 3;
        r->last_r[i] = times * (now[own] - then[own]);
    }
    for (int i = 0; i < width; i++) {
        r->last_u[i] = r->q[i];
        for (int j = 0; j < width; j++) r->last_u[i] += r->w[i * width + j] * r->last_r[j];
    }
}

/* Of several answers the one that the course goes towards; where Newton's steps do not lead from there to one, that to
 * which paths do. */
static bool find_rest(imp_springs *s, const rest *r)
{
    imp_cone_outcome o = {.status = IMP_CONE_UNSETTLED};
    for (int paths = 0; paths < 2 && o.status == IMP_CONE_UNSETTLED; paths++) {
        const imp_cone_problem problem = {.count = r->count,
                                          .w = r->w,
                                          .q = r->q,
                                          .friction = r->friction,
                                          .last_r = r->last_r,
                                          .last_u = r->last_u,
                                          .near_last = !paths,
                                          .effort = IMP_CONE_BRIEF};
        o = imp_cone_solve(&problem, s->cone, r->impulse, r->after, s->modes);
        s->work += o.factorings * pow(3 * r->count, 3);
    }
    return o.status == IMP_CONE_SOLVED || o.status == IMP_CONE_INEXACT;
}

/* D^2 at a moment: impulses to come are then more by what has been exchanged since. */
static double distance_at(const imp_springs *s, const rest *r, int moment)
{
    const double *then = imp_springs_impulses_at(s, moment), *now = imp_springs_impulses_at(s, 2);
    const int width = 3 * r->count;
    double sum = 0;
    for (int i = 0; i < width; i++) {
        const int own = 3 * r->which[i / 3] + i % 3;
        double speed = r->after[i] - r->q[i];
        for (int j = 0; j < width; j++) {
            const int other = 3 * r->which[j / 3] + j % 3;
            speed += r->w[i * width + j] * (now[other] - then[other]);
        }
        sum += (r->impulse[i] + now[own] - then[own]) * speed;
    }
    return sum;
}

/* What friction of contact c, which slides, has been off the slip that is left since the moment before, times that: a
 * power. */
static double power_missed(const imp_springs *s, const rest *r, int c)
{
    const int row = 3 * r->which[c];
    const double *then = &imp_springs_impulses_at(s, 1)[row], *now = &imp_springs_impulses_at(s, 2)[row];
    const double *after = &r->after[3 * c], speed = hypot(after[1], after[2]),
                 bound = r->friction[c] * (now[0] - then[0]);
    return hypot(speed * (now[1] - then[1]) + bound * after[1], speed * (now[2] - then[2]) + bound * after[2]);
}

/* Whether friction of contact c has been against the slip that is left, but for what its power has of rounding: of slip
 * that comes to nothing rounding tells the direction. most: the most that a contact was pushed. Or will be, but for
 * what would be none of a velocity: slip that goes on turns to where it is left, by ever less. */
static bool has_slid_so(const imp_springs *s, const rest *r, int c, double most)
{
    const double *after = &r->after[3 * c], missed = power_missed(s, r, c);
    const double pushed =
        imp_springs_impulses_at(s, 2)[3 * r->which[c]] - imp_springs_impulses_at(s, 1)[3 * r->which[c]];
    return missed <= IMP_BOUNCES_ERROR * most ||
           missed * (r->impulse[3 * c] / pushed) * imp_springs_mobility_along(s, r->which[c]) <=
               IMP_BOUNCES_ERROR * hypot(after[1], after[2]);
}

/* Whether what takes part has done since the moment before as it will: pressed, and slid where slip is left. */
static bool goes_on(const imp_springs *s, const rest *r)
{
    const double *then = imp_springs_impulses_at(s, 1), *now = imp_springs_impulses_at(s, 2);
    double most = 0;
    for (int c = 0; c < r->count; c++) {
        const double pushed = now[3 * r->which[c]] - then[3 * r->which[c]];
        if (!(pushed > 0) || s->modes[c] == IMP_CONE_OPEN) return false;
        most = fmax(most, pushed);
    }
    for (int c = 0; c < r->count; c++)
        if (s->modes[c] == IMP_CONE_SLIDES && r->friction[c] > 0 && !has_slid_so(s, r, c, most)) return false;
    return true;
}

/* Whether the course comes to it: its own ratio leads there too. What bounces on undiminished while something else
 * brings velocities nearer has pushes that do not fall. */
static bool is_led_to(const rest *r)
{
    double most = 0, apart = 0;
    for (int i = 0; i < 3 * r->count; i++) {
        most = fmax(most, fabs(r->impulse[i]));
        apart = fmax(apart, fabs(r->impulse[i] - r->last_r[i]));
    }
    return apart <= IMP_BOUNCES_APART * most;
}

/* u'_t . P_t: what the slip that is left takes of friction's work. */
static double work_of_slip(const imp_springs *s, const rest *r, int c, double x, double y)
{
    return s->modes[c] == IMP_CONE_SLIDES ? r->after[3 * c + 1] * x + r->after[3 * c + 2] * y : 0;
}

static void go_to_rest(imp_springs *s, const rest *r, double share)
{
    for (int c = 0; c < r->count; c++) {
        const int row = 3 * r->which[c];
        const double *p = imp_springs_impulses_at(s, 1) + row, *works = imp_springs_works_at(s, 1) + row,
                     *to_come = &r->impulse[3 * c];
        imp_spring *own = &s->springs[r->which[c]];
        double *work = own->finding->work;
        for (int j = 0; j < 2; j++) work[j] += share * (work[j] - works[j]);
        const double slip = work_of_slip(s, r, c, own->p[1] - p[1], own->p[2] - p[2]);
        work[2] += work_of_slip(s, r, c, to_come[1], to_come[2]) + share * (work[2] - works[2] - slip);
        for (int j = 0; j < 3; j++) own->p[j] += to_come[j];
    }
    imp_springs_find_velocities(s);
}

bool imp_springs_come_to_rest(imp_springs *s, double ratio)
{
    const rest r = take_part(s);
    guess_rest(s, &r, ratio / (1 - ratio));
    if (!find_rest(s, &r) || !goes_on(s, &r) || !is_led_to(&r)) return false;
    const double before = distance_at(s, &r, 1), now = distance_at(s, &r, 2);
    if (!(now > 0 && now < before)) return false;
    go_to_rest(s, &r, now / (before - now));
    return true;
}
