/* SPDX-License-Identifier: MIT
 *
 * The gap by libccd alone. Of the difference D = c + B - A inflated by a ball of radius rho > g the origin is inside,
 * at the depth rho - g, whether D holds it (g < 0) or not. rho comes from the centres' distance, which is no less than
 * g, then from the first answer: the thinner the ball, the fewer facets EPA needs of it.
 */
#include "base/parts.h"
#include "base/tolerances.h"
#include "gap/gap_solver.h"

bool imp_gap_harvest(const imp_gap_solids *pair, double n[3])
{
    const imp_gap_ccd *ccd = imp_ccd();
    return ccd && ccd->harvest(pair, n);
}

bool imp_gap_epa(const imp_gap_solids *pair, double rho, const double first[3], double tolerance, double *depth,
                 double n[3])
{
    const imp_gap_ccd *ccd = imp_ccd();
    return ccd && ccd->epa(pair, rho, first, tolerance, depth, n);
}

typedef struct ccd_answer {
    double gap, n[3], x[2][3]; /* x: as imp_gap_bracket */
} ccd_answer;

/* g = rho - depth, as it comes; true where it is, to IMP_CCD_CHECK tolerances, the gap g(n) along its own normal. */
static bool ask(const imp_gap_solids *pair, double rho, const double first[3], double tolerance, ccd_answer *answer)
{
    double depth;
    if (!imp_gap_epa(pair, rho, first, tolerance, &depth, answer->n)) return false;
    answer->gap = rho - depth;
    const double along = imp_pair_gap(pair, answer->n, answer->x);
    return fabs(answer->gap - along) <= IMP_CCD_CHECK * tolerance;
}

/* A thick ball first, then a thin one about what it found. A first simplex that is flat, or has the origin on its
 * boundary, ends EPA at once: where the check fails, other directions to begin with and other balls. */
static bool ask_in_turn(const imp_gap_solids *pair, double tolerance, ccd_answer *answer)
{
    static const double thickness[] = {1 / 20., 1 / 10., 1 / 5., 1 / 2., 1, 2}; /* of the size */
    static const double first[][3] = {{.48, .64, .6}, {-.64, .6, .48}, {.6, -.48, .64}, {-.48, -.6, -.64}};
    enum { BALLS = sizeof thickness / sizeof *thickness, WAYS = sizeof first / sizeof *first };
    const double apart = sqrt(pair->c[0] * pair->c[0] + pair->c[1] * pair->c[1] + pair->c[2] * pair->c[2]);
    double guess = apart;
    for (int k = 0; k < WAYS && guess == apart; k++)
        if (ask(pair, apart + pair->size * thickness[0], first[k], tolerance, answer)) guess = fmax(answer->gap, 0);
    for (int k = 0; k < BALLS * WAYS; k++)
        if (ask(pair, guess + pair->size * thickness[k / WAYS], first[k % WAYS], tolerance, answer)) return true;
    return false;
}

impact_status imp_gap_by_ccd(const impact_solid *body1, quat q1, const impact_solid *body2, quat q2, double tolerance,
                             impact_contact *contact)
{
    if (!impact_has(IMPACT_PART_CCD)) return IMPACT_EABSENT;
    const double scale = imp_gap_scale(body1, body2);
    imp_gap_solids pair;
    ccd_answer answer = {.gap = NAN, .n = {NAN, NAN, NAN}};
    imp_gap_pair(body1, q1, body2, q2, scale, &pair);
    const bool good = ask_in_turn(&pair, tolerance * pair.size, &answer);
    imp_gap_bracket meeting = {.gap = answer.gap, .lower = answer.gap, .upper = answer.gap, .stiffness = NAN};
    for (int i = 0; i < 3; i++) {
        meeting.n[i] = answer.n[i];
        meeting.x[0][i] = answer.x[0][i], meeting.x[1][i] = answer.x[1][i];
    }
    imp_gap_contact(body1, body2, scale, &meeting, IMPACT_PATH_CCD, contact);
    return good ? IMPACT_OK : IMPACT_EUNSETTLED;
}
