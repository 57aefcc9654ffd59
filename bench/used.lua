-- SPDX-License-Identifier: MIT
--- What one example scene uses: `impact --trust bench/used.lua -- FILE` prints a line of CSV: the counters of its run; our own modules
--- that the process has loaded and the libraries below them; how often its scene asked for memory and the most it used, kB; the process'
--- memory, kB; the CPU time to the scene's being made and that of its run, ms. `-- names` prints the columns' names.
local names = { "scene", "flights", "rolls", "glides", "integrators", "integrator_steps", "pile_steps", "gap_formula", "gap_queries", "impacts_closed",
  "impacts_series", "impacts_cvode", "encounters", "linked", "loaded", "pieces", "used_kB", "peak_kB", "start_ms", "run_ms" }
local path = arg[1]
if path == "names" then
  print(table.concat(names, ","))
  return
end
local impact = require "impact"
arg = {} -- the scene has arguments of its own
local make = impact.scene
impact.scene = function(definition)
  definition.plot = nil
  return make(definition)
end
local scene = dofile(path)
local started = os.clock()
scene:run()
local ran, usage, memory = os.clock() - started, scene:usage(), scene:memory()

--- Names of the shared objects in the process: ours, a folder and a name; others but the system's own.
local function objects()
  local linked, loaded, seen = {}, {}, {}
  for line in io.lines "/proc/self/maps" do
    local object = line:match "(/%S+%.so)[%d.]*$"
    if object and not seen[object] then
      seen[object] = true
      local module, library = object:match "/modules/(.*)%.so$", object:match "/lib([^/]*)%.so$"
      if module then linked[#linked + 1] = module:gsub("/", ".")
      elseif library and (library:find "^sundials" or library == "ccd" or library:find "^gsl") then loaded[#loaded + 1] = library
      end
    end
  end
  return #linked > 0 and table.concat(linked, " ") or "none", #loaded > 0 and table.concat(loaded, " ") or "none"
end

local peak = 0
for line in io.lines "/proc/self/status" do peak = tonumber(line:match "^VmHWM:%s+(%d+)") or peak end
local linked, loaded = objects()
local values = { path:match "([^/]+)%.lua$", usage.ballistic_flights, usage.rolls, usage.glides, usage.integrators, usage.integrator_steps, usage.pile_steps,
  usage.gap_closed_form, usage.gap_newton + usage.gap_gjk, usage.impacts_closed_form, usage.impacts_series, usage.impacts_cvode, usage.encounters, linked,
  loaded, memory.pieces, string.format("%.0f", memory.most / 1000), peak, string.format("%.2f", 1e3 * started), string.format("%.2f", 1e3 * ran) }
print(table.concat(values, ","))
