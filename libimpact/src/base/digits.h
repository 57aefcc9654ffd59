/* SPDX-License-Identifier: MIT
 *
 * digits: numbers as words, for files of many rows. Internal.
 */
#ifndef IMP_DIGITS_H
#define IMP_DIGITS_H

enum { IMP_DIGITS_ROOM = 32 }; /* bytes, of the longest word and what ends it */

/* The word that printf's "%.17g" has, '.' whatever the locale; its length without the 0 that ends it. */
int imp_digits(double value, char word[IMP_DIGITS_ROOM]);

#endif
