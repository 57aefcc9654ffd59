-- SPDX-License-Identifier: MIT
--- Boxes set on each other as far out as they stand, by 1/2, 1/4, 1/6 ... of a length less a thousandth. They are at rest at once, which is
--- proved, not awaited: the reactions at the points where they touch balance every weight. The picture shows these, and where each
--- one's load passes.
local impact = require "impact"
local plot = require "quat.plot"

local count, half = 7, { x = 0.2, z = 0.03 }
local part = impact.arguments { part = 0.999 }.part
local weight = 9.81

local bodies, places = { impact.body { name = "table", shape = impact.plane(), friction = 0.6 } }, {}
local x = 0
for i = count, 1, -1 do -- from the table up
  bodies[#bodies + 1] = impact.body {
    name = "box " .. i,
    shape = impact.box { a = half.x, b = 0.1, c = half.z },
    mass = 1,
    position = { x, 0, half.z * (2 * (count - i) + 1) },
    friction = 0.6,
    restitution = 0,
  }
  places[#places + 1] = { x = x, z = half.z * (2 * (count - i) + 1) }
  if i > 1 then x = x + part * half.x / (i - 1) end
end

local function draw(scene)
  local panel = { xlabel = "x, m", ylabel = "z, m", legend = "none", equal = true, box = { 0.08, 0.12, 0.97, 0.88 },
    plot.line { { -0.3, 0.9 }, { 0, 0 }, color = "black" } }
  for _, place in ipairs(places) do
    local left, right, low, high = place.x - half.x, place.x + half.x, place.z - half.z, place.z + half.z
    panel[#panel + 1] = plot.line { { left, right, right, left, left }, { low, low, high, high, low }, color = "blue", width = 2 }
  end
  -- reactions of the two points that stand behind each other are one arrow; 1 N is 4 mm
  local sums = {}
  for _, held in ipairs(scene:held()) do
    local key = ("%.6f %.6f"):format(held.point.x, held.point.z)
    local sum = sums[key] or { x = held.point.x, z = held.point.z, force = 0 }
    sum.force = sum.force + math.abs(held.force.z)
    sums[key] = sum
  end
  for _, sum in pairs(sums) do
    panel[#panel + 1] = plot.line { { sum.x, sum.x }, { sum.z, sum.z + 0.004 * sum.force }, color = "orange", width = 3 }
    panel[#panel + 1] = plot.points { { sum.x }, { sum.z }, color = "orange", shape = "dot" }
  end
  return plot.figure { title = ("%d boxes, %g of the overhang that stands: at rest at t = %g s"):format(count, part, scene:time()),
    size = { 1000, 500 }, plot.panel(panel) }
end

return impact.scene { name = "stack", gravity = { 0, 0, -weight }, duration = 1, bodies = bodies, plot = draw }
