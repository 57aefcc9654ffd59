-- SPDX-License-Identifier: MIT
--- Gimbal lock: drag the middle angle to 90 degrees, and three angles are two.
local quat = require "quat"
local plot = require "quat.plot"

local alpha, beta, gamma = values.alpha or 30, values.beta or 60, values.gamma or 20
local rad = math.rad
local turn = { quat.from_euler("XYZ", rad(alpha), 0, 0), quat.from_euler("XYZ", rad(alpha), 0, 0), quat.from_euler("XYZ", rad(alpha), rad(beta), 0) }
local body = quat.from_euler("XYZ", rad(alpha), rad(beta), rad(gamma))
local axes, colors, names = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }, { "red", "green", "blue" }, { "α", "β", "γ" }
local panel = { box = { 0, 0, 0.62, 1 }, equal = true, legend = "none", frame = false, view = { 68, 28 }, xrange = { -1.4, 1.4 }, yrange = { -1.4, 1.4 }, zrange = { -1.4, 1.4 }, title = "the rings, and the lines they turn about" }
local world = {}
for i = 1, 3 do
  local size, u, v, x, y, z = 1.15 - 0.2 * i, axes[i % 3 + 1], axes[(i + 1) % 3 + 1], {}, {}, {}
  for n = 0, 96 do
    local s = n * math.pi / 48
    local p = turn[i]:rotate { size * (math.cos(s) * u[1] + math.sin(s) * v[1]), size * (math.cos(s) * u[2] + math.sin(s) * v[2]), size * (math.cos(s) * u[3] + math.sin(s) * v[3]) }
    x[n + 1], y[n + 1], z[n + 1] = p.x, p.y, p.z
  end
  panel[#panel + 1] = plot.line { x, y, z, color = colors[i], tube = 0.04 }
  local d = turn[i]:rotate(axes[i])
  world[i] = d
  panel[#panel + 1] = plot.arrows { { 0 }, { 0 }, { 0 }, { 1.25 * d.x }, { 1.25 * d.y }, { 1.25 * d.z }, color = colors[i], width = 2.6 }
  panel[#panel + 1] = plot.text { names[i], at = { 1.4 * d.x, 1.4 * d.y, 1.4 * d.z + (i == 1 and -0.1 or 0.06) }, color = colors[i], size = 14 }
end
local nose = body:rotate { 0.45, 0, 0 }
panel[#panel + 1] = plot.arrows { { 0 }, { 0 }, { 0 }, { nose.x }, { nose.y }, { nose.z }, color = "dark", width = 4 }
local a, b, c = world[1], world[2], world[3]
local determinant = a.x * (b.y * c.z - b.z * c.y) - a.y * (b.x * c.z - b.z * c.x) + a.z * (b.x * c.y - b.y * c.x)
-- The lost line: across the two that are left.
local lost = { b.y * a.z - b.z * a.y, b.z * a.x - b.x * a.z, b.x * a.y - b.y * a.x }
panel[#panel + 1] = plot.line { { -1.3 * lost[1], 1.3 * lost[1] }, { -1.3 * lost[2], 1.3 * lost[2] }, { -1.3 * lost[3], 1.3 * lost[3] }, color = "dark", width = 2, dash = true }
local t, rates = {}, {}
for i = 0, 170 do t[i + 1], rates[i + 1] = i, math.abs(1 / math.cos(rad(i))) end
return {
  title = "Gimbal lock",
  formula = "R = Rx(α) Ry(β) Rz(γ);   det(axes) = cos β\nto turn about the dashed line at rate 1, γ' = 1/cos β: at β = 90° no angles can",
  text = "α's ring stands still, β's turns with it, γ's with both. At β = 90° the lines of α and γ are one.",
  parameters = { { name = "alpha", label = "α, °", low = -180, high = 180, value = alpha }, { name = "beta", label = "β, °", low = 0, high = 90, value = beta }, { name = "gamma", label = "γ, °", low = -180, high = 180, value = gamma } },
  number = string.format("determinant of the axes: %.12f\ncos β:                    %.12f\nγ' for a turn about the dashed line: %s", determinant, math.cos(rad(beta)), math.abs(determinant) < 1e-12 and "none is fast enough" or string.format("%.3f", 1 / determinant)),
  figure = plot.figure { size = { 1400, 760 }, plot.panel(panel),
    plot.panel { title = "γ' for a turn about the dashed line at rate 1", xlabel = "β, °", legend = "none", box = { 0.69, 0.13, 0.97, 0.9 }, xrange = { 0, 90 }, yrange = { 0, 20 }, plot.line { t, rates, color = "blue", width = 2.4 }, plot.mark { x = beta, color = "dark" } } },
}
