/* SPDX-License-Identifier: MIT */
#ifndef QUAT_EXPORT_H
#define QUAT_EXPORT_H

/* QUAT_API marks what the shared libraries quat and quat_gsl show; all else is hidden. */
#if defined(__GNUC__)
#define QUAT_API __attribute__((visibility("default")))
#else
#define QUAT_API
#endif

#endif
