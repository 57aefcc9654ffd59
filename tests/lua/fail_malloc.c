/* SPDX-License-Identifier: MIT
 *
 * For LD_PRELOAD: of the process's allocations number FAIL_AT fails, and all after it unless FAIL_ONCE is set;
 * FAIL_COUNT puts their number on stderr at the end. For this process alone, not for those that it starts.
 */
#include <stdio.h>
#include <stdlib.h>

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *block, size_t size);

static long count, fail_at;
static int once, ready;

static int fails(void)
{
    if (!ready) {
        const char *at = getenv("FAIL_AT");
        ready = 1;
        fail_at = at ? atol(at) : 0;
        once = getenv("FAIL_ONCE") != NULL;
    }
    count++;
    return fail_at > 0 && (once ? count == fail_at : count >= fail_at);
}

void *malloc(size_t size) { return fails() ? NULL : __libc_malloc(size); }
void *calloc(size_t number, size_t size) { return fails() ? NULL : __libc_calloc(number, size); }
void *realloc(void *block, size_t size) { return fails() ? NULL : __libc_realloc(block, size); }

__attribute__((constructor)) static void keep_to_myself(void) { unsetenv("LD_PRELOAD"); }

__attribute__((destructor)) static void tell(void)
{
    const long total = count;
    if (getenv("FAIL_COUNT")) fprintf(stderr, "%ld\n", total);
}
