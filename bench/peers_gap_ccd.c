/* SPDX-License-Identifier: MIT
 *
 * libccd as a peer: GJK's yes or no, EPA's and MPR's depth, with our support functions as its callbacks.
 */
#include "peers_gap.h"
#include <quat/rotation.h>

#ifdef HAVE_CCD
#include <ccd/ccd.h>

static void support(const void *object, const ccd_vec3_t *direction, ccd_vec3_t *out)
{
    const impact_solid *body = object;
    qvec3 x;
    const qvec3 d = quat_rotate_inverse(body->orientation, (qvec3){direction->v[0], direction->v[1], direction->v[2]});
    impact_shape_support(&body->shape, d, &x);
    x = qvec3_add(body->position, quat_rotate(body->orientation, x));
    ccdVec3Set(out, x.x, x.y, x.z);
}

static void centre(const void *object, ccd_vec3_t *out)
{
    const impact_solid *body = object;
    ccdVec3Set(out, body->position.x, body->position.y, body->position.z);
}

static ccd_t settings(double tolerance)
{
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = support;
    ccd.center1 = ccd.center2 = centre;
    ccd.max_iterations = 1000;
    if (tolerance > 0) ccd.epa_tolerance = ccd.mpr_tolerance = ccd.dist_tolerance = tolerance;
    return ccd;
}

bool gap_ccd_meets(const impact_solid *one, const impact_solid *other)
{
    const ccd_t ccd = settings(0);
    return ccdGJKIntersect(one, other, &ccd) != 0;
}

static bool gjk(const gap_case *c, double setting, double *gap, qvec3 *normal)
{
    (void)setting, (void)gap, (void)normal;
    return gap_ccd_meets(&c->body[0], &c->body[1]) == (c->gap < 0);
}

/* libccd's direction is the way to move body 2 away: from body 1 to body 2. */
static bool answer(int status, double depth, ccd_vec3_t direction, double *gap, qvec3 *normal)
{
    if (status != 0) return false;
    *gap = -depth;
    *normal = (qvec3){-direction.v[0], -direction.v[1], -direction.v[2]};
    return true;
}

static bool epa(const gap_case *c, double setting, double *gap, qvec3 *normal)
{
    const ccd_t ccd = settings(setting);
    ccd_real_t depth = 0;
    ccd_vec3_t direction, position;
    const int status = ccdGJKPenetration(&c->body[0], &c->body[1], &ccd, &depth, &direction, &position);
    return answer(status, depth, direction, gap, normal);
}

static bool mpr(const gap_case *c, double setting, double *gap, qvec3 *normal)
{
    const ccd_t ccd = settings(setting);
    ccd_real_t depth = 0;
    ccd_vec3_t direction, position;
    const int status = ccdMPRPenetration(&c->body[0], &c->body[1], &ccd, &depth, &direction, &position);
    return answer(status, depth, direction, gap, normal);
}

const gap_peer gap_peers_ccd[] = {
    {"libccd GJK", gjk, 0, GAP_ALL, NULL},         {"libccd EPA", epa, 1e-4, GAP_OVERLAPS, NULL},
    {"libccd EPA", epa, 1e-6, GAP_OVERLAPS, NULL}, {"libccd EPA", epa, 1e-8, GAP_OVERLAPS, NULL},
    {"libccd MPR", mpr, 1e-4, GAP_OVERLAPS, NULL}, {"libccd MPR", mpr, 1e-6, GAP_OVERLAPS, NULL},
    {"libccd MPR", mpr, 1e-8, GAP_OVERLAPS, NULL}, {NULL, NULL, 0, GAP_ALL, NULL},
};
#else
bool gap_ccd_meets(const impact_solid *one, const impact_solid *other)
{
    (void)one, (void)other;
    return false;
}
const gap_peer gap_peers_ccd[] = {{NULL, NULL, 0, GAP_ALL, NULL}};
#endif
