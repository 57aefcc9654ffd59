/* SPDX-License-Identifier: MIT
 *
 * Cheapest first: the modes of last time, where semismooth Newton on F(z, 0) takes one linear system; then the central
 * path; then, of what neither solves, whether a direction excludes a solution. What is accepted is proved from the
 * problem's own numbers, by none of the formulas that found it.
 */
#include "base/numbers.h"
#include "base/tolerances.h"
#include "contact/cone_map.h"
#include "contact/cone_order.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* ---- room ---- */

enum { SQUARES = 3, VECTORS = 16, INDICES = 6, UNKNOWNS_MOST = 7 };

/* Every contact is two lobes at most. */
static bool reserve_unknowns(imp_cone_workspace *workspace, int contacts, int unknowns)
{
    if (contacts <= workspace->capacity && unknowns <= workspace->unknowns) return true;
    imp_cone_release(workspace);
    const size_t n = (size_t)unknowns;
    workspace->block = imp_arena_take_unset(workspace->arena, SQUARES * n * n + VECTORS * n, sizeof *workspace->block);
    workspace->keys = imp_arena_take(workspace->arena, (size_t)contacts, sizeof *workspace->keys);
    workspace->indices = imp_arena_take(workspace->arena, INDICES * n + 1, sizeof *workspace->indices);
    if (workspace->block && workspace->keys && workspace->indices) {
        workspace->capacity = contacts;
        workspace->unknowns = unknowns;
        return true;
    }
    imp_cone_release(workspace);
    return false;
}

bool imp_cone_reserve(imp_cone_workspace *workspace, int contacts)
{
    return reserve_unknowns(workspace, contacts, 3 * contacts);
}

bool imp_cone_reserve_turning(imp_cone_workspace *workspace, int contacts)
{
    return reserve_unknowns(workspace, contacts, UNKNOWNS_MOST * contacts);
}

void imp_cone_release(imp_cone_workspace *workspace)
{
    imp_arena_give(workspace->arena, workspace->block);
    imp_arena_give(workspace->arena, workspace->keys);
    imp_arena_give(workspace->arena, workspace->indices);
    *workspace = (imp_cone_workspace){.arena = workspace->arena};
}

/* The next part of a block, which moves on. */
static double *next_part(double **block, size_t length)
{
    double *part = *block;
    *block += length;
    return part;
}

static imp_cone_system lay_out(const imp_cone_problem *problem, imp_cone_workspace *workspace)
{
    const size_t n = (size_t)(problem->lengths ? UNKNOWNS_MOST : 3) * (size_t)problem->count;
    double *block = workspace->block;
    imp_cone_system s = {.problem = problem};
    s.a = next_part(&block, n * n), s.matrix = next_part(&block, n * n), s.spare = next_part(&block, n * n);
    double **vectors[VECTORS] = {&s.scale, &s.b, &s.r, &s.own,  &s.scratch, &s.z,       &s.trial, &s.step,
                                 &s.value, &s.x, &s.u, &s.rate, &s.kept,    &s.tangent, &s.best,  &s.lift};
    for (int k = 0; k < VECTORS; k++) *vectors[k] = next_part(&block, n);
    int **indices[] = {&s.rows, &s.columns, &s.row, &s.order, &s.tied, &s.start};
    for (int k = 0; k < INDICES; k++) *indices[k] = workspace->indices + (size_t)k * n;
    return s;
}

/* ---- the problem ---- */

static void find_scales(imp_cone_system *system)
{
    const imp_cone_problem *problem = system->problem;
    const int width = imp_cone_width(problem);
    const size_t n = (size_t)(width * problem->count);
    double trace = 0;
    int parts = 0;
    for (int c = 0; c < problem->count; c++) /* in the chosen order: the same sum whatever the numbering */
        for (int k = 0; k < imp_cone_dimension(problem, system->order[c]); k++, parts++) {
            const size_t i = (size_t)(width * system->order[c] + k);
            trace += problem->w[i * n + i];
        }
    const double size = imp_cone_largest(problem, problem->q, true);
    system->d = trace > 0 ? trace / parts : 1;
    system->size = size > 0 ? size : 1;
}

static void add_unknown(imp_cone_system *system, int row, double scale)
{
    system->row[system->n] = row;
    system->scale[system->n++] = scale;
}

static void begin_lobe(imp_cone_system *system, int row, bool tied)
{
    system->tied[system->count] = tied;
    system->start[system->count++] = system->n;
    add_unknown(system, row, 1);
}

static void find_order(imp_cone_system *system, imp_cone_workspace *workspace)
{
    const imp_cone_problem *problem = system->problem;
    imp_cone_choose_order(problem, workspace->keys, system->order);
    for (int c = 0; c < problem->count; c++) {
        const int from = system->order[c], first = imp_cone_width(problem) * from;
        const imp_cone_lengths lengths = problem->lengths ? problem->lengths[from] : (imp_cone_lengths){0, 0};
        const double friction = problem->friction[from];
        begin_lobe(system, first, false);
        for (int k = 1; friction > 0 && k < 3; k++) add_unknown(system, first + k, friction);
        if (lengths.torsional > 0) add_unknown(system, first + 3, lengths.torsional);
        if (!(lengths.rolling > 0)) continue;
        if (friction > 0 || lengths.torsional > 0) begin_lobe(system, first, true);
        for (int k = 4; k < 6; k++) add_unknown(system, first + k, lengths.rolling);
    }
    system->start[system->count] = system->n;
}

/* Of tied lobes both normals are half the contact's, and the second's row is their tie, x2_n - x1_n. */
static void tie_lobes(imp_cone_system *system)
{
    const size_t n = (size_t)system->n;
    for (int c = 0; c < system->count; c++) {
        const size_t first = (size_t)system->start[c > 0 ? c - 1 : 0], second = (size_t)system->start[c];
        if (!system->tied[c]) continue;
        for (size_t i = 0; i < n; i++) {
            system->a[i * n + first] *= 0.5;
            system->a[i * n + second] *= 0.5;
        }
    }
    for (int c = 0; c < system->count; c++) {
        const size_t second = (size_t)system->start[c];
        if (!system->tied[c]) continue;
        for (size_t i = 0; i < n; i++) system->a[second * n + i] = 0;
        system->a[second * n + (size_t)system->start[c - 1]] = -1;
        system->a[second * n + second] = 1;
        system->b[second] = 0;
    }
}

/* A and b. */
static void find_matrix(imp_cone_system *system)
{
    const imp_cone_problem *problem = system->problem;
    const size_t width = (size_t)(imp_cone_width(problem) * problem->count), n = (size_t)system->n;
    const double unit = 1 / system->d;
    for (size_t i = 0; i < n; i++) {
        const double *w = &problem->w[(size_t)system->row[i] * width], across = system->scale[i];
        system->b[i] = across * problem->q[system->row[i]] / system->size;
        for (size_t j = 0; j < n; j++) system->a[i * n + j] = across * system->scale[j] * w[system->row[j]] * unit;
    }
    tie_lobes(system);
}

/* z = x - y of an answer; what û_n there is beyond both cones' is shared by tied lobes. */
static void recall_answer(imp_cone_system *system, const double *last_r, const double *last_u)
{
    const double unit = system->d / system->size;
    for (int c = 0; c < system->count; c++) {
        const int i = system->start[c];
        const bool shares = system->tied[c] || (c + 1 < system->count && system->tied[c + 1]);
        double square = 0, scale = 0;
        for (int k = i + 1; k < system->start[c + 1]; k++) {
            const double r = last_r[system->row[k]], u = last_u[system->row[k]];
            if (k == i + 1) scale = system->scale[k];
            square += system->scale[k] / scale * u * (system->scale[k] / scale * u);
            system->z[k] = r * unit / system->scale[k] - system->scale[k] * u / system->size;
        }
        const double r = last_r[system->row[i]], u = last_u[system->row[i]];
        system->z[i] = r * unit - ((shares ? 0.5 : 1) * u + scale * sqrt(square)) / system->size;
    }
}

/* ---- the proof ---- */

/* |r - P_K(r - s û)| of one contact. */
static double contact_residual(const imp_cone_problem *problem, int c, const double *r, const double *u, double s)
{
    const double friction = problem->friction[c];
    const imp_cone_lengths *lengths = problem->lengths ? &problem->lengths[c] : NULL;
    const double slip = imp_cone_slip(friction, lengths, u);
    double wanted[6] = {r[0] - s * (u[0] + slip), r[1] - s * u[1], r[2] - s * u[2]}, own[6], on[6], off = 0;
    memcpy(own, r, 3 * sizeof *r);
    if (lengths) {
        double units[6];
        imp_cone_units(friction, *lengths, units);
        for (int k = 3; k < 6; k++) {
            own[k] = r[k] * units[k];
            wanted[k] = units[k] > 0 ? own[k] - s * u[k] / units[k] : 0;
        }
        imp_cone_project_turning(friction, *lengths, 1, wanted, on, NULL);
    } else
        imp_cone_project(friction, wanted, on, NULL);
    for (int k = 0; k < imp_cone_width(problem); k++) off += (own[k] - on[k]) * (own[k] - on[k]);
    return sqrt(off);
}

double imp_cone_residual(const imp_cone_problem *problem, const double *r, double *u)
{
    const double most = imp_cone_largest(problem, r, false), size = imp_cone_largest(problem, problem->q, true);
    const int width = imp_cone_width(problem);
    double worst = 0;
    imp_cone_velocities(problem, r, u);
    for (int c = 0; c < problem->count; c++) {
        if (!(most > 0)) {
            worst = fmax(worst, size > 0 ? -u[width * c] / size : 0);
            continue;
        }
        const double s = size > 0 ? most / size : 1;
        worst = imp_worse(worst, contact_residual(problem, c, &r[width * c], &u[width * c], s) / most);
    }
    return worst;
}

/* The sum of the sizes of one row's terms. */
static double terms_of_row(const imp_cone_problem *problem, int row, const double *r)
{
    const int n = imp_cone_width(problem) * problem->count;
    double sum = 0;
    for (int j = 0; j < n; j++) sum += fabs(problem->w[(size_t)row * (size_t)n + (size_t)j] * r[j]);
    return sum;
}

/* The proof asks for û_n = u_n + mu |u_t|, which is off by both. */
double imp_cone_rounding(const imp_cone_problem *problem, const double *r)
{
    const int width = imp_cone_width(problem);
    const double size = imp_cone_largest(problem, problem->q, true);
    double terms = 0;
    for (int c = 0; c < problem->count; c++) {
        double row[IMP_CONE_WIDEST];
        for (int k = 0; k < width; k++) {
            row[k] = terms_of_row(problem, width * c + k, r);
            terms = fmax(terms, row[k]);
        }
        terms = fmax(terms, row[0] + problem->friction[c] * hypot(row[1], row[2]));
    }
    return size > 0 ? IMP_CONE_ROUNDINGS * DBL_EPSILON * terms / size : 0;
}

/* ---- no solution ---- */

/* Where normal reactions that press nothing apart are pressed by q: those of the problem without friction and with a
 * little added to W grow without bound along such a direction. */
static bool excludes(imp_cone_system *system, double *direction, imp_cone_outcome *outcome)
{
    const imp_cone_problem *problem = system->problem;
    const int count = problem->count, across = imp_cone_width(problem);
    const size_t width = (size_t)(across * count);
    for (int i = 0; i < count; i++) {
        system->start[i] = i;
        system->tied[i] = false;
        system->b[i] = problem->q[across * system->order[i]] / system->size;
        for (int j = 0; j < count; j++)
            system->a[(size_t)i * (size_t)count + (size_t)j] =
                problem->w[(size_t)(across * system->order[i]) * width + (size_t)(across * system->order[j])] /
                    system->d +
                (i == j ? IMP_CONE_SHIFT : 0);
    }
    system->start[count] = system->n = system->count = count;
    system->exact = false;
    system->end = IMP_CONE_PATH_END;
    (void)imp_cone_follow(system);
    imp_cone_values(system, system->z, 0, system->x, system->u);
    double sum = 0, pressed = 0, moved = 0;
    for (int i = 0; i < count; i++) sum += system->x[i];
    if (!(sum > 0)) return false;
    memset(direction, 0, width * sizeof *direction);
    for (int i = 0; i < count; i++) direction[across * system->order[i]] = system->x[i] / sum;
    imp_cone_velocities(problem, direction, system->own);
    for (size_t i = 0; i < width; i++) {
        pressed += problem->q[i] * direction[i];
        moved = fmax(moved, fabs(system->own[i] - problem->q[i]));
    }
    outcome->least_reactions = pressed < 0 ? -pressed / moved : 0;
    return outcome->least_reactions > IMP_CONE_EXCLUDING * system->size / system->d;
}

/* ---- the whole ---- */

static bool is_sound(const imp_cone_problem *problem)
{
    const size_t n = (size_t)(imp_cone_width(problem) * problem->count);
    double sum = 0; /* what is no number, or infinite, makes it none */
    for (size_t i = 0; i < n; i++) sum += 0 * problem->q[i];
    for (size_t i = 0; i < n * n; i++) sum += 0 * problem->w[i];
    for (int c = 0; c < problem->count; c++)
        if (!(problem->friction[c] >= 0 && isfinite(problem->friction[c]))) return false;
    for (int c = 0; problem->lengths && c < problem->count; c++) {
        const imp_cone_lengths *own = &problem->lengths[c];
        if (!(own->torsional >= 0 && own->rolling >= 0 && isfinite(own->torsional + own->rolling))) return false;
    }
    return sum == 0;
}

/* Newton at e = 0 from z, then the proof; the best r and its residual stay. */
static void polish(imp_cone_system *system, bool exact, int most, double *r, double *u, imp_cone_outcome *outcome)
{
    system->exact = exact;
    const int before = system->steps;
    (void)imp_cone_newton(system, 0, IMP_CONE_FINEST, most, false);
    system->exact = false;
    if (system->steps == before) imp_cone_factor(system, system->z, 0); /* the rank at e = 0 is wanted */
    imp_cone_values(system, system->z, 0, system->x, system->u);
    imp_cone_reactions(system, system->x, system->best);
    const double residual = imp_cone_residual(system->problem, system->best, system->own);
    if (!(residual < outcome->residual)) return;
    outcome->residual = residual;
    outcome->chosen = system->rank < system->n;
    const size_t length = (size_t)(imp_cone_width(system->problem) * system->problem->count);
    memcpy(r, system->best, length * sizeof *r);
    memcpy(u, system->own, length * sizeof *u);
}

/* Sweeps from own on, then Newton from there; imp_cone_sweep's change. */
static double sweep_once(imp_cone_system *system, long sweeps, int most, double *own, double *r, double *u,
                         imp_cone_outcome *outcome)
{
    const double before = outcome->residual, change = imp_cone_sweep(system, sweeps, own);
    imp_cone_velocities(system->problem, own, system->own);
    recall_answer(system, own, system->own);
    polish(system, true, most, r, u, outcome);
    if (outcome->residual < before) outcome->stage = IMP_CONE_SWEPT;
    return change;
}

/* Few sweeps at a time: where they go round they come by what Newton starts from. */
static void wander(imp_cone_system *system, double *own, double *r, double *u, imp_cone_outcome *outcome)
{
    enum { STEPS = 8, ROUND = 7 };
    const double count = system->problem->count, each = 27 * count * count, newton = STEPS * 18 * count * count * count;
    double work = 0;
    for (long k = 0;
         work <= IMP_CONE_SWEEPING && !(outcome->residual <= IMP_CONE_ACCEPTED) && !imp_cone_is_spent(system); k++) {
        (void)sweep_once(system, 1 + k % ROUND, STEPS, own, r, u, outcome);
        work += (double)(1 + k % ROUND) * each + newton;
    }
}

/* Ever more sweeps at a time, while they lead on: until they better no answer, or go on for ever where there is none.
 * What goes by the same once may be the slowest to come to rest, before Aitken takes it away; twice, and more so, it is
 * not. */
static void settle_down(imp_cone_system *system, double *own, double *r, double *u, imp_cone_outcome *outcome)
{
    enum { STEPS = 12, FIRST = 256, PATIENCE = 4, DRIFTS = 2 };
    const double each = 27.0 * system->problem->count * system->problem->count; /* multiplications of three sweeps */
    double changed = INFINITY;
    int idle = 0, drifts = 0;
    for (long n = FIRST; idle < PATIENCE && drifts < DRIFTS && n * each <= IMP_CONE_SWEEPING &&
                         !(outcome->residual <= IMP_CONE_ACCEPTED);
         n *= 2) {
        const double before = outcome->residual, change = sweep_once(system, n, STEPS, own, r, u, outcome);
        const bool usable = outcome->residual <= IMP_CONE_USABLE;
        idle = outcome->residual < 0.5 * before || !usable ? 0 : idle + 1;
        drifts = change <= fmin(IMP_CONE_DRIFT, changed) && !usable ? drifts + 1 : 0;
        changed = change;
    }
}

static void sweep(imp_cone_system *system, double *r, double *u, imp_cone_outcome *outcome)
{
    const size_t length = 3 * (size_t)system->problem->count * sizeof(double);
    memset(system->tangent, 0, length);
    memset(system->lift, 0, length);
    settle_down(system, system->tangent, r, u, outcome);
}

/* The path on which friction sets in. */
static void kindle(imp_cone_system *system, double *r, double *u, imp_cone_outcome *outcome)
{
    enum { STEPS = 20 };
    const double before = outcome->residual;
    system->end = IMP_CONE_PATH_END;
    imp_cone_kindle(system);
    polish(system, true, STEPS, r, u, outcome);
    if (outcome->residual < before) outcome->stage = IMP_CONE_KINDLED;
}

static imp_cone_status status_of(const imp_cone_outcome *outcome)
{
    return outcome->residual <= IMP_CONE_ACCEPTED ? IMP_CONE_SOLVED
           : outcome->residual <= IMP_CONE_USABLE ? IMP_CONE_INEXACT
                                                  : IMP_CONE_UNSETTLED;
}

/* Whether nothing better need or can be found: solved, or what is left is the rounding of r in W r, whose terms may be
 * far greater than u. Another way might lead elsewhere, and which it is would be for rounding to say. */
static bool is_exact(const imp_cone_problem *problem, const double *r, const imp_cone_outcome *outcome)
{
    return outcome->residual <= fmax(IMP_CONE_ACCEPTED, problem->enough) ||
           outcome->residual <= fmin(IMP_CONE_USABLE, imp_cone_rounding(problem, r));
}

static void solve(imp_cone_system *system, double *r, double *u, imp_cone_outcome *outcome)
{
    enum { RECALLED = 8, LAST_STEPS = 6, EASINGS = 4 };
    static const double easings[EASINGS] = {IMP_CONE_EASINGS};
    if (system->problem->last_r) {
        recall_answer(system, system->problem->last_r, system->problem->last_u);
        polish(system, false, RECALLED, r, u, outcome);
    }
    if (system->problem->near_last) {
        outcome->status = status_of(outcome);
        return;
    }
    if (!(outcome->residual <= fmax(IMP_CONE_ACCEPTED, system->problem->enough))) {
        outcome->stage = imp_cone_follow(system);
        polish(system, true, LAST_STEPS, r, u, outcome);
    }
    if (!is_exact(system->problem, r, outcome)) {
        system->end = IMP_CONE_RANK_END;
        const imp_cone_stage stage = imp_cone_follow(system);
        const double before = outcome->residual;
        polish(system, true, LAST_STEPS, r, u, outcome);
        if (outcome->residual < before) outcome->stage = stage;
    }
    for (int k = 0; k < EASINGS && !is_exact(system->problem, r, outcome); k++) {
        if (!imp_cone_follow_eased(system, easings[k])) continue;
        outcome->stage = IMP_CONE_EASED;
        polish(system, true, LAST_STEPS, r, u, outcome);
    }
    const bool more = !system->problem->lengths && system->problem->effort != IMP_CONE_BRIEF;
    if (more && !is_exact(system->problem, r, outcome)) kindle(system, r, u, outcome);
    if (more && !is_exact(system->problem, r, outcome) && !imp_cone_is_spent(system)) sweep(system, r, u, outcome);
    outcome->status = status_of(outcome);
    if (outcome->status == IMP_CONE_UNSETTLED && excludes(system, system->best, outcome)) {
        outcome->status = IMP_CONE_NO_SOLUTION;
        memcpy(r, system->best, (size_t)(imp_cone_width(system->problem) * system->problem->count) * sizeof *r);
        imp_cone_velocities(system->problem, r, u);
    }
}

static imp_cone_mode mode_of(double friction, double torsional, const double *r)
{
    if (!(r[0] > 0)) return IMP_CONE_OPEN;
    const double rubs = friction > 0 ? sqrt(r[1] * r[1] + r[2] * r[2]) : 0;
    const double all = torsional > 0 ? hypot(rubs, friction * r[3] / torsional) : rubs;
    return friction > 0 && all < (1 - IMP_CONE_ACCEPTED) * friction * r[0] ? IMP_CONE_STICKS : IMP_CONE_SLIDES;
}

static imp_cone_system system_of(const imp_cone_problem *problem, imp_cone_workspace *workspace)
{
    imp_cone_system system = lay_out(problem, workspace);
    find_order(&system, workspace);
    find_scales(&system);
    find_matrix(&system);
    system.end = IMP_CONE_PATH_END;
    return system;
}

imp_cone_outcome imp_cone_solve(const imp_cone_problem *problem, imp_cone_workspace *workspace, double *r, double *u,
                                imp_cone_mode *modes)
{
    imp_cone_outcome outcome = {.status = IMP_CONE_BAD, .residual = INFINITY};
    const int width = imp_cone_width(problem), unknowns = (problem->lengths ? UNKNOWNS_MOST : 3) * problem->count;
    if (problem->count > workspace->capacity || unknowns > workspace->unknowns || !is_sound(problem)) return outcome;
    if (problem->count == 0) return (imp_cone_outcome){.status = IMP_CONE_SOLVED};
    imp_cone_system system = system_of(problem, workspace);
    memset(r, 0, (size_t)(width * problem->count) * sizeof *r);
    outcome.residual = problem->near_last ? INFINITY : imp_cone_residual(problem, r, u);
    outcome.status = IMP_CONE_SOLVED;
    if (outcome.residual > 0) solve(&system, r, u, &outcome);
    if (outcome.status == IMP_CONE_UNSETTLED && problem->effort == IMP_CONE_WANDERS && !problem->lengths) {
        const imp_cone_system spent = system; /* by the question of whether there is an answer */
        system = system_of(problem, workspace);
        system.factorings = spent.factorings, system.steps = spent.steps, system.work = spent.work;
        memset(system.tangent, 0, 3 * (size_t)problem->count * sizeof *system.tangent);
        wander(&system, system.tangent, r, u, &outcome);
        outcome.status = status_of(&outcome);
    }
    for (int c = 0; modes && c < problem->count; c++)
        modes[c] = mode_of(problem->friction[c], problem->lengths ? problem->lengths[c].torsional : 0, &r[width * c]);
    outcome.factorings = system.factorings;
    outcome.steps = system.steps;
    return outcome;
}

const char *imp_cone_status_name(imp_cone_status status)
{
    switch (status) {
    case IMP_CONE_SOLVED: return "solved";
    case IMP_CONE_INEXACT: return "inexact";
    case IMP_CONE_UNSETTLED: return "unsettled";
    case IMP_CONE_NO_SOLUTION: return "no solution";
    case IMP_CONE_NO_ROOM: return "without room";
    case IMP_CONE_BAD: break;
    }
    return "bad input";
}
