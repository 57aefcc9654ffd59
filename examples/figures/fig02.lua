-- SPDX-License-Identifier: MIT
--- The thesis' figure 2: a vector and its mirror image in the plane through the origin with unit normal n.
---
---   v' = n v n = v - 2 (n.v) n         (the product of quaternions, of vectors as pure ones; n n = -1)
---   v and v' make the same angle alpha with the plane, on either side of it
---
--- Drawn in the plane of v and n. fig02.csv holds n, v, v' and alpha.
local quat = require "quat"
local plot = require "quat.plot"
local csv = require "quat.csv"

local tilt = math.rad(25) -- of the mirror
local n = { -math.sin(tilt), 0, math.cos(tilt) }
local v = { 1.15, 0, 1.35 }

local function product(a, b, c)
  local function pure(u) return quat.new(0, u[1], u[2], u[3]) end
  return pure(a) * pure(b) * pure(c)
end
local image = product(n, v, n)
local mirrored = { image.x, image.y, image.z }
local along = { math.cos(tilt), 0, math.sin(tilt) }
local height = n[1] * v[1] + n[3] * v[3]
local alpha = math.asin(height / math.sqrt(v[1] ^ 2 + v[3] ^ 2))

--- An arc of radius r between two angles to the x axis.
local function arc(r, from, to)
  local x, y = {}, {}
  for i = 0, 60 do
    local angle = from + (to - from) * i / 60
    x[i + 1], y[i + 1] = r * math.cos(angle), r * math.sin(angle)
  end
  return x, y
end

local up, vx, vy = { arc(0.62, tilt, tilt + alpha) }, { 0 }, { 0 }
local down = { arc(0.62, tilt - alpha, tilt) }
local drawn, why = plot.save(plot.figure {
  size = { 900, 760 },
  plot.panel {
    equal = true, frame = false, legend = "none", xrange = { -1.15, 2.15 }, yrange = { -0.95, 1.85 },
    plot.line { { -along[1], 2.1 * along[1] }, { -along[3], 2.1 * along[3] }, color = "dark", width = 3 },
    plot.line { { v[1], mirrored[1] }, { v[3], mirrored[3] }, color = "grey", width = 1.5, dash = true },
    plot.line { up[1], up[2], color = "purple", width = 2 },
    plot.line { down[1], down[2], color = "purple", width = 2, dash = true },
    plot.arrows { vx, vy, { n[1] }, { n[3] }, color = "green", width = 3 },
    plot.arrows { vx, vy, { v[1] }, { v[3] }, color = "blue", width = 3.5 },
    plot.arrows { vx, vy, { mirrored[1] }, { mirrored[3] }, color = "orange", width = 3.5 },
    plot.text { "v", at = { v[1] + 0.09, v[3] + 0.04 }, size = 17, color = "blue" },
    plot.text { "v′ = n v n", at = { mirrored[1] - 0.1, mirrored[3] - 0.14 }, size = 17, color = "orange", align = "center" },
    plot.text { "n", at = { n[1] - 0.16, n[3] + 0.05 }, size = 17, color = "green" },
    plot.text { "mirror", at = { 2.0 * along[1] - 0.05, 2.0 * along[3] - 0.16 }, size = 14, color = "dark" },
    plot.text { "α", at = { 0.74 * math.cos(tilt + alpha / 2), 0.74 * math.sin(tilt + alpha / 2) }, size = 16, color = "purple", align = "center" },
    plot.text { "α", at = { 0.74 * math.cos(tilt - alpha / 2), 0.74 * math.sin(tilt - alpha / 2) }, size = 16, color = "purple", align = "center" },
  },
}, "fig02")
if not drawn then print("fig02: " .. why) end
assert(csv.save("fig02", { "turn", "ax", "ay", "az" },
  { { 1, 2, 3 }, { n[1], v[1], mirrored[1] }, { n[2], v[2], mirrored[2] }, { n[3], v[3], mirrored[3] } }))
print(string.format("alpha = %.12f rad; |v'| - |v| = %.1g", alpha, math.sqrt(image.x ^ 2 + image.y ^ 2 + image.z ^ 2) - math.sqrt(v[1] ^ 2 + v[3] ^ 2)))
