-- SPDX-License-Identifier: MIT
--- quat.curve and quat.surface: functions of the script's as callbacks, their errors, and what comes back.
local check = require "check"
local quat = require "quat"
local pi = math.pi
check.equal(pcall(function() return quat.no_such_module end), false)
check.equal(package.loaded["quat.gsl"], nil) -- not before it is used

-- ---- curves ----

local function helix(t) return { math.cos(t), math.sin(t), t / 2 } end
local made = quat.curve.helix(1, pi, 2)
for derivatives, tolerance in pairs { [0] = 1e-9, [3] = 1e-14 } do
  local curve = quat.curve.new { start = 0, finish = 4 * pi, derivatives = derivatives, at = derivatives == 0 and helix or function(t)
    local c, s = math.cos(t), math.sin(t)
    return { c, s, t / 2 }, { -s, c, 0.5 }, { x = -c, y = -s, z = 0 }, { s, -c, 0 }
  end }
  local point = curve:at(1)
  check.close(point.curvature, 0.8, tolerance)
  check.close(point.torsion, 0.4, tolerance)
  check.close(point.frame:rotation_distance(made:at(1).frame), 0, tolerance)
  check.close(curve:length(), 4 * pi * math.sqrt(1.25), 1e-9)
  check.close(curve:length(2, 1), -math.sqrt(1.25), 1e-9)
  check.close(curve:at_length(math.sqrt(1.25)), 1, 1e-9)
end
local start, finish, closed = made:range()
check.truth(start == 0 and finish == 4 * pi and closed == false, "the helix' range")
local total = quat.curve.trefoil(1):total()
check.truth(total.curvature > 4 * pi, "a knot turns by more than 4 pi")
local frames, report = quat.curve.trefoil(1):frames { n = 501, framing = "closed" }
check.equal(#frames, 501)
check.close(frames[1]:rotation_distance(frames[501]), 0, 1e-13)
check.equal(report.monodromy, frames[1]:dot(frames[501]) < 0 and -1 or 1)
local turned = quat.curve.circle(2):frames { times = { 0, pi / 2 }, first = { 1, 0, 0, 0 } }
check.close(turned[2]:rotate({ 0, 0, 1 }).z, 1, 1e-14)
local bent, why = quat.curve.cubic(1, true):at(0)
check.equal(bent.curvature, 0)
check.equal(type(why), "string")
check.equal(#made:even(5), 5)
check.close(made:derivatives(0, 2)[3].x, -1, 1e-15)

local times, points = {}, {}
for i = 0, 64 do
  local t = i == 64 and 2 * pi or i * pi / 32
  times[i + 1], points[i + 1] = t, { math.cos(t), math.sin(t), 0 }
end
points[65] = points[1]
check.close(quat.curve.samples { times = times, points = points, closed = true }:at(1).curvature, 1, 1e-8)
collectgarbage()

check.equal(package.loaded["quat.gsl"], nil) -- curves do without

-- Errors of the function come through as they are; nil is no value.
local function broken(f) return quat.curve.new { at = f, start = 0, finish = 1 } end
local thrown = {}
local ok, caught = pcall(function() return broken(function() error(thrown) end):length() end)
check.truth(not ok and caught == thrown, "the same error object")
check.equal(broken(function() end):length(), nil)
check.truth(select(2, broken(function() end):at(0.5)) ~= nil, "a message")
check.raises("argument 'result 1 of at' must be a vector {x, y, z} of finite numbers, got the string 'no'",
  function() return broken(function() return "no" end):at(0.5) end)
local calls = 0
pcall(function() return broken(function() calls = calls + 1 error "once" end):total() end)
check.equal(calls, 1)
check.truth(not pcall(coroutine.wrap(function() return broken(coroutine.yield):at(0) end)), "no yield across the library")
check.raises("unknown key 'colsed' in curve (did you mean 'closed'?)", quat.curve.new, { colsed = true })
check.raises("curve: finish must be greater than start, got 0 and 1", quat.curve.new, { at = helix, start = 1, finish = 0 })
check.raises("argument 'r' must be a positive number, got -1", quat.curve.circle, -1)
check.raises("arguments 'p' and 'q' must have no common factor, got 2 and 4", quat.curve.torus_knot, 2, 1, 2, 4)
check.raises("frames: closed frames need a closed curve, and times from its start to its end",
  function() return made:frames { framing = "closed" } end)

-- ---- surfaces ----

local torus = quat.surface.torus(2, 1)
local p = torus:at(0.3, pi)
check.close(p.gauss, -1, 1e-14)
check.close(p.mean, 0, 1e-14)
check.close(p.principal[1], 1, 1e-14)
check.close(torus:total().gauss, 0, 1e-10)
check.truth(package.loaded["quat.gsl"], "loaded when asked for")
check.truth(torus:integrability(1, 2) < 1e-10, "integrability")
local own = quat.surface.new { u0 = -1, u1 = 1, v0 = -1, v1 = 1, at = function(u, v) return { u, v, u * u + v * v } end }
check.close(own:at(0, 0).gauss, 4, 1e-8)
check.close(own:at(0, 0).mean, -2, 1e-8) -- the normal points up, the surface bends towards it
local pole, reason = quat.surface.sphere(1):at(0, pi / 2)
check.equal(pole, nil)
check.equal(type(reason), "string")
ok, caught = pcall(function()
  return quat.surface.new { u0 = 0, u1 = 1, v0 = 0, v1 = 1, at = function() error(thrown) end }:total()
end)
check.truth(not ok and caught == thrown, "the same error object")
check.raises("surface: v0 is missing", quat.surface.new, { at = helix, u0 = 0, u1 = 1 })

-- A patch of a surface as a mesh, and its frames of least length.
local mesh = quat.surface.saddle(1, 2):patch { rows = 9, columns = 7, u0 = -1, u1 = 1 }
check.equal(#mesh.positions, 63)
check.equal(#mesh.triangles, 96)
check.close(mesh.positions[63].x, 1, 0)
check.close(mesh.positions[63].y, 2, 0)
mesh.gauge = "length"
local smooth, energy = quat.surface.choose_frames(mesh)
mesh.gauge = "shortest"
check.truth(#smooth == 63 and energy.energy < select(2, quat.surface.choose_frames(mesh)).energy, "less than the start")
check.equal(quat.surface.sphere(1):patch { rows = 3, columns = 3 }, nil) -- its poles

-- An octant of the sphere, one triangle: least length and its transition to the same frames turned.
local x = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }
local q = {}
for i, n in ipairs(x) do q[i] = assert(quat.from_two_vectors({ 0, 0, 1 }, n)) end
local chosen, said = quat.surface.choose_frames { positions = x, frames = q, triangles = { { 1, 2, 3 } }, gauge = "area" }
check.equal(said.torn, 0)
check.close(chosen[1]:rotation_distance(q[1]), 0, 1e-14)
check.close(chosen[2]:rotate({ 0, 0, 1 }).y, 1, 1e-14)
local quarter = quat.from_axis_angle({ 0, 0, 1 }, pi / 2)
local shifted = {}
for i = 1, 3 do shifted[i] = chosen[i] * quarter end
local turns, angles = quat.surface.transition(shifted, chosen)
check.close(turns, 0, 1e-14)
check.close(angles[2], pi / 2, 1e-14)
check.equal(quat.surface.transition({ chosen[1] }, { chosen[2] }), nil)
do -- half a turn from one point to the next could be either way
  local _, _, reason = quat.surface.transition({ quat.identity(), quat.new(0, 0, 0, 1) }, { quat.identity(), quat.identity() })
  check.equal(reason, "the answer is not unique; one was chosen")
end
check.raises("argument 'triangles[1]' must be three numbers of nodes, 1 ... 3", quat.surface.choose_frames,
  { positions = x, frames = q, triangles = { { 1, 2, 4 } } })

check.report("geometry")
