/* SPDX-License-Identifier: MIT
 *
 * bench_quat: the same work done by libquat and by its peers, each in its own types and its own memory layout.
 */
#ifndef BENCH_QUAT_H
#define BENCH_QUAT_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum bench_case {
    BENCH_PRODUCT,      /* out = p q, element by element */
    BENCH_COMPOSE,      /* one long product q0 q1 ... */
    BENCH_NORMALIZE,    /* out = p/|p| */
    BENCH_ROTATE,       /* out = q v q*, a rotation for each vector */
    BENCH_ROTATE_ARRAY, /* out = q0 v q0*, one rotation for all */
    BENCH_SLERP,        /* out = slerp(p, q, t) */
    BENCH_TO_MATRIX,    /* out = R(q) */
    BENCH_FROM_MATRIX,  /* out = q of the matrix R(p) */
    BENCH_CASES
} bench_case;

/* How many numbers one result of a case has. */
static inline int bench_width(bench_case which)
{
    return which == BENCH_ROTATE || which == BENCH_ROTATE_ARRAY ? 3 : which == BENCH_TO_MATRIX ? 9 : 4;
}

/* Quaternions w x y z, vectors x y z, matrices by rows; every contestant copies them into its own types. */
typedef struct bench_input {
    size_t n;
    const double *p, *q, *v, *t, *m;
} bench_input;

typedef struct bench_contestant {
    const char *name, *type;
    void (*load)(const bench_input *input);                 /* not timed */
    void (*run)(bench_case which, size_t n);                /* timed */
    void (*fetch)(bench_case which, size_t n, double *out); /* not timed */
    int (*can)(bench_case which);
    int peer; /* 1: another library, in double: what the ratio is against */
} bench_contestant;

extern const bench_contestant bench_eigen, bench_glm, bench_cglm;

#ifdef __cplusplus
}
#endif

#endif
