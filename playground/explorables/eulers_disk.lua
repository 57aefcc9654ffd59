-- SPDX-License-Identifier: MIT
--- Euler's disk: the flatter it lies, the faster its contact goes round.
local impact = require "impact"
local quat = require "quat"

local g, m, a, alpha, half = 9.81, 0.4, 0.0375, math.rad(values.lean or 14), (values.thickness or 4) / 2000
local shape = impact.superquadric { a = a, b = a, c = half, r = 2, s = 2, t = 100 }
local c, s = math.cos(alpha), math.sin(alpha)
local _, low = shape:support { 0, -s, -c }
local y, z = c * low[2] - s * low[3], s * low[2] + c * low[3]
local spin, j = y / (-s * z - c * y), shape.inertia
local ly, lz = j.x * s * c - j.z * (c + spin) * s, j.x * s * s + j.z * (c + spin) * c
local W = math.sqrt(g * y / -ly)
local turns = 4
local scene = impact.scene {
  name = "eulers_disk", gravity = { 0, 0, -g }, duration = turns * 2 * math.pi / W, output_rate = 0,
  bodies = {
    impact.body { name = "glass", shape = impact.plane(), friction = 1, restitution = 0 },
    impact.body { name = "disk", shape = shape, mass = m, position = { 0, 0, -z }, orientation = { math.cos(alpha / 2), math.sin(alpha / 2), 0, 0 },
      omega = { 0, -W * spin * s, W * (1 + spin * c) }, friction = 0.5, restitution = 0 },
  },
}
return {
  title = "Euler's disk",
  formula = "r × m g z = Ω z × L(ω),   ω = Ω (z + s e),   ω × r = 0\nthin and nearly flat:  Ω² = 4 g/(a α)",
  text = "The disk rolls round on its edge, its centre at rest; what is heard is Ω, what is seen turning on its face is far slower.",
  parameters = { { name = "lean", label = "leaning α, °", low = 3, high = 45, value = math.deg(alpha) }, { name = "thickness", label = "thickness, mm", low = 1, high = 10, value = 2000 * half } },
  scene = scene,
  address = "#t=0&near=2",
  after = function(run)
    local state = run:state "disk"
    local e = quat.rotate(state.orientation, { 0, 0, 1 })
    local off = math.sqrt((e[1]) ^ 2 + (e[2] + s) ^ 2 + (e[3] - c) ^ 2)
    return string.format("Ω = %.9f rad/s;  √(4g/(aα)) = %.4f\nafter %d rounds the axis is off the steady solution by %.1e\nits face turns at Ω(1 + s cos α) = %.4f rad/s", W, math.sqrt(4 * g / (a * alpha)), turns, off, W * (1 + spin * c))
  end,
}
