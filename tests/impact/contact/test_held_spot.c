/* SPDX-License-Identifier: MIT
 *
 * Contacts that run over flat and sharp places of a surface: the coordinates that carry them, revolutions whose period
 * is a quadrature, and the integrals of free rolling and gliding.
 */
#include <float.h>
#include "contact/held_spot.h"
#include "kit/held_bodies.h"

static impact_shape random_superquadric(random_stream *random, double low, double high)
{
    impact_shape shape;
    double x[6]; /* exponents, then semi-axes */
    for (int i = 0; i < 6; i++) x[i] = i < 3 ? random_log(random, low, high) : random_log(random, 0.1, 1);
    impact_shape_superquadric(x[5], x[4], x[3], x[2], x[1], x[0], &shape);
    return shape;
}

static impact_shape random_superellipsoid(random_stream *random, double low, double high)
{
    impact_shape shape;
    const double a = random_log(random, 0.1, 1), b = random_log(random, 0.1, 1), c = random_log(random, 0.1, 1);
    const double t = random_log(random, low, high);
    impact_shape_superellipsoid(a, b, c, 2 / t, 2 / random_log(random, low, high), &shape);
    return shape;
}

/* ---- the coordinates ---- */

static void a_spot_is_where_the_support_is(void **state)
{
    (void)state;
    random_stream random = {31};
    for (int k = 0; k < 40000; k++) {
        const impact_shape shape =
            k % 2 ? random_superquadric(&random, 1.1, 30) : random_superellipsoid(&random, 1.1, 30);
        const qvec3 n = random_direction(&random);
        double s[3];
        qvec3 point;
        const double h = impact_shape_support(&shape, n, &point);
        imp_spot_find(&shape, n, s);
        const imp_spot spot = imp_spot_at(&shape, s);
        assert_near3(spot.normal, n, 1e-14);
        assert_near3(spot.point, point, 1e-14);
        assert_near(qvec3_dot(spot.point, n), h, k % 2 ? 2e-15 : 4e-15); /* one power more */
    }
}

/* Exponents all but 1: sections smaller than the least number stand about a pole whose normals are as many as ever. */
static void spots_of_all_but_cones_are_too(void **state)
{
    (void)state;
    random_stream random = {33};
    for (int k = 0; k < 20000; k++) {
        const double sharp = 1 + random_log(&random, 1e-6, 0.1), other = random_log(&random, 1.1, 30);
        const bool pointed = k % 2; /* along z, or all around */
        impact_shape shape;
        assert_int_equal(impact_shape_superellipsoid(0.3, 0.2, 0.4, 2 / (pointed ? sharp : other),
                                                     2 / (pointed ? other : sharp), &shape),
                         IMPACT_OK);
        const qvec3 n = random_direction(&random);
        double s[3];
        qvec3 point;
        impact_shape_support(&shape, n, &point);
        imp_spot_find(&shape, n, s);
        const imp_spot spot = imp_spot_at(&shape, s);
        const double rounding = 1e-14 + DBL_EPSILON / (sharp - 1); /* what that of the normal makes of the place */
        assert_near3(spot.normal, n, rounding);
        assert_near3(spot.point, point, rounding);
    }
}

static void flat_and_sharp_spots_are_exact(void **state)
{
    (void)state;
    for (double p = 1.2; p < 25; p *= 1.7) {
        impact_shape shape;
        impact_shape_superquadric(1, 2, 3, p, p, p, &shape);
        for (int k = -1; k <= 1; k++) { /* the pole, and beside it */
            const double u = 1e-3 * k, e = copysign(pow(fabs(u), p - 1), u), rest = 1 - fabs(u * e);
            const double at[3] = {u + e, 0, pow(rest, 1 / p) + pow(rest, 1 - 1 / p)};
            const imp_spot spot = imp_spot_at(&shape, at);
            assert_near(spot.u[0], u, 1e-15 * fabs(u));
            assert_near(spot.e[0], e, 1e-14 * fabs(e));
            assert_near3(spot.point, (qvec3){u, 0, 3 * pow(rest, 1 / p)}, 1e-15);
            assert_true(spot.u[1] == 0 && spot.e[1] == 0 && spot.slope[1] > 0);
        }
    }
}

/* The rate of a spot whose normal turns, by finite differences of spots of turned normals. */
static void spots_move_as_their_normals_turn(void **state)
{
    (void)state;
    random_stream random = {32};
    const double h = 2e-5;
    for (int k = 0; k < 10000; k++) {
        const impact_shape shape =
            k % 2 ? random_superquadric(&random, 1.3, 5) : random_superellipsoid(&random, 1.3, 5);
        const qvec3 n = random_direction(&random), w = random_direction(&random);
        double s[3], turned[4][3];
        imp_spot_find(&shape, n, s);
        if (fmin(fabs(s[0]), fmin(fabs(s[1]), fabs(s[2]))) < 0.2) continue; /* where differences are good */
        const imp_spot spot = imp_spot_at(&shape, s);
        const imp_spot_rate rate = imp_spot_move(&shape, &spot, qvec3_cross(w, n));
        qvec3 point[4];
        for (int i = 0; i < 4; i++) {
            const double angle = h * (const double[]){-2, -1, 1, 2}[i];
            imp_spot_find(&shape, quat_rotate(quat_from_rotation_vector(qvec3_scale(w, angle)), n), turned[i]);
            point[i] = imp_spot_at(&shape, turned[i]).point;
        }
        for (int i = 0; i < 3; i++)
            assert_near((8 * (turned[2][i] - turned[1][i]) - (turned[3][i] - turned[0][i])) / (12 * h), rate.s[i],
                        1e-7 * (1 + fabs(rate.s[i])));
        const qvec3 change = qvec3_sub(qvec3_scale(qvec3_sub(point[2], point[1]), 8), qvec3_sub(point[3], point[0]));
        assert_near3(qvec3_scale(change, 1 / (12 * h)), rate.point_rate, 1e-7 * (1 + qvec3_norm(rate.point_rate)));
    }
}

/* ---- revolutions in a plane ---- */

/* A body that rolls, or glides without friction, and turns about its y axis only. With f its angle, r the contact point
 * from the centre and h(f) the centre's height, energy is all there is to it:
 *
 *   rolling (J + m r^2) f'^2/2 + m g h = E,   gliding (J + m h'^2) f'^2/2 + m g h = E. */
typedef enum tumbler_kind { SUPERQUADRIC, ELLIPSOID_PROFILE, ELLIPSOID_SECTION } tumbler_kind;

typedef struct tumbler {
    long double a, c, p, t;      /* semi-axes along x and z, exponents */
    long double inertia, energy; /* per mass */
    bool rolls;
} tumbler;

typedef struct tumble {
    long double period, path;
} tumble;

/* The part of a quarter turn at mass |u_x|^p = v, |u_z|^t = w, v + w = 1; both, since near the ends one of them is the
 * other's rounding. */
static tumble tumble_rate(const tumbler *b, long double v, long double w)
{
    const long double x = b->a * powl(v, 1 / b->p), z = b->c * powl(w, 1 / b->t);
    const long double nx = b->p * v / x, nz = b->t * w / z, n = hypotl(nx, nz);
    const long double h = (x * nx + z * nz) / n, slope = (x * nz - z * nx) / n;
    /* dx/dv = x/(p v), dz/dv = -z/(t w); the angle's tangent nx/nz changes by (1 - 1/p)/v + (1 - 1/t)/w of itself */
    const long double angle = nx * nz / (n * n) * ((1 - 1 / b->p) / v + (1 - 1 / b->t) / w);
    const long double arm = b->rolls ? x * x + z * z : slope * slope;
    return (tumble){sqrtl((b->inertia + arm) / (2 * (b->energy - (long double)gravity * h))) * angle,
                    hypotl(x / (b->p * v), z / (b->t * w))};
}

/* One revolution: four quarters, by the double exponential rule in v = 1/(1 + exp(-pi sinh x)). */
static tumble revolution(const tumbler *b)
{
    const long double pi = 3.141592653589793238462643L, step = 1.0L / 64;
    tumble sum = {0, 0};
    for (int k = -500; k <= 500; k++) {
        const long double x = step * k, tail = expl(-pi * sinhl(fabsl(x)));
        const long double small = tail / (1 + tail), large = 1 / (1 + tail);
        const tumble rate = tumble_rate(b, x < 0 ? small : large, x < 0 ? large : small);
        const long double weight = 4 * step * pi * coshl(x) * small * large;
        sum.period += weight * rate.period;
        sum.path += weight * rate.path;
    }
    return sum;
}

/* Of the kind, with semi-axes a and c and exponents p and t in the plane; other is the exponent across, where
 * superellipsoids are long, not to fall sideways. They turn about their y axis, where both exponents are the profile's,
 * or lie on their side and turn about z, where both are the section's. */
static quat tumbler_shape(tumbler_kind kind, double p, double t, double a, double c, double other, impact_shape *shape)
{
    if (kind == SUPERQUADRIC) impact_shape_superquadric(a, 0.25, c, p, other, t, shape);
    if (kind == ELLIPSOID_PROFILE) impact_shape_superellipsoid(a, 0.6, c, 2 / t, 2 / other, shape);
    if (kind == ELLIPSOID_SECTION) impact_shape_superellipsoid(a, c, 0.6, 2 / other, 2 / p, shape);
    /* z along the world's y, y down */
    return kind == ELLIPSOID_SECTION ? quat_from_rotation_vector((qvec3){-acos(0), 0, 0}) : quat_identity();
}

/* It begins on the flattest or sharpest spot, with energy for a fifth more than its centre has to climb. */
static void check_revolution(tumbler_kind kind, double p, double t, double a, double c, double other, bool rolls)
{
    impact_body_def bodies[2] = {floor_body(), impact_default_body_def()};
    impact_body_def *body = &bodies[1];
    body->name = "tumbler";
    body->mass = mass;
    const quat start = body->orientation = tumbler_shape(kind, p, t, a, c, other, &body->shape);
    const qvec3 moments = impact_shape_inertia(&body->shape);
    body->position.z = c;
    body->friction = rolls ? 1e9 : 0;
    tumbler b = {a, c, p, t, kind == ELLIPSOID_SECTION ? moments.z : moments.y, 0, rolls};
    double highest = 0, lowest = INFINITY;
    for (double f = 0; f < 1.6; f += 0.01) {
        const qvec3 up = quat_rotate_inverse(start, (qvec3){sin(f), 0, cos(f)});
        const double h = impact_shape_support(&body->shape, up, NULL);
        highest = fmax(highest, h), lowest = fmin(lowest, h);
    }
    b.energy = gravity * (highest + 0.2 * (highest - lowest) + 0.01);
    const double w = sqrt(2 * ((double)b.energy - gravity * c) / ((double)b.inertia + (rolls ? c * c : 0)));
    body->omega.y = w;
    body->velocity.x = rolls ? w * c : 0.25;
    const tumble turn = revolution(&b);
    const impact_scene_def def = scene_of(bodies, 2, (double)turn.period);
    impact_scene *scene = make_scene(&def);
    scene_log log = {0};
    const impact_recorder recorder = log_recorder(&log);
    const impact_status status = impact_scene_run(scene, &recorder);
    if (status != IMPACT_OK) fail_msg("p = %g, t = %g: %s", p, t, impact_scene_message(scene));
    if (find_event(&log, IMPACT_EVENT_LIFTOFF, NULL, 0) >= 0)
        fail_msg("kind %d p %g t %g other %g rolls %d", (int)kind, p, t, other, rolls);
    impact_sample end;
    impact_scene_body(scene, 1, &end);
    const quat q = quat_mul(end.orientation, quat_conj(start)); /* once about is -1 */
    assert_near(2 * atan2(-q.y, -q.w), 0, 5e-9);
    const double sideways = kind == SUPERQUADRIC ? 1e-15 : 1e-11;
    assert_at_most(q.x * q.x + q.z * q.z, sideways * sideways);
    assert_near(end.position.x, rolls ? (double)turn.path : 0.25 * (double)turn.period, 1e-9);
    assert_near(end.position.z, c, 1e-9);
    const impact_energy energy = impact_scene_energy(scene);
    assert_near(energy.kinetic + energy.potential, energy.start, 1e-9 * energy.start);
    free_log(&log);
    impact_scene_destroy(scene);
}

static void revolutions_take_their_time(void **state)
{
    (void)state;
    static const double exponents[] = {1.2, 1.5, 1.9, 2, 2.1, 2.5, 3, 4, 6, 10, 20};
    const int count = sizeof exponents / sizeof *exponents;
    for (int i = 0; i < count; i++)
        for (int rolls = 0; rolls < 2; rolls++) {
            const double p = exponents[i], other = exponents[(i + 4) % count];
            check_revolution(SUPERQUADRIC, p, p, 0.2, 0.2, 2, rolls);
            check_revolution(SUPERQUADRIC, p, other, 0.22, 0.2, 2, rolls);
            if (p == 2) continue;
            if (p <= 4) check_revolution(ELLIPSOID_PROFILE, p, p, 0.2, 0.2, 2, rolls); /* flatter poles let it veer */
            check_revolution(ELLIPSOID_SECTION, p, p, 0.2, 0.2, 2, rolls);
        }
}

/* ---- any motion ---- */

static double vertical_momentum(const impact_scene *scene, const impact_body_def *def)
{
    impact_sample s;
    impact_scene_body(scene, 1, &s);
    const qvec3 j = qvec3_scale(impact_shape_inertia(&def->shape), def->mass);
    const qvec3 w = quat_rotate_inverse(s.orientation, s.omega);
    return quat_rotate(s.orientation, (qvec3){j.x * w.x, j.y * w.y, j.z * w.z}).z;
}

/* Energy, and for gliding bodies the momentum along the floor and the angular momentum about the vertical. */
static void rolling_and_gliding_keep_their_integrals(void **state)
{
    (void)state;
    random_stream random = {33};
    for (int k = 0; k < 90; k++) {
        const bool rolls = k & 1;
        impact_body_def bodies[2] = {floor_body(), impact_default_body_def()};
        impact_body_def *body = &bodies[1];
        qvec3 lowest;
        body->name = "body";
        body->mass = mass;
        double x[6]; /* exponents, then semi-axes */
        for (int i = 0; i < 6; i++) x[i] = i < 3 ? random_log(&random, 1.2, 20) : 0.2 + 0.2 * random_unit(&random);
        impact_shape_superquadric(x[5], x[4], x[3], x[2], x[1], x[0], &body->shape);
        body->orientation = random_rotation(&random);
        body->position.z =
            impact_shape_support(&body->shape, quat_rotate_inverse(body->orientation, (qvec3){0, 0, -1}), &lowest);
        body->omega = random_vector(&random, 0.1, 2);
        body->velocity = qvec3_neg(qvec3_cross(body->omega, quat_rotate(body->orientation, lowest)));
        if (!rolls) body->velocity.x += 0.3;
        body->friction = rolls ? 1e4 : 0;
        impact_scene_def def = scene_of(bodies, 2, 1.5);
        def.output_rate = 40;
        impact_scene *scene = make_scene(&def);
        const double turning = vertical_momentum(scene, body);
        scene_log log = {0};
        const impact_recorder recorder = log_recorder(&log);
        const impact_status status = impact_scene_run(scene, &recorder);
        if (status != IMPACT_OK)
            fail_msg("%g %g %g: %s", body->shape.r, body->shape.s, body->shape.t, impact_scene_message(scene));
        for (int i = 0; i < log.sample_count; i++) {
            const impact_sample *s = &log.samples[i];
            const qvec3 down = quat_rotate_inverse(s->orientation, (qvec3){0, 0, -1});
            /* rows beside an event stand as they were integrated */
            assert_at_most(impact_shape_support(&body->shape, down, NULL) - s->position.z, 1e-11);
        }
        const impact_energy e = impact_scene_energy(scene);
        assert_near(e.kinetic + e.potential, e.start - e.sliding_loss - e.impact_loss, 1e-9 * e.start);
        if (!rolls) {
            impact_sample end;
            impact_scene_body(scene, 1, &end);
            assert_near(end.velocity.x, body->velocity.x, 1e-13);
            assert_near(end.velocity.y, body->velocity.y, 1e-13);
            assert_near(vertical_momentum(scene, body), turning, 1e-12);
        }
        free_log(&log);
        impact_scene_destroy(scene);
    }
}

int main(void)
{
    const struct CMUnitTest instants[] = {
        cmocka_unit_test(a_spot_is_where_the_support_is),
        cmocka_unit_test(spots_of_all_but_cones_are_too),
        cmocka_unit_test(flat_and_sharp_spots_are_exact),
        cmocka_unit_test(spots_move_as_their_normals_turn),
    };
    const struct CMUnitTest integrated[] = {
        cmocka_unit_test(revolutions_take_their_time),
        cmocka_unit_test(rolling_and_gliding_keep_their_integrals),
    };
    const int failed = cmocka_run_group_tests(instants, NULL, NULL);
    if (!impact_has(IMPACT_PART_CVODE)) return failed;
    return failed + cmocka_run_group_tests(integrated, NULL, NULL);
}
