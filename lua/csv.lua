-- SPDX-License-Identifier: MIT
--- Columns of numbers as CSV files: `local csv = require "quat.csv"`.

local format, concat = string.format, table.concat
local error, ipairs, type, pcall, require, io, os = error, ipairs, type, pcall, require, io, os

local csv = {}

local function cell(value)
  if type(value) == "number" then return format(math.type(value) == "integer" and "%d" or "%.17g", value) end
  local text = tostring(value)
  if text:find('[,"\r\n]') then return '"' .. text:gsub('"', '""') .. '"' end
  return text
end

--- The text of a CSV file: names is the header, columns the lists below it.
function csv.text(names, columns)
  if #names ~= #columns then error(format("csv: %d names for %d columns", #names, #columns), 2) end
  local lines = { concat(names, ",") }
  for i, column in ipairs(columns) do
    if #column ~= #columns[1] then
      error(format("csv: column '%s' has %d rows, '%s' has %d", names[i], #column, names[1], #columns[1]), 2)
    end
  end
  for row = 1, #columns[1] do
    local cells = {}
    for i = 1, #columns do cells[i] = cell(columns[i][row]) end
    lines[#lines + 1] = concat(cells, ",")
  end
  return concat(lines, "\n") .. "\n"
end

--- Writes the whole file or none: NAME is NAME.csv in the runner's output folder, or where the name says in a stock Lua.
--- true, or nil and why.
---@return true?, string?
function csv.save(name, names, columns)
  local text = csv.text(names, columns)
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
