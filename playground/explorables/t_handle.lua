-- SPDX-License-Identifier: MIT
--- The T-handle (Dzhanibekov's effect): spun about its middle axis it turns over, again and again.
local impact = require "impact"
local quat = require "quat"

local I2, push = values.middle or 2, 10 ^ (values.push or -2)
local I, w = { 1, I2, 3 }, { push, 10, 0 }
local high, middle, low = 0, 0, 0 -- 2 E I3 - L^2, 2 E I2 - L^2, L^2 - 2 E I1, without cancellation
for k = 1, 3 do
  high, middle = high + I[k] * w[k] ^ 2 * (I[3] - I[k]), middle + I[k] * w[k] ^ 2 * (I[2] - I[k])
end
local rate = math.sqrt((I[2] - I[1]) * high / (I[1] * I[2] * I[3]))
local x, y = 1, math.sqrt((I[3] - I[1]) * middle / ((I[2] - I[1]) * high))
while math.abs(x - y) > 1e-15 do x, y = (x + y) / 2, math.sqrt(x * y) end
local half = math.pi / x / rate
local scene = impact.scene {
  name = "t_handle", gravity = { 0, 0, 0 }, duration = 4 * half, output_rate = 0,
  bodies = { impact.body { name = "handle", shape = impact.ellipsoid { a = 0.3, b = 0.2, c = 0.1 }, mass = 1, moments = I, omega = w } },
}
return {
  title = "The T-handle",
  formula = "I_i ω_i' = (I_j − I_k) ω_j ω_k\none turn-over each  P/2 = 2 K(m)/rate,   rate² = (I₂ − I₁)(2 E I₃ − L²)/(I₁ I₂ I₃)",
  text = "Rotation about the middle axis is unstable: the smaller the push, the longer it waits, as the logarithm.",
  parameters = { { name = "middle", label = "middle moment I₂ (1 … 3)", low = 1.1, high = 2.9, value = I2 }, { name = "push", label = "log₁₀ of the push ω₁", low = -8, high = 0, value = values.push or -2 } },
  scene = scene,
  address = "#t=0",
  after = function(run)
    -- Where w_2 in the body's axes changes its sign for the first time: by the exact states of the run.
    local record = run:record()
    local function inside(t) local s = record:state("handle", t) return quat.rotate(quat.conj(s.orientation), s.omega)[2] end
    local a, b = 0, half
    for _ = 1, 60 do local c = (a + b) / 2 if inside(c) > 0 then a = c else b = c end end
    return string.format("P/2 by Jacobi's elliptic functions: %.12f s\nω₂ changes its sign at t = P/4:     %.12f s, from the run ×2: %.12f", half, a, 2 * a)
  end,
}
