/* SPDX-License-Identifier: MIT */
#define _XOPEN_SOURCE 700
#include "runner.h"

#include <signal.h>
#include <stdlib.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

void *impact_runner_allocate(void *context, void *block, size_t old_size, size_t new_size)
{
    impact_runner *runner = context;
    if (!block) old_size = 0; /* then it tells the kind of object */
    if (new_size == 0) {
        runner->memory -= old_size;
        free(block);
        return NULL;
    }
    const size_t others = runner->memory - old_size;
    if (runner->max_memory && new_size > old_size &&
        (others > runner->max_memory || new_size > runner->max_memory - others)) {
        runner->memory_refused = true;
        return NULL;
    }
    void *moved = realloc(block, new_size);
    if (moved) runner->memory = others + new_size;
    return moved;
}

double impact_runner_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* A signal handler has no other way to tell. */
static volatile sig_atomic_t time_is_over = 0;

static void on_alarm(int signal_number)
{
    static const char message[] = "\nimpact: time limit reached, and the script did not stop\n";
    (void)signal_number;
    if (time_is_over) {
        const ssize_t written = write(STDERR_FILENO, message, sizeof message - 1);
        _exit(written >= 0 ? IMPACT_EXIT_LIMIT : IMPACT_EXIT_LIMIT);
    }
    time_is_over = 1;
}

bool impact_runner_time_is_over(void) { return time_is_over != 0; }

static volatile sig_atomic_t interrupted = 0;

/* The first one stops in order; another, a second later, ends the process: some senders tell both it and its group. */
static void on_interrupt(int signal_number)
{
    static volatile time_t first = 0;
    (void)signal_number;
    if (!interrupted) first = time(NULL);
    if (interrupted && time(NULL) - first > 1) _exit(IMPACT_EXIT_INTERRUPTED);
    interrupted = 1;
}

bool impact_runner_is_interrupted(void) { return interrupted != 0; }

/* Inherited by coroutines. Once it is to end it fires at every instruction, so that no pcall can hold it. */
static void on_count(lua_State *L, lua_Debug *info)
{
    (void)info;
    if (!time_is_over && !interrupted) return;
    lua_sethook(L, on_count, LUA_MASKCOUNT, 1);
    luaL_error(L, interrupted ? "interrupted" : "time limit reached");
}

void impact_runner_start_clock(lua_State *L, const impact_runner *runner)
{
    const struct sigaction interrupt = {.sa_handler = on_interrupt};
    struct sigaction before; /* nohup and background jobs ignore it */
    if (sigaction(SIGINT, NULL, &before) == 0 && before.sa_handler != SIG_IGN) sigaction(SIGINT, &interrupt, NULL);
    sigaction(SIGTERM, &interrupt, NULL);
    lua_sethook(L, on_count, LUA_MASKCOUNT, 1000);
    if (!(runner->max_time > 0)) return;
    const struct sigaction action = {.sa_handler = on_alarm};
    const double whole = (double)(long)runner->max_time;
    struct itimerval timer = {.it_interval = {1, 0},
                              .it_value = {(time_t)whole, (suseconds_t)((runner->max_time - whole) * 1e6)}};
    if (timer.it_value.tv_sec == 0 && timer.it_value.tv_usec == 0) timer.it_value.tv_usec = 1;
    sigaction(SIGALRM, &action, NULL);
    setitimer(ITIMER_REAL, &timer, NULL);
}
