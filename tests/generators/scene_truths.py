#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The motion of whole scenes in 40 digits, from the doubles that the scenes hold: tests/data/scenes/NAME.csv.

    scene_truths.py FOLDER      (needs mpmath; the answers are committed, no test runs this)

Piecewise formulas. Between events the closed form; then the least root of all event functions, bracketed to 1e-30; then
the one-contact formula of a sphere. Bounces are followed until they are slower than 1e-26 m/s, then the contact is held.

    flight      u' = F/m [in the wind] + k u,  w' = -g + k w,  q' = K q        (x, z and the spin about y)
    sliding     u' = F/m - s mu g + k u,  q' = (5/2) s mu g/r + K q            s the sign of u - r q
    rolling     u' = (5/7) (F/m + (k + (2/5) K) u) = r q'                      needs |f| <= mu m g
    impact      P = m (1 + e) |v_n|; friction min(mu P, (2/7) m |slip|) against the slip
"""
import sys
from mpmath import mp, mpf, log, exp, sqrt, sin, cos, findroot, pi

mp.dps = 40
STOP = mpf(10) ** -26


class Linear:
    """y' = a + k y from y0, and its integral from x0."""

    def __init__(self, y0, a, k, x0=mpf(0)):
        self.y0, self.a, self.k, self.x0 = y0, a, k, x0

    def y(self, t):
        if self.k == 0:
            return self.y0 + self.a * t
        return (self.y0 + self.a / self.k) * exp(self.k * t) - self.a / self.k

    def x(self, t):
        if self.k == 0:
            return self.x0 + self.y0 * t + self.a * t * t / 2
        return self.x0 + (self.y0 + self.a / self.k) * (exp(self.k * t) - 1) / self.k - self.a / self.k * t


def first_root(f, start, end, pieces=200):
    """The first t in (start, end] at which f has fallen through zero, to 1e-30; None: there is none."""
    low, f_low = start, f(start)
    for n in range(1, pieces + 1):
        high = start + (end - start) * n / pieces
        f_high = f(high)
        if f_low > 0 and f_high <= 0:
            for _ in range(200):
                middle = (low + high) / 2
                if f(middle) > 0:
                    low = middle
                else:
                    high = middle
                if high - low < mpf(10) ** -34:
                    break
            return high
        low, f_low = high, f_high
    return None


class Ball:
    """A sphere in the plane y = 0 over a floor z = 0, and before a wall x = 0."""

    def __init__(self, p):
        self.p = p
        self.t, self.x, self.z = mpf(0), p["x"], p["z"]
        self.u, self.w, self.q, self.turn = p.get("u", mpf(0)), mpf(0), mpf(0), mpf(0)
        self.mode = p.get("mode", "fly")
        self.windy = self.in_wind()
        self.k, self.K = log(1 - p["linear"]), log(1 - p["angular"])

    def in_wind(self):
        return self.p["F"] != 0 and abs(self.x - self.p["origin"]) <= self.p["reach"]

    def pull(self):
        return self.p["F"] / self.p["m"] if self.windy else mpf(0)

    def motion(self):
        """x and u, z and w, turn and q as functions of the time from now."""
        p, r, g, mu = self.p, self.p["r"], self.p["g"], self.p["mu"]
        if self.mode == "roll":
            along = Linear(self.u, mpf(5) / 7 * self.pull(), mpf(5) / 7 * (self.k + mpf(2) / 5 * self.K), self.x)
            return along, Linear(mpf(0), mpf(0), mpf(0), self.z), Linear(self.q, along.a / r, along.k, self.turn)
        if self.mode == "slide":
            s = 1 if self.u - r * self.q > 0 else -1
            return (Linear(self.u, self.pull() - s * mu * g, self.k, self.x), Linear(mpf(0), mpf(0), mpf(0), self.z),
                    Linear(self.q, mpf(5) / 2 * s * mu * g / r, self.K, self.turn))
        return (Linear(self.u, self.pull(), self.k, self.x), Linear(self.w, -g, self.k, self.z),
                Linear(self.q, mpf(0), self.K, self.turn))

    def events(self, along, up, spin):
        """Functions of the time from now that fall through zero when something happens."""
        p, r = self.p, self.p["r"]
        yield "wall", (lambda t: -r - along.x(t)) if p["wall"] else (lambda t: mpf(1))
        if self.mode == "fly":
            yield "floor", lambda t: up.x(t) - r
        if self.mode == "slide":
            s = 1 if self.u - r * self.q > 0 else -1
            yield "stick", lambda t: s * (along.y(t) - r * spin.y(t))
        if p["F"] != 0:
            sign = 1 if self.windy else -1
            yield "edge", lambda t: sign * (p["reach"] - abs(along.x(t) - p["origin"]))

    def go(self, along, up, spin, t):
        self.t += t
        self.x, self.z, self.turn = along.x(t), up.x(t), spin.x(t)
        self.u, self.w, self.q = along.y(t), up.y(t), spin.y(t)

    def strike_floor(self):
        p, r, m = self.p, self.p["r"], self.p["m"]
        self.z = r
        P = m * (1 + p["e"]) * -self.w
        slip = self.u - r * self.q
        f = min(p["mu"] * P, mpf(2) / 7 * m * abs(slip)) * (-1 if slip > 0 else 1)
        self.u += f / m
        self.q -= f / (mpf(2) / 5 * m * r)
        self.w *= -p["e"]
        if self.w < STOP:
            self.w, self.mode = mpf(0), "slide"
            if abs(self.u - r * self.q) < STOP:
                self.hold()

    def strike_wall(self):
        p, r, m = self.p, self.p["r"], self.p["m"]
        self.x = -r
        P = m * (1 + p["wall_e"]) * self.u
        slip = self.w - r * self.q
        f = min(p["wall_mu"] * P, mpf(2) / 7 * m * abs(slip)) * (-1 if slip > 0 else 1)
        self.u *= -p["wall_e"]
        self.w += f / m
        self.q -= f / (mpf(2) / 5 * m * r)
        assert self.w > 0, "the floor would answer too"
        self.mode = "fly"

    def hold(self):
        """The slip is over: does friction hold it?"""
        p = self.p
        a = mpf(5) / 7 * (self.pull() + (self.k + mpf(2) / 5 * self.K) * self.u)
        f = mpf(2) / 5 * p["m"] * (self.K * self.u - a)
        assert abs(f) <= p["mu"] * p["m"] * p["g"], "it would slide on"
        self.q, self.mode = self.u / p["r"], "roll"

    def run(self, times):
        rows = []
        for i, goal in enumerate(times):
            while self.t < goal:
                laws = self.motion()
                left, first, what = goal - self.t, goal - self.t, None
                for name, f in self.events(*laws):
                    start, end = mpf(0), left
                    if name == "floor" and self.w > 0 and self.z == self.p["r"]:  # it left just now: it is back within three times its rise
                        start, end = min(self.w / self.p["g"], left), min(3 * self.w / self.p["g"], left)
                    if name == "edge" or (name == "wall" and self.u <= 0):
                        start = min(mpf(10) ** -12, left)
                    root = first_root(f, start, end)
                    if root is not None and root < first:
                        first, what = root, name
                self.go(*laws, first)
                if what and "-v" in sys.argv:
                    print(float(self.t), what, float(self.x), float(self.u), float(self.w), float(self.q), self.mode)
                if what == "floor":
                    self.strike_floor()
                elif what == "wall":
                    self.strike_wall()
                elif what == "stick":
                    self.hold()
                elif what == "edge":
                    self.windy = not self.windy
                    if self.mode == "roll":
                        self.hold()
                else:
                    self.t = goal
            half = self.turn / 2
            rows.append([goal, "NAME", self.x, 0, self.z, cos(half), 0, sin(half), 0, self.u, 0, self.w, 0, self.q, 0])
        return rows


def times_of(duration, count=48):
    """None is near an event: odd parts of the duration, as doubles."""
    return [mpf(float(mpf(duration) * (k + mpf("0.437")) / count)) for k in range(count)]


def sphere_wall():
    friction, bounce = mpf(0.25), mpf(0.3)
    p = dict(x=mpf(-3), z=mpf(1), r=mpf(0.3), m=mpf(4), g=mpf(9.81), F=mpf(25), origin=mpf(-3), reach=mpf(2), linear=mpf(0.04),
             angular=mpf(0.848), e=bounce, mu=friction * friction, wall=True, wall_e=mpf(0.3 * 0.3), wall_mu=friction * friction)
    return "sphere", Ball(p).run(times_of(3.75))


def bowling_ball():
    p = dict(x=mpf(0), z=mpf(0.108), r=mpf(0.108), m=mpf(6.8), g=mpf(9.81), F=mpf(0), origin=mpf(0), reach=mpf(1), linear=mpf(0),
             angular=mpf(0), e=mpf(0), mu=mpf(0.12), wall=False, u=mpf(8), mode="slide")
    return "ball", Ball(p).run(times_of(4))


def damped_ball():
    """Thrown along the floor: bounces until they die out, slides and rolls, through air that brakes motion and spin."""
    p = dict(x=mpf(0), z=mpf(1), r=mpf(0.1), m=mpf(1), g=mpf(9.81), F=mpf(0), origin=mpf(0), reach=mpf(1), linear=mpf(0.3),
             angular=mpf(0.5), e=mpf(0.6), mu=mpf(0.2), wall=False, u=mpf(4))
    with mp.workdps(80):  # the last bounces are 1e-53 m high, beside a radius of .1 m
        return "ball", Ball(p).run(times_of(4))


def orbit():
    """Two of half a kilogram about each other, G = 1: e = 0.3, semi-axis 1, period 2 pi; the planet's state."""
    e, rows = mpf(0.3), []
    near = mpf(1 - 0.3)
    speed = mpf(1.3627702877384937)  # sqrt(1.3/0.7) as the scene holds it
    v0 = speed / 2
    energy = speed * speed / 2 - 1 / near
    a = -1 / (2 * energy)
    e = 1 - near / a
    n = sqrt(1 / a ** 3)
    drift = mpf(0)
    for t in times_of(6.283185307179586):
        M = n * t
        E = findroot(lambda E: E - e * sin(E) - M, M)
        x, y = a * (cos(E) - e), a * sqrt(1 - e * e) * sin(E)
        rate = n / (1 - e * cos(E))
        vx, vy = -a * sin(E) * rate, a * sqrt(1 - e * e) * cos(E) * rate
        for name, s in (("sun", -mpf(1) / 2), ("planet", mpf(1) / 2)):
            rows.append([t, name, near / 2 + s * x, s * y + drift, 0, 1, 0, 0, 0, s * vx, s * vy, 0, 0, 0, 0])
    return None, rows


def write(folder, name, answer):
    body, rows = answer
    with open(f"{folder}/{name}.csv", "w") as file:
        file.write("# tests/generators/scene_truths.py: 40 digits, rounded to doubles\n")
        file.write("t,body,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n")
        for row in rows:
            cells = [body or value if i == 1 else repr(float(value)) for i, value in enumerate(row)]
            file.write(",".join(cells) + "\n")


if __name__ == "__main__":
    for scene in (sphere_wall, bowling_ball, damped_ball, orbit):
        write(sys.argv[1], scene.__name__, scene())
