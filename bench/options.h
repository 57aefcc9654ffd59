/* SPDX-License-Identifier: MIT
 *
 * What the reports read from their command lines: pairs of an option and a number.
 */
#ifndef OPTIONS_H
#define OPTIONS_H

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* Whether the arguments are pairs of one of the names (NULL at the end) and a number. */
static inline bool options_known(int argc, char **argv, const char *const *names)
{
    if (argc % 2 == 0) return false;
    for (int i = 1; i < argc; i += 2) {
        const char *const *name = names;
        while (*name && strcmp(argv[i], *name) != 0) name++;
        char *end;
        (void)strtod(argv[i + 1], &end);
        if (!*name || end == argv[i + 1] || *end != '\0') return false;
    }
    return true;
}

/* The number after the option's name; the fallback where it is not given. */
static inline double options_number(int argc, char **argv, const char *name, double fallback)
{
    for (int i = 1; i + 1 < argc; i += 2)
        if (strcmp(argv[i], name) == 0) return strtod(argv[i + 1], NULL);
    return fallback;
}

/* The same for a whole number from 0 to 2^53; -1 for any other. */
static inline long options_count(int argc, char **argv, const char *name, long fallback)
{
    const double value = options_number(argc, argv, name, (double)fallback);
    return value >= 0 && value <= 0x1p53 && value == floor(value) ? (long)value : -1;
}

#endif
