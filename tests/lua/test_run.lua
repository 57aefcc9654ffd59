-- SPDX-License-Identifier: MIT
--- Recorded runs from Lua and from the runner: states at any time, files, what is refused; and the lines of Python in docs/run.md.
package.path = arg[0]:match("^(.*)/[^/]*$") .. "/?.lua;" .. package.path
local impact = require "impact"
local check, runner = require "check", require "runner"
runner.clean()

local function drop()
  return impact.scene {
    name = "drop", duration = 1, gravity = { 0, 0, -10 }, output_rate = 10,
    bodies = {
      impact.body { name = "floor", shape = impact.plane(), restitution = 1 },
      impact.body { name = "ball", shape = impact.sphere(0.5), position = { 0, 0, 1.3 }, restitution = 0.5 },
    },
  }
end

-- In memory: between its rows, and on both sides of the first impact at sqrt(2 0.8/10) = 0.4 s.
local scene = drop()
check.equal(scene:run { record = true }, "end of time")
local run = scene:record()
check.equal(run:name(), "drop")
check.close(run:state("ball", 0.237).position.z, 1.3 - 5 * 0.237 ^ 2, 1e-15)
check.close(run:state("ball", 0.237).velocity.z, -2.37, 1e-14)
local event = run:events()[1]
check.close(event.t, 0.4, 1e-15)
check.close(run:state_before("ball", event.t).velocity.z, -4, 1e-14)
check.close(run:state("ball", event.t).velocity.z, 2, 1e-14)
check.close(event.impulse.z, scene:definition().bodies[2].shape.volume * 1000 * 6, 1e-10)
local first, last = run:times()
check.equal(first, 0)
check.equal(last, 1)
check.equal(#run:bodies(), 2)
check.equal(run:bodies()[2].shape.kind, "sphere")
local columns = run:columns("ball", { 0, 0.1, 0.2 })
check.close(columns.z[2], 1.3 - 5 * 0.1 ^ 2, 1e-15)
check.equal(#columns.qw, 3)
check.equal(#run:account() > 2, true)
check.raises("run 'drop' has no body 'bal'", function() local s = run:state("bal", 0) return s end)
check.raises("run 'drop' has no state at t = 2 s: it goes from 0 to 1 s", function() local s = run:state("ball", 2) return s end)
run:close()
check.raises("the recorded run is closed", function() local s = run:state("ball", 0) return s end)
check.raises("run: record must be true or the name of a file, got a number", function() local r = drop():run { record = 3 } return r end)

-- In a file.
local path = runner.folder .. "/drop.run"
check.equal(drop():run { record = path }, "end of time")
local opened = assert(impact.open(path))
check.close(opened:state("ball", 0.237).position.z, 1.3 - 5 * 0.237 ^ 2, 1e-15)
runner.write("no.run", "t,body\n")
local none, message = impact.open(runner.folder .. "/no.run")
check.equal(none, nil)
check.equal(message, string.format("'%s/no.run': not a recorded run", runner.folder))
check.truth(select(2, impact.open(runner.folder .. "/absent.run")):find("absent.run': ", 1, true), "an absent file is named")
local reason, why, kind = drop():run { record = runner.folder .. "/none/x.run" }
check.equal(reason, nil)
check.truth(why:find("cannot be opened", 1, true), "a folder that is not there")
check.equal(kind, "output")

-- By the runner: below its folder, and nothing of a run that fails.
local text = [[
local impact = require "impact"
return impact.scene { name = "drop", duration = 1, gravity = { 0, 0, -10 }, bodies = {
  impact.body { name = "floor", shape = impact.plane(), restitution = 1 },
  impact.body { name = "ball", shape = impact.sphere(0.5), position = { 0, 0, 1.3 }, restitution = 0.5 } } }]]
local code, said, complained = runner.script(text, "--record")
check.equal(code, 0)
check.equal(complained, "")
check.truth(said:find("o/drop.run", 1, true), "the file is named")
check.close(assert(impact.open(runner.folder .. "/o/drop.run")):state("ball", 0.237).position.z, 1.3 - 5 * 0.237 ^ 2, 1e-15)
if impact.has "view" then
  code, said, complained = runner.command("view script.lua --out shown")
  check.equal(complained, "")
  check.equal(code, 0)
  check.truth(said:find("wrote      shown/drop.html, ", 1, true), "the page is named first")
  check.truth(runner.read("shown/drop.html"):find("<title>drop</title>", 1, true), "a page")
  check.equal(runner.command("gltf shown/drop.run --out shown --quiet"), 0)
  check.equal(runner.read("shown/drop.glb"):sub(1, 4), "glTF")
  runner.shell("cd " .. runner.quote(runner.folder) .. " && cp shown/drop.run .")
  code, said = runner.command("view drop.run --out again --quiet")
  check.equal(code, 0)
  check.equal(said, "")
  code, said = runner.command("view shown/drop.run --out again")
  check.equal(code, 0)
  check.equal(said, "wrote again/drop.html\n")
  check.equal(runner.read("again/drop.html"), runner.read("shown/drop.html"))
  code, _, complained = runner.command("view no.run --out none")
  check.equal(code, 1)
  check.truth(complained:find("'no.run': not a recorded run", 1, true), "what is no record is named")
  check.truth(not runner.exists("none/no.html"), "and leaves no page")
  code, _, complained = runner.command("shown/drop.run")
  check.equal(code, 1)
  check.truth(complained:find("shown/drop.run: a recorded run is shown by impact view", 1, true), "a record is no script")
  local bytes = runner.read("shown/drop.run")
  runner.write("bit.run", bytes:sub(1, -300) .. string.char(bytes:byte(-299) ~ 1) .. bytes:sub(-298))
  for _, what in ipairs { "view", "gltf" } do
    code, _, complained = runner.command(what .. " bit.run --out none")
    check.equal(code, 1)
    check.truth(complained:find("'bit.run': damaged: its bytes do not give the sum that it ends with", 1, true), "a bit that changed is seen")
    code, _, complained = runner.command(what .. " shown/drop.csv --out none")
    check.equal(code, 1)
    check.truth(complained:find("shown/drop.csv: " .. what .. " takes a script that returns a scene, or a recorded run, FILE.run", 1, true), "rows are neither")
  end
  check.truth(not impact.open(runner.folder .. "/bit.run"), "nor from Lua")
  check.truth(not runner.exists("none"), "and nothing is left")
  code, _, complained = runner.command("view script.lua --out shown --max-disk 0.02")
  check.truth(code ~= 0 and complained ~= "", "a page counts as written")
  code, said, complained = runner.command("view script.lua --out wide --tolerance 3")
  check.equal(code, 4)
  check.truth(complained:find("tolerance must lie in [1e-07, 0.1], got 3", 1, true), "a tolerance out of range is told")
  check.truth(not runner.exists("wide/drop.html") and not said:find("drop.html", 1, true), "a page that is not there is not named as written")
  check.equal(runner.command("script.lua --tolerance 0.001"), 2)
  check.equal(runner.command("view script.lua --frame-rate 240"), 2)
  code, said = runner.command("gltf shown/drop.run --out fast --frame-rate 1")
  check.equal(code, 0)
  check.truth(said:find("note: drop.glb: at 1 frames a second Blender, to which keys within a hundredth of a frame are one, shows bodies up to", 1, true), "what frames cannot hold is said")
  code, said = runner.command("gltf shown/drop.run --out fast --frame-rate 1 --quiet")
  check.equal(code, 0)
  check.equal(said, "")
  code, said = runner.command("gltf shown/drop.run --out fast --frame-rate 240")
  check.equal(code, 0)
  check.equal(said, "wrote fast/drop.glb\n")
  code, _, complained = runner.command("gltf shown/drop.run --out fast --frame-rate 1e5")
  check.equal(code, 4)
  check.truth(complained:find("frame_rate = 100000 must lie in [1, 32767]", 1, true), "no rate of Blender's")
end
check.equal(runner.script((text:gsub("return impact.scene (%b{})", "impact.scene%1:run { record = 'x.run' }"))), 0)
check.truth(runner.exists("o/x.run"), "a script's own record lies in the folder")
code, _, complained = runner.script((text:gsub("return impact.scene (%b{})", "impact.scene%1:run { record = '../x.run' }")))
check.equal(code, 1)
check.truth(complained:find("record must be a plain name without '/', got the string '../x.run'", 1, true), "nowhere else")
code = runner.script("require 'impact'.open '../drop.run'")
check.equal(code, 1)
text = text:gsub("duration = 1,", "duration = 1, forces = { impact.force { law = function() return { 0 / 0, 0, 0 } end } },")
check.truth(runner.script(text, "--record") ~= 0, "the force is refused")
check.truth(not runner.exists("o/drop.run") and not runner.exists("o/drop.run.part"), "no record of a run that failed")

-- The lines of Python that docs/run.md shows give the same keys, and find the sum right, where Python has numpy.
local page = arg[3] and io.open(arg[3] .. "/run.md")
if page and runner.shell("python3 -c 'import numpy' 2>/dev/null") == 0 then
  local text = page:read "a"
  local lines, sum = text:match "```python\n(.-)```", text:match "```python\n(import zlib.-)```"
  runner.write("read.py", lines:gsub("sphere_wall%.run", "drop.run") .. sum ..
    "\nimport sys\nball = head['bodies'][1]['keys']\nrow = keys[ball[0]]\nassert len(row) == 21 and row[20] == head['forms'].index('steady') and row[3] == 1.3 and row[16] == -10, row\n")
  check.equal(runner.shell("cd " .. runner.quote(runner.folder) .. " && python3 read.py"), 0)
else
  print("run: no Python with numpy: its lines are not tried")
end
if page then page:close() end

-- --pictures: flat panels as SVG and PDF too, those in space as a page, in which no word is more than text.
local drawn = [[local plot = require "quat.plot"
local flat = plot.panel { plot.line { { 0, 1 }, { 1, 0 / 0 }, label = "</script><b id=harm>" } }
local space = plot.panel { plot.line { { 0, 1 }, { 0, 1 }, { 0, 1 }, tube = 0.1 }, plot.text { "</script><b id=harm>@TITLE@", at = { 0, 0, 0 } } }
print(plot.save(plot.figure { flat }, "flat"), plot.save(plot.figure { title = "</title><b id=harm>@FIGURE@", flat, space }, "space"))
plot.save(plot.figure { space }, "solid")]]
code, said = runner.script(drawn, "--pictures")
check.equal(code, 0)
if said:find "true" then
  check.equal(runner.read("o/flat.pdf"):sub(1, 5), "%PDF-")
  check.truth(runner.read("o/flat.svg"):find("<svg", 1, true), "SVG is SVG")
  check.truth(runner.exists("o/flat.png") and runner.exists("o/space.png"), "PNG stays")
  check.truth(runner.read("o/space.svg"):find("<svg", 1, true) and runner.exists("o/space.pdf"), "a figure's flat panels alone")
  check.truth(not runner.exists("o/flat.figure.html") and not runner.exists("o/solid.svg") and not runner.exists("o/solid.pdf"), "each in its form")
  local shown = runner.read("o/space.figure.html")
  check.truth(not shown:find("<b id", 1, true) and not shown:find "https?://", "words are text, and nothing is asked for")
  check.truth(shown:find('"tube":0.1', 1, true) and shown:find(",null]", 1, true), "the figure stands in it, and what is not finite as null")
  check.equal(runner.script(drawn), 0)
  check.truth(not runner.exists("o/flat.svg") and not runner.exists("o/space.figure.html"), "only where they are asked for")
else
  print("run: gnuplot is not installed: pictures in other forms are not tried")
end

check.report("run")
