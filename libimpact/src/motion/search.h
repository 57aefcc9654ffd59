/* SPDX-License-Identifier: MIT
 *
 * search: when two bodies next touch, from their segments alone: nothing that other bodies do, and no moment at which
 * the question is asked, changes a bit of the answer. Internal.
 */
#ifndef IMP_SEARCH_H
#define IMP_SEARCH_H

#include <impact/toi.h>
#include "motion/segment.h"

/* Body 1 moves; a plane is body 2. */
typedef struct imp_search {
    const imp_body *body[2];
    const imp_segment *segment[2];
    bool beyond;         /* body 1 is behind a plane, beside its bounds: the search is for its return before it */
    double still;        /* m/s: rates of the gap that only rounding makes: imp_world's slip_speed */
    imp_gaps *gaps;      /* how gaps are asked for; NULL: by Newton */
    impact_usage *usage; /* gap queries are counted there */
    qvec3 *axis;         /* where the pair's last search left its normal, world; 0: nowhere; NULL: not kept. It saves
                            queries, and changes no answer */
    impact_contact *contact; /* the one found, if it was looked at; NULL: not wanted */
} imp_search;

typedef struct imp_found {
    double t;     /* infinite: nothing before one of the segments ends */
    bool touches; /* false: nothing before t, from where the search goes on */
} imp_found;

/* From the time `from`: where both segments have begun, or where an earlier search stopped; stops behind `until`. */
imp_found imp_search_contact(const imp_search *search, double from, double until);

/* The receipt of impact_toi: whether the bodies, of which the first is no plane, touch at the time t > 0 of their
 * motions as the contact says: its gap is 0 to rounding, its own or the time's, and a millionth of their length earlier
 * they do not overlap. It knows nothing of the search: where a step passed the contact, or two roots, it fails. */
bool imp_toi_holds(const impact_solid body[2], const impact_motion motion[2], double t, const impact_contact *contact);

#endif
