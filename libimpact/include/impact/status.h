/* SPDX-License-Identifier: MIT
 *
 * status: how every call of libimpact ends, and what this build holds.
 */
#ifndef IMPACT_STATUS_H
#define IMPACT_STATUS_H

#include <stdbool.h>
#include "export.h"

#ifdef __cplusplus
extern "C" {
#endif

/* 0 is success; positive, success with a reason; negative, failure. One numbering with quat_status: what both have has
 * one number, and no number has two meanings. */
typedef enum impact_status {
    IMPACT_OK = 0,
    IMPACT_STOPPED = 1,     /* the caller asked to stop */
    IMPACT_AT_REST = 2,     /* every body has come to rest */
    IMPACT_EVENT_LIMIT = 3, /* the scene's event limit was reached */
    IMPACT_SEPARATING = 4,  /* the bodies separate: no impact, velocities unchanged */
    IMPACT_SOFT = 5,        /* answered, but do not trust the digits: see the conditioning, or the message */
    IMPACT_BRACKET = 6,     /* not settled to full accuracy; a bracket is given */
    IMPACT_DEEP = 7,        /* deep overlap: one of several local answers */
    IMPACT_NO_CONTACT = 8,  /* no contact within the interval asked for */
    IMPACT_EARGUMENT = -1,  /* a value out of its range: the message names it */
    IMPACT_EDOMAIN = -2,    /* a NaN or infinity where a finite value is needed */
    IMPACT_ENOMEM = -3,
    IMPACT_EABSENT = -4,     /* the part was left out of this build */
    IMPACT_EINTEGRATOR = -6, /* CVODE failed: the message says how */
    IMPACT_EUNSETTLED = -7,  /* no answer within the allowed work */
    IMPACT_ESINK = -8        /* the recorder's sink refused a row */
} impact_status;

/* One short English sentence for a status; never NULL. */
IMPACT_API const char *impact_status_string(impact_status status);

typedef enum impact_part { IMPACT_PART_CVODE, IMPACT_PART_CCD, IMPACT_PART_VIEW } impact_part;

/* Whether the part is to be had: the build holds it, and a static program was linked with it. The shared library loads
 * CVODE or libccd, once, to tell. */
IMPACT_API bool impact_has(impact_part part);

/* The version of these headers, for the preprocessor. */
#define IMPACT_VERSION_MAJOR 0
#define IMPACT_VERSION_MINOR 2
#define IMPACT_VERSION_PATCH 0

/* "MAJOR.MINOR.PATCH" of the library as built. */
IMPACT_API const char *impact_version(void);

#ifdef __cplusplus
}
#endif

#endif
