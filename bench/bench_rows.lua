-- SPDX-License-Identifier: MIT
--- How fast a run writes its rows: `impact --trust bench_rows.lua -- WORK` prints CSV: the case; rows; the processor's us for a
--- row, all of the run in it, and the same rows read and not written (output_rate without a file); millions of rows a second with all
--- in it. Medians of runs that take turns.
local impact = require "impact"
local work, quick = arg[1], os.getenv "BENCH_QUICK"
local rows_wanted = quick and 30000 or 100000

local function balls(count, tumbling)
  local bodies = {}
  for i = 1, count do
    bodies[i] = impact.body { name = "body " .. i, shape = tumbling and impact.ellipsoid { a = .3, b = .2, c = .1 } or impact.sphere(.1), position = { i, 0, 1e4 },
      velocity = { 1, 2, 3 }, omega = { 1, .2, .1 } }
  end
  return bodies
end

-- CPU seconds of a run, and its rows.
local function run(bodies, rows, file)
  local steps = rows // #bodies
  local scene = impact.scene { name = "rows", duration = 1, output_rate = steps, bodies = bodies }
  collectgarbage()
  local from = os.clock()
  assert(scene:run(file and { csv = file } or {}))
  return os.clock() - from, (steps + 1) * #bodies
end

local function median(list)
  table.sort(list)
  return list[(#list + 1) // 2]
end

print "case,rows,us_a_row,us_without_file,million_rows_a_second"
for _, case in ipairs { { "one ball", 1 }, { "a hundred balls", 100 }, { "a hundred that tumble", 100, true } } do
  local bodies, with, without, rows = balls(case[2], case[3]), {}, {}, nil
  for _ = 1, quick and 3 or 7 do
    with[#with + 1], rows = run(bodies, rows_wanted, work .. "/rows")
    without[#without + 1] = run(bodies, rows_wanted)
  end
  print(("%s,%d,%.3f,%.3f,%.2f"):format(case[1], rows, 1e6 * median(with) / rows, 1e6 * median(without) / rows, rows / median(with) * 1e-6))
end
os.remove(work .. "/rows.csv")
os.remove(work .. "/rows_events.csv")
