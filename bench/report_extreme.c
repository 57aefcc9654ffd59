/* SPDX-License-Identifier: MIT
 *
 * report_extreme: whole scenes at the ends of their ranges, each beside its closed form. CSV: the case and what is
 * driven to its end; how the run ended; error of the answer relative to its own size; how far the energy account is
 * off, of the energies in it; impacts, integrator steps, and the CPU time in ms; what the error is by: a formula, or an
 * oracle in 128 bits that shares no code (truth_fall: the flights up to the third impact), until when, s, and the
 * condition there: rounding alone makes that times 1e-16.
 * With BENCH_QUICK falls are followed to the first impact only.
 *
 *   stiff drag     a body falls through drag of this rate (1/s): terminal speed g/rate
 *   units          five bounces, with lengths and gravity times this
 *   mass ratio     two spheres collide centrally, restitution 1
 *   heavy on light so much heavier, a ball falls on the side of another, without friction (truth_lean)
 *   speed          a disc 0.1 mm thin against a thin wall, at this speed (m/s)
 *   far away       five bounces this far from the origin (m)
 *   spin           an ellipsoid tumbles at this rate (rad/s), and hits the floor
 *   bounces        so many of them, restitution 1
 *   restitution    all bounces until rest: the time they take
 *   friction       a sliding sphere, to 5/7 of its speed
 *   sliding units  the same, with lengths and gravity times this
 *   exponent       a superquadric falls on the floor, tilted
 *   slimness       an ellipsoid of this aspect falls on the floor, tilted
 */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <time.h>
#include <quat/rotation.h>
#include "report_extreme.h"
#include "truth_lean.h"

/* ---- a scene, its run and its row ---- */

static void start(extreme_trial *t, double duration)
{
    *t = (extreme_trial){.def = impact_default_scene_def()};
    t->def.gravity = (qvec3){0, 0, -extreme_gravity};
    t->def.duration = duration;
    t->def.output_rate = 0;
}

static impact_body_def *add(extreme_trial *t, const char *name, double restitution, double friction)
{
    impact_body_def *body = &t->bodies[t->def.body_count++];
    *body = impact_default_body_def();
    body->name = name;
    body->mass = 1;
    body->restitution = restitution;
    body->friction = friction;
    return body;
}

static void add_floor(extreme_trial *t)
{
    impact_body_def *body = add(t, "floor", 1, 1);
    impact_shape_plane(INFINITY, INFINITY, &body->shape);
    body->is_static = true;
}

static impact_body_def *add_ball(extreme_trial *t, double radius, double restitution, double friction)
{
    impact_body_def *body = add(t, "ball", restitution, friction);
    impact_shape_sphere(radius, &body->shape);
    return body;
}

static void complain(const extreme_trial *t, const char *message)
{
    if (t->status < 0) fprintf(stderr, "report_extreme: %s\n", message);
}

void extreme_open(extreme_trial *t)
{
    t->def.bodies = t->bodies;
    t->def.forces = &t->force;
    char message[256];
    const clock_t from = clock();
    t->status = impact_scene_create(&t->def, &t->scene, message, sizeof message);
    t->cpu = (double)(clock() - from) / CLOCKS_PER_SEC;
    complain(t, message);
}

/* NAN: to the duration, or until all rests. */
void extreme_go_on(extreme_trial *t, double until)
{
    if (t->status < 0) return;
    const clock_t from = clock();
    t->status = isnan(until) ? impact_scene_run(t->scene, NULL) : impact_scene_run_to(t->scene, until, NULL);
    t->cpu += (double)(clock() - from) / CLOCKS_PER_SEC;
    complain(t, impact_scene_message(t->scene));
}

static void run(extreme_trial *t)
{
    extreme_open(t);
    extreme_go_on(t, NAN);
}

impact_sample extreme_end_of(const extreme_trial *t, int body)
{
    impact_sample sample = {0};
    if (t->scene) impact_scene_body(t->scene, body, &sample);
    return sample;
}

static double account(const impact_energy *e)
{
    const double now = e->kinetic + e->potential + e->damping_loss + e->sliding_loss + e->impact_loss - e->force_work;
    const double size = fabs(e->start) + fabs(e->kinetic) + fabs(e->potential) + fabs(e->force_work) + e->damping_loss +
                        e->sliding_loss + e->impact_loss;
    return size > 0 ? fabs(now - e->start) / size : 0;
}

void extreme_row(const char *name, double parameter, extreme_trial *t, extreme_source s)
{
    if (!t->scene) {
        printf("%s,%g,%s,,,,,,,,\n", name, parameter, impact_status_string(t->status));
        return;
    }
    const impact_usage u = impact_scene_usage(t->scene);
    const impact_energy e = impact_scene_energy(t->scene);
    printf("%s,%g,%s,%.1e,%.1e,%ld,%ld,%.3g,%s,%.4g,%.2g\n", name, parameter, impact_status_string(t->status), s.error,
           account(&e), u.events[IMPACT_EVENT_IMPACT], u.integrator_steps, 1e3 * t->cpu, s.by, s.until, s.condition);
    fflush(stdout);
    impact_scene_destroy(t->scene);
}

static void row(const char *name, double parameter, extreme_trial *t, double error)
{
    extreme_row(name, parameter, t, (extreme_source){error, "formula", t->def.duration, 1});
}

static double off(double value, double wanted) { return fabs(value - wanted) / fabs(wanted); }

/* ---- the cases ---- */

static bool drag(double t, int body, double mass, qvec3 x, quat q, qvec3 v, qvec3 omega, qvec3 *force, qvec3 *torque,
                 void *rate)
{
    (void)t, (void)body, (void)x, (void)q, (void)omega, (void)torque;
    *force = qvec3_scale(v, -mass * *(const double *)rate);
    return true;
}

static void stiff_drag(double rate)
{
    extreme_trial t;
    start(&t, 1);
    add_ball(&t, 0.1, 0, 0);
    t.force = impact_default_force_def(IMPACT_FORCE_CUSTOM);
    t.force.function = drag;
    t.force.context = &rate;
    t.def.force_count = 1;
    run(&t);
    row("stiff drag", rate, &t, off(extreme_end_of(&t, 0).velocity.z, extreme_gravity / rate * expm1(-rate)));
}

/* Height of the lowest point of a ball let fall from 1 m, at t, and its speed. */
static double bouncing(double restitution, double t)
{
    double v = sqrt(2 * extreme_gravity), left = t - v / extreme_gravity;
    for (;;) {
        v *= restitution;
        if (left < 2 * v / extreme_gravity) return left * (v - 0.5 * extreme_gravity * left);
        left -= 2 * v / extreme_gravity;
    }
}

/* Five bounces. */
static void drop(const char *name, double parameter, double unit, double away)
{
    extreme_trial t;
    start(&t, 2.8);
    t.def.gravity.z *= unit;
    t.def.rest_height *= unit;
    t.def.rest_speed *= unit;
    add_floor(&t);
    add_ball(&t, 0.3 * unit, 0.8, 0.2)->position = (qvec3){away, -away, 1.3 * unit};
    run(&t);
    const double wanted = (0.3 + bouncing(0.8, 2.8)) * unit;
    row(name, parameter, &t, off(extreme_end_of(&t, 1).position.z, wanted));
}

static void mass_ratio(double ratio)
{
    extreme_trial t;
    start(&t, 1);
    t.def.gravity.z = 0;
    add_ball(&t, 0.1, 1, 0.3)->velocity.x = 1;
    impact_body_def *other = add(&t, "other", 1, 0.3);
    impact_shape_sphere(0.1, &other->shape);
    other->mass = ratio;
    other->position.x = 0.7;
    run(&t);
    const double one = (1 - ratio) / (1 + ratio), two = 2 / (1 + ratio);
    row("mass ratio", ratio, &t,
        fmax(fabs(extreme_end_of(&t, 0).velocity.x - one), off(extreme_end_of(&t, 1).velocity.x, two)));
}

/* The heavy one falls on the light one's side and presses it away: truth_lean. */
static void heavy_on_light(double ratio)
{
    enum { PLACES = 8 };
    const qvec3 from = {0.15, 0.02, 0.1};
    const double away = hypot(from.x, from.y);
    const truth_lean lean = {
        .gravity = extreme_gravity, .radius = 0.1, .light = 1, .heavy = ratio, .away = away, .above = 0.15};
    const truth_lean_times times = truth_lean_events(&lean);
    extreme_trial t;
    start(&t, times.floor * (1 - 1e-6));
    add_floor(&t);
    impact_body_def *light = add_ball(&t, 0.1, 0, 0), *heavy = add(&t, "heavy", 0, 0);
    light->position = from;
    impact_shape_sphere(0.1, &heavy->shape);
    heavy->mass = ratio;
    heavy->position = (qvec3){0, 0, 0.25};
    extreme_open(&t);
    double worst = 0;
    for (int k = 1; k <= 2 * PLACES && t.status >= 0; k++) {
        double at, x1, x2, above;
        if (k <= PLACES)
            truth_lean_pressing(&lean, k / (double)PLACES, &at, &x1, &x2, &above);
        else
            at = times.parting + (t.def.duration - times.parting) * (k - PLACES) / PLACES,
            truth_lean_apart(&lean, at, &x1, &x2, &above);
        extreme_go_on(&t, at);
        const double c = from.x / away, s = from.y / away;
        const qvec3 one = {from.x - c * x1, from.y - s * x1, 0.1},
                    two = {from.x - c * x2, from.y - s * x2, 0.1 + above};
        worst = fmax(worst, qvec3_norm(qvec3_sub(extreme_end_of(&t, 1).position, one)));
        worst = fmax(worst, qvec3_norm(qvec3_sub(extreme_end_of(&t, 2).position, two)));
    }
    row("heavy on light", ratio, &t, worst / 0.2);
}

static void speed(double v)
{
    extreme_trial t;
    start(&t, 2 / v);
    t.def.gravity.z = 0;
    impact_body_def *wall = add(&t, "wall", 1, 0), *disc = add(&t, "disc", 1, 0);
    impact_shape_superquadric(5e-5, 1, 1, 8, 8, 8, &wall->shape);
    wall->is_static = true;
    impact_shape_superquadric(5e-5, 0.1, 0.1, 2, 2, 2, &disc->shape);
    disc->position.x = -1;
    disc->velocity.x = v;
    run(&t);
    /* At the face's flat middle: 1 - 1e-4 there, the rest back. */
    row("speed", v, &t, off(extreme_end_of(&t, 1).position.x, -1 - 2e-4));
}

static void spin(double rate)
{
    extreme_trial t;
    start(&t, 1);
    add_floor(&t);
    impact_body_def *body = add(&t, "egg", 1, 0);
    impact_shape_ellipsoid(0.3, 0.2, 0.1, &body->shape);
    body->position.z = 2;
    body->omega = (qvec3){0.01 * rate, rate, 0.02 * rate};
    extreme_open(&t);
    extreme_falling("spin", rate, &t, 2);
}

static void bounces(double count)
{
    extreme_trial t;
    const double each = 2 * sqrt(2 / extreme_gravity);
    start(&t, count * each);
    add_floor(&t);
    add_ball(&t, 0.3, 1, 0)->position.z = 1.3;
    run(&t);
    const impact_sample s = extreme_end_of(&t, 1);
    const double height = s.position.z - 0.3 + 0.5 * s.velocity.z * s.velocity.z / extreme_gravity;
    row("bounces", count, &t, fabs(height - 1));
}

static void restitution(double e)
{
    extreme_trial t;
    const double fall = sqrt(2 / extreme_gravity), rest = fall * (1 + e) / (1 - e);
    start(&t, 2 * rest);
    add_floor(&t);
    add_ball(&t, 0.3, e, 0)->position.z = 1.3;
    run(&t);
    row("restitution", e, &t, t.scene ? off(impact_scene_time(t.scene), rest) : NAN);
}

/* Lengths and gravity in this unit. */
static void slide(const char *name, double parameter, double mu, double unit)
{
    extreme_trial t;
    const double v = 1;
    start(&t, 2 * 2 * v / (7 * mu * extreme_gravity));
    t.def.gravity.z *= unit;
    t.def.rest_height *= unit;
    t.def.rest_speed *= unit;
    add_floor(&t);
    impact_body_def *ball = add_ball(&t, 0.3 * unit, 0, mu);
    ball->position.z = 0.3 * unit;
    ball->velocity.x = v * unit;
    run(&t);
    row(name, parameter, &t, off(extreme_end_of(&t, 1).velocity.x, 5 * v * unit / 7));
}

static void friction(double mu) { slide("friction", mu, mu, 1); }
static void sliding_units(double unit) { slide("sliding units", unit, 0.3, unit); }

static void falls(const char *name, double parameter, const impact_shape *shape, double height, double duration)
{
    extreme_trial t;
    start(&t, duration);
    add_floor(&t);
    impact_body_def *body = add(&t, "body", 0.5, 0.3);
    body->shape = *shape;
    body->position.z = height;
    body->orientation = quat_from_rotation_vector((qvec3){0.3, 0.2, 0.1});
    extreme_open(&t);
    extreme_falling(name, parameter, &t, shape->r);
}

static void exponent(double n)
{
    impact_shape shape;
    impact_shape_superquadric(0.2, 0.15, 0.1, n, n, n, &shape);
    falls("exponent", n, &shape, 0.5, 2);
}

static void slimness(double aspect)
{
    impact_shape shape;
    impact_shape_ellipsoid(0.3, 0.3 / aspect, 0.3 / aspect, &shape);
    falls("slimness", aspect, &shape, 0.5, 1);
}

static void each(void (*trial_of)(double), double from, double factor, int count)
{
    for (int i = 0; i < count; i++, from *= factor) trial_of(from);
}

int main(void)
{
    printf("case,parameter,ended,error,account,impacts,steps,ms,by,until,condition\n");
    each(stiff_drag, 1, 100, 5);
    for (int k = -9; k <= 9; k += 3) drop("units", pow(10, k), pow(10, k), 0);
    each(mass_ratio, 1e-12, 1e4, 7);
    each(heavy_on_light, 1, 1e4, 4);
    each(speed, 1, 100, 4);
    for (int k = 0; k <= 12; k += 3) drop("far away", pow(10, k), 1, pow(10, k));
    each(spin, 1, 100, 5);
    each(bounces, 10, 10, 4);
    restitution(0.01);
    restitution(0.5);
    restitution(0.99);
    restitution(0.999);
    each(friction, 1e-6, 100, 7);
    each(sliding_units, 1e-9, 1000, 7);
    static const double exponents[] = {1.1, 2, 4, 10, 30, 100, 300};
    for (int i = 0; i < 7; i++) exponent(exponents[i]);
    each(slimness, 1, 10, 7);
    return 0;
}
