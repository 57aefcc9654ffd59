-- SPDX-License-Identifier: MIT
-- Painleve's rod where others hold what it slides on: a slender ellipsoid leans on top of a ball that lies on the ground, and its lower
-- end slides towards its lean. What the ball answers to an impulse at its top, held by the ground, adds to the end's own K
--
--   K_zz = 1 + r_x^2/J,   K_xz = -r_x r_z/J,   K_xx = 1 + r_z^2/J + k
--
-- where k = 1/M + R^2/I on smooth ground, and of a ball that rolls 4/(M + I/R^2): its middle goes half as far as its top. Then the rod's
-- closed form holds (docs/model.md): a = -(K_zz + mu K_xz) > 0 jams. So fast that the ball's curve leads it away from there,
-- speed^2/(R + the end's radius) > g, it is lifted.
local check = require "check"
local impact = require "impact"

local lean, half, width, radius = 0.9, 1, 0.02, 0.25
local s, c = math.sin(lean), math.cos(lean)
local height = math.sqrt(half ^ 2 * s ^ 2 + width ^ 2 * c ^ 2)
local rx, rz, J = -(half ^ 2 - width ^ 2) * s * c / height, -height, (half ^ 2 + width ^ 2) / 5

--- order: which body is defined first.
local function rod_on_ball(values)
  local ground = impact.body { name = "ground", shape = impact.plane() }
  local ball = impact.body { name = "ball", shape = impact.sphere { radius = radius }, mass = values.mass, position = { rx, 0, radius } }
  local rod = impact.body {
    name = "rod",
    shape = impact.ellipsoid { a = half, b = width, c = width },
    mass = 1,
    position = { 0, 0, 2 * radius + height },
    orientation = { math.cos(lean / 2), 0, -math.sin(lean / 2), 0 },
    velocity = { -values.speed, 0, 0 },
  }
  return impact.scene {
    name = "rod_on_ball",
    duration = 0.01,
    output_rate = 100,
    law = values.law,
    bodies = values.order == 1 and { ground, ball, rod } or { rod, ground, ball },
    pairs = {
      { bodies = { "rod", "ball" }, friction = values.mu, restitution = values.eps },
      { bodies = { "ball", "ground" }, friction = values.rolls and 10 or 0, restitution = 0 },
      { bodies = { "rod", "ground" }, friction = values.mu, restitution = values.eps },
    },
  }
end

local jammed, slid = 0, 0
for _, law in ipairs { "poisson", "newton" } do
  for _, mass in ipairs { 0.2, 1, 30 } do
    for order = 1, 2 do
      for _, rolls in ipairs { false, true } do
        for k = 1, 6 do
          local mu, eps = 0.6 * k, 0.15 * (k - 1)
          local I = 0.4 * mass * radius ^ 2
          local gives = rolls and 4 / (mass + I / radius ^ 2) or 1 / mass + radius ^ 2 / I
          local zz, xz, xx = 1 + rx * rx / J, -rx * rz / J, 1 + rz * rz / J + gives
          local a = -(zz + mu * xz)
          local scene = rod_on_ball { law = law, mass = mass, order = order, rolls = rolls, mu = mu, eps = eps, speed = 0.5 }
          scene:run { record = true }
          local struck = {}
          for _, event in ipairs(scene:events()) do
            if event.event == "impact" and event.t == 0 then struck[#struck + 1] = event end
          end
          if a < 0 then
            slid = slid + 1
            check.equal(#struck, 0)
          else
            jammed = jammed + 1
            local p1 = 0.5 / (mu * xx + xz)
            local p = (1 + (law == "newton" and 0 or eps)) * p1 * -- Newton's restitution is of the approach, and there is none
              (1 + a / (zz - xz ^ 2 / xx))
            check.equal(#struck, 2)
            for _, event in ipairs(struck) do
              check.equal(event.encounter, 1)
              check.close(event.impulse_n, p, 1e-12 * p)
              check.equal(event.phases, (event.body1 == "rod" or event.body2 == "rod") and "tangential" or "moreau")
            end
          end
          -- lifted it leaves, of three solutions that it has
          local lifted = rod_on_ball { law = law, mass = mass, order = order, rolls = rolls, mu = mu, eps = eps, speed = 3 }
          lifted:run { record = true }
          check.equal(lifted:usage().encounters, 0)
          check.equal(lifted:usage().lifts_chosen, a > 0 and 1 or 0)
        end
      end
    end
  end
end
check.equal(jammed > 50 and slid > 20, true)

-- Springs: the limit of a little approach, with the ratios that the scene has.
for k = 3, 6 do
  local scene = rod_on_ball { law = "stronge", mass = 1, order = 1, rolls = true, mu = 0.6 * k, eps = 0.3, speed = 0.5 }
  scene:run { record = true }
  local first = scene:events()[1]
  check.equal(first.event, "impact")
  check.equal(first.encounter, 1)
  check.truth(first.phases:find "^tangential" or scene:events()[2].phases:find "^tangential", first.phases)
end
check.report "drawn"
