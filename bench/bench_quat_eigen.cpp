// SPDX-License-Identifier: MIT
#include "bench_quat_peer.h"

#ifdef HAVE_EIGEN
#include <Eigen/Geometry>

namespace
{

struct Ops {
    using Quat = Eigen::Quaterniond;
    using Vec = Eigen::Vector3d;
    using Mat = Eigen::Matrix3d;

    static Quat identity() { return Quat::Identity(); }
    static Quat quat(const double *a) { return Quat(a[0], a[1], a[2], a[3]); }
    static Mat mat(const double *c)
    {
        Mat r;
        r << c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7], c[8];
        return r;
    }
    static void put(const Quat &r, double *out) { out[0] = r.w(), out[1] = r.x(), out[2] = r.y(), out[3] = r.z(); }
    static double at(const Mat &r, int row, int column) { return r(row, column); }

    static Quat normalized(const Quat &a) { return a.normalized(); }
    static Mat to_matrix(const Quat &a) { return a.toRotationMatrix(); }
    static Quat from_matrix(const Mat &r) { return Quat(r); }
    static void apply(const Mat &r, const Vec &a, Vec &out) { out.noalias() = r * a; }
    static Quat slerp(const Quat &a, const Quat &b, double t) { return a.slerp(t, b); }
};
using Eigens = Peer<Ops>;

} // namespace

const bench_contestant bench_eigen = {"Eigen", "double", Eigens::load, Eigens::run, Eigens::fetch, Eigens::can, 1};
#else
const bench_contestant bench_eigen = {"Eigen", nullptr, nullptr, nullptr, nullptr, nullptr, 1};
#endif
