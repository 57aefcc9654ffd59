/* SPDX-License-Identifier: MIT
 *
 * bracket: a root between two places by regula falsi with the rule of Illinois (Dowell & Jarratt 1971): the value of
 * the end that stays a second time is halved. Internal.
 */
#ifndef IMP_BRACKET_H
#define IMP_BRACKET_H

#include <math.h>
#include <stdbool.h>

enum { IMP_BRACKET_MOST = 100 }; /* guesses: more than halving takes from any two doubles of a motion */

typedef struct imp_bracket {
    double low, high; /* in either order; the root is behind low and not behind high */
    double at_low, at_high;
    int side; /* which end moved last: -1 low, 1 high */
} imp_bracket;

/* Where the chord crosses zero; the middle, where that is not between the ends. An end itself: they are next to each
 * other. */
static inline double imp_bracket_guess(const imp_bracket *b)
{
    const double guess = (b->at_low * b->high - b->at_high * b->low) / (b->at_low - b->at_high);
    const bool inside = guess > fmin(b->low, b->high) && guess < fmax(b->low, b->high);
    return inside ? guess : 0.5 * (b->low + b->high);
}

/* The place and value take the end's: of high where they are beyond the root. */
static inline void imp_bracket_take(imp_bracket *b, double place, double value, bool beyond)
{
    const int side = beyond ? 1 : -1;
    if (b->side == side) *(beyond ? &b->at_low : &b->at_high) *= 0.5;
    *(beyond ? &b->high : &b->low) = place;
    *(beyond ? &b->at_high : &b->at_low) = value;
    b->side = side;
}

#endif
