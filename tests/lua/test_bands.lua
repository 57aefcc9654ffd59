-- SPDX-License-Identifier: MIT
--- Bodies that go through bands of constant force, down to 4e-6 m wide, there and back: a ball in flight, a ball that slides without friction, and a
--- box that slides with it, against the same motion put together band by band from its closed form; of half of the forces nothing tells where they jump.
local impact = require "impact"
local check = require "check"

local G, mass, steps = 9.81, 1, 0

-- The first root of x + v t + a t^2/2 = e after now; infinite: there is none.
local function reaches(x, v, a, e)
  local first = math.huge
  local function take(t)
    if t > 1e-13 and t < first then first = t end
  end
  if a == 0 then
    take((e - x) / v)
    return first
  end
  local square = v * v - 2 * a * (x - e)
  if square < 0 then return first end
  local sum = v + (v >= 0 and 1 or -1) * math.sqrt(square)
  take(-sum / a)
  take(-2 * (x - e) / sum)
  return first
end

local function band(edges, x, ahead)
  local i = 1
  while edges[i] and (x > edges[i] or (x == edges[i] and ahead > 0)) do i = i + 1 end
  return i
end

-- Where a body of mass 1 is after `left` s that friction brakes by `drag` m/s^2.
local function truth(edges, forces, v, drag, left)
  local x, ahead = 0, v
  while left > 0 do
    local force = forces[band(edges, x, ahead)]
    if v == 0 then
      if math.abs(force) <= drag then return x end
      ahead = force
    end
    local i = band(edges, x, ahead)
    local a = forces[i] - (ahead > 0 and drag or -drag)
    local time, to = left, nil
    for _, e in ipairs { edges[i - 1] or -math.huge, edges[i] or math.huge } do
      local t = math.abs(e) < math.huge and not (e == x and (e == edges[i]) == (ahead < 0)) and reaches(x, v, a, e) or math.huge
      if t < time then time, to = t, e end
    end
    local stops = v ~= 0 and -v / a or math.huge
    if stops > 0 and stops < time then
      x, v, left = x + v * stops / 2, 0, left - stops
    else
      x, v, left = to or x + v * time + a * time * time / 2, v + a * time, left - time
      ahead = v
    end
  end
  return x
end

local function uniform(low, high) return low + (high - low) * math.random() end

local function steps_of(edges, forces, told)
  local laws = {}
  for i, e in ipairs(edges) do
    local before, beyond = i == 1 and forces[1] or 0, i == 1 and forces[2] or forces[i + 1] - forces[i]
    laws[i] = impact.force { name = "band " .. i, law = function(_, b) return { b.position.x < e and before or beyond, 0, 0 } end,
      edge = told and function(_, b) return b.position.x - e end or nil }
  end
  return laws
end

math.randomseed(20)
for case = 1, 60 do
  local edges, forces = {}, { uniform(-4, 4) }
  local x = uniform(.05, .35)
  for i = 1, math.random(4) do
    edges[i], forces[i + 1] = x, uniform(-4, 4)
    x = x + .4 * 10 ^ uniform(-5, 0)
  end
  local kind = case % 3
  local mu, speed, duration = kind == 0 and .1 * math.random(0, 2) or 0, uniform(.3, 1.8), uniform(.3, 1.3)
  local bodies = { impact.body { name = "body", shape = kind == 0 and impact.box { a = .05, b = .05, c = .05 } or impact.sphere(.05), mass = mass,
    position = { 0, 0, .05 }, velocity = { speed, 0, 0 }, friction = mu, restitution = 0 } }
  if kind < 2 then bodies[2] = impact.body { name = "floor", shape = impact.plane(), friction = 1, restitution = 0 } end
  local scene = impact.scene { gravity = { 0, 0, kind < 2 and -G or 0 }, duration = duration, bodies = bodies, forces = steps_of(edges, forces, case % 6 < 3) }
  check.truth(scene:run(), "it runs")
  check.close(scene:state("body").position.x, truth(edges, forces, speed, mu * G, duration), 1e-9)
  steps = steps + scene:usage().pile_steps
end
check.equal(steps, 0)

-- A push that jumps at two times, of which nothing tells: a sliding box's steps find them.
for case = 1, 30 do
  local mu, v, x, t = .1, 4, 0, 0
  local first = uniform(.1, .6)
  local jumps, pushes = { first, first + .3 * 10 ^ uniform(-4, 0), 1.3 }, { uniform(-1, 3), uniform(-3, 3), uniform(-1, 3) }
  local law = function(time) return { time < jumps[1] and pushes[1] or time < jumps[2] and pushes[2] or pushes[3], 0, 0 } end
  local scene = impact.scene { gravity = { 0, 0, -G }, duration = jumps[3], forces = { impact.force { name = "push", law = law } }, bodies = {
    impact.body { name = "floor", shape = impact.plane(), friction = 1, restitution = 0 },
    impact.body { name = "box", shape = impact.box { a = .1, b = .1, c = .05 }, mass = mass, position = { 0, 0, .05 }, velocity = { v, 0, 0 }, friction = mu } } }
  check.truth(scene:run(), "it runs")
  for i, jump in ipairs(jumps) do
    local a, time = pushes[i] - mu * G, jump - t
    x, v, t = x + v * time + a * time * time / 2, v + a * time, jump
  end
  check.truth(v > 0, "it never stops")
  check.close(scene:state("box").position.x, x, 1e-9)
end

-- One that begins so while a box stands: its face is asked for how long it does, to a rounding.
for _, start in ipairs { .4, .5, .617 } do
  local mu, push, last = .4, 6, 1.2
  local scene = impact.scene { gravity = { 0, 0, -G }, duration = last, bodies = {
    impact.body { name = "floor", shape = impact.plane(), friction = mu },
    impact.body { name = "box", shape = impact.box { a = .2, b = .2, c = .05 }, mass = 1, position = { 0, 0, .05 }, friction = 1 } },
    forces = { impact.force { law = function(t) return t >= start and { push, 0, 0 } or nil end, body = "box" } } }
  check.equal(scene:run(), "end of time")
  local off = math.abs(scene:state("box").position.x - (push - mu * G) * (last - start) ^ 2 / 2)
  check.equal(scene:usage().pile_steps, 0)
  check.close(off, 0, 1e-12)
end
