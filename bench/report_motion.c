/* SPDX-License-Identifier: MIT
 *
 * report_motion: what a thousand seconds of motion in a conservative field do to its energy, and where the answer is
 * known to the place. CSV: dE the change of the energy relative to the energy at the start; place the distance from
 * where the orbit began, in half axes, after a hundred periods; steps of the integrator.
 */
#include <stdio.h>
#include <impact/impact.h>
#include <quat/rotation.h>

static const double duration = 1000;

static impact_body_def body(const char *name, double mass)
{
    impact_body_def def = impact_default_body_def();
    impact_shape_sphere(1e-3, &def.shape);
    def.name = name;
    def.mass = mass;
    return def;
}

/* Runs; the scene is the caller's to destroy. */
static impact_scene *run(const impact_body_def *bodies, int count, const impact_force_def *force)
{
    impact_scene_def def = impact_default_scene_def();
    def.gravity = (qvec3){0, 0, 0};
    def.bodies = bodies;
    def.body_count = count;
    def.forces = force;
    def.force_count = force ? 1 : 0;
    def.duration = duration;
    def.output_rate = 0;
    impact_scene *scene;
    char message[256];
    impact_status status = impact_scene_create(&def, &scene, message, sizeof message);
    if (status == IMPACT_OK) {
        status = impact_scene_run(scene, NULL);
        snprintf(message, sizeof message, "%s", impact_scene_message(scene));
    }
    if (status == IMPACT_OK) return scene;
    fprintf(stderr, "report_motion: %s: %s\n", impact_status_string(status), message);
    impact_scene_destroy(scene);
    return NULL;
}

static void row(const char *name, double parameter, double change, double place, const impact_scene *scene)
{
    printf("%s,%g,%.2e,%.2e,%ld\n", name, parameter, change, place, impact_scene_usage(scene).integrator_steps);
}

/* Two bodies under G m1 m2/r^2, from where they are farthest apart; after a hundred periods of 10 s they are there
 * again. */
static void kepler(double eccentricity)
{
    const double pi = 3.14159265358979323846, period = 10, mu = 4 * pi * pi / (period * period), m[2] = {3, 1};
    const double r = 1 + eccentricity, v = sqrt(mu * (1 - eccentricity) / r);
    impact_body_def bodies[2] = {body("heavy", m[0]), body("light", m[1])};
    bodies[0].position.x = -r * m[1] / (m[0] + m[1]);
    bodies[1].position.x = r * m[0] / (m[0] + m[1]);
    bodies[0].velocity.y = -v * m[1] / (m[0] + m[1]);
    bodies[1].velocity.y = v * m[0] / (m[0] + m[1]);
    impact_force_def force = impact_default_force_def(IMPACT_FORCE_ATTRACTION);
    force.constant = mu / (m[0] + m[1]);
    impact_scene *scene = run(bodies, 2, &force);
    if (!scene) return;
    const impact_energy e = impact_scene_energy(scene);
    impact_sample end;
    impact_scene_body(scene, 1, &end);
    row("kepler", eccentricity, (e.kinetic + e.potential - e.start) / fabs(e.start),
        qvec3_norm(qvec3_sub(end.position, bodies[1].position)), scene);
    impact_scene_destroy(scene);
}

/* The torque of a field along z on a moment along the body's z axis; its potential is -strength z.z'. */
static bool compass(double t, int index, double mass, qvec3 x, quat q, qvec3 v, qvec3 omega, qvec3 *force,
                    qvec3 *torque, void *strength)
{
    (void)t, (void)index, (void)mass, (void)x, (void)v, (void)omega, (void)force;
    const qvec3 z = {0, 0, 1};
    *torque = qvec3_scale(qvec3_cross(quat_rotate(q, z), z), *(const double *)strength);
    return true;
}

/* A T-handle spun next to its middle axis, in a field of this strength (J), against 9 J; 0: free, in closed form. */
static void handle(double strength)
{
    impact_body_def T = body("T", 1);
    T.moments = (qvec3){1, 2, 3};
    T.omega = (qvec3){0.01, 3, 0.01};
    impact_force_def field = impact_default_force_def(IMPACT_FORCE_CUSTOM);
    field.function = compass;
    field.context = &strength;
    impact_scene *scene = run(&T, 1, strength != 0 ? &field : NULL);
    if (!scene) return;
    impact_sample end;
    impact_scene_body(scene, 0, &end);
    const double potential = strength * (1 - quat_rotate(end.orientation, (qvec3){0, 0, 1}).z);
    const impact_energy e = impact_scene_energy(scene);
    row("handle", strength, (e.kinetic + potential - e.start) / e.start, NAN, scene);
    impact_scene_destroy(scene);
}

int main(void)
{
    printf("motion,parameter,dE,place,steps\n");
    for (int i = 0; i < 4; i++) kepler(0.3 * i);
    handle(0);
    handle(0.01);
    handle(1);
    return 0;
}
