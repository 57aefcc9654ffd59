/* SPDX-License-Identifier: MIT
 *
 * Cone problems from files (bench/report_cones_files.h): each form written here from problems with a known answer, read
 * back to the bit and solved; and what is no such file, in words.
 */
#include "kit/near.h"

#include <stdio.h>
#include <string.h>
#include "../../bench/report_cones_files.h"
#ifdef HAVE_HDF5
#include <hdf5.h>
#endif

static const char *const path = "test_cone_files.tmp";

static FILE *begin(void)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    return file;
}

static void put(FILE *file, const double *numbers, size_t count)
{
    for (size_t i = 0; i < count; i++) fprintf(file, "%.17g%s", numbers[i], i % 3 == 2 ? "\n" : " ");
}

/* ---- the three forms of text ---- */

static void write_plain(const cone_case *c)
{
    FILE *file = begin();
    const size_t contacts = (size_t)c->count, n = 3 * contacts;
    fprintf(file, "# a problem\n%d # contacts\n", c->count);
    for (size_t k = 0; k < contacts; k++) fprintf(file, "%.17g%s", c->friction[k], k % 2 ? "; " : ", ");
    put(file, c->w, n * n);
    put(file, c->q, n);
    fclose(file);
}

static void write_dense(const cone_case *c)
{
    FILE *file = begin();
    const size_t contacts = (size_t)c->count, n = 3 * contacts;
    fprintf(file, "3\n%d\n0\n%zu %zu\n%zu %zu\n", c->count, n, n, n, n);
    put(file, c->w, n * n);
    put(file, c->q, n);
    put(file, c->friction, contacts);
    fclose(file);
}

/* All blocks that are not zero, each by columns; the lists of where blocks and their rows end are not looked at. */
static void write_blocks(const cone_case *c)
{
    FILE *file = begin();
    const int contacts = c->count, n = 3 * contacts;
    int blocks = 0, start[64] = {0}, column[4096];
    for (int i = 0; i < contacts; i++) {
        for (int j = 0; j < contacts; j++) {
            double most = 0;
            for (int e = 0; e < 9; e++) most = fmax(most, fabs(c->w[(3 * i + e / 3) * n + 3 * j + e % 3]));
            if (most > 0) column[blocks++] = j;
        }
        start[i + 1] = blocks;
    }
    fprintf(file, "3\n%d\n1\n%d %d\n%d %d %d\n", contacts, n, n, blocks, contacts, contacts);
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < contacts; i++) fprintf(file, "%d ", 3 * (i + 1));
    fprintf(file, "\n%d %d\n", contacts + 1, blocks);
    for (int i = 0; i <= contacts; i++) fprintf(file, "%d ", start[i]);
    for (int k = 0; k < blocks; k++) fprintf(file, "%d ", column[k]);
    for (int i = 0; i < contacts; i++)
        for (int k = start[i]; k < start[i + 1]; k++) {
            fprintf(file, "\n%d\n", k);
            for (int e = 0; e < 9; e++) fprintf(file, "%.17g ", c->w[(3 * i + e % 3) * n + 3 * column[k] + e / 3]);
        }
    fprintf(file, "\n");
    put(file, c->q, (size_t)n);
    put(file, c->friction, (size_t)contacts);
    fclose(file);
}

/* ---- FCLIB ---- */

#ifdef HAVE_HDF5
static void put_set(hid_t file, const char *name, hid_t type, const void *numbers, hsize_t count)
{
    const hid_t space = H5Screate_simple(1, &count, NULL), links = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(links, 1);
    const hid_t set = H5Dcreate2(file, name, type, space, links, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(set >= 0 && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers) >= 0);
    H5Dclose(set), H5Pclose(links), H5Sclose(space);
}

/* As triplets, by columns or by rows (nz: their number, -1, -2). */
static void put_matrix(hid_t file, const char *group, const double *a, int rows, int columns, int form)
{
    const int most = rows * columns, lines = form == -1 ? columns : rows, across = form == -1 ? rows : columns;
    int *p = calloc((size_t)most + 2, sizeof *p), *i = calloc((size_t)most + 1, sizeof *i), filled = 0;
    double *x = calloc((size_t)most + 1, sizeof *x);
    for (int line = 0; line < lines; line++) {
        if (form < 0) p[line] = filled;
        for (int k = 0; k < across; k++) {
            const int row = form == -1 ? k : line, column = form == -1 ? line : k;
            if (a[row * columns + column] == 0) continue;
            if (form >= 0) p[filled] = column;
            i[filled] = form >= 0 ? row : k;
            x[filled++] = a[row * columns + column];
        }
    }
    if (form < 0) p[lines] = filled;
    const int nz = form < 0 ? form : filled;
    const struct {
        const char *name;
        const int *values;
        int count;
    } sets[] = {
        {"m", &rows, 1}, {"n", &columns, 1}, {"nz", &nz, 1}, {"p", p, form < 0 ? lines + 1 : filled}, {"i", i, filled}};
    char name[100];
    for (int k = 0; k < 5; k++) {
        snprintf(name, sizeof name, "%s/%s", group, sets[k].name);
        put_set(file, name, H5T_NATIVE_INT, sets[k].values, (hsize_t)sets[k].count);
    }
    snprintf(name, sizeof name, "%s/x", group);
    put_set(file, name, H5T_NATIVE_DOUBLE, x, (hsize_t)filled);
    free(p), free(i), free(x);
}

static void write_local(const cone_case *c, int form)
{
    const int n = 3 * c->count, dimension = 3;
    const hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    put_set(file, "fclib_local/spacedim", H5T_NATIVE_INT, &dimension, 1);
    put_matrix(file, "fclib_local/W", c->w, n, n, form);
    put_set(file, "fclib_local/vectors/q", H5T_NATIVE_DOUBLE, c->q, (hsize_t)n);
    put_set(file, "fclib_local/vectors/mu", H5T_NATIVE_DOUBLE, c->friction, (hsize_t)c->count);
    H5Fclose(file);
}

/* Two masses of which the first bears a contact each way: W = H^T M^-1 H, q = H^T M^-1 f + w. */
static void global_problems_are_condensed(void **state)
{
    (void)state;
    enum { N = 4 };
    const double m[N * N] = {2, 0.5, 0, 0, 0.5, 1, 0, 0, 0, 0, 4, 0, 0, 0, 0, 0.25}, mu = 0.3, f[N] = {1, -2, 3, 0.5},
                       w[3] = {-1, 0.25, 0.125}, h[N * 3] = {1, 0, 0, 0, 1, 0, 0, 0, 1, -1, 0, 2};
    const double inverse[N * N] = {1 / 1.75, -0.5 / 1.75, 0, 0, -0.5 / 1.75, 2 / 1.75, 0, 0, 0, 0, 0.25, 0, 0, 0, 0, 4};
    const int dimension = 3;
    const hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    put_set(file, "fclib_global/spacedim", H5T_NATIVE_INT, &dimension, 1);
    put_matrix(file, "fclib_global/M", m, N, N, -1);
    put_matrix(file, "fclib_global/H", h, N, 3, -2);
    put_set(file, "fclib_global/vectors/f", H5T_NATIVE_DOUBLE, f, N);
    put_set(file, "fclib_global/vectors/w", H5T_NATIVE_DOUBLE, w, 3);
    put_set(file, "fclib_global/vectors/mu", H5T_NATIVE_DOUBLE, &mu, 1);
    H5Fclose(file);
    cone_case c = {0};
    assert_null(report_cones_read(path, false, &c));
    assert_int_equal(c.count, 1);
    for (int i = 0; i < 3; i++) {
        double q = w[i];
        for (int j = 0; j < 3; j++) {
            double sum = 0;
            for (int k = 0; k < N * N; k++) sum += h[3 * (k / N) + i] * inverse[k] * h[3 * (k % N) + j];
            assert_near(c.w[3 * i + j], sum, 1e-14);
        }
        for (int k = 0; k < N * N; k++) q += h[3 * (k / N) + i] * inverse[k] * f[k % N];
        assert_near(c.q[i], q, 1e-14);
    }
    cone_case_free(&c);
}
#endif

/* ---- read back ---- */

static void solve_it(const cone_case *read, const cone_case *made)
{
    imp_cone_workspace room = {.capacity = 0};
    assert_int_equal(imp_arena_create(NULL, &room.arena), IMPACT_OK);
    assert_true(imp_cone_reserve(&room, read->count));
    const imp_cone_problem problem = cone_case_problem(read);
    double r[30], u[30];
    const imp_cone_outcome o = imp_cone_solve(&problem, &room, r, u, NULL);
    assert_int_equal(o.status, IMP_CONE_SOLVED);
    for (int i = 0; i < 3 * read->count; i++) assert_near(u[i], made->u[i], 1e-11);
    imp_arena_destroy(room.arena);
}

static void every_form_comes_back_to_the_bit(void **state)
{
    (void)state;
    random_stream random = {41};
    for (int run = 0; run < 60; run++) {
        const int count = 1 + run % 10, form = run % 6;
        cone_case made = cone_case_make(&random, count, count, 0.5), c = {0};
        if (form == 0) write_plain(&made);
        if (form == 1) write_dense(&made);
        if (form == 2) write_blocks(&made);
#ifdef HAVE_HDF5
        if (form > 2) write_local(&made, form == 3 ? 0 : form == 4 ? -1 : -2);
#else
        if (form > 2) write_plain(&made);
#endif
        assert_null(report_cones_read(path, form == 1 || form == 2, &c));
        assert_int_equal(c.count, count);
        const size_t n = 3 * (size_t)count;
        assert_memory_equal(c.w, made.w, n * n * sizeof *c.w);
        assert_memory_equal(c.q, made.q, n * sizeof *c.q);
        assert_memory_equal(c.friction, made.friction, (size_t)count * sizeof *c.friction);
        solve_it(&c, &made);
        cone_case_free(&c);
        cone_case_free(&made);
    }
    remove(path);
}

/* In the plane there is a second tangent along which nothing happens; W is made symmetric. */
static void a_plane_problem_gets_a_tangent(void **state)
{
    (void)state;
    FILE *file = begin();
    fprintf(file, "2\n1\n0\n2 2\n2 2\n1 0.25\n0.125 2\n-1 0.5\n0.4\n");
    fclose(file);
    cone_case c = {0};
    assert_null(report_cones_read(path, true, &c));
    const double w[9] = {1, 0.1875, 0, 0.1875, 2, 0, 0, 0, 2}, q[3] = {-1, 0.5, 0};
    assert_memory_equal(c.w, w, sizeof w);
    assert_memory_equal(c.q, q, sizeof q);
    cone_case_free(&c);
}

/* ---- what is none ---- */

static void what_is_no_problem_is_said_in_words(void **state)
{
    (void)state;
    static const struct {
        bool siconos;
        const char *text, *words;
    } bad[] = {
        {false, "contacts", "it does not begin with the number of contacts"},
        {false, "0 1", "the number of contacts is not 1 to 2000"},
        {false, "1.5 1", "the number of contacts is not 1 to 2000"},
        {false, "2 0.5", "its frictions end before each contact has one"},
        {false, "1 0.5  1 0 0 0 1 0 0 0", "its W has fewer than 3n x 3n numbers"},
        {false, "1 0.5  1 0 0 0 1 0 0 0 x", "its W has fewer than 3n x 3n numbers"},
        {false, "1 0.5  1 0 0 0 1 0 0 0 1  -1 0", "its q has fewer than 3n numbers"},
        {false, "1 0.5  1 0 0 0 1 0 0 0 1  -1 0 0  7", "something stands after q"},
        {true, "3 1 0", "it does not begin with dimension, contacts, storage and the size of W"},
        {true, "4 1 0 4 4", "its dimension is neither 2 nor 3"},
        {true, "3 1 2 3 3", "its W is neither dense nor in blocks"},
        {true, "3 0 0 0 0", "the number of contacts is not 1 to 2000"},
        {true, "3 1 0 3 4", "its W is not square, so many numbers a contact"},
        {true, "3 1 0 3 3  3 2  1 0 0 0 1 0 0 0 1", "its W ends early, or has a block elsewhere"},
        {true, "3 1 0 3 3  3 3  1 0 0 0 1 0 0 0", "its W ends early, or has a block elsewhere"},
        {true, "3 1 0 3 3  3 3  1 0 0 0 1 0 0 0 1  -1 0", "its q or its frictions end early"},
        {true, "3 1 0 3 3  3 3  1 0 0 0 1 0 0 0 1  -1 0 0", "its q or its frictions end early"},
        {true, "3 1 1 3 3  1 2 2  3 3", "its W ends early, or has a block elsewhere"},
        {true, "3 1 1 3 3  1 1 1  3 3  2 1  0 1  1  0  1 0 0 0 1 0 0 0 1",
         "its W ends early, or has a block elsewhere"},
        {true, "3 1 1 3 3  1 1 1  3 3  3 1  0 1 1  0  0  1 0 0", "its W ends early, or has a block elsewhere"},
        {true, "3 1 1 3 3  1 1 1  3 3  2 5  0 1  0  0  1 0 0", "its W ends early, or has a block elsewhere"},
    };
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        FILE *file = begin();
        fputs(bad[k].text, file);
        fclose(file);
        cone_case c = {0};
        const char *words = report_cones_read(path, bad[k].siconos, &c);
        if (!words) fail_msg("'%s' is taken", bad[k].text);
        assert_string_equal(words, bad[k].words);
        cone_case_free(&c);
    }
    FILE *file = begin();
    fputs("\x89HDF\r\n\x1a\n", file);
    fclose(file);
    cone_case c = {0};
    const char *words = report_cones_read(path, false, &c);
    assert_true(words && strstr(words, "HDF5"));
    remove(path);
    assert_string_equal(report_cones_read(path, false, &c), "it cannot be opened");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_form_comes_back_to_the_bit),
        cmocka_unit_test(a_plane_problem_gets_a_tangent),
        cmocka_unit_test(what_is_no_problem_is_said_in_words),
#ifdef HAVE_HDF5
        cmocka_unit_test(global_problems_are_condensed),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
