-- SPDX-License-Identifier: MIT
--- Scripts as people write them, with slips: a scene of random bodies, some keys misspelt, some values of the wrong kind.
--- What is wrong is told with the script's line; what is right runs to an end, or says why not.
local bytes = require "lua_bytes"

local function vector(b, size)
  local x = {}
  for i = 1, 3 do x[i] = bytes.number(size * (b:byte() - 128) / 128) end
  return "{ " .. table.concat(x, ", ") .. " }"
end

local function size(b) return bytes.number(0.05 + b:byte() / 256) end

local function shape(b)
  local kind = b:below(5)
  if kind == 0 then return "impact.plane()" end
  if kind <= 2 then return string.format("impact.sphere(%s)", size(b)) end
  if kind == 3 then return string.format("impact.ellipsoid(%s, %s, %s)", size(b), size(b), size(b)) end
  return string.format("impact.superquadric { a = %s, b = %s, c = %s, r = %g, s = %g, t = %g }", size(b), size(b), size(b),
    1 + b:byte() / 64, 1 + b:byte() / 64, 1 + b:byte() / 64)
end

local slips = { "nil", "true", '"x"', "{}", "-1", "0/0", "math.huge", "function() end", "print", "{ 1, 2 }", "impact", "1e300" }

--- One line "key = value", now and then with a slip in one of them.
local function line(b, key, text)
  local kind = b:byte()
  if kind < 6 then key = key:sub(1, 1) .. key:sub(3) .. "e" end
  if kind > 249 then text = b:pick(slips) end
  return string.format("      %s = %s,", key, text)
end

local function body(b, i)
  local lines = { "    impact.body {", line(b, "name", string.format("%q", "b" .. i)), line(b, "shape", shape(b)) }
  local function add(key, text)
    if b:byte() < 150 then lines[#lines + 1] = line(b, key, text) end
  end
  lines[#lines + 1] = line(b, "position", string.format("{ %g, %g, %g }", 2.4 * (i % 3), 2.4 * (i // 3), b:byte() / 64))
  add("velocity", vector(b, 4))
  add("omega", vector(b, 9))
  add("orientation", string.format("{ 1, %g, %g, 0 }", b:byte() / 99, b:byte() / 99))
  add("friction", bytes.number(b:byte() / 128))
  add("restitution", bytes.number(b:byte() / 255))
  if b:byte() < 40 then lines[#lines + 1] = line(b, "linear_damping", bytes.number(b:byte() / 300)) end
  lines[#lines + 1] = "    },"
  return table.concat(lines, "\n")
end

local forces = {
  'impact.wind { direction = { 1, 0, 0 }, strength = 3, reach = 2 }',
  'impact.attraction { constant = 2 }',
  'impact.force { law = function(t, body) return { -body.position.x, 0, 0 } end }',
  'impact.force { law = function(t, body) error "mine" end }',
  'impact.force { law = function(t, body) return "no" end }',
  'impact.force { law = function(t, body) return { 0 / 0, 0, 0 } end }',
}

local function script(b)
  local lines = { 'local impact = require "impact"', "return impact.scene {" }
  local function add(key, text) lines[#lines + 1] = line(b, key, text) end
  add("name", '"s"')
  add("duration", bytes.number(0.02 + b:byte() / 1000))
  add("output_rate", bytes.number(b:below(60)))
  if b:byte() < 128 then add("gravity", vector(b, 10)) end
  if b:byte() < 40 then add("law", b:pick { '"newton"', '"stronge"', '"poisson"', '"none"' }) end
  if b:byte() < 40 then add("tolerance", b:pick { "1e-6", "1e-9", "1e-13", "1e-20", "1" }) end
  lines[#lines + 1] = "  max_events = 200,\n  bodies = {"
  for i = 0, b:below(4) do lines[#lines + 1] = body(b, i) end
  lines[#lines + 1] = "  },"
  if b:byte() < 50 then lines[#lines + 1] = "  forces = { " .. b:pick(forces) .. " }," end
  lines[#lines + 1] = "}"
  return table.concat(lines, "\n")
end

return function(text)
  local b = bytes.new(text)
  local source = script(b)
  tell(source)
  local chunk = assert(load(source, "=script"))
  local good, scene = pcall(chunk)
  if not good then
    if type(scene) ~= "string" or not scene:find "^script:%d+: " then error("no line is named: " .. tostring(scene)) end
    return
  end
  local ran, reason, message = pcall(scene.run, scene, { record = true })
  if not ran then
    if type(reason) ~= "string" or not reason:find "^script:%d+: " then error("no line is named: " .. tostring(reason)) end
  elseif reason == nil and (type(message) ~= "string" or message == "") then error "nil, and no message" end
end
