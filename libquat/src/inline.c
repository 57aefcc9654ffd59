/* SPDX-License-Identifier: MIT
 *
 * inline: every function that a header defines, as a symbol of the library: for callers without a C compiler (ctypes,
 * LuaJIT, Julia), and for those whose compiler does not inline.
 */
#include <quat/export.h>
#undef QUAT_INLINE
#if defined(__GNUC_GNU_INLINE__)
#define QUAT_INLINE QUAT_API inline
#else
#define QUAT_INLINE QUAT_API extern inline
#endif
#include <quat/dual.h>
#include <quat/project.h>
#include <quat/quat.h>
#include <quat/rotation.h>
