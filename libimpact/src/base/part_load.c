/* SPDX-License-Identifier: MIT
 *
 * The parts of the shared library, each a library of its own beside it: loaded when first asked for, so that a program
 * whose scenes fly, bounce and roll in closed form loads neither SUNDIALS nor libccd. The loader remembers what it has
 * loaded; nothing is kept here.
 */
#include "base/parts.h"

#include <dlfcn.h>
#include <stddef.h>
#include <stdint.h>

typedef const struct imp_ode_driver *cvode_entry(void);
typedef const struct imp_gap_ccd *ccd_entry(void);

/* IMPACT_PART_SUFFIX: what follows the name, ".so.0.2" */
static void *entry_of(const char *library, const char *name)
{
    void *handle = dlopen(library, RTLD_NOW | RTLD_LOCAL);
    return handle ? dlsym(handle, name) : NULL;
}

const struct imp_ode_driver *imp_part_cvode(void)
{
    void *entry = entry_of("libimpact_cvode" IMPACT_PART_SUFFIX, "imp_part_cvode");
    return entry ? ((cvode_entry *)(uintptr_t)entry)() : NULL;
}

const struct imp_gap_ccd *imp_part_ccd(void)
{
    void *entry = entry_of("libimpact_ccd" IMPACT_PART_SUFFIX, "imp_part_ccd");
    return entry ? ((ccd_entry *)(uintptr_t)entry)() : NULL;
}
