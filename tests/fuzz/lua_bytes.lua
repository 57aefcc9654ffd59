-- SPDX-License-Identifier: MIT
--- Numbers, choices and values out of a fuzzer's bytes; each value comes with the Lua that makes it.
local bytes = {}
bytes.__index = bytes

function bytes.new(text) return setmetatable({ text = text, at = 0 }, bytes) end

function bytes:byte()
  self.at = self.at + 1
  return self.text:byte(self.at) or 0
end

function bytes:below(n) return (self:byte() * 256 + self:byte()) % n end

function bytes:pick(list) return list[1 + self:below(#list)] end

--- x as Lua reads it.
function bytes.number(x)
  if x ~= x then return "0/0" end
  if x == math.huge then return "math.huge" end
  if x == -math.huge then return "-math.huge" end
  if x == math.mininteger then return "math.mininteger" end
  return math.type(x) == "integer" and tostring(x) or string.format("%.17g", x)
end

local plain = { 0, 1, -1, 0.5, 2, 3, 0.1, -0.25, 1e-9, 10, 1e6, 100, -0.0, 0.3 }
local wild = { 0 / 0, math.huge, -math.huge, math.maxinteger, math.mininteger, 1e300, 5e-324, -1e308, 1e154 }

--- A number: plain ones mostly, any now and then.
function bytes:any_number()
  local kind = self:byte()
  if kind < 140 then return plain[kind % #plain + 1] end
  if kind < 165 then return wild[kind % #wild + 1] end
  return (self:byte() * 256 + self:byte()) / 32768 - 1
end

return bytes
