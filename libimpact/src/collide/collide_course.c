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

#include <float.h>

void imp_course_start(imp_course *course, const imp_frame *frame, const impact_collision *collision, double ux,
                      double uy)
{
    const double s2 = ux * ux + uy * uy;
    course->frame = frame;
    course->mu = collision->friction;
    course->eps = collision->restitution;
    course->law = collision->law;
    course->ux = ux;
    course->uy = uy;
    course->s = s2 < DBL_MAX ? sqrt(s2) : hypot(ux, uy);
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

void imp_course_phase(imp_course *course, impact_phase phase)
{
    const int n = course->phase_count;
    if (n > 0 && course->phases[n - 1] == phase) return;
    if (n < IMPACT_MAX_PHASES) course->phases[course->phase_count++] = (unsigned char)phase;
}

void imp_course_turn(imp_course *course)
{
    course->uz = 0;
    course->compressing = !course->compressing;
    if (course->compressing) course->compressions++;
}

void imp_course_book(imp_course *course, double dp, double work, double friction)
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

void imp_course_reach(imp_course *course, double uz)
{
    if (course->compressing && uz < course->uz) course->jammed = true;
    course->uz = uz;
}

double imp_course_left_poisson(const imp_course *course) { return course->eps * course->p_c - course->p_r; }
double imp_course_target_newton(const imp_course *course) { return course->eps; }
double imp_course_left_stronge(const imp_course *course)
{
    return -course->eps * course->eps * course->work_low - course->above;
}

/* p left in restitution when uz changes by Z per unit of p; INFINITY when this line never ends the impact. */
static double left_on_line(const imp_course *course, double Z)
{
    switch (course->law) {
    case IMPACT_POISSON: return imp_larger(imp_course_left_poisson(course), 0);
    case IMPACT_NEWTON: {
        const double more = imp_course_target_newton(course) - course->uz;
        if (more <= 0) return 0;
        return Z > 0 ? more / Z : INFINITY;
    }
    case IMPACT_STRONGE: {
        const double more = imp_course_left_stronge(course);
        if (more <= 0) return 0;
        const double root = course->uz * course->uz + 2 * Z * more;
        return root >= 0 ? 2 * more / (course->uz + sqrt(root)) : INFINITY;
    }
    }
    return 0;
}

static void line_piece(imp_course *course, const imp_line *line, double dp)
{
    if (!(dp > 0 && dp < INFINITY)) return;
    const bool c = course->compressing;
    imp_course_phase(course, line->stick ? (c ? IMPACT_STICK_C : IMPACT_STICK_R) : (c ? IMPACT_SLIP_C : IMPACT_SLIP_R));
    const double ds = line->R * dp, dz = line->Z * dp;
    imp_course_book(course, dp, dp * (course->uz + 0.5 * dz),
                    line->stick ? 0 : -course->mu * dp * (course->s + 0.5 * ds));
    course->px += line->gx * dp;
    course->py += line->gy * dp;
    course->s = imp_larger(course->s + ds, 0);
    imp_course_reach(course, course->uz + dz);
}

void imp_course_line(imp_course *course, const imp_line *line, double room)
{
    const double Z = line->Z;
    while (!course->ended) {
        if (course->compressing) {
            const double left = Z > 0 ? -course->uz / Z : INFINITY;
            if (left >= room) {
                line_piece(course, line, room);
                return;
            }
            line_piece(course, line, left);
            imp_course_turn(course);
            room -= left;
            continue;
        }
        const double end = left_on_line(course, Z), turn = Z < 0 ? -course->uz / Z : INFINITY;
        if (room < end && room <= turn) {
            line_piece(course, line, room);
            return;
        }
        if (end <= turn) {
            line_piece(course, line, end);
            if (course->law == IMPACT_NEWTON) course->uz = imp_course_target_newton(course);
            course->ended = true;
        } else {
            line_piece(course, line, turn);
            imp_course_turn(course);
        }
        room -= end <= turn ? end : turn;
    }
}

imp_line imp_course_sliding(const imp_frame *frame, double mu, double x, double y)
{
    const double along = frame->c * x + frame->d * y;
    return (imp_line){.R = along - mu * (frame->a * x * x + 2 * frame->e * x * y + frame->b * y * y),
                      .Z = 1 - mu * along,
                      .gx = -mu * x,
                      .gy = -mu * y};
}

double imp_course_turning(const imp_frame *frame, double mu, double x, double y)
{
    return (frame->d * x - frame->c * y) + mu * ((frame->a - frame->b) * x * y - frame->e * (x * x - y * y));
}

bool imp_course_is_straight(const imp_frame *frame, double mu, double x, double y)
{
    const double rate = fabs(frame->c) + fabs(frame->d) + mu * imp_larger(frame->a, frame->b);
    return fabs(imp_course_turning(frame, mu, x, y)) <= 2e-15 * rate;
}

/* The root lambda > 0 of |v| = 1, v = (mu M_tt + lambda)^-1 M_tz: Newton on 1/|v| - 1, convex and rising, from the left
 * (More & Sorensen 1983); there lie 0 and, by Jensen's inequality, |M_tz| less mu M_tt along M_tz. The determinant and
 * v'(mu M_tt + lambda)^-1 v are sums of what is positive. */
static double restart_speed(const imp_frame *frame, double mu, double *x, double *y)
{
    const double a = frame->a, b = frame->b, c = frame->c, d = frame->d, e = frame->e, g2 = c * c + d * d;
    const double pull = mu * a * frame->schur, trace = mu * (a + b), q = mu * e;
    double lambda = imp_larger(sqrt(g2) - mu * (a * c * c + 2 * e * c * d + b * d * d) / g2, 0);
    for (int i = 0; i < 60; i++) {
        const double p = mu * a + lambda, inverse = 1 / (mu * pull + lambda * (trace + lambda));
        *x = (lambda * c - pull * frame->alpha) * inverse;
        *y = (lambda * d - pull * frame->beta) * inverse;
        const double n2 = *x * *x + *y * *y, n = sqrt(n2), over = p * *y - q * *x;
        const double step = (n - 1) * n2 * p / (*x * *x + over * over * inverse);
        lambda += step;
        if (fabs(step) > 1e-8 * lambda) continue;
        /* Newton's last step squares the error; to first order v follows it. */
        const double dy = over * inverse, dx = (*x - q * dy) / p;
        *x -= step * dx;
        *y -= step * dy;
        break;
    }
    const double f = 1 / sqrt(*x * *x + *y * *y);
    *x *= f;
    *y *= f;
    return imp_larger(lambda, 0);
}

imp_line imp_course_from_rest(const imp_frame *frame, double mu)
{
    const double alpha = frame->alpha, beta = frame->beta;
    if (alpha * alpha + beta * beta <= mu * mu)
        return (imp_line){.Z = frame->k, .gx = alpha, .gy = beta, .stick = true};
    double x = 0, y = 0;
    if (mu == 0) {
        /* No friction: the tangential motion does not matter; R = |M_tz|. */
        const double speed = hypot(frame->c, frame->d);
        return (imp_line){.R = speed, .Z = 1};
    }
    const double lambda = restart_speed(frame, mu, &x, &y);
    /* Z = xi' M xi + mu R as a sum of what is positive: no cancellation, and Z > 0 is plain. */
    const double ey = beta + mu * y, ex = alpha + mu * x + frame->e / frame->a * ey;
    const double Z = frame->k + frame->a * ex * ex + frame->schur * ey * ey + mu * lambda;
    return (imp_line){.R = lambda, .Z = Z, .gx = -mu * x, .gy = -mu * y};
}

void imp_course_finish(imp_course *course)
{
    course->s = course->ux = course->uy = 0;
    const imp_line line = imp_course_from_rest(course->frame, course->mu);
    if (!line.stick && course->phase_count > 0 && !course->ended) imp_course_phase(course, IMPACT_REVERSAL);
    imp_course_line(course, &line, INFINITY);
}

bool imp_course_straight(imp_course *course)
{
    const imp_frame *frame = course->frame;
    if (course->mu == 0) {
        const imp_line line = {.Z = 1};
        imp_course_line(course, &line, INFINITY);
        return true;
    }
    if (course->s == 0) {
        imp_course_finish(course);
        return true;
    }
    const double x = course->ux / course->s, y = course->uy / course->s;
    if (!imp_course_is_straight(frame, course->mu, x, y)) return false;
    const imp_line line = imp_course_sliding(frame, course->mu, x, y);
    imp_course_line(course, &line, line.R < 0 ? course->s / -line.R : INFINITY);
    if (!course->ended) imp_course_finish(course);
    return true;
}
