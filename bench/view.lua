-- SPDX-License-Identifier: MIT
--- What seeing a run costs: `impact --trust bench/view.lua -- FOLDER WORK` prints CSV of each scene of FOLDER and of a gas of 1000 balls
--- for 10 s: seconds of motion, events, keys; ms of the processor of the run alone, without rows or record; the same with the record in
--- memory over that (bar: 1.1 where the run takes a millisecond or more), and what a key takes, us; with the file written over the run
--- as the runner makes it, with CSV at the scene's rate; kB of the record and of its page, which are written to WORK and taken away.
--- Each time is the least of runs that take turns: whatever else the machine does only adds.
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

-- The least seconds of the run alone, with a record, with rows, with rows and a file: of turns that take so many seconds, three of each or ten seconds.
local function cost(definition, seconds)
  local rate, spent, turns = definition.output_rate, 0, 0
  local ways = { { {}, 0 }, { { record = true, rows = false }, 0 }, { { csv = work .. "/view" }, rate }, { { csv = work .. "/view", record = work .. "/view.run" }, rate } }
  local least = { math.huge, math.huge, math.huge, math.huge }
  repeat
    for i, way in ipairs(ways) do
      definition.output_rate = way[2]
      local taken = run(definition, way[1])
      least[i], spent = math.min(least[i], taken), spent + taken
    end
    turns = turns + 1
  until spent > seconds and turns > 2 or spent > 10
  definition.output_rate = rate
  return table.unpack(least)
end

local function size(path)
  local file = assert(io.open(path, "rb"))
  local bytes = file:seek "end"
  file:close()
  os.remove(path)
  return bytes
end

local function show(name, definition, seconds)
  local bare, kept, rows, both = cost(definition, seconds)
  local _, scene = run(definition, { record = work .. "/view.run" })
  local usage, record = scene:usage(), scene:record()
  local page, message = record:view(work .. "/view.html")
  local _, last = record:times()
  os.remove(work .. "/view.csv")
  os.remove(work .. "/view_events.csv")
  print(string.format("%s,%.4g,%d,%d,%.3g,%.3f,%.2f,%.3f,%.0f,%s", name, last, #record:events(), usage.keys, 1e3 * bare, kept / bare,
    1e6 * (kept - bare) / usage.keys, both / rows, size(work .. "/view.run") / 1000, page and string.format("%.0f", size(work .. "/view.html") / 1000) or message))
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

print "scene,duration_s,events,keys,run_ms,keys_over_run,us_per_key,file_over_rows,record_kB,page_kB"
for path in io.popen("ls '" .. folder .. "'/*.lua"):lines() do
  dofile(path)
  show(path:match "([^/]+)%.lua$", made, 1)
end
show("gas of 1000 balls", gas(1000, 10), 0)
