-- SPDX-License-Identifier: MIT
--- What one example scene uses: `impact --trust bench/used.lua -- FILE` prints a line of CSV: the counters of its run, the libraries
--- that the process has loaded, the memory it held and took, and the CPU time to the scene's being made.
local impact = require "impact"
local path = arg[1]
arg = {} -- the scene has arguments of its own
local make = impact.scene
impact.scene = function(definition)
  definition.plot = nil
  return make(definition)
end
local scene = dofile(path)
local started = os.clock()
scene:run()
local ran, usage = os.clock() - started, scene:usage()

local loaded, seen = {}, {}
for line in io.lines "/proc/self/maps" do
  local library = line:match "/lib(sundials_cvode)[^/]*%.so" or line:match "/lib(ccd)%.so" or line:match "/lib(gsl)%.so"
  if library and not seen[library] then
    seen[library] = true
    loaded[#loaded + 1] = library
  end
end
local peak = 0
for line in io.lines "/proc/self/status" do peak = tonumber(line:match "^VmHWM:%s+(%d+)") or peak end
print(table.concat({ path:match "([^/]+)%.lua$", usage.ballistic_flights, usage.rolls, usage.integrators, usage.integrator_steps, usage.gap_newton + usage.gap_gjk,
  usage.impacts_closed_form, usage.impacts_series, usage.impacts_cvode, #loaded > 0 and table.concat(loaded, " ") or "none", peak,
  string.format("%.2f", 1e3 * started), string.format("%.2f", 1e3 * ran) }, ","))
