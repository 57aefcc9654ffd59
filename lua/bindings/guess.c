/* SPDX-License-Identifier: MIT */
#include "guess.h"

#include <limits.h>
#include <stdbool.h>
#include <string.h>

static int least(int a, int b) { return a < b ? a : b; }

/* Edit distance with swaps of neighbours (optimal string alignment); words over 31 letters count as far. */
static int distance(const char *a, const char *b)
{
    enum { LONGEST = 31 };
    int d[LONGEST + 1][LONGEST + 1];
    const int m = (int)strlen(a), n = (int)strlen(b);
    if (m > LONGEST || n > LONGEST) return INT_MAX;
    for (int i = 0; i <= m; i++) d[i][0] = i;
    for (int j = 0; j <= n; j++) d[0][j] = j;
    for (int i = 1; i <= m; i++) {
        for (int j = 1; j <= n; j++) {
            const int change = a[i - 1] != b[j - 1];
            d[i][j] = least(least(d[i - 1][j] + 1, d[i][j - 1] + 1), d[i - 1][j - 1] + change);
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                d[i][j] = least(d[i][j], d[i - 2][j - 2] + 1);
        }
    }
    return d[m][n];
}

/* Whether the word is nothing but that letter, held too long: "rr" for "r". */
static bool is_run(const char *word, const char *letter) { return *word && word[strspn(word, letter)] == '\0'; }

/* Of two that are as near, the shorter one, then the first by the alphabet: a table has no order. */
static bool comes_before(const char *a, const char *b)
{
    const size_t m = strlen(a), n = strlen(b);
    return m < n || (m == n && strcmp(a, b) < 0);
}

const char *quat_lua_guess(const char *given, const char *const keys[])
{
    const char *best = NULL;
    int best_distance = INT_MAX;
    for (int i = 0; keys[i]; i++) {
        const int d = distance(given, keys[i]);
        if (d == INT_MAX) continue; /* too long to be one */
        const bool begins =
            given[0] == keys[i][0] && 2 * d <= (int)strlen(given); /* words are known by their beginnings */
        const bool near = strlen(keys[i]) == 1 ? is_run(given, keys[i]) : begins || 3 * d <= (int)strlen(keys[i]) + 1;
        const bool nearer = d < best_distance || (best && d == best_distance && comes_before(keys[i], best));
        if (nearer && near) best = keys[i], best_distance = d;
    }
    return best;
}
