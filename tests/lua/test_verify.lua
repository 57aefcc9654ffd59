-- SPDX-License-Identifier: MIT
--- scene:verify{}, and `impact SCRIPT --verify`: a right run is found again; one whose law answers otherwise the second time is not.
local check = require "check"
local runner = require "runner"
local impact = require "impact"
local quat = require "quat"
runner.clean()

local function bodies()
  return { impact.body { name = "floor", static = true, shape = impact.plane(), friction = 0.3, restitution = 1 },
    impact.body { name = "egg", shape = impact.ellipsoid { a = 0.1, b = 0.15, c = 0.2 }, position = { 0, 0, 0.7 }, omega = { 3, 1, 2 }, friction = 1, restitution = 0.8 },
    impact.body { name = "ball", shape = impact.sphere(0.1), position = { 2, 0, 0.1 }, velocity = { 1, 0, 0 }, omega = { 0, -3, 0 }, friction = 1 } }
end

local function scene(more)
  local definition = { name = "two", duration = 1.2, bodies = bodies() }
  for key, value in pairs(more or {}) do definition[key] = value end
  return impact.scene(definition)
end

-- Flight, impacts, sliding and rolling; with another tolerance, and with methods of its own.
for _, more in ipairs { {}, { tolerance = 1e-8 }, { methods = { motion = "cvode" } }, { methods = { motion = "rk4", step = 2e-4 } },
  { forces = { impact.force { law = function(t, b) return { -b.position.x, math.sin(3 * t), 0 } end } } } } do
  local run = scene(more)
  assert(run:run { record = true })
  local found = assert(run:verify())
  check.truth(found.good and found.replayed > 3 and found.part > 0.999 and found.replayed <= found.stretches, found:text())
  check.truth(math.max(found.x, found.v, found.q) <= (more.tolerance or more.methods and 1e-10 or 1e-11) * 1e3, found:text())
  check.truth(found.gap > -1e-11 and found:text():find "^%d+ of %d+ stretches %(100 %% of the time%) done again by the other method: off by ", found:text())
  check.truth(found:text():find("by CVODE's BDF", 1, true), "the second method is named: " .. found:text())
end

-- What rests from the start: no event, nothing differs.
local still = impact.scene { duration = 1, bodies = { bodies()[1], impact.body { name = "stone", shape = impact.sphere(0.1), position = { 0, 0, 0.1 } } } }
assert(still:run { record = true })
local stood = assert(still:verify())
check.truth(stood.good and stood.part == 1, stood:text())

-- A box that rocks until it lies: its dying tail is not done again, and the run ends at rest as it did.
local function box(more)
  local definition = { name = "box", density = 500, shape = impact.box { a = 0.1, b = 0.15, c = 0.3 }, friction = 0.8, restitution = 0 }
  for key, value in pairs(more) do definition[key] = value end
  return impact.body(definition)
end
local tilt = quat.from_axis_angle({ 0, 1, 0 }, 0.05)
local height = 0.1 * math.sin(0.05) + 0.3 * math.cos(0.05)
local rocks = impact.scene { duration = 6, bodies = { impact.body { name = "floor", static = true, shape = impact.plane(), friction = 2, restitution = 0 }, box { friction = 2, position = { 0, 0, height }, orientation = tilt } } }
check.equal((assert(rocks:run { record = true })), "at rest")
local rocked = assert(rocks:verify())
check.truth(rocked.good and rocked.part > 0.99 and rocked.replayed < rocked.stretches, rocked:text())

-- A box that topples down a slope by steps: the other method finds how far these err, which is more than is allowed.
local slope = quat.from_axis_angle({ 0, 1, 0 }, 0.5)
local steep = impact.scene { duration = 0.5, piles = "steps", bodies = { impact.body { name = "slope", static = true, orientation = slope, shape = impact.box { a = 3, b = 1, c = 0.1 }, friction = 0.9 },
  box { orientation = slope, position = slope:rotate(quat.vec3(-1, 0, 0.4)) } } }
assert(steep:run { record = true })
local toppled = assert(steep:verify())
check.truth(not toppled.good and toppled.x > 1e-6 and toppled.x < 1e-2 and toppled:text():find "off by .*; allowed are 1e%-07 %(", toppled:text())

-- What the other integrator does not move is not verified, in words.
local rough = impact.scene { duration = 0.1, bodies = { bodies()[1], impact.body { name = "wheel", shape = impact.sphere(0.1), position = { 0, 0, 0.1 }, rolling_friction = 1e-3, velocity = { 1, 0, 0 } } } }
assert(rough:run { record = true })
local none, said = rough:verify()
check.truth(not none and said:find "^not verified: the other integrator cannot move it: .*rolling_friction", said)

-- Steps that are too long for what pulls: another motion, and it is said where.
local coarse = scene { methods = { motion = "rk4", step = 0.05 },
  forces = { impact.force { law = function(_, b) return { -400 * b.mass * b.position.x, 0, 0 } end } } }
assert(coarse:run { record = true })
local found = assert(coarse:verify())
check.truth(not found.good and found.x > 1e-6 and found.t > 0 and found.body and found:text():find "; allowed are 1e%-0%d %(", found:text())

-- A law that answers otherwise the second time: there is nothing to compare with.
local pull = 0
local moody = scene { forces = { impact.force { law = function() return { pull, 0, 0 } end } } }
assert(moody:run { record = true })
pull = 1
local nothing, why = moody:verify()
check.truth(not nothing and why == "two runs of the scene differ: a law of it remembers, or draws lots", why)

check.truth(not pcall(function() return scene():verify() end), "a run that was not recorded")
check.truth(not pcall(impact.scene { duration = 1, bodies = bodies() }.verify, 3), "no scene")

-- ---- the runner ----

local text = [[
  local impact = require "impact"
  local n = 0
  return impact.scene { name = "drop", duration = 0.5, forces = { impact.force { law = function() n = n + 1 return { LAW, 0, 0 } end } }, bodies = {
    impact.body { name = "floor", shape = impact.plane(), restitution = 1 },
    impact.body { name = "ball", shape = impact.sphere(0.1), position = { 0, 0, 0.3 }, restitution = 0.9 } } }]]
local code, out, err = runner.script((text:gsub("LAW", "0.5")), "--verify")
check.equal(code, 0)
check.truth(out:find "verified: %d+ of %d+ stretches %(100 %% of the time%)" and out:find "drop: end of time", out .. err)
check.equal(runner.files(), "drop.csv drop_events.csv")
code, out, err = runner.script((text:gsub("LAW", "0.5")), "--verify --quiet")
check.truth(code == 0 and out == "" and err == "", out .. err)
code, out, err = runner.script((text:gsub("LAW", "n > 500 and 1 or 0")), "--verify --quiet")
check.equal(code, 6)
check.truth(out == "" and err == "impact: two runs of the scene differ: a law of it remembers, or draws lots\n", err)
code, out, err = runner.script([[
  local impact = require "impact"
  return impact.scene { name = "coarse", duration = 0.3, methods = { motion = "rk4", step = 0.05 },
    forces = { impact.force { law = function(_, b) return { -400 * b.mass * b.position.x, 0, 0 } end } }, bodies = {
    impact.body { name = "floor", shape = impact.plane(), friction = 0.3, restitution = 1 },
    impact.body { name = "ball", shape = impact.sphere(0.1), position = { 2, 0, 0.1 }, velocity = { 1, 0, 0 }, friction = 1 } } }]], "--verify --quiet")
check.equal(code, 6)
check.truth(out == "" and err:find "impact: %d+ of %d+ stretches .* off by %S+ %(ball, t = %S+ s%); allowed are %S+ %(.*%)\n$", err)
for _, more in ipairs { "--report", "--resume a" } do check.equal((runner.command("script.lua --verify " .. more)), 2) end
check.equal((runner.command "sweep script.lua --verify"), 2)

check.report "verify"
