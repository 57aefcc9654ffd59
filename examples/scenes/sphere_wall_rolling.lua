-- SPDX-License-Identifier: MIT
--- The sphere, floor and wall of sphere_wall.lua with a grip of 0.5 at both contacts, so that it rolls to the wall.
---
--- With the product of the bodies' frictions, 0.0625, the floor cannot turn a sphere in this wind: rolling needs
---
---   friction >= (2/7) F/(m g) = 0.18   without damping, and 0.32 with this scene's damping of the spin,
---
--- so that sphere_wall.lua slides to the wall. With 0.5 it rolls from t = 0.7005 s on, where the bounces have died out:
---
---   rolling    v = w r,  (7/5) m v' = F - m (k + (2/5) k_w) v,   k = -log(1 - 0.04), k_w = -log(1 - 0.848)
---
--- until the wind ends 2 m from its start, then without F; it meets the wall rolling. There friction throws it up; it comes back
--- bouncing, and rolls slowly away.
local impact = require "impact"
local portrait = require "impact.portrait"

return impact.scene {
  name = "sphere_wall_rolling",
  gravity = { 0, 0, -9.81 },
  duration = 3.75,
  output_rate = 24,
  rules = { friction = "product", restitution = "product" },
  pairs = {
    { bodies = { "sphere", "floor" }, friction = 0.5 },
    { bodies = { "sphere", "wall" }, friction = 0.5 },
  },
  bodies = {
    impact.body { name = "floor", shape = impact.plane { width = 8, depth = 8 }, restitution = 1 },
    impact.body { name = "wall", shape = impact.plane { width = 3, depth = 3 }, normal = { -1, 0, 0 }, restitution = 0.3 },
    impact.body {
      name = "sphere",
      shape = impact.sphere(0.3),
      mass = 4,
      position = { -3, 0, 1 },
      restitution = 0.3,
      linear_damping = 0.04,
      angular_damping = 0.848,
    },
  },
  forces = {
    impact.wind { origin = { -3, 0, 1 }, direction = { 1, 0, 0 }, strength = 25, reach = 2 },
  },
  plot = function(scene) return portrait.planar(scene, "sphere", "wall", "A sphere rolls to a wall and back") end,
}
