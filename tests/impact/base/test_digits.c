/* SPDX-License-Identifier: MIT
 *
 * digits: the same words as printf's "%.17g", of every kind of double.
 */
#include "base/digits.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "kit/near.h"

static uint64_t state = 2026;

static uint64_t draw(void)
{
    uint64_t z = state += 0x9e3779b97f4a7c15u; /* splitmix64 */
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static double of_bits(uint64_t bits)
{
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* The tests run in the locale "C", where printf has a point. */
static void check(double value)
{
    char got[IMP_DIGITS_ROOM], wanted[64];
    const int length = imp_digits(value, got);
    snprintf(wanted, sizeof wanted, "%.17g", value);
    assert_string_equal(got, wanted);
    assert_int_equal(length, (int)strlen(wanted));
}

static void any_bits(void **test_state)
{
    (void)test_state;
    for (int i = 0; i < 50000; i++) check(of_bits(draw()));
}

/* Of the sizes that rows have, where printf is not asked. */
static void usual_sizes(void **test_state)
{
    (void)test_state;
    for (int i = 0; i < 100000; i++) {
        const uint64_t exponent = 1023 - 130 + draw() % 190;
        check(of_bits((draw() & 0x800fffffffffffffu) | exponent << 52));
    }
}

static void round_numbers(void **test_state)
{
    (void)test_state;
    static const double some[] = {0,
                                  -0.0,
                                  1,
                                  -1,
                                  0.1,
                                  0.25,
                                  1e16,
                                  1e17,
                                  99999999999999990.0,
                                  1e-4,
                                  9.9999999999999991e-5,
                                  DBL_MIN,
                                  DBL_MAX,
                                  DBL_EPSILON,
                                  4.9406564584124654e-324,
                                  INFINITY,
                                  -INFINITY};
    for (size_t i = 0; i < sizeof some / sizeof *some; i++) check(some[i]);
    for (int k = -60; k <= 60; k++) {
        char word[16];
        snprintf(word, sizeof word, "1e%d", k);
        const double power = strtod(word, NULL);
        check(power), check(nextafter(power, 0)), check(nextafter(power, INFINITY)), check(ldexp(1, k)),
            check(3 * power);
    }
}

/* Whole numbers and a half above 10^17/2, multiples of 2^-k: the digits behind the seventeenth are half of one. */
static void ties(void **test_state)
{
    (void)test_state;
    for (int i = 0; i < 2000; i++)
        for (int k = 0; k < 12; k++) check(ldexp((double)(draw() >> 11), -k - 3));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(any_bits), cmocka_unit_test(usual_sizes),
                                       cmocka_unit_test(round_numbers), cmocka_unit_test(ties)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
