/* SPDX-License-Identifier: MIT */
#include <impact/flight.h>
#include <quat/rotation.h>

impact_flight impact_flight_after(impact_flight start, qvec3 gravity, double dt)
{
    const quat turned = quat_mul(quat_from_rotation_vector(qvec3_scale(start.omega, dt)), start.orientation);
    impact_flight end = {
        .position = qvec3_axpy(dt, qvec3_axpy(0.5 * dt, gravity, start.velocity), start.position),
        .velocity = qvec3_axpy(dt, gravity, start.velocity),
        .omega = start.omega,
    };
    quat_normalize(turned, &end.orientation);
    return end;
}

double impact_flight_fall_time(double a, double b, double c)
{
    if (!(a > 0)) a = 0;
    if (a == 0) {
        if (b < 0 || (b == 0 && c < 0)) return 0;
        return c < 0 ? -2 * b / c : INFINITY;
    }
    const double discriminant = b * b - 2 * a * c;
    if (discriminant < 0) return INFINITY;
    const double root = sqrt(discriminant);
    if (b < 0) return 2 * a / (root - b);      /* falling: the nearer root, no cancellation */
    return c < 0 ? (b + root) / -c : INFINITY; /* rising: only a negative acceleration brings it back */
}
