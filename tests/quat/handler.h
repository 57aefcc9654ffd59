/* SPDX-License-Identifier: MIT
 *
 * GSL's error handler, which by default ends the program, counts here how often it is called: never, it should be.
 */
#ifndef QUAT_TEST_HANDLER_H
#define QUAT_TEST_HANDLER_H

#include <gsl/gsl_errno.h>

static int handled;
static void count_call(const char *reason, const char *file, int line, int error)
{
    (void)reason, (void)file, (void)line, (void)error;
    handled++;
}

#endif
