/* SPDX-License-Identifier: MIT
 *
 * A file that is whole or not there, as records and what is exported of them are.
 */
#include "run/run.h"
#include "base/out_file.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

static impact_status sink_error(const char *path, const char *what, char *message, unsigned long size)
{
    if (message && size > 0) snprintf(message, size, "%s: %s: %s", path, what, strerror(errno));
    return IMPACT_ESINK;
}

impact_status imp_file_save(imp_arena *arena, const char *path, const void *bytes, size_t size, impact_quota *quota,
                            char *message, unsigned long message_size)
{
    imp_arena *own; /* of what an open file takes, and gives back with it */
    const impact_allocator within = imp_arena_allocator(arena);
    imp_out_file file;
    const char *failed = NULL;
    impact_status status = imp_arena_create(&within, &own);
    if (status < 0) {
        if (message) imp_arena_explain(arena, message, message_size);
        return status;
    }
    errno = 0;
    if (!imp_out_open(&file, own, path, quota))
        failed = "cannot be opened";
    else if (!imp_out_put(&file, bytes, size) || !imp_out_finish(&file, false))
        failed = "cannot be written";
    else if (!imp_out_give_name(&file, path))
        failed = "cannot be given its name";
    const bool refused = errno == ENOMEM;
    if (failed) status = sink_error(path, failed, message, message_size);
    imp_out_close(&file);
    imp_arena_destroy(own);
    return failed && refused ? IMPACT_ENOMEM : status;
}
