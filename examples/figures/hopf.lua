-- SPDX-License-Identifier: MIT
--- Hopf's map: over each point p of S^2 lies a great circle of S^3, all q whose rotation takes z to p. No two of them meet, and any two
--- are linked. Seen by stereographic projection from -1 they are circles in space; those over a circle of latitude fill a torus.
---
---   fibre(p, t) = q0 exp(k t),  q0 the shortest rotation from z to p;   image v / (1 + w)
---
--- hopf.csv holds for each fibre its point p and the middle and radius of its image, which is a circle to rounding.
local quat = require "quat"
local plot = require "quat.plot"
local csv = require "quat.csv"
local portrait = require "impact.portrait"

local pi = math.pi

--- A colour that goes once round: blue, teal, orange and back.
local function hue(part)
  local stops = { { 43, 108, 176 }, { 120, 190, 190 }, { 246, 194, 139 }, { 221, 107, 32 }, { 120, 70, 120 }, { 43, 108, 176 } }
  local at = part * (#stops - 1)
  local i = math.min(math.floor(at), #stops - 2)
  local c = {}
  for k = 1, 3 do c[k] = math.floor(stops[i + 1][k] + (at - i) * (stops[i + 2][k] - stops[i + 1][k]) + 0.5) end
  return string.format("#%02x%02x%02x", c[1], c[2], c[3])
end

local function mean(...)
  local sum, n = 0, select("#", ...)
  for i = 1, n do sum = sum + select(i, ...) end
  return sum / n
end

local view = { 66, 30 }
local eye = portrait.eye(view)
local base = {
  title = "points of S²", equal = true, legend = "none", frame = false, view = view, zoom = 1.4, box = { 0.0, 0.02, 0.36, 0.9 },
  xrange = { -1.1, 1.1 }, yrange = { -1.1, 1.1 }, zrange = { -1.1, 1.1 },
}
local above = {
  title = "and the circles of S³ above them, from −1", equal = true, legend = "none", frame = false, view = { 62, 25 }, zoom = 1.85,
  box = { 0.36, 0.0, 1, 0.92 }, xrange = { -2.6, 2.6 }, yrange = { -2.6, 2.6 }, zrange = { -2, 2 },
}
local x, y, z = {}, {}, {}
for i = 0, 32 do
  x[i + 1], y[i + 1], z[i + 1] = {}, {}, {}
  for j = 0, 64 do
    local theta, phi = i * pi / 32, j * pi / 32
    x[i + 1][j + 1], y[i + 1][j + 1], z[i + 1][j + 1] = math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta)
  end
end
base[1] = plot.surface { x, y, z, color = "grey", opacity = 0.4 }

local columns = { {}, {}, {}, {}, {}, {}, {} }
local function fibre(p, color, width)
  local circle = {}
  for i = 0, 180 do circle[i + 1] = quat.hopf_fibre(p, i * pi / 90) end
  local image, line = quat.stereographic_list(circle), { {}, {}, {}, color = color, width = width }
  for i, v in ipairs(image) do line[1][i], line[2][i], line[3][i] = v.x, v.y, v.z end
  above[#above + 1] = plot.line(line)
  base[#base + 1] = plot.points { { p[1] }, { p[2] }, { p[3] }, color = color, size = 1.4, front = p[1] * eye[1] + p[2] * eye[2] + p[3] * eye[3] > 0 }
end

-- The image of a great circle through neither pole is a circle: its middle is the mean of the two images where it is nearest to 1 and -1.
for _, ring in ipairs { { 0, 24 }, { -0.9, 12 } } do
  local latitude, count = ring[1], ring[2]
  for n = 0, count - 1 do
    local phi = 2 * n * pi / count
    local p = { math.cos(latitude) * math.cos(phi), math.cos(latitude) * math.sin(phi), math.sin(latitude) }
    fibre(p, hue(n / count), 1.8)
    local near, far = quat.hopf_fibre(p, 0):stereographic(), quat.hopf_fibre(p, pi):stereographic()
    local middle = { mean(near.x, far.x), mean(near.y, far.y), mean(near.z, far.z) }
    local radius = math.sqrt((near.x - far.x) ^ 2 + (near.y - far.y) ^ 2 + (near.z - far.z) ^ 2) / 2
    for c, value in ipairs { p[1], p[2], p[3], middle[1], middle[2], middle[3], radius } do table.insert(columns[c], value) end
    for i = 1, 12 do -- every point of the image is as far from the middle
      local v = quat.hopf_fibre(p, 0.5 * i):stereographic()
      assert(math.abs(math.sqrt((v.x - middle[1]) ^ 2 + (v.y - middle[2]) ^ 2 + (v.z - middle[3]) ^ 2) - radius) < 1e-14 * (1 + radius) ^ 2)
    end
  end
end
fibre({ 0, 0, -1 }, "black", 3)
base[#base + 1] = plot.points { { 0 }, { 0 }, { 1 }, color = "black", size = 1.3, shape = "circle", front = true }
above[#above + 1] = plot.line { { 0, 0 }, { 0, 0 }, { -2, 2 }, color = "black", width = 1.5, dash = true }

assert(csv.save("hopf", { "px", "py", "pz", "x", "y", "z", "radius" }, columns))
local drawn, why = plot.save(plot.figure { title = "Hopf's map", size = { 1400, 700 }, plot.panel(base), plot.panel(above) }, "hopf")
if not drawn then print("hopf: " .. why) end
