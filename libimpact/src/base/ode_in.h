/* SPDX-License-Identifier: MIT
 *
 * An integrator in somebody else's arena: of a scene, or of a workspace. Internal.
 */
#ifndef IMP_ODE_IN_H
#define IMP_ODE_IN_H

#include <impact/ode.h>
#include "base/arena.h"

/* As impact_ode_create, without its allocator; destroyed by impact_ode_destroy, before the arena. */
impact_status imp_ode_create_in(imp_arena *arena, const impact_ode_def *def, impact_ode **ode);

#endif
