-- SPDX-License-Identifier: MIT
--- Shapes with faces from a script: their values, their mistakes in words, gaps and patches.
local impact = require "impact"
local check = require "check"

local function refused(wanted, make, values)
  local good, message = pcall(make, values)
  check.truth(not good and message:find(wanted, 1, true), wanted .. ": " .. tostring(message))
end

local die = impact.box { a = 1, b = 2, c = 3, rounding = .25 }
check.truth(die.kind == "box" and die.rounding == .25 and tostring(die) == "box(1, 2, 3)", "a box tells what it is")
check.truth(impact.shape.box == impact.box and impact.shape.polyhedron == impact.polyhedron, "both names")
refused("box: rounding = 1 is not below every half side", impact.box, { a = 1, b = 2, c = 3, rounding = 1 })
refused("rounding = -1 is negative", impact.cylinder, { radius = 1, half_height = 1, rounding = -1 })
refused("cone: height is missing", impact.cone, { radius = 1 })
refused("unknown key 'height' in capsule", impact.capsule, { radius = 1, height = 1 })
refused("3 points are fewer than 4", impact.polyhedron, { vertices = { { 1, 1, 1 }, { 0, 0, 0 }, { 1, 0, 0 } } })
refused("vertices[2]", impact.polyhedron, { vertices = { { 1, 1, 1 }, { 0, 0 / 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } } })
refused("polyhedron 'p': its 5 vertices lie in a plane", impact.polyhedron,
  { name = "p", vertices = { { 1, 0, 0 }, { 0, 1, 0 }, { -1, 0, 0 }, { 0, -1, 0 }, { 0, 0, 0 } } })

local tetrahedron = impact.polyhedron { vertices = { { 1, 1, 1 }, { -1, -1, 1 }, { -1, 1, -1 }, { 1, -1, -1 } } }
check.truth(#tetrahedron.vertices == 4 and #tetrahedron.faces == 4 and tetrahedron.dropped == 0, "a tetrahedron")
check.truth(math.abs(tetrahedron.volume - 8 / 3) < 1e-14 and tetrahedron.center.x == 0 and tetrahedron.axes.w == 1, "in place")

collectgarbage() -- the shape keeps its hull
local floor = { shape = impact.plane() }
local body = { shape = impact.polyhedron { vertices = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } } }
collectgarbage()
check.truth(body.shape.center.x == .25 and impact.gap(body, floor).gap < 0, "a corner")

local patch = impact.patch({ shape = impact.box { a = 1, b = 1, c = 1 }, position = { 0, 0, 1 } }, floor)
check.truth(patch.dimension == 2 and #patch.points == 4 and patch.points[1].feature1 == "vertex", "a box on the floor")
patch = impact.patch({ shape = impact.cylinder { radius = 1, half_height = 2 }, position = { 0, 0, 2 } }, floor)
check.truth(patch.disc == 1 and #patch.points == 16, "a disc")
check.truth(select(2, impact.patch(floor, floor)):find "two planes", "no patch of planes")


-- What a scene flies, and what a record shows, outlives the script's own shapes.
local definition = impact.body { name = "b", shape = body.shape, omega = { 1, 2, 3 } }
local scene = impact.scene { bodies = { definition }, duration = 1 }
definition.shape, body, tetrahedron = impact.sphere(1), nil, nil
collectgarbage()
scene:run { record = true }
local seen = scene:record():bodies()[1].shape
scene = nil
collectgarbage()
check.truth(seen.kind == "polyhedron" and #seen.vertices == 4 and #seen.faces == 4, "a shape of a record")

check.report "faces"
