-- SPDX-License-Identifier: MIT
--- Bodies that lie with a face on what stands, and slide, turn or tip there: by closed forms, by what a square and a disc do on the page of
--- their equations, turned and mirrored, at the edge of slipping and of toppling; no integrator and no steps of a pile where nothing turns.
local impact = require "impact"
local quat = require "quat"
local check = require "check"

local G = 9.81
local floor = { name = "floor", shape = impact.plane(), friction = 1, restitution = 0 }
local slab = { name = "floor", static = true, shape = impact.box { a = 20, b = 20, c = .5, rounding = .01 }, position = { 0, 0, -.5 },
  friction = 1, restitution = 0 }

local function run(shape, height, body, more)
  more = more or {}
  body.name, body.shape, body.mass, body.restitution = "body", shape, body.mass or 1, 0
  body.position = body.position or { 0, 0, height }
  local slope = more.slope or 0
  local scene = impact.scene { gravity = { G * math.sin(slope), 0, -G * math.cos(slope) }, duration = more.duration or 2,
    bodies = { impact.body(more.under or floor), impact.body(body) } }
  local seen = {}
  check.truth(scene:run { on_event = function(event) seen[#seen + 1] = event.event end }, "it runs")
  return scene, seen
end

local function account(scene)
  local e = scene:energy()
  return math.abs(e.start - e.sliding_loss - e.impact_loss - e.kinetic - e.potential) / (math.abs(e.start) + e.kinetic)
end

local function no_work(scene, steps)
  local usage = scene:usage()
  check.equal(usage.integrators, 0)
  check.equal(usage.pile_steps, 0)
  if steps then check.truth(usage.rolls <= steps, "segments: " .. usage.rolls) end
end

local solids = {
  { impact.box { a = .1, b = .1, c = .05 }, .05 },
  { impact.box { a = .1, b = .07, c = .05, rounding = .01 }, .05 },
  { impact.cylinder { radius = .1, half_height = .05 }, .05 },
}

-- On a slope a face slides by g (sin - mu cos) t^2/2, stops after v/(mu g) on level ground, and slips iff tan > mu.
for _, under in ipairs { floor, slab } do
  for _, solid in ipairs(solids) do
    local shape, height = solid[1], solid[2]
    local slope, mu = .5, .2
    local scene, seen = run(shape, height, { friction = mu }, { slope = slope, under = under })
    local a = G * (math.sin(slope) - mu * math.cos(slope))
    check.close(scene:state("body").position.x, 2 * a, 1e-12)
    check.close(scene:state("body").velocity.x, 2 * a, 1e-12)
    check.close(scene:state("body").position.z, height, 1e-14)
    check.equal(table.concat(seen, " "), "contact")
    local held = scene:held()
    check.equal(#held, 1)
    check.close(held[1].force.z, G * math.cos(slope), 1e-12)
    check.close(held[1].force.x, -mu * G * math.cos(slope), 1e-12)
    check.close(held[1].point.x - scene:state("body").position.x, height * mu, 1e-12)
    no_work(scene, 1)
    check.truth(account(scene) < 1e-14, "the account of a slide")

    local braked, ends = run(shape, height, { friction = mu, velocity = { .6, -.8, 0 } }, { under = under })
    check.close(braked:time(), 1 / (mu * G), 1e-13)
    check.close(braked:state("body").position.x, .3 / (mu * G), 1e-13)
    check.close(braked:state("body").position.y, -.4 / (mu * G), 1e-13)
    check.equal(table.concat(ends, " "), "contact stick rest")
    no_work(braked, 1)

    for _, sign in ipairs { -1, 1 } do
      local still = run(shape, height, { friction = mu }, { slope = math.atan(mu * (1 + sign * 1e-6)), under = under, duration = 1 })
      check.equal(still:time() == 0, sign < 0)
    end
  end
end

-- A face that turns on the spot stops after J w/(mu m g r), r its mean distance from the centre.
for _, case in ipairs {
  { solids[1], .1 * (math.sqrt(2) + math.log(1 + math.sqrt(2))) / 3 },
  { solids[3], .1 * 2 / 3 },
} do
  local shape, height = case[1][1], case[1][2]
  local scene = run(shape, height, { friction = .3, omega = { 0, 0, 5 } })
  local time = shape.inertia.z * 5 / (.3 * G * case[2])
  check.close(scene:time(), time, 1e-13)
  local q = scene:state("body").orientation
  check.close(2 * math.atan(q.z, q.w), 5 * time / 2, 1e-12)
  no_work(scene, 1)
end

-- A square of half side 1 and next to no height, mu = g = v = w = 1: time, way and angle to the end, of two methods in another program
-- that agree to 2e-6 (docs/faces.md).
local square = impact.box { a = 1, b = 1, c = 1e-7 }
local plate = impact.scene { gravity = { 0, 0, -1 }, duration = 2, bodies = { impact.body(floor),
  impact.body { name = "body", shape = square, mass = 1, position = { 0, 0, 1e-7 }, velocity = { 1, 0, 0 }, omega = { 0, 0, 1 }, friction = 1, restitution = 0 } } }
check.truth(plate:run(), "the plate comes to rest")
local stop = plate:state("body")
check.close(plate:time(), 1.4190, 5e-5)
check.close(stop.position.x, .6817, 5e-5)
check.close(2 * math.atan(stop.orientation.z, stop.orientation.w), .7442, 5e-5)
no_work(plate)

-- What slides and turns, mirrored and with the scene turned about the vertical; on slopes too.
for _, slope in ipairs { 0, .1 } do
  for _, solid in ipairs { solids[1], solids[2], solids[3] } do
    local shape, height = solid[1], solid[2]
    local function throw(sign, turn)
      local v = quat.rotate(quat.from_axis_angle({ 0, 0, 1 }, turn), { 1, sign * .4, 0 })
      local pull = quat.rotate(quat.from_axis_angle({ 0, 0, 1 }, turn), { G * math.sin(slope), 0, 0 })
      local scene = impact.scene { gravity = { pull.x, pull.y, -G * math.cos(slope) }, duration = 5, bodies = { impact.body(floor), impact.body {
        name = "body", shape = shape, mass = 1, position = { 0, 0, height }, velocity = { v.x, v.y, 0 }, omega = { 0, 0, sign * 9 },
        orientation = quat.from_axis_angle({ 0, 0, 1 }, turn), friction = .3, restitution = 0 } } }
      check.truth(scene:run(), "it comes to rest")
      no_work(scene)
      check.truth(account(scene) < 1e-13, "the account of what turns")
      return scene:state("body"), scene:time()
    end
    local plain, time = throw(1, 0)
    local mirror, mirrored_time = throw(-1, 0)
    local turned, turned_time = throw(1, 1.1)
    local back = quat.rotate(quat.from_axis_angle({ 0, 0, 1 }, -1.1), turned.position)
    check.close(mirrored_time, time, 1e-12)
    check.close(turned_time, time, 1e-12)
    check.close(mirror.position.x, plain.position.x, 1e-12)
    check.close(mirror.position.y, -plain.position.y, 1e-12)
    check.close(back.x, plain.position.x, 1e-12)
    check.close(back.y, plain.position.y, 1e-12)
  end
end

-- A block topples iff tan > half its width over half its height; it goes over its lower edge without a step, and comes to lie.
for _, sign in ipairs { -1, 1 } do
  local still = run(impact.box { a = .1, b = .1, c = .2 }, .2, { friction = 1 }, { slope = math.atan(.5 * (1 + sign * 1e-6)), duration = 1 })
  check.equal(still:time() == 0, sign < 0)
  check.equal(still:usage().pile_steps, 0)
end
local toppled = run(impact.box { a = .06, b = .1, c = .2 }, .2, { friction = .7 }, { slope = math.rad(22) })
check.equal(toppled:usage().pile_steps, 0)
check.close(toppled:state("body").position.z, .06, 1e-12)
check.truth(account(toppled) < 1e-11, "the account of a fall")

-- Past the middle of its face a box slides over the border of a table, and falls.
local edge = run(impact.box { a = .1, b = .1, c = .05 }, .05, { friction = .2, position = { 19.5, 0, .05 }, velocity = { 3, 0, 0 } },
  { under = slab, duration = 1 })
check.truth(edge:state("body").position.z < -.5, "it falls from the table")

-- ---- other forces: the same law of friction ----

--- The state, and that nothing was stepped while it moved.
local function pushed(more)
  local body = { name = "body", shape = more.shape or impact.box { a = .1, b = .07, c = .04 }, mass = 1.3, position = { 0, 0, .04 }, restitution = 0,
    velocity = more.velocity or { 1, .3, 0 }, omega = { 0, 0, more.spin or 7 }, friction = more.friction or .3,
    linear_damping = more.linear, angular_damping = more.angular }
  local scene = impact.scene { gravity = more.gravity or { 0, 0, -G }, duration = more.duration or 2, forces = more.forces,
    bodies = { impact.body(floor), impact.body(body) } }
  check.truth(scene:run(), "it runs")
  check.equal(scene:usage().pile_steps, more.stands and scene:usage().pile_steps or 0)
  check.equal(scene:usage().integrators, 0)
  local e = scene:energy()
  check.close(e.start + e.force_work - e.damping_loss - e.sliding_loss - e.impact_loss, e.kinetic + e.potential, 1e-12)
  return scene, scene:state "body"
end

-- A constant force is a gravity aslant: while it slides and turns, and where it stops.
local aslant = impact.force { law = function(_, body) local m = body.mass return { m, .5 * m, (G - 9) * m } end }
for _, duration in ipairs { .3, 1 } do
  local _, one = pushed { gravity = { 1, .5, -9 }, duration = duration }
  local scene, other = pushed { forces = { aslant }, duration = duration, stands = true }
  check.close((one.position - other.position):norm(), 0, 1e-10)
  check.close((one.velocity - other.velocity):norm(), 0, 1e-10)
  check.close(one.orientation.z, other.orientation.z, 1e-10)
  check.close(scene:energy().force_work, 1.3 * (one.position.x + .5 * one.position.y), 1e-10)
end

-- Damped in a line: v' = -mu g - k v. Damped as it turns on the spot: w' = -alpha - k w, with the alpha of an undamped one.
local k = -math.log(.8)
local scene, state = pushed { linear = .2, velocity = { 1, 0, 0 }, spin = 0 }
check.close(scene:time(), math.log(1 + k / (.3 * G)) / k, 1e-9)
check.close(state.position.x, (1 - .3 * G / k * math.log(1 + k / (.3 * G))) / k, 1e-9)
local alpha = 7 / pushed { velocity = { 0, 0, 0 } }:time()
check.close(pushed { velocity = { 0, 0, 0 }, angular = .2 }:time(), math.log(1 + k * 7 / alpha) / k, 1e-9)
_, state = pushed { friction = 0, linear = .5, angular = .5 }
check.close(state.velocity.x, .25, 1e-12)
check.close(state.omega.z, 7 / 4, 1e-12)

-- A wind that ends at its reach, from rest and from a slide; the same on a superquadric's flat place.
for _, shape in ipairs { impact.box { a = .1, b = .07, c = .04 }, impact.superquadric { a = .1, b = .07, c = .04, r = 200, s = 200, t = 200 } } do
  local wind = impact.wind { strength = 6, direction = { 1, 0, 0 }, reach = .2, radius = 10 }
  scene, state = pushed { shape = shape, velocity = { 0, 0, 0 }, spin = 0, forces = { wind } }
  check.close(state.position.x, 6 * .2 / (.3 * 1.3 * G), 1e-8)
  check.close(scene:energy().force_work, 1.2, 1e-8)
  scene = pushed { shape = shape, forces = { wind } }
  check.close(scene:energy().force_work, 1.2, 1e-9)
end

-- A torque that tips it moves the pressure: by n x T/N from where friction alone has it.
local tipped = impact.force { steady = true, law = function() return { 0, 0, 0 }, { 0, .2, 0 } end }
for _, forces in ipairs { { }, { tipped } } do
  scene, state = pushed { velocity = { 1, 0, 0 }, spin = 0, forces = forces, duration = .1 }
  check.close(scene:held()[1].point.x - state.position.x, .3 * .04 + (forces[1] and .2 / (1.3 * G) or 0), 1e-12)
end

-- What stands off by roundings as it lies down lies on the face.
for _, off in ipairs { 1e-13, -1e-13 } do
  local scene = run(impact.box { a = .1, b = .1, c = .05 }, .05 + off, { velocity = { 1, 0, 0 }, friction = .3 })
  check.close(scene:state("body").position.z, .05, 2e-17)
end

-- What is damped in its turning alone falls as anything does, and lands.
for _, shape in ipairs { impact.sphere(.1), impact.box { a = .1, b = .1, c = .1 } } do
  local first
  local drop = impact.scene { gravity = { 0, 0, -G }, duration = 1, bodies = { impact.body(floor),
    impact.body { name = "body", shape = shape, mass = 1, position = { 0, 0, .6 }, angular_damping = .3, restitution = 0 } } }
  check.truth(drop:run { on_event = function(event) first = first or event.t end }, "it runs")
  check.close(first, math.sqrt(2 * .5 / G), 1e-12)
  check.close(drop:state("body").position.z, .1, 1e-12)
end

-- What lies down as it slides keeps its momentum along the face, and about its normal, where no friction takes it: the account closes.
math.randomseed(77)
local function between(low, high) return low + (high - low) * math.random() end
for i = 1, 40 do
  local points = { }
  for k = 1, 7 do points[k] = { between(-.2, .2), between(-.2, .2), between(-.2, .2) } end
  local shape = i % 2 == 0 and impact.polyhedron { vertices = points } or impact.box { a = between(.05, .2), b = between(.05, .2), c = between(.05, .2) }
  local drop = impact.scene { gravity = { G * math.sin(.2), 0, -G * math.cos(.2) }, duration = 1.2, bodies = { impact.body(floor),
    impact.body { name = "body", shape = shape, density = 1000, position = { 0, 0, .5 }, friction = 0, restitution = between(0, .5),
      orientation = { between(-1, 1), between(-1, 1), between(-1, 1), between(-1, 1) }, velocity = { between(-1, 1), between(-1, 1), 0 },
      omega = { between(-5, 5), between(-5, 5), between(-5, 5) } } } }
  check.equal(drop:run(), "end of time")
  check.equal(drop:receipt(), "ok")
end

-- A cube that falls comes to rest in a handful of steps: in those of its slide errors count by the rest speed, not by what is left of its
-- own; what holds a corner or two goes by the explicit method, and its corners stay where they are.
local cube = impact.scene { gravity = { 0, 0, -G }, duration = 2, bodies = {
  impact.body { name = "floor", shape = impact.plane(), friction = 1, restitution = 1 }, impact.body { name = "cube",
  shape = impact.box { a = .1, b = .1, c = .1 }, mass = 1, friction = .5, restitution = .3, position = { 0, 0, .3 },
  orientation = quat.from_axis_angle({ 1, .3, .2 }, .4) } } }
check.equal(cube:run(), "at rest")
check.equal(cube:usage().pile_steps, 0)
check.truth(cube:usage().glides <= 85, cube:usage().glides .. " steps of its slide") -- 113 by its own speed
check.truth(cube:usage().integrator_steps <= 100, cube:usage().integrator_steps .. " steps on corners") -- 517 by CVODE
check.close(account(cube), 0, 1e-12)
