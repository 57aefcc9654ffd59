/* SPDX-License-Identifier: MIT */
#include <impact/status.h>
#include "base/parts.h"
#include <stddef.h>

const char *impact_status_string(impact_status status)
{
    switch (status) {
    case IMPACT_OK: return "ok";
    case IMPACT_STOPPED: return "stopped by the caller";
    case IMPACT_AT_REST: return "every body is at rest";
    case IMPACT_EVENT_LIMIT: return "event limit reached";
    case IMPACT_SEPARATING: return "the bodies separate: nothing happens";
    case IMPACT_SOFT: return "answered, but not to be trusted to the last digits";
    case IMPACT_BRACKET: return "not settled to full accuracy; a bracket is given";
    case IMPACT_DEEP: return "deep overlap: one of several local answers";
    case IMPACT_NO_CONTACT: return "no contact within the interval";
    case IMPACT_EARGUMENT: return "argument out of range";
    case IMPACT_EDOMAIN: return "NaN or infinity where a finite value is needed";
    case IMPACT_ENOMEM: return "out of memory";
    case IMPACT_EABSENT: return "this part was left out of the build";
    case IMPACT_EINTEGRATOR: return "the integrator failed";
    case IMPACT_EUNSETTLED: return "no answer within the allowed work";
    case IMPACT_ESINK: return "the recorder refused a row";
    }
    return "unknown status";
}

bool impact_has(impact_part part)
{
    switch (part) {
    case IMPACT_PART_CVODE: return imp_cvode() != NULL;
    case IMPACT_PART_VIEW:
#ifdef IMPACT_WITH_VIEW
        return true;
#else
        return false;
#endif
    case IMPACT_PART_CCD: return imp_ccd() != NULL;
    }
    return false;
}

const char *impact_version(void) { return IMPACT_VERSION; }
