-- SPDX-License-Identifier: MIT
--- Balls of restitution 0.3, 0.5 and 0.8, dropped from z = 1 m on a floor of restitution 1: what thesis.py --compare sets beside Blender's own
--- rigid bodies. From a height h over the floor a ball comes back to e^2 h: z = r + e^2 (1 - r).
local impact = require "impact"

local bodies = { impact.body { name = "floor", shape = impact.plane { width = 8, depth = 8 }, friction = 0.25, restitution = 1 } }
for i, e in ipairs { 0.3, 0.5, 0.8 } do
  bodies[i + 1] = impact.body {
    name = "ball " .. e, shape = impact.sphere(0.3), mass = 4, position = { i - 2, 0, 1 }, friction = 0.25, restitution = e,
  }
end

return impact.scene { name = "drop", gravity = { 0, 0, -9.81 }, duration = 1.5, output_rate = 24, rules = { restitution = "product" }, bodies = bodies }
