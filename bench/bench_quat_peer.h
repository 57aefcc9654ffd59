/* SPDX-License-Identifier: MIT
 *
 * What the peers of bench_quat in C++ have in common: their arrays and the loops over them. `Ops` gives a peer's types
 * Quat, Vec and Mat, how to make them and take them apart, and its operations, by the peer's own calls.
 */
#ifndef BENCH_QUAT_PEER_H
#define BENCH_QUAT_PEER_H

#include <vector>
#include "bench_quat.h"

template <class Ops> struct Peer {
    using Quat = typename Ops::Quat;

    static inline std::vector<Quat> p, q, out_q;
    static inline std::vector<typename Ops::Vec> v, out_v;
    static inline std::vector<typename Ops::Mat> m, out_m;
    static inline std::vector<double> t;
    static inline Quat product;

    static void load(const bench_input *in)
    {
        p.clear(), q.clear(), v.clear(), m.clear(), t.clear();
        for (std::size_t i = 0; i < in->n; i++) {
            p.push_back(Ops::quat(in->p + 4 * i));
            q.push_back(Ops::quat(in->q + 4 * i));
            v.emplace_back(in->v[3 * i], in->v[3 * i + 1], in->v[3 * i + 2]);
            m.push_back(Ops::mat(in->m + 9 * i));
            t.push_back(in->t[i]);
        }
        out_q.resize(in->n), out_v.resize(in->n), out_m.resize(in->n);
    }

    static void run(bench_case which, std::size_t n)
    {
        switch (which) {
        case BENCH_PRODUCT:
            for (std::size_t i = 0; i < n; i++) out_q[i] = p[i] * q[i];
            break;
        case BENCH_COMPOSE: {
            Quat r = Ops::identity();
            for (std::size_t i = 0; i < n; i++) r = r * q[i];
            product = r;
            break;
        }
        case BENCH_NORMALIZE:
            for (std::size_t i = 0; i < n; i++) out_q[i] = Ops::normalized(p[i]);
            break;
        case BENCH_ROTATE:
            for (std::size_t i = 0; i < n; i++) out_v[i] = q[i] * v[i];
            break;
        case BENCH_ROTATE_ARRAY: {
            const typename Ops::Mat r = Ops::to_matrix(q[0]);
            for (std::size_t i = 0; i < n; i++) Ops::apply(r, v[i], out_v[i]);
            break;
        }
        case BENCH_SLERP:
            for (std::size_t i = 0; i < n; i++) out_q[i] = Ops::slerp(p[i], q[i], t[i]);
            break;
        case BENCH_TO_MATRIX:
            for (std::size_t i = 0; i < n; i++) out_m[i] = Ops::to_matrix(q[i]);
            break;
        case BENCH_FROM_MATRIX:
            for (std::size_t i = 0; i < n; i++) out_q[i] = Ops::from_matrix(m[i]);
            break;
        default: break;
        }
    }

    static void fetch(bench_case which, std::size_t n, double *out)
    {
        if (which == BENCH_COMPOSE) {
            Ops::put(product, out);
            return;
        }
        const int width = bench_width(which);
        for (std::size_t i = 0; i < n; i++, out += width) {
            if (width == 4) Ops::put(out_q[i], out);
            for (int j = 0; width == 3 && j < 3; j++) out[j] = out_v[i][j];
            for (int j = 0; width == 9 && j < 9; j++) out[j] = Ops::at(out_m[i], j / 3, j % 3);
        }
    }

    static int can(bench_case) { return 1; }
};

#endif
