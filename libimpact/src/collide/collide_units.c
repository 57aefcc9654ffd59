/* SPDX-License-Identifier: MIT
 *
 * In units of the reduced mass, the longest arm (or radius of gyration) and the fastest velocity, as powers of two,
 * every admitted number lies within 1e+-100, so that products of three do not overflow. Moments of a body more than
 * 1e12 apart, or masses more than 1e16, leave no digit of the smaller in sums of double precision.
 */
#include "collide/collide_units.h"

#include <float.h>
#include "base/tolerances.h"
#include "collide/collide_frame.h"
#include "collide/collide_report.h"

/* The exponent of the largest entry, or `otherwise` for none. */
static int exponent3(qvec3 v, int otherwise)
{
    const double large = fmax(fmax(fabs(v.x), fabs(v.y)), fabs(v.z));
    return large > 0 ? ilogb(large) : otherwise;
}

static int larger_of(int a, int b) { return a > b ? a : b; }

imp_units imp_units_of(const impact_collision *collision)
{
    enum { NONE = -5000 };
    imp_units units = {5000, NONE, NONE};
    for (int i = 0; i < 2; i++) {
        const impact_collider *body = &collision->body[i];
        units.length = larger_of(units.length, exponent3(body->offset, NONE));
        if (isinf(body->mass)) continue;
        const int mass = ilogb(body->mass);
        units.mass = mass < units.mass ? mass : units.mass;
        units.length = larger_of(units.length, (exponent3(body->moments, 0) - mass) / 2);
    }
    for (int i = 0; i < 2; i++) {
        const impact_collider *body = &collision->body[i];
        const int turning = exponent3(body->omega, NONE) + exponent3(body->offset, NONE);
        units.speed = larger_of(units.speed, larger_of(exponent3(body->velocity, NONE), turning));
    }
    if (units.speed < -1100) units.speed = 0;
    units.mass -= units.mass & 1; /* the root of it is taken */
    return units;
}

static qvec3 shifted(qvec3 v, int by) { return (qvec3){ldexp(v.x, by), ldexp(v.y, by), ldexp(v.z, by)}; }

impact_collision imp_units_scaled(const impact_collision *collision, imp_units units)
{
    impact_collision c = *collision;
    for (int i = 0; i < 2; i++) {
        impact_collider *body = &c.body[i];
        body->offset = shifted(body->offset, -units.length);
        body->velocity = shifted(body->velocity, -units.speed);
        body->omega = shifted(body->omega, units.length - units.speed);
        if (isinf(body->mass)) continue;
        body->mass = ldexp(body->mass, -units.mass);
        body->moments = shifted(body->moments, -units.mass - 2 * units.length);
    }
    return c;
}

imp_units imp_units_inverse(imp_units units) { return (imp_units){-units.mass, -units.length, -units.speed}; }

void imp_units_restore(impact_outcome *o, imp_units units)
{
    const int momentum = units.mass + units.speed, energy = momentum + units.speed;
    double *const momenta[] = {&o->impulse_normal, &o->impulse_tangential, &o->compression_impulse};
    double *const energies[] = {&o->work_compression, &o->work_restitution, &o->work_friction, &o->energy_before,
                                &o->energy_after};
    for (int i = 0; i < 2; i++) {
        o->velocity[i] = shifted(o->velocity[i], units.speed);
        o->omega[i] = shifted(o->omega[i], units.speed - units.length);
    }
    o->impulse = shifted(o->impulse, momentum);
    for (int i = 0; i < o->phase_count; i++) o->phase_impulse[i] = shifted(o->phase_impulse[i], momentum);
    for (int i = 0; i < 3; i++) *momenta[i] = ldexp(*momenta[i], momentum);
    for (int i = 0; i < 5; i++) *energies[i] = ldexp(*energies[i], energy);
    o->normal_before = ldexp(o->normal_before, units.speed);
    o->normal_after = ldexp(o->normal_after, units.speed);
}

imp_least imp_units_least(imp_units units)
{
    const int momentum = units.mass + units.speed;
    return (imp_least){ldexp(DBL_MIN, -units.speed), ldexp(DBL_MIN, units.length - units.speed),
                       ldexp(DBL_MIN, -momentum), ldexp(DBL_MIN, -momentum - units.speed)};
}

/* ---- the range ---- */

static impact_status check_scaled(const impact_collider *body, int number, char *message, size_t size)
{
    if (isinf(body->mass)) return IMPACT_OK;
    const qvec3 j = body->moments;
    const double most = fmax(fmax(j.x, j.y), j.z), least = fmin(fmin(j.x, j.y), j.z);
    if (!(most / least <= IMP_COLLIDE_MOMENTS_APART))
        return imp_collide_refuse(message, size, IMPACT_EARGUMENT, "body %d: moments spread over %.3g, at most %g",
                                  number, most / least, IMP_COLLIDE_MOMENTS_APART);
    if (!(least >= 1 / IMP_COLLIDE_RANGE))
        return imp_collide_refuse(message, size, IMPACT_EARGUMENT,
                                  "body %d: a moment is %.3g of the reduced mass times the longest arm squared, at "
                                  "least %g",
                                  number, least, 1 / IMP_COLLIDE_RANGE);
    const double arm = qvec3_norm(body->offset);
    if (arm > 0 && !(arm >= 1 / IMP_COLLIDE_RANGE))
        return imp_collide_refuse(
            message, size, IMPACT_EARGUMENT,
            "body %d: its arm is %.3g of the longest arm or radius of gyration, at least %g, or 0", number, arm,
            1 / IMP_COLLIDE_RANGE);
    return IMPACT_OK;
}

/* The outcome tells energies in the caller's units. */
static impact_status check_energy_range(const imp_ready *ready, imp_units units, char *message, size_t size)
{
    const imp_vectors omega = imp_ready_local(ready, &ready->omega);
    const double power = log2(imp_report_energy(ready, &ready->velocity, &omega)) + units.mass + 2.0 * units.speed;
    if (!(power >= DBL_MAX_EXP)) return IMPACT_OK;
    return imp_collide_refuse(message, size, IMPACT_EDOMAIN,
                              "the kinetic energy is about 1e%+.0f J, must be below %.2g", power * log10(2), DBL_MAX);
}

static impact_status check_speeds(const impact_collision *scaled, imp_units units, char *message, size_t size)
{
    imp_ready ready;
    imp_ready_make(scaled, &ready);
    const impact_status status = check_energy_range(&ready, units, message, size);
    if (status != IMPACT_OK) return status;
    const double approach = -imp_vec_dot(imp_ready_velocity(&ready), imp_frame_normal(scaled));
    if (!(approach > 0 && approach < 1 / IMP_COLLIDE_RANGE)) return IMPACT_OK;
    return imp_collide_refuse(message, size, IMPACT_EARGUMENT,
                              "the contact points approach at %.3g of the fastest velocity, at least %g", approach,
                              1 / IMP_COLLIDE_RANGE);
}

impact_status imp_units_check(const impact_collision *collision, char *message, size_t size)
{
    const double ratio = collision->body[0].mass / collision->body[1].mass, apart = fmax(ratio, 1 / ratio);
    if (isfinite(collision->body[0].mass) && isfinite(collision->body[1].mass) && !(apart <= IMP_COLLIDE_MASSES_APART))
        return imp_collide_refuse(message, size, IMPACT_EARGUMENT, "the masses are %.3g apart, at most %g", apart,
                                  IMP_COLLIDE_MASSES_APART);
    if (!(collision->friction <= IMP_COLLIDE_RANGE))
        return imp_collide_refuse(message, size, IMPACT_EARGUMENT, "friction is %g, must be at most %g",
                                  collision->friction, IMP_COLLIDE_RANGE);
    if (!(collision->restitution <= IMP_COLLIDE_RANGE))
        return imp_collide_refuse(message, size, IMPACT_EARGUMENT, "restitution is %g, must be at most %g",
                                  collision->restitution, IMP_COLLIDE_RANGE);
    const imp_units units = imp_units_of(collision);
    const impact_collision scaled = imp_units_scaled(collision, units);
    for (int i = 0; i < 2; i++) {
        const impact_status status = check_scaled(&scaled.body[i], i + 1, message, size);
        if (status != IMPACT_OK) return status;
    }
    return check_speeds(&scaled, units, message, size);
}
