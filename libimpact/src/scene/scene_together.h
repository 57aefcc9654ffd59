/* SPDX-License-Identifier: MIT
 *
 * scene_together: contacts struck at one instant, answered together (impact/together.h). Internal.
 */
#ifndef IMP_SCENE_TOGETHER_H
#define IMP_SCENE_TOGETHER_H

#include "scene/scene_meeting.h"

/* What answers contacts struck together: as the definition says, or by its law of restitution. */
impact_scene_together imp_scene_together_of(const impact_scene_def *def);

/* The pair of the meeting approaches, and others of the island touch: all that touch answer together where the scene
 * has a law for that, and where the impact alone would not be the whole answer, because another pair approaches, before
 * it or then. *answered: whether they have. */
impact_status imp_scene_answer_together(imp_island *island, imp_meeting *struck, bool *answered);

/* The pair jams (scene_drawn.h), and others hold its bodies: all that touch answer its impact without approach, by
 * Moreau's law where the scene has none for many. *answered: whether it was one; what holds may yet give way instead.
 */
impact_status imp_scene_answer_jam(imp_island *island, const imp_meeting *jammed, bool *answered);

/* All that touch answer together what is left of the instant's impacts, without restitution. IMPACT_EUNSETTLED, and the
 * scene's message: no impulses do, as where moving surfaces draw a body in. */
impact_status imp_scene_end_together(imp_island *island);

#endif
