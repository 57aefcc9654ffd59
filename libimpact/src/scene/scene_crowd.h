/* SPDX-License-Identifier: MIT
 *
 * scene_crowd: a scene of many bodies, divided for short whiles into groups that cannot meet (crowd.h), each moved on
 * as a small scene of its own. Internal.
 */
#ifndef IMP_SCENE_CROWD_H
#define IMP_SCENE_CROWD_H

#include "scene/scene_internal.h"

/* Gives a scene of many bodies, without forces between them, its crowd. */
impact_status imp_scene_crowd_open(impact_scene *scene);
void imp_scene_crowd_close(impact_scene *scene);

/* Before a run: what the recorder did not take of the last one; then, with the scene settled, where it stands. */
impact_status imp_scene_crowd_deliver(impact_scene *scene);
void imp_scene_crowd_begin(impact_scene *scene);

/* Moves the scene on by one while, at most to t_end. */
impact_status imp_scene_crowd_advance(impact_scene *scene, double t_end);

#endif
