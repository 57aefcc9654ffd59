-- SPDX-License-Identifier: MIT
--- Bodies on their corners and rims, held exactly: a block that rocks against quadratures, what rolls against its closed forms, a disc
--- that goes round on its rim against the steady motion of its equations, a cube on a corner against what a top conserves.
local impact = require "impact"
local quat = require "quat"
local check = require "check"

local G = 9.81

local plane = { name = "floor", shape = impact.plane(), friction = 1 }
local slab = { name = "floor", static = true, shape = impact.box { a = 2, b = 1, c = .3, rounding = .01 }, position = { .3, .1, -.3 }, friction = 1 }

local function run(shape, body, more)
  body.name, body.shape, body.mass, body.friction = "body", shape, body.mass or 1, body.friction or 1
  body.restitution = body.restitution or 0
  local def = { gravity = { 0, 0, -G }, duration = 1,
    bodies = { impact.body(more and more.under or plane), impact.body(body) } }
  local handlers = more and more.handlers or {}
  for key, value in pairs(more or {}) do if key ~= "handlers" and key ~= "under" then def[key] = value end end
  local scene = impact.scene(def)
  check.truth(scene:run(handlers), "it runs")
  return scene
end

local function off_account(energy)
  return math.abs(energy.start + energy.force_work - energy.damping_loss - energy.sliding_loss - energy.impact_loss
    - energy.kinetic - energy.potential) / (math.abs(energy.start) + energy.kinetic)
end

--- The integral of f from 0 to 1: Gauss's four places in each of many parts.
local function integral(f)
  local parts, sum = 500, 0
  local places = { .8611363115940526, .3399810435848563 }
  local weights = { .3478548451374538, .6521451548625461 }
  for i = 0, parts - 1 do
    for k = 1, 2 do
      for side = -1, 1, 2 do sum = sum + weights[k] * f((i + .5 + side * places[k] / 2) / parts) end
    end
  end
  return sum / (2 * parts)
end

--- Housner (1963): a block of half width a and half height h rocks from edge to edge. Of R = |(a, h)|, alpha = atan(a/h):
--- theta'^2 = 3 g/(2 R) (cos(alpha - theta0) - cos(alpha - theta)), and each landing leaves 1 - 3/2 sin^2 alpha of theta'. With
--- theta = theta0 - u^2 the time to fall has no root at its ends.
local function rock(a, h, tilt, friction, under)
  local R, alpha = math.sqrt(a * a + h * h), math.atan(a / h)
  local function fall(from)
    local root = math.sqrt(from)
    return integral(function(x)
      local u = root * x
      local drop = 2 * math.sin(alpha - from + u * u / 2) * math.sin(u * u / 2)
      return 2 * u * root / math.sqrt(1.5 * G / R * drop)
    end)
  end
  local expected, t, theta, kept = {}, fall(tilt), tilt, 1 - 1.5 * math.sin(alpha) ^ 2
  for n = 1, 12 do
    expected[n] = t
    theta = alpha - math.acos(math.cos(alpha) + kept ^ 2 * (math.cos(alpha - theta) - math.cos(alpha)))
    t = t + 2 * fall(theta)
  end
  local s, c, landings = math.sin(tilt), math.cos(tilt), {}
  local last, factors = nil, 0
  local scene = run(impact.box { a = a, b = .1, c = h },
    { position = { a * c - h * s, 0, a * s + h * c }, orientation = quat.from_axis_angle({ 0, 1, 0 }, -tilt), friction = friction },
    { under = under, duration = 8, handlers = { on_event = function(event)
      if event.event == "impact" and event.t > (landings[#landings] or -1) + 1e-6 then landings[#landings + 1] = event.t end
    end, on_sample = function(row)
      local turned = last and last.t == row.t and row.omega.y / last.omega.y
      if turned and math.abs(turned - 1) > 1e-6 and math.abs(row.omega.y) > 1e-3 then
        check.close(turned, kept, 1e-12)
        factors = factors + 1
      end
      last = row
    end } })
  check.truth(factors >= 12, "landings whose factor was seen")
  for n = 1, 12 do check.close(landings[n], expected[n], 4e-11) end
  check.equal(scene:usage().pile_steps, 0)
  check.truth(scene:time() < 8, "it comes to rest")
  check.close(scene:state("body").position.z, h, 1e-12)
end
rock(.1, .2, .1, 1)
rock(.1, .2, .46, 1)
rock(.1, .4, .2, 1)
rock(.02, .06, .05, 3)
rock(.1, .2, .1, 1, slab)

-- Over the border of a static box it falls as it must: what hangs over is not held as if the face went on.
local over = run(impact.box { a = .1, b = .1, c = .05 }, { position = { 2.36, .1, .2 }, orientation = quat.from_axis_angle({ 0, 1, 0 }, .3) },
  { under = slab, duration = 2 })
check.truth(over:state("body").position.z < -1, "a box beside the table falls")
check.truth(off_account(over:energy()) < 1e-12, "its account")

-- A cylinder and a capsule on their sides roll down a slope of .3: a = g sin/(1 + I/(m r^2)).
local slope = .3
local down = { G * math.sin(slope), 0, -G * math.cos(slope) }
local lying = quat.from_axis_angle({ 1, 0, 0 }, math.pi / 2)
local r, c = .05, .1
for _, round in ipairs { impact.cylinder { radius = r, half_height = c }, impact.capsule { radius = r, half_height = c } } do
  local scene = run(round, { position = { 0, 0, r }, orientation = lying }, { gravity = down })
  local inertia = round.inertia
  local a = G * math.sin(slope) / (1 + inertia.z / r ^ 2)
  local state = scene:state("body")
  check.close(state.position.x, a / 2, 1e-12)
  check.close(state.velocity.x, a, 1e-12)
  check.close(state.position.z, r, 1e-14)
  check.equal(scene:usage().pile_steps, 0)
  check.truth(off_account(scene:energy()) < 1e-13, "what rolls keeps its account")
end

-- A disc goes round on its rim, its centre at rest. Its axis leans by th and goes round at W; it turns about the line from its centre to the
-- contact, and W z x L = r x m g z: W^2 sin th/rho (I1 rho cos th - I3 c sin th) = m g (rho cos th - c sin th).
for _, case in ipairs { { .01, .001, .3 }, { .05, .02, .8 }, { 1, .01, 1.2 } } do
  local rho, half, lean = table.unpack(case)
  local disc = impact.cylinder { radius = rho, half_height = half }
  local inertia, s, co = disc.inertia, math.sin(lean), math.cos(lean)
  local W = math.sqrt(G * (rho * co - half * s) / (s / rho * (inertia.x * rho * co - inertia.z * half * s)))
  local turn = -W * s / rho
  -- e1 down the disc, e3 its axis
  local e1, e3 = { co, 0, -s }, { s, 0, co }
  local scene = run(disc, { position = { 0, 0, rho * s + half * co }, orientation = quat.from_axis_angle({ 0, 1, 0 }, lean),
    omega = { turn * (rho * e1[1] - half * e3[1]), 0, turn * (rho * e1[3] - half * e3[3]) } }, { duration = 20 / W })
  local state = scene:state("body")
  local axis = quat.rotate(state.orientation, { 0, 0, 1 })
  for _, x in ipairs { state.position.x / rho, state.position.y / rho, state.position.z / rho - s - half / rho * co } do
    check.close(x, 0, 1e-9)
  end
  check.close(math.sin(math.atan(axis.y, axis.x) - 20), 0, 1e-8)
  check.close(axis.z, co, 1e-9)
  check.equal(scene:usage().pile_steps, 0)
end

-- A cube that turns on its corner, which sticks, is a symmetric top: about the corner the angular momentum along its diagonal and along
-- the vertical stay, and so does the energy. On ice its centre has no horizontal speed to gain, and turns as fast about the vertical.
local function top(friction, spin, duration)
  local half, lean = .05, .4
  local diagonal = 1 / math.sqrt(3)
  local function cross(a, b) return { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1] } end
  local from, to = { diagonal, diagonal, diagonal }, { math.sin(lean), 0, math.cos(lean) }
  local up = quat.from_axis_angle(cross(from, to), math.acos(diagonal * (to[1] + to[3])))
  local reach = half * math.sqrt(3)
  local centre = { reach * math.sin(lean), 0, reach * math.cos(lean) }
  local omega = { spin * math.sin(lean), .5, spin * math.cos(lean) }
  local v = friction > 0 and cross(omega, centre) or { .2, -.1, cross(omega, centre)[3] }
  local inertia = 2 / 3 * half ^ 2
  local told = {}
  local scene = run(impact.box { a = half, b = half, c = half }, { position = centre, orientation = up, omega = omega, velocity = v, friction = friction },
    { duration = duration, handlers = { on_sample = function(b)
      local d = quat.rotate(b.orientation, { diagonal, diagonal, diagonal })
      local arm = { reach * d.x, reach * d.y, reach * d.z }
      local w, u = { b.omega.x, b.omega.y, b.omega.z }, { b.velocity.x, b.velocity.y, b.velocity.z }
      local l = friction > 0 and cross(arm, u) or { 0, 0, 0 }
      told[#told + 1] = { (l[1] + inertia * w[1]) * d.x + (l[2] + inertia * w[2]) * d.y + (l[3] + inertia * w[3]) * d.z, l[3] + inertia * w[3],
        friction == 0 and u[1] or b.position.z - arm[3] }
    end } })
  check.truth(#told > 10, "samples")
  for _, now in ipairs(told) do
    check.close(now[1], told[1][1], 2e-12)
    check.close(now[2], told[1][2], 2e-12)
    check.close(now[3], told[1][3], 1e-10)
  end
  check.equal(scene:usage().pile_steps, 0)
  check.truth(off_account(scene:energy()) < 1e-10, "the account of a top")
end
top(10, 300, 1)
top(0, 300, 1)

-- In parts it moves by the same bits as whole; what was saved on its way goes on as what is loaded from it.
local function thrown()
  return impact.scene { gravity = { 0, 0, -G }, duration = 1.2, bodies = {
    impact.body { name = "floor", shape = impact.plane(), friction = .4, restitution = .3 },
    impact.body { name = "die", shape = impact.box { a = .01, b = .01, c = .01, rounding = .001 }, mass = .01, position = { 0, 0, .1 },
      orientation = quat.from_axis_angle({ 1, .4, .2 }, 1), velocity = { .5, .1, 0 }, omega = { 20, -12, 7 }, friction = 1, restitution = 1 } } }
end
local function same(one, other)
  local a, b = one:state("die"), other:state("die")
  for _, key in ipairs { "x", "y", "z" } do
    check.equal(b.position[key], a.position[key])
    check.equal(b.orientation[key], a.orientation[key])
  end
end
local whole, parts, saved = thrown(), thrown(), thrown()
whole:run()
check.truth(whole:usage().integrator_steps > 0, "a die turns on its corners")
for k = 1, 40 do parts:run_to(k * .03) end
same(whole, parts)
for k = 1, 12 do
  saved:run_to(k * .03)
  local loaded = thrown()
  loaded:load(saved:save())
  loaded:run_to(k * .03 + .02)
  saved:run_to(k * .03 + .02)
  same(saved, loaded)
end

-- Found: a corner that a landing had left a rounding below the floor sank through it while another was held.
local function lowest(state, half)
  local low = math.huge
  for i = 0, 7 do
    local corner = quat.rotate(state.orientation, { i & 1 == 0 and -half[1] or half[1], i & 2 == 0 and -half[2] or half[2], i & 4 == 0 and -half[3] or half[3] })
    low = math.min(low, state.position.z + corner.z)
  end
  return low
end
local half = { 0.044935707942764962, 0.066402352553048119, 0.068687897596071704 }
local two = impact.scene { duration = 1, gravity = { 0, 0, -G }, bodies = {
  impact.body { name = "floor", shape = impact.plane(), friction = 1, restitution = 1 },
  impact.body { name = "b1", shape = impact.box { a = half[1], b = half[2], c = half[3] }, position = { 0.030850618998568669, 0.0089983467895203562, 0.55 },
    orientation = { -0.89061279348321909, -0.41498875707389749, 0.10721664169237677, -0.4530155096113837 },
    velocity = { -0.19554544036216193, 0.24877565364284582, -0.60083751522628082 }, omega = { -4.9739389765021613, 1.4201218923069643, 1.9074262016014476 },
    friction = 1.1354805916708437, restitution = 0.0065671345756083133, density = 1563.0152258385231 },
  impact.body { name = "b2", shape = impact.box { a = 0.094695564302154367, b = 0.094695564302154367, c = 0.094695564302154367 },
    position = { 0.074427991404750732, 0.009074375218257269, 1 }, orientation = { -0.19420149393420072, -0.26806840677891119, -0.45378151817715584, 0.50789792545632628 },
    velocity = { -0.59889325641730906, 0.45071588800485451, -0.23473268123094237 }, omega = { 0.41848774335750782, -3.3407161783875594, -6.0604025158313259 },
    friction = 0.9921786618839008, restitution = 0.82483100947927845, density = 464.23166908372406 } } }
for k = 1, 20 do
  two:run_to(k / 20)
  check.truth(lowest(two:state("b1"), half) > -1e-6, "no corner is below the floor")
end

-- Found: a box whose corners bounced in turn, higher by a little than what counts as touching, for ever.
local chatter = impact.scene { duration = 1.5, gravity = { 0, 0, -G }, bodies = {
  impact.body { name = "slab", static = true, shape = impact.box { a = 1, b = 1, c = .1 }, position = { 0, 0, -.1 },
    orientation = { 0.99992064327385322, 0, -0.012597902793865847, 0 }, friction = 1, restitution = 1 },
  impact.body { name = "box", shape = impact.box { a = 0.068393504242466194, b = 0.098278547021206294, c = 0.10171641429609947 },
    position = { -0.048251848249402401, -0.056488434557405751, 0.55 }, orientation = { -0.56742974819521153, -0.881905088794948, 0.91016856797721823, 0.10589466725834895 },
    velocity = { -0.58399914775809325, -0.4248307357041361, -0.77559162932759995 }, omega = { -1.0285960675157906, -3.6576325801621081, -7.6676867522685583 },
    friction = 0.31582921681846748, restitution = 0.75454972609276005, density = 363.16709038070758 } } }
chatter:run()
check.truth(chatter:usage().events.impact < 1000 and chatter:time() < 1.5, "corners that bounce in turn come to rest")

-- A ball rolls down a face of a static box by 5/7 g sin a; one that is fast enough, v^2 > g r, flies off the border where it comes to it.
local ramp = quat.from_axis_angle({ 0, 1, 0 }, .2)
local along, up = quat.rotate(ramp, { 1, 0, 0 }), quat.rotate(ramp, { 0, 0, 1 })
local function on_ramp(s) return { s * along.x + .07 * up.x, 0, s * along.z + .07 * up.z } end
local marble = impact.scene { gravity = { 0, 0, -G }, duration = 1, bodies = {
  impact.body { name = "ramp", static = true, shape = impact.box { a = .5, b = .2, c = .05 }, orientation = ramp, friction = 1 },
  impact.body { name = "marble", shape = impact.sphere(.02), mass = .1, friction = .5, position = on_ramp(-.4) } } }
marble:run()
local wanted, there = on_ramp(-.4 + 5 / 14 * G * math.sin(.2)), marble:state("marble").position
check.close(there.x, wanted[1], 1e-13)
check.close(there.z, wanted[3], 1e-13)
local r, v = .01, 1
local off = impact.scene { gravity = { 0, 0, -G }, duration = .5, bodies = {
  impact.body { name = "table", static = true, shape = impact.box { a = .3, b = .3, c = .1 }, position = { 0, 0, -.1 }, friction = 1 },
  impact.body { name = "ball", shape = impact.sphere(r), mass = 1, friction = 1, position = { 0, 0, r }, velocity = { v, 0, 0 }, omega = { 0, v / r, 0 } } } }
off:run()
check.close(off:state("ball").position.z, r - G / 2 * (.5 - .3 / v) ^ 2, 1e-12)
check.close(off:state("ball").position.x, .5 * v, 1e-12)

-- A cylinder turns about the lowest place of its rim, and comes down flat: the place across lands, with no restitution. With friction the body
-- then turns about that place (Housner: L about it is kept); without, beside a second plane that held the rim's lowest place too, the
-- impulse is along the plane's normal through it alone: w' = w (1 - 2 r^2/(J/m + r^2)). The rim changed over to the other side there,
-- without an impact, and energy came and went.
local function comes_down(lean, sides, friction, spin, turned)
  local r, h, m = .1, .2, 2
  local place = quat.vec3 { r, 0, -h }
  local J, foot = m * (3 * r ^ 2 + 4 * h ^ 2) / 12, m * (r ^ 2 + h ^ 2)
  local about = quat.from_axis_angle({ 0, 0, 1 }, turned)
  local tilted, flat = quat.from_axis_angle({ 0, 1, 0 }, lean + .05), quat.from_axis_angle({ 0, 1, 0 }, lean)
  local arm = tilted:rotate(place)
  local omega = quat.vec3 { 0, spin, 0 }
  local bodies = {}
  for k, normal in ipairs(sides) do
    bodies[k] = impact.body { name = "side " .. k, shape = impact.plane(), normal = about:rotate(normal), friction = friction, restitution = 0 }
  end
  bodies[#bodies + 1] = impact.body { name = "cylinder", shape = impact.cylinder { radius = r, half_height = h }, mass = m, position = about:rotate(-arm),
    orientation = about * tilted, omega = about:rotate(omega), velocity = about:rotate(arm:cross(omega)), friction = friction, restitution = 0 }
  local scene = impact.scene { gravity = { 0, 0, -G }, duration = 1, law = "newton", output_rate = 0, bodies = bodies }
  repeat local event = scene:step(.2) until not event or event.event == "impact"
  local fallen = flat:rotate(place).z - arm.z
  local before = -math.sqrt(spin ^ 2 + 2 * m * G * fallen / (J + foot))
  local kept = friction > 0 and (J + m * (h ^ 2 - r ^ 2)) / (J + foot) or 1 - 2 * r ^ 2 / (J / m + r ^ 2)
  -- turned, the last digits of its orientation are what tells where a rim that is all but flat stands
  check.close(scene:state("cylinder").omega:dot(about:rotate { 0, 1, 0 }), kept * before, turned == 0 and 1e-12 or 1e-6)
  scene:run_to(.3)
  check.close(off_account(scene:energy()), 0, 1e-9)
end

for _, spin in ipairs { -1, -2 } do
  for _, turned in ipairs { 0, 1 } do
    comes_down(0, { { 0, 0, 1 } }, 1, spin, turned)
    comes_down(.4, { { math.sin(.4), 0, math.cos(.4) }, { -math.sin(.8), 0, math.cos(.8) } }, 0, spin, turned)
  end
end

-- Found: boxes that fall on one held on its corner bounced by nanometres for as long as the reactions that press it were forgotten at each impact.
local dropped = { impact.body { name = "floor", shape = impact.plane(), friction = 1, restitution = 1 } }
for i = 1, 5 do
  dropped[i + 1] = impact.body { name = "box " .. i, shape = impact.box { a = .1, b = .1, c = .05 }, mass = 1,
    position = { .03 * (i % 3), .02 * (i % 2), .07 + .12 * (i - 1) }, friction = .5, restitution = .3 }
end
local five = impact.scene { gravity = { 0, 0, -G }, duration = .5, bodies = dropped, rules = { friction = "minimum", restitution = "minimum" } }
five:run()
check.truth(five:usage().events.impact < 300, "what a held body is pressed by ends the bounces on it")
