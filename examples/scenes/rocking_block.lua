-- SPDX-License-Identifier: MIT
--- Housner's block (1963): tilted and let go, it rocks from edge to edge, each swing smaller and quicker, until it stands. On the line below
--- its own record lie the crosses of the closed form: quarters of swings by quadrature, r = 1 - 3/2 sin^2 alpha at each landing.
---
---   held      the two corners of an edge stick on the floor: an integrator takes the block from landing to landing
---   struck    where the other edge's corners reach the floor, all four touch: restitution 0
---   rest      what would rise less than the rest height lies; a proof says that it stays
local impact = require "impact"
local plot = require "quat.plot"
local quat = require "quat"

local gravity = 9.81
local half = { x = 0.1, z = 0.3 }
local tilt = impact.arguments { tilt = 0.25 }.tilt

--- With R = |(x, z)|, alpha = atan(x/z): theta'^2 = 3 g/(2 R) (cos(alpha - theta0) - cos(alpha - theta)). theta = theta0 - u^2.
local R, alpha = math.sqrt(half.x ^ 2 + half.z ^ 2), math.atan(half.x / half.z)

local function fall_time(theta0)
  local parts, sum, root = 4000, 0, math.sqrt(theta0)
  for i = 1, parts do
    local u = root * (i - 0.5) / parts
    sum = sum + 2 * u / math.sqrt(3 * gravity / R * math.sin(alpha - theta0 + u * u / 2) * math.sin(u * u / 2))
  end
  return sum * root / parts
end

--- Times and angles of the landings and of the turns between them.
local function closed_form(duration)
  local times, angles = { 0 }, { tilt }
  local r, theta, t, side = 1 - 1.5 * math.sin(alpha) ^ 2, tilt, fall_time(tilt), 1
  while t < duration and theta > 1e-4 do
    times[#times + 1], angles[#angles + 1] = t, 0
    theta = alpha - math.acos(math.cos(alpha) + r ^ 2 * (math.cos(alpha - theta) - math.cos(alpha)))
    side = -side
    local quarter = fall_time(theta)
    times[#times + 1], angles[#angles + 1] = t + quarter, side * theta
    t = t + 2 * quarter
  end
  return times, angles
end

local function draw(scene)
  local track, times, angles = scene:track("block"), closed_form(scene:time())
  local turned, crosses = {}, {}
  for k in ipairs(track.t) do turned[k] = -2 * math.deg(math.atan(track.qy[k], track.qw[k])) end
  for k, angle in ipairs(angles) do crosses[k] = math.deg(angle) end
  local outlines = { title = "from edge to edge", xlabel = "x, m", ylabel = "z, m", legend = "none", equal = true,
    box = { 0.08, 0.14, 0.36, 0.84 }, xrange = { -0.3, 0.25 }, yrange = { -0.02, 0.68 } }
  for _, moment in ipairs { 0, 0.23, 0.37 } do
    local k = 1
    while track.t[k] < moment * scene:time() do k = k + 1 end
    local xs, zs, q = {}, {}, { track.qw[k], track.qx[k], track.qy[k], track.qz[k] }
    for _, corner in ipairs { { 1, 1 }, { 1, -1 }, { -1, -1 }, { -1, 1 }, { 1, 1 } } do
      local v = quat.rotate(q, { corner[1] * half.x, 0, corner[2] * half.z })
      xs[#xs + 1], zs[#zs + 1] = track.x[k] + v.x, track.z[k] + v.z
    end
    outlines[#outlines + 1] = plot.line { xs, zs, color = moment == 0 and "orange" or "blue", width = 2 }
  end
  return plot.figure { title = "A block that rocks, and Housner's closed form", size = { 1100, 500 },
    plot.panel(outlines),
    plot.panel { title = "tilt", xlabel = "t, s", ylabel = "degrees", box = { 0.46, 0.14, 0.97, 0.84 },
      plot.line { track.t, turned, label = "the scene" }, plot.points { times, crosses, label = "closed form", shape = "cross" } } }
end

local s, c = math.sin(tilt), math.cos(tilt)
return impact.scene {
  name = "rocking_block",
  gravity = { 0, 0, -gravity },
  duration = 4,
  output_rate = 60,
  bodies = {
    { name = "floor", shape = impact.plane(), friction = 1 },
    {
      name = "block",
      shape = impact.box { a = half.x, b = 0.1, c = half.z },
      mass = 10,
      position = { half.x * c - half.z * s - half.x, 0, half.x * s + half.z * c },
      orientation = quat.from_axis_angle({ 0, 1, 0 }, -tilt),
      friction = 1,
      restitution = 0,
    },
  },
  plot = draw,
}
