/* SPDX-License-Identifier: MIT
 *
 * The parts of the scene core for a stock Lua: cvode.so and ccd.so beside this module, loaded when first asked for, so
 * that `require "impact"` loads neither SUNDIALS nor libccd. The runner has its own way (runner_extra.c).
 */
#define _GNU_SOURCE /* dladdr */
#include "base/parts.h"

#include <dlfcn.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

typedef const struct imp_ode_driver *cvode_entry(void);
typedef const struct imp_gap_ccd *ccd_entry(void);

/* NULL: there is none beside this module. */
static void *entry_of(const char *library, const char *name)
{
    static const char here; /* of this module */
    char path[4096];
    Dl_info info;
    if (!dladdr(&here, &info) || !info.dli_fname) return NULL;
    const char *slash = strrchr(info.dli_fname, '/');
    const int folder = slash ? (int)(slash - info.dli_fname) : 0;
    const int length = snprintf(path, sizeof path, "%.*s/%s", folder, info.dli_fname, library);
    if (!slash || length < 0 || (size_t)length >= sizeof path) return NULL;
    void *handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    return handle ? dlsym(handle, name) : NULL;
}

const struct imp_ode_driver *imp_part_cvode(void)
{
    void *entry = entry_of("cvode.so", "imp_part_cvode");
    return entry ? ((cvode_entry *)(uintptr_t)entry)() : NULL;
}

const struct imp_gap_ccd *imp_part_ccd(void)
{
    void *entry = entry_of("ccd.so", "imp_part_ccd");
    return entry ? ((ccd_entry *)(uintptr_t)entry)() : NULL;
}
