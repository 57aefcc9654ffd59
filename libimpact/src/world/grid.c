/* SPDX-License-Identifier: MIT */
#include "world/grid.h"
#include "base/tolerances.h"

#include <math.h>

/* The arena aligns as malloc does; the entries stand on the next line of the cache. */
static imp_grid_entry *take_entries(imp_arena *arena, int entries)
{
    const size_t line = _Alignof(imp_grid_entry);
    char *block = imp_arena_take(arena, (size_t)entries + 1, sizeof(imp_grid_entry));
    if (!block) return NULL;
    return (imp_grid_entry *)(void *)(block + (line - (uintptr_t)block % line) % line);
}

impact_status imp_grid_open(imp_grid *grid, imp_arena *arena, int entries)
{
    unsigned buckets = 16; /* four a box: with two a gas takes two to three parts in a hundred more instructions */
    while (buckets < 4u * (unsigned)entries) buckets *= 2;
    *grid = (imp_grid){.arena = arena,
                       .entries = take_entries(arena, entries),
                       .places = imp_arena_take(arena, (size_t)entries, sizeof *grid->places),
                       .count = entries,
                       .buckets = imp_arena_take(arena, buckets, sizeof *grid->buckets),
                       .bucket_mask = buckets - 1};
    if (!grid->entries || !grid->places || !grid->buckets) return IMPACT_ENOMEM;
    imp_grid_clear(grid);
    return IMPACT_OK;
}

void imp_grid_clear(imp_grid *grid)
{
    for (unsigned k = 0; k <= grid->bucket_mask; k++) grid->buckets[k] = -1;
    for (int i = 0; i < grid->count; i++) grid->entries[i].level = -1;
    grid->level_count = 0;
}

/* Far out the last cell goes on for ever. */
static int64_t cell_of(double x, const imp_grid_level *level)
{
    const double most = IMP_GRID_CELLS, cell = floor(x * level->scale);
    return cell > -most && cell < most ? (int64_t)cell : (int64_t)(cell > 0 ? most : -most);
}

/* Tells the cells of a query apart, which are no more than CELL_MASK along each axis. */
enum { CELL_BITS = 10, CELL_MASK = (1 << CELL_BITS) - 1 };
static uint32_t short_cell(int64_t x, int64_t y, int64_t z)
{
    return (uint32_t)(x & CELL_MASK) | (uint32_t)(y & CELL_MASK) << CELL_BITS |
           (uint32_t)(z & CELL_MASK) << 2 * CELL_BITS;
}

/* Of the cell z = 0; the bucket of another is that many further, so that the cells that a query asks for side by side
 * are one line of the cache. */
static uint32_t column_of(int exponent, int64_t x, int64_t y)
{
    const uint64_t key = (uint32_t)x * 0x9e3779b97f4a7c15u ^ (uint32_t)y * 0xbf58476d1ce4e5b9u ^
                         (uint32_t)exponent * 0x2545f4914f6cdd1du;
    return (uint32_t)(key * 0xd6e8feb86659fd93u >> 32);
}

static int *bucket_of(const imp_grid *grid, uint32_t column, int64_t z)
{
    return &grid->buckets[(column + (uint32_t)z) & grid->bucket_mask];
}

static int *bucket_at(const imp_grid *grid, const imp_grid_entry *e)
{
    const imp_grid_level *level = &grid->levels[e->level];
    int64_t cell[3];
    for (int k = 0; k < 3; k++) cell[k] = cell_of(e->box.low[k], level);
    return bucket_of(grid, column_of(level->exponent, cell[0], cell[1]), cell[2]);
}

static void take_away(imp_grid *grid, imp_grid_entry *e)
{
    if (e->level < 0) return;
    imp_grid_level *level = &grid->levels[e->level];
    *(e->previous < 0 ? bucket_at(grid, e) : &grid->entries[e->previous].next) = e->next;
    if (e->next >= 0) grid->entries[e->next].previous = e->previous;
    const imp_grid_place *place = &grid->places[e - grid->entries];
    *(place->previous < 0 ? &level->first : &grid->places[place->previous].next) = place->next;
    if (place->next >= 0) grid->places[place->next].previous = place->previous;
    level->count--;
    e->level = -1;
}

static int level_of(imp_grid *grid, int exponent)
{
    for (int k = 0; k < grid->level_count; k++)
        if (grid->levels[k].exponent == exponent) return k;
    imp_grid_level *levels =
        imp_arena_grow(grid->arena, grid->levels, &grid->level_room, grid->level_count + 1, sizeof *levels);
    if (!levels) return -1;
    grid->levels = levels;
    grid->levels[grid->level_count] = (imp_grid_level){exponent, ldexp(1, -exponent), 0, -1};
    return grid->level_count++;
}

impact_status imp_grid_put(imp_grid *grid, int entry, const imp_box *box)
{
    imp_grid_entry *e = &grid->entries[entry];
    double side = IMP_GRID_LEAST;
    int exponent;
    take_away(grid, e);
    for (int k = 0; k < 3; k++)
        if (box->high[k] - box->low[k] > side) side = box->high[k] - box->low[k];
    frexp(side, &exponent);
    const int number = level_of(grid, exponent);
    if (number < 0) return IMPACT_ENOMEM;
    imp_grid_level *level = &grid->levels[number];
    e->box = *box;
    e->level = number;
    e->cell = short_cell(cell_of(box->low[0], level), cell_of(box->low[1], level), cell_of(box->low[2], level));
    int *bucket = bucket_at(grid, e);
    e->next = *bucket, e->previous = -1;
    grid->places[entry] = (imp_grid_place){level->first, -1};
    if (*bucket >= 0) grid->entries[*bucket].previous = entry;
    if (level->first >= 0) grid->places[level->first].previous = entry;
    *bucket = level->first = entry;
    level->count++;
    return IMPACT_OK;
}

static bool reserve_found(imp_grid *grid, int more)
{
    if (grid->found_count + more <= grid->found_room) return true;
    int *found = imp_arena_grow(grid->arena, grid->found, &grid->found_room, grid->found_count + more, sizeof *found);
    if (found) grid->found = found;
    return found;
}

static bool look_through(imp_grid *grid, int level, const imp_box *box)
{
    if (!reserve_found(grid, grid->levels[level].count)) return false;
    for (int i = grid->levels[level].first; i >= 0; i = grid->places[i].next)
        if (imp_boxes_overlap(&grid->entries[i].box, box)) grid->found[grid->found_count++] = i;
    return true;
}

/* Cells of one level whose chains are walked abreast: the next entry of each is fetched while others are looked at. */
enum { ABREAST = 32 };
typedef struct cell_walk {
    int level, count;
    int at[ABREAST]; /* the entry that each stands at */
    uint32_t cell[ABREAST];
} cell_walk;

/* To the end of all chains: the boxes in their cells; others lie in the same buckets. Without a branch: whether one is
 * found is as good as chance. */
static bool walk_cells(imp_grid *grid, cell_walk *walk, const imp_box *box)
{
    while (walk->count > 0) {
        if (!reserve_found(grid, walk->count)) return false;
        int left = 0, *found = grid->found + grid->found_count, new = 0;
        for (int k = 0; k < walk->count; k++) {
            const int at = walk->at[k];
            const uint32_t cell = walk->cell[k];
            const imp_grid_entry *e = &grid->entries[at];
            found[new] = at;
            new += (e->level == walk->level) & (e->cell == cell) & imp_boxes_overlap(&e->box, box);
            walk->at[left] = e->next, walk->cell[left] = cell;
            left += e->next >= 0;
        }
        walk->count = left;
        grid->found_count += new;
    }
    return true;
}

static bool look_on_level(imp_grid *grid, int level, const imp_box *box)
{
    const imp_grid_level *on = &grid->levels[level];
    int64_t low[3], high[3];
    double cells = 1;
    for (int k = 0; k < 3; k++) {
        low[k] = cell_of(box->low[k], on) - 1;
        high[k] = cell_of(box->high[k], on);
        const double along = (double)high[k] - (double)low[k] + 1;
        cells *= along <= CELL_MASK ? along : INFINITY; /* no two cells of one query have the same short numbers */
    }
    if (cells > on->count) return look_through(grid, level, box);
    cell_walk walk = {.level = level};
    for (int64_t x = low[0]; x <= high[0]; x++)
        for (int64_t y = low[1]; y <= high[1]; y++) {
            const uint32_t column = column_of(on->exponent, x, y);
            for (int64_t z = low[2]; z <= high[2]; z++) {
                const int first = *bucket_of(grid, column, z);
                walk.at[walk.count] = first, walk.cell[walk.count] = short_cell(x, y, z);
                walk.count += first >= 0;
                if (walk.count == ABREAST && !walk_cells(grid, &walk, box)) return false;
            }
        }
    return walk_cells(grid, &walk, box);
}

impact_status imp_grid_query(imp_grid *grid, const imp_box *box)
{
    grid->found_count = 0;
    for (int level = 0; level < grid->level_count; level++)
        if (grid->levels[level].count > 0 && !look_on_level(grid, level, box)) return IMPACT_ENOMEM;
    return IMPACT_OK;
}
