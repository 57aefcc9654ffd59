/* SPDX-License-Identifier: MIT
 *
 * Figures that a test has measured, which pages quote (docs/values.csv): lines of a name, a value and, where the test
 * asserts one, a bound. With TEST_SHOW=1 they are printed, else written to the file that TEST_SHOW names.
 */
#ifndef KIT_FIGURES_H
#define KIT_FIGURES_H

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static inline FILE *figures_out(void)
{
    static FILE *file;
    static bool asked;
    const char *where = asked ? NULL : getenv("TEST_SHOW");
    asked = true;
    if (where) file = strcmp(where, "1") == 0 ? stdout : fopen(where, "w");
    return file;
}

static inline void show_figure(const char *name, double value)
{
    if (figures_out()) fprintf(figures_out(), "%-44s %10.3g\n", name, value);
}

static inline void show_bounded(const char *name, double value, double bound)
{
    if (figures_out()) fprintf(figures_out(), "%-44s %10.3g  (bound %g)\n", name, value, bound);
}

#endif
