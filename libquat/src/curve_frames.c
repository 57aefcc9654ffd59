/* SPDX-License-Identifier: MIT */
#include "curve.h"

#include <float.h>
#include <quat/rotation.h>

static const qvec3 x_axis = {1, 0, 0};

quat_status quat_frame_step(quat q, qvec3 x0, qvec3 x1, qvec3 tangent1, quat *next)
{
    qvec3 chord, bisector, t1;
    *next = q;
    if (qvec3_normalize(qvec3_sub(x1, x0), &chord) != QUAT_OK) return QUAT_EDOMAIN;
    if (qvec3_normalize(tangent1, &t1) != QUAT_OK) return QUAT_EDOMAIN;
    /* The tangent mirrored in the chord's bisecting plane, then onto the next tangent; of the frame's own x axis, so
     * that nothing adds up. */
    const qvec3 mirrored = quat_reflect(chord, quat_rotate(q, x_axis)), sum = qvec3_add(t1, mirrored);
    bisector = qvec3_sub(t1, mirrored);
    if (qvec3_norm(bisector) <= 8 * DBL_EPSILON) return QUAT_EDOMAIN; /* nothing but rounding */
    /* Of two unit vectors the difference stands on the sum; what rounding adds to it along the sum would turn x off. */
    const double slant = qvec3_dot(bisector, sum) / fmax(qvec3_dot(sum, sum), 1);
    qvec3_normalize(qvec3_axpy(-slant, sum, bisector), &bisector);
    *next = quat_nearest(quat_renormalize(quat_mul(quat_from_reflections(chord, bisector), q)), q);
    return QUAT_OK;
}

/* The angle about the common x axis from p to q, -pi ... pi. */
static double twist(quat p, quat q)
{
    const quat s = quat_mul(quat_conj(p), q);
    return s.w < 0 ? 2 * atan2(-s.x, -s.w) : 2 * atan2(s.x, s.w);
}

static quat untwist(quat q, double angle) { return quat_mul(q, quat_make(cos(angle / 2), sin(angle / 2), 0, 0)); }

typedef struct station {
    double t;
    qvec3 x, tangent;
} station;

static quat_status at_station(const quat_curve *curve, double t, station *s)
{
    s->t = t;
    return quat_curve_tangent(curve, t, &s->x, &s->tangent);
}

static double sample(const quat_curve *curve, size_t n, const double t[], size_t i)
{
    if (t) return t[i];
    return i == n - 1 ? curve->end : curve->start + (curve->end - curve->start) * ((double)i / (double)(n - 1));
}

/* Frenet's frame at t, turned to q's side; carried, the minimal step's frame, where there is none. */
static quat_status frenet(const quat_curve *curve, double t, quat carried, bool first, size_t *inflections, quat *q)
{
    quat_curve_point point;
    const quat_status status = quat_curve_at(curve, t, &point);
    if (status < 0) return status;
    if (first) {
        *inflections += status == QUAT_NOT_UNIQUE;
        *q = point.frame;
        return QUAT_OK;
    }
    *q = status == QUAT_NOT_UNIQUE ? carried : quat_nearest(point.frame, carried);
    if (status == QUAT_NOT_UNIQUE || fabs(twist(carried, *q)) > 1.5707963267948966) ++*inflections;
    return QUAT_OK;
}

static quat_status start_frame(const quat_curve *curve, const quat *first, const station *s, quat *q)
{
    quat unit, swing;
    if (!first) {
        quat_curve_point point;
        const quat_status status = quat_curve_at(curve, s->t, &point);
        *q = point.frame;
        return status < 0 ? status : QUAT_OK;
    }
    if (quat_normalize(*first, &unit) != QUAT_OK) return QUAT_EDOMAIN;
    const quat_status status = quat_from_two_vectors(quat_rotate(unit, x_axis), s->tangent, &swing);
    *q = quat_renormalize(quat_mul(swing, unit));
    return status < 0 ? status : QUAT_OK;
}

static quat_status run(const quat_curve *curve, quat_framing framing, const quat *first, size_t n, const double t[],
                       quat q[], quat_framing_report *report)
{
    station here, next;
    quat_status status = at_station(curve, sample(curve, n, t, 0), &here);
    if (status < 0) return status;
    status = framing == QUAT_FRENET ? frenet(curve, here.t, quat_identity(), true, &report->inflections, &q[0])
                                    : start_frame(curve, first, &here, &q[0]);
    for (size_t i = 1; i < n && status == QUAT_OK; i++) {
        status = at_station(curve, sample(curve, n, t, i), &next);
        if (status == QUAT_OK) status = quat_frame_step(q[i - 1], here.x, next.x, next.tangent, &q[i]);
        if (status == QUAT_OK && framing == QUAT_FRENET)
            status = frenet(curve, next.t, q[i], false, &report->inflections, &q[i]);
        here = next;
    }
    return status;
}

static quat_status close_up(const quat_curve *curve, size_t n, const double t[], double holonomy, quat q[])
{
    double whole, gone = 0;
    quat_status status = quat_curve_length(curve, curve->start, curve->end, &whole);
    for (size_t i = 1; i < n && status >= 0; i++) {
        double piece;
        status = quat_curve_length(curve, sample(curve, n, t, i - 1), sample(curve, n, t, i), &piece);
        gone += piece;
        q[i] = untwist(q[i], -holonomy * (i == n - 1 ? 1 : gone / whole));
    }
    return status < 0 ? status : QUAT_OK;
}

static bool good_times(const quat_curve *curve, size_t n, const double t[])
{
    for (size_t i = 0; i < n; i++)
        if (!isfinite(t[i]) || (i > 0 && !(t[i] > t[i - 1])) || t[i] < curve->start || t[i] > curve->end) return false;
    return true;
}

quat_status quat_curve_frames(const quat_curve *curve, quat_framing framing, const quat *first, size_t n,
                              const double t[], quat q[], quat_framing_report *report)
{
    quat_framing_report own;
    const quat_framing_report none = {0, 0, 0};
    if (!report) report = &own;
    *report = none;
    if (!quat_curve_is_good(curve) || n < 2 || !q || (unsigned)framing > QUAT_CLOSED) return QUAT_EARGUMENT;
    if (t && !good_times(curve, n, t)) return QUAT_EARGUMENT;
    const bool round = curve->closed && (!t || (t[0] == curve->start && t[n - 1] == curve->end));
    if (framing == QUAT_CLOSED && !round) return QUAT_EARGUMENT;
    quat_status status = run(curve, framing, first, n, t, q, report);
    if (status < 0) return status;
    if (round) {
        if (framing != QUAT_FRENET) report->holonomy = twist(q[0], q[n - 1]);
        if (framing == QUAT_CLOSED) status = close_up(curve, n, t, report->holonomy, q);
        report->monodromy = quat_dot(q[0], q[n - 1]) < 0 ? -1 : 1;
    }
    if (status < 0) return status;
    return report->inflections > 0 ? QUAT_NOT_UNIQUE : QUAT_OK;
}
