-- SPDX-License-Identifier: MIT
--- Figures as plain data, drawn by gnuplot: `local plot = require "quat.plot"`. The guide is docs/lua.md.
---
---   local figure = plot.figure { title = "A circle",
---     plot.panel { equal = true, plot.line { x, y, label = "the circle" } } }
---   plot.save(figure, "circle")  -- circle.png
---
--- A figure is numbers, strings and tables only: the runner copies it into a state of its own before it draws.

local gnuplot = require "quat.gnuplot"

local error, ipairs, pairs, type = error, ipairs, pairs, type
local format, gsub, match = string.format, string.gsub, string.match
local concat, sort = table.concat, table.sort
local pcall, require, io, os = pcall, require, io, os

local plot = { colors = gnuplot.colors }

-- ---- describing ----

--- The names of a table in order, as words for a message.
local function names_of(t)
  local names = {}
  for name in pairs(t) do names[#names + 1] = name end
  sort(names)
  return names
end

local function is_finite(value) return type(value) == "number" and value - value == 0 end

--- Checks of a key's value: each returns nil, or what the value must be.
local function one_of(choices)
  return function(value)
    if type(value) ~= "string" or not choices[value] then return "one of '" .. concat(names_of(choices), "', '") .. "'" end
  end
end

local function numbers(least, most)
  return function(value)
    local count = type(value) == "table" and #value or -1
    local good = count >= least and count <= most
    for i = 1, good and count or 0 do good = good and is_finite(value[i]) end
    if not good then return format("a list of %s numbers", least == most and least or least .. " or " .. most) end
  end
end

local function span(value)
  if numbers(2, 2)(value) or value[1] >= value[2] then return "{least, most}, two numbers in order" end
end

local function shade(value)
  if type(value) ~= "string" or not match(plot.colors[value] or value, "^#%x%x%x%x%x%x$") then
    return "'#rrggbb' or one of '" .. concat(names_of(plot.colors), "', '") .. "'"
  end
end

-- What each key must be: a type's name, or a check.
local panel_keys = {
  title = "string", xlabel = "string", ylabel = "string", zlabel = "string", equal = "boolean", legend = one_of(gnuplot.legends),
  xrange = span, yrange = span, zrange = span, view = numbers(2, 2), at = numbers(2, 4), frame = "boolean", box = numbers(4, 4),
  three = "boolean", zoom = "number", shadow = "boolean", xlog = "boolean", ylog = "boolean",
}
local figure_keys = { title = "string", subtitle = "string", size = numbers(2, 2), grid = numbers(2, 2) }
local item_keys = {
  line = { label = "string", color = shade, width = "number", dash = "boolean", fill = "boolean", opacity = "number", tube = "number" },
  points = { label = "string", color = shade, size = "number", shape = one_of(gnuplot.shapes), front = "boolean" },
  arrows = { label = "string", color = shade, width = "number", head = "number", front = "boolean" },
  surface = { label = "string", color = shade, opacity = "number", lines = "boolean", value = "table", range = span },
  text = { color = shade, at = numbers(2, 3), align = one_of(gnuplot.aligns), size = "number" },
  mark = { label = "string", color = shade, x = "number", y = "number", dash = "boolean" },
}
-- How many lists each item takes: flat, or in space.
local item_lists = { line = { 2, 3 }, points = { 2, 3 }, arrows = { 4, 6 }, surface = { 3, 3 } }

local function described(value)
  return type(value) == "string" and format("'%s'", value) or type(value) == "number" and format("%.14g", value) or
      "a " .. type(value)
end

--- Checks a description's names and their values; `level` is the stack level to blame.
local function checked(what, keys, description, level)
  if type(description) ~= "table" then error(what .. ": a table is needed, got a " .. type(description), level + 1) end
  for key, value in pairs(description) do
    if type(key) == "string" and key ~= "kind" then
      local wanted = keys[key]
      if not wanted then
        error(format("unknown key '%s' in %s (keys: %s)", key, what, concat(names_of(keys), ", ")), level + 1)
      end
      local must
      if type(wanted) == "string" then must = type(value) ~= wanted and "a " .. wanted or nil else must = wanted(value) end
      if must then error(format("%s: %s must be %s, got %s", what, key, must, described(value)), level + 1) end
    end
  end
  return description
end

--- Checks an item's lists: as many as its kind takes, of one length.
local function check_lists(kind, description, level)
  local counts = item_lists[kind]
  if not counts then return end
  local flat, space = counts[1], counts[2]
  if #description ~= flat and #description ~= space then
    error(format("%s: %s lists of numbers are needed, got %d", kind, flat == space and flat or flat .. " or " .. space, #description),
      level + 1)
  end
  for i, list in ipairs(description) do
    if type(list) ~= "table" then error(format("%s: item %d must be a list, got %s", kind, i, described(list)), level + 1) end
    if #list ~= #description[1] then
      error(format("%s: lists 1 and %d are of %d and %d", kind, i, #description[1], #list), level + 1)
    end
  end
end

local function maker(kind)
  return function(description)
    checked(kind, item_keys[kind], description, 2)
    check_lists(kind, description, 2)
    if kind == "text" and type(description[1]) ~= "string" then error("text: {\"words\", at = ...} is needed", 2) end
    if kind == "mark" and not (description.x or description.y) then error("mark: x or y is missing", 2) end
    description.kind = kind
    return description
  end
end

---@class plot.item
---@class plot.panel
---@class plot.figure
---@field title? string
---@field subtitle? string
---@field size? number[]
---@field grid? number[]

--- A line through {x, y} or {x, y, z} (lists of numbers; NaN lifts the pen).
--- Also: label, color (a name of plot.colors or "#rrggbb"), width, dash, fill and opacity (a filled polygon, flat panels only), tube (in
--- space: drawn as a tube of that radius; gnuplot draws the line).
---@type fun(description: {[1]: number[], [2]: number[], [3]?: number[], label?: string, color?: string, width?: number, dash?: boolean, fill?: boolean, opacity?: number, tube?: number}): plot.item
plot.line = maker "line"
--- Points at {x, y[, z]}: label, color, size, shape ("dot", "circle", "square", "triangle", "cross", "star"),
--- front (not hidden by surfaces).
---@type fun(description: {[1]: number[], [2]: number[], [3]?: number[], label?: string, color?: string, size?: number, shape?: string, front?: boolean}): plot.item
plot.points = maker "points"
--- Arrows from {x, y, dx, dy} or {x, y, z, dx, dy, dz}: label, color, width, head (0 for none), front (not hidden by surfaces).
---@type fun(description: {[integer]: number[], label?: string, color?: string, width?: number, head?: number, front?: boolean}): plot.item
plot.arrows = maker "arrows"
--- A surface through {x, y, z}, each a list of rows of equal length: color, or value (rows of numbers to colour by) and
--- range {least, most}; opacity; lines (its mesh, drawn).
---@type fun(description: {[1]: number[][], [2]: number[][], [3]: number[][], label?: string, color?: string, opacity?: number, lines?: boolean, value?: number[][], range?: number[]}): plot.item
plot.surface = maker "surface"
--- A text {"words", at = {x, y[, z]}}: color, align ("left", "center", "right"), size.
---@type fun(description: {[1]: string, at: number[], color?: string, align?: "left"|"center"|"right", size?: number}): plot.item
plot.text = maker "text"
--- A line right across the panel at x= or y=: label, color, dash.
---@type fun(description: {x?: number, y?: number, label?: string, color?: string, dash?: boolean}): plot.item
plot.mark = maker "mark"

--- A panel of items: title, xlabel, ylabel, zlabel, equal (the same scale on all axes), legend ("top left" ..., "center", "row",
--- "none"), xrange, yrange, zrange ({least, most}), xlog, ylog (logarithmic axes, flat panels only: a mark at every decade, what is
--- not positive is left out), view ({about x, about z}, degrees), zoom, shadow (opaque surfaces cast it, where our own renderer
--- draws), frame (axes drawn), three (three-dimensional; by itself when an item has a z), at ({column, row[, columns, rows]} in the figure's grid), box ({left, bottom, right, top} of the axes,
--- as parts of the figure, instead of at).
---@return plot.panel
function plot.panel(description)
  checked("panel", panel_keys, description, 2)
  for i, item in ipairs(description) do
    if type(item) ~= "table" or not item_keys[item.kind] then
      error(format("panel: item %d must be made with plot.line, plot.points, ...", i), 2)
    end
  end
  description.kind = "panel"
  return description
end

--- A figure of panels: title, subtitle, size ({width, height}, pixels), grid ({columns, rows}).
---@return plot.figure
function plot.figure(description)
  checked("figure", figure_keys, description, 2)
  for i, panel in ipairs(description) do
    if type(panel) ~= "table" or panel.kind ~= "panel" then error(format("figure: item %d must be a plot.panel", i), 2) end
  end
  if #description == 0 then error("figure: no panel in it", 2) end
  for i, panel in ipairs(description) do
    local p = gnuplot.place(description, i)
    if not panel.box and (p.column < 1 or p.row < 1 or p.column + p.wide - 1 > p.columns or p.row + p.high - 1 > p.rows) then
      error(format("figure: panel %d stands outside of the grid of %g columns and %g rows", i, p.columns, p.rows), 2)
    end
  end
  description.kind = "figure"
  return description
end

-- ---- drawing ----

--- The commands that draw the figure: to the file `output`, or to standard output.
---@param figure plot.figure
---@param output? string
---@return string
function plot.gnuplot(figure, output)
  return assert(gnuplot.commands(figure, output))
end

--- Draws the figure as NAME.png: in the runner's output folder, or in a stock Lua where the name says.
--- true, or nil and why (gnuplot is not installed, the file cannot be written).
---@param figure plot.figure
---@param name string
---@return true?, string?
function plot.save(figure, name)
  if type(name) ~= "string" then error("save: the picture's name must be a string, got " .. described(name), 2) end
  name = gsub(name, "%.png$", "")
  local hosted, host = pcall(require, "quat.host")
  if hosted and type(host) == "table" then return host.save(figure, name) end
  local part, final = name .. ".png.part", name .. ".png"
  local good, commands = pcall(plot.gnuplot, figure, part)
  if not good then error(format("figure '%s': %s", name, commands), 2) end
  local pipe = io.popen("gnuplot -d -", "w")
  if not pipe then return nil, "gnuplot cannot be started" end
  pipe:write(commands)
  if not pipe:close() then
    os.remove(part)
    return nil, "gnuplot is not installed, or failed"
  end
  return os.rename(part, final)
end

return plot
