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
from mpmath import mp, mpf, log, exp, sqrt, sin, cos, findroot

from scene_bodies import add, advance, conjugate, cross, dot, norm, product, scale, turn, unit

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


def first_root(f, start, end, pieces=200, halves=True):
    """The first t in (start, end] at which f has fallen through zero, to 1e-30; None: there is none. By halves, or, of a smooth f
    that takes long, by Ridder's method."""
    low, f_low = start, f(start)
    for n in range(1, pieces + 1):
        high = start + (end - start) * n / pieces
        f_high = f(high)
        if f_low > 0 and f_high <= 0 and not halves:
            return findroot(f, (low, high), solver="ridder", tol=mpf(10) ** (20 - 2 * mp.dps))
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


class Sphere:
    """One of equal spheres over the floor z = r, in a wind F x of its own while |x - origin| <= reach.

    On the floor the slip s = v + r z x w (level) of a sphere that slides brakes: f = -mu m g s/|s|; v' = (F + f)/m,
    w' = -(5/(2 m r)) z x f. When s is nothing it rolls: no wind is there any more.
    """

    PIECE = mpf(1) / 64

    def __init__(self, p, x, F):
        self.p, self.F, self.origin = p, F, x[0]
        self.x, self.v, self.w, self.q = x, [mpf(0)] * 3, [mpf(0)] * 3, [mpf(1), mpf(0), mpf(0), mpf(0)]
        self.mode, self.windy = "fly", True

    def slip(self, v, w):
        return [v[0] - self.p["r"] * w[1], v[1] + self.p["r"] * w[0], mpf(0)]

    def accelerations(self, v, w):
        """Of the centre, and of the turning."""
        p, a, turning = self.p, [self.F / self.p["m"] if self.windy else mpf(0), mpf(0), mpf(0)], [mpf(0)] * 3
        if self.mode == "fly":
            a[2] = -p["g"]
        if self.mode == "slide":
            s = self.slip(v, w)
            f = scale(s, -p["mu"] * p["g"] / norm(s))
            a, turning = add(a, f), scale([-f[1], f[0], mpf(0)], -mpf(5) / (2 * p["r"]))
        return a, turning

    def rates(self, t, y):
        v, w, q = y[3:6], y[6:9], y[9:13]
        a, turning = self.accelerations(v, w)
        return v + a + turning + scale(product([mpf(0)] + w, q), mpf(1) / 2)

    def where(self, t):
        """The centre, its velocity and the turning so long after now: formulas, where the slip does not change its direction."""
        if self.mode == "slide" and self.windy:
            y = advance(self.rates, mpf(0), self.x + self.v + self.w + self.q, t, self.PIECE)
            return y[0:3], y[3:6], y[6:9]
        a, turning = self.accelerations(self.v, self.w)
        return add(add(self.x, self.v, t), a, t * t / 2), add(self.v, a, t), add(self.w, turning, t)

    def at(self, t):
        """All of its state."""
        x, v, w = self.where(t)
        if self.mode == "slide" and self.windy:
            return advance(self.rates, mpf(0), self.x + self.v + self.w + self.q, t, self.PIECE)
        _, turning = self.accelerations(self.v, self.w)
        if norm(turning) > 0:

            def turn_on(s, q):
                return scale(product([mpf(0)] + add(self.w, turning, s), q), mpf(1) / 2)
            return x + v + w + advance(turn_on, mpf(0), self.q, t, self.PIECE)
        rate = norm(self.w)
        half = rate * t / 2
        return x + v + w + (product([cos(half)] + scale(self.w, sin(half) / rate), self.q) if rate != 0 else self.q)

    def set(self, y):
        self.x, self.v, self.w, self.q = y[0:3], y[3:6], y[6:9], unit(y[9:13])

    def events(self, left):
        """Times from now at which something of its own happens, with what."""
        p = self.p
        if self.mode == "fly":
            w, h = self.v[2], self.x[2] - p["r"]
            yield (w + sqrt(w * w + 2 * p["g"] * h)) / p["g"], "floor"
        if self.mode == "slide" and not self.windy:
            yield norm(self.slip(self.v, self.w)) / (mpf(7) / 2 * p["mu"] * p["g"]), "stick"
        if self.windy:
            def inside(t):
                return p["reach"] - abs(self.where(t)[0][0] - self.origin)
            root = first_root(inside, mpf(0), left, 40) if inside(mpf(0)) > 0 else mpf(0)
            if root is not None:
                yield root, "edge"

    def strike_floor(self):
        p = self.p
        self.x[2] = p["r"]
        P = p["m"] * (1 + p["e"]) * -self.v[2]
        s = self.slip(self.v, self.w)
        if norm(s) > 0:
            f = min(p["mu"] * P, mpf(2) / 7 * p["m"] * norm(s))
            J = scale(s, -f / norm(s))
            self.v = add(self.v, J, 1 / p["m"])
            self.w = add(self.w, [-J[1], J[0], mpf(0)], -mpf(5) / (2 * p["m"] * p["r"]))
        self.v[2] *= -p["e"]
        if self.v[2] < STOP:
            self.v[2], self.mode = mpf(0), "slide"
            assert norm(self.slip(self.v, self.w)) > 0.01, "it would stick"

    def leave_wind(self):
        self.windy = False

    def hold(self):
        """No wind any more: it rolls on for ever."""
        assert not self.windy and norm(self.slip(self.v, self.w)) < mpf(10) ** -30
        self.w = [-self.v[1] / self.p["r"], self.v[0] / self.p["r"], self.w[2]]
        self.mode = "roll"


def meet(a, b, p):
    """Two equal spheres: n from b to a; P = (1 + e) m |v_n|/2, friction min(mu P, m |slip|/7) against the slip."""
    n = unit(add(a.x, b.x, -1))
    v = add(a.v, b.v, -1)
    vn = dot(v, n)
    P = (1 + p["pair_e"]) * p["m"] / 2 * -vn
    s = add(add(v, n, -vn), cross(add(a.w, b.w), n), -p["r"])  # they touch at a.x - r n, which is b.x + r n
    f = min(p["pair_mu"] * P, p["m"] * norm(s) / 7)
    J = add(scale(n, P), s, -f / norm(s))
    for body, sign in ((a, 1), (b, -1)):
        body.v = add(body.v, J, sign / p["m"])
        body.w = add(body.w, cross(n, J), -mpf(5) / (2 * p["m"] * p["r"]))


def two_spheres():
    """The thesis' second scene: they fall, bounce, meet, bounce to rest, slide, leave their winds, roll."""
    friction, bounce = mpf(0.25), mpf(0.3)
    p = dict(r=mpf(0.3), m=mpf(4), g=mpf(9.81), reach=mpf(5), e=bounce, mu=friction * friction, pair_e=bounce, pair_mu=friction)
    bodies = [Sphere(p, [mpf(-5), mpf(0), mpf(5)], mpf(25)), Sphere(p, [mpf(5), mpf(0.2), mpf(5)], mpf(-25))]
    t, rows = mpf(0), []
    with mp.workdps(60):
        for goal in times_of(3.75):
            while t < goal:
                first, what, who = goal - t, None, None
                for body in bodies:
                    for root, name in body.events(goal - t):
                        if root < first:
                            first, what, who = root, name, body

                def apart(s):
                    return norm(add(bodies[0].where(s)[0], bodies[1].where(s)[0], -1)) - 2 * p["r"]
                if all(body.mode == "fly" for body in bodies) and dot(add(bodies[0].x, bodies[1].x, -1), add(bodies[0].v, bodies[1].v, -1)) < 0:
                    root = first_root(apart, mpf(0), first, 40)
                    if root is not None:
                        first, what = root, "meet"
                states = [body.at(first) for body in bodies]
                for body, y in zip(bodies, states):
                    body.set(y)
                t = t + first if what else goal
                if what and "-v" in sys.argv:
                    print(float(t), what, who and bodies.index(who))
                if what == "floor":
                    who.strike_floor()
                elif what == "edge":
                    who.leave_wind()
                elif what == "stick":
                    who.hold()
                elif what == "meet":
                    meet(bodies[0], bodies[1], p)
            for name, body in zip(("left", "right"), bodies):
                rows.append([goal, name, *body.x, *body.q, *body.v, *body.w])
    return None, rows


class Ellipsoid:
    """An ellipsoid over the floor z = 0 in a uniform wind, through air that brakes its motion: the centre by formulas, the
    turning by Euler's equations; y = q, w (body axes)."""

    def __init__(self, p):
        self.p, self.k = p, log(1 - p["linear"])
        self.x, self.v = p["x"], p["v"]
        self.q, self.w = unit(p["q"]), p["w"]  # w in body axes
        self.piece = p["piece"]

    def rates(self, t, y):
        q, w, I = y[0:4], y[4:7], self.p["I"]
        return scale(product(q, [mpf(0)] + w), mpf(1) / 2) + [
            (I[1] - I[2]) * w[1] * w[2] / I[0], (I[2] - I[0]) * w[2] * w[0] / I[1], (I[0] - I[1]) * w[0] * w[1] / I[2]]

    def centre(self, t):
        pull = [self.p["F"] / self.p["m"], mpf(0), -self.p["g"]]
        laws = [Linear(v, a, self.k, x) for v, a, x in zip(self.v, pull, self.x)]
        return [law.x(t) for law in laws], [law.y(t) for law in laws]

    def turning(self, t):
        y = advance(self.rates, mpf(0), self.q + self.w, t, self.piece)
        return unit(y[0:4]), y[4:7]

    def lowest(self, q):
        """From the centre, in the world's axes: h(d) = |A d|, x = A A d/h, d down."""
        d = turn(conjugate(q), [mpf(0), mpf(0), mpf(-1)])
        a = self.p["axes"]
        h = norm([a[i] * d[i] for i in range(3)])
        return turn(q, [a[i] * a[i] * d[i] / h for i in range(3)])

    def height(self, t):
        q, _ = self.turning(t)
        return self.centre(t)[0][2] + self.lowest(q)[2]

    def strike(self):
        """u' = M (n - mu s/|s|) over the normal impulse P: to u_n = 0 at P_c, then to (1 + e) P_c (Poisson)."""
        p, r = self.p, self.lowest(self.q)
        n = [mpf(0), mpf(0), mpf(1)]

        def response(J):
            L = turn(conjugate(self.q), cross(r, J))
            return add(scale(J, 1 / p["m"]), cross(turn(self.q, [L[i] / p["I"][i] for i in range(3)]), r))

        def force(u):
            s = [u[0], u[1], mpf(0)]
            size = norm(s)
            assert size > 1e-3, "it would stick"
            return add(n, s, -p["mu"] / size)

        def over(P, y):
            f = force(y[0:3])
            return response(f) + f

        u = add(self.v, cross(turn(self.q, self.w), r))
        assert u[2] < 0
        start = u + [mpf(0)] * 3
        scale_P = -u[2] / response(n)[2]
        piece = scale_P / 8

        def speed(P):
            return -advance(over, mpf(0), start, P, piece)[2]
        P = first_root(speed, mpf(0), 4 * scale_P, 8, False)
        J = advance(over, mpf(0), start, P * (1 + p["e"]), piece)[3:6]
        self.v = add(self.v, J, 1 / p["m"])
        L = turn(conjugate(self.q), cross(r, J))
        self.w = add(self.w, [L[i] / p["I"][i] for i in range(3)])

    def go(self, t):
        (self.x, self.v), (self.q, self.w) = self.centre(t), self.turning(t)

    def run(self, times):
        t, rows, bounced = mpf(0), [], False
        for goal in times:
            while t < goal:
                left = goal - t
                start = mpf(10) ** -3 if bounced else mpf(0)  # it left just now
                root = first_root(self.height, start, left, 6, False) if left > start else None
                if root is None:
                    self.go(left)
                    t, bounced = goal, bounced and left <= start
                    continue
                self.go(root)
                t, bounced = t + root, True
                self.strike()
                if "-v" in sys.argv:
                    print(float(t), "floor", [float(v) for v in self.v])
            rows.append([goal, "NAME", *self.x, *self.q, *self.v, *turn(self.q, self.w)])
        return rows


def ellipsoid_in_wind():
    a = [mpf(0.1), mpf(0.2), mpf(0.3)]
    m = mpf(4)
    p = dict(axes=a, m=m, I=[m * (a[1] ** 2 + a[2] ** 2) / 5, m * (a[2] ** 2 + a[0] ** 2) / 5, m * (a[0] ** 2 + a[1] ** 2) / 5],
             g=mpf(9.81), F=mpf(5), linear=mpf(0.04), mu=mpf(0.1) * mpf(0.5), e=mpf(0.6), x=[mpf(0), mpf(0), mpf(1)],
             v=[mpf(1), mpf(0), mpf(0)], q=[mpf(0.9), mpf(0.3), mpf(0.2), mpf(0.1)], w=[mpf(0)] * 3, piece=mpf(1) / 16)
    q = unit(p["q"])
    p["w"] = turn(conjugate(q), [mpf(1), mpf(2), mpf(-1)])
    with mp.workdps(45):
        return "ellipsoid", Ellipsoid(p).run(times_of(1.2))


def write(folder, name, answer):
    body, rows = answer
    with open(f"{folder}/{name}.csv", "w") as file:
        file.write("# tests/generators/scene_truths.py: 40 digits, rounded to doubles\n")
        file.write("t,body,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n")
        for row in rows:
            cells = [body or value if i == 1 else repr(float(value)) for i, value in enumerate(row)]
            file.write(",".join(cells) + "\n")


if __name__ == "__main__":
    for scene in (sphere_wall, two_spheres, bowling_ball, damped_ball, orbit, ellipsoid_in_wind):
        write(sys.argv[1], scene.__name__, scene())
