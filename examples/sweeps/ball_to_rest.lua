-- SPDX-License-Identifier: MIT
--- Where a golf ball with backspin comes to rest, over restitution and friction: impact sweep ball_to_rest.lua -j 2
---
--- It bounces until it rolls, and rolls until it stands: all of it in closed form. cells=1000 makes a million of them. Coefficients of a
--- contact are the products of its bodies': the green's are 1.
local impact = require "impact"
local plot = require "quat.plot"

local given = impact.arguments { cells = 100, speed = 4.0, spin = 300.0, height = 2.0, rolling = 0.0005 }
local radius, mass = 0.02135, 0.0459

return impact.sweep {
  parameters = { friction = impact.grid(0.1, 0.6, given.cells), restitution = impact.grid(0, 0.6, given.cells) },
  scene = function(p)
    local ball = impact.body {
      name = "ball", shape = impact.sphere(radius), mass = mass, position = { 0, 0, given.height }, velocity = { given.speed, 0, 0 },
      omega = { 0, -given.spin, 0 }, friction = p.friction, restitution = p.restitution, rolling_friction = given.rolling,
    }
    local green = impact.body { name = "green", static = true, shape = impact.plane(), friction = 1, restitution = 1 }
    return { duration = 1000, output_rate = 0, bodies = { ball, green } }
  end,
  reduce = function(run)
    return { x = run.scene:state "ball".position.x, bounces = run.events.impact, t = run.t, energy_off = run.energy_off }
  end,
  plot = function(t)
    local panel = { xlabel = "restitution", ylabel = "way, m", legend = "top right" }
    for row = 0, given.cells - 1, math.max(1, (given.cells - 1) // 5) do
      local x, y, from = {}, {}, row * given.cells
      for column = 1, given.cells do x[column], y[column] = t.restitution[from + column], t.x[from + column] end
      panel[#panel + 1] = plot.line { x, y, label = string.format("friction %.2f", t.friction[from + 1]) }
    end
    return plot.figure { title = "How far a ball with backspin comes", size = { 1000, 700 }, plot.panel(panel) }
  end,
}
