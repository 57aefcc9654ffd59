-- SPDX-License-Identifier: MIT
--- The thesis' second collision (figure 16): two spheres driven together.
---
--- Two equal spheres, r = 0.3 m and m = 4 kg, start at rest 5 m above a floor, at x = -5 and x = 5 m. Each is in a wind of its own
--- towards the other: F = 25 N (600 in the authors' units), as far as 5 m from its start, with the falloff (1 + d/l)^-p that the
--- authors left at p = 0. They fall, bounce once on the floor, which spins them forwards, and meet above it.
---
---   falling    m x'' = +-F,  m z'' = -m g
---   meeting    Coulomb friction through compression and restitution; friction 0.25, as the thesis' text has it, given for the pair;
---              restitution 0.3
---   floor      the product of the bodies' coefficients
---
--- Were the two in one plane, the mirror image of each would be the other, and friction would have nothing to do where they meet:
--- the thesis speaks of different starts and of turns about more than one axis without telling the numbers. Here the second sphere
--- starts 0.2 m aside, in y. Then the meeting is oblique, and friction turns both about z.
local impact = require "impact"
local portrait = require "impact.portrait"

local function ball(name, x, y)
  return impact.body {
    name = name,
    shape = impact.sphere(0.3),
    mass = 4,
    position = { x, y, 5 },
    friction = 0.25,
    restitution = 0.3,
  }
end

local function wind(body, x, y, way)
  return impact.wind {
    name = "towards x = " .. -x,
    body = body,
    origin = { x, y, 5 },
    direction = { way, 0, 0 },
    strength = 25,
    reach = 5,
    falloff_power = 0,
  }
end

return impact.scene {
  name = "two_spheres",
  gravity = { 0, 0, -9.81 },
  duration = 3.75,
  output_rate = 24,
  rules = { friction = "product", restitution = "product" },
  bodies = {
    impact.body {
      name = "floor",
      shape = impact.plane { width = 20, depth = 20 },
      friction = 0.25,
      restitution = 1,
    },
    ball("left", -5, 0),
    ball("right", 5, 0.2),
  },
  forces = { wind("left", -5, 0, 1), wind("right", 5, 0.2, -1) },
  pairs = { { bodies = { "left", "right" }, friction = 0.25, restitution = 0.3 } },
  plot = function(scene) return portrait.pair(scene, "left", "right", "Two spheres meet") end,
}
