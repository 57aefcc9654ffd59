-- SPDX-License-Identifier: MIT
-- What meets an edge is struck along the edge's own normal, and what lands on a face at where it touches: both by closed forms, in scenes turned
-- at will.
local check = require "check"
local impact = require "impact"
local quat = require "quat"

math.randomseed(20261123)
local function turn()
  local q
  repeat q = { math.random() * 2 - 1, math.random() * 2 - 1, math.random() * 2 - 1, math.random() * 2 - 1 }
  until q[1] ^ 2 + q[2] ^ 2 + q[3] ^ 2 + q[4] ^ 2 < 1
  return quat.normalize(q)
end

-- A ball without friction flies at the edge x = 1, z = 0 of a box or a hull like it: v' = v - (1 + e)(v . n) n. Its middle is less than a radius
-- over the face that it goes to, so that its foot, or one a step ahead, lies on that face's own ground.
local r, e = 0.5, 0.5
local hull = {}
for x = -1, 1, 2 do for y = -2, 2, 4 do for z = -0.5, 0.5 do hull[#hull + 1] = { x, y, z } end end end
local curbs = { impact.box { a = 1, b = 2, c = 0.5 }, impact.polyhedron { vertices = hull } }
for _, law in ipairs { "poisson", "newton" } do
  for k = 1, 40 do
    local q, z, vz = k % 4 == 0 and quat.normalize { 1, 0, 0, 0 } or turn(), 0.02 + 0.46 * math.random(), 0
    if k % 5 > 0 then vz = math.random() * (k % 2 == 0 and 0.3 or -1) end
    -- |(2 t - 1, z + vz t)| = r
    local a, b, c = 4 + vz * vz, -4 + 2 * z * vz, 1 + z * z - r * r
    local t = (-b - math.sqrt(b * b - 4 * a * c)) / (2 * a)
    local n = { (2 * t - 1) / r, 0, (z + vz * t) / r }
    if n[3] > 0.02 then
      local scene = impact.scene { name = "edge", duration = t + 0.01, gravity = { 0, 0, 0 }, law = law, bodies = {
        impact.body { name = "curb", static = true, shape = curbs[1 + k % 2], orientation = q, position = q:rotate { 2, 0, -0.5 }, friction = 0, restitution = 1 },
        impact.body { name = "ball", shape = impact.sphere(r), mass = 1, position = q:rotate { 0, 0, z }, velocity = q:rotate { 2, 0, vz }, friction = 0, restitution = e } } }
      assert(scene:run { record = true })
      local events, un = scene:events(), 2 * n[1] + vz * n[3]
      check.equal(#events, 1)
      check.close(events[1].t, t, 1e-12)
      local v, wanted = q:conj():rotate(scene:state("ball").velocity), { 2 - (1 + e) * un * n[1], 0, vz - (1 + e) * un * n[3] }
      check.close(v.x, wanted[1], 1e-11)
      check.close(v.y, wanted[2], 1e-11)
      check.close(v.z, wanted[3], 1e-11)
    end
  end
end

-- A disc that flies along its axis at a static ball or ellipsoid, its middle aside by x: J = (1 + e) m v/(1 + x^2/I), and so for the base of a cone.
local x = 0.1
for k = 1, 60 do
  local q = turn()
  local shape = k % 2 == 0 and impact.cylinder { radius = 0.3, half_height = 0.05 } or impact.cone { radius = 0.3, height = 0.2 }
  local under = k % 3 == 0 and impact.sphere(0.3) or impact.ellipsoid { a = 0.35, b = 0.2, c = 0.3 }
  local away, back = q:rotate { 0, 0, 1 }, k % 2 == 0 and 1 or -1 -- a cone's base looks along -z
  local side, start = q:rotate { x, 0, 0 }, {}
  for i, axis in ipairs { "x", "y", "z" } do start[i] = -2 * back * away[axis] + side[axis] end
  local scene = impact.scene { name = "disc", duration = 3, gravity = { 0, 0, 0 }, bodies = {
    impact.body { name = "disc", shape = shape, mass = 1, orientation = q, position = start, velocity = q:rotate { 0, 0, 2 * back }, friction = 0, restitution = e },
    impact.body { name = "under", static = true, shape = under, orientation = q, friction = 0, restitution = 1 } } }
  local impulse, place
  scene:run { on_event = function(event)
    if event.event == "impact" and not impulse then impulse, place = event.impulse_n, q:conj():rotate(event.point) end
  end }
  local moment = shape.inertia.y
  check.close(impulse, (1 + e) * 2 / (1 + x * x / moment), 1e-9)
  check.close(place.x, 0, 1e-9)
  check.close(place.y, 0, 1e-9)
end

check.report "faces_edges"
