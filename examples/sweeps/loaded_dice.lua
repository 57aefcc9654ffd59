-- SPDX-License-Identifier: MIT
--- Which side of a loaded die comes up: impact sweep loaded_dice.lua -j 2
---
--- The die is a cube with rounded edges, of mass M, with a small weight w M inside, close under its lower side, the one: the
--- centre of mass is w h / (1 + w) below the middle. Each run throws it with an orientation, a spin and a speed of its own.
---
--- A throw is over when the die can no longer turn onto another side: once its energy is below its lowest pass, the least height, along the
--- edges, of the highest point on the way across. From there on only friction is at work.
local impact = require "impact"
local plot = require "quat.plot"

local given = impact.arguments { throws = 200, rounding = 0.001, friction = 0.3, restitution = 0.6, height = 0.1 }
local a, mass, gravity = 0.008, 0.005, 9.80665
local shape = impact.box { a = a, b = a, c = a, rounding = given.rounding }
local depth = 0.8 * a -- of the weight, under the middle

--- How far below the middle the centre of mass is.
local function lowering(weight) return weight * depth / (1 + weight) end

--- The height of the centre of mass when the body's direction n, a unit vector, points down.
local function height(n, weight)
  return (shape:support(n)) + n[3] * lowering(weight)
end

--- The lowest pass between two sides: over tilts along each edge the least of the highest on the way across it.
local passes = {}
local function lowest_pass(weight)
  if passes[weight] then return passes[weight] end
  local lowest = math.huge
  for along = 1, 3 do
    for quarter = 0, 3 do
      for tilt = -20, 20 do
        local t, top = math.rad(tilt), 0
        for across = 0, 90 do
          local angle, n = math.rad(across + 90 * quarter), {}
          n[along], n[along % 3 + 1], n[(along + 1) % 3 + 1] = math.sin(t), math.cos(t) * math.cos(angle), math.cos(t) * math.sin(angle)
          top = math.max(top, height(n, weight))
        end
        lowest = math.min(lowest, top)
      end
    end
  end
  passes[weight] = lowest
  return lowest
end

--- A rotation at random, evenly over all (Shoemake 1992).
local function random_rotation()
  local u, v, w = math.random(), 2 * math.pi * math.random(), 2 * math.pi * math.random()
  local r, s = math.sqrt(1 - u), math.sqrt(u)
  return { r * math.sin(v), r * math.cos(v), s * math.sin(w), s * math.cos(w) }
end

local sides = { { "x", 3, 4 }, { "y", 2, 5 }, { "z", 6, 1 } } -- the axis, the side up where it points up, and where it points down

local function side_up(state)
  local side, steepest
  for _, axis in ipairs(sides) do
    local direction = { 0, 0, 0 }
    direction[axis[1] == "x" and 1 or axis[1] == "y" and 2 or 3] = 1
    local up = state.orientation:rotate(direction)[3]
    if not steepest or math.abs(up) > steepest then steepest, side = math.abs(up), up > 0 and axis[2] or axis[3] end
  end
  return side
end

return impact.sweep {
  parameters = { weight = impact.grid(0, 1, 3) },
  runs = given.throws,
  scene = function(p)
    local i, low = shape.inertia, lowering(p.weight)
    local level = mass * low ^ 2 + p.weight * mass * (depth - low) ^ 2
    local body = impact.body {
      name = "die", shape = shape, shape_position = { 0, 0, low }, mass = (1 + p.weight) * mass,
      moments = { mass * i.x + level, mass * i.y + level, mass * i.z }, position = { 0, 0, given.height }, orientation = random_rotation(),
      velocity = { math.random(), 0, 0 }, omega = { 40 * math.random() - 20, 40 * math.random() - 20, 40 * math.random() - 20 },
      friction = given.friction, restitution = given.restitution,
    }
    local floor = impact.body { name = "floor", static = true, shape = impact.plane(), friction = 1, restitution = 1 }
    return { duration = 10, output_rate = 0, tolerance = 1e-9, gravity = { 0, 0, -gravity }, bodies = { body, floor } }
  end,
  on_event = function(event, p) return event.energy_after > (1 + p.weight) * mass * gravity * lowest_pass(p.weight) end,
  reduce = function(run)
    return { side = side_up(run.scene:state "die"), bounces = run.events.impact, t = run.t }
  end,
  plot = function(t)
    local counts, weights = {}, {}
    for i, weight in ipairs(t.weight) do
      if not counts[weight] then counts[weight], weights[#weights + 1] = { all = 0 }, weight end
      local count, side = counts[weight], t.side[i]
      if side == side then count.all, count[side] = count.all + 1, (count[side] or 0) + 1 end
    end
    local panel = { xlabel = "weight under the one, over the die's own", ylabel = "share of throws", yrange = { 0, 1 }, legend = "top left" }
    local kinds = { { "six", { 6 }, "blue" }, { "two to five, each", { 2, 3, 4, 5 }, "green" }, { "one", { 1 }, "red" } }
    for _, kind in ipairs(kinds) do
      local share, bars_x, bars_y = {}, {}, {}
      for k, weight in ipairs(weights) do
        local sum, all = 0, counts[weight].all * #kind[2]
        for _, side in ipairs(kind[2]) do sum = sum + (counts[weight][side] or 0) end
        share[k] = sum / all
        local error = math.sqrt(share[k] * (1 - share[k]) / all) -- of a binomial
        for _, y in ipairs { share[k] - error, share[k] + error, 0 / 0 } do bars_x[#bars_x + 1], bars_y[#bars_y + 1] = weight, y end
      end
      panel[#panel + 1] = plot.line { bars_x, bars_y, color = kind[3], width = 1 }
      panel[#panel + 1] = plot.line { weights, share, label = kind[1], color = kind[3], width = 2 }
    end
    return plot.figure { title = "A loaded die: sides that come up, and their standard errors", size = { 1000, 700 }, plot.panel(panel) }
  end,
}
