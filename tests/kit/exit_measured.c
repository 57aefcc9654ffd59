/* SPDX-License-Identifier: MIT
 *
 * For builds that measure coverage with gcc (-Wl,--wrap=_exit): a process that ends by _exit leaves its counts, too;
 * what these allocate is not refused (lua/fail_malloc.c).
 */
#define _GNU_SOURCE
#include <dlfcn.h>

void __gcov_dump(void);
_Noreturn void __real__exit(int status);
_Noreturn void __wrap__exit(int status);

void __wrap__exit(int status)
{
    void (*const grant_the_rest)(void) = (void (*)(void))dlsym(RTLD_DEFAULT, "fail_malloc_end");
    if (grant_the_rest) grant_the_rest();
    __gcov_dump();
    __real__exit(status);
}
