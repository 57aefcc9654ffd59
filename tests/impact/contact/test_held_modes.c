/* SPDX-License-Identifier: MIT
 *
 * Modes of held contacts against Coulomb's law, and against all modes there are: of ellipsoids in a groove of two
 * planes, and of bodies on planes and on each other that slide and stand there. What is dropped in a groove slides,
 * rocks and rests without a stall.
 */
#include "contact/held_system.h"
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

/* By how much a contact as solved for is off Signorini's conditions and Coulomb's law in accelerations, of forces and
 * of accelerations such as these. */
static double touch_off(const imp_held *held, const imp_held_contact *contact, double load, double pull)
{
    const qvec3 rate = qvec3_add(contact->bias, imp_system_change(held, contact));
    const qvec3 friction = qvec3_axpy(-contact->pressure, contact->normal, contact->force);
    const double gap_rate = qvec3_dot(contact->normal, rate) + qvec3_dot(contact->normal_rate, contact->slip);
    double off = fmax(-contact->pressure / load, fabs(gap_rate) / pull);
    off = fmax(off, (qvec3_norm(friction) - contact->friction * contact->pressure) / load);
    if (contact->mode == IMP_STICK) return fmax(off, qvec3_norm(contact->slip_rate) / pull);
    const qvec3 against = qvec3_axpy(contact->friction * contact->pressure, contact->direction, friction);
    off = fmax(off, qvec3_norm(against) / load);
    if (!contact->incipient) return off;
    const double along = qvec3_dot(contact->slip_rate, contact->direction);
    off = fmax(off, qvec3_norm(qvec3_axpy(-along, contact->direction, contact->slip_rate)) / pull);
    return fmax(off, -along / pull);
}

static double off_coulomb(const imp_island *island)
{
    const imp_held *held = &island->motion.held;
    const double load = mass * qvec3_norm(island->world.gravity), pull = qvec3_norm(island->world.gravity);
    double off = 0;
    for (int c = 0; c < held->count; c++) off = fmax(off, touch_off(held, &held->contacts[c], load, pull));
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
        assert_true(motion->held.count > 0 || g.def.gravity.z > -0.5);
        imp_field_loads(&island->world, 0, island->states, motion->loads);
        imp_held_solve(&motion->held, &island->world, island->states, motion->loads);
        assert_at_most(off_coulomb(island), 1e-9);
        imp_motion_close(&island->motion);
        impact_scene_destroy(scene);
    }
}

/* ---- bodies on planes and on each other ---- */

enum { MOVERS = 3, PLANES = 4, CONTACTS = MOVERS - 1 + PLANES };

/* Bodies in a row, each on the one before, and planes against some of them. */
typedef struct row {
    impact_body_def bodies[MOVERS + PLANES];
    impact_scene_def def;
    int movers, planes, on[PLANES]; /* which body each plane is against */
    qvec3 normals[CONTACTS];        /* of the bodies' contacts, then of the planes' */
} row;

static void make_row(row *r, random_stream *random)
{
    static const char *const names[MOVERS + PLANES] = {"a", "b", "c", "p", "q", "r", "s"};
    r->movers = 1 + (int)(random_unit(random) * MOVERS);
    r->planes = 1 + (int)(random_unit(random) * PLANES);
    for (int i = 0; i < r->movers; i++) {
        const double a = random_log(random, 0.15, 0.4), b = random_log(random, 0.15, 0.4),
                     c = random_log(random, 0.15, 0.4);
        r->bodies[i] = random_unit(random) < 0.5 ? ball_body(names[i], (qvec3){0, 0, 0}, 1, 0)
                                                 : ellipsoid_body(names[i], a, b, c, random_rotation(random));
        r->bodies[i].mass = mass * random_log(random, 0.2, 5);
        r->bodies[i].position = (qvec3){10 * i, 0, 0};
        r->bodies[i].friction = random_unit(random) < 0.1 ? 0 : random_log(random, 0.05, 0.8);
    }
    for (int k = 0; k < r->planes; k++) {
        r->on[k] = (int)(random_unit(random) * r->movers);
        r->bodies[r->movers + k] = plane_body(names[MOVERS + k], (qvec3){0, 0, -100}, quat_identity(), 1, 0);
    }
    for (int c = 0; c < CONTACTS; c++) r->normals[c] = random_direction(random);
    r->def = scene_of(r->bodies, r->movers + r->planes, 1);
    r->def.friction_rule = IMPACT_MINIMUM;
}

/* Of the body, from its centre: where its surface has this outward normal. */
static qvec3 reach(const imp_island *island, int body, qvec3 outward)
{
    const quat q = island->states[body].q;
    qvec3 point;
    impact_shape_support(&island->world.bodies[body].shape, quat_rotate_inverse(q, outward), &point);
    return quat_rotate(q, point);
}

static void hold_pair(imp_island *island, int i, int j, bool slides)
{
    for (int p = 0; p < island->world.pair_count; p++) {
        imp_pair *pair = &island->world.pairs[p];
        if (pair->body1 + pair->body2 != i + j || (pair->body1 != i && pair->body1 != j)) continue;
        pair->mode = slides || pair->law.friction == 0 ? IMP_SLIDE : IMP_STICK;
    }
}

/* Puts the bodies there, and moves them so that some contacts slide and others stand. */
static void set_up_row(const row *r, imp_island *island, random_stream *random, double sliding)
{
    imp_held *held = &island->motion.held;
    for (int i = 1; i < r->movers; i++) {
        const qvec3 n = r->normals[i - 1]; /* from the one before */
        island->states[i].x =
            qvec3_add(island->states[i - 1].x, qvec3_sub(reach(island, i - 1, n), reach(island, i, qvec3_neg(n))));
        hold_pair(island, i - 1, i, random_unit(random) < sliding);
    }
    for (int k = 0; k < r->planes; k++) {
        const qvec3 n = r->normals[MOVERS - 1 + k], z = {0, 0, 1}, axis = qvec3_cross(z, n);
        const double angle = atan2(qvec3_norm(axis), n.z);
        imp_state *plane = &island->states[r->movers + k];
        plane->q = quat_from_rotation_vector(qvec3_scale(axis, angle / qvec3_norm(axis)));
        plane->x = qvec3_add(island->states[r->on[k]].x, reach(island, r->on[k], qvec3_neg(n)));
        hold_pair(island, r->on[k], r->movers + k, random_unit(random) < sliding);
    }
    for (int i = 0; i < r->movers; i++) {
        island->states[i].v = random_vector(random, 0.1, 1);
        island->states[i].momentum =
            imp_inertia(&island->world.bodies[i], island->states[i].q, random_vector(random, 0.1, 3));
    }
    assert_int_equal(imp_held_reserve(held, &island->world, island->states), IMPACT_OK);
    assert_true(imp_field_loads(&island->world, 0, island->states, island->motion.loads));
    imp_held_project_velocities(held, &island->world, island->states, island->motion.loads);
    imp_held_project_velocities(held, &island->world, island->states, island->motion.loads);
}

/* What cannot slide stands. */
static void let_stand(imp_island *island)
{
    const imp_held *held = &island->motion.held;
    imp_held_find_contacts(&island->motion.held, &island->world, island->states, island->motion.loads);
    for (int c = 0; c < held->count; c++) {
        const imp_held_contact *contact = &held->contacts[c];
        if (contact->friction > 0 && contact->speed <= island->world.slip_speed)
            island->world.pairs[contact->pair].mode = IMP_STICK;
    }
}

static void load_row(const row *r, imp_island *island, random_stream *random)
{
    for (int i = 0; i < r->movers; i++) {
        const double weight = r->bodies[i].mass * gravity;
        island->motion.loads[i].force = random_vector(random, 0.1 * weight, 3 * weight);
        island->motion.loads[i].torque = random_vector(random, 0.01 * weight, 0.3 * weight);
    }
}

static double greatest_pull(const row *r, const imp_island *island)
{
    double pull = 0;
    for (int i = 0; i < r->movers; i++) {
        const imp_load *load = &island->motion.loads[i];
        pull = fmax(pull, qvec3_norm(load->force) / r->bodies[i].mass);
        pull = fmax(pull, qvec3_norm(imp_inverse_inertia(&island->world.bodies[i], island->states[i].q, load->torque)));
    }
    return pull;
}

/* By how much the pairs' modes, as solved for, are off the law; `asked`: pairs that were held. */
static double row_off(const row *r, imp_island *island, const bool *asked)
{
    imp_held *held = &island->motion.held;
    double load = 0, pull = greatest_pull(r, island), off = 0;
    for (int c = 0; c < held->count; c++) load = fmax(load, qvec3_norm(held->contacts[c].force));
    for (int i = 0; i < r->movers; i++) load = fmax(load, qvec3_norm(island->motion.loads[i].force));
    for (int c = 0; c < held->count; c++) off = fmax(off, touch_off(held, &held->contacts[c], load, pull));
    for (int p = 0; p < island->world.pair_count; p++) {
        if (!asked[p] || imp_is_held(&island->world.pairs[p])) continue;
        const imp_held_contact contact = imp_held_contact_at(&island->world, p, island->states, island->motion.loads);
        const qvec3 rate = qvec3_add(contact.bias, imp_system_change(held, &contact));
        off = fmax(off, -(qvec3_dot(contact.normal, rate) + qvec3_dot(contact.normal_rate, contact.slip)) / pull);
    }
    return off;
}

static void clear_effects_of(imp_island *island)
{
    for (int i = 0; i < island->world.body_count; i++)
        island->motion.held.effects[i] = (imp_effect){{0, 0, 0}, {0, 0, 0}};
}

static double solve_row(const row *r, imp_island *island, const bool *asked)
{
    imp_held *held = &island->motion.held;
    assert_int_equal(imp_held_reserve(held, &island->world, island->states), IMPACT_OK);
    if (held->count > 0)
        imp_held_solve(held, &island->world, island->states, island->motion.loads);
    else
        clear_effects_of(island);
    return row_off(r, island, asked);
}

/* ---- all modes there are ---- */

/* The pair's choice: open, as it slides, rolling, or sliding from rest against the friction that would hold it. */
static void choose_mode(imp_pair *pair, const imp_held_contact *contact, int choice)
{
    const bool goes = contact->mode == IMP_SLIDE && !contact->incipient;
    pair->mode = choice == 0 ? IMP_OPEN : goes || choice == 2 ? IMP_SLIDE : IMP_STICK;
    if (!goes)
        pair->slip = (imp_sliding){.stage = choice == 2 ? IMP_SLIP_INCIPIENT : IMP_SLIP_GROSS,
                                   .direction = imp_against_friction(contact)};
}

/* How many of all modes obey the law to that; the accelerations of the last that does. */
static int count_answers(const row *r, imp_island *island, const bool *asked, double allowed, imp_effect *found)
{
    imp_world *world = &island->world;
    imp_held_contact contacts[CONTACTS];
    int answers = 0, choices[CONTACTS], all = 1;
    (void)solve_row(r, island, asked);
    const int count = island->motion.held.count;
    memcpy(contacts, island->motion.held.contacts, sizeof *contacts * (size_t)count);
    for (int c = 0; c < count; c++) {
        choices[c] = contacts[c].mode == IMP_SLIDE ? 2 : 3;
        all *= choices[c];
    }
    for (int k = 0; k < all; k++) {
        for (int c = 0, rest = k; c < count; rest /= choices[c++])
            choose_mode(&world->pairs[contacts[c].pair], &contacts[c], rest % choices[c]);
        if (!(solve_row(r, island, asked) <= allowed)) continue;
        answers++;
        memcpy(found, island->motion.held.effects, sizeof *found * (size_t)r->movers);
    }
    return answers;
}

static double apart(const row *r, const imp_effect *a, const imp_effect *b)
{
    double off = 0;
    for (int i = 0; i < r->movers; i++) {
        off = fmax(off, qvec3_norm(qvec3_sub(a[i].linear, b[i].linear)));
        off = fmax(off, qvec3_norm(qvec3_sub(a[i].angular, b[i].angular)));
    }
    return off;
}

/* Where reactions are not unique some within the cones may do what those that are found of one choice of modes do not:
 * all modes there are then show nothing. */
static void check_row(const row *r, imp_island *island, int *solved, int *alike)
{
    imp_world *world = &island->world;
    imp_held *held = &island->motion.held;
    imp_pair given[(MOVERS + PLANES) * (MOVERS + PLANES)];
    bool asked[(MOVERS + PLANES) * (MOVERS + PLANES)];
    imp_effect own[MOVERS], found[MOVERS];
    const size_t bytes = sizeof *given * (size_t)world->pair_count;
    memcpy(given, world->pairs, bytes);
    for (int p = 0; p < world->pair_count; p++) asked[p] = imp_is_held(&given[p]);
    const impact_status status = imp_held_resolve(held, world, island->states, island->motion.loads);
    if (status == IMPACT_OK) {
        assert_at_most(solve_row(r, island, asked), 1e-9);
        memcpy(own, held->effects, sizeof *own * (size_t)r->movers);
        ++*solved;
    }
    memcpy(world->pairs, given, bytes);
    const int answers = count_answers(r, island, asked, 1e-9, found);
    if (status != IMPACT_OK) {
        assert_int_equal(status, IMPACT_EUNSETTLED);
        assert_int_equal(answers, 0);
    } else if (answers == 1) {
        assert_at_most(apart(r, own, found), 1e-6 * greatest_pull(r, island));
        ++*alike;
    }
}

static void modes_are_those_that_obey(void **state)
{
    (void)state;
    random_stream random = {43};
    enum { ROWS = 400 };
    int solved = 0, alike = 0;
    for (int k = 0; k < ROWS; k++) {
        row r;
        make_row(&r, &random);
        impact_scene *scene = make_scene(&r.def);
        imp_island *island = whole_island(scene);
        set_up_row(&r, island, &random, k % 3 * 0.4);
        let_stand(island);
        load_row(&r, island, &random);
        check_row(&r, island, &solved, &alike);
        imp_motion_close(&island->motion);
        impact_scene_destroy(scene);
    }
    assert_int_equal(solved, ROWS);
    assert_true(alike > ROWS / 2);
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
        cmocka_unit_test(modes_are_those_that_obey),
    };
    const struct CMUnitTest integrated[] = {
        cmocka_unit_test(nothing_stalls_in_a_groove),
    };
    const int failed = cmocka_run_group_tests(instants, NULL, NULL);
    if (!impact_has(IMPACT_PART_CVODE)) return failed;
    return failed + cmocka_run_group_tests(integrated, NULL, NULL);
}
