-- SPDX-License-Identifier: MIT
-- Sharp edges that lie along each other touch along all directions between two faces: what stands so stands, and goes as closed forms have it,
-- however it is numbered.
local check = require "check"
local impact = require "impact"
local quat = require "quat"

local g = 9.81

local function in_order(reversed, bodies)
  if not reversed then return bodies end
  local other = {}
  for i = #bodies, 1, -1 do other[#other + 1] = bodies[i] end
  return other
end

-- y'' = f(y, y') from rest, by Runge and Kutta.
local function grown(f, y, t)
  local n, v = 2000, 0
  local h = t / n
  for _ = 1, n do
    local k1, l1 = v, f(y, v)
    local k2, l2 = v + h / 2 * l1, f(y + h / 2 * k1, v + h / 2 * l1)
    local k3, l3 = v + h / 2 * l2, f(y + h / 2 * k2, v + h / 2 * l2)
    local k4, l4 = v + h * l3, f(y + h * k3, v + h * l3)
    y, v = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), v + h / 6 * (l1 + 2 * l2 + 2 * l3 + l4)
  end
  return y
end

-- Two cards lean on each other, alpha from upright: by their edges they press each other level.
local thick, wide, high, alpha = 0.001, 0.03, 0.045, math.rad(15)

local function cards(reversed, friction, duration, tolerance)
  local bodies = { impact.body { name = "table", shape = impact.plane(), friction = friction } }
  for _, side in ipairs { -1, 1 } do
    bodies[#bodies + 1] = impact.body { name = side < 0 and "left" or "right", shape = impact.box { a = thick, b = wide, c = high }, mass = 0.002,
      friction = 0.4, restitution = 0, orientation = quat.from_axis_angle({ 0, 1, 0 }, -side * alpha),
      position = { side * (math.cos(alpha) * thick + math.sin(alpha) * high), 0, math.sin(alpha) * thick + math.cos(alpha) * high } }
  end
  local scene = impact.scene { name = "cards", gravity = { 0, 0, -g }, duration = duration, pile_tolerance = tolerance, bodies = in_order(reversed, bodies) }
  scene:run()
  return scene
end

-- The table's friction has to bear what each leans with: (high sin - thick cos)/2 over (2 high cos): .13.
for _, reversed in ipairs { false, true } do
  local scene = cards(reversed, 0.4, 1)
  check.equal(scene:time(), 0)
end

-- Without it they slide: each goes (x, z)(a), of which the kinetic energy is m M(a) a'^2/2.
local function faster(a, rate)
  local moment, bend = 4 / 3 * (thick ^ 2 + high ^ 2) - 2 * thick * high * math.sin(2 * a), -4 * thick * high * math.cos(2 * a)
  return (g * (high * math.sin(a) - thick * math.cos(a)) - bend * rate ^ 2 / 2) / moment
end
local a = grown(faster, alpha, 0.1)
for _, reversed in ipairs { false, true } do
  for _, tolerance in ipairs { 1e-3, 1e-4, 1e-5 } do
    local scene = cards(reversed, 0, 0.1, tolerance)
    for name, side in pairs { left = -1, right = 1 } do
      local place = scene:state(name).position
      check.close(place.x, side * (math.cos(a) * thick + math.sin(a) * high), 0.05 * math.sqrt(tolerance) * high)
      check.close(place.z, math.sin(a) * thick + math.cos(a) * high, 0.05 * math.sqrt(tolerance) * high)
    end
  end
end

-- A cube that stands by an edge on the like edge of another tips over it as a pendulum, which friction holds; about an edge d from its middle.
local half, leant = 0.05, 0.9
local d = math.sqrt(2) * half
local lean = grown(function(y) return 3 * g / (4 * d) * math.sin(y) end, leant - math.pi / 4, 0.15)
for _, reversed in ipairs { false, true } do
  local q = quat.from_axis_angle({ 0, 1, 0 }, leant)
  local arm = quat.rotate(q, { half, 0, -half })
  local cube = impact.box { a = half, b = half, c = half }
  local scene = impact.scene { name = "tip", gravity = { 0, 0, -g }, duration = 0.15, bodies = in_order(reversed, {
    impact.body { name = "table", shape = impact.plane() },
    impact.body { name = "low", shape = cube, mass = 1, friction = 0.7, position = { 0, 0, half } },
    impact.body { name = "tips", shape = cube, mass = 1, friction = 0.7, restitution = 0, orientation = q, position = { half - arm.x, 0, 2 * half - arm.z } } }) }
  scene:run()
  local place = scene:state("tips").position
  check.close(place.x, half + d * math.sin(lean), 1e-3)
  check.close(place.z, 2 * half + d * math.cos(lean), 1e-3)
  check.close(scene:state("low").position.x, 0, 1e-4)
end

-- Without friction, on a cube that stays, it slides down over that edge by its bottom, s so far: (s' + half a')' = (s - half) a'^2 + g sin a.
local function sliding(s, angle, slides, turns)
  local lever, c, sine = s - half, math.cos(angle), math.sin(angle)
  local falls = lever * turns ^ 2 + g * sine
  local turning = (g * (lever * c + half * sine) - half * falls - 2 * lever * slides * turns) / (lever ^ 2 + 2 * half ^ 2 / 3)
  return falls - half * turning, turning
end
local s, angle, slides, turns, h = 0, 0.3, 0, 0, 0.05 / 20000
for _ = 1, 20000 do
  local s1, angle1 = sliding(s, angle, slides, turns)
  local s2, angle2 = sliding(s + h / 2 * slides, angle + h / 2 * turns, slides + h / 2 * s1, turns + h / 2 * angle1)
  s, angle = s + h * (slides + h / 2 * s1), angle + h * (turns + h / 2 * angle1)
  slides, turns = slides + h * s2, turns + h * angle2
end
for _, reversed in ipairs { false, true } do
  local q = quat.from_axis_angle({ 0, 1, 0 }, 0.3)
  local arm = quat.rotate(q, { half, 0, -half })
  local cube = impact.box { a = half, b = half, c = half }
  local scene = impact.scene { name = "slide", gravity = { 0, 0, -g }, duration = 0.05, bodies = in_order(reversed, {
    impact.body { name = "low", static = true, shape = cube, friction = 0, position = { 0, 0, half } },
    impact.body { name = "slides", shape = cube, mass = 1, friction = 0, restitution = 0, orientation = q, position = { half - arm.x, 0, 2 * half - arm.z } } }) }
  scene:run()
  local place = scene:state("slides").position
  check.close(place.x, half + (s - half) * math.cos(angle) + half * math.sin(angle), 5e-6)
  check.close(place.z, 2 * half - (s - half) * math.sin(angle) + half * math.cos(angle), 5e-6)
end

-- Of four cubes that stand flush, two on two, the upper ones are struck: they slide over those below, and wedge nothing apart by the edges at which
-- each meets the one across.
for _, reversed in ipairs { false, true } do
  local bodies = { impact.body { name = "floor", shape = impact.plane(), friction = 0.7 },
    impact.body { name = "ball", shape = impact.sphere(0.03), mass = 1, restitution = 0.2, position = { -0.3, 0, 0.16 }, velocity = { 5, 0, 0 } } }
  for i = 0, 1 do
    for k = 0, 1 do
      bodies[#bodies + 1] = impact.body { name = ("cube %d %d"):format(i, k), shape = impact.box { a = half, b = half, c = half }, mass = 1, friction = 0.7,
        restitution = 0.2, position = { (2 * i - 1) * half, 0, (2 * k + 1) * half } }
    end
  end
  local scene = impact.scene { name = "wall", gravity = { 0, 0, -g }, duration = 0.1, bodies = in_order(reversed, bodies), pile_tolerance = 1e-5 }
  scene:run()
  check.truth(scene:usage().pile_steps < 500, "faces that are nearly flush are no edges on each other") -- 840 as such
  for i = 0, 1 do check.close(scene:state(("cube %d 0"):format(i)).position.x, (2 * i - 1) * half, 1e-4) end
  check.truth(scene:state("cube 1 1").position.x > 0.1, "the upper cubes are struck")
end

check.report "faces_edge_on_edge"
