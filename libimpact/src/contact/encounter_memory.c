/* SPDX-License-Identifier: MIT
 *
 * The workspace: a block of a call and one of a group, which grow to what is wanted and are cut up anew each time.
 */
#include "contact/encounter.h"

#include <string.h>

impact_status imp_together_workspace_in(imp_arena *arena, impact_together_workspace **workspace)
{
    *workspace = imp_arena_take(arena, 1, sizeof **workspace);
    if (!*workspace) return IMPACT_ENOMEM;
    (*workspace)->arena = (*workspace)->cone.arena = (*workspace)->bodies.arena = (*workspace)->rest.arena = arena;
    return IMPACT_OK;
}

impact_status impact_together_workspace_create(const impact_allocator *allocator, impact_together_workspace **workspace)
{
    imp_arena *arena;
    *workspace = NULL;
    impact_status status = imp_arena_create(allocator, &arena);
    if (status != IMPACT_OK) return status;
    status = imp_together_workspace_in(arena, workspace);
    if (status != IMPACT_OK) imp_arena_destroy(arena);
    return status;
}

void impact_together_workspace_destroy(impact_together_workspace *workspace)
{
    if (workspace) imp_arena_destroy(workspace->arena);
}

impact_memory impact_together_workspace_memory(const impact_together_workspace *workspace)
{
    return imp_arena_memory(workspace->arena);
}

bool imp_block_clear(imp_arena *arena, imp_block *block, size_t bytes)
{
    block->used = 0, block->spent = false;
    if (bytes <= block->size) return true;
    imp_arena_give(arena, block->bytes);
    *block = (imp_block){imp_arena_take(arena, bytes, 1), bytes, 0, false};
    if (!block->bytes) block->size = 0;
    return block->bytes;
}

void *imp_block_take(imp_block *block, size_t count, size_t size)
{
    const size_t bytes = (count * size + 15) / 16 * 16;
    if (bytes > block->size - block->used) return block->spent = true, NULL;
    unsigned char *part = block->bytes + block->used;
    block->used += bytes;
    return memset(part, 0, bytes);
}

void *imp_encounter_take(impact_together_workspace *workspace, size_t count, size_t size)
{
    return imp_block_take(&workspace->work, count, size);
}
