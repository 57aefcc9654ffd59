-- SPDX-License-Identifier: MIT
--- What lies on a line about which it is round, capsules and cylinders on their sides: friction all along the line as it spins, slides, rolls and
--- stands, by closed forms, by a sum over places with implicit steps, turned and mirrored, over borders, under forces, saved and loaded.
local impact = require "impact"
local quat = require "quat"
local check = require "check"

local G, R, h, mu = 9.81, .05, .2, .3
local floor = { name = "floor", shape = impact.plane(), friction = 1, restitution = 0 }
local slab = { name = "floor", static = true, shape = impact.box { a = 5, b = 5, c = .5 }, position = { 0, 0, -.5 }, friction = 1, restitution = 0 }
local capsule, cylinder = impact.capsule { radius = R, half_height = h }, impact.cylinder { radius = R, half_height = h }
local rounded = impact.cylinder { radius = R, half_height = h + .01, rounding = .01 } -- its line is as long
local up = { 0, 0, 1 }
local along = quat.from_axis_angle({ 0, 1, 0 }, math.pi / 2) -- its axis to x

--- Its axis along x, turned by `angle`; velocities are given for the angle 0.
local function run(shape, more)
  local turn, slope = quat.from_axis_angle(up, more.angle or 0), more.slope or 0
  local function there(v) return turn:rotate(v or { 0, 0, 0 }) end
  local pull = there { G * math.sin(slope) * (more.down or { 0, 1 })[1], G * math.sin(slope) * (more.down or { 0, 1 })[2], -G * math.cos(slope) }
  local at = there(more.position)
  local scene = impact.scene { gravity = pull, duration = more.duration or 1, forces = more.law and { impact.force { name = "push", body = "rod", steady = more.steady,
    law = more.law, max_step = .02 } } or nil, bodies = { impact.body(more.under or floor), impact.body { name = "rod", shape = shape, mass = 1,
      position = { at.x, at.y, more.radius or R }, orientation = turn * along, velocity = there(more.velocity), omega = there(more.omega), friction = more.friction or mu,
      restitution = 0, linear_damping = more.linear, angular_damping = more.angular } } }
  local seen = {}
  check.truth(scene:run { on_event = function(event) seen[#seen + 1] = event.event end }, "it runs")
  check.truth(more.over or scene:usage().pile_steps == 0, "it is stepped")
  local e = scene:energy()
  check.close(e.start + e.force_work - e.damping_loss - e.sliding_loss - e.impact_loss, e.kinetic + e.potential, 1e-10)
  return scene:state "rod", scene, table.concat(seen, " ")
end

--- How far its axis has turned about the vertical.
local function turned(state)
  local e = state.orientation:rotate { 0, 0, 1 }
  return math.atan(e.y, e.x)
end

-- It spins on the spot for J w/(mu m g h/2), h the half length of its line, on planes and boxes; nothing else moves.
for _, shape in ipairs { capsule, cylinder, rounded } do
  for _, under in ipairs { floor, slab } do
    for _, w in ipairs { 5, -.3, 30 } do
      local state, scene, seen = run(shape, { omega = { 0, 0, w }, under = under, duration = 10 })
      local time = shape.inertia.x * math.abs(w) / (mu * G * h / 2)
      check.close(scene:time(), time, 1e-12)
      check.close(math.sin(turned(state) - w * time / 2), 0, 1e-11)
      check.close(state.position:norm(), R, 1e-14)
      check.equal(seen, "contact contact stick stick rest")
      check.equal(scene:usage().integrators, 0)
    end
  end
end

-- A torque turns it from mu m g h/2 on, with all that is more; so does one on what slides no faster than a thousandth of a millimetre.
for _, shape in ipairs { capsule, cylinder } do
  for _, part in ipairs { .5, 1 - 1e-6, 1 + 1e-4, 1.5, 1.9, 3 } do
    local limit = mu * G * h / 2
    local law = function() return nil, { 0, 0, part * limit } end
    local state, scene = run(shape, { law = law, steady = true, duration = .2 })
    check.close(state.omega.z, math.max(0, part - 1) * limit / shape.inertia.x * .2, 1e-11)
    check.equal(scene:time(), part < 1 and 0 or .2)
    if part > 1 then check.close(run(shape, { law = law, duration = .2, omega = { 0, 0, 1e-6 } }).omega.z, state.omega.z + 1e-6, 1e-11) end
  end
end

-- A torque k t turns it from the instant on in which it is more than the line holds; until then it stands, and is told as held all along it.
do
  local k = .5
  local state, _, seen = run(capsule, { law = function(t) return nil, { 0, 0, k * t } end })
  local start = mu * G * h / 2 / k
  check.close(state.omega.z, k * (1 - start) ^ 2 / 2 / capsule.inertia.x, 1e-7)
  check.truth(seen:match "rest slip$", seen)
  local _, still = run(capsule, { law = function(t) return { 1 + .1 * t, 0, 0 }, { 0, 0, .01 } end })
  local held = still:held()
  check.equal(#held, 1)
  check.equal(held[1].mode, "stick")
  check.close((held[1].force - { -1.1, 0, G }):norm(), 0, 1e-14)
  check.close(held[1].moment.z, -.01, 1e-15)
  check.close(held[1].point.x, R * 1.1 / G, 1e-14)
end

-- A push across that grows from nothing rolls it from the begin: v = k t^2/2/(m + I/R^2).
for _, shape in ipairs { capsule, cylinder } do
  local state = run(shape, { law = function(t) return { 0, t, 0 } end, duration = .5 })
  check.close(state.velocity.y, .125 / (1 + shape.inertia.z / R ^ 2), 1e-8)
  check.close(state.omega.x, -state.velocity.y / R, 1e-8)
end

-- Along itself it slides as any face does; across it rolls ever faster until it but rolls, at v/(1 + I/(m R^2)).
for _, shape in ipairs { capsule, cylinder } do
  local state, scene = run(shape, { velocity = { 1, 0, 0 }, duration = 5 })
  check.close(scene:time(), 1 / (mu * G), 1e-12)
  check.close(state.position.x, .5 / (mu * G), 1e-12)
  state = run(shape, { velocity = { 0, 1, 0 }, duration = 2 })
  local I = shape.inertia.z
  local rolls, time = 1 / (1 + I / R ^ 2), (1 - 1 / (1 + I / R ^ 2)) / (mu * G)
  check.close(state.velocity.y, rolls, 1e-12)
  check.close(state.omega.x, -rolls / R, 1e-11)
  check.close(state.position.y, (1 + rolls) / 2 * time + rolls * (2 - time), 1e-12)
  -- down a slope it rolls without slip up to tan = mu (1 + m R^2/I)
  for _, part in ipairs { .999, 1.5 } do
    local slope = math.atan(mu * (1 + R ^ 2 / I) * part)
    local a = part < 1 and G * math.sin(slope) / (1 + I / R ^ 2) or G * (math.sin(slope) - mu * math.cos(slope))
    check.close(run(shape, { slope = slope, duration = .5 }).velocity.y, a / 2, 1e-11)
  end
end

--- The same body by places along its line and implicit steps: v, w and the roll W, its axis along e at `angle`; the pressure is a + b s, so that
--- nothing tips it: int s p = -R F.e - I W w; Coulomb's friction at each place, blunt below eps. Where it is and how fast at T.
local function by_places(shape, v, w, W, T, step)
  local n, eps, J, I = 40, 1e-4, shape.inertia.x, shape.inertia.z
  local x, y, angle, vx, vy = 0, 0, 0, v[1], v[2]
  local count = math.floor(T / step + .5)
  local dt = T / count
  for _ = 1, count do
    -- the mean angle of the step, and velocities at its end, by fixed points damped by what each friction would be at that speed
    local c, s = math.cos(angle + .5 * dt * w), math.sin(angle + .5 * dt * w)
    local e, cross = { c, s }, { -s, c }
    local ue, uh, nw, nW = vx * e[1] + vy * e[2], vx * cross[1] + vy * cross[2], w, W
    local old_e, old_h = ue, uh
    local b = 0
    for _ = 1, 200 do
      local k0, k1, k2 = 0, 0, 0
      for i = 1, n do
        local at = h * ((2 * i - 1) / n - 1)
        local p = G / n * (1 + b * at)
        local k = dt * mu * p / math.sqrt(ue ^ 2 + (uh + nW * R + nw * at) ^ 2 + eps ^ 2)
        k0, k1, k2 = k0 + k, k1 + k * at, k2 + k * at * at
      end
      -- along: (1 + k0) ue = old; across: uh = old + f, W = old + R f/I, w = old + M/J,  f = -k0 q - k1 w, M = -k1 q - k2 w, q = uh + R W
      local ease = 1 + R ^ 2 / I
      local q0 = old_h + R * W
      local a11, a12, a21, a22 = 1 + ease * k0, ease * k1, k1 / J, 1 + k2 / J
      local d = a11 * a22 - a12 * a21
      local q, turn = (q0 * a22 - a12 * w) / d, (a11 * w - a21 * q0) / d
      local f = -k0 * q - k1 * turn
      ue = old_e / (1 + k0)
      local was = math.abs(uh - (old_h + f)) + math.abs(nw - turn)
      uh, nW, nw = old_h + f, W + R * f / I, turn
      local moment = (R * k0 * ue / dt - I * (W + nW) / 2 * (w + nw) / 2) / G
      b = moment / (h * h / 3 * (1 - 1 / n ^ 2))
      if was < 1e-12 then break end
    end
    local nx, ny = ue * e[1] + uh * cross[1], ue * e[2] + uh * cross[2]
    x, y, angle = x + dt * (vx + nx) / 2, y + dt * (vy + ny) / 2, angle + dt * (w + nw) / 2
    vx, vy, w, W = nx, ny, nw, nW
  end
  return x, y, angle, vx, vy, w, W
end

-- It slides aslant, turns, and rolls, from any begin, to where it but rolls, and on.
for _, case in ipairs { { { 0, .5 }, 5, 0 }, { { .5, 0 }, 3, 0 }, { { .3, .4 }, -4, 6 }, { { 0, .5 }, 3, -10 }, { { -.4, .2 }, 1, -4 } } do
  local v, w, W = case[1], case[2], case[3]
  local T = .25
  local state = run(cylinder, { velocity = { v[1], v[2], 0 }, omega = { W, 0, w }, duration = T })
  local x, y, angle, vx, vy = by_places(cylinder, v, w, W, T, 2e-4)
  local finer = { by_places(cylinder, v, w, W, T, 1e-4) }
  check.close(state.position.x, 2 * finer[1] - x, 2e-5)
  check.close(state.position.y, 2 * finer[2] - y, 2e-5)
  check.close(turned(state), 2 * finer[3] - angle, 4e-4)
  check.close(state.velocity.x, 2 * finer[4] - vx, 1e-4)
  check.close(state.velocity.y, 2 * finer[5] - vy, 1e-4)
end

-- Turned, mirrored and begun at another angle of its roll it goes alike; what is left but rolls on, straight.
for _, shape in ipairs { capsule, cylinder, rounded } do
  for _, slope in ipairs { 0, .05 } do
    local base, scene, seen = run(shape, { velocity = { .4, .6, 0 }, omega = { -3, 0, 5 }, slope = slope, duration = .6 })
    local other, again = run(shape, { velocity = { .4, .6, 0 }, omega = { -3, 0, 5 }, slope = slope, duration = .6, angle = 1.1 })
    local mirror = run(shape, { velocity = { .4, -.6, 0 }, omega = { 3, 0, -5 }, slope = slope, duration = .6, down = { 0, -1 } })
    local back = quat.from_axis_angle(up, -1.1)
    check.close((back:rotate(other.position) - base.position):norm(), 0, 1e-10)
    check.close((back:rotate(other.velocity) - base.velocity):norm(), 0, 1e-9)
    check.close(mirror.position.x, base.position.x, 1e-10)
    check.close(mirror.position.y, -base.position.y, 1e-10)
    check.close(again:time(), scene:time(), 0)
    if slope == 0 then
      check.equal(seen, "contact contact stick stick")
      local e = base.orientation:rotate { 0, 0, 1 }
      check.close(base.velocity.x * e.x + base.velocity.y * e.y, 0, 1e-12)
      check.close(base.omega.z, 0, 1e-12)
      check.close(base.velocity:norm(), R * base.omega:norm(), 1e-12)
    end
  end
end

-- A constant force is a gravity aslant; damped, it spins by w' = -alpha - k w.
do
  local one = run(cylinder, { velocity = { .4, .3, 0 }, omega = { 2, 0, 6 }, slope = .1, down = { .6, .8 }, duration = .2 })
  local other = run(cylinder, { velocity = { .4, .3, 0 }, omega = { 2, 0, 6 }, duration = .2, steady = true, law = function()
    return { G * math.sin(.1) * .6, G * math.sin(.1) * .8, G - G * math.cos(.1) } end })
  check.close((one.position - other.position):norm(), 0, 1e-9)
  check.close((one.velocity - other.velocity):norm(), 0, 1e-8)
  local k, alpha = -math.log(.8), mu * G * h / 2 / cylinder.inertia.x
  local _, scene = run(cylinder, { omega = { 0, 0, 5 }, angular = .2, duration = 4 })
  check.close(scene:time(), math.log(1 + k * 5 / alpha) / k, 1e-9)
end

-- Beyond the border of a box the line is as long as it is on it, which is left to its ends: it goes over, and falls.
do
  local state = run(cylinder, { under = slab, position = { 0, 4.6, 0 }, velocity = { 0, 3, 0 }, omega = { 0, 0, 4 }, duration = 1, friction = .1, over = true })
  check.truth(state.position.z < -.3, "it falls from the table")
end

-- Random begins on planes of all slopes, of rods short and long: they run, the account closes, and nothing is stepped.
math.randomseed(5)
local function between(low, high) return low + (high - low) * math.random() end
for i = 1, 60 do
  local r, half = R, between(.02, .6)
  local shape = i % 2 == 0 and impact.capsule { radius = r, half_height = half } or impact.cylinder { radius = r, half_height = half }
  local angle = between(0, 6)
  run(shape, { velocity = { between(-2, 2), between(-2, 2), 0 }, omega = { between(-30, 30), 0, between(-10, 10) }, friction = between(.05, 1),
    slope = i % 3 == 0 and between(0, .3) or 0, down = { math.cos(angle), math.sin(angle) }, under = i % 5 == 0 and slab or floor, duration = between(.05, 1) })
end

-- A short line under a wide body, which rolls and turns with next to no slip along it.
run(impact.cylinder { radius = .675779, half_height = .110565 }, { radius = .675779, omega = { -.2176, 0, 1.184 }, friction = 1.44 })

-- Saved as it glides, and loaded, it goes on alike, to the bit; and as what was not saved does.
for _, under in ipairs { floor, slab } do
  local function make()
    return impact.scene { gravity = { 0, 0, -G }, duration = .3, bodies = { impact.body(under), impact.body { name = "rod", shape = capsule, mass = 1,
      position = { 0, 0, R }, orientation = along, velocity = { .4, .3, 0 }, omega = { 1, 0, 6 }, friction = mu, restitution = 0 } } }
  end
  local whole, first, second = make(), make(), make()
  check.truth(whole:run_to(.05) and first:run_to(.05), "they run")
  second:load(first:save())
  check.truth(whole:run() and first:run() and second:run(), "they run on")
  check.equal((first:state("rod").position - second:state("rod").position):norm(), 0)
  check.equal((first:state("rod").velocity - second:state("rod").velocity):norm(), 0)
  check.close((whole:state("rod").velocity - second:state("rod").velocity):norm(), 0, 1e-12)
end

-- Pipes on a pipe, parallel or crossing it at so little that they lie on it, are held at both ends of what they share. One that slides along it
-- stops as on a floor; without friction it comes off sideways as a ball comes off a ball, which has a closed form of its own.
local function pipe(shape, yaw, more)
  local low = { name = "low", static = true, shape = shape, orientation = along, friction = more.friction, restitution = 0 }
  local scene = impact.scene { gravity = { 0, 0, -G }, duration = more.duration, pile_tolerance = more.tolerance, output_rate = 0, bodies = { impact.body(low),
    impact.body { name = "rod", shape = shape, mass = 1, position = { 0, 0, 2 * R }, orientation = more.orientation or quat.from_axis_angle(up, yaw) * along,
      velocity = more.velocity, friction = 1, restitution = 0 } } }
  check.truth(scene:run(), "it runs")
  check.truth(scene:usage().pile_steps < 200, "in few steps")
  return scene:state "rod"
end

local function ball_off_ball(speed, duration)
  local ball = impact.sphere { radius = R }
  local scene = impact.scene { gravity = { 0, 0, -G }, duration = duration, output_rate = 0, bodies = {
    impact.body { name = "low", static = true, shape = ball, friction = 0, restitution = 0 },
    impact.body { name = "ball", shape = ball, mass = 1, position = { 0, 0, 2 * R }, velocity = { 0, speed, 0 }, friction = 0, restitution = 0 } } }
  check.truth(scene:run(), "it runs")
  check.equal(scene:usage().pile_steps, 0)
  return scene:state "ball"
end

local off = ball_off_ball(.2, .15)
for _, shape in ipairs { capsule, cylinder } do
  for _, yaw in ipairs { 0, 1e-12, 1e-9, 1e-6, 1e-4 } do
    local slid = pipe(shape, yaw, { velocity = { .05, 0, 0 }, friction = mu, duration = .1, tolerance = 1e-5 })
    check.close(slid.position.x, .05 ^ 2 / (2 * mu * G), 1e-6)
    check.close(slid.velocity:norm(), 0, 1e-3)
    if yaw < 1e-6 then
      local fell = pipe(shape, yaw, { velocity = { 0, .2, 0 }, friction = 0, duration = .15, tolerance = 1e-4 })
      check.close((fell.position - off.position):norm(), 0, 2e-5)
    end
  end
end

--- In the groove between two that all but touch, `drop` above it.
local function in_groove(yaw, drop, tolerance)
  local height = R + math.sqrt(3) * R + 3 * yaw ^ 2 + drop
  local function static(name, y, turn)
    return impact.body { name = name, static = true, shape = cylinder, position = { 0, y, R }, orientation = quat.from_axis_angle(up, turn) * along, friction = .7 }
  end
  local scene = impact.scene { gravity = { 0, 0, -G }, duration = 2, pile_tolerance = tolerance, bodies = { static("west", -R, 0), static("east", R, -yaw),
    impact.body { name = "top", shape = cylinder, mass = 1, position = { 0, 0, height }, orientation = quat.from_axis_angle(up, .7 * yaw) * along, friction = .7,
      restitution = .2 } } }
  check.equal(scene:run(), "at rest")
  return scene:time()
end

-- There it is proved to rest, and comes to rest: it hopped from side to side for ever, each hop parted by as much as it had lost.
for _, yaw in ipairs { 0, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9 } do check.equal(in_groove(yaw, 0), 0) end
for _, yaw in ipairs { 1e-9, 1e-8, 1e-7 } do check.truth(in_groove(yaw, .01, 1e-4) < .5, "soon") end

check.report "faces_lines"
