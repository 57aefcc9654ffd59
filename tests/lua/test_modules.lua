-- SPDX-License-Identifier: MIT
--- The modules in a stock Lua 5.4: what they load, and how they read arguments.
local check = require "check"

--- Whether a library of this name is in the process; nil where the system cannot tell.
local function loaded(name)
  local maps = io.open("/proc/self/maps")
  if not maps then return nil end
  local text = maps:read("a")
  maps:close()
  return text:find(name, 1, true) ~= nil
end

local quat = require "quat"
for _, name in ipairs { "libimpact", "impact/core", "sundials", "libccd", "libgsl" } do
  check.truth(not loaded(name), "require 'quat' leaves out " .. name)
end

local impact = require "impact"
for _, name in ipairs { "libgsl", "sundials", "libccd" } do
  check.truth(not loaded(name), "require 'impact' leaves out " .. name)
end
local function drop(methods)
  return impact.scene { duration = .3, methods = methods, bodies = { { name = "ball", shape = impact.sphere(.1), position = { 0, 0, 1 } } } }
end
assert(drop():run())
check.truth(not loaded "sundials", "what falls needs no integrator")
assert(drop({ motion = "rk4", step = .01 }):run())
check.truth(not loaded "sundials", "nor do fixed steps")
if impact.has "cvode" then
  assert(drop({ motion = "cvode" }):run())
  check.truth(loaded "sundials" ~= false, "SUNDIALS is loaded when it is asked for")
end
check.truth(impact.version:match("^%d+%.%d+%.%d+$"), "impact.version is a version")
check.equal(type(impact.has("cvode")), "boolean")

-- Quaternions and vectors.
local q = quat.new(1, 2, 3, 4)
check.equal(q.w + 10 * q.x + 100 * q.y + 1000 * q.z, 4321)
check.equal(quat.new({ 1, 2, 3, 4 }).z, 4)
check.equal(quat.new({ w = 1, x = 2, y = 3, z = 4 }).y, 3)
check.equal(quat.new(q).x, 2)
check.raises("no function 'no_such_module' in quat", function() return quat.no_such_module, nil end)
check.raises("argument 'q' must be a quaternion or {w, x, y, z} of finite numbers, got {1, 2, 3}", quat.new, { 1, 2, 3 })
check.raises("argument 'z' must be a finite number, got inf", quat.new, 1, 2, 3, math.huge)

-- Shapes.
local ball = impact.sphere(0.3)
check.equal(ball.kind, "sphere")
check.close(ball.volume, 4 / 3 * math.pi * 0.027, 1e-16)
check.close(ball.inertia.y, 0.4 * 0.09, 1e-17)
check.equal(impact.sphere({ radius = 2 }).a, 2)
check.equal(impact.plane().a, math.huge)
check.equal(impact.plane({ width = 3, depth = 8 }).b, 4)
check.raises("argument 'radius' must be a positive number, got -1", impact.sphere, -1)
check.raises("argument 'radius' must be a positive number, got the string '2'", impact.sphere, "2")
check.raises("sphere: radius must be a positive number, got nan", impact.sphere, { radius = 0 / 0 })
check.raises("sphere: radius is missing", impact.sphere, {})
check.raises("unknown key 'radus' in sphere (did you mean 'radius'?)", impact.sphere, { radus = 1 })
check.raises("unknown key [1] in plane (its values have names: width, depth)", impact.plane, { 3, 3 })
check.raises("argument 'part' must be one of 'cvode', 'ccd', 'view', got the string 'gsl'", impact.has, "gsl")

-- Tables of numbers, and logarithmic axes.
local csv, plot = require "quat.csv", require "quat.plot"
local rows = csv.rows('t,name,x\n# a remark\n1,"a, b ""c""",2.5e-3\n2,plain,nan\n')
check.equal(#rows, 2)
check.equal(rows[1].name, 'a, b "c"')
check.equal(rows[1].x + rows[2].t, 2.0025)
check.truth(rows[2].x ~= rows[2].x, "nan is a number, if none")
-- In front of surfaces: objects of their own, none where the pen is lifted; and a zoom in a box, which margins on the screen would undo.
local front = plot.gnuplot(plot.figure { plot.panel { three = true, box = { 0.1, 0.2, 0.6, 0.7 }, zoom = 2,
  plot.points { { 1, 0 / 0 }, { 2, 0 }, { 3, 0 }, front = true }, plot.arrows { { 0 }, { 0 }, { 0 }, { 1 }, { 2 }, { 3 }, front = true, head = 0 } } })
check.equal(select(2, front:gsub("set label '' at ", "")), 1)
check.truth(front:find("set label '' at 1,2,3 point pt 7", 1, true), "a point in front")
check.truth(front:find("set arrow from 0,0,0 to 1,2,3 front nohead", 1, true), "an arrow in front, without a head")
check.truth(front:find("set origin 0.1,0.2; set size 0.5,0.5", 1, true), "a zoomed box")
local logs = plot.gnuplot(plot.figure { plot.panel { xlog = true, ylog = true, plot.line { { 0.02, 300 }, { 0, 5e-9 } } } })
check.truth(logs:find("set logscale x; set xrange [1e-2:1e3]", 1, true), "whole decades")
check.truth(logs:find("set yrange [1e-9:1e-8]", 1, true), "zero is left out of a logarithmic axis")

-- A hundred-millionth beside 1 is drawn, and told on the axis.
local fine = plot.gnuplot(plot.figure { plot.panel { plot.line { { 0, 1 }, { 1, 1 + 1e-9 } } } })
check.truth(fine:find("1 1.0000000010000001", 1, true), "data keep their digits")
check.truth(fine:find("set format y '%.11g'", 1, true), "marks differ")
check.truth(logs:find("set format '%h'", 1, true), "marks without a blank before them")
-- The seventh line without a colour is told from the first.
local seven = { {} }
for i = 1, 7 do seven[i] = plot.line { { 0, 1 }, { i, i } } end
check.equal(select(2, plot.gnuplot(plot.figure { plot.panel(seven) }):gsub("dt %(7,4%)", "")), 1)
-- Mistakes in figures and tables are told where they are written.
local function refuses(wanted, f, ...)
  check.raises(wanted, function(...) local result = f(...) return result end, ...) -- a place to blame
end
refuses("unknown key 'colour' in line (keys: color, dash, fill, label, opacity, tube, width)", plot.line, { { 1 }, { 2 }, colour = "red" })
refuses("line: 2 or 3 lists of numbers are needed, got 1", plot.line, { { 1 } })
refuses("line: lists 1 and 2 are of 2 and 1", plot.line, { { 1, 2 }, { 2 } })
refuses("arrows: item 2 must be a list, got 3", plot.arrows, { {}, 3, {}, {} })
refuses("points: shape must be one of 'circle', 'cross', 'dot', 'square', 'star', 'triangle', got 'diamond'", plot.points,
  { { 1 }, { 2 }, shape = "diamond" })
refuses("line: color must be '#rrggbb' or one of 'black', 'blue', 'dark', 'green', 'grey', 'orange', 'purple', 'red', 'teal', got 'pink'",
  plot.line, { { 1 }, { 2 }, color = "pink" })
refuses("panel: xrange must be {least, most}, two numbers in order, got a table", plot.panel, { xrange = { 2, 1 } })
refuses("figure: panel 3 stands outside of the grid of 2 columns and 1 rows", plot.figure, { grid = { 2, 1 }, plot.panel {}, plot.panel {}, plot.panel {} })
refuses("figure: size must be a list of 2 numbers, got a table", plot.figure, { size = { 10 }, plot.panel {} })
refuses("panel: at must be a list of 2 or 4 numbers, got 3", plot.panel, { at = 3 })
refuses("text: {\"words\", at = ...} is needed", plot.text, { at = { 0, 0 } })
refuses("mark: x or y is missing", plot.mark, {})
refuses("save: the picture's name must be a string, got a nil", plot.save, plot.figure { plot.panel {} })

-- A table goes out and comes back: names with commas, NaN.
local text = csv.text({ "a,b", 'q"' }, { { 1, 0 / 0 }, { "x", "y" } })
check.equal(text, '"a,b","q"""\n1,x\nnan,y\n')
check.equal(csv.rows(text)[2]['q"'], "y")
-- Whatever the cells hold comes back: line ends, quotes, what looks like a remark or a formula; with any line ends, and a mark of UTF-8.
local odd = { "two\nlines", '"', '""', 'a"b', "#", "=1", "'=1", "", "a,\r\nb", "'", "-", "\t", "ä" }
local again = csv.rows(csv.text({ "x\ny", "#n" }, { odd, odd }))
check.equal(#again, #odd)
for i, want in ipairs(odd) do check.equal(again[i]["x\ny"], want) check.equal(again[i]["#n"], want) end
for _, ends in ipairs { "\n", "\r\n", "\r" } do
  local got = csv.rows(("\xEF\xBB\xBFt,x|1,2|# remark||3,-inf"):gsub("|", ends))
  check.equal(#got, 2)
  check.equal(got[1].t + got[1].x + got[2].t, 6)
  check.equal(got[2].x, -math.huge)
end
check.equal(#csv.rows "" + #csv.rows "a,b\n" + #csv.rows "# nothing", 0)
refuses("csv: row 2 has 3 cells, the header has 2", csv.rows, "a,b\n1,2\n1,2,3\n")
refuses("csv: row 1 has 1 cells, the header has 2", csv.rows, "a,b\n1\n")
refuses("csv: row 1 has 3 cells, the header has 1", csv.rows, "t;x\n0,5;1,5\n")
refuses("csv: two columns have the name 'a'", csv.rows, "a,a\n1,2\n")
refuses("csv: row 1 has a quote without an end", csv.rows, 'a,b\n1,"2\n3,4\n')
refuses("csv: row 1 goes on behind a closing quote", csv.rows, 'a,b\n1,"2"3\n')
refuses("csv: 1 names for 0 columns", csv.save, "x", { "a" }, {})
refuses("csv: column 'a' must be a list, got a number", csv.text, { "a" }, { 1 })
refuses("csv: rows reads a text, got a nil", csv.rows)

check.report("modules")
