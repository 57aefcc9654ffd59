-- SPDX-License-Identifier: MIT
--- Quaternions: `local quat = require "quat"`. Loads libquat and libm; the rooms that need GSL load when first used.
---
--- Conventions as in C: w first, Hamilton product, right-handed active rotations from body to world; p * q applies q first,
--- then p; radians. Functions on rotations normalise what they are given. Misuse raises an error with the argument's name;
--- an expected failure returns nil and a message; where the answer is one of several, the reason comes after the results.

---@class vec3  {x, y, z}; also v.x, v.y, v.z
---@field x number
---@field y number
---@field z number
---@operator add(vector): vec3
---@operator sub(vector): vec3
---@operator unm: vec3
---@operator mul(number): vec3
---@operator div(number): vec3
---@field dot fun(self: vec3, w: vector): number
---@field cross fun(self: vec3, w: vector): vec3
---@field norm fun(self: vec3): number
---@field normalize fun(self: vec3): vec3?, string?

---@alias rotation quat | number[] | { w: number, x: number, y: number, z: number }
---@alias vector vec3 | number[] | { x: number, y: number, z: number }
---@alias point number[] | { x: number, y: number }  {x, y}
---@alias frame "world" | "body"
---@alias pole "south" | "north"

--- Also every function of quatlib whose first parameter is a quaternion: q:conj(), q:rotate(v), p:slerp(q, t) ...
---@class quat
---@field w number
---@field x number
---@field y number
---@field z number
---@operator add(quat | number): quat
---@operator sub(quat | number): quat
---@operator mul(quat | number): quat
---@operator div(quat | number): quat
---@operator pow(quat | number): quat
---@operator unm: quat
---@field components fun(self: quat): number, number, number, number
---@field vector fun(self: quat): vec3
---@field conj fun(self: quat): quat
---@field norm fun(self: quat): number
---@field dot fun(self: quat, q: rotation): number
---@field mul_compensated fun(self: quat, q: rotation): quat  every component rounded once
---@field inverse fun(self: quat): quat?, string?
---@field normalize fun(self: quat): quat?, string?
---@field div_left fun(self: quat, p: rotation): quat?, string?  (1/self) p
---@field exp fun(self: quat): quat?, string?
---@field log fun(self: quat): quat?, string?
---@field sqrt fun(self: quat): quat?, string?
---@field pow fun(self: quat, exponent: number | rotation): quat?, string?
---@field log_unit fun(self: quat): vec3  half the rotation vector, length 0 ... pi, along this side of S^3
---@field pow_unit fun(self: quat, exponent: number): quat
---@field distance fun(self: quat, q: rotation): number  angle between points of S^3, 0 ... pi
---@field rotation_distance fun(self: quat, q: rotation): number  angle of the rotation from one to the other, 0 ... pi
---@field angle fun(self: quat): number  rotation angle, 0 ... pi
---@field nearest fun(self: quat, reference: rotation): quat  self or -self
---@field near fun(self: quat, q: rotation, tolerance: number): boolean  as points of R^4
---@field same_rotation fun(self: quat, q: rotation, angle: number): boolean
---@field rotate fun(self: quat, v: vector): vec3
---@field rotate_inverse fun(self: quat, v: vector): vec3
---@field rotate_list fun(self: quat, vectors: vector[] | number[]): vec3[] | number[]  list of vectors, or flat x, y, z, x ...
---@field rotate_inverse_list fun(self: quat, vectors: vector[] | number[]): vec3[] | number[]
---@field rotate_soa fun(self: quat, x: number[], y: number[], z: number[]): number[], number[], number[]
---@field rotate_strided fun(self: quat, data: number[], layout: layout): number[]  a copy, its points rotated
---@field to_rotation_vector fun(self: quat): vec3
---@field to_axis_angle fun(self: quat): vec3?, number | string, string?
---@field to_matrix fun(self: quat): number[][]  three rows
---@field to_euler fun(self: quat, sequence: string): number?, number | string, number?, string?
---@field swing_twist fun(self: quat, axis: vector): quat, quat, string?  swing, twist
---@field step fun(self: quat, omega: vector, dt: number, frame?: frame): quat  after dt seconds at constant omega
---@field derivative fun(self: quat, omega: vector, frame?: frame): quat
---@field omega fun(self: quat, dq: rotation, frame?: frame): vec3
---@field integrate fun(self: quat, omega: (fun(t: number): vector), t0: number, t1: number, steps: integer, frame?: frame, method?: "magnus4" | "cf4" | "magnus8"): quat
---@field slerp fun(self: quat, q: rotation, t: number, way?: "short" | "as_given"): quat
---@field nlerp fun(self: quat, q: rotation, t: number, way?: "short" | "as_given"): quat
---@field slerp_omega fun(self: quat, q: rotation, way?: "short" | "as_given"): vec3  radians per unit of t, world axes
---@field nlerp_omega fun(self: quat, q: rotation, t: number, way?: "short" | "as_given"): vec3
---@field slerp_list fun(self: quat, q: rotation, t: number[]): quat[]
---@field stereographic fun(self: quat, pole?: pole): vec3?, string?  from "south" (-1) unless told; the pole: infinite, and a reason
---@field orthographic fun(self: quat): vec3?, integer | string  vector part and sign of w
---@field hopf fun(self: quat): vec3  the point of S^2 below: where z is turned to
---@field hopf_angle fun(self: quat): number  on its fibre, -pi ... pi
---@field roll fun(self: quat, dx: number, dy: number): quat  a unit ball under a hand that goes (dx, dy)
---@field left_matrix fun(self: quat): number[][]  4 x 4: d(self q)/dq
---@field right_matrix fun(self: quat): number[][]  4 x 4: d(p self)/dp
---@field rotate_jacobian fun(self: quat, v: vector): number[][]  3 x 4: d(q v q*)/dq
---@field log_jacobian fun(self: quat): number[][]?, string?  3 x 4: d(log_unit)/dq

--- Component c (0, 1, 2) of point i (from 0) is at data[first + i point + c component]; strides of either sign.
---@class layout
---@field count integer  points
---@field first? integer  1
---@field point? integer  3
---@field component? integer  1

---@class motion  x -> R x + s, a unit dual quaternion
---@operator mul(motion): motion
---@field inverse fun(self: motion): motion
---@field apply fun(self: motion, x: vector): vec3
---@field apply_inverse fun(self: motion, x: vector): vec3
---@field rotation fun(self: motion): quat
---@field shift fun(self: motion): vec3
---@field parts fun(self: motion): quat, quat  real, dual
---@field log fun(self: motion): vec3, vec3  rotation vector and translation rate
---@field sclerp fun(self: motion, q: motion, t: number): motion
---@field to_screw fun(self: motion): vec3?, vec3 | string, number?, number?, string?  axis, point, angle, slide

---@class rotation_spline  twice continuously differentiable
---@field at fun(self: rotation_spline, t: number): quat
---@field state fun(self: rotation_spline, t: number): quat, vec3, vec3  orientation, angular velocity and acceleration (world)
---@field length fun(self: rotation_spline, t?: number): number  angle turned through until t, or in all
---@field time_at fun(self: rotation_spline, length: number): number
---@field close fun(self: rotation_spline)

---@class spline_definition
---@field times number[]
---@field keys rotation[]
---@field ends? "natural" | "clamped" | "periodic"
---@field omega_first? vector
---@field omega_last? vector

---@class curve_point
---@field position vec3
---@field speed number
---@field curvature number
---@field torsion number
---@field curvature_error number  an estimate
---@field torsion_error number
---@field frame quat  x tangent, y principal normal, z binormal

--- A space curve. Its functions return nil and a message where it has no value; errors in its `at` come through.
---@class curve
---@field range fun(self: curve): number, number, boolean  start, end, closed
---@field at fun(self: curve, t: number): curve_point?, string?
---@field derivatives fun(self: curve, t: number, order: integer): vec3[]?, string?  {x, x', ...}
---@field length fun(self: curve, a?: number, b?: number): number?, string?
---@field at_length fun(self: curve, length: number): number?, string?
---@field even fun(self: curve, n: integer): number[]?, string?  n values of t at equal distances
---@field total fun(self: curve): { length: number, curvature: number, torsion: number }?, string?
---@field frames fun(self: curve, options: { n?: integer, times?: number[], framing?: "minimal" | "frenet" | "closed", first?: rotation }): quat[]?, { holonomy: number, monodromy: integer, inflections: integer } | string, string?

---@class curvelib
---@field new fun(definition: { at: (fun(t: number): ...: vector), start: number, finish: number, closed?: boolean, derivatives?: integer }): curve  at returns x and as many derivatives as it says
---@field samples fun(definition: { times: number[], points: vector[], closed?: boolean }): curve
---@field circle fun(r: number): curve
---@field ellipse fun(a: number, b: number): curve
---@field helix fun(r: number, h: number, turns: number): curve  h is the rise of a turn
---@field torus_knot fun(R: number, r: number, p: integer, q: integer): curve
---@field trefoil fun(a: number): curve
---@field viviani fun(a: number): curve
---@field cubic fun(a: number, planar?: boolean): curve

---@class surface_point
---@field position vec3
---@field xu vec3
---@field xv vec3
---@field frame quat  x along x_u, z the normal
---@field a vec3  q_u = q (0, a)/2
---@field b vec3  q_v = q (0, b)/2
---@field first number[]  E, F, G
---@field second number[]  L, M, N
---@field area number  |x_u x x_v|
---@field gauss number  K
---@field mean number  H, with the sign of dN: +1/R for a sphere with its normal outward
---@field principal number[]  the larger first
---@field directions vec3[]
---@field error number  of the principal curvatures, an estimate

--- A parametric surface, as a curve.
---@class surface
---@field range fun(self: surface): number, number, number, number, boolean, boolean  u0, u1, v0, v1, closed_u, closed_v
---@field at fun(self: surface, u: number, v: number): surface_point?, string?
---@field integrability fun(self: surface, u: number, v: number): number?, string?  |a_v - b_u - a x b|
---@field total fun(self: surface, tolerance?: number): { area: number, gauss: number, mean: number, bending: number }?, string?
---@field patch fun(self: surface, options: { rows: integer, columns: integer, u0?: number, u1?: number, v0?: number, v1?: number }): { positions: vec3[], frames: quat[], triangles: integer[][] }?, string?  a mesh for choose_frames

---@class surfacelib
---@field new fun(definition: { at: (fun(u: number, v: number): ...: vector), u0: number, u1: number, v0: number, v1: number, closed_u?: boolean, closed_v?: boolean, derivatives?: integer }): surface  at returns x; x_u, x_v; x_uu, x_uv, x_vv
---@field plane fun(a: number, b: number): surface
---@field sphere fun(r: number): surface
---@field ellipsoid fun(a: number, b: number, c: number): surface
---@field torus fun(R: number, r: number): surface
---@field saddle fun(a: number, size: number): surface
---@field catenoid fun(a: number, height: number): surface
---@field helicoid fun(a: number, turns: number, width: number): surface
---@field superellipsoid fun(a: number, b: number, c: number, e: number, f: number): surface
---@field choose_frames fun(mesh: { positions: vector[], frames: rotation[], triangles: integer[][], gauge?: "shortest" | "length" | "area" }): quat[]?, { energy: number, area: number, rounds: integer, torn: integer } | string, string?
---@field transition fun(q1: rotation[], q2: rotation[]): number?, number[] | string, string?  turns, angles, a reason when the seam is too coarse

local core = require "quat.core"
core.layer()

---@class quatlib : quat
---@field new (fun(w: number, x: number, y: number, z: number): quat) | fun(q: rotation): quat
---@field identity fun(): quat
---@field vec3 (fun(x: number, y: number, z: number): vec3) | fun(v: vector): vec3
---@field pure fun(v: vector): quat
---@field exp_pure fun(v: vector): quat  exp(0, v), the rotation by 2|v| about v
---@field random fun(generator?: fun(): number): quat  uniform; the generator returns numbers in [0, 1)
---@field reflect fun(normal: vector, v: vector): vec3
---@field from_reflections fun(n1: vector, n2: vector): quat
---@field from_rotation_vector fun(r: vector): quat
---@field from_axis_angle fun(axis: vector, angle: number): quat?, string?
---@field from_matrix fun(matrix: number[][]): quat?, string?
---@field from_matrix_nearest fun(matrix: number[][]): quat?, number | string, string?  q, distance
---@field from_euler fun(sequence: string, a: number, b: number, c: number): quat?, string?  "ZYX" intrinsic, "zyx" extrinsic
---@field from_two_vectors fun(a: vector, b: vector): quat?, string?
---@field from_axes fun(x: vector, y: vector): quat?, string?
---@field from_frame fun(x: vector, y: vector, z: vector): quat?, string?  nearest to the frame with these axes
---@field squad fun(p: rotation, a: rotation, b: rotation, q: rotation, t: number): quat
---@field squad_control fun(before: rotation, q: rotation, after: rotation): quat
---@field squad_omega fun(p: rotation, a: rotation, b: rotation, q: rotation, t: number): vec3
---@field spline fun(definition: spline_definition): rotation_spline?, string?
---@field rotate_each fun(q: rotation[], vectors: vector[]): vec3[]  the i-th vector by the i-th rotation
---@field to_matrix_list fun(q: rotation[]): number[][][]
---@field from_matrix_list fun(matrices: number[][][]): quat[]?, string?
---@field slerp_each fun(p: rotation[], q: rotation[], t: number[]): quat[]  0 <= t <= 1, the short way
---@field mul_list fun(p: rotation[], q: rotation[]): quat[]
---@field normalize_list fun(q: rotation[]): quat[]
---@field compose_list fun(q: rotation[]): quat  q[1] q[2] ...
---@field unflip fun(q: rotation[]): quat[], integer, integer  the list made continuous, signs changed, monodromy
---@field mean fun(q: rotation[], weights?: number[]): quat?, string?
---@field mean_karcher fun(q: rotation[], weights?: number[]): quat?, number | string, string?  mean, root mean square angle
---@field align fun(a: vector[], b: vector[], weights?: number[]): quat?, number | string, string?  b = R a: R, residual
---@field align_points fun(a: vector[], b: vector[], weights?: number[]): quat?, vec3 | string, number?, string?
---@field align_error fun(q: rotation, a: vector[], b: vector[], weights?: number[]): number  rad, by which rounding may have turned q
---@field align_points_error fun(q: rotation, a: vector[], b: vector[], weights?: number[]): number
---@field from_stereographic fun(image: vector, pole?: pole): quat
---@field stereographic_sphere fun(p: vector, pole?: pole): number[]?, string?  {x, y}; from "north" unless told
---@field from_stereographic_sphere fun(image: point, pole?: pole): vec3
---@field stereographic_circle fun(p: point, pole?: pole): number?, string?
---@field from_stereographic_circle fun(image: number, pole?: pole): number[]
---@field from_orthographic fun(image: vector, half: integer): quat?, string?  half: -1, 0, 1
---@field orthographic_sphere fun(p: vector): number[]?, integer | string
---@field from_orthographic_sphere fun(image: point, half: integer): vec3?, string?
---@field orthographic_circle fun(p: point): number?, integer | string
---@field from_orthographic_circle fun(image: number, half: integer): number[]?, string?
---@field stereographic_list fun(q: rotation[], pole?: pole): vec3[]?, string?
---@field from_stereographic_list fun(images: vector[], pole?: pole): quat[]
---@field orthographic_list fun(q: rotation[]): vec3[]?, integer[] | string
---@field from_orthographic_list fun(images: vector[], halves: integer[]): quat[]?, string?
---@field hopf_fibre fun(p: vector, t: number): quat?, string?  the point at angle t above p
---@field belt_twist fun(angle: number, t: number): quat  a belt along y, t = 0 ... 1
---@field belt_untwist fun(s: number, t: number): quat  the twist of 4 pi undone, s = 0 ... 1, its ends held
---@field belt_centre fun(s: number, t: number): vec3
---@field belt_frames fun(s: number, n: integer): quat[], vec3[]  at n places along the belt
---@field spinor_arrows fun(angle: number): number[]  each no longer than pi; back after 2 pi
---@field spinor_place fun(angle: number): number
---@field band fun(twist: number, u: number): quat  a ring of one turn, u = 0 ... 1 once round
---@field loop_sign fun(q: rotation[]): integer  1 or -1
---@field roll_path fun(start: rotation, hand: point[]): quat[]
---@field roll_circle fun(radius: number, angle: number): quat
---@field roll_loop fun(radius: number): vec3  the net turn of one round, a rotation vector
---@field chain fun(start: rotation, turns: vector[], parts: integer, frame?: frame): quat[]
---@field exp_jacobian fun(v: vector): number[][]  4 x 3: d exp(0, v)/dv
---@field rotation_vector_jacobian fun(r: vector, side?: "left" | "right"): number[][]  dr/dt to omega, world (left) or body
---@field rotation_vector_jacobian_inverse fun(r: vector, side?: "left" | "right"): number[][]?, string?
---@field motion fun(q: rotation, shift: vector): motion
---@field motion_from_parts fun(real: rotation, dual: rotation): motion?, string?  normalised
---@field screw fun(axis: vector, point: vector, angle: number, slide: number): motion?, string?
---@field motion_exp fun(rotation: vector, translation: vector): motion
---@field blend fun(motions: motion[], weights?: number[]): motion?, string?
---@field curve curvelib
---@field surface surfacelib
local quat = {}
local inner = { layer = true, no_function = true, surface_methods = true }
for name, value in pairs(core) do
  if not inner[name] then quat[name] = value end
end
setmetatable(quat, { __index = core.no_function "quat" })

-- Integrals over surfaces are in quat.gsl, where the build holds it; it loads when one is first asked for.
function core.surface_methods.total(...)
  local found, gsl = pcall(require, "quat.gsl")
  if not found then error("surface:total needs GSL: " .. tostring(gsl), 2) end
  return gsl.total(...)
end

return quat
