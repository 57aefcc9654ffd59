/* SPDX-License-Identifier: MIT */
#ifndef IMPACT_EXPORT_H
#define IMPACT_EXPORT_H

/* IMPACT_API marks what the shared library impact shows; all else is hidden. */
#if defined(__GNUC__)
#define IMPACT_API __attribute__((visibility("default")))
#else
#define IMPACT_API
#endif

/* IMPACT_INLINE: compiled into the caller, by the structs of the caller's headers, and a symbol of the library as well
 * (libimpact/src/scene/inline.c), for callers without a C compiler. */
#if !defined(IMPACT_INLINE)
#define IMPACT_INLINE static inline
#endif

#endif
