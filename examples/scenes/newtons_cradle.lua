-- SPDX-License-Identifier: MIT
--- Newton's cradle, on a line between two walls instead of on strings: five equal balls, 0.1 mm apart, and two more that
--- fly at them.
---
--- Equal balls of restitution 1 exchange their velocities: two balls in drive two balls out, and the rest stand still. That is the
--- textbook's answer, and it needs the gaps: with any of them, however small, impacts come one after another. Bodies that touch are
--- struck together, and the answer is the law's (docs/together.md):
---
---   impact newtons_cradle.lua -- gap=0.0 law=stronge           stiff springs, Hertz's: the striker comes back, all five move
---   impact newtons_cradle.lua -- gap=0.0                       Moreau's law: the five go on as one
---   impact newtons_cradle.lua -- gap=0.0 together=sequence     one after another, in the order of the list: the textbook's again
---
--- In a workshop the gap that parts the first from the textbook is the depth to which the steel is pressed in, some micrometres: Hertz's
--- (15/16 m v^2/(E* sqrt R))^(2/5) for a ball of mass m at speed v. Rigid bodies have none, and the gap is that of rounding.
local impact = require "impact"
local plot = require "quat.plot"

local arguments = impact.arguments { gap = 1e-4, law = "poisson", together = "auto" }
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
    position = { flies and -wall + (2 * i - 1) * 2 * r or (2 * r + arguments.gap) * (i - 5), 0, 0 },
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
  law = arguments.law,
  together = arguments.together,
  bodies = bodies,
  plot = draw,
}
