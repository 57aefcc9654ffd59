/* SPDX-License-Identifier: MIT */
#include "scene/definitions.h"
#include "base/definition.h"

#include <stdint.h>
#include <stdio.h>

/* No padding at the ends, so that no later field can stand where an older caller has some. */
#if UINTPTR_MAX > 0xffffffffu
#define ENDS_WITH(type, field) (offsetof(type, field) + sizeof((type *)0)->field == sizeof(type))
_Static_assert(ENDS_WITH(impact_scene_def, pile_tolerance), "impact_scene_def ends with padding");
_Static_assert(ENDS_WITH(impact_body_def, user), "impact_body_def ends with padding");
_Static_assert(ENDS_WITH(impact_force_def, edge), "impact_force_def ends with padding");
_Static_assert(ENDS_WITH(impact_pair_def, rolling_friction), "impact_pair_def ends with padding");
_Static_assert(ENDS_WITH(impact_recorder, account), "impact_recorder ends with padding");
_Static_assert(ENDS_WITH(impact_csv_def, allocator), "impact_csv_def ends with padding");
#endif

/* One kind of list: how large our struct is, and its defaults. */
typedef struct kind {
    const char *name, *defaults;
    size_t size;
    void (*fill)(void *def, size_t size);
} kind;

static void fill_body(void *def, size_t size) { impact_fill_body_def(def, size); }
static void fill_pair(void *def, size_t size) { impact_fill_pair_def(def, size); }
static void fill_force(void *def, size_t size) { impact_fill_force_def(def, size, IMPACT_FORCE_WIND); }

static const kind bodies = {"body", "impact_default_body_def", sizeof(impact_body_def), fill_body};
static const kind pairs = {"pair", "impact_default_pair_def", sizeof(impact_pair_def), fill_pair};
static const kind forces = {"force", "impact_default_force_def", sizeof(impact_force_def), fill_force};

/* All of a list have one size, the first one's, at which they follow each other. */
static impact_status check_list(const kind *k, const char *list, int count, char *message, unsigned long size)
{
    const size_t stride = imp_definition_size(list);
    for (int i = 0; i < count; i++) {
        const char *one = list + (size_t)i * stride, *why = imp_definition_refusal(one, k->size);
        if (!why && imp_definition_size(one) != stride) why = "is not the size of the first in its list";
        if (!why) continue;
        if (message)
            snprintf(message, size, "%s %d: struct_size = %zu: %s (%s)", k->name, i + 1, imp_definition_size(one), why,
                     k->defaults);
        return IMPACT_EARGUMENT;
    }
    return IMPACT_OK;
}

static impact_status take_list(const kind *k, const void **list, int count, imp_arena *arena, char *message,
                               unsigned long size)
{
    if (count <= 0 || !*list) return IMPACT_OK; /* the checks say what is missing */
    const impact_status status = check_list(k, *list, count, message, size);
    const size_t stride = imp_definition_size(*list);
    if (status != IMPACT_OK || stride == k->size) return status;
    char *own = imp_arena_take(arena, (size_t)count, k->size);
    if (!own) return IMPACT_ENOMEM;
    for (size_t i = 0; i < (size_t)count; i++) {
        k->fill(own + i * k->size, k->size);
        imp_definition_take((const char *)*list + i * stride, own + i * k->size, k->size);
    }
    *list = own;
    return IMPACT_OK;
}

impact_status imp_scene_take_def(const impact_scene_def *given, impact_scene_def *own, char *message,
                                 unsigned long message_size)
{
    *own = impact_default_scene_def();
    const char *why = imp_definition_refusal(given, sizeof *own);
    if (why) {
        if (message)
            snprintf(message, message_size, "scene: struct_size = %zu: %s (impact_default_scene_def)",
                     imp_definition_size(given), why);
        return IMPACT_EARGUMENT;
    }
    imp_definition_take(given, own, sizeof *own);
    return IMPACT_OK;
}

impact_status imp_scene_take_lists(impact_scene_def *own, imp_arena *arena, char *message, unsigned long message_size)
{
    const void *lists[3] = {own->bodies, own->pairs, own->forces};
    const int counts[3] = {own->body_count, own->pair_count, own->force_count};
    const kind *const kinds[3] = {&bodies, &pairs, &forces};
    for (int i = 0; i < 3; i++) {
        const impact_status status = take_list(kinds[i], &lists[i], counts[i], arena, message, message_size);
        if (status != IMPACT_OK) return status;
    }
    own->bodies = lists[0];
    own->pairs = lists[1];
    own->forces = lists[2];
    return IMPACT_OK;
}
