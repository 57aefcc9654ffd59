-- SPDX-License-Identifier: MIT
--- scene:verify(): a recorded run's stretches done again by another method, and the gaps along its way.
---
--- The scene is made twice more. One repeats the run, to the bit; the other moves all by the integrator that the first would not take
--- (motion = "other") at a tenth of the tolerance. Right after a stretch between two events begins the other is put into the state of the first, so
--- that nothing is carried on: a difference is of one stretch's motion. Gaps of near bodies are asked of the gap kernel, which shares
--- nothing with the search for contacts: bodies that overlap have a contact that was missed, or lost.
local impact = require "impact"

local ipairs, pairs, pcall, setmetatable = ipairs, pairs, pcall, setmetatable
local format, concat, huge, max, min, sqrt, atan, sort = string.format, table.concat, math.huge, math.max, math.min, math.sqrt, math.atan, table.sort

--- Parts of a stretch: where the other is put into the first's state, and where states are compared; not at the ends, where the other's own
--- events come a little before or after.
local start, places = 0.001, { 0.25, 0.5, 0.75, 0.999 }
--- Of the run's time: what is shorter is not done again, and nothing that is shorter than two flights of the least height that counts as one:
--- a hundred rest heights (IMP_LYING_OF_REST_HEIGHT). In that dying tail one method may lie where the other still rocks.
local shortest, lying, flights = 1e-6, 100, 2 -- and what is slower than such a flight begins may do either, too
--- Of the run's time: where less than this could be done again the run is not verified.
local least_part = 0.5
--- In tolerances: what two methods may differ by in a stretch, each of which errs by some hundred of its own; a wrong force, or a contact
--- lost, makes parts of the way. BDF's order of five leaves more at the least tolerances: 2e-8 on examples/scenes/turntable.lua at 1e-13.
local allowed, least_tolerance = 1e4, 1e-11

---@class impact.verification
---@field x number  greatest difference of places, in units of the longest way or radius of a body
---@field v number  of velocities, and radii times angular velocities, in units of the greatest speed
---@field q number  of orientations, rad
---@field t number  when the greatest of these was, s
---@field body string?  whose it was
---@field gap number  the deepest overlap met, in radii of the smaller body, <= 0
---@field gap_t number  when, s
---@field gap_bodies string[]
---@field stretches integer
---@field replayed integer
---@field part number  of the run's time that was done again
---@field enough boolean  half of the time at least
---@field by string[]  of each kind of motion in the run what the second time was by, in words
---@field good boolean  enough, and all within what is allowed
local verification = {}
verification.__index = verification

local function copy(from, changes)
  local result = {}
  for key, value in pairs(from) do result[key] = value end
  for key, value in pairs(changes) do result[key] = value end
  return result
end

local function tolerance_of(definition)
  return definition.tolerance or definition.methods and definition.methods.tolerance or impact.defaults.tolerance
end

--- How high a bounce is that counts as none, m, and how fast it falls, m/s^2.
local function rest_height_of(definition) return definition.rest_height or impact.defaults.rest_height end

local function gravity_of(definition)
  local g = definition.gravity or impact.defaults.gravity
  local x, y, z = g.x or g[1], g.y or g[2], g.z or g[3]
  local size = sqrt(x * x + y * y + z * z)
  return size > 0 and size or huge
end

--- The definition, to be moved by the other method.
local function another(definition)
  local methods = copy(definition.methods or {}, { motion = "other", tolerance = max(tolerance_of(definition) / 10, 1e-15) })
  methods.step = nil
  local result = copy(definition, { methods = methods })
  result.tolerance = nil
  if result.piles == "steps" then result.piles = nil end
  return result
end

local function length(a, b)
  local x, y, z = a.x - (b and b.x or 0), a.y - (b and b.y or 0), a.z - (b and b.z or 0)
  return sqrt(x * x + y * y + z * z)
end

--- The angle between two orientations.
local function turn(p, q)
  local minus = (p.w - q.w) ^ 2 + (p.x - q.x) ^ 2 + (p.y - q.y) ^ 2 + (p.z - q.z) ^ 2
  local plus = (p.w + q.w) ^ 2 + (p.x + q.x) ^ 2 + (p.y + q.y) ^ 2 + (p.z + q.z) ^ 2
  return 4 * atan(sqrt(min(minus, plus)), sqrt(max(minus, plus)))
end

--- The times at which stretches begin and end.
local function times_of(scene)
  local times, last = { 0.0 }, 0.0
  for _, event in ipairs(scene:events()) do
    if event.t > last then times[#times + 1], last = event.t, event.t end
  end
  if scene:time() > last then times[#times + 1] = scene:time() end
  return times
end

--- Runs on to t; where it cannot, what it says.
local function advance(scene, t)
  local reason, message, kind = scene:run_to(t)
  if not reason then return nil, kind == "run" and message or message or "stopped" end
  return true
end

local worker = {}
worker.__index = worker

--- What moves, its radius, and its way so far.
local function worker_of(scene)
  local self = setmetatable({ bodies = {}, moving = {}, V = 0, X = 0, dx = {}, dv = {}, dq = {} }, worker)
  for _, body in ipairs(scene:record():bodies()) do
    body.radius = body.shape.bounding_radius
    self.bodies[#self.bodies + 1] = body
    if not body.static then self.moving[#self.moving + 1] = body end
  end
  return self
end

--- Keeps the difference when it is the greatest.
local function keep(worst, value, t, body)
  if not (value <= (worst.value or -1)) then worst.value, worst.t, worst.body = value, t, body end
end

function worker:compare(first, other, t)
  for _, body in ipairs(self.moving) do
    local a, b = first:state(body.name), other:state(body.name)
    local r = body.radius
    body.way = (body.way or 0) + (body.last and length(a.position, body.last) or 0)
    body.last = a.position
    self.X = max(self.X, r, body.way)
    local speed = length(a.velocity) + r * length(a.omega)
    self.V = max(self.V, speed)
    keep(self.dx, length(a.position, b.position), t, body.name)
    if max(speed, length(b.velocity) + r * length(b.omega)) > self.slow then
      keep(self.dv, length(a.velocity, b.velocity) + r * length(a.omega, b.omega), t, body.name)
    end
    keep(self.dq, turn(a.orientation, b.orientation), t, body.name)
  end
end

--- Where the shape of a body is.
local function placed(scene, body)
  local state = scene:state(body.name)
  return { shape = body.shape, position = state.position + state.orientation:rotate(body.shape_position),
    orientation = state.orientation * body.shape_orientation }
end

--- The deepest overlap of two bodies that are near: sorted along x, so that not every pair is asked.
function worker:look(scene, t, found)
  local list = {}
  for _, body in ipairs(self.bodies) do
    local at = placed(scene, body)
    list[#list + 1] = { body = body, at = at, from = body.radius < huge and at.position.x - body.radius or -huge }
  end
  sort(list, function(a, b) return a.from < b.from end)
  for i, one in ipairs(list) do
    for k = i + 1, #list do
      local two = list[k]
      if two.from > one.at.position.x + one.body.radius then break end
      local near = length(one.at.position, two.at.position) <= one.body.radius + two.body.radius
      if near and not (one.body.static and two.body.static) then
        local gap = impact.gap(one.at, two.at).gap / min(one.body.radius, two.body.radius)
        if gap < found.gap then found.gap, found.gap_t, found.gap_bodies = gap, t, { one.body.name, two.body.name } end
      end
    end
  end
end

--- Puts each body into the first's state; one that would overlap another may fit once that one has been put: again, as long as some fit.
local function put(bodies, first, other)
  local left, why = bodies, nil
  while #left > 0 do
    local refused = {}
    for _, body in ipairs(left) do
      local s = first:state(body.name)
      local set, said = pcall(other.set, other, body.name, { position = s.position, orientation = s.orientation, velocity = s.velocity, omega = s.omega })
      if not set then refused[#refused + 1], why = body, said end
    end
    if #refused == #left then return false, why end
    left = refused
  end
  return true
end

--- One stretch: true; false where the other cannot be put there; nil where one of the two does not come to its end; and why.
function worker:stretch(first, other, from, to, found)
  local ready, why = advance(first, from + start * (to - from))
  if ready then ready, why = advance(other, from + start * (to - from)) end
  if not ready then return nil, why end
  local set, said = put(self.moving, first, other)
  if not set then return false, said end -- where bodies lie on others: to a rounding they overlap
  for _, place in ipairs(places) do
    local t = from + place * (to - from)
    ready, why = advance(first, t)
    if ready then ready, why = advance(other, t) end
    if not ready then return nil, why end
    self:compare(first, other, t)
    self:look(first, t, found)
  end
  return true
end

--- Whether the first comes to the run's end with the run's bits. What came to rest stood still just after its time.
function worker:repeats(scene, first)
  local rests = scene:run_to(scene:time()) == "at rest"
  if not advance(first, rests and scene:duration() or scene:time()) then return false end
  for _, body in ipairs(self.moving) do
    local a, b = scene:state(body.name), first:state(body.name)
    if length(a.position, b.position) ~= 0 or length(a.velocity, b.velocity) ~= 0 or length(a.omega, b.omega) ~= 0 then return false end
  end
  return true
end

--- In units of the scene, and whether all is within what is allowed.
function worker:judge(found, tolerance)
  local function part(worst, unit) return unit > 0 and (worst.value or 0) / unit or worst.value or 0 end
  found.x, found.v, found.q = part(self.dx, self.X), part(self.dv, self.V), self.dq.value or 0
  local worst = found.x >= max(found.v, found.q) and self.dx or found.v >= found.q and self.dv or self.dq
  found.t, found.body = worst.t or 0, worst.body
  found.limit = allowed * max(tolerance, least_tolerance)
  found.enough = found.part >= least_part
  found.good = found.enough and max(found.x, found.v, found.q) <= found.limit and -found.gap <= found.limit
end

--- What the second time found, in a line.
function verification:text()
  local text = format("%d of %d stretches (%.4g %% of the time) done again by the other method: off by %.1g", self.replayed, self.stretches,
    100 * self.part, max(self.x, self.v, self.q))
  if self.body then text = text .. format(" (%s, t = %.6g s)", self.body, self.t) end
  if self.gap < 0 then text = text .. format("; %s and %s overlap by %.1g of a radius (t = %.6g s)", self.gap_bodies[1], self.gap_bodies[2], -self.gap, self.gap_t) end
  if not self.enough then return text .. format("; at least %.4g %% is to be", 100 * least_part) end
  text = text .. (self.good and "" or format("; allowed are %.1g", self.limit))
  return #self.by > 0 and format("%s (%s)", text, concat(self.by, "; ")) or text
end

--- What a run's kinds of motion are by when the other method moves them.
local function second_methods(usage)
  local by = {}
  local function add(count, words) if count > 0 then by[#by + 1] = words end end
  add(usage.ballistic_flights, "flight in closed form: by CVODE's BDF")
  add(usage.rolls - usage.glides, "balls that rolled in closed form: by CVODE's BDF")
  add(usage.integrator_steps, "what was integrated: by CVODE's BDF, by its Adams where BDF was first")
  add(usage.glides, "what glided on a face: by the same solver, from another start")
  add(usage.pile_steps, "piles by steps: each contact's force, integrated")
  return by
end

--- Of a run that was recorded; nil and why where the other method cannot do it.
local function of(scene)
  local definition = scene:definition()
  if not impact.has "cvode" then return nil, "a run is verified by another integrator, and this build has none" end
  local times, work = times_of(scene), worker_of(scene)
  local first, made, other = impact.scene(copy(definition, {})), pcall(impact.scene, another(definition))
  if not made then return nil, "not verified: the other integrator cannot move it: " .. other end
  local whole = times[#times]
  local found = setmetatable({ stretches = #times - 1, replayed = 0, part = whole > 0 and 0 or 1, gap = 0 }, verification)
  local height, g = lying * rest_height_of(definition), gravity_of(definition)
  local least = max(shortest * whole, flights * sqrt(8 * height / g))
  work.slow = g < huge and sqrt(2 * g * height) or 0
  for k = 2, #times do
    local from, to = times[k - 1], times[k]
    if to - from > least then
      local done, why = work:stretch(first, other, from, to, found)
      if done == nil then return nil, format("not verified from t = %.6g s on: %s", from, why) end
      if done then found.replayed, found.part = found.replayed + 1, found.part + (to - from) / whole end
    end
  end
  if not work:repeats(scene, first) then return nil, "two runs of the scene differ: a law of it remembers, or draws lots" end
  found.by = second_methods(scene:usage())
  work:judge(found, tolerance_of(definition))
  return found
end

return { of = of }
