-- SPDX-License-Identifier: MIT
--- The thesis' figure 10: a ball turned by -90 degrees about y, then 90 about x, then 90 about y. The net turn is -90 degrees about z.
--- Colours and a disc show the orientation.
---
---   q = y(pi/2) x(pi/2) y(-pi/2) = z(-pi/2):   the last turn stands first
---
--- fig10.csv holds the four orientations.
local quat = require "quat"
local plot = require "quat.plot"
local csv = require "quat.csv"
local portrait = require "impact.portrait"

local turns = { { 0, -math.pi / 2, 0 }, { math.pi / 2, 0, 0 }, { 0, math.pi / 2, 0 } }
local titles = { "start", "−90° about y", "then 90° about x", "then 90° about y" }
local orientations = quat.chain({ 1, 0, 0, 0 }, turns, 1)

local columns = { {}, {}, {}, {}, {} }
local figure = {
  title = "Three turns about horizontal axes are one about the vertical, by −90°", size = { 1600, 560 }, grid = { 4, 1 },
}
--- Half of a disc about the ball, in the plane of its own x and y; the halves, at positive and negative x, in two colours.
local function half_disc(q, side)
  local x, y, z = {}, {}, {}
  for i = 0, 8 do
    x[i + 1], y[i + 1], z[i + 1] = {}, {}, {}
    for j = 0, 48 do
      local radius, angle = 1 + 0.45 * i / 8, math.pi * (j / 48 - 0.5)
      local p = q:rotate { side * radius * math.cos(angle), radius * math.sin(angle), 0 }
      x[i + 1][j + 1], y[i + 1][j + 1], z[i + 1][j + 1] = p.x, p.y, p.z
    end
  end
  return plot.surface { x, y, z, color = side > 0 and "#2c7a7b" or "#b8dcd8", opacity = 0.9 }
end

local view = { 65, 30 }
local eye = portrait.eye(view)
for n, q in ipairs(orientations) do
  for i, value in ipairs { n - 1, q.w, q.x, q.y, q.z } do columns[i][n] = value end
  local state = { position = { 0, 0, 0 }, orientation = q }
  local panel = {
    title = titles[n], equal = true, legend = "none", view = view, zoom = 1.7, frame = false,
    xrange = { -1.7, 1.7 }, yrange = { -1.7, 1.7 }, zrange = { -1.5, 1.5 },
    half_disc(q, 1), half_disc(q, -1),
  }
  for _, item in ipairs(portrait.ball(state, 1, "#dd6b20", "#2b6cb0")) do panel[#panel + 1] = item end
  -- The axis of the turn that led here; at the end that of all three.
  local axis = turns[n - 1]
  if axis then
    local x, y = axis[1] ~= 0 and 1 or 0, axis[2] ~= 0 and 1 or 0
    local near = eye[1] * x + eye[2] * y > 0 and 1 or -1
    for side = -1, 1, 2 do
      panel[#panel + 1] = plot.arrows { { side * x }, { side * y }, { 0 }, { 0.7 * side * x }, { 0.7 * side * y }, { 0 }, color = "dark",
        width = 2.5, head = 0, front = side == near }
    end
    panel[#panel + 1] = plot.text { x == 1 and "x" or "y", at = { 1.9 * x, 1.9 * y, 0 }, size = 13, align = "center" }
  end
  if n == #orientations then
    panel[#panel + 1] = plot.line { { 0, 0 }, { 0, 0 }, { -1.5, 1.5 }, color = "purple", width = 2.5, dash = true }
    panel[#panel + 1] = plot.text { "in all: −90° about z", at = { 0, 0, 1.65 }, align = "center", size = 12, color = "purple" }
  end
  figure[n] = plot.panel(panel)
end

assert(csv.save("fig10", { "t", "qw", "qx", "qy", "qz" }, columns))
local drawn, why = plot.save(plot.figure(figure), "fig10")
if not drawn then print("fig10: " .. why) end
