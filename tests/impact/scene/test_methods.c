/* SPDX-License-Identifier: MIT
 *
 * The methods of a scene: they lead to the same place, each leaves the others' counters at zero, and a key that is of
 * no use is refused by its name.
 */
#include "kit/contact_random.h"
#include "kit/same_bits.h"
#include "kit/scene_log.h"

static const double pi = 3.14159265358979323846;

/* An ellipsoid that flies, strikes a floor and flies on; and one that meets another in flight. */
typedef struct method_scene {
    impact_body_def bodies[3];
    impact_scene_def def;
} method_scene;

static impact_body_def ellipsoid_body(const char *name, qvec3 position, qvec3 velocity, qvec3 omega)
{
    impact_body_def body = impact_default_body_def();
    body.name = name;
    body.position = position;
    body.velocity = velocity;
    body.omega = omega;
    body.restitution = 0.9;
    body.linear_damping = 0.1;
    impact_shape_ellipsoid(0.1, 0.2, 0.3, &body.shape);
    return body;
}

static void make_method_scene(method_scene *s)
{
    s->bodies[0] = plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 0.5, 1);
    s->bodies[1] = ellipsoid_body("one", (qvec3){0, 0, 1}, (qvec3){1, 0, 0}, (qvec3){1, 2, 3});
    s->bodies[2] = ellipsoid_body("other", (qvec3){0.8, 0.05, 1}, (qvec3){-1, 0, 0}, (qvec3){-2, 0, 1});
    s->def = impact_default_scene_def();
    s->def.bodies = s->bodies, s->def.body_count = 3;
    s->def.duration = 0.6;
}

static impact_usage run_by(const impact_scene_def *def, impact_methods methods, impact_sample *end)
{
    impact_scene_def own = *def;
    own.methods = methods;
    impact_scene *scene = make_scene(&own);
    const impact_status status = impact_scene_run(scene, NULL);
    if (status < 0) fail_msg("%s", impact_scene_message(scene));
    impact_scene_body(scene, 1, end);
    const impact_usage usage = impact_scene_usage(scene);
    impact_scene_destroy(scene);
    return usage;
}

static double distance(const impact_sample *a, const impact_sample *b)
{
    const qvec3 x = qvec3_sub(a->position, b->position), v = qvec3_sub(a->velocity, b->velocity),
                w = qvec3_sub(a->omega, b->omega);
    return fmax(qvec3_norm(x), fmax(qvec3_norm(v), qvec3_norm(w)));
}

/* ---- the same place ---- */

static void all_methods_lead_to_one_place(void **state)
{
    (void)state;
    method_scene s;
    impact_sample best, end;
    make_method_scene(&s);
    const impact_usage exact = run_by(&s.def, (impact_methods){0}, &best);
    assert_true(exact.events[IMPACT_EVENT_IMPACT] >= 2 && exact.ballistic_flights > 0 && exact.gap_newton > 0);
    const struct {
        impact_methods methods;
        double within;
    } all[] = {
        {{.motion = IMPACT_MOTION_CVODE}, 1e-10},
        {{.motion = IMPACT_MOTION_CVODE, .tolerance = 1e-6}, 1e-4},
        {{.motion = IMPACT_MOTION_OTHER}, 1e-8},
        {{.motion = IMPACT_MOTION_RK4, .step = 1e-3}, 1e-6},
        {{.motion = IMPACT_MOTION_RK4, .step = 1e-4}, 1e-10},
        {{.impacts = IMPACT_SOLVER_CVODE}, 1e-10},
        {{.impacts = IMPACT_SOLVER_CVODE, .impact_tolerance = 1e-6}, 1e-3},
        {{.gaps = IMPACT_GAP_CCD, .gap_tolerance = 1e-7}, 1e-1},
        {{.motion = IMPACT_MOTION_CVODE, .impacts = IMPACT_SOLVER_CVODE, .gaps = IMPACT_GAP_CCD}, 1},
    };
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        const impact_methods m = all[k].methods;
        const impact_usage usage = run_by(&s.def, m, &end);
        assert_at_most(distance(&end, &best), all[k].within);
        const bool integrates = m.motion != IMPACT_MOTION_AUTO;
        assert_int_equal(usage.ballistic_flights > 0, !integrates);
        assert_int_equal(usage.integrator_steps > 0, integrates);
        assert_int_equal(usage.gap_newton > 0, m.gaps == IMPACT_GAP_NEWTON);
        assert_int_equal(usage.gap_ccd > 0, m.gaps == IMPACT_GAP_CCD);
        assert_int_equal(usage.impacts_cvode > 0, m.impacts == IMPACT_SOLVER_CVODE);
        assert_int_equal(usage.events[IMPACT_EVENT_IMPACT], exact.events[IMPACT_EVENT_IMPACT]);
    }
}

/* By steps: motion = STEPS is a name of piles = STEPS, to the bit. */
static void steps_have_two_names(void **state)
{
    (void)state;
    method_scene s;
    impact_sample one, other;
    make_method_scene(&s);
    const impact_usage usage = run_by(&s.def, (impact_methods){.motion = IMPACT_MOTION_STEPS}, &one);
    assert_true(usage.pile_steps > 0);
    s.def.piles = IMPACT_PILES_STEPS;
    run_by(&s.def, (impact_methods){0}, &other);
    assert_memory_equal(&one.position, &other.position, sizeof one.position);
}

/* A ball that slides until it rolls: in closed form by default, and by no other. */
static void rolling_is_integrated_too(void **state)
{
    (void)state;
    impact_body_def bodies[2] = {plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 0.5, 1),
                                 ball_body("ball", (qvec3){0, 0, 0.3}, 0.5, 0)};
    bodies[1].velocity = (qvec3){1, 0, 0};
    impact_scene_def def = impact_default_scene_def();
    def.bodies = bodies, def.body_count = 2, def.duration = 1;
    impact_sample end;
    assert_true(run_by(&def, (impact_methods){0}, &end).rolls > 0);
    assert_near(end.velocity.x, 5.0 / 7, 1e-12);
    const impact_methods all[] = {
        {.motion = IMPACT_MOTION_CVODE}, {.motion = IMPACT_MOTION_RK4, .step = 1e-3}, {.motion = IMPACT_MOTION_OTHER}};
    for (int k = 0; k < 3; k++) {
        const impact_usage usage = run_by(&def, all[k], &end);
        assert_int_equal(usage.rolls, 0);
        assert_true(usage.integrator_steps > 0);
        assert_near(end.velocity.x, 5.0 / 7, 1e-9);
    }
}

/* Two bodies about each other on ellipses, once round: they are back where they were. */
static double kepler_error(double step)
{
    const double eccentricity = 0.3, near = 1 - eccentricity, speed = sqrt((1 + eccentricity) / near);
    impact_body_def bodies[2] = {ball_body("sun", (qvec3){0, 0, 0}, 0, 1),
                                 ball_body("planet", (qvec3){near, 0, 0}, 0, 1)};
    bodies[0].mass = bodies[1].mass = 0.5;
    for (int k = 0; k < 2; k++) impact_shape_sphere(0.01, &bodies[k].shape);
    bodies[0].velocity = (qvec3){0, -0.5 * speed, 0};
    bodies[1].velocity = (qvec3){0, 0.5 * speed, 0};
    impact_force_def force = impact_default_force_def(IMPACT_FORCE_ATTRACTION);
    force.constant = 1; /* G (m1 + m2) = 1, semi-axis 1: the period is 2 pi */
    impact_scene_def def = impact_default_scene_def();
    def.gravity = (qvec3){0, 0, 0};
    def.bodies = bodies, def.body_count = 2;
    def.forces = &force, def.force_count = 1;
    def.duration = 2 * pi;
    impact_sample end;
    run_by(&def, step > 0 ? (impact_methods){.motion = IMPACT_MOTION_RK4, .step = step} : (impact_methods){0}, &end);
    return qvec3_norm(qvec3_sub(end.position, bodies[1].position));
}

static void on_keplers_ellipse_the_fixed_step_is_of_order_four(void **state)
{
    (void)state;
    assert_at_most(kepler_error(0), 1e-11);
    for (int n = 600; n <= 1200; n *= 2) {
        const double coarse = kepler_error(2 * pi / n), fine = kepler_error(pi / n);
        assert_near(log2(coarse / fine), 4, 0.1);
    }
}

/* CVODE's tolerance in impacts is the one that was asked for: the error falls with it. */
static void the_tolerance_of_impacts_is_theirs(void **state)
{
    (void)state;
    method_scene s;
    impact_sample best, end;
    double before = INFINITY;
    make_method_scene(&s);
    run_by(&s.def, (impact_methods){0}, &best);
    for (int digits = 3; digits <= 12; digits += 3) {
        run_by(&s.def, (impact_methods){.impacts = IMPACT_SOLVER_CVODE, .impact_tolerance = pow(10, -digits)}, &end);
        const double error = distance(&end, &best);
        assert_at_most(error, 0.2 * before);
        before = error;
    }
    impact_sample same;
    run_by(&s.def, (impact_methods){.impacts = IMPACT_SOLVER_CVODE, .tolerance = 1e-12}, &same);
    assert_memory_equal(&same.position, &end.position, sizeof same.position); /* of the scene, where none is given */
}

/* ---- the same bits ---- */

static void parts_and_saves_change_no_bit(void **state)
{
    (void)state;
    const impact_methods all[] = {{.motion = IMPACT_MOTION_CVODE},
                                  {.motion = IMPACT_MOTION_RK4, .step = 1e-3},
                                  {.impacts = IMPACT_SOLVER_CVODE},
                                  {.gaps = IMPACT_GAP_CCD},
                                  {.motion = IMPACT_MOTION_OTHER}};
    for (int k = 0; k < 5; k++) {
        method_scene s;
        make_method_scene(&s);
        s.def.methods = all[k];
        impact_scene *whole = make_scene(&s.def), *parts = make_scene(&s.def), *loaded = make_scene(&s.def);
        assert_true(impact_scene_run(whole, NULL) >= 0);
        assert_true(impact_scene_run_to(parts, 0.31 * s.def.duration, NULL) >= 0);
        if (all[k].motion == IMPACT_MOTION_AUTO) {
            char bytes[65536];
            size_t size = sizeof bytes;
            assert_int_equal(impact_scene_save(parts, bytes, &size), IMPACT_OK);
            assert_int_equal(impact_scene_load(loaded, bytes, size), IMPACT_OK);
            assert_true(impact_scene_run(loaded, NULL) >= 0);
            assert_true(same_scene(whole, loaded));
        }
        assert_true(impact_scene_run(parts, NULL) >= 0);
        assert_true(same_scene(whole, parts));
        impact_scene_destroy(whole);
        impact_scene_destroy(parts);
        impact_scene_destroy(loaded);
    }
}

/* ---- what is refused ---- */

static void refuse(impact_scene_def *def, impact_status status, const char *words)
{
    char message[256] = "";
    impact_scene *scene;
    if (impact_scene_create(def, &scene, message, sizeof message) != status || !strstr(message, words))
        fail_msg("wanted '%s', got '%s'", words, message);
    assert_null(scene);
    def->methods = (impact_methods){0};
    def->solver = IMPACT_SOLVER_AUTO, def->tolerance = 1e-13, def->piles = IMPACT_PILES_AUTO;
}

static void a_key_of_no_use_is_refused_by_its_name(void **state)
{
    (void)state;
    method_scene s;
    make_method_scene(&s);
    impact_scene_def *d = &s.def;
    impact_methods *m = &d->methods;
    m->motion = (impact_motion_method)5, refuse(d, IMPACT_EARGUMENT, "motion = 5");
    m->impacts = (impact_solver)9, refuse(d, IMPACT_EARGUMENT, "impacts = 9");
    d->solver = (impact_solver)9, refuse(d, IMPACT_EARGUMENT, "solver = 9");
    m->gaps = (impact_gap_method)-1, refuse(d, IMPACT_EARGUMENT, "gaps = -1");
    d->solver = IMPACT_SOLVER_SERIES, m->impacts = IMPACT_SOLVER_CVODE, refuse(d, IMPACT_EARGUMENT, "two names");
    d->tolerance = 1e-9, m->tolerance = 1e-8, refuse(d, IMPACT_EARGUMENT, "two names");
    m->tolerance = 1e-16, refuse(d, IMPACT_EARGUMENT, "tolerance = 1e-16");
    m->tolerance = NAN, refuse(d, IMPACT_EDOMAIN, "tolerance = nan");
    m->impact_tolerance = 1e-9, refuse(d, IMPACT_EARGUMENT, "impact_tolerance");
    m->impacts = IMPACT_SOLVER_CVODE, m->impact_tolerance = 1e-15, refuse(d, IMPACT_EARGUMENT, "impact_tolerance");
    m->gap_tolerance = 1e-4, refuse(d, IMPACT_EARGUMENT, "needs gaps");
    m->gaps = IMPACT_GAP_CCD, m->gap_tolerance = 1e-8, refuse(d, IMPACT_EARGUMENT, "cannot give it");
    m->step = 1e-3, refuse(d, IMPACT_EARGUMENT, "step");
    m->motion = IMPACT_MOTION_RK4, refuse(d, IMPACT_EARGUMENT, "needs a step");
    m->motion = IMPACT_MOTION_RK4, m->step = INFINITY, refuse(d, IMPACT_EDOMAIN, "needs a step");
    m->motion = IMPACT_MOTION_CVODE, d->piles = IMPACT_PILES_STEPS, refuse(d, IMPACT_EARGUMENT, "piles");
    m->motion = IMPACT_MOTION_STEPS, d->piles = IMPACT_PILES_EXACT, refuse(d, IMPACT_EARGUMENT, "piles");
    d->solver = m->impacts = IMPACT_SOLVER_SERIES, d->tolerance = m->tolerance = 1e-9; /* alike: no fault */
    impact_scene_destroy(make_scene(d));
}

static void what_the_build_lacks_is_said(void **state)
{
    (void)state;
    method_scene s;
    make_method_scene(&s);
    if (!impact_has(IMPACT_PART_CVODE)) {
        s.def.methods.motion = IMPACT_MOTION_CVODE, refuse(&s.def, IMPACT_EABSENT, "needs CVODE");
        s.def.methods.impacts = IMPACT_SOLVER_CVODE, refuse(&s.def, IMPACT_EABSENT, "CVODE");
    }
    if (!impact_has(IMPACT_PART_CCD))
        s.def.methods.gaps = IMPACT_GAP_CCD, refuse(&s.def, IMPACT_EABSENT, "needs libccd");
}

/* Thin plates with edges, of which libccd misses a gap in a hundred: then the run ends there, and says where. */
static void a_gap_that_libccd_has_not_ends_the_run(void **state)
{
    (void)state;
    enum { SCENES = 100 };
    random_stream random = {11};
    int ended = 0;
    for (int k = 0; k < SCENES; k++) {
        method_scene s;
        make_method_scene(&s);
        for (int i = 1; i < 3; i++) {
            impact_shape_superquadric(1e-4, 0.2, 0.3, 1.05, 1.05, 1.05, &s.bodies[i].shape);
            s.bodies[i].orientation = random_rotation(&random);
        }
        s.def.bodies = s.bodies + 1, s.def.body_count = 2;
        s.bodies[2].position.x = 2; /* not near yet: the scene is made */
        s.def.duration = 3;
        s.def.methods = (impact_methods){.gaps = IMPACT_GAP_CCD, .gap_tolerance = 1e-7};
        impact_scene *scene = make_scene(&s.def);
        const impact_status status = impact_scene_run(scene, NULL);
        const char *message = impact_scene_message(scene);
        const bool libccds =
            strstr(message, "bodies 'one' and 'other' at t = ") && strstr(message, "gap_tolerance = 1e-07");
        assert_true(status >= 0 || (status == IMPACT_EUNSETTLED && libccds && impact_scene_time(scene) < 3));
        ended += status == IMPACT_EUNSETTLED;
        impact_scene_destroy(scene);
    }
    assert_true(ended > 0);
}

int main(void)
{
    const struct CMUnitTest always[] = {cmocka_unit_test(a_key_of_no_use_is_refused_by_its_name),
                                        cmocka_unit_test(what_the_build_lacks_is_said)};
    const struct CMUnitTest with_all[] = {
        cmocka_unit_test(all_methods_lead_to_one_place),
        cmocka_unit_test(steps_have_two_names),
        cmocka_unit_test(rolling_is_integrated_too),
        cmocka_unit_test(on_keplers_ellipse_the_fixed_step_is_of_order_four),
        cmocka_unit_test(the_tolerance_of_impacts_is_theirs),
        cmocka_unit_test(parts_and_saves_change_no_bit),
        cmocka_unit_test(a_gap_that_libccd_has_not_ends_the_run),
    };
    const int failed = cmocka_run_group_tests(always, NULL, NULL);
    if (!impact_has(IMPACT_PART_CVODE) || !impact_has(IMPACT_PART_CCD)) return failed;
    return failed + cmocka_run_group_tests(with_all, NULL, NULL);
}
