-- SPDX-License-Identifier: MIT
--- The thesis' figure 12: a sphere in two patches, the quaternion Gauss map of each, and the transition along their seam.
---
--- Over each point of the sphere lies a circle of frames q exp(k phi/2) with the same normal. On each half one is chosen from every
--- circle by the strategy of least length, then least area, of the image on S^3. For a half sphere the result is known: the shortest
--- rotations from its pole, a cap of a great sphere of S^3 with area 2 pi (1 - cos(pi/4)).
--- Both halves have frames over the equator; s = q2* q1 = exp(k angle/2) takes one to the other. Its angle turns by -4 pi around the
--- seam: no choice of frames on one half can undo it, since the sphere has Euler number 2.
--- fig12.csv holds the frames of both patches along the seam and the angle between them.
local quat = require "quat"
local plot = require "quat.plot"
local csv = require "quat.csv"

if not quat.surface then
  print("fig12: this build is without GSL")
  return
end

local rings, spokes = 12, 48
local cos, sin, pi = math.cos, math.sin, math.pi

--- The half of the unit sphere about sign z: node 1 is its pole, then ring after ring.
local function patch(sign)
  local x, q, triangles = { { 0, 0, sign } }, { sign > 0 and quat.identity() or quat.new(0, 1, 0, 0) }, {}
  for i = 1, rings do
    for j = 0, spokes - 1 do
      local polar, around = pi / 2 * i / rings, 2 * pi * j / spokes
      x[#x + 1] = { sin(polar) * cos(around), sin(polar) * sin(around), sign * cos(polar) }
      q[#q + 1] = assert(quat.from_two_vectors({ 0, 0, 1 }, x[#x]))
    end
  end
  local function node(i, j) return i == 0 and 1 or 2 + (i - 1) * spokes + j % spokes end
  for i = 0, rings - 1 do
    for j = 0, spokes - 1 do
      triangles[#triangles + 1] = { node(i, j), node(i + 1, j), node(i + 1, j + 1) }
      if i > 0 then triangles[#triangles + 1] = { node(i, j), node(i + 1, j + 1), node(i, j + 1) } end
    end
  end
  local frames, report = quat.surface.choose_frames { positions = x, frames = q, triangles = triangles, gauge = "area" }
  return { x = x, q = assert(frames, report), node = node, area = report.area }
end

local north, south = patch(1), patch(-1)

-- ---- pictures ----

--- A patch as rows of rings, each closed, through f(node).
local function sheet(p, f, options)
  local x, y, z = {}, {}, {}
  for i = 0, rings do
    x[i + 1], y[i + 1], z[i + 1] = {}, {}, {}
    for j = 0, spokes do
      local at = f(p.node(i, j))
      x[i + 1][j + 1], y[i + 1][j + 1], z[i + 1][j + 1] = at[1], at[2], at[3]
    end
  end
  options[1], options[2], options[3] = x, y, z
  return plot.surface(options)
end

local function path(n, f, options)
  local x, y, z = {}, {}, {}
  for i = 0, n do
    local at = f(i)
    x[i + 1], y[i + 1], z[i + 1] = at[1], at[2], at[3]
  end
  options[1], options[2], options[3] = x, y, z
  return plot.line(options)
end

--- S^3 on space, by stereographic projection: turned first so that both patches lie alike about the middle.
local middle = quat.new(math.sqrt(0.5), math.sqrt(0.5), 0, 0)
local function image(q)
  q = middle:conj() * q
  local f = 1 / (1 + q.w)
  return { f * q.x, f * q.y, f * q.z }
end

-- The sphere, with the axes T1 and T2 of some frames on the side that shows.
local view = { 68, 35 }
local function faces(n)
  local tilt, turn = math.rad(view[1]), math.rad(view[2])
  return n[1] * sin(tilt) * sin(turn) - n[2] * sin(tilt) * cos(turn) + n[3] * cos(tilt) > 0.12
end
local function axes(p, axis, color)
  local a = { {}, {}, {}, {}, {}, {} }
  for i = 0, rings, 3 do
    for j = 0, i == 0 and 0 or spokes - 1, i == rings and 3 or i < 6 and 8 or 4 do
      local node = p.node(i, j)
      local n, d = p.x[node], p.q[node]:rotate(axis)
      if faces(n) then
        for k = 1, 3 do
          table.insert(a[k], 1.01 * n[k])
          table.insert(a[k + 3], 0.17 * d[k])
        end
      end
    end
  end
  a.color, a.width, a.head = color, 1.6, 0.012
  return plot.arrows(a)
end
local extent = { -1.1, 1.1 }
local sphere = plot.panel {
  title = "the frames: T1 dark, T2 white", equal = true, frame = false, legend = "none", three = true, view = view, zoom = 1.6, at = { 1, 1, 1, 2 },
  xrange = extent, yrange = extent, zrange = extent,
  sheet(north, function(i) return north.x[i] end, { color = "#7fa8d8", opacity = 1 }),
  sheet(south, function(i) return south.x[i] end, { color = "#f2b27c", opacity = 1 }),
  path(4 * spokes, function(j)
    local n = { cos(pi * j / 2 / spokes), sin(pi * j / 2 / spokes), 0 }
    return sin(math.rad(view[2])) * n[1] - cos(math.rad(view[2])) * n[2] > 0 and n or { 0 / 0, 0, 0 }
  end, { color = "red", width = 3 }),
  axes(north, { 0, 1, 0 }, "#ffffff"), axes(south, { 0, 1, 0 }, "#ffffff"),
  axes(north, { 1, 0, 0 }, "dark"), axes(south, { 1, 0, 0 }, "dark"),
}

-- Both Gauss maps in S^3, and the circles of frames over points of the seam.
local maps = {
  title = "their images in S³, and the ways s from one to the other", equal = true, frame = false, legend = "none",
  view = { 66, 200 }, zoom = 2.1, at = { 2, 1, 1, 2 },
}
local function color(fraction) -- around the seam: a wheel of hues
  local function part(shift)
    return math.floor(150 + 90 * cos(2 * pi * (fraction - shift)) + 0.5)
  end
  return string.format("#%02x%02x%02x", part(0), part(1 / 3), part(2 / 3))
end
for j = 0, spokes - 1, 3 do -- on the circle of frames over a point of the seam
  local to, from = north.q[north.node(rings, j)], south.q[south.node(rings, j)]
  local s = from:conj() * to
  local half = math.atan(s.z, s.w)
  maps[#maps + 1] = path(60, function(i)
    return image(from * quat.new(cos(half * i / 60), 0, 0, sin(half * i / 60)))
  end, { color = color(j / spokes), width = 1.6 })
end
maps[#maps + 1] = sheet(north, function(i) return image(north.q[i]) end, { color = "#7fa8d8", opacity = 0.75 })
maps[#maps + 1] = sheet(south, function(i) return image(south.q[i]) end, { color = "#f2b27c", opacity = 0.75 })
for _, p in ipairs { north, south } do
  maps[#maps + 1] = path(spokes, function(j) return image(p.q[p.node(rings, j)]) end, { color = "red", width = 3 })
  for j = 0, spokes - 1, 3 do
    local at = image(p.q[p.node(rings, j)])
    maps[#maps + 1] = plot.points { { at[1] }, { at[2] }, { at[3] }, color = color(j / spokes), size = 1.1 }
  end
end

-- ---- the transition ----

local q1, q2, theta, rows = {}, {}, {}, {}
for c = 1, 9 do rows[c] = {} end
for j = 0, spokes do
  local at = j - spokes // 4 -- from longitude -90 degrees, where both frames are the same
  theta[j + 1] = 2 * pi * at / spokes
  q1[j + 1], q2[j + 1] = north.q[north.node(rings, at)], south.q[south.node(rings, at)]
  for k, letter in ipairs { "w", "x", "y", "z" } do
    rows[k][j + 1], rows[k + 4][j + 1] = q1[j + 1][letter], q2[j + 1][letter]
  end
end
local turns, angle = quat.surface.transition(q1, q2)
assert(turns, angle)
local full = {}
for j, a in ipairs(angle) do
  rows[9][j] = a
  full[j] = a / (2 * pi)
end
local degrees = {}
for j, t in ipairs(theta) do degrees[j] = math.deg(t) end
local transition = plot.panel {
  title = string.format("along the seam, s = q2* q1 turns %.0f times", turns), xlabel = "longitude (degrees)",
  ylabel = "angle of s (turns)", legend = "none", at = { 3, 1, 1, 1 }, xrange = { -90, 270 },
  plot.line { degrees, full, color = "red", width = 2.5 },
}
local circle = {
  title = "s = w + k z itself, by longitude", xlabel = "w", ylabel = "z", equal = true, legend = "none",
  at = { 3, 2, 1, 1 }, xrange = { -1.5, 1.5 }, yrange = { -1.35, 1.35 },
}
local ring = { {}, {} }
for i = 0, 100 do ring[1][i + 1], ring[2][i + 1] = cos(pi * i / 50), sin(pi * i / 50) end
circle[#circle + 1] = plot.line { ring[1], ring[2], color = "grey", width = 1.5 }
for j = 1, spokes, 6 do
  local s = q2[j]:conj() * q1[j]
  local sign = math.cos(angle[j] / 2) * s.w + math.sin(angle[j] / 2) * s.z < 0 and -1 or 1
  circle[#circle + 1] = plot.points { { sign * s.w }, { sign * s.z }, color = color(theta[j] / (2 * pi)), size = 1.6 }
  circle[#circle + 1] = plot.text { string.format("%d°", math.floor(degrees[j] + 0.5)), at = { 1.26 * sign * s.w, 1.18 * sign * s.z },
    align = "center", size = 9 }
end

assert(csv.save("fig12", { "longitude", "north_w", "north_x", "north_y", "north_z", "south_w", "south_x", "south_y", "south_z", "angle" },
  { theta, table.unpack(rows) }))
local drawn, why = plot.save(plot.figure {
  title = "A sphere in two patches", size = { 1800, 720 }, grid = { 3, 2 },
  subtitle = string.format("frames of least length and area; area of each image %.4f by %d flat triangles, 2π(1 − cos π/4) = %.4f when smooth",
    north.area, spokes * (2 * rings - 1), 2 * pi * (1 - math.sqrt(0.5))),
  sphere, plot.panel(maps), transition, plot.panel(circle),
}, "fig12")
if not drawn then print("fig12: " .. why) end
