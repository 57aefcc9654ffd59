/* SPDX-License-Identifier: MIT
 *
 * Ellipsoids in a groove of two planes, with friction: the modes of both contacts at an instant against Coulomb's law,
 * and what is dropped there slides, rocks and rests without a stall.
 */
#include "contact/persist_system.h"
#include "kit/held_bodies.h"
#include "kit/islands.h"

enum { LEFT, RIGHT, EGG, BODIES };

typedef struct groove {
    impact_body_def bodies[BODIES];
    impact_scene_def def;
} groove;

/* Two planes through the y axis, 45 degrees from the floor, and an egg of any turn above. */
static void make_groove(groove *g, random_stream *random, double friction, double restitution, double duration)
{
    const double c = cos(0.39269908169872415), s = sin(0.39269908169872415);
    g->bodies[LEFT] = plane_body("left", (qvec3){0, 0, 0}, (quat){c, 0, s, 0}, 1, 1);
    g->bodies[RIGHT] = plane_body("right", (qvec3){0, 0, 0}, (quat){c, 0, -s, 0}, 1, 1);
    const double a = random_log(random, 0.15, 0.4), b = random_log(random, 0.15, 0.4),
                 d = random_log(random, 0.15, 0.4);
    g->bodies[EGG] = ellipsoid_body("egg", a, b, d, random_rotation(random));
    g->bodies[EGG].position = (qvec3){0.1 * random_unit(random), 0, 1};
    g->bodies[EGG].friction = friction;
    g->bodies[EGG].restitution = restitution;
    g->def = scene_of(g->bodies, BODIES, duration);
    g->def.friction_rule = g->def.restitution_rule = IMPACT_MINIMUM;
}

/* ---- at an instant ---- */

/* Sets the egg down on both planes, at rest; the groove's normals are orthogonal. */
static void set_down(groove *g)
{
    impact_body_def *egg = &g->bodies[EGG];
    qvec3 at = {0, 0, 0};
    for (int k = 0; k < 2; k++) {
        const qvec3 n = quat_rotate(g->bodies[k].orientation, (qvec3){0, 0, 1});
        const double reach =
            impact_shape_support(&egg->shape, quat_rotate_inverse(egg->orientation, qvec3_neg(n)), NULL);
        at = qvec3_axpy(reach, n, at);
    }
    egg->position = at;
}

/* Signorini's conditions and Coulomb's law of the touches as solved for, in accelerations; by how much of the load they
 * are off. */
static double off_coulomb(const imp_island *island)
{
    const imp_persist *persist = &island->motion.persist;
    const double load = mass * qvec3_norm(island->world.gravity), pull = qvec3_norm(island->world.gravity);
    double off = 0;
    for (int c = 0; c < persist->count; c++) {
        const imp_touch *touch = &persist->touches[c];
        const qvec3 rate = qvec3_add(touch->bias, imp_system_change(persist, touch));
        const qvec3 friction = qvec3_axpy(-touch->pressure, touch->normal, touch->force);
        off = fmax(off, -touch->pressure / load);
        off = fmax(off, fabs(qvec3_dot(touch->normal, rate)) / pull);
        off = fmax(off, (qvec3_norm(friction) - touch->friction * touch->pressure) / load);
        if (touch->mode == IMP_ROLL) {
            off = fmax(off, qvec3_norm(touch->slip_rate) / pull);
            continue;
        }
        const qvec3 against = qvec3_axpy(touch->friction * touch->pressure, touch->direction, friction);
        off = fmax(off, qvec3_norm(against) / load);
        const double along = qvec3_dot(touch->slip_rate, touch->direction);
        off = fmax(off, qvec3_norm(qvec3_axpy(-along, touch->direction, touch->slip_rate)) / pull);
        off = fmax(off, -along / pull);
    }
    return off;
}

static void modes_obey_coulomb(void **state)
{
    (void)state;
    random_stream random = {41};
    for (int k = 0; k < 3000; k++) {
        groove g;
        make_groove(&g, &random, random_log(&random, 0.01, 1), 0, 1);
        set_down(&g);
        g.def.gravity = (qvec3){random_unit(&random) - 0.5, random_unit(&random) - 0.5, -random_unit(&random)};
        impact_scene *scene = make_scene(&g.def);
        imp_island *island = whole_island(scene);
        imp_motion *motion = &island->motion;
        assert_int_equal(imp_scene_settle(island), IMPACT_OK);
        assert_true(motion->persist.count > 0 || g.def.gravity.z > -0.5);
        imp_field_loads(&island->world, 0, island->states, motion->loads);
        imp_persist_solve(&motion->persist, &island->world, island->states, motion->loads);
        assert_at_most(off_coulomb(island), 1e-9);
        imp_motion_close(&island->motion);
        impact_scene_destroy(scene);
    }
}

/* ---- in motion ---- */

typedef struct watch {
    const groove *g;
    double deepest;
} watch;

static bool watch_depth(void *context, const impact_sample *sample)
{
    watch *w = context;
    for (int k = 0; k < 2; k++) {
        const qvec3 n = quat_rotate(w->g->bodies[k].orientation, (qvec3){0, 0, 1});
        const qvec3 down = quat_rotate_inverse(sample->orientation, qvec3_neg(n));
        const double gap = qvec3_dot(n, sample->position) - impact_shape_support(&w->g->bodies[EGG].shape, down, NULL);
        w->deepest = fmax(w->deepest, -gap);
    }
    return true;
}

static void nothing_stalls_in_a_groove(void **state)
{
    (void)state;
    random_stream random = {42};
    for (int k = 0; k < 150; k++) {
        groove g;
        make_groove(&g, &random, random_log(&random, 0.05, 1), k % 3 * 0.3, 2.5);
        g.def.output_rate = 200;
        impact_scene *scene = make_scene(&g.def);
        watch w = {.g = &g};
        const impact_recorder recorder = {.struct_size = sizeof recorder, .context = &w, .sample = watch_depth};
        const impact_status status = impact_scene_run(scene, &recorder);
        if (status < 0) fail_msg("%d: t = %.17g: %s", k, impact_scene_time(scene), impact_scene_message(scene));
        const impact_energy e = impact_scene_energy(scene);
        assert_at_most((double)impact_scene_usage(scene).integrator_starts, 300);
        assert_at_most(w.deepest, 1e-11); /* what the integration leaves until the next event */
        assert_near(e.kinetic + e.potential + e.sliding_loss + e.impact_loss, e.start, 1e-9 * e.start);
        impact_scene_destroy(scene);
    }
}

int main(void)
{
    const struct CMUnitTest instants[] = {
        cmocka_unit_test(modes_obey_coulomb),
    };
    const struct CMUnitTest integrated[] = {
        cmocka_unit_test(nothing_stalls_in_a_groove),
    };
    const int failed = cmocka_run_group_tests(instants, NULL, NULL);
    if (!impact_has(IMPACT_PART_CVODE)) return failed;
    return failed + cmocka_run_group_tests(integrated, NULL, NULL);
}
