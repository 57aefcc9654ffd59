-- SPDX-License-Identifier: MIT
--- The thesis' figure 3: two reflections, in planes that meet at the angle theta/2, are the rotation by theta about the planes' common line.
---
---   v' = n v n,  v'' = m v' m = q v q*,   q = m n = -(cos(theta/2) + sin(theta/2) e),   e = n x m / |n x m|
---
--- Drawn across that line, which is the y axis here. fig03.csv holds v, v', v'' and q v q*.
local quat = require "quat"
local plot = require "quat.plot"
local csv = require "quat.csv"

local half, first = math.rad(40), math.rad(48) -- theta/2, and where the first mirror stands
local function normal(angle) return { -math.sin(angle), 0, math.cos(angle) } end
local n, m = normal(first), normal(first + half)
local v = { 1.6 * math.cos(math.rad(28)), 0, 1.6 * math.sin(math.rad(28)) }

local function pure(u) return quat.new(0, u[1], u[2], u[3]) end
local function reflect(u, mirror)
  local image = pure(mirror) * pure(u) * pure(mirror)
  return { image.x, image.y, image.z }
end
local once = reflect(v, n)
local twice = reflect(once, m)
local turned = (pure(m) * pure(n)):rotate(v)

local function arc(r, from, to)
  local x, y = {}, {}
  for i = 0, 80 do
    local angle = from + (to - from) * i / 80
    x[i + 1], y[i + 1] = r * math.cos(angle), r * math.sin(angle)
  end
  return x, y
end
local function mirror(angle, color)
  local c, s = math.cos(angle), math.sin(angle)
  return plot.line { { -0.45 * c, 2 * c }, { -0.45 * s, 2 * s }, color = color, width = 3 }
end
local function at(u) return math.atan(u[3], u[1]) end
local function label(text, angle, r, color)
  return plot.text { text, at = { r * math.cos(angle), r * math.sin(angle) }, size = 16, color = color, align = "center" }
end

local between, theta = { arc(0.5, first, first + half) }, { arc(1.05, at(v), at(v) + 2 * half) }
local zero = { 0 }
local drawn, why = plot.save(plot.figure {
  size = { 900, 820 },
  plot.panel {
    equal = true, frame = false, legend = "none", xrange = { -1.35, 2 }, yrange = { -0.65, 2.3 },
    mirror(first, "grey"), mirror(first + half, "dark"),
    plot.line { { v[1], once[1] }, { v[3], once[3] }, color = "grey", width = 1.5, dash = true },
    plot.line { { once[1], twice[1] }, { once[3], twice[3] }, color = "grey", width = 1.5, dash = true },
    plot.line { between[1], between[2], color = "green", width = 2 },
    plot.line { theta[1], theta[2], color = "purple", width = 2.5 },
    plot.arrows { zero, zero, { v[1] }, { v[3] }, color = "blue", width = 3.5 },
    plot.arrows { zero, zero, { once[1] }, { once[3] }, color = "grey", width = 3 },
    plot.arrows { zero, zero, { twice[1] }, { twice[3] }, color = "orange", width = 3.5 },
    label("v", at(v), 1.72, "blue"), label("v′", at(once), 1.74, "grey"), label("v″ = q v q*", at(twice), 1.8, "orange"),
    label("θ/2", first + 0.3 * half, 0.64, "green"), label("θ", at(v) + 0.62 * half, 1.17, "purple"),
    label("first mirror", first, 2.12, "grey"), label("second mirror", first + half, 2.12, "dark"),
  },
}, "fig03")
if not drawn then print("fig03: " .. why) end
local columns = { { 1, 2, 3, 4 }, {}, {}, {} }
for i, u in ipairs { v, once, twice, { turned.x, turned.y, turned.z } } do
  for c = 1, 3 do columns[c + 1][i] = u[c] end
end
assert(csv.save("fig03", { "turn", "ax", "ay", "az" }, columns))
print(string.format("theta = %.12f rad; |v'' - q v q*| = %.1g", 2 * half,
  math.sqrt((twice[1] - turned.x) ^ 2 + (twice[2] - turned.y) ^ 2 + (twice[3] - turned.z) ^ 2)))
