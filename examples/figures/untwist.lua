-- SPDX-License-Identifier: MIT
--- The belt trick in frames: a twist of 4 pi undone without turning the ends.
---
---   q_s(t) = exp(pi t j) exp(pi t (cos(pi s) j + sin(pi s) i)),   s = 0 (twisted) ... 1 (not), t = 0 ... 1 along the belt
---
--- The belt is nowhere stretched: its centre line is the integral of q y q*. Its left end is held; the right one goes round a loop and
--- never turns, since q_s(1) = 1 for every s. Below, the curves in S^3 as (q1, q2, q3): loops from 1 to 1 that shrink to a point.
--- untwist.csv holds, for each frame, the orientation in the middle, the turn of the free end, and its place; untwist_frames.csv the
--- whole motion, 17 frames along the belt at 17 stages.
local quat = require "quat"
local plot = require "quat.plot"
local csv = require "quat.csv"
local portrait = require "impact.portrait"

local stages = { 0, 0.15, 0.3, 0.4, 0.5, 0.6, 0.75, 1 }
local columns = { {}, {}, {}, {}, {}, {}, {}, {}, {} }
local figure = {
  title = "A twist of 4π undone, its ends never turned", size = { 1500, 1180 },
}

local function belt(n, s)
  local count = 80
  local frames, places = quat.belt_frames(s, count + 1)
  local column, row = (n - 1) % 4, (n - 1) // 4
  local panel = {
    title = string.format("s = %.2f", s), equal = true, legend = "none", frame = false, view = { 62, 62 }, zoom = 3.2,
    xrange = { -0.35, 0.65 }, yrange = { -0.28, 1.1 }, zrange = { -0.35, 0.35 },
    box = { 0.0 + 0.247 * column, 0.66 - 0.29 * row, 0.25 + 0.247 * column, 0.935 - 0.29 * row },
  }
  for _, item in ipairs(portrait.ribbon(frames, places,
    { half_width = 0.075, thickness = 0.008, front = "#8fb8de", back = "#f6c28b" })) do
    panel[#panel + 1] = item
  end
  -- Both ends, as they are held: along the belt, and its normal.
  for _, i in ipairs { 1, count + 1 } do
    local p, up = places[i], frames[i]:rotate { 0, 0, 0.2 }
    panel[#panel + 1] = plot.arrows { { p[1] }, { p[2] }, { p[3] }, { up.x }, { up.y }, { up.z }, color = "dark", width = 2, head = 0.02, front = true }
  end
  local middle, free = frames[count // 2 + 1], places[count + 1]
  for i, value in ipairs { s, middle.w, middle.x, middle.y, middle.z, frames[count + 1]:angle(), free[1], free[2], free[3] } do
    columns[i][n] = value
  end
  return plot.panel(panel)
end

for n, s in ipairs(stages) do figure[n] = belt(n, s) end

--- A colour between blue (s = 0) and orange (s = 1), through grey.
local function shade(s)
  local from, to = { 43, 108, 176 }, { 221, 107, 32 }
  local c = {}
  for i = 1, 3 do c[i] = math.floor(from[i] + s * (to[i] - from[i]) + 0.5) end
  return string.format("#%02x%02x%02x", c[1], c[2], c[3])
end

local curves = {
  title = "the curves q(t), as (q₁, q₂, q₃)", xlabel = "q₁", ylabel = "q₂", zlabel = "q₃", equal = true, legend = "none", view = { 66, 32 },
  zoom = 1.65, box = { 0.02, 0.0, 0.48, 0.36 }, xrange = { -1, 1 }, yrange = { -1, 1 }, zrange = { -1, 0.2 },
}
local scalar = {
  title = "and q₀ along the belt", xlabel = "t", ylabel = "q₀", legend = "none", box = { 0.58, 0.075, 0.96, 0.325 }, xrange = { 0, 1 },
  yrange = { -1.1, 1.3 },
}
for _, s in ipairs { 0, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9 } do
  local t, w, x, y, z = {}, {}, {}, {}, {}
  for i = 0, 200 do
    local q = quat.belt_untwist(s, i / 200)
    t[i + 1], w[i + 1], x[i + 1], y[i + 1], z[i + 1] = i / 200, q.w, q.x, q.y, q.z
  end
  curves[#curves + 1] = plot.line { x, y, z, color = shade(s), width = 2 }
  scalar[#scalar + 1] = plot.line { t, w, color = shade(s), width = 2 }
end
curves[#curves + 1] = plot.points { { 0 }, { 0 }, { 0 }, color = "dark", size = 1.6 }
curves[#curves + 1] = plot.text { "1", at = { 0.06, 0, 0.1 }, size = 12 }
scalar[#scalar + 1] = plot.line { { 0, 1 }, { 1, 1 }, color = shade(1), width = 2 }
scalar[#scalar + 1] = plot.text { "s = 0", at = { 0.5, -0.85 }, align = "center", color = shade(0) }
scalar[#scalar + 1] = plot.text { "s = 1", at = { 0.5, 1.13 }, align = "center", color = shade(1) }
figure[#figure + 1] = plot.panel(curves)
figure[#figure + 1] = plot.panel(scalar)

local motion = { {}, {}, {}, {}, {}, {}, {}, {}, {}, {} }
for stage = 0, 16 do
  local frames, places = quat.belt_frames(stage / 16, 17)
  for i, q in ipairs(frames) do
    local p = places[i]
    for c, value in ipairs { 17 * stage + i, stage / 16, (i - 1) / 16, q.w, q.x, q.y, q.z, p.x, p.y, p.z } do table.insert(motion[c], value) end
  end
end
assert(csv.save("untwist_frames", { "row", "s", "along", "qw", "qx", "qy", "qz", "x", "y", "z" }, motion))
assert(csv.save("untwist", { "s", "qw", "qx", "qy", "qz", "turn", "x", "y", "z" }, columns))
local drawn, why = plot.save(plot.figure(figure), "untwist")
if not drawn then print("untwist: " .. why) end
