/* SPDX-License-Identifier: MIT
 *
 * The point at r from the centre of a static body moves by drift + spin x r. That field has to be tangential everywhere
 * on the surface: of a plane, a drift along it and a spin about its normal; of other shapes, a spin about an axis on
 * which they are round.
 */
#include "world/surface_velocity.h"
#include "base/tolerances.h"

static quat shape_axes(const impact_body_def *def)
{
    quat body, shape;
    quat_normalize(def->orientation, &body);
    quat_normalize(def->shape_orientation, &shape);
    return quat_mul(body, shape);
}

/* Whether the shape is round about its own axis k = 0, 1, 2: the others' sections are circles. */
static bool is_round(const impact_shape *shape, int k)
{
    const double axis[3] = {shape->a, shape->b, shape->c}, p[3] = {shape->r, shape->s, shape->t};
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    if (shape->kind == IMPACT_SPHERE) return true;
    if (shape->kind == IMPACT_PLANE) return k == 2;
    if (axis[i] != axis[j] || p[i] != 2 || p[j] != 2) return false;
    return shape->kind == IMPACT_SUPERQUADRIC || k == 2 || p[k] == 2;
}

/* The part of omega, in the shape's axes, about axes on which the shape is round: about one of them, or all. */
static qvec3 round_part(const impact_shape *shape, qvec3 omega)
{
    const bool about[3] = {is_round(shape, 0), is_round(shape, 1), is_round(shape, 2)};
    return (qvec3){about[0] ? omega.x : 0, about[1] ? omega.y : 0, about[2] ? omega.z : 0};
}

static bool is_still(qvec3 v) { return v.x == 0 && v.y == 0 && v.z == 0; }

static const char *spin_refusal(const impact_body_def *def)
{
    const qvec3 omega = quat_rotate_inverse(shape_axes(def), def->omega);
    quat q;
    quat_normalize(def->orientation, &q);
    const qvec3 aside = quat_rotate_inverse(shape_axes(def), quat_rotate(q, def->shape_position));
    const double speed = qvec3_norm(omega);
    const bool plane = def->shape.kind == IMPACT_PLANE;
    if (!(qvec3_norm(qvec3_sub(omega, round_part(&def->shape, omega))) <= IMP_SURFACE_CRUMB * speed))
        return plane
                   ? "omega of a static body is its surface's: a plane's must stand along the normal"
                   : "omega of a static body is its surface's: it must stand along an axis on which the shape is round";
    if (plane && (isfinite(def->shape.a) || isfinite(def->shape.b)))
        return "omega of a static body is its surface's: a plane with edges would turn them";
    if (!(qvec3_norm(qvec3_cross(omega, aside)) <= IMP_SURFACE_CRUMB * speed * qvec3_norm(aside)))
        return "omega of a static body is its surface's: its axis must pass through the shape's centre";
    return NULL;
}

const char *imp_surface_velocity_refusal(const impact_body_def *def)
{
    if (!def->is_static) return NULL;
    if (!is_still(def->velocity)) {
        if (def->shape.kind != IMPACT_PLANE)
            return "velocity of a static body is its surface's: only a plane's can move along itself";
        const double off = fabs(qvec3_dot(quat_rotate(shape_axes(def), (qvec3){0, 0, 1}), def->velocity));
        if (!(off <= IMP_SURFACE_CRUMB * qvec3_norm(def->velocity)))
            return "velocity of a static body is its surface's: a plane's must lie along it";
    }
    return is_still(def->omega) ? NULL : spin_refusal(def);
}

void imp_surface_velocity_make(const impact_body_def *def, imp_body *body)
{
    const quat q = shape_axes(def);
    const qvec3 along = quat_rotate_inverse(q, def->velocity);
    body->driven = !is_still(def->velocity) || !is_still(def->omega);
    if (!body->driven) return;
    body->drift = quat_rotate(q, (qvec3){along.x, along.y, 0});
    body->spin = quat_rotate(q, round_part(&def->shape, quat_rotate_inverse(q, def->omega)));
}
