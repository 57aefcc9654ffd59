/* SPDX-License-Identifier: MIT
 *
 * view: what makes a recorded run visible elsewhere: a page for any browser, glTF for Blender. Without
 * IMPACT_WITH_VIEW both answer IMPACT_EABSENT.
 */
#ifndef IMPACT_VIEW_H
#define IMPACT_VIEW_H

#include "run.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Writes the run as one page of HTML that needs nothing else: no network, no other file (docs/view.md). Where it would
 * be larger than 900 kB its record is thinned: fewer keys, that meet the motion to tolerance, in [1e-7, 0.1], of each
 * body's size and rad; the page says so. IMPACT_EARGUMENT: a tolerance out of range, or a page of more than 20 MB even
 * so, with the tolerance that would do; IMPACT_ESINK; each with a message (may be NULL). quota: what may be written
 * still; NULL: no limit. */
IMPACT_API impact_status impact_view_write(const impact_run *run, double tolerance, const char *path,
                                           impact_quota *quota, char *message, unsigned long message_size);

/* Writes the run as glTF 2.0 in one binary file (.glb), for Blender and others (docs/view.md). Straight lines and
 * slerp between its keys meet the run within tolerance, in [1e-7, 0.1], of each body's size and rad, but where events
 * follow faster than keys may: frame_rate, 1/s in [1, 32767], is that of the scene in Blender (24 as it comes), which
 * takes keys within a hundredth of a frame as one. 0: the first of 24, 240, 2400 and 24000 that holds the run to the
 * tolerance; it stands in the file. Where that is not 24, or does not hold, message (may be NULL; else empty) says so
 * beside IMPACT_OK. IMPACT_EARGUMENT, IMPACT_ESINK, with a message. */
IMPACT_API impact_status impact_gltf_write(const impact_run *run, double tolerance, double frame_rate, const char *path,
                                           impact_quota *quota, char *message, unsigned long message_size);

#ifdef __cplusplus
}
#endif

#endif
