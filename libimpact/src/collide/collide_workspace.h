/* SPDX-License-Identifier: MIT
 *
 * A workspace in somebody else's arena: of a scene. Internal.
 */
#ifndef IMP_COLLIDE_WORKSPACE_H
#define IMP_COLLIDE_WORKSPACE_H

#include <impact/collide.h>
#include "base/ode_in.h"

/* As impact_collide_workspace_create; destroyed by impact_collide_workspace_destroy, before the arena. */
impact_status imp_collide_workspace_in(imp_arena *arena, impact_ode_method method, double tolerance,
                                       impact_collide_workspace **workspace);

#endif
