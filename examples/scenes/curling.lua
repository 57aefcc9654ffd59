-- SPDX-License-Identifier: MIT
--- A curling stone slides, turning, into another; both come to rest.
---
---   slides     on its face, a disc: friction 0.015 at each of its places, against the slip there, integrated in three degrees of freedom
---   impact     stone on stone, restitution 0.8, with friction 0.2
---   rest       where slip and turning end, at one instant; proved by reactions
local impact = require "impact"
local plot = require "quat.plot"

local radius, height = 0.14, 0.057
local function stone(name, x, y, v, omega)
  return impact.body {
    name = name,
    shape = impact.cylinder { radius = radius, half_height = height, rounding = 0.02 },
    mass = 19,
    position = { x, y, height },
    velocity = { v, 0, 0 },
    omega = { 0, 0, omega },
    friction = 0.2,
    restitution = 0.8,
  }
end

local function draw(scene)
  local ways = { title = "A curling stone meets another", xlabel = "x, m", ylabel = "y, m", equal = true, legend = "top left",
    xrange = { -0.5, 10.5 }, yrange = { -0.8, 1.2 } }
  for i, name in ipairs { "thrown", "lying" } do
    local track = scene:track(name)
    ways[#ways + 1] = plot.line { track.x, track.y, color = i == 1 and "orange" or "blue", width = 2, label = name }
    for _, k in ipairs { 1, #track.t } do
      local xs, ys = {}, {}
      for j = 0, 64 do
        xs[#xs + 1] = track.x[k] + radius * math.cos(j * math.pi / 32)
        ys[#ys + 1] = track.y[k] + radius * math.sin(j * math.pi / 32)
      end
      ways[#ways + 1] = plot.line { xs, ys, color = i == 1 and "orange" or "blue", width = 1 }
    end
  end
  return plot.figure { plot.panel(ways), size = { 1100, 300 } }
end

return impact.scene {
  name = "curling",
  gravity = { 0, 0, -9.81 },
  duration = 60,
  output_rate = 10,
  bodies = {
    impact.body { name = "ice", shape = impact.plane(), friction = 1, restitution = 0 },
    stone("thrown", 0, 0, 1.8, 1.5),
    stone("lying", 8, 0.1, 0, 0),
  },
  pairs = {
    { bodies = { "thrown", "ice" }, friction = 0.015 },
    { bodies = { "lying", "ice" }, friction = 0.015 },
  },
  plot = draw,
}
