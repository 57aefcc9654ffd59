/* SPDX-License-Identifier: MIT */
#include "scene/scene_methods.h"
#include "base/number.h"
#include "base/parts.h"
#include "base/tolerances.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

static double impact_tolerance(const impact_scene_def *def, double tolerance)
{
    const double given = def->methods.impact_tolerance;
    if (given > 0) return given;
    return def->compliance > 0 ? IMP_COLLIDE_CVODE_LEAST
                               : fmax(tolerance, IMP_COLLIDE_CVODE_LEAST); /* impacts are few */
}

impact_methods imp_scene_methods_of(const impact_scene_def *def)
{
    impact_methods m = def->methods;
    if (m.impacts == IMPACT_SOLVER_AUTO) m.impacts = def->solver;
    if (m.tolerance == 0) m.tolerance = def->tolerance;
    m.impact_tolerance = impact_tolerance(def, m.tolerance);
    if (m.gap_tolerance == 0) m.gap_tolerance = IMP_DEFAULT_CCD;
    return m;
}

impact_piles imp_scene_piles_of(const impact_scene_def *def)
{
    const impact_methods *m = &def->methods;
    if (m->motion == IMPACT_MOTION_STEPS) return IMPACT_PILES_STEPS;
    return imp_scene_integrates_all(m) ? IMPACT_PILES_EXACT : def->piles;
}

/* ---- what cannot be ---- */

typedef struct method_check {
    char *why;
    size_t size;
    impact_status status;
} method_check;

/* The first that fails is kept. */
static void want(method_check *c, bool good, impact_status status, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

static void want(method_check *c, bool good, impact_status status, const char *format, ...)
{
    if (good || c->status != IMPACT_OK) return;
    va_list arguments;
    c->status = status;
    va_start(arguments, format);
    vsnprintf(c->why, c->size, format, arguments);
    va_end(arguments);
}

static bool one_of(int value, int last) { return value >= 0 && value <= last; }

static void check_choices(method_check *c, const impact_scene_def *def)
{
    const impact_methods *m = &def->methods;
    want(c, one_of((int)m->motion, IMPACT_MOTION_OTHER), IMPACT_EARGUMENT, "motion = %d in methods is no method",
         (int)m->motion);
    want(c, one_of((int)m->impacts, IMPACT_SOLVER_CVODE), IMPACT_EARGUMENT, "impacts = %d in methods is no solver",
         (int)m->impacts);
    want(c, one_of((int)def->solver, IMPACT_SOLVER_CVODE), IMPACT_EARGUMENT, "solver = %d is no solver",
         (int)def->solver);
    want(c, one_of((int)m->gaps, IMPACT_GAP_CCD), IMPACT_EARGUMENT, "gaps = %d in methods is no method", (int)m->gaps);
}

/* A definition's own number is given where it is not the default. */
static void check_short_names(method_check *c, const impact_scene_def *def)
{
    const impact_methods *m = &def->methods;
    const double own = impact_default_scene_def().tolerance;
    want(c, def->solver == IMPACT_SOLVER_AUTO || m->impacts == IMPACT_SOLVER_AUTO || def->solver == m->impacts,
         IMPACT_EARGUMENT, "solver and impacts in methods are two names of one key, and differ");
    want(c, m->tolerance == 0 || def->tolerance == own || def->tolerance == m->tolerance, IMPACT_EARGUMENT,
         "tolerance = %s, and %s in methods: two names of one key", imp_number_of(def->tolerance).text,
         imp_number_of(m->tolerance).text);
    want(c, m->motion != IMPACT_MOTION_STEPS || def->piles != IMPACT_PILES_EXACT, IMPACT_EARGUMENT,
         "motion = \"steps\" in methods, and piles = \"exact\"");
    want(c, !imp_scene_integrates_all(m) || def->piles != IMPACT_PILES_STEPS, IMPACT_EARGUMENT,
         "piles = \"steps\", and a motion in methods that integrates all");
}

static void check_range(method_check *c, const char *key, double value, double least, double most)
{
    want(c, value == 0 || (value >= least && value <= most), isfinite(value) ? IMPACT_EARGUMENT : IMPACT_EDOMAIN,
         "%s = %s in methods must lie in [%g, %g]", key, imp_number_of(value).text, least, most);
}

static void check_numbers(method_check *c, const impact_scene_def *def)
{
    const impact_methods *m = &def->methods;
    const impact_methods all = imp_scene_methods_of(def);
    const bool rk4 = m->motion == IMPACT_MOTION_RK4, ccd = m->gaps == IMPACT_GAP_CCD;
    check_range(c, "tolerance", m->tolerance, IMP_LEAST_TOLERANCE, IMP_MOST_TOLERANCE);
    check_range(c, "impact_tolerance", m->impact_tolerance, IMP_COLLIDE_CVODE_LEAST, IMP_COLLIDE_CVODE_MOST);
    want(c, m->impact_tolerance == 0 || all.impacts == IMPACT_SOLVER_CVODE || def->compliance > 0, IMPACT_EARGUMENT,
         "impact_tolerance in methods is CVODE's: it needs impacts = \"cvode\", or compliance");
    want(c, m->gap_tolerance == 0 || ccd, IMPACT_EARGUMENT,
         "gap_tolerance in methods is libccd's: it needs gaps = \"ccd\"");
    want(c, m->gap_tolerance == 0 || (m->gap_tolerance >= IMP_LEAST_CCD && m->gap_tolerance <= IMP_MOST_CCD),
         isfinite(m->gap_tolerance) ? IMPACT_EARGUMENT : IMPACT_EDOMAIN,
         "gap_tolerance = %s in methods: libccd cannot give it; %g to %g", imp_number_of(m->gap_tolerance).text,
         IMP_LEAST_CCD, IMP_MOST_CCD);
    want(c, rk4 || m->step == 0, IMPACT_EARGUMENT, "step in methods is that of motion = \"rk4\"");
    want(c, !rk4 || (m->step > 0 && isfinite(m->step)), isfinite(m->step) ? IMPACT_EARGUMENT : IMPACT_EDOMAIN,
         "motion = \"rk4\" in methods needs a step > 0, in s, not %s", imp_number_of(m->step).text);
}

/* Asks for what is named alone: asking loads it. */
static void check_parts(method_check *c, const impact_scene_def *def)
{
    const impact_methods m = imp_scene_methods_of(def);
    const bool integrates = m.motion == IMPACT_MOTION_CVODE || m.motion == IMPACT_MOTION_OTHER;
    want(c, !integrates || impact_has(IMPACT_PART_CVODE), IMPACT_EABSENT,
         "motion = \"%s\" in methods needs CVODE, and " IMP_NO_CVODE,
         m.motion == IMPACT_MOTION_CVODE ? "cvode" : "other");
    want(c, m.gaps != IMPACT_GAP_CCD || impact_has(IMPACT_PART_CCD), IMPACT_EABSENT,
         "gaps = \"ccd\" in methods needs libccd, and " IMP_NO_CCD);
}

impact_status imp_scene_methods_check(const impact_scene_def *def, char *why, size_t size)
{
    method_check c = {why, size, IMPACT_OK};
    check_choices(&c, def);
    check_short_names(&c, def);
    check_numbers(&c, def);
    check_parts(&c, def);
    return c.status;
}
