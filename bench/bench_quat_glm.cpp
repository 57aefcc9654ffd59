// SPDX-License-Identifier: MIT
#include "bench_quat_peer.h"

#ifdef HAVE_GLM
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace
{

struct Ops {
    using Quat = glm::dquat;
    using Vec = glm::dvec3;
    using Mat = glm::dmat3;

    static Quat identity() { return Quat(1, 0, 0, 0); }
    static Quat quat(const double *a) { return Quat(a[0], a[1], a[2], a[3]); }
    static Mat mat(const double *c) { return Mat(c[0], c[3], c[6], c[1], c[4], c[7], c[2], c[5], c[8]); } // by columns
    static void put(const Quat &r, double *out) { out[0] = r.w, out[1] = r.x, out[2] = r.y, out[3] = r.z; }
    static double at(const Mat &r, int row, int column) { return r[column][row]; }

    static Quat normalized(const Quat &a) { return glm::normalize(a); }
    static Mat to_matrix(const Quat &a) { return glm::mat3_cast(a); }
    static Quat from_matrix(const Mat &r) { return glm::quat_cast(r); }
    static void apply(const Mat &r, const Vec &a, Vec &out) { out = r * a; }
    static Quat slerp(const Quat &a, const Quat &b, double t) { return glm::slerp(a, b, t); }
};
using Glm = Peer<Ops>;

} // namespace

const bench_contestant bench_glm = {"GLM", "double", Glm::load, Glm::run, Glm::fetch, Glm::can, 1};
#else
const bench_contestant bench_glm = {"GLM", nullptr, nullptr, nullptr, nullptr, nullptr, 1};
#endif
