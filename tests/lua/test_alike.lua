-- SPDX-License-Identifier: MIT
-- A body flies at another, of any two kinds: the first impact is the same with the scene turned, with the bodies in the other order, with a target
-- too heavy to move in the place of a static one, and with a hull in the place of a box.
local check = require "check"
local impact = require "impact"
local quat = require "quat"

math.randomseed(27182)
local function draw(a, b) return a + (b - a) * math.random() end
local function turn() return quat.normalize { draw(-1, 1), draw(-1, 1), draw(-1, 1), draw(-1, 1) } end
local function one_of(list) return list[math.random(#list)] end

local shapes = {
  sphere = function(a) return impact.sphere(a) end,
  ellipsoid = function(a, b, c) return impact.ellipsoid { a = a, b = b, c = c } end,
  box = function(a, b, c) return impact.box { a = a, b = b, c = c } end,
  rounded = function(a, b, c) return impact.box { a = a, b = b, c = c, rounding = 0.3 * math.min(a, b, c) } end,
  cylinder = function(a, _, c) return impact.cylinder { radius = a, half_height = c } end,
  cone = function(a, _, c) return impact.cone { radius = a, height = 2 * c } end,
  capsule = function(a, _, c) return impact.capsule { radius = 0.5 * a, half_height = c } end,
  hull = function(a, b, c)
    local vertices = {}
    for x = -1, 1, 2 do for y = -1, 1, 2 do for z = -1, 1, 2 do vertices[#vertices + 1] = { a * x, b * y, c * z } end end end
    return impact.polyhedron { vertices = vertices }
  end,
}
local kinds = { "sphere", "ellipsoid", "box", "rounded", "cylinder", "cone", "capsule", "hull" }

-- The first impact's time and the body's velocities after it, in the axes of the scene that was not turned; nil: there is none.
local function strike(case, changes)
  local whole = changes.turned or quat.identity()
  local target = { name = "target", shape = shapes[changes.target or case.target](table.unpack(case.large)), orientation = whole * case.q2,
    friction = case.friction, restitution = case.restitution, static = not changes.heavy or nil }
  if changes.heavy then target.mass, target.moments = 1e14, { 1e14, 1e14, 1e14 } end
  local body = { name = "body", shape = shapes[changes.body or case.body](table.unpack(case.small)), mass = 1, friction = 1, restitution = 1,
    orientation = whole * case.q1, position = whole:rotate(case.x), velocity = whole:rotate(case.v), omega = whole:rotate(case.w) }
  target, body = impact.body(target), impact.body(body)
  local scene = impact.scene { name = "alike", gravity = { 0, 0, 0 }, duration = 3, law = case.law, bodies = changes.swapped and { body, target } or { target, body } }
  repeat local event = scene:step(3) until not event or event.event == "impact"
  local at, state = scene:time(), scene:state "body"
  return at, whole:conj():rotate(state.velocity), whole:conj():rotate(state.omega)
end

local struck = 0
for _ = 1, 250 do
  local case = { body = one_of(kinds), target = one_of(kinds), law = one_of { "poisson", "newton", "stronge" },
    small = { draw(0.1, 0.3), draw(0.1, 0.3), draw(0.1, 0.3) }, large = { draw(0.2, 0.6), draw(0.2, 0.6), draw(0.2, 0.6) },
    q1 = turn(), q2 = turn(), x = { -2, draw(-0.3, 0.3), draw(-0.6, 0.6) }, v = { draw(1.5, 2.5), draw(-0.1, 0.1), one_of { 0, draw(-0.2, 0.2) } },
    w = one_of { { 0, 0, 0 }, { draw(-3, 3), draw(-3, 3), draw(-3, 3) } }, friction = one_of { 0, draw(0, 1) }, restitution = draw(0, 1) }
  if math.random() < 0.4 then case.q2 = quat.identity() end
  if math.random() < 0.3 then case.q1 = case.q2 end -- faces, edges and corners meet as they are
  local t, v, w = strike(case, {})
  local ways = { { turned = turn() }, { heavy = true }, { swapped = true } }
  if case.body == "box" then ways[#ways + 1] = { body = "hull" } end
  if case.target == "box" then ways[#ways + 1] = { target = "hull" } end
  if t < 3 then struck = struck + 1 end
  for _, way in ipairs(ways) do
    local t2, v2, w2 = strike(case, way)
    local words = string.format("%s at %s, %s", case.body, case.target, next(way))
    check.truth(math.abs(t2 - t) <= 1e-9, words .. ": time")
    check.truth((v2 - v):norm() <= 1e-7 and (w2 - w):norm() <= 1e-6, words .. string.format(": velocities %.3g %.3g", (v2 - v):norm(), (w2 - w):norm()))
  end
end
check.truth(struck > 180, "most meet")
-- In units in which the rest speed, which stays, is below what the integrator tells from none: what slides there sticks all the same.
local function edged(size, rest_speed)
  local angle = 0.10908213584499674
  local scene = impact.scene {
    duration = 0.4, rest_height = 1e-12 * size, rest_speed = rest_speed,
    gravity = { 9.81 * math.sin(angle) * size, 0, -9.81 * math.cos(angle) * size },
    bodies = {
      impact.body { name = "slope", shape = impact.plane(), friction = 0.37966241838083281, restitution = 1 },
      impact.body {
        name = "box", mass = 0.25113699049557753, friction = 1, restitution = 0,
        shape = impact.superellipsoid {
          a = 0.11696051004890061 * size, b = 0.10556600256687683 * size, c = 0.095920812122368748 * size,
          eps1 = 0.042026536407176893, eps2 = 0.014656935939698773,
        },
        position = { 0.076094094596574971 * size, 0.08688919926685601 * size, 0.35 * size },
        orientation = { -0.1541442034679521, 0.18462141949486188, 0.20769571758808514, 0.4114675058417866 },
        velocity = { 0.11621382281081549 * size, 0.3365712481434 * size, -0.83872462307279672 * size },
        omega = { 2.3903743481539594, -1.2596546495629835, -2.9596182855135118 },
      },
    },
  }
  scene:run()
  return scene:state("box").position * (1 / size)
end
for _, size in ipairs { 1, 500, 1000 } do
  for _, rest_speed in ipairs { 1e-9, 1e-13 } do check.close((edged(size, rest_speed) - edged(1, 1e-9)):norm(), 0, 1e-10) end
end

check.report "alike"
