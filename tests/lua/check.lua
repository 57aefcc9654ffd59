-- SPDX-License-Identifier: MIT
--- Checks for the tests of the Lua face; a failure names the caller's line and what was wanted and got.
local check = {}

local count = 0

local function fail(format, ...)
  error(string.format(format, ...), 3)
end

function check.equal(got, wanted)
  count = count + 1
  if got ~= wanted then fail("wanted %s, got %s", tostring(wanted), tostring(got)) end
end

function check.close(got, wanted, tolerance)
  count = count + 1
  if not (math.abs(got - wanted) <= tolerance) then
    fail("wanted %.17g within %g, got %.17g, off by %g tolerances", wanted, tolerance, got, math.abs(got - wanted) / tolerance)
  end
end

function check.truth(value, what)
  count = count + 1
  if not value then fail("%s does not hold", what or "it") end
end

--- f(...) must raise exactly `wanted`, after the "file:line: " of its position.
function check.raises(wanted, f, ...)
  count = count + 1
  local ok, message = pcall(f, ...)
  if ok then fail("wanted the error '%s', got none", wanted) end
  local place, text = tostring(message):match("^([^:]+:%d+: )(.*)$")
  if not place then fail("no file and line in '%s'", tostring(message)) end
  if text ~= wanted then fail("wanted the error '%s', got '%s'", wanted, text) end
end

function check.report(name)
  print(string.format("%s: %d checks passed", name, count))
end

return check
