/* SPDX-License-Identifier: MIT
 *
 * Where contacts determine each other, impulses p that leave the bodies' velocities are not unique. Those of least norm
 * are,
 *
 *     least sum |p_c|^2:   G^T p given,   p_c in the face of K on which p_c . (u + mu |u_t| n) = 0
 *
 * as the problem is strictly convex: contacts that give way alike share so, however little they give (Tikhonov). The
 * face is all of K where a contact sticks, the ray n - mu u_t/|u_t| where it slides, nothing where it opens. A ray is a
 * cone without friction, along a row of G of its own, so that rest.h finds them.
 */
#include "contact/encounter.h"

#include <string.h>

/* Along the ray against the tangents' direction (across), or with it: sign 1; unit. */
static void find_line(double mu, const double *across, double sign, double line[3])
{
    const double size = hypot(across[1], across[2]), part = 1 / sqrt(1 + mu * mu);
    line[0] = part;
    for (int k = 1; k < 3; k++) line[k] = mu > 0 ? sign * part * mu * across[k] / size : 0;
}

/* How far the impulse lies off the line. */
static double distance_to(const double line[3], const double *p)
{
    double along = 0, off = 0;
    for (int k = 0; k < 3; k++) along += line[k] * p[k];
    for (int k = 0; k < 3; k++) off = hypot(off, p[k] - along * line[k]);
    return off;
}

/* The face that a contact's velocity leaves; line: a ray's. Under `still` a velocity is rounding; over it, too, where
 * the impulse lies farther off that face, as a part of the greatest, than the velocity is of the fastest: of the two
 * one is zero. The ray of what slides is told by the one of its slip and its friction that is so the greater: a slow
 * slip's rounding would turn a great impulse off what it leaves. */
static imp_cone_mode find_face(const imp_contact *contact, const imp_share_question *question, const double *u,
                               const double *p, double most, double line[3])
{
    const double slip = hypot(u[1], u[2]), mu = contact->friction, unit = question->speed / most;
    if (u[0] > fmax(question->still, p[0] * unit)) return IMP_CONE_OPEN;
    if (mu > 0 && slip <= question->still) return IMP_CONE_STICKS;
    find_line(mu, u, -1, line);
    if (mu > 0 && slip <= distance_to(line, p) * unit) return IMP_CONE_STICKS;
    const double friction = hypot(p[1], p[2]);
    if (mu > 0 && friction * unit > slip) find_line(mu, p, 1, line);
    return IMP_CONE_SLIDES;
}

/* The row of G along the line, alone. */
static void set_line(const imp_contact *contact, const double line[3], imp_cone_row *row)
{
    for (int side = 0; side < 2; side++)
        for (int l = 0; l < 6; l++)
            for (int k = 0; k < 3; k++) row->side[side][0][l] += line[k] * contact->row[side][k][l];
}

typedef struct shares {
    imp_cone_row *rows;
    double *friction, *forces, (*lines)[3];
    imp_cone_mode *faces;
} shares;

static bool find_shares(const imp_group *g, const shares *s, const imp_share_question *question,
                        impact_together_workspace *workspace)
{
    const imp_rest_question rest = {g->count, question->bodies, question->couples, s->rows, s->friction};
    double most = 0;
    for (int i = 0; i < 3 * g->count; i++) most = fmax(most, fabs(g->p[i]));
    if (!(most > 0)) return false;
    for (int i = 0; i < g->count; i++) {
        const imp_contact *contact = &g->contacts[i];
        const double *own = &g->p[3 * i];
        s->faces[i] = find_face(contact, question, &question->u[3 * i], own, most, s->lines[i]);
        if (s->faces[i] == IMP_CONE_STICKS) {
            memcpy(s->rows[i].side, contact->row, sizeof contact->row);
            memcpy(&s->forces[3 * i], own, 3 * sizeof *own);
            s->friction[i] = contact->friction;
        } else if (s->faces[i] == IMP_CONE_SLIDES) {
            set_line(contact, s->lines[i], &s->rows[i]);
            for (int k = 0; k < 3; k++) s->forces[3 * i] += s->lines[i][k] * own[k];
        }
    }
    return imp_rest_reserve(&workspace->rest, g->count, question->bodies) &&
           imp_rest_find_least(&rest, &workspace->rest, s->forces);
}

bool imp_encounter_share(const imp_group *g, const imp_share_question *question, imp_cone_mode *modes,
                         impact_together_workspace *workspace)
{
    const size_t n = (size_t)g->count, used = workspace->work.used;
    shares s;
    s.rows = imp_encounter_take(workspace, n, sizeof *s.rows);
    s.friction = imp_encounter_take(workspace, n, sizeof *s.friction);
    s.forces = imp_encounter_take(workspace, 3 * n, sizeof *s.forces);
    s.lines = imp_encounter_take(workspace, n, sizeof *s.lines);
    s.faces = imp_encounter_take(workspace, n, sizeof *s.faces);
    const bool found = s.faces && find_shares(g, &s, question, workspace);
    for (int i = 0; found && i < g->count; i++) {
        const bool slides = s.faces[i] == IMP_CONE_SLIDES;
        modes[i] = s.faces[i];
        for (int k = 0; k < 3; k++) g->p[3 * i + k] = slides ? s.forces[3 * i] * s.lines[i][k] : s.forces[3 * i + k];
    }
    workspace->work.used = used;
    return found;
}
