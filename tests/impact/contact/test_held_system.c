/* SPDX-License-Identifier: MIT
 *
 * The reactions of held contacts at one instant: against Newton and Euler in long double, and against finite
 * differences of the gap.
 */
#include "kit/held_bodies.h"
#include "kit/islands.h"

/* The only pair's reactions in the mode given, as the scene's states are. */
static imp_held_contact solve_contact(imp_island *island, imp_mode mode)
{
    imp_held *held = &island->motion.held;
    island->world.pairs[0].mode = mode;
    assert_int_equal(imp_held_reserve(held, &island->world, island->states), IMPACT_OK);
    assert_true(imp_field_loads(&island->world, 0, island->states, island->motion.loads));
    imp_held_solve(held, &island->world, island->states, island->motion.loads);
    assert_int_equal(held->count, 1);
    return held->contacts[0];
}

static void turn_at(imp_island *island, int body, qvec3 omega)
{
    island->states[body].momentum = imp_inertia(&island->world.bodies[body], island->states[body].q, omega);
}

typedef long double real;

/* Long double vectors and 3 x 3 systems for the second formulation. */
static void cross(const real a[3], const real b[3], real c[3])
{
    const real r[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    for (int i = 0; i < 3; i++) c[i] = r[i];
}

static real dot(const real a[3], const real b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void to_real(qvec3 v, real r[3]) { r[0] = v.x, r[1] = v.y, r[2] = v.z; }

static real det3(real m[3][3])
{
    real c[3];
    cross(m[1], m[2], c);
    return dot(m[0], c);
}

static void solve3(real m[3][3], const real right[3], real x[3])
{
    const real d = det3(m);
    for (int k = 0; k < 3; k++) {
        real n[3][3];
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) n[i][j] = j == k ? right[i] : m[i][j];
        x[k] = det3(n) / d;
    }
}

/* An ellipsoid on the floor z = 0: columns of e are its axes. */
typedef struct spinner {
    real axes[3], e[3][3], moments[3], w[3];
} spinner;

/* Its axes after it has turned by the vector w s. */
static void turned_axes(const spinner *b, real s, real e[3][3])
{
    real k[3];
    const real w = sqrtl(dot(b->w, b->w)), c = cosl(w * s), n = sinl(w * s);
    for (int i = 0; i < 3; i++) k[i] = b->w[i] / w;
    for (int a = 0; a < 3; a++) {
        real axis[3], across[3];
        for (int i = 0; i < 3; i++) axis[i] = b->e[i][a];
        cross(k, axis, across);
        const real along = dot(k, axis);
        for (int i = 0; i < 3; i++) e[i][a] = axis[i] * c + across[i] * n + k[i] * along * (1 - c);
    }
}

/* Contact point from the centre, -h grad; returns the centre's height. */
static real lowest_point(const spinner *b, real s, real r[3])
{
    real e[3][3], h2 = 0;
    turned_axes(b, s, e);
    for (int a = 0; a < 3; a++) h2 += b->axes[a] * b->axes[a] * e[2][a] * e[2][a];
    const real h = sqrtl(h2);
    for (int i = 0; i < 3; i++) {
        r[i] = 0;
        for (int a = 0; a < 3; a++) r[i] -= e[i][a] * b->axes[a] * b->axes[a] * e[2][a] / h;
    }
    return h;
}

/* J^+-1 v. */
static void inertia(const spinner *b, bool inverse, const real v[3], real out[3])
{
    real local[3] = {0, 0, 0};
    for (int a = 0; a < 3; a++)
        for (int i = 0; i < 3; i++) local[a] += b->e[i][a] * v[i];
    for (int i = 0; i < 3; i++) {
        out[i] = 0;
        for (int a = 0; a < 3; a++)
            out[i] += b->e[i][a] * (inverse ? local[a] / b->moments[a] : local[a] * b->moments[a]);
    }
}

/* Rolling: v = -w x r all the time, m v' = F + m g, J w' + w x J w = r x F. For w': J w' + m r x (w' x r) = -w x J w -
 * m r x (w x r' + g). */
static void rolling_force(const spinner *b, real force[3])
{
    const real h = 1e-4L, g[3] = {0, 0, -(real)gravity};
    real r[3], rate[3], a[3], near[2][3], far[2][3], right[3], jw[3], m[3][3], alpha[3];
    lowest_point(b, 0, r);
    for (int k = 0; k < 2; k++) {
        lowest_point(b, k ? h : -h, near[k]);
        lowest_point(b, k ? 2 * h : -2 * h, far[k]);
    }
    for (int i = 0; i < 3; i++) rate[i] = (8 * (near[1][i] - near[0][i]) - (far[1][i] - far[0][i])) / (12 * h);
    inertia(b, false, b->w, jw);
    cross(b->w, jw, right);
    cross(b->w, rate, a);
    for (int i = 0; i < 3; i++) a[i] += g[i];
    real moved[3];
    cross(r, a, moved);
    for (int i = 0; i < 3; i++) right[i] = -right[i] - mass * moved[i];
    for (int k = 0; k < 3; k++) {
        real unit[3] = {k == 0, k == 1, k == 2}, j[3], c[3];
        inertia(b, false, unit, j);
        cross(unit, r, c);
        cross(r, c, c);
        for (int i = 0; i < 3; i++) m[i][k] = j[i] + mass * c[i];
    }
    solve3(m, right, alpha);
    cross(alpha, r, force);
    for (int i = 0; i < 3; i++) force[i] = -mass * (force[i] + a[i]);
}

/* Sliding: F = N (n - mu s/|s|) with N so that the height keeps to that of the lowest point: z'' = h'', h'' being that
 * of turning at w alone, less (r x n) . w'. */
static void sliding_force(const spinner *b, const real slip[3], real mu, real force[3])
{
    const real h = 4e-4L, n[3] = {0, 0, 1};
    real r[3], unused[3], f[3], jw[3], gyro[3], arm[3], turn[3], lever[3];
    const real now = lowest_point(b, 0, r), s = sqrtl(dot(slip, slip));
    const real weights[3] = {270.0L / 180, -27.0L / 180, 2.0L / 180}; /* of the sixth order */
    real second = -490.0L / 180 * now;
    for (int k = 1; k <= 3; k++)
        second += weights[k - 1] * (lowest_point(b, k * h, unused) + lowest_point(b, -k * h, unused));
    second /= h * h;
    for (int i = 0; i < 3; i++) f[i] = n[i] - mu * slip[i] / s;
    inertia(b, false, b->w, jw);
    cross(b->w, jw, gyro);
    inertia(b, true, gyro, gyro);
    cross(r, f, arm);
    inertia(b, true, arm, turn);
    cross(r, n, lever);
    const real pressure = (second + gravity + dot(lever, gyro)) / (1 / (real)mass + dot(lever, turn));
    for (int i = 0; i < 3; i++) force[i] = pressure * f[i];
}

static void reactions_by_newton_and_euler(void **state)
{
    (void)state;
    random_stream random = {11};
    for (int k = 0; k < 4000; k++) {
        const bool slides = k & 1;
        const double a = random_log(&random, 0.2, 1), b = random_log(&random, 0.2, 1), c = random_log(&random, 0.2, 1),
                     mu = 0.3;
        impact_body_def bodies[2] = {ellipsoid_body("egg", a, b, c, random_rotation(&random)),
                                     plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 1, 0)};
        bodies[0].friction = mu;
        bodies[0].position.z = 2;
        const impact_scene_def def = scene_of(bodies, 2, 1);
        impact_scene *scene = make_scene(&def);
        imp_island *island = whole_island(scene);
        imp_state *s = &island->states[0];
        const qvec3 w = random_vector(&random, 0.05, 5);
        spinner twin = {.axes = {a, b, c}};
        to_real(w, twin.w);
        for (int axis = 0; axis < 3; axis++) {
            real e[3];
            to_real(quat_rotate(s->q, (qvec3){axis == 0, axis == 1, axis == 2}), e);
            for (int i = 0; i < 3; i++) twin.e[i][axis] = e[i];
        }
        const qvec3 moments = island->world.bodies[0].moments;
        to_real(moments, twin.moments);
        real r[3], wanted[3];
        s->x.z = (double)lowest_point(&twin, 0, r);
        turn_at(island, 0, w);
        const qvec3 arm = {(double)r[0], (double)r[1], (double)r[2]}, rolling = qvec3_neg(qvec3_cross(w, arm));
        const double angle = 6.3 * random_unit(&random), speed = slides ? random_log(&random, 1e-3, 10) : 0;
        const qvec3 slip = {speed * cos(angle), speed * sin(angle), 0};
        s->v = qvec3_add(rolling, slip);
        const imp_held_contact contact = solve_contact(island, slides ? IMP_SLIDE : IMP_STICK);
        assert_near3(contact.slip, slip, 1e-14 * (1 + qvec3_norm(s->v)));
        real u[3];
        to_real(contact.slip, u);
        if (slides)
            sliding_force(&twin, u, mu, wanted);
        else
            rolling_force(&twin, wanted);
        const qvec3 force = {(double)wanted[0], (double)wanted[1], (double)wanted[2]};
        const double scale = mass * (gravity + qvec3_dot(w, w));
        assert_near3(contact.force, force, 2e-11 * scale);
        assert_near(contact.pressure, (double)wanted[2], 2e-11 * scale);
        if (slides) { /* friction opposes slip */
            const qvec3 tangential = {contact.force.x, contact.force.y, 0};
            assert_near(qvec3_dot(tangential, slip), -mu * contact.pressure * speed, 1e-12 * scale * speed);
        }
        imp_motion_close(&island->motion);
        impact_scene_destroy(scene);
    }
}

/* Both bodies after dt, as the loads and reactions move them. */
static void move(const imp_island *island, const imp_load *loads, double dt, imp_state *moved)
{
    for (int i = 0; i < island->world.body_count; i++) {
        const imp_body *body = &island->world.bodies[i];
        const imp_state *s = &island->states[i];
        moved[i] = *s;
        if (body->is_static) continue;
        const qvec3 acceleration = qvec3_scale(loads[i].force, body->inverse_mass), w = imp_omega(body, s);
        const qvec3 alpha = imp_inverse_inertia(body, s->q, qvec3_sub(loads[i].torque, qvec3_cross(w, s->momentum)));
        moved[i].x = qvec3_axpy(dt, qvec3_axpy(0.5 * dt, acceleration, s->v), s->x);
        moved[i].v = qvec3_axpy(dt, acceleration, s->v);
        moved[i].q = quat_mul(quat_from_rotation_vector(qvec3_scale(qvec3_axpy(0.5 * dt, alpha, w), dt)), s->q);
        moved[i].momentum = imp_inertia(body, moved[i].q, qvec3_axpy(dt, alpha, w));
    }
}

/* Relative velocity of the contact points, at the contact as it then is. */
static qvec3 contact_velocity(imp_island *island, const imp_state *states, double *rate)
{
    imp_world *world = &island->world;
    imp_pair *pair = &world->pairs[0];
    const imp_body *b1 = &world->bodies[pair->body1], *b2 = &world->bodies[pair->body2];
    const imp_state *s1 = &states[pair->body1], *s2 = &states[pair->body2];
    const impact_solid solid1 = imp_solid_of(b1, s1), solid2 = imp_solid_of(b2, s2);
    impact_contact contact;
    assert_true(impact_gap(&solid1, &solid2, NULL, &contact) >= 0);
    contact.offset1 = qvec3_add(contact.offset1, imp_shape_offset(b1, s1));
    contact.offset2 = qvec3_add(contact.offset2, imp_shape_offset(b2, s2));
    const qvec3 u1 = qvec3_add(s1->v, qvec3_cross(imp_omega(b1, s1), contact.offset1));
    const qvec3 u2 =
        b2->is_static ? (qvec3){0, 0, 0} : qvec3_add(s2->v, qvec3_cross(imp_omega(b2, s2), contact.offset2));
    *rate = qvec3_dot(contact.normal, qvec3_sub(u1, u2));
    return qvec3_sub(u1, u2);
}

/* Any smooth bodies, their centres of mass anywhere in them, on each other or on a plane, touching, rolling or sliding:
 * with the reactions that were solved for, the contact velocity (rolling) or the gap's rate (sliding) stays what it is,
 * by finite differences of the gap's contact points. */
static void reactions_keep_the_contact(void **state)
{
    (void)state;
    random_stream random = {12};
    for (int k = 0; k < 3000; k++) {
        const bool slides = k & 1, on_plane = k % 4 >= 2;
        impact_body_def bodies[2] = {ellipsoid_body("one", 1, 1, 1, random_rotation(&random)),
                                     ellipsoid_body("two", 1, 1, 1, random_rotation(&random))};
        for (int i = 0; i < 2; i++) {
            double axis[3];
            for (int j = 2; j >= 0; j--) axis[j] = random_log(&random, 0.4, 1);
            impact_shape_ellipsoid(axis[0], axis[1], axis[2], &bodies[i].shape);
        }
        if (k % 3 == 0) impact_shape_sphere(random_log(&random, 0.4, 1), &bodies[0].shape);
        if (k % 7 == 0) bodies[1].is_static = true;
        if (on_plane) impact_shape_plane(INFINITY, INFINITY, &bodies[1].shape), bodies[1].is_static = true;
        for (int i = 0; i < (on_plane ? 1 : 2) && k % 5 < 2; i++) {
            bodies[i].shape_position = random_vector(&random, 0.01, 0.2);
            bodies[i].shape_orientation = random_rotation(&random);
            bodies[i].moments = (qvec3){1, 0.8, 0.6};
        }
        bodies[1].mass = 2;
        bodies[0].friction = bodies[1].friction = 0.5;
        bodies[0].position =
            on_plane ? quat_rotate(bodies[1].orientation, (qvec3){0, 0, 3}) : qvec3_scale(random_direction(&random), 3);
        const impact_scene_def def = scene_of(bodies, 2, 1);
        impact_scene *scene = make_scene(&def);
        imp_island *island = whole_island(scene);
        imp_state *s = island->states;
        impact_contact contact;
        for (int i = 0; i < 3; i++) { /* together */
            const impact_solid one = imp_solid_of(&island->world.bodies[0], &s[0]),
                               two = imp_solid_of(&island->world.bodies[1], &s[1]);
            assert_true(impact_gap(&one, &two, NULL, &contact) >= 0);
            s[0].x = qvec3_axpy(-contact.gap, contact.normal, s[0].x);
        }
        for (int i = 0; i < 2; i++) turn_at(island, i, random_vector(&random, 0.05, 1));
        if (!island->world.bodies[1].is_static)
            s[1].v = random_vector(&random, 0.1, 1);
        else
            s[1].momentum = (qvec3){0, 0, 0};
        double rate;
        const qvec3 u = contact_velocity(island, s, &rate);
        s[0].v = qvec3_sub(s[0].v, u);
        if (slides) s[0].v = qvec3_add(s[0].v, qvec3_cross(contact.normal, random_vector(&random, 0.1, 1)));
        solve_contact(island, slides ? IMP_SLIDE : IMP_STICK);
        imp_load loads[2] = {island->motion.loads[0], island->motion.loads[1]};
        imp_held_add_reactions(&island->motion.held, loads);
        const double h = 3e-4;
        qvec3 velocity[4];
        double rates[4];
        for (int i = 0; i < 4; i++) {
            imp_state moved[2];
            move(island, loads, h * (const double[]){-2, -1, 1, 2}[i], moved);
            velocity[i] = contact_velocity(island, moved, &rates[i]);
        }
        const qvec3 change =
            qvec3_sub(qvec3_scale(qvec3_sub(velocity[2], velocity[1]), 8), qvec3_sub(velocity[3], velocity[0]));
        assert_near((8 * (rates[2] - rates[1]) - (rates[3] - rates[0])) / (12 * h), 0, 2e-7);
        if (!slides) assert_near(qvec3_norm(change) / (12 * h), 0, 2e-7);
        imp_motion_close(&island->motion);
        impact_scene_destroy(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reactions_by_newton_and_euler),
        cmocka_unit_test(reactions_keep_the_contact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
