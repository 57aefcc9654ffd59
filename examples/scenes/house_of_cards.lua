-- SPDX-License-Identifier: MIT
--- A house of fifteen cards stands, until a ball brings it down.
---
---   standing   cards lean on each other edge on edge, along the middle of all directions between their faces; reactions at every edge hold
---              the house: proved at t = 0, and nothing moves until the ball comes. The feet need friction (h sin a - d cos a)/(2 h cos a),
---              a from upright, of cards 2 h high and 2 d thick: .18
---   falling    cards that lie on each other are moved by steps; the closing summary tells their error
local impact = require "impact"
local plot = require "quat.plot"
local quat = require "quat"

local stories, half, lean = 3, { x = 0.0004, y = 0.031, z = 0.044 }, math.rad(20.25)
local speed = impact.arguments { speed = 3 }.speed -- of the ball, m/s; 0: the house alone, at rest at once
local rise, reach = math.sin(lean) * half.x + math.cos(lean) * half.z, math.cos(lean) * half.x + math.sin(lean) * half.z

local bodies, cards = { impact.body { name = "table", shape = impact.plane(), friction = 0.7 } }, {}
local function lay(name, shape, x, z, turn)
  cards[#cards + 1] = { name = name, half_x = shape.a, half_z = shape.c }
  bodies[#bodies + 1] = impact.body { name = name, shape = shape, mass = 0.0018, position = { x, 0, z }, orientation = quat.from_axis_angle({ 0, 1, 0 }, turn),
    friction = 0.7, restitution = 0.1 }
end
for story = 1, stories do
  local ground, pairs_here = (story - 1) * 2 * (rise + half.x), stories + 1 - story
  for k = 1, pairs_here do
    local middle = 4 * reach * (k - (pairs_here + 1) / 2)
    for _, side in ipairs { -1, 1 } do
      lay(("leaning %d %d %s"):format(story, k, side < 0 and "left" or "right"), impact.box { a = half.x, b = half.y, c = half.z },
        middle + side * reach, ground + rise, -side * lean)
    end
    if k < pairs_here then
      lay(("floor %d %d"):format(story, k), impact.box { a = half.y, b = half.z, c = half.x }, middle + 2 * reach, ground + 2 * rise + half.x, 0)
    end
  end
end
if speed > 0 then
  bodies[#bodies + 1] = impact.body { name = "ball", shape = impact.sphere(0.01), mass = 0.01, position = { -0.4, 0, 0.06 }, velocity = { speed, 0, 0.3 }, friction = 0.3,
    restitution = 0.5 }
end

-- Seen from the side: x to the right, z up.
local function outline(card, track, k)
  local xs, zs = {}, {}
  for _, corner in ipairs { { 1, 1 }, { 1, -1 }, { -1, -1 }, { -1, 1 }, { 1, 1 } } do
    local v = quat.rotate({ track.qw[k], track.qx[k], track.qy[k], track.qz[k] }, { corner[1] * card.half_x, 0, corner[2] * card.half_z })
    xs[#xs + 1], zs[#zs + 1] = track.x[k] + v.x, track.z[k] + v.z
  end
  return plot.line { xs, zs, color = card.name:find "left" and "blue" or card.name:find "right" and "orange" or "black", width = 2 }
end

local function draw(scene)
  local panels = {}
  for row, moment in ipairs { 0, 0.4, 1 } do
    local t = moment * scene:time()
    local panel = { title = ("t = %.2f s"):format(t), xlabel = "x, m", ylabel = "z, m", legend = "none", equal = true,
      box = { 0.1, 1.02 - 0.31 * row, 0.96, 1.2 - 0.31 * row }, xrange = { -0.25, 0.4 }, yrange = { -0.01, 0.28 } }
    for _, card in ipairs(cards) do
      local track = scene:track(card.name)
      local k = 1
      while track.t[k + 1] and track.t[k + 1] <= t do k = k + 1 end
      panel[#panel + 1] = outline(card, track, k)
    end
    panels[row] = plot.panel(panel)
  end
  panels.title = "A house of cards"
  panels.size = { 900, 1000 }
  return plot.figure(panels)
end

return impact.scene { name = "house_of_cards", gravity = { 0, 0, -9.81 }, duration = 0.5, output_rate = 100, bodies = bodies, together = "moreau", plot = draw }
