-- SPDX-License-Identifier: MIT
--- The thesis' figure 5: the square-root projection of the circle on a line, and of the sphere on a plane.
---
---   a)  (x, y) -> x,          back by y = +- sqrt(1 - x^2)
---   b)  (x, y, z) -> (x, y),  back by z = +- sqrt(1 - x^2 - y^2)
---
--- The two halves fall on the same points, so that the sign has to be kept beside the image; on the boundary, where the root is
--- zero, they meet. fig05a.csv and fig05b.csv hold the points at the projection lines and what comes back from their images.
local plot = require "quat.plot"
local csv = require "quat.csv"

local function root(n) return math.sqrt((1 - n) * (1 + n)) end

-- a) the circle
local upper, lower = { {}, {} }, { {}, {} }
for i = 0, 100 do
  local angle = i * math.pi / 100
  upper[1][i + 1], upper[2][i + 1] = math.cos(angle), math.sin(angle)
  lower[1][i + 1], lower[2][i + 1] = math.cos(angle), -math.sin(angle)
end
local a = { x = {}, y = {}, back = {} }
local flat = {
  title = "a) the circle on the x axis",
  xlabel = "x", ylabel = "y", equal = true, legend = "top left",
  xrange = { -1.5, 1.5 }, yrange = { -1.3, 1.3 },
  plot.line { upper[1], upper[2], color = "blue", width = 2.5, label = "upper half" },
  plot.line { lower[1], lower[2], color = "orange", width = 2.5, label = "lower half" },
  plot.line { { -1, 1 }, { 0, 0 }, color = "green", width = 2.5, label = "image of both" },
}
for i = 1, 11 do
  if i ~= 6 then
    local sign, angle = i < 6 and 1 or -1, (i < 6 and i or i - 6) * math.pi / 6
    local n = #a.x + 1
    a.x[n], a.y[n] = math.cos(angle), sign * math.sin(angle)
    a.back[n] = sign * root(a.x[n])
    flat[#flat + 1] = plot.line { { a.x[n], a.x[n] }, { a.y[n], 0 }, color = "dark", width = 1 }
  end
end
flat[#flat + 1] = plot.points { { -1, 1 }, { 0, 0 }, color = "red", size = 1.6, label = "boundary" }

-- b) the sphere
local function half(sign, height)
  local x, y, z = {}, {}, {}
  for i = 0, 8 do
    x[i + 1], y[i + 1], z[i + 1] = {}, {}, {}
    for j = 0, 24 do
      local theta, phi = j * math.pi / 12, i * math.pi / 16
      x[i + 1][j + 1], y[i + 1][j + 1] = math.cos(theta) * math.sin(phi), math.sin(theta) * math.sin(phi)
      z[i + 1][j + 1] = height or sign * math.cos(phi)
    end
  end
  return x, y, z
end
local boundary = { {}, {}, {} }
for i = 0, 100 do
  boundary[1][i + 1], boundary[2][i + 1], boundary[3][i + 1] = math.cos(i * math.pi / 50), math.sin(i * math.pi / 50), 0
end
local function mesh(color, opacity, x, y, z)
  return plot.surface { x, y, z, color = color, opacity = opacity, lines = true }
end
local space = {
  title = "b) the sphere on the plane z = 0",
  xlabel = "x", ylabel = "y", zlabel = "z", equal = true, legend = "none", view = { 72, 30 }, zoom = 1.2,
  xrange = { -1.2, 1.2 }, yrange = { -1.2, 1.2 }, zrange = { -1, 1 },
  mesh("orange", 0.8, half(-1)),
  mesh("green", 0.8, half(1, 0)),
  mesh("blue", 0.8, half(1)),
  plot.line { boundary[1], boundary[2], boundary[3], color = "red", width = 3 },
}
local b = { x = {}, y = {}, z = {}, back = {} }
for i = 0, 11 do
  local sign, angle, radius = i % 2 == 0 and 1 or -1, i * math.pi / 6, i % 3 == 0 and 0.4 or 0.75
  local n = #b.x + 1
  b.x[n], b.y[n], b.z[n] = radius * math.cos(angle), radius * math.sin(angle), sign * root(radius)
  b.back[n] = sign * root(math.sqrt(b.x[n] ^ 2 + b.y[n] ^ 2))
  space[#space + 1] = plot.line { { b.x[n], b.x[n] }, { b.y[n], b.y[n] }, { b.z[n], 0 }, color = "dark", width = 1.2 }
end

assert(csv.save("fig05a", { "x", "y", "back" }, { a.x, a.y, a.back }))
assert(csv.save("fig05b", { "x", "y", "z", "back" }, { b.x, b.y, b.z, b.back }))
local drawn, why = plot.save(plot.figure { size = { 1500, 640 }, grid = { 2, 1 }, plot.panel(flat), plot.panel(space) }, "fig05")
if not drawn then print("fig05: " .. why) end
