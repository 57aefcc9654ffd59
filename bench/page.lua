-- SPDX-License-Identifier: MIT
--- `./run report`: every part measured, each with its picture, and every example scene by every method, as one page.
---
---     page.lua ROOT OUT BENCH NATIVE RUNNER quick|full [PART...]
---
--- Runs the programs of bench/parts.lua, those of BENCH and again those of NATIVE (built with -march=native; "" leaves them out), and
--- reports of the examples, keeps their CSV in OUT, and writes OUT/index.html with pictures inline and no script. A program that is
--- missing, fails or does not end in its time is named; the others stand.
local plot = require "quat.plot"
local root, out, bench, native_bench, runner, mode = arg[1], arg[2], arg[3], arg[4], arg[5], arg[6]
local parts = dofile(root .. "/bench/parts.lua")
local quick = mode == "quick"
local chosen = {}
local names = { "examples" }
for _, part in ipairs(parts) do names[#names + 1] = part.name end
local known = " " .. table.concat(names, " ") .. " "
for i = 7, #arg do
  if not known:find(" " .. arg[i] .. " ", 1, true) then error(("report: no part '%s'; there are:%s"):format(arg[i], known), 0) end
  chosen[arg[i]] = true
end
local all = next(chosen) == nil

-- Seconds that a part may take on a machine of its own; of the examples, together with their reference's. On one that is busy with
-- other work ten times as many may pass. (A limit of CPU time would make the clock of CPU time as coarse as the kernel's ticks.)
local part_time, example_time = quick and 30 or 120, quick and 0.3 or 20
local function within(seconds, command) return ("timeout %d %s"):format(math.ceil(10 * seconds), command) end
local out_of_time = { [124] = true } -- timeout's own

local function quote(text) return "'" .. text:gsub("'", "'\\''") .. "'" end

local function shell(command)
  local pipe = assert(io.popen(command, "r"))
  local text = pipe:read "a"
  local good, _, code = pipe:close()
  return text, good, code
end

local function read(path)
  local file = io.open(path, "rb")
  if not file then return nil end
  local text = file:read "a"
  file:close()
  return text
end

local function write(path, text)
  local file = assert(io.open(path, "wb"))
  file:write(text)
  file:close()
end

--- CPU time of the programs that have been run, s; nil where the system does not tell.
local function spent()
  local ticks, fields = read "/proc/self/stat", {} -- in hundredths of a second
  for word in (ticks or ""):gsub("^.*%) ", ""):gmatch "%S+" do fields[#fields + 1] = word end
  return ticks and (tonumber(fields[14]) + tonumber(fields[15])) / 100
end

local function escape(text) return (tostring(text):gsub("[&<>]", { ["&"] = "&amp;", ["<"] = "&lt;", [">"] = "&gt;" })) end

local letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"
local function base64(data)
  local list = {}
  for i = 1, #data, 3 do
    local a, b, c = data:byte(i, i + 2)
    local n = a << 16 | (b or 0) << 8 | (c or 0)
    for k = 0, 3 do
      local place = (n >> (18 - 6 * k) & 63) + 1
      list[#list + 1] = (k == 2 and not b or k == 3 and not c) and "=" or letters:sub(place, place)
    end
  end
  return table.concat(list)
end

--- NAME.png of the output folder as a picture of the page; "" when there is none.
local function picture(name)
  local data = read(out .. "/" .. name .. ".png")
  return data and ('<img alt="%s" src="data:image/png;base64,%s">\n'):format(escape(name), base64(data)) or ""
end

local body, contents, failed = {}, {}, {} -- the page, its sections, what is missing
local function add(text) body[#body + 1] = text end
local function section(name, title, says)
  contents[#contents + 1] = ('<a href="#%s">%s</a>'):format(name, escape(title))
  add(('<h2 id="%s">%s</h2>\n<p>%s</p>\n'):format(name, escape(title), escape(says)))
end

--- The sections of a CSV text, each a list of lines; remarks apart.
local function sections_of(text)
  local list, remarks, now = {}, {}, nil
  for line in (text .. "\n"):gmatch "(.-)\r?\n" do
    if line == "" then now = nil
    elseif line:find "^#" then remarks[#remarks + 1] = line
    elseif now then now[#now + 1] = line
    else
      now = { line }
      list[#list + 1] = now
    end
  end
  return list, remarks
end

local function cells_of(line)
  local cells = {}
  for cell in (line .. ","):gmatch "([^,]*)," do cells[#cells + 1] = cell end
  return cells
end

local function html_table(lines)
  add "<details><summary>table</summary><table>\n"
  for i, line in ipairs(lines) do
    local tag = i == 1 and "th" or "td"
    local cells = cells_of(line)
    for k, cell in ipairs(cells) do cells[k] = ("<%s>%s</%s>"):format(tag, escape(cell), tag) end
    add("<tr>" .. table.concat(cells) .. "</tr>\n")
  end
  add "</table></details>\n"
end

local palette = { "blue", "red", "green", "orange", "purple", "teal", "grey", "dark" }

--- The rows of a part, each by its columns' names, in order; and the header.
local function rows_of(part, lines)
  local header, rows = cells_of(lines[1]), {}
  for i = 2, #lines do
    local row, fits = { line = lines[i] }, true
    for k, cell in ipairs(cells_of(lines[i])) do row[header[k]] = cell end
    for column, pattern in pairs(part.rows or {}) do fits = fits and (row[column] or ""):find(pattern) ~= nil end
    for column, pattern in pairs(part.without or {}) do fits = fits and not (row[column] or ""):find(pattern) end
    if fits then rows[#rows + 1] = row end
  end
  return rows, header
end

--- A panel of points, a colour for what the column `curve` says; nil where there is none.
local function panel_of(part, rows, title)
  local by, order = {}, {}
  for _, row in ipairs(rows) do
    local x, y, who = tonumber(row[part.time]), tonumber(row[part.error]), part.curve and row[part.curve] or part.program
    if x and y and x > 0 and y > 0 then
      if not by[who] then
        by[who] = { {}, {} }
        order[#order + 1] = who
      end
      table.insert(by[who][1], x)
      table.insert(by[who][2], y * (part.unit or 1))
    end
  end
  local panel = { title = title, xlabel = part.axes and part.axes[1] or "time, " .. part.time, ylabel = part.axes and part.axes[2] or "error, " .. part.error,
    xlog = true, ylog = true, legend = "top right" }
  for i, who in ipairs(order) do
    panel[#panel + 1] = plot.points { by[who][1], by[who][2], color = palette[(i - 1) % #palette + 1], label = who, shape = i > #palette and "square" or "dot" }
  end
  return #panel > 0 and plot.panel(panel) or nil
end

--- Error against time: one panel, or one for each of the values of a column.
local function draw(part, rows)
  if not part.time or not part.error then return false end
  local panels = {}
  for i = 2, #(part.panels or {}) do
    local own = {}
    for _, row in ipairs(rows) do if row[part.panels[1]] == part.panels[i] then own[#own + 1] = row end end
    panels[#panels + 1] = panel_of(part, own, part.panels[1] .. " " .. part.panels[i])
  end
  if not part.panels then panels[1] = panel_of(part, rows, part.title) end
  if #panels == 0 then return false end
  local columns = #panels > 1 and 2 or 1
  local deep = math.ceil(#panels / columns)
  panels.size, panels.grid = { columns == 1 and 900 or 1300, columns == 1 and 620 or 480 * deep }, { columns, deep }
  return plot.save(plot.figure(panels), part.name)
end

--- The least time of the rows, of ours or of the others, that err by no more than the goal; and whose it is.
local function least(part, rows, ours, goal)
  local best, who
  for _, row in ipairs(rows) do
    local time, error = tonumber(row[part.time]), tonumber(row[part.error])
    if (part.own[row[part.curve]] or false) == ours and time and error and error * (part.unit or 1) <= goal and (not best or time < best) then
      best, who = time, row[part.curve]
    end
  end
  return best, who
end

-- The bars: ours ten times faster than what reaches 1e-9, and no slower than anything at 1e-6; of rotations no slower than the best
-- peer; of crowds than the textbook's program.
local bars = {
  errors = function(part, rows, say)
    for _, goal in ipairs { { 1e-9, 10 }, { 1e-6, 1 } } do
      local own, other, who = least(part, rows, true, goal[1]), least(part, rows, false, goal[1])
      if other and not own then say(("no row of ours reaches %g; %s does"):format(goal[1], who))
      elseif other and other < goal[2] * own then
        say(("%s reaches %g in %.2g of our time%s"):format(who, goal[1], other / own, goal[2] > 1 and " (the bar is 10)" or ""))
      end
    end
  end,
  peers = function(part, rows, say)
    local own, double = least(part, rows, true, math.huge), {}
    for _, row in ipairs(rows) do if row.type == "double" and not row.library:find "^libquat" then double[#double + 1] = row end end
    local other, who = least(part, double, false, math.huge)
    if not own or not other or own <= other then return end
    local spread = 1
    for _, row in ipairs(rows) do spread = math.max(spread, tonumber(row.spread) or 1) end
    say(("%s takes %.2g of our time%s"):format(who, other / own, own <= spread * other and (", which the rounds' spread of %.2f may be"):format(spread) or ""))
  end,
  crowd = function(part, rows, say)
    local time = { time = "us_per_event", error = "us_per_event", own = part.own, curve = part.curve }
    local own, other, who = least(time, rows, true, math.huge), least(time, rows, false, math.huge)
    if own and other and other < own then say(("%s takes %.2g of our time"):format(who, other / own)) end
  end,
}

local missed = {}

--- Rows that miss the part's bar, in words.
local function judge(part, rows, build)
  if not part.rule then return end
  local groups, order, words = {}, {}, {}
  for _, row in ipairs(rows) do
    local key = {}
    for _, column in ipairs(part.group) do key[#key + 1] = row[column] end
    key = table.concat(key, " ")
    if not groups[key] then
      groups[key] = {}
      order[#order + 1] = key
    end
    table.insert(groups[key], row)
  end
  for _, key in ipairs(order) do
    bars[part.rule](part, groups[key], function(what) words[#words + 1] = (key ~= "" and key .. ": " or "") .. what .. build end)
  end
  for _, word in ipairs(words) do missed[#missed + 1] = escape(part.title .. ": " .. word) end
  return words
end

local started = os.time()
local kept = {} -- of each program its output, or why there is none

local function run_program(folder, part, file)
  local key = folder .. "/" .. part.program
  if kept[key] then return kept[key] end
  local got = { text = "" }
  kept[key] = got
  if not read(key) then
    got.why = part.program .. " is not built"
    return got
  end
  local code
  got.text, got.good, code = shell(("%sOUT=%s; export OUT; %s 2>/dev/null </dev/null"):format(quick and "BENCH_QUICK=1; export BENCH_QUICK; " or "", quote(out),
    within(part_time, quote(key))))
  write(out .. "/" .. file .. ".csv", got.text)
  if not got.good then
    got.why = part.program .. (out_of_time[code] and (" did not end in %d s: the rows it came to"):format(10 * part_time) or " failed")
  end
  return got
end

--- Names of a row: its first columns.
local function name_of(line, names) return table.concat(cells_of(line), ",", 1, names) end

--- The column of times again, by the program built for this machine's processor.
local function add_native(part, lines, header, native)
  local place
  local column = part.measured or part.time
  for i, name in ipairs(header) do if name == column then place = i end end
  if not place or not native then return end
  local times = {}
  for i = 2, #native do times[name_of(native[i], part.names)] = cells_of(native[i])[place] end
  lines[1] = lines[1] .. "," .. column .. " -march=native"
  for i = 2, #lines do lines[i] = lines[i] .. "," .. (times[name_of(lines[i], part.names)] or "") end
end

--- A star behind a number over ten times that of the row before, of the same name.
local function star(lines, header, by, column)
  local name, place
  for i, word in ipairs(header) do
    if word == by then name = i elseif word == column then place = i end
  end
  local before
  for i = 2, #lines do
    local cells = cells_of(lines[i])
    local value = tonumber(cells[place])
    if before and before[name] == cells[name] and value and tonumber(before[place]) and value > 10 * tonumber(before[place]) then
      before = { table.unpack(cells) }
      cells[place] = cells[place] .. "*"
      lines[i] = table.concat(cells, ",")
    else
      before = cells
    end
  end
end

local function fail(part, why)
  if not why then return end
  failed[#failed + 1] = part.name .. ": " .. why
  add("<p class=absent>" .. escape(why) .. "</p>\n")
end

local function run_part(part)
  local began = os.time()
  section(part.name, part.title, part.says)
  local got = run_program(bench, part, part.program)
  fail(part, got.why)
  local sections, remarks = sections_of(got.text)
  local lines = sections[part.section or 1]
  for _, remark in ipairs(remarks) do add("<p class=absent>" .. escape(remark:sub(3)) .. "</p>\n") end
  if lines then
    local rows, header = rows_of(part, lines)
    local words = judge(part, rows, "")
    local table_lines = { lines[1] }
    for _, row in ipairs(rows) do table_lines[#table_lines + 1] = row.line end
    if part.native and native_bench ~= "" and not (quick and part.native == "full") then
      local again = run_program(native_bench, part, part.program .. "_native")
      local native = sections_of(again.text)[part.section or 1]
      fail(part, again.why)
      if native then
        for _, word in ipairs(judge(part, (rows_of(part, native)), " (both with -march=native)") or {}) do words[#words + 1] = word end
        add_native(part, table_lines, header, native)
      end
    end
    if part.slower then star(table_lines, header, part.slower[1], part.slower[2]) end
    if draw(part, rows) then add(picture(part.name)) end
    if words and #words > 0 then add("<p>Below the bar: " .. escape(table.concat(words, "; ")) .. ".</p>\n")
    elseif words then add "<p>No row is below its bar.</p>\n" end
    html_table(table_lines)
    if not part.section and not part.rows then for i = 2, #sections do html_table(sections[i]) end end
  end
  add(("<p class=foot>%s, %d s</p>\n"):format(escape(part.program), os.time() - began))
  print(("%-16s %4d s"):format(part.name, os.time() - began))
end

local function examples()
  local list = {}
  for path in shell("ls " .. quote(root .. "/examples/scenes") .. "/*.lua"):gmatch "[^\n]+" do list[#list + 1] = path end
  return list
end

--- What a report's text says, in cells: how sure the reference is, the least error of the default and its ms, and what falls short.
local function facts_of(text, good)
  if not good then return { "-", "-", "-", (text:gsub("^impact: ", ""):gsub("%s+$", "")) } end
  local sure, worst = text:match "sure to ([^\n]-) by ", nil
  for number in (sure or ""):gsub(", [^,]- s %(events%)", ""):gmatch "%d[%de.+-]*" do worst = math.max(worst or 0, tonumber(number)) end
  local best, ms = text:match "verdict     default: (.-) in (%S+) ms"
  local words = {}
  for miss in text:gmatch "\n  missed      ([^\n]+)" do words[#words + 1] = miss end
  if not sure then words[#words + 1] = text:match "certainty unknown: ([^\n]+)" end
  local horizon = text:match "until t = ([%d.e+-]+) s: then"
  if horizon then words[#words + 1] = "compared until " .. horizon .. " s" end
  if text:find "\n  dropped" then words[#words + 1] = text:match "\n  dropped     (%d+ settings)" .. " had no time" end
  return { worst and ("%.0e"):format(worst) or "unknown", best or "-", ms or "-", #words > 0 and table.concat(words, "; ") or "none" }
end

local function line_of(cells)
  local safe = {}
  for i, cell in ipairs(cells) do safe[i] = tostring(cell):gsub(",", ";") end
  return table.concat(safe, ",")
end

--- The report of one example: into the page, its facts as a line of CSV.
local function report_example(path, name)
  local before = spent()
  local text, good = shell(within(2 * example_time + 10, ("%s %s --report --seconds %g --out %s"):format(quote(runner), quote(path), example_time, quote(out))) ..
    " 2>&1 </dev/null")
  local taken = before and ("%.1f"):format(spent() - before) or "-"
  if not good then failed[#failed + 1] = name .. ": " .. text:gsub("%s+$", "") end
  add(("<h3>%s</h3>\n<pre>%s</pre>\n"):format(escape(name), escape(text)))
  if good then add(picture(name .. "_report")) end
  local facts = facts_of(text, good)
  print(("  %-22s%8s s%10s%12s%10s  %s"):format(name, taken, facts[1], facts[2], facts[3], facts[4]))
  return line_of { name, taken, table.unpack(facts) }
end

local function run_examples()
  local began, examined = os.time(), examples()
  section("scenes", "Example scenes by every method", ("`impact SCRIPT --report --seconds %g` of each: the reference and who vouches for it, ms to reach an error, what was missed.")
    :format(example_time))
  local reports, used = { "scene,cpu_s,sure_to,default_error,default_ms,short" }, { (shell(("%s --trust --quiet %s -- names"):format(quote(runner), quote(root .. "/bench/used.lua"))):gsub("%s+$", "")) }
  print(("  %-22s%10s%10s%12s%10s  %s"):format("scene", "CPU", "sure to", "default's", "ms", "what falls short"))
  for _, path in ipairs(examined) do reports[#reports + 1] = report_example(path, path:match "([^/]+)%.lua$") end
  for _, path in ipairs(examined) do
    local row = shell(within(60, ("%s --trust --quiet %s -- %s"):format(quote(runner), quote(root .. "/bench/used.lua"), quote(path))) .. " 2>/dev/null"):gsub("%s+$", "")
    if row ~= "" then used[#used + 1] = row else failed[#failed + 1] = "used.lua: " .. path:match "([^/]+)%.lua$" end
  end
  write(out .. "/scenes.csv", table.concat(reports, "\n") .. "\n")
  write(out .. "/used.csv", table.concat(used, "\n") .. "\n")
  add "<h3>All of them</h3>\n<p>CPU time of the report, how sure its reference is, the default's least error and its ms, and what falls short.</p>\n"
  html_table(reports)
  section("used", "What each example uses", "Counters of its run; modules and libraries that the process has loaded beside the runner's own; how often its scene asked for memory, and the most it used; the process' memory; CPU time to the scene's being made and of its run.")
  html_table(used)
  print(("%-16s %4d s"):format("scenes", os.time() - began))
end

for _, part in ipairs(parts) do
  if chosen[part.name] or all then run_part(part) end
end
if all or chosen.examples then run_examples() end

local function fact(command) return (shell(command .. " 2>/dev/null"):gsub("%s+$", "")) end
local machine = {
  fact "grep -m1 'model name' /proc/cpuinfo | cut -d: -f2", fact "uname -srm", fact(quote(runner) .. " --version"), fact "date -u +%Y-%m-%d",
  fact("$(grep -h CMAKE_C_COMPILER: " .. quote(bench .. "/../CMakeCache.txt") .. " | cut -d= -f2) --version | head -1"),
}
local style = [[body{font:15px/1.5 system-ui,sans-serif;max-width:62em;margin:2em auto;padding:0 1em;color:#1a202c}
table{border-collapse:collapse;font-size:12px}td,th{border:1px solid #e2e8f0;padding:1px 6px;text-align:right}td:first-child,th:first-child{text-align:left}
pre{overflow-x:auto;background:#f7fafc;padding:.6em;font-size:12px}img{max-width:100%}.foot,.absent{color:#718096}nav a{margin-right:1em}]]
local head = ('<!doctype html><html lang=en><meta charset=utf-8><title>Error against run time</title><style>%s</style>\n<h1>Error against run time</h1>\n<p>%s</p>\n')
  :format(style, escape(table.concat(machine, "; ")))
local missing = #failed == 0 and "" or "<p class=absent>Missing: " .. escape(table.concat(failed, "; ")) .. "</p>\n"
local left = quick and "<p>Quick: fewer samples, shorter motions.</p>\n" or ""
local bar = #missed == 0 and "" or "<details><summary>" .. #missed .. " rows below their bar</summary><ul>\n<li>" ..
  table.concat(missed, "</li>\n<li>") .. "</li></ul></details>\n"
write(out .. "/index.html", head .. "<nav>" .. table.concat(contents, " ") .. "</nav>\n" .. missing .. left .. bar .. table.concat(body) .. "</html>\n")
local cpu = spent()
print(("-> %s/index.html, %d s%s%s"):format(out, os.time() - started, cpu and (", of CPU %.0f s"):format(cpu) or "", #failed > 0 and "; missing: " .. table.concat(failed, "; ") or ""))
