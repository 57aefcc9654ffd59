/* SPDX-License-Identifier: MIT
 *
 * base, inside: a number in words.
 */
#ifndef IMP_NUMBER_H
#define IMP_NUMBER_H

typedef struct imp_number {
    char text[32];
} imp_number;

/* With the fewest of 15, 16 and 17 digits that give back the same bits (0.1, not 0.10000000000000001), '.' whatever the
 * locale; nan and inf as printf has them. imp_number_of(x).text lasts as long as the call it is an argument of. */
imp_number imp_number_of(double value);

/* Puts '.' for the locale's decimal point in a word of printf's. */
void imp_number_point(char *word);

#endif
