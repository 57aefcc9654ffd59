/* SPDX-License-Identifier: MIT */
#include <impact/scene.h>

#include <stddef.h>
#include <string.h>

#define ENTRY(name)                                                                                                    \
    {                                                                                                                  \
#name, offsetof(impact_usage, name)                                                                            \
    }

static const struct {
    const char *name;
    size_t offset;
} entries[] = {
    ENTRY(ballistic_flights),
    ENTRY(rolls),
    ENTRY(glides),
    ENTRY(integrators),
    ENTRY(integrator_starts),
    ENTRY(integrator_steps),
    ENTRY(integrator_rhs_calls),
    ENTRY(gap_closed_form),
    ENTRY(gap_newton),
    ENTRY(gap_gjk),
    ENTRY(gap_fallback),
    ENTRY(gap_ccd),
    ENTRY(impacts_closed_form),
    ENTRY(impacts_series),
    ENTRY(impacts_cvode),
    ENTRY(impacts_second),
    ENTRY(impacts_soft),
    ENTRY(impacts_gaining),
    ENTRY(impacts_turning),
    ENTRY(impacts_simultaneous),
    ENTRY(lifts_chosen),
    ENTRY(encounters),
    ENTRY(impacts_together),
    ENTRY(reactions_chosen),
    ENTRY(islands_stepped),
    ENTRY(pile_steps),
    ENTRY(samples),
    ENTRY(keys),
    ENTRY(keys_unmet),
};

bool impact_usage_entry(const impact_usage *usage, int number, const char **name, long *value)
{
    if (number < 0 || (size_t)number >= sizeof entries / sizeof *entries) return false;
    *name = entries[number].name;
    memcpy(value, (const char *)usage + entries[number].offset, sizeof *value);
    return true;
}
