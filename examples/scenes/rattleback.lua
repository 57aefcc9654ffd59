-- SPDX-License-Identifier: MIT
--- A rattleback, spun the wrong way, begins to rattle, stops, and turns back (Walker 1896; these numbers: Kane and Levinson 1982).
---
--- An ellipsoid of semi-axes 20, 3 and 2 cm rolls without slipping; its centre of mass lies 1 cm below its centre. Along the ellipsoid's
--- axes its inertia is
---
---   (2, 16, 17) 10^-4 kg m^2, and -0.2 10^-4 between x and y:
---
--- the principal axes stand 0.8 degrees aside. That little couples spin and rattle, in one direction of spin only. But for a slip
--- of a few milliseconds at the start nothing is lost: it turns back to the whole of its spin.
local impact = require "impact"
local plot = require "quat.plot"

local a, b, d = 2e-4, 16e-4, -0.2e-4
local mean, half = (a + b) / 2, math.sqrt(((a - b) / 2) ^ 2 + d ^ 2)
local turn = math.atan((mean - half - a) / d) -- from the ellipsoid's x to the principal axis of the least moment
local tilt = math.rad(2)
local A, B, C, low = 0.2, 0.03, 0.02, 0.01

-- The tilt about x after the turn about z.
local orientation = {
  math.cos(tilt / 2) * math.cos(turn / 2), math.sin(tilt / 2) * math.cos(turn / 2),
  -math.sin(tilt / 2) * math.sin(turn / 2), math.cos(tilt / 2) * math.sin(turn / 2),
}
-- Of the tilted ellipsoid, the centre's height; then down to the centre of mass.
local height = math.sqrt((B * math.sin(tilt)) ^ 2 + (C * math.cos(tilt)) ^ 2)

local function draw(scene)
  local track = scene:track "rattleback"
  local energies = scene:energies("rattleback", track)
  local rolls = 1 -- the first row after the slip of the start
  while track.t[rolls] < 0.1 do rolls = rolls + 1 end
  local first = energies.total[rolls]
  local nose = {} -- how far the long axis is from level, degrees
  for i = 1, #track.t do
    nose[i] = math.deg(math.asin(2 * (track.qx[i] * track.qz[i] - track.qw[i] * track.qy[i])))
    energies.total[i] = i < rolls and 0 or math.max(math.abs(energies.total[i] / first - 1), 1e-16)
  end
  return plot.figure {
    title = "A rattleback turns back",
    size = { 1300, 900 },
    grid = { 1, 3 },
    plot.panel {
      title = "spin about the vertical", ylabel = "rad/s", legend = "none",
      plot.line { track.t, track.wz, color = "blue" },
    },
    plot.panel {
      title = "the long axis, from level", ylabel = "degrees", legend = "none",
      plot.line { track.t, nose, color = "orange", width = 1 },
    },
    plot.panel {
      title = "energy: its relative change since 0.1 s, when it no longer slips", xlabel = "time, s", ylog = true, legend = "none", yrange = { 1e-16, 1e-8 },
      plot.line { track.t, energies.total, color = "dark" },
    },
  }
end

return impact.scene {
  name = "rattleback",
  gravity = { 0, 0, -9.81 },
  duration = 8,
  key_tolerance = 1e-8, -- of the recorded run: a page of it with half the keys of 1e-10
  output_rate = 96,
  tolerance = 1e-14,
  bodies = {
    impact.body { name = "table", shape = impact.plane(), friction = 1, restitution = 0 },
    impact.body {
      name = "rattleback",
      shape = impact.ellipsoid { a = A, b = B, c = C },
      shape_position = { 0, 0, low },
      shape_orientation = { math.cos(turn / 2), 0, 0, -math.sin(turn / 2) },
      mass = 1,
      moments = { mean - half, mean + half, 17e-4 },
      position = { 0, 0, height - low * math.cos(tilt) },
      orientation = orientation,
      omega = { 0, 0, -5 },
      friction = 1,
      restitution = 0,
    },
  },
  plot = draw,
}
