-- SPDX-License-Identifier: MIT
-- test_report.lua SOURCE RUNNER WORK: what docs/report.md prints of a report is what the command prints now: its events, its rows, what is left
-- out, and how far each method comes, to a digit. Times are the machine's, and are not compared.
local pages = require "pages"
local source, runner, work = arg[1], arg[2], arg[3]

--- What there is of it to compare: the head's counts, what changes nothing, and each method's least error by its name.
local function read(text)
  local report = { head = text:match "(sphere_wall: [^\n]-%d+ events)", left_out = text:match "left out +([^\n]*)", methods = {} }
  local rows = assert(text:match "ms to reach([^\n]*\n.*)left out", "no rows")
  report.aims = rows:match "^([^\n]*)"
  for name, best in rows:gmatch "\n  (%a[%w= ]-)  +[%d.][^\n]- (%S+)\n?%f[\n\0]" do
    report.methods[#report.methods + 1] = { name = name, best = assert(tonumber(best), "no error of " .. name) }
  end
  return report
end

local printed = read(pages.read(source .. "/docs/report.md"):match "\n```text\n(sphere_wall:.-)\n```")
local pipe = assert(io.popen(("'%s' '%s/examples/scenes/sphere_wall.lua' --report --out '%s' 2>&1"):format(runner, source, work)))
local text = pipe:read "a"
assert(pipe:close(), text)
local found = read(text)

for _, key in ipairs { "head", "left_out", "aims" } do
  assert(printed[key] and printed[key] == found[key], ("%s: printed %s, found %s"):format(key, printed[key], found[key]))
end
assert(#printed.methods == 5 and #found.methods == 5, "five methods")
for k, method in ipairs(printed.methods) do
  local now = found.methods[k]
  assert(method.name == now.name, ("row %d: printed %s, found %s"):format(k, method.name, now.name))
  local ratio = now.best / method.best
  assert(ratio < 10 and ratio > 0.1, ("%s: printed %g, found %g"):format(method.name, method.best, now.best))
end
