-- SPDX-License-Identifier: MIT
--- Many scenes of one form: what `impact.sweep{...}` makes. The runner's command `impact sweep` runs it; the guide is docs/sweep.md.
---
--- Run i (from 0) is a function of (seed, i) alone: its place in the crossed grids, point i of Sobol's sequence, and a random stream
--- seeded by both. Whoever runs it, and after which others, it gives the same row.

local core = require "impact.core"
local sobol = require "impact.sobol"
local digits = require "quat.gnuplot".digits
core.layer()

local format, concat, sort = string.format, table.concat, table.sort
local type, pairs, ipairs, pcall, error, setmetatable, getmetatable = type, pairs, ipairs, pcall, error, setmetatable, getmetatable
local tostring, next, max, abs, math_type, random, randomseed = tostring, next, math.max, math.abs, math.type, math.random, math.randomseed

local MOST_RUNS <const> = 2 ^ 31 - 1

local sweeps = {}

-- ---- parameters ----

local parameter = {}
local made = 0 -- parameters are crossed in the order in which they were made

local function is_finite(value)
  return type(value) == "number" and value - value == 0
end

local function new_parameter(kind, fields)
  made = made + 1
  fields.kind, fields.order = kind, made
  return setmetatable(fields, parameter)
end

local function need_ends(name, from, to)
  if not (is_finite(from) and is_finite(to)) then
    error(format("%s: both ends must be finite numbers, got %s and %s", name, tostring(from), tostring(to)), 3)
  end
end

local function need_count(name, count)
  if math_type(count) ~= "integer" or count < 1 or count > MOST_RUNS then
    error(format("%s: the count must be a whole number from 1 on, got %s", name, tostring(count)), 3)
  end
end

--- count numbers from one end to the other, both among them, evenly spaced; their logarithms, with "log".
---@param from number
---@param to number
---@param count integer
---@param spacing? "linear"|"log"
---@return impact.parameter
function sweeps.grid(from, to, count, spacing)
  need_ends("grid", from, to)
  need_count("grid", count)
  if spacing ~= nil and spacing ~= "linear" and spacing ~= "log" then
    error(format("grid: the spacing must be 'linear' or 'log', got '%s'", tostring(spacing)), 2)
  end
  if spacing == "log" and not (from * to > 0) then
    error(format("grid: a logarithmic spacing needs ends of one sign, got %g and %g", from, to), 2)
  end
  if count == 1 and from ~= to then error(format("grid: one number from %g to %g: which?", from, to), 2) end
  return new_parameter("grid", { from = from, to = to, count = count, log = spacing == "log" })
end

--- Whole numbers from first to last.
---@param first integer
---@param last integer
---@param step? integer
---@return impact.parameter
function sweeps.range(first, last, step)
  step = step or 1
  if math_type(first) ~= "integer" or math_type(last) ~= "integer" or math_type(step) ~= "integer" or step == 0 then
    error(format("range: whole numbers are needed, got %s, %s and %s", tostring(first), tostring(last), tostring(step)), 2)
  end
  local count = (last - first) // step + 1
  if count < 1 or count > MOST_RUNS then error(format("range: no numbers from %d to %d by %d", first, last, step), 2) end
  return new_parameter("range", { from = first, step = step, count = count })
end

--- Those values: numbers, strings, booleans.
---@param list (number|string|boolean)[]
---@return impact.parameter
function sweeps.values(list)
  if type(list) ~= "table" or #list == 0 then error("values: a list is needed, with at least one value", 2) end
  local copy = {}
  for i, value in ipairs(list) do
    local kind = type(value)
    if kind ~= "number" and kind ~= "string" and kind ~= "boolean" then
      error(format("values: value %d must be a number, a string or a boolean, got a %s", i, kind), 2)
    end
    copy[i] = value
  end
  return new_parameter("values", { list = copy, count = #copy })
end

--- A coordinate of Sobol's sequence, spread over [from, to): point i in run i. Those of one sweep are coordinates of one point.
---@param from number
---@param to number
---@return impact.parameter
function sweeps.sobol(from, to)
  need_ends("sobol", from, to)
  return new_parameter("sobol", { from = from, to = to })
end

--- A number of [from, to) at random, from the run's stream.
---@param from number
---@param to number
---@return impact.parameter
function sweeps.random(from, to)
  need_ends("random", from, to)
  return new_parameter("random", { from = from, to = to })
end

local function between(from, to, part)
  return part >= 1 and to or from + (to - from) * part
end

--- Value k (from 0) of a parameter that is crossed.
local function crossed_value(p, k)
  if p.kind == "range" then return p.from + k * p.step end
  if p.kind == "values" then return p.list[k + 1] end
  if k == 0 or p.count == 1 then return p.from + 0.0 end
  if k == p.count - 1 then return p.to + 0.0 end
  local part = k / (p.count - 1)
  return p.log and p.from * (p.to / p.from) ^ part or between(p.from, p.to, part)
end

-- ---- a run's own numbers ----

--- The finaliser of splitmix64 (Steele, Lea and Flood 2014): neighbouring numbers go far apart.
local function mixed(z)
  z = (z ~ (z >> 30)) * 0xbf58476d1ce4e5b9
  z = (z ~ (z >> 27)) * 0x94d049bb133111eb
  return z ~ (z >> 31)
end

--- Word k of the pair (seed, i).
local function word(seed, i, k)
  return mixed(mixed(mixed(seed + 0x9e3779b97f4a7c15) + i * 0x9e3779b97f4a7c15) + k)
end

-- ---- the definition ----

---@class impact.sweep
local methods = {}
local sweep_meta = { __index = methods, __name = "impact.sweep" }

local keys = {
  name = "string", parameters = "table", runs = "number", seed = "number", scene = "function", reduce = "function", keep = "function",
  record = "boolean", on_event = "function", plot = "function",
}

local function check_keys(definition)
  if type(definition) ~= "table" then error(format("sweep: a table is needed, got a %s", type(definition)), 3) end
  for key, value in pairs(definition) do
    if not keys[key] then
      local known = {}
      for name in pairs(keys) do known[#known + 1] = name end
      sort(known)
      error(format("sweep: unknown key '%s'; there are: %s", tostring(key), concat(known, ", ")), 3)
    end
    if type(value) ~= keys[key] then
      error(format("sweep: %s must be a %s, got a %s", key, keys[key], type(value)), 3)
    end
  end
  for _, key in ipairs { "parameters", "scene" } do
    if definition[key] == nil then error(format("sweep: %s is missing", key), 3) end
  end
  for _, key in ipairs { "runs", "seed" } do
    local value = definition[key]
    if value and math_type(value) ~= "integer" then error(format("sweep: %s must be a whole number, got %s", key, tostring(value)), 3) end
  end
  if (definition.runs or 1) < 1 then error(format("sweep: runs must be at least 1, got %d", definition.runs), 3) end
end

local taken = { run = true, status = true, message = true, cpu = true } -- columns of the table itself

--- What can head a column: C's identifiers, to 60 letters.
local function is_name(name)
  return type(name) == "string" and name:find("^[%a_][%w_]*$") ~= nil and #name <= 60 and not taken[name]
end

--- The parameters in their order.
local function parameter_list(table_of)
  local list = {}
  for name, p in pairs(table_of) do
    if not is_name(name) then
      error(format("sweep: '%s' cannot be a parameter's name", tostring(name)), 3)
    end
    if getmetatable(p) ~= parameter then
      error(format("sweep: parameter '%s' must be of impact.grid, range, values, sobol or random, got a %s", name, type(p)), 3)
    end
    list[#list + 1] = { name = name, of = p }
  end
  sort(list, function(a, b) return a.of.order < b.of.order or a.of.order == b.of.order and a.name < b.name end)
  return list
end

--- Many scenes of one form.
---@param definition impact.sweep_definition
---@return impact.sweep
function sweeps.sweep(definition)
  check_keys(definition)
  local self = { definition = definition, list = parameter_list(definition.parameters), seed = definition.seed or 0 }
  local count, dimension = definition.runs or 1, 0
  for i = #self.list, 1, -1 do -- the last one changes first
    local p = self.list[i].of
    if p.count then
      self.list[i].stride = count
      count = count * p.count
      if count > MOST_RUNS then error(format("sweep: more than %d runs", MOST_RUNS), 2) end
    end
  end
  for _, entry in ipairs(self.list) do
    if entry.of.kind == "sobol" then
      dimension = dimension + 1
      if dimension > sobol.dimensions then error(format("sweep: more than %d parameters of impact.sobol", sobol.dimensions), 2) end
      entry.directions = sobol.directions(dimension)
      entry.shift = self.seed ~= 0 and word(self.seed, -1, dimension) >> (64 - sobol.bits) or 0
    end
  end
  self.runs = count
  return setmetatable(self, sweep_meta)
end

--- How many runs there are: 0, 1, ... count - 1.
---@return integer
function methods:count() return self.runs end

--- The parameters' names, in the order in which they are crossed.
---@return string[]
function methods:names()
  local names = {}
  for i, entry in ipairs(self.list) do names[i] = entry.name end
  return names
end

--- The parameters of run i. Seeds math.random for that run.
---@param i integer
---@return table<string, number|string|boolean>
function methods:parameters(i)
  if math_type(i) ~= "integer" or i < 0 or i >= self.runs then
    error(format("sweep: there are runs 0 to %d, got %s", self.runs - 1, tostring(i)), 2)
  end
  local p = {}
  randomseed(word(self.seed, i, 0), word(self.seed, i, 1))
  for _, entry in ipairs(self.list) do
    local of = entry.of
    if of.count then
      p[entry.name] = crossed_value(of, i // entry.stride % of.count)
    elseif of.kind == "sobol" then
      p[entry.name] = between(of.from, of.to, sobol.coordinate(entry.directions, i, entry.shift))
    else
      p[entry.name] = between(of.from, of.to, random())
    end
  end
  return p
end

-- ---- running ----

---@class impact.sweep_run
local asked = {
  energy = function(run) return run.scene:energy() end,
  usage = function(run) return run.scene:usage() end,
  events = function(run) return run.usage.events end,
  --- What the energy account misses, over the largest of its energies.
  energy_off = function(run)
    local e = run.energy
    local left = e.start + e.force_work + e.drive_work - e.damping_loss - e.sliding_loss - e.impact_loss - e.kinetic - e.potential
    local scale = max(abs(e.start), e.kinetic, abs(e.potential))
    return scale > 0 and abs(left) / scale or 0.0
  end,
}
local run_meta = {
  __index = function(run, key)
    local answer = asked[key]
    if not answer then
      error(format("a sweep's run has no '%s'; there are: number, parameters, scene, status, message, t, energy, usage, events, energy_off",
        tostring(key)), 2)
    end
    local value = answer(run)
    run[key] = value
    return value
  end,
}

--- Makes and runs the scene; its status and message.
local function perform(self, i, record)
  local p = self:parameters(i)
  local scene, on_event = self.definition.scene(p), self.definition.on_event
  if type(scene) == "table" then scene = core.scene(scene) end
  if getmetatable(scene) == nil or type(scene) ~= "userdata" then
    error(format("sweep: scene must return a scene or its definition, got a %s", type(scene)), 0)
  end
  local reason, message = scene:run { record = record, on_event = on_event and function(event) return on_event(event, p) end }
  local run = { number = i, parameters = p, scene = scene, status = reason or "failed", message = message or "", t = scene:time() }
  return setmetatable(run, run_meta), reason ~= nil
end

local function check_results(self, results)
  if type(results) ~= "table" then error(format("sweep: reduce must return a table, got a %s", type(results)), 0) end
  for name, value in pairs(results) do
    local kind = type(value)
    if not is_name(name) or self.definition.parameters[name] then
      error(format("sweep: '%s' cannot be a result's name", tostring(name)), 0)
    end
    if kind ~= "number" and kind ~= "string" and kind ~= "boolean" then
      error(format("sweep: the result '%s' must be a number, a string or a boolean, got a %s", name, kind), 0)
    end
  end
  return results
end

local function reduced(self, run)
  local reduce, keep = self.definition.reduce, self.definition.keep
  local results = check_results(self, reduce and reduce(run) or { t = run.t })
  return results, keep and keep(run) or false
end

--- The file of a run that is kept.
---@return string
function methods:record_name(i) return format("%s_run_%d.run", self.name or self.definition.name or "sweep", i) end

--- Runs run i again, with the same bits, and writes all its trajectories: a recorded run (docs/run.md). true, or nil and why.
---@param i integer
---@param path? string  record_name(i)
---@return true?, string?
function methods:record(i, path)
  local run, good = perform(self, i, path or self:record_name(i))
  run.scene:close()
  if not good then return nil, run.message end
  return true
end

--- What was raised: of a table the address is all that tostring tells, another one each time.
local function in_words(raised)
  return (type(raised) == "string" or type(raised) == "number") and tostring(raised) or "an error that is not a text"
end

--- Run i: its parameters, its results, its status and message. An error of the script's is a status, too.
---@param i integer
---@return {parameters: table, results: table, status: string, message: string}
function methods:run(i)
  local run, good, results, kept
  local fine, why = pcall(function()
    run, good = perform(self, i, self.definition.record)
    if good then results, kept = reduced(self, run) end
    run.scene:close()
    if kept then
      local wrote, problem = self:record(i)
      if not wrote then error(format("not kept: %s", problem), 0) end
    end
  end)
  local row = { parameters = run and run.parameters or self:parameters(i), results = results or {} }
  row.status, row.message = fine and run.status or "error", fine and run.message or in_words(why)
  return row
end

-- ---- rows for the runner ----

local escapes = { ["\\"] = "\\\\", ["\t"] = "\\t", ["\n"] = "\\n", ["\r"] = "\\r", ["\0"] = "\\0" }

local function escaped(text) return (text:gsub("[\\\t\n\r%z]", escapes)) end

local function cell(value)
  if type(value) == "string" then return '"' .. escaped(value) end
  if type(value) == "boolean" then return tostring(value) end
  if value ~= value then return "nan" end
  return digits(value)
end

--- Run i as a line of the runner's table: run, status, message, the parameters in order, the results as name=value; tabs between.
---@param i integer
---@return string
function methods:line(i)
  local row, cells = self:run(i), {}
  cells[1], cells[2], cells[3] = format("%d", i), row.status, escaped(row.message)
  for _, entry in ipairs(self.list) do cells[#cells + 1] = cell(row.parameters[entry.name]) end
  local names = {}
  for name in next, row.results do names[#names + 1] = name end
  sort(names)
  for _, name in ipairs(names) do cells[#cells + 1] = name .. "=" .. cell(row.results[name]) end
  return concat(cells, "\t")
end

--- The figure that the definition's plot makes of the table, a list for each column; nil without a plot.
function methods:figure(columns)
  local plot = self.definition.plot
  return plot and plot(columns)
end

return sweeps
