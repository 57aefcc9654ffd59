-- SPDX-License-Identifier: MIT
--- Static boxes laid flush are one: what goes over their seams goes as on one slab (parts against whole), without friction by uniform motion,
--- whichever way the world is turned; a brick falls through a slot of its own width; what lands beside an edge that it is flush with passes it;
--- a wall that stands on the floor strikes as one that goes on below it: its bottom is hidden, and what leans over its foot meets its side.
local impact = require "impact"
local quat = require "quat"
local check = require "check"

local G = 9.81
math.randomseed(20)
local function draw(low, high) return low + (high - low) * math.random() end

local function turned(q, x, y, z)
  local v = q:rotate(quat.vec3(x, y, z))
  return { v.x, v.y, v.z }
end

--- A floor of n by n tiles about the origin, its top at z = 0, and a body on it, all turned by q.
local function floor_of(n, q, half)
  local tiles, a = {}, half / n
  for i = 1, n do
    for j = 1, n do
      tiles[#tiles + 1] = impact.body { name = "tile " .. i .. " " .. j, static = true, friction = 1, restitution = 1, orientation = q,
        shape = impact.box { a = a, b = a, c = .25 }, position = turned(q, a * (2 * i - 1 - n), a * (2 * j - 1 - n), -.25) }
    end
  end
  return tiles
end

local function go(n, q, body, duration)
  local bodies = floor_of(n, q, 2)
  bodies[#bodies + 1] = impact.body { name = "body", shape = body.shape, mass = 1, orientation = q, friction = body.friction,
    restitution = body.restitution or 0, position = turned(q, table.unpack(body.position)),
    velocity = turned(q, table.unpack(body.velocity)), omega = turned(q, table.unpack(body.omega)) }
  local scene = impact.scene { gravity = turned(q, 0, 0, -G), duration = duration, bodies = bodies, pile_tolerance = 5e-6 }
  check.truth(scene:run(), "it runs")
  check.equal(scene:receipt(), "ok")
  local s, back = scene:state "body", q:conj()
  return back:rotate(s.position), back:rotate(s.velocity), scene:usage().pile_error
end

local shapes = {
  { impact.box { a = .1, b = .1, c = .05 }, .05 },
  { impact.box { a = .1, b = .07, c = .05, rounding = .01 }, .05 },
  { impact.cylinder { radius = .1, half_height = .05 }, .05 },
  { impact.sphere { radius = .1 }, .1, true },
}

for i = 1, 24 do
  local solid = shapes[i % #shapes + 1]
  local q = i <= 8 and quat.new(1, 0, 0, 0) or quat.random()
  local vx, vy = draw(.5, 2.5), i % 3 == 0 and 0 or draw(-.5, .5)
  local spin = i % 2 == 0 and 0 or draw(-4, 4)
  local omega = solid[3] and { -vy / solid[2], vx / solid[2], spin } or { 0, 0, spin }
  local body = { shape = solid[1], position = { -.5, .03, solid[2] }, velocity = { vx, vy, 0 }, omega = omega, friction = 0 }
  local duration = 1 / vx
  local x, v, off = go(2, q, body, duration)
  -- a ball is held on the tile it goes to: without a step; faces on two tiles go by steps, whose error is told
  local most = solid[3] and 1e-13 or 1e-7 + off
  check.close(x.x, .5, most)
  check.close(x.y, .03 + vy * duration, most)
  check.close(x.z, solid[2], 1e-10)
  check.close(v.x, vx, solid[3] and 1e-13 or 1e-6)
  check.close(v.y, vy, solid[3] and 1e-13 or 1e-6)
  if solid[3] then check.equal(off, 0) end
end
for i = 1, 8 do
  local solid = shapes[i % #shapes + 1]
  local vx, vy = draw(1.5, 2.5), draw(-.3, .3)
  local omega = solid[3] and { -vy / solid[2], vx / solid[2], 0 } or { 0, 0, 0 }
  local body = { shape = solid[1], position = { -.3, .03, solid[2] }, velocity = { vx, vy, 0 }, omega = omega, friction = .2 }
  local parts, v, off = go(2, quat.new(1, 0, 0, 0), body, .4)
  local whole, w, own = go(1, quat.new(1, 0, 0, 0), body, .4)
  check.equal(own, 0)
  check.close((parts - whole):norm(), 0, solid[3] and 1e-13 or off)
  check.close((v - w):norm(), 0, solid[3] and 1e-13 or off / .1)
end

-- A brick in a slot of its own width, between walls of flush boxes, falls freely; and so beside a single wall.
for sides = 1, 2 do
  local bodies = {}
  for k = 0, 4 do
    for side = 1, sides do
      bodies[#bodies + 1] = impact.body { name = "wall " .. k .. " " .. side, static = true, friction = 0,
        shape = impact.box { a = .5, b = .5, c = .1 }, position = { side == 1 and -.6 or .6, 0, -.2 * k } }
    end
  end
  bodies[#bodies + 1] = impact.body { name = "brick", shape = impact.box { a = .1, b = .1, c = .05 }, mass = 1, friction = 0,
    restitution = .5, position = { 0, 0, .3 }, velocity = { 0, .3, 0 } }
  local scene = impact.scene { gravity = { 0, 0, -G }, duration = .5, bodies = bodies }
  check.truth(scene:run(), "it falls")
  local s = scene:state "brick"
  check.close(s.position.x, 0, 1e-12)
  check.close(s.position.y, .15, 1e-12)
  check.close(s.position.z, .3 - G * .125, 1e-12)
end

-- What leans away from a wall slides into its foot on the floor: corner first, or with an edge.
local leaning = {
  { impact.polyhedron { vertices = { { .1, .1, 0 }, { -.1, .1, 0 }, { .1, -.1, 0 }, { -.1, -.1, 0 }, { 0, 0, .2 } } }, .05 },
  { impact.polyhedron { vertices = { { .1, .06, 0 }, { -.1, .06, 0 }, { .1, -.06, 0 }, { -.1, -.06, 0 }, { 0, 0, .26 } } }, .065 },
  { impact.cone { radius = .1, height = .2 }, .05 },
}
local function strike(shape, height, bottom, q, yaw, velocity, friction, slab)
  local scene = impact.scene { gravity = turned(q, 0, 0, -G), duration = .08, bodies = {
    impact.body { name = "floor", shape = slab and impact.box { a = 1, b = 1, c = .2 } or impact.plane(), static = true, orientation = q, friction = 1,
      restitution = 1, position = turned(q, 0, 0, slab and -.2 or 0) },
    impact.body { name = "wall", shape = impact.box { a = .05, b = 1, c = .2 }, static = true, orientation = q, friction = 1, restitution = 1,
      position = turned(q, .25, 0, .2 + bottom) },
    impact.body { name = "body", shape = shape, mass = 1, orientation = q * quat.from_axis_angle({ 0, 0, 1 }, yaw), friction = friction, restitution = .5,
      position = turned(q, 0, 0, height), velocity = turned(q, table.unpack(velocity)) } } }
  check.truth(scene:run { record = true }, "it runs")
  local impulses, normal = { floor = quat.vec3(0, 0, 0), wall = quat.vec3(0, 0, 0) }, nil
  for _, event in ipairs(scene:events()) do
    if event.event == "impact" and event.encounter == 1 then
      impulses[event.body2] = impulses[event.body2] + quat.vec3(event.impulse)
      if event.body2 == "wall" then normal = quat.vec3(event.normal) end
    end
  end
  return impulses, normal
end
for i = 1, 48 do
  local solid, slab = leaning[i % #leaning + 1], i % 8 > 3
  local q, yaw = i <= 6 and quat.new(1, 0, 0, 0) or quat.random(), i % 2 == 0 and 0 or draw(-3, 3)
  -- with friction at two contacts of one point the impulses that answer are many
  local velocity, friction = { draw(2, 3), draw(-.3, .3), 0 }, i % 4 < 2 and 0 or draw(.05, .4)
  local stands, normal = strike(solid[1], solid[2], 0, q, yaw, velocity, friction, slab)
  local below, side = strike(solid[1], solid[2], draw(-.15, -.05), q, yaw, velocity, friction, slab)
  check.close((side - q:rotate(quat.vec3(-1, 0, 0))):norm(), 0, 1e-12)
  check.close((normal - side):norm(), 0, 1e-12)
  if friction == 0 then
    check.close((stands.wall - below.wall):norm(), 0, 1e-9)
    check.close((stands.floor - below.floor):norm(), 0, 1e-9)
  end
end
