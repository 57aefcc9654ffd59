-- SPDX-License-Identifier: MIT
--- A tippe top turns over: spun on its heavy end, it ends on the other, its centre of mass raised.
---
--- A sphere of radius R whose centre of mass lies 0.3 R below its centre. With moments A across its axis and C along it, it inverts where
--- 0.7 < A/C < 1.3 and it spins fast enough; here A/C = 0.94. What turns it is the friction of its sliding contact. Friction has no moment
--- about the line from the contact to the sphere's centre, and a body of revolution none about its axis, so that
---
---   Jellett's integral   -L . r = const,   r from the centre of mass to the contact,
---
--- stays to the end, through sliding and rolling.
local impact = require "impact"
local plot = require "quat.plot"

local R, m, aside, tilt = 0.02, 0.02, 0.3, 0.1
local A, C = 131 / 350 * m * R * R, 0.4 * m * R * R

local function draw(scene)
  local track = scene:track "top"
  local angle, height, off, wz, first = {}, {}, {}, {}, nil
  for i = 1, #track.t do
    local w, x, y, z = track.qw[i], track.qx[i], track.qy[i], track.qz[i]
    local e = { 2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y) } -- the axis
    local spin = track.wx[i] * e[1] + track.wy[i] * e[2] + track.wz[i] * e[3]
    local jellett = 0
    for k, omega in ipairs { track.wx[i], track.wy[i], track.wz[i] } do
      local L = A * omega + (C - A) * spin * e[k]
      jellett = jellett - L * (aside * R * e[k] - (k == 3 and R or 0))
    end
    first = first or jellett
    off[i] = math.max(math.abs(jellett / first - 1), 1e-16)
    angle[i], height[i], wz[i] = math.deg(math.acos(math.max(-1, math.min(1, e[3])))), 1000 * track.z[i], track.wz[i]
  end
  return plot.figure {
    title = "A tippe top turns over",
    size = { 1300, 900 },
    grid = { 2, 2 },
    plot.panel { title = "its axis, from the vertical", ylabel = "degrees", legend = "none", plot.line { track.t, angle, color = "blue" } },
    plot.panel { title = "spin about the vertical", ylabel = "rad/s", legend = "none", plot.line { track.t, wz, color = "purple" } },
    plot.panel { title = "height of the centre of mass", xlabel = "time, s", ylabel = "mm", legend = "none", plot.line { track.t, height, color = "orange" } },
    plot.panel {
      title = "Jellett's integral: its relative change", xlabel = "time, s", ylog = true, legend = "none", yrange = { 1e-16, 1e-9 },
      plot.line { track.t, off, color = "dark" },
    },
  }
end

return impact.scene {
  name = "tippe_top",
  gravity = { 0, 0, -9.81 },
  duration = 5,
  output_rate = 96,
  bodies = {
    impact.body { name = "table", shape = impact.plane(), friction = 1, restitution = 0 },
    impact.body {
      name = "top",
      shape = impact.sphere(R),
      shape_position = { 0, 0, aside * R },
      mass = m,
      moments = { A, A, C },
      position = { 0, 0, R - aside * R * math.cos(tilt) },
      orientation = { math.cos(tilt / 2), math.sin(tilt / 2), 0, 0 },
      omega = { 0, 0, 155 },
      friction = 0.1,
      restitution = 0,
    },
  },
  plot = draw,
}
