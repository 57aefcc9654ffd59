-- SPDX-License-Identifier: MIT
--- A bowling ball, thrown without spin, slides, then rolls (Coriolis 1835).
---
---   sliding    v = v0 - mu g t,  r w = (5/2) mu g t
---   rolling    from t = 2 v0/(7 mu g) on, at v = r w = (5/7) v0, however strong the friction
---
--- A seventh of m v0^2 is lost on the way. Slip sticks below the larger of rest_speed/100 and 100 tolerance, here 1e-12 m/s:
--- it begins to roll 2e-13 s early.
local impact = require "impact"
local plot = require "quat.plot"

local v0, mu, g, r = 8, 0.12, 9.81, 0.108
local t0 = 2 * v0 / (7 * mu * g)

local function draw(scene)
  local track = scene:track "ball"
  local rim, off = {}, { t = {}, v = {} }
  for i = 1, #track.t do
    rim[i] = r * track.wy[i]
    local t = track.t[i]
    local v = t < t0 and v0 - mu * g * t or 5 / 7 * v0
    off.t[#off.t + 1], off.v[#off.v + 1] = t, math.max(math.abs(track.vx[i] - v), 1e-17)
  end
  return plot.figure {
    title = "A bowling ball slides, then rolls",
    subtitle = string.format("v₀ = %g m/s, friction %g: rolls from 2v₀/(7µg) = %.4f s on", v0, mu, t0),
    size = { 1300, 560 },
    grid = { 2, 1 },
    plot.panel {
      title = "velocity of the centre, and of the rim about it", xlabel = "time, s", ylabel = "m/s", legend = "bottom right", yrange = { 0, 9 },
      plot.line { track.t, track.vx, color = "blue", label = "v" },
      plot.line { track.t, rim, color = "purple", label = "r ω" },
      plot.mark { x = t0, color = "red", label = "2v₀/(7µg)" },
      plot.line { { 0, track.t[#track.t] }, { 5 / 7 * v0, 5 / 7 * v0 }, color = "grey", dash = true, label = "5/7 v₀" },
    },
    plot.panel {
      title = "v less the closed form's (1e-17: the same)", xlabel = "time, s", ylabel = "m/s", ylog = true, legend = "none", yrange = { 1e-17, 1e-9 },
      plot.points { off.t, off.v, color = "blue", size = 0.7 },
    },
  }
end

return impact.scene {
  name = "bowling_ball",
  gravity = { 0, 0, -g },
  duration = 4,
  output_rate = 24,
  tolerance = 1e-14,
  rest_speed = 1e-10,
  bodies = {
    impact.body { name = "lane", shape = impact.plane(), friction = 1 },
    impact.body { name = "ball", shape = impact.sphere(r), mass = 6.8, position = { 0, 0, r }, velocity = { v0, 0, 0 }, friction = mu },
  },
  plot = draw,
}
