/* SPDX-License-Identifier: MIT
 *
 * Semismooth Newton on D' = 0, each step halved until D falls; the Hessian sum G_c^T P_K' G_c has the coupling of the
 * bodies. It is singular where bodies hang free of all cones: a rounding's worth of its diagonal is added, and a step
 * that runs away is the direction looked for.
 */
#include "contact/rest.h"
#include "base/tolerances.h"
#include "contact/held_linear.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* The problem laid out: bodies that move are numbered in the order in which contacts name them. */
typedef struct rest_system {
    int contacts, bodies, n; /* n = 6 bodies */
    int width;               /* numbers a contact: 3, or 6 with moments, in the units of imp_cone_units */
    const imp_cone_contact *contact;
    const double *friction;
    const imp_cone_lengths *lengths;
    const imp_cone_row *rows, *turns;
    const int *number;       /* per body of the world; -1: does not move */
    double least;            /* size of a load and forces: what is smaller is missed by as much as that may be */
    const int (*couples)[2]; /* per contact, such numbers; NULL: by `contact` and `number` */
    double *matrix, *spare, *scratch, *load, *x, *trial, *step, *gradient, *forces, *sizes;
    int *pivots, *columns;
} rest_system;

enum { REST_SQUARES = 2, REST_VECTORS = 7 };

/* ---- room ---- */

bool imp_rest_reserve(imp_rest_workspace *workspace, int contacts, int bodies)
{
    if (contacts <= workspace->contacts && bodies <= workspace->bodies) return true;
    imp_rest_release(workspace);
    const size_t n = 6 * (size_t)bodies,
                 block = REST_SQUARES * n * n + REST_VECTORS * n + IMP_CONE_WIDEST * (size_t)contacts;
    workspace->block = imp_arena_take(workspace->arena, block, sizeof *workspace->block);
    workspace->rows = imp_arena_take(workspace->arena, (size_t)contacts, sizeof *workspace->rows);
    workspace->turns = imp_arena_take(workspace->arena, (size_t)contacts, sizeof *workspace->turns);
    workspace->indices = imp_arena_take(workspace->arena, 2 * n + (size_t)bodies, sizeof *workspace->indices);
    if (workspace->block && workspace->rows && workspace->turns && workspace->indices) {
        workspace->contacts = contacts, workspace->bodies = bodies;
        return true;
    }
    imp_rest_release(workspace);
    return false;
}

void imp_rest_release(imp_rest_workspace *workspace)
{
    imp_arena_give(workspace->arena, workspace->block);
    imp_arena_give(workspace->arena, workspace->rows);
    imp_arena_give(workspace->arena, workspace->turns);
    imp_arena_give(workspace->arena, workspace->indices);
    *workspace = (imp_rest_workspace){.arena = workspace->arena};
}

static rest_system furnish_rest(imp_rest_workspace *workspace, int bodies, int count)
{
    rest_system s = {.contacts = count, .rows = workspace->rows, .turns = workspace->turns};
    const size_t n = 6 * (size_t)bodies;
    double *block = workspace->block,
           **vectors[] = {&s.scratch, &s.load, &s.x, &s.trial, &s.step, &s.gradient, &s.sizes};
    s.matrix = block, s.spare = block + n * n, block += REST_SQUARES * n * n;
    for (int k = 0; k < REST_VECTORS; k++, block += n) *vectors[k] = block;
    s.forces = block;
    s.pivots = workspace->indices, s.columns = s.pivots + n;
    return s;
}

/* ---- motion and forces ---- */

/* The moving bodies of a contact's two sides, -1 where there is none. */
static void sides_of(const rest_system *s, int c, int body[2])
{
    body[0] = s->couples ? s->couples[c][0] : s->number[s->contact[c].body1];
    body[1] = s->couples ? s->couples[c][1] : s->number[s->contact[c].body2];
}

/* The row k of G of one side. */
static const double *g_row(const rest_system *s, int c, int side, int k)
{
    return k < 3 ? s->rows[c].side[side][k] : s->turns[c].side[side][k - 3];
}

/* P_K of contact c and its derivative. */
static void project_at(const rest_system *s, int c, const double *v, double *f, double slope[6][6])
{
    double small[3][3];
    if (s->width > 3) {
        imp_cone_project_turning(s->friction[c], s->lengths[c], 1, v, f, slope);
        return;
    }
    imp_cone_project(s->friction[c], v, f, slope ? small : NULL);
    for (int k = 0; slope && k < 3; k++) memcpy(slope[k], small[k], sizeof small[k]);
}

/* G x at contact c. */
static void motion_at(const rest_system *s, int c, const double *x, double *v)
{
    int body[2];
    sides_of(s, c, body);
    for (int k = 0; k < s->width; k++) v[k] = 0;
    for (int side = 0; side < 2; side++)
        for (int k = 0; body[side] >= 0 && k < s->width; k++) {
            const double *row = g_row(s, c, side, k);
            for (int l = 0; l < 6; l++) v[k] += row[l] * x[6 * body[side] + l];
        }
}

/* P_K(G x) into f; returns its square. */
static double project_motion(const rest_system *s, const double *x, double *f)
{
    double square = 0;
    for (int c = 0; c < s->contacts; c++) {
        double v[6], *own = &f[s->width * c];
        motion_at(s, c, x, v);
        project_at(s, c, v, own, NULL);
        for (int k = 0; k < s->width; k++) square += own[k] * own[k];
    }
    return square;
}

static double product(const double *a, const double *b, int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

/* D(x), and the forces. */
static double value_at(const rest_system *s, const double *x)
{
    return 0.5 * project_motion(s, x, s->forces) + product(s->load, x, s->n);
}

/* D' = load + G^T f of the forces; returns the residual. */
static double find_gradient(const rest_system *s)
{
    double worst = 0;
    memcpy(s->gradient, s->load, sizeof *s->load * (size_t)s->n);
    for (int b = 0; b < s->bodies; b++) s->sizes[b] = sqrt(product(&s->load[6 * b], &s->load[6 * b], 6));
    for (int c = 0; c < s->contacts; c++) {
        int body[2];
        sides_of(s, c, body);
        for (int side = 0; side < 2; side++) {
            double own[6] = {0};
            for (int k = 0; body[side] >= 0 && k < s->width; k++)
                for (int l = 0; l < 6; l++) own[l] += g_row(s, c, side, k)[l] * s->forces[s->width * c + k];
            for (int l = 0; body[side] >= 0 && l < 6; l++) s->gradient[6 * body[side] + l] += own[l];
            if (body[side] >= 0) s->sizes[body[side]] += sqrt(product(own, own, 6));
        }
    }
    for (int b = 0; b < s->bodies; b++) {
        const double left = sqrt(product(&s->gradient[6 * b], &s->gradient[6 * b], 6));
        const double size = fmax(s->sizes[b], s->least);
        if (left > worst * size) worst = left / size;
    }
    return worst;
}

/* ---- Newton ---- */

static void add_hessian(const rest_system *s, int c, double slope[6][6])
{
    int body[2];
    sides_of(s, c, body);
    for (int i = 0; i < 2; i++)
        for (int j = 0; body[i] >= 0 && j < 2; j++)
            for (int k = 0; body[j] >= 0 && k < 6; k++)
                for (int l = 0; l < 6; l++) {
                    double sum = 0;
                    for (int m = 0; m < s->width; m++)
                        for (int o = 0; o < s->width; o++)
                            sum += g_row(s, c, i, m)[k] * slope[m][o] * g_row(s, c, j, o)[l];
                    s->matrix[(size_t)(6 * body[i] + k) * (size_t)s->n + (size_t)(6 * body[j] + l)] += sum;
                }
}

/* Whether the contact has such a force at all; moments that it has not would balance what nothing does. */
static bool holds(const rest_system *s, int c, int k)
{
    return k < 3 || (s->lengths && (k == 3 ? s->lengths[c].torsional : s->lengths[c].rolling) > 0);
}

/* -D''^-1 D' into step; at first, as if every contact held whatever way it is drawn. */
static bool find_step(const rest_system *s, bool first)
{
    const size_t n = (size_t)s->n;
    double most = 0;
    memset(s->matrix, 0, n * n * sizeof *s->matrix);
    for (int c = 0; c < s->contacts; c++) {
        double v[6], f[6], slope[6][6];
        motion_at(s, c, s->x, v);
        project_at(s, c, v, f, slope);
        for (int k = 0; first && k < 36; k++) slope[k / 6][k % 6] = k / 6 == k % 6 && holds(s, c, k % 6);
        add_hessian(s, c, slope);
    }
    for (size_t i = 0; i < n; i++) most = fmax(most, s->matrix[i * n + i]);
    for (size_t i = 0; i < n; i++) s->matrix[i * n + i] += IMP_REST_SHIFT * (most > 0 ? most : 1);
    imp_linear linear = {.n = s->n,
                         .matrix = s->matrix,
                         .spare = s->spare,
                         .scratch = s->scratch,
                         .rows = s->pivots,
                         .columns = s->columns};
    if (!imp_linear_factor_regular(&linear)) return false;
    for (int i = 0; i < s->n; i++) s->step[i] = -s->gradient[i];
    imp_linear_solve(&linear, s->step);
    return true;
}

/* Along the step until D falls by a part of what its slope promises, or, where rounding hides that, until D' gets
 * smaller; false where neither does. */
static bool walk(const rest_system *s, double *value, double *size)
{
    enum { HALVINGS = 30 };
    const double slope = product(s->gradient, s->step, s->n);
    double part = 1;
    for (int k = 0; k < HALVINGS; k++, part *= 0.5) {
        for (int i = 0; i < s->n; i++) s->trial[i] = s->x[i] + part * s->step[i];
        const double found = value_at(s, s->trial);
        (void)find_gradient(s);
        const double left = sqrt(product(s->gradient, s->gradient, s->n));
        const bool falls = found < *value && found <= *value + IMP_ARMIJO * part * slope;
        const bool hidden = found <= *value + IMP_REST_SHIFT * fabs(*value) && left < (1 - IMP_ARMIJO * part) * *size;
        if (!falls && !hidden) continue;
        memcpy(s->x, s->trial, sizeof *s->x * (size_t)s->n);
        *value = found, *size = left;
        return true;
    }
    return false;
}

/* A step along which the Hessian all but vanishes is as long as its rounding makes it: no longer than ten times the way
 * so far. */
static void shorten(const rest_system *s)
{
    const double most = 10 * sqrt(product(s->x, s->x, s->n)), length = sqrt(product(s->step, s->step, s->n));
    for (int i = 0; i < s->n && most > 0 && length > most; i++) s->step[i] *= most / length;
}

/* Newton's step in the forces themselves, f + P_K' G step: where G x is a small difference of large numbers it leaves
 * less than P_K(G (x + step)) does. Returns the residual. */
static double refine(const rest_system *s)
{
    if (!find_step(s, false)) return INFINITY;
    for (int c = 0; c < s->contacts; c++) {
        double v[6], change[6], f[6], slope[6][6];
        motion_at(s, c, s->x, v);
        motion_at(s, c, s->step, change);
        project_at(s, c, v, f, slope);
        for (int k = 0; k < s->width; k++) {
            f[k] = s->forces[s->width * c + k];
            for (int l = 0; l < s->width; l++) f[k] += slope[k][l] * change[l];
        }
        project_at(s, c, f, &s->forces[s->width * c], NULL);
    }
    return find_gradient(s);
}

/* The least size of reactions that the direction leaves, 0 where it shows nothing; the forces are spent. */
static double excluded_by(const rest_system *s, const double *d)
{
    const double gain = -product(s->load, d, s->n);
    if (!(gain > 0)) return 0;
    const double held = sqrt(project_motion(s, d, s->forces));
    return gain / held; /* infinite where nothing holds */
}

/* ---- the whole ---- */

static void number_bodies(rest_system *s, const imp_world *world, int *number)
{
    for (int b = 0; b < world->body_count; b++) number[b] = -1;
    for (int c = 0; c < s->contacts; c++) {
        const int body[2] = {s->contact[c].body1, s->contact[c].body2};
        for (int k = 0; k < 2; k++)
            if (!world->bodies[body[k]].is_static && number[body[k]] < 0) number[body[k]] = s->bodies++;
    }
    s->n = 6 * s->bodies;
    s->number = number;
}

/* M^(-1/2) times the loads, in the axes of the rows. */
static void find_loads(const rest_system *s, const imp_world *world, const imp_state *states, const imp_load *loads)
{
    for (int i = 0; i < world->body_count; i++) {
        const imp_body *body = &world->bodies[i];
        if (s->number[i] < 0) continue;
        double *own = &s->load[6 * s->number[i]];
        const double linear = sqrt(body->inverse_mass);
        const qvec3 f = loads[i].force,
                    t = body->spherical ? loads[i].torque : quat_rotate_inverse(states[i].q, loads[i].torque),
                    root = body->inverse_moments;
        own[0] = linear * f.x, own[1] = linear * f.y, own[2] = linear * f.z;
        own[3] = sqrt(root.x) * t.x, own[4] = sqrt(root.y) * t.y, own[5] = sqrt(root.z) * t.z;
    }
}

/* The direction as velocities, of length 1 in the root of mass. */
static void show_motion(const rest_system *s, const imp_world *world, const imp_state *states, const double *d,
                        imp_rest_velocity *velocities)
{
    const double length = sqrt(product(d, d, s->n));
    for (int i = 0; i < world->body_count; i++) {
        const imp_body *body = &world->bodies[i];
        velocities[i] = (imp_rest_velocity){{0, 0, 0}, {0, 0, 0}};
        if (s->number[i] < 0 || !(length > 0)) continue;
        const double *own = &d[6 * s->number[i]], linear = sqrt(body->inverse_mass) / length;
        const qvec3 root = body->inverse_moments;
        const qvec3 turn = {sqrt(root.x) * own[3] / length, sqrt(root.y) * own[4] / length,
                            sqrt(root.z) * own[5] / length};
        velocities[i].linear = (qvec3){-linear * own[0], -linear * own[1], -linear * own[2]};
        velocities[i].angular = qvec3_neg(body->spherical ? turn : quat_rotate(states[i].q, turn));
    }
}

/* Counts the steps at a stand: near the balance each squares what the one before left, so that what several do not
 * halve is the least there is, of loads that nothing balances by more than rounding. */
static int count_idle(int idle, double residual, double *least)
{
    const bool stands = residual < IMP_REST_NEAR && residual > 0.5 * *least;
    *least = fmin(*least, residual);
    return stands ? idle + 1 : 0;
}

static imp_rest_outcome minimise(const rest_system *s, const double **direction)
{
    enum { MOST_STEPS = 100, MOST_IDLE = 8, REFINEMENTS = 3 };
    imp_rest_outcome outcome = {.status = IMP_REST_UNDECIDED, .residual = INFINITY};
    const double size = sqrt(product(s->load, s->load, s->n));
    memset(s->x, 0, sizeof *s->x * (size_t)s->n);
    double value = value_at(s, s->x), left = size, least = INFINITY;
    for (int idle = 0; outcome.steps < MOST_STEPS && idle < MOST_IDLE; outcome.steps++) {
        (void)value_at(s, s->x);
        outcome.residual = find_gradient(s);
        for (int k = 0; k < REFINEMENTS && outcome.residual > IMP_REST_BALANCED && outcome.residual < IMP_REST_NEAR;
             k++)
            outcome.residual = refine(s);
        if (outcome.residual <= IMP_REST_BALANCED) {
            outcome.status = IMP_REST_RESTS;
            return outcome;
        }
        idle = count_idle(idle, outcome.residual, &least);
        if (!find_step(s, outcome.steps == 0)) break;
        const double *tried[2] = {s->step, s->x};
        for (int k = 0; k < 2; k++) {
            const double excluded = excluded_by(s, tried[k]);
            if (!(excluded > IMP_REST_EXCLUDING * size)) continue;
            *direction = tried[k];
            outcome.status = IMP_REST_MOVES;
            outcome.least_reactions = excluded;
            return outcome;
        }
        shorten(s);
        if (!walk(s, &value, &left)) break;
    }
    return outcome;
}

/* The rows of moments, divided by the units that make forces of these. */
static void find_turns(const rest_system *s, const imp_world *world, const imp_state *states, imp_cone_row *turns)
{
    imp_cone_find_turns(world, states, s->contact, s->contacts, turns);
    for (int c = 0; c < s->contacts; c++) {
        double units[6];
        imp_cone_units(s->friction[c], s->lengths[c], units);
        for (int i = 0; i < 36; i++) {
            double *row = turns[c].side[i / 18][i / 6 % 3];
            const double unit = units[3 + i / 6 % 3];
            row[i % 6] = unit > 0 ? row[i % 6] / unit : 0;
        }
    }
}

/* The forces in those units to the caller's. */
static void take_reactions(const rest_system *s, bool rests, double *reactions)
{
    for (int i = 0; i < s->width * s->contacts; i++) {
        const int c = i / s->width, k = i % s->width;
        double units[6] = {1, 1, 1};
        if (s->width > 3) imp_cone_units(s->friction[c], s->lengths[c], units);
        reactions[i] = rests && units[k] > 0 ? s->forces[i] / units[k] : 0;
    }
}

imp_rest_outcome imp_rest_solve(const imp_world *world, const imp_state *states, const imp_cone_contact *contacts,
                                const double *friction, const imp_cone_lengths *lengths, int count,
                                const imp_load *loads, imp_rest_workspace *workspace, double *reactions,
                                imp_rest_velocity *velocities)
{
    const double *direction = NULL;
    if (count > workspace->contacts || world->body_count > workspace->bodies)
        return (imp_rest_outcome){.status = IMP_REST_UNDECIDED, .residual = INFINITY};
    rest_system s = furnish_rest(workspace, world->body_count, count);
    s.contact = contacts, s.friction = friction;
    s.lengths = lengths, s.width = lengths ? IMP_CONE_WIDEST : 3;
    number_bodies(&s, world, s.columns + 6 * world->body_count);
    imp_cone_find_rows(world, states, contacts, count, workspace->rows);
    if (lengths) find_turns(&s, world, states, workspace->turns);
    find_loads(&s, world, states, loads);
    const imp_rest_outcome outcome = minimise(&s, &direction);
    take_reactions(&s, outcome.status == IMP_REST_RESTS, reactions);
    memset(s.trial, 0, sizeof *s.trial * (size_t)s.n);
    show_motion(&s, world, states, direction ? direction : s.trial, velocities);
    return outcome;
}

bool imp_rest_find_least(const imp_rest_question *question, imp_rest_workspace *workspace, double *forces)
{
    enum { REFINEMENTS = 3, ROUNDINGS = 4 };
    const double *direction;
    double greatest = 0;
    const int count = question->count;
    if (count > workspace->contacts || question->bodies > workspace->bodies) return false;
    rest_system s = furnish_rest(workspace, question->bodies, count);
    s.couples = question->couples, s.rows = question->rows, s.friction = question->friction;
    s.bodies = question->bodies, s.n = 6 * question->bodies, s.width = 3;
    const size_t length = 3 * (size_t)count * sizeof *forces;
    memset(s.load, 0, (size_t)s.n * sizeof *s.load);
    memcpy(s.forces, forces, length);
    (void)find_gradient(&s);
    for (int i = 0; i < s.n; i++) s.load[i] = -s.gradient[i];
    /* far greater forces leave it to the rounding of their sums: of that nothing may be balanced */
    for (int b = 0; b < s.bodies; b++) {
        s.least = fmax(s.least, fmax(sqrt(product(&s.load[6 * b], &s.load[6 * b], 6)),
                                     ROUNDINGS * DBL_EPSILON / IMP_REST_BALANCED * s.sizes[b]));
        greatest = fmax(greatest, s.sizes[b]);
    }
    const imp_rest_outcome outcome = minimise(&s, &direction);
    /* G is rounded too: of bodies that move as one it leaves what no forces balance; Newton's steps stand there */
    const bool rests = outcome.status == IMP_REST_RESTS,
               stands = outcome.status == IMP_REST_UNDECIDED &&
                        outcome.residual * s.least <= IMP_REST_ROUNDINGS * DBL_EPSILON * greatest;
    if (!rests && !stands) return false;
    memcpy(forces, s.forces, length);
    /* to rounding: what is left would be taken from forces on the border of their cones */
    double before = rests ? outcome.residual : INFINITY;
    for (int k = 0; k < REFINEMENTS; k++) {
        const double left = refine(&s);
        if (!(left < before)) break;
        memcpy(forces, s.forces, length);
        before = left;
    }
    return true;
}
