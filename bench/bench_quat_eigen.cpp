// SPDX-License-Identifier: MIT
#include "bench_quat.h"

#ifdef HAVE_EIGEN
#include <Eigen/Geometry>
#include <vector>

namespace
{

using Quat = Eigen::Quaterniond;
template <class T> using Array = std::vector<T, Eigen::aligned_allocator<T>>;

Array<Quat> p, q, out_q;
std::vector<Eigen::Vector3d> v, out_v;
std::vector<Eigen::Matrix3d> m, out_m;
std::vector<double> t;
Quat product;

void load(const bench_input *in)
{
    p.clear(), q.clear(), v.clear(), m.clear(), t.clear();
    for (std::size_t i = 0; i < in->n; i++) {
        const double *a = in->p + 4 * i, *b = in->q + 4 * i, *c = in->m + 9 * i;
        p.emplace_back(a[0], a[1], a[2], a[3]);
        q.emplace_back(b[0], b[1], b[2], b[3]);
        v.emplace_back(in->v[3 * i], in->v[3 * i + 1], in->v[3 * i + 2]);
        t.push_back(in->t[i]);
        Eigen::Matrix3d r;
        r << c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7], c[8];
        m.push_back(r);
    }
    out_q.resize(in->n), out_v.resize(in->n), out_m.resize(in->n);
}

void run(bench_case which, std::size_t n)
{
    switch (which) {
    case BENCH_PRODUCT:
        for (std::size_t i = 0; i < n; i++) out_q[i] = p[i] * q[i];
        break;
    case BENCH_COMPOSE: {
        Quat r = Quat::Identity();
        for (std::size_t i = 0; i < n; i++) r = r * q[i];
        product = r;
        break;
    }
    case BENCH_NORMALIZE:
        for (std::size_t i = 0; i < n; i++) out_q[i] = p[i].normalized();
        break;
    case BENCH_ROTATE:
        for (std::size_t i = 0; i < n; i++) out_v[i] = q[i] * v[i];
        break;
    case BENCH_ROTATE_ARRAY: {
        const Eigen::Matrix3d r = q[0].toRotationMatrix();
        for (std::size_t i = 0; i < n; i++) out_v[i].noalias() = r * v[i];
        break;
    }
    case BENCH_SLERP:
        for (std::size_t i = 0; i < n; i++) out_q[i] = p[i].slerp(t[i], q[i]);
        break;
    case BENCH_TO_MATRIX:
        for (std::size_t i = 0; i < n; i++) out_m[i] = q[i].toRotationMatrix();
        break;
    case BENCH_FROM_MATRIX:
        for (std::size_t i = 0; i < n; i++) out_q[i] = Quat(m[i]);
        break;
    default: break;
    }
}

void fetch(bench_case which, std::size_t n, double *out)
{
    const auto put = [&](const Quat &r) { *out++ = r.w(), *out++ = r.x(), *out++ = r.y(), *out++ = r.z(); };
    if (which == BENCH_COMPOSE) return put(product);
    for (std::size_t i = 0; i < n; i++) {
        if (bench_width(which) == 4) put(out_q[i]);
        for (int j = 0; bench_width(which) == 3 && j < 3; j++) *out++ = out_v[i][j];
        for (int j = 0; bench_width(which) == 9 && j < 9; j++) *out++ = out_m[i](j / 3, j % 3);
    }
}

int can(bench_case) { return 1; }

} // namespace

const bench_contestant bench_eigen = {"Eigen", "double", load, run, fetch, can, 1};
#else
const bench_contestant bench_eigen = {"Eigen", nullptr, nullptr, nullptr, nullptr, nullptr, 1};
#endif
