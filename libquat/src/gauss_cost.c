/* SPDX-License-Identifier: MIT */
#include "gauss.h"

/* With s = q_a* q_b and the angle D = phi_b - phi_a, |q_a - q_b|^2 = 2 - 2 (s.w cos D/2 - s.z sin D/2): slope s.z,
 * second derivative s.w/2. */
quat_triangle_cost quat_gauge_length(const quat_mesh *mesh, size_t i, const quat q[], double soft)
{
    quat_triangle_cost cost = {0};
    (void)soft;
    for (int c = 0; c < 3; c++) {
        size_t a, b;
        quat_mesh_edge(mesh, i, c, &a, &b);
        const double weight = mesh->weight[i][c];
        const quat near = quat_nearest(q[b], q[a]), s = quat_mul(quat_conj(q[a]), near);
        cost.value += weight * quat_norm2(quat_sub(near, q[a]));
        cost.slope[(c + 1) % 3] -= weight * s.z;
        cost.slope[(c + 2) % 3] += weight * s.z;
        cost.stiffness[c] = weight * s.w / 2;
    }
    return cost;
}

/* With a = q1 - q0, b = q2 - q0 and G = |a|^2 |b|^2 - (a.b)^2 = 4 A^2. */
quat_triangle_cost quat_gauge_area(const quat_mesh *mesh, size_t i, const quat q[], double soft)
{
    quat_triangle_cost cost = {0};
    const size_t *const t = mesh->triangle[i];
    const quat k = {0, 0, 0, 0.5}, none = {0, 0, 0, 0}, q0 = q[t[0]], q1 = quat_nearest(q[t[1]], q0),
               q2 = quat_nearest(q[t[2]], q0), a = quat_sub(q1, q0), b = quat_sub(q2, q0);
    const double aa = quat_norm2(a), bb = quat_norm2(b), ab = quat_dot(a, b);
    /* as the length of the part of b perpendicular to a, which does not cancel */
    const quat across = aa > 0 ? quat_axpy(-ab / aa, a, b) : none;
    const double square = aa * quat_norm2(across) / 4, size = sqrt(square + soft * soft);
    if (size <= 1e-150) return cost;
    cost.value = square / (size + soft);
    /* a and b by the three angles */
    const quat d0 = quat_neg(quat_mul(q0, k)), by_a[3] = {d0, quat_mul(q1, k), none},
               by_b[3] = {d0, none, quat_mul(q2, k)};
    double aa_[3], bb_[3], ab_[3], g_[3];
    for (int c = 0; c < 3; c++) {
        aa_[c] = 2 * quat_dot(a, by_a[c]);
        bb_[c] = 2 * quat_dot(b, by_b[c]);
        ab_[c] = quat_dot(a, by_b[c]) + quat_dot(b, by_a[c]);
        g_[c] = aa_[c] * bb + aa * bb_[c] - 2 * ab * ab_[c];
        cost.slope[c] = g_[c] / (8 * size);
    }
    for (int c = 0; c < 3; c++) {
        const int m = (c + 1) % 3, n = (c + 2) % 3;
        const double mixed = aa_[m] * bb_[n] + aa_[n] * bb_[m] + 2 * bb * quat_dot(by_a[m], by_a[n]) +
                             2 * aa * quat_dot(by_b[m], by_b[n]) - 2 * ab_[m] * ab_[n] -
                             2 * ab * (quat_dot(by_a[m], by_b[n]) + quat_dot(by_a[n], by_b[m]));
        cost.stiffness[c] = cost.slope[m] * cost.slope[n] / size - mixed / (8 * size);
    }
    return cost;
}

double quat_gauge_sum(const quat_mesh *mesh, quat_gauge_cost cost, const quat q[], double soft)
{
    double sum = 0;
    for (size_t i = 0; i < mesh->m; i++) sum += cost(mesh, i, q, soft).value;
    return sum;
}
