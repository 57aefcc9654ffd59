// SPDX-License-Identifier: MIT
// A panel of a figure in space: lit surfaces that hide what is behind them, clear ones far to near with their back before their front,
// tubes, points, arrows; drawn on one hidden canvas of WebGL 2 and copied.
let spaceGraphics = null;
function graphicsOf(w, h) {
  if (!spaceGraphics) { const canvas = document.createElement('canvas'); spaceGraphics = { canvas, G: makeGraphics(canvas), ball: null }; }
  const s = spaceGraphics;
  if (s.G && !s.ball) Object.assign(s, { ball: s.G.upload(mesh({ kind: 'sphere', axes: [1, 1, 1], exponents: [2, 2, 2] }, 8)), arrow: s.G.upload(arrowMesh()) });
  s.canvas.width = w; s.canvas.height = h;
  return s;
}
// A grid of points with the normals of its own differences; a hole where a point is none. part: of a value's range, which the normal's
// length carries, 1 to 2 (gl.js, kind 4).
function sheetMesh(at, rows, columns, part) {
  const points = [], index = [], edge = (a, b) => (a && b ? sub(b, a) : [0, 0, 0]);
  const normal = (i, j) => {
    const p = at(i, j), u = edge(at(Math.max(i - 1, 0), j) || p, at(Math.min(i + 1, columns - 1), j) || p), v = edge(at(i, Math.max(j - 1, 0)) || p, at(i, Math.min(j + 1, rows - 1)) || p);
    return [unit(cross(u, v)), norm(cross(u, v)) > 1e-9 * dot(v, v)];
  };
  // At a pole, where a row is one point, what the means of the two rows beside it lead to.
  const mean = j => unit(Array.from({ length: columns }, (_, i) => normal(i, j)[0]).reduce(add));
  const pole = j => sub(scale(mean(j ? j - 1 : 1), 2), mean(j ? j - 2 : 2));
  for (let j = 0; j < rows; j++) for (let i = 0; i < columns; i++) {
    const p = at(i, j), [own, sound] = normal(i, j), n = p && !sound && rows > 2 && (j === 0 || j === rows - 1) ? pole(j) : own;
    points.push(...(p || [0, 0, 0]), ...scale(unit(n), part ? 1 + part(i, j) : 1));
  }
  for (let j = 0; j + 1 < rows; j++) for (let i = 0; i + 1 < columns; i++) {
    const k = j * columns + i;
    if ([[i, j], [i + 1, j], [i, j + 1], [i + 1, j + 1]].every(([a, b]) => at(a, b))) index.push(k, k + 1, k + columns + 1, k, k + columns + 1, k + columns);
  }
  return { points, index };
}
// A tube about a polyline: the frame is carried along by the shortest turn from edge to edge.
function tubeMesh(path, radius) {
  const along = path.map((_, k) => unit(sub(path[Math.min(k + 1, path.length - 1)], path[Math.max(k - 1, 0)])));
  let side = unit(cross(along[0], Math.abs(along[0][2]) < 0.9 ? [0, 0, 1] : [1, 0, 0]));
  return joined(path.map((p, k) => {
    side = unit(sub(side, scale(along[k], dot(side, along[k]))));
    const up = cross(along[k], side);
    return Array.from({ length: 13 }, (_, i) => { const n = add(scale(side, Math.cos(i * Math.PI / 6)), scale(up, Math.sin(i * Math.PI / 6))); return [add(p, scale(n, radius)), n]; });
  }));
}
// Runs of a polyline between points that are none.
function runsOf(x, y, z, put) {
  const runs = [[]];
  x.forEach((_, k) => { if (real(x[k]) && real(y[k]) && real(z[k])) runs[runs.length - 1].push(put([x[k], y[k], z[k]])); else runs.push([]); });
  return runs.filter(r => r.length > 1);
}
// What the panel holds, in the units of its box: { solids: [mesh, ink, opacity], strokes, dots, darts, texts, all: points to fit }.
function partsOf(panel) {
  const range = [0, 1, 2].map(c => panel['xyz'[c] + 'range'] || extentOf(panel, c) || [0, 1]).map(([a, b]) => (b > a ? [a, b] : [a - 0.5, b + 0.5]));
  const stretch = panel.equal ? [1, 1, 1] : range.map(([a, b], c) => (c === 2 ? 0.7 : 1) / (b - a)), put = p => p.map((x, c) => x * stretch[c]);
  const parts = { range, put, solids: [], strokes: [], dots: [], darts: [], texts: [], all: [] }, inside = p => p.every((x, c) => real(x) && x >= range[c][0] - 1e-9 && x <= range[c][1] + 1e-9);
  colored(panel).forEach(item => {
    const [x, y, z, u, v, w] = item.items;
    if (item.kind === 'surface') {
      const rows = x.length, columns = x[0].length, raw = (i, j) => [x[j][i], y[j][i], z[j][i]], at = (i, j) => (raw(i, j).every(real) ? put(raw(i, j)) : null);
      for (let j = 0; j < rows; j += 2) for (let i = 0; i < columns; i += 2) if (at(i, j)) parts.all.push(at(i, j));
      const shown = item.lines ? Math.min(0.45, 1.2 * (item.opacity || 0.35)) : item.opacity || 0.35;
      const [low, high] = item.range || (item.value ? extentOf({ items: [{ kind: 'surface', items: [item.value] }] }, 0) : [0, 1]);
      const part = item.value ? (i, j) => clamp((item.value[j][i] - low) / (high - low || 1), 0, 1) : null;
      if (part) parts.bar = [low, high];
      parts.solids.push({ mesh: sheetMesh(at, rows, columns, part), ink: item.ink, valued: !!part, opacity: part || shown > 0.9 ? 1 : shown });
      const line = (count, f) => { for (let k = 0, run = []; k <= count; k++) { const p = k < count ? f(k) : null; if (p) run.push(p); else { if (run.length > 1) parts.strokes.push({ path: run, ink: item.ink, width: 0.8, opacity: 0.7 }); run = []; } } };
      const stride = count => 2 * Math.max(1, Math.round(count / 28)); // of finer grids the lines stay as far apart
      if (item.lines) { for (let j = 0; j < rows; j += stride(rows)) line(columns, i => at(i, j)); for (let i = 0; i < columns; i += stride(columns)) line(rows, j => at(i, j)); }
    } else if (item.kind === 'line') runsOf(x, y, z, put).forEach(path => {
      parts.all.push(...path);
      if (item.tube) parts.solids.push({ mesh: tubeMesh(path, item.tube * stretch[0]), ink: item.ink, opacity: 1 }); else parts.strokes.push({ path, ink: item.ink, width: item.width || 2, opacity: item.opacity || 1, dash: item.dash });
    });
    else if (item.kind === 'points') x.forEach((_, k) => { if (real(x[k])) { const p = put([x[k], y[k], z[k]]); parts.all.push(p); parts.dots.push({ p, ink: item.ink, size: item.size || 1 }); } });
    else if (item.kind === 'arrows') x.forEach((_, k) => { if (real(x[k]) && real(u[k])) { const a = put([x[k], y[k], z[k]]), b = put([x[k] + u[k], y[k] + v[k], z[k] + w[k]]); parts.all.push(a, b); if (item.head === 0) parts.strokes.push({ path: [a, b], ink: item.ink, width: item.width || 1.5, opacity: 1 }); else parts.darts.push({ a, d: sub(b, a), ink: item.ink, width: item.width || 1.5 }); } });
    else if (item.kind === 'text') { const p = put([...item.at, 0].slice(0, 3)); parts.texts.push({ p, item }); if (inside(item.at.concat(0).slice(0, 3))) parts.all.push(p); }
  });
  return parts;
}
