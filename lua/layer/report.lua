-- SPDX-License-Identifier: MIT
--- scene:report{...} as a table in words, a CSV file and a picture: what each method gets right, how sure that is, what it costs.
local csv = require "quat.csv"
local plot = require "quat.plot"

local error, io, ipairs, pairs, setmetatable, tostring, type = error, io, ipairs, pairs, setmetatable, tostring, type
local format, concat, huge = string.format, table.concat, math.huge

---@class impact.report
---@field rows impact.report.row[]  method by method, each from loose to tight
---@field summary table  reference, certainty, condition, horizon: the fields of impact_report_summary
---@field name string
local report = {}
report.__index = report

local colors = {
  ["default"] = "blue", ["motion = cvode"] = "green", ["impacts = cvode"] = "orange", ["gaps = ccd"] = "red", ["textbook"] = "purple",
  ["motion = rk4"] = "dark",
}
local goals = { 1e-3, 1e-6, 1e-9, 1e-12 }

--- 2e-14 as people write it.
local function short(x)
  if x ~= x or x == huge then return "-" end
  return (format("%.0e", x):gsub("e([+-])0*(%d+)$", function(sign, digits) return "e" .. (sign == "-" and "-" or "") .. digits end))
end

local function setting_of(method, setting)
  if setting == 0 then return "" end
  return method == "motion = rk4" and format("%.3g s", setting) or short(setting)
end

--- A row that reached the end, whose events are the reference's.
local function good(row) return row.rounds > 0 and row.e < huge and row.other_events == 0 end

--- The methods met, in order, and their rows.
local function by_method(rows)
  local order, of = {}, {}
  for _, row in ipairs(rows) do
    if not of[row.method] then order[#order + 1], of[row.method] = row.method, {} end
    local list = of[row.method]
    list[#list + 1] = row
  end
  return order, of
end

--- Its error, or what is known of it: never less than the certainty; infinite where nobody vouches for the reference.
function report:error_of(row)
  if not self.summary.sure then return huge end
  return row.below and self.summary.certainty.e or row.e
end

--- The least CPU time, s, in which a method comes to the error: nil where it does not.
---@param method string
---@param goal number
---@return number?
function report:time_to(method, goal)
  local best
  for _, row in ipairs(self.rows) do
    if row.method == method and good(row) and self:error_of(row) <= goal and (not best or row.cpu < best) then best = row.cpu end
  end
  return best
end

--- Whether bodies were moved by steps (docs/model.md).
function report:is_stepped()
  for _, row in ipairs(self.rows) do
    if row.usage.pile_steps > 0 then return true end
  end
  return false
end

--- Whether bodies glided on faces, which is by the same solver in every row.
function report:glides()
  for _, row in ipairs(self.rows) do
    if row.usage.glides > 0 then return true end
  end
  return false
end

--- The best row of a method: the least error, then the least time. nil where no error is known.
function report:best(method)
  local best
  for _, row in ipairs(self.rows) do
    if row.method == method and good(row) and self:error_of(row) < huge then
      local e, least = self:error_of(row), best and self:error_of(best)
      if not best or e < least or (e == least and row.cpu < best.cpu) then best = row end
    end
  end
  return best
end

local function witness_of(witness, what)
  return format("%s, %s (%s)", witness.method, setting_of(witness.method, witness.setting), what)
end

local function reference_line(s, stepped, glides)
  local c = s.certainty
  if s.reference ~= s.reference then return format("an oracle's, of error %s", short(c.e)) end
  local name = s.reference == 0 and "default" or format("default at %s", short(s.reference))
  if not s.sure then return name .. ", certainty unknown: " .. (stepped and "what is moved by steps is so by every method" or
    glides and "what glides on a face does so by every method" or "no other method of motion came to the end") end
  local by, shared = witness_of(s.motion_witness, "motion"), "supports, gaps, held contacts"
  if s.impact_witness then by = by .. " and " .. witness_of(s.impact_witness, "impacts") else shared = shared .. ", impacts" end
  if glides then shared = shared .. ", motion on faces" end
  return format("%s, sure to %s (position), %s (velocity), %s rad, %s s (events) by %s; shared: %s", name, short(c.e_x), short(c.e_v),
    short(c.e_q), short(c.e_t), by, shared)
end

local function condition_line(s)
  if s.condition ~= s.condition then return "unknown" end
  return format("%.2g: rounding of the data alone makes %s", s.condition, short(s.condition * 0x1p-53))
end

--- A time in ms, to two or three digits.
local function ms(t)
  if not t then return "-" end
  local x = 1e3 * t
  return x >= 100 and format("%.0f", x) or x >= 1 and format("%.1f", x) or format("%.2f", x)
end

--- What it means, in a sentence.
---@return string
function report:verdict()
  local s, order = self.summary, by_method(self.rows)
  local own = self:best "default"
  if not s.sure or not own then
    local fastest
    for _, row in ipairs(self.rows) do
      if row.method == "default" and good(row) and (not fastest or row.cpu < fastest) then fastest = row.cpu end
    end
    return format("none: no second method vouches for the first, whose errors nobody knows%s", fastest and "; it takes " .. ms(fastest) .. " ms" or "")
  end
  local e = self:error_of(own)
  local words = { format("default: %s%s in %s ms", own.below and "<= " or "", short(e), ms(own.cpu)) }
  for _, method in ipairs(order) do
    local best = method ~= "default" and self:best(method)
    if best then
      local match = self:time_to("default", math.max(self:error_of(best), e))
      words[#words + 1] = format("%s %s%s in %s", method, best.below and "<= " or "", short(self:error_of(best)),
        match and format("%.2g times the default's time to that", best.cpu / match) or ms(best.cpu) .. " ms")
    elseif method ~= "default" then
      words[#words + 1] = method .. ": no run came to the end with the same events"
    end
  end
  if s.horizon < s.duration then
    words[#words + 1] = format("until t = %.4g s: then reference and witness part, and nobody knows", s.horizon)
  end
  return concat(words, "; ")
end

--- Where the default is slower than the fixed step at an error, or less sure than it should be: the bars, named where missed.
local function misses(self)
  local list = {}
  for _, goal in ipairs(goals) do
    local own, step = self:time_to("default", goal), self:time_to("motion = rk4", goal)
    if own and step and step < own then list[#list + 1] = format("rk4 reaches %s in %.2g of the default's time", short(goal), step / own) end
  end
  if self.summary.sure and self.summary.certainty.e > 1e-10 then
    list[#list + 1] = format("the reference is sure to %s only", short(self.summary.certainty.e))
  end
  return list
end

--- What went wrong with a row: the kind, and the words without what changes from setting to setting; nil: nothing.
local function trouble_of(row)
  if row.rounds > 0 and row.e == huge then
    local words = row.message ~= "" and row.message or row.ended
    return "failed", words, (words:gsub("%-?%d+%.?%d*[eE]?[+-]?%d*", "#"))
  elseif row.other_events > 0 then
    return "other", format("other events of %d pair%s", row.other_events, row.other_events == 1 and "" or "s"), "other events"
  end
end

--- One line for each cause: the settings of a method that fail alike, the earliest time, the first one's words.
function report:troubles()
  local order, of = by_method(self.rows)
  local lines = {}
  for _, method in ipairs(order) do
    local causes, found = {}, {}
    for _, row in ipairs(of[method]) do
      local kind, words, cause = trouble_of(row)
      if kind then
        local at = kind == "failed" and row.reached or row.first_other
        if not found[cause] then
          found[cause] = { kind = kind, words = words, first = row.setting, at = at, count = 0 }
          causes[#causes + 1] = found[cause]
        end
        local c = found[cause]
        c.last, c.at, c.count = row.setting, math.min(c.at, at), c.count + 1
      end
    end
    for _, c in ipairs(causes) do
      local first, last = setting_of(method, c.first), setting_of(method, c.last)
      local settings = c.count == 1 and first or format("%d settings, %s to %s", c.count, first, last)
      lines[#lines + 1] = format("  %-11s %s%s: t = %.4g s: %s", c.kind, method, settings ~= "" and ", " .. settings or "", c.at, c.words)
    end
  end
  return lines
end

--- The table of the terminal.
---@return string
function report:text()
  local s, order = self.summary, (by_method(self.rows))
  local out = {
    format("%s: error against run time   %d times, %d events, %d rounds", self.name, s.times, s.events, s.rounds),
    "  reference   " .. reference_line(s, self:is_stepped(), self:glides()),
    "  condition   " .. condition_line(s),
    format("  %-22s%10s%10s%10s%10s%12s", "ms to reach", "1e-3", "1e-6", "1e-9", "1e-12", "at best"),
  }
  for _, method in ipairs(order) do
    local cells, best = {}, self:best(method)
    for i, goal in ipairs(goals) do cells[i] = format("%10s", ms(self:time_to(method, goal))) end
    out[#out + 1] = format("  %-22s%s%12s", method, concat(cells), best and (best.below and "<= " or "") .. short(self:error_of(best)) or "-")
  end
  for _, line in ipairs(self:troubles()) do out[#out + 1] = line end
  if #s.useless > 0 then out[#out + 1] = "  left out    change nothing here: " .. concat(s.useless, ", ") end
  if s.dropped > 0 then out[#out + 1] = format("  dropped     %d settings that had no time; --seconds gives more", s.dropped) end
  for _, miss in ipairs(misses(self)) do out[#out + 1] = "  missed      " .. miss end
  out[#out + 1] = "  verdict     " .. self:verdict()
  return concat(out, "\n") .. "\n"
end

local measured = { "e_x", "e_v", "e_q", "e_t", "e", "other_events", "first_other", "dying", "account" }
local counters = { "ballistic_flights", "rolls", "glides", "integrator_steps", "integrator_rhs_calls", "gap_closed_form", "gap_newton", "gap_ccd",
  "impacts_closed_form", "impacts_series", "impacts_cvode", "pile_steps" }

--- Names and columns of the CSV file: one row a setting.
---@return string[] names
---@return (number|string)[][] columns
function report:columns()
  local names, columns = {}, {}
  local function add(name, value)
    local column = {}
    for i, row in ipairs(self.rows) do column[i] = value(row) end
    names[#names + 1], columns[#columns + 1] = name, column
  end
  add("method", function(row) return row.method end)
  add("setting", function(row) return row.setting end)
  for _, key in ipairs(measured) do add(key, function(row) return row[key] end) end
  add("below_certainty", function(row) return row.below and 1 or 0 end)
  add("cpu_ms", function(row) return 1e3 * row.cpu end)
  add("spread", function(row) return row.spread end)
  add("rounds", function(row) return row.rounds end)
  for _, key in ipairs(counters) do add(key, function(row) return row.usage[key] end) end
  add("ended", function(row) return row.rounds == 0 and "dropped" or row.message ~= "" and row.message or row.ended end)
  return names, columns
end

--- Writes NAME.csv: in the runner's output folder, or where the name says. true, or nil and why.
---@param name string
---@return true?, string?
function report:csv(name)
  return csv.save(name, self:columns())
end

--- The points of a method's rows: those with the reference's events, and the others.
local function points_of(self, rows)
  local x, y, other_x, other_y = {}, {}, {}, {}
  for _, row in ipairs(rows) do
    local e = self:error_of(row)
    if row.rounds > 0 and e < huge and e > 0 then
      local to_x, to_y = row.other_events > 0 and other_x or x, row.other_events > 0 and other_y or y
      to_x[#to_x + 1], to_y[#to_y + 1] = 1e3 * row.cpu, e
    end
  end
  return x, y, other_x, other_y
end

--- The log-log picture: one line a method, its ends named by their settings, crosses where events differ; dashed the certainty, grey
--- what rounding alone makes.
---@return plot.figure
function report:figure()
  local s, order, of = self.summary, by_method(self.rows)
  local panel = { title = self.name .. ": error against run time", xlabel = "CPU time, ms", ylabel = "greatest error", xlog = true, ylog = true,
    legend = "top right" }
  local function add(item) panel[#panel + 1] = item end
  for _, method in ipairs(order) do
    local color, label = colors[method], method
    local x, y, other_x, other_y = points_of(self, of[method])
    if #x > 1 then
      add(plot.line { x, y, color = color, label = label })
      label = nil
    end
    if #x > 0 then add(plot.points { x, y, color = color, label = label }) end
    if #other_x > 0 then add(plot.points { other_x, other_y, color = color, shape = "cross", label = method .. ", other events" }) end
    local first, last = of[method][1], of[method][#of[method]]
    for _, row in ipairs(first == last and { first } or { first, last }) do
      local e = self:error_of(row)
      if row.rounds > 0 and e > 0 and e < huge and row.setting > 0 then
        add(plot.text { setting_of(method, row.setting), at = { 1e3 * row.cpu, 1.6 * e }, color = color, align = "left", size = 9 })
      end
    end
  end
  local certainty, rounding = s.certainty.e, s.condition * 0x1p-53
  local low, high = huge, 0
  for _, row in ipairs(self.rows) do
    local e = self:error_of(row)
    if row.rounds > 0 and e > 0 and e < huge then low, high = math.min(low, e), math.max(high, e) end
  end
  if rounding > 0 then low = math.min(low, rounding) end
  if high > 0 then panel.yrange = { low / 5, math.max(10 * high, 1e3 * low) } end
  if s.sure and certainty > 0 and certainty < huge then add(plot.mark { y = certainty, color = "black", dash = true, label = "certainty" }) end
  if rounding > 0 then add(plot.mark { y = rounding, color = "grey", label = "rounding of the data" }) end
  return plot.figure { size = { 900, 620 }, plot.panel(panel) }
end

local components = { "x", "y", "z", "qw", "qx", "qy", "qz", "vx", "vy", "vz", "wx", "wy", "wz" }

--- An oracle's CSV (t, body, x y z, qw qx qy qz, vx vy vz, wx wy wz; lines that begin with "#" are remarks) as report_rows wants it.
local function read_reference(scene, path)
  if not io.open then error("report: reference: a script opens no files here; see --trust", 0) end
  local file, why = io.open(path)
  if not file then error("report: reference: " .. why, 0) end
  local text = file:read "a"
  file:close()
  local place, list = {}, {}
  for i, body in ipairs(scene:definition().bodies) do place[body.name] = i - 1 end
  for n, row in ipairs(csv.rows(text)) do
    local body = place[tostring(row.body)]
    if not body then error(format("%s: row %d: the scene has no body '%s'", path, n, tostring(row.body)), 0) end
    if type(row.t) ~= "number" then error(format("%s: row %d: t is no number", path, n), 0) end
    list[#list + 1], list[#list + 2] = row.t, body
    for _, key in ipairs(components) do
      if type(row[key]) ~= "number" then error(format("%s: row %d: %s is no number", path, n, key), 0) end
      list[#list + 1] = row[key]
    end
  end
  return list
end

--- Runs the report: options as in impact_report_def; reference: a path, reference_error its error.
function report.of(scene, options)
  local own = {}
  for key, value in pairs(options or {}) do own[key] = value end
  if type(own.reference) == "string" then own.reference = read_reference(scene, own.reference) end
  local rows, summary = scene:report_rows(own)
  if not rows then return nil, summary end
  return setmetatable({ rows = rows, summary = summary, name = scene:name() }, report)
end

return report
