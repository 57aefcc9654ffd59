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
--- The figure's last panel has all three. In a workshop the gap that parts the springs' answer from the textbook's is the depth to which
--- the balls are pressed in: Hertz's (15/32 m v^2/(E* sqrt(r/2)))^(2/5) for two of mass m and radius r that meet at v, 58 um for these with
--- steel's E* = 115 GPa. Rigid bodies have none, and the gap is that of rounding.
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

--- Five balls that touch, struck by one of speed 1: the velocities of all six, by a law of docs/together.md.
local function struck(law)
  local balls, contacts = {}, {}
  for i = 1, 6 do balls[i] = { m = 1, J = { moments = { 1, 1, 1 } }, v = { i == 1 and v or 0, 0, 0 } } end
  for i = 1, 5 do
    contacts[i] = { body1 = i, body2 = i + 1, n = { -1, 0, 0 }, r1 = { r, 0, 0 }, r2 = { -r, 0, 0 }, eps = 1 }
  end
  local answer = assert(impact.collide_together { bodies = balls, contacts = contacts, law = law })
  local numbers, speeds = {}, {}
  for i = 1, 6 do numbers[i], speeds[i] = i + 1, answer.v[i].x end
  return numbers, speeds
end

local function draw_laws()
  local panel = { title = "one ball meets five that touch", xlabel = "ball", ylabel = "v, m/s", xrange = { 1.5, 7.5 }, yrange = { -0.8, 1.1 } }
  for i, law in ipairs { "springs", "moreau", "sequence" } do
    local numbers, speeds = struck(law)
    local label = ({ "springs, Hertz's", "Moreau's law", "one after another: the textbook's" })[i]
    panel[i] = plot.line { numbers, speeds, color = colors[2 * i - 1], width = 2.5, label = label }
  end
  return plot.panel(panel)
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
    size = { 1800, 620 },
    grid = { 3, 1 },
    plot.panel(places),
    plot.panel(speeds),
    draw_laws(),
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
