/* SPDX-License-Identifier: MIT */
#include "motion/lying_steady.h"
#include "base/tolerances.h"
#include "motion/face_begin.h"

#include <impact/flight.h>
#include <string.h>

static double size_of(const double v[2]) { return hypot(v[0], v[1]); }

/* When a place that is inside leaves a face, s. */
static double leaves(const imp_flat_face *face, const double x[2], const double v[2], const double a[2])
{
    double time = INFINITY;
    for (int i = 0; i < face->count; i++) {
        const double *from = face->corner[i], *to = face->corner[(i + 1) % face->count];
        const double side[2] = {to[0] - from[0], to[1] - from[1]}, unit = size_of(side),
                     in[2] = {-side[1] / unit, side[0] / unit};
        time = fmin(time, impact_flight_fall_time(in[0] * (x[0] - from[0]) + in[1] * (x[1] - from[1]),
                                                  in[0] * v[0] + in[1] * v[1], in[0] * a[0] + in[1] * a[1]));
    }
    return time;
}

/* Along a line, without turning. */
static bool slides_straight(const imp_face_motion *m, const double v[2], imp_lying_steady *s)
{
    const double speed = size_of(v), pull = size_of(m->load.pull), *along = speed > 0 ? v : m->load.pull;
    const double size = size_of(along);
    if (!(size > 0) ||
        fabs(v[0] * m->load.pull[1] - v[1] * m->load.pull[0]) > IMP_LEVEL * speed * (pull + m->load.press))
        return false;
    const double line[2] = {along[0] / size, along[1] / size}, twist[3] = {line[0], line[1], 0};
    imp_face_balance balance = {.p = {0}};
    if (!imp_face_balance_of(m, twist, &balance)) return false;
    if (!(imp_face_spare(&m->face, balance.center) > IMP_FACE_MARGIN)) return false;
    const double rate = m->load.pull[0] * line[0] + m->load.pull[1] * line[1] - m->friction * m->load.press;
    if (speed == 0 && !(rate > 0)) return false;
    *s = (imp_lying_steady){
        .a = {rate * line[0], rate * line[1]}, .until = rate < 0 ? speed / -rate : INFINITY, .fades = rate < 0};
    if (!m->bounded) return true;
    if (m->under.count == 0 || !(imp_face_spare(&m->under, balance.center) > 2 * IMP_FACE_MARGIN)) return false;
    const double tips = leaves(&m->under, balance.center, v, s->a);
    if (tips < s->until) s->until = tips, s->fades = false;
    return true;
}

/* A line along itself, or across, without turning: as it slides across it rolls ever faster. */
static bool line_slides_straight(const imp_face_motion *m, const double *y, imp_lying_steady *s)
{
    const double *v = &y[IMP_FACE_V], *pull = m->load.pull;
    const int k = v[0] != 0 || (v[1] == 0 && pull[0] != 0) ? 0 : 1;
    const double along = v[k] != 0 ? v[k] : pull[k];
    if (v[1 - k] != 0 || pull[1 - k] != 0 || along == 0) return false;
    const double way = copysign(1, along), twist[3] = {k == 0 ? way : 0, k == 1 ? way : 0, 0};
    imp_face_balance balance = {.p = {0}};
    if (!imp_face_balance_of(m, twist, &balance) || !(imp_face_spare(&m->face, balance.center) > IMP_FACE_MARGIN))
        return false;
    double center[2];
    imp_face_center_velocity(m, y, center);
    *s = (imp_lying_steady){.roll = imp_face_roll_rate(m, &m->load, balance.force)};
    s->a[k] = pull[k] + m->load.press * balance.force[k];
    const double rate = way * (s->a[k] + (k == 1 ? m->height * s->roll : 0));
    if (v[k] == 0 && !(rate > 0)) return false;
    s->fades = rate < 0;
    s->until = s->fades ? fabs(v[k]) / -rate : INFINITY;
    for (int i = 0; i < IMP_FLAT_LINE && m->bounded; i++) {
        if (!(imp_face_spare(&m->under, m->face.corner[i]) > 2 * IMP_FACE_MARGIN)) return false;
        const double out = leaves(&m->under, m->face.corner[i], center, s->a);
        if (out < s->until) s->until = out, s->fades = false;
    }
    return true;
}

/* On level ground, where friction makes no force. */
static bool spins_in_place(const imp_face_motion *m, double w, imp_lying_steady *s)
{
    const double twist[3] = {0, 0, w}, none[2] = {0, 0};
    imp_face_balance balance = {.p = {0}};
    if (!imp_face_balance_of(m, twist, &balance) || size_of(balance.force) > IMP_LEVEL * m->friction) return false;
    if (!(imp_face_spare(&m->face, balance.center) > IMP_FACE_MARGIN)) return false;
    if (m->bounded && !(imp_face_spare(&m->under, none) > 1 + IMP_FACE_MARGIN)) return false; /* no corner beyond it */
    s->alpha = m->load.press * m->turning * balance.moment;
    s->a[0] = s->a[1] = 0;
    s->fades = m->friction > 0;
    s->until = s->fades ? w / -s->alpha : INFINITY;
    return true;
}

/* Without friction the centre goes its way, and it turns on. */
static bool glides_freely(const imp_face_motion *m, const double *y, imp_lying_steady *s)
{
    imp_face_balance balance = {.p = {0}};
    if (m->friction > 0 || m->bounded || m->rolling > 0 || !imp_face_balance_of(m, &y[IMP_FACE_V], &balance))
        return false;
    *s = (imp_lying_steady){.a = {m->load.pull[0], m->load.pull[1]}, .until = INFINITY};
    return imp_face_spare(&m->face, balance.center) > IMP_FACE_MARGIN;
}

/* The last of a motion that has all but stopped: along its twist. */
static bool fades_out(const imp_face_motion *m, const double *y, double slow, imp_lying_steady *s)
{
    double rate[IMP_FACE_STATE];
    imp_face_balance balance = {.p = {0}};
    const double speed = imp_face_speed(m, y), *v = &y[IMP_FACE_V], w = y[IMP_FACE_W], k = m->gyration * m->gyration;
    if (!(speed > 0 && speed <= slow) || !imp_face_rates(m, y, rate, &balance)) return false;
    const double falls = -(v[0] * rate[IMP_FACE_V] + v[1] * rate[IMP_FACE_V + 1] + k * w * rate[IMP_FACE_W]);
    if (!(falls > 0)) return false;
    const double until = speed * speed / falls;
    const double ease = imp_face_ease(m), rolls = m->rolling > 0 ? (1 - 1 / ease) / m->height : 0;
    *s = (imp_lying_steady){.a = {-v[0] / until, -v[1] / (ease * until)},
                            .alpha = -w / until,
                            .roll = -rolls * v[1] / until,
                            .until = until,
                            .fades = true};
    return true;
}

bool imp_face_rolls(const imp_face_motion *m, const double *y, const imp_face_balance *balance)
{
    imp_face_load load;
    if (!(m->rolling > 0)) return false;
    if (y[IMP_FACE_ROLL] != 0 || !imp_face_load_at(m, y, &load)) return true;
    return m->height * fabs(imp_face_roll_rate(m, &load, balance->force)) > IMP_LEVEL * load.press;
}

/* Whether the face stands under the load of so much later. */
static bool stands_then(const imp_lying *lying, double later)
{
    double y[IMP_FACE_STATE], a[3];
    imp_face_balance balance;
    memcpy(y, lying->start, sizeof y);
    y[IMP_FACE_TIME] = later;
    return imp_face_begins(&lying->motion, y, a, &balance) == IMP_FACE_STANDS &&
           !imp_face_rolls(&lying->motion, y, &balance);
}

/* Under loads that change: until they are more than the face holds, or are to be looked at again. */
static bool stands_on(const imp_lying *lying, imp_lying_steady *s)
{
    const imp_face_motion *m = &lying->motion;
    const double look = fmin(m->longest, 1 / (IMP_FACE_LOOKS * sqrt(m->load.press)));
    if (!imp_field_unsteady(lying->moves->world) || !stands_then(lying, 0)) return false;
    *s = (imp_lying_steady){.until = IMP_FACE_LOOKS * look, .stands = true};
    for (int k = 1; k <= IMP_FACE_LOOKS; k++) {
        double stands = (k - 1) * look, goes = k * look;
        if (stands_then(lying, goes)) continue;
        for (;;) {
            const double middle = 0.5 * (stands + goes), t0 = lying->t0;
            if (!(t0 + middle > t0 + stands && t0 + middle < t0 + goes)) break;
            *(stands_then(lying, middle) ? &stands : &goes) = middle;
        }
        s->until = goes, s->breaks = true;
        break;
    }
    return true;
}

bool imp_lying_find_steady(const imp_lying *lying, double slow, imp_lying_steady *s)
{
    const imp_face_motion *m = &lying->motion;
    const double *y = lying->start, *v = &y[IMP_FACE_V], w = y[IMP_FACE_W];
    *s = (imp_lying_steady){.until = INFINITY};
    if (m->loads) return imp_face_speed(m, y) > 0 ? fades_out(m, y, slow, s) : stands_on(lying, s);
    if (w == 0 && (m->rolling > 0 ? line_slides_straight(m, y, s) : slides_straight(m, v, s))) return true;
    const bool on_the_spot = size_of(v) == 0 && w != 0 && size_of(m->load.pull) == 0 && y[IMP_FACE_ROLL] == 0;
    if (on_the_spot && spins_in_place(m, w, s)) return true;
    return glides_freely(m, y, s) || fades_out(m, y, slow, s);
}
