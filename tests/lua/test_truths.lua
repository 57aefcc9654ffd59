-- SPDX-License-Identifier: MIT
--- Whole scenes against their motion in 40 digits (tests/generators/scene_truths.py, answers in tests/data/scenes): the default is right,
--- and the certainty that a report states without the truth is no less than a third of the error that the truth shows.
local check = require "check"
local impact = require "impact"
local examples, data = arg[1], arg[2]

local function orbit()
  local speed = math.sqrt((1 + .3) / (1 - .3))
  return impact.scene {
    name = "orbit", duration = 6.283185307179586, gravity = { 0, 0, 0 },
    bodies = {
      { name = "sun", shape = impact.sphere(.01), mass = .5, velocity = { 0, -speed / 2, 0 } },
      { name = "planet", shape = impact.sphere(.01), mass = .5, position = { 1 - .3, 0, 0 }, velocity = { 0, speed / 2, 0 } },
    },
    forces = { impact.attraction { constant = 1 } },
  }
end

local function damped_ball()
  return impact.scene {
    name = "damped_ball", duration = 4, gravity = { 0, 0, -9.81 },
    bodies = {
      { name = "floor", shape = impact.plane(), friction = 1, restitution = 1 },
      { name = "ball", shape = impact.sphere(.1), mass = 1, position = { 0, 0, 1 }, velocity = { 4, 0, 0 }, friction = .2, restitution = .6,
        linear_damping = .3, angular_damping = .5 },
    },
  }
end

local function ellipsoid_in_wind()
  return impact.scene {
    name = "ellipsoid_in_wind", duration = 1.2, gravity = { 0, 0, -9.81 },
    bodies = {
      { name = "floor", shape = impact.plane(), friction = .5, restitution = 1 },
      { name = "ellipsoid", shape = impact.ellipsoid { a = .1, b = .2, c = .3 }, mass = 4, position = { 0, 0, 1 }, velocity = { 1, 0, 0 },
        orientation = { .9, .3, .2, .1 }, omega = { 1, 2, -1 }, friction = .1, restitution = .6, linear_damping = .04 },
    },
    forces = { impact.wind { origin = { 0, 0, 1 }, direction = { 1, 0, 0 }, strength = 5 } },
  }
end

local function example(name)
  return function() return dofile(examples .. "/" .. name .. ".lua") end
end

--- The default's error, and what its certainty is at most over that.
local truths = {
  { "sphere_wall", example "sphere_wall", 1e-12 }, { "bowling_ball", example "bowling_ball", 1e-11 }, { "orbit", orbit, 1e-11 },
  { "damped_ball", damped_ball, 1e-11 }, { "two_spheres", example "two_spheres", 1e-11 }, 
  { "ellipsoid_in_wind", ellipsoid_in_wind, 3e-11 }, -- three impacts magnify what the integrator leaves of each flight
}
for _, truth in ipairs(truths) do
  local name, make, allowed = table.unpack(truth)
  local scene = make()
  local seen = assert(scene:report { seconds = 20, rounds = 1, methods = { "default" }, tolerances = { 1e-13, 1e-14 },
    reference = data .. "/" .. name .. ".csv", reference_error = 1e-15 })
  local blind = assert(scene:report { seconds = 60, rounds = 1, tolerances = { 1e-10, 1e-13, 1e-14 } })
  local e, c = seen:best "default".e, blind.summary.certainty.e
  if os.getenv "TEST_SHOW" then print(name, e, c, c / e) end
  check.truth(e <= allowed, ("%s is off by %.2g"):format(name, e))
  check.truth(blind.summary.sure and c >= e / 3, ("%s: certainty %.2g, error %.2g"):format(name, c, e))
  for _, row in ipairs(seen.rows) do check.equal(row.other_events, 0) end
end

check.report "truths"
