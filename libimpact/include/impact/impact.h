/* SPDX-License-Identifier: MIT
 *
 * All of libimpact's rooms.
 */
#ifndef IMPACT_IMPACT_H
#define IMPACT_IMPACT_H

#include "status.h"
#include "memory.h"
#include "hull.h"
#include "shape.h"
#include "face.h"
#include "gap.h"
#include "patch.h"
#include "toi.h"
#include "collide.h"
#include "together.h"
#include "ode.h"
#include "flight.h"
#include "tumble.h"
#include "force.h"
#include "record.h"
#include "report.h"
#include "scene.h"
#include "run.h"
#include "view.h"

#endif
