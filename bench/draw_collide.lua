-- SPDX-License-Identifier: MIT
--- Draws collide.csv, what bench_collide prints, as a work-precision diagram: the error of the velocities after one impact against the
--- run time of one call, a panel for each class. `./run bench collide` draws it.
local csv = require "quat.csv"
local plot = require "quat.plot"

local file = assert(io.open "collide.csv")
local rows = csv.rows(file:read "a")
file:close()

local classes = {
  { "straight", "spheres and planar impacts: closed form" },
  { "isotropic", "M_tt alike in all directions: closed form" },
  { "slip", "slips throughout, and turns" },
  { "stick", "comes to stick" },
  { "reversal", "stops, and slides on another way" },
  { "jam", "friction drives it on into compression" },
  { "recompression", "compressed a second time" },
}
local solvers = {
  { "closed form", label = "closed form", color = "black", shape = "star" },
  { "series", label = "series", color = "blue", shape = "dot" },
  { "cvode adams", label = "CVODE Adams", color = "green", shape = "square" },
  { "cvode bdf", label = "CVODE BDF", color = "orange", shape = "triangle" },
  { "p_z", label = "over p", color = "red", shape = "cross" },
}
local exact = 1e-17 -- no error at all is drawn here

--- One solver's times, median and worst errors where it answers more than half of the impacts, how many it was given, and how many it
--- failed on in the best of its settings.
local function points_of(class, solver)
  local x, median, worst, given, failed = {}, {}, {}, 0, math.huge
  for _, row in ipairs(rows) do
    if row.class == class and row.solver == solver then
      given, failed = row.impacts, math.min(failed, row.failures)
      if 2 * row.failures < row.impacts and row.parameter ~= "default" then
        x[#x + 1] = row.us_median
        median[#x], worst[#x] = math.max(row.error_median, exact), math.max(row.error_worst, exact)
      end
    end
  end
  return x, median, worst, given, failed
end

local figure = {
  title = "One impact: error against run time",
  subtitle = "error of the velocities against a 128-bit oracle, median (dashed: worst), over the median time of one call; orders 12 to 32, tolerances 1e-4 to 1e-12",
  size = { 1960, 980 }, grid = { 4, 2 },
}
for number, class in ipairs(classes) do
  local panel = {
    title = class[2], xlabel = "time of one impact, µs", ylabel = "relative error", xlog = true, ylog = true,
    xrange = { 0.1, 1e4 }, yrange = { exact, 1 }, legend = number == 1 and "top left" or "none",
  }
  local line = 0
  for _, solver in ipairs(solvers) do
    local x, y, worst, given, failed = points_of(class[1], solver[1])
    if #x > 1 then
      panel[#panel + 1] = plot.line { x, y, color = solver.color, width = 1.6 }
      panel[#panel + 1] = plot.line { x, worst, color = solver.color, width = 1, dash = true }
    end
    if #x > 0 or number == 1 then
      panel[#panel + 1] = plot.points { x, y, color = solver.color, shape = solver.shape, label = solver.label, size = 1.1 }
    end
    if given > 0 and failed > 0 then
      panel[#panel + 1] = plot.text {
        ("%s: %d of %d fail"):format(solver[1] == "p_z" and "over p" or solver[1], failed, given),
        at = { 0.13, 10 ^ (-9 - 1.2 * line) }, color = solver.color, size = 10,
      }
      line = line + 1
    end
  end
  figure[#figure + 1] = plot.panel(panel)
end
local drawn, why = plot.save(plot.figure(figure), "collide")
if not drawn then print("collide: " .. why) end
