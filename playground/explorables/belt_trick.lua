-- SPDX-License-Identifier: MIT
--- The belt trick by hand: drag s, and a twist of 4 pi goes away, both ends never turned.
local quat = require "quat"
local plot = require "quat.plot"
local portrait = require "impact.portrait"

local s = values.s or 0.3
local count = 80
local frames, places = quat.belt_frames(s, count + 1)
local belt = { title = "the belt: its left end is held, its right one never turns", equal = true, legend = "none", frame = false, view = { 62, 62 }, at = { 1, 1, 1, 2 },
  xrange = { -0.35, 0.65 }, yrange = { -0.28, 1.1 }, zrange = { -0.35, 0.35 } }
for _, item in ipairs(portrait.ribbon(frames, places, { half_width = 0.075, thickness = 0.008, front = "#8fb8de", back = "#f6c28b" })) do
  if item.opacity == nil then item.opacity = 1 end
  belt[#belt + 1] = item
end
for _, i in ipairs { 1, count + 1 } do
  local p, up = places[i], frames[i]:rotate { 0, 0, 0.2 }
  belt[#belt + 1] = plot.arrows { { p.x }, { p.y }, { p.z }, { up.x }, { up.y }, { up.z }, color = "dark" }
end
local t, w, x, y, z, worst = {}, {}, {}, {}, {}, 0
for i = 0, 200 do
  local q = quat.belt_untwist(s, i / 200)
  t[i + 1], w[i + 1], x[i + 1], y[i + 1], z[i + 1] = i / 200, q.w, q.x, q.y, q.z
  worst = math.max(worst, math.acos(math.max(-1, math.min(1, q.w))))
end
return {
  title = "The belt trick",
  formula = "q(s, t) = exp(πt j) exp(πt (cos(πs) j + sin(πs) i))\nq(s, 0) = q(s, 1) = 1 for every s;  q(0, t) = exp(2πt j): a twist of 4π;  q(1, t) = 1: none",
  text = "A loop of rotations by 4π can be drawn together to a point on S³; one by 2π cannot, for it ends at −1. Drag s.",
  parameters = { { name = "s", label = "s, from twisted to not", low = 0, high = 1, value = s } },
  number = string.format("both ends: turned by %.1g rad\nfarthest from 1 on S³: %.9f rad;  π(1 − s) = %.9f", frames[count + 1]:angle(), worst, math.pi * (1 - s)),
  figure = plot.figure { size = { 1400, 800 }, grid = { 2, 2 },
    plot.panel(belt),
    plot.panel { title = "q(t) on S³, as (q₁, q₂, q₃)", equal = true, legend = "none", view = { 66, 32 }, xlabel = "q₁", ylabel = "q₂", zlabel = "q₃",
      xrange = { -1, 1 }, yrange = { -1, 1 }, zrange = { -1, 1 }, plot.line { x, y, z, color = "blue", tube = 0.03 }, plot.points { { 0 }, { 0 }, { 0 }, color = "dark", size = 1.6 } },
    plot.panel { at = { 2, 2 }, title = "q₀ along the belt", xlabel = "t", ylabel = "q₀", legend = "none", xrange = { 0, 1 }, yrange = { -1.1, 1.1 }, plot.line { t, w, color = "blue" }, plot.mark { y = -1, color = "grey" } },
  },
}
