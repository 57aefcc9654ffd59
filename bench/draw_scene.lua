-- SPDX-License-Identifier: MIT
--- Draws scene.csv, what bench_scene prints: error against run time of whole scenes over `tolerance`. `./run bench scene` draws it.
local csv = require "quat.csv"
local plot = require "quat.plot"

local file = assert(io.open "scene.csv")
local rows = csv.rows(file:read "a")
file:close()

local scenes = {
  { "orbit", "two spheres, ten turns, eccentricity 0.6: against Kepler's equation" },
  { "sphere_wall", "sphere, floor and wall: against itself at 1e-14" },
  { "two_spheres", "two spheres over a floor: against itself at 1e-14" },
  { "ellipsoid", "an ellipsoid bounces in a wind: against itself at 1e-14" },
}
local figure = {
  title = "Whole scenes: error against run time, by tolerance",
  subtitle = "worst error over 32 times, relative to the largest of the run; the numbers are tolerances; median time of making and running the scene",
  size = { 1300, 1020 }, grid = { 2, 2 },
}
for number, scene in ipairs(scenes) do
  local x, position, velocity, labels = {}, {}, {}, {}
  for _, row in ipairs(rows) do
    if row.scene == scene[1] and type(row.error_position) == "number" then
      local n = #x + 1
      x[n], position[n], velocity[n] = row.us_median / 1000, row.error_position, row.error_velocity
      local text = ("1e%.0f"):format(math.log(row.tolerance, 10))
      labels[n] = plot.text { text, at = { x[n] / 1.07, position[n] / 1.3 }, size = 9, color = "dark", align = "right" }
    end
  end
  local panel = {
    title = scene[2], xlabel = "time of the run, ms", ylabel = "relative error", xlog = true, ylog = true,
    xrange = { 0.1, 100 }, yrange = { 1e-15, 1e-2 }, legend = number == 1 and "bottom left" or "none",
    plot.line { x, position, color = "blue", width = 1.6 },
    plot.points { x, position, color = "blue", label = "position", size = 1.1 },
    plot.line { x, velocity, color = "orange", width = 1.2, dash = true },
    plot.points { x, velocity, color = "orange", shape = "square", label = "velocity", size = 0.9 },
  }
  for _, label in ipairs(labels) do panel[#panel + 1] = label end
  figure[#figure + 1] = plot.panel(panel)
end
local drawn, why = plot.save(plot.figure(figure), "scene")
if not drawn then print("scene: " .. why) end
