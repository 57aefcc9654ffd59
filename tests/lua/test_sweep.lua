-- SPDX-License-Identifier: MIT
--- Sweeps: which runs there are, and that however they are shared out, ended and begun again, the table is the same.
local check = require "check"
local runner = require "runner"
local impact = require "impact"
local sobol = require "impact.sobol"
local quote, folder = runner.quote, runner.folder
runner.clean()

local function none() return {} end

--- f(...), called from a line of Lua, must raise exactly `wanted`.
local function raises(wanted, f, ...)
  local given = table.pack(...)
  check.raises(wanted, function()
    local result = f(table.unpack(given, 1, given.n))
    return result
  end)
end

-- ---- Sobol's points ----

-- In each coordinate the first 2^m points lie one in each of 2^m equal parts, for every m: a (0, m, 1)-net.
for dimension = 1, sobol.dimensions do
  local directions = sobol.directions(dimension)
  for _, shift in ipairs { 0, 0x1234567890abc } do
    for m = 1, 10 do
      local seen = {}
      for i = 0, (1 << m) - 1 do seen[math.floor(sobol.coordinate(directions, i, shift) * (1 << m))] = true end
      local count = 0
      for _ in pairs(seen) do count = count + 1 end
      check.equal(count, 1 << m)
    end
  end
end
-- Sobol's property A: of the first 2^d points one is in each half of every coordinate, all together (to d = 16 here).
for dimension = 1, 16 do
  local axes, seen, count = {}, {}, 0
  for d = 1, dimension do axes[d] = sobol.directions(d) end
  for i = 0, (1 << dimension) - 1 do
    local octant = 0
    for d = 1, dimension do octant = octant << 1 | (sobol.coordinate(axes[d], i) >= 0.5 and 1 or 0) end
    if not seen[octant] then seen[octant], count = true, count + 1 end
  end
  check.equal(count, 1 << dimension)
end

-- ---- parameters ----

do -- the crossing: the last one made changes first; ends are met exactly
  local sweep = impact.sweep { runs = 2, scene = none, parameters = {
    b = impact.grid(0, 1, 3), a = impact.range(4, 1, -1), c = impact.values { "x", true, 2.5 }, d = impact.grid(1e-3, 1, 4, "log") } }
  check.equal(sweep:count(), 3 * 4 * 3 * 4 * 2)
  check.equal(table.concat(sweep:names(), " "), "b a c d")
  local i = 0
  for _, b in ipairs { 0.0, 0.5, 1.0 } do
    for a = 4, 1, -1 do
      for _, c in ipairs { "x", true, 2.5 } do
        for k, d in ipairs { 1e-3, 1e-2, 1e-1, 1.0 } do
          for _ = 1, 2 do
            local p = sweep:parameters(i)
            check.equal(p.b, b)
            check.equal(p.a, a)
            check.equal(p.c, c)
            if k == 1 or k == 4 then check.equal(p.d, d) else check.close(p.d, d, 1e-16) end
            i = i + 1
          end
        end
      end
    end
  end
  raises("sweep: there are runs 0 to 287, got 288", sweep.parameters, sweep, 288)
end

do -- random ones: in any order the same, even over [from, to), and neighbours have nothing in common
  local function make(seed)
    return impact.sweep { runs = 4096, seed = seed, scene = none, parameters = { x = impact.random(0, 1), y = impact.random(2, 4) } }
  end
  local sweep, other = make(1), make(2)
  local bins, products, last, equal = {}, 0, 0, 0
  for i = 0, 4095 do
    local p = sweep:parameters(i)
    bins[p.x * 16 // 1] = (bins[p.x * 16 // 1] or 0) + 1
    products = products + (p.x - 0.5) * (last - 0.5)
    last = p.x
    check.truth(p.y >= 2 and p.y < 4, "within")
    if other:parameters(i).x == p.x then equal = equal + 1 end
  end
  local chi = 0
  for k = 0, 15 do chi = chi + (bins[k] - 256) ^ 2 / 256 end
  check.truth(chi < 37.7, "chi square of 15 degrees, at 0.1 per cent: " .. chi)
  check.truth(math.abs(products / 4096) < 4 / 12 / 64, "correlation with the run before, 4 sigma: " .. products / 4096)
  check.equal(equal, 0)
  local a = sweep:parameters(77)
  local r = math.random()
  sweep:parameters(5)
  check.equal(sweep:parameters(77).x, a.x)
  check.equal(math.random(), r) -- the run's own stream, for its scene
end

-- Bad input is named.
raises("sweep: unknown key 'run'; there are: keep, name, on_event, parameters, plot, record, reduce, runs, scene, seed", impact.sweep,
  { run = 3, parameters = {}, scene = none })
raises("sweep: scene is missing", impact.sweep, { parameters = {} })
raises("sweep: runs must be a whole number, got 1.5", impact.sweep, { parameters = {}, scene = none, runs = 1.5 })
raises("sweep: runs must be at least 1, got 0", impact.sweep, { parameters = {}, scene = none, runs = 0 })
raises("sweep: parameter 'mu' must be of impact.grid, range, values, sobol or random, got a number", impact.sweep,
  { parameters = { mu = 3 }, scene = none })
raises("sweep: 'status' cannot be a parameter's name", impact.sweep, { parameters = { status = impact.range(1, 2) }, scene = none })
raises("sweep: more than 2147483647 runs", impact.sweep,
  { parameters = { a = impact.range(1, 10 ^ 5 // 1 | 0), b = impact.range(1, 10 ^ 5 // 1 | 0) }, scene = none })
raises("grid: both ends must be finite numbers, got 0 and inf", impact.grid, 0, 1 / 0, 3)
raises("grid: a logarithmic spacing needs ends of one sign, got 0 and 1", impact.grid, 0, 1, 3, "log")
raises("grid: the count must be a whole number from 1 on, got 2.5", impact.grid, 0, 1, 2.5)
raises("range: no numbers from 3 to 1 by 1", impact.range, 3, 1)
raises("values: value 2 must be a number, a string or a boolean, got a table", impact.values, { 1, {} })

-- ---- runs ----

local script = [[
local impact = require "impact"
return impact.sweep {
  seed = 5,
  parameters = { eps = impact.grid(0, 0.9, 4), spin = impact.sobol(-30, 30), x = impact.random(-1, 1), word = impact.values { "a,b", '=1+"2"' } },
  runs = RUNS,
  scene = function(p)
    if p.x > 0.97 then error "too far\tto the right\nfor me" end
    return { duration = 1.5, max_events = p.eps > 0.85 and 2 or nil, bodies = {
      impact.body { name = "ball", shape = impact.sphere(0.1), position = { p.x, 0, 0.5 }, omega = { 0, p.spin, math.random() } },
      impact.body { name = "floor", static = true, shape = impact.plane(), friction = 0.4, restitution = p.eps } } }
  end,
  reduce = function(run)
    local state, hits = run.scene:state "ball", run.events.impact
    for _ = 1, WORK do state = run.scene:state "ball" end
    return { z = state.position.z, hits = hits, right = run.parameters.x > 0, off = run.energy_off, late = run.parameters.x > 0.5 and run.t or nil }
  end,
  keep = function(run) return run.number == 3 end,
}
]]

local function write_script(runs, work)
  runner.write("sweep.lua", (script:gsub("RUNS", runs):gsub("WORK", work)))
end

local function sweep(options, out)
  return runner.command(string.format("sweep sweep.lua --out %s %s", out, options or ""))
end

local function clean(out) runner.shell("rm -rf " .. quote(folder .. "/" .. out)) end

write_script(60, 0)
local code, out, said = sweep("", "one")
check.equal(said, "")
check.equal(code, 0)
local whole = runner.read("one/sweep.csv")
check.truth(runner.exists("one/sweep_run_3.run"), "the run that is kept")

do -- the table itself
  local rows = require "quat.csv".rows(whole)
  check.equal(#rows, 4 * 2 * 60)
  check.equal(whole:match("^[^\n]*"), "run,eps,spin,x,word,hits,late,off,right,z,status,message")
  local failed, limited, spread = 0, 0, {}
  for i, row in ipairs(rows) do
    check.equal(row.run, i - 1)
    check.equal(row.word, (i - 1) // 60 % 2 == 0 and "a,b" or '=1+"2"')
    check.equal(row.status == "error", row.x > 0.97)
    if row.status == "error" then
      failed = failed + 1
      check.equal(row.z, "")
      check.truth(row.message:find("^sweep.lua:7: too far.*for me"), "message: " .. row.message)
    else
      limited = limited + (row.status == "event limit" and 1 or 0)
      check.equal(row.right, tostring(row.x > 0))
      check.equal(row.late == "", row.x <= 0.5)
      check.truth(row.off < 1e-12, "energy: " .. row.off)
    end
  end
  check.truth(failed > 0 and limited > 0, failed .. " failed, " .. limited .. " at their limit")
  check.truth(out:find(string.format("^sweep: 480 of 480 runs, %d failed; the first is run %%d+: sweep.lua:7: too far", failed)), out)
  local found = impact.open(folder .. "/one/sweep_run_3.run")
  check.truth(found, "the kept run is a recorded run")
end

local function same(folder_of)
  check.truth(runner.read(folder_of .. "/sweep.csv") == whole, folder_of .. ": the table is that of one thread, byte for byte")
end

check.equal((sweep("-j 2", "two")), 0)
same "two"
check.equal((sweep("-j7", "seven")) == 0, false) -- -jN is one word only with =
check.equal((sweep("-j=7", "seven")), 0)
same "seven"
for _, i in ipairs { 2, 0, 3, 1 } do
  local status, told = sweep(string.format("--shard %d/4", i), "shards")
  check.equal(status, 0)
  check.equal(runner.exists("shards/sweep.csv"), i == 1)
  check.truth(i == 1 or told:find("120 runs done here; %d+ of 480 are in shards: impact gather shards"), told)
end
same "shards"
-- Shards of several machines, put into one folder.
runner.shell(string.format("cd %s && mkdir far && cp shards/sweep.*-*.rows far", quote(folder)))
check.equal((runner.command("gather far")), 0)
same "far"
check.equal(runner.shell(string.format("cd %s && rm far/sweep.2-1.rows", quote(folder))), 0)
code, _, said = runner.command("gather far")
check.equal(code, 3)
check.equal(said, "impact: 'sweep' has 360 of 480 runs; the rest is to do\n")
check.truth(runner.exists("far/sweep.partial.csv"), "what there is")
check.equal((sweep("", "far")), 0)
same "far"
check.truth(not runner.exists("far/sweep.partial.csv"), "a whole table takes the partial one away")

local modules = runner.program:gsub("[^/]*$", "") .. "modules/impact/"
local function has(module) return runner.shell("test -e " .. quote(modules .. module)) == 0 end

-- what Open MPI leaks is its own
if has "sweep_mpi.so" and runner.shell("command -v mpirun >/dev/null") == 0 then
  local extra = runner.shell("mpirun --version | grep -q 'Open MPI'") == 0 and "--oversubscribe" or ""
  if runner.shell('test "$(id -u)" = 0') == 0 and extra ~= "" then extra = extra .. " --allow-run-as-root" end
  code = runner.shell(string.format("cd %s && env -u LD_PRELOAD ASAN_OPTIONS=detect_leaks=0 mpirun %s -n 4 %s sweep sweep.lua --out ranks --mpi >stdout.txt 2>stderr.txt </dev/null",
    quote(folder), extra, quote(runner.program)))
  if code ~= 0 then error(runner.read("stderr.txt")) end
  same "ranks"
else
  check.equal((sweep("--mpi", "ranks")), 2)
end
if has "sweep_hdf5.so" then
  check.equal((runner.command("gather one --hdf5")), 0)
  check.equal((runner.command("gather shards --hdf5")), 0)
  check.truth(runner.read("one/sweep.h5") == runner.read("shards/sweep.h5"), "HDF5, byte for byte")
  if runner.shell("command -v h5dump >/dev/null") == 0 then
    runner.shell(string.format("cd %s && h5dump -w 1 -m %%.17g -d /runs one/sweep.h5 >h5.txt", quote(folder)))
    local text, numbers, wanted = runner.read("h5.txt"), {}, {}
    for x in text:gmatch('(%-?[%d.]+e?[+-]?%d*),%s+"[a=][,1]') do numbers[#numbers + 1] = tonumber(x) end -- x stands before the word
    for _, row in ipairs(require "quat.csv".rows(whole)) do wanted[#wanted + 1] = row.x end
    check.equal(#numbers, 480)
    for i, x in ipairs(wanted) do if numbers[i] ~= x then error(string.format("row %d: %.17g in HDF5, %.17g in CSV", i, numbers[i], x)) end end
  end
else
  check.equal((runner.command("gather one --hdf5")), 2)
end

-- ---- ended and begun again ----

-- What is left of a part when its process dies at any instant of a write: every prefix of it; and parts that bytes were changed in.
do
  local part = runner.read("one/sweep.0-1.rows")
  math.randomseed(3)
  local function again(text, what)
    clean "torn"
    runner.shell("mkdir -p " .. quote(folder .. "/torn"))
    runner.write("torn/sweep.0-1.rows", text)
    local status, _, why = sweep("--quiet", "torn")
    if status ~= 0 then error(what .. ": " .. why) end
    same "torn"
  end
  for _ = 1, 20 do
    local size = math.random(0, #part)
    again(part:sub(1, size), size .. " bytes of a part")
    local at = math.random(60, #part)
    again(part:sub(1, at - 1) .. string.char(part:byte(at) ~ (1 << math.random(0, 6))) .. part:sub(at + 1), "byte " .. at .. " changed")
  end
end

-- Killed 20 times at random, and begun again: every fourth time late enough for rows to have been written, else amid the start.
do
  write_script(60, 12000) -- some milliseconds a run, so that it is not done before
  clean "killed"
  local killed = 0
  repeat
    local status = runner.shell(string.format("cd %s && env -u LD_PRELOAD timeout --preserve-status -s KILL %.2f %s sweep sweep.lua --out killed -j 2 --quiet",
      quote(folder), killed < 20 and (killed % 4 == 3 and 0.28 or 0.03) + 0.2 * math.random() or 500, quote(runner.program)))
    killed = killed + (status == 137 and 1 or 0)
    check.truth(status == 137 or status == 0, "killed or done: " .. status)
  until status == 0
  check.equal(killed, 20)
  same "killed"
end

-- Ended in order: signals and limits say how far it came, and the same command goes on.
do
  write_script(60, 8000)
  clean "ended"
  code, _, said = sweep("--max-time 0.3", "ended")
  check.equal(code, 5)
  check.truth(said:find("^impact: time limit of 0.3 s reached; %d+ of 480 runs done here, the same command goes on\n$"), said)
  code = runner.shell(string.format("cd %s && env -u LD_PRELOAD timeout --preserve-status -s INT 0.3 %s sweep sweep.lua --out ended 2>stderr.txt", quote(folder),
    quote(runner.program)))
  check.equal(code, 130)
  check.truth(runner.read("stderr.txt"):find("^impact: interrupted; %d+ of %d+ runs done here"), runner.read("stderr.txt"))
  check.equal((sweep("--max-disk 0.001", "full")), 5)
  check.equal((sweep("-j 2 --quiet", "ended")), 0)
  same "ended"
end

-- A script that does not come back is stopped all the same.
for _, body in ipairs { "while true do end", "pcall(function() while true do end end) return good()" } do
  runner.write("ever.lua", "local impact = require 'impact' local function good() return { duration = 0.1, bodies = { impact.body { name = 'b', " ..
    "shape = impact.sphere(1) } } } end return impact.sweep { parameters = { n = impact.range(1, 4) }, scene = function(p) if p.n < 3 then " ..
    "return good() end " .. body .. " end }")
  clean "ever"
  code, _, said = runner.command("sweep ever.lua --out ever -j 2 --max-time 0.7")
  check.equal(code, 5)
  check.equal(said, "impact: time limit of 0.7 s reached; 2 of 4 runs done here, the same command goes on\n")
end

-- ---- what goes wrong ----

local function refused(text, wanted, message, options, where)
  runner.write("bad.lua", text)
  local status, _, why = runner.command("sweep bad.lua --out " .. (where or "bad") .. " " .. (options or ""))
  check.equal(status, wanted)
  if not why:find(message) then error(string.format("wanted '%s', got %s", message, why), 2) end
end
local begin = "local impact = require 'impact' "
refused("return 3", 1, "^impact: bad.lua: a sweep needs a script that returns impact.sweep{%.%.%.}; this one returned a number\n$")
refused("error 'no'", 1, "^impact: bad.lua:1: no\n$")
refused(begin .. "return impact.sweep { parameters = {}, scene = function() error 'no' end }", 3, "every run of the sweep failed\n$")
refused(begin .. "return impact.sweep { name = 'a/b', parameters = {}, scene = function() end }", 1, "must be plain")
refused(begin .. "return impact.sweep { name = 'sweep', parameters = {}, scene = function() end }", 4, "holds rows of another sweep 'sweep'", "", "one")
refused("return", 2, "^impact: %-%-shard needs I/N with 0 <= I < N, got '4/4'", "--shard 4/4")
refused("return", 2, "^impact: %-j needs a number of threads, got '0'", "-j 0")
check.equal((runner.command("sweep.lua --shard 0/2")), 2)
check.equal((runner.command("gather nothing")), 2)
check.equal((runner.command("sweep absent.lua")), 1)
-- Errors of each place are rows of their own.
for place, message in pairs {
  ["scene = function() return 1 end"] = "sweep: scene must return a scene or its definition, got a number",
  ["scene = good, reduce = function() return 1 end"] = "sweep: reduce must return a table, got a number",
  ["scene = good, reduce = function() return { [1] = 1 } end"] = "sweep: '1' cannot be a result's name",
  ["scene = good, reduce = function() return { n = 1 } end"] = "sweep: 'n' cannot be a result's name",
  ["scene = good, reduce = function() return { a = {} } end"] = "sweep: the result 'a' must be a number, a string or a boolean, got a table",
  ["scene = good, reduce = function(r) return { a = r.energie } end"] = "a sweep's run has no 'energie'; there are: number",
} do
  runner.write("rows.lua", begin .. "local function good() return { duration = 0.1, bodies = { impact.body { name = 'b', shape = impact.sphere(1) } } } end " ..
    "return impact.sweep { parameters = { n = impact.range(1, 2) }, " .. place .. " }")
  clean "rows"
  local status = runner.command("sweep rows.lua --out rows")
  check.equal(status, 3)
  check.truth(runner.read("rows/rows.csv"):find(message, 1, true), place .. ": " .. runner.read("rows/rows.csv"))
end

-- What a run gives comes back in the table as it was: words that CSV, a spreadsheet or a part would trip over; numbers of both kinds in one column;
-- several kinds in one, which are text.
runner.write("cells.lua", begin .. [[
  local words = { 'a,b', 'say "no"', "two\nlines", "tab\there", "back\\slash", "return\rhere", "=1+1", "", "t" }
  local mixed = { 1, 2.5, "x", true, -3, 7, 8, 9, 10 }
  return impact.sweep { parameters = { n = impact.range(1, 9) }, scene = function() return { duration = 0.01, bodies = {
      impact.body { name = "b", shape = impact.sphere(1) } } } end,
    reduce = function(run) return { word = words[run.parameters.n], number = run.parameters.n % 2 == 0 and 0.5 or run.parameters.n, kinds = mixed[run.parameters.n] } end }]])
clean "cells"
check.equal((runner.command("sweep cells.lua --out cells")), 0)
local cells = table.concat({ "run,n,kinds,number,word,status,message", '0,1,1,1,"a,b"', '1,2,2.5,0.5,"say ""no"""', '2,3,x,3,"two\nlines"',
  "3,4,true,0.5,tab\there", "4,5,-3,5,back\\slash", '5,6,7,0.5,"return\rhere"', '6,7,8,7,"\'=1+1"', "7,8,9,0.5,", "8,9,10,9,t" }, ",end of time,\n")
  :gsub("message,end of time,", "message") .. ",end of time,\n"
check.equal(runner.read "cells/cells.csv", cells)

-- Parts whose first line is not ours, or whose later lines were cut or changed, count for nothing: the runs are made again, and the table is the same.
for _, damage in ipairs {
  "printf x > $f", "printf 'impact sweep 1 12\\nrows' > $f", "printf 'impact sweep 1 12 0 x\\n' > $f", "printf 'impact sweep 1 12 3x\\n' > $f",
  "truncate -s -5 $f", "sed -i 's/^@ [0-9]* /@ 99999 /' $f", "sed -i 's/^@ \\([0-9]*\\) ./@ \\1 x/' $f", "sed -i 's/^@ .*/&y/' $f", ": > $f" } do
  clean "cells"
  check.equal((runner.command("sweep cells.lua --out cells --shard 0/2 --quiet")), 0)
  check.equal(runner.shell("cd " .. quote(folder) .. " && for f in cells/*.rows; do " .. damage .. "; done"), 0)
  check.equal((runner.command("sweep cells.lua --out cells --quiet")), 0)
  check.equal(runner.read "cells/cells.csv", cells)
end

-- However little may be written, a sweep says that it is that, with exit code 5, or is whole.
local ends = {}
for _, bytes in ipairs { 10, 60, 200, 700, 1200, 1e5 } do
  clean "cells"
  local status, _, said = runner.command(string.format("sweep cells.lua --out cells --quiet --max-disk %.9f", bytes / 1048576))
  ends[status] = true
  check.equal(status == 5 and said:find "disk limit of" ~= nil or status == 0 and runner.exists "cells/cells.csv", true)
end
check.truth(ends[5] and ends[0], "both ends are met")

check.report("sweep")
