-- SPDX-License-Identifier: MIT
--- The thesis' sphere, floor and wall (figures 14 and 15).
---
--- A sphere of radius r = 0.3 m and mass m = 4 kg starts at rest, its centre 1 m above the floor. A wind of F = 25 N blows along +x
--- as long as the sphere is within 2 m of its start, measured along the wind. The sphere falls, and bounces with friction, which
--- begins its spin; by x = -1.59 the bounces have died out, and it slides along the floor, turning ever faster, until it meets the
--- wall at x = -r. The wall sends it back with a small hop; it slides, and from t = 1.30 s it rolls.
---
---   damping    a damping d takes the part d of a velocity each second: x' = ... + k x with k = log(1 - d),
---              d = 0.04 for the motion (k), 0.848 for the spin (k_w)
---   falling    m x'' = F + m k x',  m z'' = -m g + m k z'
---   bounce     Coulomb friction through compression and restitution; restitution 0.3 x 1, friction 0.25 x 0.25: the pair's
---              coefficients are the product of the bodies'
---   sliding    m v' = F - mu m g + m k v,  (2/5) m r w' = mu m g + (2/5) m r k_w w      (rolling in this wind would need a friction
---              of (2/7) F = 7.1 N; the floor gives at most mu m g = 2.5 N)
---   rolling    v = w r,  (7/5) m v' = m k v + (2/5) m k_w v
---   wall       restitution 0.3 x 0.3, friction 0.25 x 0.25; the floor answers in the same instant
---
--- The motion is planar: q = (q0, 0, q2, 0) stays on a circle of S3, out to the wall and back. The thesis' own figure 14 shows a
--- space curve; sphere_wall_spin.lua has one. sphere_wall_rolling.lua has grip enough to roll to the wall.
local impact = require "impact"
local portrait = require "impact.portrait"

return impact.scene {
  name = "sphere_wall",
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
      friction = 0.25,
      restitution = 0.3,
      linear_damping = 0.04,
      angular_damping = 0.848,
    },
  },
  forces = {
    impact.wind { origin = { -3, 0, 1 }, direction = { 1, 0, 0 }, strength = 25, reach = 2 },
  },
  plot = function(scene) return portrait.planar(scene, "sphere", "wall", "A sphere meets floor and wall") end,
}
