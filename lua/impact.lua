-- SPDX-License-Identifier: MIT
--- Rigid bodies that hit each other: `local impact = require "impact"`. The guide is docs/scene.md.

local core = require "impact.core"
core.layer()

---@class impact.shape
---@field kind string
---@field volume number  m^3
---@field inertia vec3  per unit mass, m^2
---@field bounding_radius number  m

---@class impactlib
---@field version string
---@field has fun(part: "cvode"|"ccd"): boolean  whether this build holds the part
---@field sphere fun(radius: number|{radius: number}): impact.shape
---@field plane fun(bounds?: {width?: number, depth?: number}): impact.shape
local impact = {}
for name, value in pairs(core) do
  if name ~= "layer" then impact[name] = value end
end

return impact
