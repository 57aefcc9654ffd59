// SPDX-License-Identifier: MIT
// Vectors are arrays of 3, quaternions of 4 with w first, matrices of 16 by columns, as WebGL has them.
const add = (a, b) => a.map((x, i) => x + b[i]);
const sub = (a, b) => a.map((x, i) => x - b[i]);
const scale = (a, s) => a.map(x => x * s);
const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
const norm = a => Math.sqrt(dot(a, a));
const unit = a => scale(a, 1 / (norm(a) || 1));
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const conj = q => [q[0], -q[1], -q[2], -q[3]];
const qmul = (p, q) => [
  p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
  p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
  p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
  p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]];
const qrot = (q, v) => qmul(qmul(q, [0, ...v]), conj(q)).slice(1);
// The shortest turn of z to the unit vector n.
const turnTo = n => n[2] < -0.999999 ? [0, 1, 0, 0] : unit([1 + n[2], -n[1], n[0], 0]);
// Place x, orientation q, then scaled by s along the body's axes.
const frame = (x, q, s) => {
  const c = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map((e, i) => scale(qrot(q, e), s[i]));
  return [...c[0], 0, ...c[1], 0, ...c[2], 0, ...x, 1];
};
const mat = (a, b) => Array.from({ length: 16 }, (_, k) => {
  let sum = 0;
  for (let i = 0; i < 4; i++) sum += a[4 * i + k % 4] * b[4 * (k >> 2) + i];
  return sum;
});
const look = (eye, to, up) => {
  const z = unit(sub(eye, to)), x = unit(cross(up, z)), y = cross(z, x);
  return [x[0], y[0], z[0], 0, x[1], y[1], z[1], 0, x[2], y[2], z[2], 0, -dot(x, eye), -dot(y, eye), -dot(z, eye), 1];
};
const perspective = (f, aspect, near, far) =>
  [f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, 2 * far * near / (near - far), 0];
const parallel = (w, near, far) =>
  [1 / w, 0, 0, 0, 0, 1 / w, 0, 0, 0, 0, 2 / (near - far), 0, 0, 0, (far + near) / (near - far), 1];
// '#rrggbb' as WebGL has colours.
const rgb = (hex, a = 1) => [1, 3, 5].map(i => parseInt(hex.slice(i, i + 2), 16) / 255).concat(a);
const clamp = (x, a, b) => Math.max(a, Math.min(b, x));
// A number for people: 4 digits.
const say = x => x === 0 ? '0' : String(+x.toPrecision(4));
