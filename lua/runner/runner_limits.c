/* SPDX-License-Identifier: MIT */
#define _XOPEN_SOURCE 700
#include "runner.h"

#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

/* ---- memory ---- */

/* Whether `more` bytes may be held beside `others`. */
static bool allowed(impact_runner *runner, size_t others, size_t more)
{
    const bool within = !runner->max_memory || (others <= runner->max_memory && more <= runner->max_memory - others);
    runner->memory_refused = runner->memory_refused || !within;
    return within;
}

void *impact_runner_allocate(void *context, void *block, size_t old_size, size_t new_size)
{
    impact_runner *runner = context;
    if (!block) old_size = 0; /* then it tells the kind of object */
    const size_t others = runner->memory - old_size;
    if (new_size == 0) {
        runner->memory = others;
        free(block);
        return NULL;
    }
    if (new_size > old_size && !allowed(runner, others, new_size)) return NULL;
    void *moved = realloc(block, new_size);
    if (moved) runner->memory = others + new_size;
    return moved;
}

static void *allocate_piece(size_t size, void *context)
{
    impact_runner *runner = context;
    void *piece = allowed(runner, runner->memory, size) ? malloc(size) : NULL;
    if (piece) runner->memory += size;
    return piece;
}

static void release_piece(void *piece, size_t size, void *context)
{
    ((impact_runner *)context)->memory -= size;
    free(piece);
}

/* What the process has mapped, bytes; 0: not known. */
static size_t mapped(void)
{
    unsigned long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (file && fscanf(file, "%lu", &pages) != 1) pages = 0;
    if (file) fclose(file);
    return (size_t)pages * (size_t)sysconf(_SC_PAGESIZE);
}

void impact_runner_limit_memory(impact_runner *runner)
{
    runner->allocator = (impact_allocator){.allocate = allocate_piece, .release = release_piece, .context = runner};
    const size_t there = mapped();
    struct rlimit limit;
#if !defined(__SANITIZE_ADDRESS__) /* which maps terabytes */
    if (runner->max_memory && there > 0 && getrlimit(RLIMIT_AS, &limit) == 0) {
        const rlim_t most = (rlim_t)runner->max_memory + there + ((rlim_t)64 << 20);
        if (limit.rlim_max == RLIM_INFINITY || most < limit.rlim_max) limit.rlim_cur = most;
        setrlimit(RLIMIT_AS, &limit);
    }
#else
    (void)there;
#endif
    if (getrlimit(RLIMIT_CORE, &limit) == 0) limit.rlim_cur = 0, setrlimit(RLIMIT_CORE, &limit);
}

/* ---- time ---- */

double impact_runner_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* ---- what ends the process ---- */

/* A signal handler has no other way to tell. */
static volatile sig_atomic_t time_is_over = 0, signal_seen = 0;

static int guarded_folder = -1;
static char guarded[2][256];

void impact_runner_guard(const impact_runner *runner, const char *name)
{
    guarded_folder = runner->folder;
    snprintf(guarded[0], sizeof guarded[0], "%s.csv.part", name);
    snprintf(guarded[1], sizeof guarded[1], "%s_events.csv.part", name);
}

static void end_at_once(int code, const char *message, size_t length)
{
    for (int i = 0; i < 2; i++)
        if (guarded[i][0]) unlinkat(guarded_folder, guarded[i], 0);
    const ssize_t written = write(STDERR_FILENO, message, length);
    _exit(written >= 0 ? code : code);
}

static void on_alarm(int signal_number)
{
    static const char message[] = "\nimpact: time limit reached, and the script did not stop\n";
    (void)signal_number;
    if (time_is_over) end_at_once(IMPACT_EXIT_LIMIT, message, sizeof message - 1);
    time_is_over = 1;
}

bool impact_runner_time_is_over(void) { return time_is_over != 0; }

/* The first one stops in order; another, a second later, ends the process: some senders tell both it and its group. */
static void on_signal(int signal_number)
{
    static const char message[] = "\nimpact: ended by a second signal, before the run could stop in order\n";
    static volatile time_t first = 0;
    if (!signal_seen) first = time(NULL);
    if (signal_seen && time(NULL) - first > 1)
        end_at_once(IMPACT_EXIT_SIGNAL + signal_number, message, sizeof message - 1);
    signal_seen = signal_number;
}

int impact_runner_signal(void) { return signal_seen; }

/* Inherited by coroutines. Once it is to end it fires at every instruction, so that no pcall can hold it. */
static void on_count(lua_State *L, lua_Debug *info)
{
    (void)info;
    if (!time_is_over && !signal_seen) return;
    lua_sethook(L, on_count, LUA_MASKCOUNT, 1);
    luaL_error(L, signal_seen ? "interrupted" : "time limit reached");
}

void impact_runner_watch(lua_State *L) { lua_sethook(L, on_count, LUA_MASKCOUNT, 1000); }

/* Of this thread. A count hook makes each of Lua's instructions several times as dear (2 % of a run of a millisecond),
 * so that a thread's state has one only when it is to end: set by a signal that the thread itself takes, as lua.c does.
 */
static _Thread_local lua_State *thread_state;

static void on_stop(int signal_number)
{
    (void)signal_number;
    if (thread_state) lua_sethook(thread_state, on_count, LUA_MASKCOUNT, 1);
}

void impact_runner_watch_thread(lua_State *L)
{
    const struct sigaction action = {.sa_handler = on_stop};
    sigaction(SIGUSR1, &action, NULL);
    thread_state = L;
}

void impact_runner_stop_thread(pthread_t thread) { pthread_kill(thread, SIGUSR1); }

void impact_runner_start_clock(const impact_runner *runner)
{
    static const int signals[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT};
    const struct sigaction to_end = {.sa_handler = on_signal}, ignored = {.sa_handler = SIG_IGN};
    struct sigaction before; /* nohup and background jobs ignore some */
    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++)
        if (sigaction(signals[i], NULL, &before) == 0 && before.sa_handler != SIG_IGN)
            sigaction(signals[i], &to_end, NULL);
    sigaction(SIGXFSZ, &ignored, NULL); /* a file that has grown too large is told where it is written */
    sigaction(SIGPIPE, &ignored, NULL); /* so is a reader that went away */
    if (!(runner->max_time > 0)) return;
    const struct sigaction action = {.sa_handler = on_alarm};
    const double whole = (double)(long)runner->max_time;
    struct itimerval timer = {.it_interval = {1, 0},
                              .it_value = {(time_t)whole, (suseconds_t)((runner->max_time - whole) * 1e6)}};
    if (timer.it_value.tv_sec == 0 && timer.it_value.tv_usec == 0) timer.it_value.tv_usec = 1;
    sigaction(SIGALRM, &action, NULL);
    setitimer(ITIMER_REAL, &timer, NULL);
}
