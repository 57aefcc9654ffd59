-- SPDX-License-Identifier: MIT
--- Sobol's points in [0, 1)^d: `local sobol = require "impact.sobol"`.
---
--- Coordinate d of point i is the sum over the set bits k of gray(i) = i ~ (i >> 1), modulo 2, of direction numbers v[d][k]. Those obey the
--- recurrence of a primitive polynomial over GF(2) of degree s,
---   m[k] = 2 a1 m[k-1] ~ 4 a2 m[k-2] ~ ... ~ 2^s m[k-s] ~ m[k-s],   v[k] = m[k] / 2^k
--- (Bratley and Fox 1988; polynomials and first m of Joe and Kuo 2008, whose points fill each half of every axis at once: Sobol's property A).

local BITS = 53 -- of a number's fraction

--- { degree, coefficients between the first and the last, as bits, first m ... }; the first coordinate is van der Corput's.
local polynomials = {
  { 1, 0, 1 },
  { 2, 1, 1, 3 },
  { 3, 1, 1, 3, 1 },
  { 3, 2, 1, 1, 1 },
  { 4, 1, 1, 1, 3, 3 },
  { 4, 4, 1, 3, 5, 13 },
  { 5, 2, 1, 1, 5, 5, 17 },
  { 5, 4, 1, 1, 5, 5, 5 },
  { 5, 7, 1, 1, 7, 11, 19 },
  { 5, 11, 1, 1, 5, 1, 1 },
  { 5, 13, 1, 1, 1, 3, 11 },
  { 5, 14, 1, 3, 5, 5, 31 },
  { 6, 1, 1, 3, 3, 9, 7, 49 },
  { 6, 13, 1, 1, 1, 15, 21, 21 },
  { 6, 16, 1, 3, 1, 13, 27, 49 },
  { 6, 19, 1, 1, 1, 15, 7, 5 },
  { 6, 22, 1, 3, 1, 15, 13, 25 },
  { 6, 25, 1, 1, 5, 5, 19, 61 },
  { 7, 1, 1, 3, 7, 11, 23, 15, 103 },
  { 7, 4, 1, 3, 7, 13, 13, 15, 69 },
}

local sobol = { dimensions = #polynomials + 1, bits = BITS }

--- The direction numbers of a coordinate (from 1), as integers of BITS bits.
---@param dimension integer
---@return integer[]
function sobol.directions(dimension)
  local m, v = {}, {}
  if dimension == 1 then
    for k = 1, BITS do m[k] = 1 end
  else
    local polynomial = polynomials[dimension - 1]
    local degree, inner = polynomial[1], polynomial[2]
    for k = 1, degree do m[k] = polynomial[2 + k] end
    for k = degree + 1, BITS do
      m[k] = m[k - degree] ~ (m[k - degree] << degree)
      for j = 1, degree - 1 do
        if (inner >> (degree - 1 - j)) & 1 == 1 then m[k] = m[k] ~ (m[k - j] << j) end
      end
    end
  end
  for k = 1, BITS do v[k] = m[k] << (BITS - k) end
  return v
end

--- A coordinate of point i (from 0), in [0, 1); shift: a number of BITS bits that is added to all points' bits, modulo 2.
---@param directions integer[]
---@param i integer
---@param shift? integer
---@return number
function sobol.coordinate(directions, i, shift)
  local gray, x, k = i ~ (i >> 1), shift or 0, 1
  while gray > 0 do
    if gray & 1 == 1 then x = x ~ directions[k] end
    gray, k = gray >> 1, k + 1
  end
  return x * 2.0 ^ -BITS
end

return sobol
