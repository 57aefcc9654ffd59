/* SPDX-License-Identifier: MIT
 *
 * Random scenes, the same for a seed on every machine: one to six bodies of all families of shapes over a floor, with
 * frictions, restitutions, dampings, forces and laws from all that a definition accepts and a minute's work can hold.
 */
#ifndef RANDOM_SCENE_H
#define RANDOM_SCENE_H

#include <stdio.h>
#include <impact/impact.h>
#include "contact_random.h"

enum { RANDOM_SCENE_BODIES = 6 };

/* Not to be copied: the definition points into it. */
typedef struct random_scene {
    impact_scene_def def;
    impact_body_def bodies[1 + RANDOM_SCENE_BODIES];
    char names[1 + RANDOM_SCENE_BODIES][8];
    impact_force_def force;
    double spring; /* N/m, of a custom force */
} random_scene;

/* Towards the place (0, 0, 1), in a rhythm. */
static inline bool random_scene_pull(double t, int body, double mass, qvec3 x, quat q, qvec3 v, qvec3 w, qvec3 *force,
                                     qvec3 *torque, void *context)
{
    const double spring = ((const random_scene *)context)->spring * (1 + 0.5 * sin(7 * t));
    (void)body, (void)mass, (void)q, (void)w, (void)torque;
    *force = (qvec3){-spring * x.x - 0.1 * v.x, -spring * x.y - 0.1 * v.y, spring * (1 - x.z) - 0.1 * v.z};
    return true;
}

/* Often a plain number: 0 and 1 are where cases part. */
static inline double random_coefficient(random_stream *random, double most)
{
    const double u = random_unit(random);
    return u < 0.15 ? 0 : u < 0.25 ? fmin(1, most) : most * random_unit(random);
}

static inline void random_scene_body(random_stream *random, random_scene *s, int i)
{
    impact_body_def *body = &s->bodies[i];
    *body = impact_default_body_def();
    snprintf(s->names[i], sizeof s->names[i], "b%d", i);
    body->name = s->names[i];
    const int family = (int)(random_unit(random) * RANDOM_FAMILIES);
    body->shape = random_shape(random, family == RANDOM_NEEDLE ? RANDOM_SPHERE : family);
    const double size = impact_shape_bounding_radius(&body->shape), scale = random_log(random, 0.1, 1) / size;
    body->shape.a *= scale, body->shape.b *= scale, body->shape.c *= scale;
    /* on a grid of places further apart than two radii */
    body->position = (qvec3){2.2 * (i % 3), 2.2 * (i / 3), 1.1 + 0.3 * random_unit(random)};
    body->orientation = random_rotation(random);
    body->velocity = random_vector(random, 0.1, 5);
    body->omega = random_vector(random, 0.1, 20);
    body->friction = random_coefficient(random, 1.5);
    body->restitution = random_coefficient(random, 1);
    if (random_unit(random) < 0.2) body->linear_damping = 0.5 * random_unit(random);
    if (random_unit(random) < 0.2) body->angular_damping = 0.5 * random_unit(random);
}

static inline void random_scene_make(unsigned long seed, random_scene *s)
{
    random_stream random = {seed};
    const int count = 1 + (int)(random_unit(&random) * RANDOM_SCENE_BODIES);
    s->def = impact_default_scene_def();
    s->bodies[0] = impact_default_body_def();
    s->bodies[0].name = "floor";
    s->bodies[0].is_static = true;
    impact_shape_plane(INFINITY, INFINITY, &s->bodies[0].shape);
    s->bodies[0].friction = random_coefficient(&random, 1);
    s->bodies[0].restitution = random_coefficient(&random, 1);
    for (int i = 1; i <= count; i++) random_scene_body(&random, s, i);
    s->def.bodies = s->bodies;
    s->def.body_count = count + 1;
    s->def.duration = random_log(&random, 0.2, 1);
    s->def.output_rate = 0;
    s->def.law = random_unit(&random) < 0.7 ? IMPACT_POISSON : IMPACT_STRONGE;
    s->def.friction_rule = (impact_pair_rule)(random_unit(&random) * 4);
    const double kind = random_unit(&random);
    if (kind > 0.4) return;
    s->force = impact_default_force_def(kind < 0.1   ? IMPACT_FORCE_WIND
                                        : kind < 0.2 ? IMPACT_FORCE_ATTRACTION
                                                     : IMPACT_FORCE_CUSTOM);
    s->force.strength = random_log(&random, 0.1, 10);
    s->force.constant = random_log(&random, 1e-4, 1e-2);
    s->force.function = random_scene_pull;
    s->force.context = s;
    s->spring = random_log(&random, 0.1, 100);
    s->def.forces = &s->force;
    s->def.force_count = 1;
}

#endif
