/* SPDX-License-Identifier: MIT
 *
 * Whole scenes: the thesis' sphere, floor and wall; running on, stopping, and definitions that are refused.
 */
#include "kit/scene_log.h"

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

/* As the authors' files have it, the pairs' friction is .25 x .25, and the sphere slides to the wall: to roll under the
 * wind it would need 2/7 F/(m g) = .18 and more for the damping of its spin. grips: the same with a friction of .5 for
 * both pairs. */
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
    s->grip[0] = (impact_pair_def){sizeof(impact_pair_def), "sphere", "floor", 0.5, NAN, NAN, NAN, NAN};
    s->grip[1] = (impact_pair_def){sizeof(impact_pair_def), "sphere", "wall", 0.5, NAN, NAN, NAN, NAN};
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

/* While it rolls on the floor, v = w x r n and 1.4 m a = F - m (k + .4 kw) v: an exponential approach to the drift
 * speed. */
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
    assert_in_range(usage.integrators, 1,
                    6); /* one for each number of contacts that the ball has had, and for flight */
    assert_int_equal(usage.gap_newton + usage.gap_gjk + usage.gap_fallback, 0);
    assert_int_equal(usage.impacts_series + usage.impacts_cvode, 0);
    assert_true(usage.impacts_closed_form > 10 && usage.impacts_closed_form == usage.events[IMPACT_EVENT_IMPACT]);
    assert_int_equal(usage.samples, log.sample_count);
    free_log(&log);
}

/* A loose tolerance makes a run no longer, changes no event, and errs by what it says. */
static void a_loose_tolerance_costs_no_more(void **state)
{
    (void)state;
    impact_usage first = {0};
    qvec3 end = {0, 0, 0};
    for (int digits = 13; digits >= 2; digits--) {
        thesis_scene *s = make_thesis_scene(false);
        s->def.tolerance = pow(10, -digits);
        impact_scene *scene = make_scene(&s->def);
        const impact_status status = impact_scene_run(scene, NULL);
        assert_true(status == IMPACT_OK || status == IMPACT_SOFT);
        impact_sample ball;
        assert_int_equal(impact_scene_body(scene, BALL, &ball), IMPACT_OK);
        const impact_usage usage = impact_scene_usage(scene);
        if (digits == 13) first = usage;
        assert_memory_equal(usage.events, first.events, sizeof first.events);
        if (digits < 13) {
            assert_true((double)usage.integrator_rhs_calls <
                        1.1 * (double)first.integrator_rhs_calls); /* slip has a closeness of its own */
            assert_near3(ball.position, end, 10 * s->def.tolerance);
        } else
            end = ball.position;
        impact_scene_destroy(scene);
        free(s);
    }
}

/* The tolerance says from which speed on slip is slip, but not which impacts are impacts: in flight there is nothing to
 * tolerate. */
static void a_loose_tolerance_lets_nothing_fall_through(void **state)
{
    (void)state;
    double loss = 0;
    for (int digits = 13; digits >= 2; digits--) {
        impact_body_def bodies[2] = {plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 1, 1),
                                     ball_body("egg", (qvec3){0, 0, 1}, 0.5, 0.5)};
        impact_shape_ellipsoid(0.1, 0.13, 0.07, &bodies[1].shape);
        bodies[1].velocity = (qvec3){1, 0, 0};
        bodies[1].omega = (qvec3){1, 2, 3};
        bodies[1].mass = 1;
        bodies[1].moments = (qvec3){NAN, NAN, NAN};
        impact_scene_def def = impact_default_scene_def();
        def.duration = 2;
        def.bodies = bodies;
        def.body_count = 2;
        def.max_events = 100; /* it takes 19 */
        def.tolerance = pow(10, -digits);
        impact_scene *scene = make_scene(&def);
        assert_int_equal(impact_scene_run(scene, NULL), IMPACT_OK);
        const double now = impact_scene_energy(scene).impact_loss;
        if (digits < 13)
            assert_near(now, loss, 1e-9);
        else
            loss = now;
        impact_scene_destroy(scene);
    }
}

/* A heavy ball falls on a light one that lies on the floor: what sweeps of impulses would take millions of is solved at
 * once. */
static void a_heavy_ball_on_a_light_one(void **state)
{
    (void)state;
    for (int digits = 1; digits <= 12; digits++) {
        impact_body_def bodies[3] = {plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 1, 1),
                                     ball_body("light", (qvec3){0, 0, 0.1}, 0.5, 0.5),
                                     ball_body("heavy", (qvec3){0.02, 0, 1.8}, 0.5, 0.5)};
        impact_shape_sphere(0.1, &bodies[1].shape);
        impact_shape_sphere(1, &bodies[2].shape);
        for (int k = 1; k < 3; k++) bodies[k].moments = (qvec3){NAN, NAN, NAN};
        bodies[1].mass = 1;
        bodies[2].mass = pow(10, digits);
        impact_scene_def def = impact_default_scene_def();
        def.duration = 0.5;
        def.bodies = bodies;
        def.body_count = 3;
        def.max_events = 200;
        impact_scene *scene = make_scene(&def);
        assert_int_equal(impact_scene_run(scene, NULL), IMPACT_OK);
        impact_sample light, heavy;
        impact_scene_body(scene, 1, &light);
        impact_scene_body(scene, 2, &heavy);
        assert_true(light.position.z > 0.1 - 1e-9);
        assert_true(qvec3_norm(qvec3_sub(heavy.position, light.position)) > 1.1 - 1e-9);
        impact_scene_destroy(scene);
    }
}

/* An egg of a micrometre rocks on for hundreds of thousands of steps: what is held must not drift off, nor the energy
 * with it. */
static void what_is_held_for_long_does_not_drift(void **state)
{
    (void)state;
    impact_body_def bodies[2] = {plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 1, 1),
                                 ball_body("egg", (qvec3){0, 0, 1e-5}, 0.5, 0.7)};
    impact_shape_ellipsoid(1e-6, 1.3e-6, 0.7e-6, &bodies[1].shape);
    bodies[1].moments = (qvec3){NAN, NAN, NAN};
    bodies[1].velocity = (qvec3){1e-6, 0, 0};
    bodies[1].omega = (qvec3){1, 2, 3};
    impact_scene_def def = impact_default_scene_def();
    def.duration = 1;
    def.bodies = bodies;
    def.body_count = 2;
    impact_scene *scene = make_scene(&def);
    assert_int_equal(impact_scene_run(scene, NULL), IMPACT_OK);
    const impact_energy e = impact_scene_energy(scene);
    assert_near(e.kinetic + e.potential + e.sliding_loss + e.impact_loss, e.start, 1e-9 * e.start);
    impact_scene_destroy(scene);
}

/* An ellipsoid of tens of metres, whose angular momentum about the vertical is almost none of all there is: to tell
 * that from zero once took a million steps. The same in lengths of a sixtieth of it, and times of the square root of
 * that, goes alike. */
static void large_bodies_move_as_small_ones(void **state)
{
    (void)state;
    impact_scene *scenes[2];
    impact_sample end[2];
    const double lengths[2] = {1, 1.0 / 60};
    for (int k = 0; k < 2; k++) {
        const double L = lengths[k], T = sqrt(L);
        impact_body_def bodies[2] = {plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 0, 0.5),
                                     ball_body("egg", (qvec3){0, 0, 39.159066715677 * L}, 0.3, 1)};
        impact_shape_ellipsoid(64.89520554379774 * L, 42.074155745474116 * L, 38.107243057485206 * L, &bodies[1].shape);
        bodies[1].mass = NAN;
        bodies[1].moments = (qvec3){NAN, NAN, NAN};
        bodies[1].velocity = (qvec3){34.3412 * T, 39.9053 * T, -5.4039337343566 * T};
        bodies[1].omega = (qvec3){-0.51640225199062 / T, 0.043625983301985 / T, 0.015997566950121 / T};
        bodies[1].orientation = (quat){0.029778171287852, -0.53930940822995, -0.83484122275208, -0.10629560434576};
        impact_scene_def def = impact_default_scene_def();
        def.duration = 0.02 * T;
        def.bodies = bodies;
        def.body_count = 2;
        scenes[k] = make_scene(&def);
        assert_int_equal(impact_scene_run(scenes[k], NULL), IMPACT_OK);
        impact_scene_body(scenes[k], 1, &end[k]);
        end[k].velocity = qvec3_scale(end[k].velocity, 1 / T);
    }
    assert_near3(end[0].velocity, end[1].velocity, 1e-10);
    assert_true(impact_scene_usage(scenes[0]).integrator_steps <= 2 * impact_scene_usage(scenes[1]).integrator_steps);
    for (int k = 0; k < 2; k++) impact_scene_destroy(scenes[k]);
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

/* ---- running on, stopping, bad input ---- */

static void in_pieces_as_in_one(void **state)
{
    (void)state;
    thesis_scene *s = make_thesis_scene(false);
    impact_scene *whole = make_scene(&s->def), *pieces = make_scene(&s->def);
    free(s);
    assert_int_equal(impact_scene_run(whole, NULL), IMPACT_OK);
    for (int k = 1; k <= 15; k++) assert_int_equal(impact_scene_run_to(pieces, 0.25 * k, NULL), IMPACT_OK);
    assert_int_equal(impact_scene_run_to(pieces, 3.5, NULL), IMPACT_EARGUMENT); /* time does not go back */
    assert_string_equal(impact_scene_message(pieces), "t = 3.5 is over: the scene stands at 3.75 s");
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
    const impact_recorder stopper = {.struct_size = sizeof stopper, .progress = stop_late},
                          refuser = {.struct_size = sizeof refuser, .sample = refuse};
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
    bodies[1].shape = (impact_shape){.kind = IMPACT_SUPERQUADRIC, .a = 1, .b = 1, .c = 1, .r = 2, .s = 0.5, .t = 2};
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
    bodies[1].rolling_friction = -0.5;
    expect_refusal(&def, "body 'coin': rolling_friction = -0.5: must be a length, >= 0 and finite");
    bodies[1].rolling_friction = 0, bodies[1].torsional_friction = NAN;
    expect_refusal(&def, "body 'coin': torsional_friction = nan: must be a length, >= 0 and finite");
    bodies[1] = ball_body("coin", (qvec3){0, 0, 1}, 1, 0);
    bodies[1].moments = (qvec3){1, 1, 3};
    expect_refusal(&def,
                   "body 'coin': moments = 3: is larger than the other two together: no rigid body has such moments");
    bodies[1] = ball_body("coin", (qvec3){0, 0, 1}, 1, 0);
    bodies[1].shape_position.z = 0.01;
    expect_refusal(&def,
                   "body 'coin': give moments: its shape stands aside of the centre of mass or of the principal axes");
    bodies[1].moments = (qvec3){1, 1, 1};
    bodies[1].shape_orientation = (quat){0, 0, 0, 0};
    expect_refusal(&def, "body 'coin': shape_orientation must be a finite quaternion that is not zero");
    bodies[1] = ball_body("coin", (qvec3){0, 0, 1}, 1, 0);
    bodies[0].shape_position.z = 0.01;
    expect_refusal(&def, "body 'floor': a plane takes no shape_position or shape_orientation");
    bodies[0].shape_position.z = 0;
    bodies[0].is_static = false;
    expect_refusal(&def, "body 'floor': a plane must be static");
    bodies[0].is_static = true;
    def.duration = -1;
    expect_refusal(&def, "scene 'scene': duration = -1: must be positive and finite");
    def.duration = 1;
    bodies[1].shape = (impact_shape){.kind = IMPACT_SPHERE, .a = 1e-110, .b = 1e-110, .c = 1e-110};
    bodies[1].mass = NAN;
    expect_refusal(&def,
                   "body 'coin': mass = 0: of this size and density lies beyond double precision: take other units");
    bodies[1] = ball_body("coin", (qvec3){0, 0, 1}, 1, 0);
    bodies[1].velocity.x = 1e300;
    expect_refusal(&def, "scene 'scene': its energy lies beyond double precision: take other units");
    bodies[1].velocity.x = 0;
    impact_force_def wind = impact_default_force_def(IMPACT_FORCE_WIND);
    wind.name = "gust";
    wind.body = "cone";
    def.forces = &wind;
    def.force_count = 1;
    expect_refusal(&def, "force 'gust': acts on body 'cone', which the scene does not have");
    wind.body = bodies[0].name;
    expect_refusal(&def, "force 'gust': acts on body 'floor', which is static: nothing moves it");
    def.force_count = 0;
    def.compliance = 3.5;
    expect_refusal(&def, "scene 'scene': compliance = 3.5: needs Stronge's law");
    def.compliance = NAN;
    expect_refusal(&def, "scene 'scene': compliance = nan: must be >= 0 and finite");
    def.compliance = 0;
    const impact_pair_def pair = {sizeof pair, "coin", "flor", 0.5, NAN, NAN, NAN, NAN};
    def.pairs = &pair;
    def.pair_count = 1;
    expect_refusal(&def, "pair with 'flor': the scene has no such body");
    const impact_pair_def rough = {sizeof rough, "coin", "floor", 0.5, NAN, NAN, NAN, -1};
    def.pairs = &rough;
    expect_refusal(&def, "pair with 'floor': rolling_friction = -1: must be a length, >= 0 and finite");
}

static bool brake(double t, int body, double m, qvec3 x, quat q, qvec3 v, qvec3 w, qvec3 *force, qvec3 *torque,
                  void *context)
{
    (void)t, (void)body, (void)x, (void)q, (void)w, (void)torque, (void)context;
    *force = qvec3_scale(v, -1e6 * m);
    return true;
}

/* What is not stiff needs none. */
static void a_build_without_cvode_says_so(void **state)
{
    (void)state;
    thesis_scene *s = make_thesis_scene(false);
    impact_scene *scene = make_scene(&s->def);
    assert_int_equal(impact_scene_run(scene, NULL), IMPACT_OK);
    impact_scene_destroy(scene);
    free(s);
    const impact_body_def ball = ball_body("ball", (qvec3){0, 0, 1}, 0.1, 1);
    impact_force_def force = impact_default_force_def(IMPACT_FORCE_CUSTOM);
    force.function = brake;
    impact_scene_def def = impact_default_scene_def();
    def.bodies = &ball, def.body_count = 1, def.forces = &force, def.force_count = 1;
    scene = make_scene(&def);
    assert_int_equal(impact_scene_run(scene, NULL), IMPACT_EABSENT);
    assert_non_null(strstr(impact_scene_message(scene), "CVODE"));
    impact_scene_destroy(scene);
}

/* A superellipsoid that is flat along an axis passes that spot faster than the integrator sees: the run says so itself.
 */
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
        cmocka_unit_test(a_loose_tolerance_costs_no_more),
        cmocka_unit_test(a_loose_tolerance_lets_nothing_fall_through),
        cmocka_unit_test(a_heavy_ball_on_a_light_one),
        cmocka_unit_test(what_is_held_for_long_does_not_drift),
        cmocka_unit_test(large_bodies_move_as_small_ones),
        cmocka_unit_test(the_same_bits_on_every_run),
        cmocka_unit_test(in_pieces_as_in_one),
        cmocka_unit_test(stops_when_asked),
        cmocka_unit_test(a_force_that_is_no_number_stops_the_run),
    };
    const struct CMUnitTest absent[] = {cmocka_unit_test(a_build_without_cvode_says_so)};
    const int failed = cmocka_run_group_tests(closed_forms, NULL, NULL);
    if (!impact_has(IMPACT_PART_CVODE)) return failed + cmocka_run_group_tests(absent, NULL, NULL);
    return failed + cmocka_run_group_tests(integrated, NULL, NULL);
}
