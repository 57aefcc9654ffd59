/* SPDX-License-Identifier: MIT
 *
 * What the files of the surface share, in libquat and in quat_gsl. Internal.
 */
#ifndef QUAT_SURFACE_INTERNAL_H
#define QUAT_SURFACE_INTERNAL_H

#include <quat/surface.h>

static inline bool quat_surface_is_good(const quat_surface *s)
{
    return s && s->at && isfinite(s->u1 - s->u0) && isfinite(s->v1 - s->v0) && s->u0 < s->u1 && s->v0 < s->v1 &&
           s->known >= 0 && s->known <= 2;
}

#endif
