-- SPDX-License-Identifier: MIT
--- Pictures of a recorded scene: `local portrait = require "impact.portrait"`; for a definition's plot.
local impact = require "impact"
local plot = require "quat.plot"
require "impact.core".layer()

local portrait = {}

--- |v| and |w| along a track.
local function speed(track)
  local v = {}
  for i = 1, #track.t do v[i] = math.sqrt(track.vx[i] ^ 2 + track.vy[i] ^ 2 + track.vz[i] ^ 2) end
  return v
end

local function spin(track)
  local w = {}
  for i = 1, #track.t do w[i] = math.sqrt(track.wx[i] ^ 2 + track.wy[i] ^ 2 + track.wz[i] ^ 2) end
  return w
end

--- When the other body was met first, or nil.
local function meeting(scene, body, other)
  local event = other and scene:first("impact", body, other)
  return event and event.t
end

--- The curves of a track before and after the meeting, in one colour: solid, then dashed.
local function two_parts(items, before, after, x, y, color, label)
  items[#items + 1] = plot.line { before[x], before[y], color = color, label = label, width = 2.2 }
  if #after.t > 0 then items[#items + 1] = plot.line { after[x], after[y], color = color, dash = true, width = 2.2 } end
end

local function with_marks(panel, t, other)
  if t then panel[#panel + 1] = plot.mark { x = t, label = other, color = "red" } end
  return plot.panel(panel)
end

--- Position, speed and energy over time, for the right-hand side of a picture.
local function over_time(scene, body, other, axes, track, before, after, t)
  local boxes = { { 0.56, 0.69, 0.975, 0.885 }, { 0.56, 0.385, 0.975, 0.58 }, { 0.56, 0.08, 0.975, 0.275 } }
  local position = { title = "position of the centre", ylabel = "m", legend = "bottom right", box = boxes[1] }
  two_parts(position, before, after, "t", "x", "blue", "x")
  if axes == 3 then two_parts(position, before, after, "t", "y", "green", "y") end
  two_parts(position, before, after, "t", "z", "orange", "z")
  local moving = { title = "speed of the centre, and of the turning at the rim", ylabel = "m/s", legend = "top right", box = boxes[2] }
  local rim, radius = spin(track), scene:radius(body)
  for i = 1, #rim do rim[i] = rim[i] * radius end
  moving[1] = plot.line { track.t, speed(track), color = "blue", label = "|v|" }
  moving[2] = plot.line { track.t, rim, color = "purple", label = "r |ω|" }
  local energies = scene:energies(body, track)
  local energy = { title = "energy", xlabel = "time, s", ylabel = "J", legend = "top right", box = boxes[3] }
  energy[1] = plot.line { track.t, energies.total, color = "dark", label = "all" }
  energy[2] = plot.line { track.t, energies.translation, color = "blue", label = "moving" }
  energy[3] = plot.line { track.t, energies.rotation, color = "purple", label = "turning" }
  energy[4] = plot.line { track.t, energies.potential, color = "orange", label = "height" }
  return with_marks(position, t, other), with_marks(moving, t), with_marks(energy, t)
end

--- A body's recorded run, smooth; `level` is the stack level to blame for a body without one.
local function run_of(scene, body, level)
  local track = scene:track(body, 500)
  if #track.t == 0 then error("portrait: body '" .. body .. "' does not move: there is nothing to draw", level + 1) end
  return track
end

--- A body's recorded run, whole and before and after it meets the other for the first time, at t (nil: it never does).
local function parts(scene, body, other)
  local track = run_of(scene, body, 3)
  local t = meeting(scene, body, other)
  local before, after = impact.split(track, t or math.huge)
  return track, before, after, t
end

--- The figure's head: its title, and what solid and dashed mean when there is a meeting.
local function headed(figure, title, t, other)
  figure.title = title
  figure.subtitle = t and "solid before the " .. other .. ", dashed after" or nil
  figure.size = { 1400, 1000 }
  return plot.figure(figure)
end

--- A point of a track's curve: its first or last row, to be seen.
local function spot(track, row, names, color, label)
  local place = { color = color, size = 1.6, label = label }
  for i, name in ipairs(names) do place[i] = { track[name][row] } end
  return plot.points(place)
end

--- A planar motion's orientation: (q0, q2) on the unit circle, q over time, and beside them position, speed and energy;
--- solid before `body` meets `other`, dashed after. Without `other`, all solid.
---@param scene impact.scene  recorded
---@param body string
---@param other? string
---@param title? string
---@return plot.figure
function portrait.planar(scene, body, other, title)
  local track, before, after, t = parts(scene, body, other)
  local circle = { {}, {} }
  for i = 0, 360 do
    circle[1][i + 1], circle[2][i + 1] = math.cos(math.rad(i)), math.sin(math.rad(i))
  end
  -- The way goes out and back on one and the same circle: the way back is drawn a little inside.
  local inner = { qw = {}, qy = {} }
  for i = 1, #after.t do inner.qw[i], inner.qy[i] = 0.94 * after.qw[i], 0.94 * after.qy[i] end
  local whole = false
  for i = 1, #track.t do whole = whole or track.qw[i] < 0 or track.qy[i] < -0.05 end
  local axis = { whole and -1.1 or -0.1, 1.1 } -- the whole circle, or the quarter that holds the motion
  local arc = plot.panel {
    title = "orientation on the circle q₀² + q₂² = 1",
    xlabel = "q₀",
    ylabel = "q₂",
    equal = true,
    legend = whole and "center" or "bottom left",
    xrange = axis,
    yrange = axis,
    box = { 0.06, 0.405, 0.403, 0.885 },
    plot.line { circle[1], circle[2], color = "grey", width = 1 },
    plot.line { before.qw, before.qy, color = "blue", width = 3, label = t and "before the " .. other },
    plot.line { inner.qw, inner.qy, color = "blue", width = 2.5, dash = true, label = t and "after it, drawn inside" },
    spot(before, 1, { "qw", "qy" }, "green", "start"),
    spot(before, #before.t, { "qw", "qy" }, "red", t and "the " .. other or "end"),
  }
  local q = { title = "orientation over time", xlabel = "time, s", legend = "center right", box = { 0.06, 0.08, 0.47, 0.275 } }
  two_parts(q, before, after, "t", "qw", "blue", "q₀")
  two_parts(q, before, after, "t", "qy", "orange", "q₂")
  local position, moving, energy = over_time(scene, body, other, 2, track, before, after, t)
  return headed({ arc, with_marks(q, t, other), position, moving, energy }, title or "The motion of " .. body, t, other)
end

--- A motion's orientation in space: the curve (q1, q2, q3), q over time, and beside them position, speed and energy.
---@param scene impact.scene  recorded
---@param body string
---@param other? string
---@param title? string
---@return plot.figure
function portrait.space(scene, body, other, title)
  local track, before, after, t = parts(scene, body, other)
  local curve = plot.panel {
    title = "the orientation's curve (q₁, q₂, q₃)",
    xlabel = "q₁",
    ylabel = "q₂",
    zlabel = "q₃",
    legend = "top left",
    view = { 62, 38 },
    zoom = 1.45,
    equal = true,
    box = { 0.03, 0.36, 0.5, 0.9 },
    plot.line { before.qx, before.qy, before.qz, color = "blue", width = 2.5, label = t and "before the " .. other },
    plot.line { after.qx, after.qy, after.qz, color = "blue", dash = true, width = 1.8, label = t and "after it" },
    spot(before, 1, { "qx", "qy", "qz" }, "green", "start"),
    spot(before, #before.t, { "qx", "qy", "qz" }, "red", t and "the " .. other or "end"),
  }
  local q = { title = "orientation over time", xlabel = "time, s", legend = "row", box = { 0.06, 0.08, 0.47, 0.275 },
    yrange = { -1, 1.5 } }
  two_parts(q, before, after, "t", "qw", "dark", "q₀")
  two_parts(q, before, after, "t", "qx", "blue", "q₁")
  two_parts(q, before, after, "t", "qy", "orange", "q₂")
  two_parts(q, before, after, "t", "qz", "green", "q₃")
  local position, moving, energy = over_time(scene, body, other, 3, track, before, after, t)
  return headed({ curve, with_marks(q, t, other), position, moving, energy }, title or "The motion of " .. body, t, other)
end

--- The outline of a ball of radius r about (x, y), appended to a list of columns with the pen lifted before it.
local function outline(columns, x, y, r)
  local n = #columns[1]
  columns[1][n + 1], columns[2][n + 1] = 0 / 0, 0 / 0
  for i = 0, 48 do
    columns[1][n + 2 + i] = x + r * math.cos(math.pi * i / 24)
    columns[2][n + 2 + i] = y + r * math.sin(math.pi * i / 24)
  end
end

--- The paths of two bodies in the plane of two axes, with the bodies drawn at the start, where they meet, and at the end.
local function seen(description, scene, bodies, tracks, t, x, y)
  for i, body in ipairs(bodies) do
    local before, after = impact.split(tracks[i], t or math.huge)
    local color = i == 1 and "blue" or "orange"
    description[#description + 1] = plot.line { before[x], before[y], color = color, width = 2, label = body }
    if #after.t > 0 then description[#description + 1] = plot.line { after[x], after[y], color = color, width = 2, dash = true } end
    local rings, r, last, all = { {}, {} }, scene:radius(body), #before.t, #tracks[i].t
    outline(rings, before[x][1], before[y][1], r)
    outline(rings, before[x][last], before[y][last], r)
    outline(rings, tracks[i][x][all], tracks[i][y][all], r)
    description[#description + 1] = plot.line { rings[1], rings[2], color = color, width = 1.2 }
  end
  return plot.panel(description)
end

--- Two bodies that meet: their paths from the side and from above, their orientations, speeds, and the energy.
---@param scene impact.scene  recorded
---@param left string
---@param right string
---@param title? string
---@return plot.figure
function portrait.pair(scene, left, right, title)
  local bodies = { left, right }
  local tracks = { run_of(scene, left, 2), run_of(scene, right, 2) }
  local t = meeting(scene, left, right)
  local side = seen({ title = "from the side", xlabel = "x, m", ylabel = "z, m", equal = true, legend = "top center",
    box = { 0.09, 0.64, 0.47, 0.89 } }, scene, bodies, tracks, t, "x", "z")
  local above = seen({ title = "from above", xlabel = "x, m", ylabel = "y, m", equal = true, legend = "none",
    box = { 0.09, 0.08, 0.47, 0.53 } }, scene, bodies, tracks, t, "x", "y")
  local q = { title = "orientation: " .. left, legend = "row", box = { 0.59, 0.7, 0.98, 0.9 }, yrange = { -1, 1.5 } }
  local before, after = impact.split(tracks[1], t or math.huge)
  for i, name in ipairs { "qw", "qx", "qy", "qz" } do
    two_parts(q, before, after, "t", name, ({ "dark", "blue", "orange", "green" })[i], ({ "q₀", "q₁", "q₂", "q₃" })[i])
  end
  local turning = { title = "angular velocity: " .. left, ylabel = "rad/s", legend = "bottom right",
    box = { 0.59, 0.39, 0.98, 0.59 } }
  for i, name in ipairs { "wx", "wy", "wz" } do
    two_parts(turning, before, after, "t", name, ({ "blue", "orange", "green" })[i], ({ "ω₁", "ω₂", "ω₃" })[i])
  end
  local energy = { title = "energy of both", xlabel = "time, s", ylabel = "J", legend = "top right", box = { 0.59, 0.08, 0.98, 0.28 } }
  local sums = {}
  for i, body in ipairs(bodies) do
    for part, column in pairs(scene:energies(body, tracks[i])) do
      if i == 1 then
        sums[part] = column
      else
        local there = impact.along(tracks[2].t, column, tracks[1].t)
        for row = 1, #sums[part] do sums[part][row] = sums[part][row] + there[row] end
      end
    end
  end
  for i, part in ipairs { "total", "translation", "rotation", "potential" } do
    energy[i] = plot.line { tracks[1].t, sums[part], color = ({ "dark", "blue", "purple", "orange" })[i],
      label = ({ "all", "moving", "turning", "height" })[i] }
  end
  return plot.figure {
    title = title or left .. " and " .. right,
    subtitle = t and "solid before they meet, dashed after" or nil,
    size = { 1400, 1000 },
    side, above, with_marks(q, t, "meeting"), with_marks(turning, t), with_marks(energy, t),
  }
end

-- ---- scenes seen in space ----

--- v turned by the quaternion q.
local function turn(q, x, y, z)
  local tx, ty, tz = 2 * (q.y * z - q.z * y), 2 * (q.z * x - q.x * z), 2 * (q.x * y - q.y * x)
  return x + q.w * tx + q.y * tz - q.z * ty, y + q.w * ty + q.z * tx - q.x * tz, z + q.w * tz + q.x * ty - q.y * tx
end

--- A surface of rows i = 0..m, j = 0..n whose points f(i/m, j/n) stand in a body's frame; in the world by its state.
local function placed(state, m, n, f)
  local x, y, z = {}, {}, {}
  for i = 0, m do
    x[i + 1], y[i + 1], z[i + 1] = {}, {}, {}
    for j = 0, n do
      local px, py, pz = turn(state.orientation, f(i / m, j / n))
      x[i + 1][j + 1], y[i + 1][j + 1], z[i + 1][j + 1] =
        px + state.position[1], py + state.position[2], pz + state.position[3]
    end
  end
  return x, y, z
end

--- A ball at a state (scene:state), in eight patches of two colours, so that its turning shows: a list of plot items.
---@return plot.item[]
function portrait.ball(state, radius, color1, color2)
  local items = {}
  for patch = 0, 7 do
    local quarter, lower = patch % 4, patch // 4
    local x, y, z = placed(state, 12, 12, function(u, v)
      local longitude, latitude = (quarter + u) * math.pi / 2, (v - lower) * math.pi / 2
      return radius * math.cos(latitude) * math.cos(longitude), radius * math.cos(latitude) * math.sin(longitude),
        radius * math.sin(latitude)
    end)
    items[#items + 1] = plot.surface { x, y, z, color = (quarter + lower) % 2 == 0 and color1 or color2, opacity = 1 }
  end
  return items
end

--- Any shape at a state (scene:state), its centre at the state's position: one plot item.
---@param state impact.state
---@param shape impact.shape
---@param color? string
---@param opacity? number
---@return plot.item
function portrait.solid(state, shape, color, opacity)
  if type(shape) ~= "userdata" then error("solid: shape must be a shape, got a " .. type(shape), 2) end
  local around, up = 48, 24
  local points, x, y, z = shape:mesh(around, up), {}, {}, {}
  for j = 0, up do
    x[j + 1], y[j + 1], z[j + 1] = {}, {}, {}
    for i = 0, around do -- the first once more: closed
      local p = points[j * around + i % around + 1]
      local px, py, pz = turn(state.orientation, p[1], p[2], p[3])
      x[j + 1][i + 1], y[j + 1][i + 1], z[j + 1][i + 1] = px + state.position[1], py + state.position[2], pz + state.position[3]
    end
  end
  return plot.surface { x, y, z, color = color, opacity = opacity or 1 }
end

--- A sheet of a plane at its state, from low to high along its own axes: one plot item.
---@return plot.item
function portrait.sheet(state, low, high, color, opacity)
  local x, y, z = placed(state, 8, 8, function(u, v)
    return low[1] + u * (high[1] - low[1]), low[2] + v * (high[2] - low[2]), 0
  end)
  return plot.surface { x, y, z, color = color, opacity = opacity }
end

--- The direction towards the eye of a panel's view {about x, about z}, degrees: what faces it is in front.
function portrait.eye(view)
  local a, b = math.rad(view[1]), math.rad(view[2])
  return { math.sin(a) * math.sin(b), -math.sin(a) * math.cos(b), math.cos(a) }
end

--- A ribbon through `places` with the orientations `frames` (quaternions): x across it, z its normal; one colour for each side.
--- shape: {half_width, thickness, front, back}; a list of plot items.
---@return plot.item[]
function portrait.ribbon(frames, places, shape)
  local items = {}
  for side = 1, -1, -2 do
    local x, y, z = {}, {}, {}
    for i = 1, #frames do
      local q, p, n = frames[i], places[i], #x + 1
      local ax, ay, az = turn(q, 1, 0, 0)
      local nx, ny, nz = turn(q, 0, 0, 0.5 * side * shape.thickness)
      x[n], y[n], z[n] = {}, {}, {}
      for j = -1, 1 do
        local w = j * shape.half_width
        x[n][j + 2], y[n][j + 2], z[n][j + 2] = p[1] + w * ax + nx, p[2] + w * ay + ny, p[3] + w * az + nz
      end
    end
    items[#items + 1] = plot.surface { x, y, z, color = side > 0 and shape.front or shape.back, opacity = 1 }
    -- Its rims: what is seen of it edge-on.
    for j = 1, 3, 2 do
      local rim = { {}, {}, {}, color = side > 0 and shape.front or shape.back, width = 1.2 }
      for i = 1, #x do rim[1][i], rim[2][i], rim[3][i] = x[i][j], y[i][j], z[i][j] end
      items[#items + 1] = plot.line(rim)
    end
  end
  return items
end

return portrait
