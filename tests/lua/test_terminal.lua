-- SPDX-License-Identifier: MIT
--- What the runner shows on a terminal: how far a run and a sweep have come, in one line that is gone at the end. The terminal is made by
--- `script`, of util-linux; where there is none nothing is tested.
local check = require "check"
local runner = require "runner"
runner.clean()

local here = runner.quote(runner.folder)
if runner.shell "script -qefc true /dev/null >/dev/null 2>&1 </dev/null" ~= 0 then
  print "no `script`: left out"
  return
end

--- Everything that a command line of the runner shows there, and its exit code.
local function shown(line)
  local code = runner.shell(string.format("cd %s && rm -rf o && env -u LD_PRELOAD script -qefc %s shown.txt >/dev/null </dev/null", here,
    runner.quote(runner.quote(runner.program) .. " " .. line)))
  return code, (runner.read "shown.txt":gsub("^Script started[^\n]*\n", ""):gsub("\n+Script done.*$", ""))
end

local ball = "impact.body { name = 'ball', shape = impact.ellipsoid { a = 0.1, b = 0.12, c = 0.15 }, position = { 0, 0, 1 }, omega = { 1, 2, 3 }, restitution = 0.9 }"
local floor = "impact.body { name = 'floor', shape = impact.plane(), restitution = 1 }"
runner.write("long.lua", "local impact = require 'impact' return impact.scene { name = 'long', duration = 1e7, output_rate = 1000, bodies = { " .. ball .. " } }")
runner.write("short.lua", "local impact = require 'impact' return impact.scene { name = 'short', duration = 0.1, bodies = { " .. ball .. " } }")

-- A run: its time, now and then, and at the end only what went wrong.
local code, text = shown "long.lua --out o --max-time 1.4"
check.equal(code, 5)
local times, last = 0, 0
for t in text:gmatch "\r\27%[Kt = ([%d.e+]+) of 1e%+07 s, 0 %%" do
  check.truth(tonumber(t) > last, "time goes on: " .. t)
  times, last = times + 1, tonumber(t)
end
check.truth(times > 1 and times < 12, times .. " times: " .. text) -- ten a second at most, after half a second
check.truth(text:find("%%\r\27%[Kimpact: time limit of 1.4 s reached; [^\n]*$"), text)
code, text = shown "long.lua --out o --max-time 1 --quiet"
check.equal(code, 5)
check.truth(not text:find "\27", text)
code, text = shown "short.lua --out o"
check.equal(code, 0)
check.truth(not text:find "\27" and text:find "wrote", text)

-- A sweep: how many runs are done, how fast, how long the rest takes; the line is gone before the last words.
runner.write("sweep.lua", "local impact = require 'impact' return impact.sweep { name = 'many', runs = 12, parameters = { turn = impact.grid(1, 5, 5) }, " ..
  "scene = function(p) local start = os.clock() while os.clock() - start < 0.05 do end " ..
  "return { duration = 0.1, bodies = { " .. ball .. ", " .. floor .. " } } end }")
code, text = shown "sweep sweep.lua --out o -j 1"
check.equal(code, 0)
local done, left = 0, 0
for count, all, rate, rest in text:gmatch "\r\27%[K(%d+) of (%d+) runs, ([%d.e+-]+) per second(.-), 0 failed" do
  check.truth(tonumber(count) > done and tonumber(all) == 60 and tonumber(rate) > 0, count .. " of " .. all)
  done = tonumber(count)
  left = left + (rest:find "^, about %d+ s left$" and 1 or 0)
end
check.truth(done > 0 and left > 0, text)
check.truth(text:find "\r\27%[K[^\27]*$", text)
code, text = shown "sweep sweep.lua --out o -j 1 --quiet"
check.equal(code, 0)
check.truth(not text:find "\27", text)

check.report "terminal"
