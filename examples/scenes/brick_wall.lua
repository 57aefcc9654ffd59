-- SPDX-License-Identifier: MIT
--- A wall of twelve bricks, laid dry in bond, is struck by a ball.
---
---   standing   reactions at all corners of all joints hold the wall: proved at t = 0, and nothing moves until the ball comes
---   struck     all points that touch at the instant answer together (Moreau, Poisson; restitution 0.1)
---   falling    bricks that lean on each other are moved by steps; the closing summary tells their error
local impact = require "impact"
local plot = require "quat.plot"
local quat = require "quat"

local courses, half = 4, { x = 0.1, y = 0.05, z = 0.03 }
local bodies = { impact.body { name = "ground", shape = impact.plane(), friction = 0.5 } }
for course = 1, courses do
  for k = 1, 3 do
    bodies[#bodies + 1] = impact.body {
      name = ("brick %d %d"):format(course, k),
      shape = impact.box { a = half.x, b = half.y, c = half.z },
      density = 2000,
      position = { 2 * half.x * (k - 2) + (course % 2 == 0 and half.x / 2 or -half.x / 2), 0, half.z * (2 * course - 1) },
      friction = 0.6,
      restitution = 0.1,
    }
  end
end
bodies[#bodies + 1] = impact.body { name = "ball", shape = impact.sphere(0.06), mass = 2, position = { 0.03, -0.4, 0.17 },
  velocity = { 0, 5, 0.3 }, friction = 0.4, restitution = 0.3 }

-- Seen along the wall: y to the right, z up.
local function outline(track, k)
  local ys, zs = {}, {}
  for _, corner in ipairs { { 1, 1 }, { 1, -1 }, { -1, -1 }, { -1, 1 }, { 1, 1 } } do
    local v = quat.rotate({ track.qw[k], track.qx[k], track.qy[k], track.qz[k] }, { 0, corner[1] * half.y, corner[2] * half.z })
    ys[#ys + 1], zs[#zs + 1] = track.y[k] + v.y, track.z[k] + v.z
  end
  return ys, zs
end

local function draw(scene)
  local panels = {}
  for row, moment in ipairs { 0.1, 0.4, 1 } do
    local t = moment * scene:time()
    local panel = { title = ("t = %.2f s"):format(t), xlabel = "y, m", ylabel = "z, m", legend = "none", equal = true,
      box = { 0.1, 1.02 - 0.31 * row, 0.96, 1.2 - 0.31 * row }, xrange = { -0.3, 0.5 }, yrange = { -0.02, 0.3 } }
    for course = 1, courses do
      for k = 1, 3 do
        local track = scene:track(("brick %d %d"):format(course, k))
        local at = 1
        while track.t[at + 1] and track.t[at + 1] <= t do at = at + 1 end
        local ys, zs = outline(track, at)
        panel[#panel + 1] = plot.line { ys, zs, color = k == 2 and "blue" or "orange", width = 2 }
      end
    end
    panels[row] = plot.panel(panel)
  end
  panels.title = "A wall of twelve bricks, struck"
  panels.size = { 900, 900 }
  return plot.figure(panels)
end

return impact.scene { name = "brick_wall", gravity = { 0, 0, -9.81 }, duration = 0.5, output_rate = 50, bodies = bodies, together = "moreau", plot = draw }
