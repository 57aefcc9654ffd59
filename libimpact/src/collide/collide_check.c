/* SPDX-License-Identifier: MIT
 *
 * What impact_collide takes, and in which words it refuses the rest.
 */
#include "collide/collide_check.h"
#include "base/number.h"

#include <stdio.h>
#include "base/numbers.h"
#include "base/tolerances.h"
#include "collide/collide_series.h"
#include "collide/collide_units.h"

impact_status imp_collide_refuse(char *message, size_t size, impact_status status, const char *format, ...)
{
    if (size > 0) {
        va_list values;
        va_start(values, format);
        vsnprintf(message, size, format, values);
        va_end(values);
    }
    return status;
}

static impact_status check_vector(const char *name, int number, qvec3 v, char *message, size_t size)
{
    if (imp_all_finite(v)) return IMPACT_OK;
    return imp_collide_refuse(message, size, IMPACT_EDOMAIN, "body %d: %s is (%g, %g, %g), must be finite", number,
                              name, v.x, v.y, v.z);
}

static impact_status check_body(const impact_collider *body, int number, char *message, size_t size)
{
    impact_status status = check_vector("offset", number, body->offset, message, size);
    if (status == IMPACT_OK) status = check_vector("velocity", number, body->velocity, message, size);
    if (status == IMPACT_OK) status = check_vector("omega", number, body->omega, message, size);
    if (status != IMPACT_OK) return status;
    if (isnan(body->mass)) return imp_collide_refuse(message, size, IMPACT_EDOMAIN, "body %d: mass is NaN", number);
    if (!(body->mass > 0))
        return imp_collide_refuse(message, size, IMPACT_EARGUMENT, "body %d: mass is %g, must be > 0", number,
                                  body->mass);
    if (isinf(body->mass)) return IMPACT_OK;
    const qvec3 j = body->moments;
    status = check_vector("moments", number, j, message, size);
    if (status != IMPACT_OK) return status;
    if (!(j.x > 0 && j.y > 0 && j.z > 0))
        return imp_collide_refuse(message, size, IMPACT_EARGUMENT, "body %d: moments are (%g, %g, %g), must be > 0",
                                  number, j.x, j.y, j.z);
    const quat q = body->orientation;
    const double n2 = quat_dot(q, q);
    if (!isfinite(n2))
        return imp_collide_refuse(message, size, IMPACT_EDOMAIN,
                                  "body %d: orientation is (%g, %g, %g, %g), must be a finite unit quaternion", number,
                                  q.w, q.x, q.y, q.z);
    if (!(fabs(n2 - 1) <= IMP_COLLIDE_UNIT))
        return imp_collide_refuse(message, size, IMPACT_EARGUMENT, "body %d: orientation has length %s, must be 1",
                                  number, imp_number_of(sqrt(n2)).text);
    return IMPACT_OK;
}

/* What goes with a given order of the series, with a friction law, with compliance. */
static impact_status check_extras(const impact_collision *collision, char *message, size_t size)
{
    const int order = collision->series_order;
    if (order != 0 && (order < 8 || order > IMP_SERIES_MOST))
        return imp_collide_refuse(message, size, IMPACT_EARGUMENT, "series_order is %d, must be 8 to %d, or 0", order,
                                  IMP_SERIES_MOST);
    const double soft = collision->tangential_compliance;
    if (!isfinite(soft))
        return imp_collide_refuse(message, size, IMPACT_EDOMAIN, "tangential_compliance is %g, must be finite", soft);
    if (!(soft >= 0))
        return imp_collide_refuse(message, size, IMPACT_EARGUMENT, "tangential_compliance is %g, must be >= 0", soft);
    const bool cvode = collision->solver == IMPACT_SOLVER_AUTO || collision->solver == IMPACT_SOLVER_CVODE;
    if ((soft > 0 || collision->friction_law) && !cvode)
        return imp_collide_refuse(message, size, IMPACT_EARGUMENT, "solver is %s, but %s needs cvode",
                                  impact_solver_name(collision->solver),
                                  soft > 0 ? "tangential_compliance" : "a friction law");
    if (soft > 0 && collision->law != IMPACT_STRONGE)
        return imp_collide_refuse(message, size, IMPACT_EARGUMENT, "law is %s, but tangential_compliance needs stronge",
                                  impact_law_name(collision->law));
    if (soft > 0 && (collision->restitution > 1 || collision->friction_law))
        return imp_collide_refuse(message, size, IMPACT_EARGUMENT,
                                  "tangential_compliance takes constant friction and a restitution of at most 1");
    return IMPACT_OK;
}

static impact_status check_contact(const impact_collision *collision, char *message, size_t size)
{
    const qvec3 n = collision->normal;
    if (!imp_all_finite(n))
        return imp_collide_refuse(message, size, IMPACT_EDOMAIN, "normal is (%g, %g, %g), must be finite", n.x, n.y,
                                  n.z);
    if (n.x == 0 && n.y == 0 && n.z == 0)
        return imp_collide_refuse(message, size, IMPACT_EARGUMENT, "normal is (0, 0, 0), must have a direction");
    if (!isfinite(collision->friction))
        return imp_collide_refuse(message, size, IMPACT_EDOMAIN, "friction is %g, must be finite", collision->friction);
    if (!(collision->friction >= 0))
        return imp_collide_refuse(message, size, IMPACT_EARGUMENT, "friction is %g, must be >= 0", collision->friction);
    const double eps = collision->restitution;
    if (!isfinite(eps))
        return imp_collide_refuse(message, size, IMPACT_EDOMAIN, "restitution is %g, must be finite", eps);
    if (!(eps >= 0 && (eps <= 1 || collision->any_restitution)))
        return imp_collide_refuse(message, size, IMPACT_EARGUMENT, "restitution is %g, must be in [0, 1]", eps);
    if ((int)collision->law < IMPACT_POISSON || collision->law > IMPACT_STRONGE)
        return imp_collide_refuse(message, size, IMPACT_EARGUMENT, "law is %d, must be one of impact_law",
                                  (int)collision->law);
    if ((int)collision->solver < IMPACT_SOLVER_AUTO || collision->solver > IMPACT_SOLVER_CVODE)
        return imp_collide_refuse(message, size, IMPACT_EARGUMENT, "solver is %d, must be one of impact_solver",
                                  (int)collision->solver);
    return check_extras(collision, message, size);
}

/* A NaN stays one. */
static inline double size3(qvec3 v) { return fabs(v.x) + fabs(v.y) + fabs(v.z); }

static bool plain_bodies(const impact_collider *one, const impact_collider *two)
{
    const double most = IMP_COLLIDE_ORDINARY, least = 1 / IMP_COLLIDE_ORDINARY;
    const imp_vectors offset = imp_vectors_of(one->offset, two->offset);
    const imp_vectors velocity = imp_vectors_of(one->velocity, two->velocity);
    const imp_vectors omega = imp_vectors_of(one->omega, two->omega);
    const imp_vectors j = imp_vectors_of(one->moments, two->moments);
    const quat p = one->orientation, q = two->orientation;
    const imp_lanes mass = {one->mass, two->mass}, length2 = {quat_dot(p, p), quat_dot(q, q)};
    const imp_lanes slowest = imp_lanes_smaller(imp_lanes_smaller(j.x, j.y), j.z), all = j.x + j.y + j.z;
    const imp_lanes arm = imp_vectors_size(&offset);
    const imp_mask known =
        (arm + (imp_vectors_size(&velocity) + imp_vectors_size(&omega)) <= most) & ((arm >= least) | (arm == 0));
    const imp_mask moves = (mass <= most) & (slowest >= least) & (all <= most) &
                           (all <= IMP_COLLIDE_MOMENTS_APART * slowest) &
                           (imp_lanes_size(length2 - 1) <= IMP_COLLIDE_UNIT);
    const bool near = mass[0] == INFINITY || mass[1] == INFINITY ||
                      (mass[0] <= IMP_COLLIDE_MASSES_APART * mass[1] && mass[1] <= IMP_COLLIDE_MASSES_APART * mass[0]);
    return near && imp_mask_all(known & (mass >= least) & ((mass == INFINITY) | moves)) && imp_mask_any(moves);
}

bool imp_collide_is_plain(const impact_collision *c)
{
    const double size = size3(c->normal);
    return plain_bodies(&c->body[0], &c->body[1]) && size <= DBL_MAX && size > 0 && c->friction >= 0 &&
           c->friction <= IMP_COLLIDE_ORDINARY && c->restitution >= 0 && c->restitution <= 1 &&
           (unsigned)c->law <= IMPACT_STRONGE && (unsigned)c->solver <= IMPACT_SOLVER_CVODE && c->series_order == 0 &&
           c->tangential_compliance == 0 && !c->friction_law;
}

impact_status impact_collide_check(const impact_collision *collision, char *message, size_t size)
{
    if (size > 0) message[0] = '\0';
    for (int i = 0; i < 2; i++) {
        const impact_status status = check_body(&collision->body[i], i + 1, message, size);
        if (status != IMPACT_OK) return status;
    }
    if (isinf(collision->body[0].mass) && isinf(collision->body[1].mass))
        return imp_collide_refuse(message, size, IMPACT_EARGUMENT, "both bodies are static (mass inf): one must move");
    const impact_status status = check_contact(collision, message, size);
    return status == IMPACT_OK ? imp_units_check(collision, message, size) : status;
}
