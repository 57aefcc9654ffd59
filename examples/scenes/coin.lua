-- SPDX-License-Identifier: MIT
--- A coin is dropped on its edge, falls over, wobbles and comes to rest.
---
---   flight     x'' = g, the turning of a free body, in closed form
---   impact     the rim and the face; friction 0.4, restitution 0.3
---   held       by steps; rolling friction 0.1 mm, torsional friction 0.05 mm: without them it would wobble on
---   rest       proved by reactions on its face
local impact = require "impact"
local portrait = require "impact.portrait"
local quat = require "quat"

return impact.scene {
  name = "coin",
  gravity = { 0, 0, -9.81 },
  duration = 3,
  output_rate = 100,
  bodies = {
    impact.body { name = "table", shape = impact.plane(), friction = 1, restitution = 1 },
    impact.body {
      name = "coin",
      shape = impact.cylinder { radius = 0.012, half_height = 0.001 },
      density = 7500,
      position = { 0, 0, 0.03 },
      orientation = quat.from_axis_angle({ 1, 0, 0 }, 1.2),
      velocity = { 0.1, 0, 0 },
      omega = { 0, 0, 15 },
      friction = 0.4,
      restitution = 0.3,
      rolling_friction = 1e-4,
      torsional_friction = 5e-5,
    },
  },
  plot = function(scene) return portrait.space(scene, "coin", "table", "A coin falls over") end,
}
