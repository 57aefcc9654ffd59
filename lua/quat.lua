-- SPDX-License-Identifier: MIT
--- Quaternions: `local quat = require "quat"`. Loads libquat and libm; the rooms that need GSL load when first used.

---@class quat
---@field w number
---@field x number
---@field y number
---@field z number

---@class vec3  {x, y, z}; also v.x, v.y, v.z
---@field x number
---@field y number
---@field z number

local core = require "quat.core"
core.layer()

---@class quatlib
---@field new fun(w: number, x: number, y: number, z: number): quat
local quat = {}
for name, value in pairs(core) do
  if name ~= "layer" then quat[name] = value end
end

-- quat.average, quat.curve ...: the rooms of quat.gsl, where the build holds them.
setmetatable(quat, {
  __index = function(self, key)
    local found, gsl = pcall(require, "quat.gsl")
    if not found or type(gsl) ~= "table" then return nil end
    local value = gsl[key]
    rawset(self, key, value)
    return value
  end,
})

return quat
