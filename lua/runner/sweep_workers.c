/* SPDX-License-Identifier: MIT
 *
 * Threads, each with a Lua state of its own that has loaded the script. They take runs off one counter (of all ranks,
 * with MPI), and write their rows four times a second: a killed process loses that much, or a run.
 */
#define _XOPEN_SOURCE 700
#include "sweep.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { FULL = 1 << 16 };               /* bytes: a block is written when it is as large */
static const double keep_back = 0.25;  /* s: or when it is as old */
static const double poll_every = 1e-3; /* s: messages pass between runs as often */

typedef struct worker {
    impact_sweep *sweep;
    impact_runner runner; /* its own counts of memory and disk */
    pthread_t thread;
    impact_sweep_block block;
    double written, polled;
} worker;

static double thread_time(void)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* ---- ends ---- */

/* message: NULL for an error that is not a text. */
static void stop_all(impact_sweep *sweep, int code, const char *message)
{
    pthread_mutex_lock(&sweep->gate);
    if (!atomic_load(&sweep->stopped)) {
        sweep->code = code;
        snprintf(sweep->message, sizeof sweep->message, "%s", message ? message : "an error that is not a text");
        atomic_store(&sweep->stopped, true);
    }
    pthread_mutex_unlock(&sweep->gate);
}

static bool is_over(const impact_sweep *sweep)
{
    return atomic_load(&sweep->stopped) || impact_runner_time_is_over() || impact_runner_signal();
}

static bool go_on(void *context, double t, double t_end)
{
    (void)t, (void)t_end;
    return !is_over(((worker *)context)->sweep);
}

static bool open_folder(void *context, const char *name, char *message, size_t size)
{
    (void)name;
    return impact_runner_open_folder(&((worker *)context)->runner, message, size);
}

/* ---- runs ---- */

/* Takes runs: the first of `sweep->todo`, and how many; 0: none are left. */
static long take(impact_sweep *sweep, long *first)
{
    if (sweep->ranks) {
        pthread_mutex_lock(&sweep->gate);
        *first = sweep->ranks->take(sweep->grain);
        pthread_mutex_unlock(&sweep->gate);
    } else {
        *first = atomic_fetch_add(&sweep->next, sweep->grain);
    }
    const long left = sweep->todo_count - *first;
    return left < 0 ? 0 : left < sweep->grain ? left : sweep->grain;
}

static bool write_block(worker *self)
{
    impact_sweep *sweep = self->sweep;
    pthread_mutex_lock(&sweep->gate);
    const bool good = impact_sweep_write_block(&self->runner, sweep->part, &self->block);
    const int error = errno;
    pthread_mutex_unlock(&sweep->gate);
    self->written = impact_runner_now();
    char message[200];
    if (self->runner.quota.spent)
        snprintf(message, sizeof message, "disk limit of %g MB reached", self->runner.max_disk_megabytes);
    else
        snprintf(message, sizeof message, "cannot write rows: %s", strerror(error));
    if (!good) stop_all(sweep, self->runner.quota.spent ? IMPACT_EXIT_LIMIT : IMPACT_EXIT_OUTPUT, message);
    return good;
}

static void poll_ranks(worker *self, double now)
{
    impact_sweep *sweep = self->sweep;
    if (!sweep->ranks || now - self->polled < poll_every || pthread_mutex_trylock(&sweep->gate) != 0) return;
    sweep->ranks->poll();
    pthread_mutex_unlock(&sweep->gate);
    self->polled = now;
}

/* Adds the line on top of the stack. */
static bool keep_line(worker *self, lua_State *L, double cpu)
{
    size_t size;
    char head[40];
    const char *line = lua_tolstring(L, -1, &size), *status = line ? memchr(line, '\t', size) : NULL;
    const int length = snprintf(head, sizeof head, "%.6f\t", cpu);
    if (!status || !impact_sweep_add(&self->block, head, (size_t)length) ||
        !impact_sweep_add(&self->block, line, size) || !impact_sweep_add(&self->block, "\n", 1))
        return stop_all(self->sweep, IMPACT_EXIT_LIMIT, "not enough memory"), false;
    const bool failed = strncmp(status + 1, "error\t", 6) == 0 || strncmp(status + 1, "failed\t", 7) == 0;
    if (failed) atomic_fetch_add(&self->sweep->failed, 1);
    atomic_fetch_add(&self->sweep->done, 1);
    return true;
}

/* The sweep's table is at index 1. False: no more. */
static bool run_one(worker *self, lua_State *L, long run)
{
    const double before = thread_time();
    lua_getfield(L, 1, "line");
    lua_pushvalue(L, 1);
    lua_pushinteger(L, run);
    const int status = lua_pcall(L, 2, 1, 0);
    if (is_over(self->sweep)) return false; /* a run that was ended is no row */
    if (status != LUA_OK) return stop_all(self->sweep, IMPACT_EXIT_SCRIPT, lua_tostring(L, -1)), false;
    if (!keep_line(self, L, thread_time() - before)) return false;
    lua_settop(L, 1);
    const double now = impact_runner_now();
    poll_ranks(self, now);
    return (self->block.size < FULL && now - self->written < keep_back) || write_block(self);
}

/* Protected: (worker) */
static int work(lua_State *L)
{
    worker *self = lua_touserdata(L, 1);
    impact_sweep *sweep = self->sweep;
    impact_sweep_load(L, &self->runner, sweep->script, sweep->script_size, false);
    lua_replace(L, 1);
    self->written = impact_runner_now();
    long first, count;
    while (!is_over(sweep) && (count = take(sweep, &first)) > 0)
        for (long k = 0; k < count; k++)
            if (!run_one(self, L, sweep->todo[first + k])) return 0;
    return 0;
}

static void work_in_state(worker *self)
{
    lua_State *L = lua_newstate(impact_runner_allocate, &self->runner);
    if (!L) {
        stop_all(self->sweep, IMPACT_EXIT_LIMIT, "not enough memory");
        return;
    }
    lua_pushcfunction(L, work);
    lua_pushlightuserdata(L, self);
    if (lua_pcall(L, 1, 0, 0) != LUA_OK && !is_over(self->sweep))
        stop_all(self->sweep, IMPACT_EXIT_SCRIPT, lua_tostring(L, -1));
    impact_runner_watch_thread(NULL);
    write_block(self);
    lua_close(L);
    free(self->block.text);
}

static void *begin_work(void *context)
{
    worker *self = context;
    work_in_state(self);
    pthread_mutex_lock(&self->sweep->gate);
    self->sweep->ended++;
    pthread_cond_signal(&self->sweep->end);
    pthread_mutex_unlock(&self->sweep->gate);
    return NULL;
}

/* Limits are shared out evenly. */
static void make_worker(worker *self, impact_sweep *sweep, int threads)
{
    self->sweep = sweep;
    self->runner = *sweep->runner;
    impact_runner *runner = &self->runner;
    runner->memory = 0;
    runner->max_memory /= (size_t)threads;
    runner->quota.left /= (unsigned long long)threads;
    runner->drawer_link = -1;
    runner->allocator.context = runner;
    runner->host = (impact_lua_host){.directory = runner->directory,
                                     .confined = !runner->trust,
                                     .prepare = open_folder,
                                     .progress = go_on,
                                     .quota = &runner->quota,
                                     .allocator = &runner->allocator,
                                     .context = self};
}

/* ---- while they work ---- */

static void tell_progress(const impact_sweep *sweep, double seconds, bool terminal)
{
    const long done = atomic_load(&sweep->done), failed = atomic_load(&sweep->failed);
    const double rate = (double)done / seconds;
    const long all = sweep->todo_count / sweep->rank_count; /* of this rank, about */
    char left[60] = "";
    if (rate > 0 && all > done) snprintf(left, sizeof left, ", about %.0f s left", (double)(all - done) / rate);
    const char *const around[2] = {terminal ? "\r\033[K" : "", terminal ? "" : "\n"};
    fprintf(stderr, "%s%ld of %ld runs, %.4g per second%s, %ld failed%s", around[0], done, all, rate, left, failed,
            around[1]);
    fflush(stderr);
}

/* Waits for the threads; a line on a terminal as it goes, one a minute in a log. */
static void watch(impact_sweep *sweep, worker *workers, int threads)
{
    const bool terminal = isatty(STDERR_FILENO) != 0;
    const bool quiet = sweep->runner->quiet || sweep->rank > 0;
    const double started = impact_runner_now(), pause = terminal ? 0.5 : 60;
    double told = started;
    bool shown = false, over = false;
    pthread_mutex_lock(&sweep->gate);
    while (sweep->ended < threads) {
        struct timespec until;
        clock_gettime(CLOCK_REALTIME, &until);
        until.tv_nsec += 200000000;
        if (until.tv_nsec >= 1000000000) until.tv_nsec -= 1000000000, until.tv_sec++;
        pthread_cond_timedwait(&sweep->end, &sweep->gate, &until);
        for (int i = 0; !over && is_over(sweep) && i < threads; i++) impact_runner_stop_thread(workers[i].thread);
        over = is_over(sweep);
        if (quiet || impact_runner_now() - told < pause) continue;
        told = impact_runner_now();
        tell_progress(sweep, told - started, terminal);
        shown = true;
    }
    pthread_mutex_unlock(&sweep->gate);
    for (int i = 0; i < threads; i++) pthread_join(workers[i].thread, NULL);
    if (shown && terminal) fputs("\r\033[K", stderr);
}

int impact_sweep_work(impact_sweep *sweep, int threads)
{
    worker *workers = calloc((size_t)threads, sizeof *workers);
    int running = 0;
    if (!workers) return snprintf(sweep->message, sizeof sweep->message, "not enough memory"), IMPACT_EXIT_LIMIT;
    for (; running < threads; running++) {
        make_worker(&workers[running], sweep, threads);
        const int error = pthread_create(&workers[running].thread, NULL, begin_work, &workers[running]);
        if (error == 0) continue;
        if (running == 0) stop_all(sweep, IMPACT_EXIT_LIMIT, strerror(error));
        break;
    }
    watch(sweep, workers, running);
    unsigned long long left = 0;
    for (int i = 0; i < running; i++) left += workers[i].runner.quota.left;
    sweep->runner->quota.left = left;
    free(workers);
    return sweep->code;
}
