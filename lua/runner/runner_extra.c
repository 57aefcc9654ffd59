/* SPDX-License-Identifier: MIT
 *
 * What the runner loads when a script or an option needs it, from beside this program, in the build tree or as
 * installed: cvode.so and ccd.so, the parts of the scene core that stand apart; sweep_mpi.so and sweep_hdf5.so.
 */
#define _GNU_SOURCE
#include "runner.h"
#include "base/parts.h"

#include <dlfcn.h>
#include <stdint.h>
#include <string.h>
#include <unistd.h>

const void *impact_runner_extra(const char *module, const char *symbol, char *message, size_t size)
{
    static const char *const places[] = {"modules", IMPACT_RUNNER_MODULES};
    char program[4096], path[4096 + 300];
    const ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    snprintf(message, size, "this build holds no %s", module);
    if (length <= 0) return NULL;
    program[length] = 0;
    *strrchr(program, '/') = 0;
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        snprintf(path, sizeof path, "%s/%s/impact/%s.so", program, places[i], module);
        if (access(path, R_OK) != 0) continue;
        void *library = dlopen(path, RTLD_NOW | RTLD_GLOBAL); /* MPI's own parts look for its symbols */
        const void *extra = library ? dlsym(library, symbol) : NULL;
        if (!extra) snprintf(message, size, "%s", dlerror());
        return extra;
    }
    return NULL;
}

typedef const struct imp_ode_driver *cvode_entry(void);
typedef const struct imp_gap_ccd *ccd_entry(void);

const struct imp_ode_driver *imp_part_cvode(void)
{
    char message[400];
    const void *entry = impact_runner_extra("cvode", "imp_part_cvode", message, sizeof message);
    return entry ? ((cvode_entry *)(uintptr_t)entry)() : NULL;
}

const struct imp_gap_ccd *imp_part_ccd(void)
{
    char message[400];
    const void *entry = impact_runner_extra("ccd", "imp_part_ccd", message, sizeof message);
    return entry ? ((ccd_entry *)(uintptr_t)entry)() : NULL;
}
