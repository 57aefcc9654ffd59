/* SPDX-License-Identifier: MIT
 *
 * What bench_together and the engine it is beside share: a line of equal balls that touch, the first of which comes.
 */
#ifndef PEERS_TOGETHER_H
#define PEERS_TOGETHER_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Speeds after all n - 1 contacts are struck at one instant with restitution 1; iterations of the solver's sweeps.
 * False: the engine is not in this build. */
bool bullet_line(int n, int iterations, double *speed, double *seconds);

#ifdef __cplusplus
}
#endif

#endif
