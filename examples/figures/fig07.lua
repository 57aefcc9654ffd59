-- SPDX-License-Identifier: MIT
--- The thesis' figures 7a, 7b, 8 and 9: a belt twisted by 0, pi, 2 pi and 4 pi, its spinor disc, and its curve in S^3.
---
---   q(t) = (cos angle t/2, 0, sin angle t/2, 0),   t = 0 ... 1 along the belt
---
--- The disc has radius pi. Each turn of the belt's end by pi is an arrow across it; after 2 pi the arrows point back, and 4 pi ends
--- where 0 does. The ring marks the axis that is not turned. The curve starts at 1; only that of 4 pi is closed.
--- fig07.csv holds the ends: the angle in units of pi, q(1), the number of arrows, and where they end.
local quat = require "quat"
local plot = require "quat.plot"
local csv = require "quat.csv"
local portrait = require "impact.portrait"

local pi = math.pi
local rows = {
  { name = "7a   no twist", turns = 0 }, { name = "7b   a twist of π", turns = 1 },
  { name = "8   a twist of 2π", turns = 2 }, { name = "9   a twist of 4π", turns = 4 },
}

local function circle(radius, x)
  local c = { {}, {} }
  for i = 0, 120 do c[1][i + 1], c[2][i + 1] = (x or 0) + radius * math.cos(i * pi / 60), radius * math.sin(i * pi / 60) end
  return c[1], c[2]
end

local top, height = 0.955, 0.235 -- of the figure: each row's share
local function box(row, left, right)
  return { left, top - row * height + 0.012, right, top - (row - 1) * height - 0.034 }
end

local function belt(row, angle)
  local frames, places = {}, {}
  for i = 0, 96 do frames[i + 1], places[i + 1] = quat.belt_twist(angle, i / 96), { 0, i / 12, 0 } end
  local panel = {
    equal = true, legend = "none", frame = false, view = { 66, 74 }, zoom = 4.9, box = box(row, 0.01, 0.45),
    xrange = { -1.1, 1.1 }, yrange = { 0, 8 }, zrange = { -1.1, 1.1 },
  }
  for _, item in ipairs(portrait.ribbon(frames, places,
    { half_width = 0.8, thickness = 0.05, front = "#8fb8de", back = "#f6c28b" })) do
    panel[#panel + 1] = item
  end
  return plot.panel(panel)
end

local function disc(row, name, angle)
  local rim = { circle(pi) }
  local panel = {
    title = row == 1 and "spinor disc of radius π" or nil, equal = true, legend = "none", frame = false,
    xrange = { -2.2 * pi, 2.2 * pi }, yrange = { -1.25 * pi, 1.25 * pi }, box = box(row, 0.45, 0.75),
    plot.line { rim[1], rim[2], fill = true, color = "grey", opacity = 0.25 },
    plot.line { rim[1], rim[2], color = "grey", width = 1.5 },
    plot.line { { -pi, pi }, { 0, 0 }, color = "grey", width = 1 },
    plot.line { { 0, 0 }, { -pi, pi }, color = "grey", width = 1 },
    plot.points { { 0 }, { pi }, color = "red", size = 1.8, shape = "circle" },
  }
  local at, arrows = 0, quat.spinor_arrows(angle)
  for i, length in ipairs(arrows) do
    local y = length < 0 and -0.45 or 0 -- on the way back, a little below
    panel[#panel + 1] = plot.arrows { { at }, { y }, { length }, { 0 }, color = length < 0 and "orange" or "blue", width = 3, head = 0.035 }
    at = at + length
  end
  panel[#panel + 1] = plot.points { { at }, { #arrows > 2 and -0.45 or 0 }, color = "dark", size = 1.3 }
  for n = -1, 1, 2 do
    panel[#panel + 1] = plot.text { n < 0 and "−π" or "π", at = { n * (pi + 0.4), -1.2 }, align = "center", size = 10 }
  end
  if row == 1 then panel[#panel + 1] = plot.text { "ring: the axis not turned", at = { 0.5, pi + 0.25 }, size = 10, color = "red" } end
  panel[#panel + 1] = plot.text { name, at = { -6.6 * pi, 1.05 * pi }, size = 14 }
  return plot.panel(panel)
end

local function curve(row, angle)
  local x, y = {}, {}
  for i = 0, 200 do
    local q = quat.belt_twist(angle, i / 200)
    x[i + 1], y[i + 1] = q.w, q.y
  end
  local all = { circle(1) }
  local closed = quat.belt_twist(angle, 1):near({ 1, 0, 0, 0 }, 1e-9)
  return plot.panel {
    title = row == 1 and "the curve q(t) in S³: (q₀, q₂)" or nil, equal = true, legend = "none",
    xrange = { -1.2, 1.2 }, yrange = { -1.2, 1.2 }, box = box(row, 0.79, 0.97),
    plot.line { all[1], all[2], color = "grey", width = 1 },
    plot.line { x, y, color = "blue", width = 3.5 },
    plot.points { { x[#x] }, { y[#y] }, color = "orange", size = 1.8 },
    plot.points { { 1 }, { 0 }, color = "dark", size = 2.2, shape = "circle" },
    plot.text { closed and "closed" or "open", at = { 0, 0.12 }, align = "center", size = 12, color = closed and "blue" or "orange" },
    plot.text { closed and "q(1) = 1" or angle < 4 and "q(1) = j" or "q(1) = −1", at = { 0, -0.25 }, align = "center", size = 11 },
  }
end

local columns = { {}, {}, {}, {}, {}, {}, {} }
local figure = { title = "The belt trick: only a twist of 4π is none", size = { 1400, 1240 } }
for row, case in ipairs(rows) do
  local angle = case.turns * pi
  local q = quat.belt_twist(angle, 1)
  for i, value in ipairs { case.turns, q.w, q.x, q.y, q.z, #quat.spinor_arrows(angle), quat.spinor_place(angle) } do
    columns[i][row] = value
  end
  figure[#figure + 1] = belt(row, angle)
  figure[#figure + 1] = disc(row, case.name, angle)
  figure[#figure + 1] = curve(row, angle)
end

assert(csv.save("fig07", { "turns", "qw", "qx", "qy", "qz", "arrows", "place" }, columns))
local drawn, why = plot.save(plot.figure(figure), "fig07")
if not drawn then print("fig07: " .. why) end
