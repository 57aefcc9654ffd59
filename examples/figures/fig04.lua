-- SPDX-License-Identifier: MIT
--- The thesis' figure 4: stereographic projection of the circle on a line, and of the sphere on a plane.
---
---   a)  from the pole (0, 1):     x / (1 - y)                       seven lines at equal angles
---   b)  from the pole (0, 0, 1):  (x / (1 - z), y / (1 - z))        a grid of 20 x 20, twelve lines to random points
---
--- A projection line runs from the pole through a point of the circle or the sphere to its image, or on from the image to the point.
--- The pole's own image is at infinity. fig04a.csv and fig04b.csv hold the points at the lines, and their images.
local plot = require "quat.plot"
local csv = require "quat.csv"

-- a) the circle
local circle = { {}, {} }
for i = 0, 200 do
  circle[1][i + 1], circle[2][i + 1] = math.cos(i * math.pi / 100), math.sin(i * math.pi / 100)
end
local a = { x = {}, y = {}, image = {} }
local flat = plot.panel {
  title = "a) the circle from (0, 1) on the x axis",
  xlabel = "x", ylabel = "y", equal = true, legend = "bottom right",
  xrange = { -3, 3 }, yrange = { -1.9, 1.9 },
  plot.line { { -3, 3 }, { 0, 0 }, color = "red", width = 2.5, label = "image" },
  plot.line { circle[1], circle[2], color = "green", width = 2.5, label = "circle" },
}
for i = 0, 6 do
  local angle = math.pi + i * 2 * math.pi / 7
  local x, y = math.cos(angle), math.sin(angle)
  local image = x / (1 - y)
  a.x[i + 1], a.y[i + 1], a.image[i + 1] = x, y, image
  -- Pole, point and image in the order in which they lie on the line.
  local ends = y > 0 and { { 0, x, image }, { 1, y, 0 } } or { { 0, image, x }, { 1, 0, y } }
  flat[#flat + 1] = plot.line { ends[1], ends[2], color = "blue", width = 1, label = i == 0 and "projection lines" or nil }
end
flat[#flat + 1] = plot.points { a.image, { 0, 0, 0, 0, 0, 0, 0 }, color = "red", size = 1.2 }
flat[#flat + 1] = plot.points { { 0 }, { 1 }, color = "dark", size = 1.6, label = "pole" }

-- b) the sphere
local x, y, z = {}, {}, {}
for i = 0, 19 do
  x[i + 1], y[i + 1], z[i + 1] = {}, {}, {}
  for j = 0, 19 do
    local theta, phi = j * 2 * math.pi / 19, i * math.pi / 19
    x[i + 1][j + 1], y[i + 1][j + 1], z[i + 1][j + 1] = math.cos(theta) * math.sin(phi), math.sin(theta) * math.sin(phi), math.cos(phi)
  end
end
-- The image of the grid, as far as the picture goes.
local u, v, w = {}, {}, {}
for i = 1, 20 do
  u[i], v[i], w[i] = {}, {}, {}
  for j = 1, 20 do
    local scale = 1 / (1 - z[i][j])
    local inside = z[i][j] < 0.62
    u[i][j], v[i][j], w[i][j] = inside and x[i][j] * scale or 0 / 0, inside and y[i][j] * scale or 0 / 0, 0
  end
end
local space = {
  title = "b) the sphere from (0, 0, 1) on the plane z = 0",
  xlabel = "x", ylabel = "y", zlabel = "z", equal = true, legend = "none", view = { 68, 30 }, zoom = 1.25,
  xrange = { -2.2, 2.2 }, yrange = { -2.2, 2.2 }, zrange = { -1, 1 },
  plot.surface { u, v, w, color = "red", opacity = 0.6, lines = true },
  plot.surface { x, y, z, color = "green", opacity = 0.9, lines = true },
}
math.randomseed(2019)
local b = { x = {}, y = {}, z = {}, u = {}, v = {} }
while #b.x < 12 do
  -- Uniform on the sphere (Archimedes); those whose image is far away are left out.
  local height, angle = 2 * math.random() - 1, 2 * math.pi * math.random()
  local radius = math.sqrt(1 - height ^ 2)
  if height < 0.6 then
    local n = #b.x + 1
    b.x[n], b.y[n], b.z[n] = radius * math.cos(angle), radius * math.sin(angle), height
    b.u[n], b.v[n] = b.x[n] / (1 - height), b.y[n] / (1 - height)
    local ends = height > 0 and { { 0, b.x[n], b.u[n] }, { 0, b.y[n], b.v[n] }, { 1, height, 0 } } or
        { { 0, b.u[n], b.x[n] }, { 0, b.v[n], b.y[n] }, { 1, 0, height } }
    space[#space + 1] = plot.line { ends[1], ends[2], ends[3], color = "blue", width = 1 }
  end
end
local zero = {}
for i = 1, 12 do zero[i] = 0 end
space[#space + 1] = plot.points { b.u, b.v, zero, color = "red", size = 1.1 }
space[#space + 1] = plot.points { { 0 }, { 0 }, { 1 }, color = "dark", size = 1.6 }

assert(csv.save("fig04a", { "x", "y", "image" }, { a.x, a.y, a.image }))
assert(csv.save("fig04b", { "x", "y", "z", "image_x", "image_y" }, { b.x, b.y, b.z, b.u, b.v }))
local drawn, why = plot.save(plot.figure { size = { 1500, 640 }, grid = { 2, 1 }, flat, plot.panel(space) }, "fig04")
if not drawn then print("fig04: " .. why) end
