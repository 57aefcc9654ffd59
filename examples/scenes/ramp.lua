-- SPDX-License-Identifier: MIT
--- Three boxes on a slope of 22 degrees: one has grip and stays, one slides by g (sin - mu cos) t^2/2, a tall one has grip and topples,
--- since tan 22 is more than its half width over its half height. The slope is a plane, and gravity leans.
---
---   at rest    proved at t = 0 from the reactions at its four corners
---   slides     a face without turning, under a constant load: in closed form
---   topples    over its lower edge, held at two corners by the integrator; lands on its side, and slides there in closed form
local impact = require "impact"
local plot = require "quat.plot"
local quat = require "quat"

local gravity = 9.81
local slope = math.rad(impact.arguments { slope = 22 }.slope)
local boxes = {
  { name = "stays", x = 0.1, z = 0.06, at = 0, friction = 0.6, color = "blue" },
  { name = "slides", x = 0.1, z = 0.06, at = 1.5, friction = 0.2, color = "orange" },
  { name = "topples", x = 0.06, z = 0.2, at = 0.6, friction = 0.7, color = "green" },
}

local bodies = { impact.body { name = "slope", shape = impact.plane(), friction = 1, restitution = 0 } }
for i, box in ipairs(boxes) do
  bodies[i + 1] = impact.body {
    name = box.name,
    shape = impact.box { a = box.x, b = 0.1, c = box.z },
    mass = 2,
    position = { box.at, 0, box.z },
    friction = box.friction,
    restitution = 0,
  }
end

--- The box as the horizontal is level again.
local function outline(box, x, z, q, faint)
  local xs, zs = {}, {}
  local s, c = math.sin(slope), math.cos(slope)
  for _, corner in ipairs { { 1, 1 }, { 1, -1 }, { -1, -1 }, { -1, 1 }, { 1, 1 } } do
    local v = quat.rotate(q, { corner[1] * box.x, 0, corner[2] * box.z })
    local px, pz = x + v.x, z + v.z
    xs[#xs + 1], zs[#zs + 1] = c * px + s * pz, c * pz - s * px
  end
  return plot.line { xs, zs, color = box.color, width = faint and 1 or 2.5, opacity = faint and 0.4 or 1 }
end

local function draw(scene)
  local length = 2.8
  local side = { title = "every 0.15 s", xlabel = "m", ylabel = "m", legend = "none", equal = true, box = { 0.08, 0.14, 0.58, 0.84 },
    plot.line { { -0.3 * math.cos(slope), length * math.cos(slope) }, { 0.3 * math.sin(slope), -length * math.sin(slope) }, color = "black" } }
  local slid, closed = {}, {}
  for _, box in ipairs(boxes) do
    local track, next_time = scene:track(box.name), 0
    for k, t in ipairs(track.t) do
      if t >= next_time - 1e-9 then
        side[#side + 1] = outline(box, track.x[k], track.z[k], { track.qw[k], track.qx[k], track.qy[k], track.qz[k] }, k < #track.t)
        next_time = next_time + 0.15
      end
    end
    if box.name == "slides" then
      local a = gravity * (math.sin(slope) - box.friction * math.cos(slope))
      for k, t in ipairs(track.t) do slid[k], closed[k] = track.x[k] - box.at, a * t * t / 2 end
      side.times = track.t
    end
  end
  local times = side.times
  side.times = nil
  return plot.figure { title = ("Three boxes on a slope of %g degrees"):format(math.deg(slope)), size = { 1100, 500 },
    plot.panel(side),
    plot.panel { title = "the one that slides", xlabel = "t, s", ylabel = "way, m", box = { 0.68, 0.14, 0.97, 0.84 },
      plot.line { times, slid, label = "the scene" }, plot.points { times, closed, label = "closed form", shape = "cross" } } }
end

return impact.scene {
  name = "ramp",
  gravity = { gravity * math.sin(slope), 0, -gravity * math.cos(slope) },
  duration = 1,
  output_rate = 40,
  bodies = bodies,
  plot = draw,
}
