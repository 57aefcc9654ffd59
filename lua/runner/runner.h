/* SPDX-License-Identifier: MIT
 *
 * The runner: impact SCRIPT.lua. Its parts: runner_command.c (the command line), runner.c (a scene), runner_limits.c
 * (memory and time), runner_sandbox.c (what a script can reach), runner_fence.c (what the kernel lets it reach),
 * runner_files.c (the output folder), runner_draw.c (pictures by gnuplot), runner_drawer.c (which starts it), and those
 * of sweep.h (impact sweep).
 */
#ifndef IMPACT_RUNNER_H
#define IMPACT_RUNNER_H

#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <lauxlib.h>
#include <lua.h>
#include "impact_core.h"

/* Exit codes, as --help tells them. */
enum {
    IMPACT_EXIT_OK = 0,
    IMPACT_EXIT_SCRIPT = 1,
    IMPACT_EXIT_USAGE = 2,
    IMPACT_EXIT_RUN = 3,
    IMPACT_EXIT_OUTPUT = 4,
    IMPACT_EXIT_LIMIT = 5,
    IMPACT_EXIT_INACCURATE = 6,
    IMPACT_EXIT_SIGNAL = 128 /* + the signal, as a shell tells it */
};

typedef enum impact_runner_command {
    IMPACT_COMMAND_RUN,
    IMPACT_COMMAND_SWEEP,
    IMPACT_COMMAND_GATHER
} impact_runner_command;

typedef struct impact_runner {
    impact_runner_command command;
    const char *script;    /* or the folder of rows */
    char **arguments;      /* key=value, after --; ended by NULL; NULL: none */
    const char *directory; /* the output folder; made when the first file is */
    bool quiet, trust;
    bool used;     /* the script has run a scene, or written something */
    bool record;   /* NAME.run is written too */
    bool pictures; /* and pictures in other forms beside NAME.png */
    bool report;   /* instead of a run, for so long, s; 0: as it likes */
    double report_seconds;
    bool fence;           /* not without it */
    const char *unfenced; /* why there is none; NULL: there is */
    /* what else is made of the record, by method name and file ending: view, html; gltf, glb; NULL */
    double tolerance;  /* of view and gltf; 0: their own */
    double frame_rate; /* of gltf; 0: its own */
    const char *shown, *ending;
    int threads, shard, shards; /* of a sweep: 0 <= shard < shards */
    bool mpi, hdf5;
    double save_at; /* s, of the scene; NaN: never */
    const char *save_name;
    bool saved_at_time;
    double checkpoint; /* s; 0: none */
    double saved;      /* when, s, monotonic */
    char run_name[256];
    const char *resume; /* the file, and what is in it; NULL: none */
    char *resumed;
    bool verify;
    size_t resumed_size;
    double max_time;      /* s; 0: no limit */
    double max_megabytes; /* as given, and: */
    size_t max_memory;    /* bytes; 0: no limit */
    size_t memory;        /* bytes that Lua, the scenes and the CSV files' sinks hold */
    bool memory_refused;
    double max_disk_megabytes; /* as given, and what is left of it: */
    impact_quota quota;
    char early[800];         /* how far the last run came that ended early, and where its rows are; or "" */
    int folder;              /* descriptor of the output folder, or -1 */
    bool folder_made;        /* it was not there before */
    int folder_error;        /* of making it before the fence closed; 0: none */
    int drawer, drawer_link; /* the process that starts gnuplot, and the way to it; -1: none */
    bool progress_shown;
    double started; /* s, monotonic */
    double progress_at;
    impact_allocator allocator; /* of scenes and sinks: it draws on max_memory */
    impact_lua_host host;
} impact_runner;

/* ---- runner_command.c ---- */

/* Reads the command line; -1: go on; else exit so. */
int impact_runner_read_command(int count, char **words, impact_runner *runner);

/* ---- runner.c ---- */

/* The one line of an end that is not as it should be; gives back the code. */
int impact_runner_complain(impact_runner *runner, int code, const char *message);
/* The same, of a limit that was reached or a signal, where there was one: then with its code. */
int impact_runner_complain_limits(impact_runner *runner, int code, const char *text);
/* The table arg, as lua has it. */
void impact_runner_set_arguments(lua_State *L, const impact_runner *runner);
/* The script's file name without folder and ending. */
void impact_runner_base_name(const impact_runner *runner, char *name, size_t size);

/* ---- runner_limits.c ---- */

/* A lua_Alloc whose context is the runner. */
void *impact_runner_allocate(void *context, void *block, size_t old_size, size_t new_size);
/* The same count for scenes and sinks, and a bound on the address space that holds for what neither asks of us
 * (SUNDIALS, libccd, the C library): the limit, what there is already, and 64 MiB. */
void impact_runner_limit_memory(impact_runner *runner);
/* Starts the clock of --max-time: when it is over, Lua code and runs are stopped; what cannot be stopped so is ended
 * with the process, IMPACT_EXIT_LIMIT, a second later. SIGINT, SIGTERM, SIGHUP and SIGQUIT stop them too; another, a
 * second later, ends the process. */
void impact_runner_start_clock(const impact_runner *runner);
void impact_runner_watch(lua_State *L); /* so that the state's code is stopped */
/* The same of the calling thread's state (NULL: it has none any more), and what stops it. */
void impact_runner_watch_thread(lua_State *L);
void impact_runner_stop_thread(pthread_t thread);
bool impact_runner_time_is_over(void);
int impact_runner_signal(void); /* that told the process to end; 0: none */
/* What is to go when the process is ended at once: NAME.part of both CSV files, where they stand under it. */
void impact_runner_guard(const impact_runner *runner, const char *name);
double impact_runner_now(void); /* s, monotonic */

/* ---- runner_files.c: nothing here follows a link out of the folder ---- */

/* Makes and opens the output folder; false with a message. */
bool impact_runner_open_folder(impact_runner *runner, char *message, size_t size);
/* The same before the fence closes; what went wrong is told by the next who wants to write. */
void impact_runner_open_folder_early(impact_runner *runner);
/* By a process outside the fence: removes a folder that was made for nothing. */
void impact_runner_leave_folder(const impact_runner *runner);
/* Opens a file below the output folder, made of plain components; -1 with errno. */
int impact_runner_open_file(impact_runner *runner, const char *path, int flags);
/* A name that stands for a file of the folder itself: no '/', no leading '.', no control characters. */
bool impact_runner_is_plain(const char *name);
/* All of it, whatever interrupts; false with errno. */
bool impact_runner_write(int file, const char *text, size_t size);
/* A new file of the folder that has no name yet, or stands under NAME.part; -1 with errno. */
int impact_runner_new_file(impact_runner *runner, const char *name, bool *nameless);
/* Gives it its name, in place of what had it, or drops it; false with errno. */
bool impact_runner_finish_file(impact_runner *runner, int file, bool nameless, const char *name, bool keep);
/* Takes bytes from the disk's quota; false with EDQUOT when it has not as many. */
bool impact_runner_spend(impact_runner *runner, unsigned long long bytes);
/* As fdopen, for writing: what is written draws on the quota. */
FILE *impact_runner_count_writes(impact_runner *runner, int file, const char *mode);
/* io.open for scripts; the runner is upvalue 1. */
int impact_runner_io_open(lua_State *L);

/* ---- runner_sandbox.c ---- */

/* Opens the libraries of a new state, our modules among them; without --trust only what cannot reach out. */
void impact_runner_open_libraries(lua_State *L, impact_runner *runner);
/* Loads one of the embedded layers: pushes its chunk. */
bool impact_runner_load_layer(lua_State *L, const char *module);

/* ---- runner_view.c ---- */

/* Writes the page of the recorded run at index as NAME.html (or its glTF, NAME.glb) in the output folder; an exit code.
 */
int impact_runner_view(lua_State *L, int run, impact_runner *runner, const char *name);
/* Whether the script is a recorded run's file, which view and gltf take too; pushes that, or raises an error; and the
 * same of it. */
bool impact_runner_is_record(const impact_runner *runner);
void impact_runner_push_record(lua_State *L, const impact_runner *runner);
int impact_runner_view_record(lua_State *L, impact_runner *runner);
/* Raises what Lua left at the top of the stack of a script that it could not read: where it is shown with the words
 * that a file of another kind calls for; of a recorded run with what shows it. */
int impact_runner_refuse_script(lua_State *L, const impact_runner *runner);

/* ---- runner_save.c ---- */

/* The host's save function. */
bool impact_runner_save(void *context, impact_scene *scene, bool at_time, char *message, size_t message_size);
void impact_runner_drop_checkpoint(const impact_runner *runner);
/* Of --save at a time that the run did not come to: said, and its exit code. */
int impact_runner_tell_unsaved(impact_runner *runner);
/* Reads the file of --resume, before the fence; an exit code. */
int impact_runner_read_resumed(impact_runner *runner);
/* The scene at index goes on from there; raises an error where it cannot. */
void impact_runner_resume(lua_State *L, int scene, const impact_runner *runner);

/* ---- runner_fence.c ---- */

/* Closes it round the process, for good; the output folder is open. NULL, or why it did not close. */
const char *impact_runner_fence(impact_runner *runner);

/* ---- runner_drawer.c ---- */

/* gnuplot's exit code where there is no gnuplot; and in its place where its picture was over what files may hold */
enum { IMPACT_NO_PROGRAM = 127, IMPACT_FILE_TOO_LARGE = -2 };

/* Before the fence; false: no pictures. */
bool impact_runner_start_drawer(impact_runner *runner);
void impact_runner_end_drawer(impact_runner *runner);
/* Runs gnuplot on three open files: its exit code, or -1. The picture may grow to what is left of the quota. */
int impact_runner_gnuplot(impact_runner *runner, int commands, int picture, int complaints);

/* ---- runner_draw.c ---- */

typedef enum impact_draw_result {
    IMPACT_DRAWN,
    IMPACT_DRAW_NO_GNUPLOT,
    IMPACT_DRAW_REFUSED,
    IMPACT_DRAW_FAILED
} impact_draw_result;

/* Draws the figure at index (plain data, see plot.lua) as NAME.png in the output folder; other than IMPACT_DRAWN: with
 * a message. */
impact_draw_result impact_runner_draw(lua_State *L, int index, impact_runner *runner, const char *name, char *message,
                                      size_t size);
/* luaopen of quat.host: save(figure, name) and write(name, text); the runner is upvalue 1. */
int impact_runner_open_host(lua_State *L);

/* ---- runner_extra.c ---- */

/* What the module NAME beside this program's own holds under that name (sweep_extra.h, base/parts.h); NULL with a
 * message. */
const void *impact_runner_extra(const char *module, const char *symbol, char *message, size_t size);

#endif
