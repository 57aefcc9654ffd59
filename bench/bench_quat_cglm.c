/* SPDX-License-Identifier: MIT
 *
 * cglm has floats only: shown beside the others, but no part of any ratio.
 */
#include "bench_quat.h"

#ifdef HAVE_CGLM
#include <cglm/cglm.h>
#include <stdlib.h>

static versor *p, *q, *out_q, product;
static vec3 *v, *out_v;
static mat3 *m, *out_m;
static float *t;

/* cglm wants 16- and 32-byte alignment. */
static void *renew(void *old, size_t n, size_t size)
{
    free(old);
    return aligned_alloc(64, (n * size + 63) / 64 * 64);
}

static void set(versor to, const double *from)
{
    to[3] = (float)from[0];
    for (int j = 0; j < 3; j++) to[j] = (float)from[j + 1];
}

static void load(const bench_input *in)
{
    const size_t n = in->n;
    p = renew(p, n, sizeof *p), q = renew(q, n, sizeof *q), out_q = renew(out_q, n, sizeof *out_q);
    v = renew(v, n, sizeof *v), out_v = renew(out_v, n, sizeof *out_v);
    m = renew(m, n, sizeof *m), out_m = renew(out_m, n, sizeof *out_m), t = renew(t, n, sizeof *t);
    for (size_t i = 0; i < n; i++) {
        set(p[i], in->p + 4 * i);
        set(q[i], in->q + 4 * i);
        for (int j = 0; j < 3; j++) v[i][j] = (float)in->v[3 * i + (size_t)j];
        for (int j = 0; j < 9; j++) m[i][j % 3][j / 3] = (float)in->m[9 * i + (size_t)j];
        t[i] = (float)in->t[i];
    }
}

static void run(bench_case which, size_t n)
{
    switch (which) {
    case BENCH_PRODUCT:
        for (size_t i = 0; i < n; i++) glm_quat_mul(p[i], q[i], out_q[i]);
        break;
    case BENCH_COMPOSE: {
        versor r = {0, 0, 0, 1}, next;
        for (size_t i = 0; i < n; i++) {
            glm_quat_mul(r, q[i], next);
            glm_quat_copy(next, r);
        }
        glm_quat_copy(r, product);
        break;
    }
    case BENCH_NORMALIZE:
        for (size_t i = 0; i < n; i++) glm_quat_normalize_to(p[i], out_q[i]);
        break;
    case BENCH_ROTATE:
        for (size_t i = 0; i < n; i++) glm_quat_rotatev(q[i], v[i], out_v[i]);
        break;
    case BENCH_ROTATE_ARRAY: {
        mat3 r;
        glm_quat_mat3(q[0], r);
        for (size_t i = 0; i < n; i++) glm_mat3_mulv(r, v[i], out_v[i]);
        break;
    }
    case BENCH_SLERP:
        for (size_t i = 0; i < n; i++) glm_quat_slerp(p[i], q[i], t[i], out_q[i]);
        break;
    case BENCH_TO_MATRIX:
        for (size_t i = 0; i < n; i++) glm_quat_mat3(q[i], out_m[i]);
        break;
    case BENCH_FROM_MATRIX:
        for (size_t i = 0; i < n; i++) glm_mat3_quat(m[i], out_q[i]);
        break;
    default: break;
    }
}

static void put(double *out, const versor r)
{
    out[0] = r[3];
    for (int j = 0; j < 3; j++) out[j + 1] = r[j];
}

static void fetch(bench_case which, size_t n, double *out)
{
    if (which == BENCH_COMPOSE) {
        put(out, product);
        return;
    }
    for (size_t i = 0; i < n; i++) {
        if (bench_width(which) == 4) put(out + 4 * i, out_q[i]);
        for (size_t j = 0; bench_width(which) == 3 && j < 3; j++) out[3 * i + j] = out_v[i][j];
        for (size_t j = 0; bench_width(which) == 9 && j < 9; j++) out[9 * i + j] = out_m[i][j % 3][j / 3];
    }
}

static int can(bench_case which)
{
    (void)which;
    return 1;
}

const bench_contestant bench_cglm = {"cglm", "float", load, run, fetch, can, 0};
#else
const bench_contestant bench_cglm = {"cglm", NULL, NULL, NULL, NULL, NULL, 0};
#endif
