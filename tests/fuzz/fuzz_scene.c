/* SPDX-License-Identifier: MIT
 *
 * Whole scenes of two to five bodies: each ends with a status; rows in order, finite, of unit orientations; with an
 * answer the energy has not risen and no loss is below zero.
 */
#include "solids.h"

#include <impact/impact.h>

enum { MOST = 5, ROWS = 100000 };

static impact_scene_def def;
static impact_body_def bodies[MOST];
static impact_force_def force;
static double constants[4]; /* of the custom force: spring, drag, torque, unused */
static bool bad_row;
static double last_time;
static long rows;

static void show_body(FILE *out, int i, const impact_body_def *o)
{
    fprintf(out,
            "    b[%d] = impact_default_body_def();\n    b[%d].name = \"b%d\", b[%d].is_static = %d, b[%d].shape = "
            "(impact_shape)",
            i, i, i, i, o->is_static, i);
    show_shape(out, &o->shape);
    fprintf(out, ";\n    b[%d].mass = ", i);
    show_number(out, o->mass);
    fprintf(out, ", b[%d].friction = %.17g, b[%d].restitution = %.17g", i, o->friction, i, o->restitution);
    fprintf(out, ",\n    b[%d].linear_damping = %.17g, b[%d].angular_damping = %.17g", i, o->linear_damping, i,
            o->angular_damping);
    const struct {
        const char *name;
        qvec3 value;
    } vectors[] = {{"position", o->position}, {"velocity", o->velocity}, {"omega", o->omega}};
    for (int k = 0; k < 3; k++) {
        fprintf(out, ",\n    b[%d].%s = ", i, vectors[k].name);
        show_vec3(out, "(qvec3)", vectors[k].value);
    }
    fprintf(out, ",\n    b[%d].orientation = ", i);
    show_quat(out, "(quat)", o->orientation);
    fputs(";\n", out);
}

static void show_force(FILE *out)
{
    fprintf(out,
            "    impact_force_def f = impact_default_force_def((impact_force_kind)%d);\n    f.name = \"f\", f.strength "
            "= %.17g, f.reach = ",
            (int)force.kind, force.strength);
    show_number(out, force.reach);
    fprintf(out, ", f.constant = %.17g, f.power = %.17g", force.constant, force.power);
    if (force.kind == IMPACT_FORCE_CUSTOM) fputs(", f.function = push", out);
    fputs(";\n    def.forces = &f, def.force_count = 1;\n", out);
}

void fuzz_show(FILE *out)
{
    fputs("#include <impact/impact.h>\n#include <math.h>\n#include <stdio.h>\n\n", out);
    if (def.force_count && force.kind == IMPACT_FORCE_CUSTOM)
        fprintf(out,
                "static bool push(double t, int body, double mass, qvec3 x, quat q, qvec3 v, qvec3 w, qvec3 *f, qvec3 "
                "*torque, void *c)\n"
                "{\n    *f = qvec3_add(qvec3_scale(x, -%.17g), qvec3_scale(v, -%.17g));\n"
                "    *torque = (qvec3){%.17g * sin(t), 0, 0};\n    return true;\n}\n\n",
                constants[0], constants[1], constants[2]);
    fputs("int main(void)\n{\n    impact_scene_def def = impact_default_scene_def();\n    impact_body_def b[5];\n",
          out);
    fprintf(out, "    def.duration = %.17g, def.output_rate = %.17g, def.max_events = %ld, def.max_steps = %ld",
            def.duration, def.output_rate, def.max_events, def.max_steps);
    fprintf(out, ", def.law = (impact_law)%d", (int)def.law);
    fprintf(out, ", def.friction_rule = (impact_pair_rule)%d, def.bodies = b, def.body_count = %d",
            (int)def.friction_rule, def.body_count);
    show_vec3(out, ", def.gravity = (qvec3)", def.gravity);
    fputs(";\n", out);
    for (int i = 0; i < def.body_count; i++) show_body(out, i, &bodies[i]);
    if (def.force_count) show_force(out);
    fputs("    impact_scene *scene;\n    char message[300] = \"\";\n"
          "    if (impact_scene_create(&def, &scene, message, sizeof message) < 0) return puts(message), 1;\n"
          "    const impact_status s = impact_scene_run(scene, NULL);\n    const impact_energy e = "
          "impact_scene_energy(scene);\n"
          "    printf(\"%s at %.17g: %s\\nenergy %.17g, was %.17g; losses %g %g %g\\n\", impact_status_string(s), "
          "impact_scene_time(scene),\n"
          "           impact_scene_message(scene), e.kinetic + e.potential, e.start, e.impact_loss, e.sliding_loss, "
          "e.damping_loss);\n"
          "    impact_scene_destroy(scene);\n}\n",
          out);
}

static bool on_sample(void *context, const impact_sample *s)
{
    (void)context;
    const bool finite = qvec3_isfinite(s->position) && qvec3_isfinite(s->velocity) && qvec3_isfinite(s->omega);
    bad_row |= !finite || !(fabs(quat_norm(s->orientation) - 1) <= 1e-9) || s->t < last_time;
    last_time = s->t;
    return ++rows < ROWS;
}

static bool on_event(void *context, const impact_event *e)
{
    (void)context;
    const double sum = e->t + e->energy_after + e->impulse_normal + e->impulse_tangential + e->normal_after;
    bad_row |= !isfinite(sum) || !qvec3_isfinite(e->point) || !qvec3_isfinite(e->normal);
    return ++rows < ROWS;
}

static bool push(double t, int body, double mass, qvec3 x, quat q, qvec3 v, qvec3 w, qvec3 *f, qvec3 *torque,
                 void *context)
{
    (void)body, (void)mass, (void)q, (void)w, (void)context;
    *f = qvec3_add(qvec3_scale(x, -constants[0]), qvec3_scale(v, -constants[1]));
    *torque = (qvec3){constants[2] * sin(t), 0, 0};
    return true;
}

static void take_body_shape(fuzz_bytes *b, unsigned kind, impact_shape *shape)
{
    const double a = 0.05 + take_unit(b), m = 0.2 + take_unit(b), n = 0.2 + take_unit(b);
    if (kind < 130)
        impact_shape_sphere(a, shape);
    else if (kind < 190)
        impact_shape_ellipsoid(a, a * m, a * n, shape);
    else if (kind < 225) {
        const double t = 1 + 3 * take_unit(b), s = 1 + 3 * take_unit(b), r = 1 + 3 * take_unit(b);
        impact_shape_superquadric(a, a * m, a * n, r, s, t, shape);
    } else
        impact_shape_superquadric(a, a * m, a * n, 50, 50, 50, shape);
}

/* Bodies stand on a grid, so that few overlap at the start: what does is refused. */
static void take_body(fuzz_bytes *b, int i, bool floor)
{
    static const char *const names[MOST] = {"a", "b,\"", "c\n", "d", "e"};
    impact_body_def *body = &bodies[i];
    *body = impact_default_body_def();
    body->name = names[i];
    body->friction = take_unit(b) * 1.5;
    body->restitution = take_unit(b);
    const unsigned kind = i == 0 && floor ? 0 : take_byte(b);
    if (kind < 40) {
        impact_shape_plane(INFINITY, INFINITY, &body->shape);
        body->is_static = true;
        if (i > 0) body->orientation = take_quat(b), body->position = take_vec3(b, 1);
        return;
    }
    take_body_shape(b, kind, &body->shape);
    body->mass = take_byte(b) < 200 ? NAN : take_positive(b, 6);
    body->is_static = take_byte(b) < 20;
    const double x = take_signed(b, 1), y = take_signed(b, 1), z = take_signed(b, 1);
    body->position = (qvec3){2.2 * (i % 3) + x / 2, 2.2 * (i / 3) + y / 2, 1.2 + z / 5};
    body->orientation = take_quat(b);
    if (!body->is_static) {
        body->velocity = qvec3_scale(take_vec3(b, 2), 3);
        body->omega = qvec3_scale(take_vec3(b, 2), 5);
    }
    if (take_byte(b) < 20) body->linear_damping = 0.9 * take_unit(b), body->angular_damping = 0.9 * take_unit(b);
}

static void take_force(fuzz_bytes *b)
{
    force = impact_default_force_def((impact_force_kind)take_below(b, 3));
    force.name = "f";
    force.strength = take_signed(b, 2);
    force.reach = take_byte(b) & 1 ? INFINITY : take_positive(b, 1);
    force.constant = take_signed(b, 2);
    force.power = 2 * take_unit(b);
    for (int i = 0; i < 4; i++) constants[i] = fabs(take_signed(b, 1));
    if (force.kind == IMPACT_FORCE_CUSTOM) force.function = push;
    def.forces = &force, def.force_count = 1;
}

static void take_scene(fuzz_bytes *b)
{
    const unsigned mode = take_byte(b);
    def = impact_default_scene_def();
    def.gravity = mode & 1 ? (qvec3){0, 0, -9.81} : take_vec3(b, 1);
    def.duration = 0.05 + 0.5 * take_unit(b);
    def.output_rate = 20 * take_unit(b);
    def.max_events = 300, def.max_steps = 20000; /* the caller's bounds on work that is done, a second or two of it */
    def.body_count = 2 + (int)take_below(b, MOST - 1);
    def.law = (impact_law)take_below(b, 3);
    def.friction_rule = (impact_pair_rule)take_below(b, 4);
    def.bodies = bodies;
    for (int i = 0; i < def.body_count; i++) take_body(b, i, mode & 2);
    if (impact_has(IMPACT_PART_CVODE) && take_byte(b) < 50) take_force(b);
    if (take_byte(b) < 3) { /* any of a body's numbers may be anything */
        double *p = &bodies[take_below(b, (unsigned)def.body_count)].mass;
        p[take_below(b, 25)] = take_wild(b);
    }
}

static void hold_energy(const impact_energy *e)
{
    const double now = e->kinetic + e->potential, work = e->force_work + e->drive_work;
    const double scale = fabs(e->start) + fabs(e->kinetic) + fabs(e->potential) + fabs(work), room = 1e-7 * scale;
    HOLD(isfinite(now), now, 0);
    if (def.law != IMPACT_NEWTON && !def.force_count) HOLD(now - work <= e->start + room, now - work - e->start, room);
    HOLD(e->damping_loss >= -room, e->damping_loss, -room);
    HOLD(e->sliding_loss >= -room, e->sliding_loss, -room);
    if (def.law != IMPACT_NEWTON) HOLD(e->impact_loss >= -room, e->impact_loss, -room);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_bytes b = {data, size};
    const impact_recorder recorder = {.struct_size = sizeof recorder, .sample = on_sample, .event = on_event};
    impact_scene *scene;
    char message[300] = "";
    take_scene(&b);
    if (impact_scene_create(&def, &scene, message, sizeof message) < 0) {
        HOLD(message[0] != 0, 0, 0);
        return 0;
    }
    bad_row = false, last_time = 0, rows = 0;
    const impact_status s = impact_scene_run(scene, &recorder);
    const impact_energy e = impact_scene_energy(scene);
    HOLD(!bad_row, last_time, 0);
    HOLD(s >= 0 || impact_scene_message(scene)[0] != 0, s, 0);
    if (s == IMPACT_OK || s == IMPACT_AT_REST || s == IMPACT_EVENT_LIMIT) hold_energy(&e);
    impact_scene_destroy(scene);
    return 0;
}
