-- SPDX-License-Identifier: MIT
--- A figure as a page of its own, drawn by our renderer (view/figure.js): `require "quat.page"`; behind quat.plot and the runner.
local gnuplot = require "quat.gnuplot"
local digits = gnuplot.digits
local template = require "quat.page_template"

local pairs, type = pairs, type
local byte, find, format, gsub, sub = string.byte, string.find, string.format, string.gsub, string.sub
local concat, sort, tostring = table.concat, table.sort, tostring

local page = {}

local escapes = { ['"'] = '\\"', ["\\"] = "\\\\", ["\n"] = "\\n", ["\r"] = "\\r", ["\t"] = "\\t" }
local function quoted(text)
  return '"' .. gsub(text, '[%c"\\<]', function(c) return escapes[c] or format("\\u%04x", byte(c)) end) .. '"'
end

local deepest = 12

--- Plain data as JSON, in which no '<' stands. Lists are arrays; a table with names is an object, whose list, if it has one, is under
--- "items". What is not finite is null.
---@param value any
---@param depth? integer
---@return string
function page.json(value, depth)
  depth = depth or 0
  local kind = type(value)
  if kind == "number" then return value - value == 0 and digits(value, "%.17g") or "null" end
  if kind == "string" then return quoted(value) end
  if kind == "boolean" then return tostring(value) end
  if kind ~= "table" or depth > deepest then return "null" end
  local list, named = {}, {}
  for i = 1, #value do list[i] = page.json(value[i], depth + 1) end
  for key, member in pairs(value) do
    if type(key) == "string" then named[#named + 1] = quoted(key) .. ":" .. page.json(member, depth + 1) end
  end
  local items = "[" .. concat(list, ",") .. "]"
  if #named == 0 then return items end
  sort(named)
  if #list > 0 then named[#named + 1] = '"items":' .. items end
  return "{" .. concat(named, ",") .. "}"
end

local function put(text, key, value)
  local from, to = find(text, key, 1, true)
  return sub(text, 1, from - 1) .. value .. sub(text, to + 1)
end

--- The page of a figure with a panel in space; nil where all are flat, which gnuplot draws as well.
---@param figure plot.figure
---@return string?
function page.commands(figure)
  if gnuplot.is_flat(figure) then return nil end
  local title = gsub(figure.title or "A figure", "[<>&]", " ")
  return put(put(template, "@FIGURE@", page.json(figure)), "@TITLE@", title) -- the title's place is the first of its name
end

return page
