/* SPDX-License-Identifier: MIT */
#include "contact/turning.h"

#include <string.h>

static bool is_answer(const imp_cone_outcome *outcome)
{
    return outcome->status == IMP_CONE_SOLVED || outcome->status == IMP_CONE_INEXACT;
}

/* Contact 0 is what is more, 1 the part eps p_n, whose normal feels itself alone: it comes to that and no more. */
static bool restore_turning(const double *w, const double *u, double friction, imp_cone_lengths lengths, double part,
                            imp_cone_workspace *workspace, imp_turning_impact *impact)
{
    double whole[144], q[12], r[12], v[12];
    const double frictions[2] = {friction, friction};
    const imp_cone_lengths both[2] = {lengths, lengths};
    for (int i = 0; i < 12; i++) {
        q[i] = i == 6 ? -w[0] * part : u[i % 6] + w[6 * (i % 6)] * part;
        for (int j = 0; j < 12; j++) {
            const bool apart = i == 6 || j == 6;
            whole[12 * i + j] = !apart ? w[6 * (i % 6) + j % 6] : i == j ? w[0] : 0;
        }
    }
    const imp_cone_problem problem = {.count = 2, .w = whole, .q = q, .friction = frictions, .lengths = both};
    const imp_cone_outcome outcome = imp_cone_solve(&problem, workspace, r, v, NULL);
    if (!is_answer(&outcome)) return false;
    for (int k = 0; k < 6; k++) impact->p[k] += r[k] + (k == 0 ? part : r[6 + k]);
    if (outcome.residual > impact->residual) impact->residual = outcome.residual;
    return true;
}

impact_status imp_turning_collide(const imp_world *world, const imp_state *states, const imp_cone_contact *contact,
                                  double friction, imp_cone_lengths lengths, double restitution,
                                  imp_cone_workspace *workspace, imp_turning_impact *impact)
{
    imp_cone_row rows, turns;
    double w[36], u[6];
    if (!imp_cone_reserve_turning(workspace, 2)) return IMPACT_ENOMEM;
    imp_cone_assemble_turning(world, states, contact, 1, &rows, &turns, w);
    imp_cone_contact_turning(world, states, contact, 1, impact->before);
    const imp_cone_problem problem = {
        .count = 1, .w = w, .q = impact->before, .friction = &friction, .lengths = &lengths};
    const imp_cone_outcome outcome = imp_cone_solve(&problem, workspace, impact->p, u, NULL);
    impact->residual = outcome.residual;
    if (!is_answer(&outcome)) return IMPACT_EUNSETTLED;
    const double part = restitution * impact->p[0];
    if (part > 0 && !restore_turning(w, u, friction, lengths, part, workspace, impact)) return IMPACT_EUNSETTLED;
    for (int i = 0; i < 6; i++) {
        impact->after[i] = impact->before[i];
        for (int j = 0; j < 6; j++) impact->after[i] += w[6 * i + j] * impact->p[j];
    }
    return IMPACT_OK;
}
