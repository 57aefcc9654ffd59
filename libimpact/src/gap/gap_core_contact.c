/* SPDX-License-Identifier: MIT
 *
 * Two solids as a pair of polytopes with balls: the gap of the cores less both radii, exactly, in either sign.
 */
#include <quat/rotation.h>
#include "gap/gap_core.h"
#include "shape/solid.h"

static bool is_octahedron(const impact_shape *s)
{
    return s->kind == IMPACT_SUPERQUADRIC && s->r == 1 && s->s == 1 && s->t == 1;
}

static bool is_polytope(const impact_shape *s)
{
    return s->kind == IMPACT_BOX || s->kind == IMPACT_CAPSULE || s->kind == IMPACT_POLYHEDRON || is_octahedron(s);
}

bool imp_core_takes(const impact_shape *one, const impact_shape *other)
{
    const bool first = is_polytope(one), second = is_polytope(other);
    return (first && second) || (first && other->kind == IMPACT_SPHERE && imp_has_core(one)) ||
           (second && one->kind == IMPACT_SPHERE && imp_has_core(other));
}

/* The core, and the ball's radius. */
static double core_of(const impact_shape *shape, double scale, imp_core *core)
{
    const bool even = shape->kind == IMPACT_SPHERE || shape->kind == IMPACT_POLYHEDRON;
    *core = (imp_core){.hull = imp_core_hull(shape), .axis = {scale, scale, scale}, .even = even};
    if (even) return shape->kind == IMPACT_SPHERE ? shape->a : shape->rounding;
    imp_core_axes(shape, core->axis);
    for (int k = 0; k < 3; k++) core->axis[k] *= scale;
    return shape->rounding;
}

static qvec3 turned(quat q, const double x[3], double scale)
{
    return qvec3_scale(quat_rotate(q, (qvec3){x[0], x[1], x[2]}), scale);
}

impact_status imp_core_contact(const impact_solid *body1, quat q1, const impact_solid *body2, quat q2, double scale,
                               impact_gap_cache *cache, impact_contact *contact)
{
    imp_core_pair pair;
    imp_core_gap answer;
    const double r2 = core_of(&body2->shape, scale, &pair.core[0]), r1 = core_of(&body1->shape, scale, &pair.core[1]);
    const qmat3 R = quat_to_matrix(quat_mul(quat_conj(q2), q1));
    const qvec3 c = qvec3_scale(quat_rotate_inverse(q2, qvec3_sub(body1->position, body2->position)), scale);
    const impact_shape *s = &body1->shape, *t = &body2->shape;
    pair.box[0] = t->kind == IMPACT_BOX, pair.box[1] = s->kind == IMPACT_BOX;
    pair.c[0] = c.x, pair.c[1] = c.y, pair.c[2] = c.z;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) pair.R[i][j] = R.m[i][j];
    pair.reach = scale * fmax(fmax(fmax(s->a, s->b), s->c), fmax(fmax(t->a, t->b), t->c)) + qvec3_norm(c);
    const qvec3 seed = cache && cache->valid ? quat_rotate_inverse(q2, cache->normal) : (qvec3){0, 0, 0};
    const double cached[3] = {seed.x, seed.y, seed.z}, back = 1 / scale;
    const impact_status status = imp_core_solve(&pair, cache && cache->valid ? cached : NULL, &answer);
    const qvec3 normal = turned(q2, answer.n, 1);
    *contact = (impact_contact){.gap = answer.gap * back - r1 - r2,
                                .normal = normal,
                                .offset1 = qvec3_axpy(-r1, normal, turned(q2, answer.x[1], back)),
                                .offset2 = qvec3_axpy(r2, normal, turned(q2, answer.x[0], back)),
                                .stiffness = answer.firm ? INFINITY : answer.gap * back,
                                .lower = answer.lower * back - r1 - r2,
                                .upper = answer.upper * back - r1 - r2,
                                .path = IMPACT_PATH_CLOSED_FORM};
    contact->point1 = qvec3_add(body1->position, contact->offset1);
    contact->point2 = qvec3_add(body2->position, contact->offset2);
    if (cache) *cache = (impact_gap_cache){true, normal};
    return status;
}
