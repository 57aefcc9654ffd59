-- SPDX-License-Identifier: MIT
-- What touches on opposite sides is pressed there by what loads make, and by nothing else: in channels, under lids and in chutes it moves as with
-- a gap of a picometre, by closed forms, however it is listed and turned. And one face on two supports slides by what each of them bears.
local check = require "check"
local impact = require "impact"
local quat = require "quat"

local g = 9.81

local function plane(name, normal, position, friction)
  return impact.body { name = name, shape = impact.plane(), normal = normal, position = position, friction = friction, restitution = 0 }
end

-- A marble in a channel, with spin about all axes.
local r = 0.03
local function marble(gap, spin, reversed)
  local bodies = { plane("floor", { 0, 0, 1 }, { 0, 0, 0 }, 0.2), plane("left", { 0, 1, 0 }, { 0, -r, 0 }, 0.5), plane("right", { 0, -1, 0 }, { 0, r + gap, 0 }, 0.6),
    impact.body { name = "marble", shape = impact.sphere(r), mass = 1, friction = 1, position = { 0, 0, r }, velocity = { 0.1, 0, 0 }, omega = spin } }
  if reversed then bodies = { bodies[4], bodies[3], bodies[2], bodies[1] } end
  local scene = impact.scene { name = "channel", gravity = { 0, 0, -g }, duration = 0.2, bodies = bodies }
  scene:run()
  return scene:state "marble"
end
for _, spin in ipairs { { 5, 10, 0 }, { 5, 10, 5 }, { -5, 3, 2 }, { 0, 0, 5 }, { 10, -10, -5 } } do
  local wanted = marble(1e-12, spin)
  for _, reversed in ipairs { false, true } do
    local s = marble(0, spin, reversed)
    check.close(s.position.x, wanted.position.x, 1e-8)
    check.close(s.velocity.x, wanted.velocity.x, 1e-7)
  end
end

-- Along its axis under a lid: x = v t - mu g t^2/2.
for _, shape in ipairs { impact.capsule { radius = r, half_height = 2 * r }, impact.cylinder { radius = r, half_height = 2 * r } } do
  for _, yaw in ipairs { 0, 0.1, 0.3, 0.7, 2 } do
    local scene = impact.scene { name = "lid", gravity = { 0, 0, -g }, duration = 0.1, bodies = { plane("floor", { 0, 0, 1 }, { 0, 0, 0 }, 0.1),
      plane("lid", { 0, 0, -1 }, { 0, 0, 2 * r }, 0.2), impact.body { name = "slides", shape = shape, mass = 1, friction = 1, position = { 0, 0, r },
        velocity = { math.cos(yaw), math.sin(yaw), 0 }, orientation = quat.from_axis_angle({ 0, 0, 1 }, yaw) * quat.from_axis_angle({ 0, 1, 0 }, math.pi / 2) } } }
    scene:run()
    check.close(scene:state("slides").position:norm(), math.sqrt((0.1 - 0.1 * g * 0.005) ^ 2 + r ^ 2), 1e-9)
  end
end

-- From rest down a chute whose walls nothing presses: by the floor's friction alone, or rolling.
local a, slope, mu = 0.05, 0.7, 0.1
local sliding = g * math.sin(slope) - mu * g * math.cos(slope)
for _, case in ipairs {
  { impact.sphere(a), a, nil, sliding },
  { impact.box { a = 0.1, b = a, c = a }, a, nil, sliding },
  { impact.cylinder { radius = a, half_height = a / 2 }, a / 2, nil, sliding },
  { impact.capsule { radius = a, half_height = 0.1 }, a, quat.from_axis_angle({ 0, 1, 0 }, math.pi / 2), sliding },
  { impact.cylinder { radius = a, half_height = a }, a, quat.from_axis_angle({ 1, 0, 0 }, math.pi / 2), sliding },
} do
  local scene = impact.scene { name = "chute", gravity = { g * math.sin(slope), 0, -g * math.cos(slope) }, duration = 0.3, bodies = { plane("floor", { 0, 0, 1 }, { 0, 0, 0 }, mu),
    plane("left", { 0, 1, 0 }, { 0, -a, 0 }, 0.3), plane("right", { 0, -1, 0 }, { 0, a, 0 }, 0.3),
    impact.body { name = "goes", shape = case[1], mass = 1, friction = 1, restitution = 0, position = { 0, 0, case[2] }, orientation = case[3] } } }
  scene:run()
  check.close(scene:state("goes").position.x, case[4] * 0.045, 2e-5)
end

-- A drawer that one wall is pressed by.
for _, order in ipairs { { 1, 2, 3, 4 }, { 1, 4, 3, 2 }, { 3, 4, 2, 1 } } do
  local all = { plane("floor", { 0, 0, 1 }, { 0, 0, 0 }, 0.047), plane("left", { 0, 1, 0 }, { 0, -a, 0 }, 0.59), plane("right", { 0, -1, 0 }, { 0, a, 0 }, 0.5),
    impact.body { name = "drawer", shape = impact.box { a = 0.045, b = a, c = 0.032 }, mass = 1, friction = 1, restitution = 0, position = { 0, 0, 0.032 }, velocity = { 0.513, 0, 0 } } }
  local bodies = {}
  for i, k in ipairs(order) do bodies[i] = all[k] end
  local scene = impact.scene { name = "drawer", gravity = { -0.52, -1.08, -g }, duration = 0.3, bodies = bodies }
  scene:run()
  local slows = 0.52 + 0.047 * g + 0.59 * 1.08
  check.close(scene:state("drawer").position.x, 0.513 * 0.3 - slows * 0.045, 2e-5)
end

-- What just fits between two walls falls, from rest as well.
for _, shape in ipairs { impact.sphere(a), impact.box { a = a, b = a, c = a }, impact.capsule { radius = a, half_height = a } } do
  local scene = impact.scene { name = "slot", gravity = { 0, 0, -g }, duration = 0.1, bodies = { plane("left", { 0, 1, 0 }, { 0, -a, 0 }, 0.6), plane("right", { 0, -1, 0 }, { 0, a, 0 }, 0.6),
    impact.body { name = "falls", shape = shape, mass = 1, friction = 1 } } }
  check.equal(scene:run(), "end of time")
  check.close(scene:state("falls").position.z, -g * 0.005, 2e-5)
end

do -- where nothing has energy yet roundings of 1e-32 J are none
  local scene = impact.scene { name = "slot", gravity = { 0, 0, -g }, duration = 0.1, bodies = { plane("left", { 0, 1, 0 }, { 0, -0.1, 0 }, 0.6), plane("right", { 0, -1, 0 }, { 0, 0.1, 0 }, 0.6),
    impact.body { name = "falls", shape = impact.capsule { radius = 0.1, half_height = 0.2 }, mass = 1, friction = 1 } } }
  check.equal(scene:run(), "end of time")
end

-- So do two that lie on each other.
do
  local cube = impact.box { a = a, b = a, c = a }
  local scene = impact.scene { name = "two", gravity = { 0, 0, -g }, duration = 0.1, bodies = { plane("left", { 0, 1, 0 }, { 0, -a, 0 }, 0.6), plane("right", { 0, -1, 0 }, { 0, a, 0 }, 0.6),
    impact.body { name = "lower", shape = cube, mass = 1, friction = 1 }, impact.body { name = "upper", shape = cube, mass = 3, friction = 1, position = { 0, 0, 2 * a } } } }
  scene:run()
  check.close(scene:state("lower").position.z, -g * 0.005, 2e-4)
  check.close(scene:state("upper").position.z, 2 * a - g * 0.005, 2e-4)
end

-- A thin box slides from one board onto another that is flush: the same however they are listed, and, pressed linearly, by g (mu1 f1 + mu2 f2), to
-- what points are not a face.
local function onto(reversed)
  local long, m1, m2 = 0.0708, 0.31, 0.08
  local function board(name, x, friction)
    return impact.body { name = name, shape = impact.box { a = 2, b = 2, c = 0.1 }, static = true, position = { x, 0, -0.1 }, friction = friction, restitution = 0 }
  end
  local bodies = { board("one", -2, m1), board("other", 2, m2), impact.body { name = "box", shape = impact.box { a = long, b = 0.05, c = 0.02 * long }, mass = 1, friction = 1,
    restitution = 0, position = { -long - 0.02, 0, 0.02 * long }, velocity = { 0.85, 0, 0 } } }
  if reversed then bodies = { bodies[3], bodies[2], bodies[1] } end
  local scene = impact.scene { name = "onto", gravity = { 0, 0, -g }, duration = 0.5, bodies = bodies, pile_tolerance = 1e-5 }
  scene:run()
  local x, v, h = -long - 0.02, 0.85, 1e-5
  for _ = 1, 50000 do
    local over = math.max(0, math.min(1, (x + long) / (2 * long)))
    v = v - h * g * (m1 * (1 - over) + m2 * over)
    x = x + h * v
  end
  return scene:state("box").position.x, x
end
local x, wanted = onto(false)
check.close(onto(true), x, 1e-5)
check.close(x, wanted, 4e-3)

check.report "between_walls"
