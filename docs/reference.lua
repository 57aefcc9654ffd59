-- SPDX-License-Identifier: MIT
-- reference.lua SOURCE OUT: the whole interface as pages, from the headers' comments and the Lua layers' annotations: a page for each
-- header and each layer, and an index of every name. `./run site` puts them beside the pages of docs/.
local source, out = arg[1], arg[2]

local function read(path)
  local file = assert(io.open(path, "rb"))
  local text = file:read "a"
  file:close()
  return text
end

local function write(path, text)
  local file = assert(io.open(path, "wb"))
  assert(file:write(text))
  assert(file:close())
end

local function list(pattern)
  local pipe = assert(io.popen("ls " .. pattern))
  local files = {}
  for line in pipe:lines() do files[#files + 1] = line end
  pipe:close()
  return files
end

-- The text of a comment, without its marks.
local function comment_text(comment)
  local text = comment:gsub("^/%*%s?", ""):gsub("%s*%*/$", ""):gsub("\n%s*%* ?", "\n")
  return (text:gsub("^%s+", ""):gsub("%s+$", ""))
end

-- What a C declaration begins with, up to the brace or semicolon that ends it: structs and enums whole, functions without their body.
local function declaration(text, at)
  local head = text:match("^[^;{]*[;{]", at)
  if not head then return nil end
  if head:sub(-1) == ";" then return head, at + #head end
  local body = text:match("^%b{}", at + #head - 1)
  if head:find "^typedef" then
    local tail = text:match("^[^;]*;", at + #head - 1 + #body)
    return head:sub(1, -2) .. body .. tail, at + #head - 1 + #body + #tail
  end
  return (head:sub(1, -2):gsub("%s+$", "")) .. ";", at + #head - 1 + #body
end

local function name_of(text)
  if text:find "^typedef" then
    return text:match "}%s*([%w_]+)%s*;$" or text:match "%(%s*%*?([%w_]+)%s*%)%s*%(" or text:match "([%w_]+)%(" or text:match "([%w_]+)%s*;$"
  end
  return text:match "([%w_]+)%s*%("
end

local marks = { "IMPACT_API ", "QUAT_API ", "QUAT_INLINE ", "IMPACT_INLINE " }
local function plain(text)
  for _, mark in ipairs(marks) do text = text:gsub("^" .. mark, "") end
  return text
end

-- The items of a header: { kind = "section"|"comment"|"code", ... } in order; neighbours without a blank line share a comment.
local function items(text)
  local found, at = {}, 1
  while at <= #text do
    local blank = text:match("^\n+", at)
    local comment = text:match("^/%*.-%*/", at)
    local line = text:match("^[^\n]*", at)
    if blank then
      if #blank > 1 then found[#found + 1] = { kind = "gap" } end
      at = at + #blank
    elseif comment then
      local section = comment:match "^/%* %-%-%-%- (.-) %-%-%-%- %*/$"
      found[#found + 1] = section and { kind = "section", text = section } or { kind = "comment", text = comment_text(comment) }
      at = at + #comment
      local after = text:match("^[ \t]+", at)
      at = at + (after and #after or 0)
    elseif line:find "^typedef" or line:find "^[%w_]+_API " or line:find "^[%w_]+_INLINE " then
      local code, next_at = declaration(text, at)
      found[#found + 1] = { kind = "code", text = plain(code), name = name_of(code) }
      at = next_at
    else -- the preprocessor, extern "C", and the like
      at = at + #line + (line == "" and 1 or 0)
    end
  end
  return found
end

local index = {}

local function header_page(path, title)
  local text = read(path)
  local lines = { "# " .. title, "" }
  local opening = text:match "^/%*.-%*/"
  lines[#lines + 1] = (comment_text(opening):gsub("^SPDX[^\n]*\n*", ""))
  lines[#lines + 1] = ""
  local anchor, pending = title:gsub("[/.]", "_") .. ".md", nil
  local code = {}
  local function flush()
    if #code == 0 then return end
    for _, item in ipairs(code) do
      if item.name then
        lines[#lines + 1] = ("### `%s` { #%s }"):format(item.name, item.name)
        index[#index + 1] = { name = item.name, page = anchor, header = title }
      end
    end
    lines[#lines + 1] = "\n```c"
    for _, item in ipairs(code) do lines[#lines + 1] = item.text end
    lines[#lines + 1] = "```\n"
    if pending then lines[#lines + 1] = pending .. "\n" end
    code = {}
  end
  for _, item in ipairs(items(text:sub(#opening + 1))) do
    if item.kind == "section" then
      flush()
      pending = nil
      lines[#lines + 1] = "## " .. item.text .. "\n"
    elseif item.kind == "comment" then
      flush()
      pending = item.text
    elseif item.kind == "gap" then
      flush()
      pending = nil
    else
      code[#code + 1] = item
    end
  end
  flush()
  write(out .. "/" .. anchor, table.concat(lines, "\n") .. "\n")
  return anchor
end

-- A layer's annotations: classes with their fields, and what is said before them.
local function layer_page(path, module)
  local lines, said, open = { ("# Lua: `require \"%s\"`"):format(module), "" }, {}, false
  local anchor = "lua_" .. module:gsub("%.", "_") .. ".md"
  for line in read(path):gmatch "[^\n]*" do
    local class, about = line:match "^%-%-%-@class%s+([%w_.%(%):, ]-)%s%s(.*)$"
    class = class or line:match "^%-%-%-@class%s+(.+)$"
    local field, rest = line:match "^%-%-%-@field%s+(%S+)%s+(.*)$"
    local alias = line:match "^%-%-%-@alias%s+(.*)$"
    if class then
      lines[#lines + 1] = ("\n## `%s`\n"):format(class)
      if #said > 0 then lines[#lines + 1] = table.concat(said, "\n") .. "\n" end
      if about then lines[#lines + 1] = about .. "\n" end
      lines[#lines + 1] = "| name | |\n|---|---|"
      said, open = {}, true
    elseif field and open then
      local kind, words = rest:match "^(.-)%s%s+(.*)$"
      lines[#lines + 1] = ("| `%s` | `%s` %s|"):format(field, (kind or rest):gsub("|", "\\|"), words and words:gsub("|", "\\|") .. " " or "")
      index[#index + 1] = { name = field:gsub("%?$", ""), page = anchor, header = module }
    elseif alias then
      lines[#lines + 1] = ("\n`%s`"):format(alias)
    else
      local text = line:match "^%-%-%- ?(.*)$"
      if text and not text:find "^@" then said[#said + 1] = text elseif not line:find "^%-%-%-" then
        if #said > 0 and not open then lines[#lines + 1] = table.concat(said, "\n") .. "\n" end
        said, open = {}, false
      end
    end
  end
  write(out .. "/" .. anchor, table.concat(lines, "\n") .. "\n")
  return anchor
end

local pages = { "# Reference", "", "Every function, type and key, from the headers and the annotations of the Lua layers.", "" }
for _, library in ipairs { "quat", "impact" } do
  pages[#pages + 1] = ("\n## C: lib%s\n"):format(library)
  for _, path in ipairs(list(("%s/lib%s/include/%s/*.h"):format(source, library, library))) do
    local title = path:match "include/(.+)$"
    if not title:find "export%.h$" then pages[#pages + 1] = ("- [%s](%s)"):format(title, header_page(path, title)) end
  end
end
pages[#pages + 1] = "\n## Lua\n"
for _, layer in ipairs { "quat", "impact", "plot=quat.plot", "csv=quat.csv", "portrait=impact.portrait", "sweep=impact.sweep" } do
  local file, module = layer:match "^(%w+)=(.+)$"
  module = module or layer
  pages[#pages + 1] = ("- [%s](%s)"):format(module, layer_page(("%s/lua/layer/%s.lua"):format(source, file or layer), module))
end
table.sort(index, function(a, b) if a.name ~= b.name then return a.name < b.name end return a.page < b.page end)
pages[#pages + 1] = "\n## Index\n"
for _, entry in ipairs(index) do
  pages[#pages + 1] = ("- [`%s`](%s#%s) (%s)"):format(entry.name, entry.page, entry.name:lower(), entry.header)
end
write(out .. "/index.md", table.concat(pages, "\n") .. "\n")
print(#index .. " names")
