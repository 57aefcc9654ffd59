-- SPDX-License-Identifier: MIT
--- What seeing a run costs: `impact --trust bench/view.lua -- FOLDER WORK` prints CSV: each scene of FOLDER, and 1000 balls that fall
--- and bounce for 10 s; seconds of motion, events, keys; the processor's time of the run without a record, and with keys over
--- that (the median of pairs of runs that take turns); kB of the record and of its page (written to WORK, and taken away).
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

-- With keys over without, of runs in pairs until they have taken so many seconds.
local function cost(definition, seconds)
  local without, ratio, spent = {}, {}, 0
  repeat
    local bare, kept = run(definition, {}), run(definition, { record = true })
    without[#without + 1], ratio[#ratio + 1] = bare, kept / bare
    spent = spent + bare + kept
  until spent > seconds and #ratio > 2
  return median(without), median(ratio)
end

local function size(path)
  local file = assert(io.open(path, "rb"))
  local bytes = file:seek "end"
  file:close()
  os.remove(path)
  return bytes
end

local function show(name, definition, seconds)
  definition.output_rate = 0
  local bare, ratio = cost(definition, seconds)
  local _, scene = run(definition, { record = work .. "/view.run" })
  local usage, record = scene:usage(), scene:record()
  local page, message = record:view(work .. "/view.html")
  local _, last = record:times()
  print(string.format("%s,%.4g,%d,%d,%.3g,%.3f,%.0f,%s", name, last, #scene:events(), usage.keys, 1e3 * bare, ratio, size(work .. "/view.run") / 1000,
    page and string.format("%.0f", size(work .. "/view.html") / 1000) or message))
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
  return { name = "gas", duration = duration, gravity = { 0, 0, 0 }, bodies = bodies, max_events = 1000000 }
end

print "scene,duration_s,events,keys,run_ms,with_keys,record_kB,page_kB"
for path in io.popen("ls '" .. folder .. "'/*.lua"):lines() do
  dofile(path)
  show(path:match "([^/]+)%.lua$", made, 0.3)
end
show("gas of 1000 balls", gas(1000, 10), 0)
