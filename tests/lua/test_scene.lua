-- SPDX-License-Identifier: MIT
--- Scenes made and run from a stock Lua, against closed forms.
local check = require "check"
local impact = require "impact"
local quat = require "quat"

local function drop(rest)
  local definition = {
    name = "drop", gravity = { 0, 0, -10 }, duration = 0.9, output_rate = 10,
    bodies = {
      impact.body { name = "floor", shape = impact.plane(), restitution = 1 },
      impact.body { name = "ball", shape = impact.sphere(0.1), mass = 2, position = { 0, 0, 0.6 }, restitution = 0.5 },
    },
  }
  for key, value in pairs(rest or {}) do definition[key] = value end
  return impact.scene(definition)
end

-- Event by event: the first of each instant of one run, and the weight once it lies.
do
  local scene, whole = drop { duration = 2 }, drop { duration = 2 }
  whole:run { record = true }
  local events = whole:events()
  for k = 1, #events do
    if k == 1 or events[k].t > events[k - 1].t then
      local event, reason = scene:step()
      check.equal(event.t, events[k].t)
      check.equal(event.event, events[k].event)
      check.equal(event.phases, events[k].phases)
      check.equal(reason, event.t == events[#events].t and "at rest" or "end of time")
    end
  end
  local held = scene:held()
  check.equal(#held, 1)
  check.equal(held[1].body1 .. held[1].body2 .. held[1].mode, "ballfloorstick")
  check.close(held[1].force.z, 20, 1e-12)
  check.close(held[1].point.z, 0, 1e-15)
  local event, reason = drop():step(0.1)
  check.equal(event, nil)
  check.equal(reason, "end of time")
end

-- Wherever a run is paused the forces held are those that move the bodies then: against differences of their velocities.
do
  local shapes = {
    impact.superellipsoid { a = .1, b = .07, c = .05, eps1 = .5, eps2 = .7 }, impact.superellipsoid { a = .1, b = .07, c = .05, eps1 = 1.3, eps2 = .6 },
    impact.superquadric { a = .06, b = .09, c = .05, r = 3, s = 2.5, t = 4 }, impact.ellipsoid { a = .1, b = .07, c = .05 },
  }
  for _, shape in ipairs(shapes) do
    for _, friction in ipairs { 0, .3 } do
      local turned = require "quat".from_axis_angle({ .6, .8, 0 }, .4)
      local low = shape:support(require "quat".rotate(turned:conj(), { 0, 0, -1 }))
      local scene = impact.scene { gravity = { 0, 0, -10 }, duration = 1, rules = { friction = "maximum", restitution = "minimum" }, bodies = {
        { name = "floor", shape = impact.plane(), friction = 0, restitution = 0 },
        { name = "body", shape = shape, mass = 2, position = { 0, 0, low }, orientation = turned, velocity = { .4, .1, 0 }, friction = friction },
      } }
      local h, compared = 2e-5, 0
      for k = 1, 60 do
        local t = .003 * k + 1e-4 * (k % 7)
        scene:run_to(t - h)
        local before, events = scene:state("body").velocity, scene:usage().events
        scene:run_to(t)
        local held = scene:held()
        scene:run_to(t + h)
        local after = scene:state("body").velocity
        local same = true
        for kind, count in pairs(scene:usage().events) do same = same and count == events[kind] end
        if #held == 1 and same and held[1].force.z < 60 then -- at more it is over before the differences are
          compared = compared + 1
          for i = 1, 3 do
            check.close(held[1].force[i], 2 * ((after[i] - before[i]) / (2 * h) + (i == 3 and 10 or 0)), 2e-4 * (20 + held[1].force.z))
          end
        end
      end
      check.truth(compared > 20, "it is held for long")
    end
  end
end

-- Saved and loaded: the same bits to the end, laws of the script among them.
do
  local function forced()
    return drop { duration = 2, forces = { impact.force { name = "law", law = function(t) return { math.sin(t), 0, 0 } end } } }
  end
  local a, b = forced(), forced()
  a:run_to(0.7)
  local bytes = a:save()
  b:load(bytes)
  check.equal(b:time(), 0.7)
  check.equal(a:run(), b:run())
  for _, key in ipairs { "position", "velocity", "omega" } do
    for i = 1, 3 do check.equal(a:state("ball")[key][i], b:state("ball")[key][i]) end
  end
  check.equal(a:energy().force_work, b:energy().force_work)
  check.raises("scene 'drop' cannot go on from these bytes: they are no saved scene", b.load, b, "bytes")
  check.raises("scene 'drop' cannot go on from these bytes: its definition was another one when it was saved", b.load, b,
    drop():save())
end

-- Set and pushed between runs; a law of the script is asked then too, and its error comes out where it was asked.
do
  local scene = drop { duration = 2 }
  scene:run()
  scene:push("ball", { 0, 0, 4 })
  check.equal(scene:state("ball").velocity[3], 2)
  check.equal(#scene:held(), 0)
  scene:set("ball", { position = { 3, 0, 0.6 }, velocity = { 0, 0, 0 } })
  local t = scene:time()
  check.close(scene:step(t + 1).t, t + math.sqrt(0.1), 1e-14)
  scene:push("ball", { 0, 1, 0 }, { 3, 0, 0.2 })
  check.close(scene:state("ball").omega[1], -0.1 / (0.4 * 2 * 0.01), 1e-11)
  check.raises("body 'ball': there it overlaps 'floor' by 0.05 m", scene.set, scene, "ball", { position = { 0, 0, 0.05 } })
  check.raises("scene 'drop' has no body 'bell'", scene.push, scene, "bell", { 0, 0, 1 })
  check.raises("unknown key 'place' in state (keys: position, orientation, velocity, omega)", scene.set, scene, "ball",
    { place = { 0, 0, 1 } })
  check.raises("body 'floor': it is static, nothing moves it", scene.push, scene, "floor", { 0, 0, 1 })
  local asked = 0
  local forced = drop {
    forces = { impact.force { name = "law", law = function()
      asked = asked + 1
      if asked > 1e4 then error "enough" end
      return { 0, 0, 0 }
    end } },
  }
  forced:run_to(0.1)
  asked = 0
  forced:push("ball", { 0, 0, 1 })
  check.truth(asked > 0, "the law was asked")
  asked = 1e4
  check.raises("enough", forced.push, forced, "ball", { 0, 0, 1 })
end

-- A drop of 0.5 m: the first bounce at t = sqrt(0.1) s with sqrt(10) m/s, half of it back.
do
  local scene, samples, impacts, progress = drop(), 0, {}, 0
  check.equal(tostring(scene), "scene 'drop' (2 bodies)")
  check.equal(scene:name(), "drop")
  check.equal(scene:duration(), 0.9)
  check.equal(scene:time(), 0)
  local reason = scene:run {
    record = true,
    on_sample = function(state)
      samples = samples + 1
      check.equal(state.body, "ball")
    end,
    on_event = function(event) impacts[#impacts + 1] = event end,
    on_progress = function() progress = progress + 1 end,
  }
  check.equal(reason, "end of time")
  check.equal(scene:time(), 0.9)
  check.equal(impacts[1].event, "impact")
  check.equal(impacts[1].body1 .. impacts[1].body2, "ballfloor")
  check.close(impacts[1].t, math.sqrt(0.1), 1e-15)
  check.close(impacts[1].un_before, -math.sqrt(10), 1e-14)
  check.close(impacts[1].un_after, math.sqrt(10) / 2, 1e-14)
  check.close(impacts[1].impulse_n, 3 * math.sqrt(10), 1e-14)
  check.close(impacts[1].normal.z, 1, 0)
  check.equal(#scene:events(), #impacts)
  check.equal(scene:events()[2].t, impacts[2].t)
  check.equal(scene:first("impact", "floor", "ball").t, impacts[1].t)
  check.equal(scene:first("liftoff"), nil)
  local track = scene:track("ball")
  check.equal(#track.t, samples)
  check.equal(#track.wz, samples)
  check.close(track.z[2], 0.6 - 10 * 0.01 / 2, 1e-15)
  -- Between the rows of a parabola, the cubic is the parabola.
  local fine = scene:track("ball", 1000)
  for i = 1, #fine.t do
    if fine.t[i] > math.sqrt(0.1) then break end
    check.close(fine.z[i], 0.6 - 5 * fine.t[i] ^ 2, 1e-14)
  end
  local before, after = impact.split(track, impacts[1].t)
  check.equal(#before.t + #after.t, #track.t)
  check.truth(before.vz[#before.t] < 0 and after.vz[1] > 0, "the split stands at the bounce")
  local energies = scene:energies("ball", track)
  check.close(energies.total[1], 2 * 10 * 0.6, 1e-13)
  check.close(energies.total[#before.t], 2 * 10 * 0.6, 1e-13)
  local usage, energy = scene:usage(), scene:energy()
  check.equal(usage.integrators, 0)
  check.equal(usage.gap_gjk, 0)
  check.equal(usage.events.impact, usage.impacts_closed_form)
  check.close(energy.start - energy.impact_loss - energy.kinetic - energy.potential, 0, 1e-12)
  check.truth(scene:summary(reason):find("drop: end of time, t = 0.9 s", 1, true) == 1, "the summary's first line")
  check.equal(tostring(scene), "scene 'drop' (2 bodies)")
  scene:close()
  check.raises("the scene is closed", function() scene:time() end)
end

-- Rows that nobody kept, and what is no track, are told.
do
  local scene = drop()
  local function refuses(wanted, f) check.raises(wanted, function() local result = f() return result end) end
  scene:run_to(0.1)
  refuses("scene 'drop' has no rows: run it with record = true", function() local track = scene:track "ball" return track end)
  refuses("scene 'drop' has no rows: run it with record = true", function() local events = scene:events() return events end)
  scene:run { record = true }
  local track = scene:track "ball"
  refuses("track: rate must be a number > 0, got x", function() local fine = scene:track("ball", "x") return fine end)
  for _, rate in ipairs { 0, -1, 0 / 0 } do
    refuses("track: rate must be a number > 0, got " .. tostring(rate), function() local fine = scene:track("ball", rate) return fine end)
  end
  refuses("energies: a track of scene:track is needed", function() local energies = scene:energies "ball" return energies end)
  refuses("split: a track of scene:track is needed", function() return impact.split({ t = quat.vec3(1, 2, 3) }, 1) end)
  refuses("split: t must be a number", function() local before = impact.split(track) return before end)
  refuses("along: 2 times for 1 values", function() local values = impact.along({ 1, 2 }, { 3 }, { 1.5 }) return values end)
  refuses("first: the kind must be one of impact, contact, slip, stick, liftoff, force, rest, got 'bounce'", function()
    local event = scene:first "bounce"
    return event
  end)
  refuses("scene 'drop' has no body 'bal'", function() local event = scene:first("impact", "bal") return event end)
  refuses("scene 'drop' has no body 'flor'", function() local event = scene:first("impact", nil, "flor") return event end)
end

-- Moments by letters, in the energies too; and the body's surface as it stands at the end.
do
  local turning = impact.scene { duration = 1, gravity = { x = 0, y = 0, z = -10 }, bodies = {
    impact.body { name = "top", shape = impact.sphere(1), mass = 2, moments = { x = 1, y = 2, z = 3 }, omega = { 0, 0, 4 } } } }
  turning:run { record = true }
  local energies = turning:energies("top", turning:track("top"))
  check.equal(energies.rotation[1], 24)
  local solid = require "impact.portrait".solid(turning:state "top", impact.ellipsoid { a = 3, b = 2, c = 1 })
  local turn, tip = turning:state("top").orientation, turning:state("top").position + turning:state("top").orientation:rotate { 3, 0, 0 }
  check.truth(turn.w ~= 1, "it has turned")
  local nearest = math.huge
  for i, row in ipairs(solid[1]) do
    for j, x in ipairs(row) do nearest = math.min(nearest, (tip - { x, solid[2][i][j], solid[3][i][j] }):norm()) end
  end
  check.close(nearest, 0, 1e-12)
  check.equal(tostring(turning), "scene 'scene' (1 body)")
end

-- In pieces, and stopped.
do
  local whole, pieces = drop(), drop()
  whole:run_to(0.7)
  for k = 1, 7 do check.equal(pieces:run_to(k / 10), "end of time") end
  check.close(pieces:state("ball").position.z, whole:state("ball").position.z, 1e-14)
  local reason, why, kind = pieces:run_to(0.5)
  check.truth(reason == nil and why:find("is over: the scene stands at 0.7", 1, true) and kind == "run", "time does not go back")
  check.equal(drop():run { on_sample = function(state) return state.t < 0.2 end }, "stopped by the script")
  local scene = drop()
  check.equal(scene:run { on_event = function() return false end }, "stopped by the script")
  check.close(scene:time(), math.sqrt(0.1), 1e-15)
  check.equal(drop({ max_events = 2 }):run(), "event limit")
  check.equal(drop({ duration = 60 }):run(), "at rest")
  local ok, message = pcall(function() drop():run { on_event = function() error { code = 7 } end } end)
  check.truth(not ok and message.code == 7, "an error of the script goes through as it is")
end

-- A run inside another scene's, and inside a coroutine.
do
  local inner = 0
  local co = coroutine.wrap(function()
    drop():run { on_event = function()
      if inner == 0 then
        inner = 1
        local scene = drop()
        check.equal(scene:run(), "end of time")
        inner = scene:time()
      end
    end }
    coroutine.yield(1)
    check.raises("attempt to yield across a C-call boundary", function()
      local ok, message = pcall(function() drop():run { on_event = function() coroutine.yield() end } end)
      error(message, 1)
    end)
    return 2
  end)
  check.equal(co(), 1)
  check.equal(inner, 0.9)
end

-- CSV, whole or not at all.
do
  local base = os.tmpname()
  check.equal(drop():run { csv = base }, "end of time")
  for _, name in ipairs { base .. ".csv", base .. "_events.csv" } do
    local file = assert(io.open(name))
    check.truth(file:read("l"):match("^t,"), "the header")
    file:close()
    os.remove(name)
  end
  pcall(function() drop():run { csv = base, on_event = function() error("no") end } end)
  for _, name in ipairs { ".csv", "_events.csv", ".csv.part", "_events.csv.part" } do
    check.equal(io.open(base .. name), nil)
  end
  for _, name in ipairs { base, base .. ".partial.csv", base .. "_events.partial.csv" } do
    check.truth(os.remove(name), "what there is up to then is kept as " .. name)
  end
  local reason, message, kind = drop():run { csv = "/no/such/folder/x" }
  check.equal(reason, nil)
  check.equal(kind, "output")
  check.truth(message:find("/no/such/folder/x.csv", 1, true), "the message names the file")
end

-- The orientation of planes given by their normals: the free side is there.
do
  for _, normal in ipairs { { 0, 0, 1 }, { 0, 0, -1 }, { 1, 0, 0 }, { -3, 0, 0 }, { 1e-9, 0, -1 }, { 1, 2, -2 }, { -1, 1, 1e200 } } do
    local scene = impact.scene {
      duration = 1,
      bodies = { impact.body { name = "wall", shape = impact.plane(), normal = normal } },
    }
    local q = scene:state("wall").orientation
    local n = { 2 * (q.x * q.z + q.w * q.y), 2 * (q.y * q.z - q.w * q.x), 1 - 2 * (q.x ^ 2 + q.y ^ 2) }
    local scale = math.max(math.abs(normal[1]), math.abs(normal[2]), math.abs(normal[3]))
    local length = scale * math.sqrt((normal[1] / scale) ^ 2 + (normal[2] / scale) ^ 2 + (normal[3] / scale) ^ 2)
    for k = 1, 3 do check.close(n[k], normal[k] / length, 4e-16) end
  end
  local scene = impact.scene {
    duration = 1,
    bodies = { impact.body { name = "ball", shape = impact.sphere(1), orientation = quat.new(0, 0, 3, 4), omega = { x = 1, y = 2, z = 3 } } },
  }
  check.close(scene:state("ball").orientation.z, 0.8, 1e-16)
  check.equal(scene:state("ball").omega[2], 2)
end

-- What a solver cannot do is told in words.
do
  local scene = impact.scene { duration = 2, solver = "closed_form", bodies = {
    impact.body { name = "floor", shape = impact.plane() },
    impact.body { name = "egg", shape = impact.ellipsoid { a = 0.1, b = 0.13, c = 0.07 }, position = { 0, 0, 1 }, omega = { 9, 2, 3 } },
  } }
  local reason, message = scene:run()
  check.equal(reason, nil)
  check.truth(message:find("it has no closed form, and the scene asks for no other solver", 1, true), message)
end

-- A table may change after the scene is made: the scene has copied it. Bodies may be used again.
do
  local ball = impact.body { name = "ball", shape = impact.sphere(0.1), mass = 1 }
  local scene = impact.scene { duration = 1, gravity = { 0, 0, 0 }, bodies = { ball } }
  ball.position = { 5, 0, 0 }
  check.equal(scene:state("ball").position.x, 0)
  check.equal(impact.scene({ duration = 1, bodies = { ball } }):state("ball").position.x, 5)
  check.raises("scene 'scene': output_rate = 1e+300: with this duration makes more than 1e15 samples", impact.scene,
    { duration = 1, output_rate = 1e300, bodies = { ball } })
  ball.mass = -1
  check.raises("body 'ball': mass must be a positive number, got -1", impact.scene, { duration = 1, bodies = { ball } })
end

-- Forces by laws of the script's own, against closed forms.
if impact.has("cvode") then
  local scene = impact.scene {
    duration = 3, gravity = { 0, 0, 0 },
    bodies = { impact.body { name = "ball", shape = impact.sphere(0.1), mass = 2, position = { 1, 0, 0 } } },
    forces = { impact.force { name = "spring", body = "ball", law = function(t, body)
      local x = body.position
      return { -8 * x[1], -8 * x[2], -8 * x.z }, { 0, 0, 0.008 }
    end } },
  }
  check.equal(scene:run(), "end of time")
  local ball = scene:state("ball")
  check.close(ball.position.x, math.cos(2 * 3), 1e-9)
  check.close(ball.velocity.x, -2 * math.sin(2 * 3), 1e-9)
  check.close(ball.omega.z, 3, 1e-9) -- moment 0.4 x 2 x 0.01
  check.close(scene:energy().force_work, scene:energy().kinetic, 1e-9)
end

-- Newton's law may give energy: a thin rod's tenth (docs/collide.md) is the law's, and no fault of the account.
do
  local lean = math.rad(55)
  local turn = quat.from_axis_angle({ 0, 1, 0 }, lean - math.pi / 2)
  local rod = impact.capsule { radius = 1e-6, half_height = 1 }
  for _, law in ipairs { "newton", "poisson", "stronge" } do
    local scene = impact.scene { duration = 0.1, gravity = { 0, 0, 0 }, law = law, bodies = {
      impact.body { name = "floor", shape = impact.plane(), friction = 0.5, restitution = 1 },
      impact.body { name = "rod", shape = rod, mass = 1, orientation = turn, friction = 1, restitution = 1, velocity = { -1, 0, -1 },
        position = { 0, 0, rod:support(turn:rotate_inverse { 0, 0, -1 }) + 0.01 } },
    } }
    check.equal(scene:run(), "end of time")
    local energy, gained = scene:energy(), law == "newton"
    check.equal(scene:usage().impacts_gaining, gained and 1 or 0)
    check.equal(energy.impact_loss < 0, gained)
    if gained then check.close(energy.kinetic, 1.104, 1e-3) end
    check.equal(scene:summary():find("gave energy", 1, true) ~= nil, gained)
  end
end

-- What putting back what is held takes of the energy is what the constraint's force gave on the way off: nothing to book.
if impact.has("cvode") then
  local scene = impact.scene { duration = 1, output_rate = 0, tolerance = 1e-5, bodies = {
    impact.body { name = "floor", shape = impact.plane(), friction = 1, restitution = 1 },
    impact.body { name = "cigar", shape = impact.ellipsoid { a = 0.3, b = 0.03, c = 0.03 }, mass = 1, friction = 0.3, restitution = 0.5,
      position = { 0, 0, 0.5 }, orientation = quat.from_axis_angle({ 0.3, 0.2, 0.1 }, math.sqrt(0.14)) },
  } }
  check.equal(scene:run(), "end of time")
  local energy = scene:energy()
  check.close(energy.kinetic + energy.potential + energy.sliding_loss + energy.impact_loss, energy.start, 1e-9 * energy.start)
end

check.report("scene")
