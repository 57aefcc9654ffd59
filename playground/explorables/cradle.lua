-- SPDX-License-Identifier: MIT
--- Newton's cradle: so many balls in, so many out; with restitution below 1 no longer so.
local impact = require "impact"

local n, e, ratio = math.floor((values.n or 2) + 0.5), values.e or 1, values.ratio or 1
local r, count, wall = 0.05, 5, 1.2
local bodies = {}
for i = 1, n + count do
  local flies = i <= n
  bodies[i] = impact.body {
    name = "ball " .. i, shape = impact.sphere(r), mass = i == n + count and ratio or 1, friction = 0, restitution = e,
    position = { flies and -wall + 2.2 * r * i or 2.002 * r * (i - n - 3), 0, 0 }, velocity = { flies and 1 or 0, 0, 0 },
  }
end
local scene = impact.scene { name = "cradle", gravity = { 0, 0, 0 }, duration = 1.6, output_rate = 0, rules = { restitution = "product" }, bodies = bodies }
return {
  title = "Newton's cradle",
  formula = "each pair in turn: v₁' = v₁ − (1+ε) m₂/(m₁+m₂) (v₁−v₂),   v₂' = v₂ + (1+ε) m₁/(m₁+m₂) (v₁−v₂)\nε = 1 and equal masses: v₁' = v₂, v₂' = v₁ – the balls exchange their velocities",
  text = "The momentum is that of the balls that came in, whatever ε is; the energy only where ε = 1.",
  parameters = {
    { name = "n", label = "balls in", low = 1, high = 4, value = n, step = 1 }, { name = "e", label = "restitution of a ball", low = 0.5, high = 1, value = e },
    { name = "ratio", label = "mass of the last ball", low = 0.2, high = 5, value = ratio },
  },
  scene = scene,
  address = "#t=0&yaw=-1.571&pitch=0.35",
  after = function(run)
    local momentum, energy, said = 0, 0, {}
    for i = 1, n + count do
      local v = run:state("ball " .. i).velocity.x
      local m = i == n + count and ratio or 1
      momentum, energy = momentum + m * v, energy + 0.5 * m * v * v
      said[i] = string.format("%.4f", v)
    end
    return string.format("velocities at the end: %s m/s\nmomentum %.15f kg m/s, at first %d\nenergy   %.15f J, at first %.1f", table.concat(said, "  "), momentum, n, energy, n / 2)
  end,
}
