-- SPDX-License-Identifier: MIT
--- The thesis' figure 5: the square-root projection of the circle on a line, and of the sphere on a plane.
---
---   a)  (x, y) -> x,          back by y = +- sqrt(1 - x^2)
---   b)  (x, y, z) -> (x, y),  back by z = +- sqrt(1 - x^2 - y^2)
---
--- The two halves fall on the same points, so that the sign has to be kept beside the image; on the boundary, where the root is
--- zero, they meet. fig05a.csv and fig05b.csv hold the points at the projection lines and what comes back from their images.
local quat = require "quat"
local plot = require "quat.plot"
local csv = require "quat.csv"

local pi = math.pi

-- a) the circle
local upper, lower = { {}, {} }, { {}, {} }
for i = 0, 100 do
  local angle = i * pi / 100
  upper[1][i + 1], upper[2][i + 1] = math.cos(angle), math.sin(angle)
  lower[1][i + 1], lower[2][i + 1] = math.cos(angle), -math.sin(angle)
end
local a = { x = {}, y = {}, back = {} }
local lines = { {}, {}, color = "grey", width = 1.3, label = "projection lines" }
for i = 1, 11 do
  if i ~= 6 then
    local sign, angle = i < 6 and 1 or -1, (i < 6 and i or i - 6) * pi / 6
    local n = #a.x + 1
    a.x[n], a.y[n] = math.cos(angle), sign * math.sin(angle)
    local image, half = quat.orthographic_circle { a.x[n], a.y[n] }
    a.back[n] = quat.from_orthographic_circle(image, half)[2]
    for c, ends in ipairs { { a.x[n], a.x[n], 0 / 0 }, { a.y[n], 0, 0 / 0 } } do table.move(ends, 1, 3, 3 * n - 2, lines[c]) end
  end
end
local flat = plot.panel {
  title = "a) the circle on the x axis",
  xlabel = "x", ylabel = "y", equal = true, legend = "top right",
  xrange = { -1.3, 1.9 }, yrange = { -1.25, 1.25 }, box = { 0.05, 0.1, 0.52, 0.93 },
  plot.line(lines),
  plot.line { upper[1], upper[2], color = "blue", width = 2.8, label = "upper half" },
  plot.line { lower[1], lower[2], color = "orange", width = 2.8, label = "lower half" },
  plot.line { { -1, 1 }, { 0, 0 }, color = "purple", width = 2.5, label = "image of both" },
  plot.points { { -1, 1 }, { 0, 0 }, color = "dark", size = 1.7, label = "boundary" },
}

-- b) the sphere
local function half(sign, height)
  local x, y, z = {}, {}, {}
  for i = 0, 16 do
    x[i + 1], y[i + 1], z[i + 1] = {}, {}, {}
    for j = 0, 64 do
      local theta, phi = j * pi / 32, i * pi / 32
      x[i + 1][j + 1], y[i + 1][j + 1] = math.cos(theta) * math.sin(phi), math.sin(theta) * math.sin(phi)
      z[i + 1][j + 1] = height or sign * math.cos(phi)
    end
  end
  return x, y, z
end
local function sheet(color, opacity, x, y, z) return plot.surface { x, y, z, color = color, opacity = opacity } end
local rim = { {}, {}, {}, {}, {}, {}, color = "dark", width = 3, head = 0, front = true }
for i = 0, 59 do
  local c, s, c1, s1 = math.cos(i * pi / 30), math.sin(i * pi / 30), math.cos((i + 1) * pi / 30), math.sin((i + 1) * pi / 30)
  for column, value in ipairs { c, s, 0, c1 - c, s1 - s, 0 } do rim[column][i + 1] = value end
end
local space = {
  title = "b) the sphere on the plane z = 0",
  equal = true, legend = "none", view = { 70, 30 }, zoom = 1.15, box = { 0.53, 0.0, 1, 0.985 }, xlabel = "x", ylabel = "y", zlabel = "z",
  xrange = { -1.2, 1.2 }, yrange = { -1.2, 1.2 }, zrange = { -1, 1 },
  sheet("#f6c28b", 0.5, half(-1)),
  sheet("#b7a5d9", 0.7, half(1, 0)),
  sheet("#8fb8de", 0.5, half(1)),
  plot.arrows(rim),
}
local b = { x = {}, y = {}, z = {}, back = {} }
local drops = {}
for sign = -1, 1, 2 do
  drops[sign] = { {}, {}, {}, {}, {}, {}, color = "dark", width = 1.2, head = 0, front = true }
end
for i = 0, 11 do
  local sign, angle, radius = i % 2 == 0 and 1 or -1, i * pi / 6, i % 3 == 0 and 0.4 or 0.75
  local n = #b.x + 1
  local p = quat.from_orthographic_sphere({ radius * math.cos(angle), radius * math.sin(angle) }, sign)
  local image, side = quat.orthographic_sphere(p)
  b.x[n], b.y[n], b.z[n] = p[1], p[2], p[3]
  b.back[n] = quat.from_orthographic_sphere(image, side).z
  local drop = drops[sign]
  for c, value in ipairs { p[1], p[2], p[3], 0, 0, -p[3] } do table.insert(drop[c], value) end
end
for sign, color in pairs { [-1] = "orange", [1] = "blue" } do
  local drop, zero = drops[sign], {}
  for i = 1, #drop[1] do zero[i] = 0 end
  space[#space + 1] = plot.arrows(drop)
  space[#space + 1] = plot.points { drop[1], drop[2], drop[3], color = color, size = 1.1, front = true }
  space[#space + 1] = plot.points { drop[1], drop[2], zero, color = "purple", size = 1, front = true }
end

assert(csv.save("fig05a", { "x", "y", "back" }, { a.x, a.y, a.back }))
assert(csv.save("fig05b", { "x", "y", "z", "back" }, { b.x, b.y, b.z, b.back }))
local drawn, why = plot.save(plot.figure { size = { 1500, 640 }, flat, plot.panel(space) }, "fig05")
if not drawn then print("fig05: " .. why) end
