// SPDX-License-Identifier: MIT
// WebGL 2: a lit solid with octants and shadow, its depth, and lines of any width.
const solidVertex = `#version 300 es
in vec3 p; in vec3 n; uniform mat4 model, view, light; out vec3 at, up, own; out vec4 lit;
void main() {
  vec4 w = model * vec4(p, 1.); mat3 m = mat3(model); at = w.xyz; own = p; lit = light * w; gl_Position = view * w;
  up = m * (n / vec3(dot(m[0], m[0]), dot(m[1], m[1]), dot(m[2], m[2]))); // m turns and stretches: its columns are at right angles
}`;
const darkVertex = `#version 300 es
in vec3 p; uniform mat4 model, view; void main() { gl_Position = view * (model * vec4(p, 1.)); }`;
const solidFragment = `#version 300 es
precision highp float; precision highp sampler2DShadow;
in vec3 at, up, own; in vec4 lit; out vec4 color;
uniform vec4 one, two; uniform vec3 eye, sun, sky; uniform vec4 grid; uniform int kind; uniform sampler2DShadow depth; uniform float texel;
float shade() {
  vec3 s = lit.xyz * .5 + .5; float sum = 0.;
  if (any(lessThan(s, vec3(0.))) || any(greaterThan(s, vec3(1.)))) return 1.;
  for (int i = -1; i < 2; i++) for (int j = -1; j < 2; j++) sum += texture(depth, vec3(s.xy + vec2(i, j) * texel, s.z - .0015));
  return sum / 9.;
}
float line(float x) { float d = abs(fract(x - .5) - .5) / fwidth(x); return 1. - min(d, 1.); }
// Of a flat face one coordinate stands still, and has no width.
float side(float x) { return clamp(x / max(fwidth(x), 1e-20) + .5, 0., 1.) * 2. - 1.; }
void main() {
  vec3 n = normalize(up), v = normalize(eye - at); if (dot(n, v) < 0.) n = -n;
  vec4 c = one;
  if (kind == 1) c = mix(one, two, side(own.x) * side(own.y) * side(own.z) * -.5 + .5);
  if (kind == 2) { vec2 g = own.xy * grid.zw; c.rgb = mix(c.rgb, two.rgb, two.a * max(line(g.x), line(g.y))); }
  if (kind == 3) { color = c; return; }
  if (kind == 4) { float s = length(up) - 1.; c.rgb = s < .5 ? mix(one.rgb, vec3(.97, .98, .99), 2. * s) : mix(vec3(.97, .98, .99), two.rgb, 2. * s - 1.); }
  float toward = dot(n, sun), lightness = toward > 0. ? shade() : 0., l = toward * lightness, h = pow(max(dot(n, normalize(sun + v)), 0.), 60.) * lightness;
  color = vec4(c.rgb * (.5 + .12 * dot(n, sky) + .48 * l) + (kind == 2 ? 0. : .18 * h), c.a);
}`;
// A stretch a b of a polyline with its neighbours c, e: stretches meet on the line that halves their angle; at a sharp corner each ends
// square, half a width further.
const lineVertex = `#version 300 es
in vec4 a, b, c, e; uniform mat4 view; uniform vec2 size; uniform float width, now; out float late; out float across;
vec2 way(vec4 P, vec4 Q) { return (Q.xy / Q.w - P.xy / P.w) * size; }
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1); vec4 A = view * vec4(a.xyz, 1.), B = view * vec4(b.xyz, 1.), N = view * vec4((corner.x < .5 ? c : e).xyz, 1.);
  float cut = 1e-4; bool whole = A.w > cut && B.w > cut && N.w > cut;
  if (A.w < cut) A = mix(A, B, (cut - A.w) / (B.w - A.w)); if (B.w < cut) B = mix(B, A, (cut - B.w) / (A.w - B.w));
  vec2 d = way(A, B), f = corner.x < .5 ? way(N, A) : way(B, N); d = length(d) > 1e-6 ? normalize(d) : vec2(1., 0.);
  vec4 P = corner.x < .5 ? A : B; across = corner.y * 2. - 1.; late = (corner.x < .5 ? a.w : b.w) - now;
  vec2 side = vec2(-d.y, d.x), off = side * across + d * (corner.x * 2. - 1.) * .5;
  if (whole && length(f) > 1e-3) { vec2 m = normalize(f); if (dot(m, d) > -.2) { m = normalize(m + d); m = vec2(-m.y, m.x); off = m * across / dot(m, side); } }
  P.xy += off * (width + 1.5) / size * P.w; gl_Position = P;
}`;
const lineFragment = `#version 300 es
precision highp float; in float late, across; out vec4 color; uniform vec4 one; uniform float width;
void main() { float d = (1. - abs(across)) * (width + 1.5) * .5; color = vec4(one.rgb, one.a * (late > 0. ? .28 : 1.) * clamp(d, 0., 1.)); }`;
function makeGraphics(canvas) {
  const gl = canvas.getContext('webgl2', { antialias: true, alpha: false, preserveDrawingBuffer: true });
  if (!gl) return null;
  const size = 2048, buffers = new Set();
  const program = (vertex, fragment) => {
    const p = gl.createProgram();
    [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]].forEach(([type, text]) => {
      const s = gl.createShader(type);
      gl.shaderSource(s, text); gl.compileShader(s);
      if (!gl.getShaderParameter(s, gl.COMPILE_STATUS)) throw Error(gl.getShaderInfoLog(s));
      gl.attachShader(p, s);
    });
    ['p', 'n'].forEach((name, i) => gl.bindAttribLocation(p, i, name));
    ['a', 'b', 'c', 'e'].forEach((name, i) => gl.bindAttribLocation(p, i, name));
    gl.linkProgram(p);
    const places = {};
    return { p, set(values) {
      gl.useProgram(p);
      for (const [name, v] of Object.entries(values)) {
        const at = name in places ? places[name] : places[name] = gl.getUniformLocation(p, name);
        if (typeof v === 'number') (name === 'kind' || name === 'depth' ? gl.uniform1i(at, v) : gl.uniform1f(at, v));
        else if (v.length === 16) gl.uniformMatrix4fv(at, false, v); else gl['uniform' + v.length + 'fv'](at, v);
      }
    } };
  };
  const solid = program(solidVertex, solidFragment), lines = program(lineVertex, lineFragment);
  const dark = program(darkVertex, '#version 300 es\nprecision highp float; void main() {}');
  const map = gl.createTexture(), frameBuffer = gl.createFramebuffer();
  gl.bindTexture(gl.TEXTURE_2D, map);
  gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, size, size);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
  [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER].forEach(f => gl.texParameteri(gl.TEXTURE_2D, f, gl.LINEAR));
  [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T].forEach(w => gl.texParameteri(gl.TEXTURE_2D, w, gl.CLAMP_TO_EDGE));
  gl.bindFramebuffer(gl.FRAMEBUFFER, frameBuffer);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, map, 0);
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  const upload = m => {
    const array = gl.createVertexArray(), put = (target, data) => { gl.bindBuffer(target, gl.createBuffer()); gl.bufferData(target, data, gl.STATIC_DRAW); };
    gl.bindVertexArray(array);
    put(gl.ARRAY_BUFFER, new Float32Array(m.points));
    [0, 1].forEach(i => { gl.enableVertexAttribArray(i); gl.vertexAttribPointer(i, 3, gl.FLOAT, false, 24, 12 * i); });
    put(gl.ELEMENT_ARRAY_BUFFER, new Uint32Array(m.index));
    return { array, count: m.index.length };
  };
  // Points x, y, z, t of a polyline.
  const uploadLine = points => {
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array([points[0], ...points, points[points.length - 1]].flat()), gl.STATIC_DRAW);
    [1, 2, 0, 3].forEach((k, i) => { gl.enableVertexAttribArray(i); gl.vertexAttribPointer(i, 4, gl.FLOAT, false, 16, 16 * k); gl.vertexAttribDivisor(i, 1); });
    return { array, count: points.length - 1 };
  };
  const draw = m => { gl.bindVertexArray(m.array); gl.drawElements(gl.TRIANGLES, m.count, gl.UNSIGNED_INT, 0); };
  const drawLine = m => { gl.bindVertexArray(m.array); gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, m.count); };
  return { gl, solid, lines, dark, size, frameBuffer, upload, uploadLine, draw, drawLine };
}
