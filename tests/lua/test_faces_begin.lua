-- SPDX-License-Identifier: MIT
--- What stands on its face, and how it begins to move: at the limits of a square and a disc, against a motion that is already there, against
--- a sum over places of its face, and under forces that change; no steps of a pile.
local impact = require "impact"
local quat = require "quat"
local check = require "check"

local G, mu, a = 9.81, .3, .1
local floor = { name = "floor", shape = impact.plane(), friction = mu, restitution = 0 }
local slab = { name = "floor", static = true, shape = impact.box { a = 5, b = 5, c = .5 }, position = { 0, 0, -.5 }, friction = mu, restitution = 0 }
local box, disc = impact.box { a = a, b = a, c = .05 }, impact.cylinder { radius = a, half_height = .05 }
local flat = impact.superquadric { a = a, b = a, c = .05, r = 200, s = 200, t = 200 }

local function run(shape, law, more)
  more = more or {}
  local slope = more.slope or 0
  local scene = impact.scene { gravity = { G * math.sin(slope), 0, -G * math.cos(slope) }, duration = more.duration or .3,
    forces = { impact.force { name = "push", body = "body", steady = more.steady, law = law, max_step = more.max_step or .02 } }, bodies = {
      impact.body(more.under or floor), impact.body { name = "body", shape = shape, mass = 1, friction = 1, restitution = 0,
        position = { 0, 0, .05 }, velocity = more.velocity, omega = more.omega } } }
  local seen = {}
  check.truth(scene:run { on_event = function(event) seen[#seen + 1] = event.event .. (" %.9f"):format(event.t) end }, "it runs")
  check.equal(scene:usage().pile_steps, 0)
  check.equal(scene:usage().integrators, 0)
  local e = scene:energy()
  check.close(e.start + e.force_work - e.damping_loss - e.sliding_loss - e.impact_loss, e.kinetic + e.potential, 1e-12)
  return scene:state "body", scene, seen
end

-- A torque turns a square from mu m g (root 2 + asinh 1)/3 a on, a disc from 2/3 of its radius on: with all that is more than that.
local square_arm = (math.sqrt(2) + math.log(1 + math.sqrt(2))) / 3 * a
for _, case in ipairs { { box, square_arm, 2 / 3 * a * a }, { disc, 2 / 3 * a, a * a / 2 } } do
  local shape, limit, J = case[1], mu * G * case[2], case[3]
  for _, under in ipairs { floor, slab } do
    for _, part in ipairs { .5, .999, 1 - 1e-6, 1 + 2e-5, 1.001, 1.2, 1.6, 2.5 } do
      local torque = function() return nil, { 0, 0, part * limit } end
      local state, scene = run(shape, torque, { under = under, steady = true })
      check.close(state.omega.z, math.max(0, part - 1) * limit / J * .3, 1e-11)
      check.equal(scene:time(), part < 1 and 0 or .3)
      for _, omega in ipairs { 1e-3, 1e-6 } do
        if part > 1 then check.close(run(shape, torque, { omega = { 0, 0, omega } }).omega.z, state.omega.z + omega, 1e-11) end
      end
    end
  end
end

-- A pull beside the centre, on level ground and on slopes: from rest it goes as from the least of speeds, however they are directed.
math.randomseed(31)
local function between(low, high) return low + (high - low) * math.random() end
local gone, stood = 0, 0
for i = 1, 24 do
  local shape = i % 3 == 0 and disc or i % 3 == 1 and box or impact.box { a = a, b = between(.02, .1), c = .05, rounding = .005 }
  local F, arm, slope = { between(-3, 3), between(-3, 3), between(-1, 1) }, { between(-.1, .1), between(-.1, .1), 0 }, i % 2 == 0 and .1 or 0
  local law = function(_, body)
    local r = quat.rotate(body.orientation, arm)
    return F, { r.y * F[3] - r.z * F[2], r.z * F[1] - r.x * F[3], r.x * F[2] - r.y * F[1] }
  end
  local state, scene = run(shape, law, { slope = slope, steady = true })
  if scene:time() == 0 then
    stood = stood + 1
  else
    gone = gone + 1
    for _, speed in ipairs { 1e-3, 1e-6 } do
      local other = run(shape, law, { slope = slope, velocity = { between(-1, 1) * speed, between(-1, 1) * speed, 0 }, omega = { 0, 0, 10 * between(-1, 1) * speed } })
      check.close((other.position - state.position):norm(), 0, 3 * speed)
      check.close((other.velocity - state.velocity):norm(), 0, 6 * speed)
      check.close(other.orientation.z, state.orientation.z, 30 * speed)
    end
  end
end
check.truth(gone >= 8 and stood >= 4, gone .. " go, " .. stood .. " stand")

--- A thin plate of evenly pressed places, by implicit steps: Coulomb's friction at each, blunt below 1e-5 m/s; where it is then, and how turned.
local function by_places(F, T, h)
  local n, J, eps = 12, 2 / 3 * a * a, 1e-5
  local x, turned, vx, vy, w = 0, 0, 0, 0, 0
  for step = 1, math.floor(T / h + .5) do
    local c, s = math.cos(turned), math.sin(turned)
    local nx, ny, nw = vx, vy, w
    for _ = 1, 40 do
      local k0, kx, ky, kk = 0, 0, 0, 0
      for i = 1, n do
        for j = 1, n do
          local px, py = a * ((2 * i - 1) / n - 1), a * ((2 * j - 1) / n - 1)
          local rx, ry = c * px - s * py, s * px + c * py
          local k = h * mu * G / (n * n) / math.sqrt((nx - nw * ry) ^ 2 + (ny + nw * rx) ^ 2 + eps * eps)
          k0, kx, ky, kk = k0 + k, kx + k * rx, ky + k * ry, kk + k * (rx * rx + ry * ry)
        end
      end
      -- (1 + k0) vx - ky w = vx + h F,  (1 + k0) vy + kx w = vy,  -ky vx + kx vy + (J + kk) w = J w + h T
      local b1, b2, b3 = vx + h * F, vy, J * w - h * a * c * F
      local d = 1 + k0
      local was = nw
      nw = (b3 + ky * b1 / d - kx * b2 / d) / (J + kk - (ky * ky + kx * kx) / d)
      nx, ny = (b1 + ky * nw) / d, (b2 - kx * nw) / d
      if math.abs(nw - was) < 1e-8 then break end
    end
    vx, vy, w = nx, ny, nw
    x, turned = x + h * vx, turned + h * w
  end
  return x, turned
end

-- A thin plate pulled at the middle of a side, at less than what pulls it away at its centre.
for _, part in ipairs { .75, .9 } do
  local F = part * mu * G
  local law = function(_, body) return { F, 0, 0 }, { 0, 0, -F * quat.rotate(body.orientation, { 0, a, 0 }).y } end
  local plate = impact.scene { gravity = { 0, 0, -G }, duration = .3, forces = { impact.force { body = "body", law = law } }, bodies = { impact.body(floor),
    impact.body { name = "body", shape = impact.box { a = a, b = a, c = 1e-4 }, mass = 1, friction = 1, position = { 0, 0, 1e-4 }, restitution = 0 } } }
  check.truth(plate:run(), "it runs")
  check.equal(plate:usage().pile_steps, 0)
  local state, x, turned = plate:state "body", by_places(F, .3, 2e-3)
  check.close(state.position.x, x, .02 * x)
  check.close(2 * math.asin(state.orientation.z), turned, -.02 * turned)
end

-- A torque k t moves a square, and a flat place, from the instant in which it is more than they hold, and by nothing before.
for _, shape in ipairs { box, flat } do
  local k, J = .5, shape.inertia.z
  local state, _, seen = run(shape, function(t) return nil, { 0, 0, k * t } end, { duration = 1 })
  local start = tonumber(seen[#seen]:match "^slip (.+)")
  check.truth(start, "the last that it does is to slip: " .. seen[#seen])
  if shape == box then check.close(start, mu * G * square_arm / k, 1e-9) end
  check.close(state.omega.z, k * (1 - start) ^ 2 / 2 / J, 1e-7)
  check.truth(table.concat(seen, " "):match "^contact [%d.]+ rest [%d.]+ slip" or table.concat(seen, " "):match "^rest [%d.]+ slip", table.concat(seen, " "))
end

-- What a flat place holds does not turn; what holds it is told.
do
  local state, scene = run(flat, function() return nil, { 0, 0, .15 } end, { steady = true })
  check.equal(scene:time(), 0)
  check.equal(state.omega.z, 0)
  check.close(scene:held()[1].moment.z, -.15, 1e-15)
end

-- Pushed and turned to and fro, it goes the same way whatever the steps; while it stands its face holds what pushes it.
local function shaken(t) return { 5 * math.sin(20 * t), 0, 0 }, { 0, 0, .4 * math.sin(13 * t) } end
local coarse = run(box, shaken, { duration = .6 })
local fine = run(box, shaken, { duration = .6, max_step = 1e-4 })
check.close((coarse.position - fine.position):norm(), 0, 1e-9)
check.close(coarse.orientation.z, fine.orientation.z, 1e-9)
check.truth(coarse.position:norm() > .05, "it moves")
local _, still = run(box, function(t) return { 1 + .1 * t, 0, 0 }, { 0, 0, .01 } end)
local held = still:held()
check.equal(#held, 1)
check.equal(held[1].mode, "stick")
check.close(held[1].force.x, -1.03, 1e-14)
check.close(held[1].force.z, G, 1e-14)
check.close(held[1].moment.z, -.01, 1e-15)
check.close(held[1].point.x, .05 * 1.03 / G, 1e-14)

-- On a face that reaches over a border it goes by steps: what turns it is the face of what bears it, which is smaller than its own.
for _, part in ipairs { .5, 1.2 } do
  local over = impact.scene { gravity = { 0, 0, -G }, duration = .1, bodies = { impact.body(slab), impact.body { name = "body", shape = box, mass = 1, friction = 1,
    position = { 4.96, 0, .05 }, restitution = 0 } }, forces = { impact.force { body = "body", law = function() return nil, { 0, 0, part * mu * G * square_arm } end } } }
  check.truth(over:run(), "it runs")
  check.truth(over:usage().pile_steps > 0 and over:usage().glides == 0, "it is stepped")
  local omega = over:state("body").omega.z
  check.truth(part < 1 and math.abs(omega) < 1e-15 or part > 1 and omega > .2, "it is turned by as much as its part of the face does not hold")
end

-- What a ball has struck goes by steps until it stands; then its face says for how long.
local struck = impact.scene { gravity = { 0, 0, -G }, duration = 2, forces = { impact.force { body = "body", law = function(t) return nil, { 0, 0, .3 * t } end } },
  bodies = { impact.body(floor), impact.body { name = "body", shape = box, mass = 1, friction = 1, position = { 0, 0, .05 }, restitution = 0 },
    impact.body { name = "ball", shape = impact.sphere(.02), mass = .2, position = { -.5, 0, .05 }, velocity = { 3, 0, .8 }, restitution = .5 } } }
local slip
check.truth(struck:run { on_event = function(event) if event.event == "slip" and event.body1 == "body" and event.t > .5 then slip = slip or event.t end end }, "it runs")
check.close(slip, mu * G * square_arm / .3, 1e-9)
local e = struck:energy()
check.close(e.start + e.force_work - e.sliding_loss - e.impact_loss, e.kinetic + e.potential, 1e-9)

-- What is laid on a side between two edges that straight lines join, level but for rounding, stands at once, however flat these edges are.
for _, t in ipairs { 2, 4, 20, 100 } do
  for _, shape in ipairs { impact.superquadric { a = 0.06, b = 0.06, c = 0.1, r = 1, s = 1, t = t }, impact.superellipsoid { a = 0.06, b = 0.06, c = 0.1, eps1 = 2 / t, eps2 = 2 } } do
    local lies = quat.from_axis_angle({ 0, 1, 0 }, math.pi / 2) * quat.from_axis_angle({ 0, 0, 1 }, -math.pi / 4)
    local scene = impact.scene { name = "side", gravity = { 0, 0, -9.81 }, duration = 1, bodies = { impact.body { name = "floor", shape = impact.plane(), friction = 0.7 },
      impact.body { name = "lies", shape = shape, mass = 1, friction = 0.7, position = { 0, 0, 0.06 / math.sqrt(2) }, orientation = lies } } }
    scene:run()
    check.equal(scene:time(), 0)
  end
end
