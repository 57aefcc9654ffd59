/* SPDX-License-Identifier: MIT
 *
 * Of a double m 2^e, m a whole number of 53 bits, the 17 digits are the whole number nearest to
 *
 *     N = m 2^e 10^k = m 5^k 2^(e + k),    k so that 10^16 <= N < 10^17,
 *
 * ties to even. For k from 0 to 54, which is 1e-38 to 1e17, 5^k are two words of 64 bits, m 5^k three, and N comes by a
 * shift: exact. What is larger or smaller goes by printf.
 */
#include "base/digits.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { DIGITS = 17, MOST_FIVES = 27 }; /* 5^27 < 2^63 */

static const uint64_t least = 10000000000000000u, most = 100000000000000000u; /* of N */

static uint64_t power_of_five(int k)
{
    static const uint64_t fives[MOST_FIVES + 1] = {1u,
                                                   5u,
                                                   25u,
                                                   125u,
                                                   625u,
                                                   3125u,
                                                   15625u,
                                                   78125u,
                                                   390625u,
                                                   1953125u,
                                                   9765625u,
                                                   48828125u,
                                                   244140625u,
                                                   1220703125u,
                                                   6103515625u,
                                                   30517578125u,
                                                   152587890625u,
                                                   762939453125u,
                                                   3814697265625u,
                                                   19073486328125u,
                                                   95367431640625u,
                                                   476837158203125u,
                                                   2384185791015625u,
                                                   11920928955078125u,
                                                   59604644775390625u,
                                                   298023223876953125u,
                                                   1490116119384765625u,
                                                   7450580596923828125u};
    return fives[k];
}

/* Three words, the lowest first. */
typedef struct wide {
    uint64_t w[3];
} wide;

/* a b + carry: the low word, and the high one in *carry. */
static inline uint64_t multiply(uint64_t a, uint64_t b, uint64_t *carry)
{
    const uint64_t half = 0xffffffffu, a0 = a & half, a1 = a >> 32, b0 = b & half, b1 = b >> 32;
    const uint64_t low = a0 * b0, one = a1 * b0 + (low >> 32), other = a0 * b1 + (one & half);
    const uint64_t product = (other << 32) | (low & half), sum = product + *carry;
    *carry = a1 * b1 + (one >> 32) + (other >> 32) + (sum < product);
    return sum;
}

/* m 5^k; m has 53 bits. */
static inline wide scaled(uint64_t m, int k)
{
    wide a = {{0, 0, 0}};
    a.w[0] = multiply(m, power_of_five(k < MOST_FIVES ? k : MOST_FIVES), &a.w[1]);
    if (k <= MOST_FIVES) return a;
    uint64_t carry = 0;
    for (int i = 0; i < 2; i++) a.w[i] = multiply(a.w[i], power_of_five(k - MOST_FIVES), &carry);
    a.w[2] = carry;
    return a;
}

/* a 2^shift as the nearest whole number, ties to even; it fits into a word. */
static inline uint64_t shifted(wide a, int shift)
{
    if (shift >= 0) return a.w[0] << shift;
    const int down = -shift, word = down / 64, rest = down % 64;
    if (word > 2) return 0; /* below a half */
    const uint64_t part = ((uint64_t)1 << rest) - 1, high = word < 2 ? a.w[word + 1] : 0;
    uint64_t below = 0, half, left = a.w[word] & part; /* of what is cut off: the first bit, and the others */
    for (int i = 0; i < word; i++) below |= a.w[i];
    if (rest > 0) {
        half = left >> (rest - 1);
        left &= part >> 1;
    } else {
        half = word > 0 ? a.w[word - 1] >> 63 : 0;
        left = word > 0 ? a.w[word - 1] << 1 : 0;
        below = word > 1 ? a.w[0] : 0;
    }
    const uint64_t n = rest > 0 ? a.w[word] >> rest | high << (64 - rest) : a.w[word];
    return n + (half && (left || below || (n & 1)));
}

/* The digits of m 2^e and the power of ten of the first; false: out of range. */
static bool find_digits(uint64_t m, int e, int power, uint64_t *n, int *first)
{
    for (int tries = 0; tries < 3; tries++) {
        const int k = DIGITS - 1 - power;
        if (k < 0 || k > 2 * MOST_FIVES) return false;
        *n = shifted(scaled(m, k), e + k);
        *first = power;
        if (*n >= least && *n < most) return true;
        power += *n < least ? -1 : 1;
    }
    return false;
}

/* The last eight digits of n, from the front. */
static void put_eight(uint32_t n, char *digit)
{
    static const char pairs[] =
        "0001020304050607080910111213141516171819202122232425262728293031323334353637383940414243444546474849"
        "5051525354555657585960616263646566676869707172737475767778798081828384858687888990919293949596979899";
    const uint32_t high = n / 10000, low = n % 10000;
    memcpy(digit, pairs + 2 * (high / 100), 2);
    memcpy(digit + 2, pairs + 2 * (high % 100), 2);
    memcpy(digit + 4, pairs + 2 * (low / 100), 2);
    memcpy(digit + 6, pairs + 2 * (low % 100), 2);
}

/* As %g does: without zeros at the end; with an exponent below 1e-4 and from 1e17 on. */
static int put_digits(uint64_t n, int power, bool negative, char *word)
{
    const uint32_t eight = 100000000;
    char digit[DIGITS];
    int count = DIGITS;
    char *end = word;
    digit[0] = (char)('0' + n / least);
    put_eight((uint32_t)(n % least / eight), digit + 1);
    put_eight((uint32_t)(n % eight), digit + 9);
    while (count > 1 && digit[count - 1] == '0') count--;
    if (negative) *end++ = '-';
    const bool plain = power >= -4;
    if (plain && power < 0) {
        *end++ = '0', *end++ = '.';
        for (int i = -1; i > power; i--) *end++ = '0';
    }
    const int whole = !plain ? 1 : power < 0 ? 0 : power + 1; /* digits before the point */
    const int before = count < whole ? count : whole;
    memcpy(end, digit, (size_t)before);
    end += before;
    for (int i = count; i < whole; i++) *end++ = '0';
    if (count > whole && whole > 0) *end++ = '.';
    if (count > whole) memcpy(end, digit + whole, (size_t)(count - whole)), end += count - whole;
    if (!plain) end += sprintf(end, "e-%02d", -power);
    *end = '\0';
    return (int)(end - word);
}

static int by_printf(double value, char *word)
{
    snprintf(word, IMP_DIGITS_ROOM, "%.17g", value);
    char *point = word + strspn(word, "+-0123456789einfa");
    const size_t size = strcspn(point, "0123456789e"); /* of the locale's decimal point, which may be several bytes */
    if (size > 0) {
        memmove(point + 1, point + size, strlen(point + size) + 1);
        *point = '.';
    }
    return (int)strlen(word);
}

int imp_digits(double value, char word[IMP_DIGITS_ROOM])
{
    uint64_t bits, n;
    int first;
    if (value == 0) return strcpy(word, signbit(value) ? "-0" : "0"), (int)strlen(word);
    memcpy(&bits, &value, sizeof bits);
    const int exponent = (int)(bits >> 52 & 0x7ff);
    if (exponent == 0 || exponent == 0x7ff) return by_printf(value, word);
    const uint64_t m = (bits & 0xfffffffffffffu) | 0x10000000000000u;
    const int log10_of_two = 78913, places = 18, bias = 400; /* times 2^18; a shift of what is not negative */
    const int guess = (((exponent - 1023) * log10_of_two + (bias << places)) >> places) - bias;
    if (!find_digits(m, exponent - 1075, guess, &n, &first)) return by_printf(value, word);
    return put_digits(n, first, bits >> 63, word);
}
