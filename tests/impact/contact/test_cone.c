/* SPDX-License-Identifier: MIT
 *
 * The cone solver against problems made from a known answer, against all modes of planar problems tried one by one,
 * and against what the problem's form alone says: order, units, frames.
 */
#include "contact/cone.h"
#include "contact/cone_assemble.h"
#include "kit/cone_cases.h"
#include "kit/near.h"

#include <stdlib.h>
#include <string.h>

enum { MOST = 24 };

static imp_cone_workspace room;

typedef struct answer {
    imp_cone_outcome outcome;
    double r[3 * MOST], u[3 * MOST];
    imp_cone_mode modes[MOST];
} answer;

static answer solve(const imp_cone_problem *problem)
{
    answer a;
    assert_true(imp_cone_reserve(&room, problem->count));
    a.outcome = imp_cone_solve(problem, &room, a.r, a.u, a.modes);
    return a;
}

/* Signorini's and Coulomb's law as words, each to a part of the largest, in sums of their own. */
static void assert_law(const imp_cone_problem *problem, const answer *a)
{
    const int n = 3 * problem->count;
    double most = 0, size = 0;
    for (int i = 0; i < n; i++) most = fmax(most, fabs(a->r[i])), size = fmax(size, fabs(problem->q[i]));
    const double tiny_r = 1e-12 * most, tiny_u = 1e-12 * size;
    for (int c = 0; c < problem->count; c++) {
        long double u[3];
        for (int k = 0; k < 3; k++) {
            u[k] = problem->q[3 * c + k];
            for (int j = 0; j < n; j++) u[k] += (long double)problem->w[(3 * c + k) * n + j] * a->r[j];
            assert_near(a->u[3 * c + k], (double)u[k], 1e-13 * size + 1e-14 * fabs((double)u[k]));
        }
        const double *r = &a->r[3 * c], friction = problem->friction[c];
        const double rubs = hypot(r[1], r[2]), slip = (double)hypotl(u[1], u[2]);
        assert_at_most(-r[0], 0);
        assert_at_most(rubs - friction * r[0], tiny_r);
        assert_at_most(-(double)u[0], tiny_u);
        if (r[0] > tiny_r) assert_near((double)u[0], 0, tiny_u);
        if (friction == 0 || rubs == 0) continue;
        if (rubs < friction * r[0] - tiny_r) assert_near(slip, 0, tiny_u);
        if (slip > 1e-6 * size && rubs > 1e-6 * most)
            assert_near((r[1] * (double)u[1] + r[2] * (double)u[2]) / (rubs * slip), -1, 1e-9);
    }
}

/* ---- one contact ---- */

/* W = diag(a, b, b): the normal and the friction do not feel each other. */
static void one_contact_has_a_closed_form(void **state)
{
    (void)state;
    random_stream random = {3};
    for (int k = 0; k < 3000; k++) {
        const double a = random_log(&random, 1e-3, 1e3), b = random_log(&random, 1e-3, 1e3);
        const double friction = random_log(&random, 0.01, 10), w[9] = {a, 0, 0, 0, b, 0, 0, 0, b};
        const double q[3] = {cone_between(&random, -1, 0.2), cone_between(&random, -1, 1),
                             cone_between(&random, -1, 1)};
        const imp_cone_problem problem = {.count = 1, .w = w, .q = q, .friction = &friction};
        const answer got = solve(&problem);
        const double pressure = fmax(0, -q[0] / a), slip = hypot(q[1], q[2]), most = friction * pressure;
        const double rubs = fmin(most, slip / b), scale = fmax(fabs(pressure), fabs(rubs));
        assert_int_equal(got.outcome.status, IMP_CONE_SOLVED);
        assert_near(got.r[0], pressure, 1e-12 * scale);
        for (int i = 1; i < 3; i++) assert_near(got.r[i], -rubs * q[i] / slip, 1e-12 * scale);
        assert_int_equal(got.modes[0], pressure == 0     ? IMP_CONE_OPEN
                                       : slip / b < most ? IMP_CONE_STICKS
                                                         : IMP_CONE_SLIDES);
    }
}

/* ---- known answers ---- */

static void known_answers_are_found(void **state)
{
    (void)state;
    random_stream random = {11};
    int same = 0, runs = 0, chosen = 0;
    for (int k = 0; k < 1500; k++) {
        const int count = 1 + (int)cone_between(&random, 0, 11.99), bodies = 1 + count / (1 + k % 4);
        cone_case c = cone_case_make(&random, count, bodies, 1);
        const imp_cone_problem problem = cone_case_problem(&c);
        const answer got = solve(&problem);
        assert_int_equal(got.outcome.status, IMP_CONE_SOLVED);
        assert_at_most(got.outcome.residual, 1e-13);
        assert_law(&problem, &got);
        double off = 0;
        for (int i = 0; i < 3 * count; i++) off = fmax(off, fabs(got.u[i] - c.u[i]));
        same += off < 1e-11, runs++, chosen += got.outcome.chosen;
        cone_case_free(&c);
    }
    assert_true(same > 0.9 * runs); /* where friction leaves more than one answer another may come */
    assert_true(chosen > 50);       /* and reactions that nothing tells apart were among them */
}

/* Wedges and frictions to 10: what is not solved is told, with a residual; none of it as solved. */
static void hard_ones_are_solved_or_told(void **state)
{
    (void)state;
    random_stream random = {12};
    int solved = 0;
    enum { RUNS = 400 };
    for (int k = 0; k < RUNS; k++) {
        cone_case c = cone_case_make(&random, 10, 3 + k % 8, 10);
        imp_cone_problem problem = cone_case_problem(&c);
        problem.effort = IMP_CONE_WANDERS;
        const answer got = solve(&problem);
        double u[3 * MOST];
        const double residual = imp_cone_residual(&problem, got.r, u);
        assert_int_equal(got.outcome.status == IMP_CONE_SOLVED, residual <= 1e-13);
        assert_int_not_equal(got.outcome.status, IMP_CONE_NO_SOLUTION);
        if (got.outcome.status == IMP_CONE_SOLVED) assert_law(&problem, &got), solved++;
        cone_case_free(&c);
    }
    assert_true(solved >= 0.995 * RUNS);
}

/* Of contacts whose masses are 1e10 times apart the residual cannot come under what rounding leaves: ways that would be
 * tried to the last digit are left where what is asked is reached. */
static void no_more_is_found_than_is_asked(void **state)
{
    (void)state;
    enum { COUNT = 22 };
    random_stream random = {17};
    long less = 0, more = 0;
    for (int k = 0; k < 20; k++) {
        cone_case c = cone_case_make(&random, COUNT, 4, 1);
        for (int i = 0; i < 3 * COUNT; i++) {
            const double light = i / 3 % 2 ? 1e5 : 1;
            c.q[i] *= light;
            for (int j = 0; j < 3 * COUNT; j++) c.w[i * 3 * COUNT + j] *= light * (j / 3 % 2 ? 1e5 : 1);
        }
        imp_cone_problem problem = cone_case_problem(&c);
        problem.effort = IMP_CONE_BRIEF;
        more += solve(&problem).outcome.factorings;
        problem.enough = 1e-3;
        const answer got = solve(&problem);
        less += got.outcome.factorings;
        assert_at_most(got.outcome.residual, problem.enough);
        cone_case_free(&c);
    }
    assert_true(3 * less < more);
}

/* Paths end where the work allowed is done, and say that they found nothing. */
static void work_is_bounded(void **state)
{
    (void)state;
    random_stream random = {12};
    int unsettled = 0;
    for (int k = 0; k < 20; k++) {
        cone_case c = cone_case_make(&random, 10, 5, 1);
        imp_cone_problem problem = cone_case_problem(&c);
        const answer whole = solve(&problem);
        assert_int_equal(whole.outcome.status, IMP_CONE_SOLVED);
        problem.work = 1; /* one system is more */
        const answer cut = solve(&problem);
        unsettled += cut.outcome.status == IMP_CONE_UNSETTLED;
        assert_true(cut.outcome.factorings < 10);
        cone_case_free(&c);
    }
    assert_true(unsettled >= 15); /* Newton from where it begins finds a few */
}

/* Two boxes, four corners each: the lower one rests, the upper one comes down, both all but flat. What is pressed at
 * eight points has more reactions than motions; the matrix of the path is as badly conditioned as 1/e^2. */
static void a_struck_stack_is_solved(void **state)
{
    (void)state;
    enum { CORNERS = 4, CONTACTS = 2 * CORNERS, N = 3 * CONTACTS, WIDTH = 12 };
    static const double corners[CORNERS][2] = {{-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
    random_stream random = {204};
    cone_case c = cone_case_room(CONTACTS, false);
    double g[N][WIDTH] = {{0}};
    for (int k = 0; k < CONTACTS; k++) {
        const double *at = corners[k % CORNERS];
        for (int side = 0; side <= k / CORNERS; side++)
            for (int row = 0; row < 3; row++) {
                const qvec3 axis = {row == 1, row == 2, row == 0}, arm = {at[0], at[1], side ? 0.5 : -0.5},
                            turn = qvec3_scale(qvec3_cross(arm, axis), 1.5);
                const double six[6] = {axis.x, axis.y, axis.z, turn.x, turn.y, turn.z};
                for (int m = 0; m < 6; m++) g[3 * k + row][6 * (k / CORNERS - side) + m] = side ? -six[m] : six[m];
            }
        c.friction[k] = 0.7;
        c.q[3 * k] = k < CORNERS ? -0.005 : -32;
        for (int m = 0; m < 3; m++) c.q[3 * k + m] += (k < CORNERS ? 1e-9 : 1e-7) * cone_between(&random, -1, 1);
    }
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++)
            for (int m = 0; m < WIDTH; m++) c.w[i * N + j] += g[i][m] * g[j][m];
    const imp_cone_problem problem = cone_case_problem(&c);
    const answer a = solve(&problem);
    assert_int_equal(a.outcome.status, IMP_CONE_SOLVED);
    assert_law(&problem, &a);
    cone_case_free(&c);
}

static void the_last_answer_leads_to_the_next(void **state)
{
    (void)state;
    random_stream random = {13};
    int at_once = 0;
    enum { RUNS = 300 };
    for (int k = 0; k < RUNS; k++) {
        cone_case c = cone_case_make(&random, 10, 5 + k % 8, 1);
        imp_cone_problem problem = cone_case_problem(&c);
        const answer first = solve(&problem);
        double change[3 * MOST];
        for (int i = 0; i < 30; i++) change[i] = 1e-6 * cone_between(&random, -1, 1);
        for (int i = 0; i < 30; i++)
            for (int j = 0; j < 30; j++) c.q[i] += c.w[30 * i + j] * change[j];
        problem.last_r = first.r, problem.last_u = first.u;
        const answer next = solve(&problem);
        assert_int_equal(next.outcome.status, IMP_CONE_SOLVED);
        assert_law(&problem, &next);
        at_once += next.outcome.stage == IMP_CONE_LAST && next.outcome.factorings <= 3;
        cone_case_free(&c);
    }
    assert_true(at_once > 0.9 * RUNS);
}

/* ---- planar twins: every choice of modes, one by one ---- */

enum { PLANAR = 4, WIDE = 2 * PLANAR };

/* Gauss with row pivots; false where none is left. */
static bool eliminate(double a[WIDE][WIDE + 1], int n)
{
    for (int k = 0; k < n; k++) {
        int row = k;
        for (int i = k + 1; i < n; i++)
            if (fabs(a[i][k]) > fabs(a[row][k])) row = i;
        if (fabs(a[row][k]) < 1e-9) return false;
        for (int j = 0; j <= n; j++) {
            const double swap = a[k][j];
            a[k][j] = a[row][j], a[row][j] = swap;
        }
        for (int i = 0; i < n; i++) {
            const double factor = a[i][k] / a[k][k];
            for (int j = k; i != k && j <= n; j++) a[i][j] -= factor * a[k][j];
        }
    }
    for (int i = 0; i < n; i++) a[i][n] /= a[i][i];
    return true;
}

/* Open, sticking, sliding either way: the planar problem's answer under these modes; false where it breaks them. */
static bool try_modes(const double *w, const double *q, const double *friction, int count, int choice, double *r)
{
    const int n = 2 * count;
    double a[WIDE][WIDE + 1] = {{0}};
    int modes[PLANAR];
    for (int c = 0; c < count; c++, choice /= 4) {
        const int i = 2 * c;
        modes[c] = choice % 4;
        for (int k = 0; k < 2; k++) {
            for (int j = 0; j < n; j++) a[i + k][j] = w[(i + k) * n + j];
            a[i + k][n] = -q[i + k];
        }
        for (int k = 0; k < 2; k++) {
            if (modes[c] == 1 || (modes[c] > 1 && k == 0)) continue;
            for (int j = 0; j <= n; j++) a[i + k][j] = 0;
            a[i + k][i + k] = 1; /* r_k = 0, or r_t = -/+ mu r_n */
            if (modes[c] > 1) a[i + k][i] = modes[c] == 2 ? friction[c] : -friction[c];
        }
    }
    if (!eliminate(a, n)) return false;
    for (int i = 0; i < n; i++) r[i] = a[i][n];
    for (int c = 0; c < count; c++) {
        double u[2];
        for (int k = 0; k < 2; k++) {
            u[k] = q[2 * c + k];
            for (int j = 0; j < n; j++) u[k] += w[(2 * c + k) * n + j] * r[j];
        }
        const double rn = r[2 * c], rt = r[2 * c + 1], tiny = 1e-9;
        if (rn < -tiny || u[0] < -tiny || fabs(rt) > friction[c] * rn + tiny) return false;
        if (modes[c] == 2 && u[1] < -tiny) return false;
        if (modes[c] == 3 && u[1] > tiny) return false;
    }
    return true;
}

static void planar_twins_are_among_all_modes(void **state)
{
    (void)state;
    random_stream random = {17};
    int compared = 0;
    for (int k = 0; k < 600; k++) {
        const int count = 1 + k % PLANAR, n = 2 * count;
        double g[WIDE][WIDE], w[WIDE * WIDE], q[WIDE], friction[PLANAR], whole[9 * PLANAR * PLANAR] = {0};
        double lifted[3 * PLANAR] = {0};
        for (int i = 0; i < n; i++)
            for (int j = 0; j < n; j++) g[i][j] = cone_between(&random, -1, 1);
        for (int i = 0; i < n; i++) {
            q[i] = cone_between(&random, -1, i % 2 ? 1 : 0.3);
            lifted[3 * (i / 2) + i % 2] = q[i];
            for (int j = 0; j < n; j++) {
                w[i * n + j] = i == j ? 0.1 : 0;
                for (int l = 0; l < n; l++) w[i * n + j] += g[i][l] * g[j][l];
                whole[(3 * (i / 2) + i % 2) * 3 * count + 3 * (j / 2) + j % 2] = w[i * n + j];
            }
        }
        for (int c = 0; c < count; c++) {
            friction[c] = random_log(&random, 0.05, 1);
            whole[(3 * c + 2) * (3 * count + 1)] = 1;
        }
        const imp_cone_problem problem = {.count = count, .w = whole, .q = lifted, .friction = friction};
        const answer got = solve(&problem);
        assert_int_equal(got.outcome.status, IMP_CONE_SOLVED);
        double nearest = INFINITY;
        for (int choice = 0; choice < 1 << (2 * count); choice++) {
            double r[WIDE], off = 0, size = 0;
            if (!try_modes(w, q, friction, count, choice, r)) continue;
            for (int i = 0; i < n; i++) {
                off = fmax(off, fabs(r[i] - got.r[3 * (i / 2) + i % 2]));
                size = fmax(size, fabs(r[i]));
            }
            nearest = fmin(nearest, off / fmax(size, 1e-300));
        }
        if (isfinite(nearest)) assert_at_most(nearest, 1e-8), compared++;
    }
    assert_true(compared > 550);
}

/* ---- what the form says ---- */

static void shuffle(random_stream *random, int *order, int count)
{
    for (int i = 0; i < count; i++) order[i] = i;
    for (int i = count - 1; i > 0; i--) {
        const int j = (int)(random_unit(random) * (i + 1)), swap = order[i];
        order[i] = order[j], order[j] = swap;
    }
}

static void shuffled_contacts_give_the_same_bits(void **state)
{
    (void)state;
    random_stream random = {19};
    for (int k = 0; k < 200; k++) {
        const int count = 2 + k % 12, n = 3 * count;
        cone_case c = cone_case_make(&random, count, 1 + count / 2, 1), d = cone_case_make(&random, count, 1, 1);
        int order[MOST];
        shuffle(&random, order, count);
        for (int i = 0; i < n; i++) {
            const int from = 3 * order[i / 3] + i % 3;
            d.q[i] = c.q[from];
            d.friction[i / 3] = c.friction[order[i / 3]];
            for (int j = 0; j < n; j++) d.w[i * n + j] = c.w[from * n + 3 * order[j / 3] + j % 3];
        }
        const imp_cone_problem one = cone_case_problem(&c), two = cone_case_problem(&d);
        const answer a = solve(&one), b = solve(&two);
        for (int i = 0; i < n; i++) assert_true(b.r[i] == a.r[3 * order[i / 3] + i % 3]);
        cone_case_free(&c);
        cone_case_free(&d);
    }
}

/* Masses and times in other units: by powers of two the same bits, by other factors the same to rounding. */
static void units_scale_out(void **state)
{
    (void)state;
    random_stream random = {23};
    for (int k = 0; k < 200; k++) {
        const int count = 1 + k % 10, n = 3 * count;
        const bool exact = k % 2;
        const double mass = exact ? ldexp(1, k % 60 - 30) : random_log(&random, 1e-9, 1e9);
        const double speed = exact ? ldexp(1, 20 - k % 41) : random_log(&random, 1e-9, 1e9);
        cone_case c = cone_case_make(&random, count, 2 * count, 0.5);
        const imp_cone_problem problem = cone_case_problem(&c);
        const answer a = solve(&problem);
        for (int i = 0; i < n * n; i++) c.w[i] /= mass;
        for (int i = 0; i < n; i++) c.q[i] *= speed;
        const answer b = solve(&problem);
        double most = 0;
        for (int i = 0; i < n; i++) most = fmax(most, fabs(a.r[i]));
        for (int i = 0; i < n; i++) {
            assert_near(b.u[i] / speed, a.u[i], exact ? 0 : 1e-9);
            if (exact || !a.outcome.chosen) assert_near(b.r[i] / (mass * speed), a.r[i], exact ? 0 : 1e-9 * most);
        }
        cone_case_free(&c);
    }
}

/* ---- what cannot be, and what is no problem ---- */

/* A body of one unit of mass between two walls that come nearer. */
static void what_has_no_solution_is_shown(void **state)
{
    (void)state;
    double w[36] = {0}, q[6] = {-1, 0.2, 0, -1, 0.1, 0};
    const double friction[2] = {0.3, 0.4};
    for (int k = 0; k < 3; k++) {
        w[7 * k] = w[7 * (k + 3)] = 1;
        w[6 * k + k + 3] = w[6 * (k + 3) + k] = k == 0 ? -1 : 1;
    }
    const imp_cone_problem problem = {.count = 2, .w = w, .q = q, .friction = friction};
    const answer got = solve(&problem);
    assert_int_equal(got.outcome.status, IMP_CONE_NO_SOLUTION);
    assert_near(got.r[0], 0.5, 1e-9);
    assert_near(got.r[3], 0.5, 1e-9);
    assert_true(got.outcome.least_reactions > 1e8);
    q[3] = 1; /* the walls go the same way: the first pushes */
    assert_int_equal(solve(&problem).outcome.status, IMP_CONE_SOLVED);
}

static void bad_numbers_are_refused(void **state)
{
    (void)state;
    double w[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, q[3] = {-1, 0, 0}, friction = 0.5;
    const imp_cone_problem problem = {.count = 1, .w = w, .q = q, .friction = &friction};
    const double bad[] = {NAN, INFINITY, -INFINITY};
    for (int k = 0; k < 3; k++) {
        w[4] = bad[k];
        assert_int_equal(solve(&problem).outcome.status, IMP_CONE_BAD);
        w[4] = 1, q[1] = bad[k];
        assert_int_equal(solve(&problem).outcome.status, IMP_CONE_BAD);
        q[1] = 0, friction = bad[k];
        assert_int_equal(solve(&problem).outcome.status, IMP_CONE_BAD);
        friction = 0.5;
    }
    friction = -1e-300;
    assert_int_equal(solve(&problem).outcome.status, IMP_CONE_BAD);
    imp_cone_workspace none = {.capacity = 0};
    double r[3], u[3];
    friction = 0.5;
    assert_int_equal(imp_cone_solve(&problem, &none, r, u, NULL).status, IMP_CONE_BAD);
    const imp_cone_problem nothing = {.count = 0};
    assert_int_equal(imp_cone_solve(&nothing, &none, r, u, NULL).status, IMP_CONE_SOLVED);
}

/* ---- bodies ---- */

/* W r is what impulses r do to the velocities of the contacts. */
static void the_matrix_is_what_impulses_do(void **state)
{
    (void)state;
    enum { BODIES = 4, CONTACTS = 6 };
    random_stream random = {29};
    for (int k = 0; k < 200; k++) {
        imp_body bodies[BODIES] = {{.is_static = true}};
        imp_state states[BODIES] = {{.q = {1, 0, 0, 0}}};
        for (int b = 1; b < BODIES; b++) {
            const double mass = random_log(&random, 0.1, 10);
            const qvec3 j = {random_log(&random, 0.1, 10), random_log(&random, 0.1, 10), random_log(&random, 0.1, 10)};
            bodies[b] = (imp_body){
                .mass = mass, .inverse_mass = 1 / mass, .moments = j, .inverse_moments = {1 / j.x, 1 / j.y, 1 / j.z}};
            states[b] = (imp_state){.q = random_rotation(&random),
                                    .v = random_vector(&random, 0.1, 1),
                                    .momentum = random_vector(&random, 0.1, 1)};
        }
        const imp_world world = {.body_count = BODIES, .bodies = bodies};
        imp_cone_contact contacts[CONTACTS];
        for (int c = 0; c < CONTACTS; c++) {
            contacts[c] = (imp_cone_contact){.body1 = 1 + c % 3, .body2 = c < 3 ? 0 : 1 + (c + 1) % 3};
            contacts[c].arm1 = random_vector(&random, 0.3, 1), contacts[c].arm2 = random_vector(&random, 0.3, 1);
            imp_cone_find_axes(random_direction(&random), contacts[c].axes);
        }
        imp_cone_row rows[CONTACTS];
        double w[9 * CONTACTS * CONTACTS], before[3 * CONTACTS], after[3 * CONTACTS], r[3 * CONTACTS];
        imp_cone_assemble(&world, states, contacts, CONTACTS, rows, w);
        imp_cone_contact_velocities(&world, states, contacts, CONTACTS, before);
        for (int i = 0; i < 3 * CONTACTS; i++) r[i] = cone_between(&random, -1, 1);
        imp_cone_push(&world, contacts, CONTACTS, r, states);
        imp_cone_contact_velocities(&world, states, contacts, CONTACTS, after);
        for (int i = 0; i < 3 * CONTACTS; i++) {
            double change = 0;
            for (int j = 0; j < 3 * CONTACTS; j++) {
                change += w[3 * CONTACTS * i + j] * r[j];
                assert_true(w[3 * CONTACTS * i + j] == w[3 * CONTACTS * j + i]);
            }
            assert_near(after[i] - before[i], change, 1e-12 * (1 + fabs(change)));
        }
    }
}

static int furnish(void **state)
{
    (void)state;
    return imp_arena_create(NULL, &room.arena);
}

static int clear(void **state)
{
    (void)state;
    imp_arena_destroy(room.arena);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_contact_has_a_closed_form),
        cmocka_unit_test(known_answers_are_found),
        cmocka_unit_test(hard_ones_are_solved_or_told),
        cmocka_unit_test(no_more_is_found_than_is_asked),
        cmocka_unit_test(work_is_bounded),
        cmocka_unit_test(a_struck_stack_is_solved),
        cmocka_unit_test(the_last_answer_leads_to_the_next),
        cmocka_unit_test(planar_twins_are_among_all_modes),
        cmocka_unit_test(shuffled_contacts_give_the_same_bits),
        cmocka_unit_test(units_scale_out),
        cmocka_unit_test(what_has_no_solution_is_shown),
        cmocka_unit_test(bad_numbers_are_refused),
        cmocka_unit_test(the_matrix_is_what_impulses_do),
    };
    return cmocka_run_group_tests(tests, furnish, clear);
}
