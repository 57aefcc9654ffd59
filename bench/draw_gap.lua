-- SPDX-License-Identifier: MIT
--- Draws gap.csv, what bench_gap prints: the error of the gap against the run time of one query, ours and the peers'. `./run bench gap`
--- draws it.
local csv = require "quat.csv"
local plot = require "quat.plot"

local file = assert(io.open "gap.csv")
local rows = csv.rows(file:read "a")
file:close()

local pairs_of = {
  { "ellipsoid", "separated", "ellipsoids apart" },
  { "ellipsoid", "shallow", "ellipsoids that overlap" },
  { "boxy", "shallow", "boxy superquadrics that overlap" },
  { "needle", "shallow", "needles that overlap" },
  { "cylinder", "shallow", "cylinders that overlap" },
  { "mixed", "shallow", "mixed pairs that overlap" },
}
local methods = {
  { "impact cold", label = "ours, from nothing", color = "blue", shape = "dot" },
  { "impact warm", label = "ours, from the last contact", color = "black", shape = "star" },
  { "libccd EPA", label = "libccd EPA, over its tolerance", color = "orange", shape = "triangle" },
  { "libccd MPR", label = "libccd MPR, the same", color = "red", shape = "cross" },
  { "FCL (its GJK)", label = "FCL, its own GJK", color = "green", shape = "square" },
  { "FCL (libccd)", label = "FCL with libccd", color = "purple", shape = "circle" },
}
local exact = 1e-18 -- no error at all is drawn here
local legend_panel = 4 -- has room

local figure = {
  title = "The gap of two bodies: error against run time",
  subtitle = "error over the bodies' size and distance where there is an answer, median and (dashed) 99 %; median time of one query on one core",
  size = { 1500, 980 }, grid = { 3, 2 },
}
for number, kind in ipairs(pairs_of) do
  local panel = {
    title = kind[3], xlabel = "time of one query, µs", ylabel = "relative error", xlog = true, ylog = true,
    xrange = { 0.1, 1e3 }, yrange = { exact, 1 }, legend = number == legend_panel and "center right" or "none",
  }
  for _, method in ipairs(methods) do
    local x, median, most = {}, {}, {}
    for _, row in ipairs(rows) do
      if row.family == kind[1] and row.kind == kind[2] and row.method == method[1] and type(row.gap_p50) == "number" then
        x[#x + 1] = row.time_us
        median[#x], most[#x] = math.max(row.gap_p50, exact), math.max(row.gap_p99, exact)
      end
    end
    if #x > 1 then
      panel[#panel + 1] = plot.line { x, median, color = method.color, width = 1.6 }
      panel[#panel + 1] = plot.line { x, most, color = method.color, width = 1, dash = true }
    end
    if #x > 0 or number == legend_panel then
      panel[#panel + 1] = plot.points { x, median, color = method.color, shape = method.shape, label = method.label, size = 1.2 }
    end
  end
  figure[#figure + 1] = plot.panel(panel)
end
local drawn, why = plot.save(plot.figure(figure), "gap")
if not drawn then print("gap: " .. why) end
