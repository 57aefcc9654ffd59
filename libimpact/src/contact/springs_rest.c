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
 * The slip u'_t is that of the end. Until then it turns to it, by an angle that falls as D does, and friction turns
 * with it. What friction has been off the slip that is left since the moment before, along e = u'_t/|u'_t|,
 *
 *     m'' = p''_t - p'_t + mu (p''_n - p'_n) e
 *
 * is of second order too: of what is to come M = m'' D''^2/(D'^2 - D''^2) is not against u'_t, and it pushes beside P,
 * u' = u + W (P + M). What that misses is of third order. With R^2 = (D'^2 - D''^2)/(D^2 - D'^2), of which m' told m''
 * to be R^2 m', m'' = a + b, m' = a/R^2 + b/R^3, and of M
 *
 *     b (R^2/(1 - R^2) - R^3/(1 - R^3)),   b = (R^2 m' - m'')/(1/R - 1)
 *
 * is too much, and is waited for until that does nothing.
 *
 * That they do come to it is not in these equations; the course has to tell.
 */
#include "contact/springs.h"

#include <math.h>
#include "base/tolerances.h"

/* The cone problem of the contacts that take part. */
typedef struct rest {
    int count, *which;
    double *w, *u, *q, *impulse, *after, *last_r, *last_u, *friction; /* q = u + W M */
    double *turned;                                                   /* M, normals 0 */
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
    r.u = r.friction + r.count, r.turned = r.u + width;
    for (size_t i = 0; i < width; i++) {
        const int row = 3 * r.which[i / 3] + (int)(i % 3);
        for (size_t j = 0; j < width; j++)
            r.w[i * width + j] = imp_springs_entry(s, row, 3 * r.which[j / 3] + (int)(j % 3));
        r.q[i] = r.u[i] = s->springs[row / 3].u[row % 3];
        r.turned[i] = 0;
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

/* D^2 at a moment: impulses to come, which are with M, are then more by what has been exchanged since. */
static double distance_at(const imp_springs *s, const rest *r, int moment)
{
    const double *then = imp_springs_impulses_at(s, moment), *now = imp_springs_impulses_at(s, 2);
    const int width = 3 * r->count;
    double sum = 0;
    for (int i = 0; i < width; i++) {
        const int own = 3 * r->which[i / 3] + i % 3;
        double speed = r->after[i] - r->u[i];
        for (int j = 0; j < width; j++) {
            const int other = 3 * r->which[j / 3] + j % 3;
            speed += r->w[i * width + j] * (now[other] - then[other]);
        }
        sum += (r->impulse[i] + r->turned[i] + now[own] - then[own]) * speed;
    }
    return sum;
}

/* Of what is of second order: what is to come, of what was since the moment before; and of what m' told of m'' wrong
 * what M is off by. */
typedef struct rest_course {
    double share, falls, untold;
} rest_course;

/* Whether the motion comes nearer to u'. */
static bool find_rest_course(const imp_springs *s, const rest *r, rest_course *way)
{
    const double first = distance_at(s, r, 0), before = distance_at(s, r, 1), now = distance_at(s, r, 2);
    way->share = now / (before - now);
    way->falls = (before - now) / (first - before);
    const double ratio = sqrt(way->falls), square = way->falls, cube = ratio * square;
    way->untold = (square / (1 - square) - cube / (1 - cube)) / (1 / ratio - 1);
    return now > 0 && now < before;
}

/* Whether friction of contact c is against a slip that is left; slip of nothing has no direction. */
static bool slides_to_rest(const imp_springs *s, const rest *r, int c)
{
    return s->modes[c] == IMP_CONE_SLIDES && r->friction[c] > 0 && hypot(r->after[3 * c + 1], r->after[3 * c + 2]) > 0;
}

/* What friction of contact c, which slides on, has been off the slip that is left from a moment to the next: m. */
static void find_missed(const imp_springs *s, const rest *r, int c, int moment, double missed[2])
{
    const int row = 3 * r->which[c];
    const double *then = &imp_springs_impulses_at(s, moment)[row], *next = &imp_springs_impulses_at(s, moment + 1)[row];
    const double *after = &r->after[3 * c], bound = r->friction[c] * (next[0] - then[0]) / hypot(after[1], after[2]);
    for (int j = 0; j < 2; j++) missed[j] = next[1 + j] - then[1 + j] + bound * after[1 + j];
}

/* Whether that is rounding, by its power: of slip that comes to nothing rounding tells the direction. */
static bool is_against(const imp_springs *s, const rest *r, int c, const double missed[2])
{
    const double *then = imp_springs_impulses_at(s, 1), *now = imp_springs_impulses_at(s, 2);
    double most = 0;
    for (int i = 0; i < r->count; i++) most = fmax(most, now[3 * r->which[i]] - then[3 * r->which[i]]);
    return hypot(r->after[3 * c + 1], r->after[3 * c + 2]) * hypot(missed[0], missed[1]) <= IMP_BOUNCES_ERROR * most;
}

/* M, and q with it; share: of m''. Whether it is any. */
static bool turn_friction(const imp_springs *s, const rest *r, double share)
{
    const int width = 3 * r->count;
    bool turns = false;
    for (int c = 0; c < r->count; c++) {
        double missed[2];
        if (!slides_to_rest(s, r, c)) continue;
        find_missed(s, r, c, 1, missed);
        if (is_against(s, r, c, missed)) continue;
        for (int j = 0; j < 2; j++) r->turned[3 * c + 1 + j] = share * missed[j];
        turns = true;
    }
    for (int i = 0; i < width && turns; i++) {
        r->q[i] = r->u[i];
        for (int j = 0; j < width; j++) r->q[i] += r->w[i * width + j] * r->turned[j];
    }
    return turns;
}

/* Whether friction of contact c has been against the slip that is left, or what of it will not be is told so well that
 * the rest would be none of a velocity: slip that goes on turns to where it is left, by ever less. */
static bool has_slid_so(const imp_springs *s, const rest *r, int c, const rest_course *way)
{
    double before[2], missed[2];
    find_missed(s, r, c, 0, before);
    find_missed(s, r, c, 1, missed);
    if (is_against(s, r, c, missed)) return true;
    if (!(way->falls > 0 && way->falls < 1)) return false;
    const double wrong = hypot(missed[0] - way->falls * before[0], missed[1] - way->falls * before[1]);
    return way->untold * wrong * imp_springs_mobility_along(s, r->which[c]) <= IMP_BOUNCES_ERROR;
}

/* Whether what takes part has done since the moment before as it will: pressed, and slid where slip is left. */
static bool goes_on(const imp_springs *s, const rest *r, const rest_course *way)
{
    const double *then = imp_springs_impulses_at(s, 1), *now = imp_springs_impulses_at(s, 2);
    for (int c = 0; c < r->count; c++) {
        const double pushed = now[3 * r->which[c]] - then[3 * r->which[c]];
        if (!(pushed > 0) || s->modes[c] == IMP_CONE_OPEN) return false;
        if (slides_to_rest(s, r, c) && !has_slid_so(s, r, c, way)) return false;
    }
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
                     *turned = &r->turned[3 * c];
        const double to_come[3] = {r->impulse[3 * c], r->impulse[3 * c + 1] + turned[1],
                                   r->impulse[3 * c + 2] + turned[2]};
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
    rest_course way;
    if (!find_rest(s, &r) || !find_rest_course(s, &r, &way)) return false;
    if (turn_friction(s, &r, way.share) && !(find_rest(s, &r) && find_rest_course(s, &r, &way))) return false;
    if (!goes_on(s, &r, &way) || !is_led_to(&r)) return false;
    go_to_rest(s, &r, way.share);
    return true;
}
