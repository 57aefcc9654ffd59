/* SPDX-License-Identifier: MIT
 *
 * bench_engines: whole engines side by side on scenes with a known answer.
 *
 *   S1 a spinning sphere meets a plane, S2 two spheres meet obliquely (a: slide throughout, b: come to stick), S3 ten
 * bounces, S4 free tumbling near the unstable axis for 100 s, S5 an ellipsoid meets a plane (a: the slip turns by 97
 * degrees, b: it ends)
 *
 * CSV: scene, engine, step in s (0: none; of Simbody's integrator its accuracy), error, time in us (median over rounds
 * in which all take turns), that time over ours, median over least, a checksum. The error is, for one impact, that of
 * the velocities, sqrt(sum |dv|^2 + rho^2 |dw|^2) relative to their own; for S3 the worst relative error of a height;
 * for S4 the worst angle in rad at t = 1 ... 100 s (10 with BENCH_QUICK). The right answers: S1, S2, S5 by the 128-bit
 * oracle, S3 (height eps^(2 k)), and S4 by a Taylor series in long double. Other engines solve an impact by Newton's
 * law with the last direction of slip: on S5 no step helps them.
 */
#include <impact/impact.h>
#include <stdio.h>
#include <stdlib.h>
#include "../tests/generators/collide_cases.h"
#include "../tests/generators/collide_scenes.h"
#include "peers_engines.h"
#ifdef HAVE_QUADMATH
#include "../tests/generators/collide_oracle.h"
#endif

enum { ROUNDS = 51, MOST = 16, LISTS = 4 };

/* ---- our answers ---- */

static bool our_impact(const impact_collision *c, double step, qvec3 v[2], qvec3 w[2], double *seconds)
{
    (void)step;
    impact_outcome o;
    const double from = measure_clock();
    const bool done = impact_collide(c, &o) == IMPACT_OK;
    *seconds = measure_since(from);
    for (int b = 0; b < 2; b++) v[b] = o.velocity[b], w[b] = o.omega[b];
    return done;
}

typedef struct bounce_log {
    const bounce_case *c;
    double *height;
    int count;
} bounce_log;

static bool log_bounce(void *context, const impact_event *event)
{
    bounce_log *log = context;
    if (event->kind == IMPACT_EVENT_IMPACT && log->count < BOUNCES)
        log->height[log->count++] = event->normal_after * event->normal_after / (2 * log->c->gravity);
    return true;
}

static bool run_scene(const impact_scene_def *def, const impact_recorder *recorder, double *seconds)
{
    impact_scene *scene;
    if (impact_scene_create(def, &scene, NULL, 0) != IMPACT_OK) return false;
    const double from = measure_clock();
    const impact_status status = impact_scene_run(scene, recorder);
    *seconds = measure_since(from);
    impact_scene_destroy(scene);
    return status >= 0;
}

static bool our_bounce(const bounce_case *c, double step, double height[BOUNCES], double *seconds)
{
    (void)step;
    impact_body_def bodies[2] = {impact_default_body_def(), impact_default_body_def()};
    bodies[0].name = "floor", bodies[0].is_static = true, bodies[0].restitution = 1;
    bodies[1].name = "ball", bodies[1].mass = c->mass, bodies[1].restitution = c->restitution;
    bodies[1].position = (qvec3){0, 0, c->height + c->radius};
    if (impact_shape_plane(INFINITY, INFINITY, &bodies[0].shape) != IMPACT_OK) return false;
    if (impact_shape_sphere(c->radius, &bodies[1].shape) != IMPACT_OK) return false;
    impact_scene_def def = impact_default_scene_def();
    def.gravity = (qvec3){0, 0, -c->gravity};
    def.duration = c->duration;
    def.output_rate = 0;
    def.bodies = bodies, def.body_count = 2;
    bounce_log log = {c, height, 0};
    const impact_recorder recorder = {.struct_size = sizeof recorder, .context = &log, .event = log_bounce};
    return run_scene(&def, &recorder, seconds) && log.count == BOUNCES;
}

static bool log_turn(void *context, const impact_sample *sample)
{
    const int second = (int)lrint(sample->t);
    if (second >= 1 && second <= TURNS) ((quat *)context)[second - 1] = sample->orientation;
    return true;
}

static bool our_tumble(const tumble_case *c, double step, quat q[TURNS], double *seconds)
{
    (void)step;
    impact_body_def body = impact_default_body_def();
    body.name = "body", body.mass = c->mass, body.moments = c->moments, body.omega = c->omega;
    if (impact_shape_sphere(0.1, &body.shape) != IMPACT_OK) return false;
    impact_scene_def def = impact_default_scene_def();
    def.gravity = (qvec3){0, 0, 0};
    def.duration = tumble_seconds();
    def.output_rate = 1;
    def.bodies = &body, def.body_count = 1;
    const impact_recorder recorder = {.struct_size = sizeof recorder, .context = q, .sample = log_turn};
    return run_scene(&def, &recorder, seconds);
}

/* ---- right answers ---- */

/* Euler's equations and q' = q (0, omega)/2 in body axes, by Taylor series of order 24 over steps of 1/20 s. */
static void right_turns(const tumble_case *c, quat q[TURNS])
{
    enum { ORDER = 24, STEPS = 20 };
    const long double j[3] = {c->moments.x, c->moments.y, c->moments.z}, h = 1.0L / STEPS;
    long double w[3] = {c->omega.x, c->omega.y, c->omega.z}, r[4] = {1, 0, 0, 0};
    for (int step = 1; step <= TURNS * STEPS; step++) {
        long double a[ORDER + 1][3], b[ORDER + 1][4];
        for (int i = 0; i < 3; i++) a[0][i] = w[i];
        for (int i = 0; i < 4; i++) b[0][i] = r[i];
        for (int n = 0; n < ORDER; n++) {
            for (int i = 0; i < 3; i++) a[n + 1][i] = 0;
            for (int i = 0; i < 4; i++) b[n + 1][i] = 0;
            for (int k = 0; k <= n; k++) {
                const long double *x = a[n - k], *p = b[k];
                for (int i = 0; i < 3; i++) {
                    const int m = (i + 1) % 3, l = (i + 2) % 3;
                    a[n + 1][i] += (j[m] - j[l]) / j[i] * a[k][m] * x[l];
                }
                b[n + 1][0] -= (p[1] * x[0] + p[2] * x[1] + p[3] * x[2]) / 2;
                b[n + 1][1] += (p[0] * x[0] + p[2] * x[2] - p[3] * x[1]) / 2;
                b[n + 1][2] += (p[0] * x[1] + p[3] * x[0] - p[1] * x[2]) / 2;
                b[n + 1][3] += (p[0] * x[2] + p[1] * x[1] - p[2] * x[0]) / 2;
            }
            for (int i = 0; i < 3; i++) a[n + 1][i] /= n + 1;
            for (int i = 0; i < 4; i++) b[n + 1][i] /= n + 1;
        }
        for (int i = 0; i < 3; i++) w[i] = 0;
        for (int i = 0; i < 4; i++) r[i] = 0;
        for (int n = ORDER; n >= 0; n--) {
            for (int i = 0; i < 3; i++) w[i] = a[n][i] + h * w[i];
            for (int i = 0; i < 4; i++) r[i] = b[n][i] + h * r[i];
        }
        if (step % STEPS == 0) q[step / STEPS - 1] = (quat){(double)r[0], (double)r[1], (double)r[2], (double)r[3]};
    }
}

/* ---- the table ---- */

typedef struct answer {
    double seconds, error, sum;
} answer;

/* Asks an engine; false: it has no answer. */
typedef bool question(const engine *e, const void *scene, answer *a);

static double sum_of(qvec3 v) { return v.x + v.y + v.z; }

static bool ask_impact(const engine *e, const void *scene, answer *a)
{
    const impact_collision *c = scene;
    qvec3 v[2], w[2];
    if (!e->impact || !e->impact(c, e->step, v, w, &a->seconds)) return false;
    a->sum = sum_of(v[0]) + sum_of(v[1]) + sum_of(w[0]) + sum_of(w[1]);
    a->error = NAN;
#ifdef HAVE_QUADMATH
    static oracle_outcome right;
    static const impact_collision *known;
    if (known != c && !oracle_collide(c, &right)) return true;
    known = c;
    a->error = case_error(c, v, w, right.velocity, right.omega);
#endif
    return true;
}

static bool ask_bounce(const engine *e, const void *scene, answer *a)
{
    const bounce_case *c = scene;
    double height[BOUNCES];
    if (!e->bounce || !e->bounce(c, e->step, height, &a->seconds)) return false;
    a->error = a->sum = 0;
    for (int k = 0; k < BOUNCES; k++) {
        const double right = c->height * pow(c->restitution, 2 * (k + 1));
        a->error = fmax(a->error, fabs(height[k] / right - 1));
        a->sum += height[k];
    }
    return true;
}

typedef struct turning {
    tumble_case c;
    quat right[TURNS];
} turning;

static bool ask_tumble(const engine *e, const void *scene, answer *a)
{
    const turning *t = scene;
    quat q[TURNS];
    if (!e->tumble || !e->tumble(&t->c, e->step, q, &a->seconds)) return false;
    a->error = a->sum = 0;
    for (int k = 0; k < tumble_seconds(); k++) {
        a->error = fmax(a->error, quat_rotation_distance(q[k], t->right[k]));
        a->sum += q[k].x;
    }
    return true;
}

typedef struct contestant {
    const engine *e;
    answer last;
    double times[ROUNDS], spent;
    int count;
} contestant;

/* Round after round all take turns; what has taken long enough is not asked again. */
static void compete(const char *scene, const engine *const lists[], bool all_steps, question *ask, const void *what)
{
    contestant row[MOST];
    int count = 0;
    const double enough = getenv("BENCH_QUICK") ? 0.02 : 0.2;
    for (int l = 0; l < LISTS; l++)
        for (const engine *e = lists[l]; e->name && count < MOST; e++) {
            row[count] = (contestant){.e = e};
            if (!ask(e, what, &row[count].last)) continue;
            count++;
            if (!all_steps) break;
        }
    for (int round = 0; round < ROUNDS; round++)
        for (int k = 0; k < count; k++) {
            contestant *c = &row[k];
            if (c->spent > enough || !ask(c->e, what, &c->last)) continue;
            c->times[c->count++] = 1e6 * c->last.seconds;
            c->spent += c->last.seconds;
        }
    double own = 0;
    for (int k = 0; k < count; k++) {
        const measure_time time = measure_of_rounds(row[k].times, row[k].count);
        if (k == 0) own = time.median;
        printf("%s,%s,%g,%.2g,%.3g,%.3g,%.2f,%.9g\n", scene, row[k].e->name, row[k].e->step, row[k].last.error,
               time.median, time.median / own, time.spread, row[k].last.sum);
    }
    fflush(stdout);
}

typedef struct scene {
    const char *name;
    impact_collision collision;
} scene;

int main(void)
{
    const scene impacts[] = {{"S1a", scene_sphere(false)},      {"S1b", scene_sphere(true)},
                             {"S2a", scene_two_spheres(false)}, {"S2b", scene_two_spheres(true)},
                             {"S5a", scene_ellipsoid(0)},       {"S5b", scene_ellipsoid(1)}};
    const bounce_case bounces = {0.3, 4, 1, 9.80665, 0.8, 3.7};
    turning turns = {.c = {4, {0.104, 0.08, 0.04}, {0.05, 5, 0.05}}};
    static const engine own[] = {{"libimpact", 0, our_impact, our_bounce, our_tumble}, {NULL, 0, NULL, NULL, NULL}};
    const engine *const lists[LISTS] = {own, engines_ode, engines_bullet, engines_simbody};
    static const char *const names[LISTS] = {"libimpact", "ODE", "Bullet", "Simbody"};
    right_turns(&turns.c, turns.right);
    for (int l = 0; l < LISTS; l++)
        if (!lists[l][0].name) printf("# %s is not installed: its rows are skipped\n", names[l]);
    printf("scene,engine,step,error,us,time_over_ours,spread,checksum\n");
    /* of one impact the step does not matter: the first of each engine */
    for (int i = 0; i < (int)(sizeof impacts / sizeof *impacts); i++)
        compete(impacts[i].name, lists, false, ask_impact, &impacts[i].collision);
    compete("S3", lists, true, ask_bounce, &bounces);
    compete("S4", lists, true, ask_tumble, &turns);
    return 0;
}
