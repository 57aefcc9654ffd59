/* SPDX-License-Identifier: MIT
 *
 * coarser: the same scene once more, gone on from where its bodies first moved by steps, by steps that may err ten
 * times as much. A step's own error says nothing of what the motion makes of it; how far two motions are apart that err
 * differently does: of the second order and where contacts begin within a step alike, the scene errs by less than that.
 * Internal.
 */
#ifndef IMP_COARSER_H
#define IMP_COARSER_H

#include "scene/scene_internal.h"

/* What the scene does before its next slot, due at t: begins the other, where steps have begun, or follows it, where
 * that is due. IMPACT_ENOMEM. */
impact_status imp_coarser_attend(impact_scene *scene, double t);
/* How far the other is from the scene at its time, whose states were looked at. IMPACT_ENOMEM. */
impact_status imp_coarser_follow(impact_scene *scene);
/* From its time on the scene's motion is one of several that its steps cannot tell apart. */
void imp_coarser_parts(impact_scene *scene);
/* The other was changed as the scene was; one that could not be has parted from it. */
void imp_coarser_changed(impact_scene *scene, impact_status change);
/* Without the other; what was told stays told. */
void imp_coarser_end(impact_scene *scene);

#endif
