/* SPDX-License-Identifier: MIT
 *
 * bench_collide: error against run time of one impact.
 *
 * CSV rows (drawn by draw_collide.lua): class, solver, parameter, impacts, failures (no answer, or off by more than
 * 1e-3), median and worst error of the velocities against the 128-bit oracle (without libquadmath: against the series
 * of order 30), median time of one call in microseconds (the least of
 * rounds in which all ways take turns), that time over the first way's (the series') in the same class, and the
 * median and largest condition number of M of the class, by which rounding of the input can grow. Classes: how the
 * impact goes (slip, stick, reversal, jam, recompression; straight: spheres and planar ones; isotropic: a = b), the
 * scenes S1, S2, S5 that other programs are compared on, and S5e, 300 random ellipsoids on a plane. `loop of`, `array
 * of`: many different impacts by a closed form, the mean time of one. `receipt of`: such impacts, any of them, checked,
 * and that time over the same unchecked. `sensitivity of`: impact_collide_sensitivity, over such an impact. `p_z`: what
 * integration over the normal impulse itself does, by CVODE.
 */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "../tests/generators/collide_cases.h"
#include "../tests/generators/collide_scenes.h"
#include "measure.h"
#ifdef HAVE_QUADMATH
#include "../tests/generators/collide_oracle.h"
#endif

enum { MOST = 300, EACH = 24, REPEATS = 7, THREADS = 4, MOST_WAYS = 24 };

/* Impacts of a class. */
static int each(void) { return getenv("BENCH_QUICK") ? EACH / 6 : EACH; }

/* Impacts of one class with their right answers. */
typedef struct group {
    const char *name;
    int count;
    impact_collision c[MOST];
    qvec3 v[MOST][2], w[MOST][2];
    bool known[MOST];
    double conditioning_median, conditioning_largest;
} group;

/* ---- right answers ---- */

static bool right_answer(const impact_collision *c, qvec3 v[2], qvec3 w[2])
{
#ifdef HAVE_QUADMATH
    oracle_outcome o;
    if (!oracle_collide(c, &o)) return false;
#else
    impact_outcome o;
    impact_collision fine = *c;
    fine.series_order = 30;
    if (impact_collide(&fine, &o) != IMPACT_OK) return false;
#endif
    for (int b = 0; b < 2; b++) {
        v[b] = o.velocity[b];
        w[b] = o.omega[b];
    }
    return true;
}

typedef struct share {
    pthread_t thread;
    group *g;
    int first;
} share;

static void *answer_share(void *context)
{
    const share *s = context;
    group *g = s->g;
    for (int i = s->first; i < g->count; i += THREADS) g->known[i] = right_answer(&g->c[i], g->v[i], g->w[i]);
    return NULL;
}

/* Of the impacts whose right answer is known, as `run` has it. */
static void condition(group *g)
{
    double conditioning[MOST];
    int count = 0;
    for (int i = 0; i < g->count; i++) {
        impact_outcome o;
        if (g->known[i] && impact_collide(&g->c[i], &o) == IMPACT_OK) conditioning[count++] = o.conditioning;
    }
    g->conditioning_median = measure_quantile(conditioning, count, 0.5);
    g->conditioning_largest = measure_quantile(conditioning, count, 1);
}

static void answer_all(group *g)
{
    share shares[THREADS];
    for (int i = 0; i < THREADS; i++) {
        shares[i] = (share){.g = g, .first = i};
        if (pthread_create(&shares[i].thread, NULL, answer_share, &shares[i]) != 0) exit(1);
    }
    for (int i = 0; i < THREADS; i++) pthread_join(shares[i].thread, NULL);
    condition(g);
}

/* ---- running ---- */

typedef bool solver(const impact_collision *c, impact_outcome *o, void *context);

static bool by_library(const impact_collision *c, impact_outcome *o, void *context)
{
    const impact_collision *how = context;
    impact_collision k = *c;
    k.solver = how->solver;
    k.series_order = how->series_order;
    k.workspace = how->workspace;
    return impact_collide(&k, o) == IMPACT_OK;
}

/* One way to solve an impact. */
typedef struct way {
    const char *name;
    char parameter[32];
    solver *solve;
    void *context;
    bool slow;
    double times[MOST], errors[MOST];
    int failures, answered;
} way;

typedef struct ways {
    way list[MOST_WAYS];
    int count;
} ways;

static void join(ways *w, const char *name, const char *parameter, solver *solve, void *context, bool slow)
{
    way *one = &w->list[w->count++];
    memset(one, 0, sizeof *one);
    one->name = name, one->solve = solve, one->context = context, one->slow = slow;
    snprintf(one->parameter, sizeof one->parameter, "%s", parameter);
}

/* The least time of an impact, round after round in which all ways take turns; and its error. */
static void solve_all(const group *g, ways *w, int i, int timed)
{
    double best[MOST_WAYS];
    bool answered[MOST_WAYS];
    impact_outcome o[MOST_WAYS];
    for (int k = 0; k < w->count; k++) best[k] = INFINITY;
    for (int r = 0; r < REPEATS; r++)
        for (int k = 0; k < w->count; k++) {
            const way *one = &w->list[k];
            const int loops = one->slow ? 1 : 20;
            if (one->slow && r >= 1) continue; /* milliseconds */
            const double from = measure_clock();
            for (int l = 0; l < loops; l++) answered[k] = one->solve(&g->c[i], &o[k], one->context);
            best[k] = fmin(best[k], measure_since(from) / loops);
        }
    for (int k = 0; k < w->count; k++) {
        way *one = &w->list[k];
        one->times[timed] = best[k];
        const double error = answered[k] ? case_error(&g->c[i], o[k].velocity, o[k].omega, g->v[i], g->w[i]) : INFINITY;
        if (!(error < 1e-3))
            one->failures++;
        else
            one->errors[one->answered++] = error;
    }
}

/* A row for each way; times over those of the first. */
static void run(const group *g, ways *w)
{
    int timed = 0;
    double first = 0;
    for (int i = 0; i < g->count; i++)
        if (g->known[i]) solve_all(g, w, i, timed++);
    for (int k = 0; k < w->count && timed > 0; k++) {
        way *one = &w->list[k];
        const double time = measure_quantile(one->times, timed, 0.5);
        if (k == 0) first = time;
        printf("%s,%s,%s,%d,%d,%.2g,%.2g,%.3g,%.3g,%.3g,%.3g\n", g->name, one->name, one->parameter, timed,
               one->failures, measure_quantile(one->errors, one->answered, 0.5),
               measure_quantile(one->errors, one->answered, 1), 1e6 * time, time / first, g->conditioning_median,
               g->conditioning_largest);
    }
    fflush(stdout);
    w->count = 0;
}

/* ---- integration over p itself ---- */

typedef struct naive {
    impact_ode *ode;
    double M[3][3], mu;
} naive;

static int naive_rates(double p, const double *u, double *rate, void *context)
{
    (void)p;
    const naive *nv = context;
    const double s = sqrt(u[0] * u[0] + u[1] * u[1]), g[3] = {-nv->mu * u[0] / s, -nv->mu * u[1] / s, 1};
    for (int i = 0; i < 3; i++) rate[i] = nv->M[i][0] * g[0] + nv->M[i][1] * g[1] + nv->M[i][2] * g[2];
    rate[3] = g[0];
    rate[4] = g[1];
    return isfinite(rate[0] + rate[1] + rate[2]) ? 0 : 1;
}

static int naive_roots(double p, const double *u, double *value, void *context)
{
    (void)p, (void)context;
    value[0] = u[2];
    return 0;
}

/* Compression to uz = 0 and restitution to (1 + eps) p_c, Poisson, with the thesis' equation as it stands. */
static bool over_p(const impact_collision *c, impact_outcome *o, void *context)
{
    naive *nv = context;
    impact_flow f;
    double u[3];
    if (impact_flow_make(c, &f, u) != IMPACT_OK) return false;
    const double M[3][3] = {{f.a, 0, f.c}, {0, f.b, f.d}, {f.c, f.d, f.m}};
    memcpy(nv->M, M, sizeof M);
    nv->mu = c->friction;
    double y[5] = {u[0], u[1], u[2], 0, 0}, p = 0;
    bool found;
    if (impact_ode_start(nv->ode, 0, y) != IMPACT_OK) return false;
    if (impact_ode_advance(nv->ode, 100 * fabs(u[2]) / f.m, &p, y, NULL, &found) != IMPACT_OK || !found) return false;
    const double p_end = (1 + c->restitution) * p;
    if (p_end > p) {
        if (impact_ode_start(nv->ode, p, y) != IMPACT_OK) return false;
        do {
            if (impact_ode_advance(nv->ode, p_end, &p, y, NULL, &found) != IMPACT_OK) return false;
        } while (p < p_end);
    }
    const qvec3 P = qvec3_add(qvec3_scale(f.n, p), qvec3_axpy(y[3], f.t1, qvec3_scale(f.t2, y[4])));
    for (int b = 0; b < 2; b++) {
        const impact_collider *body = &c->body[b];
        o->velocity[b] = body->velocity;
        o->omega[b] = body->omega;
        if (isinf(body->mass)) continue;
        const double sign = b == 0 ? 1 : -1;
        o->velocity[b] = qvec3_axpy(sign / body->mass, P, body->velocity);
        const qvec3 l = quat_rotate_inverse(body->orientation, qvec3_cross(body->offset, P)), j = body->moments;
        o->omega[b] =
            qvec3_axpy(sign, quat_rotate(body->orientation, (qvec3){l.x / j.x, l.y / j.y, l.z / j.z}), body->omega);
    }
    return true;
}

/* ---- the table of one class ---- */

enum { TOLERANCES = 5, ORDERS = 7 };
static const double tolerances[TOLERANCES] = {1e-4, 1e-6, 1e-8, 1e-10, 1e-12};

/* What the ways of a class need: closed when it is over. */
typedef struct tools {
    impact_collision cvode[2][TOLERANCES], series[ORDERS], closed;
    naive over_p[TOLERANCES];
} tools;

static void join_cvode(ways *w, tools *t, impact_ode_method method, const char *name)
{
    for (int i = 0; i < TOLERANCES; i++) {
        impact_collision *how = &t->cvode[method == IMPACT_ODE_BDF][i];
        how->solver = IMPACT_SOLVER_CVODE;
        if (impact_collide_workspace_create(method, tolerances[i], &how->workspace) != IMPACT_OK) return;
        char parameter[32];
        snprintf(parameter, sizeof parameter, "rtol %g", tolerances[i]);
        join(w, name, parameter, by_library, how, true);
    }
}

static void join_over_p(ways *w, tools *t)
{
    for (int i = 0; i < TOLERANCES; i++) {
        naive *nv = &t->over_p[i];
        const impact_ode_def def = {.struct_size = sizeof def,
                                    .size = 5,
                                    .roots = 1,
                                    .rhs = naive_rates,
                                    .root_functions = naive_roots,
                                    .context = nv,
                                    .method = IMPACT_ODE_ADAMS,
                                    .relative_tolerance = tolerances[i],
                                    .absolute_tolerance = 1e-3 * tolerances[i],
                                    .max_steps = 5000};
        if (impact_ode_create(&def, &nv->ode) != IMPACT_OK) return;
        char parameter[32];
        snprintf(parameter, sizeof parameter, "rtol %g", tolerances[i]);
        join(w, "p_z", parameter, over_p, nv, true);
    }
}

static void join_series(ways *w, tools *t)
{
    static const int orders[ORDERS] = {0, 12, 16, 20, 24, 28, 32};
    for (int i = 0; i < ORDERS; i++) {
        t->series[i] = (impact_collision){.solver = IMPACT_SOLVER_SERIES, .series_order = orders[i]};
        char parameter[32];
        snprintf(parameter, sizeof parameter, orders[i] ? "order %d" : "default", orders[i]);
        join(w, "series", parameter, by_library, &t->series[i], false);
    }
}

/* With the closed form beside the others where there is one. */
static void run_class(group *g, bool closed)
{
    static ways w;
    tools t = {.closed = {.solver = IMPACT_SOLVER_CLOSED_FORM}};
    answer_all(g);
    join_series(&w, &t);
    if (closed) join(&w, "closed form", "", by_library, &t.closed, false);
    join_cvode(&w, &t, IMPACT_ODE_ADAMS, "cvode adams");
    join_cvode(&w, &t, IMPACT_ODE_BDF, "cvode bdf");
    join_over_p(&w, &t);
    run(g, &w);
    for (int i = 0; i < TOLERANCES; i++) {
        for (int m = 0; m < 2; m++) impact_collide_workspace_destroy(t.cvode[m][i].workspace);
        impact_ode_destroy(t.over_p[i].ode);
    }
}

static void run_scene(group *g)
{
    static ways w;
    impact_collision how = {.solver = IMPACT_SOLVER_AUTO};
    answer_all(g);
    join(&w, "auto", "", by_library, &how, false);
    run(g, &w);
}

/* ---- the classes ---- */

static bool has_phase(const impact_outcome *o, impact_phase one, impact_phase other)
{
    for (int i = 0; i < o->phase_count; i++)
        if (o->phases[i] == one || o->phases[i] == other) return true;
    return false;
}

typedef bool kind(const impact_outcome *o);
static bool slips(const impact_outcome *o)
{
    return !has_phase(o, IMPACT_STICK_C, IMPACT_STICK_R) && !has_phase(o, IMPACT_REVERSAL, IMPACT_REVERSAL);
}
static bool sticks(const impact_outcome *o) { return has_phase(o, IMPACT_STICK_C, IMPACT_STICK_R); }
static bool reverses(const impact_outcome *o) { return has_phase(o, IMPACT_REVERSAL, IMPACT_REVERSAL); }
static bool jams(const impact_outcome *o) { return o->jammed; }
static bool again(const impact_outcome *o) { return o->compressions > 1; }

/* EACH impacts of one kind, Poisson's law. */
static void gather(group *g, const char *name, case_class class_, kind *wanted)
{
    memset(g, 0, sizeof *g);
    g->name = name;
    for (uint64_t i = 0; g->count < each() && i < 3000000; i++) {
        impact_collision c = case_make(class_, 97, i);
        c.law = IMPACT_POISSON;
        impact_outcome o;
        if (impact_collide(&c, &o) == IMPACT_OK && o.solver == IMPACT_SOLVER_SERIES && wanted(&o)) g->c[g->count++] = c;
    }
}

/* Half of them spheres, half planar, all with some sliding. */
static void gather_straight(group *g)
{
    memset(g, 0, sizeof *g);
    g->name = "straight";
    for (uint64_t i = 0; g->count < each(); i++) {
        impact_collision c = case_make(g->count < each() / 2 ? CASE_SPHERE : CASE_PLANAR, 97, i);
        c.law = IMPACT_POISSON;
        impact_outcome o;
        if (c.friction > 0 && impact_collide(&c, &o) == IMPACT_OK && o.solver == IMPACT_SOLVER_CLOSED_FORM)
            g->c[g->count++] = c;
    }
}

/* a = b and sliding that turns: the closed form that is not straight. */
static void gather_isotropic(group *g)
{
    memset(g, 0, sizeof *g);
    g->name = "isotropic";
    for (uint64_t i = 0; g->count < 4 * each(); i++) {
        impact_collision c = case_make(CASE_ISOTROPIC, 97, i);
        c.law = IMPACT_POISSON;
        impact_outcome o;
        if (c.friction > 0 && impact_collide(&c, &o) == IMPACT_OK && o.solver == IMPACT_SOLVER_CLOSED_FORM)
            g->c[g->count++] = c;
    }
}

static void one_scene(group *g, const char *name, impact_collision c)
{
    memset(g, 0, sizeof *g);
    g->name = name;
    g->count = 1;
    g->c[0] = c;
    run_scene(g);
}

static void random_ellipsoids(group *g)
{
    memset(g, 0, sizeof *g);
    g->name = "S5e";
    uint64_t state = 2026;
    while (g->count < measure_count(MOST)) {
        double x[10];
        for (int i = 0; i < 10; i++) x[i] = 2 * case_random(&state) - 1;
        const quat q = {x[0], x[1], x[2], x[3]};
        quat unit;
        if (quat_dot(q, q) > 1 || quat_dot(q, q) < 0.01 || quat_normalize(q, &unit) != QUAT_OK) continue;
        const impact_collision c =
            scene_ellipsoid_at(unit, (qvec3){2 * x[4], 2 * x[5], -3}, (qvec3){3 * x[6], 3 * x[7], 3 * x[8]});
        impact_outcome o;
        if (impact_collide(&c, &o) == IMPACT_OK) g->c[g->count++] = c;
    }
    run_scene(g);
}

static void print_loop(const char *name, const char *parameter, int count, double time, double unit)
{
    printf("%s,closed form,%s,%d,0,,,%.3g,%.3g,,\n", name, parameter, count, 1e6 * time, time / unit);
}

/* Different impacts one after another, as a program has them: the time of one in the mean, for each closed form, beside
 * a sphere's. */
static void closed_forms(void)
{
    enum { COUNT = 2000 };
    static const case_class classes[] = {CASE_SPHERE, CASE_SMOOTH, CASE_REST, CASE_PLANAR, CASE_TILTED, CASE_ISOTROPIC};
    static const char *const names[] = {"loop of spheres", "loop without friction", "loop from rest",
                                        "loop of planar",  "loop of tilted planar", "loop of a = b"};
    static impact_collision c[COUNT];
    static impact_outcome o[COUNT];
    double sphere = 0, sum = 0;
    for (int k = 0; k < 6; k++) {
        int count = 0;
        for (uint64_t i = 0; count < COUNT; i++) {
            c[count] = case_make(classes[k], 103, i);
            count += impact_collide(&c[count], &o[count]) == IMPACT_OK && o[count].solver == IMPACT_SOLVER_CLOSED_FORM;
        }
        double best = INFINITY;
        for (int r = 0; r < measure_count(15); r++) {
            const double from = measure_clock();
            for (int i = 0; i < COUNT; i++) impact_collide(&c[i], &o[i]);
            best = fmin(best, measure_since(from) / COUNT);
        }
        if (k == 0) sphere = best;
        print_loop(names[k], "", COUNT, best, sphere);
        sum += best;
    }
    print_loop("loop of all these", "", 6 * COUNT, sum / 6, sphere);
}

/* The best time of so many impacts one after another, checked or not. */
static double best_of(impact_collision *c, int count, impact_checking checking, double best)
{
    impact_outcome o;
    for (int i = 0; i < count; i++) c[i].checking = checking;
    const double from = measure_clock();
    for (int i = 0; i < count; i++) impact_collide(&c[i], &o);
    return fmin(best, measure_since(from));
}

/* Checked and unchecked in turn, in portions so short that nothing interrupts the best of them. */
static void receipts(void)
{
    enum { COUNT = 2000, PORTION = 40, ROUNDS = 25 };
    static const case_class classes[] = {CASE_PLAIN,  CASE_ROD,    CASE_WILD,     CASE_SPHERE,
                                         CASE_SMOOTH, CASE_PLANAR, CASE_ISOTROPIC};
    static impact_collision c[COUNT];
    for (int k = 0; k < 7; k++) {
        double with = 0, without = 0;
        for (int i = 0; i < COUNT; i++) c[i] = case_make(classes[k], 107, (uint64_t)i);
        for (int from = 0; from < COUNT; from += PORTION) {
            double best[2] = {INFINITY, INFINITY};
            for (int r = 0; r < measure_count(ROUNDS); r++) {
                best[0] = best_of(c + from, PORTION, IMPACT_CHECK_AUTO, best[0]);
                best[1] = best_of(c + from, PORTION, IMPACT_CHECK_NEVER, best[1]);
            }
            with += best[0];
            without += best[1];
        }
        printf("receipt of %s,auto,with over without,%d,0,,,%.3g,%.3g,,\n", case_name(classes[k]), COUNT,
               1e6 * with / COUNT, with / without);
    }
}

/* The derivative of an answer, over the answer. */
static void sensitivities(void)
{
    enum { MANY = 200 };
    const int count = measure_count(MANY);
    static const case_class classes[] = {CASE_PLAIN,  CASE_ROD,       CASE_WILD,   CASE_SPHERE,
                                         CASE_PLANAR, CASE_ISOTROPIC, CASE_SLENDER};
    static impact_collision c[MANY];
    for (int k = 0; k < 7; k++) {
        double best = INFINITY, plain = INFINITY, sum = 0;
        for (int i = 0; i < count; i++) c[i] = case_make(classes[k], 109, (uint64_t)i);
        for (int r = 0; r < measure_count(5); r++) {
            const double from = measure_clock();
            for (int i = 0; i < count; i++) sum += impact_collide_sensitivity(&c[i]);
            best = fmin(best, measure_since(from));
            plain = best_of(c, count, IMPACT_CHECK_ALWAYS, plain);
        }
        if (isnan(sum)) exit(1);
        printf("sensitivity of %s,auto,over the answer,%d,0,,,%.3g,%.3g,,\n", case_name(classes[k]), count,
               1e6 * best / count, best / plain);
    }
}

/* The array call: the time of one sphere impact. */
static void array_call(void)
{
    enum { COUNT = 200000 };
    impact_collision *c = calloc(COUNT, sizeof *c);
    impact_outcome *o = calloc(COUNT, sizeof *o);
    if (!c || !o) exit(1);
    for (int i = 0; i < COUNT; i++) c[i] = case_make(CASE_SPHERE, 101, (uint64_t)i);
    static const int threads[] = {1, 2, 4};
    static const char *const names[] = {"1 threads", "2 threads", "4 threads"};
    double single = 0;
    for (int t = 0; t < 3; t++) {
        double best = INFINITY;
        for (int r = 0; r < measure_count(5); r++) {
            const double from = measure_wall();
            impact_collide_many(c, COUNT, threads[t], o, NULL);
            best = fmin(best, (measure_wall() - from) / COUNT);
        }
        if (t == 0) single = best;
        print_loop("array of spheres", names[t], COUNT, best, single);
    }
    free(c);
    free(o);
}

int main(void)
{
    static group g;
    printf("class,solver,parameter,impacts,failures,error_median,error_worst,us_median,time_over_series,"
           "conditioning_median,conditioning_largest\n");
    one_scene(&g, "S1a", scene_sphere(false));
    one_scene(&g, "S1b", scene_sphere(true));
    one_scene(&g, "S2a", scene_two_spheres(false));
    one_scene(&g, "S2b", scene_two_spheres(true));
    one_scene(&g, "S5a", scene_ellipsoid(0));
    one_scene(&g, "S5b", scene_ellipsoid(1));
    random_ellipsoids(&g);
    closed_forms();
    array_call();
    receipts();
    sensitivities();
    gather_straight(&g);
    run_class(&g, true);
    gather_isotropic(&g);
    run_class(&g, true);
    gather(&g, "slip", CASE_PLAIN, slips);
    run_class(&g, false);
    gather(&g, "stick", CASE_PLAIN, sticks);
    run_class(&g, false);
    gather(&g, "reversal", CASE_ROD, reverses);
    run_class(&g, false);
    gather(&g, "jam", CASE_WILD, jams);
    run_class(&g, false);
    gather(&g, "recompression", CASE_WILD, again);
    run_class(&g, false);
    return 0;
}
