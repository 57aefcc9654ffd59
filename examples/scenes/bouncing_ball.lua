-- SPDX-License-Identifier: MIT
--- A ball dropped on a floor: each bounce gives back e = 0.8 of the speed, and infinitely many end in a finite time.
---
---   bounce n   at t_n = t_0 (1 + 2 e (1 - e^n)/(1 - e)),  t_0 = sqrt(2 h/g),  n = 0, 1, 2 ...
---   apex       between bounces n and n + 1: h e^(2 (n + 1)) above the floor, at t_n + e^(n + 1) t_0
---   the end    t_0 (1 + e)/(1 - e): from any bounce on, 2 v/(g (1 - e)) with v the speed after it
---
--- Between bounces nothing is integrated: the parabola's own root is the instant of the next. Bounces lower than rest_height, 1e-12 m,
--- are summed up, and the ball rests.
local impact = require "impact"
local plot = require "quat.plot"

local r, h, e, g = 0.1, 1, 0.8, 9.81
local t0 = math.sqrt(2 * h / g)

local function draw(scene)
  local track = scene:track("ball", 500)
  local height, bounces = {}, scene:events()
  for i = 1, #track.t do height[i] = track.z[i] - r end
  local apex, tip, number, off = {}, {}, {}, {}
  for n = 0, 14 do
    apex[n + 1] = t0 * (1 + 2 * e * (1 - e ^ n) / (1 - e)) + e ^ (n + 1) * t0
    tip[n + 1] = h * e ^ (2 * (n + 1))
  end
  local n = 0
  for _, event in ipairs(bounces) do
    if event.event == "impact" and n < 40 then
      number[n + 1] = n
      off[n + 1] = math.abs(event.t - t0 * (1 + 2 * e * (1 - e ^ n) / (1 - e))) + 1e-17
      n = n + 1
    end
  end
  return plot.figure {
    title = "A ball whose bounces have an end",
    size = { 1300, 560 },
    grid = { 2, 1 },
    plot.panel {
      title = "height, and the tops of the closed form", xlabel = "time, s", ylabel = "m", legend = "top center", xrange = { 0, 4.6 },
      plot.line { track.t, height, color = "blue", label = "height" },
      plot.points { apex, tip, color = "red", label = "h e²ⁿ⁺²" },
      plot.mark { x = t0 * (1 + e) / (1 - e), color = "dark", label = "the end", dash = true },
    },
    plot.panel {
      title = "bounce n: its time less the closed form's (1e-17: the same)", xlabel = "n", ylabel = "s", ylog = true, legend = "none",
      yrange = { 1e-17, 1e-9 },
      plot.points { number, off, color = "purple" },
    },
  }
end

return impact.scene {
  name = "bouncing_ball",
  gravity = { 0, 0, -g },
  duration = 5,
  output_rate = 24,
  bodies = {
    impact.body { name = "floor", shape = impact.plane(), friction = 0, restitution = 1 },
    impact.body {
      name = "ball",
      shape = impact.sphere(r),
      mass = 1,
      position = { 0, 0, r + h },
      friction = 0,
      restitution = e,
    },
  },
  plot = draw,
}
