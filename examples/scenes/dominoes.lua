-- SPDX-License-Identifier: MIT
--- Five dominoes: the first is pushed over, and brings down the others.
---
---   standing   reactions at the four corners of each hold it: proved at t = 0, and nothing moves until it is struck
---   struck     corner on face, edge on face: all points that touch at the instant answer together (Moreau, Poisson; restitution 0.3)
---   falling    dominoes that lean on each other are moved by steps; the closing summary tells their error
---   rest       proved by reactions, for all that touch
local impact = require "impact"
local plot = require "quat.plot"
local quat = require "quat"

local count, half = 5, { x = 0.004, y = 0.012, z = 0.024 }
local bodies = { impact.body { name = "table", shape = impact.plane(), friction = 0.5 } }
for i = 1, count do
  bodies[i + 1] = impact.body {
    name = "domino " .. i,
    shape = impact.box { a = half.x, b = half.y, c = half.z },
    mass = 0.008,
    position = { 0.02 * i, 0, half.z },
    velocity = i == 1 and { 0.1, 0, 0 } or nil,
    omega = i == 1 and { 0, 4, 0 } or nil,
    friction = 0.6,
    restitution = 0.3,
  }
end

local function outline(x, z, q, color)
  local xs, zs = {}, {}
  for _, corner in ipairs { { 1, 1 }, { 1, -1 }, { -1, -1 }, { -1, 1 }, { 1, 1 } } do
    local v = quat.rotate(q, { corner[1] * half.x, half.y, corner[2] * half.z })
    xs[#xs + 1], zs[#zs + 1] = x + v.x, z + v.z
  end
  return plot.line { xs, zs, color = color, width = 2 }
end

local function draw(scene)
  local panels = {}
  for row, moment in ipairs { 0, 0.45, 1 } do
    local panel = { title = ("t = %.2f s"):format(moment * scene:time()), xlabel = "x, m", ylabel = "z, m", legend = "none", equal = true,
      box = { 0.1, 1.02 - 0.31 * row, 0.96, 1.2 - 0.31 * row }, xrange = { 0, 0.18 }, yrange = { -0.005, 0.055 } }
    for i = 1, count do
      local track = scene:track("domino " .. i)
      local k = 1
      while track.t[k] < moment * scene:time() do k = k + 1 end
      panel[#panel + 1] = outline(track.x[k], track.z[k], { track.qw[k], track.qx[k], track.qy[k], track.qz[k] }, i % 2 == 0 and "blue" or "orange")
    end
    panels[row] = plot.panel(panel)
  end
  panels.title = "Five dominoes, the first pushed"
  panels.size = { 700, 900 }
  return plot.figure(panels)
end

return impact.scene { name = "dominoes", gravity = { 0, 0, -9.81 }, duration = 0.6, output_rate = 50, bodies = bodies, plot = draw }
