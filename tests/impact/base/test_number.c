/* SPDX-License-Identifier: MIT
 *
 * A number in words: the same bits come back, no shorter word of printf's gives them, and no locale has its way.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/number.h"
#include "kit/contact_random.h"

static void known_words(void **state)
{
    (void)state;
    static const struct {
        double value;
        const char *word;
    } known[] = {{0.1, "0.1"},
                 {-2.5, "-2.5"},
                 {1, "1"},
                 {1e300, "1e+300"},
                 {5e-324, "4.94065645841247e-324"},
                 {0.1 + 0.2, "0.30000000000000004"},
                 {1.0 / 3, "0.3333333333333333"},
                 {INFINITY, "inf"}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        assert_string_equal(imp_number_of(known[i].value).text, known[i].word);
    assert_non_null(strstr(imp_number_of(NAN).text, "nan"));
}

static void the_same_bits_by_the_fewest_digits(void **state)
{
    (void)state;
    random_stream random = {5};
    int long_ones = 0;
    for (int i = 0; i < 100000; i++) {
        const double few = floor(1e6 * random_unit(&random)) * 1e-5;
        const double value = i % 2 ? few : ldexp(random_unit(&random) - 0.5, (int)(2000 * random_unit(&random)) - 1000);
        const imp_number number = imp_number_of(value);
        assert_true(strtod(number.text, NULL) == value);
        int digits = 0; /* that count: those from the first that is not 0 */
        for (const char *c = number.text; *c && *c != 'e'; c++)
            digits += (*c > '0' && *c <= '9') || (*c == '0' && digits > 0);
        if (digits <= 15) continue;
        char shorter[400];
        snprintf(shorter, sizeof shorter, "%.*g", digits - 1, value);
        assert_true(strtod(shorter, NULL) != value);
        long_ones++;
    }
    assert_true(long_ones > 10000);
}

/* "de_DE" and its like have a comma, ps_AF a point of two bytes; where none is installed nothing is asked. */
static void a_point_in_every_locale(void **state)
{
    (void)state;
    static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "ps_AF.UTF-8", "C"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (!setlocale(LC_NUMERIC, names[i])) continue;
        const imp_number number = imp_number_of(-1.25e-7);
        setlocale(LC_NUMERIC, "C");
        assert_string_equal(number.text, "-1.25e-07");
    }
    char two_bytes[32] = "1\xd9\xab"
                         "5e+20",
         whole[32] = "15", comma[32] = "-0,5";
    imp_number_point(two_bytes);
    imp_number_point(whole);
    imp_number_point(comma);
    assert_string_equal(two_bytes, "1.5e+20");
    assert_string_equal(whole, "15");
    assert_string_equal(comma, "-0.5");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(known_words),
        cmocka_unit_test(the_same_bits_by_the_fewest_digits),
        cmocka_unit_test(a_point_in_every_locale),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
