/* SPDX-License-Identifier: MIT
 *
 * bench_quat: libquat beside Eigen, GLM and cglm, same inputs, same flags, same run; CSV on stdout.
 *
 *   case,n,library,type,ns,ratio,error_u,checksum,spread
 *
 * ns: median over the rounds, per element. ratio: this row's time over that of the fastest peer in double (memcpy for
 * the rows called rotate_array_to_copy). error_u: largest error of a component over the length of the result, in units
 * of 2^-53, against long double. checksum: the sum of all results. spread: median over least. In every round all
 * contestants run one after the other, so that what disturbs one disturbs all, to and fro: what one leaves in the
 * caches meets both its neighbours. `libquat matrix`: the same rotations held as matrices, made beforehand. One
 * rotation of many vectors has two sizes: within the second cache, and beyond it, where memory is what takes the time.
 */
#include "bench_quat.h"
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <quat/batch.h>
#include <quat/interpolate.h>
#include <quat/rotation.h>
#include "measure.h"

enum { few = 10000, many = 1000000, rounds = 31, most = 9 };

static const char *const names[BENCH_CASES] = {"product",      "compose", "normalize", "rotate",
                                               "rotate_array", "slerp",   "to_matrix", "from_matrix"};

static void *take(size_t n, size_t size)
{
    void *const block = aligned_alloc(64, (n * size + 63) / 64 * 64);
    if (!block) {
        fprintf(stderr, "bench_quat: out of memory\n");
        exit(1);
    }
    memset(block, 0, n * size);
    return block;
}

/* ---- libquat: one at a time, inline; its array calls; and one array for each component ---- */

static const quat *p, *q;
static const qvec3 *v;
static const double *t;
static const qmat3 *m;
static quat *out_q, product;
static qvec3 *out_v;
static qmat3 *out_m;
static double *soa, *out_soa;

static void load(const bench_input *in)
{
    p = (const quat *)in->p, q = (const quat *)in->q, v = (const qvec3 *)in->v, m = (const qmat3 *)in->m, t = in->t;
    free(out_q), free(out_v), free(out_m), free(soa), free(out_soa);
    out_q = take(in->n, sizeof *out_q), out_v = take(in->n, sizeof *out_v), out_m = take(in->n, sizeof *out_m);
    soa = take(3 * in->n, sizeof *soa), out_soa = take(3 * in->n, sizeof *soa);
    for (size_t i = 0; i < in->n; i++)
        for (size_t j = 0; j < 3; j++) soa[j * in->n + i] = in->v[3 * i + j];
}

static void run_one(bench_case which, size_t n)
{
    switch (which) {
    case BENCH_PRODUCT:
        for (size_t i = 0; i < n; i++) out_q[i] = quat_mul(p[i], q[i]);
        break;
    case BENCH_COMPOSE: {
        quat r = quat_identity();
        for (size_t i = 0; i < n; i++) r = quat_mul(r, q[i]);
        product = r;
        break;
    }
    case BENCH_NORMALIZE:
        for (size_t i = 0; i < n; i++) out_q[i] = quat_unit(p[i]);
        break;
    case BENCH_ROTATE:
        for (size_t i = 0; i < n; i++) out_v[i] = quat_rotate(q[i], v[i]);
        break;
    case BENCH_SLERP:
        for (size_t i = 0; i < n; i++) out_q[i] = quat_slerp(p[i], q[i], t[i]);
        break;
    case BENCH_TO_MATRIX:
        for (size_t i = 0; i < n; i++) out_m[i] = quat_to_matrix(q[i]);
        break;
    case BENCH_FROM_MATRIX:
        for (size_t i = 0; i < n; i++) quat_from_matrix(&m[i], &out_q[i]);
        break;
    default: break;
    }
}

static void run_array(bench_case which, size_t n)
{
    switch (which) {
    case BENCH_PRODUCT: quat_mul_array(n, p, q, out_q); break;
    case BENCH_COMPOSE: product = quat_compose_array(n, q); break;
    case BENCH_NORMALIZE: quat_normalize_array(n, p, out_q, NULL); break;
    case BENCH_ROTATE: quat_rotate_each(n, q, v, out_v); break;
    case BENCH_ROTATE_ARRAY: quat_rotate_array(q[0], n, v, out_v); break;
    case BENCH_SLERP: quat_slerp_array(n, p, q, t, out_q); break;
    case BENCH_TO_MATRIX: quat_to_matrix_array(n, q, out_m); break;
    case BENCH_FROM_MATRIX: quat_from_matrix_array(n, m, out_q, NULL); break;
    default: break;
    }
}

static void run_soa(bench_case which, size_t n)
{
    (void)which;
    quat_rotate_soa(q[0], n, soa, soa + n, soa + 2 * n, out_soa, out_soa + n, out_soa + 2 * n);
}

static void run_strided(bench_case which, size_t n)
{
    (void)which;
    const quat_strided in = {soa, 1, (ptrdiff_t)n}, out = {out_soa, 1, (ptrdiff_t)n};
    quat_rotate_strided(q[0], n, in, out);
}

static void run_copy(bench_case which, size_t n)
{
    (void)which;
    memcpy(out_v, v, n * sizeof *v);
}

static void fetch(bench_case which, size_t n, double *out)
{
    const size_t bytes = n * (size_t)bench_width(which) * sizeof(double);
    if (which == BENCH_COMPOSE)
        memcpy(out, &product, sizeof product);
    else
        memcpy(out,
               bench_width(which) == 4   ? (void *)out_q
               : bench_width(which) == 3 ? (void *)out_v
                                         : (void *)out_m,
               bytes);
}

static void fetch_soa(bench_case which, size_t n, double *out)
{
    (void)which;
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < 3; j++) out[3 * i + j] = out_soa[j * n + i];
}

/* ---- the same rotations held as matrices ---- */

static qmat3 *p_matrix, *q_matrix, product_matrix;

static void load_matrices(const bench_input *in)
{
    free(p_matrix), free(q_matrix);
    p_matrix = take(in->n, sizeof *p_matrix), q_matrix = take(in->n, sizeof *q_matrix);
    quat_to_matrix_array(in->n, (const quat *)in->p, p_matrix);
    quat_to_matrix_array(in->n, (const quat *)in->q, q_matrix);
}

static void run_matrix(bench_case which, size_t n)
{
    switch (which) {
    case BENCH_PRODUCT:
        for (size_t i = 0; i < n; i++) out_m[i] = qmat3_mul(&p_matrix[i], &q_matrix[i]);
        break;
    case BENCH_COMPOSE: {
        qmat3 r = qmat3_identity();
        for (size_t i = 0; i < n; i++) r = qmat3_mul(&r, &q_matrix[i]);
        product_matrix = r;
        break;
    }
    case BENCH_ROTATE:
        for (size_t i = 0; i < n; i++) out_v[i] = qmat3_apply(&q_matrix[i], v[i]);
        break;
    case BENCH_ROTATE_ARRAY:
        for (size_t i = 0; i < n; i++) out_v[i] = qmat3_apply(&q_matrix[0], v[i]);
        break;
    default: break;
    }
}

/* Products as the quaternions of their rotations, on the side of the product's own. */
static void fetch_matrix(bench_case which, size_t n, double *out)
{
    if (which == BENCH_COMPOSE) quat_from_matrix(&product_matrix, (quat *)out);
    if (which == BENCH_PRODUCT) {
        quat_from_matrix_array(n, out_m, out_q, NULL);
        for (size_t i = 0; i < n; i++) out_q[i] = quat_nearest(out_q[i], quat_mul(p[i], q[i]));
    }
    if (which != BENCH_COMPOSE) fetch(which, n, out);
}

static int by_matrix(bench_case which)
{
    return which == BENCH_PRODUCT || which == BENCH_COMPOSE || which == BENCH_ROTATE || which == BENCH_ROTATE_ARRAY;
}

static int all_but_array(bench_case which) { return which != BENCH_ROTATE_ARRAY; }
static int only_array(bench_case which) { return which == BENCH_ROTATE_ARRAY; }
static int everything(bench_case which) { return which < BENCH_CASES; }

static const bench_contestant own[] = {
    {"libquat", "double", load, run_one, fetch, all_but_array, 0},
    {"libquat array", "double", NULL, run_array, fetch, everything, 0},
    {"libquat soa", "double", NULL, run_soa, fetch_soa, only_array, 0},
    {"libquat strided", "double", NULL, run_strided, fetch_soa, only_array, 0},
    {"libquat matrix", "double", load_matrices, run_matrix, fetch_matrix, by_matrix, 0},
    {"memcpy", "-", NULL, run_copy, fetch, only_array, 0}};

/* ---- the oracle: textbook formulas in long double ---- */

typedef struct lq {
    long double w, x, y, z;
} lq;

static lq wide(const double *a) { return (lq){a[0], a[1], a[2], a[3]}; }
static lq scaled(lq a, long double s) { return (lq){a.w * s, a.x * s, a.y * s, a.z * s}; }
static long double length(lq a) { return sqrtl(a.w * a.w + a.x * a.x + a.y * a.y + a.z * a.z); }
static lq unit(lq a) { return scaled(a, 1 / length(a)); }
static lq plus(lq a, lq b) { return (lq){a.w + b.w, a.x + b.x, a.y + b.y, a.z + b.z}; }
static lq times(lq a, lq b)
{
    return (lq){a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
static lq turned(lq a, lq b) { return times(times(a, b), (lq){a.w, -a.x, -a.y, -a.z}); }

static lq slerp(lq a, lq b, long double s)
{
    if (a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z < 0) b = scaled(b, -1);
    const long double angle = 2 * atan2l(length(plus(a, scaled(b, -1))), length(plus(a, b)));
    return plus(scaled(a, sinl((1 - s) * angle) / sinl(angle)), scaled(b, sinl(s * angle) / sinl(angle)));
}

/* The right result of element i of a case. */
static void expected(const bench_input *in, bench_case which, size_t i, long double *r)
{
    const lq a = wide(in->p + 4 * i), b = wide(in->q + 4 * i);
    lq c = {0, 0, 0, 0};
    switch (which) {
    case BENCH_PRODUCT: c = times(a, b); break;
    case BENCH_NORMALIZE: c = unit(a); break;
    case BENCH_SLERP: c = slerp(unit(a), unit(b), in->t[i]); break;
    case BENCH_FROM_MATRIX: c = unit(a); break;
    case BENCH_ROTATE:
    case BENCH_ROTATE_ARRAY: {
        const double *w = in->v + 3 * i;
        const lq d = turned(unit(which == BENCH_ROTATE ? b : wide(in->q)), (lq){0, w[0], w[1], w[2]});
        r[0] = d.x, r[1] = d.y, r[2] = d.z;
        return;
    }
    case BENCH_TO_MATRIX:
        for (int j = 0; j < 3; j++) {
            const lq d = turned(unit(b), (lq){0, j == 0, j == 1, j == 2});
            r[j] = d.x, r[3 + j] = d.y, r[6 + j] = d.z;
        }
        return;
    case BENCH_COMPOSE:
        c = (lq){1, 0, 0, 0};
        for (size_t k = 0; k < in->n; k++) c = times(c, wide(in->q + 4 * k));
        break;
    default: break;
    }
    r[0] = c.w, r[1] = c.x, r[2] = c.y, r[3] = c.z;
}

static double worst_error(const bench_input *in, bench_case which, const double *got)
{
    const int width = bench_width(which);
    const size_t count = which == BENCH_COMPOSE ? 1 : few;
    long double worst = 0;
    for (size_t i = 0; i < count; i++) {
        long double want[9], size = 0, same = 0, opposite = 0;
        expected(in, which, i, want);
        for (int j = 0; j < width; j++) {
            const long double g = got[(size_t)width * i + (size_t)j];
            size = fmaxl(size, 0) + want[j] * want[j];
            same = fmaxl(same, fabsl(g - want[j]));
            opposite = fmaxl(opposite, fabsl(g + want[j]));
        }
        /* as rotations q and -q are one; a matrix has three columns of length 1 */
        const long double off =
            width == 4 && which != BENCH_PRODUCT && which != BENCH_NORMALIZE ? fminl(same, opposite) : same;
        worst = fmaxl(worst, off / sqrtl(width == 9 ? 1 : size));
    }
    return (double)(worst * 0x1p53L);
}

/* ---- input ---- */

static uint64_t seed = 2026;
static double uniform(void *unused)
{
    (void)unused;
    uint64_t z = seed += 0x9e3779b97f4a7c15u; /* splitmix64 */
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static bench_input make_input(size_t n)
{
    quat *const a = take(n, sizeof *a), *const b = take(n, sizeof *b);
    double *const w = take(3 * n, sizeof *w), *const s = take(n, sizeof *s);
    qmat3 *const r = take(n, sizeof *r);
    for (size_t i = 0; i < n; i++) {
        a[i] = quat_random(uniform, NULL);
        b[i] = quat_random(uniform, NULL);
        s[i] = uniform(NULL);
        for (size_t j = 0; j < 3; j++) w[3 * i + j] = 2 * uniform(NULL) - 1;
        r[i] = quat_to_matrix(a[i]);
    }
    return (bench_input){n, &a[0].w, &b[0].w, w, s, &r[0].m[0][0]};
}

static void compete(bench_case which, const bench_input *in, const bench_contestant *const *all, int count)
{
    static double times_of[most][rounds];
    double median[most], spread[most], fastest = DBL_MAX, copy = DBL_MAX;
    const size_t n = in->n, repeat = n < many ? 20 : 1;
    for (int k = 0; k < measure_count(rounds); k++)
        for (int turn = 0; turn < count; turn++) {
            const int c = k % 2 == 0 ? turn : count - 1 - turn;
            if (!all[c]->can(which)) continue;
            const double start = measure_clock();
            for (size_t j = 0; j < repeat; j++) all[c]->run(which, n);
            times_of[c][k] = 1e9 * measure_since(start) / (double)(n * repeat);
        }
    for (int c = 0; c < count; c++) {
        if (!all[c]->can(which)) continue;
        const measure_time time = measure_of_rounds(times_of[c], measure_count(rounds));
        median[c] = time.median, spread[c] = time.spread;
        if (all[c]->peer && median[c] < fastest) fastest = median[c];
        if (strcmp(all[c]->name, "memcpy") == 0) copy = median[c];
    }
    double *const out = take(9 * n, sizeof *out);
    for (int c = 0; c < count; c++) {
        if (!all[c]->can(which)) continue;
        all[c]->run(which, n);
        all[c]->fetch(which, n, out);
        double sum = 0;
        const size_t results = which == BENCH_COMPOSE ? 4 : n * (size_t)bench_width(which);
        for (size_t i = 0; i < results; i++) sum += out[i];
        const int moves_only = strcmp(all[c]->name, "memcpy") == 0;
        const double error = moves_only ? 0 : worst_error(in, which, out);
        printf("%s,%zu,%s,%s,%.3f,", names[which], n, all[c]->name, all[c]->type, median[c]);
        if (fastest < DBL_MAX) printf("%.3f", median[c] / fastest);
        printf(",%.3g,%.12g,%.2f\n", error, sum, spread[c]);
        if (copy < DBL_MAX && !moves_only)
            printf("%s_to_copy,%zu,%s,%s,%.3f,%.3f,%.3g,%.12g,%.2f\n", names[which], n, all[c]->name, all[c]->type,
                   median[c], median[c] / copy, error, sum, spread[c]);
    }
    free(out);
    fflush(stdout);
}

int main(void)
{
    const bench_contestant *all[most];
    int count = 0;
    for (size_t i = 0; i < sizeof own / sizeof *own; i++) all[count++] = &own[i];
    const bench_contestant *const peers[] = {&bench_eigen, &bench_glm, &bench_cglm};
    for (size_t i = 0; i < sizeof peers / sizeof *peers; i++) {
        if (peers[i]->type)
            all[count++] = peers[i];
        else
            fprintf(stderr, "bench_quat: %s is not installed and is skipped\n", peers[i]->name);
    }
    printf("case,n,library,type,ns,ratio,error_u,checksum,spread\n");
    const size_t sizes[] = {few, many};
    for (size_t s = 0; s < 2; s++) {
        const bench_input in = make_input(sizes[s]);
        for (int c = 0; c < count; c++)
            if (all[c]->load) all[c]->load(&in);
        for (int which = 0; which < BENCH_CASES; which++) {
            const int large = which == BENCH_COMPOSE || which == BENCH_ROTATE_ARRAY;
            if (which == BENCH_ROTATE_ARRAY || large == (sizes[s] == many)) compete((bench_case)which, &in, all, count);
        }
        free((void *)in.p), free((void *)in.q), free((void *)in.v), free((void *)in.t), free((void *)in.m);
    }
    return 0;
}
