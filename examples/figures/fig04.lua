-- SPDX-License-Identifier: MIT
--- The thesis' figure 4: stereographic projection of the circle on a line, and of the sphere on a plane.
---
---   a)  from the pole (0, 1):     x / (1 - y)                       seven lines at equal angles
---   b)  from the pole (0, 0, 1):  (x / (1 - z), y / (1 - z))        a grid of 20 x 20, twelve lines to random points
---
--- A projection line runs from the pole through a point of the circle or the sphere to its image, or on from the image to the point.
--- The pole's own image is at infinity. fig04a.csv and fig04b.csv hold the points at the lines, and their images.
local quat = require "quat"
local plot = require "quat.plot"
local csv = require "quat.csv"

local pi = math.pi

-- a) the circle
local circle = { {}, {} }
for i = 0, 200 do circle[1][i + 1], circle[2][i + 1] = math.cos(i * pi / 100), math.sin(i * pi / 100) end
local a = { x = {}, y = {}, image = {} }
local flat = {
  title = "a) the circle from (0, 1) on the x axis",
  xlabel = "x", ylabel = "y", equal = true, legend = "bottom left",
  xrange = { -3, 3 }, yrange = { -3, 3 }, box = { 0.05, 0.1, 0.47, 0.93 },
  plot.line { { -3, 3 }, { 0, 0 }, color = "orange", width = 2, label = "the line, and images" },
  plot.line { circle[1], circle[2], color = "blue", width = 2.5, label = "the circle, and points" },
}
for i = 0, 6 do
  local angle = pi + i * 2 * pi / 7
  local x, y = math.cos(angle), math.sin(angle)
  local image = quat.stereographic_circle { x, y }
  a.x[i + 1], a.y[i + 1], a.image[i + 1] = x, y, image
  -- Pole, point and image in the order in which they lie on the line.
  local ends = y > 0 and { { 0, x, image }, { 1, y, 0 } } or { { 0, image, x }, { 1, 0, y } }
  flat[#flat + 1] = plot.line { ends[1], ends[2], color = "grey", width = 1.3, label = i == 0 and "projection lines" or nil }
end
flat[#flat + 1] = plot.points { a.x, a.y, color = "blue", size = 1.2 }
flat[#flat + 1] = plot.points { a.image, { 0, 0, 0, 0, 0, 0, 0 }, color = "orange", size = 1.2 }
flat[#flat + 1] = plot.points { { 0 }, { 1 }, color = "dark", size = 1.7, label = "pole" }

-- b) the sphere, and the image of its grid as far as the picture goes
local x, y, z, u, v, w = {}, {}, {}, {}, {}, {}
local grid = 61
for i = 1, grid do
  x[i], y[i], z[i], u[i], v[i], w[i] = {}, {}, {}, {}, {}, {}
  for j = 1, grid do
    local theta, phi = (j - 1) * 2 * pi / (grid - 1), (i - 1) * pi / (grid - 1)
    local p = { math.cos(theta) * math.sin(phi), math.sin(theta) * math.sin(phi), math.cos(phi) }
    local image = quat.stereographic_sphere(p)
    x[i][j], y[i][j], z[i][j] = p[1], p[2], p[3]
    local inside = p[3] < 0.8 -- within 3 of the middle
    u[i][j], v[i][j], w[i][j] = inside and image[1] or 0 / 0, inside and image[2] or 0 / 0, 0
  end
end
local space = {
  title = "b) the sphere from (0, 0, 1) on the plane z = 0",
  equal = true, legend = "none", view = { 66, 30 }, zoom = 1.6, box = { 0.5, 0.0, 1, 0.985 },
  xlabel = "x", ylabel = "y", zlabel = "z", xrange = { -3, 3 }, yrange = { -3, 3 }, zrange = { -1, 1 },
  plot.surface { u, v, w, color = "#f6c28b", opacity = 0.55 },
  plot.surface { x, y, z, color = "#8fb8de", opacity = 0.45 },
}
math.randomseed(2019)
local b = { x = {}, y = {}, z = {}, u = {}, v = {} }
local lines = { {}, {}, {}, {}, {}, {}, color = "dark", width = 1, head = 0, front = true }
while #b.x < 12 do
  -- Uniform on the sphere (Archimedes); those whose image is far away are left out.
  local height, angle = 2 * math.random() - 1, 2 * pi * math.random()
  local radius = math.sqrt(1 - height ^ 2)
  if height < 0.6 then
    local n = #b.x + 1
    b.x[n], b.y[n], b.z[n] = radius * math.cos(angle), radius * math.sin(angle), height
    b.u[n], b.v[n] = table.unpack(quat.stereographic_sphere { b.x[n], b.y[n], b.z[n] })
    local far = height > 0 and { b.u[n], b.v[n], 0 } or { b.x[n], b.y[n], height }
    for c, value in ipairs { 0, 0, 1, far[1], far[2], far[3] - 1 } do lines[c][n] = value end
  end
end
local zero = {}
for i = 1, 12 do zero[i] = 0 end
space[#space + 1] = plot.arrows(lines)
space[#space + 1] = plot.points { b.x, b.y, b.z, color = "blue", size = 1.1, front = true }
space[#space + 1] = plot.points { b.u, b.v, zero, color = "orange", size = 1.1, front = true }
space[#space + 1] = plot.points { { 0 }, { 0 }, { 1 }, color = "dark", size = 1.7, front = true }

assert(csv.save("fig04a", { "x", "y", "image" }, { a.x, a.y, a.image }))
assert(csv.save("fig04b", { "x", "y", "z", "image_x", "image_y" }, { b.x, b.y, b.z, b.u, b.v }))
local drawn, why = plot.save(plot.figure { size = { 1500, 640 }, plot.panel(flat), plot.panel(space) }, "fig04")
if not drawn then print("fig04: " .. why) end
