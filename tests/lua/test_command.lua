-- SPDX-License-Identifier: MIT
--- The runner's command lines, each wrong one with its words; what a script may be called, may be, may return and may raise; a sweep's folder with
--- what is not its own.
local check = require "check"
local runner = require "runner"
runner.clean()

local function run(line, wanted, said)
  local code, out, err = runner.command(line)
  if code ~= wanted then error(string.format("%s: wanted exit code %d, got %d: %s%s", line, wanted, code, out, err), 2) end
  local text = wanted == 0 and out or err
  if said and not text:find(said) then error(string.format("%s: wanted '%s', got %s", line, said, text), 2) end
  check.truth(true)
  return out, err
end

local begin = "local impact = require 'impact' "
local ball = "impact.body { name = 'ball', shape = impact.sphere(0.1), position = { 0, 0, 1 } }"
local drop = begin .. "return impact.scene { duration = 0.1, bodies = { " .. ball .. " } }"
runner.write("drop.lua", drop)

-- ---- wrong ones ----

local wrong = {
  [""] = "^usage: impact SCRIPT.lua",
  ["drop.lua other.lua"] = "one script at a time: 'other.lua' is too many",
  ["--bogus drop.lua"] = "unknown option '%-%-bogus'",
  ["drop.lua --out"] = "%-%-out needs a value", ["drop.lua --out="] = "%-%-out needs a value",
  ["drop.lua --max-time"] = "%-%-max%-time needs a value",
  ["drop.lua --save"] = "%-%-save needs a value",
  ["drop.lua --save 1"] = "plain name of a file, got ''", ["drop.lua --save 1 .hidden"] = "got '.hidden'",
  ["drop.lua -j 2"] = "are options of sweep", ["drop.lua --shard 0/2"] = "are options of sweep",
  ["drop.lua --mpi"] = "are options of sweep", ["drop.lua --hdf5"] = "are options of sweep", ["gather o --mpi"] = "are options of sweep",
  ["drop.lua --fence --trust"] = "%-%-fence and %-%-trust exclude", ["sweep drop.lua --fence --mpi"] = "%-%-fence and %-%-mpi exclude",
  ["sweep drop.lua --shard 0/2 --mpi"] = "%-%-shard and %-%-mpi exclude",
  ["sweep drop.lua --record"] = "is no option of sweep",
  ["drop.lua --seconds 3"] = "is the report's",
  ["drop.lua --tolerance 1"] = "is view's and gltf's", ["drop.lua --frame-rate 24"] = "is gltf's", ["view drop.lua --frame-rate 24"] = "is gltf's",
  ["sweep drop.lua --verify"] = "is of one scene's run from its start",
}
for _, number in ipairs { "nan", "inf", "-1", "0", "1x", "x", "1e9", "''", "1e400" } do
  for _, option in ipairs { "--max-time", "--max-memory", "--max-disk", "--checkpoint", "--report --seconds" } do
    wrong["drop.lua " .. option .. " " .. number] = number == "''" and "needs a value" or "is not a positive number"
  end
end
for _, shard in ipairs { "1", "x/2", "1/", "1/0", "1/2x", "-1/2", "2/2", "1/1000001", "1000001/1000002", "/2" } do
  wrong["sweep drop.lua --shard " .. shard] = "%-%-shard needs I/N with 0 <= I < N"
end
for _, threads in ipairs { "0", "-1", "x", "1.5", "1000001" } do wrong["sweep drop.lua -j " .. threads] = "%-j needs a number of threads" end
for _, time in ipairs { "x", "1x", "-1", "nan", "inf", "1e300" } do wrong["drop.lua --save " .. time .. " a"] = "is no time" end
for _, more in ipairs { "--save 1 a", "--resume a", "--checkpoint 1" } do
  for _, command in ipairs { "sweep drop.lua ", "gather o " } do wrong[command .. more] = "are of one scene's run" end
  wrong["drop.lua --report " .. more] = "makes no run"
end
for _, line in ipairs { "drop.lua --report --record", "sweep drop.lua --report", "gather o --report", "view drop.lua --report" } do
  wrong[line] = "makes no run"
end
for line, said in pairs(wrong) do run(line, 2, said) end
check.truth(not runner.exists "out", "a wrong line makes no folder")

-- ---- right ones ----

local help = run("--help", 0, "^usage: impact SCRIPT.lua")
check.equal(run("drop.lua -h", 0), help)
check.truth(run("--version", 0):find "^impact %d+%.%d+%.%d+ %(Lua 5%.4%.%d+; CVODE: %a+, libccd: %a+%)\n$")
run("drop.lua --quiet --max-time=9 --max-memory=50 --max-disk=5 --out=o///", 0)
check.equal(runner.files(), "drop.csv drop_events.csv")
runner.shell("cd " .. runner.quote(runner.folder) .. " && mkdir -p sub && cp drop.lua sub/toss && cp drop.lua sub/a.b.lua && rm -rf o")
run("sub/toss --out o --quiet", 0)
run("sub/a.b.lua --out o --quiet", 0)
check.equal(runner.files(), "a.b.csv a.b_events.csv toss.csv toss_events.csv")
runner.write(".lua", drop)
run(".lua --out o", 1, "the scene's name '.lua' names the files: it must be plain")
run("absent.lua --out o", 1, "cannot open absent.lua")
run("- --out o", 1, "cannot open %-")
run("drop.lua --out " .. ("d/"):rep(2100), 4, "cannot write to the folder 'd/")
run("drop.lua --out drop.lua/x/y", 4, "cannot write to the folder 'drop.lua/x/y': Not a directory")
for _, name in ipairs { "a\\nb", "a\\127b", "a/b", ".a" } do
  runner.write("named.lua", (drop:gsub("duration", "name = '" .. name .. "', duration")))
  run("named.lua --out o", 1, "names the files: it must be plain")
end
run("drop.lua --out o --max-memory 0.001", 5, "the memory limit is too small to start")
local full = runner.shell(string.format("cd %s && test -c /dev/full && %s drop.lua --out o >/dev/full 2>stderr.txt", runner.quote(runner.folder),
  runner.quote(runner.program)))
check.truth(full == 1 or (full == 4 and runner.read "stderr.txt" == "impact: cannot write to the standard output: No space left on device\n"))

-- ---- a runner whose parts are not beside it, or are none ----

do
  local here, program = runner.quote(runner.folder), runner.quote(runner.program)
  runner.shell(string.format("cd %s && rm -rf alone && mkdir alone && cp %s alone/impact", here, program))
  local function alone(text, wanted, said, line)
    runner.write("part.lua", text)
    local code = runner.shell(string.format("cd %s && env -u LD_PRELOAD alone/impact %s --out p >stdout.txt 2>stderr.txt </dev/null", here, line or "part.lua"))
    local err = runner.read "stderr.txt"
    if code ~= wanted or not err:find(said) then error(string.format("alone: wanted exit code %d and '%s', got %d and %s", wanted, said, code, err), 2) end
    check.truth(true)
  end
  local springy = begin .. "return impact.scene { duration = 0.2, law = 'stronge', compliance = 1.2, bodies = { " ..
    "impact.body { name = 'floor', shape = impact.plane(), friction = 1, restitution = 1 }, impact.body { name = 'ball', shape = impact.sphere(0.1), " ..
    "position = { 0, 0, 0.15 }, velocity = { 1, 0, 0 }, omega = { 0, 30, 0 }, friction = 0.3, restitution = 0.8 } } }"
  local sweep = begin .. "return impact.sweep { runs = 1, scene = function() return { duration = 0.1, bodies = { " .. ball .. " } } end }"
  local gsl = "require 'quat.gsl'"
  alone(drop, 0, "^$")
  alone(drop, 0, "^$", "--version")
  check.truth(runner.read "stdout.txt":find "CVODE: no, libccd: no%)\n$", runner.read "stdout.txt")
  alone(springy, 1, "compliance needs CVODE, and this program has none")
  alone(sweep, 2, "this build holds no sweep_hdf5", "sweep part.lua --hdf5")
  alone(sweep, 2, "this build holds no sweep_mpi", "sweep part.lua --mpi")
  alone(gsl, 1, "quat.gsl")
  runner.shell("cd " .. here .. " && mkdir -p alone/modules/impact alone/modules/quat && for f in impact/cvode impact/ccd impact/sweep_hdf5 impact/sweep_mpi quat/gsl; " ..
    "do echo 'no library' >alone/modules/$f.so; done")
  alone(drop, 0, "^$")
  alone(springy, 1, "compliance needs CVODE, and this program has none")
  alone(sweep, 2, "alone/modules/impact/sweep_hdf5.so: file too short", "sweep part.lua --hdf5")
  alone(gsl, 1, "quat.gsl: .*alone/modules/quat/gsl.so: file too short")
end

-- ---- names that are taken by folders, and folders that cannot be ----

do
  local here = runner.quote(runner.folder)
  local written = "local said = {} local function try(what, ok, why) said[#said + 1] = what .. ': ' .. tostring(ok) .. ' ' .. tostring(why) end " ..
    "local plot, host = require 'quat.plot', require 'quat.host' " ..
    "try('picture', plot.save(plot.figure { plot.panel { plot.line { { 1, 2 }, { 1, 2 } } } }, 'taken')) try('text', host.write('taken', 'words')) print(table.concat(said, '\\n'))"
  runner.write("taken.lua", written)
  runner.shell("cd " .. here .. " && rm -rf o bin && mkdir -p o/taken o/taken.png bin")
  runner.write("bin/gnuplot", "#!/bin/sh\ncat >/dev/null; echo picture\n")
  local function said_of(options)
    local code = runner.shell(string.format("cd %s && chmod +x bin/gnuplot && env -u LD_PRELOAD PATH=\"$PWD/bin:$PATH\" %s taken.lua %s >stdout.txt 2>stderr.txt </dev/null",
      here, runner.quote(runner.program), options))
    return code, runner.read "stdout.txt", runner.read "stderr.txt"
  end
  local code, out, err = said_of "--out o"
  check.equal(code, 0)
  check.equal(err, "")
  -- (the kernel's fence refuses it before the file system does)
  check.equal((out:gsub("Permission denied", "Is a directory")),
    "picture: nil cannot write 'o/taken.png': Is a directory\ntext: nil cannot write 'o/taken': Is a directory\n")
  code, out = said_of "--out taken.lua/o"
  check.equal(code, 0)
  for what in out:gmatch "[^\n]+" do check.truth(what:find "nil cannot write to the folder 'taken.lua/o': Not a directory$", what) end
  code, out = said_of "--out o/new --max-disk 0.000002"
  check.equal(code, 0)
  check.equal(out, "picture: nil cannot write 'o/new/taken.png': the disk limit is reached\ntext: nil cannot write 'o/new/taken': the disk limit is reached\n")
  code = runner.shell(string.format("cd %s && { %s wrong.lua --out o >/dev/full; } 2>stderr.txt", here, runner.quote(runner.program)))
  check.truth(code == 1, "an error of the script comes before one of the output: " .. code)
end

-- ---- a gnuplot that fails ----

do
  local here = runner.quote(runner.folder)
  runner.shell("cd " .. here .. " && mkdir -p bin")
  runner.write("drawn.lua", begin .. "return impact.scene { name = 'drawn', duration = 0.1, bodies = { " .. ball .. " }, " ..
    "plot = function() local plot = require 'quat.plot' return plot.figure { plot.panel { plot.line { { 1, 2 }, { 1, 2 } } } } end }")
  local function drawn_by(gnuplot, wanted, said, options)
    runner.write("bin/gnuplot", "#!/bin/sh\n" .. gnuplot .. "\n")
    local code = runner.shell(string.format("cd %s && chmod +x bin/gnuplot && rm -rf o && env -u LD_PRELOAD PATH=\"$PWD/bin:$PATH\" %s drawn.lua --quiet --out o %s " ..
      ">stdout.txt 2>stderr.txt </dev/null", here, runner.quote(runner.program), options or ""))
    local err = runner.read "stderr.txt"
    if code ~= wanted or not err:find(said) then error(string.format("%s: wanted exit code %d and '%s', got %d and %s", gnuplot, wanted, said, code, err), 2) end
    check.truth(runner.exists "o/drawn.csv", "the rows are there")
    check.equal(runner.exists "o/drawn.png", wanted == 0)
  end
  drawn_by("cat >/dev/null; echo picture", 0, "^$")
  drawn_by("cat >/dev/null; exit 0", 4, "^impact: no picture: gnuplot failed\n$")
  drawn_by("echo half; exit 1", 4, "^impact: no picture: gnuplot failed\n$")
  drawn_by("echo half; echo 'first complaint' >&2; echo 'line 0: no such thing' >&2; echo '    ^' >&2; echo >&2; exit 1", 4,
    "^impact: no picture: gnuplot: line 0: no such thing\n$")
  drawn_by("echo half; kill -KILL $$", 4, "^impact: no picture: gnuplot failed\n$")
  drawn_by("exec head -c 3000000 /dev/zero", 5, "^impact: disk limit of 1 MB reached\n$", "--max-disk 1")
  local here_too = runner.quote(runner.program)
  runner.write("bin/gnuplot", "#!/bin/sh\nexec head -c 3000000 /dev/zero\n") -- where it is the system that bounds files
  check.equal(runner.shell(string.format("cd %s && rm -rf o && (ulimit -f 1000; exec env -u LD_PRELOAD PATH=\"$PWD/bin:$PATH\" %s drawn.lua --quiet --out o >stdout.txt 2>stderr.txt)",
    here, here_too)), 4)
  check.equal(runner.read "stderr.txt", "impact: no picture: cannot write 'o/drawn.png': File too large\n")
  drawn_by("exec sleep 30", 5, "^impact: time limit of 1.5 s reached", "--max-time 1.5")
end

-- ---- what a script is, returns and raises ----

local function script(text, wanted, said, options)
  runner.write("s.lua", text)
  return run("s.lua --out o " .. (options or ""), wanted, said)
end
script("error {}", 1, "the script raised an error that is not a text")
script("error(nil)", 1, "the script raised an error that is not a text")
script("error 'it has not enough memory'", 5, "^impact: not enough memory\n$")
script("return 3", 1, "a script returns a scene, impact.scene{...}, or nothing; this one returned a number")
script("return", 1, "ran nothing and wrote nothing")
script("return impact.", 1, "s.lua:1:")
script("\27Lua", 1, "attempt to load a binary chunk")
script("-- done\nlocal f = io.open('done', 'w') f:write 'x' f:close() print 'done'", 0)
for _, made in ipairs { "view", "gltf" } do
  runner.write("s.lua", "local x = 1")
  run(made .. " s.lua --out o", 1, "needs a script that returns a scene")
  runner.write("s", "local x = 1")
  run(made .. " s --out o", 1, "needs a script that returns a scene") -- a name shorter than a record's ending
end
run("drop.lua --quiet --out made/o/p", 0)
check.truth(runner.exists "made/o/p/drop.csv")
run("drop.lua --out drop.lua/o/p", 4, "cannot write to the folder 'drop.lua/o/p': Not a directory")
runner.write("s.lua", "print 'x' error 'in vain'")
check.equal(runner.shell(string.format("cd %s && %s s.lua >/dev/full 2>said", runner.quote(runner.folder), runner.quote(runner.program))), 1)
check.truth(runner.read("said"):find "in vain") -- and not that it could not be printed
local function plotted(plot) return begin .. "return impact.scene { duration = 0.1, plot = " .. plot .. ", bodies = { " .. ball .. " } }" end
script(plotted "function() error 'no picture' end", 1, "no picture")
script(plotted "function() return 3 end", 1, "a figure is made with plot.figure; this is a number")
script(plotted "function() local t = { kind = 'figure' } for _ = 1, 90 do t = { t } end return t end", 1, "nested too deep")
script(plotted "function() return { kind = 'figure', title = print } end", 1, "a figure holds numbers, strings and tables only")
script(plotted "function() return { kind = 'figure', [true] = 1, ['a'] = { false } } end", 1, "names or places as keys")
for mode, good in pairs { r = true, rb = true, w = true, wb = true, a = true, ["a+"] = true, ["r+"] = true, ["w+"] = true, ["w+b"] = true, ["rb+"] = true,
  x = false, [""] = false, rr = false, ["r++b"] = false, ["+"] = false } do
  script("local f = assert(io.open('f', 'w')) f:write 'abc' f:close() local ok, why = pcall(io.open, 'f', '" .. mode .. "') " ..
    "assert(ok == " .. tostring(good) .. ", why) if ok then assert(why) why:close() " ..
    "f = io.open('f', 'r') assert((f:read 'a' == 'abc') == ('" .. mode .. "' ~= 'w' and '" .. mode .. "' ~= 'wb' and not ('" .. mode .. "'):find '^w%+')) end print 'done'", 0)
end
script("local f = assert(io.open('f', 'w+')) f:write 'abc' assert(not f:seek('set', -2)) assert(f:seek('end', -1) == 2 and f:read(1) == 'c') " ..
  "assert(not pcall(io.open, 'f', 'r+b+')) print 'done'", 0)
script("assert(not io.open('no', 'r+') and not io.open(('x'):rep(5000), 'w') and not io.open('a/../b', 'w'))\nprint 'done'", 0)

-- ---- a sweep, and what else lies in its folder ----

local rows = begin .. [[
  return impact.sweep { name = "words", parameters = { word = impact.values { "a,b", 'say "no"', "tab\tnew\nback\\end", "", "plain" } }, scene = function()
    return { duration = 0.01, bodies = { impact.body { name = "b", shape = impact.sphere(1) } } } end,
    reduce = function(r) return { twice = r.parameters.word .. r.parameters.word, number = 0.1, is = r.number > 2, whole = 7 } end }]]
runner.write("words.lua", "#!/usr/bin/env impact\n" .. rows)
runner.shell("rm -rf " .. runner.quote(runner.folder .. "/o"))
run("sweep words.lua --out o --quiet", 0)
run("sweep words.lua --out o --quiet", 0) -- nothing is left to do
local table_of = runner.read "o/words.csv"

--- The rows of a CSV text (RFC 4180).
local function parse(text)
  local result, row, at = {}, {}, 1
  while at <= #text do
    local cell
    if text:sub(at, at) == '"' then
      local from = at + 1
      repeat at = text:find('"', at + 1, true) + 1 until text:sub(at, at) ~= '"'
      cell = text:sub(from, at - 2):gsub('""', '"')
    else
      local stop = text:find("[,\n]", at)
      cell, at = text:sub(at, stop - 1), stop
    end
    row[#row + 1] = cell
    if text:sub(at, at) == "\n" then result[#result + 1], row = row, {} end
    at = at + 1
  end
  return result
end
local got = parse(table_of)
check.equal(table.concat(got[1], " "), "run word is number twice whole status message")
for i, word in ipairs { "a,b", 'say "no"', "tab\tnew\nback\\end", "", "plain" } do
  check.equal(got[i + 1][2], word)
  check.equal(got[i + 1][3], tostring(i > 3))
  check.equal(got[i + 1][4], "0.10000000000000001")
  check.equal(got[i + 1][5], word .. word)
  check.equal(got[i + 1][6], "7")
end
-- Files with other names, heads that are none, blocks that are damaged or cut short: what is not ours is not read, what is damaged is run again.
local part = runner.read "o/words.0-1.rows"
local head = part:match "^[^\n]*\n"
for _, name in ipairs { "words.rows", "words.0.rows", "words.0-.rows", "words.-1.rows", ".0-1.rows", "0-1.rows", "words.0-1.row", "wordsx0-1.rows" } do
  runner.write("o/" .. name, "impact sweep 1 0 nothing")
end
for number, damaged in ipairs { "", "impact", "impact sweep 2 0 5 \n", head:gsub(" 5 ", " 0 "), head:sub(1, -2), head:gsub("word\n", ("w"):rep(3000) .. "\n"), "impact sweep 1 0\n5 word\n", "impact sweep 1 0 5x\n", head .. "@ 5", head .. "@ 999 0\nx\n",
  head .. "@ 2 0000000000000000\nx\n", part:sub(1, -3), part:gsub("@ ", "& ") } do
  runner.write("o/words.0-1.rows", damaged)
  runner.shell("cd " .. runner.quote(runner.folder) .. "/o && rm -f words.csv words.0-2.rows")
  local out = run("sweep words.lua --out o", 0)
  check.truth(out ~= "" and runner.read "o/words.csv" == table_of, "damage " .. number)
end
runner.write("o/words.0-1.rows", head)
runner.shell("cd " .. runner.quote(runner.folder) .. "/o && rm -f words.csv words.0-2.rows")
run("gather o", 3, "'words' has 0 of 5 runs; the rest is to do")
runner.write("o/empty", "")
run("gather o/empty", 4, "Not a directory")
runner.shell("mkdir -p " .. runner.quote(runner.folder .. "/nothing"))
run("gather nothing", 4, "no rows of a sweep in 'nothing'")
runner.write("long.lua", begin .. "local p = {} for i = 1, 300 do p['parameter_number_' .. i] = impact.values { i } end return impact.sweep { parameters = p, " ..
  "scene = function() end }")
run("sweep long.lua --out l", 1, "sweep: the parameters' names are too long")
runner.write("hash.lua", "# nothing else")
run("sweep hash.lua --out l", 1, "this one returned a n")
runner.write("hash.lua", "")
run("sweep hash.lua --out l", 1, "this one returned a n")

-- What is raised need not be a text.
for _, raised in ipairs { "nil", "{}", "function() end" } do
  runner.write("raise.lua", "error(" .. raised .. ")")
  run("raise.lua --out r", 1, "the script raised an error that is not a text")
  runner.write("raise.lua", begin .. "return impact.sweep { parameters = { x = impact.grid(1, 2, 2) }, keep = function() error(" .. raised .. ") end, " ..
    "scene = function() return { duration = 1, bodies = { impact.body { name = 'ball', shape = impact.sphere(1) } } } end }")
  run("sweep raise.lua --quiet --out r", 3, "every run of the sweep failed")
  check.equal(runner.read "r/raise.csv", "run,x,status,message\n0,1,error,an error that is not a text\n1,2,error,an error that is not a text\n")
  runner.shell("rm -rf " .. runner.quote(runner.folder .. "/r"))
end

-- ---- rows that are whole, but not right ----

--- FNV-1a, 64 bits, as the blocks of a part have it.
local function checksum(text)
  local h = 0xcbf29ce484222325
  for i = 1, #text do h = (h ~ text:byte(i)) * 0x100000001b3 end
  return string.format("%016x", h)
end
local function block(lines) return string.format("@ %d %s\n%s", #lines, checksum(lines), lines) end
local blocks = part:match "\n(.*)$"
local first_line = blocks:match "\n([^\n]*\n)"
check.equal(block(blocks:match "^@ %d+ %x+\n(.*)$"), blocks) -- all rows came in one block
local function folder_of(text)
  runner.shell("cd " .. runner.quote(runner.folder) .. " && rm -rf o && mkdir o")
  runner.write("o/words.0-1.rows", text)
end
for name, row in pairs { ["a run beyond the last"] = "0.1\t5\tok\t\n", ["a run below 0"] = "0.1\t-1\tok\t\n", ["no run"] = "0.1\n",
  ["no sign"] = "0.1\t0\tok\t\tword\tsign\n", ["a name without end"] = "0.1\t0\tok\t\tword\t" .. ("n"):rep(300) .. "=1\n" } do
  folder_of(head .. block(row))
  run("gather o", 4, "a row of 'words' is damaged")
  run("sweep words.lua --out o", 4, "a row of 'words' is damaged")
  check.truth(not runner.exists "o/words.csv", name)
end
folder_of(head .. blocks .. block(first_line)) -- a run that is there twice counts once
run("gather o", 0)
check.equal(runner.read "o/words.csv", table_of)
folder_of(head .. blocks)
runner.shell("cd " .. runner.quote(runner.folder) .. "/o && ln -s words.0-1.rows words.0-2.rows") -- nothing follows a link
run("gather o", 0)
check.equal(runner.read "o/words.csv", table_of)
runner.write("o/words.0-3.rows", (head:gsub(" %x+ 5 ", " 0000000000000001 5 "))) -- of another script
run("gather o", 4, "holds rows of another sweep 'words'")
run("sweep words.lua --out o", 4, "holds rows of another sweep 'words'")
folder_of(head .. blocks)
runner.write("o/words.0-2.rows", (head:gsub(" 5 ", " 6 "))) -- of other runs
run("gather o", 4, "holds rows of another sweep 'words'")
folder_of(head .. blocks)
runner.write("o/words.0-2.rows", (head:gsub("word\n", "ward\n"))) -- of another parameter
run("gather o", 4, "holds rows of another sweep 'words'")
folder_of(head .. blocks)
runner.write("o/" .. ("x"):rep(210) .. ".0-1.rows", head .. blocks) -- a name that no sweep has
runner.write("o/more.0-1.rows", head .. block(first_line))
runner.write("o/more.0-2.rows", head)
run("gather o", 3, "'more' has 1 of 5 runs; the rest is to do") -- another sweep beside it, put together as far as it is
check.equal(runner.read "o/words.csv", table_of)
check.truth(runner.exists "o/more.partial.csv")

-- ---- cells that hold anything ----

runner.write("cells.lua", begin .. [[
  return impact.sweep { name = "cells", parameters = { length = impact.values { 1, 2, 3 } }, scene = function()
    return { duration = 0.01, bodies = { impact.body { name = "b", shape = impact.sphere(1) } } } end,
    reduce = function(r) local word = ({ "a\0b\r", '"', "" })[r.parameters.length] return { lengths = word, len = word .. "=SUM(1)", le = #word } end }]])
run("sweep cells.lua --out o --quiet --trust", 0)
do
  local rows = parse((runner.read "o/cells.csv":gsub("\r", "r")))
  check.equal(table.concat(rows[1], " "), "run length le len lengths status message")
  check.equal(rows[2][5]:gsub("%z", "0"), "abr") -- no reader takes a zero
  check.equal(rows[3][5], '"')
  check.equal(rows[4][5], "")
  check.equal(rows[4][4], "'=SUM(1)")
end
runner.write("o/cells.0-1.rows", head:gsub("word\n", ("w"):rep(5000) .. "\n")) -- a head that is too long for any sweep
run("sweep words.lua --mpi --fence --out o", 2, "%-%-fence and %-%-mpi exclude each other")

-- ---- scripts of sweeps that are none ----

runner.write("wrong.lua", "return impact.")
run("sweep wrong.lua --out l", 1, "wrong.lua:1:")
runner.write("wrong.lua", "return setmetatable({}, { __name = 'impact.swoop' })")
run("sweep wrong.lua --out l", 1, "a sweep needs a script that returns impact.sweep{...}; this one returned a table")
runner.write("wrong.lua", "\27Lua")
run("sweep wrong.lua --out l", 1, "attempt to load a binary chunk")
run("sweep absent.lua --out l", 1, "cannot open absent.lua")
run("sweep nothing --out l", 1, "cannot open nothing: Is a directory")
runner.write("wrong.lua", (rows:gsub('name = "words"', 'name = "a/b"')))
run("sweep wrong.lua --out l", 1, "the sweep's name 'a/b' names the files: it must be plain")
do -- the fence of a sweep: there, or told
  local code, _, said = runner.command("sweep words.lua --out fenced --quiet --fence")
  check.truth(code == 0 and said == "" or code == 1 and said:find "not fenced: ", "fenced or told: " .. said)
end

check.report "command"
