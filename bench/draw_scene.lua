-- SPDX-License-Identifier: MIT
--- Draws scene.csv, what bench_scene prints: error against run time of whole scenes, by method of motion. `./run bench scene` draws it.
local csv = require "quat.csv"
local plot = require "quat.plot"

local file = assert(io.open "scene.csv")
local rows = csv.rows(file:read "a")
file:close()

local scenes = {
  { "orbit", "two spheres about each other, one turn" }, { "sphere_wall", "the thesis' sphere, floor and wall" },
  { "two_spheres", "the thesis' two spheres over a floor" }, { "ellipsoid_in_wind", "an ellipsoid bounces in a wind" },
}
local motions = { { "default", "blue", "default, by tolerance" }, { "cvode", "green", "all by CVODE, by tolerance" }, { "rk4", "dark", "fixed steps of RK4, by step" } }
local figure = {
  title = "Whole scenes: error against run time, by method of motion",
  subtitle = "worst error of places and velocities over the run, relative to the largest, against 40 digits; median time of making and running the scene",
  size = { 1300, 1020 }, grid = { 2, 2 },
}
for number, scene in ipairs(scenes) do
  local panel = {
    title = scene[2], xlabel = "time of the run, ms", ylabel = "relative error", xlog = true, ylog = true,
    xrange = { 0.1, 300 }, yrange = { 1e-16, 1 }, legend = number == 1 and "top right" or "none",
  }
  for _, motion in ipairs(motions) do
    local x, y = {}, {}
    for _, row in ipairs(rows) do
      if row.scene == scene[1] and row.motion == motion[1] and type(row.error) == "number" and row.error == row.error then
        x[#x + 1], y[#y + 1] = row.us / 1000, row.error
      end
    end
    panel[#panel + 1] = plot.line { x, y, color = motion[2], width = 1.4 }
    panel[#panel + 1] = plot.points { x, y, color = motion[2], label = motion[3], size = 1.1 }
  end
  figure[#figure + 1] = plot.panel(panel)
end
local drawn, why = plot.save(plot.figure(figure), "scene")
if not drawn then print("scene: " .. why) end
