/* SPDX-License-Identifier: MIT */
#include <ccd/ccd.h>

#ifndef CCD_DOUBLE
#error "libccd must be built for double"
#endif
