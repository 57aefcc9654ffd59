-- SPDX-License-Identifier: MIT
--- Columns of numbers as CSV files: `local csv = require "quat.csv"`.

local format, gmatch, gsub, match, sub, concat = string.format, string.gmatch, string.gsub, string.match, string.sub, table.concat
local error, ipairs, tonumber, type, pcall, require, io, os = error, ipairs, tonumber, type, pcall, require, io, os

local csv = {}

local function cell(value)
  if value ~= value then return "nan" end
  if type(value) == "number" then return format(math.type(value) == "integer" and "%d" or "%.17g", value) end
  local text = tostring(value)
  -- What a spreadsheet would take for a formula has an apostrophe before it, and so has what begins with one; a number is none.
  if text:find("^[=+@\t\r'-]") and not tonumber(text) then return '"\'' .. text:gsub('"', '""') .. '"' end
  if text:find('[,"\r\n]') then return '"' .. text:gsub('"', '""') .. '"' end
  return text
end

--- The file's text; `level` is the stack level to blame.
local function text_of(names, columns, level)
  if type(names) ~= "table" or type(columns) ~= "table" then error("csv: a list of names and a list of columns are needed", level + 1) end
  if #names ~= #columns then error(format("csv: %d names for %d columns", #names, #columns), level + 1) end
  local header = {}
  for i, column in ipairs(columns) do
    header[i] = cell(names[i])
    if type(column) ~= "table" then error(format("csv: column '%s' must be a list, got a %s", names[i], type(column)), level + 1) end
    if #column ~= #columns[1] then
      error(format("csv: column '%s' has %d rows, '%s' has %d", names[i], #column, names[1], #columns[1]), level + 1)
    end
  end
  local lines = { concat(header, ",") }
  for row = 1, columns[1] and #columns[1] or 0 do
    local cells = {}
    for i = 1, #columns do cells[i] = cell(columns[i][row]) end
    lines[#lines + 1] = concat(cells, ",")
  end
  return concat(lines, "\n") .. "\n"
end

--- The text of a CSV file: names is the header, columns the lists below it.
---@param names string[]
---@param columns (number|string)[][]
---@return string
function csv.text(names, columns)
  local text = text_of(names, columns, 2) -- not a tail call: levels are counted
  return text
end

--- One line's cells, as text.
local function cells_of(line)
  local cells, at = {}, 1
  repeat
    local quoted, behind = match(line, '^"([^"]*)"()', at)
    while quoted and sub(line, behind, behind) == '"' do -- a doubled quote stands for one
      local more, next_behind = match(line, '^"([^"]*)"()', behind)
      if not more then break end
      quoted, behind = quoted .. '"' .. more, next_behind
    end
    if not quoted then quoted, behind = match(line, "^([^,]*)()", at) end
    cells[#cells + 1] = quoted
    at = sub(line, behind, behind) == "," and behind + 1 or nil
  until not at
  return cells
end

--- A cell without the apostrophe that keeps it from being a formula.
local function plain(text)
  return text and match(text, "^'([=+@\t\r'-].*)$") or text
end

--- The rows of a CSV text below its header, each a table by the header's names; what reads as a number is one, lines that begin with
--- "#" are left out. No cell may hold a line's end.
---@param text string
---@return table<string, number|string>[]
function csv.rows(text)
  if type(text) ~= "string" then error("csv: rows reads a text, got a " .. type(text), 2) end
  local names, rows
  for line in gmatch(text, "[^\r\n]+") do
    if sub(line, 1, 1) ~= "#" then
      local cells = cells_of(line)
      if not names then
        names = {}
        for i = 1, #cells do names[i] = plain(cells[i]) end
      else
        local row = {}
        for i, name in ipairs(names) do row[name] = tonumber(cells[i]) or plain(cells[i]) end
        rows[#rows + 1] = row
      end
      rows = rows or {}
    end
  end
  return rows or {}
end

--- Writes the whole file or none: NAME is NAME.csv in the runner's output folder, or where the name says in a stock Lua.
--- true, or nil and why.
---@param name string
---@param names string[]
---@param columns (number|string)[][]
---@return true?, string?
function csv.save(name, names, columns)
  if type(name) ~= "string" then error("csv: the file's name must be a string, got a " .. type(name), 2) end
  name = gsub(name, "%.csv$", "")
  local text = text_of(names, columns, 2)
  local hosted, host = pcall(require, "quat.host")
  if hosted and type(host) == "table" then return host.write(name .. ".csv", text) end
  local part, final = name .. ".csv.part", name .. ".csv"
  local file, why = io.open(part, "w")
  if not file then return nil, why end
  local good, problem = file:write(text)
  if not (file:close() and good) then
    os.remove(part)
    return nil, problem or "cannot write " .. part
  end
  return os.rename(part, final)
end

return csv
