-- SPDX-License-Identifier: MIT
--- `./run report`: every part measured, each with its picture, and every example scene by every method, as one page.
---
---     page.lua ROOT OUT BENCH RUNNER quick|full [PART...]
---
--- Runs the programs of bench/parts.lua and reports of the examples, keeps their CSV in OUT, and writes OUT/index.html with pictures inline
--- and no script. A program that is missing, fails or does not end in its time is named; the others stand.
local plot = require "quat.plot"
local root, out, bench, runner, mode = arg[1], arg[2], arg[3], arg[4], arg[5]
local parts = dofile(root .. "/bench/parts.lua")
local quick = mode == "quick"
local chosen = {}
for i = 6, #arg do chosen[arg[i]] = true end
local all = next(chosen) == nil

-- Seconds of CPU that a part may take; of the examples, together with their reference's. On a machine that is busy with other work four
-- times as many may pass.
local part_time, example_time = quick and 30 or 180, quick and 0.8 or 20
local function within(seconds, command)
  return ("( ulimit -t %d; exec timeout %d %s )"):format(math.ceil(seconds), math.ceil(4 * seconds), command)
end
local out_of_time = { [124] = true, [152] = true, [137] = true } -- timeout's own, and the signals of the limit

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

local body, contents, failed = {}, {}, {}
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

--- Error against time, a colour for what the last naming column of a curve says.
local function draw(part, lines)
  local header = cells_of(lines[1])
  local place = {}
  for i, name in ipairs(header) do place[name] = i end
  local time, error = place[part.time or ""], place[part.error or ""]
  if not time or not error then return false end
  local by, order = {}, {}
  for i = 2, #lines do
    local cells = cells_of(lines[i])
    local x, y, who = tonumber(cells[time]), tonumber(cells[error]), part.curve and cells[part.curve] or part.program
    if x and y and x > 0 and y > 0 then
      if not by[who] then
        by[who] = { {}, {} }
        order[#order + 1] = who
      end
      table.insert(by[who][1], x)
      table.insert(by[who][2], y)
    end
  end
  local panel = { title = part.title, xlabel = part.axes and part.axes[1] or "time, " .. part.time, ylabel = part.axes and part.axes[2] or "error, " .. part.error, xlog = true, ylog = true, legend = "top right" }
  for i, who in ipairs(order) do
    panel[#panel + 1] = plot.points { by[who][1], by[who][2], color = palette[(i - 1) % #palette + 1], label = who,
      shape = i > #palette and "square" or "dot" }
  end
  if #panel == 0 then return false end
  return plot.save(plot.figure { size = { 900, 620 }, plot.panel(panel) }, part.name)
end

local started = os.time()

local function run_part(part)
  local began = os.time()
  local program = bench .. "/" .. part.program
  section(part.name, part.title, part.says)
  if not read(program) then
    failed[#failed + 1] = part.name .. ": " .. part.program .. " is not built"
    return add("<p class=absent>" .. escape(part.program) .. " is not built here.</p>\n")
  end
  local text, good, code = shell(("%sOUT=%s; export OUT; %s 2>/dev/null </dev/null"):format(quick and "BENCH_QUICK=1; export BENCH_QUICK; " or "", quote(out),
    within(part_time, quote(program))))
  write(out .. "/" .. part.name .. ".csv", text)
  if not good then
    local why = out_of_time[code] and ("did not end in %d s: the rows it came to"):format(part_time) or "failed"
    failed[#failed + 1] = part.name .. ": " .. why
    add("<p class=absent>" .. escape(part.program .. " " .. why) .. "</p>\n")
  end
  local sections, remarks = sections_of(text)
  for _, remark in ipairs(remarks) do add("<p>" .. escape(remark) .. "</p>\n") end
  for i, lines in ipairs(sections) do
    if i == 1 and draw(part, lines) then add(picture(part.name)) end
    html_table(lines)
  end
  add(("<p class=foot>%s, %d s</p>\n"):format(escape(part.program), os.time() - began))
  print(("%-12s %4d s"):format(part.name, os.time() - began))
end

local function examples()
  local list = {}
  for path in shell("ls " .. quote(root .. "/examples/scenes") .. "/*.lua"):gmatch "[^\n]+" do list[#list + 1] = path end
  return list
end

local used_names = "scene,flights,rolls,integrators,integrator_steps,gap_queries,impacts_closed,impacts_series,impacts_cvode,loaded,peak_kB,start_ms,run_ms"

local function run_examples()
  local began = os.time()
  section("scenes", "Example scenes by every method", ("`impact SCRIPT --report --seconds %g` of each: the reference and who vouches for it, ms to reach an error, what was missed.")
    :format(example_time))
  local lines = { used_names }
  for _, path in ipairs(examples()) do
    local name = path:match "([^/]+)%.lua$"
    local text, good = shell(within(2 * example_time + 10, ("%s %s --report --seconds %g --out %s"):format(quote(runner), quote(path), example_time, quote(out))) ..
      " 2>&1 </dev/null")
    if not good then failed[#failed + 1] = name .. ": " .. text:gsub("%s+$", "") end
    add(("<h3>%s</h3>\n<pre>%s</pre>\n"):format(escape(name), escape(text)))
    if good then add(picture(name .. "_report")) end
    local row = shell(within(60, ("%s --trust --quiet %s -- %s"):format(quote(runner), quote(root .. "/bench/used.lua"), quote(path))) .. " 2>/dev/null")
      :gsub("%s+$", "")
    lines[#lines + 1] = row ~= "" and row or name .. ",did not end in 60 s"
  end
  write(out .. "/used.csv", table.concat(lines, "\n") .. "\n")
  section("used", "What each example uses", "Counters of its run, libraries loaded by the process, memory, CPU time to the scene's being made and of its run.")
  html_table(lines)
  print(("%-12s %4d s"):format("scenes", os.time() - began))
end

for _, part in ipairs(parts) do
  if chosen[part.name] or (all and not (quick and part.slow)) then run_part(part) end
end
if all or chosen.scenes then run_examples() end

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
local left = quick and all and "<p>Quick: fewer samples; the slow parts (engines, cones, together, crowd, extreme) are left out.</p>\n" or ""
write(out .. "/index.html", head .. "<nav>" .. table.concat(contents, " ") .. "</nav>\n" .. missing .. left .. table.concat(body) .. "</html>\n")
print(("-> %s/index.html, %d s%s"):format(out, os.time() - started, #failed > 0 and "; missing: " .. table.concat(failed, "; ") or ""))
