-- SPDX-License-Identifier: MIT
--- Two dice are thrown on a table.
---
---   flight     x'' = g, the turning of a free body, in closed form
---   impact     corners, edges and faces; friction 0.4, restitution 0.5; all points of an instant together
---   held       by steps, between the last bounces and rest; their error is told
---   rest       proved by reactions at the corners
local impact = require "impact"
local portrait = require "impact.portrait"
local quat = require "quat"

local function die(name, y, turn, omega)
  return impact.body {
    name = name,
    shape = impact.box { a = 0.008, b = 0.008, c = 0.008, rounding = 0.001 },
    mass = 0.005,
    position = { 0, y, 0.1 },
    orientation = quat.from_axis_angle({ 1, 0.3, 0.2 }, turn),
    velocity = { 0.5, -2 * y, 0 },
    omega = omega,
    friction = 0.4,
    restitution = 0.5,
  }
end

return impact.scene {
  name = "dice",
  gravity = { 0, 0, -9.81 },
  duration = 3,
  output_rate = 100,
  bodies = {
    impact.body { name = "table", shape = impact.plane(), friction = 1, restitution = 1 },
    die("red", 0, 0.4, { 10, 20, 5 }),
    die("white", 0.03, 1.4, { -10, 15, 5 }),
  },
  plot = function(scene) return portrait.space(scene, "red", "table", "A die is thrown") end,
}
