/* SPDX-License-Identifier: MIT
 *
 * The choice of methods and tolerances: what says nothing in this scene is left out, by the counters of the default.
 */
#include "report/report_work.h"

#include "base/tolerances.h"
#include <math.h>

static impact_methods methods_of(impact_report_method method, double setting)
{
    const double impacts = fmax(setting, 1e-14), gaps = fmin(fmax(setting, IMP_LEAST_CCD), IMP_MOST_CCD);
    switch (method) {
    case IMPACT_REPORT_MOTION: return (impact_methods){.motion = IMPACT_MOTION_CVODE, .tolerance = setting};
    case IMPACT_REPORT_IMPACTS:
        return (impact_methods){.impacts = IMPACT_SOLVER_CVODE, .tolerance = setting, .impact_tolerance = impacts};
    case IMPACT_REPORT_GAPS: return (impact_methods){.gaps = IMPACT_GAP_CCD, .gap_tolerance = gaps};
    case IMPACT_REPORT_TEXTBOOK:
        return (impact_methods){.motion = IMPACT_MOTION_CVODE,
                                .impacts = IMPACT_SOLVER_CVODE,
                                .gaps = impact_has(IMPACT_PART_CCD) ? IMPACT_GAP_CCD : IMPACT_GAP_NEWTON,
                                .tolerance = setting,
                                .impact_tolerance = impacts,
                                .gap_tolerance = impact_has(IMPACT_PART_CCD) ? gaps : 0};
    case IMPACT_REPORT_RK4: return (impact_methods){.motion = IMPACT_MOTION_RK4, .step = setting};
    default: return (impact_methods){.tolerance = setting};
    }
}

static bool add(imp_report_work *w, impact_report_method method, double setting)
{
    imp_report_entry *more = imp_arena_grow(w->report.arena, w->entries, &w->room, w->count + 1, sizeof *more);
    if (!more) return false;
    w->entries = more;
    more[w->count++] = (imp_report_entry){.row = {.method = method, .setting = setting, .status = IMPACT_STOPPED},
                                          .methods = methods_of(method, setting > 0 ? setting : 1e-13)};
    return true;
}

/* What changes nothing in this scene, by the counters of the default, or is not to be had. */
static void find_useless(imp_report_work *w)
{
    const impact_usage *u = &w->reference.usage;
    bool *useless = w->summary->useless;
    const bool cvode = impact_has(IMPACT_PART_CVODE), closed = u->ballistic_flights + u->rolls > 0;
    const long impacts = u->impacts_closed_form + u->impacts_series + u->impacts_cvode;
    useless[IMPACT_REPORT_MOTION] = !cvode || (!closed && u->integrator_steps == 0);
    useless[IMPACT_REPORT_IMPACTS] = !cvode || impacts == 0 || w->report.def.compliance > 0;
    useless[IMPACT_REPORT_GAPS] = !impact_has(IMPACT_PART_CCD) || u->gap_newton + u->gap_gjk + u->gap_fallback == 0;
    useless[IMPACT_REPORT_RK4] = !closed && u->integrator_steps == 0;
    int useful = 0;
    for (int m = IMPACT_REPORT_MOTION; m <= IMPACT_REPORT_GAPS; m++) useful += !useless[m];
    useless[IMPACT_REPORT_TEXTBOOK] = !cvode || useful < 2;
}

static bool add_settings(imp_report_work *w, impact_report_method method)
{
    static const double tolerances[] = {1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14};
    static const double gaps[] = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7}, steps[] = {1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4};
    const impact_report_def *how = w->how;
    const impact_usage *u = &w->reference.usage;
    const double *list = how->tolerances ? how->tolerances : tolerances;
    int count = how->tolerances ? how->tolerance_count : 11;
    double unit = 1;
    if (method == IMPACT_REPORT_DEFAULT && u->integrators == 0 && u->impacts_cvode == 0) return add(w, method, 0);
    if (method == IMPACT_REPORT_GAPS) list = gaps, count = 5;
    if (method == IMPACT_REPORT_RK4) {
        list = how->steps ? how->steps : steps, count = how->steps ? how->step_count : 6;
        unit = how->steps ? 1 : fmin(1, w->report.def.duration);
    }
    for (int k = 0; k < count; k++)
        if (!add(w, method, unit * list[k])) return false;
    return true;
}

bool imp_report_choose_settings(imp_report_work *w)
{
    find_useless(w);
    for (int m = 0; m < IMPACT_REPORT_METHODS; m++)
        if (!w->summary->useless[m] && !w->how->left_out[m] && !add_settings(w, (impact_report_method)m)) return false;
    return true;
}
