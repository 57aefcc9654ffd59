-- SPDX-License-Identifier: MIT
--- The thesis' figure 16: two spheres before they meet, where they meet, and after.
---
--- The scene is that of examples/scenes/two_spheres.lua. fig16.csv holds the states that are drawn.
local impact = require "impact"
local plot = require "quat.plot"
local csv = require "quat.csv"
local portrait = require "impact.portrait"

local function ball(name, x, y)
  return impact.body {
    name = name, shape = impact.sphere(0.3), mass = 4, position = { x, y, 5 }, friction = 0.25, restitution = 0.3,
  }
end

local function wind(body, x, y, way)
  return impact.wind { body = body, origin = { x, y, 5 }, direction = { way, 0, 0 }, strength = 25, reach = 5 }
end

local scene = impact.scene {
  name = "fig16",
  gravity = { 0, 0, -9.81 },
  duration = 1.6,
  bodies = {
    impact.body { name = "floor", shape = impact.plane { width = 20, depth = 20 }, friction = 0.25, restitution = 1 },
    ball("left", -5, 0),
    ball("right", 5, 0.2),
  },
  forces = { wind("left", -5, 0, 1), wind("right", 5, 0.2, -1) },
  pairs = { { bodies = { "left", "right" }, friction = 0.25, restitution = 0.3 } },
}

local columns = { "t", "body", "x", "y", "z", "qw", "qx", "qy", "qz" }
local states = {}
for i = 1, #columns do states[i] = {} end

--- A panel of the scene as it is now, whose states are kept.
local function drawing(title)
  local panel = {
    title = string.format("%s: t = %.3f s", title, scene:time()),
    equal = true, frame = false, shadow = true, legend = "none", view = { 72, 20 }, zoom = 1.7,
    xrange = { -2, 2 }, yrange = { -1.5, 1.5 }, zrange = { 0, 1.8 },
    portrait.sheet(scene:state("floor"), { -2, -1.5 }, { 2, 1.5 }, "grey", 0.6),
  }
  for _, body in ipairs { "left", "right" } do
    local s = scene:state(body)
    local row = { s.t, s.body, s.position.x, s.position.y, s.position.z, s.orientation.w, s.orientation.x, s.orientation.y,
      s.orientation.z }
    for i, value in ipairs(row) do states[i][#states[i] + 1] = value end
    local dark, light = body == "left" and "blue" or "orange", body == "left" and "#bee3f8" or "#feebc8"
    for _, item in ipairs(portrait.ball(s, 0.3, dark, light)) do panel[#panel + 1] = item end
  end
  return plot.panel(panel)
end

scene:run_to(1.1)
local before = drawing("a) before")
scene:run { on_event = function(event) return event.body2 ~= "right" and event.body1 ~= "right" or event.body2 == "floor" end }
local meeting = drawing("b) they meet")
scene:run()
local after = drawing("c) after")

assert(csv.save("fig16", columns, states))
local drawn, why = plot.save(plot.figure { title = "Two spheres", size = { 1500, 400 }, grid = { 3, 1 }, before, meeting, after }, "fig16")
if not drawn then print("fig16: " .. why) end
