/* SPDX-License-Identifier: MIT
 *
 * The kernel's sources once more, in the compiler's 128-bit floating point: what double's rounding cannot settle, and
 * what leaves double's range on the way, is solved again with 113 bits and exponents to 4932 before anything else is
 * tried. Names of functions that other files see are changed; all else is the same text.
 */
#define IMP_SECOND
#define imp_ready_make imp_second_ready_make
#define imp_frame_make imp_second_frame_make
#define imp_frame_turn imp_second_frame_turn
#define imp_frame_principal imp_second_frame_principal
#define imp_frame_across imp_second_frame_across
#define imp_frame_normal imp_second_frame_normal
#define imp_course_start imp_second_course_start
#define imp_course_turn_frame imp_second_course_turn_frame
#define imp_course_line imp_second_course_line
#define imp_course_from_rest imp_second_course_from_rest
#define imp_course_sliding imp_second_course_sliding
#define imp_course_straight_line imp_second_course_straight_line
#define imp_course_turning imp_second_course_turning
#define imp_course_is_straight imp_second_course_is_straight
#define imp_course_left_poisson imp_second_course_left_poisson
#define imp_course_target_newton imp_second_course_target_newton
#define imp_course_left_stronge imp_second_course_left_stronge
#define imp_course_reach imp_second_course_reach
#define imp_course_mark imp_second_course_mark
#define imp_course_phase imp_second_course_phase
#define imp_course_turn imp_second_course_turn
#define imp_course_book imp_second_course_book
#define imp_course_slide imp_second_course_slide
#define imp_course_finish imp_second_course_finish
#define imp_course_straight imp_second_course_straight
#define imp_taylor_value imp_second_taylor_value
#define imp_taylor_integral imp_second_taylor_integral
#define imp_taylor_make imp_second_taylor_make
#define imp_tail_make imp_second_tail_make
#define imp_series_solve imp_second_series_solve
#define imp_swerve_over imp_second_swerve_over
#define imp_swerve_from_rest imp_second_swerve_from_rest
#define imp_swerve_to_rest imp_second_swerve_to_rest
#define imp_variation_make imp_second_variation_make
#define imp_columns_sensitivity imp_second_columns_sensitivity
#define imp_report_push imp_second_report_push
#define imp_report_course imp_second_report_course

#include "collide/collide_second.h"

#include "collide/collide_columns.h"
#include "collide/collide_real.h"

#if IMP_HAS_SECOND

/* Pairs of these numbers are no vectors of the machine: how they would be passed is no matter between functions in
 * line.
 */
#pragma GCC diagnostic ignored "-Wpsabi"

#include "collide/collide_columns.c"
#include "collide/collide_course.c"
#include "collide/collide_frame.c"
#include "collide/collide_ready.c"
#include "collide/collide_report.c"
#include "collide/collide_series.c"
#include "collide/collide_swerve.c"
#include "collide/collide_tail.c"
#include "collide/collide_variation.c"

/* A sliding velocity that is rounding of those given is none. */
static imp_real sliding(const imp_ready *ready, imp_vec t)
{
    const imp_lanes each =
        imp_vectors_size(&ready->velocity) + imp_vectors_size(&ready->omega) * imp_vectors_size(&ready->arm);
    const imp_real s = imp_sqrt(imp_vec_dot(t, t));
    return s > 2 * IMP_EPSILON * (each[0] + each[1]) ? s : 0;
}

impact_status imp_second_collide(const impact_collision *collision, impact_outcome *outcome)
{
    imp_ready ready;
    imp_ready_make(collision, &ready);
    const imp_vec n = imp_frame_normal(collision), u = imp_ready_velocity(&ready);
    const imp_real approach = imp_vec_dot(u, n);
    if (!(approach < 0)) return IMPACT_SEPARATING;
    const imp_vec t = imp_vec_axpy(-approach, n, u);
    const imp_real s = sliding(&ready, t);
    imp_frame frame;
    imp_frame_make(n, s > 0 ? imp_vec_cross(imp_vec_scale(t, 1 / s), n) : imp_frame_across(n), &ready, &frame);
    imp_course course;
    imp_course_start(&course, &frame, collision, 0, -s / approach);
    if (!imp_course_straight(&course)) {
        imp_course_turn_frame(&course, &ready, &frame);
        if (!imp_series_solve(&course, IMP_SERIES_ORDER)) return IMPACT_EUNSETTLED;
    }
    if (!course.ended) return IMPACT_EUNSETTLED;
    imp_course_mark(&course);
    outcome->solver = IMPACT_SOLVER_SERIES;
    imp_report_course(collision, &ready, &course, -approach, outcome);
    return IMPACT_OK;
}

#else

impact_status imp_second_collide(const impact_collision *collision, impact_outcome *outcome)
{
    (void)collision, (void)outcome;
    return IMPACT_EABSENT;
}

double imp_second_columns_sensitivity(const impact_collision *collision, const impact_outcome *outcome)
{
    (void)collision, (void)outcome;
    return NAN;
}

#endif
