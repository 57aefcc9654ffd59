-- SPDX-License-Identifier: MIT
--- Custom forces with corners, and a scene's receipt, from Lua.
local check = require "check"
local impact = require "impact"

local function scene(force, more)
  local definition = { name = "forced", gravity = { 0, 0, 0 }, duration = 1, output_rate = 0, forces = { force },
    bodies = { impact.body { name = "ball", shape = impact.sphere(0.1), mass = 1, velocity = { 1, 0, 0 } } } }
  for key, value in pairs(more or {}) do definition[key] = value end
  return impact.scene(definition)
end

-- A square wave whose corners are told: up and down take turns, and the ball ends as fast as it began.
local function wave(t) return { t // 0.1 % 2 == 0 and 7 or -7, 0, 0 } end
for _, corners in ipairs { { period = 0.1 }, { switches = { 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9 } } } do
  corners.law, corners.max_step = wave, math.huge
  local s = scene(impact.force(corners))
  check.equal(s:run(), "end of time")
  check.close(s:state("ball").velocity.x, 1, 1e-13)
  check.close(s:state("ball").position.x, 1 + 5 * 7 * 0.01, 1e-12)
  check.truth(s:usage().integrator_rhs_calls < 1200, "few evaluations")
end

-- An edge is met twice: in and out of a wall that pushes by a constant force, 1/8 s to stand and 1/8 s back.
local function wall(t, body) return { body.position.x > 0.5 and -8 or 0, 0, 0 } end
local function edge(t, body)
  check.truth(body.name == "ball" and body.velocity and body.omega and body.orientation, "the body is there")
  return body.position.x - 0.5
end
local s = scene(impact.force { name = "wall", law = wall, edge = edge })
check.equal(s:run { record = true }, "end of time")
check.close(s:state("ball").velocity.x, -1, 1e-11)
check.close(s:first("force", "ball").t, 0.5, 1e-12)
check.equal(#s:events(), 2)
check.close(s:events()[2].t, 0.75, 1e-10)

-- At rest, and pushed later; and at rest for ever under a force that says so.
local floor = impact.body { name = "floor", shape = impact.plane() }
local ball = impact.body { name = "ball", shape = impact.sphere(0.1), mass = 1, position = { 0, 0, 0.1 }, friction = 2 }
for _, steady in ipairs { true, false } do
  local push = impact.force { steady = steady, law = function(t) return { not steady and t > 0.5 and 7 or 0, 0, 0 } end,
    switches = { 0.5 } }
  local rest = scene(push, { bodies = { floor, ball }, gravity = { 0, 0, -9.81 } })
  check.equal(rest:run(), steady and "at rest" or "end of time")
  check.close(rest:state("ball").velocity.x, steady and 0 or 5 * 0.5, 1e-11)
  check.equal(rest:receipt(), "ok")
end

-- The receipt: residuals with their limits.
local word, residuals = s:receipt()
check.equal(word, "ok")
for _, key in ipairs { "unit", "gap", "contact", "energy", "momentum" } do
  check.truth(residuals[key] <= residuals["limit_" .. key], key)
end
check.equal(residuals.failed, nil)
check.close(residuals["end"], 1, 0)

-- Mistakes, by name and value.
local function fails(pattern, f, ...)
  local ok, message = pcall(f, ...)
  check.truth(not ok and tostring(message):find(pattern), pattern .. " in " .. tostring(message))
end
fails("max_step", impact.force, { law = wave, max_step = 0 })
fails("period", impact.force, { law = wave, period = -1 })
fails("edge must be a function", impact.force, { law = wave, edge = 3 })
fails("switches must be a list", impact.force, { law = wave, switches = 3 })
fails("switches%[2%] must be a number", impact.force, { law = wave, switches = { 1, "x" } })
fails("switches%[2%]", scene, impact.force { law = wave, switches = { 0.2, 0.1 } })
local broken = scene(impact.force { name = "odd", law = wave, edge = function() return 0 / 0 end })
fails("force 'odd': the edge must be a finite number", broken.run, broken)
local words = scene(impact.force { name = "odd", law = wave, edge = function() return "much" end })
fails("force 'odd': the edge must be a finite number, got a string", words.run, words)

-- A jump that was not told is met in words that say how to tell it.
local untold = scene(impact.force { max_step = 1e-3, law = function(t) return { t > 0.5 and t < 0.503 and 100 or 0, 0, 0 } end },
  { bodies = { { name = "ball", shape = impact.sphere(0.1), mass = 1 } } })
local reason, message = untold:run()
check.equal(reason, nil)
check.truth(message:find("switches in time, edge elsewhere", 1, true), message)

check.report "force"
