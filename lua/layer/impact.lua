-- SPDX-License-Identifier: MIT
--- Rigid bodies that hit each other: `local impact = require "impact"`. The guide is docs/scene.md.

require "quat" -- gives the orientations that come back their methods
local core = require "impact.core"
core.layer()

---@alias vec {[1]: number, [2]: number, [3]: number}|vec3
---@alias impact.rule "product"|"geometric_mean"|"minimum"|"maximum"

---@class impact.shape
---@field kind string
---@field rounding number  m
---@field vertices vec3[]  polyhedra: in the shape's frame, m
---@field faces integer[][]  polyhedra: the corners of each, counter-clockwise seen from outside
---@field dropped integer  polyhedra: points given that are no vertices
---@field center vec3  polyhedra: the shape's origin in the frame of the points given, m
---@field axes quat  polyhedra: the shape's axes to those of the points given
---@field volume number  m^3
---@field inertia vec3  per unit mass, m^2
---@field bounding_radius number  m
---@field support fun(self, direction: vec): number, vec3  the support function, and where it is reached
---@field point fun(self, u: number, v: number): vec3  on the surface, u in [-pi, pi), v in [-pi/2, pi/2]
---@field normal fun(self, u: number, v: number): vec3  the outward unit normal there
---@field inside fun(self, x: vec): number  below 1 inside, 1 on the surface
---@field hessian fun(self, direction: vec): number[][]  of the support function at the unit of direction, rows, m
---@field curvatures fun(self, direction: vec): number, number  1/m, larger first, where the normal is along direction
---@field mesh fun(self, nu: integer, nv: integer): vec3[], vec3[]  points and normals, nv + 1 rows of nu

---@class impact.patch
---@field dimension integer  of the closed points: -1 none, 0 a point, 1 a segment, 2 a polygon or disc
---@field normal vec3  from the second body to the first
---@field gap number  m
---@field disc? number  radius, where the patch is a whole disc
---@field points {offset1: vec3, offset2: vec3, normal: vec3, height: number, closed: boolean, feature1: string, feature2: string}[]

---@class impact.solid
---@field shape impact.shape
---@field position? vec  m
---@field orientation? quat|number[]  body to world
---@field velocity? vec  m/s; for toi only, as the next two
---@field acceleration? vec  m/s^2
---@field omega? vec  rad/s, world

---@class impact.contact
---@field gap number  m; negative when the bodies overlap
---@field lower number  m; bracket of the gap
---@field upper number
---@field normal vec3  unit, from the second body to the first
---@field point1 vec3  witness points, world
---@field point2 vec3
---@field offset1 vec3  the same less the bodies' positions
---@field offset2 vec3
---@field stiffness number  m; small: the normal is soft
---@field path "closed form"|"newton"|"gjk"|"fallback"|"ccd"
---@field status string  "ok", or what to know about the answer

---@class impact.body
---@field name string  unique in the scene
---@field shape impact.shape
---@field static? boolean  never moves; planes are static by themselves
---@field mass? number  kg
---@field density? number  kg/m^3, instead of mass
---@field moments? vec  principal moments, kg m^2; of the uniform solid by default
---@field position? vec  of the centre of mass, m
---@field orientation? quat|number[]  body to world, {w, x, y, z}
---@field trail? vec  the point, in the body's frame, whose way viewers draw: 0, 0, 0
---@field shape_position? vec  where the shape's centre stands in the body's frame, m
---@field shape_orientation? quat|number[]  the shape's axes to the body's principal ones
---@field normal? vec  for planes, instead of orientation: where the free side is
---@field velocity? vec  m/s; of a static body, its surface's: along a plane (a belt)
---@field omega? vec  rad/s, world; of a static body, its surface's: about a plane's normal through its position, or an axis on which it is round
---@field friction? number
---@field restitution? number
---@field torsional_friction? number  length tau, m: a contact pressed by N resists turning about its normal by up to tau N (0)
---@field rolling_friction? number  length rho, m: and rolling by up to rho N (0)
---@field linear_damping? number  part of the velocity lost per second
---@field angular_damping? number

---@class impact.wind
---@field name? string
---@field body? string  acts on this body only
---@field origin? vec  m
---@field direction? vec
---@field strength number  N
---@field reach? number  m along the tube
---@field radius? number  m from its axis
---@field falloff_power? number
---@field falloff_length? number  m
---@field drag? number  N s/m: the wind pulls towards its own speed, strength/drag

---@class impact.attraction
---@field name? string
---@field body? string
---@field constant? number  G, N m^power/kg^2
---@field power? number
---@field reach? number  m

---@class impact.force
---@field name? string
---@field body? string
---@field law fun(t: number, body: impact.state): vec?, vec?  force (N) and torque (N m); the state is valid during the call only
---@field max_step? number  s; a thousandth of the duration by default, math.huge: as long as the integrator likes
---@field switches? number[]  s, rising: when the law jumps or has a corner
---@field period? number  s: the switches again and again; alone: at its multiples
---@field edge? fun(t: number, body: impact.state): number  zero where the law has a corner
---@field steady? boolean  does not depend on t

---@class impact.state
---@field t number
---@field body string
---@field position vec3
---@field orientation quat
---@field velocity vec3
---@field omega vec3

---@class impact.methods
---@field motion? "auto"|"cvode"|"rk4"|"steps"|"other"  how bodies move between events; "steps": piles by steps; "other": by what "cvode" would not take
---@field impacts? "auto"|"closed_form"|"series"|"cvode"  the same as solver
---@field gaps? "newton"|"ccd"
---@field tolerance? number  the same as the scene's
---@field impact_tolerance? number  of impacts = "cvode", 1e-14 to 1e-2; by default the tolerance
---@field gap_tolerance? number  of gaps = "ccd", 1e-7 to 1e-2 of the larger body; by default 1e-4
---@field step? number  s, of motion = "rk4"

---@class impact.definition
---@field name? string
---@field duration number  s
---@field bodies impact.body[]
---@field forces? (impact.wind|impact.attraction|impact.force)[]
---@field gravity? vec  m/s^2
---@field output_rate? number  samples per second
---@field rules? {friction?: impact.rule, restitution?: impact.rule}
---@field pairs? {bodies: string[], friction?: number, restitution?: number, torsional_friction?: number, rolling_friction?: number, stiffness?: number}[]
---@field law? "poisson"|"newton"|"stronge"
---@field solver? "auto"|"closed_form"|"series"|"cvode"
---@field compliance? number  eta^2 of every contact, with law = "stronge"; 0: rigid
---@field tolerance? number
---@field methods? impact.methods
---@field rest_height? number  m
---@field rest_speed? number  m/s
---@field max_events? integer
---@field key_tolerance? number  of a recorded run's keys: part of a body's radius, and rad
---@field view? table  what its page shows: docs/view.md
---@field together? "auto"|"springs"|"moreau"|"sequence"  what answers contacts struck at one instant, (auto): docs/together.md
---@field piles? "auto"|"exact"|"steps"  how bodies are moved that touch each other and do not settle
---@field pile_tolerance? number  what one of their steps may err, of the smallest body's radius
---@field samples? "all"|"moving"  which bodies have rows: every one, or only those that do not rest
---@field plot? fun(scene: impact.scene): plot.figure

---@class impact.options
---@field csv? string  NAME.csv and NAME_events.csv
---@field record? boolean|string  keeps the run for scene:track, scene:events and scene:record; a string: in this file as well
---@field on_sample? fun(state: impact.state): boolean?  false stops the run
---@field on_event? fun(event: table): boolean?
---@field on_progress? fun(t: number, t_end: number): boolean?

---@class impact.scene
---@field run fun(self, options?: impact.options): string?, string?, string?  why it ended; or nil, message, "run"|"output"
---@field run_to fun(self, t: number, options?: impact.options): string?, string?, string?
---@field step fun(self, t_max?: number, options?: impact.options): table?, string?, string?, string?  the next event, and what run returns
---@field held fun(self): table[]  the contacts held now: t, body1, body2, mode, point, normal, force and moment (of friction against turning) on body 1
---@field set fun(self, body: string, state: table)  position, orientation, velocity, omega; what is absent stays
---@field push fun(self, body: string, impulse: vec, point?: vec)  N s, at the centre
---@field save fun(self): string  all that decides how it goes on
---@field load fun(self, bytes: string)
---@field time fun(self): number
---@field duration fun(self): number
---@field name fun(self): string
---@field definition fun(self): impact.definition
---@field state fun(self, body: string): impact.state
---@field energy fun(self): table  start, kinetic, potential, force_work, drive_work, damping_loss, sliding_loss, impact_loss, J
---@field report_rows fun(self, options: table): table[]?, table|string  what scene:report is made of: rows, a summary; or nil and why not
---@field usage fun(self): table  what the run used, by name; and events, by kind
---@field memory fun(self): table  held, used, most: bytes; pieces: how many the allocator was asked for (impact_memory)
---@field receipt fun(self): string, table  "ok" or "inaccurate"; residuals and their limits
---@field events fun(self): table[]  of a recorded run
---@field record fun(self): impact.run  the recorded run, so far
---@field close fun(self)

---@class impact.run
---@field name fun(self): string
---@field reason fun(self): string  why it ended
---@field times fun(self): number, number  s: its begin and end
---@field bodies fun(self): table[]  name, shape, static, mass, moments, shape_position, shape_orientation, friction, restitution, torsional_friction, rolling_friction
---@field state fun(self, body: string, t: number): impact.state  exact at any time; at an event, after it
---@field state_before fun(self, body: string, t: number): impact.state
---@field columns fun(self, body: string, times: number[]): table  t, x, y, z, qw ... wz at those times
---@field keys fun(self, body: string): number[]  the times of its keys
---@field events fun(self): table[]
---@field contacts fun(self): table[]  held contacts: t, body1, body2, mode, point, normal, force
---@field account fun(self): table[]  t, and what scene:energy gives, J
---@field view fun(self, path: string, tolerance?: number): true?, string?  writes the page of it, a large record thinned to tolerance (1e-5) of each body; or nil and why not
---@field gltf fun(self, path: string, tolerance?: number, frame_rate?: number): true?, string?  the same of glTF, to tolerance (3e-4) of each body, for so many frames a second in Blender (as many as it takes: 24, 240, 2400 or 24000); true, and a word where those are not 24, or cannot hold it
---@field close fun(self)

---@alias impact.inertia number[][]|{moments: vec, orientation?: quat|number[]}  world tensor, or principal moments and their axes

---@class impact.collision
---@field m1 number  kg; math.huge: static
---@field J1? impact.inertia  kg m^2; needed when m1 is finite
---@field r1? vec  contact point less centre of mass, m
---@field v1? vec  m/s
---@field w1? vec  rad/s
---@field m2? number  absent: static
---@field J2? impact.inertia
---@field r2? vec
---@field v2? vec
---@field w2? vec
---@field n vec  from body 2 to body 1
---@field mu? number|fun(speed: number): number
---@field eps? number  in [0, 1]
---@field law? "poisson"|"newton"|"stronge"
---@field solver? "auto"|"closed_form"|"series"|"cvode"
---@field order? integer  of the series, 8 to 32
---@field any_restitution? boolean  lets eps be above 1
---@field pressed? boolean  other forces press the contact: docs/collide.md
---@field compliance? number  eta^2, tangential compliance; with law = "stronge"
---@field tolerance? number  of CVODE, 1e-14 to 1e-2
---@field method? "adams"|"bdf"  of CVODE

---@class impact.outcome
---@field v1 vec3
---@field w1 vec3
---@field v2 vec3
---@field w2 vec3
---@field impulse vec3  on body 1, N s
---@field impulse_normal number
---@field impulse_tangential number
---@field compression_impulse number
---@field normal_before number  m/s, < 0
---@field normal_after number
---@field encounter integer  impacts that were answered together share a number, 1, 2, ...; 0: alone
---@field energy_before number  J
---@field energy_after number
---@field work {compression: number, restitution: number, friction: number}  J
---@field phases string[]  "slip-c", "stick-c", "reversal", "slip-r", "stick-r", "tangential"
---@field compressions integer
---@field phase_impulses vec3[]  on body 1 up to the end of each phase, N s
---@field conditioning number
---@field error number  estimated relative error of the velocities; 0: not looked at
---@field second boolean  answered in 128-bit arithmetic
---@field energy_rose boolean
---@field jammed boolean
---@field solver string
---@field status "ok"|"separating"|"soft"

--- The keys of impact.collision (mu a number; not compliance, tolerance, method), each one value for all or a list: numbers, vectors, or
--- one flat list of 3 count numbers.
---@class impact.collisions
---@field count integer
---@field threads? integer  1 by default; 0: as many as the machine has
---@field checked? boolean  each answer by its receipt; false by default

---@class impact.flow_columns
---@field p number[]  N s
---@field ux number[]  m/s, along t1
---@field uy number[]
---@field uz number[]
---@field s number[]
---@field theta number[]
---@field px number[]  N s
---@field py number[]
---@field stick boolean[]
---@field directions {theta: number, rate: number, climb: number, pull: number}[]  those that do not turn
---@field a number  the inverse mass, 1/kg, in the frame (t1, t2, normal); also b, c, d, m
---@field t1 vec3
---@field t2 vec3
---@field normal vec3

---@class impact.encounter  docs/together.md
---@field bodies {name?: string, m?: number, J?: table, v?: vec3, w?: vec3}[]  as m1, J1, v1, w1 of an impact; without m: static
---@field contacts {body1: integer, body2: integer, n: vec3, r1?: vec3, r2?: vec3, mu?: number, eps?: number, k?: number, pressed?: boolean}[]  bodies from 1; k: stiffness (1); pressed: docs/together.md
---@field law? "springs"|"moreau"|"sequence"  (springs)
---@field exponent? number  of the springs, 1 to 3 (3/2)
---@field restitution? "poisson"|"newton"|"stronge"  of the laws sequence, and moreau, which has no stronge (poisson)

---@class impact.encounter_outcome
---@field v vec3[]  of the bodies, after
---@field w vec3[]
---@field contacts {impulse: vec3, normal_before: number, normal_after: number, work: table, phases: string[], compressions: integer, group: integer, merged: boolean}[]
---@field energy_before number
---@field energy_after number
---@field residual number  the receipt's
---@field error number
---@field groups integer
---@field events integer
---@field steps integer
---@field chosen boolean  reactions are not unique
---@field ended_early boolean  springs: what was left when their work was spent ended at once; error tells what by
---@field energy_rose boolean  not by springs
---@field solver "none"|"alone"|"series"|"cone"|"sweeps"
---@field status "ok"|"separating"|"soft"

---@class impact.sweep_definition  docs/sweep.md
---@field parameters table<string, impact.parameter>  crossed in the order in which they were made
---@field scene fun(p: table): impact.scene|impact.definition
---@field reduce? fun(run: impact.sweep_run): table<string, number|string|boolean>  what the row keeps ({t = run.t})
---@field runs? integer  for each crossing (1)
---@field seed? integer  (0)
---@field keep? fun(run: impact.sweep_run): boolean  whether the run is recorded as NAME_run_I.run
---@field record? boolean  whether `reduce` can ask for tracks and events
---@field on_event? fun(event: table, p: table): boolean?  false ends the run
---@field plot? fun(columns: table<string, any[]>): plot.figure  of the whole table
---@field name? string  of the files (the script's)

---@class impactlib
---@field version string
---@field defaults table  what the library takes for absent keys: gravity, output_rate, tolerance, density, friction ...
---@field arguments fun(defaults: table<string, number|string|boolean>): table  those of the script's command line, key=value, over the defaults
---@field has fun(part: "cvode"|"ccd"|"view"): boolean  whether this build holds the part
---@field sphere fun(radius: number|{radius: number}): impact.shape
---@field plane fun(bounds?: {width?: number, depth?: number}): impact.shape
---@field ellipsoid fun(axes: {a: number, b: number, c: number}): impact.shape
---@field superquadric fun(axes: {a: number, b: number, c: number, r?: number, s?: number, t?: number}): impact.shape
---@field superellipsoid fun(axes: {a: number, b: number, c: number, eps1?: number, eps2?: number}): impact.shape
---@field box fun(sizes: {a: number, b: number, c: number, rounding?: number}): impact.shape  half sides of the whole
---@field cylinder fun(sizes: {radius: number, half_height: number, rounding?: number}): impact.shape
---@field cone fun(sizes: {radius: number, height: number, rounding?: number}): impact.shape  z = 0 is the centroid
---@field capsule fun(sizes: {radius: number, half_height: number}): impact.shape  half_height: of the segment inside
---@field polyhedron fun(points: {vertices: vec[], rounding?: number}): impact.shape  their hull, about its centroid
---@field shape table  the ten above, by the same names
---@field patch fun(A: impact.solid, B: impact.solid, height?: number): impact.patch?, string?  where they lie on each other
---@field gap fun(first: impact.solid, second: impact.solid): impact.contact?, string?
---@field gap_receipt fun(first: impact.solid, second: impact.solid, contact: impact.contact): table  its residuals in eps; `worst`
---@field toi fun(first: impact.solid, second: impact.solid, t_max: number): number?, impact.contact|string
---@field body fun(definition: impact.body): impact.body
---@field collide fun(collision: impact.collision): impact.outcome?, string?  one impact; or nil and why there is no answer
---@field collide_many fun(collisions: impact.collisions): table  columns v1, w1, v2, w2, impulse (flat), energy_before, energy_after, normal_after, error, status; checked = true: each by its receipt
---@field collide_together fun(encounter: impact.encounter): impact.encounter_outcome?, string?  many contacts struck at one instant; or nil and why there is no answer
---@field collide_receipt fun(collision: impact.collision, outcome: impact.outcome): {momentum: number, spin: number, cone: number, energy: number, power: number, law: number, approach: number, stick: number, path: number, hodograph: number, slips: number, worst: number}  how far identities are missed, in 2^-52 of their own terms
---@field collide_sensitivity fun(collision: impact.collision): number?, string?  relative change of the velocities after over that of each number of the data, root of the sum of squares; times 2^-52: what the data's rounding leaves open
---@field flow fun(flow: table): impact.flow_columns?, string?  {a=, b=, c=, d=, m=, mu=, u=, p_end=, count=}, or a collision with p_end and count
---@field wind fun(definition: impact.wind): impact.wind
---@field attraction fun(definition?: impact.attraction): impact.attraction
---@field force fun(definition: impact.force): impact.force
---@field open fun(path: string): impact.run?, string?  a recorded run; or nil and what is wrong with it
---@field scene fun(definition: impact.definition): impact.scene
---@field sweep fun(definition: impact.sweep_definition): impact.sweep  many scenes of one form
---@field grid fun(from: number, to: number, count: integer, spacing?: "linear"|"log"): impact.parameter  of a sweep, as the next four
---@field range fun(first: integer, last: integer, step?: integer): impact.parameter
---@field values fun(list: (number|string|boolean)[]): impact.parameter
---@field sobol fun(from: number, to: number): impact.parameter
---@field random fun(from: number, to: number): impact.parameter
local impact = {}
for name, value in pairs(core) do
  if name ~= "layer" and name ~= "no_function" and name ~= "scene_methods" then impact[name] = value end
end

for name, value in pairs(require "impact.sweep") do impact[name] = value end

---@class impact.scene
local methods = core.scene_methods
local recorded_track = methods.track

local event_kinds = { "impact", "contact", "slip", "stick", "liftoff", "force", "rest" }

-- ---- tracks: the recorded rows of a body, as columns ----

local columns = { "t", "x", "y", "z", "qw", "qx", "qy", "qz", "vx", "vy", "vz", "wx", "wy", "wz" }

local function row_of(track, i)
  local row = {}
  for _, column in ipairs(columns) do row[column] = track[column][i] end
  return row
end

--- Raises the message where the caller of `level` stands, unless it is so.
local function need(so, message, level)
  if not so then error(message, level + 1) end
end

local function is_track(value)
  for _, column in ipairs(columns) do
    local list = type(value) == "table" and value[column]
    if type(list) ~= "table" or #list ~= #value.t then return false end
  end
  return true
end

--- The recorded rows of a body as columns t, x, y, z, qw ... wz. With a rate, rows are put between them, at least so many per
--- second, for smooth curves: exact states, of the run's keys; the recorded rows stay as they are.
---@param body string
---@param rate? number
---@return table
function methods:track(body, rate)
  local track = recorded_track(self, body)
  if not rate then return track end
  need(type(rate) == "number" and rate > 0, string.format("track: rate must be a number > 0, got %s", tostring(rate)), 2)
  local times, place = {}, {} -- of the rows put between, and after which recorded row they stand
  for i = 2, #track.t do
    local from, to = track.t[i - 1], track.t[i]
    local steps = math.ceil((to - from) * rate)
    for k = 1, steps - 1 do
      times[#times + 1] = from + (to - from) * k / steps
      place[#times] = i - 1
    end
  end
  local between, fine, k = self:record():columns(body, times), {}, 1
  for _, column in ipairs(columns) do fine[column] = {} end
  local function add(rows, i)
    for _, column in ipairs(columns) do fine[column][#fine[column] + 1] = rows[column][i] end
  end
  for i = 1, #track.t do
    add(track, i)
    while place[k] == i do
      add(between, k)
      k = k + 1
    end
  end
  return fine
end

--- A track's rows before and after time t. Of the rows at t itself, the first ends the one, the others begin the other.
---@return table, table
function impact.split(track, t)
  need(is_track(track), "split: a track of scene:track is needed", 2)
  need(type(t) == "number", "split: t must be a number", 2)
  local before, after = {}, {}
  for _, column in ipairs(columns) do before[column], after[column] = {}, {} end
  local passed = false
  for i = 1, #track.t do
    local part = (passed or track.t[i] > t) and after or before
    for _, column in ipairs(columns) do part[column][#part[column] + 1] = track[column][i] end
    passed = passed or track.t[i] >= t
  end
  return before, after
end

--- A column over times t, read off at other times by straight lines; where t has two rows for one time, the later.
---@return number[]
function impact.along(t, column, times)
  need(type(t) == "table" and type(column) == "table" and type(times) == "table", "along: three lists are needed", 2)
  need(#t == #column and #t > 0, string.format("along: %d times for %d values", #t, #column), 2)
  for name, list in pairs { t = t, column = column, times = times } do
    for i, value in ipairs(list) do
      need(type(value) == "number", string.format("along: %s[%d] is a %s, not a number", name, i, type(value)), 2)
    end
  end
  local result, i = {}, 1
  for row, time in ipairs(times) do
    while i < #t and t[i + 1] <= time do i = i + 1 end
    local step = i < #t and t[i + 1] - t[i] or 0
    local part = step > 0 and math.max(0, time - t[i]) / step or 0
    result[row] = part > 0 and column[i] + part * (column[i + 1] - column[i]) or column[i]
  end
  return result
end

local function find_body(self, name)
  for _, body in ipairs(methods.definition(self).bodies) do
    if body.name == name then return body end
  end
  error(string.format("scene '%s' has no body '%s'", self:name(), tostring(name)), 3)
end

--- The first recorded event of a kind ("impact", "contact", ...) between two bodies, or nil; a nil name is any.
---@return table?
function methods:first(kind, body1, body2)
  local known = table.concat(event_kinds, ", ")
  need((", " .. known .. ","):find(", " .. tostring(kind) .. ",", 1, true),
    string.format("first: the kind must be one of %s, got '%s'", known, tostring(kind)), 2)
  for _, name in pairs { body1, body2 } do find_body(self, name) end
  for _, event in ipairs(methods.events(self)) do
    local straight = (not body1 or event.body1 == body1) and (not body2 or event.body2 == body2)
    local turned = (not body1 or event.body2 == body1) and (not body2 or event.body1 == body2)
    if event.event == kind and (straight or turned) then return event end
  end
  return nil
end

--- A vector's three numbers, by place or by letter.
local function parts_of(v)
  return v[1] or v.x, v[2] or v.y, v[3] or v.z
end

--- The radius of the smallest ball about a body's centre that holds it, m.
---@return number
function methods:radius(body)
  return find_body(self, body).shape.bounding_radius
end

--- The energies of a body along a track of it, J, as columns: translation, rotation, potential (of gravity), total.
---@param body string
---@param track table  of scene:track
---@return {translation: number[], rotation: number[], potential: number[], total: number[]}
function methods:energies(body, track)
  need(is_track(track), "energies: a track of scene:track is needed", 2)
  local definition = find_body(self, body)
  local shape = definition.shape
  local mass = definition.mass or (definition.density or impact.defaults.density) * shape.volume
  local ax, ay, az = parts_of(definition.moments or mass * shape.inertia)
  local gx, gy, gz = parts_of(self:definition().gravity or impact.defaults.gravity)
  local result = { translation = {}, rotation = {}, potential = {}, total = {} }
  for i = 1, #track.t do
    local r = row_of(track, i)
    -- The angular velocity along the body's axes: conj(q) omega q.
    local tx = 2 * (r.wy * r.qz - r.wz * r.qy)
    local ty = 2 * (r.wz * r.qx - r.wx * r.qz)
    local tz = 2 * (r.wx * r.qy - r.wy * r.qx)
    local bx = r.wx + r.qw * tx + (ty * r.qz - tz * r.qy)
    local by = r.wy + r.qw * ty + (tz * r.qx - tx * r.qz)
    local bz = r.wz + r.qw * tz + (tx * r.qy - ty * r.qx)
    local translation = mass / 2 * (r.vx ^ 2 + r.vy ^ 2 + r.vz ^ 2)
    local rotation = (ax * bx ^ 2 + ay * by ^ 2 + az * bz ^ 2) / 2
    local potential = -mass * (gx * r.x + gy * r.y + gz * r.z)
    result.translation[i], result.rotation[i], result.potential[i] = translation, rotation, potential
    result.total[i] = translation + rotation + potential
  end
  return result
end

-- ---- report ----

--- What each method gets right of this scene, how sure that is and what it costs (docs/report.md): the scene is made anew from its
--- definition and run by every method and tolerance. nil and a message where nothing can be compared.
---@param options? {seconds?: number, times?: integer, rounds?: integer, tolerances?: number[], steps?: number[], methods?: string[], reference?: string, reference_error?: number}
---@return impact.report?, string?
function methods:report(options)
  methods.name(self) -- of anything but a scene this raises
  return require "impact.report".of(self, options)
end

--- A run that was recorded done a second time, stretch by stretch, by another integrator at a tenth of the tolerance, and its gaps (docs/scene.md).
--- nil and a message where that cannot be done.
---@return impact.verification?, string?
function methods:verify()
  methods.name(self)
  return require "impact.verify".of(self)
end

-- ---- plot and summary ----

--- Whether the definition holds a plot.
---@return boolean
function methods:has_plot()
  return methods.definition(self).plot ~= nil
end

--- The figure that the definition's plot makes of the recorded run.
---@return plot.figure
function methods:figure()
  local plot = methods.definition(self).plot
  if not plot then error(string.format("scene '%s' has no plot", self:name()), 2) end
  return plot(self)
end

local parts = {
  { "ballistic_flights", "flight in closed form", "stretch", "stretches" },
  { "rolls", "rolling and sliding in closed form", "stretch", "stretches" },
  { "glides", "gliding on a face", "stretch", "stretches", rare = true },
  { "integrators", "integration of the motion", "integrator", "integrators" },
  { "gap_closed_form", "gaps in closed form", "query", "queries" },
  { "gap_newton", "gaps by Newton", "query", "queries" },
  { "gap_gjk", "gaps by GJK", "query", "queries" },
  { "gap_fallback", "gaps by the fallback", "query", "queries" },
  { "impacts_closed_form", "impacts in closed form", "impact", "impacts" },
  { "impacts_series", "impacts by series", "impact", "impacts" },
  { "impacts_cvode", "impacts by CVODE", "impact", "impacts" },
  { "impacts_gaining", "impacts that gave energy, as their law may", "impact", "impacts", rare = true },
  { "impacts_turning", "impacts with friction against turning", "impact", "impacts", rare = true },
}

--- The account, without the terms that are zero but for the integrator's crumbs.
local function energy_line(energy)
  local now = energy.kinetic + energy.potential
  local terms = {
    { energy.force_work, "forces" }, { energy.drive_work, "drives" }, { -energy.damping_loss, "damping" }, { -energy.sliding_loss, "sliding" },
    { -energy.impact_loss, "impacts" },
  }
  local crumb = 1e-15 * math.max(math.abs(energy.start), energy.kinetic, math.abs(energy.potential))
  local balance, line = energy.start - now, string.format("%.6g J at the start", energy.start)
  for _, term in ipairs(terms) do
    balance = balance + term[1]
    if math.abs(term[1]) > crumb then line = line .. string.format(", %+.6g by %s", term[1], term[2]) end
  end
  return string.format("%s: %.6g J now (off by %.1g J)", line, now, math.abs(balance))
end

--- What happened, in a few lines: why it ended, events by kind, the energy account, what was used and what was not.
---@param reason? string
---@return string
function methods:summary(reason)
  local usage, happened, used, unused = methods.usage(self), {}, {}, {}
  for _, kind in ipairs(event_kinds) do
    local count = usage.events[kind] or 0
    if count > 0 then happened[#happened + 1] = string.format("%d %s", count, kind) end
  end
  if usage.encounters > 0 then
    happened[#happened + 1] = string.format("%d instant%s answered together", usage.encounters, usage.encounters == 1 and "" or "s")
  end
  for _, part in ipairs(parts) do
    local count = usage[part[1]]
    if count > 0 then
      used[#used + 1] = string.format("%s (%d %s)", part[2], count, count == 1 and part[3] or part[4])
    elseif not part.rare then
      unused[#unused + 1] = part[2]
    end
  end
  local stepped = usage.pile_steps > 0 and
      string.format("\n  stepped    bodies that touch each other, not exactly: %d steps, that leave places uncertain by %.2g m%s", usage.pile_steps,
        usage.pile_error, usage.pile_parted and string.format("; from t = %.3g s on motions part, and this is one of them",
          usage.pile_parted) or "") or ""
  local steps = usage.integrator_steps > 0 and
      string.format("\n             it took %d steps from %d starts, with %d evaluations of the forces", usage.integrator_steps,
        usage.integrator_starts, usage.integrator_rhs_calls) or ""
  return string.format("%s: %s, t = %.6g s\n  events     %s\n  energy     %s\n  used       %s%s\n  not used   %s\n", self:name(),
    reason or "so far", self:time(), #happened > 0 and table.concat(happened, ", ") or "none", energy_line(self:energy()),
    table.concat(used, ", "), steps .. stepped, #unused > 0 and table.concat(unused, ", ") or "nothing was left out")
end

return setmetatable(impact, { __index = core.no_function "impact" })
