-- SPDX-License-Identifier: MIT
--- One impact's hodograph: how the tangential velocity moves while the normal impulse grows, under friction to drag.
local impact = require "impact"
local plot = require "quat.plot"

local mu, restitution, angle, coupling = values.mu or 0.5, values.restitution or 0.5, values.angle or 40, values.coupling or 0.9
local a, b, m = 2.5, 1, 2
local c, d = coupling, 0.9 * coupling
local start = { math.cos(math.rad(angle)), math.sin(math.rad(angle)), -1 }
local function flow(u, finish) return assert(impact.flow { a = a, b = b, c = c, d = d, m = m, mu = mu, u = u, p_end = finish, count = 241 }) end

-- Compression ends where u_z = 0 for the last time; then restitution times its impulse (Poisson).
local curve = flow(start, 6)
local compressed
for i = 2, #curve.p do if curve.uz[i - 1] < 0 and curve.uz[i] >= 0 then compressed = curve.p[i - 1] + (curve.p[i] - curve.p[i - 1]) * -curve.uz[i - 1] / (curve.uz[i] - curve.uz[i - 1]) end end
local finish = compressed and compressed * (1 + restitution) or 6
local path = flow(start, finish)
local stuck
for i = 1, #path.p do if not stuck and math.sqrt(path.ux[i] ^ 2 + path.uy[i] ^ 2) < 1e-9 then stuck = path.p[i] end end
local last = #path.p
local plane = { title = "tangential velocity", xlabel = "u_x, m/s", ylabel = "u_y, m/s", equal = true, legend = "none", xrange = { -1.25, 1.25 }, yrange = { -1.25, 1.25 } }
local directions = path.directions
for k = 1, 16 do
  local at = 2 * math.pi * (k - 0.5) / 16
  local other = flow({ math.cos(at), math.sin(at), -1 }, 4)
  local x, y = {}, {}
  for i = 1, #other.p do
    if math.abs(other.ux[i]) > 1.25 or math.abs(other.uy[i]) > 1.25 then break end
    x[i], y[i] = other.ux[i], other.uy[i]
  end
  plane[#plane + 1] = plot.line { x, y, color = "grey", width = 1 }
end
for _, direction in ipairs(directions) do
  plane[#plane + 1] = plot.line { { 0, 1.2 * math.cos(direction.theta) }, { 0, 1.2 * math.sin(direction.theta) }, color = "red", width = 1.6, dash = direction.pull > 0 }
end
plane[#plane + 1] = plot.line { path.ux, path.uy, color = "blue", width = 3.5 }
plane[#plane + 1] = plot.points { { path.ux[1] }, { path.uy[1] }, color = "blue", size = 1.6 }
plane[#plane + 1] = plot.points { { path.ux[last] }, { path.uy[last] }, color = "blue", size = 1.6, shape = "square" }
local normal = { title = "velocities over the normal impulse", xlabel = "p, N s", ylabel = "m/s", legend = "bottom right", xrange = { 0, finish } }
for i, part in ipairs { { "ux", "red" }, { "uy", "green" }, { "uz", "blue" } } do normal[i] = plot.line { path.p, path[part[1]], color = part[2], label = "u_" .. part[1]:sub(2), width = 2.4 } end
if compressed then normal[#normal + 1] = plot.mark { x = compressed, color = "grey", label = "compressed" } end
-- What friction must give to hold: |M_tt^-1 M_tz|.
local needed = math.sqrt((c / a) ^ 2 + (d / b) ^ 2)
return {
  title = "One impact's hodograph",
  formula = "du/dp = M (−μ u_t/|u_t|, 1),   M = [[a, 0, c], [0, b, d], [c, d, m]]\nat u_t = 0 friction holds where |M_tt⁻¹ M_tz| = √(c²/a² + d²/b²) ≤ μ; else it slides on in one direction",
  text = "From the dot to the square: one impact. Grey: starts all round. Red: directions that do not turn, dashed where curves part from them.",
  parameters = {
    { name = "mu", label = "friction μ", low = 0.02, high = 1.5, value = mu }, { name = "restitution", label = "restitution ε (Poisson)", low = 0, high = 1, value = restitution },
    { name = "angle", label = "direction at first, °", low = 0, high = 360, value = angle }, { name = "coupling", label = "coupling c (d = 0.9 c)", low = 0, high = 1, value = coupling },
  },
  number = string.format("friction needed to hold: %.6f, there is %.3f: %s\ncompressed at p = %s N s; %s", needed, mu, mu >= needed and "it sticks when it stops" or "slip reverses: on in one direction",
    compressed and string.format("%.6f", compressed) or "–", stuck and string.format("stopped by p = %.4f N s", stuck) or string.format("slides to the end, at %.6f m/s", math.sqrt(path.ux[last] ^ 2 + path.uy[last] ^ 2))),
  figure = plot.figure { size = { 1400, 720 }, grid = { 2, 1 }, plot.panel(plane), plot.panel(normal) },
}
