-- SPDX-License-Identifier: MIT
--- Curvature beyond the thesis: torus, ellipsoid and saddle coloured by K and H from their quaternion frames, and by the error.
---
--- The frames' rates a and b, of q_u = q (0, a)/2 and q_v = q (0, b)/2, give K = det M/det J and H = tr(M J^-1)/2 with
--- J = [x_u.T1 x_v.T1; x_u.T2 x_v.T2] and M = [a_y b_y; -a_x -b_x]. H is positive where the surface bends away from its normal.
--- The closed forms:
---   torus      k1 = 1/r, k2 = cos v/(R + r cos v)
---   ellipsoid  K = 1/(abc s)^2, H = (a^2 + b^2 + c^2 - |x|^2)/(2 (abc)^2 s^(3/2)), s = x^2/a^4 + y^2/b^4 + z^2/c^4
---   saddle     z = (x^2 - y^2)/(2a), w = 1 + (x^2 + y^2)/a^2: K = -1/(a w)^2, H = (x^2 - y^2)/(2 a^3 w^(3/2))
--- curvature.csv holds K and H over a coarse net, and how far they are off.
local quat = require "quat"
local plot = require "quat.plot"
local csv = require "quat.csv"

if not quat.surface then
  print("curvature: this build is without GSL")
  return
end

local R, r = 2, 0.9
local a, b, c = 2, 1.4, 1
local extent = 1.2

local shapes = {
  {
    name = "torus", surface = quat.surface.torus(R, r), view = { 52, 30 }, zoom = 1.85, rows = 96, columns = 60,
    exact = function(_, v)
      local k1, k2 = 1 / r, math.cos(v) / (R + r * math.cos(v))
      return k1 * k2, (k1 + k2) / 2
    end,
  },
  {
    name = "ellipsoid", surface = quat.surface.ellipsoid(a, b, c), view = { 65, 30 }, zoom = 1.85, rows = 72, columns = 48,
    exact = function(_, _, x)
      local s = x.x ^ 2 / a ^ 4 + x.y ^ 2 / b ^ 4 + x.z ^ 2 / c ^ 4
      local square = x.x ^ 2 + x.y ^ 2 + x.z ^ 2
      return 1 / (a * b * c * s) ^ 2, (a ^ 2 + b ^ 2 + c ^ 2 - square) / (2 * (a * b * c) ^ 2 * s ^ 1.5)
    end,
  },
  {
    name = "saddle", surface = quat.surface.saddle(1, extent), view = { 58, 35 }, zoom = 1.7, rows = 48, columns = 48,
    exact = function(u, v)
      local w = 1 + u ^ 2 + v ^ 2
      return -1 / w ^ 2, (u ^ 2 - v ^ 2) / (2 * w ^ 1.5)
    end,
  },
}

local list = { {}, {}, {}, {}, {}, {}, {} }

--- A net over the surface: positions, K, H, and how many digits are off.
local function net(shape)
  local s = shape.surface
  local u0, u1, v0, v1 = s:range()
  local inset = shape.name == "ellipsoid" and 1e-3 or 0 -- the angles are degenerate at the poles
  local x, y, z, gauss, mean, off = {}, {}, {}, {}, {}, {}
  shape.worst = 0
  for i = 0, shape.rows do
    x[i + 1], y[i + 1], z[i + 1], gauss[i + 1], mean[i + 1], off[i + 1] = {}, {}, {}, {}, {}, {}
    for j = 0, shape.columns do
      local u, v = u0 + (u1 - u0) * i / shape.rows, v0 + inset + (v1 - v0 - 2 * inset) * j / shape.columns
      local p = assert(s:at(math.min(u, u1), math.min(v, v1)))
      local K, H = shape.exact(u, v, p.position)
      local scale = math.max(math.abs(p.principal[1]), math.abs(p.principal[2]))
      local error = math.max(math.abs(p.gauss - K) / scale ^ 2, math.abs(p.mean - H) / scale)
      shape.worst = math.max(shape.worst, error)
      x[i + 1][j + 1], y[i + 1][j + 1], z[i + 1][j + 1] = p.position.x, p.position.y, p.position.z
      gauss[i + 1][j + 1], mean[i + 1][j + 1], off[i + 1][j + 1] = p.gauss, p.mean, math.log(math.max(error, 1e-17), 10)
      if i % 12 == 0 and j % 12 == 0 then
        local row = { u, v, shape.name, p.gauss, p.mean, p.gauss - K, p.mean - H }
        for k = 1, 7 do list[k][#list[k] + 1] = row[k] end
      end
    end
  end
  return x, y, z, { gauss, mean, off }
end

local panels = {}
for row, shape in ipairs(shapes) do
  local x, y, z, values = net(shape)
  for column, value in ipairs(values) do
    local most, title = 0, nil
    for _, line in ipairs(value) do for _, entry in ipairs(line) do most = math.max(most, math.abs(entry)) end end
    if column == 1 then title = string.format("%s: K", shape.name) end
    if column == 2 then title = string.format("%s: H", shape.name) end
    if column == 3 then title = string.format("%s: log10 of the error, at most %.0e", shape.name, shape.worst) end
    panels[#panels + 1] = plot.panel {
      title = title, equal = true, frame = false, legend = "none", view = shape.view, zoom = shape.zoom, at = { column, row },
      plot.surface { x, y, z, value = value, range = column < 3 and { -most, most } or { -17, -14 } },
    }
  end
end

assert(csv.save("curvature", { "u", "v", "surface", "gauss", "mean", "gauss_off", "mean_off" }, list))
local drawn, why = plot.save(plot.figure {
  title = "Curvature from quaternion frames", size = { 1500, 1120 }, grid = { 3, 3 },
  subtitle = "the error against the closed form is in parts of the larger principal curvature, or its square",
  table.unpack(panels),
}, "curvature")
if not drawn then print("curvature: " .. why) end
