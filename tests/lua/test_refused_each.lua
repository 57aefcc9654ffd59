-- SPDX-License-Identifier: MIT
--- Of few functions of the system every single call refused, by an error and by an interruption: sweeps, their gathering, states saved and gone on
--- from. What ends so says so; what has a name is whole, and there after a 0. (test_refused_calls.lua has calls of all functions, some of them.)
--- And what a sweep says of itself: once a minute in a log, and of errors that are no text.
local check = require "check"
local runner = require "runner"
local library = arg[3]
runner.clean()

local EIO, EINTR = 5, 4
local tiny = [[
  local impact = require "impact"
  return impact.sweep { name = "six", parameters = { speed = impact.grid(1, 3, 3) }, runs = 2, scene = function(p) return { duration = 0.2, bodies = {
    impact.body { name = "ball", shape = impact.sphere(0.1), position = { 0, 0, 0.2 }, velocity = { p.speed, 0, 0 }, restitution = 0.9 },
    impact.body { name = "floor", shape = impact.plane(), restitution = 1 } } } end }
]]
local drop = [[
  local impact = require "impact"
  return impact.scene { name = "drop", duration = 0.5, bodies = { impact.body { name = "floor", shape = impact.plane(), restitution = 1 },
    impact.body { name = "ball", shape = impact.sphere(0.1), position = { 0, 0, 0.3 }, restitution = 0.9 } } }
]]
runner.write("sweep.lua", tiny)
runner.write("drop.lua", drop)

local function within(variables, line, limit)
  local code = runner.shell(string.format("( cd %s && timeout %d env %s LD_PRELOAD=%s %s %s >stdout.txt 2>stderr.txt </dev/null ) 2>/dev/null",
    runner.quote(runner.folder), limit or 60, variables, runner.quote(library), runner.quote(runner.program), line))
  return code, runner.read "stderr.txt"
end

local function make(before)
  runner.shell(string.format("cd %s && rm -rf o && %s", runner.quote(runner.folder), before:gsub("IMPACT", runner.quote(runner.program))))
end

--- Every call of the functions; how many refusals were met by an exit code other than 0.
local function each_call(line, before, names, functions)
  local whole, met, tried = {}, 0, 0
  for only in functions:gmatch "%S+" do
    make(before)
    local code, told = within("FAIL_COUNT=1 FAIL_ONLY=" .. only, line)
    if code ~= 0 then error(string.format("%s: exit code %d: %s", line, code, told)) end
    local calls = 0
    for number in told:gmatch "(%d+)\n" do calls = math.max(calls, tonumber(number)) end
    check.truth(calls > 0, line .. " calls " .. only)
    for _, name in ipairs(names) do whole[name] = assert(runner.read("o/" .. name), name) end
    for at = 1, calls do
      for _, with in ipairs { EIO, EINTR } do
        make(before)
        local ended, said = within(string.format("FAIL_AT=%d FAIL_WITH=%d FAIL_ONLY=%s", at, with, only), line)
        local where = string.format("%s: %s, call %d with errno %d: exit code %s: %s", line, only, at, with, ended, said)
        tried = tried + 1
        if ended == 124 or ended >= 126 then error(where) end
        for _, name in ipairs(names) do
          local got = runner.read("o/" .. name)
          if got and got ~= whole[name] then error(name .. " is not whole: " .. where) end
          if ended == 0 and not got then error("no " .. name .. ": " .. where) end
        end
        if ended ~= 0 and not said:find "impact: " then error("says nothing: " .. where) end
        met = met + (ended ~= 0 and 1 or 0)
      end
    end
  end
  check.truth(met > 0, string.format("%s: %d refusals, %d met by words", line, tried, met))
end

local shards = "IMPACT sweep sweep.lua --quiet --out o --shard 0/2 >/dev/null 2>&1 && IMPACT sweep sweep.lua --quiet --out o --shard 1/2 >/dev/null 2>&1"
each_call("sweep sweep.lua --quiet --out o -j 2 --hdf5", "true", { "six.csv" }, "pthread_create close fstat openat mkdir fopencookie fclose fflush write")
each_call("gather o", shards, { "six.csv" }, "openat fstat fopencookie renameat")
each_call("drop.lua --quiet --out o --save 0.2 half --checkpoint 0.000001", "true", { "drop.csv", "half" }, "fopencookie fclose fflush")
each_call("drop.lua --quiet --out o --resume half", "IMPACT drop.lua --quiet --out p --save 0.2 half >/dev/null 2>&1 && mv p/half .", { "drop.csv" }, "fopen fseek ftell fread")

runner.write("figure.lua", [[
  local plot = require "quat.plot"
  local saved, why = plot.save(plot.figure { plot.panel { plot.line { { 1, 2, 3 }, { 1, 4, 9 } } } }, "curve")
  if not saved and not why:find "gnuplot is not installed" then error(why, 0) end
  local written, reason = require "quat.host".write("words", ("word\n"):rep(1000))
  if not written then error(reason, 0) end
]])
each_call("figure.lua --quiet --out o --pictures", "true", { "words" }, "openat linkat close write")

-- In a log a line a minute: of two seconds at a clock 120 times as fast four minutes.
runner.write("sweep.lua", [[
  local impact = require "impact"
  return impact.sweep { name = "many", parameters = { speed = impact.grid(1, 3, 100000) }, scene = function(p) return { duration = 20, output_rate = 0,
    bodies = { impact.body { name = "ball", shape = impact.sphere(0.1), position = { 0, 0, 0.2 }, velocity = { p.speed, 0, 0 }, restitution = 0.999 },
      impact.body { name = "floor", shape = impact.plane(), restitution = 1 } } } end }]])
make "true"
local _, said = within("FAIL_CLOCK=120", "sweep sweep.lua --out o -j 2", 3)
local lines = 0
for line in said:gmatch "[^\n]+\n" do
  if line:find "^%d+ of 100000 runs, %S+ per second, about %d+ s left, 0 failed\n$" then lines = lines + 1 end
end
check.truth(lines >= 2 and not said:find "\27", "a line a minute: " .. said)

-- A script that the threads load with another end than the runner did.
for name, raised in pairs { ["not a text"] = "{}", ["as it comes"] = "'as it comes'" } do
  runner.write("sweep.lua", ([[
    local seen = io.open("o/seen", "r")
    if seen then error(RAISED, 0) end
    local file = assert(io.open("o/seen", "w"))
    file:close()
  ]]):gsub("RAISED", raised) .. tiny)
  make "true"
  local code, words = within("FAIL_COUNT=0", "sweep sweep.lua --quiet --out o -j 2")
  check.equal(code, 1)
  check.truth(words:find(name, 1, true), words)
end

check.report "refused each"
