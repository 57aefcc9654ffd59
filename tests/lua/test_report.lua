-- SPDX-License-Identifier: MIT
--- scene:report{...}, and `impact SCRIPT --report`: a table, a CSV file, a picture, a verdict.
local check = require "check"
local csv = require "quat.csv"
local impact = require "impact"
local runner = require "runner"
runner.clean()

local function definition(rest)
  local d = {
    name = "drop", duration = 1, gravity = { 0, 0, -9.81 },
    bodies = {
      { name = "floor", shape = impact.plane(), friction = 0, restitution = 1 },
      { name = "ball", shape = impact.sphere(.1), mass = 1, position = { 0, 0, 1 }, friction = 0, restitution = .5 },
    },
  }
  for key, value in pairs(rest or {}) do d[key] = value end
  return d
end

local function wind(law) return { forces = { impact.force { name = "gust", law = law } } } end

local quick = { seconds = 10, times = 12, rounds = 2, tolerances = { 1e-4, 1e-8 }, steps = { 1e-2, 1e-3 } }

-- In a constant force: rows, and what is said of them.
local scene = impact.scene(definition(wind(function() return { 1, 0, 0 } end)))
local report = assert(scene:report(quick))
check.equal(#report.rows, 10)
check.truth(report.summary.sure and report.summary.certainty.e < 1e-11)
check.equal(report.summary.motion_witness.method, "motion = rk4")
check.truth(report:best "default".e < 1e-11 and report:time_to("default", 1e-9) > 0)
check.equal(report:time_to("default", 1e-30), nil)
local text = report:text()
for _, words in ipairs { "drop: error against run time   12 times, 2 events, 2 rounds", "reference   default at 1e-15, sure to ",
  "condition", "ms to reach", "motion = rk4", "left out    change nothing here: gaps = ccd", "verdict     default: " } do
  check.truth(text:find(words, 1, true), words .. "\n" .. text)
end
local rows = csv.rows(csv.text(report:columns()))
check.equal(#rows, 10)
check.equal(rows[1].method, "default")
check.equal(rows[1].setting, 1e-4)
check.truth(rows[10].method == "motion = rk4" and rows[10].cpu_ms > 0 and rows[10].integrator_steps > 500 and rows[10].ended == "ok")
check.equal(report:figure().kind, "figure")
check.equal(scene:time(), 0) -- the scene itself was not run

-- Only some methods; an error of a law is the script's; a law with a memory is refused.
local two = assert(scene:report { seconds = 5, times = 6, rounds = 1, methods = { "default", "motion = rk4" }, tolerances = { 1e-6 }, steps = { 1e-2 } })
check.equal(#two.rows, 2)
check.equal(two.rows[2].setting, 1e-2)
local function fails(words, ...)
  local ok, said = pcall(...)
  check.truth(not ok and tostring(said):find(words, 1, true), tostring(said))
end
fails("unknown key 'second' in report", scene.report, scene, { second = 1 })
fails("unknown method 'rk45'", scene.report, scene, { methods = { "rk45" } })
fails("tolerances must be a list of numbers", scene.report, scene, { tolerances = { "a" } })
local calls = 0
local moody = impact.scene(definition(wind(function(t)
  if t == 0 then calls = calls + 1 end
  return { 1e-3 * calls, 0, 0 }
end)))
local nothing, why = moody:report(quick)
check.equal(nothing, nil)
check.truth(why:find("force 'gust' is not the same in two runs", 1, true), why)
fails("no wind today", function() return impact.scene(definition(wind(function() error "no wind today" end))):report(quick) end)
local still, said = impact.scene(definition { bodies = { definition().bodies[1] } }):report(quick)
check.truth(still == nil and said:find("nothing moves", 1, true), said)

-- A reference from a file: the ball's free fall, whose truth is a formula.
local path = runner.folder .. "/truth.csv"
runner.shell("mkdir -p " .. runner.quote(runner.folder))
local file = assert(io.open(path, "w"))
file:write("# z = 1 - g t^2/2\nt,body,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n")
for k = 1, 8 do
  local t = .05 * k
  file:write(string.format("%.17g,ball,0,0,%.17g,1,0,0,0,0,0,%.17g,0,0,0\n", t, 1 - 9.81 * t * t / 2, -9.81 * t))
end
file:close()
local told = assert(impact.scene(definition()):report { seconds = 5, rounds = 1, reference = path, reference_error = 1e-15, steps = { 1e-2 }, tolerances = { 1e-6 } })
check.truth(told.summary.reference ~= told.summary.reference and told.summary.times == 8)
check.truth(told.rows[1].method == "default" and told.rows[1].e < 1e-14)

-- A reference that lacks a number is refused by its row: what follows would stand one place off.
for was, now in pairs { [",0,0,0\n"] = ",0,0,\n", [",ball,"] = ",bell,", ["0%.2%d*,ball"] = "soon,ball" } do
  file = assert(io.open(path))
  local text = file:read "a"
  file:close()
  file = assert(io.open(path, "w"))
  file:write((text:gsub(was, now, 1)))
  file:close()
  local good, why = pcall(function() return impact.scene(definition()):report { seconds = 5, reference = path } end)
  check.truth(not good and why:find(now == ",bell," and "row 1: the scene has no body 'bell'" or now == ",0,0,\n" and "row 1: wz is no number" or
    "row 4: t is no number", 1, true), why)
  file = assert(io.open(path, "w"))
  file:write(text)
  file:close()
end

-- The runner.
local script = [[
local impact = require "impact"
return impact.scene { name = "toss", duration = 0.5, bodies = {
  { name = "ball", shape = impact.sphere(0.1), mass = 1, position = { 0, 0, 1 }, omega = { 1, 2, 3 } } } }
]]
local code, out, err = runner.script(script, "--report --seconds 2")
check.equal(code, 0)
check.truth(out:find("toss: error against run time", 1, true) and out:find("verdict", 1, true), out .. err)
check.truth(runner.exists "o/toss_report.csv" and not runner.exists "o/toss.csv")
code, out, err = runner.script(script, "--report --seconds 1 --quiet")
check.equal(code, 0)
check.truth(out == "" and err == "" and runner.exists "o/toss_report.csv", out .. err)
check.equal(runner.script(script, "--report --record"), 2)

-- Its picture and its CSV file, where one of them cannot be, and a scene whose run fails.
local here = runner.quote(runner.folder)
local function drawn_by(gnuplot, wanted, said, options)
  runner.shell("cd " .. here .. " && rm -rf o bin && mkdir bin")
  runner.write("script.lua", script)
  if gnuplot then runner.write("bin/gnuplot", "#!/bin/sh\n" .. gnuplot .. "\n") end
  local got = runner.shell(string.format("cd %s && chmod -f +x bin/gnuplot; env -u LD_PRELOAD PATH=%s %s script.lua --out o --report --seconds 1 %s " ..
    ">stdout.txt 2>stderr.txt </dev/null", here, gnuplot and "$PWD/bin:/usr/bin:/bin" or "$PWD/bin", runner.quote(runner.program), options or ""))
  local complained = runner.read "stderr.txt"
  if got ~= wanted or not complained:find(said) then error(string.format("wanted exit code %d and '%s', got %d and %s", wanted, said, got, complained), 2) end
  return runner.read "stdout.txt"
end
local table_alone, both = "wrote       o/toss_report.csv\n", "wrote       o/toss_report.csv, o/toss_report.png\n"
check.truth(drawn_by("cat >/dev/null; echo picture", 0, "^$"):find(both, 1, true))
check.truth(drawn_by("cat >/dev/null; exit 1", 4, "^impact: no picture: gnuplot failed\n$"):find(table_alone, 1, true))
check.truth(drawn_by(nil, 0, "^impact: gnuplot is not installed: no picture is drawn; the CSV file is complete\n$"):find(table_alone, 1, true))
check.equal(drawn_by("exit 0", 5, "^impact: disk limit of 0.0001 MB reached\n$", "--max-disk 0.0001"), "")
check.truth(not runner.exists "o/toss_report.csv" and not runner.exists "o/toss_report.png")
runner.shell("cd " .. here .. " && rm -rf o && mkdir -p o/toss_report.csv")
check.equal(runner.command "script.lua --out o --report --seconds 1", 4)
check.truth(runner.read "stderr.txt":find("^impact: cannot write 'o/toss_report.csv'"), runner.read "stderr.txt")
code, _, err = runner.script("local impact = require 'impact' return impact.scene { duration = 0.5, bodies = { { name = 'wall', shape = impact.plane() } } }",
  "--report --seconds 1")
check.equal(code, 3)
check.truth(err:find "nothing moves", err)
check.equal(runner.script(script, "--seconds 2"), 2)

check.report "report"
