-- SPDX-License-Identifier: MIT
--- Gimbal lock (the thesis' 5.3.3): three angles that are two.
---
---   R = Rx(alpha) Ry(beta) Rz(gamma): three rings in each other, x, y', z''
---
--- Each angle turns the body about its ring's axis, x, Rx y and Rx Ry z in the world. Their determinant is cos beta: at beta = 90 degrees
--- the third axis lies on the first, alpha and gamma turn about one line, and a turn about the line across the other two cannot be begun.
--- Here a body that stands at alpha = 40, gamma = 20 degrees turns on evenly past beta = 90: the angles jump by 180 degrees, where q(t) goes
--- through smoothly. At the lock itself `to_euler` gives gamma = 0 and says so.
---
--- gimbal.csv: t, the angles (degrees), the determinant of the three axes, q.
local quat = require "quat"
local plot = require "quat.plot"
local csv = require "quat.csv"

local alpha, gamma = math.rad(40), math.rad(20)

-- The lock to the last bit, which rounding elsewhere misses: alpha + gamma is all that is left.
local half = (alpha + gamma) / 2
local at_lock = quat.new(math.cos(half), math.sin(half), math.cos(half), math.sin(half)):normalize()

local columns = { {}, {}, {}, {}, {}, {}, {}, {}, {} }
local locked
for n = 0, 120 do
  local t = n / 2 + 60
  local q = t == 90 and at_lock or quat.from_euler("XYZ", alpha, math.rad(t), gamma)
  local a, b, c, said = q:to_euler("XYZ")
  if said then locked = { t, math.deg(a), math.deg(b), math.deg(c) } end
  for i, value in ipairs { t, math.deg(a), math.deg(b), math.deg(c), math.cos(b), q.w, q.x, q.y, q.z } do columns[i][n + 1] = value end
end
assert(locked and locked[1] == 90, "the lock at 90 degrees was not told")
assert(csv.save("gimbal", { "t", "alpha", "beta", "gamma", "determinant", "qw", "qx", "qy", "qz" }, columns))

--- The three rings and their axes for a middle angle in degrees, at alpha = 0.
local function rings(beta, title, box)
  local turn = { quat.identity(), quat.identity(), quat.from_euler("XYZ", 0, math.rad(beta), 0) }
  local axes = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }
  local panel = {
    title = title, equal = true, legend = "none", frame = false, view = { 68, 28 }, zoom = 2.1, box = box,
    xrange = { -1.3, 1.3 }, yrange = { -1.3, 1.3 }, zrange = { -1.3, 1.3 },
  }
  local colors, names = { "blue", "green", "orange" }, { "α", "β", "γ" }
  for i = 1, 3 do
    local size = 1.15 - 0.2 * i
    local u, v = axes[i % 3 + 1], axes[(i + 1) % 3 + 1]
    local circle = { {}, {}, {}, color = colors[i], width = 2.4, tube = 0.04 }
    for n = 0, 96 do
      local s = n * math.pi / 48
      local p = turn[i]:rotate {
        size * (math.cos(s) * u[1] + math.sin(s) * v[1]), size * (math.cos(s) * u[2] + math.sin(s) * v[2]), size * (math.cos(s) * u[3] + math.sin(s) * v[3]),
      }
      circle[1][n + 1], circle[2][n + 1], circle[3][n + 1] = p.x, p.y, p.z
    end
    local axis = turn[i]:rotate(axes[i])
    local length = i == 3 and 1.25 or 1.0
    panel[#panel + 1] = plot.line(circle)
    panel[#panel + 1] = plot.arrows { { 0 }, { 0 }, { 0 }, { length * axis.x }, { length * axis.y }, { length * axis.z }, color = colors[i], width = 2.6 }
    local reach = i == 3 and 1.42 or 1.15
    panel[#panel + 1] = plot.text { names[i], at = { reach * axis.x, reach * axis.y, reach * axis.z + (i == 1 and -0.16 or 0.04) }, color = colors[i], size = 13 }
  end
  -- Across the lines of alpha and beta: where gamma should turn, and at the lock does not.
  panel[#panel + 1] = plot.line { { 0, 0 }, { 0, 0 }, { -1.2, 1.2 }, color = "dark", width = 2, dash = true }
  return plot.panel(panel)
end

--- The angles with the pen lifted where they jump.
local function lifted(values)
  local out = {}
  for n, value in ipairs(values) do out[n] = columns[1][n] == 90 and 0 / 0 or value end
  return out
end
local t = columns[1]
local drawn, why = plot.save(plot.figure {
  title = "Gimbal lock: three angles that are two", size = { 1400, 1000 },
  rings(35, "β = 35°: three axes", { 0.0, 0.5, 0.5, 0.92 }),
  rings(90, "β = 90°: α and γ turn about one line", { 0.5, 0.5, 1, 0.92 }),
  plot.panel {
    title = "a body turns on evenly: its angles", xlabel = "t (the angle turned, degrees)", ylabel = "degrees", legend = "top left",
    box = { 0.07, 0.08, 0.47, 0.43 }, xrange = { 60, 120 }, yrange = { -200, 200 },
    plot.mark { x = 90, color = "grey", dash = true },
    plot.line { t, lifted(columns[2]), color = "blue", width = 2.4, label = "α" },
    plot.line { t, columns[3], color = "green", width = 2.4, label = "β" },
    plot.line { t, lifted(columns[4]), color = "orange", width = 2.4, label = "γ" },
    plot.points { { 90, 90 }, { locked[2], locked[4] }, color = "dark", size = 1.4, shape = "circle" },
    plot.text { "at the lock: γ = 0 by choice", at = { 90.8, -27 }, size = 10, color = "dark" },
  },
  plot.panel {
    title = "its quaternion", xlabel = "t (the angle turned, degrees)", legend = "none", box = { 0.56, 0.08, 0.96, 0.43 },
    xrange = { 60, 120 }, yrange = { 0, 1 },
    plot.mark { x = 90, color = "grey", dash = true },
    plot.line { t, columns[6], color = "black", width = 2.4 },
    plot.line { t, columns[7], color = "blue", width = 2.4 },
    plot.line { t, columns[8], color = "green", width = 2.4 },
    plot.line { t, columns[9], color = "orange", width = 2.4 },
    plot.text { "w", at = { 63, columns[6][7] + 0.05 }, size = 12 },
    plot.text { "x", at = { 116, columns[7][113] - 0.06 }, size = 12, color = "blue" },
    plot.text { "y", at = { 63, columns[8][7] + 0.05 }, size = 12, color = "green" },
    plot.text { "z", at = { 63, columns[9][7] - 0.06 }, size = 12, color = "orange" },
  },
}, "gimbal")
if not drawn then print("gimbal: " .. why) end
