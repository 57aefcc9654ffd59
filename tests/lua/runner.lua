-- SPDX-License-Identifier: MIT
--- Runs the runner for a test: `local runner = require "runner"`; arg[1] is the program, arg[2] a folder to work in.
local runner = {}

local program, folder = arg[1], arg[2]

local function quote(text)
  return "'" .. text:gsub("'", "'\\''") .. "'"
end

local function shell(command)
  local _, _, code = os.execute(command)
  return code
end

runner.folder = folder
runner.program = program
runner.quote = quote
runner.shell = shell

function runner.read(name)
  local file = io.open(folder .. "/" .. name, "rb")
  if not file then return nil end
  local text = file:read("a")
  file:close()
  return text
end

function runner.exists(name)
  return shell("test -e " .. quote(folder .. "/" .. name)) == 0
end

function runner.write(name, text)
  local file = assert(io.open(folder .. "/" .. name, "wb"))
  file:write(text)
  file:close()
end

--- An empty folder to work in.
function runner.clean()
  shell("rm -rf " .. quote(folder) .. " && mkdir -p " .. quote(folder))
end

--- Runs the program in the folder with a command line: exit code, what it said, what it complained of.
--- (A sanitizer that the interpreter needed beforehand is none of gnuplot's business.)
function runner.command(line)
  local code = shell(string.format("cd %s && env -u LD_PRELOAD %s %s >stdout.txt 2>stderr.txt </dev/null", quote(folder), quote(program), line))
  return code, runner.read("stdout.txt"), runner.read("stderr.txt")
end

--- Runs a script's text as script.lua with --out o.
function runner.script(text, options)
  shell("rm -rf " .. quote(folder .. "/o"))
  runner.write("script.lua", text)
  return runner.command("script.lua --out o " .. (options or ""))
end

--- The same, sent a signal after a while.
function runner.signalled(text, signal, seconds)
  shell("rm -rf " .. quote(folder .. "/o"))
  runner.write("script.lua", text)
  local code = shell(string.format("cd %s && env -u LD_PRELOAD timeout --preserve-status -s %s %g %s script.lua --out o " ..
    ">stdout.txt 2>stderr.txt </dev/null", quote(folder), signal, seconds, quote(program)))
  return code, runner.read("stdout.txt"), runner.read("stderr.txt")
end

--- The names in the output folder, sorted, with a blank between.
function runner.files()
  shell(string.format("cd %s && ls -A o > files.txt 2>/dev/null", quote(folder)))
  return (runner.read("files.txt"):gsub("\n", " "):gsub(" $", ""))
end

return runner
