-- SPDX-License-Identifier: MIT
-- What is integrated does not hang on the units of its definition: bars that tip over from an edge of theirs, on a plane and on a box, from a metre's size
-- down to a tenth of a millimetre's. Lengths in L, times in sqrt(L), masses in L^3. Nor does what is stepped.
local check = require "check"
local impact = require "impact"
local quat = require "quat"

local function slab(under, L)
  if under == "plane" then return impact.body { name = "floor", shape = impact.plane(), friction = 1, restitution = 1 } end
  return impact.body { name = "floor", shape = impact.box { a = 4 * L, b = 4 * L, c = L }, position = { 0, 0, -L }, static = true,
    friction = 1, restitution = 1 }
end

local function bar_ends(bar, under, friction, L)
  local T, turn = math.sqrt(L), quat.from_axis_angle({ 0, 1, 0 }, bar == "box" and 0.5 or math.pi / 2 - 0.5)
  local shape = bar == "box" and impact.box { a = 0.5 * L, b = 0.1 * L, c = 0.02 * L } or impact.cylinder { radius = 0.1 * L, half_height = 0.5 * L }
  local scene = impact.scene { gravity = { 0, 0, -9.81 }, duration = 0.6 * T, rest_height = 1e-12 * L, rest_speed = 1e-9 * L / T, output_rate = 0,
    bodies = { slab(under, L), impact.body { name = "bar", shape = shape, mass = L ^ 3, orientation = turn, friction = friction, restitution = 0.5,
      position = { 0, 0, (shape:support(turn:rotate_inverse { 0, 0, -1 })) }, velocity = { 0.3 * L / T, 0, 0 }, omega = { 0.1 / T, 0, 0.2 / T } } } }
  check.equal(scene:run(), "end of time")
  local state = scene:state "bar"
  return state.position / L, state.velocity * (T / L)
end

for _, bar in ipairs { "box", "cylinder" } do
  for _, under in ipairs { "plane", "box" } do
    for _, friction in ipairs { 0, 0.2 } do
      local position, velocity = bar_ends(bar, under, friction, 1)
      for digits = 1, 4 do
        local place, speed = bar_ends(bar, under, friction, 10.0 ^ -digits)
        check.close((place - position):norm(), 0, 1e-9)
        check.close((speed - velocity):norm(), 0, 1e-8)
      end
    end
  end
end

-- Two boxes that fall on each other come to rest after the same steps, be they of a millimetre or of a thousand kilometres, and rest is 1e-9 m/s to all.
local function boxes_rest(L)
  local bodies = { impact.body { name = "floor", shape = impact.plane(), friction = 1, restitution = 1 } }
  for i = 1, 2 do
    bodies[i + 1] = impact.body { name = "box " .. i, shape = impact.box { a = L, b = L, c = L }, mass = 1, friction = 0.5, restitution = 0.3,
      position = { 0.3 * L * (i - 1), 0.2 * L * (i - 1), 1.1 * L + 2.1 * L * (i - 1) } }
  end
  local scene = impact.scene { gravity = { 0, 0, -9.81 }, duration = 10 * math.sqrt(L), output_rate = 0, bodies = bodies }
  check.equal(scene:run(), "at rest")
  return scene:time() / math.sqrt(L), scene:usage().pile_steps
end

local rests, steps = boxes_rest(1)
for _, L in ipairs { 1e-3, 1e2, 1e3, 1e6 } do
  local own, taken = boxes_rest(L)
  check.close(own, rests, 1e-6)
  check.equal(taken, steps)
end

check.report "units"
