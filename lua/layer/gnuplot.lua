-- SPDX-License-Identifier: MIT
--- A figure's plain data as gnuplot's commands: `local gnuplot = require "quat.gnuplot"`; behind quat.plot, which makes and checks
--- figures. The runner draws in a Lua state in which this is the only layer: nothing that a script wrote reaches gnuplot but numbers,
--- and strings in single quotes.

local error, ipairs, pairs, tostring, type = error, ipairs, pairs, tostring, type
local format, gsub, match, rep = string.format, string.gsub, string.match, string.rep
local concat, unpack = table.concat, table.unpack
local abs, ceil, floor, log, max, min, math_type = math.abs, math.ceil, math.floor, math.log, math.max, math.min, math.type

local gnuplot = {}

--- A number's digits by string.format's `look` (all of them, when it is nil), "." whatever the locale: for all that other programs read.
---@param value number
---@param look? string
---@return string
function gnuplot.digits(value, look)
  return (gsub(format(look or math_type(value) == "integer" and "%d" or "%.17g", value), "[^%w+-]+", "."))
end

local digits_of = gnuplot.digits

--- The colours of Okabe and Ito (2008), which stand apart for every eye.
gnuplot.colors = {
  blue = "#0072b2",
  red = "#d55e00",
  green = "#009e73",
  orange = "#e69f00",
  purple = "#cc79a7",
  teal = "#56b4e9",
  grey = "#a0aec0",
  dark = "#2d3748",
  black = "#000000",
}
local cycle = { "blue", "red", "green", "orange", "purple", "teal" }

-- What a figure may ask for by name, and gnuplot's word for it.
gnuplot.legends = {
  ["top left"] = "top left", ["top right"] = "top right", ["bottom left"] = "bottom left",
  ["bottom right"] = "bottom right", ["top center"] = "top center", ["bottom center"] = "bottom center",
  ["center"] = "center center", ["row"] = "top right horizontal", ["none"] = "none",
  ["center right"] = "center right", ["center left"] = "center left",
}
gnuplot.shapes = { dot = 7, circle = 6, square = 5, triangle = 9, cross = 2, star = 3 }
gnuplot.aligns = { left = "left", center = "center", right = "right" }

local function is_finite(value) return type(value) == "number" and value - value == 0 end

--- A string as gnuplot's single-quoted one: no escapes, no substitution; control characters and backquotes do not pass.
local function quote(text)
  local clean = gsub(tostring(text), "[%c`]", " ")
  return "'" .. gsub(clean, "'", "''") .. "'"
end

local function number(value, what, look)
  if type(value) ~= "number" then error((what or "a value") .. " must be a number, got a " .. type(value), 0) end
  if not is_finite(value) then return "NaN" end
  return digits_of(value, look or "%.9g")
end

--- A number of the data, or of the axes that measure it: all its digits.
local function datum(value)
  return number(value, "a plotted value", "%.17g")
end

local function color(value, fallback)
  local code = gnuplot.colors[value or fallback] or value
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
  return gnuplot.shapes[item.shape or "dot"]
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
    position(item.at or { 0, 0, 0 }, three), gnuplot.aligns[item.align or "left"], number(item.size or 11),
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
    if is_finite(value) and (not positive or value > 0) then
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

--- Where an axis begins and ends: as asked, or as the data; never the same.
local function ends(panel, axis, name, three)
  local asked = panel[name .. "range"]
  local least, most
  if asked then least, most = asked[1], asked[2] else least, most = extent(panel, axis, three) end
  if not least or number(least, "a range") == "NaN" or number(most, "a range") == "NaN" then least, most = 0, 1 end
  local margin = 1e-9 * max(abs(least), abs(most))
  if most - least <= margin then least, most = least - max(margin, 0.5), most + max(margin, 0.5) end
  return least, most
end

--- The step of each axis' marks. In space on one scale the shorter of x and y has little room, and fewer marks: down to two steps.
local function steps_of(panel, three)
  local steps, few, widest = {}, {}, 0
  for i, axis in ipairs { "x", "y", "z" } do
    if i < 3 or three then
      local least, most = ends(panel, i, axis, three)
      widest = max(widest, most - least)
      few[i] = nice_step(most - least, 2)
      steps[i] = nice_step(most - least, three and 4 or i == 1 and not panel.equal and 7 or 5)
    end
  end
  for i = 1, three and panel.equal and 2 or 0 do steps[i] = min(nice_step(widest, 4), few[i]) end
  return steps
end

--- Range and marks of an axis: as asked, or as the data; `tight` keeps the data's own ends. Returns the marks' digits.
local function put_range(out, panel, axis, name, three, tight, step)
  local asked = panel[name .. "range"]
  local least, most = ends(panel, axis, name, three)
  if not asked and not tight then least, most = floor(least / step + 1e-9) * step, ceil(most / step - 1e-9) * step end
  out[#out + 1] = format("set %srange [%s:%s]", name, datum(least - 1e-5 * step), datum(most + 1e-5 * step)) -- rounding must not clip
  -- As many digits as tell one mark from the next.
  local digits = ceil(log(max(abs(least), abs(most)) / step, 10)) + 1
  if digits > 6 then out[#out + 1] = format("set format %s '%%.%dg'", name, min(17, digits)) end
  return digits
end

-- In space gnuplot would put the labels on the marks.
local label_aside = { x = " offset -1,-0.4", y = " offset 1.5,-0.4" }

--- Returns how many digits the marks of y have.
local function put_axes(out, panel, three)
  local add = function(...) out[#out + 1] = format(...) end
  add("unset label; unset arrow; unset xlabel; unset ylabel; unset zlabel; unset title")
  if panel.title then add("set title %s font ',12' offset 0,-0.4 tc rgb '#1a202c'", quote(panel.title)) end
  for _, axis in ipairs { "x", "y", "z" } do
    local label = panel[axis .. "label"]
    local aside = three and label_aside[axis] or ""
    if label then add("set %slabel %s font ',11' tc rgb '#2d3748'%s", axis, quote(label), aside) end
  end
  add("unset logscale; set format '%%h'")
  local steps, digits = steps_of(panel, three), {}
  for i, axis in ipairs { "x", "y", "z" } do
    if panel[axis .. "log"] then
      steps[i] = put_decades(out, panel, i, axis)
    elseif steps[i] then
      digits[i] = put_range(out, panel, i, axis, three, i == 1 and not three and not panel.equal, steps[i])
    end
  end
  local legend = panel.legend or "top right"
  if legend == "none" then
    add("unset key")
  else
    add("set key vertical %s Left reverse noopaque samplen 2.2 spacing 1.15 font ',10.5' tc rgb '#2d3748'", gnuplot.legends[legend])
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
    add("set lmargin %s; set rmargin 3; set tmargin 2.2; set bmargin 3.6", number(max(9.5, digits + 4)))
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
        out[#out + 1] = "set palette defined (0 '#0072b2', 0.5 '#f7fafc', 1 '#d55e00')"
        put_colors(out, panel, item.range, place, top)
      end
    end
  end
  if #parts == 0 then parts[1] = "NaN notitle" end
  out[#out + 1] = (three and "splot " or "plot ") .. concat(parts, ", \\\n  ")
end

--- The cells of a figure's grid that panel i takes: as it asks, or one, row by row.
---@return {column: number, row: number, wide: number, high: number, columns: number, rows: number}
function gnuplot.place(figure, i)
  local grid = figure.grid or { #figure > 1 and 2 or 1, #figure > 1 and floor((#figure + 1) / 2) or 1 }
  local at = figure[i].at or { (i - 1) % grid[1] + 1, floor((i - 1) / grid[1]) + 1 }
  return { column = at[1], row = at[2], wide = at[3] or 1, high = at[4] or 1, columns = grid[1], rows = grid[2] }
end

--- Whether no panel of the figure is in space.
---@return boolean
function gnuplot.is_flat(figure)
  for _, panel in ipairs(figure) do if is_three(panel) then return false end end
  return true
end

-- Of a form of picture, gnuplot's terminal; a picture in print has 96 pixels to the inch.
local terminals = {
  png = function(w, h) return format("pngcairo noenhanced size %d,%d", w, h) end,
  svg = function(w, h) return format("svg noenhanced size %d,%d", w, h) end,
  pdf = function(w, h) return format("pdfcairo noenhanced size %sin,%sin", digits_of(w / 96, "%.4f"), digits_of(h / 96, "%.4f")) end,
}

-- The figure's flat panels alone, side by side; nil where there are none.
local function flat_part(figure)
  local part = { kind = "figure", title = figure.title }
  for _, panel in ipairs(figure) do
    if not is_three(panel) then
      local copy = {}
      for key, value in pairs(panel) do if key ~= "at" and key ~= "box" then copy[key] = value end end
      part[#part + 1] = copy
    end
  end
  part.size = { #part > 1 and 1280 or 640, 480 * floor((#part + 1) / 2) }
  return #part > 0 and part or nil
end

--- The commands that draw the figure: to the file `output`, or to standard output. form: "png", "svg" or "pdf": of the latter two the
--- flat panels alone, nil where there are none: surfaces hide nothing there.
---@param figure plot.figure
---@param output? string
---@param form? string
---@return string?
function gnuplot.commands(figure, output, form)
  if type(figure) ~= "table" or figure.kind ~= "figure" then error("a figure is made with plot.figure", 0) end
  form = form or "png"
  if form ~= "png" and not gnuplot.is_flat(figure) then
    figure = flat_part(figure)
    if not figure then return nil end
  end
  local size = figure.size or { 1280, 860 }
  local out = {
    "set encoding utf8",
    format("set terminal %s font 'DejaVu Sans,11' background '#ffffff'",
      terminals[form](floor(min(8000, max(100, size[1]))), floor(min(8000, max(100, size[2]))))),
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
    put_panel(out, panel, i, gnuplot.place(figure, i), top)
  end
  out[#out + 1] = "unset multiplot"
  out[#out + 1] = "set output"
  return concat(out, "\n") .. "\n"
end

return gnuplot
