/* SPDX-License-Identifier: MIT
 *
 * A sweep's table as HDF5: /runs, one compound row a run. Nothing in the file depends on when or where it was written:
 * CPU times are in the CSV of their own alone.
 */
#include "sweep_extra.h"

#include <hdf5.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { ROWS_AT_ONCE = 4096 };

/* How the rows lie in memory and in the file: all columns but the last, the CPU time. */
typedef struct layout {
    const impact_sweep_table *table;
    size_t *offsets;
    int count;
    size_t size;
    hid_t type;
} layout;

static size_t size_of(const impact_sweep_column *column)
{
    switch (column->kind) {
    case IMPACT_SWEEP_BOOLEAN: return 1;
    case IMPACT_SWEEP_STRING: return column->longest > 0 ? column->longest : 1;
    default: return 8;
    }
}

/* As h5py has its booleans: an enumeration of FALSE and TRUE. */
static hid_t boolean_type(void)
{
    const hid_t type = H5Tenum_create(H5T_STD_I8LE);
    const int8_t no = 0, yes = 1;
    H5Tenum_insert(type, "FALSE", &no);
    H5Tenum_insert(type, "TRUE", &yes);
    return type;
}

static hid_t type_of(const impact_sweep_column *column)
{
    if (column->kind == IMPACT_SWEEP_BOOLEAN) return boolean_type();
    if (column->kind == IMPACT_SWEEP_INTEGER) return H5Tcopy(H5T_STD_I64LE);
    if (column->kind == IMPACT_SWEEP_NUMBER) return H5Tcopy(H5T_IEEE_F64LE);
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, size_of(column));
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    H5Tset_cset(type, H5T_CSET_UTF8);
    return type;
}

static bool begin_layout(layout *self)
{
    self->size = 0;
    for (int i = 0; i < self->count; i++) {
        self->offsets[i] = self->size;
        self->size += size_of(&self->table->columns[i]);
    }
    self->type = H5Tcreate(H5T_COMPOUND, self->size);
    for (int i = 0; i < self->count; i++) {
        const impact_sweep_column *column = &self->table->columns[i];
        const hid_t member = type_of(column);
        H5Tinsert(self->type, column->name, self->offsets[i], member);
        H5Tclose(member);
    }
    return self->type >= 0;
}

/* Little-endian, as the types say. */
static void put_word(unsigned char *place, uint64_t bits)
{
    for (int i = 0; i < 8; i++) place[i] = (unsigned char)(bits >> (8 * i));
}

static void put_cell(const impact_sweep_column *column, impact_sweep_cell cell, unsigned char *place,
                     impact_sweep_plain *plain)
{
    double number = cell.text ? strtod(cell.text, NULL) : NAN;
    uint64_t bits;
    switch (column->kind) {
    case IMPACT_SWEEP_BOOLEAN: *place = cell.text && cell.text[0] == 't'; return;
    case IMPACT_SWEEP_INTEGER: put_word(place, cell.text ? (uint64_t)strtoll(cell.text, NULL, 10) : 0); return;
    case IMPACT_SWEEP_STRING:
        if (cell.text) plain(cell, (char *)place);
        return;
    default:
        memcpy(&bits, &number, sizeof bits);
        if (isnan(number)) bits = UINT64_C(0x7ff8000000000000); /* one NaN for all */
        put_word(place, bits);
    }
}

static void fill_rows(const layout *self, long from, long count, unsigned char *rows, impact_sweep_cell *cells,
                      impact_sweep_split *split, impact_sweep_plain *plain)
{
    memset(rows, 0, (size_t)count * self->size);
    for (long k = 0; k < count; k++) {
        split(self->table, from + k, cells);
        for (int i = 0; i < self->count; i++) {
            const impact_sweep_column *column = &self->table->columns[i];
            put_cell(column, cells[i], rows + (size_t)k * self->size + self->offsets[i], plain);
        }
    }
}

static bool write_rows(const layout *self, hid_t set, hid_t space, impact_sweep_split *split, impact_sweep_plain *plain)
{
    unsigned char *rows = malloc(ROWS_AT_ONCE * self->size);
    impact_sweep_cell *cells = malloc((size_t)self->table->column_count * sizeof *cells);
    bool good = rows && cells;
    for (long from = 0; good && from < self->table->rows; from += ROWS_AT_ONCE) {
        const long left = self->table->rows - from, count = left < ROWS_AT_ONCE ? left : ROWS_AT_ONCE;
        const hsize_t start = (hsize_t)from, number = (hsize_t)count;
        fill_rows(self, from, count, rows, cells, split, plain);
        const hid_t memory = H5Screate_simple(1, &number, NULL);
        good = H5Sselect_hyperslab(space, H5S_SELECT_SET, &start, NULL, &number, NULL) >= 0 &&
               H5Dwrite(set, self->type, memory, space, H5P_DEFAULT, rows) >= 0;
        H5Sclose(memory);
    }
    free(rows);
    free(cells);
    return good;
}

static bool write_set(hid_t file, const char *name, layout *self, impact_sweep_split *split, impact_sweep_plain *plain)
{
    const hsize_t rows = (hsize_t)self->table->rows;
    if (!begin_layout(self)) return false;
    const hid_t space = H5Screate_simple(1, &rows, NULL), how = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_obj_track_times(how, false);
    const hid_t set = H5Dcreate2(file, name, self->type, space, H5P_DEFAULT, how, H5P_DEFAULT);
    const bool good = set >= 0 && write_rows(self, set, space, split, plain);
    if (set >= 0) H5Dclose(set);
    H5Pclose(how);
    H5Sclose(space);
    H5Tclose(self->type);
    return good;
}

static bool write_runs(hid_t file, const impact_sweep_table *table, impact_sweep_split *split,
                       impact_sweep_plain *plain)
{
    layout self = {.table = table, .count = table->column_count - 1};
    self.offsets = malloc((size_t)self.count * sizeof *self.offsets);
    const bool good = self.offsets && write_set(file, "runs", &self, split, plain);
    free(self.offsets);
    return good;
}

static const char *write_file(const char *path, const impact_sweep_table *table, impact_sweep_split *split,
                              impact_sweep_plain *plain)
{
    H5dont_atexit(); /* it would close again, at exit, a file that it could not close, and end by a signal */
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    const hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    if (file < 0) return "HDF5 cannot make it";
    const bool good = write_runs(file, table, split, plain);
    return H5Fclose(file) >= 0 && good ? NULL : "HDF5 failed";
}

__attribute__((visibility("default"))) extern const impact_sweep_hdf5 impact_sweep_hdf5_writer;
const impact_sweep_hdf5 impact_sweep_hdf5_writer = {write_file};
