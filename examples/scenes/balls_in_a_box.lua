-- SPDX-License-Identifier: MIT
--- Thirty-two balls fall into a box: a floor and four walls.
---
---   flight     x'' = g, in closed form; a pair's contact is the root of a parabola, or of |d + v t| = r1 + r2
---   impact     Coulomb friction 0.3 through compression and restitution; restitution 0.7
---   account    kinetic + potential = start - sliding loss - impact loss, after every event of the run
---
--- For short whiles the balls are divided into groups that cannot meet; each group moves as a small scene of its own, so that an impact
--- costs what its own group costs, however many balls there are.
local impact = require "impact"
local plot = require "quat.plot"

local n, r, half = 32, 0.08, 0.5
local colors = { "blue", "orange", "green", "purple", "red", "dark" }

local function wall(name, position, normal)
  return impact.body { name = name, shape = impact.plane(), position = position, normal = normal, friction = 1, restitution = 1 }
end

local bodies = {
  wall("floor", { 0, 0, 0 }, { 0, 0, 1 }),
  wall("west", { -half, 0, 0 }, { 1, 0, 0 }),
  wall("east", { half, 0, 0 }, { -1, 0, 0 }),
  wall("south", { 0, -half, 0 }, { 0, 1, 0 }),
  wall("north", { 0, half, 0 }, { 0, -1, 0 }),
}

local seed = 3
local function draw_lots() -- Park and Miller's, in [0, 1)
  seed = seed * 16807 % 2147483647
  return seed / 2147483647
end

for i = 0, n - 1 do
  local column = i % 16
  bodies[#bodies + 1] = impact.body {
    name = "ball " .. i + 1,
    shape = impact.sphere(r),
    position = {
      (column % 4 - 1.5) * 0.22 + 0.02 * (draw_lots() - 0.5),
      (column // 4 - 1.5) * 0.22 + 0.02 * (draw_lots() - 0.5),
      0.3 + (i // 16) * 0.3 + 0.05 * draw_lots(),
    },
    velocity = { draw_lots() - 0.5, draw_lots() - 0.5, 0 },
    friction = 0.3,
    restitution = 0.7,
  }
end

local function circle(x, z, color)
  local xs, zs = {}, {}
  for k = 0, 48 do
    xs[k + 1], zs[k + 1] = x + r * math.cos(k * math.pi / 24), z + r * math.sin(k * math.pi / 24)
  end
  return plot.line { xs, zs, color = color, width = 2 }
end

local function draw(scene)
  local front = { title = "from the front: the way down, and the end", xlabel = "x, m", ylabel = "z, m", legend = "none", equal = true, box = { 0.06, 0.12, 0.52, 0.85 },
    xrange = { -0.55, 0.55 }, yrange = { -0.03, 0.8 } }
  for i = 1, n do
    local track = scene:track("ball " .. i, 200)
    front[#front + 1] = plot.line { track.x, track.z, color = colors[i % #colors + 1], width = 0.7 }
    front[#front + 1] = circle(track.x[#track.t], track.z[#track.t], colors[i % #colors + 1])
  end
  front[#front + 1] = plot.line { { -half, -half, half, half }, { 0.8, 0, 0, 0.8 }, color = "dark", width = 3 }
  local t, energy, count = { 0 }, { scene:energy().start }, { 0 }
  for _, event in ipairs(scene:events()) do
    for _, now in ipairs { event.energy_before, event.energy_after } do
      t[#t + 1], energy[#energy + 1], count[#count + 1] = event.t, now, count[#count] + (now == event.energy_after and 1 or 0)
    end
  end
  return plot.figure {
    title = "Balls that fall into a box",
    size = { 1300, 640 },
    plot.panel(front),
    plot.panel { title = "energy of all, step by step", xlabel = "time, s", ylabel = "J", legend = "none", box = { 0.6, 0.58, 0.97, 0.85 },
      plot.line { t, energy, color = "blue", width = 2 } },
    plot.panel { title = "events", xlabel = "time, s", legend = "none", box = { 0.6, 0.12, 0.97, 0.39 },
      plot.line { t, count, color = "orange", width = 2 } },
  }
end

return impact.scene {
  name = "balls_in_a_box",
  duration = 0.5,
  output_rate = 24,
  rules = { friction = "minimum", restitution = "minimum" },
  bodies = bodies,
  plot = draw,
}
