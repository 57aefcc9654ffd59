-- SPDX-License-Identifier: MIT
--- Mutants: one change each to a rule or formula, which some test has to notice.
---
---   lua5.4 tests/mutants.lua make [SEED]                    prints a list: of every file below, the first so many candidates by
---                                                           the hash of seed, file and line
---   lua5.4 tests/mutants.lua run BUILD WORK PART PARTS [PATTERN]   tries tests/mutants.txt (those whose file matches): each is
---                                                           compiled alone, linked before the archive of BUILD, and run
---                                                           against the tests of its folder until one fails; of a header
---                                                           those sources are compiled that name what its line defines,
---                                                           or, where it defines nothing, that include it
---
--- A line of tests/mutants.txt: file, old line, new line, and, where it may survive, the reason: tabs between.
local root = arg[0]:match "^(.*)/tests/[^/]*$" or "."

-- Which tests run a file's lines: the quick ones first. Files that no pattern names have no mutants.
local rooms = {
  { "^libquat/src/average%.c$", { "quat_average" } }, { "^libquat/src/attitude%.c$", { "quat_average", "quat_rotation" } },
  { "^libquat/src/batch%.c$", { "quat_batch" } }, { "^libquat/src/dual%.c$", { "quat_dual" } },
  { "^libquat/src/euler%.c$", { "quat_euler" } }, { "^libquat/src/exponential%.c$", { "quat_exponential" } },
  { "^libquat/src/integrate%.c$", { "quat_integrate" } }, { "^libquat/src/interpolate%.c$", { "quat_interpolate" } },
  { "^libquat/src/jacobian%.c$", { "quat_jacobian", "quat_limits" } }, { "^libquat/src/project%.c$", { "quat_project" } },
  { "^libquat/src/quat%.c$", { "quat_quat" } }, { "^libquat/src/rotation%.c$", { "quat_rotation", "quat_limits" } },
  { "^libquat/src/sequence%.c$", { "quat_sequence" } }, { "^libquat/src/spline%.c$", { "quat_spline" } },
  { "^libimpact/src/shape/ridge", { "impact_ridge", "impact_apexes", "impact_scene_answers", "lua_faces_begin" } }, { "^libimpact/src/shape/", { "impact_support", "impact_shape", "impact_gap" } },
  { "^libimpact/src/flight/elliptic", { "impact_elliptic", "impact_tumble" } }, { "^libimpact/src/flight/", { "impact_flight", "impact_tumble" } },
  { "^libimpact/src/base/ode%.", { "impact_ode", "impact_ode_refusals" } },
  { "^libimpact/src/base/ode_", { "impact_ode_one_step", "impact_ode", "impact_ode_rk4", "impact_force", "impact_motion" } }, { "^libimpact/src/motion/key", { "impact_run", "impact_run_words" } },
  { "^libimpact/src/base/record%.c$", { "impact_record", "impact_memory" } }, { "^libimpact/src/gap/gap_strike", { "impact_gap", "impact_toi", "impact_motion" } },
  { "^lua/runner/runner_limits", { "lua_memory", "lua_ends" } }, { "^lua/runner/sweep", { "lua_command", "lua_sweep", "lua_ends" } },
  { "^lua/runner/runner_sandbox", { "lua_command", "lua_sandbox", "lua_ends" } }, { "^lua/runner/runner%.c$", { "lua_command", "lua_ends", "lua_sandbox", "lua_verify" } },
  { "^lua/runner/", { "lua_command", "lua_ends", "lua_sandbox" } },
  { "^libimpact/src/scene/saved", { "impact_save", "impact_saved_words" } }, { "^libimpact/src/scene/scene_save", { "impact_save", "impact_saved_words" } },
  { "^libimpact/src/scene/rolling", { "impact_rolling", "impact_scene_answers" } }, { "^libimpact/src/scene/names", { "impact_names" } },
  { "^libimpact/src/scene/definitions", { "impact_definitions", "impact_scene", "impact_run_words" } },
  { "^libimpact/src/scene/scene_change", { "impact_change", "impact_scene" } },
  { "^libimpact/src/scene/following", { "impact_random_scenes", "impact_scene_answers" } },
  { "^libimpact/src/scene/parting", { "lua_between_walls", "impact_random_scenes", "impact_scene_answers", "impact_cases" } },
  { "^libimpact/src/scene/scene_drawn", { "lua_between_walls", "impact_ramps", "impact_scene_answers", "impact_cases", "impact_random_scenes" } },
  { "^libimpact/src/scene/scene_held", { "impact_scene", "impact_rolling", "impact_random_scenes" } },
  { "^libimpact/src/scene/scene_methods", { "impact_ranges", "impact_methods", "impact_scene" } },
  { "^libimpact/src/scene/scene_keys", { "impact_names", "impact_definitions", "impact_scene", "impact_piles" } },
  { "^libimpact/src/scene/scene_check", { "impact_ranges", "impact_scene", "impact_definitions", "impact_run_words" } },
  { "^libimpact/src/scene/scene_defaults", { "impact_ranges", "impact_definitions" } }, { "^libimpact/src/scene/scene%.c$", { "impact_ranges", "impact_scene", "impact_change", "impact_cases" } },
  { "^libimpact/src/world/normal", { "impact_normal", "impact_random_scenes", "impact_cases", "lua_faces_edge_on_edge" } },
  { "^libimpact/src/motion/segment", { "impact_segment", "impact_motion", "impact_search", "impact_scene_answers", "impact_random_scenes", "impact_cases", "impact_piles" } },
  { "^libimpact/src/motion/psi", { "impact_search", "impact_crowd", "impact_search_proof", "impact_random_scenes", "impact_scene_answers" } },
  { "^libimpact/src/motion/spin", { "impact_segment", "impact_search", "impact_crowd", "impact_search_proof", "impact_random_scenes", "impact_scene_answers" } },
  { "^libimpact/src/contact/patch", { "impact_patch", "impact_held_still", "lua_faces_lines", "lua_faces_edge_on_edge" } },
  { "^libimpact/src/contact/points", { "impact_patch", "lua_faces_lines", "impact_random_scenes", "impact_cases", "impact_piles" } },
  { "^libimpact/src/contact/rest", { "impact_rest", "impact_cases", "impact_encounter_random", "impact_encounter_kept", "impact_encounter_ends" } }, { "^libimpact/src/contact/least", { "impact_patch", "impact_held", "impact_encounter_random", "impact_encounter_kept", "impact_encounter_ends", "impact_piles" } },
  { "^libimpact/src/contact/skyline", { "impact_cone", "impact_springs", "impact_held_system" } },
  { "^libimpact/src/contact/held_still", { "impact_held_still", "impact_cases" } }, { "^libimpact/src/contact/held_flat", { "impact_held_flat" } }, { "^libimpact/src/contact/held_line%.", { "impact_held_line" } },
  { "^libimpact/src/contact/held_linear", { "impact_held_linear", "impact_held_still", "impact_held" } },
  { "^libimpact/src/contact/held_s[po]", { "impact_held_spot", "impact_held_still", "impact_held_modes", "impact_held" } },
  { "^libimpact/src/contact/held_system", { "impact_random_scenes", "lua_between_walls", "impact_held_system", "impact_held_still", "impact_held_modes", "impact_held" } },
  { "^libimpact/src/scene/coarser", { "impact_coarser", "impact_piles", "lua_bands" } }, { "^libimpact/src/scene/arrivals", { "impact_arrivals", "impact_scene", "impact_rolling", "impact_crowd", "lua_faces_tolerance", "lua_scene", "lua_faces_turned" } },
  { "^libimpact/src/scene/queue", { "impact_queue" } }, { "^libimpact/src/scene/rules", { "impact_rules" } },
  { "^libimpact/src/scene/scene_receipt", { "impact_scene_receipt", "impact_scene_answers", "impact_cases" } },
  { "^libimpact/src/scene/scene_hold", { "impact_crowd", "impact_scene", "impact_scene_answers", "impact_cases", "impact_motion", "impact_piles", "lua_faces_exact", "lua_faces_held", "lua_faces_tolerance" } },
  { "^libimpact/src/scene/tracks", { "impact_crowd", "impact_scene", "impact_scene_answers" } },
  { "^libimpact/src/scene/scene_build", { "impact_rolling", "impact_scene", "impact_scene_answers", "impact_cases" } },
  { "^libimpact/src/scene/island", { "impact_scene_answers", "impact_scene", "lua_scene", "lua_units", "lua_faces_tolerance", "impact_random_scenes" } },
  { "^libimpact/src/scene/scene_instant", { "impact_piles", "lua_faces_exact", "lua_faces_tolerance", "lua_alike", "lua_units", "impact_scene", "impact_cases", "impact_random_scenes" } },
  { "^libimpact/src/scene/stepped", { "impact_scene_together", "lua_ends", "lua_faces_begin", "impact_crowd", "impact_piles", "impact_scene", "impact_random_scenes" } },
  { "^libimpact/src/scene/gliding", { "lua_faces_gliding", "lua_faces_lines", "lua_faces_begin", "impact_scene", "impact_cases", "impact_piles" } },
  { "^libimpact/src/scene/scene_together", { "impact_scene_together", "impact_scene_answers" } },
  { "^libimpact/src/scene/", { "impact_scene_answers", "impact_scene", "impact_cases", "impact_surface_velocity", "impact_scene_together", "impact_random_scenes" } },
  { "^libimpact/src/motion/search_", { "impact_search_proof", "impact_toi", "impact_search" } }, { "^libimpact/src/motion/search", { "impact_search", "impact_crowd", "impact_motion" } }, { "^libimpact/src/motion/face_points", { "impact_face_points" } }, { "^libimpact/src/motion/face", { "impact_face_motion", "impact_face_begin", "impact_line_motion", "impact_face_friction", "lua_faces_gliding", "lua_faces_begin", "lua_faces_lines" } }, { "^libimpact/src/motion/motion_method", { "lua_faces_gliding", "impact_scene_answers", "impact_motion", "impact_force", "impact_cases", "impact_random_scenes" } }, { "^libimpact/src/motion/motion_guard", { "impact_motion_guard", "impact_force_time", "impact_motion" } },
  { "^libimpact/src/motion/pile", { "impact_pile", "lua_between_walls", "impact_pile_order", "impact_coarser", "impact_pile_contacts", "lua_faces_lines", "lua_faces_turned", "lua_faces_stacked", "lua_faces_edge_on_edge", "lua_turning", "lua_units", "lua_faces_held", "impact_piles" } },
  { "^libimpact/src/motion/motion_stretch", { "impact_motion", "lua_faces_exact", "lua_faces_held", "lua_faces_turned", "impact_held_modes", "impact_cases", "lua_faces_seams" } },
  { "^libimpact/src/motion/lying", { "lua_faces_gliding", "lua_faces_lines", "lua_faces_turned", "lua_faces_begin", "impact_ramps" } },
  { "^libimpact/src/world/corner", { "impact_corner", "lua_faces_exact", "lua_faces_held", "lua_faces_seams", "impact_cases" } },
  { "^libimpact/src/motion/motion_", { "impact_motion", "impact_force", "impact_cases", "impact_random_scenes" } },
  { "^libimpact/src/contact/held%.c$", { "impact_held", "impact_cases", "lua_faces_turned" } },
  { "^libimpact/src/contact/held", { "lua_between_walls", "impact_held_still", "impact_held_modes", "impact_held", "impact_cases" } },
  { "^libimpact/src/contact/cone_", { "impact_cone", "impact_cone_turning", "impact_cone_bodies", "lua_faces_stacked", "impact_encounter_random", "impact_encounter_kept", "impact_encounter_ends" } }, { "^libimpact/src/contact/turning", { "impact_cone_turning", "impact_rolling", "impact_scene_answers" } },
  { "^libimpact/src/contact/encounter_share", { "impact_encounter_random", "impact_encounter_kept", "impact_encounter_ends", "impact_piles" } },
  { "^libimpact/src/contact/encounter", { "impact_encounter", "impact_encounter_limits", "impact_encounter_mend", "impact_encounter_known", "impact_encounter_wedge",
    "impact_encounter_newton", "impact_encounter_pressed", "impact_encounter_receipt", "impact_encounter_random", "impact_encounter_kept", "impact_encounter_ends" } },
  { "^libimpact/src/contact/springs", { "impact_springs", "impact_encounter_known", "impact_encounter", "impact_encounter_random", "impact_encounter_kept", "impact_encounter_ends", "impact_encounter_incipient" } },
  { "^libimpact/src/contact/rates", { "impact_rates", "impact_pile_order", "lua_faces_stacked", "impact_held_spot", "impact_held_line", "impact_held", "impact_held_modes" } },
  { "^libimpact/src/gap/gap_ladder", { "impact_gap", "impact_gap_mixed", "impact_gap_arcs", "impact_gap_faces", "impact_gap_deep", "impact_gap_receipt" } },
  { "^libimpact/src/gap/gap_arcs", { "impact_gap_arcs" } },
  { "^libimpact/src/gap/gap_simplex", { "impact_gjk", "impact_gap", "impact_gap_mixed" } },
  { "^libimpact/src/gap/flat", { "impact_patch", "lua_faces_turned", "impact_cases" } },
  { "^libimpact/src/gap/gap_core%.c$", { "impact_gap_faces" } }, { "^libimpact/src/gap/gap_axes", { "impact_gap_faces" } },
  { "^libimpact/src/gap/", { "impact_gap", "impact_gap_mixed", "impact_gap_deep", "impact_gap_receipt", "impact_gjk", "impact_toi" } },
  { "^libimpact/src/motion/toi", { "impact_toi" } },
  { "^libimpact/src/collide/", { "impact_collide", "impact_collide_frame", "impact_collide_ready", "impact_collide_direct",
    "impact_collide_inertia", "impact_collide_isotropic", "impact_collide_flow", "impact_collide_course", "impact_collide_series",
    "impact_collide_facts", "impact_collide_receipt", "impact_collide_limits", "impact_collide_sensitivity", "impact_collide_compliant", "impact_collide_many", "impact_collide_cvode" } },
}

local function read(path)
  local file = assert(io.open(path, "rb"))
  local text = file:read "a"
  file:close()
  return text
end

local function write(path, text)
  local file = assert(io.open(path, "wb"))
  file:write(text)
  file:close()
end

local function lines_of(text)
  local list = {}
  for line in (text:gsub("\n$", "") .. "\n"):gmatch "(.-)\n" do list[#list + 1] = line end
  return list
end

local function tests_of(file)
  for _, room in ipairs(rooms) do
    if file:find(room[1]) then return room[2] end
  end
end

--- The sources that a change of this line is seen in.
local function sources_of(file, line)
  if not file:find "%.h$" then return { file } end
  local word = line:match "^#define ([%w_]+)" or '"' .. file:match "/src/(.*)$" .. '"'
  local pipe, list = io.popen(string.format("cd '%s' && git grep -lwF '%s' -- 'lib*/src/*.c'", root, word)), {}
  for source in pipe:lines() do list[#list + 1] = source end
  pipe:close()
  return list
end

--- The tests of all of them, each once.
local function tests_of_all(sources)
  local list, seen = {}, {}
  for _, source in ipairs(sources) do
    for _, test in ipairs(tests_of(source) or {}) do
      if not seen[test] then list[#list + 1], seen[test] = test, true end
    end
  end
  return list
end

-- ---- making them ----

--- FNV-1a, 32 bits.
local function hash(text)
  local h = 2166136261
  for i = 1, #text do h = ((h ~ text:byte(i)) * 16777619) & 0xffffffff end
  return h
end

--- The place after the parenthesis that closes the one at `from`.
local function closing(line, from)
  local depth = 0
  for i = from, #line do
    local c = line:sub(i, i)
    depth = depth + (c == "(" and 1 or c == ")" and -1 or 0)
    if depth == 0 then return i end
  end
end

local function swap(add, line, old, new)
  local from, to = line:find(old, 1, true)
  if from then add(line:sub(1, from - 1) .. new .. line:sub(to + 1)) end
end

--- Every change of one line that we know how to make: add(new line).
local function changes(line, add)
  local from, to = line:find "%f[%w_.]%d[%d.]*e%-?%d+"
  if not from then from, to = line:find "%f[%w_.]0x1p%-?%d+" end
  if from then -- a threshold
    add(line:sub(1, from - 1) .. "(10 * " .. line:sub(from, to) .. ")" .. line:sub(to + 1))
    add(line:sub(1, from - 1) .. "(" .. line:sub(from, to) .. " / 10)" .. line:sub(to + 1))
  end
  local open = line:match "^%s+if ()%("
  local close = open and closing(line, open)
  if close then -- a condition
    local condition = line:sub(open, close)
    add(line:sub(1, open - 1) .. "(1 || " .. condition .. ")" .. line:sub(close + 1))
    add(line:sub(1, open - 1) .. "(0 && " .. condition .. ")" .. line:sub(close + 1))
  end
  local loop = line:find "for %(" or line:find "enum "
  if not loop then
    for _, pair in ipairs { { " < ", " >= " }, { " <= ", " > " }, { " > ", " <= " }, { " && ", " || " }, { " || ", " && " },
      { " - ", " + " }, { " + ", " - " }, { "(-", "(" }, { "= -", "= " }, { "return -", "return " }, { "0.5 * ", "0.25 * " },
      { " 2 * ", " 3 * " }, { " * ", " / " } } do
      swap(add, line, pair[1], pair[2])
    end
    if line:find "^%s+[%w_.%->%[%]*]+ [%+%-%*/|]?= [^{]*;$" or line:find "^%s+[%w_]+%(.*%);$" then add(line:match "^%s+" .. ";") end
  end
end

local function is_code(line)
  return line:find "^    " and not line:find "^%s*[/*#}]" and not line:find '"' and not line:find "prefetch" and not line:find "^%s*static" and #line < 120
end

local function make(seed)
  local pipe = assert(io.popen(string.format("cd '%s' && git ls-files 'lib*/src/*.c' 'lua/runner/*.c'", root)))
  for file in pipe:lines() do
    if tests_of(file) then
      local list, count, found = lines_of(read(root .. "/" .. file)), {}, {}
      for _, line in ipairs(list) do count[line] = (count[line] or 0) + 1 end
      for _, line in ipairs(list) do
        if is_code(line) and count[line] == 1 then
          changes(line, function(new)
            found[#found + 1] = { hash(seed .. file .. line .. new), line, new }
          end)
        end
      end
      table.sort(found, function(a, b) return a[1] < b[1] end)
      for i = 1, math.min(#found, 2 + #list // 50) do print(file .. "\t" .. found[i][2] .. "\t" .. found[i][3]) end
    end
  end
  pipe:close()
end

-- ---- trying them ----

local function command(text) return os.execute(text .. " >/dev/null 2>&1") == true end

--- The edge of build.ninja that makes a target.
local function edge(build, target)
  local lists = read(build .. "/build.ninja")
  local at = assert(lists:find("\nbuild " .. target .. ":", 1, true), "not in this build: " .. target) + 1
  return lists:sub(at, lists:find("\n\n", at, true))
end

--- A runner with the mutant's object in its file's place, and the Lua test that drives it.
local function runner_passes(build, work, test, object, file)
  local text = edge(build, "lua/impact")
  local objects = text:match "^build lua/impact: %S+ ([^|]*)":gsub("[^%s]*/" .. file:match "[^/]+$":gsub("%.", "%%.") .. "%.o", object)
  local runner, name = work .. "/impact", test:match "^lua_(.*)$"
  assert(command(string.format("cd '%s' && ln -sfn '%s/lua/modules' '%s/modules' && cc -O2 %s %s -o %s %s", build, build, work,
    text:match "LINK_FLAGS = ([^\n]*)", objects, runner, text:match "LINK_LIBRARIES = ([^\n]*)")), "no link of the runner")
  local extra = name == "memory" and build .. "/tests/lua/libfail_malloc.so" or root .. "/docs"
  return command(string.format("cd '%s' && ulimit -t 60 && LUA_PATH='%s/lua/modules/?.lua;%s/tests/lua/?.lua' LUA_CPATH='%s/lua/modules/?.so' " ..
    "'%s' '%s/tests/lua/test_%s.lua' '%s' '%s/lua_%s' '%s'", work, build, root, build, arg[-1], root, name, runner, work, name, extra))
end

--- A module of Lua with the mutant's object before the archive, and the Lua test that loads it.
local function module_passes(build, work, test, object)
  local text, modules = edge(build, "lua/modules/impact/core.so"), work .. "/modules"
  assert(command(string.format("rm -rf '%s' && cp -r '%s/lua/modules' '%s' && cd '%s' && cc -shared -O2 %s %s %s -o '%s/impact/core.so' %s", modules,
    build, modules, build, text:match "LINK_FLAGS = ([^\n]*)", text:match "^build lua/modules/impact/core.so: %S+ ([^|]*)", object, modules,
    text:match "LINK_LIBRARIES = ([^\n]*)")), "no link of the module")
  return command(string.format("ulimit -t 60 && LUA_PATH='%s/?.lua;%s/tests/lua/?.lua' LUA_CPATH='%s/?.so' '%s' '%s/tests/lua/test_%s.lua'", modules,
    root, modules, arg[-1], root, test:match "^lua_(.*)$"))
end

--- Runs the test linked with the mutant's object before everything else, to its first failure; at most 60 s of computing.
local function passes(build, work, test, object, file)
  local library, name = test:match "^(%a+)_(.*)$"
  if library == "lua" then return (file:find "^lua/" and runner_passes or module_passes)(build, work, test, object, file) end
  local folder = string.format("%s/tests/%s/CMakeFiles/test_%s.dir", build, library, test)
  local text = edge(build, "tests/" .. library .. "/test_" .. test)
  local wrap, libraries = text:match "LINK_FLAGS = ([^\n]*)" or "", text:match "LINK_LIBRARIES = ([^\n]*)" or ""
  local program = string.format("%s/test_%s_%s", work, library, name)
  local objects = string.format("$(find %s -name '*.o')", folder)
  assert(command(string.format("cd '%s' && cc -O2 %s %s %s -o %s %s", build, wrap, objects, object, program, libraries)),
    "no link of " .. test)
  return command(string.format("cd '%s' && ulimit -t 60 && CMOCKA_TEST_ABORT=1 '%s'", work, program))
end

--- As the build compiles the file, of the text given.
local function compile(build, work, file, source)
  local path = string.format("%s/%s", work, file:match "[^/]+$")
  write(path, source)
  local known = read(build .. "/compile_commands.json")
  local at = assert(known:find('"file": "[^"\n]*/' .. file:gsub("%p", "%%%0") .. '"'), "not in this build: " .. file)
  local text = known:sub(1, at - 1):match '.*"command": "(.-)",%s*$':gsub('\\"', '"'):gsub("\\\\", "\\")
  local object, folder = path:gsub("%.c$", ".o"), (root .. "/" .. file):match "^(.*)/[^/]+$"
  text = text:gsub("%-o %S+ %-c %S+$", "")
  -- a header of the mutant's stands before the library's own
  text = text:gsub("^(%S+) ", "%1 -I'" .. work .. "/include' ", 1)
  return command(string.format("cd '%s' && %s -w -O2 -I'%s' -o '%s' -c '%s'", build, text, folder, object, path)) and object
end

--- The objects of the mutant, or nil.
local function mutate(build, work, file, text, sources)
  if not file:find "%.h$" then return compile(build, work, file, text) end
  local place, objects = work .. "/include/" .. file:match "/src/(.*)$", {}
  os.execute("mkdir -p '" .. place:match "^(.*)/" .. "'")
  write(place, text)
  for _, source in ipairs(sources) do objects[#objects + 1] = compile(build, work, source, read(root .. "/" .. source)) end
  os.remove(place)
  return #objects == #sources and #objects > 0 and table.concat(objects, " ") or nil
end

local function run(build, work, part, parts, pattern)
  local caught, total, stale, known = 0, 0, 0, 0
  local survivors = {}
  os.execute("mkdir -p '" .. work .. "'")
  local number, sound = 0, {}
  --- A test is trusted once it has passed with the file as it is.
  local function trusted(test, file)
    if sound[test] == nil then
      sound[test] = passes(build, work, test, assert(compile(build, work, file, read(root .. "/" .. file)), file), file)
      if not sound[test] then print("fails unchanged: " .. test) end
    end
    return sound[test]
  end
  for line in io.lines(root .. "/tests/mutants.txt") do
    local file, old, new, reason = line:match "^([^\t]+)\t([^\t]+)\t([^\t]+)\t?(.*)$"
    if file and not file:find "^#" and (not pattern or file:find(pattern)) then
      number = number + 1
      if number % parts == part % parts then
        local text = "\n" .. read(root .. "/" .. file)
        local sources = sources_of(file, old)
        local tests = tests_of_all(sources)
        for _, test in ipairs(tests) do trusted(test, sources[1]) end
        local from, to = text:find("\n" .. old .. "\n", 1, true)
        local object = from and mutate(build, work, file, text:sub(2, from) .. new .. text:sub(to), sources)
        if not object then
          stale = stale + 1
          print("stale     " .. file .. ": " .. old:match "^%s*(.*)")
        else
          total = total + 1
          local noticed
          for _, test in ipairs(tests) do
            if trusted(test, sources[1]) and not passes(build, work, test, object, file) then
              noticed = test
              break
            end
          end
          if noticed then
            caught = caught + 1
            print("caught    " .. file .. ": " .. new:match "^%s*(.*)" .. "  by " .. noticed)
            if reason ~= "" then print("caught after all " .. file .. ": " .. new:match "^%s*(.*)") end
          else
            known = known + (reason ~= "" and 1 or 0)
            survivors[#survivors + 1] = line
            print("survives  " .. file .. ": " .. old:match "^%s*(.*)" .. "  ->  " .. new:match "^%s*(.*)" .. (reason ~= "" and "  (" .. reason .. ")" or ""))
          end
        end
        io.stdout:flush()
      end
    end
  end
  print(string.format("part %d of %d: %d mutants, %d caught, %d survive, of them %d with a reason; %d stale", part, parts, total, caught,
    #survivors, known, stale))
  os.exit(#survivors == known and stale == 0 and 0 or 1)
end

if arg[1] == "make" then make(arg[2] or "1")
else run(arg[2], arg[3], tonumber(arg[4]), tonumber(arg[5]), arg[6]) end
