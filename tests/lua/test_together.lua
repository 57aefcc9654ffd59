-- SPDX-License-Identifier: MIT
-- impact.collide_together from Lua.
local impact = require "impact"
local check = require "check"
local near = check.close

local function ball(speed) return { m = 1, J = { moments = { 0.4, 0.4, 0.4 } }, v = { speed, 0, 0 } } end
local function contact(i)
  return { body1 = i, body2 = i + 1, n = { -1, 0, 0 }, r1 = { 1, 0, 0 }, r2 = { -1, 0, 0 }, eps = 1 }
end
local function cradle(changes)
  local encounter = { bodies = { ball(1), ball(0), ball(0) }, contacts = { contact(1), contact(2) }, exponent = 1 }
  for key, value in pairs(changes or {}) do encounter[key] = value end
  return encounter
end

-- A cradle by springs.
do
  local o = assert(impact.collide_together(cradle()))
  near(o.v[1].x, -0.130261695064521, 1e-14)
  near(o.v[2].x, 0.150229569434774, 1e-14)
  near(o.v[3].x, 0.980032125629747, 1e-14)
  check.truth(o.status == "ok" and o.solver == "series" and o.groups == 1 and #o.contacts == 2)
  near(o.contacts[1].impulse.x, o.v[1].x - 1, 1e-14)
  near(o.contacts[1].work.restitution, -o.contacts[1].work.compression, 1e-14)
  near(o.energy_after, o.energy_before, 1e-14)
end

-- By the other laws.
do
  near(assert(impact.collide_together(cradle { law = "moreau" })).v[1].x, -1 / 3, 1e-14)
  near(assert(impact.collide_together(cradle { law = "sequence" })).v[3].x, 1, 1e-15)
end

-- A static body, and what no motion takes apart.
do
  local wall = {}
  local held = { bodies = { ball(1), wall }, contacts = {
    { body1 = 1, body2 = 2, n = { -1, 0, 0 }, r1 = { 1, 0, 0 }, eps = 0.5 },
    { body1 = 1, body2 = 2, n = { 1, 0, 0 }, r1 = { -1, 0, 0 }, eps = 0.5 } } }
  local answer, why = impact.collide_together(held)
  check.truth(answer == nil and why:find("wedged"))
end

-- What is wrong is named.
local function refused(encounter, words)
  local good, message = pcall(impact.collide_together, encounter)
  check.truth(not good and message:find(words, 1, true), message)
end
refused(cradle { law = "sprigs" }, "sprigs")
refused(cradle { exponent = 5 }, "exponent is 5")
refused(cradle { contacts = {} }, "contacts")
do
  local bad = contact(1)
  bad.k = -1
  refused(cradle { contacts = { bad } }, "k")
  refused(cradle { contacts = { contact(3) } }, "body2")
end

check.report "together"
