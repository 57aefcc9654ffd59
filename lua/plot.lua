-- SPDX-License-Identifier: MIT
--- Figures as plain data, drawn by gnuplot: `local plot = require "quat.plot"`. The guide is docs/lua.md.
---
---   local figure = plot.figure { title = "A circle",
---     plot.panel { equal = true, plot.line { x, y, label = "the circle" } } }
---   plot.save(figure, "circle")  -- circle.png
---
--- A figure is numbers, strings and tables only: the runner copies it into a state of its own before it draws. Nothing that a
--- script wrote reaches gnuplot but numbers, and strings in single quotes.

local error, ipairs, pairs, tostring, type = error, ipairs, pairs, tostring, type
local format, gsub, match, rep = string.format, string.gsub, string.match, string.rep
local concat, sort, unpack = table.concat, table.sort, table.unpack
local abs, ceil, floor, huge, log, max, min = math.abs, math.ceil, math.floor, math.huge, math.log, math.max, math.min
local pcall, require, io, os = pcall, require, io, os

local plot = {}

--- Colours that stand apart for most eyes, also in grey.
plot.colors = {
  blue = "#2b6cb0",
  red = "#c53030",
  green = "#2f855a",
  orange = "#dd6b20",
  purple = "#6b46c1",
  teal = "#2c7a7b",
  grey = "#a0aec0",
  dark = "#2d3748",
  black = "#000000",
}
local cycle = { "blue", "red", "green", "orange", "purple", "teal" }

-- ---- describing ----

local legends = {
  ["top left"] = "top left", ["top right"] = "top right", ["bottom left"] = "bottom left",
  ["bottom right"] = "bottom right", ["top center"] = "top center", ["bottom center"] = "bottom center",
  ["center"] = "center center", ["row"] = "top right horizontal", ["none"] = "none",
  ["center right"] = "center right", ["center left"] = "center left",
}
local shapes = { dot = 7, circle = 6, square = 5, triangle = 9, cross = 2, star = 3 }
local aligns = { left = "left", center = "center", right = "right" }

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
  title = "string", xlabel = "string", ylabel = "string", zlabel = "string", equal = "boolean", legend = one_of(legends),
  xrange = span, yrange = span, zrange = span, view = numbers(2, 2), at = numbers(2, 4), frame = "boolean", box = numbers(4, 4),
  three = "boolean", zoom = "number", xlog = "boolean", ylog = "boolean",
}
local figure_keys = { title = "string", subtitle = "string", size = numbers(2, 2), grid = numbers(2, 2) }
local item_keys = {
  line = { label = "string", color = shade, width = "number", dash = "boolean", fill = "boolean", opacity = "number" },
  points = { label = "string", color = shade, size = "number", shape = one_of(shapes), front = "boolean" },
  arrows = { label = "string", color = shade, width = "number", head = "number", front = "boolean" },
  surface = { label = "string", color = shade, opacity = "number", lines = "boolean", value = "table", range = span },
  text = { color = shade, at = numbers(2, 3), align = one_of(aligns), size = "number" },
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

---@class plot.figure
---@class plot.panel
---@class plot.item

--- A line through {x, y} or {x, y, z} (lists of numbers; NaN lifts the pen).
--- Also: label, color (a name of plot.colors or "#rrggbb"), width, dash, fill and opacity (a filled polygon, flat panels only).
---@type fun(description: table): plot.item
plot.line = maker "line"
--- Points at {x, y[, z]}: label, color, size, shape ("dot", "circle", "square", "triangle", "cross", "star"),
--- front (not hidden by surfaces).
---@type fun(description: table): plot.item
plot.points = maker "points"
--- Arrows from {x, y, dx, dy} or {x, y, z, dx, dy, dz}: label, color, width, head (0 for none), front (not hidden by surfaces).
---@type fun(description: table): plot.item
plot.arrows = maker "arrows"
--- A surface through {x, y, z}, each a list of rows of equal length: color, or value (rows of numbers to colour by) and
--- range {least, most}; opacity; lines (its mesh, drawn).
---@type fun(description: table): plot.item
plot.surface = maker "surface"
--- A text {"words", at = {x, y[, z]}}: color, align ("left", "center", "right"), size.
---@type fun(description: table): plot.item
plot.text = maker "text"
--- A line right across the panel at x= or y=: label, color, dash.
---@type fun(description: table): plot.item
plot.mark = maker "mark"

--- A panel of items: title, xlabel, ylabel, zlabel, equal (the same scale on all axes), legend ("top left" ..., "center", "row", "none"), xrange,
--- yrange, zrange ({least, most}), xlog, ylog (logarithmic axes, flat panels only: a mark at every decade, what is not positive is
--- left out), view ({about x, about z}, degrees), zoom, frame (axes drawn), three (three-dimensional; by itself
--- when an item has a z), at ({column, row[, columns, rows]} in the figure's grid), box ({left, bottom, right, top} of the axes,
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
  description.kind = "figure"
  return description
end

-- ---- gnuplot's commands ----

--- A string as gnuplot's single-quoted one: no escapes, no substitution; control characters and backquotes do not pass.
local function quote(text)
  local clean = gsub(tostring(text), "[%c`]", " ")
  return "'" .. gsub(clean, "'", "''") .. "'"
end

local function number(value, what, look)
  if type(value) ~= "number" then error((what or "a value") .. " must be a number, got a " .. type(value), 0) end
  if not is_finite(value) then return "NaN" end
  return format(look or "%.9g", value)
end

--- A number of the data, or of the axes that measure it: all its digits.
local function datum(value)
  return number(value, "a plotted value", "%.17g")
end

local function color(value, fallback)
  local code = plot.colors[value or fallback] or value
  if type(code) ~= "string" or not match(code, "^#%x%x%x%x%x%x$") then
    error(format("the color '%s' is neither '#rrggbb' nor one of plot.colors", tostring(value)), 0)
  end
  return code
end

local function with_opacity(code, opacity)
  if not opacity then return code end
  return format("#%02x%s", floor(255 * (1 - min(1, max(0, opacity))) + 0.5), code:sub(2))
end

local function columns_of(item, count)
  local columns = { unpack(item, 1, count) }
  for i, column in ipairs(columns) do
    if type(column) ~= "table" then error(format("%s: column %d is not a list", item.kind, i), 0) end
    if #column ~= #columns[1] then
      error(format("%s: columns 1 and %d have %d and %d rows", item.kind, i, #columns[1], #column), 0)
    end
  end
  if #columns ~= count then error(format("%s: %d columns are needed, got %d", item.kind, count, #columns), 0) end
  return columns
end

local function data_block(out, name, columns)
  out[#out + 1] = name .. " << EOD"
  local row = {}
  for i = 1, #columns[1] do
    for c = 1, #columns do row[c] = datum(columns[c][i]) end
    out[#out + 1] = concat(row, " ")
  end
  if #columns[1] == 0 then out[#out + 1] = rep("NaN ", #columns) end
  out[#out + 1] = "EOD"
end

local function surface_block(out, name, item)
  local x, y, z, value = item[1], item[2], item[3], item.value
  if type(x) ~= "table" or type(y) ~= "table" or type(z) ~= "table" then error("surface: x, y and z are lists of rows", 0) end
  out[#out + 1] = name .. " << EOD"
  for i = 1, #x do
    for j = 1, #x[i] do
      local shade = value and value[i][j] or 0
      out[#out + 1] = concat({ datum(x[i][j]), datum(y[i][j]), datum(z[i][j]), datum(shade) }, " ")
    end
    out[#out + 1] = ""
  end
  out[#out + 1] = "EOD"
end

local function title_of(item)
  return item.label and "title " .. quote(item.label) or "notitle"
end

--- Each returns the plotting clause of an item whose data stands in block `name`.
local clauses = {}

function clauses.line(out, name, item, three, fallback, dashed)
  data_block(out, name, columns_of(item, three and 3 or 2))
  if item.fill and not three then
    return format("%s using 1:2 with filledcurves closed lc rgb %s %s", name,
      quote(with_opacity(color(item.color, fallback), item.opacity or 0.25)), title_of(item))
  end
  return format("%s using 1:2%s with lines lw %s dt %s lc rgb %s %s", name, three and ":3" or "", number(item.width or 2),
    (item.dash or item.dash == nil and dashed) and "(7,4)" or "solid", quote(with_opacity(color(item.color, fallback), item.opacity)), title_of(item))
end

local function shape_of(item)
  return shapes[item.shape or "dot"]
end

function clauses.points(out, name, item, three, fallback)
  data_block(out, name, columns_of(item, three and 3 or 2))
  return format("%s using 1:2%s with points pt %d ps %s lw 1.5 lc rgb %s %s", name, three and ":3" or "", shape_of(item),
    number(item.size or 1), quote(color(item.color, fallback)), title_of(item))
end

local function head_of(item)
  return item.head == 0 and "nohead" or format("filled head size graph %s,20,60", number(item.head or 0.02))
end

function clauses.arrows(out, name, item, three, fallback)
  data_block(out, name, columns_of(item, three and 6 or 4))
  return format("%s using 1:2:3:4%s with vectors %s lw %s lc rgb %s %s", name, three and ":5:6" or "", head_of(item),
    number(item.width or 1.5), quote(color(item.color, fallback)), title_of(item))
end

function clauses.surface(out, name, item, _, fallback)
  surface_block(out, name, item)
  if item.value then return format("%s using 1:2:3:4 with pm3d %s", name, title_of(item)) end
  local code = quote(with_opacity(color(item.color, fallback), item.opacity or 0.35))
  if item.lines == true then return format("%s using 1:2:3 with lines lw 0.7 lc rgb %s %s", name, code, title_of(item)) end
  return format("%s using 1:2:3 with pm3d fillcolor rgb %s %s", name, code, title_of(item))
end

local function position(at, three)
  local a = { datum(at[1]), datum(at[2]) }
  if three then a[3] = datum(at[3] or 0) end
  return concat(a, ",")
end

local function put_text(out, item, three)
  out[#out + 1] = format("set label %s at %s %s front font ',%s' tc rgb %s", quote(item[1]),
    position(item.at or { 0, 0, 0 }, three), aligns[item.align or "left"], number(item.size or 11),
    quote(color(item.color, "dark")))
end

--- Points and arrows as objects of their own, which gnuplot draws over the surfaces.
local function put_front(out, item, three)
  local n = three and 3 or 2
  local columns = columns_of(item, item.kind == "points" and n or 2 * n)
  local shade = quote(color(item.color, "dark"))
  for i = 1, #columns[1] do
    local from, to = {}, {}
    for c = 1, n do from[c], to[c] = columns[c][i], columns[c][i] + (columns[n + c] or columns[c])[i] end
    local at = position(from, three)
    if at:find "NaN" or position(to, three):find "NaN" then -- the pen is lifted
    elseif item.kind == "points" then
      out[#out + 1] = format("set label '' at %s point pt %d ps %s lw 1.5 lc rgb %s front", at, shape_of(item), number(item.size or 1), shade)
    else
      out[#out + 1] = format("set arrow from %s to %s front %s lw %s lc rgb %s", at, position(to, three), head_of(item),
        number(item.width or 1.5), shade)
    end
  end
end

local function put_mark(out, item)
  local look = format("nohead front lw 1.2 dt %s lc rgb %s", item.dash == false and "solid" or "(3,3)",
    quote(color(item.color, "dark")))
  if item.x then
    local x = datum(item.x)
    out[#out + 1] = format("set arrow from first %s, graph 0 to first %s, graph 1 %s", x, x, look)
    if item.label then
      out[#out + 1] = format("set label %s at first %s, graph 0.97 left offset 0.5,0 front font ',10' tc rgb %s",
        quote(item.label), x, quote(color(item.color, "dark")))
    end
  elseif item.y then
    local y = datum(item.y)
    out[#out + 1] = format("set arrow from graph 0, first %s to graph 1, first %s %s", y, y, look)
    if item.label then
      out[#out + 1] = format("set label %s at graph 0.02, first %s left offset 0,0.5 front font ',10' tc rgb %s",
        quote(item.label), y, quote(color(item.color, "dark")))
    end
  end
end

local function is_three(panel)
  if panel.three then return true end
  for _, item in ipairs(panel) do
    local kind = item.kind
    if kind == "surface" or (kind == "arrows" and #item == 6) or ((kind == "line" or kind == "points") and #item == 3) then
      return true
    end
  end
  return false
end

--- The least and the most of what a panel's items hold along an axis (1, 2 or 3), of the positive values only where so asked; nil
--- when there is nothing.
local function extent(panel, axis, three, positive)
  local least, most
  local function take(value)
    if type(value) == "number" and value == value and value ~= huge and value ~= -huge and (not positive or value > 0) then
      least, most = min(least or value, value), max(most or value, value)
    end
  end
  for _, item in ipairs(panel) do
    if item.kind == "surface" then
      for _, row in ipairs(item[axis] or {}) do for _, value in ipairs(row) do take(value) end end
    elseif item.kind == "line" or item.kind == "points" or item.kind == "arrows" then
      local column, step = item[axis], item.kind == "arrows" and item[axis + (three and 3 or 2)]
      for i, value in ipairs(column or {}) do
        take(value)
        if step and value == value then take(value + (step[i] or 0)) end
      end
    end
  end
  return least, most
end

--- A step of 1, 2 or 5 times a power of ten that divides the span into about `parts`.
local function nice_step(span, parts)
  local power = 10 ^ floor(log(span / parts) / log(10))
  local rest = span / parts / power
  return (rest < 1.5 and 1 or rest < 3.5 and 2 or rest < 7.5 and 5 or 10) * power
end

--- The same of a logarithmic axis, in whole decades; a mark at each, or at every other one where there are many.
local function put_decades(out, panel, axis, name)
  local asked = panel[name .. "range"]
  local least, most
  if asked then least, most = asked[1], asked[2] else least, most = extent(panel, axis, false, true) end
  if not least or least <= 0 then least, most = 1, 10 end
  local low, high = floor(log(least, 10) + 1e-9), ceil(log(most, 10) - 1e-9)
  if high == low then high = low + 1 end
  out[#out + 1] = format("set logscale %s; set %srange [1e%d:1e%d]; set format %s '1e%%T'", name, name, low, high, name)
  return high - low > 10 and 100 or 10
end

--- Range and marks of an axis: as asked, or as the data; `tight` keeps the data's own ends. Returns the marks' step and digits.
local function put_range(out, panel, axis, name, three, tight, parts)
  local asked = panel[name .. "range"]
  if panel[name .. "log"] then return put_decades(out, panel, axis, name) end
  local least, most
  if asked then least, most = asked[1], asked[2] else least, most = extent(panel, axis, three) end
  if not least or not (number(least) ~= "NaN" and number(most) ~= "NaN") then least, most = 0, 1 end
  local margin = 1e-9 * max(abs(least), abs(most))
  if most - least <= margin then least, most = least - max(margin, 0.5), most + max(margin, 0.5) end
  local step = nice_step(most - least, parts)
  if not asked and not tight then least, most = floor(least / step + 1e-9) * step, ceil(most / step - 1e-9) * step end
  out[#out + 1] = format("set %srange [%s:%s]", name, datum(least - 1e-5 * step), datum(most + 1e-5 * step)) -- rounding must not clip
  -- As many digits as tell one mark from the next.
  local digits = ceil(log(max(abs(least), abs(most)) / step, 10)) + 1
  if digits > 6 then out[#out + 1] = format("set format %s '%%.%dg'", name, min(17, digits)) end
  return step, digits
end

--- Returns how many digits the marks of y have.
local function put_axes(out, panel, three)
  local add = function(...) out[#out + 1] = format(...) end
  add("unset label; unset arrow; unset xlabel; unset ylabel; unset zlabel; unset title")
  if panel.title then add("set title %s font ',12' offset 0,-0.4 tc rgb '#1a202c'", quote(panel.title)) end
  for _, axis in ipairs { "x", "y", "z" } do
    local label = panel[axis .. "label"]
    if label then add("set %slabel %s font ',11' tc rgb '#2d3748'", axis, quote(label)) end
  end
  add("unset logscale; set format '%%h'")
  local steps, digits = {}, {}
  for i, axis in ipairs { "x", "y", "z" } do
    if i < 3 or three then
      steps[i], digits[i] = put_range(out, panel, i, axis, three, i == 1 and not three and not panel.equal, three and 4 or i == 1 and not panel.equal and 7 or 5)
    end
  end
  local legend = panel.legend or "top right"
  if legend == "none" then
    add("unset key")
  else
    add("set key vertical %s Left reverse noopaque samplen 2.2 spacing 1.15 font ',10.5' tc rgb '#2d3748'", legends[legend])
  end
  if panel.frame == false then
    add("unset border; unset xtics; unset ytics; unset ztics; unset grid")
  else
    add("set border %d lc rgb '#718096' lw 1", three and 31 or 3)
    local look = "nomirror out scale 0.6 font ',10' tc rgb '#2d3748'"
    local x_aside, y_aside = three and " offset 0,-0.4" or "", three and " offset 1,-0.1" or "" -- apart where axes meet
    add("set xtics %s %s%s; set ytics %s %s%s", datum(steps[1]), look, x_aside, datum(steps[2]), look, y_aside)
    if three then add("set ztics %s %s", datum(steps[3]), look) end
    add("set grid lc rgb '#e2e8f0' lt 1 lw 1 dt solid")
  end
  if three then
    local view = panel.view or { 65, 35 }
    add("set size noratio; set view %s,%s,%s,1; set view %s", number(view[1]), number(view[2]), number(panel.zoom or 1),
      panel.equal and "equal xyz" or "noequal")
    add("set xyplane relative 0; set pm3d depthorder border lc rgb '#ffffff' lw 0.2; unset colorbox; unset hidden3d")
  else
    add(panel.equal and "set size ratio -1" or "set size noratio")
  end
  return digits[2] or 1
end

--- Where the panel's axes stand: its box, or its cell of the figure's grid.
local function put_place(out, panel, place, top, three, digits)
  local add = function(...) out[#out + 1] = format(...) end
  local left, width = (place.column - 1) / place.columns, place.wide / place.columns
  local height = top * place.high / place.rows
  local bottom = top - top * (place.row - 1) / place.rows - height
  local b = panel.box
  if b and not (three and panel.zoom) then
    add("set lmargin at screen %s; set bmargin at screen %s; set rmargin at screen %s; set tmargin at screen %s",
      number(b[1]), number(b[2]), number(b[3]), number(b[4]))
    add("set origin 0,0; set size 1,1")
    return
  elseif b then -- margins on the screen would undo gnuplot's zoom
    left, bottom, width, height = b[1], b[2], b[3] - b[1], b[4] - b[2]
  end
  add("set origin %s,%s; set size %s,%s", number(left), number(bottom), number(width), number(height))
  if three then
    add("set lmargin 2; set rmargin 2; set tmargin 2; set bmargin 1")
  else
    add("set lmargin %g; set rmargin 3; set tmargin 2.2; set bmargin 3.6", max(9.5, digits + 4))
  end
end

--- The colours' range, and their key: a bar below the panel's axes.
local function put_colors(out, panel, range, place, top)
  local add = function(...) out[#out + 1] = format(...) end
  add("set cbrange [%s:%s]", range and number(range[1]) or "*", range and number(range[2]) or "*")
  add("set cbtics %s out nomirror scale 0.4 font ',9' tc rgb '#2d3748'",
    range and number(nice_step(range[2] - range[1], 4)) or "autofreq")
  local left, bottom, width, height = (place.column - 1) / place.columns, 0, place.wide / place.columns, top * place.high / place.rows
  bottom = top - top * (place.row - 1) / place.rows - height
  if panel.box then
    left, bottom, width, height = panel.box[1], panel.box[2], panel.box[3] - panel.box[1], panel.box[4] - panel.box[2]
  end
  add("set colorbox horizontal user origin %s,%s size %s,%s noborder", number(left + 0.28 * width),
    number(bottom + 0.1 * height), number(0.44 * width), number(0.02 * height))
end

local function put_panel(out, panel, number_of, place, top)
  local three = is_three(panel)
  put_place(out, panel, place, top, three, put_axes(out, panel, three))
  local parts, colored = {}, 0
  for i, item in ipairs(panel) do
    if item.kind == "text" then
      put_text(out, item, three)
    elseif item.kind == "mark" then
      put_mark(out, item)
    elseif item.front then
      put_front(out, item, three)
    else
      if not item.color then colored = colored + 1 end
      local name = format("$panel%d_%d", number_of, i)
      parts[#parts + 1] = clauses[item.kind](out, name, item, three, cycle[(colored - 1) % #cycle + 1], not item.color and colored > #cycle)
      if item.value then
        out[#out + 1] = "set palette defined (0 '#2b6cb0', 0.5 '#f7fafc', 1 '#c53030')"
        put_colors(out, panel, item.range, place, top)
      end
    end
  end
  if #parts == 0 then parts[1] = "NaN notitle" end
  out[#out + 1] = (three and "splot " or "plot ") .. concat(parts, ", \\\n  ")
end

--- The commands that draw the figure: to the file `output`, or to standard output.
---@param figure plot.figure
---@param output? string
---@return string
function plot.gnuplot(figure, output)
  if type(figure) ~= "table" or figure.kind ~= "figure" then error("a figure is made with plot.figure", 0) end
  local size = figure.size or { 1280, 860 }
  local grid = figure.grid or { #figure > 1 and 2 or 1, #figure > 1 and floor((#figure + 1) / 2) or 1 }
  local out = {
    "set encoding utf8",
    format("set terminal pngcairo noenhanced size %d,%d font 'DejaVu Sans,11' background '#ffffff'",
      floor(min(8000, max(100, size[1]))), floor(min(8000, max(100, size[2])))),
    output and "set output " .. quote(output) or "set output",
    "set multiplot",
  }
  local top = 1
  if figure.title then
    local line = 30 / size[2]
    out[#out + 1] = format("set label 1001 %s at screen 0.5,%s center front font ',16' tc rgb '#1a202c'", quote(figure.title),
      number(1 - 0.85 * line))
    top = 1 - 1.5 * line
    if figure.subtitle then
      out[#out + 1] = format("set label 1002 %s at screen 0.5,%s center front font ',11' tc rgb '#4a5568'",
        quote(figure.subtitle), number(1 - 1.65 * line))
      top = 1 - 2.2 * line
    end
    out[#out + 1] = "set origin 0,0; set size 1,1; unset border; unset tics; unset key; set margins 0,0,0,0"
    out[#out + 1] = "plot [0:1][0:1] NaN notitle"
    out[#out + 1] = "unset label"
  end
  for i, panel in ipairs(figure) do
    local at = panel.at or { (i - 1) % grid[1] + 1, floor((i - 1) / grid[1]) + 1 }
    local place = { column = at[1], row = at[2], wide = at[3] or 1, high = at[4] or 1, columns = grid[1], rows = grid[2] }
    put_panel(out, panel, i, place, top)
  end
  out[#out + 1] = "unset multiplot"
  out[#out + 1] = "set output"
  return concat(out, "\n") .. "\n"
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
