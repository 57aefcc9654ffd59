/* SPDX-License-Identifier: MIT
 *
 * What bench_gap and its peers share.
 */
#ifndef PEERS_GAP_H
#define PEERS_GAP_H

#include <impact/gap.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct gap_case {
    impact_solid body[2];
    double gap, reach; /* the truth; L + |c| */
    qvec3 normal;      /* the truth, body 2 to body 1 */
    impact_gap_cache cache;
} gap_case;

/* Answers a case; what the method does not tell is left alone. False: no answer, or a wrong yes or no. */
typedef bool gap_method(const gap_case *c, double setting, double *gap, qvec3 *normal);

typedef struct gap_peer {
    const char *name;
    gap_method *method; /* NULL ends the list */
    double setting;
    bool overlap_only, separated_ellipsoids_only;
} gap_peer;

/* Empty where the peer is not installed. */
extern const gap_peer gap_peers_ccd[], gap_peers_fcl[];

#ifdef __cplusplus
}
#endif

#endif
