/* SPDX-License-Identifier: MIT
 *
 * Mixed primal/dual Newton for two witness points: gap_face's steps until they are small.
 */
#include "base/tolerances.h"
#include "gap/gap_face.h"

enum { NEWTON_STEPS = 16, MORE_NEWTON_STEPS = 8 }; /* more when the steps have become small */

/* last: the step that led to s. */
static bool newton(const imp_gap_solids *pair, imp_surface s[2], double last, imp_gap_bracket *meeting)
{
    int settled = 0; /* how often it has: while the bracket is wider than rounding, a few more steps may close it */
    for (int i = 0, end = NEWTON_STEPS; i < end; i++) {
        imp_face face;
        if (!imp_face_look(pair, s, &face)) return settled > 0;
        if (i == NEWTON_STEPS - 1 && last < IMP_GAP_CONVERGING) end += MORE_NEWTON_STEPS;
        if (last < IMP_GAP_LAST_STEP || i == end - 1) {
            imp_gap_bracket now;
            if (imp_face_judge(pair, &face, &now)) {
                if (settled++ == 0 || now.upper - now.lower < meeting->upper - meeting->lower) *meeting = now;
                if (meeting->upper - meeting->lower <= IMP_GAP_TIGHT * pair->reach || settled == 4) return true;
            } else if (i > 0 && imp_face_slide(pair, &face, s)) {
                last = INFINITY;
                continue;
            }
        }
        double step[2][2];
        imp_face_step(pair, &face, step);
        if (!imp_face_advance(pair, &face, step, s, &last)) return settled > 0;
    }
    return settled > 0;
}

bool imp_gap_newton(const imp_gap_solids *pair, const double n[3], const double (*x)[3], imp_gap_bracket *meeting)
{
    imp_surface s[2];
    imp_face_start(pair, n, x, s);
    return newton(pair, s, INFINITY, meeting);
}

bool imp_gap_newton_at(const imp_gap_solids *pair, const imp_surface at[2], imp_gap_bracket *meeting)
{
    imp_surface s[2] = {at[0], at[1]};
    return newton(pair, s, 0, meeting);
}
