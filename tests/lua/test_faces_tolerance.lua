-- SPDX-License-Identifier: MIT
-- A log lies in a corner of two walls, on a rim on each, when its other rim comes down: what it is held at takes part, at every tolerance.
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

local place, encounters = log_ends(1e-13)
for digits = 12, 8, -1 do
  local there, met = log_ends(10.0 ^ -digits)
  check.equal(met, encounters)
  check.close((there - place):norm(), 0, 10.0 ^ -digits)
end

check.report "faces_tolerance"
