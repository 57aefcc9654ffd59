-- SPDX-License-Identifier: MIT
--- Painleve's rod (1895): a slender rod leans, and its lower end slides over rough ground towards the lean. Chalk that is pushed over a
--- board hops so.
---
--- With K the inverse mass of that end (m = 1, r from the centre to the end, J about the rod's middle)
---
---   K_zz = 1 + r_x^2/J,   K_xx = 1 + r_z^2/J,   K_xz = -r_x r_z/J
---
--- a pressure N with its friction mu N against the slip -s accelerates the end by (K_zz + mu K_xz) N = -a N along the normal. From
--- mu = 4/3 on, for a rod of no width, a > 0 is possible: what presses is made more by its own reaction, and no pressure holds the end.
--- What happens is an impact without approach (phase `tangential`): friction stops the slip after p1 = s/(mu K_xx + K_xz), the end being
--- driven into the ground by a p1 meanwhile; then it sticks, and after p2 = a p1/(K_zz - K_xz^2/K_xx) more it has stopped. The rest is
--- eps (p1 + p2), Poisson's.
---
---   impact examples/scenes/painleve_rod.lua -- mu=3.0 eps=0.5
local impact = require "impact"
local arguments = impact.arguments { mu = 2.0, eps = 0.5, lean = 0.9, speed = 3.0 }

local half, width = 1, 0.02 -- an ellipsoid's semi-axes; it stands on its lowest point
local s, c = math.sin(arguments.lean), math.cos(arguments.lean)
local height = math.sqrt(half ^ 2 * s ^ 2 + width ^ 2 * c ^ 2)

return impact.scene {
  name = "painleve_rod",
  duration = 1,
  output_rate = 60,
  bodies = {
    impact.body { name = "ground", shape = impact.plane(), friction = 1, restitution = 1 },
    impact.body {
      name = "rod",
      shape = impact.ellipsoid { a = half, b = width, c = width },
      mass = 1,
      position = { 0, 0, height },
      orientation = { math.cos(arguments.lean / 2), 0, -math.sin(arguments.lean / 2), 0 },
      velocity = { -arguments.speed, 0, 0 },
      friction = arguments.mu,
      restitution = arguments.eps,
    },
  },
}
