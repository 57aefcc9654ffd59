-- SPDX-License-Identifier: MIT
--- The figures of the pages, held to those that commands print.
---
---   test_values.lua ROOT BUILD              the test: pages, store, sources and what the tests of BUILD have measured agree
---   test_values.lua ROOT BUILD measure [NAME...]   runs the programs (all but the long ones, or those named) and puts their figures
---                                           into docs/values.csv
---   test_values.lua ROOT BUILD write        puts the store's figures into the pages, to as many digits as stand there
---   test_values.lua ROOT BUILD again        runs the programs once more: the test that their figures are those of the store
---
--- A page says behind a number where it comes from, in comments that no reader of the rendered page sees:
---   7e-14<!--v quat_curve/curvature-->      a figure of docs/values.csv, rounded to the digits that stand there, or up to them.
---                                           A star in the key: the largest of those that match. KEY / KEY: the quotient
---   1e-9 … 1e9<!--s report_extreme.c-->     a range, a bound or a default: each number before it on the line is a literal of that file
---   1e-9 … 1e9<!--r report_extreme/units-->  the ends of a range of rows of the store: PROGRAM/row, whose next part is the number
---   <!--t report_cones 3: solved - systems,systems_most-->   before a table: what the cells after the first three are; those three
---                                           are the row's name. "-": nothing; commas between the numbers of one cell
--- Every number with an exponent has one of these or stands in docs/given.txt (page, text, reason: tabs between; a # in
--- the text is any number).
--- Code is left out: docs.blocks runs it.
---
--- Keys: PROGRAM/row/column. Tests print name, value and bound with TEST_SHOW; benches and reports print CSV.
local pages = require "pages"
local root, build, mode = arg[1], arg[2], arg[3]

-- Of CSV: how many columns name the row. Of tests nothing need be said. "long": minutes, run when named. "script": of bench/, by the
-- runner, once for its columns' names and once for each example.
local programs = {
  bench_quat = { names = 3 }, bench_geometry = { names = 2 }, bench_flight = { names = 3 }, bench_gap = { names = 4 },
  bench_engines = { names = 3 }, bench_scene = { names = 3 }, bench_collide = { names = 3 },
  bench_cones = { names = 2 }, bench_together = { names = 4 }, report_cones = { names = 3 }, report_extreme = { names = 2 }, report_motion = { names = 2 },
  report_held = { names = 2, long = true }, report_flat = { names = 4, long = true },
  report_collide = { names = 2, arguments = "--impacts 10000000 --seed 7 --oracle 1000 --cvode 1000 --range 100000", long = true },
  report_gap = { names = 2, arguments = "--pairs 60000 --threads 2" },
  used = { names = 1, script = "used.lua", command = "./run report examples" },
}

--- A name as it stands in a key: 1e-06 and 1e-6 are the same.
local function slug(text)
  text = text:match "^%s*(.-)%s*$"
  local number = tonumber(text)
  if number then return string.format(number % 1 == 0 and math.abs(number) < 1e15 and "%.0f" or "%g", number) end
  return (text:lower():gsub("[^%w.+-]+", "_"):gsub("^_+", ""):gsub("_+$", ""))
end

-- ---- the store ----

local store_path = root .. "/docs/values.csv"
local store, known = {}, {}

local function read_store()
  for i, line in ipairs(pages.lines(store_path) or {}) do
    local key, value, unit, kind, command = line:match '^([^,]*),([^,]*),([^,]*),([^,]*),(.*)$'
    if i > 1 then
      store[key] = { value = tonumber(value), unit = unit, kind = kind, command = command }
      known[#known + 1] = key
    end
  end
end

local function write_store(used)
  local keys = {}
  for key in pairs(store) do if used[key] then keys[#keys + 1] = key end end
  table.sort(keys)
  local file = assert(io.open(store_path, "w"))
  file:write "key,value,unit,kind,command\n"
  for _, key in ipairs(keys) do
    local v = store[key]
    file:write(string.format("%s,%.6g,%s,%s,%s\n", key, v.value, v.unit, v.kind, v.command))
  end
  file:close()
  print(#keys .. " figures in docs/values.csv")
end

-- ---- harvests ----

--- Times hang on the machine: shown, not compared.
local function unit_of(column)
  for _, unit in ipairs { "ns", "us", "ms" } do
    if (column .. "_"):find("%f[%w]" .. unit .. "_") or column:find("_" .. unit .. "$") then return unit, "time" end
  end
  if column:find "^time_" or column == "ratio" or column:find "_over_ours$" then return "1", "time" end
  return column:match "[,_ ]+(rad)$" or column:match "[,_ ]+(u)$" or "1"
end

--- Lines "name   value  (bound B)" of a test. A name that comes again: the largest.
local function of_test(text, program, add)
  for line in text:gmatch "[^\n]+" do
    local name, value = line:match "^(%S.-)%s+(%-?[%d.][%d.e+-]*)%s*$"
    local bound
    if not name then name, value, bound = line:match "^(%S.-)%s+(%-?[%d.][%d.e+-]*)%s+%(bound ([%d.e+-]+)%)$" end
    if name then
      local unit = unit_of(name)
      add(program .. "/" .. slug(name), tonumber(value), unit, "figure")
      if bound then add(program .. "/" .. slug(name) .. "/bound", tonumber(bound), unit, "bound") end
    end
  end
end

--- CSV, in sections of a header each, empty lines between.
local function of_csv(text, program, add)
  local header
  for line in (text .. "\n"):gmatch "(.-)\n" do
    local cells = {}
    for cell in (line .. ","):gmatch "([^,]*)," do cells[#cells + 1] = cell end
    if line == "" then header = nil
    elseif line:find "^#" then
    elseif not header then header = cells
    else
      local names = {}
      for i = 1, programs[program].names do names[i] = slug(cells[i]) end
      for i = programs[program].names + 1, #cells do
        local value = tonumber(cells[i])
        if value and value == value and header[i] then
          local unit, kind = unit_of(header[i])
          kind = kind or cells[i]:find "^%d+$" and "count" or "figure"
          add(program .. "/" .. table.concat(names, "/") .. "/" .. header[i], value, unit, kind)
        end
      end
    end
  end
end

local function command_of(program)
  local spec = programs[program]
  if spec and spec.command then return spec.command end
  if spec then
    local kind, module = program:match "^(%a+)_(.*)$"
    return string.format("./run %s %s%s", kind, module, spec.arguments and " " .. spec.arguments or "")
  end
  local library, test = program:match "^(%a+)_(.*)$"
  return string.format("TEST_SHOW=1 build/release/tests/%s/test_%s_%s", library, library, test)
end

local function capture(command)
  local pipe = assert(io.popen(command))
  local text = pipe:read "a"
  assert(pipe:close(), command .. " failed")
  return text
end

--- What a script of bench/ prints: the names of its columns, and a row for each example.
local function of_examples(runner, script)
  local rows = { capture(string.format("'%s' --trust --quiet '%s/bench/%s' -- names", runner, root, script)) }
  for path in capture(string.format("ls '%s'/examples/scenes/*.lua", root)):gmatch "[^\n]+" do
    rows[#rows + 1] = capture(string.format("'%s' --trust --quiet '%s/bench/%s' -- '%s' 2>/dev/null", runner, root, script, path))
  end
  return table.concat(rows)
end

--- The figures of a program, run now: key to { value, unit, kind, command }; nil where this build has none.
local function measured(program)
  local spec, found = programs[program], {}
  local path = spec and spec.script and build .. "/lua/impact" or spec and string.format("%s/bench/%s", build, program) or
    string.format("%s/tests/%s/test_%s", build, program:match "^%a+", program)
  local file = io.open(path, "rb")
  if not file then return end
  file:close()
  local text = spec and spec.script and of_examples(path, spec.script) or
    capture(string.format("cd '%s' && OUT='%s' TEST_SHOW=1 '%s' %s 2>/dev/null", build, build, path, spec and spec.arguments or ""))
  local harvest = spec and of_csv or of_test
  harvest(text, program, function(key, value, unit, kind)
    if found[key] and found[key].value >= value then return end
    found[key] = { value = value, unit = unit, kind = kind, command = command_of(program) }
  end)
  return found
end

-- ---- numbers of a line ----

--- Every number outside of code and comments: { from, to, value, text, exponent }.
local function numbers_of(line)
  local blank = function(text) return (" "):rep(#text) end
  line = line:gsub("<!%-%-.-%-%->", blank):gsub("`[^`]*`", blank):gsub("%]%([^)]*%)", blank)
  local list, at = {}, 1
  while true do
    local from, to = line:find("%.?%d[%d.]*", at)
    if not from then return list end
    local digits = line:sub(from, to):gsub("%.+$", "")
    to = from + #digits - 1
    local power = line:match("^e[-+]?%d+", to + 1) or line:match("^e±%d+", to + 1)
    local thousands = not digits:find "%." and line:match("^ %d%d%d%f[%D]", to + 1)
    while thousands do
      digits, to = digits .. thousands:sub(2), to + 4
      thousands = line:match("^ %d%d%d%f[%D]", to + 1)
    end
    local number = { from = from, to = to + #(power or ""), exponent = power ~= nil }
    number.value = tonumber(digits .. (power or ""):gsub("±", ""))
    number.text = line:sub(from, number.to)
    local other = line:match("^⁻", to + 1) or line:match("^[¹²]", to + 1) and line:match("^..?[⁰¹²³⁴⁵⁶⁷⁸⁹]", to + 1) or line:match("^%^", to + 1)
    if digits == "10" and other then number.foreign = true end
    if number.value and not line:sub(1, from - 1):find "[%a_]$" then list[#list + 1] = number end
    at = number.to + 1
  end
end

--- A figure as the page would print it, in the style of what stands there.
local function styled(value, text)
  local mantissa = text:match "^([%d.]+)e"
  local digits = (mantissa or text):gsub("[^%d]", ""):gsub("^0+", "")
  local count = math.max(#digits, 1)
  if mantissa then
    local m, e = string.format("%." .. count - 1 .. "e", value):match "^(.-)e([-+]%d+)$"
    return m .. "e" .. tonumber(e)
  end
  local places = #(text:match "%.(%d*)$" or "")
  local plain = string.format("%." .. places .. "f", value)
  if places == 0 and text:find " " then plain = plain:reverse():gsub("(%d%d%d)(%f[%d])", "%1 %2"):reverse() end
  return text:find "^%." and plain:gsub("^0%.", ".") or plain
end

--- Whether the printed number is the value to the digits printed, or rounded up to them.
local function agrees(text, value)
  local mantissa, power = text:match "^([%d.]+)e([-+]?%d+)$"
  mantissa = mantissa or text:gsub(" ", "")
  local unit = 10.0 ^ (tonumber(power or 0) - #(mantissa:match "%.(%d*)$" or ""))
  local off = tonumber(mantissa) * 10.0 ^ tonumber(power or 0) - value
  return off >= -0.5000001 * unit and off < unit
end

-- ---- where a number comes from ----

local used = {}

--- The value of a key: of one, of the largest that match, of a quotient.
local function value_of(key)
  local a, b = key:match "^(.-) / (.*)$"
  if a then
    local over, under = value_of(a), value_of(b)
    return over and under and over / under
  end
  if not key:find "*" then
    used[key] = true
    return store[key] and store[key].value
  end
  local pattern = "^" .. key:gsub("[%-%.%+]", "%%%0"):gsub("%*", "[^/]*") .. "$"
  local largest
  for name, entry in pairs(store) do
    if name:find(pattern) then
      used[name] = true
      largest = math.max(largest or entry.value, entry.value)
    end
  end
  return largest
end

local sources, literals = nil, {}

--- The numbers that stand in a source file, by its name.
local function literals_of(name)
  if literals[name] then return literals[name] end
  sources = sources or pages.list(root, "^.*%.%a+$")
  local found
  for _, path in ipairs(sources) do
    if path == name or path:sub(-#name - 1) == "/" .. name then
      if found then pages.complain("two files are called %s: %s and %s", name, found, path) end
      found = path
    end
  end
  local list = {}
  if not found then pages.complain("no file %s", name)
  else
    local whole = pages.read(root .. "/" .. found)
    for ends in (whole:gsub("decades%(g,", "random_scale(r,")):gmatch "random_scale%(%&?r,([^()]*)" do -- between powers of ten
      for power in ends:gmatch "%f[%w-]%-?%d+%f[^%d.]" do list[#list + 1] = 10.0 ^ tonumber(power) end
    end
    for text in whole:gmatch "%f[%w.]%.?%d[%w.]*[-+]?%d*" do
      for _, candidate in ipairs { text, text:match "^[%d.]+e?%-?%d*", text:match "^[%d.]+" } do
        local value = tonumber(candidate)
        if value then list[#list + 1] = value end
      end
    end
  end
  literals[name] = list
  return list
end

local function stands_in(value, names)
  for name in names:gmatch "%S+" do
    for _, literal in ipairs(literals_of(name)) do
      if math.abs(literal - value) <= 1e-9 * math.abs(value) then return true end
    end
  end
  return false
end

--- Whether the store has a row of that number: its name after the prefix.
local function is_row_of(value, prefix)
  local from = prefix .. "/" .. slug(string.format("%.15g", value)) .. "/"
  for key in pairs(store) do
    if key:sub(1, #from) == from then return true end
  end
  return false
end

local given = {}
local function read_given()
  for _, line in ipairs(pages.lines(root .. "/docs/given.txt") or {}) do
    local page, text, reason = line:match "^([^\t#]+)\t([^\t]+)\t(.+)$"
    if page then given[#given + 1] = { page = page, text = text, reason = reason } end
  end
end

local checked = 0

--- A number with a key: complains, or in `write` gives the text that should stand there.
local function hold(place, number, key)
  local value = value_of(key)
  checked = checked + 1
  if not value then
    if mode ~= "measure" then pages.complain("%s: docs/values.csv has no %s", place, key) end
  elseif mode == "write" then
    if not agrees(number.text, value) then return styled(value, number.text) end
  elseif not mode and not agrees(number.text, value) then
    pages.complain("%s: prints %s, and %s is %.4g", place, number.text, key, value)
  end
end

--- Tags of a line, in order: { from, kind, text }.
local function tags_of(line)
  local list = {}
  for from, kind, text in line:gmatch "()<!%-%-([vsr]) (.-)%-%->" do list[#list + 1] = { from = from, kind = kind, text = text } end
  return list
end

local function excused(page, line, number)
  for _, entry in ipairs(given) do
    if entry.page == page then
      local pattern = entry.text:gsub("%p", "%%%0"):gsub("%%#", "[%%d.e-]+")
      local from, to = line:find(pattern)
      while from do
        if from <= number.from and number.to <= to then
          entry.met = true
          return true
        end
        from, to = line:find(pattern, to + 1)
      end
    end
  end
end

--- Row of a table whose columns a t-tag names: key of each number; false: it names the row.
local function keys_of_row(table_tag, line)
  local keys, cell, at, names = {}, 0, 2, {}
  while true do
    local bar = line:find("|", at, true)
    if not bar then return keys end
    cell = cell + 1
    local text = line:sub(at, bar - 1)
    if cell <= table_tag.names then
      names[cell] = slug((text:gsub("<!%-%-.-%-%->", "")))
      for _, number in ipairs(numbers_of(line)) do
        if number.from >= at and number.to < bar then keys[number.from] = false end
      end
    end
    local words, k = table_tag.columns[cell - table_tag.names], 0
    if words and words ~= "-" and text:find "%d" then
      local list = {}
      for word in words:gmatch "[^,]+" do list[#list + 1] = word end
      for _, number in ipairs(numbers_of(line)) do
        if number.from >= at and number.to < bar then
          k = k + 1
          if list[k] then keys[number.from] = table_tag.source .. "/" .. table.concat(names, "/") .. "/" .. list[k] end
        end
      end
    end
    at = bar + 1
  end
end

local function check_line(page, place, line, table_tag)
  local numbers, tags, changes = numbers_of(line), tags_of(line), {}
  local keys = table_tag and line:find "^|" and keys_of_row(table_tag, line) or {}
  local covered = 0
  for _, tag in ipairs(tags) do
    if tag.kind == "v" then
      local nearest
      for _, number in ipairs(numbers) do
        if number.to < tag.from then nearest = number end
      end
      if nearest then keys[nearest.from] = tag.text else pages.complain("%s: no number before %s", place, tag.text) end
    end
  end
  for _, tag in ipairs(tags) do
    for _, number in ipairs(numbers) do
      if tag.kind ~= "v" and number.from > covered and number.to < tag.from and not keys[number.from] and number.exponent then
        number.sourced = true
        checked = checked + 1
        local there = tag.kind == "s" and stands_in or is_row_of
        if not mode and not there(number.value, tag.text) then pages.complain("%s: %s does not stand in %s", place, number.text, tag.text) end
      end
    end
    covered = tag.from
  end
  for _, number in ipairs(numbers) do
    local key = keys[number.from]
    if number.foreign and not mode and not excused(page, line, number) then pages.complain("%s: a power of ten is written 1e-3 here", place) end
    if key and not excused(page, line, number) then
      local better = hold(place, number, key)
      if better then changes[#changes + 1] = { number.from, number.to, better } end
    elseif not key and key ~= false and number.exponent and not number.sourced and not excused(page, line, number) and not mode then
      pages.complain("%s: %s comes from nowhere", place, number.text)
    end
  end
  for i = #changes, 1, -1 do line = line:sub(1, changes[i][1] - 1) .. changes[i][3] .. line:sub(changes[i][2] + 1) end
  return line
end

local function check_page(page)
  local lines, fence, tag = pages.lines(root .. "/" .. page), false, nil
  for i, line in ipairs(lines) do
    local source, names, columns = line:match "^<!%-%-t (%S+) (%d+): (.-)%-%->$"
    if line:find "^```" then fence = not fence end
    if source then
      tag = { source = source, names = tonumber(names), columns = {}, fresh = true }
      for word in columns:gmatch "%S+" do tag.columns[#tag.columns + 1] = word end
    elseif tag and line:find "^|%-" then tag.fresh = false
    elseif tag and not tag.fresh and not line:find "^|" then tag = nil
    end
    if not fence and not line:find "^    %S" then
      lines[i] = check_line(page, page .. ":" .. i, line, tag and not tag.fresh and tag or nil)
    end
  end
  if mode == "write" then
    local file = assert(io.open(root .. "/" .. page, "w"))
    file:write(table.concat(lines, "\n"), "\n")
    file:close()
  end
end

local function check_pages()
  for _, page in ipairs(pages.all(root)) do
    check_page(page)
  end
end

--- Whether a figure measured again is that of the store. Errors may be less; another libm makes them differ in the first digit: twice
--- the store's is too much. Counts may differ by one in a hundred. Times are not compared.
local function compare(key, now)
  local was = store[key]
  if not was or was.kind == "time" then return end
  if was.kind == "bound" and now.value ~= was.value then pages.complain("%s is %g, docs/values.csv has %g", key, now.value, was.value)
  elseif was.kind == "count" and math.abs(now.value - was.value) > math.max(1, 0.01 * was.value) then
    pages.complain("%s is %g, docs/values.csv has %g", key, now.value, was.value)
  elseif was.kind == "figure" and math.abs(now.value) > 2 * math.abs(was.value) then
    pages.complain("%s is %g, docs/values.csv has %g", key, now.value, was.value)
  end
end

--- The programs whose figures the pages use.
local function wanted()
  local list, seen = {}, {}
  for key in pairs(used) do
    local program = key:match "^[^/]+"
    if not seen[program] then
      seen[program] = true
      list[#list + 1] = program
    end
  end
  table.sort(list)
  return list
end

read_store()
read_given()

if mode == "measure" then
  -- A star in a key matches what the store has: everything measured goes there first.
  check_pages()
  local names = { table.unpack(arg, 4) }
  if #names == 0 then
    local seen = {}
    for _, page in ipairs(pages.all(root)) do
      for tag in pages.read(root .. "/" .. page):gmatch "<!%-%-[vt] (.-)%-%->" do
        for key in (tag:gsub(" %d+:.*", "") .. " / "):gmatch "(.-) / " do
          local program = key:match "^[^/]+"
          if not seen[program] and not (programs[program] and programs[program].long) then names[#names + 1] = program end
          seen[program] = true
        end
      end
    end
  end
  for _, program in ipairs(names) do
    print(program)
    for key, figure in pairs(measured(program) or {}) do store[key] = figure end
  end
  used = {}
  check_pages()
  write_store(used)
  os.exit(0)
end

check_pages()
if mode == "write" then os.exit(0) end

for _, entry in ipairs(given) do
  if not entry.met then pages.complain("docs/given.txt: no number in '%s' on %s needs it", entry.text, entry.page) end
end
for _, key in ipairs(known) do
  if not used[key] then pages.complain("docs/values.csv: no page prints %s", key) end
end

local again, absent = 0, 0
for _, program in ipairs(wanted()) do
  local found
  if mode == "again" and programs[program] and not programs[program].long then
    found = measured(program)
  elseif not mode and not programs[program] then
    local lines = pages.lines(string.format("%s/tests/figures/test_%s.txt", build, program))
    if lines then
      found = {}
      of_test(table.concat(lines, "\n"), program, function(key, value) found[key] = { value = math.max(value, found[key] and found[key].value or value) } end)
    end
  end
  if found then
    again = again + 1
    for key, figure in pairs(found) do compare(key, figure) end
  else
    absent = absent + 1
  end
end
pages.finish("%d numbers; %d programs measured again, %d not here", checked, again, absent)
