-- SPDX-License-Identifier: MIT
--- However a run ends: its exit code, one line that says why and how far it came, its rows kept as partial files, and no other
--- file left.
local check = require "check"
local runner = require "runner"
local has_cvode = require "impact".has "cvode"
runner.clean()

local partial = "long.partial.csv long_events.partial.csv"

--- A scene that goes on for ever: 'long', one ball, one row a millisecond.
local function long(more)
  return "local impact = require 'impact' return impact.scene { name = 'long', duration = 1e7, output_rate = 1000, " .. (more or "") ..
    " bodies = { impact.body { name = 'ball', shape = impact.sphere(1) } } }"
end

--- The rows of a partial file: whole lines, in order of time; how far they come.
local function rows_of(name)
  local text = runner.read("o/" .. name)
  check.equal(text:sub(-1), "\n")
  local last, count = -1, 0
  for line in text:gmatch("[^\n]+") do
    local t = tonumber(line:match("^([^,]*),"))
    if count > 0 then check.truth(t and t >= last, "rows in order: " .. line) end
    last, count = t or last, count + 1
  end
  return last, count
end

--- The end of a run that did not come to its own.
local function ends(code, out, said, wanted, message, files)
  if code ~= wanted then error(string.format("wanted exit code %d, got %d: %s", wanted, code, said), 2) end
  check.equal(out, "")
  check.equal(select(2, said:gsub("\n", "\n")), 1) -- one line
  if not said:find("^impact: " .. message) then error(string.format("wanted '%s', got %s", message, said), 2) end
  check.equal(runner.files(), files)
  if files == partial then
    local t = tonumber(said:match("; the run came to t = ([%d.e+-]+) of 1e%+07 s, its rows are in o/long%.partial%.csv and o/long_events%.partial%.csv\n$"))
    check.truth(t, "how far: " .. said)
    local last = rows_of("long.partial.csv")
    check.truth(last > 0 and last <= t * (1 + 1e-5) + 1e-9, string.format("rows to %g of a run to %g", last, t))
  end
end

-- Limits.
for _, quiet in ipairs { "", "--quiet " } do
  local code, out, said = runner.script(long(), quiet .. "--max-time 0.3")
  ends(code, out, said, 5, "time limit of 0%.3 s reached; the run", partial)
  code, out, said = runner.script(long(), quiet .. "--max-disk 0.5")
  ends(code, out, said, 5, "disk limit of 0%.5 MB reached; the run", partial)
  local size = #runner.read("o/long.partial.csv") + #runner.read("o/long_events.partial.csv")
  check.truth(size <= 0.5 * 1048576 and size > 0.4 * 1048576, "bytes on the disk: " .. size)
  local bounce = "local impact = require 'impact' return impact.scene { name = 'long', duration = 1e7, max_events = 3, bodies = { " ..
    "impact.body { name = 'ball', shape = impact.sphere(0.1), position = { 0, 0, 1 }, restitution = 0.9 }, " ..
    "impact.body { name = 'floor', static = true, shape = impact.plane(), restitution = 1 } } }"
  code, out, said = runner.script(bounce, quiet)
  ends(code, out, said, 5, "3 events by t = .*: the limit; the run", partial)
  check.equal(select(2, rows_of("long_events.partial.csv")), 4)
end
do -- what a script writes itself draws on the same quota, however many files are open
  local code, _, said = runner.script("local f, g = assert(io.open('a', 'w')), assert(io.open('b', 'w')) local line = ('x'):rep(1000) " ..
    "for i = 1, 1000 do if not (f:write(line) and g:write(line)) then break end end f:close() g:close() " ..
    "assert(not require 'quat.csv'.save('c', { 'x' }, { { ('y'):rep(2e5) } })) error 'over'", "--max-disk 0.25")
  check.equal(code, 5)
  check.equal(said, "impact: disk limit of 0.25 MB reached\n")
  local size = #runner.read("o/a") + #runner.read("o/b")
  check.truth(size <= 0.25 * 1048576 and size > 0.2 * 1048576, "bytes on the disk: " .. size)
  check.equal(runner.files(), "a b")
end

-- A disk that is full: here a bound on each file, which the system sets.
do
  runner.shell("rm -rf " .. runner.quote(runner.folder .. "/o"))
  runner.write("script.lua", long())
  local code = runner.shell(string.format("cd %s && (ulimit -f 100; exec env -u LD_PRELOAD %s script.lua --out o >stdout.txt 2>stderr.txt)",
    runner.quote(runner.folder), runner.quote(runner.program)))
  ends(code, runner.read("stdout.txt"), runner.read("stderr.txt"), 4, "cannot write the rows: File too large; the run", partial)
end

-- The script's functions, called from inside a run.
if has_cvode then
  local law = "forces = { impact.force { law = function(t, b) if t > 2 then %s end return { 0, 0, 0 } end } },"
  local code, out, said = runner.script(long(law:format("error 'enough'")))
  ends(code, out, said, 1, "script%.lua:1: enough; the run", partial)
  code, out, said = runner.script(long(law:format("return { 0 / 0, 0, 0 }")))
  ends(code, out, said, 1, "script%.lua:1: force 'force': the force must be a vector .*; the run", partial)
  -- v' = v^2 from 1 leaves every bound at t = 1.
  local blow_up = long("forces = { impact.force { law = function(t, b) return { b.velocity.x ^ 2, 0, 0 } end } },"):gsub("impact.sphere%(1%)",
    "%0, mass = 1, velocity = { 1, 0, 0 }")
  code, out, said = runner.script(blow_up)
  ends(code, out, said, 3, "the integrator cannot go on: .*, at t = %S+, where body .ball. .*; the run", partial)
end
do
  local text = long():gsub("return impact%.scene", "local scene = impact.scene") ..
    " scene:run { csv = 'long', on_sample = function(s) if s.t > 1 then error 'enough' end end }"
  local code, out, said = runner.script(text)
  ends(code, out, said, 1, "script%.lua:1: enough; the run", partial)
end

-- Memory: everything that a scene and its script hold.
do
  local code, out, said = runner.script("local impact = require 'impact' local bodies = {} for i = 1, 3000 do bodies[i] = impact.body { " ..
    "name = 'b' .. i, shape = impact.sphere(0.1), position = { i, 0, 0 } } end return impact.scene { duration = 1, bodies = bodies }",
    "--max-memory 4")
  ends(code, out, said, 5, "memory limit of 4 MB reached\n", "")
end

-- Signals: in order, at the next step; what is killed leaves nothing, where the file system has files without a name.
for signal, code in pairs { INT = 130, TERM = 143, HUP = 129, QUIT = 131 } do
  local got, out, said = runner.signalled(long(), signal, 0.5)
  ends(got, out, said, code, signal == "INT" and "interrupted; the run" or "ended by signal %d+, %a+; the run", partial)
  got, out, said = runner.signalled("while true do pcall(coroutine.wrap(function() while true do end end)) end", signal, 0.3)
  ends(got, out, said, code, signal == "INT" and "interrupted\n" or "ended by signal %d+, %a+\n", "")
end
do
  local got = runner.signalled(long(), "KILL", 0.5)
  check.equal(got, 137)
  local files = runner.files()
  check.truth(files == "" or files == "long.csv.part long_events.csv.part", "nothing, or files that say that they are not whole: " .. files)
end

do -- what does not stop in order is ended by a second signal, a second after the first; not sooner
  local busy = "string.find(('a'):rep(400), ('.-'):rep(12) .. 'b')"
  runner.write("script.lua", busy)
  local code = runner.shell(string.format("cd %s && { env -u LD_PRELOAD %s script.lua --out o >stdout.txt 2>stderr.txt & p=$!; sleep 0.3; kill -TERM $p; " ..
    "kill -TERM $p; sleep 2.2; kill -0 $p || exit 99; kill -TERM $p; wait $p; }", runner.quote(runner.folder), runner.quote(runner.program)))
  check.equal(code, 143)
  check.equal(runner.read "stderr.txt", "\nimpact: ended by a second signal, before the run could stop in order\n")
end
do -- a signal that was ignored before, as nohup has it, stays so
  runner.write("script.lua", (long():gsub("1e7", "2e4")))
  local code = runner.shell(string.format("cd %s && { trap '' HUP; env -u LD_PRELOAD %s script.lua --quiet --out o --max-time 1 & p=$!; sleep 0.3; kill -HUP $p; wait $p; } 2>stderr.txt",
    runner.quote(runner.folder), runner.quote(runner.program)))
  check.truth(code == 0 or code == 5, "not ended by SIGHUP: " .. tostring(code))
  check.truth(not runner.read "stderr.txt":find "signal", runner.read "stderr.txt")
end
do -- the shortest time there is
  local code, _, said = runner.script("while true do end", "--max-time 1e-9")
  check.equal(code, 5)
  check.equal(said, "impact: time limit of 1e-09 s reached\n")
end
for _, kilobytes in ipairs { 4000000, 400000 } do -- memory that the system bounds already
  runner.write("script.lua", "print 'done'")
  local code = runner.shell(string.format("cd %s && (ulimit -v %d; exec env -u LD_PRELOAD %s script.lua --out o --max-memory 500 >stdout.txt 2>stderr.txt)",
    runner.quote(runner.folder), kilobytes, runner.quote(runner.program)))
  check.equal(code, 0)
  check.equal(runner.read "stdout.txt", "done\n")
end

-- A whole run takes the partial files away.
do
  runner.write("script.lua", long())
  check.equal(runner.command("script.lua --out o --max-time 0.3"), 5)
  local short = long():gsub("1e7", "1")
  runner.write("script.lua", short)
  check.equal(runner.command("script.lua --out o --quiet"), 0)
  check.equal(runner.files(), "long.csv long_events.csv")
end

-- The kernel's fence, where there is one; a word says so where there is none.
do
  runner.write("script.lua", "print 'done'")
  local code, _, said = runner.command("script.lua --out o --fence")
  check.truth(code == 0 and said == "" or code == 3 and said:find("^impact: not fenced: [^\n]+\n$"), "fenced or told: " .. said)
  local fenced = code == 0
  runner.write("script.lua", (long():gsub("1e7", "0.01")))
  local _, out = runner.command("script.lua --out o")
  check.equal(out:find("\n  not fenced ", 1, true) == nil, fenced)
  check.equal(runner.command("script.lua --out o --fence --trust"), 2)
end
do -- a folder that nothing was written to is not left
  runner.write("script.lua", "io.write 'done'")
  check.equal(runner.command("script.lua --out new"), 0)
  check.truth(not runner.exists("new"), "no empty folder")
end

-- A script that returns nothing has done its work itself, or says that it has not.
do
  local ball = "local impact = require 'impact' local scene = impact.scene { duration = 1, bodies = { impact.body { name = 'ball', shape = impact.sphere(1) } } } "
  for _, idle in ipairs { "", "return", ball } do
    local code, _, said = runner.script(idle)
    check.equal(code, 1)
    check.equal(said, "impact: script.lua: the script returned nothing, ran nothing and wrote nothing: is `return` missing before impact.scene{...}?\n")
  end
  for _, busy in ipairs { "print(1)", "io.write(1)", "io.stdout:write(1)", "io.open('a', 'w'):write(1)", ball .. "scene:run()", ball .. "scene:step()",
    "assert(require 'quat.csv'.save('a', { 'x' }, { { 1 } }))" } do
    check.equal((runner.script(busy)), 0)
  end
end

-- Saved at a time and after events, and gone on from there: the rows together are those of one run, byte for byte.
do
  local bounce = "local impact = require 'impact' return impact.scene { name = 'long', duration = DURATION, output_rate = 50, bodies = { " ..
    "impact.body { name = 'ball', shape = SHAPE, position = { 0, 0, 1 }, velocity = { 1, 0, 0 }, omega = { 3, 4, 5 }, restitution = 0.8 }, " ..
    "impact.body { name = 'floor', static = true, shape = impact.plane(), restitution = 0.8 } } }"
  local function rows(name, from) -- of a CSV file, those after a time
    local kept = {}
    for line in runner.read(name):gmatch "[^\n]+" do
      if (tonumber(line:match "^[^,]*") or 0) > from then kept[#kept + 1] = line end
    end
    return table.concat(kept, "\n")
  end
  for _, shape in ipairs { "impact.sphere(0.1)", has_cvode and "impact.ellipsoid { a = 0.1, b = 0.12, c = 0.15 }" } do
    local text = bounce:gsub("SHAPE", shape):gsub("DURATION", "4")
    check.equal((runner.script(text, "--quiet --save 1.3 half")), 0)
    check.equal(runner.files(), "half long.csv long_events.csv")
    check.equal((runner.command("script.lua --quiet --out p --resume o/half")), 0)
    for _, name in ipairs { "long.csv", "long_events.csv" } do check.equal(rows("p/" .. name, 0), rows("o/" .. name, 1.3)) end
    local code, _, complained = runner.script(text, "--quiet --save 9 never")
    check.equal(code, 4)
    check.equal(complained, "impact: nothing is saved as 'never': the run ended before t = 9 s\n")
  end
  -- A run that is killed leaves its last checkpoint; the run that goes on from there ends as one does that was not.
  local text = bounce:gsub("SHAPE", "impact.sphere(0.1)"):gsub("DURATION", "2e4"):gsub("0.8 }", "1 }"):gsub("output_rate = 50", "output_rate = 1e-4")
  runner.write("script.lua", text)
  check.equal((runner.command("script.lua --quiet --out q --max-time 60 --checkpoint 0.05")), 0)
  runner.shell(string.format("cd %s && env -u LD_PRELOAD timeout -s KILL 0.6 %s script.lua --out killed --checkpoint 0.05 --quiet 2>/dev/null",
    runner.quote(runner.folder), runner.quote(runner.program)))
  if runner.exists "killed/long.save" then
    check.equal((runner.command("script.lua --quiet --out r --resume killed/long.save")), 0)
    local last = runner.read("q/long.csv"):match "[^\n]*\n$"
    check.equal(runner.read("r/long.csv"):match "[^\n]*\n$", last)
  end
  check.truth(not runner.exists "q/long.save", "a run that came to its end leaves no checkpoint")
  local function refused(options, wanted, message)
    local code, _, said = runner.command("script.lua --out s " .. options)
    check.equal(code, wanted)
    check.truth(said:find(message), said)
  end
  refused("--resume script.lua", 1, "^impact: cannot go on from script.lua: scene 'long' cannot go on from these bytes: they are no saved scene\n$")
  runner.write("empty", "")
  refused("--resume empty", 1, "^impact: cannot read empty: it is empty\n$")
  refused("--resume .", 1, "^impact: cannot read .: Is a directory\n$")
  refused("--max-memory 1e9", 2, "'1e9' is not a positive number below 1e9")
  refused("--resume absent", 1, "^impact: cannot read absent: No such file or directory\n$")
  refused("--save 1 a/b", 2, "plain name of a file, got 'a/b'")
  refused("--save soon a", 2, "'soon' is no time")
  refused("--checkpoint 0", 2, "'0' is not a positive number")
end

-- The list of codes.
do
  local _, out = runner.command("--help")
  for _, code in ipairs { "0  done", "1  the script", "2  the command", "3  the run", "4  an output", "5  a limit", "6  done, but", "128 %+ N" } do
    check.truth(out:find("\n  " .. code), "--help tells: " .. code)
  end
end

-- However little may be written, what is asked for is whole or is not there; and a limit that was reached is told, with exit code 5.
do
  runner.write("small.lua", [[
    local impact, plot = require "impact", require "quat.plot"
    local written, why = require "quat.host".write("words", ("word\n"):rep(100))
    if not written then error(why, 0) end
    return impact.scene { name = "small", duration = 0.3, plot = function() return plot.figure { plot.panel { plot.line { { 1, 2 }, { 1, 4 } } } } end,
      bodies = { impact.body { name = "floor", shape = impact.plane(), restitution = 1 },
        impact.body { name = "ball", shape = impact.sphere(0.1), position = { 0, 0, 0.3 }, restitution = 0.9 } } }]])
  local names, ends, sizes = { "small.csv", "small_events.csv", "words", "half", "small.run" }, {}, {}
  for _, bytes in ipairs { 1e8, 100, 499, 501, 1000, 1500, 4000, 6000, 8000, 12000, 16000, 24000 } do
    runner.shell("cd " .. runner.quote(runner.folder) .. " && rm -rf o")
    local status, _, said = runner.command(string.format("small.lua --out o --quiet --record --save 0.2 half --max-disk %.9f", bytes / 1048576))
    for _, name in ipairs(names) do
      local got = runner.read("o/" .. name)
      sizes[name] = sizes[name] or got and #got
      check.truth(not got or #got == sizes[name], name .. " is whole")
    end
    ends[status] = true
    check.truth(status == 5 and said:find "disk limit of" or status == 0 and not said:find "limit", status .. ": " .. said)
  end
  check.truth(ends[0] and ends[5], "both ends are met")
end

-- A body of infinite curvature under one that has none: the integrator asked for 578000 steps in fifty microseconds, and no pile took over.
do
  local impact = require "impact"
  local scene = impact.scene { gravity = { 0, 0, -9.81 }, duration = 1.5, law = "poisson", max_steps = 60000, output_rate = 0, bodies = {
    impact.body { name = "floor", shape = impact.plane(), friction = 1, restitution = 1 },
    impact.body { name = "under", shape = impact.superellipsoid { a = .13, b = .13, c = .13, eps1 = 1.5, eps2 = 1 }, mass = 4, friction = .3, restitution = 0,
      position = { 0.0085841617796441512, 0.032592960507182113, 0.5 }, velocity = { 0.1203784701008791, 0.40491335131885631, 0 },
      omega = { 1.5122829557190025, 1.4079227901025737, 3.1093348960591314 },
      orientation = { 0.81760763062695974, 0.28648969436282051, -0.18205168285399886, -0.46507913534633405 } },
    impact.body { name = "over", shape = impact.superquadric { a = 0.13599882231157, b = 0.092556333748722, c = 0.13599882231157, r = 1.5, s = 2, t = 8 }, mass = 6,
      friction = .3, restitution = 0, position = { -0.023516769333731015, 0.04279163112229574, 1 }, velocity = { -0.18316748196652377, 0.232725078231104, 0 },
      omega = { 3.0716511239463999, -1.3942863239122172, -0.78268075728936637 },
      orientation = { 0.64642536062532774, -0.57714507591390718, 0.40530799325929323, -0.29114128028994773 } } } }
  check.equal(scene:run(), "end of time")
  check.truth(scene:usage().pile_steps > 0, "by steps")
end

check.report("ends")
