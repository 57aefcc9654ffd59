/* SPDX-License-Identifier: MIT
 *
 * Boxes, cylinders and polyhedra on each other and in boxes: three to five bodies of random kinds, sizes, frictions and
 * restitutions, set on one another, dropped on one another, or dropped into a box without a lid.
 */
#ifndef PILE_SCENE_H
#define PILE_SCENE_H

#include <stdio.h>
#include <impact/scene.h>
#include "kit/solid_random.h"

enum { PILE_SET, PILE_DROPPED, PILE_IN_BOX, PILE_STARTS };
enum { PILE_MOST = 5, PILE_WALLS = 4, PILE_BODIES = 1 + PILE_WALLS + PILE_MOST };

typedef struct pile_scene {
    int start;
    impact_body_def bodies[PILE_BODIES];
    char names[PILE_BODIES][16];
    impact_hull *hulls[PILE_MOST];
    int hull_count;
    impact_scene_def def;
} pile_scene;

static inline const char *pile_start_name(int start)
{
    static const char *const names[] = {"set on each other", "dropped on each other", "dropped into a box"};
    return names[start];
}

static inline impact_body_def *pile_add(pile_scene *scene, const char *what)
{
    const int i = scene->def.body_count++;
    impact_body_def *body = &scene->bodies[i];
    *body = impact_default_body_def();
    snprintf(scene->names[i], sizeof scene->names[i], "%s %d", what, i);
    body->name = scene->names[i];
    return body;
}

/* Its faces are the floor's at 0 and the walls', `half` from the middle. */
static inline void pile_add_ground(pile_scene *scene, double half)
{
    impact_body_def *floor = pile_add(scene, "floor");
    floor->is_static = true;
    floor->friction = floor->restitution = 1;
    impact_shape_plane(INFINITY, INFINITY, &floor->shape);
    for (int k = 0; scene->start == PILE_IN_BOX && k < PILE_WALLS; k++) {
        const double away = (k % 2 ? -1 : 1) * (half + 0.05);
        impact_body_def *wall = pile_add(scene, "wall");
        wall->is_static = true;
        wall->friction = wall->restitution = 1;
        wall->position = (qvec3){k < 2 ? away : 0, k < 2 ? 0 : away, 0.2};
        impact_shape_box(k < 2 ? 0.05 : half + 0.1, k < 2 ? half + 0.1 : 0.05, 0.2, 0, &wall->shape);
    }
}

/* A polyhedron of points in a cube of half side `reach`, or on a lattice of it; one too large for the box is drawn
 * again. */
static inline impact_hull *pile_hull(random_stream *random, double reach)
{
    impact_hull *hull = NULL;
    impact_shape shape;
    while (!hull || (impact_shape_polyhedron(hull, &shape), impact_shape_bounding_radius(&shape) > 0.16)) {
        impact_hull_destroy(hull);
        hull = NULL;
        qvec3 points[12];
        const int family = (int)(4 * random_unit(random)), count = 4 + (int)(9 * random_unit(random));
        for (int i = 0; i < count; i++) points[i] = qvec3_scale(random_point(random, family), reach);
        impact_hull_create(points, (size_t)count, 0, NULL, &hull, NULL, 0);
    }
    return hull;
}

/* The shape, and an orientation in which it stands on a face. */
static inline void pile_take_shape(random_stream *random, pile_scene *scene, impact_body_def *body)
{
    const double a = 0.03 + 0.05 * random_unit(random), b = 0.03 + 0.05 * random_unit(random),
                 c = 0.03 + 0.05 * random_unit(random), turn = 6.283185307179586 * random_unit(random);
    const int kind = (int)(3 * random_unit(random));
    qvec3 down = {0, 0, -1};
    if (kind == 0) {
        impact_shape_box(a, b, c, 0, &body->shape);
    } else if (kind == 1) {
        impact_shape_cylinder(a, c, 0, &body->shape);
    } else {
        impact_hull *hull = scene->hulls[scene->hull_count++] = pile_hull(random, a);
        const int faces = impact_hull_describe(hull).faces;
        int vertex[IMPACT_HULL_POINTS];
        impact_hull_face(hull, (int)(faces * random_unit(random)), vertex, &down);
        impact_shape_polyhedron(hull, &body->shape);
    }
    quat level = quat_identity(), about = quat_identity();
    (void)quat_from_two_vectors(down, (qvec3){0, 0, -1}, &level);
    (void)quat_from_axis_angle((qvec3){0, 0, 1}, turn, &about);
    (void)quat_normalize(quat_mul(about, level), &body->orientation);
}

static inline double pile_reach(const impact_body_def *body, double up)
{
    qvec3 x;
    impact_shape_support(&body->shape, quat_rotate_inverse(body->orientation, (qvec3){0, 0, up}), &x);
    return quat_rotate(body->orientation, x).z;
}

/* Its lowest point `above` over what is highest so far, which is then its own. */
static inline void pile_add_body(random_stream *random, pile_scene *scene, double aside, double *top)
{
    impact_body_def *body = pile_add(scene, "body");
    pile_take_shape(random, scene, body);
    body->density = 1000;
    body->friction = random_unit(random) < 0.1 ? 0 : 0.1 + 0.9 * random_unit(random);
    body->restitution = random_unit(random) < 0.2 ? 0 : 0.7 * random_unit(random);
    body->position = (qvec3){aside * (2 * random_unit(random) - 1), aside * (2 * random_unit(random) - 1), 0};
    if (scene->start != PILE_SET) {
        body->orientation = random_rotation(random);
        body->velocity = random_vector(random, 0.05, 1);
        body->omega = random_vector(random, 0.1, 10);
        *top += 0.01 + 0.05 * random_unit(random);
    }
    body->position.z = *top - pile_reach(body, -1);
    *top += pile_reach(body, 1) - pile_reach(body, -1);
}

/* The definition points into the scene: it stays where it is. To be given back by pile_scene_end. */
static inline void random_pile_scene(uint64_t seed, int start, pile_scene *scene)
{
    random_stream random = {seed};
    *scene = (pile_scene){.start = start, .def = impact_default_scene_def()};
    pile_add_ground(scene, 0.2);
    double top = 0;
    const int count = 3 + (int)((PILE_MOST - 2) * random_unit(&random));
    for (int i = 0; i < count; i++) pile_add_body(&random, scene, start == PILE_SET ? 0.02 : 0.04, &top);
    scene->def.bodies = scene->bodies;
    scene->def.friction_rule = scene->def.restitution_rule = IMPACT_MINIMUM;
    scene->def.duration = 2;
    scene->def.output_rate = 0;
}

static inline void pile_scene_end(pile_scene *scene)
{
    for (int i = 0; i < scene->hull_count; i++) impact_hull_destroy(scene->hulls[i]);
    scene->hull_count = 0;
}

/* m: how far any two bodies overlap, of which one moves; 0: none do. */
static inline double pile_overlap(const pile_scene *scene, const impact_scene *running)
{
    impact_solid solid[PILE_BODIES];
    double most = 0;
    for (int i = 0; i < scene->def.body_count; i++) {
        impact_sample s;
        impact_scene_body(running, i, &s);
        solid[i] = (impact_solid){scene->bodies[i].shape, s.position, s.orientation};
    }
    for (int j = 1; j < scene->def.body_count; j++)
        for (int i = 0; i < j; i++) {
            impact_contact contact;
            if (scene->bodies[j].is_static) continue;
            if (impact_gap(&solid[j], &solid[i], NULL, &contact) >= 0) most = fmax(most, -contact.gap);
        }
    return most;
}

#endif
