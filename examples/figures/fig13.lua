-- SPDX-License-Identifier: MIT
--- The thesis' figure 13: two superquadrics whose Minkowski difference holds the origin, with normals and the contact.
---
--- Two convex bodies A and B meet where the difference A - B = {a - b} holds the origin. Its boundary is drawn from the support
--- functions: in the direction n it lies at a(n) - b(-n). The contact's normal n is the direction in which the origin is nearest
--- to that boundary, and the gap is minus that distance.
--- fig13.csv holds the contact: the gap, the normal and the witness points.
local impact = require "impact"
local plot = require "quat.plot"
local csv = require "quat.csv"

local function about(x, y, z, angle)
  local s = math.sin(angle / 2) / math.sqrt(x * x + y * y + z * z)
  return { math.cos(angle / 2), s * x, s * y, s * z }
end

local A = {
  shape = impact.shape.superquadric { a = 1, b = 0.7, c = 0.5, r = 4, s = 3, t = 2.5 },
  position = { 0, 0, 0 }, orientation = about(1, 2, 3, 0.7),
}
local B = {
  shape = impact.shape.superquadric { a = 0.6, b = 0.9, c = 0.8, r = 1.6, s = 2.2, t = 6 },
  position = { 1.05, 0.75, 0.55 }, orientation = about(-1, 1, 0.5, 1.1),
}

--- v turned by q, or back by its inverse.
local function turn(q, v, back)
  local s = back and -1 or 1
  local w, x, y, z = q[1], s * q[2], s * q[3], s * q[4]
  local tx, ty, tz = 2 * (y * v[3] - z * v[2]), 2 * (z * v[1] - x * v[3]), 2 * (x * v[2] - y * v[1])
  return { v[1] + w * tx + y * tz - z * ty, v[2] + w * ty + z * tx - x * tz, v[3] + w * tz + x * ty - y * tx }
end

local function to_world(body, v)
  local t = turn(body.orientation, v)
  return { t[1] + body.position[1], t[2] + body.position[2], t[3] + body.position[3] }
end

--- The world point of a body that lies farthest along d.
local function support(body, d)
  local _, x = body.shape:support(turn(body.orientation, d, true))
  return to_world(body, { x.x, x.y, x.z })
end

local rows, columns = 48, 64

--- A surface of (u, v) -> point as rows of x, y, z.
local function sheet(point, options)
  local x, y, z = {}, {}, {}
  for j = 0, rows do
    x[j + 1], y[j + 1], z[j + 1] = {}, {}, {}
    for i = 0, columns do
      local p = point(-math.pi + 2 * math.pi * i / columns, -math.pi / 2 + math.pi * j / rows)
      x[j + 1][i + 1], y[j + 1][i + 1], z[j + 1][i + 1] = p[1], p[2], p[3]
    end
  end
  options[1], options[2], options[3] = x, y, z
  return plot.surface(options)
end

local function body_sheet(body, color)
  return sheet(function(u, v)
    local p = body.shape:point(u, v)
    return to_world(body, { p.x, p.y, p.z })
  end, { color = color, opacity = 0.25, lines = true })
end

--- Normals of a body's surface as arrows of the given length; few, so that the contact is seen between them.
local function normals(body, color, length)
  local arrows = { {}, {}, {}, {}, {}, {} }
  for j = 1, 3 do
    for i = 0, 7 do
      local u, v = -math.pi + 2 * math.pi * (i + 0.5) / 8, -math.pi / 2 + math.pi * j / 4
      local p, n = body.shape:point(u, v), body.shape:normal(u, v)
      local x, d = to_world(body, { p.x, p.y, p.z }), turn(body.orientation, { n.x, n.y, n.z })
      for k = 1, 3 do
        local start, way = arrows[k], arrows[k + 3]
        start[#start + 1], way[#way + 1] = x[k], length * d[k]
      end
    end
  end
  arrows.color = color
  arrows.width = 1
  return plot.arrows(arrows)
end

--- A name beside the body, to the left of what is seen of it.
local function name_of(body, text, color)
  local p = body.position
  return plot.text { text, at = { p[1] - 1.1, p[2] - 1.1, p[3] + 0.5 }, size = 22, color = color }
end

local contact = assert(impact.gap(A, B))
local n, a, b = contact.normal, contact.point1, contact.point2

local bodies = plot.panel {
  title = string.format("A and B overlap by %.6f", -contact.gap), equal = true, frame = false, legend = "none", view = { 65, 330 }, zoom = 2.2,
  body_sheet(A, "blue"), body_sheet(B, "orange"), normals(A, "blue", 0.18), normals(B, "orange", 0.18),
  plot.arrows { { a.x }, { a.y }, { a.z }, { 0.6 * n.x }, { 0.6 * n.y }, { 0.6 * n.z }, color = "red", width = 5 },
  plot.points { { a.x, b.x }, { a.y, b.y }, { a.z, b.z }, color = "red", size = 1.2 },
  name_of(A, "A", "blue"), name_of(B, "B", "orange"),
}

local difference = plot.panel {
  title = "A − B holds the origin", equal = true, frame = false, legend = "none", view = { 65, 330 }, zoom = 2.2,
  sheet(function(u, v)
    local d = { math.cos(v) * math.cos(u), math.cos(v) * math.sin(u), math.sin(v) }
    local p, q = support(A, d), support(B, { -d[1], -d[2], -d[3] })
    return { p[1] - q[1], p[2] - q[2], p[3] - q[3] }
  end, { color = "purple", opacity = 0.3, lines = true }),
  plot.points { { 0 }, { 0 }, { 0 }, color = "black", size = 1.5 },
  plot.text { "0", at = { 0.1, 0, -0.25 }, size = 18, color = "black" },
  plot.arrows { { 0 }, { 0 }, { 0 }, { a.x - b.x }, { a.y - b.y }, { a.z - b.z }, color = "red", width = 3 },
}

assert(csv.save("fig13", { "gap", "nx", "ny", "nz", "ax", "ay", "az", "bx", "by", "bz" },
  { { contact.gap }, { n.x }, { n.y }, { n.z }, { a.x }, { a.y }, { a.z }, { b.x }, { b.y }, { b.z } }))
local drawn, why = plot.save(plot.figure { title = "Two superquadrics in contact", size = { 1300, 620 }, grid = { 2, 1 }, bodies,
  difference }, "fig13")
if not drawn then print("fig13: " .. why) end
