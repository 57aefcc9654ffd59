-- SPDX-License-Identifier: MIT
--- The thesis' figure 15: the sphere, the floor and the wall before, at and after the collision.
---
--- The scene is that of examples/scenes/sphere_wall.lua. fig15.csv holds the three states that are drawn.
local impact = require "impact"
local plot = require "quat.plot"
local csv = require "quat.csv"
local portrait = require "impact.portrait"

local scene = impact.scene {
  name = "fig15",
  gravity = { 0, 0, -9.81 },
  duration = 3.75,
  bodies = {
    impact.body { name = "floor", shape = impact.plane { width = 8, depth = 8 }, friction = 0.25, restitution = 1 },
    impact.body {
      name = "wall", shape = impact.plane { width = 3, depth = 3 }, normal = { -1, 0, 0 }, friction = 0.25, restitution = 0.3,
    },
    impact.body {
      name = "sphere", shape = impact.sphere(0.3), mass = 4, position = { -3, 0, 1 }, friction = 0.25, restitution = 0.3,
      linear_damping = 0.04, angular_damping = 0.848,
    },
  },
  forces = { impact.wind { origin = { -3, 0, 1 }, direction = { 1, 0, 0 }, strength = 25, reach = 2 } },
}

local function drawing(title)
  local panel = {
    title = string.format("%s: t = %.3f s", title, scene:time()),
    equal = true, frame = false, shadow = true, legend = "none", view = { 70, 335 }, zoom = 1.75,
    xrange = { -3.4, 0.6 }, yrange = { -1.5, 1.5 }, zrange = { 0, 1.5 },
    portrait.sheet(scene:state("floor"), { -3.4, -1.5 }, { 0.6, 1.5 }, "grey", 0.6),
    portrait.sheet(scene:state("wall"), { 0, -1.5 }, { 1.5, 1.5 }, "purple", 0.45),
  }
  for _, item in ipairs(portrait.ball(scene:state("sphere"), 0.3, "red", "#fed7d7")) do panel[#panel + 1] = item end
  return plot.panel(panel)
end

local columns = { "t", "x", "y", "z", "qw", "qx", "qy", "qz" }
local states = {}
for i = 1, #columns do states[i] = {} end
local function keep()
  local s = scene:state("sphere")
  local row = { s.t, s.position.x, s.position.y, s.position.z, s.orientation.w, s.orientation.x, s.orientation.y, s.orientation.z }
  for i, value in ipairs(row) do states[i][#states[i] + 1] = value end
end

local start = drawing("a) start")
keep()
-- The run stops at the wall, and goes on from there.
scene:run { on_event = function(event) return not (event.event == "impact" and event.body2 == "wall") end }
local wall = drawing("b) at the wall")
keep()
scene:run()
local finish = drawing("c) the end")
keep()

assert(csv.save("fig15", columns, states))
local drawn, why = plot.save(plot.figure { title = "A sphere, a floor and a wall", size = { 1500, 400 }, grid = { 3, 1 }, start, wall, finish }, "fig15")
if not drawn then print("fig15: " .. why) end
