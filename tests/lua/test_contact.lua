-- SPDX-License-Identifier: MIT
--- Shapes and gaps from Lua.
local check = require "check"
local impact = require "impact"

local box = impact.shape.superquadric { a = 1, b = 2, c = 3, r = 4, s = 4, t = 4 }
check.equal(box.kind, "superquadric")
check.equal(impact.superquadric { a = 1, b = 1, c = 1 }.r, 2)
check.close(impact.ellipsoid { a = 1, b = 2, c = 3 }.volume, 8 * math.pi, 1e-14)
check.equal(impact.superellipsoid { a = 1, b = 1, c = 1, eps1 = 0.5, eps2 = 0.25 }.t, 4)

local h, point = box:support { 0, 0, 5 }
check.close(h, 15, 1e-14)
check.close(point.z, 3, 1e-15)
check.close(box:inside(box:point(0.3, -0.7)), 1, 1e-14)
check.close(box:normal(0, 0).x, 1, 1e-15)
local k1, k2 = impact.ellipsoid({ a = 1, b = 2, c = 3 }):curvatures { 0, 0, 1 }
check.close(k1, 3, 1e-14)
check.close(k2, 0.75, 1e-14)
local H = impact.ellipsoid({ a = 1, b = 2, c = 3 }):hessian { 0, 0, 7 }
check.close(H[1][1], 1 / 3, 1e-15)
check.close(H[2][2], 4 / 3, 1e-15)
check.close(H[3][3], 0, 1e-15)
local points, normals = box:mesh(12, 6)
check.equal(#points, 84)
check.equal(#normals, 84)

local ball = impact.sphere(1)
local contact = impact.gap({ shape = ball, position = { 0, 0, 5 } }, { shape = box, orientation = { 2, 0, 0, 0 } })
check.close(contact.gap, 1, 1e-15)
local pair = { { shape = ball, position = { 0, 0, 5 } }, { shape = box, orientation = { 2, 0, 0, 0 } } }
check.equal(impact.gap_receipt(pair[1], pair[2], contact).worst < 20, true)
local lower = contact.lower
contact.lower = 0.9
check.equal(impact.gap_receipt(pair[1], pair[2], contact).dual > 1e10, true)
contact.lower = lower
check.close(contact.normal.z, 1, 1e-15)
check.close(contact.point1.z, 4, 1e-15)
check.close(contact.point2.z, 3, 1e-15)
check.equal(contact.path, "newton")
check.equal(contact.status, "ok")

local time, at = impact.toi({ shape = ball, position = { 0, 0, 5 }, velocity = { 0, 0, -2 } }, { shape = box }, 1)
check.close(time, 0.5, 1e-15)
check.close(at.gap, 0, 1e-15)
local none, message = impact.toi({ shape = ball, position = { 0, 0, 5 } }, { shape = box }, 1)
check.equal(none, nil)
check.equal(message, "no contact within the interval")

check.raises("superquadric: exponent r = 0.5 < 1 is not convex", impact.superquadric, { a = 1, b = 1, c = 1, r = 0.5 })
check.raises("superellipsoid: eps1 = 2.5 > 2 is not convex", impact.superellipsoid, { a = 1, b = 1, c = 1, eps1 = 2.5 })
check.raises("unknown key 'eps' in superellipsoid (did you mean 'eps1'?)", impact.superellipsoid, { a = 1, b = 1, c = 1, eps = 1 })
check.raises("unknown key 'rr' in superquadric (did you mean 'r'?)", impact.superquadric, { a = 1, b = 1, c = 1, rr = 4 })
check.raises("unknown key 'x' in superquadric (keys: a, b, c, r, s, t)", impact.superquadric, { a = 1, b = 1, c = 1, x = 4 })
check.raises("superquadric: c is missing", impact.superquadric, { a = 1, b = 1 })
check.raises("argument 'direction' must not be zero", box.support, box, { 0, 0, 0 })
check.raises("first body: orientation is zero", impact.gap, { shape = ball, orientation = { 0, 0, 0, 0 } }, { shape = ball })

local floor = { shape = impact.plane() }
for ask, t_max in pairs { [impact.gap] = false, [impact.toi] = 1 } do
  none, message = ask(floor, floor, t_max or nil)
  check.equal(none, nil)
  check.equal(message, "two planes have no gap: one of the bodies must have another shape")
end

-- A tip on a side that straight lines make up: the normal is the side's, however little they overlap.
do
  local quat = require "quat"
  local tip = impact.superellipsoid { a = 0.1, b = 0.08, c = 0.07, eps1 = 2, eps2 = 0.31 }
  local side = impact.superellipsoid { a = 0.09, b = 0.11, c = 0.12, eps1 = 2, eps2 = 1.17 }
  for k = 0, 9 do
    local place, normal = side:point(0.6 * k - 2.9, 0.3 + 0.06 * k), side:normal(0.6 * k - 2.9, 0.3 + 0.06 * k)
    local turn = quat.from_two_vectors({ 0, 0, 1 }, -normal) * quat.from_rotation_vector { 0.03 * k, 0.1, 0 }
    for _, gap in ipairs { 1e-6, 1e-10, 0, -1e-14, -1e-10 } do
      local met = impact.gap({ shape = tip, position = place + normal * gap - turn:rotate { 0, 0, 0.07 }, orientation = turn }, { shape = side })
      check.close(met.gap, gap, 2e-14)
      check.close((met.normal - normal):norm(), 0, 1e-12)
    end
  end
end

check.report("contact")
