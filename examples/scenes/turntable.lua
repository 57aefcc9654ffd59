-- SPDX-License-Identifier: MIT
--- Balls on a turntable go round, at 2/7 of its rate, wherever they are.
---
--- On a table that turns at W about z, friction F on a solid ball gives m v' = F and (2/5) m r^2 w' = -r z x F. So that, sliding or not,
---
---   w + (5/(2 r)) z x v = const,        and rolling, v - r w x z = W z x x, makes of it        v' = (2/7) W z x v :
---
--- circles at 2/7 W about a point of the ball's own. The ball that is thrown rolls from the start, about x0 + z x v0/(2/7 W); the one
--- that is set down slides at first, and, as its constant is 0, it then goes round the table's axis, v = (2/7) W z x x.
local impact = require "impact"
local plot = require "quat.plot"

local W, r = 7 * math.pi / 3, 0.02 -- seven rounds in 6 s, and two of theirs
local rate = 2 / 7 * W
local v0 = 0.15 * rate
local start, centre = { 0.7, 0, r }, { 0.55, 0 }

--- The thrown ball's place at time t.
local function circle(t) return centre[1] + v0 / rate * math.cos(rate * t), centre[2] + v0 / rate * math.sin(rate * t) end

--- The columns x, y of a track, in the laboratory or in axes that turn with the table.
local function seen(track, turns)
  local x, y = {}, {}
  for i = 1, #track.t do
    local a = turns and W * track.t[i] or 0
    x[i] = math.cos(a) * track.x[i] + math.sin(a) * track.y[i]
    y[i] = math.cos(a) * track.y[i] - math.sin(a) * track.x[i]
  end
  return x, y
end

local function draw(scene)
  local thrown, set = scene:track("thrown", 500), scene:track("set down", 500)
  local slides = scene:first("stick", "set down", "table").t
  local off, off_set, rim = { t = {} }, { t = {} }, { {}, {} }
  local rows = scene:track "thrown"
  for i = 1, #rows.t do
    local x, y = circle(rows.t[i])
    off[i], off.t[i] = math.max(math.sqrt((rows.x[i] - x) ^ 2 + (rows.y[i] - y) ^ 2), 1e-17), rows.t[i]
  end
  rows = scene:track "set down"
  for i = 1, #rows.t do
    if rows.t[i] > slides then
      local along, across = rows.vx[i] + rate * rows.y[i], rows.vy[i] - rate * rows.x[i]
      off_set[#off_set + 1] = math.max(math.sqrt(along ^ 2 + across ^ 2), 1e-17)
      off_set.t[#off_set.t + 1] = rows.t[i]
    end
  end
  for i = 0, 120 do
    rim[1][i + 1], rim[2][i + 1] = 0.8 * math.cos(math.pi * i / 60), 0.8 * math.sin(math.pi * i / 60)
  end
  local function above(title, turns)
    local x1, y1 = seen(thrown, turns)
    local x2, y2 = seen(set, turns)
    return plot.panel {
      title = title, xlabel = "x, m", ylabel = turns and "" or "y, m", equal = true, legend = turns and "none" or "top right",
      xrange = { -0.9, 0.9 }, yrange = { -0.9, 1.1 },
      plot.line { rim[1], rim[2], color = "grey" },
      plot.line { x1, y1, color = "blue", width = 2, label = "thrown" },
      plot.line { x2, y2, color = "orange", width = 2, label = "set down" },
      plot.points { { x1[1], x2[1] }, { y1[1], y2[1] }, color = "green", size = 1.4, label = "start" },
    }
  end
  return plot.figure {
    title = "Balls on a turntable go round at 2/7 of its rate",
    subtitle = string.format("seven rounds of its, two of theirs; after %.3f s the one set down no longer slides", slides),
    size = { 1700, 640 },
    grid = { 3, 1 },
    above("from above", false),
    above("from above, turning along", true),
    plot.panel {
      title = "less the closed form's (1e-17: the same)", xlabel = "time, s", ylog = true, legend = "bottom right", yrange = { 1e-17, 1e-10 },
      plot.points { off.t, off, color = "blue", size = 0.7, label = "place, m" },
      plot.points { off_set.t, off_set, color = "orange", size = 0.7, label = "velocity, m/s" },
    },
  }
end

return impact.scene {
  name = "turntable",
  gravity = { 0, 0, -9.81 },
  duration = 6,
  output_rate = 24,
  bodies = {
    impact.body { name = "table", shape = impact.plane(), omega = { 0, 0, W }, friction = 1 },
    impact.body {
      name = "thrown", shape = impact.sphere(r), position = start, velocity = { 0, v0, 0 }, friction = 0.3,
      omega = { (W * start[1] - v0) / r, 0, 0 }, -- v - r w x z = W z x x
    },
    impact.body { name = "set down", shape = impact.sphere(r), position = { 0, 0.12, r }, friction = 0.3 },
  },
  plot = draw,
}
