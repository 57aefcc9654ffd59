-- SPDX-License-Identifier: MIT
--- The sliding flow: how the tangential velocity (u_x, u_y) of two bodies in contact moves during an impact, for a few inverse masses
---
---   M = [[a, 0, c], [0, b, d], [c, d, m]],   du_t / dp = M_tz - mu M_tt u_t / |u_t|.
---
--- Each curve starts on the unit circle and runs towards u_t = 0, where friction holds it or, when |M_tt^-1 M_tz| > mu, lets it slide on
--- in one direction. Straight lines are the directions that do not turn: full where curves are drawn to them, dashed where they part.
--- hodograph.csv holds every sixteenth point.
local impact = require "impact"
local plot = require "quat.plot"
local csv = require "quat.csv"

local flows = {
  { title = "a = b, c = d = 0: straight to the stop", a = 2, b = 2, c = 0, d = 0, m = 2, mu = 0.5 },
  { title = "a = 4 b: curves gather along the axis of b", a = 4, b = 1, c = 0, d = 0, m = 2, mu = 0.5 },
  { title = "coupled, friction holds: four directions", a = 4, b = 1, c = 0.3, d = 0.12, m = 2, mu = 0.5 },
  { title = "coupled, friction too weak: on in one direction", a = 2.5, b = 1, c = 0.9, d = 0.8, m = 2, mu = 0.4 },
}
local starts, samples = 24, 161
local columns = { flow = {}, start = {}, p = {}, ux = {}, uy = {}, uz = {}, s = {} }
local names = { "flow", "start", "p", "ux", "uy", "uz", "s" }

local function keep(flow, start, curve)
  for i = 1, samples, 16 do
    local n = #columns.p + 1
    columns.flow[n], columns.start[n] = flow, start
    for k = 3, #names do columns[names[k]][n] = curve[names[k]][i] end
  end
end

--- The part of a curve within the picture.
local function visible(curve)
  local x, y = {}, {}
  for i = 1, samples do
    if math.abs(curve.ux[i]) > 1.25 or math.abs(curve.uy[i]) > 1.25 then break end
    x[i], y[i] = curve.ux[i], curve.uy[i]
  end
  return x, y
end

local figure = { title = "The hodograph of sliding during an impact", size = { 1300, 1340 }, grid = { 2, 2 } }
for number, flow in ipairs(flows) do
  local panel = {
    title = flow.title, xlabel = "u_x, m/s", ylabel = "u_y, m/s", equal = true, legend = "none",
    xrange = { -1.25, 1.25 }, yrange = { -1.25, 1.25 },
  }
  local directions
  for start = 1, starts do
    local angle = 2 * math.pi * (start - 0.5) / starts
    local curve = assert(impact.flow {
      a = flow.a, b = flow.b, c = flow.c, d = flow.d, m = flow.m, mu = flow.mu,
      u = { math.cos(angle), math.sin(angle), -1 }, p_end = 4, count = samples,
    })
    directions = curve.directions
    keep(number, start, curve)
    local x, y = visible(curve)
    panel[#panel + 1] = plot.line { x, y, color = "blue", width = 1.2 }
  end
  for _, direction in ipairs(directions) do
    local x, y = 1.2 * math.cos(direction.theta), 1.2 * math.sin(direction.theta)
    panel[#panel + 1] = plot.line { { 0, x }, { 0, y }, color = "red", width = 2, dash = direction.pull > 0 }
  end
  panel[#panel + 1] = plot.points { { 0 }, { 0 }, color = "dark", size = 1.4 }
  figure[#figure + 1] = plot.panel(panel)
end

assert(csv.save("hodograph", names, { columns.flow, columns.start, columns.p, columns.ux, columns.uy, columns.uz, columns.s }))
local drawn, why = plot.save(plot.figure(figure), "hodograph")
if not drawn then print("hodograph: " .. why) end
