-- SPDX-License-Identifier: MIT
--- The runner with one call of the system refused, each in turn, by an error and each third by an interruption: it ends, never by a signal; what has
--- a name is whole; and where something is amiss it says so and does not end with 0.
local check = require "check"
local runner = require "runner"
local impact = require "impact"
local library = arg[3]
runner.clean()

local EIO, EINTR = 5, 4
local text = [[
  local impact, csv = require "impact", require "quat.csv"
  local function must(file, why) if not file then error(why, 0) end return file end
  local file = must(io.open("o/notes.txt", "w"))
  must(file:write("one\n"))
  must(file:close())
  file = must(io.open("o/notes.txt", "a+"))
  must(file:write("two\n"))
  must(file:close())
  file = must(io.open("notes.txt", "r"))
  local got = file:read "a"
  if got ~= "one\ntwo\n" then error("read back: " .. tostring(got), 0) end
  must(file:close())
  must(csv.save("table", { "x" }, { { 1, 2, 3 } }))
  return impact.scene { name = "drop", duration = 0.5, plot = function(scene) return require "impact.portrait".space(scene, "ball") end, bodies = {
    impact.body { name = "floor", shape = impact.plane(), restitution = 1 },
    impact.body { name = "ball", shape = impact.sphere(0.1), position = { 0, 0, 0.3 }, restitution = 0.9 } } }
]]
runner.write("script.lua", text)

local function run(variables, options)
  local command = string.format(
    "cd %s && rm -rf o && timeout 30 env %s LD_PRELOAD=%s %s script.lua --record --out o %s >stdout.txt 2>stderr.txt </dev/null",
    runner.quote(runner.folder), variables, runner.quote(library), runner.quote(runner.program), options or "")
  local code = runner.shell("( " .. command .. " ) 2>/dev/null")
  return code, runner.read "stderr.txt"
end

local files = { "drop.csv", "drop_events.csv", "drop.run", "table.csv" }
local whole, told = run "FAIL_COUNT=1"
check.equal(whole, 0)
local count, good = 0, {}
for number in told:gmatch "%d+" do count = math.max(count, tonumber(number)) end
check.truth(count > 60, "calls are counted: " .. told)
for _, name in ipairs(files) do good[name] = assert(runner.read("o/" .. name), name) end
local pictured = runner.exists "o/drop.png"

local refused, ends = 0, 0
for at = 1, count do
  for _, with in ipairs(at % 3 == 0 and { EIO, EINTR } or { EIO }) do
    local code, said = run(string.format("FAIL_AT=%d FAIL_WITH=%d", at, with))
    local where = string.format("call %d with errno %d: exit code %s: %s", at, with, code, said)
    if code == 124 or code >= 126 then error(where) end
    for _, name in ipairs(files) do
      local got = runner.read("o/" .. name)
      if got and got ~= good[name] then error(name .. " is not whole: " .. where) end
      if code == 0 and not got then error("no " .. name .. ": " .. where) end
    end
    if code == 0 and pictured and not runner.exists "o/drop.png" and said == "" then error("no picture: " .. where) end
    if code ~= 0 then
      refused = refused + 1
      if not said:find "impact: " then error("says nothing: " .. where) end
    else
      ends = ends + 1
    end
  end
end
check.truth(refused > 30, string.format("%d are refused, %d go on", refused, ends))

-- The same of the runner's other commands: each of their calls refused, they end, and say so where they do not end with 0; a file of `names` that
-- is there is whole, and after a 0 all of them are.
local tiny = [[
  local impact = require "impact"
  return impact.sweep { name = "six", parameters = { speed = impact.grid(1, 3, 3) }, runs = 2, keep = function(run) return run.number == 4 end,
    plot = function(c) local plot = require "quat.plot" return plot.figure { plot.panel { plot.line { c.run, c.speed } } } end,
    scene = function(p) return { duration = 0.2, bodies = {
      impact.body { name = "ball", shape = impact.sphere(0.1), position = { 0, 0, 0.2 }, velocity = { p.speed, 0, 0 }, restitution = 0.9 },
      impact.body { name = "floor", shape = impact.plane(), restitution = 1 } } } end }
]]
runner.write("sweep.lua", tiny)
runner.write("drop.lua", "local impact = require 'impact' " .. text:match "return impact.scene.*")

local function within(variables, line)
  local code = runner.shell(string.format("( cd %s && timeout 60 env %s LD_PRELOAD=%s %s %s >stdout.txt 2>stderr.txt </dev/null ) 2>/dev/null",
    runner.quote(runner.folder), variables, runner.quote(library), runner.quote(runner.program), line))
  return code, runner.read "stderr.txt"
end

local function make(before)
  runner.shell(string.format("cd %s && rm -rf o && %s", runner.quote(runner.folder), before:gsub("IMPACT", runner.quote(runner.program))))
end

local commands = 0
--- each: how many of the calls are refused, 1 of so many.
local function each_call(line, before, names, each)
  make(before)
  local code, told = within("FAIL_COUNT=1", line)
  if code ~= 0 then error(string.format("%s: exit code %d: %s", line, code, told)) end
  local calls, whole = 0, {}
  for number in told:gmatch "(%d+)\n" do calls = math.max(calls, tonumber(number)) end
  for _, name in ipairs(names) do whole[name] = assert(runner.read("o/" .. name), name) end
  local said_no = 0
  commands = commands + 1
  for at = 1 + commands % each, calls, each do -- how it starts is common to all of them
    for _, with in ipairs((each == 1 or at % (4 * each) < each) and { EIO, EINTR } or { EIO }) do
      make(before)
      local ended, said = within(string.format("FAIL_AT=%d FAIL_WITH=%d", at, with), line)
      local where = string.format("%s: call %d of %d with errno %d: exit code %s: %s", line, at, calls, with, ended, said)
      if ended == 124 or ended >= 126 then error(where) end
      for _, name in ipairs(names) do
        local got = runner.read("o/" .. name)
        local told_of = name == "six.csv" and got and got:gsub(",error,not kept: [^\n]*", ",end of time,") -- the row says it
        if got and got ~= whole[name] and told_of ~= whole[name] then error(name .. " is not whole: " .. where) end
        if ended == 0 and not got then error("no " .. name .. ": " .. where) end
      end
      if ended ~= 0 then
        said_no = said_no + 1
        if not said:find "impact: " then error("says nothing: " .. where) end
      end
    end
  end
  check.truth(calls > 20 and said_no > 0, string.format("%s: %d calls, %d refusals", line, calls, said_no))
end

local sweeping = "IMPACT sweep sweep.lua --quiet --out o --shard %d/2 >/dev/null 2>&1"
each_call("sweep sweep.lua --quiet --out o -j 2 --hdf5", "true", { "six.csv" }, 2)
each_call("gather o", sweeping:format(0) .. " && " .. sweeping:format(1), { "six.csv" }, 2)
each_call("drop.lua --quiet --out o --save 0.2 half --checkpoint 0.000001", "true", { "drop.csv", "half" }, 2)
each_call("drop.lua --quiet --out o --resume half", "IMPACT drop.lua --quiet --out p --save 0.2 half >/dev/null 2>&1 && mv p/half .", { "drop.csv" }, 2)
-- What is loaded when it is needed: the integrator, the surfaces; a figure in every form.
runner.write("parts.lua", "local impact = require 'impact' " .. (impact.has "cvode" and "require 'quat.gsl' local law, compliance = 'stronge', 1.2 " or "") .. [[
  return impact.scene { name = "drop", duration = 0.3, law = law, compliance = compliance,
    bodies = { impact.body { name = "floor", shape = impact.plane(), restitution = 1, friction = 1 }, impact.body { name = "ball", friction = 0.3,
      shape = impact.sphere(0.1), position = { 0, 0, 0.3 }, velocity = { 1, 0, 0 }, omega = { 0, 30, 0 }, restitution = 0.9 } } }
]])
each_call("parts.lua --quiet --out o", "true", { "drop.csv" }, 1)
runner.write("figure.lua", [[
  local plot = require "quat.plot"
  local saved, why = plot.save(plot.figure { plot.panel { plot.line { { 1, 2, 3 }, { 1, 4, 9 } } } }, "curve")
  if not saved and not why:find "gnuplot is not installed" then error(why, 0) end
  local written, reason = require "quat.host".write("words", ("word\\n"):rep(1000))
  if not written then error(reason, 0) end
]])
each_call("figure.lua --quiet --out o --pictures", "true", { "words" }, 1)
if impact.has "view" then
  local recorded = "IMPACT drop.lua --quiet --record --out p >/dev/null 2>&1"
  each_call("view p/drop.run --quiet --out o", recorded, { "drop.html" }, 4)
  each_call("gltf p/drop.run --quiet --out o", recorded, { "drop.glb" }, 4)
end

-- A terminal is shown how far it came.
runner.write("script.lua", [[
  local impact = require "impact"
  local bodies = { impact.body { name = "floor", shape = impact.plane(), restitution = 1 } }
  return impact.scene { name = "long", duration = 1e8, max_events = 1000000000, bodies = { bodies[1],
    impact.body { name = "ball", shape = impact.sphere(0.1), position = { 0, 0, 0.3 }, restitution = 1 } } }]])
local code, said = run("FAIL_TTY=1", "--max-time 2")
check.equal(code, 5)
check.truth(said:find "t = .- of 1e%+08 s, %d+ %%", "progress is shown")

runner.write("sweep.lua", [[
  local impact = require "impact"
  return impact.sweep { name = "many", parameters = { speed = impact.grid(1, 3, 100000) }, scene = function(p)
    if p.speed > 1 and p.speed < 1.0001 then error "too slow" end
    return { duration = 20, output_rate = 0, bodies = {
      impact.body { name = "ball", shape = impact.sphere(0.1), position = { 0, 0, 0.2 }, velocity = { p.speed, 0, 0 }, restitution = 0.999 },
      impact.body { name = "floor", shape = impact.plane(), restitution = 1 } } } end }]])
make "true"
code, said = within("FAIL_TTY=1", "sweep sweep.lua --out o -j 2 --max-time 2")
check.equal(code, 5)
check.truth(said:find "\r\27%[K%d+ of 100000 runs, %S+ per second, about %d+ s left, [1-9]%d* failed", "a sweep's progress is shown: " .. said:sub(1, 200))
check.truth(said:find "\r\27%[Kimpact: time limit of 2 s reached; %d+ of 100000 runs done here, the same command goes on\n$", "and cleared: " .. said:sub(-200))

check.report "refused calls"
