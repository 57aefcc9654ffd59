-- SPDX-License-Identifier: MIT
--- docs/thesis.md: every equation, theorem, figure and listing of the thesis has a row, and the test each row names is there.
--- test_thesis.lua ROOT
local pages = require "pages"
local root = arg[1]

local files = {}
for _, name in ipairs(pages.list(root, "^tests/.*/test_[%w_]+%.%a+$")) do
  local base = name:match "[^/]+$"
  files[base] = (files[base] or "") .. pages.read(root .. "/" .. name)
end

local left, rows, section = {}, 0, nil
for line in pages.read(root .. "/docs/thesis.md"):gmatch "[^\n]+" do
  section = line:match "^## (.*)" or section
  if line:match "^|" and not line:match "^| *%-" and not line:match "held by" then
    local row = pages.cells(line)
    local held = row[#row]
    rows = rows + 1
    if held ~= "none" and held ~= "history" then
      local file, name = held:match "^`([%w_%.]+)`: ([%w_]+)$"
      if not file or not files[file] then pages.complain("no test file in the row '%s'", line)
      elseif not files[file]:find("%f[%w_]" .. name .. "%f[^%w_]") then pages.complain("%s has no %s", file, name) end
    end
    if section == "Where each lives" then left[#left + 1] = row[1] end
  end
end

-- "equations 34 to 37", "figures 7, 8 and 9", "listing D.2.1": what the first column names.
local named = {}
for _, cell in ipairs(left) do
  for kind, numbers in cell:gmatch "(%a+) ([%dD][%d%., andto]*)" do
    kind = kind:gsub("s$", "")
    local from, to = numbers:match "^(%d+) to (%d+)"
    for k = tonumber(from) or 1, tonumber(to) or 0 do named[kind .. " " .. k] = true end
    for number in numbers:gmatch "[D%d%.]*%d" do named[kind .. " " .. number] = true end
  end
end
local function wanted(kind, count)
  for k = 1, count do
    if not named[kind .. " " .. k] then pages.complain("docs/thesis.md: no row for %s %d", kind, k) end
  end
end
wanted("equation", 37)
wanted("theorem", 6)
wanted("figure", 16)
for _, listing in ipairs { "D.1", "D.1.1", "D.1.2", "D.1.3", "D.1.4", "D.1.5", "D.1.6", "D.2.1", "D.2.2", "D.2.3", "D.2.4" } do
  if not named["listing " .. listing] then pages.complain("docs/thesis.md: no row for listing %s", listing) end
end
pages.finish("docs/thesis.md: %d rows", rows)
