-- SPDX-License-Identifier: MIT
--- Torsional and rolling friction in scenes, against closed forms: balls on planes, exactly; impacts; rest by proof; what steps move.
local check = require "check"
local impact = require "impact"

local g, R = 9.81, 0.1

local function floor(keys)
  keys = keys or {}
  keys.name, keys.shape = "floor", impact.plane()
  keys.friction, keys.restitution = keys.friction or 1, keys.restitution or 1
  return impact.body(keys)
end

local function ball(keys)
  keys.name, keys.shape, keys.position = "ball", impact.sphere(R), keys.position or { 0, 0, R }
  keys.friction, keys.restitution = keys.friction or 1, keys.restitution or 0
  return impact.body(keys)
end

local function scene(bodies, slope, more)
  local definition = { gravity = { g * math.sin(slope or 0), 0, -g * math.cos(slope or 0) }, duration = 1e6, bodies = bodies }
  for key, value in pairs(more or {}) do definition[key] = value end
  return impact.scene(definition)
end

local function run(bodies, slope, more)
  local s = scene(bodies, slope, more)
  local ended, message = s:run()
  check.truth(ended == "at rest" or ended == "end of time", message)
  local energy = s:energy()
  local left = energy.start - energy.sliding_loss - energy.impact_loss - energy.kinetic - energy.potential
  check.close(left / energy.start, 0, 1e-12)
  return s, ended
end

-- Rolling out: the way 7 R v²/(10 rho g), the time 7 R v/(5 rho g). No step is taken.
for _, rho in ipairs { 1e-5, 1e-3, 2e-2 } do
  for _, v in ipairs { 0.1, 1, 10 } do
    local s, ended = run { floor(), ball { velocity = { v, 0, 0 }, omega = { 0, v / R, 0 }, rolling_friction = rho } }
    check.equal(ended, "at rest")
    check.close(s:time() * 5 * rho * g / (7 * R * v), 1, 1e-14)
    check.close(s:state("ball").position.x * 10 * rho * g / (7 * R * v ^ 2), 1, 1e-13)
    check.equal(s:usage().pile_steps, 0)
  end
end

-- Spinning out: the time 2 R² omega/(5 tau g); either way round.
for _, omega in ipairs { -200, 3 } do
  local tau = 7e-4
  local s, ended = run { floor { torsional_friction = tau / 2 }, ball { omega = { 0, 0, omega }, torsional_friction = tau / 2 } }
  check.equal(ended, "at rest")
  check.close(s:time() * 5 * tau * g / (2 * R ^ 2 * math.abs(omega)), 1, 1e-14)
  check.equal(s:usage().pile_steps, 0)
end

-- On a slope it rests iff tan <= rho/R; else it rolls by a = (5/7) g (sin - cos rho/R), and up the slope against both.
for _, rho in ipairs { 1e-4, 1e-2 } do
  for _, part in ipairs { 0.5, 1 - 1e-9, 1 + 1e-9, 2 } do
    local slope = math.atan(part * rho / R)
    local s, ended = run({ floor(), ball { rolling_friction = rho } }, slope, { duration = 1 })
    check.equal(ended, part < 1 and "at rest" or "end of time")
    local a = part < 1 and 0 or 5 / 7 * g * (math.sin(slope) - math.cos(slope) * rho / R)
    check.close(s:state("ball").position.x, a / 2, 1e-15 + 1e-6 * a)
    check.equal(s:usage().pile_steps, 0)
  end
  local slope, v = math.atan(rho / R / 2), 1
  local s, ended = run({ floor(), ball { velocity = { -v, 0, 0 }, omega = { 0, -v / R, 0 }, rolling_friction = rho } }, slope)
  check.equal(ended, "at rest")
  check.close(s:state("ball").position.x * 10 * g * (math.sin(slope) + math.cos(slope) * rho / R) / (7 * v ^ 2), -1, 1e-12)
end

-- Sliding first: mu against the slip, (R mu - rho)/J against the turning; then it rolls out. By the times of both.
do
  local rho, mu, v = 3e-3, 0.5, 2
  local up = 5 / 2 * g * (R * mu - rho) / R ^ 2 -- omega'
  local slides = v / (mu * g + R * up)
  local rolls = v - mu * g * slides
  local s = run { floor(), ball { velocity = { v, 0, 0 }, friction = mu, rolling_friction = rho } }
  check.close(s:time(), slides + 7 * R * rolls / (5 * rho * g), 1e-13)
  check.close(s:state("ball").position.x, (v + rolls) / 2 * slides + 7 * R * rolls ^ 2 / (10 * rho * g), 1e-13)
  -- backspin: rolling friction first helps to turn it over
  local back = -50
  local s = run { floor(), ball { velocity = { v, 0, 0 }, omega = { 0, back, 0 }, friction = mu, rolling_friction = rho } }
  local over = -back / (5 / 2 * g * (R * mu + rho) / R ^ 2)
  local slides = over + (v - mu * g * over) / (mu * g + R * up)
  local rolls = v - mu * g * slides
  check.close(s:time(), slides + 7 * R * rolls / (5 * rho * g), 1e-13)
  check.equal(s:usage().pile_steps, 0)
end

-- An impact of a spinning ball, straight down: the spin loses tau (1 + eps) m w/J, no more than there is.
for _, eps in ipairs { 0, 0.6 } do
  for _, omega in ipairs { 0.3, 40 } do
    local tau, w = 2e-3, math.sqrt(2 * g)
    local s = scene({ floor(), ball { position = { 0, 0, R + 1 }, omega = { 0, 0, omega }, restitution = eps, torsional_friction = tau } }, 0, { duration = 0.46 })
    s:run()
    local lost = 5 / 2 * tau * (1 + eps) * w / R ^ 2
    if eps > 0 then
      check.close(s:state("ball").omega.z, math.max(0, omega - lost), 1e-12)
      check.equal(s:usage().impacts_turning, 1)
    end
  end
end

-- Where pairs say otherwise; and without lengths nothing of this is asked.
do
  local balls = { floor(), ball { velocity = { 1, 0, 0 }, omega = { 0, 1 / R, 0 }, rolling_friction = 1e-3 } }
  local _, ended = run(balls, 0, { duration = 5, pairs = { { bodies = { "floor", "ball" }, rolling_friction = 0 } } })
  check.equal(ended, "end of time")
  local s = run { floor { rolling_friction = 1e-3 }, ball { velocity = { 1, 0, 0 }, omega = { 0, 1 / R, 0 }, rolling_friction = 1e-3 } }
  check.close(s:time() * 5 * 2e-3 * g / (7 * R), 1, 1e-14)
end

-- By steps: a cylinder on its side rolls out like (1 + 1/2) R v²/(2 rho g); a box spins out on its face.
do
  local rho, v, half = 2e-3, 0.5, math.sqrt(0.5)
  local s, ended = run({ floor(), impact.body { name = "log", shape = impact.cylinder { radius = R, half_height = R }, position = { 0, 0, R },
    orientation = { half, half, 0, 0 }, velocity = { v, 0, 0 }, omega = { 0, v / R, 0 }, friction = 1, rolling_friction = rho } }, 0, { pile_tolerance = 1e-5 })
  check.equal(ended, "at rest")
  check.close(s:state("log").position.x * 4 * rho * g / (3 * R * v ^ 2), 1, 1e-6)
  local times = {}
  for i, tau in ipairs { 0, 1e-2 } do
    times[i] = run({ floor(), impact.body { name = "box", shape = impact.box { a = R, b = R, c = R / 2 }, position = { 0, 0, R / 2 },
      omega = { 0, 0, 5 }, friction = 0.3, torsional_friction = tau } }, 0, { pile_tolerance = 1e-5 }):time()
  end
  -- The whole face without tau: J omega/(mu m g r), J = (2/3) m R², r = (sqrt 2 + asinh 1) R/3 its mean distance. By steps with tau, in
  -- one ellipsoid at each place of its friction, as far from the centre as r: J omega/(m g sqrt((mu r)² + tau²)), known to a step.
  local mean, tau = (math.sqrt(2) + math.log(1 + math.sqrt(2))) / 3 * R, 1e-2
  check.close(times[1], 2 / 3 * R ^ 2 * 5 / (0.3 * g * mean), 1e-12)
  local wanted = 2 / 3 * R ^ 2 * 5 / (g * math.sqrt((0.3 * mean) ^ 2 + tau ^ 2))
  check.truth(times[2] >= wanted - 1e-12 and times[2] <= wanted + 0.05 * math.sqrt(1.5 * R / g), "the time of spinning")
end

-- A ball whose rolling is not along its slip is stepped until it rolls, and then rolls out in closed form; steps alone agree.
do
  local function throw(piles)
    return run({ floor(), ball { velocity = { 2, 1, 0 }, omega = { 3, 5, 0 }, friction = 0.4, rolling_friction = 2e-3 } }, 0, { piles = piles })
  end
  local exact, stepped = throw "auto", throw "steps"
  check.truth(exact:usage().rolls > 0 and exact:usage().pile_steps < stepped:usage().pile_steps / 4)
  for _, axis in ipairs { "x", "y" } do
    check.close(exact:state("ball").position[axis], stepped:state("ball").position[axis], 1e-3)
  end
end

-- A turntable's middle spins a ball up, J W/(tau g) for the spin, and then it goes along; on one that stands it rests.
do
  local tau = 3e-3
  for _, W in ipairs { 0, 5 } do
    local s = scene({ floor { omega = { 0, 0, W } }, ball { torsional_friction = tau } }, 0, { duration = 2 })
    check.equal(s:run(), W == 0 and "at rest" or "end of time")
    check.close(s:state("ball").omega.z, W, 1e-12)
    check.close(s:energy().drive_work, 2 * s:energy().kinetic, 0.01 * s:energy().kinetic)
  end
end

-- A break: balls that part roll out in closed form again, each on its own; the table's length is all of theirs.
do
  local r, bodies = 0.028, { floor { friction = 0.5, rolling_friction = 3e-4, torsional_friction = 3e-4 } }
  for row = 0, 2 do
    for j = 0, row do
      bodies[#bodies + 1] = impact.body { name = "ball " .. #bodies, shape = impact.sphere(r), mass = 0.17, restitution = 0.95, friction = 0.3,
        position = { 1 + row * r * 1.7330, (j - row / 2) * 2.0005 * r, r } }
    end
  end
  bodies[#bodies + 1] = impact.body { name = "cue", shape = impact.sphere(r), mass = 0.17, position = { 0, 0.003, r }, velocity = { 3, 0, 0 }, restitution = 0.95,
    friction = 0.3 }
  local s, ended = run(bodies)
  check.equal(ended, "at rest")
  check.truth(s:usage().rolls >= 7)
end

-- What is held: rolling, the moment rho N against it and the force that slows the ball; at rest on a slope, what holds it.
do
  local rho, m = 5e-3, 2
  local s = scene({ floor(), ball { mass = m, velocity = { 1, 0, 0 }, omega = { 0, 1 / R, 0 }, rolling_friction = rho } })
  s:run_to(0.1)
  local held = s:held()[1]
  check.close(held.force.x, -5 / 7 * m * g * rho / R, 1e-14)
  check.close(held.force.z, m * g, 1e-14)
  check.close(held.moment.y, -rho * m * g, 1e-15)
  local slope = math.atan(rho / R / 2)
  local s = run({ floor(), ball { mass = m, rolling_friction = rho } }, slope)
  local held = s:held()[1]
  check.close(held.force.x, -m * g * math.sin(slope), 1e-12)
  check.close(held.moment.y, -R * m * g * math.sin(slope), 1e-13)
end

-- Refused in words.
for _, case in ipairs {
  { { rolling_friction = -1 }, "rolling_friction must be a number >= 0, got -1" },
  { { torsional_friction = 0 / 0 }, "torsional_friction must be a number >= 0, got" },
} do
  local good, message = pcall(ball, case[1])
  check.truth(not good and message:find(case[2], 1, true), message)
end
for _, more in ipairs { { law = "stronge" }, { law = "newton" }, { piles = "exact" } } do
  local good, message = pcall(scene, { floor(), ball { rolling_friction = 1e-3 } }, 0, more)
  check.truth(not good and message:find("rolling_friction", 1, true), message)
end

check.report "turning"
