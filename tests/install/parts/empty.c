/* SPDX-License-Identifier: MIT
 *
 * A program of nothing. With ANGLES it calls what axes and angles take of libm, of which glibc's archive holds one copy
 * for each kind of processor.
 */
#include <math.h>
#include <stdio.h>

int main(int count, char **arguments)
{
    (void)arguments;
#if defined(ANGLES)
    return puts(atan2(sin(count), cos(count)) > 0 ? "1" : "2") < 0;
#else
    return puts(count > 0 ? "1" : "2") < 0;
#endif
}
