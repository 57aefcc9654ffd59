-- SPDX-License-Identifier: MIT
--- Slip that dies out: by the explicit method, whose steps shorten with it, and by CVODE, whose clock it slows. Both
--- stick at the same instants in the same states, the explicit method in a handful of steps.
local check = require "check"
local impact = require "impact"

--- A lens that slides, and turns, on a floor, until it rolls.
local function lens(k, motion)
  local sticks = {}
  local scene = impact.scene { duration = .4, gravity = { 0, 0, -9.81 }, methods = { motion = motion }, bodies = {
    impact.body { name = "floor", shape = impact.plane(), friction = 1, restitution = 1 },
    impact.body { name = "lens", shape = impact.ellipsoid { a = .1, b = .11, c = .09 }, mass = 1, friction = .3, restitution = 0,
      position = { 0, 0, .09 }, velocity = { .2 + .02 * k, .1, 0 }, omega = { .3 * k, -2 + .3 * k, 3 - .5 * k } },
  } }
  local ends = scene:run { on_event = function(event) if event.event == "stick" then sticks[#sticks + 1] = event.t end end }
  check.equal(ends, "end of time")
  return scene, sticks
end

local steps, clocked, count = 0, 0, 0
for k = 0, 9 do
  local explicit, sticks = lens(k, "auto")
  local cvode, others = lens(k, "cvode")
  check.truth(#sticks > 0, "it sticks")
  check.equal(#sticks, #others)
  for i, t in ipairs(sticks) do check.close(t, others[i], 1e-10) end
  check.close((explicit:state("lens").position - cvode:state("lens").position):norm(), 0, 1e-10)
  check.close((explicit:state("lens").omega - cvode:state("lens").omega):norm(), 0, 1e-8)
  steps, clocked, count = steps + explicit:usage().integrator_steps, clocked + cvode:usage().integrator_steps, count + #sticks
end
-- The way before and after with it.
check.truth(steps <= 60 * count, steps .. " steps for " .. count .. " slips that die out")
check.truth(clocked >= 5 * steps, "CVODE takes " .. clocked)

check.report "fading"
