-- SPDX-License-Identifier: MIT
--- The thesis' figure 6: a Moebius band, and the sign of the spinor that goes round it.
---
--- A strip of 2 x 16 in 41 segments is twisted by pi and bent by 2 pi. Its frame, u rounds from the start (z the normal), is
---
---   q(u) = exp(pi u k) exp(pi u j / 2)
---
--- After one round the normal is turned over; after two it is back, but q is -q; only after four is q itself again.
--- fig06.csv holds the middles of the segments, their normals and orientations.
local quat = require "quat"
local plot = require "quat.plot"
local csv = require "quat.csv"
local portrait = require "impact.portrait"

local length, width, segments = 16, 2, 41
local radius = length / (2 * math.pi)

local function place(u) return { radius * math.cos(2 * math.pi * u), radius * math.sin(2 * math.pi * u), 0 } end

-- The band's edges between segments, finer than they are, and the normals at their middles.
local frames, places = {}, {}
for i = 0, 4 * segments do
  frames[i + 1], places[i + 1] = quat.band(math.pi, i / (4 * segments)), place(i / (4 * segments))
end
local columns = { {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {} }
local view = { 58, 22 }
local eye = portrait.eye(view)
local near, far = { {}, {}, {}, {}, {}, {}, color = "blue", width = 1.4, head = 0.012, front = true },
  { {}, {}, {}, {}, {}, {}, color = "blue", width = 1.4, head = 0.012 }
for n = 1, segments do
  local u = (n - 0.5) / segments
  local q, p = quat.band(math.pi, u), place(u)
  local normal = q:rotate { 0, 0, 1 }
  for i, value in ipairs { n, p[1], p[2], p[3], normal.x, normal.y, normal.z, q.w, q.x, q.y, q.z } do columns[i][n] = value end
  -- A normal that points away from the eye stands behind the band.
  local side = normal.x * eye[1] + normal.y * eye[2] + normal.z * eye[3] > 0 and near or far
  for i, value in ipairs { p[1], p[2], p[3], 0.8 * normal.x, 0.8 * normal.y, 0.8 * normal.z } do table.insert(side[i], value) end
end

local band = {
  title = "a strip of 2 × 16, twisted by π and bent by 2π", equal = true, legend = "none", frame = false, view = view, zoom = 2.2,
  xrange = { -3.4, 3.4 }, yrange = { -3.4, 3.4 }, zrange = { -1.4, 1.4 }, box = { 0.0, 0.02, 0.55, 0.88 },
}
for _, item in ipairs(portrait.ribbon(frames, places,
  { half_width = width / 2, thickness = 0.06, front = "#8fb8de", back = "#f6c28b" })) do
  band[#band + 1] = item
end
band[#band + 1] = plot.arrows(near)
band[#band + 1] = plot.arrows(far)
for u, color in pairs { [0] = "dark", [1] = "orange" } do
  local normal = quat.band(math.pi, u):rotate { 0, 0, 1.4 }
  band[#band + 1] = plot.arrows { { radius }, { 0 }, { 0 }, { normal.x }, { normal.y }, { normal.z }, color = color, width = 3.5,
    head = 0.02, front = u == 0 }
end
band[#band + 1] = plot.text { "start", at = { radius - 0.15, 0, 1.1 }, align = "right", size = 12 }
band[#band + 1] = plot.text { "after one round", at = { radius + 0.2, 0, -1.45 }, size = 12, color = "orange" }

-- Four rounds: the normal beside the spinor.
local u, normal, spinor = {}, {}, {}
local start = quat.band(math.pi, 0)
for i = 0, 400 do
  local q = quat.band(math.pi, i / 100)
  u[i + 1], normal[i + 1], spinor[i + 1] = i / 100, q:rotate({ 0, 0, 1 }).z, q:dot(start)
end
local signs = plot.panel {
  title = "compared with the start", xlabel = "rounds", ylabel = "cosine", legend = "none", yrange = { -1.25, 1.25 }, xrange = { 0, 4 },
  box = { 0.61, 0.16, 0.97, 0.8 },
  plot.line { u, normal, color = "orange", dash = true, width = 2 },
  plot.line { u, spinor, color = "blue", width = 2.8 },
  plot.points { { 0, 2, 4 }, { 1, 1, 1 }, color = "orange", size = 1.4, shape = "circle" },
  plot.points { { 0, 2, 4 }, { 1, -1, 1 }, color = "blue", size = 1.5 },
  plot.text { "normal: back after 2", at = { 2, 1.13 }, align = "center", color = "orange", size = 11 },
  plot.text { "spinor q: −q after 2, back after 4", at = { 2, -1.13 }, align = "center", color = "blue", size = 11 },
}

assert(csv.save("fig06", { "segment", "x", "y", "z", "nx", "ny", "nz", "qw", "qx", "qy", "qz" }, columns))
local drawn, why = plot.save(plot.figure { title = "A spinor on Möbius' band", size = { 1500, 640 }, plot.panel(band), signs }, "fig06")
if not drawn then print("fig06: " .. why) end
