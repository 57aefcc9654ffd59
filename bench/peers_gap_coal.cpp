// SPDX-License-Identifier: MIT
//
// coal as a peer, for its ellipsoids: signed distance and normal by its GJK and EPA at several tolerances, from nothing
// and, warm, from the guess that its last query of the pair left.
#include "peers_gap.h"

#ifdef HAVE_COAL
#include <coal/distance.h>
#include <coal/shape/geometric_shapes.h>
#include <vector>

namespace
{

struct Pair {
    coal::Ellipsoid shape[2] = {coal::Ellipsoid(1, 1, 1), coal::Ellipsoid(1, 1, 1)};
    coal::Transform3s place[2];
    coal::Vec3s guess;
    coal::support_func_guess_t support;
};
std::vector<Pair> pairs;

coal::DistanceRequest request_of(double tolerance)
{
    coal::DistanceRequest request(true, true);
    request.gjk_tolerance = request.epa_tolerance = tolerance;
    request.gjk_max_iterations = request.epa_max_iterations = 1000;
    return request;
}

// The shapes and places in coal's own types, and the guess that a query of a moment ago leaves.
bool load(const gap_case *cases, int count)
{
    pairs.assign(static_cast<std::size_t>(count), Pair());
    for (int i = 0; i < count; i++) {
        Pair &p = pairs[static_cast<std::size_t>(i)];
        for (int k = 0; k < 2; k++) {
            const impact_solid &b = cases[i].body[k];
            const quat q = b.orientation;
            p.shape[k] = coal::Ellipsoid(b.shape.a, b.shape.b, b.shape.c);
            p.shape[k].computeLocalAABB();
            p.place[k] = coal::Transform3s(coal::Quatf(q.w, q.x, q.y, q.z).toRotationMatrix(),
                                           coal::Vec3s(b.position.x, b.position.y, b.position.z));
        }
        coal::DistanceResult result;
        const coal::DistanceRequest request = request_of(1e-6);
        coal::distance(&p.shape[0], p.place[0], &p.shape[1], p.place[1], request, result);
        p.guess = result.cached_gjk_guess;
        p.support = result.cached_support_func_guess;
    }
    return true;
}

// coal's normal is from body 1 to body 2.
bool answer(const Pair &p, const gap_case *c, coal::DistanceRequest &request, double *gap, qvec3 *normal)
{
    coal::DistanceResult result;
    *gap = coal::distance(&p.shape[0], p.place[0], &p.shape[1], p.place[1], request, result);
    *normal = qvec3{-result.normal[0], -result.normal[1], -result.normal[2]};
    return (*gap < 0) == (c->gap < 0);
}

bool cold(const gap_case *c, double setting, double *gap, qvec3 *normal)
{
    coal::DistanceRequest request = request_of(setting);
    return answer(pairs[static_cast<std::size_t>(c->number)], c, request, gap, normal);
}

bool warm(const gap_case *c, double setting, double *gap, qvec3 *normal)
{
    const Pair &p = pairs[static_cast<std::size_t>(c->number)];
    coal::DistanceRequest request = request_of(setting);
    request.gjk_initial_guess = coal::GJKInitialGuess::CachedGuess;
    request.cached_gjk_guess = p.guess;
    request.cached_support_func_guess = p.support;
    return answer(p, c, request, gap, normal);
}

} // namespace

extern "C" const gap_peer gap_peers_coal[] = {
    {"coal", cold, 1e-6, GAP_ELLIPSOIDS, load},      {"coal", cold, 1e-12, GAP_ELLIPSOIDS, load},
    {"coal warm", warm, 1e-6, GAP_ELLIPSOIDS, load}, {"coal warm", warm, 1e-12, GAP_ELLIPSOIDS, load},
    {nullptr, nullptr, 0, GAP_ALL, nullptr},
};
#else
extern "C" const gap_peer gap_peers_coal[] = {{nullptr, nullptr, 0, GAP_ALL, nullptr}};
#endif
