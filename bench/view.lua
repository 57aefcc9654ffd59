-- SPDX-License-Identifier: MIT
--- What seeing a run costs: `impact --trust bench/view.lua -- FOLDER WORK` prints CSV of each scene of FOLDER and of a gas of 1000 balls
--- for 10 s: seconds of motion, events, keys; the processor's time of the run alone, without rows or record; with keys over that; with
--- rows and keys over with rows alone, as the runner makes them (CSV at the scene's rate); medians of runs that take turns; kB of
--- the record and of its page, which are written to WORK and taken away.
local impact = require "impact"
local folder, work = arg[1], arg[2]
arg = {}
local make, made = impact.scene, nil
impact.scene = function(definition)
  definition.plot = nil
  made = definition
  return make(definition)
end

-- The processor's seconds of a run, and the scene.
local function run(definition, options)
  local scene = make(definition)
  collectgarbage()
  local from = os.clock()
  assert(scene:run(options))
  return os.clock() - from, scene
end

local function median(list)
  table.sort(list)
  return list[(#list + 1) // 2]
end

-- The seconds of the bare run, and the two quotients, of runs that take turns until they have taken so many seconds, three of each or ten seconds.
local function cost(definition, seconds)
  local bare, over_bare, over_rows, spent, rate = {}, {}, {}, 0, definition.output_rate
  repeat
    definition.output_rate = 0
    local alone, kept = run(definition, {}), run(definition, { record = work .. "/view.run" })
    definition.output_rate = rate
    local rows, both = run(definition, { csv = work .. "/view" }), run(definition, { csv = work .. "/view", record = work .. "/view.run" })
    bare[#bare + 1], over_bare[#over_bare + 1], over_rows[#over_rows + 1] = alone, kept / alone, both / rows
    spent = spent + alone + kept + rows + both
  until spent > seconds and #bare > 2 or spent > 10
  return median(bare), median(over_bare), median(over_rows)
end

local function size(path)
  local file = assert(io.open(path, "rb"))
  local bytes = file:seek "end"
  file:close()
  os.remove(path)
  return bytes
end

local function show(name, definition, seconds)
  local bare, over_bare, over_rows = cost(definition, seconds)
  local _, scene = run(definition, { record = work .. "/view.run" })
  local usage, record = scene:usage(), scene:record()
  local page, message = record:view(work .. "/view.html")
  local _, last = record:times()
  os.remove(work .. "/view.csv")
  os.remove(work .. "/view_events.csv")
  print(string.format("%s,%.4g,%d,%d,%.3g,%.3f,%.3f,%.0f,%s", name, last, #record:events(), usage.keys, 1e3 * bare, over_bare, over_rows,
    size(work .. "/view.run") / 1000, page and string.format("%.0f", size(work .. "/view.html") / 1000) or message))
end

-- A gas: equal balls in a box of which they fill a tenth, which meet some 35000 times.
local function gas(count, duration)
  local r, seed, bodies = 0.1, 3, {}
  local side = (count * 4 / 3 * math.pi * r ^ 3 / 0.1) ^ (1 / 3)
  local cells = math.ceil(count ^ (1 / 3))
  local function draw() -- Park and Miller's, in [-1, 1)
    seed = seed * 16807 % 2147483647
    return seed / 1073741823.5 - 1
  end
  for axis = 1, 3 do
    for way = -1, 1, 2 do
      local position, normal = { 0, 0, 0 }, { 0, 0, 0 }
      position[axis], normal[axis] = way * side / 2, -way
      bodies[#bodies + 1] = impact.body { name = "wall " .. #bodies + 1, shape = impact.plane(), position = position, normal = normal, friction = 0.2, restitution = 1 }
    end
  end
  for i = 0, count - 1 do
    local position, velocity = {}, {}
    for axis, cell in ipairs { i % cells, i // cells % cells, i // cells ^ 2 } do
      position[axis] = ((cell + 0.5) / cells - 0.5) * side
      velocity[axis] = 2 * draw()
    end
    bodies[#bodies + 1] = impact.body { name = "ball " .. i + 1, shape = impact.sphere(r), position = position, velocity = velocity, friction = 0.2, restitution = 1 }
  end
  return { name = "gas", duration = duration, gravity = { 0, 0, 0 }, bodies = bodies, max_events = 1000000, output_rate = 24 }
end

print "scene,duration_s,events,keys,run_ms,keys_over_bare,keys_over_rows,record_kB,page_kB"
for path in io.popen("ls '" .. folder .. "'/*.lua"):lines() do
  dofile(path)
  show(path:match "([^/]+)%.lua$", made, 0.3)
end
show("gas of 1000 balls", gas(1000, 10), 0)
