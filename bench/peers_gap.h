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
    int number; /* its place in the list that was loaded */
} gap_case;

/* Answers a case; what the method does not tell is left alone. False: no answer, or a wrong yes or no. */
typedef bool gap_method(const gap_case *c, double setting, double *gap, qvec3 *normal);

/* Which pairs it answers. */
typedef enum gap_pairs { GAP_ALL, GAP_OVERLAPS, GAP_ELLIPSOIDS, GAP_ELLIPSOIDS_APART } gap_pairs;

typedef struct gap_peer {
    const char *name;
    gap_method *method; /* NULL ends the list */
    double setting;
    gap_pairs pairs;
    bool (*load)(const gap_case *cases, int count); /* the pairs in its own types, not timed; NULL: it takes ours */
} gap_peer;

/* Empty where the peer is not installed. */
extern const gap_peer gap_peers_ccd[], gap_peers_fcl[], gap_peers_coal[], gap_peers_mujoco[];

/* libccd's GJK: do the bodies meet? */
bool gap_ccd_meets(const impact_solid *one, const impact_solid *other);

/* FCL's distance of two ellipsoids or spheres that are apart, by its own GJK. */
double gap_fcl_distance(const impact_solid *one, const impact_solid *other, double tolerance);

#ifdef __cplusplus
}
#endif

#endif
