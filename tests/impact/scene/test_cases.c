/* SPDX-License-Identifier: MIT
 *
 * Scenes that once went wrong without a word, with their relatives: other sizes, places, speeds, shapes. Each is right
 * against a closed form, or refused with a status and words. Through the public interface alone.
 */
#include "kit/contact_random.h"
#include "kit/scene_ending.h"

static const double gravity = 9.80665;

/* ---- far from the origin ---- */

/* A fall of a millimetre along a floor takes as long anywhere on it. */
static void far_away_is_as_here(void **state)
{
    (void)state;
    for (int k = 0; k <= 10; k++)
        for (int i = 0; i < 4; i++) {
            const double away = pow(10, k), height = 1e-3 * (1 + i), time = sqrt(2 * height / gravity);
            const double radius = 0.25 * (1 + i);
            const impact_body_def bodies[2] = {
                floor_body(0.5, 1),
                ball("ball", radius, (qvec3){away, i & 1 ? -away : 0, radius + height}, (qvec3){0, 0, 0})};
            const impact_scene_def def = scene_of(bodies, 2, 2.5 * time);
            scene_log log = {0};
            const ending e = run_logged(&def, &log);
            assert_good(&e);
            const int first = find_event(&log, IMPACT_EVENT_IMPACT, NULL, 0);
            assert_true(first >= 0);
            assert_near(log.events[first].t, time, 1e-12 + 1e-15 / (gravity * time));
            free_log(&log);
        }
}

/* Two balls meet along the line that is far: to the rounding of their places there. */
static void far_along_the_line_is_known_to_its_rounding(void **state)
{
    (void)state;
    for (int k = 0; k <= 9; k++) {
        const double away = pow(10, k), apart = 0.5, rounding = 0x1p-52 * away;
        const impact_body_def bodies[2] = {ball("a", 0.5, (qvec3){away, 0, 0}, (qvec3){1, 0, 0}),
                                           ball("b", 0.5, (qvec3){away + 1 + apart, 0, 0}, (qvec3){-1, 0, 0})};
        impact_scene_def def = scene_of(bodies, 2, 1);
        def.gravity = (qvec3){0, 0, 0};
        scene_log log = {0};
        const ending e = run_logged(&def, &log);
        assert_good(&e);
        const int first = find_event(&log, IMPACT_EVENT_IMPACT, NULL, 0);
        assert_true(first >= 0);
        assert_near(log.events[first].t, 0.25, 4 * rounding + 1e-15);
        free_log(&log);
    }
}

/* ---- the same in company ---- */

/* What one body does does not hang on how many others there are far away. */
static void compliance_holds_in_company(void **state)
{
    (void)state;
    for (int spin = 0; spin < 3; spin++) {
        ending alone = {0};
        for (int n = 1; n <= 7; n++) {
            char names[8][8];
            impact_body_def bodies[8] = {floor_body(1, 1)};
            for (int i = n; i >= 1; i--) { /* the last of the definition is the same in each */
                snprintf(names[i], sizeof names[i], "b%d", i);
                bodies[i] = ball(names[i], 0.1, (qvec3){10.0 * (n - i), 0, 1}, (qvec3){1, 0, 0});
                bodies[i].omega = (qvec3){0, 10.0 + 20 * spin, 0};
                bodies[i].friction = 0.3;
                bodies[i].restitution = 0.8;
            }
            impact_scene_def def = scene_of(bodies, n + 1, 0.6);
            def.law = IMPACT_STRONGE;
            def.compliance = 1.2;
            const ending e = run(&def);
            assert_good(&e);
            assert_int_equal(e.usage.impacts_closed_form, 0);
            if (n == 1) alone = e;
            assert_near3(e.body.velocity, alone.body.velocity, 1e-13);
            assert_near3(e.body.omega, alone.body.omega, 1e-12);
        }
    }
}

/* ---- boxes on boxes ---- */

/* Dropped on a table within its edges, a box stays on it, also where the run says that its digits are not to be
 * trusted. */
static void nothing_falls_through(void **state)
{
    (void)state;
    random_stream random = {35};
    for (int i = 0; i < 4; i++) {
        const double exponent = i < 3 ? 50 : 8 + 20 * random_unit(&random);
        impact_body_def bodies[2] = {box("table", (qvec3){0.5, 0.5, 0.1}, exponent, (qvec3){0, 0, 0.1}, 0),
                                     box("box", (qvec3){0.1, 0.1, 0.05}, exponent,
                                         (qvec3){0.2 * random_unit(&random), -0.2 * random_unit(&random), 0.3}, 0)};
        bodies[0].is_static = true;
        bodies[1].velocity = (qvec3){0.2 * random_unit(&random), 0.1, 0};
        if (i == 0) {
            bodies[1].position = (qvec3){.1738748, -.199613, .3};
            bodies[1].velocity = (qvec3){.631857, .159491, 0};
        }
        impact_scene_def def = scene_of(bodies, 2, i == 0 ? 0.4 : 0.6);
        const ending e = run(&def);
        if (i == 0 || !refused(&e)) assert_good(&e);
        assert_true(e.body.position.z > 0.24);
    }
}

/* A box slides on a box that stays: as friction brakes it. */
static void a_box_slides_on_a_box(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        const double friction = 0.3 + 0.1 * i, speed = 1;
        impact_body_def bodies[3] = {floor_body(0.1, 0.5), box("lower", (qvec3){.3, .3, .1}, 100, (qvec3){0, 0, .1}, 1),
                                     box("upper", (qvec3){.1, .1, .1}, 100, (qvec3){0, 0, .3}, friction)};
        bodies[2].velocity = (qvec3){speed, 0, 0};
        impact_scene_def def = scene_of(bodies, 3, 1);
        def.pile_tolerance = 1e-5;
        const ending e = run(&def);
        assert_good(&e);
        assert_near(e.body.position.x, speed * speed / (2 * friction * gravity), 1e-6);
        assert_near(e.body.position.z, 0.3, 1e-6);
    }
}

/* ---- losses ---- */

/* Seven ellipsoids heap up in a shaft, where friction once did work: losses do not fall. */
static void friction_takes(void **state)
{
    (void)state;
    static const double data[7][11] = {
        {0.18629394485055783, 0.19431200553875067, 0.19950443742245094, 13672.117670624806, 0.25, -0.25, 0.3,
         0.13179815224660152, 0.51343690234291306, 0.81296629701928758, 0.24103442552391374},
        {0.1297425156862575, 0.17790191579626122, 0.15278886074222323, 2826.0372700745343, -0.25, 0.25, 0.3,
         -0.96373509557966397, 0.1285555116400792, -0.19177562778967325, 0.13382919920888031},
        {0.17388416483444757, 0.14819912388241416, 0.12613440153091562, 9025.3966516610035, 0.25, 0.25, 0.3,
         -0.43601366701445138, 0.85876370032332938, 0.22912482935480297, 0.14113398512309627},
        {0.14104818840503386, 0.14076251702149756, 0.14749392711019887, 1274.4767457495302, -0.25, -0.25, 0.8,
         -0.83678413736503177, -0.15018506252596345, 0.042766135191524238, 0.52479311364490333},
        {0.19579709107767113, 0.17750424448624369, 0.15717079556223063, 1890.1586081503701, 0.25, -0.25, 0.8,
         -0.38991833778535689, 0.55694454349566969, 0.073246138103329722, -0.7296653127167636},
        {0.16888579935637862, 0.12095803585099382, 0.14533040659254676, 2000.7780231130052, -0.25, 0.25, 0.8,
         -0.62748258952741898, 0.47459095469379131, -0.60884489265492725, 0.10067165580004214},
        {0.12765638686759892, 0.14696415371552857, 0.17758975148168962, 1836.0463534520643, 0.25, 0.25, 0.8,
         -0.025184896117390426, -0.46819219138155566, 0.33661768221871968, 0.81660904290522651}};
    static const char *const names[] = {"b1", "b2", "b3", "b4", "b5", "b6", "b7"};
    const double friction = 0.81118577579718387, side = sqrt(0.5);
    impact_body_def bodies[12] = {plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), friction, 0),
                                  plane_body("west", (qvec3){-0.6, 0, 0}, (quat){side, 0, side, 0}, friction, 0),
                                  plane_body("east", (qvec3){0.6, 0, 0}, (quat){side, 0, -side, 0}, friction, 0),
                                  plane_body("south", (qvec3){0, -0.6, 0}, (quat){side, -side, 0, 0}, friction, 0),
                                  plane_body("north", (qvec3){0, 0.6, 0}, (quat){side, side, 0, 0}, friction, 0)};
    for (int i = 0; i < 7; i++) {
        const double *d = data[i];
        impact_body_def *body = &bodies[5 + i];
        *body = impact_default_body_def();
        body->name = names[i];
        impact_shape_ellipsoid(d[0], d[1], d[2], &body->shape);
        body->density = d[3];
        body->position = (qvec3){d[4], d[5], d[6]};
        body->orientation = (quat){d[7], d[8], d[9], d[10]};
        body->friction = friction;
        body->restitution = 0;
    }
    impact_scene_def def = scene_of(bodies, 12, 2);
    def.gravity = (qvec3){0, 0, -19.62};
    def.friction_rule = def.restitution_rule = IMPACT_MAXIMUM;
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 12; i++) bodies[i].friction = friction * (1 - 0.3 * k);
        const ending e = run(&def);
        assert_good(&e);
        assert_near(e.residuals.loss_fallen, 0, 1e-9 * e.energy.start);
    }
}

/* ---- tolerance ---- */

/* A ball slips on a turntable until it rolls, and rolls on: the closer, the smaller the tolerance; and with the same
 * events. */
static void tolerance_is_the_integrators_alone(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        ending best = {0};
        for (int digits = 13; digits >= 4; digits--) {
            impact_body_def bodies[2] = {floor_body(1, 1), ball("ball", 0.1, (qvec3){1, 0, 0.1}, (qvec3){0, 3, 0})};
            bodies[0].name = "table";
            bodies[0].omega = (qvec3){0, 0, 3 + k};
            bodies[1].friction = 0.05 + 0.1 * k;
            bodies[1].restitution = 0;
            impact_scene_def def = scene_of(bodies, 2, 0.5);
            def.tolerance = pow(10, -digits);
            const ending e = run(&def);
            assert_good(&e);
            if (digits == 13) best = e;
            for (int kind = 0; kind <= IMPACT_EVENT_REST; kind++)
                assert_int_equal(e.usage.events[kind], best.usage.events[kind]);
            assert_near3(e.body.position, best.body.position, 100 * def.tolerance);
        }
    }
}

/* Three balls fall into a shaft that they just fill: it ends, at every tolerance. */
static void a_pile_ends_at_every_tolerance(void **state)
{
    (void)state;
    const double side = sqrt(0.5);
    for (int digits = 4; digits <= 13; digits += 3) {
        impact_body_def bodies[6] = {plane_body("floor", (qvec3){0, 0, 0}, quat_identity(), 1, 1),
                                     plane_body("west", (qvec3){-.25, 0, 0}, (quat){side, 0, side, 0}, 1, 1),
                                     plane_body("east", (qvec3){.25, 0, 0}, (quat){side, 0, -side, 0}, 1, 1),
                                     ball("one", 0.1, (qvec3){-0.14, 0, 0.15}, (qvec3){0, 0, 0}),
                                     ball("two", 0.1, (qvec3){0.13, 0, 0.2}, (qvec3){0, 0, 0}),
                                     ball("three", 0.1, (qvec3){0.01, 0.003, 0.5}, (qvec3){0, 0, 0})};
        for (int i = 3; i < 6; i++) bodies[i].friction = 0.3, bodies[i].restitution = 0.25;
        impact_scene_def def = scene_of(bodies, 6, 1);
        def.friction_rule = def.restitution_rule = IMPACT_MINIMUM;
        def.tolerance = pow(10, -digits);
        def.max_steps = 1000000;
        const ending e = run(&def);
        assert_good(&e);
    }
}

/* ---- ends ---- */

/* The limit of events is an end of its own, alone and in company, and the run can be gone on with. */
static void the_limit_of_events_is_told(void **state)
{
    (void)state;
    for (int n = 1; n <= 5; n += 2)
        for (long limit = 1; limit <= 9; limit += 4) {
            static const char *const names[] = {"a", "b", "c", "d", "e"};
            impact_body_def bodies[6] = {floor_body(0, 1)};
            for (int i = 0; i < n; i++) {
                bodies[1 + i] = ball(names[i], 0.1, (qvec3){i, 0, 0.5 + 0.01 * i}, (qvec3){0, 0, 0});
                bodies[1 + i].restitution = 0.9;
            }
            impact_scene_def def = scene_of(bodies, n + 1, 5);
            def.max_events = limit;
            impact_scene *scene = make_scene(&def);
            assert_int_equal(impact_scene_run(scene, NULL), IMPACT_EVENT_LIMIT);
            const impact_usage usage = impact_scene_usage(scene);
            long events = 0;
            for (int kind = 0; kind <= IMPACT_EVENT_REST; kind++) events += usage.events[kind];
            assert_true(events >= limit && events < limit + 2 * n);
            assert_non_null(strstr(impact_scene_message(scene), "limit"));
            assert_true(impact_scene_time(scene) > 0 && impact_scene_time(scene) < 5);
            impact_scene_destroy(scene);
        }
}

typedef struct pulse_count {
    long calls, allowed;
} pulse_count;

static bool count_pulse(void *context, double t, double t_end)
{
    pulse_count *count = context;
    (void)t, (void)t_end;
    return ++count->calls <= count->allowed;
}

/* The progress function is called at each slot of the queue: steps, stretches, samples, and where a body leaves its
 * box; and never more than max_steps. */
static void calls_of_progress_are_bounded(void **state)
{
    (void)state;
    random_stream random = {36};
    for (int i = 0; i < 30; i++) {
        impact_body_def bodies[2] = {floor_body(0.5, 0.8), ball("ball", 0.1, (qvec3){0, 0, 1}, (qvec3){2, 0, 0})};
        bodies[1].restitution = random_unit(&random);
        bodies[1].linear_damping = i & 1 ? 0.1 : 0;
        impact_scene_def def = scene_of(bodies, 2, 2);
        if (i >= 15) def.max_steps = 1 + (long)random_log(&random, 1, 1e3);
        impact_scene *scene = make_scene(&def);
        pulse_count count = {0, 1000000};
        const impact_recorder recorder = {.struct_size = sizeof recorder, .context = &count, .progress = count_pulse};
        const impact_status status = impact_scene_run(scene, &recorder);
        const impact_usage u = impact_scene_usage(scene);
        enum { BOXES = 16 }; /* they grow by half each time that the lone ball leaves one */
        assert_true(count.calls <= u.integrator_steps + u.integrator_starts + u.ballistic_flights + BOXES);
        assert_true(count.calls <= def.max_steps);
        if (status == IMPACT_EUNSETTLED)
            assert_non_null(strstr(impact_scene_message(scene), "max_steps"));
        else
            assert_true(status == IMPACT_OK || status == IMPACT_AT_REST);
        assert_true(i >= 15 || status != IMPACT_EUNSETTLED);
        impact_scene_destroy(scene);
    }
}

/* Time once stood still here: a body whose exponent is over 1 by an ulp rolls on the floor. Of 1, and of what lies so
 * far over it that its sides are not flat but for rounding, the scene ends, and no two of them are farther apart than
 * their exponents; what lies between is refused. */
static void exponents_are_one_or_more_by_far(void **state)
{
    (void)state;
    impact_body_def hang[5] = {floor_body(1.3969838619232178e-09, 1e-8), impact_default_body_def(),
                               ball("c", 0.18907284768211918,
                                    (qvec3){4.571910763878293, 2.0342236627941439, 1.0680990020447401},
                                    (qvec3){3, -0.64672415463022437, 5.5879354476928711e-09}),
                               ball("d", 0.46151158177434615, (qvec3){0.91943113498336737, 1.8943571275978883, 1.2},
                                    (qvec3){0.26715903195287938, 6e-16, -216.46779668822717}),
                               impact_default_body_def()};
    hang[1].name = "b";
    impact_shape_superquadric(0.67749107333597836, 0.40101963450363581, 0.54769530436189051, 1.0000000000000002,
                              1.8802148503067109, 1.4505447553941466, &hang[1].shape);
    hang[1].position = (qvec3){1.2326548051393171, 0.24945829645680104, 1.0853472601150072};
    hang[1].orientation = (quat){-0.16594437801015333, 0.98613511417392663, 0, 8.4193855551280653e-09};
    hang[1].velocity = (qvec3){-6, -98.423782795251967, -1.7999999999999998};
    hang[1].omega = (qvec3){1.1517685476241342, 0, -5};
    hang[1].friction = 1.5e-16, hang[1].restitution = 0.97506637775811034;
    hang[2].mass = 30.203543444505549;
    hang[2].orientation = (quat){0, -0.90830955891185605, 0.4182986310611258, 2.1017554295204278e-05};
    hang[2].omega = (qvec3){-6.1125522629474771, 0, -3.394573809015168};
    hang[2].friction = 1.5, hang[2].restitution = 2.2204460492503131e-16;
    hang[3].omega = (qvec3){3.3582567827387311, 0, 0.05};
    hang[3].friction = 1.3969838619232178e-09, hang[3].restitution = 0.1;
    hang[4].name = "e";
    impact_shape_ellipsoid(0.31984466078676715, 0.065686900244101412, 0.24648351900970403, &hang[4].shape);
    hang[4].position = (qvec3){1.7, 1.4697531052583392, 1.5779290139469588};
    hang[4].orientation =
        (quat){0.00018453680638435025, 0.54800090308817029, 0.53132690484668021, -0.64605471621741428};
    hang[4].velocity = (qvec3){6e-08, 4.8, 6e-08};
    hang[4].omega = (qvec3){0, 1e-7, -7.17734305856502};
    hang[4].friction = 3.33e-16, hang[4].restitution = 1e-16;
    hang[4].linear_damping = 0.85907467879268773, hang[4].angular_damping = 0.46130252998443555;
    impact_scene_def def = scene_of(hang, 5, 0.45);
    def.gravity = (qvec3){0, 0, -9.81};
    def.friction_rule = IMPACT_GEOMETRIC_MEAN;
    def.law = IMPACT_NEWTON;
    def.max_steps = 20000;
    static const double over[] = {0, 1e-6, 1e-5, 1e-4, 1e-3}, too_little[] = {2.3e-16, 1e-12, 1e-9, 9e-7};
    double kinetic[sizeof over / sizeof *over];
    for (size_t k = 0; k < sizeof over / sizeof *over; k++) {
        hang[1].shape.r = 1 + over[k];
        scene_log log = {0};
        const ending e = run_logged(&def, &log);
        assert_good(&e);
        assert_true(find_event(&log, IMPACT_EVENT_CONTACT, NULL, 0) >= 0);
        kinetic[k] = e.energy.kinetic;
        assert_near(kinetic[k], kinetic[0], (over[k] + 1e-12) * kinetic[0]);
        free_log(&log);
    }
    for (size_t k = 0; k < sizeof too_little / sizeof *too_little; k++) {
        hang[1].shape.r = 1 + too_little[k];
        impact_scene *scene;
        char message[200];
        assert_int_equal(impact_scene_create(&def, &scene, message, sizeof message), IMPACT_EARGUMENT);
        assert_non_null(strstr(message, "over 1 by less than 1e-6: give 1"));
    }
}

/* A ball rolls on nearly flat places of a body of exponent 50, and time all but stood still: how the contact moves came
 * out of the noise of its curvature. */
static void time_advances_on_nearly_flat_places(void **state)
{
    (void)state;
    impact_body_def creeps[4] = {floor_body(1.5, 0.74031800286873994),
                                 ball("b", 0.96662343211157575, (qvec3){3.2, 0.5, 1.5027558214056826},
                                      (qvec3){-3e-16, 0.057721939621843577, -0.6}),
                                 impact_default_body_def(), impact_default_body_def()};
    creeps[1].mass = NAN;
    creeps[1].omega = (qvec3){-9.4882045960875274, 0, 1e-7};
    creeps[1].friction = 1.5, creeps[1].restitution = 0.3;
    creeps[2].name = "c";
    impact_shape_ellipsoid(0.11231879634998626, 0.11814057569264248, 0.091588819458413129, &creeps[2].shape);
    creeps[2].position = (qvec3){4.9, -0.99999998999999995, 1.1104873003842193};
    creeps[2].velocity = (qvec3){3.0987884151738028, 0.93551438947721799, -5.5879354476928711e-09};
    creeps[2].omega = (qvec3){0, 4.7553941465498824, -5};
    creeps[2].friction = 1.5, creeps[2].restitution = 0.13202307199316385;
    creeps[3] = box("d", (qvec3){0.72165135654774626, 0.2164954069643239, 0.84320909748617912}, 50,
                    (qvec3){-0.5, 0.95000005756462658, 0.88}, 1.5);
    creeps[3].orientation = (quat){-0.72872338032925132, 0.58297870426340115, 0.359302192223865, 0};
    creeps[3].velocity = (qvec3){-0.37752637605975281, -1.0362254707480087, 0};
    creeps[3].omega = (qvec3){0.060006190296930328, 6.1543626209295947, 0};
    creeps[3].restitution = 0.69435712759788815;
    impact_force_def pull = impact_default_force_def(IMPACT_FORCE_ATTRACTION);
    pull.constant = 0.168903, pull.power = 0.635334;
    impact_scene_def def = scene_of(creeps, 4, 0.55);
    def.gravity = (qvec3){-0.447563, 2e-16, 0};
    def.friction_rule = IMPACT_MAXIMUM;
    def.law = IMPACT_STRONGE;
    def.forces = &pull;
    def.force_count = 1;
    def.max_steps = 20000;
    const double exponents[] = {50, 20, 100};
    for (int k = 0; k < 3; k++) {
        creeps[3].shape.r = creeps[3].shape.s = creeps[3].shape.t = exponents[k];
        const ending e = run(&def);
        assert_good(&e);
        assert_true(e.t == 0.55);
    }
}

int main(void)
{
    const struct CMUnitTest closed_forms[] = {
        cmocka_unit_test(far_away_is_as_here),   cmocka_unit_test(far_along_the_line_is_known_to_its_rounding),
        cmocka_unit_test(nothing_falls_through), cmocka_unit_test(a_box_slides_on_a_box),
        cmocka_unit_test(friction_takes),        cmocka_unit_test(the_limit_of_events_is_told),
    };
    const struct CMUnitTest integrated[] = {
        cmocka_unit_test(exponents_are_one_or_more_by_far), cmocka_unit_test(time_advances_on_nearly_flat_places),
        cmocka_unit_test(compliance_holds_in_company),      cmocka_unit_test(tolerance_is_the_integrators_alone),
        cmocka_unit_test(a_pile_ends_at_every_tolerance),   cmocka_unit_test(calls_of_progress_are_bounded),
    };
    const int failed = cmocka_run_group_tests_name("impact.cases", closed_forms, NULL, NULL);
    if (!impact_has(IMPACT_PART_CVODE)) return failed;
    return failed + cmocka_run_group_tests_name("impact.cases", integrated, NULL, NULL);
}
