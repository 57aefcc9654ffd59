/* SPDX-License-Identifier: MIT
 *
 * What the files of the room surface share. Internal.
 */
#ifndef QUAT_SURFACE_INTERNAL_H
#define QUAT_SURFACE_INTERNAL_H

#include <quat/surface.h>

bool quat_surface_is_good(const quat_surface *surface);

#endif
