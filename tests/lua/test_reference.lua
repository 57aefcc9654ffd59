-- SPDX-License-Identifier: MIT
--- test_reference.lua SOURCE WORK: the functions that a script finds and those of the reference are the same. Data and keys of tables
--- that are given are not looked at.
local check = require "check"
local source, work = arg[1], arg[2]
local quat, impact = require "quat", require "impact"

-- ---- what a script finds ----

local found = {}
local function add(owner, functions)
  for name, value in pairs(functions) do
    if type(value) == "function" and not name:find "^__" then found[owner .. "." .. name] = true end
  end
end
--- The methods of a value: the table behind its __index, or the one that its function keeps.
local function add_methods(owner, value)
  local meta = debug.getmetatable(value)
  local methods = type(meta.__index) == "table" and meta.__index or meta.methods
  if not methods then methods = select(2, debug.getupvalue(meta.__index, 1)) end
  check.equal(type(methods), "table")
  add(owner, methods)
end

local q = quat.identity()
add("quat", quat)
add_methods("quat", q)
add_methods("vec3", quat.vec3(1, 2, 3))
add_methods("motion", quat.motion(q, { 0, 0, 0 }))
add_methods("rotation_spline", quat.spline { times = { 0, 1, 2, 3 }, keys = { q, q, q, q } })
add("quat.curve", quat.curve)
add_methods("curve", quat.curve.circle(1))
add("quat.surface", quat.surface)
add_methods("surface", quat.surface.sphere(1))
for _, module in ipairs { "quat.plot", "quat.csv", "impact.portrait", "impact.sobol" } do add(module, require(module)) end
add("impact", impact)
add("impact", require "impact.sweep")
add_methods("impact.shape", impact.sphere(1))
local scene = impact.scene { duration = 1, bodies = { impact.body { name = "ball", shape = impact.sphere(1), position = { 0, 0, 0 } } } }
scene:run { record = true }
add_methods("impact.scene", scene)
add_methods("impact.run", scene:record())
add_methods("impact.sweep", impact.sweep { parameters = {}, scene = function() return scene end })
add("impact.report", require "impact.report")
if impact.has "cvode" then add_methods("impact.verification", scene:verify()) end

-- ---- what the reference says ----

local folder = work .. "/reference"
assert(os.execute(("mkdir -p '%s' && '%s' '%s/docs/reference.lua' '%s' '%s' >'%s/log'"):format(folder, arg[-1] or "lua", source, source, folder, work)))
local told, pages = {}, {}
for line in io.lines(folder .. "/index.md") do
  local name, page, anchor = line:match "^%- %[`(.-)`%]%(([%w_]+%.md)#(.-)%)"
  if name then
    if not pages[page] then pages[page] = assert(io.open(folder .. "/" .. page)):read "a" end
    check.truth(pages[page]:find("{ #" .. anchor .. " }", 1, true), anchor .. " has its place on " .. page)
    if page:find "^lua_" and name:find "%(%)$" then told[anchor] = true end
  end
end

local count, missing, stale = 0, {}, {}
for name in pairs(found) do
  count = count + 1
  if not told[name] then missing[#missing + 1] = name end
end
local keys = { definition = true, options = true, force = true, sweep_definition = true } -- functions in tables that a script gives
for name in pairs(told) do
  if not found[name] and not keys[name:match "^impact%.([%w_]+)%."] then stale[#stale + 1] = name end
end
table.sort(missing)
table.sort(stale)
check.equal("not in the reference: " .. table.concat(missing, " "), "not in the reference: ")
check.equal("in the reference alone: " .. table.concat(stale, " "), "in the reference alone: ")
check.truth(count > 200, count .. " functions")
check.report("reference")
