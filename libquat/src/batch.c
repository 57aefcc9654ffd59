/* SPDX-License-Identifier: MIT */
#include <quat/batch.h>
#include <quat/rotation.h>
#include <string.h>
#include "dd.h"
#include "slerp_kernel.h"
#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#endif

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

/* Six streams are more than a machine foresees by itself: a cache line of each is asked for long before its turn. */
enum { line = 8, ahead = 256 };

#ifdef __GNUC__
static inline void fetch(const double *in, const double *out)
{
    __builtin_prefetch(in, 0);
    __builtin_prefetch(out, 1);
}
#else
static inline void fetch(const double *in, const double *out) { (void)in, (void)out; }
#endif

QUAT_AVX2_CLONES
void quat_rotate_soa(quat q, size_t n, const double *x, const double *y, const double *z, double *out_x, double *out_y,
                     double *out_z)
{
    const qmat3 r = quat_to_matrix(q);
    size_t i = 0;
    for (; i + line <= n; i += line) {
        const size_t next = n - i > ahead ? i + ahead : i;
        fetch(x + next, out_x + next), fetch(y + next, out_y + next), fetch(z + next, out_z + next);
        double a[line], b[line], c[line]; /* apart from in and out, which may be the same */
        for (int k = 0; k < line; k++) {
            const qvec3 v = qmat3_apply(&r, qvec3_make(x[i + (size_t)k], y[i + (size_t)k], z[i + (size_t)k]));
            a[k] = v.x, b[k] = v.y, c[k] = v.z;
        }
        memcpy(out_x + i, a, sizeof a), memcpy(out_y + i, b, sizeof b), memcpy(out_z + i, c, sizeof c);
    }
    for (; i < n; i++) {
        const qvec3 v = qmat3_apply(&r, qvec3_make(x[i], y[i], z[i]));
        out_x[i] = v.x, out_y[i] = v.y, out_z[i] = v.z;
    }
}

void quat_rotate_strided(quat q, size_t n, quat_strided in, quat_strided out)
{
    if (n > 0 && in.point == 1 && out.point == 1) {
        quat_rotate_soa(q, n, in.data, in.data + in.component, in.data + 2 * in.component, out.data,
                        out.data + out.component, out.data + 2 * out.component);
        return;
    }
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
/* Registers of four, where the loader may find them. */
typedef double four __attribute__((vector_size(32)));
typedef long long four_bits __attribute__((vector_size(32)));

/* One quaternion in a register: the same products and sums as quat_mul's. */
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

/* q/|q| for |q|^2 in the range of doubles, with less to do than quat_normalize has and as right. The quotient u = q r
 * keeps what its rounding lost, and its length is put right by c = (1 - |u|^2)/2, summed in halves so small that each
 * rounding on the way is a quarter of a unit. Half a unit in all, and half for the result. */
QUAT_FMA_CLONES
static quat divide_by_length(quat q)
{
    const double r = 1 / sqrt(quat_norm2(q));
    const quat u = quat_scale(q, r);
    const quat lost = quat_make(fma(q.w, r, -u.w), fma(q.x, r, -u.x), fma(q.y, r, -u.y), fma(q.z, r, -u.z));
    const double excess = fma(u.w, u.w, fma(u.x, u.x, -0.5)) + fma(u.y, u.y, fma(u.z, u.z, -0.5));
    const double c = -0.5 * excess - (fma(u.w, lost.w, u.x * lost.x) + fma(u.y, lost.y, u.z * lost.z));
    return quat_make(u.w + fma(c, u.w, lost.w), u.x + fma(c, u.x, lost.x), u.y + fma(c, u.y, lost.y),
                     u.z + fma(c, u.z, lost.z));
}

#if defined(__x86_64__) && defined(__GNUC__)
/* The same, step by step, of four neighbours in registers w, x, y and z. Stops at the first four of which
 * one is outside its range, and says how many were done. */
__attribute__((target("avx,fma"))) static size_t divide_fours(size_t n, const quat q[], quat out[])
{
    const __m256d half = _mm256_set1_pd(-0.5);
    size_t i = 0;
    for (; i + 4 <= n; i += 4) {
        const __m256d wx02 = _mm256_loadu2_m128d(&q[i + 2].w, &q[i].w);
        const __m256d wx13 = _mm256_loadu2_m128d(&q[i + 3].w, &q[i + 1].w);
        const __m256d yz02 = _mm256_loadu2_m128d(&q[i + 2].y, &q[i].y);
        const __m256d yz13 = _mm256_loadu2_m128d(&q[i + 3].y, &q[i + 1].y);
        __m256d w = _mm256_unpacklo_pd(wx02, wx13), x = _mm256_unpackhi_pd(wx02, wx13);
        __m256d y = _mm256_unpacklo_pd(yz02, yz13), z = _mm256_unpackhi_pd(yz02, yz13);

        const __m256d n2 = (w * w + x * x) + (y * y + z * z), r = 1 / _mm256_sqrt_pd(n2);
        if (_mm256_movemask_pd((__m256d)((n2 >= 1e-280) & (n2 <= 1e280))) != 15) break;
        const __m256d uw = w * r, ux = x * r, uy = y * r, uz = z * r;
        const __m256d lw = _mm256_fmsub_pd(w, r, uw), lx = _mm256_fmsub_pd(x, r, ux);
        const __m256d ly = _mm256_fmsub_pd(y, r, uy), lz = _mm256_fmsub_pd(z, r, uz);
        const __m256d excess = _mm256_fmadd_pd(uw, uw, _mm256_fmadd_pd(ux, ux, half)) +
                               _mm256_fmadd_pd(uy, uy, _mm256_fmadd_pd(uz, uz, half));
        const __m256d c = half * excess - (_mm256_fmadd_pd(uw, lw, ux * lx) + _mm256_fmadd_pd(uy, ly, uz * lz));
        w = uw + _mm256_fmadd_pd(c, uw, lw), x = ux + _mm256_fmadd_pd(c, ux, lx);
        y = uy + _mm256_fmadd_pd(c, uy, ly), z = uz + _mm256_fmadd_pd(c, uz, lz);

        _mm256_storeu2_m128d(&out[i + 2].w, &out[i].w, _mm256_unpacklo_pd(w, x));
        _mm256_storeu2_m128d(&out[i + 3].w, &out[i + 1].w, _mm256_unpackhi_pd(w, x));
        _mm256_storeu2_m128d(&out[i + 2].y, &out[i].y, _mm256_unpacklo_pd(y, z));
        _mm256_storeu2_m128d(&out[i + 3].y, &out[i + 1].y, _mm256_unpackhi_pd(y, z));
    }
    return i;
}

static size_t divide_quickly(size_t n, const quat q[], quat out[])
{
    return __builtin_cpu_supports("avx") && __builtin_cpu_supports("fma") ? divide_fours(n, q, out) : 0;
}
#else
static size_t divide_quickly(size_t n, const quat q[], quat out[])
{
    (void)n, (void)q, (void)out;
    return 0;
}
#endif

static quat_status normalize_one(quat q, quat *unit)
{
    const double n2 = quat_norm2(q);
    if (!(n2 >= 1e-280 && n2 <= 1e280)) return quat_normalize(q, unit);
    *unit = divide_by_length(q);
    return QUAT_OK;
}

quat_status quat_normalize_array(size_t n, const quat q[], quat out[], size_t *first_bad)
{
    size_t bad = n;
    for (size_t i = 0; i < n;) {
        const size_t done = divide_quickly(n - i, q + i, out + i), end = n - i - done < 4 ? n : i + done + 4;
        for (i += done; i < end; i++)
            if (normalize_one(q[i], &out[i]) != QUAT_OK && bad == n) bad = i;
    }
    if (first_bad) *first_bad = bad;
    return bad == n ? QUAT_OK : QUAT_EDOMAIN;
}

void quat_to_matrix_array(size_t n, const quat q[], qmat3 out[])
{
    for (size_t i = 0; i < n; i++) out[i] = quat_to_matrix(q[i]);
}

#ifdef QUAT_HAS_CLONES
/* Where the mask is set a, else b. No function: without AVX a call passes no such register. */
#define CHOOSE(mask, a, b) ((four)(((mask) & (four_bits)(a)) | (~(mask) & (four_bits)(b))))

/* Rows of four doubles, so far apart, into registers of one column each; and registers into neighbouring rows. Each
 * register is copied by itself: together they would go by way of the stack. */
static inline void load_columns(const double *rows, size_t apart, four column[4])
{
    four r0, r1, r2, r3;
    memcpy(&r0, rows, sizeof r0), memcpy(&r1, rows + apart, sizeof r1);
    memcpy(&r2, rows + 2 * apart, sizeof r2), memcpy(&r3, rows + 3 * apart, sizeof r3);
    const four a = __builtin_shufflevector(r0, r1, 0, 4, 2, 6), b = __builtin_shufflevector(r0, r1, 1, 5, 3, 7);
    const four c = __builtin_shufflevector(r2, r3, 0, 4, 2, 6), d = __builtin_shufflevector(r2, r3, 1, 5, 3, 7);
    column[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5), column[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
    column[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7), column[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}

static inline void store_columns(const four column[4], double *rows)
{
    const four a = __builtin_shufflevector(column[0], column[1], 0, 4, 2, 6),
               b = __builtin_shufflevector(column[0], column[1], 1, 5, 3, 7);
    const four c = __builtin_shufflevector(column[2], column[3], 0, 4, 2, 6),
               d = __builtin_shufflevector(column[2], column[3], 1, 5, 3, 7);
    const four r0 = __builtin_shufflevector(a, c, 0, 1, 4, 5), r1 = __builtin_shufflevector(b, d, 0, 1, 4, 5);
    const four r2 = __builtin_shufflevector(a, c, 2, 3, 6, 7), r3 = __builtin_shufflevector(b, d, 2, 3, 6, 7);
    memcpy(rows, &r0, sizeof r0), memcpy(rows + 4, &r1, sizeof r1);
    memcpy(rows + 8, &r2, sizeof r2), memcpy(rows + 12, &r3, sizeof r3);
}

/* quat_from_matrix of four neighbours, the same sums and products, element k of each in a register. Stops at the first
 * four of which one has no quaternion, and says how many were done. */
QUAT_AVX2_CLONES
static size_t from_fours(size_t n, const qmat3 m[], quat out[])
{
    const long long minus = (long long)(1ull << 63);
    const four_bits sign = {minus, minus, minus, minus};
    size_t i = 0;
    for (; i + 4 <= n; i += 4) {
        four u[4], v[4]; /* 00 01 02 10; 11 12 20 21 */
        load_columns(&m[i].m[0][0], 9, u), load_columns(&m[i].m[1][1], 9, v);
        const four a = u[0], b = v[0], c = {m[i].m[2][2], m[i + 1].m[2][2], m[i + 2].m[2][2], m[i + 3].m[2][2]};
        const four wx = v[3] - v[1], wy = u[2] - v[2], wz = u[3] - u[1];
        const four xy = u[3] + u[1], xz = u[2] + v[2], yz = v[3] + v[1];
        const four ww = 1 + ((a + b) + c), xx = 1 + ((a - b) - c), yy = 1 + ((b - a) - c), zz = 1 + ((c - a) - b);

        const four_bits x = xx > ww, z = zz > yy, second = CHOOSE(z, zz, yy) > CHOOSE(x, xx, ww);
        four q[4] = {
            CHOOSE(second, CHOOSE(z, wz, wy), CHOOSE(x, wx, ww)), CHOOSE(second, CHOOSE(z, xz, xy), CHOOSE(x, xx, wx)),
            CHOOSE(second, CHOOSE(z, yz, yy), CHOOSE(x, xy, wy)), CHOOSE(second, CHOOSE(z, zz, yz), CHOOSE(x, xz, wz))};
        const four n2 = (q[0] * q[0] + q[1] * q[1]) + (q[2] * q[2] + q[3] * q[3]);
        const four_bits good = (n2 > 1) & (n2 <= 1e280);
        if (!(good[0] & good[1] & good[2] & good[3])) break;

        four s;
        for (int k = 0; k < 4; k++) s[k] = sqrt(n2[k]);
        s = (four)((four_bits)(1 / s) | ((four_bits)q[0] & sign));
        for (int k = 0; k < 4; k++) q[k] *= s;
        store_columns(q, &out[i].w);
    }
    return i;
}
#else
static size_t from_fours(size_t n, const qmat3 m[], quat out[])
{
    (void)n, (void)m, (void)out;
    return 0;
}
#endif

quat_status quat_from_matrix_array(size_t n, const qmat3 m[], quat out[], size_t *first_bad)
{
    size_t bad = n;
    for (size_t i = 0; i < n;) {
        const size_t done = from_fours(n - i, m + i, out + i), end = n - i - done < 4 ? n : i + done + 4;
        for (i += done; i < end; i++)
            if (quat_from_matrix(&m[i], &out[i]) != QUAT_OK && bad == n) bad = i;
    }
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
