/* SPDX-License-Identifier: MIT
 *
 * Laws of restitution and the straight pieces of an impact.
 *
 * Poisson: restitution impulse = eps (compression impulse), both summed over repeated compressions.
 * Newton: the first uz = -eps uz(0) in restitution.
 * Stronge: with W the normal work, W_c = min W is the work of loading (what is reloaded elastically does not lower the
 * minimum), and the impact ends in restitution once W - W_c = eps^2 |W_c| (Stronge, Impact Mechanics, 2000,
 * section 3.5).
 */
#include "collide/collide_course.h"

#include "base/tolerances.h"

void imp_course_start(imp_course *course, const imp_frame *frame, const impact_collision *collision, imp_real ux,
                      imp_real uy)
{
    const imp_real s2 = ux * ux + uy * uy;
    course->frame = frame;
    course->mu = collision->friction;
    course->eps = collision->restitution;
    course->law = collision->law;
    course->ux = course->from_x = ux;
    course->uy = course->from_y = uy;
    course->s = imp_is_finite(s2) ? imp_sqrt(s2) : imp_hypot(ux, uy);
    course->uz = -1;
    course->px = course->py = course->p = 0;
    course->work_low = course->above = 0;
    course->work_c = course->work_r = course->work_f = 0;
    course->p_c = course->p_r = 0;
    course->compressing = true;
    course->ended = course->jammed = false;
    course->compressions = 1;
    course->phase_count = 0;
}

void imp_course_turn_frame(imp_course *course, const imp_ready *ready, imp_frame *frame)
{
    const imp_vec e = frame->t2;
    imp_frame_turn(ready, frame);
    course->ux = course->from_x = course->s * imp_vec_dot(e, frame->t1);
    course->uy = course->from_y = course->s * imp_vec_dot(e, frame->t2);
}

void imp_course_mark(imp_course *course)
{
    imp_real *at = course->reached[course->phase_count - 1];
    at[0] = course->px;
    at[1] = course->py;
    at[2] = course->p;
}

void imp_course_phase(imp_course *course, impact_phase phase)
{
    const int n = course->phase_count;
    if (n > 0 && course->phases[n - 1] == phase) return;
    if (n == IMPACT_MAX_PHASES) return;
    if (n > 0) imp_course_mark(course);
    course->phases[course->phase_count++] = (unsigned char)phase;
}

void imp_course_turn(imp_course *course)
{
    course->uz = 0;
    course->compressing = !course->compressing;
    if (course->compressing) course->compressions++;
}

void imp_course_book(imp_course *course, imp_real dp, imp_real work, imp_real friction)
{
    course->p += dp;
    /* Kept apart from the work of loading, so that a small eps does not cancel. */
    course->above += work;
    if (course->above < 0) {
        course->work_low += course->above;
        course->above = 0;
    }
    course->work_f += friction;
    if (course->compressing) {
        course->p_c += dp;
        course->work_c += work;
    } else {
        course->p_r += dp;
        course->work_r += work;
    }
}

void imp_course_reach(imp_course *course, imp_real uz)
{
    if (course->compressing && uz < course->uz) course->jammed = true;
    course->uz = uz;
}

imp_real imp_course_left_poisson(const imp_course *course) { return course->eps * course->p_c - course->p_r; }
imp_real imp_course_target_newton(const imp_course *course) { return course->eps; }
imp_real imp_course_left_stronge(const imp_course *course)
{
    return -course->eps * course->eps * course->work_low - course->above;
}

/* p left in restitution when uz changes by Z per unit of p; INFINITY when this line never ends the impact. */
static imp_real left_on_line(const imp_course *course, imp_real Z)
{
    switch (course->law) {
    case IMPACT_POISSON: return imp_larger(imp_course_left_poisson(course), 0);
    case IMPACT_NEWTON: {
        const imp_real more = imp_course_target_newton(course) - course->uz;
        if (more <= 0) return 0;
        return Z > 0 ? more / Z : INFINITY;
    }
    case IMPACT_STRONGE: {
        const imp_real more = imp_course_left_stronge(course);
        if (more <= 0) return 0;
        const imp_real root = course->uz * course->uz + 2 * Z * more;
        return root >= 0 ? 2 * more / (course->uz + imp_sqrt(root)) : INFINITY;
    }
    }
    return 0;
}

static void line_piece(imp_course *course, const imp_line *line, imp_real dp)
{
    if (!(dp > 0 && dp < INFINITY)) return;
    const bool c = course->compressing;
    imp_course_phase(course, line->stick ? (c ? IMPACT_STICK_C : IMPACT_STICK_R) : (c ? IMPACT_SLIP_C : IMPACT_SLIP_R));
    const imp_real ds = line->R * dp, dz = line->Z * dp;
    imp_course_book(course, dp, dp * (course->uz + 0.5 * dz),
                    line->stick ? 0 : -course->mu * dp * (course->s + 0.5 * ds));
    course->px += line->gx * dp;
    course->py += line->gy * dp;
    course->s = imp_larger(course->s + ds, 0);
    course->ux = course->s * line->x;
    course->uy = course->s * line->y;
    imp_course_reach(course, course->uz + dz);
}

/* A line has two turns at most; what is not ended by the last pass never ends (uz and Z beyond the range of numbers).
 */
void imp_course_line(imp_course *course, const imp_line *line, imp_real room)
{
    const imp_real Z = line->Z;
    for (int turns = 0; turns < 2 * IMPACT_MAX_PHASES && !course->ended; turns++) {
        if (course->compressing) {
            const imp_real left = Z > 0 ? -course->uz / Z : INFINITY;
            if (left >= room) {
                line_piece(course, line, room);
                return;
            }
            line_piece(course, line, left);
            imp_course_turn(course);
            room -= left;
            continue;
        }
        const imp_real end = left_on_line(course, Z), turn = Z < 0 ? -course->uz / Z : INFINITY;
        if (room < end && room <= turn) {
            line_piece(course, line, room);
            return;
        }
        if (end <= turn) {
            line_piece(course, line, end);
            if (course->law == IMPACT_NEWTON) course->uz = imp_course_target_newton(course);
            course->ended = end < INFINITY;
            return;
        }
        line_piece(course, line, turn);
        imp_course_turn(course);
        room -= turn;
    }
}

imp_line imp_course_sliding(const imp_frame *frame, imp_real mu, imp_real x, imp_real y)
{
    const imp_real along = frame->c * x + frame->d * y;
    return (imp_line){.R = along - mu * (frame->a * x * x + 2 * frame->e * x * y + frame->b * y * y),
                      .Z = 1 - mu * along,
                      .gx = -mu * x,
                      .gy = -mu * y};
}

/* With T = M_tn - mu M_te = 0, t across e, and S the Schur complement of M_tt in (e, n): R = S_en - mu S_ee and
 * Z = S_nn - mu S_en, where S_ee = det / M_tt, S_en = -S_ee g and S_nn = k + S_ee g^2, g = (alpha, beta) . e. */
imp_line imp_course_straight_line(const imp_frame *frame, imp_real mu, imp_real x, imp_real y)
{
    const imp_real across = frame->a * y * y - 2 * frame->e * x * y + frame->b * x * x;
    const imp_real S = frame->a * frame->schur / across, g = frame->alpha * x + frame->beta * y;
    return (imp_line){
        .R = -S * (mu + g), .Z = frame->k + S * g * (mu + g), .gx = -mu * x, .gy = -mu * y, .x = x, .y = y};
}

imp_real imp_course_turning(const imp_frame *frame, imp_real mu, imp_real x, imp_real y)
{
    return (frame->d * x - frame->c * y) + mu * ((frame->a - frame->b) * x * y - frame->e * (x * x - y * y));
}

bool imp_course_is_straight(const imp_frame *frame, imp_real mu, imp_real x, imp_real y)
{
    const imp_real rate = imp_abs(frame->c) + imp_abs(frame->d) + mu * imp_larger(frame->a, frame->b);
    return imp_abs(imp_course_turning(frame, mu, x, y)) <=
           imp_larger(IMP_COLLIDE_STRAIGHT * IMP_EPSILON * rate, IMP_COLLIDE_LEAST_TURNING);
}

/* The root lambda > 0 of |v| = 1, v = (mu M_tt + lambda)^-1 M_tz: Newton on 1/|v| - 1, convex and rising, from the left
 * (More & Sorensen 1983); there lie 0 and, by Jensen's inequality, |M_tz| less mu M_tt along M_tz. The determinant and
 * v'(mu M_tt + lambda)^-1 v are sums of what is positive. All in units of |M_tz|, so that nothing underflows. */
static imp_real restart_speed(const imp_frame *frame, imp_real mu, imp_real *x, imp_real *y)
{
    const imp_real unit = imp_hypot(frame->c, frame->d), c = frame->c / unit, d = frame->d / unit, rub = mu / unit;
    const imp_real a = frame->a, b = frame->b, e = frame->e, alpha = frame->alpha / unit, beta = frame->beta / unit;
    const imp_real pull = rub * a * frame->schur, trace = rub * (a + b), q = rub * e;
    imp_real lambda = imp_larger(1 - rub * (a * c * c + 2 * e * c * d + b * d * d), 0);
    for (int i = 0; i < 80; i++) {
        const imp_real p = rub * a + lambda, inverse = 1 / (rub * pull + lambda * (trace + lambda));
        *x = (lambda * c - pull * alpha) * inverse;
        *y = (lambda * d - pull * beta) * inverse;
        const imp_real n2 = *x * *x + *y * *y, n = imp_sqrt(n2), over = p * *y - q * *x;
        const imp_real step = (n - 1) * n2 * p / (*x * *x + over * over * inverse);
        lambda += step;
        if (imp_abs(step) > IMP_ROOT_EPSILON * lambda) continue;
        /* Newton's last step squares the error; to first order v follows it. */
        const imp_real dy = over * inverse, dx = (*x - q * dy) / p;
        *x -= step * dx;
        *y -= step * dy;
        break;
    }
    const imp_real f = 1 / imp_sqrt(*x * *x + *y * *y);
    *x *= f;
    *y *= f;
    return imp_larger(lambda * unit, 0);
}

imp_line imp_course_from_rest(const imp_frame *frame, imp_real mu)
{
    const imp_real alpha = frame->alpha, beta = frame->beta;
    if (alpha * alpha + beta * beta <= mu * mu)
        return (imp_line){.Z = frame->k, .gx = alpha, .gy = beta, .stick = true};
    imp_real x = 0, y = 0;
    if (mu == 0) {
        /* No friction: the tangential motion does not matter; R = |M_tz|. */
        const imp_real speed = imp_hypot(frame->c, frame->d);
        return (imp_line){.R = speed, .Z = 1, .x = frame->c / speed, .y = frame->d / speed};
    }
    const imp_real lambda = restart_speed(frame, mu, &x, &y);
    /* Z = xi' M xi + mu R as a sum of what is positive: no cancellation, and Z > 0 is plain. */
    const imp_real ey = beta + mu * y, ex = alpha + mu * x + frame->e / frame->a * ey;
    const imp_real Z = frame->k + frame->a * ex * ex + frame->schur * ey * ey + mu * lambda;
    return (imp_line){.R = lambda, .Z = Z, .gx = -mu * x, .gy = -mu * y, .x = x, .y = y};
}

void imp_course_finish(imp_course *course)
{
    course->s = course->ux = course->uy = 0;
    const imp_line line = imp_course_from_rest(course->frame, course->mu);
    if (!line.stick && course->phase_count > 0 && !course->ended) imp_course_phase(course, IMPACT_REVERSAL);
    imp_course_line(course, &line, INFINITY);
}

void imp_course_slide(imp_course *course, imp_real x, imp_real y)
{
    const imp_line line = imp_course_straight_line(course->frame, course->mu, x, y);
    imp_course_line(course, &line, line.R < 0 ? course->s / -line.R : INFINITY);
    if (!course->ended) course->s = course->ux = course->uy = 0;
}

bool imp_course_straight(imp_course *course)
{
    const imp_frame *frame = course->frame;
    if (course->mu == 0) {
        const imp_line line = {.Z = 1};
        const imp_real ux = course->ux, uy = course->uy;
        imp_course_line(course, &line, INFINITY);
        course->ux = ux + frame->c * course->p;
        course->uy = uy + frame->d * course->p;
        return true;
    }
    if (course->s == 0) {
        imp_course_finish(course);
        return true;
    }
    const imp_real x = course->ux / course->s, y = course->uy / course->s;
    if (!imp_course_is_straight(frame, course->mu, x, y)) return false;
    imp_course_slide(course, x, y);
    if (!course->ended) imp_course_finish(course);
    return true;
}
