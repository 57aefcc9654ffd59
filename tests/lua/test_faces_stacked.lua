-- SPDX-License-Identifier: MIT
--- The friction of faces on bodies that move themselves, which go by steps: it turns as the whole face's does, not as its corners'. A square,
--- a disc and a line that spin on a free box, whatever its mass; what a torque turns, and what it does not; sliding that is as it was.
local impact = require "impact"
local quat = require "quat"
local check = require "check"

local G, mu, a = 9.81, .3, .1

--- The body on a box of the mass, which stands on a rough floor.
local function run(shape, height, mass, more)
  local scene = impact.scene { gravity = { 0, 0, -G }, duration = more.duration, bodies = {
    impact.body { name = "floor", shape = impact.plane(), friction = 1, restitution = 0 },
    impact.body { name = "base", shape = impact.box { a = .5, b = .5, c = .1 }, mass = mass, position = { 0, 0, .1 }, friction = mu, restitution = 0 },
    impact.body { name = "body", shape = shape, mass = 2, moments = more.moments, position = { 0, 0, .2 + height }, orientation = more.orientation, friction = 1,
      restitution = 0, velocity = more.velocity, omega = more.omega } },
    forces = more.torque and { impact.force { name = "screw", body = "body", steady = true, law = function() return nil, { 0, 0, more.torque } end } } }
  check.truth(scene:run(), "it runs")
  check.truth(scene:usage().pile_steps > 0 or scene:time() == 0, "by steps")
  local e = scene:energy()
  check.close(e.start + e.force_work - e.damping_loss - e.sliding_loss - e.impact_loss, e.kinetic + e.potential, 1e-9 * e.start)
  return scene:state "body", scene
end

local function about_z(angle) return quat.from_axis_angle({ 0, 0, 1 }, angle) end

local box, disc, rod = impact.box { a = a, b = a, c = .05 }, impact.cylinder { radius = a, half_height = .05 }, impact.box { a = a, b = .01, c = .01 }
local square = (math.sqrt(2) + math.log(1 + math.sqrt(2))) / 3 * a
-- arm of the friction and moment of inertia of a kilogram; a disc is the polygon of its sixteen points, 1.3 % less
for _, case in ipairs { { box, .05, square, 2 / 3 * a * a, 1e-3 }, { disc, .05, 2 / 3 * a, a * a / 2, .015 } } do
  local shape, height, arm, J, off = table.unpack(case)
  local slows, spin = mu * G * arm / J, 5
  for _, mass in ipairs { 2, 100, 1e4 } do
    for _, yaw in ipairs { 0, .4 } do
      local state = run(shape, height, mass, { duration = .6 * spin / slows, omega = { 0, 0, spin }, orientation = about_z(yaw) })
      check.close(state.omega.z, .4 * spin, .6 * spin * off)
      local still = select(2, run(shape, height, mass, { duration = 3 * spin / slows, omega = { 0, 0, spin }, orientation = about_z(yaw) }))
      check.close(still:state "body".omega:norm(), 0, 0)
      check.truth(still:time() < 1.3 * spin / slows, "at rest")
    end
  end
  -- at rest up to the whole face's torque
  for _, part in ipairs { .5, .97, 1.03, 1.5 } do
    local state, scene = run(shape, height, 2, { duration = .2, torque = part * 2 * mu * G * arm })
    if part < 1 then
      check.equal(scene:time(), 0)
    else
      check.close(state.omega.z, (part - 1) * mu * G * arm / J * .2, .03 * mu * G * arm / J * .2)
    end
  end
end

-- Of what is all but a line half its length's half.
local slows = mu * G * (a / 2) / (a * a / 3)
local state = run(rod, .01, 2, { duration = .5 * 5 / slows, omega = { 0, 0, 5 } })
check.close(state.omega.z, 2.5, .05)

-- Of a capsule's two points, too: a line of half length .12, J = .01.
local lying = quat.from_axis_angle({ 0, 1, 0 }, math.pi / 2)
state = run(impact.capsule { radius = .02, half_height = .12 }, .02, 100, { duration = .08, omega = { 0, 0, 5 }, orientation = lying, moments = { .01, .01, .0004 } })
check.close(state.omega.z, 5 - mu * 2 * G * (.12 / 2) / .01 * .08, 1e-3)

-- What slides without turning is held by all of its friction, and not turned.
state = run(box, .05, 1e4, { duration = .2, velocity = { 1, .5, 0 }, orientation = about_z(.3) })
check.close(state.velocity:norm(), math.sqrt(1.25) - mu * G * .2, 1e-3)
check.close(state.omega:norm(), 0, .02)

-- What does both does so as on all of its face, on the floor and on a body that stands, however it is turned: a square with v = a omega turns by .744
-- and goes .68, with .006 aside at most.
for _, yaw in ipairs { 0, .3, math.pi / 8, math.pi / 4 } do
  for _, thick in ipairs { 0, 1 } do
    local bodies = { impact.body { name = "floor", shape = impact.plane(), friction = 1, restitution = 0 },
      impact.body { name = "body", shape = impact.box { a = 1, b = 1, c = .001 }, mass = 1, position = { 0, 0, 2 * thick + .001 }, orientation = about_z(yaw), friction = 1,
        restitution = 0, velocity = { 1, 0, 0 }, omega = { 0, 0, 1 } } }
    if thick > 0 then
      bodies[3] = impact.body { name = "base", shape = impact.box { a = 5, b = 5, c = thick }, mass = 1e4, position = { 0, 0, thick }, friction = 1, restitution = 0 }
    end
    local scene = impact.scene { gravity = { 0, 0, -1 }, duration = 6, piles = "steps", pile_tolerance = 1e-4, bodies = bodies }
    check.equal(scene:run(), "at rest")
    local q, x = scene:state "body".orientation, scene:state "body".position
    check.close(2 * math.atan(q.z, q.w) - yaw, .7437, .002)
    check.close(x.x, .682, .004)
    check.close(x.y, 0, .008)
  end
end

-- What has come to rest, and is pulled by .9 of what its face holds and turned to and fro by an eighth, stands: what its steps leave is no slip, by which
-- friction would be as of one that turns.
do
  local scene = impact.scene { gravity = { 0, 0, -1 }, duration = 2, piles = "steps", bodies = {
    impact.body { name = "floor", shape = impact.plane(), friction = 1, restitution = 0 },
    impact.body { name = "body", shape = impact.box { a = 1, b = 1, c = .001 }, mass = 1, position = { 0, 0, .001 }, friction = 1, restitution = 0, omega = { 0, 0, .2 } } },
    forces = { impact.force { name = "pull", body = "body", law = function(t) return { t > 1 and .9 or 0, 0, 0 }, { 0, 0, .1 * math.sin(37 * t) } end } } }
  check.equal(scene:run(), "end of time")
  check.close(scene:state("body").velocity:norm(), 0, 1e-9)
  check.close(scene:state("body").omega:norm(), 0, 1e-9)
end

-- Two plates that lean against each other and slide apart touch along a strip of their edges, whose corners are so near to each other that closing the
-- gaps of each would turn them by radians. The tilt's equation, with the foot at mu N and the push H at the top:
--   m x'' = mu N - H      m z'' = N - m g      I th'' = (r x f)_y of both      x = -(L sin th + w cos th), z = L cos th + w sin th
local function lean(th, duration)
  local L, w, m, I, rate, steps = .5, .005, 1, (.5 ^ 2 + .005 ^ 2) / 3, 0, 4000
  local function acceleration(angle, turning)
    local s, c = math.sin(angle), math.cos(angle)
    local function off(A)
      local X, Z = -(L * c - w * s) * A + (L * s + w * c) * turning ^ 2, (-L * s + w * c) * A - (L * c + w * s) * turning ^ 2
      local N = m * (G + Z)
      local H = .2 * N - m * X
      return I * A - (-(L * c + w * s) * .2 * N - (w * c - L * s) * N - (L * c - w * s) * H)
    end
    return off(0) / (off(0) - off(1))
  end
  local h = duration / steps
  for _ = 1, steps do
    local middle, turning = th + h / 2 * rate, rate + h / 2 * acceleration(th, rate)
    th, rate = th + h * turning, rate + h * acceleration(middle, turning)
  end
  return L * math.cos(th) + w * math.sin(th), rate
end
for _, th in ipairs { .5, .51, .52 } do
  local L, w, plates = .5, .005, { impact.body { name = "floor", shape = impact.plane(), friction = 1 } }
  for k, side in ipairs { 1, -1 } do
    plates[k + 1] = impact.body { name = k == 1 and "left" or "right", shape = impact.box { a = w, b = .2, c = L }, mass = 1, friction = 1, restitution = 0,
      orientation = quat.from_axis_angle({ 0, 1, 0 }, side * th),
      position = { -side * (L * math.sin(th) + w * math.cos(th)), 0, L * math.cos(th) + w * math.sin(th) } }
  end
  local scene = impact.scene { gravity = { 0, 0, -G }, duration = .14, bodies = plates, pairs = { { bodies = { "floor", "left" }, friction = .2 },
    { bodies = { "floor", "right" }, friction = .2 }, { bodies = { "left", "right" }, friction = .6 } } }
  check.equal(scene:run(), "end of time")
  local z, rate = lean(th, .14)
  for k, name in ipairs { "left", "right" } do
    check.close(scene:state(name).position.z, z, 5e-5)
    check.close(scene:state(name).omega.y, k == 1 and rate or -rate, 2e-3)
  end
  check.close(scene:energy().impact_loss, 0, 1e-3)
end

-- Where nothing falls, and all is at rest to begin with, forces press and pull two boxes over a floor: together, as friction between them holds.
do
  local pull = impact.force { name = "pull", law = function() return { 2, 0, -3 } end }
  local bodies = { impact.body { name = "floor", shape = impact.plane(), friction = .2, restitution = 1 } }
  for k, name in ipairs { "under", "on" } do
    bodies[k + 1] = impact.body { name = name, shape = impact.box { a = .1, b = .1, c = .1 }, mass = 1, position = { .02 * k, 0, .2 * k - .1 }, friction = 1, restitution = 0 }
  end
  local scene = impact.scene { gravity = { 0, 0, 0 }, duration = 1, piles = "steps", forces = { pull }, bodies = bodies }
  check.equal(scene:run(), "end of time")
  for k, name in ipairs { "under", "on" } do check.close(scene:state(name).position.x, .02 * k + (4 - .2 * 6) / 2 / 2, 5e-5) end
end
