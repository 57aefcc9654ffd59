-- SPDX-License-Identifier: MIT
--- Every example ends at every tolerance, with the same events; looser ones may say that they are inaccurate. Of the dice
--- rounding decides which of a face's corners lands first, whatever the tolerance: they end, with events of their own.
local check = require "check"
local impact = require "impact"
local scenes = arg[1] .. "/scenes/"
arg = {} -- the scenes' own: none

local make, tolerance = impact.scene, nil
impact.scene = function(definition)
  definition.tolerance, definition.max_steps, definition.plot = tolerance, 400000, nil
  return make(definition)
end

local names = { "sphere_wall", "sphere_wall_rolling", "sphere_wall_spin", "two_spheres", "bouncing_ball", "t_handle", "superball",
  "newtons_cradle", "balls_in_a_box", "bowling_ball", "rattleback", "tippe_top", "eulers_disk", "turntable", "dice" }
for _, name in ipairs(names) do
  local first
  for digits = 13, 4, -3 do
    tolerance = 10.0 ^ -digits
    local scene = dofile(scenes .. name .. ".lua")
    local reason = scene:run()
    check.truth(reason == "end of time" or reason == "at rest" or (digits < 13 and reason == "inaccurate"),
      string.format("%s at 1e-%d ends: %s", name, digits, tostring(reason)))
    local events = scene:usage().events
    first = first or events
    for kind, count in pairs(name ~= "dice" and first or {}) do check.equal(events[kind], count) end
  end
end

check.report "tolerances"
