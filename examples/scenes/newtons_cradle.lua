-- SPDX-License-Identifier: MIT
--- Newton's cradle, on a line between two walls instead of on strings: five equal balls, 0.1 mm apart, and two more that
--- fly at them.
---
--- Equal balls of restitution 1 exchange their velocities: two balls in drive two balls out, and the rest stand still. Were the five to
--- touch, the impacts of one instant would still come one after another, of all pairs that touch and approach the first in the order of
--- the definition: equal balls end the same in any order, unequal ones need not, and `usage().impacts_simultaneous` counts such answers.
local impact = require "impact"
local plot = require "quat.plot"

local r, v, wall = 0.05, 1, 1.003 -- no hit falls on a sample: which of two rows of one time comes first is rounding's to say
local colors = { "blue", "orange", "green", "purple", "dark", "red", "grey" }
local bodies = {
  impact.body { name = "left wall", shape = impact.plane(), position = { -wall, 0, 0 }, normal = { 1, 0, 0 }, friction = 0, restitution = 1 },
  impact.body { name = "right wall", shape = impact.plane(), position = { wall, 0, 0 }, normal = { -1, 0, 0 }, friction = 0, restitution = 1 },
}

for i = 1, 7 do
  local flies = i <= 2
  bodies[#bodies + 1] = impact.body {
    name = "ball " .. i,
    shape = impact.sphere(r),
    mass = 1,
    position = { flies and -wall + (2 * i - 1) * 2 * r or (2 * r + 1e-4) * (i - 5), 0, 0 },
    velocity = { flies and v or 0, 0, 0 },
    friction = 0,
    restitution = 1,
  }
end

local function draw(scene)
  local places, speeds = {}, {}
  for i = 1, 7 do
    local track = scene:track("ball " .. i, 400)
    places[i] = plot.line { track.t, track.x, color = colors[i], width = 2.2, label = "ball " .. i }
    local shown = {}
    for k = 1, #track.t do shown[k] = track.vx[k] + 2.5 * i end
    speeds[i] = plot.line { track.t, shown, color = colors[i], width = 2 }
  end
  places.title, places.xlabel, places.ylabel, places.legend, places.yrange = "places", "time, s", "x, m", "none", { -1, 1 }
  speeds.title, speeds.xlabel, speeds.ylabel, speeds.legend = "velocities, one above another", "time, s", "v + 2.5 i, m/s", "none"
  return plot.figure {
    title = "Two balls in, two balls out",
    size = { 1300, 620 },
    grid = { 2, 1 },
    plot.panel(places),
    plot.panel(speeds),
  }
end

return impact.scene {
  name = "newtons_cradle",
  gravity = { 0, 0, 0 },
  duration = 4,
  output_rate = 24,
  bodies = bodies,
  plot = draw,
}
