-- SPDX-License-Identifier: MIT
-- impact.collide, impact.collide_many, impact.collide_sensitivity and impact.flow from Lua.
local impact = require "impact"
local check = require "check"

local j = 0.144
local sphere = { m1 = 4, J1 = { moments = { j, j, j } }, r1 = { 0, 0, -0.3 }, v1 = { 4, 1, -2 }, w1 = { 1, -2, 5 },
  n = { 0, 0, 1 }, mu = 0.25, eps = 0.3 }
local function with(changes)
  local copy = {}
  for key, value in pairs(sphere) do copy[key] = value end
  for key, value in pairs(changes) do copy[key] = value end
  return copy
end
local near = check.close

-- A sphere slides on the floor.
do
  local o = assert(impact.collide(sphere))
  local s = math.sqrt(4.6 ^ 2 + 1.3 ^ 2)
  near(o.v1.x, 4 - 0.65 * 4.6 / s, 1e-14)
  near(o.v1.z, 0.6, 1e-15)
  near(o.impulse_normal, 10.4, 1e-14)
  near(o.energy_after - o.energy_before, o.work.compression + o.work.restitution + o.work.friction, 1e-13)
  check.truth(o.solver == "closed form" and o.status == "ok" and o.compressions == 1)
  check.truth(table.concat(o.phases, " ") == "slip-c slip-r")
end

-- A tensor in the world, and m2 = math.huge, are the same body.
do
  local one = assert(impact.collide(with { J1 = { moments = { 0.1, 0.2, 0.25 }, orientation = { 0.8, 0, 0, 0.6 } }, r1 = { 0.1, 0, -0.3 } }))
  -- R diag R' for a turn of 2 acos(0.8) about z: cos = .28, sin = .96.
  local c, s = 0.28, 0.96
  local tensor = { { 0.1 * c * c + 0.2 * s * s, (0.1 - 0.2) * c * s, 0 }, { (0.1 - 0.2) * c * s, 0.1 * s * s + 0.2 * c * c, 0 }, { 0, 0, 0.25 } }
  local two = assert(impact.collide(with { J1 = tensor, r1 = { 0.1, 0, -0.3 }, m2 = math.huge }))
  for _, key in ipairs { "x", "y", "z" } do
    near(one.v1[key], two.v1[key], 1e-14)
    near(one.w1[key], two.w1[key], 1e-13)
  end
  check.truth(one.solver == "series")
end

-- Separating bodies stay as they are.
do
  local o = assert(impact.collide(with { v1 = { 0, 0, 2 } }))
  check.truth(o.status == "separating" and o.v1.z == 2)
end

-- A ball that falls straight follows velocity and restitution, each as they are; what nearly stops follows them by what is left of its velocity.
do
  local falls = with { v1 = { 0, 0, -1 }, w1 = { 0, 0, 0 }, eps = 0.5 }
  local sensitivity = assert(impact.collide_sensitivity(falls))
  check.truth(math.abs(sensitivity - math.sqrt(2)) < 1e-14, tostring(sensitivity))
  local stops = with { J1 = { moments = { 4, 4, 4 } }, v1 = { 1e-6, -0.75, -1 }, w1 = { 0, 0, 0 }, r1 = { 0, -0.6, -0.8 }, n = { 0, 0.6, 0.8 }, mu = 0, eps = 0 }
  sensitivity = assert(impact.collide_sensitivity(stops))
  check.truth(sensitivity > 1e5 and sensitivity < 1e7, tostring(sensitivity))
  local ok, message = pcall(impact.collide_sensitivity, with { frition = 1 })
  check.truth(not ok and tostring(message):find("unknown key 'frition'", 1, true), tostring(message))
  local answer, why = impact.collide_sensitivity(with { mu = function() return 0.25 end })
  if impact.has "cvode" then
    check.truth(answer > 0.1, tostring(why))
    ok, message = pcall(impact.collide_sensitivity, with { mu = function() error "worn out" end })
    check.truth(not ok and tostring(message):find("worn out", 1, true), tostring(message))
  else
    check.truth(answer == nil and why:find("left out of the build", 1, true), tostring(why))
  end
  answer, why = impact.collide_sensitivity(with { solver = "closed_form", r1 = { 0.1, 0.2, -0.3 } })
  check.truth(answer == nil and why == "solver is closed_form, and this impact has none", tostring(why))
end

-- A solver that has no answer says why.
do
  local turning = with { solver = "closed_form", J1 = { moments = { 0.1, 0.2, 0.25 } }, r1 = { 0.1, 0.2, -0.3 } }
  local o, why = impact.collide(turning)
  check.truth(o == nil and why == "solver is closed_form, and this impact has none", tostring(why))
  turning.count = 1
  check.truth(impact.collide_many(turning).status[1] == why)
end

-- Mistakes are named.
do
  local function fails(changes, text)
    local ok, message = pcall(impact.collide, with(changes))
    check.truth(not ok and tostring(message):find(text, 1, true), tostring(message))
  end
  fails({ m1 = -3 }, "m1")
  fails({ frition = 1 }, "unknown key 'frition'")
  fails({ eps = 1.2 }, "eps")
  fails({ J1 = { { 1, 2, 3 }, { 0, 1, 0 }, { 0, 0, 1 } } }, "J1 must be symmetric")
  fails({ J1 = { moments = { 1, 0, 1 } } }, "moments")
  fails({ n = { 0, 0, 0 } }, "normal")
  fails({ law = "poison" }, "law")
  fails({ v1 = { 0 / 0, 0, 0 } }, "v1")
end

if impact.has "cvode" then
  -- A friction law in Lua.
do
    local body = { J1 = { moments = { 0.1, 0.2, 0.25 } }, r1 = { 0.1, 0.05, -0.3 } }
    local constant = assert(impact.collide(with(body)))
    body.mu = function(speed) assert(speed >= 0) return 0.25 end
    local law = assert(impact.collide(with(body)))
    check.truth(law.solver == "cvode")
    near(law.v1.x, constant.v1.x, 1e-9)
    body.mu = function(speed) return 0.1 + 0.3 / (1 + speed) end
    local falling = assert(impact.collide(with(body)))
    check.truth(math.abs(falling.v1.x - constant.v1.x) > 1e-3)
    body.mu = function() error "no law here" end
    local ok, message = pcall(impact.collide, with(body))
    check.truth(not ok and tostring(message):find("no law here", 1, true))
    body.mu = function() return -1 end
    ok, message = pcall(impact.collide, with(body))
    check.truth(not ok and tostring(message):find("mu", 1, true))
  end
end

-- Many impacts are the same as one by one, on any number of threads.
do
  local count, m1, v1, J1 = 300, {}, {}, {}
  for i = 1, count do
    m1[i] = 1 + i / 100
    J1[i] = { moments = { 0.1 + i / 1000, 0.2, 0.25 } }
    for k, x in ipairs { math.sin(i), math.cos(i), -1 - i / 100 } do v1[3 * i - 3 + k] = x end
  end
  local shared = { n = { 0, 0, 1 }, r1 = { 0.1, 0.2, -0.3 }, eps = 0.5, mu = 0.4, law = "stronge" }
  local function call(threads)
    return assert(impact.collide_many { count = count, threads = threads, m1 = m1, J1 = J1, v1 = v1, n = shared.n, r1 = shared.r1,
      eps = shared.eps, mu = shared.mu, law = shared.law })
  end
  local single, several = call(1), call(3)
  for i = 1, count do
    local o = assert(impact.collide { m1 = m1[i], J1 = J1[i], v1 = { v1[3 * i - 2], v1[3 * i - 1], v1[3 * i] }, n = shared.n, r1 = shared.r1,
      eps = shared.eps, mu = shared.mu, law = shared.law })
    for k, axis in ipairs { "x", "y", "z" } do
      check.truth(single.v1[3 * i - 3 + k] == o.v1[axis] and several.v1[3 * i - 3 + k] == o.v1[axis])
      check.truth(several.w1[3 * i - 3 + k] == o.w1[axis])
    end
    check.truth(several.status[i] == "ok" and several.energy_after[i] == o.energy_after)
  end
  m1[17] = -1
  local ok, message = pcall(call, 2)
  check.truth(not ok and tostring(message):find("impact 17", 1, true), tostring(message))
end

-- The receipt of an answer is small, of a changed one large; arrays have it when asked.
do
  local slides = with { J1 = { moments = { 0.1, 0.2, 0.25 } }, r1 = { 0.1, 0.05, -0.3 } }
  local o = assert(impact.collide(slides))
  local r = impact.collide_receipt(slides, o)
  check.truth(r.worst < 100 and o.error > 0 and o.error < 1e-13 and not o.second, tostring(r.worst))
  for _, field in ipairs { "momentum", "spin", "cone", "energy", "power", "law", "approach", "stick", "path" } do
    check.truth(r[field] <= r.worst, field)
  end
  check.truth(#o.phase_impulses == #o.phases)
  near(o.phase_impulses[#o.phases].z, o.impulse.z, 1e-14)
  o.impulse_normal = o.impulse_normal * (1 + 1e-9)
  check.truth(impact.collide_receipt(slides, o).approach > 1e4)
  check.truth(r.hodograph <= r.worst and math.type(r.slips) == "float" and r.slips >= 0)
  local less = with { J1 = slides.J1, r1 = slides.r1, mu = 0.2 }
  check.truth(impact.collide_receipt(less, assert(impact.collide(slides))).cone > 1e4)
  for _, wrong in ipairs { { phases = { "slipping" } }, { impulse_normal = "much" }, { normal_before = 0 / 0 } } do
    local bad = assert(impact.collide(slides))
    for key, value in pairs(wrong) do bad[key] = value end
    local ok, message = pcall(impact.collide_receipt, slides, bad)
    check.truth(not ok and tostring(message):find((next(wrong)), 1, true), tostring(message))
  end
  local array = { count = 2, m1 = 4, J1 = { moments = { 0.1, 0.2, 0.25 } }, r1 = { 0.1, 0.05, -0.3 }, v1 = { 4, 1, -2 }, n = { 0, 0, 1 }, mu = 0.25 }
  check.truth(assert(impact.collide_many(array)).error[2] == 0)
  array.checked = true
  check.truth(assert(impact.collide_many(array)).error[2] > 0)
end

-- What lies outside of the admitted range is refused in words.
do
  local ok, message = pcall(impact.collide, with { J1 = { moments = { 1e-14, 1, 1 } } })
  check.truth(not ok and tostring(message):find("body 1: moments spread over 1e+14, at most 1e+12", 1, true), tostring(message))
end

-- The flow as columns.
do
  local f = assert(impact.flow { a = 2, b = 1, c = 0.3, d = 0.2, m = 1.5, mu = 0.5, u = { 1, 0.5, -1 }, p_end = 8, count = 50 })
  check.truth(#f.p == 50 and #f.ux == 50 and f.p[50] == 8 and f.s[1] > 1)
  check.truth(#f.directions == 4 or #f.directions == 2)
  check.truth(f.stick[50] == true and f.s[50] == 0)
end

check.report "collide"
