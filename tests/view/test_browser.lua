-- SPDX-License-Identifier: MIT
--- The page of a run in a headless Chromium: nothing in the console, something drawn, states as the library has them, keys, names that
--- mean harm, no request. The page writes a report into its root element when its address asks for it (view/hands.js).
local impact = require "impact"
local check, runner = require "check", require "runner"
local chromium, examples = arg[3], arg[4]
runner.clean()

-- Opens the page at an address and returns its report, as a table of texts by key, and what the console said.
local function visit(page, address)
  runner.shell(string.format("cd %s && %s --headless --no-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader --enable-logging=stderr " ..
    "--window-size=1200,800 --virtual-time-budget=4000 --dump-dom 'file://'\"$PWD\"'/%s#%s' >dom.txt 2>log.txt", runner.quote(runner.folder),
    runner.quote(chromium), page, address))
  local text = (runner.read("dom.txt"):match('data%-report="([^"]*)"') or ""):gsub("&quot;", '"')
  local said = {}
  for line in runner.read("log.txt"):gmatch "[^\n]*CONSOLE[^\n]*" do
    if not line:find("GL Driver Message (OpenGL, Performance", 1, true) then said[#said + 1] = line end -- a test reads pixels: slow
  end
  return text, table.concat(said, "\n")
end

local function field(report, name) return report:match('"' .. name .. '":([^,}%]]+)') end

-- All numbers of the report's states: 13 for each body and time.
local function states(report)
  local list = {}
  for word in (report:match '"states":(.*)' or ""):gmatch "[-+.%de]+" do list[#list + 1] = tonumber(word) end
  return list
end

local function sound(report, said)
  check.equal(said, "")
  check.truth(report ~= "", "the page reports")
  check.equal(field(report, "error"), "0")
  check.equal(field(report, "requests"), "0")
end

-- Examples: states at random times are the record's own, read by the library; each moving body's colour stands where its centre is.
math.randomseed(15)
for _, name in ipairs { "sphere_wall", "sphere_wall_spin", "t_handle", "dice" } do
  check.equal(runner.command("view " .. runner.quote(examples .. "/scenes/" .. name .. ".lua") .. " --out ."), 0)
  local run = assert(impact.open(runner.folder .. "/" .. name .. ".run"))
  local _, last = run:times()
  local times = {}
  for i = 1, 60 do times[i] = string.format("%.17g", math.random() * last) end
  local report, said = visit(name .. ".html", "t=" .. times[1] .. "&check&probe=" .. table.concat(times, ","))
  sound(report, said)
  local numbers, k, worst = states(report), 0, 0
  for _, t in ipairs(times) do
    for _, body in ipairs(run:bodies()) do
      local s = run:state(body.name, tonumber(t))
      local wanted = { s.position.x, s.position.y, s.position.z, s.orientation.w, s.orientation.x, s.orientation.y, s.orientation.z }
      for c = 1, 7 do worst = math.max(worst, math.abs(numbers[k + c] - wanted[c])) end
      k = k + 13
    end
  end
  check.equal(#numbers, k)
  check.close(worst, 0, 1e-9)
  print(string.format("%s: states within %.1e", name, worst))
  for pixel in report:match '"pixels":%[(.-)%]%]':gmatch "%d+,%d+,%d+" do
    local r, g, b = pixel:match "(%d+),(%d+),(%d+)"
    local off = math.abs(r - 247) + math.abs(g - 246) + math.abs(b - 243)
    check.truth(math.min(off, math.abs(r - 20) + math.abs(g - 22) + math.abs(b - 26)) > 40, "a body is drawn where its centre is")
  end
end

-- A page too large for its record has it thinned: to what it says, and it says so.
local report, said
for name, tolerance in pairs { dominoes = 1e-4, brick_wall = 1e-5 } do
  check.equal(runner.command("view " .. runner.quote(examples .. "/scenes/" .. name .. ".lua") .. " --out . --tolerance " .. tolerance), 0)
  local run = assert(impact.open(runner.folder .. "/" .. name .. ".run"))
  report, said = visit(name .. ".html", "t=0.3&check&probe=0.05,0.1234,0.3,0.45,0.5")
  sound(report, said)
  check.truth(runner.read("dom.txt"):find("thinned for this page to " .. string.format("%.5f", tolerance):gsub("0+$", "") .. " of a body", 1, true), "it says so")
  local numbers, k = states(report), 0
  for _, t in ipairs { 0.05, 0.1234, 0.3, 0.45, 0.5 } do
    for _, body in ipairs(run:bodies()) do
      local s, size = run:state(body.name, t), body.shape.bounding_radius
      size = size < math.huge and size or 1
      for c, wanted in ipairs { s.position.x, s.position.y, s.position.z } do check.close(numbers[k + c], wanted, tolerance * size) end
      for c, wanted in ipairs { s.orientation.w, s.orientation.x, s.orientation.y, s.orientation.z } do check.close(numbers[k + 3 + c], wanted, tolerance) end
      k = k + 13
    end
  end
  check.equal(#numbers, k)
  check.truth(#runner.read(name .. ".html") < 0.1 * #runner.read(name .. ".run"), "and is a tenth as large at most")
end

local size = #runner.read("sphere_wall.html")
print(string.format("sphere_wall.html: %d bytes", size))
check.truth(size <= 65536, "the thesis' scene is a page of at most 64 KB")

-- Keys: up to the first event, past it, back before it, to the end; play.
local events = assert(impact.open(runner.folder .. "/sphere_wall.run")):events()
local function press(keys)
  local report, said = visit("sphere_wall.html", "t=0&check&press=" .. keys)
  sound(report, said)
  return report
end
report = press "ArrowRight"
check.close(tonumber(field(report, "t")), events[1].t, 1e-15)
check.equal(field(report, "before"), "true")
report = press "ArrowRight,ArrowRight"
check.close(tonumber(field(report, "t")), events[1].t, 1e-15)
check.equal(field(report, "before"), "false")
check.equal(field(press "ArrowRight,ArrowRight,ArrowLeft", "before"), "true")
check.close(tonumber(field(press "End", "t")), 3.75, 1e-15)
check.close(tonumber(field(press ".,.,.", "t")), 3 / 240, 1e-15)
check.equal(field(press "space", "playing"), "true")

-- Names that mean harm, one body that nothing moves, scales: all are text, and all is drawn.
local hostile = "</script><b onclick=1 id=harm>\"&'`\u{202e}"
local odd = {
  { name = hostile, size = 1, duration = 1 },
  { name = "small", size = 1e-6, duration = 1e-9 },
  { name = "large", size = 1e6, duration = 1e9 },
}
for i, scene in ipairs(odd) do
  local made = impact.scene {
    name = scene.name, duration = scene.duration, gravity = { 0, 0, 0 }, output_rate = 0,
    bodies = { impact.body { name = scene.name, shape = impact.ellipsoid { a = scene.size, b = 2 * scene.size, c = scene.size } },
      impact.body { name = "floor", shape = impact.plane(), position = { 0, 0, -3 * scene.size } } },
  }
  made:run { record = true }
  local page = "odd" .. i .. ".html"
  assert(made:record():view(runner.folder .. "/" .. page))
  local text = runner.read(page)
  check.truth(not text:find("<b onclick", 1, true), "no name stands in the page as it is")
  check.truth(not text:find "https?://" and not text:find " src=" and not text:find " href=", "the page names nothing outside")
  local told, said = visit(page, "check")
  sound(told, said)
  check.truth(not runner.read("dom.txt"):find('<b onclick', 1, true), "no name becomes an element")
end
check.report("browser")
