/* SPDX-License-Identifier: MIT
 *
 * inline: every function that a header defines, as a symbol of the library, for callers without a C compiler (ctypes,
 * LuaJIT, Julia). Their structs are those of this version.
 */
#include <impact/export.h>
#undef IMPACT_INLINE
#define IMPACT_INLINE IMPACT_API
#include <impact/impact.h>
