/* SPDX-License-Identifier: MIT
 *
 * Boxes of exponents 4 ... 1e4 on a ramp of 0 ... 45 degrees with friction 0 ... 1, set down, slid along the line of
 * greatest slope, or slid across it and turned: one body on an endless plane.
 */
#ifndef RAMP_SCENE_H
#define RAMP_SCENE_H

#include <impact/face.h>
#include <impact/scene.h>
#include "contact_random.h"

enum { RAMP_SET_DOWN, RAMP_SLID, RAMP_TURNED, RAMP_STARTS };

typedef struct ramp_scene {
    int start;
    double exponent, angle, friction, speed; /* speed: down the slope, m/s */
    qvec3 down;
    impact_body_def bodies[2];
    impact_scene_def def;
} ramp_scene;

static inline const char *ramp_start_name(int start)
{
    static const char *const names[] = {"set down", "slid", "slid and turned"};
    return names[start];
}

/* The definition points into the scene: it stays where it is. */
static inline void random_ramp_scene(random_stream *random, int start, ramp_scene *scene)
{
    const double gravity = 9.81, quarter = 0.78539816339744831;
    scene->start = start;
    scene->exponent = random_log(random, 4, 1e4);
    scene->angle = quarter * random_unit(random);
    const double mu = random_unit(random), a = random_log(random, 0.05, 0.2), b = random_log(random, 0.05, 0.2),
                 c = random_log(random, 0.05, 0.2);
    scene->friction = mu < 0.05 ? 0 : mu;
    scene->down = (qvec3){cos(scene->angle), 0, -sin(scene->angle)};
    quat tilt = quat_identity(), turn = quat_identity();
    (void)quat_from_axis_angle((qvec3){0, 1, 0}, scene->angle, &tilt);
    (void)quat_from_axis_angle((qvec3){0, 0, 1}, 8 * quarter * random_unit(random), &turn);
    const qvec3 normal = quat_rotate(tilt, (qvec3){0, 0, 1}), across = qvec3_cross(normal, scene->down);
    scene->bodies[0] = scene->bodies[1] = impact_default_body_def();
    impact_body_def *ramp = &scene->bodies[0], *box = &scene->bodies[1];
    ramp->name = "ramp", box->name = "box";
    ramp->is_static = true;
    ramp->orientation = tilt;
    impact_shape_plane(INFINITY, INFINITY, &ramp->shape);
    impact_shape_superquadric(a, b, c, scene->exponent, scene->exponent, scene->exponent, &box->shape);
    box->mass = 1;
    box->position = qvec3_scale(normal, c);
    (void)quat_normalize(quat_mul(tilt, turn), &box->orientation);
    ramp->friction = 1, box->friction = scene->friction;
    const double along = 2 * random_unit(random) - 1, aside = 2 * random_unit(random) - 1,
                 spin = 10 * (2 * random_unit(random) - 1);
    scene->speed = start == RAMP_SET_DOWN ? 0 : along;
    box->velocity = qvec3_scale(scene->down, scene->speed);
    if (start == RAMP_TURNED) {
        box->velocity = qvec3_axpy(aside, across, box->velocity);
        box->omega = qvec3_scale(normal, spin);
    }
    scene->def = impact_default_scene_def();
    scene->def.gravity = (qvec3){0, 0, -gravity};
    scene->def.bodies = scene->bodies;
    scene->def.body_count = 2;
    scene->def.duration = 2;
    scene->def.output_rate = 0;
}

/* Whether the pressure stays within the flat place (half its height) while friction acts along the slope: the box then
 * neither tips nor rocks. */
static inline bool ramp_stays_flat(const ramp_scene *scene)
{
    const impact_body_def *box = &scene->bodies[1];
    const impact_shape *s = &box->shape;
    const double pull = tan(scene->angle), holds = scene->friction,
                 part = scene->speed != 0 || pull > holds ? holds : pull;
    const qvec3 foot = quat_rotate_inverse(box->orientation, qvec3_scale(scene->down, part * s->c));
    const double rise = pow(fabs(foot.x / s->a), s->r) + pow(fabs(foot.y / s->b), s->s);
    return s->c * rise <= 0.5 * scene->def.rest_height;
}

/* How far down the slope it is after so long, in closed form: it is slowed, turns back or stays, and slides on. */
static inline double ramp_way(const ramp_scene *scene, double time)
{
    const double g = -scene->def.gravity.z, pull = g * sin(scene->angle),
                 hold = scene->friction * g * cos(scene->angle), v = scene->speed;
    const double slows = pull - copysign(hold, v), stops = v != 0 && v * slows < 0 ? -v / slows : INFINITY;
    if (v != 0 && time <= stops) return v * time + 0.5 * slows * time * time;
    const double way = v != 0 ? 0.5 * v * stops : 0, left = v != 0 ? time - stops : time;
    return way + 0.5 * fmax(pull - hold, 0) * left * left;
}

#endif
