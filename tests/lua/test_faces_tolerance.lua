-- SPDX-License-Identifier: MIT
-- What is held is put back before what lands is looked at: no tolerance decides what lands with it.
local check = require "check"
local impact = require "impact"
local quat = require "quat"

local function wall(name, around)
  local normal = quat.vec3 { -math.sin(0.6) * math.cos(around), -math.sin(0.6) * math.sin(around), math.cos(0.6) }
  return impact.body { name = name, static = true, shape = impact.box { a = 0.6, b = 0.6, c = 0.2 }, friction = 0, restitution = 1,
    orientation = quat.from_two_vectors({ 0, 0, 1 }, normal),
    position = normal * -0.2 + quat.vec3 { 0.5 * math.cos(around), 0.5 * math.sin(around), 0.5 * math.tan(0.6) } }
end

local function log_ends(tolerance)
  local scene = impact.scene { gravity = { 0, 0, -9.81 }, duration = 0.3, tolerance = tolerance, output_rate = 0,
    bodies = { wall("east", 0), wall("north", math.pi / 3),
      impact.body { name = "log", shape = impact.cylinder { radius = 0.123, half_height = 0.186 }, mass = 1, restitution = 0.3,
        position = { 0.2923698, 0.1889027, 0.3953356 }, velocity = { 0.3186216, 0.07061575, -0.0533464 },
        orientation = { -0.448076, 0.3846494, 0.3884869, 0.7073547 }, omega = { 2.439646, 1.730972, -5.037316 } } } }
  check.equal(scene:run(), "end of time")
  check.equal(scene:usage().pile_steps, 0)
  return scene:state("log").position, scene:usage().encounters
end

-- A log lies in a corner of two walls, on a rim on each, when its other rim comes down: what it is held at takes part.
local place, encounters = log_ends(1e-13)
for digits = 12, 8, -1 do
  local there, met = log_ends(10.0 ^ -digits)
  check.equal(met, encounters)
  check.close((there - place):norm(), 0, 10.0 ^ -digits)
end

-- A bar that slips on an edge without friction turns about it: its four corners come down as one, and leave it level.
local function bar_ends(tolerance, floor)
  local tilted = quat.from_axis_angle({ 0, 1, 0 }, 0.5)
  local shape = impact.box { a = 0.5, b = 0.1, c = 0.02 }
  local scene = impact.scene { gravity = { 0, 0, -9.81 }, duration = 0.45, tolerance = tolerance, output_rate = 0,
    bodies = { floor, impact.body { name = "bar", shape = shape, mass = 1, position = { 0, 0, (shape:support(tilted:rotate_inverse { 0, 0, -1 })) },
      orientation = tilted, velocity = { 0.3, 0, 0 }, omega = { 0.1, 0, 0.2 }, friction = 0, restitution = 0.5 } } }
  check.equal(scene:run(), "end of time")
  check.equal(scene:usage().pile_steps, 0)
  check.equal(scene:usage().encounters, 1)
  local bar = scene:state "bar"
  check.close(bar.orientation:rotate({ 0, 1, 0 }).z, 0, tolerance)
  return bar.position
end

local wide = impact.body { name = "floor", static = true, shape = impact.box { a = 4, b = 4, c = 1 }, position = { 0, 0, -1 },
  friction = 1, restitution = 1 }
for _, floor in ipairs { impact.body { name = "floor", shape = impact.plane(), friction = 1, restitution = 1 }, wide } do
  local level = bar_ends(1e-13, floor)
  for digits = 12, 6, -1 do check.close((bar_ends(10.0 ^ -digits, floor) - level):norm(), 0, 10.0 ^ -digits) end
end

-- Whatever it is tilted by when it lands, the wide floor has one normal under it.
for run = -20, 19 do bar_ends(1e-9 * (1 + run / 500), wide) end

check.report "faces_tolerance"
