/* SPDX-License-Identifier: MIT
 *
 * gliding: a body that lies with a face on a static one and nothing else holds, and slides or turns there, or stands
 * under forces that may move it later: in closed form (motion/lying_steady.h), or its motion is integrated
 * (motion/face_motion.h). Whether it stands is a question to its face (motion/face_begin.h). A face that slides without
 * turning is held by mu N however its pressure lies; so one that stands under what pulls at its centre is, iff |pull|
 * <= mu P: what friction takes of any twist about the centre of pressure c is at least mu N |u(c)| (Jensen). Internal.
 */
#ifndef IMP_GLIDING_H
#define IMP_GLIDING_H

#include "scene/scene_internal.h"

/* The pairs of the island, whose points that touch are settled, in which a body glides, or stands for now: they lie
 * (IMP_FOOT_FACE), the body brought exactly onto its face. any: whether there are such. A row of contact is written
 * unless it lay before; of what stood before, one of slip. */
impact_status imp_island_lay(imp_island *island, bool lay_before, bool *any);

/* The superquadrics that are held flat on a plane (held_flat.h), and slide or turn there, or stand under forces: what
 * their flat place is of is a face. They lie, and are held no more; where their places end they are to be held again.
 */
impact_status imp_island_glide_on_flats(imp_island *island);
/* The lying pair p, held again where its pressure is, so that it may tip; false: it is one of faces. */
bool imp_island_hold_flat(imp_island *island, int p);

/* The bodies that are held at both ends of a line about which they are round, and slide or turn there, or stand under
 * forces: they lie, held no more; the pairs of both ends stay. */
impact_status imp_island_glide_on_lines(imp_island *island);
/* The lying pair p, held again at its end of a line; false: it is none. */
bool imp_island_hold_line(imp_island *island, int p);
/* What lies on the pair's line has come to its stop: it but rolls. */
void imp_island_stop_on_line(imp_island *island, int p);

/* Whether the one body of an island that goes by steps, which stands by the reactions at its points, does so for now by
 * its face; or does not by its face, which has not been asked yet: it is to lie. One that rests has been, and tips. */
bool imp_island_may_lie(imp_island *island);

/* The pair of the island's one body that moves, if it glides; or NULL. */
imp_pair *imp_island_lying(const imp_island *island);

/* The gliding body's next segment: a closed form, or a step, in motion.dense. What ends it is in island->end. */
impact_status imp_island_glide_on(imp_island *island, imp_segment *segment, bool *closed);

/* Its contact at t, as one at the centre of pressure, where its state is this. False where it has none. */
bool imp_island_glide_force(imp_island *island, double t, const imp_state *states, impact_held *held);

#endif
