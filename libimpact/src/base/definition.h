/* SPDX-License-Identifier: MIT
 *
 * definition: structs that a later version may grow at their end; each begins with its size, as the caller's headers
 * have it. A field that is added later means "as before" where it is zero, and stands behind all that was there,
 * padding too. So, whichever of both is older: what the caller's struct is short of has its default, and what it has
 * beyond ours must be zero. Internal.
 */
#ifndef IMP_DEFINITION_H
#define IMP_DEFINITION_H

#include <stdbool.h>
#include <stddef.h>

/* Of the struct at `given`; 0 for NULL. */
size_t imp_definition_size(const void *given);

/* Why the struct at `given` cannot be read, in words, as where that is NULL; NULL: it can. */
const char *imp_definition_refusal(const void *given, size_t own_size);

/* Reads one that is not refused into *own, which has the defaults and its own size. */
void imp_definition_take(const void *given, void *own, size_t own_size);

/* Writes *own into the first struct_size bytes at `given`: what is beyond own is zero, the size is struct_size. */
void imp_definition_give(const void *own, size_t own_size, void *given, size_t struct_size);

#endif
