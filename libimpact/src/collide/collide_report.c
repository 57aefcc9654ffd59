/* SPDX-License-Identifier: MIT
 *
 * From a finished course to an outcome. The course knows the impulse to rounding of its parts, and the contact's
 * velocity u to eps |u|. Spin about a slim body's axis follows from u, everything else from the impulse P: with
 * M = B' B, B (9 x 3) stacking sqrt(1/m1 + 1/m2) and, of each body, J^-1/2 [r]x in its axes, all in the contact's
 * frame, z = B P are the changes of all velocities weighed by the root of the masses. What rounding of P leaves of u,
 *
 *   delta = (u+ - u-) - B' z,   B Pi = Q R,   y = R^-T Pi' delta,   z <- z + Q y,
 *
 * is given to z by the least change (Gauss). Householder's QR with rows sorted and columns pivoted is stable row by row
 * (Cox & Higham 1998), which bodies of small and large moments need.
 */
#include "collide/collide_report.h"

#include "base/tolerances.h"

enum { ROWS = 9, COLUMNS = 3 };

/* impulse on body 1; spin: the change of both angular velocities, local axes. */
static inline void give(const imp_ready *ready, imp_vec impulse, const imp_vectors *spin, impact_outcome *outcome)
{
    const imp_vectors each = imp_vectors_of(impulse, imp_vec_neg(impulse)), out = imp_ready_world(ready, spin);
    const imp_vectors velocity = imp_vectors_add(&ready->velocity, ready->inverse_mass, &each);
    const imp_vectors before = imp_ready_local(ready, &ready->omega);
    const imp_lanes one = {1, 1};
    const imp_vectors after = imp_vectors_add(&before, one, spin), omega = imp_vectors_add(&ready->omega, one, &out);
    outcome->energy_before = (double)imp_report_energy(ready, &ready->velocity, &before);
    outcome->energy_after = (double)imp_report_energy(ready, &velocity, &after);
    for (int i = 0; i < 2; i++) {
        outcome->velocity[i] = imp_vec_rounded(imp_vectors_at(&velocity, i));
        outcome->omega[i] = imp_vec_rounded(imp_vectors_at(&omega, i));
    }
}

void imp_report_push(const imp_ready *ready, imp_vec impulse, impact_outcome *outcome)
{
    const imp_vectors each = imp_vectors_of(impulse, imp_vec_neg(impulse)), there = imp_ready_local(ready, &each);
    const imp_vectors turn = imp_vectors_cross(&ready->offset, &there);
    const imp_vectors spin = imp_vectors_weigh(&ready->inverse_moments, &turn);
    give(ready, impulse, &spin, outcome);
}

/* ---- what u knows better than P ---- */

static inline imp_vec in_world(const imp_frame *frame, imp_real x, imp_real y, imp_real z)
{
    return imp_vec_axpy(x, frame->t1, imp_vec_axpy(y, frame->t2, imp_vec_scale(frame->n, z)));
}

typedef struct root_of_mass {
    imp_real row[ROWS][COLUMNS];
    int place[ROWS]; /* which row of B stands here */
} root_of_mass;

static inline void set_rows(imp_real row[ROWS][COLUMNS], int column, const imp_vectors *arms, imp_real w)
{
    const imp_lanes arm[3] = {arms->x, arms->y, arms->z};
    for (int k = 0; k < 3; k++) {
        row[k][column] = k == column ? w : 0;
        row[3 + k][column] = arm[k][0];
        row[6 + k][column] = arm[k][1];
    }
}

/* B's columns are t1, t2, n; w: sqrt(1/m1 + 1/m2). */
static void make_root(const imp_ready *ready, const imp_frame *frame, imp_real w, imp_real row[ROWS][COLUMNS])
{
    const imp_levers l = imp_frame_levers(ready);
    const imp_vectors x = imp_frame_arms(&l, frame->t1), y = imp_frame_arms(&l, frame->t2),
                      z = imp_frame_arms(&l, frame->n);
    set_rows(row, 0, &x, w);
    set_rows(row, 1, &y, w);
    set_rows(row, 2, &z, w);
}

static inline imp_real largest_of(const imp_real *row)
{
    return imp_larger(imp_larger(imp_abs(row[0]), imp_abs(row[1])), imp_abs(row[2]));
}

/* The rows of B sorted, the largest first. */
static void sort_rows(imp_real row[ROWS][COLUMNS], root_of_mass *b)
{
    imp_real size[ROWS];
    for (int i = 0; i < ROWS; i++) {
        const imp_real large = largest_of(row[i]);
        int at = i;
        for (; at > 0 && size[at - 1] < large; at--) {
            size[at] = size[at - 1];
            b->place[at] = b->place[at - 1];
        }
        size[at] = large;
        b->place[at] = i;
    }
    for (int i = 0; i < ROWS; i++)
        for (int j = 0; j < COLUMNS; j++) b->row[i][j] = row[b->place[i]][j];
}

static imp_real column_norm2(const root_of_mass *b, int from, int j)
{
    imp_real sum = 0;
    for (int i = from; i < ROWS; i++) sum += b->row[i][j] * b->row[i][j];
    return sum;
}

/* Brings the longest of the columns left to `k`; its length squared. */
static imp_real pivot(root_of_mass *b, int k, int *order)
{
    int best = k;
    imp_real most = column_norm2(b, k, k);
    for (int j = k + 1; j < COLUMNS; j++) {
        const imp_real n2 = column_norm2(b, k, j);
        if (n2 > most) most = n2, best = j;
    }
    if (best == k) return most;
    for (int i = 0; i < ROWS; i++) {
        const imp_real swap = b->row[i][k];
        b->row[i][k] = b->row[i][best];
        b->row[i][best] = swap;
    }
    const int swap = order[k];
    order[k] = order[best];
    order[best] = swap;
    return most;
}

/* Householder in place: R in and above the diagonal but for the diagonal itself, the reflections' vectors in and below
 * it. R's diagonal and 2 / |v|^2 of the reflections are returned. */
static void reflect_all(root_of_mass *b, int *order, imp_real diagonal[COLUMNS], imp_real scale[COLUMNS])
{
    for (int k = 0; k < COLUMNS; k++) {
        const imp_real norm2 = pivot(b, k, order), head = b->row[k][k];
        diagonal[k] = -imp_copysign(imp_sqrt(norm2), head);
        b->row[k][k] = head - diagonal[k];
        scale[k] = norm2 > 0 ? 1 / (norm2 - diagonal[k] * head) : 0;
        for (int j = k + 1; j < COLUMNS; j++) {
            imp_real sum = 0;
            for (int i = k; i < ROWS; i++) sum += b->row[i][k] * b->row[i][j];
            sum *= scale[k];
            for (int i = k; i < ROWS; i++) b->row[i][j] -= sum * b->row[i][k];
        }
    }
}

/* z += Q R^-T Pi' delta, where rounding of the impulse, R's diagonal squared times rough[], is above that of u. */
static void mend(root_of_mass *b, const imp_real *delta, const imp_real *rough, imp_real u, imp_real z[ROWS])
{
    int order[COLUMNS] = {0, 1, 2};
    imp_real diagonal[COLUMNS], scale[COLUMNS], y[ROWS] = {0};
    reflect_all(b, order, diagonal, scale);
    for (int k = 0; k < COLUMNS; k++) {
        if (!(diagonal[k] * diagonal[k] * rough[order[k]] > u)) continue;
        imp_real left = delta[order[k]];
        for (int j = 0; j < k; j++) left -= b->row[j][k] * y[j];
        y[k] = left / diagonal[k];
    }
    for (int k = COLUMNS - 1; k >= 0; k--) {
        imp_real sum = 0;
        for (int i = k; i < ROWS; i++) sum += b->row[i][k] * y[i];
        sum *= scale[k];
        for (int i = k; i < ROWS; i++) y[i] -= sum * b->row[i][k];
    }
    for (int i = 0; i < ROWS; i++) z[b->place[i]] += y[i];
}

/* The course's last velocity less the first, in its frame and units, and the larger of both. */
static imp_real change_of_u(const imp_course *course, imp_real du[3])
{
    const imp_real x = course->ux, y = course->uy, z = course->uz, from_x = course->from_x, from_y = course->from_y;
    du[0] = x - from_x;
    du[1] = y - from_y;
    du[2] = z + 1;
    return imp_sqrt(imp_larger(x * x + y * y + z * z, from_x * from_x + from_y * from_y + 1));
}

static bool ever_sticks(const imp_course *course)
{
    for (int i = 0; i < course->phase_count; i++)
        if (course->phases[i] == IMPACT_STICK_C || course->phases[i] == IMPACT_STICK_R) return true;
    return false;
}

/* P in the course's frame and units gives z, in the same; the velocities after it. A slip's friction rounds with
 * itself, mu p, what sticks with p. */
static void push_to(const imp_ready *ready, const imp_course *course, const imp_real P[3], imp_real speed,
                    impact_outcome *outcome)
{
    const imp_frame *frame = course->frame;
    const imp_real w = imp_sqrt(ready->inverse_mass[0] + ready->inverse_mass[1]);
    imp_real row[ROWS][COLUMNS], z[ROWS], du[3];
    make_root(ready, frame, w, row);
    for (int i = 0; i < ROWS; i++) z[i] = (row[i][0] * P[0] + row[i][1] * P[1] + row[i][2] * P[2]) / frame->scale;
    const imp_real u = change_of_u(course, du);
    for (int i = 0; i < ROWS; i++)
        for (int j = 0; j < COLUMNS; j++) du[j] -= row[i][j] * z[i];
    const imp_real all = imp_sqrt(P[0] * P[0] + P[1] * P[1] + P[2] * P[2]);
    const imp_real rub = all * (ever_sticks(course) ? 1 : imp_smaller(course->mu, 1));
    const imp_real rough[COLUMNS] = {rub / frame->scale, rub / frame->scale, all / frame->scale};
    root_of_mass b;
    sort_rows(row, &b);
    mend(&b, du, rough, u, z);
    const imp_vec impulse = in_world(frame, z[0] / w * speed, z[1] / w * speed, z[2] / w * speed);
    const imp_vectors *j = &ready->inverse_moments;
    const imp_vectors spin = {imp_lanes_sqrt(j->x) * (imp_lanes){z[3], -z[6]} * speed,
                              imp_lanes_sqrt(j->y) * (imp_lanes){z[4], -z[7]} * speed,
                              imp_lanes_sqrt(j->z) * (imp_lanes){z[5], -z[8]} * speed};
    outcome->impulse = imp_vec_rounded(impulse);
    give(ready, impulse, &spin, outcome);
}

/* ---- the outcome ---- */

static void report_phases(const imp_course *course, imp_real unit, impact_outcome *outcome)
{
    outcome->phase_count = course->phase_count;
    for (int i = 0; i < course->phase_count; i++) {
        const imp_real *at = course->reached[i];
        outcome->phases[i] = course->phases[i];
        outcome->phase_impulse[i] = imp_vec_rounded(in_world(course->frame, at[0] * unit, at[1] * unit, at[2] * unit));
    }
}

void imp_report_course(const impact_collision *collision, const imp_ready *ready, const imp_course *course,
                       imp_real speed, impact_outcome *outcome)
{
    const imp_frame *frame = course->frame;
    const imp_real unit = speed / frame->scale, joule = speed * unit;
    imp_real px = course->px, py = course->py;
    /* Friction's direction rounds: the cone is kept to the last bit. */
    const imp_real across2 = px * px + py * py, most = course->mu * course->p;
    if (!collision->friction_law && across2 > most * most) {
        const imp_real f = most / imp_sqrt(across2) * (1 - IMP_EPSILON / 2);
        px *= f;
        py *= f;
    }
    const imp_vec impulse = in_world(frame, px * unit, py * unit, course->p * unit);
    outcome->impulse = imp_vec_rounded(impulse);
    outcome->impulse_normal = (double)(course->p * unit);
    outcome->impulse_tangential = (double)(imp_sqrt(px * px + py * py) * unit);
    outcome->normal_before = (double)-speed;
    outcome->normal_after = (double)(course->uz * speed);
    outcome->compression_impulse = (double)(course->p_c * unit);
    outcome->work_compression = (double)(course->work_c * joule);
    outcome->work_restitution = (double)(course->work_r * joule);
    outcome->work_friction = (double)(course->work_f * joule);
    outcome->compressions = course->compressions;
    outcome->jammed = course->jammed;
    outcome->conditioning = (double)frame->conditioning;
    outcome->energy_rose = course->work_c + course->work_r + course->work_f > -IMP_COLLIDE_ROSE * course->work_c;
    report_phases(course, unit, outcome);
    if (frame->conditioning < IMP_COLLIDE_UNEVEN || outcome->solver == IMPACT_SOLVER_CVODE) {
        imp_report_push(ready, impulse, outcome);
        return;
    }
    const imp_real P[3] = {px, py, course->p};
    push_to(ready, course, P, speed, outcome);
}
