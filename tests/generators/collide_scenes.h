/* SPDX-License-Identifier: MIT
 *
 * The scenes of one impact that other programs are compared on: m = 4 kg, no gravity.
 */
#ifndef COLLIDE_SCENES_H
#define COLLIDE_SCENES_H

#include <impact/collide.h>
#include <quat/rotation.h>

/* S1: a sphere of .3 m on the plane z = 0; sticks: whether it comes to stick (S1b) or slides throughout (S1a). */
static inline impact_collision scene_sphere(bool sticks)
{
    const double j = 0.4 * 4 * 0.3 * 0.3;
    const qvec3 v = sticks ? (qvec3){1, 0.5, -2} : (qvec3){4, 1, -2};
    return (impact_collision){.body = {{4, {j, j, j}, {1, 0, 0, 0}, {0, 0, -0.3}, v, {1, -2, 5}},
                                       {.mass = INFINITY, .orientation = {1, 0, 0, 0}}},
                              .normal = {0, 0, 1},
                              .friction = 0.25,
                              .restitution = 0.3};
}

/* S2: two such spheres, oblique; S2b sticks. */
static inline impact_collision scene_two_spheres(bool sticks)
{
    const double j = 0.4 * 4 * 0.3 * 0.3;
    const qvec3 n = {0.8, 0.36, 0.48};
    const qvec3 w1 = sticks ? (qvec3){0, 4, -2} : (qvec3){0, 12, -9},
                w2 = sticks ? (qvec3){1, -3, 5} : (qvec3){3, 10, -12};
    return (impact_collision){
        .body = {{4, {j, j, j}, {1, 0, 0, 0}, {-0.3 * n.x, -0.3 * n.y, -0.3 * n.z}, {-3, 0, 0}, w1},
                 {4, {j, j, j}, {1, 0, 0, 0}, {0.3 * n.x, 0.3 * n.y, 0.3 * n.z}, {3, 0, 0}, w2}},
        .normal = n,
        .friction = 0.25,
        .restitution = 0.3};
}

/* An ellipsoid of semi-axes (.1, .2, .3) m and 4 kg on the plane z = 0. */
static inline impact_collision scene_ellipsoid_at(quat q, qvec3 v, qvec3 omega)
{
    const qvec3 down = quat_rotate_inverse(q, (qvec3){0, 0, -1}), scaled = {0.1 * down.x, 0.2 * down.y, 0.3 * down.z};
    const double length = sqrt(qvec3_dot(scaled, scaled));
    const qvec3 local = {0.1 * scaled.x / length, 0.2 * scaled.y / length, 0.3 * scaled.z / length};
    const qvec3 j = {0.8 * (0.04 + 0.09), 0.8 * (0.01 + 0.09), 0.8 * (0.01 + 0.04)};
    return (impact_collision){
        .body = {{4, j, q, quat_rotate(q, local), v, omega}, {.mass = INFINITY, .orientation = {1, 0, 0, 0}}},
        .normal = {0, 0, 1},
        .friction = 0.3,
        .restitution = 0.5};
}

/* S5a (which = 0): the slip turns by 97 degrees; S5b (1): slides, then sticks. */
static inline impact_collision scene_ellipsoid(int which)
{
    const double angle = which == 0 ? 0.7 : 0.6, h = sin(angle / 2);
    const qvec3 axis = which == 0 ? (qvec3){1 / sqrt(2), 1 / sqrt(2), 0} : (qvec3){2 / sqrt(5), 1 / sqrt(5), 0};
    const quat q = {cos(angle / 2), h * axis.x, h * axis.y, h * axis.z};
    return which == 0 ? scene_ellipsoid_at(q, (qvec3){0.4, -1, -3}, (qvec3){-2, 3, 1})
                      : scene_ellipsoid_at(q, (qvec3){1, -0.7, -3}, (qvec3){3, 2, -1});
}

#endif
