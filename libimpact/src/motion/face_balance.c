/* SPDX-License-Identifier: MIT
 *
 * The balance of a face that is pressed and rubs, and the rates of its motion from it.
 */
#include "motion/face_motion.h"
#include "base/tolerances.h"

#include <math.h>
#include <quat/quat.h>
#include <string.h>

void imp_face_prepare(imp_face_motion *motion)
{
    imp_press_all(&motion->face, &motion->whole);
    imp_press_moments(&motion->whole, motion->moments);
}

/* ---- the balance ---- */

static bool solve_three(double a[3][4])
{
    for (int k = 0; k < 3; k++) {
        int best = k;
        for (int i = k + 1; i < 3; i++)
            if (fabs(a[i][k]) > fabs(a[best][k])) best = i;
        if (!(fabs(a[best][k]) > 0)) return false;
        for (int j = 0; j < 4; j++) {
            const double swap = a[k][j];
            a[k][j] = a[best][j], a[best][j] = swap;
        }
        for (int i = 0; i < 3; i++)
            for (int j = 3; i != k && j >= k; j--) a[i][j] -= a[i][k] / a[k][k] * a[k][j];
    }
    for (int k = 0; k < 3; k++) a[k][3] /= a[k][k];
    return isfinite(a[0][3] + a[1][3] + a[2][3]);
}

static double along_row(const double row[3], const double p[3])
{
    return row[0] * p[0] + row[1] * p[1] + row[2] * p[2];
}

void imp_face_turn(const double v[2], double angle, double out[2])
{
    const double c = cos(angle), s = sin(angle), x = v[0], y = v[1];
    out[0] = c * x - s * y, out[1] = s * x + c * y;
}

/* Of a line, which lies along x: across it nothing presses. */
static void leave_across(const imp_face_motion *motion, double row[4])
{
    if (motion->face.count != IMP_FLAT_LINE) return;
    row[0] = row[1] = row[3] = 0, row[2] = 1;
}

/* The pressure that balances where just this part is pressed; the load in the face's axes. */
static bool press(const imp_face_motion *motion, const imp_face_load *load, const imp_pressed *pressed,
                  const imp_face_twist *twist, imp_face_balance *balance)
{
    double part[3][3], rub[3][3], a[3][4];
    const bool whole = pressed == &motion->whole;
    const double(*m)[3] = whole ? motion->moments : (const double(*)[3])part;
    if (pressed->count == 0) return false;
    if (!whole) imp_press_moments(pressed, part);
    imp_press_rub(pressed, twist->way, rub);
    const double mu = motion->friction, *j = motion->aside, across[2] = {-j[1], j[0]};
    for (int k = 0; k < 3; k++) {
        a[0][k] = m[0][k];
        for (int i = 0; i < 2; i++)
            a[1 + i][k] = m[1 + i][k] + motion->height * mu * rub[i][k] - across[i] * motion->turning * mu * rub[2][k];
    }
    a[0][3] = 1;
    for (int i = 0; i < 2; i++)
        a[1 + i][3] = (across[i] * load->turn - twist->square * j[i] - load->tip[i]) / load->press;
    a[1][3] -= motion->rolling * twist->rolled / load->press;
    leave_across(motion, a[2]);
    if (!solve_three(a)) return false;
    for (int k = 0; k < 3; k++) balance->p[k] = a[k][3];
    for (int i = 0; i < 2; i++) {
        balance->force[i] = mu * along_row(rub[i], balance->p);
        balance->center[i] = along_row(m[1 + i], balance->p);
    }
    balance->moment = mu * along_row(rub[2], balance->p);
    return true;
}

/* The same of a face that stands: friction is what balances the load. */
static bool press_standing(const imp_face_motion *motion, const imp_face_load *load, const imp_pressed *pressed,
                           imp_face_balance *balance)
{
    double m[3][3], a[3][4];
    if (pressed->count == 0) return false;
    imp_press_moments(pressed, m);
    for (int i = 0; i < 2; i++) {
        balance->force[i] = -load->pull[i] / load->press;
        balance->center[i] = -motion->height * balance->force[i] - load->tip[i] / load->press;
    }
    if (motion->rolling > 0) {
        const double eased = imp_face_ease(motion) * load->press;
        balance->force[1] = -(load->pull[1] + motion->height * load->tip[1] / motion->rolling) / eased;
        balance->center[1] = 0;
    }
    balance->moment = -load->turn / (motion->turning * load->press);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) a[i][k] = m[i][k];
        a[i][3] = i == 0 ? 1 : balance->center[i - 1];
    }
    leave_across(motion, a[2]);
    if (!solve_three(a)) return false;
    for (int k = 0; k < 3; k++) balance->p[k] = a[k][3];
    return true;
}

bool imp_face_balance_under(const imp_face_motion *motion, const imp_face_load *load, const imp_face_twist *twist,
                            imp_face_balance *balance)
{
    imp_pressed part;
    double change = INFINITY;
    for (int i = 0; i < IMP_FACE_PRESSINGS; i++) {
        double before[3], moved = 0, size = 0;
        memcpy(before, balance->p, sizeof before);
        const bool whole = imp_least_pressure(&motion->face, before) >= 0;
        if (!whole) imp_press_part(&motion->face, before, &part);
        const imp_pressed *pressed = whole ? &motion->whole : &part;
        if (!(twist ? press(motion, load, pressed, twist, balance) : press_standing(motion, load, pressed, balance)))
            return false;
        if (whole && imp_least_pressure(&motion->face, balance->p) >= 0) return true;
        for (int k = 0; k < 3; k++) {
            moved = fmax(moved, fabs(balance->p[k] - before[k]));
            size = fmax(size, fabs(balance->p[k]));
        }
        if (moved <= IMP_FACE_NEXT * size || (moved >= change && moved <= IMP_FACE_PRESSED * size)) return true;
        change = moved;
    }
    return false;
}

/* Of the twist (v, w) as it is. */
static imp_face_twist moving(const double twist[3], double roll)
{
    return (imp_face_twist){{twist[0], twist[1], twist[2]}, twist[2] * twist[2], roll * twist[2]};
}

bool imp_face_balance_of(const imp_face_motion *motion, const double twist[3], imp_face_balance *balance)
{
    const imp_face_twist moves = moving(twist, 0);
    return imp_face_balance_under(motion, &motion->load, &moves, balance);
}

bool imp_face_load_at(const imp_face_motion *motion, const double *y, imp_face_load *load)
{
    *load = motion->load;
    if (motion->loads && (!motion->loads(motion->context, y, load) || !(load->press > 0))) return false;
    imp_face_turn(load->tip, -y[IMP_FACE_ANGLE], load->tip);
    return true;
}

/* ---- rates ---- */

double imp_face_speed(const imp_face_motion *motion, const double *y)
{
    return qvec3_norm((qvec3){y[IMP_FACE_V], y[IMP_FACE_V + 1], motion->gyration * y[IMP_FACE_W]});
}

double imp_face_roll_rate(const imp_face_motion *motion, const imp_face_load *load, const double force[2])
{
    if (!(motion->rolling > 0)) return 0;
    return (motion->height * load->press * force[1] + load->tip[1]) / motion->rolling;
}

double imp_face_ease(const imp_face_motion *motion)
{
    return motion->rolling > 0 ? 1 + motion->height * motion->height / motion->rolling : 1;
}

double imp_face_difference(const imp_face_motion *motion)
{
    return motion->rolling > 0 ? IMP_LINE_DIFFERENCE : IMP_FACE_DIFFERENCE;
}

void imp_face_over_center(const imp_face_motion *motion, const double *y, double roll, double out[2])
{
    const double across[2] = {0, motion->height * roll};
    imp_face_turn(across, y[IMP_FACE_ANGLE], out);
}

void imp_face_center_velocity(const imp_face_motion *motion, const double *y, double v[2])
{
    double over[2] = {0, 0};
    if (motion->rolling > 0) imp_face_over_center(motion, y, y[IMP_FACE_ROLL], over);
    for (int i = 0; i < 2; i++) v[i] = y[IMP_FACE_V + i] - over[i];
}

/* What rolling adds to the rates of a line's points. */
static void add_rolling(const imp_face_motion *motion, const double *y, const imp_face_load *load,
                        const imp_face_balance *balance, double *rate)
{
    const double c = motion->height, faster = imp_face_roll_rate(motion, load, balance->force);
    const double own[2] = {-c * y[IMP_FACE_ROLL] * y[IMP_FACE_W], c * faster};
    double more[2];
    imp_face_turn(own, y[IMP_FACE_ANGLE], more);
    imp_face_center_velocity(motion, y, &rate[IMP_FACE_X]);
    for (int i = 0; i < 2; i++) rate[IMP_FACE_V + i] += more[i];
    rate[IMP_FACE_ROLLED] = y[IMP_FACE_ROLL];
    rate[IMP_FACE_ROLL] = faster;
}

bool imp_face_rates(const imp_face_motion *motion, const double *y, double *rate, imp_face_balance *balance)
{
    double twist[3] = {0, 0, y[IMP_FACE_W]}, force[2];
    imp_face_load load;
    if (!imp_face_load_at(motion, y, &load)) return false;
    imp_face_turn(&y[IMP_FACE_V], -y[IMP_FACE_ANGLE], twist);
    const imp_face_twist moves = moving(twist, y[IMP_FACE_ROLL]);
    if (!imp_face_balance_under(motion, &load, &moves, balance)) return false;
    imp_face_turn(balance->force, y[IMP_FACE_ANGLE], force);
    const double P = load.press;
    for (int i = 0; i < 2; i++) {
        rate[IMP_FACE_X + i] = y[IMP_FACE_V + i];
        rate[IMP_FACE_V + i] = P * force[i] + load.pull[i];
    }
    rate[IMP_FACE_ANGLE] = y[IMP_FACE_W];
    rate[IMP_FACE_W] = P * motion->turning * balance->moment + load.turn;
    rate[IMP_FACE_TIME] = 1;
    rate[IMP_FACE_PUSHED] = load.power;
    rate[IMP_FACE_DAMPED] = load.damping;
    rate[IMP_FACE_ROLLED] = rate[IMP_FACE_ROLL] = 0;
    if (motion->rolling > 0) add_rolling(motion, y, &load, balance, rate);
    rate[IMP_FACE_WORK] =
        -P * (balance->force[0] * twist[0] + balance->force[1] * twist[1] + balance->moment * twist[2]);
    return true;
}

double imp_face_margin(const imp_face_motion *motion, const double *y, const imp_face_balance *balance)
{
    const double end = motion->rolling > 0 ? IMP_LINE_MARGIN : 0;
    double least = imp_face_spare(&motion->face, balance->center) - end;
    if (!motion->bounded) return least;
    const imp_flat_face *face = &motion->face;
    for (int i = 0; i < (face->count > 0 ? face->count : 1); i++) {
        double x[2];
        imp_face_turn(face->count > 0 ? face->corner[i] : face->center, y[IMP_FACE_ANGLE], x);
        for (int k = 0; k < 2; k++) x[k] += y[IMP_FACE_X + k];
        least = fmin(least, imp_face_spare(&motion->under, x) - face->radius);
    }
    return least;
}
