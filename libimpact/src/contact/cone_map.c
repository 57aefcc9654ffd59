/* SPDX-License-Identifier: MIT */
#include "base/tolerances.h"
#include "contact/cone_map.h"

#include <math.h>
#include <string.h>

/* One lobe's spectral values. */
typedef struct cone_spectrum {
    double dir[3], size;     /* z_t/|z_t|, 0 at the axis; |z_t| */
    double f[2], g[2];       /* f(lambda_i), f(-lambda_i) */
    double rise[2], fall[2]; /* f'(lambda_i), f'(-lambda_i) */
    double root[2];          /* sqrt(lambda² + 4 e²) */
    double chord, counter;   /* (f_2 - f_1)/(lambda_2 - lambda_1), and 1 - it */
} cone_spectrum;

/* The smaller of f(lambda), f(-lambda), without cancellation. */
static double smaller_part(double size, double root, double e)
{
    return size + root > 0 ? 2 * e * e / (size + root) : 0;
}

static void spectral_value(cone_spectrum *s, int i, double lambda, double e)
{
    const double size = fabs(lambda), root = sqrt(lambda * lambda + 4 * e * e);
    const double small = smaller_part(size, root, e), large = 0.5 * (size + root);
    s->root[i] = root;
    s->f[i] = lambda > 0 ? large : small;
    s->g[i] = lambda > 0 ? small : large;
    s->rise[i] = root > 0 ? s->f[i] / root : 0.5;
    s->fall[i] = root > 0 ? s->g[i] / root : 0.5;
}

/* chord = (1 + L/S)/2 with L = lambda_1 + lambda_2, S = root_1 + root_2; S² - L² without cancellation. */
static void find_chord(cone_spectrum *s, double lambda1, double lambda2, double e)
{
    const double sum = s->root[0] + s->root[1], along = lambda1 + lambda2, product = lambda1 * lambda2,
                 four = 4 * e * e;
    double small = 0.5;
    if (sum > 0) {
        const double roots = s->root[0] * s->root[1];
        const double excess =
            product > 0 ? four * (lambda1 * lambda1 + lambda2 * lambda2 + four) / (roots + product) : roots - product;
        small = (four + excess) / (sum * (sum + fabs(along)));
    }
    s->chord = along < 0 ? small : 1 - small;
    s->counter = along < 0 ? 1 - small : small;
}

static cone_spectrum spectrum_of(const double *z, int dimension, double e)
{
    cone_spectrum s = {.size = 0};
    double square = 0;
    for (int k = 1; k < dimension; k++) square += z[k] * z[k];
    s.size = sqrt(square);
    for (int k = 1; k < dimension && s.size > 0; k++) s.dir[k - 1] = z[k] / s.size;
    spectral_value(&s, 0, z[0] - s.size, e);
    spectral_value(&s, 1, z[0] + s.size, e);
    find_chord(&s, z[0] - s.size, z[0] + s.size, e);
    return s;
}

static double theta_of(const imp_cone_system *system, double e) { return system->kindles ? 1 - e : 1; }

/* y_n - theta |y_t|: of y_n -/+ |y_t|, or of their rates. */
static double slip_set_apart(double theta, double less, double more)
{
    return 0.5 * ((1 + theta) * less + (1 - theta) * more);
}

/* The two s of tied lobes, or their rates, to s1 + s2 and s2 - s1. */
static void tie(const imp_cone_system *system, int c, double *u)
{
    if (!system->tied[c]) return;
    double *first = &u[system->start[c - 1]], *second = &u[system->start[c]];
    const double one = *first, two = *second;
    *first = one + two;
    *second = two - one;
}

void imp_cone_values(const imp_cone_system *system, const double *z, double e, double *x, double *u)
{
    const double theta = theta_of(system, e);
    for (int c = 0; c < system->count; c++) {
        const int i = system->start[c], dimension = system->start[c + 1] - i;
        const cone_spectrum s = spectrum_of(&z[i], dimension, e);
        x[i] = 0.5 * (s.f[0] + s.f[1]);
        u[i] = slip_set_apart(theta, s.g[1], s.g[0]);
        for (int k = 1; k < dimension; k++) {
            x[i + k] = s.chord * z[i + k];
            u[i + k] = -s.counter * z[i + k];
        }
        tie(system, c, u);
    }
}

void imp_cone_reactions(const imp_cone_system *system, const double *x, double *r)
{
    const double unit = system->size / system->d;
    const int n = imp_cone_width(system->problem) * system->problem->count;
    for (int i = 0; i < n; i++) r[i] = 0;
    for (int i = 0; i < system->n; i++) r[system->row[i]] = system->scale[i] * x[i] * unit;
    for (int c = 0; c < system->count; c++)
        if (system->tied[c])
            r[system->row[system->start[c]]] = 0.5 * (x[system->start[c - 1]] + x[system->start[c]]) * unit;
}

/* Sum and product with their errors (Ogita, Rump & Oishi 2005). */
void imp_cone_velocities(const imp_cone_problem *problem, const double *r, double *u)
{
    const int n = imp_cone_width(problem) * problem->count;
    for (int i = 0; i < n; i++) {
        const double *row = &problem->w[(size_t)i * (size_t)n];
        double sum = problem->q[i], rest = 0;
        for (int j = 0; j < n; j++) {
            if (r[j] == 0) continue;
            const double product = row[j] * r[j], low = fma(row[j], r[j], -product);
            const double next = sum + product, back = next - sum;
            rest += ((sum - (next - back)) + (product - back)) + low;
            sum = next;
        }
        u[i] = sum + rest;
    }
}

/* T u/Q - b as the problem itself has it. */
static void ask_problem(imp_cone_system *system, double *value)
{
    imp_cone_reactions(system, system->x, system->r);
    imp_cone_velocities(system->problem, system->r, system->own);
    for (int i = 0; i < system->n; i++) value[i] = system->scale[i] * system->own[system->row[i]] / system->size;
    for (int c = 0; c < system->count; c++)
        if (system->tied[c]) value[system->start[c]] = system->x[system->start[c]] - system->x[system->start[c - 1]];
}

double imp_cone_defect(imp_cone_system *system, const double *z, double e, double *value)
{
    const int n = system->n;
    double square = 0;
    imp_cone_values(system, z, e, system->x, system->u);
    if (system->exact)
        ask_problem(system, value);
    else
        for (int i = 0; i < n; i++)
            value[i] = imp_linear_dot(&system->a[(size_t)i * (size_t)n], system->x, n) + system->b[i];
    const double left = 1 - theta_of(system, e);
    for (int i = 0; i < n; i++) {
        value[i] = system->u[i] - value[i];
        if (left != 0) value[i] -= left * system->lift[i];
        square += value[i] * value[i];
    }
    return sqrt(square);
}

/* X' and -U' of one lobe. */
static void derivatives(const cone_spectrum *s, double theta, int dimension, double rise[4][4], double fall[4][4])
{
    const double along = 0.5 * (s->rise[0] + s->rise[1]), skew = 0.5 * (s->rise[1] - s->rise[0]);
    const double back = 0.5 * (s->fall[0] + s->fall[1]), turn = 0.5 * (s->fall[1] - s->fall[0]);
    rise[0][0] = along;
    fall[0][0] = slip_set_apart(theta, s->fall[1], s->fall[0]);
    for (int k = 0; k < dimension - 1; k++) {
        rise[0][k + 1] = rise[k + 1][0] = skew * s->dir[k];
        fall[0][k + 1] = slip_set_apart(theta, s->fall[1], -s->fall[0]) * s->dir[k];
        fall[k + 1][0] = turn * s->dir[k];
        for (int l = 0; l < dimension - 1; l++) {
            const double ray = s->dir[k] * s->dir[l];
            rise[k + 1][l + 1] = (along - s->chord) * ray + (k == l ? s->chord : 0);
            fall[k + 1][l + 1] = (back - s->counter) * ray + (k == l ? s->counter : 0);
        }
    }
}

/* The columns A X' - U' of one lobe. */
static inline void fill_columns(imp_cone_system *system, int i, int dimension, double rise[4][4], double fall[4][4])
{
    const size_t n = (size_t)system->n;
    for (size_t row = 0; row < n; row++) {
        const double *a = &system->a[row * n + (size_t)i];
        double *m = &system->matrix[row * n + (size_t)i];
        for (int k = 0; k < dimension; k++) {
            m[k] = a[0] * rise[0][k];
            for (int l = 1; l < dimension; l++) m[k] += a[l] * rise[l][k];
        }
    }
    for (int k = 0; k < dimension; k++)
        for (int l = 0; l < dimension; l++) system->matrix[((size_t)(i + k)) * n + (size_t)(i + l)] += fall[k][l];
}

/* What -U' has of a lobe in the normal row of the one it is tied to. */
static void fill_tie(imp_cone_system *system, int c, int other, double sign, double fall[4][4])
{
    const size_t n = (size_t)system->n, row = (size_t)system->start[other], i = (size_t)system->start[c];
    for (int k = 0; k < system->start[c + 1] - system->start[c]; k++)
        system->matrix[row * n + i + (size_t)k] += sign * fall[0][k];
}

void imp_cone_factor(imp_cone_system *system, const double *z, double e)
{
    for (int c = 0; c < system->count; c++) {
        const int i = system->start[c], dimension = system->start[c + 1] - i;
        const cone_spectrum s = spectrum_of(&z[i], dimension, e);
        double rise[4][4], fall[4][4];
        derivatives(&s, theta_of(system, e), dimension, rise, fall);
        if (dimension == 3)
            fill_columns(system, i, 3, rise, fall); /* the same, unrolled */
        else
            fill_columns(system, i, dimension, rise, fall);
        if (system->tied[c]) fill_tie(system, c, c - 1, 1, fall);
        if (c + 1 < system->count && system->tied[c + 1]) fill_tie(system, c, c + 1, -1, fall);
    }
    imp_linear linear = {.n = system->n,
                         .matrix = system->matrix,
                         .spare = system->spare,
                         .scratch = system->scratch,
                         .rows = system->rows,
                         .columns = system->columns};
    if (e <= IMP_CONE_ARC_LEAST) /* what A leaves open -U' alone tells, of size e^2: rounding hides it */
        imp_linear_factor(&linear);
    else if (!imp_linear_factor_regular(&linear))
        linear.sign = 0;
    system->rank = linear.rank;
    system->sign = linear.sign;
    system->factorings++;
    system->work += 2.0 / 3 * (double)system->n * (double)system->n * (double)system->n;
}

bool imp_cone_is_spent(const imp_cone_system *system)
{
    return system->work > (system->problem->work > 0 ? system->problem->work : IMP_CONE_WORK);
}

void imp_cone_back(imp_cone_system *system, double *right)
{
    const imp_linear linear = {.n = system->n,
                               .rank = system->rank,
                               .matrix = system->matrix,
                               .spare = system->spare,
                               .scratch = system->scratch,
                               .rows = system->rows,
                               .columns = system->columns};
    imp_linear_solve(&linear, right);
}

void imp_cone_drift(imp_cone_system *system, const double *z, double e, double *rate)
{
    const int n = system->n;
    const double theta = theta_of(system, e), kindling = system->kindles ? -0.5 / e : 0; /* dtheta/d(e²) */
    double *x = system->x, *u = system->u; /* d/d(e²) of both: df/d(e²) = 1/root */
    for (int c = 0; c < system->count; c++) {
        const int i = system->start[c], dimension = system->start[c + 1] - i;
        const cone_spectrum s = spectrum_of(&z[i], dimension, e);
        const double low = 1 / s.root[0], high = 1 / s.root[1];
        x[i] = 0.5 * (low + high);
        u[i] = slip_set_apart(theta, high, low) - 0.5 * kindling * (s.g[0] - s.g[1]);
        for (int k = 1; k < dimension; k++) x[i + k] = u[i + k] = 0.5 * (high - low) * s.dir[k - 1];
        tie(system, c, u);
    }
    for (int i = 0; i < n; i++) {
        rate[i] = u[i] - imp_linear_dot(&system->a[(size_t)i * (size_t)n], x, n);
        if (system->kindles) rate[i] += kindling * system->lift[i];
    }
}

/* Along the step, halved until |F| falls; false where it does not. */
static bool search_line(imp_cone_system *system, double e, double *norm)
{
    enum { HALVINGS = 12 };
    const int n = system->n;
    double part = 1;
    for (int k = 0; k < HALVINGS; k++, part *= 0.5) {
        for (int i = 0; i < n; i++) system->trial[i] = system->z[i] + part * system->step[i];
        const double found = imp_cone_defect(system, system->trial, e, system->rate);
        if (!(found < (1 - IMP_ARMIJO * part) * *norm)) continue;
        memcpy(system->z, system->trial, sizeof *system->z * (size_t)n);
        memcpy(system->value, system->rate, sizeof *system->z * (size_t)n);
        *norm = found;
        return true;
    }
    return false;
}

bool imp_cone_newton(imp_cone_system *system, double e, double wanted, int most, bool positive)
{
    double norm = imp_cone_defect(system, system->z, e, system->value);
    for (int k = 0; k < most && norm > wanted && !imp_cone_is_spent(system); k++) {
        imp_cone_factor(system, system->z, e);
        if (positive && system->sign <= 0) return false;
        memcpy(system->step, system->value, sizeof *system->step * (size_t)system->n);
        imp_cone_back(system, system->step);
        system->steps++;
        if (!search_line(system, e, &norm)) return false;
    }
    return norm <= wanted;
}
