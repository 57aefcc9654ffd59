-- SPDX-License-Identifier: MIT
--- Bodies with faces in scenes: what rests is at rest at once, what slides and falls does so by the closed form, and what is thrown
--- comes to rest on the floor, not in it.
local impact = require "impact"
local quat = require "quat"
local check = require "check"

local G = 9.81
local degree = math.pi / 180

local function floor(friction)
  return impact.body { name = "floor", shape = impact.plane(), friction = friction or .5, restitution = .3 }
end

local function run(bodies, duration, more, on_sample)
  local def = { gravity = { 0, 0, -G }, duration = duration, bodies = bodies }
  for key, value in pairs(more or {}) do def[key] = value end
  local scene = impact.scene(def)
  check.truth(scene:run { on_sample = on_sample }, "it runs")
  return scene
end

local function off_account(energy)
  return math.abs(energy.start + energy.force_work + energy.drive_work - energy.damping_loss - energy.sliding_loss
    - energy.impact_loss - energy.kinetic - energy.potential)
end

-- Thin plates that steps move (they are damped) slide to their rest, and stay on the floor: what lies higher than a plate is thick is of
-- another face of it than the one that lies (once their tops were held on the floor, and they were flung up by metres).
do
  math.randomseed(10)
  local function between(low, high) return low + (high - low) * math.random() end
  for _ = 1, 40 do
    local a, b = between(.03, .5), between(.03, .5)
    local c = math.min(a, b) * 10 ^ between(-2.5, -1)
    local highest = 0
    local scene = run({ floor(1), impact.body { name = "plate", shape = impact.box { a = a, b = b, c = c }, density = 1000, position = { 0, 0, c },
      velocity = { between(-3, 3), between(-3, 3), 0 }, omega = { 0, 0, between(-8, 8) }, friction = between(0, .8), linear_damping = .1 } }, .5,
      { piles = "steps" }, function(sample) highest = math.max(highest, (sample.position or sample).z) end)
    check.close(highest, c, 1e-6)
    check.truth(scene:energy().impact_loss > -1e-6, "steps give it no energy")
  end
end

-- Steps, and what glides exactly, end at the edges of forces: a box blown over .2 m, and a force that ends at x = .2 by its own edge; without friction, and
-- with.
do
  local reach, force = .2, 3
  local wind = impact.wind { strength = force, direction = { 1, 0, 0 }, reach = reach, radius = 10 }
  local custom = impact.force { name = "push", law = function(_, b) return b.position.x < reach and { force, 0, 0 } or { 0, 0, 0 } end,
    edge = function(_, b) return b.position.x - reach end }
  local function blow(law, mu, piles)
    local scene = run({ floor(), impact.body { name = "box", shape = impact.box { a = .1, b = .1, c = .1 }, mass = 1, position = { 0, 0, .1 },
      velocity = { 1, 0, 0 } } }, 2, { forces = { law }, piles = piles, pile_tolerance = 1e-5, pairs = { { bodies = { "floor", "box" }, friction = mu } } })
    local v = math.sqrt(1 + 2 * (force - mu * G) * reach)
    local x = mu == 0 and reach + v * (2 - (v - 1) / force) or reach + v ^ 2 / (2 * mu * G)
    check.close(scene:energy().force_work, force * reach, 1e-9)
    return scene, math.abs(scene:state("box").position.x - x)
  end
  for _, law in ipairs { wind, custom } do
    for _, mu in ipairs { 0, .1 } do
      local scene, off = blow(law, mu, "steps")
      check.truth(scene:usage().pile_steps > 0, "it goes by steps")
      check.truth(off <= (mu == 0 and 1e-9 or 1e-5 * .1 * math.sqrt(3)), "off by " .. off) -- the step in which it stops errs by so much
      scene, off = blow(law, mu)
      check.truth(off <= 1e-9, "off by " .. off)
    end
  end
end

-- A stack of ten, masses 1 and 1e4 in turn: at rest at once, and each carries what stands on it.
local stack, weight = { floor() }, {}
for i = 1, 10 do
  weight[i] = (i % 2 == 0 and 1e4 or 1) * G
  stack[i + 1] = impact.body { name = "b" .. i, shape = impact.box { a = .1, b = .1, c = .05 }, mass = weight[i] / G,
    position = { .03 * (i % 3), .02 * (i % 2), .05 + .1 * (i - 1) }, friction = .5, restitution = .3 }
end
local scene = run(stack, 1)
check.equal(scene:time(), 0)
local carried = {}
for _, held in ipairs(scene:held()) do
  local lower = held.body2 == "floor" and 0 or tonumber(held.body2:sub(2))
  local upper = tonumber(held.body1:sub(2)) or 0
  local between = math.max(lower, upper)
  carried[between] = (carried[between] or 0) + math.abs(held.force.z)
end
local above = 0
for i = 10, 1, -1 do
  above = above + weight[i]
  check.close(carried[i], above, 1e-12 * 5e4 * G)
end

-- Boxes one over another by 1/2, 1/4, 1/6 of their length stand just within, and fall just beyond.
for _, part in ipairs { 1 - 1e-3, 1 + 1e-3 } do
  local x, bodies = 0, { floor() }
  for i = 4, 1, -1 do
    bodies[#bodies + 1] = impact.body { name = "b" .. i, shape = impact.box { a = .1, b = .05, c = .02 }, mass = 1,
      position = { x, 0, .02 + .04 * (4 - i) }, friction = .5, restitution = 0 }
    x = x + part * .1 / (i - 1)
  end
  local standing = run(bodies, .05)
  check.truth((standing:time() == 0) == (part < 1), "the overhang " .. part)
end

-- A box on a slope: it stays where tan <= mu, and slides by g (sin - mu cos) t^2/2 where not.
for _, case in ipairs { { .3, 16 }, { .3, 17 }, { .3, 30 }, { 0, 10 }, { 1, 44 } } do
  local mu, slope = case[1], case[2] * degree
  local pull = G * (math.sin(slope) - mu * math.cos(slope))
  local sliding = run({ floor(mu), impact.body { name = "box", shape = impact.box { a = .1, b = .1, c = .05 }, mass = 2,
    position = { 0, 0, .05 }, friction = 1, restitution = .3 } }, .5, { gravity = { G * math.sin(slope), 0, -G * math.cos(slope) } })
  local x = sliding:state("box").position
  check.close(x.x, pull > 0 and pull * .5 ^ 2 / 2 or 0, 1e-8)
  check.close(x.z, .05, 1e-12)
  check.truth(off_account(sliding:energy()) < 1e-12, "the account of a box on a slope")
end

-- A tall box on a slope with grip topples where tan > b/h.
for _, tilt in ipairs { 26, 27 } do -- atan(1/2) is 26.57 degrees
  local tall = run({ floor(2), impact.body { name = "box", shape = impact.box { a = .05, b = .05, c = .1 }, mass = 1,
    position = { 0, 0, .1 }, friction = 1, restitution = 0 } }, .3,
    { gravity = { G * math.sin(tilt * degree), 0, -G * math.cos(tilt * degree) } })
  check.truth((tall:time() == 0) == (tilt == 26), "a tall box at " .. tilt)
end

-- A box that falls flat on a floor gets no spin.
local flat = run({ floor(), impact.body { name = "box", shape = impact.box { a = .1, b = .2, c = .05 }, mass = 1,
  position = { .3, .1, .15 }, orientation = quat.from_axis_angle({ 0, 0, 1 }, .7), friction = .5, restitution = .4 } }, 2)
local landed = flat:state "box"
check.close(landed.position.x, .3, 1e-12)
check.close(landed.position.z, .05, 1e-12)
check.truth(landed.omega.x == 0 and landed.omega.y == 0 and landed.omega.z == 0, "no spin")

-- A force that begins moves a box that rests; a belt drags what is set on it; damping beside friction; planes with edges are refused.
local function box_on(under, more, extra)
  local body = { name = "box", shape = impact.box { a = .1, b = .1, c = .1 }, mass = 1, position = { 0, 0, .1 }, friction = 1 }
  for key, value in pairs(more or {}) do body[key] = value end
  local moved = run({ under, impact.body(body) }, 2, extra)
  check.truth(off_account(moved:energy()) < 1e-11 * moved:energy().start + 1e-11, "the account of a box that is moved")
  return moved:state("box"), moved:energy()
end
-- at friction 1 it would be about to tip
local pushed = box_on(floor(.8), nil, { forces = { impact.force { law = function(t) return { t >= 1 and 12 or 0, 0, 0 } end, switches = { 1 } } } })
check.close(pushed.position.x, (12 - .8 * G) / 2, 1e-9)
local belt = impact.body { name = "belt", shape = impact.plane(), velocity = { 2, 0, 0 }, friction = 1 }
local dragged, account = box_on(belt, nil, { pile_tolerance = 1e-4 })
check.close(dragged.position.x, 4 - 2 / G, 1e-5)
check.close(account.drive_work, 4, 1e-6)
local k, v = math.log(2), 2
local damped = box_on(floor(.2), { velocity = { v, 0, 0 }, linear_damping = .5 }, { pile_tolerance = 1e-4 }) -- v' = -k v - mu g, until it stops
local stop = math.log(1 + k * v / (.2 * G)) / k
check.close(damped.position.x, v / k - .2 * G / k * stop, 5e-6)
check.raises("body 'table': a plane with edges carries no bodies with faces: take a static box, or a plane without edges", function()
  box_on(impact.body { name = "table", shape = impact.plane { width = 1, depth = 1 } })
end)

-- Each kind, thrown: it comes to rest upon the floor, or rolls there.
local shapes = {
  box = impact.box { a = .05, b = .04, c = .03, rounding = .004 },
  cylinder = impact.cylinder { radius = .05, half_height = .02 },
  capsule = impact.capsule { radius = .02, half_height = .06 },
  polyhedron = impact.polyhedron { vertices = { { .05, 0, 0 }, { -.05, .05, 0 }, { -.05, -.05, 0 }, { 0, 0, .07 } } },
  cone = impact.cone { radius = .05, height = .08 },
}
for kind, shape in pairs(shapes) do
  for throw = 1, 5 do
    local lowest = math.huge -- not under the floor by more than a step may be off
    local function look(sample)
      if sample.body ~= "it" then return end
      local it = { shape = shape, position = sample.position, orientation = sample.orientation }
      lowest = math.min(lowest, impact.gap(it, { shape = impact.plane() }).gap)
    end
    local thrown = run({ floor(), impact.body { name = "it", shape = shape, density = 1000, position = { 0, 0, .2 },
      velocity = { .3 * throw - 1, .2, -1 }, omega = { 3 * throw, -4, 2 }, friction = .5, restitution = .4,
      orientation = quat.from_axis_angle({ 1, throw, .5 }, throw) } }, 3, { output_rate = 200 }, look)
    check.truth(lowest > -1e-5 * .05, ("%s, throw %d: %g m in the floor"):format(kind, throw, lowest))
    check.truth((kind ~= "box" and kind ~= "polyhedron") or thrown:time() < 3, kind .. " comes to rest")
    check.truth(off_account(thrown:energy()) < 1e-11, "the account of a " .. kind)
  end
end

-- Just beyond what stands: the box turns about its lower edge, theta'' = 3 g/(4 d) sin theta from the edge upward, by small steps. Corners
-- that rise are not held.
for _, beyond in ipairs { 1e-2, 1e-3, 1e-4 } do
  local slope, g = math.atan(.5 * (1 + beyond)), G
  local d, over, omega, want = math.sqrt(.05 ^ 2 + .1 ^ 2), slope - math.atan(.5), 0, 0
  for _ = 1, 10000000 do
    omega = omega + 1e-5 * 3 * g / (4 * d) * math.sin(over)
    over, want = over + 1e-5 * omega, want + 1e-5
    if over - slope + math.atan(.5) >= .5 then break end
  end
  local reached
  run({ floor(1), impact.body { name = "box", shape = impact.box { a = .05, b = .05, c = .1 }, position = { 0, 0, .1 }, friction = 2 } },
    want + .01, { gravity = { G * math.sin(slope), 0, -G * math.cos(slope) }, output_rate = 1000 }, function(sample)
      if sample.body == "box" and not reached and 2 * math.atan(sample.orientation.y, sample.orientation.w) > .5 then reached = sample.t end
    end)
  check.close(reached, want, 4e-3)
end

-- What rolls on its side stays on the floor, and straight on, however fast: the points of its line go round it.
for _, case in ipairs { { "cylinder", 10 }, { "capsule", 10 }, { "cylinder", 50 } } do
  local kind, v = case[1], case[2]
  local shape = impact[kind] { radius = .1, half_height = .2 }
  local on_side = quat.from_axis_angle({ 1, 0, 0 }, 90 * degree)
  local highest = 0
  local rolled = run({ floor(), impact.body { name = "log", shape = shape, position = { 0, 0, .1 }, orientation = on_side, friction = .5,
    velocity = { v, 0, 0 }, omega = { 0, 10 * v, 0 } } }, 1, { piles = "steps", output_rate = 200 }, function(sample)
      if sample.body == "log" then highest = math.max(highest, math.abs(sample.velocity.z)) end
    end)
  check.truth(highest < 1e-11, ("a %s that rolls leaves the floor at %g m/s"):format(kind, highest))
  check.close(rolled:state("log").position.x, v, 1e-10)
  check.close(rolled:state("log").omega.x, 0, 1e-10)
end

check.report "faces_held"
