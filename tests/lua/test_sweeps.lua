-- SPDX-License-Identifier: MIT
--- The example sweeps, few of their runs, against the rows committed beside them; arg[3] is the examples' folder. After a change that is
--- meant to move them: impact sweep SWEEP.lua --out DIR -- ARGUMENTS, and its NAME.csv to examples/sweeps/expected.
local check = require "check"
local runner = require "runner"
local csv = require "quat.csv"
runner.clean()
local sweeps = arg[3] .. "/sweeps"

-- Another machine's libm moves last digits, which impacts of a die amplify, a few times each. Throws that end by steps are not among them:
-- their last time is as good as the steps.
local few = { ball_to_rest = "cells=4", ellipsoid_turns = "cells=3", loaded_dice = "throws=2" }
local tolerance = 1e-7

--- Runs the sweep: its rows.
local function rows_of(name, arguments, out)
  local code, _, said = runner.command(("sweep %s --out %s -- %s"):format(runner.quote(("%s/%s.lua"):format(sweeps, name)), out, arguments))
  if code ~= 0 then error(("%s: exit %d: %s"):format(name, code, said)) end
  return csv.rows(runner.read(("%s/%s.csv"):format(out, name)))
end

for name, arguments in pairs(few) do
  local file = assert(io.open(("%s/expected/%s.csv"):format(sweeps, name)))
  local wanted, got = csv.rows(file:read "a"), rows_of(name, arguments, name)
  file:close()
  check.equal(#got, #wanted)
  for i, row in ipairs(wanted) do
    for column, value in pairs(row) do
      if type(value) == "number" then
        check.close(got[i][column], value, tolerance * (1 + math.abs(value)))
      else
        check.equal(got[i][column], value)
      end
    end
  end
end

-- Every example is among them.
runner.shell(("ls %s/*.lua >%s/list.txt"):format(runner.quote(sweeps), runner.quote(runner.folder)))
for path in runner.read("list.txt"):gmatch "[^\n]+" do check.truth(few[path:match "([^/]+)%.lua$"], path .. " is looked at") end

-- A ball that slides through all its bounces: friction's impulse is mu times the weight's over any bounce, so that where it comes to rest
-- hangs on its restitution by nothing but rounding.
local first
for _, row in ipairs(rows_of("ball_to_rest", "cells=12", "slides")) do
  check.equal(row.status, "at rest")
  check.truth(math.abs(row.energy_off) < 1e-13, "energy: " .. row.energy_off)
  if row.friction == 0.1 and row.restitution < 0.45 then
    first = first or row.x
    check.close(row.x, first, 1e-12 * first)
    if row.restitution > 0.1 then check.truth(row.bounces > 3, "it bounces") end
  end
end

check.report("sweeps")
