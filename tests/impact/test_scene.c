/* SPDX-License-Identifier: MIT
 *
 * Whole scenes against closed forms: the thesis' sphere, floor and wall; bounces, slides, rolls and rest with known answers.
 */
#include "scene_log.h"

static const double mass = 4, radius = 0.3, gravity = 9.81;

/* ---- the thesis' scene ---- */

enum { FLOOR, WALL, BALL };

/* The first impact with the body of this index, or -1. */
static int find_impact(const scene_log *log, int other)
{
    for (int i = 0; i < log->event_count; i++)
        if (log->events[i].kind == IMPACT_EVENT_IMPACT && log->events[i].body2 == other) return i;
    return -1;
}

static const double linear_rate = 0.040821994520255166; /* -ln(1 - .04) */
static const double angular_rate = 1.8838747581358606;  /* -ln(1 - .848) */
static const double wind_force = 25, wind_reach = 2;

typedef struct thesis_scene {
    impact_body_def bodies[3];
    impact_force_def wind;
    impact_pair_def grip[2];
    impact_scene_def def;
} thesis_scene;

/* As the authors' files have it, the pairs' friction is .25 x .25, and the sphere slides to the wall: to roll under the wind it would need
 * 2/7 F/(m g) = .18 and more for the damping of its spin. grips: the same with a friction of .5 for both pairs. */
static thesis_scene *make_thesis_scene(bool grips)
{
    thesis_scene *s = calloc(1, sizeof *s);
    s->bodies[FLOOR] = plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 0.25, 1);
    impact_shape_plane(4, 4, &s->bodies[FLOOR].shape);
    s->bodies[WALL] = plane_body("wall", (qvec3){0, 0, 0}, (quat){1, 0, -1, 0}, 0.25, 0.3);
    impact_shape_plane(1.5, 1.5, &s->bodies[WALL].shape);
    s->bodies[BALL] = ball_body("sphere", (qvec3){-3, 0, 1}, 0.25, 0.3);
    s->bodies[BALL].linear_damping = 0.04;
    s->bodies[BALL].angular_damping = 0.848;
    s->wind = impact_default_force_def(IMPACT_FORCE_WIND);
    s->wind.origin = (qvec3){-3, 0, 1};
    s->wind.strength = wind_force;
    s->wind.reach = wind_reach;
    s->grip[0] = (impact_pair_def){"sphere", "floor", 0.5, NAN};
    s->grip[1] = (impact_pair_def){"sphere", "wall", 0.5, NAN};
    s->def = impact_default_scene_def();
    s->def.gravity = (qvec3){0, 0, -gravity};
    s->def.duration = 3.75;
    s->def.bodies = s->bodies;
    s->def.body_count = 3;
    s->def.forces = &s->wind;
    s->def.force_count = 1;
    s->def.pairs = s->grip;
    s->def.pair_count = grips ? 2 : 0;
    return s;
}

static scene_log run_thesis_scene(bool grips, impact_energy *energy, impact_usage *usage)
{
    thesis_scene *s = make_thesis_scene(grips);
    impact_scene *scene = make_scene(&s->def);
    free(s); /* the scene has copied all it needs; names in rows live as long as it does */
    scene_log log = {0};
    const impact_recorder recorder = log_recorder(&log);
    assert_int_equal(impact_scene_run(scene, &recorder), IMPACT_OK);
    assert_true(impact_scene_time(scene) == 3.75);
    if (energy) *energy = impact_scene_energy(scene);
    if (usage) *usage = impact_scene_usage(scene);
    impact_scene_destroy(scene);
    return log;
}

/* Fall under weight and damping: z(t) = 1 - (g/k) (t - (1 - e^-kt)/k). */
static long double fall_height(long double t)
{
    const long double k = linear_rate;
    return 1 - gravity / k * (t + expm1l(-k * t) / k);
}

static void first_bounce_is_where_the_closed_form_puts_it(void **state)
{
    (void)state;
    scene_log log = run_thesis_scene(false, NULL, NULL);
    long double low = 0, high = 1;
    for (int i = 0; i < 200; i++) *(fall_height((low + high) / 2) > radius ? &low : &high) = (low + high) / 2;
    const double t = (double)low, k = linear_rate, decay = -expm1(-k * t);
    const double vx = wind_force / (mass * k) * decay, w = gravity / k * decay;
    const double x = -3 + wind_force / (mass * k) * (t - decay / k);
    const impact_event *bounce = &log.events[0];
    assert_int_equal(bounce->kind, IMPACT_EVENT_IMPACT);
    assert_near(bounce->t, t, 1e-13);
    assert_near3(bounce->point, (qvec3){x, 0, 0}, 1e-12);
    assert_near(bounce->normal_before, -w, 1e-11);
    assert_near(bounce->normal_after, 0.3 * w, 1e-11);
    /* It slips throughout: 2/7 vx > friction (1 + e) w. */
    const double friction = 0.0625, kick = friction * 1.3 * w;
    assert_true(vx / 3.5 > kick);
    for (int i = 0; i < log.sample_count; i++) {
        if (log.samples[i].t != bounce->t || i + 1 == log.sample_count || log.samples[i + 1].t != bounce->t) continue;
        assert_near3(log.samples[i].velocity, (qvec3){vx, 0, -w}, 1e-11);
        assert_near3(log.samples[i + 1].velocity, (qvec3){vx - kick, 0, 0.3 * w}, 1e-11);
        assert_near3(log.samples[i + 1].omega, (qvec3){0, 2.5 * kick / radius, 0}, 1e-10);
        free_log(&log);
        return;
    }
    fail_msg("no rows on either side of the bounce");
}

/* While it rolls on the floor, v = w x r n and 1.4 m a = F - m (k + .4 kw) v: an exponential approach to the drift speed. */
static void rolls_as_the_closed_form_says_and_meets_the_wall_rolling(void **state)
{
    (void)state;
    scene_log log = run_thesis_scene(true, NULL, NULL);
    const int stick = find_event(&log, IMPACT_EVENT_STICK, "roll", 0),
              edge = find_event(&log, IMPACT_EVENT_FORCE, NULL, 0);
    const int wall = find_impact(&log, WALL);
    assert_true(stick >= 0 && edge > stick && wall > edge);
    const double rate = (linear_rate + 0.4 * angular_rate) / 1.4, drift = wind_force / (1.4 * mass) / rate;
    const double from = log.events[stick].t, until = log.events[edge].t;
    double v0 = NAN, v1 = NAN;
    for (int i = 0; i < log.sample_count; i++) {
        const impact_sample *s = &log.samples[i];
        if (s->t < from || (s->t == from && fabs(s->velocity.x - radius * s->omega.y) > 1e-12)) continue;
        if (s->t == from) v0 = s->velocity.x; /* the last of the rows at this time */
        if (s->t > from && s->t <= until)
            assert_near(s->velocity.x, drift + (v0 - drift) * exp(-rate * (s->t - from)), 1e-11);
        if (s->t == until) v1 = s->velocity.x;
        if (s->t > until && s->t < log.events[wall].t)
            assert_near(s->velocity.x, v1 * exp(-rate * (s->t - until)), 1e-11);
        if (s->t >= log.events[wall].t) break;
        assert_at_most(fabs(s->velocity.x - radius * s->omega.y), 1e-12);
    }
    free_log(&log);
}

static void check_penetration_and_energy(bool grips)
{
    impact_energy energy;
    scene_log log = run_thesis_scene(grips, &energy, NULL);
    double last = INFINITY;
    for (int i = 0; i < log.sample_count; i++) {
        const impact_sample *s = &log.samples[i];
        assert_true(s->position.z >= radius - 1e-12 && s->position.x <= -radius + 1e-12);
        assert_near(sqrt(quat_dot(s->orientation, s->orientation)), 1, 1e-15);
        const double kinetic = 0.5 * mass * qvec3_dot(s->velocity, s->velocity) +
                               0.2 * mass * radius * radius * qvec3_dot(s->omega, s->omega);
        const double work = wind_force * (fmin(s->position.x, -1) + 3);
        const double own = kinetic + mass * gravity * s->position.z - work;
        assert_at_most(own - last, 1e-10);
        last = own;
    }
    const double end = energy.kinetic + energy.potential;
    assert_near(end, energy.start + energy.force_work - energy.damping_loss - energy.sliding_loss - energy.impact_loss,
                1e-9);
    assert_near(energy.force_work, wind_force * wind_reach, 1e-10);
    assert_true(energy.damping_loss > 0 && energy.sliding_loss > 0 && energy.impact_loss > 0);
    for (int i = 0; i < log.event_count; i++)
        assert_at_most(log.events[i].energy_after, log.events[i].energy_before + 1e-12);
    free_log(&log);
}

static void never_penetrates_and_never_gains_energy(void **state)
{
    (void)state;
    check_penetration_and_energy(false);
    check_penetration_and_energy(true);
}

/* As the files have it: it slides to the wall, and comes back sliding, then rolling. */
static void comes_back_sliding_and_rolling(void **state)
{
    (void)state;
    scene_log log = run_thesis_scene(false, NULL, NULL);
    const int wall = find_impact(&log, WALL);
    assert_true(wall > 0);
    const int slide = find_event(&log, IMPACT_EVENT_CONTACT, "slide", 1),
              roll = find_event(&log, IMPACT_EVENT_STICK, "roll", 0);
    assert_true(slide > wall && roll > slide);
    for (int i = 0; i < log.sample_count; i++) {
        const impact_sample *s = &log.samples[i];
        if (s->t <= log.events[roll].t) continue;
        assert_at_most(fabs(s->velocity.x - radius * s->omega.y), 1e-15);
        assert_true(s->velocity.x < 0);
    }
    free_log(&log);
}

static void samples_stand_on_the_grid_and_beside_events(void **state)
{
    (void)state;
    scene_log log = run_thesis_scene(false, NULL, NULL);
    int k = 0, beside = 0;
    for (int i = 0; i < log.sample_count; i++) {
        if (i > 0) assert_true(log.samples[i].t >= log.samples[i - 1].t);
        if (log.samples[i].t == k / 24.0) k++;
        for (int e = 0; e < log.event_count; e++) beside += log.samples[i].t == log.events[e].t;
    }
    assert_int_equal(k, 91);
    assert_true(beside >= 2 * log.event_count);
    free_log(&log);
}

static void uses_only_what_it_needs(void **state)
{
    (void)state;
    impact_usage usage;
    scene_log log = run_thesis_scene(false, NULL, &usage);
    assert_int_equal(usage.integrators, 1);
    assert_int_equal(usage.gap_newton + usage.gap_gjk + usage.gap_fallback, 0);
    assert_int_equal(usage.impacts_series + usage.impacts_cvode, 0);
    assert_true(usage.impacts_closed_form > 10 && usage.impacts_closed_form == usage.events[IMPACT_EVENT_IMPACT]);
    assert_int_equal(usage.samples, log.sample_count);
    free_log(&log);
}

static void the_same_bits_on_every_run(void **state)
{
    (void)state;
    scene_log a = run_thesis_scene(false, NULL, NULL), b = run_thesis_scene(false, NULL, NULL);
    assert_int_equal(a.sample_count, b.sample_count);
    for (int i = 0; i < a.sample_count; i++) {
        assert_memory_equal(&a.samples[i].t, &b.samples[i].t, sizeof(double));
        assert_memory_equal(&a.samples[i].position, &b.samples[i].position, sizeof(double) * 13);
    }
    free_log(&a);
    free_log(&b);
}

/* ---- bounces, in closed form throughout ---- */

static void ten_bounces(void **state)
{
    (void)state;
    const double g = 9.80665, e = 0.8, w0 = sqrt(2 * g);
    impact_body_def bodies[2] = {plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 1, 1),
                                 ball_body("ball", (qvec3){0, 0, radius + 1}, 0.25, e)};
    impact_scene_def def = impact_default_scene_def();
    def.bodies = bodies;
    def.body_count = 2;
    def.duration = 60;
    def.output_rate = 0;
    impact_scene *scene = make_scene(&def);
    scene_log log = {0};
    const impact_recorder recorder = log_recorder(&log);
    assert_int_equal(impact_scene_run(scene, &recorder), IMPACT_AT_REST);
    double t = w0 / g, w = w0;
    for (int i = 0; i < 10; i++) {
        assert_near(log.events[i].t, t, 4e-15 * (i + 1));
        assert_near(log.events[i].normal_before, -w, 1e-14 * w0);
        assert_near(log.events[i].normal_after * log.events[i].normal_after / (2 * g), pow(e, 2 * i + 2), 4e-15);
        t += 2 * e * w / g;
        w *= e;
    }
    /* Zeno: all bounces end at w0/g + 2 e w0/(g (1 - e)), but for the tail below the rest height. */
    const int contact = find_event(&log, IMPACT_EVENT_CONTACT, "roll", 0);
    assert_true(contact >= 0);
    const double zeno = w0 / g * (1 + 2 * e / (1 - e)), tail = 2 * sqrt(2 * def.rest_height / g) / (1 - e);
    assert_true(log.events[contact].t < zeno && log.events[contact].t > zeno - tail / e);
    const impact_usage usage = impact_scene_usage(scene);
    assert_int_equal(usage.integrators, 0);
    assert_true(usage.ballistic_flights > 10);
    impact_sample rest;
    assert_int_equal(impact_scene_body(scene, impact_scene_find(scene, "ball"), &rest), IMPACT_OK);
    assert_near3(rest.position, (qvec3){0, 0, radius}, 1e-15);
    assert_true(qvec3_norm(rest.velocity) == 0 && qvec3_norm(rest.omega) == 0);
    free_log(&log);
    impact_scene_destroy(scene);
}

/* ---- slides and rolls with known answers ---- */

/* A ball thrown along the floor without spin slides until t = 2 v0/(7 mu g), then rolls at 5/7 v0 (Coriolis 1835). */
static void bowling_ball(void **state)
{
    (void)state;
    for (int k = 0; k < 8; k++) {
        const double v0 = 0.3 * pow(3, k - 3), mu = 0.05 + 0.1 * k, angle = 0.7 * k;
        impact_body_def bodies[2] = {plane_body("lane", (qvec3){0, 0, 0}, quat_identity(), 1, 0),
                                     ball_body("ball", (qvec3){0, 0, radius}, mu, 0)};
        bodies[1].velocity = (qvec3){v0 * cos(angle), v0 * sin(angle), 0};
        impact_scene_def def = impact_default_scene_def();
        def.gravity = (qvec3){0, 0, -gravity};
        def.bodies = bodies;
        def.body_count = 2;
        const double t = 2 * v0 / (7 * mu * gravity);
        def.duration = 2 * t;
        impact_scene *scene = make_scene(&def);
        scene_log log = {0};
        const impact_recorder recorder = log_recorder(&log);
        assert_int_equal(impact_scene_run(scene, &recorder), IMPACT_OK);
        const int stick = find_event(&log, IMPACT_EVENT_STICK, "roll", 0);
        assert_true(stick >= 0);
        assert_near(log.events[stick].t, t, 2e-11 * (1 + 1 / mu));
        impact_sample end;
        impact_scene_body(scene, 1, &end);
        assert_near3(end.velocity, qvec3_scale(bodies[1].velocity, 5.0 / 7), 1e-12 * fmax(1, v0));
        assert_near(qvec3_norm(end.omega), 5.0 / 7 * v0 / radius, 1e-11 * fmax(1, v0));
        const impact_energy energy = impact_scene_energy(scene);
        assert_near(energy.sliding_loss, mass * v0 * v0 / 7, 1e-12 * fmax(1, mass * v0 * v0));
        free_log(&log);
        impact_scene_destroy(scene);
    }
}

/* On an incline of angle a, a ball rolls at 5/7 g sin a when friction allows (mu > 2/7 tan a), and slides at g (sin a - mu cos a) else. */
static void incline(void **state)
{
    (void)state;
    for (int slides = 0; slides < 2; slides++) {
        const double angle = 0.5, mu = slides ? 0.1 : 0.2;
        const quat tilt = {cos(angle / 2), 0, sin(angle / 2), 0};
        const qvec3 normal = quat_rotate(tilt, (qvec3){0, 0, 1}), down = quat_rotate(tilt, (qvec3){1, 0, 0});
        impact_body_def bodies[2] = {plane_body("incline", (qvec3){0, 0, 0}, tilt, 1, 0),
                                     ball_body("ball", qvec3_scale(normal, radius), mu, 0)};
        impact_scene_def def = impact_default_scene_def();
        def.gravity = (qvec3){0, 0, -gravity};
        def.bodies = bodies;
        def.body_count = 2;
        def.duration = 2;
        impact_scene *scene = make_scene(&def);
        assert_int_equal(impact_scene_run(scene, NULL), IMPACT_OK);
        const double a = slides ? gravity * (sin(angle) - mu * cos(angle)) : 5.0 / 7 * gravity * sin(angle);
        const double spin = slides ? 2.5 * mu * gravity * cos(angle) / radius : a / radius;
        impact_sample end;
        impact_scene_body(scene, 1, &end);
        assert_near3(end.position, qvec3_axpy(0.5 * a * 4, down, bodies[1].position), 1e-10);
        assert_near3(end.velocity, qvec3_scale(down, a * 2), 1e-10);
        assert_near3(end.omega, (qvec3){0, spin * 2, 0}, 1e-9);
        impact_scene_destroy(scene);
    }
}

/* It rolls over the floor's edge and falls as a stone. */
static void falls_off_the_edge(void **state)
{
    (void)state;
    impact_body_def bodies[2] = {plane_body("table", (qvec3){0, 0, 0}, quat_identity(), 1, 0),
                                 ball_body("ball", (qvec3){0, 0, radius}, 1, 0)};
    impact_shape_plane(0.5, 2, &bodies[0].shape);
    bodies[1].velocity = (qvec3){1, 0, 0};
    bodies[1].omega = (qvec3){0, 1 / radius, 0};
    impact_scene_def def = impact_default_scene_def();
    def.gravity = (qvec3){0, 0, -gravity};
    def.bodies = bodies;
    def.body_count = 2;
    def.duration = 1;
    impact_scene *scene = make_scene(&def);
    scene_log log = {0};
    const impact_recorder recorder = log_recorder(&log);
    assert_int_equal(impact_scene_run(scene, &recorder), IMPACT_OK);
    const int liftoff = find_event(&log, IMPACT_EVENT_LIFTOFF, NULL, 0);
    assert_true(liftoff >= 0);
    assert_near(log.events[liftoff].t, 0.5, 1e-12);
    impact_sample end;
    impact_scene_body(scene, 1, &end);
    assert_near3(end.position, (qvec3){1, 0, radius - 0.5 * gravity * 0.25}, 1e-11);
    free_log(&log);
    impact_scene_destroy(scene);
}

/* ---- several bodies ---- */

/* Newton's cradle of three, not touching: the last flies off with the first one's velocity. */
static void cradle(void **state)
{
    (void)state;
    impact_body_def bodies[3] = {ball_body("a", (qvec3){0, 0, 0}, 0, 1), ball_body("b", (qvec3){1, 0, 0}, 0, 1),
                                 ball_body("c", (qvec3){1.7, 0, 0}, 0, 1)};
    bodies[0].velocity = (qvec3){2, 0, 0};
    impact_scene_def def = impact_default_scene_def();
    def.gravity = (qvec3){0, 0, 0};
    def.bodies = bodies;
    def.body_count = 3;
    impact_scene *scene = make_scene(&def);
    assert_int_equal(impact_scene_run(scene, NULL), IMPACT_OK);
    const double x[3] = {0.4, 1.1, 1.7 + 2 * (1 - 0.25)}, v[3] = {0, 0, 2};
    for (int i = 0; i < 3; i++) {
        impact_sample s;
        impact_scene_body(scene, i, &s);
        assert_near3(s.position, (qvec3){x[i], 0, 0}, 1e-14);
        assert_near3(s.velocity, (qvec3){v[i], 0, 0}, 1e-14);
    }
    const impact_usage usage = impact_scene_usage(scene);
    assert_int_equal(usage.integrators, 0);
    assert_int_equal(usage.events[IMPACT_EVENT_IMPACT], 2);
    impact_scene_destroy(scene);
}

/* Two bodies that fall towards each other under Newton's attraction alone, from rest a distance d apart: they meet at
 * t = sqrt(d^3/(2 G (m1 + m2))) (acos(sqrt(x)) + sqrt(x (1 - x))), x = 2 r/d. */
static void fall_by_attraction(void **state)
{
    (void)state;
    const double d = 3, G = 0.5, x = 2 * radius / d;
    impact_body_def bodies[2] = {ball_body("a", (qvec3){0, 0, 0}, 0, 0.5), ball_body("b", (qvec3){0, d, 0}, 0, 0.5)};
    impact_force_def attraction = impact_default_force_def(IMPACT_FORCE_ATTRACTION);
    attraction.constant = G;
    impact_scene_def def = impact_default_scene_def();
    def.gravity = (qvec3){0, 0, 0};
    def.bodies = bodies;
    def.body_count = 2;
    def.forces = &attraction;
    def.force_count = 1;
    const double t = sqrt(d * d * d / (2 * G * 2 * mass)) * (acos(sqrt(x)) + sqrt(x * (1 - x)));
    def.duration = 1.01 * t;
    def.restitution_rule = IMPACT_MAXIMUM;
    impact_scene *scene = make_scene(&def);
    scene_log log = {0};
    const impact_recorder recorder = log_recorder(&log);
    assert_int_equal(impact_scene_run(scene, &recorder), IMPACT_OK);
    assert_near(log.events[0].t, t, 1e-10);
    const double speed = sqrt(2 * G * 2 * mass * (1 / (2 * radius) - 1 / d));
    assert_near(log.events[0].normal_before, -speed, 1e-10);
    assert_near(log.events[0].normal_after, 0.5 * speed, 1e-10);
    const impact_energy energy = impact_scene_energy(scene);
    assert_near(energy.kinetic + energy.potential, energy.start - energy.impact_loss, 1e-9);
    free_log(&log);
    impact_scene_destroy(scene);
}

/* The whole scene turned by a rotation, and its bodies in another order, gives the turned answer. */
static void invariant_under_rotation_and_order(void **state)
{
    (void)state;
    quat turn;
    quat_normalize((quat){0.3, -0.7, 0.2, 0.5}, &turn);
    impact_sample ends[2];
    for (int turned = 0; turned < 2; turned++) {
        const quat r = turned ? turn : quat_identity();
        const int ball = turned ? 1 : 0, other = turned ? 0 : 1;
        impact_body_def bodies[3] = {[2] = plane_body("floor", (qvec3){0, 0, 0}, r, 0.4, 0.7)};
        bodies[ball] = ball_body("ball", quat_rotate(r, (qvec3){0, 0, 1}), 0.6, 0.8);
        bodies[ball].velocity = quat_rotate(r, (qvec3){1, 0.3, 0});
        bodies[ball].omega = quat_rotate(r, (qvec3){3, -8, 11});
        bodies[other] = ball_body("other", quat_rotate(r, (qvec3){1.2, 0.2, 0.3}), 0.5, 0.8);
        impact_scene_def def = impact_default_scene_def();
        def.gravity = quat_rotate(r, (qvec3){0, 0, -gravity});
        def.bodies = bodies;
        def.body_count = 3;
        def.duration = 0.9;
        impact_scene *scene = make_scene(&def);
        assert_int_equal(impact_scene_run(scene, NULL), IMPACT_OK);
        impact_scene_body(scene, impact_scene_find(scene, "ball"), &ends[turned]);
        const impact_usage usage = impact_scene_usage(scene);
        assert_true(usage.events[IMPACT_EVENT_IMPACT] >= 2);
        impact_scene_destroy(scene);
    }
    assert_near3(ends[1].position, quat_rotate(turn, ends[0].position), 1e-12);
    assert_near3(ends[1].velocity, quat_rotate(turn, ends[0].velocity), 1e-11);
    assert_near3(ends[1].omega, quat_rotate(turn, ends[0].omega), 1e-10);
}

/* ---- running on, stopping, bad input ---- */

static void in_pieces_as_in_one(void **state)
{
    (void)state;
    thesis_scene *s = make_thesis_scene(false);
    impact_scene *whole = make_scene(&s->def), *pieces = make_scene(&s->def);
    free(s);
    assert_int_equal(impact_scene_run(whole, NULL), IMPACT_OK);
    for (int k = 1; k <= 15; k++) assert_int_equal(impact_scene_run_to(pieces, 0.25 * k, NULL), IMPACT_OK);
    impact_sample a, b;
    impact_scene_body(whole, BALL, &a);
    impact_scene_body(pieces, BALL, &b);
    assert_near3(a.position, b.position, 1e-11);
    assert_near3(a.velocity, b.velocity, 1e-11);
    impact_scene_destroy(whole);
    impact_scene_destroy(pieces);
}

static bool stop_late(void *context, double t, double t_end)
{
    (void)context;
    return t < 0.5 * t_end;
}

static bool refuse(void *context, const impact_sample *sample)
{
    (void)context;
    return sample->t < 1;
}

static void stops_when_asked(void **state)
{
    (void)state;
    thesis_scene *s = make_thesis_scene(false);
    impact_scene *scene = make_scene(&s->def);
    free(s);
    const impact_recorder stopper = {.progress = stop_late}, refuser = {.sample = refuse};
    assert_int_equal(impact_scene_run(scene, &stopper), IMPACT_STOPPED);
    const double t = impact_scene_time(scene);
    assert_true(t > 0.5 * 3.75 && t < 3.75);
    assert_int_equal(impact_scene_run(scene, &refuser), IMPACT_ESINK);
    assert_int_equal(impact_scene_run(scene, NULL), IMPACT_OK);
    assert_true(impact_scene_time(scene) == 3.75);
    impact_scene_destroy(scene);
}

static bool not_a_number(double t, int body, double m, qvec3 x, quat q, qvec3 v, qvec3 w, qvec3 *force, qvec3 *torque,
                         void *context)
{
    (void)body, (void)m, (void)x, (void)q, (void)v, (void)w, (void)torque, (void)context;
    if (t > 0.1) force->x = NAN;
    return true;
}

static void a_force_that_is_no_number_stops_the_run(void **state)
{
    (void)state;
    impact_body_def body = ball_body("ball", (qvec3){0, 0, 1}, 0, 0);
    impact_force_def force = impact_default_force_def(IMPACT_FORCE_CUSTOM);
    force.function = not_a_number;
    impact_scene_def def = impact_default_scene_def();
    def.bodies = &body;
    def.body_count = 1;
    def.forces = &force;
    def.force_count = 1;
    impact_scene *scene = make_scene(&def);
    assert_true(impact_scene_run(scene, NULL) < 0);
    assert_non_null(strstr(impact_scene_message(scene), "body 'ball': the force on it is not finite"));
    impact_scene_destroy(scene);
}

static void expect_refusal(const impact_scene_def *def, const char *wanted)
{
    char message[256];
    impact_scene *scene;
    assert_true(impact_scene_create(def, &scene, message, sizeof message) < 0);
    assert_null(scene);
    if (strcmp(message, wanted) != 0) fail_msg("wanted \"%s\", got \"%s\"", wanted, message);
}

static void bad_definitions_are_named(void **state)
{
    (void)state;
    impact_body_def bodies[2] = {plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 1, 0),
                                 ball_body("coin", (qvec3){0, 0, 1}, 1, 0)};
    impact_scene_def def = impact_default_scene_def();
    def.bodies = bodies;
    def.body_count = 2;
    bodies[1].mass = -4;
    expect_refusal(&def, "body 'coin': mass = -4: must be positive and finite");
    bodies[1] = ball_body("coin", (qvec3){0, 0, 1}, 1, 0);
    bodies[1].position.y = NAN;
    expect_refusal(&def, "body 'coin': position.y = nan: must be finite");
    bodies[1] = ball_body("coin", (qvec3){0, 0, 1}, 1, 0);
    bodies[1].shape = (impact_shape){IMPACT_SUPERQUADRIC, 1, 1, 1, 2, 0.5, 2};
    expect_refusal(&def, "body 'coin': exponent s = 0.5 < 1 is not convex");
    bodies[1] = ball_body("floor", (qvec3){0, 0, 1}, 1, 0);
    expect_refusal(&def, "body 'floor': the name is taken by another body");
    bodies[1] = ball_body("coin", (qvec3){0, 0, 0.25}, 1, 0);
    expect_refusal(&def, "body 'coin': overlaps 'floor' by 0.05 m at the start");
    bodies[1] = ball_body("coin", (qvec3){0, 0, 1}, -0.5, 0);
    expect_refusal(&def, "body 'coin': friction = -0.5: must be >= 0 and finite");
    bodies[1] = ball_body("coin", (qvec3){0, 0, 1}, 1, 1.5);
    expect_refusal(&def, "body 'coin': restitution = 1.5: must lie in [0, 1]");
    bodies[1] = ball_body("coin", (qvec3){0, 0, 1}, 1, 0);
    bodies[1].moments = (qvec3){1, 1, 3};
    expect_refusal(&def,
                   "body 'coin': moments = 3: is larger than the other two together: no rigid body has such moments");
    bodies[1] = ball_body("coin", (qvec3){0, 0, 1}, 1, 0);
    bodies[0].is_static = false;
    expect_refusal(&def, "body 'floor': a plane must be static");
    bodies[0].is_static = true;
    def.duration = -1;
    expect_refusal(&def, "scene 'scene': duration = -1: must be positive and finite");
    def.duration = 1;
    def.compliance = 3.5;
    expect_refusal(&def, "scene 'scene': compliance = 3.5: needs Stronge's law");
    def.compliance = NAN;
    expect_refusal(&def, "scene 'scene': compliance = nan: must be >= 0 and finite");
    def.compliance = 0;
    const impact_pair_def pair = {"coin", "flor", 0.5, NAN};
    def.pairs = &pair;
    def.pair_count = 1;
    expect_refusal(&def, "pair with 'flor': the scene has no such body");
}

static void a_build_without_cvode_says_so(void **state)
{
    (void)state;
    thesis_scene *s = make_thesis_scene(false);
    impact_scene *scene = make_scene(&s->def);
    assert_int_equal(impact_scene_run(scene, NULL), IMPACT_EABSENT);
    assert_non_null(strstr(impact_scene_message(scene), "CVODE"));
    impact_scene_destroy(scene);
    free(s);
}

/* A superellipsoid that is flat along an axis passes that spot faster than the integrator sees: the run says so itself. */
static void an_account_that_does_not_close_is_told(void **state)
{
    (void)state;
    impact_body_def bodies[2] = {plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 0.5, 1),
                                 ball_body("die", (qvec3){0, 0, 1}, 0.5, 0.8)};
    assert_int_equal(impact_shape_superellipsoid(0.1, 0.2, 0.15, 0.5, 0.8, &bodies[1].shape), IMPACT_OK);
    bodies[1].omega = (qvec3){1, 2, 3};
    impact_scene_def def = impact_default_scene_def();
    def.bodies = bodies;
    def.body_count = 2;
    def.duration = 2;
    impact_scene *scene = make_scene(&def);
    const impact_status status = impact_scene_run(scene, NULL);
    const impact_energy e = impact_scene_energy(scene);
    const double off =
        e.kinetic + e.potential - (e.start + e.force_work - e.damping_loss - e.sliding_loss - e.impact_loss);
    if (status == IMPACT_SOFT)
        assert_non_null(strstr(impact_scene_message(scene), "the energy account is off by"));
    else
        assert_at_most(fabs(off), 1.1e-8 * e.start);
    impact_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest closed_forms[] = {
        cmocka_unit_test(ten_bounces),
        cmocka_unit_test(cradle),
        cmocka_unit_test(an_account_that_does_not_close_is_told),
        cmocka_unit_test(bad_definitions_are_named),
    };
    const struct CMUnitTest integrated[] = {
        cmocka_unit_test(first_bounce_is_where_the_closed_form_puts_it),
        cmocka_unit_test(rolls_as_the_closed_form_says_and_meets_the_wall_rolling),
        cmocka_unit_test(never_penetrates_and_never_gains_energy),
        cmocka_unit_test(comes_back_sliding_and_rolling),
        cmocka_unit_test(samples_stand_on_the_grid_and_beside_events),
        cmocka_unit_test(uses_only_what_it_needs),
        cmocka_unit_test(the_same_bits_on_every_run),
        cmocka_unit_test(bowling_ball),
        cmocka_unit_test(incline),
        cmocka_unit_test(falls_off_the_edge),
        cmocka_unit_test(fall_by_attraction),
        cmocka_unit_test(invariant_under_rotation_and_order),
        cmocka_unit_test(in_pieces_as_in_one),
        cmocka_unit_test(stops_when_asked),
        cmocka_unit_test(a_force_that_is_no_number_stops_the_run),
    };
    const struct CMUnitTest absent[] = {cmocka_unit_test(a_build_without_cvode_says_so)};
    const int failed = cmocka_run_group_tests(closed_forms, NULL, NULL);
    if (!impact_has(IMPACT_PART_CVODE)) return failed + cmocka_run_group_tests(absent, NULL, NULL);
    return failed + cmocka_run_group_tests(integrated, NULL, NULL);
}
