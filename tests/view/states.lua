-- SPDX-License-Identifier: MIT
--- Where a recorded run's bodies are at random times: `impact --trust tests/view/states.lua -- FILE.run COUNT` prints CSV: t, the body, its size (the
--- radius about its centre), place and orientation. What is imported elsewhere is held against them.
local impact = require "impact"
local path, count = arg[1], tonumber(arg[2])
arg = {}
math.randomseed(7)
local run = assert(impact.open(path))
local first, last = run:times()
print "t,body,size,x,y,z,qw,qx,qy,qz"
for _ = 1, count do
  local t = first + (last - first) * math.random()
  for _, body in ipairs(run:bodies()) do
    local s = run:state(body.name, t)
    local p, q = s.position, s.orientation
    local size = not body.static and body.shape.bounding_radius + body.shape_position:norm()
    if size then print(string.format("%.17g,%s,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g", t, body.name:gsub(",", " "), size, p.x, p.y, p.z, q.w, q.x, q.y, q.z)) end
  end
end
