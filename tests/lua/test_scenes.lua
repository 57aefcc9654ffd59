-- SPDX-License-Identifier: MIT
--- The example scenes and figures against the rows committed beside them, a tolerance per column; arg[3] is the examples' folder.
--- After a change that is meant to move them: impact SCENE.lua --out examples/scenes/expected, without the picture.
local check = require "check"
local runner = require "runner"
runner.clean()
local scenes, figures = arg[3] .. "/scenes", arg[3] .. "/figures"

-- What the integrator's tolerance of 1e-13 leaves room for, many times over; another compiler moves the last digits only.
local tolerances = {
  t = 1e-10, x = 1e-9, y = 1e-9, z = 1e-9, qw = 1e-9, qx = 1e-9, qy = 1e-9, qz = 1e-9, vx = 1e-8, vy = 1e-8, vz = 1e-8,
  wx = 1e-8, wy = 1e-8, wz = 1e-8, image = 1e-12, image_x = 1e-12, image_y = 1e-12, back = 1e-12, px = 1e-9, py = 1e-9, pz = 1e-9, nx = 1e-9, ny = 1e-9, nz = 1e-9, impulse_n = 1e-8,
  turn = 1e-12, radius = 1e-12, place = 1e-12, impulse_t = 1e-8, p = 1e-12, ux = 1e-12, uy = 1e-12, uz = 1e-12, s = 1e-12, gap = 1e-12, ax = 1e-12, ay = 1e-12, az = 1e-12, bx = 1e-12, by = 1e-12, bz = 1e-12, un_before = 1e-8, un_after = 1e-8, energy_before = 1e-7, energy_after = 1e-7,
}

local function cells(line)
  local row = {}
  for cell in (line .. ","):gmatch("([^,]*),") do row[#row + 1] = cell end
  return row
end

-- The energies of events of one instant, as they are when the events come in the order of the list.
local function chain_energies(header, list)
  local before, after = #header - 1, #header
  if header[before] ~= "energy_before" then return end
  local instant, energy
  for i, row in ipairs(list) do
    local now = row.key:match("%S+")
    local same = now == instant
    if not same then
      energy = -math.huge
      for k = i, #list do
        if list[k].key:match("%S+") ~= now then break end
        energy = math.max(energy, tonumber(list[k][before]))
      end
    end
    local lost = row[before] - row[after]
    row[before], row[after] = string.format("%.17g", energy), string.format("%.17g", energy - lost)
    instant, energy = now, energy - lost
  end
end

-- Of two bodies that do the same at the same time, rounding alone says who comes first: within 1e-9 s, rows go by body.
local function rows(path)
  local file = assert(io.open(path))
  local header, list = cells(file:read()), {}
  local body = header[2] == "body" and 2 or 3
  for line in file:lines() do
    local row = cells(line)
    row.key = string.format("%.9f %s %06d", row[1], row[body], #list)
    list[#list + 1] = row
  end
  file:close()
  table.sort(list, function(a, b) return a.key < b.key end)
  chain_energies(header, list)
  table.insert(list, 1, header)
  return list
end

-- Where bounces die out a ball is slower than 1e-3 m/s, and the gap's own rounding divided by its speed is how well an instant is
-- known: a hundred tolerances there, in the last 1e-4 s before a contact is held.
local function tails(path)
  local file, times = io.open(path), {}
  for line in file and file:lines() or function() end do
    local row = cells(line)
    if row[2] == "contact" then times[#times + 1] = tonumber(row[1]) end
  end
  if file then file:close() end
  return function(t)
    for _, contact in ipairs(times) do
      if t > contact - 1e-4 and t < contact + 1e-7 then return 100 end
    end
    return 1
  end
end

local function compare(folder, name)
  local allowance = tails(folder .. "/expected/" .. name:gsub("_events", ""):gsub("%.csv$", "_events.csv"))
  local wanted, got = rows(folder .. "/expected/" .. name), rows(runner.folder .. "/" .. name)
  local header = wanted[1]
  check.equal(table.concat(got[1], ","), table.concat(header, ","))
  check.equal(#got, #wanted)
  for i = 2, #wanted do
    for c, column in ipairs(header) do
      local a, b, tolerance = wanted[i][c], got[i][c], tolerances[column]
      tolerance = tolerance and tolerance * allowance(tonumber(wanted[i][1]))
      local good = tolerance and math.abs(tonumber(a) - tonumber(b)) <= tolerance or not tolerance and a == b
      if not good then
        error(string.format("%s, row %d, %s: wanted %s, got %s%s", name, i, column, a, b,
          tolerance and string.format(", off by %.3g tolerances", math.abs(a - b) / tolerance) or ""))
      end
      check.truth(good)
    end
  end
end

for _, name in ipairs { "sphere_wall", "sphere_wall_rolling", "sphere_wall_spin", "two_spheres", "bouncing_ball", "t_handle", "superball",
  "newtons_cradle", "balls_in_a_box", "bowling_ball", "rattleback", "tippe_top", "eulers_disk", "turntable", "dice", "rocking_block", "ramp", "stack", "dominoes", "coin",
  "curling" } do
  local code, out, said = runner.command(string.format("%s --out .", runner.quote(scenes .. "/" .. name .. ".lua")))
  check.equal(code, 0)
  check.truth(said == "" or said:find("gnuplot is not installed", 1, true), "no complaint but of a missing gnuplot: " .. said)
  check.truth(said ~= "" or (runner.read(name .. ".png") or ""):sub(1, 4) == "\137PNG", "the picture of " .. name)
  for _, line in ipairs { "events", "energy", "used", "not used", "wrote" } do
    check.truth(out:find("\n  " .. line .. " +"), "the summary's line on " .. line)
  end
  compare(scenes, name .. ".csv")
  compare(scenes, name .. "_events.csv")
end

-- A wall that is struck is chaotic: its bricks stand until the ball comes, then none leaves the ground downward, and the account closes.
do
  local code, out = runner.command(string.format("%s --out .", runner.quote(scenes .. "/brick_wall.lua")))
  check.equal(code, 0)
  check.truth(tonumber(out:match "off by (%S+) J%)") <= 1e-9)
  local table_rows = rows(runner.folder .. "/brick_wall.csv")
  local column, first, struck, lowest = {}, {}, nil, math.huge
  for c, name in ipairs(table_rows[1]) do column[name] = c end
  for i = 2, #table_rows do
    local row = table_rows[i]
    local body, t = row[column.body], tonumber(row[column.t])
    if body:find "^brick" then
      first[body] = first[body] or row
      lowest = math.min(lowest, tonumber(row[column.z]))
      if row[column.y] ~= first[body][column.y] then struck = math.min(struck or t, t) end
    end
  end
  check.truth(struck and struck > 0.05, "the ball strikes after 0.05 s")
  check.truth(lowest > 0.03 - 1e-6, "no brick's centre is lower than half of it is high")
end

-- A house of cards stands by proof; struck it is chaotic: in the end all cards lie lower than one leaning is high, and the account closes.
do
  local house = runner.quote(scenes .. "/house_of_cards.lua")
  local code, out = runner.command(house .. " --out . -- speed=0")
  check.equal(code, 0)
  check.truth(out:find("at rest, t = 0 s", 1, true), "the house stands")
  code, out = runner.command(house .. " --out .")
  check.equal(code, 0)
  check.truth(tonumber(out:match "off by (%S+) J%)") <= 1e-9)
  local table_rows = rows(runner.folder .. "/house_of_cards.csv")
  local column, last = {}, {}
  for c, name in ipairs(table_rows[1]) do column[name] = c end
  for i = 2, #table_rows do last[table_rows[i][column.body]] = tonumber(table_rows[i][column.z]) end
  for body, z in pairs(last) do check.truth(z > 0 and z < 0.041, body .. " has come down, and not through the table") end
end

-- Each figure, and the rows it gives.
local expected = {
  fig02 = { "fig02" }, fig03 = { "fig03" }, fig04 = { "fig04a", "fig04b" }, fig05 = { "fig05a", "fig05b" }, fig06 = { "fig06" }, fig07 = { "fig07" }, untwist = { "untwist", "untwist_frames" }, hopf = { "hopf" }, gimbal = { "gimbal" }, fig10 = { "fig10" }, fig11 = { "fig11" }, fig13 = { "fig13" },
  fig15 = { "fig15" }, fig16 = { "fig16" }, hodograph = { "hodograph" },
}
if pcall(require, "quat.gsl") then
  for _, name in ipairs { "fig12", "curvature", "trefoil" } do expected[name] = { name } end
  for _, column in ipairs { "u", "v", "gauss", "mean", "gauss_off", "mean_off" } do tolerances[column] = tolerances[column] or 1e-13 end
  for _, column in ipairs { "longitude", "length", "angle", "frenet_angle", "closed_angle" } do tolerances[column] = tolerances[column] or 1e-9 end
  for _, frame in ipairs { "north", "south", "frenet", "minimal", "closed" } do
    for _, part in ipairs { "_w", "_x", "_y", "_z" } do tolerances[frame .. part] = 1e-9 end
  end
end
for name, lists in pairs(expected) do
  local code, _, said = runner.command(string.format("%s --out .", runner.quote(figures .. "/" .. name .. ".lua")))
  check.equal(code, 0)
  check.truth(said == "" or said:find("gnuplot is not installed", 1, true), "no complaint but of a missing gnuplot: " .. said)
  check.truth(said ~= "" or (runner.read(name .. ".png") or ""):sub(1, 4) == "\137PNG", "the picture of " .. name)
  for _, list in ipairs(lists) do compare(figures, list .. ".csv") end
end

-- A second run, at another time and place, is the same to the bit.
runner.shell(string.format("cd %s && mkdir again", runner.quote(runner.folder)))
check.equal(runner.command(string.format("%s --out again --quiet", runner.quote(scenes .. "/sphere_wall.lua"))), 0)
check.equal(runner.read("again/sphere_wall.csv"), runner.read("sphere_wall.csv"))

-- Without gnuplot: the CSV files, one line that says so, and success.
runner.shell(string.format("cd %s && PATH=/nonexistent %s %s --out bare// --quiet 2>stderr.txt; echo $? >code.txt",
  runner.quote(runner.folder), runner.quote(runner.program), runner.quote(scenes .. "/sphere_wall.lua")))
check.equal(runner.read("code.txt"), "0\n")
check.equal(runner.read("stderr.txt"), "impact: gnuplot is not installed: no picture is drawn; the CSV files are complete\n")
check.equal(runner.read("bare/sphere_wall.csv"), runner.read("sphere_wall.csv"))
check.truth(not runner.exists("bare/sphere_wall.png") and not runner.exists("bare/sphere_wall.png.part"), "no picture, no part of one")

check.report("scenes")
