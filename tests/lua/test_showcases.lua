-- SPDX-License-Identifier: MIT
--- Example scenes whose motion is known in closed form, against it; arg[1] is the examples' folder.
local check = require "check"
local impact = require "impact"
local quat = require "quat"

local folder = arg[1]

--- The scene, with its own arguments if any.
local function example(name, arguments)
  arg = arguments or {}
  return dofile(string.format("%s/scenes/%s.lua", folder, name))
end

--- The same scene with other values.
local function variant(scene, changes)
  local definition = {}
  for key, value in pairs(scene:definition()) do definition[key] = value end
  for key, value in pairs(changes) do definition[key] = value end
  return impact.scene(definition)
end

local function impacts(scene)
  local list = {}
  for _, event in ipairs(scene:events()) do
    if event.event == "impact" then list[#list + 1] = event end
  end
  return list
end

-- ---- the bouncing ball: ten bounces and the end of all ----
do
  local r, h, e, g = 0.1, 1, 0.8, 9.81
  local t0 = math.sqrt(2 * h / g)
  local the_end = t0 * (1 + e) / (1 - e)
  local function bounce(n) return t0 * (1 + 2 * e * (1 - e ^ n) / (1 - e)) end
  local scene = example "bouncing_ball"
  check.equal(scene:run { record = true }, "at rest")
  local list = impacts(scene)
  for n = 0, 9 do
    check.close(list[n + 1].t, bounce(n), 1e-12)
    check.close(list[n + 1].un_after, g * t0 * e ^ (n + 1), 1e-12)
    check.close(list[n + 1].t + 2 * list[n + 1].un_after / (g * (1 - e)), the_end, 1e-12)
  end
  -- The last impact is held; what would have followed takes 2 e v/(g (1 - e)).
  local last = list[#list]
  check.close(last.t - 2 * e * last.un_before / (g * (1 - e)), the_end, 1e-10)
  check.truth(the_end - last.t < 1e-5, "bounces are followed to 1e-12 m")
  local tops = example "bouncing_ball"
  for n = 0, 9 do
    check.truth(tops:run_to(bounce(n) + e ^ (n + 1) * t0))
    local state = tops:state "ball"
    check.close(state.position[3], r + h * e ^ (2 * (n + 1)), 1e-12)
    check.close(state.velocity[3], 0, 1e-11)
  end
  check.equal(scene:usage().integrators, 0)
end

-- ---- Painleve's rod: stopped by an impact without approach ----
do
  local lean, half, width, speed = 0.9, 1, 0.02, 3
  local s, c = math.sin(lean), math.cos(lean)
  local height = math.sqrt(half ^ 2 * s ^ 2 + width ^ 2 * c ^ 2)
  local rx, rz, J = -(half ^ 2 - width ^ 2) * s * c / height, -height, (half ^ 2 + width ^ 2) / 5
  local zz, xx, xz = 1 + rx * rx / J, 1 + rz * rz / J, -rx * rz / J
  for k = 1, 8 do
    local mu, eps = 0.8 * k, 0.12 * (k - 1)
    local scene = example("painleve_rod", { string.format("mu=%.17g", mu), string.format("eps=%.17g", eps) })
    local slides = variant(scene, { duration = 0.01 })
    slides:run { record = true }
    local first = slides:events()[1]
    local a = -(zz + mu * xz)
    check.equal(first.t, 0)
    if a < 0 then
      check.equal(first.event, "contact")
    else
      local p1 = speed / (mu * xx + xz)
      local p = (1 + eps) * p1 * (1 + a / (zz - xz ^ 2 / xx))
      check.equal(first.phases, eps > 0 and "tangential stick-c stick-r" or "tangential stick-c")
      check.close(first.impulse_n, p, 1e-12 * p)
    end
    -- lifted it leaves at once, of three solutions that it has: nothing; a pressure; an impact
    local lifted = variant(slides, { gravity = { 0, 0, 9.81 } })
    lifted:run { record = true }
    check.equal(#lifted:events(), 0)
    check.equal(lifted:usage().lifts_chosen, a > 0 and 1 or 0)
  end
end

-- Whatever its lean and friction it runs through.
do
  local stopped = 0
  for _, mu in ipairs { 1.4, 2, 3, 10 } do
    for _, lean in ipairs { 0.3, 0.6, 0.9, 1.1, 1.3 } do
      local scene = example("painleve_rod",
        { string.format("mu=%.17g", mu), "eps=0.5", string.format("lean=%.17g", lean), "speed=3.0" })
      scene:run { record = true }
      check.equal(scene:time(), 1)
      for _, event in ipairs(scene:events()) do
        if event.phases and event.phases:find("tangential", 1, true) then stopped = stopped + 1 end
      end
    end
  end
  check.equal(stopped > 10, true)
end

-- ---- the cradle: the textbook's answer, and the laws' where the balls touch ----
do
  local function after_first(arguments)
    local scene = variant(example("newtons_cradle", arguments), { duration = 0.45 })
    scene:run { record = true }
    local v = {}
    for i = 1, 7 do v[i] = scene:state("ball " .. i).velocity.x end
    return v, scene
  end
  local function ball(speed) return { m = 1, J = { moments = { 1, 1, 1 } }, v = { speed, 0, 0 } } end
  for _, gap in ipairs { 1e-4, 1e-9 } do
    local v, scene = after_first { string.format("gap=%.17g", gap) }
    check.equal(scene:usage().encounters, 0)
    for i, wanted in ipairs { 1, 0, 0, 0, 0, 0, 1 } do check.close(v[i], wanted, 1e-15) end
  end
  for law, together in pairs { stronge = "springs", poisson = "moreau" } do
    local v, scene = after_first { "gap=0.0", "law=" .. law }
    local bodies, contacts = {}, {}
    for i = 2, 7 do bodies[i - 1] = ball(i == 2 and 1 or 0) end
    for i = 1, 5 do
      contacts[i] = { body1 = i, body2 = i + 1, n = { -1, 0, 0 }, r1 = { 0.05, 0, 0 }, r2 = { -0.05, 0, 0 }, eps = 1 }
    end
    local answer = impact.collide_together { bodies = bodies, contacts = contacts, law = together }
    for i = 2, 7 do check.close(v[i], answer.v[i - 1].x, 1e-12) end
    check.truth(v[2] < -0.05, "the striker comes back")
    check.equal(scene:usage().encounters, 1)
    local struck = 0
    for _, event in ipairs(scene:events()) do
      struck = struck + event.encounter
      if event.encounter == 1 then check.close(event.t, 0.403, 1e-12) end
    end
    check.equal(struck, 5)
    check.truth(scene:summary():find "1 instant answered together", "the summary counts encounters")
  end
  local v, scene = after_first { "gap=0.0", "together=sequence" }
  check.equal(scene:usage().encounters, 0)
  for i, wanted in ipairs { 1, 0, 0, 0, 0, 0, 1 } do check.close(v[i], wanted, 1e-15) end
end

-- ---- the T-handle: a thousand turn-overs ----
do
  local short = example "t_handle"
  local half = short:duration() / 4
  local scene = variant(short, { duration = 1001 * half })
  local start = scene:energy().kinetic
  for k = 1, 1000 do
    check.truth(scene:run_to(k * half))
    local state = scene:state "handle"
    local inside = quat.rotate(quat.conj(state.orientation), state.omega)
    local sign = k % 2 == 0 and 1 or -1
    check.close(inside[1], 0.01, 1e-10)
    check.close(inside[2], sign * 10, 1e-12)
    check.close(inside[3], 0, 1e-10)
    -- The momentum stands still: I w, turned back into the laboratory.
    local L = quat.rotate(state.orientation, { inside[1], 2 * inside[2], 3 * inside[3] })
    check.close(math.sqrt((L[1] - 0.01) ^ 2 + (L[2] - 20) ^ 2 + L[3] ^ 2), 0, 20 * 1e-14)
    check.close(scene:energy().kinetic / start, 1, 1e-13)
  end
  check.equal(scene:usage().integrators, 0)
end

-- ---- Garwin's superball: each impact by CVODE at 1e-14 ----
do
  local theta, r = math.acos(3 / 7), 0.025
  local scene = example "superball"
  check.equal(scene:run { record = true }, "end of time")
  local track, n = scene:track "ball", 0
  for i = 2, #track.t do
    if track.vz[i] ~= track.vz[i - 1] then
      n = n + 1
      check.close(track.vx[i], math.cos(n * theta), 1e-11)
      check.close((n % 2 == 0 and 1 or -1) * r * track.wy[i], -math.sqrt(5 / 2) * math.sin(n * theta), 1e-11)
    end
  end
  check.equal(n, 8)
  check.equal(#impacts(scene), 8)

  -- On one wall: after every second bounce velocity and spin are what they were.
  local bodies = {}
  for i, body in ipairs(scene:definition().bodies) do
    if i ~= 2 then bodies[#bodies + 1] = body end
  end
  local floor = variant(scene, { gravity = { 0, 0, -9.81 }, bodies = bodies, duration = 4, output_rate = 0 })
  check.equal(floor:run { record = true }, "end of time")
  track, n = floor:track "ball", 0
  for i = 2, #track.t, 2 do
    if math.abs(track.vz[i] - track.vz[i - 1]) > 1 then
      n = n + 1
      check.close(track.vx[i], n % 2 == 0 and 1 or 3 / 7, 1e-11)
      check.close(r * track.wy[i], n % 2 == 0 and 0 or 10 / 7, 1e-11)
    end
  end
  check.truth(n >= 4, "it bounces")
end

-- ---- the turntable: circles at two sevenths of its rate; and a belt ----
do
  local r = 0.02
  local scene = example "turntable"
  local W = scene:state("table").omega[3]
  local rate, v0 = 2 / 7 * W, scene:state("thrown").velocity[2]
  check.equal(scene:run { record = true }, "end of time")
  local track = scene:track "thrown"
  for i = 1, #track.t do
    local c, s = math.cos(rate * track.t[i]), math.sin(rate * track.t[i])
    check.close(track.x[i], 0.7 + v0 / rate * (c - 1), 1e-11)
    check.close(track.y[i], v0 / rate * s, 1e-11)
    check.close(track.vx[i], -v0 * s, 1e-11)
    check.close(track.vy[i], v0 * c, 1e-11)
  end
  track = scene:track "set down"
  local slides = scene:first("stick", "set down", "table").t
  for i = 1, #track.t do
    check.close(track.wx[i] - 5 / (2 * r) * track.vy[i], 0, 1e-10)
    check.close(track.wy[i] + 5 / (2 * r) * track.vx[i], 0, 1e-10)
    if track.t[i] > slides then
      check.close(track.vx[i], -rate * track.y[i], 1e-12)
      check.close(track.vy[i], rate * track.x[i], 1e-12)
    end
  end
  local energy = scene:energy()
  check.close(energy.kinetic + energy.potential, energy.start + energy.drive_work - energy.sliding_loss - energy.impact_loss, 1e-13)

  -- Set down on a belt: sliding for 2 V/(7 mu g), then rolling at 2/7 V.
  local V, mu, g = 3, 0.2, 9.81
  local belt = impact.scene {
    name = "belt", gravity = { 0, 0, -g }, duration = 1,
    bodies = {
      impact.body { name = "belt", shape = impact.plane { width = 50, depth = 1 }, velocity = { V, 0, 0 }, friction = 1 },
      impact.body { name = "ball", shape = impact.sphere(r), position = { 0, 0, r }, friction = mu },
    },
  }
  check.equal(belt:run { record = true }, "end of time")
  check.close(belt:first("stick", "ball", "belt").t, 2 * V / (7 * mu * g), 1e-11)
  check.close(belt:state("ball").velocity[1], 2 / 7 * V, 1e-11)
  check.close(belt:state("ball").omega[2] * r, -5 / 7 * V, 1e-11)
  check.truth(belt:summary():find(" by drives, -", 1, true), "the drive's work in the summary")
end

check.report("showcases")
