-- SPDX-License-Identifier: MIT
--- Frames along a knot: Frenet's, rotation-minimising, and closed.
---
--- The trefoil on a torus, ((2 + 0.8 cos 3t) cos 2t, (2 + 0.8 cos 3t) sin 2t, -0.8 sin 3t). Frenet's frame turns about the tangent at the rate of the torsion;
--- a minimal one does not turn about it at all (double reflection of Wang, Juettler, Zheng and Liu, 2008), and comes back after one
--- round turned by minus the total torsion, up to full turns: the holonomy. Taken back in proportion to arc length it closes.
--- trefoil.csv holds the three frames at 61 points, and how far each has turned about the tangent against the minimal one.
local quat = require "quat"
local plot = require "quat.plot"
local csv = require "quat.csv"

if not quat.curve then
  print("trefoil: this build is without GSL")
  return
end

local n = 601
local knot = quat.curve.torus_knot(2, 0.8, 2, 3)
local times = assert(knot:even(n))
local frenet = assert(knot:frames { times = times, framing = "frenet" })
local minimal, report = knot:frames { times = times, framing = "minimal" }
assert(minimal, report)
local closed, closed_report = knot:frames { times = times, framing = "closed" }
assert(closed, closed_report)
local total = assert(knot:total())

local place, length = {}, {}
for i, t in ipairs(times) do
  place[i] = knot:derivatives(t, 0)[1]
  length[i] = total.length * (i - 1) / (n - 1)
end

-- ---- ribbons: the curve, and a line beside it along the frame's y axis ----

local width = 0.5
local function ribbon(frames, title, colors)
  local panel = { title = title, equal = true, frame = false, legend = "none", view = { 35, 20 }, zoom = 2.15,
    xrange = { -3.2, 3.2 }, yrange = { -3.2, 3.2 }, zrange = { -1.5, 1.5 } }
  for side = 1, 2 do
    local x, y, z = {}, {}, {}
    for i = 1, n, 2 do
      local out, row, at = frames[i]:rotate { 0, 1, 0 }, (i + 1) // 2, place[i]
      x[row], y[row], z[row] = {}, {}, {}
      for k = 0, 2 do
        local far = (side - 1) * width / 2 + k * width / 4
        x[row][k + 1], y[row][k + 1], z[row][k + 1] = at.x + far * out.x, at.y + far * out.y, at.z + far * out.z
      end
    end
    panel[side] = plot.surface { x, y, z, color = colors[side], opacity = 1 }
  end
  return panel
end

local left = ribbon(frenet, "Frenet: along the principal normal", { "#c53030", "#f0a3a3" })
local right = ribbon(closed, "rotation-minimising, closed", { "#2b6cb0", "#a5c8ec" })

-- ---- the frames as curves on S^3 ----

local function image(frames)
  local x, y, z = {}, {}, {}
  for i, q in ipairs(frames) do
    local f = 1 / (1.6 + q.w) -- from a point outside the sphere: nothing is far away
    x[i], y[i], z[i] = f * q.x, f * q.y, f * q.z
  end
  return x, y, z
end
local sphere = { title = "the frames on S³, vec q/(1.6 + w)", equal = true, legend = "none", view = { 62, 40 }, zoom = 0.95,
  frame = true, xlabel = "x", ylabel = "y", zlabel = "z" }
for _, each in ipairs { { frenet, "red", 2.5 }, { minimal, "green", 2.5 }, { closed, "blue", 2.5 } } do
  local x, y, z = image(each[1])
  sphere[#sphere + 1] = plot.line { x, y, z, color = each[2], width = each[3] }
  sphere[#sphere + 1] = plot.points { { x[1], x[n] }, { y[1], y[n] }, { z[1], z[n] }, color = each[2], size = 1.4 }
end

-- ---- how far each has turned about the tangent ----

local function turned(frames)
  local angles, last = {}, 0
  for i, q in ipairs(frames) do
    local s = minimal[i]:conj() * q
    local angle = 2 * math.atan(s.x, s.w)
    angle = angle - 2 * math.pi * math.floor((angle - last) / (2 * math.pi) + 0.5)
    angles[i], last = angle, angle
  end
  return angles
end
local by_frenet, by_closed = turned(frenet), turned(closed)
local zero, degrees = {}, { {}, {} }
for i = 1, n do
  zero[i] = 0
  degrees[1][i], degrees[2][i] = math.deg(by_frenet[i]), math.deg(by_closed[i])
end
local turning = plot.panel {
  title = "turned about the tangent against the minimal frame", xlabel = "arc length", ylabel = "degrees", legend = "top left",
  plot.line { length, degrees[1], color = "red", width = 2.5, label = "Frenet" },
  plot.line { length, zero, color = "green", width = 2.5, label = "rotation-minimising" },
  plot.line { length, degrees[2], color = "blue", width = 2.5, label = "closed" },
}

local rows = { {}, {}, {} }
for c = 1, 15 do rows[c] = {} end
for i = 1, n, 10 do
  local k = #rows[1] + 1
  rows[1][k] = length[i]
  for f, frames in ipairs { frenet, minimal, closed } do
    for c, letter in ipairs { "w", "x", "y", "z" } do rows[4 * f + c - 3][k] = frames[i][letter] end
  end
  rows[14][k], rows[15][k] = by_frenet[i], by_closed[i]
end
assert(csv.save("trefoil", { "length", "frenet_w", "frenet_x", "frenet_y", "frenet_z", "minimal_w", "minimal_x", "minimal_y", "minimal_z",
  "closed_w", "closed_x", "closed_y", "closed_z", "frenet_angle", "closed_angle" }, rows))
local drawn, why = plot.save(plot.figure {
  title = "Frames along a trefoil", size = { 1300, 1150 }, grid = { 2, 2 },
  subtitle = string.format("total torsion %.2f°, holonomy %.2f°; curvature in all %.3f π (a knot: more than 4 π)",
    math.deg(total.torsion), math.deg(report.holonomy), total.curvature / math.pi),
  plot.panel(left), plot.panel(right), plot.panel(sphere), turning,
}, "trefoil")
if not drawn then print("trefoil: " .. why) end
