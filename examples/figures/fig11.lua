-- SPDX-License-Identifier: MIT
--- The thesis' figure 11: the ball trick. A hand rolls a ball on a table in small circles, and the ball turns about the vertical.
---
--- A unit ball is rolled by dt = pi/250 per step about a horizontal axis that advances by pi/50 per step, so that a hundred steps are
--- one circle of the hand, of radius r = dt/(pi/50) = 1/5; a thousand steps are ten:
---
---   q_(n+1) = (cos dt/2, sin dt/2 axis_n) q_n,   axis_n = (sin n pi/50, -cos n pi/50, 0)
---
--- The hand that turns the ball so goes counter-clockwise, the ball clockwise: (q1, q2, q3) does not close, it drifts along q3. In the
--- limit of small steps the net turn of one circle is 2 pi (sqrt(1 + r^2) - 1) = 7.13 degrees about an axis tilted by atan r from -z:
--- -6.99 degrees about z.
local quat = require "quat"
local plot = require "quat.plot"
local csv = require "quat.csv"

local pi = math.pi

-- The hand's strokes: d with z x d = dt axis.
local hand = { { 0, 0 } }
for n = 1, 1000 do
  local angle, last = n * pi / 50, hand[n]
  hand[n + 1] = { last[1] - pi / 250 * math.cos(angle), last[2] - pi / 250 * math.sin(angle) }
end
local columns = { {}, {}, {}, {}, {} }
local turned = {}
for n, q in ipairs(quat.roll_path({ 1, 0, 0, 0 }, hand)) do
  for i, value in ipairs { n - 1, q.w, q.x, q.y, q.z } do columns[i][n] = value end
  turned[n] = math.deg(2 * math.atan(q.z, q.w))
end
-- One round in closed form: how much of it is about z.
local round = quat.from_rotation_vector(quat.roll_loop(1 / 5))
local each = math.deg(2 * math.atan(round.z, round.w))

assert(csv.save("fig11", { "t", "qw", "qx", "qy", "qz" }, columns))
local circles, limit = {}, {}
for n = 0, 10 do circles[n + 1], limit[n + 1] = 100 * n, n * each end
local last = #columns[1]
local drawn, why = plot.save(plot.figure {
  title = "The ball trick: circles of the hand turn the ball the other way", size = { 1400, 680 },
  plot.panel {
    title = "its orientation (q₁, q₂, q₃) during ten circles of the hand", xlabel = "q₁", ylabel = "q₂", zlabel = "q₃", legend = "none",
    view = { 68, 35 }, equal = true, zoom = 0.93, box = { 0.02, 0.0, 0.5, 0.9 },
    xrange = { -0.1, 0.3 }, yrange = { -0.2, 0.2 }, zrange = { -0.6, 0 },
    plot.line { columns[3], columns[4], columns[5], color = "blue", width = 2 },
    plot.points { { 0 }, { 0 }, { 0 }, color = "dark", size = 1.8, shape = "circle" },
    plot.points { { columns[3][last] }, { columns[4][last] }, { columns[5][last] }, color = "orange", size = 1.6 },
    plot.text { "start", at = { 0.01, 0, 0.035 }, size = 12 },
    plot.text { "after ten", at = { columns[3][last] - 0.025, columns[4][last], columns[5][last] + 0.005 }, size = 12, align = "right", color = "orange" },
  },
  plot.panel {
    title = "how far it has turned about the vertical", xlabel = "step", ylabel = "degrees", legend = "top right", box = { 0.6, 0.13, 0.97, 0.86 },
    plot.line { columns[1], turned, color = "blue", width = 2.2, label = "rolled, a thousand steps" },
    plot.points { circles, limit, color = "orange", size = 1.5, shape = "circle", label = string.format("closed form: %.2f° a circle", each) },
  },
}, "fig11")
if not drawn then print("fig11: " .. why) end
