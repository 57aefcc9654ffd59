-- SPDX-License-Identifier: MIT
--- The thesis' sphere, floor and wall, with a spin: figure 14 as a space curve.
---
--- Everything is as in sphere_wall.lua, but the sphere starts with 10 rad/s about an axis in the x-z plane, tilted by 37 degrees from
--- the vertical. Its spin about x makes the first bounce throw it aside, along y; from then on neither the motion nor the
--- orientation is planar, and (q1, q2, q3) is a curve in space with a kink at every bounce and at the wall.
---
---   free       q' = (0, w) q / 2 with the angular velocity w in the world; a sphere's w keeps its direction between contacts
---   damping    w' = k_w w, k_w = log(1 - 0.848)
---   contact    the slip is s = (v_x - r w_y, v_y + r w_x); friction points against it, in the direction of -s
local impact = require "impact"
local portrait = require "impact.portrait"

return impact.scene {
  name = "sphere_wall_spin",
  gravity = { 0, 0, -9.81 },
  duration = 3.75, -- 90 frames
  output_rate = 24,
  rules = { friction = "product", restitution = "product" },
  bodies = {
    impact.body {
      name = "floor",
      shape = impact.plane { width = 8, depth = 8 },
      friction = 0.25,
      restitution = 1,
    },
    impact.body {
      name = "wall",
      shape = impact.plane { width = 3, depth = 3 },
      normal = { -1, 0, 0 },
      friction = 0.25,
      restitution = 0.3,
    },
    impact.body {
      name = "sphere",
      shape = impact.sphere(0.3),
      mass = 4,
      position = { -3, 0, 1 },
      omega = { 6, 0, 8 }, -- about an axis tilted by 37 degrees from the vertical
      friction = 0.25,
      restitution = 0.3,
      linear_damping = 0.04,
      angular_damping = 0.848,
    },
  },
  forces = {
    impact.wind { origin = { -3, 0, 1 }, direction = { 1, 0, 0 }, strength = 25, reach = 2 },
  },
  plot = function(scene) return portrait.space(scene, "sphere", "wall", "A spinning sphere meets floor and wall") end,
}
