/* SPDX-License-Identifier: MIT */
#include <quat/integrate.h>
#include <quat/rotation.h>

static const double sqrt3 = 1.7320508075688772935;

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

quat_status quat_integrate(quat_omega omega, void *context, quat_frame frame, quat_method method, double t0, double t1,
                           size_t n, quat q, quat *result)
{
    if (quat_normalize(q, result) != QUAT_OK || !isfinite(t0) || !isfinite(t1)) return QUAT_EDOMAIN;
    if (n == 0 || (frame != QUAT_WORLD && frame != QUAT_BODY) || (method != QUAT_MAGNUS4 && method != QUAT_CF4))
        return QUAT_EARGUMENT;
    const double h = (t1 - t0) / (double)n;
    for (size_t i = 0; i < n; i++) {
        const double start = t0 + (double)i * h;
        const qvec3 omega1 = omega(start + (0.5 - sqrt3 / 6) * h, context),
                    omega2 = omega(start + (0.5 + sqrt3 / 6) * h, context);
        if (!qvec3_isfinite(omega1) || !qvec3_isfinite(omega2)) return QUAT_EDOMAIN;
        const quat next = method == QUAT_CF4 ? quat_step_cf4(*result, omega1, omega2, h, frame)
                                             : quat_step_magnus4(*result, omega1, omega2, h, frame);
        if (!quat_isfinite(next)) return QUAT_ERANGE;
        *result = quat_renormalize(next);
    }
    return QUAT_OK;
}
