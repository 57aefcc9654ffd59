-- SPDX-License-Identifier: MIT
-- reference.lua SOURCE OUT: the whole interface as pages, from the headers' comments and the Lua layers' annotations: a page for each
-- header and each layer, and an index of every name. `./run site` puts them beside the pages of docs/; docs.exported and lua.reference
-- hold the index, both ways, to what the libraries show and to what a script finds.
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
  text = text:gsub("%s*__attribute__%s*%b()", "")
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

local index = {} -- { name = as shown, id = its anchor, page =, header = }

-- Classes that stand for a module's table, by the name a script has for them.
local public = { impactlib = "impact", quatlib = "quat", curvelib = "quat.curve", surfacelib = "quat.surface" }

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
        local shown = item.name .. (item.text:find "^typedef" and "" or "()")
        index[#index + 1] = { name = shown, id = item.name, page = anchor, header = title }
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

-- ---- a layer's annotations ----

-- A page of one layer: the opening, classes with their fields, and functions that the layer itself defines, each with what is said
-- before it. What a local function says stays out.
local function layer_page(path, module, called)
  local anchor = "lua_" .. module:gsub("%.", "_") .. ".md"
  local lines, said, parameters = { ("# Lua: `require \"%s\"`"):format(module), "" }, {}, {}
  local class, table_open, kind -- of the class that is open, and of a value: ---@type
  local owners, opening = {}, true -- whose functions a local table holds

  local function add(...)
    for _, line in ipairs { ... } do lines[#lines + 1] = line end
  end
  local function clear() said, parameters, kind = {}, {}, nil end
  local function entry(owner, name, is_method, is_function)
    local id = owner .. "." .. name
    local shown = owner .. (is_method and ":" or ".") .. name .. (is_function and "()" or "")
    index[#index + 1] = { name = shown, id = id, page = anchor, header = module }
    return id, shown
  end
  local function cell(text) return (text:gsub("|", "\\|")) end

  local function open_class(name, words)
    class, table_open = public[name] or name, false
    add("", ("## `%s`"):format(class), "")
    if #said > 0 then add(table.concat(said, "\n"), "") end
    if words ~= "" then add(words, "") end
    clear()
  end
  local function field(name, rest)
    if not table_open then add("| name | |", "|---|---|") end
    table_open = true
    local type_text, words = rest:match "^(.-)%s%s+(.*)$"
    type_text = type_text or rest
    local id = entry(class, (name:gsub("%?$", "")), type_text:find "^%(?fun%(self", type_text:find "^%(?fun%(")
    add(("| `%s`{ #%s } | `%s` %s|"):format(name, id, cell(type_text), words and cell(words) .. " " or ""))
  end
  local function defined(owner, separator, name, arguments)
    local id, shown = entry(owner, name, separator == ":", true)
    add("", ("### `%s` { #%s }"):format(arguments and shown:sub(1, -3) .. arguments or shown, id), "")
    if #said > 0 then add(table.concat(said, "\n"), "") end
    if kind then add(("`%s`"):format(kind), "") end
    if #parameters > 0 then add("| | |", "|---|---|", table.concat(parameters, "\n"), "") end
    class = nil
    clear()
  end
  local function note(mark, rest)
    local name, type_text, words
    if mark == "param" then
      name, rest = rest:match "^(%S+)%s+(.*)$"
    end
    type_text, words = rest:match "^(.-)%s%s+(.*)$"
    parameters[#parameters + 1] = ("| %s | `%s` %s |"):format(name and "`" .. name .. "`" or "gives", cell(type_text or rest), cell(words or ""))
  end

  local text = read(path)
  local returned = text:match "\nreturn ([%w_]+)%s*$"
  if returned then owners[returned] = called or module end
  for line in text:gmatch "([^\n]*)\n" do
    local mark, rest = line:match "^%-%-%-@(%w+)%s+(.*)$"
    local words = line:match "^%-%-%- ?(.*)$"
    local table_name, separator, name, arguments = line:match "^function ([%w_]+)([.:])([%w_]+)(%b())"
    if not table_name then table_name, name = line:match "^([%w_]+)%.([%w_]+) = " end
    if mark == "class" then
      open_class(rest:match "^([%w_.]+)", rest:match "%s%s+(.*)$" or "")
    elseif mark == "field" and class then
      field(rest:match "^(%S+)%s+(.*)$")
    elseif mark == "alias" then
      add("", ("`%s`"):format(rest))
    elseif mark == "type" then
      kind = rest
    elseif mark == "param" or mark == "return" then
      note(mark, rest)
    elseif words and not mark then
      said[#said + 1] = words:gsub("^  ", "    ") -- code
    elseif table_name and owners[table_name] and (separator or kind) then
      defined(owners[table_name], separator, name, arguments)
    elseif not mark then
      local held = line:match "^local ([%w_]+) = "
      if held and class and not owners[held] then owners[held] = class end
      if opening and #said > 0 then add(table.concat(said, "\n"), "") end
      opening = opening and #said == 0
      class = nil
      clear()
    end
  end
  write(out .. "/" .. anchor, table.concat(lines, "\n") .. "\n")
  return anchor
end

-- ---- all pages ----

local pages = { "# Reference", "", "Every function, type and key, from the headers and the annotations of the Lua layers.", "" }
for _, library in ipairs { "quat", "impact" } do
  pages[#pages + 1] = ("\n## C: lib%s\n"):format(library)
  for _, path in ipairs(list(("%s/lib%s/include/%s/*.h"):format(source, library, library))) do
    local title = path:match "include/(.+)$"
    if not title:find "export%.h$" then pages[#pages + 1] = ("- [%s](%s)"):format(title, header_page(path, title)) end
  end
end
pages[#pages + 1] = "\n## Lua\n"
-- File, module, and what its functions are called where that is another: sweeps are made by those of impact.
for _, layer in ipairs { { "quat", "quat" }, { "plot", "quat.plot" }, { "csv", "quat.csv" }, { "impact", "impact" }, { "sweep", "impact.sweep", "impact" },
  { "report", "impact.report" }, { "verify", "impact.verify" }, { "portrait", "impact.portrait" }, { "sobol", "impact.sobol" } } do
  pages[#pages + 1] = ("- [%s](%s)"):format(layer[2], layer_page(("%s/lua/layer/%s.lua"):format(source, layer[1]), layer[2], layer[3]))
end
table.sort(index, function(a, b) if a.name ~= b.name then return a.name < b.name end return a.page < b.page end)
pages[#pages + 1] = "\n## Index\n"
for _, entry in ipairs(index) do
  pages[#pages + 1] = ("- [`%s`](%s#%s) (%s)"):format(entry.name, entry.page, entry.id, entry.header)
end
write(out .. "/index.md", table.concat(pages, "\n") .. "\n")
print(#index .. " names")
