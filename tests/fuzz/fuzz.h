/* SPDX-License-Identifier: MIT
 *
 * What the harnesses share: numbers out of a fuzzer's bytes, and promises. A harness defines LLVMFuzzerTestOneInput,
 * which libFuzzer or driver.c calls, and fuzz_show, which prints the case at hand as code that reproduces it.
 */
#ifndef FUZZ_H
#define FUZZ_H

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <quat/quat.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
void fuzz_show(FILE *out);

typedef struct fuzz_bytes {
    const uint8_t *data;
    size_t size;
} fuzz_bytes;

/* 0 where the bytes are spent. */
static inline unsigned take_byte(fuzz_bytes *b)
{
    if (b->size == 0) return 0;
    b->size--;
    return *b->data++;
}

static inline unsigned take_below(fuzz_bytes *b, unsigned n) { return take_byte(b) % n; }

/* Any bits as a double. */
static inline double take_raw(fuzz_bytes *b)
{
    uint64_t bits = 0;
    double x;
    for (int i = 0; i < 8; i++) bits = bits << 8 | take_byte(b);
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* In [0, 1], often a plain number or one beside it. */
static inline double take_unit(fuzz_bytes *b)
{
    static const double plain[] = {0, 1, 0.5, 0.25, 0.1, 1e-16, 1 - 1e-16, 1e-8, 1 - 1e-8, 0.3, 0.8, 0x1p-52, 0x1p-30};
    const unsigned kind = take_byte(b);
    if (kind < 128) return plain[kind % (sizeof plain / sizeof *plain)];
    return ((kind & 127) * 256 + take_byte(b)) / 32767.0;
}

/* Of either sign, mostly about 1, now and then of any magnitude within 10^+-span. */
static inline double take_signed(fuzz_bytes *b, double span)
{
    const unsigned kind = take_byte(b);
    const double sign = kind & 1 ? -1 : 1, u = take_unit(b);
    switch (kind >> 1 & 7) {
    case 0: return 0;
    case 1: return sign;
    case 2: return sign * pow(10, span * (2 * take_unit(b) - 1)) * u;
    case 3: return sign * pow(10, -span * take_unit(b));
    default: return sign * u * 2;
    }
}

static inline double take_positive(fuzz_bytes *b, double span)
{
    const double x = fabs(take_signed(b, span));
    return x > 0 ? x : 1;
}

/* Anything at all, NaN and infinities too. */
static inline double take_wild(fuzz_bytes *b)
{
    static const double wild[] = {NAN, INFINITY, -INFINITY, 0, -0.0, 1e308, -1e308, 5e-324, 1e-308, 1e154, 1e-162, 1};
    const unsigned kind = take_byte(b);
    if (kind < 64) return wild[kind % (sizeof wild / sizeof *wild)];
    return kind < 128 ? take_raw(b) : take_signed(b, 20);
}

static inline qvec3 take_vec3(fuzz_bytes *b, double span)
{
    const double x = take_signed(b, span), y = take_signed(b, span), z = take_signed(b, span);
    return (qvec3){x, y, z};
}

static inline quat take_quat(fuzz_bytes *b)
{
    const qvec3 v = take_vec3(b, 8);
    const quat q = {take_signed(b, 8), v.x, v.y, v.z};
    quat u;
    return quat_normalize(q, &u) == QUAT_OK ? u : quat_identity();
}

/* Numbers as C reads them, exactly. */
static inline void show_number(FILE *out, double x)
{
    if (isnan(x))
        fputs("NAN", out);
    else if (isinf(x))
        fputs(x > 0 ? "INFINITY" : "-INFINITY", out);
    else
        fprintf(out, "%.17g", x);
}

static inline void show_numbers(FILE *out, const char *name, const double *x, size_t n)
{
    fprintf(out, "%s{", name);
    for (size_t i = 0; i < n; i++) {
        if (i) fputs(", ", out);
        show_number(out, x[i]);
    }
    fputs("}", out);
}

static inline void show_vec3(FILE *out, const char *name, qvec3 v)
{
    show_numbers(out, name, (double[]){v.x, v.y, v.z}, 3);
}

static inline void show_quat(FILE *out, const char *name, quat q)
{
    show_numbers(out, name, (double[]){q.w, q.x, q.y, q.z}, 4);
}

/* The promise is broken: the case as code, and an end that every fuzzer sees. */
static inline void fuzz_broken(const char *promise, const char *file, int line, double value, double bound)
{
    fprintf(stderr, "\n%s:%d: broken: %s: %.17g (bound %.17g)\n", file, line, promise, value, bound);
    fuzz_show(stderr);
    abort();
}

#define HOLD(promise, value, bound)                                                                                    \
    do {                                                                                                               \
        if (!(promise)) fuzz_broken(#promise, __FILE__, __LINE__, value, bound);                                       \
    } while (0)

#endif
