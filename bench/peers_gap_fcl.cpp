// SPDX-License-Identifier: MIT
//
// FCL as a peer, for its ellipsoids where they are apart (where they overlap its assertions abort the process):
// distance and normal by its own GJK and by the one it takes from libccd.
#include "peers_gap.h"

#ifdef HAVE_FCL
#include <fcl/fcl.h>

static fcl::Transform3d place(const impact_solid &body)
{
    fcl::Transform3d t = fcl::Transform3d::Identity();
    const quat q = body.orientation;
    t.linear() = fcl::Quaterniond(q.w, q.x, q.y, q.z).toRotationMatrix();
    t.translation() = fcl::Vector3d(body.position.x, body.position.y, body.position.z);
    return t;
}

static fcl::DistanceResultd ask(const impact_solid &one, const impact_solid &other, double tolerance, bool points,
                                fcl::GJKSolverType solver)
{
    const fcl::Ellipsoidd e1(one.shape.a, one.shape.b, one.shape.c), e2(other.shape.a, other.shape.b, other.shape.c);
    fcl::DistanceRequestd request(points, points);
    request.gjk_solver_type = solver;
    request.distance_tolerance = tolerance;
    fcl::DistanceResultd result;
    fcl::distance(&e1, place(one), &e2, place(other), request, result);
    return result;
}

extern "C" double gap_fcl_distance(const impact_solid *one, const impact_solid *other, double tolerance)
{
    return ask(*one, *other, tolerance, false, fcl::GST_INDEP).min_distance;
}

static bool measure(const gap_case *c, double setting, fcl::GJKSolverType solver, double *gap, qvec3 *normal)
{
    const fcl::DistanceResultd result = ask(c->body[0], c->body[1], setting, true, solver);
    *gap = result.min_distance;
    const fcl::Vector3d d = (result.nearest_points[0] - result.nearest_points[1]) * (result.min_distance < 0 ? -1 : 1);
    if (d.norm() > 0) *normal = qvec3{d.x() / d.norm(), d.y() / d.norm(), d.z() / d.norm()};
    return (*gap < 0) == (c->gap < 0);
}

static bool independent(const gap_case *c, double setting, double *gap, qvec3 *normal)
{
    return measure(c, setting, fcl::GST_INDEP, gap, normal);
}

static bool by_libccd(const gap_case *c, double setting, double *gap, qvec3 *normal)
{
    return measure(c, setting, fcl::GST_LIBCCD, gap, normal);
}

extern "C" const gap_peer gap_peers_fcl[] = {
    {"FCL (its GJK)", independent, 1e-6, GAP_ELLIPSOIDS_APART, nullptr},
    {"FCL (its GJK)", independent, 1e-12, GAP_ELLIPSOIDS_APART, nullptr},
    {"FCL (libccd)", by_libccd, 1e-6, GAP_ELLIPSOIDS_APART, nullptr},
    {"FCL (libccd)", by_libccd, 1e-10, GAP_ELLIPSOIDS_APART, nullptr},
    {nullptr, nullptr, 0, GAP_ALL, nullptr},
};
#else
extern "C" double gap_fcl_distance(const impact_solid *, const impact_solid *, double) { return NAN; }
extern "C" const gap_peer gap_peers_fcl[] = {{nullptr, nullptr, 0, GAP_ALL, nullptr}};
#endif
