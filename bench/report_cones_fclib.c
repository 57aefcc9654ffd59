/* SPDX-License-Identifier: MIT */
#include "report_cones_files.h"

#ifndef HAVE_HDF5

const char *report_cones_read_fclib(const char *path, cone_case *c)
{
    (void)path, (void)c;
    return "it is HDF5, which this program was built without";
}

#else

#include <hdf5.h>
#include <stdio.h>

/* A data set's numbers, *count of them; NULL where there are none. */
static void *read_set(hid_t file, const char *group, const char *name, hid_t type, size_t size, size_t *count)
{
    char path[128];
    snprintf(path, sizeof path, "%s/%s", group, name);
    const hid_t set = H5Dopen2(file, path, H5P_DEFAULT);
    if (set < 0) return NULL;
    const hid_t space = H5Dget_space(set);
    *count = (size_t)H5Sget_simple_extent_npoints(space);
    void *numbers = malloc(*count * size + 1);
    if (numbers && H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers) < 0) free(numbers), numbers = NULL;
    H5Sclose(space);
    H5Dclose(set);
    return numbers;
}

static double *read_numbers(hid_t file, const char *group, const char *name, size_t *count)
{
    return read_set(file, group, name, H5T_NATIVE_DOUBLE, sizeof(double), count);
}

/* A sparse matrix as CSparse has it (Davis 2006): nz >= 0 triplets, -1 by columns, -2 by rows; here dense by rows. */
static double *read_matrix(hid_t file, const char *group, size_t *rows, size_t *columns)
{
    size_t one, starts, places, values;
    double *m = read_numbers(file, group, "m", &one), *n = read_numbers(file, group, "n", &one),
           *nz = read_numbers(file, group, "nz", &one), *p = read_numbers(file, group, "p", &starts),
           *i = read_numbers(file, group, "i", &places), *x = read_numbers(file, group, "x", &values), *a = NULL;
    if (m && n && nz && p && i && x && *m >= 1 && *n >= 1 && *m <= 20000 && *n <= 20000) {
        *rows = (size_t)*m, *columns = (size_t)*n;
        a = calloc(*rows * *columns, sizeof *a);
        const size_t lines = *nz >= 0 ? 1 : starts - 1;
        for (size_t line = 0; a && line < lines; line++)
            for (size_t k = *nz >= 0 ? 0 : (size_t)p[line]; k < (*nz >= 0 ? (size_t)*nz : (size_t)p[line + 1]); k++) {
                if (k >= places || k >= values || (*nz >= 0 && k >= starts)) continue;
                const size_t other = *nz >= 0 ? (size_t)p[k] : line, place = (size_t)i[k];
                const size_t row = *nz == -2 ? other : place, column = *nz == -2 ? place : other;
                if (row < *rows && column < *columns) a[row * *columns + column] += x[k];
            }
    }
    free(m), free(n), free(nz), free(p), free(i), free(x);
    return a;
}

/* M = L L^T in place, where rows are from their first number that is not zero on; false where M is not positive. */
static bool take_apart(double *m, size_t n, size_t *first)
{
    for (size_t i = 0; i < n; i++) {
        double *row = &m[i * n];
        for (first[i] = 0; first[i] < i && row[first[i]] == 0; first[i]++) {
        }
        for (size_t j = first[i]; j <= i; j++) {
            for (size_t k = first[i] > first[j] ? first[i] : first[j]; k < j; k++) row[j] -= row[k] * m[j * n + k];
            if (j < i) row[j] /= m[j * n + j];
        }
        if (!(row[i] > 0)) return false;
        row[i] = sqrt(row[i]);
    }
    return true;
}

/* L^-1 of so many columns, in place. */
static void substitute(const double *l, const size_t *first, size_t n, double *b, size_t columns)
{
    for (size_t i = 0; i < n; i++) {
        for (size_t k = first[i]; k < i; k++) {
            const double factor = l[i * n + k];
            for (size_t c = 0; factor != 0 && c < columns; c++) b[i * columns + c] -= factor * b[k * columns + c];
        }
        for (size_t c = 0; c < columns; c++) b[i * columns + c] /= l[i * n + i];
    }
}

/* w += Y^T Y, q += Y^T y, where Y = L^-1 H and y = L^-1 f. */
static void condense(const double *h, const double *f, size_t n, size_t columns, double *w, double *q)
{
    for (size_t k = 0; k < n; k++) {
        const double *row = &h[k * columns];
        for (size_t i = 0; i < columns; i++) {
            if (row[i] == 0) continue;
            q[i] += row[i] * f[k];
            for (size_t j = 0; j < columns; j++) w[i * columns + j] += row[i] * row[j];
        }
    }
}

/* M, H, f to W and what is added to q. */
static double *read_global(hid_t file, double *q, size_t wanted)
{
    size_t n = 0, other = 0, rows = 0, columns = 0, forces = 0;
    double *m = read_matrix(file, "fclib_global/M", &n, &other),
           *h = read_matrix(file, "fclib_global/H", &rows, &columns),
           *f = read_numbers(file, "fclib_global/vectors", "f", &forces), *w = NULL;
    size_t *first = malloc((n + 1) * sizeof *first);
    if (m && h && f && first && n == other && rows == n && forces == n && columns == wanted &&
        take_apart(m, n, first)) {
        substitute(m, first, n, h, columns);
        substitute(m, first, n, f, 1);
        w = calloc(columns * columns, sizeof *w);
        if (w) condense(h, f, n, columns, w, q);
    }
    free(m), free(h), free(f), free(first);
    return w;
}

static const char *read_open(hid_t file, cone_case *c)
{
    const bool global = H5Lexists(file, "fclib_global", H5P_DEFAULT) > 0;
    const char *group = global ? "fclib_global" : "fclib_local", *wrong = NULL;
    char vectors[64];
    snprintf(vectors, sizeof vectors, "%s/vectors", group);
    size_t one = 0, contacts = 0, length = 0, rows = 0, columns = 0;
    double *dimension = read_numbers(file, group, "spacedim", &one), *mu = read_numbers(file, vectors, "mu", &contacts),
           *q = read_numbers(file, vectors, global ? "w" : "q", &length), *w = NULL;
    if (!dimension || !mu || !q || (*dimension != 2 && *dimension != 3) || length != (size_t)*dimension * contacts)
        wrong = "it has no dimension, mu and q of one size";
    else
        wrong = report_cones_room((double)contacts, c);
    if (!wrong) {
        w = global ? read_global(file, q, length) : read_matrix(file, "fclib_local/W", &rows, &columns);
        if (!w || (!global && (rows != length || columns != length))) wrong = "its matrices are not of one size";
    }
    if (!wrong) {
        for (size_t k = 0; k < contacts; k++) c->friction[k] = mu[k];
        report_cones_take(w, q, (int)*dimension, c);
    }
    free(dimension), free(mu), free(q), free(w);
    return wrong;
}

const char *report_cones_read_fclib(const char *path, cone_case *c)
{
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    if (file < 0) return "it is no HDF5 after all";
    const char *wrong = read_open(file, c);
    H5Fclose(file);
    return wrong;
}

#endif
