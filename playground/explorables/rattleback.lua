-- SPDX-License-Identifier: MIT
--- The rattleback: spun one way it goes on, spun the other way it rattles, stops, and turns back.
local impact = require "impact"

local a, b, d = 2e-4, 16e-4, -(values.aside or 0.2) * 1e-4
local mean, half = (a + b) / 2, math.sqrt(((a - b) / 2) ^ 2 + d ^ 2)
local turn = d == 0 and 0 or math.atan((mean - half - a) / d)
local tilt, spin = math.rad(values.tilt or 2), values.spin or -5
local A, B, C, low = 0.2, 0.03, 0.02, 0.01
local height = math.sqrt((B * math.sin(tilt)) ^ 2 + (C * math.cos(tilt)) ^ 2)
local scene = impact.scene {
  name = "rattleback", gravity = { 0, 0, -9.81 }, duration = 6, key_tolerance = 1e-7, output_rate = 1, tolerance = 1e-10,
  bodies = {
    impact.body { name = "table", shape = impact.plane(), friction = 1, restitution = 0 },
    impact.body {
      name = "rattleback", shape = impact.ellipsoid { a = A, b = B, c = C }, shape_position = { 0, 0, low }, shape_orientation = { math.cos(turn / 2), 0, 0, -math.sin(turn / 2) },
      mass = 1, moments = { mean - half, mean + half, 17e-4 }, position = { 0, 0, height - low * math.cos(tilt) },
      orientation = { math.cos(tilt / 2) * math.cos(turn / 2), math.sin(tilt / 2) * math.cos(turn / 2), -math.sin(tilt / 2) * math.sin(turn / 2), math.cos(tilt / 2) * math.sin(turn / 2) },
      omega = { 0, 0, spin }, friction = 1, restitution = 0,
    },
  },
}
return {
  title = "The rattleback",
  formula = "J ω' + ω × Jω = r × F,   v = r × ω at the contact (it rolls),   J = [[2, d, 0], [d, 16, 0], [0, 0, 17]] · 10⁻⁴ kg m²\nd ≠ 0: the principal axes stand tan 2δ = 2d/(2 − 16) aside of the ellipsoid's, and spin feeds rattle in one direction only",
  text = "With d = 0 it never turns back. The other way round it goes on – and so does −5 with the sign of d changed.",
  parameters = { { name = "spin", label = "spin at first, rad/s", low = -8, high = 8, value = spin }, { name = "aside", label = "−d, 10⁻⁴ kg m²", low = -0.5, high = 0.5, value = values.aside or 0.2 }, { name = "tilt", label = "tilt at first, °", low = 0.2, high = 5, value = math.deg(tilt) } },
  scene = scene,
  address = "#t=0&near=1.7",
  after = function(run)
    local track = run:track("rattleback", 200)
    local back, most = nil, 0
    for i = 2, #track.t do
      if not back and track.wz[i] * track.wz[i - 1] < 0 and track.t[i] > 0.1 then back = track.t[i] end
      if back then most = math.abs(track.wz[i]) > math.abs(most) and track.wz[i] or most end
    end
    return string.format("principal axes aside by %.4f°\n%s", math.deg(turn), back and string.format("it turns back at t = %.3f s, and comes to %.4f rad/s", back, most) or "it does not turn back within 6 s")
  end,
}
