/* SPDX-License-Identifier: MIT
 *
 * Changes of mode: contacts close (delta = base), turn (u_n = 0), are loaded on beyond where they turned (delta =
 * delta_m), open; slips stop, what is still sticks or begins to slip.
 *
 * A spring whose energy is under 2^-90, where u is of order 1, counts as open, x <= tiny: Hertz's force is not analytic
 * there, and does nothing that a double would hold. Where a spring turns the part 1 - eps^2 of its energy is lost.
 */
#include "contact/springs.h"

#include <math.h>
#include "base/tolerances.h"

double imp_springs_energy(const imp_springs *s, const imp_spring *c, double x)
{
    return x > 0 ? c->kappa * pow(x, s->exponent + 1) / (s->exponent + 1) : 0;
}

void imp_springs_take_branch(imp_springs *s, int contact, imp_spring_normal normal, double base, double kappa)
{
    imp_spring *c = &s->springs[contact];
    const double own = s->w[(size_t)(3 * contact) * (3 * (size_t)s->count + 1)];
    c->normal = normal;
    c->x += c->base - base;
    c->base = base;
    c->kappa = kappa;
    const double least = s->exponent == 1 && c->friction == 0 ? IMP_SPRINGS_ENERGY_LINEAR : IMP_SPRINGS_ENERGY;
    c->tiny = pow((s->exponent + 1) * least / (kappa * own), 1 / (s->exponent + 1));
}

double imp_springs_again(const imp_spring *c)
{
    return IMP_SPRINGS_PAST * c->restitution * c->restitution * c->deepest;
}

static void turn_spring(imp_springs *s, int contact)
{
    imp_spring *c = &s->springs[contact];
    const double square = c->restitution * c->restitution;
    c->deepest = c->x;
    imp_springs_take_branch(s, contact, IMP_SPRING_UNLOADS, (1 - square) * c->deepest,
                            c->stiffness * pow(c->restitution, -2 * s->exponent));
    c->x = square * c->deepest; /* without the difference's rounding */
    c->stored = imp_springs_energy(s, c, c->x);
    c->finding->compressions++;
}

static void open_spring(imp_spring *c)
{
    c->normal = IMP_SPRING_OPEN;
    c->slip = IMP_SPRING_SMOOTH;
    c->still = false;
    c->stored = 0;
}

static void load_on(imp_springs *s, int contact)
{
    imp_spring *c = &s->springs[contact];
    imp_springs_take_branch(s, contact, IMP_SPRING_LOADS, 0, c->stiffness);
    c->stored = imp_springs_energy(s, c, c->x);
}

/* A dent that was hardly one, eps^2 delta_m <= tiny, is loaded on from where it closes: no event would tell that. */
static void close_spring(imp_springs *s, int contact)
{
    imp_spring *c = &s->springs[contact];
    c->normal = c->deepest > 0 ? IMP_SPRING_UNLOADS : IMP_SPRING_LOADS;
    c->x = c->tiny; /* after a long flight x is rounded by far more */
    c->stored = imp_springs_energy(s, c, c->x);
    if (c->normal == IMP_SPRING_UNLOADS && c->x >= imp_springs_again(c)) load_on(s, contact);
    c->summed = false;
    c->still = c->friction > 0 && hypot(c->u[1], c->u[2]) <= c->none;
    c->slip = c->friction == 0 ? IMP_SPRING_SMOOTH : c->still ? IMP_SPRING_STICKS : IMP_SPRING_SLIDES;
    c->along[0] = c->along[1] = 0;
}

/* What is due of the contact's normal; whether anything was. Where nothing is pressed, approach that is rounding is
 * none. */
static bool settle_normal(imp_springs *s, int contact, bool pressed)
{
    imp_spring *c = &s->springs[contact];
    const double again = imp_springs_again(c);
    if (c->normal == IMP_SPRING_OPEN) {
        if (c->x < c->tiny * (1 - IMP_SPRINGS_TOGETHER) || c->u[0] >= (pressed ? 0 : -c->none)) return false;
        close_spring(s, contact);
        if (s->closing < 0 || contact == s->bounces.contact) s->closing = contact;
    } else if (c->x <= c->tiny * (1 + IMP_SPRINGS_TOGETHER) && c->u[0] >= 0) {
        open_spring(c);
    } else if (c->normal == IMP_SPRING_LOADS && c->restitution < 1 && c->u[0] >= 0) {
        turn_spring(s, contact);
    } else if (c->normal == IMP_SPRING_UNLOADS && c->x >= again && c->u[0] < 0) {
        load_on(s, contact);
    } else {
        return false;
    }
    return true;
}

double imp_springs_pace(const imp_springs *s)
{
    double pace = 0, most = 0, rate = 0;
    for (int i = 0; i < s->count; i++) {
        const imp_spring *c = &s->springs[i];
        if (!imp_springs_presses(c)) continue;
        const double force = c->kappa * pow(c->x, s->exponent), stiffness = s->exponent * force / c->x;
        pace = fmax(pace, sqrt(stiffness * imp_springs_entry(s, 3 * i, 3 * i)));
        rate = fmax(rate, stiffness * fabs(c->u[0]));
        most = fmax(most, force);
    }
    return fmax(pace, rate / most);
}

double imp_springs_mobility_along(const imp_springs *s, int contact)
{
    return fmax(imp_springs_entry(s, 3 * contact + 1, 3 * contact + 1),
                imp_springs_entry(s, 3 * contact + 2, 3 * contact + 2));
}

/* Whether the contact opens before its friction could change a velocity by more than rounding: in the time x/u_n its
 * force falls to nothing. */
static bool is_spent(const imp_springs *s, int contact)
{
    const imp_spring *c = &s->springs[contact];
    if (!(c->u[0] > 0)) return false;
    const double left = c->friction * c->kappa * pow(c->x, s->exponent) * c->x / c->u[0];
    return left * imp_springs_mobility_along(s, contact) <= IMP_SPRINGS_SPENT;
}

double imp_springs_turned(const imp_springs *s, int contact)
{
    return is_spent(s, contact) ? INFINITY : IMP_SPRINGS_TOLD * s->springs[contact].none;
}

/* Whether slip that went straight to its stop, all but there, has come by it and goes elsewhere. */
static bool has_turned(const imp_springs *s, int contact)
{
    const imp_spring *c = &s->springs[contact];
    return c->normal != IMP_SPRING_OPEN && c->slip == IMP_SPRING_STRAIGHT && !c->still &&
           fabs(c->along[0] * c->u[2] - c->along[1] * c->u[1]) > imp_springs_turned(s, contact);
}

static double slip_that_is_none(const imp_spring *c)
{
    return c->free ? fmin(c->none, IMP_SPRINGS_TOLD * c->rounding) : c->none;
}

/* What held slips have drifted to is none of a slip that they leave no way of its own. One that they leave free its
 * friction brings to rest: stopped at twice their drift it would be the next that they are measured by, and of two that
 * stop by turns the drift would double each time. */
static void find_free(imp_springs *s)
{
    for (int i = 0; i < s->count; i++) {
        imp_spring *c = &s->springs[i];
        c->free = imp_springs_presses(c) && c->slip == IMP_SPRING_SLIDES && c->none > IMP_SPRINGS_TOLD * c->rounding &&
                  imp_springs_is_free(s, i);
    }
}

/* A slip that is over, or so near its end that its direction is settled: it goes straight to it then. Forces as of now.
 * What it still turns by in the time speed/|along| that is left, and by what forces change in it, is
 * under rounding. Where the contact is about to open, and too little of its friction is left, any direction will do:
 * what begins there, or creeps, is turned by a force that vanishes, and its series hold for no time. */
static bool settle_slip(const imp_springs *s, int contact, imp_spring *c)
{
    if (has_turned(s, contact)) c->slip = IMP_SPRING_SLIDES;
    if (c->normal == IMP_SPRING_OPEN || (c->slip != IMP_SPRING_SLIDES && c->slip != IMP_SPRING_BEGINS)) return false;
    const double speed = hypot(c->u[1], c->u[2]), none = slip_that_is_none(c);
    const bool begins = c->slip == IMP_SPRING_BEGINS, over = !begins && speed <= none,
               spent = !over && is_spent(s, contact);
    if (over) c->still = true;
    if (over || (!spent && (begins || speed > IMP_SPRINGS_SLOW || c->creeps))) return over;
    const double x = imp_springs_row(s, 3 * contact + 1), y = imp_springs_row(s, 3 * contact + 2);
    const double e[2] = {begins ? c->along[0] : c->u[1] / speed, begins ? c->along[1] : c->u[2] / speed};
    const double along = x * e[0] + y * e[1], across = fabs(y * e[0] - x * e[1]);
    if (spent || (along < 0 && speed * (across + imp_springs_pace(s) * speed) <= -none * along)) {
        c->slip = IMP_SPRING_STRAIGHT;
        c->along[0] = e[0], c->along[1] = e[1];
    }
    return false;
}

static bool is_undecided(const imp_spring *c)
{
    return c->normal != IMP_SPRING_OPEN && c->still && c->slip != IMP_SPRING_BEGINS;
}

bool imp_springs_pressed(const imp_springs *s)
{
    for (int i = 0; i < s->count; i++)
        if (s->springs[i].normal != IMP_SPRING_OPEN) return true;
    return false;
}

bool imp_springs_settle(imp_springs *s)
{
    bool changed = s->stopped, undecided = s->stopped, frictional = false;
    const bool pressed = imp_springs_pressed(s);
    s->stopped = false;
    for (int i = 0; i < s->count; i++) {
        const bool was = is_undecided(&s->springs[i]);
        if (settle_normal(s, i, pressed)) {
            changed = true;
            s->events++;
        }
        undecided = undecided || (!was && is_undecided(&s->springs[i]));
        frictional = frictional || (s->springs[i].normal != IMP_SPRING_OPEN && s->springs[i].friction > 0);
    }
    if (changed) imp_springs_pack_pressed(s);
    if (!frictional) {
        s->stick_count = 0;
        return true;
    }
    /* shares that were chosen stay as long as the same contacts stick */
    if (changed && !undecided && !imp_springs_is_tied(s)) {
        imp_springs_tie(s);
        imp_springs_forces(s);
        undecided = imp_springs_is_over(s);
    }
    if (changed && undecided && !imp_springs_choose(s)) return false;
    if (changed) imp_springs_straighten(s);
    find_free(s);
    imp_springs_forces(s);
    for (int i = 0; i < s->count; i++) s->stopped = settle_slip(s, i, &s->springs[i]) || s->stopped;
    return !s->stopped || imp_springs_settle(s);
}
