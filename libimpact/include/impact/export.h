/* SPDX-License-Identifier: MIT */
#ifndef IMPACT_EXPORT_H
#define IMPACT_EXPORT_H

/* IMPACT_API marks what the shared library impact shows; all else is hidden. */
#if defined(__GNUC__)
#define IMPACT_API __attribute__((visibility("default")))
#else
#define IMPACT_API
#endif

#endif
