-- SPDX-License-Identifier: MIT
--- test_locale.lua WORK: a host whose locale has a decimal comma changes nothing of what other programs read: tables, gnuplot's
--- commands, pages, rows of runs. Where no such locale is installed, localedef makes one; where that cannot, the test is skipped (77).
local check = require "check"
local work = ...

local names = { "de_DE.UTF-8", "de_DE.utf8", "sv_SE.UTF-8", "fr_FR.UTF-8" }
local found
for _, name in ipairs(names) do found = found or os.setlocale(name) and name end
if not found then
  if os.getenv "LOCPATH" == work .. "/locale" then os.exit(77) end -- we have made one, in vain
  os.execute(("mkdir -p '%s/locale' && localedef -i de_DE -f UTF-8 '%s/locale/de_DE.utf8' >'%s/locale/log' 2>&1"):format(work, work, work))
  local _, _, code = os.execute(("LOCPATH='%s/locale' '%s' '%s' '%s'"):format(work, arg[-1], arg[0], work))
  os.exit(code)
end
check.equal(("%.1f"):format(0.5), "0,5") -- the locale is at work

local impact, csv, plot, page = require "impact", require "quat.csv", require "quat.plot", require "quat.page"
local text = csv.text({ "a", "b" }, { { 0.5, -0.375, 1 / 0 }, { 1, 0.1, "0,5" } })
check.equal(text, 'a,b\n0.5,1\n-0.375,0.10000000000000001\ninf,"0,5"\n')
local rows = csv.rows(text)
check.equal(rows[1].a + rows[1].b, 1.5)
check.equal(rows[3].b, "0,5")

local figure = plot.figure { plot.panel { plot.line { { 0, 0.5 }, { 0.25, 1.5 }, width = 1.5 }, xrange = { -0.5, 1.5 } } }
local commands = plot.gnuplot(figure)
check.truth(commands:find("xrange [-0.5", 1, true), commands)
check.equal(page.json { 0.5, { x = -2.5e-7 } }, '[0.5,{"x":-2.4999999999999999e-07}]')

-- And a run's rows are those of the C locale, byte for byte.
local function rows_of_run(name)
  local scene = impact.scene { name = "drop", gravity = { 0, 0, -9.81 }, duration = 0.6, bodies = { { name = "floor", shape = impact.plane(), restitution = 1 },
    { name = "ball", shape = impact.sphere(0.1), mass = 1, restitution = 0.7, position = { 0, 0, 1 }, velocity = { 0.3, 0, 0 } } } }
  check.equal((scene:run { csv = work .. "/" .. name }), "end of time")
  local file = assert(io.open(work .. "/" .. name .. ".csv"))
  local all = file:read "a"
  file:close()
  return all
end
os.execute("mkdir -p '" .. work .. "'")
local abroad = rows_of_run "abroad"
os.setlocale "C"
check.equal(abroad, rows_of_run "at_home")
check.equal(commands, (plot.gnuplot(figure)))
check.report("locale")
