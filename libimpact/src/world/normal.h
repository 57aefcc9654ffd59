/* SPDX-License-Identifier: MIT
 *
 * normal: which direction a contact has where several separate two bodies alike: over the seam of boxes laid flush the
 * top and the hidden side of the second, in a slot of its own width a brick's sides and its bottom. The gap is the
 * greatest that a direction separates, and so is its rate among those that attain it (Danskin 1967, theorem 1)
 *
 *     g = max over n of g_n,     g' = max {n . (v1 - v2 at the contact) : g_n = g}
 *
 * The contact's normal is the direction that attains g': the bodies approach iff they do along every one.
 *
 * Sharp edges that lie along each other, of which neither face is flush with one of the other's, touch along a fan of
 * directions between two faces. Rounded by r they touch along the line between their axes, 2r apart, which turns by
 * the mean of what the bodies turn: where g' is that of both faces the contact's normal is the fan's middle, which does
 * too. Edges between flush faces (cubes across from each other in a wall) go along one of these: their normal is one
 * of them.  Internal.
 */
#ifndef IMP_NORMAL_H
#define IMP_NORMAL_H

#include "world/world.h"

/* Takes for the contact's normal the normal of a face of either body along which they approach less fast, or part,
 * among those that separate them by `within` (m) less than touching at the most. The witness points are then where
 * the bodies reach farthest along it, nearest to where they touch. Of a contact that is farther off, or deeper, than
 * `within`, or that does not approach, nothing is asked. */
void imp_settle_normal(const imp_body *body1, const imp_state *state1, const imp_body *body2, const imp_state *state2,
                       double within, impact_contact *contact);

/* The same of a pair among the world's static bodies: no normal that leads from one of them into another. The foot of a
 * wall that stands on a floor has normals from the wall's side to its bottom, and what the floor holds cannot go
 * under the wall: it touches the side. With u the velocity of what touches there, f.u >= 0 for the floor's normal f and
 * n.u >= 0 for one n = a s - b f between the side's s and the bottom's leave s.u >= 0. */
void imp_settle_among(const imp_world *world, const imp_pair *pair, const imp_state *states, double within,
                      impact_contact *contact);

/* Of sharp edges that lie along each other, each at one end of the fan of their normals: a face's normal, whose body
 * (0 or 1) it is. */
typedef struct imp_edges {
    qvec3 normal[2]; /* world, from body 2 to body 1 */
    int owner[2];
} imp_edges;

/* Whether the contact, which is held by a step, is of such edges. Where they stay together they bear in the fan's
 * middle; where they slip they part along one of the two, and bear along that. */
bool imp_edge_normals(const imp_world *world, const imp_pair *pair, const imp_state *states,
                      const impact_contact *contact, imp_edges *edges);

/* The gap where one body stands on a face of the other, near the direction `normal` (from body 2 to body 1): its lowest
 * place, whose foot is within the face, is as far from it as the face's plane parts them, which no gap exceeds and no
 * distance is under. False: it is not so, or they overlap by more than the foot is within, or a nearer way out leads
 * through another face or the side, as from under the base of a cone. Shapes of which one is
 * neither a polytope nor a ball are found so in a hundredth of the time that Newton takes, where the other's place is
 * not unique.
 */
bool imp_face_gap(const imp_body *body1, const imp_state *state1, const imp_body *body2, const imp_state *state2,
                  qvec3 normal, impact_contact *contact);

/* m: how far bodies that are stepped may overlap where they are held. */
double imp_stepped_flush(const imp_body *body1, const imp_body *body2);

#endif
