/* SPDX-License-Identifier: MIT
 *
 * libquat on any numbers: what a status promises, unit results, ways there and back; nothing traps, loops or reads
 * outside its arrays. What is fed in: q, p any quaternions, u, w unit ones, v, x any vectors, t any number.
 */
#include "fuzz.h"

#include <quat/average.h>
#include <quat/batch.h>
#include <quat/dual.h>
#include <quat/euler.h>
#include <quat/exponential.h>
#include <quat/integrate.h>
#include <quat/interpolate.h>
#include <quat/jacobian.h>
#include <quat/project.h>
#include <quat/rotation.h>
#include <quat/sequence.h>
#include <quat/spline.h>

static struct {
    quat q, p, u, w;
    qvec3 v, x;
    double t;
} in;

enum { MOST = 12 };
static size_t count; /* of the arrays a case takes */
static quat set[MOST];
static qvec3 one[MOST], two[MOST];
static double number[MOST];

void fuzz_show(FILE *out)
{
    fputs("    /* the promise above, with */\n", out);
    show_quat(out, "    const quat q = ", in.q);
    show_quat(out, ", p = ", in.p);
    show_quat(out, ",\n               u = ", in.u);
    show_quat(out, ", w = ", in.w);
    show_vec3(out, ";\n    const qvec3 v = ", in.v);
    show_vec3(out, ", x = ", in.x);
    fputs(";\n    const double t = ", out);
    show_number(out, in.t);
    fputs(";\n", out);
    for (size_t i = 0; i < count; i++) {
        show_quat(out, "    set: ", set[i]);
        show_vec3(out, ", one: ", one[i]);
        show_vec3(out, ", two: ", two[i]);
        show_numbers(out, ", number: ", &number[i], 1);
        fputs("\n", out);
    }
}

static quat take_any(fuzz_bytes *b)
{
    const double w = take_wild(b), x = take_wild(b), y = take_wild(b), z = take_wild(b);
    return (quat){w, x, y, z};
}

static qvec3 take_any3(fuzz_bytes *b)
{
    const double x = take_wild(b), y = take_wild(b), z = take_wild(b);
    return (qvec3){x, y, z};
}

static double apart(quat a, quat b) { return quat_norm(quat_sub(a, b)); }

static void hold_unit(quat r, double bound) { HOLD(fabs(quat_norm(r) - 1) <= bound, quat_norm(r) - 1, bound); }

static void hold_turn(quat r, quat wanted, double bound)
{
    HOLD(quat_rotation_distance(r, wanted) <= bound, quat_rotation_distance(r, wanted), bound);
}

static void units_and_inverses(fuzz_bytes *b)
{
    (void)b;
    quat r;
    const quat q = in.q;
    if (quat_normalize(q, &r) == QUAT_OK)
        hold_unit(r, 4e-16);
    else
        HOLD(!quat_isfinite(q) || quat_norm(q) == 0, quat_norm(q), 0);
    const double size = quat_norm(q);
    if (quat_inverse(q, &r) == QUAT_OK && size > 1e-140 && size < 1e140)
        HOLD(apart(quat_mul(q, r), quat_identity()) < 1e-14, apart(quat_mul(q, r), quat_identity()), 1e-14);
    if (quat_div(in.p, q, &r) == QUAT_OK) HOLD(quat_isfinite(r), r.w, 0);
    if (quat_div_left(q, in.p, &r) == QUAT_OK) HOLD(quat_isfinite(r), r.w, 0);
    const double far = quat_distance(in.u, in.w), turned = quat_rotation_distance(in.u, in.w);
    HOLD(far >= 0 && turned >= 0 && turned <= 3.1415926535897936, far, turned);
    quat_mul_compensated(in.p, q), quat_same_rotation(in.p, q, in.t), quat_near(in.p, q, in.t), quat_angle(q);
}

static void exp_and_log(fuzz_bytes *b)
{
    (void)b;
    quat r, s;
    const quat q = in.q;
    const double n = quat_norm(q);
    if (quat_exp(q, &r) == QUAT_OK) HOLD(quat_isfinite(r), r.w, 0);
    if (quat_log(q, &r) == QUAT_OK) {
        HOLD(quat_isfinite(r), r.w, 0);
        if (quat_exp(r, &s) == QUAT_OK) {
            const double bound = 1e-15 * n * (1 + fabs(r.w)) + 1e-307;
            HOLD(apart(q, s) <= bound, apart(q, s), bound);
        }
    }
    if (quat_sqrt(q, &r) == QUAT_OK && n > 1e-300 && n < 1e300)
        HOLD(apart(q, quat_mul(r, r)) <= 2e-15 * n, apart(q, quat_mul(r, r)) / n, 2e-15);
    if (quat_pow(q, in.t, &r) == QUAT_OK) HOLD(quat_isfinite(r), r.w, 0);
    if (quat_pow_quat(in.p, q, &r) == QUAT_OK) HOLD(quat_isfinite(r), r.w, 0);
    /* the logarithm is up to pi long, to its last bit or two, and turns by twice that */
    hold_turn(quat_exp_pure(quat_log_unit(in.u)), in.u, 2e-15);
    quat_pow_unit(in.u, in.t), quat_log_unit(q);
}

static void euler(fuzz_bytes *b)
{
    static const char letters[] = "xyzXYZab";
    char name[4] = {0};
    quat_euler e;
    quat r;
    double angles[3], back[3];
    for (int i = 0; i < 3; i++) name[i] = letters[take_below(b, 8)], angles[i] = take_wild(b);
    if (quat_euler_from_name(name, &e) != QUAT_OK) e = (quat_euler)take_byte(b);
    if (quat_from_euler(angles, e, &r) == QUAT_OK) hold_unit(r, 1e-14);
    if (quat_to_euler(in.u, e, back) >= 0) {
        HOLD(isfinite(back[0] + back[1] + back[2]), back[0], 0);
        if (quat_from_euler(back, e, &r) == QUAT_OK) hold_turn(r, in.u, 1e-14);
    }
    if (quat_to_euler(in.q, e, back) >= 0) HOLD(isfinite(back[0] + back[1] + back[2]), back[0], 0);
}

static void two_vectors(quat r)
{
    if (quat_from_two_vectors(in.v, in.x, &r) < 0) return;
    hold_unit(r, 1e-14);
    const double n = qvec3_norm(in.v), k = qvec3_norm(in.x);
    if (!(n > 1e-150 && n < 1e150 && k > 1e-150 && k < 1e150)) return;
    const qvec3 off = qvec3_sub(quat_rotate(r, qvec3_scale(in.v, 1 / n)), qvec3_scale(in.x, 1 / k));
    HOLD(qvec3_norm(off) < 4e-15, qvec3_norm(off), 4e-15);
}

static void matrices_and_vectors(fuzz_bytes *b)
{
    const qvec3 rows[3] = {take_any3(b), take_any3(b), take_any3(b)};
    qmat3 m = {
        {{rows[0].x, rows[0].y, rows[0].z}, {rows[1].x, rows[1].y, rows[1].z}, {rows[2].x, rows[2].y, rows[2].z}}};
    quat r, swing, twist;
    qvec3 axis;
    double d;
    if (quat_from_matrix(&m, &r) == QUAT_OK) hold_unit(r, 1e-14);
    if (quat_from_matrix_nearest(&m, &r, &d) >= 0) {
        hold_unit(r, 1e-14);
        HOLD(d >= 0, d, 0);
    }
    m = quat_to_matrix(in.u);
    HOLD(quat_from_matrix(&m, &r) == QUAT_OK, 0, 0);
    hold_turn(r, in.u, 1e-14);
    two_vectors(r);
    if (quat_swing_twist(in.u, in.v, &swing, &twist) >= 0) hold_turn(quat_mul(swing, twist), in.u, 1e-14);
    if (quat_to_axis_angle(in.u, &axis, &d) >= 0 && quat_from_axis_angle(axis, d, &r) == QUAT_OK)
        hold_turn(r, in.u, 1e-14);
    if (quat_from_axis_angle(in.v, in.t, &r) == QUAT_OK) hold_unit(r, 1e-14);
    if (quat_from_axes(in.v, in.x, &r) == QUAT_OK) hold_unit(r, 1e-14);
    if (quat_from_frame(in.v, in.x, rows[0], &r) == QUAT_OK) hold_unit(r, 1e-14);
    quat_from_rotation_vector(in.v), quat_to_rotation_vector(in.q);
}

static void between(fuzz_bytes *b)
{
    const double f = take_unit(b);
    hold_unit(quat_slerp(in.u, in.w, f), 1e-14);
    hold_unit(quat_nlerp(in.u, in.w, f), 1e-14);
    quat_slerp_as_given(in.u, quat_neg(in.u), f), quat_nlerp_as_given(in.u, quat_neg(in.u), f);
    quat_slerp(in.q, in.p, in.t), quat_squad(in.q, in.p, in.u, in.w, in.t), quat_squad_control(in.q, in.p, in.u);
    quat_squad_omega(in.u, in.w, in.u, in.w, f), quat_slerp_omega(in.u, in.w), quat_nlerp_omega(in.u, in.w, f);
    quat_step_magnus4(in.u, in.v, in.x, in.t, QUAT_BODY), quat_step_cf4(in.u, in.v, in.x, in.t, QUAT_WORLD);
    quat_step_magnus8(in.u, (const qvec3[4]){in.v, in.x, in.v, in.x}, in.t, QUAT_BODY);
}

static void spline(fuzz_bytes *b)
{
    const bool wild = take_byte(b) < 30;
    const quat_spline_end end = (quat_spline_end)take_below(b, 4);
    double now = take_signed(b, 3);
    count = take_below(b, MOST + 1);
    for (size_t i = 0; i < count; i++) {
        number[i] = now;
        now += wild ? take_wild(b) : take_positive(b, 6);
        set[i] = wild && take_byte(b) < 40 ? take_any(b) : take_quat(b);
    }
    if (end == QUAT_SPLINE_PERIODIC && count > 0) set[count - 1] = set[0];
    quat_spline *s = NULL;
    const qvec3 first = take_vec3(b, 2), last = take_vec3(b, 2);
    const quat_status made = quat_spline_new(count, number, set, end, first, last, &s);
    HOLD((made == QUAT_OK) == (s != NULL), made, 0);
    if (!s) return;
    for (size_t i = 0; i < count && !wild; i++) hold_turn(quat_spline_at(s, number[i]), set[i], 1e-12);
    qvec3 omega, acceleration;
    const double span = number[count - 1] - number[0];
    const quat r = quat_spline_state(s, number[0] + take_unit(b) * span, &omega, &acceleration);
    if (!wild) hold_unit(r, 1e-13);
    quat_spline_at(s, in.t), quat_spline_length(s, in.t), quat_spline_time_at(s, in.t);
    quat_spline_free(s);
}

static void means(fuzz_bytes *b)
{
    const bool wild = take_byte(b) < 60;
    count = take_below(b, MOST + 1);
    for (size_t i = 0; i < count; i++) {
        set[i] = wild && take_byte(b) < 40 ? take_any(b) : take_quat(b);
        number[i] = wild ? take_wild(b) : take_unit(b);
        one[i] = wild ? take_any3(b) : take_vec3(b, 3);
        two[i] = wild ? take_any3(b) : take_vec3(b, 3);
    }
    const double *by = take_byte(b) & 1 ? number : NULL;
    quat r;
    qvec3 shift;
    double out = 0;
    int turns;
    if (quat_mean(count, set, by, &r) >= 0) hold_unit(r, 1e-13);
    if (quat_mean_karcher(count, set, by, &r, &out) >= 0) hold_unit(r, 1e-13);
    HOLD(!(out < 0), out, 0);
    if (quat_align(count, one, two, by, &r, &out) >= 0) hold_unit(r, 1e-13);
    HOLD(!(out < 0), out, 0);
    if (quat_align_points(count, one, two, by, &r, &shift, &out) >= 0) hold_unit(r, 1e-13);
    quat_unflip(count, set, &turns), quat_loop_sign(count, set);
    quat_normalize_array(count, set, set, NULL), quat_compose_array(count, set);
}

static void projections(fuzz_bytes *b)
{
    const quat_pole pole = (quat_pole)take_below(b, 3);
    const int any = (int)take_byte(b) - 3;
    qvec3 image;
    qvec2 flat;
    quat r;
    double line;
    int half;
    if (quat_stereographic(in.u, pole, &image) == QUAT_OK) {
        r = quat_from_stereographic(image, pole);
        HOLD(quat_distance(in.u, r) < 1e-14, quat_distance(in.u, r), 1e-14);
    }
    if (quat_orthographic(in.u, &image, &half) >= 0 && quat_from_orthographic(image, half, &r) >= 0)
        HOLD(quat_distance(in.u, r) < 1e-7, quat_distance(in.u, r), 1e-7);
    quat_stereographic(in.q, pole, &image), quat_from_stereographic(in.v, pole);
    quat_orthographic(in.q, &image, &half), quat_from_orthographic(in.v, any, &r);
    quat_stereographic_sphere(in.v, pole, &flat), quat_stereographic_circle((qvec2){in.v.x, in.v.y}, pole, &line);
    if (quat_hopf_fibre(in.v, in.t, &r) >= 0 && isfinite(in.t)) HOLD(quat_isfinite(r), r.w, 0);
    quat_hopf_angle(in.q);
}

static void motions(fuzz_bytes *b)
{
    (void)b;
    const qdual d = {in.q, in.p}, e = {in.u, in.w};
    qdual out;
    qvec3 axis, point;
    double angle, slide;
    if (quat_dual_normalize(d, &out) == QUAT_OK) hold_unit(out.real, 1e-14);
    quat_dual_inverse(d, &out), quat_dual_log(d), quat_dual_to_screw(d, &axis, &point, &angle, &slide);
    quat_dual_sclerp(d, e, in.t), quat_dual_from_screw(in.v, in.x, in.t, in.t, &out);
    quat_exp_jacobian(in.v), quat_log_jacobian(in.q), quat_rotate_jacobian(in.q, in.v);
    quat_rotation_vector_jacobian_left(in.x), quat_rotation_vector_jacobian_left_inverse(in.v);
}

static void sequences(fuzz_bytes *b)
{
    double arrows[8];
    quat path[16];
    qvec3 centre[16];
    const double s = take_wild(b);
    quat_spinor_arrows(in.t, take_below(b, 9), arrows), quat_spinor_place(in.t);
    quat_belt_twist(in.t, s), quat_belt_untwist(in.t, s), quat_belt_frames(in.t, take_below(b, 17), path, centre);
    quat_band(in.t, s), quat_roll(in.q, in.t, s), quat_roll_circle(in.t, s), quat_roll_loop(in.t);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static void (*const cases[])(fuzz_bytes *) = {
        units_and_inverses, exp_and_log, euler,    matrices_and_vectors, between, spline, means,
        projections,        motions,     sequences};
    fuzz_bytes b = {data, size};
    const unsigned which = take_below(&b, sizeof cases / sizeof *cases);
    count = 0;
    in.q = take_any(&b), in.p = take_any(&b);
    in.u = take_quat(&b), in.w = take_quat(&b);
    in.v = take_any3(&b), in.x = take_any3(&b);
    in.t = take_wild(&b);
    cases[which](&b);
    return 0;
}
