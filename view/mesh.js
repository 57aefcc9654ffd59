// SPDX-License-Identifier: MIT
// A convex shape's octant, the corner of a cube blown up to the surface, mirrored by the eight signs. The point n of the unit sphere
// goes to A_i |n_i|^(2/p_i), which lies on sum |x_i/A_i|^p_i = 1 for any exponents; its normal is p_i/A_i |n_i|^(2 - 2/p_i).
// Superellipsoids (Barr 1981): across by r, along z by t, with rho = |(n_x, n_y)|.
function surface(body) {
  const [a, b, c] = body.axes, [r, s, t] = body.exponents, pow = (x, p) => x > 0 ? Math.pow(x, p) : p > 0 ? 0 : 1;
  if (body.kind !== 'superellipsoid') return n => [
    [a, b, c].map((A, i) => A * pow(n[i], 2 / [r, s, t][i])), unit([a, b, c].map((A, i) => [r, s, t][i] / A * pow(n[i], 2 - 2 / [r, s, t][i])))];
  return n => {
    const rho = Math.hypot(n[0], n[1]), k = pow(rho, 2 / t), x = rho > 0 ? n[0] / rho : 1, y = rho > 0 ? n[1] / rho : 0;
    const across = pow(rho, 2 - 2 * r / t) * pow(k, r - 1);
    return [[a * k * pow(x, 2 / r), b * k * pow(y, 2 / r), c * pow(n[2], 2 / t)],
      unit([across * pow(x, 2 - 2 / r) / a, across * pow(y, 2 - 2 / r) / b, pow(n[2], 2 - 2 / t) / c])];
  };
}
// One octant on three grids of equal angles, n by n each: [point, normal] by rows.
function octant(body, n) {
  const f = surface(body), grids = [];
  for (let face = 0; face < 3; face++) {
    const grid = [];
    for (let j = 0; j <= n; j++) for (let i = 0; i <= n; i++) {
      const d = [1, Math.tan(i / n * Math.PI / 4), Math.tan(j / n * Math.PI / 4)];
      grid.push(f(unit([d[(3 - face) % 3], d[(4 - face) % 3], d[(5 - face) % 3]])));
    }
    grids.push(grid);
  }
  return grids;
}
// Whether neighbouring normals differ by less than 5 degrees, or stand closer than a hundredth of the body.
function fine(grids, n, size) {
  return grids.every(g => g.every(([p, m], k) => [k + 1, k + n + 1].every(l => l >= g.length || (l === k + 1 && l % (n + 1) === 0) ||
    dot(m, g[l][1]) > 0.9962 || norm(sub(p, g[l][0])) < 0.01 * size)));
}
// Rows of [point, normal] joined to a mesh; each row as long as the first.
function joined(rows) {
  const points = rows.flat().flatMap(([p, n]) => [...p, ...n]), index = [], w = rows[0].length;
  for (let j = 0; j + 1 < rows.length; j++) for (let i = 0; i + 1 < w; i++) {
    const k = j * w + i;
    index.push(k, k + 1, k + w + 1, k, k + w + 1, k + w);
  }
  return { points, index };
}
// A profile of [rho, z, normal] around z.
function turned(profile) {
  return joined(profile.map(([rho, z, out, up]) => Array.from({ length: 65 }, (_, i) => {
    const c = Math.cos(i * Math.PI / 32), s = Math.sin(i * Math.PI / 32);
    return [[rho * c, rho * s, z], [out * c, out * s, up]];
  })));
}
const arc = (rho, z, r, from, to) => Array.from({ length: 9 }, (_, i) => {
  const a = from + (to - from) * i / 8, c = Math.cos(a), s = Math.sin(a);
  return [rho + r * c, z + r * s, c, s];
});
function roundMesh(body) {
  const [a, , c] = body.axes, r = body.rounding || 0, half = Math.PI / 2;
  if (body.kind === 'cone') {
    const R = a - r, H = c - 2 * r, z = body.base, tilt = Math.atan2(R, H);
    return turned([[0, z - r, 0, -1], ...arc(R, z, r, -half, tilt), ...arc(0, z + H, r, tilt, half)]);
  }
  return turned([[0, -c, 0, -1], ...arc(a - r, r - c, r, -half, 0), ...arc(a - r, c - r, r, 0, half), [0, c, 0, 1]]);
}
// Flat faces a rounding away from the core's, a strip of the ball along each edge, a fan of it on each corner.
function flatMesh(vertices, faces, r) {
  const points = [], index = [], beside = new Map(), around = vertices.map(() => []);
  const put = (v, n) => (points.push(...add(v, scale(n, r)), ...n), points.length / 6 - 1);
  const between = (n, m, s) => unit(add(scale(n, 1 - s), scale(m, s)));
  const normals = faces.map(f => unit(f.slice(2).reduce((sum, v, i) =>
    add(sum, cross(sub(vertices[f[i + 1]], vertices[f[0]]), sub(vertices[v], vertices[f[0]]))), [0, 0, 0])));
  faces.forEach((f, number) => {
    const at = f.map(v => put(vertices[v], normals[number]));
    for (let i = 1; i + 1 < at.length; i++) index.push(at[0], at[i], at[i + 1]);
    f.forEach((v, i) => { beside.set(v + ' ' + f[(i + 1) % f.length], number); around[v].push(number); });
  });
  if (!(r > 0)) return { points, index };
  beside.forEach((left, pair) => {
    const [u, v] = pair.split(' ').map(Number), right = beside.get(v + ' ' + u);
    const middle = [u, v].map(w => unit(around[w].reduce((sum, f) => add(sum, normals[f]), [0, 0, 0])));
    const parts = 1 + Math.floor(Math.acos(clamp(dot(normals[left], normals[right]), -1, 1)) / 0.27);
    for (let i = 0; i < parts; i++) {
      const n = between(normals[left], normals[right], i / parts), m = between(normals[left], normals[right], (i + 1) / parts);
      if (u < v) { const q = [put(vertices[u], m), put(vertices[v], m), put(vertices[v], n), put(vertices[u], n)]; index.push(q[0], q[1], q[2], q[0], q[2], q[3]); }
      for (let k = 0; k < parts; k++) { // the corner at u, from the edge's arc to its middle
        const [a, b, c, d] = [[n, k], [n, k + 1], [m, k + 1], [m, k]].map(([x, j]) => put(vertices[u], between(x, middle[0], j / parts)));
        index.push(a, b, c, a, c, d);
      }
    }
  });
  return { points, index };
}
const boxFaces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
function coreMesh(body) {
  const r = body.rounding || 0;
  if (body.kind === 'polyhedron') return flatMesh(body.vertices, body.faces, r);
  if (body.kind !== 'box') return roundMesh(body);
  const corners = [0, 1, 2, 3, 4, 5, 6, 7].map(i => body.axes.map((a, k) => (i >> k & 1 ? 1 : -1) * (a - r)));
  return flatMesh(corners, boxFaces, r);
}
const cored = ['box', 'cylinder', 'cone', 'capsule', 'polyhedron'];
const isEllipsoid = body => !cored.includes(body.kind) && body.exponents.every(p => p === 2);
// Grid lines to an eighth of a turn by which a circle of so many pixels is a quarter of one off: r (pi/4n)^2/8.
const gridLines = pixels => [2, 3, 4, 6, 8, 12, 16, 24].find(n => n >= Math.PI / 4 * Math.sqrt(pixels / 2)) || 24;
// { points: position and normal by vertex, index }
function mesh(body, most) {
  if (cored.includes(body.kind)) return coreMesh(body);
  let n = isEllipsoid(body) ? most : Math.min(4, most);
  while (n < most && !fine(octant(body, n), n, Math.max(...body.axes))) n = Math.min(2 * n, most);
  const grids = octant(body, n), points = [], index = [];
  for (let sign = 0; sign < 8; sign++) {
    const m = [sign & 1 ? -1 : 1, sign & 2 ? -1 : 1, sign & 4 ? -1 : 1], flip = m[0] * m[1] * m[2] < 0;
    for (const grid of grids) {
      const base = points.length / 6;
      for (const [p, q] of grid) points.push(...p.map((x, i) => x * m[i]), ...q.map((x, i) => x * m[i]));
      for (let j = 0; j < n; j++) for (let i = 0; i < n; i++) {
        const k = base + j * (n + 1) + i, quad = [k, k + 1, k + n + 2, k, k + n + 2, k + n + 1];
        index.push(...(flip ? quad.reverse() : quad));
      }
    }
  }
  return { points, index };
}
// Along z from 0 to 1: a shaft and a head, radius 1 in the head.
function arrowMesh() {
  const points = [], index = [], n = 20, rings = [[0.4, 0, 0], [0.4, 0.75, 0], [1, 0.75, 0.7], [0, 1, 0.7]];
  rings.forEach(([r, z, up]) => {
    for (let i = 0; i <= n; i++) {
      const c = Math.cos(2 * Math.PI * i / n), s = Math.sin(2 * Math.PI * i / n);
      points.push(r * c, r * s, z, c, s, up);
    }
  });
  for (let k = 0; k < 3; k++) for (let i = 0; i < n; i++) {
    const a = k * (n + 1) + i, b = a + n + 1;
    index.push(a, a + 1, b + 1, a, b + 1, b);
  }
  return { points, index };
}
const quadMesh = { points: [-1, -1, 0, 0, 0, 1, 1, -1, 0, 0, 0, 1, 1, 1, 0, 0, 0, 1, -1, 1, 0, 0, 0, 1], index: [0, 1, 2, 0, 2, 3] };
