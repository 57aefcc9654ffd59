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

static bool measure(const gap_case *c, double setting, fcl::GJKSolverType solver, double *gap, qvec3 *normal)
{
    const impact_shape &s1 = c->body[0].shape, &s2 = c->body[1].shape;
    const fcl::Ellipsoidd e1(s1.a, s1.b, s1.c), e2(s2.a, s2.b, s2.c);
    fcl::DistanceRequestd request(true, true);
    request.gjk_solver_type = solver;
    request.distance_tolerance = setting;
    fcl::DistanceResultd result;
    fcl::distance(&e1, place(c->body[0]), &e2, place(c->body[1]), request, result);
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
    {"FCL (its GJK)", independent, 1e-6, false, true},
    {"FCL (its GJK)", independent, 1e-12, false, true},
    {"FCL (libccd)", by_libccd, 1e-6, false, true},
    {"FCL (libccd)", by_libccd, 1e-10, false, true},
    {nullptr, nullptr, 0, false, false},
};
#else
extern "C" const gap_peer gap_peers_fcl[] = {{nullptr, nullptr, 0, false, false}};
#endif
