/* SPDX-License-Identifier: MIT
 *
 * The cone problem in the space of the bodies, against the same problem in that of the contacts: the same velocities,
 * and a residual that the contacts' own proof confirms. Its matrix against a dense product.
 */
#include "base/tolerances.h"
#include "contact/cone_bodies.h"
#include "kit/contact_random.h"
#include "kit/near.h"

#include <math.h>
#include <stdlib.h>

enum { BODIES = 8, MOST = 48 };

typedef struct many {
    imp_world world;
    imp_body bodies[BODIES];
    imp_state states[BODIES];
    imp_cone_contact contacts[MOST];
    imp_cone_row rows[MOST], turns[MOST];
    imp_cone_lengths lengths[MOST];
    double friction[MOST], w[36 * MOST * MOST], q[6 * MOST];
    int couples[MOST][2], count;
    bool turning;
} many;

static imp_cone_problem problem_of(const many *m)
{
    return (imp_cone_problem){
        .count = m->count, .w = m->w, .q = m->q, .friction = m->friction, .lengths = m->turning ? m->lengths : NULL};
}

static imp_cone_couples couples_of(const many *m)
{
    return (imp_cone_couples){
        .bodies = BODIES - 1, .of = (const int(*)[2])m->couples, .rows = m->rows, .turns = m->turns};
}

static double between(random_stream *random, double low, double high)
{
    return low + (high - low) * random_unit(random);
}

static qvec3 any_vector(random_stream *random)
{
    return (qvec3){between(random, -1, 1), between(random, -1, 1), between(random, -1, 1)};
}

/* Bodies of which the first is static, each on one before it, some on more; what approaches is drawn; with moments,
 * lengths up to a fifth of the arms. */
static void draw(many *m, random_stream *random, int count, double most_friction, bool turning)
{
    const int width = turning ? 6 : 3;
    *m = (many){.count = count, .turning = turning};
    m->world = (imp_world){.body_count = BODIES, .bodies = m->bodies};
    for (int i = 0; i < BODIES; i++) {
        const double mass = exp(between(random, -2, 2)), j = 0.4 * mass;
        m->bodies[i] = (imp_body){.is_static = i == 0, .mass = mass, .spherical = true};
        if (i > 0) m->bodies[i].inverse_mass = 1 / mass, m->bodies[i].inverse_moments = (qvec3){1 / j, 1 / j, 1 / j};
        m->bodies[i].moments = (qvec3){j, j, j};
        m->states[i] = (imp_state){.q = {1, 0, 0, 0}};
    }
    for (int c = 0; c < count; c++) {
        const int upper = 1 + c % (BODIES - 1), lower = (int)(between(random, 0, upper));
        qvec3 n = any_vector(random);
        n.z = 1 + fabs(n.z);
        m->contacts[c] =
            (imp_cone_contact){.body1 = upper, .body2 = lower, .arm1 = any_vector(random), .arm2 = any_vector(random)};
        imp_cone_find_axes(qvec3_scale(n, 1 / qvec3_norm(n)), m->contacts[c].axes);
        m->couples[c][0] = upper - 1, m->couples[c][1] = lower - 1;
        m->friction[c] = c % 5 == 0 ? 0 : between(random, 0, most_friction);
        m->q[width * c] = -fabs(between(random, 0, 1));
        for (int k = 1; k < width; k++) m->q[width * c + k] = between(random, -1, 1);
        if (!turning) continue;
        m->lengths[c].torsional = c % 4 == 1 ? 0 : between(random, 0, 0.2);
        m->lengths[c].rolling = c % 4 == 2 ? 0 : between(random, 0, 0.2);
    }
    if (turning)
        imp_cone_assemble_turning(&m->world, m->states, m->contacts, count, m->rows, m->turns, m->w);
    else
        imp_cone_assemble(&m->world, m->states, m->contacts, count, m->rows, m->w);
}

/* How many of the problems both spaces solve. */
static int compare_spaces(bool turning, int problems)
{
    imp_arena *arena;
    assert_int_equal(imp_arena_create(NULL, &arena), IMPACT_OK);
    imp_cone_bodies bodies = {.arena = arena};
    imp_cone_workspace contacts = {.arena = arena};
    random_stream random = {11};
    const int width = turning ? 6 : 3;
    int settled = 0;
    many *m = malloc(sizeof *m);
    for (int k = 0; k < problems; k++) {
        double r[6 * MOST], u[6 * MOST], other_r[6 * MOST], other_u[6 * MOST];
        draw(m, &random, 1 + k % MOST, 0.5, turning);
        const imp_cone_problem problem = problem_of(m);
        const imp_cone_couples couples = couples_of(m);
        const imp_cone_outcome quick = imp_cone_solve_bodies(&bodies, &problem, &couples, r, u);
        assert_true((turning ? imp_cone_reserve_turning : imp_cone_reserve)(&contacts, m->count));
        const imp_cone_outcome exact = imp_cone_solve(&problem, &contacts, other_r, other_u, NULL);
        if (exact.status != IMP_CONE_SOLVED || quick.status != IMP_CONE_SOLVED) continue;
        settled++;
        double seen[6 * MOST];
        assert_true(imp_cone_residual(&problem, r, seen) <= 2 * IMP_BODIES_ACCEPTED);
        for (int i = 0; i < width * m->count; i++)
            if (i % width == 0 || m->friction[i / width] > 0) assert_near(u[i], seen[i], 1e-6);
        if (m->count > BODIES) continue; /* friction may leave a choice of motions */
        for (int i = 0; i < width * m->count; i++)
            if (i % width == 0 || m->friction[i / width] > 0) assert_near(u[i], other_u[i], 1e-4);
    }
    free(m);
    imp_arena_destroy(arena);
    return settled;
}

static void velocities_are_those_of_the_contacts_own_space(void **state)
{
    (void)state;
    enum { PROBLEMS = 400 };
    assert_true(compare_spaces(false, PROBLEMS) >= PROBLEMS * 9 / 10); /* the others are told: much friction */
}

static void with_moments_too(void **state)
{
    (void)state;
    enum { PROBLEMS = 200 };
    assert_true(compare_spaces(true, PROBLEMS) >=
                PROBLEMS * 7 / 10); /* the others are told, and the contacts' to solve */
}

/* ---- faces that slide and turn on each other ---- */

enum { RIM = 12, DISCS = MOST / RIM };

static qvec3 velocity_at(const qvec3 v[2], qvec3 arm) { return qvec3_add(v[0], qvec3_cross(v[1], arm)); }

/* Discs on a floor, each on the one before it at twelve places of the smaller rim, a light one under each heavy one:
 * they slide, turn and are about to tip, and weight presses them. */
static void stack_discs(many *m, random_stream *random)
{
    double radius[DISCS + 1] = {2};
    qvec3 moves[DISCS + 1][2] = {{{0, 0, 0}, {0, 0, 0}}};
    *m = (many){.count = MOST};
    m->world = (imp_world){.body_count = BODIES, .bodies = m->bodies};
    for (int i = 0; i < BODIES; i++) {
        m->bodies[i] = (imp_body){.is_static = i == 0 || i > DISCS, .mass = 1, .moments = {1, 1, 1}};
        m->states[i] = (imp_state){.q = {1, 0, 0, 0}};
    }
    for (int i = 1; i <= DISCS; i++) {
        const double mass = (i % 2 ? 1 : 100) * between(random, 0.5, 2);
        radius[i] = between(random, 0.5, 1);
        const double across = mass * radius[i] * radius[i] / 4, about = 2 * across;
        m->bodies[i] = (imp_body){.mass = mass,
                                  .inverse_mass = 1 / mass,
                                  .moments = {across, across, about},
                                  .inverse_moments = {1 / across, 1 / across, 1 / about}};
        moves[i][0] = qvec3_scale(any_vector(random), 0.02), moves[i][1] = qvec3_scale(any_vector(random), 0.02);
        moves[i][0].z = -0.1;
        const double rim = fmin(radius[i], radius[i - 1]), friction = between(random, 0.1, 0.5);
        const qvec3 shift = {between(random, -0.1, 0.1), between(random, -0.1, 0.1), 0};
        for (int k = 0; k < RIM; k++) {
            const int c = RIM * (i - 1) + k;
            const double angle = 2 * acos(-1) * k / RIM;
            const qvec3 place = {rim * cos(angle), rim * sin(angle), 0};
            m->contacts[c] = (imp_cone_contact){.body1 = i,
                                                .body2 = i - 1,
                                                .arm1 = qvec3_add(place, (qvec3){0, 0, -0.1}),
                                                .arm2 = qvec3_add(qvec3_add(place, shift), (qvec3){0, 0, 0.1})};
            imp_cone_find_axes((qvec3){0, 0, 1}, m->contacts[c].axes);
            m->couples[c][0] = i - 1, m->couples[c][1] = i - 2;
            m->friction[c] = friction;
            const qvec3 u =
                qvec3_sub(velocity_at(moves[i], m->contacts[c].arm1), velocity_at(moves[i - 1], m->contacts[c].arm2));
            for (int l = 0; l < 3; l++) m->q[3 * c + l] = qvec3_dot(m->contacts[c].axes[l], u);
        }
    }
    imp_cone_assemble(&m->world, m->states, m->contacts, m->count, m->rows, m->w);
}

/* Contacts that give lead to the answer: without them half are not found so soon. */
static void discs_on_each_other_are_solved_soon(void **state)
{
    (void)state;
    enum { PROBLEMS = 200 };
    imp_arena *arena;
    assert_int_equal(imp_arena_create(NULL, &arena), IMPACT_OK);
    imp_cone_bodies bodies = {.arena = arena};
    random_stream random = {12};
    int solved = 0;
    many *m = malloc(sizeof *m);
    for (int k = 0; k < PROBLEMS; k++) {
        double r[3 * MOST], u[3 * MOST], seen[3 * MOST];
        stack_discs(m, &random);
        imp_cone_problem problem = problem_of(m);
        problem.effort = IMP_CONE_BRIEF;
        problem.enough = 1e-3;
        const imp_cone_couples couples = couples_of(m);
        const imp_cone_outcome outcome = imp_cone_solve_bodies(&bodies, &problem, &couples, r, u);
        if (outcome.residual > problem.enough) continue;
        solved++;
        assert_true(imp_cone_residual(&problem, r, seen) <= 1.01 * problem.enough);
    }
    free(m);
    imp_arena_destroy(arena);
    assert_true(solved >= PROBLEMS * 99 / 100);
}

/* Coulomb's law with at least so much pressed at each contact: what is beyond it only where nothing opens; friction
 * within its cone, and against the slip with all its force. In units of the largest reaction and velocity. */
static double off_law(const many *m, const double *least, const double *r, const double *u)
{
    double most = 0, fastest = 0, off = 0;
    for (int i = 0; i < 3 * m->count; i++) most = fmax(most, fabs(r[i])), fastest = fmax(fastest, fabs(m->q[i]));
    for (int c = 0; c < m->count; c++) {
        const double *f = &r[3 * c], *v = &u[3 * c], bound = m->friction[c] * f[0];
        const double slip = m->friction[c] > 0 ? hypot(v[1], v[2]) : 0;
        const double beyond = f[0] - least[c], outside = hypot(f[1], f[2]) - bound,
                     along = f[1] * v[1] + f[2] * v[2] + bound * slip;
        off = fmax(off, fmax(fabs(fmin(beyond / most, v[0] / fastest)), fmax(outside / most, 0)));
        off = fmax(off, fabs(along) / (most * fastest));
    }
    return off;
}

static void at_least_so_much_is_pressed(void **state)
{
    (void)state;
    enum { PROBLEMS = 300 };
    imp_arena *arena;
    assert_int_equal(imp_arena_create(NULL, &arena), IMPACT_OK);
    imp_cone_bodies bodies = {.arena = arena};
    random_stream random = {12};
    many *m = malloc(sizeof *m);
    int settled = 0, pressed = 0, opened = 0;
    for (int k = 0; k < PROBLEMS; k++) {
        double r[3 * MOST], u[3 * MOST], least[MOST];
        draw(m, &random, 1 + k % MOST, 0.5, false);
        for (int c = 0; c < m->count; c++) least[c] = c % 3 == 0 ? 0 : between(&random, 0, 0.5);
        imp_cone_problem problem = problem_of(m);
        problem.enough = 1e-11;
        imp_cone_couples couples = couples_of(m);
        couples.least = least;
        const imp_cone_outcome outcome = imp_cone_solve_bodies(&bodies, &problem, &couples, r, u);
        if (outcome.residual > 1e-9) continue;
        settled++;
        assert_true(off_law(m, least, r, u) <= 1e-8);
        for (int c = 0; c < m->count; c++) pressed += r[3 * c] > least[c], opened += least[c] > 0 && u[3 * c] > 1e-6;
    }
    assert_true(settled >= PROBLEMS * 9 / 10 && pressed > settled && opened > settled);
    free(m);
    imp_arena_destroy(arena);
}

/* What is enough is met, by no more steps than more takes. */
static void no_more_is_found_than_is_asked(void **state)
{
    (void)state;
    imp_arena *arena;
    assert_int_equal(imp_arena_create(NULL, &arena), IMPACT_OK);
    imp_cone_bodies bodies = {.arena = arena};
    random_stream random = {13};
    many *m = malloc(sizeof *m);
    long rough = 0, fine = 0;
    for (int k = 0; k < 100; k++) {
        double r[3 * MOST], u[3 * MOST];
        draw(m, &random, 1 + k % MOST, 0.5, false);
        imp_cone_problem problem = problem_of(m);
        const imp_cone_couples couples = couples_of(m);
        const imp_cone_outcome all = imp_cone_solve_bodies(&bodies, &problem, &couples, r, u);
        problem.enough = 1e-4;
        const imp_cone_outcome some = imp_cone_solve_bodies(&bodies, &problem, &couples, r, u);
        assert_true(some.residual <= 1e-4 || some.residual <= all.residual);
        assert_true(some.steps <= all.steps);
        rough += some.steps, fine += all.steps;
    }
    assert_true(rough < fine);
    free(m);
    imp_arena_destroy(arena);
}

/* L U x = A b for b of a matrix that is not symmetric. */
static void a_skyline_is_solved(void **state)
{
    (void)state;
    enum { N = 5 };
    imp_arena *arena;
    assert_int_equal(imp_arena_create(NULL, &arena), IMPACT_OK);
    imp_skyline sky = {.arena = arena};
    random_stream random = {3};
    const int touching[5][2] = {{0, 3}, {3, 1}, {-1, 2}, {4, 0}, {1, 1}};
    static double dense[6 * N][6 * N];
    assert_true(imp_skyline_shape(&sky, N, touching, 5));
    imp_skyline_clear(&sky);
    for (int k = 0; k < 5 + N; k++) {
        const int a = k < 5 ? touching[k][0] : k - 5, b = k < 5 ? touching[k][1] : k - 5;
        if (a < 0 || b < 0) continue;
        for (int turn = 0; turn < 2; turn++) {
            double block[6][6];
            for (int i = 0; i < 6; i++)
                for (int j = 0; j < 6; j++) {
                    block[i][j] = between(&random, -1, 1) + (a == b && i == j ? 9 : 0);
                    dense[6 * (turn ? b : a) + i][6 * (turn ? a : b) + j] += block[i][j];
                }
            imp_skyline_add(&sky, turn ? b : a, turn ? a : b, block);
        }
    }
    double x[6 * N], b[6 * N];
    for (int i = 0; i < 6 * N; i++) b[i] = between(&random, -1, 1);
    for (int i = 0; i < 6 * N; i++) {
        x[i] = 0;
        for (int j = 0; j < 6 * N; j++) x[i] += dense[i][j] * b[j];
    }
    assert_true(imp_skyline_factor(&sky));
    imp_skyline_solve(&sky, x);
    for (int i = 0; i < 6 * N; i++) assert_near(x[i], b[i], 1e-13);
    imp_arena_destroy(arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(velocities_are_those_of_the_contacts_own_space),
        cmocka_unit_test(with_moments_too),
        cmocka_unit_test(discs_on_each_other_are_solved_soon),
        cmocka_unit_test(at_least_so_much_is_pressed),
        cmocka_unit_test(no_more_is_found_than_is_asked),
        cmocka_unit_test(a_skyline_is_solved),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
