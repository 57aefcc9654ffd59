/* SPDX-License-Identifier: MIT */
#include "report_cones_files.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

/* The file's next number; false at its end, or where something else stands. */
static bool next_number(FILE *file, double *value)
{
    int c = fgetc(file);
    while (c != EOF && (isspace(c) || c == ',' || c == ';' || c == '#')) {
        while (c == '#' && (c = fgetc(file)) != EOF && c != '\n') c = '#';
        if (c != EOF) c = fgetc(file);
    }
    if (c == EOF) return false;
    ungetc(c, file);
    return fscanf(file, "%lf", value) == 1;
}

static bool numbers(FILE *file, double *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!next_number(file, &values[i])) return false;
    return true;
}

static bool at_end(FILE *file)
{
    double more;
    return !next_number(file, &more) && feof(file);
}

static void symmetrise(double *w, size_t n)
{
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < i; j++) w[i * n + j] = w[j * n + i] = 0.5 * w[i * n + j] + 0.5 * w[j * n + i];
}

const char *report_cones_room(double contacts, cone_case *c)
{
    if (!(contacts >= 1 && contacts <= 2000 && contacts == floor(contacts)))
        return "the number of contacts is not 1 to 2000";
    *c = cone_case_room((int)contacts, false);
    return c->w && c->q && c->friction && c->r && c->u ? NULL : "there is no memory for it";
}

void report_cones_take(const double *w, const double *q, int dimension, cone_case *c)
{
    const size_t d = (size_t)dimension, n = d * (size_t)c->count, width = 3 * (size_t)c->count;
    for (size_t i = 0; i < n; i++) {
        const size_t row = i / d * 3 + i % d;
        c->q[row] = q[i];
        for (size_t j = 0; j < n; j++) c->w[row * width + j / d * 3 + j % d] = w[i * n + j];
        if (d == 2 && i % 2 == 1) c->w[(row + 1) * (width + 1)] = w[i * (n + 1)];
    }
}

/* ---- as plain numbers ---- */

static const char *read_plain(FILE *file, cone_case *c)
{
    double count;
    if (!next_number(file, &count)) return "it does not begin with the number of contacts";
    const char *wrong = report_cones_room(count, c);
    if (wrong) return wrong;
    const size_t contacts = (size_t)count, n = 3 * contacts;
    if (!numbers(file, c->friction, contacts)) return "its frictions end before each contact has one";
    if (!numbers(file, c->w, n * n)) return "its W has fewer than 3n x 3n numbers";
    if (!numbers(file, c->q, n)) return "its q has fewer than 3n numbers";
    return at_end(file) ? NULL : "something stands after q";
}

/* ---- as Siconos writes them ---- */

/* W in square blocks: how many, their rows and columns, where those end; then, of the blocks by rows, two lists with
 * their lengths before them: where each row of blocks begins, and the column of each. Each block has its number, and
 * its numbers by columns. */
static bool read_blocks(FILE *file, size_t d, size_t contacts, double *w)
{
    double head[3], lengths[2], *skipped = malloc(2 * contacts * sizeof *skipped), *starts = NULL, *columns = NULL;
    bool good = skipped && numbers(file, head, 3) && head[1] == (double)contacts && head[2] == (double)contacts &&
                numbers(file, skipped, 2 * contacts) && numbers(file, lengths, 2) && lengths[0] >= 1 &&
                lengths[0] <= (double)contacts + 1 && lengths[1] >= 0 && lengths[1] <= (double)(contacts * contacts);
    const size_t rows = good ? (size_t)lengths[0] - 1 : 0, blocks = good ? (size_t)lengths[1] : 0, n = d * contacts;
    starts = malloc((rows + 1) * sizeof *starts), columns = malloc((blocks + 1) * sizeof *columns);
    good = good && starts && columns && numbers(file, starts, rows + 1) && numbers(file, columns, blocks);
    for (size_t row = 0; good && row < rows; row++)
        for (double k = starts[row]; good && k < starts[row + 1]; k++) {
            double number, entry;
            good = next_number(file, &number) && k >= 0 && k < (double)blocks && columns[(size_t)k] >= 0 &&
                   columns[(size_t)k] < (double)contacts;
            for (size_t e = 0; good && e < d * d; e++) {
                good = next_number(file, &entry);
                if (good) w[(d * row + e % d) * n + d * (size_t)columns[(size_t)k] + e / d] = entry;
            }
        }
    free(skipped);
    free(starts);
    free(columns);
    return good;
}

static bool read_dense(FILE *file, size_t n, double *w)
{
    double size[2];
    return numbers(file, size, 2) && size[0] == (double)n && size[1] == (double)n && numbers(file, w, n * n);
}

static const char *read_siconos(FILE *file, cone_case *c)
{
    double head[5]; /* dimension, contacts, how W is stored, its rows and columns */
    if (!numbers(file, head, 5)) return "it does not begin with dimension, contacts, storage and the size of W";
    if (head[0] != 2 && head[0] != 3) return "its dimension is neither 2 nor 3";
    if (head[2] != 0 && head[2] != 1) return "its W is neither dense nor in blocks";
    const char *wrong = report_cones_room(head[1], c);
    if (wrong) return wrong;
    const size_t d = (size_t)head[0], contacts = (size_t)head[1], n = d * contacts;
    double *w = calloc(n * n, sizeof *w), *q = calloc(n, sizeof *q);
    if (head[3] != (double)n || head[4] != (double)n)
        wrong = "its W is not square, so many numbers a contact";
    else if (!w || !q)
        wrong = "there is no memory for it";
    else if (!(head[2] == 0 ? read_dense(file, n, w) : read_blocks(file, d, contacts, w)))
        wrong = "its W ends early, or has a block elsewhere";
    else if (!numbers(file, q, n) || !numbers(file, c->friction, contacts))
        wrong = "its q or its frictions end early";
    else
        report_cones_take(w, q, (int)d, c);
    free(w);
    free(q);
    return wrong;
}

/* ---- which of them ---- */

const char *report_cones_read(const char *path, bool siconos, cone_case *c)
{
    unsigned char begin[4] = {0};
    FILE *file = fopen(path, "rb");
    if (!file) return "it cannot be opened";
    const bool hdf5 = fread(begin, 1, 4, file) == 4 && memcmp(begin, "\x89HDF", 4) == 0;
    rewind(file);
    const char *wrong = hdf5 ? report_cones_read_fclib(path, c) : siconos ? read_siconos(file, c) : read_plain(file, c);
    fclose(file);
    if (!wrong) symmetrise(c->w, 3 * (size_t)c->count);
    return wrong;
}
