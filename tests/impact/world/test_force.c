/* SPDX-License-Identifier: MIT
 *
 * Forces on bodies that meet nothing: motions with closed forms, edges of reach, potentials as integrals of their
 * forces, and the account of energy.
 */
#include "scene/scene_internal.h"
#include "kit/contact_random.h"
#include "kit/scene_log.h"

static const double mass = 4, radius = 0.3;

static impact_scene_def scene_of(const impact_body_def *bodies, int body_count, const impact_force_def *force,
                                 double duration)
{
    impact_scene_def def = impact_default_scene_def();
    def.gravity = (qvec3){0, 0, 0};
    def.bodies = bodies;
    def.body_count = body_count;
    def.forces = force;
    def.force_count = 1;
    def.duration = duration;
    def.output_rate = 0;
    return def;
}

static impact_body_def small_ball(qvec3 position, qvec3 velocity)
{
    impact_body_def body = ball_body("ball", position, 0, 0);
    impact_shape_sphere(1e-3, &body.shape);
    body.velocity = velocity;
    return body;
}

/* Runs a scene of one force; the end of body 0. */
static impact_sample run_scene(const impact_scene_def *def, scene_log *log, impact_energy *energy)
{
    impact_scene *scene = make_scene(def);
    scene_log own = {0};
    const impact_recorder recorder = log_recorder(log ? log : &own);
    if (impact_scene_run(scene, &recorder) != IMPACT_OK) fail_msg("%s", impact_scene_message(scene));
    impact_sample end;
    impact_scene_body(scene, 0, &end);
    *energy = impact_scene_energy(scene);
    const double wanted =
        energy->start + energy->force_work - energy->damping_loss - energy->sliding_loss - energy->impact_loss;
    /* No step adds more than its tolerance. */
    const double steps = 10.0 + (double)impact_scene_usage(scene).integrator_steps;
    assert_near(energy->kinetic + energy->potential, wanted,
                def->tolerance * steps * (fabs(energy->start) + energy->kinetic + 1));
    free_log(&own);
    impact_scene_destroy(scene);
    return end;
}

static double wind_works(double strength, double length, double power, double d)
{
    const double e = 1 - power, ratio = log1p(d / length);
    return strength * length * (e == 0 ? ratio : expm1(e * ratio) / e);
}

/* ---- wind ---- */

/* From rest at the tube's origin: what the wind has done after the distance d is the integral of its force. */
static void wind_does_the_integral_of_its_force(void **state)
{
    (void)state;
    random_stream random = {1};
    for (int i = 0; i < 60; i++) {
        const qvec3 direction = random_direction(&random), origin = qvec3_scale(random_direction(&random), 3);
        const impact_body_def body = small_ball(origin, (qvec3){0, 0, 0});
        impact_force_def wind = impact_default_force_def(IMPACT_FORCE_WIND);
        wind.origin = origin;
        wind.direction = qvec3_scale(direction, random_log(&random, 1e-3, 1e3)); /* only its direction counts */
        wind.strength = random_log(&random, 0.1, 100);
        wind.falloff_power = i % 4 == 0 ? 0 : i % 4 == 1 ? 1 : 4 * random_unit(&random);
        wind.falloff_length = random_log(&random, 0.1, 10);
        const bool cut = i & 1;
        if (cut) wind.reach = 0.5 * 0.5 * wind.strength / mass;
        const impact_scene_def def = scene_of(&body, 1, &wind, 2);
        impact_energy energy;
        scene_log log = {0};
        const impact_sample end = run_scene(&def, &log, &energy);
        const qvec3 path = qvec3_sub(end.position, origin);
        const double d = fmin(qvec3_norm(path), wind.reach);
        const double work = wind_works(wind.strength, wind.falloff_length, wind.falloff_power, d);
        assert_near(energy.force_work, work, 1e-11 * (1 + work));
        assert_near(energy.kinetic, work, 1e-11 * (1 + work));
        assert_near(qvec3_norm(qvec3_cross(path, direction)), 0, 1e-12 * (1 + qvec3_norm(path)));
        const int edge = find_event(&log, IMPACT_EVENT_FORCE, NULL, 0);
        assert_true((edge >= 0) == (qvec3_norm(path) > wind.reach));
        if (edge >= 0) {
            assert_string_equal("wind", wind.name);
            assert_near(qvec3_norm(qvec3_sub(log.events[edge].point, origin)), wind.reach, 1e-12 * wind.reach);
            assert_int_equal(log.events[edge].body2, -1);
        }
        free_log(&log);
    }
}

/* A wind that drags pulls to its own speed u = F/c: v = u + (v0 - u) exp(-c t/m), at any angle to it, gently or fast.
 */
static void wind_pulls_to_its_own_speed(void **state)
{
    (void)state;
    random_stream random = {7};
    for (int i = 0; i < 40; i++) {
        const qvec3 v0 = qvec3_scale(random_direction(&random), 3 * random_unit(&random));
        const impact_body_def body = small_ball((qvec3){0, 0, 0}, v0);
        impact_force_def wind = impact_default_force_def(IMPACT_FORCE_WIND);
        wind.direction = random_direction(&random);
        wind.strength = random_log(&random, 0.1, 10);
        wind.drag = random_log(&random, 1e-3, 1e4);
        const double t = 2, rate = wind.drag / mass, left = exp(-rate * t);
        const qvec3 u = qvec3_scale(wind.direction, wind.strength / wind.drag), off = qvec3_sub(v0, u);
        const impact_scene_def def = scene_of(&body, 1, &wind, t);
        impact_energy energy;
        scene_log log = {0};
        const impact_sample end = run_scene(&def, &log, &energy);
        const qvec3 x = qvec3_axpy(t, u, qvec3_scale(off, -expm1(-rate * t) / rate));
        assert_near3(end.velocity, qvec3_axpy(left, off, u), 1e-11 * (1 + qvec3_norm(u)));
        assert_near3(end.position, x, 1e-11 * (1 + qvec3_norm(x)));
        free_log(&log);
    }
}

/* Across a tube of any radius, at a distance from its axis: the wind blows for 2 sqrt(R^2 - b^2)/speed. */
static void wind_blows_within_its_radius(void **state)
{
    (void)state;
    random_stream random = {2};
    for (int i = 0; i < 60; i++) {
        const double tube = random_log(&random, 1e-6, 1), beside = (2 * random_unit(&random) - 1) * 1.5 * tube;
        const double speed = random_log(&random, 0.1, 1e3), from = -random_log(&random, 1.5, 100);
        const double inside = fabs(beside) < tube ? 2 * sqrt((tube - beside) * (tube + beside)) / speed : 0;
        const impact_body_def body = small_ball((qvec3){0, from, beside}, (qvec3){0, speed, 0});
        impact_force_def wind = impact_default_force_def(IMPACT_FORCE_WIND);
        wind.radius = tube;
        wind.strength = 50;
        const impact_scene_def def = scene_of(&body, 1, &wind, -2 * from / speed);
        impact_energy energy;
        scene_log log = {0};
        const impact_sample end = run_scene(&def, &log, &energy);
        /* Where it crosses is known to the rounding of its position. */
        const double blur = 1e-13 * -from / speed * (inside > 0 ? tube / (speed * inside) : 0);
        assert_near(end.velocity.x, wind.strength / mass * inside, wind.strength / mass * (blur + 1e-12 * inside));
        assert_near(end.velocity.y, speed, 1e-13 * speed);
        assert_int_equal(log.event_count, inside > 0 ? 2 : 0);
        if (inside > 0) assert_near(log.events[1].t - log.events[0].t, inside, blur + 1e-12 * inside);
        free_log(&log);
    }
}

/* Thrown into the tube's end against the wind, it is turned back and leaves as fast as it came; or it comes through. */
static void wind_turns_back_what_comes_against_it(void **state)
{
    (void)state;
    for (int k = 0; k < 40; k++) {
        const double speed = 0.5 + 0.25 * k, strength = 40, reach = 1;
        const impact_body_def body = small_ball((qvec3){3, 0.1, 0}, (qvec3){-speed, 0, 0});
        impact_force_def wind = impact_default_force_def(IMPACT_FORCE_WIND);
        wind.strength = strength;
        wind.reach = reach;
        const double a = strength / mass, deepest = speed * speed / (2 * a),
                     slowed = sqrt(fmax(0, speed * speed - 4 * a * reach));
        const bool back = deepest < 2 * reach;
        if (fabs(deepest - 2 * reach) < 0.1) continue;
        const double within = back ? 2 * speed / a : (speed - slowed) / a;
        const impact_scene_def def = scene_of(&body, 1, &wind, 2 / speed + within + 1);
        impact_energy energy;
        scene_log log = {0};
        const impact_sample end = run_scene(&def, &log, &energy);
        assert_int_equal(log.event_count, 2);
        assert_near(log.events[0].t, 2 / speed, 1e-12 / speed);
        assert_near(log.events[1].t, 2 / speed + within, 1e-11);
        assert_near3(end.velocity, (qvec3){back ? speed : -slowed, 0, 0}, 1e-11);
        assert_near3(end.position, (qvec3){back ? 1 + speed : -1 - slowed, 0.1, 0}, 1e-10);
        assert_near(energy.force_work, back ? 0 : -2 * strength * reach, 1e-10);
        free_log(&log);
    }
}

static void a_force_may_have_one_body(void **state)
{
    (void)state;
    impact_body_def bodies[2] = {small_ball((qvec3){0, 0, 0}, (qvec3){0, 0, 0}),
                                 small_ball((qvec3){0, 1, 0}, (qvec3){0, 0, 0})};
    bodies[1].name = "other";
    impact_force_def wind = impact_default_force_def(IMPACT_FORCE_WIND);
    wind.strength = 8;
    wind.body = "other";
    const impact_scene_def def = scene_of(bodies, 2, &wind, 1);
    impact_scene *scene = make_scene(&def);
    assert_int_equal(impact_scene_run(scene, NULL), IMPACT_OK);
    impact_sample ends[2];
    for (int i = 0; i < 2; i++) impact_scene_body(scene, i, &ends[i]);
    assert_near3(ends[0].position, (qvec3){0, 0, 0}, 0);
    assert_near3(ends[1].position, (qvec3){1, 1, 0}, 1e-12);
    impact_scene_destroy(scene);
}

/* ---- attraction ---- */

/* Gauss and Legendre, 5 points, on pieces of equal ratio. */
static long double integral_of_force(double k, double power, double from, double to)
{
    static const long double x[3] = {0, 0.538469310105683091036L, 0.906179845938663992798L};
    static const long double w[3] = {0.568888888888888888889L, 0.478628670499366468041L, 0.236926885056189087514L};
    enum { PIECES = 400 };
    long double sum = 0;
    for (int i = 0; i < PIECES; i++) {
        const long double a = from * powl((long double)to / from, (long double)i / PIECES);
        const long double b = from * powl((long double)to / from, (i + 1.0L) / PIECES), middle = (a + b) / 2,
                          half = (b - a) / 2;
        for (int p = 0; p < 3; p++)
            for (int sign = -1; sign <= (p ? 1 : -1); sign += 2)
                sum += w[p] * half * k * powl(middle + sign * x[p] * half, -(long double)power);
    }
    return sum;
}

/* Over random powers, with 1 and what is close to it, reaching far or not: U(b) - U(a) is the integral of the pull from
 * a to b, and U is zero at the reach; the pull is as its formula says, on either body. */
static void attractions_potential_is_the_integral_of_its_force(void **state)
{
    (void)state;
    random_stream random = {3};
    static const double powers[] = {2, 1, 0, 1 + 1e-9, 1 - 1e-12, -1, 3};
    for (int i = 0; i < 300; i++) {
        const double power = i % 8 < 7 ? powers[i % 8] : 8 * random_unit(&random) - 3;
        const double reach = i & 8 ? INFINITY : random_log(&random, 1, 10), G = random_log(&random, 1e-3, 1e3);
        const double a = random_log(&random, 0.1, 0.9), b = random_log(&random, 0.1, 0.9);
        const qvec3 axis = random_direction(&random);
        impact_body_def bodies[2] = {small_ball((qvec3){1, 2, 3}, (qvec3){0, 0, 0}),
                                     small_ball(qvec3_axpy(a, axis, (qvec3){1, 2, 3}), (qvec3){0, 0, 0})};
        bodies[1].name = "other";
        bodies[1].mass = 2.5;
        impact_force_def attraction = impact_default_force_def(IMPACT_FORCE_ATTRACTION);
        attraction.constant = G;
        attraction.power = power;
        attraction.reach = reach;
        const impact_scene_def def = scene_of(bodies, 2, &attraction, 1);
        impact_scene *scene = make_scene(&def);
        imp_load loads[2];
        const double near = imp_field_potential(&scene->world, scene->states);
        assert_true(imp_field_loads(&scene->world, 0, scene->states, loads));
        const double k = G * mass * 2.5, distance = qvec3_norm(qvec3_sub(scene->states[1].x, scene->states[0].x));
        const double pull = k * pow(distance, -power);
        assert_near3(loads[0].force, qvec3_scale(axis, pull), 1e-14 * pull);
        assert_near3(loads[1].force, qvec3_scale(axis, -pull), 1e-14 * pull);
        scene->states[1].x = qvec3_axpy(b, axis, scene->states[0].x);
        const double far = imp_field_potential(&scene->world, scene->states);
        const double wanted = (double)integral_of_force(k, power, distance, b);
        assert_near(far - near, wanted, 4e-15 * (fabs(near) + fabs(far) + fabs(wanted)));
        if (isfinite(reach))
            assert_near(near, -(double)integral_of_force(k, power, distance, reach), 4e-14 * fabs(near));
        impact_scene_destroy(scene);
    }
}

/* Kepler: an ellipse closes after 2 pi sqrt(a^3/(G (m1 + m2))); the bodies' centre of mass goes straight on. */
static void an_ellipse_closes(void **state)
{
    (void)state;
    const double pi = 3.14159265358979323846, G = 0.7, other_mass = 3, d = 2, total = mass + other_mass;
    for (int k = 0; k < 4; k++) {
        const double speed = sqrt(G * total / d) * (0.6 + 0.2 * k); /* at the far end, or the near one */
        const double a = 1 / (2 / d - speed * speed / (G * total)), period = 2 * pi * sqrt(a * a * a / (G * total));
        impact_body_def bodies[2] = {small_ball((qvec3){0, 0, 0}, (qvec3){0.1, -speed * other_mass / total, 0.2}),
                                     small_ball((qvec3){d, 0, 0}, (qvec3){0.1, speed * mass / total, 0.2})};
        bodies[1].name = "other";
        bodies[1].mass = other_mass;
        impact_force_def attraction = impact_default_force_def(IMPACT_FORCE_ATTRACTION);
        attraction.constant = G;
        const impact_scene_def def = scene_of(bodies, 2, &attraction, period);
        impact_energy energy;
        const impact_sample end = run_scene(&def, NULL, &energy);
        assert_near3(end.position, (qvec3){0.1 * period, 0, 0.2 * period}, 1e-10 * period * speed);
        assert_near3(end.velocity, bodies[0].velocity, 1e-10 * speed);
        assert_true(energy.force_work == 0);
    }
}

/* Two bodies let go within reach of a constant pull pass by each other's place, leave the reach, and drift on at the
 * speed they have there. */
static void attraction_ends_at_its_reach(void **state)
{
    (void)state;
    const double k = mass * mass, reach = 2, speed = 3;
    impact_body_def bodies[2] = {small_ball((qvec3){-0.5, 0, 0}, (qvec3){-speed, 0, 0}),
                                 small_ball((qvec3){0.5, 0, 0}, (qvec3){speed, 0, 0})};
    bodies[1].name = "other";
    impact_force_def attraction = impact_default_force_def(IMPACT_FORCE_ATTRACTION);
    attraction.constant = 1;
    attraction.power = 0;
    attraction.reach = reach;
    const impact_scene_def def = scene_of(bodies, 2, &attraction, 2);
    impact_energy energy;
    scene_log log = {0};
    const impact_sample end = run_scene(&def, &log, &energy);
    const double a = k / mass, after = sqrt(speed * speed - 2 * a * 0.5 * (reach - 1)), leaves = (speed - after) / a;
    assert_int_equal(log.event_count, 1);
    assert_near(log.events[0].t, leaves, 1e-12);
    assert_near3(end.velocity, (qvec3){-after, 0, 0}, 1e-12);
    assert_near3(end.position, (qvec3){-0.5 * reach - after * (2 - leaves), 0, 0}, 1e-11);
    assert_true(energy.potential == 0);
    free_log(&log);
}

/* Whatever they do to each other, their centre of mass, momentum and angular momentum do not know of it. */
static void attraction_keeps_momentum(void **state)
{
    (void)state;
    random_stream random = {4};
    enum { N = 5 };
    static const char *const names[N] = {"a", "b", "c", "d", "e"};
    for (int round = 0; round < 5; round++) {
        impact_body_def bodies[N];
        for (int i = 0; i < N; i++) {
            const qvec3 v = random_direction(&random), at = random_direction(&random);
            bodies[i] = small_ball(qvec3_scale(at, 1.0 + i), qvec3_scale(v, 0.5));
            bodies[i].name = names[i];
            bodies[i].mass = random_log(&random, 0.1, 10);
        }
        impact_force_def attraction = impact_default_force_def(IMPACT_FORCE_ATTRACTION);
        attraction.constant = 0.05;
        attraction.power = 1.5;
        attraction.reach = 3;
        const impact_scene_def def = scene_of(bodies, N, &attraction, 1);
        impact_scene *scene = make_scene(&def);
        if (impact_scene_run(scene, NULL) != IMPACT_OK) fail_msg("%s", impact_scene_message(scene));
        qvec3 p = {0, 0, 0}, l = {0, 0, 0};
        for (int i = 0; i < N; i++) {
            impact_sample s;
            impact_scene_body(scene, i, &s);
            const qvec3 after = qvec3_scale(s.velocity, bodies[i].mass),
                        before = qvec3_scale(bodies[i].velocity, bodies[i].mass);
            p = qvec3_add(p, qvec3_sub(after, before));
            l = qvec3_add(l, qvec3_sub(qvec3_cross(s.position, after), qvec3_cross(bodies[i].position, before)));
        }
        assert_near3(p, (qvec3){0, 0, 0}, 1e-12);
        assert_near3(l, (qvec3){0, 0, 0}, 1e-10);
        const impact_energy energy = impact_scene_energy(scene);
        assert_near(energy.kinetic + energy.potential, energy.start, 1e-11);
        impact_scene_destroy(scene);
    }
}

/* ---- custom forces and damping ---- */

typedef struct spring {
    double stiffness, twist;
} spring;

/* A spring to the origin, and a torque against the turn about z. */
static bool pull_back(double t, int body, double m, qvec3 x, quat q, qvec3 v, qvec3 w, qvec3 *force, qvec3 *torque,
                      void *context)
{
    (void)t, (void)body, (void)v, (void)w;
    assert_true(m == mass && qvec3_norm(*force) == 0 && qvec3_norm(*torque) == 0);
    const spring *s = context;
    *force = qvec3_scale(x, -s->stiffness);
    *torque = (qvec3){0, 0, -s->twist * 2 * atan2(q.z, q.w)};
    return true;
}

static void a_spring_swings(void **state)
{
    (void)state;
    spring s = {100, 0.05};
    impact_body_def body = ball_body("bob", (qvec3){1, 0, 0}, 0, 0);
    body.velocity = (qvec3){0, 2, 0};
    body.omega = (qvec3){0, 0, 0.5};
    impact_force_def force = impact_default_force_def(IMPACT_FORCE_CUSTOM);
    force.function = pull_back;
    force.context = &s;
    const double w = sqrt(s.stiffness / mass), inertia = 0.4 * mass * radius * radius, wt = sqrt(s.twist / inertia);
    for (int k = 1; k <= 5; k++) {
        const double t = 1.7 * k;
        const impact_scene_def def = scene_of(&body, 1, &force, t);
        impact_energy energy;
        const impact_sample end = run_scene(&def, NULL, &energy);
        assert_near3(end.position, (qvec3){cos(w * t), 2 / w * sin(w * t), 0}, 1e-11 * t);
        assert_near3(end.velocity, (qvec3){-w * sin(w * t), 2 * cos(w * t), 0}, 1e-10 * t);
        assert_near3(end.omega, (qvec3){0, 0, 0.5 * cos(wt * t)}, 1e-11 * t);
        const double turn = 0.5 / wt * sin(wt * t);
        assert_near(2 * atan2(end.orientation.z, end.orientation.w), turn, 1e-11 * t);
        const double x2 = qvec3_dot(end.position, end.position);
        assert_near(energy.force_work, 0.5 * s.stiffness * (1 - x2) - 0.5 * s.twist * turn * turn, 1e-10 * t);
    }
}

/* Brakes to a wind of 2 m/s along x and a turn of 3 rad/s about y. */
static bool brake_to(double t, int body, double m, qvec3 x, quat q, qvec3 v, qvec3 w, qvec3 *force, qvec3 *torque,
                     void *context)
{
    (void)t, (void)body, (void)x, (void)q;
    const double rate = *(const double *)context, inertia = 0.4 * m * radius * radius;
    *force = qvec3_scale(qvec3_sub((qvec3){2, 0, 0}, v), m * rate);
    *torque = qvec3_scale(qvec3_sub((qvec3){0, 3, 0}, w), inertia * rate);
    return true;
}

/* However fast they brake: x = V (t - (1 - e^(-k t))/k). The steps do not grow with k. */
static void forces_may_brake_hard(void **state)
{
    (void)state;
    const impact_body_def body = ball_body("ball", (qvec3){0, 0, 0}, 0, 0);
    for (double rate = 1; rate < 1e11; rate *= 10) {
        impact_force_def force = impact_default_force_def(IMPACT_FORCE_CUSTOM);
        force.function = brake_to;
        force.context = &rate;
        const impact_scene_def def = scene_of(&body, 1, &force, 2);
        impact_scene *scene = make_scene(&def);
        if (impact_scene_run(scene, NULL) != IMPACT_OK) fail_msg("rate %g: %s", rate, impact_scene_message(scene));
        impact_sample end;
        impact_scene_body(scene, 0, &end);
        const double reached = -expm1(-2 * rate);
        assert_near3(end.velocity, (qvec3){2 * reached, 0, 0}, 1e-12);
        assert_near3(end.omega, (qvec3){0, 3 * reached, 0}, 1e-12);
        assert_near3(end.position, (qvec3){2 * (2 - reached / rate), 0, 0}, 1e-11);
        assert_true(impact_scene_usage(scene).integrator_steps < 5000);
        impact_scene_destroy(scene);
    }
}

/* Across the velocity, as a magnet's: nothing brakes. */
static bool turn_aside(double t, int body, double m, qvec3 x, quat q, qvec3 v, qvec3 w, qvec3 *force, qvec3 *torque,
                       void *context)
{
    (void)t, (void)body, (void)x, (void)q, (void)w, (void)torque;
    *force = qvec3_scale(qvec3_cross((qvec3){0, 0, *(const double *)context}, v), m);
    return true;
}

static void a_magnet_turns_in_circles(void **state)
{
    (void)state;
    double rate = 20;
    const impact_body_def body = small_ball((qvec3){0, 0, 0}, (qvec3){1, 0, 0});
    impact_force_def force = impact_default_force_def(IMPACT_FORCE_CUSTOM);
    force.function = turn_aside;
    force.context = &rate;
    const impact_scene_def def = scene_of(&body, 1, &force, 1);
    impact_energy energy;
    const impact_sample end = run_scene(&def, NULL, &energy);
    assert_near3(end.velocity, (qvec3){cos(rate), sin(rate), 0}, 1e-11);
    assert_near3(end.position, (qvec3){sin(rate) / rate, (1 - cos(rate)) / rate, 0}, 1e-12);
    assert_near(energy.force_work, 0, 1e-11);
}

static bool push_in_time(double t, int body, double m, qvec3 x, quat q, qvec3 v, qvec3 w, qvec3 *force, qvec3 *torque,
                         void *context)
{
    (void)body, (void)x, (void)q, (void)v, (void)w, (void)torque, (void)context;
    force->y = m * cos(t);
    return true;
}

static void a_force_may_know_the_time(void **state)
{
    (void)state;
    const impact_body_def body = small_ball((qvec3){0, 0, 0}, (qvec3){1, 0, 0});
    impact_force_def force = impact_default_force_def(IMPACT_FORCE_CUSTOM);
    force.function = push_in_time;
    const impact_scene_def def = scene_of(&body, 1, &force, 5);
    impact_energy energy;
    const impact_sample end = run_scene(&def, NULL, &energy);
    assert_near3(end.position, (qvec3){5, 1 - cos(5), 0}, 1e-11);
    assert_near3(end.velocity, (qvec3){1, sin(5), 0}, 1e-11);
}

static bool refuse(double t, int body, double m, qvec3 x, quat q, qvec3 v, qvec3 w, qvec3 *force, qvec3 *torque,
                   void *context)
{
    (void)body, (void)m, (void)x, (void)q, (void)v, (void)w, (void)force, (void)torque, (void)context;
    return t < 0.5;
}

static void a_refusal_stops_the_run(void **state)
{
    (void)state;
    const impact_body_def body = small_ball((qvec3){0, 0, 0}, (qvec3){1, 0, 0});
    impact_force_def force = impact_default_force_def(IMPACT_FORCE_CUSTOM);
    force.function = refuse;
    const impact_scene_def def = scene_of(&body, 1, &force, 5);
    impact_scene *scene = make_scene(&def);
    assert_true(impact_scene_run(scene, NULL) < 0);
    assert_non_null(strstr(impact_scene_message(scene), "a custom force refused at t = "));
    assert_true(impact_scene_time(scene) <= 0.5);
    impact_scene_destroy(scene);
}

/* Velocity and spin lose the parts (1 - d)^t, under weight too; the account books what damping takes. */
static void damping_decays(void **state)
{
    (void)state;
    const double d = 0.3, k = -log1p(-d), g = 9.81, t = 3;
    impact_body_def body = ball_body("ball", (qvec3){0, 0, 0}, 0, 0);
    body.velocity = (qvec3){2, 0, 5};
    body.omega = (qvec3){1, -2, 3};
    body.linear_damping = d;
    body.angular_damping = 0.848;
    impact_scene_def def = scene_of(&body, 1, NULL, t);
    def.force_count = 0;
    def.gravity = (qvec3){0, 0, -g};
    impact_energy energy;
    const impact_sample end = run_scene(&def, NULL, &energy);
    const double left = pow(1 - d, t);
    assert_near3(end.velocity, (qvec3){2 * left, 0, (5 + g / k) * left - g / k}, 1e-12);
    assert_near3(end.position, (qvec3){2 * (1 - left) / k, 0, (5 + g / k) * (1 - left) / k - g / k * t}, 1e-11);
    assert_near3(end.omega, qvec3_scale(body.omega, pow(1 - 0.848, t)), 1e-13);
    assert_true(energy.damping_loss > 0 && energy.force_work == 0);
}

static void defaults_are_newtons_and_still_air(void **state)
{
    (void)state;
    const impact_force_def wind = impact_default_force_def(IMPACT_FORCE_WIND),
                           pull = impact_default_force_def(IMPACT_FORCE_ATTRACTION);
    assert_true(wind.strength == 0 && isinf(wind.reach) && isinf(wind.radius) && wind.falloff_power == 0 && !wind.body);
    assert_true(pull.constant == 6.67430e-11 && pull.power == 2 && isinf(pull.reach));
    assert_string_equal(impact_default_force_def(IMPACT_FORCE_CUSTOM).name, "force");
}

int main(void)
{
    const struct CMUnitTest closed_forms[] = {
        cmocka_unit_test(attractions_potential_is_the_integral_of_its_force),
        cmocka_unit_test(defaults_are_newtons_and_still_air),
    };
    const struct CMUnitTest integrated[] = {
        cmocka_unit_test(wind_does_the_integral_of_its_force),
        cmocka_unit_test(wind_pulls_to_its_own_speed),
        cmocka_unit_test(wind_blows_within_its_radius),
        cmocka_unit_test(wind_turns_back_what_comes_against_it),
        cmocka_unit_test(a_force_may_have_one_body),
        cmocka_unit_test(an_ellipse_closes),
        cmocka_unit_test(attraction_ends_at_its_reach),
        cmocka_unit_test(attraction_keeps_momentum),
        cmocka_unit_test(a_spring_swings),
        cmocka_unit_test(forces_may_brake_hard),
        cmocka_unit_test(a_magnet_turns_in_circles),
        cmocka_unit_test(a_force_may_know_the_time),
        cmocka_unit_test(a_refusal_stops_the_run),
        cmocka_unit_test(damping_decays),
    };
    const int failed = cmocka_run_group_tests(closed_forms, NULL, NULL);
    if (!impact_has(IMPACT_PART_CVODE)) return failed;
    return failed + cmocka_run_group_tests(integrated, NULL, NULL);
}
