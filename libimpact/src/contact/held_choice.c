/* SPDX-License-Identifier: MIT
 *
 * Of contacts that stick the balance leaves forces e_k open that move nothing. Friction holds while some sum
 * r + s_1 e_1 + s_2 e_2 ... is within all cones, so that it is to be chosen amid them, where it stays longest: s
 * maximises
 *
 *     phi(s) = sum log(mu² N² - |f|²) + sum log N - |r + s e|²/(2 R²)      (stick; slide; R: the largest force)
 *
 * which is concave, by searches along one e_k after another. Cones that r is not in yet are widened by as much as it is
 * out of them, N by tau, until it is.
 */
#include "contact/held_choice.h"
#include "contact/held_system.h"

#include <math.h>

/* Of one contact along e: c + 2 b s + a s² stays above 0. */
typedef struct band {
    double a, b, c;
} band;

typedef struct choice {
    const imp_held *held;
    int island;
    double size, wider;  /* R, tau */
    qvec3 *force, *idle; /* per contact: r, e */
} choice;

static qvec3 along_plane(qvec3 v, qvec3 n) { return qvec3_axpy(-qvec3_dot(v, n), n, v); }

static band band_of(const choice *own, int c)
{
    const imp_held_contact *contact = &own->held->contacts[c];
    const double pressure = qvec3_dot(contact->normal, own->force[c]) + own->wider,
                 more = qvec3_dot(contact->normal, own->idle[c]);
    if (contact->mode != IMP_STICK) return (band){0, 0.5 * more, pressure};
    const qvec3 f = along_plane(own->force[c], contact->normal), t = along_plane(own->idle[c], contact->normal);
    const double mu2 = contact->friction * contact->friction;
    return (band){mu2 * more * more - qvec3_dot(t, t), mu2 * pressure * more - qvec3_dot(f, t),
                  mu2 * pressure * pressure - qvec3_dot(f, f)};
}

/* Narrows low < s < high to where the polynomial, above 0 at s = 0, is. */
static void stay_within(band own, double *low, double *high)
{
    const double square = own.b * own.b - own.a * own.c;
    if (square < 0) return;
    const double root = sqrt(square), ends[2] = {own.c / (-own.b - root), own.c / (-own.b + root)};
    for (int k = 0; k < 2; k++) {
        if (ends[k] > 0) *high = fmin(*high, ends[k]);
        if (ends[k] < 0) *low = fmax(*low, ends[k]);
    }
}

static bool is_here(const choice *own, int c) { return own->held->island[c] == own->island; }

/* phi'(s) along e. */
static double climb(const choice *own, double s)
{
    double slope = 0;
    for (int c = own->island; c < own->held->count; c++) {
        if (!is_here(own, c)) continue;
        const band r = band_of(own, c);
        if (r.a == 0 && r.b == 0) continue;
        slope += 2 * (r.b + r.a * s) / (r.c + (2 * r.b + r.a * s) * s);
        slope -= qvec3_dot(qvec3_axpy(s, own->idle[c], own->force[c]), own->idle[c]) / (own->size * own->size);
    }
    return slope;
}

/* Goes to the top of phi along e. */
static void search_along(const choice *own)
{
    enum { HALVINGS = 50 };
    double most = 0;
    for (int c = own->island; c < own->held->count; c++)
        if (is_here(own, c)) most = fmax(most, qvec3_norm(own->idle[c]));
    double low = -own->size / most, high = own->size / most;
    for (int c = own->island; c < own->held->count; c++)
        if (is_here(own, c)) stay_within(band_of(own, c), &low, &high);
    for (int k = 0; k < HALVINGS; k++) {
        const double middle = 0.5 * (low + high);
        *(climb(own, middle) > 0 ? &low : &high) = middle;
    }
    for (int c = own->island; c < own->held->count; c++)
        if (is_here(own, c)) own->force[c] = qvec3_axpy(0.5 * (low + high), own->idle[c], own->force[c]);
}

/* By how much of pressure a force is out of its cone at most. */
static double outside(const choice *own)
{
    double worst = -INFINITY;
    for (int c = own->island; c < own->held->count; c++) {
        if (!is_here(own, c)) continue;
        const imp_held_contact *contact = &own->held->contacts[c];
        const double rubs = contact->mode == IMP_STICK ? qvec3_norm(along_plane(own->force[c], contact->normal)) : 0;
        worst = fmax(worst, (rubs > 0 ? rubs / contact->friction : 0) - qvec3_dot(contact->normal, own->force[c]));
    }
    return worst;
}

/* The forces amid the cones; false where there is no room in them. */
static bool find_middle(choice *own, imp_held *held, int idle)
{
    enum { ROUNDS = 8, SWEEPS = 6 };
    for (int round = 0; round < ROUNDS; round++) {
        const double out = outside(own), near = IMP_MODE_ROUNDING * own->size;
        own->wider = out > -near ? 2 * fmax(out, near) : 0;
        for (int k = 0; k < (idle > 1 ? SWEEPS * idle : 1); k++) {
            imp_system_idle(held, own->island, k % idle, own->idle);
            search_along(own);
        }
        if (own->wider == 0) return true;
    }
    return false;
}

static void choose_forces(imp_held *held, imp_world *world, const imp_state *states, choice *own)
{
    const int idle = imp_system_count_idle(held, world, states, own->island);
    own->size = 0;
    for (int c = 0; c < held->count; c++) {
        own->force[c] = held->contacts[c].force;
        if (is_here(own, c)) own->size = fmax(own->size, qvec3_norm(own->force[c]));
    }
    if (idle == 0 || !(own->size > 0) || !find_middle(own, held, idle)) return;
    for (int c = own->island; c < held->count; c++)
        if (is_here(own, c)) world->pairs[held->contacts[c].pair].rest.reaction = own->force[c];
}

/* Whether one of the island's pairs is marked; not any more. */
static bool take_marks(const imp_held *held, imp_world *world, int island)
{
    bool any = false;
    for (int c = island; c < held->count; c++) {
        imp_pair *pair = &world->pairs[held->contacts[c].pair];
        if (held->island[c] != island || pair->mode != IMP_STICK || !imp_is_incipient(pair)) continue;
        imp_end_incipient(pair);
        any = true;
    }
    return any;
}

impact_status imp_held_choose(imp_held *held, imp_world *world, const imp_state *states, const imp_load *loads)
{
    const size_t count = (size_t)held->count;
    bool any = false;
    qvec3 *room = imp_arena_take(held->arena, 2 * count, sizeof *room);
    if (!room) return IMPACT_ENOMEM;
    for (int c = 0; c < held->count; c++) {
        if (held->island[c] != c || !take_marks(held, world, c) || !held->contacts[c].redundant) continue;
        choice own = {.held = held, .island = c, .force = room, .idle = room + count};
        choose_forces(held, world, states, &own);
        any = true;
    }
    imp_arena_give(held->arena, room);
    if (any) imp_held_solve(held, world, states, loads);
    return IMPACT_OK;
}
