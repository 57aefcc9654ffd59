// SPDX-License-Identifier: MIT
// A panel in space, drawn: fitted to its place, its frame on the floor of its box.
// Grid and numbers on the floor, and one standing axis.
function frameOf(panel, parts, eye) {
  const [X, Y, Z] = parts.range, put = parts.put, lines = [], texts = [], axes = ['x', 'y', 'z'].map((_, c) => ticksOf(...parts.range[c], niceStep(parts.range[c][1] - parts.range[c][0], 4)));
  const far = (r, c) => (eye[c] > 0 ? r[0] : r[1]), near = (r, c) => (eye[c] > 0 ? r[1] : r[0]), say = x => String(+x.toPrecision(4));
  const span = r => r[1] - r[0];
  axes[0].forEach(x => { lines.push([put([x, Y[0], Z[0]]), put([x, Y[1], Z[0]])]); texts.push([put([x, near(Y, 1) + 0.07 * Math.sign(eye[1]) * span(Y), Z[0]]), say(x)]); });
  axes[1].forEach(y => { lines.push([put([X[0], y, Z[0]]), put([X[1], y, Z[0]])]); texts.push([put([near(X, 0) + 0.07 * Math.sign(eye[0]) * span(X), y, Z[0]]), say(y)]); });
  const corner = z => put([near(X, 0), far(Y, 1), z]);
  axes[2].forEach(z => { texts.push([put([near(X, 0) + 0.05 * Math.sign(eye[0]) * span(X), far(Y, 1), z]), say(z)]); });
  lines.push([corner(Z[0]), corner(Z[1])], ...[[X[0], Y[0], X[1], Y[0]], [X[1], Y[0], X[1], Y[1]], [X[1], Y[1], X[0], Y[1]], [X[0], Y[1], X[0], Y[0]]].map(([a, b, c, e]) => [put([a, b, Z[0]]), put([c, e, Z[0]])]));
  const name = (c, p) => panel['xyz'[c] + 'label'] && texts.push([p, panel['xyz'[c] + 'label'], true]);
  name(0, put([(X[0] + X[1]) / 2, near(Y, 1) + 0.18 * Math.sign(eye[1]) * span(Y), Z[0]]));
  name(1, put([near(X, 0) + 0.18 * Math.sign(eye[0]) * span(X), (Y[0] + Y[1]) / 2, Z[0]]));
  name(2, add(corner(Z[1]), [0, 0, 0.08 * norm(sub(corner(Z[1]), corner(Z[0])))]));
  return { lines, texts };
}
const dashed = (path, length) => {
  const out = [];
  let run = [path[0]], on = true, left = length;
  for (let k = 1; k < path.length; k++) {
    let a = path[k - 1], rest = norm(sub(path[k], a));
    while (rest > left) {
      a = add(a, scale(unit(sub(path[k], a)), left)); rest -= left; left = length;
      if (on) out.push([...run, a]);
      run = [a]; on = !on;
    }
    left -= rest; run.push(path[k]);
  }
  return on && run.length > 1 ? [...out, run] : out;
};
// Inside-out grids are turned: what is clear is drawn back before front.
function outward(m) {
  let sum = 0;
  const middle = [0, 1, 2].map(c => { let s = 0; for (let i = c; i < m.points.length; i += 6) s += m.points[i]; return 6 * s / m.points.length; });
  for (let i = 0; i < m.index.length; i += 3) {
    const [a, b, c] = [0, 1, 2].map(k => m.points.slice(6 * m.index[i + k], 6 * m.index[i + k] + 3));
    sum += dot(cross(sub(b, a), sub(c, a)), sub(a, middle));
  }
  return { points: m.points, index: sum < 0 ? m.index.slice().reverse() : m.index, middle };
}
// The colours of values, below: low to high.
function colorBar(d, [low, high], box) {
  const x = box.x + 0.28 * box.w, w = 0.44 * box.w, y = box.y + box.h - 30, shade = d.createLinearGradient(x, 0, x + w, 0);
  [[0, inks.blue], [0.5, '#f7fafc'], [1, inks.red]].forEach(([s, c]) => shade.addColorStop(s, c));
  d.fillStyle = shade; d.fillRect(x, y, w, 9);
  ticksOf(low, high, niceStep(high - low, 4)).forEach(v => letter(d, String(+v.toPrecision(4)), x + w * (v - low) / (high - low), y + 19, { size: 9, align: 'center' }));
}
// What opaque surfaces keep the sun from; the solid program is the one in use again.
function castShadow(G, parts, sun, radius, model) {
  const { gl } = G, [, , w, h] = gl.getParameter(gl.VIEWPORT), light = mat(parallel(1.1 * radius, 0.1 * radius, 8 * radius), look(scale(sun, 4 * radius), [0, 0, 0], [0, 0, 1]));
  gl.bindFramebuffer(gl.FRAMEBUFFER, G.frameBuffer); gl.viewport(0, 0, G.size, G.size); gl.clear(gl.DEPTH_BUFFER_BIT);
  G.dark.set({ view: light, model });
  parts.solids.filter(o => o.opacity >= 1).forEach(o => G.draw(o.drawn));
  gl.bindFramebuffer(gl.FRAMEBUFFER, null); gl.viewport(0, 0, w, h);
  G.solid.set({ light, texel: 1 / G.size });
}
// most: pixels for a unit of length at most, so that panels of one range have one scale; 0: as large as it fits. Gives back what it took.
function drawSpace(d, panel, box, ratio, turn, most) {
  const s = graphicsOf(Math.max(2, Math.round(box.w * ratio)), Math.max(2, Math.round(box.h * ratio))), { G, canvas } = s, w = canvas.width, h = canvas.height;
  if (!G) return letter(d, 'no WebGL 2', box.x + box.w / 2, box.y + box.h / 2, { align: 'center' });
  const parts = panel.parts = panel.parts || partsOf(panel), gl = G.gl, framed = panel.frame !== false;
  const dir = [Math.cos(turn.pitch) * Math.cos(turn.yaw), Math.cos(turn.pitch) * Math.sin(turn.yaw), Math.sin(turn.pitch)];
  const frameParts = framed ? frameOf(panel, parts, dir) : { lines: [], texts: [] };
  const fitted = [...parts.all, ...frameParts.lines.flat(), ...frameParts.texts.map(t => t[0])];
  const low = [0, 1, 2].map(c => Math.min(...fitted.map(p => p[c]))), high = [0, 1, 2].map(c => Math.max(...fitted.map(p => p[c])));
  const middle = scale(add(low, high), 0.5), radius = norm(sub(high, low)) / 2 || 1, distance = 5 * radius, here = p => sub(p, middle);
  const eye = scale(dir, distance), up = Math.abs(dir[2]) > 0.999 ? [-Math.cos(turn.yaw), -Math.sin(turn.yaw), 0] : [0, 0, 1];
  const plain = mat(perspective(4, w / h, 3 * radius, 8 * radius), look(eye, [0, 0, 0], up));
  const place = (m, p) => { const c = [0, 1, 3].map(r => m[r] * p[0] + m[r + 4] * p[1] + m[r + 8] * p[2] + m[r + 12]); return [c[0] / c[2], c[1] / c[2]]; };
  // Fitted to its place, below the title and with room for the words.
  const flat = fitted.map(p => place(plain, here(p))), ends = [0, 1].map(c => [Math.min(...flat.map(p => p[c])), Math.max(...flat.map(p => p[c]))]);
  const top = panel.title ? 1 - 60 * ratio / h : 0.97, rooms = [[-0.93, 0.93], [parts.bar ? 80 * ratio / h - 1 : -0.93, top]];
  const fit = Math.min(...[0, 1].map(c => (rooms[c][1] - rooms[c][0]) / (ends[c][1] - ends[c][0] || 1))), sight = 2 * h / distance, grow = most ? Math.min(fit, most / sight) : fit;
  const shift = [0, 1].map(c => (rooms[c][0] + rooms[c][1]) / 2 - grow * (ends[c][0] + ends[c][1]) / 2);
  const view = mat([grow, 0, 0, 0, 0, grow, 0, 0, 0, 0, 1, 0, shift[0], shift[1], 0, 1], plain), pixel = distance / (grow * 4 * h / 2) * ratio;
  const sun = unit(add(add(scale([-Math.sin(turn.yaw), Math.cos(turn.yaw), 0], -0.6), scale(dir, 0.7)), [0, 0, 0.9]));
  gl.viewport(0, 0, w, h); gl.clearColor(1, 1, 1, 1); gl.depthMask(true); gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  gl.enable(gl.DEPTH_TEST); gl.depthFunc(gl.LEQUAL); gl.enable(gl.BLEND); gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA); gl.enable(gl.POLYGON_OFFSET_FILL); gl.polygonOffset(1, 1);
  G.solid.set({ view, eye, sun, sky: [0, 0, 1], depth: 0, texel: 0, kind: 0, grid: [0, 0, 0, 0], light: [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 10, 10, 10, 1] });
  parts.solids.forEach(o => { if (!o.drawn) { const m = outward(o.mesh); o.middle = m.middle; o.drawn = G.upload(m); } });
  const still = frame(scale(middle, -1), [1, 0, 0, 0], [1, 1, 1]);
  if (panel.shadow) castShadow(G, parts, sun, radius, still);
  const solid = (m, model, ink, a, valued) => { G.solid.set({ model, kind: valued ? 4 : 0, one: rgb(valued ? inks.blue : ink, a), two: rgb(valued ? inks.red : ink, a) }); G.draw(m); };
  parts.solids.filter(o => o.opacity >= 1).forEach(o => solid(o.drawn, still, o.ink, 1, o.valued));
  parts.dots.forEach(o => solid(s.ball, frame(here(o.p), [1, 0, 0, 0], [1, 1, 1].map(() => 4.6 * o.size * pixel)), o.ink, 1));
  parts.darts.forEach(o => { const length = norm(o.d), wide = Math.min((3 + 1.2 * o.width) * pixel, 0.2 * length); if (length > 0) solid(s.arrow, frame(here(o.a), turnTo(unit(o.d)), [wide, wide, length]), o.ink, 1); });
  const stroke = (path, ink, a, width) => { G.lines.set({ view, size: [w / 2, h / 2], one: rgb(ink, a), width: width * ratio, now: 1e30 }); G.drawLine(G.uploadLine(path.map(p => [...here(p), -1e30]))); };
  frameParts.lines.forEach(l => stroke(l, '#a0aec0', 0.7, 0.2));
  parts.strokes.forEach(o => (o.dash ? dashed(o.path, 9 * pixel) : [o.path]).forEach(p => stroke(p, o.ink, o.opacity, o.width)));
  gl.depthMask(false); gl.enable(gl.CULL_FACE);
  const depth = o => dot(sub(o.middle, middle), dir);
  parts.solids.filter(o => o.opacity < 1).sort((a, b) => depth(a) - depth(b)).forEach(o => [gl.FRONT, gl.BACK].forEach(side => { gl.cullFace(side); solid(o.drawn, still, o.ink, o.opacity); }));
  gl.disable(gl.CULL_FACE); gl.depthMask(true); gl.disable(gl.POLYGON_OFFSET_FILL);
  d.drawImage(canvas, box.x, box.y, box.w, box.h);
  const at = p => { const [x, y] = place(view, here(p)); return [box.x + box.w * (x + 1) / 2, box.y + box.h * (1 - y) / 2]; };
  frameParts.texts.forEach(([p, text, big]) => letter(d, text, ...at(p), { size: big ? 11 : 9.5, align: 'center', halo: true }));
  parts.texts.forEach(({ p, item }) => letter(d, item.items[0], ...at(p), { size: item.size || 11, align: item.align || 'left', color: item.ink, halo: true }));
  if (panel.title) letter(d, panel.title, box.x + box.w / 2, box.y + 16, { size: 12, align: 'center', color: '#1a202c' });
  legend(d, panel, colored(panel), box.x, box.y + 20, box.w, box.h - 24);
  if (parts.bar) colorBar(d, parts.bar, box);
  return grow * sight;
}
