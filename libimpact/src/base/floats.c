/* SPDX-License-Identifier: MIT */
#if defined(__linux__)
#define _GNU_SOURCE /* fegetexcept */
#endif
#include "base/floats.h"

#include <float.h>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

/* Doubles trap, and are rounded, in the unit that computes them. */
static bool is_unlike_ours(void)
{
#if defined(__SSE2__) && defined(__x86_64__)
    return (_mm_getcsr() & (_MM_MASK_MASK | _MM_ROUND_MASK)) != (_MM_MASK_MASK | _MM_ROUND_NEAREST);
#elif defined(__GLIBC__)
    return fegetexcept() != 0 || fegetround() != FE_TONEAREST;
#else
    return true; /* it cannot be asked */
#endif
}

imp_floats imp_floats_hold(void)
{
    imp_floats floats = {.held = is_unlike_ours()};
    if (floats.held) floats.held = feholdexcept(&floats.theirs) == 0;
    if (floats.held) fesetround(FE_TONEAREST);
    return floats;
}

void imp_floats_give_back(const imp_floats *floats)
{
    if (floats->held) fesetenv(&floats->theirs);
}

bool imp_floats_are_gradual(void)
{
    volatile double smallest = DBL_MIN, half = 0.5;
    volatile double below = smallest * half; /* 0 under flush-to-zero */
    volatile double back = below * 2;        /* 0 under denormals-are-zero */
    return below > 0 && back == smallest;
}
