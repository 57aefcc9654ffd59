/* SPDX-License-Identifier: MIT
 *
 * --save, --checkpoint, --resume: a scene's state on the disk, so that a run can go on from there.
 */
#define _GNU_SOURCE
#include "runner.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static bool write_all(FILE *file, const void *bytes, size_t size)
{
    return fwrite(bytes, 1, size, file) == size && fflush(file) == 0;
}

static bool write_saved(impact_runner *runner, const char *name, const void *bytes, size_t size)
{
    bool nameless;
    const int file = impact_runner_new_file(runner, name, &nameless);
    FILE *stream = file >= 0 ? impact_runner_count_writes(runner, file, "w") : NULL;
    if (file >= 0 && !stream) close(file);
    if (!stream) return false;
    const bool whole = write_all(stream, bytes, size);
    const bool named = impact_runner_finish_file(runner, file, nameless, name, whole);
    return fclose(stream) == 0 && named;
}

/* A checkpoint: NAME.save of the run that goes on. */
static void checkpoint_name(const impact_runner *runner, char *name, size_t size)
{
    snprintf(name, size, "%s.save", runner->run_name);
}

bool impact_runner_save(void *context, impact_scene *scene, bool at_time, char *message, size_t message_size)
{
    impact_runner *runner = context;
    char name[300];
    size_t size = 0;
    if (at_time)
        snprintf(name, sizeof name, "%s", runner->save_name);
    else if (!(runner->checkpoint > 0) || impact_runner_now() - runner->saved < runner->checkpoint)
        return true;
    else
        checkpoint_name(runner, name, sizeof name);
    impact_status status = impact_scene_save(scene, NULL, &size);
    void *bytes = status < 0 ? NULL : malloc(size);
    if (bytes) status = impact_scene_save(scene, bytes, &size);
    errno = ENOMEM;
    const bool good = bytes && status >= 0 && write_saved(runner, name, bytes, size);
    if (!good)
        snprintf(message, message_size, "cannot save to '%s/%s': %s", runner->directory, name,
                 status < 0 ? impact_scene_message(scene) : strerror(errno));
    free(bytes);
    runner->saved = impact_runner_now();
    runner->saved_at_time = runner->saved_at_time || (good && at_time);
    return good;
}

int impact_runner_tell_unsaved(impact_runner *runner)
{
    char message[400];
    if (!runner->save_name || runner->saved_at_time) return IMPACT_EXIT_OK;
    snprintf(message, sizeof message, "nothing is saved as '%s': the run ended before t = %g s", runner->save_name,
             runner->save_at);
    return impact_runner_complain(runner, IMPACT_EXIT_OUTPUT, message);
}

/* A run that came to its end needs no checkpoint. */
void impact_runner_drop_checkpoint(const impact_runner *runner)
{
    char name[300];
    checkpoint_name(runner, name, sizeof name);
    if (runner->checkpoint > 0) unlinkat(runner->folder, name, 0);
}

int impact_runner_read_resumed(impact_runner *runner)
{
    char message[400];
    if (!runner->resume) return IMPACT_EXIT_OK;
    FILE *file = fopen(runner->resume, "rb");
    /* a folder opens, and has a length, but cannot be read */
    bool good = file && (getc(file) != EOF || !ferror(file)) && fseek(file, 0, SEEK_END) == 0;
    const long size = good ? ftell(file) : -1;
    runner->resumed = size > 0 ? malloc((size_t)size) : NULL;
    good = runner->resumed && fseek(file, 0, SEEK_SET) == 0 &&
           fread(runner->resumed, 1, (size_t)size, file) == (size_t)size;
    if (!good)
        snprintf(message, sizeof message, "cannot read %s: %s", runner->resume,
                 size == 0 ? "it is empty" : strerror(errno));
    if (file) fclose(file);
    runner->resumed_size = good ? (size_t)size : 0;
    return good ? IMPACT_EXIT_OK : impact_runner_complain(runner, IMPACT_EXIT_SCRIPT, message);
}

void impact_runner_resume(lua_State *L, int scene, const impact_runner *runner)
{
    if (!runner->resumed) return;
    lua_getfield(L, scene, "load");
    lua_pushvalue(L, scene);
    lua_pushlstring(L, runner->resumed, runner->resumed_size);
    if (lua_pcall(L, 2, 0, 0) != LUA_OK) luaL_error(L, "cannot go on from %s: %s", runner->resume, lua_tostring(L, -1));
}
