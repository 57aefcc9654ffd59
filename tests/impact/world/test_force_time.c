/* SPDX-License-Identifier: MIT
 *
 * Custom forces that steps could pass over, that jump, that have no bound, that brake hard; against closed forms,
 * through the public interface alone.
 */
#include "kit/contact_random.h"
#include "kit/scene_ending.h"

static const double pi = 3.14159265358979323846;

/* ---- forces that steps could pass over ---- */

/* A hill of potential height exp(-(x/width)^2), along x. */
typedef struct hill {
    double height, width;
} hill;

static bool hill_force(double t, int body, double mass, qvec3 x, quat q, qvec3 v, qvec3 w, qvec3 *force, qvec3 *torque,
                       void *context)
{
    (void)t, (void)body, (void)mass, (void)q, (void)v, (void)w, (void)torque;
    const hill *h = context;
    const double s = x.x / h->width;
    force->x = 2 * h->height * s / h->width * exp(-s * s);
    return true;
}

static impact_force_def custom(impact_force_function *function, void *context)
{
    impact_force_def force = impact_default_force_def(IMPACT_FORCE_CUSTOM);
    force.function = function;
    force.context = context;
    return force;
}

/* Higher than its energy, a ball comes back as fast as it came; lower, it goes on as fast as it came. */
static void no_hill_is_passed_over(void **state)
{
    (void)state;
    random_stream random = {31};
    for (int i = 0; i < 60; i++) {
        const double speed = random_log(&random, 0.1, 10), radius = random_log(&random, 1e-3, 0.1);
        const bool stops = i & 1;
        hill h = {0.5 * speed * speed * (stops ? 1.2 + random_unit(&random) : 0.3 + 0.5 * random_unit(&random)),
                  random_log(&random, 2 * radius, 0.3)};
        const impact_body_def body = ball("ball", radius, (qvec3){-2, 0, 0}, (qvec3){speed, 0, 0});
        const impact_force_def force = custom(hill_force, &h);
        impact_scene_def def = scene_of(&body, 1, 4 / speed);
        def.gravity = (qvec3){0, 0, 0};
        def.forces = &force;
        def.force_count = 1;
        const ending e = run(&def);
        assert_good(&e);
        assert_near(e.body.velocity.x, stops ? -speed : speed, 1e-10 * speed);
    }
}

/* A bell of force in time, F exp(-((t - at)/width)^2), of impulse F width sqrt(pi). */
typedef struct bell {
    qvec3 peak;
    double at, width;
} bell;

static bool bell_force(double t, int body, double mass, qvec3 x, quat q, qvec3 v, qvec3 w, qvec3 *force, qvec3 *torque,
                       void *context)
{
    (void)body, (void)mass, (void)x, (void)q, (void)v, (void)w, (void)torque;
    const bell *b = context;
    const double s = (t - b->at) / b->width;
    *force = qvec3_scale(b->peak, exp(-s * s));
    return true;
}

static void no_pulse_is_passed_over(void **state)
{
    (void)state;
    random_stream random = {32};
    for (int i = 0; i < 40; i++) {
        const double width = random_log(&random, 1e-3, 0.05);
        bell b = {random_vector(&random, 0.1, 100), 0.35 + 0.3 * random_unit(&random), width};
        const impact_body_def body = ball("ball", 0.1, (qvec3){0, 0, 0}, (qvec3){0, 0, 0});
        const impact_force_def force = custom(bell_force, &b);
        impact_scene_def def = scene_of(&body, 1, 1);
        def.gravity = (qvec3){0, 0, 0};
        def.forces = &force;
        def.force_count = 1;
        const ending e = run(&def);
        assert_good(&e);
        const qvec3 wanted = qvec3_scale(b.peak, width * sqrt(pi));
        assert_near3(e.body.velocity, wanted, 1e-10 * (1 + qvec3_norm(wanted)));
    }
}

/* Methods that ask a force at the ends of their steps alone: both thirds of a step are asked as well, so that nothing
 * lies farther than a sixth of it from where it is looked for, four widths of the bell. */
static void pulses_between_the_ends_of_steps_are_seen(void **state)
{
    (void)state;
    if (!impact_has(IMPACT_PART_CVODE)) skip();
    random_stream random = {35};
    for (int i = 0; i < 60; i++) {
        const double longest = random_log(&random, 0.01, 0.1), width = longest / 24;
        bell b = {random_vector(&random, 1, 100), 0.35 + 0.3 * random_unit(&random), width};
        const impact_body_def body = ball("ball", 0.1, (qvec3){0, 0, 0}, (qvec3){0, 0, 0});
        impact_force_def force = custom(bell_force, &b);
        force.max_step = longest;
        impact_scene_def def = scene_of(&body, 1, 1);
        def.gravity = (qvec3){0, 0, 0};
        def.methods.motion = IMPACT_MOTION_CVODE;
        def.forces = &force;
        def.force_count = 1;
        const ending e = run(&def);
        assert_good(&e);
        const qvec3 wanted = qvec3_scale(b.peak, width * sqrt(pi));
        assert_near3(e.body.velocity, wanted, 1e-10 * (1 + qvec3_norm(wanted)));
    }
}

/* Switches are a law's own: wind that is given some has none, whatever their number. */
static void wind_has_no_switches(void **state)
{
    (void)state;
    static const double never[2] = {NAN, NAN};
    ending e[2];
    for (int k = 0; k < 2; k++) {
        const impact_body_def body = ball("ball", 0.1, (qvec3){0, 0, 0}, (qvec3){0, 0, 0});
        impact_force_def wind = impact_default_force_def(IMPACT_FORCE_WIND);
        wind.name = "wind", wind.strength = 5;
        if (k) wind.switches = never, wind.switch_count = 1000000000;
        impact_scene_def def = scene_of(&body, 1, 1);
        def.forces = &wind;
        def.force_count = 1;
        e[k] = run(&def);
        assert_good(&e[k]);
    }
    assert_memory_equal(&e[0].body.position, &e[1].body.position, sizeof(qvec3));
}

/* What lies at rest on the floor is found by a later push: along the floor a ball then rolls, with 5/7 of the impulse;
 * a box on a floor without friction slides with all of it. */
static void what_rests_wakes(void **state)
{
    (void)state;
    random_stream random = {33};
    for (int i = 0; i < 24; i++) {
        const bool rolls = i & 1;
        const double width = random_log(&random, 2e-3, 0.05), size = random_log(&random, 0.05, 1);
        bell b = {{random_log(&random, 1, 20), 0, 0}, 0.6, width};
        impact_body_def bodies[2] = {floor_body(1, 0), ball("ball", size, (qvec3){0, 0, size}, (qvec3){0, 0, 0})};
        if (!rolls) {
            bodies[1] = box("box", (qvec3){size, size, size}, 4, (qvec3){0, 0, size}, 0);
            bodies[1].mass = 1;
        }
        bodies[1].friction = rolls ? 4 : 0;
        const impact_force_def force = custom(bell_force, &b);
        impact_scene_def def = scene_of(bodies, 2, 1);
        def.forces = &force;
        def.force_count = 1;
        const ending e = run(&def);
        assert_good(&e);
        assert_true(e.t == 1 && e.usage.events[IMPACT_EVENT_REST] >= 1);
        const double impulse = b.peak.x * width * sqrt(pi);
        assert_near(e.body.velocity.x, rolls ? impulse * 5 / 7 : impulse, 1e-9 * (1 + impulse));
        assert_near(e.body.position.z, size, 1e-9 * size);
    }
}

/* A force that says it is steady lets rest be rest. */
static void under_a_steady_force_rest_is_the_end(void **state)
{
    (void)state;
    for (int steady = 0; steady < 2; steady++) {
        bell b = {{0.1, 0, 0}, 0, INFINITY};
        impact_body_def bodies[2] = {floor_body(1, 0), box("box", (qvec3){1, 1, 1}, 4, (qvec3){0, 0, 1}, 1)};
        impact_force_def force = custom(bell_force, &b);
        force.steady = steady;
        impact_scene_def def = scene_of(bodies, 2, 3);
        def.forces = &force;
        def.force_count = 1;
        b.peak.x = 0;
        const ending e = run(&def);
        assert_good(&e);
        assert_int_equal(e.status, steady ? IMPACT_AT_REST : IMPACT_OK);
        assert_true(steady ? e.t < 3 : e.t == 3);
    }
}

/* ---- declared corners ---- */

static bool square_wave(double t, int body, double mass, qvec3 x, quat q, qvec3 v, qvec3 w, qvec3 *force, qvec3 *torque,
                        void *context)
{
    (void)body, (void)mass, (void)x, (void)q, (void)v, (void)w, (void)torque;
    const double half = *(double *)context;
    force->x = fmod(floor(t / half), 2) == 0 ? 3 : -3;
    return true;
}

/* Up and down in turn for half a period each, from rest: after whole periods at rest again, 3/m half^2 further each. */
static void switches_cut_the_steps(void **state)
{
    (void)state;
    for (int k = 0; k < 12; k++) {
        double half = 0.1 + 0.01 * k, times[30];
        const int periods = 5;
        for (int i = 0; i < 30; i++) times[i] = (i + 1) * half;
        const impact_body_def body = ball("ball", 1, (qvec3){0, 0, 0}, (qvec3){0, 0, 0});
        impact_force_def force = custom(square_wave, &half);
        if (k & 1) {
            force.switches = times;
            force.switch_count = 30;
        } else {
            force.switch_period = half;
        }
        force.max_step = INFINITY;
        impact_scene_def def = scene_of(&body, 1, 2 * periods * half);
        def.gravity = (qvec3){0, 0, 0};
        def.forces = &force;
        def.force_count = 1;
        const ending e = run(&def);
        assert_good(&e);
        assert_near(e.body.velocity.x, 0, 1e-13);
        assert_near(e.body.position.x, periods * 3 * half * half, 1e-12);
        assert_true(e.usage.integrator_rhs_calls < 120 * 2 * periods);
    }
}

/* Switches in a period that is none of their own distances, begun long before the run. */
static bool on_off(double t, int body, double mass, qvec3 x, quat q, qvec3 v, qvec3 w, qvec3 *force, qvec3 *torque,
                   void *context)
{
    (void)body, (void)mass, (void)x, (void)q, (void)v, (void)w, (void)torque, (void)context;
    const double phase = t - floor(t / 0.5) * 0.5;
    force->y = phase > 0.125 && phase < 0.3125 ? 8 : 0;
    return true;
}

static void switches_come_again(void **state)
{
    (void)state;
    const double times[2] = {-9.875, -9.6875};
    const impact_body_def body = ball("ball", 1, (qvec3){0, 0, 0}, (qvec3){0, 0, 0});
    impact_force_def force = custom(on_off, NULL);
    force.switches = times;
    force.switch_count = 2;
    force.switch_period = 0.5;
    impact_scene_def def = scene_of(&body, 1, 3);
    def.gravity = (qvec3){0, 0, 0};
    def.forces = &force;
    def.force_count = 1;
    const ending e = run(&def);
    assert_good(&e);
    assert_near(e.body.velocity.y, 6 * 8 * 0.1875, 1e-13);
}

/* A buffer behind x = 0: pushes back by stiffness x there, and by nothing before it. */
static bool buffer(double t, int body, double mass, qvec3 x, quat q, qvec3 v, qvec3 w, qvec3 *force, qvec3 *torque,
                   void *context)
{
    (void)t, (void)body, (void)mass, (void)q, (void)v, (void)w, (void)torque;
    force->x = x.x > 0 ? -*(double *)context * x.x : 0;
    return true;
}

static double buffer_edge(double t, const impact_sample *body, void *context)
{
    (void)t, (void)context;
    return -body->position.x;
}

/* Half a period of the spring and out again; entry and exit are events. */
static void edges_are_met(void **state)
{
    (void)state;
    random_stream random = {34};
    for (int i = 0; i < 30; i++) {
        const double speed = random_log(&random, 0.1, 10), way = random_log(&random, 0.1, 1);
        double stiffness = random_log(&random, 1e2, 1e6);
        const impact_body_def body = ball("ball", 0.5, (qvec3){-way, 0, 0}, (qvec3){speed, 0, 0});
        impact_force_def force = custom(buffer, &stiffness);
        force.edge = buffer_edge;
        force.name = "buffer";
        const double inside = pi / sqrt(stiffness), duration = 2 * way / speed + inside;
        impact_scene_def def = scene_of(&body, 1, duration);
        def.gravity = (qvec3){0, 0, 0};
        def.forces = &force;
        def.force_count = 1;
        scene_log log = {0};
        const ending e = run_logged(&def, &log);
        assert_good(&e);
        assert_int_equal(log.event_count, 2);
        assert_int_equal(log.events[0].kind, IMPACT_EVENT_FORCE);
        assert_near(log.events[0].t, way / speed, 1e-11 * duration);
        assert_near(log.events[1].t, way / speed + inside, 1e-10 * duration);
        assert_near(e.body.velocity.x, -speed, 1e-10 * speed);
        assert_near(e.body.position.x, -way, 1e-10 * way);
        free_log(&log);
    }
}

static double edge_that_is_nan(double t, const impact_sample *body, void *context)
{
    (void)body, (void)context;
    return t < 0.5 ? 1 : NAN;
}

static void what_cannot_be_is_refused_by_name(void **state)
{
    (void)state;
    const double falling[] = {0.3, 0.2}, equal[] = {0.1, 0.1}, unreal[] = {0.1, NAN}, wide[] = {0, 2};
    static const char *const words[] = {"max_step",    "max_step",      "switches[2]",  "switches[2]",
                                        "switches[2]", "switch_period", "switch_period"};
    for (int k = 0; k < 7; k++) {
        const impact_body_def body = ball("ball", 1, (qvec3){0, 0, 0}, (qvec3){0, 0, 0});
        double half = 1;
        impact_force_def force = custom(square_wave, &half);
        force.name = "wave";
        force.switches = k == 2 ? falling : k == 3 ? equal : k == 4 ? unreal : wide;
        force.switch_count = k >= 2 ? 2 : 0;
        if (k == 0) force.max_step = 0;
        if (k == 1) force.max_step = -1;
        if (k == 5) force.switch_period = 1.5;
        if (k == 6) force.switch_period = -1;
        impact_scene_def def = scene_of(&body, 1, 1);
        def.forces = &force;
        def.force_count = 1;
        impact_scene *scene;
        char message[256];
        assert_true(impact_scene_create(&def, &scene, message, sizeof message) < 0);
        assert_null(scene);
        if (!strstr(message, words[k]) || !strstr(message, "wave")) fail_msg("%s", message);
    }
    const impact_body_def body = ball("ball", 1, (qvec3){0, 0, 0}, (qvec3){0, 0, 0});
    double half = 1;
    impact_force_def force = custom(square_wave, &half);
    force.edge = edge_that_is_nan;
    impact_scene_def def = scene_of(&body, 1, 1);
    def.forces = &force;
    def.force_count = 1;
    const ending e = run(&def);
    assert_true(e.status < 0 && refused(&e) && strstr(e.message, "edge") && e.t <= 0.51);
}

/* ---- forces without bound, and forces that brake hard ---- */

typedef struct pole {
    double at, power, strength;
} pole;

static bool pole_force(double t, int body, double mass, qvec3 x, quat q, qvec3 v, qvec3 w, qvec3 *force, qvec3 *torque,
                       void *context)
{
    (void)body, (void)mass, (void)x, (void)q, (void)v, (void)w, (void)torque;
    const pole *p = context;
    force->x = p->strength * pow(p->at - t, -p->power);
    return true;
}

/* A force that grows without bound ends the run before its pole, and the words name time and body. */
static void a_pole_is_an_end(void **state)
{
    (void)state;
    for (int power = 1; power <= 3; power++)
        for (int k = 0; k < 6; k += 3) {
            pole p = {0.2 + 0.13 * k, power, pow(10, 2 - k)};
            const impact_body_def bodies[2] = {ball("idle", 0.1, (qvec3){0, 5, 0}, (qvec3){0, 0, 0}),
                                               ball("driven", 0.1, (qvec3){0, 0, 0}, (qvec3){0, 0, 0})};
            impact_force_def force = custom(pole_force, &p);
            force.body = "driven";
            impact_scene_def def = scene_of(bodies, 2, 2);
            def.gravity = (qvec3){0, 0, 0};
            def.forces = &force;
            def.force_count = 1;
            def.max_steps = 300000;
            const ending e = run(&def);
            if (e.status >= 0) fail_msg("status %d at t = %.17g of a pole at %g", e.status, e.t, p.at);
            assert_true(e.t <= p.at * (1 + 1e-12) && e.t > 0.9 * p.at);
            if (!strstr(e.message, "'driven'") && !strstr(e.message, "max_steps")) fail_msg("%s", e.message);
            assert_non_null(strstr(e.message, "t = "));
            assert_null(strstr(e.message, "CV"));
        }
}

/* Friction as mu m g tanh(v/v_s). */
typedef struct smooth_friction {
    double grip, scale; /* m/s^2, m/s */
} smooth_friction;

static bool smooth_friction_force(double t, int body, double mass, qvec3 x, quat q, qvec3 v, qvec3 w, qvec3 *force,
                                  qvec3 *torque, void *context)
{
    (void)t, (void)body, (void)x, (void)q, (void)w, (void)torque;
    const smooth_friction *f = context;
    force->x = -mass * f->grip * tanh(v.x / f->scale);
    return true;
}

/* sinh(v/v_s) = sinh(v0/v_s) exp(-grip t/v_s); where that overflows, v = v0 - grip t as long as v >> v_s. */
static double smooth_friction_speed(const smooth_friction *f, double v0, double t)
{
    const double x = v0 / f->scale - f->grip * t / f->scale, e = exp(-2 * v0 / f->scale);
    if (x > 300) return f->scale * (x + log1p(-e));
    return f->scale * asinh(0.5 * exp(x) * (1 - e));
}

static void regularised_friction_ends(void **state)
{
    (void)state;
    for (int k = 0; k <= 12; k++)
        for (int late = 0; late < 2; late++) {
            smooth_friction f = {2, pow(10, -k)};
            const double v0 = 1, duration = late ? 0.7 : 0.45; /* after the stop at .5 s, and before it */
            const impact_body_def body = ball("ball", 0.1, (qvec3){0, 0, 0}, (qvec3){v0, 0, 0});
            const impact_force_def force = custom(smooth_friction_force, &f);
            impact_scene_def def = scene_of(&body, 1, duration);
            def.gravity = (qvec3){0, 0, 0};
            def.forces = &force;
            def.force_count = 1;
            const ending e = run(&def);
            if (e.status != IMPACT_OK) fail_msg("v_s = %g: status %d, %s", f.scale, e.status, e.message);
            assert_near(e.body.velocity.x, smooth_friction_speed(&f, v0, duration), 1e-11);
        }
}

int main(void)
{
    const struct CMUnitTest integrated[] = {
        cmocka_unit_test(no_hill_is_passed_over),
        cmocka_unit_test(no_pulse_is_passed_over),
        cmocka_unit_test(pulses_between_the_ends_of_steps_are_seen),
        cmocka_unit_test(wind_has_no_switches),
        cmocka_unit_test(what_rests_wakes),
        cmocka_unit_test(under_a_steady_force_rest_is_the_end),
        cmocka_unit_test(switches_cut_the_steps),
        cmocka_unit_test(switches_come_again),
        cmocka_unit_test(edges_are_met),
        cmocka_unit_test(what_cannot_be_is_refused_by_name),
        cmocka_unit_test(a_pole_is_an_end),
        cmocka_unit_test(regularised_friction_ends),
    };
    return impact_has(IMPACT_PART_CVODE) ? cmocka_run_group_tests_name("impact.force_time", integrated, NULL, NULL) : 0;
}
