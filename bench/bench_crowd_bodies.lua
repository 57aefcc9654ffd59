-- SPDX-License-Identifier: MIT
--- A crowd as a script makes it: the processor's time of 1e5 bodies, and of the scene they make up. bench_crowd runs it.
local impact = require "impact"

local count, shape, bodies = 100000, impact.sphere(0.1), {}
local start = os.clock()
for i = 1, count do bodies[i] = impact.body { name = "ball " .. i, shape = shape, position = { i, 0, 0 } } end
local made = os.clock()
local scene <close> = impact.scene { duration = 1, bodies = bodies }
print(string.format("1e5 bodies in Lua,s,%.3g", made - start))
print(string.format("their scene in Lua,s,%.3g", os.clock() - made))
