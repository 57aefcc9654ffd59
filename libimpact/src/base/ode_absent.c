/* SPDX-License-Identifier: MIT
 *
 * The driver of CVODE in a build without it: nothing is made.
 */
#include "base/ode_driver.h"

const imp_ode_driver imp_ode_cvode = {.bytes = 0};
