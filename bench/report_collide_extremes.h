/* SPDX-License-Identifier: MIT
 *
 * report_collide, inside: impacts at the limits of what is admitted.
 */
#ifndef REPORT_COLLIDE_EXTREMES_H
#define REPORT_COLLIDE_EXTREMES_H

#include <stdint.h>

/* Solves each[k] impacts of the class CASE_CLASSES + k on so many threads and prints a table and a line of words.
 * Returns how many broke a promise: not finite, or energy risen, or a receipt that fails, with IMPACT_OK. */
long report_extremes(const long each[3], uint64_t seed, int threads);

#endif
