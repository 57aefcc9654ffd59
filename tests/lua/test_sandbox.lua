-- SPDX-License-Identifier: MIT
--- What a script cannot do without --trust, and the limits on memory and time.
local check = require "check"
local runner = require "runner"
runner.clean()

local function succeeds(text, options)
  local code, _, said = runner.script(text .. "\nprint 'done'", options)
  if code ~= 0 then error(string.format("wanted exit code 0, got %d: %s\nof the script\n%s", code, said, text), 2) end
  check.truth(true)
end

-- Names that are not there, also not by way of require.
for _, name in ipairs {
  "os.execute", "os.remove", "os.rename", "os.exit", "os.getenv", "os.tmpname", "os.setlocale", "io.popen", "io.lines", "io.input",
  "io.output", "io.tmpfile", "io.read", "io.stdin", "package.loadlib", "package.searchpath", "package.path", "package.cpath",
  "debug.getregistry", "debug.sethook", "debug.gethook", "debug.getupvalue", "debug.setupvalue", "debug.getinfo", "debug.getlocal",
  "debug.setmetatable", "debug.getmetatable", "debug.upvaluejoin", "debug.debug", "debug.setuservalue", "debug.getuservalue",
  "string.dump",
} do
  local library, field = name:match("(%a+)%.(%a+)")
  succeeds(string.format("assert(%s == nil and require '%s'.%s == nil and package.loaded.%s.%s == nil)", name, library, field, library, field))
end
succeeds("assert(dofile == nil and loadfile == nil)")
succeeds("assert(#package.searchers == 1)")

-- Files: only plain ones of the output folder.
runner.write("secret", "secret")
runner.write("helper.lua", "return 1")
local prepare = [[
local function refused(...)
  local file, message, code = io.open(...)
  assert(file == nil, "opened " .. (...))
  assert(type(message) == "string" and math.type(code) == "integer")
end
]]
for _, path in ipairs {
  "/etc/passwd", "../secret", "o/../secret", "./../secret", "..", ".", "", "/", "a/../../secret", "//etc/passwd", "o//../secret",
  "secret\\0.txt", "~/x", "./x",
} do
  succeeds(prepare .. string.format("refused('%s', 'r') refused('%s', 'w') refused('%s', 'a+')", path, path, path))
end
local here = runner.folder
local function with_link(make, text)
  runner.shell(string.format("cd %s && rm -rf o && mkdir o && %s", runner.quote(here), make))
  runner.write("script.lua", prepare .. text .. "\nprint 'done'")
  local code, _, said = runner.command("script.lua --out o")
  if code ~= 0 then error(string.format("%s: exit code %d: %s", make, code, said), 2) end
  check.equal(runner.read("secret"), "secret")
end
with_link("ln -s ../secret o/link", "refused('link', 'r') refused('link', 'w') refused('link', 'a')")
with_link("ln -s ../absent o/link", "refused('link', 'w')")
with_link("ln -s .. o/up", "refused('up/secret', 'r') refused('up/new', 'w')")
with_link("ln secret o/hard", "refused('hard', 'r') refused('hard', 'w')")
with_link("mkfifo o/pipe", "refused('pipe', 'r') refused('pipe', 'w')")
with_link("mkdir o/folder", "refused('folder', 'r') refused('folder', 'w') local f = assert(io.open('folder/in', 'w')) f:close()")
with_link("ln -s ../secret o/x.csv.part", "assert(require 'quat.csv'.save('x', { 'a' }, { { 1 } }))")
check.equal(runner.read("o/x.csv"), "a\n1\n")
succeeds("local f = assert(io.open('own.txt', 'w')) f:write('a') f:close() f = assert(io.open('o/own.txt')) assert(f:read('a') == 'a')")
check.equal(runner.read("o/own.txt"), "a")
check.truth(not runner.exists("absent") and not runner.exists("new"), "nothing was made outside")

-- Modules: ours only; source text only.
succeeds("assert(not pcall(require, 'helper'))")
succeeds("assert(not pcall(require, 'socket.core')) package.preload.mine = function() return 7 end assert(require 'mine' == 7)")
succeeds("local f, why = load('\\27Lua') assert(f == nil and why:find('binary'))")
succeeds("local f, why = load('\\27Lua', 'x', 'b') assert(f == nil and why:find('binary'))")
succeeds("local f, why = load(function() return '\\27Lua' end) assert(f == nil)")
succeeds("local e = { a = 4 } assert(load('return a', 'x', 't', e)() == 4 and load('return 3')() == 3)")
succeeds("local f, why = load('return return') assert(f == nil and type(why) == 'string')")
runner.shell(string.format("cd %s && echo 'return' | luac5.4 -o bytecode.lua - 2>/dev/null", runner.quote(here)))
if runner.exists("bytecode.lua") then check.equal(runner.command("bytecode.lua --out o"), 1) end

-- Names of results stay in the folder.
local scene = [[
local impact, plot = require "impact", require "quat.plot"
local scene = impact.scene { name = "drop", duration = 0.1, bodies = { impact.body { name = "ball", shape = impact.sphere(1) } } }
local figure = plot.figure { title = "t", plot.panel { title = "p", plot.line { { 0, 1 }, { 0, 1 }, label = "l" } } }
]]
for _, name in ipairs { "../x", "/tmp/x", "a/b", "..", ".hidden", "" } do
  succeeds(scene .. string.format("assert(not pcall(scene.run, scene, { csv = '%s' })) assert(not pcall(plot.save, figure, '%s')) " ..
    "assert(not pcall(require 'quat.csv'.save, '%s/y', { 'a' }, { { 1 } }))", name, name, name))
end

-- gnuplot is given nothing of the script's to run: whatever stands in a string, and whatever the script does to Lua's functions.
for _, text in ipairs {
  "`touch pwned`", "'; system('touch pwned') #", "x\n!touch pwned\n", '"; system("touch pwned") #', "@pwned", "\\", "%s",
  "\\\nsystem('touch pwned')\n", "'\0; system('touch pwned')",
} do
  succeeds(scene .. ([[
local text = TEXT
figure.title, figure.subtitle, figure[1].title, figure[1][1].label = text, text, text, text
figure[1].xlabel, figure[1][2], figure[1][3] = text, plot.text { text, at = { 0, 0 } }, plot.mark { x = 0.5, label = text }
plot.save(figure, "a")]]):gsub("TEXT", (string.format("%q", text):gsub("%%", "%%%%"))))
end
succeeds(scene .. [[
string.gsub = function() return "'\nsystem('touch pwned')\n'" end
string.format = string.gsub
table.concat = function() return "system('touch pwned')\n" end
plot.gnuplot = table.concat
tostring = string.gsub
plot.save(figure, "a")]])
for _, wrong in ipairs {
  "figure[1][1].color = '#00000; system(\"touch pwned\")'", "figure[1][1].width = '1; system(\"touch pwned\")'",
  "figure[1][1][1][1] = '1; system(\"touch pwned\")'", "figure[1].xrange = { 0, '1]; system(\"touch pwned\")' }",
  "figure.size = { '1; x', 100 }", "figure[1].box = { 0, '0; x', 1, 1 }", "figure[1].at = { '1;', 2 }", "figure.grid = { 'x', 2 }",
} do
  succeeds(scene .. wrong .. " assert(not pcall(plot.save, figure, 'a'))")
end
check.truth(runner.shell("find " .. runner.quote(here) .. " . -maxdepth 2 -name 'pwned*' 2>/dev/null | grep -q .") ~= 0, "nothing ran")

-- A script that tampers with what it is handed gets an error at most.
succeeds(scene .. [[
local v = scene:state("ball").position
local meta = getmetatable(v)
assert(not pcall(meta.__index, 5, "x") and not pcall(meta.__tostring, nil) and not pcall(meta.__index))
for _, object in ipairs { scene, impact.sphere(1), require("quat").new(1, 0, 0, 0) } do
  for key, method in pairs(getmetatable(object)) do
    if type(method) == "function" then pcall(method) pcall(method, {}) pcall(method, 3, 4) pcall(method, io.stdout) pcall(method, v, v) end
  end
end
for _, method in pairs(getmetatable(scene).__index) do pcall(method) pcall(method, {}) pcall(method, v) pcall(method, impact.sphere(1)) end
]])
succeeds(scene .. [[
-- Names that come from metamethods, or go away while they are read.
local body = setmetatable({ shape = impact.sphere(1) }, { __index = function(_, key) return key == "name" and ("x"):rep(100) or nil end })
assert(not pcall(impact.body, body))
for i = 1, 200 do
  local t = { name = "name" .. i, shape = impact.sphere(1) }
  setmetatable({}, { __gc = function() t.name = nil collectgarbage() end })
  pcall(impact.body, t)
  pcall(impact.scene, { name = "s" .. i, duration = 1, bodies = { t } })
end]])
if require "impact".has "cvode" then
  succeeds(scene .. [[
local seen
local law = function(t, state)
  seen = state
  state.position, state.velocity, state.omega, state.orientation, state.name = nil, 3, "x", false, {}
  setmetatable(state, { __newindex = function() end })
end
local tampered = impact.scene { duration = 0.1, forces = { impact.force { law = law } },
  bodies = { impact.body { name = "ball", shape = impact.sphere(1) } } }
assert(tampered:run() == "end of time" and seen)]])
end
succeeds([[
-- Our own functions, called out of turn.
for name, opener in pairs(package.preload) do pcall(opener) pcall(opener, name) pcall(opener, "quat.plot") pcall(opener, {}) end
local ok, why = pcall(package.preload["quat.plot"], "no such layer")
assert(not ok and why:find "no layer 'no such layer'")
for _, name in ipairs { "a\0b", "a\nb", "a\127b", "../a", "" } do
  local done, text = pcall(require "quat.host".write, name, "x")
  assert(not done and text:find "the name of a file must be plain")
end
local core = require "impact.core"
core.layer()
for _, f in pairs(core) do if type(f) == "function" then pcall(f) pcall(f, {}) pcall(f, 3) pcall(f, core) pcall(f, nil, {}) end end]])

-- With --trust, the script is Lua as usual.
succeeds("assert(os.execute and io.popen and debug.getinfo and string.dump) assert(load(string.dump(function() return 5 end))() == 5)", "--trust")
succeeds("local f = assert(io.open('secret')) assert(f:read('a') == 'secret')", "--trust")

-- Limits.
local function limited(text, options, wanted)
  local code, _, said = runner.script(text, options)
  if code ~= 5 or said:gsub("^\n", ""):gsub("; the run came to t = .*", "\n") ~= "impact: " .. wanted .. "\n" then
    error(string.format("wanted exit code 5 and %s, got %d and %s of\n%s", wanted, code, said, text), 2)
  end
  check.truth(runner.shell("ls " .. runner.quote(here) .. "/o/*.csv 2>/dev/null | grep -qv partial.csv") ~= 0, "no CSV under its final name")
end
limited("local t = {} while true do t[#t + 1] = ('x'):rep(1e5) .. #t end", "--max-memory 20", "memory limit of 20 MB reached")
limited("local s = ('x'):rep(1e9)", "--max-memory 20", "memory limit of 20 MB reached")
limited("return 1", "--max-memory 0.001", "the memory limit is too small to start")
limited("local impact = require 'impact' impact.scene { duration = 1e4, output_rate = 1e3, bodies = { impact.body { name = 'b', " ..
  "shape = impact.sphere(1) } } }:run { record = true }", "--max-memory 2", "memory limit of 2 MB reached")
succeeds("assert(not pcall(string.rep, 'x', 1e9))", "--max-memory 20")
local over = "time limit of 0.2 s reached"
limited("while true do end", "--max-time 0.2", over)
limited("while true do pcall(function() while true do end end) end", "--max-time 0.2", over)
limited("while true do pcall(coroutine.wrap(function() while true do end end)) end", "--max-time 0.2", over)
if require "impact".has "cvode" then
  limited("local impact = require 'impact' return impact.scene { name = 'long', duration = 1e7, gravity = { 0, 0, 0 }, " ..
    "forces = { impact.force { law = function(t, b) return { -b.position.x, 0, 0 } end } }, " ..
    "bodies = { impact.body { name = 'ball', shape = impact.sphere(1), position = { 1, 0, 0 } } } }", "--max-time 0.2", over)
end
limited("local impact = require 'impact' return impact.scene { name = 'long', duration = 1e7, output_rate = 1000, " ..
  "bodies = { impact.body { name = 'ball', shape = impact.sphere(1) } } }", "--max-time 0.2", over)
local stuck = "time limit reached, and the script did not stop"
limited("setmetatable({}, { __gc = function() while true do end end }) collectgarbage()", "--max-time 0.2", stuck)
limited("string.find(('a'):rep(400), ('.-'):rep(12) .. 'b')", "--max-time 0.2", stuck)

check.report("sandbox")
