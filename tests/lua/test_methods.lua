-- SPDX-License-Identifier: MIT
--- The methods of a scene, and of a gap, as keys of a script; keys that are of no use are refused by name.
local check = require "check"
local impact = require "impact"
local quat = require "quat"

local function definition(methods, rest)
  local d = {
    name = "two", duration = .7, gravity = { 0, 0, 0 }, methods = methods,
    bodies = {
      { name = "one", shape = impact.ellipsoid { a = .1, b = .2, c = .3 }, velocity = { 1, 0, 0 }, omega = { 1, 2, 3 } },
      { name = "other", shape = impact.ellipsoid { a = .3, b = .2, c = .1 }, position = { .7, .05, 0 }, velocity = { -1, 0, 0 } },
    },
  }
  for key, value in pairs(rest or {}) do d[key] = value end
  return d
end

local function run(methods, rest)
  local scene = impact.scene(definition(methods, rest))
  check.equal(scene:run(), "end of time")
  return scene:state("one").velocity, scene:usage()
end

local exact, usage = run(nil)
check.truth(usage.ballistic_flights > 0 and usage.gap_newton > 0 and usage.integrator_steps == 0)
local cases = {
  { { motion = "cvode" }, 1e-11 }, { { motion = "rk4", step = 1e-4 }, 1e-11 }, { { impacts = "cvode" }, 1e-11 },
  { { motion = "auto", impacts = "auto", gaps = "newton" }, 0 }, { { gaps = "ccd", gap_tolerance = 1e-7 }, 1e-3 },
  { { motion = "cvode", impacts = "cvode", gaps = "ccd", tolerance = 1e-10 }, 0.1 },
}
for _, case in ipairs(cases) do
  local methods, within = table.unpack(case)
  local velocity, used = run(methods)
  check.truth((velocity - exact):norm() <= within, "off by " .. (velocity - exact):norm())
  check.equal(used.gap_newton == 0, methods.gaps == "ccd")
  check.equal(used.gap_ccd > 0, methods.gaps == "ccd")
  check.equal(used.ballistic_flights == 0, methods.motion == "cvode" or methods.motion == "rk4")
  check.equal(used.impacts_cvode > 0, methods.impacts == "cvode")
end
-- The short names: the same bits.
local short, long = run(nil, { solver = "cvode", tolerance = 1e-8 }), run { impacts = "cvode", tolerance = 1e-8 }
check.truth(short.x == long.x and short.y == long.y and short.z == long.z)
run({ impacts = "series", tolerance = 1e-9 }, { solver = "series", tolerance = 1e-9 })

--- The call raises an error with these words in it.
local function raises(words, call, ...)
  local ok, said = pcall(call, ...)
  check.truth(not ok and said:find(words, 1, true), ("wanted '%s', got '%s'"):format(words, said))
end

local function refused(words, methods, rest) raises(words, impact.scene, definition(methods, rest)) end

refused("unknown key 'movement' in methods", { movement = "rk4" })
refused("motion must be one of 'auto', 'cvode', 'rk4', 'steps', 'other', got the string 'rk45'", { motion = "rk45" })
refused("gaps must be one of 'newton', 'ccd'", { gaps = "gjk" })
refused("solver, and impacts in methods, are two names of one key", { impacts = "cvode" }, { solver = "auto" })
refused("tolerance, and tolerance in methods, are two names of one key", { tolerance = 1e-9 }, { tolerance = 1e-13 })
refused("needs a step", { motion = "rk4" })
refused("step in methods is that of motion", { step = 1e-3 })
refused("gap_tolerance in methods is libccd's", { gap_tolerance = 1e-4 })
refused("libccd cannot give it; 1e-07 to 0.01", { gaps = "ccd", gap_tolerance = 1e-9 })
refused("impact_tolerance in methods is CVODE's", { impact_tolerance = 1e-9 })
refused("step must be a positive number", { motion = "rk4", step = -1 })

-- A body runs over a flat place in next to no time: as that all but stands no other, half a metre away, is met.
do
  local function flat(motion)
    return impact.scene { duration = 1, gravity = { 0, 0, -9.81 }, methods = { motion = motion }, bodies = {
      impact.body { name = "floor", shape = impact.plane(), friction = 0.89581282089456826, restitution = 1 },
      impact.body { name = "egg", mass = 0.32174532030821551, friction = 1, restitution = 0.81981280880910024,
        shape = impact.superellipsoid { a = 0.11368438681290596, b = 0.075893901791623961, c = 0.084629168365108198, eps1 = 0.5, eps2 = 0.5 },
        position = { 0.011854443161597695, 0.0052322902742822476, 0.35 }, velocity = { -0.14237969771210113, 0.44617659026875733, -0.6114816017215976 } },
      impact.body { name = "block", mass = 1.028859601277871, friction = 1, restitution = 0.41552657127305359,
        shape = impact.superquadric { a = 0.078077670017918446, b = 0.056480989162809241, c = 0.11838147642558818, r = 2.0000080496687582,
          s = 9.7098959044129174, t = 2.6710450412785884 },
        position = { 0.064039989597311914, 0.06830344387264925, 0.8 },
        orientation = quat.new(0.14493109666784809, -0.046016582250989924, 0.14627120705396202, 0.27025896851384068):normalize(),
        velocity = { -0.040203446731270853, 0.088918102098379026, -0.62068561449989124 },
        omega = { -1.3888227869628349, 2.5436507071429242, 0.73614860659599435 } },
    } }
  end
  local exact, textbook = flat "auto", flat "cvode"
  check.equal(exact:run(), "end of time")
  check.equal(textbook:run(), "end of time")
  for _, name in ipairs { "egg", "block" } do
    check.close((exact:state(name).position - textbook:state(name).position):norm(), 0, 1e-8)
  end
end

-- A gap's own options.
local body = {}
for i, b in ipairs(definition().bodies) do body[i] = { name = b.name, shape = b.shape, position = b.position } end
local newton, ccd = impact.gap(body[1], body[2]), impact.gap(body[1], body[2], { method = "ccd", tolerance = 1e-6 })
check.equal(ccd.path, "ccd")
check.truth(newton.gap ~= ccd.gap and math.abs(newton.gap - ccd.gap) < 1e-5)
check.equal(impact.gap(body[1], body[2], { method = "newton" }).gap, newton.gap)
local function gap_refused(words, options) raises(words, impact.gap, body[1], body[2], options) end
gap_refused("method must be one of 'newton', 'ccd'", { method = "gjk" })
gap_refused("unknown key 'methods' in options", { methods = "ccd" })
gap_refused("tolerance is libccd's", { tolerance = 1e-4 })
gap_refused("tolerance must be in", { method = "ccd", tolerance = 1e-9 })

check.report "methods"
