/* SPDX-License-Identifier: MIT
 *
 * scene_together: contacts struck at one instant, answered together (impact/together.h). Internal.
 */
#ifndef IMP_SCENE_TOGETHER_H
#define IMP_SCENE_TOGETHER_H

#include "scene/scene_meeting.h"

/* What answers contacts struck together: as the definition says, or by its law of restitution. */
impact_scene_together imp_scene_together_of(const impact_scene_def *def);

typedef enum imp_answer {
    IMP_ANSWER_ALONE,    /* the pair is to be struck by itself */
    IMP_ANSWER_TOGETHER, /* all that touch have answered */
    IMP_ANSWER_NONE      /* it jams, and nothing happens: what touches gives way */
} imp_answer;

/* The pair of the meeting approaches, and others of the island touch: all that touch answer together where the scene
 * has a law for that, and where the impact alone would not be the whole answer, because another pair approaches, before
 * it or then. Or it jams: then whatever touches answers with it, by Moreau's law where the scene has none for many. */
impact_status imp_scene_answer_together(imp_island *island, imp_meeting *struck, imp_answer *by);

/* All that touch answer together what is left of the instant's impacts, without restitution. IMPACT_EUNSETTLED, and the
 * scene's message: no impulses do, as where moving surfaces draw a body in. */
impact_status imp_scene_end_together(imp_island *island);

#endif
