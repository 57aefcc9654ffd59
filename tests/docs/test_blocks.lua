-- SPDX-License-Identifier: MIT
-- test_blocks.lua SOURCE BUILD WORK CC SHELL PAGE ...: every fence of c, lua and sh in the pages is built and run as printed, and what it prints
-- is the text fence after it. A line before a fence may say:
--   <!-- block: continues -->   the fence goes on from the one before it
--   <!-- block: file NAME -->   the page asks the reader to save it so: later fences find it there
-- C links the shared libraries; Lua that returns a scene goes to the runner, other Lua to a stock interpreter. Of sh the line
-- `./run test` is left out: it is what runs this; SHELL = no-shell leaves out all.
local pages = require "pages"
local source, build, work, cc = arg[1], arg[2], arg[3], arg[4]

local function quote(text) return "'" .. text:gsub("'", "'\\''") .. "'" end

local function write(path, text)
  local file = assert(io.open(path, "wb"))
  file:write(text)
  file:close()
end

-- The fences of a page: language, text, first line, and what the line before asks for.
local function fences(page)
  local found, open, said, number = {}, nil, nil, 0
  for line in pages.read(page):gmatch "([^\n]*)\n" do
    number = number + 1
    local language = line:match "^```(%w*)$"
    if open and line == "```" then
      found[#found + 1], open = open, nil
    elseif open then
      open.text = open.text .. line .. "\n"
    elseif language then
      open, said = { language = language, text = "", line = number, said = said }, nil
    else
      said = line:match "^<!%-%- block: (.-) %-%->$"
    end
  end
  assert(not open, page .. ": a fence is not closed")
  return found
end

-- Runs a shell command in a folder; its status and all it printed.
local function run(folder, command)
  local pipe = assert(io.popen(("cd %s && { %s ; } 2>&1 </dev/null"):format(quote(folder), command)))
  local text = pipe:read "a"
  return pipe:close() == true, text
end

local libraries = build .. "/libimpact:" .. build .. "/libquat"

local function run_c(folder, name, text)
  write(folder .. "/" .. name, text)
  local flags = "-std=gnu11 -Wall -Wextra -Werror -Wno-unused-parameter -Wno-unused-variable -ffp-contract=off"
  for _, directory in ipairs { "/libquat", "/libimpact" } do
    flags = flags .. " -I" .. quote(source .. directory .. "/include") .. " -L" .. quote(build .. directory)
  end
  local gsl = text:find "<quat/curve" or text:find "<quat/surface" or text:find "<quat/family"
  return run(folder, ("%s %s %s -o %s -Wl,--as-needed %s -limpact -lquat -lm && LD_LIBRARY_PATH=%s ./%s"):format(
    cc, flags, quote(name), quote(name:gsub("%.c$", "")), gsl and "-lquat_gsl" or "", quote(libraries), name:gsub("%.c$", "")))
end

local function run_lua(folder, name, text)
  write(folder .. "/" .. name, text)
  if text:find "\nreturn impact%.scene" then
    return run(folder, quote(build .. "/lua/impact") .. " " .. quote(name) .. " --out out")
  end
  return run(folder, ("LUA_PATH=%s LUA_CPATH=%s %s %s"):format(quote(build .. "/lua/modules/?.lua"),
    quote(build .. "/lua/modules/?.so"), quote(arg[-1]), quote(name)))
end

local function run_sh(folder, _, text)
  text = text:gsub("%./run test[^\n]*\n", "")
  write(folder .. "/block.sh", "set -eu\n" .. text)
  return run(folder, "HOME=" .. quote(folder) .. " bash block.sh")
end

local runners = { c = run_c, lua = run_lua, sh = arg[5] ~= "no-shell" and run_sh or nil }

-- Numbers agree to nine digits, or to those that are printed; all else to the letter.
local function agrees(printed, got)
  if printed == got then return true end
  local a, b = tonumber(printed), tonumber(got)
  if not a or not b then return false end
  return math.abs(a - b) <= 1e-9 * math.abs(a) or (math.abs(a) < 1e-15 and math.abs(b) < 1e-15)
end

local function words(text)
  local list = {}
  for word in text:gsub("[(),]", " %0 "):gmatch "%S+" do list[#list + 1] = word end
  return list
end

local function same(printed, got)
  local a, b = words(printed), words(got)
  for i = 1, math.max(#a, #b) do
    if not a[i] or not b[i] or not agrees(a[i], b[i]) then return false end
  end
  return true
end

local blocks, bad = 0, 0
local function complain(page, fence, what)
  io.write(("%s:%d: %s\n"):format(page, fence.line, what))
  bad = bad + 1
end

local function check_page(page)
  local folder = work .. "/" .. page:match "([^/]+)%.md$"
  os.execute("mkdir -p " .. quote(folder))
  os.execute(("ln -sfn %s %s/libquat-libimpact"):format(quote(source), quote(folder)))
  write(folder .. "/run", "#!/bin/sh\nexec " .. quote(source .. "/run") .. ' "$@"\n')
  os.execute("chmod +x " .. quote(folder .. "/run"))
  local list, before = fences(page), {}
  for i, fence in ipairs(list) do
    local runner = runners[fence.language]
    if runner then
      blocks = blocks + 1
      local text, shown = fence.text, ""
      if fence.said == "continues" then text, shown = before[fence.language].text .. text, before[fence.language].output end
      local name = fence.said and fence.said:match "^file (%S+)$" or ("block%d.%s"):format(i, fence.language)
      local ok, output = runner(folder, name, text)
      before[fence.language] = { text = text, output = output }
      if output:sub(1, #shown) == shown then output = output:sub(#shown + 1) end
      local after = list[i + 1]
      if not ok then
        complain(page, fence, "does not run:\n" .. output)
      elseif after and after.language == "text" and not same(after.text, output) then
        complain(page, fence, "prints\n" .. output .. "and not\n" .. after.text)
      elseif output ~= "" and not (after and after.language == "text") and fence.language ~= "sh" and not text:find "\nreturn impact%.scene" then
        complain(page, fence, "prints, and the page does not show it:\n" .. output)
      end
    end
  end
end

for i = 6, #arg do check_page(arg[i]) end
print(blocks .. " blocks")
os.exit(bad == 0 and blocks > 0)
