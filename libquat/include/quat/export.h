/* SPDX-License-Identifier: MIT */
#ifndef QUAT_EXPORT_H
#define QUAT_EXPORT_H

/* QUAT_API marks what the shared libraries quat and quat_gsl show; all else is hidden. */
#if defined(__GNUC__)
#define QUAT_API __attribute__((visibility("default")))
#else
#define QUAT_API
#endif

/* QUAT_INLINE: defined in a header, and a symbol of the library as well (libquat/src/inline.c), for callers without a C
 * compiler. In C the definition here is inline only (C99, 6.7.4): where a compiler does not inline it, it calls the
 * library's. Both give the same bits, unless the host lets its compiler contract a * b + c. */
#if !defined(QUAT_INLINE)
#if defined(__GNUC_GNU_INLINE__) && !defined(__cplusplus)
#define QUAT_INLINE extern inline
#else
#define QUAT_INLINE inline
#endif
#endif

#endif
