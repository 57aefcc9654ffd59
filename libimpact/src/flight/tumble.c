/* SPDX-License-Identifier: MIT
 *
 * Axes 1, 2, 3: moments I1, I2, I3 in order of size, rising or falling, so that the direction l of the momentum circles
 * axis 3, l3 > 0. With the shares
 *
 *     rho = I1 (I3 - I2)/(I2 (I3 - I1)),   sigma = I3 (I2 - I1)/(I2 (I3 - I1)) = 1 - rho,   rho l3^2 >= sigma l1^2,
 *     l = (A cn, +-B sn, C dn),   A^2 = l1^2 + rho l2^2,   B^2 = A^2/rho,   C^2 = l3^2 + sigma l2^2,
 *     m = sigma A^2/(rho C^2),
 *
 * of the argument u = u0 + rate t. Let S be the minimal rotation that takes l to axis 3; then R(t) = R(0) S(0)^-1
 * Rz(chi) S(t) with
 *
 *     chi' = |L| (l3/I3 + (l1^2/I1 + l2^2/I2)/(1 + l3)) = |L|/I3 + const/(1 + C dn u),
 *
 * which has no singularity. 1 + C dn u is |theta_4(pi (u + i y)/(2 K), q^2)|^2 but for a factor and another, real,
 * theta function, where sn(y, k') = sqrt(rho); so chi is a linear part and twice that theta function's argument, as
 * Jacobi found for Cayley's parameters.
 */
#include <impact/tumble.h>
#include <quat/rotation.h>
#include "flight/elliptic.h"

/* Indices of the moments in rising order. */
static void sort_axes(const double I[3], int axis[3])
{
    for (int i = 0; i < 3; i++) axis[i] = i;
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2 - i; j++)
            if (I[axis[j]] > I[axis[j + 1]]) {
                const int k = axis[j];
                axis[j] = axis[j + 1];
                axis[j + 1] = k;
            }
}

/* l1 and l3 are to be >= 0, and the axes right-handed. */
static void sign_axes(impact_tumble *tumble, const double l[3])
{
    const int *axis = tumble->axis;
    const bool cyclic = (axis[0] + 1) % 3 == axis[1];
    tumble->sign[0] = l[axis[0]] < 0 ? -1 : 1;
    tumble->sign[2] = l[axis[2]] < 0 ? -1 : 1;
    tumble->sign[1] = tumble->sign[0] * tumble->sign[2] * (cyclic ? 1 : -1);
}

/* Minimal rotation of l onto axis 3. */
static quat onto_third(const double l[3])
{
    const double lift = 1 + l[2], norm = sqrt(lift * lift + l[0] * l[0] + l[1] * l[1]);
    return (quat){lift / norm, l[1] / norm, -l[0] / norm, 0};
}

/* The amplitudes, moduli and rates, from the momentum's size and its direction l along axes 1, 2, 3; false: omega is
 * constant. */
static bool find_motion(impact_tumble *tumble, double size, const double I[3], double rho, double sigma,
                        const double l[3])
{
    const double a = sqrt(l[0] * l[0] + rho * l[1] * l[1]), c = sqrt(l[2] * l[2] + sigma * l[1] * l[1]);
    const double rest = rho * l[2] * l[2] - sigma * l[0] * l[0];
    if (!(rho * l[2] * l[2] > 0 && a > 0)) return false;
    const double b = a / sqrt(rho), m1 = rest / (rho * c * c), m = fmin(1, sigma * a * a / (rho * c * c));
    const double sense = I[2] > I[0] ? 1 : -1;
    imp_elliptic_make(m, m1, &tumble->elliptic);
    tumble->start = imp_elliptic_inverse(sense * l[1] / b, l[0] / a, l[2] / c);
    if (!isfinite(tumble->start)) return false;
    const double y = sqrt(rho) * imp_elliptic_rf(sigma, sigma / (c * c), 1);
    const double w = c * imp_elliptic_rf(a * a, b * b, 1);
    imp_elliptic_phase_make(&tumble->elliptic, y, w, &tumble->phase);
    tumble->amplitude[0] = a;
    tumble->amplitude[1] = sense * b;
    tumble->amplitude[2] = c;
    tumble->sense = sense;
    tumble->rate = size / I[2] * c * sqrt((I[2] - I[0]) / I[0] * ((I[2] - I[1]) / I[1]));
    tumble->mean = size * (c / I[2] + a * (a / I[0]) / (1 + c)) + 2 * sense * tumble->phase.slope * tumble->rate;
    return true;
}

/* The momentum's direction along axes 1, 2, 3 after t, and chi since t = 0. */
static void motion_at(const impact_tumble *tumble, double t, double l[3], double *chi)
{
    const double turned = tumble->start + tumble->rate * t, period = 2 * tumble->elliptic.K;
    const double laps = isinf(period) ? 0 : nearbyint(turned / period);
    const double u = isinf(period) ? turned : fma(-laps, period, turned), sign = fmod(laps, 2) == 0 ? 1 : -1;
    double sn, cn, dn;
    imp_elliptic_at(&tumble->elliptic, u, &sn, &cn, &dn);
    l[0] = tumble->amplitude[0] * sign * cn;
    l[1] = tumble->amplitude[1] * sign * sn;
    l[2] = tumble->amplitude[2] * dn;
    const double phase = imp_elliptic_phase_at(&tumble->elliptic, &tumble->phase, u);
    *chi = tumble->mean * t - 2 * tumble->sense * (phase - tumble->start_phase);
}

/* The tumble of a body with this momentum in its own axes; all else is set. */
static void begin(const double inside[3], impact_tumble *tumble)
{
    const qvec3 moments = tumble->moments;
    const double size = qvec3_norm(qvec3_make(inside[0], inside[1], inside[2]));
    tumble->size = size;
    tumble->steady = true;
    tumble->turn = quat_rotate(tumble->orientation, tumble->omega);
    if (size == 0) return;
    const double I[3] = {moments.x, moments.y, moments.z};
    const double along[3] = {inside[0] / size, inside[1] / size, inside[2] / size};
    int *axis = tumble->axis;
    sort_axes(I, axis);
    const double low = I[axis[0]], middle = I[axis[1]], high = I[axis[2]];
    if (!(high > low)) return;
    double rho = (low / middle) * ((high - middle) / (high - low));
    double sigma = (high / middle) * ((middle - low) / (high - low));
    if (!(rho * along[axis[2]] * along[axis[2]] >= sigma * along[axis[0]] * along[axis[0]])) {
        const int k = axis[0];
        axis[0] = axis[2];
        axis[2] = k;
        const double share = rho;
        rho = sigma;
        sigma = share;
    }
    sign_axes(tumble, along);
    double l[3], moment[3], chi;
    for (int k = 0; k < 3; k++) l[k] = tumble->sign[k] * along[axis[k]], moment[k] = I[axis[k]];
    tumble->steady = !find_motion(tumble, size, moment, rho, sigma, l);
    if (tumble->steady) return;
    tumble->start_phase = imp_elliptic_phase_at(&tumble->elliptic, &tumble->phase, tumble->start);
    motion_at(tumble, 0, l, &chi);
    tumble->first = onto_third(l);
}

static impact_status check(qvec3 moments, quat orientation, qvec3 vector, quat *unit)
{
    if (!qvec3_isfinite(moments) || !qvec3_isfinite(vector) || quat_normalize(orientation, unit) != QUAT_OK)
        return IMPACT_EDOMAIN;
    return moments.x > 0 && moments.y > 0 && moments.z > 0 ? IMPACT_OK : IMPACT_EARGUMENT;
}

impact_status impact_tumble_make(qvec3 moments, quat orientation, qvec3 momentum, impact_tumble *tumble)
{
    quat unit;
    const impact_status status = check(moments, orientation, momentum, &unit);
    if (status != IMPACT_OK) return status;
    const qvec3 L = quat_rotate_inverse(unit, momentum), omega = {L.x / moments.x, L.y / moments.y, L.z / moments.z};
    const double inside[3] = {L.x, L.y, L.z};
    if (!qvec3_isfinite(omega)) return IMPACT_EDOMAIN;
    *tumble = (impact_tumble){.orientation = unit, .momentum = momentum, .moments = moments, .omega = omega};
    begin(inside, tumble);
    return IMPACT_OK;
}

impact_status impact_tumble_make_omega(qvec3 moments, quat orientation, qvec3 omega, impact_tumble *tumble)
{
    quat unit;
    const impact_status status = check(moments, orientation, omega, &unit);
    if (status != IMPACT_OK) return status;
    const qvec3 L = {moments.x * omega.x, moments.y * omega.y, moments.z * omega.z};
    const double inside[3] = {L.x, L.y, L.z};
    if (!qvec3_isfinite(L)) return IMPACT_EDOMAIN;
    *tumble =
        (impact_tumble){.orientation = unit, .momentum = quat_rotate(unit, L), .moments = moments, .omega = omega};
    begin(inside, tumble);
    return IMPACT_OK;
}

quat impact_tumble_at(const impact_tumble *tumble, double t)
{
    quat turned;
    if (t == 0) return tumble->orientation;
    if (tumble->steady)
        return quat_unit(quat_mul(quat_from_rotation_vector(qvec3_scale(tumble->turn, t)), tumble->orientation));
    double l[3], chi;
    motion_at(tumble, t, l, &chi);
    const quat about = {cos(0.5 * chi), 0, 0, sin(0.5 * chi)};
    turned = quat_mul(quat_conj(tumble->first), quat_mul(about, onto_third(l)));
    const double along[3] = {turned.x, turned.y, turned.z};
    double vector[3];
    for (int k = 0; k < 3; k++) vector[tumble->axis[k]] = tumble->sign[k] * along[k];
    return quat_unit(quat_mul(tumble->orientation, (quat){turned.w, vector[0], vector[1], vector[2]}));
}

/* |L| l_k/I_k of the body's own amplitudes: through L in the world each component would have the rounding of the
 * largest moment's. */
qvec3 impact_tumble_omega_body(const impact_tumble *tumble, double t)
{
    if (tumble->steady || t == 0) return tumble->omega;
    const double I[3] = {tumble->moments.x, tumble->moments.y, tumble->moments.z};
    double l[3], chi, omega[3];
    motion_at(tumble, t, l, &chi);
    for (int k = 0; k < 3; k++) {
        const int i = tumble->axis[k];
        omega[i] = tumble->sign[k] * l[k] * (tumble->size / I[i]);
    }
    return (qvec3){omega[0], omega[1], omega[2]};
}

qvec3 impact_tumble_omega(const impact_tumble *tumble, double t)
{
    if (tumble->steady) return tumble->turn;
    return quat_rotate(impact_tumble_at(tumble, t), impact_tumble_omega_body(tumble, t));
}

double impact_tumble_period(const impact_tumble *tumble)
{
    return tumble->steady ? INFINITY : 4 * tumble->elliptic.K / tumble->rate;
}
