/* SPDX-License-Identifier: MIT
 *
 * Encounters beside what others have of them: a chain of Hertz balls as a free differential equation; two billiard
 * balls and their table (Mathavan, Jackson & Parkin 2014); the bouncing dimer (Dorbolo et al. 2005).
 */
#include <string.h>

#include <impact/together.h>
#include "kit/near.h"

typedef long double wide;

static impact_collider ball(double mass, double radius, qvec3 velocity, qvec3 omega)
{
    const double j = 0.4 * mass * radius * radius;
    return (impact_collider){
        .mass = mass, .moments = {j, j, j}, .orientation = {1, 0, 0, 0}, .velocity = velocity, .omega = omega};
}

static impact_collider still_ground(void) { return (impact_collider){.mass = INFINITY, .orientation = {1, 0, 0, 0}}; }

/* ---- a chain of Hertz balls ---- */

enum { CHAIN = 8 };

typedef struct chain {
    int n;
    wide mass[CHAIN];
} chain;

/* y: places, each from where it touches its neighbours, then velocities. */
static void chain_rates(const chain *c, const wide *y, wide *rate)
{
    const int n = c->n;
    for (int i = 0; i < n; i++) rate[i] = y[n + i], rate[n + i] = 0;
    for (int i = 0; i + 1 < n; i++) {
        const wide depth = y[i] - y[i + 1], force = depth > 0 ? depth * sqrtl(depth) : 0;
        rate[n + i] -= force / c->mass[i];
        rate[n + i + 1] += force / c->mass[i + 1];
    }
}

static void chain_step(const chain *c, const wide *y, wide h, wide *out)
{
    wide k[4][2 * CHAIN], at[2 * CHAIN];
    const wide along[4] = {0, 0.5L, 0.5L, 1};
    for (int s = 0; s < 4; s++) {
        for (int i = 0; i < 2 * c->n; i++) at[i] = y[i] + (s > 0 ? along[s] * h * k[s - 1][i] : 0);
        chain_rates(c, at, k[s]);
    }
    for (int i = 0; i < 2 * c->n; i++) out[i] = y[i] + h / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
}

static bool chain_is_over(const chain *c, const wide *y)
{
    for (int i = 0; i + 1 < c->n; i++)
        if (y[i] - y[i + 1] > 0 || y[c->n + i] > y[c->n + i + 1]) return false;
    return true;
}

/* Runge and Kutta's steps, halved until two halves agree with the whole to 1e-16. */
static void follow_chain(const chain *c, wide *y)
{
    wide h = 1e-3L, whole[2 * CHAIN], half[2 * CHAIN], twice[2 * CHAIN];
    for (long steps = 0; steps < 2000000 && !(steps > 10 && chain_is_over(c, y)); steps++) {
        wide off = 0;
        chain_step(c, y, h, whole);
        chain_step(c, y, h / 2, half);
        chain_step(c, half, h / 2, twice);
        for (int i = 0; i < 2 * c->n; i++) off = fmaxl(off, fabsl(whole[i] - twice[i]));
        if (off <= 1e-16L)
            for (int i = 0; i < 2 * c->n; i++) y[i] = twice[i] + (twice[i] - whole[i]) / 15;
        h *= fminl(2, fmaxl(0.3L, 0.9L * powl(1e-16L / fmaxl(off, 1e-22L), 0.2L)));
    }
    assert_true(chain_is_over(c, y));
}

static void chains_of_hertz_balls_are_the_free_equation_s(void **state)
{
    (void)state;
    for (int run = 0; run < 4; run++) {
        chain c = {.n = run == 0 ? 3 : run == 1 ? CHAIN : 5};
        wide y[2 * CHAIN] = {0};
        impact_collider balls[CHAIN];
        impact_meeting m[CHAIN];
        qvec3 v[CHAIN], omega[CHAIN];
        for (int i = 0; i < c.n; i++) {
            const double mass = run < 2 ? 1 : run == 2 ? pow(0.5, i) : i % 2 ? 3 : 1; /* equal; tapered; in turns */
            c.mass[i] = mass;
            y[c.n + i] = i == 0;
            balls[i] = ball(mass, 1, (qvec3){i == 0, 0, 0}, (qvec3){0, 0, 0});
            m[i] = (impact_meeting){i, i + 1, {-1, 0, 0}, {1, 0, 0}, {-1, 0, 0}, 0, 1, 1, false};
        }
        const impact_encounter e = {.bodies = balls, .body_count = c.n, .meetings = m, .meeting_count = c.n - 1};
        impact_together_outcome o = {.velocity = v, .omega = omega};
        assert_int_equal(impact_collide_together(&e, &o), IMPACT_OK);
        follow_chain(&c, y);
        for (int i = 0; i < c.n; i++) assert_near(v[i].x, (double)y[c.n + i], 1e-12);
        assert_near(o.energy_after, o.energy_before, 1e-14);
    }
}

/* ---- two balls on a table ---- */

enum { CUE, OBJECT };
static const wide billiard = 0.2L, cloth = 0.25L; /* frictions between the balls, and with the table */

typedef struct table_ball {
    wide v[3], w[3];
} table_ball;

/* The impulse f at r changes it: mass 1, radius 1. */
static void push_ball(table_ball *b, const wide *r, const wide *f)
{
    for (int k = 0; k < 3; k++) {
        b->v[k] += f[k];
        b->w[k] += 2.5L * (r[(k + 1) % 3] * f[(k + 2) % 3] - r[(k + 2) % 3] * f[(k + 1) % 3]);
    }
}

static void point_of(const table_ball *b, const wide *r, wide *u)
{
    for (int k = 0; k < 3; k++)
        u[k] = b->v[k] + b->w[(k + 1) % 3] * r[(k + 2) % 3] - b->w[(k + 2) % 3] * r[(k + 1) % 3];
}

/* dp of the balls' impulse along x: their friction, and the table's answer where that presses down. */
static void push_both(table_ball *b, wide dp)
{
    const wide ahead[3] = {1, 0, 0}, behind[3] = {-1, 0, 0}, below[3] = {0, 0, -1};
    wide u1[3], u2[3], f[2][3];
    point_of(&b[CUE], ahead, u1);
    point_of(&b[OBJECT], behind, u2);
    const wide y = u1[1] - u2[1], z = u1[2] - u2[2], size = hypotl(y, z);
    const wide on_cue[3] = {-dp, -billiard * dp * y / size, -billiard * dp * z / size};
    for (int k = 0; k < 3; k++) f[CUE][k] = on_cue[k], f[OBJECT][k] = -on_cue[k];
    wide slip[2][3];
    for (int i = 0; i < 2; i++) point_of(&b[i], below, slip[i]);
    push_ball(&b[CUE], ahead, f[CUE]);
    push_ball(&b[OBJECT], behind, f[OBJECT]);
    for (int i = 0; i < 2; i++) {
        const wide pressed = fmaxl(0, -f[i][2]), along = hypotl(slip[i][0], slip[i][1]);
        const wide by_table[3] = {along > 0 ? -cloth * pressed * slip[i][0] / along : 0,
                                  along > 0 ? -cloth * pressed * slip[i][1] / along : 0, pressed};
        push_ball(&b[i], below, by_table);
    }
}

/* A midpoint step in the balls' impulse; the work that their springs take. */
static wide step_table(table_ball *b, wide dp)
{
    table_ball middle[2], moved[2];
    memcpy(middle, b, sizeof middle);
    const wide before = b[CUE].v[0] - b[OBJECT].v[0];
    push_both(middle, dp / 2);
    memcpy(moved, middle, sizeof moved);
    push_both(moved, dp);
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 3; k++) {
            b[i].v[k] += moved[i].v[k] - middle[i].v[k];
            b[i].w[k] += moved[i].w[k] - middle[i].w[k];
        }
    return dp * 0.5L * (before + b[CUE].v[0] - b[OBJECT].v[0]);
}

/* Until the springs have given back all they took. */
static void follow_table(table_ball *b)
{
    wide stored = 0;
    for (wide dp = 1e-4L; dp > 1e-12L;) {
        table_ball kept[2];
        memcpy(kept, b, sizeof kept);
        const wide taken = step_table(b, dp);
        if (stored + taken > 0) {
            stored += taken;
            continue;
        }
        memcpy(b, kept, sizeof kept);
        dp /= 2;
    }
}

/* The largest difference of velocities, with a table so many times as stiff as the balls. */
static double table_difference(double stiffness, const table_ball *wanted, const impact_collider *balls)
{
    const impact_collider bodies[3] = {balls[0], balls[1], still_ground()};
    const impact_meeting m[3] = {{0, 1, {-1, 0, 0}, {1, 0, 0}, {-1, 0, 0}, (double)billiard, 1, 1, false},
                                 {0, 2, {0, 0, 1}, {0, 0, -1}, {0, 0, 0}, (double)cloth, 1, stiffness, false},
                                 {1, 2, {0, 0, 1}, {0, 0, -1}, {0, 0, 0}, (double)cloth, 1, stiffness, false}};
    qvec3 v[3], w[3];
    const impact_encounter e = {.bodies = bodies, .body_count = 3, .meetings = m, .meeting_count = 3, .exponent = 1};
    impact_together_outcome o = {.velocity = v, .omega = w};
    assert_int_equal(impact_collide_together(&e, &o), IMPACT_OK);
    double off = 0;
    for (int i = 0; i < 2; i++) {
        const double got[6] = {v[i].x, v[i].y, v[i].z, w[i].x, w[i].y, w[i].z};
        for (int k = 0; k < 3; k++) {
            off = fmax(off, fabs(got[k] - (double)wanted[i].v[k]));
            off = fmax(off, fabs(got[3 + k] - (double)wanted[i].w[k]));
        }
    }
    return off;
}

/* A cue ball that comes sliding, with side and top spin, on one at rest: the faster the table answers the nearer the
 * springs come to impulses of the table that follow those of the balls. */
static void balls_on_a_stiff_table_are_mathavan_s(void **state)
{
    (void)state;
    for (int run = 0; run < 2; run++) {
        const double top = run ? 1.5 : -1.5; /* the cue ball is pressed down, or the other one */
        const impact_collider balls[2] = {ball(1, 1, (qvec3){1, 0.2, 0}, (qvec3){0.1, top, 2}),
                                          ball(1, 1, (qvec3){0, -0.1, 0}, (qvec3){0.3, 0.2, 0})};
        table_ball b[2];
        for (int i = 0; i < 2; i++) {
            const impact_collider *c = &balls[i];
            b[i] = (table_ball){{c->velocity.x, c->velocity.y, c->velocity.z}, {c->omega.x, c->omega.y, c->omega.z}};
        }
        follow_table(b);
        const double soft = table_difference(1e2, b, balls), hard = table_difference(1e4, b, balls),
                     harder = table_difference(1e6, b, balls);
        assert_true(hard < 0.3 * soft && harder < 0.05 * hard);
        assert_at_most(harder, 1e-6);
    }
}

/* ---- the dimer ---- */

/* Two balls on a rod, one end lying on the plate, the other comes down. With J = m a^2 (all mass at the ends) no end
 * feels the other's impulse: the one bounces, the other lies still. With more inertia than that the end that lies is
 * lifted by a part of the impulse, with less it is pressed and bounces. */
static void a_dimer_s_ends(void **state)
{
    (void)state;
    const double a = 1, u = 1;
    for (int run = 0; run < 9; run++) {
        const double eps = 0.3 + 0.35 * (run % 3), j = run < 3 ? a * a : run < 6 ? 1.8 : 0.5;
        /* end 0 at -a stands still, end 1 at +a falls with u: v_z = -u/2, omega x r */
        const impact_collider bodies[2] = {{.mass = 1,
                                            .moments = {1, j, j},
                                            .orientation = {1, 0, 0, 0},
                                            .velocity = {0, 0, -u / 2},
                                            .omega = {0, u / (2 * a), 0}},
                                           still_ground()};
        impact_meeting m[2];
        for (int i = 0; i < 2; i++)
            m[i] = (impact_meeting){0, 1, {0, 0, 1}, {i ? a : -a, 0, 0}, {0, 0, 0}, 0, eps, 1, false};
        qvec3 v[2], w[2];
        impact_meeting_outcome each[2];
        const impact_encounter e = {.bodies = bodies, .body_count = 2, .meetings = m, .meeting_count = 2};
        impact_together_outcome o = {.velocity = v, .omega = w, .meetings = each};
        assert_int_equal(impact_collide_together(&e, &o), IMPACT_OK);
        const double lies = v[0].z + a * w[0].y, comes = v[0].z - a * w[0].y;
        const double own = 1 + a * a / j, other = 1 - a * a / j;
        if (run < 6) { /* the end that lies takes no part */
            const double p = (1 + eps) * u / own;
            assert_near(comes, eps * u, 1e-14);
            assert_near(lies, other * p, 1e-14);
            assert_near(each[0].impulse.z, 0, 1e-15);
        } else {
            assert_true(each[0].impulse.z > 0.1 && each[0].work_compression < 0 && lies > 0.1);
        }
        assert_true(lies >= 0 && comes >= 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(chains_of_hertz_balls_are_the_free_equation_s),
        cmocka_unit_test(balls_on_a_stiff_table_are_mathavan_s),
        cmocka_unit_test(a_dimer_s_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
