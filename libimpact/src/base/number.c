/* SPDX-License-Identifier: MIT */
#include "base/number.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void imp_number_point(char *word)
{
    char *point = word + strspn(word, "+-0123456789einfa");
    const size_t size = strcspn(point, "0123456789e"); /* the locale's may be several bytes */
    if (size == 0) return;
    memmove(point + 1, point + size, strlen(point + size) + 1);
    *point = '.';
}

imp_number imp_number_of(double value)
{
    imp_number number;
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(number.text, sizeof number.text, "%.*g", digits, value);
        if (strtod(number.text, NULL) == value) break;
    }
    imp_number_point(number.text);
    return number;
}
