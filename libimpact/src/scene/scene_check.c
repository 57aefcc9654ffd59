/* SPDX-License-Identifier: MIT */
#include "scene/scene_check.h"
#include "base/number.h"
#include "scene/scene_methods.h"
#include "shape/ridge.h"
#include "shape/solid.h"
#include "world/surface_velocity.h"

#include <stdio.h>
#include <string.h>

/* Where the message goes, and whose value is being looked at. */
typedef struct check {
    char *message;
    size_t size;
    const char *kind, *name; /* "body", "coin" */
    char number[32];         /* in place of a name that is not there */
    impact_status status;
    imp_names *names; /* of the bodies passed so far */
} check;

/* Every test below goes through here: the first failure is kept. */
static bool require(check *c, bool good, const char *key, double value, const char *rule)
{
    if (c->status != IMPACT_OK) return false;
    if (good) return true;
    c->status = isfinite(value) ? IMPACT_EARGUMENT : IMPACT_EDOMAIN;
    if (c->message && c->size > 0)
        snprintf(c->message, c->size, "%s '%s': %s = %s: %s", c->kind, c->name, key, imp_number_of(value).text, rule);
    return false;
}

static void require_words(check *c, bool good, const char *words)
{
    if (c->status != IMPACT_OK || good) return;
    c->status = IMPACT_EARGUMENT;
    if (c->message && c->size > 0) snprintf(c->message, c->size, "%s '%s': %s", c->kind, c->name, words);
}

static void require_vector(check *c, qvec3 v, const char *key)
{
    const double values[3] = {v.x, v.y, v.z};
    for (int i = 0; i < 3; i++) {
        char component[64];
        if (isfinite(values[i])) continue;
        snprintf(component, sizeof component, "%s.%c", key, "xyz"[i]);
        require(c, false, component, values[i], "must be finite");
    }
}

static void check_mass(check *c, const impact_body_def *body)
{
    if (body->is_static) return;
    if (isnan(body->mass))
        require(c, isfinite(body->density) && body->density > 0, "density", body->density,
                "must be positive and finite, or give a mass");
    else
        require(c, isfinite(body->mass) && body->mass > 0, "mass", body->mass, "must be positive and finite");
    const double m[3] = {body->moments.x, body->moments.y, body->moments.z};
    if (isnan(m[0]) && isnan(m[1]) && isnan(m[2])) return;
    for (int i = 0; i < 3; i++) require(c, isfinite(m[i]) && m[i] > 0, "moments", m[i], "must be positive and finite");
    for (int i = 0; i < 3; i++)
        require(c, m[i] <= (m[(i + 1) % 3] + m[(i + 2) % 3]) * (1 + IMP_MOMENTS_TOGETHER), "moments", m[i],
                "is larger than the other two together: no rigid body has such moments");
}

double imp_scene_body_mass(const impact_body_def *body, qvec3 *moments)
{
    const double mass = isnan(body->mass) ? body->density * impact_shape_volume(&body->shape) : body->mass;
    *moments = isnan(body->moments.x) ? qvec3_scale(impact_shape_inertia(&body->shape), mass) : body->moments;
    return mass;
}

/* What comes of the shape and the density must have a place among the doubles. */
static void check_solid(check *c, const impact_body_def *body)
{
    static const char beyond[] = "of this size and density lies beyond double precision: take other units";
    qvec3 moments;
    const double mass = imp_scene_body_mass(body, &moments);
    const double m[3] = {moments.x, moments.y, moments.z};
    require(c, isnormal(mass), "mass", mass, beyond);
    for (int i = 0; i < 3; i++) require(c, isnormal(m[i]), "moments", m[i], beyond);
}

bool imp_scene_shape_stands_aside(const impact_body_def *body)
{
    const qvec3 p = body->shape_position;
    const quat q = body->shape_orientation;
    return p.x != 0 || p.y != 0 || p.z != 0 || q.x != 0 || q.y != 0 || q.z != 0;
}

/* Sides that are flat but for rounding: as good as those of 1. */
static void check_exponents(check *c, const impact_shape *shape)
{
    if (shape->kind != IMPACT_SUPERQUADRIC && shape->kind != IMPACT_SUPERELLIPSOID) return;
    const double exponents[3] = {shape->r, shape->s, shape->t};
    static const char *const keys[3] = {"exponent r", "exponent s", "exponent t"};
    for (int i = 0; i < 3; i++)
        require(c, exponents[i] == 1 || exponents[i] >= 1 + IMP_LEAST_OVER_ONE, keys[i], exponents[i],
                "over 1 by less than 1e-6: give 1");
}

static void check_body(check *c, const impact_body_def *body)
{
    require_vector(c, body->position, "position");
    require_vector(c, body->velocity, "velocity");
    require_vector(c, body->omega, "omega");
    quat unit;
    const double size = body->orientation.w + body->orientation.x + body->orientation.y + body->orientation.z;
    require(c, quat_normalize(body->orientation, &unit) == QUAT_OK, "orientation", size,
            "must be a finite quaternion that is not zero");
    require_vector(c, body->shape_position, "shape_position");
    require_vector(c, body->trail, "trail");
    require_words(c, quat_normalize(body->shape_orientation, &unit) == QUAT_OK,
                  "shape_orientation must be a finite quaternion that is not zero");
    const bool aside = imp_scene_shape_stands_aside(body);
    require_words(c, !aside || body->shape.kind != IMPACT_PLANE,
                  "a plane takes no shape_position or shape_orientation");
    require_words(c, !aside || body->is_static || !isnan(body->moments.x),
                  "give moments: its shape stands aside of the centre of mass or of the principal axes");
    check_mass(c, body);
    require(c, isfinite(body->friction) && body->friction >= 0, "friction", body->friction, "must be >= 0 and finite");
    require(c, body->restitution >= 0 && body->restitution <= 1, "restitution", body->restitution,
            "must lie in [0, 1]");
    require(c, isfinite(body->torsional_friction) && body->torsional_friction >= 0, "torsional_friction",
            body->torsional_friction, "must be a length, >= 0 and finite");
    require(c, isfinite(body->rolling_friction) && body->rolling_friction >= 0, "rolling_friction",
            body->rolling_friction, "must be a length, >= 0 and finite");
    require(c, body->linear_damping >= 0 && body->linear_damping < 1, "linear_damping", body->linear_damping,
            "must lie in [0, 1)");
    require(c, body->angular_damping >= 0 && body->angular_damping < 1, "angular_damping", body->angular_damping,
            "must lie in [0, 1)");
    require_words(c, body->is_static || body->shape.kind != IMPACT_PLANE, "a plane must be static");
    char why[200];
    require_words(c, impact_shape_check(&body->shape, why, sizeof why) == IMPACT_OK, why);
    check_exponents(c, &body->shape);
    if (c->status != IMPACT_OK) return;
    if (!body->is_static) check_solid(c, body);
    const char *refusal = imp_surface_velocity_refusal(body);
    require_words(c, !refusal, refusal);
}

static bool has_faces(const impact_body_def *body)
{
    const impact_shape *shape = &body->shape;
    return imp_has_core(shape) || imp_is_octahedron(shape) || imp_ridge_count(shape) > 0;
}

static void check_bodies(check *c, const impact_scene_def *def, imp_arena *arena)
{
    require(c, def->body_count >= 1, "bodies", def->body_count, "a scene needs at least one body");
    require_words(c, def->bodies != NULL, "bodies is NULL, and body_count is not 0");
    if (c->status == IMPACT_OK) c->status = imp_names_open(c->names, arena, def->body_count);
    for (int i = 0; c->status == IMPACT_OK && i < def->body_count; i++) {
        const impact_body_def *body = &def->bodies[i];
        snprintf(c->number, sizeof c->number, "%d", i + 1);
        c->kind = "body";
        c->name = c->number;
        require_words(c, body->name && body->name[0] != '\0', "has no name");
        if (c->status != IMPACT_OK) return;
        c->name = body->name;
        require_words(c, imp_names_find(c->names, body->name) < 0, "the name is taken by another body");
        check_body(c, body);
        require_words(c, !has_faces(body) || def->body_count == 1 || def->piles != IMPACT_PILES_EXACT,
                      "bodies with faces go by steps where they lie on each other: piles = 'exact' is not for them");
        if (c->status == IMPACT_OK) c->status = imp_names_add(c->names, body->name);
    }
}

/* Torsional and rolling friction are in the cone problems of steps and of Moreau's impacts. */
static void check_turning(check *c, const impact_scene_def *def)
{
    bool turning = false;
    for (int i = 0; i < def->body_count; i++)
        turning = turning || def->bodies[i].torsional_friction > 0 || def->bodies[i].rolling_friction > 0;
    for (int k = 0; k < def->pair_count; k++)
        turning = turning || def->pairs[k].torsional_friction > 0 || def->pairs[k].rolling_friction > 0;
    c->kind = "scene", c->name = def->name ? def->name : "";
    require_words(c, !turning || def->law == IMPACT_POISSON,
                  "torsional_friction and rolling_friction are answered with Poisson's law: law = \"poisson\"");
    require_words(c, !turning || imp_scene_piles_of(def) != IMPACT_PILES_EXACT,
                  "bodies with torsional_friction or rolling_friction are moved by steps while they touch, but for a "
                  "ball on a plane: piles = \"exact\", or all by integrators, is not for them");
}

/* The edges of a plane carry nothing: a face would reach over them as if the plane went on. */
static void check_faces(check *c, const impact_scene_def *def)
{
    bool faces = false;
    for (int i = 0; i < def->body_count; i++)
        faces = faces || (!def->bodies[i].is_static && has_faces(&def->bodies[i]));
    for (int i = 0; c->status == IMPACT_OK && faces && i < def->body_count; i++) {
        const impact_shape *shape = &def->bodies[i].shape;
        c->kind = "body";
        c->name = def->bodies[i].name;
        require_words(c, shape->kind != IMPACT_PLANE || (isinf(shape->a) && isinf(shape->b)),
                      "a plane with edges carries no bodies with faces: take a static box, or a plane without edges");
    }
}

static void check_custom(check *c, const impact_force_def *force)
{
    require_words(c, force->function != NULL, "a custom force needs a function");
    require(c, isnan(force->max_step) || force->max_step > 0, "max_step", force->max_step, "must be positive");
    require(c, isfinite(force->switch_period) && force->switch_period >= 0, "switch_period", force->switch_period,
            "must be >= 0 and finite");
    require(c, force->switch_count >= 0, "switch_count", force->switch_count, "must be >= 0");
    require_words(c, force->switch_count <= 0 || force->switches != NULL, "has no switches, but a switch_count");
    for (int i = 0; c->status == IMPACT_OK && i < force->switch_count; i++) {
        char key[40];
        snprintf(key, sizeof key, "switches[%d]", i + 1);
        require(c, isfinite(force->switches[i]), key, force->switches[i], "must be finite");
        require(c, i == 0 || force->switches[i] > force->switches[i - 1], key, force->switches[i],
                "does not come after the one before it: switches must rise");
    }
    const bool fits = c->status != IMPACT_OK || force->switch_period == 0 || force->switch_count == 0 ||
                      force->switches[force->switch_count - 1] - force->switches[0] < force->switch_period;
    require(c, fits, "switch_period", force->switch_period, "is shorter than the switches in it");
}

static void check_force(check *c, const impact_force_def *force, const impact_body_def *bodies)
{
    const int body = force->body ? imp_names_find(c->names, force->body) : -1;
    char words[160];
    snprintf(words, sizeof words, "acts on body '%s', which %s", force->body ? force->body : "",
             body < 0 ? "the scene does not have" : "is static: nothing moves it");
    require_words(c, !force->body || (body >= 0 && !bodies[body].is_static), words);
    require(c, force->reach > 0, "reach", force->reach, "must be positive");
    switch (force->kind) {
    case IMPACT_FORCE_WIND:
        require_vector(c, force->origin, "origin");
        require_vector(c, force->direction, "direction");
        require(c, qvec3_norm(force->direction) > 0, "direction", 0, "must not be zero");
        require(c, isfinite(force->strength), "strength", force->strength, "must be finite");
        require(c, force->radius > 0, "radius", force->radius, "must be positive");
        require(c, isfinite(force->falloff_power), "falloff_power", force->falloff_power, "must be finite");
        require(c, isfinite(force->falloff_length) && force->falloff_length > 0, "falloff_length",
                force->falloff_length, "must be positive and finite");
        require(c, isfinite(force->drag) && force->drag >= 0, "drag", force->drag, "must be finite and not negative");
        break;
    case IMPACT_FORCE_ATTRACTION:
        require_words(c, !force->body, "an attraction acts on every two bodies: it takes no 'body'");
        require(c, isfinite(force->constant), "constant", force->constant, "must be finite");
        require(c, isfinite(force->power), "power", force->power, "must be finite");
        break;
    case IMPACT_FORCE_CUSTOM: check_custom(c, force); break;
    default: require_words(c, false, "is of no known kind");
    }
}

/* Arrays that stand beside a count. */
static void check_arrays(check *c, const impact_scene_def *def)
{
    require(c, def->force_count >= 0, "force_count", def->force_count, "must be >= 0");
    require_words(c, def->force_count == 0 || def->forces != NULL, "forces is NULL, and force_count is not 0");
    require(c, def->pair_count >= 0, "pair_count", def->pair_count, "must be >= 0");
    require_words(c, def->pair_count == 0 || def->pairs != NULL, "pairs is NULL, and pair_count is not 0");
}

static void check_pair(check *c, const impact_pair_def *pair)
{
    const int i = imp_names_find(c->names, pair->body1), j = imp_names_find(c->names, pair->body2);
    c->name = pair->body1 ? pair->body1 : "";
    require_words(c, i >= 0, "the scene has no such body");
    c->name = pair->body2 ? pair->body2 : "";
    require_words(c, j >= 0, "the scene has no such body");
    require_words(c, i != j, "a pair needs two bodies");
    require(c, isnan(pair->friction) || (isfinite(pair->friction) && pair->friction >= 0), "friction", pair->friction,
            "must be >= 0 and finite");
    require(c, isnan(pair->restitution) || (pair->restitution >= 0 && pair->restitution <= 1), "restitution",
            pair->restitution, "must lie in [0, 1]");
    require(c, isnan(pair->torsional_friction) || (isfinite(pair->torsional_friction) && pair->torsional_friction >= 0),
            "torsional_friction", pair->torsional_friction, "must be a length, >= 0 and finite");
    require(c, isnan(pair->rolling_friction) || (isfinite(pair->rolling_friction) && pair->rolling_friction >= 0),
            "rolling_friction", pair->rolling_friction, "must be a length, >= 0 and finite");
    require(c, isnan(pair->stiffness) || (pair->stiffness >= 0 && isfinite(pair->stiffness)), "stiffness",
            pair->stiffness, "must be finite and not negative");
}

static void check_methods(check *c, const impact_scene_def *def)
{
    char why[200];
    if (c->status != IMPACT_OK) return;
    const impact_status status = imp_scene_methods_check(def, why, sizeof why);
    require_words(c, status == IMPACT_OK, why);
    c->status = status;
}

impact_status imp_scene_check(const impact_scene_def *def, imp_arena *arena, imp_names *names, char *message,
                              unsigned long message_size)
{
    check c = {.message = message,
               .size = message_size,
               .kind = "scene",
               .name = def->name ? def->name : "",
               .status = IMPACT_OK,
               .names = names};
    require_vector(&c, def->gravity, "gravity");
    require(&c, isfinite(def->duration) && def->duration > 0, "duration", def->duration, "must be positive and finite");
    require(&c, isfinite(def->output_rate) && def->output_rate >= 0, "output_rate", def->output_rate,
            "must be >= 0 and finite");
    require(&c, def->output_rate * def->duration <= IMP_MOST_SAMPLES, "output_rate", def->output_rate,
            "with this duration makes more than 1e15 samples");
    require(&c, isfinite(def->compliance) && def->compliance >= 0, "compliance", def->compliance,
            "must be >= 0 and finite");
    require(&c, def->compliance == 0 || def->law == IMPACT_STRONGE, "compliance", def->compliance,
            "needs Stronge's law");
    require(&c, def->tolerance >= IMP_LEAST_TOLERANCE && def->tolerance <= IMP_MOST_TOLERANCE, "tolerance",
            def->tolerance, "must lie in [1e-15, 1e-2]");
    require(&c, isfinite(def->rest_height) && def->rest_height > 0, "rest_height", def->rest_height,
            "must be positive and finite");
    require(&c, isfinite(def->rest_speed) && def->rest_speed > 0, "rest_speed", def->rest_speed,
            "must be positive and finite");
    require(&c, def->key_tolerance >= IMP_LEAST_KEY_TOLERANCE && def->key_tolerance <= IMP_MOST_TOLERANCE,
            "key_tolerance", def->key_tolerance, "must lie in [1e-14, 1e-2]");
    require(&c, def->pile_tolerance >= IMP_LEAST_PILE_TOLERANCE && def->pile_tolerance <= IMP_MOST_TOLERANCE,
            "pile_tolerance", def->pile_tolerance, "must lie in [1e-9, 1e-2]");
    require(&c, def->max_events > 0, "max_events", (double)def->max_events, "must be positive");
    require(&c, def->piles >= IMPACT_PILES_AUTO && def->piles <= IMPACT_PILES_STEPS, "piles", def->piles,
            "is no way to move them");
    require(&c, def->together >= IMPACT_SCENE_TOGETHER_AUTO && def->together <= IMPACT_SCENE_SEQUENCE, "together",
            def->together, "is no law");
    require_words(&c, def->together != IMPACT_SCENE_SPRINGS || (def->law == IMPACT_STRONGE && def->compliance == 0),
                  "together = \"springs\" needs law = \"stronge\", without compliance");
    require_words(&c, def->together != IMPACT_SCENE_MOREAU || def->law != IMPACT_STRONGE,
                  "together = \"moreau\" needs law = \"poisson\" or \"newton\"");
    require(&c, def->samples == IMPACT_SAMPLES_ALL || def->samples == IMPACT_SAMPLES_MOVING, "samples", def->samples,
            "are neither all nor those that move");
    check_methods(&c, def);
    require(&c, def->max_steps > 0, "max_steps", (double)def->max_steps, "must be positive");
    require(&c, def->friction_rule >= IMPACT_PRODUCT && def->friction_rule <= IMPACT_MAXIMUM, "friction_rule",
            def->friction_rule, "is no rule");
    require(&c, def->restitution_rule >= IMPACT_PRODUCT && def->restitution_rule <= IMPACT_MAXIMUM, "restitution_rule",
            def->restitution_rule, "is no rule");
    check_arrays(&c, def);
    check_bodies(&c, def, arena);
    if (c.status == IMPACT_OK) check_faces(&c, def);
    if (c.status == IMPACT_OK) check_turning(&c, def);
    for (int k = 0; c.status == IMPACT_OK && k < def->force_count; k++) {
        c.kind = "force";
        c.name = def->forces[k].name ? def->forces[k].name : "";
        check_force(&c, &def->forces[k], def->bodies);
    }
    for (int k = 0; c.status == IMPACT_OK && k < def->pair_count; k++) {
        c.kind = "pair with";
        check_pair(&c, &def->pairs[k]);
    }
    return c.status;
}
