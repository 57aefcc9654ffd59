-- SPDX-License-Identifier: MIT
--- The runner with one call of the system refused, each in turn, by an error and each third by an interruption: it ends, never by a signal; what has
--- a name is whole; and where something is amiss it says so and does not end with 0.
local check = require "check"
local runner = require "runner"
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

-- A terminal is shown how far it came.
runner.write("script.lua", [[
  local impact = require "impact"
  local bodies = { impact.body { name = "floor", shape = impact.plane(), restitution = 1 } }
  return impact.scene { name = "long", duration = 100000, max_events = 100000000, bodies = { bodies[1],
    impact.body { name = "ball", shape = impact.sphere(0.1), position = { 0, 0, 0.3 }, restitution = 1 } } }]])
local code, said = run("FAIL_TTY=1", "--max-time 2")
check.equal(code, 5)
check.truth(said:find "t = .- of 1e%+05 s, %d+ %%", "progress is shown")

check.report "refused calls"
