-- SPDX-License-Identifier: MIT
--- How often a bouncing ellipsoid turns over, for each friction and restitution: impact sweep ellipsoid_turns.lua -j 2
---
--- It is thrown flat along the floor, tilted, without spin; all motion stays in one plane. turns is the integral of omega_y / (2 pi) over two
--- seconds; in flight omega_y is constant, so that the trapezoidal rule over the rows is exact there. Coefficients of a contact are the
--- products of its bodies': the floor's are 1.
local impact = require "impact"
local plot = require "quat.plot"

local given = impact.arguments { cells = 40 }

return impact.sweep {
  parameters = { friction = impact.grid(0, 1, given.cells), restitution = impact.grid(0.3, 0.95, given.cells) },
  record = true,
  scene = function(p)
    local body = impact.body {
      name = "ellipsoid", shape = impact.ellipsoid { a = 0.15, b = 0.08, c = 0.1 }, position = { 0, 0, 0.5 }, velocity = { 2, 0, 0 },
      orientation = { math.cos(0.3), 0, math.sin(0.3), 0 }, friction = p.friction, restitution = p.restitution,
    }
    local floor = impact.body { name = "floor", static = true, shape = impact.plane(), friction = 1, restitution = 1 }
    return { duration = 2, output_rate = 20, bodies = { body, floor } }
  end,
  reduce = function(run)
    local track, turns = run.scene:track "ellipsoid", 0
    for i = 2, #track.t do turns = turns + (track.t[i] - track.t[i - 1]) * (track.wy[i] + track.wy[i - 1]) / 2 end
    return { turns = turns / (2 * math.pi), bounces = run.events.impact }
  end,
  plot = function(t)
    local x, y, z, value = {}, {}, {}, {}
    for row = 1, given.cells do
      x[row], y[row], z[row], value[row] = {}, {}, {}, {}
      for column = 1, given.cells do
        local i = (row - 1) * given.cells + column
        x[row][column], y[row][column], z[row][column], value[row][column] = t.friction[i], t.restitution[i], 0, t.turns[i]
      end
    end
    return plot.figure { title = "Turns of a bouncing ellipsoid in two seconds", size = { 1000, 800 },
      plot.panel { xlabel = "friction", ylabel = "restitution", view = { 0, 0 }, zoom = 1.2,
        plot.surface { x, y, z, value = value, range = { -3, 3 }, lines = false } } }
  end,
}
