-- SPDX-License-Identifier: MIT
--- Branch coverage out of gcov's text: coverage.lua BUILD [FILE]: a line for each file of the libraries and the runner, and
--- totals; with FILE the lines of it that have a branch no test takes. Status 1 below the bar.
---
--- Counted are the branches of gcc's flow graph at -O1, as `gcov -b` has them: two for each condition, && and || apart, one
--- for each case of a switch. A function inlined in several places counts once: a branch is taken where any of them takes it.
--- Left out: the inline functions of public headers, of which gcc counts the one copy that is a symbol and not those that
--- run, and lines marked "unreachable" with the reason beside.
local build, wanted = arg[1], arg[2]
local bar = 95

local rooms = { { "libquat", "/(libquat/[%w_/%.]+)$" }, { "libimpact", "/(libimpact/[%w_/%.]+)$" }, { "runner", "/(lua/runner/[%w_/%.]+)$" } }

local function room_of(path)
  if path:find "/build/" or path:find "/include/" then return end
  for _, room in ipairs(rooms) do
    local file = path:match(room[2])
    if file then return room[1], file end
  end
end

-- taken[file][line][k]: whether any test takes branch k of the line.
local taken, where, text = {}, {}, {}

local function read_report(pipe)
  local file, line, k
  for row in pipe:lines() do
    local source = row:match "^%s*%-:%s*0:Source:(.*)$"
    if source then
      local room, name = room_of(source)
      file = name
      if file then
        where[file] = room
        taken[file], text[file] = taken[file] or {}, text[file] or {}
      end
    elseif file then
      local number, code = row:match "^%s*[%d#=%-%*]+:%s*(%d+):(.*)$"
      if number then
        line, k = tonumber(number), 0
        text[file][line] = code
      else
        local count = row:match "^branch%s+%d+ taken (%d+)" or row:match "^branch%s+%d+ never executed" and "0"
        if count and not text[file][line]:find "unreachable" then
          k = k + 1
          local branches = taken[file][line] or {}
          taken[file][line] = branches
          branches[k] = branches[k] or tonumber(count) > 0
        end
      end
    end
  end
end

local list = assert(io.popen(string.format("find '%s' -name '*.gcda'", build)))
for data in list:lines() do
  if data:find "/lib" or data:find "impact_runner" then
    local pipe = assert(io.popen(string.format("cd '%s' && gcov -b -c -t '%s' 2>/dev/null", build, data)))
    read_report(pipe)
    pipe:close()
  end
end
list:close()

local files, sums = {}, {}
for file in pairs(taken) do files[#files + 1] = file end
table.sort(files)
for _, file in ipairs(files) do
  local all, some = 0, 0
  for line, branches in pairs(taken[file]) do
    for k, is in ipairs(branches) do
      all, some = all + 1, some + (is and 1 or 0)
      if file == wanted and not is then print(string.format("%s:%d: branch %d: %s", file, line, k, text[file][line])) end
    end
  end
  local sum = sums[where[file]] or { 0, 0 }
  sums[where[file]] = { sum[1] + some, sum[2] + all }
  if not wanted and all > 0 then print(string.format("%6.1f %%  %5d of %5d  %s", 100 * some / all, some, all, file)) end
end
local good, some, all = true, 0, 0
for _, room in ipairs(rooms) do
  local sum = sums[room[1]] or { 0, 0 }
  some, all = some + sum[1], all + sum[2]
  good = good and sum[1] >= bar / 100 * sum[2]
  if not wanted then print(string.format("%6.1f %%  %5d of %5d  %s", 100 * sum[1] / math.max(sum[2], 1), sum[1], sum[2], room[1])) end
end
if not wanted then print(string.format("%6.1f %%  %5d of %5d  in all; the bar is %d %% of each", 100 * some / math.max(all, 1), some, all, bar)) end
os.exit((wanted or good) and 0 or 1)
