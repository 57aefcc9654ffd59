/* SPDX-License-Identifier: MIT
 *
 * Cheapest first: the modes of last time, where semismooth Newton on F(z, 0) takes one linear system; then the central
 * path; then, of what neither solves, whether a direction excludes a solution. What is accepted is proved from the
 * problem's own numbers, by none of the formulas that found it.
 */
#include "base/tolerances.h"
#include "contact/cone_map.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* ---- room ---- */

enum { SQUARES = 3, VECTORS = 14, INDICES = 3 };

struct imp_cone_key {
    uint64_t key, coupled;
    int contact;
};

bool imp_cone_reserve(imp_cone_workspace *workspace, int contacts)
{
    if (contacts <= workspace->capacity) return true;
    imp_cone_release(workspace);
    const size_t n = 3 * (size_t)contacts;
    workspace->block = imp_arena_take(workspace->arena, SQUARES * n * n + VECTORS * n, sizeof *workspace->block);
    workspace->keys = imp_arena_take(workspace->arena, (size_t)contacts, sizeof *workspace->keys);
    workspace->indices = imp_arena_take(workspace->arena, INDICES * n + 1, sizeof *workspace->indices);
    if (workspace->block && workspace->keys && workspace->indices) {
        workspace->capacity = contacts;
        return true;
    }
    imp_cone_release(workspace);
    return false;
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

static imp_cone_system lay_out(const imp_cone_problem *problem, imp_cone_workspace *workspace, int **order, int **start)
{
    const size_t n = 3 * (size_t)problem->count;
    double *block = workspace->block;
    imp_cone_system s = {.problem = problem, .count = problem->count};
    s.a = next_part(&block, n * n), s.matrix = next_part(&block, n * n), s.spare = next_part(&block, n * n);
    double **vectors[VECTORS] = {&s.b,     &s.r, &s.own, &s.scratch, &s.z,    &s.trial,   &s.step,
                                 &s.value, &s.x, &s.u,   &s.rate,    &s.kept, &s.tangent, &s.best};
    for (int k = 0; k < VECTORS; k++) *vectors[k] = next_part(&block, n);
    s.rows = workspace->indices, s.columns = s.rows + n;
    *order = s.columns + n, *start = *order + problem->count;
    s.order = *order, s.start = *start;
    return s;
}

/* ---- without units ---- */

static double power_of_two(double value)
{
    int exponent;
    (void)frexp(value, &exponent);
    return value > 0 && isfinite(value) ? ldexp(1, exponent - 1) : 1;
}

/* The parts of a contact that are its unknowns. */
static int dimension_of(const imp_cone_problem *problem, int c) { return problem->friction[c] > 0 ? 3 : 1; }

static double contact_size(const imp_cone_problem *problem, const double *v, int c)
{
    double square = v[3 * c] * v[3 * c];
    for (int k = 1; k < dimension_of(problem, c); k++) square += v[3 * c + k] * v[3 * c + k];
    return sqrt(square);
}

static double largest(const imp_cone_problem *problem, const double *v)
{
    double most = 0;
    for (int c = 0; c < problem->count; c++) most = fmax(most, contact_size(problem, v, c));
    return most;
}

/* ---- an order of the contacts that is the problem's own ---- */

/* splitmix64's mixing (Steele, Lea & Flood 2014). */
static uint64_t mix(uint64_t h, double value)
{
    const double positive = value + 0.0; /* one zero, not two */
    uint64_t bits;
    memcpy(&bits, &positive, sizeof bits);
    uint64_t z = h + bits + 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static int by_key(const void *a, const void *b)
{
    const struct imp_cone_key *x = a, *y = b;
    if (x->key != y->key) return x->key < y->key ? -1 : 1;
    return (x->contact > y->contact) - (x->contact < y->contact);
}

/* Factors, powers of two, that take the units out of W and q. */
typedef struct cone_units {
    double w, q;
} cone_units;

static cone_units units_of(const imp_cone_problem *problem)
{
    const size_t n = 3 * (size_t)problem->count;
    double most = 0;
    for (size_t i = 0; i < n; i++) most = fmax(most, problem->w[i * (n + 1)]);
    return (cone_units){1 / power_of_two(most), 1 / power_of_two(largest(problem, problem->q))};
}

static uint64_t own_key(const imp_cone_problem *problem, cone_units units, int c)
{
    const size_t n = 3 * (size_t)problem->count;
    uint64_t h = mix(1, problem->friction[c]);
    for (int k = 0; k < 3; k++) {
        h = mix(h, units.q * problem->q[3 * c + k]);
        for (int l = 0; l < 3; l++) h = mix(h, units.w * problem->w[(size_t)(3 * c + k) * n + (size_t)(3 * c + l)]);
    }
    return h;
}

/* By a hash of the contact's own numbers and of all its couplings: sums of integers know no order. Contacts of one key
 * have like numbers and like neighbours, so that which comes first changes nothing. */
static void choose_order(const imp_cone_problem *problem, cone_units units, struct imp_cone_key *keys, int *order)
{
    const int count = problem->count, n = 3 * count;
    for (int c = 0; c < count; c++) keys[c] = (struct imp_cone_key){.key = own_key(problem, units, c), .contact = c};
    for (int c = 0; c < count; c++) {
        uint64_t sum = 0;
        for (int j = 0; j < count; j++) {
            const double *w = &problem->w[(size_t)(3 * c) * (size_t)n + (size_t)(3 * j)];
            uint64_t h = keys[j].key;
            if (j == c || (w[0] == 0 && w[1] == 0 && w[2] == 0)) continue;
            for (int k = 0; k < 3; k++) h = mix(h, units.w * w[k]);
            sum += h;
        }
        keys[c].coupled = sum;
    }
    for (int c = 0; c < count; c++) keys[c].key += 3 * keys[c].coupled;
    qsort(keys, (size_t)count, sizeof *keys, by_key);
    for (int c = 0; c < count; c++) order[c] = keys[c].contact;
}

/* ---- the problem ---- */

static void find_scales(imp_cone_system *system)
{
    const imp_cone_problem *problem = system->problem;
    const size_t n = 3 * (size_t)problem->count;
    double trace = 0;
    for (int c = 0; c < problem->count; c++) /* in the chosen order: the same sum whatever the numbering */
        for (int k = 0; k < dimension_of(problem, system->order[c]); k++) {
            const size_t i = (size_t)(3 * system->order[c] + k);
            trace += problem->w[i * n + i];
        }
    system->d = power_of_two(trace / fmax(system->n, 1));
    system->size = power_of_two(largest(problem, problem->q));
}

static void find_order(imp_cone_system *system, imp_cone_workspace *workspace, int *order, int *start)
{
    choose_order(system->problem, units_of(system->problem), workspace->keys, order);
    int next = 0;
    for (int c = 0; c < system->count; c++) {
        start[c] = next;
        next += dimension_of(system->problem, order[c]);
    }
    start[system->count] = system->n = next;
}

/* A and b, of contacts i and j the rows and columns. */
static void find_matrix(imp_cone_system *system)
{
    const imp_cone_problem *problem = system->problem;
    const size_t width = 3 * (size_t)problem->count, n = (size_t)system->n;
    const double unit = 1 / system->d; /* a power of two: exact */
    for (int i = 0; i < system->count; i++) {
        const int from = system->order[i], rows = system->start[i + 1] - system->start[i];
        for (int k = 0; k < rows; k++) {
            const size_t row = (size_t)(system->start[i] + k);
            const double *w = &problem->w[(size_t)(3 * from + k) * width], across = k ? problem->friction[from] : 1;
            system->b[row] = across * problem->q[3 * from + k] / system->size;
            for (int j = 0; j < system->count; j++)
                for (int l = 0; l < system->start[j + 1] - system->start[j]; l++) {
                    const double other = l ? problem->friction[system->order[j]] : 1;
                    system->a[row * n + (size_t)(system->start[j] + l)] =
                        across * other * w[3 * system->order[j] + l] * unit;
                }
        }
    }
}

/* z = x - y of an answer that the problem was given. */
static void recall_answer(imp_cone_system *system)
{
    const imp_cone_problem *problem = system->problem;
    const double unit = system->d / system->size;
    for (int c = 0; c < system->count; c++) {
        const int i = system->start[c], from = 3 * system->order[c];
        const double friction = system->start[c + 1] - i == 3 ? problem->friction[system->order[c]] : 0;
        const double *r = &problem->last_r[from], *u = &problem->last_u[from];
        const double slip = friction > 0 ? sqrt(u[1] * u[1] + u[2] * u[2]) : 0;
        system->z[i] = r[0] * unit - (u[0] + friction * slip) / system->size;
        for (int k = 1; i + k < system->start[c + 1]; k++)
            system->z[i + k] = r[k] * unit / friction - friction * u[k] / system->size;
    }
}

/* ---- the proof ---- */

double imp_cone_residual(const imp_cone_problem *problem, const double *r, double *u)
{
    const double most = largest(problem, r), size = largest(problem, problem->q);
    double worst = 0;
    imp_cone_velocities(problem, r, u);
    for (int c = 0; c < problem->count; c++) {
        const double friction = problem->friction[c], *own = &r[3 * c], *v = &u[3 * c];
        if (!(most > 0)) {
            worst = fmax(worst, size > 0 ? -v[0] / size : 0);
            continue;
        }
        const double s = size > 0 ? most / size : 1, slip = friction > 0 ? sqrt(v[1] * v[1] + v[2] * v[2]) : 0;
        const double wanted[3] = {own[0] - s * (v[0] + friction * slip), own[1] - s * v[1], own[2] - s * v[2]};
        double on[3], off = 0;
        imp_cone_project(friction, wanted, on, NULL);
        for (int k = 0; k < 3; k++) off += (own[k] - on[k]) * (own[k] - on[k]);
        const double part = sqrt(off) / most;
        if (!(part <= worst)) worst = part; /* no number is the worst */
    }
    return worst;
}

/* ---- no solution ---- */

/* Where normal reactions that press nothing apart are pressed by q: those of the problem without friction and with a
 * little added to W grow without bound along such a direction. */
static bool excludes(imp_cone_system *system, int *start, double *direction, imp_cone_outcome *outcome)
{
    const imp_cone_problem *problem = system->problem;
    const int count = problem->count;
    const size_t width = 3 * (size_t)count;
    for (int i = 0; i < count; i++) {
        start[i] = i;
        system->b[i] = problem->q[3 * system->order[i]] / system->size;
        for (int j = 0; j < count; j++)
            system->a[(size_t)i * (size_t)count + (size_t)j] =
                problem->w[(size_t)(3 * system->order[i]) * width + (size_t)(3 * system->order[j])] / system->d +
                (i == j ? IMP_CONE_SHIFT : 0);
    }
    start[count] = system->n = count;
    system->exact = false;
    (void)imp_cone_follow(system);
    imp_cone_values(system, system->z, 0, system->x, system->u);
    double sum = 0, pressed = 0, moved = 0;
    for (int i = 0; i < count; i++) sum += system->x[i];
    if (!(sum > 0)) return false;
    memset(direction, 0, width * sizeof *direction);
    for (int i = 0; i < count; i++) direction[3 * system->order[i]] = system->x[i] / sum;
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
    const size_t n = 3 * (size_t)problem->count;
    double sum = 0; /* what is no number, or infinite, makes it none */
    for (size_t i = 0; i < n; i++) sum += 0 * problem->q[i];
    for (size_t i = 0; i < n * n; i++) sum += 0 * problem->w[i];
    for (int c = 0; c < problem->count; c++)
        if (!(problem->friction[c] >= 0 && isfinite(problem->friction[c]))) return false;
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
    memcpy(r, system->best, 3 * (size_t)system->count * sizeof *r);
    memcpy(u, system->own, 3 * (size_t)system->count * sizeof *u);
}

static void solve(imp_cone_system *system, int *start, double *r, double *u, imp_cone_outcome *outcome)
{
    enum { RECALLED = 4, LAST_STEPS = 6, EASINGS = 4 };
    static const double easings[EASINGS] = {0.1, 1e-2, 1e-3, 1}; /* by how many of the hard ones they solve */
    if (system->problem->last_r) {
        recall_answer(system);
        polish(system, false, RECALLED, r, u, outcome);
    }
    if (!(outcome->residual <= IMP_CONE_ACCEPTED)) {
        outcome->stage = imp_cone_follow(system);
        polish(system, true, LAST_STEPS, r, u, outcome);
    }
    for (int k = 0; k < EASINGS && !(outcome->residual <= IMP_CONE_ACCEPTED); k++) {
        if (!imp_cone_follow_eased(system, easings[k])) continue;
        outcome->stage = IMP_CONE_EASED;
        polish(system, true, LAST_STEPS, r, u, outcome);
    }
    outcome->status = outcome->residual <= IMP_CONE_ACCEPTED ? IMP_CONE_SOLVED
                      : outcome->residual <= IMP_CONE_USABLE ? IMP_CONE_INEXACT
                                                             : IMP_CONE_UNSETTLED;
    if (outcome->status == IMP_CONE_UNSETTLED && excludes(system, start, system->best, outcome)) {
        outcome->status = IMP_CONE_NO_SOLUTION;
        memcpy(r, system->best, 3 * (size_t)system->count * sizeof *r);
        imp_cone_velocities(system->problem, r, u);
    }
}

static imp_cone_mode mode_of(double friction, const double *r)
{
    if (!(r[0] > 0)) return IMP_CONE_OPEN;
    const double rubs = friction > 0 ? sqrt(r[1] * r[1] + r[2] * r[2]) : 0;
    return friction > 0 && rubs < (1 - IMP_CONE_ACCEPTED) * friction * r[0] ? IMP_CONE_STICKS : IMP_CONE_SLIDES;
}

imp_cone_outcome imp_cone_solve(const imp_cone_problem *problem, imp_cone_workspace *workspace, double *r, double *u,
                                imp_cone_mode *modes)
{
    imp_cone_outcome outcome = {.status = IMP_CONE_BAD, .residual = INFINITY};
    if (problem->count > workspace->capacity || !is_sound(problem)) return outcome;
    if (problem->count == 0) return (imp_cone_outcome){.status = IMP_CONE_SOLVED};
    int *order, *start;
    imp_cone_system system = lay_out(problem, workspace, &order, &start);
    find_order(&system, workspace, order, start);
    find_scales(&system);
    find_matrix(&system);
    memset(r, 0, 3 * (size_t)problem->count * sizeof *r);
    outcome.residual = imp_cone_residual(problem, r, u);
    outcome.status = IMP_CONE_SOLVED;
    if (outcome.residual > 0) solve(&system, start, r, u, &outcome);
    for (int c = 0; modes && c < problem->count; c++) modes[c] = mode_of(problem->friction[c], &r[3 * c]);
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
