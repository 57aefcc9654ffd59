-- SPDX-License-Identifier: MIT
--- Mistakes in scripts and on the command line: one clear line, the right exit code, no file under its final name.
local check = require "check"
local runner = require "runner"
runner.clean()

--- A good scene with one change: `body` and `scene` are put into the tables.
local function scene(body, rest)
  return string.format([[
local impact = require "impact"
local coin = impact.body {
  name = "coin", %s
}
local floor = impact.body { name = "floor", shape = impact.plane() }
return impact.scene {
  name = "toss", duration = 0.1, bodies = { floor, coin }, %s
}
]], body, rest or "")
end

local good = 'shape = impact.sphere(0.1), mass = 1, position = { 0, 0, 1 },'

local function refused(text, wanted, code, options)
  local got, _, said = runner.script(text, options)
  said = said:gsub("; the run came to t = [^\n]*", "") -- test_ends.lua
  if got ~= (code or 1) or said ~= "impact: " .. wanted .. "\n" then
    error(string.format("wanted exit code %d and\n%s\ngot %d and\n%s\nof the script\n%s", code or 1, wanted, got, said, text), 2)
  end
  check.truth(not runner.exists("o/toss.csv") and not runner.exists("o/toss_events.csv"), "no file stands under its final name")
  check.truth(runner.shell("find " .. runner.quote(runner.folder) .. " -name '*.part' | grep -q .") ~= 0, "no partial file stays")
end

check.equal(runner.script(scene(good)), 0)
check.truth(runner.exists("o/toss.csv"), "the good scene's CSV")

-- Functions that are not there.
refused("require 'impact'.boks { a = 1 }", "script.lua:1: no function 'boks' in impact (did you mean 'box'?)")
refused("require 'quat'.slurp()", "script.lua:1: no function 'slurp' in quat (did you mean 'slerp'?)")
refused("require 'impact'.weather()", "script.lua:1: no function 'weather' in impact")

-- A body's keys.
refused(scene(good .. "fricton = 1,"), "script.lua:2: unknown key 'fricton' in body 'coin' (did you mean 'friction'?)")
local keys = "name, shape, static, mass, density, moments, position, orientation, normal, velocity, omega, friction, restitution, " ..
  "torsional_friction, rolling_friction, linear_damping, angular_damping, shape_position, shape_orientation, trail)"
refused(scene(good .. "colour = 1,"), "script.lua:2: unknown key 'colour' in body 'coin' (keys: " .. keys)
refused(scene(good .. "7,"), "script.lua:2: unknown key [1] in body 'coin' (its values have names: " .. keys)
refused(scene("shape = impact.sphere(0.1), mass = -1,"), "script.lua:2: body 'coin': mass must be a positive number, got -1")
refused(scene("shape = impact.sphere(0.1), mass = 0/0,"), "script.lua:2: body 'coin': mass must be a positive number, got nan")
refused(scene("shape = impact.sphere(0.1), mass = '4',"), "script.lua:2: body 'coin': mass must be a positive number, got the string '4'")
refused(scene("mass = 1,"), "script.lua:2: body 'coin': shape is missing")
refused(scene("shape = impact.sphere(1e-110),"),
  "script.lua:2: body 'coin': mass = 0: of this size and density lies beyond double precision: take other units")
refused(scene("shape = 3,"), "script.lua:2: body 'coin': shape must be a shape such as impact.sphere(0.3), got a number")
refused(scene("shape = impact.sphere(-0.1),"), "script.lua:3: argument 'radius' must be a positive number, got -0.1")
refused(scene(good .. "density = 3,"), "script.lua:2: body 'coin': give mass or density, not both")
refused(scene(good .. "velocity = { 1, 2 },"), "script.lua:2: body 'coin': velocity must be a vector {x, y, z} of finite numbers, got {1, 2}")
refused(scene(good .. "velocity = { 1, 2, 0/0 },"), "script.lua:2: body 'coin': velocity must be a vector {x, y, z} of finite numbers, got {1, 2, nan}")
refused(scene(good .. "velocity = { 1, 2, 3, x = 9 },"),
  "script.lua:2: body 'coin': velocity must be a vector {x, y, z} of finite numbers, got {1, 2, 3 and more}")
refused(scene(good .. "velocity = { x = 1, y = 2, z = 3, w = 4 },"),
  "script.lua:2: body 'coin': velocity must be a vector {x, y, z} of finite numbers, got {w = 4, x = 1, y = 2, z = 3}")
refused(scene(good .. "orientation = { 1, 0, 0, 0, axis = 'x' },"),
  "script.lua:2: body 'coin': orientation must be a quaternion or {w, x, y, z} of finite numbers, got {1, 0, 0, 0 and more}")
for _, idle in ipairs { "mass", "density", "linear_damping", "angular_damping" } do
  refused(scene("shape = impact.sphere(0.1), static = true, " .. idle .. " = 0.5,"), "script.lua:2: body 'coin': is static: it has no use for " .. idle)
end
refused(scene("shape = impact.plane(), moments = { 1, 1, 1 },"), "script.lua:2: body 'coin': is static: it has no use for moments")
refused(scene(good .. "omega = 3,"), "script.lua:2: body 'coin': omega must be a vector {x, y, z} of finite numbers, got 3")
refused(scene(good .. "orientation = { 0, 0, 0, 0 },"), "script.lua:2: body 'coin': orientation must not be zero")
refused(scene(good .. "normal = { 0, 0, 1 },"), "script.lua:2: body 'coin': normal is for planes; give orientation")
refused(scene("shape = impact.plane(), normal = { 0, 0, 0 },"), "script.lua:2: body 'coin': normal must not be zero")
refused(scene(good .. "friction = -0.5,"), "script.lua:2: body 'coin': friction must be a number >= 0, got -0.5")
refused(scene(good .. "restitution = 1.5,"), "script.lua:2: body 'coin': restitution must be a number from 0 to 1, got 1.5")
refused(scene(good .. "linear_damping = 1,"), "script.lua:2: body 'coin': linear_damping must be a number in [0, 1), got 1")
refused(scene(good .. "static = 1,"), "script.lua:2: body 'coin': static must be true or false, got 1")
refused('require "impact".body { shape = 1 }', "script.lua:1: body: name is missing")
refused('require "impact".body { name = "" }', "script.lua:1: body '': name must not be empty")
refused('require "impact".body(3)', "script.lua:1: body: a table of its values is needed, got 3 (keys: name, shape, static, mass, density, moments, position, " ..
  "orientation, normal, velocity, omega, friction, restitution, torsional_friction, rolling_friction, linear_damping, angular_damping, shape_position, " ..
  "shape_orientation, trail)")

-- The scene's keys.
refused(scene(good, "duraton = 3,"), "script.lua:6: unknown key 'duraton' in scene 'toss' (did you mean 'duration'?)")
refused(scene(good, "duration = -1,"), "script.lua:6: scene 'toss': duration must be a positive number, got -1")
refused(scene(good, "gravity = 9.81,"), "script.lua:6: scene 'toss': gravity must be a vector {x, y, z} of finite numbers, got 9.81")
refused(scene(good, "rules = { friction = 'mean' },"),
  "script.lua:6: rules: friction must be one of 'product', 'geometric_mean', 'minimum', 'maximum', got the string 'mean'")
refused(scene(good, "rules = { frition = 'product' },"), "script.lua:6: unknown key 'frition' in rules (did you mean 'friction'?)")
refused(scene(good, "forces = { { strength = 1 } },"),
  "script.lua:6: forces[1] must be made with impact.wind, impact.attraction or impact.force")
refused(scene(good, "forces = impact.attraction {},"), "script.lua:6: scene 'toss': forces must be a list of forces, got one force")
refused(scene(good, "forces = { impact.wind { direction = { 1, 0, 0 } } },"), "script.lua:7: wind: strength is missing")
refused(scene(good, "forces = { impact.wind { strength = 1, direction = { 0, 0, 0 } } },"), "script.lua:7: wind: direction must not be zero")
refused(scene(good, "forces = { impact.force { name = 'pull' } },"), "script.lua:7: force 'pull': law is missing")
refused(scene(good, "forces = { impact.force { name = 'pull', law = 3 } },"),
  "script.lua:7: force 'pull': law must be a function(t, body), got a number")
refused(scene(good, "pairs = { { bodies = { 'coin' } } },"), "script.lua:6: pair: bodies must be the names of two bodies")
refused(scene(good, "samples = 'some',"), "script.lua:6: scene 'toss': samples must be one of 'all', 'moving', got the string 'some'")
refused(scene(good, "plot = 3,"), "script.lua:6: scene 'toss': plot must be a function(scene) that returns a figure, got a number")
refused(scene(good, "bodies = { a = coin },"), "script.lua:6: scene 'toss': bodies must be a list, without names for its members")
refused('return require "impact".scene { name = "toss", duration = 1 }', "script.lua:1: scene 'toss': bodies is missing")
refused((scene(good):gsub("toss", "a/b")),
  "script.lua: the scene's name 'a/b' names the files: it must be plain, without '/'")

-- What only the library can see comes with the place of the body it speaks of.
local function refused_by_library(text, start)
  local code, _, said = runner.script(text)
  check.equal(code, 1)
  if said:sub(1, #start) ~= start then error(string.format("wanted '%s...', got '%s'", start, said), 2) end
  check.truth(said:find("\n") == #said, "one line")
end
refused_by_library(scene(good, "bodies = { floor, coin, coin },"), "impact: script.lua:")
-- A crowd is a list like any other, whatever its length; and each of its names is looked at.
refused_by_library([[
local impact = require "impact"
local coin, bodies = impact.body { name = "coin", shape = impact.sphere(1) }, {}
for i = 1, 200000 do bodies[i] = coin end
impact.scene { name = "crowd", duration = 1, bodies = bodies }]],
  "impact: script.lua:2: body 'coin': the name is taken by another body")
refused_by_library(scene(good, "forces = { impact.wind { strength = 1, body = 'cone' } },"), "impact: script.lua:6: ")
refused_by_library(scene(good, "pairs = { { bodies = { 'coin', 'cone' } } },"), "impact: script.lua:6: ")
refused_by_library(scene(good, "pairs = { { bodies = { 'coin', 'floor' }, friction = 0 }, { bodies = { 'floor', 'coin' }, restitution = 1 } },"),
  "impact: script.lua:6: pair with ")
refused_by_library(scene("shape = impact.plane(), static = false,"), "impact: script.lua:2: body 'coin': ")
refused_by_library(scene("shape = impact.plane(), velocity = { 1, 0, 1 },"),
  "impact: script.lua:2: body 'coin': velocity of a static body is its surface's: a plane's must lie along it")

-- Scripts that fail.
refused("return {", "script.lua:1: unexpected symbol near <eof>")
refused("local a\na.b = 1", "script.lua:2: attempt to index a nil value (local 'a')")
refused("error('no')", "script.lua:1: no")
refused("error({})", "the script raised an error that is not a text")
refused("return 3", "script.lua: a script returns a scene, impact.scene{...}, or nothing; this one returned a number")
refused("local scene = (function()\n" .. scene(good) .. "end)()\nscene:run { csv = 'toss', on_sample = function() error('no') end }",
  "script.lua:11: no")
refused("local scene = (function()\n" .. scene(good) .. "end)()\nscene:run { cvs = 'toss' }",
  "script.lua:11: unknown key 'cvs' in run (did you mean 'csv'?)")
refused("local scene = (function()\n" .. scene(good) .. "end)()\nscene:run { on_event = function() scene:time() end, csv = 'toss', on_sample = function() scene:run() end }",
  "script.lua:11: scene 'toss' is running; ask when the run has ended, or go on by scene:step() or scene:run_to(t) and ask between")
refused("local scene = (function()\n" .. scene(good) .. "end)()\nscene:state 'cone'", "script.lua:11: scene 'toss' has no body 'cone'")

-- A plot that fails keeps the CSV files, which are whole, and tells.
local function plot_refused(plot, wanted)
  local code, _, said = runner.script(scene(good, "plot = function(scene) " .. plot .. " end,"))
  check.equal(said, "impact: script.lua" .. wanted .. "\n")
  check.equal(code, 1)
  check.truth(runner.exists("o/toss.csv") and not runner.exists("o/toss.png"), "CSV, but no picture")
end
plot_refused("return 3", ": the plot of scene 'toss': a figure is made with plot.figure; this is a number")
plot_refused("return { kind = 'figure', { kind = 'panel', { kind = 'line', { 1 }, { 1, 2 } } } }",
  ": the plot of scene 'toss': line: columns 1 and 2 have 1 and 2 rows")
plot_refused("return { kind = 'figure', print }", ": the plot of scene 'toss': a figure holds numbers, strings and tables only")
plot_refused("return (require 'quat.plot'.figure { titel = 'x' })", ":7: unknown key 'titel' in figure (keys: grid, size, subtitle, title)")
plot_refused("require 'quat.plot'.save({}, 'x')", ":7: figure 'x': a figure is made with plot.figure") -- our own layers are not to blame
plot_refused("require 'quat.csv'.save('x', { 'a' }, {})", ":7: csv: 1 names for 0 columns")
plot_refused("return (scene:figur())", ":7: attempt to call a nil value (method 'figur')")

plot_refused("", ": the plot of scene 'toss': a figure is made with plot.figure; this is a nil")
plot_refused("local figure = require 'impact.portrait'.space(scene, 'floor')", ":7: portrait: body 'floor' does not move: there is nothing to draw")
-- One body's picture needs nothing but its name.
if runner.script(scene(good, "plot = function(s) return require 'impact.portrait'.space(s, 'coin') end,")) == 0 then
  check.equal(runner.script(scene(good, "plot = function(s) return require 'impact.portrait'.planar(s, 'coin') end,")), 0)
end

-- Laws of force that fail, and a run that fails with the script in order.
local code, _, said
if require "impact".has "cvode" then
  refused(scene(good, "forces = { impact.force { name = 'pull', law = function(t) error('no') end } },"), "script.lua:7: no")
  refused(scene(good, "forces = { impact.force { name = 'pull', law = function(t) return { 0, 0, 0/0 } end } },"),
    "script.lua:7: force 'pull': the force must be a vector {x, y, z} of finite numbers, got {0, 0, nan}")
  for _, wrong in ipairs { "{1, 2}", "{1, 2, 3, 4}", "{1, 2, 3 and more}", "{x = 1, z = 2}", "3", "the string 'up'" } do
    local written = wrong:gsub(" and more", ", up = 4"):gsub("the string ", "")
    refused(scene(good, "forces = { impact.force { name = 'pull', law = function(t) return " .. written .. " end } },"),
      "script.lua:7: force 'pull': the force must be a vector {x, y, z} of finite numbers, got " .. wrong)
  end
  refused(scene(good, "forces = { impact.force { name = 'pull', law = function(t, b) return { 0, 0, b.posision.x } end } },"),
    "script.lua:7: no field 'posision' in the body of a law (did you mean 'position'?)")
  -- in arithmetic on what may be nil a wrong name would pass in silence
  refused(scene(good, "forces = { impact.force { law = function(t, b) return b.velocty and { 1, 0, 0 } or { 0, 0, b.mass } end } },"),
    "script.lua:7: no field 'velocty' in the body of a law (did you mean 'velocity'?)")
  refused(scene(good, "forces = { impact.force { law = function() end, edge = function(t, b) return b.mas end } },"),
    "script.lua:7: no field 'mas' in the body of a law (did you mean 'mass'?)")
  code, _, said = runner.script(scene(good, "forces = { impact.force { law = function(t) return { 1e308 * math.sin(1e6 * t), 1e308, 1e308 } end } },"))
  check.equal(code, 3)
  check.truth(said:match("^impact: [^\n]+\n$"), "one line of the failed run")
  check.truth(not runner.exists("o/toss.csv"), "no CSV of a failed run")
end

-- What a run tells a script: a state or an event that is asked for what it has not.
local function asks(rest) return (scene(good):gsub("return impact", "local scene = impact"):gsub("duration = 0.1", "duration = 1") .. rest) end
refused(asks("scene:run { on_event = function(e) return e.kind end }"), "script.lua:9: no field 'kind' in an event")
refused(asks("scene:run { on_sample = function(s) return s.velocty end }"),
  "script.lua:9: no field 'velocty' in the state of a body (did you mean 'velocity'?)")
refused(asks("print(scene:state('coin').name)"), "script.lua:9: no field 'name' in the state of a body")

-- Folders and files that cannot be written. (Root may write anywhere, so the folder is put below a file.)
runner.write("file", "")
runner.write("script.lua", scene(good))
code, _, said = runner.command("script.lua --out file/below")
check.equal(code, 4)
check.equal(said, "impact: cannot write to the folder 'file/below': Not a directory\n")
runner.shell("mkdir -p " .. runner.quote(runner.folder .. "/full/toss.csv"))
code, _, said = runner.command("script.lua --out full")
check.equal(code, 4)
check.truth(said:match("^impact: [^\n]*toss%.csv[^\n]*\n$"), "one line that names the file")

-- The command line.
for _, case in ipairs {
  { "", 2 }, { "script.lua other.lua", 2 }, { "--frob script.lua", 2 }, { "script.lua --out", 2 }, { "script.lua --max-time x", 2 },
  { "script.lua --max-memory -3", 2 }, { "--help", 0 }, { "--version", 0 }, { "nothing.lua", 1 }, { "script.lua --out=p --quiet", 0 },
} do
  local got, out, err = runner.command(case[1])
  check.equal(got, case[2])
  if case[2] == 2 then check.truth(#err > 0 and #out == 0, "a complaint of " .. case[1]) end
end
local _, out = runner.command("--version")
check.truth(out:match("^impact %d+%.%d+%.%d+ %(Lua 5%.4%.%d+; CVODE: %a+, libccd: %a+%)\n$"), "the version's form")
check.truth(runner.exists("p/toss.csv"), "--out=DIR")
_, out = runner.command("script.lua --quiet --out q")
check.equal(out, "")

-- Arguments after --: over the defaults, which say what there is.
do
  local script = [[local impact = require "impact"
local given = impact.arguments { mu = 0.3, n = 10, name = "ball", spin = false }
assert(arg[0] == "script.lua" and given.n == 10 and math.type(given.n) == "integer")
io.write(string.format("%g %s %s", given.mu, given.name, given.spin))]]
  local function told(options, wanted_code, wanted_out, wanted_said)
    local code, out, said = runner.script(script, options)
    check.equal(said, wanted_said)
    check.equal(code, wanted_code)
    check.equal(out, wanted_out)
  end
  told("", 0, "0.3 ball false", "")
  told("--", 0, "0.3 ball false", "")
  told("-- mu=1e-3 name=a=b spin=true", 0, "0.001 a=b true", "")
  told("-- mu=2 n=10 name=", 0, "2  false", "")
  local function refused_argument(word, why)
    told("-- " .. word, 1, "", "impact: script.lua:2: " .. why .. "\n")
  end
  refused_argument("um=1", "unknown argument 'um' (did you mean 'mu'?)")
  refused_argument("velocity=1", "unknown argument 'velocity'")
  refused_argument("mu=fast", "argument 'mu' must be a number, got 'fast'")
  refused_argument("n=1.5", "argument 'n' must be a whole number, got '1.5'")
  refused_argument("spin=yes", "argument 'spin' must be true or false, got 'yes'")
  refused_argument("--quiet", "an argument has the form key=value, got '--quiet'")
end

check.report("mistakes")
