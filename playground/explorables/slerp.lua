-- SPDX-License-Identifier: MIT
--- Three ways from one orientation to another: slerp, straight lines of quaternions (normalised), and Euler angles by their straight lines.
local quat = require "quat"
local plot = require "quat.plot"

local angle, tilt, part = values.angle or 150, values.tilt or 60, values.part or 0.25
local a = quat.from_euler("ZYX", math.rad(-40), math.rad(20), math.rad(10))
local axis = { math.sin(math.rad(tilt)), 0, math.cos(math.rad(tilt)) }
local b = quat.from_axis_angle(axis, math.rad(angle)) * a
local a1, a2, a3 = a:to_euler "ZYX"
local b1, b2, b3 = b:to_euler "ZYX"
local function along(from, to, t)
  local d = to - from
  return from + t * (d - 2 * math.pi * math.floor((d + math.pi) / (2 * math.pi))) -- the shorter way round
end
local ways = {
  { name = "slerp", color = "blue", at = function(t) return quat.slerp(a, b, t) end },
  { name = "lerp, normalised", color = "orange", at = function(t) return quat.nlerp(a, b, t) end },
  { name = "Euler angles", color = "red", at = function(t) return quat.from_euler("ZYX", along(a1, b1, t), along(a2, b2, t), along(a3, b3, t)) end },
}
local count = 200
-- A picture of S^3 with the unit ball's three great circles.
local function picture(title)
  local panel = { title = title, equal = true, legend = "none", frame = false, view = { 66, 32 } }
  for axis = 1, 3 do
    local circle = { {}, {}, {}, color = "grey", width = 1 }
    for i = 0, 96 do
      circle[axis][i + 1], circle[axis % 3 + 1][i + 1], circle[(axis + 1) % 3 + 1][i + 1] = 0, math.cos(i * math.pi / 48), math.sin(i * math.pi / 48)
    end
    panel[axis] = plot.line(circle)
  end
  return panel
end
local ball, flat = picture "(q₁, q₂, q₃) in the unit ball; dots at equal times", picture "stereographic: great circles stay circles"
local speed = { title = "angular speed along the way", xlabel = "t", ylabel = "rad per unit of t", legend = "top right", xrange = { 0, 1 }, at = { 1, 2, 2, 1 } }
local said = {}
for _, way in ipairs(ways) do
  local x, y, z, u, v, w, t, rate = {}, {}, {}, {}, {}, {}, {}, {}
  local before, length, fastest, slowest = way.at(0), 0, 0, math.huge
  for i = 0, count do
    local q = way.at(i / count)
    if q.w * before.w + q.x * before.x + q.y * before.y + q.z * before.z < 0 then q = -q end
    x[i + 1], y[i + 1], z[i + 1] = q.x, q.y, q.z
    local s = 1 / (1 + q.w)
    u[i + 1], v[i + 1], w[i + 1] = s * q.x, s * q.y, s * q.z
    if i > 0 then length = length + 2 * quat.distance(before, q) end -- of the turn: twice the arc on S^3
    local middle, h = math.max(1e-5, math.min(1 - 1e-5, i / count)), 1e-5
    t[i + 1], rate[i + 1] = i / count, quat.distance(way.at(middle - h), way.at(middle + h)) / h
    fastest, slowest = math.max(fastest, rate[i + 1]), math.min(slowest, rate[i + 1])
    before = q
  end
  if way.name:sub(1, 4) ~= "lerp" then -- whose way is slerp's
    ball[#ball + 1] = plot.line { x, y, z, color = way.color, tube = 0.015, label = way.name }
    flat[#flat + 1] = plot.line { u, v, w, color = way.color, tube = 0.015 }
  end
  local dots = { {}, {}, {}, color = way.color, size = 1.1 }
  for i = 1, count + 1, 20 do
    local n = #dots[1] + 1
    dots[1][n], dots[2][n], dots[3][n] = x[i], y[i], z[i]
  end
  ball[#ball + 1] = plot.points(dots)
  speed[#speed + 1] = plot.line { t, rate, color = way.color, width = 2.4, label = way.name }
  local q = way.at(part)
  ball[#ball + 1] = plot.points { { q.x }, { q.y }, { q.z }, color = way.color, size = 2 }
  said[#said + 1] = string.format("%-18s %9.6f rad long, fastest : slowest = %.4f", way.name, length, fastest / slowest)
end
speed[#speed + 1] = plot.mark { x = part, color = "grey" }
return {
  title = "Slerp on S³",
  formula = "slerp(a, b, t) = (a sin((1−t)θ) + b sin(tθ)) / sin θ,   cos θ = a·b\nthe great circle at one speed: the turn 2θ, the least there is",
  text = "Lines of quaternions go the same way, but faster in the middle: 1 : cos²(θ/2). Euler angles go elsewhere, and farther.",
  parameters = {
    { name = "angle", label = "angle of the turn, °", low = 10, high = 175, value = angle }, { name = "tilt", label = "axis from the vertical, °", low = 0, high = 90, value = tilt },
    { name = "part", label = "t", low = 0, high = 1, value = part },
  },
  number = table.concat(said, "\n") .. string.format("\nby the formulas: 2θ = %.6f rad; lerp's 1/cos²(θ/2) = %.4f", math.rad(angle), 1 / math.cos(math.rad(angle) / 4) ^ 2),
  figure = plot.figure { size = { 1400, 900 }, grid = { 2, 2 }, plot.panel(ball), plot.panel(flat), plot.panel(speed) },
}
