-- SPDX-License-Identifier: MIT
--- Euler's disk rolls round on its edge, its centre at rest.
---
--- A superquadric of exponents (2, 2, 100), radius a = 37.5 mm, 4 mm thick, leans by alpha. It turns about the line from its centre to the
--- contact, w = W z + s e with e its axis and w x r = 0, and its weight turns its angular momentum at the rate W of the contact:
---
---   r x m g z = W z x L(w)
---
--- A thin disk that lies nearly flat goes round at W^2 = 4 g/(a alpha): the flatter, the faster, without bound. Without losses it goes on
--- for ever, at the angle it began with.
local impact = require "impact"
local quat = require "quat"
local plot = require "quat.plot"

local g, m, a, alpha = 9.81, 0.4, 0.0375, 0.25
local shape = impact.superquadric { a = a, b = a, c = 0.002, r = 2, s = 2, t = 100 }
local lean = { math.cos(alpha / 2), math.sin(alpha / 2), 0, 0 }

--- r, W and w for a disk that leans by the angle.
local function steady(angle, disk)
  local c, s = math.cos(angle), math.sin(angle)
  local _, low = disk:support { 0, -s, -c } -- downwards, in the disk's axes
  local y, z = c * low[2] - s * low[3], s * low[2] + c * low[3] -- r = (0, y, z), e = (0, -s, c)
  local spin = y / (-s * z - c * y)
  local j = disk.inertia
  local along = c + spin -- of w/W, along e; across it, in the plane of z and e, s
  local ly, lz = j.x * s * c - j.z * along * s, j.x * s * s + j.z * along * c -- L/(m W)
  return { 0, y, z }, math.sqrt(g * y / -ly), { 0, -spin * s, 1 + spin * c }, lz
end

local r, W, w = steady(alpha, shape)
local omega = { 0, W * w[2], W * w[3] }

local function draw(scene)
  local track = scene:track "disk"
  local x, y, off = {}, {}, {}
  for i = 1, #track.t do
    local q = { track.qw[i], track.qx[i], track.qy[i], track.qz[i] }
    local e = quat.rotate(quat.new(q[1], q[2], q[3], q[4]), { 0, 0, 1 })
    x[i], y[i] = e[1], e[2]
    local phi = W * track.t[i]
    local d = { e[1] - math.sin(alpha) * math.sin(phi), e[2] + math.sin(alpha) * math.cos(phi), e[3] - math.cos(alpha) }
    off[i] = math.max(math.sqrt(d[1] ^ 2 + d[2] ^ 2 + d[3] ^ 2), 1e-17)
  end
  local angles, ratio = {}, {}
  local thin = impact.superquadric { a = a, b = a, c = 1e-6, r = 2, s = 2, t = 100 }
  for k = 0, 60 do
    local angle = 10 ^ (-2.5 + 2.4 * k / 60)
    local _, rate = steady(angle, thin)
    angles[#angles + 1], ratio[#ratio + 1] = angle, rate ^ 2 * a * angle / (4 * g)
  end
  return plot.figure {
    title = "Euler's disk",
    subtitle = string.format("leaning by %g: the contact goes round %.2f times a second", alpha, W / (2 * math.pi)),
    size = { 1500, 560 },
    grid = { 3, 1 },
    plot.panel {
      title = "the axis, seen from above", xlabel = "x", ylabel = "y", equal = true, legend = "none",
      plot.points { x, y, color = "blue", size = 0.7 },
    },
    plot.panel {
      title = "the axis less the steady solution's", xlabel = "time, s", ylog = true, legend = "none", yrange = { 1e-17, 1e-9 },
      plot.points { track.t, off, color = "purple", size = 0.7 },
    },
    plot.panel {
      title = "Ω² aα/(4g) of a thin disk; 1.005 by its rounded edge", xlabel = "leaning α, rad", xlog = true, legend = "none",
      plot.line { angles, ratio, color = "dark" },
    },
  }
end

return impact.scene {
  name = "eulers_disk",
  gravity = { 0, 0, -g },
  duration = 6 * 2 * math.pi / W,
  output_rate = 200,
  bodies = {
    impact.body { name = "glass", shape = impact.plane(), friction = 1, restitution = 0 },
    impact.body {
      name = "disk",
      shape = shape,
      mass = m,
      position = { 0, 0, -r[3] },
      orientation = lean,
      omega = omega,
      friction = 0.5,
      restitution = 0,
    },
  },
  plot = draw,
}
