-- SPDX-License-Identifier: MIT
--- What the tests of the pages share: reading files, lists of them, tables, and complaints counted to the end.
local pages = { complaints = 0 }

--- Of a file; nil where there is none and it may be so.
function pages.lines(path)
  local file = io.open(path, "r")
  if not file then return end
  local list = {}
  for line in file:lines() do list[#list + 1] = line end
  file:close()
  return list
end

function pages.read(path)
  local file = assert(io.open(path, "rb"))
  local text = file:read "a"
  file:close()
  return text
end

--- The files that git knows, or without git those that find finds beside build/ and out/, by the patterns of Lua given.
function pages.list(root, pattern)
  local list = {}
  local pipe = assert(io.popen(string.format("cd '%s' && (git ls-files 2>/dev/null || find . -path ./build -prune -o -path ./out -prune -o -type f -print | sed 's|^./||')", root)))
  for name in pipe:lines() do
    if name:match(pattern) then list[#list + 1] = name end
  end
  pipe:close()
  table.sort(list)
  return list
end

--- The README and every page of docs/.
function pages.all(root)
  local list = pages.list(root, "^docs/[^/]+%.md$")
  table.insert(list, 1, "README.md")
  return list
end

--- The cells of a row of a table; "\|" stays in its cell.
function pages.cells(line)
  local row = {}
  for cell in line:gsub("\\|", "\1"):match("^|(.*)|%s*$"):gmatch("([^|]*)") do
    row[#row + 1] = cell:gsub("\1", "|"):match("^%s*(.-)%s*$")
  end
  return row
end

function pages.complain(format, ...)
  pages.complaints = pages.complaints + 1
  io.stderr:write(string.format(format, ...), "\n")
end

function pages.finish(format, ...)
  print(string.format(format, ...))
  os.exit(pages.complaints == 0 and 0 or 1)
end

return pages
