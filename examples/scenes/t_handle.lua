-- SPDX-License-Identifier: MIT
--- A T-handle, spun about its middle axis, turns over again and again (Dzhanibekov's effect, Poinsot's motion).
---
---   I_i w_i' = (I_j - I_k) w_j w_k,   I = (1, 2, 3),   w(0) = (0.01, 10, 0)
---   P = 4 K(m)/rate,   one turn-over each P/2
---   1 - m = (I3 - I1)(2 E I2 - L^2)/((I2 - I1)(2 E I3 - L^2)),   rate^2 = (I2 - I1)(2 E I3 - L^2)/(I1 I2 I3)
---
--- which is Jacobi's solution where 2 E I2 > L^2: the momentum circles the axis of the least moment. The orientation is computed for
--- each instant from the start, with no steps between: the thousandth turn-over is where the first one says.
local impact = require "impact"
local quat = require "quat"
local plot = require "quat.plot"

local I, w = { 1, 2, 3 }, { 0.01, 10, 0 }

--- P/2.
local function turn_over()
  local twice_E, L2 = 0, 0
  for k = 1, 3 do twice_E, L2 = twice_E + I[k] * w[k] ^ 2, L2 + (I[k] * w[k]) ^ 2 end
  local high, middle = 0, 0 -- 2 E I3 - L^2 and 2 E I2 - L^2, without cancellation
  for k = 1, 3 do
    high = high + I[k] * w[k] ^ 2 * (I[3] - I[k])
    middle = middle + I[k] * w[k] ^ 2 * (I[2] - I[k])
  end
  local rate = math.sqrt((I[2] - I[1]) * high / (I[1] * I[2] * I[3]))
  local a, b = 1, math.sqrt((I[3] - I[1]) * middle / ((I[2] - I[1]) * high)) -- their mean is pi/(2 K)
  while math.abs(a - b) > 1e-15 do a, b = (a + b) / 2, math.sqrt(a * b) end
  return math.pi / a / rate
end

local function definition(duration, draw)
  return {
    name = "t_handle",
    gravity = { 0, 0, 0 },
    duration = duration,
    output_rate = 24,
    bodies = {
      impact.body { name = "handle", shape = impact.ellipsoid { a = 0.3, b = 0.2, c = 0.1 }, mass = 1, moments = I, omega = w },
    },
    plot = draw,
  }
end

--- Components of w along the body's axes, over 4 turn-overs from the given number of them on; time counts from there.
local function watch(first)
  local half = turn_over()
  local scene = impact.scene(definition((first + 4.1) * half))
  local columns = { t = {}, {}, {}, {} }
  for i = 0, 400 do
    local t = first * half + 4 * half * i / 400
    assert(scene:run_to(t))
    local state = scene:state "handle"
    local inside = quat.rotate(quat.conj(state.orientation), state.omega)
    columns.t[i + 1] = t - first * half
    columns[1][i + 1], columns[2][i + 1], columns[3][i + 1] = inside[1], inside[2], inside[3]
  end
  return columns
end

local function draw()
  local start, late = watch(0), watch(1000)
  local names, colors = { "ω₁", "ω₂", "ω₃" }, { "orange", "blue", "green" }
  local body = { title = "angular velocity in the body's axes, the first turn-overs", xlabel = "time, s", ylabel = "rad/s", legend = "top right", yrange = { -12, 16 } }
  local both = { title = "dots: the same after a thousand turn-overs", xlabel = "time since then, s", ylabel = "rad/s", legend = "top right", yrange = { -12, 16 } }
  for k = 1, 3 do
    body[k] = plot.line { start.t, start[k], color = colors[k], label = names[k] }
    both[k] = plot.line { start.t, start[k], color = "grey" }
  end
  for k = 1, 3 do
    local t, value = {}, {}
    for i = 1, #late.t, 5 do t[#t + 1], value[#value + 1] = late.t[i], late[k][i] end
    both[3 + k] = plot.points { t, value, color = colors[k], label = names[k], size = 0.7 }
  end
  return plot.figure {
    title = "A T-handle spun about its middle axis",
    size = { 1300, 560 },
    grid = { 2, 1 },
    plot.panel(body),
    plot.panel(both),
  }
end

return impact.scene(definition(4 * turn_over(), draw))
