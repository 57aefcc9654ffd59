/* SPDX-License-Identifier: MIT
 *
 * Random shapes, directions and rotations for the contact rooms' tests and campaigns: a fixed stream per seed, the same
 * on every machine.
 */
#ifndef CONTACT_RANDOM_H
#define CONTACT_RANDOM_H

#include <stdint.h>
#include <impact/gap.h>
#include <quat/rotation.h>

typedef struct random_stream {
    uint64_t state;
} random_stream;

/* splitmix64 (Steele, Lea, Flood 2014). */
static inline uint64_t random_bits(random_stream *random)
{
    uint64_t z = (random->state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static inline double random_unit(random_stream *random) { return (double)(random_bits(random) >> 11) * 0x1p-53; }

/* low to high, evenly in the logarithm. */
static inline double random_log(random_stream *random, double low, double high)
{
    return low * exp(random_unit(random) * log(high / low));
}

static inline qvec3 random_direction(random_stream *random)
{
    const double z = 2 * random_unit(random) - 1, angle = 6.28318530717958647692 * random_unit(random);
    const double rho = sqrt(1 - z * z);
    return (qvec3){rho * cos(angle), rho * sin(angle), z};
}

/* low to high long, any way. */
static inline qvec3 random_vector(random_stream *random, double low, double high)
{
    const double length = random_log(random, low, high);
    return qvec3_scale(random_direction(random), length);
}

/* Evenly over the rotations (Shoemake 1992). */
static inline quat random_rotation(random_stream *random)
{
    const double a = random_unit(random), b = 6.28318530717958647692 * random_unit(random),
                 c = 6.28318530717958647692 * random_unit(random);
    const quat q = {sqrt(a) * cos(c), sqrt(1 - a) * sin(b), sqrt(1 - a) * cos(b), sqrt(a) * sin(c)};
    quat unit;
    quat_normalize(q, &unit);
    return unit;
}

enum {
    RANDOM_SPHERE,
    RANDOM_ELLIPSOID,
    RANDOM_NEEDLE,       /* ellipsoids of aspect up to 1e6 */
    RANDOM_ROUND,        /* equal exponents in [1.5, 4] */
    RANDOM_MIXED,        /* independent exponents in [1.3, 10] */
    RANDOM_CYLINDER,     /* (2, 2, up to 100) */
    RANDOM_OCTAHEDRAL,   /* exponents in [1, 1.3] */
    RANDOM_BOXY,         /* exponents in [10, 100] */
    RANDOM_EXTREME,      /* exponents in [1, 1000], aspect to 1e3 */
    RANDOM_BARR,         /* eps in [0.2, 1.6] */
    RANDOM_BARR_EXTREME, /* eps in [0.02, 2] */
    RANDOM_FAMILIES
};

static inline const char *random_family_name(int family)
{
    static const char *const names[] = {"sphere",     "ellipsoid", "needle",  "round", "mixed",       "cylinder",
                                        "octahedral", "boxy",      "extreme", "barr",  "barr-extreme"};
    return names[family];
}

static inline impact_shape random_shape(random_stream *random, int family)
{
    impact_shape shape = {.kind = IMPACT_SPHERE, .a = 1, .b = 1, .c = 1, .r = 2, .s = 2, .t = 2};
    const double low = family == RANDOM_NEEDLE ? 1e-6 : family == RANDOM_EXTREME ? 1e-3 : 0.2;
    const double a = random_log(random, low, 1), b = random_log(random, low, 1), c = random_log(random, low, 1);
    double f[3];
    for (int i = 0; i < 3; i++) f[i] = random_unit(random);
    switch (family) {
    case RANDOM_SPHERE: impact_shape_sphere(a, &shape); break;
    case RANDOM_ELLIPSOID:
    case RANDOM_NEEDLE: impact_shape_ellipsoid(a, b, c, &shape); break;
    case RANDOM_ROUND: {
        const double p = 1.5 * pow(4 / 1.5, f[0]);
        impact_shape_superquadric(a, b, c, p, p, p, &shape);
        break;
    }
    case RANDOM_MIXED:
        impact_shape_superquadric(a, b, c, 1.3 * pow(10 / 1.3, f[0]), 1.3 * pow(10 / 1.3, f[1]),
                                  1.3 * pow(10 / 1.3, f[2]), &shape);
        break;
    case RANDOM_CYLINDER: impact_shape_superquadric(a, a, c, 2, 2, 4 * pow(25, f[0]), &shape); break;
    case RANDOM_OCTAHEDRAL: /* some exactly 1 */
        impact_shape_superquadric(a, b, c, 1 + 0.3 * fmax(0, 2 * f[0] - 1), 1 + 0.3 * fmax(0, 2 * f[1] - 1),
                                  1 + 0.3 * fmax(0, 2 * f[2] - 1), &shape);
        break;
    case RANDOM_BOXY:
        impact_shape_superquadric(a, b, c, 10 * pow(10, f[0]), 10 * pow(10, f[1]), 10 * pow(10, f[2]), &shape);
        break;
    case RANDOM_EXTREME:
        impact_shape_superquadric(a, b, c, pow(1000, f[0]), pow(1000, f[1]), pow(1000, f[2]), &shape);
        break;
    case RANDOM_BARR: impact_shape_superellipsoid(a, b, c, 0.2 * pow(8, f[0]), 0.2 * pow(8, f[1]), &shape); break;
    case RANDOM_BARR_EXTREME:
        impact_shape_superellipsoid(a, b, c, 0.02 * pow(100, f[0]), 0.02 * pow(100, f[1]), &shape);
        break;
    default: break;
    }
    return shape;
}

/* Exponents in [1.5, 4], superquadric or Barr's. */
static inline impact_shape random_smooth_shape(random_stream *random, bool nested)
{
    impact_shape shape = random_shape(random, RANDOM_SPHERE);
    const double a = 0.5 + random_unit(random), b = 0.5 + random_unit(random), c = 0.5 + random_unit(random);
    const double r = 1.5 + 2.5 * random_unit(random), s = 1.5 + 2.5 * random_unit(random),
                 t = 1.5 + 2.5 * random_unit(random);
    if (nested)
        impact_shape_superellipsoid(a, b, c, 2 / t, 2 / r, &shape);
    else
        impact_shape_superquadric(a, b, c, r, s, t, &shape);
    return shape;
}

static inline double contact_size(const impact_shape *s) { return fmax(s->a, fmax(s->b, s->c)); }

/* Where the body reaches farthest along n, less its position. */
static inline qvec3 contact_support(const impact_solid *body, qvec3 n)
{
    qvec3 x;
    impact_shape_support(&body->shape, quat_rotate_inverse(body->orientation, n), &x);
    return quat_rotate(body->orientation, x);
}

/* Whether g has a local maximum at the normal when the gap is the given negative one: H_A + H_B + gap I positive across
 * it. */
static inline bool contact_is_deepest(const impact_solid body[2], qvec3 n, double gap)
{
    double W[3][3] = {{0}};
    for (int k = 0; k < 2; k++) {
        const qmat3 H = impact_shape_support_hessian(&body[k].shape,
                                                     quat_rotate_inverse(body[k].orientation, k ? n : qvec3_neg(n)));
        const qmat3 R = quat_to_matrix(body[k].orientation);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                for (int a = 0; a < 3; a++)
                    for (int b = 0; b < 3; b++) W[i][j] += R.m[i][a] * H.m[a][b] * R.m[j][b];
    }
    /* eigenvalues 0, r1, r2: trace and sum of principal minors */
    const double trace = W[0][0] + W[1][1] + W[2][2];
    const double minors = W[0][0] * W[1][1] - W[0][1] * W[1][0] + W[1][1] * W[2][2] - W[1][2] * W[2][1] +
                          W[2][2] * W[0][0] - W[2][0] * W[0][2];
    return isfinite(trace) && minors / trace > -4 * gap;
}

#endif
