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
  local newton = assert(impact.collide_together(cradle { law = "moreau", restitution = "newton" }))
  for i, v in ipairs { -1 / 3, 2 / 3, 2 / 3 } do near(newton.v[i].x, v, 1e-14) end
end

-- A box that falls flat on the floor comes up flat by every law, each time by eps: h = (1 - r) eps^2n, and it rests after
-- sqrt(2 h/g) (1 + 2 eps/(1 - eps)).
for _, law in ipairs { "poisson", "newton", "stronge" } do
  local h, eps, g = 0.8, 0.5, 9.81
  local scene = impact.scene { name = "box", gravity = { 0, 0, -g }, duration = 3, law = law, rules = { restitution = "minimum" }, bodies = {
    impact.body { name = "floor", shape = impact.plane(), friction = 0.4, restitution = eps },
    impact.body { name = "box", shape = impact.box { a = 0.1, b = 0.15, c = 0.2 }, mass = 24, position = { 0, 0, 0.2 + h },
      orientation = { 0.8, 0, 0, 0.6 }, friction = 0.4, restitution = eps } } }
  assert(scene:run())
  local time, box = scene:time(), scene:state "box"
  near(time, math.sqrt(2 * h / g) * (1 + 2 * eps / (1 - eps)), law == "stronge" and 1e-4 or 1e-5)
  near(box.position.x, 0, 1e-9)
  near(box.position.z, 0.2, 1e-9)
  near(box.orientation.w, 0.8, 1e-9)
  near(scene:energy().sliding_loss, 0, 1e-9)
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
