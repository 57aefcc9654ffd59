-- SPDX-License-Identifier: MIT
--- The quat module: every function once with a value known by hand, and how it speaks of misuse and failure.
local check = require "check"
local quat = require "quat"

local pi, h = math.pi, math.sqrt(0.5)
local x, y, z = { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }

local function same(q, w, a, b, c, tolerance)
  check.truth(quat.near(q, { w, a, b, c }, tolerance or 1e-15), tostring(q))
end
local function vector(v, a, b, c, tolerance)
  for i, want in ipairs { a, b, c } do check.close(v[i], want, tolerance or 1e-15) end
end

-- Algebra: Hamilton's products, by hand.
local one, i, j, k = quat.identity(), quat.new(0, 1, 0, 0), quat.new(0, 0, 1, 0), quat.new(0, 0, 0, 1)
check.equal(i * j, k)
check.equal(j * i, -k)
check.equal(i * i, -one)
check.equal(quat.new(1, 2, 3, 4) * quat.new(5, 6, 7, 8), quat.new(-60, 12, 30, 24))
check.equal(quat.new(1, 2, 3, 4) + 1, quat.new(2, 2, 3, 4))
check.equal(1 - quat.new(1, 2, 3, 4), quat.new(0, -2, -3, -4))
check.equal(2 * i, i * 2)
check.truth(i ~= j)
check.equal(tostring(quat.new(1, -2, 0.5, 0)), "(1, -2, 0.5, 0)")
same(i / j, 0, 0, 0, -1)
same(1 / i, 0, -1, 0, 0)
same(i ^ 2, -1, 0, 0, 0)
same(i ^ i, math.exp(-pi / 2), 0, 0, 0)
same(quat.new(1, 2, 3, 4):conj(), 1, -2, -3, -4)
check.equal(quat.new(2, 4, 4, 8):norm(), 10)
check.equal(i:dot({ 1, 2, 3, 4 }), 2)
same(quat.new(0, 0, 2, 0):inverse(), 0, 0, -0.5, 0)
same(quat.new(0, 0, 1e-310, 0):normalize(), 0, 0, 1, 0)
same(j:div_left(i), 0, 0, 0, 1)
same(quat.new(0, pi / 2, 0, 0):exp(), 0, 1, 0, 0)
same(i:log(), 0, pi / 2, 0, 0)
same(quat.new(-4, 0, 0, 0):sqrt(), 0, 2, 0, 0)
same(i:pow(0.5), h, h, 0, 0)
same(quat.exp_pure({ 0, pi / 2, 0 }), 0, 0, 1, 0)
vector(quat.new(0, 0, -3, 0):log_unit(), 0, -pi / 2, 0)
same(i:pow_unit(1.5), -h, h, 0, 0)
same(i:mul_compensated(i), -1, 0, 0, 0)
same(quat.pure({ 1, 2, 3 }), 0, 1, 2, 3)
check.equal(select("#", one:components()), 4)
vector(quat.new(1, 2, 3, 4):vector(), 2, 3, 4)
local zero = quat.new(0, 0, 0, 0)
check.equal(select(2, zero:inverse()), "zero, infinite or NaN where a finite, non-zero value is needed")
check.equal(zero:normalize(), nil)
check.equal(select(2, quat.new(-1, 0, 0, 0):log()), "the answer is not unique; one was chosen")

-- Vectors.
local v1, v2 = quat.vec3(1, 2, 3), quat.vec3 { x = 4, y = 5, z = 6 }
vector(v1 + v2, 5, 7, 9)
vector(v1 - { 1, 1, 1 }, 0, 1, 2)
vector({ 1, 1, 1 } - v1, 0, -1, -2)
vector(-v1, -1, -2, -3)
vector(2 * v1 / 4, 0.5, 1, 1.5)
vector(v1 * 2, 2, 4, 6)
check.equal(v1:dot(v2), 32)
vector(v1:cross(v2), -3, 6, -3)
check.equal(quat.vec3(2, 3, 6):norm(), 7)
vector(quat.vec3(0, 3e-310, 4e-310):normalize(), 0, 0.6, 0.8)
check.equal(quat.vec3(0, 0, 0):normalize(), nil)
vector(quat.identity():rotate(v1):cross(v1), 0, 0, 0)
check.equal(v1.w, nil)

-- Distances.
check.close(one:distance(i), pi / 2, 1e-15)
check.close(one:distance(-one), pi, 1e-15)
check.equal(one:rotation_distance(-one), 0)
check.truth(one:same_rotation(-one, 0))
check.close(i:angle(), pi, 1e-15)
check.equal((-i):nearest(i), i)
local state = 7
local q = quat.random(function()
  state = state * 16807 % 2147483647
  return state / 2147483647
end)
check.close(q:norm(), 1, 1e-15)
check.close(quat.random():norm(), 1, 1e-15)

-- Rotations.
local about_z = quat.from_axis_angle({ 0, 0, 2 }, pi / 2)
vector(about_z:rotate(x), 0, 1, 0)
vector(about_z:rotate_inverse(y), 1, 0, 0)
vector(quat.reflect(x, { 1, 2, 3 }), -1, 2, 3)
same(quat.from_reflections(x, { 1, 1, 0 }), h, 0, 0, h)
same(quat.from_rotation_vector({ 0, 0, pi / 2 }), h, 0, 0, h)
vector(about_z:to_rotation_vector(), 0, 0, pi / 2)
local axis, angle = about_z:to_axis_angle()
vector(axis, 0, 0, 1)
check.close(angle, pi / 2, 1e-15)
local m = about_z:to_matrix()
check.close(m[2][1], 1, 1e-15)
same(quat.from_matrix(m), h, 0, 0, h)
m[1][1] = m[1][1] + 1e-3
local near, distance = quat.from_matrix_nearest(m)
check.close(near:rotation_distance(about_z), 5e-4, 1e-6)
check.close(distance, 1e-3 / math.sqrt(2), 1e-6)
same(quat.from_euler("ZYX", pi / 2, 0, 0), h, 0, 0, h)
local a, b, c, reason = quat.new(h, 0, h, 0):to_euler("ZYX")
check.close(b, pi / 2, 1e-15)
check.equal(a + c, 0)
check.equal(reason, "the answer is not unique; one was chosen")
same(quat.from_two_vectors(x, y), h, 0, 0, h)
same(quat.from_axes(y, { -1, 0, 0 }), h, 0, 0, h)
same(quat.from_frame(y, { -1, 0, 0 }, z), h, 0, 0, h)
local swing, twist = (quat.from_rotation_vector({ 0.3, 0, 0 }) * about_z):swing_twist(z)
same(twist, h, 0, 0, h)
check.close(swing:angle(), 0.3, 1e-15)
same(one:step({ 0, 0, pi }, 0.5), h, 0, 0, h)
same(one:derivative({ 0, 0, 2 }), 0, 0, 0, 1)
vector(one:omega({ 0, 0, 0, 1 }), 0, 0, 2)
same(one:integrate(function(t) return { 0, 0, t } end, 0, math.sqrt(pi), 7), h, 0, 0, h)
same(one:integrate(function(t) return { 0, 0, t } end, 0, math.sqrt(pi), 7, "body", "cf4"), h, 0, 0, h)
same(one:integrate(function(t) return { 0, 0, t } end, 0, math.sqrt(pi), 7, "world", "magnus8"), h, 0, 0, h)

-- Interpolation.
same(one:slerp(about_z, 0.5), math.cos(pi / 8), 0, 0, math.sin(pi / 8))
same(one:slerp(-about_z, 0.5), math.cos(pi / 8), 0, 0, math.sin(pi / 8))
same(one:slerp(-about_z, 0.5, "as_given"), math.cos(3 * pi / 8), 0, 0, -math.sin(3 * pi / 8))
same(one:nlerp(about_z, 0.5), math.cos(pi / 8), 0, 0, math.sin(pi / 8))
vector(one:slerp_omega(about_z), 0, 0, pi / 2)
vector(one:slerp_omega(-about_z, "as_given"), 0, 0, -3 * pi / 2)
vector(one:nlerp_omega(about_z, 0.5), 0, 0, 4 * math.tan(pi / 8))
vector(one:nlerp_omega(-about_z, 0.5), 0, 0, 4 * math.tan(pi / 8))
vector(one:nlerp_omega(-about_z, 0.5, "as_given"), 0, 0, -4 * math.tan(3 * pi / 8), 4e-15)
same(quat.squad(one, one, about_z, about_z, 0.5), math.cos(pi / 8), 0, 0, math.sin(pi / 8))
same(quat.squad_control(about_z:conj(), one, about_z), 1, 0, 0, 0)
check.close(quat.squad_omega(one, one, about_z, about_z, 0.5)[3], pi / 2, 1e-14)
local turns = {}
for n = 0, 4 do turns[n + 1] = quat.from_rotation_vector({ 0, 0, n * pi / 2 }) end
local spline = quat.spline { times = { 0, 1, 2, 3, 4 }, keys = turns, ends = "periodic" }
same(spline:at(0.5), math.cos(pi / 8), 0, 0, math.sin(pi / 8))
local at, omega, acceleration = spline:state(2.25)
vector(omega, 0, 0, pi / 2, 1e-13)
vector(acceleration, 0, 0, 0, 1e-12)
check.close(spline:length(), 2 * pi, 1e-13)
check.close(spline:time_at(pi), 2, 1e-13)
check.close(at:norm(), 1, 1e-15)
spline:close()
check.raises("argument 'spline' has been closed", spline.at, spline, 1)
do
  local closed <close> = quat.spline { times = { 0, 1 }, keys = { one, about_z } }
  same(closed:at(2), h, 0, 0, h)
end

-- Lists.
local turned = about_z:rotate_list { x, { x = 0, y = 1, z = 0 } }
vector(turned[1], 0, 1, 0)
vector(turned[2], -1, 0, 0)
local flat = about_z:rotate_list { 1, 0, 0, 0, 1, 0 }
check.equal(#flat, 6)
check.close(flat[2], 1, 1e-15)
vector(about_z:rotate_inverse_list({ y })[1], 1, 0, 0)
check.equal(#about_z:rotate_list {}, 0)
local xs, ys, zs = about_z:rotate_soa({ 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 })
vector(xs, 0, -1, 0)
vector(ys, 1, 0, 0)
vector(zs, 0, 0, 1)
-- Rows t, x, y, z, tag; columns; and backwards: what is no point stays.
local rows = about_z:rotate_strided({ 9, 1, 0, 0, 7, 8, 0, 1, 0, 6 }, { count = 2, first = 2, point = 5 })
for n, want in ipairs { 9, 0, 1, 0, 7, 8, -1, 0, 0, 6 } do check.close(rows[n], want, 1e-15) end
local columns = about_z:rotate_strided({ 1, 0, 0, 1, 0, 5 }, { count = 2, point = 1, component = 2 })
for n, want in ipairs { 0, -1, 1, 0, 0, 5 } do check.close(columns[n], want, 1e-15) end
local backwards = about_z:rotate_strided({ 0, 0, 1, 0, 1, 0 }, { count = 2, first = 6, point = -3, component = -1 })
for n, want in ipairs { 0, 1, 0, 0, 0, -1 } do check.close(backwards[n], want, 1e-15) end
check.equal(#one:rotate_strided({}, { count = 0 }), 0)
vector(quat.rotate_each({ about_z, one }, { x, y })[1], 0, 1, 0)
vector(quat.rotate_each({ about_z, one }, { x, y })[2], 0, 1, 0)
local matrices = quat.to_matrix_list { one, about_z }
check.close(matrices[2][2][1], 1, 1e-15)
same(quat.from_matrix_list(matrices)[2], h, 0, 0, h)
check.equal(select(2, quat.from_matrix_list { matrices[1], { { -1, 0, 0 }, { 0, 1e300, 0 }, { 0, 0, 1 } } }),
  "matrices[2]: zero, infinite or NaN where a finite, non-zero value is needed")
local between = quat.slerp_each({ one, one }, { about_z, -about_z }, { 0, 0.5 })
same(between[1], 1, 0, 0, 0)
same(between[2], math.cos(pi / 8), 0, 0, math.sin(pi / 8))
check.equal(quat.mul_list({ i, j }, { j, k })[2], i)
check.equal(quat.normalize_list({ { 0, 3, 0, 0 } })[1], i)
check.equal(quat.compose_list { i, j, k }, -one)
same(one:slerp_list(about_z, { 0, 0.5, 1 })[2], math.cos(pi / 8), 0, 0, math.sin(pi / 8))
local curve, changed, monodromy = quat.unflip { one, about_z, i * i }
check.equal(changed, 1)
check.equal(monodromy, 1)
check.equal(curve[3], one)
same(quat.mean { one, about_z }, math.cos(pi / 8), 0, 0, math.sin(pi / 8))
same(quat.mean({ one, about_z }, { 0, 2 }), h, 0, 0, h)
local mean, spread = quat.mean_karcher { one, -about_z }
check.close(spread, pi / 4, 1e-14)
check.close(mean:angle(), pi / 4, 1e-14)
local aligned, residual = quat.align({ x, y }, { y, { -1, 0, 0 } })
same(aligned, h, 0, 0, h)
check.close(residual, 0, 1e-15)
local fit, shift = quat.align_points({ x, y, z }, { { 5, 1, 0 }, { 4, 0, 0 }, { 5, 0, 1 } })
same(fit, h, 0, 0, h, 1e-14)
vector(shift, 5, 0, 0, 1e-14)
check.equal(quat.align_error(aligned, { x, y }, { y, { -1, 0, 0 } }) < 1e-14, true)
check.equal(quat.align_error(one, { x }, { x }), math.huge)
check.equal(quat.align_points_error(fit, { x, y, z }, { { 5, 1, 0 }, { 4, 0, 0 }, { 5, 0, 1 } }) < 1e-14, true)
check.equal(select(3, quat.align({ x }, { x })), "the answer is not unique; one was chosen")

-- Derivatives.
local function apply(rows_of, numbers)
  local out = {}
  for n, row in ipairs(rows_of) do
    out[n] = 0
    for c, value in ipairs(row) do out[n] = out[n] + value * numbers[c] end
  end
  return out
end
local p1, q1 = quat.new(1, 2, 3, 4), quat.new(5, 6, 7, 8)
check.equal(quat.new(apply(p1:left_matrix(), { q1:components() })), p1 * q1)
check.equal(quat.new(apply(q1:right_matrix(), { p1:components() })), p1 * q1)
local turning = about_z:rotate_jacobian { 1, 2, 3 }
check.equal(#turning, 3)
vector(apply(turning, { about_z:components() }), -4, 2, 6) -- homogeneous of degree two
check.equal(#quat.exp_jacobian { 0, 0, 0 }, 4)
local back_again = apply(about_z:log_jacobian(), apply(quat.exp_jacobian { 0, 0, pi / 4 }, { 1, 2, 3 }))
vector(back_again, 1, 2, 3, 1e-14)
local r1 = { 0.3, -0.7, 0.2 }
vector(apply(quat.rotation_vector_jacobian(r1), apply(quat.rotation_vector_jacobian_inverse(r1), { 1, 2, 3 })), 1, 2, 3, 1e-14)
local body = apply(quat.rotation_vector_jacobian(r1, "right"), { 1, 2, 3 })
local world = apply(quat.rotation_vector_jacobian(r1, "left"), { 1, 2, 3 })
vector(quat.from_rotation_vector(r1):rotate(body), world[1], world[2], world[3], 1e-14)
check.equal(select(2, quat.new(-1, 0, 0, 0):log_jacobian()), "the derivative does not exist here")

-- Rigid motions.
local lift = quat.motion(about_z, { 0, 0, 3 })
vector(lift:apply { 1, 0, 0 }, 0, 1, 3)
vector((lift * lift):apply { 1, 0, 0 }, -1, 0, 6)
vector((lift * lift:inverse()):apply { 1, 2, 3 }, 1, 2, 3)
vector(lift:apply_inverse { 0, 1, 3 }, 1, 0, 0)
vector(lift:shift(), 0, 0, 3)
same(lift:rotation(), h, 0, 0, h)
local line, point, turn, slide = quat.screw(z, x, pi / 2, 2):to_screw()
vector(line, 0, 0, 1)
vector(point, 1, 0, 0)
check.close(turn, pi / 2, 1e-15)
check.close(slide, 2, 1e-15)
vector(quat.motion({ 1, 0, 0, 0 }, { 0, 0, 0 }):sclerp(lift, 0.5):shift(), 0, 0, 1.5)
vector(quat.blend({ lift, quat.motion(about_z, { 3, 0, 0 }) }, { 1, 2 }):shift(), 2, 0, 1)
local rate, flow = lift:log()
vector(quat.motion_exp(rate, flow):apply { 1, 0, 0 }, 0, 1, 3)
local real, dual = lift:parts()
check.equal(quat.motion_from_parts(real, dual), lift)
vector(quat.motion_from_parts(real * 2, dual * 2):shift(), 0, 0, 3)
check.equal(quat.motion_from_parts(zero, one), nil)
check.truth(tostring(lift):find("shift (0, 0, 3)", 1, true), tostring(lift))

-- Projections.
local inf = math.huge
vector(about_z:stereographic(), 0, 0, math.tan(pi / 8))
vector(about_z:stereographic("north"), 0, 0, math.tan(3 * pi / 8), 1e-15)
same(quat.from_stereographic { 0, 0, math.tan(pi / 8) }, h, 0, 0, h)
local infinite, why = (-one):stereographic()
check.equal(infinite.x, inf)
check.equal(why, "the image is the point at infinity")
check.equal(quat.from_stereographic(infinite), -one)
check.equal(quat.from_stereographic({ x = inf, y = 0, z = 0 }, "north"), one)
check.equal(select(2, zero:stereographic()), "zero, infinite or NaN where a finite, non-zero value is needed")
local on_plane = quat.stereographic_sphere { 2, -3, 6 }
check.close(on_plane[1], 2, 1e-15)
check.close(on_plane[2], -3, 1e-15)
vector(quat.from_stereographic_sphere(on_plane), 2 / 7, -3 / 7, 6 / 7)
check.close(quat.stereographic_circle { 0.6, 0.8 }, 3, 3e-15)
check.close(quat.stereographic_circle({ x = 0.6, y = 0.8 }, "south"), 1 / 3, 1e-15)
check.close(quat.from_stereographic_circle(3)[2], 0.8, 1e-15)
check.equal(quat.from_stereographic_circle(-inf)[2], 1)
local shadow, half = (-about_z):orthographic()
vector(shadow, 0, 0, -h)
check.equal(half, -1)
same(quat.from_orthographic(shadow, half), -h, 0, 0, -h)
check.equal(quat.from_orthographic({ 2, 0, 0 }, 1), nil)
local below, side = quat.orthographic_sphere { 0, 3, -4 }
check.close(below[2], 0.6, 1e-15)
check.equal(side, -1)
vector(quat.from_orthographic_sphere(below, side), 0, 0.6, -0.8)
local on_line, upper = quat.orthographic_circle { 3, 4 }
check.close(quat.from_orthographic_circle(on_line, upper)[2], 0.8, 1e-15)
local images, reached = quat.stereographic_list { one, about_z, -one }
vector(images[2], 0, 0, math.tan(pi / 8))
check.equal(reached, "the image is the point at infinity")
check.equal(quat.from_stereographic_list(images)[3], -one)
check.equal(select(2, quat.stereographic_list { one, zero }), "q[2]: zero, infinite or NaN where a finite, non-zero value is needed")
local shadows, halves = quat.orthographic_list { one, -about_z, i }
check.equal(table.concat(halves, " "), "1 -1 0")
same(quat.from_orthographic_list(shadows, halves)[2], -h, 0, 0, -h)
vector(about_z:hopf(), 0, 0, 1)
vector(quat.hopf_fibre({ 3, 0, 4 }, 1):hopf(), 0.6, 0, 0.8)
check.close(quat.hopf_fibre({ 3, 0, 4 }, 1):hopf_angle(), 1, 1e-15)

-- Sequences.
same(quat.belt_twist(2 * pi, 1), -1, 0, 0, 0)
check.equal(quat.belt_untwist(0.3, 1), one)
same(quat.belt_untwist(0, 0.25), 0, 0, 1, 0)
vector(quat.belt_centre(0.5, 1), 0.5, 0, 0)
local frames, centres = quat.belt_frames(0.3, 11)
check.equal(#frames, 11)
check.equal(frames[11], one)
check.equal(centres[4][1], quat.belt_centre(0.3, 0.3)[1])
check.equal(table.concat(quat.spinor_arrows(4 * pi), " "), table.concat({ pi, pi, -pi, -pi }, " "))
check.equal(quat.spinor_place(2 * pi), 2 * pi)
same(quat.band(pi, 2), -1, 0, 0, 0)
local rounds = {}
for n = 0, 5 do rounds[n + 1] = (-1) ^ n * quat.band(pi, 0.4 * n) end
check.equal(quat.loop_sign(rounds), -1)
vector(one:roll(pi / 2, 0):rotate { 0, 0, 1 }, 1, 0, 0)
same(quat.roll_path(one, { { 0, 0 }, { 1, 0 }, { 1, pi / 2 }, { 0, pi / 2 } })[2], math.cos(0.5), 0, math.sin(0.5), 0)
local loop = quat.roll_loop(0.75)
check.truth(quat.from_rotation_vector(loop):near(quat.roll_circle(0.75, 2 * pi), 2e-15))
check.close(math.sqrt(loop.x ^ 2 + loop.z ^ 2), pi / 2, 1e-15)
local thirds = quat.chain(one, { { 0, -pi / 2, 0 }, { pi / 2, 0, 0 }, { 0, pi / 2, 0 } }, 5)
check.equal(#thirds, 16)
same(thirds[16], h, 0, 0, -h)
same(quat.chain(one, { { 0, pi / 2, 0 }, { pi / 2, 0, 0 }, { 0, -pi / 2, 0 } }, 1, "body")[4], h, 0, 0, -h)

-- Misuse names the argument.
check.raises("a vector is multiplied by a number; of two vectors take v:dot(w) or v:cross(w)", function() return v1 * v2 end)
check.raises("division of a vector by zero", function() return v1 / 0 end)
check.raises("argument 'right' must be a vector {x, y, z} of finite numbers, got 1", function() return v1 + 1 end)
check.raises("argument 'z' must be a finite number, got nothing", quat.vec3, 1, 2)
check.raises("the result is (inf, 0.000000, 0.000000): the result or a number on the way to it is too large or too small",
  function() return quat.vec3(1e308, 0, 0) * 10 end)
check.raises("argument 'pole' must be one of 'south', 'north', got the string 'west'", one.stereographic, one, "west")
check.raises("argument 'image' must be a point {x, y, z} of numbers", quat.from_stereographic, { 1, 2 })
check.raises("argument 'p' must be a point {x, y} of numbers", quat.stereographic_circle, { 1, 0 / 0 })
check.raises("argument 'p' must be finite", quat.stereographic_circle, { 1, math.huge })
check.raises("argument 'half' must be a whole number from -1 to 1, got 2", quat.from_orthographic, { 0, 0, 0 }, 2)
check.raises("argument 'halves[1]' must be -1, 0 or 1, got 0.5", quat.from_orthographic_list, { x }, { 0.5 })
check.raises("argument 'hand[2]' must be a point {x, y} of numbers", quat.roll_path, one, { { 0, 0 }, 7 })
check.raises("argument 'parts' must be a whole number from 1 to 1000000, got 0", quat.chain, one, { x }, 0)
check.raises("argument 'angle' would give more than 1000000 arrows, got 1e+10", quat.spinor_arrows, 1e10)
check.raises("argument 'v' must be a vector {x, y, z} of finite numbers, got nothing", one.rotate, one)
check.raises("argument 'q' must not be zero", quat.rotate, zero, x)
check.raises("argument 'sequence' must be three axes such as 'ZYX' (intrinsic) or 'xyz' (extrinsic), no two neighbours alike, got the string 'ZZX'",
  quat.from_euler, "ZZX", 1, 2, 3)
check.raises("argument 'sequence' must be three axes such as 'ZYX' (intrinsic) or 'xyz' (extrinsic), no two neighbours alike, got 3",
  quat.from_euler, 3, 1, 2, 3)
check.raises("argument 'sequence' must be three axes such as 'ZYX' (intrinsic) or 'xyz' (extrinsic), no two neighbours alike, got nothing",
  one.to_euler, one)
local ok, overflow = pcall(one.integrate, one, function() return { 1e308, 0, 0 } end, 0, 100, 10)
assert(not ok and overflow:find("the result or a number on the way to it is too large or too small", 1, true))
check.raises("the motion is not finite: the result or a number on the way to it is too large or too small",
  quat.motion_exp, { 1e200, 0, 0 }, { 1e200, 0, 1e200 })
local whirl, why = quat.spline { times = { 0, 1e-12, 1 }, keys = { one, { 0.8, 0.6, 0, 0 }, { 0.6, 0.8, 0, 0 } } }
assert(whirl == nil and why == "the result or a number on the way to it is too large or too small")
check.raises("'w' cannot be set: quaternions do not change; make another with quat.new", function() quat.new(1, 2, 3, 4).w = 5 end)
check.raises("argument 'vectors[2]' must be a vector {x, y, z} of finite numbers, got the string 'y'", one.rotate_list, one, { x, "y" })
check.raises("argument 'vectors' must hold three numbers for each vector, got 4 numbers", one.rotate_list, one, { 1, 2, 3, 4 })
check.raises("argument 'weights' must have 2 elements, one for each, got 1", quat.mean, { one, i }, { 1 })
check.raises("argument 'weights[2]' must not be negative, got -1", quat.mean, { one, i }, { 1, -1 })
check.raises("argument 'y' must have 2 elements like the first, got 1", one.rotate_soa, one, { 1, 2 }, { 3 }, { 4, 5 })
check.raises("layout: reaches from data[1] to data[6], but data has 5 numbers", one.rotate_strided, one, { 1, 2, 3, 4, 5 }, { count = 2 })
check.raises("layout: reaches from data[-1] to data[1], but data has 3 numbers", one.rotate_strided, one, { 1, 2, 3 },
  { count = 1, component = -1 })
check.raises("layout: count is missing", one.rotate_strided, one, {}, {})
check.raises("argument 'sequence' must be three axes such as 'ZYX' (intrinsic) or 'xyz' (extrinsic), no two neighbours alike, got a table",
  quat.from_euler, {}, 1, 2, 3)
check.raises("unknown key 'stride' in layout (keys: count, first, point, component)", one.rotate_strided, one, {}, { count = 0, stride = 3 })
check.raises("argument 't[1]' must be a number from 0 to 1, got 1.5", quat.slerp_each, { one }, { one }, { 1.5 })
check.raises("argument 'matrices[1]' must have 3 rows, got 4", quat.from_matrix_list, { { x, y, z, x } })
check.raises("argument 'q[2]' must not be zero", quat.rotate_each, { one, zero }, { x, y })
check.raises("argument 'side' must be one of 'left', 'right', got the string 'up'", quat.rotation_vector_jacobian, x, "up")
check.raises("argument 'omega' must be a function of time, got a number", one.integrate, one, 3, 0, 1, 10)
check.raises("argument 'generator()' must be a number in [0, 1), got 1", quat.random, function() return 1 end)
check.raises("division of quaternions: zero, infinite or NaN where a finite, non-zero value is needed", function() return one / zero end)
check.raises("spline: 2 times but 3 keys", quat.spline, { times = { 0, 1 }, keys = { one, i, j } })
check.raises("argument 'p' must be a motion, got a table", lift.sclerp, {}, lift, 0)

check.report("quat")
