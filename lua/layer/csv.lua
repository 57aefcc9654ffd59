-- SPDX-License-Identifier: MIT
--- Columns of numbers as CSV files: `local csv = require "quat.csv"`.

local format, gsub, match, sub, concat = string.format, string.gsub, string.match, string.sub, table.concat
local error, ipairs, math, tonumber, type, pcall, require, io, os = error, ipairs, math, tonumber, type, pcall, require, io, os

local digits = require "quat.gnuplot".digits

local csv = {}

local function cell(value)
  if value ~= value then return "nan" end
  if type(value) == "number" then return digits(value) end
  local text = tostring(value)
  -- What a spreadsheet would take for a formula has an apostrophe before it, and so has what begins with one; a number is none.
  if text:find("^[=+@\t\r'-]") and not tonumber(text) then return '"\'' .. text:gsub('"', '""') .. '"' end
  if text:find('[,"\r\n]') or text:find "^#" then return '"' .. text:gsub('"', '""') .. '"' end
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

--- The quoted cell that begins at `at`, and what is behind it; `number` is the row's, for an error.
local function quoted_at(text, at, number)
  local parts = {}
  repeat
    local part, behind = match(text, '^"([^"]*)"()', at)
    if not part then error(format("csv: row %d has a quote without an end", number), 0) end
    parts[#parts + 1], at = part, behind
  until sub(text, at, at) ~= '"' -- a doubled quote stands for one
  if not match(text, "^[,\r\n]", at) and at <= #text then error(format("csv: row %d goes on behind a closing quote", number), 0) end
  return concat(parts, '"'), at
end

--- The cells of the row that begins at `at`, as text, and where the next line may begin.
local function cells_at(text, at, number)
  local cells, more = {}, true
  while more do
    if sub(text, at, at) == '"' then
      cells[#cells + 1], at = quoted_at(text, at, number)
    else
      cells[#cells + 1], at = match(text, "^([^,\r\n]*)()", at)
    end
    more = sub(text, at, at) == ","
    if more then at = at + 1 end
  end
  return cells, at
end

--- A cell without the apostrophe that keeps it from being a formula.
local function plain(text)
  return match(text, "^'([=+@\t\r'-].*)$") or text
end

local no_numbers = { nan = 0 / 0, ["-nan"] = 0 / 0, inf = math.huge, ["-inf"] = -math.huge }

--- A number whose point is a point: tonumber takes the locale's too.
local function number_in(text)
  return match(text, "^ *[%w.+-]+ *$") and tonumber(text) or no_numbers[text]
end

local function names_of(cells)
  local names, seen = {}, {}
  for i = 1, #cells do
    names[i] = plain(cells[i])
    if seen[names[i]] then error(format("csv: two columns have the name '%s'", names[i]), 0) end
    seen[names[i]] = true
  end
  return names
end

local function row_of(names, cells, number)
  if #cells ~= #names then error(format("csv: row %d has %d cells, the header has %d", number, #cells, #names), 0) end
  local row = {}
  for i, name in ipairs(names) do row[name] = number_in(cells[i]) or plain(cells[i]) end
  return row
end

local function read(text)
  local names, rows, cells = nil, {}, nil
  local at = match(text, "^\xEF\xBB\xBF()") or 1 -- a mark of UTF-8
  while true do
    at = match(text, "^[\r\n]*()", at)
    if at > #text then return rows end
    if sub(text, at, at) == "#" then
      at = match(text, "^[^\r\n]*()", at)
    else
      cells, at = cells_at(text, at, names and #rows + 1 or 0)
      if names then rows[#rows + 1] = row_of(names, cells, #rows + 1) else names = names_of(cells) end
    end
  end
end

--- The rows of a CSV text below its header, each a table by the header's names; what reads as a number is one, "nan", "inf" and "-inf"
--- too. Empty lines and those that begin with "#" are left out. A text that is no such table is an error: a row of more or fewer cells
--- than the header (row 0), two columns of one name, a quote without an end.
---@param text string
---@return table<string, number|string>[]
function csv.rows(text)
  if type(text) ~= "string" then error("csv: rows reads a text, got a " .. type(text), 2) end
  local good, rows = pcall(read, text)
  if not good then error(rows, 2) end
  return rows
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
