/* SPDX-License-Identifier: MIT
 *
 * names: the bodies of a scene by their names: a hash table of their numbers, with linear probing. Internal.
 */
#ifndef IMP_NAMES_H
#define IMP_NAMES_H

#include "base/arena.h"

#include <stddef.h>

typedef struct imp_names {
    imp_arena *arena;
    char **names; /* copies, in the order they came in */
    int count;
    int *numbers; /* the table; -1: empty. At most half of it is taken */
    size_t mask;  /* its length less one, which is a power of two */
} imp_names;

/* Room for so many names, none yet. */
impact_status imp_names_open(imp_names *names, imp_arena *arena, int room);
/* The next number's name, of which there was room; there must be none like it. */
impact_status imp_names_add(imp_names *names, const char *name);
/* The number of the name, or -1; of NULL too. */
int imp_names_find(const imp_names *names, const char *name);

#endif
