/* SPDX-License-Identifier: MIT
 *
 * gjk: the only file that names libccd. It sees one body, c + B - A, against a point at the origin: along d that body
 * reaches -g(-d).
 *
 * As a source of seeds: libccd stops near 1e-4 rad and misses shallow contacts, so its support callback notes the best
 * of all the directions it asks for. As the textbook has it: GJK finds that the inflated body holds the origin, EPA how
 * deep, and both are taken as they come. EPA compares its tolerance with the square of a distance.
 */
#include <stdint.h>
#include <ccd/ccd.h>
#include "base/parts.h"
#include "gap/gap_solver.h"

#ifndef CCD_DOUBLE
#error "libccd must be built for double"
#endif

enum { MAX_CALLS = 200, MAX_EPA_CALLS = 600 };

typedef struct harvest {
    const imp_gap_solids *pair;
    double g, n[3];
    int calls;
} harvest;

/* After MAX_CALLS the body shrinks to a point, which ends every loop of libccd. */
static void support_difference(const void *object, const ccd_vec3_t *direction, ccd_vec3_t *out)
{
    harvest *h = (harvest *)(uintptr_t)object;
    const double length = sqrt(ccdVec3Len2(direction));
    ccdVec3Set(out, 0, 0, 0);
    if (h->calls++ >= MAX_CALLS || !(length > 0) || !isfinite(length)) return;
    double x[2][3];
    const double n[3] = {-direction->v[0] / length, -direction->v[1] / length, -direction->v[2] / length};
    const double g = imp_pair_gap(h->pair, n, x), *c = h->pair->c;
    if (g > h->g) {
        h->g = g;
        for (int i = 0; i < 3; i++) h->n[i] = n[i];
    }
    ccdVec3Set(out, c[0] + x[1][0] - x[0][0], c[1] + x[1][1] - x[0][1], c[2] + x[1][2] - x[0][2]);
}

static void support_origin(const void *object, const ccd_vec3_t *direction, ccd_vec3_t *out)
{
    (void)object, (void)direction;
    ccdVec3Set(out, 0, 0, 0);
}

static void first_direction(const void *object, const void *origin, ccd_vec3_t *direction)
{
    const harvest *h = object;
    (void)origin;
    ccdVec3Set(direction, -h->n[0], -h->n[1], -h->n[2]);
}

static bool harvest_directions(const imp_gap_solids *pair, double n[3])
{
    harvest h = {.pair = pair, .g = -INFINITY, .n = {n[0], n[1], n[2]}};
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.first_dir = first_direction;
    ccd.support1 = support_difference;
    ccd.support2 = support_origin;
    ccd.max_iterations = 60;
    ccdGJKIntersect(&h, &h, &ccd);
    for (int i = 0; i < 3; i++) n[i] = h.n[i];
    return h.calls > 0;
}

/* ---- its own answer ---- */

typedef struct inflated {
    const imp_gap_solids *pair;
    double rho;
    const double *first; /* direction */
    int calls;
} inflated;

/* After MAX_EPA_CALLS it shrinks to a point, as in a harvest: EPA has no limit of its own. */
static void support_inflated(const void *object, const ccd_vec3_t *direction, ccd_vec3_t *out)
{
    inflated *body = (inflated *)(uintptr_t)object;
    const double length = sqrt(ccdVec3Len2(direction));
    ccdVec3Set(out, 0, 0, 0);
    if (body->calls++ >= MAX_EPA_CALLS || !(length > 0) || !isfinite(length)) return;
    double x[2][3], w[3];
    const double n[3] = {-direction->v[0] / length, -direction->v[1] / length, -direction->v[2] / length};
    imp_pair_gap(body->pair, n, x);
    for (int i = 0; i < 3; i++) w[i] = body->pair->c[i] + x[1][i] - x[0][i] - body->rho * n[i];
    ccdVec3Set(out, w[0], w[1], w[2]);
}

static void given_direction(const void *object, const void *origin, ccd_vec3_t *direction)
{
    const inflated *body = object;
    (void)origin;
    ccdVec3Set(direction, body->first[0], body->first[1], body->first[2]);
}

static bool penetrate(const imp_gap_solids *pair, double rho, const double first[3], double tolerance, double *depth,
                      double n[3])
{
    inflated body = {.pair = pair, .rho = rho, .first = first};
    ccd_t ccd;
    ccd_vec3_t out, place;
    ccd_real_t deep = 0;
    CCD_INIT(&ccd);
    ccd.first_dir = given_direction;
    ccd.support1 = support_inflated;
    ccd.support2 = support_origin;
    ccd.max_iterations = 100;
    ccd.epa_tolerance = tolerance * tolerance;
    ccdVec3Set(&out, 0, 0, 0);
    if (ccdGJKPenetration(&body, &body, &ccd, &deep, &out, &place) != 0 || body.calls > MAX_EPA_CALLS) return false;
    const double length = sqrt(ccdVec3Len2(&out));
    if (!(length > 0) || !isfinite(length) || !isfinite(deep)) return false;
    *depth = deep;
    for (int i = 0; i < 3; i++) n[i] = -out.v[i] / length;
    return true;
}

const imp_gap_ccd *imp_part_ccd(void)
{
    static const imp_gap_ccd table = {.harvest = harvest_directions, .epa = penetrate};
    return &table;
}
