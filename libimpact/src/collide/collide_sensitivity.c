/* SPDX-License-Identifier: MIT
 *
 * How far the answer follows its data: cond(M) alone knows neither of slim bodies, nor of a velocity that nearly
 * vanishes. By the derivative of the flow (collide_variation.c), in double, and in 113 bits where cancellation between
 * the entries of M would show; where CVODE answers alone (a friction law, compliance), by differences.
 */
#include "base/tolerances.h"
#include "collide/collide_columns.h"
#include "collide/collide_units.h"

/* sum of |v|^2 + rho^2 |omega|^2 over the bodies that move, rho^2 the mean moment over the mass; of the difference to
 * `other` if given. */
static double size2(const impact_collision *c, const impact_outcome *o, const impact_outcome *other)
{
    double sum = 0;
    for (int i = 0; i < 2; i++) {
        const impact_collider *body = &c->body[i];
        if (isinf(body->mass)) continue;
        const double rho2 = (body->moments.x + body->moments.y + body->moments.z) / (3 * body->mass);
        const qvec3 v = other ? qvec3_sub(o->velocity[i], other->velocity[i]) : o->velocity[i];
        const qvec3 w = other ? qvec3_sub(o->omega[i], other->omega[i]) : o->omega[i];
        sum += qvec3_dot(v, v) + rho2 * qvec3_dot(w, w);
    }
    return sum;
}

/* ---- by differences ---- */

enum { NUMBERS_OF_BODY = 17 };

static double *number_of_body(impact_collider *b, int k)
{
    double *const all[NUMBERS_OF_BODY] = {
        &b->mass,     &b->moments.x,     &b->moments.y,     &b->moments.z,     &b->offset.x,     &b->offset.y,
        &b->offset.z, &b->velocity.x,    &b->velocity.y,    &b->velocity.z,    &b->omega.x,      &b->omega.y,
        &b->omega.z,  &b->orientation.w, &b->orientation.x, &b->orientation.y, &b->orientation.z};
    return all[k];
}

/* Number k of a collision's data; NULL after the last. */
static double *number_of(impact_collision *c, int k)
{
    double *const all[] = {&c->normal.x, &c->normal.y,    &c->normal.z,
                           &c->friction, &c->restitution, &c->tangential_compliance};
    if (k < 2 * NUMBERS_OF_BODY) return number_of_body(&c->body[k / NUMBERS_OF_BODY], k % NUMBERS_OF_BODY);
    return k < 2 * NUMBERS_OF_BODY + 6 ? all[k - 2 * NUMBERS_OF_BODY] : NULL;
}

/* Every number made a little smaller in turn, which keeps each of them admitted. */
static double by_differences(const impact_collision *collision, const impact_outcome *outcome)
{
    double sum = 0;
    impact_collision c = *collision;
    for (int k = 0; number_of(&c, k); k++) {
        impact_outcome other;
        double *const number = number_of(&c, k), given = *number;
        if (given == 0 || isinf(given)) continue;
        *number -= IMP_COLLIDE_NUDGE * given;
        if (impact_collide(&c, &other) < 0) return NAN;
        *number = given;
        sum += size2(collision, outcome, &other);
    }
    return sum == 0 ? 0 : sqrt(sum / size2(collision, outcome, NULL)) / IMP_COLLIDE_NUDGE;
}

/* ---- by the derivative ---- */

double impact_collide_sensitivity(const impact_collision *collision)
{
    impact_outcome outcome;
    const impact_status status = impact_collide(collision, &outcome);
    if (status < 0) return NAN;
    /* What is not struck keeps the velocities given. */
    if (status == IMPACT_SEPARATING) return size2(collision, &outcome, NULL) > 0 ? 1 : 0;
    if (collision->friction_law || (collision->tangential_compliance > 0 && collision->friction > 0))
        return by_differences(collision, &outcome);
    const imp_units units = imp_units_of(collision);
    const impact_collision scaled = imp_units_scaled(collision, units);
    imp_units_restore(&outcome, imp_units_inverse(units));
    double s = NAN;
    if (outcome.conditioning <= IMP_COLLIDE_VARIED_IN_DOUBLE) s = imp_columns_sensitivity(&scaled, &outcome);
    if (!isfinite(s)) s = imp_second_columns_sensitivity(&scaled, &outcome);
    return isnan(s) ? by_differences(&scaled, &outcome) : s;
}
