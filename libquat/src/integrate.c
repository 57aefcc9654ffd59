/* SPDX-License-Identifier: MIT */
#include <quat/integrate.h>
#include <quat/rotation.h>

static const double sqrt3 = 1.7320508075688772935;

/* Gauss' four points stand this far from the middle of the step, in parts of it. */
static const double inner_part = 0.16999052179242812824, outer_part = 0.43056815579702628761;

static quat turn(quat q, qvec3 rotation_vector, quat_frame frame)
{
    const quat step = quat_from_rotation_vector(rotation_vector);
    return frame == QUAT_WORLD ? quat_mul(step, q) : quat_mul(q, step);
}

quat quat_step_magnus4(quat q, qvec3 omega1, qvec3 omega2, double h, quat_frame frame)
{
    /* R' = [w]R has the commutator [A2, A1], R' = R[w] the opposite; [w]s commute as their cross products */
    const double side = frame == QUAT_WORLD ? 1 : -1;
    const qvec3 mean = qvec3_scale(qvec3_add(omega1, omega2), 0.5 * h);
    const qvec3 bent = qvec3_scale(qvec3_cross(omega2, omega1), side * sqrt3 / 12 * h * h);
    return turn(q, qvec3_add(mean, bent), frame);
}

quat quat_step_cf4(quat q, qvec3 omega1, qvec3 omega2, double h, quat_frame frame)
{
    const double near = h * (0.25 + sqrt3 / 6), far = h * (0.25 - sqrt3 / 6);
    const qvec3 first = qvec3_axpy(far, omega2, qvec3_scale(omega1, near));
    const qvec3 second = qvec3_axpy(near, omega2, qvec3_scale(omega1, far));
    return turn(turn(q, first, frame), second, frame);
}

/* a, b: of the generators that follow, their sum with a weight. */
static qvec3 sum(qvec3 a, double weight, qvec3 b) { return qvec3_axpy(weight, b, a); }

/* Generators a1 ... a4 are h times the coefficients of omega's cubic about the step's middle, in parts of the step;
 * their commutators cross products, s1 ... s3 and r1, r2 in Blanes, Casas and Ros's names. */
quat quat_step_magnus8(quat q, const qvec3 omega[4], double h, quat_frame frame)
{
    const double side = frame == QUAT_WORLD ? 1 : -1, inner = inner_part, outer = outer_part,
                 apart = h / (outer * outer - inner * inner);
    const qvec3 even_in = qvec3_scale(qvec3_add(omega[1], omega[2]), 0.5),
                even_out = qvec3_scale(qvec3_add(omega[0], omega[3]), 0.5),
                odd_in = qvec3_scale(qvec3_sub(omega[2], omega[1]), 0.5 / inner),
                odd_out = qvec3_scale(qvec3_sub(omega[3], omega[0]), 0.5 / outer);
    const qvec3 a3 = qvec3_scale(qvec3_sub(even_out, even_in), apart),
                a4 = qvec3_scale(qvec3_sub(odd_out, odd_in), apart),
                a1 = sum(qvec3_scale(even_in, h), -inner * inner, a3),
                a2 = sum(qvec3_scale(odd_in, h), -inner * inner, a4);
    const qvec3 even = sum(a1, 1.0 / 28, a3), odd = sum(a2, 3.0 / 28, a4);
    const qvec3 s1 = qvec3_scale(qvec3_cross(even, odd), -side / 28),
                r1 = qvec3_scale(qvec3_cross(a1, sum(s1, -1.0 / 14, a3)), side / 3),
                s2 = qvec3_scale(qvec3_cross(qvec3_add(even, s1), qvec3_add(odd, r1)), side),
                bent = qvec3_scale(qvec3_cross(a2, s1), side),
                r2 = qvec3_scale(qvec3_cross(sum(a1, 1.25, s1), sum(sum(s2, 2, a3), 0.5, bent)), side);
    const qvec3 left = sum(sum(sum(a1, 1.0 / 12, a3), -7.0 / 3, s1), -1.0 / 6, s2),
                right = sum(sum(sum(r2, -9, a2), -9.0 / 4, a4), 63, r1);
    const qvec3 s3 = qvec3_scale(qvec3_cross(left, right), side);
    return turn(q, sum(sum(sum(a1, 1.0 / 12, a3), -7.0 / 120, s2), 1.0 / 360, s3), frame);
}

int quat_method_parts(quat_method method, double part[4])
{
    if (method == QUAT_MAGNUS8) {
        part[0] = 0.5 - outer_part, part[1] = 0.5 - inner_part, part[2] = 0.5 + inner_part, part[3] = 0.5 + outer_part;
        return 4;
    }
    part[0] = 0.5 - sqrt3 / 6, part[1] = 0.5 + sqrt3 / 6;
    return method == QUAT_MAGNUS4 || method == QUAT_CF4 ? 2 : 0;
}

quat quat_step_by(quat_method method, quat q, const qvec3 omega[], double h, quat_frame frame)
{
    if (method == QUAT_MAGNUS8) return quat_step_magnus8(q, omega, h, frame);
    if (method == QUAT_CF4) return quat_step_cf4(q, omega[0], omega[1], h, frame);
    return quat_step_magnus4(q, omega[0], omega[1], h, frame);
}

quat_status quat_integrate(quat_omega omega, void *context, quat_frame frame, quat_method method, double t0, double t1,
                           size_t n, quat q, quat *result)
{
    double part[4];
    const int parts = quat_method_parts(method, part);
    if (quat_normalize(q, result) != QUAT_OK || !isfinite(t0) || !isfinite(t1)) return QUAT_EDOMAIN;
    if (n == 0 || (frame != QUAT_WORLD && frame != QUAT_BODY) || parts == 0) return QUAT_EARGUMENT;
    const double h = (t1 - t0) / (double)n;
    for (size_t i = 0; i < n; i++) {
        qvec3 asked[4];
        for (int k = 0; k < parts; k++) {
            asked[k] = omega(t0 + (double)i * h + part[k] * h, context);
            if (!qvec3_isfinite(asked[k])) return QUAT_EDOMAIN;
        }
        const quat next = quat_step_by(method, *result, asked, h, frame);
        if (!quat_isfinite(next)) return QUAT_ERANGE;
        *result = quat_renormalize(next);
    }
    return QUAT_OK;
}
