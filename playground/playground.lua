-- SPDX-License-Identifier: MIT
--- Runs one script for a page: `require "playground" (name, source, values)` gives JSON,
---   { "summary": text, "figures": [{ "name", "figure" }], "files": { name: text }, "page": { ... } }
--- A script that returns a scene has it run and recorded; one that returns another table has that table handed on as "page", in which
--- `scene` is run and `figure` drawn. Its arguments are the values, by name, in the global table `values`.
local figures, files = {}, {}

package.loaded["quat.host"] = {
  write = function(name, text) files[name] = text return true end,
  save = function(figure, name) figures[#figures + 1] = { name = name, figure = figure } return true end,
}

local json = require("quat.page").json

local function numbers(lines)
  local values = {}
  for name, value in lines:gmatch "([%w_]+)=(%S+)" do values[name] = tonumber(value) end
  return values
end

local function bytes_of(path)
  local file = assert(io.open(path, "rb"))
  local bytes = file:read "a"
  file:close()
  return bytes
end

--- Runs and records, and makes the page of it; the closing words.
local function run(scene)
  local reason, message = scene:run { record = "playground.run" }
  if not reason then error(message, 0) end
  assert(scene:record():view "playground.html")
  keep(0, bytes_of "playground.run")
  keep(1, bytes_of "playground.html")
  return scene:summary(reason)
end

return function(name, source, lines)
  _G.values = numbers(lines)
  local chunk, wrong = load(source, "=" .. name, "t")
  if not chunk then error(wrong, 0) end
  local made = chunk(name)
  local answer = { figures = figures, files = files }
  if type(made) == "userdata" then
    answer.summary = run(made)
  elseif type(made) == "table" then
    if made.scene then answer.summary = run(made.scene) end
    if type(made.after) == "function" then made.number = made.after(made.scene) end
    made.scene, made.after = nil, nil
    answer.page = made
  end
  return json(answer)
end
