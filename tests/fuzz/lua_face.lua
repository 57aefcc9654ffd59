-- SPDX-License-Identifier: MIT
--- Calls of every function that a script can reach, with values of every kind; results are handed on to later calls. What
--- a call raises is a message in words of the caller's, not of a slip inside our layers.
local bytes = require "lua_bytes"
local impact, quat, plot = require "impact", require "quat", require "quat.plot"
require "quat.csv"
pcall(require, "quat.gsl")

-- Not called: what writes files, and what is told to raise.
local skip = { [plot.save] = true, [require("quat.csv").save] = true, [require("impact.portrait").planar] = true }
local functions, seen = {}, {}

local function gather(value, name, depth)
  if type(value) == "function" and not seen[value] and not skip[value] then
    seen[value] = true
    functions[#functions + 1] = { name = name, call = value }
  end
  if type(value) ~= "table" or seen[value] or depth > 4 then return end
  seen[value] = true
  local keys = {}
  for key in pairs(value) do
    if type(key) == "string" then keys[#keys + 1] = key end
  end
  table.sort(keys)
  for _, key in ipairs(keys) do gather(value[key], name .. "." .. key, depth + 1) end
end

local objects = {
  { "impact.sphere(1)", impact.sphere(1) },
  { "impact.plane()", impact.plane() },
  { "impact.superquadric { a = 1, b = 0.5, c = 0.7, r = 2, s = 3, t = 4 }", impact.superquadric { a = 1, b = 0.5, c = 0.7, r = 2, s = 3, t = 4 } },
  { "quat.new(1, 2, 3, 4)", quat.new(1, 2, 3, 4) },
  { "quat.vec3(1, 2, 3)", quat.vec3(1, 2, 3) },
}
local function small_scene()
  return impact.scene { name = "s", duration = 0.01, bodies = {
    impact.body { name = "b", shape = impact.sphere(1), position = { 0, 0, 0 } },
    impact.body { name = "f", shape = impact.plane(), position = { 0, 0, -5 } },
  } }
end
local scene_text = 'impact.scene { name = "s", duration = 0.01, bodies = { impact.body { name = "b", shape = impact.sphere(1) }, '
  .. 'impact.body { name = "f", shape = impact.plane(), position = { 0, 0, -5 } } } }'

gather(impact, "impact", 0)
gather(quat, "quat", 0)
gather(plot, "plot", 0)
gather(require "quat.csv", "csv", 0)
for _, object in ipairs(objects) do gather(getmetatable(object[2]), "getmetatable(" .. object[1] .. ")", 0) end
gather(getmetatable(small_scene()), "getmetatable(" .. scene_text .. ")", 0)

local keys = { "x", "y", "z", "w", "name", "shape", "radius", "mass", "bodies", "duration", "normal", "friction", "law", "n", "a", "b", "c",
  "r", "t", "p", "q", "position", "velocity", "count", "first", "point" }

local value -- value(b, made, depth): a value and its text

local function list(b, made, depth, length)
  local t, texts = {}, {}
  for i = 1, length do
    local text
    t[i], text = value(b, made, depth + 1)
    if t[i] == nil then t[i], text = 0, "0" end
    texts[i] = text
  end
  return t, "{ " .. table.concat(texts, ", ") .. " }"
end

local function record(b, made, depth)
  local t, texts = {}, {}
  for i = 1, 4 do
    local key = b:pick(keys)
    local v, text = value(b, made, depth + 1)
    t[key], texts[i] = v, key .. " = " .. text
  end
  return t, "{ " .. table.concat(texts, ", ") .. " }"
end

local words = { "xyz", "ZYX", "south", "body", "poisson", "", ("\0a"):rep(20) }

function value(b, made, depth)
  local kind = b:below(20)
  if kind == 0 then return nil, "nil" end
  if kind == 1 then return true, "true" end
  if kind == 2 then
    local word = b:pick(words)
    return word, string.format("%q", word)
  end
  if kind == 3 then return function(x) return x, 0, 1 end, "function(x) return x, 0, 1 end" end
  if kind < 7 and #made > 0 then
    local k = 1 + b:below(#made)
    return made[k], "r[" .. k .. "]"
  end
  if kind < 10 then
    local object = b:pick(objects)
    return object[2], object[1]
  end
  if kind == 10 and depth < 3 then return record(b, made, depth) end
  if kind < 14 and depth < 3 then return list(b, made, depth, 1 + b:below(5)) end
  local x = b:any_number()
  return x, bytes.number(x)
end

return function(text)
  local b, made = bytes.new(text), {}
  tell 'local impact, quat, plot, csv, r = require "impact", require "quat", require "quat.plot", require "quat.csv", {}'
  for _ = 1, 12 do
    local f = b:pick(functions)
    local given, texts, count = {}, {}, b:below(6)
    for i = 1, count do given[i], texts[i] = value(b, made, 0) end
    tell(string.format("r[%d] = %s(%s)", #made + 1, f.name, table.concat(texts, ", ")))
    local good, result = pcall(f.call, table.unpack(given, 1, count))
    if good then
      if result ~= nil then made[#made + 1] = result end
    elseif type(result) ~= "string" then error("raises a " .. type(result))
    elseif result:find "^[^:]*/modules/[^:]*%.lua:%d+: attempt to" then error("our layer slips: " .. result) end
  end
end
