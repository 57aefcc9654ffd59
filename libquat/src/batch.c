/* SPDX-License-Identifier: MIT */
#include <quat/batch.h>
#include <quat/rotation.h>
#include <string.h>
#include "dd.h"
#include "length_kernel.h"
#include "slerp_kernel.h"

/* Vectors of four on machines with AVX2, of two elsewhere: without FMA the bits are the same. */

/* Blocks small enough for the first cache: what is kept of each element are plain arrays and plain loops. */
enum { block = 128 };

/* ---- many vectors by one rotation ---- */

QUAT_AVX2_CLONES
void quat_rotate_array(quat q, size_t n, const qvec3 in[], qvec3 out[])
{
    const qmat3 r = quat_to_matrix(q);
    for (size_t i = 0; i < n; i++) out[i] = qmat3_apply(&r, in[i]);
}

QUAT_AVX2_CLONES
void quat_rotate_soa(quat q, size_t n, const double *x, const double *y, const double *z, double *out_x, double *out_y,
                     double *out_z)
{
    const qmat3 r = quat_to_matrix(q);
    for (size_t i = 0; i < n; i++) {
        const qvec3 v = qmat3_apply(&r, qvec3_make(x[i], y[i], z[i]));
        out_x[i] = v.x;
        out_y[i] = v.y;
        out_z[i] = v.z;
    }
}

void quat_rotate_strided(quat q, size_t n, quat_strided in, quat_strided out)
{
    const qmat3 r = quat_to_matrix(q);
    for (size_t i = 0; i < n; i++) {
        const double *const a = in.data + (ptrdiff_t)i * in.point;
        double *const b = out.data + (ptrdiff_t)i * out.point;
        const qvec3 v = qmat3_apply(&r, qvec3_make(a[0], a[in.component], a[2 * in.component]));
        b[0] = v.x;
        b[out.component] = v.y;
        b[2 * out.component] = v.z;
    }
}

/* ---- element by element ---- */

QUAT_AVX2_CLONES
void quat_rotate_each(size_t n, const quat q[], const qvec3 v[], qvec3 out[])
{
    for (size_t i = 0; i < n; i++) out[i] = quat_rotate(q[i], v[i]);
}

#ifdef QUAT_HAS_CLONES
/* One quaternion in a register of four, where the loader may find one: the same products and sums as quat_mul's. */
typedef double four __attribute__((vector_size(32)));
typedef long long four_bits __attribute__((vector_size(32)));

QUAT_AVX2_CLONES
void quat_mul_array(size_t n, const quat p[], const quat q[], quat out[])
{
    const long long minus = (long long)(1ull << 63);
    const four_bits sign_x = {minus, 0, minus, 0}, sign_y = {minus, 0, 0, minus}, sign_z = {minus, minus, 0, 0};
    for (size_t i = 0; i < n; i++) {
        four wxyz, r;
        memcpy(&wxyz, &q[i], sizeof wxyz);
        const four xwzy = __builtin_shufflevector(wxyz, wxyz, 1, 0, 3, 2),
                   yzwx = __builtin_shufflevector(wxyz, wxyz, 2, 3, 0, 1);
        const four zyxw = __builtin_shufflevector(wxyz, wxyz, 3, 2, 1, 0);
        const four x = (four)((four_bits)(p[i].x * xwzy) ^ sign_x), y = (four)((four_bits)(p[i].y * yzwx) ^ sign_y);
        const four z = (four)((four_bits)(p[i].z * zyxw) ^ sign_z);
        r = (p[i].w * wxyz + x) + (y + z);
        memcpy(&out[i], &r, sizeof r);
    }
}
#else
void quat_mul_array(size_t n, const quat p[], const quat q[], quat out[])
{
    for (size_t i = 0; i < n; i++) out[i] = quat_mul(p[i], q[i]);
}
#endif

/* All of a block at once; those outside the range of the kernel again, one by one. */
QUAT_FMA_CLONES
static size_t normalize_block(size_t n, const quat *q, quat *out, double *n2)
{
    size_t outside = 0;
    for (size_t i = 0; i < n; i++) {
        n2[i] = quat_norm2(q[i]);
        outside += !(n2[i] >= 1e-280 && n2[i] <= 1e280);
    }
    if (outside) return outside;
    for (size_t i = 0; i < n; i++) out[i] = quat_divide_by_length(q[i]);
    return 0;
}

quat_status quat_normalize_array(size_t n, const quat q[], quat out[], size_t *first_bad)
{
    size_t bad = n;
    for (size_t start = 0; start < n; start += block) {
        double n2[block];
        const size_t end = n - start < block ? n : start + block;
        if (normalize_block(end - start, q + start, out + start, n2) == 0) continue;
        for (size_t i = start; i < end; i++)
            if (quat_normalize(q[i], &out[i]) != QUAT_OK && bad == n) bad = i;
    }
    if (first_bad) *first_bad = bad;
    return bad == n ? QUAT_OK : QUAT_EDOMAIN;
}

void quat_to_matrix_array(size_t n, const quat q[], qmat3 out[])
{
    for (size_t i = 0; i < n; i++) out[i] = quat_to_matrix(q[i]);
}

quat_status quat_from_matrix_array(size_t n, const qmat3 m[], quat out[], size_t *first_bad)
{
    size_t bad = n;
    for (size_t i = 0; i < n; i++)
        if (quat_from_matrix(&m[i], &out[i]) != QUAT_OK && bad == n) bad = i;
    if (first_bad) *first_bad = bad;
    return bad == n ? QUAT_OK : QUAT_EDOMAIN;
}

QUAT_AVX2_CLONES
static void slerp_block(size_t n, const quat *p, const quat *q, const double *t, quat *out)
{
    double s2[block], side[block], a[block], b[block], inner[block];
    for (size_t i = 0; i < n; i++) {
        side[i] = copysign(1, quat_dot(p[i], q[i]));
        s2[i] = 0.25 * quat_norm2(quat_axpy(-side[i], p[i], q[i]));
    }
    for (size_t i = 0; i < n; i++) {
        double x, y;
        quat_slerp_weights(s2[i], 2 * t[i] - 1, &x, &y);
        a[i] = x;
        b[i] = side[i] * y;
        inner[i] = 0.5;
    }
    for (size_t i = 0; i < n; i++) {
        if (t[i] > 0 && t[i] < 1) continue;
        /* the ends are exact: weights 1 and 0, and no correction of the length */
        a[i] = t[i] == 0;
        b[i] = side[i] * (t[i] == 1);
        inner[i] = t[i] == 0 || t[i] == 1 ? 0 : NAN;
    }
    for (size_t i = 0; i < n; i++) {
        const quat r = quat_axpy(b[i], q[i], quat_scale(p[i], a[i]));
        out[i] = quat_axpy(inner[i] - inner[i] * quat_norm2(r), r, r);
    }
}

void quat_slerp_array(size_t n, const quat p[], const quat q[], const double t[], quat out[])
{
    for (size_t i = 0; i < n; i += block) slerp_block(n - i < block ? n - i : block, p + i, q + i, t + i, out + i);
}

/* ---- all into one ---- */

quat quat_compose_array(size_t n, const quat q[])
{
    enum { runs = 8 };
    const size_t length = n / runs;
    quat r[runs];
    for (int k = 0; k < runs; k++) r[k] = quat_identity();
    for (size_t i = 0; i < length; i++)
        for (size_t k = 0; k < runs; k++) r[k] = quat_mul(r[k], q[k * length + i]);
    for (size_t i = runs * length; i < n; i++) r[runs - 1] = quat_mul(r[runs - 1], q[i]);
    quat product = r[0];
    for (int k = 1; k < runs; k++) product = quat_mul(product, r[k]);
    return product;
}
