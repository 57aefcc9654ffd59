-- SPDX-License-Identifier: MIT
--- The runner with one of its allocations refused, or all from one on: it ends with 0, or 1, 4 or 5 and one line, and never by a signal.
--- Of SUNDIALS' own, two within SUNContext_Create stop the process (docs/memory.md): a scene may meet each of them once. Every
--- allocation has its turn without the fence, which forbids to double a process (fail_malloc.c), or each so many where a double takes long to write
--- down what it took (coverage); 48 of each script with it.
local check = require "check"
local runner = require "runner"
local library, stride = arg[3], tonumber(arg[4] or 1)
runner.clean()

local body = "impact.body { name = 'ball', shape = impact.sphere(0.1), position = { 0, 0, 0.3 }, restitution = 0.9 }"
local scripts = {
  bounce = { text = "local impact = require 'impact' return impact.scene { duration = 0.3, bodies = { " .. body ..
    ", impact.body { name = 'floor', shape = impact.plane(), restitution = 1 } } }", crashes = 0 },
  figure = { text = [[local plot = require "quat.plot"
    local figure = plot.figure { title = "t", plot.panel { title = "p", plot.line { { 0, 1 }, { 0, 1 }, label = "l" } } }
    local saved, why = plot.save(figure, "a")
    if not saved and not why:find "gnuplot is not installed" then error(why) end
    assert(require "quat.csv".save("b", { "x" }, { { 1, 2, 3 } }))]], crashes = 0 },
  saved = { text = "local impact = require 'impact' return impact.scene { duration = 0.2, bodies = { " .. body .. " } }", crashes = 0,
    line = "script.lua --record --save 0.1 half --checkpoint 0.000001" },
  sweep = { text = "local impact = require 'impact' return impact.sweep { parameters = { x = impact.grid(0, 1, 3) }, scene = function(p) " ..
    "return { duration = p.x + 0.1, bodies = { " .. body .. " } } end }", crashes = 0, line = "sweep script.lua -j 2", threads = true },
}
if require "impact".has "cvode" then
  scripts.force = { text = "local impact = require 'impact' return impact.scene { duration = 0.2, forces = { impact.force { law = " ..
    "function(t, b) return { -b.position.x, 0, 0 } end } }, bodies = { " .. body .. " } }", crashes = 2 }
end

local function run(script, variables, options)
  local command = string.format("cd %s && rm -rf o && timeout %s env %s LD_PRELOAD=%s %s %s --out o --quiet %s >stdout.txt 2>stderr.txt </dev/null",
    runner.quote(runner.folder), options and 300 or 20, variables, runner.quote(library), runner.quote(runner.program), script.line or "script.lua",
    options or "")
  local code = runner.shell("( " .. command .. " ) 2>/dev/null")
  return code, runner.read("stderr.txt")
end

for name, script in pairs(scripts) do
  runner.write("script.lua", script.text)
  local whole, told = run(script, "FAIL_COUNT=1")
  check.equal(whole, 0)
  local count = tonumber(told)
  check.truth(count > 500, name .. " allocates")
  local crashes, refused, last = 0, 0, ""
  local function try(at, once)
    local code, said = run(script, "FAIL_AT=" .. at .. (once and " FAIL_ONCE=1" or ""))
    if code == 124 or code == 143 then error(string.format("%s, allocation %d: it hangs", name, at)) end
    if code >= 128 then
      crashes, last = crashes + 1, string.format("allocation %d%s: %s", at, once and " alone" or "", said)
    elseif code ~= 0 then
      refused = refused + 1
      if not (code == 1 or code == 4 or code == 5) or select(2, said:gsub("\n", "\n")) ~= 1 then
        error(string.format("%s, allocation %d%s: exit code %d: %s", name, at, once and " alone" or "", code, said))
      end
    end
  end
  for i = 1, 24 do -- the last ones are the runs', the first the state's
    try(1 + (i * i * count) // 576, i % 2 == 0)
    try(count - 3 * i, i % 2 == 1)
  end
  check.truth(crashes <= script.crashes, string.format("%s: %d ends by a signal, the last at %s", name, crashes, last))
  check.truth(refused > 10, name .. ": refusals are met")
  if script.threads then -- a process that is doubled has one of them
    for at = count - 1700, count, 7 do try(at, at % 2 == 0) end
    check.truth(crashes == 0, last)
    goto continue
  end
  local _, words = run(script, "FAIL_EACH=" .. stride, "--trust")
  local each, ended, signals = words:match "each (%d+) refused (%d+) signals (%d+)\n$"
  -- CVodeCreate writes its own two lines, which nothing can turn off.
  local faults, own = words:gsub(
    "allocation %d+: exit code 5: \n%[CVODE ERROR%]  CVodeCreate\n  Allocation of cvode_mem failed%.\n\n(impact: [^\n]*)\n\n", "%1\n")
  if not each or faults:find "allocation %d" or own > script.crashes // 2 then error(name .. ": " .. words:sub(1, 2000)) end
  check.truth(tonumber(each) * stride > 500 and tonumber(ended) * stride > 100, name .. ": every allocation has its turn: " .. words)
  check.truth(tonumber(signals) <= script.crashes, name .. ": ends by a signal: " .. words)
  print(name .. ": " .. words)
  ::continue::
end

check.report("memory")
