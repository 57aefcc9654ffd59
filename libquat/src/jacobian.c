/* SPDX-License-Identifier: MIT */
#include <quat/jacobian.h>
#include <quat/exponential.h>

qmat4 quat_left_matrix(quat p)
{
    return (qmat4){{{p.w, -p.x, -p.y, -p.z}, {p.x, p.w, -p.z, p.y}, {p.y, p.z, p.w, -p.x}, {p.z, -p.y, p.x, p.w}}};
}

qmat4 quat_right_matrix(quat q)
{
    return (qmat4){{{q.w, -q.x, -q.y, -q.z}, {q.x, q.w, q.z, -q.y}, {q.y, -q.z, q.w, q.x}, {q.z, q.y, -q.x, q.w}}};
}

/* q v q* = (w^2 - u.u) v + 2 (u.v) u + 2 w u x v. */
qmat34 quat_rotate_jacobian(quat q, qvec3 v)
{
    const qvec3 u = quat_vector(q), cross = qvec3_cross(u, v);
    const double dot = 2 * qvec3_dot(u, v), w = 2 * q.w;
    const double a[3] = {u.x, u.y, u.z}, b[3] = {v.x, v.y, v.z}, c[3] = {cross.x, cross.y, cross.z};
    const double minus_v_cross[3][3] = {{0, v.z, -v.y}, {-v.z, 0, v.x}, {v.y, -v.x, 0}};
    qmat34 r;
    for (int i = 0; i < 3; i++) {
        r.m[i][0] = w * b[i] + 2 * c[i];
        for (int j = 0; j < 3; j++)
            r.m[i][1 + j] = -2 * b[i] * a[j] + 2 * a[i] * b[j] + (i == j ? dot : 0) + w * minus_v_cross[i][j];
    }
    return r;
}

qmat43 quat_exp_jacobian(qvec3 v)
{
    const double n = qvec3_norm(v), a[3] = {v.x, v.y, v.z};
    double sinc, slope; /* sin n/n, and its derivative over n: (cos n - sin n/n)/n^2 */
    if (n < 0.03) {
        const double n2 = n * n;
        sinc = 1 - n2 / 6 * (1 - n2 / 20 * (1 - n2 / 42));
        slope = -1.0 / 3 * (1 - n2 / 10 * (1 - n2 / 28 * (1 - n2 / 54)));
    } else {
        sinc = sin(n) / n;
        slope = (cos(n) - sinc) / n / n;
    }
    qmat43 r;
    for (int j = 0; j < 3; j++) {
        r.m[0][j] = -sinc * a[j];
        for (int i = 0; i < 3; i++) r.m[1 + i][j] = (i == j ? sinc : 0) + slope * a[i] * a[j];
    }
    return r;
}

/* log q = f u with f = atan2(n, w)/n, n = |u|: df/dw = -1 and df/dn = (w - f)/n on the unit sphere. */
qmat34 quat_log_jacobian(quat q)
{
    const qvec3 u = quat_vector(q);
    const double n = qvec3_norm(u), a[3] = {u.x, u.y, u.z};
    double f, slope; /* f, and (df/dn)/n = (w - f)/n^2 */
    if (n < 0.03 && q.w > 0) {
        const double n2 = n * n;
        f = 1 + n2 * (1.0 / 6 + n2 * (3.0 / 40 + n2 * (5.0 / 112 + n2 * (35.0 / 1152))));
        slope = -2.0 / 3 - n2 * (1.0 / 5 + n2 * (3.0 / 28 + n2 * (5.0 / 72 + n2 * (35.0 / 704))));
    } else {
        f = atan2(n, q.w) / n;
        slope = (q.w - f) / n / n;
    }
    qmat34 r;
    for (int i = 0; i < 3; i++) {
        r.m[i][0] = -a[i];
        for (int j = 0; j < 3; j++) r.m[i][1 + j] = (i == j ? f : 0) + slope * a[i] * a[j];
    }
    return r;
}

/* 1 + b [r]x + c [r]x^2 */
static qmat3 series(qvec3 r, double b, double c)
{
    const double xx = r.x * r.x, yy = r.y * r.y, zz = r.z * r.z, xy = c * r.x * r.y, xz = c * r.x * r.z,
                 yz = c * r.y * r.z;
    return (qmat3){{{1 - c * (yy + zz), xy - b * r.z, xz + b * r.y},
                    {xy + b * r.z, 1 - c * (xx + zz), yz - b * r.x},
                    {xz - b * r.y, yz + b * r.x, 1 - c * (xx + yy)}}};
}

qmat3 quat_rotation_vector_jacobian_left(qvec3 r)
{
    const double a = qvec3_norm(r), a2 = a * a;
    /* (1 - cos a)/a^2 = (sin(a/2)/(a/2))^2/2, never by the difference */
    const double s = a < 1e-8 ? 1 : sin(0.5 * a) / (0.5 * a), b = 0.5 * s * s;
    const double c = a < 0.5 ? (1 - a2 / 20 * (1 - a2 / 42 * (1 - a2 / 72 * (1 - a2 / 110 * (1 - a2 / 156))))) / 6
                             : (1 - sin(a) / a) / a2;
    return series(r, b, c);
}

qmat3 quat_rotation_vector_jacobian_right(qvec3 r) { return quat_rotation_vector_jacobian_left(qvec3_neg(r)); }

qmat3 quat_rotation_vector_jacobian_left_inverse(qvec3 r)
{
    const double a = qvec3_norm(r), a2 = a * a;
    double c;
    if (a < 0.5) {
        /* the Bernoulli numbers of x cot x */
        c = 1.0 / 12 +
            a2 * (1.0 / 720 +
                  a2 * (1.0 / 30240 + a2 * (1.0 / 1209600 + a2 * (1.0 / 47900160 + a2 * (691.0 / 1307674368000)))));
    } else {
        c = (1 - 0.5 * a * cos(0.5 * a) / sin(0.5 * a)) / a2;
    }
    return series(r, -0.5, c);
}

qmat3 quat_rotation_vector_jacobian_right_inverse(qvec3 r)
{
    return quat_rotation_vector_jacobian_left_inverse(qvec3_neg(r));
}
