# SPDX-License-Identifier: MIT
"""What scene_truths.py needs of bodies in space: vectors, quaternions, and smooth stretches of motion in many digits.

A stretch y' = f(t, y) is followed by Gragg's midpoint rule, extrapolated in the square of the step (Bulirsch and Stoer):
COLUMNS columns over pieces of a length that leaves less than 1e-32; scene_truths.py checks that by pieces of half.
"""
from mpmath import mpf, sqrt

COLUMNS = 12


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def add(a, b, s=1):
    """a + s b."""
    return [x + s * y for x, y in zip(a, b)]


def scale(a, s):
    return [x * s for x in a]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def norm(a):
    return sqrt(dot(a, a))


def product(p, q):
    w = p[0] * q[0] - dot(p[1:], q[1:])
    return [w] + add(add(scale(q[1:], p[0]), p[1:], q[0]), cross(p[1:], q[1:]))


def turn(q, v):
    """v by the rotation of the unit q; back: turn(conjugate(q), v)."""
    return product(product(q, [mpf(0)] + v), conjugate(q))[1:]


def conjugate(q):
    return [q[0], -q[1], -q[2], -q[3]]


def unit(q):
    return scale(q, 1 / norm(q))


def midpoints(f, t, y, h, n):
    """Gragg's rule over h in n steps, n even."""
    s = h / n
    before, now = y, add(y, f(t, y), s)
    for i in range(1, n):
        before, now = now, add(before, f(t + i * s, now), 2 * s)
    return scale(add(add(before, now), f(t + h, now), s), mpf(1) / 2)


def advance(f, t, y, h, piece):
    """y at t + h."""
    count = max(1, int(abs(h) / piece) + 1)
    for i in range(count):
        s = h / count
        table = []
        for k in range(COLUMNS):
            row = [midpoints(f, t + i * s, y, s, 2 * (k + 1))]
            for j in range(k):
                ratio = (mpf(k + 1) / (k - j)) ** 2
                row.append(add(row[j], add(row[j], table[j], -1), 1 / (ratio - 1)))
            table = row
        y = table[-1]
    return y
