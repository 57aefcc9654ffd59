-- SPDX-License-Identifier: MIT
--- The thesis' figure 11: the ball trick. A hand rolls a ball on a table in small circles, and the ball turns about the vertical.
---
--- A unit ball is rolled by dt = pi/250 per step about a horizontal axis that advances by pi/50 per step, so that a hundred steps are
--- one circle of the hand, of radius r = dt/(pi/50) = 1/5; a thousand steps are ten:
---
---   q_(n+1) = (cos dt/2, sin dt/2 axis_n) q_n,   axis_n = (sin n pi/50, -cos n pi/50, 0)
---
--- (q1, q2, q3) does not close: it drifts along q3. In the limit of small steps the net turn of one circle is
--- 2 pi (sqrt(1 + r^2) - 1) = 7.13 degrees about an axis tilted by atan r from -z: -6.99 degrees about z.
local quat = require "quat"
local plot = require "quat.plot"
local csv = require "quat.csv"

local q = quat.new(1, 0, 0, 0)
local columns = { {}, {}, {}, {}, {} }
local function keep(n)
  for i, value in ipairs { n, q.w, q.x, q.y, q.z } do columns[i][n + 1] = value end
end
keep(0)
for n = 1, 1000 do
  local angle = n * math.pi / 50
  q = quat.from_axis_angle({ math.sin(angle), -math.cos(angle), 0 }, math.pi / 250) * q
  keep(n)
end

assert(csv.save("fig11", { "t", "qw", "qx", "qy", "qz" }, columns))
local zero = {}
for i = 1, #columns[1] do zero[i] = 0 end
local drawn, why = plot.save(plot.figure {
  size = { 1400, 620 },
  grid = { 2, 1 },
  plot.panel {
    title = "ten small circles of the hand", xlabel = "q₁", ylabel = "q₂", zlabel = "q₃", legend = "none", view = { 65, 35 },
    zoom = 1.1, plot.line { columns[3], columns[4], columns[5], color = "blue", width = 1.5 },
    plot.points { { 0 }, { 0 }, { 0 }, color = "green", size = 1.5 },
    plot.points { { columns[3][1001] }, { columns[4][1001] }, { columns[5][1001] }, color = "red", size = 1.5 },
  },
  plot.panel {
    title = "the turn about the vertical", xlabel = "step", ylabel = "q₃", legend = "none",
    plot.line { columns[1], columns[5], color = "blue" },
  },
}, "fig11")
if not drawn then print("fig11: " .. why) end
