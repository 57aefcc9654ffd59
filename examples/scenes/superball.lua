-- SPDX-License-Identifier: MIT
--- Garwin's superball in a corridor: thrown without spin between a floor and a ceiling, it comes back.
---
--- Its contact gives along the surface as it does across it, and takes just as long to spring back: eta^2 = 7/2 for a solid sphere. So
--- the velocity of the contact point is reversed whole, u_t -> -u_t as u_n -> -u_n, and nothing is lost. With b = r w (b > 0: forwards
--- on the floor)
---
---   floor      v' = (3 v + 4 b)/7,   b' = (10 v - 3 b)/7
---   ceiling    the same with -b
---
--- a rotation of (v, b sqrt(2/5)) by theta, cos theta = 3/7, from wall to wall: v_n = v_0 cos(n theta). After three v is -0.971 v_0. On
--- one wall alone, two impacts are none: spin and velocity alternate.
local impact = require "impact"
local plot = require "quat.plot"

local r, m, height, v0, vz = 0.025, 0.05, 1, 1, 3
local theta = math.acos(3 / 7)

local function draw(scene)
  local track = scene:track("ball")
  local n, v, b, steps, wave, turned = {}, {}, {}, {}, {}, {}
  local state = scene:events()
  local count = 0
  local function note(i)
    n[#n + 1], v[#v + 1] = count, track.vx[i]
    b[#b + 1] = (count % 2 == 0 and 1 or -1) * r * track.wy[i]
  end
  note(1)
  for i = 2, #track.t do
    if track.t[i] == track.t[i - 1] and track.vz[i] ~= track.vz[i - 1] then
      count = count + 1
      note(i)
    end
  end
  local thrown, later = impact.split(track, state[4].t) -- there and back; on from the fourth impact
  for i = 0, 200 do
    steps[i + 1] = #state * i / 200
    wave[i + 1] = v0 * math.cos(steps[i + 1] * theta)
    turned[i + 1] = -v0 * math.sqrt(5 / 2) * math.sin(steps[i + 1] * theta)
  end
  return plot.figure {
    title = "Garwin's superball between a floor and a ceiling",
    size = { 1300, 560 },
    grid = { 2, 1 },
    plot.panel {
      title = "the centre's path", xlabel = "x, m", ylabel = "z, m", legend = "none", yrange = { 0, height },
      plot.line { later.x, later.z, color = "grey" },
      plot.line { thrown.x, thrown.z, color = "blue", width = 2.2 },
      plot.points { { track.x[1] }, { track.z[1] }, color = "dark", size = 1.4 },
    },
    plot.panel {
      title = "after n impacts", xlabel = "n", ylabel = "m/s", legend = "top right", yrange = { -2, 2.5 },
      plot.line { steps, wave, color = "grey" },
      plot.line { steps, turned, color = "grey" },
      plot.points { n, v, color = "blue", label = "v" },
      plot.points { n, b, color = "orange", label = "r ω, towards the next wall" },
    },
  }
end

return impact.scene {
  name = "superball",
  gravity = { 0, 0, 0 },
  duration = 2.5,
  output_rate = 24,
  law = "stronge",
  compliance = 7 / 2,
  bodies = {
    impact.body { name = "floor", shape = impact.plane(), friction = 1, restitution = 1 },
    impact.body { name = "ceiling", shape = impact.plane(), position = { 0, 0, height }, normal = { 0, 0, -1 }, friction = 1, restitution = 1 },
    impact.body {
      name = "ball",
      shape = impact.sphere(r),
      mass = m,
      position = { 0, 0, height / 2 },
      velocity = { v0, 0, -vz },
      friction = 1,
      restitution = 1,
    },
  },
  plot = draw,
}
