/* SPDX-License-Identifier: MIT
 *
 * floats: the caller's floating-point environment. A host may let operations trap; libimpact forms infinities and NaNs
 * that it then looks at (a root of a negative number, a quotient by zero), which must not stop it. It may round
 * otherwise than to nearest: every bound on an error of rounding is of that. Internal.
 */
#ifndef IMP_FLOATS_H
#define IMP_FLOATS_H

#include <stdbool.h>
#include <fenv.h>

typedef struct imp_floats {
    fenv_t theirs;
    bool held;
} imp_floats;

/* No traps, and rounding to nearest, until imp_floats_give_back, where it is not so; otherwise nothing is done: to ask
 * costs a few cycles, to change a hundred. */
imp_floats imp_floats_hold(void);
/* The environment as it was, its flags too. */
void imp_floats_give_back(const imp_floats *floats);

/* Whether numbers below the smallest normal one are kept: not under flush-to-zero or denormals-are-zero, in which
 * differences of unlike numbers vanish that the proofs of gaps and events rely on. */
bool imp_floats_are_gradual(void);

#endif
