-- SPDX-License-Identifier: MIT
--- The thesis' figure 10: a ball turned by -90 degrees about y, then 90 about x, then 90 about y. The net turn is -90 degrees about z.
---
---   q = y(pi/2) x(pi/2) y(-pi/2) = z(-pi/2):   the last turn stands first
---
--- fig10.csv holds the four orientations.
local quat = require "quat"
local plot = require "quat.plot"
local csv = require "quat.csv"
local portrait = require "impact.portrait"

local function turn(x, y, degrees)
  return quat.from_axis_angle({ x, y, 0 }, math.rad(degrees))
end

local steps = {
  { "start", quat.new(1, 0, 0, 0) }, { "-90° about y", turn(0, 1, -90) }, { "90° about x", turn(1, 0, 90) }, { "90° about y", turn(0, 1, 90) },
}
local columns = { {}, {}, {}, {}, {} }
local figure = { title = "Three turns about horizontal axes, and one about the vertical", size = { 1600, 520 }, grid = { 4, 1 } }
local q = quat.new(1, 0, 0, 0)
for n, step in ipairs(steps) do
  q = step[2] * q
  for i, value in ipairs { n - 1, q.w, q.x, q.y, q.z } do columns[i][n] = value end
  local state = { position = { 0, 0, 0 }, orientation = q }
  local panel = {
    title = step[1], equal = true, legend = "none", view = { 65, 30 }, zoom = 1.2, frame = false,
    xrange = { -1.2, 1.2 }, yrange = { -1.2, 1.2 }, zrange = { -1.2, 1.2 },
    portrait.sheet(state, { -1.2, -1.2 }, { 1.2, 1.2 }, "teal", 0.35),
  }
  for _, item in ipairs(portrait.ball(state, 1, "red", "blue")) do panel[#panel + 1] = item end
  figure[n] = plot.panel(panel)
end

assert(csv.save("fig10", { "t", "qw", "qx", "qy", "qz" }, columns))
local drawn, why = plot.save(plot.figure(figure), "fig10")
if not drawn then print("fig10: " .. why) end
