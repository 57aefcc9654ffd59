/* SPDX-License-Identifier: MIT
 *
 * The central path F(z, e) = 0 from e = 1 to e = 1e-10. The determinant of -F' is above zero at its start; where it
 * changes its sign the path has a fold: e is no measure along it any more, its arc length is.
 */
#include "base/tolerances.h"
#include "contact/cone_map.h"

#include <math.h>
#include <string.h>

static void copy(double *to, const double *from, int n) { memcpy(to, from, sizeof *to * (size_t)n); }

/* ---- by e ---- */

/* What of e |F| may be on the path: on that which has folds to go round, and ends in an answer, so little that what is
 * followed is the path itself. */
static double nearness(const imp_cone_system *system) { return system->kindles ? IMP_CONE_ON_PATH : IMP_CONE_NEAR; }

/* From e to the next: the tangent, then Newton; false, and z as before, where that fails. */
static bool go_down(imp_cone_system *system, double e, double next)
{
    enum { MOST = 10 };
    const int n = system->n;
    copy(system->kept, system->z, n);
    imp_cone_factor(system, system->z, e);
    if (system->sign > 0 || e <= IMP_CONE_ARC_LEAST) {
        imp_cone_drift(system, system->z, e, system->step);
        imp_cone_back(system, system->step);
        for (int i = 0; i < n; i++) system->z[i] += (next * next - e * e) * system->step[i];
        if (imp_cone_newton(system, next, nearness(system) * next, MOST, next > IMP_CONE_ARC_LEAST)) return true;
    }
    copy(system->z, system->kept, n);
    return false;
}

/* Down to the end, or to where no step goes on; the last e. */
static double descend(imp_cone_system *system, double e, double end)
{
    double ratio = 0.1;
    while (e > end && !imp_cone_is_spent(system)) {
        const double next = fmax(end, ratio * e);
        const int before = system->steps;
        if (go_down(system, e, next)) {
            e = next;
            if (system->steps - before <= 2) ratio = fmax(IMP_CONE_STRIDE, ratio * ratio);
        } else {
            ratio = pow(ratio, 0.4);
            if (ratio > IMP_CONE_SLOW) break;
        }
    }
    return e;
}

/* ---- by arc length ---- */

/* Where the path is and where it goes, in z (of the system) and ln e, measured by |dz_c|/max(|z_c|, e). */
typedef struct cone_arc {
    double log_e, along; /* d(ln e) of the unit tangent */
} cone_arc;

static double weight_of(const imp_cone_system *system, const double *z, int c, double e)
{
    double square = 0;
    for (int i = system->start[c]; i < system->start[c + 1]; i++) square += z[i] * z[i];
    return 1 / fmax(square, e * e);
}

static double weighted_product(const imp_cone_system *system, const double *a, const double *b, double e)
{
    double sum = 0;
    for (int c = 0; c < system->count; c++) {
        double own = 0;
        for (int i = system->start[c]; i < system->start[c + 1]; i++) own += a[i] * b[i];
        sum += own * weight_of(system, system->kept, c, e);
    }
    return sum;
}

/* dz/d(ln e), into rate; false where the matrix is singular to the last digit. */
static bool find_slope(imp_cone_system *system, const double *z, double e)
{
    imp_cone_factor(system, z, e);
    if (system->sign == 0) return false;
    imp_cone_drift(system, z, e, system->rate);
    for (int i = 0; i < system->n; i++) system->rate[i] *= 2 * e * e;
    imp_cone_back(system, system->rate);
    return true;
}

/* The unit tangent at z, on from the last: e falls where the determinant is above zero. */
static bool find_tangent(imp_cone_system *system, cone_arc *arc)
{
    const double e = exp(arc->log_e);
    copy(system->kept, system->z, system->n);
    if (!find_slope(system, system->z, e)) return false;
    const double length = sqrt(1 + weighted_product(system, system->rate, system->rate, e));
    arc->along = -system->sign / length;
    for (int i = 0; i < system->n; i++) system->tangent[i] = arc->along * system->rate[i];
    return true;
}

/* Newton's steps across the tangent onto the path, from the point that a step along it gave; false where they fail. */
static bool correct_arc(imp_cone_system *system, const cone_arc *arc, double *log_e, int *used)
{
    enum { MOST = 8 };
    const int n = system->n;
    double before = INFINITY;
    for (*used = 0; *used < MOST; (*used)++) {
        const double e = exp(*log_e);
        const double norm = imp_cone_defect(system, system->z, e, system->step);
        if (norm <= IMP_CONE_ON_PATH * e) return true;
        if (!(norm < 2 * before)) return false;
        before = norm;
        copy(system->value, system->step, n);
        if (!find_slope(system, system->z, e)) return false;
        imp_cone_back(system, system->value); /* dz = value + rate d(ln e), tangent . (dz, d(ln e)) = 0 */
        const double metric = exp(arc->log_e);
        const double change = -weighted_product(system, system->tangent, system->value, metric) /
                              (arc->along + weighted_product(system, system->tangent, system->rate, metric));
        if (!isfinite(change)) return false;
        for (int i = 0; i < n; i++) system->z[i] += system->value[i] + change * system->rate[i];
        *log_e += change;
        system->steps++;
    }
    return false;
}

/* On by arc length round all folds, as far as the steps do not creep; the last e. */
static double turn_round(imp_cone_system *system, double e, int most)
{
    const int before = system->factorings;
    const double widest = 1; /* of a contact's size */
    cone_arc arc = {.log_e = log(e)};
    double length = 0.1;
    while (arc.log_e > log(IMP_CONE_ARC_LEAST) && arc.log_e < 1 && system->factorings - before < most &&
           !imp_cone_is_spent(system)) {
        if (!find_tangent(system, &arc)) break;
        int used = 0;
        bool found = false;
        for (; !found && length > IMP_CONE_CREEP; length *= found ? 1 : 0.4) {
            double log_e = arc.log_e + length * arc.along;
            for (int i = 0; i < system->n; i++) system->z[i] = system->kept[i] + length * system->tangent[i];
            found = correct_arc(system, &arc, &log_e, &used);
            if (found) arc.log_e = log_e;
        }
        if (!found) {
            copy(system->z, system->kept, system->n);
            break;
        }
        if (used <= 3) length = fmin(widest, 2 * length);
    }
    return exp(arc.log_e);
}

/* ---- by A + alpha 1 ---- */

/* The normal of tied lobes is their mean; their tie stays. */
static void ease(imp_cone_system *system, double alpha)
{
    const size_t n = (size_t)system->n;
    const double more = alpha - system->eased;
    for (int c = 0; c < system->count; c++) {
        const bool ties = c + 1 < system->count && system->tied[c + 1];
        for (size_t i = (size_t)system->start[c]; i < (size_t)system->start[c + 1]; i++) {
            const bool normal = i == (size_t)system->start[c];
            if (normal && system->tied[c]) continue;
            system->a[i * n + i] += normal && ties ? 0.5 * more : more;
            if (normal && ties) system->a[i * n + (size_t)system->start[c + 1]] += 0.5 * more;
        }
    }
    system->eased = alpha;
}

/* Alpha from where it is to 0 at a fixed e; false where a step fails. */
static bool tighten(imp_cone_system *system, double e)
{
    enum { MOST = 10 };
    double ratio = 0.5;
    while (system->eased > 0) {
        const double before = system->eased, next = ratio * before;
        const int steps = system->steps;
        copy(system->kept, system->z, system->n);
        ease(system, next > IMP_CONE_NEAR * e * e ? next : 0);
        if (imp_cone_newton(system, e, IMP_CONE_NEAR * e, MOST, true)) {
            if (system->steps - steps <= 2) ratio *= ratio;
            continue;
        }
        copy(system->z, system->kept, system->n);
        ease(system, before);
        ratio = pow(ratio, 0.4);
        if (ratio > IMP_CONE_SLOW) return false;
    }
    return true;
}

/* ---- the whole ---- */

static bool begin_path(imp_cone_system *system)
{
    enum { MOST = 60 };
    memset(system->z, 0, sizeof *system->z * (size_t)system->n);
    return imp_cone_newton(system, 1, IMP_CONE_NEAR, MOST, false);
}

/* Linear systems that a path may turn round by. That on which friction sets in ends in an answer where there is one:
 * round as many folds as it has, but where sweeps are all that is asked besides in no more work than theirs. */
static int most_turns(const imp_cone_system *system)
{
    enum { TURNING = 200, KINDLED = 2000 };
    if (!system->kindles) return TURNING;
    if (system->problem->effort == IMP_CONE_WANDERS) return KINDLED;
    return (int)fmin(KINDLED, IMP_CONE_SWEEPING / (2 / 3.0 * pow(system->n, 3)));
}

/* Down from e, by arc length if there is no other way: as far as folds are told from rounding. Below that matrices are
 * taken apart by rank, and where reactions are not unique no determinant tells where the path goes. */
static imp_cone_stage go_on(imp_cone_system *system, double e)
{
    const double last = descend(system, e, system->end);
    if (last <= IMP_CONE_ARC_LEAST) return IMP_CONE_PATH;
    const double turned = turn_round(system, last, most_turns(system));
    if (turned <= IMP_CONE_ARC_LEAST) (void)descend(system, turned, system->end);
    return IMP_CONE_ARC;
}

imp_cone_stage imp_cone_follow(imp_cone_system *system)
{
    return begin_path(system) ? go_on(system, 1) : IMP_CONE_PATH;
}

bool imp_cone_follow_eased(imp_cone_system *system, double e)
{
    ease(system, IMP_CONE_EASING);
    const bool found = begin_path(system) && descend(system, 1, e) <= e && tighten(system, e);
    ease(system, 0);
    if (found) (void)go_on(system, e);
    return found;
}

void imp_cone_kindle(imp_cone_system *system)
{
    memset(system->z, 0, sizeof *system->z * (size_t)system->n);
    (void)imp_cone_defect(system, system->z, 1, system->lift);
    system->kindles = true;
    (void)go_on(system, 1);
    system->kindles = false;
}
